"""Frames of a lake as large as that of [mihalik2008, 10]: its tables, by the thesis's algorithms and by ours."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pellucid.benchmarks.rows import SIZE, Progress, device_of, row_of

if TYPE_CHECKING:
    from pellucid.frame import Frame
    from pellucid.scene import Scene, WaterQuality

BASE = "lake_dry"
TRUEST = "lake_best"
GROUND = {"corners": 159, "trees": 109}  # 85 536 faces; there are 85 409 in the thesis
STEP_S = 0.04
WARM_UP = 3  # frames until pictures that can be kept are kept
FRAMES = 4
PATIENCE_S = 20.0  # a row that has taken longer is not drawn again
THESIS_FPS = "27, 130 and 57 fps there with caustics, 75, 170 and 69 without [mihalik2008, table 2]"
TABLE_3 = {256: 31, 512: 28, 1024: 17}  # side of all textures, of caustics too: fps in the thesis
NAMED = 3  # passes that a note names


@dataclass
class _Row:
    """A lake, drawn some frames long in every round.

    Attributes
    ----------
    quality : of its water; None for none.
    flies : the camera is elsewhere in every frame.
    against : the row that it is compared with besides the base.
    picture : radiance (H, W, 3) of the last frame of a round.
    """

    quality: WaterQuality | None
    note: str
    flies: bool = False
    against: str | None = None
    ms: list[float] = field(default_factory=list)
    processor_ms: list[float] = field(default_factory=list)
    timings: list[dict[str, float]] = field(default_factory=list)
    picture: npt.NDArray[np.float32] | None = None

    @property
    def passes(self) -> dict[str, float]:
        """Medians in milliseconds; the rest is to encode and to read the picture back."""
        labels = dict.fromkeys(label for timings in self.timings for label in timings if label != "total")
        passes = {label: float(np.median([t.get(label, 0.0) for t in self.timings])) for label in labels}
        rest = [2.0 * t["total"] - sum(t.values()) for t in self.timings]
        passes["rest"] = max(float(np.median(rest)), 0.0)
        return {label: round(ms, 2) for label, ms in passes.items() if ms >= 0.005}


def water(progress: Progress = lambda share: None, repeat: int = 3) -> dict[str, Any]:
    """A lake among hills fills the lower half of 800 x 600 pixels; its waves move in every frame.

    Rows are drawn in turn, `repeat` times, each some frames after others that warm up, as what is seen at rest is kept
    from frame to frame. A time is that of a whole frame, on the clock, until its picture is read back. The ratio is to
    the same scene without its water. The error is the mean absolute difference of radiance from `lake_best`, as a share
    of the mean radiance, over the pixels of the water.

    Rows have besides: `fps`; `processor_ms`, of all cores, which other work on the machine changes less; `passes`, the
    median of each in milliseconds.
    """
    from pellucid.renderer import Renderer

    renderer, rows, scene = Renderer(), _rows(), _scene()
    count = len(rows) * repeat
    for turn in range(repeat):
        for number, row in enumerate(rows.values()):
            if sum(row.ms) < 1e3 * PATIENCE_S:
                _draw(renderer, _of(scene, row), row)
            progress((turn * len(rows) + number + 1) / count)
    vertices, faces = (sum(len(getattr(m, part)) for m in scene.objects[:-1]) for part in ("vertices", "faces"))
    rows[BASE].note += f"; {vertices} vertices and {faces} faces; 131437 and 85409 in the thesis"
    table = [_row(name, rows) for name in rows]
    return {"device": device_of(renderer), "suite": "water", "rows": table}


def _rows() -> dict[str, _Row]:
    from pellucid.scene import WaterQuality

    by = WaterQuality.of
    rows = {
        BASE: _Row(None, "no water: its picture is kept"),
        "lake_dry_moving_camera": _Row(None, "no water, camera flies", flies=True),
        "lake": _Row(by("fast", caustics="none"), "refraction and reflection, waves move"),
        "lake_caustics": _Row(by("fast"), "with caustics", against="lake"),
        "lake_glow": _Row(by("fast", glow=1.0), "with caustics and glow", against="lake"),
        "lake_rate_4": _Row(by("fast", shading_rate=4), "a look for four pixels", against="lake_caustics"),
        "lake_every_pixel": _Row(
            by("fast", shading_rate=1, texture_size=512), "a look for every pixel", against="lake_caustics"
        ),
        "lake_moving_camera": _Row(by("fast"), "with caustics, camera flies", True, "lake_caustics"),
        TRUEST: _Row(by("best"), "rays, with caustics", against="lake_caustics"),
        "lake_mihalik": _Row(by("mihalik", caustics="none"), f"the thesis's algorithm; {THESIS_FPS}"),
        "lake_mihalik_caustics": _Row(
            by("mihalik", caustic_size=256), "caustics on the CPU, map of 256 as there", against="lake_mihalik"
        ),
        "lake_mihalik_moving_camera": _Row(
            by("mihalik", caustic_size=256), "camera flies", True, "lake_mihalik_caustics"
        ),
    }
    for algorithm, technique, said in (("lake", "fast", "ours"), ("lake_mihalik", "mihalik", "caustics on the GPU")):
        for side, fps in TABLE_3.items():
            there = f"{fps} fps there, {TABLE_3[512] / fps:.2f} times the time of 512"
            rows[f"{algorithm}_textures_{side}"] = _Row(
                by(technique, texture_size=side, caustic_size=side, caustics="gpu"),
                f"all textures of {side}, {said}; {there}",
                against=None if side == 512 else f"{algorithm}_textures_512",
            )
    return rows


def _scene() -> Scene:
    from pellucid.gallery.lake import lake_scene
    from pellucid.gallery.waters import lake_waves

    return lake_scene(lake_waves(), size=GROUND)


def _of(scene: Scene, row: _Row) -> Scene:
    *meshes, lake = scene.objects
    return scene.replace(objects=meshes if row.quality is None else [*meshes, lake.replace(quality=row.quality)])


def _draw(renderer: Any, scene: Scene, row: _Row) -> None:
    """The same frames in every round."""
    for k in range(WARM_UP + FRAMES):
        seen = scene.replace(camera=_flown(scene.camera, k)) if row.flies else scene
        begun = time.process_time()
        frame: Frame = renderer.render(seen, SIZE, time=STEP_S * k)
        if k >= WARM_UP:
            row.processor_ms.append(1e3 * (time.process_time() - begun))
            row.ms.append(frame.timings["total"])
            row.timings.append(frame.timings)
    row.picture = frame.radiance


def _flown(camera: Any, k: int) -> Any:
    """Over the shore at 1.6 m/s, turning."""
    (x, y, z), (to_x, to_y, to_z) = camera.position, camera.target
    return camera.replace(position=(x + 0.05 * k, y, z - 0.04 * k), target=(to_x - 0.1 * k, to_y, to_z))


def _row(name: str, rows: dict[str, _Row]) -> dict[str, Any]:
    row = rows[name]
    passes = row.passes
    largest = sorted(passes, key=passes.__getitem__, reverse=True)[:NAMED]
    whole = sum(passes.values())
    said = [row.note, ", ".join(f"{label} {100.0 * passes[label] / whole:.0f} %" for label in largest)]
    if row.against in rows:
        said.insert(1, f"{np.median(row.ms) / np.median(rows[row.against].ms):.2f} times {row.against}")
    base = rows[BASE].ms if BASE in rows else None
    printed = row_of(name, row.ms, base, _error(name, rows), "; ".join(said))
    processor_ms = round(float(np.median(row.processor_ms)), 2)
    return {**printed, "fps": round(1e3 / printed["ms"], 2), "processor_ms": processor_ms, "passes": passes}


def _error(name: str, rows: dict[str, _Row]) -> float | None:
    row = rows[name]
    if row.quality is None or row.flies or name == TRUEST or not {TRUEST, BASE} <= set(rows):
        return None
    picture, true, dry = (np.asarray(r.picture, np.float64) for r in (row, rows[TRUEST], rows[BASE]))
    covered = np.abs(true - dry).max(axis=2) > 1e-6
    return float(np.abs(picture - true)[covered].mean() / true[covered].mean())
