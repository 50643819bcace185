"""Milliseconds of each pass, from the device's own clock where it has one."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.gpu.device import Device
from pellucid.gpu.readback import BufferRead


class PassTimer:
    """Collects begin and end timestamps of labelled passes; a label used twice is summed.

    Without timestamp queries `writes` returns None and `milliseconds` is empty: the caller then has only the wall
    clock. Passes beyond `capacity` (at most 2048) since the last reading are not timed.
    """

    def __init__(self, device: Device, capacity: int = 128) -> None:
        self.device = device
        self.available = "timestamp-query" in device.features
        self._labels: list[str] = []
        self._capacity = min(capacity, 2048)  # WebGPU: a query set holds at most 4096
        self._queries: Any = None
        self._resolved: Any = None
        if self.available:
            self._queries = device.wgpu.create_query_set(type="timestamp", count=2 * self._capacity)

    def writes(self, label: str) -> dict[str, Any] | None:
        """The `timestamp_writes` of a pass, or None when it cannot be timed."""
        if not self.available or len(self._labels) >= self._capacity:
            return None
        index = len(self._labels)
        self._labels.append(label)
        return {
            "query_set": self._queries,
            "beginning_of_pass_write_index": 2 * index,
            "end_of_pass_write_index": 2 * index + 1,
        }

    def forget(self) -> None:
        """Leave out the passes since the last reading: a frame that failed has left them."""
        self._labels.clear()

    def resolve(self, encoder: Any) -> list[BufferRead]:
        """Encode, after the passes, what `summed` needs to be read of them; nothing when there were none."""
        count = len(self._labels)
        if not count:
            return []
        if self._resolved is None:
            import wgpu

            usage = wgpu.BufferUsage.QUERY_RESOLVE | wgpu.BufferUsage.COPY_SRC
            self._resolved = self.device.wgpu.create_buffer(size=max(16 * self._capacity, 256), usage=usage)
        encoder.resolve_query_set(self._queries, 0, 2 * count, self._resolved, 0)
        return [BufferRead(self._resolved, np.dtype(np.uint64), (count, 2))]

    def summed(self, ticks: npt.NDArray[np.uint64]) -> dict[str, float]:
        """{label: ms} of the (N, 2) ticks that `resolve` asked to be read."""
        out: dict[str, float] = {}
        for label, (begin, end) in zip(self._labels, ticks, strict=True):
            # Some drivers reset their clock inside a pass: unsigned ticks would make that centuries.
            ticks_taken = max(int(end) - int(begin), 0)
            out[label] = out.get(label, 0.0) + ticks_taken * _tick_ns(self.device) * 1e-6
        self._labels.clear()
        return out

    def milliseconds(self) -> dict[str, float]:
        """{label: ms} since the last call; waits for the work."""
        encoder = self.device.wgpu.create_command_encoder()
        asked = self.resolve(encoder)
        if not asked:
            return {}
        self.device.wgpu.queue.submit([encoder.finish()])
        return self.summed(self.device.read(asked[0].buffer, asked[0].dtype, asked[0].shape))


def _tick_ns(device: Device) -> float:
    """Nanoseconds of one tick; wgpu-py has no public call for it, so its native library is asked."""
    if "tick_ns" not in device.cache:
        try:
            from wgpu.backends.wgpu_native import lib

            device.cache["tick_ns"] = float(lib.wgpuQueueGetTimestampPeriod(device.wgpu.queue._internal))
        except (ImportError, AttributeError, TypeError):
            device.cache["tick_ns"] = 1.0
    return float(device.cache["tick_ns"])
