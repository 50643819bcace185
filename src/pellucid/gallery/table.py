"""On the table: a glass of wine, and a cut stone."""

from __future__ import annotations

from pellucid import media
from pellucid.fields import shapes
from pellucid.scene import Camera, DirectionalLight, Environment, Mesh, Quality, RefractiveVolume, Scene

from . import stage
from .picture import Picture


def wine_glass() -> Scene:
    """A stemmed glass 22 cm high, of soda-lime glass, with red wine."""
    height = 0.22
    glass, wine = shapes.wine_glass(height, wall_m=0.0024, filled=0.36)
    claret = media.get("water").with_absorption((7.0, 95.0, 62.0), name="claret")
    body = RefractiveVolume.from_regions(
        [(glass, "soda-lime glass"), (wine, claret)], 288, (0.086, 1.03 * height, 0.086),
        position=(0.0, 0.5 * height + stage.GAP_M, 0.0), dispersion=False,
        light=stage.QUICK_LIGHT.replace(caustic_texels=512),
    )  # fmt: skip
    wall = Mesh.plane((6.0, 3.0), position=(0.0, 0.0, -0.9), rotation=(90.0, 0.0, 0.0), base_color=(0.13, 0.14, 0.16))
    plate = Mesh.box((0.14, 0.012, 0.11), position=(0.125, 0.006, -0.06), rotation=(0.0, 20.0, 0.0),
                     base_color=(0.06, 0.07, 0.08), roughness=0.35)  # fmt: skip
    grapes = [
        Mesh.sphere(0.0105, 48, position=(0.125 + dx, 0.0215 + dy, -0.06 + dz), base_color=(0.045, 0.008, 0.03),
                    roughness=0.32)
        for dx, dy, dz in ((0, 0, 0), (0.021, 0, 0.004), (-0.02, 0, 0.008), (0.008, 0, 0.021), (-0.013, 0, 0.028),
                           (0.004, 0.016, 0.009), (-0.016, 0.015, 0.017), (0.028, 0, 0.024), (-0.006, 0, -0.02))
    ]  # fmt: skip
    return Scene(
        Camera((0.02, 0.21, 0.52), (-0.01, 0.098, 0.0), fov_deg=30.0),
        Environment.studio(),
        [DirectionalLight((-0.42, -0.86, 0.28), (1.0, 0.97, 0.92), 2.6)],
        [stage.table(0.5, stage.wood(), 5.0, roughness=0.4), wall, plate, *grapes, body],
        exposure=0.75,
        tone_mapping="khronos",
    )


def brilliant() -> Scene:
    """A round brilliant of diamond, 1 cm across, lying on its pavilion."""
    diameter = 0.01
    stone = RefractiveVolume.from_sdf(
        shapes.brilliant_cut(diameter), "diamond", 160, (1.06 * diameter, 0.72 * diameter, 1.06 * diameter),
        position=(0.0, 0.0047, 0.0), rotation=(24.0, 0.0, 0.0), quality=Quality(bounces=8, min_weight=0.02),
        light=stage.FACET_LIGHT,
    )  # fmt: skip
    slate = stage.stone(512, (0.012, 0.013, 0.017), 0.22)
    return Scene(
        Camera((0.003, 0.026, 0.032), (0.0, 0.0042, 0.0), fov_deg=23.0, near_m=0.002),
        stage.jewellers_lamps(),
        [stage.key_light(1.0)],
        [stage.table(0.05, slate, 0.6, roughness=0.8, specular=0.02), stone],
        exposure=0.7,
        tone_mapping="khronos",
    )


PICTURES = (
    Picture(
        "wine-glass",
        "Glass of red wine",
        "A stemmed glass with red wine, lit from above; in its shadow on the table the wine gathers a red spot.",
        wine_glass,
        5,
    ),
    Picture(
        "brilliant",
        "Brilliant cut diamond",
        "Facets that are bright beside facets that are dark, with flashes of colour where white light is split.",
        brilliant,
        3,
    ),
)
