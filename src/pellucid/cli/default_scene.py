"""A scene for a mesh that comes alone: a camera that sees all of it, light, and a floor to see it bend."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pellucid.scene import Camera, DirectionalLight, Environment, Mesh, RefractiveVolume, Scene

VIEW_FROM = (0.42, 0.34, 1.0)
"""Direction from the object to the viewer: three quarters from the right, a little from above."""
FOV_DEG = 28.0
MARGIN = 1.25
"""Room around the object, as a factor on its width and height in the picture."""
FLOOR_GAP = 0.01
"""Between object and floor, in lengths of the object: more than a voxel, so that their surfaces do not cross."""
FLOOR_LENGTHS = 36.0
SQUARES_PER_LENGTH = 2.5
FLOOR_COLORS = ((0.30, 0.29, 0.27), (0.11, 0.13, 0.15))
EXPOSURES = {"studio": 0.7, "sky": 0.75}
KEY_DIRECTION = (0.57, -0.70, 0.44)
"""From where the studio has its main panel: behind on the left."""


@dataclass(frozen=True)
class View:
    """What of the camera was asked for; the rest follows from the object."""

    position: tuple[float, float, float] | None = None
    target: tuple[float, float, float] | None = None
    fov_deg: float | None = None


def turned_up(vertices: np.ndarray, up: str) -> tuple[np.ndarray, tuple[float, float, float]]:
    """Vertices in a world where +Y is up, and the rotation, in degrees, that took them there."""
    if up == "z":
        return np.stack([vertices[:, 0], vertices[:, 2], -vertices[:, 1]], axis=1), (-90.0, 0.0, 0.0)
    return vertices, (0.0, 0.0, 0.0)


def framed_camera(vertices: np.ndarray, size: tuple[int, int], view: View) -> Camera:
    """A camera that sees every vertex, (V, 3) in the world, with the middle of what it sees in the middle."""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    radius, centre = 0.5 * float(np.linalg.norm(high - low)), 0.5 * (low + high)
    fov_deg = FOV_DEG if view.fov_deg is None else view.fov_deg
    target = centre if view.target is None else np.asarray(view.target)
    if view.position is not None:
        return _camera(np.asarray(view.position), target, fov_deg, radius)
    half_height = math.tan(math.radians(0.5 * min(max(fov_deg, 1.0), 160.0))) / MARGIN
    half = np.array([half_height * size[0] / size[1], half_height])
    axes = Camera(VIEW_FROM, (0.0, 0.0, 0.0)).axes()
    for _ in range(4):
        seen = (vertices - target) @ axes.T
        distance = float((np.abs(seen[:, :2]) / half + seen[:, 2:]).max())
        if view.target is None:
            flat = seen[:, :2] / (distance - seen[:, 2:])
            target = target + 0.5 * distance * (flat.min(axis=0) + flat.max(axis=0)) @ axes[:2]
    return _camera(target + distance * axes[2], target, fov_deg, radius)


def _camera(position: np.ndarray, target: np.ndarray, fov_deg: float, radius: float) -> Camera:
    x, y, z = (float(c) for c in position)
    a, b, c = (float(c) for c in target)
    return Camera((x, y, z), (a, b, c), fov_deg=fov_deg, near_m=0.01 * radius)


def floor_under(low: np.ndarray, high: np.ndarray, kind: str) -> Mesh:
    """A plane a little below the box, with a quiet chessboard or plain."""
    length = float((high - low).max())
    side = FLOOR_LENGTHS * length
    place = (float(low[0] + high[0]) / 2, float(low[1]) - FLOOR_GAP * length, float(low[2] + high[2]) / 2)
    if kind == "plain":
        return Mesh.plane(side, base_color=FLOOR_COLORS[0], roughness=0.8, position=place)
    ground = Mesh.plane(side)
    assert ground.uvs is not None
    uvs = (ground.uvs - 0.5) * (0.5 * FLOOR_LENGTHS * SQUARES_PER_LENGTH)
    white = (1.0, 1.0, 1.0)
    board = _four_squares()
    return ground.replace(uvs=uvs, base_color=white, base_color_map=board, roughness=0.6, position=place)


def _four_squares(texels: int = 128) -> np.ndarray:
    """(256, 256, 3) linear: two squares by two, which the floor repeats."""
    light = np.kron([[1, 0], [0, 1]], np.ones((texels, texels))) > 0
    first, second = (np.array(color, np.float32) for color in FLOOR_COLORS)
    return np.where(light[..., None], first, second)


def scene_around(body: RefractiveVolume, vertices: np.ndarray, camera: Camera, environment: str, floor: str) -> Scene:
    """The scene for one body, whose mesh has these `vertices` (V, 3) in the world."""
    around, lights = surroundings(environment)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    objects = [body] if floor == "none" else [floor_under(low, high, floor), body]
    return Scene(camera, around, lights, objects, exposure=EXPOSURES.get(environment, 1.0), tone_mapping="khronos")


def surroundings(environment: str) -> tuple[Environment, list[DirectionalLight]]:
    """``studio``, ``sky`` or a picture file, with the light that goes with it."""
    if environment == "studio":
        return Environment.studio(), [DirectionalLight(KEY_DIRECTION, (1.0, 0.97, 0.92), 2.0)]
    if environment == "sky":
        return Environment.sky(38.0, -60.0, sun_disc=False), [DirectionalLight.sun(38.0, -60.0)]
    return Environment.load(environment), []
