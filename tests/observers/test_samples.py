"""Data at places of a picture are interpolated as the picture has them."""

import numpy as np
import pytest
import pyvista as pv
from vectors import unit

from vizlight import Light, Scene, View
from vizlight.observers import samples
from vizlight.observers.samples import parts_of
from vizlight.shading.options import LightOptions


def places_of(line_field, vectors):
    """Return the tangents at the middles of the two triangles of a square, seen from above."""
    square = pv.Plane(i_resolution=1, j_resolution=1).triangulate()
    square["V"] = vectors
    scene = Scene(lights=Light(direction=(1, 2, 3)), view=View(direction=(0, 0, 1)))
    options = LightOptions(tangents="V", line_field=line_field)
    (part,) = parts_of(square, scene, options, None)
    camera = pv.Camera()
    camera.position, camera.focal_point, camera.up = (0, 0, 3), (0, 0, 0), (0, 1, 0)
    cells = part.cells
    middles = np.asarray(square.points)[cells].mean(axis=1)
    half = 3 * np.tan(np.radians(camera.view_angle / 2))
    found = samples.sample(part, cells, middles[:, :2] / half, camera, scene)
    np.testing.assert_allclose(found.points, middles, atol=1e-6)
    return cells, found


@pytest.mark.parametrize("line_field", [False, True])
def test_tangents_are_vectors_unless_they_are_lines(line_field):
    vectors = np.array([[1.0, 0, 0], [-0.6, 0.8, 0], [0, 1, 0], [0.8, -0.6, 0]])
    cells, found = places_of(line_field, vectors)
    assert found.tangents is not None
    for ids, own in zip(cells, found.tangents[:, 0], strict=True):
        rows = vectors[ids]
        if line_field:
            expected = np.linalg.eigh(rows.T @ rows)[1][:, -1]
            assert abs(own @ expected) > 0.97
        else:
            np.testing.assert_allclose(own, unit(rows.mean(axis=0)), atol=1e-6)
