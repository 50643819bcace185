"""A thin layer over wgpu: devices, WGSL modules, layouts, kernels, timing. It knows nothing of optics."""

from pellucid.gpu.device import Device, adapter_remedy, list_adapters
from pellucid.gpu.kernel import ComputeKernel, RenderPass
from pellucid.gpu.layout import struct, wgsl_struct
from pellucid.gpu.modules import compile_module, source
from pellucid.gpu.pipelines import Pipelines
from pellucid.gpu.probe import probe
from pellucid.gpu.timing import PassTimer

__all__ = [
    "ComputeKernel", "Device", "PassTimer", "Pipelines", "RenderPass", "adapter_remedy", "compile_module",
    "list_adapters", "probe", "source", "struct", "wgsl_struct",
]  # fmt: skip
