"""What rays of other things see of water and of glass, against closed forms."""

from __future__ import annotations

import numpy as np

from pellucid.gpu import Device
from pellucid.optics import fresnel_dielectric
from pellucid.optics.snell import refract
from pellucid.scene import Camera, Environment, Mesh, Scene
from pellucid.surroundings import Query, Surroundings
from pellucid.surroundings.interfaces import Interface
from pellucid.surroundings.submersion import WaterRegion

N, GLASS = 1.333, 1.5
SKY = 0.7
BALL = np.array([0.2, 0.3, -0.1])
RADIUS = 0.5


def ball(absorption: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Interface:
    mesh = Mesh.sphere(RADIUS)
    points = np.asarray(mesh.vertices, np.float64)
    return Interface(points + BALL, np.asarray(mesh.faces), points / RADIUS, GLASS, absorption)


def around(
    device: Device, waters: tuple[WaterRegion, ...] = (), glass: tuple[Interface, ...] = (), *objects: object
) -> Query:
    surroundings = Surroundings(device)
    sky = Environment(np.full((8, 16, 3), SKY, np.float32))
    scene = Scene(camera=Camera((0, 40, 5), (0, 0, 0)), objects=list(objects), environment=sky)
    surroundings.prepare(scene, (8, 8), (), glass)
    surroundings.submersion.set(waters, 4, 4, [surroundings.sky_through(w.n) for w in waters])
    return Query(surroundings)


def directions(count: int, seed: int = 1) -> np.ndarray:
    ways = np.random.default_rng(seed).normal(size=(count, 3))
    return ways / np.linalg.norm(ways, axis=1, keepdims=True)


def test_an_even_sky_is_seen_unchanged_through_lossless_water_and_glass(device: Device) -> None:
    waters = WaterRegion(0.2, (-2, -2), (2, 2)), WaterRegion(1.0, (2, -1), (3, 1), n=(1.4, 1.4, 1.4))
    query = around(device, waters, (ball(),))
    origins = np.random.default_rng(2).uniform(-4, 4, (4000, 3))
    clear = np.linalg.norm(origins - BALL, axis=1) > 1.01 * RADIUS
    seen = query.radiance(origins[clear], directions(4000)[clear], across=True)
    np.testing.assert_allclose(seen, SKY, rtol=2e-5)


def test_a_floor_under_level_water_is_mixed_with_the_sky_by_fresnel(device: Device) -> None:
    depth_m, absorption, glow = 0.8, (1.0, 0.3, 0.1), (0.4, 0.9, 2.0)
    water = WaterRegion(0.0, (-50, -50), (50, 50), n=(N, N, N), absorption_per_m=absorption)
    floor = Mesh.plane(100.0, position=(0, -depth_m, 0), base_color=(0, 0, 0), specular=0.0, emission=glow)
    angles = np.radians([0.0, 20.0, 50.0, 75.0, 84.0])
    ways = np.stack([np.sin(angles), -np.cos(angles), np.zeros(5)], axis=1)
    seen = around(device, (water,), (), floor).radiance(np.tile((0.0, 1.0, 0.0), (5, 1)), ways, across=True)
    share = fresnel_dielectric(np.cos(angles), 1.0, N)[:, None]
    way_m = depth_m / np.sqrt(1.0 - (np.sin(angles) / N) ** 2)[:, None]
    below = np.exp(-np.array(absorption) * way_m) * np.array(glow) / N**2
    np.testing.assert_allclose(seen, share * SKY + (1.0 - share) * below, rtol=1e-4)


def test_from_below_the_sky_fills_the_window_and_the_rest_mirrors_the_floor(device: Device) -> None:
    glow, depth_m = np.array([0.4, 0.9, 2.0]), 1.0
    water = WaterRegion(0.0, (-50, -50), (50, 50), n=(N, N, N))
    floor = Mesh.plane(100.0, position=(0, -depth_m, 0), base_color=(0, 0, 0), specular=0.0, emission=tuple(glow))
    angles = np.radians([0.0, 30.0, 48.0, 49.5, 70.0])
    ways = np.stack([np.sin(angles), np.cos(angles), np.zeros(5)], axis=1)
    seen = around(device, (water,), (), floor).radiance(np.tile((0.0, -0.5, 0.0), (5, 1)), ways, across=True)
    share = fresnel_dielectric(np.cos(angles), N, 1.0)[:, None]
    np.testing.assert_allclose(seen, share * glow / N**2 + (1.0 - share) * SKY, rtol=1e-4)


def test_the_side_of_a_tank_mirrors_the_sky_and_swallows_the_rest(device: Device) -> None:
    tank = WaterRegion(1.0, (1.0, -2.0), (3.0, 2.0), n=(N, N, N), absorption_per_m=(1e4, 1e4, 1e4))
    angles = np.radians([0.0, 30.0, 60.0, 80.0])
    ways = np.stack([np.cos(angles), np.zeros(4), np.sin(angles)], axis=1)
    origins = np.array([1.0, 0.5, 0.0]) - 0.5 * ways
    seen = around(device, (tank,)).radiance(origins, ways, across=True)
    np.testing.assert_allclose(seen, SKY * fresnel_dielectric(np.cos(angles), 1.0, N)[:, None] * np.ones(3), rtol=1e-4)


def test_what_is_behind_a_ball_of_glass_is_where_snell_says(device: Device) -> None:
    glass = (ball((2.0, 0.5, 0.0)),)
    offsets = RADIUS * np.array([0.0, 0.2, 0.4, 0.6, 0.8])
    ways = np.tile((0.0, 0.0, -1.0), (5, 1))
    origins = BALL + np.stack([offsets, np.zeros(5), np.full(5, 2.0)], axis=1)
    # A wall behind the ball whose glow tells the place: one strip after the other.
    normal = np.stack([offsets, np.zeros(5), np.sqrt(RADIUS**2 - offsets**2)], axis=1) / RADIUS
    inside = refract(ways, normal, 1.0, GLASS).direction
    chord = -2.0 * np.sum(inside * normal, axis=1)[:, None] * RADIUS
    leaves = BALL + RADIUS * normal + chord * inside
    out = refract(inside, -(leaves - BALL) / RADIUS, GLASS, 1.0).direction
    wall = -3.0
    lands = (leaves + (wall - leaves[:, 2:]) / out[:, 2:] * out)[:, 0]
    passed = (1.0 - fresnel_dielectric(normal[:, 2], 1.0, GLASS))[:, None] ** 2 * np.exp(
        -np.array([2.0, 0.5, 0.0]) * chord
    )
    found = []
    for step in (-1.0, 1.0):  # the edge of a wall that begins or ends a little beside the place
        seen = []
        for k in range(5):
            edge = lands[k] + 0.02 * step
            strip = Mesh.plane((2.0, 4.0), rotation=(90, 0, 0), position=(edge + 1.0, BALL[1], wall),
                               base_color=(0, 0, 0), specular=0.0, emission=(90.0, 90.0, 90.0))  # fmt: skip
            seen.append(around(device, (), glass, strip).radiance(origins[k : k + 1], ways[k : k + 1], across=True)[0])
        found.append(np.array(seen))
    # The wall goes to the right from its edge: a ray lands on it whose edge is to the left, and not on the other.
    assert (found[1] < 5.0).all()
    np.testing.assert_allclose(found[0] - found[1], passed * (90.0 - SKY), rtol=0.01)


def test_glass_that_stands_in_water_is_bent_through_by_its_index_over_that_of_water(device: Device) -> None:
    same = WaterRegion(5.0, (-9, -9), (9, 9), n=(GLASS, GLASS, GLASS))
    glow = (0.4, 0.9, 2.0)
    floor = Mesh.plane(18.0, position=(0, -1, 0), base_color=(0, 0, 0), specular=0.0, emission=glow)
    origins = BALL + np.array([[0.3, 2.0, 0.0], [0.0, 2.0, 0.4]])
    ways = np.tile((0.0, -1.0, 0.0), (2, 1))
    seen = around(device, (same,), (ball(),), floor).radiance(origins, ways, across=True)
    np.testing.assert_allclose(seen, np.tile(np.array(glow) / GLASS**2, (2, 1)), rtol=1e-4)
