"""Reflection data and BRDFs of boundaries: lobes against their formulae, limits, energy, lamps."""

from __future__ import annotations

import numpy as np
import pytest

import oracles
import pellucid as pl
from pellucid.fields import shapes
from pellucid.gpu.probe import probe
from pellucid.scene.brdf import GGX, TabulatedBRDF
from pellucid.surroundings import ggx
from pellucid.techniques.eikonal.brdf_tables import lobe_alpha

SIZE = (96, 72)
CAMERA = pl.Camera(position=(0.02, 0.07, 0.22), target=(0.0, 0.0, 0.0), fov_deg=30.0)
DARK = pl.Environment.constant((0.0, 0.0, 0.0))
WHITE = pl.Environment.constant((1.0, 1.0, 1.0))
BLACK_GLASS = pl.media.constant(1.5, (1e6, 1e6, 1e6), name="black glass")


@pytest.fixture(scope="module")
def renderer(device):
    return pl.Renderer(device)


@pytest.fixture(scope="module")
def ball():
    return pl.Volume.from_sdf(shapes.sphere(0.04), 1.5, 48, 0.1)


@pytest.fixture(scope="module")
def slab():
    return pl.Volume.from_sdf(shapes.box((0.08, 0.08, 0.04)), BLACK_GLASS, 48, 0.1)


def picture(renderer, *objects, environment=WHITE, camera=CAMERA, lights=(), size=SIZE, samples=1):
    scene = pl.Scene(camera=camera, environment=environment, objects=objects, lights=lights, tone_mapping="linear")
    return renderer.render(scene, size, samples=samples).radiance


def seen_at(renderer, slab, angle_deg, lights, samples=1, **look):
    """Radiance of the front face of a slab of black glass in the dark, seen from `angle_deg` off its normal."""
    t = np.radians(angle_deg)
    camera = pl.Camera(position=(np.sin(t), 0.0, 0.02 + np.cos(t)), target=(0.0, 0.0, 0.02), orthographic_height_m=1e-3)
    item = pl.RefractiveVolume(slab, **look)
    return picture(renderer, item, environment=DARK, camera=camera, lights=lights, size=(2, 2), samples=samples)[0, 0]


def lamp_from(angle_deg, irradiance=2.0):
    """A lamp that stands this far off the normal, on the side away from the viewer."""
    t = np.radians(angle_deg)
    return pl.DirectionalLight((np.sin(t), 0.0, -np.cos(t)), irradiance=irradiance)


def microfacet(view_deg, lamp_deg, roughness):
    """f_r cos of GGX in the plane of incidence, Fresnel apart; both angles from the normal, on opposite sides of it."""
    v, to = np.radians(view_deg), np.radians(lamp_deg)
    alpha = roughness**2
    lobe = ggx.ggx_distribution(np.cos(0.5 * (v - to)), alpha) * ggx.ggx_visibility(np.cos(to), np.cos(v), alpha)
    return lobe / ggx.ggx_directional_albedo(np.cos(v), alpha)[0] * np.cos(to)


def test_the_twins_of_the_lobe_agree(device):
    rng = np.random.default_rng(1)
    cosines, alpha = rng.uniform(0.01, 1.0, (2, 500)), rng.uniform(0.02, 1.0, 500)

    def of(name, *rows):
        return probe("surroundings/shaders/ggx", name, *(r.astype(np.float32) for r in rows), device=device)

    assert of("ggx_distribution", cosines[0], alpha) == pytest.approx(ggx.ggx_distribution(cosines[0], alpha), rel=2e-3)
    found = of("ggx_visibility", *cosines, alpha)
    assert found == pytest.approx(ggx.ggx_visibility(*cosines, alpha), rel=1e-4)


def test_visible_normals_have_the_density_that_is_claimed(device):
    count, alpha = 200_000, 0.4
    u = np.random.default_rng(3).random((count, 2)).astype(np.float32)
    n, v = np.array([0.36, 0.48, 0.8], np.float32), np.array([0.0, 0.6, 0.8], np.float32)
    module = "techniques/eikonal/shaders/visible_normal"
    h = probe(module, "visible_normal", n, v, np.float32(alpha), u, device=device)
    density = probe(module, "visible_normal_density", n, v, h, np.float32(alpha), device=device)
    # So weighted they measure the microfacet lobe: what facets send back.
    n_dot_l = 2 * (h @ v) * (h @ n) - n @ v
    lobe = ggx.ggx_distribution(h @ n, alpha) * ggx.ggx_visibility(np.maximum(n_dot_l, 1e-9), n @ v, alpha)
    sent = np.where(n_dot_l > 0, lobe * n_dot_l * 4 * (h @ v) / density, 0.0)
    truth = ggx.ggx_directional_albedo(n @ v, alpha)[0]
    assert abs(sent.mean() / truth - 1) < 3e-3, f"{sent.mean():.4f} instead of {truth:.4f}"


@pytest.mark.parametrize("roughness", [0.3, 0.6, 0.9])
@pytest.mark.parametrize(("view", "lamp"), [(0.0, 20.0), (35.0, 50.0), (60.0, 40.0)])
def test_a_lamp_in_a_rough_boundary_is_the_microfacet_formula(renderer, slab, roughness, view, lamp):
    found = seen_at(renderer, slab, view, [lamp_from(lamp)], brdf=GGX(roughness=roughness))
    fresnel = 0.04 if view == 0 else oracles.fresnel(np.radians(view), 1.0, 1.5)
    truth = 2.0 * fresnel * microfacet(view, lamp, roughness)
    assert found == pytest.approx(truth, rel=0.02), f"{found[0] / truth - 1:+.1%}"


def test_a_lobe_sends_back_all_that_arrives(renderer, slab):
    """Lamps all over the hemisphere, one after the other: what a viewer gets adds up to Fresnel's share."""
    turns = np.radians(np.arange(5.0, 180.0, 10.0))
    total = 0.0
    for t in np.radians(np.arange(5.0, 90.0, 10.0)):
        ring = [
            pl.DirectionalLight((np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), -np.cos(t)), irradiance=1.0)
            for p in np.concatenate([turns, -turns])
        ]
        dome = np.sin(t) * np.radians(10.0) ** 2  # each lamp stands for this solid angle of unit radiance
        total += dome * seen_at(renderer, slab, 30.0, ring, brdf=GGX(roughness=0.6))[0]
    truth = oracles.fresnel(np.radians(30.0), 1.0, 1.5)
    assert total == pytest.approx(truth, rel=0.02)


def test_lambert_and_ggx_from_a_table_are_what_the_formulae_say(renderer, slab):
    lambert = TabulatedBRDF.from_function(lambda h, d: 0.0 * h + 0.7 / np.pi)
    assert lambert.albedo([0.3, 1.0]) == pytest.approx(0.7, rel=5e-3)
    fresnel = oracles.fresnel(np.radians(35.0), 1.0, 1.5)
    matt = seen_at(renderer, slab, 35.0, [lamp_from(50.0)], brdf=lambert)
    assert matt == pytest.approx(2.0 * fresnel * 0.7 / np.pi * np.cos(np.radians(50.0)), rel=2e-3)

    roughness, alpha = 0.6, 0.36

    def facets(half, difference):
        """With visibility as if n.l = n.v = cos h cos d, which a table needs no third angle for."""
        cosine = np.maximum(np.cos(half) * np.cos(difference), 0.05)
        return ggx.ggx_distribution(np.cos(half), alpha) * ggx.ggx_visibility(cosine, cosine, alpha)

    table = TabulatedBRDF.from_function(facets)
    assert lobe_alpha(table) == pytest.approx(alpha, rel=0.2)
    view, lamp = 35.0, 50.0
    found = seen_at(renderer, slab, view, [lamp_from(lamp)], brdf=table)
    truth = 2.0 * fresnel * facets(np.radians(7.5), np.radians(42.5)) * np.cos(np.radians(lamp))
    assert found == pytest.approx(truth, rel=5e-3)
    ideal = seen_at(renderer, slab, view, [lamp_from(lamp)], brdf=GGX(roughness=roughness))
    kept = ggx.ggx_directional_albedo(np.cos(np.radians(view)), alpha)[0]
    assert found == pytest.approx(ideal * kept, rel=0.03)


@pytest.mark.parametrize("boundary", ["sharp", "smooth"])
def test_roughness_towards_zero_is_the_mirror(renderer, ball, boundary):
    around = pl.Environment.studio()
    item = pl.RefractiveVolume(ball, boundary=boundary)
    mirror = picture(renderer, item, environment=around)
    errors = [
        np.abs(picture(renderer, item.replace(brdf=GGX(roughness=r), gloss=0.0), environment=around) - mirror).mean()
        for r in (0.6, 0.2, 0.05, 0.0)
    ]
    assert errors == sorted(errors, reverse=True) and errors[2] < 0.1 * errors[0] and errors[3] == 0.0, errors


@pytest.mark.parametrize("boundary", ["sharp", "smooth"])
@pytest.mark.parametrize("roughness", [0.0, 0.4, 1.0])
def test_reflection_data_of_tint_one_keep_the_furnace_closed(renderer, ball, boundary, roughness):
    data = np.ones((*ball.shape, 4))
    data[..., 3] = roughness
    item = pl.RefractiveVolume(ball.replace(reflection=data), boundary=boundary, brdf=GGX())
    floor = pl.Mesh.plane(4.0, base_color=(1.0, 1.0, 1.0), specular=0.0, position=(0, -0.05, 0))
    error = np.abs(picture(renderer, item, floor) - 1.0).max()
    assert error < 5e-3, f"off by {error:.1e}"


def test_a_table_in_a_furnace_sends_back_its_albedo(renderer, slab):
    grey = TabulatedBRDF.from_function(lambda h, d: 0.0 * h + 0.5 / np.pi)
    camera = pl.Camera(position=(0, 0, 1), target=(0, 0, 0), orthographic_height_m=0.02)
    found = picture(renderer, pl.RefractiveVolume(slab, brdf=grey), camera=camera, size=(4, 4))
    assert found == pytest.approx(0.04 * 0.5, rel=5e-3)


def test_tint_takes_its_share_of_what_is_mirrored_and_no_more(renderer, ball, slab):
    """Half of a slab of black glass is coated: a mirror of that tint, sharp and smooth, with a BRDF and without."""
    data = np.ones((*slab.shape, 4))
    data[:, :, : slab.shape[2] // 2] = (0.5, 0.25, 0.0, 0.0)
    coated = slab.replace(reflection=data)
    camera = pl.Camera(position=(0, 0, 1), target=(0, 0, 0), orthographic_height_m=0.02)
    for look in ({}, {"brdf": GGX()}, {"boundary": "smooth"}):
        found = picture(renderer, pl.RefractiveVolume(coated, **look), camera=camera, size=(8, 6))
        assert found[:, 0] == pytest.approx(np.tile([0.02, 0.01, 0.0], (6, 1)), abs=5e-4), look
        assert found[:, 7] == pytest.approx(0.04, abs=2e-3)
    uniform = picture(renderer, pl.RefractiveVolume(slab, brdf=GGX(0.5, (0.5, 0.25, 0.0))), camera=camera, size=(4, 4))
    assert uniform[1, 1] == pytest.approx([0.02, 0.01, 0.0], rel=1e-3)


@pytest.mark.parametrize("boundary", ["sharp", "smooth"])
def test_a_lamp_glints_where_the_mirror_shows_it(renderer, boundary):
    """On a ball the glint lies where the normal bisects lamp and view, as strong as a convex mirror makes it."""
    black = pl.Volume.from_sdf(shapes.sphere(0.04), BLACK_GLASS, 64, 0.1)
    camera = pl.Camera(position=(0, 0, 1), target=(0, 0, 0), orthographic_height_m=0.08)
    item = pl.RefractiveVolume(black, boundary=boundary, gloss=0.15)
    lamp = lamp_from(-60.0, irradiance=1.0)  # on the right
    found = picture(renderer, item, environment=DARK, camera=camera, lights=[lamp], size=(96, 96), samples=4)[..., 1]
    weight = found / found.sum()
    x = (np.arange(96) + 0.5) / 96 * 0.08 - 0.04
    # The lamp stands at 60 deg to the right, so the normal there leans by 30 deg.
    assert (weight.sum(axis=0) * x).sum() == pytest.approx(0.04 * np.sin(np.radians(30.0)), abs=1.5e-3)
    # A convex mirror scatters intensity E R^2/4 evenly in all directions [radar cross section of a sphere].
    intensity = found.sum() * (0.08 / 96) ** 2
    fresnel = oracles.fresnel(np.radians(30.0), 1.0, 1.5)
    assert intensity == pytest.approx(fresnel * 0.04**2 / 4, rel=0.2 if boundary == "smooth" else 0.03)


def test_without_gloss_or_lamps_there_is_no_glint(renderer, ball):
    lamp = lamp_from(-60.0)
    bare = picture(renderer, pl.RefractiveVolume(ball), environment=pl.Environment.studio())
    plain = pl.RefractiveVolume(ball, gloss=0.0)
    assert (picture(renderer, plain, environment=pl.Environment.studio(), lights=[lamp]) == bare).all()


def test_an_area_light_fills_the_lobe_it_covers(renderer, slab):
    """A rectangle larger than a sharp lobe is seen with its own radiance; by a wide lobe with the integral over it."""
    lamp = pl.AreaLight((0.0, 0.0, 0.5), (0.6, 0.0, 0.0), (0.0, -0.6, 0.0), radiance=3.0, cast_shadow=False)
    sharp = seen_at(renderer, slab, 0.0, [lamp], samples=64, gloss=0.1)
    assert sharp == pytest.approx(0.04 * 3.0, rel=0.03)
    wide = seen_at(renderer, slab, 0.0, [lamp], samples=512, brdf=GGX(0.7))
    s = (np.arange(200) + 0.5) / 200 * 0.6 - 0.3
    x, y = np.meshgrid(s, s)
    d2 = x**2 + y**2 + 0.48**2
    cosine = 0.48 / np.sqrt(d2)
    half = np.cos(0.5 * np.arccos(cosine))
    lobe = ggx.ggx_distribution(half, 0.49) * ggx.ggx_visibility(cosine, 1.0, 0.49)
    lobe /= ggx.ggx_directional_albedo(1.0, 0.49)[0]
    truth = 0.04 * 3.0 * (lobe * cosine * cosine / d2).sum() * (0.6 / 200) ** 2
    assert wide == pytest.approx(truth, rel=0.02)


def test_a_mesh_stands_in_the_light_of_a_glint(renderer, slab):
    lamp = lamp_from(30.0)
    lit = seen_at(renderer, slab, 30.0, [lamp])
    screen = pl.Mesh.box(0.02, position=(-0.1 * np.tan(np.radians(30)), 0, 0.12))
    camera = pl.Camera(position=(0.5, 0, 0.02 + 0.5 * np.sqrt(3)), target=(0, 0, 0.02), orthographic_height_m=1e-3)
    item = pl.RefractiveVolume(slab)
    shaded = picture(renderer, item, screen, environment=DARK, camera=camera, lights=[lamp], size=(2, 2))
    assert lit.min() > 1.0 and shaded.max() < 0.2


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: GGX(roughness=1.5), "ggx.roughness"),
        (lambda: GGX(tint=(1, 1, 2)), "ggx.tint"),
        (lambda: TabulatedBRDF(np.zeros((4, 4))), "brdf.values"),
        (lambda: TabulatedBRDF(np.zeros((1, 4, 3))), "brdf.values"),
        (lambda: TabulatedBRDF(np.full((4, 4, 3), -1.0)), "brdf.values"),
        (lambda: TabulatedBRDF(np.full((4, 4, 3), np.nan)), "brdf.values"),
        (lambda: TabulatedBRDF(np.full((4, 4, 3), 1.0)), "multiply by 0.3"),
    ],
)
def test_faults_are_named(make, field):
    with pytest.raises(pl.SceneError, match=field):
        make()


def test_faulty_reflection_data_are_refused(ball):
    with pytest.raises(pl.SceneError, match="reflection"):
        ball.replace(reflection=np.full((*ball.shape, 4), 1.5))
    with pytest.raises(pl.SceneError, match="reflection"):
        ball.replace(reflection=np.ones((*ball.shape, 3)))
    with pytest.raises(pl.SceneError, match="brdf"):
        pl.RefractiveVolume(ball, brdf="ggx")
    with pytest.raises(pl.SceneError, match="gloss"):
        pl.RefractiveVolume(ball, gloss=-0.1)
