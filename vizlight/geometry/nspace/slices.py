"""Sections of a k-manifold of simplices by a hyperplane, which are (k - 1)-manifolds."""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import AnyArray, Array, Foreign, Indices
from vizlight.model import frames
from vizlight.model.frames import default_rtol, orthonormalize

__all__ = ["cut", "mean_frame", "slice_frame"]

_EDGES = {
    2: ((0, 1),),
    3: ((0, 1), (1, 2), (2, 0)),
    4: ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)),
}


def _cases(corners: int) -> dict[int, tuple[tuple[int, ...], ...]]:
    """Return for each pattern of non-negative corners the simplices of the cut, as edges."""
    edges = _EDGES[corners]
    cases: dict[int, tuple[tuple[int, ...], ...]] = {}
    # All patterns but the two without a cut: every corner above, or every corner below.
    for pattern in range(1, 2**corners - 1):
        # Bit i of a pattern is corner i, and an edge is cut where its corners differ.
        cut = [i for i, (a, b) in enumerate(edges) if (pattern >> a & 1) != (pattern >> b & 1)]
        if len(cut) < 4:
            cases[pattern] = (tuple(cut),)
            continue
        # Four edges of a tetrahedron form a ring in which neighbours share a corner.
        a, b, c, d = cut
        far = next(e for e in (b, c, d) if not set(edges[a]) & set(edges[e]))
        near = [e for e in (b, c, d) if e != far]
        # A quadrilateral of four cut edges, as two triangles.
        cases[pattern] = ((a, near[0], far), (a, far, near[1]))
    return cases


def cut(values: ArrayLike, simplices: ArrayLike, /) -> tuple[Indices, Array, AnyArray]:
    """Return the zero set of a function that is linear on each simplex.

    Parameters
    ----------
    values : array_like, shape (N,)
        Values of the function at the points.
    simplices : array_like of int, shape (M, k + 1)
        Indices of the corners of segments, triangles or tetrahedra, k = 1, 2, 3.

    Returns
    -------
    edges : ndarray of int, shape (E, 2)
        Indices of the two points between which each point of the cut lies; both are equal where the
        function is 0 at a point.
    weights : ndarray, shape (E,)
        Position between these two, from 0 at the first to 1 at the second.
    cells : ndarray of int, shape (C, k)
        Points, segments or triangles of the cut, each once.

    Raises
    ------
    TypeError, ValueError
        If a shape is wrong or an index is out of range.

    Notes
    -----
    Neighbouring simplices share the points of the cut whatever the coordinates are. A simplex that
    lies entirely in the hyperplane is not part of the cut, nor is one with a value that is not
    finite.
    """
    height = _check.floats("values", values).astype(np.float64)
    if height.ndim != 1:
        raise _check.value_error("values", "shape (N,)", height)
    corners = _check.cells("simplices", simplices, len(height), list(_EDGES), of="values")
    size = corners.shape[1]
    corners = corners[np.all(np.isfinite(height[corners]), axis=1)]
    # 0 counts as above, everywhere alike: neighbours then agree on the points of the cut.
    above = height[corners] >= 0
    pattern = above @ (1 << np.arange(size))
    edge_pairs = []
    for case, parts in _cases(size).items():
        rows = corners[pattern == case]
        for part in parts:
            # Corners of an edge in rising order: neighbours find the same point by the same pair.
            pairs = rows[:, np.array([_EDGES[size][edge] for edge in part])]
            edge_pairs.append(np.sort(pairs, axis=2))
    pairs = np.concatenate(edge_pairs)
    # A corner at 0 is a single point of the cut for all edges that meet there.
    for end in (0, 1):
        at = height[pairs[..., end]] == 0
        pairs[at, 1 - end] = pairs[at, end]
    edges, number = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    cells = np.asarray(number, dtype=np.intp).reshape(-1, size - 1)
    ordered = np.sort(cells, axis=1)
    # Where the cut passes through a corner, cells shrink to fewer points and are left out.
    whole = np.all(ordered[:, 1:] != ordered[:, :-1], axis=1)
    # A face in the hyperplane is a cell of both its simplices where both are below: it is kept
    # once.
    _, first = np.unique(ordered[whole], axis=0, return_index=True)
    cells = cells[whole][np.sort(first)]
    used, cells_of = np.unique(cells, return_inverse=True)
    edges = edges[used]
    low, high = height[edges[:, 0]], height[edges[:, 1]]
    same = edges[:, 0] == edges[:, 1]
    # Halved, so that the difference of very large numbers does not overflow.
    weights = np.where(same, 0.0, (low / 2) / np.where(same, 1.0, low / 2 - high / 2))
    return edges, weights, np.asarray(cells_of, dtype=np.intp).reshape(cells.shape)


def mean_frame(frame: ArrayLike, shares: Foreign, /) -> Array:
    """Return tangent frames at new points as weighted means of the tangent spaces at given points.

    A frame represents the space that it spans, and any basis of that space is equivalent:
    neighbouring frames may differ by a rotation or a change of sign, so their numbers cannot be
    averaged directly. Each frame is first rotated within its own space until it is nearest to the
    frame with the largest share.

    Parameters
    ----------
    frame : array_like, shape (N, k, n)
        Tangents at the points; orthonormalised here.
    shares : sparse array, shape (M, N)
        Weights of the given points in each mean, 0 or more and with sum 1.

    Returns
    -------
    ndarray, shape (M, k, n)
        Orthonormal rows. They are zero where a point with a share lacks tangents, and where two of
        the spaces have directions at right angles, which have no mean.

    Raises
    ------
    TypeError, ValueError
        If the shapes do not match.

    Notes
    -----
    The rotation is the orthogonal factor ``U V^T`` of the matrix ``F G^T = U S V^T`` of two frames
    (orthogonal Procrustes). For orthonormal tangents in any basis, the space that the result spans
    is known to 2 eps divided by the cosine of the largest angle between the spaces. Between two
    points of a smooth manifold the error of the mean grows with the square of their distance.
    """
    rows, _ = orthonormalize(frames.as_rows("frame", frame, full=True))
    if rows.ndim != 3:
        raise _check.value_error("frame", "shape (N, k, n)", f"shape {rows.shape}")
    count, k, n = rows.shape
    sparse: bool = scipy.sparse.issparse(shares)
    if not sparse or shares.dtype.kind not in "iuf":
        raise _check.type_error("shares", "a sparse array of real numbers", shares)
    parts = scipy.sparse.csr_array(shares)
    if parts.shape[1] != count:
        expected = f"a matrix of {count} columns, one per point of frame"
        raise _check.value_error("shares", expected, f"shape {parts.shape}")
    owner = np.repeat(np.arange(parts.shape[0]), np.diff(parts.indptr))
    # With entries sorted by share, the last entry of each owner is the one with its largest share.
    order = np.lexsort((parts.data, owner))
    largest = np.zeros(parts.shape[0], dtype=np.intp)
    largest[owner[order]] = parts.indices[order]
    base = rows[largest[owner]]
    other = rows[parts.indices]
    # The rotation inside its own space that brings a frame nearest to the base one (Procrustes).
    left, cosines, right = np.linalg.svd(base @ other.swapaxes(1, 2))
    turned = (left @ right @ other).reshape(len(owner), k * n)
    # The same shares, with one column for each turned frame.
    mixing = scipy.sparse.csr_array(
        (parts.data, np.arange(len(owner)), parts.indptr), (len(largest), len(owner))
    )
    means = orthonormalize((mixing @ turned).reshape(-1, k, n))[0]
    # A frame with rows of zero gives a cosine of 0 with every frame.
    means[owner[cosines.min(axis=1) <= default_rtol(n, rows.dtype)]] = 0
    return means


def slice_frame(frame: ArrayLike, normal: ArrayLike, /, *, rtol: float | None = None) -> Array:
    """Return the tangent frame of the section of a manifold by a hyperplane.

    Parameters
    ----------
    frame : array_like, shape (..., k, n)
        Tangents of the manifold, k of 2 or more; orthonormalised here.
    normal : array_like, shape (n,)
        Normal of the hyperplane, of any length but 0.
    rtol : float, optional
        Sine of the angle between manifold and hyperplane below which they count as tangent to each
        other. Default: ``8 sqrt(n) eps``.

    Returns
    -------
    ndarray, shape (..., k - 1, n)
        Orthonormal rows, tangent to both the manifold and the hyperplane; zero where these touch,
        or where the frame of the manifold has rows of zero.

    Raises
    ------
    TypeError, ValueError
        If the shapes do not match.

    Notes
    -----
    Let a be the coefficients of the normal on the frame. A reflection of the frame maps its first
    row to a; the other rows are the result. ``|F F^T - 1| <= 8 eps``; for orthonormal tangents the
    space that the rows span is known to 2 eps divided by the sine of the angle between manifold and
    hyperplane.
    """
    rows, rank = orthonormalize(frames.as_rows("frame", frame, full=True))
    k, n = rows.shape[-2:]
    if k < 2:
        raise _check.value_error("frame", "2 tangents or more", k)
    across = np.array(_check.vector("normal", normal, direction=True))
    if len(across) != n:
        raise _check.value_error("normal", f"{n} components, like the rows of frame", len(across))
    # By the largest component first, so that no square overflows.
    across /= np.abs(across).max()
    a = rows @ (across / np.linalg.norm(across))
    size = np.linalg.norm(a, axis=-1)
    rtol = default_rtol(n, rows.dtype) if rtol is None else _check.number("rtol", rtol, low=0.0)
    good = (size > rtol) & (rank == k)
    mirror = a / np.where(good, size, 1)[..., np.newaxis]
    # Householder's vector, with the sign that does not cancel.
    mirror[..., 0] += np.where(mirror[..., 0] < 0, -1, 1)
    square = np.sum(mirror**2, axis=-1)
    # Householder's reflection, 1 - 2 m m^T / |m|^2, on the rows as coefficients of the frame.
    along = np.einsum("...k,...kn->...n", mirror, rows)
    factor = 2 * mirror[..., 1:] / np.where(good, square, 1)[..., np.newaxis]
    result: Array = rows[..., 1:, :] - factor[..., np.newaxis] * along[..., np.newaxis, :]
    result[~good] = 0
    return result
