"""The exposure of the light that a camera sees."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.looks.exposure import exposure_seen
from vizlight.shading.display import exposure_of

SIZE = (300, 200)


def ball():
    mesh = pv.Sphere(theta_resolution=60, phi_resolution=60)
    mesh["T"] = np.asarray(mesh.points)[:, 2]
    return mesh


def test_the_70th_percentile_of_the_pixels_of_a_surface_becomes_1():
    look = vizlight.look(ball(), size=SIZE)
    plain = look.scene.replace(exposure=None)
    lit = vizlight.illuminate(ball(), plain)
    # By ray casting through each pixel: nothing is shared with the sample of triangles.
    eye, focus = np.asarray(look.view.position), np.asarray(look.view.focal_point)
    toward = (eye - focus) / np.linalg.norm(eye - focus)
    right = np.cross((0, 0, 1), toward)
    right /= np.linalg.norm(right)
    up = np.cross(toward, right)
    at = np.linspace(-0.49, 0.49, 40)
    rows = [x * right + y * up for x in at for y in at if x * x + y * y < 0.24]
    points = [row + toward * np.sqrt(0.25 - row @ row) for row in rows]
    nearest = [lit.find_closest_point(point) for point in points]
    expected = exposure_of(lit["luminance"][nearest])
    assert look.scene.exposure == pytest.approx(expected, abs=0.1)
    assert look.scene.exposure > 1


@pytest.mark.parametrize("n", [4, 40])
def test_a_polygon_toward_the_eye_is_as_bright_as_a_plane(n):
    """Copies of its triangles in the sample are no closed surface, which is dark inside."""
    polygon, other = (pv.Polygon(n_sides=sides, normal=(-1, -1, 1)) for sides in (n, 5))
    exposure = vizlight.look(polygon, size=SIZE).scene.exposure
    assert exposure == vizlight.look(other, size=SIZE).scene.exposure
    assert exposure < 2


def test_a_scene_that_is_given_is_not_exposed():
    scene = vizlight.Scene()
    assert vizlight.look(ball(), scene=scene, size=SIZE).scene.exposure is None


def test_rows_of_arrays_follow_the_corners_that_are_seen():
    mesh, look = ball(), vizlight.look(ball(), size=SIZE)
    normals = np.asarray(mesh.point_normals, dtype=np.float64)
    mesh["n"] = normals
    plain = look.scene.replace(exposure=None)
    found = {exposure_seen(mesh, plain, look.view, {"normals": given}) for given in ("n", normals)}
    assert len(found) == 1
    # Triangles are lit by their own planes where no normals are given.
    assert exposure_seen(mesh, plain, look.view, {}) == pytest.approx(found.pop(), abs=0.1)
    assert exposure_seen(pv.ImageData(dimensions=(3, 3, 3)), plain, look.view, {}) == 1
