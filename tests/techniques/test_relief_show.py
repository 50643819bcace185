"""What a picture may show of a translucent layer beside its radiance."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import pellucid as pl
from pellucid.optics import fresnel_dielectric
from pellucid.scene.relief_quality import SHOWS

SIZE = (24, 18)


@pytest.fixture(scope="module")
def renderer(device: pl.Device) -> pl.Renderer:
    return pl.Renderer(device)


def waves_over(solid: Any, show: str, **look: Any) -> pl.ReliefSurface:
    """Steep waves, so that some mirrored rays go down."""
    v, u = (np.mgrid[0:64, 0:64] + 0.5) / 64 * 2.0 * np.pi
    quality = pl.ReliefQuality(show=show, **({"environment": "map"} | look.pop("quality", {})))
    cover = pl.ReliefLayer(0.03 * np.sin(2 * u) * np.cos(2 * v), roughness=0.0)
    more: dict[str, Any] = {"medium": 1.5, "tile_m": 0.4, "absorption": (0.0, 0.0, 0.0), "quality": quality}
    return pl.ReliefSurface.plane(8.0, solid, cover, **(more | look))


def drawn(renderer: pl.Renderer, item: Any, **scene: Any) -> np.ndarray:
    camera = pl.Camera(position=(0.1, 0.5, 0.5), target=(0, 0, 0), fov_deg=30)
    environment = pl.Environment.constant(1.0)
    parts = {"camera": camera, "environment": environment, "objects": [item]} | scene
    return renderer.render(pl.Scene(**parts), SIZE).radiance.astype(float)


@pytest.mark.parametrize("angle_deg", [0.0, 45.0, 80.0])
@pytest.mark.parametrize("n", [1.33, 2.42])
def test_shares_are_those_of_fresnel(renderer: pl.Renderer, n: float, angle_deg: float) -> None:
    quality = pl.ReliefQuality(show="shares")
    item = pl.ReliefSurface.plane(2.0, pl.ReliefLayer(-0.1), pl.ReliefLayer(0.0), medium=n, quality=quality)
    a = np.radians(angle_deg)
    camera = pl.Camera((2.0 * float(np.sin(a)), 2.0 * float(np.cos(a)), 0.0), up=(0, 0, -1), orthographic_height_m=0.1)
    mirrored = float(fresnel_dielectric(np.cos(a), 1.0, n))
    seen = drawn(renderer, item, camera=camera)[9, 12]
    np.testing.assert_allclose(seen, (mirrored, 0.0, 1.0 - mirrored), atol=1e-3)


def test_mirrored_and_refracted_light_make_up_the_radiance_by_their_shares(renderer: pl.Renderer) -> None:
    """L = F L_mirrored + (1 - F) L_refracted where there are no lamps."""
    stripes = np.where(np.arange(64)[None, :, None] % 16 < 8, (0.8, 0.5, 0.1), (0.1, 0.3, 0.7)) * np.ones((64, 1, 1))
    elevation = np.linspace(1.0, -1.0, 64)[:, None, None] * np.ones((1, 128, 3))
    sky = pl.Environment((1.0 + elevation * (0.2, 0.5, 0.8)).astype(np.float32))
    quality = {"reflection": "search"}
    solid = pl.ReliefLayer(-0.06, colors=stripes)
    seen = {
        show: drawn(renderer, waves_over(solid, show, quality=quality), environment=sky)
        for show in ("radiance", "shares", "mirrored", "refracted")
    }
    f = seen["shares"][..., :1]
    assert np.ptp(f) > 0.02
    np.testing.assert_allclose(seen["radiance"], f * seen["mirrored"] + (1 - f) * seen["refracted"], rtol=2e-3)


@pytest.mark.parametrize("reflection", ["environment", "plane", "search"])
def test_ways_say_where_mirrored_rays_end(renderer: pl.Renderer, reflection: str) -> None:
    """Under a black sky, what is mirrored is bright where rays end on the relief, which a lamp lights."""
    white = pl.ReliefLayer(-0.06, colors=(1.0, 1.0, 1.0), specular=0.0)
    scene = {"environment": pl.Environment.constant(0.0), "lights": [pl.DirectionalLight((0.0, -1.0, 0.0))]}
    quality = {"reflection": reflection, "shadows": "none", "occlusion": "none"}
    ways, mirrored = (drawn(renderer, waves_over(white, s, quality=quality), **scene) for s in ("ways", "mirrored"))
    assert set(np.unique(ways)) <= {0.0, 1.0}
    np.testing.assert_array_equal(ways[..., 0] + ways[..., 2], 1.0)
    share = ways[..., 0].mean()
    assert share == 0.0 if reflection == "environment" else 0.02 < share < 0.9
    np.testing.assert_array_equal(mirrored[..., 1] > 0.01, ways[..., 0] > 0.5)


def test_lamps_alone_are_what_a_lamp_adds_to_a_black_ground(renderer: pl.Renderer) -> None:
    black = pl.ReliefLayer(-0.06, colors=(0.0, 0.0, 0.0), specular=0.0)
    scene = {"environment": pl.Environment.constant(0.0), "lights": [pl.DirectionalLight((0.1, -1.0, -0.4))]}
    all_light, lamps = (drawn(renderer, waves_over(black, s), **scene) for s in ("radiance", "lamps"))
    assert lamps.max() > 0.1
    np.testing.assert_allclose(lamps, all_light, rtol=1e-4, atol=1e-6)


@pytest.mark.parametrize("show", SHOWS)
def test_dry_stone_stays_where_it_is_seen(renderer: pl.Renderer, show: str) -> None:
    stone = pl.ReliefLayer(0.1, colors=(0.8, 0.4, 0.1), specular=0.0)
    seen = drawn(renderer, waves_over(stone, show))
    wanted = np.array((0.8, 0.4, 0.1))
    if show in ("shares", "ways"):
        wanted = np.full(3, wanted @ (0.2126, 0.7152, 0.0722))
    np.testing.assert_allclose(seen, np.broadcast_to(0.0 if show == "lamps" else wanted, seen.shape), rtol=5e-3)


def test_a_picture_shows_what_is_there_only() -> None:
    shares = pl.ReliefQuality(show="shares")
    with pytest.raises(pl.SceneError, match="show"):
        pl.ReliefQuality(show="depth")
    with pytest.raises(pl.SceneError, match="no translucent layer"):
        pl.ReliefSurface.plane(1.0, pl.ReliefLayer(0.0), quality=shares)
    with pytest.raises(pl.SceneError, match="no translucent layer"):
        pl.ReliefSurface.plane(1.0, pl.ReliefLayer(0.0), pl.ReliefLayer(0.1), quality=shares, technique="relief")


def test_a_view_is_compiled_once(renderer: pl.Renderer) -> None:
    item = waves_over(pl.ReliefLayer(-0.06), "shares")
    drawn(renderer, item)
    drawn(renderer, waves_over(pl.ReliefLayer(-0.06), "ways"))
    pipelines = renderer._techniques[pl.ReliefSurface].pipelines
    made = len(pipelines)
    for show, n in (("shares", 1.3), ("ways", 2.4), ("shares", 1.7)):
        drawn(renderer, waves_over(pl.ReliefLayer(-0.06), show, medium=n))
    assert len(pipelines) == made > 0
