"""Light in one volume as it is asked for from outside: power, fluence and direction as arrays."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from pellucid.errors import SceneError
from pellucid.scene import DirectionalLight, LightQuality
from pellucid.techniques.eikonal.light import Lit
from pellucid.techniques.eikonal.light_sources import sources_of
from pellucid.techniques.eikonal.prepare import Prepared
from pellucid.techniques.eikonal.proxies import whole_box

if TYPE_CHECKING:
    from pellucid.surroundings import Surroundings
    from pellucid.techniques.eikonal.passes import EikonalTechnique


@dataclass(frozen=True)
class Irradiance:
    """Light in a volume.

    fluence : (Z, Y, X, 3) float32, radiant power that crosses a small ball at each voxel, per area of its
        cross-section: in a parallel beam the irradiance of a surface that faces it. RGB, in the units of the lights.
    direction : (Z, Y, X, 3) float32, mean direction of travel in object space, over 2 x 2 x 2 voxels; its length,
        0 to 1, says how parallel light is.
    flux_in, flux_absorbed, flux_out, flux_ended : (3,) float64, radiant power that entered the box, was absorbed or
        scattered in it, left it, and was given up (too weak, too many bounces, lists full); they sum to nothing.
    patches : how many patches were followed.
    seconds : what it took.
    """

    fluence: np.ndarray
    direction: np.ndarray
    flux_in: np.ndarray
    flux_absorbed: np.ndarray
    flux_out: np.ndarray
    flux_ended: np.ndarray
    patches: int
    seconds: float


def illuminate(
    technique: EikonalTechnique,
    lights: Sequence[object],
    surroundings: Surroundings,
    progress: Callable[[float], None] | None = None,
) -> Irradiance:
    """Light in the one body of a technique. See `pellucid.illuminate`."""
    begun = time.perf_counter()
    body = technique.bodies[0]
    check_lights(body.prepared, body.world, lights)
    lit = Lit(body, body.objects[0].light)
    technique.simulator.run([lit], lights, surroundings, progress=progress)
    totals, patches = technique.simulator.totals()
    del totals["flux_unsent"]
    shape = body.objects[0].volume.shape
    fluence, direction = (_inner(field, body.prepared, shape) for field in technique.simulator.read())
    seconds = time.perf_counter() - begun
    return Irradiance(fluence, direction, **totals, patches=patches, seconds=seconds)


def _inner(field: np.ndarray, prepared: Prepared, shape: tuple[int, int, int]) -> np.ndarray:
    """At the voxels of a volume, without those that preparing has added on every side; larger ones are repeated."""
    for axis, voxels in enumerate(shape):
        have = round(prepared.extent_m[2 - axis] / prepared.voxel_m[2 - axis])
        at = (np.arange(voxels) + (have - voxels) // 2 + 0.5) * field.shape[axis] / have
        field = np.take(field, at.astype(int), axis=axis)
    return np.ascontiguousarray(field)


def flux_bound(prepared: Prepared, world: np.ndarray, lights: Sequence[object], quality: LightQuality) -> float:
    """Power that the lamps shed on the box of a volume, brightest channel, if nothing is in between."""
    box = whole_box(prepared)
    fronts = (s for lamp in lights for s in sources_of(lamp, world, box, prepared.voxel, quality))
    return sum(front.total_flux for front in fronts)


def check_lights(prepared: Prepared, world: np.ndarray, lights: Sequence[object]) -> None:
    """Lamps do not stand in opaque matter.

    Raises
    ------
    SceneError : names the lamp.
    """
    if prepared.opaque is None:
        return
    inverse = np.linalg.inv(world)
    half = 0.5 * np.array(prepared.extent_m)
    size = np.array(prepared.opaque.shape[2::-1])
    for number, lamp in enumerate(lights):
        if isinstance(lamp, DirectionalLight):
            continue
        position = np.array(lamp.position, dtype=np.float64)  # type: ignore[attr-defined]
        at = inverse[:3, :3] @ position + inverse[:3, 3]
        x, y, z = np.floor((at / (2.0 * half) + 0.5) * size).astype(int)
        if (np.abs(at) < half).all() and prepared.opaque[z, y, x, 3] > 0.5:
            reason = "lies inside opaque matter of a volume, which lets no light out"
            raise SceneError(f"scene.lights[{number}].position", reason, "move the lamp or the volume")
