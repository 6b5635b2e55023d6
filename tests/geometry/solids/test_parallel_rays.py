"""Hits of parallel rays against a product of signs in exact numbers, and through edges."""

from fractions import Fraction

import numpy as np
import pytest
import pyvista as pv
from vectors import unit

from vizlight.geometry.solids import parallel_rays
from vizlight.mesh import closed_meshes

WAYS = [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0.6, 0.0, 0.8), (0.48, 0.6, 0.64), (1e-9, 0, 1)]


def windings(body, start, way):
    """Times that each line enters minus times that it leaves, and the number of its hits."""
    ray, cell = parallel_rays.hits(body.vertices, body.triangles, start, way)
    sense = np.sign(body.normals[cell] @ way)
    return np.bincount(ray, sense, len(start)), np.bincount(ray, minlength=len(start))


def solid(mesh):
    return closed_meshes.Body(*closed_meshes.closed(mesh))


@pytest.mark.parametrize("way", WAYS)
def test_lines_through_vertices_and_edges_enter_as_often_as_they_leave(way, random):
    """A cube of unit cells with lines through its vertices, edges and cells."""
    cells = pv.ImageData(dimensions=(5, 5, 5)).extract_surface(algorithm="geometry").triangulate()
    body = solid(cells)
    middles = body.vertices[body.triangles[:, :2]].mean(axis=1)
    inner = random.uniform(0.1, 3.9, (200, 3))
    start = np.concatenate([body.vertices, middles, inner])
    total, count = windings(body, start, unit(way))
    assert np.all(total == 0)
    assert np.all(count % 2 == 0)
    assert np.all(count[-200:] == 2)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("way", WAYS[3:5])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_every_hit_is_found(way, dtype, random):
    """The sides of the edges in rational numbers, of a tangle of triangles."""
    vertices = random.normal(size=(40, 3)).astype(dtype).astype(np.float64)
    triangles = random.permuted(np.tile(np.arange(40), (30, 1)), axis=1)[:, :3]
    start, way = random.normal(size=(60, 3)), unit(way)
    ray, cell = parallel_rays.hits(vertices, triangles, start, way)
    found = set(zip(ray.tolist(), cell.tolist(), strict=True))

    exact = [[Fraction(x) for x in row] for row in vertices.tolist()]
    toward = [Fraction(x) for x in way.tolist()]

    def volume(a, b, p):
        (a0, a1, a2), (b0, b1, b2) = ([x - y for x, y in zip(q, p, strict=True)] for q in (a, b))
        return (
            toward[0] * (a1 * b2 - a2 * b1)
            + toward[1] * (a2 * b0 - a0 * b2)
            + toward[2] * (a0 * b1 - a1 * b0)
        )

    expected = set()
    for i, p in enumerate(start.tolist()):
        place = [Fraction(x) for x in p]
        for j, (a, b, c) in enumerate(triangles.tolist()):
            sides = [volume(exact[u], exact[v], place) > 0 for u, v in ((a, b), (b, c), (c, a))]
            if all(sides) or not any(sides):
                expected.add((i, j))
    assert found == expected
    assert len(expected) > 100


def test_far_from_the_origin_and_with_rays_outside(random):
    ball = pv.Sphere(theta_resolution=40, phi_resolution=40)
    ball.points = np.asarray(ball.points, dtype=np.float64) + np.array([5e6, -3e6, 1e3])
    body = solid(ball)
    start = np.asarray(ball.points)[::7] + random.uniform(-2, 2, (len(ball.points[::7]), 3))
    total, count = windings(body, start, unit((0.48, 0.6, 0.64)))
    assert np.all(total == 0)
    gap = start - ball.center
    way = unit((0.48, 0.6, 0.64))
    miss = np.linalg.norm(gap - (gap @ way)[:, None] * way, axis=1)
    assert np.all(count[miss < 0.49] == 2)
    assert np.all(count[miss > 0.501] == 0)


def test_none_where_a_tree_is_faster():
    """Long triangles along the diagonal, whose boxes hold every ray."""
    t = np.linspace(0, 1, 400)
    low = np.stack([t * 0, t * 1e-3, t], axis=1)
    vertices = np.concatenate([low, low + np.array([1.0, 1, 0]), low + np.array([1, 1 + 1e-4, 0])])
    triangles = np.arange(1200).reshape(3, 400).T
    start = np.random.default_rng(1).uniform(0, 1, (2000, 3))
    assert parallel_rays.hits(vertices, triangles, start, np.array([0.0, 0, 1])) is None


def test_nothing_to_hit():
    none = np.empty((0, 3)), np.empty((0, 3), np.intp)
    for start in (np.empty((0, 3)), np.ones((4, 3))):
        ray, cell = parallel_rays.hits(*none, start, np.array([0.0, 0, 1]))
        assert len(ray) == len(cell) == 0


@pytest.mark.parametrize("way", WAYS[2:5])
def test_lengths_are_those_of_a_search_tree(way, random, monkeypatch):
    ring = pv.ParametricTorus(u_res=60, v_res=40, w_res=2).triangulate().clean(tolerance=1e-6)
    body = solid(ring)
    start = random.uniform(-1, 1, (400, 3)) * [1.5, 1.5, 0.5]
    ways, reach = np.tile(unit(way), (400, 1)), np.full(400, np.inf)
    found = closed_meshes.inside_length([body], start, ways, reach)
    monkeypatch.setattr(parallel_rays, "hits", lambda *_: None)
    tree = closed_meshes.inside_length([solid(ring)], start, ways, reach)
    assert np.abs(found - tree).max() < 1e-9
    assert np.count_nonzero(found) > 100
