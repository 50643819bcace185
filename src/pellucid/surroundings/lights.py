"""Lights as GPU records, and the view of each shadow map."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from pellucid.surroundings.layouts import LIGHT_AREA, LIGHT_DIRECTIONAL, LIGHT_POINT, MAX_WATER_LIGHTS, Light

if TYPE_CHECKING:
    from pellucid.scene import AreaLight, DirectionalLight, PointLight

SHADOW_SIZE = 2048
MAX_SHADOWS = 4  # directional lights beyond these still shine, without a shadow
SHADOW_MARGIN_TEXELS = 4
FLATNESS = 1e-5  # height of a flat mesh over its width


def light_records(lights: Sequence[object], corners: Sequence[np.ndarray]) -> tuple[np.ndarray, list[list[bool]]]:
    """Records of all lights, and for each shadow map which meshes cast into it.

    Parameters
    ----------
    lights : the lights of the scene.
    corners : (V, 3) world-space vertices of each mesh.

    Returns
    -------
    records : (max(N, 1),) of dtype `layouts.Light`.
    casters : per shadow map, the list of booleans per mesh.
    """
    from pellucid.scene import AreaLight, DirectionalLight, PointLight

    records = np.zeros(max(len(lights), 1), Light)
    records["shadow_layer"] = records["water_layer"] = -1
    casters: list[list[bool]] = []
    for record, light in zip(records, lights, strict=False):
        if isinstance(light, DirectionalLight):
            _write_directional(record, light, corners, casters)
        elif isinstance(light, PointLight):
            _write_point(record, light)
        elif isinstance(light, AreaLight):
            _write_area(record, light)
    high = np.flatnonzero((records["kind"] == LIGHT_DIRECTIONAL) & (records["direction"][:, 1] > 0.0))
    near = np.flatnonzero(records["kind"][: len(lights)] != LIGHT_DIRECTIONAL)
    for layer, light in enumerate([*high, *near][:MAX_WATER_LIGHTS]):
        records["water_layer"][light] = layer
    return records, casters


def _write_directional(
    record: np.ndarray, light: DirectionalLight, corners: Sequence[np.ndarray], casters: list[list[bool]]
) -> None:
    towards = -_unit(light.direction)
    record["kind"], record["direction"] = LIGHT_DIRECTIONAL, towards
    record["power"] = np.asarray(light.color) * light.irradiance
    record["radius"] = np.tan(np.radians(light.angular_radius_deg))
    casting = [casts_shadow(i, corners, towards) for i in range(len(corners))]
    if light.cast_shadow and any(casting) and len(casters) < MAX_SHADOWS:
        points = np.concatenate([c for c, casts in zip(corners, casting, strict=True) if casts])
        matrix, texel_m = fit_shadow(points, towards)
        record["shadow_layer"], record["shadow_texel_m"] = len(casters), texel_m
        record["shadow_from_world"] = matrix.T
        casters.append(casting)


def _write_point(record: np.ndarray, light: PointLight) -> None:
    record["kind"], record["position"] = LIGHT_POINT, light.position
    record["power"] = np.asarray(light.color) * light.intensity
    record["shadow_layer"] = 0 if light.cast_shadow else -1


def _write_area(record: np.ndarray, light: AreaLight) -> None:
    record["kind"], record["position"] = LIGHT_AREA, light.position
    record["edge_u"], record["edge_v"] = light.edge_u, light.edge_v
    record["radius"] = np.sqrt(np.linalg.norm(np.cross(light.edge_u, light.edge_v)) / np.pi)
    record["direction"] = _unit(np.cross(light.edge_u, light.edge_v))
    record["power"] = np.asarray(light.color) * light.radiance
    record["shadow_layer"] = 0 if light.cast_shadow else -1


def shadow_order(records: np.ndarray) -> list[int]:
    """Index of the light of each shadow map, in the order of their layers."""
    mapped = np.flatnonzero((records["kind"] == LIGHT_DIRECTIONAL) & (records["shadow_layer"] >= 0))
    return [int(i) for i in mapped[np.argsort(records["shadow_layer"][mapped])]]


def far_over_water(records: np.ndarray) -> int:
    """How many directional lights have maps in waters."""
    return int(((records["kind"] == LIGHT_DIRECTIONAL) & (records["water_layer"] >= 0)).sum())


def lamp_constants(records: np.ndarray) -> dict[str, float]:
    """Override constants of shaders/lights.wgsl: which kinds of lamps there are, and whether any has a shadow map."""
    far = records["kind"] == LIGHT_DIRECTIONAL
    return {
        "LAMPS_FAR": float(far.any()),
        "LAMPS_NEAR": float((~far).any()),
        "SHADOW_MAPS": float((far & (records["shadow_layer"] >= 0)).any()),
    }


def casts_shadow(mesh: int, corners: Sequence[np.ndarray], towards: np.ndarray) -> bool:
    """Whether a mesh can shadow anything: a flat one with all others on its lit side cannot.

    Leaving such a floor out of the fit gives the whole shadow map to the things that stand on it.
    """
    points = corners[mesh]
    centre = points.mean(axis=0)
    _, spread, axes = np.linalg.svd(np.cov((points - centre).T))
    if spread[2] > FLATNESS**2 * spread[0]:
        return True
    normal = axes[2] if axes[2] @ towards > 0 else -axes[2]
    slack = 10 * FLATNESS * np.sqrt(spread[0])
    others = [c for i, c in enumerate(corners) if i != mesh]
    return any(((c - centre) @ normal).min() < -slack for c in others)


def fit_shadow(points: np.ndarray, towards: np.ndarray) -> tuple[np.ndarray, float]:
    """Orthographic view from a directional light that just holds the points.

    Returns
    -------
    matrix : (4, 4) world to clip space, depth 0 at the light's side and 1 at the far side.
    texel_m : the longer side of a texel in metres.
    """
    aside = np.array([0.0, 1.0, 0.0]) if abs(towards[1]) < 0.9 else np.array([1.0, 0.0, 0.0])
    right = _unit(np.cross(aside, towards))
    axes = np.stack([right, np.cross(towards, right), -towards])
    local = points @ axes.T
    low, high = local.min(axis=0), local.max(axis=0)
    size = np.maximum(high - low, 1e-3 * max(float((high - low).max()), 1e-6))
    size[:2] *= SHADOW_SIZE / (SHADOW_SIZE - 2 * SHADOW_MARGIN_TEXELS)
    size[2] *= 1.02
    scale, centre = np.array([2.0, 2.0, 1.0]) / size, 0.5 * (low + high)
    matrix = np.eye(4)
    matrix[:3, :3] = axes * scale[:, None]
    matrix[:3, 3] = -centre * scale + np.array([0.0, 0.0, 0.5])
    return matrix, float(size[:2].max() / SHADOW_SIZE)


def _unit(vector: object) -> np.ndarray:
    v = np.asarray(vector, np.float64)
    return v / np.linalg.norm(v)
