"""What a relief makes of maps that are unlike one another, or level; and what is uploaded when something moves."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.scene.relief_quality import SEARCHES

SKY = pl.Environment.constant(1.0)
SIZE = (24, 24)


@pytest.fixture(scope="module")
def renderer(device: pl.Device) -> pl.Renderer:
    return pl.Renderer(device)


def slanted() -> pl.Camera:
    return pl.Camera(position=(0.2, 0.7, 0.7), target=(0, 0, 0), fov_deg=40)


def drawn(renderer: pl.Renderer, item: pl.ReliefSurface, **scene: Any) -> pl.Frame:
    return renderer.render(pl.Scene(**({"camera": slanted(), "environment": SKY, "objects": [item]} | scene)), SIZE)


def waves(rows: int, columns: int) -> np.ndarray:
    v, u = (np.mgrid[0:rows, 0:columns] + 0.5) / np.array([rows, columns]).reshape(2, 1, 1) * 2.0 * np.pi
    return np.asarray(np.sin(u) * np.cos(v))


@pytest.mark.parametrize("search", SEARCHES)
def test_level_heights_are_met_by_every_search(renderer: pl.Renderer, search: str) -> None:
    quality = pl.ReliefQuality(search=search)
    flat = drawn(renderer, pl.ReliefSurface.plane(4.0, pl.ReliefLayer(0.05), technique="relief", quality=quality)).depth
    many = pl.ReliefLayer(np.full((16, 16), 0.05))
    level = drawn(renderer, pl.ReliefSurface.plane(4.0, many, technique="relief", quality=quality)).depth
    ways = slanted().pixel_rays(SIZE)[1]
    forward = -np.asarray(slanted().position) / np.linalg.norm(slanted().position)
    true = (slanted().position[1] - 0.05) / -ways[..., 1] * (ways @ forward)
    np.testing.assert_allclose(flat, true, atol=1e-4)
    np.testing.assert_allclose(level, true, atol=1e-4)


def test_maps_of_different_sizes_are_brought_together(renderer: pl.Renderer) -> None:
    """A bilinear map is the same surface whatever the size of the maps beside it."""
    fine, coarse = 0.02 * waves(64, 96), -0.03 + 0.005 * waves(4, 8)
    colors = np.repeat(np.linspace(0.2, 0.8, 16)[None, :, None], 3, axis=2) * np.ones((5, 1, 1))
    item = pl.ReliefSurface.plane(
        4.0, pl.ReliefLayer(coarse, colors=colors), pl.ReliefLayer(fine), technique="two_layer"
    )
    frame = drawn(renderer, item)
    assert np.isfinite(frame.depth).all() and np.isfinite(frame.radiance).all()
    alone = drawn(renderer, item.replace(solid=pl.ReliefLayer(-0.04))).depth  # the upper surface hides what is below
    np.testing.assert_allclose(frame.depth, alone, atol=1e-3)
    # one level map for the solid layer, of one texel or as many as the other has
    level = [item.replace(solid=pl.ReliefLayer(h, colors=colors)) for h in (-0.03, np.full((64, 96), -0.03))]
    one, many = (drawn(renderer, surface).radiance for surface in level)
    np.testing.assert_allclose(one, many, rtol=1e-3)


def test_a_layer_that_is_not_drawn_focuses_no_light(renderer: pl.Renderer) -> None:
    solid, lamp = pl.ReliefLayer(0.05 * waves(32, 32)), pl.DirectionalLight(direction=(-1, -1, 0))
    item = pl.ReliefSurface.plane(1.0, solid, pl.ReliefLayer(0.2), technique="relief")
    asked = item.replace(quality=pl.ReliefQuality(caustics=True))
    plain, focused = (drawn(renderer, surface, lights=[lamp]).radiance for surface in (item, asked))
    np.testing.assert_array_equal(plain, focused)


def test_what_moves_uploads_its_parameters_only(renderer: pl.Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    item = pl.ReliefSurface.plane(
        4.0, pl.ReliefLayer(0.02 * waves(32, 32)), pl.ReliefLayer(0.03), technique="two_layer"
    )
    lamp = pl.DirectionalLight(direction=(0.2, -1, 0.2))
    drawn(renderer, item, lights=[lamp])
    sent: list[int] = []
    write = pl.Device.write

    def watched(self: Any, buffer: Any, data: Any, *rest: Any, **options: Any) -> None:
        sent.append(np.asarray(data).nbytes)
        write(self, buffer, data, *rest, **options)

    monkeypatch.setattr(pl.Device, "write", watched)
    for changed, lights, camera in (
        (item, [lamp.replace(direction=(0.5, -1, 0))], slanted()),
        (item, [lamp], pl.Camera(position=(0.3, 1, 0.2))),
        (item.replace(medium=1.6), [lamp], slanted()),
    ):
        sent.clear()
        drawn(renderer, changed, lights=lights, camera=camera)
        assert 0 < sum(sent) < 16384
