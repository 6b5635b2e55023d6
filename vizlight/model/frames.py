"""Tangent spaces in n-space: orthonormal frames, and the two parts of a direction."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array, FloatType, Indices
from vizlight.model import kernels

__all__ = ["orthonormalize", "split"]


def default_rtol(n: int, dtype: FloatType) -> float:
    """Return the relative distance from a span below which a vector counts as inside it."""
    return float(8 * np.sqrt(n) * np.finfo(dtype).eps)


def orthonormalize(vectors: ArrayLike, /, *, rtol: float | None = None) -> tuple[Array, Indices]:
    """Return an orthonormal frame of the space that k vectors span, and its rank.

    The rows keep their order: row 0 is along the first vector that is not dropped, and so on. A
    vector is dropped when it is zero, not finite, or no further from the span of the vectors before
    it than ``rtol`` times its own length. Rows 0 to rank - 1 of the frame are orthonormal and the
    rows from rank on are zero, so projections on the frame are right for every rank.

    Parameters
    ----------
    vectors : array_like, shape (..., k, n)
        k vectors per point, k <= n, of any scale (lengths from the smallest to the largest number
        of the type).
    rtol : float, optional
        Relative distance from the span, unitless. Default: ``8 sqrt(n) eps``.

    Returns
    -------
    frame : ndarray, shape (..., k, n)
    rank : ndarray of int, shape (...)

    Raises
    ------
    TypeError
        If the vectors are not real numbers.
    ValueError
        If the shape is not (..., k, n) with k <= n, or rtol is negative.

    Notes
    -----
    Gram-Schmidt in which every projection is made twice. ``|F F^T - 1| <= 6 eps`` for n up to 8,
    also for float64 vectors that are 1e-8 apart; the space that such vectors span is known to eps
    divided by the angle between them.

    Examples
    --------
    >>> from vizlight.model import frames
    >>> frame, rank = frames.orthonormalize([[3.0, 0.0, 0.0], [1.0, 1e-200, 0.0]])
    >>> int(rank)
    1
    """
    array = as_rows("vectors", vectors, full=True)
    k, n = array.shape[-2:]
    if rtol is None:
        rtol = default_rtol(n, array.dtype)
    rtol = _check.number("rtol", rtol, low=0.0)
    # Points last, as the kernels have them.
    rows = np.ascontiguousarray(array.reshape(-1, k, n).transpose(1, 2, 0))
    frame, rank = kernels.orthonormalize(rows, rtol)
    shape = array.shape[:-2]
    return (
        np.ascontiguousarray(frame.transpose(2, 0, 1)).reshape(*shape, k, n),
        rank.reshape(shape),
    )


def split(direction: ArrayLike, frame: ArrayLike, /) -> tuple[Array, Array]:
    """Split a direction x into its part in the tangent space and the length of the normal part.

    Parameters
    ----------
    direction : array_like, shape (..., n)
        Vectors x, not necessarily of unit length.
    frame : array_like, shape (..., k, n)
        Frames of orthonormal rows (rows past the rank are zero), k < n.

    Returns
    -------
    coefficients : ndarray, shape (..., k)
        ``x . t_j`` for every row t_j.
    normal : ndarray, shape (...)
        ``|x_N|``, the length of ``x - sum_j (x . t_j) t_j``, which is sin(a) for a unit x. Both
        results are NaN where x is not finite.

    Raises
    ------
    TypeError
        If an argument does not hold real numbers.
    ValueError
        If the shapes do not broadcast or the rows are not orthonormal.

    Notes
    -----
    Absolute error at most ``10 eps |x|`` (k up to 7, n up to 8), which includes the error of rows
    that are orthonormal up to rounding, and also holds where x lies along the tangent: ``|x_N|`` is
    the length of the residual, not ``sqrt(1 - cos^2)``.
    Source: Banks, section 2 (parts in T and N).
    """
    rows = as_frame(frame)
    x = _check.vectors("direction", direction, n=rows.shape[-1])
    shape, rows, (x,) = batch("frame", rows, direction=x)
    # Otherwise an infinite component would give infinite coefficients beside a length of NaN.
    x = np.where(np.isfinite(x).all(axis=0), x, np.nan)
    along, normal = kernels.split(x, rows)
    return np.ascontiguousarray(along.T).reshape(*shape, len(along)), normal.reshape(shape)


#: Frames whose rows deviate from orthonormality by more than this many sqrt(eps) are rejected.
SLACK = 16.0


def batch(
    name: str, frame: Array, **directions: Array
) -> tuple[tuple[int, ...], Array, list[Array]]:
    """Return the broadcast shape, and a frame and directions as component-first arrays.

    Messages call the frame by ``name``.
    """
    k, n = frame.shape[-2:]
    kind = np.result_type(frame, *directions.values())
    shapes = {key: d.shape[:-1] for key, d in directions.items()}
    shape = _check.broadcast_shape(**{name: frame.shape[:-2]}, **shapes)
    rows = np.broadcast_to(frame, (*shape, k, n)).reshape(-1, k, n).transpose(1, 2, 0)
    columns = [np.broadcast_to(d, (*shape, n)).reshape(-1, n).T for d in directions.values()]
    return (
        shape,
        np.ascontiguousarray(rows, dtype=kind),
        [np.ascontiguousarray(c, dtype=kind) for c in columns],
    )


def as_rows(name: str, value: ArrayLike, *, full: bool) -> Array:
    """Validate k rows of n components, shape (..., k, n), where k < n, or k <= n if ``full``."""
    array = _check.vectors(name, value)
    k, n = array.shape[-2:] if array.ndim > 1 else (0, array.shape[-1])
    if not 0 < k < n + full:
        expected = f"0 < k {'<=' if full else '<'} n rows of n components, shape (..., k, n)"
        remedy = "for one vector per point pass v[..., None, :]"
        raise _check.value_error(name, expected, f"shape {array.shape}", remedy)
    return array


def as_frame(frame: ArrayLike) -> Array:
    """Validate a tangent frame of shape (..., k, n): k < n, and each row orthonormal or zero."""
    array = as_rows("frame", frame, full=False)
    k = array.shape[-2]
    with np.errstate(over="ignore", invalid="ignore"):
        gram = array @ np.swapaxes(array, -1, -2)
    diagonal = np.diagonal(gram, axis1=-2, axis2=-1)
    # Rows past the rank are zero: their diagonal is 0, not 1.
    off = np.abs(gram - np.eye(k) * np.where(diagonal == 0, 0, 1)[..., np.newaxis])
    worst = float(off.max()) if off.size else 0.0
    # Negated, since a row that is not finite gives NaN, for which no comparison holds.
    if not worst <= SLACK * float(np.sqrt(np.finfo(array.dtype).eps)):
        remedy = "call vizlight.model.frames.orthonormalize first"
        raise _check.value_error("frame", "orthonormal rows", f"rows off by {worst:.2g}", remedy)
    return array


def result(value: Array) -> Array:
    """Return an array unchanged, and a 0-dimensional array as a NumPy scalar."""
    return value[()]
