"""You should see: wet stones in shallow water, and rings that spread on it from where two drops fell; six pictures."""

from pathlib import Path

import pellucid as pl
from pellucid.fields import Ripples, textures


def main(output: Path = Path("out/examples"), size: tuple[int, int] = (800, 600), samples: int = 2) -> list[pl.Frame]:
    # A relief needs heights in metres over a polygon. These come with colours; your own may be arrays or pictures.
    stones = textures.cobbles(size=256, seed=3, tile_m=0.8, relief_m=0.04, unevenness_m=0.02)
    # The second layer lies over the first; where it is lower there is none. This one moves.
    water = Ripples(shape=(256, 256), cell_m=0.8 / 256, speed_m_s=0.35)
    water.drop(x_m=-0.12, z_m=0.1, radius_m=0.015, strength_m=0.022, time_s=0.0)
    water.drop(x_m=0.2, z_m=-0.15, radius_m=0.012, strength_m=0.018, time_s=0.25)
    pond = pl.ReliefSurface.plane(
        0.8,
        pl.ReliefLayer.of(stones),
        pl.ReliefLayer(water, base_m=-0.012),
        medium="water",
        tiling=False,
        quality=pl.ReliefQuality(reflection="search", caustics=True),
    )
    scene = pl.Scene(
        camera=pl.Camera(position=(0.05, 0.5, 0.78), target=(0.0, -0.02, 0.05), fov_deg=22),
        environment=pl.Environment.sky(30.0, -50.0, sun_disc=False),
        lights=[pl.DirectionalLight.sun(30.0, -50.0)],
        objects=[pond],
        exposure=1.4,
    )
    frames = []
    for number in range(6):
        frames.append(pl.render(scene, size, samples=samples, time=0.15 + 0.1 * number))
        frames[-1].save(output / f"rings_{number}.png")
    return frames


if __name__ == "__main__":
    Path("out/examples").mkdir(parents=True, exist_ok=True)
    main()
