"""The device: adapter choice, limits, buffers, textures and read-back; no physics."""

from __future__ import annotations

import contextlib
import logging
import os
import platform
import stat
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from pellucid.errors import NoAdapterError, PellucidError
from pellucid.gpu.readback import TEXEL, BufferRead, TextureRead, read_back

_REMEDIES = {
    "Linux": "install a Vulkan driver; without a GPU the software one will do: "
    "on Debian or Ubuntu `apt-get install mesa-vulkan-drivers libvulkan1`",
    "Darwin": "Metal is part of macOS 10.13 and later; update the system, or leave the sandbox that hides the GPU",
    "Windows": "install the graphics driver of the GPU's maker (DirectX 12 or Vulkan)",
}
_SOFTWARE_REMEDIES = {
    "Linux": "on Debian or Ubuntu `apt-get install mesa-vulkan-drivers libvulkan1`",
    "Darwin": "macOS has none; ask for any adapter instead",
    "Windows": "WARP is part of Windows 10 and later; update the system, or ask for any adapter instead",
}
_OPTIONAL_FEATURES = ("float32-filterable", "timestamp-query", "float32-blendable")
# Asked for as far as the adapter has them; the standard ones are small.
_RAISED_LIMITS = (
    *("max-storage-buffer-binding-size", "max-buffer-size", "max-texture-dimension-3d"),
    "max-sampled-textures-per-shader-stage",
)


def adapter_remedy(software: bool = False) -> str:
    """What to install on this operating system so that an adapter (or a software one) is found."""
    remedies = _SOFTWARE_REMEDIES if software else _REMEDIES
    return remedies.get(platform.system(), "install a Vulkan, Metal or DirectX 12 driver")


def _private_runtime_folder() -> None:
    """Vulkan loaders complain, or fail, when XDG_RUNTIME_DIR is unset: give them a folder of our own."""
    if platform.system() == "Linux" and not os.environ.get("XDG_RUNTIME_DIR"):
        folder = os.path.join(tempfile.gettempdir(), f"pellucid-runtime-{os.getuid()}")
        with contextlib.suppress(FileExistsError):
            os.mkdir(folder, mode=0o700)
        # The name can be guessed: someone else may have put a folder, or a link, there first.
        os.environ["XDG_RUNTIME_DIR"] = folder if _is_private(folder) else tempfile.mkdtemp(prefix="pellucid-runtime-")


def _is_private(folder: str) -> bool:
    status = os.lstat(folder)
    return stat.S_ISDIR(status.st_mode) and status.st_uid == os.getuid() and not status.st_mode & 0o077


def list_adapters() -> list[Any]:
    """Every adapter of this machine, GPUs before software drivers; empty when there is none."""
    _private_runtime_folder()
    import wgpu

    order = {"DiscreteGPU": 0, "IntegratedGPU": 1, "VirtualGPU": 2, "Unknown": 3, "CPU": 4}
    adapters = [a for a in wgpu.gpu.enumerate_adapters_sync() if a.info.get("backend_type") != "OpenGL"]
    return sorted(adapters, key=lambda a: order.get(str(a.info.get("adapter_type")), 3))


@dataclass(eq=False)
class Device:
    """A WebGPU device with the few operations that the passes need.

    Create one with `Device.create`; it is the only holder of GPU state that this package passes around.
    """

    wgpu: Any
    info: dict[str, Any]
    features: frozenset[str]
    limits: dict[str, int]
    _samplers: dict[Any, Any] = field(default_factory=dict, repr=False)
    cache: dict[Any, Any] = field(default_factory=dict, repr=False)

    @classmethod
    def create(cls, software: bool = False) -> Device:
        """Open the best adapter (or, with `software`, the CPU driver).

        Raises
        ------
        NoAdapterError : when there is none, or none that opens; the message says what to install here.
        """
        adapters = list_adapters()
        if software:
            adapters = [a for a in adapters if a.info.get("adapter_type") == "CPU"]
        if not adapters:
            kind = "software Vulkan driver" if software else "graphics adapter"
            raise NoAdapterError(f"no {kind} was found: {adapter_remedy(software)}")
        return cls._open(adapters[0])

    @classmethod
    def _open(cls, adapter: Any) -> Device:
        import wgpu

        wanted = [f for f in _OPTIONAL_FEATURES if f in adapter.features]
        limits = {name: adapter.limits[name] for name in _RAISED_LIMITS if name in adapter.limits}
        try:
            device = adapter.request_device_sync(required_features=wanted, required_limits=limits)
        except (RuntimeError, wgpu.GPUError) as error:
            name = adapter.info.get("device", "the adapter")
            raise NoAdapterError(f"{name} could not be opened ({error}): {adapter_remedy()}") from error
        opened = cls(device, dict(adapter.info), frozenset(device.features), dict(device.limits))
        if opened.is_software:
            logging.getLogger("pellucid").info("no GPU: %s does the work on the CPU", opened.name)
        return opened

    @property
    def is_software(self) -> bool:
        """True when the CPU does the work."""
        return self.info.get("adapter_type") == "CPU"

    @property
    def float32_filterable(self) -> bool:
        """True when 32-bit float textures may be sampled with linear filtering."""
        return "float32-filterable" in self.features

    @property
    def name(self) -> str:
        """What the driver calls the adapter."""
        return str(self.info.get("device", "unknown adapter"))

    # ---- buffers -------------------------------------------------------------------------------------------

    def buffer(self, data: np.ndarray | int, usage: str = "storage", label: str = "") -> Any:
        """Create a buffer from an array, or of a number of bytes (zeroed).

        usage : "storage", "uniform", "vertex", "index" or "indirect"; copies in both directions are always allowed.
            Sizes are rounded up to 16 bytes.

        Raises
        ------
        PellucidError : when it is more than the device allows, or than it has left.
        """
        import wgpu

        flag = getattr(wgpu.BufferUsage, usage.upper())
        if usage == "indirect":
            flag |= wgpu.BufferUsage.STORAGE
        flag |= wgpu.BufferUsage.COPY_SRC | wgpu.BufferUsage.COPY_DST
        size = int(data) if isinstance(data, int | np.integer) else data.nbytes
        self._check_buffer_size(size, usage, label)
        size = max(16, -(-size // 16) * 16)
        with self.memory(label or "buffer", f"{size} bytes"):
            out = self.wgpu.create_buffer(size=size, usage=flag, label=label)
        if not isinstance(data, int | np.integer):
            self.write(out, data)
        return out

    def _check_buffer_size(self, size: int, usage: str, label: str) -> None:
        limit = self.limits["max-buffer-size"]
        if usage in ("storage", "uniform"):
            limit = min(limit, self.limits[f"max-{usage}-buffer-binding-size"])
        if size < 0 or size > limit:
            raise PellucidError(
                f"{label or 'buffer'}: {size} bytes; this device allows {usage} buffers of 0 to {limit}"
            )

    @staticmethod
    @contextlib.contextmanager
    def memory(label: str, what: str) -> Iterator[None]:
        """Within the limits a device can still run out of memory."""
        import wgpu

        try:
            yield
        except wgpu.GPUError as error:
            reason = str(error).strip().splitlines()[-1].strip()
            raise PellucidError(f"{label}: {what} cannot be had on this device: {reason}") from error

    def write(self, buffer: Any, data: np.ndarray, offset: int = 0) -> None:
        """Copy an array into a buffer at a byte offset; up to three zero bytes make its size a multiple of four."""
        raw = np.ascontiguousarray(data).reshape(-1).view(np.uint8)
        if raw.size % 4:
            raw = np.concatenate([raw, np.zeros(4 - raw.size % 4, np.uint8)])
        if offset % 4 or offset < 0 or offset + raw.size > buffer.size:
            raise PellucidError(
                f"{buffer.label or 'buffer'}: {raw.size} bytes at {offset} do not fit into {buffer.size} bytes in fours"
            )
        if raw.size:
            self.wgpu.queue.write_buffer(buffer, offset, raw)

    def read(self, buffer: Any, dtype: Any, shape: Sequence[int] | int) -> np.ndarray:
        """Copy a buffer back as an array of `dtype` and `shape`; waits until the work before it is done."""
        shape = (shape,) if isinstance(shape, int) else tuple(shape)
        read = BufferRead(buffer, np.dtype(dtype), shape)
        return read_back(self, [read])[0] if read.nbytes else np.zeros(shape, dtype)

    def wait(self) -> None:
        """Block until everything submitted so far is done."""
        if "fence" not in self.cache:
            self.cache["fence"] = self.buffer(16, "storage", "fence")
        self.read(self.cache["fence"], np.uint32, 1)

    # ---- textures ------------------------------------------------------------------------------------------

    def texture(
        self,
        array: np.ndarray | None = None,
        *,
        size: Sequence[int] | None = None,
        format: str = "rgba32float",
        dimension: str = "2d",
        layers: int = 1,
        mips: int = 1,
        usage: Iterable[str] = ("sample", "copy"),
        label: str = "",
    ) -> Any:
        """Create a texture, filled from `array` when given.

        array : (H, W, C), (L, H, W, C) when `layers` > 1, or (Z, Y, X[, C]) when dimension is "3d".
        size : (width, height[, depth]) when there is no array.
        usage : any of "sample", "copy", "render", "storage"; copies are always allowed.

        Raises
        ------
        PellucidError : when it is more than the device allows or has left, or the array does not fit the format.
        """
        import wgpu

        flags = {
            "sample": wgpu.TextureUsage.TEXTURE_BINDING,
            "copy": wgpu.TextureUsage.COPY_SRC | wgpu.TextureUsage.COPY_DST,
            "render": wgpu.TextureUsage.RENDER_ATTACHMENT,
            "storage": wgpu.TextureUsage.STORAGE_BINDING,
        }
        flag = flags["copy"]
        for name in usage:
            flag |= flags[name]
        extent = self._extent(array, size, dimension, layers)
        self._check_texture_size(extent, dimension, label)
        with self.memory(label or "texture", f"{' x '.join(map(str, extent))} texels of {format}"):
            texture = self.wgpu.create_texture(
                size=extent, format=format, dimension=dimension, mip_level_count=mips, usage=flag, label=label
            )
        if array is not None:
            self.write_texture(texture, array)
        return texture

    @staticmethod
    def _extent(
        array: np.ndarray | None, size: Sequence[int] | None, dimension: str, layers: int
    ) -> tuple[int, int, int]:
        if array is None:
            assert size is not None
            w, h, *rest = size
            return int(w), int(h), int(rest[0]) if rest else layers
        if dimension == "3d":
            return array.shape[2], array.shape[1], array.shape[0]
        if array.ndim == 4:
            return array.shape[2], array.shape[1], array.shape[0]
        return array.shape[1], array.shape[0], 1

    def _check_texture_size(self, extent: tuple[int, int, int], dimension: str, label: str) -> None:
        side = self.limits[f"max-texture-dimension-{dimension}"]
        depth = side if dimension == "3d" else self.limits["max-texture-array-layers"]
        if min(extent) < 1 or max(extent[:2]) > side or extent[2] > depth:
            raise PellucidError(
                f"{label or 'texture'}: {' x '.join(map(str, extent))} texels; "
                f"this device allows 1 x 1 x 1 to {side} x {side} x {depth}"
            )

    def write_texture(self, texture: Any, array: np.ndarray, layer: int = 0, mip: int = 0) -> None:
        """Fill one level of a texture: all of a 3D one, all layers with a stack of them, or else one layer.

        Raises
        ------
        PellucidError : when the array has not the size or the channels of the level, or is not bytes for bytes.
        """
        dtype, channels = TEXEL[texture.format]
        is_stack = texture.dimension == "3d" or array.ndim == 4
        depth, height, width = array.shape[:3] if is_stack else (1, *array.shape[:2])
        level = max(1, texture.height >> mip), max(1, texture.width >> mip)
        if (height, width) != level or array.size != depth * height * width * channels:
            where = f"{texture.label or 'texture'}: an array of shape {array.shape}"
            raise PellucidError(f"{where} does not fill {level} texels of {texture.format}, {channels} channels each")
        if dtype is np.uint8 and array.dtype != np.uint8:
            # Radiance cast to bytes would be black without a word.
            raise PellucidError(f"{texture.label or 'texture'}: {texture.format} takes uint8, not {array.dtype}")
        data: np.ndarray = np.ascontiguousarray(array, dtype=dtype)
        self.wgpu.queue.write_texture(
            {"texture": texture, "mip_level": mip, "origin": (0, 0, layer)},
            data,
            {"bytes_per_row": width * channels * data.itemsize, "rows_per_image": height},
            (width, height, depth),
        )

    def read_texture(self, texture: Any, layer: int = 0, mip: int = 0) -> np.ndarray:
        """Copy one layer (of a 3D texture: one slice) and level back as (H, W, C)."""
        return read_back(self, [TextureRead(texture, layer, mip)])[0]

    def sampler(self, filter: str = "linear", address: Any = "clamp", compare: str | None = None) -> Any:
        """A sampler; `address` is "clamp", "repeat" or one of them for each of u, v, w."""
        modes = (address,) * 3 if isinstance(address, str) else tuple(address)
        key = (filter, modes, compare)
        if key not in self._samplers:
            names = {"clamp": "clamp-to-edge", "repeat": "repeat", "mirror": "mirror-repeat"}
            options: dict[str, Any] = {f"address_mode_{axis}": names[m] for axis, m in zip("uvw", modes, strict=True)}
            if compare:
                options["compare"] = compare
            self._samplers[key] = self.wgpu.create_sampler(
                mag_filter=filter, min_filter=filter, mipmap_filter=filter, **options
            )
        return self._samplers[key]
