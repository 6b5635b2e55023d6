"""Lengths inside closed meshes against closed forms, with VTK's tree and with Embree's."""

import importlib.util

import numpy as np
import pytest
import pyvista as pv

from vizlight.geometry.solids import parallel_rays
from vizlight.mesh import closed_meshes

EMBREE = importlib.util.find_spec("embreex") is not None


@pytest.fixture(
    params=[
        "projected",
        "vtk",
        pytest.param("embree", marks=pytest.mark.skipif(not EMBREE, reason="pip install embreex")),
    ]
)
def make(request, monkeypatch):
    """A function that makes solids, whose hits are found in one of the ways."""
    if request.param != "projected":
        monkeypatch.setattr(parallel_rays, "hits", lambda *_: None)
    if request.param == "vtk":
        monkeypatch.setattr(closed_meshes, "embree_tree", lambda _: None)

    def of(mesh):
        body = closed_meshes.closed(mesh)
        return closed_meshes.Body(*body)

    return of


def rays(start, way):
    start = np.atleast_2d(np.asarray(start, dtype=float))
    way = np.asarray(way, dtype=float) / np.linalg.norm(way)
    return start, np.repeat(way[None], len(start), 0), np.full(len(start), np.inf)


def cube(lows=(0, 0, 0), highs=(1, 1, 1), level=1):
    sides = [(lows[0], highs[0], lows[1], highs[1], lows[2], highs[2])]
    return pv.Box(*sides, level=level).triangulate().clean()


def box_length(start, way, low, high):
    with np.errstate(divide="ignore"):
        one, two = (low - start) / way, (high - start) / way
    near, far = np.minimum(one, two).max(axis=1), np.maximum(one, two).min(axis=1)
    return np.maximum(far - np.maximum(near, 0), 0)


def test_cube_from_inside_and_outside(make, random):
    start, way, reach = rays(random.uniform(-1, 2, (400, 3)), (0.3, 0.5, 0.8))
    found = closed_meshes.inside_length([make(cube())], start, way, reach)
    np.testing.assert_allclose(found, box_length(start, way, 0.0, 1.0), atol=1e-9)


def test_hits_on_shared_edges_and_corners_count_once(make):
    """Along diagonals of faces, edges of triangles and through corners of the cube."""
    body = make(cube(level=3))
    grid = np.stack(np.meshgrid(*[np.linspace(0.25, 0.75, 3)] * 3), axis=-1).reshape(-1, 3)
    for way in ((0, 0, 1), (1, 0, 0), (1, 1, 0), (1, 1, 1), (-1, 1, 1)):
        start, unit, reach = rays(grid, way)
        found = closed_meshes.inside_length([body], start, unit, reach)
        np.testing.assert_allclose(found, box_length(start, unit + 1e-300, 0.0, 1.0), atol=1e-9)


def test_union_of_overlapping_and_apart(make):
    """What two solids share counts once; what is apart is added."""
    bodies = [
        make(cube()),
        make(cube((0, 0, 0.5), (1, 1, 2))),
        make(cube((0, 0, 3), (1, 1, 3.5))),
    ]
    found = closed_meshes.inside_length(bodies, *rays((0.4, 0.3, 0.2), (0, 0, 1)))
    assert found[0] == pytest.approx(1.8 + 0.5, abs=1e-9)
    near = closed_meshes.inside_length(
        bodies, np.array([[0.4, 0.3, 0.2]]), np.array([[0.0, 0, 1]]), np.array([2.5])
    )
    assert near[0] == pytest.approx(1.8, abs=1e-9)


def test_cavity_is_outside(make):
    """A shell: the inner sphere turned inward is no solid; so is one turned as it came."""
    outer = pv.Sphere(radius=1, theta_resolution=40, phi_resolution=40)
    inner = pv.Sphere(radius=0.5, theta_resolution=40, phi_resolution=40)
    inner = inner.flip_faces()
    body = make(pv.merge([outer, inner], merge_points=False))
    found = closed_meshes.inside_length([body], *rays((0.01, 0.02, -0.75), (0, 0, 1)))
    assert found[0] == pytest.approx(0.25 + 0.5, abs=5e-3)


def test_faces_flipped_at_random_are_oriented_consistently(make, random):
    mesh = pv.Sphere(theta_resolution=30, phi_resolution=30)
    faces = mesh.regular_faces.copy()
    turned = random.random(len(faces)) < 0.4
    faces[turned] = faces[turned][:, ::-1]
    body = make(pv.PolyData.from_regular_faces(mesh.points, faces))
    good = make(mesh)
    start, way, reach = rays(random.uniform(-0.3, 0.3, (50, 3)), (1, 2, 3))
    np.testing.assert_allclose(
        closed_meshes.inside_length([body], start, way, reach),
        closed_meshes.inside_length([good], start, way, reach),
        atol=1e-9,
    )


def test_inside_or_not(make):
    body = make(cube())
    assert closed_meshes.is_inside(body, np.array([0.5, 0.2, 0.9]))
    assert not closed_meshes.is_inside(body, np.array([0.5, 0.2, 1.1]))
    assert not closed_meshes.is_inside(body, np.array([5.0, 5.0, 5.0]))


def test_shell_of_a_plane_is_a_box():
    plane = pv.Plane(i_resolution=4, j_resolution=3).triangulate()
    normals = np.tile([0.0, 0, 1], (plane.n_points, 1))
    body = closed_meshes.Body(*closed_meshes.shell(plane, 0.2, normals))
    start, way, reach = rays([[0.1, 0.2, 1]], (0.3, 0.1, -1))
    found = closed_meshes.inside_length([body], start, way, reach)
    assert found[0] == pytest.approx(0.2 * np.sqrt(1.1), abs=1e-9)


def test_seams_of_equal_points_are_closed():
    cube = pv.Cube().triangulate()
    soup = np.asarray(cube.points)[cube.regular_faces].reshape(-1, 3)
    mesh = pv.PolyData.from_regular_faces(soup, np.arange(36).reshape(-1, 3))
    vertices, triangles = closed_meshes.closed(mesh)
    assert (len(vertices), len(triangles)) == (8, 12)


def test_a_face_that_stands_twice_counts_once():
    cube = pv.Cube().triangulate().clean()
    faces = np.concatenate([cube.regular_faces, cube.regular_faces[:2, ::-1]])
    _, triangles = closed_meshes.closed(pv.PolyData.from_regular_faces(cube.points, faces))
    assert len(triangles) == 12


def test_open_surface_says_how_to_repair():
    mesh = pv.Sphere(end_phi=90)
    words = (
        r"mesh: expected a closed surface, got one with \d+ open edges; .*fill_holes.*thickness="
    )
    with pytest.raises(ValueError, match=words):
        closed_meshes.closed(mesh)


def test_shell_of_inconsistently_oriented_faces_is_refused():
    plane = pv.Plane(i_resolution=4, j_resolution=3).triangulate()
    faces = plane.regular_faces.copy()
    faces[5] = faces[5][::-1]
    mixed = pv.PolyData.from_regular_faces(plane.points, faces)
    normals = np.tile([0.0, 0, 1], (plane.n_points, 1))
    with pytest.raises(ValueError, match="mesh: expected a surface of consistently oriented faces"):
        closed_meshes.shell(mixed, 0.1, normals)
