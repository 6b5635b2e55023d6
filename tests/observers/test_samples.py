"""Data at places of a picture are interpolated as the picture has them."""

import numpy as np
import pytest
import pyvista as pv
from vectors import unit

from vizlight import Light, Scene, View
from vizlight.draw.cameras import camera_on
from vizlight.observers import samples
from vizlight.observers.pixels import Pixels, footprint
from vizlight.shading.options import LightOptions


def places_of(line_field, vectors):
    """Return the tangents at two places of a square, seen from above, and their corners."""
    square = pv.Plane(i_resolution=1, j_resolution=1).triangulate()
    square["V"] = vectors
    scene = Scene(lights=Light(direction=(1, 2, 3)), view=View(direction=(0, 0, 1)))
    part = samples.part_on(square, scene, LightOptions(tangents="V", line_field=line_field))
    camera = pv.Camera()
    camera.position, camera.focal_point, camera.up = (0, 0, 3), (0, 0, 0), (0, 1, 0)
    camera.parallel_projection, camera.parallel_scale = True, 0.5
    middles = np.asarray(square.points)[part.cells].mean(axis=1)
    row = np.rint((0.5 - middles[:, 1]) * 300 - 0.5).astype(int)
    column = np.rint((0.5 + middles[:, 0]) * 300 - 0.5).astype(int)
    none = np.zeros(2, dtype=int)
    at = Pixels(row, column, none, np.arange(2), (300, 300))
    found = samples.sample(part, at, camera)
    np.testing.assert_allclose(found.points, middles, atol=2e-3)
    np.testing.assert_allclose(footprint(camera, found.points, 300), 1 / 300)
    return part.cells, found


@pytest.mark.parametrize("line_field", [False, True])
def test_tangents_are_vectors_unless_they_are_lines(line_field):
    vectors = np.array([[1.0, 0, 0], [-0.6, 0.8, 0], [0, 1, 0], [0.8, -0.6, 0]])
    cells, found = places_of(line_field, vectors)
    for ids, own in zip(cells, found.tangents[:, 0], strict=True):
        rows = vectors[ids]
        if line_field:
            expected = np.linalg.eigh(rows.T @ rows)[1][:, -1]
            assert abs(own @ expected) > 0.97
        else:
            np.testing.assert_allclose(own, unit(rows.mean(axis=0)), atol=0.02)


def test_the_length_of_vectors_is_kept_beside_their_direction():
    _, found = places_of(False, 3.0 * np.tile([0, 1.0, 0], (4, 1)))
    np.testing.assert_allclose(found.magnitude, 3, rtol=1e-6)
    np.testing.assert_allclose(found.tangents[:, 0], [[0, 1, 0]] * 2, atol=1e-6)


def test_a_pixel_far_away_is_larger():
    camera = camera_on((-1, 1, -1, 1, -1, 1), (0, 0, 1))
    near, far = footprint(camera, np.array([[0, 0, 1.0], [0, 0, -1.0]]), 100)
    assert 0 < near < far
