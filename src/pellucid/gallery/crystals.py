"""Crystals: calcite that doubles what lies under it, and tourmaline whose colour depends on where one looks from."""

from __future__ import annotations

import numpy as np

from pellucid.fields import shapes
from pellucid.fields.volume import Volume
from pellucid.scene import Camera, Environment, Quality, RefractiveVolume, Scene

from . import stage
from .picture import Picture

PAPER, INK = (0.80, 0.79, 0.74), (0.015, 0.015, 0.02)


def print_on_paper(lines: tuple[str, ...], letter_m: float, size_m: float, pixels: int = 1536) -> stage.Image:
    """Lines of block letters in the middle of a sheet, as `stage.table` wants them: with its middle in the corners."""
    at = ((np.arange(pixels) + 0.5) / pixels - 0.5) * size_m
    ink = np.zeros((pixels, pixels, 1))
    for k, line in enumerate(lines):
        below = at - 2.5 * letter_m * (k - 0.5 * (len(lines) - 1))
        rows = np.abs(below) < 0.8 * letter_m
        letters = shapes.lettering(line, letter_m, 1.0, 0.15 * letter_m)
        distance = letters(at[None, :], -below[rows, None], np.zeros((1, 1)))
        ink[rows, :, 0] = np.clip(0.5 - distance * pixels / size_m, 0.0, 1.0)
    page = (1.0 - ink) * np.array(PAPER) + ink * np.array(INK)
    return np.asarray(np.roll(page, (pixels // 2, pixels // 2), (0, 1)), np.float32)


def calcite() -> Scene:
    """A cleavage rhomb of calcite, 4 cm along its edges, on printed paper."""
    rhomb, axis = shapes.rhombohedron(0.04)
    tall = 2.0 * -float(rhomb(0.0, 0.0, 0.0))
    sheet = 0.24
    words = ("DOUBLE REFRACTION", "OF ICELAND SPAR", "COPENHAGEN 1669")
    page = stage.table(sheet, print_on_paper(words, 0.0072, sheet), sheet, roughness=0.9, specular=0.02)
    spar = RefractiveVolume.from_sdf(
        rhomb, "calcite", 128, (0.078, 1.06 * tall, 0.078), optic_axis=axis,
        position=(0.0, 0.5 * tall + stage.GAP_M, 0.0), rotation=(0.0, 20.0, 0.0),
        quality=Quality(bounces=6, min_weight=0.02), light=stage.FACET_LIGHT,
    )  # fmt: skip
    return Scene(
        Camera((0.0, 0.155, 0.10), (0.0, 0.008, 0.002), fov_deg=28.0),
        Environment.studio(),
        [stage.key_light(1.6)],
        [page, spar],
        exposure=0.56,
        tone_mapping="khronos",
    )


def tourmaline() -> Scene:
    """Three equal six-sided prisms of green tourmaline, 1 cm wide, that point up, to the side, and to the viewer."""
    width, length = 0.010, 0.012
    turns = np.radians(60.0 * np.arange(6))
    sides = np.stack([np.cos(turns), 0.0 * turns, np.sin(turns)], axis=1)
    normals = np.concatenate([sides, [(0.0, 1.0, 0.0), (0.0, -1.0, 0.0)]])
    prism = Volume.from_sdf(
        shapes.convex(normals, [0.5 * width] * 6 + [0.5 * length] * 2), "tourmaline", 72,
        (0.0126, 0.0134, 0.0126), optic_axis=(0.0, 1.0, 0.0),
    )  # fmt: skip
    quality = Quality(bounces=5, min_weight=0.03)
    lies = 0.5 * width + stage.GAP_M
    places = [
        ((-0.019, 0.5 * length + stage.GAP_M, 0.0), (0.0, 20.0, 0.0)),
        ((0.0, lies, 0.003), (0.0, 0.0, 90.0)),
        ((0.019, lies, 0.0), (90.0, 0.0, 30.0)),
    ]
    stones = [
        RefractiveVolume(prism, position=at, rotation=turn, quality=quality, light=stage.FACET_LIGHT)
        for at, turn in places
    ]
    return Scene(
        Camera((0.0, 0.034, 0.082), (0.0, 0.0035, 0.0), fov_deg=33.0, near_m=0.005),
        Environment.studio(),
        [stage.key_light(1.6)],
        [stage.table(0.02, stage.checks((0.72, 0.70, 0.66), (0.50, 0.49, 0.47)), 0.6, roughness=0.8), *stones],
        exposure=0.7,
        tone_mapping="khronos",
    )


PICTURES = (
    Picture(
        "calcite",
        "Calcite over print",
        "A skewed clear crystal on a printed page: under it every letter stands twice, each half as dark.",
        calcite,
        4,
    ),
    Picture(
        "tourmaline",
        "Tourmaline from three sides",
        "Three equal prisms: two are seen across their axis and are green, one is seen along it and is black.",
        tourmaline,
        4,
    ),
)
