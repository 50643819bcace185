"""Any WGSL function on arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
import pytest

from pellucid.errors import PellucidError, ShaderError
from pellucid.gpu.probe import probe

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.gpu.modules import ModuleSource

FUNCTIONS = """
struct Mixed { a: f32, @align(16) v: vec3<f32>, yes: bool, // a: comment, here
  n: u32, i: i32 }
@group(0) @binding(0) var<uniform> elsewhere: vec4f;
fn sum(a: f32, b: f32) -> f32 { return a + b; }
fn weighted(v: vec3f, w: f32) -> vec3<f32> { return v * w; }
fn swapped(v: vec2f) -> vec2f { return v.yx; }
// fn hidden(a: f32) -> f32 in a comment is no function
fn mixed(v: vec4f, n: u32, i: i32, yes: bool) -> Mixed {
  return Mixed(v.w, v.xyz, !yes, n + 1u, -i);
}
fn whole(v: vec3<u32>,
         w: vec2i) -> vec4i { return vec4i(vec3i(v), w.x * w.y); }
fn is_big(a: f32) -> bool { return a > 2.0; }
fn nothing() -> f32 { return 7.0; }
fn silent(a: f32) { }
fn from_elsewhere(a: f32) -> f32 { return a + elsewhere.x; }
fn of_matrix(m: mat4x4f) -> f32 { return m[0][0]; }
fn of_array(a: array<f32, 3>) -> f32 { return a[0]; }
fn to_matrix(a: f32) -> mat2x2f { return mat2x2f(a, a, a, a); }
fn row_of(base: u32, to: u32) -> u32 { return base - to; }
"""


@pytest.fixture
def on(device: Device, assemble: Callable[..., ModuleSource]) -> Callable[..., np.ndarray]:
    module = assemble(FUNCTIONS)
    return lambda function, *arrays: probe(module, function, *arrays, device=device)


def test_scalars_in_more_rows_than_a_group_and_a_buffer_has(on: Callable[..., np.ndarray]) -> None:
    a, b = np.arange(131, dtype=np.float32), np.linspace(0, 1, 131, dtype=np.float32)
    found = on("sum", a, b)
    assert found.shape == (131,) and found.dtype == np.float32
    np.testing.assert_array_equal(found, a + b)


def test_rows_in_more_groups_than_one_dimension_has(on: Callable[..., np.ndarray]) -> None:
    a = np.arange(32768 * 64 + 5, dtype=np.uint32)
    np.testing.assert_array_equal(on("row_of", a, 0), a)


def test_vectors_and_scalars_are_repeated(on: Callable[..., np.ndarray]) -> None:
    v = np.arange(12.0).reshape(4, 3)
    np.testing.assert_array_equal(on("weighted", v, 2.0), 2 * v)
    np.testing.assert_array_equal(on("weighted", v[1], np.arange(3.0)), v[1] * np.arange(3.0)[:, None])
    np.testing.assert_array_equal(on("weighted", v[:1], np.ones(2)), v[[0, 0]])
    assert on("sum", 1.0, 2.0).tolist() == [3.0]
    assert on("swapped", [1.0, 2.0]).tolist() == [[2.0, 1.0]]


def test_structs_come_back_as_records(on: Callable[..., np.ndarray]) -> None:
    v = np.arange(8.0).reshape(2, 4)
    found = on("mixed", v, np.array([0, 2**32 - 2]), np.array([-5, 2**31 - 1]), np.array([True, False]))
    np.testing.assert_array_equal(found["a"], v[:, 3])
    np.testing.assert_array_equal(found["v"], v[:, :3])
    assert found["yes"].tolist() == [False, True]
    assert found["n"].tolist() == [1, 2**32 - 1]
    assert found["i"].tolist() == [5, -(2**31) + 1]
    assert [found.dtype[name] for name in ("yes", "n", "i")] == [np.bool_, np.uint32, np.int32]


def test_whole_numbers_truths_and_no_arguments(on: Callable[..., np.ndarray]) -> None:
    found = on("whole", [[1, 2, 3], [4, 5, 6]], [[2, -3], [4, 5]])
    assert found.dtype == np.int32 and found.tolist() == [[1, 2, 3, -6], [4, 5, 6, 20]]
    found = on("is_big", [1.0, 3.0])
    assert found.dtype == np.bool_ and found.tolist() == [False, True]
    assert on("nothing").tolist() == [7.0]


def test_no_rows_give_none(on: Callable[..., np.ndarray]) -> None:
    assert on("sum", np.zeros(0), 1.0).shape == (0,)
    assert on("weighted", np.zeros((0, 3)), np.zeros(0)).shape == (0, 3)
    empty = on("mixed", np.zeros((0, 4)), 1, 1, True)
    assert empty.shape == (0,) and empty.dtype["v"].shape == (3,)


@pytest.mark.parametrize(
    ("function", "arrays", "said"),
    [
        ("sum", ([1.0],), "top: sum takes 2 arguments, got 1"),
        ("nothing", ([1.0],), "top: nothing takes 0 arguments, got 1"),
        ("sum", ([1.0, 2.0], [1.0, 2.0, 3.0]), "top: sum: arguments have different lengths: 2, 3"),
        ("sum", ([], [1.0, 2.0]), "top: sum: arguments have different lengths: 0, 2"),
        ("absent", ([1.0],), "top: absent: no function of this name with a result"),
        ("hidden", ([1.0],), "top: hidden: no function of this name with a result"),
        ("silent", ([1.0],), "top: silent: no function of this name with a result"),
        ("weighted", (np.zeros((3, 4)), 1.0), r"top: weighted, argument 1 is vec3f: give \(N, 3\) or one row"),
        ("weighted", (np.zeros(6), 1.0), r"argument 1 is vec3f: give \(N, 3\) or one row, not \(6,\)"),
        ("sum", (np.zeros((2, 2)), 1.0), r"argument 1 is f32: give \(N,\) or one row, not \(2, 2\)"),
        ("of_matrix", (np.zeros(16),), "mat4x4f cannot be probed"),
        ("of_array", (np.zeros(3),), "array<f32,3> cannot be probed"),
        ("to_matrix", (1.0,), "mat2x2f cannot be probed"),
    ],
)
def test_what_does_not_fit_is_said(on: Callable[..., np.ndarray], function: str, arrays: tuple, said: str) -> None:
    with pytest.raises(PellucidError, match=said):
        on(function, *arrays)


def test_a_function_that_needs_bindings_is_refused(on: Callable[..., np.ndarray]) -> None:
    with pytest.raises(ShaderError, match=r"^top\.wgsl:|\(probe\)"):
        on("from_elsewhere", 1.0)


def test_a_law_of_the_package_by_name(device: Device) -> None:
    # At normal incidence R = ((n - 1)/(n + 1))^2 = 0.04 for n = 1.5 (Fresnel).
    assert probe("optics/fresnel", "fresnel_dielectric", 1.0, 1.0, 1.5, device=device)[0] == pytest.approx(0.04)
