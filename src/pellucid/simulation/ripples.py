"""The wave equation of `fields.waves` on the GPU."""

from __future__ import annotations

from typing import Any

import numpy as np

from pellucid.fields.waves import Disturbance, Ripples
from pellucid.gpu import ComputeKernel, Device, Pipelines
from pellucid.simulation.layouts import RippleDent, RippleParams, RipplePush

#: Cells of a workgroup, in a row: neighbours in memory are three times as fast as squares on the software driver.
ROW = 64
#: Cells of a column that one invocation follows: RIPPLE_STRIP of shaders/ripple_bindings.wgsl.
STRIP = 8


class RippleSimulation:
    """Twin of `Ripples`: the same steps, the same drops, in float32 on the device.

    Parameters
    ----------
    device : where it runs.
    ripples : what is simulated. Drops that fall into it later reach the device too; of its own state only the time is
        written.

    Attributes
    ----------
    heights : r32float texture (W, H), metres, row 0 at the top; what `advance` has written last.
    """

    def __init__(self, device: Device, ripples: Ripples) -> None:
        self.device, self.ripples = device, ripples
        rows, columns = ripples.shape
        self.heights = device.texture(
            size=(columns, rows), format="r32float", usage=("sample", "storage"), label="ripple heights"
        )
        cells = 4 * rows * columns
        self._states = [device.buffer(cells, label="ripple displacement") for _ in range(2)]
        self._velocity = device.buffer(cells, label="ripple velocity")
        self._friction = device.buffer(ripples.friction.astype(np.float32), label="ripple friction")
        self._params = device.buffer(RippleParams.itemsize, "uniform", "ripple parameters")
        self._pressed: Any = None  # made for the first thing that floats
        self._step, self._show, self._dent = (_kernel(device, name) for name in ("step", "show", "dent"))
        self._groups = (-(-columns // ROW), -(-rows // STRIP), 1)
        self._cells = (-(-columns // ROW), rows, 1)
        self._applied: list[Disturbance] = []
        self._done = 0
        self._params_now = self._constant_params()

    def advance(self, time_s: float, encoder: Any = None) -> Any:
        """Go to a time and write `heights`, which is given back.

        Parameters
        ----------
        time_s : seconds from the start; a time before the last one starts again.
        encoder : takes the work if given; it is to be submitted before the next call. Else it is submitted at once.

        Raises
        ------
        SceneError : the time is negative or not finite, or takes too many steps.
        """
        plan = self.ripples.schedule(time_s, self._done, self._applied)
        own = encoder is None
        encoder = self.device.wgpu.create_command_encoder() if own else encoder
        self._params_now["rest_s"] = plan.rest_s
        self.device.write(self._params, self._params_now)
        if plan.restart:
            for buffer in (self._states[0], self._velocity):
                encoder.clear_buffer(buffer)
            self._done, self._applied = 0, []
        for state, disturbance in plan.dents:
            self._steps_to(state, encoder)
            self._dent_by(disturbance, encoder)
        self._steps_to(plan.last, encoder)
        self._show.run(self._groups, self._bindings(self._press(encoder), heights=self.heights), encoder)
        self.ripples.time_s = float(time_s)  # what falls in without a time does so now
        if own:
            self.device.wgpu.queue.submit([encoder.finish()])
        return self.heights

    def _steps_to(self, state: int, encoder: Any) -> None:
        for _ in range(state - self._done):
            bound = self._bindings(self._press(encoder), following=self._states[1])
            self._step.run(self._groups, bound, encoder)
            self._states.reverse()
            self._done += 1

    def _press(self, encoder: Any) -> Any:
        """The displacement, with what floats on it on top."""
        pressing = self.ripples.pressing(self._done)
        if not pressing:
            return self._states[0]
        if self._pressed is None:
            self._pressed = self.device.buffer(self._states[0].size, label="ripple displacement, pressed")
        encoder.copy_buffer_to_buffer(self._states[0], 0, self._pressed, 0, self._states[0].size)
        for push, x_m, z_m, depth_m in pressing:
            given = np.zeros((), RipplePush)
            rows, columns = self.ripples.reached(push, x_m, z_m)
            if not (len(rows) and len(columns)):
                continue
            size, outside = np.array(self.ripples.shape[::-1]), np.array([columns[0], rows[0]])
            first = outside % size  # whole turns further in a periodic pool, its centre too
            given["centre_m"] = np.array([x_m, z_m]) + (first - outside) * self.ripples.cell_m
            given["size"], given["first"], given["count"] = size, first, (len(columns), len(rows))
            given["cell_m"], given["radius_m"], given["depth_m"] = self.ripples.cell_m, push.radius_m, depth_m
            bound = {"push": self.device.buffer(given, "uniform", "ripple push"), "pressed": self._pressed}
            kernel = _kernel(self.device, "push")
            kernel.run((-(-len(columns) // ROW), len(rows), 1), bound, encoder)
        return self._pressed

    def _dent_by(self, disturbance: Disturbance, encoder: Any) -> None:
        dent = np.zeros((), RippleDent)
        dent["centre_m"] = disturbance.x_m, disturbance.z_m
        dent["size"] = self.ripples.shape[::-1]
        dent["cell_m"], dent["radius_m"] = self.ripples.cell_m, disturbance.radius_m
        dent["strength_m"], dent["balance"] = disturbance.strength_m, self.ripples.balance(disturbance)
        dent["periodic"] = self.ripples.boundary == "periodic"
        # A buffer of its own for each: those of one submission are all written before it begins.
        given = {"dent": self.device.buffer(dent, "uniform", "ripple dent"), "displacement": self._states[0]}
        self._dent.run(self._cells, given, encoder)
        self._applied.append(disturbance)

    def _bindings(self, pressed: Any, **more: Any) -> dict[str, Any]:
        return {
            "ripples": self._params, "displacement": self._states[0], "velocity": self._velocity,
            "friction": self._friction, "pressed": pressed, **more,
        }  # fmt: skip

    def _constant_params(self) -> np.ndarray:
        ripples, params = self.ripples, np.zeros((), RippleParams)
        weights = ripples.stencil()
        params["size"] = ripples.shape[::-1]
        params["periodic"] = ripples.boundary == "periodic"
        params["step_s"], params["level_m"], params["limit_m"] = ripples.step_s, ripples.level_m, ripples.limit_m
        params["near"] = weights[2, 2], weights[2, 3], weights[3, 3], weights[2, 4]
        params["far"] = weights[3, 4], weights[4, 4]
        return params


def _kernel(device: Device, name: str) -> ComputeKernel:
    return Pipelines(device, shared=True).kernel(f"simulation/shaders/ripple_{name}")
