"""Change the size of an image by integrating it over the area of each new pixel."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

Measure = Callable[[np.ndarray], np.ndarray]


def area_resample(image: np.ndarray, size: tuple[int, int], row_measure: Measure | None = None) -> np.ndarray:
    """Average the piecewise constant image over each new pixel.

    Parameters
    ----------
    image : (H, W, C).
    size : (height, width) of the result.
    row_measure : grows from the top (0) to the bottom (1) of the image by the weight of what was passed,
        such as solid angle; equal weight when absent.

    Returns
    -------
    (height, width, C) in the dtype of `image`. The weighted integral of the image is kept.
    """
    narrowed = _resample_axis(image, 1, size[1], _uniform)
    return _resample_axis(narrowed, 0, size[0], row_measure or _uniform)


def _uniform(position: np.ndarray) -> np.ndarray:
    return position


def _resample_axis(image: np.ndarray, axis: int, size: int, measure: Measure) -> np.ndarray:
    old = image.shape[axis]
    if size == old:
        return image
    if old == 2 * size:
        return _halve(image, axis, measure)
    share = _shares(old, size, measure).astype(image.dtype)
    return np.ascontiguousarray(np.moveaxis(np.tensordot(share, image, axes=(1, axis)), 0, axis))


def _halve(image: np.ndarray, axis: int, measure: Measure) -> np.ndarray:
    weights = np.diff(measure(np.linspace(0.0, 1.0, image.shape[axis] + 1)))
    share = weights[0::2] / (weights[0::2] + weights[1::2])
    share = share.reshape([-1 if k == axis else 1 for k in range(image.ndim)]).astype(image.dtype)
    first = image.take(np.arange(0, image.shape[axis], 2), axis)
    second = image.take(np.arange(1, image.shape[axis], 2), axis)
    return share * first + (1 - share) * second


def _shares(old: int, new: int, measure: Measure) -> np.ndarray:
    """Weight of each old cell in each new one: (new, old), rows summing to 1."""
    old_edges, new_edges = np.linspace(0.0, 1.0, old + 1), np.linspace(0.0, 1.0, new + 1)
    low = np.maximum(new_edges[:-1, None], old_edges[None, :-1])
    high = np.minimum(new_edges[1:, None], old_edges[None, 1:])
    overlap = measure(np.maximum(low, high)) - measure(low)
    return overlap / overlap.sum(axis=1, keepdims=True)
