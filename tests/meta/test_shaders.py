"""Shader files: each compiles alone with its imports; each law of optics is written twice, under the same names."""

from __future__ import annotations

import ast
import importlib
import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from pellucid.gpu import Device

PACKAGE = Path(__file__).resolve().parents[2] / "src" / "pellucid"
OPTICS = PACKAGE / "optics"
SHADERS = sorted(str(p.relative_to(PACKAGE).with_suffix("")) for p in PACKAGE.rglob("*.wgsl"))
LAYOUTS = sorted(
    ".".join(("pellucid", *p.relative_to(PACKAGE).with_suffix("").parts)) for p in PACKAGE.rglob("layouts.py")
)
LAWS = sorted({p.stem for p in OPTICS.iterdir() if p.suffix in {".py", ".wgsl"} and p.stem != "__init__"})

# They take the field as a function, and WGSL has no function values: its techniques call the parts (drift, kick).
PYTHON_ONLY = {"leapfrog_step", "euler_step", "hamiltonian_step"}


@pytest.mark.parametrize("name", SHADERS)
def test_a_shader_compiles_alone_with_its_imports(name: str, device: Device) -> None:
    from pellucid.gpu.modules import compile_module

    compile_module(device, name)


@pytest.mark.parametrize("law", LAWS)
def test_a_law_is_a_pair_of_files(law: str) -> None:
    assert (OPTICS / f"{law}.py").is_file()
    assert (OPTICS / f"{law}.wgsl").is_file()


@pytest.mark.parametrize("law", LAWS)
def test_every_function_of_a_law_has_its_twin(law: str) -> None:
    shader = wgsl_functions(OPTICS / f"{law}.wgsl")
    assert shader, f"{law}.wgsl defines no function"
    assert shader == python_functions(OPTICS / f"{law}.py") - PYTHON_ONLY


def test_numbers_of_layouts_are_the_same_in_shaders() -> None:
    """Constants of the same name, and those whose comment names one: `const ROWS = 32u;  // layouts.ENTRIES`."""
    known = {name: value for module in LAYOUTS for name, value in vars(importlib.import_module(module)).items()}
    line = re.compile(r"^const (\w+)(?:: \w+)? = ([\d.]+)[uif]?;(?:  // (?:\w+\.)*layouts\.(\w+))?", re.MULTILINE)
    found = {
        (path.stem, named or name, float(value))
        for path in PACKAGE.rglob("*.wgsl")
        for name, value, named in line.findall(path.read_text(encoding="utf-8"))
        if named or name in known
    }
    assert len(found) > 10
    assert {(shader, name, known.get(name)) for shader, name, _ in found} == found


def python_functions(path: Path) -> set[str]:
    body = ast.parse(path.read_text(encoding="utf-8")).body
    return {n.name for n in body if isinstance(n, ast.FunctionDef) and not n.name.startswith("_")}


def wgsl_functions(path: Path) -> set[str]:
    code = re.sub(r"//[^\n]*", "", path.read_text(encoding="utf-8"))
    return {name for name in re.findall(r"\bfn\s+(\w+)", code) if not name.startswith("_")}
