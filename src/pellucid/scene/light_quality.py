"""How carefully light is followed through a refractive volume."""

from __future__ import annotations

from dataclasses import dataclass

from pellucid.scene import checks
from pellucid.scene.placement import Value, store

LIGHT_METHODS = ("flux", "intensity")


@dataclass(frozen=True)
class LightQuality(Value):
    """The light simulator of a refractive volume.

    Parameters
    ----------
    fluence_voxels : edge of a voxel of the fluence, in voxels of the volume, 1 to 8. With 2 light takes about a quarter
        of the time, and its edges are twice as soft.
    front_voxels : edge of a patch of the front where it enters the box, in voxels of the fluence, 0.1 to 8.
    split_voxels : a patch that has grown wider is divided in two, 0.25 to 8 voxels of the fluence.
    bounces : crossings of boundaries that light is followed through, 0 to 48.
    min_flux : light that carries less than this share of what its patch began with is given up, 0 to 0.5.
    method : ``"flux"`` adds what every patch carries to the voxels that it crosses, so that energy is kept and
        folded fronts add up; ``"intensity"`` is the intensity law with the strongest patch of a voxel alone
        [tevs2007, eq. 4.16 and 6.2.3], for comparison.
    caustics : whether the volume changes the light on meshes around it: its shadow, and what it focuses there.
    caustic_texels : texels of these along the longest edge of the volume's box, 8 to 4096.

    Raises
    ------
    SceneError : a value out of range.
    """

    fluence_voxels: float = 1.0
    front_voxels: float = 1.0
    split_voxels: float = 1.0
    bounces: int = 32
    min_flux: float = 1e-3
    method: str = "flux"
    caustics: bool = True
    caustic_texels: int = 256

    def __post_init__(self) -> None:
        store(
            self,
            fluence_voxels=checks.number("light.fluence_voxels", self.fluence_voxels, low=1.0, high=8.0, unit="voxels"),
            front_voxels=checks.number("light.front_voxels", self.front_voxels, low=0.1, high=8.0, unit="voxels"),
            split_voxels=checks.number("light.split_voxels", self.split_voxels, low=0.25, high=8.0, unit="voxels"),
            bounces=checks.integer("light.bounces", self.bounces, low=0, high=48),
            min_flux=checks.number("light.min_flux", self.min_flux, low=0.0, high=0.5),
            method=checks.choice("light.method", self.method, LIGHT_METHODS),
            caustics=checks.flag("light.caustics", self.caustics),
            caustic_texels=checks.integer("light.caustic_texels", self.caustic_texels, low=8, high=4096),
        )
