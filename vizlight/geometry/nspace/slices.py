"""Cutting a k-manifold made of simplices by a hyperplane: what is left is a (k - 1)-manifold."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import csr_array

from vizlight import _check
from vizlight.model.frames import default_rtol, orthonormalize

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vizlight._types import Array

__all__ = ["cut", "mean_frame", "slice_frame"]

_EDGES = {
    2: ((0, 1),),
    3: ((0, 1), (1, 2), (2, 0)),
    4: ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)),
}


def _cases(corners: int) -> dict[int, tuple[tuple[int, ...], ...]]:
    """Return for each pattern of corners above 0 the simplices of the cut, as edges."""
    edges = _EDGES[corners]
    cases: dict[int, tuple[tuple[int, ...], ...]] = {}
    for pattern in range(1, 2**corners - 1):
        cut = [i for i, (a, b) in enumerate(edges) if (pattern >> a & 1) != (pattern >> b & 1)]
        if len(cut) < 4:
            cases[pattern] = (tuple(cut),)
            continue
        # Four edges of a tetrahedron in a ring: neighbours share a corner.
        a, b, c, d = cut
        far = next(e for e in (b, c, d) if not set(edges[a]) & set(edges[e]))
        near = [e for e in (b, c, d) if e != far]
        cases[pattern] = ((a, near[0], far), (a, far, near[1]))
    return cases


def cut(values: ArrayLike, simplices: ArrayLike, /) -> tuple[Any, Any, Any]:
    """Return where a function, linear on each simplex, is zero.

    Parameters
    ----------
    values : array_like, shape (N,)
        Of the function at the points.
    simplices : array_like of int, shape (M, k + 1)
        Segments, triangles or tetrahedra, k = 1, 2, 3.

    Returns
    -------
    edges : ndarray of int, shape (E, 2)
        The two points that each point of the cut lies between; the same one twice where the
        function is 0 at it.
    weights : ndarray, shape (E,)
        How far it is from the first of them to the second, from 0 to 1.
    cells : ndarray of int, shape (C, k)
        Points, segments or triangles of the cut, each once.

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit or an index is out of range.

    Notes
    -----
    Neighbours share the points of the cut, whatever their coordinates. A simplex that lies in
    the hyperplane as a whole is no part of the cut; one with a value that is not finite neither.
    """
    height = _check.floats("values", values).astype(np.float64)
    corners = np.asarray(simplices)
    if corners.ndim != 2 or corners.shape[1] not in _EDGES or corners.dtype.kind not in "iu":
        expected = "integers of shape (M, 2), (M, 3) or (M, 4)"
        raise ValueError(_check.message("simplices", expected, _check.describe(corners)))
    if height.ndim != 1 or (corners.size and not 0 <= corners.min() <= corners.max() < len(height)):
        expected = f"numbers of points, from 0 to {len(height) - 1}"
        raise ValueError(_check.message("simplices", expected, _check.describe(corners)))
    size = corners.shape[1]
    corners = corners[np.all(np.isfinite(height[corners]), axis=1)]
    above = height[corners] >= 0
    pattern = above @ (1 << np.arange(size))
    found = []
    for case, parts in _cases(size).items():
        rows = corners[pattern == case]
        for part in parts:
            pairs = rows[:, np.array([_EDGES[size][edge] for edge in part])]
            found.append(np.sort(pairs, axis=2))
    pairs = np.concatenate(found) if found else np.empty((0, size - 1, 2), np.intp)
    # A corner at 0 is one point of the cut, from whichever edge it is reached.
    for end in (0, 1):
        at = height[pairs[..., end]] == 0
        pairs[at, 1 - end] = pairs[at, end]
    edges, number = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    cells = np.asarray(number, dtype=np.intp).reshape(-1, size - 1)
    ordered = np.sort(cells, axis=1)
    whole = np.all(ordered[:, 1:] != ordered[:, :-1], axis=1)
    _, first = np.unique(ordered[whole], axis=0, return_index=True)
    cells = cells[whole][np.sort(first)]
    used, cells_of = np.unique(cells, return_inverse=True)
    edges = edges[used]
    low, high = height[edges[:, 0]], height[edges[:, 1]]
    same = edges[:, 0] == edges[:, 1]
    # Halves, so that the difference of the largest numbers is one.
    weights = np.where(same, 0.0, (low / 2) / np.where(same, 1.0, low / 2 - high / 2))
    return edges, weights, np.asarray(cells_of, dtype=np.intp).reshape(cells.shape)


def mean_frame(frame: ArrayLike, shares: Any, /) -> Any:
    """Return tangent frames between points, each a mean of the spaces at some of them.

    A frame stands for the space that it spans, whatever basis it is: neighbours may differ by
    any rotation or change of sign, so numbers cannot be mixed as they are. Each frame is turned
    within its own space until it is nearest to that of the largest share, and mixed then.

    Parameters
    ----------
    frame : array_like, shape (N, k, n)
        Tangents at the points; orthonormalised here.
    shares : sparse array, shape (M, N)
        What each point has in each mean: 0 or more, in sum 1.

    Returns
    -------
    ndarray, shape (M, k, n)
        Orthonormal rows; zero where a point that has a share lacks tangents, or two of the
        spaces have directions at right angles, which have no mean.

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit.

    Notes
    -----
    The turn is the orthogonal factor ``U V^T`` of the matrix ``F G^T = U S V^T`` of two frames
    (orthogonal Procrustes). Of orthonormal tangents, whatever their bases, what is spanned is
    known to 2 eps over the cosine of the largest angle between the spaces. Between two points of
    a smooth manifold the mean is off by the square of their distance.
    """
    rows, _ = orthonormalize(frame)
    if rows.ndim != 3:
        raise ValueError(_check.message("frame", "shape (N, k, n)", f"shape {rows.shape}"))
    count, k, n = rows.shape
    parts = shares.tocsr()
    if parts.shape[1] != count:
        expected = f"a matrix of {count} columns, one a point"
        raise ValueError(_check.message("shares", expected, f"shape {parts.shape}"))
    owner = np.repeat(np.arange(parts.shape[0]), np.diff(parts.indptr))
    # The last of each owner's entries, ordered by share, is that of its largest.
    order = np.lexsort((parts.data, owner))
    largest = np.zeros(parts.shape[0], dtype=np.intp)
    largest[owner[order]] = parts.indices[order]
    base = rows[largest[owner]]
    other = rows[parts.indices]
    left, cosines, right = np.linalg.svd(base @ other.swapaxes(1, 2))
    turned = (left @ right @ other).reshape(len(owner), k * n)
    mixing = csr_array(
        (parts.data, np.arange(len(owner)), parts.indptr), (len(largest), len(owner))
    )
    found: Array = orthonormalize((mixing @ turned).reshape(-1, k, n))[0]
    # A frame with rows of zero has such a cosine with any frame.
    found[owner[cosines.min(axis=1) <= default_rtol(n, rows.dtype)]] = 0
    return found


def slice_frame(frame: ArrayLike, normal: ArrayLike, /, *, rtol: float | None = None) -> Any:
    """Return the tangent frame of a manifold's cut by a hyperplane.

    Parameters
    ----------
    frame : array_like, shape (..., k, n)
        Tangents of the manifold, k of 2 or more; orthonormalised here.
    normal : array_like, shape (n,)
        Of the hyperplane, any length but 0.
    rtol : float, optional
        The sine of the angle between manifold and hyperplane below which they touch. Default:
        ``8 sqrt(n) eps``.

    Returns
    -------
    ndarray, shape (..., k - 1, n)
        Orthonormal rows, tangent to the manifold and to the hyperplane; zero where the manifold
        touches the hyperplane, or its own frame has rows of zero.

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit.

    Notes
    -----
    With a the normal's coefficients on the frame, a reflection of the frame takes its first row
    to a; the others are what is wanted. ``|F F^T - 1| <= 8 eps``; of orthonormal tangents what
    they span is known to 2 eps over the sine of the angle between manifold and hyperplane.
    """
    rows, rank = orthonormalize(frame)
    k, n = rows.shape[-2:]
    if k < 2:
        raise ValueError(_check.message("frame", "2 tangents or more", k))
    across = np.array(_check.vector("normal", normal, direction=True))
    if len(across) != n:
        raise ValueError(_check.message("normal", f"{n} components", len(across)))
    across /= np.abs(across).max()
    a = rows @ (across / np.linalg.norm(across))
    size = np.linalg.norm(a, axis=-1)
    rtol = default_rtol(n, rows.dtype) if rtol is None else _check.number("rtol", rtol, low=0.0)
    good = (size > rtol) & (rank == k)
    mirror = a / np.where(good, size, 1)[..., np.newaxis]
    mirror[..., 0] += np.where(mirror[..., 0] < 0, -1, 1)
    square = np.sum(mirror**2, axis=-1)
    along = np.einsum("...k,...kn->...n", mirror, rows)
    factor = 2 * mirror[..., 1:] / np.where(good, square, 1)[..., np.newaxis]
    result = rows[..., 1:, :] - factor[..., np.newaxis] * along[..., np.newaxis, :]
    result[~good] = 0
    return result
