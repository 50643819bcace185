"""Drops on an inclined pane: they arrive, grow, merge, run down when they are heavy enough, and leave trails."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.numbers import number
from pellucid.fields.sessile import (
    DENSITY,
    GRAVITY,
    PLUNGE,
    SURFACE_TENSION,
    check_angle,
    highest_m,
    looked_up,
    meniscus,
    merge,
    rim_table,
)
from pellucid.fields.swarm import Placed, Swarm, Values

STEP_S = 1.0 / 120.0
MOST_STEPS = 1_000_000
LARGEST = 4096
#: Fastest that a drop runs, m/s: drops of a step then touch what they pass.
FASTEST_M_S = 0.25
#: Time in which a drop takes its new shape, and in which a running one forgets its way aside, seconds.
RELAXATION_S = 0.04
STRAYING_S = 0.25
#: Standard deviation of the way of a running drop from straight down, radians.
STRAYING = 0.35
#: Texels outside of a rim over which the surface goes on at the contact angle.
APRON = 2.5
#: Volumes of the droplets of a trail, cubic metres.
TRAIL_M3 = (0.03e-9, 0.4e-9)


class Drops:
    """Rain and dew on a pane.

    **Running.** Gravity pulls with density V g sin(tilt); a rim of width 2 r holds back with
    2 r gamma (cos theta_receding - cos theta_advancing) [furmidge1962]. What is left over is spent on inertia and on
    friction `drag_pa_s` r v. A drop that runs strays a little, and leaves a film of thickness `film_m`, as wide as it
    is, which breaks up into droplets at once. Drops that touch merge; the heavier stays, in their centre of mass. What
    has passed the lower edge has run off. Left and right edge are joined, so the map repeats along u only.

    **Mass.** `rained_m3` = `on_pane_m3` + `run_off_m3`, at any time; rained is what came as drops and as dew.

    **Shape.** Spherical caps that gravity flattens, merged where they touch (`fields.sessile`); a running drop has a
    tail. The surface dips below the pane between them, as in `textures.drops`.

    x and z are metres from the centre, x along u, z downwards in the map, which is down the pane.

    Parameters
    ----------
    shape : (H, W) texels. cell_m : edge of a texel, metres. seed : of random numbers.
    tilt_deg : of the pane, 0 (lying) to 90 (upright).
    initial : number of drops at the start.
    rain_m_per_s : height of water that rain brings in a second; 3e-6 is a shower.
    dew_m_per_s : height of water that condenses on the drops in a second.
    volumes_ul : smallest and largest drop of the rain, microlitres.
    contact_angle_deg : of the shape, 5 to 85 degrees.
    hysteresis : cos theta_receding - cos theta_advancing, 0 (slippery) to 2.
    drag_pa_s : friction, Pa s: some hundred times the viscosity, as most of it arises near the rim.
    film_m : thickness of the trail, metres.
    below_m : depth of the map where there is no water, metres.

    Raises
    ------
    SceneError
        A parameter is out of its range.
    """

    def __init__(
        self,
        shape: tuple[int, int] = (256, 256),
        cell_m: float = 0.0003,
        seed: int = 0,
        tilt_deg: float = 90.0,
        initial: int = 400,
        rain_m_per_s: float = 3e-6,
        dew_m_per_s: float = 2e-7,
        volumes_ul: tuple[float, float] = (0.1, 5.0),
        contact_angle_deg: float = 60.0,
        hysteresis: float = 0.25,
        drag_pa_s: float = 0.15,
        film_m: float = 12e-6,
        below_m: float = 0.002,
    ) -> None:
        self.shape = _shape(shape)
        self.cell_m = number("cell_m", cell_m, low=1e-9)
        self.seed = _whole("seed", seed)
        self.initial = _whole("initial", initial)
        self.tilt = float(np.radians(number("tilt_deg", tilt_deg, low=0.0, high=90.0)))
        self.rain_m_per_s = number("rain_m_per_s", rain_m_per_s, low=0.0, high=1e-3)
        self.dew_m_per_s = number("dew_m_per_s", dew_m_per_s, low=0.0, high=1e-3)
        self.volumes_m3 = _volumes(volumes_ul)
        self.contact_angle = check_angle("contact_angle_deg", contact_angle_deg)
        self.hysteresis = number("hysteresis", hysteresis, low=0.0, high=2.0)
        self.drag_pa_s = number("drag_pa_s", drag_pa_s, low=1e-6)
        self.film_m = number("film_m", film_m, low=0.0, high=1e-3)
        self.below_m = number("below_m", below_m, low=1e-9)
        self._rim_table = rim_table(self.contact_angle)
        self.placed: list[Placed] = []
        self._restart()

    # ---- what a relief asks for ------------------------------------------------------------------------------

    @property
    def tile_m(self) -> tuple[float, float]:
        """Size along u and v, metres."""
        return self.shape[1] * self.cell_m, self.shape[0] * self.cell_m

    @property
    def limits_m(self) -> tuple[float, float]:
        """Lowest and highest height that is given back, metres."""
        return -self.below_m, highest_m(self.contact_angle)

    def advance(self, time_s: float) -> npt.NDArray[np.float32]:
        """Go to a time and give the heights there, (H, W) float32 metres.

        Whole steps of `STEP_S` are taken up to that time; drops are drawn a part of a step further on. For a time
        before the last one everything is done again from the start.

        Raises
        ------
        SceneError : the time is negative or not finite, or so late that it takes more than `MOST_STEPS` steps.
        """
        time_s = number("time_s", time_s, low=0.0)
        last = int(np.floor(time_s / STEP_S + 1e-6))
        if last > MOST_STEPS:
            raise SceneError("time_s", f"is {time_s:g}", f"takes more than {MOST_STEPS} steps of {STEP_S:g} s")
        unknown = self.placed[: len(self.applied)] != self.applied
        late = any(_state(p) < self.steps_done for p in self.placed[len(self.applied) :])
        if last < self.steps_done or unknown or late:
            self._restart()
        self._arrive_placed()
        while self.steps_done < last:
            self._step()
        self.time_s = time_s
        return self._heights(max(0.0, time_s - last * STEP_S))

    def drop(self, x_m: float, z_m: float, volume_ul: float, time_s: float | None = None) -> Placed:
        """Put a drop on the pane.

        Parameters
        ----------
        x_m, z_m : where, metres from the centre, z down the pane. volume_ul : microlitres.
        time_s : when; now if not given. It may lie in the future.

        Raises
        ------
        SceneError : it is not on the pane, has no volume, or comes before now.
        """
        width, depth = self.tile_m
        x = number("x_m", x_m, low=-0.5 * width, high=0.5 * width)
        z = number("z_m", z_m, low=-0.5 * depth, high=0.5 * depth)
        when = self.time_s if time_s is None else number("time_s", time_s, low=self.time_s)
        placed = Placed(when, x, z, number("volume_ul", volume_ul, low=1e-9, high=1e4))
        self.placed.append(placed)
        self.placed.sort(key=lambda p: p.time_s)
        return placed

    # ---- state -----------------------------------------------------------------------------------------------

    @property
    def on_pane_m3(self) -> float:
        """Volume of all drops on the pane, cubic metres."""
        return float(self.swarm.volume.sum())

    @property
    def count(self) -> int:
        """Number of drops on the pane."""
        return len(self.swarm)

    def _rims(self, volumes: Values) -> Values:
        return looked_up(volumes, *self._rim_table)

    def _restart(self) -> None:
        self.rng = np.random.default_rng(self.seed)
        self.steps_done, self.time_s = 0, 0.0
        self.rained_m3 = self.run_off_m3 = 0.0
        self.applied: list[Placed] = []
        self.swarm = Swarm.of([], [], [], [])
        # What has merged into another drop, and shrinks away: drawn, but without mass.
        self.ghosts = Swarm.of([], [], [], [])
        self._arrive(self.initial)
        self.swarm.shown = self._rims(self.swarm.volume)

    def _arrive(self, count: int) -> None:
        """Drops of rain anywhere; volumes are spread evenly over their logarithm."""
        width, depth = self.tile_m
        low, high = np.log(self.volumes_m3)
        x, y = self.rng.random(count) * width, self.rng.random(count) * depth
        self._add(x, y, np.exp(self.rng.uniform(low, high, count)))

    def _arrive_placed(self) -> None:
        width, depth = self.tile_m
        for placed in self.placed[len(self.applied) :]:
            if _state(placed) > self.steps_done:
                break
            x, y = (placed.x_m + 0.5 * width) % width, placed.z_m + 0.5 * depth
            self._add(np.array([x]), np.array([y]), np.array([placed.volume_ul * 1e-9]))
            self.applied.append(placed)

    def _add(self, x: Values, y: Values, volume: Values) -> None:
        self.swarm = self.swarm.with_more(Swarm.of(x, y, volume, self.rng.uniform(*TRAIL_M3, len(x))))
        self.rained_m3 += float(volume.sum())

    def _step(self) -> None:
        width, depth = self.tile_m
        area = width * depth
        mean = (self.volumes_m3[1] - self.volumes_m3[0]) / max(np.log(self.volumes_m3[1] / self.volumes_m3[0]), 1e-12)
        mean = mean if self.volumes_m3[1] > self.volumes_m3[0] else self.volumes_m3[0]
        self._arrive(int(self.rng.poisson(self.rain_m_per_s * area * STEP_S / mean)))
        self._condense(self.dew_m_per_s * area * STEP_S)
        self._run()
        self._leave_trails()
        self._merge()
        gone = self.swarm.y - self._rims(self.swarm.volume) > depth
        self.run_off_m3 += float(self.swarm.volume[gone].sum())
        self.swarm = self.swarm.kept(~gone)
        self._take_shape(STEP_S)
        self.steps_done += 1
        self._arrive_placed()

    def _condense(self, volume: float) -> None:
        """Dew goes to drops as their wet area is; on a dry pane there is nothing for it to settle on."""
        if len(self.swarm) and volume > 0.0:
            wet = self._rims(self.swarm.volume) ** 2
            self.swarm.volume = self.swarm.volume + volume * wet / wet.sum()
            self.rained_m3 += volume

    def _run(self) -> None:
        """Inertia, gravity, the hold of the rim and friction; friction at the end of the step, so that it is stable."""
        s = self.swarm
        rim = self._rims(s.volume)
        pull = DENSITY * s.volume * GRAVITY * np.sin(self.tilt)
        hold = 2.0 * rim * SURFACE_TENSION * self.hysteresis  # [furmidge1962]
        mass = DENSITY * s.volume
        pushed = s.speed + STEP_S * (pull - hold) / mass
        s.speed = np.clip(pushed / (1.0 + STEP_S * self.drag_pa_s * rim / mass), 0.0, FASTEST_M_S)
        noise = self.rng.normal(size=len(s)) * STRAYING * np.sqrt(2.0 * STEP_S / STRAYING_S)
        s.way = np.where(s.speed > 0.0, np.clip(s.way * (1.0 - STEP_S / STRAYING_S) + noise, -1.0, 1.0), 0.0)
        s.x = (s.x + STEP_S * s.speed * np.sin(s.way)) % self.tile_m[0]
        s.y = s.y + STEP_S * s.speed * np.cos(s.way)
        film = STEP_S * s.speed * 2.0 * rim * self.film_m
        s.owed = np.minimum(s.owed + film, 0.9 * s.volume)

    def _leave_trails(self) -> None:
        s = self.swarm
        leaving = (s.owed >= s.next_trail) & (s.volume > 3.0 * s.next_trail)
        if not leaving.any():
            return
        given = s.next_trail[leaving]
        reach = 1.02 * (self._rims(s.volume[leaving]) + self._rims(given))
        aside = s.way[leaving] + self.rng.uniform(-0.35, 0.35, len(given))
        x, y = s.x[leaving] - reach * np.sin(aside), s.y[leaving] - reach * np.cos(aside)
        s.volume[leaving] -= given
        s.owed[leaving] -= given
        s.next_trail[leaving] = self.rng.uniform(*TRAIL_M3, len(given))
        trail = Swarm.of(x % self.tile_m[0], y, given, self.rng.uniform(*TRAIL_M3, len(given)))
        trail.shown = self._rims(given)
        self.swarm = s.with_more(trail)

    def _merge(self) -> None:
        from scipy.spatial import cKDTree

        s = self.swarm
        if len(s) < 2:
            return
        rim = self._rims(s.volume)
        width = self.tile_m[0]
        # The tree joins left and right; up and down there is a box that nothing leaves.
        places = np.stack([s.x % width, s.y - s.y.min()], axis=-1)
        box = [width, 4.0 * float(places[:, 1].max() + rim.max()) + 1.0]
        pairs = cKDTree(places, boxsize=box).query_pairs(2.0 * float(rim.max()), output_type="ndarray")
        if len(pairs) == 0:
            return
        apart = places[pairs[:, 0]] - places[pairs[:, 1]]
        apart[:, 0] -= width * np.round(apart[:, 0] / width)
        touching = pairs[np.hypot(apart[:, 0], apart[:, 1]) < rim[pairs].sum(axis=1)]
        there = np.ones(len(s), bool)
        for a, b in touching[np.lexsort((touching[:, 1], touching[:, 0]))]:
            if there[a] and there[b]:
                small, large = (a, b) if s.volume[a] < s.volume[b] else (b, a)
                self._take_in(large, small)
                there[small] = False
        ghosts = s.kept(~there)
        self.ghosts = self.ghosts.with_more(replace(ghosts, speed=np.zeros(len(ghosts))))
        self.swarm = s.kept(there)

    def _take_in(self, large: int, small: int) -> None:
        s, width = self.swarm, self.tile_m[0]
        total = s.volume[large] + s.volume[small]
        share = s.volume[small] / total
        across = s.x[small] - s.x[large]
        s.x[large] = (s.x[large] + share * (across - width * np.round(across / width))) % width
        s.y[large] += share * (s.y[small] - s.y[large])
        s.speed[large] += share * (s.speed[small] - s.speed[large])
        s.owed[large] += s.owed[small]
        s.volume[large] = total

    def _take_shape(self, dt: float) -> None:
        self.swarm.shown = self._shown(dt)
        self.ghosts.shown = self.ghosts.shown * np.exp(-dt / RELAXATION_S)
        self.ghosts = self.ghosts.kept(self.ghosts.shown > 0.5 * self.cell_m)

    def _shown(self, dt: float) -> Values:
        s = self.swarm
        return np.asarray(s.shown + (self._rims(s.volume) - s.shown) * -np.expm1(-dt / RELAXATION_S))

    # ---- shape -----------------------------------------------------------------------------------------------

    def _heights(self, dt: float) -> npt.NDArray[np.float32]:
        s, ghosts = self.swarm, self.ghosts
        within = np.full(self.shape, -1.0)
        rim = np.full(self.shape, float(s.shown.max()) if len(s) else self.cell_m)
        shown = self._shown(dt)
        x, y = s.x + dt * s.speed * np.sin(s.way), s.y + dt * s.speed * np.cos(s.way)
        # A running drop draws a tail: a smaller circle after it. Its own is smaller by as much.
        stretch = np.clip(s.speed / 0.06, 0.0, 1.0)
        for k in range(len(s)):
            radius = shown[k] * (1.0 - 0.1 * stretch[k])
            self._draw(within, rim, x[k], y[k], radius, 0.6)
            if stretch[k] > 0.0:
                back = 0.75 * stretch[k] * radius
                tail = radius * (1.0 - 0.35 * stretch[k])
                self._draw(within, rim, x[k] - back * np.sin(s.way[k]), y[k] - back * np.cos(s.way[k]), tail, 1.8)
        for k, radius in enumerate(ghosts.shown * np.exp(-dt / RELAXATION_S)):
            self._draw(within, rim, ghosts.x[k], ghosts.y[k], radius, 1.2)
        heights = meniscus(within, rim, self.contact_angle, APRON * self.cell_m)
        return np.clip(heights, *self.limits_m).astype(np.float32)

    def _draw(self, within: Values, rim: Values, x: float, y: float, radius: float, width: float) -> None:
        """Merge a round drop into the texels that it can reach."""
        if radius < 0.25 * self.cell_m:
            return
        rows, columns = self.shape
        reach = radius * (1.0 + 0.25 * width) + APRON * self.cell_m + self.below_m / PLUNGE + self.cell_m
        top, bottom = (int(np.floor((y + sign * reach) / self.cell_m)) for sign in (-1, 1))
        left, right = (int(np.floor((x + sign * reach) / self.cell_m)) for sign in (-1, 1))
        j = np.arange(max(top, 0), min(bottom + 1, rows))
        i = np.arange(left, min(right + 1, left + columns))
        if len(j) == 0:
            return
        rho = np.hypot((i + 0.5) * self.cell_m - x, ((j + 0.5) * self.cell_m - y)[:, None])
        at = np.ix_(j, i % columns)
        part, part_rim = within[at], rim[at]
        merge(part, part_rim, rho, radius, width)
        within[at], rim[at] = part, part_rim


def _state(placed: Placed) -> int:
    return int(np.ceil(placed.time_s / STEP_S - 1e-6))


def _shape(shape: Any) -> tuple[int, int]:
    try:
        rows, columns = (_whole("shape", n) for n in shape)
    except TypeError:
        raise SceneError("shape", f"is {shape!r}", "give (rows, columns)") from None
    except ValueError:
        raise SceneError("shape", f"is {shape!r}", "give (rows, columns)") from None
    if not (2 <= rows <= LARGEST and 2 <= columns <= LARGEST):
        raise SceneError("shape", f"is {shape!r}", f"use 2 to {LARGEST} rows and columns")
    return rows, columns


def _volumes(volumes_ul: Any) -> tuple[float, float]:
    try:
        low, high = volumes_ul
    except (TypeError, ValueError):
        raise SceneError("volumes_ul", f"is {volumes_ul!r}", "give the smallest and the largest volume") from None
    small, large = (number("volumes_ul", v, low=1e-6, high=1e4) * 1e-9 for v in (low, high))
    if small > large:
        raise SceneError("volumes_ul", f"is {volumes_ul!r}", "give the smaller volume first")
    return small, large


def _whole(name: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < 0:
        raise SceneError(name, f"is {value!r}", "give a whole number, at least 0")
    return int(value)
