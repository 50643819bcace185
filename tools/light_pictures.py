"""The pictures of docs/light.md: light in a glass ball by both methods, and what the ball does to the light on a floor.

Run ``python tools/light_pictures.py out/light``, and then ``python tools/make_docs_images.py --light out/light``.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import OpenImageIO

import pellucid as pl
from pellucid.fields import shapes

VOXELS = 192  # along the beam
EXTENT_M = (0.09, 0.12, 0.09)
CENTRE_M = (0.0, 0.022, 0.0)
RADIUS_M = 0.028
IRRADIANCE = 2.0
# Fluence in units of the lamp's irradiance, on a logarithmic scale, and its colours (sRGB).
SCALE = (0.03, 0.3, 1.0, 5.0, 40.0)
COLOURS = ((0, 0, 0), (30, 20, 80), (110, 90, 130), (245, 160, 60), (255, 255, 230))


def slice_of(method: str) -> np.ndarray:
    """(Y, X, 3) uint8: the middle plane of a glass ball under a lamp, by one `LightQuality.method`."""
    body = shapes.moved(shapes.sphere(RADIUS_M), CENTRE_M)
    volume = pl.Volume.from_sdf(body, 1.5, VOXELS, EXTENT_M)
    ball = pl.RefractiveVolume(volume, light=pl.LightQuality(method=method))
    lamp = pl.DirectionalLight(direction=(0, -1, 0), irradiance=IRRADIANCE)
    scene = pl.Scene(camera=pl.Camera(position=(0, 0, 0.5)), lights=[lamp], objects=[ball])
    fluence = pl.illuminate(scene, ball).fluence[volume.shape[0] // 2, ::-1, :, 1] / IRRADIANCE
    at = np.log(np.maximum(fluence, SCALE[0]))
    channels = [np.interp(at, np.log(SCALE), [colour[c] for colour in COLOURS]) for c in range(3)]
    return np.stack(channels, axis=-1).astype(np.uint8)


def caustic() -> np.ndarray:
    """(H, W, 3) uint8: a glass ball on a white floor, lit aslant."""
    ball = pl.RefractiveVolume.from_sdf(
        shapes.sphere(0.03), "N-BK7", 96, 0.068, position=(0, 0.0305, 0), light=pl.LightQuality(caustic_texels=384)
    )
    floor = pl.Mesh.plane(2.0, base_color=(0.3, 0.3, 0.28), specular=0.0)
    lamp = pl.DirectionalLight(direction=(0.75, -1.0, 0.15), irradiance=2.5)
    camera = pl.Camera(position=(0.03, 0.17, 0.17), target=(0.022, 0.01, 0.0), fov_deg=27)
    scene = pl.Scene(camera, pl.Environment.constant((0.12, 0.14, 0.18)), lights=[lamp], objects=[floor, ball])
    return pl.render(scene, (800, 600), samples=4).srgb()


def save(path: Path, picture: np.ndarray) -> None:
    """As PNG."""
    path.parent.mkdir(parents=True, exist_ok=True)
    OpenImageIO.ImageBuf(np.ascontiguousarray(picture)).write(str(path))


def main() -> None:
    """Write the three pictures as PNG."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    save(folder / "fluence.png", slice_of("flux"))
    save(folder / "intensity.png", slice_of("intensity"))
    save(folder / "caustic.png", caustic())


if __name__ == "__main__":
    main()
