"""Kernels and passes: resources by name, override constants, what a pass leaves in its targets."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from pellucid.errors import PellucidError, ShaderError
from pellucid.gpu.kernel import ComputeKernel, RenderPass

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.gpu.modules import ModuleSource

Assemble = Callable[..., "ModuleSource"]

SCALED = """
override FACTOR: f32 = 2.0;
override OFFSET: f32;
@group(1) @binding(2) var<storage, read> given: array<f32>;
@group(0) @binding(1) var<storage, read_write> found: array<f32>;
@group(0) @binding(0) var<uniform> unused: vec4f;

@compute @workgroup_size(4)
fn main(@builtin(global_invocation_id) id: vec3u) { found[id.x] = FACTOR * given[id.x] + OFFSET; }

@compute @workgroup_size(4)
fn other(@builtin(global_invocation_id) id: vec3u) { found[id.x] = -given[id.x] + OFFSET; }
"""

DRAWN = """
override DEPTH: f32 = 0.5;
override LEVEL: f32 = 1.0;
@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
  return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, DEPTH, 1.0);
}
@fragment fn fs_main(@builtin(position) p: vec4f) -> @location(0) vec4f { return vec4f(p.xy, LEVEL, 1.0); }
"""

WIDTH, HEIGHT = 7, 5


def scaled(device: Device, kernel: ComputeKernel, given: np.ndarray, **options: Any) -> np.ndarray:
    found = device.buffer(given.nbytes)
    kernel.run((len(given) // 4, 1, 1), {"given": device.buffer(given), "found": found}, **options)
    return device.read(found, np.float32, len(given))


def test_resources_are_bound_by_name_and_what_is_unused_is_not_asked_for(device: Device, assemble: Assemble) -> None:
    module, given = assemble(SCALED), np.arange(8, dtype=np.float32)
    with_default = ComputeKernel(device, module, constants={"OFFSET": 1.0})
    np.testing.assert_array_equal(scaled(device, with_default, given), 2 * given + 1)
    both = ComputeKernel(device, module, constants={"OFFSET": 0.5, "FACTOR": 3.0})
    np.testing.assert_array_equal(scaled(device, both, given), 3 * given + 0.5)
    other = ComputeKernel(device, module, entry="other", constants={"OFFSET": 0.0})
    np.testing.assert_array_equal(scaled(device, other, given), -given)


def test_the_same_kernel_follows_what_is_bound_to_it(device: Device, assemble: Assemble) -> None:
    kernel = ComputeKernel(device, assemble(SCALED), constants={"OFFSET": 0.0})
    for scale in (1.0, 10.0, 100.0):
        given = np.full(4, scale, np.float32)
        np.testing.assert_array_equal(scaled(device, kernel, given), 2 * given)


def test_work_goes_into_a_given_encoder_in_order(device: Device, assemble: Assemble) -> None:
    kernel = ComputeKernel(device, assemble(SCALED), constants={"OFFSET": 1.0})
    a, b = device.buffer(np.ones(4, np.float32)), device.buffer(16)
    encoder = device.wgpu.create_command_encoder()
    kernel.run((1, 1, 1), {"given": a, "found": b}, encoder=encoder)
    kernel.run((1, 1, 1), {"given": b, "found": a}, encoder=encoder)
    assert not device.read(b, np.float32, 4).any()
    device.wgpu.queue.submit([encoder.finish()])
    assert device.read(a, np.float32, 4).tolist() == [7.0] * 4


def test_the_number_of_groups_may_come_from_a_buffer(device: Device, assemble: Assemble) -> None:
    kernel = ComputeKernel(device, assemble(SCALED), constants={"OFFSET": 1.0})
    counts = device.buffer(np.array([9, 9, 9, 2, 1, 1], np.uint32), "indirect")
    given = np.zeros(12, np.float32)
    assert scaled(device, kernel, given, indirect=(counts, 12)).tolist() == [1.0] * 8 + [0.0] * 4


def test_what_is_not_bound_is_named_and_the_encoder_stays_usable(device: Device, assemble: Assemble) -> None:
    kernel = ComputeKernel(device, assemble(SCALED), constants={"OFFSET": 1.0})
    encoder, found = device.wgpu.create_command_encoder(), device.buffer(16)
    with pytest.raises(PellucidError, match=r"^top: nothing is bound to found, given$"):
        kernel.run((1, 1, 1), {}, encoder=encoder)
    with pytest.raises(PellucidError, match=r"^top: nothing is bound to given$"):
        kernel.run((1, 1, 1), {"found": found}, encoder=encoder)
    kernel.run((1, 1, 1), {"found": found, "given": device.buffer(16)}, encoder=encoder)
    device.wgpu.queue.submit([encoder.finish()])
    assert device.read(found, np.float32, 1)[0] == 1.0


def test_a_resource_of_another_kind_is_refused_by_name(device: Device, assemble: Assemble) -> None:
    kernel = ComputeKernel(device, assemble(SCALED), constants={"OFFSET": 1.0})
    for wrong in (device.buffer(16, "uniform"), device.sampler(), device.texture(size=(1, 1)), None):
        with pytest.raises(PellucidError, match=r"top: group 1 \(2 given\) cannot be bound"):
            kernel.run((1, 1, 1), {"found": device.buffer(16), "given": wrong})


@pytest.mark.parametrize(
    ("options", "line", "said"),
    [
        ({"constants": {"OFFSET": 1.0, "NOWHERE": 1.0}}, 3, "'NOWHERE' not found"),
        ({}, 2, "'OFFSET'"),
        ({"constants": {"OFFSET": 1.0}, "entry": "absent"}, 1, "'absent'"),
    ],
)
def test_what_is_wrong_with_a_pipeline_is_said_of_our_file(
    options: dict, line: int, said: str, device: Device, assemble: Assemble
) -> None:
    top = "//!import rest\n@compute @workgroup_size(1)\nfn main() { found[0] = OFFSET; }\n"
    rest = "// why\noverride OFFSET: f32;\n@group(0) @binding(0) var<storage, read_write> found: array<f32>;\n"
    with pytest.raises(ShaderError, match=said) as caught:
        ComputeKernel(device, assemble(top, rest=rest), **options)
    assert caught.value.path == ("rest.wgsl" if line == 2 else "top.wgsl")
    assert caught.value.line == line


def test_textures_and_samplers_are_bound_by_name(device: Device, assemble: Assemble) -> None:
    module = assemble(
        "@group(0) @binding(0) var picture: texture_2d<f32>;\n"
        "@group(0) @binding(1) var smooth_sampler: sampler;\n"
        "@group(0) @binding(2) var exact: texture_3d<f32>;\n"
        "@group(0) @binding(3) var written: texture_storage_2d<rgba32float, write>;\n"
        "@group(0) @binding(4) var stack: texture_2d_array<f32>;\n"
        "@compute @workgroup_size(1) fn main() {\n"
        "  let a = textureSampleLevel(picture, smooth_sampler, vec2f(0.5), 0.0).x;\n"
        "  textureStore(written, vec2i(1, 0), vec4f(a, textureLoad(exact, vec3i(0, 0, 1), 0).x, \n"
        "    textureLoad(stack, vec2i(0), 1, 0).x, 0.0));\n"
        "}\n"
    )
    kernel = ComputeKernel(device, module, nearest=("exact", "stack"))
    written = device.texture(size=(2, 1), usage=("storage",))
    stack = device.texture(np.array([5, 7], np.float32).reshape(2, 1, 1, 1), format="r32float")
    bindings = {
        "picture": device.texture(np.array([[[1.0], [3.0]]], np.float16), format="r16float"),
        "smooth_sampler": device.sampler(),
        "exact": device.texture(np.array([8, 9], np.float32).reshape(2, 1, 1), format="r32float", dimension="3d"),
        "written": written,
        "stack": stack.create_view(dimension="2d-array"),
    }
    kernel.run((1, 1, 1), bindings)
    assert device.read_texture(written)[0].tolist() == [[0.0] * 4, [2.0, 9.0, 7.0, 0.0]]


def test_a_resource_that_has_no_layout_is_named(device: Device, assemble: Assemble) -> None:
    module = assemble(
        "@group(0) @binding(0) var odd: texture_multisampled_2d<f32>;\n"
        "@compute @workgroup_size(1) fn main() { _ = textureDimensions(odd); }\n"
    )
    with pytest.raises(PellucidError, match=r"^cannot bind 'odd: texture_multisampled_2d<f32>'$"):
        ComputeKernel(device, module)


# ---- drawing ---------------------------------------------------------------------------------------------------


@pytest.fixture
def draw(device: Device, assemble: Assemble) -> Callable[..., tuple[np.ndarray, np.ndarray]]:
    """Run passes, each given as (pipeline options, run options), over one pair of targets."""
    module = assemble(DRAWN)

    def run(*passes: tuple[dict, dict]) -> tuple[np.ndarray, np.ndarray]:
        color = device.texture(size=(WIDTH, HEIGHT), usage=("render",))
        depth = device.texture(size=(WIDTH, HEIGHT), format="depth32float", usage=("render",))
        encoder = device.wgpu.create_command_encoder()
        for options, ran in passes:
            made = RenderPass(device, module, depth="depth32float", **options)
            made.run(encoder, color=[color.create_view()], depth=depth.create_view(), **ran)
        device.wgpu.queue.submit([encoder.finish()])
        return device.read_texture(color), device.read_texture(depth)[..., 0]

    return run


CLEARED = {"clear": [(-1.0, -2.0, -3.0, -4.0)], "clear_depth": 0.0}


def test_a_triangle_covers_every_pixel_once_from_the_top(draw: Callable) -> None:
    color, depth = draw(({}, CLEARED))
    x, y = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
    np.testing.assert_array_equal(color, np.stack([x, y, np.ones_like(x), np.ones_like(x)], axis=-1))
    np.testing.assert_array_equal(depth, np.full((HEIGHT, WIDTH), 0.5))


def test_nearer_is_larger(draw: Callable) -> None:
    def at(depth: float, level: float) -> dict:
        return {"constants": {"DEPTH": depth, "LEVEL": level}}

    color, depth = draw((at(0.5, 1.0), CLEARED), (at(0.25, 2.0), {}), (at(0.75, 3.0), {}))
    assert np.all(color[..., 2] == 3.0) and np.all(depth == 0.75)
    color, depth = draw((at(0.5, 1.0), CLEARED), (at(0.25, 2.0), {}), (at(0.5, 3.0), {}))
    assert np.all(color[..., 2] == 3.0) and np.all(depth == 0.5)
    unwritten = {**at(0.75, 3.0), "depth_write": False}
    color, depth = draw((at(0.5, 1.0), CLEARED), (unwritten, {}), (at(0.6, 4.0), {}))
    assert np.all(color[..., 2] == 4.0) and np.all(depth == np.float32(0.6))
    strict = {**at(0.5, 3.0), "depth_compare": "greater"}
    color, _ = draw((at(0.5, 1.0), CLEARED), (strict, {}))
    assert np.all(color[..., 2] == 1.0)


def test_only_masked_channels_are_written(draw: Callable) -> None:
    color, depth = draw(({"write_mask": 4 | 8}, CLEARED))
    assert np.all(color == [-1.0, -2.0, 1.0, 1.0]) and np.all(depth == 0.5)


def test_only_the_scissor_is_written(draw: Callable) -> None:
    color, _ = draw(({}, {**CLEARED, "scissor": (2, 1, 3, 2)}))
    inside = np.zeros((HEIGHT, WIDTH), bool)
    inside[1:3, 2:5] = True
    np.testing.assert_array_equal(color[..., 3] == 1.0, inside)


@pytest.mark.parametrize(("cull", "drawn"), [("none", True), ("back", True), ("front", False)])
def test_counter_clockwise_is_the_front(draw: Callable, cull: str, drawn: bool) -> None:
    color, _ = draw(({"cull": cull}, CLEARED))
    assert np.all(color[..., 3] == (1.0 if drawn else -4.0))


def test_vertices_indices_and_depth_alone(device: Device, assemble: Assemble) -> None:
    """A pass without a fragment stage, drawn from buffers with an index that leaves one vertex out."""
    module = assemble(
        "@vertex fn vs_main(@location(0) p: vec3f) -> @builtin(position) vec4f { return vec4f(p, 1.0); }\n"
    )
    layout = {
        "array_stride": 12,
        "step_mode": "vertex",
        "attributes": [{"format": "float32x3", "offset": 0, "shader_location": 0}],
    }
    made = RenderPass(device, module, fragment=None, targets=(), depth="depth32float", vertex_buffers=[layout])
    corners = np.array([[-1, -1, 0.25], [9, 9, 9], [3, -1, 0.25], [-1, 3, 0.25]], np.float32)
    depth = device.texture(size=(WIDTH, HEIGHT), format="depth32float", usage=("render",))
    encoder = device.wgpu.create_command_encoder()
    made.run(
        encoder,
        depth=depth.create_view(),
        clear_depth=0.0,
        vertex_buffers=[device.buffer(corners, "vertex")],
        index_buffer=device.buffer(np.array([0, 2, 3], np.uint32), "index"),
        index_count=3,
    )
    device.wgpu.queue.submit([encoder.finish()])
    np.testing.assert_array_equal(device.read_texture(depth), np.full((HEIGHT, WIDTH, 1), 0.25))


@pytest.mark.parametrize("options", [{"constants": {"NOWHERE": 1.0}}, {"fragment": "absent"}, {"vertex": "absent"}])
def test_what_is_wrong_with_a_drawing_pipeline_is_said_of_our_file(
    options: dict, device: Device, assemble: Assemble
) -> None:
    with pytest.raises(ShaderError, match=r"^top\.wgsl:\d+: .*(NOWHERE|absent)"):
        RenderPass(device, assemble(DRAWN), **options)


def test_a_pass_names_what_is_not_bound_before_it_begins(device: Device, assemble: Assemble) -> None:
    text = DRAWN.replace("LEVEL, 1.0", "LEVEL, tint").replace(
        "override DEPTH", "@group(0) @binding(0) var<uniform> tint: f32;\noverride DEPTH"
    )
    made = RenderPass(device, assemble(text))
    encoder = device.wgpu.create_command_encoder()
    view = device.texture(size=(1, 1), usage=("render",)).create_view()
    with pytest.raises(PellucidError, match=r"^top: nothing is bound to tint$"):
        made.run(encoder, color=[view])
    encoder.finish()
