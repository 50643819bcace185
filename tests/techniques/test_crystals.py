"""Crystals as they are traced and drawn: two images, their energies, pleochroism, and an axis that turns."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import ndimage

import pellucid as pl
from pellucid.fields import shapes
from pellucid.optics import crystal
from pellucid.techniques.eikonal.trace import trace as trace_on

N_O, N_E = 1.6584, 1.4864  # calcite at 589.3 nm
CALCITE = pl.media.uniaxial(N_O, N_E, name="calcite at the sodium line")
THICK = 0.02
SHIFT = THICK * np.tan(np.radians(6.2241))  # of the extraordinary ray through a slab with its axis at 45 degrees
SLANTED = (1.0, 0.0, 1.0)
FLAT = pl.Camera(position=(0, 0, 1), target=(0, 0, 0), orthographic_height_m=0.02)
AROUND = pl.Camera(position=(0.02, 0.07, 0.22), target=(0, 0, 0), fov_deg=30.0)


@pytest.fixture(scope="module")
def renderer(device):
    return pl.Renderer(device)


@pytest.fixture(scope="module")
def trace(device):
    return lambda volume, o, d, mode=None: trace_on(device, pl.RefractiveVolume(volume), o, d, mode=mode)


def slab(axis=SLANTED, medium=CALCITE, resolution=48) -> pl.Volume:
    return pl.Volume.from_sdf(shapes.box((0.06, 0.06, THICK)), medium, resolution, (0.07, 0.07, 0.03), optic_axis=axis)


def scene(*objects, camera=AROUND, environment=None):
    around = environment or pl.Environment.constant((1.0, 1.0, 1.0))
    return pl.Scene(camera=camera, environment=around, objects=list(objects), tone_mapping="linear")


# ---- rays ---------------------------------------------------------------------------------------------------


def test_the_extraordinary_ray_walks_off_and_the_ordinary_does_not(trace):
    o = np.array([[0.001, 0.002, 0.03], [-0.004, 0.003, 0.03]])
    ordinary, extraordinary = (trace(slab(), o, (0, 0, -1), mode) for mode in ("ordinary", "extraordinary"))
    assert np.abs((ordinary.position - o)[:, :2]).max() < 1e-8
    np.testing.assert_allclose((extraordinary.position - o)[:, :2], [[SHIFT, 0.0]] * 2, atol=2e-8)
    for rays in (ordinary, extraordinary):
        np.testing.assert_allclose(rays.direction, [[0, 0, -1]] * 2, atol=1e-7)
    n = crystal.extraordinary_index(np.cos(np.pi / 4), N_O, N_E)
    walked = 0.03 + 0.015 - THICK
    np.testing.assert_allclose(extraordinary.optical_path, walked + n * THICK, rtol=1e-6)
    np.testing.assert_allclose(ordinary.optical_path, walked + N_O * THICK, rtol=1e-6)


def test_rays_and_their_energies_are_those_of_the_laws(trace):
    """Oblique rays through a slab with a skew axis, against float64."""
    rng = np.random.default_rng(2)
    axis = np.array([0.48, -0.64, 0.6])
    d = np.column_stack([rng.uniform(-0.5, 0.5, (50, 2)), -np.ones(50)])
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    o = np.array([0.0, 0.0, 0.5 * THICK]) - 0.01 * d
    up = np.array([0.0, 0.0, 1.0])
    into = crystal.split_modes(d, [0.5, 0.5], up, 1.0, 1.0, up, N_O, N_E, axis)
    for mode, wave, k, share in (
        ("ordinary", into.transmitted_o, 2, [1.0, 0.0]),
        ("extraordinary", into.transmitted_e, 3, [0.0, 1.0]),
    ):
        ray = wave if k == 2 else crystal.extraordinary_ray(wave, axis, N_O, N_E)
        across = THICK * ray[:, :2] / -ray[:, 2:]
        out = crystal.split_modes(wave, share, up, N_O, N_E, axis, 1.0, 1.0, up).powers[:, 2:].sum(1)
        rays = trace(slab(axis), o, d, mode)
        back = (rays.position[:, 2] + 0.5 * THICK) / d[:, 2]
        leave = rays.position[:, :2] - back[:, None] * d[:, :2]
        np.testing.assert_allclose(leave, across, atol=3e-7)
        np.testing.assert_allclose(rays.direction, d, atol=1e-6)
        expected = (into.powers[:, k] * out)[:, None]
        np.testing.assert_allclose(rays.transmittance, np.repeat(expected, 3, 1), rtol=2e-5)


def test_without_an_axis_a_crystal_is_its_ordinary_index(trace):
    o, d = np.array([0.0, 0.0, 0.03]), np.array([0.3, 0.1, -1.0])
    glass = trace(slab(None, pl.media.constant(N_O)), o, d)
    for volume in (slab(None), slab()):
        np.testing.assert_array_equal(trace(volume, o, d).position, glass.position)


def test_modes_that_are_none_are_refused(trace):
    with pytest.raises(pl.SceneError, match=r"trace\.mode"):
        trace(slab(), (0, 0, 1), (0, 0, -1), "fast")
    with pytest.raises(pl.SceneError, match="no region has an optic axis"):
        trace(slab(None), (0, 0, 1), (0, 0, -1), "ordinary")


# ---- two images ---------------------------------------------------------------------------------------------


def dot_behind(renderer, volume, turn_deg: float = 0.0, size: int = 160) -> list[np.ndarray]:
    """Centres (metres, x to the right, y up) of the images of a black dot behind a slab, darkest pixels only."""
    y, x = np.mgrid[:512, :512] - 255.5
    paper = np.where((x * x + y * y < 8.0**2)[..., None], np.float32(0.0), np.float32(1.0)) * np.ones(3, np.float32)
    wall = pl.Mesh.plane(
        0.04, base_color=(1, 1, 1), base_color_map=paper, specular=0.0, rotation=(90, 0, 0), position=(0, 0, -0.011)
    )
    body = pl.RefractiveVolume(volume, rotation=(0, 0, turn_deg))
    picture = renderer.render(scene(wall, body, camera=FLAT), (size, size), samples=4).radiance[..., 1]
    darkness = np.clip(picture.max() - picture, 0.0, None)
    found, count = ndimage.label(darkness > 0.2 * darkness.max())
    centres = ndimage.center_of_mass(darkness, found, range(1, count + 1))
    pixel = 0.02 / size
    return [np.array([(c + 0.5 - size / 2) * pixel, -(r + 0.5 - size / 2) * pixel]) for r, c in centres]


@pytest.mark.parametrize("turn_deg", [0.0, 72.0, 144.0, 216.0, 288.0])
def test_one_image_stays_and_the_other_circles_as_the_crystal_turns(renderer, turn_deg):
    images = sorted(dot_behind(renderer, slab(), turn_deg), key=np.linalg.norm)
    assert len(images) == 2
    pixel = 0.02 / 160
    # Seen against the ray, the image stands opposite to where the ray walks off.
    angle = np.radians(turn_deg)
    expected = -SHIFT * np.array([np.cos(angle), np.sin(angle)])
    fixed, moved = np.linalg.norm(images[0]), np.linalg.norm(images[1] - expected)
    # Edges are sampled four times a pixel, and the shift is 17 pixels.
    assert fixed < 0.25 * pixel and moved < 0.25 * pixel, f"off by {fixed / pixel:.2f} and {moved / pixel:.2f} pixels"


def test_along_the_axis_there_is_one_image(renderer):
    images = dot_behind(renderer, slab((0, 0, 1)))
    assert len(images) == 1 and np.linalg.norm(images[0]) < 0.25 * 0.02 / 160


# ---- energy -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("bounces", [0, 2, 8])
def test_a_clear_crystal_vanishes_in_a_furnace(renderer, bounces):
    cubes = pl.Volume.from_regions(
        [(shapes.sphere(0.014), "rutile"), (shapes.box((0.04, 0.04, 0.04)), "calcite"), (shapes.sphere(0.03), 1.5)],
        48,
        0.08,
        optic_axes=[(0, 0, 1), (1, 2, 3), None],
    )
    item = pl.RefractiveVolume(cubes, rotation=(20, 30, 0), quality=pl.Quality(bounces=bounces, min_weight=0.05))
    frame = renderer.render(scene(item), (120, 90))
    assert np.isfinite(frame.depth).any()
    assert np.abs(frame.radiance - 1.0).max() < 5e-3
    inside = pl.Camera(position=(0.0, 0.0, 0.017), target=(0.1, 0.2, -1.0), fov_deg=50.0)
    assert np.abs(renderer.render(scene(item, camera=inside), (40, 30)).radiance - 1.0).max() < 5e-3


def test_equal_indices_look_like_glass(renderer):
    """The same picture as of the isotropic kernel: one surface, and no more of the tree than both have room for."""
    quality = pl.Quality(bounces=2, min_weight=1e-5)
    cube, floor = shapes.box((0.04, 0.04, 0.04)), pl.Mesh.checkerboard(0.5, position=(0, -0.021, 0))
    pictures = [
        renderer.render(
            scene(
                floor,
                pl.RefractiveVolume(pl.Volume.from_sdf(cube, medium, 48, 0.08, optic_axis=axis), quality=quality),
                environment=pl.Environment.studio(),
            ),
            (120, 90),
        ).radiance
        for medium, axis in ((1.5, None), (pl.media.uniaxial(1.5, 1.5), (1.0, 2.0, 0.5)))
    ]
    error = np.abs(pictures[0] - pictures[1]).max(axis=2)
    # The two rays of equal index share out the light by polarisation, which then counts as unpolarised.
    assert np.quantile(error, 0.99) < 0.02 and np.median(error) < 1e-6, np.quantile(error, [0.9, 0.99, 1.0])


def test_a_tourmaline_is_dark_along_its_axis(renderer):
    """Pleochroism without refraction: half of the light is o and half is e, each with its absorption."""
    sigma_o, sigma_e = np.array([400.0, 200.0, 300.0]), np.array([90.0, 10.0, 60.0])
    n = 1.0 + 1e-7
    gem = pl.media.uniaxial(n, n, sigma_o, sigma_e)
    for axis, angle in (((0, 0, 1), 0.0), ((1, 0, 1), np.pi / 4), ((0, 1, 0), np.pi / 2)):
        frame = renderer.render(scene(pl.RefractiveVolume(slab(axis, gem)), camera=FLAT), (8, 6))
        along_e = sigma_o * np.cos(angle) ** 2 + sigma_e * np.sin(angle) ** 2
        truth = 0.5 * np.exp(-sigma_o * THICK) + 0.5 * np.exp(-along_e * THICK)
        assert np.abs(frame.radiance / truth - 1.0).max() < 2e-3, axis


def test_absorption_of_one_ray_only_makes_a_polariser(renderer):
    black = pl.media.uniaxial(1.0 + 1e-7, 1.0 + 1e-7, (1e5, 1e5, 1e5), (0.0, 0.0, 0.0))
    frame = renderer.render(scene(pl.RefractiveVolume(slab((0, 1, 0), black)), camera=FLAT), (8, 6))
    assert np.abs(frame.radiance - 0.5).max() < 1e-4


# ---- an axis that turns -------------------------------------------------------------------------------------


def grid(volume: pl.Volume) -> tuple[np.ndarray, ...]:
    z, y, x = ((np.arange(n) + 0.5) * h - 0.5 * n * h for n, h in zip(volume.shape, volume.voxel_m[::-1], strict=True))
    zz, yy, xx = np.meshgrid(z, y, x, indexing="ij")
    return xx, yy, zz


def turning(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Angle of the axis in the plane of x and z."""
    return 0.5 + 40.0 * z + 15.0 * x


def test_a_constant_field_is_a_homogeneous_crystal(trace):
    plain = slab((0.6, 0.0, 0.8))
    field = np.broadcast_to(np.float32([0.6, 0.0, 0.8]), (*plain.shape, 3))
    index = np.full(plain.shape, N_O - 1.0, np.float32)
    o, d = np.array([[0.0, 0.0, 0.02], [0.001, 0.0, 0.02]]), np.array([0.2, 0.3, -1.0])
    expected = trace(plain, o, d, "extraordinary")
    for volume in (plain.replace(optic_axis=field), plain.replace(delta_n=index)):
        found = trace(volume, o, d, "extraordinary")
        np.testing.assert_allclose(found.position, expected.position, atol=5e-7)
        np.testing.assert_allclose(found.direction, expected.direction, atol=1e-5)
        np.testing.assert_allclose(found.transmittance, expected.transmittance, rtol=1e-3)


def test_an_axis_that_turns_bends_rays_as_its_hamiltonian_says(trace):
    plain = slab(resolution=96)
    x, _, z = grid(plain)
    angle = turning(x, z)
    volume = plain.replace(optic_axis=np.stack([np.cos(angle), 0.0 * angle, np.sin(angle)], -1))
    d = np.array([[0.0, 0.0, -1.0], [0.3, 0.2, -1.0], [-0.4, 0.1, -1.0]])
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    start = np.tile([0.002, 0.0, 0.5 * THICK], (3, 1))

    def field(at):
        angle = turning(at[..., 0], at[..., 2])
        zero = np.zeros_like(angle)
        axis = np.stack([np.cos(angle), zero, np.sin(angle)], -1)
        turned = np.stack([-np.sin(angle), zero, np.cos(angle)], -1)
        slope = np.stack([15.0 + zero, zero, 40.0 + zero], -1)
        none = np.zeros_like(axis)
        return (
            np.full_like(angle, N_O),
            np.full_like(angle, N_E),
            axis,
            none,
            none,
            slope[..., None] * turned[..., None, :],
        )

    up = np.array([0.0, 0.0, 1.0])
    axis = field(start)[2]
    p = crystal.split_modes(d, [0.5, 0.5], up, 1.0, 1.0, up, N_O, N_E, axis).transmitted_e
    at = start
    count = 400
    for k in range(count):  # in equal slices of z, the last one onto the face
        ray = crystal.extraordinary_ray(p, field(at)[2], N_O, N_E)
        left = (at[:, 2] + 0.5 * THICK) / (count - k)
        at, p = crystal.hamiltonian_step(at, p, left / -ray[:, 2], field, 6)
    out = crystal.split_modes(p, [0.0, 1.0], up, N_O, N_E, field(at)[2], 1.0, 1.0, up).transmitted_o

    rays = trace(volume, start - 0.005 * d, d, "extraordinary")
    np.testing.assert_allclose(rays.direction, out, atol=2e-3)
    back = (rays.position[:, 2] + 0.5 * THICK) / rays.direction[:, 2]
    leave = rays.position - back[:, None] * rays.direction
    np.testing.assert_allclose(leave[:, :2], at[:, :2], atol=2e-5)
    assert np.abs(rays.direction - d).max() > 0.02, "the ray is bent"


def test_a_twisted_crystal_vanishes_in_a_furnace(renderer):
    plain = slab()
    x, _, z = grid(plain)
    angle = turning(x, z)
    volume = plain.replace(
        optic_axis=np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], -1),
        delta_n=(0.6 + 2.0 * x).astype(np.float32),
        delta_n_e=(0.5 + 3.0 * z).astype(np.float32),
    )
    frame = renderer.render(scene(pl.RefractiveVolume(volume, rotation=(10, 30, 0))), (80, 60))
    assert np.abs(frame.radiance - 1.0).max() < 5e-3


# ---- wavelengths and other bodies ---------------------------------------------------------------------------


def test_many_wavelengths_average_to_the_same_crystal(renderer):
    """The extraordinary index follows the wavelengths of each sample; without dispersion nothing changes."""
    spar = slab((0.6, 0.2, 0.8), pl.media.get("calcite"))
    item = pl.RefractiveVolume(spar, rotation=(20, 30, 0), spectral=6)
    assert np.abs(renderer.render(scene(item), (60, 45), samples=2).radiance - 1.0).max() < 5e-3
    floor = pl.Mesh.checkerboard(0.5, position=(0, -0.04, 0))
    three, many = (
        renderer.render(scene(floor, item.replace(spectral=count)), (60, 45), samples=4).radiance for count in (0, 6)
    )
    assert np.median(np.abs(three - many)) < 1e-3 and abs(three.mean() - many.mean()) < 0.01


def test_a_crystal_is_seen_through_glass(renderer):
    """Two bodies, one behind the other: the tourmaline behind the index-matched pane keeps its colour."""
    sigma = np.array([100.0, 10.0, 50.0])
    gem = pl.media.uniaxial(1.0 + 1e-7, 1.0 + 1e-7, sigma, 2.0 * sigma)
    stone = pl.RefractiveVolume(slab((0, 1, 0), gem))
    pane = pl.RefractiveVolume(slab(None, pl.media.constant(1.0 + 1e-7)), position=(0, 0, 0.05))
    truth = 0.5 * np.exp(-sigma * THICK) + 0.5 * np.exp(-2.0 * sigma * THICK)
    for objects in ((stone, pane), (pane, stone)):
        frame = renderer.render(scene(*objects, camera=FLAT), (8, 6))
        assert np.abs(frame.radiance / truth - 1.0).max() < 2e-3


def test_a_crystal_in_smoke_keeps_its_axis(renderer):
    """Volumes that reach into one another become one, whose axes of space are those of another body."""
    smoke = pl.RefractiveVolume.from_array(
        np.ones((16, 16, 16), np.float32),
        0.05,
        absorption=np.full((16, 16, 16, 3), 1e-4, np.float32),
        rotation=(0, 40, 0),
        boundary="smooth",
    )
    spar = pl.RefractiveVolume(
        pl.Volume.from_sdf(shapes.sphere(0.015), "calcite", 48, 0.04, optic_axis=(1, 2, 0)),
        rotation=(20, 0, 50),
        scale=1.2,
        dispersion=False,
    )
    floor = pl.Mesh.checkerboard(0.5, squares=40, position=(0, -0.04, 0))
    alone, within = (renderer.render(scene(floor, *objects), (80, 60)).radiance for objects in ((spar,), (spar, smoke)))
    error = np.abs(alone - within)
    assert np.quantile(error, 0.97) < 0.02 and np.median(error) < 1e-4, np.quantile(error, [0.5, 0.9, 0.97, 1.0])
    turned = renderer.render(scene(floor, spar.replace(rotation=(20, 90, 50))), (80, 60)).radiance
    assert np.abs(alone - turned).mean() > 3.0 * error.mean(), "another axis is another picture"


def test_crystals_that_join_keep_the_directions_of_their_axes():
    from pellucid.techniques.eikonal.joining import Joiner

    spar = pl.Volume.from_sdf(shapes.sphere(0.015), "calcite", 24, 0.04, optic_axis=(0.36, 0.48, 0.8))
    turns = ((20.0, 0.0, 50.0), (0.0, 70.0, 10.0))
    items = [pl.RefractiveVolume(spar, rotation=turn, position=(0.01 * k, 0, 0)) for k, turn in enumerate(turns)]
    joiner = Joiner()
    (group,) = joiner.groups(items)
    placed = joiner.place(group)
    volume, to_frame = placed.volume()
    world = placed.frame @ to_frame
    found = [world[:3, :3] @ region.optic_axis for region in volume.regions]
    expected = [item.object_to_world()[:3, :3] @ spar.regions[0].optic_axis for item in items]
    assert len(found) == 2, "bodies whose axes differ stay two"
    for axis in expected:
        assert max(abs(axis @ other) for other in found) > 1.0 - 1e-9
