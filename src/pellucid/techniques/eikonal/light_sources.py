"""Lamps as fronts of light on the box of a volume [tevs2007, 4.2]; NumPy only."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from pellucid.errors import SceneError
from pellucid.scene import AreaLight, DirectionalLight, LightQuality, PointLight
from pellucid.techniques.eikonal.proxies import Box
from pellucid.techniques.eikonal.resources import scale_of

# An area light is taken as this many points along each edge.
AREA_POINTS = 3
MOST_TILES = 1 << 22


@dataclass(frozen=True)
class Source:
    """One front in object space."""

    kind: int
    position: np.ndarray
    direction: np.ndarray
    power: np.ndarray
    casts: bool
    inside: bool
    faces: np.ndarray  # (F, 4): face, tiles, tiles, first
    patch_flux: float  # largest of its patches, brightest channel
    total_flux: float

    @property
    def tiles(self) -> int:
        return int((self.faces[:, 1] * self.faces[:, 2]).sum())


def sources_of(lamp: object, world: np.ndarray, box: Box, voxel: float, quality: LightQuality) -> Iterator[Source]:
    """The fronts of a lamp: one, or one for each point of an area light."""
    inverse = np.linalg.inv(world)
    scale = scale_of(world)

    def point(x: Any) -> np.ndarray:
        return np.asarray(inverse[:3, :3] @ np.asarray(x, float) + inverse[:3, 3])

    def way(d: Any) -> np.ndarray:
        v = inverse[:3, :3] @ np.asarray(d, float)
        return np.asarray(v / np.linalg.norm(v))

    if isinstance(lamp, DirectionalLight):
        power = np.asarray(lamp.color, float) * lamp.irradiance
        yield _front(0, np.zeros(3), way(lamp.direction), power, lamp.cast_shadow, box, voxel, scale, quality)
    elif isinstance(lamp, PointLight):
        power = np.asarray(lamp.color, float) * lamp.intensity
        yield _front(1, point(lamp.position), np.zeros(3), power, lamp.cast_shadow, box, voxel, scale, quality)
    elif isinstance(lamp, AreaLight):
        u, v = np.asarray(lamp.edge_u, float), np.asarray(lamp.edge_v, float)
        normal = np.cross(u, v)
        power = np.asarray(lamp.color, float) * lamp.radiance * np.linalg.norm(normal) / AREA_POINTS**2
        steps = (np.arange(AREA_POINTS) + 0.5) / AREA_POINTS - 0.5
        for s in steps:
            for t in steps:
                x = point(np.asarray(lamp.position, float) + s * u + t * v)
                yield _front(2, x, way(normal), power, lamp.cast_shadow, box, voxel, scale, quality)


def _front(
    kind: int,
    position: np.ndarray,
    direction: np.ndarray,
    power: np.ndarray,
    casts: bool,
    box: Box,
    voxel: float,
    scale: float,
    quality: LightQuality,
) -> Source:
    center, half = box
    at = position - center
    inside = kind != 0 and bool((np.abs(at) < half).all())
    edge = quality.front_voxels * voxel
    rows, first, largest, total = [], 0, 0.0, 0.0
    for face in range(6):
        axis, side = divmod(face, 2)
        sign = 2.0 * side - 1.0
        across = [(axis + 1) % 3, (axis + 2) % 3]
        outside = sign * at[axis] > half[axis]
        facing = -sign * direction[axis] > 1e-6 if kind == 0 else inside or outside
        if not facing:
            continue
        # A front that begins at a point inside is divided as it grows.
        tiles = [max(1, int(np.ceil(2.0 * half[a] / edge - 1e-6))) for a in across]
        tiles = [min(t, 64) for t in tiles] if inside else tiles
        rows.append((face, *tiles, first))
        first += tiles[0] * tiles[1]
        share, whole = _shares(kind, at, direction, half, axis, sign, across, tiles, inside, scale)
        largest, total = max(largest, share), total + whole
    if first > MOST_TILES:
        reason = f"asks for {first / 1e6:.1f} million patches of light on the volume's box"
        raise SceneError("light.front_voxels", reason, "use larger patches or fewer voxels")
    brightest = float(np.max(power))
    faces = np.array(rows, np.uint32).reshape(-1, 4)
    return Source(kind, position, direction, power, casts, inside, faces, brightest * largest, brightest * total)


def _shares(
    kind: int,
    position: np.ndarray,
    direction: np.ndarray,
    half: np.ndarray,
    axis: int,
    sign: float,
    across: list[int],
    tiles: list[int],
    inside: bool,
    scale: float,
) -> tuple[float, float]:
    """Largest and summed share of the light among the patches of a face: m^2 of beam, or solid angle."""
    area = 4.0 * half[across[0]] * half[across[1]]
    if kind == 0:
        beam = area * abs(direction[axis]) * scale**2
        return beam / (tiles[0] * tiles[1]), beam
    grids = [(np.arange(n) + 0.5) / n * 2.0 - 1.0 for n in tiles]
    u, v = np.meshgrid(*grids, indexing="ij")
    if inside:
        distance2, normal, cell = 1.0 + u**2 + v**2, 1.0, 4.0 / (tiles[0] * tiles[1])
    else:
        normal = abs(half[axis] - sign * position[axis])
        distance2 = normal**2 + (u * half[across[0]] - position[across[0]]) ** 2
        distance2 = distance2 + (v * half[across[1]] - position[across[1]]) ** 2
        cell = area / (tiles[0] * tiles[1])
    solid = cell * normal / distance2**1.5
    return float(solid.max()), float(solid.sum())
