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


def test_a_seam_of_a_texture_is_not_seen_in_the_light(tmp_path):
    """Points of a seam differ in their place on the texture, not in their normal."""
    x, y = np.meshgrid(np.linspace(0, 1, 25), np.linspace(0.02, 0.98, 15))
    turn, tilt = 2 * np.pi * x, np.pi * y
    ball = np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], -1)
    ball[:, -1] = ball[:, 0]
    at = np.arange(x.size).reshape(x.shape)
    quads = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], -1).reshape(-1, 4) + 1
    lines = [f"v {a:.6f} {b:.6f} {c:.6f}" for a, b, c in ball.reshape(-1, 3)]
    lines += [f"vt {u} {v}" for u, v in zip(x.ravel(), y.ravel(), strict=True)]
    lines += ["f " + " ".join(f"{i}/{i}" for i in quad) for quad in quads.tolist()]
    (tmp_path / "ball.obj").write_text("\n".join(lines))
    mesh = vizlight.read(tmp_path / "ball.obj")
    assert mesh.n_points == x.size  # the texture keeps its seam
    scene = Scene(view=View(direction=(1, 0, 0)))
    for angle in (None, "auto"):
        lit = vizlight.illuminate(mesh, scene, feature_angle=angle)["luminance"]
        _, same = np.unique(mesh.points, axis=0, return_inverse=True)
        same = same.reshape(-1)
        for i in np.flatnonzero(np.bincount(same) > 1):
            assert np.ptp(lit[same == i]) < 1e-6


def test_points_without_a_face_are_left_out(tmp_path, recwarn):
    points = np.vstack([np.full((5, 3), 9.0), BALL.points])
    pv.PolyData.from_regular_faces(points, BALL.regular_faces + 5).save(tmp_path / "a.ply")
    read = vizlight.read(tmp_path / "a.ply")
    np.testing.assert_array_equal(read.points, BALL.points)
    np.testing.assert_array_equal(read.regular_faces, BALL.regular_faces)
    assert "luminance_valid" not in vizlight.illuminate(read).point_data
    assert not recwarn.list


def test_what_is_no_soup_is_the_same_mesh():
    lines = pv.Line()
    assert welded(BALL) is BALL
    assert welded(lines) is lines
