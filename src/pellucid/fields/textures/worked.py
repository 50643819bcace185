"""Surfaces that were worked or grew: hammered glass, brushed metal, skin."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pellucid.fields.numbers import number

from .maps import Maps, Values, averaged, color, grid, mixed, places, ramp, whole
from .noise import octaves, scattered, voronoi


def hammered_glass(
    size: int = 256,
    seed: int = 0,
    tile_m: float = 0.12,
    hollow_m: float = 0.014,
    relief_m: float = 0.0007,
    tint: Sequence[float] = (0.93, 0.97, 0.95),
) -> Maps:
    """Rolled glass with shallow round hollows that meet in soft ridges. The ridges reach 0.

    Parameters
    ----------
    size, seed, tile_m : texels along an edge, of random numbers, edge of the tile in metres.
    hollow_m : mean distance between hollows, metres.
    relief_m : depth of the deepest hollow under the highest ridge, metres.
    tint : colour of the map.

    Raises
    ------
    SceneError
        A parameter is out of its range.
    """
    size, rng, tile_m = grid(size, seed, tile_m)
    hollow_m = number("hollow_m", hollow_m, low=tile_m / 64.0, high=tile_m / 3.0, unit="metres")
    relief_m = number("relief_m", relief_m, low=0.0, high=hollow_m, unit="metres")
    points = scattered(whole(tile_m, hollow_m) ** 2, rng)
    deep = rng.uniform(-0.12, 0.12, len(points))
    pitch = 1.0 / np.sqrt(len(points))
    u, v = places(size)
    # Each hollow is a paraboloid; a smooth minimum of all of them rounds the ridges.
    total = np.zeros((size, size))
    for (a, b), level in zip(points, deep, strict=True):
        du, dv = u - a, v - b
        rho2 = ((du - np.round(du)) ** 2 + (dv - np.round(dv)) ** 2) / pitch**2
        total += np.exp(-11.0 * (rho2 + level))
    heights = -np.log(total)
    heights = (heights - heights.max()) * (relief_m / np.ptp(heights))
    return Maps.of(heights, color("tint", tint), tile_m)


def brushed_metal(
    size: int = 256,
    seed: int = 0,
    tile_m: float = 0.05,
    relief_m: float = 8e-6,
    stroke_m: float = 0.02,
    metal_color: Sequence[float] = (0.56, 0.55, 0.53),
) -> Maps:
    """Metal brushed along u: fine scratches of all depths, a few deep ones. The unworked surface is at 0.

    Parameters
    ----------
    size, seed, tile_m : as in `hammered_glass`.
    relief_m : depth of the deepest scratch, metres.
    stroke_m : length of a stroke of the brush, metres.
    metal_color : mean linear reflectance.

    Raises
    ------
    SceneError
        A parameter is out of its range.
    """
    size, rng, tile_m = grid(size, seed, tile_m)
    relief_m = number("relief_m", relief_m, low=0.0, high=0.1 * tile_m, unit="metres")
    stroke_m = number("stroke_m", stroke_m, low=tile_m / size, high=tile_m, unit="metres")
    metal = color("metal_color", metal_color)
    u, v = places(size)
    fine = _streaks(rng, size, stroke_m / tile_m, 0.35 / size)
    broad = _streaks(rng, size, stroke_m / tile_m, 2.2 / size)
    deep = np.zeros((size, size))
    for _ in range(round(60 * tile_m / stroke_m)):
        x, y, depth = rng.random(), rng.random(), rng.uniform(0.2, 1.0) ** 2
        length, lean = stroke_m / tile_m * rng.uniform(0.3, 1.2), rng.normal(scale=0.012)
        du = u - x - np.round(u - x)
        across = v - y - lean * du
        across -= np.round(across)
        taper = np.clip(1.0 - (2.0 * du / length) ** 2, 0.0, 1.0)
        deep = np.maximum(deep, depth * taper * np.exp(-((across * size / 0.8) ** 2)))
    ground = 0.35 * fine + 0.25 * broad - 1.1 * deep
    heights = ground - ground.max()
    heights *= relief_m / max(float(-heights.min()), 1e-12)
    cloud = octaves(u, v, (2, 8), rng, 3)
    lightness = 1.0 + 0.10 * fine + 0.07 * broad + 0.05 * cloud - 0.18 * deep
    return Maps.of(heights, metal * lightness[..., None], tile_m)


def skin(
    size: int = 256,
    seed: int = 0,
    tile_m: float = 0.02,
    cell_m: float = 0.0011,
    relief_m: float = 0.00012,
    skin_color: Sequence[float] = (0.52, 0.27, 0.18),
) -> Maps:
    """Skin: plateaus between furrows of two depths, pores where furrows meet. The plateaus lie about 0.

    Parameters
    ----------
    size, seed, tile_m : as in `hammered_glass`.
    cell_m : distance between the deeper furrows, metres.
    relief_m : depth of the furrows, metres.
    skin_color : mean linear reflectance.

    Raises
    ------
    SceneError
        A parameter is out of its range.
    """
    size, rng, tile_m = grid(size, seed, tile_m)
    cell_m = number("cell_m", cell_m, low=tile_m / 64.0, high=tile_m / 3.0, unit="metres")
    relief_m = number("relief_m", relief_m, low=0.0, high=cell_m, unit="metres")
    flesh = color("skin_color", skin_color)
    count = whole(tile_m, cell_m)
    plateaus, parts = scattered(count**2, rng, tries=4), scattered(4 * count**2, rng, tries=3)
    pores = scattered(max(4, count**2 // 5), rng, tries=6)
    width = rng.uniform(0.5, 1.4, len(pores))
    level = rng.normal(size=len(plateaus)).clip(-2.0, 2.0)
    bend, blood, rough = rng.spawn(3)

    def evaluate(u: Values, v: Values) -> tuple[Values, Values]:
        wander = 0.16 / count
        wu = u + wander * octaves(u, v, count, bend, 2)
        wv = v + wander * octaves(u, v, count, bend, 2)
        blotch = octaves(u, v, 3, blood, 4, 0.6)
        fine = octaves(u, v, 4 * count, rough, 2)
        wide = octaves(u, v, max(2, count // 3), rough, 2)
        main = voronoi(wu, wv, plateaus, rounding=0.05 / count)
        minor = voronoi(wu, wv, parts, rounding=0.03 / count)
        hole = voronoi(wu, wv, pores)
        rho = np.hypot(hole.offset_u, hole.offset_v) * count / width[hole.owner]
        pore = np.exp(-((rho / 0.17) ** 2))
        furrow = np.exp(-np.maximum(main.edge, 0.0) * count / 0.10)
        crease = np.exp(-np.maximum(minor.edge, 0.0) * count / 0.06)
        cushion = ramp(main.edge * count, 0.0, 0.5)
        heights = 0.45 * cushion - 0.75 * furrow - 0.3 * crease - 0.85 * pore
        heights = heights + 0.09 * fine + 0.22 * wide + 0.06 * level[main.owner] * ramp(main.edge * count, 0.0, 0.25)
        redness = 0.35 + 0.55 * blotch + 0.12 * fine
        body = flesh * (1.0 + 0.07 * fine + 0.05 * blotch - 0.10 * (0.6 * furrow + 0.4 * crease))[..., None]
        body = mixed(body, body * np.array([1.02, 0.76, 0.72]), np.clip(redness, 0.0, 1.0))
        body = mixed(body, body * np.array([0.82, 0.66, 0.62]), np.clip(0.8 * pore + 0.22 * furrow, 0.0, 1.0))
        return heights, body

    heights, colors = averaged(size, evaluate)
    heights -= np.quantile(heights, 0.9)
    return Maps.of(heights * (relief_m / max(float(-heights.min()), 1e-12)), colors, tile_m)


def _streaks(rng: np.random.Generator, size: int, length: float, width: float) -> Values:
    """White noise drawn out along u and a little across, with period 1; standard deviation 1."""
    ku, kv = np.fft.fftfreq(size, 1.0 / size)[None, :], np.fft.fftfreq(size, 1.0 / size)[:, None]
    # A stroke fades as exp(-|u| / length): its ends are not all alike, and some are much longer than others.
    kept = np.exp(-2.0 * (np.pi * kv * width) ** 2) / (1.0 + (np.pi * ku * length) ** 2)
    noise = np.fft.ifft2(np.fft.fft2(rng.normal(size=(size, size))) * kept).real
    return np.asarray((noise - noise.mean()) / noise.std())
