"""Triangles and segments as VTK's renderer draws them, made for some of them and not stored."""

from __future__ import annotations

from functools import partial

import numpy as np
from vtkmodules.vtkCommonDataModel import (
    VTK_BIQUADRATIC_QUAD,
    VTK_BIQUADRATIC_TRIANGLE,
    VTK_LINE,
    VTK_POLYGON,
    VTK_QUAD,
    VTK_QUADRATIC_QUAD,
    VTK_QUADRATIC_TRIANGLE,
    VTK_TRIANGLE,
    vtkCellArray,
    vtkExplicitStructuredGrid,
    vtkPolyData,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkFiltersCore import vtkTriangleFilter

from vizlight import _pool
from vizlight._types import AnyArray, Bools, Dataset, Indices, Rows, Slice
from vizlight.vtk.cells import (
    as_numpy,
    as_vtk,
    bare_faces,
    cell_arrays,
    connectivity,
    dimensions,
    grid_cells,
    has_faces,
    has_marks,
    new_cells,
    result,
    unseen,
)

#: Numbers of corners.
SEGMENT, TRIANGLE, QUAD = 2, 3, 4
#: Nodes of the triangles by which VTK's renderer draws curved faces.
CURVED = {
    VTK_QUADRATIC_TRIANGLE: "035 314 542 453",
    VTK_QUADRATIC_QUAD: "047 415 526 637 467 456",
    VTK_BIQUADRATIC_TRIANGLE: "036 634 645 065 314 542",
    VTK_BIQUADRATIC_QUAD: "047 415 526 637 487 458 568 678",
}
#: Number of polygons that are looked at at once.
BLOCK = 1 << 16
#: Least number of entries of the table of marked points, beyond which some share an entry, and
#: least number of entries for each of them.
TABLE, SHARE = 1 << 20, 16


class DrawnPoints:
    """Numbers of all points of a mesh, which are cells of one corner."""

    def __init__(self, count: int) -> None:
        self.shape = (count, 1)

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, rows: Rows, /) -> Indices:
        """Return some of the points, shape (M, 1)."""
        numbers = np.arange(*rows.indices(len(self))) if isinstance(rows, slice) else rows
        return np.asarray(numbers)[:, np.newaxis]


class DrawnCells:
    """Parts of polygons or of lines, all with as many corners, one after the other.

    ``size`` is the number of corners of a part, and ``cells`` the cell of the mesh that each
    polygon or line is, or that of the first.
    """

    def __init__(self, whole: vtkCellArray, size: int, cells: Indices | int = 0) -> None:
        #: Number of polygons or lines.
        self.polygons = whole.GetNumberOfCells()
        self._part, self._size = size, max(whole.IsHomogeneous(), 0)
        self._cells, self._each = cells, 1
        self._ids: Indices | _GridCorners | _CurvedCorners = as_numpy(whole.GetConnectivityArray())
        self._offsets = np.zeros(0, np.intp) if self._size else as_numpy(whole.GetOffsetsArray())

    @classmethod
    def all_of(cls, mesh: Dataset) -> list[DrawnCells]:
        """Return all cells of a mesh by kind, the parts of which are their corners."""
        if sides := [count for count in dimensions(mesh) if count > 1]:
            if not isinstance(mesh, vtkExplicitStructuredGrid):
                cells = cls(vtkCellArray(), 1)
                cells._take_grid(*sides)
                return [cells]
            return [cls(mesh.GetCells(), 1)]
        kinds, every, first = cell_arrays(mesh), list[DrawnCells](), 0
        for kind in kinds:
            every.append(cls(kind, 1, first))
            first += kind.GetNumberOfCells()
        return every

    def _take_grid(self, *sides: int) -> None:
        """Take the cells of a grid of some numbers of points, with corners without memory."""
        self._ids = _GridCorners(*sides)
        self._size = self._ids.count
        self.polygons = len(self._ids) // self._size

    def _take_curved(self, whole: vtkCellArray, nodes: str) -> None:
        """Take the triangles of curved faces of one kind as polygons, without memory."""
        self._ids = _CurvedCorners(as_numpy(whole.GetConnectivityArray()), nodes)
        self._size, self._each = TRIANGLE, len(nodes.split())
        self.polygons = len(self._ids) // TRIANGLE

    @property
    def shape(self) -> tuple[int, int]:
        """Shape of an array of the corners."""
        return len(self._ids) - (self._part - 1) * self.polygons, self._part

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, rows: Rows, /) -> Indices:
        """Return the points at the corners of some parts, shape (M, s)."""
        if self._size == self._part and isinstance(self._ids, np.ndarray):
            return np.reshape(self._ids, (-1, self._part))[rows]
        return self._some(*self._places(rows))

    def polygon(self, rows: Rows) -> Indices:
        """Return the polygons that some triangles are of, or the lines of some segments."""
        return self._places(rows)[0]

    def cells(self, rows: Rows) -> Indices:
        """Return the cells of the mesh that some parts are of."""
        return self.cells_of(self._places(rows)[0])

    def cells_of(self, polygon: Indices) -> Indices:
        """Return the cells of the mesh that some polygons or lines are."""
        if isinstance(self._cells, np.ndarray):
            return self._cells[polygon]
        return polygon // self._each + self._cells

    def corners(self, polygon: Indices) -> tuple[Indices, Indices]:
        """Return the corners of some polygons, one after the other, and where each begins."""
        start, size = self._ends(polygon)
        ends = np.concatenate([[0], np.cumsum(size)])
        return self._ids[np.repeat(start - ends[:-1], size) + np.arange(ends[-1])], ends

    def sizes(self, polygon: Indices) -> Indices:
        """Return how many corners some polygons or lines have."""
        return self._ends(polygon)[1]

    def around(self, points: Indices) -> Indices:
        """Return the polygons that have a corner among some points."""
        table = np.zeros(max(TABLE, SHARE * len(points)), dtype=np.bool_)
        table[points % len(table)] = True
        # A mask of all points would be as long as the mesh.
        known = np.sort(points)
        found = []
        # Lines may have many points: as many corners as BLOCK quadrilaterals.
        step = max(1, QUAD * BLOCK * self.polygons // max(len(self._ids), 1))
        for block in _pool.blocks(self.polygons, step):
            polygon = np.flatnonzero(self._any(table, block)) + block.start
            ids, ends = self.corners(polygon)
            at = np.minimum(np.searchsorted(known, ids), len(known) - 1)
            found.append(polygon[np.logical_or.reduceat(known[at] == ids, ends[:-1])])
        return np.concatenate(found)

    def _any(self, table: Bools, block: Slice) -> Bools:
        """Return which polygons of a block have a corner in a table of points."""
        ids, ends = self.of_block(block)
        known = table[ids % len(table)]
        if self._size:
            return np.asarray(known.reshape(-1, self._size).any(axis=1))
        # Some cells may have no corners.
        return np.asarray(np.diff(np.append(0, np.cumsum(known))[ends]) > 0)

    def of_block(self, block: Slice) -> tuple[Indices, Indices]:
        """Return the corners of polygons that follow each other, and where each begins."""
        if self._size:
            ends = np.arange(block.start, block.stop + 1) * self._size
        else:
            ends = self._offsets[block.start : block.stop + 1]
        return self._ids[ends[0] : ends[-1]], ends - ends[0]

    def _ends(self, polygon: Indices) -> tuple[Indices, Indices]:
        """Return where the corners of polygons begin, and how many they are."""
        if self._size:
            return polygon * self._size, np.full(len(polygon), self._size)
        start = self._offsets[polygon].astype(np.intp)
        return start, self._offsets[polygon + 1] - start

    def _places(self, rows: Rows) -> tuple[Indices, Indices]:
        """Return the polygons of triangles, and which of the triangles of these they are."""
        number = rows
        if isinstance(rows, slice):
            number = np.arange(*rows.indices(len(self)))
        if self._size:
            polygon, place = np.divmod(number, self._size - self._part + 1)
            return polygon, place
        # Polygons before one have fewer triangles than corners, by two each, and lines have fewer
        # segments by one. Bisection takes no table.
        fewer = self._part - 1
        low = np.zeros(len(number), dtype=np.intp)
        high = np.full(len(number), self.polygons)
        for _ in range(self.polygons.bit_length()):
            middle = (low + high) // 2
            before = self._offsets[middle] - fewer * middle <= number
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        return low, number - (self._offsets[low] - fewer * low)

    def _some(self, polygon: Indices, place: Indices) -> Indices:
        """Return the corners of parts by their places in polygons or lines."""
        start = self._ends(polygon)[0] + place
        return np.stack([self._ids[start + i] for i in range(self._part)], axis=1)


class DrawnTriangles(DrawnCells):
    """Triangles of a surface as VTK's renderer draws it, polygon by polygon.

    It halves all quadrilaterals from their first corner to their third, and not by the shorter
    diagonal. Strips are split after all polygons, of which those with ``least`` corners are kept;
    those of 2 have no triangles.
    """

    def __init__(self, surface: vtkPolyData, least: int = TRIANGLE) -> None:
        before = surface.GetNumberOfVerts() + surface.GetNumberOfLines()
        cells: Indices | int = before
        if surface.GetNumberOfStrips():
            surface, cells = _without_strips(surface)
        kept = _are_of(surface.GetPolys(), least)
        if not kept.all():
            kept = np.broadcast_to(kept, surface.GetNumberOfPolys())
            cells = (cells if isinstance(cells, np.ndarray) else cells + np.arange(len(kept)))[kept]
            surface = bare_faces(surface, kept)
        super().__init__(surface.GetPolys(), TRIANGLE, cells)
        self._points = surface.GetPoints()
        #: Whether the mesh may have cells that are none of the polygons.
        self.beside = before > 0
        #: Grid with hidden cells that they are the cells of, if any.
        self.grid: Dataset | None = None

    @classmethod
    def of(cls, mesh: Dataset) -> DrawnTriangles | None:
        """Return the triangles of a mesh with faces in memory or in rows, else None.

        It is a surface, a grid of plain polygons, segments among them, one of curved faces of one
        kind, or one of a single layer of points. Of the latter alone VTK leaves hidden cells out:
        their triangles are of one point.
        """
        if isinstance(mesh, vtkPolyData):
            return cls(mesh) if has_faces(mesh) else None
        sides = [count for count in dimensions(mesh) if count > 1]
        if len(sides) == 2 and not isinstance(mesh, vtkExplicitStructuredGrid):
            triangles = cls(vtkPolyData())
            triangles._take_grid(*sides)
            triangles.grid = mesh if has_marks(mesh) else None
            return triangles
        if not isinstance(mesh, vtkUnstructuredGrid):
            return None
        kinds = {*as_numpy(mesh.GetDistinctCellTypesArray()).tolist()}
        if len(kinds) == 1 and (nodes := CURVED.get(min(kinds))):
            triangles = cls(vtkPolyData())
            triangles._take_curved(grid_cells(mesh), nodes)
            # A cell counts once at a point, however many of its triangles are there.
            triangles.beside = True
            return triangles
        faces = {VTK_TRIANGLE, VTK_QUAD, VTK_POLYGON}
        if not kinds & faces or kinds - faces - {VTK_LINE}:
            return None
        surface = vtkPolyData()
        surface.SetPoints(mesh.GetPoints())
        surface.SetPolys(grid_cells(mesh))
        triangles = cls(surface, SEGMENT)
        triangles.beside = VTK_LINE in kinds
        return triangles

    def around(self, points: Indices) -> Indices:
        """Return the polygons that have a corner among some points, but for hidden ones."""
        polygon = super().around(points)
        if self.beside:
            polygon = polygon[self.sizes(polygon) > SEGMENT]
        return polygon[~self._unseen(polygon)]

    def _unseen(self, polygon: Indices) -> Bools:
        """Return which polygons are hidden."""
        hidden = np.zeros(len(polygon), dtype=np.bool_)
        for block in [] if self.grid is None else _pool.blocks(len(polygon), BLOCK):
            some = polygon[block]
            hidden[block] = unseen(self.grid, some, partial(self.corners, some))
        return hidden

    def _some(self, polygon: Indices, place: Indices) -> Indices:
        start, size = self._ends(polygon)
        fan = [self._ids[start], self._ids[start + place + 1], self._ids[start + place + 2]]
        corners = np.stack(fan, axis=1)
        many = size > QUAD
        if many.any():
            corners[many] = self._cut(polygon[many], place[many])
        hidden = self._unseen(polygon)
        corners[hidden] = corners[hidden, :1]
        return corners

    def _cut(self, polygon: Indices, place: Indices) -> Indices:
        """Return some of the triangles into which VTK cuts polygons of many corners."""
        names, which = np.unique(polygon, return_inverse=True)
        ids, ends = self.corners(names)
        some = vtkPolyData()
        some.SetPoints(self._points)
        some.SetPolys(new_cells(ids, ends))
        some.GetCellData().AddArray(as_vtk(np.arange(len(names)), "number"))
        output = result(vtkTriangleFilter(), some)
        triangles = connectivity(output.GetPolys())[0].reshape(-1, TRIANGLE)
        count = np.bincount(as_numpy(output.GetCellData().GetArray("number")), minlength=len(names))
        # What VTK cannot cut, it does not draw: a triangle of one point.
        corners = np.repeat(ids[ends[:-1]][which, np.newaxis], TRIANGLE, axis=1)
        there = place < count[which]
        corners[there] = triangles[(np.cumsum(count) - count)[which[there]] + place[there]]
        return corners


class DrawnSegments(DrawnCells):
    """Segments of lines. ``first`` is the cell of the mesh that the first line is."""

    def __init__(self, lines: vtkCellArray, first: int = 0) -> None:
        super().__init__(lines, SEGMENT, first)

    @classmethod
    def of(cls, mesh: Dataset) -> DrawnSegments | None:
        """Return the segments of a mesh of lines that stand in memory, else None."""
        if not isinstance(mesh, vtkPolyData) or has_faces(mesh) or not mesh.GetNumberOfLines():
            return None
        lines, first = mesh.GetLines(), mesh.GetNumberOfVerts()
        return cls(lines, first) if _are_of(lines, SEGMENT).all() else None

    @property
    def are_single(self) -> bool:
        """Whether all lines are single segments."""
        return self._size == SEGMENT

    @property
    def may_join(self) -> bool:
        """Whether some lines are single segments, which may be parts of longer lines."""
        if self._size:
            return self.are_single
        blocks = _pool.blocks(self.polygons, BLOCK)
        sizes = (np.diff(self._offsets[block.start : block.stop + 1]) for block in blocks)
        return any((each == SEGMENT).any() for each in sizes)


class _GridCorners:
    """Points at the corners of the cells of a grid, as an array of them without memory."""

    def __init__(self, width: int, height: int, depth: int = 1) -> None:
        self._width, self._height = width, height
        #: Number of corners of a cell.
        self.count = QUAD if depth == 1 else 2 * QUAD
        self._size = self.count * (width - 1) * (height - 1) * max(depth - 1, 1)

    def __len__(self) -> int:
        return self._size

    def __getitem__(self, index: Rows, /) -> Indices:
        """Return the points at some corners; those of a quadrilateral stand around it."""
        if isinstance(index, slice):
            index = np.arange(*index.indices(self._size))
        cell, corner = np.divmod(index, self.count)
        row, column = np.divmod(cell, self._width - 1)
        layer, row = np.divmod(row, self._height - 1)
        above, corner = np.divmod(corner, QUAD)
        row += (corner > 1) + self._height * (layer + above)
        points: Indices = column + (corner % 3 > 0) + self._width * row
        return points


class _CurvedCorners:
    """Points at the corners of the triangles of curved faces, as an array without memory."""

    def __init__(self, ids: Indices, nodes: str) -> None:
        self._ids, triangles = ids, nodes.split()
        self._nodes = np.array([int(node) for node in "".join(triangles)])
        self._size = int(self._nodes.max()) + 1

    def __len__(self) -> int:
        return len(self._ids) // self._size * len(self._nodes)

    def __getitem__(self, index: Rows, /) -> Indices:
        """Return the points at some corners."""
        if isinstance(index, slice):
            index = np.arange(*index.indices(len(self)))
        cell, corner = np.divmod(index, len(self._nodes))
        points: Indices = self._ids[cell * self._size + self._nodes[corner]]
        return points


def _are_of(polys: vtkCellArray, least: int) -> Bools:
    """Return which cells have some number of corners or more, or one value for all."""
    if (size := polys.IsHomogeneous()) >= 0:
        return np.array([size == 0 or size >= least])
    offsets = as_numpy(polys.GetOffsetsArray())
    blocks = _pool.blocks(polys.GetNumberOfCells(), BLOCK)
    few = (np.diff(offsets[block.start : block.stop + 1]) < least for block in blocks)
    if not any(each.any() for each in few):
        return np.array([True])
    return np.asarray(np.diff(offsets) >= least)


def _without_strips(surface: vtkPolyData) -> tuple[vtkPolyData, Indices]:
    """Return a surface with triangles in the place of strips, and the cell that each polygon is."""
    before = surface.GetNumberOfVerts() + surface.GetNumberOfLines()
    polygons = surface.GetNumberOfPolys()
    strips = vtkPolyData()
    strips.SetPoints(surface.GetPoints())
    strips.SetStrips(surface.GetStrips())
    number = before + polygons + np.arange(surface.GetNumberOfStrips())
    strips.GetCellData().AddArray(as_vtk(number, "number"))
    output = result(vtkTriangleFilter(), strips)
    ids, offsets = connectivity(surface.GetPolys())
    more, ends = connectivity(output.GetPolys())
    whole = bare_faces(surface)
    whole.SetStrips(vtkCellArray())
    ends = np.concatenate([offsets, offsets[-1] + ends[1:]])
    whole.SetPolys(new_cells(np.append(ids, more), ends))
    numbers: AnyArray = as_numpy(output.GetCellData().GetArray("number"))
    return whole, np.append(before + np.arange(polygons), numbers)
