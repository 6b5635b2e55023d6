"""Surfaces in a mesh, layers of it, and its points elsewhere."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals

from vizlight import files


def volume():
    grid = pv.ImageData(dimensions=(8, 8, 8))
    grid["r"] = np.linalg.norm(grid.points - 3.5, axis=1)
    grid["V"] = np.ones((grid.n_points, 3))
    return grid


def test_surfaces():
    grid = volume()
    iso = files.surface_of(grid, "r", 2.0)
    np.testing.assert_allclose(np.linalg.norm(iso.points - 3.5, axis=1), 2.0, atol=0.15)
    middle = files.surface_of(grid, "r")
    assert middle.n_points > 0
    outside = files.surface_of(grid)
    assert isinstance(outside, pv.PolyData)
    assert outside.n_points == 8**3 - 6**3
    assert files.surface_of(iso) is iso


def test_warp():
    plane = pv.ImageData(dimensions=(3, 3, 1))
    plane["z"] = np.arange(9.0)
    np.testing.assert_allclose(files.warped(plane, "z", 2.0).points[:, 2], 2 * np.arange(9))


def bad_arrays(call):
    grid = volume()
    grid.cell_data["C"] = np.ones(grid.n_cells)
    call(grid)


test_bad_arrays = refusals(
    bad_arrays,
    (lambda g: files.surface_of(g, "s"), r"contour: .*one of \['r', 'C'\], got 's'"),
    (
        lambda g: files.surface_of(pv.Sphere(), "s"),
        "contour: expected .* of one component, but the mesh has none, got 's'",
    ),
    (lambda g: files.surface_of(g, "V"), r"contour: .*got 'V' of an array of shape \(512, 3\)"),
    (lambda g: files.surface_of(g, "r", 99.0), "level: expected a value between 0.8.* and 6.0"),
    (lambda g: files.surface_of(g, "r", np.nan), "level: expected a finite number"),
    (lambda g: files.warped(g, "r", np.inf), "exaggeration: expected a finite number"),
    (lambda g: files.warped(g, "\ud800", 1.0), "warp: expected .* of valid characters"),
)


def test_points_are_displaced_by_vectors():
    solid = pv.ImageData(dimensions=(4, 3, 2)).cast_to_unstructured_grid()
    for mesh in (pv.ImageData(dimensions=(4, 3, 2)), solid, pv.Sphere()):
        mesh["move"] = np.random.default_rng(0).normal(size=(mesh.n_points, 3))
        before = np.array(mesh.points)
        moved = files.warped(mesh, "move", 2.0)
        np.testing.assert_allclose(moved.points, before + 2 * mesh["move"], rtol=1e-6)
        np.testing.assert_array_equal(mesh.points, before)
        mesh["move"][0, 1] = np.nan
        assert files.warped(mesh, "move", 2.0).n_points < mesh.n_points
    mesh["colours"] = np.zeros((mesh.n_points, 3), np.uint8)
    with pytest.raises(ValueError, match="warp: expected an array of one component"):
        files.warped(mesh, "colours", 1.0)


def test_an_isosurface_beside_holes_is_finite():
    grid = pv.ImageData(dimensions=(20, 20, 10))
    p = grid.points
    values = 8 - p[:, 2] + np.sin(p[:, 0] / 5)
    whole = files.surface_of(grid_with(grid, values), "T", 4.0)
    values[np.hypot(p[:, 0] - 10, p[:, 1] - 10) < 4] = np.nan
    holed = files.surface_of(grid_with(grid, values), "T", 4.0)
    assert np.isfinite(holed.points).all()
    assert 0.7 * whole.area < holed.area < 0.9 * whole.area
    assert np.isfinite(holed.point_data["T"]).all()


def grid_with(grid, values):
    out = grid.copy()
    out["T"] = values.copy()
    return out


def test_one_layer_of_a_grid():
    grid = pv.RectilinearGrid([0.0, 1, 3], [0.0, 2], [5.0, 6, 9])
    grid["p"], grid.cell_data["c"] = np.arange(18), np.arange(4)
    grid.field_data["unit"] = ["degree"]
    layer = files.layer_of(grid, 2)
    assert layer.dimensions == (3, 2, 1)
    assert layer["p"].tolist() == list(range(12, 18))
    assert layer.cell_data["c"].tolist() == [2, 3]
    assert layer.bounds[4:] == (9, 9)
    assert layer.field_data["unit"][0] == "degree"
    with pytest.raises(ValueError, match=r"at: expected .* got 3"):
        files.layer_of(grid, 3)


def test_labels_of_points_are_those_of_what_is_nearest():
    plane = pv.Plane(i_resolution=6, j_resolution=4).triangulate()
    plane["v"] = plane.points[:, 0].astype(float)
    plane["k"] = np.random.default_rng(1).choice([1.0, 5.0, np.nan], plane.n_points)
    before = plane.copy()
    found = files.surface_of(plane, labels="k")
    assert plane == before
    assert found.area == pytest.approx(plane.area)
    assert "k" not in found.point_data
    np.testing.assert_allclose(found["v"], found.points[:, 0], atol=1e-6)
    # The middles of triangles that are split are nearest to their corner.
    middles = found.cell_centers().points
    nearest = np.argmin(np.linalg.norm(middles[:, np.newaxis] - plane.points, axis=2), axis=1)
    split = found.compute_cell_sizes()["Area"] < 0.99 * plane.area / plane.n_cells
    np.testing.assert_array_equal(found["k"][split], plane["k"][nearest[split]])
    # Whole triangles have one label, that of all of their corners.
    for cell in np.flatnonzero(~split).tolist():
        ids = found.get_cell(cell).point_ids
        np.testing.assert_array_equal(plane["k"][ids], found["k"][cell])


def test_labels_of_an_image():
    with pytest.raises(ValueError, match="labels: expected an array of one component"):
        files.surface_of(pv.Sphere(), labels="a")
    image = pv.ImageData(dimensions=(4, 4, 4))
    image.cell_data["c"] = np.arange(27) // 14 * 5
    found = files.surface_of(image, labels="c")
    assert {*found.cell_data["c"].tolist()} == {5}
    assert found.bounds.z_max > 2
    image["a"] = np.zeros(64)
    with pytest.raises(ValueError, match="labels: expected whole numbers that are not all 0"):
        files.surface_of(image, labels="a")


def test_a_thin_label_of_an_image_keeps_its_voxels_and_a_thick_one_is_smooth():
    image = pv.ImageData(dimensions=(16, 16, 16), spacing=(0.5, 0.5, 0.5))
    labels = np.zeros((16, 16, 16), np.uint8)
    labels[3:13, 13, 13] = 2
    labels[np.linalg.norm(np.indices(labels.shape) - 5.0, axis=0) < 4.6] = 7
    image["c"] = labels.ravel(order="F")
    found = files.surface_of(image, labels="c")
    faces = found.compute_cell_sizes()["Area"]
    # The bar has the faces of ten voxels, and the ball not much more than the area of one.
    assert faces[found["c"] == 2].sum() == pytest.approx(0.25 * (4 * 10 + 2))
    ball = 4 * np.pi * (0.5 * 4.6) ** 2
    assert 0.7 * ball < faces[found["c"] == 7].sum() < 1.1 * ball


@pytest.mark.parametrize("turn", [np.diag([-1.0, -1, 1]), [[0, -1, 0], [1, 0, 0], [0, 0, 1]]])
def test_an_isosurface_of_an_image_whose_rows_run_elsewhere_is_at_its_place(turn):
    image = pv.ImageData(dimensions=(20, 24, 16), spacing=(1, 2, 1), origin=(5, 6, 7))
    image.direction_matrix = turn
    middle = np.asarray(image.center)
    image["r"] = np.linalg.norm(np.asarray(image.points) - middle, axis=1)
    found = files.surface_of(image, contour="r", level=5.0)
    radius = np.linalg.norm(np.asarray(found.points) - middle, axis=1)
    assert np.abs(radius - 5).max() < 0.3
