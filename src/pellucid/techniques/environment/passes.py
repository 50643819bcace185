"""The environment where the picture shows nothing nearer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pellucid.surroundings.views import SceneView

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.gpu.timing import PassTimer
    from pellucid.surroundings import Surroundings


class Sky:
    """Fills the background.

    Parameters
    ----------
    device : where to draw.
    """

    def __init__(self, device: Device) -> None:
        self._view = SceneView(device)

    def prepare(self, surroundings: Surroundings) -> None:
        """Nothing of its own: the environment belongs to the surroundings, which every ray shares."""

    def draw(
        self,
        encoder: Any,
        color: Any,
        depth: Any,
        surroundings: Surroundings,
        timer: PassTimer | None = None,
    ) -> None:
        """Draw where `depth` is 0; keeps the rest of `color` (rgba32float) and all of `depth`."""
        self._view.draw_sky(encoder, color, depth, surroundings.bindings, timer)
