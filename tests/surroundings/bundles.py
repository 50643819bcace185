"""Bundles of rays made by hand, and their landing on meshes."""

from __future__ import annotations

from typing import Any

import numpy as np

from pellucid.gpu import Device
from pellucid.scene import Camera, Environment, Mesh, Scene
from pellucid.surroundings import Reach, Surroundings
from pellucid.surroundings.layouts import OUT_CAUSTIC, LookCount, OutPatch


def unit(rows: np.ndarray) -> np.ndarray:
    return rows / np.linalg.norm(rows, axis=-1, keepdims=True)


def bundles(points: np.ndarray, ways: np.ndarray, flux: np.ndarray, kind: int = OUT_CAUSTIC) -> np.ndarray:
    """A front of (V + 1, U + 1) corner rays as V x U bundles; flux (V, U, 3) or what broadcasts to it."""
    out = np.zeros((points.shape[0] - 1, points.shape[1] - 1), OutPatch)
    for k, (v, u) in enumerate(((0, 0), (0, 1), (1, 0), (1, 1))):
        rows, columns = slice(v, v + out.shape[0]), slice(u, u + out.shape[1])
        out[f"corner_{k}"], out[f"way_{k}"] = points[rows, columns], unit(ways)[rows, columns]
    out["flux"], out["kind"] = flux, kind
    return out.ravel()


def beam(
    centre: tuple[float, float, float],
    edge_u: tuple[float, float, float],
    edge_v: tuple[float, float, float],
    count: int,
    irradiance: Any = 1.0,
    kind: int = OUT_CAUSTIC,
    way: tuple[float, float, float] | None = None,
) -> np.ndarray:
    """Parallel light through a rectangle, of the given irradiance on it; along edge_u x edge_v unless told."""
    u, v = np.array(edge_u), np.array(edge_v)
    across = np.linspace(-0.5, 0.5, count + 1)
    points = np.array(centre) + across[None, :, None] * u + across[:, None, None] * v
    normal = np.cross(u, v)
    flux = np.broadcast_to(irradiance, 3) * np.linalg.norm(normal) / count**2
    return bundles(points, np.broadcast_to(normal if way is None else np.array(way), points.shape), flux, kind)


def surroundings(device: Device, *meshes: Mesh, **rest: Any) -> Surroundings:
    out = Surroundings(device)
    settings = {"camera": Camera((0, 1, 3)), "environment": Environment.constant(0.0)} | rest
    out.prepare(Scene(objects=meshes, **settings), (64, 48))
    return out


def land(
    around: Surroundings, records: np.ndarray, texel_m: float = 0.02, reach: Reach | None = None, **rest: Any
) -> None:
    """The whole sequence, in one submission."""
    device, maps = around.device, around.caustics
    maps.prepare(around.geometry, [reach or Reach((0, 0.5, 0), 3.0, 0.5)], texel_m, **rest)
    outgoing = device.buffer(records, "storage", "outgoing")
    queue = device.buffer(np.array([(-(-len(records) // 64), 1, 1, len(records))], LookCount), "indirect", "queue")
    encoder = device.wgpu.create_command_encoder()
    maps.begin(encoder, 2.0 * float(records["flux"].sum(axis=0).max()) or 1.0)
    maps.land(encoder, outgoing, queue)
    maps.resolve(encoder)
    device.wgpu.queue.submit([encoder.finish()])


def total(records: np.ndarray, kind: int = OUT_CAUSTIC) -> np.ndarray:
    """Power (3,) of all bundles of a kind."""
    return records["flux"][records["kind"] == kind].sum(axis=0, dtype=np.float64)


def joined(*parts: np.ndarray) -> np.ndarray:
    """Lists of bundles as one; `np.concatenate` would drop the padding of the layout."""
    out = np.zeros(sum(map(len, parts)), OutPatch)
    for part, start in zip(parts, np.cumsum([0, *map(len, parts)]), strict=False):
        out[start : start + len(part)] = part
    return out
