"""Heights and meshes of one's own, sums of waves, and waves in files."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from pellucid.errors import SceneError
from pellucid.fields.dynamic import DynamicHeights
from pellucid.fields.waves import Gerstner, Heights, MeshWaves, Ocean, Ripples, Sine, Sum, from_plain, to_plain
from pellucid.fields.waves.source import bilinear


def grid(count: int, side: float, heights: Any) -> tuple[np.ndarray, np.ndarray]:
    """A square mesh about the origin with heights f(x, z)."""
    line = np.linspace(-0.5 * side, 0.5 * side, count)
    x, z = np.meshgrid(line, line)
    number = np.arange(count * count).reshape(count, count)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[:-1, 1:], number[1:, 1:]
    faces = np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, b, c), (b, d, c))])
    return np.stack([x, heights(x, z), z], -1).reshape(-1, 3), faces


def test_heights_at_rest_stay() -> None:
    values = np.arange(12.0).reshape(3, 4)
    waves = Heights(values, (4.0, 3.0))
    assert isinstance(waves, DynamicHeights) and waves.limits_m == (0.0, 11.0)
    assert waves.surface(0.0) is waves.surface(8.0)
    np.testing.assert_array_equal(waves.advance(1.0), values)
    np.testing.assert_allclose(waves.surface(0.0).slopes, np.broadcast_to((1.0, 4.0), (3, 4, 2)))


@pytest.mark.parametrize(
    ("heights", "said"),
    [
        (np.ones((3, 3), complex), "is of type complex128"),
        ("high", "is of type <U4"),
        ([[0.0, 1.0], [0.0]], "differ in length"),
        (np.zeros(3), r"have shape \(3,\)"),
        ([[0.0, np.inf], [0.0, 0.0]], "1 values that are not finite"),
    ],
)
def test_heights_that_are_none_are_refused_for_what_they_are(heights: Any, said: str) -> None:
    with pytest.raises(SceneError, match=rf"^heights: .*{said}"):
        Heights(heights, 1.0)


def test_pictures_in_time_are_linear_between_and_may_repeat() -> None:
    pictures = np.zeros((3, 4, 4)) + np.array([0.0, 1.0, 4.0])[:, None, None]
    waves, looped = (Heights(pictures, 1.0, [1.0, 2.0, 4.0], loop=loop) for loop in (False, True))
    for time, wanted in ((0.0, 0.0), (1.5, 0.5), (3.0, 2.5), (9.0, 4.0)):
        assert waves.advance(time)[0, 0] == pytest.approx(wanted)
    for time, wanted in ((1.5, 0.5), (5.0, 2.0), (6.5, 0.5), (0.0, 2.0)):  # five seconds a turn
        assert looped.advance(time)[0, 0] == pytest.approx(wanted)


def test_a_mesh_is_read_at_the_centres_of_cells() -> None:
    waves = MeshWaves(grid(9, 5.0, lambda x, z: 0.1 * x - 0.2 * z), (4.0, 3.0), (12, 16))
    x, z = waves.centres()
    np.testing.assert_allclose(waves.advance(0.0), 0.1 * x - 0.2 * z[:, None], atol=1e-6)
    np.testing.assert_allclose(waves.surface(0.0).slopes, np.broadcast_to((0.1, -0.2), (12, 16, 2)), atol=1e-5)


def test_meshes_in_time_and_functions_of_it() -> None:
    def wave(time: float) -> tuple[np.ndarray, np.ndarray]:
        return grid(41, 4.2, lambda x, z: 0.1 * np.sin(x - time))

    moving = MeshWaves(wave, 4.0, (8, 32), limits_m=(-0.1, 0.1))
    x, _ = moving.centres()
    np.testing.assert_allclose(moving.advance(2.0)[3], 0.1 * np.sin(x - 2.0), atol=2e-4)
    listed = MeshWaves([wave(0.0), wave(1.0)], 4.0, (8, 32), times_s=[0.0, 1.0])
    np.testing.assert_allclose(listed.advance(0.5), 0.5 * (moving.advance(0.0) + moving.advance(1.0)), atol=1e-6)


def test_meshes_that_are_no_heights_are_refused() -> None:
    whole, faces = grid(5, 4.0, lambda x, z: 0.0 * x)

    def refused(vertices: np.ndarray, faces: np.ndarray, said: str, side: float = 4.0) -> None:
        with pytest.raises(SceneError, match=said):
            MeshWaves((vertices, faces), side, (16, 16))

    refused(whole, faces, "open", side=5.0)
    refused(whole, faces[1:], "open")
    refused(
        np.concatenate([whole, whole + np.array([0, 1, 0])]), np.concatenate([faces, faces + len(whole)]), "two heights"
    )
    curled = whole.copy()
    curled[12, 0] += 1.5
    refused(curled, faces, "upside down")
    refused(whole[:, [0, 2, 1]], faces, "upright")
    refused(whole[:, :2], faces, r"^mesh\.vertices: ")
    refused(np.where(whole == 2.0, np.nan, whole), faces, r"^mesh\.vertices: ")
    refused(whole, faces + 1, r"^mesh\.faces: ")
    refused(whole + 0j, faces, r"^mesh\.vertices: is of type complex128")
    for given, options, field in (
        (lambda time: (whole, faces), {}, "limits_m"),
        ([(whole, faces)] * 2, {}, "times_s"),
        ([(whole, faces), (whole, faces[1:])], {"times_s": [0, 1]}, "mesh"),
        ("sea.obj", {}, "mesh"),
    ):
        with pytest.raises(SceneError, match=rf"^{field}: "):
            MeshWaves(given, 4.0, (16, 16), **options)


def test_a_sum_adds_its_layers_up() -> None:
    swell, chop = Sine(4.0, 0.1, 20.0, tile_m=8.0, shape=(64, 64)), Sine(1.0, 0.02, 80.0, tile_m=4.0, shape=(64, 64))
    both = Sum(swell, chop)
    assert both.periodic and both.tile_m == (8.0, 8.0) and both.shape == (128, 128)
    x, z = np.meshgrid(np.linspace(-3, 3, 7), np.linspace(-3, 3, 7))
    wanted = [a + b for a, b in zip(swell.at(x, z, 1.0), chop.at(x, z, 1.0), strict=True)]
    for found, value in zip(both.at(x, z, 1.0), wanted, strict=True):
        np.testing.assert_allclose(found, value, atol=0.003 if value.ndim == 2 else 0.02)
    assert both.limits_m == pytest.approx((-0.12, 0.12))
    assert (
        both.steepest == pytest.approx(swell.steepest + chop.steepest)
        and Sum(swell, Ripples((8, 8), 1.0)).steepest is None
    )


def test_drops_in_a_sum_fall_into_its_ripples() -> None:
    ripples = Ripples((32, 32), 0.25, 1.0)
    both = Sum(Ocean(3.0, tile_m=20.0, shape=(32, 32)), ripples)
    assert not both.periodic and both.tile_m == (8.0, 8.0)
    before = both.advance(1.0).copy()
    both.drop(0.0, 0.0, 0.6, 0.01)
    assert len(ripples.disturbances) == 1 and np.abs(both.advance(1.0) - before).max() > 0.001
    with pytest.raises(SceneError, match="no Ripples"):
        Sum(Sine()).drop(0.0, 0.0, 1.0, 0.1)


def test_sums_are_checked() -> None:
    for layers in ((), (Ripples,), (Sine(shape=(16, 16)),) * 9):
        with pytest.raises(SceneError, match=r"^layers: "):
            Sum(*layers)  # type: ignore[arg-type]
    with pytest.raises(SceneError, match="do not repeat"):
        Sum(Ripples((32, 32), 0.25), Heights(np.zeros((4, 4)), 5.0))


def test_places_between_cells_are_linear_and_go_on_or_stay() -> None:
    plane = np.arange(4.0, dtype=np.float32)[None, :].repeat(3, 0)
    (stays,) = bilinear([plane], np.array([-2.0, 0.25, 9.0]), np.array([1.0, 1.5, 7.0]), False)
    (goes,) = bilinear([plane], np.array([-1.0, 3.5, 4.0]), np.array([0.0, 0.0, 3.0]), True)
    np.testing.assert_allclose(stays, [0.0, 0.25, 3.0])
    np.testing.assert_allclose(goes, [3.0, 1.5, 0.0])


def all_kinds() -> list[Any]:
    ripples = Ripples((16, 20), 0.1, 1.0, boundary="periodic", level_m=0.1)
    ripples.drop(0.1, 0.2, 0.3, 0.01, time_s=0.1)
    ripples.push([(0, 0), (0.5, 0)], 0.3, 0.01, time_s=0.2)
    pictures = np.random.default_rng(1).normal(size=(2, 6, 8))
    a, b = grid(4, 5.0, lambda x, z: 0.1 * x), grid(4, 5.0, lambda x, z: 0.1 * z)
    return [
        Sine((2.0, 1.0), 0.1, shape=(32, 32)),
        Gerstner(2.0, 0.1, sharpness=0.5, speed_m_s=1.0, depth_m=2.0, shape=(32, 32)),
        Ocean(7.0, 20.0, (90.0, 60.0), (32, 32), "tma", depth_m=9.0, seed=4, loop_s=20.0),
        ripples,
        Heights(pictures, (2.0, 1.0), [0.0, 1.0], periodic=True),
        MeshWaves([a, b], 4.0, (8, 8), times_s=[0.0, 2.0]),
        MeshWaves(grid(4, 5.0, lambda x, z: 0.0 * x), 4.0, (8, 8)),
        Sum(Sine(shape=(16, 16)), Heights(pictures[0], 10.0)),
    ]


@pytest.mark.parametrize("source", all_kinds(), ids=lambda s: s.kind)
def test_waves_come_back_from_plain_dictionaries(source: Any) -> None:
    import json

    plain, arrays = to_plain(source)
    back = from_plain(json.loads(json.dumps(plain)), arrays)
    assert type(back) is type(source) and back.tile_m == source.tile_m and back.periodic == source.periodic
    np.testing.assert_array_equal(back.advance(0.7), source.advance(0.7))


def test_what_dictionaries_get_wrong_is_said() -> None:
    for plain, said in (
        ({}, r"^waves\.kind: "),
        ({"kind": "swell"}, r"^waves\.kind: "),
        ({"kind": "ocean", "wind": 3.0}, r"^waves\.wind: .*wind_"),
        ({"kind": "ocean", "wind_m_s": "much"}, r"^wind_m_s: "),
        ({"kind": "ripples"}, r"^waves\.shape: "),
        ({"kind": "ripples", "shape": [8, 8], "cell_m": 0.1, "drops": [{"x": 1}]}, r"^waves\.drops: "),
        ({"kind": "heights", "tile_m": 1.0}, r"^waves\.arrays: "),
        ({"kind": "sum", "layers": 3}, r"^waves\.layers: "),
    ):
        with pytest.raises(SceneError, match=said):
            from_plain(plain)
    with pytest.raises(SceneError, match="function"):
        to_plain(MeshWaves(lambda time: grid(4, 5.0, lambda x, z: 0.0 * x), 4.0, (8, 8), limits_m=(-1, 1)))
    with pytest.raises(SceneError, match="cannot be written"):
        to_plain(np.zeros(3))
