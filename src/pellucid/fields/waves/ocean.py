"""The open sea: waves of a wind's spectrum, added up by Fourier transforms [tessendorf2001]."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from pellucid.errors import SceneError
from pellucid.fields.waves import arguments, spectra
from pellucid.fields.waves.dispersion import angular_frequency
from pellucid.fields.waves.eulerian import grid_origins, moved_slopes
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
        self.loop_s = None if loop_s is None else arguments.number("loop_s", loop_s, low=1e-3)
        self.level_m = arguments.number("level_m", level_m)
        self._prepare()

    @property
    def tile_m(self) -> tuple[float, float]:
        """Size along x and z, metres."""
        return self._tile

    @property
    def limits_m(self) -> tuple[float, float]:
        """Lowest and highest height that is given, metres: `DEVIATIONS` from the level."""
        reach = DEVIATIONS * self.variance_m2**0.5
        return self.level_m - reach, self.level_m + reach

    @property
    def significant_height_m(self) -> float:
        """Four standard deviations of the heights, metres: what a sailor calls the height of the waves."""
        return 4.0 * float(self.variance_m2) ** 0.5

    @property
    def short_slopes(self) -> tuple[float, float, float]:
        """Mean squares of slopes of the waves below two cells: what [cox1954] measured, without those on the grid."""
        along, across = (self.amplitude**2 * value for value in spectra.slope_variance(self.wind_m_s))
        c, s = np.cos(np.radians(self.wind_deg)), np.sin(np.radians(self.wind_deg))
        total = along * c * c + across * s * s, along * s * s + across * c * c
        xx, zz = (max(all_ - own, 0.0) for all_, own in zip(total, self.slope_variance[::2], strict=True))
        xz = (along - across) * c * s - self.slope_variance[1]
        bound = (xx * zz) ** 0.5
        return xx, float(np.clip(xz, -bound, bound)), zz

    def _prepare(self) -> None:
        (rows, columns), (width, depth) = self.shape, self._tile
        n = np.fft.fftfreq(rows, 1.0 / rows)[:, None]
        m = np.fft.fftfreq(columns, 1.0 / columns)[None, :]
        k_x, k_z = 2.0 * np.pi * m / width, 2.0 * np.pi * n / depth
        given = (self.wind_m_s, self.wind_deg, self.spectrum, self.fetch_m, self.depth_m, self.spreading)
        power = self.amplitude**2 * spectra.vector_spectrum(k_x, k_z, *given) * (2.0 * np.pi) ** 2 / (width * depth)
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
        self.omega = omega
        self._along_x, self._along_z = (1j * k_x).astype(np.complex64)[:, half], (1j * k_z).astype(np.complex64)
        self._inverse = np.where(k > 0.0, 1.0 / np.where(k > 0.0, k, 1.0), 0.0).astype(np.float32)

    def _coefficients(self, time_s: float) -> Complex:
        """(H, W/2 + 1) of the heights over x0: waves cos(omega t) - i waves sin(omega t)."""
        phase = np.remainder(self.omega * time_s, 2.0 * np.pi).astype(np.float32)
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
        places = grid_origins(field(move_x), field(move_z), self.cell)
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
