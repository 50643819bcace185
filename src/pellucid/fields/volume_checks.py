"""What the fields of a volume must be together: of one shape, in range, and a crystal's with a crystal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pellucid.errors import SceneError
from pellucid.fields.sampling import check_size

if TYPE_CHECKING:
    from pellucid.fields.volume import Volume

MOST_REGIONS = 4
HIGHEST_INDEX = 100.0


def common_shape(volume: Volume) -> tuple[int, int, int]:
    if len(volume.regions) > MOST_REGIONS:
        raise SceneError("regions", f"has {len(volume.regions)} bodies", f"at most {MOST_REGIONS} are possible")
    first = volume.regions[0].sdf if volume.regions else volume.delta_n
    if first is None:
        raise SceneError("delta_n", "is missing, and there are no regions", "give one of them")
    shape = np.shape(first)[:3]
    check_size("regions[0].sdf" if volume.regions else "delta_n", shape)
    for i, region in enumerate(volume.regions):
        if region.sdf.shape != shape:
            raise SceneError(f"regions[{i}].sdf", f"has shape {region.sdf.shape}, the first has {shape}")
    z, y, x = (int(n) for n in shape)
    return z, y, x


def check_ranges(volume: Volume) -> None:
    if volume.delta_n is not None and float(volume.delta_n.min()) + volume.ambient_n <= 0.0:
        raise SceneError("delta_n", "makes the index 0 or less")
    if volume.delta_n is not None and float(volume.delta_n.max()) + volume.ambient_n > HIGHEST_INDEX:
        raise SceneError("n", f"reaches {float(volume.delta_n.max()) + volume.ambient_n:g}", "no matter is above 100")
    for name in ("absorption", "scattering", "emission"):
        values = getattr(volume, name)
        if values is not None and float(values.min()) < 0.0:
            raise SceneError(name, f"has {float(values.min()):g}", "use 0 or more")
    if volume.anisotropy is not None and float(np.abs(volume.anisotropy).max()) >= 1.0:
        raise SceneError("anisotropy", "has values outside (-1, 1)", "it is a mean cosine")
    if volume.reflection is not None and not 0.0 <= volume.reflection.min() <= volume.reflection.max() <= 1.0:
        raise SceneError("reflection", "has values outside 0 to 1", "give tint and roughness")
    if volume.opaque is not None:
        coverage = volume.opaque[..., 3]
        if float(coverage.min()) < 0.0 or float(coverage.max()) > 1.0:
            raise SceneError("opaque", "has a coverage outside 0 to 1")
        if float(volume.opaque.min()) < 0.0:
            raise SceneError("opaque", "has a negative colour")


def check_crystal(volume: Volume) -> None:
    """What varies inside a crystal belongs to the first region."""
    for name in ("optic_axis", "delta_n_e"):
        if getattr(volume, name) is not None and not volume.regions:
            raise SceneError(name, "is given without regions", "a crystal is a region with a sharp surface")
    if volume.delta_n_e is None:
        if volume.optic_axis is not None and not volume.regions[0].medium.is_uniaxial:
            reason = f"is given, but {volume.regions[0].medium.name} has one index"
            raise SceneError("optic_axis", reason, "use a crystal such as calcite, media.uniaxial, or give delta_n_e")
        return
    if volume.optic_axis is None and volume.regions[0].optic_axis is None:
        raise SceneError("delta_n_e", "is given without an axis", "give optic_axis, or that of the first region")
    lowest, highest = float(volume.delta_n_e.min()), float(volume.delta_n_e.max())
    if lowest + volume.ambient_n <= 0.0 or highest + volume.ambient_n > HIGHEST_INDEX:
        raise SceneError("delta_n_e", "makes an index that is not between 0 and 100")
