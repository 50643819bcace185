"""The view renderer: the same ball drawn in several ways, and what it takes to prepare a body."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from pellucid.benchmarks.rows import RESOLUTION, SIZE, Progress, bunny_path, device_of, row_of


def eikonal(progress: Progress = lambda share: None, repeat: int = 5) -> dict[str, Any]:
    """The view renderer: a glass ball of 128^3 voxels that covers half of an 800x600 picture, under a studio sky.

    The error of a row is the mean absolute difference of radiance from a picture with steps 16 times finer than the
    base's, as a share of the mean radiance, both over the pixels that the ball covers.
    """
    from pellucid.renderer import Renderer
    from pellucid.scene import Quality

    renderer = Renderer()
    fixed = Quality(step_voxels=0.5, adaptive=False, max_steps=20000)
    variants = {
        "euler_half_voxel": ("smooth", fixed.replace(method="euler"), "fixed steps, first order"),
        "leapfrog_half_voxel": ("smooth", fixed, "fixed steps, second order"),
        "adaptive": ("smooth", Quality(step_voxels=1.5), "jumps through homogeneous matter, steps up to 1.5 voxels"),
        "adaptive_default": ("smooth", Quality(), "the same, steps up to half a voxel"),
        "sharp": ("sharp", Quality(), "surfaces by sphere tracing, a tree of rays; has no error of steps"),
        "crystal": ("crystal", Quality(), "the same, of a crystal with the indices of calcite: two kinds of rays"),
    }
    glass_ball = _ball_scene()
    scenes = {name: glass_ball(boundary, quality) for name, (boundary, quality, _) in variants.items()}
    reference = renderer.render(glass_ball("smooth", fixed.replace(step_voxels=0.5 / 16)), SIZE).radiance
    covered = _covered(renderer, scenes["adaptive"])
    pictures = {name: renderer.render(scene, SIZE).radiance for name, scene in scenes.items()}  # the warm-up
    times: dict[str, list[float]] = {name: [] for name in scenes}
    for turn in range(repeat):
        for number, (name, scene) in enumerate(scenes.items()):
            timings = renderer.render(scene, SIZE).timings
            times[name].append(sum(ms for label, ms in timings.items() if label.startswith("eikonal")))
            progress((turn + (number + 1) / len(scenes)) / (repeat + 1))
    memory = renderer.nbytes / 2**20
    rows = []
    for name, (boundary, _, note) in variants.items():
        error = None if boundary in ("sharp", "crystal") else _difference(pictures[name], reference, covered)
        rows.append(row_of(name, times[name], times["euler_half_voxel"], error, note))
    rows[-1]["note"] += f"; {memory:.0f} MiB on the device"
    rows += _preparation_rows()
    progress(1.0)
    return {"device": device_of(renderer), "suite": "eikonal", "rows": rows}


def _ball_scene() -> Callable[[str, Any], Any]:
    """Scenes of one and the same ball by boundary (or as a crystal) and quality."""
    from pellucid.fields.shapes import sphere
    from pellucid.fields.volume import Volume
    from pellucid.media import uniaxial
    from pellucid.scene import Camera, Environment, RefractiveVolume, Scene

    volume = Volume.from_sdf(sphere(0.045), 1.5, RESOLUTION, 0.1)
    spar = Volume.from_sdf(sphere(0.045), uniaxial(1.6584, 1.4864), RESOLUTION, 0.1, optic_axis=(1.0, 2.0, 3.0))
    environment = Environment.studio()
    camera = Camera(position=(0.03, 0.06, 0.2), target=(0.0, 0.0, 0.0), fov_deg=32.0)

    def scene(boundary: str, quality: Any) -> Any:
        if boundary == "crystal":
            ball = RefractiveVolume(spar, quality=quality)
        else:
            ball = RefractiveVolume(volume, boundary=boundary, quality=quality)
        return Scene(camera=camera, environment=environment, objects=[ball], tone_mapping="linear")

    return scene


def _covered(renderer: Any, scene: Any) -> np.ndarray:
    """Where the ball is: the pixels that differ from the picture without it."""
    bare = renderer.render(scene.replace(objects=[]), SIZE).radiance
    return np.abs(renderer.render(scene, SIZE).radiance - bare).max(axis=2) > 1e-6


def _difference(picture: np.ndarray, reference: np.ndarray, where: np.ndarray) -> float:
    return float(np.abs(picture - reference)[where].mean() / reference[where].mean())


def _preparation_rows() -> list[dict[str, Any]]:
    """From triangles to what the GPU is given, at 128 voxels along the longest edge."""
    from pellucid.fields.shapes import creature_mesh

    rows = [_prepare_row("prepare_creature", *creature_mesh(0.1))]
    bunny = bunny_path()
    if bunny is not None:
        from pellucid.io.meshes import read_mesh

        mesh = read_mesh(bunny)
        rows.append(_prepare_row("prepare_bunny", mesh.vertices, mesh.faces))
    return rows


def _prepare_row(name: str, vertices: np.ndarray, faces: np.ndarray) -> dict[str, Any]:
    from pellucid.fields.volume import Volume
    from pellucid.techniques.eikonal.prepare import prepare

    begun = time.perf_counter()
    volume, _ = Volume.from_mesh(vertices, faces, 1.5, RESOLUTION)
    voxelised = time.perf_counter()
    prepare(volume, "sharp")
    prepare(volume, "smooth")
    done = time.perf_counter()
    shape = " x ".join(str(n) for n in volume.shape[::-1])
    seconds = f"{voxelised - begun:.2f} s, fields of both boundaries {done - voxelised:.2f} s"
    note = f"{len(faces)} faces to {shape} voxels in {seconds}"
    return row_of(name, [1e3 * (done - begun)], None, None, note)
