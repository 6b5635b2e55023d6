"""Arrays in n-space on a mesh: turned, cut by a hyperplane and projected, block by block."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight import _check, _pool
from vizlight._version import __version__
from vizlight.geometry.nspace import projection, slices
from vizlight.mesh import cutting, point_arrays, records
from vizlight.model.frames import default_rtol

if TYPE_CHECKING:
    from collections.abc import Callable

    from vizlight._types import Array, Bools, VectorLike

POSITION, FRAME, PROJECTED, RECORD = "position", "frame", "projected_", "projection"
#: Number of rows worked on at once, in float64.
BLOCK = 1 << 15


class Counter:
    """A count that is reported when it grows."""

    def __init__(self, report: Callable[[int], None]) -> None:
        self.count, self._report = 0, report

    def add(self, more: int) -> None:
        """Count more and report the sum."""
        self.count += more
        self._report(self.count)


@dataclass(frozen=True)
class Turning:
    """What :func:`project` does to each mesh, with its options."""

    rotation: object
    hyperplane: tuple[VectorLike, float] | None
    distance: float | None
    positions: str
    frame: str | None
    vectors: tuple[str, ...]
    cut: bool

    def turned(self, mesh: pv.DataSet, done: Counter, lost: Counter) -> pv.DataSet:
        """Return a mesh turned and cut; its points stay where they are."""
        if isinstance(mesh, pv.ImageData | pv.RectilinearGrid):
            mesh = mesh.cast_to_structured_grid()
        out = mesh.copy(deep=False)
        # The mesh that is given keeps its points; its normals are not those of the result.
        out.point_data.active_normals_name = None
        arrays = self._arrays(out)
        n = arrays[self.positions].shape[1]
        matrix = None if self.rotation is None else projection.rotation(n, self.rotation)
        plane = None if self.hyperplane is None else _plane(self.hyperplane, n)
        record = _record(self, mesh, matrix)
        for name, array in arrays.items():
            if matrix is not None:
                rows = array.shape[1] // n
                array = _blocks(
                    lambda x, rows=rows: projection.turn(x.reshape(-1, rows, n), matrix), array
                )
            point_arrays.attach_rows(out, name, array)
        if plane is not None:
            out = self._sliced(out, *plane, lost)
        out.field_data[records.key(RECORD)] = [record]
        done.add(mesh.n_points)
        return out

    def _arrays(self, mesh: Any) -> dict[str, Array]:
        """Return the arrays that turn, by name, each checked."""
        position = _named(mesh, "positions", self.positions)
        n = position.shape[1]
        if n < 2:
            got = f"{self.positions!r} with 1"
            raise ValueError(_check.message("positions", "2 components or more", got))
        found = {self.positions: position}
        given = [("vectors", name) for name in self.vectors]
        if self.frame is not None:
            given.append(("frame", self.frame))
        for argument, name in given:
            array = _named(mesh, argument, name)
            most = n - 1 if argument == "frame" else array.shape[1]
            if array.shape[1] % n or not 0 < array.shape[1] // n <= most:
                expected = f"a point array of {n} k components, rows of {n}, as positions have"
                got = f"{name!r} with {array.shape[1]}"
                raise ValueError(_check.message(argument, expected, got))
            found[name] = array
        ours = records.key(RECORD) in mesh.field_data
        for name in list(found)[1:]:
            if PROJECTED + name in mesh.point_data and not ours:
                expected = "a mesh without an array of that name of its own"
                remedy = "rename that array"
                raise ValueError(_check.message("mesh", expected, repr(PROJECTED + name), remedy))
        return {
            name: array if array.dtype.kind == "f" else array.astype(np.float64)
            for name, array in found.items()
        }

    def _sliced(self, mesh: Any, normal: Array, offset: float, lost: Counter) -> Any:
        position = np.asarray(mesh.point_data[self.positions])
        heights = np.empty(len(position))
        with np.errstate(all="ignore"):
            for block in _pool.blocks(len(position), BLOCK):
                heights[block] = position[block].astype(np.float64) @ normal - offset
        bad = int(np.count_nonzero(~np.isfinite(heights)))
        if bad:
            self._count_lost(bad, len(heights), "finite points", lost)
        n = len(normal)
        if self.frame is None:
            return cutting.cut(mesh, heights)
        k = mesh.point_data[self.frame].shape[1] // n
        if k == 1:
            del mesh.point_data[self.frame]
            return cutting.cut(mesh, heights)
        out = cutting.cut(mesh, heights, spaces={self.frame: n})
        tangents = np.asarray(out.point_data[self.frame])
        rtol = default_rtol(n, tangents.dtype)
        rows = _blocks(
            lambda x: slices.slice_frame(x.reshape(-1, k, n), normal, rtol=rtol), tangents, k - 1, n
        )
        del out.point_data[self.frame]
        point_arrays.attach_rows(out, self.frame, rows)
        return out

    def _count_lost(self, count: int, total: int, expected: str, lost: Counter) -> None:
        """Count points that cannot be shown, if they may be left out."""
        if not self.cut:
            got = f"{count} of {total} points that are not"
            remedy = "leave them out by cut=True"
            if self.distance is not None:
                remedy = "move the eye away by distance=, or " + remedy
            raise ValueError(_check.message("mesh", expected, got, remedy))
        lost.add(count)

    def projected(self, mesh: Any, done: Counter, lost: Counter) -> Any:
        """Return a mesh projected to 3-space."""
        position = np.asarray(mesh.point_data[self.positions])
        n = position.shape[1]
        points, good = self._points(position)
        if not good.all():
            expected = "points before the eye's hyperplane, and finite"
            self._count_lost(int(np.count_nonzero(~good)), len(good), expected, lost)
            mesh = _without(mesh, ~good)
            position = np.asarray(mesh.point_data[self.positions])
            points, _ = self._points(position)
        out = mesh.copy(deep=False)
        out.SetPoints(pv.vtk_points(points))
        for name in self.vectors:
            point_arrays.attach_rows(out, PROJECTED + name, self._image(out, name, position))
        if self.frame is not None:
            name = PROJECTED + self.frame
            out.point_data.pop(name, None)
            # Three directions fill 3-space: there is no frame that light could use.
            if self.frame in out.point_data and out.point_data[self.frame].shape[1] < 3 * n:
                point_arrays.attach_rows(
                    out, name, self._image(out, self.frame, position, space=True)
                )
        done.add(mesh.n_points)
        return out

    def _points(self, position: Array) -> tuple[Any, Bools]:
        """Return places in 3-space, and which of them can be seen.

        These are finite, and before the eye's hyperplane by more than rounding.
        """
        points = np.empty((len(position), 3), dtype=position.dtype)
        good = np.empty(len(position), dtype=np.bool_)
        rounding = 4 * np.finfo(position.dtype).eps
        with np.errstate(all="ignore"):
            for block in _pool.blocks(len(position), BLOCK):
                part = position[block].astype(np.float64, copy=False)
                image, depth = projection.image_and_depth(part, distance=self.distance)
                points[block] = image
                good[block] = np.all(np.isfinite(part), axis=1) & (depth > rounding)
                good[block] &= np.all(np.isfinite(points[block]), axis=1)
        return points, good

    def _image(self, mesh: Any, name: str, position: Array, *, space: bool = False) -> Array:
        """Return the vectors of an array as the projection's derivative takes them to 3-space.

        With ``space`` they are tangents: an orthonormal frame of what their images span.
        """
        vectors, n = np.asarray(mesh.point_data[name]), position.shape[1]
        rows = vectors.shape[1] // n
        # Orthographic images do not depend on the places.
        rough = [vectors.dtype] if self.distance is None else [vectors.dtype, position.dtype]
        rtol = max(default_rtol(n, dtype) for dtype in rough)

        def work(x: Array, p: Array) -> Array:
            x = x.reshape(-1, rows, n)
            found: Array = (
                projection.push_frame(x, p, distance=self.distance, rtol=rtol)[0]
                if space
                else projection.push_forward(x, p, distance=self.distance)
            )
            return found

        return _blocks(work, vectors, rows, 3, position)


def _blocks(
    work: Callable[..., Array], array: Array, rows: int | None = None, n: int = 1, *others: Array
) -> Array:
    """Return work done on float64 blocks of an array, in the array's own type.

    The result has ``rows`` vectors of n components a point, or as many numbers as the array.
    """
    width = array.shape[1] if rows is None else rows * n
    out = np.empty((len(array), width), dtype=array.dtype)
    with np.errstate(all="ignore"):
        for block in _pool.blocks(len(array), BLOCK):
            parts = [part[block].astype(np.float64, copy=False) for part in (array, *others)]
            out[block] = work(*parts).reshape(-1, width)
    return out


def _named(mesh: Any, argument: str, name: Any) -> Array:
    if not isinstance(name, str):
        raise TypeError(_check.message(argument, "the name of a point array", repr(name)))
    return point_arrays.array_of(mesh, argument, name)


def _without(mesh: Any, lost: Bools) -> Any:
    """Return a mesh without some points and the cells that have one."""
    before = set(mesh.point_data), set(mesh.cell_data)
    grid = mesh.extract_points(~lost, adjacent_cells=False, progress_bar=False)
    if isinstance(mesh, pv.PolyData):
        grid = grid.extract_surface(algorithm="geometry", pass_pointid=False, pass_cellid=False)
    for data, kept in zip((grid.point_data, grid.cell_data), before, strict=True):
        for name in set(data) - kept:
            del data[name]
    for name in before[0] - set(grid.point_data):  # where no point is left
        point_arrays.attach_rows(grid, name, np.asarray(mesh.point_data[name])[:0])
    for key, value in mesh.field_data.items():
        grid.field_data[key] = value
    return grid


def _plane(hyperplane: Any, n: int) -> tuple[Array, float]:
    """Return a hyperplane's unit normal and its offset."""
    expected = f"(normal of {n} components, offset)"
    if not isinstance(hyperplane, tuple | list) or len(hyperplane) != 2:
        raise TypeError(_check.message("hyperplane", expected, _check.describe(hyperplane)))
    normal = np.array(_check.vector("hyperplane", hyperplane[0], direction=True))
    if len(normal) != n:
        got = f"a normal of {len(normal)}"
        raise ValueError(_check.message("hyperplane", expected, got))
    normal /= np.abs(normal).max()
    return normal / np.linalg.norm(normal), _check.number("hyperplane", hyperplane[1])


def _record(job: Turning, mesh: Any, matrix: Array | None) -> str:
    """Return what is done to a mesh, and what was before, as a line of JSON."""
    plane = job.hyperplane
    return json.dumps(
        {
            "vizlight": __version__,
            "filter": "project",
            "rotation": None if matrix is None else matrix.tolist(),
            "hyperplane": None
            if plane is None
            else [[float(x) for x in plane[0]], float(plane[1])],
            "distance": job.distance,
            "positions": job.positions,
            "frame": job.frame,
            "vectors": list(job.vectors),
            "cut": job.cut,
            "earlier": records.read(mesh, RECORD),
        }
    )
