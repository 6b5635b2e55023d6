"""An ideal observer: how well each candidate explains the noisy colour of a pixel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.observers.colors import ROUNDING

if TYPE_CHECKING:
    from vizlight._types import Array


def posterior(observed: Array, table: Array, noise: float) -> Array:
    """Return the probability of each candidate, equally likely before the pixel is seen.

    Parameters
    ----------
    observed : ndarray, shape (M, 3)
        Colours of pixels, from 0 to 1.
    table : ndarray, shape (A, 3) or (M, A, 3)
        Colours of the candidates without noise, the same for all pixels or separate for each.
    noise : float
        Standard deviation of each channel, to which the deviation of rounding to bytes is added.

    Returns
    -------
    ndarray, shape (M, A)
        Probabilities, with sum 1 in each row.
    """
    if table.ndim == 3:
        square = ((observed[:, np.newaxis] - table) ** 2).sum(axis=-1)
    else:
        square = (observed**2).sum(axis=-1)[:, np.newaxis] + (table**2).sum(axis=-1)
        square = square - 2 * observed @ table.T
    square -= square.min(axis=1, keepdims=True)
    found: Array = np.exp(-square / (2 * (noise**2 + ROUNDING)))
    return np.asarray(found / found.sum(axis=1, keepdims=True))


def information(probability: Array) -> Array:
    """Return the bits that each pixel tells of candidates that were equally likely before."""
    bits = probability * np.log2(np.maximum(probability, 1e-300))
    found: Array = np.log2(probability.shape[1]) + bits.sum(axis=1)
    return found
