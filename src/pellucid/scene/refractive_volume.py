"""Things that bend light inside: glass bodies, graded-index fields, hot air."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from pellucid.errors import AssetError, SceneError
from pellucid.scene import checks
from pellucid.scene.brdf import GGX, TabulatedBRDF
from pellucid.scene.light_quality import LightQuality
from pellucid.scene.mesh import Mesh
from pellucid.scene.placement import Origin, SceneObject, check_placement, store, translation_matrix
from pellucid.scene.quality import Quality

if TYPE_CHECKING:
    from pellucid.fields.volume import Volume
    from pellucid.media import Medium

    Substance = str | Medium | float
    Extent = float | Sequence[float]


@dataclass(frozen=True, eq=False)
class RefractiveVolume(SceneObject):
    """A box of matter whose refractive index varies, placed in the world.

    Parameters
    ----------
    volume : the field itself, a ``pellucid.fields.volume.Volume``.
    boundary : ``"sharp"`` refracts and reflects where regions meet, by Snell and Fresnel (without regions
        the box itself is the surface); ``"smooth"`` lets the index change over about a voxel instead.
        ``"auto"`` becomes sharp for a volume with regions and smooth for one of arrays.
    position, rotation, scale : metres, degrees about x, y, z in this order, one factor > 0.
    dispersion : trace red, green and blue apart where the medium asks for it.
    spectral : how many wavelengths from 400 to 700 nm are traced apart instead of these three, 4 to 64, with the
        colours of the CIE 1931 observer; 0 for the three.
    smoothing_voxels : width of the Gaussian that smooths a field before its gradient, 0 to 8.
    gradient : ``"central"`` differences or ``"sobel"``.
    surroundings : ``"rays"`` trace what a ray sees once it has left; ``"screen"`` looks it up in the
        picture behind, cheaper and blind to what the picture does not show.
    quality : how carefully rays are bent.
    proxy : where rays of the picture begin: ``"box"``, a ``"sphere"`` around all matter, or a Mesh that holds it (its
        geometry without its placement, in the object's own coordinates). Of a mesh it is the convex hull that counts,
        or 26 planes around it, a little enlarged: the body's own mesh will do. The picture stays the same.
    brdf : how boundaries spread what they mirror, seen from outside: None for mirrors, `GGX` or `TabulatedBRDF`.
        Tint and roughness come from ``volume.reflection``, where there is such.
    gloss : roughness 0 to 1 in which lamps are mirrored where a ray first meets the body; lamps have no size, so a
        perfect mirror would never show them. 0 leaves them out. Boundaries smoother than this count as mirrors.
    light : how carefully light is followed through the volume.
    center_m : where the middle of the box lies in the object's own coordinates. From a mesh it is the
        middle of the box around the mesh, so that ``position=(0, 0, 0)`` leaves the model where its file
        says: world = T(position) R S (x_volume + center_m), with x_mesh = x_volume + center_m.
    origin : the recipe that scene files store; set by the class methods.

    Raises
    ------
    SceneError : a value out of range.
    """

    volume: Volume
    boundary: str = "auto"
    position: checks.Vector = (0.0, 0.0, 0.0)
    rotation: checks.Vector = (0.0, 0.0, 0.0)
    scale: float = 1.0
    dispersion: bool = True
    spectral: int = 0
    smoothing_voxels: float = 0.75
    gradient: str = "central"
    surroundings: str = "rays"
    quality: Quality = field(default_factory=Quality)
    proxy: str | Mesh = "box"
    brdf: GGX | TabulatedBRDF | None = None
    gloss: float = 0.08
    light: LightQuality = field(default_factory=LightQuality)
    center_m: checks.Vector = (0.0, 0.0, 0.0)
    origin: Origin | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        from pellucid.fields.volume import Volume

        if not isinstance(self.volume, Volume):
            kind = type(self.volume).__name__
            raise SceneError("refractive_volume.volume", f"cannot be {kind!r}", "use from_mesh, from_array, from_sdf")
        store(self, **_checked({name: getattr(self, name) for name in DEFAULTS}))
        if self.boundary == "auto":
            store(self, boundary="sharp" if self.volume.regions else "smooth")

    def replace(self, **changes: Any) -> Self:
        """A copy with some fields changed; a new volume or centre has no recipe."""
        if "volume" in changes or "center_m" in changes:
            changes = {"origin": None} | changes
        return super().replace(**changes)

    def object_to_world(self) -> np.ndarray:
        """(4, 4) float64: maps volume coordinates (origin at the middle of the box) to the world."""
        return super().object_to_world() @ translation_matrix(self.center_m)

    @classmethod
    def from_volume(cls, volume: Volume, **placement: Any) -> Self:
        """A ready ``Volume``, placed; `placement` is any other field of the class."""
        return cls(volume, **placement)

    @classmethod
    def from_mesh(
        cls,
        mesh: Any,
        medium: Substance,
        resolution: int = 128,
        ambient_n: float = 1.0,
        *,
        rounding_voxels: float = 0.0,
        optic_axis: Sequence[float] | np.ndarray | None = None,
        progress: Callable[[float], None] | None = None,
        **placement: Any,
    ) -> Self:
        """The inside of a closed mesh, filled with a medium.

        Parameters
        ----------
        mesh : path of an .obj, .ply, .stl, .glb or .gltf; a trimesh or Mesh (its geometry, without its
            placement); or (vertices (V, 3), faces (F, 3)).
        medium : name, Medium or constant index.
        resolution : voxels along the longest edge of the box.
        ambient_n : index around the body.
        rounding_voxels : 0 to 8; rounds off facets and edges, for coarse meshes of curved things.
        optic_axis : of a crystal, in the coordinates of the mesh; with it light splits into two rays.
        progress : called with the share of the voxels that is done, 0 to 1.
        placement : any other field of the class, such as ``boundary`` or ``position``.

        Raises
        ------
        AssetError : the file cannot be used. SceneError : a value out of range, an unknown medium.
        """
        from pellucid import media
        from pellucid.fields.volume import Volume

        options = _checked(placement)
        substance = media.resolve(medium, "refractive_volume.medium")
        vertices, faces, recipe = _triangles(mesh)
        with _blaming(mesh):
            volume, center = Volume.from_mesh(
                vertices,
                faces,
                substance,
                resolution,
                ambient_n=ambient_n,
                rounding_voxels=rounding_voxels,
                progress=progress,
                optic_axis=optic_axis,
            )
        if recipe is not None and "center_m" not in options:
            made = {**recipe, "medium": substance, "resolution": resolution, "ambient_n": volume.ambient_n}
            made |= {"rounding_voxels": rounding_voxels} if rounding_voxels else {}
            made |= {} if optic_axis is None else {"optic_axis": volume.regions[0].optic_axis}
            options["origin"] = Origin(made)
        return cls(volume, **({"center_m": center} | options))

    @classmethod
    def from_array(
        cls,
        n: np.ndarray,
        extent_m: Extent,
        ambient_n: float = 1.0,
        absorption: np.ndarray | None = None,
        scattering: np.ndarray | None = None,
        anisotropy: np.ndarray | None = None,
        emission: np.ndarray | None = None,
        opaque: np.ndarray | None = None,
        reflection: np.ndarray | None = None,
        **placement: Any,
    ) -> Self:
        """Refractive index and more, given voxel by voxel; see ``Volume.from_array``.

        Parameters
        ----------
        n : (Z, Y, X) index, or (Z, Y, X, 3) for red, green and blue.
        extent_m : edges of the box along x, y, z, or its longest edge when voxels are cubes.
        ambient_n : index around it.
        absorption, scattering : (Z, Y, X, 3) 1/m. anisotropy : (Z, Y, X). emission : (Z, Y, X, 3)
            radiance per metre. opaque : (Z, Y, X, 4) linear colour and coverage. reflection : (Z, Y, X, 4) tint of
            mirrored light and roughness.
        placement : any other field of the class.

        Raises
        ------
        SceneError : a value out of range or an array of the wrong shape.
        """
        from pellucid.fields.volume import Volume

        options = _checked(placement)
        more = (absorption, scattering, anisotropy, emission, opaque, reflection)
        return cls(Volume.from_array(n, extent_m, ambient_n, *more), **options)

    @classmethod
    def from_function(
        cls,
        f: Callable[..., np.ndarray],
        resolution: int,
        extent_m: Extent,
        ambient_n: float = 1.0,
        **placement: Any,
    ) -> Self:
        """Index as a function ``f(x, y, z)`` of metres from the middle of the box; see ``Volume.from_function``."""
        from pellucid.fields.volume import Volume

        options = _checked(placement)
        return cls(Volume.from_function(f, resolution, extent_m, ambient_n), **options)

    @classmethod
    def from_sdf(
        cls,
        f: Callable[..., np.ndarray],
        medium: Substance,
        resolution: int,
        extent_m: Extent,
        ambient_n: float = 1.0,
        optic_axis: Sequence[float] | np.ndarray | None = None,
        **placement: Any,
    ) -> Self:
        """A body given by its signed distance ``f(x, y, z)`` in metres, negative inside; see ``Volume.from_sdf``.

        optic_axis : of a crystal; with it light splits into two rays.
        """
        from pellucid.fields.volume import Volume

        options = _checked(placement)
        return cls(Volume.from_sdf(f, medium, resolution, extent_m, ambient_n, optic_axis), **options)

    @classmethod
    def from_regions(
        cls,
        regions: Sequence[tuple[Any, Substance]],
        resolution: int,
        extent_m: Extent,
        ambient_n: float = 1.0,
        optic_axes: Sequence[Sequence[float] | np.ndarray | None] = (),
        **placement: Any,
    ) -> Self:
        """Up to four bodies as (signed distance, medium); the first that holds a point owns it.

        optic_axes : one for each body, or None for one that is not to be drawn as a crystal.
        """
        from pellucid.fields.volume import Volume

        options = _checked(placement)
        return cls(Volume.from_regions(list(regions), resolution, extent_m, ambient_n, optic_axes), **options)


PROXIES = ("box", "sphere")
DEFAULTS = tuple(name for name in RefractiveVolume.__dataclass_fields__ if name not in ("volume", "origin"))


def _checked(given: Mapping[str, Any]) -> dict[str, Any]:
    """The fields that are given, as they are stored; done before any long work, so that slips show at once."""
    prefix = "refractive_volume"
    unknown = [name for name in given if name not in (*DEFAULTS, "origin")]
    if unknown:
        raise SceneError(
            f"{prefix}.{unknown[0]}", "is not a field of RefractiveVolume", f"it has {', '.join(DEFAULTS)}"
        )
    tests: dict[str, Callable[[str, Any], Any]] = {
        "boundary": lambda f, v: checks.choice(f, v, ("auto", "sharp", "smooth")),
        "dispersion": checks.flag,
        "spectral": _wavelengths,
        "smoothing_voxels": lambda f, v: checks.number(f, v, low=0.0, high=8.0, unit="voxels"),
        "gradient": lambda f, v: checks.choice(f, v, ("central", "sobel")),
        "surroundings": lambda f, v: checks.choice(f, v, ("rays", "screen")),
        "quality": _one_of(Quality),
        "brdf": _brdf,
        "proxy": _proxy,
        "gloss": lambda f, v: checks.number(f, v, low=0.0, high=1.0),
        "light": _one_of(LightQuality),
        "center_m": checks.vector,
    }
    result = dict(given)
    result |= {name: test(f"{prefix}.{name}", given[name]) for name, test in tests.items() if name in given}
    neutral = {"position": (0.0, 0.0, 0.0), "rotation": (0.0, 0.0, 0.0), "scale": 1.0}
    placed = check_placement(prefix, **{name: given.get(name, value) for name, value in neutral.items()})
    return result | {name: value for name, value in placed.items() if name in given}


def _wavelengths(name: str, value: Any) -> int:
    count = checks.integer(name, value, low=0, high=64)
    if 0 < count < 4:
        raise SceneError(name, f"is {count}", "use 4 to 64 wavelengths, or 0 for red, green and blue")
    return count


def _one_of(kind: type) -> Callable[[str, Any], Any]:
    def test(name: str, value: Any) -> Any:
        if not isinstance(value, kind):
            raise SceneError(name, f"cannot be {type(value).__name__!r}", f"give {kind.__name__}(...)")
        return value

    return test


def _proxy(name: str, value: Any) -> str | Mesh:
    if isinstance(value, Mesh) or (isinstance(value, str) and value in PROXIES):
        return value
    shown = repr(value) if isinstance(value, str) else type(value).__name__
    raise SceneError(name, f"cannot be {shown}", "give 'box', 'sphere' or a Mesh")


def _brdf(name: str, value: Any) -> GGX | TabulatedBRDF | None:
    if value is not None and not isinstance(value, GGX | TabulatedBRDF):
        raise SceneError(name, f"cannot be {type(value).__name__!r}", "give GGX(...), TabulatedBRDF(...) or None")
    return value


@contextmanager
def _blaming(mesh: Any) -> Iterator[None]:
    """What is wrong with the triangles of a file is said of the file."""
    try:
        yield
    except SceneError as error:
        if isinstance(mesh, str | PathLike) and error.field in ("mesh", "vertices", "faces"):
            raise AssetError(fspath(mesh), error.reason, error.remedy) from error
        raise


def _triangles(mesh: Any) -> tuple[np.ndarray, np.ndarray, dict[str, Any] | None]:
    """Vertices, faces, and how a scene file names them (None when it cannot)."""
    if isinstance(mesh, str | PathLike):
        from pellucid.io.meshes import read_mesh

        data = read_mesh(mesh)
        return data.vertices, data.faces, {"mesh": str(Path(fspath(mesh)).resolve())}
    pair = mesh if isinstance(mesh, tuple | list) else (getattr(mesh, "vertices", None), getattr(mesh, "faces", None))
    if len(pair) != 2 or pair[0] is None or pair[1] is None:
        kind = type(mesh).__name__
        raise SceneError("refractive_volume.mesh", f"cannot be {kind!r}", "give a path, a trimesh or (vertices, faces)")
    vertices = checks.array("refractive_volume.mesh vertices", np.asarray(pair[0]), (None, 3), np.float64)
    faces = checks.array("refractive_volume.mesh faces", np.asarray(pair[1]), (None, 3), np.int32)
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise SceneError("refractive_volume.mesh faces", f"name vertices beyond the {len(vertices)} there are")
    return vertices, faces, None
