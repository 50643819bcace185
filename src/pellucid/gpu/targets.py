"""What a frame is drawn into: linear colour, reversed depth, and copies of them to look things up in."""

from __future__ import annotations

from typing import Any

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
        self._copies: tuple[Any, Any] | None = None

    def copies(self, encoder: Any) -> tuple[Any, Any]:
        """Copy colour and depth as they are at this point of the frame; (colour texture, depth texture)."""
        if self._copies is None:
            both = ("sample", "copy")
            self._copies = (
                self.device.texture(size=self.size, format=COLOR_FORMAT, usage=both, label="radiance so far"),
                self.device.texture(size=self.size, format=DEPTH_FORMAT, usage=both, label="depth so far"),
            )
        for source, target in zip((self.color, self.depth), self._copies, strict=True):
            encoder.copy_texture_to_texture({"texture": source}, {"texture": target}, (*self.size, 1))
        return self._copies

    def read_color(self) -> np.ndarray:
        """(H, W, 3) float32 radiance."""
        return self.device.read_texture(self.color)[..., :3].copy()

    def read_depth(self) -> np.ndarray:
        """(H, W) float32 depth-buffer values, 0 where nothing was drawn."""
        return self.device.read_texture(self.depth)[..., 0]
