"""You should see: a chessboard through a pane whose index ripples; the squares swell and shrink in rings."""

from pathlib import Path

import numpy as np

import pellucid as pl


def main(output: Path = Path("out/examples"), size: tuple[int, int] = (800, 600), resolution: int = 96) -> pl.Frame:
    # Arrays are indexed [z, y, x]; the box is centred on the object's position.
    edge, thick = 0.10, 0.02
    across = (np.arange(resolution) + 0.5) / resolution * edge - 0.5 * edge
    deep = max(resolution // 5, 4)
    through = (np.arange(deep) + 0.5) / deep * thick - 0.5 * thick
    z, y, x = np.meshgrid(through, across, across, indexing="ij")
    r = np.hypot(x, y)
    window = np.clip((0.046 - r) / 0.008, 0.0, 1.0) * np.clip((0.5 * thick - np.abs(z)) / 0.006, 0.0, 1.0)
    n = 1.0 + 0.04 * (0.5 + 0.5 * np.cos(2.0 * np.pi * r / 0.018)) * window

    pane = pl.RefractiveVolume.from_array(n, (edge, edge, thick), boundary="smooth")
    board = pl.Mesh.checkerboard(0.6, squares=60, position=(0.0, 0.0, -0.10), rotation=(90.0, 0.0, 0.0), roughness=0.9)
    scene = pl.Scene(
        camera=pl.Camera(position=(0.0, 0.0, 0.3), target=(0.0, 0.0, 0.0), fov_deg=26),
        environment=pl.Environment.constant(1.0),
        objects=[board, pane],
    )
    frame = pl.render(scene, size=size, samples=2)
    frame.save(output / "index_from_numpy.png")
    return frame


if __name__ == "__main__":
    Path("out/examples").mkdir(parents=True, exist_ok=True)
    main()
