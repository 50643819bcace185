"""Prints the polynomials of techniques/finish/shaders/agx_encoded.wgsl, and how far off they are."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.polynomial import Chebyshev, Polynomial

from pellucid.optics import srgb_encode

#: Where the straight part of sRGB ends [iec61966], on the scale of AgX, whose gamma is 2.2.
KNEE = 0.0031308 ** (1.0 / 2.2)
NODES = 4000
ROUNDS = 300

Array = np.ndarray


def smallest_error(curve: Callable[[Array], Array], low: float, high: float, degree: int) -> Polynomial:
    """Polynomial with about the smallest greatest error: least squares, weighted by the errors again and again."""
    t = np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
    wanted = curve(0.5 * (low + high) + 0.5 * (high - low) * t)
    powers, weights = np.polynomial.chebyshev.chebvander(t, degree), np.full(NODES, 1.0 / NODES)
    coefficients = np.zeros(degree + 1)
    for _ in range(ROUNDS):
        root = np.sqrt(weights)
        coefficients = np.linalg.lstsq(powers * root[:, None], wanted * root, rcond=None)[0]
        weights *= np.abs(powers @ coefficients - wanted)
        weights /= weights.sum()
    return Chebyshev(coefficients, domain=[low, high]).convert(kind=Polynomial)


def main() -> None:
    """Print highest powers first, as Horner's scheme takes them."""
    curves: dict[str, tuple[Callable[[Array], Array], float, float, int]] = {
        "log2": (np.log2, 1.0, 2.0, 4),
        "encoded, low": (lambda x: srgb_encode(x**2.2), 0.0, KNEE, 3),
        "encoded, high": (lambda x: srgb_encode(x**2.2), KNEE, 1.0, 7),
    }
    for name, (curve, low, high, degree) in curves.items():
        found = smallest_error(curve, low, high, degree)
        x = np.linspace(low, high, 100_001)[1:]
        print(f"{name}: {', '.join(f'{c:.8g}' for c in found.coef[::-1])}")
        print(f"  off by {np.abs(found(x) - curve(x)).max():.2g} from {low:.8g} to {high:.8g}")


if __name__ == "__main__":
    main()
