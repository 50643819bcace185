"""From linear radiance to the numbers that a screen is sent."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.errors import SceneError
from pellucid.gpu.kernel import RenderPass
from pellucid.gpu.layout import struct
from pellucid.techniques.finish.glow import Glow

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.gpu.timing import PassTimer

TONE_MAPPINGS = ("linear", "reinhard", "aces", "agx", "khronos")

FinishParams = struct([("exposure", "f32"), ("glow", "f32")])


class Finish:
    """Glow if wanted, then exposure, tone mapping and sRGB encoding in one pass.

    Parameters
    ----------
    device : where to draw.
    target_format : "rgba8unorm" for pictures, or the format of a window ("bgra8unorm").
    """

    def __init__(self, device: Device, target_format: str = "rgba8unorm") -> None:
        self.device = device
        self._params = device.buffer(FinishParams.itemsize, "uniform", "finish")
        self._glow = Glow(device)
        self._no_glow = device.texture(size=(1, 1), format="rgba16float", usage=("sample",), label="no glow")
        self._share = 0.0
        # All at once, so that no choice compiles anything; in one shader each pixel would pay for every curve.
        self._passes = {
            (tone, glow): RenderPass(
                device,
                "techniques/finish/shaders/finish",
                targets=(target_format,),
                constants={"FINISH_TONE": float(index), "FINISH_GLOW": float(glow)},
                nearest=("radiance",),
            )
            for index, tone in enumerate(TONE_MAPPINGS)
            for glow in (False, True)
        }
        self._tone = TONE_MAPPINGS[0]

    def prepare(self, exposure: float = 1.0, tone_mapping: str = "agx", glow: float = 0.0) -> None:
        """Upload the settings; nothing is compiled anew.

        Parameters
        ----------
        exposure : factor on radiance. tone_mapping : one of `TONE_MAPPINGS`.
        glow : share of the light that is scattered, 0 to 1; 0.02 to 0.1 look like a lens.

        Raises
        ------
        SceneError : an unknown tone mapping, a glow out of range.
        """
        if not 0.0 <= glow <= 1.0:
            raise SceneError("glow", f"is {glow}", "use a share from 0 to 1")
        if tone_mapping not in TONE_MAPPINGS:
            raise SceneError("scene.tone_mapping", f"'{tone_mapping}' is not one of {', '.join(TONE_MAPPINGS)}")
        record = np.zeros(1, FinishParams)
        self._tone, self._share = tone_mapping, glow
        record["exposure"], record["glow"] = exposure, glow
        self.device.write(self._params, record)

    def draw(self, encoder: Any, radiance: Any, target: Any, timer: PassTimer | None = None) -> None:
        """Encode the pass.

        Parameters
        ----------
        radiance : texture, linear Rec.709, any float format; without glow a view will do.
        target : view of the same size; receives sRGB values, row 0 at the top, alpha 1.
        """
        glows = self._share > 0.0
        blurred = self._glow.draw(encoder, radiance, timer) if glows else self._no_glow
        self._passes[self._tone, glows].run(
            encoder,
            color=[target],
            clear=[(0.0, 0.0, 0.0, 1.0)],
            bindings={
                "finish_params": self._params,
                "radiance": radiance,
                "blurred": blurred,
                "blurred_sampler": self.device.sampler("linear", "clamp"),
            },
            timer=timer,
            label="finish",
        )
