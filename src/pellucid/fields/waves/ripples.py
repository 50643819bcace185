"""Ripples: the wave equation on a rectangle of water, u_tt + 2 d u_t = c^2 (u_xx + u_zz) [landau1987, 12]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.numbers import number
from pellucid.fields.waves import arguments
from pellucid.fields.waves.disturbances import Disturbance, Push, places_of
from pellucid.fields.waves.source import WaveSource, WaveSurface, difference_slopes

BOUNDARIES = ("reflect", "periodic", "absorb")
#: c dt / h of the steps that are taken. The scheme is stable below 0.8 (see `Ripples`).
COURANT = 0.5
#: Width of the zone that absorbs, as a share of the shorter side.
ABSORBING_SHARE = 0.15
#: Beyond so many radii a push is nothing: exp(-16) of its strength.
REACH = 4.0
MOST_STEPS = 1_000_000

Array = npt.NDArray[Any]


@dataclass(frozen=True)
class Plan:
    """How to get to a time.

    restart : from water at rest. dents : (state at which it comes, what comes), in order. last : number of the last
    state. rest_s : time that is left after it, less than a step.
    """

    restart: bool
    dents: tuple[tuple[int, Disturbance], ...]
    last: int
    rest_s: float


class Ripples(WaveSource):
    """Small waves that all travel at one speed, as on shallow water, on a grid of square cells.

    **Scheme.** Velocities w live half a step between displacements u: w += dt (c^2 L' u - 2 d w), u += dt w. With the
    isotropic nine-point Laplacian L (error h^2/12 of the squared Laplacian) and the error of the leapfrog in time
    (c^2 dt^2/12 of the same, of the other sign), L' = L - (h^2 - c^2 dt^2)/12 L L has neither: the phase speed errs in
    fourth order [shubin1987]. It is stable up to c dt / h = 0.8; steps of `COURANT` are taken whatever is asked for.

    L' is symmetric and its columns add up to 0, also at a border. So mass, the sum of u, is kept, and so is the energy
    1/2 <w, w> - c^2/2 <u, L' u'> of neighbouring steps without damping, and falls with it.

    x and z are metres from the centre of the rectangle, x along u, z downwards in the map: those of `Mesh.plane`.

    Parameters
    ----------
    shape : (H, W) cells.
    cell_m : edge of a cell, metres.
    speed_m_s : of the waves; sqrt(9.81 depth) for water much shallower than the waves are long.
    damping : 1/s; waves fade as exp(-damping t).
    boundary : ``"reflect"``, ``"periodic"`` or ``"absorb"`` (waves fade in a zone along the border, which does not keep
        the mass).
    level_m : height of the water at rest, metres.
    limit_m : heights that are given back are cut off so far above and below the level; the waves are not.
    dtype : float32, as on the GPU, or float64.

    Raises
    ------
    SceneError
        A parameter is out of its range.
    """

    kind: ClassVar[str] = "ripples"

    def __init__(
        self,
        shape: tuple[int, int],
        cell_m: float,
        speed_m_s: float = 0.3,
        damping: float = 0.4,
        boundary: str = "reflect",
        level_m: float = 0.0,
        limit_m: float = 0.02,
        dtype: Any = np.float32,
    ) -> None:
        self.shape = arguments.grid(shape)
        self.cell_m = number("cell_m", cell_m, low=1e-9)
        self.speed_m_s = number("speed_m_s", speed_m_s, low=1e-9)
        self.damping = number("damping", damping, low=0.0)
        if np.dtype(dtype) not in (np.dtype(np.float32), np.dtype(np.float64)):
            raise SceneError("dtype", f"is {dtype!r}", "use float32 or float64")
        self.boundary = arguments.choice("boundary", boundary, BOUNDARIES)
        self.periodic = boundary == "periodic"
        self.level_m = number("level_m", level_m)
        self.limit_m = number("limit_m", limit_m, low=1e-9)
        self.dtype = np.dtype(dtype)
        self.step_s = COURANT * self.cell_m / self.speed_m_s
        self.friction = (self.damping + _absorption(self)).astype(self.dtype)
        drag = (self.friction * self.step_s).astype(self.dtype)
        self._keep, self._gain = (1 - drag) / (1 + drag), self.dtype.type(self.step_s) / (1 + drag)
        self.time_s = 0.0
        self.disturbances: list[Disturbance] = []
        self.pushes: list[Push] = []
        self.displacement: Array = np.zeros(self.shape, self.dtype)
        self.velocity: Array = np.zeros(self.shape, self.dtype)
        self.steps_done = 0
        self.applied: list[Disturbance] = []

    # ---- what a relief or water asks for ---------------------------------------------------------------------

    @property
    def tile_m(self) -> tuple[float, float]:
        """Size along u and v, metres."""
        return self.shape[1] * self.cell_m, self.shape[0] * self.cell_m

    @property
    def limits_m(self) -> tuple[float, float]:
        """Lowest and highest height that is given back, metres."""
        return self.level_m - self.limit_m, self.level_m + self.limit_m

    def advance(self, time_s: float) -> npt.NDArray[np.float32]:
        """Go to a time and give the heights there, (H, W) float32 metres.

        Whole steps are taken up to that time, and what is given back is a part of one step further. For a time before
        the last one everything is done again from the start.

        Raises
        ------
        SceneError : the time is negative or not finite, or so late that it takes more than `MOST_STEPS` steps.
        """
        plan = self.schedule(time_s, self.steps_done, self.applied)
        if plan.restart:
            self._restart()
        for state, disturbance in plan.dents:
            self._steps_to(state)
            self.displacement = self.displacement + self.dent(disturbance).astype(self.dtype)
            self.applied.append(disturbance)
        self._steps_to(plan.last)
        self.time_s = float(time_s)
        heights = self.level_m + self._part(plan.rest_s)
        return np.clip(heights, *self.limits_m).astype(np.float32)

    def _surface(self, time_s: float) -> WaveSurface:
        heights = self.advance(time_s)
        return WaveSurface(heights, difference_slopes(heights, self.cell, self.periodic))

    def moment(self, time_s: float) -> Any:
        """What the waves of a time hang on: equal to an earlier one as long as they are the same."""
        return time_s, len(self.disturbances), len(self.pushes)

    def _key(self, time_s: float) -> Any:
        return self.moment(time_s)

    def step(self, dt: float) -> npt.NDArray[np.float32]:
        """Go on by `dt` seconds, of any length, and give the heights."""
        return self.advance(self.time_s + number("dt", dt, low=0.0))

    def drop(
        self, x_m: float, z_m: float, radius_m: float, strength_m: float, time_s: float | None = None
    ) -> Disturbance:
        """Something falls into the water: a dent and a rim around it that holds what was pressed out.

        Parameters
        ----------
        x_m, z_m : where, metres from the centre.
        radius_m : of the dent, metres, at least a cell.
        strength_m : depth of the dent, metres; negative for a hump.
        time_s : when; now if not given. It may lie in the future.

        Raises
        ------
        SceneError : it is outside of the water, smaller than a cell, or before now.
        """
        width, depth = self.tile_m
        x = number("x_m", x_m, low=-0.5 * width, high=0.5 * width)
        z = number("z_m", z_m, low=-0.5 * depth, high=0.5 * depth)
        radius = number("radius_m", radius_m, low=self.cell_m)
        when = self.time_s if time_s is None else number("time_s", time_s, low=self.time_s)
        dropped = Disturbance(when, x, z, radius, number("strength_m", strength_m))
        self.disturbances.append(dropped)
        self.disturbances.sort(key=lambda d: d.time_s)
        return dropped

    def push(
        self,
        path_m: npt.ArrayLike,
        radius_m: float,
        strength_m: float,
        speed_m_s: float | None = None,
        time_s: float | None = None,
        times_s: npt.ArrayLike | None = None,
    ) -> Push:
        """Something floats along a path, a boat or a ball: it presses on the water, u_tt = c^2 lap(u + q).

        q = strength exp(-(distance / radius)^2) is what it weighs, over density and gravity. At rest it lies in a dent
        of that depth; under way it draws waves behind it, and a wedge of half angle arcsin(c / v) when it is faster
        than they are. The Laplacian keeps the mass.

        Parameters
        ----------
        path_m : (N, 2) places (x, z), metres from the middle; N >= 2, or one place with two `times_s`.
        radius_m : metres, at least a cell. strength_m : depth of the dent at rest, metres.
        speed_m_s : along the path, that of the waves if not given. time_s : when it starts; now if not given.
        times_s : (N,) when it is where, rising, in place of both.

        Raises
        ------
        SceneError : a path of another shape, a time before now, times that do not rise, a radius below a cell.
        """
        radius, strength = number("radius_m", radius_m, low=self.cell_m), number("strength_m", strength_m)
        path = places_of(path_m)
        if times_s is None:
            speed = self.speed_m_s if speed_m_s is None else number("speed_m_s", speed_m_s, low=1e-9)
            start = self.time_s if time_s is None else number("time_s", time_s, low=self.time_s)
            ways = np.hypot(*np.diff(path, axis=0).T)
            if not len(ways) or not ways.min() > 0.0:
                raise SceneError("path_m", "stands still", "give places apart from each other, or times_s")
            times = start + np.concatenate([[0.0], np.cumsum(ways)]) / speed
        else:
            if speed_m_s is not None or time_s is not None:
                raise SceneError("times_s", "are given with speed_m_s or time_s", "choose one of them")
            times = arguments.numbers("times_s", times_s, low=self.time_s)
            path = np.repeat(path, 2, axis=0) if len(path) == 1 and len(times) == 2 else path
            if len(times) != len(path) or not (np.diff(times) > 0.0).all():
                raise SceneError("times_s", f"are {len(times)} for {len(path)} places", "give one a place, rising")
        # It sinks in while a wave crosses it, so that it begins without a splash.
        ease = min(2.0 * radius / self.speed_m_s, 0.5 * float(times[-1] - times[0]))
        places = tuple((float(x), float(z)) for x, z in path)
        pushed = Push(tuple(float(t) for t in times), places, radius, strength, ease)
        self.pushes.append(pushed)
        return pushed

    # ---- what the GPU does likewise --------------------------------------------------------------------------

    def schedule(self, time_s: float, done: int, applied: Sequence[Disturbance]) -> Plan:
        """What leads to a time, from a state that `done` steps and the dents `applied` have led to.

        Raises
        ------
        SceneError : the time is negative or not finite, or takes too many steps.
        """
        time_s = number("time_s", time_s, low=0.0)
        last = int(self._states(time_s))
        if last > MOST_STEPS:
            raise SceneError("time_s", f"is {time_s:g}", f"takes more than {MOST_STEPS} steps of {self.step_s:g} s")
        due = [(int(np.ceil(self._states(d.time_s))), d) for d in self.disturbances]
        known = self.disturbances[: len(applied)] == list(applied)
        restart = last < done or not known or any(state < done for state, _ in due[len(applied) :])
        rest = max(0.0, time_s - last * self.step_s)
        ahead = due if restart else due[len(applied) :]
        return Plan(restart, tuple(pair for pair in ahead if pair[0] <= last), last, rest)

    def dent(self, disturbance: Disturbance) -> Array:
        """(H, W) float64 displacement of a drop, metres: -strength (k - s) exp(-s), s = (distance / radius)^2.

        k, near 1, makes the sum zero: no water comes or goes.
        """
        s = self._distance2(disturbance)
        return np.asarray(-disturbance.strength_m * (self.balance(disturbance) - s) * np.exp(-s))

    def balance(self, disturbance: Disturbance) -> float:
        """k of `dent`."""
        s = self._distance2(disturbance)
        bell = np.exp(-s)
        return float((s * bell).sum() / bell.sum())

    def _distance2(self, disturbance: Disturbance) -> Array:
        """(H, W) squared distance in radii."""
        x, z = self.centres()
        x, z = x - disturbance.x_m, z - disturbance.z_m
        if self.periodic:
            width, depth = self.tile_m
            x, z = x - width * np.round(x / width), z - depth * np.round(z / depth)
        return np.asarray((z[:, None] ** 2 + x**2) / disturbance.radius_m**2)

    def pressing(self, state: int) -> list[tuple[Push, float, float, float]]:
        """What presses at a state: pushes with their x, z and depth of dent, metres."""
        time_s = state * self.step_s
        found = [(push, *push.at(time_s)) for push in self.pushes if push.times_s[0] < time_s < push.times_s[-1]]
        return [one for one in found if one[3] != 0.0]

    def reached(self, push: Push, x_m: float, z_m: float) -> tuple[range, range]:
        """Rows and columns within `REACH` radii of a push at a place; they may lie outside, to be repeated."""
        lines = []
        for count, at, size in zip(self.shape, (z_m, x_m), reversed(self.tile_m), strict=True):
            middle, far = (at / size + 0.5) * count - 0.5, REACH * push.radius_m / self.cell_m
            first, last = int(np.ceil(middle - far)), int(np.floor(middle + far))
            if self.periodic:  # once around at most
                lines.append(range(first, min(last + 1, first + count)))
            else:
                lines.append(range(max(first, 0), min(last + 1, count)))
        return lines[0], lines[1]

    def stencil(self) -> npt.NDArray[np.float64]:
        """(5, 5) weights of c^2 L', 1/s^2."""
        nine = np.array([[1.0, 4.0, 1.0], [4.0, -20.0, 4.0], [1.0, 4.0, 1.0]]) / (6.0 * self.cell_m**2)
        wide = np.zeros((5, 5))
        twice = np.zeros((5, 5))
        wide[1:4, 1:4] = nine
        for j in range(3):
            for i in range(3):
                twice[j : j + 3, i : i + 3] += nine[j, i] * nine
        return np.asarray(self.speed_m_s**2 * (wide - self._correction() * twice))

    # ---- state -----------------------------------------------------------------------------------------------

    @property
    def energy(self) -> float:
        """1/2 of the integral of u_t^2 + c^2 |grad u|^2, m^4/s^2: energy over density and depth, times c^2."""
        u, w = self.displacement.astype(np.float64), self.velocity.astype(np.float64)
        potential = -float(((u - self.step_s * w) * self._acceleration(u)).sum())
        return 0.5 * (float((w * w).sum()) + potential) * self.cell_m**2

    @property
    def volume_m3(self) -> float:
        """Volume over the level, cubic metres: zero but for rounding, as drops displace no more than they raise."""
        return float(self.displacement.sum(dtype=np.float64)) * self.cell_m**2

    def _restart(self) -> None:
        self.displacement = np.zeros(self.shape, self.dtype)
        self.velocity = np.zeros(self.shape, self.dtype)
        self.steps_done = 0
        self.applied = []

    def _states(self, time_s: float) -> float:
        """A time in steps; a whole number but for its rounding is one."""
        steps = time_s / self.step_s
        return float(np.round(steps)) if abs(steps - np.round(steps)) < 1e-6 else steps

    def _correction(self) -> float:
        return (self.cell_m**2 - (self.speed_m_s * self.step_s) ** 2) / 12.0

    def _laplacian(self, u: Array) -> Array:
        p = np.pad(u, 1, mode="wrap" if self.periodic else "symmetric")
        near, here = p[:-2] + p[2:], p[1:-1]
        across = near + 4.0 * here
        out = across[:, :-2] + across[:, 2:]
        near *= 4.0
        out += near[:, 1:-1]
        out -= 20.0 * u
        out *= 1.0 / (6.0 * self.cell_m**2)
        return np.asarray(out)

    def _acceleration(self, u: Array) -> Array:
        out = self._laplacian(u)
        twice = self._laplacian(out)
        twice *= self._correction()
        out -= twice
        out *= self.speed_m_s**2
        return out

    def _pressed(self) -> Array:
        """Displacement, and on top of it what presses at the last state."""
        pressing = self.pressing(self.steps_done)
        if not pressing:
            return self.displacement
        total = self.displacement.copy()
        for push, x_m, z_m, depth_m in pressing:
            rows, columns = (np.array(line, np.intp) for line in self.reached(push, x_m, z_m))
            (width, depth), (count_z, count_x) = self.tile_m, self.shape
            s_x = (((columns + 0.5) / count_x - 0.5) * width - x_m) / push.radius_m
            s_z = (((rows + 0.5) / count_z - 0.5) * depth - z_m) / push.radius_m
            bell = depth_m * np.exp(-(s_z**2))[:, None] * np.exp(-(s_x**2))
            total[np.ix_(rows % count_z, columns % count_x)] += bell.astype(self.dtype)
        return total

    def _next_velocity(self) -> Array:
        # Damping by the mean of both velocities: it never adds energy, however strong it is.
        out = self._acceleration(self._pressed())
        out *= self._gain
        out += self._keep * self.velocity
        return out

    def _steps_to(self, state: int) -> None:
        for _ in range(state - self.steps_done):
            self.velocity = self._next_velocity()
            self.displacement = self.displacement + self.dtype.type(self.step_s) * self.velocity
            self.steps_done += 1

    def _part(self, dt: float) -> Array:
        """Displacement `dt` after the last state, less than a step; at a whole step it is the next state."""
        if dt <= 0.0:
            return self.displacement
        following = self._next_velocity()
        mean, gain = 0.5 * (self.velocity + following), following - self.velocity
        return np.asarray(self.displacement + dt * mean + dt * dt / (2.0 * self.step_s) * gain)


def _absorption(ripples: Ripples) -> Array:
    """(H, W) 1/s: grows as the square of the depth in the zone; a wave that crosses it twice keeps 1/1000."""
    rows, columns = ripples.shape
    if ripples.boundary != "absorb":
        return np.zeros(ripples.shape)
    zone = max(4.0, ABSORBING_SHARE * min(rows, columns))
    near = [np.minimum(np.arange(n) + 0.5, n - np.arange(n) - 0.5) for n in (rows, columns)]
    deep = np.maximum(*(np.clip(1.0 - n / zone, 0.0, 1.0) for n in np.meshgrid(*near, indexing="ij")))
    return np.asarray(1.5 * np.log(1000.0) * ripples.speed_m_s / (zone * ripples.cell_m) * deep**2)
