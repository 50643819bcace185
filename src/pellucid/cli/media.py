"""`pellucid media`: what things can be made of."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated

import typer

from pellucid.cli.console import outcome

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from pellucid.media import Medium

LINES_NM = {"h": 404.66, "g": 435.83, "F": 486.13, "e": 546.07, "d": 587.56, "C": 656.28, "A'": 768.19, "s": 852.11}
"""Fraunhofer lines at which glass makers state indices, nm."""


def media(
    name: Annotated[
        str | None, typer.Argument(metavar="[NAME]", help="One medium in detail; a number works too.")
    ] = None,
) -> None:
    """List all media by name, or show one with its index at several wavelengths.

    A medium in the list can be given to --medium and to every argument of that name in Python.
    """
    from pellucid import media as catalogue
    from pellucid.cli.arguments import substance

    if name is None:
        _print_all([catalogue.get(each) for each in catalogue.names()])
    else:
        _print_one(catalogue.resolve(substance(name)))


def _print_all(known: list[Medium]) -> None:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("name", no_wrap=True, style="bold")
    table.add_column("kind")
    table.add_column("n_d", justify="right")
    table.add_column("Abbe", justify="right")
    table.add_column("known, nm", justify="right", no_wrap=True)
    table.add_column("absorption RGB, 1/m", justify="right")
    table.add_column("source", overflow="fold")
    for medium in known:
        cells = (medium.name, medium.kind, f"{medium.n_d:.5f}", _abbe(medium), _range(medium), _absorption(medium))
        table.add_row(*cells, Text(medium.source))
    console = outcome()
    console.print(table)
    console.print(f"{len(known)} media; pellucid media NAME shows one of them")


def _print_one(medium: Medium) -> None:
    from rich import box
    from rich.table import Table

    console = outcome()
    console.print(medium.name, style="bold")
    facts = {
        "kind": medium.kind,
        "index": f"n_d = {medium.n_d:.6f}, Abbe number {_abbe(medium)}",
        **_extraordinary(medium),
        "known": f"{_range(medium)} nm",
        "source": medium.source,
        "absorption": f"{_absorption(medium)} 1/m (red, green, blue); {medium.absorption_source}",
        **_scattering(medium),
    }
    for title, text in facts.items():
        console.print(f"  {title:<11} {text}")
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("line", no_wrap=True)
    table.add_column("wavelength, nm", justify="right")
    table.add_column("n", justify="right")
    rays = [medium]
    if medium.extraordinary is not None:
        table.add_column("n_e", justify="right")
        rays.append(medium.extraordinary)
    extinctions = _extinctions(medium)
    for title in extinctions:
        table.add_column(title, justify="right")
    for label, wavelength in _wavelengths(medium):
        known = [f"{float(values(wavelength)):.5f}" for values in extinctions.values()]
        table.add_row(label, f"{wavelength:.2f}", *(f"{float(ray.n(wavelength)):.6f}" for ray in rays), *known)
    console.print(table)


def _scattering(medium: Medium) -> dict[str, str]:
    """What a body of water has besides its absorption."""
    from pellucid.media import WaterBody

    if not isinstance(medium, WaterBody):
        return {}
    rgb = " ".join(f"{value:.3g}" for value in medium.scattering_rgb_per_m)
    return {
        "scattering": f"{rgb} 1/m (red, green, blue); {medium.scattering_source}",
        "asymmetry": f"mean cosine {medium.asymmetry:.3f} (Henyey-Greenstein)",
    }


def _extinctions(medium: Medium) -> dict[str, Callable[[float], NDArray[np.float64]]]:
    """Absorption and scattering by wavelength, for the table."""
    from pellucid.media import WaterBody

    if not isinstance(medium, WaterBody):
        return {}
    return {"absorption, 1/m": medium.absorption, "scattering, 1/m": medium.scattering}


def _extraordinary(medium: Medium) -> dict[str, str]:
    """What a uniaxial crystal has besides its ordinary ray."""
    ray = medium.extraordinary
    if ray is None:
        return {}
    return {"crystal": f"uniaxial; extraordinary n_d = {ray.n_d:.6f}, absorption {_absorption(ray)} 1/m"}


def _wavelengths(medium: Medium) -> list[tuple[str, float]]:
    """Lines within the range that the source covers, then the three channels of a picture."""
    from pellucid.media.medium import RGB_LAMBDA_NM

    low, high = medium.valid_nm
    channels = zip(("red channel", "green channel", "blue channel"), RGB_LAMBDA_NM, strict=True)
    return [(name, nm) for name, nm in (*LINES_NM.items(), *channels) if low <= nm <= high]


def _abbe(medium: Medium) -> str:
    return f"{medium.abbe:.1f}" if math.isfinite(medium.abbe) else "-"


def _range(medium: Medium) -> str:
    low, high = medium.valid_nm
    return f"{low:.0f} - {high:.0f}" if math.isfinite(high) else "any"


def _absorption(medium: Medium) -> str:
    rgb = medium.absorption_rgb_per_m
    return " ".join(f"{value:.3g}" for value in rgb) if rgb.any() else "clear"
