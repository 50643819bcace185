"""Volumes: what is kept, what is refused, and how bodies become voxels."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from pellucid import media
from pellucid.errors import SceneError
from pellucid.fields.volume import Region, Volume


def ball(radius):
    return lambda x, y, z: np.sqrt(x * x + y * y + z * z) - radius


def test_index_of_gas_survives_as_a_difference():
    n = 1.0 + 1e-4 * np.linspace(1.0, 1.001, 8)[None, None, :] * np.ones((2, 3, 8))
    volume = Volume.from_array(n, 1.0)
    np.testing.assert_allclose(volume.delta_n, n - 1.0, rtol=1e-7)
    assert volume.extent_m == (1.0, 0.375, 0.25)
    assert volume.voxel_m == pytest.approx((0.125,) * 3)


def test_arrays_are_kept_read_only_and_contiguous():
    n = np.full((4, 4, 4), 1.5).transpose(2, 1, 0)
    volume = Volume.from_array(n, 1.0, absorption=np.ones((4, 4, 4, 3)))
    for values in (volume.delta_n, volume.absorption):
        assert values.dtype == np.float32 and values.flags.c_contiguous and not values.flags.writeable
    assert volume.nbytes == 64 * 4 * 4
    n[:] = 2.0
    assert (volume.delta_n == 0.5).all()


def test_function_is_sampled_at_voxel_centres_in_xyz():
    volume = Volume.from_function(lambda x, y, z: 2 + x + 10 * y + 100 * z, 4, (0.04, 0.02, 0.01), 2.0)
    assert volume.shape == (1, 2, 4)
    assert volume.delta_n[0, 1, 3] == pytest.approx(0.015 + 10 * 0.005, rel=1e-6)


def test_one_value_a_channel_is_dispersive():
    n = np.full((2, 2, 2, 3), [1.51, 1.52, 1.53])
    assert Volume.from_array(n, 1.0).is_dispersive
    assert not Volume.from_array(n[..., 0], 1.0).is_dispersive


def test_medium_may_be_a_name_a_medium_or_a_number():
    f = ball(0.3)
    for medium in ("N-BK7", media.get("N-BK7"), 1.5):
        assert Volume.from_sdf(f, medium, 8, 1.0).regions[0].medium == media.resolve(medium)
    assert Volume.from_sdf(f, "N-BK7", 8, 1.0).is_dispersive


def test_rasterised_ball_has_the_volume_of_a_ball():
    volume = Volume.from_sdf(ball(0.4), media.constant(1.5, (1.0, 2.0, 3.0)), 48, 1.0).rasterised()
    filled = volume.delta_n.astype(float).mean() / 0.5
    # Coverage by a plane parallel to a face errs by curvature and slant, both of second order in the voxel.
    assert filled == pytest.approx(4 / 3 * np.pi * 0.4**3, rel=2e-3)
    np.testing.assert_allclose(volume.absorption[24, 24, 24], [1, 2, 3])
    assert volume.rasterised() is volume


def test_rasterised_bodies_in_contact_leave_no_gap():
    def left(x, y, z):
        return x - 0.013

    def right(x, y, z):
        return -x + 0.008

    volume = Volume.from_regions([(left, 1.5), (right, 1.5)], 16, 1.0).rasterised()
    np.testing.assert_allclose(volume.delta_n, 0.5, atol=1e-6)


def test_rasterised_follows_priority_and_dispersion():
    inner, outer = ball(0.2), ball(0.4)
    volume = Volume.from_regions([(inner, 1.0), (outer, "N-BK7")], 32, 1.0)
    smooth = volume.rasterised()
    assert smooth.delta_n.shape == (32, 32, 32, 3)
    np.testing.assert_allclose(smooth.delta_n[16, 16, 16], 0.0, atol=1e-7)
    np.testing.assert_allclose(smooth.delta_n[16, 16, 25], media.get("N-BK7").n_rgb - 1.0, rtol=1e-6)


def test_rasterised_keeps_emission():
    sdf = Volume.from_sdf(ball(0.4), 1.2, 16, 1.0).regions[0].sdf
    volume = Volume((1, 1, 1), regions=(Region(sdf, 1.2, emission=(1, 2, 3)),)).rasterised()
    np.testing.assert_allclose(volume.emission[8, 8, 8], [1, 2, 3])
    assert volume.absorption is None


def test_rasterised_adds_fields_to_bodies_and_weights_the_anisotropy_by_scattering():
    sdf = Volume.from_sdf(ball(0.4), 1.2, 16, 1.0).regions[0].sdf
    body = Region(sdf, media.constant(1.2, (1.0, 2.0, 3.0)), scattering=(3, 3, 3), anisotropy=0.8)
    around = np.ones((16, 16, 16, 3))
    fields = {"absorption": around, "scattering": around, "emission": around, "anisotropy": np.full((16,) * 3, -0.4)}
    volume = Volume((1, 1, 1), regions=(body,), **fields).rasterised()
    np.testing.assert_allclose(volume.absorption[8, 8, 8], [2, 3, 4])
    np.testing.assert_allclose(volume.scattering[8, 8, 8], 4.0)
    np.testing.assert_allclose(volume.emission[[8, 0], 8, [8, 0]], 1.0)
    np.testing.assert_allclose(volume.anisotropy[[8, 0], [8, 0], [8, 0]], [(3 * 0.8 - 0.4) / 4, -0.4], rtol=1e-6)
    np.testing.assert_allclose(volume.scattering[0, 0, 0], 1.0)


def test_mesh_is_placed_about_its_centre():
    mesh = trimesh.creation.box(extents=(0.4, 0.2, 0.1)).apply_translation([1.0, 2.0, 3.0])
    volume, centre = Volume.from_mesh(mesh.vertices, mesh.faces, 1.5, 26)
    assert centre == pytest.approx((1.0, 2.0, 3.0))
    assert volume.shape == (11, 16, 26)
    assert np.ptp(volume.voxel_m) < 1e-12
    assert (volume.regions[0].sdf < 0).sum() * np.prod(volume.voxel_m) == pytest.approx(0.008, rel=1e-6)


def test_sheet_without_inside_is_refused():
    with pytest.raises(SceneError, match="encloses no"):
        Volume.from_mesh(np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]]), [[0, 1, 2], [0, 2, 3]], 1.5, 16)


FINE = np.full((4, 4, 4), 1.5)
WITH_NAN = FINE.copy()
WITH_NAN[1, 2, 3] = np.nan


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ({"n": WITH_NAN}, "n"),
        ({"n": FINE * 0}, "n"),
        ({"n": FINE[0]}, "n"),
        ({"n": np.ones((2, 2, 2, 2))}, "n"),
        ({"n": np.ones((0, 2, 2))}, "n"),
        ({"n": np.broadcast_to(np.float32(1), (2048, 1024, 1024))}, "n"),
        ({"extent_m": 0.0}, "extent_m"),
        ({"extent_m": (1, 2)}, "extent_m"),
        ({"extent_m": (1, -2, 1)}, "extent_m"),
        ({"extent_m": float("inf")}, "extent_m"),
        ({"extent_m": "wide"}, "extent_m"),
        ({"ambient_n": 0.0}, "ambient_n"),
        ({"ambient_n": None}, "ambient_n"),
        ({"absorption": -np.ones((4, 4, 4, 3))}, "absorption"),
        ({"absorption": np.ones((4, 4, 4))}, "absorption"),
        ({"absorption": np.ones((4, 4, 5, 3))}, "absorption"),
        ({"scattering": np.full((4, 4, 4, 3), np.inf)}, "scattering"),
        ({"anisotropy": np.ones((4, 4, 4))}, "anisotropy"),
        ({"anisotropy": np.zeros((4, 4, 4, 1))}, "anisotropy"),
        ({"emission": -np.ones((4, 4, 4, 3))}, "emission"),
        ({"opaque": np.full((4, 4, 4, 4), 2.0)}, "opaque"),
        ({"opaque": np.ones((4, 4, 4, 3))}, "opaque"),
        ({"absorption": np.full((4, 4, 4, 3), "x")}, "absorption"),
    ],
)
def test_bad_fields_are_refused_by_name(arguments, field):
    with pytest.raises(SceneError) as caught:
        Volume.from_array(**({"n": FINE, "extent_m": 1.0} | arguments))
    assert caught.value.field == field


@pytest.mark.parametrize("resolution", [0, 1, -3, 2.5, True, 100000, 2000])
def test_bad_resolution_is_refused_before_memory_is_taken(resolution):
    with pytest.raises(SceneError, match="resolution"):
        Volume.from_function(lambda x, y, z: 1.0 + 0 * x, resolution, 1.0)


@pytest.mark.parametrize(
    "wrong",
    [
        {"scattering": (1, -1, 1)},
        {"scattering": 1.0},
        {"scattering": "thick"},
        {"anisotropy": 1.0},
        {"anisotropy": float("nan")},
        {"anisotropy": True},
        {"emission": (0, np.inf, 0)},
    ],
)
def test_bad_constants_of_a_region_are_refused_by_name(wrong):
    with pytest.raises(SceneError) as caught:
        Region(np.ones((4, 4, 4)), 1.5, **wrong)
    assert caught.value.field == next(iter(wrong))


def test_bad_regions_are_refused():
    with pytest.raises(SceneError, match="delta_n"):
        Volume((1, 1, 1))
    with pytest.raises(SceneError, match="at most 4"):
        Volume.from_regions([(ball(0.1), 1.5)] * 5, 8, 1.0)
    with pytest.raises(SceneError, match=r"regions\[0\]\.sdf"):
        Volume.from_regions([(lambda x, y, z: np.zeros(7), 1.5)], 8, 1.0)
    with pytest.raises(SceneError, match=r"regions\[1\]\.sdf"):
        Volume.from_regions([(ball(0.1), 1.5), (np.zeros((3, 3, 3)), 1.5)], 8, 1.0)
    with pytest.raises(SceneError):
        Volume.from_sdf(ball(0.1), "no such glass", 8, 1.0)


@pytest.mark.parametrize(
    ("n", "words"),
    [
        (np.full((2, 2, 2), 1.5 + 0.1j), "complex128"),
        (np.full((2, 2, 2), None), "object"),
        (np.full((2, 2, 2), "1.5"), "real numbers"),
        ([[[1.5, 1.5], [1.5]]], "differ in length"),
    ],
)
def test_what_is_no_array_of_real_numbers_is_refused(n, words):
    with pytest.raises(SceneError, match=rf"^n: .*{words}"):
        Volume.from_array(n, 1.0)


def test_bodies_that_are_no_pairs_are_refused_by_number():
    with pytest.raises(SceneError, match=r"regions\[1\]: cannot be 'function'"):
        Volume.from_regions([(ball(0.3), "water"), ball(0.2)], 8, 1.0)


def test_a_volume_is_shown_in_a_line():
    text = repr(Volume.from_sdf(ball(0.3), "water", 32, 1.0))
    assert text == "Volume(1 x 1 x 1 m, shape=(32, 32, 32), ambient_n=1, of water)"
    assert len(repr(Volume.from_sdf(ball(0.3), "water", 32, 1.0).regions[0])) < 1000


def test_rounding_keeps_a_smooth_body_and_takes_the_facets_off_a_coarse_one() -> None:
    """A ball of 80 facets, blurred by two voxels, is rounder than before and no larger; rays still cannot overstep."""
    import trimesh

    coarse = trimesh.creation.icosphere(subdivisions=1, radius=1.0)
    flat, _ = Volume.from_mesh(coarse.vertices, coarse.faces, 1.5, 64)
    round_, _ = Volume.from_mesh(coarse.vertices, coarse.faces, 1.5, 64, rounding_voxels=2.0)

    def spread(volume: Volume) -> float:
        """Standard deviation of the radius of the surface, found between voxels along the axes of the grid."""
        sdf = volume.regions[0].sdf
        z, y, x = np.nonzero((sdf[..., :-1] < 0) != (sdf[..., 1:] < 0))
        a, b = sdf[z, y, x], sdf[z, y, x + 1]
        at = np.stack([x + a / (a - b), y, z], axis=1) + 0.5 - 0.5 * np.array(sdf.shape[::-1])
        return float(np.std(np.linalg.norm(at, axis=1)))

    assert spread(round_) < 0.75 * spread(flat)
    steps = [np.abs(np.diff(round_.regions[0].sdf, axis=a)).max() for a in range(3)]
    assert max(steps) <= round_.voxel_m[0] * 1.001, "a distance changes by at most the distance"


@pytest.mark.parametrize("voxels", [-1.0, 9.0, float("nan"), "1", True])
def test_rounding_out_of_range_is_refused(voxels: object) -> None:
    cube = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
    with pytest.raises(SceneError, match="rounding_voxels"):
        Volume.from_mesh(*cube, 1.5, 32, rounding_voxels=voxels)  # type: ignore[arg-type]


def test_an_index_that_no_matter_has_is_refused() -> None:
    with pytest.raises(SceneError, match="no matter"):
        Volume.from_array(np.full((4, 4, 4), 1e30), 0.1)


# ---- crystals -----------------------------------------------------------------------------------------------


def cube(axis=None, medium="calcite"):
    return Volume.from_sdf(lambda x, y, z: np.abs(x) - 0.02, medium, 8, 0.1, optic_axis=axis)


def test_an_optic_axis_is_kept_as_a_unit_vector():
    assert cube().regions[0].optic_axis is None and not cube().has_crystals
    body = cube((0, 3, 4))
    assert body.regions[0].optic_axis == pytest.approx((0.0, 0.6, 0.8)) and body.has_crystals
    bodies = Volume.from_regions(
        [(lambda x, y, z: x, "calcite"), (lambda x, y, z: -x, "N-BK7")], 8, 0.1, optic_axes=[(2, 0, 0), None]
    )
    assert [r.optic_axis for r in bodies.regions] == [(1.0, 0.0, 0.0), None]
    field = np.zeros((8, 8, 8, 3), np.float32)
    field[..., 1] = 2.0
    np.testing.assert_allclose(cube().replace(optic_axis=field).optic_axis, field / 2.0)


@pytest.mark.parametrize("axis", [(0, 0, 0), (1, 2), (np.nan, 0, 1), "up"])
def test_what_is_no_axis_is_refused(axis):
    with pytest.raises(SceneError, match="optic_axis"):
        cube(axis)


def test_crystals_that_cannot_be_are_refused():
    field = np.ones((8, 8, 8, 3), np.float32)
    index = np.full((8, 8, 8), 0.5, np.float32)
    with pytest.raises(SceneError, match="N-BK7 has one index"):
        cube((0, 1, 0), "N-BK7")
    with pytest.raises(SceneError, match="N-BK7 has one index"):
        cube(medium="N-BK7").replace(optic_axis=field)
    with pytest.raises(SceneError, match="length 0"):
        cube().replace(optic_axis=0.0 * field)
    with pytest.raises(SceneError, match="without regions"):
        Volume.from_array(1.5 + 0 * index, 0.1).replace(optic_axis=field)
    with pytest.raises(SceneError, match="without an axis"):
        cube().replace(delta_n_e=index)
    with pytest.raises(SceneError, match="between 0 and 100"):
        cube((0, 1, 0)).replace(delta_n_e=-3.0 * index)
    with pytest.raises(SceneError, match="2 for 1 regions"):
        Volume.from_regions([(lambda x, y, z: x, "calcite")], 8, 0.1, optic_axes=[None, None])
    assert cube(medium="N-BK7").replace(optic_axis=field, delta_n_e=index).has_crystals
