"""Analytic shapes for `Volume.from_sdf` and `from_regions`, and graded indices for `from_function`.

All take arrays in metres. Signed distances are negative inside and never larger than the distance to the
surface, except for `ellipsoid` and what is made of it.
"""

from pellucid.fields.shapes.creature import creature, creature_mesh
from pellucid.fields.shapes.gems import (
    brilliant_cut,
    brilliant_planes,
    convex,
    emerald_cut,
    emerald_planes,
    rhombohedron,
)
from pellucid.fields.shapes.glassware import wine_glass
from pellucid.fields.shapes.graded import grin_rod, hot_air, luneburg, maxwell_fish_eye
from pellucid.fields.shapes.lettering import embossed_block, lettering
from pellucid.fields.shapes.outlines import extruded_polygon, lathe, polygon_distance, prism, smooth_curve
from pellucid.fields.shapes.primitives import (
    Shape,
    box,
    capsule,
    cylinder,
    difference,
    ellipsoid,
    extruded,
    grown,
    intersection,
    moved,
    nested_rounded_cubes,
    plane,
    rotated,
    rounded_box,
    smooth_union,
    sphere,
    torus,
    union,
)
from pellucid.fields.surface_nets import surface_nets

__all__ = [
    "Shape", "box", "brilliant_cut", "brilliant_planes", "capsule", "convex", "creature", "creature_mesh",
    "cylinder", "difference", "ellipsoid", "embossed_block", "emerald_cut", "emerald_planes", "extruded",
    "extruded_polygon", "grin_rod", "grown", "hot_air", "intersection", "lathe", "lettering", "luneburg",
    "maxwell_fish_eye", "moved", "nested_rounded_cubes", "plane", "polygon_distance", "prism", "rhombohedron",
    "rotated", "rounded_box", "smooth_curve", "smooth_union", "sphere", "surface_nets", "torus", "union", "wine_glass",
]  # fmt: skip
