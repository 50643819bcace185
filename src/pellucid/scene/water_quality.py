"""How water is drawn: each step selectable, and named sets of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

from pellucid.scene import checks
from pellucid.scene.choices import Choices
from pellucid.scene.placement import store

REFRACTIONS = ("rays", "march", "iteration")
REFLECTIONS = ("rays", "march", "point", "environment")
FRESNELS = ("exact", "schlick")
COLORS = ("physical", "mihalik")
UNDERSIDES = ("exact", "mihalik")
CAUSTICS = ("gpu", "cpu", "none")
CAUSTIC_CAMERAS = ("refracted", "incident")
CAUSTIC_INTERSECTIONS = ("march", "iteration")
FALLBACKS = ("rays", "environment")
CAMERAS = ("fitted", "mihalik")
TECHNIQUES = ("best", "fast", "mihalik")


@dataclass(frozen=True, eq=False, repr=False)
class WaterQuality(Choices):
    """What a ray that meets water sees, and what light does in it.

    What is given counts in every technique of the water; the technique chooses what is left out.

    Parameters
    ----------
    refraction : what a refracted ray sees below the surface: the meshes themselves (``"rays"``), or a picture taken by
        a camera of its own, met by a ``"march"`` through its depth, or by the ``"iteration"`` of [mihalik2008, 7.1].
    reflection : likewise above it; ``"point"`` takes the picture a fixed way along the mirrored ray
        [mihalik2008, eq. 6], ``"environment"`` sees no meshes.
    steps : of the iteration, 1 to 64.
    march_steps : of a march, 1 to 256.
    texture_size : side of those pictures, texels, 16 to 8192.
    cameras : where they are taken from: ``"fitted"`` to the rays of the visible surface, or the camera turned by the
        ray of its lower border, mirrored, and widened ([mihalik2008, 5.1, 5.2], ``"mihalik"``).
    field_of_view : how much more than the camera they show, 1 to 4 [mihalik2008, 5.2]; at most, where they are fitted.
    cull_back_faces : meshes are cut at the surface in these pictures; leave out their backs before, which would be
        seen in the cut [mihalik2008, 5.1].
    point_distance_m : way along the mirrored ray, metres > 0 (c of [mihalik2008, eq. 6]).
    underside_distance_m : the same from below (m of [mihalik2008, eqs. 13, 15]).
    fallback : what counts where a picture has no answer: ``"rays"`` to the meshes, or the ``"environment"``; below the
        surface that is what the border of the picture shows.
    fresnel : ``"exact"``, or ``"schlick"`` with the exponent `schlick_power` > 0.
    color : attenuation by what the water holds (``"physical"``), or towards one colour [mihalik2008, eqs. 4, 5].
    underside : from below, ``"exact"`` refraction with its window, or the rays of [mihalik2008, eq. 12].
    shading_rate : pixels that share one look at the water, 1 to 16, in blocks that cover about squares of it; what cuts
        the water stays sharp. A camera within the water, or without perspective, looks for every pixel.
    caustics : light that waves focus below them, worked out on the ``"gpu"``, the ``"cpu"``, or not at all.
    caustic_size : side of the map of it, texels, 16 to 4096.
    caustic_camera : looks along the ``"refracted"`` light or the ``"incident"`` one, as [mihalik2008, 8] does.
    caustic_intersection : how its photons find the bottom.
    shadows : meshes throw shadows below the water.
    glow : how much lamps that are mirrored glow, 0 or more [mihalik2008, 9.3]; `Scene.glow` does that for all that is
        bright.
    god_rays : beams in the water, from a march along each view ray.

    Raises
    ------
    SceneError : a value out of range.
    """

    refraction: str = "rays"
    reflection: str = "rays"
    steps: int = 3
    march_steps: int = 16
    texture_size: int = 512
    cameras: str = "fitted"
    field_of_view: float = 1.5
    cull_back_faces: bool = False
    point_distance_m: float = 1.0
    underside_distance_m: float = 1.5
    fallback: str = "rays"
    fresnel: str = "exact"
    schlick_power: float = 5.0
    color: str = "physical"
    underside: str = "exact"
    shading_rate: int = 1
    caustics: str = "gpu"
    caustic_size: int = 256
    caustic_camera: str = "refracted"
    caustic_intersection: str = "march"
    shadows: bool = True
    god_rays: bool = False
    glow: float = 0.0

    @classmethod
    def of(cls, technique: str, **fields: Any) -> Self:
        """The quality of a named technique, with some fields otherwise; draws so whatever the water's technique is.

        Parameters
        ----------
        technique : ``"best"``, ``"fast"`` or ``"mihalik"``. fields : any field.
        """
        known = checks.choice("water_quality.technique", technique, TECHNIQUES)
        return cls(**(_preset(known) | fields))

    def __post_init__(self) -> None:
        for name, options in _CHOICES.items():
            checks.choice(f"water_quality.{name}", getattr(self, name), options)
        for name in ("shadows", "god_rays", "cull_back_faces"):
            checks.flag(f"water_quality.{name}", getattr(self, name))
        for name, (low, high) in _WHOLE.items():
            store(self, **{name: checks.integer(f"water_quality.{name}", getattr(self, name), low=low, high=high)})
        store(
            self,
            field_of_view=checks.number("water_quality.field_of_view", self.field_of_view, low=1.0, high=4.0),
            glow=checks.number("water_quality.glow", self.glow, low=0.0),
            point_distance_m=_length("point_distance_m", self.point_distance_m),
            underside_distance_m=_length("underside_distance_m", self.underside_distance_m),
            schlick_power=checks.number("water_quality.schlick_power", self.schlick_power, low=0.0, exclusive=True),
        )


def _length(name: str, value: float) -> float:
    return checks.number(f"water_quality.{name}", value, low=0.0, exclusive=True, unit="metres")


_CHOICES = {
    "refraction": REFRACTIONS,
    "reflection": REFLECTIONS,
    "fallback": FALLBACKS,
    "cameras": CAMERAS,
    "fresnel": FRESNELS,
    "color": COLORS,
    "underside": UNDERSIDES,
    "caustics": CAUSTICS,
    "caustic_camera": CAUSTIC_CAMERAS,
    "caustic_intersection": CAUSTIC_INTERSECTIONS,
}
_WHOLE = {
    "steps": (1, 64),
    "march_steps": (1, 256),
    "texture_size": (16, 8192),
    "caustic_size": (16, 4096),
    "shading_rate": (1, 16),
}
_PRESETS: dict[str, dict[str, Any]] = {
    "best": {},
    "fast": {
        "refraction": "march",
        "reflection": "march",
        "march_steps": 8,
        "fallback": "environment",
        "shading_rate": 8,
        "texture_size": 320,
        "caustic_size": 256,
    },
    "mihalik": {
        "refraction": "iteration",
        "reflection": "point",
        "cameras": "mihalik",
        "cull_back_faces": True,
        "fallback": "environment",
        "fresnel": "schlick",
        "color": "mihalik",
        "underside": "mihalik",
        "glow": 1.0,
        "caustics": "cpu",
        "caustic_camera": "incident",
        "caustic_intersection": "iteration",
    },
}


def quality_of(technique: str, quality: WaterQuality) -> WaterQuality:
    """What a named technique makes of a quality: its own choice of every field that was not given.

    Parameters
    ----------
    technique : one of ``TECHNIQUES``.
    """
    return quality.fill_in(**_preset(technique))


def _preset(technique: str) -> dict[str, Any]:
    """The choice of a technique for every field that any technique has a choice of its own for."""
    plain = WaterQuality()
    chosen = {name: getattr(plain, name) for preset in _PRESETS.values() for name in preset}
    return chosen | _PRESETS[technique]
