"""What things are made of: named media with their index, absorption and sources."""

from pellucid.media.catalogue import get, names, resolve
from pellucid.media.medium import Medium, constant, uniaxial
from pellucid.media.water_body import WaterBody, water_body

__all__ = ["Medium", "WaterBody", "constant", "get", "names", "resolve", "uniaxial", "water_body"]
