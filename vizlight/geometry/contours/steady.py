"""Samples moved within a tolerance so that their contours are short and without noise."""

from __future__ import annotations

import numpy as np
import scipy

from vizlight._types import Array, Bools, Slice

#: Rounds in which pixels become the mean of their neighbours.
ROUNDS = 24
#: Difference of neighbouring pixels above which they are of two surfaces, in tolerances.
JUMP = 24.0


def steadied(samples: Array, shown: Bools, scale: int, tolerance: float) -> Array:
    """Return samples that differ from others by at most a tolerance and vary as little as may be.

    Each pixel becomes the mean of its neighbours, round after round, and what is then farther away
    than the tolerance is put back to it. What differs by a jump is of another surface, and the
    borders of surfaces stay.
    """
    rows, columns = (side // scale * scale for side in shown.shape)
    blocks = samples[:rows, :columns].reshape(rows // scale, scale, columns // scale, scale, -1)
    low, high = blocks.min(axis=(1, 3)), blocks.max(axis=(1, 3))
    whole = shown[:rows, :columns].reshape(rows // scale, scale, columns // scale, scale)
    inner = whole.all(axis=(1, 3)) & np.all(high - low <= JUMP * tolerance, axis=2)
    if not inner.any():
        return samples
    mean = blocks.mean(axis=(1, 3), dtype=np.float32)
    change = _relaxed(mean, inner, np.float32(tolerance)) - mean
    moved = samples.copy()
    for channel in range(samples.shape[2]):
        fine = scipy.ndimage.zoom(
            change[..., channel], scale, order=1, mode="nearest", grid_mode=True
        )
        moved[:rows, :columns, channel] += np.where(shown[:rows, :columns], fine, np.float32(0))
    return moved


def _relaxed(mean: Array, inner: Bools, tolerance: np.float32) -> Array:
    """Return pixels after rounds of means, each within a tolerance of what it was."""
    links = []
    for axis in (0, 1):
        near, far = _ends(axis)
        step = np.abs(mean[near] - mean[far]).max(axis=2)
        joined = inner[near] & inner[far] & (step <= JUMP * tolerance)
        links.append((near, far, joined.astype(np.float32)[..., np.newaxis]))
    count = np.ones((*inner.shape, 1), dtype=np.float32)
    for near, far, joined in links:
        count[near] += joined
        count[far] += joined
    low, high, moved = mean - tolerance, mean + tolerance, mean
    for _ in range(ROUNDS):
        total = np.zeros_like(mean)
        for near, far, joined in links:
            flow = joined * (moved[far] - moved[near])
            total[near] += flow
            total[far] -= flow
        moved = np.clip(moved + total / count, low, high)
    return moved


def _ends(axis: int) -> tuple[tuple[Slice, ...], tuple[Slice, ...]]:
    """Return the index of the pixels before others along an axis, and that of the others."""
    whole = (slice(None),) * axis
    return (*whole, slice(None, -1)), (*whole, slice(1, None))


def slopes(samples: Array, scale: int) -> Array:
    """Return the largest change of a channel per pixel around each sample."""
    steep = np.zeros(samples.shape[:2], dtype=np.float32)
    for channel in range(samples.shape[2]):
        down, right = np.gradient(samples[..., channel])
        np.maximum(steep, np.hypot(down, right), out=steep)
    return scale * steep
