"""Where a command writes: results to standard output; notices, progress and errors to standard error."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

    from pellucid.gpu import Device

WIDTH_IN_FILES = 200
"""Columns when the output goes to a file or a pipe, so that tables are not cut."""


def outcome() -> Console:
    """Standard output."""
    return _console(stderr=False)


def aside() -> Console:
    """Standard error."""
    return _console(stderr=True)


def _console(stderr: bool) -> Console:
    from rich.console import Console

    console = Console(stderr=stderr, highlight=False, markup=False, emoji=False)
    if not console.is_terminal:
        console.width = WIDTH_IN_FILES
    return console


def complain(message: str, label: str = "error") -> None:
    """One red line on standard error."""
    from rich.text import Text

    aside().print(Text(f"{label}: ", style="bold red").append(" ".join(message.split()), style="red"), soft_wrap=True)


def notice(message: str) -> None:
    """One dim line on standard error."""
    aside().print(f"note: {message}", style="dim", soft_wrap=True)


def open_device(quiet: bool = False) -> Device:
    """The device that everything is drawn on, with a notice when it is the CPU."""
    from pellucid.session import default_device

    device = default_device()
    if device.is_software and not quiet:
        notice(f"no GPU was found, so the CPU does the work ({device.name}); it is slower")
    return device


class Bar:
    """One line of progress, made of named steps; without a terminal it stays silent."""

    def __init__(self, progress: Any) -> None:
        self._progress = progress
        self._task = progress.add_task("", total=1.0)

    def step(self, name: str) -> Callable[[float], None]:
        """Begin the step `name`; the result takes its share that is done, 0 to 1."""
        self._progress.reset(self._task, description=name, total=1.0)
        return lambda share: self._progress.update(self._task, completed=share)

    def overall(self, name: str, share: float) -> None:
        """Set name and share without starting the clock anew."""
        self._progress.update(self._task, description=name, completed=share)

    def say(self, line: str) -> None:
        """A line of the outcome; on a terminal it goes through the bar, which would otherwise be written over."""
        shared = self._progress.console.is_terminal and sys.stdout.isatty()
        (self._progress.console if shared else outcome()).print(line, soft_wrap=True)


@contextmanager
def progress_bar() -> Iterator[Bar]:
    """A bar on standard error for as long as the block runs."""
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    console = aside()
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
    progress = Progress(
        *columns,
        console=console,
        transient=True,
        disable=not console.is_terminal,
        redirect_stdout=False,  # results that go to a file must not end above the bar
    )
    with progress:
        yield Bar(progress)


def seconds(duration: float) -> str:
    """A duration for people: ``0.34 s``, ``12.3 s``, ``2 min 05 s``."""
    if duration >= 99.95:
        minutes, rest = divmod(round(duration), 60)
        return f"{minutes} min {rest:02d} s"
    return f"{duration:.2f} s" if duration < 9.995 else f"{duration:.1f} s"
