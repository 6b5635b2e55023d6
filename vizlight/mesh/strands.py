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


class Grown(NamedTuple):
    """A block of F fibres of m points, in float32 and component by component.

    ``offsets`` (m, 3, F) are points minus roots; ``ways`` and ``normals`` (3, F) are unit vectors.
    """

    roots: Array
    offsets: Array
    ways: Array
    normals: Array
    inside: Bools | None


class Strands:
    """Fibres as rows for the engine, which reads one block after the other and each block once.

    The vectors of a block are kept while a thread works on it; only points are kept for all.
    ``unit`` is the length in which the heights of fur are counted.
    """

    def __init__(
        self,
        grow: Callable[[slice], Grown],
        count: int,
        m: int,
        kind: np.dtype[np.floating],
        *,
        straight: bool,
        unit: float = 1.0,
    ) -> None:
        self._grow, self._straight = grow, straight
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
        share = POINTS_AT_ONCE // (self.m * _pool.workers())
        return min(SEED_BLOCK, 1 << max(share, 1).bit_length() - 1)

    def inputs(self, *, normals: bool, fur: float, origin: Vector) -> ShadingInputs:
        """Return the inputs of the engine, for light through fur of a density."""
        count, m = self.points.shape[:2]
        tangents = (lambda rows: self._at(rows)[0].ways.T) if self._straight else self._tangents
        upright = lambda rows: self._at(rows)[0].normals.T  # noqa: E731
        rows = count if self._straight else count * m
        single = np.dtype(np.float32)
        return ShadingInputs(
            points=_Rows((count * m, 3), self.points.dtype, self._points),
            tangents=_Rows((rows, 3), single, tangents),
            normals=_Rows((count, 3), single, upright) if normals else None,
            fur_height=_Rows((count * m,), single, self._heights) if fur else None,
            fur=fur,
            repeat=m,
            block=self.block,
            origin=origin,
            generated=True,
        )

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

    def _tangents(self, rows: slice) -> Array:
        """Return tangents, of any length, of the parabola through three points.

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
