"""What light does by itself: colours of a prism, lenses without a surface, hot air."""

from __future__ import annotations

import numpy as np

from pellucid.fields import shapes
from pellucid.fields.volume import Volume
from pellucid.scene import Camera, DirectionalLight, Environment, LightQuality, Mesh, Quality, RefractiveVolume, Scene

from . import stage
from .picture import Picture


def dispersion_prism() -> Scene:
    """A standing prism of N-SF66 before a curved screen of white bars on black.

    Its edge of 45 deg turns light by 50 deg at least deviation, and blue 2.3 deg more than red. A turn of half
    the deviation makes the viewer look through it just there. Eight wavelengths, others in
    each sample, make a spectrum without bands; the light on the floor can be coarser.
    """
    edge, side, tall, plinth, bevel = np.radians(45.0), 0.048, 0.06, 0.03, 0.0008
    x, z = side * np.cos(0.5 * edge), side * np.sin(0.5 * edge)
    outline = [(-0.5 * x, -z), (0.5 * x, 0.0), (-0.5 * x, z)]
    body = shapes.grown(shapes.extruded_polygon(outline, tall - 2.0 * bevel), bevel)
    prism = RefractiveVolume.from_sdf(
        body, "N-SF66", 128, (1.13 * x, 2.25 * z, 1.08 * tall),
        position=(0.0, plinth + 0.5 * tall + stage.GAP_M, 0.0), rotation=(-90.0, 25.0, 0.0),
        spectral=8, quality=Quality(bounces=6, min_weight=0.02),
        light=LightQuality(front_voxels=4.0, split_voxels=4.0, bounces=4, min_flux=0.02, caustic_texels=128),
    )  # fmt: skip
    floor = stage.table(0.3, stage.stone(512, (0.10, 0.10, 0.11), 0.1), 4.0, roughness=0.7)
    block = Mesh.box((0.075, plinth, 0.06), position=(0.0, 0.5 * plinth, 0.0), rotation=(0.0, 25.0, 0.0),
                     base_color=(0.16, 0.05, 0.025), roughness=0.4)  # fmt: skip
    return Scene(
        Camera((0.0, 0.082, 0.27), (-0.002, 0.054, 0.0), fov_deg=23.0),
        Environment.studio(),
        [DirectionalLight((0.25, -0.8, -0.8), (1.0, 1.0, 1.0), 3.5)],
        [floor, _barred_screen(0.32, 0.24, 36, 0.4), block, prism],
        exposure=0.75,
        tone_mapping="khronos",
    )


def _barred_screen(radius_m: float, height_m: float, bars: int, share: float) -> Mesh:
    """The wall of an upright half cylinder, open towards the viewer, with bars on it."""
    turn = np.radians(np.linspace(-112.0, 112.0, 97))
    x, z = radius_m * np.sin(turn), -radius_m * np.cos(turn)
    low, high = np.column_stack([x, 0.0 * x, z]), np.column_stack([x, 0.0 * x + height_m, z])
    across = np.linspace(0.0, 1.0, len(turn))
    uvs = np.concatenate([np.column_stack([across, 0.0 * across]), np.column_stack([across, 0.0 * across + 1.0])])
    i, n = np.arange(len(turn) - 1), len(turn)
    faces = np.concatenate([np.column_stack([i, i + 1, i + n + 1]), np.column_stack([i, i + n + 1, i + n])])
    pattern = stage.stripes(2048, bars, (0.86, 0.86, 0.86), (0.012, 0.012, 0.012), share)
    return Mesh(
        np.concatenate([low, high]), faces, uvs=uvs, base_color=(1.0, 1.0, 1.0), base_color_map=pattern, roughness=0.9
    )


def graded_lenses() -> Scene:
    """Luneburg's lens and Maxwell's fish-eye, whose index falls smoothly to that of air at the rim."""
    radius = 0.04
    lenses = [
        RefractiveVolume.from_function(
            index(radius),
            128,
            2.1 * radius,
            boundary="smooth",
            position=(x, 1.06 * radius, 0.0),
            light=stage.QUICK_LIGHT,
        )
        for index, x in ((shapes.luneburg, -0.05), (shapes.maxwell_fish_eye, 0.05))
    ]
    sky, sun = stage.daylight()
    tiles = stage.grid(512, 2, (0.66, 0.62, 0.54), (0.015, 0.09, 0.13), 0.16)
    pencils = [
        Mesh.box((0.014, 0.075, 0.014), position=(x, 0.0375, -0.11), rotation=(0.0, 30.0, 0.0), base_color=color)
        for x, color in ((-0.13, (0.62, 0.06, 0.03)), (-0.045, (0.80, 0.44, 0.05)), (0.045, (0.08, 0.30, 0.12)),
                         (0.13, (0.05, 0.13, 0.42)))
    ]  # fmt: skip
    return Scene(
        Camera((0.0, 0.09, 0.30), (0.0, 0.044, 0.0), fov_deg=32.0),
        sky,
        [sun],
        [stage.table(0.05, tiles, 60.0), *pencils, *lenses],
        exposure=0.62,
        tone_mapping="khronos",
    )


def hot_air() -> Scene:
    """Air over a hot plate, before a ruled card twenty metres behind, through a long lens: nothing is exaggerated."""
    width, height = 0.011, 0.16
    plume = RefractiveVolume.from_function(
        shapes.hot_air(width, height, warmer_k=900.0, sway=1.6), 96, (0.13, height, 0.13), boundary="smooth",
        position=(0.0, 0.5 * height, 0.0), smoothing_voxels=0.0,
        light=LightQuality(caustics=False),
    )  # fmt: skip
    sky, sun = stage.daylight(40.0, 160.0)
    ruled = stage.grid(2048, 64, (0.70, 0.68, 0.62), (0.02, 0.06, 0.18), 0.2)
    card = Mesh.plane((2.4, 2.4), position=(0.0, 0.1, -20.0), rotation=(90.0, 0.0, 0.0))
    card = card.replace(base_color=(1.0, 1.0, 1.0), base_color_map=ruled, roughness=0.9)
    plate = Mesh.box((0.13, 0.02, 0.13), position=(0.0, -0.009, 0.0), base_color=(0.035, 0.036, 0.04), roughness=0.3,
                     emission=(0.03, 0.003, 0.0))  # fmt: skip
    return Scene(
        Camera((0.0, 0.09, 4.0), (0.0, 0.06, 0.0), fov_deg=2.1),
        sky,
        [sun],
        [card, plate, plume],
        exposure=0.62,
        tone_mapping="khronos",
    )


def spectrum() -> Scene:
    """A slit of sunlight through a prism of SF10 in thin smoke, on to a screen.

    Seen from above the beam comes along x. Inside the prism it runs along the base, so that it is turned least: by
    60 deg, and violet 7 deg more than red.
    """
    side, tall, half_turn, slit = 0.05, 0.045, np.radians(29.8), 0.004
    along = np.array([np.cos(half_turn), np.sin(half_turn)])
    base = np.array([-along[1], along[0]])
    low, high = np.array([-0.095, -0.04]), np.array([0.16, 0.165])
    centre = 0.25 * side * along + base * side / (4.0 * np.sqrt(3.0)) - 0.5 * (low + high)
    corners = [centre - base * side / np.sqrt(3.0)]
    corners += [centre + base * side / (2.0 * np.sqrt(3.0)) + sign * 0.5 * side * along for sign in (1.0, -1.0)]
    outline = [(float(x), float(y)) for x, y in corners]
    extent = (float(high[0] - low[0]), float(high[1] - low[1]), 1.1 * tall)
    body = Volume.from_sdf(shapes.extruded_polygon(outline, tall), "SF10", 128, extent)
    smoke = np.where(np.asarray(body.regions[0].sdf) > 0.0, 3.5, 0.0)
    prism = RefractiveVolume.from_volume(
        body.replace(scattering=np.repeat(smoke[..., None], 3, axis=3), anisotropy=np.full(body.shape, 0.3)),
        position=(float(0.5 * (low[0] + high[0])), 0.55 * tall + stage.GAP_M, float(-0.5 * (low[1] + high[1]))),
        rotation=(-90.0, 0.0, 0.0), spectral=12, quality=Quality(bounces=4, min_weight=0.05),
        light=LightQuality(bounces=4, min_flux=1e-2, caustic_texels=400),
    )  # fmt: skip
    dark = {"base_color": (0.03, 0.03, 0.035), "roughness": 0.7}
    screens = [
        Mesh.box((0.006, 0.16, 0.3), position=(-0.11, 0.08, sign * (0.15 + 0.5 * slit)), **dark) for sign in (-1.0, 1.0)
    ]
    screens.append(Mesh.box((0.006, 0.12, 0.02), position=(-0.11, 0.1, 0.0), **dark))
    screens.append(Mesh.box((0.006, 0.012, 0.02), position=(-0.11, 0.006, 0.0), **dark))
    wall = Mesh.plane((0.3, 0.09), position=(0.07, 0.045, -0.18), rotation=(90.0, 0.0, 0.0), base_color=(0.8,) * 3,
                      roughness=0.9)  # fmt: skip
    return Scene(
        Camera((0.03, 0.23, 0.20), (0.03, 0.012, -0.065), fov_deg=37.0),
        Environment.studio(intensity=0.08),
        [DirectionalLight((1.0, 0.0, 0.0), (1.0, 1.0, 1.0), 70.0)],
        [stage.table(0.3, stage.stone(512, (0.10, 0.10, 0.11), 0.1), 2.0, roughness=0.8), wall, *screens, prism],
        exposure=1.6,
        tone_mapping="khronos",
    )


PICTURES = (
    Picture(
        "dispersion-prism",
        "Prism of dense flint",
        "Through the prism every edge between black and white has a coloured fringe: red and yellow on one side, "
        "blue and violet on the other.",
        dispersion_prism,
        3,
    ),
    Picture(
        "spectrum",
        "Spectrum of a prism",
        "A narrow beam of white light, seen in thin smoke, is turned by a prism and fans out into a spectrum on a "
        "screen: red is turned least, violet most.",
        spectrum,
        1,
    ),
    Picture(
        "graded-lenses",
        "Luneburg lens and Maxwell fish-eye",
        "Two balls that bend light without reflecting any: the world stands upside down in them, and they have no "
        "glossy rim.",
        graded_lenses,
        3,
    ),
    Picture(
        "hot-air",
        "Air over a hot plate",
        "The straight rulings of a card far behind waver above the hot plate; the air itself cannot be seen.",
        hot_air,
        2,
    ),
)
