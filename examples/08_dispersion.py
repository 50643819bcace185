"""You should see: white bars whose edges turn red and blue through a prism, and stay white without dispersion."""

from pathlib import Path

import numpy as np

import pellucid as pl
from pellucid.fields import shapes

ANGLE_DEG = 30.0


def deviation_deg(n: np.ndarray) -> np.ndarray:
    """Least deviation of a prism, from Snell's law."""
    half = np.radians(0.5 * ANGLE_DEG)
    return np.degrees(2.0 * np.arcsin(n * np.sin(half)) - 2.0 * half)


def main(
    output: Path = Path("out/examples"), size: tuple[int, int] = (800, 600), resolution: int = 96
) -> tuple[pl.Frame, pl.Frame]:
    glass = pl.media.get("N-SF66")
    red, green, blue = deviation_deg(np.asarray(glass.n_rgb))
    print(f"{glass.name}, Abbe number {glass.abbe:.1f}: red turns by {red:.2f}, green {green:.2f}, blue {blue:.2f} deg")

    x, z = 0.05 * np.cos(np.radians(15.0)), 0.05 * np.sin(np.radians(15.0))
    outline = [(-0.5 * x, -z), (0.5 * x, 0.0), (-0.5 * x, z)]
    prism = pl.RefractiveVolume.from_sdf(
        shapes.extruded_polygon(outline, 0.06), glass, resolution, (0.055, 0.03, 0.064), rotation=(-90.0, 15.0, 0.0)
    )
    bars = [
        pl.Mesh.box(
            (0.008, 0.4, 0.001), position=(0.026 * k, 0.0, -0.3), base_color=(0, 0, 0), emission=(0.8, 0.8, 0.8)
        )
        for k in range(-14, 15)
    ]
    scene = pl.Scene(
        camera=pl.Camera(position=(0.0, 0.0, 0.3), target=(0.0, 0.0, 0.0), fov_deg=20),
        environment=pl.Environment.constant(0.02),
        objects=[*bars, prism],
    )
    coloured = pl.render(scene, size, samples=2)
    coloured.save(output / "dispersion.png")
    plain = pl.render(scene.replace(objects=[*bars, prism.replace(dispersion=False)]), size, samples=2)
    plain.save(output / "no_dispersion.png")
    return coloured, plain


if __name__ == "__main__":
    Path("out/examples").mkdir(parents=True, exist_ok=True)
    main()
