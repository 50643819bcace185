"""A dtype of `struct` against the rules of WGSL, by hand and by a kernel that reads it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
import pytest

from pellucid.gpu.layout import struct, wgsl_struct

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.gpu.modules import ModuleSource

# (fields, offsets, size) worked out by hand from W3C WGSL, "Alignment and Size" and "Structure Member Layout".
BY_HAND = {
    "scalar after vec3f fills its hole": ([("a", "vec3f"), ("b", "f32"), ("c", "f32")], [0, 12, 16], 32),
    "vec3f after scalar leaves a hole": ([("a", "f32"), ("b", "vec3f"), ("c", "u32")], [0, 16, 28], 32),
    "vec2f aligns to 8": ([("a", "f32"), ("b", "vec2f"), ("c", "i32")], [0, 8, 16], 24),
    "scalars alone are packed": ([("a", "f32"), ("b", "u32"), ("c", "i32")], [0, 4, 8], 12),
    "arrays and matrices": (
        [("a", "u32"), ("m", "mat4x4f"), ("b", "f32"), ("s", ("vec4f", 3)), ("n", "mat3x3f"), ("c", "vec2u")],
        [0, 16, 80, 96, 144, 192],
        208,
    ),
}


@pytest.mark.parametrize("case", BY_HAND)
def test_offsets_by_hand(case: str) -> None:
    fields, offsets, size = BY_HAND[case]
    dtype = struct(fields)
    assert dtype.fields is not None
    assert [dtype.fields[name][1] for name, _ in fields] == offsets
    assert dtype.itemsize == size


@pytest.mark.parametrize("case", BY_HAND)
def test_the_compiler_lays_it_out_alike(case: str, device: Device, assemble: Callable[..., ModuleSource]) -> None:
    """Every number of every field, in the second element of an array: offsets and stride are both right."""
    from pellucid.gpu import ComputeKernel

    dtype = struct(BY_HAND[case][0])
    components = [c for field, kind in dtype.metadata["wgsl"] for c in wgsl_components(f"given[1].{field}", kind)]
    stores = "\n".join(f"  found[{i}] = f32({c});" for i, c in enumerate(components))
    module = assemble(
        f"{wgsl_struct('Given', dtype)}\n"
        "@group(0) @binding(0) var<storage, read> given: array<Given>;\n"
        "@group(0) @binding(1) var<storage, read_write> found: array<f32>;\n"
        f"@compute @workgroup_size(1)\nfn main() {{\n{stores}\n}}\n"
    )
    records, expected = np.zeros(2, dtype), []
    for field, kind in dtype.metadata["wgsl"]:
        values = np.arange(records[field][1].size) + 1 + len(expected)
        records[field][1] = values.reshape(records[field][1].shape)
        used = values.reshape(3, 4)[:, :3] if kind == "mat3x3f" else values
        expected += list(used.reshape(-1))
    out = device.buffer(4 * len(expected))
    ComputeKernel(device, module).run((1, 1, 1), {"given": device.buffer(records), "found": out})
    np.testing.assert_array_equal(device.read(out, np.float32, len(expected)), expected)


def wgsl_components(value: str, kind: str) -> list[str]:
    """Expressions of the numbers of a value, in the order of its bytes."""
    if kind.startswith("array<"):
        inner, count = kind[6:-1].split(", ")
        return [c for k in range(int(count)) for c in wgsl_components(f"{value}[{k}]", inner)]
    if kind.startswith("mat"):
        return [f"{value}[{column}][{row}]" for column in range(int(kind[3])) for row in range(int(kind[5]))]
    if kind.startswith("vec"):
        return [f"{value}.{axis}" for axis in "xyzw"[: int(kind[3])]]
    return [value]


def test_a_transposed_matrix_multiplies_as_numpy_does(device: Device, assemble: Callable[..., ModuleSource]) -> None:
    from pellucid.gpu import ComputeKernel

    dtype = struct([("m", "mat4x4f"), ("v", "vec4f")])
    module = assemble(
        f"{wgsl_struct('Given', dtype)}\n"
        "@group(0) @binding(0) var<uniform> given: Given;\n"
        "@group(0) @binding(1) var<storage, read_write> found: vec4f;\n"
        "@compute @workgroup_size(1) fn main() { found = given.m * given.v; }\n"
    )
    matrix, vector = np.arange(16.0).reshape(4, 4), np.array([1.0, -2.0, 3.0, 0.5])
    record = np.zeros((), dtype)
    record["m"], record["v"] = matrix.T, vector
    out = device.buffer(16)
    ComputeKernel(device, module).run((1, 1, 1), {"given": device.buffer(record, "uniform"), "found": out})
    np.testing.assert_array_equal(device.read(out, np.float32, 4), matrix @ vector)


def test_text_of_the_struct() -> None:
    dtype = struct([("origin", "vec3f"), ("t", "f32"), ("sh", ("vec4f", 9))])
    assert wgsl_struct("Ray", dtype) == "struct Ray { origin: vec3f, t: f32, sh: array<vec4f, 9> }"


def test_a_foreign_dtype_has_no_text() -> None:
    with pytest.raises(ValueError, match="Ray: the dtype was not made by"):
        wgsl_struct("Ray", np.dtype([("t", np.float32)]))


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ([("a", ("f32", 4))], "a: an array of 4 f32 is not allowed in uniforms"),
        ([("a", ("vec3f", 4))], "a: an array of 4 vec3f is not allowed in uniforms"),
        ([("a", ("vec4f", 0))], "a: an array of 0 vec4f is not allowed in uniforms"),
        ([("a", "vec5f")], "a: no type 'vec5f'; there are f32"),
        ([], "no empty structs"),
    ],
)
def test_what_uniforms_do_not_allow_is_refused(fields: list, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        struct(fields)
