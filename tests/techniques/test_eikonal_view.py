"""Pictures of refractive volumes: energy, vanishing, depth, order, and what a frame does not do twice."""

from __future__ import annotations

import numpy as np
import pytest

import oracles
import pellucid as pl
from pellucid.fields import shapes
from pellucid.scene.placement import rotation_matrix

SIZE = (160, 120)
CAMERA = pl.Camera(position=(0.02, 0.07, 0.22), target=(0.0, 0.0, 0.0), fov_deg=30.0)
BOUNDARIES = ["sharp", "smooth"]


@pytest.fixture(scope="module")
def renderer(device):
    return pl.Renderer(device)


@pytest.fixture(scope="module")
def ball():
    return pl.Volume.from_sdf(shapes.sphere(0.04), 1.5, 64, 0.1)


@pytest.fixture(scope="module")
def torus():
    ring = shapes.rotated(shapes.torus(0.03, 0.012), rotation_matrix((35.0, 20.0, 0.0)))
    return pl.Volume.from_sdf(ring, pl.media.constant(2.4), 64, 0.1)


def scene(*objects, environment=None, camera=CAMERA, lights=()):
    around = environment or pl.Environment.constant((1.0, 1.0, 1.0))
    return pl.Scene(
        camera=camera, environment=around, objects=list(objects), lights=list(lights), tone_mapping="linear"
    )


# ---- energy -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("boundary", BOUNDARIES)
@pytest.mark.parametrize("kind", ["ball", "torus"])
def test_lossless_glass_vanishes_in_a_furnace(renderer, request, kind, boundary):
    """A uniform environment, no absorption: every pixel equals the environment, however light is split inside."""
    volume = request.getfixturevalue(kind)
    frame = renderer.render(scene(pl.RefractiveVolume(volume, boundary=boundary)), SIZE)
    error = np.abs(frame.radiance - 1.0).max()
    assert np.isfinite(frame.depth).any(), "the object is in the picture"
    assert error < 5e-3, f"the furnace is off by {error:.1e}"


def test_the_furnace_stays_closed_when_the_budget_is_small(renderer, torus):
    for bounces in (0, 1, 3):
        item = pl.RefractiveVolume(torus, quality=pl.Quality(bounces=bounces, min_weight=0.3))
        error = np.abs(renderer.render(scene(item), SIZE).radiance - 1.0).max()
        assert error < 5e-3, f"{bounces} bounces: off by {error:.1e}"


def test_the_furnace_holds_with_a_white_floor_and_many_regions(renderer):
    cubes = pl.Volume.from_regions(
        list(zip(shapes.nested_rounded_cubes(0.06, 0.01), (1.7, 1.3, 1.5), strict=True)), 64, 0.1
    )
    floor = pl.Mesh.plane(4.0, base_color=(1.0, 1.0, 1.0), specular=0.0, position=(0, -0.05, 0))
    frame = renderer.render(scene(pl.RefractiveVolume(cubes), floor), SIZE)
    error = np.abs(frame.radiance - 1.0).max()
    assert error < 5e-3, f"the furnace is off by {error:.1e}"


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_index_matched_glass_vanishes(renderer, boundary):
    around = pl.Environment.studio()
    matched = pl.Volume.from_sdf(shapes.sphere(0.04), 1.333, 64, 0.1, ambient_n=1.333)
    floor = pl.Mesh.checkerboard(0.5, position=(0, -0.05, 0))
    bare = renderer.render(scene(floor, environment=around), SIZE).radiance
    with_ball = renderer.render(
        scene(floor, pl.RefractiveVolume(matched, boundary=boundary), environment=around), SIZE
    ).radiance
    # The ball's pixels are shaded by rays and the others by the rasteriser, which differ by filtering at edges.
    error = np.abs(with_ball - bare) / (bare + 1.0)
    assert np.quantile(error, 0.99) < 5e-3 and np.median(error) < 1e-5, f"{np.quantile(error, 0.99):.1e}"


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_absorption_of_a_glass_slab_colours_what_is_behind(renderer, boundary):
    glass = pl.media.constant(1.0 + 1e-7, (60.0, 20.0, 5.0), name="filter")
    slab = pl.Volume.from_sdf(shapes.box((0.06, 0.06, 0.02)), glass, 64, 0.1)
    camera = pl.Camera(position=(0, 0, 1), target=(0, 0, 0), orthographic_height_m=0.03)
    frame = renderer.render(scene(pl.RefractiveVolume(slab, boundary=boundary), camera=camera), (8, 6))
    truth = np.exp(-np.array([60.0, 20.0, 5.0]) * 0.02)
    error = np.abs(frame.radiance / truth - 1.0).max()
    assert error < 5e-3, f"off by {error:.1e}"


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_normal_reflectance_is_exact(renderer, boundary):
    """Looking straight at an absorbing slab: only the first reflection returns, ((n-1)/(n+1))^2 of the environment."""
    black = pl.media.constant(1.5, (1e5, 1e5, 1e5), name="black glass")
    slab = pl.Volume.from_sdf(shapes.box((0.06, 0.06, 0.04)), black, 64, 0.1)
    camera = pl.Camera(position=(0, 0, 1), target=(0, 0, 0), orthographic_height_m=0.02)
    frame = renderer.render(scene(pl.RefractiveVolume(slab, boundary=boundary), camera=camera), (8, 6))
    error = np.abs(frame.radiance - 0.04).max()
    assert error < (1e-5 if boundary == "sharp" else 2e-3), f"reflectance off by {error:.1e}"


def test_emission_adds_up_along_the_ray_whatever_the_step(renderer):
    glow = np.zeros((32, 32, 32, 3))
    glow[...] = (3.0, 2.0, 1.0)
    for step, adaptive in ((0.3, False), (2.0, False), (1.0, True)):
        block = pl.RefractiveVolume.from_array(
            np.ones((32, 32, 32)), 0.1, emission=glow, quality=pl.Quality(step_voxels=step, adaptive=adaptive)
        )
        camera = pl.Camera(position=(0, 0, 1), target=(0, 0, 0), orthographic_height_m=0.02)
        dark = pl.Environment.constant((0.0, 0.0, 0.0))
        radiance = renderer.render(scene(block, camera=camera, environment=dark), (4, 4)).radiance
        assert np.abs(radiance - np.array([0.3, 0.2, 0.1])).max() < 1e-3, f"step {step}: {radiance[0, 0]}"


# ---- geometry -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_refraction_of_nearby_geometry_is_where_snell_puts_it(renderer, boundary):
    """A ball before a plane with a known emission pattern, against float64 refraction and the same pattern."""
    n, radius, z_plane = 1.5, 0.04, -0.08
    ramp = np.linspace(0.0, 1.0, 256, dtype=np.float32)
    pattern = np.stack(np.broadcast_arrays(ramp[None, :], ramp[::-1, None], np.float32(0.5)), axis=-1).copy()
    white = (1.0, 1.0, 1.0)
    wall = pl.Mesh.plane(
        0.4, base_color=white, base_color_map=pattern, specular=0.0, rotation=(90, 0, 0), position=(0, 0, z_plane)
    )
    glass = pl.Volume.from_sdf(shapes.sphere(radius), n, 128, 0.1)
    camera = pl.Camera(position=(0, 0, 0.5), target=(0, 0, 0), orthographic_height_m=0.06)
    frame = renderer.render(scene(wall, pl.RefractiveVolume(glass, boundary=boundary), camera=camera), SIZE)
    origins, directions = camera.pixel_rays(SIZE)
    o, d = origins.reshape(-1, 3), directions.reshape(-1, 3)
    inner = np.linalg.norm(o[:, :2], axis=1) < 0.6 * radius
    leave, out = oracles.through_ball(o[inner], d[inner], radius, n)
    hit = leave + out * ((z_plane - leave[:, 2]) / out[:, 2])[:, None]
    theta = np.arcsin(np.linalg.norm(o[inner, :2], axis=1) / radius)
    through = (1.0 - oracles.fresnel(np.maximum(theta, 1e-4), 1.0, n)) ** 2
    seen = frame.radiance.reshape(-1, 3)[inner]
    # The pattern is linear in x and y: red tells where the ray arrived, once the reflection is taken off.
    expected = hit[:, 0] / 0.4 + 0.5
    rest = 1.0 - through
    got = (seen[:, 0] - rest * 1.0) / through
    error = np.abs(got - expected)
    assert np.median(error) < (0.01 if boundary == "sharp" else 0.015), f"median {np.median(error):.1e} of the wall"


def test_depth_of_a_ball_is_its_surface(renderer, ball):
    frame = renderer.render(scene(pl.RefractiveVolume(ball)), SIZE)
    origins, directions = CAMERA.pixel_rays(SIZE)
    o, d = origins.reshape(-1, 3), directions.reshape(-1, 3)
    b, c = (o * d).sum(1), (o * o).sum(1) - 0.04**2
    square = b * b - c
    hits = square > 1e-4  # where the surface is not seen edge-on
    t = -b[hits] - np.sqrt(square[hits])
    forward = np.asarray(CAMERA.target) - np.asarray(CAMERA.position)
    truth = t * (d[hits] @ (forward / np.linalg.norm(forward)))
    error = np.abs(frame.depth.reshape(-1)[hits] - truth) * np.sqrt(square[hits]) / 0.04  # across the surface
    assert error.max() < 0.02 * 0.1 / 64, f"the surface is off by {error.max() * 64 / 0.1:.1e} voxels"
    assert np.isinf(frame.depth.reshape(-1)[square < -2e-5]).all()


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_a_mesh_in_front_hides_glass_and_one_inside_its_box_is_seen(renderer, ball, boundary):
    glass = pl.RefractiveVolume(ball, boundary=boundary)
    card = dict(base_color=(0.0, 0.0, 0.0), specular=0.0, emission=(5.0, 0.0, 0.0))
    front = pl.Mesh.sphere(0.01, position=(0.006, 0.021, 0.066), **card)
    inside = pl.Mesh.sphere(0.01, **card)
    before = renderer.render(scene(glass, front), SIZE).radiance
    assert np.abs(before[60, 80] - (5.0, 0.0, 0.0)).max() < 1e-3
    within = renderer.render(scene(glass, inside), SIZE).radiance[60, 80]
    # Through the front surface (0.96), and 0.04 of the white environment reflected.
    assert np.abs(within - np.array([5 * 0.96 + 0.04, 0.04, 0.04])).max() < 0.02, within


def test_the_cheap_mode_sees_what_the_picture_shows(renderer, ball):
    wall = pl.Mesh.plane(4.0, base_color=(0.2, 0.5, 0.8), specular=0.0, rotation=(90, 0, 0), position=(0, 0, -0.3))
    true = renderer.render(scene(wall, pl.RefractiveVolume(ball, surroundings="rays")), SIZE).radiance
    cheap = renderer.render(scene(wall, pl.RefractiveVolume(ball, surroundings="screen")), SIZE).radiance
    share = np.mean(np.abs(true - cheap).max(axis=2) < 0.02)
    assert share > 0.85, f"{share:.0%} of the pixels agree"


def test_dispersive_glass_differs_between_channels_only_where_it_is(renderer):
    prism = pl.RefractiveVolume.from_sdf(shapes.sphere(0.04), "N-SF66", 64, 0.1)
    around = pl.Environment.studio()
    spread = renderer.render(scene(prism, environment=around), SIZE).radiance
    single = renderer.render(scene(prism.replace(dispersion=False), environment=around), SIZE).radiance
    outside = np.isinf(renderer.render(scene(prism), SIZE).depth)
    assert (spread[outside] == single[outside]).all()
    assert np.abs(spread - single)[~outside].max() > 0.05


def test_a_camera_inside_glass_sees_out(renderer, ball):
    camera = pl.Camera(position=(0, 0, 0.01), target=(0, 0, -1), fov_deg=60)
    frame = renderer.render(scene(pl.RefractiveVolume(ball), camera=camera), SIZE)
    assert np.abs(frame.radiance - 1.0).max() < 5e-3


def test_hot_air_moves_the_background_and_writes_no_depth(renderer):
    air = pl.RefractiveVolume.from_function(
        lambda x, y, z: 1.00027 - 2e-4 * np.exp(-(x * x + y * y + z * z) / 0.02**2), 48, 0.1, ambient_n=1.00027
    )
    frame = renderer.render(scene(air, environment=pl.Environment.studio()), SIZE)
    assert np.isinf(frame.depth).all() and np.isfinite(frame.radiance).all()


# ---- frames -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_the_same_scene_gives_the_same_bits(device, renderer, torus, boundary):
    what = scene(
        pl.RefractiveVolume(torus, boundary=boundary), pl.Mesh.checkerboard(0.5), environment=pl.Environment.studio()
    )
    first = renderer.render(what, SIZE, samples=2)
    again = pl.Renderer(device).render(what, SIZE, samples=2)
    assert (first.radiance == again.radiance).all() and (first.srgb() == again.srgb()).all()


def test_moving_camera_light_index_or_object_compiles_nothing(device, ball, monkeypatch):
    renderer = pl.Renderer(device)
    light = pl.DirectionalLight(direction=(-1, -2, -1))
    floor = pl.Mesh.plane(1.0, position=(0, -0.05, 0))
    glass = pl.RefractiveVolume(ball)
    around = pl.Environment.constant((1.0, 1.0, 1.0))

    def scene(*objects, **rest):
        return pl.Scene(camera=rest.pop("camera", CAMERA), environment=around, objects=objects, **rest)

    renderer.render(scene(glass, floor, lights=[light]), SIZE)
    volumes, make = [], type(device).texture

    def texture(*args, **options):
        if options.get("dimension") == "3d":
            volumes.append(options.get("label"))
        return make(*args, **options)

    monkeypatch.setattr(type(device), "texture", texture, raising=True)
    for maker in ("create_shader_module", "create_compute_pipeline", "create_render_pipeline"):
        monkeypatch.setattr(device.wgpu, maker, lambda **k: pytest.fail("compiled again"))
    moved = [
        scene(glass, floor, lights=[light], camera=CAMERA.replace(position=(0.1, 0.05, 0.2))),
        scene(glass, floor, lights=[light.replace(direction=(1, -2, 0))]),
        scene(glass.replace(position=(0.01, 0.0, 0.0), rotation=(0, 30, 0)), floor, lights=[light]),
        scene(glass.replace(quality=pl.Quality(bounces=3, step_voxels=0.7)), floor, lights=[light]),
    ]
    for what in moved:
        renderer.render(what, SIZE)
    assert not volumes, "of volumes nothing but parameters is uploaded"


def test_more_samples_smooth_the_outline_and_keep_the_mean(renderer, ball):
    dark = pl.media.constant(1.5, (1e5, 1e5, 1e5), name="black glass")
    black = pl.RefractiveVolume.from_sdf(shapes.sphere(0.04), dark, 64, 0.1)
    one = renderer.render(scene(black), SIZE).radiance[..., 1]
    many = renderer.render(scene(black), SIZE, samples=16).radiance[..., 1]
    assert abs(one.mean() - many.mean()) < 2e-3
    assert len(np.unique(many.round(3))) > 1.5 * len(np.unique(one.round(3)))


@pytest.mark.parametrize(
    ("size", "samples", "field"),
    [
        ((0, 10), 1, "size"),
        ((10, 100_000), 1, "size"),
        ("large", 1, "size"),
        ((16000, 16000), 1, "million pixels"),
        ((8, 8), 0, "samples"),
        ((8, 8), 1.5, "samples"),
    ],
)
def test_bad_sizes_and_samples_are_refused(renderer, ball, size, samples, field):
    with pytest.raises(pl.SceneError, match=field):
        renderer.render(scene(pl.RefractiveVolume(ball)), size, samples=samples)


def test_a_frame_saves_itself_or_nothing(renderer, ball, tmp_path):
    frame = renderer.render(scene(pl.RefractiveVolume(ball)), (32, 24))
    for suffix in ("png", "exr", "hdr"):
        assert frame.save(tmp_path / f"a.{suffix}").stat().st_size > 100
    assert frame._repr_png_()[:4] == b"\x89PNG"
    with pytest.raises(pl.AssetError, match="jpeg2"):
        frame.save(tmp_path / "a.jpeg2")
    assert len(list(tmp_path.iterdir())) == 3


def test_objects_that_share_a_volume_share_its_textures(device, ball):
    renderer = pl.Renderer(device)
    one = pl.RefractiveVolume(ball, position=(-0.03, 0, 0), scale=0.5)
    other = pl.RefractiveVolume(ball.replace(), position=(0.03, 0, 0), scale=0.5)
    renderer.render(scene(one, other), SIZE)
    apart = renderer.nbytes
    frame = renderer.render(scene(one, one.replace(position=(0.03, 0, 0))), SIZE)
    assert apart - renderer.nbytes >= ball.nbytes
    left, right = np.isfinite(frame.depth[:, :80]).sum(), np.isfinite(frame.depth[:, 80:]).sum()
    assert min(left, right) > 300, "both are drawn, each in its place"


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_glass_that_stands_on_a_floor_has_no_speckle(renderer, boundary):
    """Lifted by a hundredth of a millimetre it changes no more than far from the floor: edges move, and no more."""
    cube = pl.Volume.from_sdf(shapes.box((0.08, 0.08, 0.08)), 1.5, 64, 0.1)
    floor = pl.Mesh.checkerboard(2.0, squares=20)
    camera = pl.Camera(position=(0.05, 0.12, 0.45), target=(0, 0.05, 0), fov_deg=22)
    around = pl.Environment.studio()

    def picture(height: float) -> np.ndarray:
        item = pl.RefractiveVolume(cube, boundary=boundary, position=(0, height, 0), rotation=(0, 30, 0))
        return renderer.render(scene(item, floor, environment=around, camera=camera), SIZE).radiance

    touching, clear = (
        np.mean(np.abs(picture(height) - picture(height + 1e-5)).max(axis=2) > 0.05) for height in (0.04, 0.06)
    )
    assert touching < 1.2 * clear < 0.02, f"{touching:.1%} of the pixels change, {clear:.1%} of a cube that hovers"


def test_glow_spreads_light_on_the_screen_and_leaves_radiance_alone(renderer):
    lamp = pl.Mesh.sphere(0.01, base_color=(0.0, 0.0, 0.0), specular=0.0, emission=(50.0, 50.0, 50.0))
    dark = scene(lamp, environment=pl.Environment.constant((0.0, 0.0, 0.0)))
    plain, glowing = renderer.render(dark, SIZE), renderer.render(dark.replace(glow=0.1), SIZE)
    assert (plain.radiance == glowing.radiance).all()
    assert (glowing.srgb() > plain.srgb()).mean() > 0.5
