"""What a frame is drawn into: linear colour and reversed depth."""

from __future__ import annotations

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

    def read_depth(self) -> np.ndarray:
        """(H, W) float32 depth-buffer values, 0 where nothing was drawn."""
        return self.device.read_texture(self.depth)[..., 0]
