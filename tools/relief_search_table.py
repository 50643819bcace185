"""Prints the table of searches in docs/relief.md: how far each is off, how often it is wrong, and what it costs.

800 x 600 rays of a camera over three surfaces, seen from 60 and from 30 degrees above the horizon, against
`techniques/relief/reference.py`. An error is a distance along the ray times its slope, as a share of the depth of the
relief; a hit is wrong that is off by more than 2 %. Costs are times of the processor, less those of a kernel that
searches nowhere, as a share of the thesis's search of 24 + 6 steps; medians of seven.
"""

from __future__ import annotations

import sys
import time
from typing import Any

import numpy as np

from pellucid.fields.textures import bricks
from pellucid.gpu import Device
from pellucid.scene.relief_quality import ReliefQuality
from pellucid.techniques.relief.meet import ReliefMeeting
from pellucid.techniques.relief.reference import HeightField, ReliefRays, first_below

SIZE = (800, 600)
TEXELS = 256
TILE = (0.45, 0.45)
DISTANCE_M = 0.9
CHECKED = 6000  # rays that are compared
PLAIN: dict[str, Any] = {"adapt_angle": False, "adapt_distance": False}
SEARCHES = {
    "24 steps": ReliefQuality(search="linear", binary_steps=0, linear_approximation=False, **PLAIN),
    "24 + 6 steps": ReliefQuality(search="linear", linear_approximation=False, **PLAIN),
    "24 + 6 steps, line": ReliefQuality(search="linear", **PLAIN),
    "the same, adapted to the angle": ReliefQuality(search="linear", adapt_distance=False),
    "the same, adapted to heights too": ReliefQuality(search="linear", adapt_distance=False, complexity=True),
    "distance map": ReliefQuality(search="distance", **PLAIN),
    "maxima": ReliefQuality(search="max_mip"),
    "cones": ReliefQuality(search="cone"),
}
THESIS = "24 + 6 steps, line"


def surfaces() -> dict[str, np.ndarray]:
    """Heights in metres: round hills, bricks with steep edges, spikes a texel wide."""
    from scipy.ndimage import gaussian_filter

    rng = np.random.default_rng(2)
    hills = gaussian_filter(rng.standard_normal((TEXELS, TEXELS)), 14, mode="wrap")
    spikes = gaussian_filter(rng.random((TEXELS, TEXELS)) ** 8, 0.7, mode="wrap")
    scaled = {name: (h - h.min()) / np.ptp(h) for name, h in (("hills", hills), ("spikes", spikes))}
    wall = np.asarray(bricks(size=TEXELS, tile_m=TILE[0]).heights_m)
    found = {"hills": 0.03 * scaled["hills"], "bricks": wall, "spikes": 0.015 * scaled["spikes"]}
    return {name: h.astype(np.float32) for name, h in found.items()}


def view(elevation_deg: float, high: float, low: float) -> tuple[ReliefRays, np.ndarray]:
    """Rays of all pixels where they come under the highest height, and their reach to the lowest."""
    angle, spread = np.radians(elevation_deg), np.tan(np.radians(20.0))
    forward = np.array([0.0, np.cos(angle), -np.sin(angle)])
    right = np.array([1.0, 0.0, 0.0])
    x = ((np.arange(SIZE[0]) + 0.5) / SIZE[0] * 2 - 1) * spread * SIZE[0] / SIZE[1]
    y = (1 - (np.arange(SIZE[1]) + 0.5) / SIZE[1] * 2) * spread
    d = forward + x[None, :, None] * right + y[:, None, None] * np.cross(right, forward)
    d = (d / np.linalg.norm(d, axis=-1, keepdims=True)).reshape(-1, 3)
    start = -DISTANCE_M * forward + d * ((high + DISTANCE_M * forward[2]) / d[:, 2:])
    return ReliefRays.of(start[:, :2] / TILE, high, d, TILE), 1.001 * (high - low) / -d[:, 2]


def seconds(meeting: ReliefMeeting, count: int) -> float:
    """Median time of the processor for searching along all rays."""
    taken = []
    for _ in range(7):
        begin = time.process_time()
        meeting.run(count)
        meeting.device.wait()
        taken.append(time.process_time() - begin)
    return float(np.median(taken))


def main() -> int:
    """Print one table a surface."""
    device = Device.create()
    print("| surface, view | search | error, median | 99 % | wrong | cost |\n|---|---|---|---|---|---|")
    for name, heights in surfaces().items():
        meetings = {search: ReliefMeeting(device, heights, None, q, TILE) for search, q in SEARCHES.items()}
        high, low = float(heights.max()), float(heights.min())
        for elevation in (60.0, 30.0):
            rays, reach = view(elevation, high, low)
            picked = np.random.default_rng(0).choice(len(rays), CHECKED, replace=False)
            some = ReliefRays(*(v[picked] for v in (rays.uv, rays.h, rays.duv, rays.dh, rays.bend)))
            true = first_below(HeightField(heights), some, reach[picked])
            meetings["cones"](rays, np.zeros(len(rays)))
            nowhere = seconds(meetings["cones"], len(rays))
            found = {search: meeting(rays, reach)[0][picked] for search, meeting in meetings.items()}
            cost = {search: seconds(meeting, len(rays)) - nowhere for search, meeting in meetings.items()}
            for search, t in found.items():
                error = np.minimum(np.abs(t - true) * -some.dh / (high - low), 1.0)
                middle, most = np.percentile(error, [50, 99])
                numbers = f"{middle:.1e} | {most:.1e} | {100 * np.mean(error > 0.02):.2f} %"
                print(f"| {name}, {elevation:.0f}° | {search} | {numbers} | {cost[search] / cost[THESIS]:.2f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
