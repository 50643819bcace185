"""Volumes composed into one: distances, priority, fields, and what cannot be composed."""

from __future__ import annotations

import numpy as np
import pytest

import pellucid as pl
from pellucid.fields import shapes
from pellucid.fields.composition import can_compose, compose
from pellucid.fields.reaching import Part, matter_of
from pellucid.scene.placement import placement_matrix


def part(volume, position=(0, 0, 0), rotation=(0, 0, 0), scale=1.0, boundary=None):
    drawn = boundary or ("sharp" if volume.regions else "smooth")
    return Part(volume, drawn, placement_matrix(position, rotation, scale))


def composed(*parts):
    assert can_compose(parts)
    return compose(parts, [matter_of(p.volume, p.boundary) for p in parts])


def centres_ws(volume, world):
    """(Z, Y, X, 3) voxel centres in the world."""
    lines = [(np.arange(n) + 0.5) * h - 0.5 * n * h for n, h in zip(volume.shape, volume.voxel_m[::-1], strict=True)]
    z, y, x = np.meshgrid(*lines, indexing="ij")
    return np.stack([x, y, z], axis=-1) @ world[:3, :3].T + world[:3, 3]


def ball(radius, medium=1.5, n=48):
    return pl.Volume.from_sdf(shapes.sphere(radius), medium, n, 2.5 * radius)


def test_distances_are_those_of_the_placed_bodies():
    """Turned, scaled and moved: near the surfaces to a twentieth of a voxel, and nowhere much longer than they are."""
    volume, world = composed(
        part(ball(0.01, 1.3), (0.02, 0.01, 0.0), (20, 30, 40), 1.4), part(ball(0.04), (0, 0, 0.01), (5, 0, 0))
    )
    x = centres_ws(volume, world)
    voxel = volume.voxel_m[0]
    for region, center, radius in zip(volume.regions, ((0.02, 0.01, 0.0), (0, 0, 0.01)), (0.014, 0.04), strict=True):
        truth = np.linalg.norm(x - center, axis=-1) - radius
        near = np.abs(truth) < 2 * voxel
        assert np.abs(region.sdf - truth)[near].max() < 0.05 * voxel
        assert (np.abs(region.sdf) - 1.05 * np.abs(truth)).max() < 0.05 * voxel


def test_the_finest_part_is_taken_over_voxel_by_voxel():
    fine, coarse = ball(0.02, 1.4, 40), ball(0.04, 1.5, 30)
    volume, world = composed(part(fine, (0.003, 0, 0)), part(coarse))
    assert np.allclose(volume.voxel_m, fine.voxel_m)
    own = np.linalg.inv(placement_matrix((0.003, 0, 0), (0, 0, 0), 1.0)) @ world
    first = np.round((own[:3, 3] - 0.5 * np.array(volume.extent_m) + 0.025) / fine.voxel_m[0]).astype(int)
    x, y, z = -first
    block = volume.regions[0].sdf[z : z + 40, y : y + 40, x : x + 40]
    inside = slice(1, 39)
    assert np.abs(block[inside, inside, inside] - fine.regions[0].sdf[inside, inside, inside]).max() < 1e-6 * 0.05


def test_bodies_of_one_medium_become_one_region():
    volume, _ = composed(part(ball(0.02), (-0.01, 0, 0)), part(ball(0.02), (0.01, 0, 0)))
    assert len(volume.regions) == 1
    colour = pl.media.constant(1.5, (1.0, 2.0, 3.0))
    assert len(composed(part(ball(0.02), (-0.01, 0, 0)), part(ball(0.02, colour), (0.01, 0, 0)))[0].regions) == 2


def test_a_body_keeps_smoke_out_and_smoke_adds_up_elsewhere():
    def cloud(edge, strength, g):
        fields = {"scattering": np.full((16, 16, 16, 3), strength), "anisotropy": np.full((16, 16, 16), g)}
        return pl.Volume.from_array(np.ones((16, 16, 16)), edge, **fields)

    volume, world = composed(
        part(ball(0.01)), part(cloud(0.06, 2.0, 0.8), (0.02, 0, 0)), part(cloud(0.12, 4.0, -0.1), rotation=(0, 0, 20))
    )
    x = centres_ws(volume, world)
    r = np.linalg.norm(x, axis=-1)
    inner = (np.abs(x - (0.02, 0, 0)) < 0.027).all(axis=-1)
    assert np.abs(volume.scattering[r < 0.008]).max() == 0.0
    assert np.allclose(volume.scattering[inner & (r > 0.012)], 6.0)
    assert np.allclose(volume.anisotropy[inner & (r > 0.012)], (2.0 * 0.8 - 4.0 * 0.1) / 6.0, atol=1e-5)
    assert volume.regions and volume.ambient_n == 1.0


def test_fields_of_index_are_laid_over_one_another():
    lens = pl.Volume.from_function(lambda x, y, z: 1.0 + 0.1 * (x * x + y * y + z * z < 0.01**2), 32, 0.03)
    air = pl.Volume.from_function(lambda x, y, z: 1.0002 + 0 * x, 16, 0.06, ambient_n=1.0002).replace(
        delta_n=np.full((16, 16, 16), 1e-4)
    )
    volume, world = composed(part(lens), part(air))
    r = np.linalg.norm(centres_ws(volume, world), axis=-1)
    assert volume.ambient_n == 1.0002 and not volume.regions
    assert np.abs(volume.delta_n[r < 0.008] - (0.1 - 2e-4)).max() < 1e-5
    assert np.abs(volume.delta_n[(r > 0.012) & (r < 0.026)] - 1e-4).max() < 1e-6


def test_what_cannot_be_one_volume_is_told():
    glass, graded = ball(0.02), pl.Volume.from_function(lambda x, y, z: 1.3 + x, 16, 0.05)
    inhomogeneous = glass.replace(delta_n=np.full(glass.shape, 0.4))
    assert not can_compose([part(glass), part(graded)])
    assert not can_compose([part(glass), part(graded, boundary="sharp")])
    assert not can_compose([part(glass), part(inhomogeneous)])
    assert can_compose([part(inhomogeneous), part(glass)])
    five = [part(ball(0.02, 1.3 + 0.1 * k, 16)) for k in range(5)]
    assert not can_compose(five) and can_compose(five[:4])


def test_the_number_of_voxels_is_bounded(monkeypatch):
    monkeypatch.setattr("pellucid.fields.composition.MOST_COMPOSED_VOXELS", 40**3)
    volume, _ = composed(part(ball(0.01, 1.3, 32)), part(ball(0.05)))
    assert np.prod(volume.shape) < (40 + 8) ** 3


@pytest.mark.parametrize("boundary", ["sharp", "smooth"])
def test_matter_is_boxed(boundary):
    box = matter_of(ball(0.02), boundary)
    assert np.abs(box.high - 0.02).max() < 0.05 / 48 and np.abs(box.low + 0.02).max() < 0.05 / 48
