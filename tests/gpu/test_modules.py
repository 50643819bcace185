"""WGSL modules: imports, errors at our file and line, bindings by name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from pellucid.errors import ShaderError
from pellucid.gpu.modules import ModuleSource, compile_module, source

if TYPE_CHECKING:
    from pellucid.gpu import Device

MAIN = "@compute @workgroup_size(1)\nfn main() {}\n"


def test_imports_come_once_each_and_depth_first(assemble: Callable[..., ModuleSource]) -> None:
    module = assemble(
        "//!import left\n//!import right\nconst top = 1;\n",
        left="//!import base\nconst left = 1;\n",
        right="// why\n//!import base\n//!import left\nconst right = 1;\n",
        base="//!import top\nconst base = 1;\n",
    )
    assert [line for line in module.text.splitlines() if line.startswith("const")] == [
        "const base = 1;",
        "const left = 1;",
        "const right = 1;",
        "const top = 1;",
    ]
    assert module.lines == (("base.wgsl", 2), ("left.wgsl", 2), ("right.wgsl", 1), ("right.wgsl", 4), ("top.wgsl", 3))


def test_a_struct_comes_from_its_dtype_once(assemble: Callable[..., ModuleSource]) -> None:
    directive = "//!struct QueryRay from surroundings.layouts\n"
    module = assemble(f"//!import other\n{directive}const top = 1;\n", other=directive)
    assert module.text.count("struct QueryRay { origin: vec3f, t_max: f32, direction: vec3f }") == 1
    assert module.lines == (("other.wgsl", 1), ("top.wgsl", 3))


@pytest.mark.parametrize(
    ("directive", "said"),
    [
        ("//!import nowhere", "no WGSL module is called 'nowhere'"),
        ("//!struct Nothing from surroundings.layouts", "no layout 'Nothing' in pellucid.surroundings.layouts"),
        ("//!struct QueryRay from surroundings.nowhere", "no layout 'QueryRay' in pellucid.surroundings.nowhere"),
        ("//!struct MATERIAL_SINGLE_SIDED from surroundings.layouts", "no layout 'MATERIAL_SINGLE_SIDED'"),
        ("//!import other // why", "cannot read '//!import other // why'"),
        ("//!include other", "cannot read '//!include other'"),
    ],
)
def test_a_wrong_directive_is_reported_where_it_stands(
    directive: str, said: str, assemble: Callable[..., ModuleSource]
) -> None:
    with pytest.raises(ShaderError) as caught:
        assemble("//!import middle\n", middle=f"// a line\n\n{directive}\n", other="")
    assert (caught.value.path, caught.value.line) == ("middle.wgsl", 3)
    assert said in caught.value.message


def test_an_unknown_module_names_the_file_that_is_missing(tmp_path: Path) -> None:
    with pytest.raises(ShaderError, match=r"nowhere\.wgsl:0: no WGSL module is called 'nowhere'"):
        source("nowhere", tmp_path)


@pytest.mark.parametrize(
    ("body", "line"),
    [
        ("fn f() -> f32 {\n  let a = 1.0;\n\n  let b: u32 = a;\n  return a;\n}\n", 5),
        ("fn f() -> f32 {\n  let a = 1.0;\n\n\n  return vec2f(a);\n}\n", 6),
        ("fn f() -> f32 {\n  return missing;\n}\n", 3),
        ("fn f() -> f32 {\n  let a = 1.0\n  return a;\n}\n", 4),
        ("fn g(x: f32) -> f32 { return x; }\nfn f() -> f32 {\n  let b = g(1u);\n  return b;\n}\n", 4),
        ("\nstruct S { a: nothing }\n", 3),
    ],
)
def test_an_error_in_an_imported_file_is_reported_there(
    body: str, line: int, device: Device, assemble: Callable[..., ModuleSource]
) -> None:
    before = "".join(f"const before_{i} = {i};\n" for i in range(7))
    module = assemble(
        f"//!import first\n//!import broken\n{MAIN}",
        first=before,
        broken=f"//!import last\n{body}",
        last="const last = 1;\n",
    )
    with pytest.raises(ShaderError) as caught:
        compile_module(device, module)
    assert (caught.value.path, caught.value.line) == ("broken.wgsl", line)


def test_an_error_after_the_imports_is_reported_in_the_file_itself(
    device: Device, assemble: Callable[..., ModuleSource]
) -> None:
    module = assemble("//!import first\n\nfn f() -> f32 { return 1u; }\n", first="const a = 1;\n" + "\n" * 9)
    with pytest.raises(ShaderError, match=r"^top\.wgsl:3: "):
        compile_module(device, module)


def test_two_layouts_of_one_name_are_an_error_not_a_choice(
    device: Device, assemble: Callable[..., ModuleSource], monkeypatch: pytest.MonkeyPatch
) -> None:
    import pellucid.surroundings.layouts as first
    import pellucid.techniques.finish.passes as second

    monkeypatch.setattr(second, "QueryRay", first.QueryHit, raising=False)
    module = assemble(
        "//!struct QueryRay from surroundings.layouts\n//!struct QueryRay from techniques.finish.passes\n" + MAIN
    )
    with pytest.raises(ShaderError, match="redefinition of `QueryRay`"):
        compile_module(device, module)


def test_a_module_is_compiled_once(device: Device, assemble: Callable[..., ModuleSource]) -> None:
    module = assemble(MAIN)
    assert compile_module(device, module) is compile_module(device, module)


def test_bindings_are_read_from_the_text(assemble: Callable[..., ModuleSource]) -> None:
    module = assemble(
        "@group(0) @binding(3) var<uniform> a: A;\n"
        "@binding(1) @group(2)\nvar<storage, read_write> b: array<vec4<f32>>;\n"
        "@group(1) @binding(0) var c: texture_storage_2d< rgba16float, write >;\n"
        "@group(0) @binding(4) var<storage> d: array<f32, 4,>;\n"
        "@group(0) @binding(5) var unused: sampler;\n"
        "// @group(0) @binding(6) var commented: sampler; commented unused\n"
        "/* @group(0) @binding(7) var also: sampler;\n also */\n"
        "fn f() { a; b; c; d; }\n"
    )
    found = [(b.name, b.group, b.binding, b.space, b.type) for b in module.bindings]
    assert found == [
        ("a", 0, 3, "uniform", "A"),
        ("b", 2, 1, "storage,read_write", "array<vec4<f32>>"),
        ("c", 1, 0, "", "texture_storage_2d<rgba16float,write>"),
        ("d", 0, 4, "storage", "array<f32,4>"),
    ]
