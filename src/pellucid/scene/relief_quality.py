"""How carefully a relief is drawn, and the named steps from plain colour to everything."""

from __future__ import annotations

from dataclasses import dataclass

from pellucid.errors import SceneError
from pellucid.scene import checks
from pellucid.scene.choices import Choices
from pellucid.scene.placement import store

SEARCHES = ("linear", "distance", "cone", "max_mip")
REFRACTIONS = ("search", "plane")
REFLECTIONS = ("environment", "plane", "search")
SHADOWS = ("none", "hard", "soft", "horizon")
OCCLUSIONS = ("none", "fragment", "texture")
ENVIRONMENTS = ("rays", "map", "cube_once", "cube_every_frame")
SHOWS = ("radiance", "shares", "ways", "mirrored", "refracted", "lamps")
STEPS = ("color", "normal", "offset", "relief", "two_layer", "occlusion", "occlusion_hue", "best")
TECHNIQUES = (*STEPS, *(f"{step}_thesis" for step in STEPS))


@dataclass(frozen=True, eq=False, repr=False)
class ReliefQuality(Choices):
    """Searches along rays, and what light does in the relief.

    What is given counts in every technique of the surface; the technique chooses what is left out.

    Parameters
    ----------
    search : how a ray finds the surface: ``"cone"`` jumps as far as a map of free space says, ``"max_mip"`` goes
        down a pyramid of highest heights; both miss nothing, and the second serves heights that move. ``"linear"``
        takes equal steps, and ``"distance"`` steps as long as the nearest matter is away.
    linear_steps, binary_steps : of a linear search, 1 to 1024 and 0 to 32.
    linear_approximation : end it on the line between the last two heights.
    refraction_steps : linear and binary steps of rays in the translucent layer.
    refraction : ``"search"`` for the solid layer along the refracted ray, or meet a ``"plane"`` as deep as the layer
        is where the ray enters.
    refraction_pieces : straight pieces of a refracted ray that a search follows, 1 to 16: total reflections within the
        matter, ways out of it and in again. The next is taken to end on what lies below.
    adapt_angle, adapt_distance : take fewer steps where the view is steep, or the relief far away.
    complexity : take fewer steps where the heights are simple.
    reflection : what mirrored rays see: the ``"environment"`` (see below), with ``"plane"`` first the relief as if it
        were flat, with ``"search"`` the relief itself.
    shadows : of the solid layer on itself: ``"hard"`` for a ray to the middle of each lamp, ``"soft"`` for the share
        of the lamp's disc that is seen, ``"horizon"`` for the same from a map made beforehand.
        Where `occlusion` is on, ``"none"`` counts as ``"hard"``: light that the solid layer stops reaches nothing.
    shadow_steps : steps of a ray towards a lamp where `search` is linear, 1 to 256.
    occlusion : what the translucent layer takes from light on its way to the solid one, beyond what lies right above
        each point: nothing, worked out in every ``"fragment"``, or, shadows included, once a light has moved in a
        ``"texture"``. Textures hold on plane meshes, for lamps far away or a single tile; else it is fragments.
    hue : light on its way through the translucent layer is tinted; else it is dimmed evenly.
    caustics : the translucent layer focuses light on the solid one.
    silhouettes : rays may leave the relief over the horizon; else they go on until they meet something.
    environment : rays that leave meet the meshes of the scene (``"rays"``), or see the environment alone (``"map"``),
        or the scene in a cube drawn from the middle of the object, once or for every picture.
    show : what the picture holds of the translucent layer: its ``"radiance"``; in false colours its ``"shares"``, red
        what it reflects and blue what it lets through, or the ``"ways"`` of mirrored rays, red where they end on the
        relief and blue where they leave it; or, all else left out, what is ``"mirrored"``, or ``"refracted"``, as if
        all light were, or the ``"lamps"`` that it mirrors.

    Raises
    ------
    SceneError : a value out of range.
    """

    search: str = "cone"
    linear_steps: int = 24
    binary_steps: int = 6
    linear_approximation: bool = True
    refraction_steps: tuple[int, int] = (8, 5)
    refraction: str = "search"
    refraction_pieces: int = 4
    adapt_angle: bool = True
    adapt_distance: bool = True
    complexity: bool = False
    reflection: str = "environment"
    shadows: str = "soft"
    shadow_steps: int = 16
    occlusion: str = "texture"
    hue: bool = True
    caustics: bool = False
    silhouettes: bool = True
    environment: str = "rays"
    show: str = "radiance"

    def __post_init__(self) -> None:
        for name, options in _CHOICES.items():
            checks.choice(f"relief_quality.{name}", getattr(self, name), options)
        for name in ("linear_approximation", "adapt_angle", "adapt_distance", "complexity", "hue", "caustics"):
            checks.flag(f"relief_quality.{name}", getattr(self, name))
        checks.flag("relief_quality.silhouettes", self.silhouettes)
        given = self.refraction_steps
        if not isinstance(given, tuple | list) or len(given) != 2:
            raise SceneError("relief_quality.refraction_steps", f"must be (linear, binary), got {given!r}")
        store(
            self,
            linear_steps=checks.integer("relief_quality.linear_steps", self.linear_steps, low=1, high=1024),
            binary_steps=checks.integer("relief_quality.binary_steps", self.binary_steps, low=0, high=32),
            refraction_pieces=checks.integer(
                "relief_quality.refraction_pieces", self.refraction_pieces, low=1, high=16
            ),
            shadow_steps=checks.integer("relief_quality.shadow_steps", self.shadow_steps, low=1, high=256),
            refraction_steps=(
                checks.integer("relief_quality.refraction_steps[0]", given[0], low=1, high=1024),
                checks.integer("relief_quality.refraction_steps[1]", given[1], low=0, high=32),
            ),
        )


_CHOICES = {
    "search": SEARCHES,
    "refraction": REFRACTIONS,
    "reflection": REFLECTIONS,
    "shadows": SHADOWS,
    "occlusion": OCCLUSIONS,
    "environment": ENVIRONMENTS,
    "show": SHOWS,
}
_THESIS = {
    "search": "linear",
    "linear_steps": 24,
    "binary_steps": 6,
    "linear_approximation": True,
    "refraction_steps": (8, 5),
    "refraction": "search",
    "refraction_pieces": 1,
    "adapt_angle": False,
    "adapt_distance": False,
    "complexity": False,
    "reflection": "plane",
    "shadow_steps": 16,
    "environment": "map",
}


def quality_of(technique: str, quality: ReliefQuality) -> ReliefQuality:
    """What a named technique makes of a quality: its own choice of the fields that were not given.

    The steps of [timonen2006, table 1] take away what comes later.

    Parameters
    ----------
    technique : one of ``TECHNIQUES``; those that end in ``_thesis`` search as the thesis does.
    """
    step, thesis = technique.removesuffix("_thesis"), technique.endswith("_thesis")
    changes: dict[str, object] = dict(_THESIS) if thesis else {}
    rank = STEPS.index(step)
    if rank < STEPS.index("occlusion"):
        changes |= {"shadows": "none", "occlusion": "none", "caustics": False}
    elif step != "best":
        changes |= {"occlusion": "fragment" if thesis else "texture", "caustics": False}
        changes |= {"hue": step == "occlusion_hue"}
        changes |= {"shadows": "hard"} if thesis else {}
    elif thesis:
        changes |= {"occlusion": "fragment", "hue": True}
    return quality.fill_in(**changes)
