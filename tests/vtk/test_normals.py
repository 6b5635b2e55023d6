"""Normals of a mesh: outward where it is closed, else toward the eye."""

import numpy as np
import pytest
import pyvista as pv
import scipy.ndimage
from vectors import unit

import vizlight
from vizlight import Light, Scene, View
from vizlight.mesh.normals import split_edges
from vizlight.vtk import normals, orientation


@pytest.mark.parametrize("winding", [1, -1])
def test_normals_of_open_pieces_turn_outward_and_to_the_eye(winding):
    cup = pv.Sphere(end_phi=150).triangulate()
    cup.clear_data()
    both = cup.merge(cup.translate((3, 0, 0), inplace=False), merge_points=False)
    mesh = pv.PolyData.from_regular_faces(both.points, both.regular_faces[:, ::winding])
    found = normals.computed_normals(mesh).vectors
    centre = np.where(np.asarray(mesh.points)[:, :1] > 1.5, [[3.0, 0, 0]], [[0.0, 0, 0]])
    assert np.einsum("ij,ij->i", found, mesh.points - centre).min() > 0.45
    sheet = pv.Plane(i_resolution=3, j_resolution=3)
    sheet.clear_data()
    for side in (1.0, -1.0):
        for view in (View(direction=(0, 0.1, side)), View(position=(0, 0, 5 * side))):
            up = normals.computed_normals(sheet, view=view).vectors[:, 2]
            np.testing.assert_allclose(up, side)


@pytest.mark.parametrize("axis", [(0, 0, 1), (-1, 0, 0), (0, 1, 0)])
@pytest.mark.parametrize("case", ["map", "triangles", "folded", "wound"])
@pytest.mark.parametrize("eye", [None, (1, 2, 3), (-1, -2, -3)])
def test_maps_have_the_normals_that_a_search_finds(axis, case, eye, monkeypatch):
    sheet = pv.Plane(direction=axis, i_resolution=4, j_resolution=3)
    sheet.clear_data()
    sheet = sheet if case == "map" else sheet.triangulate()
    if case == "folded":
        points = np.array(sheet.points)
        points[0] += 1.5 * (points[6] - points[0])
        sheet.points = points
    if case == "wound":
        faces = sheet.regular_faces
        faces[3] = faces[3, ::-1]
        sheet = pv.PolyData.from_regular_faces(sheet.points, faces)
    sheet.points = np.vstack([sheet.points, sheet.points[:1]])
    view = None if eye is None else View(direction=eye)
    quick = normals.computed_normals(sheet, view=view)
    is_map = orientation.normal_of_map(sheet) is not None
    assert is_map == (case in ("map", "triangles"))
    # Other points, as results are kept.
    monkeypatch.setattr(orientation, "normal_of_map", lambda _: None)
    larger = pv.PolyData(np.asarray(sheet.points) * 2, sheet.faces)
    searched = normals.computed_normals(larger, view=view)
    np.testing.assert_array_equal(quick.vectors, searched.vectors)
    np.testing.assert_array_equal(quick.lean, searched.lean)
    used = quick.vectors.any(axis=1)
    np.testing.assert_array_equal(np.asarray(quick.open)[used], np.asarray(searched.open)[used])
    assert quick.sharp == searched.sharp


def test_a_bowl_faces_the_eye_that_looks_into_it():
    bowl = pv.Sphere(end_phi=90, theta_resolution=40, phi_resolution=40)
    bowl.clear_data()
    for side in (1, -1):
        found = normals.computed_normals(bowl, view=View(direction=(0, 0.3, side))).vectors
        outward = np.einsum("ij,ij->i", found, np.asarray(bowl.points)) / 0.5
        assert (side * outward).min() > 0.9


def test_a_point_that_is_nowhere_has_no_say():
    x, y = np.meshgrid(np.arange(40.0), np.arange(30.0))
    z = 5 * np.exp(-((x - 20) ** 2 + (y - 15) ** 2) / 50)
    z[10, 10] = np.nan
    for side in (1, -1):
        found = normals.computed_normals(
            pv.StructuredGrid(x, y, z), view=View(direction=(0, 0, side))
        ).vectors
        known = np.isfinite(found).all(axis=1) & found.any(axis=1)
        assert known.sum() > 1150
        assert (side * found[known, 2]).min() > 0


@pytest.mark.parametrize("winding", [1, -1])
@pytest.mark.parametrize("eye", [(5, 0, 5), (-5, 0, 5), (0, 0, -9), (30, 1, 0)])
def test_what_is_nearly_closed_faces_outward_wherever_the_eye_is(winding, eye):
    slab = pv.Cube(x_length=4, y_length=1, z_length=0.2).triangulate().clean().subdivide(2)
    kept = slab.regular_faces[slab.cell_centers().points[:, 0] < 1.99]
    open_end = pv.PolyData.from_regular_faces(slab.points, kept[:, ::winding])
    assert open_end.n_open_edges > 0
    found = normals.computed_normals(open_end, view=View(position=eye)).vectors
    flat = np.all(np.abs(open_end.points[:, :2]) < (1.6, 0.4), axis=1)
    assert flat.sum() > 10
    assert (np.sign(open_end.points[flat, 2]) * found[flat, 2]).min() > 0.99


def test_separate_triangles_of_a_closed_surface_face_outward():
    soup = pv.Sphere().separate_cells().extract_surface(algorithm="geometry")
    soup.clear_data()
    found = normals.computed_normals(soup, view=View(direction=(0, 0, 1))).vectors
    assert np.einsum("ij,ij->i", found, np.asarray(soup.points)).min() > 0.4


def test_strips_and_loose_points_have_their_piece():
    strip = pv.Plane(i_resolution=4, j_resolution=4).triangulate().strip()
    strip.clear_data()
    found = normals.computed_normals(strip, view=View(direction=(0, 0, -1))).vectors
    np.testing.assert_allclose(found[:, 2], -1)
    loose = pv.PolyData.from_regular_faces(np.vstack([np.eye(3), [[9.0, 9, 9]]]), [[0, 1, 2]])
    found = normals.computed_normals(loose, view=View(direction=(1, 1, 1))).vectors
    np.testing.assert_allclose(found[:3], 3**-0.5, rtol=1e-6)
    np.testing.assert_array_equal(found[3], 0)


def test_faces_without_area_have_no_sharp_edges():
    """Meshes of a globe often have such faces at the poles."""
    ball = pv.Sphere(theta_resolution=60, phi_resolution=40)
    pole = int(np.argmax(ball.points[:, 2]))
    faces = ball.regular_faces
    around = faces[(faces == pole).any(axis=1)]
    points = np.concatenate([ball.points, np.repeat(ball.points[[pole]], len(around), axis=0)])
    points[ball.n_points :, 0] += 1e-9 * np.arange(len(around))
    extra = ball.n_points + np.arange(len(around))
    beside = around[np.arange(len(around)), (around != pole).argmax(axis=1)]
    doubled = np.column_stack([np.full(len(around), pole), extra, beside])
    mesh = pv.PolyData.from_regular_faces(points, np.concatenate([faces, doubled]))
    assert normals.computed_normals(mesh).sharp == 0
    assert split_edges(mesh, "auto") is mesh
    assert normals.computed_normals(pv.Cube().triangulate().clean()).sharp > 0.5


@pytest.mark.filterwarnings("ignore:.* of the edges are sharper")
@pytest.mark.parametrize("joined", [False, True])
@pytest.mark.parametrize("make", [pv.ParametricBoy, pv.ParametricKlein, pv.ParametricRoman])
def test_closed_surfaces_with_one_side_face_the_eye(make, joined):
    """No side of such a surface is the outer one, along seams of coincident points too."""
    mesh = make(u_res=60, v_res=60, w_res=10)
    mesh = mesh.clean() if joined else mesh
    mesh.point_data.clear()
    scene = vizlight.Scene(view=vizlight.View(direction=(1, 1, 1)))
    found = vizlight.illuminate(mesh, scene)["luminance"]
    toward_eye = vizlight.illuminate(mesh, scene, facing="eye")["luminance"]
    assert np.mean(np.abs(found - toward_eye) > 0.01) < 0.03


@pytest.mark.parametrize("cut", [False, True])
def test_a_strip_with_one_side_has_its_normals_at_the_seam(cut, random):
    """The faces of a Möbius strip cannot all be wound alike, and cancel where they are not."""
    count, rows = 60, 7
    u, v = np.meshgrid(2 * np.pi * np.arange(count) / count, np.linspace(-0.4, 0.4, rows))
    radius, along = 1 + v * np.cos(u / 2), np.arange(count * rows).reshape(rows, count)
    points = np.stack([radius * np.cos(u), radius * np.sin(u), v * np.sin(u / 2)], axis=-1)
    radial = np.stack([np.cos(u), np.sin(u), 0 * u], axis=-1)
    across = np.cos(u / 2)[..., np.newaxis] * radial
    across[..., 2] = np.sin(u / 2)
    turn = -v[..., np.newaxis] / 2 * np.sin(u / 2)[..., np.newaxis] * radial
    turn += radius[..., np.newaxis] * np.stack([-np.sin(u), np.cos(u), 0 * u], axis=-1)
    turn[..., 2] = v / 2 * np.cos(u / 2)
    exact = unit(np.cross(turn, across).reshape(-1, 3))
    wide = np.concatenate([along, along[::-1, :1]], axis=1)
    corners = [wide[:-1, :-1], wide[:-1, 1:], wide[1:, 1:], wide[1:, :-1]]
    faces = random.permutation(np.stack(corners, axis=-1).reshape(-1, 4))
    mesh = pv.PolyData.from_regular_faces(points.reshape(-1, 3), faces)
    found = normals.computed_normals(mesh.triangulate() if cut else mesh)
    assert np.abs(np.einsum("ij,ij->i", found.vectors, exact)).min() > np.cos(np.radians(8))
    assert np.all(found.open == 1)


def test_a_closed_surface_wound_at_random_has_an_outer_side():
    ball = pv.Sphere(theta_resolution=20, phi_resolution=20)
    ball.point_data.clear()
    every_other = np.arange(ball.n_cells)[:, np.newaxis] % 2 == 0
    faces = ball.regular_faces
    ball.regular_faces = np.where(every_other, faces, faces[:, ::-1])
    assert not normals.computed_normals(ball).any_open


@pytest.mark.parametrize("kind", ["grid", "surface"])
def test_the_rim_of_a_hole_has_normals(kind):
    """A corner that is missing takes its faces away, not the normals of its neighbours."""
    x, y = np.meshgrid(np.linspace(-1, 1, 30), np.linspace(-1, 1, 30), indexing="ij")
    z = 0.3 * x - 0.2 * y
    z[10:14, 12:20] = np.nan
    mesh = pv.StructuredGrid(x, y, z)
    if kind == "surface":
        quads = mesh.cast_to_unstructured_grid().cells
        mesh = pv.PolyData(np.asarray(mesh.points), quads)
    found = normals.computed_normals(mesh, view=View(direction=(0, 0, 1)))
    known = np.isfinite(mesh.points).all(axis=1)
    up = np.array([-0.3, 0.2, 1]) / np.linalg.norm([0.3, 0.2, 1])
    np.testing.assert_allclose(found.vectors[known], np.tile(up, (known.sum(), 1)), atol=1e-6)
    assert not found.vectors[~known].any()
    assert found.any_open


def rough_field(turn=0.0):
    """Return a rough height field, turned about x by degrees, and normals of its upper side."""
    random = np.random.default_rng(3)
    x = np.linspace(0, 10, 60)
    z = sum(
        scale * scale * scipy.ndimage.gaussian_filter(random.standard_normal((60, 60)), scale)
        for scale in (6, 3, 1)
    )
    field = pv.StructuredGrid(*np.meshgrid(x, x), 0.7 * z).extract_surface(
        algorithm="dataset_surface"
    )
    field = pv.PolyData(field.points, field.faces).triangulate()
    up = np.array(field.compute_normals(cell_normals=False)["Normals"])
    field.points = field.points.astype(np.float64)
    up *= np.sign(up[:, 2:])
    return field.rotate_x(turn), pv.PolyData(up).rotate_x(turn).points


@pytest.mark.parametrize("turn", [0, 50])
@pytest.mark.parametrize("below", [False, True])
@pytest.mark.parametrize("near", [False, True])
@pytest.mark.parametrize("given", [False, True])
def test_faces_of_a_height_field_are_lit_on_the_side_from_which_they_are_seen(
    turn, below, near, given
):
    field, up = rough_field(turn)
    toward = pv.PolyData(np.array([[0.6, 1.0, -0.5 if below else 0.5]])).rotate_x(turn).points[0]
    eye = np.array(field.center) + 12 * toward
    view = View(position=eye) if near else View(direction=toward)
    field["up"] = up
    sided = normals.sided_normals(field, "up" if given else None, 3, "auto")
    assert np.all(np.asarray(sided.open) == 2)
    shown = sided.facing("auto", field.points, view)[:]
    side = -1 if below else 1
    corners = field.regular_faces
    a, b, c = (field.points[row] for row in corners.T)
    across = np.cross(b - a, c - a)
    across *= np.sign(np.einsum("ij,ij->i", across, up[corners[:, 0]]))[:, np.newaxis] * side
    seen = np.einsum("ij,ij->i", across, eye - a if near else np.broadcast_to(toward, a.shape)) > 0
    agree = np.einsum("ij,ij->i", shown, up) * side > 0
    assert agree[corners[seen]].all()
    # What is seen of the other side, below a border, is still lit on that.
    assert not agree[corners[~seen]].all()


def test_a_bowl_is_lit_inside_and_outside_as_it_is_seen():
    bowl = pv.Sphere(start_phi=110, theta_resolution=60, phi_resolution=60)
    bowl = pv.PolyData(bowl.points, bowl.faces)
    view = View(direction=(1, 0, 0.35))
    found = normals.computed_normals(bowl)
    shown = found.facing("auto", bowl.points, view)[:]
    cosine = shown @ np.asarray(view.direction)
    assert cosine.min() > -0.07
    outside = np.einsum("ij,ij->i", shown, bowl.points) > 0
    assert 0.2 < outside.mean() < 0.8


def test_each_height_field_of_a_mesh_shows_its_own_side():
    low, _ = rough_field()
    high = low.translate((0, 0, 20))
    both = pv.merge([low, high], merge_points=False)
    sided = normals.computed_normals(both)
    assert set(np.unique(sided.open)) == {2, 3}
    view = View(position=np.add(low.center, (0, 0, 10)))
    averted = sided.averted_fields(both.points, view)
    up = sided.vectors[:, 2] > 0
    below = averted[sided.open] == up
    np.testing.assert_array_equal(below, np.arange(both.n_points) >= low.n_points)


def test_a_sheet_that_folds_back_is_no_height_field():
    tube = pv.Cylinder(capping=False, resolution=40).triangulate()
    assert np.all(normals.computed_normals(tube).open == 1)


def test_each_connected_piece_has_a_number():
    both = pv.Sphere() + pv.Sphere(center=(3, 0, 0))
    numbers = normals.piece_numbers(both)
    left = np.asarray(both.points)[:, 0] < 1.5
    assert len(np.unique(numbers[left])) == len(np.unique(numbers[~left])) == 1
    assert len(np.unique(numbers)) == 2


def test_given_normals_of_a_surface_without_an_outer_side_face_the_eye(random):
    """Boy's surface as PyVista makes it; a ball keeps its side, however its faces are wound."""
    scene = Scene(lights=Light.headlight(), view=View(direction=(1, 1, 1)))
    boy = pv.ParametricBoy()
    assert boy.point_data.active_normals_name == "Normals"
    lit = vizlight.illuminate(boy, scene)["luminance"]
    bare = vizlight.illuminate(pv.PolyData(boy.points, boy.faces), scene)["luminance"]
    assert np.mean(np.abs(lit - bare) < 0.1) > 0.95
    assert np.mean(lit <= scene.material.ambient) < 0.01
    ball = pv.Sphere()
    expected = vizlight.illuminate(ball, scene)["luminance"]
    faces = [face[:: random.choice([-1, 1])] for face in ball.regular_faces]
    mixed = pv.PolyData.from_regular_faces(ball.points, faces)
    mixed.point_data.active_normals = ball.point_normals
    both = vizlight.illuminate(pv.MultiBlock([mixed, boy]), scene)
    np.testing.assert_allclose(both[0]["luminance"], expected, atol=1e-6)
    np.testing.assert_array_equal(both[1]["luminance"], lit)


@pytest.mark.parametrize("gap", [0.0, np.nan, np.inf])
@pytest.mark.parametrize("side", [1, -1])
def test_normals_of_a_file_that_have_gaps_are_filled_by_those_of_the_faces(gap, side):
    ball = pv.Sphere(theta_resolution=20, phi_resolution=20)
    outward = unit(np.asarray(ball.points, dtype=float))
    ball.clear_data()
    rows = (side * outward).astype(np.float32)
    rows[::7] = gap
    ball.point_data["Normals"] = rows
    ball.point_data.active_normals_name = "Normals"
    found = normals.given_normals(ball, None, 3)
    np.testing.assert_array_equal(found[1:7], rows[1:7])
    assert np.einsum("ij,ij->i", found, side * outward).min() > 0.99
    ball.point_data["Normals"][:] = gap
    assert normals.given_normals(ball, None, 3) is None


def test_normals_of_a_scan_that_are_all_zero_are_estimated(tmp_path):
    points = np.random.default_rng(0).random((300, 3)) * [1, 1, 0]
    scan = pv.PolyData(points)
    scan.point_data["Normals"] = np.zeros_like(points)
    scan.point_data.active_normals_name = "Normals"
    scan.save(tmp_path / "scan.ply")
    scene = Scene(lights=Light(direction=(0, 0, 1)), view=View(direction=(0, 0, 1)))
    assert vizlight.illuminate(scan, scene)["luminance"].min() > 0.99
    scan.save(tmp_path / "scan.vtp")
    assert "Normals" not in vizlight.read(tmp_path / "scan.vtp").point_data


def test_points_of_hidden_cells_are_no_fault():
    x, y = np.meshgrid(np.linspace(-1, 1, 11), np.linspace(-1, 1, 11))
    grid = pv.StructuredGrid(x, y, 0 * x).hide_cells(range(30))
    lit = grid.vizlight.illuminate()
    assert np.count_nonzero(~lit["luminance_valid"].astype(bool)) == 33


@pytest.mark.parametrize("length", [1.0, 7.0])
def test_lean_is_the_sine_of_the_largest_angle_with_a_face(length):
    mesh = pv.Sphere(theta_resolution=9, phi_resolution=7)
    vectors = unit(np.asarray(mesh.points) + 0.1)
    # Sides of normals, and the order of corners of all faces, do not count.
    sides = np.where(np.arange(len(vectors)) % 2, length, -length)[:, np.newaxis]
    expected = np.zeros(len(vectors))
    for face, across in zip(mesh.regular_faces, mesh.compute_normals().cell_normals, strict=True):
        sine = np.linalg.norm(np.cross(vectors[face], across), axis=1)
        np.maximum.at(expected, face, sine)
    for order in (1, -1):
        surface = pv.PolyData.from_regular_faces(mesh.points, mesh.regular_faces[:, ::order])
        np.testing.assert_allclose(
            orientation.lean_of(surface, vectors * sides), expected, atol=1e-5
        )
    vectors[3] = np.nan
    assert orientation.lean_of(mesh, vectors)[3] == 0


def test_normals_of_faces_are_told_from_others():
    ball, cube = pv.Sphere(), pv.Cube().triangulate().clean()
    assert normals.are_of_faces(ball, np.asarray(ball.points))
    assert not normals.are_of_faces(ball, np.roll(ball.points, 1, axis=1))
    # Means over the corners of a cube are normals of none of its sides.
    assert not normals.are_of_faces(cube, np.asarray(cube.points))
