"""A sheet that refracts a flat picture below it, as water in games did before pixels could think [oliveira2000b]."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from pellucid import media
from pellucid.errors import AssetError, SceneError
from pellucid.scene import checks
from pellucid.scene.mesh import Mesh
from pellucid.scene.placement import Filled, check_placement, store
from pellucid.scene.sphere_maps import RULES

if TYPE_CHECKING:
    from pellucid.media import Medium

PICTURES = ("picture", "sphere_map")
REFRACTIONS = ("exact", "approximate")
PLACES = ("fragment", "vertex")
BORDERS = ("clamp", "shrink")
REFLECTIONS = ("rays", "environment", "sphere_map", "none")
SHOWS = ("radiance", "error", "error_uv", "error_values", "uv")
MOST_SEGMENTS = 1024
MOST_VERTICES = 2_000_000
MOST_TEXELS = 8192


@dataclass(frozen=True, eq=False)
class RefractiveSheet(Filled):
    """A surface in motion, and `depth_m` below its level a flat picture that is seen through it [oliveira2000b].

    In its own coordinates the sheet is level at y = 0, the picture lies at y = -depth_m and is as large as the sheet in
    x and z, its top towards -z. `scale` enlarges all of it. From above, each ray is refracted, followed to the plane of
    the picture, and the point there taken for a place in the picture; what is reflected sees the surroundings. From
    below it is the other way round: the picture is seen where reflection is total, else the surroundings.

    Parameters
    ----------
    picture : (H, W, 3) linear radiance (reflectance if `lit`), sRGB when of uint8 or uint16; or the path of a picture.
    depth_m : of the picture below the level of the sheet, > 0.
    size_m : of the sheet along x and z, one number or two; not with `mesh`.
    waves : heights in metres over the sheet: (H, W), as wide as it is, or anything that moves by itself
        (``fields.dynamic.DynamicHeights``, such as ``fields.waves.Ripples``), with metres of its own about the middle.
        None for a level sheet.
    segments : cells of the grid along its longer side, 1 to 1024; by default as many as `waves` have, at most 256.
    mesh : a surface of the user's own instead of a grid: its geometry counts. y is the height above the level.
    motion : how that mesh moves: (T, V, 3) positions of its vertices, or a function of the time in seconds that gives
        (V, 3). motion_fps : how many of the T follow one another in a second.
    medium : below the sheet: a name, a Medium or an index. ambient_n : index above it.
    refraction : ``"exact"`` by Snell's law, or ``"approximate"``: incident + `factor` * inverted normal.
    factor : of the approximation, >= 0; None for the best one for the two indices up to `fit_angle_deg`.
    fit_angle_deg : largest angle of incidence, 0 to 90, that the factor is fitted to.
    per : everything is worked out in every ``"fragment"``, or at each ``"vertex"`` and interpolated.
    borders : rays that miss the picture see its border (``"clamp"``), or the picture is stretched until none misses
        (``"shrink"``: the limits shrink to the largest deviation of all vertices as the camera sees them).
    deviation_m : with ``"shrink"``, this deviation to all sides, so that nothing is stretched as the camera moves.
    reflection : ``"rays"`` meet the meshes of the scene and its environment; the ``"environment"`` alone; a picture
        by `sphere_map`; or ``"none"``.
    sphere_map : as `picture`. sphere_rule : ``"ball"`` or ``"linear"``, see `scene.sphere_maps`.
    blend : share that is reflected, 0 to 1; None for Fresnel's law.
    lit : the picture is matt matter lit by the scene's lamps and sky through the sheet; else it is seen as it is.
    meshes : meshes of the scene between sheet and picture are seen (per fragment only).
    absorption : between sheet and picture, 1/m by channel; that of the medium when None.
    show : ``"radiance"``; or how far refraction as chosen lands from Snell's law in every fragment: false colours in
        metres (``"error"``) or widths of the picture (``"error_uv"``), or as numbers in metres (``"error_values"``: how
        far, along x, along z); or ``"uv"``: u, v, and the share of the picture in what is seen.
    error_scale : the last colour, metres or widths of the picture, > 0.
    position, rotation, scale : metres, degrees about x, y, z in this order, one factor > 0.
    files : the pictures that arrays were read from; filled in by reading.

    Raises
    ------
    SceneError : values of the wrong kind or out of range, heights that reach down to the picture.
    AssetError : a picture that cannot be used.
    """

    picture: Any
    depth_m: float = 0.3
    size_m: float | tuple[float, float] = 1.0
    waves: Any = None
    segments: int | None = None
    mesh: Mesh | None = None
    motion: np.ndarray | Callable[[float], Any] | None = None
    motion_fps: float = 25.0
    medium: str | Medium | float = "water"
    ambient_n: float = 1.0
    refraction: str = "exact"
    factor: float | None = None
    fit_angle_deg: float = 60.0
    per: str = "fragment"
    borders: str = "clamp"
    deviation_m: float | None = None
    reflection: str = "rays"
    sphere_map: Any = None
    sphere_rule: str = "ball"
    blend: float | None = None
    lit: bool = False
    meshes: bool = True
    absorption: checks.Vector | None = None
    show: str = "radiance"
    error_scale: float = 0.05
    position: checks.Vector = (0.0, 0.0, 0.0)
    rotation: checks.Vector = (0.0, 0.0, 0.0)
    scale: float = 1.0
    files: Mapping[str, tuple[str, np.ndarray]] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        self._store_pictures()
        self._store_looks()
        store(
            self,
            **check_placement("refractive_sheet", self.position, self.rotation, self.scale),
            depth_m=_positive("depth_m", self.depth_m, "metres"),
            medium=media.resolve(self.medium, "refractive_sheet.medium"),
            ambient_n=_positive("ambient_n", self.ambient_n),
            motion_fps=_positive("motion_fps", self.motion_fps),
            error_scale=_positive("error_scale", self.error_scale),
        )
        if self.mesh is None:
            self._store_grid()
        else:
            self._store_mesh()

    @classmethod
    def article(cls, picture: Any, **look: Any) -> Self:
        """The sheet of [oliveira2000b] as it is there: approximate and per vertex, clamped, no absorption.

        Parameters
        ----------
        look : any other field; it wins.
        """
        own: dict[str, Any] = {"refraction": "approximate", "per": "vertex", "absorption": (0.0, 0.0, 0.0)}
        mirrored = {"reflection": "sphere_map", "blend": 0.3} if "sphere_map" in look else {"reflection": "none"}
        return cls(picture, **(own | mirrored | look))

    @property
    def is_dynamic(self) -> bool:
        """Whether the sheet changes with time."""
        return self.motion is not None or hasattr(self.waves, "advance")

    @property
    def extents_m(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """((least, greatest) x, (least, greatest) z) of the sheet at rest, and of the picture."""
        if self.mesh is None:
            x, z = _pair(self.size_m)
            return (-0.5 * x, 0.5 * x), (-0.5 * z, 0.5 * z)
        low, high = self.mesh.vertices.min(axis=0), self.mesh.vertices.max(axis=0)
        return (float(low[0]), float(high[0])), (float(low[2]), float(high[2]))

    @property
    def cells(self) -> tuple[int, int]:
        """Cells of the grid along x and z."""
        shape = None if self.waves is None else tuple(self.waves.shape)
        x, z = _pair(self.size_m)
        count = self.segments or (64 if shape is None else min(max(shape), 256))
        edge = max(x, z) / count
        return max(1, round(x / edge)), max(1, round(z / edge))

    def vertices_at(self, time_s: float) -> np.ndarray:
        """(V, 3) float64 positions of the mesh at a time.

        Raises
        ------
        SceneError : the motion gives another shape, values that are not finite, or reaches down to the picture.
        """
        assert self.mesh is not None
        if self.motion is None:
            return np.asarray(self.mesh.vertices, np.float64)
        if isinstance(self.motion, np.ndarray):
            at = min(max(time_s * self.motion_fps, 0.0), len(self.motion) - 1.0)
            first = min(int(at), len(self.motion) - 1)
            share, following = at - first, min(first + 1, len(self.motion) - 1)
            return (1.0 - share) * self.motion[first].astype(np.float64) + share * self.motion[following]
        found = checks.array("refractive_sheet.motion", self.motion(time_s), (len(self.mesh.vertices), 3), np.float64)
        self._check_above("motion", float(found[:, 1].min()))
        return found

    def _store_pictures(self) -> None:
        files = {name: kept for name, kept in self.files.items() if getattr(self, name) is kept[1]}
        for name in PICTURES:
            value = getattr(self, name)
            if isinstance(value, str | PathLike):
                pixels = checks.frozen(_picture(value))
                files[name] = (str(Path(fspath(value)).resolve()), pixels)
                store(self, **{name: pixels})
        if self.picture is None:
            raise SceneError("refractive_sheet.picture", "is missing", "give (H, W, 3) or the path of a picture")
        if self.reflection == "sphere_map" and self.sphere_map is None:
            raise SceneError(
                "refractive_sheet.sphere_map", "is missing", "give a picture, such as scene.sphere_map(sky)"
            )
        checked = {name: _checked_picture(name, getattr(self, name)) for name in PICTURES}
        store(self, files=files, **checked)

    def _store_looks(self) -> None:
        for name, options in _CHOICES.items():
            checks.choice(f"refractive_sheet.{name}", getattr(self, name), options)
        for name in ("lit", "meshes"):
            checks.flag(f"refractive_sheet.{name}", getattr(self, name))
        bounds: dict[str, dict[str, float]] = {"factor": {}, "deviation_m": {}, "blend": {"high": 1.0}}
        for name, limits in bounds.items():
            value = getattr(self, name)
            if value is not None:
                store(self, **{name: checks.number(f"refractive_sheet.{name}", value, low=0.0, **limits)})  # type: ignore[arg-type]
        angle = checks.number("refractive_sheet.fit_angle_deg", self.fit_angle_deg, low=0.0, high=90.0)
        given = self.absorption
        store(
            self,
            fit_angle_deg=angle,
            absorption=None if given is None else checks.color("refractive_sheet.absorption", given),
        )

    def _store_grid(self) -> None:
        store(self, size_m=_checked_size(self.size_m))
        if self.segments is not None:
            segments = checks.integer("refractive_sheet.segments", self.segments, low=1, high=MOST_SEGMENTS)
            store(self, segments=segments)
        if self.motion is not None:
            raise SceneError("refractive_sheet.motion", "is given without a mesh", "it moves the vertices of `mesh`")
        if self.waves is None:
            return
        from pellucid.fields.dynamic import DynamicHeights

        if isinstance(self.waves, DynamicHeights):
            self._check_above("waves", float(self.waves.limits_m[0]))
            return
        heights = checks.array("refractive_sheet.waves", self.waves, (None, None))
        if min(heights.shape) < 2 or max(heights.shape) > MOST_TEXELS:
            raise SceneError("refractive_sheet.waves", f"are {heights.shape}", f"use 2 to {MOST_TEXELS} a side")
        self._check_above("waves", float(heights.min()))
        store(self, waves=heights)

    def _store_mesh(self) -> None:
        mesh = self.mesh
        if not isinstance(mesh, Mesh):
            raise SceneError("refractive_sheet.mesh", f"cannot be {type(mesh).__name__!r}", "give a Mesh or None")
        for name in ("waves", "segments"):
            if getattr(self, name) is not None:
                raise SceneError(f"refractive_sheet.{name}", "are given with a mesh", "choose one of them")
        if len(mesh.vertices) > MOST_VERTICES:
            reason = f"has {len(mesh.vertices)} vertices"
            raise SceneError("refractive_sheet.mesh", reason, f"simplify it to at most {MOST_VERTICES}")
        for axis, (low, high) in zip("xz", self.extents_m, strict=True):
            if not high - low > 1e-9:
                raise SceneError(
                    "refractive_sheet.mesh", f"has no extent along {axis}", "it lies over x and z, y is up"
                )
        self._check_above("mesh", float(mesh.vertices[:, 1].min()))
        if self.motion is None or callable(self.motion):
            return
        motion = checks.array("refractive_sheet.motion", self.motion, (None, len(mesh.vertices), 3))
        self._check_above("motion", float(motion[..., 1].min()))
        store(self, motion=motion)

    def _check_above(self, name: str, lowest_m: float) -> None:
        if lowest_m <= -self.depth_m:
            reason = f"reach {-lowest_m:g} metres down, the picture lies {self.depth_m:g} below the level"
            raise SceneError(f"refractive_sheet.{name}", reason, "make the picture deeper or the waves lower")


_CHOICES = {
    "refraction": REFRACTIONS,
    "per": PLACES,
    "borders": BORDERS,
    "reflection": REFLECTIONS,
    "sphere_rule": RULES,
    "show": SHOWS,
}


def _picture(path: str | PathLike[str]) -> np.ndarray:
    from pellucid.io.images import read_image

    pixels = read_image(path)
    rgb = pixels[..., :3] if pixels.shape[2] >= 3 else np.repeat(pixels[..., :1], 3, axis=2)
    if not np.isfinite(rgb).all() or rgb.min() < 0.0:
        raise AssetError(path, "holds values that are negative or not finite", "it is radiance or reflectance")
    return np.ascontiguousarray(rgb)


def _checked_picture(name: str, value: Any) -> np.ndarray | None:
    if value is None:
        return None
    where = f"refractive_sheet.{name}"
    result = checks.picture(where, value, (None, None, 3))
    if max(result.shape) > MOST_TEXELS:
        raise SceneError(where, f"is {result.shape[1]} x {result.shape[0]}", f"use at most {MOST_TEXELS} a side")
    if result.min() < 0.0:
        raise SceneError(where, "holds negative values", "it is linear radiance or reflectance")
    return result


def _positive(name: str, value: Any, unit: str = "") -> float:
    return checks.number(f"refractive_sheet.{name}", value, low=0.0, exclusive=True, unit=unit)


def _pair(value: float | tuple[float, float]) -> tuple[float, float]:
    return value if isinstance(value, tuple) else (value, value)


def _checked_size(value: Any) -> float | tuple[float, float]:
    if np.ndim(value) == 0:
        return _positive("size_m", value, "metres")
    parts = tuple(value)
    if len(parts) != 2:
        raise SceneError("refractive_sheet.size_m", f"must be one length or two, got {len(parts)}")
    return _positive("size_m[0]", parts[0], "metres"), _positive("size_m[1]", parts[1], "metres")
