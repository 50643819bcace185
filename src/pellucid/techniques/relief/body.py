"""A relief on the device: its parameters, and what tells whether its geometry and maps are those of one before."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.scene.placement import placement_matrix
from pellucid.scene.relief_quality import REFLECTIONS, REFRACTIONS, SEARCHES, SHOWS, ReliefQuality
from pellucid.surroundings.diffuse import diffuse_tables
from pellucid.techniques.relief.frames import Hull
from pellucid.techniques.relief.layouts import ReliefParams
from pellucid.techniques.relief.moving import MovingMaps
from pellucid.techniques.relief.prepare import MARGIN, SOLID_ROUGHNESS, TRANSLUCENT_ROUGHNESS, Maps, roughness_of

if TYPE_CHECKING:
    from pellucid.scene import ReliefSurface

DEPTHS = {"color": 0, "normal": 0, "offset": 1}  # of RELIEF_DEPTH; 2 for all others


@dataclass
class Body:
    """A surface on the device.

    Attributes
    ----------
    item : what the user described. quality : what its technique makes of its quality.
    hull, maps : its geometry and its layers as arrays; of heights that `moving` writes, as they begin.
    time_s : of heights that move; version : counts their changes. moving : makes their maps on the device, if it can.
    bindings : resources of bind group 0 by their WGSL names.
    light_constants : override constants of how light of the lamps is found; filled in by `illuminate`.
    """

    item: ReliefSurface
    quality: ReliefQuality
    hull: Hull
    maps: Maps
    bindings: dict[str, Any]
    geometry_key: list[Any]
    maps_key: list[Any]
    nbytes: int = 0
    time_s: float = 0.0
    version: int = 0
    moving: MovingMaps | None = None
    params: np.ndarray = field(default_factory=lambda: np.zeros((), ReliefParams))
    light_constants: dict[str, float] = field(default_factory=dict)

    @property
    def step(self) -> str:
        """Name of the step of the thesis's table that is drawn."""
        return self.item.technique.removesuffix("_thesis")

    @property
    def two_layers(self) -> bool:
        """Whether the translucent layer is drawn."""
        return self.item.draws_translucent

    @property
    def constants(self) -> dict[str, float]:
        """Override constants of all shaders of this body; none depends on what moves."""
        quality = self.quality
        return {
            "TWO_LAYERS": float(self.two_layers),
            "RELIEF_DEPTH": float(DEPTHS.get(self.step, 2)),
            "RELIEF_NORMALS": float(self.step != "color"),
            "RELIEF_SEARCH": float(SEARCHES.index(quality.search)),
            "RELIEF_REFRACTION": float(REFRACTIONS.index(quality.refraction)),
            "RELIEF_PIECES": float(quality.refraction_pieces),
            "RELIEF_SHOWS": float(SHOWS.index(quality.show)),
            "RELIEF_DISPERSION": float(self.item.dispersion and self.item.matter.is_dispersive),
            "RELIEF_SHADOW_STEPS": float(quality.shadow_steps),
            "RELIEF_CUBE": float(quality.environment.startswith("cube")),
            "RELIEF_REFLECTION": float(REFLECTIONS.index(quality.reflection)),
            **self.light_constants,
        }


def write_parameters(body: Body) -> None:
    """Fill the parameters of a body; cheap, since the sliders of a user end here."""
    item, quality, p = body.item, body.quality, body.params
    p["world_from_object"] = placement_matrix(item.position, item.rotation, 1.0).T
    heights = body.maps.heights
    p["texels"] = heights.shape[1], heights.shape[0]
    p["tiling"], p["tile_m"] = item.tiling, body.hull.tile_m
    low, high = body.maps.low, body.maps.high
    p["solid_low"], p["translucent_low"] = low
    p["solid_high"], p["translucent_high"] = high
    p["hull_low"], p["hull_high"] = _hull_range(body, float(low[0]), float(high[0]), float(high[1]))
    clips = item.edges == "clip"
    p["clip_low"] = body.hull.clip_low if clips else (-1e9, -1e9)
    p["clip_high"] = body.hull.clip_high if clips else (1e9, 1e9)
    matter = item.matter
    n = matter.n_rgb if item.dispersion else np.full(3, matter.n_d)
    p["n_layer"], p["n_outside"] = n, item.ambient_n
    absorption = np.asarray(item.absorption_per_m, np.float64)
    p["absorption"] = absorption if quality.hue else absorption.mean()
    p["scattering"] = item.scattering
    p["specular_factor"] = 1.0 if item.specular_factor is None else item.specular_factor
    p["solid_roughness"], p["solid_specular"] = roughness_of(item.solid, SOLID_ROUGHNESS), item.solid.specular
    p["translucent_roughness"] = roughness_of(item.translucent, TRANSLUCENT_ROUGHNESS)
    p["linear_steps"], p["binary_steps"] = quality.linear_steps, quality.binary_steps
    p["linear_approximation"] = quality.linear_approximation
    p["refraction_linear"], p["refraction_binary"] = quality.refraction_steps
    p["adapt_angle"], p["adapt_distance"] = quality.adapt_angle, quality.adapt_distance
    p["complexity"] = quality.complexity
    p["silhouettes"] = quality.silhouettes
    p["color"] = (1.0, 1.0, 1.0) if isinstance(item.solid.colors, np.ndarray) else item.solid.colors
    p["color_texels"] = max(body.maps.colors[0].shape[:2])
    p["diffuse_down"], p["diffuse_back"] = diffuse_tables(item.ambient_n, (float(n[0]), float(n[1]), float(n[2])))


def _hull_range(body: Body, low: float, high: float, upper: float) -> tuple[float, float]:
    """Between which heights rays are followed; a little more than the layers need, so that rounding hides nothing."""
    if DEPTHS.get(body.step, 2) != 2:
        return 0.0, 0.0
    top = max(high, upper) if body.two_layers else high
    margin = max(MARGIN * (top - low), 1e-5 * max(abs(top), abs(low)), 1e-4 * min(body.hull.tile_m))
    return low - margin, top + margin


def moves(item: ReliefSurface) -> bool:
    """Whether heights of the surface change with time."""
    return item.solid.is_dynamic or (item.translucent is not None and item.translucent.is_dynamic)


def geometry_key(item: ReliefSurface) -> list[Any]:
    """What the hull of a surface is made of."""
    mesh = item.mesh
    return [mesh.vertices, mesh.faces, mesh.normals, mesh.uvs, item.tiles, item.tile_m, item.scale]


def maps_key(item: ReliefSurface, tile_m: tuple[float, float]) -> list[Any]:
    """What its maps are made of."""
    out: list[Any] = [item.tiling, tile_m]
    colors = item.solid.colors
    out.append(colors if isinstance(colors, np.ndarray) else None)
    for layer in (item.solid, item.translucent):
        parts = ("heights", "height_m", "base_m", "normals", "normal_convention")
        out += [None] * len(parts) if layer is None else [getattr(layer, name) for name in parts]
    return out


def is_same(a: list[Any], b: list[Any]) -> bool:
    """Arrays are told apart by identity: scene objects are values."""
    return all(x is y or (not _is_array(x) and not _is_array(y) and x == y) for x, y in zip(a, b, strict=True))


def _is_array(value: Any) -> bool:
    return isinstance(value, np.ndarray)
