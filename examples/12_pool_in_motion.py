"""You should see: a ball thrown into a tiled pool; rings run from it, and bright lines over the floor; then the lake.

An animation of the pool (run it again after an interruption and it goes on where it stopped) and a lake from an OBJ
file with several materials, seen over the day.
"""

from pathlib import Path

import pellucid as pl
from pellucid.gallery import lake, waters


def main(
    output: Path = Path("out/examples"),
    size: tuple[int, int] = (480, 360),
    samples: int = 2,
    frames: int = 24,
    corners: int = 129,
) -> dict[str, list[Path]]:
    # Ripples on a grid of 24 cells a metre. Drops may lie in the future; so may what floats along a path.
    ripples = pl.waves.Ripples(shape=(96, 144), cell_m=6.0 / 144, speed_m_s=1.4, damping=0.15, limit_m=0.1)
    ripples.drop(x_m=0.9, z_m=0.35, radius_m=0.3, strength_m=0.16, time_s=0.0)
    pool = waters.pool_scene(waves=ripples)
    made = {
        "pool": pl.animate(lambda time: pool, output / "pool", frames, 12.0, size, samples, start_s=0.3),
    }

    # The surroundings are written to lake.obj, with lake.mtl and a picture of the ground, and read back.
    output.mkdir(parents=True, exist_ok=True)
    surroundings = pl.Mesh.load_all(lake.lake_surroundings(output, corners, texels=512), roughness=0.9, specular=0.02)
    breeze = pl.waves.Ocean(wind_m_s=1.8, tile_m=12.0, fetch_m=250.0, amplitude=0.4)
    water = pl.Water(extent_m=lake.SIZE_M, medium="clear lake", waves=breeze)
    camera = pl.Camera(position=(1.5, 1.6, 20.5), target=(-0.5, 0.45, 8.0), fov_deg=46.0, far_m=400.0)

    def day(time: float) -> pl.Scene:
        elevation, azimuth = 8.0 + 40.0 * time, 90.0 + 60.0 * time
        sky = pl.Environment.sky(elevation, azimuth, sun_disc=False)
        sun = pl.DirectionalLight.sun(elevation, azimuth)
        return pl.Scene(camera, sky, [sun], [*surroundings, water], exposure=0.8, tone_mapping="khronos")

    made["day"] = pl.animate(day, output / "day", frames, float(frames), size, samples)
    return made


if __name__ == "__main__":
    for name, paths in main().items():
        print(f"{name}: {len(paths)} frames, the first is {paths[0]}")
