"""Writes the table of look-ups into docs/water.md: how far off are the iteration of the thesis and the march, by steps.

Refracted rays of a waved surface over three bottoms, two metres deep, seen from 2.5 m above the water through a picture
of 512 x 512 that is taken as in the thesis, against triangles met in float64. The error is the distance between the
point that a ray meets and the one that the picture shows for it; a ray fails that is off by more than 5 % of its way.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

import numpy as np
from marked_page import write_between

import pellucid as pl
from pellucid.gpu import Device
from pellucid.optics.snell import refract
from pellucid.scene.water_quality import WaterQuality
from pellucid.surroundings import Surroundings
from pellucid.surroundings.camera import view_of
from pellucid.techniques.water.cameras import ray_of
from pellucid.techniques.water.picture_query import HIDDEN, UNKNOWN, PictureQuery
from pellucid.techniques.water.reference_pictures import first_triangle
from pellucid.techniques.water.views import SurfacePictures

PAGE = Path(__file__).resolve().parents[1] / "docs" / "water.md"
MARKS = "<!-- look-ups: written by tools/water_intersection_table.py -->", "<!-- end of look-ups -->"
CAMERA = pl.Camera((0.0, 2.5, 6.0), (0.0, 0.0, 0.0), fov_deg=45.0)
HALF_M = 10.0  # of the water
RAYS = 600
STEPS = (1, 2, 3, 4, 5, 6, 7, 8, 16)
FAILS = 0.05
SKY_M = 100.0
SLOPE = 0.1


def ground(heights: Any, side: int = 97) -> pl.Mesh:
    """A mesh of heights y(x, z), 30 m wide."""
    x, z = np.meshgrid(np.linspace(-15, 15, side), np.linspace(-15, 15, side))
    i = np.arange(side * side).reshape(side, side)
    a, b, c, d = i[:-1, :-1].ravel(), i[1:, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel()
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([b, d, c], -1)])
    return pl.Mesh(np.stack([x, heights(x, z), z], -1).reshape(-1, 3), faces)


def bottoms() -> dict[str, list[pl.Mesh]]:
    """Meshes of three bottoms."""
    rng = np.random.default_rng(4)
    stones = []
    for _ in range(40):
        x, z = rng.uniform(-6, 6), rng.uniform(-6, 5)
        size = rng.uniform(0.25, 0.6)
        turn = tuple(rng.uniform(0, 90, 3))
        shape = pl.Mesh.box(1.5 * size) if rng.random() < 0.5 else pl.Mesh.sphere(size)
        stones.append(shape.replace(position=(x, -2.0 + 0.3 * size, z), rotation=turn))
    return {
        "a slope": [ground(lambda x, z: -2.0 + 0.05 * x - 0.04 * z, 3)],
        "hills": [ground(lambda x, z: -1.8 + 0.4 * np.sin(1.1 * x) * np.cos(0.9 * z))],
        "steps and stones": [ground(lambda x, z: -2.0 + 0.5 * (np.sin(0.8 * z + 0.3 * x) > 0.4), 193), *stones],
    }


def rays() -> tuple[np.ndarray, np.ndarray]:
    """Points of the surface, evenly over the picture, and refracted directions there."""
    rng = np.random.default_rng(1)
    view = view_of(CAMERA, (800, 600))
    origin, ways = view.position, np.array([ray_of(view, ndc)[1] for ndc in rng.uniform(-1, 1, (2 * RAYS, 2))])
    ways = ways[ways[:, 1] < -0.05]
    points = origin - ways * (origin[1] / ways[:, 1])[:, None]
    inside = np.abs(points[:, [0, 2]]).max(axis=1) < HALF_M
    points, ways = points[inside][:RAYS], ways[inside][:RAYS]
    x, z = points[:, 0], points[:, 2]
    slopes = SLOPE * np.stack([np.sin(3 * x + z), np.cos(2.5 * z - 0.7 * x)], -1)
    normals = np.stack([-slopes[:, 0], np.ones(len(slopes)), -slopes[:, 1]], -1)
    return points, refract(ways, normals / np.linalg.norm(normals, axis=1, keepdims=True), 1.0, 1.333).direction


def rows(device: Device) -> list[str]:
    """The table as lines of Markdown."""
    head = (
        "| bottom | look-up, steps | error, median | 95 % | fails | known to fail | show another place, sky, border |"
    )
    lines = [head, "|---|---|---|---|---|---|---|"]
    points, ways = rays()
    water = pl.Water(extent_m=2 * HALF_M, medium=1.333)
    for name, meshes in bottoms().items():
        around = Surroundings(device)
        around.prepare(pl.Scene(camera=CAMERA, environment=pl.Environment.constant(0.5), objects=meshes), (800, 600))
        triangles = around.geometry.triangles[: around.triangle_count]
        corners = np.stack([triangles[f"corner_{k}"] for k in range(3)], axis=1)
        way = first_triangle(points, ways, corners)
        met = np.isfinite(way)
        true = points + np.where(met, way, 0.0)[:, None] * ways
        for cameras in ("mihalik", "fitted"):
            pictures = SurfacePictures(device)
            quality = WaterQuality(refraction="march", cameras=cameras)
            encoder = device.wgpu.create_command_encoder()
            pictures.draw(encoder, water, quality, ((0.0, 0.0), SLOPE), around)
            device.wgpu.queue.submit([encoder.finish()])
            query = PictureQuery(pictures)
            tried = {f"iteration, {n}": query.iteration(points, ways, n) for n in STEPS} if cameras == "mihalik" else {}
            tried |= {f"march, {n}" + (", fitted" if cameras == "fitted" else ""): query.march(points, ways, n)
                      for n in ((4, 8, 16, 32) if cameras == "mihalik" else (16,))}  # fmt: skip
            for search, places in tried.items():
                error = np.linalg.norm(places.shown_ws - true, axis=1)[met]
                fails = error > FAILS * way[met]
                low, high = np.percentile(error, [50, 95])
                known = np.isin(places.found, (UNKNOWN, HIDDEN))[met] & fails
                border = ((places.uv < 0.0) | (places.uv > 1.0)).any(axis=1)[met] & fails
                sky = (np.linalg.norm(places.shown_ws - points, axis=1) > SKY_M)[met] & fails & ~border
                shares = [f"{100 * part.mean():.1f} %" for part in (fails, known, fails & ~sky & ~border, sky, border)]
                numbers = f"{_metres(low)} | {_metres(high)} | {shares[0]} | {shares[1]}"
                lines.append(f"| {name} | {search} | {numbers} | {', '.join(shares[2:])} |")
    return lines


def _metres(value: float) -> str:
    if value > SKY_M:
        return "sky"
    return f"{1000 * value:.2g} mm" if value < 0.1 else f"{value:.2f} m"


def main() -> int:
    """Print the table, or write it into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help=f"put it into {PAGE.name}")
    table = "\n".join(rows(Device.create()))
    if not parser.parse_args().write:
        print(table)
        return 0
    write_between(PAGE, MARKS, table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
