"""Data at places of a picture are interpolated as the picture has them."""

import numpy as np
import pytest
import pyvista as pv
from vectors import unit

from vizlight import Light, Scene, View
from vizlight.draw.cameras import camera_on
from vizlight.observers import samples
from vizlight.observers.pixels import Pixels, footprint
from vizlight.observers.samples import camera_of, rays, weights
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
    np.testing.assert_allclose(found.right, [[1, 0, 0]] * 2, atol=1e-12)
    np.testing.assert_allclose(found.up, [[0, 1, 0]] * 2, atol=1e-12)
    assert (part.kind, part.drawn.width) == ("surface", 1)
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


def line_part(vectors=None, times=None, **how):
    """Return a part of a line of three segments along x, with an array V and times."""
    mesh = pv.lines_from_points(np.column_stack([np.arange(4.0), np.zeros((4, 2))]))
    scene = Scene(lights=Light.headlight(), view=View(direction=(0, 0, 1)))
    if times is not None:
        mesh["IntegrationTime"] = np.array(times, float)
    if vectors is not None:
        mesh["V"] = np.array(vectors, float)
        how = {"tangents": "V"} | how
    return samples.part_on(mesh, scene, LightOptions(**how))


def ahead(*args, **how):
    return line_part(*args, **how).ahead(np.arange(3)).tolist()


def test_segments_run_ahead_with_time_or_with_their_vectors():
    assert ahead() == [0, 0, 0]
    assert ahead(times=[0, 1, 1, 0.5]) == [1, 0, -1]
    along, back = [1, 0.2, 0], [-2, 0.5, 0]
    vectors = [along, along, along, back]
    assert ahead(vectors) == [1, 1, -1]
    assert line_part(vectors).ahead(np.array([2, 0])).tolist() == [-1, 1]
    assert ahead(vectors, line_field=True) == [0, 0, 0]
    assert ahead(vectors, times=[3, 2, 1, 0]) == [-1, -1, -1]
    assert ahead(np.tile(np.eye(3)[:2].ravel(), (4, 1))) == [0, 0, 0]


def test_a_view_becomes_the_camera_of_a_picture():
    mesh = pv.Cube()
    far = camera_of(mesh, None, View(position=(0, 0, 9)), 1.5)
    np.testing.assert_allclose(far.position, (0, 0, 9))
    np.testing.assert_allclose(far.direction, (0, 0, -1), atol=1e-9)
    assert not far.parallel_projection
    both = camera_of(mesh, None, View(position=(0, 0, 9), direction=(0, 1, 1)), 1.5)
    np.testing.assert_allclose(both.position, (0, 0, 9))
    np.testing.assert_allclose(both.direction, np.array([0, -1, -1]) / np.sqrt(2), atol=1e-9)
    side = camera_of(mesh, Scene(view=View(direction=(1, 0, 0), parallel=True)), None, 1.5)
    np.testing.assert_allclose(side.direction, (-1, 0, 0), atol=1e-9)
    assert side.parallel_projection
    given = pv.Camera()
    given.position = (1, 2, 3)
    own = camera_of(mesh, None, given, 1.5)
    assert own is not given
    np.testing.assert_allclose(own.position, (1, 2, 3))


def test_lines_of_sight_go_through_the_places_of_a_picture():
    camera = pv.Camera()
    camera.position, camera.focal_point, camera.up = (0, 0, 4), (0, 0, 0), (0, 1, 0)
    camera.view_angle = 90
    at = np.array([[0, 0], [1, 0], [0, -0.5]])
    origin, way = rays(camera, at)
    np.testing.assert_allclose(origin, [[0, 0, 4]] * 3)
    np.testing.assert_allclose(way / -way[:, 2:], [[0, 0, -1], [1, 0, -1], [0, -0.5, -1]])
    np.testing.assert_allclose(np.linalg.norm(way, axis=1), 1)
    camera.parallel_projection, camera.parallel_scale = True, 3.0
    origin, way = rays(camera, at)
    np.testing.assert_allclose(origin, [[0, 0, 4], [3, 0, 4], [0, -1.5, 4]], atol=1e-12)
    np.testing.assert_allclose(way, [[0, 0, -1]] * 3, atol=1e-12)


def test_cells_that_are_seen_edge_on_have_shares_too():
    edge = np.array([[[0, 0, 0], [0, 0, 1], [0, 0, 2.0]], [[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]])
    origin, way = np.array([[0, 0, 5], [0.25, 0.5, 5.0]]), np.tile([0, 0, -1.0], (2, 1))
    np.testing.assert_allclose(weights(edge, origin, way), [[1, 0, 0], [0.25, 0.25, 0.5]])
    np.testing.assert_allclose(weights(edge[:, 1:], origin, way), [[1, 0], [0.375, 0.625]])
    np.testing.assert_array_equal(weights(edge[:, :1], origin, way), [[1], [1]])
