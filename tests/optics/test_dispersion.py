"""Dispersion formulas against catalogue values."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.optics import RGB_LAMBDA_NM, abbe_number, cauchy, cauchy_from_abbe, sellmeier
from pellucid.optics.dispersion import LAMBDA_C_NM, LAMBDA_D_NM, LAMBDA_F_NM

# Schott data sheet of N-BK7: coefficients, then n_d, n_F, n_C, V_d
N_BK7 = (1.03961212, 0.231792344, 1.01046945), (0.00600069867, 0.0200179144, 103.560653)


def test_sellmeier_gives_the_indices_of_the_data_sheet() -> None:
    n_d, n_f, n_c = sellmeier([LAMBDA_D_NM, LAMBDA_F_NM, LAMBDA_C_NM], *N_BK7)
    np.testing.assert_allclose([n_d, n_f, n_c], [1.51680, 1.52238, 1.51432], atol=5e-6)
    assert abbe_number(n_d, n_f, n_c) == pytest.approx(64.17, abs=0.005)


@pytest.mark.parametrize(("n_d", "abbe"), [(1.5168, 64.17), (1.9229, 20.88), (1.333, 55.8)])
def test_cauchy_from_abbe_has_the_index_and_the_abbe_number_it_was_made_from(n_d: float, abbe: float) -> None:
    lines = cauchy([LAMBDA_D_NM, LAMBDA_F_NM, LAMBDA_C_NM], *cauchy_from_abbe(n_d, abbe))
    assert lines[0] == pytest.approx(n_d, rel=1e-14)
    assert abbe_number(*lines) == pytest.approx(abbe, rel=1e-12)


def test_the_cauchy_of_a_crown_follows_it_at_the_rendered_wavelengths() -> None:
    np.testing.assert_allclose(
        cauchy(RGB_LAMBDA_NM, *cauchy_from_abbe(1.5168, 64.17)), sellmeier(RGB_LAMBDA_NM, *N_BK7), atol=3e-4
    )
