"""Draw a scene with the passes that know nothing of refraction."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from pellucid.gpu import Device

Draw = Callable[..., tuple[np.ndarray, np.ndarray, Any]]


@pytest.fixture(scope="session")
def draw(device: Device) -> Draw:
    """draw(scene, size) -> radiance (H, W, 3), depth-buffer values (H, W), Query of the same scene.

    `before` is called with the surroundings, before anything is drawn.
    """
    from pellucid.surroundings import Query, Surroundings
    from pellucid.techniques.environment.passes import Sky
    from pellucid.techniques.opaque.passes import Opaque

    opaque, sky = Opaque(device), Sky(device)

    def run(scene: Any, size: tuple[int, int], jitter: tuple[float, float] = (0.0, 0.0), before: Any = None) -> Any:
        surroundings = Surroundings(device)
        surroundings.prepare(scene, size)
        surroundings.set_camera(scene.camera, size, jitter)
        if before is not None:
            before(surroundings)
        color = device.texture(size=size, format="rgba32float", usage=("render",))
        depth = device.texture(size=size, format="depth32float", usage=("render",))
        targets = color.create_view(), depth.create_view()
        encoder = device.wgpu.create_command_encoder()
        opaque.illuminate(encoder, surroundings)
        opaque.draw(encoder, color, depth, surroundings)
        sky.draw(encoder, *targets, surroundings)
        device.wgpu.queue.submit([encoder.finish()])
        radiance = device.read_texture(color)[..., :3]
        return radiance, device.read_texture(depth)[..., 0], Query(surroundings)

    return run
