"""The box of a volume in which rays are followed; NumPy only."""

from __future__ import annotations

import numpy as np

from pellucid.techniques.eikonal.prepare import Prepared

# The box of a volume whose box is its surface is entered from this far outside, voxels.
SURFACE_MARGIN_VOXELS = 1.5
# From the last voxel centre that holds anything: a field acts a voxel further, and surfaces are interpolated over two.
MATTER_MARGIN_VOXELS = 2.0
# What a Gaussian leaves of an index counts as nothing below this share of the strongest.
NOTHING = 1e-7

Box = tuple[np.ndarray, np.ndarray]
"""Centre and half edges (x, y, z), object metres."""


def whole_box(prepared: Prepared) -> Box:
    """All of a volume. Where its box is its surface there is a margin, so that rays begin outside."""
    margin = SURFACE_MARGIN_VOXELS * prepared.voxel if _is_its_surface(prepared) else 0.0
    return np.zeros(3), 0.5 * np.array(prepared.extent_m) + margin


def tight_box(prepared: Prepared) -> Box:
    """What lies around all matter that differs from the ambient medium, and within the whole box."""
    center, half = whole_box(prepared)
    if _is_its_surface(prepared):
        return center, half
    held = matter_of(prepared)
    low, high = np.zeros(3), np.zeros(3)
    for axis, edge in enumerate(prepared.voxel_m):
        along = np.flatnonzero(held.any(axis=tuple(a for a in range(3) if a != 2 - axis)))
        first, last = (along[0], along[-1]) if along.size else (0, 0)
        low[axis] = (first + 0.5 - MATTER_MARGIN_VOXELS) * edge - half[axis]
        high[axis] = (last + 0.5 + MATTER_MARGIN_VOXELS) * edge - half[axis]
    low, high = np.maximum(low, -half), np.minimum(high, half)
    return 0.5 * (low + high), 0.5 * (high - low)


def corners(box: Box, margin: float = 0.0) -> np.ndarray:
    """(8, 3) corners of a box that is `margin` metres larger on every side."""
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    return box[0] + signs * (box[1] + margin)


def _is_its_surface(prepared: Prepared) -> bool:
    return prepared.sharp and prepared.distance is None


def matter_of(prepared: Prepared) -> np.ndarray:
    """(Z, Y, X) bool: the voxels that hold anything."""
    if prepared.distance is not None:
        held = (prepared.distance < 0.0).any(axis=-1)
    else:
        indices = [np.abs(c.index) for c in prepared.channels if c.index is not None]
        held = np.any([index > NOTHING * index.max() for index in indices], axis=0)
    scattering = None if prepared.scattering is None else prepared.scattering[..., :3]
    coverage = None if prepared.opaque is None else prepared.opaque[..., 3:]
    for field in (prepared.absorption, scattering, prepared.emission, coverage):
        if field is not None:
            held = held | (field > 0.0).any(axis=-1)
    return np.asarray(held)
