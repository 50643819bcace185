"""What every reader and writer shares: looking at a file before opening it, and replacing it whole."""

from __future__ import annotations

import os
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from os import PathLike
from pathlib import Path

from pellucid.errors import AssetError


def existing_file(path: str | PathLike[str]) -> Path:
    """The path, once it is known to be a readable file that is not empty.

    Raises
    ------
    AssetError : the file is missing, is a folder, is empty, or may not be read.
    """
    file = Path(path)
    try:
        if file.is_dir():
            raise AssetError(file, "is a folder, not a file", "name a file inside it")
        if not file.exists():
            raise AssetError(file, "does not exist", _nearby(file))
        if file.stat().st_size == 0:
            raise AssetError(file, "is empty (0 bytes)", "export or download it again")
        with file.open("rb"):
            pass
    except (OSError, ValueError) as error:
        raise AssetError(file, f"cannot be opened: {_words(error)}", "check the name and the permissions") from error
    return file


def suffix_of(file: Path, known: tuple[str, ...], verb: str) -> str:
    """The lower-case suffix of `file`, which must be one of `known` (with their dots).

    Raises
    ------
    AssetError : any other suffix.
    """
    suffix = file.suffix.lower()
    if suffix not in known:
        said = f"the suffix {suffix!r} is not one" if suffix else "it has no suffix, so its format is not one"
        raise AssetError(file, f"{said} that can be {verb}", f"use one of {', '.join(known)}")
    return suffix


@contextmanager
def replacing(path: str | PathLike[str]) -> Iterator[Path]:
    """A temporary name beside `path` to write to; it takes the place of `path` only when all went well.

    A reader therefore sees the old file or the whole new one. The temporary keeps the suffix, since many
    writers choose the format by it.

    Raises
    ------
    AssetError : the folder is missing, or an OSError (full disk, no permission) came up while writing.
    """
    file = Path(path)
    if not file.parent.is_dir():
        raise AssetError(file, f"the folder {str(file.parent)!r} does not exist", "create it first")
    if file.is_dir():
        raise AssetError(file, "is a folder and cannot be written as a file", "name a file inside it")
    part = file.with_name(f".{file.stem}.{uuid.uuid4().hex[:8]}{file.suffix}")
    try:
        yield part
        os.replace(part, file)
    except OSError as error:
        raise AssetError(file, f"could not be written: {_words(error)}", "check free space and permissions") from error
    finally:
        with suppress(OSError):  # a read-only file system refuses this even where there is nothing to remove
            part.unlink(missing_ok=True)


def _nearby(file: Path) -> str:
    """A remedy for a missing file: a file of almost the same name, if there is one."""
    import difflib

    if not file.parent.is_dir():
        return f"nor does the folder {str(file.parent)!r}"
    names = [entry.name for entry in file.parent.iterdir() if entry.is_file()]
    close = difflib.get_close_matches(file.name, names, n=1)
    return f"did you mean {close[0]!r}?" if close else "check the spelling and the folder"


def _words(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error) or type(error).__name__
