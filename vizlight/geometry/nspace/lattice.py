"""Cells on lattices of samples, also with closed directions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vizlight import _check
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
    """Return the number of samples in each of k directions, validated."""
    entries: Foreign = value
    several = isinstance(entries, list | tuple) or np.ndim(entries) == 1
    if several and len(entries) != k:
        raise _check.value_error("resolution", f"1 or {k} integers", len(entries))
    sizes = tuple(entries) if several else (entries,) * k
    counts = tuple(
        _check.integer("resolution", size, low=3 if wraps else 2)
        for size, wraps in zip(sizes, closed, strict=True)
    )
    _check.holds("resolution", counts)
    return counts


def cells(shape: Sequence[int], closed: Sequence[bool], *, by_rows: bool = False) -> Indices:
    """Return the cells of a lattice of 1 to 3 directions; the last index runs fastest.

    They are (M, 2^k) segments, quadrilaterals or hexahedra with corners in VTK's order; in a closed
    direction the first sample follows the last. ``by_rows`` lays quadrilaterals along the last
    direction first, as those of images.
    """
    index = np.arange(int(np.prod(shape)), dtype=np.intp).reshape(tuple(shape))
    # Behind the last sample comes the first one itself, no copy of it: a closed direction has no
    # seam.
    index = np.pad(index, [(0, int(wraps)) for wraps in closed], mode="wrap")
    parts = [
        index[tuple(slice(c, n - 1 + c) for c, n in zip(corner, index.shape, strict=True))]
        for corner in _CORNERS[len(shape)]
    ]
    if by_rows:
        parts[1:] = parts[:0:-1]
    return np.stack(parts, axis=-1).reshape(-1, len(parts))
