"""Scenes as files: JSON or TOML that a person can write, with meshes, pictures and arrays beside them."""

from __future__ import annotations

import difflib
import json
import tomllib
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pellucid.errors import AssetError, SceneError
from pellucid.io.files import existing_file, replacing, suffix_of
from pellucid.scene.scene import Scene

if TYPE_CHECKING:
    from pydantic import ValidationError
    from pydantic_core import ErrorDetails

SUFFIXES = (".json", ".toml")


def load_scene(path: str | PathLike[str]) -> Scene:
    """Read a scene file.

    Parameters
    ----------
    path : .json or .toml; files named in it are relative to its folder.

    Raises
    ------
    AssetError : the file, or one that it names, is missing, damaged or of the wrong kind.
    SceneError : a field is missing, unknown or out of range; names the file and the field.
    """
    from pydantic import ValidationError

    from pellucid.scene.loading import build_scene
    from pellucid.scene.schema import SceneFile

    file = existing_file(path)
    data = _parsed(file, suffix_of(file, SUFFIXES, "read as a scene"))
    try:
        part = SceneFile.model_validate(data)
    except ValidationError as error:
        raise _explained(file, data, error) from None
    return build_scene(part, file)


def save_scene(scene: Scene, path: str | PathLike[str]) -> None:
    """Write a scene so that :func:`load_scene` gives it back.

    Things made from files and by named generators are written as such; what was made from arrays is
    written beside the scene file, as ``<scene>.<part>.npz`` or ``.exr``. On failure nothing new is left.

    Parameters
    ----------
    path : .json or .toml.

    Raises
    ------
    AssetError : wrong suffix, missing folder, full disk.
    SceneError : something that no scene file can state, such as a medium of the user's own formula.
    """
    from pellucid.scene.saving import Sidecars, describe_scene

    file = Path(path)
    suffix = suffix_of(file, SUFFIXES, "written as a scene")
    if not file.parent.is_dir():
        raise AssetError(file, f"the folder {str(file.parent)!r} does not exist", "create it first")
    beside = Sidecars(file)
    try:
        described = describe_scene(scene, beside)
        text = json.dumps(described, indent=2, ensure_ascii=False) + "\n" if suffix == ".json" else _toml(described)
        with replacing(file) as part:
            part.write_text(text, encoding="utf-8")
    except BaseException:
        beside.take_back()
        raise


def _parsed(file: Path, suffix: str) -> Any:
    try:
        text = file.read_text(encoding="utf-8-sig")  # some editors put a byte order mark first
        return json.loads(text, object_pairs_hook=_once_each) if suffix == ".json" else tomllib.loads(text)
    except UnicodeDecodeError as error:
        raise AssetError(file, f"is not UTF-8 text: {error.reason}", "save it as UTF-8") from error
    except RecursionError as error:
        raise AssetError(file, f"is not valid {suffix[1:].upper()}: it is nested too deeply", "correct it") from error
    except ValueError as error:  # what both parsers raise, and a name that stands twice
        raise AssetError(file, f"is not valid {suffix[1:].upper()}: {error}", "correct it there") from error


def _once_each(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A JSON object; of two fields of one name the parser would drop the first without a word (TOML refuses them)."""
    table = dict(pairs)
    if len(table) < len(pairs):
        twice = next(name for i, (name, _) in enumerate(pairs) if name in dict(pairs[:i]))
        raise ValueError(f"the field {twice!r} stands twice in one table")
    return table


def _explained(file: Path, data: Any, error: ValidationError) -> SceneError:
    """The first fault that pydantic found, in the words of a scene file."""
    found = [(_field_path(fault, data), fault) for fault in error.errors(include_url=False)]
    # of the variants that were tried, the one that came further is the one that was meant
    meant = [pair for pair in found if not any(path.startswith(f"{pair[0]}.") for path, _ in found)]
    where, fault = meant[0]
    reason, remedy = _words(fault)
    others = {path for path, _ in meant} - {where}
    more = f"; also wrong: {', '.join(sorted(others))}" if others else ""
    return SceneError(f"{file}: {where or 'the scene'}", reason + more, remedy)


def _words(fault: ErrorDetails) -> tuple[str, str]:
    """What is wrong, and what to do."""
    from pellucid.scene.schema import KNOWN_FIELDS

    if fault["type"] == "missing":
        return "is missing", "add it"
    if fault["type"] == "extra_forbidden":
        close = difflib.get_close_matches(str(fault["loc"][-1]), KNOWN_FIELDS, n=1)
        return "is not a field that belongs here", f"did you mean {close[0]!r}?" if close else "remove it"
    if fault["type"] == "model_type":
        return "must be a table of named fields", 'such as { "camera": { "position": [0, 0, 1] } }'
    if fault["type"] == "tuple_type":
        return f"should be a list of numbers, got {fault['input']!r:.60}", "such as [0, 0.1, 1]"
    if fault["type"] == "unknown_kind":
        return fault["msg"], ""
    shown = repr(fault["input"])
    wish = fault["msg"].removeprefix("Input should ")
    return f"should {wish}, got {shown if len(shown) < 60 else shown[:57] + '...'}", ""


def _field_path(fault: ErrorDetails, data: Any) -> str:
    """``objects[0].size_m``: pydantic's location without the names of the variants it tried."""
    path, here = "", data
    for i, part in enumerate(fault["loc"]):
        last_and_absent = i == len(fault["loc"]) - 1 and fault["type"] == "missing"
        if isinstance(part, int):
            path += f"[{part}]"
            here = here[part] if isinstance(here, list) and part < len(here) else None
        elif last_and_absent or (isinstance(here, dict) and part in here):
            path += f".{part}"
            here = here.get(part) if isinstance(here, dict) else None
    return path.removeprefix(".")


def _toml(described: Mapping[str, Any]) -> str:
    """Plain values first, then a table each, then the lists of tables; the standard library only reads TOML."""
    lines = [f"{key} = {_toml_value(value)}" for key, value in described.items() if not isinstance(value, dict | list)]
    for key, value in described.items():
        tables = value if isinstance(value, list) else [value] if isinstance(value, dict) else []
        for table in tables:
            lines += ["", f"[[{key}]]" if isinstance(value, list) else f"[{key}]"]
            lines += [f"{name} = {_toml_value(item)}" for name, item in table.items()]
    return "\n".join(lines).lstrip("\n") + "\n"


def _toml_value(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_toml_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml_value, value)) + "]"
    # JSON's strings, numbers and booleans are TOML's, but for the control character DEL
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
