"""How carefully rays are bent: the numbers that trade time for accuracy."""

from __future__ import annotations

from dataclasses import dataclass

from pellucid.scene import checks
from pellucid.scene.placement import Value, store

METHODS = ("leapfrog", "euler")


@dataclass(frozen=True)
class Quality(Value):
    """Integration of rays through a refractive volume.

    Parameters
    ----------
    method : ``"leapfrog"`` (second order) or ``"euler"`` (first order, for comparison).
    step_voxels : longest step in matter whose index varies, in voxels, above 0 up to 16.
    adaptive : jump through matter that does not vary, and shorten steps where rays bend strongly.
    max_steps : a ray that needs more is given up, 1 to 50 000.
    bounces : crossings of sharp boundaries that one ray follows, 0 to 64; then it sees the environment.
    min_weight : a ray that carries less than this share of the light sees the environment straight away.

    Raises
    ------
    SceneError : a value out of range.
    """

    method: str = "leapfrog"
    step_voxels: float = 0.5
    adaptive: bool = True
    max_steps: int = 4000
    bounces: int = 8
    min_weight: float = 0.01

    def __post_init__(self) -> None:
        store(
            self,
            method=checks.choice("quality.method", self.method, METHODS),
            step_voxels=checks.number("quality.step_voxels", self.step_voxels, low=1e-3, high=16.0, unit="voxels"),
            adaptive=checks.flag("quality.adaptive", self.adaptive),
            max_steps=checks.integer("quality.max_steps", self.max_steps, low=1, high=50_000),
            bounces=checks.integer("quality.bounces", self.bounces, low=0, high=64),
            min_weight=checks.number("quality.min_weight", self.min_weight, low=0.0, high=0.999),
        )
