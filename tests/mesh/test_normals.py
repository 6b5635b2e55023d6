"""Points are split as VTK splits them, and normals do not depend on the size of parts."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import Scene, View
from vizlight.geometry.lines import simplices
from vizlight.mesh.normals import normals_of, welded
from vizlight.vtk import cells, corners, normals, orientation, topology


def plain(mesh):
    mesh.clear_data()
    return mesh


def turned_over():
    box = pv.Cube().triangulate().subdivide(2).clean()
    faces = box.regular_faces.copy()
    faces[::7] = faces[::7, ::-1]
    return pv.PolyData.from_regular_faces(box.points, faces)


def tips():
    """Two cones that meet at their tips alone."""
    cone = plain(pv.Cone(resolution=12).triangulate())
    other = cone.rotate_y(180, point=(cone.bounds[1], 0, 0))
    return cone.append_polydata(other).clean()


def tangle():
    rng = np.random.default_rng(0)
    faces = [row for row in rng.integers(0, 90, (300, 3)) if len(set(row)) == 3]
    return pv.PolyData.from_regular_faces(rng.random((90, 3)), np.array(faces))


SURFACES = {
    "box": lambda: plain(pv.Cube().triangulate().subdivide(2).clean()),
    "quads": lambda: plain(pv.Box(level=4).clean()),
    "polygons": lambda: plain(pv.Cylinder(resolution=9).clean()),
    "turned over": turned_over,
    "tips": tips,
    "tangle": tangle,
}


@pytest.mark.parametrize("name", sorted(set(SURFACES) - {"tangle"}))
def test_points_are_split_as_by_vtk(name, monkeypatch):
    """VTK numbers points in another way, and turns faces over that are not wound alike."""
    mesh = SURFACES[name]()
    whole = mesh.compute_normals(
        cell_normals=False, split_vertices=True, feature_angle=25, consistent_normals=True,
        auto_orient_normals=False, non_manifold_traversal=False,
    )  # fmt: skip
    monkeypatch.setattr(corners, "EDGES", 200)
    ids, ends = cells.connectivity(mesh.GetPolys())
    split, origin, turned = corners.split_faces(mesh.points, ids, ends, 25)
    np.testing.assert_array_equal(origin[split], ids)
    np.testing.assert_array_equal(origin[: mesh.n_points], np.arange(mesh.n_points))
    face = np.repeat(np.arange(mesh.n_cells), np.diff(ends))
    theirs = cells.connectivity(whole.GetPolys())[0]
    places = [(f, *place) for f, place in zip(face, mesh.points[ids].tolist(), strict=True)]
    found = dict(zip(places, split.tolist(), strict=True))
    pairs = {
        (found[(f, *place)], i)
        for f, place, i in zip(face, whole.points[theirs].tolist(), theirs.tolist(), strict=True)
    }
    assert len(pairs) == len(origin) == whole.n_points > mesh.n_points
    over = np.add.reduceat(np.any(whole.points[theirs] != mesh.points[ids], axis=1), ends[:-1]) > 0
    np.testing.assert_array_equal(turned, over)


@pytest.mark.parametrize("name", SURFACES)
def test_normals_do_not_depend_on_the_size_of_parts(name, monkeypatch):
    mesh = SURFACES[name]()
    own = [normals.computed_normals(mesh, as_wound=wound) for wound in (False, True)]
    for module in (topology, simplices):
        monkeypatch.setattr(module, "EDGES", 64)
    monkeypatch.setattr(orientation, "BLOCK", 16)
    for before, wound in zip(own, (False, True), strict=True):
        after = normals.computed_normals(mesh, as_wound=wound)
        np.testing.assert_array_equal(after.vectors, before.vectors)
        np.testing.assert_array_equal(after.lean, before.lean)
        np.testing.assert_array_equal(after.open, before.open)
        assert after.sharp == before.sharp


def test_a_surface_without_creases_is_surveyed_once(monkeypatch):
    made = []

    class Counted(orientation.SurfaceShape):
        def __init__(self, *given, **options):
            made.append(self)
            super().__init__(*given, **options)

    monkeypatch.setattr(orientation, "SurfaceShape", Counted)
    ball = plain(pv.Sphere())
    scene = vizlight.Scene(lights=vizlight.Light(direction=(1, 1, 1)))
    lit = vizlight.illuminate(ball, scene, feature_angle="auto")
    assert len(made) == 1
    np.testing.assert_array_equal(lit["luminance"], vizlight.illuminate(ball, scene)["luminance"])


def test_edges_at_the_angle_itself_are_split_alike_however_a_cylinder_is_turned():
    for turn in range(0, 90, 9):
        cylinder = pv.Cylinder(resolution=12).triangulate().clean().rotate_vector((1, 2, 3), turn)
        cylinder = pv.PolyData.from_regular_faces(cylinder.points, cylinder.regular_faces)
        split = vizlight.illuminate(cylinder, vizlight.Scene(), feature_angle=30)
        # The rim is split between the side and the caps, the side nowhere.
        assert split.n_points == 2 * cylinder.n_points


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


def test_points_without_a_face_are_left_out(tmp_path):
    points = np.vstack([np.full((5, 3), 9.0), BALL.points])
    pv.PolyData.from_regular_faces(points, BALL.regular_faces + 5).save(tmp_path / "a.ply")
    with pytest.warns(UserWarning, match=f"5 of its {len(points)} points are in no face"):
        read = vizlight.read(tmp_path / "a.ply")
    np.testing.assert_array_equal(read.points, BALL.points)
    np.testing.assert_array_equal(read.regular_faces, BALL.regular_faces)
    assert "luminance_valid" not in vizlight.illuminate(read).point_data


def test_what_is_no_soup_is_the_same_mesh():
    lines = pv.Line()
    assert welded(BALL) is BALL
    assert welded(lines) is lines


def test_normals_for_an_eye_are_computed_once(calls_of):
    calls = calls_of(normals, "_computed")
    view = View(direction=(0, 0, -1))
    sheet, ball = plain(pv.Plane(i_size=0.7)), plain(pv.Sphere(radius=0.7))
    assert np.all(normals_of(sheet, None, 3, view)[:, 2] < 0)
    assert len(calls) == 1
    for eye in (view, None, view):
        outward = normals_of(ball, None, 3, eye)
        assert np.einsum("ij,ij->i", outward, ball.points).min() > 0
    assert len(calls) == 2
    # Without an eye those of the sheet are its own, which are then kept.
    normals_of(sheet, None, 3, None)
    assert normals.known_normals(sheet) is not None
