"""An equirectangular environment made ready for the GPU: blurred levels and its irradiance."""

from __future__ import annotations

import numpy as np

from pellucid.surroundings.resample import area_resample

MAX_HEIGHT = 4096
GLOSSY_HEIGHT = 128
GLOSSY_LEVELS = 6
GLOSSY_ALPHA = 0.04  # sharper lobes are read from the map's own levels
HALF_MAX = 65504.0


def row_solid_angles(height: int) -> np.ndarray:
    """Solid angle of a whole row of an equirectangular image: (height,) sr, summing to 4 pi."""
    edges = np.cos(np.linspace(0.0, np.pi, height + 1))
    return 2.0 * np.pi * (edges[:-1] - edges[1:])


def mip_levels(pixels: np.ndarray) -> list[np.ndarray]:
    """Blurred levels of an environment, each half the size of the one before, down to one row.

    Every texel is the mean radiance of the directions it covers, so each level sends the same power.

    Parameters
    ----------
    pixels : (H, W, 3) radiance, row 0 towards +Y.
    """
    levels = [np.ascontiguousarray(pixels, np.float32)]
    if levels[0].shape[0] > MAX_HEIGHT or levels[0].shape[1] > 2 * MAX_HEIGHT:
        levels = [_resized(levels[0], (MAX_HEIGHT, 2 * MAX_HEIGHT))]
    while min(levels[-1].shape[:2]) > 1:
        height, width = levels[-1].shape[:2]
        levels.append(_resized(levels[-1], (max(height // 2, 1), max(width // 2, 1))))
    return levels


def _resized(level: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    return area_resample(level, size, lambda v: -np.cos(np.pi * v))


def glossy_levels(levels: list[np.ndarray]) -> list[np.ndarray]:
    """The environment as rough mirrors show it, seen straight on [karis2013, split sum].

    Level k holds the mean under a GGX lobe of alpha = GLOSSY_ALPHA 2^k. Its texels halve as the lobe doubles, so
    a lobe always covers some four of them and neither the poles nor the texels show.

    Parameters
    ----------
    levels : of `mip_levels`.

    Returns
    -------
    list of (h, 2 h, 3) float32, the first of GLOSSY_HEIGHT rows.
    """
    wanted = [level for level in levels if level.shape[0] >= GLOSSY_HEIGHT] or levels[:1]
    source = _resized(wanted[-1], (GLOSSY_HEIGHT, 2 * GLOSSY_HEIGHT))
    found = []
    for k in range(GLOSSY_LEVELS):
        height = GLOSSY_HEIGHT >> k
        source = _resized(source, (height, 2 * height))
        found.append(_lobe_means(source, GLOSSY_ALPHA * 2**k).astype(np.float32))
    return found


def _lobe_means(pixels: np.ndarray, alpha: float) -> np.ndarray:
    """Mean under the lobe D(h) max(n.l, 0) about each texel's direction; its azimuth by Fourier transform."""
    height, width = pixels.shape[:2]
    theta = np.pi * (np.arange(height) + 0.5) / height
    turn = 2.0 * np.pi * np.arange(width) / width
    along, across = np.outer(np.cos(theta), np.cos(theta)), np.outer(np.sin(theta), np.sin(theta))
    cosine = along[..., None] + across[..., None] * np.cos(turn)
    lobe = np.maximum(cosine, 0.0) / (0.5 * (1.0 + cosine) * (alpha**2 - 1.0) + 1.0) ** 2
    lobe *= row_solid_angles(height)[:, None]
    lobe /= lobe.sum(axis=(1, 2), keepdims=True)
    spectrum = np.einsum("ijm,jmc->imc", np.fft.rfft(lobe, axis=2), np.fft.rfft(pixels, axis=1))
    return np.maximum(np.fft.irfft(spectrum, n=width, axis=1), 0.0)


def irradiance_sh(pixels: np.ndarray) -> np.ndarray:
    """Irradiance of an environment as nine coefficients [ramamoorthi2001, eqs. 5, 7, 8].

    The basis functions are integrated exactly over each texel, so a constant environment is exact.

    Parameters
    ----------
    pixels : (H, W, 3) radiance, row 0 towards +Y, centre column towards -Z.

    Returns
    -------
    (9, 3) float64 `c` with ``E(n) = sum(c[k] * basis(n)[k])`` in the unit of the radiance times sr;
    see `irradiance_basis`.
    """
    height, width = pixels.shape[:2]
    polar, azimuth = _polar_integrals(height), _azimuth_integrals(width)
    moments = np.zeros((9, 3))
    for start in range(0, height, 64):  # whole large images in float64 would not fit comfortably
        rows = slice(start, start + 64)
        columns = np.einsum("hwc,kw->khc", pixels[rows].astype(np.float64), azimuth)
        moments += np.einsum("kh,khc->kc", polar[:, rows], columns)
    return moments * (_NORM**2 * _COSINE_LOBE)[:, None]


def irradiance_basis(normal: np.ndarray) -> np.ndarray:
    """The polynomials of `irradiance_sh` for unit normals: (N, 3) to (N, 9)."""
    x, y, z = np.moveaxis(np.asarray(normal, np.float64), -1, 0)
    return np.stack([np.ones_like(x), x, y, z, x * y, y * z, x * z, 3 * y * y - 1, x * x - z * z], -1)


# Normalisation of the real spherical harmonics of order 0, 1, 2 on the polynomials of irradiance_basis, and
# the weights of the clamped cosine [ramamoorthi2001, eqs. 3, 8].
_NORM = np.sqrt(np.array([1, 3, 3, 3, 15, 15, 15, 5 / 4, 15 / 4]) / (4 * np.pi))
_COSINE_LOBE = np.array([np.pi] + [2 * np.pi / 3] * 3 + [np.pi / 4] * 5)


def _polar_integrals(height: int) -> np.ndarray:
    """Integrals over each row of the polar factor of each basis polynomial, sine included: (9, height)."""
    theta = np.linspace(0.0, np.pi, height + 1)
    c, s = np.cos(theta), np.sin(theta)
    primitive = {
        "1": -c,
        "sin": 0.5 * (theta - s * c),
        "cos": 0.5 * s * s,
        "sin cos": s**3 / 3,
        "sin2": c**3 / 3 - c,
        "3cos2-1": c - c**3,
    }
    kinds = ["1", "sin", "cos", "sin", "sin cos", "sin cos", "sin2", "3cos2-1", "sin2"]
    return np.stack([np.diff(primitive[kind]) for kind in kinds])


def _azimuth_integrals(width: int) -> np.ndarray:
    """Integrals over each column of the azimuth factor; x = sin(phi), z = -cos(phi): (9, width)."""
    phi = np.linspace(-np.pi, np.pi, width + 1)
    one, x, z = phi, -np.cos(phi), -np.sin(phi)
    xz, xx_zz = 0.25 * np.cos(2 * phi), -0.5 * np.sin(2 * phi)
    return np.stack([np.diff(f) for f in (one, x, one, z, x, z, xz, one, xx_zz)])
