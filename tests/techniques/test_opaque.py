"""A drawn picture is what rays through its pixel centres see, shadows included."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from pellucid.scene import AreaLight, Camera, DirectionalLight, Environment, Mesh, PointLight, Scene
from pellucid.surroundings import Query

if TYPE_CHECKING:
    from pellucid.gpu import Device

SIZE = (160, 120)
PERSPECTIVE = Camera((0.6, 1.1, 2.6), (0.0, 0.3, 0.0), fov_deg=45.0)
PARALLEL = PERSPECTIVE.replace(orthographic_height_m=2.4)


def still_life(camera: Camera, **changes: object) -> Scene:
    checker = (np.indices((256, 256)) // 32).sum(0)[..., None] % 2 * np.ones(3)
    objects = [
        Mesh.plane(4.0, base_color_map=checker.astype(np.float32)),
        Mesh.sphere(0.5, position=(-0.4, 0.5, 0.0), base_color=(0.8, 0.2, 0.1), roughness=0.3),
        Mesh.box(0.6, position=(0.6, 0.3, 0.2), rotation=(0, 30, 0), specular=0.5, double_sided=False),
    ]
    lights = [
        DirectionalLight((-1, -2, -1)),
        PointLight((0.5, 1.5, 1.5), intensity=0.7),
        AreaLight((-1, 2, 1), (0.5, 0, 0), (0, 0, 0.5), radiance=2.0),
    ]
    return Scene(camera=camera, environment=Environment.studio(), lights=lights, objects=objects).replace(**changes)


@pytest.mark.parametrize("camera", [PERSPECTIVE, PARALLEL], ids=["perspective", "parallel"])
@pytest.mark.parametrize("jitter", [(0.0, 0.0), (0.31, -0.22)])
def test_picture_and_depth_equal_rays(draw, camera: Camera, jitter: tuple[float, float]) -> None:
    radiance, depth, query = draw(still_life(camera), SIZE, jitter)
    origins, directions = (a.reshape(-1, 3) for a in query.camera_rays())
    hits = query.hits(origins, directions)
    seen = query.radiance(origins, directions).reshape(radiance.shape)
    expected_depth = np.where(hits["valid"] != 0, hits["value"][:, 2], 0.0).reshape(depth.shape)
    # A pixel centre within rounding of a silhouette may fall on either side: a handful of 19,200.
    outline = ~np.isclose(depth, expected_depth, rtol=2e-5, atol=1e-7)
    assert outline.sum() <= 8
    different = ~np.isclose(radiance, seen, rtol=2e-3, atol=1e-4).all(axis=-1)
    assert (different & ~outline).sum() <= 0.002 * depth.size


def test_what_is_right_in_the_world_is_right_in_the_picture(draw) -> None:
    """Looking along -Z: +X to the right, +Y up."""
    marks = [
        Mesh.sphere(0.2, position=(1, 0, 0), base_color=(0, 0, 0), emission=(1, 0, 0), specular=0.0),
        Mesh.sphere(0.2, position=(0, 1, 0), base_color=(0, 0, 0), emission=(0, 1, 0), specular=0.0),
    ]
    scene = Scene(camera=Camera((0, 0, 4)), environment=Environment.constant(0.0), objects=marks)
    radiance, depth, _ = draw(scene, (101, 101))
    rows, columns = np.indices(depth.shape)
    red, green = radiance[..., 0] == 1, radiance[..., 1] == 1
    assert red.sum() > 20 and green.sum() > 20
    assert columns[red].min() > 60 and abs(rows[red].mean() - 50) < 1
    assert rows[green].max() < 40 and abs(columns[green].mean() - 50) < 1


def test_neighbouring_triangles_leave_no_cracks(draw) -> None:
    ball = Mesh.sphere(1.0, base_color=(0, 0, 0), emission=(1, 1, 1), specular=0.0)
    camera = Camera((0.3, 0.2, 1.9), fov_deg=30.0, near_m=0.1)
    scene = Scene(camera=camera, environment=Environment.constant(0.0), objects=[ball])
    radiance, _, _ = draw(scene, (400, 400))
    assert (radiance == 1.0).all()


def test_shadow_maps_agree_with_shadow_rays(draw) -> None:
    """Lit or not, away from the filtered edge of a shadow, is what a ray to the light says."""
    light = DirectionalLight((-1, -1.3, -0.7), irradiance=np.pi)
    scene = still_life(PERSPECTIVE, lights=[light], environment=Environment.constant(0.0))
    matt = [m.replace(base_color=(1, 1, 1), base_color_map=None, specular=0.0) for m in scene.objects]
    radiance, _, query = draw(scene.replace(objects=matt), SIZE)
    origins, directions = (a.reshape(-1, 3) for a in query.camera_rays())
    hits = query.hits(origins, directions)
    valid = hits["valid"] != 0
    points = (origins + directions * hits["t"][:, None])[valid]
    towards = np.array([1, 1.3, 0.7]) / np.linalg.norm([1, 1.3, 0.7])
    dark, clear_cut = _shadowed(query, points, towards)
    lit = radiance.reshape(-1, 3)[valid, 0] > 1e-6
    assert dark.mean() > 0.1 and lit.mean() > 0.4 and clear_cut.mean() > 0.9
    assert (lit == ~dark)[clear_cut].mean() > 0.999


def _shadowed(query: Query, points: np.ndarray, towards: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Blocked on the way to the light; and whether ways that lean by 0.02 rad to all sides say the same."""
    aside = np.cross(towards, [0.0, 1.0, 0.0])
    across = np.cross(towards, aside)

    def blocked(lean: np.ndarray) -> np.ndarray:
        way = np.broadcast_to(towards + lean, points.shape)
        return query.hits(points + 1e-4 * way, way)["blocked"] != 0

    centre = blocked(np.zeros(3))
    around = [blocked(0.02 * lean) for lean in (aside, -aside, across, -across)]
    return centre, np.all([a == centre for a in around], axis=0)


def test_a_lit_surface_has_no_acne_at_any_angle(draw) -> None:
    """A tilted card alone in slanted light: every pixel of it has one radiance."""
    for angle in (0.0, 30.0, 60.0, 80.0, 88.0):
        card = Mesh.box(1.0, rotation=(10, 15, angle), base_color=(1, 1, 1), specular=0.0)
        light = DirectionalLight((0, -1, 0), irradiance=np.pi)
        scene = Scene(
            camera=Camera((0, 3, 0.5), fov_deg=30.0),
            environment=Environment.constant(0.0),
            lights=[light],
            objects=[card],
        )
        radiance, _, query = draw(scene, SIZE)
        origins, directions = (a.reshape(-1, 3) for a in query.camera_rays())
        hits = query.hits(origins, directions)
        levels = radiance.reshape(-1, 3)[hits["valid"] != 0, 0]
        faces = [n @ [0, 1, 0] for n in _box_normals(card)]
        nearest = np.min([np.abs(levels - max(c, 0.0)) for c in faces], axis=0)
        assert (nearest < 2e-3).mean() > 0.995


def _box_normals(mesh: Mesh) -> np.ndarray:
    turn = mesh.object_to_world()[:3, :3]
    return np.concatenate([turn.T, -turn.T])


def test_shadow_maps_are_drawn_again_only_when_something_moved(device) -> None:
    from pellucid.surroundings import Surroundings
    from pellucid.techniques.opaque.passes import Opaque

    scene, surroundings, opaque = still_life(PERSPECTIVE), Surroundings(device), Opaque(device)

    def drawn(changed: Scene) -> bool:
        surroundings.prepare(changed, SIZE)
        return opaque.illuminate(device.wgpu.create_command_encoder(), surroundings)

    assert drawn(scene)
    assert not drawn(scene.replace(camera=PARALLEL, exposure=2.0))
    moved = [scene.objects[0], scene.objects[1].replace(position=(0, 1, 0)), scene.objects[2]]
    assert drawn(scene.replace(objects=moved))


def test_a_picture_with_caustics_is_what_rays_see(draw) -> None:
    """The same maps for the pixels of the picture and for the rays that leave glass."""
    from surroundings.bundles import beam, joined, land

    light = beam((0, 2, 0), (0, 0, 1.5), (1.5, 0, 0), 50, irradiance=3.0, way=(0.1, -1, 0))
    shade = beam((0, 2, 0), (0, 0, 1), (1, 0, 0), 50, irradiance=0.8, way=(-0.4, -0.8, -0.4), kind=1)
    plain, _, _ = draw(still_life(PERSPECTIVE), SIZE)
    radiance, _, query = draw(
        still_life(PERSPECTIVE), SIZE, before=lambda around: land(around, joined(light, shade), 0.02)
    )
    origins, directions = (a.reshape(-1, 3) for a in query.camera_rays())
    seen = query.radiance(origins, directions).reshape(radiance.shape)
    assert (~np.isclose(radiance, seen, rtol=2e-3, atol=1e-4).all(axis=-1)).sum() <= 0.003 * SIZE[0] * SIZE[1]
    assert (radiance > plain + 0.1).any() and (radiance < plain - 0.01).any()


def test_a_kept_picture_is_that_of_a_fresh_renderer(device: Device) -> None:
    from pellucid.renderer import Renderer

    scene, renderer = still_life(PERSPECTIVE), Renderer(device)
    kept = [renderer.render(scene, size=(48, 36)).radiance for _ in range(3)]
    assert (kept[0] == kept[1]).all() and (kept[0] == kept[2]).all()
    turned = scene.replace(environment=scene.environment.replace(rotation_deg=50.0))
    moved = scene.replace(camera=PERSPECTIVE.replace(fov_deg=30.0))
    painted = scene.replace(objects=[scene.objects[0].replace(base_color=(0.9, 0.1, 0.1)), *scene.objects[1:]])
    for other in (turned, moved, painted, scene):
        seen = [renderer.render(other, size=(48, 36)).radiance for _ in range(3)]
        fresh = Renderer(device).render(other, size=(48, 36)).radiance
        assert all((picture == fresh).all() for picture in seen)
        assert (fresh != kept[0]).any() or other is scene
