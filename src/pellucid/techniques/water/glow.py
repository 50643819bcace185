"""Glow around lamps that water mirrors, as the thesis has it: few pixels, a power of the cosine, a filter of 13 texels.

`Scene.glow` scatters all bright light of a picture as a lens does, and keeps its sum. This adds light to water alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu import Pipelines
from pellucid.gpu.targets import COLOR_FORMAT, Targets

if TYPE_CHECKING:
    from pellucid.gpu import Device

FORMAT = "rgba16float"
SHADERS = "techniques/water/shaders"
SCALE = 4  # pixels of the picture to one of the highlight


class WaterGlow:
    """Three passes [mihalik2008, 9.3].

    Parameters
    ----------
    device : where to draw.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self._pipelines = Pipelines(device, ("water_hits", "before"))
        self._spread = self._pipelines.draw(f"{SHADERS}/glow_spread", targets=(FORMAT,))
        self._add = self._pipelines.draw(f"{SHADERS}/glow_add", targets=(COLOR_FORMAT,))
        self._strength = device.buffer(16, "uniform", "glow strength")
        self._size = (0, 0)
        self._small: list[Any] = []
        self._before: Any = None

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held."""
        return 16 + self._size[0] * self._size[1] * 16 + sum(8 * t.width * t.height for t in self._small)

    def draw(
        self,
        encoder: Any,
        targets: Targets,
        bindings: dict[str, Any],
        constants: Mapping[str, float],
        strength: float,
        timer: Any = None,
    ) -> None:
        """Add the glow to the colour of a picture.

        Parameters
        ----------
        bindings : of the body of water and of the surroundings, with `water_hits` as the search left it.
        constants : of the surroundings' shading; they tell which kinds of lamps there are.
        strength : of the highlight before it is spread; 1 for as bright as white paper that faces the lamp.
        """
        self._use_size(targets.size)
        self.device.write(self._strength, np.array([strength, 0.0, 0.0, 0.0], np.float32))
        size = (*targets.size, 1)
        encoder.copy_texture_to_texture({"texture": targets.color}, {"texture": self._before}, size)
        sharp, wide = self._small
        highlight = self._pipelines.draw(f"{SHADERS}/glow_highlight", constants, targets=(FORMAT,))
        steps = (
            (highlight, sharp.create_view(), bindings),
            (self._spread, wide.create_view(), {"highlight": sharp}),
            (
                self._add,
                targets.color_view,
                {
                    "before": self._before,
                    "glow_map": wide,
                    "glow_sampler": self.device.sampler("linear", "clamp"),
                    "glow_strength": self._strength,
                },
            ),
        )
        for step, target, bound in steps:
            step.run(encoder, [target], clear=[(0.0, 0.0, 0.0, 0.0)], bindings=bound, timer=timer, label="water glow")

    def _use_size(self, size: tuple[int, int]) -> None:
        if size == self._size:
            return
        self._size = size
        small = (-(-size[0] // SCALE), -(-size[1] // SCALE))
        usage = ("sample", "render")
        self._small = [
            self.device.texture(size=small, format=FORMAT, usage=usage, label=name) for name in ("highlight", "glow")
        ]
        self._before = self.device.texture(size=size, format=COLOR_FORMAT, usage=("sample",), label="before the glow")
