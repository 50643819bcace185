"""Opaque meshes: shadow maps from the lights' side, then colour and depth from the camera's."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu.kernel import RenderPass
from pellucid.gpu.targets import DEPTH_FORMAT, Targets
from pellucid.surroundings.views import Box, SceneView, Shown

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.gpu.timing import PassTimer
    from pellucid.surroundings import Surroundings


class Opaque:
    """Draws the opaque meshes of the surroundings.

    Parameters
    ----------
    device : where to draw.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self._shadow = RenderPass(
            device,
            "techniques/opaque/shaders/shadow_depth",
            fragment=None,
            targets=(),
            depth=DEPTH_FORMAT,
            depth_compare="less",
        )
        self._view = SceneView(device)
        self._shadow_lights: list[Any] = []
        self._drawn: tuple[Surroundings, int] | None = None
        self._wanted: tuple[Any, ...] = ()
        self._kept: Targets | None = None
        self._is_kept = False

    def prepare(self, surroundings: Surroundings) -> None:
        """Upload which light each shadow map belongs to."""
        layers = surroundings.shadow_lights
        while len(self._shadow_lights) < len(layers):
            self._shadow_lights.append(self.device.buffer(16, "uniform", "shadow light"))
        for layer, light in enumerate(layers):
            self.device.write(self._shadow_lights[layer], np.array([light, layer, 0, 0], np.uint32))

    def illuminate(self, encoder: Any, surroundings: Surroundings, timer: PassTimer | None = None) -> bool:
        """Encode the shadow maps, if a mesh or a light changed since they were drawn; tells whether it did."""
        state = (surroundings, surroundings.shadow_version)
        if self._drawn == state:
            return False
        self.prepare(surroundings)
        for layer, view in enumerate(surroundings.shadow_views):
            self._shadow.run(
                encoder,
                depth=view,
                clear_depth=1.0,
                bindings={**surroundings.bindings, "shadow_light": self._shadow_lights[layer]},
                vertices=3 * surroundings.triangle_count,
                timer=timer,
                label="shadow",
            )
        self._drawn = state
        return True

    def draw(
        self,
        encoder: Any,
        color: Any,
        depth: Any,
        surroundings: Surroundings,
        timer: PassTimer | None = None,
        hidden: Box | None = None,
        sky: Any = None,
    ) -> None:
        """Clear both targets and draw every mesh; a picture that is wanted for the second time running is kept.

        Parameters
        ----------
        color : rgba32float texture of the surroundings' size, receives linear radiance; 0 where nothing is.
        depth : depth32float texture, receives reversed depth; 0 where nothing is.
        hidden : nothing within this box is drawn, for another technique covers it from all sides.
        sky : draws into the same targets what is behind the meshes, and is kept with them.
        """
        shown = Shown(hidden=hidden)
        in_water = not surroundings.submersion.is_above(surroundings.view.position)
        wanted = (*surroundings.state(in_water), surroundings.frame.tobytes(), shown)
        again, self._wanted = wanted == self._wanted, wanted
        self._kept = (self._kept or Targets(self.device, surroundings.size)) if again else None
        given = (self._kept.color, self._kept.depth) if self._kept else (color, depth)
        if not (again and self._is_kept):
            views = given[0].create_view(), given[1].create_view()
            self._view.draw(encoder, *views, surroundings, shown, timer=timer, waters=in_water)
            if sky is not None:
                sky.draw(encoder, *views, surroundings, timer)
        self._is_kept = again
        if again:
            for source, target in zip(given, (color, depth), strict=True):
                encoder.copy_texture_to_texture({"texture": source}, {"texture": target}, (*surroundings.size, 1))
