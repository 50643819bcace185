"""Water with borders of its own: what is seen through them, where they are, and what counts as in the water."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.optics.fresnel import fresnel_dielectric
from pellucid.optics.snell import reflect, refract
from water_scenes import rays, sines

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.renderer import Renderer

N = 1.333
SIZE = (64, 48)
EVEN = (0.3, 0.5, 0.7)
FIVE = [(-1.0, -0.8), (1.0, -0.6), (0.9, 0.5), (0.0, 1.0), (-0.9, 0.6)]
BODIES: dict[str, dict[str, Any]] = {
    "cylinder": {"outline": "ellipse", "extent_m": (2.0, 1.6), "depth_m": 0.8},
    "bowl": {"outline": "ellipse", "extent_m": (2.0, 1.6), "depth_m": 0.7, "floor": "round"},
    "goldfish": {"outline": "ellipse", "extent_m": 1.6, "depth_m": 1.3, "floor": "round"},
    "bucket": {"outline": "ellipse", "extent_m": 2.0, "depth_m": 0.8, "floor_scale": 0.6},
    "cone": {"outline": "ellipse", "extent_m": 2.0, "depth_m": 0.8, "floor_scale": 0.0},
    "box": {"extent_m": (2.0, 1.5), "depth_m": 0.8},
    "tray": {"extent_m": (2.0, 1.5), "depth_m": 0.5, "floor_scale": 0.7},
    "five corners": {"outline": FIVE, "depth_m": 0.8, "floor_scale": 0.9},
    "endless": {"outline": "ellipse", "extent_m": 2.0},
}


@pytest.fixture(scope="module")
def renderer(device: Device) -> Renderer:
    from pellucid.renderer import Renderer

    return Renderer(device)


def camera_at(position: tuple[float, float, float], target: tuple[float, float, float], **look: float) -> pl.Camera:
    return pl.Camera(position=position, target=target, **({"fov_deg": 50.0, "near_m": 0.01} | look))


VIEWS = {
    "above": camera_at((0.0, 1.5, 3.0), (0.0, -0.3, 0.0)),
    "aside": camera_at((2.5, 0.1, 2.5), (0.0, -0.4, 0.0)),
    "below": camera_at((1.0, -2.5, 1.5), (0.0, -0.3, 0.0)),
    "within": camera_at((0.3, -0.2, 0.2), (-1.0, -0.25, -0.3), fov_deg=100.0),
    "parallel": camera_at((2.0, 0.7, 2.5), (0.0, -0.4, 0.0), orthographic_height_m=2.5),
}


@pytest.mark.parametrize("wavy", [False, True])
@pytest.mark.parametrize("body", BODIES)
def test_lossless_water_that_stands_free_vanishes_in_an_even_sky(body: str, wavy: bool, renderer: Renderer) -> None:
    """All that is mirrored and refracted at any border adds up to one."""
    water = pl.Water(medium=N, waves=sines(0.05) if wavy else None, **BODIES[body])
    sky = pl.Environment.constant(EVEN)
    for camera in VIEWS.values():
        frame = renderer.render(pl.Scene(camera=camera, environment=sky, objects=[water]), size=SIZE)
        assert frame.radiance == pytest.approx(np.broadcast_to(EVEN, frame.radiance.shape), rel=1e-5)


@pytest.mark.parametrize("view", ["above", "aside", "below", "parallel"])
@pytest.mark.parametrize("body", BODIES)
def test_silhouettes_are_those_of_the_shape(body: str, view: str, renderer: Renderer) -> None:
    water = pl.Water(medium=N, level=0.2, center=(0.1, -0.2), **BODIES[body])
    place = np.array([0.1, 0.2, -0.2])
    camera = VIEWS[view]
    frame = renderer.render(pl.Scene(camera=camera, objects=[water]), size=SIZE)
    origins, ways, cosine = rays(camera, SIZE)
    # Points all along each ray, in metres from the middle of the surface; a grazed border may lie between two.
    shape, middle = water.shape, np.array([water.shape.middle[0], 0.2, water.shape.middle[1]])
    t = np.linspace(0.0, 7.0, 3501)
    points = origins[:, None] + t[:, None] * ways[:, None] - middle
    inside = shape.holds(points) & (points[..., 1] <= 0.0)
    found = np.isfinite(frame.depth.reshape(-1))
    assert found.sum() > 100 and (inside.any(axis=1) != found).sum() <= 4
    both = inside.any(axis=1) & found
    first = t[np.argmax(inside[both], axis=1)]
    near = first < 6.0
    way = frame.depth.reshape(-1)[both] / cosine[both]
    assert np.abs(way - first)[near].max() < 2.1e-3  # one step
    assert place[1] == water.level


def through_ball(origins: np.ndarray, ways: np.ndarray, radius: float, height: float, sigma: float) -> np.ndarray:
    """Radiance in an even sky of 1, float64: the part below y = 0 of a ball of water about (0, height, 0)."""

    def ball(o: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        m = o - (0.0, height, 0.0)
        b, c = (m * d).sum(1), (m * m).sum(1) - radius**2
        root = np.sqrt(np.maximum(b * b - c, 0.0))
        miss = b * b < c
        return np.where(miss, np.inf, -b - root), np.where(miss, -np.inf, -b + root)

    with np.errstate(divide="ignore", invalid="ignore"):
        near, far = ball(origins, ways)
        level = -origins[:, 1] / ways[:, 1]
        down = ways[:, 1] < 0.0
        enters, leaves = np.where(down, level, -np.inf), np.where(down, np.inf, level)
        t = np.maximum(near, enters)
        hit = (t < np.minimum(far, leaves)) & (t > 0.0)
        origins, ways, flat = origins[hit] + t[hit, None] * ways[hit], ways[hit], (enters > near)[hit]
    normal = np.where(flat[:, None], (0.0, 1.0, 0.0), (origins - (0.0, height, 0.0)) / radius)
    total = fresnel_dielectric(-(ways * normal).sum(1), 1.0, N)
    share = 1.0 - total
    ways = refract(ways, normal, 1.0, N).direction
    for _ in range(60):
        with np.errstate(divide="ignore", invalid="ignore"):
            far, level = ball(origins, ways)[1], -origins[:, 1] / ways[:, 1]
        up = (ways[:, 1] > 0.0) & (level < far)
        end = np.maximum(np.where(up, level, far), 0.0)
        origins = origins + end[:, None] * ways
        normal = np.where(up[:, None], (0.0, 1.0, 0.0), origins - (0.0, height, 0.0))
        normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
        share = share * np.exp(-sigma * end)
        mirrored = fresnel_dielectric(np.clip((ways * normal).sum(1), 0.0, 1.0), N, 1.0)
        total, share = total + share * (1.0 - mirrored), share * mirrored
        ways = reflect(ways, -normal)
    assert np.isfinite(total).all()
    result = np.ones(len(hit))
    result[hit] = total
    return result


@pytest.mark.parametrize("view", ["above", "aside", "below", "parallel"])
@pytest.mark.parametrize(("radius", "depth"), [(1.0, 0.6), (0.8, 1.3)])
def test_a_round_floor_is_a_balls_and_dims_light_as_it_should(
    radius: float, depth: float, view: str, renderer: Renderer
) -> None:
    ball, sigma = (radius**2 + depth**2) / (2.0 * depth), 0.9
    ink = pl.media.constant(N, (sigma, sigma, sigma))
    water = pl.Water(outline="ellipse", extent_m=2 * radius, depth_m=depth, floor="round", medium=ink)
    scene = pl.Scene(camera=VIEWS[view], environment=pl.Environment.constant(1.0), objects=[water])
    found = renderer.render(scene, size=SIZE).radiance[..., 1].reshape(-1)
    origins, ways, _ = rays(VIEWS[view], SIZE)
    exact = through_ball(origins, ways, ball, ball - depth, sigma)
    assert (exact < 0.9).sum() > 200
    # Less than 0.002 of the light is not followed to its end. Edges, and rays that graze, are decided by rounding.
    assert np.mean(np.abs(found - exact) > 2.5e-3) < 0.003


@pytest.mark.parametrize(("extent", "thickness"), [((2.0, 1.5), 1.5), ((3.0, 0.4), 0.4)])
@pytest.mark.parametrize("outline", ["rectangle", "ellipse"])
def test_light_straight_through_is_that_of_a_plate(
    outline: str, extent: tuple[float, float], thickness: float, renderer: Renderer
) -> None:
    """R + (1 - R)^2 T / (1 - R T), the sum over all that is thrown to and fro between two borders."""
    sigma = np.array([0.3, 1.0, 2.5])
    water = pl.Water(outline=outline, extent_m=extent, depth_m=1.0, medium=pl.media.constant(N, tuple(sigma)))
    camera = camera_at((0.0, -0.5, 4.0), (0.0, -0.5, 0.0), orthographic_height_m=1e-3)
    scene = pl.Scene(camera=camera, environment=pl.Environment.constant(1.0), objects=[water])
    found = renderer.render(scene, size=(5, 5)).radiance[2, 2]
    r, t = fresnel_dielectric(1.0, 1.0, N), np.exp(-sigma * thickness)
    assert found == pytest.approx(r + (1.0 - r) ** 2 * t / (1.0 - r * t), abs=1e-4)


def test_a_bowl_hides_the_water_in_it_and_stays_dry_outside(renderer: Renderer) -> None:
    """Its wall lies beyond the water: whatever is in it, it looks the same from outside."""
    angle, around = np.meshgrid(np.radians(np.linspace(-90.0, 4.0, 30)), 2 * np.pi * np.arange(48) / 48)
    shells = [
        np.stack([r * np.cos(angle) * np.cos(around), r * np.sin(angle), r * np.cos(angle) * np.sin(around)], -1)
        for r in (1.0, 1.06)
    ]
    i = np.arange(angle.size).reshape(angle.shape)
    a, b = i[:, :-1].ravel(), i[:, 1:].ravel()
    c, d = np.roll(i, -1, 0)[:, :-1].ravel(), np.roll(i, -1, 0)[:, 1:].ravel()
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([b, d, c], -1)])
    bowl = [pl.Mesh(shell.reshape(-1, 3), faces, base_color=(0.8, 0.7, 0.6)) for shell in shells]
    water = pl.Water(outline="ellipse", extent_m=2.06, depth_m=1.03, floor="round", medium="ink")
    sun = pl.DirectionalLight(direction=(0.6, -0.7, -0.4))
    for position in ((2.0, -1.5, 2.5), (2.4, 0.0, 2.0), (0.5, -3.0, 0.3)):
        look = {"camera": camera_at(position, (0.0, -0.4, 0.0)), "environment": pl.Environment.sky(), "lights": [sun]}
        full, empty = (
            renderer.render(pl.Scene(objects=things, **look), size=SIZE) for things in ([*bowl, water], bowl)
        )
        assert np.isfinite(empty.depth).sum() > 400
        assert np.array_equal(full.radiance, empty.radiance) and np.array_equal(full.depth, empty.depth)
    inner = {**look, "camera": camera_at((0.0, 2.0, 1.0), (0.0, -0.5, 0.0))}
    full, empty = (renderer.render(pl.Scene(objects=t, **inner), size=SIZE).radiance for t in ([*bowl, water], bowl))
    assert full[30, 32].max() < 0.5 * empty[30, 32].min()


def test_a_pool_may_have_any_outline_and_is_lit_below_as_before(renderer: Renderer) -> None:
    """In the middle of a pool that is wide, its outline makes no difference: rays, waves, caustics, shadows."""
    floor = pl.Mesh.checkerboard(20.0, squares=40, position=(0, -1.2, 0))
    ball = pl.Mesh.sphere(0.4, position=(0.5, 0, 0), base_color=(0.8, 0.1, 0.1))
    sun = pl.DirectionalLight(direction=(0.6, -0.7, 0.4))
    eight = [(7.0 * np.cos(a), 7.0 * np.sin(a)) for a in 2 * np.pi * np.arange(8) / 8]
    scene = pl.Scene(
        camera=camera_at((0, 1.6, 2.5), (0, -0.2, 0), fov_deg=34.0), environment=pl.Environment.sky(), lights=[sun]
    )
    shown = [
        renderer.render(
            scene.replace(objects=[floor, ball, pl.Water(extent_m=14.0, medium="lake", waves=sines(0.05), **outline)]),
            size=SIZE,
        ).radiance
        for outline in ({}, {"outline": eight})
    ]
    # Rays that leave a crest through its other side go on straight in a part of a larger water.
    differs = np.abs(shown[1] - shown[0]).max(axis=2) > 0.02 * shown[0].max(axis=2)
    assert differs.mean() < 0.01


def test_borders_are_not_looked_up(renderer: Renderer) -> None:
    floor = pl.Mesh.checkerboard(8.0, squares=24, position=(0, -1.0, 0))
    ball = pl.Mesh.sphere(0.22, position=(0.15, -0.35, 0.1), base_color=(0.8, 0.1, 0.1))
    water = pl.Water(medium="lake", **BODIES["bowl"])
    below = VIEWS["below"].replace(position=(1.4, -0.9, 1.9), target=(0.0, -0.35, 0.0))
    best, fast = (
        renderer.render(
            pl.Scene(below, pl.Environment.sky(), objects=[floor, ball, water.replace(technique=how)]), size=SIZE
        ).radiance
        for how in ("best", "fast")
    )
    assert np.array_equal(best, fast)


def test_nothing_compiles_when_a_shape_of_one_kind_changes(
    device: Device, renderer: Renderer, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = pl.Scene(camera=VIEWS["above"], environment=pl.Environment.constant(EVEN))
    for body in ("cylinder", "box"):
        renderer.render(scene.replace(objects=[pl.Water(**BODIES[body])]), size=SIZE)
    for maker in ("create_shader_module", "create_compute_pipeline", "create_render_pipeline"):
        monkeypatch.setattr(device.wgpu, maker, lambda **_: pytest.fail("compiled again"))
    for body in BODIES.values():
        renderer.render(scene.replace(objects=[pl.Water(**body)], camera=VIEWS["below"]), size=SIZE)


def test_several_bodies_vanish_in_an_even_sky_too(renderer: Renderer) -> None:
    """Where rays meet what stands for other things, they meet its shape."""
    bodies = [
        pl.Water(medium=N, **BODIES["bowl"]),
        pl.Water(medium=N, center=(2.2, 0.3), **BODIES["box"]),
        pl.Water(medium=N, center=(-2.1, -0.3), outline=FIVE, depth_m=0.8, floor_scale=0.9),
    ]
    for camera in (VIEWS["above"], VIEWS["within"], VIEWS["aside"].replace(fov_deg=80.0)):
        frame = renderer.render(pl.Scene(camera, pl.Environment.constant(EVEN), objects=bodies), size=SIZE)
        assert frame.radiance == pytest.approx(np.broadcast_to(EVEN, frame.radiance.shape), rel=1e-4)
