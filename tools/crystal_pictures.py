"""The picture of docs/crystals.md: a dot under calcite that turns, and under calcite seen along its axis.

Run ``python tools/crystal_pictures.py``. It writes docs/images/crystals/turning.jpg.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO

import pellucid as pl
from pellucid.fields import shapes

TARGET = Path(__file__).resolve().parents[1] / "docs" / "images" / "crystals" / "turning.jpg"
SIZE = 150
THICK_M = 0.02


def dot(volume: pl.Volume, turn_deg: float) -> np.ndarray:
    """(SIZE, SIZE, 3) uint8: a black dot on white paper through a slab that is turned about the line of sight."""
    y, x = np.mgrid[:512, :512] - 255.5
    paper = np.where(np.hypot(x, y)[..., None] < 11.0, np.float32(0.02), np.float32(0.9)) * np.ones(3, np.float32)
    wall = pl.Mesh.plane(
        0.04, base_color=(1, 1, 1), base_color_map=paper, specular=0.0, rotation=(90, 0, 0), position=(0, 0, -0.011)
    )
    slab = pl.RefractiveVolume(volume, rotation=(0, 0, turn_deg))
    camera = pl.Camera(position=(0, 0, 1), target=(0, 0, 0), orthographic_height_m=0.011)
    scene = pl.Scene(camera, pl.Environment.constant((1.0, 1.0, 1.0)), objects=[wall, slab], tone_mapping="linear")
    return pl.render(scene, (SIZE, SIZE), samples=4).srgb()


def main() -> None:
    """Four turns of a slab whose axis lies at 45 degrees, then one whose axis is the line of sight."""

    def slab(axis: tuple[float, float, float]) -> pl.Volume:
        body = shapes.box((0.06, 0.06, THICK_M))
        return pl.Volume.from_sdf(body, "calcite", 48, (0.07, 0.07, 0.03), optic_axis=axis)

    slanted = slab((1.0, 0.0, 1.0))
    panels = [dot(slanted, turn) for turn in (0.0, 60.0, 120.0, 180.0)] + [dot(slab((0.0, 0.0, 1.0)), 0.0)]
    row = np.ascontiguousarray(np.concatenate(panels, axis=1))
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    picture = OpenImageIO.ImageBuf(row)
    picture.specmod().attribute("Compression", "jpeg:88")
    picture.write(str(TARGET))


if __name__ == "__main__":
    main()
