"""Few colours for many samples, of which one is near to each."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from vizlight._types import Array, Bools, Indices

#: Share of the samples above which one exact colour is its own face.
FLAT = 2e-3
#: Most colours of this kind, and the step by which samples are looked through for them.
MOST_FLAT, FEWER = 24, 37
#: Least number of samples of one exact colour among those that are looked through.
LEAST = 20
#: Difference of channels that is rounding.
ROUNDED = 0.1
#: Rounds in which specks join the face beside them.
ROUNDS = 4
#: Neighbours of a sample, and the number of those of its colour below which it is a speck.
AROUND = [(down, right) for down in (-1, 0, 1) for right in (-1, 0, 1) if down or right]
FEW = 4
#: Difference up to which the rim of surfaces has the color beside it.
RIM = 96.0
#: Difference of neighbouring samples, in errors, above which they are of two surfaces.
JUMP = 4.0


class Palette(NamedTuple):
    """Colours of faces.

    The bisectors of the ``centres`` (K, c), the background's first, are the borders of faces, which
    are painted in ``colors``, the middle of the samples of each; ``labels`` has the number of the
    colour of each sample, and ``error`` is the largest difference of a channel from it.
    """

    centres: Array
    colors: Array
    labels: NDArray[np.int32]
    error: float


def palette_of(
    samples: Array, background: Array, error: float, scale: int, shown: Bools | None = None
) -> Palette:
    """Return a few colours such that each sample is near one of them.

    ``error`` is the largest difference of a channel, in the unit of the samples; ``shown`` masks
    the samples that are not background, by default those that differ from it. Colours are from dark
    to light; equal samples keep their colour exactly.
    """
    rows, columns, channels = samples.shape
    flat = samples.reshape(-1, channels)
    if shown is None:
        shown = np.any(samples != background.astype(flat.dtype), axis=2)
    where = np.flatnonzero(shown)
    foreground = flat[where].astype(np.float32)
    labels = np.zeros(rows * columns, dtype=np.int32)
    if not len(where):
        return Palette(background[np.newaxis], background[np.newaxis], labels.reshape(rows, -1), 0)
    centres, number = nearest_colors(foreground, error)
    # From dark to light, and none that no sample has.
    count = np.bincount(number, minlength=len(centres))
    order = np.argsort(centres.sum(axis=1), kind="stable")
    order = order[count[order] > 0]
    rank = np.zeros(len(centres), dtype=np.int32)
    rank[order] = np.arange(1, len(order) + 1)
    labels[where] = rank[number]
    numbers = np.arange(1, len(order) + 1)
    limits = [scipy.ndimage.extrema(x, labels[where], numbers)[:2] for x in foreground.T]
    low, high = np.moveaxis(np.array(limits, np.float64), 0, -1)
    colors = np.concatenate([background[np.newaxis], (low + high) / 2])
    largest_error = float(np.max(high - low) / 2)
    kept = np.concatenate([background[np.newaxis], centres[order]])
    _trim(labels.reshape(rows, columns), samples, kept, scale)
    _settle(labels.reshape(rows, columns), samples, kept, error)
    return Palette(kept, colors, labels.reshape(rows, columns), largest_error)


def nearest_colors(samples: Array, error: float) -> tuple[Array, Indices]:
    """Return colours such that each sample is near one of them, and the index of that colour.

    ``error`` is the largest difference of a channel.
    """
    some, count = np.unique(samples[::FEWER], axis=0, return_counts=True)
    common = np.argsort(-count, kind="stable")[:MOST_FLAT]
    common = common[count[common] > max(FLAT * count.sum(), LEAST)]
    number = np.full(len(samples), -1)
    flat = np.zeros((0, samples.shape[1]))
    # A large part of one colour, but for rounding, keeps it.
    for color in some[common]:
        if not np.any(np.all(np.abs(flat - color) < 2 * ROUNDED, axis=1)):
            number[np.all(np.abs(samples - color) < ROUNDED, axis=1)] = len(flat)
            flat = np.concatenate([flat, color[np.newaxis]])
    rest = np.flatnonzero(number < 0)
    if not len(rest):
        return flat, number
    centres, nearest = _even(samples[rest], error)
    number[rest] = len(flat) + nearest
    return np.concatenate([flat, centres]), number


def _settle(labels: NDArray[np.int32], samples: Array, centres: Array, error: float) -> None:
    """Give samples that touch few others of their own colour the nearest colour beside them.

    Where colours change within a pixel, faces would be specks that nobody sees. A corner of a face
    stays if its colour differs clearly from those around it.
    """
    limit = JUMP * error
    for _ in range(ROUNDS):
        padded = np.pad(labels, 1, constant_values=-1)
        rows, columns = labels.shape
        alike = np.zeros(labels.shape, dtype=np.int8)
        for down, right in AROUND:
            alike += padded[1 + down : 1 + down + rows, 1 + right : 1 + right + columns] == labels
        row, column = np.nonzero((alike < FEW) & (labels > 0))
        if not len(row):
            return
        few = np.where(alike[row, column] < 2, np.inf, limit)
        _join(labels, samples, centres, (row, column), (alike >= FEW) & (labels > 0), few)


def _join(labels: NDArray[np.int32], samples: Array, centres: Array, at: tuple[Indices, Indices],
          firm: Bools, limit: Array | float) -> tuple[Indices, Indices]:  # fmt: skip
    """Give samples the nearest color of firm ones beside them; return those within a limit."""
    row, column = at
    padded, sure = np.pad(labels, 1, constant_values=-1), np.pad(firm, 1)
    color = samples[row, column]
    best, nearest = np.zeros(len(row), dtype=np.int32), np.full(len(row), np.inf)
    for down, right in AROUND:
        beside = row + 1 + down, column + 1 + right
        other = padded[beside]
        away = np.abs(centres[other] - color).max(axis=1)
        better = sure[beside] & (away < nearest)
        best[better], nearest[better] = other[better], away[better]
    taken = nearest < limit
    row, column = row[taken], column[taken]
    labels[row, column] = best[taken]
    return row, column


def _trim(labels: NDArray[np.int32], samples: Array, centres: Array, scale: int) -> None:
    """Let colors at the rim of surfaces be those a pixel within.

    Light falls off within a pixel, which is a mixture with what is beside it.
    """
    shown = labels > 0
    firm = scipy.ndimage.binary_erosion(shown, iterations=max(scale - 1, 1), border_value=1)
    for _ in range(scale + 1):
        near = scipy.ndimage.binary_dilation(firm, np.ones((3, 3), dtype=np.bool_)) & shown & ~firm
        row, column = np.nonzero(near)
        firm[_join(labels, samples, centres, (row, column), firm, RIM)] = True


def _even(samples: Array, error: float) -> tuple[Array, Indices]:
    """Return colours of about even levels of channels, and the one nearest to each sample."""
    channels = [_levels(values, error) for values in samples.T.astype(np.float64)]
    levels, numbers = zip(*channels, strict=True)
    shape = [len(each) for each in levels]
    codes, number = np.unique(np.ravel_multi_index(numbers, shape), return_inverse=True)
    places = np.unravel_index(codes, shape)
    return np.stack([x[at] for x, at in zip(levels, places, strict=True)], axis=1), number


def _levels(values: Array, error: float) -> tuple[Array, Indices]:
    """Return levels of which one is near each value, and the number of that level.

    Each begins at the first value above the one before, so that values that are nearly equal have
    one level.
    """
    unique = np.unique(values)
    span = unique[-1] - unique[0]
    width = (1 + 1e-9) * span / max(np.ceil(span / (2 * error)), 1)
    starts = [0]
    while (end := int(np.searchsorted(unique, unique[starts[-1]] + width, "right"))) < len(unique):
        starts.append(end)
    lasts = np.array([*starts[1:], len(unique)]) - 1
    return (unique[starts] + unique[lasts]) / 2, np.searchsorted(
        unique[starts], values, "right"
    ) - 1
