"""Milliseconds of each pass, from the device's own clock where it has one."""

from __future__ import annotations

from typing import Any

import numpy as np

from pellucid.gpu.device import Device


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

    def milliseconds(self) -> dict[str, float]:
        """{label: ms} since the last call; waits for the work."""
        count = len(self._labels)
        if not count:
            return {}
        import wgpu

        size = 16 * count
        usage = wgpu.BufferUsage.QUERY_RESOLVE | wgpu.BufferUsage.COPY_SRC
        resolved = self.device.wgpu.create_buffer(size=max(size, 256), usage=usage)
        encoder = self.device.wgpu.create_command_encoder()
        encoder.resolve_query_set(self._queries, 0, 2 * count, resolved, 0)
        self.device.wgpu.queue.submit([encoder.finish()])
        ticks = self.device.read(resolved, np.uint64, (count, 2))
        out: dict[str, float] = {}
        for label, (begin, end) in zip(self._labels, ticks, strict=True):
            # Some drivers reset their clock inside a pass: unsigned ticks would make that centuries.
            ticks_taken = max(int(end) - int(begin), 0)
            out[label] = out.get(label, 0.0) + ticks_taken * _tick_ns(self.device) * 1e-6
        self._labels.clear()
        return out


def _tick_ns(device: Device) -> float:
    """Nanoseconds of one tick; wgpu-py has no public call for it, so its native library is asked."""
    if "tick_ns" not in device.cache:
        try:
            from wgpu.backends.wgpu_native import lib

            device.cache["tick_ns"] = float(lib.wgpuQueueGetTimestampPeriod(device.wgpu.queue._internal))
        except (ImportError, AttributeError, TypeError):
            device.cache["tick_ns"] = 1.0
    return float(device.cache["tick_ns"])
