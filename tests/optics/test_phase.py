"""The phase function by quadrature over the sphere."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.optics import henyey_greenstein

NODES, WEIGHTS = np.polynomial.legendre.leggauss(200)


@pytest.mark.parametrize("g", [-0.8, -0.3, 0.0, 0.5, 0.9])
def test_it_integrates_to_one_with_mean_cosine_g(g: float) -> None:
    # Gauss-Legendre converges like |g|^(2 nodes): exact to rounding here.
    values = 2 * np.pi * henyey_greenstein(NODES, g)
    assert values @ WEIGHTS == pytest.approx(1.0, abs=1e-12)
    assert (values * NODES) @ WEIGHTS == pytest.approx(g, abs=1e-12)


def test_isotropic_is_one_over_the_sphere() -> None:
    np.testing.assert_allclose(henyey_greenstein([-1.0, 0.2, 1.0], 0.0), 1 / (4 * np.pi), rtol=1e-15)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_peaks_do_not_cancel(side: float) -> None:
    g = 1 - 1e-9
    peak = henyey_greenstein(side, side * g)
    assert peak == pytest.approx((1 + g) / (4 * np.pi * (1 - g) ** 2), rel=1e-12)
