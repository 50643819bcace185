"""Cubes as mesh files: whole, turned inside out, open."""

from __future__ import annotations

CUBE = """\
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
"""
OUTWARD = ((1, 4, 3, 2), (5, 6, 7, 8), (1, 2, 6, 5), (3, 4, 8, 7), (2, 3, 7, 6), (1, 5, 8, 4))


def cube_text(inverted: bool = False, faces: int = 6) -> str:
    """An OBJ of a cube of one metre; `faces` < 6 leaves it open."""
    sides = [side[::-1] if inverted else side for side in OUTWARD[:faces]]
    return CUBE + "".join(f"f {' '.join(map(str, side))}\n" for side in sides)
