"""Pellucid: refractive and translucent matter in real time.

Importing this package makes no device and opens no window. See the README for a first picture.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from pellucid.errors import AssetError, AssetWarning, NoAdapterError, PellucidError, SceneError, ShaderError

if TYPE_CHECKING:
    from pellucid import media, optics
    from pellucid.animation import animate
    from pellucid.fields import waves
    from pellucid.fields.volume import Region, Volume
    from pellucid.frame import Frame
    from pellucid.gpu import Device
    from pellucid.renderer import Renderer
    from pellucid.scene import (
        GGX,
        AreaLight,
        Camera,
        DirectionalLight,
        Environment,
        LightQuality,
        Mesh,
        PointLight,
        Quality,
        RefractiveSheet,
        RefractiveVolume,
        ReliefLayer,
        ReliefQuality,
        ReliefSurface,
        Scene,
        TabulatedBRDF,
        Water,
        WaterQuality,
        load_scene,
        save_scene,
    )
    from pellucid.session import illuminate, probe, render, trace
    from pellucid.techniques.eikonal.irradiance import Irradiance
    from pellucid.techniques.eikonal.trace import Rays

_HOME = {
    "AreaLight": "scene", "Camera": "scene", "DirectionalLight": "scene", "Environment": "scene", "Mesh": "scene",
    "LightQuality": "scene", "ReliefLayer": "scene", "ReliefQuality": "scene", "ReliefSurface": "scene",
    "PointLight": "scene", "Quality": "scene", "RefractiveVolume": "scene", "Scene": "scene",
    "RefractiveSheet": "scene", "Water": "scene", "WaterQuality": "scene", "GGX": "scene", "TabulatedBRDF": "scene",
    "load_scene": "scene", "save_scene": "scene",
    "Region": "fields.volume", "Volume": "fields.volume",
    "Frame": "frame", "Device": "gpu", "Renderer": "renderer", "Rays": "techniques.eikonal.trace",
    "Irradiance": "techniques.eikonal.irradiance", "illuminate": "session",
    "render": "session", "trace": "session", "probe": "session", "animate": "animation",
}  # fmt: skip
_WITHIN = {"waves": "fields.waves"}
_MODULES = ("errors", "fields", "gpu", "io", "media", "optics", "scene")

__version__ = "0.1.0"
__all__ = [
    "GGX",
    "AreaLight",
    "AssetError",
    "AssetWarning",
    "Camera",
    "Device",
    "DirectionalLight",
    "Environment",
    "Frame",
    "Irradiance",
    "LightQuality",
    "Mesh",
    "NoAdapterError",
    "PellucidError",
    "PointLight",
    "Quality",
    "Rays",
    "RefractiveSheet",
    "RefractiveVolume",
    "Region",
    "ReliefLayer",
    "ReliefQuality",
    "ReliefSurface",
    "Renderer",
    "Scene",
    "SceneError",
    "ShaderError",
    "TabulatedBRDF",
    "Volume",
    "Water",
    "WaterQuality",
    "animate",
    "illuminate",
    "load_scene",
    "media",
    "optics",
    "probe",
    "render",
    "save_scene",
    "trace",
    "waves",
]  # fmt: skip


def __getattr__(name: str) -> Any:
    """Public names are loaded when they are first used: importing stays quick and opens nothing."""
    if name in _HOME:
        value = getattr(import_module(f"pellucid.{_HOME[name]}"), name)
    elif name in _WITHIN:
        value = import_module(f"pellucid.{_WITHIN[name]}")
    elif name in _MODULES:
        value = import_module(f"pellucid.{name}")
    else:
        raise AttributeError(f"module 'pellucid' has no attribute '{name}'")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, *_MODULES})
