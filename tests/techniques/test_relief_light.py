"""Light of lamps on the solid layer of a relief: shadows, what the translucent layer leaves of it, and caustics."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.errors import SceneError
from pellucid.gpu import Device
from pellucid.optics.fresnel import fresnel_dielectric
from pellucid.scene.relief_quality import ReliefQuality
from pellucid.techniques.relief.light import mapped_lights, plane_of
from pellucid.techniques.relief.reference import HeightField, ReliefRays, first_below

TILE = 0.1
N = 1.33


class Lit:
    """Light maps of one surface after another, by the technique that draws them."""

    def __init__(self, device: Device) -> None:
        from pellucid.surroundings import Surroundings
        from pellucid.techniques.relief.passes import ReliefTechnique

        self.device = device
        self.technique = ReliefTechnique(device)
        self.surroundings = Surroundings(device)

    def maps(self, surface: pl.ReliefSurface, *lamps: Any) -> Any:
        camera = pl.Camera(position=(0.0, 0.3, 0.3), target=(0.0, 0.0, 0.0))
        self.surroundings.prepare(pl.Scene(camera=camera, lights=lamps, objects=[surface]), (8, 8))
        self.technique.prepare([surface], self.surroundings)
        self.technique.illuminate(lamps, self.surroundings)
        return self.technique._light_maps[0]

    def shares(self, surface: pl.ReliefSurface, *lamps: Any) -> np.ndarray:
        """(lamps, H, W, 3)"""
        texture = self.maps(surface, *lamps).light_map
        return np.stack([self.device.read_texture(texture, layer=k)[..., :3] for k in range(len(lamps))]).astype(float)

    def caustic(self, surface: pl.ReliefSurface, lamp: Any) -> np.ndarray:
        return self.device.read_texture(self.maps(surface, lamp).caustic_map)[..., :3].astype(float)


@pytest.fixture(scope="module")
def lit(device: Device) -> Lit:
    return Lit(device)


def waves(amplitude: float, size: int = 64, seed: int = 1) -> np.ndarray:
    """Smooth, and the same at both borders."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(size) / size, np.arange(size) / size)
    out = sum(np.sin(2 * np.pi * (a * x + b * y + rng.random())) for a, b in ((1, 1), (2, -1), (-1, 3), (3, 2)))
    return amplitude * np.asarray(out) / 4


def relief(solid: np.ndarray, translucent: np.ndarray | None = None, *, tile_m: Any = TILE, **look: Any) -> Any:
    quality = {"occlusion": "texture", **look.pop("quality", {})}
    upper = None if translucent is None else pl.ReliefLayer(translucent)
    size = 3 * np.broadcast_to(tile_m, 2)
    return pl.ReliefSurface.plane(
        (float(size[0]), float(size[1])),
        pl.ReliefLayer(solid),
        upper,
        tile_m=tile_m,
        quality=ReliefQuality(**quality),
        **look,
    )


def towards(elevation_deg: float, azimuth_deg: float = 0.0) -> np.ndarray:
    """Unit vector to a lamp over the plane y = 0, azimuth from +x (u) to -z (v)."""
    e, a = np.radians([elevation_deg, azimuth_deg])
    return np.array([np.cos(e) * np.cos(a), np.sin(e), -np.cos(e) * np.sin(a)])


def sun(elevation_deg: float, azimuth_deg: float = 0.0, radius_deg: float = 0.0) -> pl.DirectionalLight:
    way = -towards(elevation_deg, azimuth_deg)
    return pl.DirectionalLight((float(way[0]), float(way[1]), float(way[2])), angular_radius_deg=radius_deg)


def traced_share(heights: np.ndarray, elevation_deg: float, azimuth_deg: float) -> np.ndarray:
    """Of four rays a texel, how many meet nothing once they have left their first texel; in float64."""
    rows, columns = heights.shape
    y, x = (np.mgrid[0 : 2 * rows, 0 : 2 * columns].reshape(2, -1) + 0.5) / 2.0
    uv = np.stack([x / columns, 1.0 - y / rows], axis=1)
    to = towards(elevation_deg, azimuth_deg)
    way = np.array([to[0], -to[2], to[1]])
    field = HeightField(heights)
    start = TILE / heights.shape[0] / np.abs(way[:2]).max()
    rays = ReliefRays.of(uv, field.height(uv), np.tile(way, (len(uv), 1)), (TILE, TILE))
    moved = ReliefRays(rays.uv_at(np.full(len(uv), start)), rays.h + start * rays.dh, rays.duv, rays.dh, rays.bend)
    free = np.isinf(first_below(field, moved, 3 * TILE))
    return np.asarray(free.reshape(rows, 2, columns, 2).mean(axis=(1, 3)))


def disc_share(x: np.ndarray) -> np.ndarray:
    x = np.clip(x, -1.0, 1.0)
    return np.asarray(0.5 + (x * np.sqrt(1 - x * x) + np.arcsin(x)) / np.pi)


@pytest.mark.parametrize("azimuth", [20.0, 200.0])
def test_hard_shadows_are_those_of_traced_rays(lit: Lit, azimuth: float) -> None:
    heights = waves(0.02)
    seen = lit.shares(relief(heights, quality={"shadows": "hard"}), sun(25.0, azimuth))[0, ..., 0]
    truth = traced_share(heights, 25.0, azimuth)
    assert 0.2 < truth.mean() < 0.9
    assert np.abs(seen - truth).mean() < 0.002


def test_horizon_maps_agree_with_traced_rays_but_at_the_borders_of_shadows(lit: Lit) -> None:
    heights = waves(0.02)
    for azimuth in (0.0, 31.0, 250.0):  # 31 degrees lies between two of the directions of the map
        seen = lit.shares(relief(heights, quality={"shadows": "horizon"}), sun(25.0, azimuth))[0, ..., 0]
        assert ((seen > 0.5) != (traced_share(heights, 25.0, azimuth) > 0.5)).mean() < 0.055


def wall(columns: int = 512) -> tuple[np.ndarray, np.ndarray]:
    """A wall 5 mm high in the middle of a tile, and how far every column lies from its edge, metres."""
    heights = np.zeros((4, columns))
    middle = columns // 2
    heights[:, middle : middle + 8] = 0.005
    return heights, (middle - np.arange(columns)) * TILE / columns


@pytest.mark.parametrize("shadows", ["soft", "horizon"])
def test_a_penumbra_is_as_wide_as_the_lamp_is_seen(lit: Lit, shadows: str) -> None:
    """Behind a wall the edge stands at atan(H / x), and the lamp's disc rises over it."""
    heights, x = wall()
    surface = relief(heights, quality={"shadows": shadows})
    behind = (x > 0.001) & (x < 0.015)
    edge = np.degrees(np.arctan(0.005 / x[behind]))
    for radius in (2.0, 4.0, 8.0):
        share = lit.shares(surface, sun(45.0, 0.0, radius))[0, 1, :, 0]
        np.testing.assert_allclose(share[behind], disc_share((45.0 - edge) / radius), atol=0.02)


def test_a_penumbra_is_proportional_to_radius_over_distance(lit: Lit) -> None:
    """[timonen2006, eq. 2]: w / l = h / d, for rectangles of several sizes at several distances."""
    heights, x = wall(1024)
    surface = pl.ReliefSurface.plane(
        TILE, pl.ReliefLayer(heights), tiling=False, quality=ReliefQuality(occlusion="texture", shadows="soft")
    )
    widths, ratios = [], []
    for distance, radius in ((0.5, 0.05), (1.0, 0.05), (1.0, 0.1), (2.0, 0.1)):
        edge, to = radius * np.sqrt(np.pi), distance * towards(45.0)
        lamp = pl.AreaLight(tuple(to), (edge, 0.0, 0.0), (0.0, 0.0, edge))  # type: ignore[arg-type]
        share = lit.shares(surface, lamp)[0, 1, :, 0]
        widths.append(np.interp([0.2, 0.8], share[300:500][::-1], x[300:500][::-1]) @ [-1, 1])
        ratios.append(radius / distance)
    assert np.abs(np.array(widths) / ratios / (widths[1] / ratios[1]) - 1.0).max() < 0.06


def test_a_level_layer_takes_what_fresnel_and_absorption_take(lit: Lit) -> None:
    solid, depth, absorption = np.full((8, 8), -0.01), 0.012, (30.0, 10.0, 0.0)
    layer = np.full((8, 8), 0.002)
    for elevation in (90.0, 50.0, 20.0):
        cos_i = np.sin(np.radians(elevation))
        through = 1.0 - fresnel_dielectric(cos_i, 1.0, N)
        bent = depth / np.sqrt(1.0 - (1.0 - cos_i**2) / N**2)
        look = {"medium": N, "absorption": absorption}
        share = lit.shares(relief(solid, layer, **look), sun(elevation, 40.0))[0]
        np.testing.assert_allclose(
            share, np.broadcast_to(through * np.exp(-np.array(absorption) * bent), share.shape), rtol=1e-3
        )


def test_light_through_drops_is_the_same_in_texels_and_in_fragments(device: Device) -> None:
    from pellucid.renderer import Renderer

    solid, water = waves(0.002, seed=2), 0.004 + waves(0.006)
    camera = pl.Camera(position=(0.0, 0.09, 0.03), target=(0.0, 0.0, 0.0), fov_deg=40.0)
    renderer, pictures = Renderer(device), []
    for occlusion in ("texture", "fragment"):
        surface = relief(solid, water, medium=N, absorption=(40.0, 15.0, 5.0), quality={"occlusion": occlusion})
        scene = pl.Scene(
            camera=camera, lights=[sun(60.0, 30.0)], objects=[surface], environment=pl.Environment.constant(0.0)
        )
        pictures.append(renderer.render(scene, (64, 48)).radiance.astype(float))
    difference = np.abs(pictures[0] - pictures[1]).mean(axis=(0, 1)) / pictures[1].mean(axis=(0, 1))
    assert (pictures[1].mean(axis=(0, 1)) > 0.01).all()
    assert difference.max() < 0.02


def test_no_light_of_a_caustic_is_lost(lit: Lit) -> None:
    """What lands is what the interface lets in: the mean over a tile of (l.n) / (n.N) / (l.N) (1 - R)."""
    water = waves(0.002)
    surface = relief(np.full((64, 64), -0.03), water, medium=N, absorption=(0.0, 0.0, 0.0), quality={"caustics": True})
    from pellucid.fields.heightfield import slopes_of

    slopes = slopes_of(water, (TILE / 64, TILE / 64)).astype(float)
    for elevation, azimuth in ((90.0, 0.0), (55.0, 70.0)):
        to = towards(elevation, azimuth)
        facing = to[1] - slopes[..., 0] * to[0] + slopes[..., 1] * to[2]
        cosine = facing / np.sqrt(1.0 + (slopes**2).sum(axis=-1))
        entering = facing / to[1] * (1.0 - fresnel_dielectric(cosine, 1.0, N))
        assert (facing / to[1]).mean() == pytest.approx(1.0, abs=1e-6)
        caustic = lit.caustic(surface, sun(elevation, azimuth))
        assert caustic.std() > 0.1
        np.testing.assert_allclose(caustic.mean(axis=(0, 1)), entering.mean(), rtol=1e-3)


def test_a_ripple_focuses_first_at_its_focal_length(lit: Lit) -> None:
    """Under a crest of curvature kappa light meets at the depth 1 / (kappa (1 - 1/n))."""
    columns, amplitude = 1024, 2e-3
    wave = 2 * np.pi / TILE
    crest = columns // 4
    ripple = np.tile(amplitude * np.sin(wave * (np.arange(columns) + 0.5) / columns * TILE), (4, 1))
    focal = 1.0 / (amplitude * wave**2 * (1.0 - 1.0 / N))
    depths = focal * np.linspace(0.52, 1.48, 17)
    look = {"medium": N, "absorption": (0.0, 0.0, 0.0), "quality": {"caustics": True}, "tile_m": (TILE, 0.01)}
    under = [
        lit.caustic(relief(np.full((4, columns), -d), ripple, **look), sun(90.0))[1, crest - 1 : crest + 1, 0].mean()
        for d in depths
    ]
    assert max(under) > 4.0
    assert depths[int(np.argmax(under))] == pytest.approx(focal, rel=0.07)


def test_dispersion_parts_the_colours_of_a_caustic(lit: Lit) -> None:
    """Blue is bent more: over a bottom that lies before the focus it is gathered more."""
    ripple = waves(0.002)
    look = {"absorption": (0.0, 0.0, 0.0), "quality": {"caustics": True}, "medium": "N-SF11"}
    solid = np.full((64, 64), -0.02)
    parted = lit.caustic(relief(solid, ripple, dispersion=True, **look), sun(90.0))
    alike = lit.caustic(relief(solid, ripple, **look), sun(90.0))
    assert np.abs(alike - alike[..., :1]).max() == 0.0
    assert (np.diff(parted.std(axis=(0, 1))) > 0.0).all()
    np.testing.assert_allclose(parted.mean(axis=(0, 1)), alike.mean(axis=(0, 1)), rtol=0.01)


def test_light_is_worked_out_once_for_each_move(lit: Lit, device: Device) -> None:
    surface = relief(waves(0.02), quality={"shadows": "hard"})
    lamp = sun(30.0, 20.0)
    runs = lit.maps(surface, lamp).runs
    assert lit.maps(surface, lamp).runs == runs
    known = len(device.cache), len(lit.technique.pipelines)
    assert lit.maps(surface, sun(31.0, 20.0)).runs == runs + 1
    assert lit.maps(surface.replace(rotation=(10.0, 0.0, 0.0)), sun(31.0, 20.0)).runs == runs + 2
    assert (len(device.cache), len(lit.technique.pipelines)) == known


def test_maps_are_for_planes_and_lamps_that_see_all_tiles_alike() -> None:
    from pellucid.techniques.relief.prepare import hull

    solid = pl.ReliefLayer(np.zeros((4, 4)))
    tiled, one = hull(pl.ReliefSurface.plane(1.0, solid, tile_m=0.25)), hull(pl.ReliefSurface.plane(1.0, solid))
    ball = hull(pl.ReliefSurface.sphere(0.1, solid))
    lamps = [sun(40.0), pl.PointLight((0.0, 1.0, 0.0))]
    assert mapped_lights(lamps, tiled) == 0b01 and mapped_lights(lamps, one) == 0b11
    assert plane_of(ball, np.eye(4)) is None
    plane = plane_of(tiled, np.eye(4))
    assert plane is not None
    np.testing.assert_allclose(plane["tangent"], (0.25, 0.0, 0.0), atol=1e-6)
    np.testing.assert_allclose(plane["normal"], (0.0, 1.0, 0.0), atol=1e-6)


def test_a_lamp_has_no_radius_out_of_range() -> None:
    with pytest.raises(SceneError, match="angular_radius_deg"):
        pl.DirectionalLight((0.0, -1.0, 0.0), angular_radius_deg=80.0)
