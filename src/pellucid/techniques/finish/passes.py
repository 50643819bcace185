"""From linear radiance to the numbers that a screen is sent."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.errors import SceneError
from pellucid.gpu.kernel import RenderPass
from pellucid.gpu.layout import struct

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.gpu.timing import PassTimer

TONE_MAPPINGS = ("linear", "reinhard", "aces", "agx", "khronos")

FinishParams = struct([("exposure", "f32"), ("tone_mapping", "u32")])


class Finish:
    """Exposure, tone mapping and sRGB encoding in one pass.

    Parameters
    ----------
    device : where to draw.
    target_format : "rgba8unorm" for pictures, or the format of a window ("bgra8unorm").
    """

    def __init__(self, device: Device, target_format: str = "rgba8unorm") -> None:
        self.device = device
        self._params = device.buffer(FinishParams.itemsize, "uniform", "finish")
        self._pass = RenderPass(
            device, "techniques/finish/shaders/finish", targets=(target_format,), nearest=("radiance",)
        )

    def prepare(self, exposure: float = 1.0, tone_mapping: str = "agx") -> None:
        """Upload the settings; nothing is compiled anew.

        Parameters
        ----------
        exposure : factor on radiance. tone_mapping : one of `TONE_MAPPINGS`.

        Raises
        ------
        SceneError : an unknown tone mapping.
        """
        if tone_mapping not in TONE_MAPPINGS:
            raise SceneError("scene.tone_mapping", f"'{tone_mapping}' is not one of {', '.join(TONE_MAPPINGS)}")
        record = np.zeros(1, FinishParams)
        record["exposure"], record["tone_mapping"] = exposure, TONE_MAPPINGS.index(tone_mapping)
        self.device.write(self._params, record)

    def draw(self, encoder: Any, radiance: Any, target: Any, timer: PassTimer | None = None) -> None:
        """Encode the pass.

        Parameters
        ----------
        radiance : texture or view, linear Rec.709, any float format.
        target : view of the same size; receives sRGB values, row 0 at the top, alpha 1.
        """
        self._pass.run(
            encoder,
            color=[target],
            clear=[(0.0, 0.0, 0.0, 1.0)],
            bindings={"finish_params": self._params, "radiance": radiance},
            timer=timer,
            label="finish",
        )
