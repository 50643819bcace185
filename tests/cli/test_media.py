"""The table of media, and one of them in detail."""

from __future__ import annotations

from pellucid import media


def test_the_table_holds_every_medium_with_its_source(pellucid):
    said = pellucid("media")
    assert said.code == 0
    first_words = {line.split("  ")[0].strip() for line in said.out.splitlines()}
    assert set(media.names()) <= first_words
    assert media.get("N-BK7").source.split()[0] in said.out


def test_one_medium_in_detail(pellucid):
    said = pellucid("media", "n-bk7")
    assert said.code == 0
    assert "1.516800" in said.out, "n_d of N-BK7 in the maker's data sheet"
    for nm in ("486.13", "656.28", "611.40", "549.10", "464.30"):
        assert nm in said.out


def test_a_crystal_shows_both_of_its_indices(pellucid):
    said = pellucid("media", "calcite")
    assert said.code == 0 and "uniaxial" in said.out and "n_e" in said.out
    assert "1.658461" in said.out and "1.486185" in said.out


def test_a_constant_index(pellucid):
    said = pellucid("media", "1.4")
    assert said.code == 0 and "1.400000" in said.out


def test_an_unknown_medium_suggests_the_nearest(pellucid):
    said = pellucid("media", "N-BK8")
    assert said.code == 1 and said.out == ""
    assert said.err.startswith("error: ") and "did you mean N-BK7" in said.err


def test_an_impossible_index(pellucid):
    said = pellucid("media", "-1")
    assert said.code in (1, 2) and said.out == ""


def test_a_water_states_what_it_absorbs_and_scatters(pellucid):
    said = pellucid("media", "pond")
    assert said.code == 0
    assert "scattering" in said.out and "mean cosine 0.92" in said.out and "absorption, 1/m" in said.out
