"""Light inside a bundle of lines: the lines as a medium of thin cylinders.

A line of diameter d takes from light of direction w the share ``d |w x t|`` per length of line and
area across w, and what is left of the light is the exponential of minus the sum on its way (Beer
and Lambert). The sum is taken on a grid in the light's own frame: each piece of a line is spread
over the 8 voxels around it, the voxels are summed along the light, and the sum is read at a point
from the 8 voxels around that.

Two corrections are in closed form. A point of a line does not shade itself: a straight line adds
``1 / (3 h)`` to its own depth per diameter, h the side of a voxel, since the hat function of the
voxels has the mean 2/3 of its square and half of the line lies on the light's side; a line that is
short as the light sees it adds less. And lines are spread at random within a voxel, so the mean of
the exponential is above the exponential of the mean, which a factor ``1 + d / (4 h)`` of the depth
makes up for: it stands for the lines, d wide, that lie in one another's shadow.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _compiled

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vizlight._types import Array, Indices, VectorLike

__all__ = ["Medium", "attenuation", "directions", "medium", "own_share", "read", "spread"]

#: Share of the depth of a straight line at its own points, in voxels per diameter.
OWN = 1 / 3
#: Factor of the depth per voxel and diameter by which lines shade one another less.
CROWDING = 1 / 4
#: Least side of a voxel in diameters.
LEAST_VOXEL = 2.0
#: Golden angle of the Fibonacci directions.
GOLDEN = np.pi * (3 - np.sqrt(5))
#: Rows that are taken at once.
BLOCK = 1 << 18


def directions(count: int, /) -> Array:
    """Return half of some directions that fill the sphere evenly; their opposites are the others.

    Parameters
    ----------
    count : int
        Number of directions, at least 2.

    Returns
    -------
    ndarray, shape (count // 2, 3)
        Unit vectors of a hemisphere, on a Fibonacci spiral.
    """
    number = np.arange(max(1, count // 2))
    z = (number + 0.5) / len(number)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(GOLDEN * number), r * np.sin(GOLDEN * number), z], axis=1)


@dataclass(frozen=True)
class Medium:
    """Lines cut to pieces that are no longer than a voxel.

    Attributes
    ----------
    middles, vectors : ndarray of float32, shape (M, 3)
        Middle and vector of each piece, relative to ``origin``.
    origin : ndarray, shape (3,)
        Centre of the lines, subtracted in float64.
    voxel : float
        Side of a voxel in the unit of the points.
    """

    middles: Array
    vectors: Array
    origin: Array
    voxel: float

    def depths(self, points: Array, toward: VectorLike, /) -> tuple[Array, Array]:
        """Return the optical depth per diameter toward a direction and toward its opposite.

        Parameters
        ----------
        points : ndarray, shape (N, 3)
            Positions.
        toward : sequence of float, shape (3,)
            Direction toward a light at infinity, of any length.

        Returns
        -------
        forth, back : ndarray of float32, shape (N,)
            Depths, the point's own line included.
        """
        frame = _frame(toward)
        at = _turned(points - self.origin, frame)
        middles = _turned(self.middles, frame)
        across = np.hypot(*(self.vectors @ frame[:2].T.astype(np.float32)).T)
        low = np.minimum(middles.min(axis=1), at.min(axis=1)) - 1.5 * self.voxel
        high = np.maximum(middles.max(axis=1), at.max(axis=1)) + 1.5 * self.voxel
        shape = _shape((high - low) / self.voxel)
        cells = (middles - low[:, None]) / self.voxel
        grid = spread(cells.astype(np.float32), across / self.voxel**2, shape)
        below = np.cumsum(grid, axis=2, dtype=np.float32)
        total = below[:, :, -1:].copy()
        # Half of the own voxel counts on either side.
        grid *= np.float32(0.5)
        below -= grid
        places = ((at - low[:, None]) / self.voxel).astype(np.float32)
        back = read(below, places)
        np.subtract(total, below, out=below)
        return read(below, places), back

    def near_depth(self, points: Array, position: VectorLike, /) -> Array:
        """Return the optical depth per diameter between points and a light nearby.

        The grid has the light in its centre: on each of the six faces of a cube around it, voxels
        are cones whose width grows with the distance.

        Parameters
        ----------
        points : ndarray, shape (N, 3)
            Positions.
        position : sequence of float, shape (3,)
            Position of the light, inside or outside the bundle.

        Returns
        -------
        ndarray of float32, shape (N,)
            Depths, the point's own line included.
        """
        lamp = np.asarray(position, np.float64)
        at = points - lamp
        middles = self.middles + (self.origin - lamp)
        out = np.zeros(len(points), np.float32)
        far = np.linalg.norm(at, axis=1)
        reach = far.max(initial=0.0)
        width = self.voxel / max(float(np.median(far)), self.voxel)
        gone = np.linalg.norm(middles, axis=1)
        direction = middles / np.maximum(gone, np.finfo(np.float64).tiny)[:, None]
        across = np.linalg.norm(np.cross(self.vectors, direction), axis=1)
        face = np.argmax(np.abs(at), axis=1)
        for axis in range(3):
            others = [i for i in range(3) if i != axis]
            for side in (1, -1):
                rows = np.flatnonzero((face == axis) & (side * at[:, axis] > 0))
                if not rows.size:
                    continue
                height = side * at[rows, axis]
                seen = at[rows][:, others].T / height
                low = seen.min(axis=1) - 2 * width
                high = seen.max(axis=1) + 2 * width
                held = np.flatnonzero((side * middles[:, axis] > 0) & (gone < reach))
                depth = side * middles[held, axis]
                place = middles[held][:, others].T / depth
                inside = ((place > low[:, None] + width / 100) & (place < high[:, None])).all(
                    axis=0
                )
                held, depth, place = held[inside], depth[inside], place[:, inside]
                steps = np.array([*((high - low) / width), reach / self.voxel])
                area = (width * depth) ** 2 * depth / gone[held]
                cells = np.stack([*((place - low[:, None]) / width), gone[held] / self.voxel])
                grid = spread(cells.astype(np.float32), across[held] / area, _shape(steps))
                below = np.cumsum(grid, axis=2, dtype=np.float32) - grid / 2
                places = np.stack([*((seen - low[:, None]) / width), far[rows] / self.voxel])
                out[rows] = read(below, places.astype(np.float32))
        return out


def medium(points: Array, connectivity: Indices, offsets: Indices, /, *, voxel: float) -> Medium:
    """Return the medium of some polylines.

    Parameters
    ----------
    points : ndarray, shape (N, 3)
        Positions, in any unit.
    connectivity : ndarray of int, shape (M,)
        Indices of the points of each line, one line after the other.
    offsets : ndarray of int, shape (L + 1,)
        Start of each line in the connectivity, followed by its length.
    voxel : float
        Side of a voxel in the unit of the points.

    Returns
    -------
    Medium
        Pieces of the segments whose ends are finite.
    """
    inside = np.ones(len(connectivity), np.bool_)
    inside[offsets[1:][np.diff(offsets) > 0] - 1] = False
    first = np.flatnonzero(inside)
    ends = points[connectivity].astype(np.float64)
    finite = np.isfinite(ends).all(axis=1)
    first = first[finite[first] & finite[first + 1]]
    origin = (
        (ends[finite].min(axis=0) + ends[finite].max(axis=0)) / 2 if finite.any() else np.zeros(3)
    )
    start, vector = ends[first] - origin, ends[first + 1] - ends[first]
    parts = np.maximum(1, np.ceil(np.linalg.norm(vector, axis=1) / voxel - 1e-9)).astype(np.intp)
    vector /= parts[:, None]
    owner = np.repeat(np.arange(len(parts)), parts)
    number = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
    middles = start[owner] + (number + 0.5)[:, None] * vector[owner]
    return Medium(middles.astype(np.float32), vector[owner].astype(np.float32), origin, voxel)


def attenuation(depth: Array, own: Array | float, diameter: float, voxel: float, /) -> Array:
    """Return the share of light that is left behind lines.

    Parameters
    ----------
    depth : ndarray, shape (N,)
        Depths per diameter, of :class:`Medium`.
    own : ndarray, shape (N,), or float
        Share of the own line that is counted, of :func:`own_share`; 0 for a point of no line.
    diameter, voxel : float
        Diameter of the lines and side of a voxel at the points, in one unit.

    Returns
    -------
    ndarray, shape (N,)
        Shares in [0, 1].
    """
    others = np.maximum(depth - own * OWN / voxel, 0)
    return np.exp(-diameter * (1 + CROWDING * diameter / voxel) * others)


def own_share(length: Array, tangent: Array, toward: Array, voxel: float | Array, /) -> Array:
    """Return which share of a long line's own depth a line adds at its own points.

    Parameters
    ----------
    length : ndarray, shape (N,)
        Length of the line that a point belongs to.
    tangent, toward : ndarray, shape (N, 3) or (3,)
        Unit tangent, and unit direction toward the light.
    voxel : float or ndarray
        Side of a voxel.

    Returns
    -------
    ndarray, shape (N,)
        Shares in [0, 1]: 0 for a line that the light sees end on.
    """
    seen = length * np.linalg.norm(np.cross(tangent, toward), axis=-1)
    return np.minimum(1, seen / (2 * voxel))


def _frame(toward: VectorLike) -> Array:
    """Return an orthonormal frame, in rows, whose last row is a direction."""
    w = np.asarray(toward, np.float64) / np.linalg.norm(toward)
    u = np.cross(w, np.eye(3)[np.argmin(np.abs(w))])
    u /= np.linalg.norm(u)
    return np.stack([u, np.cross(w, u), w])


def _turned(rows: Array, frame: Array) -> Array:
    """Return component-first coordinates in a frame."""
    turned: Array = frame.astype(rows.dtype) @ rows.T
    return turned


def _shape(cells: Array) -> tuple[int, int, int]:
    i, j, k = (int(n) + 3 for n in np.ceil(cells))
    return i, j, k


def _corners(cells: Array, shape: tuple[int, int, int]) -> Iterator[tuple[Indices, Array]]:
    """Yield the flat index and the weight of each of the 8 corners around places in a grid."""
    low = np.floor(cells).astype(np.int32)
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
    grid = np.zeros(shape, np.float32)
    if _spread.pays(len(values) * 60e-9):
        _spread(np.ascontiguousarray(cells), values, grid.reshape(-1), shape[1], shape[2])
        return grid
    flat = np.zeros(grid.size)
    for index, weight in _corners(cells, shape):
        flat += np.bincount(index, weights=weight * values, minlength=grid.size)
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
    shape = grid.shape
    flat, out = grid.reshape(-1), np.zeros(cells.shape[1], np.float32)
    if _read.pays(len(out) * 60e-9):
        _read(flat, np.ascontiguousarray(cells), shape[1], shape[2], out)
        return out
    for index, weight in _corners(cells, (shape[0], shape[1], shape[2])):
        out += weight * flat[index]
    return out


@_compiled.kernel()
def _spread(cells: Array, values: Array, grid: Array, rows: int, columns: int) -> None:
    """Add values to the 8 voxels around places."""
    x, y, z = cells[0], cells[1], cells[2]
    one = np.float32(1)
    for i in range(len(values)):
        p, q, r = int(x[i]), int(y[i]), int(z[i])
        f, g, h = x[i] - np.float32(p), y[i] - np.float32(q), z[i] - np.float32(r)
        at = (p * rows + q) * columns + r
        near, far = values[i] * (one - f), values[i] * f
        for plane in (near, far):
            low, high = plane * (one - g), plane * g
            grid[at] += low * (one - h)
            grid[at + 1] += low * h
            grid[at + columns] += high * (one - h)
            grid[at + columns + 1] += high * h
            at += rows * columns


@_compiled.kernel()
def _read(grid: Array, cells: Array, rows: int, columns: int, out: Array) -> None:
    """Take values from the 8 voxels around places."""
    x, y, z = cells[0], cells[1], cells[2]
    one = np.float32(1)
    for i in range(len(out)):
        p, q, r = int(x[i]), int(y[i]), int(z[i])
        f, g, h = x[i] - np.float32(p), y[i] - np.float32(q), z[i] - np.float32(r)
        at = (p * rows + q) * columns + r
        total = np.float32(0)
        for share in (one - f, f):
            low = grid[at] * (one - h) + grid[at + 1] * h
            high = grid[at + columns] * (one - h) + grid[at + columns + 1] * h
            total += share * (low * (one - g) + high * g)
            at += rows * columns
        out[i] = total
