"""`pellucid doctor`: is this machine ready, and if not, what is missing."""

from __future__ import annotations

import math
import platform
import re
import sys
import tempfile
import time
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from pellucid.cli.console import complain, outcome
from pellucid.errors import NoAdapterError

if TYPE_CHECKING:
    from rich.console import Console

    from pellucid.gpu import Device

LIMITS = (
    "max-texture-dimension-2d",
    "max-texture-dimension-3d",
    "max-buffer-size",
    "max-storage-buffer-binding-size",
)


def doctor() -> None:
    """Tell whether this machine can draw: versions, adapters, limits, memory, and a small test of the physics.

    Exits with 1, and says what to install, when no adapter is found or the test fails.
    """
    console = outcome()
    _versions(console)
    _space(console)
    _extras(console)
    try:
        _adapters(console)
        device = _device(console)
    except NoAdapterError as error:
        complain(str(error))
        raise typer.Exit(1) from None
    if not _self_test(console, device):
        complain("the test of the physics failed on this adapter; update its driver, and report the lines above")
        raise typer.Exit(1)
    console.print("\nThis machine is ready.", style="bold green")


def _heading(console: Console, text: str) -> None:
    console.print(f"\n{text}", style="bold")


def _line(console: Console, name: str, value: str) -> None:
    console.print(f"  {name:<32} {value}", soft_wrap=True)


def _versions(console: Console) -> None:
    from pellucid import __version__

    console.print(f"pellucid {__version__}", style="bold")
    _line(console, "system", platform.platform())
    _line(console, "python", f"{platform.python_version()} ({sys.executable})")
    for requirement in metadata.requires("pellucid") or ():
        if "extra ==" not in requirement:
            _line(console, _package(requirement), _installed(_package(requirement)) or "missing")


def _space(console: Console) -> None:
    from pellucid.cli.machine import free_disk, free_memory

    _heading(console, "Room")
    memory = free_memory()
    _line(console, "free memory", "unknown" if memory is None else f"{memory / 2**30:.1f} GB")
    for name, folder in (("free disk, this folder", Path.cwd()), ("free disk, temporary", Path(tempfile.gettempdir()))):
        _line(console, name, f"{free_disk(folder) / 2**30:.1f} GB")


def _extras(console: Console) -> None:
    """Optional parts, and whether their packages are there."""

    _heading(console, "Optional")
    for extra in metadata.metadata("pellucid").get_all("Provides-Extra") or ():
        parts = [
            _package(r) for r in metadata.requires("pellucid") or () if re.search(rf"extra == ['\"]{extra}['\"]", r)
        ]
        missing = [part for part in parts if _installed(part) is None]
        remedy = f"missing: {', '.join(missing)} (pip install 'pellucid[{extra}]')"
        _line(console, f"pellucid[{extra}]", remedy if missing else "installed")


def _package(requirement: str) -> str:
    match = re.match(r"[A-Za-z0-9._-]+", requirement)
    return match[0] if match else requirement


def _installed(package: str) -> str | None:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def _adapters(console: Console) -> None:
    from pellucid.gpu.device import list_adapters

    _heading(console, "Adapters")
    for adapter in list_adapters():
        info = adapter.info
        _line(console, str(info.get("device")), f"{info.get('adapter_type')}, {info.get('backend_type')}")


def _device(console: Console) -> Device:
    from pellucid.session import default_device

    device = default_device()
    _heading(console, "Chosen")
    _line(console, "adapter", device.name)
    _line(console, "kind", "software: no GPU was found, the CPU does the work" if device.is_software else "GPU")
    _line(console, "driver", str(device.info.get("description") or "unknown"))
    _line(console, "features", ", ".join(sorted(device.features)) or "none of the optional ones")
    for name in LIMITS:
        value = device.limits[name]
        _line(console, name, f"{value / 2**20:.0f} MB" if "size" in name else f"{value}")
    return device


def _self_test(console: Console, device: Device) -> bool:
    _heading(console, "Self-test")
    tests: dict[str, Callable[[], tuple[bool, str]]] = {
        "a ray through a glass ball": _bends_as_snell_says,
        "a clear ball in even light": _keeps_the_light,
    }
    good = True
    for name, test in tests.items():
        begun = time.perf_counter()
        try:
            passed, words = test()
        except Exception as error:  # whatever a driver may raise is the answer looked for here
            passed, words = False, f"{type(error).__name__}: {error}"
        verdict = "ok" if passed else "FAILED"
        _line(console, name, f"{verdict}: {words} ({time.perf_counter() - begun:.1f} s)")
        good = good and passed
    return good


def _ball(n: float = 1.5, radius_m: float = 0.4) -> Any:
    import numpy as np

    from pellucid.fields.volume import Volume

    return Volume.from_sdf(lambda x, y, z: np.sqrt(x * x + y * y + z * z) - radius_m, n, 48, 1.0)


def _bends_as_snell_says() -> tuple[bool, str]:
    """A ray that meets a ball at height h turns by 2 (asin(h/r) - asin(h/(n r)))."""
    from pellucid.session import trace

    n, radius, height = 1.5, 0.4, 0.2
    rays = trace(_ball(n, radius), [0.0, height, 1.0], [0.0, 0.0, -1.0])  # type: ignore[arg-type]
    expected = math.degrees(2.0 * (math.asin(height / radius) - math.asin(height / (n * radius))))
    turned = math.degrees(math.atan2(-rays.direction[0, 1], -rays.direction[0, 2]))
    return abs(turned - expected) < 0.5, f"turned by {turned:.2f} degrees, {expected:.2f} by Snell's law"


def _keeps_the_light() -> tuple[bool, str]:
    """In even light from everywhere, a ball that absorbs nothing cannot be seen (a furnace)."""
    from pellucid.scene import Camera, Environment, RefractiveVolume, Scene
    from pellucid.session import render

    ball = RefractiveVolume.from_volume(_ball(), boundary="sharp")
    scene = Scene(Camera((0.0, 0.0, 2.5)), Environment.constant((1.0, 1.0, 1.0)), objects=[ball], tone_mapping="linear")
    radiance = render(scene, (64, 64)).radiance
    low, high = float(radiance.min()), float(radiance.max())
    return low > 0.97 and high < 1.03, f"radiance {low:.3f} to {high:.3f}, 1 expected"
