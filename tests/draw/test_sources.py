"""The sides of a grid are its outer surface, split at the edges of the box."""

import numpy as np
import pytest
import pyvista as pv

from vizlight.draw import sources
from vizlight.mesh import normals
from vizlight.mesh.normals import split_edges


def image(dimensions=(14, 5, 9)):
    turn = pv.Transform().rotate_z(30).rotate_x(20).matrix[:3, :3]
    grid = pv.ImageData(dimensions=dimensions, spacing=(1, 2, 0.5), origin=(3, -1, 2))
    grid.direction_matrix = turn
    return grid


def rectilinear():
    return pv.RectilinearGrid(np.arange(14.0) ** 2, [5.0, 4.0, 1.0, 0.0, -2.0], np.arange(9.0))


@pytest.mark.parametrize("make", [image, rectilinear])
def test_sides_are_those_of_the_outer_surface_split_at_its_edges(make):
    grid = make()
    grid["v"] = np.arange(grid.n_points, dtype=float)
    grid.cell_data["c"] = np.arange(grid.n_cells)
    found, expected = sources.box(grid), split_edges(grid.extract_surface(algorithm=None), 30.0)
    assert (found.n_points, found.n_cells) == (expected.n_points, expected.n_cells)
    np.testing.assert_allclose(grid.points[found["v"].astype(int)], found.points, atol=1e-14)
    key = lambda mesh: sorted(map(tuple, np.round(mesh.cell_centers().points, 4)))  # noqa: E731
    np.testing.assert_allclose(key(found), key(expected), atol=1e-3)
    centres = grid.cell_centers().points[found.cell_data["c"]]
    away = found.cell_centers().points - centres
    outward = found.compute_normals(auto_orient_normals=False, consistent_normals=False)
    cosine = np.einsum("ij,ij->i", outward.cell_data["Normals"], away)
    np.testing.assert_allclose(cosine, np.linalg.norm(away, axis=1), rtol=1e-3)
    sided = normals.kept(found)
    own = outward.point_data["Normals"]
    np.testing.assert_allclose(sided.vectors, own, atol=1e-5)
    assert not sided.any_open


def test_a_live_grid_takes_them_and_what_is_no_box_does_not():
    grid = image()
    (source,), _ = sources.sources_of(grid, None, {})
    assert source.mesh.n_points == sources.box(grid).n_points
    assert source.mesh.n_points > grid.extract_surface(algorithm=None).n_points
    hidden = image()
    hidden.cell_data["vtkGhostType"] = np.zeros(hidden.n_cells, np.uint8)
    for mesh in (image((14, 1, 9)), hidden, grid.cast_to_structured_grid(), pv.Sphere()):
        assert sources.box(mesh) is None
