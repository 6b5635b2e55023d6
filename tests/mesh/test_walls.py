"""Walls of a body in a mesh of the flow around it."""

import numpy as np
import pytest
import pyvista as pv

from vizlight import files


def half_shell(outer, n_radial=24):
    """Return a mesh between half balls on a plane of symmetry, finer toward the inner."""
    radius = np.geomspace(1.0, outer, n_radial)
    polar = np.linspace(0.05, np.pi - 0.05, 13)
    turn = np.linspace(0, np.pi, 13)
    r, p, t = np.meshgrid(radius, polar, turn, indexing="ij")
    return pv.StructuredGrid(r * np.sin(p) * np.cos(t), r * np.cos(p), r * np.sin(p) * np.sin(t))


@pytest.mark.parametrize(("outer", "is_far"), [(20.0, True), (5.5, True), (3.0, False)])
def test_walls_are_the_inner_boundary_of_a_mesh_that_reaches_far(outer, is_far):
    shell = pv.SolidSphere(inner_radius=1.0, outer_radius=outer)
    walls = files.walls(shell)
    assert bool(walls.n_cells) is is_far
    if is_far:
        np.testing.assert_allclose(np.linalg.norm(walls.points, axis=1), 1.0, rtol=1e-6)


def test_walls_on_a_plane_of_symmetry_are_those_much_smaller_than_the_rest():
    shell = half_shell(60.0)
    # Where blocks meet, each has points of its own.
    blocks = pv.MultiBlock(
        [shell.extract_subset((0, 23, 0, 12, *ends)) for ends in ((0, 6), (6, 12))]
    )
    for mesh in (shell, blocks.combine()):
        walls = files.walls(mesh)
        assert walls.n_cells == 144
        np.testing.assert_allclose(np.linalg.norm(walls.points, axis=1), 1.0, rtol=1e-6)
    # A hole that is not so small is one of a solid.
    assert not files.walls(half_shell(8.0)).n_cells


def test_what_stands_outside_of_a_solid_is_no_wall():
    large, small = pv.SolidSphere(outer_radius=20.0), pv.SolidSphere(center=(30.0, 0, 0))
    assert not files.walls(large.merge(small)).n_cells
    assert not files.walls(pv.ImageData(dimensions=(4, 4, 4))).n_cells
    with pytest.raises(TypeError, match="volume: expected a mesh of cells"):
        files.walls(3)


def test_obstacles_are_inside_of_the_hull_that_a_flow_fills():
    shell = pv.SolidSphere(inner_radius=1.0, outer_radius=2.0)
    shell = shell.extract_surface(algorithm="dataset_surface")
    bent = pv.Spline(np.array([[0, 0, 0], [3, 0, 0], [3, 3, 0]]), 40).tube(radius=0.3)
    for surface, is_filled in ((shell, True), (bent, False)):
        surface["heat"] = np.ones(surface.n_points)
        inner = np.isfinite(files.obstacles(surface, "heat")["heat"])
        near = np.linalg.norm(surface.points, axis=1) < 1.5
        assert np.array_equal(inner, near & is_filled)
    with pytest.raises(ValueError, match="name: expected the name of a point array"):
        files.obstacles(shell, "cold")


def test_walls_beside_quadratic_cells():
    """VTK's numbers of the cells of faces are others where some cells are quadratic."""
    shell = pv.SolidSphere(inner_radius=1.0, outer_radius=20.0)
    far = pv.examples.cells.QuadraticTetrahedron().translate((18.0, 0, 0))
    walls = files.walls(pv.merge([far, shell], merge_points=False))
    np.testing.assert_allclose(np.linalg.norm(walls.points, axis=1), 1.0, rtol=1e-6)
    assert walls.n_cells == files.walls(shell).n_cells


def test_faces_whose_corners_are_at_one_place_are_none():
    hexahedron = pv.ImageData(dimensions=(3, 3, 3)).cast_to_unstructured_grid()
    # The sides of a wedge that is written as a hexahedron.
    flat = hexahedron.points[:, 0] == 2
    hexahedron.points[flat, 2] = 0
    assert not files.walls(hexahedron).n_cells
