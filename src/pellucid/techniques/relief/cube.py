"""The scene around a relief as a cube map: meshes and the sky, seen from the middle of the object."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu import Device, Pipelines

if TYPE_CHECKING:
    from pellucid.scene import Mesh
    from pellucid.surroundings import Surroundings

SIDE = 256
FORMAT = "rgba16float"


class SceneCube:
    """Six views of the surroundings from one point.

    Attributes
    ----------
    view : the cube, to be bound. nbytes : bytes of GPU memory held.
    """

    nbytes = 6 * 8 * SIDE * SIDE

    def __init__(self, device: Device) -> None:
        self.device = device
        usage = ("sample", "render")
        self._texture = device.texture(size=(SIDE, SIDE), format=FORMAT, layers=6, usage=usage, label="scene cube")
        self.view = self._texture.create_view(dimension="cube")
        self._drawn: tuple[Mesh, np.ndarray] | None = None
        self._faces = [device.buffer(32, "uniform", "cube face") for _ in range(6)]
        self._layers = [
            self._texture.create_view(dimension="2d", base_array_layer=k, array_layer_count=1) for k in range(6)
        ]

    def belongs_to(self, mesh: Mesh, center_ws: np.ndarray) -> bool:
        """Whether it was drawn for this mesh in this place."""
        return self._drawn is not None and self._drawn[0] is mesh and np.array_equal(self._drawn[1], center_ws)

    def draw(
        self, encoder: Any, mesh: Mesh, center_ws: np.ndarray, surroundings: Surroundings, timer: Any = None
    ) -> None:
        """Look around from a point of the world, in the middle of a mesh."""
        self._drawn = (mesh, np.array(center_ws))
        pipelines = Pipelines(self.device, shared=True)
        constants = {**surroundings.shading_constants, **surroundings.across_constants}
        cube = pipelines.draw("techniques/relief/shaders/cube", constants, targets=(FORMAT,))
        for face, (buffer, view) in enumerate(zip(self._faces, self._layers, strict=True)):
            self.device.write(buffer, np.array([*center_ws, face, SIDE, 0, 0, 0], np.float32))
            bound = {**surroundings.bindings, "cube_face": buffer}
            clear = [(0.0, 0.0, 0.0, 0.0)]
            cube.run(encoder, color=[view], clear=clear, bindings=bound, timer=timer, label="relief cube")
