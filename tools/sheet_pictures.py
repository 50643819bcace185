"""Draws the pictures of docs/sheet.md: the page's example, and the article's sheet beside its error with a scale.

Run ``python tools/sheet_pictures.py out/sheet``, and then ``python tools/make_docs_images.py --sheet out/sheet``.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
SIZE = (400, 300)
SCALE_M = 0.05
BAR = 80  # pixels


def example(folder: Path) -> None:
    """The scene of the page, as it stands there."""
    code = (ROOT / "docs" / "sheet.md").read_text(encoding="utf-8").split("```python\n")[1].split("```")[0]
    values: dict[str, Any] = {}
    exec(compile(code.replace('"sheet.png"', repr(str(folder / "example.png"))), "sheet.md", "exec"), values)


def scale_bar(height: int) -> np.ndarray:
    """(height, BAR, 3) uint8: the false colours from 0 below to SCALE_M above, with numbers in centimetres."""
    from PIL import Image, ImageDraw

    from pellucid.optics import srgb_encode
    from pellucid.techniques.sheet.reference import false_colour

    margin = 20
    out = np.zeros((height, BAR, 3), np.uint8)
    values = np.linspace(1.0, 0.0, height - 2 * margin)
    out[margin:-margin, 12:30] = np.round(255.0 * srgb_encode(false_colour(values)))[:, None]
    picture = Image.fromarray(out)
    draw = ImageDraw.Draw(picture)
    for k in range(6):
        y = margin + (1.0 - k / 5.0) * (height - 2 * margin - 1)
        draw.text((36, y - 6), f"{100.0 * SCALE_M * k / 5.0:.0f} cm", fill=(255, 255, 255))
    return np.asarray(picture)


def errors(folder: Path) -> None:
    """Tiles under ripples as the article draws them, and how far that is off."""
    import pellucid as pl
    from pellucid.fields import Ripples
    from pellucid.gallery.stage import grid
    from pellucid.io.images import write_image

    water = Ripples((192, 192), 2.0 / 192, 0.7)
    water.drop(-0.25, 0.2, 0.08, 0.09)
    water.drop(0.5, -0.4, 0.06, 0.07, time_s=0.2)
    tiles = grid(1024, 16, (0.05, 0.3, 0.4), (0.8, 0.8, 0.75), 0.1)
    sheet = pl.RefractiveSheet.article(tiles, depth_m=0.4, size_m=2.0, waves=water)
    camera = pl.Camera(position=(0.25, 1.4, 2.0), target=(0.0, -0.1, 0.1), fov_deg=46)
    pictures = []
    for show in ("radiance", "error"):
        shown = sheet.replace(show=show, error_scale=SCALE_M)
        scene = pl.Scene(camera, pl.Environment.constant(0.05), objects=[shown], tone_mapping="linear")
        pictures.append(pl.render(scene, SIZE, samples=4, time=0.55).srgb())
    write_image(folder / "errors.png", np.concatenate([*pictures, scale_bar(SIZE[1])], axis=1))


def main() -> None:
    """Draw both into a folder."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/sheet")
    folder.mkdir(parents=True, exist_ok=True)
    example(folder)
    errors(folder)


if __name__ == "__main__":
    main()
