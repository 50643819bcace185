"""Pictures of 8 and 16 bits mean the same as arrays as they do in files, wherever pictures are taken."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.io.images import decoded, read_image, write_image

FLAT = pl.Mesh.plane(1.0)


def mesh(given: Any, **look: Any) -> pl.Mesh:
    return pl.Mesh(FLAT.vertices, FLAT.faces, uvs=FLAT.uvs, base_color_map=given, **look)


def layer(**maps: Any) -> pl.ReliefLayer:
    return pl.ReliefLayer(**({"heights": 0.0} | maps))


# What is made of an array, what of the file that holds the same bytes, and what is stored of either.
PLACES: dict[str, tuple[Callable[[Any], Any], Callable[[Path], Any]]] = {
    "environment": (lambda a: pl.Environment(a).pixels, lambda p: pl.Environment.load(p).pixels),
    "base_color_map": (lambda a: mesh(a).base_color_map, read_image),
    "picture": (lambda a: pl.RefractiveSheet(a).picture, lambda p: pl.RefractiveSheet(p).picture),
    "sphere_map": (
        lambda a: pl.RefractiveSheet(np.ones((2, 2, 3)), sphere_map=a).sphere_map,
        lambda p: pl.RefractiveSheet(np.ones((2, 2, 3)), sphere_map=p).sphere_map,
    ),
    "colors": (lambda a: layer(colors=a).colors, lambda p: layer(colors=p).colors),
    "normals": (lambda a: layer(normals=a).normals, lambda p: layer(normals=p).normals),
    "heights": (
        lambda a: layer(heights=a[..., 0], height_m=0.1).heights,
        lambda p: layer(heights=p, height_m=0.1).heights,
    ),
}


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("place", PLACES)
def test_an_array_of_bytes_is_the_picture_that_a_file_holds(tmp_path: Path, place: str, dtype: Any) -> None:
    pixels = np.random.default_rng(5).integers(0, np.iinfo(dtype).max, (8, 16, 3), dtype, endpoint=True)
    pixels[..., 2] |= dtype(1 + np.iinfo(dtype).max // 2)  # of normals, z is > 0
    pixels[0, 0] = 0, 0, np.iinfo(dtype).max
    write_image(tmp_path / "picture.png", pixels)
    of_array, of_file = PLACES[place]
    found = of_array(pixels)
    np.testing.assert_allclose(found, of_file(tmp_path / "picture.png"), rtol=2e-6, atol=1e-7)
    assert np.abs(found).max() <= 1.0 and not found.flags.writeable


@pytest.mark.parametrize("place", PLACES)
def test_arrays_of_other_types_are_numbers(place: str) -> None:
    for value in (0.5, 200):
        np.testing.assert_array_equal(PLACES[place][0](np.full((8, 16, 3), value)), value)


def test_alpha_is_not_linearised() -> None:
    grey = np.full((2, 2, 4), 128, np.uint8)
    found = mesh(grey).base_color_map
    assert found is not None
    np.testing.assert_allclose(found[0, 0], [0.21586, 0.21586, 0.21586, 128 / 255], rtol=1e-4)  # [iec61966, 5.2]
    np.testing.assert_allclose(decoded(grey[..., 2:])[0, 0], [0.21586, 128 / 255], rtol=1e-4)


def test_heights_of_bytes_need_the_height_of_the_brightest() -> None:
    with pytest.raises(pl.SceneError, match=r"height_m.*is missing"):
        pl.ReliefLayer(np.zeros((4, 4), np.uint8))
