"""BRDFs as layers of one texture, which every look into a lobe reads."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu import Device
from pellucid.scene.brdf import GGX, TabulatedBRDF
from pellucid.surroundings.ggx import ggx_directional_albedo, ggx_distribution, ggx_visibility

if TYPE_CHECKING:
    from pellucid.scene import RefractiveVolume

# Nodes of a layer: half angles and difference angles; brdf_table.wgsl has the same.
ROWS, COLUMNS = 128, 64
# What is above this cosine is tabulated; nearer to grazing the last value holds.
LEAST_COSINE = 0.02


def layers_of(brdfs: Sequence[TabulatedBRDF], rough: bool) -> np.ndarray:
    """(1 + N, ROWS + 2, COLUMNS, 4) float32 as `brdf_table.wgsl` describes.

    rough : some volume has a GGX boundary, so layer 0 is needed; without one it is all 1, and nothing is computed.
    """
    ggx = np.ones((ROWS + 2, COLUMNS, 4), np.float32)
    if rough:
        ggx[:ROWS, :, 0] = _ggx_albedos()
    return np.stack([ggx, *(_layer(brdf) for brdf in brdfs)])


def _layer(brdf: TabulatedBRDF) -> np.ndarray:
    half = 0.5 * np.pi * np.linspace(0.0, 1.0, ROWS) ** 2
    difference = np.linspace(0.0, 0.5 * np.pi, COLUMNS)
    out = np.zeros((ROWS + 2, COLUMNS, 4), np.float32)
    out[:ROWS, :, :3] = brdf.evaluate(half[:, None], difference[None, :])
    cosines = np.linspace(LEAST_COSINE, 1.0, 16)
    lobe = np.maximum(brdf.albedo(cosines) - np.pi * brdf.floor, 0.0)
    nodes = np.linspace(0.0, 1.0, COLUMNS)
    out[ROWS, :, :3] = np.stack([np.interp(nodes, cosines, lobe[:, c]) for c in range(3)], axis=-1)
    out[ROWS, :, 3] = lobe_alpha(brdf)
    out[ROWS + 1, :, :3] = np.pi * brdf.floor
    return out


def lobe_alpha(brdf: TabulatedBRDF) -> float:
    """The alpha, 0 to 1, of the GGX lobe that is as wide as what rises over the table's least value.

    Seen from the normal, half of the light comes by half angles below the same one in both.
    """
    theta = 0.5 * np.pi * np.linspace(0.0, 1.0, 1001) ** 2
    widths = np.linspace(0.01, 1.0, 60) ** 2
    to = np.maximum(np.cos(2.0 * theta), 1e-6)
    medians = [_median(theta, ggx_distribution(np.cos(theta), a) * ggx_visibility(to, 1.0, a)) for a in widths]
    # From the normal the difference angle equals the half angle.
    rise = (brdf.evaluate(theta, theta) - brdf.floor).mean(axis=-1)
    return float(np.interp(_median(theta, rise), medians, widths))


def _median(theta: np.ndarray, values: np.ndarray) -> float:
    """Half angle below which half of the light of a BRDF comes, seen from the normal; dl = 4 (v.h) dh."""
    weight = values * np.maximum(np.cos(2.0 * theta), 0.0) * np.cos(theta) * np.sin(theta)
    share = np.concatenate([[0.0], np.cumsum(0.5 * (weight[1:] + weight[:-1]) * np.diff(theta))])
    return float(np.interp(0.5, share / max(share[-1], 1e-30), theta)) if share[-1] > 0.0 else float(theta[-1])


@cache
def _ggx_albedos() -> np.ndarray:
    """(ROWS, COLUMNS) by roughness and cosine, interpolated from a coarser grid: a smooth function."""
    roughness, cosine = np.linspace(0.02, 1.0, 20), np.linspace(LEAST_COSINE, 1.0, 20) ** 1.5
    grid = np.stack([ggx_directional_albedo(cosine, r * r) for r in roughness])
    across = np.stack([np.interp(np.linspace(0.0, 1.0, COLUMNS), cosine, row) for row in grid])
    along = np.linspace(0.0, 1.0, ROWS)
    return np.stack([np.interp(along, roughness, column) for column in across.T], axis=-1)


class BrdfTables:
    """The BRDFs of all volumes on the device.

    Attributes
    ----------
    bindings : resources of `brdf_table.wgsl`, by name.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self.bindings: dict[str, Any] = {}
        self._brdfs: list[TabulatedBRDF] = []
        self._rough = False

    def prepare(self, objects: Sequence[RefractiveVolume]) -> None:
        """Upload one layer for each table, if they differ from the last call's."""
        brdfs = list({id(o.brdf): o.brdf for o in objects if isinstance(o.brdf, TabulatedBRDF)}.values())
        rough = any(isinstance(o.brdf, GGX) for o in objects)
        same = [id(b) for b in self._brdfs] == [id(b) for b in brdfs] and self._rough == rough
        if same and self.bindings:
            return
        self._brdfs, self._rough = brdfs, rough
        layers = layers_of(brdfs, rough)
        name = "rgba32float" if self.device.float32_filterable else "rgba16float"
        texture = self.device.texture(layers, format=name, layers=len(layers), label="BRDFs")
        self.bindings = {
            "brdf_tables": texture.create_view(dimension="2d-array"),
            "brdf_sampler": self.device.sampler("linear", "clamp"),
        }

    def write(self, record: np.ndarray, item: RefractiveVolume) -> None:
        """Fill in what VolumeParams says of the boundaries of one volume."""
        record["gloss"] = item.gloss
        if isinstance(item.brdf, GGX):
            record["coat"] = (*item.brdf.tint, item.brdf.roughness)
        elif isinstance(item.brdf, TabulatedBRDF):
            record["brdf_layer"] = 1 + [id(b) for b in self._brdfs].index(id(item.brdf))


def spreading(item: RefractiveVolume) -> int:
    """The constant ROUGH of `view.wgsl`: what spreads the light that boundaries mirror."""
    return 1 if isinstance(item.brdf, GGX) else 2 if isinstance(item.brdf, TabulatedBRDF) else 0
