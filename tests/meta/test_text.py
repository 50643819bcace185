"""What the source says: citations that resolve, nothing left for later, names that mean something."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "src" / "pellucid"
BIBLIOGRAPHY = ROOT / "docs" / "references.bib"
SOURCES = sorted([*PACKAGE.rglob("*.py"), *PACKAGE.rglob("*.wgsl")])
WRITTEN = sorted(
    path
    for folder in ("src", "docs", "examples", "tools", "bench")
    for path in (ROOT / folder).rglob("*")
    if path.suffix in {".py", ".wgsl", ".md", ".sh", ".toml"}
)

CITING = [*WRITTEN, ROOT / "README.md"]

# [timonen2006, eq. 14; born1999, 1.5.1] or (key iec61966): keys stand first in the brackets, or after a semicolon.
KEY = re.compile(r"^([a-z][a-z-]*[0-9]{4,5}[a-z]?)(?:,|$)")
NAMED_KEY = re.compile(r"\bkey ([a-z][a-z-]*[0-9]{4,5}[a-z]?)\b")
UNFINISHED = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b|\b(?i:placeholder)\b")
EMPTY_NAMES = {"utils", "util", "helper", "helpers", "misc", "manager", "common", "stuff"}


def cited_keys(text: str) -> set[str]:
    pieces = [piece.strip() for inside in re.findall(r"\[([^\[\]]*)\]", text) for piece in inside.split(";")]
    keys = {match[1] for piece in pieces if (match := KEY.match(" ".join(piece.split())))}
    return keys | set(NAMED_KEY.findall(text))


def bibliography_keys() -> list[str]:
    return re.findall(r"^\s*@\w+\{\s*([^,\s]+)\s*,", BIBLIOGRAPHY.read_text(encoding="utf-8"), flags=re.MULTILINE)


def test_every_citation_is_in_the_bibliography() -> None:
    known = set(bibliography_keys())
    missing = {p.relative_to(ROOT): cited_keys(p.read_text(encoding="utf-8")) - known for p in CITING}
    assert [f"{path}: {key}" for path, keys in missing.items() for key in sorted(keys)] == []


def test_bibliography_keys_are_unique() -> None:
    keys = bibliography_keys()
    assert keys and len(keys) == len(set(keys))


def test_the_laws_and_methods_cite_their_sources() -> None:
    for room in ("optics", "techniques"):
        texts = [p.read_text(encoding="utf-8") for p in SOURCES if room in p.relative_to(PACKAGE).parts]
        assert set().union(*map(cited_keys, texts)), f"nothing in {room} cites a source"


def test_the_citation_pattern() -> None:
    text = "[born1999, 1.5.1; timonen2006] [0, 1] [a, b] x[index2] [walter2007,\n eq. 33] [lambda; n] (key iec61966)"
    assert cited_keys(text) == {"born1999", "timonen2006", "walter2007", "iec61966"}


def test_nothing_is_left_for_later() -> None:
    found = [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()}"
        for path in WRITTEN
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)
        if UNFINISHED.search(line)
    ]
    assert found == []


def test_file_names_mean_something() -> None:
    assert [p for p in SOURCES if not EMPTY_NAMES.isdisjoint(p.stem.lower().split("_"))] == []
