"""The light simulator: what it takes until a volume is lit again after its lamp has moved."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.benchmarks.rows import RESOLUTION, SIZE, Progress, bunny_path, device_of, row_of

if TYPE_CHECKING:
    from pellucid.fields import Volume
    from pellucid.scene import LightQuality, RefractiveVolume

BASE = f"relight_ball_{RESOLUTION}"
FINE = 0.25  # voxels, of the run that the error is measured against
SCATTERING = (3.0, 3.0, 3.0)  # 1/m: so that light is wanted all over the body
PATIENCE_S = 10.0


@dataclasses.dataclass
class _Job:
    """A scene that is lit again and again."""

    build: Callable[[], RefractiveVolume]
    note: str
    floor: bool = False
    wall_ms: list[float] = dataclasses.field(default_factory=list)
    processor_ms: list[float] = dataclasses.field(default_factory=list)
    patches: int = 0


def light(progress: Progress = lambda share: None, repeat: int = 3) -> dict[str, Any]:
    """Bodies of N-BK7 are lit by a lamp that moves between two runs; then a lit ball is drawn.

    The error of `relight_ball_64` is the root of the mean square of the difference of its fluence from that of a run
    with front and patches of a quarter voxel, relative to that of this run. Rows without a word on it follow one index;
    a dispersive medium is followed once for each of three.
    """
    from pellucid.renderer import Renderer

    renderer = Renderer()
    jobs = _jobs()
    views = {f"view_clear_{RESOLUTION}": _view(False), f"view_scattering_{RESOLUTION}": _view(True)}
    shares = len(jobs) + 2
    for number, job in enumerate(jobs.values()):
        _relight(renderer.device, job, repeat)
        progress((number + 1) / shares)
    rows = [
        row_of(
            name, job.wall_ms, jobs[BASE].wall_ms, _error(renderer) if name == "relight_ball_64" else None, _said(job)
        )
        for name, job in jobs.items()
    ]
    progress((shares - 1) / shares)
    for name, (scene, note) in views.items():
        drawn = [renderer.render(scene, SIZE).timings for _ in range(repeat + 1)][1:]
        times = [sum(ms for label, ms in timings.items() if label.startswith("eikonal")) for timings in drawn]
        rows.append(row_of(name, times, jobs[BASE].wall_ms, None, note))
    progress(1.0)
    return {"device": device_of(renderer), "suite": "light", "rows": rows}


def _jobs() -> dict[str, _Job]:
    from pellucid.scene import LightQuality

    bunny_note = "" if bunny_path() else "no bunny.ply here: the creature of pellucid.fields.shapes stands for it"
    intensity, coarse = LightQuality(method="intensity"), LightQuality(fluence_voxels=2.0)
    return {
        BASE: _Job(lambda: _ball(RESOLUTION), "a ball that scatters, 0.8 of the box across"),
        f"relight_bunny_{RESOLUTION}": _Job(_bunny, bunny_note),
        "relight_ball_64": _Job(lambda: _ball(64), "error: fluence against front and patches of a quarter voxel"),
        "relight_ball_192": _Job(lambda: _ball(192), ""),
        "relight_ball_256": _Job(lambda: _ball(256), "fluence on as many voxels as a buffer of the device holds"),
        f"relight_ball_{RESOLUTION}_coarse": _Job(lambda: _ball(RESOLUTION, coarse), "fluence_voxels=2"),
        f"relight_bunny_{RESOLUTION}_coarse": _Job(lambda: _bunny(coarse), "fluence_voxels=2"),
        f"dispersion_ball_{RESOLUTION}": _Job(
            lambda: _ball(RESOLUTION, dispersion=True), "three indices, one after the other"
        ),
        f"intensity_ball_{RESOLUTION}": _Job(
            lambda: _ball(RESOLUTION, intensity), "intensity law, strongest patch of a voxel"
        ),
        f"caustics_ball_{RESOLUTION}": _Job(
            lambda: _ball(RESOLUTION, scatters=False), "a clear ball over a floor: caustic and shadow only", floor=True
        ),
    }


def _ball(
    resolution: int, quality: LightQuality | None = None, dispersion: bool = False, scatters: bool = True
) -> RefractiveVolume:
    from pellucid.fields.shapes import sphere
    from pellucid.fields.volume import Volume

    volume = Volume.from_sdf(sphere(0.04), "N-BK7", resolution, 0.1)
    return _placed(volume, quality, dispersion, scatters)


def _placed(
    volume: Volume, quality: LightQuality | None = None, dispersion: bool = False, scatters: bool = True
) -> RefractiveVolume:
    from pellucid.scene import LightQuality, RefractiveVolume

    if scatters:
        volume = volume.replace(
            regions=tuple(dataclasses.replace(region, scattering=SCATTERING) for region in volume.regions)
        )
    return RefractiveVolume(volume, dispersion=dispersion, light=quality or LightQuality())


def _bunny(quality: LightQuality | None = None) -> RefractiveVolume:
    from pellucid.fields.shapes import creature_mesh
    from pellucid.fields.volume import Volume
    from pellucid.io.meshes import read_mesh

    path = bunny_path()
    mesh = read_mesh(path) if path is not None else None
    vertices, faces = (mesh.vertices, mesh.faces) if mesh is not None else creature_mesh(0.1)
    volume, _ = Volume.from_mesh(vertices, faces, "N-BK7", RESOLUTION)
    return _placed(volume, quality)


def _relight(device: Any, job: _Job, repeat: int) -> None:
    """Times from the moment that the lamp has moved until what shows its light is ready; the first run warms up.

    A row that has taken longer than `PATIENCE_S` is not run again.
    """
    from pellucid.scene import Camera, DirectionalLight, Mesh, Scene
    from pellucid.surroundings import Surroundings
    from pellucid.techniques.eikonal.passes import EikonalTechnique

    volume = job.build()
    floor = [Mesh.plane(0.6, position=(0.0, -0.06, 0.0))] if job.floor else []
    scene = Scene(camera=Camera(position=(0.0, 0.1, 0.5)), objects=[volume, *floor])
    surroundings, technique = Surroundings(device), EikonalTechnique(device)
    for turn in range(repeat + 1):
        if sum(job.wall_ms) > 1e3 * PATIENCE_S:
            break
        moved = scene.replace(lights=[DirectionalLight(direction=(0.4, -1.0, 0.2 + 0.01 * turn), irradiance=2.0)])
        device.wait()
        begun = time.perf_counter(), time.process_time()
        surroundings.prepare(moved, (1, 1))
        technique.prepare([volume], surroundings)
        technique.illuminate(moved.lights, surroundings)
        device.wait()
        if turn > 0:
            job.wall_ms.append(1e3 * (time.perf_counter() - begun[0]))
            job.processor_ms.append(1e3 * (time.process_time() - begun[1]))
    job.patches = technique.simulator.totals()[1]


def _said(job: _Job) -> str:
    processor_ms = float(np.median(job.processor_ms))
    counted = f"{job.patches} patches, {processor_ms:.0f} ms of processor time, {len(job.wall_ms)} runs"
    return f"{job.note}; {counted}" if job.note else counted


def _error(renderer: Any) -> float:
    from pellucid.scene import Camera, DirectionalLight, LightQuality, Scene

    lamp = DirectionalLight(direction=(0.4, -1.0, 0.2), irradiance=2.0)
    found = []
    for quality in (LightQuality(), LightQuality(front_voxels=FINE, split_voxels=FINE)):
        ball = _ball(64, quality)
        scene = Scene(camera=Camera(position=(0.0, 0.1, 0.5)), lights=[lamp], objects=[ball])
        found.append(renderer.illuminate(scene, ball).fluence.astype(np.float64))
    return float(np.sqrt(np.square(found[0] - found[1]).mean() / np.square(found[1]).mean()))


def _view(scatters: bool) -> tuple[Any, str]:
    """A picture of which the ball covers about half, and what is said of it."""
    from pellucid.scene import Camera, DirectionalLight, Environment, Scene

    camera = Camera(position=(0.03, 0.06, 0.18), target=(0.0, 0.0, 0.0), fov_deg=32.0)
    lamp = DirectionalLight(direction=(0.4, -1.0, 0.2), irradiance=2.0)
    ball = _ball(RESOLUTION, scatters=scatters)
    scene = Scene(camera=camera, environment=Environment.studio(), lights=[lamp], objects=[ball])
    what = "the ball that scatters" if scatters else "a clear ball"
    return scene, f"{what}, drawn at {SIZE[0]} x {SIZE[1]}: refractive passes of a frame, light as it was"
