"""Waves as plain dictionaries and arrays, and back: what scene files say of them."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from pellucid.errors import SceneError
from pellucid.fields.waves.heights import Heights
from pellucid.fields.waves.layers import Sum
from pellucid.fields.waves.mesh import MeshWaves
from pellucid.fields.waves.ocean import Ocean
from pellucid.fields.waves.ripples import Ripples
from pellucid.fields.waves.source import WaveSource
from pellucid.fields.waves.trains import Gerstner, Sine

Arrays = dict[str, np.ndarray]

_GRID = ("tile_m", "shape", "level_m")
_TRAINS = ("wavelength_m", "amplitude_m", "direction_deg", "phase_deg", "speed_m_s", "depth_m", "periodic", *_GRID)
FIELDS: dict[str, tuple[str, ...]] = {
    "sine": _TRAINS,
    "gerstner": (*_TRAINS, "sharpness"),
    "ocean": (
        *("wind_m_s", "wind_deg", "spectrum", "spreading", "fetch_m", "depth_m", "choppiness", "amplitude", "seed"),
        *("shortest_m", "longest_m"),
        *("loop_s", *_GRID),
    ),
    "ripples": (
        *("shape", "cell_m", "speed_m_s", "damping", "boundary", "level_m", "limit_m", "drops", "pushes"),
    ),
    "heights": ("tile_m", "periodic", "loop", "arrays"),
    "mesh": ("tile_m", "shape", "limits_m", "loop", "arrays"),
    "sum": ("layers",),
}  # fmt: skip
_DROP = ("time_s", "x_m", "z_m", "radius_m", "strength_m")


def to_plain(source: Any) -> tuple[dict[str, Any], Arrays]:
    """Waves as what `from_plain` understands: a dictionary of numbers, words and lists, and the arrays beside it.

    Raises
    ------
    SceneError : waves that are a function, or of a class of the user's own.
    """
    arrays: Arrays = {}
    return _described(source, "", arrays), arrays


def from_plain(plain: Mapping[str, Any], arrays: Mapping[str, np.ndarray] | None = None) -> WaveSource:
    """The waves that a dictionary describes; fields that are left out have the value of the class.

    Parameters
    ----------
    plain : ``kind`` is one of `FIELDS`. arrays : those that `to_plain` gave, by name.

    Raises
    ------
    SceneError : an unknown kind or field, arrays that are missing, or values out of range.
    """
    return _built(plain, "", dict(arrays or {}))


def _described(source: Any, prefix: str, arrays: Arrays) -> dict[str, Any]:
    if type(source) not in (Sine, Gerstner, Ocean, Ripples, Heights, MeshWaves, Sum):
        raise SceneError("waves", f"a {type(source).__name__} cannot be written to a scene file")
    plain: dict[str, Any] = {"kind": source.kind}
    if isinstance(source, Sum):
        layers = enumerate(source.layers)
        return plain | {"layers": [_described(layer, f"{prefix}layer{n}.", arrays) for n, layer in layers]}
    for name in FIELDS[source.kind]:
        value = source.trains.get(name) if isinstance(source, Sine) and name in source.trains else None
        value = getattr(source, name, None) if value is None else value
        if value is not None and not (isinstance(value, float) and np.isinf(value)):
            plain[name] = _plain(value)
    if isinstance(source, Ripples):
        plain |= _disturbances(source)
    if isinstance(source, Heights):
        arrays[f"{prefix}heights"], arrays[f"{prefix}times_s"] = source.pictures, source.times_s
    if isinstance(source, MeshWaves):
        if source.function is not None:
            raise SceneError("waves", "that are a function cannot be written to a scene file", "store some moments")
        arrays[f"{prefix}vertices"] = np.stack([vertices for vertices, _ in source.meshes])
        arrays[f"{prefix}faces"], arrays[f"{prefix}times_s"] = source.meshes[0][1], source.times_s
    return plain


def _disturbances(source: Ripples) -> dict[str, Any]:
    drops = [{name: getattr(drop, name) for name in _DROP} for drop in source.disturbances]
    pushes = [
        {"path_m": [list(at) for at in push.path_m], "radius_m": push.radius_m, "strength_m": push.strength_m,
         "times_s": list(push.times_s)}
        for push in source.pushes
    ]  # fmt: skip
    return ({"drops": drops} if drops else {}) | ({"pushes": pushes} if pushes else {})


def _built(plain: Mapping[str, Any], prefix: str, arrays: Arrays) -> WaveSource:
    given = dict(plain)
    kind = given.pop("kind", None)
    if kind not in FIELDS:
        raise SceneError("waves.kind", f"is {kind!r}", f"use one of {', '.join(FIELDS)}")
    for name in given:
        if name not in FIELDS[kind]:
            near = difflib.get_close_matches(name, FIELDS[kind], 1)
            remedy = f"did you mean {near[0]!r}?" if near else f"{kind} has {', '.join(FIELDS[kind])}"
            raise SceneError(f"waves.{name}", f"is not known of {kind}", remedy)
    given.pop("arrays", None)
    if kind == "sum":
        layers = given.get("layers")
        if not isinstance(layers, list | tuple) or not all(isinstance(layer, Mapping) for layer in layers):
            raise SceneError("waves.layers", "are missing", "give a list of waves")
        return Sum(*(_built(layer, f"{prefix}layer{n}.", arrays) for n, layer in enumerate(layers)))
    given = {name: tuple(value) if isinstance(value, list) else value for name, value in given.items()}
    return MAKERS[kind](given, lambda name: _array(arrays, f"{prefix}{name}"))


def _ripples(given: dict[str, Any]) -> Ripples:
    drops, pushes = given.pop("drops", ()), given.pop("pushes", ())
    _needed("ripples", given, "shape", "cell_m")
    ripples = Ripples(**given)
    for calls, make, field in ((drops, ripples.drop, "drops"), (pushes, ripples.push, "pushes")):
        for call in calls:
            try:
                make(**call)  # type: ignore[operator]
            except TypeError as error:
                raise SceneError(f"waves.{field}", f"cannot be {call!r:.60}", str(error)) from None
    return ripples


def _heights(given: dict[str, Any], array: Callable[[str], np.ndarray]) -> Heights:
    _needed("heights", given, "tile_m")
    return Heights(array("heights"), times_s=array("times_s"), **given)


def _mesh(given: dict[str, Any], array: Callable[[str], np.ndarray]) -> MeshWaves:
    _needed("mesh", given, "tile_m")
    meshes = [(vertices, array("faces")) for vertices in np.atleast_3d(array("vertices"))]
    return MeshWaves(meshes if len(meshes) > 1 else meshes[0], times_s=array("times_s"), **given)


MAKERS: dict[str, Callable[[dict[str, Any], Callable[[str], np.ndarray]], WaveSource]] = {
    "sine": lambda given, _: Sine(**given),
    "gerstner": lambda given, _: Gerstner(**given),
    "ocean": lambda given, _: Ocean(**given),
    "ripples": lambda given, _: _ripples(given),
    "heights": _heights,
    "mesh": _mesh,
}


def _needed(kind: str, given: Mapping[str, Any], *names: str) -> None:
    for name in names:
        if name not in given:
            raise SceneError(f"waves.{name}", f"is missing for {kind}", "give it")


def _array(arrays: Mapping[str, np.ndarray], name: str) -> np.ndarray:
    if name not in arrays:
        raise SceneError("waves.arrays", f"hold no {name!r}", "save the scene again")
    return arrays[name]


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.item() if value.size == 1 else value.tolist()
    if isinstance(value, tuple | list):
        return [_plain(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value
