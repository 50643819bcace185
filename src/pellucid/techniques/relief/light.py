"""Light of the lamps on the solid layer of a relief, texel by texel, once a lamp has moved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.fields.horizon import horizon_map
from pellucid.scene import DirectionalLight
from pellucid.scene.relief_quality import SHADOWS, ReliefQuality
from pellucid.techniques.relief.layouts import ReliefBeam, ReliefParams, ReliefPlane

if TYPE_CHECKING:
    from pellucid.gpu import Device, Pipelines
    from pellucid.techniques.relief.frames import Hull

SHADERS = "techniques/relief/shaders/"
MAP_FORMAT = "rgba16float"
MAPPED_LIGHTS = 32  # bits of ReliefParams.mapped_lights
GROUP = 8


def plane_of(hull: Hull, world_from_object: np.ndarray) -> np.ndarray | None:
    """The plane with one frame that a mesh lies on; light maps are true there.

    Parameters
    ----------
    hull : of the mesh. world_from_object : (4, 4) without the scale, which the hull has already.

    Returns
    -------
    () record of `layouts.ReliefPlane`, world; None for a mesh that is curved, or whose texture is stretched unevenly.
    """
    own = hull.plane
    if own is None:
        return None
    plane, world = np.zeros((), ReliefPlane), np.asarray(world_from_object, np.float64)
    plane["origin"] = world[:3, :3] @ own["origin"] + world[:3, 3]
    for name in ("tangent", "bitangent", "normal"):
        plane[name] = world[:3, :3] @ own[name]
    return plane


def mapped_lights(lamps: Sequence[object], hull: Hull) -> int:
    """Bits of the lamps whose light is the same in each tile of a plane: all of them where there is one tile."""
    u, v = hull.vertices["u"], hull.vertices["v"]
    slack = 1e-4
    one_tile = min(u.min(), v.min()) >= -slack and max(u.max(), v.max()) <= 1.0 + slack
    return sum(1 << k for k, lamp in enumerate(lamps[:MAPPED_LIGHTS]) if one_tile or isinstance(lamp, DirectionalLight))


def light_constants(quality: ReliefQuality, lamps: Sequence[object], mapped: int) -> dict[str, float]:
    """Override constants of the shaders of light; the place of a lamp is not among them.

    Parameters
    ----------
    mapped : bits of the lamps that have a layer of the light map.
    """
    occluded = quality.occlusion != "none"
    # Light that is followed through the translucent layer is stopped by the solid one as well.
    shadows = "hard" if occluded and quality.shadows == "none" else quality.shadows
    all_mapped = mapped == (1 << len(lamps)) - 1
    return {
        "RELIEF_SHADOWS": float(SHADOWS.index(shadows)),
        "RELIEF_OCCLUSION": float(occluded),
        "RELIEF_LIGHT_STEPPED": float(quality.search == "linear"),
        "RELIEF_LIGHT_MAPS": float(mapped != 0),
        "RELIEF_LIGHT_RAYS": float(shadows != "none" and not all_mapped),
        "RELIEF_CAUSTICS": float(quality.caustics and mapped != 0),
    }


class LightMaps:
    """Light maps of one relief: a layer a lamp, each as large as the map of heights.

    Attributes
    ----------
    light_map, caustic_map : textures, one texel while there are none.
    runs : how often they were computed.
    """

    def __init__(self, device: Device, pipelines: Pipelines) -> None:
        self.device, self.pipelines = device, pipelines
        self.runs = 0
        self.nbytes = 0
        self._size: tuple[int, int, int, bool] | None = None
        self._state: Any = None
        self._planes: list[Any] = []
        self._horizon: tuple[Any, Any, Any] | None = None
        self._params = device.buffer(ReliefParams.itemsize, "uniform", "relief of light maps")
        self._allocate((1, 1, 1, False))

    @property
    def bindings(self) -> dict[str, Any]:
        """Views to bind in the shaders that read the maps."""
        return {"light_map": self._light_view, "relief_caustic_map": self._caustic_view}

    def update(
        self,
        bound: Mapping[str, Any],
        params: np.ndarray,
        plane: np.ndarray,
        lights: int,
        constants: Mapping[str, float],
        state: Any,
    ) -> bool:
        """Compute the maps of all lamps, unless all is as it was at the last call; tells whether it did.

        Parameters
        ----------
        bound : resources of groups 0 and 1. params : () record of `layouts.ReliefParams`. plane : see `plane_of`.
        lights : how many lamps there are. constants : of the shaders. state : what else light depends on.
        """
        caustics = constants["RELIEF_CAUSTICS"] != 0.0
        texels = (int(params["texels"][0]), int(params["texels"][1]))
        state = (params.tobytes(), plane.tobytes(), dict(constants), state)
        self._allocate((*texels, max(lights, 1), caustics))
        if state == self._state or not lights:
            return False
        parts = _channels(params)
        self._write_planes(plane, lights, parts)
        endless = params.copy()
        if params["tiling"]:
            # All tiles share one map: that of a tile in the midst of many.
            endless["clip_low"], endless["clip_high"] = -1e9, 1e9
        self.device.write(self._params, endless.reshape(1))
        width, height = (-(-side // GROUP) for side in texels)
        bound = {**bound, "relief": self._params}
        own = {"light_map_out": self._light_view, "plane": self._planes[0]}
        self._run("light_map", constants, (width, height, lights), {**bound, **own})
        own = {
            "caustic_beams": self._beams, "caustic_sums": self._sums, "caustic_map_out": self._caustic_view
        }  # fmt: skip
        for light in range(lights if caustics else 0):
            of_light = self._planes[light * len(parts) : (light + 1) * len(parts)]
            for part in of_light:
                for name in ("caustic_refract", "caustic_splat"):
                    self._run(name, constants, (width, height, 1), {**bound, **own, "plane": part})
            self._run("caustic_resolve", constants, (width, height, 1), {**bound, **own, "plane": of_light[0]})
        self._state = state
        self.runs += 1
        return True

    def _run(self, name: str, constants: Mapping[str, float], groups: tuple[int, int, int], bound: Any) -> None:
        self.pipelines.kernel(SHADERS + name, constants).run(groups, bound)

    def horizon(self, heights: np.ndarray, tile_m: tuple[float, float], tiling: bool, kept: Any) -> Any:
        """View of the horizon map of the solid layer; `kept` is what its heights came from, told apart by identity."""
        state = (tile_m, tiling, heights.shape)
        if self._horizon is None or self._horizon[0] is not kept or self._horizon[1] != state:
            rows, columns = heights.shape
            stack = horizon_map(heights, (tile_m[0] / columns, tile_m[1] / rows), tiling)
            texture = self.device.texture(size=(columns, rows), format="r16float", layers=len(stack), label="horizons")
            self.device.write_texture(texture, stack[..., None].astype(np.float16))
            self._horizon = kept, state, texture.create_view(dimension="2d-array")
        return self._horizon[2]

    def _allocate(self, size: tuple[int, int, int, bool]) -> None:
        if size == self._size:
            return
        width, height, layers, caustics = size
        self.light_map = self._texture((width, height), layers, "light map")
        self.caustic_map = self._texture((width, height) if caustics else (1, 1), layers, "caustic map")
        self._light_view = self.light_map.create_view(dimension="2d-array")
        self._caustic_view = self.caustic_map.create_view(dimension="2d-array")
        texels = width * height if caustics else 1
        device = self.device
        self._beams = device.buffer(ReliefBeam.itemsize * texels, label="caustic beams")
        self._sums = device.buffer(np.zeros(3 * texels, np.uint32), label="caustic sums")
        self.nbytes = 8 * layers * (width * height + texels) + (ReliefBeam.itemsize + 12) * texels
        self._size, self._state = size, None

    def _texture(self, size: tuple[int, int], layers: int, label: str) -> Any:
        usage = ("sample", "storage")
        return self.device.texture(size=size, format=MAP_FORMAT, layers=layers, usage=usage, label=label)

    def _write_planes(self, plane: np.ndarray, lights: int, parts: list[tuple[float, tuple[float, ...]]]) -> None:
        records = np.repeat(plane.reshape(1), lights * len(parts))
        records["light"] = np.repeat(np.arange(lights), len(parts))
        records["n_layer"] = np.tile([n for n, _ in parts], lights)
        records["channels"] = np.tile([channels for _, channels in parts], (lights, 1))
        while len(self._planes) < len(records):
            self._planes.append(self.device.buffer(ReliefPlane.itemsize, "uniform", "relief plane"))
        for buffer, record in zip(self._planes, records, strict=False):
            self.device.write(buffer, record.reshape(1))


def _channels(params: np.ndarray) -> list[tuple[float, tuple[float, ...]]]:
    """(index, which of red, green and blue) of light that is refracted together."""
    n = params["n_layer"]
    if n[0] == n[1] == n[2]:
        return [(float(n[1]), (1.0, 1.0, 1.0))]
    return [(float(n[k]), tuple(float(k == j) for j in range(3))) for k in range(3)]
