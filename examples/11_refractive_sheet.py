"""You should see: tiles under moving water, refracted by a factor and by Snell's law, and how far the factor is off.

Three short animations of the same ripples; run it again after an interruption and it goes on where it stopped.
"""

from pathlib import Path

import numpy as np

import pellucid as pl
from pellucid.fields import Ripples


def main(
    output: Path = Path("out/examples"), size: tuple[int, int] = (480, 360), samples: int = 2, frames: int = 12
) -> dict[str, list[Path]]:
    # Any picture will do, also a path: blue tiles with white joints, linear light.
    across = np.minimum(*np.meshgrid(*2 * [np.abs(np.arange(512) / 64 % 1 - 0.5)])) < 0.04
    tiles = np.where(across[..., None], (0.8, 0.8, 0.75), (0.05, 0.3, 0.4))
    water = Ripples(shape=(160, 160), cell_m=2.0 / 160, speed_m_s=0.7)
    water.drop(x_m=-0.3, z_m=0.2, radius_m=0.08, strength_m=0.09, time_s=0.0)
    water.drop(x_m=0.5, z_m=-0.4, radius_m=0.06, strength_m=0.07, time_s=0.2)
    sky = pl.Environment.sky(35.0, 20.0, sun_disc=False)
    camera = pl.Camera(position=(0.3, 1.5, 2.1), target=(0.0, -0.1, 0.05), fov_deg=42)

    # As in games of the year 2000: per vertex, with a factor, and the sky from a picture of a mirror ball.
    mirror_ball = pl.scene.sphere_map(sky, 256)
    article = pl.RefractiveSheet.article(tiles, depth_m=0.4, size_m=2.0, waves=water, sphere_map=mirror_ball, blend=0.1)
    # Snell's law and Fresnel's in every pixel; the same fields otherwise.
    exact = pl.RefractiveSheet(tiles, depth_m=0.4, size_m=2.0, waves=water)
    # False colours: black where both agree, white where they are 5 cm apart.
    error = article.replace(show="error", error_scale=0.05)
    made = {}
    for name, sheet in (("article", article), ("exact", exact), ("error", error)):
        scene = pl.Scene(camera=camera, environment=sky, objects=[sheet], tone_mapping="khronos")
        folder = output / f"sheet_{name}"
        made[name] = pl.animate(lambda t, scene=scene: scene, folder, frames, fps=12, size=size, samples=samples)
    return made


if __name__ == "__main__":
    main()
