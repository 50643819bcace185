"""Extinction, emission and scattering in the view: fields and constants, in bodies and around them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields import shapes
from pellucid.fields.volume import Region
from pellucid.optics.phase import henyey_greenstein
from pellucid.techniques.eikonal.passes import EikonalTechnique

EDGE = 0.1
VOXELS = 24
BOUNDARIES = ["sharp", "smooth"]
STRAIGHT = pl.Camera(position=(0, 0, 1), target=(0, 0, 0), orthographic_height_m=0.02)
DARK = (0.0, 0.0, 0.0)


@pytest.fixture(scope="module")
def renderer(device):
    return pl.Renderer(device)


@pytest.fixture
def light(monkeypatch, device):
    """light(fluence rgb, direction): every volume drawn from now on is lit so, the same everywhere."""

    drawn = EikonalTechnique.draw

    def shine(fluence, direction):
        textures = {
            name: device.texture(np.float16([[[[*value, 0.0]]]]), format="rgba16float", dimension="3d")
            for name, value in (("fluence_field", fluence), ("light_field", direction))
        }

        def draw(self, *arguments, **named):
            for body in self.bodies:
                body.light = textures
            return drawn(self, *arguments, **named)

        monkeypatch.setattr(EikonalTechnique, "draw", draw)

    return shine


def everywhere(*values, voxels=VOXELS):
    return np.broadcast_to(np.float32(values), (voxels, voxels, voxels, len(values)))


def with_region(volume, **changes):
    """The volume with other constants in its first region."""
    return volume.replace(regions=(replace(volume.regions[0], **changes), *volume.regions[1:]))


def full_block(n, **changes):
    """A body that fills its box, and is cut off there."""
    sdf = np.full((VOXELS,) * 3, -1.0)
    return pl.Volume((EDGE,) * 3, regions=(Region(sdf, pl.media.constant(n), **changes),))


def cloud(voxels=VOXELS):
    """Scattering (Z, Y, X, 3) that is strongest in the middle and ends in the box."""
    z, y, x = np.meshgrid(*3 * [(np.arange(voxels) + 0.5) / voxels - 0.5], indexing="ij")
    return 300.0 * np.clip(0.45 - np.sqrt(x**2 + y**2 + z**2), 0, 0.3)[..., None] * np.array([0.3, 0.6, 1.0])


def radiance_of(renderer, volume, environment=DARK, objects=(), camera=STRAIGHT, size=(4, 4), **placement):
    item = pl.RefractiveVolume(volume, **placement)
    around = pl.Environment.constant(environment)
    scene = pl.Scene(camera=camera, environment=around, objects=[item, *objects], tone_mapping="linear")
    return renderer.render(scene, size)


# ---- energy -------------------------------------------------------------------------------------------------


def furnace_volumes():
    empty = pl.Volume.from_array(
        np.ones((VOXELS,) * 3), EDGE, scattering=cloud(), anisotropy=np.full((VOXELS,) * 3, 0.6)
    )
    ball = with_region(
        pl.Volume.from_sdf(shapes.sphere(0.04), 1.5, VOXELS, EDGE), scattering=(10, 20, 40), anisotropy=0.5
    )
    inside = pl.Volume.from_sdf(shapes.sphere(0.025), 1.5, VOXELS, EDGE).replace(scattering=cloud())
    graded = ball.replace(delta_n=np.full((VOXELS,) * 3, 0.5))
    return {"cloud": empty, "ball": ball, "ball in a cloud": inside, "graded ball": graded}


@pytest.mark.parametrize("boundary", BOUNDARIES)
@pytest.mark.parametrize("kind", list(furnace_volumes()))
def test_matter_that_only_scatters_vanishes_in_a_furnace(renderer, kind, boundary):
    """What scattering takes from a ray of a uniform environment, it puts back, whatever the phase function."""
    camera = pl.Camera(position=(0.0, 0.03, 0.3), target=(0, 0, 0), fov_deg=26.0)
    walls = (1.0, 0.5, 0.25)
    frame = radiance_of(renderer, furnace_volumes()[kind], walls, camera=camera, size=(48, 48), boundary=boundary)
    error = np.abs(frame.radiance / np.array(walls) - 1.0).max()
    assert error < 1e-5, f"the furnace is off by {error:.1e}"


# ---- extinction ---------------------------------------------------------------------------------------------

SIGMA_A, SIGMA_S = np.array([5.0, 10.0, 20.0]), np.array([1.0, 4.0, 8.0])


def blocks():
    fields = {"absorption": everywhere(*SIGMA_A), "scattering": everywhere(*SIGMA_S)}
    medium = pl.media.constant(1.5, tuple(SIGMA_A), name="murky")
    constants = full_block(1.5, scattering=tuple(SIGMA_S))
    constants = with_region(constants, medium=medium)
    return {
        "fields, smooth": (pl.Volume.from_array(np.ones((VOXELS,) * 3), EDGE, **fields), "smooth"),
        "fields of a dense block, smooth": (
            pl.Volume.from_array(np.full((VOXELS,) * 3, 1.2), EDGE, **fields),
            "smooth",
        ),
        "fields, sharp": (pl.Volume.from_array(np.full((VOXELS,) * 3, 1.5), EDGE, **fields), "sharp"),
        "fields in a body": (full_block(1.5).replace(**fields), "sharp"),
        "constants": (constants, "sharp"),
        "constants, smooth": (constants, "smooth"),
        "constants of a graded body": (constants.replace(delta_n=np.full((VOXELS,) * 3, 0.5)), "sharp"),
        "both": (constants.replace(absorption=everywhere(*SIGMA_A)), "sharp"),
    }


@pytest.mark.parametrize("kind", list(blocks()))
def test_extinction_of_a_homogeneous_block_is_exact_at_any_step(device, kind):
    volume, boundary = blocks()[kind]
    sigma = SIGMA_A + SIGMA_S + (SIGMA_A if kind == "both" else 0.0)
    depths = []
    # A rim that fades over a voxel wants steps that are shorter.
    fades = boundary == "smooth" and kind != "fields, smooth"
    for step, adaptive in ((0.3, False), (0.5, True), (0.4 if fades else 2.0, True)):
        quality = pl.Quality(step_voxels=step, adaptive=adaptive)
        item = pl.RefractiveVolume(volume, boundary=boundary)
        rays = pl.trace(item, [(0.013, 0.004, 1.0)], [(0, 0, -1.0)], quality=quality)
        n = 1.0 + 0.5 * (boundary == "sharp")
        fresnel = (1.0 - ((n - 1.0) / (n + 1.0)) ** 2) ** 2
        depths.append(-np.log(rays.transmittance[0] / fresnel))
        if fades:  # what a smooth boundary reflects is the same for all channels, and not quite Fresnel
            depths[-1] -= depths[-1][0] - sigma[0] * EDGE
    # Fields are kept in 16 bits.
    error = np.abs(np.array(depths) / (sigma * EDGE) - 1.0).max()
    assert error < 1e-3, f"off by {error:.1e}"
    steps_differ = np.ptp(np.array(depths), axis=0).max()
    assert steps_differ < 1e-3, f"steps differ by {steps_differ:.1e}"


def test_a_field_inside_a_sharp_body_colours_what_is_behind(renderer):
    """Absorption that rises along the ray: midpoints integrate what is linear without error."""
    ramp = np.zeros((VOXELS, VOXELS, VOXELS, 3), np.float32)
    ramp[...] = 64.0 * (np.arange(VOXELS)[:, None, None, None] + 0.5) / VOXELS * np.float32([1.0, 0.5, 0.25])
    volume = full_block(1.0).replace(absorption=ramp)
    truth = np.exp(-32.0 * EDGE * np.array([1.0, 0.5, 0.25]))
    along = radiance_of(renderer, volume, (1, 1, 1)).radiance[0, 0]
    error = np.abs(along / truth - 1.0).max()
    assert error < 2e-3, f"off by {error:.1e}"


def test_a_dark_heart_in_clear_glass_is_found(device):
    """A field that is zero but for a small lump: long steps through the glass around it must not jump over it."""
    z, y, x = np.meshgrid(*3 * [(np.arange(VOXELS) + 0.5) / VOXELS - 0.5], indexing="ij")
    lump = np.where(np.maximum(np.maximum(abs(x), abs(y)), abs(z)) < 0.1, 80.0, 0.0)
    volume = pl.Volume.from_sdf(shapes.sphere(0.04), 1.0, VOXELS, EDGE).replace(absorption=lump[..., None] * np.ones(3))
    rays = pl.trace(pl.RefractiveVolume(volume), [(0.001, 0.002, 1.0)], [(0, 0, -1.0)])
    wide = np.count_nonzero(lump[:, VOXELS // 2, VOXELS // 2]) * EDGE / VOXELS
    error = abs(-np.log(rays.transmittance[0, 0]) / (80.0 * wide) - 1.0)
    assert error < 5e-3, f"off by {error:.1e}"


# ---- scattered light ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("g", [-0.5, 0.0, 0.5, 0.9])
@pytest.mark.parametrize("kind", ["smooth", "sharp", "constants"])
def test_single_scattering_of_even_light_has_its_closed_form(renderer, light, kind, g):
    """sigma_s phi HG(cos, g |m|) (1 - exp(-sigma_t L)) / sigma_t, for parallel and for partly diffuse light."""
    fluence = np.array([3.0, 2.0, 1.0])
    if kind == "constants":
        medium = pl.media.constant(1.0, tuple(SIGMA_A), name="murky")
        volume = with_region(full_block(1.0, scattering=tuple(SIGMA_S), anisotropy=g), medium=medium)
    else:
        fields = {"absorption": everywhere(*SIGMA_A), "scattering": everywhere(*SIGMA_S)}
        volume = pl.Volume.from_array(np.ones((VOXELS,) * 3), EDGE, anisotropy=np.full((VOXELS,) * 3, g), **fields)
    sigma_t = SIGMA_A + SIGMA_S
    for m in ((0.0, 0.0, 1.0), (0.0, 0.0, -0.5), (0.3, -0.4, 0.0), (0.0, 0.0, 0.0)):
        light(fluence, m)
        parallel = float(np.linalg.norm(m))
        cos_theta = m[2] / parallel if parallel else 0.0  # the viewer is at +z
        phase = henyey_greenstein(cos_theta, g * parallel)
        truth = SIGMA_S * fluence * phase * (1 - np.exp(-sigma_t * EDGE)) / sigma_t
        boundary = "smooth" if kind == "smooth" else "sharp"
        seen = radiance_of(renderer, volume, boundary=boundary).radiance
        error = np.abs(seen / truth - 1.0).max()
        assert error < 4e-3, f"m = {m}: off by {error:.1e}"


def test_scattered_light_leaves_dense_matter_by_n_squared(renderer, light):
    """A slab of index n, lit evenly, isotropic: (1 - R) S / (1 - R exp(-sigma L)), with S of one passage over n^2."""
    n, fluence = 1.5, np.array([2.0, 2.0, 2.0])
    volume = full_block(n, scattering=(4.0, 8.0, 16.0))
    light(fluence, (0, 0, 0))
    sigma = np.array([4.0, 8.0, 16.0])
    reflectance = ((n - 1) / (n + 1)) ** 2
    kept = np.exp(-sigma * EDGE)
    passage = fluence / (4 * np.pi) * (1 - kept) / n**2
    truth = (1 - reflectance) * passage / (1 - reflectance * kept)
    frame = radiance_of(renderer, volume, quality=pl.Quality(min_weight=1e-6))
    error = np.abs(frame.radiance / truth - 1.0).max()
    assert error < 1e-3, f"off by {error:.1e}"


def test_an_index_matched_block_scatters_as_much_as_a_cloud_of_the_same_strength(renderer, light):
    light((3.0, 2.0, 1.0), (0.0, -0.7, 0.0))
    camera = pl.Camera(position=(0.1, 0.1, 0.3), target=(0, 0, 0), fov_deg=20.0)
    body = full_block(1.0, scattering=tuple(SIGMA_S), anisotropy=0.4)
    fields = {"scattering": everywhere(*SIGMA_S), "anisotropy": np.full((VOXELS,) * 3, 0.4)}
    smoke = pl.Volume.from_array(np.ones((VOXELS,) * 3), EDGE, **fields)
    seen = [radiance_of(renderer, v, camera=camera, size=(40, 30)).radiance for v in (body, smoke)]
    # Sampled distances round off the edges of the body by a voxel.
    error = np.quantile(np.abs(seen[0] - seen[1]), 0.95) / seen[0].max()
    assert seen[0].max() > 0.01 and error < 2e-3, f"off by {error:.1e}"


@pytest.mark.parametrize("kind", ["smooth", "sharp", "body"])
def test_a_block_under_a_lamp_glows_from_the_side_by_two_exponentials(renderer, kind):
    """sigma_s E exp(-sigma_t depth) HG(0) (1 - exp(-sigma_t L)) / sigma_t, with the light that the simulator finds."""
    g, irradiance = 0.4, 3.0
    fields = {"scattering": everywhere(*SIGMA_S), "anisotropy": np.full((VOXELS,) * 3, g)}
    volume = pl.Volume.from_array(np.ones((VOXELS,) * 3), EDGE, **fields)
    if kind == "body":
        volume = full_block(1.0, scattering=tuple(SIGMA_S), anisotropy=g)
    item = pl.RefractiveVolume(volume, boundary="smooth" if kind == "smooth" else "sharp")
    lamp = pl.DirectionalLight(direction=(0, -1, 0), irradiance=irradiance)
    camera = pl.Camera(position=(0, 0, 1), target=(0, 0, 0), orthographic_height_m=0.08)
    dark = pl.Environment.constant(DARK)
    frame = renderer.render(pl.Scene(camera=camera, environment=dark, lights=[lamp], objects=[item]), (24, 24))
    rows = np.flatnonzero(frame.radiance[:, 12, 2] > 0)
    depth = 0.5 * EDGE - (0.5 - (rows + 0.5) / 24) * 0.08
    thick = (1 - np.exp(-SIGMA_S * EDGE)) / SIGMA_S
    truth = SIGMA_S * irradiance * np.exp(-SIGMA_S * depth[:, None]) * henyey_greenstein(0.0, g) * thick
    assert len(rows) == 24
    error = np.abs(frame.radiance[:, 4:20] / truth[:, None] - 1.0).max()
    assert error < 0.02, f"off by {error:.1e}"


# ---- smoke --------------------------------------------------------------------------------------------------


def smoky_ball(**fields):
    return pl.Volume.from_sdf(shapes.sphere(0.015), 1.5, VOXELS, EDGE).replace(**fields)


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_smoke_without_a_surface_dims_what_is_behind_and_has_no_depth(renderer, boundary):
    volume = smoky_ball(absorption=everywhere(*SIGMA_A))
    camera = pl.Camera(position=(0, 0, 1), target=(0, 0, 0), orthographic_height_m=0.096)
    floor = pl.Mesh.plane(
        0.1, rotation=(90, 0, 0), position=(0, 0, -0.2), base_color=(0, 0, 0), emission=(2, 2, 2), specular=0.0
    )
    frame = radiance_of(renderer, volume, (1, 1, 1), [floor], camera, (33, 33), boundary=boundary)
    truth = np.exp(-SIGMA_A * EDGE)
    beside = frame.radiance[16, 1]
    assert np.abs(beside / (2 * truth) - 1.0).max() < 2e-3, beside / (2 * truth)
    assert frame.depth[16, 1] == pytest.approx(1.2, rel=1e-3), "smoke does not write depth"
    assert frame.depth[16, 16] == pytest.approx(1.0 - 0.015, abs=0.006), "the ball does"


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_smoke_behind_a_mesh_is_not_seen(renderer, boundary):
    """A lamp in the smoke, half-way in: its light is dimmed by what lies before it only."""
    volume = smoky_ball(absorption=everywhere(*SIGMA_A))
    lamp = pl.Mesh.plane(
        0.02, rotation=(90, 0, 0), position=(0.035, 0, 0.01), base_color=(0, 0, 0), emission=(1, 1, 1), specular=0.0
    )
    camera = pl.Camera(position=(0.035, 0, 1), target=(0.035, 0, 0), orthographic_height_m=0.004)
    frame = radiance_of(renderer, volume, (0, 0, 0), [lamp], camera, boundary=boundary)
    truth = np.exp(-SIGMA_A * 0.04)
    error = np.abs(frame.radiance / truth - 1.0).max()
    assert error < 2e-3, f"off by {error:.1e}"


def test_smoke_ends_where_its_box_ends_around_a_body_that_is_cut_off_there(device):
    """Such a box gets a margin, which the fields do not fill."""
    half = pl.Volume.from_sdf(lambda x, y, z: x + 0 * y, 1.0, VOXELS, EDGE).replace(absorption=everywhere(*SIGMA_A))
    rays = pl.trace(pl.RefractiveVolume(half), [(0.02, 0.01, 1.0), (-0.02, 0.01, 1.0)], [(0, 0, -1.0)])
    error = np.abs(rays.transmittance / np.exp(-SIGMA_A * EDGE) - 1.0).max()
    assert error < 1e-3, f"off by {error:.1e}"


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_opaque_voxels_keep_their_colour_to_the_rim(renderer, boundary):
    """White light from all sides: what is matt shows its colour, though beside it there is none to interpolate with."""
    opaque = np.zeros((VOXELS,) * 3 + (4,))
    opaque[8:16, 8:16, 8:16] = (0.8, 0.4, 0.2, 1.0)
    camera = pl.Camera(position=(0.5, 0.3, 1), target=(0, 0, 0), orthographic_height_m=0.08)
    volume = pl.Volume.from_array(np.ones((VOXELS,) * 3), EDGE, opaque=opaque)
    seen = radiance_of(renderer, volume, (1, 1, 1), camera=camera, size=(32, 32), boundary=boundary).radiance
    colours = seen[np.abs(seen - 1.0).max(axis=-1) > 1e-3]
    error = np.abs(colours / (0.8, 0.4, 0.2) - 1.0).max()
    assert len(colours) > 100 and error < 2e-3, f"off by {error:.1e}"
