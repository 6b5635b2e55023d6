"""The outer surface of a mesh: which nodes of curved cells are on it."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View
from vizlight.reading import hull


def test_control_points_are_not_lit():
    """A Bezier triangle passes through its corners, and half as high as the points between."""
    points = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [1, 0, 0.8], [1, 1, 0.8], [0, 1, 0.8]]
    mesh = pv.UnstructuredGrid({pv.CellType.BEZIER_TRIANGLE: np.arange(6)[None]}, np.array(points))
    toward = np.array([1, 2, 6]) / np.sqrt(41)
    scene = Scene(
        lights=Light(direction=toward),
        view=View(direction=(0, 0, 1)),
        material=Material(ambient=0.1, diffuse=0.8, specular=0),
    )
    with pytest.warns(UserWarning, match="3 of 6 points could not be lit"):
        lit = vizlight.illuminate(mesh, scene)
    np.testing.assert_array_equal(lit["luminance_valid"], [1, 1, 1, 0, 0, 0])
    np.testing.assert_allclose(lit["luminance"][3:], 0.1)
    # The flat triangles at the corners rise by 0.4 to the middles of the edges.
    normals = np.array([[-0.4, -0.4, 1], [0.4, 0, 1], [0, 0.4, 1]])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    np.testing.assert_allclose(lit["luminance"][:3], 0.1 + 0.8 * normals @ toward, rtol=1e-5)


def clouds():
    points = np.random.default_rng(1).normal(size=(20, 3)).astype(np.float32)
    grid = pv.UnstructuredGrid()
    grid.points = points
    return [grid, pv.PointSet(points), pv.PolyData(points)]


@pytest.mark.parametrize("cloud", clouds(), ids=lambda mesh: type(mesh).__name__)
def test_points_without_cells_are_lit_by_vectors_of_their_own(cloud):
    vectors = np.random.default_rng(2).normal(size=(20, 3))
    scene = Scene(lights=Light(direction=(0, 0, 1)), view=View(direction=(0, 0, 1)))
    points = np.asarray(cloud.points)
    lines = vizlight.illuminate(cloud, scene, tangents=vectors)
    expected = vizlight.engine.shade(points, vectors, scene)
    np.testing.assert_array_equal(lines["luminance"], expected.luminance)
    sheets = vizlight.illuminate(cloud, scene, normals=vectors, facing="as given")
    expected = vizlight.engine.shade(points, None, scene, normals=vectors)
    np.testing.assert_array_equal(sheets["luminance"], expected.luminance)
    with pytest.raises(ValueError, match="mesh: expected a surface with faces"):
        vizlight.isoluminance(cloud, scene)
    with pytest.raises(ValueError, match="mesh: expected faces or lines, got points alone"):
        vizlight.refine(cloud, scene, tangents=vectors)


@pytest.mark.parametrize("kind", ["surface", "grid", "image"])
def test_numbers_that_an_earlier_filter_left_are_not_taken_for_ours(kind):
    """VTK leaves a point array of numbers on the surfaces and cells that it takes from a mesh."""
    mesh = {
        "surface": pv.Sphere(theta_resolution=8, phi_resolution=8),
        "grid": pv.ImageData(dimensions=(4, 4, 4)).cast_to_unstructured_grid(),
        "image": pv.ImageData(dimensions=(4, 4, 4)),
    }[kind]
    left = np.arange(mesh.n_points)[::-1].copy()
    mesh["vtkOriginalPointIds"] = left
    surface, origin = hull.outer_surface(mesh)
    surface = pv.wrap(surface)
    np.testing.assert_array_equal(surface.points, np.asarray(mesh.points)[origin])
    np.testing.assert_array_equal(surface["vtkOriginalPointIds"], left[origin])
