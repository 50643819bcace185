"""Data that the laws of light act on: volumes, distances, meshes on voxels, analytic shapes, textures. NumPy only."""

from pellucid.fields import shapes, textures
from pellucid.fields.distance import homogeneous_distance
from pellucid.fields.gradient import central, sobel
from pellucid.fields.smoothing import gaussian
from pellucid.fields.surface_nets import surface_nets
from pellucid.fields.volume import Region, Volume
from pellucid.fields.voxelise import signed_distance

__all__ = [
    "Region", "Volume", "central", "gaussian", "homogeneous_distance", "shapes", "signed_distance", "sobel",
    "surface_nets", "textures",
]  # fmt: skip
