"""What water promises besides optics: nothing compiled anew, several bodies, sensible pictures of odd input."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields.waves import Ripples
from pellucid.surroundings.submersion import refracted_slope
from water_scenes import Still, rays, sines

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.renderer import Renderer

SIZE = (48, 36)
CAMERA = pl.Camera(position=(0, 1.0, 2.5), target=(0, -0.2, 0), fov_deg=55, near_m=0.01)
FLOOR = pl.Mesh.checkerboard(8.0, squares=16, position=(0, -1.2, 0))
SUN = pl.DirectionalLight(direction=(0.6, -0.7, 0.4))


@pytest.fixture(scope="module")
def renderer(device: Device) -> Renderer:
    from pellucid.renderer import Renderer

    return Renderer(device)


def scene(*waters: pl.Water, camera: pl.Camera = CAMERA, **parts: Any) -> pl.Scene:
    given = {"environment": pl.Environment.sky(sun_disc=False), "lights": [SUN], "objects": [FLOOR, *waters]}
    return pl.Scene(camera=camera, **(given | parts))


def test_nothing_that_moves_compiles(device: Device, renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    ripples = Ripples((48, 48), 0.1, limit_m=0.1)
    ripples.drop(0.2, 0.3, 0.4, 0.1)
    water = pl.Water(extent_m=4.8, waves=ripples, medium="clear lake")
    renderer.render(scene(water), size=SIZE)
    for maker in ("create_shader_module", "create_compute_pipeline", "create_render_pipeline"):
        monkeypatch.setattr(device.wgpu, maker, lambda **_: pytest.fail("compiled again"))
    renderer.render(scene(water), size=SIZE, time=0.4)
    renderer.render(scene(water, camera=CAMERA.replace(position=(0.3, -0.5, 2.0))), size=SIZE, time=0.4)
    other = water.replace(medium="pond", level=0.1, center=(0.2, 0.1), extent_m=(3.0, 2.0))
    renderer.render(scene(other, lights=[SUN.replace(direction=(0.1, -1, 0.2), irradiance=2.0)]), size=SIZE, time=0.1)


def test_waves_move_with_time_and_with_what_falls_in(renderer: Renderer) -> None:
    ripples = Ripples((48, 48), 0.1, limit_m=0.1)
    water = pl.Water(extent_m=4.8, waves=ripples)
    still = renderer.render(scene(water), size=SIZE).radiance
    water.drop(0.2, 0.3, 0.4, 0.1)
    dented = renderer.render(scene(water), size=SIZE).radiance
    assert (dented != still).any()
    later = renderer.render(scene(water), size=SIZE, time=0.5).radiance
    assert (later != dented).any()
    assert (renderer.render(scene(water), size=SIZE).radiance == dented).all()  # the same time, the same bits
    with pytest.raises(pl.SceneError, match="waves"):
        pl.Water().drop(0, 0, 0.1, 0.1)
    with pytest.raises(pl.SceneError, match=r"drop\.x_m"):
        pl.Water().drop("here", 0, 0.1, 0.1)  # type: ignore[arg-type]


def test_water_rarer_than_what_is_above_it_has_finite_light() -> None:
    with np.errstate(all="raise"):
        assert np.isfinite(refracted_slope(np.array([0.8, 0.6, 0.0]), 0.5)).all()
        assert refracted_slope(np.array([0.6, 0.8, 0.0]), 1.0)[0] == pytest.approx(0.75)


def test_a_drop_falls_where_the_world_says() -> None:
    ripples = Ripples((48, 48), 0.1)
    assert pl.Water(center=(5.0, 2.0), waves=ripples).drop(5.5, 1.5, 0.2, 0.1).x_m == pytest.approx(0.5)


def test_what_stands_out_of_the_water_is_cut_at_its_surface(renderer: Renderer) -> None:
    post = pl.Mesh.box((0.4, 2.0, 0.4), base_color=(0.9, 0.1, 0.1))
    frame = renderer.render(scene(pl.Water(extent_m=8.0), objects=[FLOOR, post, pl.Water(extent_m=8.0)]), size=SIZE)
    dry = renderer.render(scene(objects=[FLOOR, post]), size=SIZE)
    _, ways, cosine = rays(CAMERA, SIZE)
    ground = (-1.0 / ways[:, 1]).reshape(36, 48)
    first = np.where(ground > 0, np.minimum(ground * cosine.reshape(36, 48), dry.depth), dry.depth)
    wet = np.isclose(frame.depth, first, rtol=1e-3) & np.isfinite(first)
    sky = ~np.isfinite(dry.depth)
    assert (wet | sky).mean() > 0.995
    above = (dry.depth < ground * cosine.reshape(36, 48)) & (ground > 0)
    assert above.sum() > 50 and np.array_equal(frame.radiance[above], dry.radiance[above])


def test_only_folded_crests_foam(renderer: Renderer) -> None:
    sea = pl.waves.Ocean(wind_m_s=14.0, tile_m=60.0, shape=(64, 64), seed=5)
    dark = pl.Environment.constant((0.0, 0.0, 0.0))
    above = CAMERA.replace(position=(0, 40.0, 0), target=(0, 0, 0), up=(0, 0, -1), far_m=1e3)
    flat, foamy = (
        renderer.render(
            scene(camera=above, environment=dark, objects=[pl.Water(extent_m=60.0, waves=sea, foam=foam)]), size=SIZE
        )
        for foam in (0.0, 0.9)
    )
    white = np.abs(foamy.radiance - flat.radiance).max(axis=2) > 0.05
    assert 0.0 < white.mean() < 0.3
    calm = pl.Water(extent_m=60.0, waves=sines(0.02), foam=0.9)
    plain = [renderer.render(scene(w, camera=above), size=SIZE).radiance for w in (calm, calm.replace(foam=0.0))]
    assert plain[0] == pytest.approx(plain[1], rel=1e-5)


def test_waters_side_by_side_are_each_as_if_alone(renderer: Renderer) -> None:
    left = pl.Water(extent_m=1.5, center=(-1.0, 0.0), medium="pond")
    right = pl.Water(extent_m=1.5, center=(1.0, 0.0), waves=Still(sines(0.03).heights, (1.5, 1.5)))
    both = renderer.render(scene(left, right, objects=[left, right]), size=SIZE)
    alone = [renderer.render(scene(objects=[water]), size=SIZE) for water in (left, right)]
    half = SIZE[0] // 2 - 2
    assert both.radiance[:, :half] == pytest.approx(alone[0].radiance[:, :half], rel=1e-3)
    assert both.depth[:, -half:] == pytest.approx(alone[1].depth[:, -half:], rel=1e-6)


@pytest.mark.parametrize(
    "water",
    [
        pl.Water(level=-3.0),
        pl.Water(level=5.0, extent_m=30.0),
        pl.Water(level=1.0),
        pl.Water(extent_m=1e6),
        pl.Water(extent_m=1e6, level=2.0, waves=sines(0.2)),
        pl.Water(extent_m=1e-3),
        pl.Water(extent_m=8.0, waves=sines(2.0)),
        pl.Water(extent_m=8.0, waves=sines(0.05), medium=1.0, foam=1.0),
        pl.Water(extent_m=8.0, medium=0.9),
        pl.Water(extent_m=8.0, medium="ink"),
    ],
    ids=["below all", "above all", "in the camera", "huge", "huge waves", "tiny", "steep", "foam", "thin", "ink"],
)
def test_odd_water_makes_a_picture(water: pl.Water, renderer: Renderer) -> None:
    frame = renderer.render(scene(water), size=SIZE)
    assert np.isfinite(frame.radiance).all() and (frame.radiance >= 0.0).all()
    assert (frame.depth > 0.0).all()


def test_water_below_all_changes_nothing_that_is_before_it(renderer: Renderer) -> None:
    dry, wet = (renderer.render(scene(*waters), size=SIZE) for waters in ((), (pl.Water(level=-3.0),)))
    floor = np.isfinite(dry.depth)
    assert floor.sum() > 100 and np.array_equal(dry.radiance[floor], wet.radiance[floor])


@pytest.mark.parametrize(
    ("fields", "where"),
    [
        ({"level": np.nan}, "water.level"),
        ({"extent_m": 0.0}, "water.extent_m"),
        ({"extent_m": (3.0, -1.0)}, "water.extent_m"),
        ({"extent_m": (1.0, np.inf)}, "water.extent_m"),
        ({"extent_m": "wide"}, "water.extent_m"),
        ({"center": (0.0, 0.0, 0.0)}, "water.center"),
        ({"center": (0.0, np.nan)}, "water.center"),
        ({"waves": 3.0}, "water.waves"),
        ({"waves": Ripples}, "water.waves"),
        ({"medium": "watr"}, "water.medium"),
        ({"medium": None}, "water.medium"),
        ({"ambient_n": 0.0}, "water.ambient_n"),
        ({"technique": "slow"}, "water.technique"),
        ({"quality": "best"}, "water.quality"),
        ({"foam": 1.5}, "water.foam"),
        ({"color": (0.1, 0.2)}, "water.color"),
        ({"clarity_per_m": -1.0}, "water.clarity_per_m"),
        ({"dispersion": 1}, "water.dispersion"),
    ],
)
def test_what_cannot_be_is_named(fields: dict[str, Any], where: str) -> None:
    with pytest.raises(pl.SceneError) as error:
        pl.Water(**fields)
    assert error.value.field.startswith(where)


@pytest.mark.parametrize(
    ("fields", "where"),
    [
        ({"refraction": "ray"}, "refraction"),
        ({"steps": 0}, "steps"),
        ({"texture_size": 512.0}, "texture_size"),
        ({"field_of_view": 0.5}, "field_of_view"),
        ({"point_distance_m": 0.0}, "point_distance_m"),
        ({"schlick_power": np.nan}, "schlick_power"),
        ({"shadows": "yes"}, "shadows"),
    ],
)
def test_a_quality_that_cannot_be_is_named(fields: dict[str, Any], where: str) -> None:
    with pytest.raises(pl.SceneError) as error:
        pl.WaterQuality(**fields)
    assert error.value.field == f"water_quality.{where}"


def test_techniques_choose_what_quality_leaves_open() -> None:
    from pellucid.scene.water_quality import TECHNIQUES, quality_of

    assert all(quality_of(t, pl.WaterQuality()) == pl.WaterQuality.of(t) for t in TECHNIQUES)
    named = [pl.WaterQuality.of(t) for t in TECHNIQUES]
    assert all(quality_of(t, quality) == quality for t in TECHNIQUES for quality in named)
    assert quality_of("mihalik", pl.WaterQuality(reflection="environment")).reflection == "environment"
    exact = pl.WaterQuality.of("mihalik", fresnel="exact")
    assert exact.fresnel == "exact" and quality_of("best", exact) == exact
    with pytest.raises(pl.SceneError, match="technique"):
        pl.WaterQuality.of("slow")


def test_waves_that_are_not_finite_are_refused(renderer: Renderer) -> None:
    broken = sines(0.1)
    broken.heights[3, 4] = np.nan
    with pytest.raises(pl.SceneError, match="waves"):
        renderer.render(scene(pl.Water(waves=broken)), size=SIZE)
