"""Sphere maps: the whole sky in one square picture, looked up by the components of a direction [oliveira2000a].

The picture is seen from above: its right is +X of the world, its top -Z, its middle straight up. Two rules:
``"ball"`` is the photograph of a mirror ball [segal1999, 2.11.4], which holds all directions but straight down;
``"linear"`` takes x and z themselves from -1..1 to 0..1, as equations 12 and 13 of [oliveira2000b] do with a point of
the mesh, and holds those that point upwards. Twin of ``techniques/sheet/shaders/sphere_map.wgsl``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pellucid.scene import checks, equirect
from pellucid.scene.placement import rotation_matrix

if TYPE_CHECKING:
    from pellucid.scene.environment import Environment

RULES = ("ball", "linear")
TINY = 1e-12


def sphere_map_uv(direction_ws: ArrayLike, rule: str = "ball") -> NDArray[np.float64]:
    """Where a sphere map shows a direction [segal1999, 2.11.4, turned so that +Y looks at the viewer].

    Parameters
    ----------
    direction_ws : (..., 3), unit. rule : one of `RULES`.

    Returns
    -------
    (..., 2) in [0, 1], from the left and from the top.
    """
    d = np.asarray(direction_ws, float)
    if rule == "linear":
        return np.asarray(0.5 * d[..., (0, 2)] + 0.5)
    m = 2.0 * np.sqrt(np.maximum(d[..., 0] ** 2 + (d[..., 1] + 1.0) ** 2 + d[..., 2] ** 2, TINY))
    return np.asarray(d[..., (0, 2)] / m[..., None] + 0.5)


def sphere_map_direction(uv: ArrayLike, rule: str = "ball") -> NDArray[np.float64]:
    """The unit direction that a point of a sphere map shows; outside of its disc that of the nearest point of the rim.

    Parameters
    ----------
    uv : (..., 2), from the left and from the top. rule : one of `RULES`.

    Returns
    -------
    (..., 3), world.
    """
    across = 2.0 * np.asarray(uv, float) - 1.0
    across = across / np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1.0)
    up = np.sqrt(np.maximum(1.0 - np.sum(across**2, axis=-1), 0.0))
    n = np.stack([across[..., 0], up, across[..., 1]], axis=-1)
    if rule == "linear":
        return n
    # `across` are components of the ball's normal: mirror the direction to the viewer, +Y.
    return np.asarray(2.0 * up[..., None] * n - (0.0, 1.0, 0.0))


def sphere_map(environment: Environment, size: int = 512, rule: str = "ball") -> NDArray[np.float32]:
    """The sphere map of an environment.

    Parameters
    ----------
    environment : what is photographed. size : pixels a side, 2 to 8192. rule : one of `RULES`.

    Returns
    -------
    (size, size, 3) float32 radiance, linear.

    Raises
    ------
    SceneError : size or rule out of range.
    """
    count = checks.integer("sphere_map.size", size, low=2, high=8192)
    rule = checks.choice("sphere_map.rule", rule, RULES)
    along = (np.arange(count) + 0.5) / count
    directions = sphere_map_direction(np.stack(np.meshgrid(along, along), axis=-1), rule)
    turned = directions @ rotation_matrix((0.0, environment.rotation_deg, 0.0))
    found = environment.intensity * equirect.look_up(environment.pixels, turned)
    return np.asarray(found, np.float32)
