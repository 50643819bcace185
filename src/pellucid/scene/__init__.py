"""What a user describes: camera, lights, surroundings and things, with units and ranges; no GPU."""

from pellucid.scene.brdf import GGX, TabulatedBRDF
from pellucid.scene.camera import Camera
from pellucid.scene.environment import Environment
from pellucid.scene.files import load_scene, save_scene
from pellucid.scene.light_quality import LightQuality
from pellucid.scene.lights import AreaLight, DirectionalLight, PointLight
from pellucid.scene.mesh import Mesh
from pellucid.scene.placement import Light, SceneObject
from pellucid.scene.quality import Quality
from pellucid.scene.refractive_sheet import RefractiveSheet
from pellucid.scene.refractive_volume import RefractiveVolume
from pellucid.scene.relief_quality import ReliefQuality
from pellucid.scene.relief_surface import ReliefLayer, ReliefSurface
from pellucid.scene.scene import Scene
from pellucid.scene.sphere_maps import sphere_map
from pellucid.scene.water import Water
from pellucid.scene.water_quality import WaterQuality

__all__ = [
    "GGX",
    "AreaLight",
    "Camera",
    "DirectionalLight",
    "Environment",
    "Light",
    "LightQuality",
    "Mesh",
    "PointLight",
    "Quality",
    "RefractiveSheet",
    "RefractiveVolume",
    "ReliefLayer",
    "ReliefQuality",
    "ReliefSurface",
    "Scene",
    "SceneObject",
    "TabulatedBRDF",
    "Water",
    "WaterQuality",
    "load_scene",
    "save_scene",
    "sphere_map",
]
