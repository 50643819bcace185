"""Procedural surfaces for relief: heights, normals and colours of a tile that agree, repeat and need no file.

Heights are metres; the polygon is at 0. The same parameters and seed give the same maps.
"""

from pellucid.fields.textures.liquids import drops, puddles
from pellucid.fields.textures.maps import Maps
from pellucid.fields.textures.masonry import bricks, cobbles, tiles
from pellucid.fields.textures.worked import brushed_metal, hammered_glass, skin

__all__ = ["Maps", "bricks", "brushed_metal", "cobbles", "drops", "hammered_glass", "puddles", "skin", "tiles"]
