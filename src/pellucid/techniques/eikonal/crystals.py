"""What the shaders know of the crystals in a volume; NumPy only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pellucid.fields.volume import Region, Volume
from pellucid.techniques.eikonal.layouts import CrystalParams

Axis = tuple[float, float, float]


@dataclass(frozen=True)
class Crystals:
    """The crystals among the regions of a sharp volume.

    Attributes
    ----------
    axes : for each region its axis, or None where it is isotropic; where it varies, any.
    absorption_e : for each region the extinction of the extraordinary ray across the axis, 1/m.
    n_e : for each wavelength, and in that for each region, the extraordinary index.
    fields : None where axis and indices are constant; else for each wavelength (Z, Y, X, 4) float32: axis of the first
        region, and n_e - ambient_n.
    """

    axes: tuple[Axis | None, ...]
    absorption_e: tuple[tuple[float, ...], ...]
    n_e: tuple[tuple[float, ...], ...]
    fields: tuple[np.ndarray, ...] | None

    def at(self, regions: Sequence[Region], lambdas_nm: Sequence[float] | np.ndarray) -> Crystals:
        """The same crystals, without fields, at other wavelengths."""
        return replace(self, n_e=_indices(regions, lambdas_nm))

    def record(self, channel: int) -> np.ndarray:
        """The CrystalParams of one wavelength."""
        out = np.zeros((), CrystalParams)
        for k, axis in enumerate(self.axes):
            out["n_e"][k] = self.n_e[channel][k]
            out["absorption_e"][k, :3] = self.absorption_e[k]
            if axis is not None:
                out["axis"][k] = (*axis, 1.0)
        return out


def crystals_of(
    volume: Volume,
    lambdas_nm: Sequence[float],
    deltas: Sequence[np.ndarray | None],
    deltas_e: Sequence[np.ndarray | None],
) -> Crystals | None:
    """The crystals of a volume at some wavelengths; None when it has none.

    deltas, deltas_e : n_o - ambient_n and n_e - ambient_n of the first region at each wavelength, (Z, Y, X), where they
        vary.
    """
    if not volume.has_crystals:
        return None
    regions = volume.regions
    axes: list[Axis | None] = [r.optic_axis for r in regions]
    if volume.optic_axis is not None and axes[0] is None:
        axes[0] = (0.0, 1.0, 0.0)
    n_e = _indices(regions, lambdas_nm)
    varies = axes[0] is not None and (
        volume.optic_axis is not None or volume.delta_n is not None or volume.delta_n_e is not None
    )
    fields = None
    if varies:
        rows = zip(lambdas_nm, deltas, deltas_e, strict=True)
        fields = tuple(_field(volume, axes[0], nm, delta, delta_e) for nm, delta, delta_e in rows)
    return Crystals(tuple(axes), tuple(tuple(r.medium.absorption_e_rgb_per_m) for r in regions), n_e, fields)


def _indices(regions: Sequence[Region], lambdas_nm: Sequence[float] | np.ndarray) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(_index(r, float(nm), extraordinary=True) for r in regions) for nm in lambdas_nm)


def _index(region: Region, lambda_nm: float, extraordinary: bool) -> float:
    """Beyond the wavelengths that the source of a medium covers, the index where they end."""
    ray = (region.medium.extraordinary or region.medium) if extraordinary else region.medium
    return float(ray.n(np.clip(lambda_nm, *ray.valid_nm)))


def _field(
    volume: Volume, axis: Axis | None, lambda_nm: float, delta: np.ndarray | None, delta_e: np.ndarray | None
) -> np.ndarray:
    """Axis and n_e - ambient_n of the first region, everywhere in the box."""
    first = volume.regions[0]
    out = np.zeros((*volume.shape, 4), np.float32)
    out[..., :3] = axis if volume.optic_axis is None else volume.optic_axis
    n_e = _index(first, lambda_nm, extraordinary=True)
    if delta_e is not None:
        out[..., 3] = delta_e
    elif delta is not None:
        out[..., 3] = delta + (n_e - _index(first, lambda_nm, extraordinary=False))
    else:
        out[..., 3] = n_e - volume.ambient_n
    return out
