"""Cells on lattices of samples, also with closed directions, and the surface cells of a cube."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Foreign, Indices


#: Corners of a segment, a quadrilateral and a hexahedron, in VTK's order.
_CORNERS: dict[int, tuple[tuple[int, ...], ...]] = {
    1: ((0,), (1,)),
    2: ((0, 0), (1, 0), (1, 1), (0, 1)),
    3: (
        (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
        (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1),
    ),
}  # fmt: skip


def resolution(value: int | Sequence[int], k: int, closed: Sequence[bool]) -> tuple[int, ...]:
    """Return the number of samples in each of k directions, validated.

    Raises
    ------
    TypeError, ValueError
        If the value is not one integer or k of them, or one is less than 3 in a closed direction
        or less than 2 in an open one.
    """
    entries: Foreign = value
    several = isinstance(entries, list | tuple) or np.ndim(entries) == 1
    if several and len(entries) != k:
        raise ValueError(_check.message("resolution", f"1 or {k} integers", len(entries)))
    sizes = tuple(entries) if several else (entries,) * k
    counts = tuple(
        _check.integer("resolution", size, low=3 if wraps else 2)
        for size, wraps in zip(sizes, closed, strict=True)
    )
    _check.holds("resolution", counts)
    return counts


def cells(shape: Sequence[int], closed: Sequence[bool], *, twisted: bool = False) -> Indices:
    """Return the cells of a lattice of 1 to 3 directions; the last index runs fastest.

    Parameters
    ----------
    shape : sequence of int
        Number of samples in each direction.
    closed : sequence of bool
        Whether the last sample of a direction is followed by its first.
    twisted : bool, default: False
        Whether the second direction is reversed (index ``-j`` for ``j``) where the first one, which
        must be closed, returns to its start, as on a Klein bottle.

    Returns
    -------
    ndarray of int, shape (M, 2^k)
        Segments, quadrilaterals or hexahedra with corners in VTK's order.
    """
    index = np.arange(int(np.prod(shape)), dtype=np.intp).reshape(tuple(shape))
    if twisted:
        # Index -j modulo the count: reversed, and turned by one, so that 0 stays where it is.
        back = np.roll(index[0, ::-1], 1, axis=0)
        index = np.concatenate([index, back[np.newaxis]])
        closed = (False, *closed[1:])
    # Behind the last sample comes the first one itself, no copy of it: a closed direction has no
    # seam.
    index = np.pad(index, [(0, int(wraps)) for wraps in closed], mode="wrap")
    parts = [
        index[tuple(slice(c, n - 1 + c) for c, n in zip(corner, index.shape, strict=True))]
        for corner in _CORNERS[len(shape)]
    ]
    return np.stack([part.ravel() for part in parts], axis=1)


def cube_skin(dimension: int, size: int, *, opposite: bool = False) -> tuple[Indices, Indices]:
    """Return the lattice points on the surface of a cube, each once, and the cells between them.

    Parameters
    ----------
    dimension : int
        Dimension of the cube, 3 or 4; its surface has one less.
    size : int
        Number of cells along an edge.
    opposite : bool, default: False
        Whether opposite points are identified, which makes the surface a projective space.

    Returns
    -------
    points : ndarray of int, shape (N, dimension)
        Coordinates from ``-size`` to ``size`` in steps of 2.
    cells : ndarray of int, shape (M, 2^(dimension - 1))
    """
    # Twice the coordinates, which are whole numbers about 0 for odd numbers of cells, too.
    steps = 2 * np.arange(size + 1) - size
    within = np.stack(np.meshgrid(*[steps] * (dimension - 1), indexing="ij"), axis=-1)
    within = within.reshape(-1, dimension - 1)
    local = cells([size + 1] * (dimension - 1), [False] * (dimension - 1))
    places: list[Indices] = []
    faces: list[Indices] = []
    # Of opposite faces one is enough where opposite points are one.
    for axis, side in itertools.product(range(dimension), (1,) if opposite else (1, -1)):
        faces.append(local + len(places) * len(within))
        places.append(np.insert(within, axis, side * size, axis=1))
    corner = np.concatenate(places)
    if opposite:
        # The sign of the first non-zero coordinate decides which of both points is kept.
        first = np.argmax(corner != 0, axis=1)
        corner = corner * np.sign(corner[np.arange(len(corner)), first])[:, np.newaxis]
    # Faces share the points of their edges, which are found by equal coordinates.
    points, number = np.unique(corner, axis=0, return_inverse=True)
    return points, np.asarray(number, dtype=np.intp).reshape(-1)[np.concatenate(faces)]
