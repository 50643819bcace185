"""Natural water: a level with waves over an outline, filled with something clear or murky."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid import media
from pellucid.errors import SceneError
from pellucid.scene import checks
from pellucid.scene.placement import SceneObject, store
from pellucid.scene.water_outline import FLOORS, Corners, WaterShape, checked_outline, shape_of
from pellucid.scene.water_quality import TECHNIQUES, WaterQuality

if TYPE_CHECKING:
    from pellucid.media import Medium

WIDEST_M = 1e7  # positions are 32-bit floats on the device


@dataclass(frozen=True, eq=False)
class Water(SceneObject):
    """Water that fills an outline below its surface, down to the meshes, or endlessly where there are none.

    Above it is air. Meshes may cross the surface and stand at its borders. A rectangle without a depth is a part of
    a larger water: where nothing stands at its borders they are cuts, through which light goes straight. All else has
    borders of its own, which refract and mirror light from both sides.

    Parameters
    ----------
    level : height of the surface at rest, metres along y.
    extent_m : size along x and z, metres; one number for a square. That of a polygon is what its corners span.
    center : (x, z) of the middle, metres.
    outline : ``"rectangle"``, or the ``"ellipse"`` within it, or corners (N, 2) of a convex polygon, (x, z) from
        `center`, metres.
    depth_m : of a floor of its own below the level, metres > 0. None: down to the meshes, or endlessly.
    floor : ``"flat"``; or ``"round"``, an ellipse's: part of an ellipsoid, of a ball if the outline is round.
    floor_scale : size of a flat floor over that of the outline, 0 to 1; less than 1 for trays and buckets.
    waves : heights over the level that may move: a source of ``fields.waves``, anything with `shape`, `tile_m`,
        `limits_m` and `advance(time_s)`. A periodic one repeats over the rectangle. None for a flat surface.
    medium : a name, a Medium, or an index; a ``media.WaterBody`` scatters, such as ``"coastal"``.
    ambient_n : index of what is above.
    technique : ``"best"`` draws all that `quality` asks for, ``"fast"`` from pictures instead of rays, ``"mihalik"`` as
        [mihalik2008]; what `quality` says otherwise counts in each.
    quality : how it is drawn.
    foam : crests foam where waves fold the surface to less than this share of its area at rest, 0 (none) to 1. Only
        waves that move water sideways fold it, such as ``fields.waves.Ocean``.
    color, clarity_per_m : colour of deep water, and how fast it covers what is below, 1/m, where the quality's colour
        is ``"mihalik"`` (C_water and k of [mihalik2008, eqs. 4, 5]).
    dispersion : refract red, green and blue apart.

    Raises
    ------
    SceneError : values of the wrong kind or out of range.
    """

    level: float = 0.0
    extent_m: float | tuple[float, float] = (20.0, 20.0)
    center: tuple[float, float] = (0.0, 0.0)
    waves: Any = None
    medium: str | Medium | float = "water"
    ambient_n: float = 1.0
    technique: str = "best"
    quality: WaterQuality = field(default_factory=WaterQuality)
    foam: float = 0.0
    color: checks.Vector = (0.0, 0.2, 0.1)
    clarity_per_m: float = 0.5
    dispersion: bool = False
    outline: Any = "rectangle"
    depth_m: float | None = None
    floor: str = "flat"
    floor_scale: float = 1.0

    def __post_init__(self) -> None:
        if not isinstance(self.quality, WaterQuality):
            raise SceneError("water.quality", f"cannot be {type(self.quality).__name__!r}", "give a WaterQuality")
        outline = checked_outline(self.outline)
        store(
            self,
            level=checks.number("water.level", self.level, low=-WIDEST_M, high=WIDEST_M, unit="metres"),
            extent_m=_extent(self.extent_m) if isinstance(outline, str) else _spanned(outline),
            center=_pair("water.center", self.center, low=-WIDEST_M),
            waves=_checked_waves(self.waves),
            medium=media.resolve(self.medium, "water.medium"),
            ambient_n=checks.number("water.ambient_n", self.ambient_n, low=0.0, exclusive=True),
            technique=checks.choice("water.technique", self.technique, TECHNIQUES),
            foam=checks.number("water.foam", self.foam, low=0.0, high=1.0),
            color=checks.color("water.color", self.color),
            clarity_per_m=checks.number("water.clarity_per_m", self.clarity_per_m, low=0.0, unit="1/m"),
            dispersion=checks.flag("water.dispersion", self.dispersion),
            outline=outline,
            depth_m=None if self.depth_m is None else _depth(self.depth_m),
            floor=checks.choice("water.floor", self.floor, FLOORS),
            floor_scale=checks.number("water.floor_scale", self.floor_scale, low=0.0, high=1.0),
        )
        self._check_floor()

    @property
    def position(self) -> checks.Vector:  # type: ignore[override]
        """Middle of the surface at rest, metres."""
        return self.center[0], self.level, self.center[1]

    @property
    def rotation(self) -> checks.Vector:  # type: ignore[override]
        """Water lies level: no rotation."""
        return 0.0, 0.0, 0.0

    @property
    def scale(self) -> float:  # type: ignore[override]
        """Water is given in metres: 1."""
        return 1.0

    @property
    def matter(self) -> Medium:
        """The medium, which knows index, absorption and scattering."""
        return media.resolve(self.medium)

    @property
    def bounds_m(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Lowest and highest (x, z) of the outline, metres."""
        (x, z), (width, depth) = self.center, self.size_m
        if not isinstance(self.outline, str):
            low, high = np.min(self.outline, axis=0), np.max(self.outline, axis=0)
            return (x + float(low[0]), z + float(low[1])), (x + float(high[0]), z + float(high[1]))
        return (x - 0.5 * width, z - 0.5 * depth), (x + 0.5 * width, z + 0.5 * depth)

    @property
    def shape(self) -> WaterShape:
        """The space below its surface."""
        return shape_of(self.outline, self.center, self.size_m, (self.depth_m, self.floor, self.floor_scale))

    @property
    def box_m(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Lowest and highest (x, y, z) of the water at rest, metres."""
        (low_x, low_z), (high_x, high_z) = self.bounds_m
        wider = 0.5 * (self.shape.widest - 1.0)
        x, z = wider * (high_x - low_x), wider * (high_z - low_z)
        floor = -np.inf if self.depth_m is None else self.level - self.depth_m
        return (low_x - x, floor, low_z - z), (high_x + x, self.level, high_z + z)

    @property
    def size_m(self) -> tuple[float, float]:
        """Size along x and z, metres."""
        return self.extent_m  # type: ignore[return-value]

    def _check_floor(self) -> None:
        if self.floor == "round" and self.outline != "ellipse":
            raise SceneError("water.floor", "can be round below an ellipse only", 'give outline="ellipse"')
        if self.depth_m is None and (self.floor == "round" or self.floor_scale != 1.0):
            field = "water.floor" if self.floor == "round" else "water.floor_scale"
            raise SceneError(field, "needs to know how deep the floor is", "give depth_m")
        if self.floor == "round" and self.floor_scale != 1.0:
            raise SceneError("water.floor_scale", "is that of a flat floor", 'give floor="flat", or no floor_scale')

    def drop(self, x_m: float, z_m: float, radius_m: float, strength_m: float, time_s: float | None = None) -> Any:
        """Something falls into the water; see ``fields.waves.Ripples.drop``. x and z are metres of the world.

        Raises
        ------
        SceneError : no waves of this water can be disturbed, or the place is outside of them.
        """
        x, z = checks.number("drop.x_m", x_m, unit="metres"), checks.number("drop.z_m", z_m, unit="metres")
        for source in (self.waves, *getattr(self.waves, "layers", ())):
            if hasattr(source, "drop"):
                return source.drop(x - self.center[0], z - self.center[1], radius_m, strength_m, time_s)
        raise SceneError("water.waves", "cannot be disturbed", "give Ripples, alone or in a Sum")


def _extent(value: Any) -> tuple[float, float]:
    pair = (value, value) if np.ndim(value) == 0 and not isinstance(value, str) else value
    return _pair("water.extent_m", pair, low=0.0, exclusive=True)


def _spanned(corners: Corners) -> tuple[float, float]:
    low, high = np.min(corners, axis=0), np.max(corners, axis=0)
    return float(high[0] - low[0]), float(high[1] - low[1])


def _depth(value: Any) -> float:
    return checks.number("water.depth_m", value, low=0.0, high=WIDEST_M, exclusive=True, unit="metres")


def _pair(name: str, value: Any, *, low: float, exclusive: bool = False) -> tuple[float, float]:
    if isinstance(value, str) or np.ndim(value) != 1 or len(value) != 2:
        raise SceneError(name, f"must be two numbers, got {value!r:.60}", "give metres along x and along z")
    x, z = (
        checks.number(f"{name}[{i}]", v, low=low, high=WIDEST_M, exclusive=exclusive, unit="metres")
        for i, v in enumerate(value)
    )
    return x, z


def _checked_waves(value: Any) -> Any:
    from pellucid.fields.dynamic import DynamicHeights

    if value is None or (isinstance(value, DynamicHeights) and not isinstance(value, type)):
        return value
    remedy = "give a source of fields.waves, or None for a flat surface"
    raise SceneError("water.waves", f"cannot be {type(value).__name__!r}", remedy)
