"""The steps of [timonen2006, table 1] on one surface, by the thesis's algorithms and by ours."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.benchmarks.rows import SIZE, Progress, device_of, row_of

if TYPE_CHECKING:
    from pellucid.scene import ReliefSurface, Scene

TEXELS = 256
TILE_M = 0.6
BASE_MS = 4.37  # of normal and colour mapping in the thesis
THESIS_MS = {"relief": 30.3, "two_layer": 82.1, "occlusion": 226.0, "occlusion_hue": 264.0}  # of a whole frame
WORKED_OUT = ("illuminate",)


@dataclass
class _Row:
    """One surface, drawn in every round.

    Attributes
    ----------
    besides : parts of a frame that count besides the passes of the relief.
    moves : the lamp is elsewhere in every frame.
    """

    item: ReliefSurface
    note: str
    besides: tuple[str, ...] = ()
    moves: bool = False
    ms: list[float] = field(default_factory=list)


def relief(progress: Progress = lambda share: None, repeat: int = 3) -> dict[str, Any]:
    """Cobbles under a layer of coloured hammered glass, from which half of the stones rise, fill 800 x 600 pixels.

    Rows are drawn in turn, `repeat` times after a warm-up. A time is that of the two passes of the relief in one frame;
    of rows that say so, with what was worked out before them. The ratio is to `base`, normal and colour mapping.
    """
    from pellucid.renderer import Renderer

    renderer, rows = Renderer(), _rows()
    scene, count = _scene(), len(rows) * (repeat + 1)
    for turn in range(repeat + 1):
        for number, row in enumerate(rows.values()):
            timings = renderer.render(_turned(scene, row, turn), SIZE, time=0.02 * turn).timings
            if turn > 0:
                passes = sum(ms for label, ms in timings.items() if label.startswith("relief"))
                row.ms.append(passes + sum(timings[label] for label in row.besides))
            progress((turn * len(rows) + number + 1) / count)
    base = rows["base"].ms
    table = [row_of(name, row.ms, base, None, row.note) for name, row in rows.items()]
    return {"device": device_of(renderer), "suite": "relief", "rows": table}


def _rows() -> dict[str, _Row]:
    """Every row's surface; those of the table come first."""
    from pellucid.scene import ReliefQuality

    stones, glass = _layers()
    covered: Callable[..., Any] = _surface(stones, glass)
    bare: Callable[..., Any] = _surface(stones, None)
    rows = {"base": _Row(covered("normal"), f"normal and colour mapping; in the thesis {BASE_MS} ms, 229 fps")}
    for step, ms in THESIS_MS.items():
        said = f"there {ms:g} ms, {1e3 / ms:.3g} fps, {ms / BASE_MS:.1f} times its base"
        rows[step] = _Row(covered(step), "ours")
        rows[f"{step}_thesis"] = _Row(covered(f"{step}_thesis"), f"the thesis's algorithm and steps; {said}")
    plain: dict[str, Any] = {"adapt_angle": False, "adapt_distance": False}
    searches = {
        "search_linear": (ReliefQuality(search="linear"), "24 + 6 steps, fewer where the view is steep"),
        "search_distance": (ReliefQuality(search="distance", **plain), "steps by a map of distances"),
        "search_max_mip": (ReliefQuality(search="max_mip"), "a pyramid of bounds; misses nothing"),
    }
    for name, (quality, note) in searches.items():
        rows[name] = _Row(bare("relief", quality=quality), f"solid layer: {note}")
    for shadows in ("hard", "soft", "horizon"):
        rows[f"shadows_{shadows}"] = _Row(
            bare("best", quality=ReliefQuality(shadows=shadows, occlusion="none")),
            "solid layer, a ray from every fragment to the lamp",
        )
    per_fragment = ReliefQuality(occlusion="fragment")
    rows["occlusion_fragment"] = _Row(covered("best", quality=per_fragment), "ours, worked out in every fragment")
    rows["dispersion"] = _Row(covered("two_layer", dispersion=True), "red, green and blue refracted apart")
    rows["caustics"] = _Row(covered("best", quality=ReliefQuality(occlusion="texture", caustics=True)), "lamp at rest")
    for name, caustics in (("lamp_moves", False), ("lamp_moves_caustics", True)):
        quality = ReliefQuality(occlusion="texture", caustics=caustics)
        said = f"light map{' and caustics' if caustics else ''} of {TEXELS} x {TEXELS} texels worked out anew"
        rows[name] = _Row(covered("best", quality=quality), f"with the {said}", WORKED_OUT, True)
    rows["ripples"] = _Row(_pool(stones), "heights of water move: with what is made of them anew", ("prepare",))
    return rows


def _layers() -> tuple[Any, Any]:
    from pellucid.fields import textures
    from pellucid.scene import ReliefLayer

    stones = textures.cobbles(size=TEXELS, seed=3, tile_m=TILE_M)
    glass = textures.hammered_glass(size=TEXELS, seed=1, tile_m=TILE_M)
    level = float(np.median(stones.heights_m))
    waves = 6.0 * (glass.heights_m - glass.heights_m.mean())
    return ReliefLayer.of(stones), ReliefLayer(level + waves)


def _surface(solid: Any, translucent: Any) -> Callable[..., Any]:
    from pellucid.scene import ReliefSurface

    def surface(technique: str, **look: Any) -> ReliefSurface:
        more = {"medium": 1.5, "absorption": (20.0, 60.0, 90.0), "tile_m": TILE_M, "technique": technique}
        return ReliefSurface.plane(12.0, solid, translucent, **(more | look))

    return surface


def _pool(stones: Any) -> Any:
    from pellucid.fields import Ripples
    from pellucid.scene import ReliefLayer, ReliefQuality

    basin = Ripples(shape=(TEXELS, TEXELS), cell_m=TILE_M / TEXELS, speed_m_s=0.25, boundary="periodic")
    for k in range(6):
        place = ((0.37 * k) % 0.6 - 0.3, (0.23 * k) % 0.6 - 0.3)
        basin.drop(x_m=place[0], z_m=place[1], radius_m=0.01, strength_m=0.003, time_s=0.0)
    water = ReliefLayer(basin, base_m=0.01)
    return _surface(stones, water)(
        "best", quality=ReliefQuality(search="max_mip", occlusion="fragment"), medium="water", tile_m=TILE_M
    )


def _scene() -> Scene:
    from pellucid.scene import Camera, Environment, Scene

    camera = Camera(position=(0.0, 0.9, 0.9), target=(0.0, 0.0, 0.0), fov_deg=40.0)
    return Scene(camera=camera, environment=Environment.studio(), tone_mapping="linear")


def _turned(scene: Scene, row: _Row, turn: int) -> Scene:
    from pellucid.scene import DirectionalLight

    lamp = DirectionalLight(direction=(0.6, -0.8, 0.3 + (0.01 * turn if row.moves else 0.0)), irradiance=3.0)
    return scene.replace(objects=[row.item], lights=[lamp])
