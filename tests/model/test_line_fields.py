"""Means of line fields: they have no sign, and are those of vectors where all point one way."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.model import line_fields

RANDOM = np.random.default_rng(5)


def rotation():
    q, r = np.linalg.qr(RANDOM.normal(size=(3, 3)))
    return q * np.sign(np.diag(r))


def mean(tangents, weights):
    """t and -t have the same outer product: opposite tangents do not cancel in the mean."""
    products = np.einsum("...m,...mij->...ij", weights, line_fields.outer(tangents))
    return line_fields.principal(products, tangents.shape[-2])[0]


def test_the_mean_does_not_depend_on_signs_and_turns_with_its_lines():
    lines = RANDOM.normal(size=(50, 4, 1, 3)) + np.array([3.0, 0, 1])
    weights = RANDOM.random((50, 4))
    found = mean(lines, weights)
    np.testing.assert_allclose(np.linalg.norm(found, axis=-1), 1, rtol=1e-14)
    signs = RANDOM.choice([-1.0, 1.0], size=(50, 4, 1, 1))
    other = mean(signs * lines, weights)
    np.testing.assert_allclose(np.abs(np.sum(found * other, axis=-1)), 1, rtol=1e-13)
    q = rotation()
    for other, expected in ((lines @ q.T, found @ q.T), (1e-150 * lines, found)):
        along = np.sum(mean(other, weights) * expected, axis=-1, keepdims=True)
        np.testing.assert_allclose(np.sign(along) * mean(other, weights), expected, atol=1e-12)


@pytest.mark.parametrize("angle", [1e-1, 1e-2, 1e-3])
def test_it_is_the_mean_of_vectors_to_second_order(angle):
    """Two directions of one length: both means halve the angle between them."""
    two = np.array([[[1, 0, 0]], [[np.cos(angle), np.sin(angle), 0]]])
    found = mean(np.array([two[0], -two[1]])[np.newaxis], np.ones((1, 2)))[0, 0]
    half = np.array([np.cos(angle / 2), np.sin(angle / 2), 0])
    np.testing.assert_allclose(np.abs(found), half, atol=1e-15 / angle)


def test_planes_are_averaged_whatever_spans_them():
    frames = RANDOM.normal(size=(20, 3, 2, 4)) * 0.1 + np.eye(4)[:2]
    mixed = np.einsum("...ij,...jk->...ik", RANDOM.normal(size=(20, 3, 2, 2)), frames)
    for rows in (frames, mixed):
        found = mean(rows, np.ones((20, 3)))
        projection = np.einsum("pki,pkj->pij", found, found)
        np.testing.assert_allclose(np.trace(projection, axis1=1, axis2=2), 2, rtol=1e-13)
        if rows is frames:
            expected = projection
    np.testing.assert_allclose(projection, expected, atol=1e-11)


def test_where_no_direction_prevails():
    across = np.array([[[[1.0, 0, 0]], [[0, 1, 0]]], [[[0, 0, 0]], [[0, 0, 0]]]])
    np.testing.assert_array_equal(mean(across, np.ones((2, 2))), 0)
    tensors = np.array([np.eye(3), np.diag([3.0, 1, 1]), np.full((3, 3), np.nan)])
    tangents, anisotropy = line_fields.principal(tensors)
    np.testing.assert_array_equal(np.abs(tangents[:, 0]), [[0, 0, 0], [1, 0, 0], [0, 0, 0]])
    np.testing.assert_allclose(anisotropy, [0, 0.4, 0])


def test_one_that_is_not_finite_does_not_count():
    lines = np.array([[[1.0, 2, 2]], [[np.nan, 0, 0]], [[-1, -2, -2]]])
    found = mean(lines[np.newaxis], np.ones((1, 3)))
    np.testing.assert_allclose(np.abs(found[0, 0]), [1 / 3, 2 / 3, 2 / 3])


@pytest.mark.filterwarnings("ignore:tangents. the cell array")
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_random_signs_of_cells_do_not_move_the_light(dtype):
    grid = pv.ImageData(dimensions=(12, 12, 12), spacing=(0.1, 0.1, 0.1))
    x, y, z = grid.cell_centers().points.T.astype(float)
    lines = np.stack([np.cos(x + z), np.sin(x + z), 0.3 + y], axis=1)
    signs = np.random.default_rng(3).choice([-1, 1], size=(len(lines), 1))
    scene = vizlight.Scene(
        lights=vizlight.Light(direction=(1, 2, 3)), view=vizlight.View(direction=(0, 0, 1))
    )
    light = []
    for array in (lines, signs * lines):
        grid.cell_data["T"] = array.astype(dtype)
        light.append(vizlight.illuminate(grid, scene, tangents="T"))
    moved = np.abs(light[0]["luminance"] - light[1]["luminance"])
    assert moved.max() < 50 * np.finfo(dtype).eps
    # Where nothing is turned over, the mean of the vectors is close.
    grid.cell_data["T"] = lines
    plain = vizlight.illuminate(grid.cell_data_to_point_data(), scene, tangents="T")
    assert np.abs(plain["luminance"] - light[0]["luminance"]).max() < 2e-3
