"""A prepared volume on the GPU: textures that stay, and one small uniform a wavelength channel that changes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from pellucid.gpu import Device
from pellucid.scene.quality import Quality
from pellucid.techniques.eikonal.crystals import Crystals
from pellucid.techniques.eikonal.layouts import VolumeParams, blank_params
from pellucid.techniques.eikonal.prepare import Prepared
from pellucid.techniques.eikonal.proxies import Box, whole_box

# Between two looks at the opaque meshes that reach into a volume a curved ray turns by this much, as a change of its
# optical momentum; the chord then departs from the arc by about 1 % of its length.
PAUSE_TURN = 0.1
FAR = 1e30
# The largest 16-bit float; an extinction of that many per metre is black in a tenth of a millimetre.
MOST_HALF = 65504.0
# Rays that one pixel may send into the surroundings; more of them see the environment only.
LOOKS_PER_PIXEL = 8


@dataclass(frozen=True)
class VolumeTextures:
    """Textures of one volume: bindings for each channel, and what their values are scaled by."""

    channels: tuple[dict[str, Any], ...]
    force_scales: tuple[float, ...]
    index_scales: tuple[float, ...]
    nbytes: int


def upload(device: Device, prepared: Prepared) -> VolumeTextures:
    """Create the textures of a prepared volume, 32-bit where the device can filter that, else 16-bit."""
    shared = {"volume_sampler": device.sampler("linear", "clamp")}
    size = 0

    def texture(array: np.ndarray | None, channels: int, half: bool, label: str) -> Any:
        nonlocal size
        if array is None:
            array = np.zeros((1, 1, 1, channels), np.float32)
        narrow = half or not device.float32_filterable
        name = {1: "r", 2: "rg", 4: "rgba"}[channels] + ("16float" if narrow else "32float")
        if narrow:
            array = np.clip(array, -MOST_HALF, MOST_HALF)
        data = _fit(array, channels).astype(np.float16 if narrow else np.float32)
        size += data.nbytes
        return device.texture(data, format=name, dimension="3d", label=label)

    def crystal_bindings(crystals: Crystals, channel: int) -> dict[str, Any]:
        field = None if crystals.fields is None else crystals.fields[channel]
        record = crystals.record(channel).reshape(1)
        return {
            "crystals": device.buffer(record, "uniform", "crystals"),
            "axis_field": texture(field, 4, False, "optic axis"),
        }

    count = prepared.distance.shape[-1] if prepared.distance is not None else 1
    shared["distance_field"] = texture(prepared.distance, 1 if count == 1 else 4, False, "distance")
    shared["absorption_field"] = texture(prepared.absorption, 4, True, "absorption")
    shared["emission_field"] = texture(prepared.emission, 4, True, "emission")
    shared["scattering_field"] = texture(prepared.scattering, 4, True, "scattering")
    # No light, until some has been followed through the volume.
    shared["fluence_field"] = texture(None, 4, True, "fluence")
    shared["light_field"] = texture(None, 4, True, "direction of light")
    shared["opaque_field"] = texture(prepared.opaque, 4, True, "opaque")
    shared["reflection_field"] = texture(prepared.reflection, 4, True, "reflection")
    made: dict[tuple[int, int], tuple[dict[str, Any], float, float]] = {}
    rows = []
    for channel in prepared.channels:
        key = (id(channel.force), id(channel.index))
        if key not in made:
            force, force_scale = _scaled(channel.force, 3)
            index, index_scale = _scaled(channel.index, 1)
            own = {
                "force_field": texture(force, 4, False, "force"),
                "index_field": texture(index, 1, False, "index"),
            }
            made[key] = ({**shared, **own}, force_scale, index_scale)
        rows.append(made[key])
    bindings, force_scales, index_scales = zip(*rows, strict=True)
    if prepared.crystals is not None:
        bindings = tuple({**row, **crystal_bindings(prepared.crystals, k)} for k, row in enumerate(bindings))
    return VolumeTextures(bindings, force_scales, index_scales, size)


def _scaled(field: np.ndarray | None, channels: int) -> tuple[np.ndarray | None, float]:
    """Bring the leading channels into -1..1, so that 16-bit textures keep the digits of weak fields."""
    if field is None:
        return None, 1.0
    data = field if field.ndim == 4 else field[..., None]
    scale = float(np.abs(data[..., :channels]).max()) or 1.0
    scale = float(np.exp2(np.ceil(np.log2(scale))))  # a power of two costs no digits
    out = data.astype(np.float32, copy=True)
    out[..., :channels] /= scale
    return out, scale


def _fit(array: np.ndarray, channels: int) -> np.ndarray:
    data = array if array.ndim == 4 else array[..., None]
    if data.shape[-1] < channels:
        data = np.concatenate([data, np.zeros((*data.shape[:3], channels - data.shape[-1]), data.dtype)], axis=-1)
    return data


def scatters(prepared: Prepared) -> bool:
    """Whether anything in a volume scatters light."""
    return prepared.scattering is not None or any(any(rgb_g[:3]) for rgb_g in prepared.region_scattering)


def constants_of(prepared: Prepared, quality: Quality) -> dict[str, float]:
    """The override constants that the march of a volume is compiled with."""
    return {
        "EULER": float(quality.method == "euler"),
        "ADAPTIVE": float(quality.adaptive),
        "ABSORBS": float(prepared.absorption is not None or (prepared.graded and np.any(prepared.region_absorption))),
        "EMITS": float(prepared.emission is not None or (prepared.graded and np.any(prepared.region_emission))),
        "SCATTERS": float(scatters(prepared)),
        "SCATTER_VARIES": float(prepared.scattering is not None),
        "BLOCKS": float(prepared.opaque is not None),
        "REFLECTS": float(prepared.reflection is not None),
    }


def crystal_constants(prepared: Prepared) -> dict[str, float]:
    """The further constants of the kernels for crystals."""
    return {"CRYSTALS": 1.0, "VARIES": float(_varies(prepared))}


def _varies(prepared: Prepared) -> bool:
    return prepared.crystals is not None and prepared.crystals.fields is not None


def scale_of(world_from_object: np.ndarray) -> float:
    """World metres per object metre of a placement (4, 4), whose scale is uniform."""
    return float(np.cbrt(np.linalg.det(world_from_object[:3, :3])))


def parameters(
    prepared: Prepared,
    textures: VolumeTextures,
    channel: int,
    quality: Quality,
    world_from_object: np.ndarray,
    box: Box | None = None,
    meets_meshes: bool = False,
) -> np.ndarray:
    """The VolumeParams record of one channel.

    world_from_object : (4, 4) float64, metres. box : the proxy; all of the volume when omitted.
    """
    out = blank_params()
    curved = not prepared.sharp or prepared.graded or _varies(prepared)
    row = prepared.channels[channel]
    out["world_from_object"] = np.asarray(world_from_object, np.float64).T
    out["object_from_world"] = np.linalg.inv(np.asarray(world_from_object, np.float64)).T
    out["half_extent"] = 0.5 * np.array(prepared.extent_m)
    out["ambient_n"] = out["dry_n"] = out["wet_n"] = prepared.ambient_n
    out["wet_level_m"] = -FAR
    out["proxy_center"], out["proxy_half"] = box or whole_box(prepared)
    out["scale"] = scale_of(world_from_object)
    out["voxel"] = prepared.voxel
    out["step"] = quality.step_voxels * prepared.voxel
    out["force_scale"] = textures.force_scales[channel]
    out["index_scale"] = textures.index_scales[channel]
    out["boundary_on"] = min(prepared.boundary_on_per_m, FAR)
    out["boundary_off"] = prepared.boundary_off_per_m
    out["min_weight"] = quality.min_weight
    out["coat"] = (1.0, 1.0, 1.0, 0.0)
    out["pause"] = PAUSE_TURN if meets_meshes and curved else FAR
    out["max_steps"] = quality.max_steps
    out["bounces"] = quality.bounces
    out["writes_depth"] = prepared.sharp or np.isfinite(prepared.boundary_on_per_m)
    out["matter_half"] = 0.5 * np.array(prepared.matter_extent_m)
    out["region_count"] = len(row.region_n)
    for k, n in enumerate(row.region_n):
        out["region_n"][k] = n
        out["region_absorption"][k, :3] = prepared.region_absorption[k]
        out["region_emission"][k, :3] = prepared.region_emission[k]
        out["region_scattering"][k] = prepared.region_scattering[k]
    assert out.dtype.itemsize == VolumeParams.itemsize
    return out
