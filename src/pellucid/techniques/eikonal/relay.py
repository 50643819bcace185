"""Rays go on from body to body [laine2013].

The camera ray of each pixel goes to the list of the body that it meets first. Each body follows the rays of its list
and puts those that leave it into one common list; from there they go to the body that they meet next, or, where there
is none or a mesh is nearer, into the list of rays that look around. So it goes on for a number of rounds.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from pellucid.gpu import ComputeKernel, Device, Pipelines
from pellucid.techniques.eikonal.bodies import Body
from pellucid.techniques.eikonal.layouts import BodyBox, LookCount
from pellucid.techniques.eikonal.resources import LOOKS_PER_PIXEL, scale_of

# Bodies that a ray may enter one after the other; behind the last it sees meshes and the environment only.
BODIES_IN_A_ROW = 8

March = tuple[ComputeKernel, dict[str, Any]]


def list_bytes(pixels: int) -> int:
    """Of a list that takes all the rays that these pixels can have (shaders/ray_list.wgsl)."""
    return 2 * LookCount.itemsize + 4 * pixels * LOOKS_PER_PIXEL


class Relay:
    """The lists of rays between bodies, and the kernels that fill them."""

    def __init__(self, device: Device) -> None:
        self.device = device
        self._pipelines = Pipelines(device)
        self._count = 0
        self._pixels = 0
        self._empty = device.buffer(16, "storage", "no lists")
        self._buffers: dict[str, Any] = {}

    @property
    def nbytes(self) -> int:
        return sum(buffer.size for buffer in self._buffers.values())

    def prepare(self, bodies: Sequence[Body]) -> None:
        """Write where the bodies stand, if there are several."""
        if len(bodies) < 2:
            return
        boxes = np.zeros(len(bodies), BodyBox)
        for box, body in zip(boxes, bodies, strict=True):
            box["object_from_world"] = np.linalg.inv(body.world).T
            box["center"], box["half"] = body.box
            box["scale"] = scale_of(body.world)
        if len(bodies) != self._count:
            self._count, self._pixels = len(bodies), 0
            self._buffers = {"body_boxes": self.device.buffer(boxes.nbytes, "storage", "body boxes")}
            empty = np.tile(np.array([(0, 1, 1, 0)], LookCount), len(bodies))
            boxes_of_nothing = np.zeros(len(bodies), BodyBox)
            boxes_of_nothing["half"] = -1.0
            self._buffers["no_boxes"] = self.device.buffer(boxes_of_nothing, "storage", "no boxes")
            self._buffers["no_rays"] = self.device.buffer(empty, "storage", "no rays")
        self.device.write(self._buffers["body_boxes"], boxes)

    def reserve(self, pixels: int, several: bool) -> dict[str, Any]:
        """What the marches bind, with room for `pixels` pixels."""
        if not several:
            return {"body_lists": self._empty}
        if pixels > self._pixels:
            self._pixels = pixels
            words = 4 * self._count + (self._marks + self._count) * pixels
            self._buffers["body_lists"] = self.device.buffer(4 * words, "indirect", "rays of each body")
            self._buffers["waiting"] = self.device.buffer(list_bytes(pixels), "indirect", "rays that wait")
        return {"body_lists": self._buffers["body_lists"]}

    @property
    def _marks(self) -> int:
        return -(-self._count // 32)

    def run(
        self,
        encoder: Any,
        blocks: tuple[int, int, int],
        pixels: int,
        seen: Sequence[int],
        marches: Sequence[March],
        shared: dict[str, Any],
        has_meshes: bool,
        timer: Any,
    ) -> None:
        """Follow all rays to where they look around, from those of the camera on.

        Parameters
        ----------
        blocks : workgroups of 8 x 8 pixels. seen : numbers of the bodies that the camera sees in the band.
        marches : for each body the kernel that follows its rays, and what is bound to it.
        shared : what is bound to all; the rays that look around are added to its "look_list".
        """
        lists, waiting = shared["body_lists"], self._buffers["waiting"]
        bound = {**shared, **self._buffers}
        self._clear(encoder, pixels)
        route = self._route_kernel(has_meshes)
        self._begin_kernel().run(blocks, bound, encoder, timer, "eikonal begin")
        for number in range(BODIES_IN_A_ROW):
            encoder.copy_buffer_to_buffer(self._buffers["no_rays"], 0, waiting, 0, 2 * LookCount.itemsize)
            for body in seen if number == 0 else range(len(marches)):
                kernel, bindings = marches[body]
                leaving = {**bindings, "look_list": waiting}
                arguments = (lists, LookCount.itemsize * body)
                kernel.run((0, 0, 0), leaving, encoder, timer, "eikonal march", indirect=arguments)
            self._clear(encoder, pixels)
            if number == BODIES_IN_A_ROW - 1:
                bound["body_boxes"] = self._buffers["no_boxes"]
            route.run((0, 0, 0), bound, encoder, timer, "eikonal route", indirect=(waiting, 0))

    def _clear(self, encoder: Any, pixels: int) -> None:
        lists, head = self._buffers["body_lists"], LookCount.itemsize * self._count
        encoder.copy_buffer_to_buffer(self._buffers["no_rays"], 0, lists, 0, head)
        encoder.clear_buffer(lists, head, 4 * self._marks * pixels)

    def _begin_kernel(self) -> ComputeKernel:
        return self._pipelines.kernel("techniques/eikonal/shaders/begin")

    def _route_kernel(self, has_meshes: bool) -> ComputeKernel:
        return self._pipelines.kernel("techniques/eikonal/shaders/route", {"HAS_MESHES": float(has_meshes)})
