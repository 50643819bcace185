"""Block letters from strokes of one width, A to Z, digits and a few signs; no font is needed."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np

from pellucid.errors import SceneError

from .primitives import Shape, Values, difference, extruded, moved, positive, rounded_box, union

#: Width of the cell that centre lines fill, and the space to the next letter, in letter heights.
LETTER_WIDTH = 0.6
LETTER_GAP = 0.34

Path = list[tuple[float, float]]


def _arc(cx: float, cy: float, rx: float, ry: float, start_deg: float, stop_deg: float) -> Path:
    steps = max(3, int(abs(stop_deg - start_deg) / 15.0))
    turn = np.radians(np.linspace(start_deg, stop_deg, steps + 1))
    return [(float(cx + rx * np.cos(a)), float(cy + ry * np.sin(a))) for a in turn]


def _bowl(y0: float, y1: float, left: float = 0.0) -> Path:
    """The bow of B, D, P and R between two heights."""
    radius = min(0.5 * (y1 - y0), 0.3)
    straight = 0.6 - radius
    upper = _arc(straight, y1 - radius, radius, radius, 90, 0)
    lower = _arc(straight, y0 + radius, radius, radius, 0, -90)
    return [(left, y1), *upper, *lower, (left, y0)]


_O = _arc(0.3, 0.7, 0.3, 0.3, 0, 180) + _arc(0.3, 0.3, 0.3, 0.3, 180, 360) + [(0.6, 0.7)]
_C = _arc(0.3, 0.7, 0.3, 0.3, 25, 180) + _arc(0.3, 0.3, 0.3, 0.3, 180, 335)
_S = _arc(0.3, 0.75, 0.27, 0.25, 30, 270) + _arc(0.3, 0.25, 0.27, 0.25, 90, -150)

#: Centre lines in a cell 0.6 wide and 1 high.
STROKES: dict[str, list[Path]] = {
    " ": [],
    "A": [[(0, 0), (0.3, 1), (0.6, 0)], [(0.12, 0.4), (0.48, 0.4)]],
    "B": [[(0, 0), (0, 1)], _bowl(0.52, 1.0), _bowl(0.0, 0.52)],
    "C": [_C],
    "D": [[(0, 0), (0, 1)], _bowl(0.0, 1.0)],
    "E": [[(0.55, 1), (0, 1), (0, 0), (0.55, 0)], [(0, 0.52), (0.45, 0.52)]],
    "F": [[(0.55, 1), (0, 1), (0, 0)], [(0, 0.52), (0.45, 0.52)]],
    "G": [[*_C, (0.6, 0.45), (0.35, 0.45)]],
    "H": [[(0, 0), (0, 1)], [(0.6, 0), (0.6, 1)], [(0, 0.5), (0.6, 0.5)]],
    "I": [[(0.3, 0), (0.3, 1)]],
    "J": [[(0.55, 1), *_arc(0.275, 0.275, 0.275, 0.275, 0, -170)]],
    "K": [[(0, 0), (0, 1)], [(0.58, 1), (0, 0.42)], [(0.2, 0.62), (0.6, 0)]],
    "L": [[(0, 1), (0, 0), (0.55, 0)]],
    "M": [[(0, 0), (0, 1), (0.3, 0.4), (0.6, 1), (0.6, 0)]],
    "N": [[(0, 0), (0, 1), (0.6, 0), (0.6, 1)]],
    "O": [_O],
    "P": [[(0, 0), (0, 1)], _bowl(0.45, 1.0)],
    "Q": [_O, [(0.36, 0.26), (0.62, 0)]],
    "R": [[(0, 0), (0, 1)], _bowl(0.48, 1.0), [(0.3, 0.48), (0.6, 0)]],
    "S": [_S],
    "T": [[(0, 1), (0.6, 1)], [(0.3, 1), (0.3, 0)]],
    "U": [[(0, 1), *_arc(0.3, 0.3, 0.3, 0.3, 180, 360), (0.6, 1)]],
    "V": [[(0, 1), (0.3, 0), (0.6, 1)]],
    "W": [[(0, 1), (0.13, 0), (0.3, 0.62), (0.47, 0), (0.6, 1)]],
    "X": [[(0, 0), (0.6, 1)], [(0, 1), (0.6, 0)]],
    "Y": [[(0, 1), (0.3, 0.5), (0.6, 1)], [(0.3, 0.5), (0.3, 0)]],
    "Z": [[(0, 1), (0.6, 1), (0, 0), (0.6, 0)]],
    "0": [_O, [(0.14, 0.25), (0.46, 0.75)]],
    "1": [[(0.1, 0.8), (0.3, 1), (0.3, 0)]],
    "2": [[*_arc(0.3, 0.72, 0.28, 0.28, 170, -35), (0.02, 0), (0.6, 0)]],
    "3": [_arc(0.27, 0.76, 0.26, 0.24, 160, -90), _arc(0.27, 0.26, 0.3, 0.26, 90, -160)],
    "4": [[(0.46, 0), (0.46, 1), (0, 0.3), (0.6, 0.3)]],
    "5": [[(0.55, 1), (0.08, 1), (0.05, 0.55), *_arc(0.27, 0.3, 0.31, 0.3, 120, -150)]],
    "6": [_arc(0.3, 0.3, 0.28, 0.3, 0, 360), [(0.03, 0.36), (0.4, 1)]],
    "7": [[(0, 1), (0.6, 1), (0.2, 0)]],
    "8": [_arc(0.3, 0.76, 0.24, 0.24, 0, 360), _arc(0.3, 0.26, 0.29, 0.26, 0, 360)],
    "9": [_arc(0.3, 0.7, 0.28, 0.3, 0, 360), [(0.57, 0.64), (0.2, 0)]],
    "-": [[(0.12, 0.5), (0.48, 0.5)]],
    ".": [[(0.3, 0), (0.3, 0.001)]],
}


def text_width_m(text: str, height_m: float) -> float:
    """Length of a line of text between the outer centre lines, metres; the height is that of the centre lines."""
    return height_m * (len(text) * (LETTER_WIDTH + LETTER_GAP) - LETTER_GAP)


def lettering(
    text: str, height_m: float, depth_m: float, stroke_m: float | None = None, rounding_m: float = 0.0
) -> Shape:
    """A line of text in x, y, centred, drawn out along z; exact outside if `rounding_m` is 0.

    Parameters
    ----------
    text : letters A to Z (small ones are made capital), digits, space, full stop, hyphen.
    height_m : of the capitals, strokes included.
    depth_m : along z.
    stroke_m : width of the strokes, a seventh of the height if not given.
    rounding_m : radius of the rims, at most half of the stroke.

    Raises
    ------
    SceneError
        A sign that is not there, or no letter at all.
    """
    stroke = positive("height_m", height_m) / 7.0 if stroke_m is None else positive("stroke_m", stroke_m)
    core = positive("height_m minus stroke_m", height_m - stroke)
    segments = _segments(text, core)
    if not 0.0 <= rounding_m <= 0.5 * stroke:
        raise SceneError("rounding_m", f"is {rounding_m}", "use 0 to half of the stroke")

    def flat(x: Any, y: Any) -> Values:
        nearest = np.full(np.broadcast(x, y).shape, np.inf)
        for (ax, ay), (bx, by) in segments:
            ex, ey = bx - ax, by - ay
            px, py = x - ax, y - ay
            t = np.clip((px * ex + py * ey) / (ex * ex + ey * ey), 0.0, 1.0)
            np.minimum(nearest, (px - t * ex) ** 2 + (py - t * ey) ** 2, out=nearest)
        return np.sqrt(nearest) - 0.5 * stroke

    def on_one_sheet(x: Any, y: Any) -> Values:
        """All layers of a grid share their x and y: measure one layer."""
        x, y = np.broadcast_arrays(x, y)
        if x.ndim == 3 and x.shape[0] > 1 and _same_layers(x) and _same_layers(y):
            return np.broadcast_to(flat(x[0], y[0]), x.shape)
        return flat(x, y)

    return extruded(on_one_sheet, depth_m, rounding_m)


def embossed_block(
    text: str, size_m: Sequence[float], letter_height_m: float, relief_m: float, engraved: bool = False
) -> Shape:
    """A rounded block with text standing out of its front (+z), or cut into it.

    Parameters
    ----------
    text : as in `lettering`.
    size_m : block (x, y, z) without the letters.
    letter_height_m : of the capitals.
    relief_m : how far the letters stand out, or how deep they are cut.

    Raises
    ------
    SceneError
        The text is larger than the block, or as in `lettering`.
    """
    x, y, z = (positive("size_m", v) for v in size_m)
    if text_width_m(text, letter_height_m) > x or letter_height_m > y:
        raise SceneError("letter_height_m", "makes the text larger than the block", "use a smaller one")
    block = rounded_box((x, y, z), 0.08 * min(x, y, z))
    letters = lettering(text, letter_height_m, 2.0 * positive("relief_m", relief_m))
    letters = moved(letters, (0.0, 0.0, 0.5 * z))
    return difference(block, letters) if engraved else union(block, letters)


def _segments(text: str, height: float) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    unknown = sorted(set(text.upper()) - set(STROKES))
    if unknown:
        raise SceneError("text", f"has {''.join(unknown)!r}", f"there are {''.join(STROKES)!r}")
    left = -0.5 * text_width_m(text, height)
    segments = []
    for n, letter in enumerate(text.upper()):
        start = left + n * (LETTER_WIDTH + LETTER_GAP) * height
        for path in STROKES[letter]:
            line = [(start + u * height, (v - 0.5) * height) for u, v in path]
            segments += [(a, b) for a, b in itertools.pairwise(line) if a != b]
    if not segments:
        raise SceneError("text", "has no letters")
    return segments


def _same_layers(values: Values) -> bool:
    return values.strides[0] == 0 or bool(np.array_equal(values[0], values[-1]) and (values == values[:1]).all())
