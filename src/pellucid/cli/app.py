"""All commands together, and what becomes of their errors."""

from __future__ import annotations

import errno
import inspect
import sys
import traceback
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from pellucid.cli.animate import animate
from pellucid.cli.bench import bench
from pellucid.cli.console import complain, notice, outcome
from pellucid.cli.demo import demo
from pellucid.cli.doctor import doctor
from pellucid.cli.media import media
from pellucid.cli.render import render
from pellucid.cli.trace import trace
from pellucid.errors import AssetWarning, PellucidError


@contextmanager
def _notices() -> Iterator[None]:
    """Tells an AssetWarning in one line too."""
    with warnings.catch_warnings():
        shown = warnings.showwarning
        warnings.simplefilter("always", AssetWarning)
        warnings.showwarning = lambda message, category, *rest: (
            notice(str(message)) if issubclass(category, AssetWarning) else shown(message, category, *rest)
        )
        yield


class Commands(TyperGroup):
    """The commands, with errors told in one line instead of a traceback."""

    def invoke(self, ctx: Any) -> Any:
        try:
            with _notices():
                return super().invoke(ctx)
        except PellucidError as error:
            complain(str(error))
        except KeyboardInterrupt:
            complain("interrupted", label="stopped")
        except MemoryError:
            complain("there is not enough memory for this; use a smaller picture or a lower resolution")
        except OSError as error:  # files of the user's are AssetErrors by now; this is standard output itself
            if error.errno != errno.ENOSPC:
                raise
            complain("the disk is full, so not everything could be printed; make space")
        raise typer.Exit(1)


app = typer.Typer(
    name="pellucid",
    cls=Commands,
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="First steps:\n\n"
    "  is this machine ready?     pellucid doctor\n\n"
    "  the gallery                pellucid demo\n\n"
    "  a mesh of yours, in glass  pellucid render bunny.ply --medium N-BK7 -o bunny.png\n\n"
    "Exit codes: 0 done, 1 something went wrong, 2 the command was not understood.",
)


def _version(wanted: bool) -> None:
    if wanted:
        from pellucid import __version__

        outcome().print(f"pellucid {__version__}", highlight=False)
        raise typer.Exit


@app.callback()
def pellucid(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Draw glass, gems, water and every other thing that bends light.

    Works on any GPU through Vulkan, Metal or DirectX 12, and on the CPU through a software Vulkan driver.
    Each command explains itself: pellucid COMMAND --help.
    """


def _add(command: Callable[..., None], *examples: str) -> None:
    """Make a function a command; its docstring, its paragraphs unwrapped, is the help."""
    paragraphs = inspect.cleandoc(command.__doc__ or "").split("\n\n")
    text = "\n\n".join(" ".join(paragraph.split()) for paragraph in paragraphs)
    app.command(help=text, epilog="\n\n".join(("Examples:", *(f"  {line}" for line in examples))))(command)


_add(demo, "pellucid demo", "pellucid demo --only wine-glass --size 1600x1200 --samples 64")
_add(
    render,
    "pellucid render bunny.ply -o bunny.png --medium N-BK7",
    "pellucid render cup.stl -o cup.exr --medium amber --resolution 192 --up z",
    "pellucid render ring.obj -o ring.png --medium diamond --environment sky",
    "pellucid render scene.toml -o scene.png --size 1920x1080 --samples 64",
)
_add(
    animate,
    "pellucid animate wine-glass --light-orbit 90 --frames 24 -o out/wine",
    "pellucid animate water-pool --frames 48 -o out/pool",
    "pellucid animate scene.toml --orbit 360 --frames 120 --size 1280x720 -o out/turn --video turn.mp4",
    "pellucid animate scene.toml --orbit 360 --frames 120 --only 60:120 -o out/turn",
)
_add(
    trace,
    "pellucid trace ball.ply --origin 0,0.01,1 --direction 0,0,-1",
    "pellucid trace flame.npy --extent 0.1 --rays rays.csv -o bent.csv",
)
_add(media, "pellucid media", "pellucid media N-BK7", "pellucid media 'clear lake'")
_add(doctor, "pellucid doctor")
_add(bench, "pellucid bench", "pellucid bench eikonal --json > eikonal.json", "pellucid bench water --repeat 1")


def run() -> None:
    """Run the command line. What no one foresaw is a fault of ours, and says so."""
    try:
        app(prog_name="pellucid")
    except Exception:  # SystemExit, with which every foreseen way ends, is none
        traceback.print_exc()
        complain(
            "this is a fault of Pellucid, not yours. Please report it with the lines above "
            "and what `pellucid doctor` prints"
        )
        sys.exit(1)
