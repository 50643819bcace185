"""You should see: printed, how near to its focus a Luneburg lens brings parallel rays; in theory all meet there."""

from pathlib import Path

import numpy as np

import pellucid as pl
from pellucid.fields import shapes


def main(output: Path | None = None, size: tuple[int, int] | None = None, resolution: int = 96) -> float:
    radius = 0.04
    lens = pl.RefractiveVolume.from_function(
        shapes.luneburg(radius), resolution, 2.1 * radius, boundary="smooth", smoothing_voxels=0.0
    )
    # Arrays in, arrays out: a bundle of 400 rays along +z that fills the middle nine tenths of the lens.
    rng = np.random.default_rng(1)
    r, turn = 0.9 * radius * np.sqrt(rng.random(400)), 2.0 * np.pi * rng.random(400)
    origins = np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(400, -0.2)])
    rays = pl.trace(lens, origins, np.array([0.0, 0.0, 1.0]))  # one direction for all

    focus = np.array([0.0, 0.0, radius])
    miss = np.linalg.norm(np.cross(focus - rays.position, rays.direction), axis=1)
    print(f"{np.sum(rays.status == 'left')} of {len(rays)} rays left the lens")
    print(f"they pass the focus at {1e6 * np.median(miss):.1f} um (median), {1e6 * miss.max():.1f} um (most)")
    return float(np.median(miss) / radius)


if __name__ == "__main__":
    main()
