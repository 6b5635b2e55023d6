"""Fibres of one number of points each, and the rows that light them, made when asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Array = NDArray[np.floating[Any]]


class Strands:
    """Fibres of one number of points each, (F, m, 3), with the normals at their roots."""

    def __init__(self, points: Array, root_normals: Array, *, straight: bool) -> None:
        self.points, self._normals = points, root_normals
        self._straight = straight or points.shape[1] == 2
        self.n_points = points.shape[0] * points.shape[1]

    def normals(self) -> _Rows:
        """Return the root's normal for each point."""
        m = self.points.shape[1]
        return _Rows(self.points, lambda f: np.repeat(self._normals[f], m, axis=0), 3)

    def tangents(self) -> _Rows:
        """Return tangents by the parabola through three points, of no particular length."""

        def rows(f: slice) -> Array:
            part = self.points[f]
            m = part.shape[1]
            if self._straight:
                return np.repeat(part[:, -1] - part[:, 0], m, axis=0)
            step = part[:, 1:] - part[:, :-1]
            tangent = np.empty_like(part)
            tangent[:, 1:-1] = step[:, 1:] + step[:, :-1]
            tangent[:, 0] = 3 * step[:, 0] - step[:, 1]
            tangent[:, -1] = 3 * step[:, -1] - step[:, -2]
            return tangent.reshape(-1, 3)

        return _Rows(self.points, rows, 3)

    def depth(self) -> _Rows:
        """Return how far the highest point of its fibre stands above each point."""

        def rows(f: slice) -> Array:
            part, normal = self.points[f], self._normals[f]
            last = part.shape[1] - 1
            depth = np.zeros(part.shape[:2], part.dtype)
            top = np.zeros(len(part), part.dtype)
            if self._straight:
                tip = np.einsum("ij,ij->i", part[:, last] - part[:, 0], normal)
            for j in range(1, last + 1):
                if self._straight:
                    height = tip * part.dtype.type(j / last)
                else:
                    height = np.einsum("ij,ij->i", part[:, j] - part[:, 0], normal)
                depth[:, j] = height
                np.maximum(top, height, out=top)
            for j in range(last + 1):
                np.subtract(top, depth[:, j], out=depth[:, j])
            return depth.reshape(-1)

        return _Rows(self.points, rows, None)

    def mesh(self) -> pv.PolyData:
        """Return the fibres as lines; their points are not copied."""
        count, m, _ = self.points.shape
        # Numbers of 32 bits, where they suffice, take half the memory.
        number = np.int32 if self.n_points < 2**31 else np.int64
        offsets = np.arange(0, count * m + 1, m, dtype=number)
        out = pv.PolyData()
        out.points = self.points.reshape(-1, 3)
        out.SetLines(pv.CellArray.from_arrays(offsets, np.arange(count * m, dtype=number)))
        return out


class _Rows:
    """Rows that are made fibre by fibre when the engine asks for them."""

    def __init__(self, points: Array, make: Callable[[slice], Array], n: int | None) -> None:
        count, self._m, _ = points.shape
        self.dtype = points.dtype
        self.shape: tuple[int, ...] = (count * self._m,) if n is None else (count * self._m, n)
        self._make = make

    def __getitem__(self, rows: slice, /) -> Array:
        start, stop, _ = rows.indices(self.shape[0])
        first = start // self._m
        made = self._make(slice(first, -(-stop // self._m)))
        return made[start - first * self._m : stop - first * self._m]
