"""Both sides of a surface, beside each other."""

import numpy as np
import pytest
import pyvista as pv

from vizlight.mesh.both_sides import both_sides


def ellipsoid(*sizes):
    mesh = pv.Sphere().scale(sizes)
    mesh["x"] = np.asarray(mesh.points)[:, 0].copy()
    mesh["way"] = np.tile([1.0, 2.0, 3.0], (mesh.n_points, 1))
    return mesh


@pytest.mark.parametrize(("sizes", "step"), [((4, 1, 3), (1, 0, 0)), ((9, 1, 3), (0, 0, -1))])
def test_the_second_side_is_turned_and_stands_beside_the_first(sizes, step):
    mesh = ellipsoid(*sizes)
    blocks = both_sides(mesh, (0, -1, 0), names=("front", "back"))
    assert blocks.keys() == ["front", "back"]
    np.testing.assert_array_equal(blocks[0].points, mesh.points)
    away = np.subtract(blocks[1].center, blocks[0].center)
    size = 1.08 * mesh.bounds_size[0 if step[0] else 2]
    np.testing.assert_allclose(away, size * np.array(step), atol=1e-5)
    turned = np.asarray(blocks[1].points) - blocks[1].center
    expected = (np.asarray(mesh.points) - mesh.center) * (-1, -1, 1)
    np.testing.assert_allclose(turned, expected, atol=1e-5)
    np.testing.assert_array_equal(blocks[1]["x"], mesh["x"])
    np.testing.assert_allclose(blocks[1]["way"][0], (-1, -2, 3), atol=1e-6)
    np.testing.assert_array_equal(mesh["way"][0], (1, 2, 3))


def test_colors_of_bytes_are_no_vectors():
    mesh = pv.Sphere(theta_resolution=6, phi_resolution=6)
    mesh["rgb"] = np.full((mesh.n_points, 3), (250, 10, 20), np.uint8)
    mesh.cell_data["rgb"] = np.full((mesh.n_cells, 3), (1, 2, 3), np.uint8)
    turned = both_sides(mesh, (0, -1, 0), names=("front", "back"))["back"]
    for rows, expected in (
        (turned.point_data["rgb"], (250, 10, 20)), (turned.cell_data["rgb"], (1, 2, 3))
    ):  # fmt: skip
        assert rows.dtype == np.uint8
        np.testing.assert_array_equal(rows[0], expected)


def test_what_has_no_sides_is_refused():
    with pytest.raises(TypeError, match="surface: expected a surface"):
        both_sides(pv.ImageData(), (0, -1, 0), names=("a", "b"))
    with pytest.raises(ValueError, match="names: expected two names"):
        both_sides(pv.Sphere(), (0, -1, 0), names=("a",))
