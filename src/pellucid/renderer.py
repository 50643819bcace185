"""The frame: the order of the passes, and nothing else."""

from __future__ import annotations

import time as clock
from collections.abc import Callable
from operator import index as whole
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.errors import SceneError
from pellucid.frame import Frame
from pellucid.gpu import Device, PassTimer
from pellucid.gpu.targets import Targets
from pellucid.scene import Camera, RefractiveSheet, RefractiveVolume, ReliefSurface, Scene, Water
from pellucid.scene.checks import number
from pellucid.surroundings import Surroundings
from pellucid.techniques.eikonal.passes import EikonalTechnique
from pellucid.techniques.environment.passes import Sky
from pellucid.techniques.finish.accumulate import Accumulator
from pellucid.techniques.finish.passes import Finish
from pellucid.techniques.opaque.passes import Opaque
from pellucid.techniques.relief.passes import ReliefTechnique
from pellucid.techniques.sheet.passes import SheetTechnique
from pellucid.techniques.water.passes import WaterTechnique

if TYPE_CHECKING:
    from pellucid.techniques.eikonal.irradiance import Irradiance

# Which technique draws which kind of object. Adding one takes a folder and a line here.
TECHNIQUES: dict[type, Any] = {
    RefractiveSheet: SheetTechnique,
    Water: WaterTechnique,
    ReliefSurface: ReliefTechnique,
    RefractiveVolume: EikonalTechnique,
}

# Of a picture of radiance in one buffer, as it is summed and read back.
BYTES_PER_PIXEL = 16


class Renderer:
    """Renders scenes on one device, and keeps there what the next frame can use again.

    Parameters
    ----------
    device : where to render; the best adapter of this machine when omitted.

    Raises
    ------
    NoAdapterError : when no device is given and there is none.
    """

    def __init__(self, device: Device | None = None) -> None:
        self.device = device or Device.create()
        self.surroundings = Surroundings(self.device)
        self._opaque = Opaque(self.device)
        self._sky = Sky(self.device)
        self._finish = Finish(self.device)
        self._techniques: dict[type, Any] = {}
        self._targets: Targets | None = None
        self._display: Any = None

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held by the surroundings and the techniques."""
        return self.surroundings.nbytes + sum(t.nbytes for t in self._techniques.values())

    def render(
        self,
        scene: Scene,
        size: tuple[int, int] = (800, 600),
        time: float = 0.0,
        samples: int = 1,
        progress: Callable[[float], None] | None = None,
    ) -> Frame:
        """Render one picture. The same input on the same device gives the same bits.

        Parameters
        ----------
        scene : what to draw. size : (width, height) in pixels.
        time : seconds, for objects that move by themselves, such as ripples on a relief.
        samples : jittered pictures that are averaged, for anti-aliasing.
        progress : called with the share that is done, 0 to 1.

        Raises
        ------
        SceneError : for a size, a number of samples or a time out of range.
        """
        begun = clock.perf_counter()
        number("time", time, unit="seconds")
        width, height = self._check(scene, size, samples)
        self._use_size((width, height))
        assert self._targets is not None
        timer = PassTimer(self.device)
        self._prepare(scene, (width, height))
        self._simulate(time)
        self.device.wait()
        timings = {"prepare": 1e3 * (clock.perf_counter() - begun)}
        self._illuminate(scene, timings)
        mean, depth = self._accumulate(scene, samples, timer, timings, progress)
        self._finish.prepare(scene.exposure, scene.tone_mapping, scene.glow)
        encoder = self.device.wgpu.create_command_encoder()
        self._finish.draw(encoder, self._targets.color, self._display.create_view(), timer)
        self._submit(encoder, timer, timings)
        display = self.device.read_texture(self._display)[..., :3]
        timings["total"] = 1e3 * (clock.perf_counter() - begun)
        return Frame(mean[..., :3], _metres(depth, scene.camera), display, timings)

    def illuminate(
        self, scene: Scene, volume: RefractiveVolume, progress: Callable[[float], None] | None = None
    ) -> Irradiance:
        """Light in one volume of a scene. See `pellucid.illuminate`."""
        from pellucid.techniques.eikonal.irradiance import illuminate

        self._check(scene, (1, 1), 1)
        if not any(item is volume for item in scene.objects):
            raise SceneError("volume", "is not among the objects of the scene", "add it to Scene(objects=[...])")
        self.surroundings.prepare(scene, (1, 1))
        technique = EikonalTechnique(self.device)
        technique.prepare([volume], self.surroundings)
        return illuminate(technique, scene.lights, self.surroundings, progress)

    def _check(self, scene: Scene, size: tuple[int, int], samples: int) -> tuple[int, int]:
        if not isinstance(scene, Scene):
            raise SceneError("scene", f"is a {type(scene).__name__}", "give a pellucid.Scene")
        limit = self.device.limits["max-texture-dimension-2d"]
        try:
            width, height = (whole(s) for s in size)
        except (TypeError, ValueError):
            raise SceneError("size", f"is {size!r}", "give (width, height) in whole pixels") from None
        if not (1 <= width <= limit and 1 <= height <= limit):
            raise SceneError("size", f"is {width} x {height}", f"use 1 to {limit} pixels a side on this device")
        most = self.device.limits["max-storage-buffer-binding-size"] // BYTES_PER_PIXEL
        if width * height > most:
            reason = f"{width} x {height} are {width * height / 1e6:.1f} million pixels"
            raise SceneError("size", reason, f"this device holds {most / 1e6:.1f} million; render it in parts")
        if isinstance(samples, bool) or not isinstance(samples, int | np.integer) or not 1 <= samples <= 65536:
            raise SceneError("samples", f"is {samples!r}", "use a whole number from 1 to 65536")
        return width, height

    def _use_size(self, size: tuple[int, int]) -> None:
        if self._targets is None or self._targets.size != size:
            self._targets = Targets(self.device, size)
            usage = ("render", "copy", "sample")
            self._display = self.device.texture(size=size, format="rgba8unorm", usage=usage, label="display")

    def _prepare(self, scene: Scene, size: tuple[int, int]) -> None:
        items = {kind: [o for o in scene.objects if type(o) is kind] for kind in TECHNIQUES}
        for kind in TECHNIQUES:
            if items[kind] and kind not in self._techniques:
                self._techniques[kind] = TECHNIQUES[kind](self.device)
        drawn = [(self._techniques[kind], items[kind]) for kind in TECHNIQUES if kind in self._techniques]
        stand_ins = [
            mesh for technique, own in drawn if hasattr(technique, "stand_ins") for mesh in technique.stand_ins(own)
        ]
        self.surroundings.prepare(scene, size, stand_ins)
        for technique, own in drawn:
            technique.prepare(own, self.surroundings)

    def _simulate(self, time: float) -> None:
        """Move what moves by itself to a time."""
        for technique in self._techniques.values():
            if hasattr(technique, "simulate"):
                technique.simulate(time)

    def _illuminate(self, scene: Scene, timings: dict[str, float]) -> None:
        """Light from the lamps' side, where a technique wants it; kept until what it depends on moves."""
        begun = clock.perf_counter()
        for technique in self._techniques.values():
            technique.illuminate(scene.lights, self.surroundings)
        self.device.wait()
        timings["illuminate"] = 1e3 * (clock.perf_counter() - begun)

    def _accumulate(
        self,
        scene: Scene,
        samples: int,
        timer: PassTimer,
        timings: dict[str, float],
        progress: Callable[[float], None] | None,
    ) -> tuple[np.ndarray, np.ndarray]:
        """The mean of the samples, which is left in the colour target too, and the depth of the first."""
        targets = self._targets
        assert targets is not None
        total = Accumulator(self.device, targets.size) if samples > 1 else None
        depth = np.empty(0)
        for index in range(samples):
            offset = _jitter(index) if samples > 1 else (0.0, 0.0)
            self.surroundings.set_camera(scene.camera, targets.size, offset, index)
            encoder = self.device.wgpu.create_command_encoder()
            self._draw(encoder, scene, targets, timer)
            if total is not None:
                total.add(encoder, targets.color, timer)
            self._submit(encoder, timer, timings)
            if index == 0:
                depth = targets.read_depth()
            if progress is not None:
                progress((index + 1) / samples)
        if total is None:
            return self.device.read_texture(targets.color), depth
        mean = total.mean()
        self.device.write_texture(targets.color, mean)
        return mean, depth

    def _draw(self, encoder: Any, scene: Scene, targets: Targets, timer: PassTimer) -> None:
        """Illuminate, opaque, refractive: everything up to the linear picture.

        Each technique draws all of its objects; they follow one another far to near, by the nearest object of each.
        """
        around = self.surroundings
        self._opaque.illuminate(encoder, around, timer)
        hidden = next((t.hides(around.view) for t in self._techniques.values() if hasattr(t, "hides")), None)
        self._opaque.draw(encoder, targets.color, targets.depth, around, timer, hidden, self._sky)
        nearest: dict[type, float] = {}
        for item in (o for o in scene.objects if type(o) in TECHNIQUES):
            nearest[type(item)] = min(nearest.get(type(item), np.inf), _distance(item, scene.camera))
        for kind in sorted(nearest, key=nearest.__getitem__, reverse=True):
            self._techniques[kind].draw(encoder, targets, scene.camera, around, timer)

    def _submit(self, encoder: Any, timer: PassTimer, timings: dict[str, float]) -> None:
        self.device.wgpu.queue.submit([encoder.finish()])
        for label, ms in timer.milliseconds().items():
            timings[label] = timings.get(label, 0.0) + ms


def _distance(item: Any, camera: Camera) -> float:
    return float(np.linalg.norm(item.object_to_world()[:3, 3] - np.asarray(camera.position)))


def _jitter(index: int) -> tuple[float, float]:
    """Point `index` of the Halton sequence in bases 2 and 3, about the pixel's centre."""
    return _radical_inverse(index + 1, 2) - 0.5, _radical_inverse(index + 1, 3) - 0.5


def _radical_inverse(number: int, base: int) -> float:
    out, digit = 0.0, 1.0 / base
    while number:
        number, remainder = divmod(number, base)
        out += remainder * digit
        digit /= base
    return out


def _metres(depth: np.ndarray, camera: Camera) -> np.ndarray:
    """Depth-buffer values to metres along the view axis: near/z for perspective, linear for orthographic."""
    near, far = camera.near_m, camera.far_m
    with np.errstate(divide="ignore"):
        metres = far - depth * (far - near) if camera.is_orthographic else near / depth
    return np.where(depth > 0.0, metres, np.inf).astype(np.float32)
