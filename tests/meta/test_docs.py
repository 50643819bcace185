"""What the pages say is so: their example runs, their links lead somewhere, their commands exist."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")), *sorted((ROOT / "src").rglob("README.md"))]
LINK = re.compile(r"!?\[[^\]\[]*\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```(\w*)\n(.*?)^```", flags=re.MULTILINE | re.DOTALL)
INLINE = re.compile(r"`([^`\n]+)`")


def name(path: Path) -> str:
    return str(path.relative_to(ROOT))


def code(text: str) -> list[str]:
    """Lines of fenced blocks that are no Python, indented lines, and what stands in backquotes outside of blocks."""
    fenced = [body for language, body in FENCE.findall(text) if language != "python"]
    rest = FENCE.sub("", text)
    indented = re.findall(r"^ {4,}(\S.*)$", rest, flags=re.MULTILINE)
    return [line.strip() for body in fenced for line in body.splitlines()] + indented + INLINE.findall(rest)


def quoted(program: str) -> list[tuple[Path, list[str]]]:
    """(page, words after the program's name) of every line of code that calls the program."""
    start = re.compile(rf"^(?:\$ )?(?:\.venv/bin/)?{program} (.*)$")
    found = []
    for page in PAGES:
        for line in code(page.read_text(encoding="utf-8")):
            if call := start.match(line):
                found.append((page, shlex.split(call[1], comments=True)))
    return found


def test_the_example_of_the_readme_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocks = [body for language, body in FENCE.findall((ROOT / "README.md").read_text("utf-8")) if language == "python"]
    assert [8 <= len([line for line in block.splitlines() if line.strip()]) <= 12 for block in blocks] == [True, True]
    small = blocks[0]
    for written, tried in (("size=(800, 600)", "size=(64, 48)"), ("samples=4", "samples=1"), ("=96", "=32")):
        assert written in small
        small = small.replace(written, tried)
    monkeypatch.chdir(tmp_path)
    values: dict[str, object] = {}
    exec(compile(small, "README.md", "exec"), values)
    assert [p.name for p in tmp_path.iterdir()] == ["ball.png"]
    assert values["frame"].radiance.std() > 0.01  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("page", "number", "picture"),
    [
        ("README.md", 1, "pool.png"),
        ("docs/water.md", 0, "pool.png"),
        ("docs/water.md", 1, "shapes.png"),
        ("docs/water.md", 2, ""),
        ("docs/water.md", 3, ""),
    ],
)
def test_the_examples_of_water_run(
    page: str, number: int, picture: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    blocks = [body for language, body in FENCE.findall((ROOT / page).read_text("utf-8")) if language == "python"]
    assert len(blocks) == {"README.md": 2, "docs/water.md": 4}[page]
    small = blocks[number].replace("size=(800, 600)", "size=(48, 36)")
    assert ("size=(48, 36)" in small) == bool(picture)
    monkeypatch.chdir(tmp_path)
    values: dict[str, Any] = {}
    exec(compile(small, page, "exec"), values)
    assert [p.name for p in tmp_path.iterdir()] == ([picture] if picture else [])
    if "waves" in values and not picture:
        first, later = (values["waves"].layers[0].advance(time) for time in (1.0, 2.2))
        assert np.abs(later - first).max() > 0.003  # the boat has gone on, and something fell in


def test_the_example_of_the_page_on_light_runs(capsys: pytest.CaptureFixture[str]) -> None:
    blocks = [body for language, body in FENCE.findall((ROOT / "docs" / "light.md").read_text("utf-8")) if language]
    assert len(blocks) == 1 and "resolution=96" in blocks[0]
    values: dict[str, Any] = {}
    exec(compile(blocks[0].replace("=96", "=32"), "light.md", "exec"), values)
    light, place = values["light"], values["place"]
    assert light.flux_absorbed + light.flux_out + light.flux_ended == pytest.approx(light.flux_in, rel=1e-3)
    x, y, z = (((place[axis] + 0.5) / 32 - 0.5) * 0.1 for axis in (2, 1, 0))
    assert max(abs(x), abs(y)) < 0.1 / 32 and -0.0294 < z < -0.02  # behind the ball, not beyond the paraxial focus
    assert capsys.readouterr().out.startswith("brightest at")


def first_example(page: str, smaller: tuple[tuple[str, str], ...]) -> dict[str, Any]:
    """What the first Python block of a page leaves behind, with numbers in it made smaller."""
    text = (ROOT / "docs" / page).read_text("utf-8").split("```python\n")[1].split("```")[0]
    for written, tried in smaller:
        assert written in text
        text = text.replace(written, tried)
    values: dict[str, Any] = {}
    exec(compile(text, page, "exec"), values)
    return values


def test_the_example_of_the_page_on_reliefs_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    smaller = (("size=(800, 600)", "size=(48, 36)"), ("samples=4", "samples=1"), ("=256", "=64"))
    values = first_example("relief.md", smaller)
    assert [p.name for p in tmp_path.iterdir()] == ["puddles.png"]
    assert values["frame"].depth.max() < 4.0 and values["frame"].radiance.std() > 0.01


def test_the_example_of_the_page_on_sheets_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    smaller = (("size=(640, 480)", "size=(48, 36)"), ("samples=4", "samples=1"), ("size=512", "size=64"))
    values = first_example("sheet.md", smaller)
    assert [p.name for p in tmp_path.iterdir()] == ["sheet.png"]
    assert np.isfinite(values["frame"].depth).mean() > 0.3 and values["frame"].radiance.std() > 0.01


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_links_lead_somewhere(page: Path) -> None:
    links = [link for link in LINK.findall(page.read_text(encoding="utf-8")) if "://" not in link]
    missing = [link for link in links if not (page.parent / link.split("#")[0]).exists()]
    assert missing == []


def test_every_page_is_listed_in_the_index() -> None:
    index = ROOT / "docs" / "index.md"
    listed = {(index.parent / link).resolve() for link in LINK.findall(index.read_text(encoding="utf-8"))}
    assert [name(page) for page in PAGES if page != index and page not in listed] == []


def test_commands_are_understood() -> None:
    command = typer.main.get_command(__import__("pellucid.cli.app", fromlist=["app"]).app)
    calls = quoted("pellucid")
    assert len(calls) > 5
    for page, (first, *rest) in calls:
        if first.startswith("-"):
            continue
        sub = command.commands.get(first)  # type: ignore[attr-defined]
        assert sub is not None, f"{name(page)}: there is no `pellucid {first}`"
        if not rest:  # the name of a command, in a sentence
            continue
        try:
            sub.make_context(first, list(rest))  # parses and checks; runs nothing
        except Exception as error:
            pytest.fail(f"{name(page)}: `pellucid {first} {shlex.join(rest)}`: {error}")


def test_targets_of_make_exist() -> None:
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), flags=re.MULTILINE))
    calls = quoted("make")
    assert {"demo", "test"} <= {words[0] for _, words in calls}
    assert [(name(page), words) for page, words in calls if words[0] not in targets] == []


def test_tools_and_tests_exist() -> None:
    calls = [(page, word) for page, words in quoted("python") for word in words if word.endswith(".py")]
    assert calls and [(name(page), word) for page, word in calls if not (ROOT / word).is_file()] == []


def test_the_tests_that_pages_name_exist() -> None:
    defined = set()
    for path in (ROOT / "tests").rglob("test_*.py"):
        defined |= set(re.findall(r"^def (test_\w+)", path.read_text(encoding="utf-8"), flags=re.MULTILINE))
    named = {(name(page), word) for page in PAGES for word in INLINE.findall(page.read_text(encoding="utf-8"))}
    assert [
        (page, word) for page, word in sorted(named) if re.fullmatch(r"test_\w+", word) and word not in defined
    ] == []


def test_the_gallery_says_what_the_pictures_say() -> None:
    from pellucid.gallery import PICTURES

    text = " ".join((ROOT / "docs" / "gallery.md").read_text(encoding="utf-8").split())
    for picture in PICTURES:
        assert f"images/gallery/{picture.name}.jpg" in text, picture.name
        assert picture.title in text and picture.you_should_see in text, picture.name


def test_pictures_are_small() -> None:
    sizes = {path: path.stat().st_size for path in (ROOT / "docs" / "images").rglob("*") if path.is_file()}
    assert max(sizes.values()) <= 300_000 and sum(sizes.values()) <= 2_000_000
