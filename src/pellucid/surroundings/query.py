"""Ask the surroundings about rays given as arrays, through the shaders that draw them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pellucid.gpu import Pipelines
from pellucid.surroundings.layouts import QueryHit, QueryRay

if TYPE_CHECKING:
    from pellucid.surroundings.prepare import Surroundings


class Query:
    """Arrays in, arrays out. All directions are in world space and have unit length.

    Parameters
    ----------
    surroundings : prepared with a scene.
    """

    def __init__(self, surroundings: Surroundings) -> None:
        self.surroundings = surroundings
        self.device = surroundings.device

    def hits(self, origins: np.ndarray, directions: np.ndarray, t_max: float = 1e30) -> np.ndarray:
        """Nearest opaque surface of each ray: (N,) of dtype `layouts.QueryHit`.

        `t`, `valid` and `triangle` tell where; `value` holds the two barycentric weights and the value of
        the depth buffer; `blocked` is the answer of the shadow ray.
        """
        return self._run("hits", origins, directions, t_max)

    def radiance(self, origins: np.ndarray, directions: np.ndarray, across: bool = False) -> np.ndarray:
        """Radiance (N, 3) that comes back along each ray; `across` what stands for water and glass, too."""
        constants = self.surroundings.across_constants if across else {}
        return self._run("radiance", origins, directions, 0.0, constants)["value"]

    def environment(self, directions: np.ndarray, lod: float = 0.0) -> np.ndarray:
        """Radiance (N, 3) of the environment at one of its blurred levels."""
        return self._run("environment", np.zeros(3), directions, lod)["value"]

    def irradiance(self, normals: np.ndarray) -> np.ndarray:
        """Irradiance (N, 3) of the environment on surfaces with the given normals."""
        return self._run("irradiance", np.zeros(3), normals, 0.0)["value"]

    def camera_rays(self) -> tuple[np.ndarray, np.ndarray]:
        """Origins and directions (H, W, 3) of the rays through the pixels of the current view."""
        width, height = self.surroundings.size
        out = self._run("camera", np.zeros(3), np.zeros((width * height, 3)), 0.0)
        shape = (height, width, 3)
        return out["value"].reshape(shape), out["direction"].reshape(shape)

    def _run(
        self,
        entry: str,
        origins: np.ndarray,
        directions: np.ndarray,
        t_max: float,
        more: dict[str, float] | None = None,
    ) -> np.ndarray:
        rays = np.zeros(len(directions), QueryRay)
        rays["origin"], rays["direction"], rays["t_max"] = origins, directions, t_max
        constants = {**self.surroundings.shading_constants, **(more or {})}
        kernel = Pipelines(self.device, shared=True).kernel("surroundings/shaders/query", constants, entry)
        found = self.device.buffer(QueryHit.itemsize * len(rays), label="query hits")
        own = {"query_rays": self.device.buffer(rays, label="query rays"), "query_hits": found}
        kernel.run((-(-len(rays) // 64), 1, 1), {**own, **self.surroundings.bindings})
        return self.device.read(found, QueryHit, len(rays))
