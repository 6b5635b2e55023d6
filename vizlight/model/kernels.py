"""Vector algebra and powers on component-first arrays.

A batch of vectors has shape ``(n, B)``, of frames ``(k, n, B)``, of numbers ``(B,)``; a batch of
one element broadcasts. The public functions of this package document and validate their arguments,
move the last axis to the front and call these functions; the engine calls them on blocks that fit
the cache. The component-first layout is fast in NumPy because every operation runs over contiguous
memory.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vizlight._types import Array, Bools, Indices

#: Above this exponent a power is computed from log1p of the deficit 1 - x, whose rounding error
#: grows more slowly than the exponent; below it multiplication is as accurate and faster.
DEFICIT_FROM = 64.0


def dot(a: Array, b: Array) -> Array:
    """Return the dot products of two batches of vectors."""
    result: Array = np.einsum("i...,i...->...", a, b)
    return result


def cross(a: Array, b: Array) -> Array:
    """Return the vector products of two batches of 3-vectors."""
    result = np.empty(np.broadcast_shapes(a.shape, b.shape), dtype=np.result_type(a, b))
    for i, row in enumerate(result):
        j, k = (i + 1) % 3, (i + 2) % 3
        np.multiply(a[j], b[k], out=row)
        row -= a[k] * b[j]
    return result


def length(v: Array) -> Array:
    """Return the lengths of vectors of any scale; NaN where a component is not finite."""
    return _length(v)[0]


def unit(v: Array) -> tuple[Array, Array]:
    """Return unit vectors and the lengths that the vectors had.

    A vector that is zero or not finite becomes the zero vector and its length is 0 or NaN, so
    ``length > 0`` is the mask of valid vectors.
    """
    size, extreme = _length(v)
    if extreme is None:
        return v / size, size
    result = np.empty(v.shape, dtype=v.dtype)
    np.divide(v, size, out=result, where=~extreme)
    # The squares of these leave the range of the type: they are scaled before they are taken.
    scaled, _, _ = _rescale(v[:, extreme])
    scaled_size = np.sqrt(dot(scaled, scaled))
    result[:, extreme] = scaled / np.where(scaled_size > 0, scaled_size, 1)
    return result, size


def unit_rows(vectors: ArrayLike) -> Array:
    """Return rows as unit vectors in float64; zero rows stay zero."""
    columns = np.ascontiguousarray(np.asarray(vectors, dtype=np.float64).T)
    return unit(columns)[0].T


def length_rows(vectors: ArrayLike) -> Array:
    """Return the lengths of rows in float64; NaN where a component is not finite."""
    return length(np.ascontiguousarray(np.asarray(vectors, dtype=np.float64).T))


def _length(v: Array) -> tuple[Array, Bools | None]:
    """Return lengths, and a mask of the vectors with squares out of the range of the type."""
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        square = dot(v, v)
    info = np.finfo(v.dtype)
    # Below tiny / eps the squares of small components are subnormal, and the sum has lost digits.
    low, high = info.tiny / info.eps, info.max
    if square.size == 0 or (square.min() >= low and square.max() <= high):
        return np.sqrt(square, out=square), None
    extreme = ~((square >= low) & (square <= high))
    result: Array = np.sqrt(np.where(extreme, 1, square))
    scaled, exponent, finite = _rescale(v[:, extreme])
    with np.errstate(over="ignore", under="ignore"):
        rest = np.ldexp(np.sqrt(dot(scaled, scaled)), exponent)
    result[extreme] = np.where(finite, rest, np.nan)
    return result, extreme


def _rescale(v: Array) -> tuple[Array, NDArray[np.intc], Bools]:
    """Scale each vector by an exact power of two so that its largest component is in [1/2, 1)."""
    largest = np.abs(v).max(axis=0)
    finite = np.isfinite(largest)
    # A power of two changes no digit, so that scaling adds no error.
    _, exponent = np.frexp(np.where(finite, largest, 1))
    with np.errstate(under="ignore"):
        scaled = np.ldexp(np.where(finite, v, 0), -exponent)
    return scaled, exponent, finite


def orthonormalize(v: Array, rtol: float) -> tuple[Array, Indices]:
    """Return orthonormal rows that span the input, and their number.

    Gram-Schmidt on unit vectors, each projected twice. A vector whose distance from the span of the
    vectors before it is at most ``rtol`` of its length is dropped. Rows past the rank are 0.
    """
    k = v.shape[0]
    # A single vector has nothing to be projected on.
    if k == 1:
        row, size = unit(v[0])
        return row[np.newaxis], (size > 0).astype(np.intp)
    frame = np.zeros_like(v)
    rank = np.zeros(v.shape[2], dtype=np.intp)
    for j in range(k):
        row, size = unit(v[j])
        good = size > 0
        if j:
            row = _reject(row, frame[:j])
            # The first projection tells how far the vector is from the span; the second removes the
            # rounding left.
            row, distance = unit(row)
            good &= distance > rtol
            row = _reject(row, frame[:j])
            row, _ = unit(row)
        # Mostly no vector has been dropped, and whole rows are written without a mask.
        if good.all() and (rank == j).all():
            frame[j] = row
        else:
            # A dropped vector leaves no gap: those after it take the next free row of their point.
            frame[rank[good], :, good] = row[:, good].T
        rank += good
    return frame, rank


def _reject(x: Array, frame: Array) -> Array:
    """Return the part of x that is orthogonal to the frame, removing one row after the other."""
    for row in frame:
        x = x - dot(row, x) * row
    return x


def split(x: Array, frame: Array) -> tuple[Array, Array]:
    """Return the tangential coefficients ``(k, B)`` and the length of the normal part.

    The length comes from the residual, because sqrt(1 - cos^2) would lose half the digits.
    """
    along = np.stack([dot(row, x) for row in frame])
    # All coefficients are of x itself, so that none depends on the order of the rows.
    residual = x - along[0] * frame[0]
    for c, row in zip(along[1:], frame[1:], strict=True):
        residual -= c * row
    return along, length(residual)


def power(x: Array, exponent: float, deficit: Array | None = None) -> Array:
    """Return x to a power for x in [0, 1], with 0^0 = 1; ``deficit`` is 1 - x where it is known.

    Integer powers up to 64 use multiplication; exponents above 64 use the deficit if it is given.
    """
    if exponent > DEFICIT_FROM and deficit is not None:
        with np.errstate(divide="ignore", under="ignore", over="ignore"):
            # By rounding a deficit may exceed 1, where the logarithm has no value.
            result: Array = np.log1p(-np.minimum(deficit, 1))
            result *= exponent
            return np.exp(result, out=result)
    with np.errstate(under="ignore"):
        if exponent != int(exponent) or exponent > DEFICIT_FROM:
            return np.power(x, x.dtype.type(exponent))
        return _integer_power(x, int(exponent))


def _integer_power(x: Array, exponent: int) -> Array:
    if exponent == 0:
        return np.ones_like(x)
    # By squaring: as many rounds as the exponent has bits.
    result = None
    while exponent > 1:
        if exponent & 1:
            result = x if result is None else result * x
        exponent >>= 1
        x = x * x
    return x if result is None else result * x
