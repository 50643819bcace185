"""The camera: where it stands, what it sees, and the rays of its pixels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pellucid.errors import SceneError
from pellucid.scene import checks
from pellucid.scene.placement import Value, store


@dataclass(frozen=True)
class Camera(Value):
    """A pinhole camera, or a parallel projection when `orthographic_height_m` is given.

    Camera space is right-handed with +Y up and looks along -Z.

    Parameters
    ----------
    position : world position in metres.
    target : the world point at the middle of the picture.
    up : world direction that points up in the picture; must not lie along the view.
    fov_deg : vertical field of view, between 0 and 180 degrees.
    orthographic_height_m : height of the picture in world metres; None for perspective.
    near_m, far_m : distances along the view axis, 0 < near < far. In perspective the far plane is at
        infinity and `far_m` is not used; an orthographic picture shows what lies between the two.

    Raises
    ------
    SceneError : a value out of range, `target` at `position`, `up` along the view.
    """

    position: checks.Vector
    target: checks.Vector = (0.0, 0.0, 0.0)
    up: checks.Vector = (0.0, 1.0, 0.0)
    fov_deg: float = 40.0
    orthographic_height_m: float | None = None
    near_m: float = 0.01
    far_m: float = 100.0

    def __post_init__(self) -> None:
        height = self.orthographic_height_m
        if height is not None:
            height = checks.number("camera.orthographic_height_m", height, low=0.0, exclusive=True, unit="metres")
        near = checks.number("camera.near_m", self.near_m, low=0.0, exclusive=True, unit="metres")
        store(
            self,
            position=checks.vector("camera.position", self.position),
            target=checks.vector("camera.target", self.target),
            up=checks.direction("camera.up", self.up),
            fov_deg=checks.number("camera.fov_deg", self.fov_deg, low=0.0, high=180.0, exclusive=True, unit="degrees"),
            orthographic_height_m=height,
            near_m=near,
            far_m=checks.number(
                "camera.far_m", self.far_m, low=near, exclusive=True, unit="metres", remedy="far_m lies beyond near_m"
            ),
        )
        self._check_axes()

    @property
    def is_orthographic(self) -> bool:
        """Whether all rays run parallel."""
        return self.orthographic_height_m is not None

    def axes(self) -> np.ndarray:
        """(3, 3) float64, rows: the picture's right, its up, and the way back towards the viewer (world)."""
        back = np.subtract(self.position, self.target)
        back = back / np.linalg.norm(back)
        right = np.cross(self.up, back)
        right = right / np.linalg.norm(right)
        return np.stack([right, np.cross(back, right), back])

    def view_matrix(self) -> np.ndarray:
        """(4, 4) float64: world points, as columns, to camera space."""
        result = np.eye(4)
        result[:3, :3] = self.axes()
        result[:3, 3] = -result[:3, :3] @ np.asarray(self.position)
        return result

    def projection_matrix(self, size: tuple[int, int], jitter: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
        """(4, 4) float64: camera space to clip space with reversed depth, 1 near and 0 far.

        Parameters
        ----------
        size : width and height of the picture in pixels.
        jitter : where in the pixel its ray goes, in pixels right and down from the centre.

        Notes
        -----
        Perspective depth is near / distance with the far plane at infinity; orthographic depth falls
        linearly from 1 at `near_m` to 0 at `far_m`. Distance is along the view axis.
        """
        width, height = _checked_size(size)
        shift_x, shift_y = -2.0 * jitter[0] / width, 2.0 * jitter[1] / height
        half_x, half_y = self._half_extent(width / height)
        result = np.zeros((4, 4))
        result[0, 0], result[1, 1] = 1.0 / half_x, 1.0 / half_y
        if self.is_orthographic:
            span = self.far_m - self.near_m
            result[2, 2:] = 1.0 / span, self.far_m / span
            result[:, 3] += shift_x, shift_y, 0.0, 1.0
        else:
            result[2, 3] = self.near_m
            result[:, 2] += -shift_x, -shift_y, 0.0, -1.0
        return result

    def pixel_rays(
        self, size: tuple[int, int], jitter: tuple[float, float] = (0.0, 0.0)
    ) -> tuple[np.ndarray, np.ndarray]:
        """World rays through the pixel centres (i + 0.5, j + 0.5) + jitter, row 0 at the top.

        Returns
        -------
        origins, directions : (H, W, 3) float64 each; directions have unit length. Origins lie on the
            plane through `position`, also in a parallel projection.
        """
        width, height = _checked_size(size)
        half_x, half_y = self._half_extent(width / height)
        x = half_x * (2.0 * (np.arange(width) + 0.5 + jitter[0]) / width - 1.0)
        y = half_y * (1.0 - 2.0 * (np.arange(height) + 0.5 + jitter[1]) / height)
        right, up, back = self.axes()
        in_plane = x[None, :, None] * right + y[:, None, None] * up
        if self.is_orthographic:
            return self.position + in_plane, np.broadcast_to(-back, in_plane.shape).copy()
        directions = in_plane - back
        directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
        return np.broadcast_to(np.asarray(self.position), in_plane.shape).copy(), directions

    def _half_extent(self, aspect: float) -> tuple[float, float]:
        """Half width and height of the picture: metres if parallel, per metre of distance if not."""
        if self.orthographic_height_m is not None:
            half = 0.5 * self.orthographic_height_m
        else:
            half = float(np.tan(0.5 * np.radians(self.fov_deg)))
        return half * aspect, half

    def _check_axes(self) -> None:
        view = np.subtract(self.target, self.position)
        distance = np.linalg.norm(view)
        if distance < 1e-12 * max(1.0, float(np.abs(self.position).max())):
            raise SceneError("camera.target", "lies at the camera's position, so there is no view direction")
        sine = np.linalg.norm(np.cross(view, self.up)) / (distance * np.linalg.norm(self.up))
        if sine < 1e-6:
            raise SceneError("camera.up", "is parallel to the view", "choose another, such as (0, 0, -1)")


def _checked_size(size: tuple[int, int]) -> tuple[int, int]:
    if not isinstance(size, tuple | list) or len(size) != 2:
        raise SceneError("size", f"must be (width, height) in pixels, got {size!r}")
    return (
        checks.integer("size[0]", size[0], low=1, high=65536),
        checks.integer("size[1]", size[1], low=1, high=65536),
    )
