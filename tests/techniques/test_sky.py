"""The background is the environment, exactly where nothing was drawn."""

from __future__ import annotations

import numpy as np

from pellucid.scene import Camera, Environment, Mesh, Scene

SIZE = (90, 60)


def test_background_is_the_environment_along_each_pixel_ray(draw) -> None:
    studio = Environment.studio(rotation_deg=40.0)
    camera = Camera((0, 0, 0), (1, 0.3, 0.8), fov_deg=20.0)
    radiance, depth, _ = draw(Scene(camera=camera, environment=studio), SIZE)
    _, directions = camera.pixel_rays(SIZE)
    assert (depth == 0).all()
    # The map is read between levels when a pixel is wider than a texel; here it is not.
    np.testing.assert_allclose(radiance, studio.radiance(directions), rtol=1e-3, atol=2e-3)


def test_parallel_rays_see_one_direction(draw) -> None:
    studio = Environment.studio()
    camera = Camera((0, 0, 0), (-0.6, 0.7, 0.2), orthographic_height_m=3.0)
    radiance, _, _ = draw(Scene(camera=camera, environment=studio), SIZE)
    np.testing.assert_allclose(radiance, np.broadcast_to(radiance[0, 0], radiance.shape), rtol=1e-6)
    np.testing.assert_allclose(radiance[0, 0], studio.radiance(camera.pixel_rays((1, 1))[1])[0, 0], rtol=1e-3)


def test_meshes_are_not_painted_over(draw) -> None:
    ball = Mesh.sphere(0.5, base_color=(0, 0, 0), emission=(0, 3, 0), specular=0.0)
    scene = Scene(camera=Camera((0, 0, 3)), environment=Environment.constant((1.0, 0.0, 0.0)), objects=[ball])
    radiance, depth, _ = draw(scene, SIZE)
    np.testing.assert_array_equal(radiance[..., 1] == 3, depth > 0)
    np.testing.assert_allclose(radiance[depth == 0], [[1, 0, 0]] * int((depth == 0).sum()), rtol=1e-6)
