"""Bodies: what the passes of this technique work on. A placed volume is a body."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from pellucid.scene import Quality, RefractiveVolume
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
    meets_meshes : opaque meshes reach into its box.
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
    light: dict[str, Any] = field(default_factory=dict)
