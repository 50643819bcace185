"""Things that are laid: bricks in mortar, cobbles in sand, glazed tiles in grout."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pellucid.errors import SceneError
from pellucid.fields.numbers import number

from .maps import Maps, Values, averaged, color, grid, mixed, ramp, whole
from .noise import octaves, voronoi


def bricks(
    size: int = 256,
    seed: int = 0,
    tile_m: float = 0.45,
    brick_m: tuple[float, float] = (0.215, 0.065),
    joint_m: float = 0.010,
    relief_m: float = 0.005,
    wear: float = 0.5,
    brick_color: Sequence[float] = (0.36, 0.105, 0.06),
    mortar_color: Sequence[float] = (0.36, 0.33, 0.29),
) -> Maps:
    """Fired bricks in running bond. The faces lie about 0, the mortar `relief_m` below.

    A whole number of bricks and an even number of courses fill the tile: their size gives way a little.

    Parameters
    ----------
    size, seed, tile_m : texels along an edge, of random numbers, edge of the tile in metres.
    brick_m : length and height of a brick, metres.
    joint_m : width of the mortar, metres.
    relief_m : depth of the joints, metres.
    wear : 0 for sharp new bricks to 1 for chipped, rounded, pitted ones.
    brick_color, mortar_color : mean linear reflectances.

    Raises
    ------
    SceneError
        A parameter is out of its range.
    """
    size, rng, tile_m = grid(size, seed, tile_m)
    length, height = (number("brick_m", v, low=1e-4, unit="metres") for v in brick_m)
    joint_m = number("joint_m", joint_m, low=1e-4, high=0.5 * height, unit="metres")
    relief_m = number("relief_m", relief_m, low=0.0, high=height, unit="metres")
    wear = number("wear", wear, low=0.0, high=1.0)
    fired, mortar = color("brick_color", brick_color), color("mortar_color", mortar_color)
    columns, courses = whole(tile_m, length + joint_m), whole(tile_m, height + joint_m, even=True)
    pitch = np.array([tile_m / columns, tile_m / courses])
    # Of each brick: level, tilt in two ways, shift along the course, lightness, how much it was fired.
    each = rng.normal(size=(6, courses, columns)).clip(-2.0, 2.0)
    cloud, pits, chips, grain = rng.spawn(4)

    def evaluate(u: Values, v: Values) -> tuple[Values, Values]:
        coarse = octaves(u, v, whole(tile_m, 0.05), chips, 4)
        bow = octaves(u, v, whole(tile_m, 0.07), chips, 3)
        fine = octaves(u, v, whole(tile_m, 0.011), pits, 3)
        sand = octaves(u, v, whole(tile_m, 0.004), grain, 2, 0.8)
        stain = octaves(u, v, whole(tile_m, 0.15), cloud, 5, 0.6)
        course = np.floor(v * courses).astype(np.intp) % courses
        along = u * columns + 0.5 * (course % 2)
        column = np.floor(along).astype(np.intp) % columns
        level, tilt_x, tilt_y, shift, light, fire = each[:, course, column]
        # Place within the brick, from its centre, metres; courses are laid by hand, so nothing is quite straight.
        x = (along - np.floor(along) - 0.5) * pitch[0] + 0.0010 * shift + 0.0016 * coarse
        y = (v * courses - np.floor(v * courses) - 0.5) * pitch[1] + 0.0006 * shift + 0.0016 * bow
        half = 0.5 * (pitch - joint_m)
        corner = (0.0015 + 0.004 * wear) * (1.0 + 0.2 * shift)
        qx, qy = np.abs(x) - half[0] + corner, np.abs(y) - half[1] + corner
        inside = corner - np.hypot(np.maximum(qx, 0.0), np.maximum(qy, 0.0)) - np.minimum(np.maximum(qx, qy), 0.0)
        # Chips bite into the arris where the coarse noise is high.
        inside = inside - wear * 0.006 * ramp(coarse + 0.5 * fine, 0.18, 0.75) - 0.0005 * sand
        rim = 0.0015 + 0.0045 * wear
        face = np.sqrt(np.clip(1.0 - (1.0 - np.clip(inside / rim, 0.0, 1.0)) ** 2, 0.0, 1.0))
        texture = 0.00022 * sand * (0.4 + wear) + 0.0004 * fine - wear * 0.0012 * ramp(fine + 0.3 * sand, 0.38, 0.6)
        plane = 0.0004 * level + (0.004 * tilt_x * x + 0.01 * tilt_y * y)
        bed = -relief_m + 0.0006 * coarse + 0.0004 * fine + 0.00035 * sand
        # Mortar is pressed against bricks: it rises to them in a hollow curve.
        bed = bed + 0.22 * relief_m * ramp(inside, -0.5 * joint_m, 0.0)
        heights = bed + (np.minimum(plane, 0.0012) + texture - bed) * face
        burnt = 1.0 + 0.14 * light + 0.16 * stain + 0.16 * fine + 0.13 * sand
        redder = np.stack([1.0 + 0.03 * fire, 1.0 - 0.09 * fire, 1.0 - 0.13 * fire], axis=-1)
        brick = fired * burnt[..., None] * redder
        brick = mixed(brick, brick * np.array([0.42, 0.45, 0.55]), ramp(stain + 0.25 * fire + 0.3 * coarse, 0.45, 1.1))
        brick = mixed(brick, 0.3 * brick, 0.75 * ramp(sand - 0.4 * fine, 0.34, 0.6))
        dusty = ramp(coarse + 0.5 * fine + 0.4 * sand, 0.2, 0.8) * 0.45 + 0.25 * wear * (1.0 - ramp(inside, 0.0, rim))
        brick = mixed(brick, 0.6 * mortar + 0.4 * brick, np.clip(dusty, 0.0, 1.0))
        joint = mortar * (1.0 + 0.34 * sand + 0.22 * fine + 0.3 * stain)[..., None]
        joint = mixed(joint, 0.55 * joint, ramp(inside, -0.3 * joint_m, 0.0) * 0.8)
        return heights, mixed(joint, brick, ramp(face, 0.15, 0.7))

    heights, colors = averaged(size, evaluate)
    return Maps.of(heights, colors, tile_m)


def cobbles(
    size: int = 256,
    seed: int = 0,
    tile_m: float = 0.8,
    stone_m: float = 0.1,
    gap_m: float = 0.012,
    relief_m: float = 0.018,
    unevenness_m: float = 0.004,
    stone_color: Sequence[float] = (0.23, 0.215, 0.20),
    sand_color: Sequence[float] = (0.30, 0.23, 0.15),
) -> Maps:
    """Rounded paving stones in courses, with sand in the gaps. The highest stones reach about 0.

    Parameters
    ----------
    size, seed, tile_m : as in `bricks`.
    stone_m : edge of a stone, metres.
    gap_m : between stones at the level of the sand, metres.
    relief_m : height of a stone over the sand, metres.
    unevenness_m : standard deviation of the ground over half a metre, metres; puddles gather in it.
    stone_color, sand_color : mean linear reflectances.

    Raises
    ------
    SceneError
        A parameter is out of its range.
    """
    size, rng, tile_m = grid(size, seed, tile_m)
    stone_m = number("stone_m", stone_m, low=1e-4, high=tile_m / 2.0, unit="metres")
    gap_m = number("gap_m", gap_m, low=0.0, high=0.5 * stone_m, unit="metres")
    relief_m = number("relief_m", relief_m, low=0.0, high=stone_m, unit="metres")
    unevenness_m = number("unevenness_m", unevenness_m, low=0.0, high=stone_m, unit="metres")
    stone, sand_mean = color("stone_color", stone_color), color("sand_color", sand_color)
    columns, courses = whole(tile_m, stone_m), whole(tile_m, stone_m, even=True)
    across, along = np.meshgrid(np.arange(columns), np.arange(courses))
    moved = rng.uniform(-1.0, 1.0, (2, courses, columns))
    # Neighbours in a course lie side by side, those of the next course over the joints: setts, worn round.
    points = np.stack(
        [
            ((across + 0.5 + 0.5 * (along % 2) + 0.19 * moved[0]) / columns).ravel() % 1.0,
            ((along + 0.5 + 0.09 * moved[1]) / courses).ravel() % 1.0,
        ],
        axis=-1,
    )
    each = rng.normal(size=(6, len(points))).clip(-2.0, 2.0)
    bend, ground, rough, grain, dust = rng.spawn(5)

    def evaluate(u: Values, v: Values) -> tuple[Values, Values]:
        wide = octaves(u, v, whole(tile_m, 0.4), ground, 2)
        bump = octaves(u, v, whole(tile_m, 0.03), rough, 4)
        sand = octaves(u, v, whole(tile_m, 0.006), grain, 2, 0.9)
        dirt = octaves(u, v, whole(tile_m, 0.09), dust, 4)
        warp = 0.07 * stone_m / tile_m
        cells = voronoi(
            u + warp * octaves(u, v, whole(tile_m, 0.05), bend, 2),
            v + warp * octaves(u, v, whole(tile_m, 0.05), bend, 2),
            points,
            rounding=0.035 * stone_m / tile_m,
        )
        level, tilt_x, tilt_y, light, tint, _ = each[:, cells.owner]
        inside = cells.edge * tile_m - 0.5 * gap_m + 0.0012 * bump
        dome = np.clip(inside / (0.33 * stone_m), -0.2, 1.0)
        round_top = np.sign(dome) * np.sqrt(np.clip(1.0 - (1.0 - np.abs(dome)) ** 2.0, 0.0, 1.0)) ** 1.15
        wide = wide / max(float(wide.std()), 1e-9)
        base = unevenness_m * wide
        slope = 0.05 * (tilt_x * cells.offset_u + tilt_y * cells.offset_v) * tile_m
        top = base - relief_m + relief_m * (1.0 + 0.07 * level) * round_top + slope * ramp(dome, 0.0, 0.6)
        top = top + (0.0009 * bump + 0.00025 * sand) * ramp(dome, 0.0, 0.3)
        filled = base - 0.93 * relief_m + 0.0012 * dirt + 0.0011 * sand + 0.02 * relief_m * wide
        heights = np.maximum(top, filled)
        is_stone = ramp(top - filled, -0.0002, 0.0012)
        specks = ramp(sand + 0.4 * bump, 0.25, 0.6) - 0.8 * ramp(-sand + 0.3 * bump, 0.3, 0.65)
        lightness = 1.0 + 0.17 * light + 0.16 * bump + 0.28 * specks + 0.10 * dirt
        warmth = np.stack([1.0 + 0.035 * tint, 1.0 + 0.01 * tint, 1.0 - 0.05 * tint], axis=-1)
        body = stone * lightness[..., None] * warmth
        # Feet polish the tops; dirt of the gaps stays on the flanks.
        body = mixed(body, 0.45 * body + 0.28 * sand_mean, (1.0 - ramp(dome, 0.05, 0.55)) * 0.75)
        bed = sand_mean * (1.0 + 0.38 * sand + 0.2 * dirt)[..., None]
        bed = mixed(bed, bed * 0.6, ramp(-sand, 0.2, 0.7))
        return heights, mixed(bed, body, is_stone)

    heights, colors = averaged(size, evaluate)
    return Maps.of(heights - float(heights.max()), colors, tile_m)


def tiles(
    size: int = 256,
    seed: int = 0,
    tile_m: float = 0.3,
    edge_m: float = 0.097,
    grout_m: float = 0.003,
    relief_m: float = 0.0018,
    handmade: float = 0.5,
    glaze_color: Sequence[float] = (0.045, 0.22, 0.24),
    grout_color: Sequence[float] = (0.40, 0.38, 0.34),
) -> Maps:
    """Square glazed tiles with rounded rims in grout. The glaze lies about 0, the grout `relief_m` below.

    Parameters
    ----------
    size, seed, tile_m : as in `bricks`; tile_m is the edge of the map.
    edge_m : edge of one glazed tile, metres.
    grout_m : width of the joints, metres.
    relief_m : depth of the joints, metres.
    handmade : 0 for flat tiles of one colour to 1 for waved, tilted ones of many shades.
    glaze_color, grout_color : mean linear reflectances.

    Raises
    ------
    SceneError
        A parameter is out of its range.
    """
    size, rng, tile_m = grid(size, seed, tile_m)
    edge_m = number("edge_m", edge_m, low=1e-4, high=tile_m, unit="metres")
    grout_m = number("grout_m", grout_m, low=1e-5, high=0.5 * edge_m, unit="metres")
    relief_m = number("relief_m", relief_m, low=0.0, high=edge_m, unit="metres")
    handmade = number("handmade", handmade, low=0.0, high=1.0)
    glaze, grout = color("glaze_color", glaze_color), color("grout_color", grout_color)
    count = whole(tile_m, edge_m + grout_m)
    pitch = tile_m / count
    if grout_m >= pitch:
        raise SceneError("grout_m", f"is {grout_m:g}", f"use less than the pitch of {pitch:g} metres")
    each = rng.normal(size=(6, count, count)).clip(-2.0, 2.0)
    wave, cloud, grain, speck = rng.spawn(4)

    def evaluate(u: Values, v: Values) -> tuple[Values, Values]:
        swell = octaves(u, v, whole(tile_m, 0.035), wave, 2, 0.35)
        stain = octaves(u, v, whole(tile_m, 0.06), cloud, 4, 0.6)
        sand = octaves(u, v, whole(tile_m, 0.003), grain, 2, 0.8)
        dots = octaves(u, v, whole(tile_m, 0.006), speck, 2)
        row = np.floor(v * count).astype(np.intp) % count
        column = np.floor(u * count).astype(np.intp) % count
        level, tilt_x, tilt_y, light, tint, mottle = each[:, row, column]
        x = (u * count - np.floor(u * count) - 0.5) * pitch
        y = (v * count - np.floor(v * count) - 0.5) * pitch
        corner, half = 0.05 * edge_m, 0.5 * (pitch - grout_m)
        wander = 0.0008 * handmade * swell
        qx, qy = np.abs(x) - half + corner + wander, np.abs(y) - half + corner + wander
        inside = corner - np.hypot(np.maximum(qx, 0.0), np.maximum(qy, 0.0)) - np.minimum(np.maximum(qx, qy), 0.0)
        rim = 0.9 * relief_m + 0.0006
        face = np.sqrt(np.clip(1.0 - (1.0 - np.clip(inside / rim, 0.0, 1.0)) ** 2, 0.0, 1.0))
        plane = handmade * (0.00016 * swell + 0.0001 * level + 0.004 * (tilt_x * x + tilt_y * y))
        bed = -relief_m + 0.00013 * sand + 0.25 * relief_m * ramp(inside, -0.5 * grout_m, 0.0)
        heights = bed + (plane - bed) * face
        # Molten glaze flows off the rims: it is thin and pale there, and deep where it gathers.
        depth = 1.0 + handmade * (0.24 * light + 0.42 * stain * (1.0 + 0.5 * mottle)) + 0.1 * handmade * swell
        shade = np.stack([1.0 + 0.1 * tint, 1.0 + 0.02 * tint, 1.0 - 0.04 * tint], axis=-1)
        body = glaze * np.maximum(depth, 0.2)[..., None] * (1.0 + handmade * (shade - 1.0))
        pale = 0.55 * glaze + 0.45 * np.array([0.62, 0.55, 0.45])
        thin = 1.0 - ramp(inside + 0.0012 * swell + 0.0006 * stain, 0.0, rim)
        body = mixed(body, pale, (0.3 + 0.4 * handmade) * thin)
        body = mixed(body, 0.35 * body, 0.6 * handmade * ramp(dots, 0.5, 0.66))
        joint = grout * (1.0 + 0.2 * sand + 0.25 * stain)[..., None]
        return heights, mixed(joint, body, ramp(face, 0.1, 0.45))

    heights, colors = averaged(size, evaluate)
    return Maps.of(heights, colors, tile_m)
