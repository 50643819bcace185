"""The mean of several jittered pictures, summed on the device."""

from __future__ import annotations

from typing import Any

import numpy as np

from pellucid.gpu import Device, Pipelines


class Accumulator:
    """Sums pictures of one size. Create it anew for each series."""

    def __init__(self, device: Device, size: tuple[int, int]) -> None:
        self.device = device
        self.size = size
        self.count = 0
        self._kernel = Pipelines(device, ("picture",), shared=True).kernel("techniques/finish/shaders/accumulate")
        self._sum = device.buffer(16 * size[0] * size[1], "storage", "sum of samples")

    def add(self, encoder: Any, picture: Any, timer: Any = None) -> None:
        """Encode the addition of one picture (an rgba32float texture)."""
        groups = (-(-self.size[0] // 8), -(-self.size[1] // 8), 1)
        bindings = {"picture": picture, "sum": self._sum}
        self._kernel.run(groups, bindings, encoder, timer, "accumulate")
        self.count += 1

    def mean(self) -> np.ndarray:
        """(H, W, 4) float32."""
        total = self.device.read(self._sum, np.float32, (self.size[1], self.size[0], 4))
        return total / np.float32(max(self.count, 1))
