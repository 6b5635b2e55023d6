"""Cells of every kind are cut, without cracks, and arrays go along."""

import numpy as np
import pytest
import pyvista as pv
from vectors import unit

from vizlight.mesh import nspace


def box(kind):
    grid = pv.ImageData(dimensions=(5, 5, 5), spacing=(0.25,) * 3)
    if kind == "image":
        return grid
    mesh = grid.cast_to_unstructured_grid()
    return mesh.triangulate() if kind == "tetrahedra" else grid.cast_to_structured_grid()


def area(mesh):
    return mesh.compute_cell_sizes()["Area"].sum()


@pytest.mark.parametrize("kind", ["image", "structured", "tetrahedra"])
def test_a_box_cut_by_a_plane(kind):
    mesh = box(kind)
    x = np.asarray(mesh.points, float)
    mesh["x"], mesh["id"] = x[:, 0], np.arange(mesh.n_points)
    mesh["word"] = ["a"] * mesh.n_points
    cut = nspace.cut(mesh, x @ [1.0, 0.4, 0.3] - 0.73)
    points = np.asarray(cut.points)
    np.testing.assert_allclose(points @ [1, 0.4, 0.3], 0.73, atol=1e-14)
    np.testing.assert_allclose(cut["x"], points[:, 0], atol=1e-14)
    assert cut["id"].dtype == np.float64
    assert "word" not in cut.point_data
    # The whole section and nothing twice: its area is that of the plane over the unit square.
    assert area(cut) == pytest.approx(np.linalg.norm([1, 0.4, 0.3]), rel=1e-12)
    # Edges on the box's skin alone belong to one triangle.
    edges = np.sort(
        np.concatenate([cut.regular_faces[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1
    )
    once, count = np.unique(edges, axis=0, return_counts=True)
    assert count.max() == 2
    ends = points[once[count == 1]]
    on_skin = np.isclose(ends, 0, atol=1e-12) | np.isclose(ends, 1, atol=1e-12)
    assert np.all(np.any(np.all(on_skin, axis=1), axis=1))


def test_a_cut_through_lattice_points():
    mesh = box("image")
    cut = nspace.cut(mesh, np.asarray(mesh.points, float)[:, 2] - 0.5)
    assert area(cut) == pytest.approx(1, rel=1e-12)


def test_strips_lines_and_wedges():
    strip = pv.Plane(i_resolution=4, j_resolution=4).triangulate().strip()
    assert strip.n_strips
    cut = nspace.cut(strip, np.asarray(strip.points, float)[:, 0] - 0.1)
    assert cut.compute_cell_sizes()["Length"].sum() == pytest.approx(1, rel=1e-6)
    line = pv.MultipleLines(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0]]))
    points = nspace.cut(line, np.array([-0.25, 0.75, 1.0]))
    np.testing.assert_allclose(points.points, [[0.25, 0, 0]])
    assert points.n_verts == 1
    wedge = pv.UnstructuredGrid(
        {pv.CellType.WEDGE: np.arange(6)[None]},
        np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]]),
    )
    assert area(nspace.cut(wedge, np.asarray(wedge.points)[:, 2] - 0.5)) == pytest.approx(0.5)


def test_frames_are_cut_as_the_spaces_they_span(random):
    """Whichever cells are cut: also at the mean point of a hexahedron."""
    for kind in ("image", "tetrahedra"):
        mesh = box(kind)
        x = np.asarray(mesh.points, float)
        away, along = x + np.array([1.0, 2, 3]), np.array([1.0, 0, 0])
        frame = np.linalg.qr(np.stack([away, 0 * x + along], axis=2))[0].swapaxes(1, 2)
        turns = np.linalg.qr(random.standard_normal((len(x), 2, 2)))[0]
        seen = []
        for rows in (frame, turns @ frame):
            mesh["frame"] = rows.reshape(len(x), 6)
            cut = nspace.cut(mesh, x @ [1.0, 0.4, 0.3] - 0.73, spaces={"frame": 3})
            seen.append(np.cross(*np.asarray(cut["frame"]).reshape(-1, 2, 3).swapaxes(0, 1)))
        one, other = seen
        assert np.abs(np.abs(np.sum(one * other, axis=1)) - 1).max() < 1e-14
        exact = unit(np.cross(np.asarray(cut.points) + np.array([1.0, 2, 3]), along))
        assert np.abs(np.sum(one * exact, axis=1)).min() > 0.9999


def test_nothing_to_cut_and_nothing_met():
    cut = nspace.cut(pv.Sphere(), np.ones(842))
    assert cut.n_points == cut.n_cells == 0
    assert cut["Normals"].shape == (0, 3)
    for mesh in (pv.PolyData(np.zeros((3, 3))), pv.PointSet(np.zeros((3, 3)))):
        with pytest.raises(ValueError, match="mesh: expected lines, faces or volumes"):
            nspace.cut(mesh, np.array([-1.0, 0, 1]))


def test_a_point_that_is_not_finite_spoils_its_cells_alone():
    mesh = pv.Plane(i_resolution=2, j_resolution=1).triangulate()
    mesh["v"] = np.array([np.nan, 1, 1, 1, 1, 1])
    heights = np.asarray(mesh.points, float)[:, 1]
    cut = nspace.cut(mesh, np.where(np.isnan(mesh["v"]), np.nan, heights))
    assert 0 < cut.n_points < 5
    assert np.all(np.isfinite(cut["v"]))


def clifford(count):
    """Return the torus of two circles of radius 0.7 in 4-space as points, and its mesh."""
    circles = np.linspace(0, 2 * np.pi, count)
    u, v = np.meshgrid(circles, circles, indexing="ij")
    places = np.stack([np.cos(u), np.sin(u), np.cos(v), np.sin(v)], axis=-1) * np.sqrt(0.5)
    mesh = pv.StructuredGrid(*places[..., :3].transpose(2, 0, 1)[..., np.newaxis])
    mesh["position"] = places.transpose(1, 0, 2).reshape(-1, 4)
    return mesh


@pytest.mark.parametrize("count", [16, 64])
def test_sheets_onto_each_other_are_seen(count):
    mesh = clifford(count)
    assert nspace.is_dropped(mesh)
    assert nspace.covers_itself(mesh)
    # A graph crosses itself along lines alone.
    z = np.add.outer(np.linspace(-1, 1, 4 * count), 1j * np.linspace(-1, 1, 4 * count)).ravel()
    graph = pv.PolyData(np.stack([z.real, z.imag, (z**2).real], axis=1))
    graph["position"] = np.stack([z.real, z.imag, (z**2).real, (z**2).imag], axis=1)
    assert nspace.is_dropped(graph)
    assert not nspace.covers_itself(graph)
    graph.points *= 2
    assert not nspace.is_dropped(graph)


def test_the_eye_is_beyond_all_points():
    mesh = clifford(16)
    # On a sphere: the stereographic projection.
    assert nspace.eye_distance(mesh) == pytest.approx(1)
    mesh["position"] = mesh["position"] + [3, 0, 0, 5]
    assert nspace.eye_distance(mesh) > mesh["position"][:, 3].max()
    named = nspace.with_last_coordinate(mesh, "w")
    np.testing.assert_array_equal(named["w"], mesh["position"][:, 3])
    assert "w" not in mesh.point_data
