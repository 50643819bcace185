"""WGSL modules: imports resolved once each, errors reported in our file and line.

Two directives, each alone on its line:

- ``//!import optics/fresnel`` includes ``src/pellucid/optics/fresnel.wgsl`` (and what that imports) once.
- ``//!struct FrameParams from surroundings.layouts`` writes the struct of that NumPy dtype.
"""

from __future__ import annotations

import importlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from pellucid.errors import ShaderError
from pellucid.gpu.layout import wgsl_struct

ROOT = Path(__file__).resolve().parent.parent
_IMPORT = re.compile(r"^\s*//!import\s+(\S+)\s*$")
_STRUCT = re.compile(r"^\s*//!struct\s+(\w+)\s+from\s+([\w.]+)\s*$")
_DIRECTIVE = re.compile(r"^\s*//!")
_OVERRIDE = re.compile(r"\boverride (\w+):")
_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_BINDING = re.compile(
    r"((?:@(?:group|binding)\s*\(\s*\d+[iu]?\s*\)\s*){2})"
    r"var\s*(?:<\s*([\w\s,]+?)\s*>)?\s*(\w+)\s*:\s*([^;]+);"
)


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
def source(name: str, root: Path = ROOT) -> ModuleSource:
    """Assemble a module by its path under `root` (the package), without the suffix (``optics/fresnel``).

    Raises
    ------
    ShaderError : when a file or a struct that it names does not exist, or a directive cannot be read.
    """
    text: list[str] = []
    lines: list[tuple[str, int]] = []
    _include(root, name, ("", 0), set(), text, lines)
    joined = "\n".join(text) + "\n"
    return ModuleSource(name, joined, tuple(lines), _used_bindings(joined))


def declared(module: str, constants: Mapping[str, float]) -> dict[str, float]:
    """Of override constants those that a module declares: a pipeline takes no others."""
    known = _overrides(module)
    return {name: value for name, value in constants.items() if name in known}


@cache
def _overrides(module: str) -> frozenset[str]:
    return frozenset(_OVERRIDE.findall(source(module).text))


def _include(
    root: Path, name: str, wanted_at: tuple[str, int], seen: set[str], text: list[str], lines: list[tuple[str, int]]
) -> None:
    if name in seen:
        return
    seen.add(name)
    path = root / f"{name}.wgsl"
    if not path.is_file():
        raise ShaderError(*(wanted_at if wanted_at[0] else (str(path), 0)), f"no WGSL module is called '{name}'")
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        place = (f"{name}.wgsl", number)
        if match := _IMPORT.match(line):
            _include(root, match[1], place, seen, text, lines)
        elif match := _STRUCT.match(line):
            if (key := f"struct {match[1]} from {match[2]}") in seen:
                continue
            seen.add(key)
            text.append(_struct_text(match[1], match[2], place))
            lines.append(place)
        elif _DIRECTIVE.match(line):
            raise ShaderError(
                *place, f"cannot read '{line.strip()}'; write //!import NAME or //!struct NAME from MODULE"
            )
        else:
            text.append(line)
            lines.append(place)


def _struct_text(struct: str, module: str, place: tuple[str, int]) -> str:
    try:
        return wgsl_struct(struct, getattr(importlib.import_module(f"pellucid.{module}"), struct))
    except (ImportError, AttributeError, ValueError) as error:
        raise ShaderError(*place, f"no layout '{struct}' in pellucid.{module}: {error}") from error


def _used_bindings(text: str) -> tuple[Binding, ...]:
    code = without_comments(text)
    found = []
    for attributes, space, name, kind in _BINDING.findall(code):
        if len(re.findall(rf"\b{name}\b", code)) > 1:
            at = {word: int(number) for word, number in re.findall(r"@(\w+)\s*\(\s*(\d+)", attributes)}
            found.append(Binding(name, at["group"], at["binding"], _packed(space), _packed(kind)))
    return tuple(found)


def without_comments(text: str) -> str:
    """WGSL without its comments; the lines stay where they are."""
    return _COMMENT.sub(lambda match: "\n" * match[0].count("\n"), text)


def _packed(text: str) -> str:
    return "".join(text.split()).rstrip(",").replace(",>", ">")


def compile_module(device: Any, module: str | ModuleSource) -> Any:
    """Compile a module, by name or assembled, for a `Device`; cached on the device.

    Raises
    ------
    ShaderError : naming our file and line.
    """
    assembled = source(module) if isinstance(module, str) else module
    key = ("module", assembled)
    if key not in device.cache:
        device.cache[key] = _compile(device, assembled)
    return device.cache[key]


def _compile(device: Any, module: ModuleSource) -> Any:
    import wgpu

    try:
        return device.wgpu.create_shader_module(code=module.text, label=module.name)
    except wgpu.GPUError as error:
        raise located(module, str(error)) from None


def located(module: ModuleSource, message: str, entry: str = "") -> ShaderError:
    """Turn a compiler's message about the assembled text into a ShaderError about our file.

    What is said of a whole pipeline names no line: then the constant that it quotes, or the entry point, is the place.
    """
    quoted = re.findall(r"'(\w+)'", message)
    number = (
        _reported_line(message)
        or next((n for name in quoted if (n := _line_of(module, rf"override\s+{name}"))), 0)
        or (_line_of(module, rf"fn\s+{entry}") if entry else 0)
    )
    path, line = module.lines[min(number, len(module.lines)) - 1] if number else (f"{module.name}.wgsl", 1)
    return ShaderError(path, line, _core_message(message))


def _line_of(module: ModuleSource, pattern: str) -> int:
    code = without_comments(module.text)
    found = re.search(rf"\b{pattern}\b", code)
    return 1 + code.count("\n", 0, found.start()) if found else 0


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
