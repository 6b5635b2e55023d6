"""Take points, tangents and normals from a mesh as rows that the engine slices."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from vizlight import _check
from vizlight.model import kernels
from vizlight.scene import View

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vizlight._types import Array, Bools, Indices, Vector
    from vizlight.scene import Scene
    from vizlight.shading.block import Rows

#: A point array that no user has.
NUMBERS = "vizlight numbers"
#: The vectors of a nearly closed surface's faces add up to less than this share of their area.
NEARLY_CLOSED = 0.2


class GridPoints:
    """The points of an image or a rectilinear grid, made by slice: none are kept."""

    dtype: np.dtype[Any] = np.dtype(np.float64)

    def __init__(self, grid: pv.ImageData | pv.RectilinearGrid) -> None:
        self.shape: tuple[int, ...] = (grid.n_points, 3)
        self._dimensions = grid.dimensions
        if isinstance(grid, pv.ImageData):
            matrix = np.asarray(grid.index_to_physical_matrix, dtype=np.float64)
            first = np.array(grid.extent[::2])
            self._place: Callable[[Indices], Array] = lambda ijk: (
                (ijk + first) @ matrix[:3, :3].T + matrix[:3, 3]
            )
        else:
            axes = [np.asarray(axis, dtype=np.float64) for axis in (grid.x, grid.y, grid.z)]
            self._place = lambda ijk: np.stack(
                [axis[i] for axis, i in zip(axes, ijk.T, strict=True)], axis=1
            )

    def __getitem__(self, rows: slice, /) -> Array:
        """Return some points, the first index running fastest."""
        flat = np.arange(*rows.indices(self.shape[0]))
        ijk = np.stack(np.unravel_index(flat, self._dimensions, order="F"), axis=1)
        return self._place(ijk)


def check(mesh: Any) -> None:
    """Refuse what is neither a dataset nor blocks of them."""
    if not isinstance(mesh, pv.DataSet | pv.MultiBlock):
        remedy = "read files by pyvista.read, wrap VTK objects by pyvista.wrap"
        raise TypeError(_check.message("mesh", "a PyVista mesh", type(mesh).__name__, remedy))


def leaves(mesh: Any) -> Iterator[Any]:
    """Yield the meshes of a MultiBlock, however deep, or the mesh itself."""
    for leaf, _ in named_leaves(mesh):
        yield leaf


def named_leaves(mesh: Any, path: str = "") -> Iterator[tuple[Any, str]]:
    """Yield the meshes of a MultiBlock, however deep, with where they are."""
    if not isinstance(mesh, pv.MultiBlock):
        if not isinstance(mesh, pv.DataSet):
            where = f"block {path}: " if path else ""
            got = type(mesh).__name__
            raise TypeError(where + _check.message("mesh", "a PyVista mesh", got))
        yield mesh, path
        return
    for i in range(mesh.n_blocks):
        if mesh[i] is not None:
            yield from named_leaves(mesh[i], f"{path}/{mesh.get_block_name(i) or i}")


def box(mesh: pv.DataSet) -> tuple[Array, float]:
    """Return the middle of a mesh's finite points and its longest side, 1 where it has none."""
    low, high = np.reshape(mesh.bounds, (3, 2)).T
    if not np.all(np.isfinite([low, high])) and isinstance(mesh, pv.PointSet | pv.PolyData):
        points = np.asarray(mesh.points, dtype=np.float64)
        points = points[np.all(np.isfinite(points), axis=1)]
        low, high = points.min(axis=0, initial=np.inf), points.max(axis=0, initial=-np.inf)
    side = float(np.max(high / 2 - low / 2)) * 2
    if not (np.isfinite(side) and side > 0):
        return np.nan_to_num(low / 2 + high / 2, posinf=0.0, neginf=0.0), 1.0
    return low / 2 + high / 2, side


def near_origin(mesh: pv.DataSet) -> Vector:
    """Return a place near a mesh, 0 where that is near enough not to lose digits of float32."""
    middle, side = box(mesh)
    far = np.abs(middle).max() > side
    return tuple(float(x) if far else 0.0 for x in middle)


def moved(mesh: Any, offset: Array, scale: float = 1.0) -> Any:
    """Return a mesh with its points p at ``scale (p + offset)``, in float64."""
    out = mesh.copy(deep=False)
    if isinstance(mesh, pv.ImageData):
        out.origin = tuple(scale * (np.array(mesh.origin) + offset))
        out.spacing = tuple(scale * np.array(mesh.spacing))
    elif isinstance(mesh, pv.RectilinearGrid):
        for i, axis in enumerate("xyz"):
            ticks = np.asarray(getattr(mesh, axis), dtype=np.float64)
            setattr(out, axis, scale * (ticks + offset[i]))
    else:
        points: Any = scale * (np.asarray(mesh.points, dtype=np.float64) + offset)
        points[~np.isfinite(points)] = np.nan
        # Not by assigning to points, which would move those that the copy shares.
        out.SetPoints(pv.vtk_points(points))
    return out


def points_of(mesh: pv.DataSet, positions: str | None) -> Rows:
    """Return the points of a mesh, or a point array of positions in n-space."""
    if positions is not None:
        return array_of(mesh, "positions", positions)
    if isinstance(mesh, pv.ImageData | pv.RectilinearGrid):
        return GridPoints(mesh)
    return np.asarray(mesh.points)


def array_of(
    mesh: pv.DataSet, name: str, value: Any, *, average_cells: bool | None = None
) -> Array:
    """Return a point array by name, or an array given as such; two-dimensional, real.

    Cell data are averaged to the points, refused, or, where None, never averaged.

    Raises
    ------
    TypeError
        If it does not hold real numbers.
    ValueError
        If there is no such array, or it is cell data and may not be averaged.
    """
    if isinstance(value, str):
        array = _named(mesh, name, value, average_cells=average_cells)
        what = f"{value!r} with "
    else:
        array, what = _check.floats(name, value), ""
        if array.ndim == 3:
            array = array.reshape(len(array), -1)
        if array.ndim == 0 or len(array) != mesh.n_points:
            raise ValueError(
                _check.message(name, f"{mesh.n_points} rows, one a point", _check.describe(array))
            )
    if array.dtype.kind not in "iubf":
        raise TypeError(_check.message(name, "real numbers", f"{what}type {array.dtype}"))
    if array.ndim != 2:
        raise ValueError(
            _check.message(
                name,
                "vectors, an array of 2 or more components",
                f"{what}1 component" if array.ndim == 1 else f"{what}shape {array.shape}",
                "name another array",
            )
        )
    return array


def _named(mesh: pv.DataSet, name: str, value: str, *, average_cells: bool | None) -> Array:
    if value in mesh.point_data:
        return np.asarray(mesh.point_data[value])
    if value in mesh.cell_data:
        if average_cells:
            only = mesh.copy(deep=False)
            only.clear_data()
            only.cell_data[value] = np.asarray(mesh.cell_data[value])
            return np.asarray(only.cell_data_to_point_data().point_data[value])
        remedy = "call mesh.cell_data_to_point_data()"
        if average_cells is not None:
            remedy = f"pass average_cells=True or {remedy}"
        raise ValueError(_check.message(name, "a point array", f"the cell array {value!r}", remedy))
    there = ", ".join(repr(key) for key in mesh.point_data) or "none"
    raise ValueError(_check.message(name, f"the name of a point array ({there})", repr(value)))


def refuse_unnamed(name: str, value: Any) -> None:
    """Refuse anything but the name of an array, or None."""
    if value is not None and not isinstance(value, str):
        remedy = "attach it to the mesh and name it"
        raise TypeError(
            _check.message(name, "the name of a point array", _check.describe(value), remedy)
        )


def vectors_of(mesh: pv.DataSet, name: str, value: Any, n: int) -> Array:
    """Return a point array of n components, by name or given as such."""
    array = array_of(mesh, name, value)
    if array.shape[1] != n:
        what = f"{value!r} with {array.shape[1]}" if isinstance(value, str) else array.shape[1]
        raise ValueError(_check.message(name, f"{n} components", what))
    return array


def attach_rows(mesh: Any, name: str, array: Array) -> None:
    """Attach a point array, also one of no rows, which PyVista refuses."""
    if len(array):
        mesh.point_data[name] = array
    else:
        mesh.GetPointData().AddArray(pv.convert_array(array, name))


def activate(mesh: Any, name: str) -> None:
    """Make a point array the active scalars of a mesh, also where those of its cells were."""
    mesh.point_data.active_scalars_name = name
    if mesh.n_points:
        mesh.set_active_scalars(name, preference="point")


def tangents_of(
    mesh: pv.DataSet, value: Any, n: int, *, average_cells: bool, argument: str = "tangents"
) -> Array:
    """Return tangents as (n_points, k n), 0 < k < n."""
    array = array_of(mesh, argument, value, average_cells=average_cells)
    if array.shape[1] % n or not 0 < array.shape[1] // n < n:
        allowed = " or ".join(str(k * n) for k in range(1, min(n, 5)))
        what = f"{value!r} with {array.shape[1]}" if isinstance(value, str) else array.shape[1]
        raise ValueError(
            _check.message(
                argument,
                f"a point array of {allowed} components, rows of {n}",
                what,
                "name another array, or the points in n-space by positions=",
            )
        )
    return array


def normals_of(mesh: pv.DataSet, value: Any, n: int, view: View | None) -> Array:
    """Return outward normals: those given, those the mesh carries, or those of its surface."""
    if value is not None:
        return vectors_of(mesh, "normals", value, n)
    if n != 3:
        raise ValueError(
            _check.message(
                "normals",
                f"a point array of {n} components for {n}-space",
                None,
                "where there are none, light by tangents=, "
                "conditioned by the name of the surface's tangents",
            )
        )
    carried = mesh.point_data.active_normals
    if carried is not None:
        return np.asarray(carried)
    return surface_normals(mesh, view)


def surface_normals(mesh: pv.DataSet, view: View | None) -> Array:
    """Return the normals of a mesh's outer surface, zero at points that are not on it.

    A closed surface has them outward, and so has a connected piece that is nearly closed. Any
    other has no outside: it is turned as a whole, rather toward the eye.
    VTK computes them, in float32.

    Raises
    ------
    ValueError
        If the mesh has no surface.
    """
    if mesh.n_points == 0:
        return np.zeros((0, 3), dtype=np.float32)
    if isinstance(mesh, pv.PointSet):
        mesh = mesh.cast_to_polydata(deep=False)
    if isinstance(mesh, pv.PolyData):
        surface, origin = mesh, None
    else:
        surface, origin = outer_surface(mesh)
    if not (surface.GetNumberOfPolys() or surface.GetNumberOfStrips()):
        raise ValueError(
            _check.message(
                "mesh",
                "a surface, whose normals decide where no tangents are named",
                f"a {type(mesh).__name__} without faces",
                "name its tangent vectors by tangents=",
            )
        )
    bare = pv.PolyData()
    bare.copy_structure(surface)
    closed = bare.n_open_edges == 0
    found = bare.compute_normals(
        cell_normals=False,
        split_vertices=False,
        consistent_normals=True,
        auto_orient_normals=closed,
        non_manifold_traversal=False,
    )
    computed = np.array(found.point_data["Normals"])
    used = np.zeros(len(computed), dtype=np.bool_)
    used[_corners(bare)[0]] = True
    computed[~used] = 0
    if not closed:
        _turn_open(computed, found, view)
    if origin is None:
        return computed
    return scattered(computed, origin, mesh.n_points)


def outer_surface(mesh: Any) -> tuple[pv.PolyData, Indices]:
    """Return the outer surface of a mesh and which of its points each is, -1 for none.

    Curved cells are taken as flat ones between their nodes.
    """
    if not mesh.has_nonlinear_cells:
        surface = mesh.extract_surface(algorithm="geometry", pass_pointid=True, pass_cellid=False)
        ids = surface.point_data.pop("vtkOriginalPointIds")
        return surface, np.asarray(ids, dtype=np.intp)
    # VTK numbers the nodes of curved cells by their places in the cell: numbers of our own tell.
    numbered = mesh.copy(deep=False)
    numbered.point_data[NUMBERS] = np.arange(mesh.n_points, dtype=np.float64)
    surface = numbered.extract_surface(
        algorithm="dataset_surface", nonlinear_subdivision=1, pass_pointid=False, pass_cellid=False
    )
    ids = np.rint(np.asarray(surface.point_data.pop(NUMBERS))).astype(np.intp)
    # Bezier's control points are not on the surface.
    off = np.abs(np.asarray(surface.points) - np.asarray(mesh.points)[ids]).max(axis=1, initial=0)
    return surface, np.where(off <= 1e-5 * np.abs(surface.points).max(initial=0), ids, -1)


def scattered(rows: Array, origin: Indices, count: int) -> Array:
    """Return the rows of a mesh's surface as rows of its points, zero where it has none."""
    found = np.zeros((count, *rows.shape[1:]), dtype=rows.dtype)
    there = origin >= 0
    found[origin[there]] = rows[there]
    return found


def _turn_open(normals: Array, surface: pv.PolyData, view: View | None) -> None:
    """Turn over each connected piece whose normals rather point inward, or away from the eye.

    A piece is nearly closed where the vectors of its faces' areas add up to little of their area:
    then the volume it encloses decides. For a sheet or a bowl the mean of N toward the eye, which
    counts three times, and away from the piece's centroid. Points that are not finite have no say.
    """
    points = np.asarray(surface.points, dtype=np.float64)
    piece = _pieces(surface)
    good = np.all(np.isfinite(points), axis=1) & np.all(np.isfinite(normals), axis=1)
    points = np.where(good[:, np.newaxis], points, 0)
    size = np.maximum(np.bincount(piece, good), 1)
    centroids = np.stack([np.bincount(piece, axis * good) / size for axis in points.T], axis=1)
    away = points - centroids[piece]
    score = _dots(normals, unit_rows(away))
    if view is not None and len(view.position or view.direction or ()) == 3:
        toward = (
            np.broadcast_to(np.asarray(view.direction), points.shape)
            if view.parallel
            else np.asarray(view.position) - points
        )
        score += 3 * _dots(normals, unit_rows(toward))
    turned = np.bincount(piece, np.where(good, score, 0)) < 0

    faces = surface if surface.is_all_triangles else surface.triangulate()
    corners = np.asarray(faces.regular_faces, dtype=np.intp)
    corners = corners[good[corners].all(axis=1)]
    # Over their size, since products of tiny lengths vanish and those of huge ones overflow.
    a, b, c = (away[corners[:, i]] / (np.abs(away).max() or 1.0) for i in range(3))
    across, owner = np.cross(b - a, c - a), piece[corners[:, 0]]
    total = np.stack([np.bincount(owner, axis, len(size)) for axis in across.T], axis=1)
    area = np.bincount(owner, np.linalg.norm(across, axis=1), len(size))
    volume = np.bincount(owner, _dots(across, a), len(size))
    around = np.linalg.norm(total, axis=1) < NEARLY_CLOSED * area
    normals[np.where(around, volume < 0, turned)[piece]] *= -1


def _dots(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", a, b))


def onlooker(scene: Scene) -> View | None:
    """Return the scene's view, or one from its first light, to which an open surface then turns."""
    if scene.view is not None:
        return scene.view
    light = next((light for light in scene.lights if not light.follows_view), None)
    if light is None:
        return None
    return View(position=light.position, direction=light.direction)


def _pieces(surface: pv.PolyData) -> Indices:
    """Return for each point the number of the connected piece it belongs to.

    Corners of one place belong together, so that separate triangles of one surface do too.
    """
    corners, last = _corners(surface)
    follows = np.flatnonzero(~last)
    points = np.asarray(surface.points)
    order = np.lexsort(points.T)
    same = np.flatnonzero(np.all(points[order[1:]] == points[order[:-1]], axis=1))
    a = np.concatenate([corners[follows], order[same]])
    b = np.concatenate([corners[follows + 1], order[same + 1]])
    graph = coo_array((np.ones(len(a), np.bool_), (a, b)), shape=(surface.n_points,) * 2)
    _, piece = connected_components(graph, directed=False)
    return np.asarray(piece, dtype=np.intp)


def _corners(surface: pv.PolyData) -> tuple[Indices, Bools]:
    """Return the corners of all faces, one after the other, and which are the last of a face."""
    corners, last = [], []
    for cells in (surface.GetPolys(), surface.GetStrips()):
        ids = pv.convert_array(cells.GetConnectivityArray()).astype(np.intp, copy=False)
        ends = np.zeros(len(ids), dtype=np.bool_)
        ends[pv.convert_array(cells.GetOffsetsArray())[1:] - 1] = True
        corners.append(ids)
        last.append(ends)
    return np.concatenate(corners), np.concatenate(last)


def unit_rows(vectors: Array) -> Array:
    """Return unit vectors in float64, of whatever length they were; zero without a direction."""
    columns = np.ascontiguousarray(np.asarray(vectors, dtype=np.float64).T)
    result: Array = kernels.unit(columns)[0].T
    return result
