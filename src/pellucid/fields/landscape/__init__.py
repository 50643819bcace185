"""A lake with its surroundings from a seed: ground with a basin, stones, trees and reeds, as triangles."""

from pellucid.fields.landscape.ground import Ground, ground_map, lake_basin, weathered
from pellucid.fields.landscape.growth import conifer, reeds
from pellucid.fields.landscape.patch import Patch, joined
from pellucid.fields.landscape.stones import stone

__all__ = ["Ground", "Patch", "conifer", "ground_map", "joined", "lake_basin", "reeds", "stone", "weathered"]
