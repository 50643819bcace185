"""Light by wavelength: what a standard observer sees of it, and spectra that have a given colour."""

from pellucid.spectra.observer import colour_matching, daylight, rgb_of_light
from pellucid.spectra.wavelengths import LONGEST_NM, SHORTEST_NM, stratified, weights

__all__ = ["LONGEST_NM", "SHORTEST_NM", "colour_matching", "daylight", "rgb_of_light", "stratified", "weights"]
