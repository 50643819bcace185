"""Every picture of the gallery builds and renders."""

from __future__ import annotations

import re

import numpy as np
import pytest

from pellucid.gallery import PICTURES, Picture, stage
from pellucid.gpu import Device
from pellucid.renderer import Renderer


@pytest.fixture(scope="module")
def renderer(device: Device) -> Renderer:
    return Renderer(device)


def test_names_are_for_files_and_differ() -> None:
    names = [p.name for p in PICTURES]
    assert len(set(names)) == len(names) >= 8
    assert all(re.fullmatch(r"[a-z]+(-[a-z]+)*", name) for name in names)


@pytest.mark.parametrize("picture", PICTURES, ids=lambda p: p.name)
def test_words_say_what_there_is_to_see(picture: Picture) -> None:
    assert picture.title and picture.you_should_see.endswith(".") and 1 <= picture.samples <= 16


@pytest.mark.parametrize("picture", PICTURES, ids=lambda p: p.name)
def test_a_picture_renders(picture: Picture, renderer: Renderer) -> None:
    frame = renderer.render(picture.build(), (64, 48), time=picture.time_s)
    assert np.isfinite(frame.radiance).all()
    # Pure colours lie outside of Rec. 709, where a channel may be negative; luminance may not.
    assert (frame.radiance @ (0.2126, 0.7152, 0.0722)).min() >= -1e-5
    assert frame.srgb().std() > 8.0, "the picture is nearly constant"
    # A picture for a front page is neither lost in the dark nor burnt out.
    burnt = (frame.srgb().min(axis=2) >= 250).mean()
    assert burnt < 0.1 and 20 < frame.srgb().mean() < 220


def test_noise_repeats_at_its_edges() -> None:
    values = stage.noise((64, 96), (3.0, 6.0), 1)
    assert abs(values.mean()) < 1e-9 and values.std() == pytest.approx(1.0)
    seam, inside = np.abs(values[:, 0] - values[:, -1]).mean(), np.abs(np.diff(values, axis=1)).mean()
    assert seam < 1.5 * inside
