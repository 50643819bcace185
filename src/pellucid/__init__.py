"""Pellucid: refractive and translucent matter in real time."""
