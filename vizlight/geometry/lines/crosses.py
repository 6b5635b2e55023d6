"""Cross fields: two directions at each point; neither is the first and none has a sign."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.geometry.lines.simplices import Simplices, numbered

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices


def double_cover(points: Array, cells: Indices, pairs: Array) -> tuple[Simplices, Array]:
    """Return simplices on which a cross field is a line field.

    Parameters
    ----------
    points : ndarray, shape (N, 3)
    cells : ndarray of int, shape (M, k + 1)
    pairs : ndarray, shape (N, 2, 3)
        Two directions at each vertex, of length 1, or zero where there is none. Their order and
        their signs may differ from vertex to vertex.

    Returns
    -------
    mesh : Simplices
        2 N vertices and 2 M cells: cell i + M lies on cell i, with corners in the same order, and
        vertex j + N on vertex j.
    lines : ndarray, shape (2 N, 3)
        Directions without sign at its vertices: the two of each pair.

    Notes
    -----
    The directions at both ends of an edge are matched such that the sum of their ``|cos|`` is the
    larger one, and cells share a side where their matches agree. A curve that goes once around a
    singularity of index 1/4 so comes to the other cell over its place, as it continues along the
    other direction. In the cell of such a singularity no match fits all edges: one side of it is a
    boundary. Source: Kaelberer, Nieser and Polthier, QuadCover (2007), for the covering.
    """
    count = len(points)
    # Vertices at one position are compared with the first of them.
    number = numbered(points)
    first = np.unique(number, return_index=True)[1]
    turned = _turned(pairs[first[number]], pairs)
    corners = pairs[cells]
    other = _turned(corners[:, :1], corners)
    twice = np.concatenate([cells + count * other, cells + count * ~other])
    mesh = Simplices(np.concatenate([points, points]), twice, np.concatenate([turned, ~turned]))
    return mesh, np.concatenate([pairs[:, 0], pairs[:, 1]])


def _turned(a: Array, b: Array) -> Bools:
    """Return whether the first direction of each pair b continues the second one of a."""
    cosine = np.abs(np.einsum("...ic,...jc->...ij", a, b))
    straight = cosine[..., 0, 0] + cosine[..., 1, 1]
    return np.asarray(straight < cosine[..., 0, 1] + cosine[..., 1, 0])
