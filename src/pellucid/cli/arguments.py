"""What is typed on the command line, turned into values before any work begins."""

from __future__ import annotations

import math
import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import typer

from pellucid.errors import AssetError, SceneError

LARGEST_SIDE = 32768
PICTURES = (".png", ".exr", ".hdr")


class Size(NamedTuple):
    """Pixels."""

    width: int
    height: int

    def __str__(self) -> str:
        return f"{self.width}x{self.height}"


class Vector(NamedTuple):
    """Metres, or a direction."""

    x: float
    y: float
    z: float

    def __str__(self) -> str:
        return f"{self.x:g},{self.y:g},{self.z:g}"


def parse_size(text: str | Size) -> Size:
    """``800x600``."""
    if isinstance(text, Size):
        return text
    match = re.fullmatch(r"\s*(\d{1,9})\s*[xX×*]\s*(\d{1,9})\s*", text)
    if not match:
        raise typer.BadParameter(f"{text!r} is not a size; write width x height in pixels, such as 800x600")
    width, height = int(match[1]), int(match[2])
    if not (1 <= width <= LARGEST_SIDE and 1 <= height <= LARGEST_SIDE):
        raise typer.BadParameter(f"{text!r} is out of range; each side has 1 to {LARGEST_SIDE} pixels")
    return Size(width, height)


def parse_vector(text: str | Vector) -> Vector:
    """``0,0.5,-1``."""
    if isinstance(text, Vector):
        return text
    numbers = _numbers(text)
    if len(numbers) != 3:
        raise typer.BadParameter(f"{text!r} is not a vector; write three numbers as x,y,z, such as 0,0.5,-1")
    return Vector(*numbers)


class Edges(tuple[float, ...]):
    """Edges of a box: one length, or three."""

    def __str__(self) -> str:
        return ",".join(f"{edge:g}" for edge in self)


def parse_edges(text: str | Edges) -> Edges:
    """``0.1`` or ``0.1,0.1,0.2``."""
    if isinstance(text, Edges):
        return text
    numbers = _numbers(text)
    if len(numbers) not in (1, 3) or min(numbers) <= 0.0:
        raise typer.BadParameter(
            f"{text!r} is not an extent; write one or three lengths in metres, such as 0.1,0.1,0.2"
        )
    return Edges(numbers)


def parse_positive(text: str | float) -> float:
    """A finite number above 0."""
    numbers = _numbers(str(text))
    if len(numbers) != 1 or numbers[0] <= 0.0:
        raise typer.BadParameter(f"{text!r} is not a number above 0")
    return numbers[0]


def parse_degrees(text: str | float) -> float:
    """A finite angle."""
    numbers = _numbers(str(text))
    if len(numbers) != 1:
        raise typer.BadParameter(f"{text!r} is not an angle; write degrees, such as 90 or -45")
    return numbers[0]


def _numbers(text: str) -> list[float]:
    """The finite numbers in a list with commas; none at all when one of them is not."""
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        return []
    return values if all(map(math.isfinite, values)) else []


def substance(text: str) -> str | float:
    """A medium as typed: a number is a constant index."""
    try:
        return float(text)
    except ValueError:
        return text


@contextmanager
def blaming(file: Path, *fields: str) -> Iterator[None]:
    """What is wrong with these fields of a volume came out of the file, and is said of it."""
    try:
        yield
    except SceneError as error:
        if error.field in fields:
            raise AssetError(file, error.reason, error.remedy) from error
        raise


def check_output(path: Path, suffixes: tuple[str, ...], verb: str = "written") -> Path:
    """The path, once it is known that a file of this kind can be written there.

    Raises
    ------
    AssetError : unknown suffix, a folder of this name, a folder that is missing or cannot be written to.
    """
    from pellucid.io.files import suffix_of

    suffix_of(path, suffixes, verb)
    if path.is_dir():
        raise AssetError(path, "is a folder and cannot be written as a file", "name a file inside it")
    check_folder(path.parent, path)
    return path


def make_folder(folder: Path) -> None:
    """Make a folder for what comes out, and see that it can be written to.

    Raises
    ------
    AssetError : something else has that name, or it may not be made or written to.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = f"cannot be made a folder: {error.strerror or error}"
        raise AssetError(folder, reason, "choose another --output") from None
    check_folder(folder)


def check_folder(folder: Path, blame: Path | None = None) -> None:
    """Raise an AssetError unless files can be made in `folder`; the only sure way to know is to make one."""
    path = folder if blame is None else blame
    if not folder.is_dir():
        raise AssetError(path, f"the folder {str(folder)!r} does not exist", "create it first")
    try:
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        why = error.strerror or str(error)
        raise AssetError(path, f"nothing can be written in {str(folder)!r}: {why}", "choose another folder") from None


def check_size(size: Size, limit: int) -> None:
    """Raise a SceneError for a picture larger than the device can draw."""
    if max(size) > limit:
        raise SceneError("size", f"is {size}", f"this device draws up to {limit} pixels a side")


def check_pixels(size: Size) -> None:
    """Raise a SceneError when the memory of the machine cannot hold the picture with what it takes to draw it."""
    from pellucid.cli.machine import free_memory

    needed, free = 100 * size.width * size.height, free_memory()
    if free is not None and needed > free:
        reason = f"is {size}, which takes about {needed / 2**30:.1f} GB of memory"
        raise SceneError("size", reason, f"{free / 2**30:.1f} GB are free")
