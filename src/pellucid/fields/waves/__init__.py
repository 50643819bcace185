"""Water in motion: heights, and the slopes that belong to them, at a time."""

from pellucid.fields.waves.disturbances import Disturbance, Push
from pellucid.fields.waves.heights import Heights
from pellucid.fields.waves.layers import Sum, ripples_of
from pellucid.fields.waves.mesh import MeshWaves
from pellucid.fields.waves.ocean import Ocean
from pellucid.fields.waves.ripples import BOUNDARIES, Plan, Ripples
from pellucid.fields.waves.source import WaveSource, WaveSurface
from pellucid.fields.waves.stored import from_plain, to_plain
from pellucid.fields.waves.trains import Gerstner, Sine

__all__ = [
    "BOUNDARIES", "Disturbance", "Gerstner", "Heights", "MeshWaves", "Ocean", "Plan", "Push", "Ripples", "Sine", "Sum",
    "WaveSource", "WaveSurface", "from_plain", "ripples_of", "to_plain",
]  # fmt: skip
