"""Water that opaque surfaces stand in: what shading must know to light them through its surface.

A technique that draws water says with `Submersion.set` where its waters are and what fills them, and fills the maps of
the light that comes through their surfaces. `shaders/shade.wgsl` then lights what lies below a surface as

    sun:   E = E_0 l.y / l'.y  map  exp(-(a + b) s)     across the refracted direction l', s metres through the water,
           and what is scattered forward on the way, without the sharpness of the map;
    sky:   through Snell's window, weakened by the depth, and thrown back by the surface; see submerged_sky.wgsl;
    lamps: through the level surface, each along its own bent way, times a map of its own; see submerged_lamp.wgsl.

Radiance in water is n^2 times that in air; it is divided again where the view ray leaves the water. Without water an
override constant takes all of it out of the shaders, and pictures are the same to the last bit.

The maps lie on the level of each water, under a camera that looks along the light: a point p at the depth z is seen at
p.xz + slope z; for a lamp nearby it is seen where the bent way to it crosses the level. So a map covers the water
exactly, and under a flat surface it is the same at every depth. Red, green
and blue are the flux that comes to a place over that which falls on a level surface; alpha is the surface's height.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.errors import SceneError
from pellucid.optics import fresnel_dielectric
from pellucid.scene.water_outline import MOST_CORNERS, WaterShape
from pellucid.surroundings.diffuse import diffuse_tables
from pellucid.surroundings.environment import irradiance_basis, row_solid_angles
from pellucid.surroundings.layouts import (
    DIFFUSE_ENTRIES,
    MAX_WATER_LIGHTS,
    MAX_WATERS,
    SCATTER_AROUND,
    SCATTER_DOWN,
    SubmersionParams,
)
from pellucid.surroundings.open_sky import OpenSkyMaps
from pellucid.surroundings.sky_scatter import scatter_table, window_light

if TYPE_CHECKING:
    from pellucid.gpu import Device

MAP_FORMAT = "rgba16float"
DEPTH_FORMAT = "depth32float"
SKY_ROWS = 64  # of the environment that is summed for what comes through a surface
LEAST_COSINE = 0.05  # of light below a surface
LEVEL = np.array([(0.0, 1.0, 0.0), (0.0, -1.0, 0.0)])  # normals of a floor and a ceiling
PAINTED = ("sample", "storage", "copy", "render")

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class WaterRegion:
    """What stands in for one water.

    Attributes
    ----------
    level_m : height of the surface at rest. low_m, high_m : corners (x, z) of its rectangle.
    limits_m : lowest and highest wave over the level.
    n : index by channel, over that of what is above.
    absorption_per_m, scattering_per_m : by channel. asymmetry : mean cosine of the scattering angle.
    shape : what bounds it besides its surface; None for all that is below the rectangle.
    reach_m : how far below the highest wave meshes are told apart by the maps.
    slopes : (x, z) of the camera of each map, horizontal way over depth, towards the light.
    shadows : by map, whether meshes throw any.
    along : whether all those cameras look along the light that a level surface refracts.
    near : by map, whether it is that of a lamp nearby, over this water.
    shade_depth_m : how far below the highest wave meshes hide the sky from what lies there; 0 where they do not.
    """

    level_m: float
    low_m: tuple[float, float]
    high_m: tuple[float, float]
    limits_m: tuple[float, float] = (0.0, 0.0)
    n: Triple = (1.333, 1.333, 1.333)
    absorption_per_m: Triple = (0.0, 0.0, 0.0)
    scattering_per_m: Triple = (0.0, 0.0, 0.0)
    asymmetry: float = 0.0
    reach_m: float = 100.0
    slopes: tuple[tuple[float, float], ...] = ()
    shadows: tuple[bool, ...] = ()
    along: bool = False
    near: tuple[bool, ...] = ()
    shade_depth_m: float = 0.0
    shape: WaterShape | None = None


@dataclass
class SkyThroughSurface:
    """Light of an environment just below a level surface, over the environment's intensity.

    Attributes
    ----------
    irradiance : (3,) of the sky on a level surface. axis : (3,) unit, where it comes from, in the environment's space.
    ground : (3,) irradiance from below. back : (3,) share of matt light that the surface throws back.
    air : the same above the surface; None there.
    window : directions and light of `sky_scatter.window_light`. tables : by asymmetry, of `scatter_table`.
    """

    irradiance: np.ndarray = field(default_factory=lambda: np.zeros(3))
    axis: np.ndarray = field(default_factory=lambda: np.array([0.0, 1.0, 0.0]))
    ground: np.ndarray = field(default_factory=lambda: np.zeros(3))
    back: np.ndarray = field(default_factory=lambda: np.zeros(3))
    air: SkyThroughSurface | None = None
    window: tuple[np.ndarray, np.ndarray] | None = None
    tables: dict[float, np.ndarray] = field(default_factory=dict)

    def scattered(self, asymmetry: float) -> np.ndarray:
        """Table of what water of a mean cosine of scattering makes of it; the same array each time."""
        if asymmetry not in self.tables:
            ways, light = self.window or (np.array([(0.0, 1.0, 0.0)]), np.zeros((1, 3)))
            self.tables[asymmetry] = scatter_table(ways, light, asymmetry)
        return self.tables[asymmetry]


class Submersion:
    """The waters of one `Surroundings`, and the maps of the light that comes through their surfaces.

    Parameters
    ----------
    device : where the maps live. resources : bind group 1 by name, which gets the maps and loses none.

    Attributes
    ----------
    active : whether there is water; then shaders are run with ``SUBMERGED`` = 1.
    light_map : texture of one layer for each water and light, rgba16float; see the top of this file.
    version : grows whenever shading in water may change; whoever fills the maps of light adds to it.
    settled : grows with what `set` changed, not with what the maps of light hold.
    depth_map : texture of as many layers, depth32float, 0 at the highest wave and 1 at the reach of each water.
    """

    def __init__(self, device: Device, resources: dict[str, Any]) -> None:
        self.device = device
        self.active = False
        self.version = self.settled = 0
        self.regions: tuple[WaterRegion, ...] = ()
        self._resources = resources
        self._params = np.zeros((), SubmersionParams)
        self._size: tuple[int, int, int] | None = None
        self._sky: tuple[Any, ...] = ()
        self.open_sky = OpenSkyMaps(device, resources)
        resources["submersion"] = device.buffer(self._params, "uniform", "submersion")
        self._allocate(1, 1, 1)

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held."""
        assert self._size is not None
        side, depth_side, layers = self._size
        return self.open_sky.nbytes + SubmersionParams.itemsize + layers * (8 * side**2 + 4 * depth_side**2)

    @property
    def outlined(self) -> bool:
        """Whether a water has borders of its own; then shaders are run with ``SUBMERGED_OUTLINES`` = 1."""
        return any(region.shape is not None for region in self.regions)

    def is_above(self, p_ws: np.ndarray) -> bool:
        """Whether a point (3,) is above the highest wave of all waters, and sees what is in them through a surface."""
        return all(p_ws[1] > region.level_m + region.limits_m[1] for region in self.regions)

    def layer(self, water: int, light: int) -> int:
        """Layer of the maps of a water (its place in what `set` got) and the `light`-th directional light."""
        return sum(max(len(r.slopes), 1) for r in self.regions[:water]) + light

    def set(
        self,
        regions: Sequence[WaterRegion],
        map_size: int = 512,
        depth_size: int = 1024,
        sky: Sequence[SkyThroughSurface] | None = None,
    ) -> bool:
        """Say where there is water now; tells whether the maps were made anew, and so are empty.

        Parameters
        ----------
        regions : one for each water, at most ``MAX_WATERS``.
        map_size, depth_size : sides of the maps of light and of depth, texels.
        sky : light of the environment below each surface, of `Surroundings.sky_through`; dark if not given.

        Raises
        ------
        SceneError : more waters than there may be.
        """
        if len(regions) > MAX_WATERS:
            raise SceneError("scene.objects", f"hold {len(regions)} waters", f"use at most {MAX_WATERS}")
        self.regions, self.active = tuple(regions), bool(regions)
        layers = max(self.layer(len(regions), 0), 1)
        anew = self._allocate(map_size, depth_size, layers) if regions else self._allocate(1, 1, 1)
        params = np.zeros((), SubmersionParams)
        params["bounds"][:, :2], params["bounds"][:, 2:] = 1e30, -1e30
        params["index"], params["window"][:, 3] = 1.0, 1.0
        params["sky_axis"][:, 1] = params["air_axis"][:, 1] = 1.0
        for k, region in enumerate(regions):
            self._write(params, k, region, sky[k] if sky else SkyThroughSurface())
        if params.tobytes() != self._params.tobytes():
            self._params = params
            self.version += 1
            self.settled += 1
            self.device.write(self._resources["submersion"], params.reshape(1))
        return anew

    def _write(self, p: np.ndarray, k: int, region: WaterRegion, sky: SkyThroughSurface) -> None:
        p["bounds"][k] = *region.low_m, *region.high_m
        p["level"][k] = region.level_m, region.limits_m[1], self.layer(k, 0), region.reach_m
        if region.shape is not None:
            shape = region.shape
            p["shape"][k] = shape.kind, *shape.bend, shape.depth_m
            p["middle"][k] = *shape.middle, *shape.half
            p["edges"][k * MOST_CORNERS : (k + 1) * MOST_CORNERS] = every_edge(shape.edges)
        p["index"][k, :3] = region.n
        p["absorption"][k] = *region.absorption_per_m, region.shade_depth_m
        p["scattering"][k] = *region.scattering_per_m, region.asymmetry
        p["sky"][k, :3], p["sky_axis"][k, :3], p["ground"][k, :3] = sky.irradiance, sky.axis, sky.ground
        air = sky.air or sky
        p["air_sky"][k, :3], p["air_axis"][k, :3], p["air_ground"][k, :3] = air.irradiance, air.axis, air.ground
        p["window"][k] = *sky.back, min(1.0 / region.n[1] ** 2, 1.0)
        for light, slope in enumerate(region.slopes[:MAX_WATER_LIGHTS]):
            p["slope"][k * MAX_WATER_LIGHTS + light, :2] = slope
            p["slope"][k * MAX_WATER_LIGHTS + light, 2] = light < len(region.shadows) and region.shadows[light]
            p["slope"][k * MAX_WATER_LIGHTS + light, 3] = light < len(region.near) and region.near[light]
        if any(region.scattering_per_m):
            count = SCATTER_DOWN * SCATTER_AROUND
            p["scatter"][k * count : (k + 1) * count] = sky.scattered(region.asymmetry).reshape(-1, 4)
        down, back = diffuse_tables(1.0, region.n)
        rows = slice(k * DIFFUSE_ENTRIES, (k + 1) * DIFFUSE_ENTRIES)
        p["down"][rows], p["back"][rows] = down / np.maximum(down[-1], 1e-9), back

    def _allocate(self, side: int, depth_side: int, layers: int) -> bool:
        if self._size == (side, depth_side, layers):
            return False
        self.version += 1
        self.settled += 1
        self.light_map = self.device.texture(
            size=(side, side), format=MAP_FORMAT, layers=layers, usage=PAINTED, label="submerged light"
        )
        self.depth_map = self.device.texture(
            size=(depth_side, depth_side), format=DEPTH_FORMAT, layers=layers, usage=("sample", "render"), label="depth"
        )
        self._resources["submerged_light"] = self.light_map.create_view(dimension="2d-array")
        self._resources["submerged_depth"] = self.depth_map.create_view(dimension="2d-array")
        self._size = side, depth_side, layers
        return True


def every_edge(edges: np.ndarray) -> np.ndarray:
    """Edges (N, 4) of a polygon, and others that hold every point, up to as many as there may be."""
    return np.concatenate([edges, np.tile((0.0, 0.0, 0.0, 1.0), (MOST_CORNERS - len(edges), 1))])


def refracted_slope(towards: np.ndarray, n: float) -> tuple[float, float]:
    """Horizontal way over depth, (x, z) towards the light, of light refracted at a level surface.

    Parameters
    ----------
    towards : (3,) unit, to the light, y > 0. n : index of the water over that above.
    """
    aside = np.asarray(towards, np.float64)[[0, 2]] / n
    # Where the water is the rarer matter, light that slants far enters no level surface: then as it grazes below.
    slope = aside / np.sqrt(max(1.0 - float(aside @ aside), LEAST_COSINE**2))
    return float(slope[0]), float(slope[1])


def sky_through(pixels: np.ndarray, sh: np.ndarray, n: Triple) -> SkyThroughSurface:
    """Light of an environment just below a level surface.

    With F the reflectance from above, radiance L and n^2 cos' dw' = cos dw at the surface, the irradiance is the sum of
    (1 - F) L cos dw, and its vector that of (1 - F) L (direction'/cos') cos dw. What comes up is guessed: ground of the
    albedo rho that the environment shows, E_below/E_above, receives the light of the sky and what the surface throws
    back, n^2 (1 - R)/(1 - rho R) times as much as in air [saunderson1942].

    Parameters
    ----------
    pixels : (H, W, 3) radiance, row 0 towards +Y. sh : (9, 3) coefficients of its irradiance.
    n : index by channel, over that of what is above.
    """
    out = SkyThroughSurface(air=None if n == (1.0, 1.0, 1.0) else sky_through(pixels, sh, (1.0, 1.0, 1.0)))
    rows = pixels.shape[0]
    theta = np.pi * (np.arange(rows) + 0.5) / rows
    phi = 2.0 * np.pi * (np.arange(pixels.shape[1]) + 0.5) / pixels.shape[1] - np.pi
    upper = theta < 0.5 * np.pi
    cosine, sine = np.cos(theta[upper]), np.sin(theta[upper])
    solid = row_solid_angles(rows)[upper] / pixels.shape[1]
    across = np.stack([np.sin(phi), -np.cos(phi)])
    vector = np.zeros(3)
    for c, index in enumerate(n):
        passed = (1.0 - fresnel_dielectric(cosine, 1.0, index)) * cosine * solid
        inner = sine / index
        tangent = inner / np.sqrt(np.maximum(1.0 - inner**2, 1e-9))
        back = float(diffuse_tables(1.0, n)[1][-1, c])
        # The sum over texels of a uniform sky is brought to its exact value, so that furnaces hold.
        exact = np.pi * index**2 * (1.0 - back) / (passed.sum() * pixels.shape[1])
        rim = pixels[upper, :, c]
        out.irradiance[c] = exact * (passed @ rim.sum(axis=1))
        aside = exact * ((passed * tangent) @ (rim @ across.T))
        vector += (aside[0], out.irradiance[c], aside[1])
        above, below = (max(float(e), 0.0) for e in irradiance_basis(LEVEL) @ sh[:, c])
        rho = min(below / above, 1.0) if above > 0.0 else 0.0
        out.ground[c] = below * index**2 * (1.0 - back) / max(1.0 - rho * back, 1e-6)
        out.back[c] = back
    out.window = window_light(pixels, n[1], out.irradiance)
    length = float(np.linalg.norm(vector))
    if length > 0.0:
        out.axis = vector / length
        # |V| is the irradiance across the axis; on a level surface it gives V.y again.
        out.irradiance = out.irradiance / out.axis[1]
    return out


def small_sky(levels: Sequence[np.ndarray]) -> np.ndarray:
    """The level of an environment that is summed: the first of at most ``SKY_ROWS`` rows."""
    return next((level for level in levels if level.shape[0] <= SKY_ROWS), levels[-1]).astype(np.float64)


def cap_irradiance(cosine: np.ndarray, sine2: float) -> np.ndarray:
    """Irradiance of an even round patch of sky on a tilted surface, over that on one that faces it [snyder1996].

    Parameters
    ----------
    cosine : of the angle between normal and middle of the patch. sine2 : squared sine of its half angle.
    """
    c = np.clip(np.asarray(cosine, np.float64), -1.0, 1.0)
    tilt, sigma = np.sqrt(np.maximum(1.0 - c**2, 1e-12)), np.sqrt(sine2)
    x = np.sqrt(max(1.0 / sine2 - 1.0, 0.0))
    y = np.clip(-x * c / tilt, -1.0, 1.0)
    part = tilt * np.sqrt(1.0 - y**2)
    rim = ((c * np.arccos(y) - x * part) * sine2 + np.arctan2(part, x)) / (np.pi * sine2)
    return np.asarray(np.where(c >= sigma, c, np.where(c <= -sigma, 0.0, np.maximum(rim, 0.0))))
