"""Meshes that are made of a mesh: a surface in it, a layer of it, its points elsewhere."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Bools, Foreign, Keywords, Raw
from vizlight.mesh import blocks, georeference, meaning, records, sections
from vizlight.mesh.polylines import by_end
from vizlight.mesh.subdivision import by_corner
from vizlight.vtk.arrays import of_components
from vizlight.vtk.cells import check_whole, connectivity
from vizlight.vtk.polylines import has_lines_only

#: Share of the area of its voxels' faces below which the surface of a label is too thin to be
#: smoothed: that of a ball is 0.6, of a bar two voxels wide 0.23.
THIN = 0.25
#: Cells with a face below and one above.
PRISMS = {pv.CellType.WEDGE, pv.CellType.HEXAHEDRON, pv.CellType.VOXEL}


def check_dataset(mesh: object) -> None:
    """Check that a mesh is one dataset that VTK can read."""
    if not isinstance(mesh, pv.DataSet):
        remedy = "join its blocks by mesh.combine()" if isinstance(mesh, pv.MultiBlock) else ""
        raise TypeError(_check.message("mesh", "a PyVista dataset", type(mesh).__name__, remedy))
    check_whole(mesh, "mesh")


def surface_of(
    mesh: pv.DataSet | pv.MultiBlock,
    /,
    contour: str | None = None,
    level: float | Sequence[float] | None = None,
    labels: str | None = None,
) -> pv.PolyData:
    """Return an isosurface of a mesh, the boundary of labels, or its outer surface.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh, which is not changed.
    contour : str, optional
        Name of an array of one component; one of cells is averaged to the points.
    level : float or sequence of float, optional
        Value of the array on the isosurface, or those on several of them. Default: the middle of
        its range.
    labels : str, optional
        Name of an array of labels, which are then those of the cells. In an image that fills space,
        such as an atlas of a brain, they are whole numbers of which 0 is the ground: the surface of
        all others is smoothed within the size of a voxel, but for labels as thin as one or two
        voxels, of which little would be left. Elsewhere each point of the surface
        labels the cells nearest to it, so that no cell has a label between two; of lines each end
        of a segment labels its half.

    Returns
    -------
    pyvista.PolyData

    Raises
    ------
    ValueError
        If the array does not exist, or the isosurface is empty.
    """
    if labels is not None:
        return _of_labels(mesh, _check.text("labels", labels))
    if isinstance(mesh, pv.MultiBlock):
        mesh = blocks.one_grid(mesh)
    check_dataset(mesh)
    if contour is None:
        if isinstance(mesh, pv.PolyData):
            return mesh
        return blocks.outer_surface(mesh)[0]
    mesh = records.averaged(mesh, _check.text("contour", contour))
    values = _scalars(mesh, "contour", contour)
    finite = values[np.isfinite(values)]
    if not finite.size:
        raise _check.value_error("contour", "an array with finite values", repr(contour))
    low, high = float(finite.min()), float(finite.max())
    levels = np.ravel((low + high) / 2 if level is None else level).tolist()
    surface = blocks.isosurface(mesh, contour, *(_check.number("level", each) for each in levels))
    if not surface.n_points:
        expected = f"a value between {low:g} and {high:g}"
        raise _check.value_error("level", expected, ", ".join(f"{each:g}" for each in levels))
    # Beside a hole VTK makes faces with corners that are nowhere.
    there: Foreign = np.isfinite(np.asarray(surface.points)).all(axis=1)
    return surface if there.all() else _kept_points(surface, there)


def _of_labels(mesh: pv.DataSet | pv.MultiBlock, name: str) -> pv.PolyData:
    """Return the surface of labelled cells, with labels of its own cells."""
    if not isinstance(mesh, pv.ImageData) or min(mesh.dimensions) == 1:
        surface = surface_of(mesh)
        _scalars(surface, "labels", name)
        if name not in surface.point_data:
            return surface
        return (by_end if has_lines_only(surface) else by_corner)(surface, name)
    if name not in mesh.point_data and name in mesh.cell_data:
        # Each cell becomes a point at its middle.
        mesh = mesh.cells_to_points(name)
    values = _scalars(mesh, "labels", name)
    if values.dtype.kind not in "iu" or not values.any():
        got = f"{name!r} of {values.dtype}"
        raise _check.value_error("labels", "whole numbers that are not all 0", got)
    taken: Keywords = {"scalars": name, "output_mesh_type": "triangles"}
    boundary: pv.PolyData = mesh.contour_labels(**taken)
    rows = np.asarray(boundary.cell_data["boundary_labels"])
    thin = _are_thin(boundary, rows, np.asarray(mesh.spacing))
    if thin.any():
        of_thin = np.unique(boundary.regular_faces[thin])
        voxels = mesh.contour_labels(**taken, smoothing=False)
        # Both have the same points in the same order.
        boundary.points[of_thin] = voxels.points[of_thin]
    boundary.clear_data()
    boundary.cell_data[name] = rows
    georeference.place_alike(boundary, mesh)
    return boundary


def _are_thin(boundary: pv.PolyData, labels: Raw, spacing: Array) -> Bools:
    """Return which triangles of a smoothed boundary are of labels of which it leaves little."""
    areas = np.asarray(boundary.compute_cell_sizes(length=False, volume=False).cell_data["Area"])
    _, label, counts = np.unique(labels, return_inverse=True, return_counts=True)
    # Each face of a voxel is two triangles.
    face = float(np.mean(np.prod(spacing) / spacing)) / 2
    is_thin: Bools = np.bincount(label, areas) < THIN * face * counts
    return is_thin[label]


def _kept_points(mesh: pv.PolyData, kept: Foreign) -> pv.PolyData:
    """Return the cells of a mesh with all their points kept, and their arrays."""
    return blocks.plain_surface(
        mesh.extract_points(kept, adjacent_cells=False, pass_point_ids=False, pass_cell_ids=False)
    )


def with_vectors(mesh: pv.DataSet, names: str | Sequence[str], /) -> pv.DataSet:
    """Return a mesh with a point array of vectors, given the names of their components.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh, which is not changed.
    names : str or sequence of str
        Names of two or three arrays of one component, separated by commas, such as ``"u,v"``,
        which is the name of the vectors too; or that of vectors of two components. A third
        component that is missing is 0. Arrays of cells are averaged to the points.

    Returns
    -------
    pyvista.DataSet
        Mesh with the vectors, NaN where a component is not finite; the mesh itself if it has an
        array of this name, as that of a wind on turned axes, which points where it is drawn.

    Raises
    ------
    TypeError, ValueError
        If an array does not exist, or their number is not two or three.
    """
    check_dataset(mesh)
    if isinstance(names, list | tuple):
        names = ",".join(map(str, names))
    names = _check.text("names", names, expected="names of arrays, separated by commas")
    if names in mesh.array_names:
        return meaning.with_named(mesh, names)[0]
    every = names.split(",")
    # The array is attached to a shallow copy, so that the caller's mesh does not get it.
    out = records.averaged(mesh, *every).copy(deep=False)
    out.point_data[names] = of_components(out, "names", every)
    return out


def warped(mesh: pv.DataSet, name: str, factor: float, /) -> pv.DataSet:
    """Return a mesh with points raised by heights, or displaced by vectors.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh, which is not changed. A map in degrees becomes one in metres about its centre.
    name : str
        Name of the array of heights, or of three components in floating point. Cells at values
        that are not finite are left out.
    factor : float
        Length in the unit of the mesh that corresponds to one unit of the array.

    Returns
    -------
    pyvista.DataSet

    Raises
    ------
    ValueError
        If the array does not exist or has no finite value, or the factor is not finite.
    """
    check_dataset(mesh)
    _check.text("warp", name, expected="the name of a point array")
    mesh = records.averaged(mesh, name)
    rows = np.asarray(mesh.point_data[name]) if name in mesh.point_data else np.empty(0)
    if rows.dtype.kind != "f" or rows.shape[1:] != (3,):
        rows = np.asarray(_scalars(mesh, "warp", name))[:, np.newaxis]
    holes = ~np.isfinite(rows).all(axis=1)
    factor = _check.number("exaggeration", factor)
    # Over degrees, each some 111 km, heights in metres would stand as needles.
    mesh = georeference.in_metres(mesh)
    if holes.all():
        raise _check.value_error("warp", "an array with finite values", repr(name))
    is_grid = isinstance(mesh, pv.ImageData | pv.RectilinearGrid)
    if is_grid or rows.shape[1] == 3:
        # VTK raises grids to float32, which is coarse far from the origin.
        points = np.array(mesh.points, dtype=np.float64)
        # Heights move the last axis, and vectors move all three.
        points[:, -rows.shape[1] :] += factor * rows
        moved: Foreign = mesh.cast_to_structured_grid() if is_grid else mesh.copy(deep=False)
        # A shallow copy has the points of the mesh itself, and gets others in their place.
        moved.SetPoints(pv.vtk_points(points))
    else:
        moved = mesh.warp_by_scalar(name, factor=factor)
    out: pv.DataSet = moved
    # Cells at a hole go, whatever their other points are.
    return out.extract_points(~holes, adjacent_cells=False) if holes.any() else out


def layers(mesh: pv.DataSet, /) -> int:
    """Return the number of layers of a volume, 0 where it has none.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Image or grid, or unstructured grid of prisms between levels.
    """
    if isinstance(mesh, pv.ImageData | pv.RectilinearGrid | pv.StructuredGrid):
        return mesh.dimensions[2] if min(mesh.dimensions) > 1 else 0
    return len(_levels(mesh))


def _levels(mesh: pv.DataSet) -> Array:
    """Return the heights of the levels between which all cells are, empty without any."""
    prisms = isinstance(mesh, pv.UnstructuredGrid) and {*mesh.distinct_cell_types} <= PRISMS
    if not prisms or not mesh.n_cells:
        return np.empty(0)
    levels: Array = np.unique(np.asarray(mesh.points, dtype=np.float64)[:, 2])
    # The points of other volumes are at nearly as many heights as there are points.
    return levels if len(levels) ** 2 < mesh.n_points else np.empty(0)


def layer_of(mesh: pv.DataSet, at: int, /) -> pv.RectilinearGrid | pv.StructuredGrid | pv.PolyData:
    """Return one layer of a grid across its last axis, with its arrays.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Image, rectilinear or structured grid, or unstructured one of prisms between levels, which
        is not changed.
    at : int
        Number of the layer, from 0 where z is least.

    Returns
    -------
    pyvista.RectilinearGrid, pyvista.StructuredGrid or pyvista.PolyData
        Grid of one layer, or the faces of prisms in it; values of cells are those above it, below
        the last layer.

    Raises
    ------
    TypeError, ValueError
        If the mesh is no such grid, or has no such layer.
    """
    if isinstance(mesh, pv.ImageData):
        mesh = mesh.cast_to_rectilinear_grid()
    if isinstance(mesh, pv.UnstructuredGrid) and len(levels := _levels(mesh)):
        at = _check.integer("at", at, low=0, high=len(levels) - 1)
        return _faces_at(mesh, levels, at)
    if not isinstance(mesh, pv.RectilinearGrid | pv.StructuredGrid):
        raise TypeError(_check.message("mesh", "an image or a grid", type(mesh).__name__))
    nx, ny, nz = mesh.dimensions
    at = _check.integer("at", at, low=0, high=nz - 1)
    layer: pv.RectilinearGrid | pv.StructuredGrid
    if isinstance(mesh, pv.RectilinearGrid):
        layer = pv.RectilinearGrid(mesh.x, mesh.y, mesh.z[at : at + 1])
    else:
        rows = np.array(mesh.points[at * nx * ny : (at + 1) * nx * ny])
        layer = blocks.structured(rows, (nx, ny, 1))
    cells = max(nx - 1, 1) * max(ny - 1, 1)
    places = (
        (mesh.point_data, layer.point_data, at, nx * ny),
        (mesh.cell_data, layer.cell_data, min(at, max(nz - 2, 0)), cells),
    )
    for data, into, number, count in places:
        for name in data:
            into[name] = np.array(data[name][number * count : (number + 1) * count])
    layer.field_data.update(mesh.field_data)
    said = meaning.of(mesh)
    if len(said.scales) > 2 and (text := said.scales[2].at(_middle(layer))):
        meaning.attach(layer, dataclasses.replace(said, level=text))
    return layer


def _middle(layer: pv.DataSet) -> float:
    """Return the mean height of a layer."""
    return float(np.nanmean(np.asarray(layer.points, dtype=np.float64)[:, 2]))


def _faces_at(mesh: pv.UnstructuredGrid, levels: Array, at: int) -> pv.PolyData:
    """Return the faces of prisms at a level, of the cells above it, below the last level."""
    ids, ends = connectivity(mesh.GetCells())
    heights = np.asarray(mesh.points, dtype=np.float64)[:, 2]
    lowest = np.minimum.reduceat(heights[ids], ends[:-1])
    chosen: Foreign = np.flatnonzero(lowest == levels[min(at, len(levels) - 2)])
    cells = mesh.extract_cells(chosen, pass_point_ids=False, pass_cell_ids=False)
    surface = blocks.plain_surface(cells)
    there: Foreign = np.asarray(surface.points, dtype=np.float64)[:, 2] == levels[at]
    return _kept_points(surface, there)


def stretched(mesh: pv.DataSet, factor: float, /) -> pv.DataSet:
    """Return a volume over a map in degrees in metres, its z times a factor.

    A vertical section has its y times it, and pressures from 100 to 1 on by their logarithm.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh, which is not changed.
    factor : float
        Factor of z, of a section that of y.

    Returns
    -------
    pyvista.DataSet

    Raises
    ------
    TypeError, ValueError
        If it is no dataset, or the factor is not finite and positive.
    """
    check_dataset(mesh)
    factor = _check.positive("factor", factor)
    if meaning.of(mesh).section:
        return sections.stretched(mesh, factor)
    return blocks.moved(georeference.in_metres(mesh), np.zeros(3), np.array([1.0, 1.0, factor]))


def _scalars(mesh: pv.DataSet, argument: str, name: str) -> Raw:
    """Return a point array of one component, or raise an error that names the argument."""
    data = mesh.point_data
    _check.text(argument, name, expected="the name of a point array")
    names = [key for key in (*data, *mesh.cell_data) if _are_numbers(mesh[key])]
    if name in data and name in names:
        return data[name]
    got = repr(name)
    if name in data:
        got = f"{name!r} of {_check.describe(data[name])}"
    raise _check.value_error(argument, f"an array of one component, {_check.one_of(names)}", got)


def _are_numbers(values: Raw) -> bool:
    return values.ndim == 1 and values.dtype.kind in "biuf"
