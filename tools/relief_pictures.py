"""Draws the pictures of docs/relief.md: the page's example, and the steps of `technique` on one surface.

Run ``python tools/relief_pictures.py out/relief``, and then ``python tools/make_docs_images.py --relief out/relief``.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
SIZE = (320, 240)
STEPS = ("color", "normal", "offset", "relief", "two_layer", "occlusion", "occlusion_hue", "best")
TILE_M = 0.6


def example(folder: Path) -> None:
    """The scene of the page, as it stands there."""
    code = (ROOT / "docs" / "relief.md").read_text(encoding="utf-8").split("```python\n")[1].split("```")[0]
    values: dict[str, Any] = {}
    exec(compile(code.replace('"puddles.png"', repr(str(folder / "example.png"))), "relief.md", "exec"), values)


def steps(folder: Path) -> None:
    """Cobbles half under coloured glass by each step; the last with caustics."""
    import pellucid as pl
    from pellucid.fields import textures
    from pellucid.io.images import write_image

    stones = textures.cobbles(size=256, seed=3, tile_m=TILE_M)
    glass = textures.hammered_glass(size=256, seed=5, tile_m=TILE_M)
    over = np.median(stones.heights_m) + 6.0 * (glass.heights_m - glass.heights_m.mean())
    renderer, pictures = pl.Renderer(), []
    for step in STEPS:
        item = pl.ReliefSurface.plane(
            3.0,
            pl.ReliefLayer.of(stones),
            pl.ReliefLayer(over),
            medium=1.5,
            absorption=(10.0, 60.0, 80.0),
            tile_m=TILE_M,
            technique=step,
            quality=pl.ReliefQuality(caustics=step == "best"),
        )
        scene = pl.Scene(
            camera=pl.Camera(position=(0.0, 0.2, 0.34), target=(0.0, 0.0, 0.02), fov_deg=34.0),
            environment=pl.Environment.studio(),
            lights=[pl.DirectionalLight(direction=(0.9, -0.7, 0.1), irradiance=2.0, angular_radius_deg=1.0)],
            objects=[item],
            exposure=0.6,
        )
        pictures.append(renderer.render(scene, SIZE, samples=4).srgb())
    rows = [np.concatenate(pictures[k : k + 4], axis=1) for k in (0, 4)]
    write_image(folder / "steps.png", np.concatenate(rows, axis=0))


def main() -> None:
    """Draw both into a folder."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/relief")
    folder.mkdir(parents=True, exist_ok=True)
    example(folder)
    steps(folder)


if __name__ == "__main__":
    main()
