"""Compute kernels and render passes whose resources are bound by the name that the WGSL declares."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from pellucid.errors import PellucidError
from pellucid.gpu.device import Device
from pellucid.gpu.modules import Binding, ModuleSource, compile_module, located, source

Bindings = Mapping[str, Any]

# Bind groups that a pipeline keeps: several views of one frame take turns with it.
GROUPS_KEPT = 12


class _Pipeline:
    """What compute and render share: module, explicit layouts made from the declarations, bind groups by name."""

    def __init__(self, device: Device, module: str | ModuleSource, stages: int, nearest: Sequence[str]) -> None:
        self.device = device
        self.module = source(module) if isinstance(module, str) else module
        self.label = self.module.name
        self.shader = compile_module(device, self.module)
        self.groups: list[list[Binding]] = [
            sorted((b for b in self.module.bindings if b.group == g), key=lambda b: b.binding)
            for g in range(1 + max((b.group for b in self.module.bindings), default=-1))
        ]
        self._layouts = [
            device.wgpu.create_bind_group_layout(entries=[_entry(device, b, stages, nearest) for b in group])
            for group in self.groups
        ]
        self.layout = device.wgpu.create_pipeline_layout(bind_group_layouts=self._layouts)
        self._bound: dict[tuple[int, ...], tuple[Any, list[Any]]] = {}

    def create(self, build: Any, entry: str, **options: Any) -> Any:
        import wgpu

        try:
            return build(layout=self.layout, label=self.label, **options)
        except wgpu.GPUError as error:
            raise located(self.module, str(error), entry) from None

    def resolve(self, bindings: Bindings) -> list[Any]:
        """Bind groups in order; called before a pass begins, so that what is wrong here leaves no pass half open."""
        missing = [b.name for group in self.groups for b in group if b.name not in bindings]
        if missing:
            raise PellucidError(f"{self.label}: nothing is bound to {', '.join(missing)}")
        return [self._group(i, group, [bindings[b.name] for b in group]) for i, group in enumerate(self.groups)]

    def _group(self, index: int, group: list[Binding], resources: list[Any]) -> Any:
        key = (index, *(id(r) for r in resources))
        if key not in self._bound:
            entries = [{"binding": b.binding, "resource": _resource(r)} for b, r in zip(group, resources, strict=True)]
            while len(self._bound) >= GROUPS_KEPT:
                del self._bound[next(iter(self._bound))]
            # The resources are kept so that no id is used again while this entry stands.
            self._bound[key] = self._make_group(index, entries), resources
        return self._bound[key][0]

    def _make_group(self, index: int, entries: list[dict[str, Any]]) -> Any:
        import wgpu

        try:
            return self.device.wgpu.create_bind_group(layout=self._layouts[index], entries=entries)
        except (wgpu.GPUError, TypeError) as error:
            reason = " ".join(str(error).split())
            names = ", ".join(f"{b.binding} {b.name}" for b in self.groups[index])
            raise PellucidError(f"{self.label}: group {index} ({names}) cannot be bound: {reason}") from error


def _resource(resource: Any) -> Any:
    kind = type(resource).__name__
    if kind == "GPUBuffer":
        return {"buffer": resource, "offset": 0, "size": resource.size}
    if kind == "GPUTexture":
        return resource.create_view()
    return resource


def _entry(device: Device, b: Binding, stages: int, nearest: Sequence[str]) -> dict[str, Any]:
    import wgpu

    entry: dict[str, Any] = {"binding": b.binding, "visibility": stages}
    if b.space == "uniform":
        entry["buffer"] = {"type": "uniform"}
    elif b.space.startswith("storage"):
        writable = "write" in b.space
        if writable:
            entry["visibility"] = stages & ~wgpu.ShaderStage.VERTEX
        entry["buffer"] = {"type": "storage" if writable else "read-only-storage"}
    elif b.type == "sampler":
        entry["sampler"] = {"type": "non-filtering" if b.name in nearest else "filtering"}
    elif b.type == "sampler_comparison":
        entry["sampler"] = {"type": "comparison"}
    elif match := re.match(r"texture_storage_(\w+)<(\w+),(\w+)>", b.type):
        entry["visibility"] = stages & ~wgpu.ShaderStage.VERTEX
        access = {"write": "write-only", "read": "read-only", "read_write": "read-write"}[match[3]]
        entry["storage_texture"] = {
            "access": access, "format": match[2], "view_dimension": match[1].replace("_", "-")
        }  # fmt: skip
    elif match := re.match(r"texture_depth_(\w+)", b.type):
        entry["texture"] = {"sample_type": "depth", "view_dimension": match[1].replace("_", "-")}
    elif match := re.match(r"texture_(\dd|\dd_array|cube|cube_array)<(f32|u32|i32)>", b.type):
        floats = "unfilterable-float" if b.name in nearest else "float"
        kind = {"f32": floats, "u32": "uint", "i32": "sint"}[match[2]]
        entry["texture"] = {"sample_type": kind, "view_dimension": match[1].replace("_", "-")}
    else:
        raise PellucidError(f"cannot bind '{b.name}: {b.type}'")
    return entry


class ComputeKernel:
    """One compute entry point.

    Parameters
    ----------
    module : path of the WGSL module under the package, without the suffix; or an assembled one.
    constants : values of its `override` constants.
    nearest : names of textures that hold 32-bit floats and are only read texel by texel, and of samplers of them.

    Raises
    ------
    ShaderError : when the module does not compile, or has not this entry point or these constants.
    """

    def __init__(
        self,
        device: Device,
        module: str | ModuleSource,
        entry: str = "main",
        constants: Mapping[str, float] | None = None,
        nearest: Sequence[str] = (),
    ) -> None:
        import wgpu

        self._pipeline = _Pipeline(device, module, wgpu.ShaderStage.COMPUTE, nearest)
        self.device = device
        stage = {
            "module": self._pipeline.shader, "entry_point": entry, "constants": dict(constants or {})
        }  # fmt: skip
        self.pipeline = self._pipeline.create(device.wgpu.create_compute_pipeline, entry, compute=stage)

    def run(
        self,
        groups: tuple[int, int, int],
        bindings: Bindings,
        encoder: Any = None,
        timer: Any = None,
        label: str = "",
        indirect: tuple[Any, int] | None = None,
    ) -> None:
        """Dispatch; encodes into `encoder`, or submits at once when there is none.

        Raises
        ------
        PellucidError : when a declared resource that the module uses is not bound, or is of another kind.
        """
        bound = self._pipeline.resolve(bindings)
        own = encoder is None
        encoder = self.device.wgpu.create_command_encoder() if own else encoder
        writes = timer.writes(label or self._pipeline.label) if timer is not None else None
        compute = encoder.begin_compute_pass(label=label, timestamp_writes=writes)
        compute.set_pipeline(self.pipeline)
        for index, group in enumerate(bound):
            compute.set_bind_group(index, group)
        if indirect is None:
            compute.dispatch_workgroups(*groups)
        else:
            compute.dispatch_workgroups_indirect(*indirect)
        compute.end()
        if own:
            self.device.wgpu.queue.submit([encoder.finish()])


class RenderPass:
    """One render pipeline and the pass that runs it.

    Parameters
    ----------
    targets : colour formats. depth : depth format or None (depth is reversed: larger is nearer).
    vertex_buffers : WebGPU vertex buffer layouts. write_mask : bits 1 2 4 8 for r g b a.

    Raises
    ------
    ShaderError : when the module does not compile, or has not these entry points or constants.
    """

    def __init__(
        self,
        device: Device,
        module: str | ModuleSource,
        vertex: str = "vs_main",
        fragment: str | None = "fs_main",
        targets: Sequence[str] = ("rgba32float",),
        depth: str | None = None,
        depth_compare: str = "greater-equal",
        depth_write: bool = True,
        depth_bias: Mapping[str, float] | None = None,
        cull: str = "none",
        write_mask: int = 15,
        vertex_buffers: Sequence[Any] = (),
        constants: Mapping[str, float] | None = None,
        topology: str = "triangle-list",
        nearest: Sequence[str] = (),
    ) -> None:
        import wgpu

        stages = wgpu.ShaderStage.VERTEX | wgpu.ShaderStage.FRAGMENT
        self._pipeline = _Pipeline(device, module, stages, nearest)
        self.device = device
        shader, values = self._pipeline.shader, dict(constants or {})
        options: dict[str, Any] = {
            "vertex": {
                "module": shader,
                "entry_point": vertex,
                "buffers": list(vertex_buffers),
                "constants": values,
            },
            "primitive": {"topology": topology, "cull_mode": cull},
        }
        if fragment is not None:
            colour = [{"format": t, "write_mask": write_mask} for t in targets]
            options["fragment"] = {
                "module": shader, "entry_point": fragment, "targets": colour, "constants": values
            }  # fmt: skip
        if depth is not None:
            options["depth_stencil"] = {
                "format": depth,
                "depth_compare": depth_compare,
                "depth_write_enabled": depth_write,
                **(depth_bias or {}),
            }
        self.pipeline = self._pipeline.create(device.wgpu.create_render_pipeline, fragment or vertex, **options)

    def run(
        self,
        encoder: Any,
        color: Sequence[Any] = (),
        depth: Any = None,
        clear: Sequence[tuple[float, float, float, float]] | None = None,
        clear_depth: float | None = None,
        bindings: Bindings | None = None,
        vertices: int = 3,
        instances: int = 1,
        vertex_buffers: Sequence[Any] = (),
        index_buffer: Any = None,
        index_count: int = 0,
        ranges: Sequence[tuple[int, int]] | None = None,
        scissor: tuple[int, int, int, int] | None = None,
        timer: Any = None,
        label: str = "",
    ) -> None:
        """Encode one pass that draws into `color` views and `depth`; what is not cleared is kept.

        `ranges` are (first vertex, number) of several draws instead of the first `vertices`.

        Raises
        ------
        PellucidError : when a declared resource that the module uses is not bound, or is of another kind.
        """
        bound = self._pipeline.resolve(bindings or {})
        attachments = []
        for i, view in enumerate(color):
            load = "load" if clear is None else "clear"
            attachment = {"view": view, "load_op": load, "store_op": "store"}
            if clear is not None:
                attachment["clear_value"] = clear[i]
            attachments.append(attachment)
        options: dict[str, Any] = {"color_attachments": attachments, "label": label}
        if depth is not None:
            options["depth_stencil_attachment"] = {
                "view": depth,
                "depth_load_op": "load" if clear_depth is None else "clear",
                "depth_store_op": "store",
                "depth_clear_value": clear_depth or 0.0,
            }
        if timer is not None:
            options["timestamp_writes"] = timer.writes(label or self._pipeline.label)
        draw = encoder.begin_render_pass(**options)
        draw.set_pipeline(self.pipeline)
        for index, group in enumerate(bound):
            draw.set_bind_group(index, group)
        if scissor is not None:
            draw.set_scissor_rect(*scissor)
        for slot, buffer in enumerate(vertex_buffers):
            draw.set_vertex_buffer(slot, buffer)
        if index_buffer is not None:
            draw.set_index_buffer(index_buffer, "uint32")
            draw.draw_indexed(index_count, instances)
        else:
            for first, count in ((0, vertices),) if ranges is None else ranges:
                draw.draw(count, instances, first)
        draw.end()
