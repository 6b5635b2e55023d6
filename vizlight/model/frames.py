"""Tangent spaces in n-space: orthonormal frames, and the two parts of a direction."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.model import kernels, layout

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vizlight._types import Array, Indices


__all__ = ["orthonormalize", "split"]


def default_rtol(n: int, dtype: np.dtype[np.floating]) -> float:
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
    array = layout.as_rows("vectors", vectors, full=True)
    k, n = array.shape[-2:]
    if rtol is None:
        rtol = default_rtol(n, array.dtype)
    rtol = _check.number("rtol", rtol, low=0.0)
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
    rows = layout.as_frame(frame)
    x = _check.vectors("direction", direction, n=rows.shape[-1])
    shape, rows, (x,) = layout.batch("frame", rows, direction=x)
    x = np.where(np.isfinite(x).all(axis=0), x, np.nan)
    along, normal = kernels.split(x, rows)
    return np.ascontiguousarray(along.T).reshape(*shape, len(along)), normal.reshape(shape)
