"""Ask the pictures of a body of water about rays given as arrays, through the shaders that draw it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from pellucid.gpu import Pipelines
from pellucid.surroundings.layouts import QueryHit, QueryRay
from pellucid.techniques.water.layouts import WaterParams

if TYPE_CHECKING:
    from pellucid.surroundings.camera import View
    from pellucid.techniques.water.views import SurfacePictures

UNKNOWN, SOMETHING, NOTHING, HIDDEN = 0, 1, 2, 3


@dataclass(frozen=True, eq=False)
class PicturePlaces:
    """Where rays end in a picture.

    uv : (N, 2) place, 0 to 1 from the upper left. t : (N,) way that is reported, metres.
    found : (N,) UNKNOWN, SOMETHING, NOTHING or HIDDEN (shaders/picture.wgsl).
    shown_ws : (N, 3) point of the scene that the picture shows there.
    """

    uv: np.ndarray
    t: np.ndarray
    found: np.ndarray
    shown_ws: np.ndarray


class PictureQuery:
    """Arrays in, arrays out.

    Parameters
    ----------
    pictures : already taken.
    """

    def __init__(self, pictures: SurfacePictures) -> None:
        self.pictures = pictures
        self.device = pictures.device
        self._params = self.device.buffer(WaterParams.itemsize, "uniform", "water of a query")

    def march(self, origins: np.ndarray, directions: np.ndarray, steps: int = 16) -> PicturePlaces:
        """By a march of at most `steps` steps; rays (N, 3) that go down ask the picture of what is below."""
        return self._run("march", origins, directions, march_steps=steps)

    def iteration(self, origins: np.ndarray, directions: np.ndarray, steps: int = 3) -> PicturePlaces:
        """By the iteration of [mihalik2008, 7.1]."""
        return self._run("iteration", origins, directions, steps=steps)

    def point(self, origins: np.ndarray, directions: np.ndarray, way_m: float = 1.0) -> PicturePlaces:
        """A fixed way along the rays [mihalik2008, eq. 6]."""
        return self._run("point", origins, directions, way_m)

    def _run(
        self, entry: str, origins: np.ndarray, directions: np.ndarray, t_max: float = 0.0, **params: int
    ) -> PicturePlaces:
        record = np.zeros(1, WaterParams)
        for name, value in params.items():
            record[name] = value
        self.device.write(self._params, record)
        rays = np.zeros(len(directions), QueryRay)
        rays["origin"], rays["direction"], rays["t_max"] = origins, directions, t_max
        pipelines = Pipelines(self.device, ("picture_depths", "picture_sampler"), shared=True)
        kernel = pipelines.kernel("techniques/water/shaders/picture_query", entry=entry)
        found = self.device.buffer(QueryHit.itemsize * len(rays), label="picture hits")
        own = {"picture_rays": self.device.buffer(rays, label="picture rays"), "picture_hits": found}
        kernel.run((-(-len(rays) // 64), 1, 1), {**own, **self.pictures.bindings, "water": self._params})
        hits = self.device.read(found, QueryHit, len(rays))
        uv, depth = hits["value"][:, :2].astype(np.float64), hits["value"][:, 2].astype(np.float64)
        down = rays["direction"][:, 1] <= 0.0
        shown = np.empty((len(rays), 3))
        for layer, side in enumerate((down, ~down)):
            view = self.pictures.views[layer]
            shown[side] = np.nan if view is None else unprojected(view, uv[side], depth[side])
        return PicturePlaces(uv, hits["t"], hits["valid"], shown)


def unprojected(view: View, uv: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """(N, 3) points of the world at places (N, 2) of a picture, 0 to 1, with reversed depth (N,)."""
    right, up, forward = view.axes
    across = (uv * 2.0 - 1.0) * (1.0, -1.0) * view.half_extent
    if view.is_orthographic:
        away = view.far_m - depth * (view.far_m - view.near_m)
        return view.position + across[:, :1] * right + across[:, 1:] * up + away[:, None] * forward
    away = view.near_m / np.maximum(depth, 1e-9)
    return view.position + away[:, None] * (across[:, :1] * right + across[:, 1:] * up + forward)
