"""Fibres with equal numbers of points, grown block by block when the engine reads them."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyvista as pv

from vizlight import _pool
from vizlight.geometry.lines.fur import SEED_BLOCK
from vizlight.shading.inputs import ShadingInputs

if TYPE_CHECKING:
    from collections.abc import Callable

    from vizlight._types import Array, Bools, Vector

#: Number of points that all threads grow at once: few compared with the points that are kept, but
#: enough that threads seldom wait for the interpreter.
POINTS_AT_ONCE = 1 << 18
#: The same where compiled code fills blocks, which the cache of a processor should hold.
POINTS_FILLED = 1 << 16


class Grown(NamedTuple):
    """A block of F fibres of m points, in float32 and component by component.

    ``offsets`` (m, 3, F) are points minus roots; ``ways`` and ``normals`` (3, F) are unit vectors.
    """

    roots: Array
    offsets: Array
    ways: Array
    normals: Array
    inside: Bools | None


class Room(NamedTuple):
    """Flat arrays that compiled code fills for a block of fibres, point after point.

    ``normals`` and ``heights`` are empty where they are not needed; ``inside`` is per fibre.
    """

    points: Array
    tangents: Array
    normals: Array
    heights: Array
    inside: Bools


class Strands:
    """Fibres as rows for the engine, which reads one block after the other and each block once.

    The vectors of a block are kept while a thread works on it; only points are kept for all.
    ``unit`` is the length in which the heights of fur are counted. ``fill`` writes all of a block
    at once in place of ``grow``.
    """

    def __init__(
        self,
        grow: Callable[[slice], Grown],
        count: int,
        m: int,
        kind: np.dtype[np.floating],
        *,
        straight: bool,
        threads: int | None,
        unit: float = 1.0,
        fill: Callable[[slice, Room], None] | None = None,
    ) -> None:
        self._grow, self._straight, self._threads = grow, straight, threads
        self._fill, self._needed = fill, (False, False)
        self._block, self._unit = threading.local(), np.float32(unit)
        self.points = np.empty((count, m, 3), kind)
        self.inside = np.zeros(count, np.bool_)

    @property
    def m(self) -> int:
        """Number of points of a fibre."""
        return int(self.points.shape[1])

    @property
    def block(self) -> int:
        """Number of fibres in a block, a power of two so that no block has seeds of two blocks."""
        at_once = POINTS_AT_ONCE if self._fill is None else POINTS_FILLED
        share = at_once // (self.m * _pool.workers(self._threads))
        return min(SEED_BLOCK, 1 << max(share, 1).bit_length() - 1)

    def inputs(self, *, normals: bool, fur: float, origin: Vector) -> ShadingInputs:
        """Return the inputs of the engine, for light through fur of a density."""
        count, m = self.points.shape[:2]
        tangents = self._ways if self._straight else self._tangents
        rows = count if self._straight else count * m
        single = np.dtype(np.float32)
        if self._fill is not None:
            self._needed = normals, bool(fur)
            return ShadingInputs(
                points=_Rows((count * m, 3), self.points.dtype, lambda rows: self._made(rows, 0)),
                tangents=_Rows((count * m, 3), single, lambda rows: self._made(rows, 1)),
                normals=(
                    _Rows((count * m, 3), single, lambda rows: self._made(rows, 2))
                    if normals
                    else None
                ),
                fur_height=(
                    _Rows((count * m,), single, lambda rows: self._made(rows, 3)) if fur else None
                ),
                fur=fur,
                block=self.block * m,
                origin=origin,
                generated=True,
            )
        return ShadingInputs(
            points=_Rows((count * m, 3), self.points.dtype, self._points),
            tangents=_Rows((rows, 3), single, tangents),
            normals=_Rows((count, 3), single, self._normals) if normals else None,
            fur_height=_Rows((count * m,), single, self._heights) if fur else None,
            fur=fur,
            repeat=m,
            block=self.block,
            origin=origin,
            generated=True,
        )

    def _made(self, rows: slice, part: int) -> Array:
        """Return some rows of an array of :class:`Room`, whose block is filled if it is another."""
        m = self.m
        fibres = slice(rows.start // m, -(-rows.stop // m))
        if getattr(self._block, "fibres", None) != fibres:
            assert self._fill is not None
            count = (fibres.stop - fibres.start) * m
            kept: Array | None = getattr(self._block, "room", None)
            if kept is None or kept.shape[1] < count:
                kept = self._block.room = np.empty((7, count), np.float32)
            widths = (3, 3 * self._needed[0], self._needed[1])
            vectors = [
                kept[i : i + w].reshape(-1)[: w * count]
                for i, w in zip((0, 3, 6), widths, strict=True)
            ]
            points = self.points[fibres].reshape(-1)
            room = Room(points, vectors[0], vectors[1], vectors[2], self.inside[fibres])
            self._fill(fibres, room)
            self._block.fibres, self._block.made = fibres, room
        found: Array = self._block.made[part]
        if part < 3:
            found = found.reshape(-1, 3)
        return found[rows.start - fibres.start * m : rows.stop - fibres.start * m]

    def _at(self, rows: slice) -> tuple[Grown, int]:
        """Return the block that rows belong to, and the index of their point within each fibre."""
        step = rows.step or 1
        fibres = slice(rows.start // step, rows.start // step + len(range(*rows.indices(1 << 62))))
        if getattr(self._block, "fibres", None) != fibres:
            block = self._grow(fibres)
            points = self.points[fibres]
            # One component at a time: NumPy is slow where the innermost axis has three.
            for j, offset in enumerate(block.offsets):
                for i in range(3):
                    np.add(block.roots[i], offset[i], out=points[:, j, i])
            if block.inside is not None:
                self.inside[fibres] = block.inside
            self._block.fibres, self._block.grown = fibres, block
            self._block.heights = None
        grown: Grown = self._block.grown
        return grown, rows.start % step

    def _points(self, rows: slice) -> Array:
        self._at(rows)
        return self.points.reshape(-1, 3)[rows]

    def _ways(self, rows: slice) -> Array:
        return self._at(rows)[0].ways.T

    def _normals(self, rows: slice) -> Array:
        return self._at(rows)[0].normals.T

    def _tangents(self, rows: slice) -> Array:
        """Return tangents of any length, those of the parabola through three points.

        The tangent of a fibre of length 0 is the direction in which it would grow.
        """
        block, j = self._at(rows)
        offset, last = block.offsets, self.m - 1
        if last == 1:
            tangent = offset[1].copy()
        elif j in (0, last):
            near, far = (1, 2) if j == 0 else (last - 1, last - 2)
            tangent = (3 * (offset[near] - offset[j]) - (offset[far] - offset[near])) * (
                1 if j == 0 else -1
            )
        else:
            tangent = offset[j + 1] - offset[j - 1]
        lost = ~np.any(tangent, axis=0)
        if lost.any():
            tangent[:, lost] = block.ways[:, lost]
        result: Array = tangent.T
        return result

    def _heights(self, rows: slice) -> Array:
        """Return the height above each point of the highest point of its fibre, in units."""
        block, j = self._at(rows)
        last = self.m - 1
        heights: Array | None = self._block.heights
        if heights is None:
            # Of a straight fibre the tip is enough.
            offsets = block.offsets[last:] if self._straight else block.offsets
            heights = np.einsum("jib,ib->jb", offsets, block.normals) / self._unit
            self._block.heights = heights
        if self._straight:
            tip: Array = heights[0]
            return np.asarray(np.maximum(tip, 0) - np.float32(j / last) * tip)
        return np.asarray(heights.max(axis=0) - heights[j])

    def mesh(self) -> pv.PolyData:
        """Return the fibres as lines; their points are not copied."""
        count, m, _ = self.points.shape
        # Indices of 32 bits take half the memory.
        number = np.int32 if count * m < 2**31 else np.int64
        offsets = np.arange(0, count * m + 1, m, dtype=number)
        out = pv.PolyData()
        out.points = self.points.reshape(-1, 3)
        out.SetLines(pv.CellArray.from_arrays(offsets, np.arange(count * m, dtype=number)))
        return out


class _Rows:
    """Rows that are computed on demand."""

    def __init__(
        self, shape: tuple[int, ...], kind: np.dtype[np.generic], make: Callable[[slice], Array]
    ) -> None:
        self.shape, self.dtype = shape, kind
        self._make = make

    def __getitem__(self, rows: slice, /) -> Array:
        return self._make(rows)
