"""You should see: a sitting animal of green glass, made from a mesh file."""

from pathlib import Path

import numpy as np

import pellucid as pl
from pellucid.fields import shapes


def write_obj(path: Path, vertices: np.ndarray, faces: np.ndarray) -> Path:
    """A model to load; put your own .obj, .ply, .stl or .glb in its place."""
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in vertices]
    lines += [f"f {a} {b} {c}" for a, b, c in faces + 1]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def main(
    output: Path = Path("out/examples"), size: tuple[int, int] = (800, 600), resolution: int = 96
) -> pl.RefractiveVolume:
    model = write_obj(output / "animal.obj", *shapes.creature_mesh(0.09))
    # The mesh may have holes or cross itself: what counts as inside is decided by its winding number.
    animal = pl.RefractiveVolume.from_mesh(
        model, medium="green window glass", resolution=resolution, rotation=(0.0, 28.0, 0.0), dispersion=False
    )
    floor = pl.Mesh.checkerboard(1.6, squares=64, colors=((0.5, 0.45, 0.4), (0.2, 0.1, 0.05)), position=(0, -0.045, 0))
    scene = pl.Scene(
        camera=pl.Camera(position=(0.03, 0.06, 0.24), target=(0.0, 0.0, 0.0), fov_deg=28),
        lights=[pl.DirectionalLight(direction=(0.6, -0.7, 0.4), irradiance=2.0)],
        objects=[floor, animal],
    )
    pl.render(scene, size=size, samples=2).save(output / "own_mesh.png")
    return animal


if __name__ == "__main__":
    Path("out/examples").mkdir(parents=True, exist_ok=True)
    main()
