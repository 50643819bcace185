"""Fields in motion on the GPU: twins of what `fields` does in NumPy, for techniques that draw them every frame."""

from pellucid.simulation.ripples import RippleSimulation

__all__ = ["RippleSimulation"]
