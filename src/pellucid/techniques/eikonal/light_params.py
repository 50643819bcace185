"""The numbers that the light simulator's shaders are given: the grid of the fluence, and what a front carries."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from pellucid.techniques.eikonal.layouts import LightParams, OtherBodies
from pellucid.techniques.eikonal.resources import scale_of

if TYPE_CHECKING:
    from pellucid.scene import LightQuality
    from pellucid.techniques.eikonal.bodies import Body
    from pellucid.techniques.eikonal.light_sources import Source
    from pellucid.techniques.eikonal.prepare import Prepared

CAPACITY = 1 << 17  # patches in a list
OUT_CAPACITY = 3 << 16  # bundles that leave in one batch
BATCH = 1 << 14  # patches of the front that are followed at a time
FINE_FRONT = 1 << 16  # patches
FLUENCE_BYTES = 12  # a voxel
# Patches that carry less of the front's largest than this are not divided; they leave a track of random points instead.
DIVIDE_ABOVE = 1.0 / 20.0


def batch_of(source: Source) -> int:
    """How many patches of a front are followed at a time. Fine fronts meet fine details, such as the walls of a
    wine glass, and are divided most.
    """
    return BATCH if source.tiles <= FINE_FRONT else BATCH // 8


def grid_of(prepared: Prepared, quality: LightQuality, most_bytes: int) -> tuple[int, int, int]:
    """Voxels (x, y, z) of the fluence: those of the volume, or larger ones where told, or where a buffer holds no more.

    most_bytes : that a storage buffer of the device may have.
    """
    own = np.array(prepared.extent_m) / np.array(prepared.voxel_m)
    width = quality.fluence_voxels
    while True:
        grid = np.maximum(np.rint(own / width), 1).astype(int)
        if FLUENCE_BYTES * int(grid.prod()) <= most_bytes:
            return int(grid[0]), int(grid[1]), int(grid[2])
        width *= 1.01 * max((FLUENCE_BYTES * float(grid.prod()) / most_bytes) ** (1.0 / 3.0), 1.0)


def voxel_of(prepared: Prepared, grid: tuple[int, int, int]) -> float:
    """Shortest edge of a voxel of the fluence, object metres."""
    return float((np.array(prepared.extent_m) / grid).min())


def cells_of(grid: tuple[int, int, int]) -> tuple[int, int, int]:
    """Cells (x, y, z) of the direction of light: two voxels wide."""
    x, y, z = (-(-n // 2) for n in grid)
    return x, y, z


def record_of(
    body: Body,
    quality: LightQuality,
    grid: tuple[int, int, int],
    sources: Sequence[Source],
    largest: float,
    total: float,
) -> np.ndarray:
    """The parameters that all lights share. Quanta are as fine as the largest sum allows: all flux through a voxel.

    largest, total : flux of the largest patch, and of all, on all bodies.
    """
    out = np.zeros((), LightParams)
    voxel = voxel_of(body.prepared, grid)
    voxel_m = np.array(body.prepared.extent_m) / grid * scale_of(body.world)
    patch_flux = max((s.patch_flux for s in sources), default=largest or 1.0)
    total_flux = max(total, patch_flux)
    longest = float(np.linalg.norm(voxel_m))
    out["box_center"], out["box_half"] = body.box
    out["grid"], out["cells"] = grid, cells_of(grid)
    out["capacity"], out["out_capacity"] = CAPACITY, OUT_CAPACITY
    out["bounces"] = quality.bounces
    out["most_layers"] = 2 * max(grid) + 16
    out["patch_flux"] = patch_flux
    out["min_flux"] = quality.min_flux
    # Measured by a patch as wide as patches may become: of a coarse front all the more pieces are worth it.
    out["divide_above"] = DIVIDE_ABOVE * min(1.0, quality.split_voxels / quality.front_voxels) ** 2
    out["follow_above"] = DIVIDE_ABOVE
    # Of a voxel the intensity law keeps one patch: patches must not be wider, or voxels stay dark between them.
    widest = min(quality.split_voxels, 1.0) if quality.method == "intensity" else quality.split_voxels
    out["split_width"] = widest * voxel
    out["voxel"] = voxel
    out["quanta_per_flux_m"] = min(2.0**15 / (patch_flux * longest), 2.0**30 / (total_flux * longest))
    out["fluence_per_quantum"] = 1.0 / (float(out["quanta_per_flux_m"]) * float(np.prod(voxel_m)))
    # Of the intensity law: quanta of fluence for a flux through the cross-section of a voxel
    out["intensity_quanta"] = 1.0 / (float(out["fluence_per_quantum"]) * float(np.prod(voxel_m)) ** (2.0 / 3.0))
    out["total_quanta"] = min(2.0**24 / patch_flux, 2.0**30 / max(largest, patch_flux))
    return out


def params_of(record: np.ndarray, source: Source, weights: np.ndarray, first: int) -> np.ndarray:
    out = record.copy()
    out["position"], out["direction"], out["kind"] = source.position, source.direction, source.kind
    out["inside"], out["casts"] = source.inside, source.casts
    # Bundles carry what the lamp sends out: matter takes from that, and what is left is worth its weights.
    out["power"] = source.power
    out["weights"][:, :3] = weights.T  # columns
    out["patch_flux"] *= worth_of(source, weights)
    out["face_count"] = len(source.faces)
    out["faces"][: len(source.faces)] = source.faces
    out["batch_first"], out["batch_count"] = first, min(batch_of(source), source.tiles - first)
    return out


def worth_of(source: Source, weights: np.ndarray) -> float:
    """Of the brightest channel of a lamp, how much is light of one draw."""
    return float(np.abs(weights @ source.power).max() / source.power.max())


def others_of(bodies: Sequence[Body], own: Body) -> np.ndarray:
    """The OtherBodies record of one body among several."""
    out = np.zeros((), OtherBodies)
    others = [body for body in bodies if body is not own]
    out["count"] = len(others)
    for k, body in enumerate(others):
        out["object_from_world"][k] = np.linalg.inv(body.world).T
        out["center"][k, :3], out["half"][k, :3] = body.box
        out["center"][k, 3] = scale_of(body.world)
        out["number"][k, 0] = body.number
    return out
