"""Rays through volumes against closed-form optics, by the shader that draws."""

from __future__ import annotations

import numpy as np
import pytest

import oracles
import pellucid as pl
from pellucid.techniques.eikonal.trace import trace as trace_on

RADIUS = 0.04
BOX = 0.1


def ball_distance(x, y, z):
    return np.sqrt(x * x + y * y + z * z) - RADIUS


def squared_radius(x, y, z):
    return (x * x + y * y + z * z) / RADIUS**2


def beam(count: int, spread: float, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Parallel rays at random heights up to `spread` radii, in a direction that is no axis of the grid."""
    rng = np.random.default_rng(seed)
    radius, angle = np.sqrt(rng.uniform(0, 1, count)) * spread * RADIUS, rng.uniform(0, 2 * np.pi, count)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    origins = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, -0.2)], axis=1)
    return origins @ turn.T, np.tile([0.0, 0.0, 1.0], (count, 1)) @ turn.T


@pytest.fixture(scope="module")
def trace(device):
    return lambda volume, o, d, **options: trace_on(device, volume, o, d, pl.Quality(**options) if options else None)


@pytest.fixture(scope="module")
def ball():
    return pl.Volume.from_sdf(ball_distance, 1.5, 128, BOX)


def placed(volume: pl.Volume, boundary: str, **options) -> pl.RefractiveVolume:
    return pl.RefractiveVolume(volume, boundary=boundary, **options)


# ---- constant index: Snell, Fresnel -------------------------------------------------------------------------


# Smooth boundaries are Gaussians of 0.8 voxels: rays bend over a few voxels, and a curved boundary refracts them at a
# radius that differs by about half the square of that over the radius.
@pytest.mark.parametrize(("boundary", "median", "worst"), [("sharp", 6e-5, 3e-4), ("smooth", 6e-3, 5e-2)])
def test_ball_refracts_as_snell_says(trace, ball, boundary, median, worst):
    o, d = beam(4000, 0.75)
    leave, direction = oracles.through_ball(o, d, RADIUS, 1.5)
    rays = trace(placed(ball, boundary), o, d)
    angle = np.linalg.norm(rays.direction - direction, axis=1)
    assert (rays.status == "left").all()
    assert np.median(angle) < median and angle.max() < worst, (
        f"median {np.median(angle):.2e}, worst {angle.max():.2e} rad"
    )
    if boundary == "sharp":
        offset = oracles.line_distance(rays.position, rays.direction, leave) / (BOX / 128)
        assert offset.max() < 0.02, f"off by {offset.max():.1e} voxels"


@pytest.mark.parametrize(("boundary", "deviation"), [("sharp", 2e-3), ("smooth", 0.02)])
def test_ball_lens_focal_length(trace, ball, boundary, deviation):
    angle = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    o = np.stack([0.05 * RADIUS * np.cos(angle), 0.05 * RADIUS * np.sin(angle), np.full(64, -0.2)], axis=1)
    rays = trace(placed(ball, boundary), o, [0, 0, 1])
    across = np.linalg.norm(rays.position[:, :2], axis=1)
    slope = -(rays.position[:, :2] * rays.direction[:, :2]).sum(1) / across / rays.direction[:, 2]
    focus = np.median(rays.position[:, 2] + across / slope)
    error = focus / oracles.ball_lens_focus(RADIUS, 1.5) - 1.0
    assert abs(error) < deviation, f"focal length off by {error:.2%}"


@pytest.mark.parametrize(("boundary", "deviation"), [("sharp", 1e-5), ("smooth", 3e-3)])
def test_slab_shifts_rays_in_parallel(trace, boundary, deviation):
    """Smooth boundaries have a closed form too: in layers n sin is kept, the shift is an integral over the profile."""
    thickness, theta = 0.03, np.radians([10.0, 30.0, 45.0, 60.0])
    slab = pl.Volume.from_sdf(lambda x, y, z: np.abs(z) - thickness / 2 + 0 * x, 1.5, 128, BOX)
    d = np.stack([np.sin(theta), 0 * theta, np.cos(theta)], axis=1)
    rays = trace(placed(slab, boundary, smoothing_voxels=0.75), -0.045 * d, d)
    shift = oracles.line_distance(rays.position, rays.direction, np.zeros(3))
    truth = oracles.slab_shift(thickness, theta, 1.5)
    if boundary == "smooth":
        voxel = BOX / 128
        truth = oracles.soft_slab_shift(thickness, theta, 1.5, np.sqrt(0.75**2 + 1 / 12) * voxel, voxel)
    error = np.abs(shift / truth - 1.0).max()
    assert error < deviation, f"shift off by {error:.1e}"
    assert np.abs(rays.direction - d).max() < (1e-6 if boundary == "sharp" else 2e-3)


@pytest.mark.parametrize(("boundary", "deviation"), [("sharp", 1e-5), ("smooth", 2e-3)])
def test_two_interfaces_transmit_what_fresnel_says(trace, boundary, deviation):
    theta = np.radians([1e-3, 20.0, 45.0, 60.0])
    slab = pl.Volume.from_sdf(lambda x, y, z: np.abs(z) - 0.015 + 0 * x, 1.5, 64, BOX)
    d = np.stack([np.sin(theta), 0 * theta, np.cos(theta)], axis=1)
    rays = trace(placed(slab, boundary), -0.045 * d, d)
    truth = (1.0 - oracles.fresnel(theta, 1.0, 1.5)) ** 2
    error = np.abs(rays.transmittance[:, 0] - truth).max()
    assert error < deviation, f"transmittance off by {error:.1e}"


def test_total_reflection_begins_at_the_critical_angle(trace):
    block = pl.Volume.from_array(np.full((32, 32, 32), 1.5), BOX)
    critical = np.degrees(np.arcsin(1 / 1.5))
    theta = np.radians([critical - 0.02, critical + 0.02])
    d = np.stack([np.sin(theta), 0 * theta, np.cos(theta)], axis=1)
    rays = trace(placed(block, "sharp"), [[0, 0, 0.04]] * 2, d, bounces=0)
    assert rays.direction[0, 2] > 0.0 and rays.direction[0, 0] > 0.999
    assert rays.direction[1, 2] < 0.0, "41.83 degrees inside glass of 1.5 must reflect totally"


def test_a_body_that_fills_its_box_ends_at_the_faces_of_the_box(trace):
    block = pl.Volume.from_sdf(
        lambda x, y, z: -1.0 + 0 * x, pl.media.constant(1.5, (7.0, 7.0, 7.0), name="grey"), 48, BOX
    )
    rays = trace(placed(block, "sharp"), [0.01, 0.02, -1.0], [0, 0, 1])
    truth = 0.96**2 * np.exp(-7.0 * BOX)
    assert abs(rays.transmittance[0, 0] - truth) < 1e-5
    assert abs(rays.optical_path[0] - (rays.position[0, 2] + 1.0 + 0.5 * BOX)) < 1e-5


def test_a_prism_spreads_colours_by_its_sellmeier_curve(trace, device):
    apex, theta = np.radians(40.0), np.radians(45.0)
    half = apex / 2
    left, right = np.array([-np.cos(half), np.sin(half)]), np.array([np.cos(half), np.sin(half)])

    def wedge(x, y, z):
        sides = [n[0] * x + n[1] * y - 0.01 for n in (left, right)]
        return np.maximum(np.maximum(*sides), np.maximum(-y - 0.03, np.abs(z) - 0.04))

    glass = pl.Volume.from_sdf(wedge, "N-SF66", 128, BOX)
    inward = -left
    turn = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
    d2 = turn @ inward if (turn @ inward)[1] > 0 else turn.T @ inward
    start = np.array([*(0.01 * left + np.array([0.0, -0.004]) - 0.02 * d2), 0.0])
    n_rgb = pl.media.get("N-SF66").n_rgb
    for channel, n in enumerate(n_rgb):
        rays = trace_on(device, placed(glass, "sharp"), start, [*d2, 0.0], channel=channel)
        turned = np.arccos(np.clip(rays.direction[0, :2] @ d2, -1, 1))
        truth = oracles.prism_deviation(apex, theta, float(n))
        assert abs(turned - truth) < 2e-5, f"channel {channel}: deviation off by {turned - truth:.1e} rad"


# ---- graded index -------------------------------------------------------------------------------------------


def graded(f, resolution: int = 128, boundary: str = "smooth", extent=BOX) -> pl.RefractiveVolume:
    return placed(pl.Volume.from_function(f, resolution, extent), boundary, smoothing_voxels=0.0)


def test_luneburg_lens_focuses_on_its_rim(trace):
    lens = graded(lambda x, y, z: np.sqrt(2.0 - np.minimum(squared_radius(x, y, z), 1.0)))
    o, d = beam(2000, 0.9)
    rays = trace(lens, o, d)
    miss = np.linalg.norm(np.cross(RADIUS * d - rays.position, rays.direction), axis=1) / RADIUS
    # The rim is a kink of the index, which voxels of 1/51 radius round off.
    assert np.median(miss) < 1e-3 and miss.max() < 6e-3, (
        f"misses by {np.median(miss):.1e}, at most {miss.max():.1e} radii"
    )


def test_maxwell_fish_eye_images_its_rim_to_the_antipode(trace):
    lens = graded(lambda x, y, z: np.maximum(2.0 / (1.0 + squared_radius(x, y, z)), 1.0))
    point = RADIUS * np.array([0.36, 0.48, 0.8])
    angle = np.radians(np.linspace(5, 60, 40))
    side = np.array([0.8, -0.6, 0.0])
    d = np.cos(angle)[:, None] * (-point / RADIUS) + np.sin(angle)[:, None] * side
    rays = trace(lens, point, d)
    miss = oracles.line_distance(rays.position, rays.direction, -point) / RADIUS
    assert miss.max() < 0.01, f"misses the antipode by up to {miss.max():.1e} radii"


def test_rod_lens_bends_rays_to_sinusoids(trace):
    n0, g, length = 1.6, 40.0, 0.16
    profile = lambda x, y, z: n0 * np.sqrt(np.maximum(1.0 - g * g * (x * x + y * y), 0.3)) + 0 * z  # noqa: E731
    rod = graded(profile, 256, extent=(0.04, 0.04, length))
    x0 = np.linspace(-0.01, 0.01, 21)
    origins = np.stack([x0, 0 * x0, np.full(21, -length / 2 + 1e-6)], axis=1)
    rays = trace(rod, origins, [0, 0, 1])
    p_z = n0 * np.sqrt(1.0 - g * g * x0 * x0)
    truth = oracles.rod_ray(x0, length, n0, g, p_z)
    error = np.abs(rays.position[:, 0] - truth).max() / 0.01
    assert np.abs(rays.position[:, 2] - length / 2).max() < 1e-5
    assert error < 2e-3, f"off by {error:.1e} of the amplitude after a pitch"


def test_linear_squared_index_bends_rays_to_parabolas(trace):
    slope = 8.0
    field = graded(lambda x, y, z: np.sqrt(2.0 + slope * y), 64)
    angle = np.radians([-15.0, 0.0, 15.0])
    d = np.stack([0 * angle, np.sin(angle), np.cos(angle)], axis=1)
    rays = trace(field, [0, -0.01, -0.05 + 1e-7], d)
    n = np.sqrt(2.0 - slope * 0.01)
    truth = oracles.parabola(-0.01, n * d[:, 1], n * d[:, 2], slope, 0.1)
    error = np.abs(rays.position[:, 1] - truth).max()
    assert error < 2e-6, f"off by {error:.1e} m of {abs(truth).max():.2e} m: a constant force is integrated exactly"


def blob(height: float):
    return lambda x, y, z: 1.0 + height * np.exp(-((x / 0.012) ** 2 + (y / 0.015) ** 2 + (z / 0.01) ** 2))


def test_momentum_keeps_the_length_of_the_index_to_second_order_in_the_voxel(trace):
    error = [
        np.abs(trace(graded(blob(0.4), resolution), *beam(2000, 0.9), step_voxels=0.25).index - 1.0).max()
        for resolution in (64, 128)
    ]
    assert error[1] < 1e-3 and error[0] / error[1] > 3.5, f"|p| differs from n by {error[0]:.1e}, then {error[1]:.1e}"


def test_angular_momentum_is_kept_in_spherical_fields(trace):
    """Bouguer: n r sin(angle) = |x cross p| is constant."""
    o, d = beam(500, 0.9)
    field = graded(lambda x, y, z: 1.0 + 0.4 * np.exp(-(x * x + y * y + z * z) / 0.015**2))
    rays = trace(field, o, d, step_voxels=0.25)
    before, after = np.cross(o, d), np.cross(rays.position, rays.direction * rays.index[:, None])
    error = np.abs(after - before).max() / RADIUS
    assert error < 5e-4, f"n r sin changes by {error:.1e} radii"


def test_a_ray_turned_round_finds_its_way_back_to_second_order_in_the_voxel(trace):
    """The integrator is reversible; what is left is |p| - n of a sampled force: the way back starts with |p| = n."""
    o, d = beam(500, 0.8)
    error = []
    for resolution in (64, 128):
        field = graded(blob(0.4), resolution)
        out = trace(field, o, d, adaptive=False)
        back = trace(field, out.position, -out.direction, adaptive=False)
        error.append(np.linalg.norm(np.cross(o - back.position, back.direction), axis=1).max() / RADIUS)
    assert error[1] < 2e-3 and error[0] / error[1] > 3.5, (
        f"misses its start by {error[0]:.1e}, then {error[1]:.1e} radii"
    )


@pytest.mark.parametrize(("method", "order", "slack"), [("leapfrog", 2.0, 0.3), ("euler", 1.0, 0.2)])
def test_half_the_step_divides_the_error_by_two_to_the_order(trace, method, order, slack):
    o, d = beam(1000, 0.7)
    field = graded(blob(0.4))

    def run(step: float) -> np.ndarray:
        rays = trace(field, o, d, method=method, adaptive=False, step_voxels=step, max_steps=20000)
        assert (rays.status == "left").all()
        return rays.direction

    fine = run(0.25 if method == "leapfrog" else 1 / 32)
    errors = [np.sqrt(np.mean((run(h) - fine) ** 2)) for h in (4.0, 2.0)]
    measured = np.log2(errors[0] / errors[1])
    assert abs(measured - order) < slack, f"{method} is of order {measured:.2f}"


@pytest.mark.parametrize("height", [3e-4, 1e-5])
def test_weak_fields_deflect_by_the_integral_of_the_gradient(trace, height):
    """Deflection = integral of grad n across the line of sight, to first order in n - 1."""
    field = graded(blob(height))
    x = np.linspace(-0.02, 0.02, 41)
    rays = trace(field, np.stack([x, 0 * x, np.full(41, -0.2)], axis=1), [0, 0, 1])
    truth = -2.0 * x / 0.012**2 * height * np.exp(-((x / 0.012) ** 2)) * 0.01 * np.sqrt(np.pi)
    error = np.abs(rays.direction[:, 0] - truth).max() / np.abs(truth).max()
    assert error < 0.01, f"deflection off by {error:.2%} of its largest"


def test_weak_measured_field_deflects_by_the_integral_of_its_gradient(trace, shared_data):
    path = shared_data / "fuel_injection_64.npy"
    if not path.is_file():
        pytest.skip(f"no {path}")
    n = np.load(path)
    volume = pl.Volume.from_array(n, 0.1)
    h = volume.voxel_m[0]
    rows = np.arange(8, 56)
    centre = (rows + 0.5) * h - 0.05
    xs, ys = np.meshgrid(centre, centre, indexing="ij")
    origins = np.stack([xs.ravel(), ys.ravel(), np.full(xs.size, -0.2)], axis=1)
    rays = trace(placed(volume, "smooth", smoothing_voxels=0.0), origins, [0, 0, 1], step_voxels=0.25)
    slope_y, slope_x = (np.gradient(n, h, axis=a).sum(axis=0) * h for a in (1, 2))
    truth = np.stack([slope_x[np.ix_(rows, rows)].T.ravel(), slope_y[np.ix_(rows, rows)].T.ravel()], axis=1)
    error = np.sqrt(np.mean((rays.direction[:, :2] - truth) ** 2) / np.mean(truth**2))
    assert error < 0.01, f"deflection off by {error:.2%} (RMS)"


# ---- absorption, opacity ------------------------------------------------------------------------------------


@pytest.mark.parametrize("step", [4.0, 1.0, 0.13])
@pytest.mark.parametrize("adaptive", [True, False])
@pytest.mark.parametrize("boundary", ["sharp", "smooth"])
def test_a_homogeneous_block_absorbs_exactly_at_any_step(trace, boundary, adaptive, step):
    sigma = np.array([3.0, 10.0, 40.0])
    block = pl.Volume.from_array(np.ones((32, 32, 32)), BOX, absorption=np.broadcast_to(sigma, (32, 32, 32, 3)))
    rays = trace(placed(block, boundary), [0.01, 0.02, -1.0], [0, 0, 1], step_voxels=step, adaptive=adaptive)
    error = np.abs(rays.transmittance[0] / np.exp(-sigma * BOX) - 1.0).max()
    # 16-bit absorption coefficients: 5e-4 of an exponent of 4.
    assert error < 2e-3, f"transmittance off by {error:.1e}"


def test_absorption_of_a_glass_counts_only_inside_and_in_world_metres(trace):
    glass = pl.media.constant(1.0001, (20.0, 5.0, 0.0), name="filter")
    ball = pl.Volume.from_sdf(ball_distance, glass, 64, BOX)
    rays = trace(placed(ball, "sharp", scale=3.0, position=(1.0, 2.0, 3.0)), [1.0, 2.0, 0.0], [0, 0, 1])
    truth = np.exp(-np.array([20.0, 5.0, 0.0]) * 2 * 3 * RADIUS)
    error = np.abs(rays.transmittance[0] - truth).max()
    assert error < 1e-3, f"transmittance off by {error:.1e}"


@pytest.mark.parametrize("boundary", ["sharp", "smooth"])
def test_optical_path_is_the_integral_of_the_index(trace, ball, boundary):
    rays = trace(placed(ball, boundary), [0.0, 0.0, -0.2], [0, 0, 1])
    truth = (rays.position[0, 2] + 0.2) + 0.5 * 2 * RADIUS
    assert abs(rays.optical_path[0] - truth) < (1e-6 if boundary == "sharp" else 2e-4)


@pytest.mark.parametrize("boundary", ["sharp", "smooth"])
def test_opaque_voxels_stop_rays(trace, boundary):
    opaque = np.zeros((32, 32, 32, 4))
    opaque[12:20, 12:20, 12:20] = (0.5, 0.5, 0.5, 1.0)
    block = pl.Volume.from_array(np.full((32, 32, 32), 1.0), BOX, opaque=opaque)
    rays = trace(placed(block, boundary), [[0, 0, -1], [0.04, 0, -1]], [0, 0, 1])
    assert list(rays.status) == ["opaque", "left"]
    assert abs(rays.position[0, 2] + 4 * BOX / 32) < 0.75 * BOX / 32


def test_a_graded_lens_with_a_sharp_surface(trace):
    """A body whose index varies inside: normal incidence on its axis splits by the index at the surface."""
    volume = pl.Volume.from_sdf(ball_distance, 1.5, 96, BOX)
    z, y, x = np.meshgrid(*[(np.arange(96) + 0.5) * BOX / 96 - BOX / 2] * 3, indexing="ij")
    graded_ball = volume.replace(delta_n=(0.7 - 0.2 * squared_radius(x, y, z)).astype(np.float32))
    rays = trace(placed(graded_ball, "sharp"), [0, 0, -0.2], [0, 0, 1])
    assert abs(rays.transmittance[0, 0] - 0.96**2) < 1e-4
    path = 2 * RADIUS * (1.7 - 0.2 / 3)
    assert abs(rays.optical_path[0] - (rays.position[0, 2] + 0.2 - 2 * RADIUS + path)) < 2e-5


# ---- the way in ---------------------------------------------------------------------------------------------


def test_rays_that_miss_come_back_unchanged(trace, ball):
    rays = trace(placed(ball, "sharp"), [[0.5, 0, -1], [0, 0, 1]], [[0, 0, 2.0], [0, 0, 2.0]])
    assert list(rays.status) == ["missed", "missed"]
    assert (rays.position == [[0.5, 0, -1], [0, 0, 1]]).all() and (rays.direction == [0, 0, 1]).all()


def test_placement_turns_and_scales_rays_alike(trace, ball):
    o, d = beam(200, 0.7)
    still = trace(placed(ball, "smooth"), o, d)
    moved = placed(ball, "smooth", position=(3.0, -2.0, 1.0), rotation=(90.0, 0.0, 90.0), scale=2.0)
    world = moved.object_to_world()
    turned = trace(moved, o @ world[:3, :3].T + world[:3, 3], d @ world[:3, :3].T)
    error = np.abs(turned.direction - still.direction @ world[:3, :3].T / 2.0)
    assert np.median(error) < 1e-5


@pytest.mark.parametrize(
    ("origins", "directions", "field"),
    [
        ([0, 0, np.nan], [0, 0, 1], "trace.origins"),
        ([0, 0, 0], [0, 0, 0], "trace.directions"),
        ([[0, 0]], [0, 0, 1], "trace.origins"),
        ([[0, 0, 0]] * 3, [[0, 0, 1]] * 2, "trace.directions"),
    ],
)
def test_bad_rays_are_refused(trace, ball, origins, directions, field):
    with pytest.raises(pl.SceneError, match=field):
        trace(placed(ball, "sharp"), origins, directions)


def test_no_rays_give_no_rays(trace, ball):
    assert len(trace(placed(ball, "sharp"), np.zeros((0, 3)), np.zeros((0, 3)))) == 0
