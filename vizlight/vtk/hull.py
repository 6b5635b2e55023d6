"""The outer surface of a dataset, whole or in parts, and the indices of its points in the dataset.

The parts are those of a structured grid, one after the other, so that little memory is used. Cells
of Bezier are taken as cells of Lagrange, with nodes on the surface of the mesh.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple, TypeAlias, TypeGuard

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonDataModel import (
    VTK_BEZIER_CURVE,
    VTK_BEZIER_WEDGE,
    VTK_LAGRANGE_CURVE,
    VTK_TRIANGLE_STRIP,
    vtkCellArray,
    vtkDataSetAttributes,
    vtkGenericCell,
    vtkImageData,
    vtkPolyData,
    vtkRectilinearGrid,
    vtkStructuredGrid,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter, vtkGeometryFilter

from vizlight import _pool
from vizlight._types import AnyArray, Array, Bools, Dataset, Foreign, Indices, Raw, Slice
from vizlight.vtk.arrays import points_of
from vizlight.vtk.cells import (
    DUPLICATE,
    GHOSTS,
    POLYDATA,
    as_numpy,
    as_vtk,
    connectivity,
    dimensions,
    finite_faces,
    grid_cells,
    has_marks,
    mixed_corners,
    new_cells,
    new_points,
    places,
    point_data,
    result,
    types_of_cells,
    unseen,
)
from vizlight.vtk.drawn import DrawnCells

Grid: TypeAlias = vtkImageData | vtkRectilinearGrid | vtkStructuredGrid

#: Attributes of rational cells: weights of points, and degrees of cells along their axes.
_WEIGHTS, _DEGREES = (vtkDataSetAttributes.RATIONALWEIGHTS, vtkDataSetAttributes.HIGHERORDERDEGREES)


def as_lagrange(grid: vtkUnstructuredGrid) -> vtkUnstructuredGrid:
    """Return a grid in which each cell of Bezier is that of Lagrange through the same surface.

    Point i of the result is the place of the surface at the parameters of control point i, of
    polynomial and of rational cells. Their error between nodes is that of the interpolation of a
    rational function by polynomials; polynomial cells stay as they are. A grid without such cells
    is returned itself.
    """
    # VTK has a number for pyramids, and no such cell.
    distinct = as_numpy(grid.GetDistinctCellTypesArray())
    if not np.any((distinct >= VTK_BEZIER_CURVE) & (distinct <= VTK_BEZIER_WEDGE)):
        return grid
    # The method that returns all of them has another name in each version of VTK.
    types = np.array([grid.GetCellType(i) for i in range(grid.GetNumberOfCells())])
    curved = (types >= VTK_BEZIER_CURVE) & (types <= VTK_BEZIER_WEDGE)
    ids, ends = connectivity(grid_cells(grid))
    control = places(grid).astype(np.float64)
    of_points = point_data(grid).GetAttribute(_WEIGHTS)
    weights = np.ones(len(control)) if of_points is None else as_numpy(of_points).reshape(-1)
    points_out, plain = control.copy(), vtkUnstructuredGrid()
    # A copy with the Bernstein polynomials alone as shape functions.
    plain.ShallowCopy(grid)
    point_data(plain).SetActiveAttribute(-1, _WEIGHTS)
    for cells in _alike(grid, types, np.diff(ends), np.flatnonzero(curved)):
        shares = _shares(plain.GetCell(int(cells[0])))
        corners = ids[ends[cells][:, np.newaxis] + np.arange(len(shares))]
        shares_of = weights[corners][..., np.newaxis]
        # A rational point is the mean of the control points by weight times Bernstein polynomial.
        sums = np.einsum("ij,mjk->mik", shares, shares_of * control[corners])
        points_out[corners] = sums / np.einsum("ij,mjk->mik", shares, shares_of)
    out = vtkUnstructuredGrid()
    out.ShallowCopy(grid)
    out.SetPoints(new_points(points_out))
    kinds = np.where(curved, types - VTK_BEZIER_CURVE + VTK_LAGRANGE_CURVE, types)
    out.SetCells(as_vtk(kinds.astype(np.uint8)), grid_cells(grid))
    return out


def _alike(
    grid: vtkUnstructuredGrid, types: AnyArray, sizes: AnyArray, cells: AnyArray
) -> list[AnyArray]:
    """Return the numbers of cells of one type, size and degree, for each of these."""
    degrees = grid.GetCellData().GetAttribute(_DEGREES)
    columns = [types[cells], sizes[cells]]
    if degrees is not None:
        columns += [*as_numpy(degrees)[cells].T]
    _, kind = np.unique(np.column_stack(columns), axis=0, return_inverse=True)
    return [cells[kind.reshape(-1) == i] for i in range(int(kind.max()) + 1)]


def _shares(cell: Foreign) -> Array:
    """Return the shape functions of a cell, a column for each, at the parameters of its points."""
    count = cell.GetNumberOfPoints()
    at = np.reshape(cell.GetParametricCoords(), (-1, 3))[:count]
    rows = np.empty((count, count))
    for row, place in zip(rows, at, strict=True):
        values = [0.0] * count
        cell.InterpolateFunctions(place, values)
        row[:] = values
    return rows


#: Name of temporary arrays of points and of cells, chosen not to clash with a user's array.
NUMBERS = "vizlight numbers"
#: Types of cells whose faces are flat or ruled: up to 20, convex point sets, polyhedra.
_LAST_LINEAR, _OTHER_LINEAR = 20, {41, 42}
#: Dimension of cells that fill space.
SOLID = 3
#: Type of polyhedra, whose faces are stored apart from their points.
_POLYHEDRON = 42
#: Places of the four nodes in the middle of sides, and of those at corners, among those of the six
#: triangles of a face, and the last two of these triangles where they are cut the other way.
_OF_MIDDLES = ([1, 3, 12, 15], [5, 6, 16], [8, 9, 13, 17], [2, 11, 14])
_OF_CORNERS = [0, 4, 7, 10]
_OTHER_CUT = [1, 5, 2, 5, 8, 2]
#: Types that stand for vertices, lines, polygons and strips.
_KINDS = (2, 4, 7, 6)


def cell_types(mesh: Dataset) -> set[int]:
    """Return the types of the cells of a grid, of a surface one for each kind, else nothing."""
    if isinstance(mesh, vtkPolyData):
        return {kind for kind, (count, _) in zip(_KINDS, POLYDATA, strict=True) if count(mesh)}
    if not isinstance(mesh, vtkUnstructuredGrid):
        return set()
    return set(np.unique(as_numpy(mesh.GetDistinctCellTypesArray())).tolist())


def dimension(mesh: Dataset) -> int:
    """Return the largest dimension of the cells of a dataset that is no vtkPolyData."""
    if not isinstance(mesh, vtkUnstructuredGrid):
        return int(mesh.GetDataDimension()) if hasattr(mesh, "GetDataDimension") else 3
    return max(map(_dimension, cell_types(mesh)), default=0)


def _dimension(kind: int) -> int:
    """Return the dimension of a type of cell."""
    cell = vtkGenericCell()
    cell.SetCellType(kind)
    return int(cell.GetCellDimension())


def is_curved(mesh: Dataset) -> bool:
    """Return whether a dataset has cells that are not linear."""
    return any(kind > _LAST_LINEAR and kind not in _OTHER_LINEAR for kind in cell_types(mesh))


def outer_surface(mesh: Dataset) -> tuple[vtkPolyData, Indices]:
    """Return the outer surface of a mesh, and the index of each of its points in the mesh.

    Each curved cell is replaced by a flat cell with the same nodes; those of a cell of Bezier are
    the places of its surface at the parameters of its control points. Points without cells
    have a surface of all points without cells. Where a flat polygon lies on the face of a solid
    cell, the surface has it once, wound as the face and with the data of the polygon.
    """
    return _numbered_surface(mesh)[:2]


def _numbered_surface(mesh: Dataset) -> tuple[vtkPolyData, Indices, Indices]:
    """Return :func:`outer_surface`, and the cell of the mesh that each of its cells is of."""
    surface, ids = _with_walls(mesh)
    # Flat polygons may lie on the faces of solid cells.
    if {SOLID - 1, SOLID}.issubset(map(_dimension, cell_types(mesh))):
        _join_walls(surface, mesh)
    cells = as_numpy(surface.GetCellData().GetArray(NUMBERS)).astype(np.intp)
    surface.GetCellData().RemoveArray(NUMBERS)
    return surface, ids, cells


def _with_walls(mesh: Dataset) -> tuple[vtkPolyData, Indices]:
    """Return :func:`outer_surface` with walls beside faces and with the numbers of its cells."""
    if not mesh.GetNumberOfCells():
        bare = vtkPolyData()
        bare.SetPoints(new_points(points_of(mesh, None)[:]))
        bare.GetCellData().AddArray(as_vtk(np.zeros(0, np.intp), NUMBERS))
        return bare, np.arange(mesh.GetNumberOfPoints())
    curved = is_curved(mesh)
    numbered: Foreign = mesh
    if curved:
        # Of cells of Bezier the control points are not on the surface.
        mesh = as_lagrange(mesh) if isinstance(mesh, vtkUnstructuredGrid) else mesh
        # VTK's ids of the nodes of curved cells are those within the cell, so the points of the
        # mesh are numbered here.
        numbered = mesh.NewInstance()
        numbered.ShallowCopy(mesh)
        numbers = np.arange(mesh.GetNumberOfPoints(), dtype=np.float64)
        numbered.GetPointData().AddArray(as_vtk(numbers, NUMBERS))
        numbered.GetCellData().AddArray(as_vtk(np.arange(mesh.GetNumberOfCells()), NUMBERS))
        take: Foreign = vtkDataSetSurfaceFilter()
        # Level 1 cuts a curved face by all of its nodes; 0 would drop those between its corners,
        # and more would add points that the mesh does not have.
        take.SetNonlinearSubdivisionLevel(1)
    else:
        take = vtkGeometryFilter()
        # An array of the mesh may have VTK's own name, whose surface was taken before.
        take.SetOriginalPointIdsName(NUMBERS)
        take.PassThroughPointIdsOn()
        take.SetOriginalCellIdsName(NUMBERS)
        take.PassThroughCellIdsOn()
    surface: vtkPolyData = result(take, numbered)
    ids = np.rint(as_numpy(surface.GetPointData().GetArray(NUMBERS))).astype(np.intp)
    surface.GetPointData().RemoveArray(NUMBERS)
    if curved:
        surface.SetPolys(_cut_as_curved(surface))
        if isinstance(mesh, vtkUnstructuredGrid):
            # Cells are numbered by VTK's kinds: vertices and lines first.
            before = surface.GetNumberOfVerts() + surface.GetNumberOfLines()
            cells = as_numpy(surface.GetCellData().GetArray(NUMBERS))[before:]
            surface.SetPolys(_outward(surface, mesh, cells))
        surface, ids = _merged(surface, ids)
    return surface, ids


def _join_walls(surface: vtkPolyData, grid: Dataset) -> None:
    """Take the faces that lie on polygons out of the surface of a grid, by its numbered cells."""
    before = surface.GetNumberOfVerts() + surface.GetNumberOfLines()
    cells = as_numpy(surface.GetCellData().GetArray(NUMBERS))[before:]
    ids, offsets = connectivity(surface.GetPolys())
    ids, sizes, doubled = ids.copy(), np.diff(offsets), []
    kinds = np.array([grid.GetCellType(cell) for cell in cells.tolist()])
    solid = np.isin(kinds, [kind for kind in np.unique(kinds) if _dimension(kind) == SOLID])
    for size in np.unique(sizes).tolist():
        polygons = np.flatnonzero(sizes == size)
        corners = offsets[polygons][:, np.newaxis] + np.arange(size)
        rows = np.sort(ids[corners], axis=1)
        # Equal ones stand beside each other, a wall before the face.
        order = np.lexsort((solid[polygons], *rows.T))
        pairs = np.all(np.diff(rows[order], axis=0) == 0, axis=1)
        pairs &= np.diff(solid[polygons[order]].astype(np.int8)) == 1
        wall, face = order[:-1][pairs], order[1:][pairs]
        ids[corners[wall]] = ids[corners[face]]
        doubled += polygons[face].tolist()
    surface.SetPolys(new_cells(ids, offsets))
    surface.BuildCells()
    for polygon in doubled:
        surface.DeleteCell(before + polygon)
    surface.RemoveDeletedCells()


def _cut_as_curved(surface: vtkPolyData) -> vtkCellArray:
    """Return the polygons of a surface, with faces of eight nodes cut as they are curved.

    VTK cuts such a face, of nodes at corners and in the middle of sides, into six triangles. Of the
    two ways to cut the four inner nodes, that counts which passes nearer to the middle of the
    curved face: the other one notches a cylinder at each face.
    """
    ids, offsets = connectivity(surface.GetPolys())
    start = offsets[:-1][np.diff(offsets) == 3]
    first = start[: max(len(start) - 5, 0)]
    first = first[start[5:] - first == 15]
    nodes = ids[first[:, np.newaxis] + np.arange(18)]
    is_face = np.ones(len(first), np.bool_)
    for slots in _OF_MIDDLES:
        is_face &= np.all(nodes[:, slots] == nodes[:, slots[:1]], axis=1)
    first, nodes = first[is_face], nodes[is_face]
    points = places(surface).astype(np.float64)
    middles = points[nodes[:, [slots[0] for slots in _OF_MIDDLES]]]
    centre = middles.sum(axis=1) / 2 - points[nodes[:, _OF_CORNERS]].sum(axis=1) / 4
    along, across = (
        np.linalg.norm(middles[:, i] / 2 + middles[:, i + 2] / 2 - centre, axis=1) for i in (0, 1)
    )
    # Both cut a flat face alike, but for rounding.
    size = np.linalg.norm(middles[:, 0] - middles[:, 2], axis=1)
    is_other = across < along - 1e-6 * size
    ids = ids.copy()
    ids[first[is_other, np.newaxis] + np.arange(12, 18)] = nodes[is_other][:, _OTHER_CUT]
    return new_cells(ids, offsets)


def _outward(surface: vtkPolyData, grid: vtkUnstructuredGrid, cells: Indices) -> vtkCellArray:
    """Return the polygons of a surface, those of solid cells facing away from the cells' middles.

    VTK winds the faces of quadratic wedges and hexahedra now this way, now that way.
    """
    ids, offsets = connectivity(surface.GetPolys())
    start, size = offsets[:-1], np.diff(offsets)
    first = [ids[start + i] for i in range(3)] if len(size) else [ids] * 3
    a, b, c = (places(surface)[corner].astype(np.float64) for corner in first)
    middles = _middles(grid)[cells]
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c - 3 * middles) < 0
    # One by one, since the array of all types has another name in each version of VTK.
    turned = np.unique(cells[inward])
    solid = {kind for kind in cell_types(grid) if _dimension(kind) == SOLID}
    fills = [grid.GetCellType(cell) in solid for cell in turned.tolist()]
    inward &= np.isin(cells, turned[np.array(fills, dtype=np.bool_)])
    # The corners of a polygon from its last to its first, or as they are.
    along = np.arange(len(ids)) - np.repeat(start, size)
    back = np.repeat(size, size) - 1 - along
    order = np.repeat(start, size) + np.where(np.repeat(inward, size), back, along)
    return new_cells(ids[order], offsets)


def _middles(grid: vtkUnstructuredGrid) -> Array:
    """Return the mean of the points of each cell, 0 for a cell of none."""
    ids, offsets = connectivity(grid.GetCells())
    cell, size = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets)), np.diff(offsets)
    points = places(grid)[ids]
    sums = [np.bincount(cell, points[:, i], len(size)) for i in range(3)]
    return np.asarray(np.stack(sums, axis=1) / np.maximum(size, 1)[:, np.newaxis])


def _merged(surface: vtkPolyData, ids: Indices) -> tuple[vtkPolyData, Indices]:
    """Return a surface with faces that share their points: VTK gives each curved face its own."""
    points, first, number = np.unique(ids, return_index=True, return_inverse=True)
    merged = vtkPolyData()
    merged.SetPoints(new_points(places(surface)[first]))
    for get, put in (
        (surface.GetVerts, merged.SetVerts),
        (surface.GetLines, merged.SetLines),
        (surface.GetPolys, merged.SetPolys),
    ):
        corners, offsets = connectivity(get())
        put(new_cells(number.reshape(-1)[corners], offsets))
    merged.GetCellData().ShallowCopy(surface.GetCellData())
    merged.GetFieldData().ShallowCopy(surface.GetFieldData())
    _take_rows(merged.GetPointData(), surface.GetPointData(), first)
    return merged, points


def _take_rows(part: vtkDataSetAttributes, whole: vtkDataSetAttributes, rows: Indices) -> None:
    """Give the points or the cells of a surface some rows of all arrays of those of a dataset."""
    for i in range(whole.GetNumberOfArrays()):
        # Arrays of words have no rows of numbers, and are no data of a picture.
        if (array := whole.GetArray(i)) is not None:
            at = part.AddArray(as_vtk(as_numpy(array)[rows], array.GetName()))
            if (kind := whole.IsArrayAnAttribute(i)) >= 0:
                part.SetActiveAttribute(at, kind)


#: Number of corners of the cells of a grid whose surface is found at once.
BLOCK = 1 << 21


def outer_faces(mesh: Dataset) -> tuple[vtkPolyData, Indices, Indices]:
    """Return :func:`outer_surface`, and the cell of each face, of many linear cells by blocks.

    VTK's filter would take memory for each point and cell of the whole. Faces that two blocks have
    in common are none of its surface. Lines and vertices are left out.
    """
    kinds = cell_types(mesh)
    flat, solid = ([k for k in kinds if _dimension(k) == n] for n in (SOLID - 1, SOLID))
    if not isinstance(mesh, vtkUnstructuredGrid) or is_curved(mesh) or VTK_TRIANGLE_STRIP in kinds:
        return _numbered_surface(mesh)
    if not solid or mesh.GetCells().GetNumberOfConnectivityIds() <= BLOCK:
        return _numbered_surface(mesh)
    types, ghosts = as_numpy(types_of_cells(mesh)), mesh.GetCellData().GetArray(GHOSTS)
    kept = [mesh.GetCells()]
    if _POLYHEDRON in kinds:
        kept += [mesh.GetPolyhedronFaceLocations(), mesh.GetPolyhedronFaces()]
    every = [DrawnCells(each, 1) for each in kept]
    corners, ends, cells = np.zeros(0, np.intp), np.zeros(1, np.intp), np.zeros(0, np.intp)
    size = max(map(len, every))
    for block in _pool.blocks(len(types), max(BLOCK * len(types) // size, 1)):
        part, own = _part(mesh, every, types[block], block)
        if ghosts is not None:
            marks = as_numpy(ghosts)[block]
            # What is between cells and their twins in another piece is inside.
            part.GetCellData().AddArray(as_vtk(np.where(marks & DUPLICATE, 0, marks), GHOSTS))
        surface, origin = _with_walls(part)
        more, stops = connectivity(surface.GetPolys())
        corners = np.concatenate([corners, own[origin[more]]])
        ends = np.concatenate([ends, ends[-1] + stops[1:]])
        first = surface.GetNumberOfVerts() + surface.GetNumberOfLines()
        number = as_numpy(surface.GetCellData().GetArray(NUMBERS))[first:]
        cells = np.concatenate([cells, number + block.start])
        inside = _are_twins(corners, ends, ~np.isin(types[cells], flat), own[0], own[-1])
        corners, ends, cells = _without(inside, corners, ends, cells)
    marked = unseen(mesh, cells, lambda: (corners, ends))
    corners, ends, cells = _without(marked, corners, ends, cells)
    whole = vtkPolyData()
    origin, corners = np.unique(corners, return_inverse=True)
    whole.SetPoints(new_points(places(mesh)[origin]))
    whole.SetPolys(new_cells(corners, ends))
    if flat:
        whole.GetCellData().AddArray(as_vtk(cells, NUMBERS))
        _join_walls(whole, mesh)
        cells = as_numpy(whole.GetCellData().GetArray(NUMBERS)).copy()
        whole.GetCellData().RemoveArray(NUMBERS)
    _take_rows(whole.GetPointData(), mesh.GetPointData(), origin)
    _take_rows(whole.GetCellData(), mesh.GetCellData(), cells)
    return whole, origin, cells


def _part(
    grid: vtkUnstructuredGrid, every: Sequence[DrawnCells], types: AnyArray, block: Slice
) -> tuple[vtkUnstructuredGrid, Indices]:
    """Return the cells of a block without arrays, and their points, rising."""
    ids, ends = every[0].of_block(block)
    # Neighbouring cells mostly have neighbouring points.
    low, high = int(ids.min()), int(ids.max()) + 1
    own = np.arange(low, high) if high - low <= len(ids) else np.unique(ids)

    def cells(ids: Indices, ends: Indices, *, of_points: bool = True) -> vtkCellArray:
        if of_points and dense:
            ids = np.subtract(ids, low, dtype=np.int32, casting="unsafe")
        elif of_points:
            ids = np.searchsorted(own, ids)
        return new_cells(*(each.astype(np.int32, copy=False) for each in (ids, ends)))

    part, kinds = vtkUnstructuredGrid(), as_vtk(types)
    dense = len(own) == high - low
    part.SetPoints(new_points(places(grid)[low:high] if dense else places(grid)[own]))
    if _POLYHEDRON not in types:
        part.SetCells(kinds, cells(ids, ends))
        return part, own
    names, stops = every[1].of_block(block)
    faces = cells(*every[2].corners(names))
    numbers = cells(np.arange(len(names)), stops, of_points=False)
    part.SetPolyhedralCells(kinds, cells(ids, ends), numbers, faces)
    return part, own


def _are_twins(
    corners: Indices, ends: Indices, solid: Bools, low: int, high: int
) -> Bools:  # fmt: skip
    """Return which faces of solid cells have a twin of points from ``low`` to ``high``."""
    some = np.logical_and.reduceat((corners >= low) & (corners <= high), ends[:-1]) & solid
    sizes = np.diff(ends)
    some_ends = np.concatenate([[0], np.cumsum(sizes[some])])
    numbers = mixed_corners(new_cells(corners[np.repeat(some, sizes)], some_ends))
    twins = np.zeros(len(sizes), dtype=np.bool_)
    order, rows = np.argsort(numbers), np.flatnonzero(some)
    ordered = numbers[order]
    same = ordered[1:] == ordered[:-1]
    twins[rows[order[1:][same]]] = twins[rows[order[:-1][same]]] = True
    return twins


def _without(
    polygons: Bools, corners: Indices, ends: Indices, cells: Indices
) -> tuple[Indices, Indices, Indices]:
    """Return the corners of polygons, where each begins, and their cells, without some."""
    sizes, kept = np.diff(ends), ~polygons
    stops = np.concatenate([[0], np.cumsum(sizes[kept])])
    return corners[np.repeat(kept, sizes)], stops, cells[kept]


def surface_of(mesh: Dataset) -> tuple[vtkPolyData, Indices | None]:
    """Return :func:`outer_surface`; a surface is its own, and has no indices."""
    return (mesh, None) if isinstance(mesh, vtkPolyData) else outer_surface(mesh)


def scattered(rows: AnyArray, origin: Indices, count: int) -> AnyArray:
    """Return an array of all points of a mesh from one of its surface; other rows are zero."""
    out = np.zeros((count, *rows.shape[1:]), dtype=rows.dtype)
    out[origin] = rows
    return out


#: Number of points of a part. Its surface takes some 200 bytes for each of them.
PART = 1 << 14
#: Share of the points of a grid on its surface up to which that takes little memory as a whole.
FEW = 1 / 16


class GridPart(NamedTuple):
    """The outer surface of some layers of a grid, with the layer before and the one after them.

    It has the faces around all points of those layers, but for those with a corner that is not
    finite; ``origin`` is the point of the grid that each point is, and ``side`` is 0 for points of
    those layers, -1 in the layer before, 1 in the layer after.
    """

    surface: vtkPolyData
    origin: Indices
    side: NDArray[np.int8]


def in_parts(mesh: Dataset) -> TypeGuard[Grid]:
    """Return whether a mesh is a grid, all of it seen, with a surface that takes much memory."""
    if not isinstance(mesh, vtkImageData | vtkRectilinearGrid | vtkStructuredGrid):
        return False
    size = np.array(dimensions(mesh))
    count = size.prod()
    # Without two axes along which it extends a grid has no faces.
    if count <= PART or np.count_nonzero(size > 1) < 2:
        return False
    # A cube has few points on its surface; a sheet has all of them there.
    if count - np.maximum(size - 2, 0).prod() <= FEW * count:
        return False
    # Hidden cells may cut a grid into several pieces, while its parts are taken for one.
    return not has_marks(mesh)


def parts(mesh: Grid) -> Iterator[GridPart]:
    """Yield the surface of a grid by layers across its longest axis."""
    size = dimensions(mesh)
    # Of axes of equal length the last: the later the axis, the longer the stretches of memory.
    axis = max(range(3), key=lambda i: (size[i], i))
    count = size[axis]
    layers = max(PART * count // mesh.GetNumberOfPoints(), 1)
    for start in range(0, count, layers):
        stop = min(start + layers, count)
        low, high = max(start - 1, 0), min(stop + 1, count)
        # A layer more on either side: normals and borders at the cut are then those of the whole.
        # Without the arrays, which would be copied for each part.
        bare: Foreign = mesh.NewInstance()
        bare.CopyStructure(mesh)
        extent = list(mesh.GetExtent())
        extent[2 * axis : 2 * axis + 2] = extent[2 * axis] + low, extent[2 * axis] + high - 1
        surface, ids = outer_surface(cropped(bare, extent))
        # The number of a point in the layers becomes its number in the grid: VTK's first index
        # varies fastest.
        inner = (*size[:axis], high - low, *size[axis + 1 :])
        index = list(np.unravel_index(ids, inner, order="F"))
        index[axis] = layer = index[axis] + low
        side = (layer >= stop).astype(np.int8) - (layer < start)
        # The cut itself makes faces too: those between points of the added layers alone are no
        # surface of the grid.
        around = finite_faces(surface, side == 0)
        yield GridPart(around, np.ravel_multi_index(index, size, order="F"), side)


def cropped(mesh: Foreign, extent: Sequence[int]) -> Foreign:
    """Return a part of a grid, with its arrays."""
    # Libraries of VTK that few meshes need take longer to load than a small mesh to light.
    from vtkmodules.vtkFiltersExtraction import vtkExtractGrid, vtkExtractRectilinearGrid
    from vtkmodules.vtkImagingCore import vtkExtractVOI

    filters = (
        (vtkImageData, vtkExtractVOI),
        (vtkRectilinearGrid, vtkExtractRectilinearGrid),
        (vtkStructuredGrid, vtkExtractGrid),
    )
    take: Foreign = next(extract for kind, extract in filters if isinstance(mesh, kind))()
    take.SetVOI(extent)
    return result(take, mesh)


def rim(mesh: Grid) -> list[Raw]:
    """Return the points along the four borders of a sheet; none for a grid that fills space."""
    size = dimensions(mesh)
    if 1 not in size:
        return []
    row, _ = (n for n in size if n > 1)
    points, last = points_of(mesh, None), mesh.GetNumberOfPoints()
    # First and last row, then first and last column.
    lines = slice(row), slice(last - row, last), slice(0, last, row), slice(row - 1, last, row)
    return [points[line] for line in lines]
