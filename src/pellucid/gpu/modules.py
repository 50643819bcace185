"""WGSL modules: imports resolved once each, errors reported in our file and line.

Two directives, each alone on its line:

- ``//!import optics/fresnel`` includes ``src/pellucid/optics/fresnel.wgsl`` (and what that imports) once.
- ``//!struct FrameParams from surroundings.layouts`` writes the struct of that NumPy dtype.
"""

from __future__ import annotations

import importlib
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from pellucid.errors import ShaderError
from pellucid.gpu.layout import wgsl_struct

ROOT = Path(__file__).resolve().parent.parent
_IMPORT = re.compile(r"^\s*//!import\s+(\S+)\s*$")
_STRUCT = re.compile(r"^\s*//!struct\s+(\w+)\s+from\s+([\w.]+)\s*$")
_BINDING = re.compile(r"@group\((\d+)\)\s*@binding\((\d+)\)\s*var\s*(?:<\s*([\w\s,]+?)\s*>)?\s*(\w+)\s*:\s*([^;]+);")


@dataclass(frozen=True)
class Binding:
    """One `@group(g) @binding(b) var` declaration."""

    name: str
    group: int
    binding: int
    space: str
    type: str


@dataclass(frozen=True)
class ModuleSource:
    """A module with its imports pasted in; `lines[i]` is the (file, line) that line i of `text` came from."""

    name: str
    text: str
    lines: tuple[tuple[str, int], ...]
    bindings: tuple[Binding, ...]


@cache
def source(name: str) -> ModuleSource:
    """Assemble a module by its path under the package, without the suffix (``optics/fresnel``).

    Raises
    ------
    ShaderError : when a file or a struct that it names does not exist.
    """
    text: list[str] = []
    lines: list[tuple[str, int]] = []
    _include(name, ("", 0), set(), text, lines)
    joined = "\n".join(text) + "\n"
    return ModuleSource(name, joined, tuple(lines), _used_bindings(joined))


def _include(
    name: str, wanted_at: tuple[str, int], seen: set[str], text: list[str], lines: list[tuple[str, int]]
) -> None:
    if name in seen:
        return
    seen.add(name)
    path = ROOT / f"{name}.wgsl"
    if not path.is_file():
        raise ShaderError(*(wanted_at if wanted_at[0] else (str(path), 0)), f"no WGSL module is called '{name}'")
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        place = (f"{name}.wgsl", number)
        if match := _IMPORT.match(line):
            _include(match[1], place, seen, text, lines)
        elif match := _STRUCT.match(line):
            if f"struct {match[1]}" in seen:
                continue
            seen.add(f"struct {match[1]}")
            text.append(_struct_text(match[1], match[2], place))
            lines.append(place)
        else:
            text.append(line)
            lines.append(place)


def _struct_text(struct: str, module: str, place: tuple[str, int]) -> str:
    try:
        return wgsl_struct(struct, getattr(importlib.import_module(f"pellucid.{module}"), struct))
    except (ImportError, AttributeError, ValueError) as error:
        raise ShaderError(*place, f"no layout '{struct}' in pellucid.{module}: {error}") from error


def _used_bindings(text: str) -> tuple[Binding, ...]:
    code = re.sub(r"//[^\n]*", "", text)
    found = []
    for group, binding, space, name, kind in _BINDING.findall(code):
        if len(re.findall(rf"\b{name}\b", code)) > 1:
            found.append(Binding(name, int(group), int(binding), space.replace(" ", ""), kind.replace(" ", "")))
    return tuple(found)


def compile_module(device: Any, name: str) -> Any:
    """Compile a module for a `Device`; cached on the device.

    Raises
    ------
    ShaderError : naming our file and line.
    """
    key = ("module", name)
    if key not in device.cache:
        device.cache[key] = compile_source(device, source(name))
    return device.cache[key]


def compile_source(device: Any, module: ModuleSource) -> Any:
    """Compile assembled text; errors are mapped back to the files that it was assembled from."""
    import wgpu

    try:
        return device.wgpu.create_shader_module(code=module.text, label=module.name)
    except wgpu.GPUError as error:
        raise located(module, str(error)) from None


def located(module: ModuleSource, message: str) -> ShaderError:
    """Turn a compiler's message about the assembled text into a ShaderError about our file."""
    number = _reported_line(message)
    path, line = module.lines[min(max(number, 1), len(module.lines)) - 1] if number else (module.name, 0)
    return ShaderError(path, line, _core_message(message))


def _reported_line(message: str) -> int:
    # The compiler frames a whole function and marks the culprit inside it with carets: prefer that line.
    current = 0
    for line in message.splitlines():
        if match := re.match(r"^\s*(\d+)\s*│", line):
            current = int(match[1])
        elif current and re.search(r"│.*\s\^+", line) and "╰" not in line:
            return current
    match = re.search(r"┌─ \S*?:(\d+):\d+", message)
    return int(match[1]) if match else 0


def _core_message(message: str) -> str:
    kept = [line.strip() for line in message.splitlines() if line.strip()]
    kept = [line for line in kept if not line.startswith(("Validation Error", "Caused by", "In wgpu"))]
    return " | ".join(kept[:12])
