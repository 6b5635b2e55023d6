"""Compiled loops over faces find what NumPy finds."""

import numpy as np
import pytest
import pyvista as pv

from vizlight import _compiled
from vizlight.vtk.corners import corner_normals
from vizlight.vtk.orientation import SurfaceShape
from vizlight.vtk.topology import coincident, sorted_edges

pytestmark = pytest.mark.skipif(bool(_compiled.why_not()), reason="numba is missing")


def both(function):
    """Return what a function finds in NumPy, and compiled."""
    found = []
    for value in ("0", "1"):
        with _compiled.setting(value):
            found.append(function())
    return found


def close(one, other, **limits):
    assert len(one) == len(other)
    for a, b in zip(one, other, strict=True):
        np.testing.assert_allclose(b, a, **limits)


def surface(random, dtype):
    """Return a rough ball of triangles with poles of many edges, and places that repeat."""
    ball = pv.Sphere(theta_resolution=90, phi_resolution=12)
    points = np.asarray(ball.points) * random.uniform(0.8, 1.2, (ball.n_points, 1))
    points = np.concatenate([points, points[::7], points[:1] + 1e-6])
    faces = ball.regular_faces.copy()
    faces[::5] = faces[::5, ::-1]
    first = np.full(ball.n_points, -1)
    first[::7] = ball.n_points + np.arange(len(first[::7]))
    faces[::3] = np.where(first[faces[::3]] >= 0, first[faces[::3]], faces[::3])
    more = [[0, len(points) - 1, 5], [3, 3, 4], [8, 9, 8]]
    return pv.PolyData.from_regular_faces(points.astype(dtype), np.concatenate([faces, more]))


@pytest.mark.parametrize("scale", [1e-150, 1.0, 1e150])
@pytest.mark.parametrize("size", [3, 4, 5])
def test_normals_of_corners(size, scale, random):
    """Of polygons that are dented, name points twice, have no area, or corners at no place."""
    points = random.normal(size=(60, 3)) * scale
    points[7], points[8] = np.nan, points[9]
    # Each point in one face alone, so that rounding cannot become a direction.
    faces = random.permutation(60).reshape(-1, size)
    faces[0, 1] = faces[0, 0]
    faces[1] = faces[1, 0]
    faces[2, 2:] = faces[2, 1]
    whole, compiled = both(lambda: corner_normals(points, [faces]))
    np.testing.assert_allclose(compiled, whole, atol=1e-6)
    assert np.count_nonzero(np.any(whole, axis=1)) > 40


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("by_place", [False, True])
def test_edges_are_sorted_alike(dtype, by_place, random, monkeypatch):
    mesh = surface(random, dtype)
    same = coincident(np.asarray(mesh.points)) if by_place else None
    assert (same is not None) == by_place
    monkeypatch.setattr("vizlight.vtk.topology.EDGES", 1000)
    monkeypatch.setattr("vizlight.vtk.topology.BLOCK", 200)
    faces = mesh.regular_faces
    whole, compiled = both(lambda: [*sorted_edges(faces, mesh.n_points, same)])
    assert len(whole) > 3
    assert sum(len(part.keys) for part in whole) < faces.size
    for one, other in zip(whole, compiled, strict=True):
        for a, b in zip(one, other, strict=True):
            np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_shapes_and_their_survey(dtype, random):
    mesh = surface(random, dtype)
    points = np.asarray(mesh.points)
    points[4] = np.inf
    known = np.isfinite(points[mesh.regular_faces]).all(axis=(1, 2))
    finite = pv.PolyData.from_regular_faces(points, mesh.regular_faces[known])
    for one in (mesh, finite):
        normals = random.normal(size=points.shape).astype(np.float32)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        shapes = both(lambda one=one: SurfaceShape(one))
        np.testing.assert_array_equal(shapes[0].edges, shapes[1].edges)
        np.testing.assert_array_equal(shapes[0]._full, shapes[1]._full)
        np.testing.assert_allclose(shapes[0]._unit, shapes[1]._unit, atol=1e-6)
        slivers = [
            np.concatenate([part.lower * 10000 + part.upper for part in shape.slivers])
            for shape in shapes
        ]
        assert len(slivers[0]) > 1
        np.testing.assert_array_equal(*map(np.sort, slivers))
        if one is mesh:
            continue
        (sums, lean), (other, leaning) = both(lambda shape=shapes[0], n=normals: shape.survey(n))
        close(sums, other, rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(leaning, lean, atol=1e-3)


def test_surfaces_without_slivers_have_none(random):
    mesh = pv.Sphere(theta_resolution=20, phi_resolution=20)
    for shape in both(lambda: SurfaceShape(mesh)):
        assert sum(len(part.lower) for part in shape.slivers) == 0
