"""You should see: rain runs down an enamel sign; drops merge, the heavy ones run, and leave trails of small ones."""

from importlib.util import find_spec
from pathlib import Path

import numpy as np

import pellucid as pl
from pellucid.fields import shapes
from pellucid.fields.drops import Drops

CELL_M = 0.00015
FILM = find_spec("av") is not None  # pip install 'pellucid[video]'


def sign(size: tuple[int, int] = (768, 1024)) -> np.ndarray:
    """Linear colours: cream letters between two lines on blue enamel, one texel wide and high for each."""
    rows, columns = size
    texel_m = 512 * CELL_M / columns
    x = (np.arange(columns) + 0.5 - 0.5 * columns)[None, :] * texel_m
    y = (0.5 * rows - np.arange(rows) - 0.5)[:, None] * texel_m
    x, y = np.broadcast_arrays(x, y)
    letters = shapes.lettering("RAIN", 0.02, 1.0, 0.0036)(x, y, np.zeros_like(x))
    lines = np.abs(np.abs(y) - 0.018) - 0.0008
    cover = np.clip(0.5 - np.minimum(letters, lines) / texel_m, 0.0, 1.0)[..., None]
    return (1.0 - cover) * np.array((0.01, 0.05, 0.22)) + cover * np.array((0.85, 0.74, 0.5))


def main(
    output: Path = Path("out/examples"),
    size: tuple[int, int] = (800, 600),
    samples: int = 2,
    frames: int = 96,
    film: bool = FILM,
) -> list[Path]:
    # Heights that move: the same time always gives the same drops, so frames may be drawn in any order.
    # More friction than water has on glass, so that drops can be followed.
    water = Drops((384, 512), CELL_M, seed=2, initial=600, rain_m_per_s=2e-5, volumes_ul=(0.1, 12.0), drag_pa_s=0.6)
    pane = pl.ReliefSurface.plane(
        water.tile_m,
        pl.ReliefLayer(0.0, colors=sign(), roughness=0.25),
        pl.ReliefLayer(water),
        medium="water",
        tiling=False,
        rotation=(90.0, 0.0, 0.0),  # upright: v runs down it
        quality=pl.ReliefQuality(environment="map", caustics=True),
    )
    scene = pl.Scene(
        camera=pl.Camera(position=(0.012, -0.03, 0.12), target=(0.0, -0.001, 0.0), fov_deg=22),
        environment=pl.Environment.studio(intensity=0.6),
        lights=[pl.DirectionalLight(direction=(0.5, -0.6, -0.6), irradiance=2.5, angular_radius_deg=0.5)],
        objects=[pane],
        tone_mapping="khronos",
    )
    # What is drawn already stays: after ctrl-C the same command goes on.
    return pl.animate(
        lambda time: scene,
        output / "rain",
        frames,
        fps=24,
        size=size,
        samples=samples,
        video=output / "rain.mp4" if film else None,
    )


if __name__ == "__main__":
    main()
