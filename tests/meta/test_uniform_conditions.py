"""Conditions that hang on uniforms alone: the software driver builds a shader for their values.

lavapipe puts the values of such uniforms into the shader and optimises it again: once for every new value, and at worst
at every dispatch, where one takes less than a millisecond and the other tens of them. What does not change while
pictures are drawn belongs into an `override` constant; a `select` has no condition; and a bound that also asks
something else, such as `arrayLength`, is no uniform.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2] / "src" / "pellucid"
SHADERS = sorted(PACKAGE.rglob("*.wgsl"))

# Condition by file -> why it stays.
ALLOWED = {
    (
        "techniques/eikonal/shaders/hull.wgsl",
        "k < volume.proxy_plane_count",
    ): "planes of a body, of which most have few",
    ("techniques/eikonal/shaders/light_start.wgsl", "!HAS_MESHES || light.casts == 0u || light.inside != 0u"): (
        "spares four rays a patch; a lamp seldom goes into matter"
    ),
    ("techniques/eikonal/shaders/light_start.wgsl", "!HANDS_ON || light.inside != 0u"): "spares 64 rays a patch",
    ("techniques/eikonal/shaders/light_others.wgsl", "k < MOST_OTHERS && others.half[k].x > 0.0"): (
        "bodies of the scene, which stay as they are"
    ),
}

WORDS = {"true", "false", "let", "var", "u32", "i32", "f32", "bool", "vec2f", "vec3f", "vec4f", "vec2u", "vec2i"}
BUILT_IN = {"min", "max", "abs", "select", "any", "all", "clamp", "floor", "ceil", "dot", "length"}
UNIFORM = re.compile(r"var<uniform>\s+(\w+)")
CONDITION = re.compile(r"\b(if|while|switch|for)\b")
LOCAL = re.compile(r"\b(?:let|var)\s+(\w+)\s*(?::[^=;]+)?=\s*([^;]+);")
TOKEN = re.compile(r"(?<![\w.])([A-Za-z_]\w*)")


def code_of(path: Path) -> str:
    return re.sub(r"//[^\n]*", "", path.read_text(encoding="utf-8"))


def functions(code: str) -> Iterator[str]:
    """The text of each function, from its name to the next one."""
    starts = [match.start() for match in re.finditer(r"\bfn\s+\w+", code)]
    yield from (code[a:b] for a, b in pairwise([*starts, len(code)]))


def conditions(function: str) -> Iterator[tuple[str, set[str]]]:
    """Each condition, and the name that its loop counts with."""
    for match in CONDITION.finditer(function):
        rest = function[match.end() :]
        depth, end = 0, 0
        while end < len(rest) and (rest[end] != "{" or depth):
            depth += {"(": 1, ")": -1}.get(rest[end], 0)
            end += 1
        head = rest[:end].strip()
        if match[1] == "for":
            begin, head, _ = head.strip("()").split(";") if head.count(";") == 2 else ("", "", "")
            yield " ".join(head.split()), set(re.findall(r"var (\w+)", begin))
        elif head:
            bare = head[1:-1] if re.fullmatch(r"\((?:[^()]|\([^()]*\))*\)", head) else head
            yield " ".join(bare.split()), set()


def hangs_on(expression: str, uniforms: set[str], ignored: set[str]) -> bool:
    """Whether an expression asks uniforms, and nothing else but constants."""
    names = {name for name in TOKEN.findall(expression) if name not in WORDS | BUILT_IN | ignored}
    names = {name for name in names if not re.fullmatch(r"[A-Z][A-Z0-9_]*", name)}
    return bool(names) and names <= uniforms


def found_in(path: Path, uniforms: set[str]) -> Iterator[str]:
    for function in functions(code_of(path)):
        own = dict(LOCAL.findall(function))
        parameters = set(re.findall(r"(\w+)\s*:", function.partition("{")[0]))
        known = uniforms - set(own) - parameters
        for name, value in own.items():  # what is made of uniforms alone is one
            assigned = re.search(rf"\b{name}\s*[-+*/|&]?=(?!=)", function.replace(f"{name} =", "", 1))
            if not assigned and hangs_on(value, known, set()):
                known = known | {name}
        yield from (text for text, counters in conditions(function) if hangs_on(text, known, counters))


def found() -> set[tuple[str, str]]:
    uniforms = {name for path in SHADERS for name in UNIFORM.findall(code_of(path))}
    return {(str(path.relative_to(PACKAGE)), text) for path in SHADERS for text in found_in(path, uniforms)}


def test_conditions_on_uniforms_alone_are_known() -> None:
    unknown = found() - set(ALLOWED)
    assert not unknown, "\n".join(f"{path}: {text}" for path, text in sorted(unknown))


def test_what_is_allowed_is_still_there() -> None:
    assert set(ALLOWED) <= found()


def test_the_judge_tells_right_from_wrong(tmp_path: Path) -> None:
    shader = tmp_path / "a.wgsl"
    shader.write_text(
        "fn a(u: u32) { if u > 1u { return; } }\n"
        "fn b() { let n = u.count; for (var k = 0u; k < n; k++) { if u.flag != 0u && k > 2u { x(); } } }\n"
        "fn c(id: vec3u) { if (any(id.xy >= u.size)) { return; } while k < min(u.n, arrayLength(&z)) { } }\n"
        "fn d() { switch u.kind { default: { } } if (SMALL || u.flag == 0u) { } }\n"
    )
    assert set(found_in(shader, {"u"})) == {"k < n", "u.kind", "SMALL || u.flag == 0u"}
