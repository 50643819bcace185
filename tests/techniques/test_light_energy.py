"""Where the flux goes: what enters a volume is absorbed, leaves, or is given up and counted. And what cannot be lit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import pellucid as pl
from pellucid.fields import shapes

CAMERA = pl.Camera(position=(0, 0.1, 0.5))
LAMP = pl.DirectionalLight((0.4, -1.0, 0.2), color=(1.0, 0.9, 0.8), irradiance=2.0)
AMBER = (2.0, 12.0, 60.0)
SIZES = [
    32,
    pytest.param(64, marks=pytest.mark.slow),
    pytest.param(128, marks=pytest.mark.slow),
    pytest.param(192, marks=pytest.mark.slow),
]


def lit(volume: pl.RefractiveVolume, *lights: Any) -> Any:
    return pl.illuminate(pl.Scene(camera=CAMERA, lights=list(lights or (LAMP,)), objects=[volume]), volume)


def ball(count: int) -> pl.RefractiveVolume:
    return pl.RefractiveVolume.from_sdf(shapes.sphere(0.04), pl.media.resolve(1.5).with_absorption(AMBER), count, 0.1)


def cube(count: int) -> pl.RefractiveVolume:
    body = shapes.rotated(shapes.box(0.05), Rotation.from_euler("xyz", (20, 30, 10), degrees=True).as_matrix())
    return pl.RefractiveVolume.from_sdf(body, pl.media.resolve(1.5).with_absorption(AMBER), count, 0.1)


def wine_glass(count: int) -> pl.RefractiveVolume:
    glass, wine = shapes.wine_glass(0.1, wall_m=0.003)
    bodies = [(glass, 1.52), (wine, pl.media.resolve(1.34).with_absorption((5.0, 90.0, 120.0)))]
    return pl.RefractiveVolume.from_regions(bodies, count, (0.06, 0.11, 0.06))


def assert_energy_closes(light: Any, given_up: float) -> None:
    found = light.flux_absorbed + light.flux_out + light.flux_ended
    assert found == pytest.approx(light.flux_in, rel=5e-3)
    assert (np.abs(light.flux_ended) < given_up * light.flux_in).all()
    assert (light.flux_absorbed > 0.0).all() and (light.flux_out > 0.0).all()
    assert np.isfinite(light.fluence).all() and light.fluence.min() >= 0.0


@pytest.mark.parametrize("count", SIZES)
@pytest.mark.parametrize(("body", "given_up"), [(ball, 0.02), (cube, 0.02), (wine_glass, 0.08)])
def test_what_enters_is_absorbed_or_leaves(body: Any, given_up: float, count: int) -> None:
    """The walls of a wine glass guide light along: much of it is still inside after eight crossings."""
    assert_energy_closes(lit(body(count)), given_up)


@pytest.mark.parametrize("count", SIZES)
def test_what_enters_a_bunny_is_absorbed_or_leaves(count: int, shared_data: Path) -> None:
    glass = pl.media.resolve(1.5).with_absorption(AMBER)
    bunny = pl.RefractiveVolume.from_mesh(shared_data / "bunny.ply", glass, count)
    lamp = pl.DirectionalLight((0.4, -1.0, 0.2), irradiance=2.0)
    assert_energy_closes(lit(bunny, lamp), given_up=0.02)


def test_light_that_meets_opaque_voxels_is_absorbed() -> None:
    opaque = np.zeros((16, 16, 16, 4), np.float32)
    opaque[4:12, 4:12, 4:12] = 1.0
    light = lit(
        pl.RefractiveVolume.from_array(np.ones((16, 16, 16)), 0.1, opaque=opaque),
        pl.DirectionalLight((0, 0, -1), irradiance=2.0),
    )
    assert light.flux_absorbed == pytest.approx(0.25 * light.flux_in, rel=0.02)
    assert light.fluence[2, 5:11, 5:11].max() < 0.02 and light.fluence[14, 5:11, 5:11] == pytest.approx(2.0, rel=0.02)


def test_light_inside_an_opaque_voxel_ends_there() -> None:
    opaque = np.ones((8, 8, 8, 4), np.float32)
    try:
        light = lit(pl.RefractiveVolume.from_array(np.ones((8, 8, 8)), 0.1, opaque=opaque), pl.PointLight((0, 0, 0)))
    except pl.SceneError as error:
        assert "opaque" in str(error)
    else:
        assert light.flux_out == pytest.approx(np.zeros(3), abs=1e-3 * light.flux_in.max())


@pytest.mark.parametrize(
    "make",
    [
        lambda: pl.Volume.from_array(np.ones((8, 8, 8)), 0.0),
        lambda: pl.Volume.from_array(np.ones((0, 8, 8)), 0.1),
        lambda: pl.Volume.from_array(np.ones((8, 8, 8)), 0.1, absorption=np.full((8, 8, 8, 3), -1.0)),
        lambda: pl.Volume.from_array(np.ones((8, 8, 8)), 0.1, scattering=np.full((8, 8, 8, 3), -1.0)),
        lambda: pl.Volume.from_array(np.ones((8, 8, 8)), 0.1, anisotropy=np.full((8, 8, 8), 1.0)),
        lambda: pl.Volume.from_array(np.ones((8, 8, 8)), 0.1, anisotropy=np.full((8, 8, 8), np.nan)),
        lambda: pl.Region(np.ones((8, 8, 8)), 1.5, scattering=(-1.0, 0.0, 0.0)),
        lambda: pl.Region(np.ones((8, 8, 8)), 1.5, anisotropy=-1.0),
        lambda: pl.DirectionalLight((0, 0, 0)),
        lambda: pl.DirectionalLight((np.nan, 0, 1)),
        lambda: pl.PointLight((np.inf, 0, 0)),
        lambda: pl.PointLight((0, 0, 0), intensity=np.inf),
        lambda: pl.LightQuality(front_voxels=0.0),
        lambda: pl.LightQuality(method="photons"),
    ],
)
def test_what_cannot_be_is_refused(make: Any) -> None:
    with pytest.raises(pl.SceneError) as caught:
        make()
    assert caught.value.field


def test_a_volume_that_is_not_in_the_scene_is_refused_or_lit_alone() -> None:
    placed = ball(16)
    with pytest.raises(pl.SceneError):
        pl.illuminate(pl.Scene(camera=CAMERA, lights=[LAMP], objects=[]), placed)


def test_no_light_is_no_light() -> None:
    placed = ball(16)
    light = pl.illuminate(pl.Scene(camera=CAMERA, lights=[], objects=[placed]), placed)
    assert light.fluence.max() == 0.0 and light.flux_in.max() == 0.0


def test_a_lamp_very_far_away_lights_evenly() -> None:
    light = lit(
        pl.RefractiveVolume.from_array(np.ones((12, 12, 12)), 0.1),
        pl.PointLight((0.0, 0.0, 1e5), intensity=2e10),
    )
    assert light.fluence == pytest.approx(2.0, rel=0.03)


def test_a_lamp_on_a_face_of_the_box_ends() -> None:
    volume = pl.RefractiveVolume.from_array(np.ones((8, 8, 8)), 0.1)
    light = lit(volume, pl.PointLight((0.0, 0.0, 0.05), intensity=0.1))
    assert np.isfinite(light.fluence).all()
    assert light.flux_out + light.flux_ended == pytest.approx(light.flux_in, rel=5e-3)


@pytest.mark.slow
def test_a_maze_of_surfaces_has_an_end() -> None:
    """Noise in every voxel: patches tear everywhere, and lists run full. What is lost is counted."""
    rng = np.random.default_rng(1)
    noise = rng.uniform(-1.0, 1.0, (24, 24, 24)).astype(np.float32) * 0.004
    body = pl.Region(noise, pl.media.resolve(2.4).with_absorption((1, 1, 1)))
    placed = pl.RefractiveVolume(pl.Volume((0.1,) * 3, regions=(body,)))
    light = lit(placed)
    assert light.flux_absorbed + light.flux_out + light.flux_ended == pytest.approx(light.flux_in, rel=5e-3)
