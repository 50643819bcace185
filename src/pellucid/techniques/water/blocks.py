"""Blocks of pixels that share one look at the water."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pellucid.techniques.water.region import Rectangle

if TYPE_CHECKING:
    from pellucid.surroundings.camera import View

Block = tuple[int, int]
LEAST_SINE = 0.05  # of the angle between a view and the level


def block_of(count: int, view: View) -> Block:
    """Pixels from left to right and from top to bottom of a block of about `count` pixels.

    A pixel covers 1 / sin of the angle between view and level as much of the level along the view as across it: so
    blocks are wider than they are high by as much, and cover squares of water.
    """
    right, up, forward = view.axes
    sine = max(abs(float(forward[1])), LEAST_SINE)
    along = max(round(np.sqrt(count * sine)), 1)
    across = max(round(count / along), 1)
    return (along, across) if abs(right[1]) > abs(up[1]) else (across, along)


def divided(region: Rectangle, block: Block) -> Rectangle:
    """The blocks (left, top, width, height) that a part of the picture touches."""
    left, top, width, height = region
    first = left // block[0], top // block[1]
    return (*first, -(-(left + width) // block[0]) - first[0], -(-(top + height) // block[1]) - first[1])
