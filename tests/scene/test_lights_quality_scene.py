"""Lights, quality and the scene as a whole: what they accept and how they refuse."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.scene import AreaLight, Camera, DirectionalLight, Environment, Mesh, PointLight, Quality, Scene

CAMERA = Camera(position=(0, 0, 1))


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: DirectionalLight(direction=(0, 0, 0)), "directional_light.direction"),
        (lambda: DirectionalLight(direction=(0, 1, 0), irradiance=-1), "directional_light.irradiance"),
        (lambda: DirectionalLight(direction=(0, 1, 0), color=(1, -1, 0)), "directional_light.color[1]"),
        (lambda: DirectionalLight(direction=(0, 1, 0), cast_shadow=1), "directional_light.cast_shadow"),
        (lambda: DirectionalLight(direction=(0, float("nan"), 0)), "directional_light.direction[1]"),
        (lambda: PointLight(position=(0, 0, 0), intensity=float("inf")), "point_light.intensity"),
        (lambda: PointLight(position=(0, 0)), "point_light.position"),
        (lambda: AreaLight((0, 0, 0), (1, 0, 0), (2, 0, 0)), "area_light.edge_v"),
        (lambda: AreaLight((0, 0, 0), (0, 0, 0), (2, 0, 0)), "area_light.edge_u"),
        (lambda: AreaLight((0, 0, 0), (1, 0, 0), (0, 1, 0), radiance=-2), "area_light.radiance"),
        (lambda: Quality(method="rk4"), "quality.method"),
        (lambda: Quality(step_voxels=0), "quality.step_voxels"),
        (lambda: Quality(max_steps=0), "quality.max_steps"),
        (lambda: Quality(max_steps=1.5), "quality.max_steps"),
        (lambda: Quality(bounces=-1), "quality.bounces"),
        (lambda: Quality(min_weight=1.0), "quality.min_weight"),
        (lambda: Quality(adaptive="yes"), "quality.adaptive"),
        (lambda: Scene(camera=None), "scene.camera"),
        (lambda: Scene(CAMERA, environment="sky"), "scene.environment"),
        (lambda: Scene(CAMERA, exposure=0), "scene.exposure"),
        (lambda: Scene(CAMERA, tone_mapping="filmic"), "scene.tone_mapping"),
        (lambda: Scene(CAMERA, lights=[Mesh.plane()]), "scene.lights[0]"),
        (lambda: Scene(CAMERA, objects=Mesh.plane()), "scene.objects"),
        (lambda: Scene(CAMERA, objects=[Mesh.plane(), np.zeros(3)]), "scene.objects[1]"),
    ],
)
def test_each_fault_names_its_field(make, field: str) -> None:
    with pytest.raises(SceneError) as caught:
        make()
    assert caught.value.field == field


def test_a_scene_is_a_value_with_a_studio_around_it() -> None:
    scene = Scene(CAMERA, lights=[PointLight((0, 1, 0))], objects=[Mesh.plane()])
    assert isinstance(scene.lights, tuple) and isinstance(scene.objects, tuple)
    assert scene.environment.kind == "studio"
    brighter = scene.replace(exposure=2.0)
    assert brighter.objects[0] is scene.objects[0] and scene.exposure == 1.0
    # what did not change keeps its identity, so nothing is uploaded again
    assert scene.environment.pixels is Scene(CAMERA).environment.pixels


def test_the_sun_light_belongs_to_the_sky() -> None:
    light = DirectionalLight.sun(elevation_deg=30.0, azimuth_deg=90.0, turbidity=3.0)
    assert light.direction == pytest.approx((-np.cos(np.pi / 6), -0.5, 0.0), abs=1e-12)
    with_disc = Environment.sky(30.0, 90.0, 3.0)
    without = Environment.sky(30.0, 90.0, 3.0, sun_disc=False)
    weights = _solid_angles(with_disc.pixels)
    disc = ((with_disc.pixels.astype(float) - without.pixels) * weights).sum((0, 1))
    assert disc == pytest.approx(np.array(light.color) * light.irradiance, rel=1e-5)


def _solid_angles(pixels: np.ndarray) -> np.ndarray:
    """Exact solid angle of each pixel, worked out here from the convention alone: (H, 1, 1)."""
    height, width = pixels.shape[:2]
    edges = np.cos(np.linspace(0.0, np.pi, height + 1))
    return (-np.diff(edges) * 2.0 * np.pi / width)[:, None, None]
