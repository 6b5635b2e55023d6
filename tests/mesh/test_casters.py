"""Shadows of closed meshes as point scalars: closed forms, occluders, any size and place."""

import contextlib

import numpy as np
import pytest
import pyvista as pv
from lamps import far
from vectors import unit

import vizlight
from vizlight import Light, Material, Scene, _progress, relief_shadow
from vizlight.geometry.relief import shadowing
from vizlight.mesh import closed_meshes

TOWARD = np.array([0.6, -0.5, 0.4])
SCENE = Scene(lights=Light(direction=TOWARD), material=Material(ambient=0.1, specular=0))


def test_highlight_keeps_the_share_that_t_has_of_the_cosine():
    mesh = pv.Sphere(theta_resolution=40, phi_resolution=40)
    scene = far((1, 0, 1), (1, 0, 1), Material(ambient=0, diffuse=0, specular=1))
    wall = pv.Cube(center=(2, 0.2, 2), x_length=0.5, y_length=0.4, z_length=0.5).triangulate()
    free = vizlight.illuminate(mesh, scene)["luminance"]
    out = relief_shadow(mesh, scene, depth=0.01, lit=True, occluders=[wall])
    cosine = np.maximum(np.asarray(mesh.point_normals) @ [0.5**0.5, 0, 0.5**0.5], 0)
    share = np.minimum(out["t"] / np.maximum(cosine, 1e-9), 1)
    np.testing.assert_allclose(out["luminance"], free * share, atol=1e-5)
    shaded = (cosine > 0.95) & (out["t"] < 0.1)
    assert shaded.sum() > 5
    assert free[shaded].max() > 0.5


def test_sphere_has_its_closed_form():
    """At every point, light at infinity and near: below 1e-3 with cells of 1.2 degrees."""
    mesh = pv.Sphere(radius=1, theta_resolution=300, phi_resolution=151)
    n = unit(np.asarray(mesh.points, dtype=float))
    depth = 0.1
    for light in (Light(direction=(1, 2, 3)), Light(position=(1.2, -0.9, 0.7))):
        out = relief_shadow(mesh, Scene(lights=light), depth=depth)
        start = (1 - depth) * n
        if light.direction is not None:
            way = np.tile(np.array(light.direction) / 14**0.5, (len(n), 1))
        else:
            way = unit(np.array(light.position) - start)
        middle = np.einsum("ij,ij->i", start, way)
        r = -middle + np.sqrt(middle**2 + 1 - (1 - depth) ** 2)
        assert np.abs(out["t"] - depth / np.maximum(r, depth)).max() < 1e-3


@pytest.mark.parametrize("far", [1e20, 1e200, 1e308])
@pytest.mark.parametrize("size", [1, 1e-120])
def test_a_light_far_away_is_a_direction(far, size):
    ball = pv.Sphere(theta_resolution=20, phi_resolution=20)
    mesh = pv.PolyData(np.asarray(ball.points, dtype=float) * size, ball.faces)
    mesh["Normals"] = np.asarray(ball.point_normals)
    mesh.point_data.active_normals_name = "Normals"
    one, other = (
        relief_shadow(mesh, Scene(lights=Light(**where)))["t"]
        for where in ({"direction": TOWARD}, {"position": far * TOWARD})
    )
    np.testing.assert_allclose(other, one, atol=1e-9)


@pytest.mark.parametrize(("scale", "moved"), [(1e-120, 0.0), (1e120, 0.0), (1e3, 4e6)])
def test_closed_mesh_of_any_size_and_place(scale, moved):
    """Far from the origin float32 rounds the points; what it kept has the same shadow."""
    ball = pv.Sphere(theta_resolution=30, phi_resolution=30)
    faces, points = ball.regular_faces, np.asarray(ball.points, dtype=float) * scale
    if moved:
        points = (points + moved).astype(np.float32)
    far = pv.PolyData.from_regular_faces(points, faces)
    near = pv.PolyData.from_regular_faces((points.astype(float) - moved) / scale, faces)
    for mesh in (far, near):
        mesh["Normals"] = np.asarray(ball.point_normals)
        mesh.point_data.active_normals_name = "Normals"
    t = relief_shadow(far, SCENE, depth=0.1 * scale)["t"]
    np.testing.assert_allclose(t, relief_shadow(near, SCENE, depth=0.1)["t"], atol=1e-9)
    assert 0 < t.min() < t.max()


def test_depth_to_zero_on_a_closed_mesh():
    mesh = pv.Sphere(theta_resolution=60, phi_resolution=60)
    normals = np.asarray(mesh.point_normals, dtype=float)
    cosine = np.maximum(normals @ TOWARD / np.linalg.norm(TOWARD), 0)
    t = relief_shadow(mesh, SCENE, depth=0)["t"]
    np.testing.assert_allclose(t[cosine > 0.05], cosine[cosine > 0.05], atol=1e-6)
    assert not t[cosine == 0].any()


def test_field_and_the_same_solid_as_a_mesh_agree():
    """A height field with walls is the closed mesh that it bounds, which ends deep below."""
    x = np.linspace(0, 2, 21)
    z = 0.3 * np.maximum(0, 1 - 2 * np.abs(x - 1)) + 0 * x[:, None]
    grid = pv.StructuredGrid(*np.meshgrid(x, x, indexing="ij"), z.T)
    field = relief_shadow(grid, SCENE, depth=0.05, border="wall")
    top = grid.extract_surface(algorithm="geometry").triangulate()
    side = pv.Plane(center=(1, 1, -9.0), direction=(0, 0, 1), i_size=4, j_size=4)
    solid = top.extrude_trim((0, 0, -1), side.triangulate()).triangulate().clean()
    solid = solid.compute_normals(auto_orient_normals=True, split_vertices=False)
    solid.point_data.pop("Normals")
    start = np.asarray(grid.points, dtype=float)
    inner = (start[:, :2] > 0.3).all(axis=1) & (start[:, :2] < 1.7).all(axis=1)
    nearest = [solid.find_closest_point(p) for p in start[inner]]
    flat = np.isclose(start[inner][:, 2], 0) & (np.abs(start[inner][:, 0] - 1) > 0.55)
    with pytest.warns(UserWarning, match="of the edges are sharper than 30 degrees"):
        t = relief_shadow(solid, SCENE, depth=0.05)["t"][nearest]
    np.testing.assert_allclose(t[flat], field["t"][inner][flat], atol=1e-6)


def test_occluder_in_the_way():
    ball = pv.Sphere(theta_resolution=40, phi_resolution=40)
    screen = pv.Cube(center=(0, 0, 3), x_length=4, y_length=4, z_length=0.5).triangulate()
    scene = Scene(lights=Light(direction=(0, 0, 1)))
    alone = relief_shadow(ball, scene, depth=0.1)["t"]
    behind = relief_shadow(ball, scene, depth=0.1, occluders=[screen])["t"]
    np.testing.assert_array_equal(
        relief_shadow(ball, scene, depth=0.1, occluders=screen)["t"], behind
    )
    lit = alone < 1
    np.testing.assert_allclose(0.1 / behind[lit], 0.1 / alone[lit] + 0.5, atol=1e-9)


def test_open_surface_with_thickness():
    plane = pv.Plane(i_size=2, j_size=2, i_resolution=20, j_resolution=20)
    scene = Scene(lights=Light(direction=(0, 3, 4)))
    with pytest.raises(ValueError, match="mesh: expected a closed surface.*thickness="):
        relief_shadow(plane, scene)
    out = relief_shadow(plane, scene, depth=0.1, thickness=0.3)
    inner = (np.abs(np.asarray(plane.points)[:, :2]) < [0.95, 0.5]).all(axis=1)
    np.testing.assert_allclose(out["t"][inner], 0.8, atol=1e-6)


@pytest.mark.parametrize("loose", [np.nan, np.inf, 9.0])
@pytest.mark.parametrize("thickness", [None, 0.3])
def test_a_loose_point_changes_no_other(loose, thickness):
    ball = pv.Icosphere(nsub=2)
    mesh = pv.PolyData(np.vstack([ball.points, [[loose] * 3]]), ball.faces)
    with pytest.warns(UserWarning, match="1 of 163 points have no normal"):
        out = relief_shadow(mesh, SCENE, thickness=thickness)
    t = relief_shadow(ball, SCENE, thickness=thickness)["t"]
    np.testing.assert_allclose(out["t"], np.append(t, 0), atol=1e-6)
    assert np.flatnonzero(~out["t_valid"].astype(bool)).tolist() == [162]


def test_a_shadow_is_made_again_from_what_is_told():
    ball = pv.Sphere()
    told = vizlight.provenance(relief_shadow(ball, SCENE, samples=2), "t")
    assert told["options"]["occluders"] == []
    again = relief_shadow(ball, Scene.from_dict(told["scene"]), **told["options"])
    np.testing.assert_array_equal(again["t"], relief_shadow(ball, SCENE, samples=2)["t"])
    other = pv.Sphere(center=TOWARD)
    told = vizlight.provenance(relief_shadow(ball, SCENE, occluders=(o for o in [other])), "t")
    assert told["options"]["occluders"] == [f"PolyData of {other.n_points} points"]
    for wrong in (0, told["options"]["occluders"]):
        with pytest.raises(TypeError, match="occluders.*: expected .*surface"):
            relief_shadow(ball, SCENE, occluders=wrong)


@pytest.mark.parametrize("inplace", [False, True])
def test_points_are_split_at_sharp_edges(inplace):
    """The free faces of a box toward the light have its cosine, up to their edges, at depth 0."""
    box = pv.Cube().triangulate().subdivide(3).clean()
    box.clear_data()
    scene = Scene(lights=Light(direction=(1, 2, 3)))
    out = relief_shadow(box, scene, depth=0.0, feature_angle="auto", inplace=inplace)
    assert (out is box) == inplace
    assert out.n_points == 6 * 81
    cosines = [0, *(np.array([1.0, 2, 3]) / 14**0.5)]
    off = np.abs(np.asarray(out["t"])[:, np.newaxis] - cosines)
    assert off.min(axis=1).max() < 1e-6
    assert np.bincount(off.argmin(axis=1)).tolist() == [3 * 81, 81, 81, 81]
    day = vizlight.relief_day(box, sun=[(30, 20), (60, 50)], feature_angle=30)
    assert day["t"].shape == (6 * 81, 2)


def test_a_surface_may_hold_vertices_and_lines():
    """As files of gmsh do."""
    box = pv.Cube().triangulate().subdivide(3).clean()
    box.clear_data()
    expected = relief_shadow(box, SCENE, feature_angle=30)["t"]
    box.verts = [1, 0, 1, 5]
    box.lines = [2, 0, 1]
    box.cell_data["gmsh:physical"] = np.arange(box.n_cells)
    found = relief_shadow(box, SCENE, feature_angle=30)
    np.testing.assert_array_equal(found["t"], expected)
    assert found.n_cells == box.n_cells


def test_a_height_field_has_no_sharp_edges():
    flat = pv.ImageData(dimensions=(5, 5, 1))
    flat["height"] = [0.0] * 25
    with pytest.raises(ValueError, match="feature_angle: expected none on a height field, got 30"):
        relief_shadow(flat, SCENE, feature_angle=30)


@pytest.mark.parametrize("kind", ["field", "solid"])
def test_progress_advances_within_one_light(kind, monkeypatch):
    told = []

    @contextlib.contextmanager
    def progress(what, total, *, show):
        assert (what, show) == ("shadow", True)
        told.append(total)
        yield told.append

    monkeypatch.setattr(_progress, "progress", progress)
    monkeypatch.setattr(closed_meshes, "BLOCK", 100)
    monkeypatch.setattr(shadowing, "BLOCK", 100)
    monkeypatch.setenv("VIZLIGHT_FAST", "0")
    mesh = pv.Sphere()
    if kind == "field":
        mesh = pv.ImageData(dimensions=(30, 30, 1))
        mesh["height"] = np.arange(900.0) % 7
    monkeypatch.setenv("VIZLIGHT_THREADS", "1")
    relief_shadow(mesh, SCENE, progress_bar=True, angular_diameter=0.1, samples=3)
    total, *steps = told
    assert total == 3 * mesh.n_points
    assert steps == sorted(steps)
    assert steps[-1] == total
    assert len(set(steps)) > 3 if kind == "field" else len(set(steps)) > 9
