"""The open sea: waves of a wind's spectrum, added up by Fourier transforms [tessendorf2001]."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.waves import arguments, spectra
from pellucid.fields.waves.dispersion import angular_frequency
from pellucid.fields.waves.eulerian import grid_origins, moved_slopes
from pellucid.fields.waves.layers import Sum
from pellucid.fields.waves.source import Singles, WaveSource, WaveSurface, bilinear

#: Heights are cut off so many standard deviations from the level; one in 10^9 is beyond.
DEVIATIONS = 6.0
LARGEST = 2048

Complex = npt.NDArray[np.complex64]


class Ocean(WaveSource):
    """A sea under a steady wind, periodic over a tile.

    Each wave vector k of the tile's lattice carries a wave that travels along it, A cos(k x - omega t + phase), with
    the mean square A^2 / 2 = psi(k) dk^2 and a random phase: so heights are normally distributed, with the variance of
    the part of the spectrum that lies on the lattice, waves from the tile's side down to two cells.

    Parameters
    ----------
    wind_m_s : at 10 m over the water; 0 gives flat water.
    wind_deg : where it blows to, degrees from x towards z.
    tile_m : side of the tile, or (along x, along z), metres. It should hold several of the longest waves: those longer
        than it are left out. shape : (H, W) cells, even numbers. A finer grid only adds shorter waves.
    spectrum : ``"jonswap"``, ``"tma"``, ``"pierson-moskowitz"`` or ``"phillips"``; see `spectra.frequency_spectrum`.
    spreading : ``"hasselmann"``, ``"donelan"`` or ``"cosine"``; see `spectra.spreading`.
    fetch_m : over which the wind blows. depth_m : of the water; with ``"tma"``.
    choppiness : how far water moves sideways; 1 as it does in waves of small height, sharper crests beyond, 0 not at
        all.
    amplitude : multiplies all waves.
    seed : of the phases.
    shortest_m, longest_m : wavelengths that are left out below and from there on; see `cascade`.
    loop_s : frequencies are rounded so that all repeats after so many seconds; None for those of the waves.
    level_m : of the water at rest, metres.

    Raises
    ------
    SceneError : a parameter out of its range.
    """

    kind: ClassVar[str] = "ocean"
    periodic = True

    def __init__(
        self,
        wind_m_s: float = 8.0,
        wind_deg: float = 0.0,
        tile_m: float | tuple[float, float] = 100.0,
        shape: tuple[int, int] = (256, 256),
        spectrum: str = "jonswap",
        spreading: str = "hasselmann",
        fetch_m: float = 100e3,
        depth_m: float = np.inf,
        choppiness: float = 1.0,
        amplitude: float = 1.0,
        seed: int = 0,
        shortest_m: float = 0.0,
        longest_m: float = np.inf,
        loop_s: float | None = None,
        level_m: float = 0.0,
    ) -> None:
        spectra.checked(wind_m_s, spectrum, spreading, fetch_m, depth_m)
        self.shape = arguments.grid(shape, low=8, high=LARGEST)
        if self.shape[0] % 2 or self.shape[1] % 2:
            raise SceneError("shape", f"is {self.shape}", "give even numbers of rows and columns")
        self.wind_m_s, self.wind_deg = float(wind_m_s), arguments.number("wind_deg", wind_deg)
        self._tile = arguments.tile(tile_m)
        self.spectrum, self.spreading = spectrum, spreading
        self.fetch_m, self.depth_m = float(fetch_m), float(depth_m)
        self.choppiness = arguments.number("choppiness", choppiness, low=0.0, high=4.0)
        self.amplitude = arguments.number("amplitude", amplitude, low=0.0, high=100.0)
        if not isinstance(seed, int | np.integer) or isinstance(seed, bool) or seed < 0:
            raise SceneError("seed", f"is {seed!r}", "give a whole number, 0 or more")
        self.seed = int(seed)
        self.shortest_m = arguments.number("shortest_m", shortest_m, low=0.0)
        self.longest_m = arguments.depth("longest_m", longest_m)
        if not self.shortest_m < self.longest_m:
            raise SceneError("shortest_m", f"is {self.shortest_m:g}", f"use less than longest_m, {self.longest_m:g}")
        self.loop_s = None if loop_s is None else arguments.number("loop_s", loop_s, low=1e-3)
        self.level_m = arguments.number("level_m", level_m)
        self._prepare()

    @classmethod
    def cascade(
        cls, wind_m_s: float = 8.0, wind_deg: float = 0.0, tiles_m: Sequence[float] = (250.0, 37.0, 5.3), **others: Any
    ) -> Sum:
        """A sea of several tiles that divide the spectrum between them: long waves and ripples, no repetition in sight.

        Each tile has the waves that are shorter than four cells of the one before, as long as they are longer than
        four of its own; together their pattern does not repeat where their sides have no common multiple.

        Parameters
        ----------
        tiles_m : sides of the tiles, falling, each to hold four of its longest waves. others : those of `Ocean`; each
            tile has a seed of its own.

        Raises
        ------
        SceneError : tiles that do not fall, or so fast that waves between them are missing.
        """
        sides = arguments.numbers("tiles_m", tiles_m, low=1e-6)
        shape = arguments.grid(others.get("shape", (256, 256)), low=8, high=LARGEST)
        ends = [4.0 * side / min(shape) for side in sides]
        for side, before in zip(sides[1:], ends, strict=False):
            if not before <= 0.25 * side or not side < sides[0]:
                said = f"are {sides.tolist()} with {shape} cells"
                raise SceneError("tiles_m", said, f"after one with waves to {before:g} m use at least {4.0 * before:g}")
        longest = [np.inf, *ends[:-1]]
        shortest = [*ends[:-1], 0.0]
        seed = others.pop("seed", 0)
        layers = [
            cls(wind_m_s, wind_deg, float(side), shortest_m=low, longest_m=high, seed=seed + 7919 * n, **others)
            for n, (side, low, high) in enumerate(zip(sides, shortest, longest, strict=True))
        ]
        return Sum(*layers)

    @property
    def limits_m(self) -> tuple[float, float]:
        """Lowest and highest height that is given, metres: `DEVIATIONS` from the level."""
        reach = DEVIATIONS * self.variance_m2**0.5
        return self.level_m - reach, self.level_m + reach

    @property
    def steepest(self) -> float:
        """Root of the mean square of slopes, times that of the logarithm of the number of cells.

        As slopes are normally distributed, one of the cells is beyond that on average, but for what `choppiness` adds.
        """
        rows, columns = self.shape
        return float(((self.slope_variance[0] + self.slope_variance[2]) * np.log(rows * columns)) ** 0.5)

    @property
    def significant_height_m(self) -> float:
        """Four standard deviations of the heights, metres: what a sailor calls the height of the waves."""
        return 4.0 * float(self.variance_m2) ** 0.5

    @property
    def short_slopes(self) -> tuple[float, float, float]:
        """Mean squares of slopes of the waves below two cells: what [cox1954] measured, without those on the grid.

        None where `shortest_m` leaves shorter ones to others; with `longest_m` longer ones are taken off as well.
        """
        if self.shortest_m > 0.0:
            return 0.0, 0.0, 0.0
        along, across = (self.amplitude**2 * value for value in spectra.slope_variance(self.wind_m_s))
        c, s = np.cos(np.radians(self.wind_deg)), np.sin(np.radians(self.wind_deg))
        total = along * c * c + across * s * s, along * s * s + across * c * c
        own = [a + b for a, b in zip(self.slope_variance, self._longer_slopes(), strict=True)]
        xx, zz = (max(every - held, 0.0) for every, held in zip(total, own[::2], strict=True))
        xz = (along - across) * c * s - own[1]
        bound = (xx * zz) ** 0.5
        return xx, float(np.clip(xz, -bound, bound)), zz

    def _longer_slopes(self) -> tuple[float, ...]:
        """Mean squares xx, xz, zz of slopes of waves from `longest_m` on, by sums in log k and direction."""
        if np.isinf(self.longest_m):
            return 0.0, 0.0, 0.0
        k = np.geomspace(1e-4 * 2.0 * np.pi / self.longest_m, 2.0 * np.pi / self.longest_m, 600)[:, None]
        theta = np.arange(96) * (2.0 * np.pi / 96)
        k_x, k_z = k * np.cos(theta), k * np.sin(theta)
        density = self.amplitude**2 * spectra.vector_spectrum(k_x, k_z, *self._wind()) * k * k
        weight = density * (2.0 * np.pi / 96) * np.log(k[1] / k[0])
        return tuple(float((weight * a * b).sum()) for a, b in ((k_x, k_x), (k_x, k_z), (k_z, k_z)))

    def _wind(self) -> tuple[Any, ...]:
        return self.wind_m_s, self.wind_deg, self.spectrum, self.fetch_m, self.depth_m, self.spreading

    def _prepare(self) -> None:
        (rows, columns), (width, depth) = self.shape, self._tile
        n = np.fft.fftfreq(rows, 1.0 / rows)[:, None]
        m = np.fft.fftfreq(columns, 1.0 / columns)[None, :]
        k_x, k_z = 2.0 * np.pi * m / width, 2.0 * np.pi * n / depth
        power = self.amplitude**2 * spectra.vector_spectrum(k_x, k_z, *self._wind())
        power *= (2.0 * np.pi) ** 2 / (width * depth)
        length = 2.0 * np.pi / np.maximum(np.hypot(k_x, k_z), 1e-9)
        power[(length < self.shortest_m) | (length >= self.longest_m)] = 0.0
        # A wave of two cells has no direction, and no slope on the grid.
        power[rows // 2], power[:, columns // 2] = 0.0, 0.0
        self.variance_m2 = float(power.sum())
        pairs = ((k_x, k_x), (k_x, k_z), (k_z, k_z))
        #: Mean squares (dh/dx)^2, dh/dx dh/dz, (dh/dz)^2 of the waves on the grid, before they are moved sideways.
        self.slope_variance = tuple(float((power * a * b).sum()) for a, b in pairs)
        # Random numbers go outwards, shell by shell: those of a coarser grid stay when it is refined.
        shell = np.maximum(np.abs(n), np.abs(m))
        order = _outwards(n, m, shell)
        noise = np.empty((rows * columns, 2))
        noise[order] = np.random.default_rng(self.seed).standard_normal((rows * columns, 2))
        waves = np.sqrt(power) * (noise[:, 0] + 1j * noise[:, 1]).reshape(rows, columns)
        # Phases are those at x = z = 0, the middle; the transform's origin is the centre of the first cell.
        x, z = self.centres()
        waves = waves * np.exp(1j * (k_x * x[0] + k_z * z[0]))
        # A real field: each coefficient is half the wave along k, and the conjugate half of that against k.
        against = np.conj(np.roll(waves[::-1, ::-1], 1, (0, 1)))
        half = slice(0, columns // 2 + 1)
        self._sum = (0.5 * (waves + against)[:, half]).astype(np.complex64)
        self._difference = (-0.5j * (waves - against)[:, half]).astype(np.complex64)
        k = np.hypot(k_x, k_z)[:, half]
        omega = angular_frequency(k, self.depth_m)
        if self.loop_s is not None:
            turn = 2.0 * np.pi / self.loop_s
            omega = np.round(omega / turn) * turn
        self.omega, self._turns_s = omega, omega / (2.0 * np.pi)
        self._along_x, self._along_z = (1j * k_x).astype(np.complex64)[:, half], (1j * k_z).astype(np.complex64)
        self._inverse = np.where(k > 0.0, 1.0 / np.where(k > 0.0, k, 1.0), 0.0).astype(np.float32)

    def _coefficients(self, time_s: float) -> Complex:
        """(H, W/2 + 1) of the heights over x0: waves cos(omega t) - i waves sin(omega t)."""
        turns = self._turns_s * time_s
        turns -= np.floor(turns)
        phase = np.float32(2.0 * np.pi) * turns.astype(np.float32)
        return np.asarray(self._sum * np.cos(phase) + self._difference * np.sin(phase))

    def _surface(self, time_s: float) -> WaveSurface:
        from scipy.fft import irfft2

        if self.variance_m2 == 0.0:
            return _flat(self.shape, self.level_m)

        def field(coefficients: Complex) -> Singles:
            return np.asarray(irfft2(coefficients, s=self.shape, norm="forward", overwrite_x=True))

        waves = self._coefficients(time_s)
        slope_x, slope_z = self._along_x * waves, self._along_z * waves
        if self.choppiness == 0.0:
            heights = self._cut(field(waves))
            return WaveSurface(heights, np.stack([field(slope_x), field(slope_z)], axis=-1))
        # D = grad h / |k| times choppiness; [tessendorf2001, eq. 29] has the other sign, which sharpens troughs.
        reach = np.float32(self.choppiness) * self._inverse
        move_x, move_z = reach * slope_x, reach * slope_z
        of_x, of_z = self._along_x * move_x, self._along_z * move_z
        gradients = field(of_x), field(of_z), field(self._along_x * move_z)
        planes = field(waves), *moved_slopes(field(slope_x), field(slope_z), *gradients)
        places = grid_origins(field(move_x), field(move_z), self.cell, gradients)
        heights, along_x, along_z, fold = bilinear(planes, *places, True)
        return WaveSurface(self._cut(heights), np.stack([along_x, along_z], axis=-1), fold)

    def _cut(self, heights: Singles) -> Singles:
        low, high = (limit - self.level_m for limit in self.limits_m)
        np.clip(heights, low, high, out=heights)
        heights += np.float32(self.level_m)
        return heights


def _outwards(n: Any, m: Any, shell: Any) -> npt.NDArray[np.intp]:
    """Cells in order of their shell, then row, then column."""
    flat = [np.broadcast_to(a, shell.shape).reshape(-1) for a in (m, n, shell)]
    return np.asarray(np.lexsort(flat))


def _flat(shape: tuple[int, int], level_m: float) -> WaveSurface:
    heights = np.full(shape, level_m, np.float32)
    return WaveSurface(heights, np.zeros((*shape, 2), np.float32))
