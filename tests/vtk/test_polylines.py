"""Lines are lit by their own tangents, whatever cells they come in."""

import numpy as np
import pytest
import pyvista as pv
from lamps import SHINY, far

import vizlight
from vizlight import Light, Scene, View, illuminate
from vizlight.vtk import polylines

SCENE = Scene(lights=Light(direction=(1, 0.4, 1)), view=View(direction=(0, 0.2, 1)), material=SHINY)


def circle(count=40, *, closed=True):
    s = np.linspace(0, 2 * np.pi, count, endpoint=not closed)
    points = np.stack([np.cos(s), np.sin(s), 0 * s], axis=1)
    ids = [*range(count), 0] if closed else [*range(count)]
    return pv.PolyData(points, lines=[len(ids), *ids])


def exact(points):
    x, y, _ = np.asarray(points).T
    return np.stack([-y, x, 0 * x], axis=1) / np.hypot(x, y)[:, np.newaxis]


def test_a_polyline_is_lit_by_its_tangents():
    mesh = circle()
    lit = illuminate(mesh, SCENE)
    mesh["T"] = exact(mesh.points)
    np.testing.assert_allclose(
        lit["luminance"], illuminate(mesh, SCENE, tangents="T")["luminance"], atol=1e-12
    )


def test_a_named_array_wins():
    mesh = circle()
    mesh["z"] = np.tile([0, 0, 1.0], (mesh.n_points, 1))
    lit = illuminate(mesh, SCENE, tangents="z")
    assert np.ptp(lit["luminance"]) < 1e-12


def test_segments_are_joined():
    mesh = circle()
    ids = np.arange(40)
    pairs = np.stack([np.full(40, 2), ids, np.roll(ids, -1)], axis=1)
    pieces = pv.PolyData(mesh.points, lines=pairs[np.random.default_rng(1).permutation(40)].ravel())
    tangents = polylines.line_tangents(pieces)
    np.testing.assert_allclose(np.abs(np.sum(tangents * exact(mesh.points), axis=1)), 1, atol=1e-12)


def test_contour_lines_of_a_surface():
    plane = pv.Plane(i_resolution=60, j_resolution=60).triangulate()
    plane["r"] = np.hypot(*np.asarray(plane.points[:, :2]).T)
    lines = plane.contour([0.2, 0.35], scalars="r")
    tangents = polylines.line_tangents(lines)
    along = np.abs(np.sum(tangents * exact(lines.points), axis=1))
    assert along.min() > 0.97
    assert "luminance" in illuminate(lines, SCENE).point_data


def test_grids_of_lines():
    grid = circle().cast_to_unstructured_grid()
    np.testing.assert_allclose(
        illuminate(grid, SCENE)["luminance"], illuminate(circle(), SCENE)["luminance"], atol=1e-12
    )
    assert not polylines.has_lines_only(
        pv.ImageData(dimensions=(2, 2, 2)).cast_to_unstructured_grid()
    )
    assert not polylines.has_lines_only(pv.ImageData(dimensions=(2, 2, 2)))


def test_odd_lines_get_a_defined_light():
    points = np.array([[0.0, 0, 0], [0, 0, 0], [1, 0, 0], [5, 5, 5], [7, 7, 7]])
    mesh = pv.PolyData(points, lines=[3, 0, 1, 2, 1, 3])
    with pytest.warns(UserWarning, match="2 of 5 points could not be lit"):
        lit = illuminate(mesh, SCENE)
    np.testing.assert_array_equal(lit["luminance_valid"].astype(bool), [1, 1, 1, 0, 0])
    assert np.all(np.isfinite(lit["luminance"]))
    np.testing.assert_allclose(lit["luminance"][[3, 4]], 0.1)


def test_segments_from_a_point_to_itself():
    """They end VTK's filter, and are no part of the line of the others."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]])
    mesh = pv.PolyData(points, lines=[2, 0, 1, 2, 1, 1, 2, 1, 2, 2, 2, 2])
    np.testing.assert_allclose(polylines.line_tangents(mesh), [[1, 0, 0]] * 3)


def test_a_mesh_with_faces_is_no_mesh_of_lines():
    both = pv.Plane().append_polydata(pv.Line((0, 0, 1), (1, 0, 1)))
    assert both.n_lines
    assert not polylines.has_lines_only(both)
    assert not polylines.has_lines_only(pv.Plane())
    assert polylines.has_lines_only(pv.Line())


def test_lines_as_thin_cylinders():
    """The exact line light through every filter of lines; refused where there are no lines."""
    flow = vizlight.load_example()
    scene = far((1, 0.9, 0.5), (0.2, 1, 0.3))
    lines = vizlight.streamlines(flow, scene, tangents="V", seeds=10, model="cylinder")
    assert vizlight.provenance(lines)["options"]["model"] == "cylinder"
    again = vizlight.illuminate(lines, scene, tangents="Tangents", model="cylinder", name="again")
    np.testing.assert_array_equal(again["again"], lines["luminance"])
    cheap = vizlight.illuminate(lines, scene, tangents="Tangents", exponent=1, name="cheap")[
        "cheap"
    ]
    assert np.corrcoef(cheap, lines["luminance"])[0, 1] > 0.5
    assert np.abs(cheap - lines["luminance"]).max() > 0.05
    coat = vizlight.fur(pv.Sphere(), scene, density=0.1, fibres=50, model="cylinder")
    assert coat["fibres"]["luminance"].max() > coat["fibres"]["luminance"].min()
    blocks = pv.MultiBlock({"lines": lines, "ball": pv.Sphere()})
    with pytest.raises(ValueError, match="block /ball: model: expected lines in 3-space"):
        vizlight.illuminate(blocks, scene, model="cylinder")


def test_curved_cells_are_lines_through_their_nodes():
    """Quadratic edges, whose middle node comes last."""
    line = circle(41, closed=False)
    ids = np.arange(0, 40, 2)
    cells = np.stack([ids, ids + 2, ids + 1], axis=1)
    mesh = pv.UnstructuredGrid({pv.CellType.QUADRATIC_EDGE: cells}, line.points)
    np.testing.assert_allclose(
        illuminate(mesh, SCENE)["luminance"], illuminate(line, SCENE)["luminance"], atol=1e-6
    )
