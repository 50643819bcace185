"""Named media against published values."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from pellucid import media, optics
from pellucid.errors import SceneError
from pellucid.media.formulas import PowerSeries, Sellmeier

BIBLIOGRAPHY = Path(__file__).resolve().parents[2] / "docs" / "references.bib"

# n_d and V_d as printed on Schott's data sheets
SCHOTT = {
    "N-BK7": (1.51680, 64.17),
    "N-BAK4": (1.56883, 55.98),
    "N-K5": (1.52249, 59.48),
    "N-FK51A": (1.48656, 84.47),
    "N-PK52A": (1.49700, 81.61),
    "N-SK16": (1.62041, 60.32),
    "N-LAK9": (1.69100, 54.71),
    "N-LAK14": (1.69680, 55.41),
    "N-BAF10": (1.67003, 47.11),
    "N-KZFS4": (1.61336, 44.49),
    "F2": (1.62004, 36.37),
    "SF10": (1.72825, 28.41),
    "SF11": (1.78472, 25.76),
    "N-SF11": (1.78472, 25.68),
    "N-SF66": (1.92286, 20.88),
    "N-LASF9": (1.85025, 32.17),
}

# name, wavelength (nm), index, tolerance: half a unit of the last digit of the source, or the spread among sources
SPOTS = [
    ("fused silica", 587.56, 1.45846, 5e-6),  # Malitson 1965, Table I: 1.458464
    ("diamond", 589.3, 2.417, 1e-3),  # Peter 1923, and every handbook
    ("water", 589.3, 1.33299 * 1.000271, 5e-5),  # CRC Handbook, 20 C, against air; the source is against vacuum
    ("sea water", 589.3, 1.3394, 1e-4),  # CRC Handbook, 35 g/kg, 20 C
    ("calcite", 589.3, 1.6584, 1e-4),  # CRC Handbook
    ("quartz", 589.3, 1.5442, 1e-4),  # CRC Handbook
    ("sapphire", 589.3, 1.768, 5e-4),  # CRC Handbook
    ("rutile", 589.3, 2.613, 5e-3),  # DeVore 1951
    ("cubic zirconia", 589.3, 2.158, 5e-4),  # Wood & Nassau 1982
    ("fluorite", 587.56, 1.43385, 5e-6),  # Malitson 1963
    ("rock salt", 589.3, 1.5441, 1e-4),  # Li 1976
    ("ethanol", 589.3, 1.3611, 5e-4),  # CRC Handbook, 20 C
    ("acetone", 589.3, 1.3588, 2e-3),  # CRC Handbook, 20 C; the source measured at 22 C
    ("glycerol", 589.3, 1.4722, 1e-3),  # CRC Handbook, 25 C
    ("acrylic", 587.56, 1.4915, 1.5e-3),  # PMMA, data sheets 1.490-1.492
    ("polycarbonate", 587.56, 1.585, 1e-3),
    ("polystyrene", 587.56, 1.5915, 1.5e-3),
]

# the extraordinary rays
EXTRAORDINARY = [
    ("calcite", 589.3, 1.4864, 3e-4),  # CRC Handbook
    ("quartz", 589.3, 1.5533, 1e-4),  # CRC Handbook
    ("sapphire", 589.3, 1.760, 5e-4),  # CRC Handbook
    ("rutile", 589.3, 2.909, 5e-3),  # CRC Handbook: 2.616 and 2.903; DeVore 1951 has 2.909
    ("magnesium fluoride", 589.3, 1.38950, 2e-4),  # Dodge 1984, as quoted by makers: 1.38950 at 0.5893 um
    ("lithium niobate", 632.8, 2.2028, 1e-3),  # of congruent crystals, as quoted for the helium-neon laser
    ("ice", 589.3, 1.3105, 1e-4),  # Hobbs 1974
    ("tourmaline", 589.3, 1.624, 1e-3),
]

ABBE = [
    ("fused silica", 67.8, 0.1),
    ("diamond", 55.3, 0.2),
    ("water", 55.7, 0.2),
    ("fluorite", 95.0, 0.2),
    ("acrylic", 53.2, 4.5),  # published values spread from 52 to 58
    ("polycarbonate", 27.9, 2.0),
    ("polystyrene", 29.5, 1.5),
    ("air", 89.3, 0.3),
]


@pytest.mark.parametrize("name", SCHOTT)
def test_schott_glasses_have_the_index_and_abbe_number_of_their_data_sheets(name: str) -> None:
    glass = media.get(name)
    assert glass.n_d == pytest.approx(SCHOTT[name][0], abs=6e-6)
    assert glass.abbe == pytest.approx(SCHOTT[name][1], abs=0.006)


@pytest.mark.parametrize(("name", "lambda_nm", "expected", "tolerance"), SPOTS)
def test_published_indices(name: str, lambda_nm: float, expected: float, tolerance: float) -> None:
    assert media.get(name).n(lambda_nm) == pytest.approx(expected, abs=tolerance)


@pytest.mark.parametrize(("lambda_nm", "mean"), [(550.0, 1.3110), (450.0, 1.3157)])
def test_ice_has_the_mean_index_of_the_table(lambda_nm: float, mean: float) -> None:
    ice = media.get("ice")  # Warren & Brandt 2008; the fit is within 2.1e-4
    assert (2.0 * ice.n(lambda_nm) + ice.n_e(lambda_nm)) / 3.0 == pytest.approx(mean, abs=2.5e-4)


@pytest.mark.parametrize(("name", "lambda_nm", "expected", "tolerance"), EXTRAORDINARY)
def test_published_extraordinary_indices(name: str, lambda_nm: float, expected: float, tolerance: float) -> None:
    crystal = media.get(name)
    assert crystal.is_uniaxial and crystal.extraordinary is not None
    assert crystal.n_e(lambda_nm) == pytest.approx(expected, abs=tolerance)
    assert np.all(np.diff(crystal.n_e_rgb) > 0.0)


def test_an_isotropic_medium_has_one_index() -> None:
    glass = media.get("N-BK7")
    assert not glass.is_uniaxial
    np.testing.assert_array_equal(glass.n_e_rgb, glass.n_rgb)
    np.testing.assert_array_equal(glass.absorption_e_rgb_per_m, glass.absorption_rgb_per_m)
    with pytest.raises(SceneError, match="no extraordinary ray"):
        glass.with_absorption((1.0, 1.0, 1.0), extraordinary_rgb_per_m=(1.0, 1.0, 1.0))


def test_a_crystal_of_two_numbers_and_its_colours() -> None:
    crystal = media.uniaxial(1.7, 1.5, (1.0, 2.0, 3.0), (4.0, 5.0, 6.0), name="two")
    assert crystal.is_uniaxial and not crystal.is_dispersive and crystal.name == "two"
    np.testing.assert_array_equal(crystal.n_e([500.0, 600.0]), 1.5)
    np.testing.assert_array_equal(crystal.absorption_e_rgb_per_m, [4.0, 5.0, 6.0])
    red = crystal.with_absorption((0.0, 9.0, 9.0))
    np.testing.assert_array_equal(red.absorption_e_rgb_per_m, [0.0, 9.0, 9.0])
    other = crystal.with_absorption((0.0, 9.0, 9.0), extraordinary_rgb_per_m=(7.0, 0.0, 0.0))
    np.testing.assert_array_equal(other.absorption_e_rgb_per_m, [7.0, 0.0, 0.0])
    with pytest.raises(SceneError, match="refractive index"):
        media.uniaxial(1.5, 0.0)


@pytest.mark.parametrize(("name", "expected", "tolerance"), ABBE)
def test_published_abbe_numbers(name: str, expected: float, tolerance: float) -> None:
    assert media.get(name).abbe == pytest.approx(expected, abs=tolerance)


def test_air() -> None:
    # Ciddor 1996: standard air at the sodium line; the two digits of n - 1 that everyone knows
    assert media.get("air").n(589.3) - 1.0 == pytest.approx(2.7716e-4, abs=2e-8)


def test_gems_have_the_fire_they_were_made_from() -> None:
    zircon = media.get("zircon")
    assert zircon.n(430.8) - zircon.n(686.7) == pytest.approx(0.039, rel=1e-9)
    diamond = media.get("diamond")
    assert diamond.n(430.8) - diamond.n(686.7) == pytest.approx(0.044, abs=1e-3)  # B to G, [read2005]


def test_water_absorbs_red_as_pope_and_fry_measured() -> None:
    # Table 3 at 610, 550 and 465 nm, the nearest entries: 0.2644, 0.0565, 0.0101 per metre
    np.testing.assert_allclose(media.get("water").absorption_rgb_per_m, [0.2644, 0.0565, 0.0101], rtol=0.02)


@pytest.mark.parametrize("name", media.names())
def test_every_medium_is_usable_and_says_where_it_comes_from(name: str) -> None:
    medium = media.get(name)
    assert media.get(medium.name) is medium and media.resolve(name) is medium
    assert medium.n_rgb.shape == (3,) and medium.absorption_rgb_per_m.shape == (3,)
    assert medium.n_rgb.min() >= 1.0 and np.all(medium.absorption_rgb_per_m >= 0.0)
    if name != "vacuum":
        assert medium.is_dispersive and np.all(np.diff(medium.n_rgb) > 0.0)  # red, green, blue: normal dispersion
        assert 5.0 < medium.abbe < 110.0
    assert medium.source and medium.absorption_source
    known = set(re.findall(r"@\w+\{(\w+),", BIBLIOGRAPHY.read_text(encoding="utf-8")))
    rays = [medium] if medium.extraordinary is None else [medium, medium.extraordinary]
    cited = set(re.findall(r"\[(\w+)", " ".join(f"{ray.source} {ray.absorption_source}" for ray in rays)))
    assert cited <= known
    assert cited or "representative" in medium.source or name == "vacuum"
    assert medium.absorption_source != "treated as clear" or not np.any(medium.absorption_rgb_per_m)


def test_there_are_many_and_no_two_share_a_name() -> None:
    names = media.names()
    assert len(names) >= 60 and len({name.casefold() for name in names}) == len(names)


@pytest.mark.parametrize(
    ("alias", "name"),
    [("n-bk7", "N-BK7"), ("BK7", "N-BK7"), ("n_bk7", "N-BK7"), ("Fused_Silica", "fused silica"), ("pmma", "acrylic")],
)
def test_case_spaces_and_aliases(alias: str, name: str) -> None:
    assert media.get(alias).name == name


@pytest.mark.parametrize(("typo", "suggestion"), [("N-BK8", "N-BK7"), ("watr", "water"), ("saphire", "sapphire")])
def test_an_unknown_name_suggests_the_nearest(typo: str, suggestion: str) -> None:
    with pytest.raises(SceneError, match=re.escape(suggestion)):
        media.get(typo)


def test_resolve_takes_names_media_and_numbers() -> None:
    glass = media.get("F2")
    assert media.resolve(glass) is glass
    assert media.resolve("F2") is glass
    np.testing.assert_array_equal(media.resolve(1.5).n_rgb, 1.5)
    np.testing.assert_array_equal(media.resolve(np.float32(1.5)).n_rgb, 1.5)


@pytest.mark.parametrize("wrong", [0.0, -1.0, float("nan"), float("inf"), "nothing of the kind", None, True])
def test_resolve_names_the_field_of_what_is_wrong(wrong: object) -> None:
    with pytest.raises(SceneError, match=r"^regions\[1\]\.medium"):
        media.resolve(wrong, "regions[1].medium")  # type: ignore[arg-type]


def test_constant() -> None:
    medium = media.constant(1.7, (1.0, 2.0, 3.0), name="syrup")
    assert medium.name == "syrup" and not medium.is_dispersive and medium.abbe == float("inf")
    np.testing.assert_array_equal(medium.n([[100.0], [1e6]]), [[1.7], [1.7]])
    np.testing.assert_array_equal(medium.absorption_rgb_per_m, [1.0, 2.0, 3.0])


@pytest.mark.parametrize("absorption", [(1.0, 2.0), (-1.0, 0.0, 0.0), (float("nan"), 0.0, 0.0)])
def test_impossible_absorption_is_refused(absorption: tuple[float, ...]) -> None:
    with pytest.raises(SceneError, match="absorption_rgb_per_m"):
        media.constant(1.5, absorption)
    with pytest.raises(SceneError, match="absorption_rgb_per_m"):
        media.get("N-BK7").with_absorption(absorption)


def test_a_coloured_version_keeps_the_index() -> None:
    red = media.get("N-BK7").with_absorption((0.0, 50.0, 50.0), name="red crown")
    assert red.name == "red crown"
    np.testing.assert_array_equal(red.n_rgb, media.get("N-BK7").n_rgb)
    np.testing.assert_array_equal(red.absorption_rgb_per_m, [0.0, 50.0, 50.0])


@pytest.mark.parametrize("lambda_nm", [200.0, 3000.0, float("nan"), [500.0, 3000.0]])
def test_outside_its_range_an_index_is_an_error_that_names_the_range(lambda_nm: object) -> None:
    with pytest.raises(SceneError, match="300 to 2500 nm"):
        media.get("N-BK7").n(lambda_nm)  # type: ignore[arg-type]


def test_formulas_agree_with_the_laws_of_optics() -> None:
    # media and optics do not import one another: what both state is held together here.
    assert media.medium.RGB_LAMBDA_NM == optics.RGB_LAMBDA_NM
    lambda_nm = np.linspace(400.0, 700.0, 31)
    b, c = (1.03961212, 0.231792344, 1.01046945), (0.00600069867, 0.0200179144, 103.560653)
    np.testing.assert_allclose(Sellmeier(b, c)(lambda_nm * 1e-3), optics.sellmeier(lambda_nm, b, c), rtol=1e-15)
    expected = optics.cauchy(lambda_nm, *optics.cauchy_from_abbe(1.62, 36.4))
    np.testing.assert_allclose(PowerSeries.from_abbe(1.62, 36.4)(lambda_nm * 1e-3), expected, rtol=1e-14)
    glass = media.get("F2")
    lines = (optics.dispersion.LAMBDA_D_NM, optics.dispersion.LAMBDA_F_NM, optics.dispersion.LAMBDA_C_NM)
    assert glass.abbe == pytest.approx(optics.abbe_number(*glass.n(lines)), rel=1e-12)
