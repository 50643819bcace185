"""Natural waters against the tables of their sources."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from pellucid import media
from pellucid.errors import SceneError
from pellucid.media import waters
from pellucid.media.medium import RGB_LAMBDA_NM

# Smith and Baker 1981 as NASA's table of water coefficients interpolates it: twice the backscattering of sea water, 1/m
SEA_WATER = [(410.0, 0.0067903), (443.0, 0.0048724), (490.0, 0.0031645), (555.0, 0.0018591), (670.0, 0.0008340)]

# Solonenko and Mobley 2015: type, nm, absorption, scattering, 1/m
JERLOV = [
    ("I", 475.0, 0.019, 0.00306),
    ("IB", 500.0, 0.0287, 0.0597),
    ("II", 550.0, 0.0622, 0.358),
    ("III", 425.0, 0.0449, 1.52),
    ("1C", 600.0, 0.236, 0.314),
    ("3C", 650.0, 0.346, 0.800),
    ("9C", 400.0, 1.613, 5.36),
]


@pytest.mark.parametrize(("lambda_nm", "expected"), SEA_WATER)
def test_molecules_scatter_as_tabulated(lambda_nm: float, expected: float) -> None:
    assert media.get("pure sea water").scattering(lambda_nm) == pytest.approx(expected, rel=0.03)
    # Salt adds 30 %: Morel 1974
    assert media.get("pure water").scattering(lambda_nm) == pytest.approx(expected / 1.30, rel=0.03)


@pytest.mark.parametrize(("lambda_nm", "expected"), [(420, 0.00454), (490, 0.0150), (555, 0.0596), (670, 0.439)])
def test_pure_water_absorbs_as_pope_and_fry_measured(lambda_nm: float, expected: float) -> None:
    assert media.get("pure water").absorption(lambda_nm) == pytest.approx(expected, rel=1e-9)


def test_both_waters_of_the_catalogue_have_one_colour() -> None:
    np.testing.assert_allclose(
        media.get("pure water").absorption_rgb_per_m, media.get("water").absorption_rgb_per_m, rtol=0.015
    )


@pytest.mark.parametrize(("kind", "lambda_nm", "absorption", "scattering"), JERLOV)
def test_types_of_jerlov_are_those_of_the_table(
    kind: str, lambda_nm: float, absorption: float, scattering: float
) -> None:
    water = media.get(f"Jerlov {kind}")
    assert water.absorption(lambda_nm) == pytest.approx(absorption, rel=1e-9)
    assert water.scattering(lambda_nm) == pytest.approx(scattering, rel=1e-9)


def test_every_type_of_jerlov_is_murkier_than_the_one_before() -> None:
    for types in (waters.JERLOV_TYPES[:5], waters.JERLOV_TYPES[5:]):
        bodies = [media.get(f"Jerlov {t}") for t in types]
        nm = np.linspace(400.0, 700.0, 61)
        for clear, murky in pairwise(bodies):
            assert np.all(murky.absorption(nm) > clear.absorption(nm) * 0.997), (clear.name, murky.name)
            assert np.all(murky.scattering(nm) > clear.scattering(nm))


def test_the_model_of_plankton_begins_with_pure_water_and_grows_with_chlorophyll() -> None:
    # a_440 of 1 mg/m3: (0.00635 + 0.06) 1.2; b_550 of 1 mg/m3: 0.30
    assert waters.plankton_absorption(440.0, 1.0) == pytest.approx(0.07962, rel=1e-6)
    assert waters.particle_scattering(550.0, 1.0) == pytest.approx(0.30)
    assert waters.plankton_absorption(440.0, 1e-12) == pytest.approx(1.2 * 0.00635, rel=1e-4)
    assert waters.dissolved_absorption(490.0, 1.0) == pytest.approx(np.exp(-0.7))


def test_what_a_diver_sees_last_turns_from_blue_to_green_to_brown() -> None:
    """The channel that reaches deepest, and the colour that is gone first."""
    deepest = {name: int(np.argmin(media.get(name).absorption_rgb_per_m)) for name in ("clear ocean", "lake", "pond")}
    assert deepest == {"clear ocean": 2, "lake": 1, "pond": 1}
    assert np.argmax(media.get("pond").absorption_rgb_per_m) == 2


@pytest.mark.parametrize("water", waters.MEDIA, ids=lambda water: water.name)
def test_every_water_is_usable(water: media.WaterBody) -> None:
    assert media.get(water.name) is water
    np.testing.assert_allclose(water.absorption(RGB_LAMBDA_NM), water.absorption_rgb_per_m, rtol=1e-12)
    nm = np.linspace(400.0, 700.0, 301)
    assert np.all(water.absorption(nm) > 0.0) and np.all(water.scattering(nm) > 0.0)
    assert np.all(np.abs(water.mean_cosine(nm)) < 0.93) and 0.0 <= water.asymmetry < 0.93
    with pytest.raises(SceneError, match="400 to 700 nm"):
        water.scattering(710.0)


def test_molecules_scatter_evenly_and_particles_forwards() -> None:
    assert media.get("pure water").asymmetry == 0.0
    assert 0.88 < media.get("clear ocean").asymmetry < 0.91
    assert media.get("pond").asymmetry == pytest.approx(0.924, abs=2e-3)
    assert media.get("N-BK7").asymmetry == 0.0 and not media.get("N-BK7").scattering_rgb_per_m.any()


def test_a_liquid_of_ones_own() -> None:
    milk = media.water_body((0.1, 0.2, 0.6), (800.0, 900.0, 1000.0), 0.8, name="milk")
    np.testing.assert_allclose(milk.absorption_rgb_per_m, (0.1, 0.2, 0.6))
    np.testing.assert_allclose(milk.scattering_rgb_per_m, (800.0, 900.0, 1000.0))
    assert milk.asymmetry == pytest.approx(0.8) and milk.n_d == media.get("water").n_d and milk.name == "milk"
    green = media.get("pond").with_absorption((3.0, 1.0, 3.0))
    assert isinstance(green, media.WaterBody) and green.asymmetry == pytest.approx(media.get("pond").asymmetry, 1e-3)
    np.testing.assert_allclose(green.absorption(RGB_LAMBDA_NM), (3.0, 1.0, 3.0))
    np.testing.assert_allclose(green.scattering_rgb_per_m, media.get("pond").scattering_rgb_per_m)


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"scattering_rgb_per_m": (1.0, -1.0, 0.0)}, "scattering_rgb_per_m"),
        ({"absorption_rgb_per_m": (1.0, 2.0)}, "absorption_rgb_per_m"),
        ({"asymmetry": 1.0}, "asymmetry"),
        ({"base": "watr"}, "base"),
    ],
)
def test_what_is_wrong_is_named(changes: dict, field: str) -> None:
    with pytest.raises(SceneError) as caught:
        media.water_body(**changes)
    assert caught.value.field == field
