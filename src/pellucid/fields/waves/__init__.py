"""Water in motion: heights, and the slopes that belong to them, at a time."""

from pellucid.fields.waves.ripples import BOUNDARIES, Disturbance, Plan, Push, Ripples
from pellucid.fields.waves.source import WaveSource, WaveSurface

__all__ = ["BOUNDARIES", "Disturbance", "Plan", "Push", "Ripples", "WaveSource", "WaveSurface"]
