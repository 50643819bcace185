"""An insect in amber: opaque voxels inside a sharp body that absorbs."""

from __future__ import annotations

import numpy as np

from pellucid.fields import shapes
from pellucid.fields.volume import Volume
from pellucid.scene import Camera, Environment, RefractiveVolume, Scene

from . import stage
from .picture import Picture

EXTENT_M = (0.034, 0.0232, 0.028)
RESOLUTION = 192


def insect_in_amber() -> Scene:
    """A pebble of amber, 3 cm long, with an ant of 12 mm in it."""
    pebble = Volume.from_regions([(_pebble(), "amber")], RESOLUTION, EXTENT_M)
    stone = RefractiveVolume.from_volume(
        pebble.replace(opaque=_ant_voxels(pebble)),
        position=(0.0, 0.0100, 0.0),
        rotation=(0.0, -12.0, 0.0),
        dispersion=False,
        light=stage.QUICK_LIGHT,
    )
    return Scene(
        Camera((0.012, 0.044, 0.062), (0.0, 0.0085, 0.0), fov_deg=28.0, near_m=0.003),
        Environment.studio(intensity=1.2),
        [stage.key_light(2.0)],
        [stage.table(0.12, stage.stone(512, (0.50, 0.47, 0.42), 0.10), 2.0, roughness=0.6), stone],
        exposure=0.75,
        tone_mapping="khronos",
    )


def _pebble() -> shapes.Shape:
    """Two ellipsoids that have grown together."""
    return shapes.smooth_union(
        0.004,
        shapes.moved(shapes.ellipsoid((0.0120, 0.0095, 0.0108)), (-0.0028, 0.0, 0.0)),
        shapes.moved(shapes.ellipsoid((0.0095, 0.0082, 0.0090)), (0.0052, -0.0010, 0.0012)),
    )


def _ant() -> shapes.Shape:
    """Head, chest and abdomen along x; six legs and two feelers."""
    parts = [
        shapes.moved(shapes.ellipsoid((0.0024, 0.0014, 0.0015)), (-0.0040, 0.0002, 0.0)),
        shapes.moved(shapes.ellipsoid((0.0017, 0.0009, 0.0009)), (-0.0004, 0.0, 0.0)),
        shapes.moved(shapes.ellipsoid((0.0013, 0.0011, 0.0013)), (0.0026, 0.0005, 0.0)),
    ]
    for side in (-1.0, 1.0):
        for k, reach in enumerate((0.0026, -0.0002, -0.0030)):
            x, y, z = 0.0006 - 0.0008 * k, -0.0003, 0.0006 * side
            knee = (x + 0.55 * reach, y + 0.0013, z + 0.0019 * side)
            foot = (x + 1.1 * reach, y - 0.0016, z + 0.0034 * side)
            parts += [shapes.capsule((x, y, z), knee, 0.00024), shapes.capsule(knee, foot, 0.0002)]
        elbow, tip = (0.0042, 0.0017, 0.0011 * side), (0.0058, 0.0004, 0.0019 * side)
        parts += [shapes.capsule((0.0034, 0.0010, 0.0005 * side), elbow, 0.0002), shapes.capsule(elbow, tip, 0.00018)]
    return shapes.union(*parts)


def _ant_voxels(volume: Volume) -> np.ndarray:
    """(Z, Y, X, 4) dark brown, with the share of each voxel that the ant fills."""
    axes = [
        (np.arange(n) + 0.5) * h - 0.5 * e
        for n, h, e in zip(volume.shape[::-1], volume.voxel_m, volume.extent_m, strict=True)
    ]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    ant = shapes.moved(_ant(), (0.0, 0.0015, 0.0))
    covered = np.clip(0.5 - ant(x, y, z) / volume.voxel_m[0], 0.0, 1.0)
    return np.stack([np.full_like(covered, v) for v in (0.05, 0.022, 0.010)] + [covered], axis=-1)


PICTURES = (
    Picture(
        "insect-in-amber",
        "Ant in amber",
        "A honey-coloured pebble, darker where it is thick, with an ant inside that the curved surface magnifies.",
        insect_in_amber,
        3,
    ),
)
