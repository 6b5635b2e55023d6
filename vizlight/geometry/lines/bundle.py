"""Light inside a bundle of lines: the lines as a medium of thin cylinders.

A line of diameter d takes from light of direction w the share ``d |w x t|`` per length of line and
area across w, and what is left of the light is the exponential of minus the sum on its way (Beer
and Lambert). The sum is taken on a grid in the light's own frame: each piece of a line is spread
over the 8 voxels around it, the voxels are summed along the light, and the sum is read at a point
from the 8 voxels around that. All lengths are in voxels.

Two corrections are in closed form. A point of a line does not shade itself: a straight line adds
1/3 to its own depth, since the hat function of the voxels has the mean 2/3 of its square and half
of the line lies on the light's side; a line that is short as the light sees it adds less. And lines
are spread at random within a voxel, so the mean of the exponential is above the exponential of the
mean, which a factor ``1 + d / 4`` of the depth makes up for: it stands for the lines, d wide, that
lie in one another's shadow.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vizlight import _check, _compiled, _pool

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from vizlight._types import Array, Bools, Indices, VectorLike

__all__ = ["Medium", "Targets", "directions", "medium", "read", "spread"]

#: Depth of a straight line at its own points, per diameter.
OWN = 1 / 3
#: Factor of the depth per diameter by which lines shade one another less.
CROWDING = 1 / 4
#: Least side of a voxel in diameters.
LEAST_VOXEL = 2.0
#: Golden angle of the Fibonacci directions.
GOLDEN = np.pi * (3 - np.sqrt(5))
#: Seconds per point or piece that compiled code saves.
SAVED = 60e-9
#: Largest coordinate in voxels of a place: farther points are as dark as those there.
FARTHEST = 1e6
#: Largest number of parts of a piece near a light.
MOST_PARTS = 64
#: Largest number of parallel pieces of a piece near a light.
MOST_ACROSS = 16
#: Largest share of a voxel that a line takes from the light.
WIDEST = 0.99
#: Least width of a voxel near a light, and least distance from it, in voxels.
NARROWEST = 1e-6


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


class Targets(NamedTuple):
    """Points that a medium dims, in voxels from its origin; see :meth:`Medium.targets`.

    Attributes
    ----------
    places : ndarray of float32, shape (3, N)
        Places of the points.
    known : ndarray of bool, shape (N,)
        Whether a point is finite; others are not dimmed.
    vectors : ndarray of float32, shape (3, N), or None
        Unit tangents of lines or unit normals of a surface.
    lengths : ndarray of float32, shape (N,), or None
        Length of the line of the medium that a point belongs to, 0 for none; None for a surface,
        which light reaches from the side of its normals alone.
    """

    places: Array
    known: Bools
    vectors: Array | None = None
    lengths: Array | None = None

    def facing(self, toward: Array) -> Array:
        """Return the share of light from a direction that points receive, for both its ends.

        Parameters
        ----------
        toward : ndarray, shape (3,) or (3, N)
            Unit direction.

        Returns
        -------
        ndarray, shape (2, N)
            ``|w x t|`` of a line, ``max(0, N . w)`` of a surface, 1 of a point without vectors.
        """
        if self.vectors is None:
            return np.ones((2, self.places.shape[1]), np.float32)
        cosine = np.einsum("i...,i...->...", toward.reshape(3, -1), self.vectors)
        if self.lengths is None:
            return np.maximum([cosine, -cosine], 0)
        sine = np.sqrt(np.maximum(1 - cosine * cosine, 0))
        return np.stack([sine, sine])

    def own(self, toward: Array, width: Array | float = 1.0) -> Array | float:
        """Return the depth per diameter that the line of a point adds at the point itself."""
        if self.lengths is None or self.vectors is None:
            return 0.0
        seen = self.lengths * self.facing(toward)[0]
        share: Array = np.minimum(seen / (2 * width), 1) * np.float32(OWN) / width
        return share


@dataclass(frozen=True)
class Medium:
    """Lines cut to pieces that are no longer than a voxel.

    Attributes
    ----------
    middles, vectors : ndarray of float32, shape (3, M)
        Middle and vector of each piece, in voxels from the origin.
    origin : ndarray, shape (3,)
        Centre of the lines.
    voxel : float
        Side of a voxel in the unit of the lines.
    """

    middles: Array
    vectors: Array
    origin: Array
    voxel: float

    def targets(
        self, points: Array, vectors: Array | None = None, lengths: Array | None = None, /
    ) -> Targets:
        """Return points that the medium dims.

        Parameters
        ----------
        points : ndarray, shape (N, 3)
            Positions in the unit of the lines.
        vectors : ndarray, shape (N, 3), optional
            Tangents of lines or normals of a surface, of any length.
        lengths : ndarray, shape (N,), optional
            Lengths of the lines that the points belong to, for tangents.

        Returns
        -------
        Targets
        """
        places = (points.T.astype(np.float64) - self.origin[:, np.newaxis]) / self.voxel
        known: Bools = np.asarray(np.isfinite(places).all(axis=0))
        places = np.where(known, np.clip(places, -FARTHEST, FARTHEST), 0).astype(np.float32)
        unit = None
        if vectors is not None:
            rows = vectors.T.astype(np.float64)
            largest = np.abs(rows).max(axis=0, initial=0)
            with np.errstate(invalid="ignore", divide="ignore"):
                rows = rows / largest
                rows /= np.sqrt((rows * rows).sum(axis=0))
            unit = np.where(np.isfinite(rows), rows, 0).astype(np.float32)
        if lengths is not None:
            lengths = np.minimum(lengths / self.voxel, FARTHEST).astype(np.float32)
        return Targets(np.ascontiguousarray(places), known, unit, lengths)

    def depths(self, places: Array, toward: VectorLike, /) -> tuple[Array, Array]:
        """Return the optical depth per diameter toward a direction and toward its opposite.

        Parameters
        ----------
        places : ndarray of float32, shape (3, N)
            Places of :class:`Targets`.
        toward : sequence of float, shape (3,)
            Direction toward a light at infinity, of any length.

        Returns
        -------
        forth, back : ndarray of float32, shape (N,)
            Depths, the point's own line included; diameters and depths are in voxels.
        """
        frame = _frame(toward).astype(np.float32)
        middles, at = frame @ self.middles, frame @ places
        across = np.hypot(*(frame[:2] @ self.vectors))
        low, shape = _box(middles)
        grid = spread(middles - low, across, shape)
        cells = np.clip(at - low, 0, np.array(shape, np.float32)[:, np.newaxis] - 2)
        return _both(grid, _summed(grid), cells)

    def near_depth(
        self, places: Array, lamp: VectorLike, thick: float = 0.0, /
    ) -> tuple[Array, Array]:
        """Return the optical depth per diameter between points and a light nearby.

        The grid has the light in its centre: on each of the six faces of a cube around it, voxels
        are cones whose width grows with the distance. Near the light they are narrower than a
        line, which is then spread over its own width, and opaque where it covers a cone.

        Parameters
        ----------
        places : ndarray of float32, shape (3, N)
            Places of :class:`Targets`.
        lamp : sequence of float, shape (3,)
            Place of the light, inside or outside the bundle, in voxels.
        thick : float, default: 0.0
            Diameter of the lines in voxels, of which the depth includes the factor for lines in
            one another's shadow.

        Returns
        -------
        depth : ndarray of float32, shape (N,)
            Depths, the point's own line included.
        width : ndarray of float32, shape (N,)
            Width of the voxels at the points, in voxels of the medium.
        """
        centre = np.asarray(lamp, np.float64)[:, np.newaxis]
        at = places - centre
        gone, far = _size(self.middles - centre), _size(at)
        out = np.zeros(at.shape[1], np.float32)
        widths: Array = np.ones(at.shape[1], np.float32)
        if not gone.size:
            return out, widths
        width = 1 / max(float(np.median(gone)), 1.0)
        middles, vectors, share = _for_cones(self.middles - centre, self.vectors, width, thick)
        gone = _size(middles)
        across = share * _size(np.cross(vectors, middles, axis=0)) / np.maximum(gone, NARROWEST)
        across *= _crowding(thick / np.maximum(width * gone, NARROWEST))
        face = np.argmax(np.abs(at), axis=0)
        for axis in range(3):
            for side in (1, -1):
                rows = np.flatnonzero((face == axis) & (side * at[axis] > 0))
                held = np.flatnonzero(side * middles[axis] > 0)
                if rows.size and held.size:
                    part = _Cone(axis, side, width)
                    seen = part.seen(at[:, rows])
                    out[rows] = part.depth(
                        seen, far[rows], part.seen(middles[:, held]), gone[held], across[held]
                    )
                    height = side * at[axis, rows]
                    widths[rows] = width * height * np.sqrt(height / far[rows])
        return out, widths

    def dimmed(
        self,
        targets: Targets,
        diameter: float,
        lights: Sequence[tuple[VectorLike, bool]],
        count: int,
        *,
        threads: int | None = None,
        progress: Callable[[int], None] | None = None,
    ) -> tuple[Array, Array | None]:
        """Return the share of each light, and of light from all sides, that is left at points.

        Parameters
        ----------
        targets : Targets
            Points.
        diameter : float
            Diameter of the lines in the unit of the lines.
        lights : sequence of (vector of 3 components, bool)
            Direction toward each light, or its position and True.
        count : int
            Number of directions for light from all sides, 0 for none.
        threads : int, optional
            Number of threads that share the directions.
        progress : callable, optional
            Function that is called with the number of grids that are done.

        Returns
        -------
        transmittance : ndarray of float32, shape (N, L)
            Shares in [0, 1].
        occlusion : ndarray of float32, shape (N,), or None
            Mean over all directions, each weighted by :meth:`Targets.facing`; None without
            directions.
        """
        thick = diameter / self.voxel
        ways = directions(count) if count else np.empty((0, 3))
        found: dict[int, tuple[Array, Array]] = {}

        def work(part: slice) -> int:
            number = int(part.start)
            if number < len(lights):
                found[number] = self._light(targets, thick, *lights[number])
            else:
                found[number] = self._pair(targets, thick, ways[number - len(lights)])
            return number

        transmittance = np.empty((targets.places.shape[1], len(lights)), np.float32)
        total = np.zeros((2, targets.places.shape[1]))
        parts = _pool.blocks(len(lights) + len(ways), 1)
        for number in _pool.run(work, parts, threads):
            # In the order of the parts, so that sums do not depend on the threads.
            left, weight = found.pop(number)
            if number < len(lights):
                transmittance[:, number] = left
            else:
                total += left, weight
            if progress is not None:
                progress(number + 1)
        transmittance[~targets.known] = 1
        if not count:
            return transmittance, None
        with np.errstate(invalid="ignore"):
            occlusion = (total[0] / total[1]).astype(np.float32)
        occlusion[~targets.known | (total[1] == 0)] = 1
        return transmittance, occlusion

    def _light(
        self, targets: Targets, thick: float, place: VectorLike, near: bool
    ) -> tuple[Array, Array]:
        """Return the share of a light that is left, twice."""
        if not near:
            toward = _frame(place)[2].astype(np.float32)
            depth, _ = self.depths(targets.places, toward)
            left = _left(depth, targets.own(toward), thick)
        else:
            lamp = (np.asarray(place, np.float64) - self.origin) / self.voxel
            depth, width = self.near_depth(targets.places, lamp, thick)
            way = lamp[:, np.newaxis] - targets.places
            way /= np.maximum(_size(way), NARROWEST)
            width = np.maximum(width, NARROWEST)
            own = targets.own(way.astype(np.float32), width) * _crowding(thick / width)
            left = np.exp(np.minimum(-thick * (depth - own), 0))
        return left, left

    def _pair(self, targets: Targets, thick: float, toward: Array) -> tuple[Array, Array]:
        """Return the weighted share of light from a direction and its opposite, and the weight."""
        toward = toward.astype(np.float32)
        own, facing = targets.own(toward), targets.facing(toward)
        forth, back = (_left(d, own, thick) for d in self.depths(targets.places, toward))
        return facing[0] * forth + facing[1] * back, facing.sum(axis=0)

    def crowded(self, targets: Targets, count: int) -> float:
        """Return the median over points of the depth per diameter, as a mean over directions."""
        total = np.zeros(targets.places.shape[1])
        ways = directions(count)
        for way in ways:
            forth, back = self.depths(targets.places, way)
            total += (forth + back) / 2 - targets.own(way.astype(np.float32))
        return float(np.median(total[targets.known]) / len(ways)) if targets.known.any() else 0.0


class _Cone(NamedTuple):
    """One of the six pyramids around a light, cut into cones of an angular width."""

    axis: int
    side: int
    width: float

    def seen(self, rows: Array) -> Array:
        """Return the tangents of the two angles under which the light sees rows, in widths."""
        height = self.side * rows[self.axis]
        others = [i for i in range(3) if i != self.axis]
        seen: Array = rows[others] / (height * self.width)
        return seen

    def depth(self, seen: Array, far: Array, held: Array, gone: Array, across: Array) -> Array:
        """Return the depth between the light and points at distances, for pieces at distances."""
        reach = far.max()
        low = seen.min(axis=1, keepdims=True) - 2
        high = seen.max(axis=1, keepdims=True) + 2
        inside = ((held > low) & (held < high)).all(axis=0) & (gone < reach + 2)
        if not inside.any():
            return np.zeros(len(far), np.float32)
        held, gone, across = held[:, inside], gone[inside], across[inside]
        # Height over the light of the plane that is divided into squares, in voxels.
        slant = np.sqrt(1 + self.width**2 * (held * held).sum(axis=0))
        area = (self.width * gone) ** 2 / slant**3
        rows = np.concatenate([held, gone[np.newaxis]])
        low, shape = _box(rows)
        grid = spread((rows - low).astype(np.float32), across / area, shape)
        _summed(grid)
        cells = np.concatenate([seen, far[np.newaxis]]) - low
        limits = np.array(shape, np.float64)[:, np.newaxis] - 2
        return read(grid, np.clip(cells, 0, limits).astype(np.float32))


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
    first = segment_starts(connectivity, offsets)
    ends = points[connectivity].astype(np.float64)
    finite: Bools = np.asarray(np.isfinite(ends).all(axis=1))
    first = first[finite[first] & finite[first + 1]]
    origin: Array = np.zeros(3)
    if finite.any():
        origin = ends[finite].min(axis=0) / 2 + ends[finite].max(axis=0) / 2
    start = (ends[first] - origin) / voxel
    vector = (ends[first + 1] - origin) / voxel - start
    parts = np.maximum(1, np.ceil(np.linalg.norm(vector, axis=1) - 1e-9)).astype(np.intp)
    middles, vectors = _cut((start + vector / 2).T, vector.T, parts)
    return Medium(middles.astype(np.float32), vectors.astype(np.float32), origin, voxel)


def _cut(middles: Array, vectors: Array, parts: Indices) -> tuple[Array, Array]:
    """Return pieces, given by columns, each cut to some parts of equal lengths."""
    owner = np.repeat(np.arange(len(parts)), parts)
    number = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
    share = 1 / parts[owner]
    place = (number + 0.5) * share - 0.5
    vectors = np.take(vectors, owner, axis=1)
    return np.take(middles, owner, axis=1) + place * vectors, vectors * share


def segment_starts(connectivity: Indices, offsets: Indices, /) -> Indices:
    """Return the indices in the connectivity at which a segment starts; the next one is its end."""
    inside = np.ones(len(connectivity), np.bool_)
    inside[offsets[1:][np.diff(offsets) > 0] - 1] = False
    return np.flatnonzero(inside)


def line_lengths(points: Array, connectivity: Indices, offsets: Indices, /) -> Array:
    """Return the length of the longest line that each point belongs to, 0 for none."""
    first = segment_starts(connectivity, offsets)
    ends = points[connectivity].astype(np.float64)
    size = np.zeros(len(connectivity) + 1)
    size[first] = np.linalg.norm(ends[first + 1] - ends[first], axis=1)
    size[~np.isfinite(size)] = 0
    along = np.concatenate([[0.0], np.cumsum(size)])
    length = along[offsets[1:]] - along[offsets[:-1]]
    found = np.zeros(len(points))
    np.maximum.at(found, connectivity, np.repeat(length, np.diff(offsets)))
    return found


def check_count(name: str, value: object, /) -> int:
    """Return an even number of 2 or more.

    Raises
    ------
    TypeError, ValueError
        If it is none.
    """
    count = _check.integer(name, value, low=2)
    if count % 2:
        raise ValueError(_check.message(name, "an even number", count))
    return count


def _size(rows: Array) -> Array:
    """Return the lengths of vectors in columns."""
    size: Array = np.sqrt((rows * rows).sum(axis=0))
    return size


def _crowding(thick: Array) -> Array:
    """Return the factor of the depth in voxels, from the diameter of the lines in voxels.

    It is ``1 + d / 4`` where voxels are much wider than lines, as for a light at infinity: -log(1 -
    d / 2) is the depth that leaves the light which a line of half the width leaves.
    """
    share = np.minimum(2 * CROWDING * thick, WIDEST)
    factor: Array = -np.log1p(-share) / np.maximum(share, NARROWEST)
    return np.where(share > NARROWEST, factor, 1)


def _for_cones(
    middles: Array, vectors: Array, width: float, thick: float
) -> tuple[Array, Array, Array]:
    """Return pieces cut again where cones from a light are narrower, and the share of each.

    A piece is cut along its length, and into parallel pieces over the width of the line.
    """
    cone = np.maximum(width * _size(middles), NARROWEST)
    parts = np.ceil(np.clip(_size(vectors) / cone, 1, MOST_PARTS)).astype(np.intp)
    middles, vectors = _cut(middles, vectors, parts)
    cone = np.maximum(width * _size(middles), NARROWEST)
    across = np.cross(vectors, middles, axis=0)
    across *= thick / np.maximum(_size(across), NARROWEST**2)
    parts = np.ceil(np.clip(2 * thick / cone, 1, MOST_ACROSS)).astype(np.intp)
    middles, across = _cut(middles, across, parts)
    return middles, np.repeat(vectors, parts, axis=1), np.repeat(1 / parts, parts)


def _left(depth: Array, own: Array | float, thick: float, /) -> Array:
    """Return the share of light that is left behind lines of a diameter, in voxels."""
    others = depth - own
    others *= -thick * (1 + CROWDING * thick)
    left: Array = np.exp(np.minimum(others, 0, out=others), out=others)
    return left


def _frame(toward: VectorLike) -> Array:
    """Return an orthonormal frame, in rows, whose last row is a direction."""
    w = np.asarray(toward, np.float64) / np.linalg.norm(toward)
    u = np.cross(w, np.eye(3)[np.argmin(np.abs(w))])
    u /= np.linalg.norm(u)
    return np.stack([u, np.cross(w, u), w])


def _box(rows: Array) -> tuple[Array, tuple[int, int, int]]:
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
    for index, weight in _corners(cells, shape):
        flat += np.bincount(index, weights=weight * values, minlength=size)
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
    return _both(grid, None, cells)[1]


def _summed(grid: Array) -> Array:
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


def _both(grid: Array, total: Array | None, cells: Array) -> tuple[Array, Array]:
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


@_compiled.kernel(rounding=_compiled.ROUNDING)
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


@_compiled.kernel(rounding=_compiled.ROUNDING)
def _read(
    grid: Array, total: Array, cells: Array, rows: int, columns: int, forth: Array, back: Array
) -> None:
    """Take values from the 8 voxels around places, and what is left of the total of columns."""
    x, y, z = cells[0], cells[1], cells[2]
    one, whole = np.float32(1), len(total) > 0
    for i in range(len(back)):
        p, q, r = int(x[i]), int(y[i]), int(z[i])
        f, g, h = x[i] - np.float32(p), y[i] - np.float32(q), z[i] - np.float32(r)
        line = p * rows + q
        value = beyond = np.float32(0)
        for share in (one - f, f):
            at = line * columns + r
            low = grid[at] * (one - h) + grid[at + 1] * h
            high = grid[at + columns] * (one - h) + grid[at + columns + 1] * h
            value += share * (low * (one - g) + high * g)
            if whole:
                beyond += share * (total[line] * (one - g) + total[line + 1] * g)
            line += rows
        back[i] = value
        if whole:
            forth[i] = beyond - value
