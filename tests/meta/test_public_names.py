"""Names that users may rely on."""

from __future__ import annotations

import inspect

import pytest

import pellucid as pl

SCENE = [
    "Scene",
    "Camera",
    "Environment",
    "DirectionalLight",
    "PointLight",
    "AreaLight",
    "Mesh",
    "RefractiveSheet",
    "RefractiveVolume",
    "Quality",
    "ReliefLayer",
    "ReliefQuality",
    "ReliefSurface",
]
CALLS = ["render", "animate", "trace", "probe"]
RESULTS = ["Frame", "Rays"]
ERRORS = ["PellucidError", "NoAdapterError", "AssetError", "SceneError", "ShaderError"]
ROOMS = ["media", "optics", "waves"]


@pytest.mark.parametrize("name", [*SCENE, *CALLS, *RESULTS, *ERRORS, *ROOMS])
def test_a_public_name_is_there_listed_and_documented(name: str) -> None:
    found = getattr(pl, name)
    assert name in pl.__all__
    assert name in dir(pl)
    assert (inspect.getdoc(found) or "").strip(), f"pellucid.{name} has no docstring"


def test_every_listed_name_exists() -> None:
    assert [name for name in pl.__all__ if not hasattr(pl, name)] == []


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="Nonesuch"):
        _ = pl.Nonesuch


@pytest.mark.parametrize("name", [n for n in ERRORS if n != "PellucidError"])
def test_every_error_is_a_pellucid_error(name: str) -> None:
    assert issubclass(getattr(pl, name), pl.PellucidError)


@pytest.mark.parametrize("name", ["from_mesh", "from_array", "from_function", "from_sdf"])
def test_a_volume_is_made_in_these_ways(name: str) -> None:
    assert callable(getattr(pl.RefractiveVolume, name))


@pytest.mark.parametrize("name", ["Sine", "Gerstner", "Ocean", "Ripples", "Heights", "MeshWaves", "Sum"])
def test_water_moves_by_these_waves(name: str) -> None:
    found = getattr(pl.waves, name)
    assert issubclass(found, pl.waves.WaveSource) and (inspect.getdoc(found) or "").strip()
