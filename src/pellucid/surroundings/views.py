"""Opaque meshes and the sky from any camera: which triangle each pixel shows, then its light, then the background."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu import Pipelines, RenderPass
from pellucid.gpu.targets import COLOR_FORMAT, DEPTH_FORMAT
from pellucid.surroundings.culling import Clusters, clusters, visible_ranges

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.gpu.timing import PassTimer
    from pellucid.surroundings.camera import View
    from pellucid.surroundings.geometry import Geometry
    from pellucid.surroundings.prepare import Surroundings

SHADERS = "surroundings/shaders"
CLEAR = (0.0, 0.0, 0.0, 0.0)
FARTHEST_M = 1e30
APART_FORMAT = "rgba32uint"  # see shaders/shading_apart.wgsl

Box = tuple[tuple[float, float, float], tuple[float, float, float]]  # lower and upper corner, metres


@dataclass(frozen=True)
class Shown:
    """What of the meshes a view shows.

    clip : (a, b, c, d) keeps what has a x + b y + c z + d >= 0, exactly at each pixel; None keeps all.
    cull_back_faces : leave out what turns its back to the camera, double-sided or not, so that no solid that is cut
        open shows its inside.
    stand_ins : show what only rays meet too.
    hidden : leave out what lies within this box, for something else will be drawn before it; not together with `clip`.
    """

    clip: tuple[float, float, float, float] | None = None
    cull_back_faces: bool = False
    stand_ins: bool = False
    hidden: Box | None = None

    @property
    def constants(self) -> dict[str, float]:
        """Override constants of the visibility pass."""
        return {"CULL_BACK_FACES": float(self.cull_back_faces), "STAND_INS": float(self.stand_ins)}


EVERYTHING = Shown()


def above(level_m: float) -> tuple[float, float, float, float]:
    """Clip plane that keeps y >= level."""
    return (0.0, 1.0, 0.0, -level_m)


def below(level_m: float) -> tuple[float, float, float, float]:
    """Clip plane that keeps y <= level."""
    return (0.0, -1.0, 0.0, level_m)


class SceneView:
    """Draws the surroundings from one camera; keeps what the next picture from it needs.

    Shading once a pixel spares the pixels that small triangles share and hide from one another [burns2013].

    Parameters
    ----------
    device : where to draw.
    format : of the colour targets that it is given.
    """

    def __init__(self, device: Device, format: str = COLOR_FORMAT) -> None:
        self.device = device
        self.format = format
        self._pipelines = Pipelines(device, ("shaded_rest",), shared=True)
        self._triangles: Any = None
        self._apart: tuple[Any, Any] | None = None
        self._frame: Any = None
        self._clip: Any = None
        self._box: Any = None
        self._clusters: tuple[Geometry | None, Clusters | None] = (None, None)
        self._seen: tuple[Any, ...] = ()
        self._rested: tuple[Any, ...] = ()
        self._lit: tuple[Any, ...] = ()

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held for shading."""
        kept = [] if self._triangles is None else [(self._triangles, 4)]
        if self._apart is not None:
            kept += [(self._apart[0], 16 if self.format == COLOR_FORMAT else 8), (self._apart[1], 16)]
        return sum(texture.width * texture.height * size for texture, size in kept)

    def draw(
        self,
        encoder: Any,
        color: Any,
        depth: Any,
        surroundings: Surroundings,
        shown: Shown = EVERYTHING,
        view: View | None = None,
        size: tuple[int, int] | None = None,
        sky: bool = False,
        timer: PassTimer | None = None,
        label: str = "opaque",
        kept: bool = False,
        waters: bool = True,
    ) -> None:
        """Clear both targets and draw every mesh, and the sky behind them if it is wanted.

        Parameters
        ----------
        color : view of a target of this view's format, receives linear radiance; 0 where nothing is.
        depth : view of a depth32float target, receives reversed depth; 0 where nothing is.
        shown : what is drawn.
        view, size : another camera than that of the surroundings, and the size of its targets in pixels.
        kept : the targets still hold what this view drew last; what would be the same is not drawn again.
        waters : light what is in water as it is there; without, as in air, where no mesh in water is seen by itself.
        """
        size = surroundings.size if size is None else size
        bindings, record = dict(surroundings.bindings), surroundings.frame
        if view is not None:
            record = surroundings.frame_of(view, size)
            bindings["frame"] = self._frame = self._written(self._frame, record.reshape(1), "frame of a view")
        if shown.clip is not None:
            plane = np.array(shown.clip, np.float32)
            bindings["clip_plane"] = self._clip = self._written(self._clip, plane, "clip plane")
        elif shown.hidden is not None:
            corners = np.zeros((2, 4), np.float32)
            corners[:, :3] = np.clip(shown.hidden, -FARTHEST_M, FARTHEST_M)
            bindings["hidden_box"] = self._box = self._written(self._box, corners, "hidden box")
        seen = (*surroundings.state(waters=False), record.tobytes(), shown, size)
        lit = (*surroundings.state(waters), seen, sky)
        if kept and lit == self._lit:
            return
        triangles = self._triangle_target(size)
        if not (kept and seen == self._seen):
            self._visibility(shown, waters=surroundings.submersion.active).run(
                encoder,
                color=[triangles.create_view()],
                depth=depth,
                clear=[CLEAR],
                clear_depth=0.0,
                bindings=bindings,
                ranges=self._ranges(surroundings, record.reshape(())["clip_from_world"].T, shown),
                timer=timer,
                label=f"{label} visibility",
            )
        self._seen, self._lit = seen, lit
        # Where nothing over the surface is shown, what only waves cover may count as water.
        if waters and shown.clip is not None and surroundings.sun_may_be_apart:
            anew = self._shade_apart(encoder, color, depth, surroundings, bindings, seen, kept, timer, label)
        else:
            self._shade(encoder, color, depth, surroundings, bindings, waters, timer, label)
            anew = True
        if sky and anew:
            self.draw_sky(encoder, color, depth, bindings, timer, f"{label} sky")

    def _shade(
        self,
        encoder: Any,
        color: Any,
        depth: Any,
        surroundings: Surroundings,
        bindings: dict[str, Any],
        waters: bool,
        timer: PassTimer | None,
        label: str,
    ) -> None:
        constants = surroundings.shading_constants
        # Both are made at once, so that a camera that dives waits for nothing.
        wet, dry = self._shading(constants), self._shading({**constants, "SUBMERGED": 0.0})
        (wet if waters else dry).run(
            encoder,
            color=[color],
            depth=depth,
            clear=[CLEAR],
            bindings={**bindings, "visible_triangles": self._triangles},
            timer=timer,
            label=f"{label} shading",
        )

    def _shade_apart(
        self,
        encoder: Any,
        color: Any,
        depth: Any,
        surroundings: Surroundings,
        bindings: dict[str, Any],
        seen: tuple[Any, ...],
        kept: bool,
        timer: PassTimer | None,
        label: str,
    ) -> bool:
        """Only light that waves focus is added anew while nothing but waves moves; tells whether more was."""
        rest, sun = self._apart_targets((self._triangles.width, self._triangles.height))
        rested = (seen, surroundings.submersion.settled)
        anew = not kept or rested != self._rested
        if anew:
            options: dict[str, Any] = {"targets": (self.format, APART_FORMAT), "depth_compare": "less"}
            constants = {**surroundings.shading_constants, "SUN_APART": 1.0}
            self._pass("shading_apart", constants, **options).run(
                encoder,
                color=[rest.create_view(), sun.create_view()],
                depth=depth,
                clear=[CLEAR, CLEAR],
                bindings={**bindings, "visible_triangles": self._triangles},
                timer=timer,
                label=f"{label} shading",
            )
            self._rested = rested
        self._pass("sunlit", surroundings.shading_constants, vertex="vs_sunlit", depth_compare="less").run(
            encoder,
            color=[color],
            depth=depth,
            clear=[CLEAR] if anew else None,
            bindings={**bindings, "shaded_rest": rest, "shaded_sun": sun},
            timer=timer,
            label=f"{label} sun",
        )
        return anew

    def _apart_targets(self, size: tuple[int, int]) -> tuple[Any, Any]:
        """Radiance but for that of the sun through the water, and that for a sun that nothing takes from."""
        if self._apart is None or (self._apart[0].width, self._apart[0].height) != size:
            usage = ("sample", "render")
            rest, sun = (
                self.device.texture(size=size, format=format, usage=usage, label="shaded apart")
                for format in (self.format, APART_FORMAT)
            )
            self._apart, self._rested = (rest, sun), ()
        return self._apart

    def draw_sky(
        self,
        encoder: Any,
        color: Any,
        depth: Any,
        bindings: dict[str, Any],
        timer: PassTimer | None = None,
        label: str = "sky",
    ) -> None:
        """Draw the environment where `depth` is 0; keeps the rest of `color` and all of `depth`."""
        # At depth 0, which is where the triangle that covers the picture lies, this holds where nothing was drawn.
        sky = self._pass("sky", {}, depth_compare="greater-equal")
        sky.run(encoder, color=[color], depth=depth, bindings=bindings, timer=timer, label=label)

    def _ranges(self, surroundings: Surroundings, clip_from_world: np.ndarray, shown: Shown) -> list[tuple[int, int]]:
        geometry, parts = self._clusters
        if parts is None or geometry is not surroundings.geometry:
            parts = clusters(surroundings.geometry)
            self._clusters = surroundings.geometry, parts
        plane = None if shown.clip is None else np.array(shown.clip)
        ranges = visible_ranges(parts, clip_from_world, plane, shown.hidden)
        return [(3 * a, 3 * n) for a, n in ranges]

    def _visibility(self, shown: Shown, waters: bool) -> RenderPass:
        options: dict[str, Any] = {"targets": ("r32uint",), "depth_compare": "greater", "depth_write": True}
        if shown.clip is not None:
            return self._pass("visibility_clipped", shown.constants, **options)
        # Where there is water both are made at once, so that a camera that dives waits for nothing.
        names = ("visibility", "visibility_hidden") if waters else ("visibility",)
        made = {name: self._pass(name, shown.constants, **options) for name in names}
        if shown.hidden is None:
            return made["visibility"]
        return made.get("visibility_hidden") or self._pass("visibility_hidden", shown.constants, **options)

    def _shading(self, constants: dict[str, float]) -> RenderPass:
        # Against depth 0: only where something was drawn.
        return self._pass("shading", constants, depth_compare="less")

    def _pass(self, module: str, constants: dict[str, float], **options: Any) -> RenderPass:
        """A pipeline; all views of a device share it, for a software driver compiles a shader for seconds."""
        options = {"targets": (self.format,), "depth": DEPTH_FORMAT, "depth_write": False, **options}
        return self._pipelines.draw(f"{SHADERS}/{module}", constants, **options)

    def _written(self, buffer: Any, record: np.ndarray, label: str) -> Any:
        buffer = buffer or self.device.buffer(record.nbytes, "uniform", label)
        self.device.write(buffer, record)
        return buffer

    def _triangle_target(self, size: tuple[int, int]) -> Any:
        if self._triangles is None or (self._triangles.width, self._triangles.height) != size:
            self._triangles = self.device.texture(
                size=size, format="r32uint", usage=("sample", "render"), label="visible triangles"
            )
        return self._triangles
