"""What a render is asked for, refused before any work."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.errors import SceneError


@pytest.fixture(scope="module")
def scene() -> pl.Scene:
    return pl.Scene(camera=pl.Camera(position=(0.0, 0.0, 1.0)))


@pytest.mark.parametrize("size", [(8.5, 8), (8.0, 8), ("8", 8), (8, 8, 8), 8, "8x8", (0, 8), (8, -1), (100_000, 8)])
def test_a_size_that_is_not_two_whole_numbers_in_range_is_refused(scene: pl.Scene, size: Any) -> None:
    with pytest.raises(SceneError, match=r"^size: "):
        pl.render(scene, size=size)


@pytest.mark.parametrize("time", [float("nan"), float("inf"), "1", None])
def test_a_time_that_is_no_finite_number_is_refused(scene: pl.Scene, time: Any) -> None:
    with pytest.raises(SceneError, match=r"^time: "):
        pl.render(scene, size=(8, 8), time=time)


def test_whole_numbers_of_any_kind_are_sizes(scene: pl.Scene) -> None:
    assert pl.render(scene, size=(np.int64(9), np.uint8(8))).size == (9, 8)
