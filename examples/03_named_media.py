"""You should see: a table of materials, and four balls of ice, window glass, sapphire and diamond side by side."""

from pathlib import Path

import pellucid as pl
from pellucid.fields import shapes

NAMES = ("ice", "soda-lime glass", "sapphire", "diamond")


def main(output: Path = Path("out/examples"), size: tuple[int, int] = (800, 400), resolution: int = 64) -> pl.Frame:
    print(f"{'medium':18s} {'n at 587.6 nm':>13s}   {'n at R, G, B':22s} absorption at R, G, B (1/m)")
    for name in NAMES:
        medium = pl.media.get(name)
        rgb = " ".join(f"{n:.4f}" for n in medium.n_rgb)
        lost = " ".join(f"{a:.1f}" for a in medium.absorption_rgb_per_m)
        print(f"{name:18s} {float(medium.n(587.56)):13.4f}   {rgb:22s} {lost}")

    radius = 0.02
    balls = [
        pl.RefractiveVolume.from_sdf(
            shapes.sphere(radius),
            name,
            resolution,
            2.2 * radius,
            position=(0.05 * (k - 1.5), 0.021, 0.0),
            dispersion=False,
        )
        for k, name in enumerate(NAMES)
    ]
    scene = pl.Scene(
        camera=pl.Camera(position=(0.0, 0.06, 0.26), target=(0.0, 0.02, 0.0), fov_deg=26),
        environment=pl.Environment.sky(sun_elevation_deg=40, sun_azimuth_deg=-50, turbidity=2, sun_disc=False),
        lights=[pl.DirectionalLight.sun(elevation_deg=40, azimuth_deg=-50, turbidity=2)],
        objects=[pl.Mesh.checkerboard(3.0, squares=150), *balls],
        exposure=0.7,
        tone_mapping="khronos",
    )
    frame = pl.render(scene, size=size, samples=2)
    frame.save(output / "named_media.png")
    return frame


if __name__ == "__main__":
    Path("out/examples").mkdir(parents=True, exist_ok=True)
    main()
