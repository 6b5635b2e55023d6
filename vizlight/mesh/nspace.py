"""Rotation, section by a hyperplane and projection of the arrays of a mesh in n-space."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pyvista as pv
import scipy

from vizlight import _check, _pool
from vizlight._types import AnyArray, Array, Bools, Indices, Sparse, VectorLike
from vizlight._version import __version__
from vizlight.geometry.nspace import projection, slices
from vizlight.mesh import blocks, meaning, records
from vizlight.model.frames import default_rtol
from vizlight.shading.results import Record, plain
from vizlight.vtk import polylines
from vizlight.vtk.arrays import array_of
from vizlight.vtk.cells import has_faces

POSITION, FRAME, PROJECTED, RECORD = "position", "frame", "projected_", "projection"
#: Least gap of the eigenvalues of a mean of projections onto tangent spaces, from 0 to 1, at which
#: the spaces have a limit.
AGREEMENT = 0.8
#: Number of rows that are processed at once, in float64.
BLOCK = 1 << 15


#: Most points of a mesh that are compared with their neighbours, and the number of these with each
#: point itself.
SAMPLE, NEIGHBOURS = 2000, 5
#: Distance of two points in n-space over that of their images from which they are of two sheets,
#: and the share of the points near another sheet from which the image covers itself.
FOLDED, COVERED = 5.0, 0.3
#: Deviation of the distances from the origin, as a share of them, up to which points are on a
#: sphere, and their largest coordinate along the last axis, in radii, that is not near its pole.
ON_SPHERE, FROM_POLE = 0.01, 0.9


class Counter:
    """A sum that is reported after each addition."""

    def __init__(self, report: Callable[[int], None]) -> None:
        self.count, self._report = 0, report

    def add(self, more: int) -> None:
        """Add a number and report the sum."""
        self.count += more
        self._report(self.count)


@dataclass(frozen=True)
class Turning:
    """The steps of :func:`vizlight.project` on one mesh, and their options."""

    rotation: object
    hyperplane: tuple[VectorLike, float] | None
    distance: float | None
    positions: str
    frame: str | None
    turned: tuple[str, ...]
    cut: bool

    def rotated(self, mesh: pv.DataSet, done: Counter, lost: Counter) -> pv.DataSet:
        """Return a mesh with its arrays rotated, and cut by the hyperplane; not yet projected."""
        # These have axes in place of points, which projected points do not follow.
        if isinstance(mesh, pv.ImageData | pv.RectilinearGrid):
            mesh = mesh.cast_to_structured_grid()
        # Deep: the result shares no memory with the mesh, arrays that nothing is done to included.
        out = mesh.copy(deep=True)
        # The normals of the mesh are not the result's.
        out.point_data.active_normals_name = None
        arrays = self._arrays(out)
        n = arrays[self.positions].shape[1]
        matrix = None if self.rotation is None else projection.rotation(n, self.rotation)
        plane = None if self.hyperplane is None else _plane(self.hyperplane, n)
        # The record has the matrix, in whatever form the rotation was given: JSON keeps all digits.
        exact = None if matrix is None else matrix.tolist()
        for name, array in arrays.items():
            if matrix is not None:
                # An array of k vectors has k n columns, and each of its vectors turns like a
                # position.
                array = _blocks(lambda x: projection.turn(x.reshape(len(x), -1, n), matrix), array)
            records.attach_rows(out, name, array)
        # The hyperplane is one of the turned space, so the cut comes second.
        if plane is not None:
            out = self._sliced(out, *plane, lost)
            # Arrays by vizlight stay its own on the cut, where new light may replace them.
            records.carry(mesh, out)
        records.write(out, RECORD, self._record(exact, records.read(mesh, RECORD)))
        done.add(mesh.n_points)
        return out

    def _record(self, rotation: object, earlier: object) -> Record:
        """Return the record of the steps, given the rotation as a matrix and the earlier record."""
        plane = self.hyperplane
        exact = {
            "rotation": rotation,
            "hyperplane": plane and [[float(x) for x in plane[0]], float(plane[1])],
            "earlier": earlier,
        }
        return {"vizlight": __version__, "filter": "project"} | plain(self) | exact

    def _arrays(self, mesh: pv.DataSet) -> dict[str, Array]:
        """Check the arrays that are rotated, and return them by name."""
        if self.positions == POSITION and POSITION not in mesh.point_data:
            got = f"a mesh without the point array {POSITION!r}"
            remedy = (
                "vizlight.manifold makes a mesh of a manifold in n-space; of your own, attach the "
                "places as a point array of n components and pass positions="
            )
            raise _check.value_error("positions", "places in n-space", got, remedy)
        position = _named(mesh, "positions", self.positions)
        n = position.shape[1]
        # A rotation needs a plane, and so two axes.
        if n < 2:
            got = f"{self.positions!r} with {n}"
            remedy = "name an array of positions in n-space"
            raise _check.value_error("positions", "2 components or more", got, remedy)
        arrays = {self.positions: position}
        has_cells = mesh.GetMaxSpatialDimension() > 0
        if has_cells and self.frame == FRAME and FRAME not in mesh.point_data:
            records.attach_rows(mesh, FRAME, spanned(mesh, position))
        arguments = [("turned", name) for name in self.turned]
        if self.frame is not None:
            arguments.append(("frame", self.frame))
        for argument, name in arguments:
            array = _named(mesh, argument, name)
            # A frame of n tangents spans all of n-space, where no normal is left to light by.
            most = n - 1 if argument == "frame" else array.shape[1]
            if array.shape[1] % n or not 0 < array.shape[1] // n <= most:
                expected = f"a point array of {n} k components, as positions have {n}"
                got = f"{name!r} with {array.shape[1]} components"
                raise _check.value_error(argument, expected, got, "name another array")
            arrays[name] = array
        # Positions have no array of images: these are the points of the result.
        _refuse_overwriting(mesh, [PROJECTED + name for name in list(arrays)[1:]])
        # Integers do not hold turned vectors.
        return {
            name: array if array.dtype.kind == "f" else array.astype(np.float64)
            for name, array in arrays.items()
        }

    def _sliced(self, mesh: pv.DataSet, normal: Array, offset: float, lost: Counter) -> pv.PolyData:
        """Return the section of a mesh by a hyperplane, with its frame restricted to it."""
        position = np.asarray(mesh.point_data[self.positions])
        # Signed distances from the hyperplane, as the normal has length 1. They are in float64,
        # since their sign decides which cells are cut.
        heights = np.empty(len(position))
        with np.errstate(all="ignore"):
            for block in _pool.blocks(len(position), BLOCK):
                heights[block] = position[block].astype(np.float64) @ normal - offset
        bad = int(np.count_nonzero(~np.isfinite(heights)))
        if bad:
            self._count_lost(bad, len(heights), "finite points", lost)
        n = len(normal)
        if self.frame is None:
            return cut(mesh, heights)
        k = mesh.point_data[self.frame].shape[1] // n
        # A curve is cut to points, which have no tangents.
        if k == 1:
            del mesh.point_data[self.frame]
            return cut(mesh, heights)
        out = cut(mesh, heights, spaces={self.frame: n})
        tangents = np.asarray(out.point_data[self.frame])
        # By the digits of the array, whose rounding hides a rank; the work is in float64.
        rtol = default_rtol(n, tangents.dtype)
        rows = _blocks(
            lambda x: slices.slice_frame(x.reshape(-1, k, n), normal, rtol=rtol), tangents, k - 1, n
        )
        del out.point_data[self.frame]
        records.attach_rows(out, self.frame, rows)
        return out

    def _count_lost(self, count: int, total: int, expected: str, lost: Counter) -> None:
        """Count points that cannot be cut or projected; raise ValueError if they must be kept."""
        if not self.cut:
            got = f"{count} of {total} points that are not"
            remedy = "drop them by cut=True"
            if self.distance is not None:
                remedy = "move the eye away by distance=, or " + remedy
            raise _check.value_error("mesh", expected, got, remedy)
        lost.add(count)

    def projected(self, mesh: pv.DataSet, done: Counter, lost: Counter) -> pv.DataSet:
        """Return a mesh projected to 3-space."""
        position = np.asarray(mesh.point_data[self.positions])
        n = position.shape[1]
        points, good = self._points(position)
        if not good.all():
            expected = "finite points before the eye's hyperplane"
            self._count_lost(int(np.count_nonzero(~good)), len(good), expected, lost)
            whole, mesh = mesh, _without(mesh, ~good)
            records.carry(whole, mesh)
            position = np.asarray(mesh.point_data[self.positions])
            # Extraction drops the points that no cell is left for, too: rows are those of its
            # result.
            points, _ = self._points(position)
        out = mesh.copy(deep=False)
        out.SetPoints(pv.vtk_points(points))
        for name in self.turned:
            records.attach_rows(out, PROJECTED + name, self._image(out, name, position))
        if self.frame is not None:
            name = PROJECTED + self.frame
            # An image by an earlier projection would be stale.
            out.point_data.pop(name, None)
            # The image of three tangents is all of 3-space, which light cannot use as a frame.
            if self.frame in out.point_data and out.point_data[self.frame].shape[1] < 3 * n:
                records.attach_rows(out, name, self._image(out, self.frame, position, space=True))
        framed = () if self.frame is None else (self.frame,)
        images = [PROJECTED + name for name in (*self.turned, *framed)]
        record = records.read(out, RECORD) or {}
        records.write(out, RECORD, record, [name for name in images if name in out.point_data])
        done.add(mesh.n_points)
        return out

    def _points(self, position: Array) -> tuple[AnyArray, Bools]:
        """Return points in 3-space, and a mask of those that are visible.

        Visible points are finite and before the eye's hyperplane by more than rounding.
        """
        points = np.empty((len(position), 3), dtype=position.dtype)
        good = np.empty(len(position), dtype=np.bool_)
        # Depths are shares of the eye's distance: below the rounding of the positions their sign
        # means nothing, and the image would be anywhere.
        rounding = 4 * np.finfo(position.dtype).eps
        with np.errstate(all="ignore"):
            for block in _pool.blocks(len(position), BLOCK):
                part = position[block].astype(np.float64, copy=False)
                image, depth = projection.image_and_depth(part, distance=self.distance)
                points[block] = image
                good[block] = np.all(np.isfinite(part), axis=1) & (depth > rounding)
                # Near the eye's hyperplane an image in float64 may be too large for the type of the
                # positions.
                good[block] &= np.all(np.isfinite(points[block]), axis=1)
        return points, good

    def _image(self, mesh: pv.DataSet, name: str, position: Array, *, space: bool = False) -> Array:
        """Return the images in 3-space of the vectors of an array by the projection's derivative.

        With ``space`` return an orthonormal frame of the space that the images span.
        """
        vectors, n = np.asarray(mesh.point_data[name]), position.shape[1]
        rows = vectors.shape[1] // n
        # Orthographic images do not depend on the positions.
        rough = [vectors.dtype] if self.distance is None else [vectors.dtype, position.dtype]
        rtol = max(default_rtol(n, dtype) for dtype in rough)

        def work(x: Array, p: Array) -> Array:
            x = x.reshape(-1, rows, n)
            return (
                projection.push_frame(x, p, distance=self.distance, rtol=rtol)[0]
                if space
                else projection.push_forward(x, p, distance=self.distance)
            )

        return _blocks(work, vectors, rows, 3, position)


def spanned(mesh: pv.DataSet, position: Array) -> Array:
    """Return at each point a frame of the space that the cells around it span in n-space.

    It is the space nearest to those of the cells, each by its size. The cells of highest dimension
    k count. The k orthonormal rows, (n_points, k n) for places (n_points, n), are zero at points of
    no cell with a size.
    """
    corners, middles = _simplices(mesh)
    count, n = position.shape
    k = corners.shape[1] - 1
    finite = np.where(np.isfinite(position), position, 0).astype(np.float64)
    places = finite / (np.abs(finite).max(initial=0) or 1.0)
    places = np.concatenate([places, places[middles].mean(axis=1)])[corners]
    axes, factors = np.linalg.qr((places[:, 1:] - places[:, :1]).transpose(0, 2, 1))
    sizes = np.abs(np.prod(np.diagonal(factors, axis1=1, axis2=2), axis=1))
    spaces = sizes[:, np.newaxis, np.newaxis] * (axes @ axes.transpose(0, 2, 1))
    total = count + len(middles)
    sums = [
        np.bincount(corners.ravel(), np.repeat(column, k + 1), total)[:count]
        for column in spaces.reshape(-1, n * n).T
    ]
    values, vectors = np.linalg.eigh(np.stack(sums, axis=1).reshape(count, n, n))
    frame = vectors[:, :, n - k :].transpose(0, 2, 1).reshape(count, k * n)
    return np.where(values[:, -1:] > 0, frame, 0).astype(position.dtype)


def continued(mesh: pv.DataSet, name: str) -> Array | None:
    """Return tangents in 3-space with the limit along the surface where their rank is lost.

    At a fold of the projection the image of a tangent vanishes, but the spaces that the tangents
    span at the points around usually have a limit. It is found as their mean, of second order in
    the distance of points that lie on both sides of the fold. Where the spaces around differ by
    much, as at a pinch point, no limit exists and the rows stay as they are. The array of the
    projected mesh has 3 k components, orthonormal rows, zero past their rank; None is returned if
    no rank is lost.
    """
    rows = np.asarray(mesh.point_data[name])
    frame = rows.reshape(len(rows), -1, 3).astype(np.float64)
    # A row of zeros is past the rank: the projection has flattened the space of that point.
    lost = ~np.all(np.any(frame != 0, axis=2), axis=1)
    if not lost.any() or lost.all():
        return None
    at, around = _neighbours(mesh)
    # Only neighbours whose own space is whole tell of the limit.
    used = lost[at] & ~lost[around]
    at, around = at[used], around[used]
    # The projection F^T F onto a space is the same for every basis F of it, so it can be averaged.
    spaces = np.einsum("ika,ikb->iab", frame[around], frame[around]).reshape(-1, 9)
    count = np.bincount(at, minlength=len(rows))
    total = np.stack([np.bincount(at, column, len(rows)) for column in spaces.T], axis=1)
    chosen = np.flatnonzero(count)
    mean = (total[chosen] / count[chosen, np.newaxis]).reshape(-1, 3, 3)
    # Eigenvectors of the k largest eigenvalues, which eigh puts last, span the space nearest to
    # all.
    values, vectors = np.linalg.eigh(mean)
    k = frame.shape[1]
    # The gap is 1 where all spaces around are one, and falls as they differ.
    agree = values[:, 3 - k] - values[:, 2 - k] > AGREEMENT
    frame[chosen[agree]] = vectors[agree][:, :, 3 - k :].transpose(0, 2, 1)
    return frame.reshape(rows.shape).astype(rows.dtype)


def _neighbours(mesh: pv.DataSet) -> tuple[Indices, Indices]:
    """Return the pairs of points that an edge joins, each pair both ways."""
    edges = mesh.extract_all_edges(progress_bar=False)
    a, b = polylines.segments(edges.GetLines()).T
    return np.concatenate([a, b]), np.concatenate([b, a])


def _blocks(
    work: Callable[..., Array], array: Array, rows: int | None = None, n: int = 1, *others: Array
) -> Array:
    """Return the results of a function on float64 blocks of an array, in the type of the array.

    The result has ``rows`` vectors of n components per point, or the shape of the array.
    """
    width = array.shape[1] if rows is None else rows * n
    out = np.empty((len(array), width), dtype=array.dtype)
    with np.errstate(all="ignore"):
        for block in _pool.blocks(len(array), BLOCK):
            parts = [part[block].astype(np.float64, copy=False) for part in (array, *others)]
            out[block] = work(*parts).reshape(-1, width)
    return out


def _named(mesh: pv.DataSet, argument: str, name: object) -> Array:
    if not isinstance(name, str):
        raise TypeError(_check.message(argument, "the name of a point array", repr(name)))
    return array_of(mesh, argument, name)


def _refuse_overwriting(mesh: pv.DataSet, names: list[str]) -> None:
    """Raise ValueError if a result would replace a user's array."""
    ours = records.made(mesh, RECORD)
    for name in names:
        if name in mesh.point_data and name not in ours:
            expected = "a mesh without an array under the name of a result"
            raise _check.value_error("mesh", expected, repr(name), "rename that array")


def _without(mesh: pv.DataSet, lost: Bools) -> pv.DataSet:
    """Return a mesh without some points and without the cells that use one of them."""
    kept = np.asarray(np.flatnonzero(~lost), dtype=int)
    # VTK's ids of the points and cells before would stay in the result as arrays of the user.
    grid: pv.DataSet = mesh.extract_points(
        kept, adjacent_cells=False, pass_point_ids=False, pass_cell_ids=False, progress_bar=False
    )
    # Extraction has made an unstructured grid of the surface.
    if isinstance(mesh, pv.PolyData):
        grid = grid.extract_surface(algorithm="geometry", pass_pointid=False, pass_cellid=False)
    for name in set(mesh.point_data) - set(grid.point_data):  # where no point is left
        records.attach_rows(grid, name, np.asarray(mesh.point_data[name])[:0])
    grid.GetFieldData().DeepCopy(mesh.GetFieldData())
    return grid


def _plane(hyperplane: object, n: int) -> tuple[Array, float]:
    """Return the unit normal of a hyperplane and its offset."""
    expected = f"(normal of {n} components, offset)"
    if not isinstance(hyperplane, tuple | list) or len(hyperplane) != 2:
        raise _check.type_error("hyperplane", expected, hyperplane)
    normal = np.array(_check.vector("hyperplane", hyperplane[0], direction=True))
    if len(normal) != n:
        raise _check.value_error("hyperplane", expected, f"a normal of {len(normal)} components")
    # By the largest component first, so that no square overflows.
    normal /= np.abs(normal).max()
    return normal / np.linalg.norm(normal), _check.number("hyperplane", hyperplane[1])


_SIMPLICES = (pv.CellType.TETRA, pv.CellType.TRIANGLE, pv.CellType.LINE)
#: Six faces of a hexahedron, their corners in cyclic order.
_FACES = np.array(
    [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
)
#: Corners of a voxel in the order of a hexahedron's.
_VOXEL = [0, 1, 3, 2, 4, 5, 7, 6]
#: Number of frames that are interpolated at once: each takes about n k numbers.
FRAMES = 1 << 15


def cut(
    mesh: pv.DataSet, heights: Array, /, *, spaces: Mapping[str, int] | None = None
) -> pv.PolyData:
    """Return the part of a mesh where a function of its points is 0, with its point arrays.

    The cells of highest dimension are cut, to points, lines or triangles, which are not
    consistently oriented; a hexahedron is cut as 12 tetrahedra around its mean point. Numeric point
    arrays are interpolated along the cut edges, cell arrays are left out. ``spaces`` are names of
    point arrays of rows that span a space, and the number n of components of a row: the mean is one
    of spaces, independent of the basis at each point.
    """
    simplices, middles = _simplices(mesh)
    # The mean point of a hexahedron, a new point behind those of the mesh, has the mean height.
    heights = np.concatenate([heights, heights[middles].mean(axis=1)])
    edges, weights, cells = slices.cut(heights, simplices)
    count, total = mesh.n_points, mesh.n_points + len(middles)
    parts = np.stack([1 - weights, weights], axis=1)
    # Each row has the weights of the points of the mesh in a point of the cut.
    between = _sparse(parts, edges, total)
    if len(middles):
        # Mean points are none of the mesh: their weight is spread over the corners that they stand
        # for.
        spread = _sparse(np.full(middles.shape, 1 / middles.shape[1]), middles, count)
        between = between[:, :count] + between[:, count:] @ spread
    # A point with weight 0 must not contribute a NaN.
    between.eliminate_zeros()
    out = blocks.polydata(between @ np.asarray(mesh.points, dtype=np.float64), cells)
    for key, value in mesh.point_data.items():
        array = np.asarray(value)
        if spaces and key in spaces:
            records.attach_rows(out, key, _mean_frames(array, between, spaces[key]))
        # Between integers or flags there are fractions. Words have no mean, and are left out.
        elif array.dtype.kind in "biuf":
            kind = array.dtype if array.dtype.kind == "f" else np.float64
            records.attach_rows(out, key, (between @ array.astype(np.float64)).astype(kind))
    out.GetFieldData().DeepCopy(mesh.GetFieldData())
    return out


def _sparse(parts: Array, columns: Indices, count: int) -> Sparse:
    """Return a sparse array of rows with equally many parts in given columns."""
    ends = np.arange(0, parts.size + 1, parts.shape[1])
    matrix = scipy.sparse.csr_array((parts.ravel(), columns.ravel(), ends), (len(parts), count))
    # Where the function is 0 at a point, both ends of its edge are that point.
    matrix.sum_duplicates()
    return matrix


def _mean_frames(array: Array, between: Sparse, n: int) -> Array:
    """Return weighted means of frames in n-space; a row of ``between`` has the weights of one."""
    means = np.empty((between.shape[0], array.shape[1]), dtype=array.dtype)
    for block in _pool.blocks(len(means), FRAMES):
        part = between[block]
        # Only the frames that a block needs are widened to float64.
        used = np.unique(part.indices)
        rows = array[used].astype(np.float64).reshape(len(used), -1, n)
        means[block] = slices.mean_frame(rows, part[:, used]).reshape(-1, array.shape[1])
    return means


def _triangles(mesh: pv.PolyData) -> Indices:
    """Return the triangles of faces."""
    if np.ptp(mesh.points, axis=0).any():
        return np.asarray(mesh.triangulate().regular_faces, dtype=np.intp)
    # A manifold that is not projected yet has all points in one place; VTK 9.4 finds nothing there.
    faces = np.asarray(mesh.regular_faces, dtype=np.intp)
    fan = [(0, i, i + 1) for i in range(1, faces.shape[1] - 1)]
    return faces[:, fan].reshape(-1, 3)


def _simplices(mesh: pv.DataSet) -> tuple[Indices, Indices]:
    """Return segments, triangles or tetrahedra, and the corners of the hexahedra that are split."""
    none = np.empty((0, 8), dtype=np.intp)
    if isinstance(mesh, pv.PolyData):
        if has_faces(mesh):
            return _triangles(mesh), none
        segments = polylines.segments(mesh.GetLines())
        if len(segments):
            return segments, none
    else:
        grid = mesh.cast_to_unstructured_grid()
        kinds = _cells(grid)
        whole = {pv.CellType.TETRA, pv.CellType.HEXAHEDRON, pv.CellType.VOXEL}
        if kinds and set(kinds) <= whole:
            # Cells of these types are split here and not by VTK, for the sake of common diagonals.
            return _tetrahedra(kinds, mesh.n_points)
        kinds = _cells(grid.triangulate()) if kinds else {}
        # From volumes down: side sets beside the cells of highest dimension are not cut.
        for kind in _SIMPLICES:
            if kind in kinds:
                return kinds[kind], none
    expected, got = "lines, faces or volumes", "a mesh of points alone"
    remedy = "connect the points, for example by delaunay_3d()"
    raise _check.value_error("mesh", expected, got, remedy)


def _cells(grid: pv.UnstructuredGrid) -> dict[int, Indices]:
    """Return the points of the cells of a grid, by the type of the cells."""
    kinds = grid.cells_dict if grid.n_cells else {}
    return {int(kind): np.asarray(cells, dtype=np.intp) for kind, cells in kinds.items()}


def _tetrahedra(kinds: Mapping[int, Indices], count: int) -> tuple[Indices, Indices]:
    """Return the tetrahedra of a mesh, 12 around the mean point of each hexahedron.

    Each face is split by the diagonal from its corner of the lowest index, so that both hexahedra
    at a face split it by the same diagonal and the section has no cracks.
    """
    none = np.empty((0, 8), dtype=np.intp)
    voxels = kinds.get(pv.CellType.VOXEL, none)[:, _VOXEL]
    corners = np.concatenate([kinds.get(pv.CellType.HEXAHEDRON, none), voxels])
    faces = corners[:, _FACES]
    # Each face begins at its lowest index, from whichever hexahedron it is seen.
    first = np.argmin(faces, axis=2)[..., np.newaxis]
    ring = np.take_along_axis(faces, (first + np.arange(4)) % 4, axis=2)
    # Numbers of the mean points, in the order in which the cut adds their heights.
    middle = np.broadcast_to(
        count + np.arange(len(corners))[:, np.newaxis, np.newaxis], (len(corners), 6, 1)
    )
    parts = [
        np.concatenate([ring[..., part], middle], axis=2).reshape(-1, 4)
        # Both triangles of a face have the diagonal from its first corner in common.
        for part in ([0, 1, 2], [0, 2, 3])
    ]
    return np.concatenate([kinds.get(pv.CellType.TETRA, none[:, :4]), *parts]), corners


def is_dropped(mesh: pv.DataSet) -> bool:
    """Return whether points are the first three of more coordinates, the others of which differ."""
    rows = mesh.point_data.get(POSITION)
    if rows is None or rows.ndim != 2 or rows.shape[1] < 4 or not len(rows):
        return False
    places = np.asarray(rows)
    is_number = places.dtype.kind == "f" and bool(np.isfinite(places).all())
    is_image = is_number and np.allclose(places[:, :3], mesh.points, atol=1e-6 * mesh.length)
    return is_image and bool(np.ptp(places[:, 3:], axis=0).any())


def covers_itself(mesh: pv.DataSet) -> bool:
    """Return whether the first three coordinates put much of a mesh onto other parts of it.

    Its places in n-space are ``position``.
    """
    places: Array = np.asarray(mesh.point_data[POSITION], dtype=np.float64)
    if len(places) <= NEIGHBOURS:
        return False
    some = np.arange(0, len(places), max(len(places) // SAMPLE, 1))
    tree = scipy.spatial.cKDTree(places[:, :3])
    near, at = tree.query(places[some, :3], k=NEIGHBOURS)
    far = np.linalg.norm(places[at] - places[some, np.newaxis], axis=2)
    folded = (far > FOLDED * near) & (far > np.sqrt(np.finfo(np.float64).eps) * far.max())
    return bool(folded.any(axis=1).mean() > COVERED)


def eye_distance(mesh: pv.DataSet) -> float:
    """Return a distance of the eye on the last axis from which all of a mesh is before it.

    It is the radius for points on a sphere about the origin, for the stereographic projection.
    """
    places: Array = np.asarray(mesh.point_data[POSITION], dtype=np.float64)
    radii, top = np.linalg.norm(places, axis=1), float(places[:, 3:].max())
    radius = float(radii.mean())
    if np.ptp(radii) <= ON_SPHERE * radius and top <= FROM_POLE * radius:
        return radius
    return float(f"{max(top, 0.0) + float(np.ptp(places, axis=0).max()) / 2:.3g}")


def with_last_coordinate(mesh: pv.DataSet, name: str, /) -> pv.DataSet:
    """Return a mesh with the last coordinate of its places in n-space as a point array.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh with the point array ``position`` of n components, which is not changed.
    name : str
        Name of the new array.

    Returns
    -------
    pyvista.DataSet
        Mesh with that array.

    Raises
    ------
    TypeError, ValueError
        If it is no such mesh.
    """
    _check.instance("mesh", mesh, pv.DataSet, "a pyvista.DataSet")
    places = _named(mesh, "mesh", POSITION)
    out = mesh.copy(deep=False)
    records.attach_rows(out, _check.text("name", name), places[:, -1].copy())
    said = meaning.of(out)
    said.add_array(name, {"long_name": f"{name}, the last of {places.shape[1]} coordinates"})
    return meaning.attach(out, said)
