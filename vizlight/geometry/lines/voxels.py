"""Sums over voxels: values are spread over the 8 voxels around places, and read at places."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight import _compiled

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vizlight._types import Array, Indices

#: Seconds per point or piece that compiled code saves.
SAVED = 60e-9
#: Number of places that NumPy spreads at once.
AT_ONCE = 1 << 19


def cut(middles: Array, vectors: Array, parts: Indices) -> tuple[Array, Array]:
    """Return pieces, given by columns, each cut to some parts of equal lengths."""
    owner = np.repeat(np.arange(len(parts)), parts)
    # Counts from 0 within each piece, so that parts of all pieces are made without a loop.
    number = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
    share = 1 / parts[owner]
    # Middles of the parts, in lengths of the piece from its middle: from -1/2 to 1/2.
    place = (number + 0.5) * share - 0.5
    vectors = np.take(vectors, owner, axis=1)
    return np.take(middles, owner, axis=1) + place * vectors, vectors * share


def box(rows: Array) -> tuple[Array, tuple[int, int, int]]:
    """Return the lower corner and the shape of a grid around places, with a margin of zeros."""
    if not rows.size:
        return np.zeros((3, 1), np.float32), (3, 3, 3)
    # An empty layer before all pieces and two behind: a place outside is clipped to one, where it
    # finds no line beside it, or the whole sum behind the last.
    low = np.floor(rows.min(axis=1, keepdims=True)) - 1
    i, j, k = (int(n) + 4 for n in (rows.max(axis=1) - low[:, 0]))
    return low, (i, j, k)


def _corners(cells: Array, shape: tuple[int, ...]) -> Iterator[tuple[Indices, Array]]:
    """Yield the flat index and the weight of each of the 8 corners around places in a grid."""
    low = np.floor(cells).astype(np.intp)
    high = cells - low
    base = (low[0] * shape[1] + low[1]) * shape[2] + low[2]
    # Trilinear: the weight of a corner is the product of three shares, one along each axis.
    weights = (1 - high, high)
    for a in (0, 1):
        for b in (0, 1):
            plane = weights[a][0] * weights[b][1]
            for c in (0, 1):
                yield base + (a * shape[1] + b) * shape[2] + c, plane * weights[c][2]


def spread(cells: Array, values: Array, shape: tuple[int, int, int], /) -> Array:
    """Return a grid to which values are added at places, each over the 8 voxels around it.

    Parameters
    ----------
    cells : ndarray of float32, shape (3, N)
        Places in units of voxels, from 0 to the shape less 2.
    values : ndarray of float32, shape (N,)
        Values.
    shape : tuple of int
        Numbers of voxels.

    Returns
    -------
    ndarray of float32
        Grid.
    """
    values = values.astype(np.float32, copy=False)
    if _spread.pays(len(values) * SAVED):
        grid = np.zeros(shape, np.float32)
        _spread(np.ascontiguousarray(cells), values, grid.reshape(-1), shape[1], shape[2])
        return grid
    size = shape[0] * shape[1] * shape[2]
    flat = np.zeros(size)
    for start in range(0, len(values), AT_ONCE):
        part = slice(start, start + AT_ONCE)
        indices, weights = zip(*_corners(cells[:, part], shape), strict=True)
        shares = np.concatenate(weights).reshape(8, -1) * values[part]
        # Unlike an indexed sum this adds all that falls on one voxel, and it does so in float64.
        flat += np.bincount(np.concatenate(indices), shares.reshape(-1), minlength=size)
    return flat.astype(np.float32).reshape(shape)


def read(grid: Array, cells: Array, /) -> Array:
    """Return the values of a grid at places, from the 8 voxels around each.

    Parameters
    ----------
    grid : ndarray of float32
        Grid.
    cells : ndarray of float32, shape (3, N)
        Places in units of voxels, from 0 to the shape less 2.

    Returns
    -------
    ndarray of float32, shape (N,)
        Values.
    """
    values = np.zeros(cells.shape[1], np.float32)
    flat = grid.reshape(-1)
    if _read.pays(len(values) * SAVED):
        _read(flat, np.ascontiguousarray(cells), grid.shape[1], grid.shape[2], values)
        return values
    for index, weight in _corners(cells, grid.shape):
        values += weight * flat[index]
    return values


def summed(grid: Array) -> Array:
    """Replace each voxel by the sum of those before it and half of it; return the sum of all."""
    # A sum is read at the middle of a voxel, before which half of its own content lies.
    half = grid * np.float32(0.5)
    np.cumsum(grid, axis=2, dtype=np.float32, out=grid)
    # Before the halves are taken off: the last running sum covers the whole row.
    total = grid[:, :, -1].copy()
    grid -= half
    return total


def depths(middles: Array, vectors: Array, places: Array, frame: Array, /) -> tuple[Array, Array]:
    """Return the length of pieces, across a direction, on either side of places.

    Parameters
    ----------
    middles, vectors : ndarray of float32, shape (3, M)
        Middle and vector of each piece, in voxels.
    places : ndarray of float32, shape (3, N)
        Places, in voxels.
    frame : ndarray of float32, shape (3, 3)
        Orthonormal frame in rows; the last row is the direction.

    Returns
    -------
    forth, back : ndarray of float32, shape (N,)
        Sums along the direction and against it.
    """
    # For so few rows a product of matrices takes twice as long.
    turned, at = (np.einsum("ij,jk->ik", frame, rows) for rows in (middles, places))
    low, shape = box(turned)
    # A cylinder takes from the light by |w x t|, the length of its part in the plane across w.
    u, v = np.einsum("ij,jk->ik", frame[:2], vectors)
    grid = spread(turned - low, np.sqrt(u * u + v * v), shape)
    total = summed(grid)
    cells = np.clip(at - low, 0, np.array(shape, np.float32)[:, np.newaxis] - 2)
    back = read(grid, cells)
    # The sums of all stand in two layers, so that they are read like a grid.
    cells[2] = 0
    return read(np.stack([total, total], axis=2), cells) - back, back


@_compiled.kernel(rounding=_compiled.ROUNDING)
def _spread(cells: Array, values: Array, grid: Array, rows: int, columns: int) -> None:
    """Add values to the 8 voxels around places."""
    unit, x, y, z = np.float32(1), cells[0], cells[1], cells[2]
    for i in range(len(values)):
        p, q, r = int(x[i]), int(y[i]), int(z[i])
        # The casts keep the arithmetic in float32: with an integer numba would widen it to float64.
        f, g, h = x[i] - np.float32(p), y[i] - np.float32(q), z[i] - np.float32(r)
        at = (p * rows + q) * columns + r
        for plane in (values[i] * (unit - f), values[i] * f):
            low, high = plane * (unit - g), plane * g
            grid[at] += low * (unit - h)
            grid[at + 1] += low * h
            grid[at + columns] += high * (unit - h)
            grid[at + columns + 1] += high * h
            at += rows * columns


@_compiled.kernel(rounding=_compiled.ROUNDING)
def _read(grid: Array, cells: Array, rows: int, columns: int, values: Array) -> None:
    """Take values from the 8 voxels around places."""
    unit, x, y, z = np.float32(1), cells[0], cells[1], cells[2]
    for i in range(len(values)):
        p, q, r = int(x[i]), int(y[i]), int(z[i])
        f, g, h = x[i] - np.float32(p), y[i] - np.float32(q), z[i] - np.float32(r)
        at = (p * rows + q) * columns + r
        for share in (unit - f, f):
            low = grid[at] * (unit - h) + grid[at + 1] * h
            high = grid[at + columns] * (unit - h) + grid[at + columns + 1] * h
            values[i] += share * (low * (unit - g) + high * g)
            at += rows * columns
