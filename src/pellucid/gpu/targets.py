"""What a frame is drawn into: linear colour and reversed depth."""

from __future__ import annotations

import weakref

import numpy as np

from pellucid.gpu.device import Device

COLOR_FORMAT = "rgba32float"
DEPTH_FORMAT = "depth32float"


class Targets:
    """Colour and depth of one picture size; colour is 32-bit so that a sun in the environment does not overflow."""

    def __init__(self, device: Device, size: tuple[int, int]) -> None:
        self.device = device
        self.size = size
        both = ("render", "sample", "copy")
        self.color = device.texture(size=size, format=COLOR_FORMAT, usage=both, label="radiance")
        self.depth = device.texture(size=size, format=DEPTH_FORMAT, usage=both, label="depth")
        self.color_view = self.color.create_view()
        self.depth_view = self.depth.create_view()

    def read_color(self) -> np.ndarray:
        """(H, W, 4) float32 linear radiance."""
        return self.device.read_texture(self.color)

    def read_depth(self) -> np.ndarray:
        """(H, W) float32 depth-buffer values, 0 where nothing was drawn."""
        return self.device.read_texture(self.depth)[..., 0]


class Held:
    """A picture that lies in targets still: it is read when someone asks for it, or when its place is needed."""

    def __init__(self, targets: Targets) -> None:
        self._targets: Targets | None = targets
        self._color: np.ndarray | None = None
        self._depth: np.ndarray | None = None

    def color(self) -> np.ndarray:
        """(H, W, 4) float32 linear radiance."""
        if self._color is None:
            assert self._targets is not None
            self._color = self._targets.read_color()
        return self._color

    def depth(self) -> np.ndarray:
        """(H, W) float32 depth-buffer values."""
        if self._depth is None:
            assert self._targets is not None
            self._depth = self._targets.read_depth()
        return self._depth

    def leave(self) -> None:
        """Read what has not been read: the targets are for someone else from now on."""
        self.color(), self.depth()
        self._targets = None


class TargetRing:
    """Targets for one picture after the other, so that a picture nobody reads is never copied off the device.

    A picture keeps its place for as long as someone keeps hold of it and there is another; `MOST` places are enough
    for a loop that draws the next picture while it has the last.
    """

    MOST = 2

    def __init__(self, device: Device) -> None:
        self.device = device
        self._places: list[tuple[Targets, weakref.ref[Held]]] = []

    def take(self, size: tuple[int, int]) -> tuple[Targets, Held]:
        """Targets of a size (width, height), and the hold on what will be drawn into them."""
        # Those of another size are left to the pictures in them.
        self._places = [place for place in self._places if place[0].size == size]
        free = next((targets for targets, held in self._places if held() is None), None)
        if free is None and len(self._places) < self.MOST:
            free = Targets(self.device, size)
        if free is None:
            free, oldest = self._places[0]
            if (held := oldest()) is not None:
                held.leave()
        held = Held(free)
        others = [place for place in self._places if place[0] is not free]
        self._places = [*others, (free, weakref.ref(held))]
        return free, held
