"""Rays that are looked up in pictures: the iteration of the thesis, our march, and rays to the meshes themselves."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields.waves import Sine
from pellucid.gpu import Device, RenderPass
from pellucid.optics.snell import refract
from pellucid.scene.water_quality import WaterQuality
from pellucid.surroundings import Query, Surroundings
from pellucid.surroundings.camera import view_of
from pellucid.techniques.water.cameras import Basin, refraction_camera, visible_surface
from pellucid.techniques.water.passes import WaterTechnique
from pellucid.techniques.water.picture_query import HIDDEN, SOMETHING, UNKNOWN, PictureQuery, unprojected
from pellucid.techniques.water.prepare import surfaces_of, wave_maps
from pellucid.techniques.water.reference_pictures import first_triangle, iterate
from pellucid.techniques.water.views import SurfacePictures

SIZE = (64, 48)
CAMERA = pl.Camera((0.0, 2.5, 7.0), (0.0, -0.3, 0.0), fov_deg=45.0)
WATER = pl.Water(extent_m=14.0, medium=1.333)
SOURCE = WaterQuality(refraction="iteration", reflection="march", cameras="mihalik", texture_size=192)


def bottom(kind: str, side: int = 57) -> pl.Mesh:
    x, z = np.meshgrid(np.linspace(-12, 12, side), np.linspace(-12, 12, side))
    y = {
        "slope": -2.0 + 0.06 * x - 0.05 * z,
        "hills": -1.8 + 0.45 * np.sin(1.1 * x) * np.cos(0.9 * z),
        "level": -1.5 + 0.0 * x,
    }[kind]
    i = np.arange(side * side).reshape(side, side)
    a, b, c, d = i[:-1, :-1].ravel(), i[1:, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel()
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([b, d, c], -1)])
    return pl.Mesh(np.stack([x, y, z], -1).reshape(-1, 3), faces)


class Looked:
    """Pictures of a bottom, and refracted rays of a lightly waved surface above it."""

    def __init__(self, device: Device, *objects: pl.Mesh, quality: WaterQuality = SOURCE) -> None:
        self.surroundings = Surroundings(device)
        self.surroundings.prepare(
            pl.Scene(camera=CAMERA, environment=pl.Environment.constant(0.5), objects=[*objects]), SIZE
        )
        self.pictures = SurfacePictures(device)
        encoder = device.wgpu.create_command_encoder()
        self.pictures.draw(encoder, WATER, quality, ((0.0, 0.0), 0.1), self.surroundings)
        device.wgpu.queue.submit([encoder.finish()])
        self.query = PictureQuery(self.pictures)
        basin = Basin(0.0, (-7.0, -7.0), (7.0, 7.0), 0.1, 1.333, 1.0, -3.0)
        self.points, ways = visible_surface(view_of(CAMERA, SIZE), basin)
        slopes = 0.08 * np.stack([np.sin(3 * self.points[:, 0]), np.cos(2 * self.points[:, 2])], -1)
        normals = np.stack([-slopes[:, 0], np.ones(len(slopes)), -slopes[:, 1]], -1)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        self.ways = refract(ways, normals, 1.0, 1.333).direction
        hits = Query(self.surroundings).hits(self.points, self.ways)
        self.met = hits["valid"] != 0
        self.true = self.points + hits["t"][:, None] * self.ways

    def errors(self, places: Any) -> np.ndarray:
        """Metres between what is shown and what the rays meet."""
        return np.linalg.norm(places.shown_ws - self.true, axis=1)[self.met]


@pytest.fixture(scope="module")
def hills(device: Device) -> Looked:
    return Looked(device, bottom("hills"))


def plane_lookup(view: Any, normal: np.ndarray, at: float) -> Any:
    """Where the rays of a camera through points meet a plane."""

    def ends(w: np.ndarray) -> np.ndarray:
        way = w - view.position
        return view.position + way * ((at - view.position @ normal) / (way @ normal))[:, None]

    return ends


def test_on_a_flat_bottom_the_iteration_becomes_exact() -> None:
    view = refraction_camera(view_of(CAMERA, SIZE), 0.0, 1.0, 1.333)
    points, ways = visible_surface(view_of(CAMERA, SIZE), Basin(0.0, (-6, -6), (6, 6), 0.0, 1.333, 1.0, -3.0))
    rays = refract(ways, np.broadcast_to((0.0, 1.0, 0.0), ways.shape), 1.0, 1.333).direction
    normal = np.array([0.1, 1.0, -0.05])
    ends = plane_lookup(view, normal, -2.0)
    exact = points + rays * ((-2.0 - points @ normal) / (rays @ normal))[:, None]
    errors = [
        np.linalg.norm(iterate(points, rays, ends, lambda w: (w - view.position) @ view.axes[2], n).a - exact, axis=1)
        for n in (1, 3, 8)
    ]
    assert np.median(errors[0]) > 0.1 and errors[1].max() < 0.3 * errors[0].max()
    assert errors[2].max() < 1e-9


def test_more_steps_are_never_worse() -> None:
    """The nearest of all is kept, whatever later steps do: on a bottom that is no function of anything smooth."""
    rng = np.random.default_rng(3)
    u = np.c_[rng.uniform(-2, 2, 200), np.zeros(200), rng.uniform(-2, 2, 200)]
    r = np.array([0.3, -0.9, 0.1]) / np.linalg.norm([0.3, -0.9, 0.1])
    eye = np.array([0.0, 3.0, 5.0])

    def ends(w: np.ndarray) -> np.ndarray:
        way = w - eye
        depth = -2.0 + 0.7 * np.sign(np.sin(9 * w[:, 0]) * np.cos(7 * w[:, 2]))
        return eye + way * ((depth - eye[1]) / way[:, 1])[:, None]

    ways = np.broadcast_to(r, u.shape)
    gaps = [iterate(u, ways, ends, lambda w: np.linalg.norm(w - eye, axis=1), n).gap for n in range(1, 13)]
    assert all((later <= earlier).all() for earlier, later in pairwise(gaps))
    assert np.median(gaps[-1]) < 0.2 * np.median(gaps[0])


def test_the_shader_iterates_as_the_reference(hills: Looked) -> None:
    view = hills.pictures.views[0]
    assert view is not None
    _, depths = hills.pictures.read(0)
    size = np.array(depths.shape[::-1])

    def ends(w: np.ndarray) -> np.ndarray:
        clip = np.c_[w, np.ones(len(w))] @ (view.projection @ view.view_from_world).T
        uv = 0.5 + np.array([0.5, -0.5]) * clip[:, :2] / clip[:, 3:]
        at = np.clip(uv * size - 0.5, 0, size - 1)
        low = at.astype(int)
        high = np.minimum(low + 1, size - 1)
        x, y = (at - low).T
        rows = [(1 - x) * depths[k, low[:, 0]] + x * depths[k, high[:, 0]] for k in (low[:, 1], high[:, 1])]
        deep = view.near_m / np.maximum((1 - y) * rows[0] + y * rows[1], 1e-6)
        return view.position + (w - view.position) * (np.minimum(deep, 1e4) / clip[:, 3])[:, None]

    # Above some points the picture shows the sky: the first step is then as long as a sky is far, and rounds so too.
    u, r = hills.points, hills.ways
    shown = iterate(u, r, ends, lambda w: (w - view.position) @ view.axes[2], 1).gap < 100.0
    assert shown.mean() > 0.8
    for steps in (2, 3, 6):
        mine = iterate(hills.points, hills.ways, ends, lambda w: (w - view.position) @ view.axes[2], steps)
        theirs = hills.query.iteration(hills.points, hills.ways, steps)
        way = np.linalg.norm(mine.a - hills.points, axis=1)
        # Where two steps are as good as one another, rounding decides which is kept.
        assert (np.abs(theirs.t - way) < 2e-3 * way)[shown].mean() > 0.98


def test_our_march_is_truer_than_the_iteration(hills: Looked) -> None:
    places = hills.query.march(hills.points, hills.ways, 12)
    march, known = hills.errors(places), (places.found == SOMETHING)[hills.met]
    errors = {n: hills.errors(hills.query.iteration(hills.points, hills.ways, n)) for n in (1, 3, 16)}
    assert np.median(errors[1]) > np.median(errors[3]) > np.median(errors[16])
    assert np.median(march) < 0.1 * np.median(errors[3]) and np.percentile(march, 90) < 0.02
    assert march.mean() < 0.1 * errors[3].mean()
    assert known.mean() > 0.95 and march[known].mean() < errors[16][known].mean()


def test_the_queries_agree_with_exact_triangles(hills: Looked) -> None:
    triangles = hills.surroundings.geometry.triangles[: hills.surroundings.triangle_count]
    corners = np.stack([triangles[f"corner_{k}"] for k in range(3)], axis=1)
    t = first_triangle(hills.points[:40], hills.ways[:40], corners)
    true = np.linalg.norm(hills.true[:40] - hills.points[:40], axis=1)
    assert np.allclose(t[hills.met[:40]], true[hills.met[:40]], rtol=1e-5)
    march = hills.query.march(hills.points, hills.ways, 32)
    way = np.linalg.norm(hills.true - hills.points, axis=1)[hills.met]
    assert np.median(np.abs(march.t[hills.met] - way) / way) < 2e-3


def test_a_march_passes_behind_what_stands_before(device: Device) -> None:
    """A ball hangs in the water: rays that go by behind it find the floor, or say that the picture does not show it."""
    ball = pl.Mesh.sphere(0.4, position=(0.0, -0.9, 1.0))
    looked = Looked(device, bottom("slope"), ball)
    places = looked.query.march(looked.points, looked.ways, 32)
    errors = np.linalg.norm(places.shown_ws - looked.true, axis=1)
    known = places.found == SOMETHING
    assert known.mean() > 0.85 and (errors[known & looked.met] > 0.15).mean() < 0.02
    assert (np.isin(places.found, (UNKNOWN, HIDDEN)) | known).all()
    assert (places.found == HIDDEN).any()


def test_places_and_points_are_inverse_to_each_other() -> None:
    for camera in (CAMERA, CAMERA.replace(orthographic_height_m=5.0)):
        view = view_of(camera, SIZE)
        uv, depth = (
            np.array([[0.2, 0.7], [0.9, 0.1]]),
            np.array([0.3, 0.9]) if view.is_orthographic else np.array([0.002, 0.001]),
        )
        clip = np.c_[unprojected(view, uv, depth), np.ones(2)] @ (view.projection @ view.view_from_world).T
        assert np.allclose(0.5 + clip[:, :2] / clip[:, 3:] * (0.5, -0.5), uv)
        assert np.allclose(clip[:, 2] / clip[:, 3], depth)


@pytest.fixture(scope="module")
def renderer(device: Device) -> Any:
    from pellucid.renderer import Renderer

    return Renderer(device)


def pond(height: float, technique: str, kind: str = "hills") -> pl.Scene:
    ball = pl.Mesh.sphere(0.5, position=(0.3, 0.2, 0.0), base_color=(0.8, 0.2, 0.1))
    waves = Sine(wavelength_m=2.0, amplitude_m=0.02, tile_m=8.0, shape=(64, 64))
    quality = WaterQuality(caustics="none", texture_size=256)
    water = pl.Water(extent_m=10.0, waves=waves, technique=technique, quality=quality)
    camera = pl.Camera((0.0, height, 4.5), (0.0, 0.2 * height, 0.0), fov_deg=50.0)
    return pl.Scene(camera=camera, environment=pl.Environment.studio(), objects=[bottom(kind), ball, water])


@pytest.mark.parametrize("height", [2.0, 0.01, -0.8])
def test_what_water_covers_is_not_drawn_and_no_pixel_shows_it(
    renderer: Any, height: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Bit for bit, from above, within the waves, and below."""
    frame = renderer.render(pond(height, "fast"), SIZE)
    box = renderer._techniques[pl.Water].hides(renderer.surroundings.view)
    assert (box is None) == (height < 0.02)
    monkeypatch.setattr(WaterTechnique, "hides", lambda self, view: None)
    whole = renderer.render(pond(height, "fast"), SIZE)
    assert np.array_equal(frame.radiance, whole.radiance) and np.array_equal(frame.depth, whole.depth)


def test_walls_at_the_border_cover_the_water_from_outside(renderer: Any) -> None:
    """A red wall in the very plane where the water ends, seen from beyond it: no pixel shows what is behind it."""
    red: dict[str, Any] = {"base_color": (1.0, 0.0, 0.0), "specular": 0.0, "roughness": 1.0}
    wall = pl.Mesh.plane((2.0, 2.0), position=(0.0, -1.0, 0.7), rotation=(90.0, 0.0, 0.0), **red)
    floor = pl.Mesh.plane(1.4, position=(0.0, -1.4, 0.0), base_color=(0.0, 0.9, 0.0))
    camera = pl.Camera((0.37, 1.2, 3.0), (0.1, -0.8, 0.7), fov_deg=22.0)
    scene = pl.Scene(camera, pl.Environment.constant(1.0), [], [floor, wall, pl.Water(extent_m=(1.9, 1.4))])
    radiance = renderer.render(scene, SIZE).radiance
    assert (radiance[..., 0] > 10.0 * radiance[..., 1]).all()


@pytest.mark.parametrize(("height", "kind"), [(2.0, "hills"), (-0.8, "hills"), (2.0, "level"), (-0.001, "level")])
def test_pictures_show_what_rays_see(renderer: Any, height: float, kind: str) -> None:
    """The whole image, where pictures stand for rays: "fast" is "best" but for a few pixels.

    On a level bottom all rays end just where meshes do. A camera in the level sees no point of it, but waves.
    """
    scenes = [pond(height, technique, kind) for technique in ("best", "fast")]
    *rest, water = scenes[1].objects
    whole = water.replace(quality=water.quality.replace(shading_rate=1))
    best, fast = (
        renderer.render(scene, SIZE).radiance for scene in (scenes[0], scenes[1].replace(objects=[*rest, whole]))
    )
    error = np.abs(fast - best).max(axis=-1) / best.mean()
    assert np.median(error) < 0.005 and (error > 0.1).mean() < 0.03


def test_glow_adds_light_round_mirrored_lamps_alone(renderer: Any) -> None:
    scene = pond(2.0, "fast").replace(lights=[pl.DirectionalLight((0.0, -0.5, 1.0), irradiance=2.0)])
    water = scene.objects[-1]
    glowing = water.replace(quality=water.quality.replace(glow=1.0))
    size = (96, 72)
    plain = renderer.render(scene, size).radiance
    added = renderer.render(scene.replace(objects=[*scene.objects[:-1], glowing]), size).radiance - plain
    assert added.min() >= -1e-4 and added.max() > 0.05
    assert np.allclose(added[..., 2], 0.8 * added[..., 0], atol=1e-3)
    assert np.abs(added[:8]).max() < 1e-3
    columns = added[..., 0].sum(axis=0)
    assert abs((columns * np.arange(size[0])).sum() / columns.sum() - 0.5 * (size[0] - 1)) < 6


def test_a_sun_that_is_kept_apart_lights_as_one_that_is_not(renderer: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    def pictures() -> list[np.ndarray]:
        waves = Sine(amplitude_m=0.03, wavelength_m=1.5)
        lake = pl.Water(extent_m=24.0, medium="coastal", waves=waves, technique="fast")
        meshes = [bottom("hills"), pl.Mesh.sphere(0.6, position=(0.4, -0.7, 1.0), roughness=0.3)]
        sun = pl.DirectionalLight((-1.0, -2.0, -0.5))
        scene = pl.Scene(camera=CAMERA, environment=pl.Environment.sky(), lights=[sun], objects=[*meshes, lake])
        return [renderer.render(scene, SIZE, time=time).radiance for time in (0.3, 0.4, 0.5)]

    apart = pictures()
    monkeypatch.setattr(Surroundings, "sun_may_be_apart", False)
    for one, other in zip(apart, pictures(), strict=True):
        assert np.abs(one - other).mean() < 2e-3 * other.mean()
    assert np.abs(apart[0] - apart[2]).mean() > 1e-2 * apart[0].mean()


def test_what_shines_by_itself_is_no_less_under_waves(renderer: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """A ball that glows, in the dark: waves that stand over it take nothing from what leaves it, only on its way."""
    ball = pl.Mesh.sphere(0.6, position=(0.4, -0.7, 1.0), base_color=(0, 0, 0), specular=0.0, emission=(1.0, 2.0, 3.0))
    waves = Sine(amplitude_m=0.03, wavelength_m=1.5)
    pond = pl.Water(extent_m=24.0, medium="coastal", waves=waves, technique="fast")
    sun = pl.DirectionalLight((-1.0, -2.0, -0.5), irradiance=0.0)
    dark = pl.Environment.constant(0.0)
    scene = pl.Scene(camera=CAMERA, environment=dark, lights=[sun], objects=[bottom("level"), ball, pond])
    apart = renderer.render(scene, SIZE, time=0.3).radiance
    monkeypatch.setattr(Surroundings, "sun_may_be_apart", False)
    renderer.render(scene, SIZE, time=0.4)  # what is kept goes
    whole = renderer.render(scene, SIZE, time=0.3).radiance
    assert whole.max() > 0.5
    np.testing.assert_allclose(apart, whole, rtol=2e-3, atol=1e-4)  # half floats


def test_pictures_stay_while_only_waves_move(renderer: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """The steepest slope of the moment would move the cameras: here it crosses a step between the frames."""
    waves = pl.waves.Ocean(3.0, tile_m=12.0, shape=(64, 64), fetch_m=500.0, seed=2)
    lake = pl.Water(extent_m=24.0, medium="coastal", waves=waves, technique="fast")
    slopes = [wave_maps(lake, surfaces_of(waves, time)).slope for time in (0.0, 0.3, 0.6)]
    assert len({np.ceil(4.0 * np.log2(slope)) for slope in slopes}) > 1
    ball = pl.Mesh.sphere(0.6, position=(0.4, 0.1, 1.0))
    sun = pl.DirectionalLight((-1.0, -2.0, -0.5))
    scene = pl.Scene(CAMERA, pl.Environment.sky(), [sun], [bottom("hills"), ball, lake])
    drawn: list[str] = []
    run = RenderPass.run

    def counted(self: RenderPass, *given: Any, label: str = "", **named: Any) -> None:
        drawn.append(label)
        run(self, *given, label=label, **named)

    monkeypatch.setattr(RenderPass, "run", counted)
    renderer.render(scene, SIZE, time=0.0)
    assert {"water picture above visibility", "water picture below shading"} <= set(drawn)
    drawn.clear()
    for time in (0.3, 0.6):
        renderer.render(scene, SIZE, time=time)
    assert "water shade" in drawn and "water picture below sun" in drawn
    pictures = {label for label in drawn if label.startswith("water picture")}
    assert pictures <= {"water picture below sun", "water picture below sky"}
