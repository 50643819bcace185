"""Light inside matter: a sphere that glows, an animal in smoke, a glass over a lamp, a beam in a prism."""

from __future__ import annotations

import dataclasses

import numpy as np

from pellucid import media
from pellucid.fields import shapes
from pellucid.fields.volume import Volume
from pellucid.scene import (
    Camera,
    DirectionalLight,
    Environment,
    LightQuality,
    Mesh,
    PointLight,
    Quality,
    RefractiveVolume,
    Scene,
)

from . import stage
from .picture import Picture


def glowing_sphere() -> Scene:
    """A ball of blue glass with a core that shines by itself, under a sky whose sun is in it."""
    radius = 0.04
    glass = Volume.from_sdf(shapes.sphere(radius), stage.tinted("N-BK7", (16.0, 9.0, 2.0)), 128, 2.15 * radius)
    x, y, z = stage.voxel_centres(glass)
    turn = np.arctan2(z, x)
    wire = np.hypot(np.hypot(x, z) - 0.0125 - 0.003 * np.cos(3.0 * turn), y - 0.004 * np.sin(3.0 * turn))
    blob = np.exp(-((wire / 0.0017) ** 2)) + 0.25 * np.exp(-((x * x + y * y + z * z) / 0.0042**2))
    glow = blob[..., None] * np.array([560.0, 200.0, 26.0])
    ball = RefractiveVolume.from_volume(
        glass.replace(emission=glow.astype(np.float32)), position=(0.0, radius + stage.GAP_M, 0.0),
        rotation=(38.0, 0.0, 12.0), dispersion=False, light=stage.QUICK_LIGHT,
    )  # fmt: skip
    sky, sun = stage.daylight(16.0, 130.0)
    return Scene(
        Camera((0.05, 0.075, 0.21), (0.0, 0.036, 0.0), fov_deg=30.0),
        sky,
        [sun],
        [stage.table(0.3, stage.stone(512, (0.42, 0.40, 0.37), 0.1), 40.0, roughness=0.5), ball],
        exposure=0.6,
        tone_mapping="khronos",
        glow=0.03,
    )


def smoky_showcase() -> Scene:
    """An animal of amber with black inclusions in a case of thin smoke, lit from underneath only."""
    height, voxels = 0.09, 112
    extent = (0.13, 0.155, 0.13)
    amber = media.get("amber").with_absorption((4.0, 22.0, 110.0), name="clear amber")
    lift = 0.5 * extent[1] - 0.5 * height - 0.012
    animal = shapes.moved(shapes.rotated(shapes.creature(height), stage.turned(25.0)), (0.0, -lift, 0.0))
    body = Volume.from_regions([(animal, amber)], voxels, extent)
    body = body.replace(regions=(dataclasses.replace(body.regions[0], scattering=(7.0, 5.0, 2.0), anisotropy=0.5),))
    x, y, z = stage.voxel_centres(body)
    inside = np.asarray(body.regions[0].sdf) < -0.002
    rng = np.random.default_rng(8)
    dark = np.zeros(body.shape)
    for cx, cy, cz, r in zip(*rng.uniform(-1, 1, (3, 34)), rng.uniform(0.0018, 0.0045, 34), strict=True):
        far = np.sqrt((x - 0.03 * cx) ** 2 + (y + lift - 0.045 * cy) ** 2 + (z - 0.03 * cz) ** 2)
        dark = np.maximum(dark, np.clip((r - far) / 0.0012 + 0.5, 0.0, 1.0))
    wisps = 1.0 + 0.35 * stage.noise_3d(body.shape, 9.0, 4)
    smoke = np.where(np.asarray(body.regions[0].sdf) > 0.0, np.clip(wisps, 0.2, 2.0) * 1.7, 0.0)
    case = RefractiveVolume.from_volume(
        body.replace(
            absorption=np.repeat((1400.0 * dark * inside)[..., None], 3, axis=3),
            scattering=np.repeat(smoke[..., None], 3, axis=3),
            anisotropy=np.full(body.shape, 0.45),
        ),
        position=(0.0, 0.5 * extent[1] + stage.GAP_M, 0.0), dispersion=False, quality=Quality(bounces=6),
        light=LightQuality(caustics=False, front_voxels=1.5, min_flux=1e-2),
    )  # fmt: skip
    frame = [
        Mesh.box((0.003, extent[1], 0.003), position=(sx * 0.068, 0.5 * extent[1], sz * 0.068), base_color=(0.02,) * 3,
                 roughness=0.4)
        for sx in (-1, 1) for sz in (-1, 1)
    ]  # fmt: skip
    plinth = Mesh.box((0.16, 0.05, 0.16), position=(0.0, -0.0252, 0.0), base_color=(0.03, 0.03, 0.035), roughness=0.35)
    lamp = PointLight((0.02, -0.13, 0.015), (1.0, 0.93, 0.82), 0.34, cast_shadow=False)
    return Scene(
        Camera((0.13, 0.105, 0.52), (0.0, 0.062, 0.0), fov_deg=18.5),
        Environment.studio(intensity=0.07),
        [lamp],
        [plinth, *frame, case],
        exposure=1.0,
        tone_mapping="khronos",
        glow=0.04,
    )


def lit_from_below() -> Scene:
    """A glass of wine on a pane of light in a dark room; the wine is a little turbid, so that it glows."""
    height = 0.22
    glass, wine = shapes.wine_glass(height, wall_m=0.0024, filled=0.42)
    claret = media.get("water").with_absorption((7.0, 95.0, 62.0), name="claret")
    body = Volume.from_regions([(glass, "soda-lime glass"), (wine, claret)], 256, (0.086, 1.03 * height, 0.086))
    clear, turbid = body.regions
    turbid = dataclasses.replace(turbid, scattering=(9.0, 5.0, 5.0), anisotropy=0.4)
    stemware = RefractiveVolume.from_volume(
        body.replace(regions=(clear, turbid)), position=(0.0, 0.5 * height + stage.GAP_M, 0.0), dispersion=False,
        light=LightQuality(caustics=False, front_voxels=2.0, min_flux=1e-2),
    )  # fmt: skip
    pane = Mesh.box((0.26, 0.01, 0.26), position=(0.0, -0.005, 0.0), base_color=(0.0, 0.0, 0.0), specular=0.0,
                    emission=(0.85, 0.80, 0.72), rotation=(0.0, 20.0, 0.0))  # fmt: skip
    table = stage.table(0.5, stage.wood(), 5.0, roughness=0.35, position=(0.0, -0.0102, 0.0))
    up = DirectionalLight((0.0, 1.0, 0.0), (1.0, 0.94, 0.85), 2.6, cast_shadow=False)
    return Scene(
        Camera((0.08, 0.17, 0.5), (0.0, 0.1, 0.0), fov_deg=31.0),
        Environment.studio(intensity=0.2),
        [up],
        [table, pane, stemware],
        exposure=0.9,
        tone_mapping="khronos",
        glow=0.04,
    )


PICTURES = (
    Picture(
        "glowing-sphere",
        "Coloured sphere with a core that shines",
        "A ball of blue glass under the open sky; in its middle an orange ring glows by itself, and under it the sun "
        "is gathered in a blue spot.",
        glowing_sphere,
        3,
    ),
    Picture(
        "smoky-showcase",
        "Animal of amber in smoke",
        "An animal of amber with black inclusions, lit from underneath: light gathers over it in the smoke, between "
        "the shadows that the inclusions throw upwards.",
        smoky_showcase,
        3,
    ),
    Picture(
        "lit-from-below",
        "Glass of wine over a lamp",
        "A glass of wine stands on a pane of light in a dark room; the wine glows red, most of all at its bottom.",
        lit_from_below,
        3,
    ),
)
