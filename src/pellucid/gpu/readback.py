"""What the host reads of buffers and textures: all that is asked for by one submission, with one wait."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.errors import PellucidError

if TYPE_CHECKING:
    from pellucid.gpu.device import Device

ROW = 256  # bytes that rows of texels begin at a multiple of in a buffer
SMALL = 65536  # bytes; what is no larger shares a buffer that is never given up

TEXEL: dict[str, tuple[type, int]] = {
    "rgba32float": (np.float32, 4),
    "rg32float": (np.float32, 2),
    "r32float": (np.float32, 1),
    "rgba16float": (np.float16, 4),
    "rg16float": (np.float16, 2),
    "r16float": (np.float16, 1),
    "rgba32uint": (np.uint32, 4),
    "rgba8unorm": (np.uint8, 4),
    "rgba8unorm-srgb": (np.uint8, 4),
    "r8unorm": (np.uint8, 1),
    "depth32float": (np.float32, 1),
}
"""What one texel of a format is: type and number of its channels."""


@dataclass(frozen=True, eq=False)
class TextureRead:
    """One layer (of a 3D texture: one slice) and level of a texture, as (H, W, C)."""

    texture: Any
    layer: int = 0
    mip: int = 0

    @property
    def shape(self) -> tuple[int, int, int]:
        """(H, W, C)."""
        width, height = (max(1, side >> self.mip) for side in (self.texture.width, self.texture.height))
        return height, width, TEXEL[self.texture.format][1]

    @property
    def pitch(self) -> int:
        """Bytes from row to row."""
        _, width, channels = self.shape
        row = width * channels * np.dtype(TEXEL[self.texture.format][0]).itemsize
        return -(-row // ROW) * ROW

    @property
    def nbytes(self) -> int:
        """Bytes in the buffer that it is read through."""
        return self.pitch * self.shape[0]

    def encode(self, encoder: Any, staging: Any, offset: int) -> None:
        """Copy it there."""
        height, width, _ = self.shape
        encoder.copy_texture_to_buffer(
            {"texture": self.texture, "mip_level": self.mip, "origin": (0, 0, self.layer)},
            {"buffer": staging, "offset": offset, "bytes_per_row": self.pitch, "rows_per_image": height},
            (width, height, 1),
        )

    def found(self, mapped: Any, offset: int) -> np.ndarray:
        """A copy of what was mapped."""
        dtype, channels = TEXEL[self.texture.format]
        item = np.dtype(dtype).itemsize
        strides = self.pitch, channels * item, item
        return np.ndarray(self.shape, dtype, mapped, offset, strides).copy()


@dataclass(frozen=True, eq=False)
class BufferRead:
    """The beginning of a buffer, as an array of a type and shape."""

    buffer: Any
    dtype: Any
    shape: tuple[int, ...]

    @property
    def nbytes(self) -> int:
        """Bytes in the buffer that it is read through; copies are of whole words."""
        return -(-int(np.prod(self.shape)) * np.dtype(self.dtype).itemsize // 4) * 4

    def encode(self, encoder: Any, staging: Any, offset: int) -> None:
        """Copy it there."""
        size = self.nbytes
        if size > self.buffer.size:
            raise PellucidError(
                f"{self.buffer.label or 'buffer'}: {size} bytes asked of a buffer of {self.buffer.size}"
            )
        if size:
            encoder.copy_buffer_to_buffer(self.buffer, 0, staging, offset, size)

    def found(self, mapped: Any, offset: int) -> np.ndarray:
        """A copy of what was mapped."""
        return np.ndarray(self.shape, self.dtype, mapped, offset).copy()


def read_back(device: Device, reads: Sequence[TextureRead | BufferRead], encoder: Any = None) -> list[np.ndarray]:
    """Submit, and where anything is asked for wait until the work is done, and have it.

    Parameters
    ----------
    encoder : holds work that comes before; a new one when omitted.

    Raises
    ------
    PellucidError : a buffer is smaller than what is asked of it, or there is no memory to read through.
    """
    offsets = np.cumsum([0] + [-(-read.nbytes // ROW) * ROW for read in reads]).tolist()
    encoder = device.wgpu.create_command_encoder() if encoder is None else encoder
    if not offsets[-1]:
        device.wgpu.queue.submit([encoder.finish()])
        return []
    staging = _staging(device, offsets[-1])
    for read, offset in zip(reads, offsets, strict=False):
        read.encode(encoder, staging, offset)
    device.wgpu.queue.submit([encoder.finish()])
    staging.map_sync("READ", 0, offsets[-1])
    try:
        mapped = staging.read_mapped(0, offsets[-1], copy=False)
        return [read.found(mapped, offset) for read, offset in zip(reads, offsets, strict=False)]
    finally:
        staging.unmap()


def _staging(device: Device, nbytes: int) -> Any:
    """A buffer to read through; kept, for fresh memory costs as much as the copy."""
    import wgpu

    name = "staging" if nbytes > SMALL else "small staging"
    kept = device.cache.get(name)
    if kept is None or not nbytes <= kept.size <= max(8 * nbytes, SMALL):
        with device.memory("read-back", f"{nbytes} bytes"):
            usage = wgpu.BufferUsage.MAP_READ | wgpu.BufferUsage.COPY_DST
            device.cache[name] = kept = device.wgpu.create_buffer(size=max(nbytes, SMALL), usage=usage)
    return kept
