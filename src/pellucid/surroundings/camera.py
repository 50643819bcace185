"""The camera's part of the frame parameters, read off the camera's own matrices."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pellucid.surroundings.layouts import FLAG_ORTHOGRAPHIC

if TYPE_CHECKING:
    from pellucid.scene import Camera


def write_camera(
    frame: np.ndarray, camera: Camera, size: tuple[int, int], jitter: tuple[float, float] = (0.0, 0.0)
) -> None:
    """Fill the camera fields of one FrameParams record.

    Parameters
    ----------
    frame : () structured array of dtype `layouts.FrameParams`, changed in place.
    camera : the camera.
    size : (width, height) of the picture in pixels.
    jitter : offset in pixels, x to the right and y down, of the sampled point from the pixel's centre.
    """
    view = np.asarray(camera.view_matrix(), np.float64)
    projection = np.asarray(camera.projection_matrix(size), np.float64)
    world = np.linalg.inv(view)
    half = 1.0 / np.array([projection[0, 0], projection[1, 1]])
    shift = np.eye(4)
    shift[:2, 3] = -2.0 * jitter[0] / size[0], 2.0 * jitter[1] / size[1]
    frame["clip_from_world"] = (shift @ projection @ view).T
    frame["camera_right"], frame["camera_up"] = world[:3, 0], world[:3, 1]
    frame["camera_forward"], frame["camera_position"] = -world[:3, 2], world[:3, 3]
    frame["near_m"], frame["far_m"] = camera.near_m, camera.far_m
    frame["size"], frame["jitter"], frame["half_extent"] = size, jitter, half
    frame["pixel_footprint"] = 2.0 * half[1] / size[1]
    frame["flags"] = FLAG_ORTHOGRAPHIC if projection[3, 3] == 1.0 else 0
