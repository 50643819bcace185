"""The whole of what is to be drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from pellucid.errors import SceneError
from pellucid.scene import checks
from pellucid.scene.camera import Camera
from pellucid.scene.environment import Environment
from pellucid.scene.placement import Light, SceneObject, Value, store

TONE_MAPPINGS = ("agx", "reinhard", "aces", "khronos", "linear")


@dataclass(frozen=True, eq=False)
class Scene(Value):
    """A camera, what surrounds it, what lights it, and what stands in it.

    Parameters
    ----------
    camera : the view.
    environment : light from all around; a photographer's studio unless given.
    lights : DirectionalLight, PointLight, AreaLight.
    objects : Mesh, RefractiveVolume and the other things that can be drawn.
    exposure : factor on the radiance before tone mapping, > 0.
    tone_mapping : ``"agx"``, ``"reinhard"``, ``"aces"``, ``"khronos"`` or ``"linear"``.
    glow : share of the light that a lens would scatter around bright things, 0 to 1; 0.02 to 0.1 look like one.
        In the picture for the screen only: radiance stays as it is.

    Raises
    ------
    SceneError : something of the wrong kind or out of range.
    """

    camera: Camera
    environment: Environment = field(default_factory=Environment.studio)
    lights: Sequence[Light] = ()
    objects: Sequence[SceneObject] = ()
    exposure: float = 1.0
    tone_mapping: str = "agx"
    glow: float = 0.0

    def __post_init__(self) -> None:
        _check_kind("scene.camera", self.camera, Camera, "give a Camera")
        _check_kind("scene.environment", self.environment, Environment, "such as Environment.studio()")
        store(
            self,
            lights=_members("scene.lights", self.lights, Light, "give lights, such as DirectionalLight(...)"),
            objects=_members("scene.objects", self.objects, SceneObject, _OBJECT_REMEDY),
            exposure=checks.number("scene.exposure", self.exposure, low=0.0, exclusive=True),
            tone_mapping=checks.choice("scene.tone_mapping", self.tone_mapping, TONE_MAPPINGS),
            glow=checks.number("scene.glow", self.glow, low=0.0, high=1.0),
        )


_OBJECT_REMEDY = "give objects, such as Mesh or RefractiveVolume; wrap a Volume in RefractiveVolume.from_volume"


def _members(name: str, value: Any, kind: type, remedy: str) -> tuple[Any, ...]:
    if isinstance(value, kind) or not isinstance(value, Sequence) or isinstance(value, str):
        raise SceneError(name, f"must be a list, got {type(value).__name__}", "put it in [ ]")
    for i, member in enumerate(value):
        _check_kind(f"{name}[{i}]", member, kind, remedy)
    return tuple(value)


def _check_kind(name: str, value: Any, kind: type, remedy: str) -> None:
    if not isinstance(value, kind):
        raise SceneError(name, f"cannot be {type(value).__name__!r}", remedy)
