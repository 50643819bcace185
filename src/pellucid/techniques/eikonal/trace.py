"""Rays of the caller through a volume, by the shader that draws it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from pellucid.errors import SceneError
from pellucid.gpu import ComputeKernel, Device, Pipelines
from pellucid.scene.quality import Quality
from pellucid.scene.refractive_volume import RefractiveVolume
from pellucid.techniques.eikonal.layouts import TraceParams, TraceRay
from pellucid.techniques.eikonal.prepare import Prepared, prepare
from pellucid.techniques.eikonal.resources import (
    VolumeTextures,
    constants_of,
    crystal_constants,
    parameters,
    scale_of,
    upload,
)

MODES = ("ordinary", "extraordinary")
STATUS = ("missed", "left", "opaque", "exhausted")


@dataclass(frozen=True)
class Rays:
    """Where rays ended, N rows each.

    position : (N, 3) float64, metres of the world: where the ray left the volume's box (its start when it missed it).
    direction : (N, 3) float64, unit.
    optical_path : (N,) float64, integral of n ds in metres from the start.
    transmittance : (N, 3) float64, absorption and Fresnel transmission along the way, 0 to 1.
    status : (N,) of "missed", "left", "opaque" or "exhausted" (out of steps or of interfaces).
    steps : (N,) int64, steps that the march took.
    index : (N,) float64, |p| at the end: the refractive index there, as the integration knows it.
    """

    position: np.ndarray
    direction: np.ndarray
    optical_path: np.ndarray
    transmittance: np.ndarray
    status: np.ndarray
    steps: np.ndarray
    index: np.ndarray

    def __len__(self) -> int:
        return len(self.status)


def trace(
    device: Device,
    volume: RefractiveVolume,
    origins: np.ndarray,
    directions: np.ndarray,
    quality: Quality | None = None,
    channel: int | None = None,
    mode: str | None = None,
) -> Rays:
    """Follow rays through one volume. See `pellucid.trace`."""
    x, d = _checked_rays(origins, directions)
    if mode not in (None, *MODES):
        raise SceneError("trace.mode", f"is {mode!r}", "use 'ordinary' or 'extraordinary', or leave it out")
    quality = quality or volume.quality
    prepared, textures = _resident(device, volume, quality, dispersion=channel is not None)
    if mode is not None and prepared.crystals is None:
        raise SceneError("trace.mode", "is given, but no region has an optic axis", "leave it out, or give an axis")
    row = channel if channel is not None and prepared.dispersive else 0
    world = volume.object_to_world()
    scale = scale_of(world)
    params = parameters(prepared, textures, row, quality, world)
    inverse = np.linalg.inv(world)
    x_os = x @ inverse[:3, :3].T + inverse[:3, 3]
    d_os = d @ (inverse[:3, :3].T * scale)
    out = _run(device, prepared, quality, params, textures.channels[row], x_os, d_os, mode)
    # The deviation comes back apart from what it deviates from, so that 32 bits carry deflections of 1e-6.
    p = _base(out, d_os) + out["momentum"].astype(np.float64)
    index = np.linalg.norm(p, axis=1)
    missed = out["status"] == 0
    position = out["position"].astype(np.float64) @ world[:3, :3].T + world[:3, 3]
    return Rays(
        position=np.where(missed[:, None], x, position),
        direction=(p / index[:, None]) @ (world[:3, :3].T / scale),
        optical_path=out["optical_path"].astype(np.float64),
        transmittance=out["transmittance"].astype(np.float64),
        status=np.array(STATUS)[out["status"]],
        steps=out["steps"].astype(np.int64),
        index=index,
    )


def _base(out: np.ndarray, d: np.ndarray) -> np.ndarray:
    """The momentum that deviations count from: where it is still the start's, its 64-bit form."""
    base = out["base"].astype(np.float64)
    length = np.linalg.norm(base, axis=1, keepdims=True)
    exact = d * length
    untouched = np.abs(base - exact).max(axis=1, keepdims=True) < 4e-7 * length
    return np.where(untouched, exact, base)


def _checked_rays(origins: Any, directions: Any) -> tuple[np.ndarray, np.ndarray]:
    x = np.atleast_2d(np.asarray(origins, np.float64))
    d = np.atleast_2d(np.asarray(directions, np.float64))
    for name, a in (("origins", x), ("directions", d)):
        if a.ndim != 2 or a.shape[1] != 3:
            raise SceneError(f"trace.{name}", f"has shape {np.shape(a)}", "give an array of shape (N, 3)")
        if not np.isfinite(a).all():
            raise SceneError(f"trace.{name}", "holds NaN or infinite values")
    try:
        x, d = np.broadcast_arrays(x, d)
    except ValueError:
        reason = f"{len(d)} directions for {len(x)} origins"
        raise SceneError("trace.directions", reason, "give as many, or one for all") from None
    length = np.linalg.norm(d, axis=1, keepdims=True)
    if (length == 0.0).any():
        raise SceneError("trace.directions", "holds a vector of length zero")
    return x, d / length


def _resident(
    device: Device, volume: RefractiveVolume, quality: Quality, dispersion: bool
) -> tuple[Prepared, VolumeTextures]:
    """Prepared arrays and textures of the volume, kept on the device while the same volume is traced again."""
    how = (volume.boundary, volume.smoothing_voxels, volume.gradient, quality.method, dispersion)
    cached = device.cache.get("traced volume")
    if cached is None or cached[0] is not volume.volume or cached[1] != how:
        prepared = prepare(volume.volume, *how)
        cached = (volume.volume, how, prepared, upload(device, prepared))
        device.cache["traced volume"] = cached
    return cached[2], cached[3]


def _kernel(device: Device, prepared: Prepared, quality: Quality, mode: str | None) -> ComputeKernel:
    constants = {"GRADED": float(prepared.graded), **constants_of(prepared, quality)}
    if mode is None:
        name, constants = "trace", {"SHARP": float(prepared.sharp), **constants}
    else:
        name, constants = "trace_crystal", {**constants, **crystal_constants(prepared)}
    return Pipelines(device, shared=True).kernel(f"techniques/eikonal/shaders/{name}", constants)


def _run(
    device: Device,
    prepared: Prepared,
    quality: Quality,
    params: np.ndarray,
    textures: dict[str, Any],
    x: np.ndarray,
    d: np.ndarray,
    mode: str | None,
) -> np.ndarray:
    rays = np.zeros(len(x), TraceRay)
    rays["position"], rays["momentum"], rays["transmittance"] = x, d, 1.0
    if len(x) == 0:
        return rays
    head = np.zeros((), TraceParams)
    head["count"] = len(x)
    head["mode"] = MODES.index(mode or "ordinary")
    buffer = device.buffer(rays, "storage", "trace rays")
    groups = -(-len(x) // 64)
    _kernel(device, prepared, quality, mode).run(
        (min(groups, 32768), -(-groups // 32768), 1),
        {
            **textures,
            "volume": device.buffer(params.reshape(1), "uniform", "volume parameters"),
            "trace_params": device.buffer(head.reshape(1), "uniform"),
            "trace_rays": buffer,
        },
    )
    return device.read(buffer, TraceRay, len(x))
