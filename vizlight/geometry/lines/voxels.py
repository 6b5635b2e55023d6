"""Sums over voxels: what is spread over the 8 voxels around places, and read again at places."""

from __future__ import annotations

from collections import deque
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
    number = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
    share = 1 / parts[owner]
    place = (number + 0.5) * share - 0.5
    vectors = np.take(vectors, owner, axis=1)
    return np.take(middles, owner, axis=1) + place * vectors, vectors * share


def box(rows: Array) -> tuple[Array, tuple[int, int, int]]:
    """Return the lower corner and the shape of a grid around places, with a margin of zeros."""
    if not rows.size:
        return np.zeros((3, 1), np.float32), (3, 3, 3)
    low = np.floor(rows.min(axis=1, keepdims=True)) - 1
    i, j, k = (int(n) + 4 for n in (rows.max(axis=1) - low[:, 0]))
    return low, (i, j, k)


def _corners(cells: Array, shape: tuple[int, ...]) -> Iterator[tuple[Indices, Array]]:
    """Yield the flat index and the weight of each of the 8 corners around places in a grid."""
    low = np.floor(cells).astype(np.intp)
    high = cells - low
    base = (low[0] * shape[1] + low[1]) * shape[2] + low[2]
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
    return both(grid, None, cells)[1]


class Rooms:
    """Grids that are used again: to make one of many megabytes takes as long as to fill it."""

    def __init__(self) -> None:
        self._free: deque[Array] = deque()

    def take(self, shape: tuple[int, int, int]) -> Array:
        """Return a grid of zeros."""
        size = shape[0] * shape[1] * shape[2]
        try:
            room = self._free.pop()
        except IndexError:
            room = np.empty(0, np.float32)
        if room.size < size:
            room = np.empty(size + size // 4, np.float32)
        grid = room[:size]
        grid[:] = 0
        return grid.reshape(shape)

    def give(self, grid: Array) -> None:
        """Take a grid back."""
        room = grid.base
        self._free.append(room if isinstance(room, np.ndarray) else grid.reshape(-1))


def depths(
    middles: Array, vectors: Array, places: Array, frame: Array, rooms: Rooms, /
) -> tuple[Array, Array]:
    """Return how much of the length of pieces, across a direction, is on either side of places.

    Parameters
    ----------
    middles, vectors : ndarray of float32, shape (3, M)
        Middle and vector of each piece, in voxels.
    places : ndarray of float32, shape (3, N)
        Places, in voxels.
    frame : ndarray of float32, shape (3, 3)
        Orthonormal frame in rows; the last row is the direction.
    rooms : Rooms
        Grids that are used again.

    Returns
    -------
    forth, back : ndarray of float32, shape (N,)
        Sums along the direction and against it.
    """
    if middles.size and _spread_across.pays((middles.shape[1] + places.shape[1]) * SAVED):
        flat = np.ascontiguousarray(frame, np.float32).reshape(-1)
        limits = np.repeat(np.array([np.inf, -np.inf], np.float32), 3)
        _limits(middles, flat, limits)
        low, shape = box(limits.reshape(2, 3).T)
        low = low[:, 0].astype(np.float32)
        grid = rooms.take(shape)
        _spread_across(middles, vectors, flat, low, grid.reshape(-1), shape[1], shape[2])
        total, most = summed(grid), np.array(shape, np.float32) - 2
        forth, back = np.empty((2, places.shape[1]), np.float32)
        _read_across(
            places, flat, low, most, grid.reshape(-1), total.reshape(-1), shape[1], shape[2],
            forth, back,
        )  # fmt: skip
        rooms.give(grid)
        return forth, back
    turned, at = frame @ middles, frame @ places
    across = np.hypot(*(frame[:2] @ vectors))
    low, shape = box(turned)
    grid = spread(turned - low, across, shape)
    cells = np.clip(at - low, 0, np.array(shape, np.float32)[:, np.newaxis] - 2)
    return both(grid, summed(grid), cells)


def summed(grid: Array) -> Array:
    """Replace each voxel by the sum of those before it and half of it; return the sum of all."""
    total = np.empty(grid.shape[:2], np.float32)
    if _sum.pays(grid.size * 5e-9):
        _sum(grid.reshape(-1), total.reshape(-1), grid.shape[2])
        return total
    half = grid * np.float32(0.5)
    np.cumsum(grid, axis=2, dtype=np.float32, out=grid)
    total[:] = grid[:, :, -1]
    grid -= half
    return total


def both(grid: Array, total: Array | None, cells: Array) -> tuple[Array, Array]:
    """Return what is left of a total per column beyond the values of a grid, and the values."""
    shape, count = grid.shape, cells.shape[1]
    forth, back = np.zeros(count if total is not None else 0, np.float32), np.zeros(count, "f4")
    if _read.pays(count * SAVED):
        columns = np.empty(0, np.float32) if total is None else total.reshape(-1)
        cells = np.ascontiguousarray(cells)
        _read(grid.reshape(-1), columns, cells, shape[1], shape[2], forth, back)
        return forth, back
    flat = grid.reshape(-1)
    for index, weight in _corners(cells, shape):
        back += weight * flat[index]
        if total is not None:
            forth += weight * total.reshape(-1)[index // shape[2]]
    if total is not None:
        forth -= back
    return forth, back


@_compiled.kernel(inline=True)
def _add(
    grid: Array, x: np.float32, y: np.float32, z: np.float32, value: np.float32, rows: int,
    columns: int,
) -> None:  # fmt: skip
    """Add a value to the 8 voxels around a place."""
    one, p, q, r = np.float32(1), int(x), int(y), int(z)
    f, g, h = x - np.float32(p), y - np.float32(q), z - np.float32(r)
    at = (p * rows + q) * columns + r
    near, far = value * (one - f), value * f
    for plane in (near, far):
        low, high = plane * (one - g), plane * g
        grid[at] += low * (one - h)
        grid[at + 1] += low * h
        grid[at + columns] += high * (one - h)
        grid[at + columns + 1] += high * h
        at += rows * columns


@_compiled.kernel(inline=True)
def _value(
    grid: Array, total: Array, x: np.float32, y: np.float32, z: np.float32, rows: int, columns: int
) -> tuple[np.float32, np.float32]:
    """Return the value of a grid at a place, and what is left of the total beyond it."""
    one, p, q, r = np.float32(1), int(x), int(y), int(z)
    f, g, h = x - np.float32(p), y - np.float32(q), z - np.float32(r)
    line = p * rows + q
    value = beyond = np.float32(0)
    for share in (one - f, f):
        at = line * columns + r
        low = grid[at] * (one - h) + grid[at + 1] * h
        high = grid[at + columns] * (one - h) + grid[at + columns + 1] * h
        value += share * (low * (one - g) + high * g)
        if len(total):
            beyond += share * (total[line] * (one - g) + total[line + 1] * g)
        line += rows
    return value, beyond - value


@_compiled.kernel(rounding=_compiled.ROUNDING)
def _spread(cells: Array, values: Array, grid: Array, rows: int, columns: int) -> None:
    """Add values to the 8 voxels around places."""
    x, y, z = cells[0], cells[1], cells[2]
    for i in range(len(values)):
        _add(grid, x[i], y[i], z[i], values[i], rows, columns)


@_compiled.kernel(rounding=_compiled.ROUNDING)
def _read(
    grid: Array, total: Array, cells: Array, rows: int, columns: int, forth: Array, back: Array
) -> None:
    """Take values from the 8 voxels around places, and what is left of the total of columns."""
    x, y, z = cells[0], cells[1], cells[2]
    for i in range(len(back)):
        value, beyond = _value(grid, total, x[i], y[i], z[i], rows, columns)
        back[i] = value
        if len(total):
            forth[i] = beyond


@_compiled.kernel(inline=True)
def _turned(rows: Array, i: int, f: Array) -> tuple[np.float32, np.float32, np.float32]:
    """Return a vector in a frame, given by the components of its rows."""
    x, y, z = rows[0][i], rows[1][i], rows[2][i]
    return (
        f[0] * x + f[1] * y + f[2] * z,
        f[3] * x + f[4] * y + f[5] * z,
        f[6] * x + f[7] * y + f[8] * z,
    )


@_compiled.kernel(rounding=_compiled.ROUNDING)
def _limits(rows: Array, frame: Array, limits: Array) -> None:
    """Take the least and the largest components of places in a frame."""
    for i in range(rows.shape[1]):
        x, y, z = _turned(rows, i, frame)
        limits[0], limits[3] = min(limits[0], x), max(limits[3], x)
        limits[1], limits[4] = min(limits[1], y), max(limits[4], y)
        limits[2], limits[5] = min(limits[2], z), max(limits[5], z)


@_compiled.kernel(rounding=_compiled.ROUNDING)
def _spread_across(
    middles: Array, vectors: Array, frame: Array, low: Array, grid: Array, rows: int, columns: int
) -> None:
    """Add the lengths of pieces across the last direction of a frame."""
    for i in range(middles.shape[1]):
        x, y, z = _turned(middles, i, frame)
        u, v, _ = _turned(vectors, i, frame)
        _add(grid, x - low[0], y - low[1], z - low[2], np.sqrt(u * u + v * v), rows, columns)


@_compiled.kernel(rounding=_compiled.ROUNDING)
def _read_across(
    places: Array, frame: Array, low: Array, most: Array, grid: Array, total: Array, rows: int,
    columns: int, forth: Array, back: Array,
) -> None:  # fmt: skip
    """Take the sums before and beyond places, those outside the grid at its rim."""
    zero = np.float32(0)
    for i in range(places.shape[1]):
        x, y, z = _turned(places, i, frame)
        x = min(max(x - low[0], zero), most[0])
        y = min(max(y - low[1], zero), most[1])
        z = min(max(z - low[2], zero), most[2])
        back[i], forth[i] = _value(grid, total, x, y, z, rows, columns)


@_compiled.kernel()
def _sum(grid: Array, total: Array, columns: int) -> None:
    """Replace each voxel by the sum of those before it in its column and half of it."""
    half = np.float32(0.5)
    for row in range(len(total)):
        run = np.float32(0)
        for at in range(row * columns, (row + 1) * columns):
            value = grid[at]
            grid[at] = run + half * value
            run += value
        total[row] = run
