"""Who may know whom: the arrows between the rooms of the package, in Python and in WGSL."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "src" / "pellucid"

# Room -> rooms that it may import besides itself. `errors` is open to all. A new room is added here, knowingly.
ARROWS: dict[str, set[str]] = {
    "errors": set(),
    "optics": set(),
    "media": set(),
    "spectra": set(),
    "fields": {"optics", "media"},
    "io": set(),
    "scene": {"media", "fields", "io"},
    "gpu": set(),
    "simulation": {"fields", "gpu"},  # fields in motion, for any technique
    "surroundings": {"optics", "fields", "scene", "gpu"},
    "techniques": {"optics", "spectra", "fields", "scene", "gpu", "surroundings", "simulation"},
    "frame": {"techniques", "surroundings", "scene", "gpu", "optics", "io"},  # it encodes and saves pictures
    "renderer": {"techniques", "surroundings", "scene", "gpu", "frame"},
}
EDGE = {
    "animation",
    "__init__",
    "__main__",
    "session",
    "cli",
    "view",
    "cluster",
    "benchmarks",
    "demo",
    "gallery",
}  # nobody imports these; they may import all

# Third-party packages that only some rooms may touch, even lazily.
KEPT_TO: dict[str, set[str]] = {
    "wgpu": {"gpu", "surroundings", "techniques", "renderer"} | EDGE,
    "trimesh": {"io"},
    "OpenImageIO": {"io"},
    "av": {"io"},
    "typer": EDGE,
    "rich": EDGE,
}


def room_of(dotted: str) -> str:
    """``pellucid.techniques.eikonal.passes`` -> ``techniques/eikonal``; ``pellucid.optics.snell`` -> ``optics``."""
    parts = dotted.split(".")[1:]
    if not parts:
        return "__init__"
    if parts[0] == "techniques" and len(parts) > 1 and (PACKAGE / "techniques" / parts[1]).is_dir():
        return f"techniques/{parts[1]}"
    return parts[0]


def module_of(path: Path) -> str:
    parts = ["pellucid", *path.relative_to(PACKAGE).with_suffix("").parts]
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def is_module(dotted: str) -> bool:
    path = PACKAGE.joinpath(*dotted.split(".")[1:])
    return path.is_dir() or path.with_suffix(".py").is_file()


def python_imports(path: Path) -> Iterator[tuple[int, str]]:
    """Line and dotted name of every import, those inside functions too; names are resolved to modules."""
    module = module_of(path)
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                above = package.split(".")[: len(package.split(".")) - node.level + 1]
                base = ".".join([*above, base] if base else above)
            for alias in node.names:
                inner = f"{base}.{alias.name}"
                yield node.lineno, inner if base.startswith("pellucid") and is_module(inner) else base


def wgsl_imports(path: Path) -> Iterator[tuple[int, str]]:
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        if match := re.match(r"\s*//!import\s+(\S+)", line):
            yield number, "pellucid." + match[1].replace("/", ".")
        elif match := re.match(r"\s*//!struct\s+\w+\s+from\s+(\S+)", line):
            yield number, "pellucid." + match[1]


def allowed(importer: str, imported: str) -> bool:
    if importer in EDGE or importer == imported or imported == "errors":
        return True
    if importer.startswith("techniques/") and imported == "techniques":
        return True  # what all techniques share lies beside their folders
    known = ARROWS[importer.partition("/")[0]]
    if imported.startswith("techniques/"):
        return "techniques" in known and not importer.startswith("techniques")
    return imported in known


SOURCES = sorted([*PACKAGE.rglob("*.py"), *PACKAGE.rglob("*.wgsl")])


def imports(path: Path) -> list[tuple[int, str]]:
    return list(python_imports(path) if path.suffix == ".py" else wgsl_imports(path))


@pytest.mark.parametrize("path", SOURCES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_a_file_imports_only_rooms_it_may_know(path: Path) -> None:
    importer = room_of(module_of(path))
    assert importer in EDGE or importer.partition("/")[0] in ARROWS, f"a new room: add {importer} to ARROWS"
    wrong = [
        f"{path.relative_to(PACKAGE)}:{line} imports {name}"
        for line, name in imports(path)
        if name.partition(".")[0] == "pellucid" and not allowed(importer, room_of(name))
    ]
    assert not wrong, "\n".join(wrong)


def test_third_party_packages_stay_in_their_rooms() -> None:
    wrong = [
        f"{path.relative_to(PACKAGE)}:{line} imports {name}"
        for path in SOURCES
        for line, name in imports(path)
        if (room := room_of(module_of(path)).partition("/")[0]) not in KEPT_TO.get(name.partition(".")[0], {room})
    ]
    assert not wrong, "\n".join(wrong)


def test_the_arrows_have_no_cycle() -> None:
    done: set[str] = {"errors"}
    while ready := {room for room, known in ARROWS.items() if room not in done and known <= done}:
        done |= ready
    assert done == set(ARROWS)


def test_the_judge_tells_right_from_wrong() -> None:
    assert allowed("fields", "optics") and allowed("renderer", "techniques/eikonal")
    assert not allowed("optics", "fields")
    assert not allowed("techniques/eikonal", "techniques/opaque")
    assert not allowed("gpu", "scene") and not allowed("scene", "__init__")
