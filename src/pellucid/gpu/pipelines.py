"""Kernels and render passes that are made when they are first wanted, and kept."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from pellucid.gpu.device import Device
from pellucid.gpu.kernel import ComputeKernel, RenderPass
from pellucid.gpu.modules import declared


class _Key(NamedTuple):
    kind: type[Any]
    module: str
    nearest: tuple[str, ...]
    constants: str
    options: str


class Pipelines:
    """Kernels and render passes, each made once for its module, its options and those constants that it declares.

    Parameters
    ----------
    device : where they are made.
    nearest : names of textures that hold 32-bit floats and are only read texel by texel.
    shared : kept with the device, for all on it that ask for the same; else they go with this object.
    """

    def __init__(self, device: Device, nearest: Sequence[str] = (), shared: bool = False) -> None:
        self.device = device
        self._nearest = tuple(nearest)
        self._made: dict[Any, Any] = device.cache if shared else {}

    def __len__(self) -> int:
        """How many were made."""
        return sum(isinstance(key, _Key) for key in self._made)

    def kernel(self, module: str, constants: Mapping[str, float] | None = None, entry: str = "main") -> ComputeKernel:
        """A compute kernel; of the constants those count that the module declares."""
        made: ComputeKernel = self._kept(ComputeKernel, module, constants, {"entry": entry})
        return made

    def draw(self, module: str, constants: Mapping[str, float] | None = None, **options: Any) -> RenderPass:
        """A render pass, with options of `RenderPass`; of the constants those count that the module declares."""
        made: RenderPass = self._kept(RenderPass, module, constants, options)
        return made

    def _kept(
        self, kind: type[Any], module: str, constants: Mapping[str, float] | None, options: dict[str, Any]
    ) -> Any:
        used = declared(module, constants or {})
        # Options are numbers, names and lists of them: equal ones are spelled alike.
        key = _Key(kind, module, self._nearest, *(repr(sorted(given.items())) for given in (used, options)))
        if key not in self._made:
            self._made[key] = kind(self.device, module, constants=used, nearest=self._nearest, **options)
        return self._made[key]
