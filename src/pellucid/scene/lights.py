"""Lights: far away, at a point, or a bright rectangle. Colours and powers are linear Rec.709."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from pellucid.errors import SceneError
from pellucid.scene import checks
from pellucid.scene.placement import Light, store

SUN_RADIUS_DEG = 0.2666


@dataclass(frozen=True)
class DirectionalLight(Light):
    """Light of a source so far away that its rays run parallel.

    Parameters
    ----------
    direction : the way the light travels, away from the source; need not be normalised.
    color : factor on each channel, >= 0.
    irradiance : on a surface that faces the light, >= 0; a white matt surface then has the radiance
        irradiance / pi.
    cast_shadow : whether meshes stop it.
    angular_radius_deg : of the source as it is seen, 0 to 45; soft shadows of reliefs are as wide. The sun's is 0.267.

    Raises
    ------
    SceneError : zero direction, negative or infinite values.
    """

    direction: checks.Vector
    color: checks.Vector = (1.0, 1.0, 1.0)
    irradiance: float = 3.0
    cast_shadow: bool = True
    angular_radius_deg: float = 0.0

    def __post_init__(self) -> None:
        store(
            self,
            direction=checks.direction("directional_light.direction", self.direction),
            color=checks.color("directional_light.color", self.color),
            irradiance=checks.number("directional_light.irradiance", self.irradiance, low=0.0),
            cast_shadow=checks.flag("directional_light.cast_shadow", self.cast_shadow),
            angular_radius_deg=checks.number(
                "directional_light.angular_radius_deg", self.angular_radius_deg, low=0.0, high=45.0
            ),
        )

    @classmethod
    def sun(cls, elevation_deg: float = 35.0, azimuth_deg: float = 40.0, turbidity: float = 3.0) -> Self:
        """The sun that belongs to ``Environment.sky`` of the same angles and haze.

        Give that sky ``sun_disc=False``, or the sun shines twice.
        """
        from pellucid.scene import sky

        sky.check_sky(elevation_deg, azimuth_deg, turbidity)
        rgb = sky.sun_irradiance(elevation_deg, turbidity)
        peak = float(rgb.max())
        travel = -sky.sun_direction(elevation_deg, azimuth_deg)
        direction = (float(travel[0]), float(travel[1]), float(travel[2]))
        return cls(direction, tuple(float(c) / peak for c in rgb), peak, angular_radius_deg=SUN_RADIUS_DEG)  # type: ignore[arg-type]


@dataclass(frozen=True)
class PointLight(Light):
    """Light that leaves one point evenly in all directions.

    Parameters
    ----------
    position : metres.
    color : factor on each channel, >= 0.
    intensity : radiant intensity, >= 0; at a distance d a surface facing the light receives
        intensity / d^2.
    cast_shadow : whether meshes stop it.

    Raises
    ------
    SceneError : negative or infinite values.
    """

    position: checks.Vector
    color: checks.Vector = (1.0, 1.0, 1.0)
    intensity: float = 1.0
    cast_shadow: bool = True

    def __post_init__(self) -> None:
        store(
            self,
            position=checks.vector("point_light.position", self.position),
            color=checks.color("point_light.color", self.color),
            intensity=checks.number("point_light.intensity", self.intensity, low=0.0),
            cast_shadow=checks.flag("point_light.cast_shadow", self.cast_shadow),
        )


@dataclass(frozen=True)
class AreaLight(Light):
    """A rectangle that is equally bright from every side it faces.

    Parameters
    ----------
    position : its centre, metres.
    edge_u, edge_v : its full edges as vectors in metres; it shines along their cross product u x v.
    color : factor on each channel, >= 0.
    radiance : of its face, >= 0.
    cast_shadow : whether meshes stop it.

    Raises
    ------
    SceneError : edges that are zero or parallel, negative or infinite values.
    """

    position: checks.Vector
    edge_u: checks.Vector
    edge_v: checks.Vector
    color: checks.Vector = (1.0, 1.0, 1.0)
    radiance: float = 1.0
    cast_shadow: bool = True

    def __post_init__(self) -> None:
        store(
            self,
            position=checks.vector("area_light.position", self.position),
            edge_u=checks.direction("area_light.edge_u", self.edge_u),
            edge_v=checks.direction("area_light.edge_v", self.edge_v),
            color=checks.color("area_light.color", self.color),
            radiance=checks.number("area_light.radiance", self.radiance, low=0.0),
            cast_shadow=checks.flag("area_light.cast_shadow", self.cast_shadow),
        )
        u, v = np.asarray(self.edge_u), np.asarray(self.edge_v)
        if np.linalg.norm(np.cross(u, v)) < 1e-6 * np.linalg.norm(u) * np.linalg.norm(v):
            raise SceneError("area_light.edge_v", "is parallel to edge_u, so the light has no area")
