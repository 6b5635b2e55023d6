"""What was found out of a surface is found once, and forgotten with its points."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import Light, Scene, View
from vizlight.mesh.normals import split_edges
from vizlight.vtk import memory, normals, orientation, polylines


@pytest.fixture
def shapes(monkeypatch):
    """Surfaces whose shape was found, one after the other."""
    found = []

    class Counted(orientation.SurfaceShape):
        def __init__(self, surface, side=None, block=None):
            found.append(surface.GetNumberOfPoints())
            super().__init__(surface, side, block)

    monkeypatch.setattr(orientation, "SurfaceShape", Counted)
    monkeypatch.setattr(memory, "_KEPT", {})
    return found


def ball():
    found = pv.Sphere(theta_resolution=40, phi_resolution=40)
    found.clear_data()
    return found


def box():
    found = pv.Box(level=9).clean()
    found.clear_data()
    return found


def test_normals_are_computed_once_for_copies_until_a_point_moves(shapes):
    mesh = ball()
    first = normals.computed_normals(mesh)
    assert normals.computed_normals(mesh.copy()) is first
    assert normals.computed_normals(mesh.copy(deep=False)) is first
    assert shapes == [mesh.n_points]
    # NumPy writes to the memory, and VTK does not know of it.
    np.asarray(mesh.points)[0] *= 1.5
    moved = normals.computed_normals(mesh)
    assert len(shapes) == 2
    assert np.abs(moved.vectors - first.vectors).max() > 0.01
    turned = pv.PolyData.from_regular_faces(mesh.points, mesh.regular_faces[1:])
    assert normals.computed_normals(turned).any_open
    assert len(shapes) == 3


def test_what_is_kept_cannot_be_written():
    sided = normals.computed_normals(ball())
    for array in (sided.vectors, sided.lean, sided.open):
        assert not array.flags.writeable


@pytest.mark.parametrize("change", ["faces", "precision"])
def test_other_cells_and_other_numbers_are_another_surface(shapes, change):
    mesh = ball()
    normals.computed_normals(mesh)
    if change == "faces":
        mesh = pv.PolyData.from_regular_faces(mesh.points, mesh.regular_faces[:, ::-1])
    else:
        mesh.points = np.asarray(mesh.points, dtype=np.float64)
    normals.computed_normals(mesh)
    assert len(shapes) == 2


def test_normals_are_forgotten_with_the_points(shapes):
    normals.computed_normals(ball())
    normals.computed_normals(box())
    assert len(memory._KEPT) == 1
    normals.computed_normals(ball())
    assert len(shapes) == 3


def test_few_things_are_kept(monkeypatch, shapes):
    monkeypatch.setattr(memory, "MOST", 2 * ball().n_points)
    meshes = [ball().scale(s) for s in (1, 2, 3)]
    for mesh in meshes:
        normals.computed_normals(mesh)
    assert len(memory._KEPT) == 2
    normals.computed_normals(meshes[2])
    assert len(shapes) == 3
    normals.computed_normals(meshes[0])
    assert len(shapes) == 4


def test_a_function_that_fails_leaves_nothing(shapes):
    def fails():
        raise ValueError("no")

    mesh = ball()
    with pytest.raises(ValueError, match="no"):
        memory.once(mesh, "x", fails)
    assert memory.once(mesh, "x", lambda: 3) == 3
    assert memory.once(mesh, "x", fails) == 3
    grid = pv.ImageData(dimensions=(2, 2, 2))
    assert memory.once(grid, "x", lambda: 1) == 1
    assert memory.once(grid, "x", lambda: 2) == 2


@pytest.mark.parametrize(("make", "count"), [(ball, 1), (box, 2)])
def test_a_chain_of_light_pictures_and_pages_finds_normals_once(shapes, tmp_path, make, count):
    """With creases once for the mesh, and once for its split points."""
    mesh = make()
    scene = Scene(lights=Light(direction=(1, 1, 1)), view=View(direction=(0, 0.2, 1)))
    vizlight.illuminate(mesh, scene, feature_angle="auto")
    for _ in range(2):
        plotter = pv.Plotter(off_screen=True, window_size=(60, 40))
        plotter.vizlight.add_mesh(mesh, scene=scene)
        plotter.show()
    vizlight.live_html(mesh, tmp_path / "page.html", scene=scene)
    assert len(shapes) == count


@pytest.mark.parametrize(("carried", "count"), [("faces", 0), ("no face", 1)])
def test_a_mesh_with_normals_is_looked_at_once_if_they_leave_doubt(
    shapes, monkeypatch, carried, count
):
    """Normals that fit the faces tell by themselves that no edge is sharp."""
    walks, lean_of = [], orientation.lean_of
    monkeypatch.setattr(orientation, "lean_of", lambda *given: walks.append(0) or lean_of(*given))
    mesh = pv.Plane(i_resolution=99, j_resolution=99).triangulate()
    x, y, _ = np.asarray(mesh.points).T
    np.asarray(mesh.points)[:, 2] = 0.1 * np.sin(9 * x) * np.cos(7 * y)
    if carried == "faces":
        mesh.clear_data()
        mesh = mesh.compute_normals(cell_normals=False, split_vertices=False)
    plotter = pv.Plotter(off_screen=True, window_size=(60, 40))
    plotter.vizlight.add_mesh(mesh)
    assert len(shapes) == count
    assert len(walks) == 1


def test_tangents_of_lines_are_computed_once(monkeypatch):
    calls, tangents = [], polylines.polyline_tangents
    monkeypatch.setattr(
        polylines, "polyline_tangents", lambda *a, **k: calls.append(0) or tangents(*a, **k)
    )
    monkeypatch.setattr(memory, "_KEPT", {})
    look = vizlight.look(pv.Spline(np.random.default_rng(3).normal(size=(9, 3)), 50))
    look.plotter()
    assert len(calls) == 1


def test_small_blocks_are_looked_at_together_and_once(shapes):
    mesh = pv.MultiBlock([ball().translate((x, 0, 0), inplace=False) for x in range(3)])
    scene = Scene(lights=Light(direction=(1, 1, 1)), view=View(direction=(0, 0.2, 1)))
    lit = vizlight.illuminate(mesh, scene, feature_angle="auto")
    plotter = pv.Plotter(off_screen=True, window_size=(60, 40))
    plotter.vizlight.add_mesh(mesh, scene=scene)
    assert shapes == [3 * mesh[0].n_points]
    apart = vizlight.illuminate(mesh[1], scene, feature_angle="auto")
    np.testing.assert_array_equal(lit[1]["luminance"], apart["luminance"])
    assert len(shapes) == 1


def test_split_points_share_no_memory_with_what_is_kept(shapes):
    mesh = box()
    first = split_edges(mesh, "auto")
    expected = np.array(first.points), np.array(first.faces)
    assert first.n_points > mesh.n_points
    np.asarray(first.points)[:] = 0
    first.regular_faces[:] = 0
    np.asarray(first.GetPolys().GetConnectivityArray())[:] = 0
    again = split_edges(mesh, "auto")
    np.testing.assert_array_equal(again.points, expected[0])
    np.testing.assert_array_equal(again.faces, expected[1])
    assert len(shapes) == 1
