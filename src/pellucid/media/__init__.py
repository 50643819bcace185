"""What things are made of: named media with their index, absorption and sources."""

from pellucid.media.catalogue import get, names, resolve
from pellucid.media.medium import Medium, constant, uniaxial

__all__ = ["Medium", "constant", "get", "names", "resolve", "uniaxial"]
