"""The camera's part of the frame parameters, read off the camera's own matrices."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from pellucid.surroundings.layouts import FLAG_ORTHOGRAPHIC

if TYPE_CHECKING:
    from pellucid.scene import Camera


@dataclass(frozen=True, eq=False)
class View:
    """A camera as its two matrices, which may be mirrored, turned or widened in ways that no `Camera` can describe.

    Attributes
    ----------
    view_from_world : (4, 4) float64, world points as columns to camera space (x right, y up, looking along -z); may be
        left-handed.
    projection : (4, 4) float64, camera space to clip space with reversed depth, without jitter.
    near_m, far_m : metres along the view axis, as of `Camera`.
    """

    view_from_world: np.ndarray
    projection: np.ndarray
    near_m: float
    far_m: float

    @property
    def is_orthographic(self) -> bool:
        """Whether all rays run parallel."""
        return bool(self.projection[3, 3] == 1.0)

    @cached_property
    def position(self) -> np.ndarray:
        """(3,) float64, where it stands in the world, metres."""
        return np.asarray(np.linalg.inv(self.view_from_world)[:3, 3])

    @cached_property
    def axes(self) -> np.ndarray:
        """(3, 3) float64, rows: the picture's right, its up and the way that it looks, unit vectors of the world."""
        world = np.linalg.inv(self.view_from_world)
        return np.stack([world[:3, 0], world[:3, 1], -world[:3, 2]])

    @property
    def half_extent(self) -> np.ndarray:
        """(2,) float64, half width and height: tangents, or metres if parallel."""
        return 1.0 / np.array([self.projection[0, 0], self.projection[1, 1]])


def view_of(camera: Camera, size: tuple[int, int]) -> View:
    """The matrices of a camera for a picture of `size` (width, height) pixels."""
    view = np.asarray(camera.view_matrix(), np.float64)
    projection = np.asarray(camera.projection_matrix(size), np.float64)
    return View(view, projection, camera.near_m, camera.far_m)


def write_view(frame: np.ndarray, view: View, size: tuple[int, int], jitter: tuple[float, float] = (0.0, 0.0)) -> None:
    """Fill the camera fields of one FrameParams record.

    Parameters
    ----------
    frame : () structured array of dtype `layouts.FrameParams`, changed in place.
    view : the camera.
    size : (width, height) of the picture in pixels.
    jitter : offset in pixels, x to the right and y down, of the sampled point from the pixel's centre.
    """
    world = np.linalg.inv(view.view_from_world)
    half = view.half_extent
    shift = np.eye(4)
    shift[:2, 3] = -2.0 * jitter[0] / size[0], 2.0 * jitter[1] / size[1]
    frame["clip_from_world"] = (shift @ view.projection @ view.view_from_world).T
    frame["camera_right"], frame["camera_up"] = world[:3, 0], world[:3, 1]
    frame["camera_forward"], frame["camera_position"] = -world[:3, 2], world[:3, 3]
    frame["near_m"], frame["far_m"] = view.near_m, view.far_m
    frame["size"], frame["jitter"], frame["half_extent"] = size, jitter, half
    frame["pixel_footprint"] = 2.0 * half[1] / size[1]
    frame["flags"] = FLAG_ORTHOGRAPHIC if view.is_orthographic else 0
    # As sharp as the picture: a level of the environment whose texels are as wide as a pixel.
    height = float(frame["environment_height"])
    texel = np.pi / height if height else np.pi
    spread = 0.0 if view.is_orthographic else float(frame["pixel_footprint"])
    frame["environment_pixel_lod"] = max(0.0, np.log2(max(spread / texel, 1e-9)))
