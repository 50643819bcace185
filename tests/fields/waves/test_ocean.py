"""The open sea against its spectrum and the dispersion relation."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.fields.dynamic import DynamicHeights
from pellucid.fields.waves import Ocean, dispersion, spectra
from pellucid.fields.waves.eulerian import grid_origins
from pellucid.fields.waves.source import bilinear


def sea(**options: Any) -> Ocean:
    return Ocean(**({"wind_m_s": 9.0, "tile_m": 120.0, "shape": (64, 64), "choppiness": 0.0} | options))


def test_an_ocean_is_dynamic_heights() -> None:
    ocean = sea(tile_m=(120.0, 60.0), shape=(32, 64))
    assert isinstance(ocean, DynamicHeights) and ocean.periodic and ocean.tile_m == (120.0, 60.0)
    heights = ocean.advance(1.0)
    assert heights.dtype == np.float32 and heights.shape == (32, 64) and abs(float(heights.mean())) < 1e-5
    low, high = ocean.limits_m
    assert low < heights.min() and heights.max() < high


def test_the_steepest_slope_is_that_of_one_cell() -> None:
    """Extremes of so many normal numbers spread by a sixth round what is expected once."""
    ocean = sea(shape=(128, 128))
    found = [np.hypot(*np.moveaxis(ocean.surface(4.0 * n).slopes, -1, 0)) for n in range(16)]
    assert np.mean([slopes.max() for slopes in found]) == pytest.approx(ocean.steepest, rel=0.08)
    assert 2 < np.mean([(slopes > 0.85 * ocean.steepest).sum() for slopes in found]) < 40
    assert sea(wind_m_s=0.0).steepest == 0.0


@pytest.mark.parametrize("spectrum", spectra.SPECTRA)
def test_the_variance_of_heights_is_that_of_the_spectrum(spectrum: str) -> None:
    """Mean over 64 seeds. A tile's mean square is a sum of chi-squared numbers: its own spread gives the tolerance."""
    depth = 12.0 if spectrum == "tma" else np.inf
    given = {"spectrum": spectrum, "depth_m": depth, "tile_m": 200.0}
    squares = np.array([float(np.square(sea(seed=n, **given).advance(3.0)).mean()) for n in range(64)])
    wanted = sea(**given).variance_m2
    assert squares.mean() == pytest.approx(wanted, abs=4.0 * squares.std(ddof=1) / 8.0)


@pytest.mark.parametrize("spectrum", spectra.SPECTRA)
@pytest.mark.parametrize("spreading", spectra.SPREADINGS)
def test_a_lattice_that_holds_all_waves_sums_up_to_the_integral(spectrum: str, spreading: str) -> None:
    depth = 20.0 if spectrum == "tma" else np.inf
    ocean = sea(spectrum=spectrum, spreading=spreading, depth_m=depth, tile_m=600.0, shape=(360, 360), wind_deg=20.0)
    assert ocean.variance_m2 == pytest.approx(spectra.variance(9.0, spectrum, depth_m=depth), rel=0.02)


def test_significant_heights_are_those_of_the_sources() -> None:
    """0.21 U^2/g of a sea that has grown out [pierson1964]; A L^2 / 4 of Phillips' spectrum, in closed form."""
    grown = 4.0 * spectra.variance(10.0, "pierson-moskowitz") ** 0.5
    assert grown == pytest.approx(0.21 * (1.026 * 10.0) ** 2 / 9.81, rel=0.01)
    assert spectra.variance(7.0, "phillips") == pytest.approx(0.0081 * (49.0 / 9.81) ** 2 / 4.0, rel=1e-3)
    assert spectra.variance(9.0, "tma", depth_m=5.0) < 0.5 * spectra.variance(9.0, "jonswap")
    assert spectra.variance(9.0, "tma", depth_m=1e4) == pytest.approx(spectra.variance(9.0, "jonswap"), rel=1e-6)


def test_spreadings_integrate_to_one() -> None:
    theta = np.linspace(-np.pi, np.pi, 4001)
    for name in spectra.SPREADINGS:
        for share in (0.5, 1.0, 2.0, 5.0):
            density = spectra.spreading(np.full_like(theta, share * 0.8), theta, 0.8, 10.0, name)
            assert np.trapezoid(density, theta) == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize("depth", [np.inf, 3.0])
@pytest.mark.parametrize(("rows", "columns"), [(0, 2), (3, 4)])
def test_one_wave_travels_at_its_phase_speed(rows: int, columns: int, depth: float) -> None:
    """The phase of its coefficient over 10 s against omega^2 = g k tanh(k d), from outside of the class."""
    ocean = sea(tile_m=40.0, spectrum="tma", depth_m=depth, spreading="cosine", wind_deg=30.0)
    times = np.linspace(0.0, 10.0, 201)
    values = [np.fft.fft2(ocean.advance(t).astype(float))[rows, columns] for t in times]
    # Nothing runs against the wind, so the coefficient is that of one wave alone.
    turned = np.unwrap(np.angle(values))[-1] - np.angle(values[0])
    k = 2.0 * np.pi * np.hypot(rows, columns) / 40.0
    wanted = np.sqrt(9.81 * k * np.tanh(k * min(depth, 1e3)))
    assert -turned / 10.0 == pytest.approx(wanted, rel=1e-3)


def test_speeds_of_short_and_long_waves() -> None:
    assert dispersion.phase_speed(1e-3, 4.0) == pytest.approx(np.sqrt(9.81 * 4.0), rel=1e-5)
    k = np.geomspace(10.0, 3000.0, 4000)
    slowest = k[np.argmin(dispersion.phase_speed(k))]
    assert 2.0 * np.pi / slowest == pytest.approx(0.0171, rel=0.01)  # known of clean water
    for depth in (0.5, np.inf):
        k = np.array([0.3, 2.0, 40.0])
        slope = np.gradient(dispersion.angular_frequency(np.array([k * 0.999, k, k * 1.001]), depth), axis=0)[1]
        np.testing.assert_allclose(slope / (0.001 * k), dispersion.group_speed(k, depth), rtol=1e-5)
        np.testing.assert_allclose(spectra.wave_number(dispersion.angular_frequency(k, depth), depth), k, rtol=1e-9)


def test_slopes_are_derivatives_of_heights() -> None:
    ocean = sea(wind_deg=70.0)
    found = ocean.surface(2.0)
    k = 2.0 * np.pi * np.fft.fftfreq(64, 120.0 / 64)
    spectrum = np.fft.fft2(found.heights.astype(float))
    along_x = np.fft.ifft2(1j * k[None, :] * spectrum).real
    along_z = np.fft.ifft2(1j * k[:, None] * spectrum).real
    np.testing.assert_allclose(found.slopes[..., 0], along_x, atol=2e-5)
    np.testing.assert_allclose(found.slopes[..., 1], along_z, atol=2e-5)
    xx, xz, zz = ocean.slope_variance
    mean = [np.mean([np.square(sea(seed=n, wind_deg=70.0).surface(0.0).slopes).mean((0, 1)) for n in range(48)], 0)]
    np.testing.assert_allclose(mean[0], (xx, zz), rtol=0.05)
    assert xz > 0.0 and zz > xx  # the wind blows mostly along z


def test_choppy_slopes_belong_to_their_heights() -> None:
    """Against differences over two cells, which lose as much of the shortest waves where nothing is moved sideways."""
    errors = []
    for choppiness in (0.0, 1.0):
        ocean = sea(choppiness=choppiness, tile_m=40.0, shape=(256, 256), wind_m_s=3.0)
        found = ocean.surface(1.0)
        difference = (np.roll(found.heights, -1, 1) - np.roll(found.heights, 1, 1)) / (2.0 * ocean.cell[0])
        open_water = np.full(ocean.shape, True) if found.fold is None else found.fold > 0.4
        errors.append(np.sqrt(np.square(difference - found.slopes[..., 0])[open_water].mean()) / found.slopes.std())
        assert open_water.mean() > 0.98
    assert errors[1] < 1.25 * errors[0]


def test_choppy_waves_have_narrow_crests_and_wide_troughs() -> None:
    """Over places heights count with the Jacobian 1 - c |k| h: their mean is -c sum of power |k|, to third order.

    Look-ups between cells smooth the shortest waves, which have 17 % of that sum here.
    """
    seas = [sea(choppiness=1.0, seed=n, wind_m_s=6.0) for n in range(24)]
    k = 2.0 * np.pi * np.fft.fftfreq(64, 120.0 / 64)
    power = spectra.vector_spectrum(k[None, :], k[:, None], 6.0) * (2.0 * np.pi / 120.0) ** 2
    power[32], power[:, 32] = 0.0, 0.0
    wanted = -float((power * np.hypot(k[None, :], k[:, None])).sum())
    means = np.array([float(one.advance(0.0).mean(dtype=np.float64)) for one in seas])
    assert means.mean() == pytest.approx(wanted, rel=0.2)
    found = seas[0].surface(0.0)
    assert found.fold is not None and np.corrcoef(found.fold.ravel(), found.heights.ravel())[0, 1] < -0.5


@pytest.mark.parametrize(("size", "enough"), [(1.0, 0.03), (0.19, 0.002)])
def test_the_way_back_ends_where_it_should(size: float, enough: float) -> None:
    """x0 + D(x0) = x, in cells: for smooth moves that halve the water at crests, and for those of less than a cell."""
    at = 2.0 * np.pi * np.arange(64) / 64
    cell_m, zero = (1.0, 2.0), np.zeros((64, 64), np.float32)
    reach_x, reach_z = size * 0.5 * 64 / (2.0 * np.pi), size * 0.3 * 64 / (2.0 * np.pi)
    move_x = (reach_x * np.sin(at)[None, :] * cell_m[0] + zero).astype(np.float32)
    move_z = (reach_z * np.cos(at)[:, None] * cell_m[1] + zero).astype(np.float32)
    bent = (size * 0.5 * np.cos(at)[None, :] + zero, -size * 0.3 * np.sin(at)[:, None] + zero, zero)
    assert (max(reach_x, reach_z) < 1.0) == (size < 1.0)
    column, row = grid_origins(move_x, move_z, cell_m, bent)
    moved_x, moved_z = bilinear([move_x, move_z], column, row, True)
    np.testing.assert_allclose(column + moved_x / cell_m[0] - np.arange(64), 0.0, atol=enough)
    np.testing.assert_allclose(row + moved_z / cell_m[1] - np.arange(64)[:, None], 0.0, atol=enough)


def test_small_moves_that_twist_are_turned_round() -> None:
    """Of waves that run aslant, whose moves along one axis change along the other; cells are not square."""
    cell_m, reach = (1.0, 1.5), np.float32(0.9)
    k = 2.0 * np.pi * np.array([3 / 64, 2 / 72])
    phase = k[0] * np.arange(64) * cell_m[0] + k[1] * np.arange(48)[:, None] * cell_m[1]
    length = float(np.hypot(*k))
    move_x, move_z = ((reach * k_ / length * np.sin(phase)).astype(np.float32) for k_ in k)
    xx, zz, xz = (reach * a * b / length * np.cos(phase) for a, b in ((k[0], k[0]), (k[1], k[1]), (k[0], k[1])))
    column, row = grid_origins(move_x, move_z, cell_m, (xx, zz, xz))
    moved_x, moved_z = bilinear([move_x, move_z], column, row, True)
    # The first step leaves what moves bend over its length, and between cells; the second, a share of that which is
    # by how much the gradient changes on the way.
    bend, least = float(reach) * length**2, 1.0 - float(reach) * length
    enough = bend * (0.5 * float(reach) ** 2 + 0.125) * bend * (float(reach) + 1.0) / least
    np.testing.assert_allclose(column + moved_x / cell_m[0] - np.arange(64), 0.0, atol=enough)
    np.testing.assert_allclose(row + moved_z / cell_m[1] - np.arange(48)[:, None], 0.0, atol=enough)
    assert float(np.abs(move_x).max()) > 40.0 * enough


def test_places_are_looked_up_part_by_part() -> None:
    """More places than are looked up at once, in every shape that they come in, against one at a time."""
    planes = list(np.random.default_rng(3).normal(size=(2, 24, 40)).astype(np.float32))
    column, row = np.linspace(-50.0, 90.0, 900, dtype=np.float32), np.linspace(-30.0, 60.0, 70, dtype=np.float32)
    grid = bilinear(planes, column, row[:, None], True)
    flat = bilinear(planes, *(a.reshape(-1) for a in np.broadcast_arrays(column, row[:, None])), True)
    for plane, one, other in zip(planes, grid, flat, strict=True):
        assert one.shape == (70, 900)
        np.testing.assert_array_equal(one.reshape(-1), other)
        for j, i in ((0, 0), (33, 450), (69, 899)):
            np.testing.assert_array_equal(bilinear([plane], column[i], row[j], True)[0], one[j, i])
    assert bilinear(planes, column[:0], row[:0], True)[0].shape == (0,)


def test_a_finer_grid_only_adds_shorter_waves() -> None:
    coarse, fine = (np.fft.rfft2(sea(shape=(n, n)).advance(1.0)) / n**2 for n in (32, 64))
    # Coefficients refer to the first cell, which lies half a cell from the border of the tile.
    at = np.arange(1, 12)
    turn = np.exp(-1j * np.pi * at * (1 / 32 - 1 / 64))
    np.testing.assert_allclose(coarse[0, at], fine[0, at] * np.conj(turn), atol=1e-5)


def test_time_goes_anywhere_and_seeds_differ() -> None:
    ocean = sea(choppiness=1.0)
    ocean.advance(9.0)
    np.testing.assert_array_equal(ocean.advance(5.0), sea(choppiness=1.0).advance(5.0))
    assert np.abs(sea(seed=1).advance(5.0) - sea(seed=2).advance(5.0)).max() > 0.1
    assert ocean.surface(5.0) is ocean.surface(5.0)
    looped = sea(loop_s=8.0)
    np.testing.assert_allclose(looped.advance(11.0), looped.advance(3.0), atol=1e-4)


def test_no_wind_and_no_amplitude_give_flat_water() -> None:
    for ocean in (sea(wind_m_s=0.0, level_m=0.5), sea(amplitude=0.0, level_m=0.5)):
        found = ocean.surface(7.0)
        assert (found.heights == 0.5).all() and not found.slopes.any()
        assert ocean.limits_m == (0.5, 0.5) and ocean.short_slopes == (0.0, 0.0, 0.0)


def test_all_slopes_together_are_those_that_were_measured() -> None:
    ocean = sea(wind_deg=0.0)
    total = np.array(ocean.short_slopes) + ocean.slope_variance
    assert total[[0, 2]] == pytest.approx((3.16e-3 * 9.0, 0.003 + 1.92e-3 * 9.0))


def test_tiles_of_a_cascade_divide_the_spectrum() -> None:
    """Their variances add up to the integral, their slopes to what was measured, with nothing counted twice."""
    tiles = Ocean.cascade(6.0, 20.0, (150.0, 40.0, 12.0), shape=(128, 128), choppiness=0.0)
    layers = [layer for layer in tiles.layers if isinstance(layer, Ocean)]
    assert [layer.longest_m for layer in layers[1:]] == [layer.shortest_m for layer in layers[:-1]]
    assert sum(layer.variance_m2 for layer in layers) == pytest.approx(spectra.variance(6.0), rel=0.03)
    c, s = np.cos(np.radians(20.0)), np.sin(np.radians(20.0))
    total = np.array(tiles.short_slopes) + np.sum([layer.slope_variance for layer in layers], axis=0)
    along, across = spectra.slope_variance(6.0)
    assert total[[0, 2]] == pytest.approx((along * c * c + across * s * s, along * s * s + across * c * c), rel=0.02)
    with pytest.raises(SceneError, match=r"^tiles_m: "):
        Ocean.cascade(6.0, tiles_m=(100.0, 3.0), shape=(128, 128))
    with pytest.raises(SceneError, match=r"^tiles_m: "):
        Ocean.cascade(6.0, tiles_m=(100.0, 200.0), shape=(128, 128))
    with pytest.raises(SceneError, match=r"^shortest_m: "):
        sea(shortest_m=5.0, longest_m=4.0)


@pytest.mark.parametrize(
    ("options", "field"),
    [({"wind_m_s": -1.0}, "wind_m_s"), ({"wind_m_s": np.nan}, "wind_m_s"), ({"wind_deg": np.inf}, "wind_deg"),
     ({"tile_m": 0.0}, "tile_m"), ({"tile_m": -5.0}, "tile_m"), ({"tile_m": (1.0, 2.0, 3.0)}, "tile_m"),
     ({"shape": (63, 64)}, "shape"), ({"shape": (65536, 65536)}, "shape"), ({"shape": 64}, "shape"),
     ({"spectrum": "swell"}, "spectrum"), ({"spreading": "none"}, "spreading"), ({"fetch_m": 0.0}, "fetch_m"),
     ({"depth_m": 3.0}, "depth_m"), ({"depth_m": 0.0, "spectrum": "tma"}, "depth_m"), ({"seed": 1.5}, "seed"),
     ({"choppiness": -0.1}, "choppiness"), ({"loop_s": 0.0}, "loop_s"), ({"amplitude": np.nan}, "amplitude")],
)  # fmt: skip
def test_parameters_are_checked(options: dict[str, Any], field: str) -> None:
    with pytest.raises(SceneError, match=rf"^{field}: "):
        sea(**options)
    for time in (-1.0, np.nan):
        with pytest.raises(SceneError, match=r"^time_s: "):
            sea(shape=(8, 8)).advance(time)
