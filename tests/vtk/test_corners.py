"""Normals by the corners of faces: exact where they are known, and closer than VTK's."""

import numpy as np
import pytest
import pyvista as pv
from scipy.spatial import cKDTree

import vizlight
from vizlight.mesh.normals import split_edges
from vizlight.vtk import corners
from vizlight.vtk.corners import corner_normals, surface_normals
from vizlight.vtk.normals import computed_normals


def off(found, exact):
    """Return the angles in degrees between normals, whatever their sides."""
    exact = exact / np.linalg.norm(exact, axis=1, keepdims=True)
    sine = np.linalg.norm(np.cross(found, exact), axis=1)
    return np.degrees(np.arctan2(sine, np.abs(np.einsum("ij,ij->i", found, exact))))


def by_vtk(surface):
    bare = pv.PolyData(surface.points, surface.faces)
    made = bare.compute_normals(cell_normals=False, split_vertices=False, consistent_normals=False)
    return made.point_data["Normals"]


def volume(n, function):
    grid = pv.ImageData(dimensions=(n, n, n), spacing=3 * (4 / (n - 1),), origin=(-2, -2, -2))
    grid["f"] = function(*grid.points.T)
    return grid.contour([0.0], scalars="f", compute_normals=False)


def ellipsoid(x, y, z):
    return x * x + y * y + 0.5 * z * z - 1.5


def gyroid(x, y, z):
    return sum(np.sin(3 * a) * np.cos(3 * b) for a, b in ((x, y), (y, z), (z, x)))


def gradient(function, points, step=1e-5):
    p = np.asarray(points, dtype=float)
    ends = [[p + s * step * np.eye(3)[i] for s in (1, -1)] for i in range(3)]
    return np.stack([function(*a.T) - function(*b.T) for a, b in ends], axis=1)


@pytest.mark.parametrize("function", [ellipsoid, gyroid])
@pytest.mark.parametrize("n", [20, 41, 60])
def test_isosurfaces_have_better_normals_than_those_of_vtk(function, n):
    surface = volume(n, function)
    exact = gradient(function, surface.points)
    own, other = (off(each, exact) for each in (surface_normals(surface), by_vtk(surface)))
    assert own.mean() < 0.75 * other.mean()
    assert np.percentile(own, 99) < 1.05 * np.percentile(other, 99)


def test_a_warped_grid_has_better_normals_than_those_of_vtk():
    x, y = np.meshgrid(np.linspace(0, 3, 50), np.linspace(0, 3, 50))
    field = pv.StructuredGrid(x, y, 0.5 * np.sin(2 * x) * np.cos(3 * y))
    surface = field.extract_surface(algorithm="dataset_surface")
    x, y, _ = np.asarray(surface.points, dtype=float).T
    slopes = -np.cos(2 * x) * np.cos(3 * y), 1.5 * np.sin(2 * x) * np.sin(3 * y), 1 + 0 * x
    exact = np.stack(slopes, axis=1)
    own, other = (off(each, exact) for each in (surface_normals(surface), by_vtk(surface)))
    assert own.mean() < 0.7 * other.mean()


@pytest.mark.parametrize("scale", [1e-150, 1e-30, 1.0, 1e30, 1e150])
def test_the_corners_of_a_box_do_not_depend_on_how_it_is_cut(scale, random):
    """VTK's depend on it: a corner in two triangles of a side counts twice."""
    box = pv.Box((-1, 1, -1, 1, -1, 1)).clean()
    points = np.asarray(box.points, dtype=float) * scale
    quads = box.regular_faces
    whole = corner_normals(points, [quads])
    for _ in range(4):
        turned = np.stack([np.roll(quad, random.integers(4)) for quad in quads])
        halves = np.concatenate([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]])
        cut = corner_normals(points, [halves])
        assert off(cut, points).max() < 4
    assert whole.any(axis=1).all()
    assert off(whole, points).max() < 1e-4


def test_a_plane_has_one_normal_however_it_is_cut(random):
    """Also beside slivers, where corners lie on one line, and at inner corners of polygons."""
    square = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    points = np.concatenate([square, random.uniform(0, 1, (300, 2)), [[0.5, 0], [0.5, 1e-9]]])
    flat = pv.PolyData(np.column_stack([points, 0 * points[:, 0]])).delaunay_2d()
    letter = np.array([[0.0, 0], [3, 0], [3, 1], [2, 1], [1, 1], [1, 3], [0, 3]])
    outline = corner_normals(np.column_stack([letter, 0 * letter[:, 0]]), [np.arange(7)[None]])
    for found in (surface_normals(flat)[np.unique(flat.regular_faces)], outline):
        np.testing.assert_array_equal(found, np.tile([0, 0, 1], (len(found), 1)))


def test_faces_in_any_order_and_number_have_the_same_normals(monkeypatch, random):
    surface = volume(20, gyroid)
    faces = surface.regular_faces
    whole = corner_normals(surface.points, [faces])
    monkeypatch.setattr(corners, "BLOCK", 50)
    for order in (slice(None), random.permutation(len(faces))):
        found = corner_normals(surface.points, [faces[order]])
        np.testing.assert_allclose(found, whole, atol=2e-7)


def test_polygons_and_strips_are_read():
    ball = pv.Sphere(theta_resolution=20, phi_resolution=20)
    strips = surface_normals(ball.strip())
    np.testing.assert_allclose(strips, surface_normals(ball), atol=1e-6)
    mixed = pv.PolyData(ball.points, faces=[*ball.faces, 5, 0, 2, 3, 4, 5])
    assert np.isfinite(surface_normals(mixed)).all()


@pytest.mark.filterwarnings("error")
def test_faces_without_area_and_points_without_faces_have_none():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 0, 0], [5, 5, 5]])
    faces = np.array([[0, 1, 2], [2, 3, 2], [0, 0, 1]])
    assert not corner_normals(points, [faces]).any()
    assert not corner_normals(1e200 * points, [faces]).any()
    assert corner_normals(np.zeros((0, 3)), []).shape == (0, 3)


def ball(dtype, *, image=True, n=21, level=49):
    """Return an isosurface through nodes of a grid, which stands there up to three times."""
    half = (n - 1) // 2
    grid = pv.ImageData(dimensions=(n, n, n), origin=3 * (-half,))
    grid["f"] = np.sum(np.asarray(grid.points) ** 2, axis=1).astype(dtype)
    grid = grid if image else grid.cast_to_unstructured_grid()
    method = "flying_edges" if image else "contour"
    surface = grid.contour([level], scalars="f", compute_normals=False, method=method)
    surface.clear_data()
    return surface


def spread(points, values):
    """Return how many points stand at a place again, and how far values at one place differ."""
    places, number = np.unique(points, axis=0, return_inverse=True)
    low, high = np.full((2, len(places)), np.inf)
    np.minimum.at(low, number.ravel(), values)
    np.minimum.at(high, number.ravel(), -values)
    return len(points) - len(places), (-high - low).max()


@pytest.mark.parametrize("image", [True, False])
@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_an_isosurface_through_nodes_has_one_light_at_a_place(dtype, image):
    surface = ball(dtype, image=image)
    lit = vizlight.illuminate(surface)
    again, difference = spread(np.asarray(lit.points), np.asarray(lit["luminance"]))
    assert again > 50
    assert difference < 1e-6


@pytest.mark.parametrize("image", [True, False])
@pytest.mark.parametrize("ulps", [1, 4, 100])
def test_points_that_lie_apart_by_rounding_have_one_light(ulps, image):
    """Rounding of the field moves the points off the node, each along its own edge."""
    worst = 0.0
    for seed in range(6):
        random = np.random.default_rng(seed)
        n, level = ((41, 144), (21, 49))[seed % 2]
        grid = pv.ImageData(dimensions=(n, n, n), origin=3 * (-(n // 2),))
        values = np.sum(np.asarray(grid.points) ** 2, axis=1).astype("f4")
        grid["f"] = values + ulps * np.spacing(values) * random.integers(-1, 2, len(values)).astype(
            "f4"
        )
        grid = grid if image else grid.cast_to_unstructured_grid()
        method = "flying_edges" if image else "contour"
        surface = grid.contour([level], scalars="f", compute_normals=False, method=method)
        surface.clear_data()
        lit = np.asarray(vizlight.illuminate(surface)["luminance"])
        near = cKDTree(surface.points).query_pairs(1e-3, output_type="ndarray")
        assert len(near) > 50
        worst = max(worst, np.abs(lit[near[:, 0]] - lit[near[:, 1]]).max())
    assert worst < 1e-3


def test_points_along_a_row_of_slivers_keep_their_own_normals():
    """Facets of a fan are as thin as slivers, but the points of the row are not at one place."""
    angle = np.linspace(0, 0.5, 2001)
    rim = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    points = np.concatenate([rim, np.add(rim, (0, 0, 1.0))])
    i = np.arange(2000)
    lower = np.stack([i, i + 1, i + 2001], axis=1)
    faces = np.concatenate([lower, np.stack([i + 1, i + 2002, i + 2001], axis=1)])
    fan = pv.PolyData.from_regular_faces(points, faces)
    assert (
        corners.joined(fan.points, corners.all_slivers(fan.points, fan.regular_faces)) is not None
    )
    found = computed_normals(fan).vectors[:2001]
    assert np.einsum("ij,ij->i", np.abs(found), np.abs(rim)).min() > 1 - 1e-6


def test_normals_are_those_of_the_clean_surface():
    surface = ball("f8")
    clean = surface.clean()
    assert clean.n_points < surface.n_points
    row = cKDTree(clean.points).query(surface.points)[1]
    found, expected = computed_normals(surface), computed_normals(clean)
    np.testing.assert_allclose(found.vectors, expected.vectors[row], atol=2e-3)
    assert not found.any_open


def test_an_open_isosurface_shows_one_side_at_a_place():
    whole = ball("f4")
    faces = whole.regular_faces
    bowl = pv.PolyData.from_regular_faces(
        whole.points, faces[whole.points[faces][..., 2].min(axis=1) >= 0]
    ).remove_unused_points()
    lit = vizlight.illuminate(bowl, vizlight.Scene(view=vizlight.View(direction=(1, 0.2, 0.1))))
    again, difference = spread(np.asarray(lit.points), np.asarray(lit["luminance"]))
    assert again > 20
    assert difference < 1e-6


def test_several_meshes_at_one_place_keep_their_own():
    lit = vizlight.illuminate(pv.MultiBlock([ball("f4"), ball("f4", level=81)]))
    alone = vizlight.illuminate(ball("f4", level=81))
    np.testing.assert_allclose(lit[1]["luminance"], alone["luminance"], atol=1e-6)


def test_separate_triangles_and_split_edges_stay_apart():
    sphere = pv.Sphere()
    corners = sphere.points[sphere.regular_faces].reshape(-1, 3)
    soup = pv.PolyData.from_regular_faces(corners, np.arange(len(corners)).reshape(-1, 3))
    found = computed_normals(soup).vectors
    np.testing.assert_allclose(np.abs(found[::3]), np.abs(soup.face_normals), atol=1e-5)
    cube = split_edges(pv.Cube().triangulate().clean(), 30)
    cube.clear_data()
    found = computed_normals(cube).vectors
    np.testing.assert_allclose(np.sort(np.abs(found), axis=1), [[0, 0, 1]] * 24, atol=1e-6)


def test_the_tip_of_a_cone_keeps_the_normals_of_its_sides():
    """Triangles without area join its points too, but no normal would fit all of them."""
    angle, height = np.meshgrid(np.linspace(0, 2 * np.pi, 25), [0.0, 0.5, 1.0])
    x, y = height * np.cos(angle), height * np.sin(angle)
    x[0] = y[0] = 0
    cone = pv.StructuredGrid(x, y, height).extract_surface(algorithm="geometry").triangulate()
    cone.clear_data()
    tip = ~np.any(cone.points, axis=1)
    assert tip.sum() == 25
    found = computed_normals(cone).vectors[tip]
    lit = np.any(found, axis=1)
    assert lit.sum() >= 24
    np.testing.assert_allclose(np.abs(found[lit, 2]), 0.5**0.5, atol=0.05)


@pytest.mark.parametrize("turn", range(4))
def test_a_point_that_a_face_names_twice_is_one_corner(turn):
    points = np.array([[0, 0, 0], [2, 0, 0], [0, 1, 0.5], [1, -1, 2]], dtype=np.float64)
    whole = np.array([[0, 1, 2], [0, 3, 1]])
    twice = np.roll([[0, 1, 1, 2], [0, 3, 3, 1]], turn, axis=1)
    found = corners.corner_normals(points, [twice])
    np.testing.assert_allclose(found, corners.corner_normals(points, [whole]), atol=1e-6)


def test_corners_at_one_place_have_the_normal_of_their_face():
    """As at the poles of a grid of degrees, whose quads are triangles there."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 0, 0], [2, 2, 0], [0, 2, 0]])
    faces = [np.array([[0, 1, 2, 4]]), np.array([[1, 3, 3, 4]]), np.array([[0, 1, 2, 3, 4]])]
    for face in faces:
        found = corner_normals(points, [face])
        np.testing.assert_allclose(found[face[0]], np.tile([0.0, 0, 1], (face.size, 1)), atol=1e-7)


def of_quads(points, quads):
    """Return normals by the corners of quads, one by one."""
    total = np.zeros((len(points), 3))
    for quad in quads:
        a, b, c, d = points[quad]
        face = np.cross(c - a, d - b) / 2
        longest = max(np.linalg.norm(side) for side in (b - a, c - b, d - c, a - d))
        for i, to in enumerate((c, d, a, b)):
            at, ahead, behind = (points[quad[(i + step) % 4]] for step in (0, 1, -1))
            short = max(0, 1 - np.sum((to - at) ** 2) / longest**2)
            normal = (1 - short) * np.cross(ahead - at, behind - at) + short * face
            near = np.linalg.norm(ahead - at) * np.linalg.norm(behind - at)
            total[quad[i]] += normal / near**1.5
    return total / np.linalg.norm(total, axis=1, keepdims=True)


@pytest.mark.parametrize("scale", [1e-150, 1.0, 1e150])
def test_quads_have_normals_of_their_formula(scale, random):
    x, y = np.meshgrid(np.arange(6.0), np.arange(6.0))
    first = np.arange(36).reshape(6, 6)[:-1, :-1].ravel()
    quads = first[:, np.newaxis] + [0, 1, 7, 6]
    points = np.stack([x + np.sin(y) * y, y, 0.05 * x * y], axis=-1).reshape(-1, 3)
    points += random.uniform(-0.1, 0.1, points.shape)
    found = corner_normals(scale * points, [quads])
    np.testing.assert_allclose(found, of_quads(points, quads), atol=1e-6)


def test_a_smooth_lattice_has_normals_of_second_order():
    """However its quads are sheared: with twice as many nodes each way a fourth of the error."""
    errors = []
    for n in (20, 40):
        u, v = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
        x, y = u + 1.5 * v + 0.2 * np.sin(3 * u * v), v + 0.2 * u * u
        points = np.stack([x, y, np.sin(x) * np.cos(2 * y)], axis=-1).reshape(-1, 3)
        slopes = np.cos(x) * np.cos(2 * y), -2 * np.sin(x) * np.sin(2 * y)
        exact = np.stack([*slopes, 0 * x - 1], axis=-1).reshape(-1, 3)
        first = np.arange(n * n).reshape(n, n)[:-1, :-1].ravel()
        found = corner_normals(points, [first[:, np.newaxis] + [0, 1, n + 1, n]])
        errors.append(off(found, exact).reshape(n, n)[1:-1, 1:-1].mean())
    assert errors[1] < 0.3 * errors[0]


def test_quads_with_dents_and_straight_corners_have_normals_at_all_four():
    points = np.array([[2.0, 0], [2.5, 4], [2, 3], [1.5, 4], [3, 0], [3, 1], [3, 2], [2, 1]])
    points = np.column_stack([points, 0 * points[:, 0]])
    for quad in ([0, 1, 2, 3], [0, 4, 5, 6], [0, 4, 7, 7]):
        for turn in range(4):
            found = corner_normals(points, [np.roll([quad], turn, axis=1)])
            np.testing.assert_allclose(found[quad], np.tile([0.0, 0, 1], (4, 1)), atol=1e-7)


def test_faces_that_have_a_point_twice_are_split_at_points_that_are_there():
    """Also where a face is there again, of hexahedra whose corners coincide."""
    generator = np.random.default_rng(3)
    for _ in range(200):
        points = generator.random((6, 3)) * [1, 1, 0]
        quads = generator.integers(0, 6, size=(5, 4))
        quads[0] = quads[4]
        ends = np.arange(0, 24, 4)
        twins = np.unique(np.sort(quads), axis=0, return_index=True, return_inverse=True)
        found, origin, _ = corners.split_faces(
            points, quads.ravel(), ends, 30, twins[1][twins[2].reshape(-1)]
        )
        assert found.max() < len(origin)
        np.testing.assert_array_equal(origin[found], quads.ravel())
