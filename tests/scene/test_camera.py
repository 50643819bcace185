"""The camera's matrices and its rays are two statements of one thing; here they check each other."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.scene import Camera

PERSPECTIVE = Camera(position=(1.0, 2.0, 3.0), target=(-0.5, 0.3, -2.0), up=(0.1, 1.0, 0.0), fov_deg=55.0, near_m=0.2)
PARALLEL = PERSPECTIVE.replace(orthographic_height_m=2.5, far_m=30.0)
SIZE = (7, 4)


def project(camera: Camera, points: np.ndarray, jitter: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
    """World points to (pixel x, pixel y, depth)."""
    clip = np.c_[points, np.ones(len(points))] @ (camera.projection_matrix(SIZE, jitter) @ camera.view_matrix()).T
    x, y, z = (clip[:, :3] / clip[:, 3:]).T
    return np.stack([(x + 1.0) * SIZE[0] / 2.0, (1.0 - y) * SIZE[1] / 2.0, z], axis=1)


@pytest.mark.parametrize("camera", [PERSPECTIVE, PARALLEL], ids=["perspective", "parallel"])
@pytest.mark.parametrize("jitter", [(0.0, 0.0), (0.3, -0.45)])
def test_a_point_on_a_pixels_ray_is_drawn_at_that_pixels_centre(camera: Camera, jitter: tuple[float, float]) -> None:
    origins, directions = camera.pixel_rays(SIZE, jitter)
    drawn = project(camera, (origins + 4.2 * directions).reshape(-1, 3), jitter)
    j, i = np.mgrid[: SIZE[1], : SIZE[0]]
    assert drawn[:, :2] == pytest.approx(np.stack([i + 0.5, j + 0.5], -1).reshape(-1, 2), abs=1e-12)


def test_depth_is_reversed_with_the_far_plane_at_infinity() -> None:
    _, _, back = PERSPECTIVE.axes()
    points = np.array(PERSPECTIVE.position) - np.outer([0.2, 0.4, 2.0, 1e9], back)
    assert project(PERSPECTIVE, points)[:, 2] == pytest.approx([1.0, 0.5, 0.1, 2e-10])


def test_parallel_depth_falls_linearly_from_near_to_far() -> None:
    _, _, back = PARALLEL.axes()
    points = np.array(PARALLEL.position) - np.outer([0.2, 15.1, 30.0], back)
    assert project(PARALLEL, points)[:, 2] == pytest.approx([1.0, 0.5, 0.0], abs=1e-12)


def test_the_field_of_view_is_vertical_and_the_first_row_is_the_top() -> None:
    _, directions = Camera(position=(0, 0, 0), target=(0, 0, -1), fov_deg=90.0).pixel_rays((300, 200))
    assert directions[100, 150] == pytest.approx([0, 0, -1], abs=0.01)
    top, right = directions[0, 150], directions[100, -1]
    assert top[1] / -top[2] == pytest.approx(1.0 - 1.0 / 200)  # tan 45 degrees, less half a pixel
    assert right[0] / -right[2] == pytest.approx(1.5 - 1.0 / 200)


def test_rays_have_unit_length_and_parallel_ones_cover_the_height() -> None:
    for camera in (PERSPECTIVE, PARALLEL):
        assert np.linalg.norm(camera.pixel_rays(SIZE)[1], axis=-1) == pytest.approx(np.ones((4, 7)))
    origins, _ = PARALLEL.pixel_rays(SIZE)
    assert np.linalg.norm(origins[0, 0] - origins[-1, 0]) == pytest.approx(2.5 * 3 / 4)


def test_the_view_matrix_is_a_rigid_motion_of_a_right_handed_frame() -> None:
    view = PERSPECTIVE.view_matrix()
    assert view[:3, :3] @ view[:3, :3].T == pytest.approx(np.eye(3), abs=1e-14)
    assert np.linalg.det(view[:3, :3]) == pytest.approx(1.0)
    assert view @ [*PERSPECTIVE.position, 1.0] == pytest.approx([0, 0, 0, 1])
    target = view @ [*PERSPECTIVE.target, 1.0]
    assert target[:2] == pytest.approx([0.0, 0.0], abs=1e-14) and target[2] < 0.0


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"fov_deg": 200}, "camera.fov_deg"),
        ({"fov_deg": 180}, "camera.fov_deg"),
        ({"fov_deg": 0}, "camera.fov_deg"),
        ({"fov_deg": float("nan")}, "camera.fov_deg"),
        ({"fov_deg": "wide"}, "camera.fov_deg"),
        ({"fov_deg": True}, "camera.fov_deg"),
        ({"position": (0, np.inf, 0)}, r"camera.position[1]"),
        ({"position": (0, 0)}, "camera.position"),
        ({"position": "abc"}, "camera.position"),
        ({"position": 3}, "camera.position"),
        ({"target": (1.0, 2.0, 3.0)}, "camera.target"),
        ({"up": (0, 0, 0)}, "camera.up"),
        ({"up": (3.0, 3.4, 10.0)}, "camera.up"),
        ({"near_m": 0}, "camera.near_m"),
        ({"near_m": 200}, "camera.far_m"),
        ({"orthographic_height_m": -1}, "camera.orthographic_height_m"),
    ],
)
def test_each_fault_names_its_field(changes: dict, field: str) -> None:
    with pytest.raises(SceneError) as caught:
        PERSPECTIVE.replace(**changes)
    assert caught.value.field == field


def test_the_message_reads_like_a_sentence() -> None:
    with pytest.raises(SceneError) as caught:
        PERSPECTIVE.replace(fov_deg=200)
    assert str(caught.value) == "camera.fov_deg: must be strictly between 0 and 180 degrees, got 200"
    with pytest.raises(SceneError, match="Camera has no such field"):
        PERSPECTIVE.replace(fov=3)


@pytest.mark.parametrize("size", [(0, 4), (4,), 4, (4.5, 3), (4, -1)])
def test_odd_sizes_are_refused(size: object) -> None:
    with pytest.raises(SceneError, match="size"):
        PERSPECTIVE.pixel_rays(size)  # type: ignore[arg-type]


def test_numpy_values_are_as_good_as_python_ones() -> None:
    camera = Camera(position=np.array([0, 0, 2], np.float32), fov_deg=np.float32(30))  # type: ignore[arg-type]
    assert camera.position == (0.0, 0.0, 2.0) and camera == Camera(position=(0, 0, 2), fov_deg=30)
