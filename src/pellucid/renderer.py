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
from pellucid.gpu.readback import TextureRead, read_back
from pellucid.gpu.targets import Held, TargetRing, Targets
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
        self._targets = TargetRing(self.device)
        self._timer = PassTimer(self.device)
        self._display: Any = None
        self._display_view: Any = None

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
        targets, held = self._use_size((width, height))
        self._timer.forget()
        self._prepare(scene, (width, height))
        self._simulate(time)
        timings = {"prepare": 1e3 * (clock.perf_counter() - begun)}
        lit = clock.perf_counter()
        self._illuminate(scene)
        self._finish.prepare(scene.exposure, scene.tone_mapping, scene.glow)
        averaged: tuple[np.ndarray, np.ndarray] | None = None
        if samples > 1:
            self._wait(timings, lit)
            averaged = self._accumulate(scene, samples, targets, timings, progress)
            self.device.write_texture(targets.color, averaged[0])
            encoder = self.device.wgpu.create_command_encoder()
        else:
            encoder = self._draw(scene, targets)  # while the device is busy with the light
            self._wait(timings, lit)
        self._finish.draw(encoder, targets.color, self._display_view, self._timer)
        display = self._submit(encoder, timings, [TextureRead(self._display)])[0][..., :3]
        timings["total"] = 1e3 * (clock.perf_counter() - begun)
        camera = scene.camera
        if averaged is not None:
            return Frame(averaged[0][..., :3], _metres(averaged[1], camera), display, timings)
        if progress is not None:
            progress(1.0)
        return Frame(lambda: held.color()[..., :3], lambda: _metres(held.depth(), camera), display, timings)

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

    def _use_size(self, size: tuple[int, int]) -> tuple[Targets, Held]:
        if self._display is None or (self._display.width, self._display.height) != size:
            usage = ("render", "copy", "sample")
            self._display = self.device.texture(size=size, format="rgba8unorm", usage=usage, label="display")
            self._display_view = self._display.create_view()
        return self._targets.take(size)

    def _prepare(self, scene: Scene, size: tuple[int, int]) -> None:
        items = {kind: [o for o in scene.objects if type(o) is kind] for kind in TECHNIQUES}
        for kind in TECHNIQUES:
            if items[kind] and kind not in self._techniques:
                self._techniques[kind] = TECHNIQUES[kind](self.device)
        drawn = [(self._techniques[kind], items[kind]) for kind in TECHNIQUES if kind in self._techniques]
        stand_ins = [
            mesh for technique, own in drawn if hasattr(technique, "stand_ins") for mesh in technique.stand_ins(own)
        ]
        # Where nothing else sends rays, volumes see one another by themselves.
        mixed = sum(bool(own) for own in items.values()) > 1
        interfaces = [
            surface
            for technique, own in drawn
            if mixed and hasattr(technique, "interfaces")
            for surface in technique.interfaces(own, items[Water])
        ]
        self.surroundings.prepare(scene, size, stand_ins, interfaces)
        for technique, own in drawn:
            technique.prepare(own, self.surroundings)

    def _simulate(self, time: float) -> None:
        """Move what moves by itself to a time."""
        for technique in self._techniques.values():
            if hasattr(technique, "simulate"):
                technique.simulate(time)

    def _illuminate(self, scene: Scene) -> None:
        """Light from the lamps' side, where a technique wants it; kept until what it depends on moves."""
        for technique in self._techniques.values():
            technique.illuminate(scene.lights, self.surroundings)

    def _wait(self, timings: dict[str, float], begun: float) -> None:
        self.device.wait()
        timings["illuminate"] = 1e3 * (clock.perf_counter() - begun)

    def _accumulate(
        self,
        scene: Scene,
        samples: int,
        targets: Targets,
        timings: dict[str, float],
        progress: Callable[[float], None] | None,
    ) -> tuple[np.ndarray, np.ndarray]:
        """The mean of the samples, and the depth of the first."""
        total = Accumulator(self.device, targets.size)
        depth = np.empty(0)
        for index in range(samples):
            encoder = self._draw(scene, targets, _jitter(index), index)
            total.add(encoder, targets.color, self._timer)
            found = self._submit(encoder, timings, [TextureRead(targets.depth)] if index == 0 else [])
            if index == 0:
                depth = found[0][..., 0]
            if progress is not None:
                progress((index + 1) / samples)
        return total.mean(), depth

    def _draw(self, scene: Scene, targets: Targets, offset: tuple[float, float] = (0.0, 0.0), index: int = 0) -> Any:
        """Encode illuminate, opaque, refractive: everything up to the linear picture.

        Each technique draws all of its objects; they follow one another far to near, by the nearest object of each.
        Water comes first, for what has no surface of its own lies over it, or last, for it dims what is in it with the
        camera.
        """
        around, timer = self.surroundings, self._timer
        around.set_camera(scene.camera, targets.size, offset, index)
        encoder = self.device.wgpu.create_command_encoder()
        self._opaque.illuminate(encoder, around, timer)
        hidden = next((t.hides(around.view) for t in self._techniques.values() if hasattr(t, "hides")), None)
        self._opaque.draw(encoder, targets.color, targets.depth, around, timer, hidden, self._sky)
        nearest: dict[type, float] = {}
        for item in (o for o in scene.objects if type(o) in TECHNIQUES):
            nearest[type(item)] = min(nearest.get(type(item), np.inf), _distance(item, scene.camera))
        order = sorted(nearest, key=nearest.__getitem__, reverse=True)
        if Water in order:
            order.remove(Water)
            order.insert(len(order) if self._techniques[Water].holds(scene.camera) else 0, Water)
        for kind in order:
            self._techniques[kind].draw(encoder, targets, scene.camera, around, timer)
        return encoder

    def _submit(self, encoder: Any, timings: dict[str, float], reads: list[TextureRead]) -> list[np.ndarray]:
        """Have the work done, all that is read of it with one wait."""
        ticks = self._timer.resolve(encoder)
        found = read_back(self.device, [*reads, *ticks], encoder)
        for label, ms in self._timer.summed(found.pop()).items() if ticks else ():
            timings[label] = timings.get(label, 0.0) + ms
        return found


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
