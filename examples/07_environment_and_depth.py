"""You should see: a ball of water under a sunset that was read from a file, and a picture of how far everything is."""

from pathlib import Path

import numpy as np

import pellucid as pl
from pellucid.fields import shapes


def write_sunset(path: Path) -> Path:
    """An environment map; put your own .hdr or .exr (latitude and longitude, twice as wide as high) in its place."""
    sunset = pl.Environment.sky(sun_elevation_deg=6, sun_azimuth_deg=-25, sun_disc=False)
    empty = pl.Scene(camera=pl.Camera((0.0, 0.0, 1.0)), environment=sunset)
    pl.Frame(np.array(empty.environment.pixels), np.zeros((1, 1), np.float32), np.zeros((1, 1, 3), np.uint8)).save(path)
    return path


def main(output: Path = Path("out/examples"), size: tuple[int, int] = (800, 600), resolution: int = 64) -> pl.Frame:
    environment = pl.Environment.load(write_sunset(output / "sunset.hdr"), rotation_deg=20)
    drop = pl.RefractiveVolume.from_sdf(shapes.sphere(0.03), "water", resolution, 0.066, position=(0, 0.035, 0))
    stones = [
        pl.Mesh.sphere(0.012, position=(x, 0.012, z), base_color=(0.25, 0.2, 0.18))
        for x, z in ((-0.06, -0.05), (0.05, -0.08), (0.07, 0.02))
    ]
    scene = pl.Scene(
        camera=pl.Camera(position=(0.0, 0.06, 0.2), target=(0.0, 0.032, 0.0), fov_deg=36),
        environment=environment,
        objects=[pl.Mesh.plane(4.0, base_color=(0.3, 0.26, 0.22)), *stones, drop],
        exposure=2.0,
    )
    frame = pl.render(scene, size=size, samples=2)
    frame.save(output / "sunset.png")
    # Metres along the view axis; infinite where there is only sky.
    near, far = np.percentile(frame.depth[np.isfinite(frame.depth)], [0, 60])
    grey = np.clip((far - frame.depth) / (far - near), 0.0, 1.0)
    shown = np.repeat((255.0 * grey[..., None]).astype(np.uint8), 3, axis=2)
    pl.Frame(frame.radiance, frame.depth, shown).save(output / "sunset_depth.png")
    print(f"the nearest point is {near:.3f} m away")
    return frame


if __name__ == "__main__":
    Path("out/examples").mkdir(parents=True, exist_ok=True)
    main()
