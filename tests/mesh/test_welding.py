"""Faces with points of their own become a surface; colours that differ keep points apart."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import Scene, View
from vizlight.mesh.welding import welded

BALL = pv.Sphere()
BALL.clear_data()


def soup():
    """Return the faces of a sphere, each with points of its own."""
    corners = BALL.regular_faces
    return pv.PolyData.from_regular_faces(
        BALL.points[corners.ravel()], np.arange(corners.size).reshape(corners.shape)
    )


def test_a_soup_of_triangles_has_the_light_of_its_surface(tmp_path):
    pytest.importorskip("meshio")
    points, faces = soup().points, soup().regular_faces
    lines = [f"{x} {y} {z}" for x, y, z in points] + [f"3 {a} {b} {c}" for a, b, c in faces]
    path = tmp_path / "a.off"
    path.write_text("\n".join(["OFF", f"{len(points)} {len(faces)} 0", *lines, ""]))
    mesh = vizlight.read(path)
    assert mesh.n_points == BALL.n_points
    scene = Scene(view=View(direction=(1, 1, 1)))
    corner = mesh.regular_faces.ravel()
    known = vizlight.illuminate(BALL, scene)["luminance"][BALL.regular_faces.ravel()]
    found = vizlight.illuminate(mesh, scene)["luminance"][corner]
    np.testing.assert_allclose(found, known, atol=1e-5)


def test_colours_of_faces_stay():
    mesh = soup()
    mesh["rgb"] = np.repeat(np.arange(mesh.n_cells) % 2, 3).astype(np.uint8)
    found = welded(mesh)
    assert BALL.n_points < found.n_points <= 2 * BALL.n_points
    np.testing.assert_array_equal(found["rgb"][found.regular_faces.ravel()], mesh["rgb"])


def test_what_is_no_soup_is_the_same_mesh():
    lines = pv.Line()
    assert welded(BALL) is BALL
    assert welded(lines) is lines
