"""A contact sheet of the procedural textures: heights, normals, colours, and lit from the upper left.

Run ``python tools/texture_sheet.py sheet.png [--size 256] [--seed 0] [--only bricks,drops]``, or with ``--page``
for the picture of docs/textures.md. Opaque ones are shown
lit as two by two tiles, so that seams and repetition would be seen; water and glass lie on paper with a dark grid.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np
import OpenImageIO

from pellucid.fields import Drops, Ripples, textures
from pellucid.fields.textures import Maps
from pellucid.io.contact_sheet import contact_sheet
from pellucid.io.images import write_image

PAGE = Path(__file__).resolve().parents[1] / "docs" / "images" / "textures.jpg"
NAMES = ("bricks", "cobbles", "tiles", "hammered_glass", "drops", "puddles", "brushed_metal", "skin")
CLEAR = {"hammered_glass", "drops", "puddles"}
#: GGX roughness and reflectance at normal incidence for the lit picture.
LOOKS = {"bricks": (0.8, 0.03), "cobbles": (0.65, 0.04), "tiles": (0.12, 0.05), "skin": (0.4, 0.03),
         "brushed_metal": (0.25, 0.6)}  # fmt: skip
SUN = np.array([-0.55, 0.5, 0.67]) / np.linalg.norm([-0.55, 0.5, 0.67])
N_WATER = 1.33


def encoded(linear: np.ndarray) -> np.ndarray:
    """sRGB bytes."""
    x = np.clip(linear, 0.0, 1.0)
    curve = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    return np.asarray(curve * 255.0 + 0.5, dtype=np.uint8)


def sunlit(heights: np.ndarray, tile_m: float) -> np.ndarray:
    """Share of the sun that arrives, softened over a few steps of the ray, with the tile repeated."""
    size = len(heights)
    step = np.array([SUN[0], -SUN[1]]) / np.hypot(SUN[0], SUN[1])
    rise = SUN[2] / np.hypot(SUN[0], SUN[1]) * tile_m / size
    lit = np.ones_like(heights)
    reach = int(min(size // 2, np.ptp(heights) / rise + 2))
    for k in np.linspace(1, reach, min(reach, 60)):
        moved = np.roll(heights, (-round(step[1] * k), -round(step[0] * k)), axis=(0, 1))
        lit = np.minimum(lit, np.clip(1.0 + (heights + k * rise - moved) / (0.35 * k * rise + 1e-9), 0.0, 1.0))
    return lit


def openness(heights: np.ndarray, tile_m: float) -> np.ndarray:
    """Rough share of the sky that is seen: mean over directions of the highest slope upwards."""
    size, total = len(heights), np.zeros_like(heights)
    for turn in np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False):
        steepest = np.zeros_like(heights)
        for k in (1, 2, 4, 7, 12):
            to = (round(k * np.sin(turn)), round(k * np.cos(turn)))
            apart = max(np.hypot(*to), 1.0) * tile_m / size
            steepest = np.maximum(steepest, (np.roll(heights, to, axis=(0, 1)) - heights) / apart)
        total += 1.0 / (1.0 + steepest**2)
    return total / 12


def glint(normals: np.ndarray, roughness: float, f0: float) -> np.ndarray:
    """GGX highlight of the sun, seen from straight above."""
    half = SUN + np.array([0.0, 0.0, 1.0])
    half /= np.linalg.norm(half)
    a2 = roughness**4
    nh = np.clip(normals @ half, 0.0, 1.0)
    return f0 * a2 / (4.0 * (nh**2 * (a2 - 1.0) + 1.0) ** 2 + 1e-6)


def sky(normals: np.ndarray) -> np.ndarray:
    """Radiance that a mirror seen from above shows: a window of light towards the upper left, a pale sky around it."""
    mirrored = 2.0 * normals[..., 2:3] * normals - np.array([0.0, 0.0, 1.0])
    window = (np.abs(mirrored[..., 0] + 0.45) < 0.2) & (np.abs(mirrored[..., 1] - 0.4) < 0.25)
    return 0.35 + 0.25 * mirrored[..., 1] + 14.0 * window


def lit(name: str, maps: Maps) -> np.ndarray:
    """(H, W, 3) linear radiance of the surface from straight above."""
    heights, normals = maps.heights_m.astype(float), maps.normals.astype(float)
    if name in CLEAR:
        return through(heights, normals, maps, wet=heights > 0.0 if name != "hammered_glass" else heights <= 0.0)
    shine, f0 = LOOKS[name]
    if name == "brushed_metal":
        spread = normals * [1.0, 6.0, 1.0]
        spread /= np.linalg.norm(spread, axis=-1, keepdims=True)
        return maps.colors * (0.3 + 0.8 * glint(spread, 0.75, 1.0))[..., None]
    lambert = np.clip(normals @ SUN, 0.0, 1.0) * sunlit(heights, maps.tile_m)
    ambient = 0.32 * openness(heights, maps.tile_m)
    lobe = glint(normals, shine, f0) * sunlit(heights, maps.tile_m)
    mirror = f0 * sky(normals) if shine < 0.3 else 0.0
    return maps.colors * (1.0 * lambert + ambient)[..., None] + np.asarray(lobe + mirror)[..., None]


def gathered(bend: np.ndarray, wet: np.ndarray) -> np.ndarray:
    """Sun on the paper: where the rays through all texels arrive, shifted by the slant of the sun under water."""
    size = len(bend)
    slant = np.where(wet[..., None], 2.0 * SUN[:2], 0.0)
    j, i = np.mgrid[:size, :size].astype(float)
    x, y = i - bend[..., 0] - slant[..., 0], j + bend[..., 1] + slant[..., 1]
    light = np.zeros((size, size))
    for dj in (0, 1):
        for di in (0, 1):
            share = np.abs(1 - di - x % 1.0) * np.abs(1 - dj - y % 1.0)
            np.add.at(light, ((np.floor(y).astype(int) + dj) % size, (np.floor(x).astype(int) + di) % size), share)
    return 0.3 + 0.7 * light


def through(heights: np.ndarray, normals: np.ndarray, maps: Maps, wet: np.ndarray) -> np.ndarray:
    """Paper with a grid under water or under glass 6 mm over it; refraction to first order, Schlick's mirror."""
    size = len(heights)
    slope = -normals[..., :2] / normals[..., 2:3]
    depth = np.where(wet, heights + (0.03 if heights.max() <= 0.0 else 0.0), 0.0)
    bend = (1.0 - 1.0 / N_WATER) * depth[..., None] * slope * size / maps.tile_m
    j, i = np.mgrid[:size, :size].astype(float)
    x, y = (i - bend[..., 0]) / size, (j + bend[..., 1]) / size
    line = np.minimum(np.abs(x * 16 % 1.0 - 0.5), np.abs(y * 16 % 1.0 - 0.5)) * size / 16
    paper = np.where(line[..., None] < 1.0, [0.04, 0.08, 0.18], [0.62, 0.55, 0.45])
    fresnel = 0.02 + 0.98 * (1.0 - normals[..., 2]) ** 5
    light = gathered(bend, wet)
    body = paper * maps.colors * light[..., None]
    return np.where(wet, fresnel * sky(normals), 0.0)[..., None] + np.where(wet, 1.0 - fresnel, 1.0)[..., None] * body


def rows(name: str, maps: Maps) -> list[tuple[str, np.ndarray]]:
    """Four titled pictures of one texture."""
    h = maps.heights_m
    picture = lit(name, maps) if name in CLEAR else np.tile(lit(name, maps), (2, 2, 1))
    grey = np.repeat(((h - h.min()) / max(np.ptp(h), 1e-12))[..., None], 3, axis=-1)
    low, high = 1e3 * float(h.min()), 1e3 * float(h.max())
    return [
        (f"{name}: {low:.3g} to {high:.3g} mm", np.asarray(grey * 255, np.uint8)),
        ("normals", np.asarray((maps.normals * 0.5 + 0.5) * 255, np.uint8)),
        ("colours", encoded(maps.colors)),
        (
            "lit" if name in CLEAR else "lit, two by two tiles",
            encoded(picture),
        ),
    ]


def moving() -> list[tuple[str, np.ndarray]]:
    """Two titled pictures of heights in motion: drops on a pane, ripples in a basin."""
    rain = Drops((384, 384), 0.0002, seed=4, rain_m_per_s=2e-5)
    for x, z, volume in ((0.0, -0.03, 25.0), (-0.02, -0.035, 14.0), (0.022, -0.025, 40.0)):
        rain.drop(x, z, volume, time_s=0.45)
    basin = Ripples((256, 256), 0.001, speed_m_s=0.25)
    for x, z, time_s in ((-0.05, -0.03, 0.0), (0.06, 0.07, 0.15), (0.09, -0.1, 0.3)):
        basin.drop(x, z, 0.005, 0.004, time_s)
    heights = rain.advance(0.68).astype(float)
    pane = Maps.of(heights, (1, 1, 1), rain.tile_m[0]).normals.astype(float)
    glass = np.linspace(0.5, 0.1, 384)[:, None] * np.ones((1, 384))
    fresnel = 0.02 + 0.98 * (1.0 - pane[..., 2]) ** 5
    # A drop shows what is behind the pane upside down.
    seen = np.clip(0.3 - 0.22 * pane[..., 1] / pane[..., 2], 0.02, 0.9)
    drops = np.where(heights > 0.0, (1.0 - fresnel) * seen + fresnel * sky(pane), 0.6 * glass)
    water = Maps.of(basin.advance(0.7), (1, 1, 1), basin.tile_m[0]).normals.astype(float)
    waves = np.clip(0.12 + 1.6 * (water @ SUN - SUN[2]), 0.0, 1.0)
    tints = (np.array([0.9, 1.0, 1.1]), np.array([0.6, 1.0, 1.15]))
    shaded = [encoded(grey[..., None] * tint) for grey, tint in zip((drops, waves), tints, strict=True)]
    return [("Drops after 0.68 s", shaded[0]), ("Ripples after 0.7 s", shaded[1])]


def flooded() -> np.ndarray:
    """(H, W, 3) linear radiance of cobbles with puddles: wet stone is darker, and water mirrors the sky."""
    ground = textures.cobbles(512, 3)
    water = textures.puddles(over=ground, coverage=0.45)
    depth = np.clip(water.heights_m - ground.heights_m, 0.0, None).astype(float)
    shade = lit("cobbles", ground)
    under = shade * 0.6 * np.exp(-depth[..., None] * np.array([45.0, 32.0, 38.0])) + 0.05 * np.array([0.8, 0.95, 1.1])
    return np.where(depth[..., None] > 0.0, under, shade)


def write_page(pictures: list[tuple[str, np.ndarray]]) -> None:
    """The picture of docs/textures.md."""
    sheet = OpenImageIO.ImageBuf(contact_sheet(pictures, columns=5))
    height = round(1200 * sheet.spec().height / sheet.spec().width)
    small = OpenImageIO.ImageBufAlgo.resize(sheet, filtername="lanczos3", roi=OpenImageIO.ROI(0, 1200, 0, height))
    small.specmod().attribute("Compression", "jpeg:86")
    small.write(str(PAGE))


def main() -> None:
    """Write the sheet."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("target", nargs="?")
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default=",".join(NAMES))
    parser.add_argument("--page", action="store_true", help="write the picture of docs/textures.md")
    options = parser.parse_args()
    if options.page:
        pictures = [(name, encoded(lit(name, getattr(textures, name)(512)))) for name in NAMES if name != "puddles"]
        write_page([*pictures, ("puddles over cobbles", encoded(flooded())), *moving()])
        return
    pictures = []
    for name in options.only.split(","):
        start = time.process_time()
        maps = getattr(textures, name)(size=options.size, seed=options.seed)
        print(f"{name}: {time.process_time() - start:.2f} s")
        pictures += rows(name, maps)
    write_image(options.target, contact_sheet(pictures, columns=4))


if __name__ == "__main__":
    main()
