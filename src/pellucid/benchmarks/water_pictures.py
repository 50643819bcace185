"""Frames of a lake by the size of its pictures, as [mihalik2008, table 3] has them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.benchmarks.rows import SIZE, Progress, device_of, row_of

if TYPE_CHECKING:
    from pellucid.scene import Scene

TEXTURE_SIZES = (256, 512, 1024)
THESIS_FPS = {256: 31, 512: 28, 1024: 17}  # ATI Radeon X800, Pentium 4 at 3 GHz
BASE = "mihalik_512"
LAKE_M = 40.0
SIDE = 150  # vertices of the ground, 44,402 triangles


def texture_sizes(progress: Progress = lambda share: None, repeat: int = 3) -> dict[str, Any]:
    """A lake of 40 m with waves, 800 x 600: all three textures of one size, by the thesis's steps and by ours.

    Rows are drawn in turn, `repeat` times after a warm-up, with waves that move. A time is that of a whole frame but
    for what is prepared for its geometry.
    """
    from pellucid.renderer import Renderer

    renderer = Renderer()
    names = [(technique, size) for technique in ("mihalik", "fast") for size in TEXTURE_SIZES]
    scenes = {f"{technique}_{size}": lake(technique, size) for technique, size in names}
    times: dict[str, list[float]] = {name: [] for name in scenes}
    for turn in range(repeat + 1):
        for number, (name, scene) in enumerate(scenes.items()):
            timings = renderer.render(scene, SIZE, time=0.05 * turn).timings
            if turn > 0:
                times[name].append(timings["total"] - timings["prepare"])
            progress((turn * len(scenes) + number + 1) / (len(scenes) * (repeat + 1)))
    rows = [row_of(name, ms, times[BASE], None, _note(name)) for name, ms in times.items()]
    return {"device": device_of(renderer), "suite": "water pictures", "rows": rows}


def _note(name: str) -> str:
    technique, size = name.split("_")
    said = f"; there {THESIS_FPS[int(size)]} fps" if technique == "mihalik" else ""
    return f"pictures and caustics of {size} x {size} by {technique!r}{said}"


def lake(technique: str, texture_size: int) -> Scene:
    """A basin with stones and posts that stand out of the water."""
    import pellucid as pl
    from pellucid.fields.waves import Sine

    meshes = [_ground()]
    rng = np.random.default_rng(1)
    for x, z in rng.uniform(-9.0, 9.0, (14, 2)):
        place = (x, -2.2 + 0.0112 * (x * x + z * z), z)
        meshes.append(pl.Mesh.sphere(0.5 + 0.5 * rng.random(), position=place, base_color=(0.5, 0.45, 0.4)))
    meshes += [pl.Mesh.box(1.0, position=(x, 0.1, -1.0), base_color=(0.6, 0.2, 0.1)) for x in (-4.0, 2.5, 5.0)]
    waves = Sine(wavelength_m=[2.4, 1.1], amplitude_m=[0.03, 0.012], direction_deg=[20, 75], tile_m=10.0)
    quality = pl.WaterQuality(texture_size=texture_size, caustic_size=texture_size)
    water = pl.Water(extent_m=LAKE_M, waves=waves, technique=technique, quality=quality)
    return pl.Scene(
        camera=pl.Camera(position=(0, 2.5, 9), target=(0, -0.5, 0), fov_deg=50),
        environment=pl.Environment.sky(sun_disc=False),
        lights=[pl.DirectionalLight(direction=(-1, -2, -1))],
        objects=[*meshes, water],
    )


def _ground() -> Any:
    from pellucid.scene import Mesh

    x, z = np.meshgrid(*2 * [np.linspace(-25.0, 25.0, SIDE)])
    y = -2.5 + 0.0112 * (x * x + z * z) + 0.35 * np.sin(0.7 * x) * np.cos(0.6 * z)
    i = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
    a, b, c, d = i[:-1, :-1].ravel(), i[1:, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel()
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([b, d, c], -1)])
    return Mesh(np.stack([x, y, z], -1).reshape(-1, 3), faces, base_color=(0.4, 0.35, 0.25))
