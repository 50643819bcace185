"""Bodies: what the passes of this technique work on. A placed volume is a body."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from pellucid.scene import Quality, RefractiveVolume, Water
    from pellucid.techniques.eikonal.hulls import Hull
    from pellucid.techniques.eikonal.prepare import Prepared
    from pellucid.techniques.eikonal.proxies import Box
    from pellucid.techniques.eikonal.resources import VolumeTextures


@dataclass(eq=False)
class Body:
    """One box of matter on the device.

    Attributes
    ----------
    objects : the objects of the scene that it stands for.
    prepared, textures : its volume, shared with other bodies of the same volume.
    uniforms : one VolumeParams buffer for each channel of `prepared`.
    world : (4, 4) float64, object to world.
    box : its proxy, object metres.
    hull : where rays of the picture begin, within the box.
    quality : how carefully rays are bent.
    number : its place among the bodies of the scene.
    meets_meshes : opaque meshes reach into its box. water : it reaches into that.
    light : textures "fluence_field" and "light_field" over the prepared box, once light has been followed through it.
    """

    objects: tuple[RefractiveVolume, ...]
    prepared: Prepared
    textures: VolumeTextures
    uniforms: list[Any]
    world: np.ndarray
    box: Box
    quality: Quality
    hull: Hull
    number: int = 0
    meets_meshes: bool = False
    water: Water | None = None
    light: dict[str, Any] = field(default_factory=dict)

    def write_water(self, record: np.ndarray) -> None:
        """Fill in what VolumeParams says of the water that it reaches into: there, what is ambient changes."""
        if self.water is not None:
            record["wet_low"], record["wet_high"] = self.water.bounds_m
            record["wet_level_m"] = self.water.level
            record["wet_n"], record["dry_n"] = self.water.matter.n_d, self.water.ambient_n

    @property
    def around(self) -> tuple[Any, ...]:
        """What refraction at its surfaces depends on besides it."""
        water = self.water
        return () if water is None else (water.bounds_m, water.level, water.matter.n_d, water.ambient_n)
