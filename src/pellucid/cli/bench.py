"""`pellucid bench`: how long things take on this machine."""

from __future__ import annotations

import difflib
import inspect
import json
from collections.abc import Callable
from typing import Annotated, Any

import typer

from pellucid.cli.console import complain, open_device, outcome, progress_bar
from pellucid.errors import PellucidError, SceneError


def bench(
    suite: Annotated[
        str, typer.Argument(metavar="[SUITE]", help="What to time: eikonal, light, relief, or water.")
    ] = "eikonal",
    as_json: Annotated[bool, typer.Option("--json", help="Only JSON on standard output, for other programs.")] = False,
    repeat: Annotated[int | None, typer.Option(min=1, max=1000, help="Runs of which the median counts.")] = None,
) -> None:
    """Time one suite of jobs, each in milliseconds and as a ratio to the suite's base row."""
    run = _suite(suite)
    open_device(quiet=as_json)
    with progress_bar() as bar:
        step = bar.step(f"timing {suite}")
        report = run(step) if repeat is None else run(step, **_repeated(run, suite, repeat))
    if as_json:
        typer.echo(json.dumps(report, indent=2, default=_plain))
    else:
        _print(report)
    failed = [row for row in report["rows"] if row.get("error") and isinstance(row["error"], str)]
    if failed:
        complain(f"{len(failed)} of {len(report['rows'])} rows failed: {failed[0]['error']}")
        raise typer.Exit(1)


def _suite(name: str) -> Callable[..., dict[str, Any]]:
    try:
        from pellucid.benchmarks import SUITES
    except ModuleNotFoundError as error:
        if error.name != "pellucid.benchmarks":
            raise
        raise PellucidError("this installation has no benchmarks; install the package again") from None
    if name not in SUITES:
        close = difflib.get_close_matches(name, SUITES, n=1)
        nearest = f"did you mean {close[0]}? " if close else ""
        raise SceneError("suite", f"no suite is called {name!r}", f"{nearest}there are {', '.join(SUITES)}")
    return SUITES[name]


def _repeated(run: Callable[..., Any], suite: str, repeat: int) -> dict[str, int]:
    if "repeat" not in inspect.signature(run).parameters:
        raise typer.BadParameter(f"the suite {suite} has a fixed number of runs; leave --repeat out")
    return {"repeat": repeat}


def _plain(value: Any) -> Any:
    """NumPy numbers as JSON knows them."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} has no form in JSON")


def _print(report: dict[str, Any]) -> None:
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("job", no_wrap=True)
    for name in ("median, ms", "fastest", "slowest", "ratio", "error"):
        table.add_column(name, justify="right")
    table.add_column("note", overflow="fold")
    for row in report["rows"]:
        numbers = [_number(row.get(key)) for key in ("ms", "min_ms", "max_ms", "ratio", "error")]
        table.add_row(str(row["name"]), *numbers, str(row.get("note") or ""))
    console = outcome()
    device = report.get("device") or {}
    console.print(f"{report.get('suite', '')} on {device.get('device') or device.get('name') or 'an unknown device'}")
    console.print(table)


def _number(value: Any) -> str:
    if value is None:
        return ""
    return f"{value:.4g}" if isinstance(value, int | float) else str(value)
