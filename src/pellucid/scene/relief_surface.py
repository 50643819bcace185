"""Surfaces with relief: a solid layer of heights over polygons, and a translucent one over it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from pellucid import media
from pellucid.errors import AssetError, SceneError
from pellucid.scene import checks
from pellucid.scene.mesh import Mesh
from pellucid.scene.placement import Filled, Value, check_placement, store
from pellucid.scene.relief_quality import STEPS, TECHNIQUES, ReliefQuality

if TYPE_CHECKING:
    from pellucid.media import Medium

MAPS = ("heights", "normals", "colors")
NORMAL_CONVENTIONS = ("opengl", "directx")
EDGES = ("clip", "extend")
MOST_TEXELS = 8192


@dataclass(frozen=True, eq=False)
class ReliefLayer(Value):
    """A surface of heights over polygons.

    Parameters
    ----------
    heights : (H, W) metres along the normal, row 0 at the top of the map; one number for a flat layer. With
        `height_m`, an array or the path of a picture (8 or 16 bits, EXR) with values from 0 to 1; arrays of uint8 and
        uint16 are such pictures. Or heights that move: ``fields.waves.Ripples``, ``fields.drops.Drops``, any
        ``fields.dynamic.DynamicHeights``.
    height_m : height of the value 1 above the value 0, metres > 0; None when `heights` are metres.
    base_m : height of the value 0 when there is `height_m`, metres; else is added.
    normals : (H, W, 3) unit vectors, x to the right, y up, z out of the surface, or a picture (a path, uint8 or uint16)
        in which 0 to 1 stand for -1 to 1. Worked out from the heights when None.
    colors : (H, W, 3) linear reflectance, a picture (sRGB when a file or array of 8 or 16 bits), or one linear colour.
    roughness : 0 mirror-like to 1 matt; None for 0.6, or 0.05 of a translucent layer. There it blurs what is mirrored.
    specular : reflectance of the coat at normal incidence, 0 to 1; that of a translucent layer follows from its index.
    normal_convention : ``"directx"`` when y of the normals points down.
    files : the pictures that arrays were read from; filled in by reading.

    Raises
    ------
    SceneError : wrong shapes, values out of range or not finite. AssetError : a picture that cannot be used.
    """

    heights: Any
    height_m: float | None = None
    base_m: float = 0.0
    normals: Any = None
    colors: Any = (0.8, 0.8, 0.8)
    roughness: float | None = None
    specular: float = 0.04
    normal_convention: str = "opengl"
    files: Mapping[str, tuple[str, np.ndarray]] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        files = {name: kept for name, kept in self.files.items() if getattr(self, name) is kept[1]}
        loaded = {name: getattr(self, name) for name in MAPS if isinstance(getattr(self, name), str | PathLike)}
        for name, path in loaded.items():
            pixels = checks.frozen(_picture(path, name))
            files[name] = (str(Path(fspath(path)).resolve()), pixels)
            store(self, **{name: pixels})
        height_m = self.height_m
        if height_m is not None:
            height_m = checks.number("relief_layer.height_m", height_m, low=0.0, exclusive=True, unit="metres")
        elif "heights" in files or checks.is_stored(self.heights):
            raise SceneError("relief_layer.height_m", "is missing", "say how high the value 1 of the picture is")
        store(
            self,
            files=files,
            height_m=height_m,
            base_m=checks.number("relief_layer.base_m", self.base_m, unit="metres"),
            heights=_checked_heights(self.heights, height_m),
            normals=_checked_normals(self.normals),
            colors=_checked_colors(self.colors),
            roughness=None
            if self.roughness is None
            else checks.number("relief_layer.roughness", self.roughness, low=0.0, high=1.0),
            specular=checks.number("relief_layer.specular", self.specular, low=0.0, high=1.0),
            normal_convention=checks.choice(
                "relief_layer.normal_convention", self.normal_convention, NORMAL_CONVENTIONS
            ),
        )

    @classmethod
    def of(cls, maps: Any, **look: Any) -> Self:
        """The layer of ``fields.textures.Maps``; normals come from its heights, so that tiles of any size agree.

        Parameters
        ----------
        maps : has ``heights_m`` (H, W) and ``colors`` (H, W, 3). look : any other field.
        """
        return cls(maps.heights_m, **({"colors": maps.colors} | look))

    @property
    def heights_m(self) -> np.ndarray:
        """(H, W) float64, metres; of heights that move, as they begin."""
        return self.heights_at(0.0)

    @property
    def is_dynamic(self) -> bool:
        """Whether the heights change with time."""
        return not isinstance(self.heights, np.ndarray)

    @property
    def limits_m(self) -> tuple[float, float]:
        """Lowest and highest height at any time, metres."""
        if self.is_dynamic:
            low, high = self.heights.limits_m
            return self.base_m + float(low), self.base_m + float(high)
        heights = self.heights_m
        return float(heights.min()), float(heights.max())

    def heights_at(self, time_s: float) -> np.ndarray:
        """(H, W) float64, metres, at a time."""
        scale = 1.0 if self.height_m is None else self.height_m
        values = self.heights.advance(time_s) if self.is_dynamic else self.heights
        return self.base_m + scale * np.asarray(values, np.float64)

    def slopes(self, cell_m: tuple[float, float], tiling: bool, time_s: float = 0.0) -> np.ndarray:
        """(H, W, 2) metres a metre, towards growing u and v: of the normals where there are any, else of the heights.

        Parameters
        ----------
        cell_m : width and height of a texel of the height map, metres. time_s : of heights that move.
        """
        from pellucid.fields.heightfield import slopes_of

        if self.normals is None:
            return np.asarray(slopes_of(self.heights_at(time_s), cell_m, tiling))
        n = np.asarray(self.normals, np.float64)
        up = -1.0 if self.normal_convention == "directx" else 1.0
        return np.asarray(-n[..., :2] * (1.0, up) / np.maximum(n[..., 2:], 1e-3))


@dataclass(frozen=True, eq=False)
class ReliefSurface(Filled):
    """A mesh whose surface has depth, and may be covered with something translucent.

    Where the translucent layer is higher than the solid one, its matter fills what is between; elsewhere there is
    none, and where both are equally high the solid one is seen. Heights are metres of the world: `scale` enlarges the
    mesh and its tiles, not the heights.

    Parameters
    ----------
    mesh : where the layers lie; its geometry with uvs, without its look and placement.
    solid : the opaque layer. translucent : the layer over it, or None.
    medium : of the translucent layer: a name, a Medium or an index.
    ambient_n : index of what is around.
    tile_m : side of a tile in metres, one number or (along u, along v), in the mean over the mesh. None: by `tiles`.
    tiles : tiles along u and v for each unit of the mesh's uvs.
    tiling : maps repeat; else they go on as they end.
    technique : ``"best"`` draws all that `quality` asks for. ``"color"``, ``"normal"``, ``"offset"``, ``"relief"``,
        ``"two_layer"``, ``"occlusion"``, ``"occlusion_hue"`` stop at a step of [timonen2006, table 1]; with
        ``_thesis`` at the end they are worked out as there.
    quality : how carefully.
    dispersion : refract red, green and blue apart.
    absorption : of the translucent layer, 1/m by channel; that of the medium when None.
    scattering : of the translucent layer, 1/m; what lies below is blurred with the way that light goes.
    specular_factor : multiplies the reflection of lamps in the translucent layer, as [timonen2006] does where pictures
        hold no more than white; None for light as it is.
    edges : at an open border a relief is cut (``"clip"``), or goes on as far as a ray needs (``"extend"``).
    position, rotation, scale : metres, degrees about x, y, z in this order, one factor > 0.

    Raises
    ------
    SceneError : a mesh without uvs, values of the wrong kind or out of range.
    """

    mesh: Mesh
    solid: ReliefLayer
    translucent: ReliefLayer | None = None
    medium: str | Medium | float = "water"
    ambient_n: float = 1.0
    tile_m: float | tuple[float, float] | None = None
    tiles: tuple[float, float] = (1.0, 1.0)
    tiling: bool = True
    technique: str = "best"
    quality: ReliefQuality = field(default_factory=ReliefQuality)
    dispersion: bool = False
    absorption: checks.Vector | None = None
    scattering: float = 0.0
    specular_factor: float | None = None
    edges: str = "clip"
    position: checks.Vector = (0.0, 0.0, 0.0)
    rotation: checks.Vector = (0.0, 0.0, 0.0)
    scale: float = 1.0

    def __post_init__(self) -> None:
        _check_kind("mesh", self.mesh, Mesh, "give a Mesh with uvs, or use ReliefSurface.plane")
        if self.mesh.uvs is None:
            raise SceneError("relief_surface.mesh.uvs", "are missing", "give (V, 2) texture coordinates")
        _check_kind("solid", self.solid, ReliefLayer, "give a ReliefLayer")
        if self.translucent is not None:
            _check_kind("translucent", self.translucent, ReliefLayer, "give a ReliefLayer or None")
        _check_kind("quality", self.quality, ReliefQuality, "give a ReliefQuality")
        absorption, factor = self.absorption, self.specular_factor
        store(
            self,
            **check_placement("relief_surface", self.position, self.rotation, self.scale),
            medium=media.resolve(self.medium, "relief_surface.medium"),
            ambient_n=_positive("ambient_n", self.ambient_n),
            tile_m=None if self.tile_m is None else _pair("tile_m", self.tile_m, unit="metres"),
            tiles=_pair("tiles", self.tiles),
            tiling=checks.flag("relief_surface.tiling", self.tiling),
            technique=checks.choice("relief_surface.technique", self.technique, TECHNIQUES),
            dispersion=checks.flag("relief_surface.dispersion", self.dispersion),
            absorption=None if absorption is None else checks.color("relief_surface.absorption", absorption),
            scattering=checks.number("relief_surface.scattering", self.scattering, low=0.0, unit="1/m"),
            specular_factor=None if factor is None else _positive("specular_factor", factor),
            edges=checks.choice("relief_surface.edges", self.edges, EDGES),
        )
        if self.tile_m is not None and self.tiles != (1.0, 1.0):
            raise SceneError("relief_surface.tiles", "are given together with tile_m", "choose one of them")
        if self.quality.show != "radiance" and not self.draws_translucent:
            said = f"is {self.quality.show!r}, but no translucent layer is drawn"
            raise SceneError("relief_surface.quality.show", said, "give one, and a technique that draws it")

    @classmethod
    def plane(
        cls,
        size_m: float | tuple[float, float],
        solid: ReliefLayer,
        translucent: ReliefLayer | None = None,
        **look: Any,
    ) -> Self:
        """A rectangle in the plane y = 0 that faces +Y, `size_m` along x and z."""
        return cls(Mesh.plane(size_m), solid, translucent, **look)

    @classmethod
    def sphere(
        cls,
        radius_m: float,
        solid: ReliefLayer,
        translucent: ReliefLayer | None = None,
        segments: int = 64,
        **look: Any,
    ) -> Self:
        """A sphere around the origin; whole numbers of `tiles`, 4 and 2 unless told, go round and from pole to pole."""
        return cls(Mesh.sphere(radius_m, segments), solid, translucent, **_tiled(look, (4.0, 2.0)))

    @classmethod
    def torus(
        cls,
        radius_m: float,
        tube_m: float,
        solid: ReliefLayer,
        translucent: ReliefLayer | None = None,
        segments: int = 64,
        **look: Any,
    ) -> Self:
        """A torus around the y axis; whole numbers of `tiles`, 6 and 2 unless told, go round the axis and the tube."""
        return cls(Mesh.torus(radius_m, tube_m, segments), solid, translucent, **_tiled(look, (6.0, 2.0)))

    @classmethod
    def load(
        cls, path: str | PathLike[str], solid: ReliefLayer, translucent: ReliefLayer | None = None, **look: Any
    ) -> Self:
        """The mesh of a file, which has to bring uvs along.

        Raises
        ------
        AssetError : the file cannot be used. SceneError : a value out of range.
        """
        mesh = Mesh.load(path)
        if mesh.uvs is None:
            raise AssetError(path, "has no texture coordinates", "unwrap the mesh before it is exported")
        return cls(mesh, solid, translucent, **look)

    @property
    def draws_translucent(self) -> bool:
        """Whether there is a translucent layer, and the technique draws it."""
        step = self.technique.removesuffix("_thesis")
        return self.translucent is not None and STEPS.index(step) >= STEPS.index("two_layer")


def _tiled(look: dict[str, Any], tiles: tuple[float, float]) -> dict[str, Any]:
    return look if "tile_m" in look else {"tiles": tiles} | look


def _picture(path: str | PathLike[str], name: str) -> np.ndarray:
    from pellucid.io.images import read_image

    pixels = read_image(path, linear=None if name == "colors" else True)
    if name == "heights":
        return np.ascontiguousarray(pixels[..., 0])
    if pixels.shape[2] < 3 and name == "normals":
        raise AssetError(path, f"has {pixels.shape[2]} channels", "a normal map has three")
    rgb = pixels[..., :3] if pixels.shape[2] >= 3 else np.repeat(pixels[..., :1], 3, axis=2)
    return np.ascontiguousarray(2.0 * rgb - 1.0 if name == "normals" else rgb)


def _checked_heights(value: Any, height_m: float | None) -> Any:
    from pellucid.fields.dynamic import DynamicHeights

    if isinstance(value, DynamicHeights):
        if height_m is not None:
            raise SceneError("relief_layer.height_m", "is given with heights that move", "they are metres already")
        return value
    given = np.full((1, 1), checks.number("relief_layer.heights", value)) if np.ndim(value) == 0 else value
    result = checks.picture("relief_layer.heights", given, (None, None), linear=True)
    _check_size("heights", result)
    return result


def _checked_normals(value: Any) -> np.ndarray | None:
    if value is None:
        return None
    result = checks.picture("relief_layer.normals", value, (None, None, 3), linear=True)
    if checks.is_stored(value):
        result = checks.frozen(2.0 * result - 1.0)
    _check_size("normals", result)
    length = np.linalg.norm(result, axis=2)
    if (length < 1e-3).any() or (result[..., 2] <= -1e-3 * length).any():
        raise SceneError("relief_layer.normals", "hold vectors that are zero or point into the surface", "z is > 0")
    return result


def _checked_colors(value: Any) -> Any:
    if np.ndim(value) == 1:
        return checks.color("relief_layer.colors", value, high=1.0)
    result = checks.picture("relief_layer.colors", value, (None, None, 3))
    _check_size("colors", result)
    if result.min() < 0.0:
        raise SceneError("relief_layer.colors", "hold negative values", "they are linear reflectance from 0 to 1")
    return result


def _check_size(name: str, array: np.ndarray) -> None:
    if max(array.shape[:2]) > MOST_TEXELS:
        shown = f"{array.shape[1]} x {array.shape[0]} texels"
        raise SceneError(f"relief_layer.{name}", f"has {shown}", f"use up to {MOST_TEXELS} a side")


def _check_kind(name: str, value: Any, kind: type, remedy: str) -> None:
    if not isinstance(value, kind):
        raise SceneError(f"relief_surface.{name}", f"cannot be {type(value).__name__!r}", remedy)


def _positive(name: str, value: Any) -> float:
    return checks.number(f"relief_surface.{name}", value, low=0.0, exclusive=True)


def _pair(name: str, value: Any, unit: str = "") -> tuple[float, float]:
    parts = (value, value) if np.ndim(value) == 0 else tuple(value)
    if len(parts) != 2:
        raise SceneError(f"relief_surface.{name}", f"must be one number or two, got {len(parts)}")
    a, b = (checks.number(f"relief_surface.{name}", p, low=0.0, exclusive=True, unit=unit) for p in parts)
    return a, b
