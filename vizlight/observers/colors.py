"""Colours as a screen shows them and as a reader compares them: bytes, CIELAB, chromaticity."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.shading.display import displayable

if TYPE_CHECKING:
    from vizlight._types import Array


#: CIE XYZ of linear sRGB (IEC 61966-2-1), and of white D65.
_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
_WHITE = _XYZ.sum(axis=1)
#: Variance of rounding to bytes, in units of the range.
ROUNDING = (1 / 255) ** 2 / 12


def linear(rgb: Array) -> Array:
    """Return sRGB values, from 0 to 1, in linear light (IEC 61966-2-1)."""
    found: Array = np.where(
        rgb <= 0.04045, rgb / 12.92, ((np.maximum(rgb, 0.0) + 0.055) / 1.055) ** 2.4
    )
    return found


def lab(rgb: Array) -> Array:
    """Return CIELAB of sRGB values, shape (..., 3) from 0 to 1, under white D65 (CIE 15)."""
    ratio = linear(rgb) @ _XYZ.T / _WHITE
    f = np.where(ratio > 0.008856, np.cbrt(ratio), 7.787 * ratio + 16 / 116)
    x, y, z = f[..., 0], f[..., 1], f[..., 2]
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def chromaticity(rgb: Array) -> Array:
    """Return the share of each channel in the sum of the three; 0 for black."""
    total = rgb.sum(axis=-1, keepdims=True)
    found: Array = rgb / np.maximum(total, 1 / 255)
    return found


def shown(rgb: Array) -> Array:
    """Return the colours of light, 0 or more, in the range of a screen."""
    return displayable(np.maximum(rgb, 0.0))


def seen(rgb: Array, random: np.random.Generator, noise: float) -> Array:
    """Return colours of light as a reader gets them: on a screen, with noise, in bytes."""
    colors = shown(rgb)
    noisy = colors + random.normal(0.0, noise, colors.shape)
    found: Array = np.rint(255 * np.clip(noisy, 0.0, 1.0)) / 255
    return found


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
