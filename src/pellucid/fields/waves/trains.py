"""Waves of a few lengths and directions: sines [mihalik2008], and Gerstner's, in which water goes round in circles."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.waves import arguments
from pellucid.fields.waves.dispersion import angular_frequency
from pellucid.fields.waves.eulerian import moved_slopes, origins
from pellucid.fields.waves.source import Array, Singles, WaveSource, WaveSurface

MOST_TRAINS = 64
LARGEST = 2048


class Sine(WaveSource):
    """A sum of sine waves, h = sum of a cos(k x - omega t + phase) [mihalik2008, 6].

    All that a train has may be one number or one for each train.

    Parameters
    ----------
    wavelength_m : > 0. amplitude_m : half the height from trough to crest.
    direction_deg : where it travels to, from x towards z. phase_deg : at the middle at the start.
    speed_m_s : of the crests; that of water waves of the length when None.
    depth_m : of the water, for that speed.
    tile_m, shape : size and cells (H, W) of the grid.
    periodic : lengths and directions are moved to the nearest with whole waves on the tile along both axes, so that it
        repeats. Else they are as given, and there is water on one tile only.
    level_m : of the water at rest, metres.

    Attributes
    ----------
    k : (N, 2) wave vectors along x and z, 1/m. omega : (N,) rad/s. amplitudes_m, phases_rad : (N,).

    Raises
    ------
    SceneError : a parameter out of its range; a wave that is longer than the tile, or than two cells shorter.
    """

    kind: ClassVar[str] = "sine"

    def __init__(
        self,
        wavelength_m: npt.ArrayLike = 2.0,
        amplitude_m: npt.ArrayLike = 0.05,
        direction_deg: npt.ArrayLike = 0.0,
        phase_deg: npt.ArrayLike = 0.0,
        speed_m_s: npt.ArrayLike | None = None,
        depth_m: float = np.inf,
        tile_m: float | tuple[float, float] = 10.0,
        shape: tuple[int, int] = (256, 256),
        periodic: bool = True,
        level_m: float = 0.0,
    ) -> None:
        self.shape = arguments.grid(shape, low=4, high=LARGEST)
        self._tile = arguments.tile(tile_m)
        self.periodic = arguments.flag("periodic", periodic)
        self.depth_m = arguments.depth("depth_m", depth_m)
        self.level_m = arguments.number("level_m", level_m)
        self.trains: dict[str, Array] = {
            "wavelength_m": arguments.numbers("wavelength_m", wavelength_m, low=1e-6),
            "amplitude_m": arguments.numbers("amplitude_m", amplitude_m, low=0.0, high=1e4),
            "direction_deg": arguments.numbers("direction_deg", direction_deg),
            "phase_deg": arguments.numbers("phase_deg", phase_deg),
        }
        if speed_m_s is not None:
            self.trains["speed_m_s"] = arguments.numbers("speed_m_s", speed_m_s, low=0.0)
        self._prepare(**self._together())

    @property
    def limits_m(self) -> tuple[float, float]:
        """Lowest and highest height, metres: all crests together."""
        reach = float(self.amplitudes_m.sum()) * (1.0 + 1e-6)
        return self.level_m - reach, self.level_m + reach

    @property
    def steepest(self) -> float:
        """Steepest slope, where all trains are steepest in one place."""
        return float((self.amplitudes_m * np.hypot(*self.k.T)).sum())

    def _together(self) -> dict[str, Array]:
        """All parameters of the trains at the same length."""
        count = max(len(values) for values in self.trains.values())
        for name, values in self.trains.items():
            if len(values) not in (1, count):
                raise SceneError(name, f"are {len(values)} for {count} trains", "give one number, or one a train")
        if count > MOST_TRAINS:
            raise SceneError("wavelength_m", f"are {count}", f"add up at most {MOST_TRAINS}, or use Ocean")
        return {name: np.broadcast_to(values, count) for name, values in self.trains.items()}

    def _prepare(
        self,
        wavelength_m: Array,
        amplitude_m: Array,
        direction_deg: Array,
        phase_deg: Array,
        speed_m_s: Array | None = None,
    ) -> None:
        angle, size = np.radians(direction_deg), np.array(self._tile)
        turns = np.stack([np.cos(angle), np.sin(angle)], axis=1) / wavelength_m[:, None] * size
        turns = np.round(turns) if self.periodic else turns
        if not np.any(turns, axis=1).all():
            longest = float(wavelength_m.max())
            raise SceneError("wavelength_m", f"is {longest:g} on a tile of {self._tile}", "use a larger tile_m")
        if (np.abs(turns) > 0.5 * np.array(self.shape[::-1])).any():
            shortest = float(wavelength_m.min())
            raise SceneError("wavelength_m", f"is {shortest:g}: two cells or less", "use more cells, or a smaller tile")
        self.k: Array = 2.0 * np.pi * turns / size
        self.amplitudes_m: Array = amplitude_m
        self.phases_rad: Array = np.radians(phase_deg)
        length = np.hypot(*self.k.T)
        self.omega: Array = angular_frequency(length, self.depth_m) if speed_m_s is None else length * speed_m_s
        self.heading: Array = self.k / length[:, None]

    def _lattice(self, time_s: float, factors: Array) -> Singles:
        """(F, H, W) sums over the trains of factor (F, N), complex, times exp(i (k x - omega t + phase)), real part.

        The exponential is one of x times one of z: two thin matrices instead of a cosine for each cell and train.
        """
        x, z = self.centres()
        along_x = np.exp(1j * self.k[:, :1] * x)
        along_z = np.exp(1j * (self.k[:, 1:] * z + (self.phases_rad - self.omega * time_s)[:, None]))
        left = (factors[:, None, :] * along_z.T).reshape(-1, len(self.k))
        left, right = np.hstack([left.real, -left.imag]), np.vstack([along_x.real, along_x.imag])
        sums = left.astype(np.float32) @ right.astype(np.float32)
        return np.asarray(sums.reshape(len(factors), *self.shape))

    def _surface(self, time_s: float) -> WaveSurface:
        steep = 1j * self.k.T * self.amplitudes_m
        heights, along_x, along_z = self._lattice(time_s, np.vstack([self.amplitudes_m + 0j, steep]))
        heights += np.float32(self.level_m)
        return WaveSurface(np.clip(heights, *self.limits_m), np.stack([along_x, along_z], axis=-1))


class Gerstner(Sine):
    """A sum of trochoidal waves: water at rest at x0 goes round in circles about it [gerstner1809; fournier1986].

    x = x0 - sum of s a k/|k| sin(k x0 - omega t + phase), h = sum of a cos(...): crests narrower than troughs. For each
    place of the grid the x0 that has come there is found (`eulerian.origins`).

    Parameters
    ----------
    sharpness : width of the orbits over their height, s: 0 for sines, 1 for circles; a number, or one for each train.
    others : those of `Sine`.

    Attributes
    ----------
    steepness : sum of s a |k|; where all crests meet the Jacobian is 1 less this.

    Raises
    ------
    SceneError : those of `Sine`; waves with a steepness above 1, which would run in loops.
    """

    kind: ClassVar[str] = "gerstner"

    def __init__(
        self,
        wavelength_m: npt.ArrayLike = 2.0,
        amplitude_m: npt.ArrayLike = 0.1,
        direction_deg: npt.ArrayLike = 0.0,
        phase_deg: npt.ArrayLike = 0.0,
        sharpness: npt.ArrayLike = 1.0,
        **others: Any,
    ) -> None:
        self._sharpness = arguments.numbers("sharpness", sharpness, low=0.0, high=1.0)
        super().__init__(wavelength_m, amplitude_m, direction_deg, phase_deg, **others)

    @property
    def steepest(self) -> float:
        """Steepest slope, as of one train of the same steepness: that of a trochoid; a cusp's is infinite."""
        rest = 1.0 - self.steepness**2
        return super().steepest / rest**0.5 if rest > 0.0 else float("inf")

    def _together(self) -> dict[str, Array]:
        self.trains["sharpness"] = self._sharpness
        return super()._together()

    def _prepare(self, *given: Any, sharpness: Any = 1.0, **others: Any) -> None:
        super()._prepare(*given, **others)
        self.sharpness: Array = sharpness
        self.steepness = float((sharpness * self.amplitudes_m * np.hypot(*self.k.T)).sum())
        if self.steepness > 1.0:
            most = float(1.0 / self.steepness)
            said = f"with sharpness the waves have a steepness of {self.steepness:.3g}; above 1 they run in loops"
            raise SceneError("amplitude_m", said, f"multiply amplitudes or sharpness by {most:.3g} or less")

    def displaced(self, x0: Array, z0: Array, time_s: float) -> tuple[Array, ...]:
        """Of water at rest at x0, z0 (...): its way D_x, D_z, dD_x/dx, dD_z/dz, dD_x/dz, and h, dh/dx, dh/dz."""
        total = [np.zeros(np.broadcast(x0, z0).shape, np.float32) for _ in range(8)]
        offsets = np.remainder(self.phases_rad - self.omega * time_s, 2.0 * np.pi)
        for (k_x, k_z), (c, s), a, q, phase in zip(
            self.k.tolist(), self.heading.tolist(), self.amplitudes_m.tolist(), self.sharpness.tolist(),
            offsets.tolist(), strict=True,
        ):  # fmt: skip
            angle = np.asarray(k_x * x0 + k_z * z0 + phase, np.float32)
            sine, cosine = a * np.sin(angle), a * np.cos(angle)
            moved = (-q * c * sine, -q * s * sine)
            squeezed = (-q * c * k_x * cosine, -q * s * k_z * cosine, -q * c * k_z * cosine)
            for one, part in zip(total, (*moved, *squeezed, cosine, -k_x * sine, -k_z * sine), strict=True):
                one += part
        return tuple(total)

    def _surface(self, time_s: float) -> WaveSurface:
        x, z = (np.asarray(line, np.float32) for line in self.centres())
        x, z = np.broadcast_arrays(x, z[:, None])
        x0, z0 = origins(lambda a, b: self.displaced(a, b, time_s)[:5], x, z, 1e-3 * min(self.cell))
        _, _, xx, zz, xz, heights, along_x, along_z = self.displaced(x0, z0, time_s)
        slope_x, slope_z, fold = moved_slopes(along_x, along_z, xx, zz, xz)
        heights = np.clip(heights + np.float32(self.level_m), *self.limits_m).astype(np.float32)
        return WaveSurface(heights, np.stack([slope_x, slope_z], axis=-1), fold)
