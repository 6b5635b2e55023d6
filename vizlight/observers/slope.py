"""How steeply lines run toward the eye, and which end of them is near."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vizlight.model.kernels import unit_rows
from vizlight.observers.colors import posterior, seen, shown
from vizlight.observers.direction import ANGLES, BLOCK

if TYPE_CHECKING:
    from vizlight._types import Array
    from vizlight.observers.samples import Sample

#: Number of classes of steepness, and largest number of classes of lightness, between which
#: information is counted; and of the places for each of the latter. With 128 places in 32 classes
#: noise alone would tell 1.8 bits.
STEEP, LIGHT, EACH = 16, 32, 128


def steepness(sample: Sample) -> Array:
    """Return the cosine, 0 or more, of the angle between tangents and the line of sight."""
    assert sample.tangents is not None
    return np.asarray(np.abs(np.einsum("ij,ij->i", sample.tangents[:, 0], sample.eye)))


def rank_correlation(a: Array, b: Array) -> float:
    """Return Spearman's rank correlation; 0 where one of the two is constant."""
    if np.ptp(a) == 0 or np.ptp(b) == 0:
        return 0.0
    return float(np.corrcoef(_ranks(a), _ranks(b))[0, 1])


def _ranks(values: Array) -> Array:
    """Return ranks; equal values have their mean."""
    _, which, count = np.unique(values, return_inverse=True, return_counts=True)
    mean = np.cumsum(count) - (count - 1) / 2
    return np.asarray(mean[which.ravel()])


def mutual_information(steep: Array, light: Array) -> float:
    """Return the bits that lightness tells of steepness, both in classes of equal count.

    Fewer than 4096 places tell less than there is: of n, classes of lightness are ``n / 128``. The
    bias of a sample of n is taken off: ``(joint - rows - columns + 1) / (2 n ln 2)``, of the
    numbers of classes that occur (Miller 1955).
    """
    rows, columns = (
        np.searchsorted(np.unique(np.quantile(x, np.linspace(0, 1, k + 1)[1:-1])), x)
        for x, k in ((steep, STEEP), (light, min(LIGHT, max(2, len(light) // EACH))))
    )
    joint = np.bincount(rows * LIGHT + columns, minlength=STEEP * LIGHT)
    share = joint.reshape(STEEP, LIGHT) / len(steep)
    alone = share.sum(axis=1, keepdims=True) * share.sum(axis=0, keepdims=True)
    there = share > 0
    bits = float((share[there] * np.log2(share[there] / alone[there])).sum())
    classes = int(there.sum()) - int(there.any(axis=1).sum()) - int(there.any(axis=0).sum()) + 1
    return max(0.0, bits - classes / (2 * len(steep) * math.log(2)))


def in_space(sample: Sample, random: np.random.Generator, noise: float) -> Array:
    """Return the errors of an observer who knows the course of lines in the picture.

    Parameters
    ----------
    sample : Sample
        Places with one tangent each.
    random : numpy.random.Generator
    noise : float
        Standard deviation of each channel.

    Returns
    -------
    ndarray
        Angle in degrees, from 0 to 90, between the tangent and the likeliest of 180 directions
        with the same course; of tangents that are not along the line of sight.
    """
    errors = [np.empty(0)]
    for start in range(0, len(sample), BLOCK):
        own = sample.take(slice(start, start + BLOCK))
        assert own.tangents is not None
        tangent = own.tangents[:, 0]
        toward = np.einsum("ij,ij->i", tangent, own.eye)
        own = own.take(np.abs(toward) < 1 - 1e-9)
        m = len(own)
        assert own.tangents is not None
        tangent = own.tangents[:, 0]
        along = np.einsum("ij,ij->i", tangent, own.eye)[:, np.newaxis] * own.eye
        course = unit_rows(tangent - along)
        offset = random.uniform(0.0, 1.0, m)
        turn = np.radians(np.arange(ANGLES) - 90 + offset[:, np.newaxis])[..., np.newaxis]
        every = np.cos(turn) * course[:, np.newaxis] + np.sin(turn) * own.eye[:, np.newaxis]
        repeated = None if own.normals is None else np.repeat(own.normals, ANGLES, axis=0)
        table = shown(own.light(every.reshape(-1, 1, 3), repeated, ANGLES))
        observed = seen(own.own_light(), random, noise)
        likely = posterior(observed, table.reshape(m, ANGLES, 3), noise)
        best = every[np.arange(m), likely.argmax(axis=1)]
        cosine = np.abs(np.einsum("ij,ij->i", best, tangent))
        errors.append(np.degrees(np.arccos(np.minimum(cosine, 1.0))))
    return np.concatenate(errors)
