"""The device and renderer that the one-line functions share; made at the first call, never at import."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np

    from pellucid.fields.volume import Volume
    from pellucid.frame import Frame
    from pellucid.gpu import Device
    from pellucid.renderer import Renderer
    from pellucid.scene import Quality, RefractiveVolume, Scene
    from pellucid.techniques.eikonal.irradiance import Irradiance
    from pellucid.techniques.eikonal.trace import Rays


@cache
def default_device() -> Device:
    """The best adapter of this machine, opened once. Use `Device.create` for one of your own."""
    from pellucid.gpu import Device

    return Device.create()


@cache
def default_renderer() -> Renderer:
    """A renderer on the default device."""
    from pellucid.renderer import Renderer

    return Renderer(default_device())


def render(scene: Scene, size: tuple[int, int] = (800, 600), samples: int = 1, time: float = 0.0) -> Frame:
    """Render one picture of a scene.

    Parameters
    ----------
    scene : what to draw. size : (width, height) in pixels. samples : jittered pictures that are averaged.
    time : seconds, for objects that move by themselves.

    Raises
    ------
    SceneError : for a value out of range. NoAdapterError : when there is no device to render on.
    """
    return default_renderer().render(scene, size, time=time, samples=samples)


def illuminate(scene: Scene, volume: RefractiveVolume, progress: Callable[[float], None] | None = None) -> Irradiance:
    """Follow the light of a scene's lamps through one of its volumes, and say how much there is everywhere.

    Meshes throw their shadows into the volume; other volumes do not act on its light.

    Parameters
    ----------
    scene : its lamps and meshes. volume : one of its objects; `volume.light` says how carefully.
    progress : called with the share that is done, 0 to 1.

    Returns
    -------
    Irradiance : fluence, direction, flux_in, flux_absorbed, flux_out, flux_ended, patches, seconds.

    Raises
    ------
    SceneError : when the volume is not in the scene, or a lamp stands in opaque matter.
    """
    return default_renderer().illuminate(scene, volume, progress)


def trace(
    volume: RefractiveVolume | Volume,
    origins: np.ndarray,
    directions: np.ndarray,
    quality: Quality | None = None,
    channel: int | None = None,
    mode: str | None = None,
) -> Rays:
    """Follow rays through one volume with the shader that draws it.

    At an interface the refracted ray is followed, the reflected one where reflection is total.

    Parameters
    ----------
    volume : a placed `RefractiveVolume`, or a bare `Volume` (at the origin, sharp if it has regions, else smooth).
    origins, directions : (N, 3) or (3,), metres of the world; directions need not be unit.
    quality : overrides the volume's own.
    channel : 0, 1 or 2 for the index of red, green or blue; the index at 587.56 nm when omitted.
    mode : "ordinary" or "extraordinary": the kind of ray that is followed in every crystal. Each entry into a crystal
        then counts with its share of unpolarised light. When omitted, crystals are traced by their ordinary index.

    Returns
    -------
    Rays : position, direction, optical_path, transmittance, status, steps, index.

    Raises
    ------
    SceneError : for arrays of the wrong shape, NaN, or directions of length zero.
    """
    from pellucid.fields.volume import Volume
    from pellucid.scene import RefractiveVolume
    from pellucid.techniques.eikonal.trace import trace as trace_on

    if isinstance(volume, Volume):
        volume = RefractiveVolume(volume)
    return trace_on(default_device(), volume, origins, directions, quality, channel, mode)


def probe(module: str, function: str, *arrays: Any) -> np.ndarray:
    """Evaluate a WGSL function on arrays; see `pellucid.gpu.probe`."""
    from pellucid.gpu.probe import probe as probe_on

    return probe_on(module, function, *arrays, device=default_device())
