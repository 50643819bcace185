"""Call any WGSL function on arrays: the way in for tests, parity checks and the curious."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from pellucid.errors import PellucidError
from pellucid.gpu.device import Device
from pellucid.gpu.kernel import _Pipeline
from pellucid.gpu.modules import ModuleSource, _used_bindings, compile_source, source

_ALIASES = {"vec2<f32>": "vec2f", "vec3<f32>": "vec3f", "vec4<f32>": "vec4f", "mat4x4<f32>": "mat4x4f"}
_WORDS = {"f32": 1, "u32": 1, "i32": 1, "bool": 1, "vec2f": 2, "vec3f": 3, "vec4f": 4}


def probe(module: str, function: str, *arrays: Any, device: Device | None = None) -> np.ndarray:
    """Evaluate a WGSL function once per row of its arguments.

    Parameters
    ----------
    module : path under the package without suffix, such as ``optics/fresnel``.
    function : a function of scalars and vectors that it defines (or imports) and that needs no bindings.
    arrays : one per argument: (N,) for scalars, (N, k) for vectors; scalars and single rows are repeated.

    Returns
    -------
    (N,) or (N, k) float32 (bool and integer results in their own type); a struct result is a structured array.

    Raises
    ------
    PellucidError : when the function does not exist or the arguments do not fit.
    """
    device = device or Device.create()
    assembled = source(module)
    arguments, result = _signature(assembled.text, function)
    if len(arrays) != len(arguments):
        raise PellucidError(f"{module}: {function} takes {len(arguments)} arguments, got {len(arrays)}")
    columns, count = _columns(arguments, arrays, f"{module}: {function}")
    members = _members(assembled.text, result)
    text = _driver(assembled.text, function, arguments, members, result)
    words = sum(_WORDS[kind] for _, kind in members)
    pipeline = _ProbePipeline(device, ModuleSource(module, text, _pad(assembled, text), _used_bindings(text)))
    out = device.buffer(4 * words * count)
    pipeline.run(count, {"probe_in": device.buffer(columns), "probe_out": out})
    raw = device.read(out, np.uint32, (count, words))
    return _unpack(raw, members, single=not _struct_body(assembled.text, result))


def _signature(text: str, function: str) -> tuple[list[str], str]:
    match = re.search(rf"\bfn\s+{function}\s*\(([^)]*)\)\s*->\s*([\w<>]+)", text)
    if not match:
        raise PellucidError(f"no function '{function}' with a result was found")
    kinds = [part.split(":")[1].strip() for part in match[1].split(",") if ":" in part]
    return [_ALIASES.get(k, k) for k in kinds], _ALIASES.get(match[2], match[2])


def _struct_body(text: str, kind: str) -> str | None:
    match = re.search(rf"\bstruct\s+{kind}\s*\{{([^}}]*)\}}", text)
    return match[1] if match else None


def _members(text: str, kind: str) -> list[tuple[str, str]]:
    body = _struct_body(text, kind)
    if body is None:
        return [("value", kind)]
    body = re.sub(r"//[^\n]*", "", body)
    pairs = [part.split(":") for part in re.split(r",", body) if ":" in part]
    return [(name.split()[-1].strip(), _ALIASES.get(k.strip(), k.strip())) for name, k in pairs]


def _columns(kinds: list[str], arrays: tuple[Any, ...], where: str) -> tuple[np.ndarray, int]:
    flat = []
    for kind, array in zip(kinds, arrays, strict=True):
        width = _WORDS[kind]
        numpy_type = {"u32": np.uint32, "i32": np.int32, "bool": np.uint32}.get(kind, np.float32)
        values = np.asarray(array).astype(numpy_type)
        values = values.reshape(-1, width) if width > 1 else values.reshape(-1, 1)
        flat.append(values.view(np.uint32))
    count = max((v.shape[0] for v in flat), default=1)
    if any(v.shape[0] not in (1, count) for v in flat):
        raise PellucidError(f"{where}: arguments have different lengths")
    return np.ascontiguousarray(np.concatenate([np.broadcast_to(v, (count, v.shape[1])) for v in flat], axis=1)), count


def _load(kind: str, at: int) -> str:
    word = "probe_in[base + {}u]".format
    if kind == "bool":
        return f"({word(at)} != 0u)"
    if kind == "u32":
        return word(at)
    if kind == "i32":
        return f"bitcast<i32>({word(at)})"
    parts = ", ".join(f"bitcast<f32>({word(at + k)})" for k in range(_WORDS[kind]))
    return parts if kind == "f32" else f"{kind}({parts})"


def _store(kind: str, name: str, at: int) -> str:
    if kind == "bool":
        return f"probe_out[to + {at}u] = select(0u, 1u, {name});"
    if _WORDS[kind] == 1:
        return f"probe_out[to + {at}u] = bitcast<u32>({name});"
    return " ".join(f"probe_out[to + {at + k}u] = bitcast<u32>({name}.{'xyzw'[k]});" for k in range(_WORDS[kind]))


def _driver(text: str, function: str, kinds: list[str], members: list[tuple[str, str]], result: str) -> str:
    offsets = np.cumsum([0] + [_WORDS[k] for k in kinds])
    calls = ", ".join(_load(k, int(at)) for k, at in zip(kinds, offsets, strict=False))
    stores, at = [], 0
    whole = _struct_body(text, result) is None
    for name, kind in members:
        stores.append(_store(kind, "result" if whole else f"result.{name}", at))
        at += _WORDS[kind]
    return text + (
        "@group(0) @binding(0) var<storage, read> probe_in: array<u32>;\n"
        "@group(0) @binding(1) var<storage, read_write> probe_out: array<u32>;\n"
        "@compute @workgroup_size(64)\n"
        "fn probe_main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) wg: vec3u) {\n"
        "  let row = id.x + id.y * wg.x * 64u;\n"
        f"  if (row >= arrayLength(&probe_out) / {at}u) {{ return; }}\n"
        f"  let base = row * {int(offsets[-1])}u; let to = row * {at}u;\n"
        f"  let result = {function}({calls});\n  {' '.join(stores)}\n}}\n"
    )


def _pad(assembled: ModuleSource, text: str) -> tuple[tuple[str, int], ...]:
    extra = text.count("\n") + 1 - len(assembled.lines)
    return assembled.lines + (("(probe)", 0),) * max(extra, 0)


class _ProbePipeline(_Pipeline):
    """A pipeline of assembled text that is in no file."""

    def __init__(self, device: Device, module: ModuleSource) -> None:
        self.device, self.module, self.label = device, module, f"probe {module.name}"
        self.shader = compile_source(device, module)
        self._layouts, self.groups, self._bound = [], [list(module.bindings)], {}
        self.pipeline = device.wgpu.create_compute_pipeline(
            layout="auto", compute={"module": self.shader, "entry_point": "probe_main"}
        )
        self._layouts = [self.pipeline.get_bind_group_layout(0)]

    def run(self, count: int, bindings: dict[str, Any]) -> None:
        encoder = self.device.wgpu.create_command_encoder()
        compute = encoder.begin_compute_pass()
        compute.set_pipeline(self.pipeline)
        self.bind(compute, bindings)
        groups = -(-count // 64)
        compute.dispatch_workgroups(min(groups, 32768), -(-groups // 32768))
        compute.end()
        self.device.wgpu.queue.submit([encoder.finish()])


def _unpack(raw: np.ndarray, members: list[tuple[str, str]], single: bool) -> np.ndarray:
    columns, at = {}, 0
    for name, kind in members:
        width = _WORDS[kind]
        block = np.ascontiguousarray(raw[:, at : at + width])
        at += width
        if kind == "bool":
            values: np.ndarray = block != 0
        else:
            values = block.view({"u32": np.uint32, "i32": np.int32}.get(kind, np.float32))
        columns[name] = values[:, 0] if width == 1 else values
    if single:
        return columns["value"]
    out = np.zeros(raw.shape[0], dtype=[(n, v.dtype, v.shape[1:]) for n, v in columns.items()])
    for name, values in columns.items():
        out[name] = values
    return out
