"""You should see: a glass ball on a chessboard, which it shows upside down; your first picture."""

from pathlib import Path

import pellucid as pl


def main(output: Path = Path("out/examples"), size: tuple[int, int] = (800, 600)) -> pl.Frame:
    # Lengths are metres, +y is up. A body is a signed distance: negative inside, positive outside.
    radius = 0.04
    ball = pl.RefractiveVolume.from_sdf(
        lambda x, y, z: (x**2 + y**2 + z**2) ** 0.5 - radius,
        medium="N-BK7",
        resolution=96,
        extent_m=0.09,
        position=(0.0, 0.041, 0.0),
        dispersion=False,  # one pass instead of three: crown glass hardly splits colours
    )
    scene = pl.Scene(
        camera=pl.Camera(position=(0.05, 0.09, 0.22), target=(0.0, 0.037, 0.0), fov_deg=34),
        environment=pl.Environment.studio(),
        lights=[pl.DirectionalLight(direction=(0.6, -0.7, 0.4))],
        objects=[pl.Mesh.checkerboard(1.6, squares=40), ball],
        exposure=0.7,
    )
    frame = pl.render(scene, size=size, samples=2)
    frame.save(output / "glass_ball.png")
    return frame


if __name__ == "__main__":
    Path("out/examples").mkdir(parents=True, exist_ok=True)
    main()
