"""A lake among hills, about as large as that of [mihalik2008]: ground, stones, trees and reeds from an OBJ file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from pellucid.fields import landscape
from pellucid.fields.landscape import Ground, Patch
from pellucid.io.meshes import MeshData
from pellucid.io.obj import write_obj
from pellucid.scene import Camera, Mesh, Scene, Water
from pellucid.scene.shapes import vertex_normals

from . import stage

SIZE_M = 90.0

# Linear base colours
STONE = (0.27, 0.26, 0.245)
BARK = (0.085, 0.06, 0.042)
NEEDLES = (0.022, 0.058, 0.018)
REED = (0.16, 0.19, 0.06)


def lake_surroundings(folder: Path, corners: int = 193, seed: int = 5, trees: int = 110, texels: int = 1024) -> Path:
    """Writes lake.obj with its materials and the picture of its ground, and returns its path.

    Parameters
    ----------
    folder : that exists. corners : of the ground along an edge; 193 make 74 000 of 85 000 triangles.
    seed : of random numbers. trees : how many. texels : of the map of the ground.
    """
    ground = landscape.lake_basin(corners, seed, SIZE_M)
    rng = np.random.default_rng(seed + 1)
    trunks, needles = zip(*_forest(ground, trees, rng), strict=True)
    parts = {
        "stones": (landscape.joined(_stones(ground, rng)), STONE),
        "trunks": (landscape.joined(trunks), BARK),
        "needles": (landscape.joined(needles), NEEDLES),
        "reeds": (landscape.joined(_reeds(ground, rng)), REED),
    }
    soil = ground.patch()
    picture = landscape.ground_map(ground, texels, seed)
    data = [
        MeshData(soil.vertices, soil.faces, _normals(soil), ground.uvs(), (1.0, 1.0, 1.0), picture, "ground"),
        *(MeshData(p.vertices, p.faces, _normals(p), None, color, None, name) for name, (p, color) in parts.items()),
    ]
    write_obj(folder / "lake.obj", data)
    return folder / "lake.obj"


def lake_meshes(folder: Path | None = None, **size: Any) -> list[Mesh]:
    """The surroundings of the lake as meshes that were written and read; see :func:`lake_surroundings`."""
    if folder is None:
        with TemporaryDirectory() as aside:
            return [mesh.replace(origin=None) for mesh in lake_meshes(Path(aside), **size)]
    return Mesh.load_all(lake_surroundings(folder, **size), roughness=0.9, specular=0.02)


def lake_scene(
    waves: Any = None, camera: Camera | None = None, sun: Sequence[float] = (34.0, 150.0), folder: Path | None = None,
    size: dict[str, Any] | None = None, **water: Any,
) -> Scene:  # fmt: skip
    """The lake under a clear sky.

    Parameters
    ----------
    waves : heights of the water. camera : from the shore when not given.
    sun : its elevation and azimuth, degrees. folder : keeps the OBJ file. size : of :func:`lake_surroundings`.
    water : fields of the Water.
    """
    sky, lamp = stage.daylight(*sun)
    lake = Water(**({"extent_m": SIZE_M, "medium": "clear lake", "waves": waves} | water))
    return Scene(
        camera or Camera((1.5, 1.6, 20.5), (-0.5, 0.45, 8.0), fov_deg=46.0, far_m=400.0),
        sky, [lamp], [*lake_meshes(folder, **(size or {})), lake], exposure=0.8, tone_mapping="khronos",
    )  # fmt: skip


def underwater_window(
    waves: Any = None, sun: Sequence[float] = (62.0, 20.0), camera: Camera | None = None, **water: Any
) -> Scene:
    """The lake seen by a diver who looks up: the whole sky in a window, and the bed of the lake mirrored around it."""
    scene = lake_scene(waves, camera or Camera((0.0, -2.3, 9.0), (0.0, 0.0, 7.6), fov_deg=100.0), sun, **water)
    hull = boat()
    afloat = Mesh(hull.vertices, hull.faces, base_color=(0.30, 0.13, 0.05), roughness=0.5, rotation=(0.0, -25.0, 0.0),
                  position=(-1.1, 0.08, 7.0))  # fmt: skip
    return scene.replace(objects=[*scene.objects, afloat], exposure=1.2)


def boat(length_m: float = 3.4, width_m: float = 1.2, depth_m: float = 0.55, stations: int = 33) -> Patch:
    """The hull of a rowing boat along x about the origin, its rim a third of its depth above y = 0."""
    at = np.linspace(-1.0, 1.0, stations)
    around = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 17)
    x, turn = np.meshgrid(at, around, indexing="ij")
    wide = 0.5 * width_m * (1.0 - x**2) ** 0.75
    deep = depth_m * (1.0 - x**4) ** 0.5
    rim = depth_m * (0.33 + 0.3 * x**2)
    vertices = np.stack([0.5 * length_m * x, rim - deep * np.cos(turn), wide * np.sin(turn)], axis=-1)
    k = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (part.ravel() for part in (k[:-1, :-1], k[1:, :-1], k[:-1, 1:], k[1:, 1:]))
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([b, d, c], 1)])
    return Patch(vertices.reshape(-1, 3), faces.astype(np.int32))


def _normals(patch: Patch) -> np.ndarray:
    return np.asarray(vertex_normals(patch.vertices, patch.faces), np.float32)


def _forest(ground: Ground, count: int, rng: np.random.Generator) -> list[tuple[Patch, Patch]]:
    """Spruces on dry and not too steep ground; they stand in groups."""
    trees: list[tuple[Patch, Patch]] = []
    kinds = [landscape.conifer(1.0, seed) for seed in range(6)]
    steep = Ground(ground.steepness(), ground.size_m)
    while len(trees) < count:
        x, z = rng.uniform(-0.47, 0.47, 2) * ground.size_m
        for dx, dz in rng.normal(0.0, 2.5, (rng.integers(1, 6), 2)):
            at = np.array([x + dx, 0.0, z + dz])
            at[1] = ground.height(at[0], at[2])
            near = abs(at[0]) < 9.0 and at[2] > 0.0  # where the camera stands
            if at[1] < 1.2 or steep.height(at[0], at[2]) > 0.6 or near:
                continue
            high = rng.uniform(3.5, 8.0)
            turn = rng.uniform(0.0, 6.3)
            trunk, needles = kinds[rng.integers(len(kinds))]
            trees.append((trunk.placed(at, turn, high), needles.placed(at, turn, high)))
    return trees[:count]


def _stones(ground: Ground, rng: np.random.Generator) -> list[Patch]:
    """Boulders along the shore and in the shallows, some of which look out of the water."""
    stones: list[Patch] = []
    kinds = [landscape.stone(seed) for seed in range(8)]
    while len(stones) < 46:
        x, z = rng.uniform(-0.4, 0.4, 2) * ground.size_m
        height = float(ground.height(x, z))
        radius = float(rng.uniform(0.25, 0.5) * (1.0 + 2.2 * rng.random() ** 4))
        if -1.6 * radius - 0.3 < height < 0.6:
            squat = radius * np.array([1.0, rng.uniform(0.6, 0.9), rng.uniform(0.75, 1.0)])
            at = (x, height + 0.25 * radius, z)
            stones.append(kinds[rng.integers(len(kinds))].placed(at, rng.uniform(0.0, 6.3), squat))
    return stones


def _reeds(ground: Ground, rng: np.random.Generator) -> list[Patch]:
    """Clumps in water of less than half a metre."""
    clumps: list[Patch] = []
    while len(clumps) < 36:
        x, z = rng.uniform(-0.4, 0.4, 2) * ground.size_m
        depth = -float(ground.height(x, z))
        if 0.05 < depth < 0.5:
            for dx, dz in rng.normal(0.0, 1.0, (3, 2)):
                at = (x + dx, float(ground.height(x + dx, z + dz)), z + dz)
                clumps.append(landscape.reeds(40, 1.5 + depth, 0.7, int(rng.integers(1 << 30))).placed(at))
    return clumps[:36]
