"""Call any WGSL function on arrays: the way in for tests, parity checks and the curious."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from pellucid.errors import PellucidError
from pellucid.gpu.device import Device
from pellucid.gpu.kernel import ComputeKernel
from pellucid.gpu.modules import Binding, ModuleSource, source, without_comments

_BASES = {"f": "f32", "u": "u32", "i": "i32"}
_WORDS = {"f32": 1, "u32": 1, "i32": 1, "bool": 1} | {f"vec{n}{b}": n for n in (2, 3, 4) for b in _BASES}
_ALIASES = {f"vec{n}<{long}>": f"vec{n}{short}" for n in (2, 3, 4) for short, long in _BASES.items()}
_NUMPY = {"f32": np.float32, "u32": np.uint32, "i32": np.int32, "bool": np.uint32}
# The last group that every device has: the lower ones are free for what the module declares.
_GROUP = 3
_BINDINGS = (
    Binding("probe_in", _GROUP, 0, "storage,read", "array<u32>"),
    Binding("probe_out", _GROUP, 1, "storage,read_write", "array<u32>"),
)

Members = list[tuple[str, str]]


def probe(module: str | ModuleSource, function: str, *arrays: Any, device: Device | None = None) -> np.ndarray:
    """Evaluate a WGSL function once per row of its arguments.

    Parameters
    ----------
    module : path under the package without suffix, such as ``optics/fresnel``; or an assembled module.
    function : a function of scalars and vectors that it defines (or imports) and that needs no bindings.
    arrays : one per argument: (N,) for scalars, (N, k) for vectors; scalars and single rows are repeated.

    Returns
    -------
    (N,) or (N, k) float32 (bool and integer results in their own type); a struct result is a structured array.

    Raises
    ------
    PellucidError : when the function does not exist, needs bindings, or the arguments do not fit.
    """
    device = device or Device.create()
    assembled = source(module) if isinstance(module, str) else module
    where = f"{assembled.name}: {function}"
    code = without_comments(assembled.text)
    arguments, result = _signature(code, function, where)
    members = _members(code, result, where)
    columns, count = _columns(arguments, arrays, where)
    words = sum(_WORDS[kind] for _, kind in members)
    if not count:
        return _unpack(np.zeros((0, words), np.uint32), members)
    kernel = _kernel(device, assembled, function, arguments, members)
    # The first word is the number of rows: buffers are rounded up, and what is past the rows is not to be run.
    given = np.concatenate([np.array([count], np.uint32), columns.reshape(-1)])
    out = device.buffer(4 * words * count)
    groups = -(-count // 64)
    kernel.run((min(groups, 32768), -(-groups // 32768), 1), {"probe_in": device.buffer(given), "probe_out": out})
    return _unpack(device.read(out, np.uint32, (count, words)), members)


def _kernel(
    device: Device, assembled: ModuleSource, function: str, arguments: list[str], members: Members
) -> ComputeKernel:
    key = ("probe", assembled, function)
    if key not in device.cache:
        driver = _driver(function, arguments, members)
        lines = assembled.lines + (("(probe)", 1),) * driver.count("\n")
        text = ModuleSource(assembled.name, assembled.text + driver, lines, _BINDINGS)
        device.cache[key] = ComputeKernel(device, text, entry="probe_main")
    return device.cache[key]


def _signature(code: str, function: str, where: str) -> tuple[list[str], str]:
    match = re.search(rf"\bfn\s+{re.escape(function)}\s*\(([^)]*)\)\s*->\s*(\w+(?:\s*<[^{{]*>)?)", code)
    if not match:
        raise PellucidError(f"{where}: no function of this name with a result was found")
    return [_kind(kind, where) for _, kind in _declared(match[1])], _spelled(match[2])


def _declared(text: str) -> list[tuple[str, str]]:
    """(name, type) of each `name: type` in a list of arguments or members; commas inside < > part nothing."""
    pairs = [part.split(":") for part in re.split(r",(?![^<]*>)", text) if ":" in part]
    return [(name.split()[-1], _spelled(kind)) for name, kind in pairs]


def _spelled(kind: str) -> str:
    kind = "".join(kind.split())
    return _ALIASES.get(kind, kind)


def _kind(kind: str, where: str) -> str:
    if kind not in _WORDS:
        raise PellucidError(f"{where}: {kind} cannot be probed; scalars and vectors can")
    return kind


def _base(kind: str) -> str:
    return _BASES[kind[-1]] if kind.startswith("vec") else kind


def _members(code: str, result: str, where: str) -> Members:
    """Parts of a result; one without a name when it is no struct."""
    match = re.search(rf"\bstruct\s+{re.escape(result)}\s*\{{([^}}]*)\}}", code)
    if not match:
        return [("", _kind(result, where))]
    return [(name, _kind(kind, where)) for name, kind in _declared(match[1])]


def _columns(kinds: list[str], arrays: tuple[Any, ...], where: str) -> tuple[np.ndarray, int]:
    """Arguments as the words of each row, and the number of rows."""
    if len(arrays) != len(kinds):
        raise PellucidError(f"{where} takes {len(kinds)} arguments, got {len(arrays)}")
    if not kinds:
        return np.zeros((1, 0), np.uint32), 1
    flat = [
        _words(kind, array, f"{where}, argument {i}")
        for i, (kind, array) in enumerate(zip(kinds, arrays, strict=True), 1)
    ]
    lengths = {len(v) for v in flat} - {1}
    if len(lengths) > 1:
        raise PellucidError(f"{where}: arguments have different lengths: {', '.join(str(len(v)) for v in flat)}")
    count = lengths.pop() if lengths else 1
    return np.concatenate([np.broadcast_to(v, (count, v.shape[1])) for v in flat], axis=1), count


def _words(kind: str, array: Any, where: str) -> np.ndarray:
    width = _WORDS[kind]
    values = np.asarray(array)
    row_shape = (width,) if width > 1 else ()
    if values.ndim > len(row_shape) + 1 or values.shape[values.ndim - len(row_shape) :] != row_shape:
        rows = f"(N, {width})" if width > 1 else "(N,)"
        raise PellucidError(f"{where} is {kind}: give {rows} or one row, not {values.shape}")
    return np.ascontiguousarray(values.reshape(-1, width).astype(_NUMPY[_base(kind)])).view(np.uint32)


def _load(kind: str, at: int) -> str:
    words = [f"probe_in[base + {at + k}u]" for k in range(_WORDS[kind])]
    if kind == "bool":
        return f"({words[0]} != 0u)"
    cast = "" if _base(kind) == "u32" else f"bitcast<{_base(kind)}>"
    return f"{kind}({', '.join(f'{cast}({word})' for word in words)})"


def _store(kind: str, value: str, at: int) -> str:
    if kind == "bool":
        return f"probe_out[to + {at}u] = select(0u, 1u, {value});"
    parts = [value] if _WORDS[kind] == 1 else [f"{value}.{axis}" for axis in "xyzw"[: _WORDS[kind]]]
    return " ".join(f"probe_out[to + {at + k}u] = bitcast<u32>({part});" for k, part in enumerate(parts))


def _driver(function: str, kinds: list[str], members: Members) -> str:
    """WGSL that calls the function once per row."""
    starts = np.cumsum([0] + [_WORDS[k] for k in kinds])
    calls = ", ".join(_load(k, int(at)) for k, at in zip(kinds, starts, strict=False))
    stores, at = [], 0
    for name, kind in members:
        stores.append(_store(kind, f"probed.{name}" if name else "probed", at))
        at += _WORDS[kind]
    return (
        f"@group({_GROUP}) @binding(0) var<storage, read> probe_in: array<u32>;\n"
        f"@group({_GROUP}) @binding(1) var<storage, read_write> probe_out: array<u32>;\n"
        "@compute @workgroup_size(64)\n"
        "fn probe_main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) wg: vec3u) {\n"
        "  let row = id.x + id.y * wg.x * 64u;\n"
        "  if (row >= probe_in[0]) { return; }\n"
        f"  let base = 1u + row * {int(starts[-1])}u; let to = row * {at}u;\n"
        f"  let probed = {function}({calls});\n  {' '.join(stores)}\n}}\n"
    )


def _unpack(raw: np.ndarray, members: Members) -> np.ndarray:
    columns, at = {}, 0
    for name, kind in members:
        block = np.ascontiguousarray(raw[:, at : at + _WORDS[kind]])
        at += _WORDS[kind]
        values: np.ndarray = block != 0 if kind == "bool" else block.view(_NUMPY[_base(kind)])
        columns[name] = values[:, 0] if _WORDS[kind] == 1 else values
    if "" in columns:
        return columns[""]
    out = np.zeros(raw.shape[0], dtype=[(n, v.dtype, v.shape[1:]) for n, v in columns.items()])
    for name, values in columns.items():
        out[name] = values
    return out
