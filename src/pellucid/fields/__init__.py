"""Data that the laws of light act on: volumes, distances, shapes, height fields at rest and in motion. NumPy only."""

from pellucid.fields import shapes, textures
from pellucid.fields.distance import homogeneous_distance
from pellucid.fields.drops import Drops
from pellucid.fields.dynamic import DynamicHeights
from pellucid.fields.gradient import central, sobel
from pellucid.fields.smoothing import gaussian
from pellucid.fields.surface_nets import surface_nets
from pellucid.fields.volume import Region, Volume
from pellucid.fields.voxelise import signed_distance
from pellucid.fields.waves import Ripples

__all__ = [
    "Drops", "DynamicHeights", "Region", "Ripples", "Volume", "central", "gaussian", "homogeneous_distance", "shapes",
    "signed_distance", "sobel", "surface_nets", "textures",
]  # fmt: skip
