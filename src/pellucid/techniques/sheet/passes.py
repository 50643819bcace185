"""The pass of a sheet: its mesh, with everything worked out per vertex or per fragment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.fields.waves import WaveSource
from pellucid.gpu import Device, Pipelines
from pellucid.gpu.targets import COLOR_FORMAT, DEPTH_FORMAT, Targets
from pellucid.optics import fitted_factor, opposite_factor
from pellucid.scene.placement import placement_matrix
from pellucid.scene.refractive_sheet import SHOWS
from pellucid.surroundings.diffuse import diffuse_shares
from pellucid.techniques.sheet.layouts import SheetParams
from pellucid.techniques.sheet.prepare import faces_of, picture_levels, vertices_of
from pellucid.techniques.sheet.reference import inward, picture_hit, shrunk_limits

if TYPE_CHECKING:
    from pellucid.scene import Camera, RefractiveSheet
    from pellucid.surroundings import Surroundings

MODULE = "techniques/sheet/shaders/sheet"
OPTIONS: dict[str, Any] = {"targets": (COLOR_FORMAT,), "depth": DEPTH_FORMAT, "depth_compare": "greater"}
MOST_TRIED = 65536  # vertices whose deviation is looked at


@dataclass(eq=False)
class Body:
    """A sheet on the device.

    Attributes
    ----------
    item : what the user described. vertices : as they are at a `moment`. index_count : three a triangle.
    bindings : resources of bind group 0 by their WGSL names, and its "indices".
    """

    item: RefractiveSheet
    vertices: np.ndarray
    index_count: int
    bindings: dict[str, Any]
    moment: list[Any]
    params: np.ndarray = field(default_factory=lambda: np.zeros((), SheetParams))

    @property
    def factor(self) -> float:
        """Of the approximation: the one given, or the one that is fitted to the two indices."""
        item = self.item
        if item.factor is not None:
            return item.factor
        return float(fitted_factor(item.ambient_n, item.matter.n_d, np.radians(item.fit_angle_deg)))

    def constants(self, surroundings: Surroundings) -> dict[str, float]:
        """Override constants of the shader; none depends on what moves."""
        item = self.item
        meshes = surroundings.triangle_count > 0
        return {
            "SHEET_EXACT": float(item.refraction == "exact"),
            "SHEET_PER_VERTEX": float(item.per == "vertex"),
            "SHEET_BALL": float(item.sphere_rule == "ball"),
            "SHEET_SPHERE_MAP": float(item.reflection == "sphere_map"),
            "SHEET_SHOW": float(SHOWS.index(item.show)),
            "SHEET_LIT": float(item.lit),
            "SHEET_MEETS_BELOW": float(meshes and item.meshes and item.per == "fragment"),
            "SHEET_MEETS_OUTSIDE": float(meshes and item.reflection == "rays"),
            "SHEET_MEETS_ACROSS": float(item.reflection == "rays"),
            **surroundings.shading_constants,
            **surroundings.across_constants,
        }


class SheetTechnique:
    """Draws `RefractiveSheet` objects.

    Attributes
    ----------
    bodies : what was prepared last. pipelines : one for each choice that a sheet was drawn with.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self.bodies: list[Body] = []
        self.pipelines = Pipelines(device)
        self._pictures: list[tuple[np.ndarray, Any]] = []
        self._absent = device.texture(size=(1, 1), format="rgba16float", label="no sphere map")

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held."""
        pictures = sum(8 * array.shape[0] * array.shape[1] * 4 // 3 for array, _ in self._pictures)
        return pictures + sum(body.vertices.nbytes + 4 * body.index_count for body in self.bodies)

    def prepare(self, items: Sequence[RefractiveSheet], surroundings: Surroundings) -> None:
        """Make meshes and pictures resident that are new, and write the parameters of every sheet."""
        before = list(self.bodies)
        wanted = [p for item in items for p in (item.picture, item.sphere_map) if p is not None]
        self._pictures = [kept for kept in self._pictures if any(kept[0] is p for p in wanted)]
        self.bodies = [self._body(item, before) for item in items]
        for body in self.bodies:
            write_parameters(body)

    def simulate(self, time_s: float) -> None:
        """Move the sheets that move by themselves to a time."""
        for body in self.bodies:
            state = _moment(body.item, time_s)
            if not _same(body.moment, state):
                body.vertices, body.moment = vertices_of(body.item, time_s), state
                self.device.write(body.bindings["sheet_vertices"], body.vertices)

    def illuminate(self, lights: Sequence[Any], surroundings: Surroundings) -> None:
        """Nothing: what lamps give is worked out where it is seen."""

    def draw(
        self, encoder: Any, targets: Targets, camera: Camera, surroundings: Surroundings, timer: Any = None
    ) -> None:
        """Draw every sheet into colour and depth, before what is there only where it is nearer."""
        for body in self.bodies:
            write_limits(body, camera)
            self.device.write(body.bindings["sheet"], body.params.reshape(1))
            self.pipelines.draw(MODULE, body.constants(surroundings), **OPTIONS).run(
                encoder,
                color=[targets.color_view],
                depth=targets.depth_view,
                bindings={**body.bindings, **surroundings.bindings},
                index_buffer=body.bindings["indices"],
                index_count=body.index_count,
                timer=timer,
                label="sheet",
            )

    def _body(self, item: RefractiveSheet, before: list[Body]) -> Body:
        same = next((b for b in before if _same(_geometry_key(b.item), _geometry_key(item))), None)
        if same is not None:
            before.remove(same)
            body = Body(item, same.vertices, same.index_count, dict(same.bindings), same.moment)
        else:
            vertices, faces = vertices_of(item, 0.0), faces_of(item)
            bindings = {
                "sheet": self.device.buffer(SheetParams.itemsize, "uniform", "sheet"),
                "sheet_vertices": self.device.buffer(vertices, "storage", "sheet vertices"),
                "indices": self.device.buffer(faces, "index", "sheet indices"),
                "sheet_sampler": self.device.sampler("linear", "clamp"),
            }
            body = Body(item, vertices, faces.size, bindings, _moment(item, 0.0))
        body.bindings["sheet_picture"] = self._picture(item.picture)
        mirrored = item.sphere_map
        body.bindings["sheet_sphere_map"] = self._absent if mirrored is None else self._picture(mirrored)
        return body

    def _picture(self, array: np.ndarray) -> Any:
        """The texture of a picture; pictures are told apart by identity: scene objects are values."""
        kept = next((texture for one, texture in self._pictures if one is array), None)
        if kept is None:
            levels = picture_levels(array)
            height, width = array.shape[:2]
            kept = self.device.texture(size=(width, height), format="rgba16float", mips=len(levels), label="picture")
            for mip, level in enumerate(levels):
                self.device.write_texture(kept, level, mip=mip)
            self._pictures.append((array, kept))
        return kept


def write_parameters(body: Body) -> None:
    """Fill the parameters of a body but for its limits; cheap, since the sliders of a user end here."""
    item, p = body.item, body.params
    matrix = placement_matrix(item.position, item.rotation, item.scale)
    p["world_from_object"], p["object_from_world"] = matrix.T, np.linalg.inv(matrix).T
    p["extents_low"] = [low for low, _ in item.extents_m]
    p["extents_size"] = [high - low for low, high in item.extents_m]
    p["depth"], p["scale"] = item.depth_m, item.scale
    p["n_inside"], p["n_outside"] = item.matter.n_d, item.ambient_n
    p["factor"], p["factor_below"] = body.factor, opposite_factor(body.factor)
    p["absorption"] = item.absorption_per_m
    p["fresnel"] = item.blend is None and item.reflection != "none"
    p["blend"] = 0.0 if item.blend is None or item.reflection == "none" else item.blend
    p["error_scale"] = item.error_scale
    if item.lit:
        passes = np.exp(-np.asarray(item.absorption_per_m, float) * item.depth_m * item.scale)
        p["diffuse_down"], p["diffuse_back"] = diffuse_shares(item.matter.n_d / item.ambient_n, passes)


def write_limits(body: Body, camera: Camera) -> None:
    """Fill in between which limits of x and z the picture lies, as this camera sees the sheet."""
    low, high = (np.array(ends, float) for ends in zip(*body.item.extents_m, strict=True))
    if body.item.borders == "shrink":
        given = body.item.deviation_m
        low, high = (low - given, high + given) if given is not None else shrunk_limits(_hits(body, camera), low, high)
    body.params["limits_low"], body.params["limits_size"] = low, high - low


def _hits(body: Body, camera: Camera) -> np.ndarray:
    """Where rays of the camera through vertices meet the plane of the picture."""
    item = body.item
    vertices = body.vertices[:: max(1, len(body.vertices) // MOST_TRIED)]
    p, n = vertices["position"].astype(np.float64), vertices["normal"].astype(np.float64)
    to_object = np.linalg.inv(item.object_to_world())
    world = np.linalg.inv(np.asarray(camera.view_matrix(), np.float64))
    if camera.is_orthographic:
        d = np.broadcast_to(to_object[:3, :3] @ -world[:3, 2], p.shape)
    else:
        d = p - (to_object @ world[:, 3])[:3]
    d = d / np.maximum(np.linalg.norm(d, axis=1, keepdims=True), 1e-12)
    factor = body.factor if item.refraction == "approximate" else None
    return picture_hit(p, inward(d, n, item.ambient_n, item.matter.n_d, factor), item.depth_m).xz


def _geometry_key(item: RefractiveSheet) -> list[Any]:
    return [item.waves, item.mesh, item.motion, item.motion_fps, item.extents_m, item.cells]


def _moment(item: RefractiveSheet, time_s: float) -> list[Any]:
    """What decides whether vertices are still true: waves may be disturbed between two pictures of one time."""
    if not item.is_dynamic:
        return [0.0, None]
    return [float(time_s), item.waves.surface(time_s) if isinstance(item.waves, WaveSource) else None]


def _same(a: list[Any], b: list[Any]) -> bool:
    """Arrays and objects are told apart by identity: scene objects are values."""
    return all(x is y or (isinstance(x, tuple | float) and x == y) for x, y in zip(a, b, strict=True))
