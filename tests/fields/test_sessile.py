"""Drops that lie on a plane: caps, volumes, gravity, and what touches."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.fields.sessile import CAPILLARY_LENGTH_M, cap_volume, check_angle, meniscus, merge, rims_of


@pytest.mark.parametrize("angle", [0.3, 1.0, 1.4])
def test_a_small_drop_is_a_spherical_cap_of_its_volume(angle: float) -> None:
    rim = 1e-4  # a volume of nanolitres: gravity takes less than 1e-4 of its height
    rho = (np.arange(4000) + 0.5) / 4000 * rim
    within = (rim**2 - rho**2) / (2 * rim)
    height = meniscus(within, np.full_like(rho, rim), angle)
    ball = rim / np.sin(angle)
    np.testing.assert_allclose(height, np.sqrt(ball**2 - rho**2) - ball * np.cos(angle), rtol=1e-4)
    volume = (2 * np.pi * rho * height).sum() * rim / 4000
    assert volume == pytest.approx(float(cap_volume(rim, angle)), rel=1e-4)


def test_a_hemisphere_has_two_thirds_pi() -> None:
    assert float(cap_volume(1.0, np.pi / 2)) == pytest.approx(2 * np.pi / 3)


def test_gravity_flattens_a_wide_drop_to_the_height_of_a_puddle() -> None:
    height = meniscus(np.array([0.5]), np.array([1.0]), 1.0)
    assert height[0] == pytest.approx(2 * CAPILLARY_LENGTH_M * np.sin(0.5), rel=1e-6)


def test_the_capillary_length_of_water() -> None:
    assert pytest.approx(2.73e-3, rel=0.002) == CAPILLARY_LENGTH_M  # [degennes2004, 2.2]: 2.7 mm


@pytest.mark.parametrize("angle", [0.4, 1.0, 1.4])
def test_rims_belong_to_volumes(angle: float) -> None:
    volumes = np.array([1e-12, 1e-9, 1e-8, 1e-7])
    rims = rims_of(volumes, angle)
    assert rims[0] == pytest.approx(np.cbrt(1e-12 / cap_volume(1.0, angle)), rel=2e-3)  # too small for gravity
    rho = (np.arange(2000) + 0.5) / 2000 * rims[:, None]
    heights = meniscus((rims[:, None] ** 2 - rho**2) / (2 * rims[:, None]), rims[:, None], angle)
    np.testing.assert_allclose((2 * np.pi * rho * heights).sum(axis=1) * rims / 2000, volumes, rtol=2e-3)


def test_drops_that_touch_keep_their_slope_at_the_rim_and_grow_a_neck() -> None:
    """F falls by a metre a metre where two rims were, away from the neck."""
    x, y = np.meshgrid(np.linspace(-4, 4, 401), np.linspace(-3, 3, 301))
    within, rim = np.full(x.shape, -9.0), np.full(x.shape, 1.0)
    for centre in (-1.05, 1.05):
        merge(within, rim, np.hypot(x - centre, y), 1.0, 0.6)
    assert within[150, 200] > 0.0  # 0.1 apart: joined
    slope = np.hypot(*np.gradient(within, 0.02))
    at_rim = (np.abs(within) < 0.02) & (np.abs(x) > 0.6)
    np.testing.assert_allclose(slope[at_rim], 1.0, atol=0.03)
    np.testing.assert_allclose(rim, 1.0)


@pytest.mark.parametrize("angle", [0.0, 90.0, np.nan, "steep", True])
def test_angles_are_checked(angle: object) -> None:
    with pytest.raises(SceneError, match=r"^angle_deg: "):
        check_angle("angle_deg", angle)
