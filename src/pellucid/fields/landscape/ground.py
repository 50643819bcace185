"""Ground as heights over a square: a basin for a lake, hills around it, and what weather does to them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.landscape.patch import Patch
from pellucid.fields.numbers import number
from pellucid.fields.textures.maps import ramp
from pellucid.fields.textures.noise import octaves

Values = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Ground:
    """Heights at the corners of a grid over a square about the origin.

    Parameters
    ----------
    heights_m : (N, N) metres, columns along x, rows along z, the first at the lowest x and z.
    size_m : edge of the square, metres.
    """

    heights_m: Values
    size_m: float

    @property
    def cell_m(self) -> float:
        """Distance of neighbouring corners, metres."""
        return self.size_m / (len(self.heights_m) - 1)

    def axis(self) -> Values:
        """(N,) x of the columns, which is z of the rows, metres."""
        return np.linspace(-0.5 * self.size_m, 0.5 * self.size_m, len(self.heights_m))

    def height(self, x_m: npt.ArrayLike, z_m: npt.ArrayLike) -> Values:
        """Height at places, metres; bilinear, as at the border beyond it."""
        from scipy.ndimage import map_coordinates

        z, x = np.broadcast_arrays(np.asarray(z_m, float), np.asarray(x_m, float))
        places = [v.ravel() / self.cell_m + 0.5 * (len(self.heights_m) - 1) for v in (z, x)]
        return np.asarray(map_coordinates(self.heights_m, places, order=1, mode="nearest")).reshape(x.shape)

    def steepness(self) -> Values:
        """(N, N) slope, metres per metre."""
        along_z, along_x = np.gradient(self.heights_m, self.cell_m)
        return np.hypot(along_x, along_z)

    def patch(self) -> Patch:
        """Two triangles a cell, seen from above."""
        count = len(self.heights_m)
        z, x = np.meshgrid(self.axis(), self.axis(), indexing="ij")
        vertices = np.stack([x, self.heights_m, z], axis=-1).reshape(-1, 3)
        first = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).ravel()
        near, far = first + count, first
        faces = np.concatenate([np.stack([near, near + 1, far + 1], 1), np.stack([near, far + 1, far], 1)])
        return Patch(vertices, faces.astype(np.int32))

    def uvs(self) -> npt.NDArray[np.float32]:
        """(N * N, 2) places in a map over the whole square; its top lies towards -z."""
        at = np.linspace(0.0, 1.0, len(self.heights_m))
        v, u = np.meshgrid(1.0 - at, at, indexing="ij")
        return np.stack([u, v], axis=-1).reshape(-1, 2).astype(np.float32)


def lake_basin(
    corners: int = 193,
    seed: int = 0,
    size_m: float = 90.0,
    lake_m: Sequence[float] = (30.0, 22.0),
    depth_m: float = 5.0,
    hills_m: float = 16.0,
) -> Ground:
    """A lake's bed and its surroundings; the shore is at height 0.

    Fractal noise [musgrave1989], ridged for the hills, over a basin whose shore winds; then :func:`weathered`.

    Parameters
    ----------
    corners : of the grid along each edge, 9 to 2049. seed : of random numbers.
    size_m : edge of the square, metres. lake_m : half axes of the lake along x and z, metres.
    depth_m : of the lake's middle, metres. hills_m : height of the hills, metres.

    Raises
    ------
    SceneError : a value out of its range.
    """
    if not 9 <= corners <= 2049:
        raise SceneError("corners", f"are {corners}", "use 9 to 2049")
    size_m = number("size_m", size_m, low=1e-3, high=1e5, unit="metres")
    half = [number("lake_m", v, low=1e-3 * size_m, high=size_m, unit="metres") for v in lake_m]
    depth_m = number("depth_m", depth_m, low=0.0, high=size_m, unit="metres")
    hills_m = number("hills_m", hills_m, low=0.0, high=size_m, unit="metres")
    rng = np.random.default_rng(seed)
    shore, bed, ridges, grain = rng.spawn(4)
    ground = Ground(np.zeros((corners, corners)), size_m)
    z, x = np.meshgrid(ground.axis(), ground.axis(), indexing="ij")
    v, u = z / size_m + 0.5, x / size_m + 0.5
    out = np.hypot(x / half[0], z / half[1]) * (1.0 + 0.4 * octaves(u, v, 3, shore, 4)) - 1.0
    under = -depth_m * ramp(-out, 0.0, 0.85) * (1.0 + 0.25 * octaves(u, v, 6, bed, 3))
    ridged = 1.0 - np.abs(octaves(u, v, 2, ridges, 5))
    hills = hills_m * ramp(out, 0.1, 1.9) * (0.15 + 0.85 * ridged**2)
    beach = 0.06 * size_m * 0.2 * np.maximum(out, 0.0)
    rough = 0.012 * hills_m * octaves(u, v, 12, grain, 4) * ramp(np.abs(out), 0.0, 0.25)
    return weathered(Ground(under + hills + beach + rough, size_m), talus=0.75)


def weathered(ground: Ground, talus: float = 0.7, rounds: int = 40) -> Ground:
    """Thermal weathering [musgrave1989]: what lies steeper than the talus slides down to the neighbours.

    No matter comes or goes.

    Parameters
    ----------
    talus : slope at which loose ground rests, metres per metre > 0. rounds : how often it slides.
    """
    heights = np.array(ground.heights_m)
    rest = number("talus", talus, low=1e-6) * ground.cell_m
    for _ in range(rounds):
        for axis in (0, 1):
            excess = np.diff(heights, axis=axis)
            # A quarter of what is too much, between two corners: four neighbours take at most all of it.
            slide = 0.25 * np.sign(excess) * np.maximum(np.abs(excess) - rest, 0.0)
            move = np.zeros_like(heights)
            low, high = (
                tuple(slice(a, b) if i == axis else slice(None) for i in (0, 1)) for a, b in ((0, -1), (1, None))
            )
            move[low] += slide
            move[high] -= slide
            heights += move
    return Ground(heights, ground.size_m)


def ground_map(ground: Ground, texels: int = 1024, seed: int = 0) -> npt.NDArray[np.float32]:
    """(texels, texels, 3) linear colours by height and slope: mud, sand at the shore, grass, rock where it is steep."""
    rng = np.random.default_rng(seed)
    at = (np.arange(texels) + 0.5) / texels
    v, u = np.meshgrid(at, at, indexing="ij")
    x, z = (u - 0.5) * ground.size_m, (v - 0.5) * ground.size_m
    height = ground.height(x, z)
    slope = Ground(ground.steepness(), ground.size_m).height(x, z)
    coarse, fine = octaves(u, v, 9, rng, 5, 0.6), octaves(u, v, 90, rng, 3, 0.7)
    color = np.empty((texels, texels, 3))
    color[:] = (0.16, 0.13, 0.085)  # mud

    def cover(share: Values, with_color: tuple[float, float, float]) -> None:
        color[:] += share[..., None] * (np.array(with_color) - color)

    cover(ramp(height + 0.7 * coarse, -2.6, -0.5), (0.37, 0.31, 0.21))  # sand
    cover(ramp(height + 0.35 * coarse + 0.15 * fine, 0.25, 0.8), (0.075, 0.125, 0.028))  # grass
    cover(0.7 * ramp(coarse + 0.4 * fine, 0.05, 0.5) * ramp(height, 0.6, 1.5), (0.14, 0.15, 0.05))  # dry grass
    cover(ramp(slope + 0.25 * coarse, 0.55, 0.75), (0.22, 0.205, 0.185))  # rock
    color *= (1.0 + 0.30 * fine + 0.2 * coarse)[..., None]
    return np.clip(color, 0.0, 1.0).astype(np.float32)
