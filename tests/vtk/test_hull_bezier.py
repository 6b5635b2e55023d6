"""Cells of Bezier are lit on their surface, at all of their control points."""

import numpy as np
import pytest
import pyvista as pv
from pyvista.examples import cells
from vtkmodules.vtkCommonCore import reference

import vizlight
from vizlight import Light, Material, Scene, View
from vizlight.vtk.hull import as_lagrange

TOWARD = np.array([0.3, 0.5, 0.8]) / np.sqrt(0.98)
SCENE = Scene(
    lights=Light(direction=TOWARD),
    material=Material(ambient=0.1, diffuse=0.9),
    view=View(direction=(1, 1, 1), parallel=True),
)


@pytest.mark.parametrize("kind", ["Quadrilateral", "Triangle"])
def test_all_points_of_a_flat_cell_are_lit(kind):
    lit = getattr(cells, f"Bezier{kind}")().vizlight.illuminate(SCENE)["luminance"]
    np.testing.assert_allclose(lit, 0.1 + 0.9 * TOWARD[2], atol=1e-6)


@pytest.mark.filterwarnings("ignore:.*sharper than")
@pytest.mark.parametrize("kind", ["Hexahedron", "Tetrahedron", "Wedge"])
def test_solids_of_bezier_are_lit_as_those_of_lagrange(kind):
    one, other = (getattr(cells, f"{name}{kind}")() for name in ("Bezier", "Lagrange"))
    # Straight cells have one shape: their control points are their nodes.
    np.testing.assert_allclose(one.points, other.points)
    np.testing.assert_allclose(
        one.vizlight.illuminate(SCENE)["luminance"],
        other.vizlight.illuminate(SCENE)["luminance"],
        atol=1e-6,
    )


def cylinder():
    """Return a quarter of a cylinder of radius 1, exact as a rational cell of degrees 2 and 1."""
    points = [[1, 0, 0], [0, 1, 0], [0, 1, 2], [1, 0, 2], [1, 1, 0], [1, 1, 2]]
    cell = np.array([6, 0, 1, 2, 3, 4, 5])
    kind = pv.CellType.BEZIER_QUADRILATERAL
    grid = pv.UnstructuredGrid(cell, [kind], np.array(points, dtype=float))
    weights = np.array([1, 1, 1, 1, 0.5**0.5, 0.5**0.5])
    grid.GetPointData().SetRationalWeights(pv.convert_array(weights, "weights"))
    degrees = np.array([[2.0, 1.0, 0.0]])
    grid.GetCellData().SetHigherOrderDegrees(pv.convert_array(degrees, "degrees"))
    return grid


@pytest.mark.filterwarnings("ignore:.*sharper than")
def test_nodes_of_a_rational_cell_are_on_its_surface():
    found = pv.wrap(as_lagrange(cylinder()))
    np.testing.assert_allclose(np.linalg.norm(found.points[:, :2], axis=1), 1, atol=1e-12)
    assert set(found.celltypes) == {pv.CellType.LAGRANGE_QUADRILATERAL}
    lit = vizlight.illuminate(cylinder(), SCENE)["luminance"]
    # In the middle of the arc normals of its two chords are averaged to that of the cylinder.
    middle = 0.1 + 0.9 * (TOWARD[0] + TOWARD[1]) / np.sqrt(2)
    np.testing.assert_allclose(lit[4:], middle, atol=0.005)


#: Number of the points of a cell of each kind by its degree.
SIZES = {
    "CURVE": lambda d: d + 1,
    "TRIANGLE": lambda d: (d + 1) * (d + 2) // 2,
    "QUADRILATERAL": lambda d: (d + 1) ** 2,
    "TETRAHEDRON": lambda d: (d + 1) * (d + 2) * (d + 3) // 6,
    "HEXAHEDRON": lambda d: (d + 1) ** 3,
    "WEDGE": lambda d: (d + 1) ** 2 * (d + 2) // 2,
}


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
@pytest.mark.parametrize("kind", SIZES)
def test_nodes_of_any_degree_are_where_vtk_has_them(kind, degree):
    random, n = np.random.default_rng(degree), SIZES[kind](degree)
    cell_type = getattr(pv.CellType, f"BEZIER_{kind}")
    grid = pv.UnstructuredGrid([n, *range(n)], [cell_type], random.normal(size=(n, 3)))
    if kind in ("QUADRILATERAL", "HEXAHEDRON", "WEDGE"):
        degrees = np.full((1, 3), float(degree))
        grid.GetCellData().SetHigherOrderDegrees(pv.convert_array(degrees, "degrees"))
    weights = random.uniform(0.3, 2, n)
    grid.GetPointData().SetRationalWeights(pv.convert_array(weights, "weights"))
    nodes = pv.wrap(as_lagrange(grid)).points
    cell, place = grid.GetCell(0), [0.0] * 3
    for node, at in zip(nodes, np.reshape(cell.GetParametricCoords(), (-1, 3))[:n], strict=True):
        cell.EvaluateLocation(reference(0), [*at], place, [0.0] * n)
        np.testing.assert_allclose(node, place, atol=1e-14)


def test_a_pyramid_is_no_cell_of_vtk():
    grid = pv.ImageData(dimensions=(2, 2, 2)).cast_to_unstructured_grid()
    ids = pv.CellArray.from_regular_cells(np.arange(5)[np.newaxis])
    grid.SetCells(pv.convert_array(np.array([pv.CellType.BEZIER_PYRAMID], np.uint8)), ids)
    with pytest.raises(ValueError, match="types that VTK has, got one of type 81"):
        vizlight.illuminate(grid, SCENE)


def test_a_grid_of_other_cells_stays_itself():
    grid = pv.ImageData(dimensions=(2, 2, 2)).cast_to_unstructured_grid()
    assert as_lagrange(grid) is grid
