"""Triangles between transparent matter: what rays meet that come from other things, where a technique draws better."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pellucid.surroundings import bvh
from pellucid.surroundings.layouts import BvhNode, BvhTriangle, Material, TriangleAttributes


@dataclass(frozen=True, eq=False)
class Interface:
    """A surface between two kinds of matter.

    Attributes
    ----------
    vertices : (V, 3) metres, world space. faces : (F, 3), counter-clockwise seen from outside.
    normals : (V, 3) unit, outwards.
    n : index behind the faces, over that of air. absorption_per_m : by channel, there.
    outer_n : index before them; 0 for whatever is around, air or water. outer_absorption_per_m : by channel, there.
    """

    vertices: np.ndarray
    faces: np.ndarray
    normals: np.ndarray
    n: float
    absorption_per_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    outer_n: float = 0.0
    outer_absorption_per_m: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Joined:
    """Opaque triangles and those of interfaces in one list, under one hierarchy whose first part is the opaque one's.

    Attributes
    ----------
    nodes, triangles, attributes : structured arrays of `layouts`. root : node over all.
    """

    nodes: np.ndarray
    triangles: np.ndarray
    attributes: np.ndarray
    root: int


def join(
    opaque: tuple[np.ndarray, np.ndarray, np.ndarray], count: int, interfaces: Sequence[Interface], first_material: int
) -> Joined:
    """Add interfaces behind opaque triangles.

    Parameters
    ----------
    opaque : nodes, triangles and attributes of the meshes. count : how many triangles of them there are, maybe none.
    first_material : place of the first interface's record among those of materials.
    """
    if not any(len(i.faces) for i in interfaces):
        return Joined(*opaque, 0)
    corners = np.concatenate([np.asarray(i.vertices, np.float64)[i.faces] for i in interfaces])
    tree = bvh.build(corners)
    triangles = np.zeros(len(corners), BvhTriangle)
    attributes = np.zeros(len(corners), TriangleAttributes)
    normals = np.concatenate([np.asarray(i.normals, np.float64)[i.faces] for i in interfaces])[tree.order]
    material = np.repeat(np.arange(len(interfaces)), [len(i.faces) for i in interfaces])
    for k in range(3):
        triangles[f"corner_{k}"], attributes[f"normal_{k}"] = corners[tree.order][:, k], normals[:, k]
    triangles["material"] = first_material + material[tree.order]
    nodes, root = _nodes(tree, opaque[0], len(opaque[1]), meshes=count > 0)
    return Joined(nodes, together(opaque[1], triangles), together(opaque[2], attributes), root)


def together(*records: np.ndarray) -> np.ndarray:
    """Records one after the other in their own layout: NumPy would leave out what pads them."""
    out = np.zeros(sum(len(part) for part in records), records[0].dtype)
    np.concatenate(records, out=out)
    return out


def matter_records(interfaces: Sequence[Interface]) -> np.ndarray:
    """One `layouts.Material` an interface: what lies behind it, and before it."""
    records = np.zeros(len(interfaces), Material)
    for record, item in zip(records, interfaces, strict=True):
        record["base_color_layer"] = -1
        record["inner"] = *item.absorption_per_m, item.n
        record["outer"] = *item.outer_absorption_per_m, item.outer_n
    return records


def _nodes(tree: bvh.Bvh, opaque: np.ndarray, triangles: int, meshes: bool) -> tuple[np.ndarray, int]:
    """Opaque nodes, one over all where there are meshes, and those of a tree of triangles behind the opaque ones."""
    before = len(opaque) + meshes
    own = np.zeros(len(tree.link), BvhNode)
    own["lower"], own["upper"], own["count"] = tree.lower, tree.upper, tree.count
    own["link"] = tree.link + np.where(tree.count > 0, triangles, before).astype(np.uint32)
    if not meshes:
        return together(opaque, own), before
    over = np.zeros(1, BvhNode)  # its left child is the node that follows it, its right one the first of all
    over["lower"] = np.minimum(own["lower"][0], opaque["lower"][0])
    over["upper"] = np.maximum(own["upper"][0], opaque["upper"][0])
    return together(opaque, over, own), len(opaque)
