"""The side of a surface that is lit, its sharp edges, and normals that stay with a result."""

import numpy as np
import pytest
import pyvista as pv
from lamps import SHINY, far, shiny
from vectors import unit

import vizlight
from vizlight import Light, Scene, View, illuminate
from vizlight.mesh import normals
from vizlight.vtk import normals as vtk_normals

HEAD = Scene(lights=Light.headlight(), view=View(position=(2.0, 3.0, 4.0)), material=SHINY)
MATTE = shiny(specular=0)


@pytest.fixture(scope="module")
def isosurface():
    """An open isosurface of real flow, without normals and with those of the field."""
    flow = vizlight.load_example()
    level = float(np.quantile(flow["Temp"], 0.3))
    bare = flow.contour([level], scalars="Temp")
    given = flow.contour([level], scalars="Temp", compute_normals=True)
    bare.clear_data()
    return bare, given


def dots(a, b):
    return np.einsum("ij,ij->i", np.asarray(a, float), np.asarray(b, float))


@pytest.mark.slow
@pytest.mark.opengl
def test_what_is_seen_of_an_open_surface_is_lit(isosurface, random):
    """At most 1 in 100 of the pixels has the ambient light only; it was half of them."""
    for surface in isosurface:
        for toward in [*random.standard_normal((3, 3)), (-1, 0.4, 0.3)]:
            camera = vizlight.render.camera_on(surface, toward)
            scene = HEAD.replace(view=View.from_camera(camera), material=MATTE)
            picture = {}
            for facing in ("auto", "outward"):
                lit = illuminate(surface, scene, facing=facing)
                options = {"size": (200, 200), "anti_aliasing": None, "background": "white"}
                (picture[facing],) = vizlight.render.pictures([lit], camera=camera, **options)
            seen = picture["auto"][..., 0] < 200
            assert seen.sum() > 3000
            assert np.mean(picture["auto"][..., 0][seen] <= 27) < 0.01


@pytest.mark.parametrize("position", [(0.2, 0.1, 3), (0.2, 0.1, -3)])
def test_an_open_surface_faces_the_eye_point_by_point(position):
    wave = pv.Plane(i_resolution=40, j_resolution=40, i_size=6, j_size=6)
    x, y = np.array(wave.points)[:, :2].T
    wave.points = np.stack([x, y, np.sin(2 * x) * np.cos(y)], axis=1)
    wave.clear_data()
    scene = HEAD.replace(view=View(position=position), material=MATTE)
    lit = illuminate(wave, scene)
    toward = unit(np.asarray(position) - wave.points)
    slope = np.stack([-2 * np.cos(2 * x) * np.cos(y), np.sin(2 * x) * np.sin(y), 1 + 0 * x], axis=1)
    exact = np.abs(dots(slope / np.linalg.norm(slope, axis=1, keepdims=True), toward))
    inner = np.abs(wave.points[:, :2]).max(axis=1) < 2.9
    seen = inner & (exact > 0.4)
    error = np.abs(lit["luminance"] - 0.1 - 0.5 * exact)[seen]
    assert seen.sum() > 400
    assert error.max() < 0.03


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("carried", [True, False])
def test_closed_surfaces_face_outward_whatever_their_normals(sign, carried):
    ball = pv.Sphere()
    outward = np.asarray(ball.points) / 0.5
    if carried:
        ball.point_data.active_normals = sign * outward
    else:
        ball = pv.PolyData.from_regular_faces(ball.points, ball.regular_faces[:, ::sign])
    scene = Scene(lights=Light(direction=(1, 2, 3)), view=View(direction=(0, 0, 1)), material=MATTE)
    lit = illuminate(ball, scene)
    expected = 0.1 + 0.5 * np.maximum(outward @ (1, 2, 3) / 14**0.5, 0)
    np.testing.assert_allclose(lit["luminance"], expected, atol=0.01)
    if carried:
        turned = illuminate(ball, scene, facing="as given")["luminance"]
        expected = 0.1 + 0.5 * np.maximum(sign * (outward @ (1, 2, 3)) / 14**0.5, 0)
        np.testing.assert_allclose(turned, expected, atol=0.01)


def test_normals_as_given_follow_the_corners_of_the_faces():
    sheet = pv.Plane(i_resolution=2, j_resolution=2)
    sheet.clear_data()
    scene = Scene(lights=Light(direction=(0, 0, 1)), material=MATTE)
    up = illuminate(sheet, scene, facing="as given")["luminance"]
    down = illuminate(sheet.flip_faces(), scene, facing="as given")["luminance"]
    np.testing.assert_allclose(up, 0.6, rtol=1e-6)
    np.testing.assert_allclose(down, 0.1, rtol=1e-6)


def test_without_a_view_both_sides_are_lit_alike():
    sheet = pv.Plane(i_resolution=3, j_resolution=3)
    sheet.clear_data()
    lights = [Light(direction=(0, 0.6, 0.8)), Light(direction=(0, 0, -1), intensity=0.5)]
    scene = Scene(lights=lights, material=MATTE)
    for mesh in (sheet, sheet.flip_faces()):
        for facing in ("auto", "eye"):
            lit = illuminate(mesh, scene, facing=facing)["luminance"]
            np.testing.assert_allclose(lit, 0.1 + 0.5 * (0.8 + 0.5), rtol=1e-6)
    ball = illuminate(pv.Sphere(), scene.replace(lights=lights[1]))
    assert ball["luminance"][np.asarray(ball.points)[:, 2] > 0.1].max() == np.float32(0.1)


def test_lines_on_an_open_surface_are_lit_on_the_side_that_is_seen():
    sheet = pv.Plane(i_resolution=10, j_resolution=10)
    sheet["V"] = np.tile([1.0, 0.3, 0], (sheet.n_points, 1))
    for side in (1, -1):
        scene = HEAD.replace(view=View(position=(0.1, 0.2, 3 * side)))
        lines = vizlight.streamlines(sheet, scene, tangents="V", seeds=5, facing="eye")
        assert lines["luminance"].min() > 0.3


# ------------------------------------------------------------------ edges


def box():
    cube = pv.Cube()
    cube.clear_data()
    return cube.triangulate().clean().subdivide(3)


def test_no_highlight_on_the_edges_of_a_box():
    scene = far((1, 2, 3), (3, 2, 1.5))
    plain = box()
    plain["x"] = np.asarray(plain.points)[:, 0].copy()
    with pytest.warns(UserWarning, match=r"% of the edges are sharper than 30 .*feature_angle=30"):
        bent = illuminate(plain, scene)
    assert bent.n_points == plain.n_points
    for angle in (30, "auto", 89.0):
        lit = illuminate(plain, scene, feature_angle=angle)
        np.testing.assert_array_equal(lit["x"], np.asarray(lit.points)[:, 0])
        faces = np.asarray(lit["luminance"])[lit.regular_faces]
        # Each face has one value: directions toward eye and light are the same everywhere.
        assert np.ptp(faces, axis=1).max() < 1e-6
        assert len(np.unique(faces[:, 0].round(5))) <= 6
        assert lit.n_points == 6 * 81
    assert np.ptp(np.asarray(bent["luminance"])[bent.regular_faces], axis=1).max() > 0.1
    kept = illuminate(plain, scene, feature_angle=91)
    assert kept.n_points == plain.n_points


@pytest.mark.parametrize("inplace", [True, False])
def test_points_are_split_in_the_mesh_itself_only_if_asked(inplace):
    mesh = pv.MultiBlock({"box": box(), "ball": pv.Sphere()})
    before = mesh.copy()
    lit = illuminate(mesh, HEAD, feature_angle=30, inplace=inplace)
    assert lit["box"].n_points > before["box"].n_points
    assert (lit is mesh) == inplace
    if not inplace:
        assert mesh["box"] == before["box"]


def test_corners_stand_apart_from_coarse_arcs():
    """A rod of 20 sides has edges of 18 degrees, and more of them than around its two ends."""
    rod = pv.Line((0, 0, 0), (0, 0, 3), resolution=6).tube(radius=0.5, n_sides=20, capping=True)
    rod = rod.triangulate().clean()
    rod.clear_data()
    assert vtk_normals.computed_normals(rod).sharp > 0.02
    ends = normals.split_edges(rod, "auto")
    assert ends.n_points == rod.n_points + 40


def test_a_smooth_shape_of_coarse_triangles_has_no_creases():
    ball = pv.Icosphere(nsub=1)
    ball.clear_data()
    assert illuminate(ball, HEAD, feature_angle="auto").n_points == ball.n_points
    tube = pv.Cylinder(resolution=24).triangulate().clean()
    tube.clear_data()
    assert illuminate(tube, HEAD, feature_angle="auto").n_points == tube.n_points + 48


def test_arrays_of_the_user_outlive_the_split():
    mesh = box()
    mesh["Normals"] = np.arange(mesh.n_points)
    mesh.cell_data["c"] = np.arange(mesh.n_cells)
    lit = illuminate(mesh, HEAD, feature_angle=30)
    rows = np.asarray(lit["Normals"])
    np.testing.assert_array_equal(np.asarray(mesh.points)[rows], lit.points)
    np.testing.assert_allclose(
        lit.cell_centers().points, mesh.cell_centers().points[lit.cell_data["c"]], atol=1e-6
    )


def test_bad_feature_angles():
    grid = pv.ImageData(dimensions=(3, 3, 3))
    with pytest.raises(ValueError, match=r"feature_angle: expected a pyvista.PolyData.*extract_su"):
        illuminate(grid, HEAD, feature_angle=30)
    mesh = box()
    with pytest.raises(TypeError, match="tangents: expected the name of a point array beside feat"):
        illuminate(
            mesh, HEAD, tangents=np.ones((mesh.n_points, 3)), conditioned=True, feature_angle=30
        )


# ------------------------------------------------------------------ normals that stay


def fresh(mesh):
    bare = mesh.copy()
    bare.clear_data()
    return bare


@pytest.mark.parametrize("kind", ["polydata", "grid", "blocks"])
def test_light_again_takes_the_normals_that_stayed(kind, monkeypatch, tmp_path):
    mesh = pv.Sphere(end_phi=130)
    mesh.clear_data()
    if kind == "grid":
        mesh = mesh.cast_to_unstructured_grid()
    elif kind == "blocks":
        mesh = pv.MultiBlock([mesh, pv.Plane(i_resolution=16, j_resolution=16)])
        mesh[1].clear_data()
    lit = illuminate(mesh, HEAD)
    suffix = {"polydata": "vtp", "grid": "vtu", "blocks": "vtm"}[kind]
    lit.save(tmp_path / f"lit.{suffix}")
    again = pv.read(tmp_path / f"lit.{suffix}")
    other = HEAD.replace(view=View(position=(-3, 1, -4)))
    expected = illuminate(mesh, other)
    monkeypatch.setattr(vtk_normals, "computed_normals", None)
    for start in (lit, again):
        found = illuminate(start, other)
        for block, own in zip(
            vizlight.mesh.blocks.all_blocks(found),
            vizlight.mesh.blocks.all_blocks(expected),
            strict=True,
        ):
            np.testing.assert_array_equal(block["luminance"], own["luminance"])


@pytest.mark.filterwarnings("ignore:1 of 133 points could not be lit")
@pytest.mark.parametrize("change", ["points", "one point", "cells", "turned", "rows"])
def test_a_changed_mesh_is_noticed(change):
    mesh = pv.Sphere(end_phi=130, theta_resolution=12, phi_resolution=12)
    mesh.clear_data()
    lit = illuminate(mesh, HEAD).copy()
    if change == "points":
        lit.points = np.asarray(lit.points) * (1, 1, 3)
    elif change == "one point":
        lit.points[7] += (0, 0, 0.2)
    elif change == "cells":
        lit.faces = np.insert(lit.regular_faces[20:], 0, 3, axis=1).ravel()
    elif change == "turned":
        lit = lit.rotate_x(80)
    else:
        lit[normals.KEPT] = np.zeros((lit.n_points, 3))
    again = illuminate(lit, HEAD)
    expected = illuminate(fresh(lit), HEAD)
    np.testing.assert_allclose(again["luminance"], expected["luminance"], atol=1e-6)


def test_an_array_of_the_user_is_not_replaced():
    mesh = pv.Plane()
    mesh.clear_data()
    mesh[normals.KEPT] = np.arange(mesh.n_points)
    lit = illuminate(mesh, HEAD)
    np.testing.assert_array_equal(lit[normals.KEPT], np.arange(mesh.n_points))
    assert lit["luminance"].min() > 0.2


def test_normals_of_the_user_do_not_stay_a_second_time():
    assert normals.KEPT not in illuminate(pv.Sphere(), HEAD).point_data


def test_vertices_and_lines_do_not_change_where_faces_are_split():
    plain = pv.Box().triangulate().subdivide(2, "linear").clean()
    mesh = pv.PolyData(plain.points, faces=plain.faces)
    mesh.verts = np.ravel([(1, i) for i in range(7)])
    mesh.lines = np.ravel([(2, i, i + 1) for i in range(0, 40, 2)])
    mesh.cell_data["own"] = np.arange(mesh.n_cells)
    scene = far((1, 0.5, 2), (1, 1, 1))
    ours, others = (vtk_normals.computed_normals(surface).vectors for surface in (mesh, plain))
    np.testing.assert_array_equal(ours, others)
    lit = vizlight.illuminate(mesh, scene, feature_angle=30)
    assert (lit.n_verts, lit.n_lines) == (7, 20)
    np.testing.assert_array_equal(lit.cell_data["own"], mesh.cell_data["own"])
    corners = lit.points[lit.regular_faces]
    top = lit.regular_faces[(corners[..., 2] > corners[..., 2].max() - 1e-6).all(axis=1)]
    assert len(top) > 8
    assert np.ptp(lit["luminance"][top]) < 1e-6


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("step", [1, 3])
@pytest.mark.parametrize("make", [pv.Sphere, pv.Box])
def test_faces_that_a_mesh_has_again_do_not_count(make, step, turned):
    plain = make().triangulate().subdivide(1, "linear").clean()
    plain.clear_data()
    faces = plain.regular_faces
    more = faces[::step, ::-1] if turned else np.roll(faces[::step], 1, axis=1)
    mesh = pv.PolyData.from_regular_faces(plain.points, np.concatenate([more, faces]))
    mesh.cell_data["own"] = np.arange(mesh.n_cells)
    scene = far((1, 0.5, 2), (1, 1, 1))
    for angle in ("auto", 30):
        lit = vizlight.illuminate(mesh, scene, feature_angle=angle)
        expected = vizlight.illuminate(plain, scene, feature_angle=angle)
        assert lit.n_points == expected.n_points
        assert (lit.n_points > plain.n_points) == (make is pv.Box)
        np.testing.assert_array_equal(lit.cell_data["own"], np.arange(mesh.n_cells))
        at, own = lit.regular_faces, expected.regular_faces
        np.testing.assert_array_equal(lit.points[at], mesh.points[mesh.regular_faces])
        # A face of which there are two has the light that it has alone.
        light = np.sort(lit["luminance"][at], axis=1)
        alone = np.sort(expected["luminance"][own], axis=1)
        # The sums of the normals are in another order.
        np.testing.assert_allclose(light, np.concatenate([alone[::step], alone]), atol=1e-6)


def test_strips_are_split_with_their_cell_arrays():
    mesh = pv.Box().triangulate().subdivide(2, "linear").clean().strip()
    mesh.verts = [1, 0, 1, 5]
    mesh.cell_data["own"] = np.arange(mesh.n_cells)
    found = normals.split_edges(mesh, 30)
    assert found.n_points > mesh.n_points
    assert (found.n_verts, found.n_strips) == (2, 0)
    own = np.asarray(found.cell_data["own"])
    np.testing.assert_array_equal(own[:2], [0, 1])
    points = [set(map(tuple, mesh.get_cell(i).points)) for i in range(mesh.n_cells)]
    for i, corners in zip(own[2:], found.points[found.regular_faces], strict=True):
        assert set(map(tuple, corners)) <= points[i]


def test_an_angle_that_normals_make_idle_is_said_to_be():
    scene = far((1, 0.5, 2), (1, 1, 1))
    rounded = pv.Box().triangulate().clean()
    rounded.clear_data()
    rounded["N"] = rounded.points / np.linalg.norm(rounded.points, axis=1, keepdims=True)
    rounded.point_data.active_normals_name = "N"
    with pytest.warns(UserWarning, match="feature_angle has no effect on normals that the mesh"):
        vizlight.illuminate(rounded, scene, feature_angle=30)
    rounded.point_data.active_normals_name = None
    assert vizlight.illuminate(rounded, scene, feature_angle=30).n_points == 24
