"""You should see: a rounded cube of amber glass with smooth edges, as PNG to look at and as EXR to compute with."""

from pathlib import Path

import numpy as np

import pellucid as pl
from pellucid.fields import shapes


def main(
    output: Path = Path("out/examples"), size: tuple[int, int] = (800, 600), samples: int = 8
) -> tuple[pl.Frame, pl.Frame]:
    cube = pl.RefractiveVolume.from_sdf(
        shapes.rounded_box(0.012, 0.002), "amber glass", 64, 0.0132, position=(0, 0.0062, 0), rotation=(0, 30, 0),
        dispersion=False,
    )  # fmt: skip
    scene = pl.Scene(
        camera=pl.Camera(position=(0.005, 0.022, 0.042), target=(0, 0.0055, 0), fov_deg=28, near_m=0.002),
        lights=[pl.DirectionalLight(direction=(0.6, -0.7, 0.4), irradiance=2.0)],
        objects=[pl.Mesh.checkerboard(0.4, squares=80), cube],
        exposure=0.7,
    )
    rough, fine = pl.render(scene, size, samples=1), pl.render(scene, size, samples=samples)
    fine.save(output / "amber_cube.png")  # exposure, tone mapping and sRGB: what a screen shows
    fine.save(output / "amber_cube.exr")  # linear radiance, never clamped
    print(f"brightest {fine.radiance.max():.2f}; samples changed {np.abs(fine.radiance - rough.radiance).mean():.4f}")
    print("milliseconds:", {name: round(ms, 1) for name, ms in fine.timings.items()})
    return rough, fine


if __name__ == "__main__":
    Path("out/examples").mkdir(parents=True, exist_ok=True)
    main()
