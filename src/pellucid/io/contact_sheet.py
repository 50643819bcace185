"""A page of small pictures with their titles."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

THUMBNAIL_PX = 400
GAP_PX = 16
TITLE_PX = 34
FONT_PX = 17
PAPER = 24
INK = 0.86


def contact_sheet(pictures: Sequence[tuple[str, np.ndarray]], columns: int | None = None) -> np.ndarray:
    """Pictures in rows, each above its title.

    Parameters
    ----------
    pictures : pairs of a title and (H, W, 3) uint8 pixels. columns : pictures in a row, at most; if not
        given three, or four when there are more than a dozen.

    Returns
    -------
    (H, W, 3) uint8.
    """
    small = [(title, _thumbnail(pixels)) for title, pixels in pictures]
    columns = min(columns or (3 if len(small) <= 12 else 4), len(small))
    height = max(pixels.shape[0] for _, pixels in small)
    cell_w, cell_h = THUMBNAIL_PX + GAP_PX, height + TITLE_PX + GAP_PX
    rows = math.ceil(len(small) / columns)
    page = np.full((rows * cell_h + GAP_PX, columns * cell_w + GAP_PX, 3), PAPER, np.uint8)
    for i, (title, pixels) in enumerate(small):
        x, y = GAP_PX + i % columns * cell_w, GAP_PX + i // columns * cell_h
        page[y : y + pixels.shape[0], x : x + pixels.shape[1]] = pixels
        page[y + height : y + height + TITLE_PX, x : x + THUMBNAIL_PX] = _title(title)
    return page


def _thumbnail(pixels: np.ndarray) -> np.ndarray:
    """(h, 400, 3) uint8."""
    import OpenImageIO

    height = max(1, round(pixels.shape[0] * THUMBNAIL_PX / pixels.shape[1]))
    target = OpenImageIO.ROI(0, THUMBNAIL_PX, 0, height, 0, 1, 0, 3)
    resized = OpenImageIO.ImageBufAlgo.resize(OpenImageIO.ImageBuf(np.ascontiguousarray(pixels)), roi=target)
    return np.asarray(resized.get_pixels(OpenImageIO.UINT8)).reshape(height, THUMBNAIL_PX, 3)


def _title(text: str) -> np.ndarray:
    """(34, 400, 3) uint8; empty where no font can be found."""
    import OpenImageIO

    buffer = OpenImageIO.ImageBuf(np.full((TITLE_PX, THUMBNAIL_PX, 3), PAPER, np.uint8))
    if not OpenImageIO.ImageBufAlgo.render_text(buffer, 2, TITLE_PX - 12, text, FONT_PX, textcolor=(INK, INK, INK)):
        OpenImageIO.geterror()  # read, or it is printed when the program ends
    return np.asarray(buffer.get_pixels(OpenImageIO.UINT8)).reshape(TITLE_PX, THUMBNAIL_PX, 3)
