"""Light of normally distributed slopes: closed forms against sums over facets, energy, and the twins."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from pellucid.optics import rough_water as rough
from pellucid.optics.snell import refract

if TYPE_CHECKING:
    from pellucid.gpu import Device

VARIANCE = np.array([0.02, 0.01, 0.006])
SLOPE = np.array([0.1, -0.05])


def facets(count: int = 400_000, seed: int = 1) -> np.ndarray:
    covariance = np.array([[VARIANCE[0], VARIANCE[2]], [VARIANCE[2], VARIANCE[1]]])
    return np.random.default_rng(seed).multivariate_normal(SLOPE, covariance, count)


def direction(elevation_deg: float, azimuth_deg: float) -> np.ndarray:
    e, a = np.radians((elevation_deg, azimuth_deg))
    return np.array([np.cos(e) * np.cos(a), np.sin(e), np.cos(e) * np.sin(a)])


@pytest.mark.parametrize("elevation", [2.0, 8.0, 30.0, 85.0])
def test_what_is_seen_of_facets(elevation: float) -> None:
    """Area and mean slope against a sum over facets."""
    view = direction(elevation, 30.0)
    s = facets()
    area = np.maximum(view[1] - s @ view[::2], 0.0)
    spread = area.std() / np.sqrt(len(s))
    assert rough.visible_area(view, SLOPE, VARIANCE) == pytest.approx(area.mean(), abs=4.0 * spread)
    mean = (s * area[:, None]).sum(0) / area.sum()
    np.testing.assert_allclose(rough.visible_slope(view, SLOPE, VARIANCE), mean, atol=2e-3)


def test_the_share_below_is_the_normal_distribution() -> None:
    from scipy.special import ndtr

    a = np.linspace(-8.0, 8.0, 1001)
    np.testing.assert_allclose(rough.gaussian_below(a), ndtr(a), atol=1.5e-7)


def sphere(count: int = 1500) -> tuple[np.ndarray, np.ndarray]:
    """Directions of a hemisphere and their solid angles."""
    y, a = (np.arange(count // 2) + 0.5) / (count // 2), (np.arange(count) + 0.5) * 2.0 * np.pi / count
    r = np.sqrt(1.0 - y * y)
    d = np.stack([r[:, None] * np.cos(a), np.broadcast_to(y[:, None], (len(y), count)), r[:, None] * np.sin(a)], -1)
    return d.reshape(-1, 3), np.full(d[..., 0].size, 4.0 * np.pi / count**2)


@pytest.mark.parametrize("elevation", [35.0, 80.0])
def test_mirrored_light_is_kept(elevation: float) -> None:
    """Over all viewers, radiance times the area seen is the light that falls on facets that face it: E l_y."""
    light = direction(elevation, 200.0)
    views, angles = sphere()
    sent = rough.glint(views, light, SLOPE, VARIANCE, 1.0, 1.0) * rough.visible_area(views, SLOPE, VARIANCE)
    # A facet's own share of the light is l.h / h_y; what is mirrored downwards meets other waves.
    s = facets()
    normal = np.stack([-s[:, 0], np.ones(len(s)), -s[:, 1]], 1)
    facing = normal @ light
    mirrored_up = 2.0 * facing / (normal**2).sum(1) - light[1] > 0.0
    wanted = np.where((facing > 0.0) & mirrored_up, facing, 0.0).mean()
    assert (sent * angles).sum() == pytest.approx(wanted, rel=3e-3)


def test_refracted_light_is_kept() -> None:
    """From below all of it arrives, within the cone of Snell's law."""
    light = direction(60.0, 200.0)
    views, angles = sphere(3000)
    views = views * (1.0, -1.0, 1.0)
    sent = rough.glint(views, light, SLOPE, VARIANCE, 1.333, 1.0) * rough.visible_area(-views, SLOPE, VARIANCE)
    s = facets()
    facing = light[1] - s @ light[::2]
    assert (sent * angles).sum() == pytest.approx(np.maximum(facing, 0.0).mean(), rel=3e-3)
    brightest = views[np.argmax(sent)]
    mean = np.array([-SLOPE[0], 1.0, -SLOPE[1]]) / np.sqrt(1.0 + SLOPE @ SLOPE)
    straight = refract(-light, mean, 1.0, 1.333).direction
    assert brightest @ straight == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize(("n_view", "side"), [(1.0, 1.0), (1.333, -1.0)])
def test_a_disc_of_light_spreads_facets(n_view: float, side: float) -> None:
    """Covariance of the facets of many points of a small disc, one by one."""
    light, view = direction(40.0, 10.0), direction(55.0, 150.0) * (1.0, side, 1.0)
    rng = np.random.default_rng(2)
    across = np.linalg.svd(light[None])[2][1:]
    angle, way = rng.uniform(0.0, 2.0 * np.pi, 100_000), 0.01 * np.sqrt(rng.uniform(0.0, 1.0, 100_000))
    points = light + way[:, None] * (np.cos(angle)[:, None] * across[0] + np.sin(angle)[:, None] * across[1])
    m = rough.facet_normal(view, points, n_view, 1.0)
    found = np.cov((-m[:, ::2] / m[:, 1:2]).T)
    wanted = rough.disc_variance(light, rough.facet_normal(view, light, n_view, 1.0), 0.01, 1.0)
    np.testing.assert_allclose(wanted, (found[0, 0], found[1, 1], found[0, 1]), rtol=0.03, atol=1e-7)


def test_a_mirror_shows_the_lamp_where_it_is() -> None:
    """Nearly flat water: the radiance integrates over the picture of the lamp to its irradiance."""
    light = direction(50.0, 0.0)
    middle = light * (-1.0, 1.0, 1.0)
    variance = rough.disc_variance(light, rough.facet_normal(middle, light, 1.0, 1.0), 0.01, 1.0)
    side = np.linspace(-0.05, 0.05, 401)
    across = np.linalg.svd(middle[None])[2][1:]
    views = middle + side[:, None, None] * across[0] + side[None, :, None] * across[1]
    views /= np.linalg.norm(views, axis=-1, keepdims=True)
    seen = rough.glint(views, light, np.zeros(2), variance, 1.0, 1.0)
    assert seen.sum() * (side[1] - side[0]) ** 2 == pytest.approx(1.0, rel=5e-3)


def test_twins(device: Device) -> None:
    from pellucid.gpu.probe import probe

    rng = np.random.default_rng(5)
    count = 500

    def unit(low: float, high: float) -> np.ndarray:
        y, a = rng.uniform(low, high, count), rng.uniform(0.0, 2.0 * np.pi, count)
        r = np.sqrt(1.0 - y * y)
        return np.stack([r * np.cos(a), y, r * np.sin(a)], 1).astype(np.float32).astype(float)

    view, light = unit(-1.0, 1.0), unit(0.1, 1.0)
    slope = rng.normal(0.0, 0.2, (count, 2)).astype(np.float32).astype(float)
    own = rng.uniform(0.005, 0.05, (count, 2))
    variance = np.column_stack([own, rng.uniform(-0.9, 0.9, count) * np.sqrt(own.prod(1))]).astype(np.float32)
    variance = variance.astype(float)
    one, water = np.ones(count), np.full(count, np.float32(1.333)).astype(float)
    offset = 0.5 * slope
    facet = rough.facet_normal(view, light, water, one)
    # Relative to the largest: densities of slopes far out are differences of large exponents.
    for name, given, bound in (
        ("slope_density", (offset, variance), 3e-5), ("gaussian_below", (slope[:, 0] * 20.0,), 3e-7),
        ("slope_spread", (view, variance), 1e-6), ("visible_area", (view, slope, variance), 1e-6),
        ("visible_slope", (np.abs(view), slope, variance), 2e-5), ("facet_normal", (view, light, water, one), 1e-6),
        ("disc_variance", (light, facet, 0.005 * one, one), 1e-4),
        ("glint", (view, light, slope, variance, water, one), 1e-4),
    ):  # fmt: skip
        wanted = getattr(rough, name)(*given)
        found = probe("optics/rough_water", name, *given, device=device)
        assert np.abs(found - wanted).max() <= bound * np.abs(wanted).max(), name
