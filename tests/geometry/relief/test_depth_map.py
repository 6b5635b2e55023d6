"""The highest of triangles over nodes."""

import numpy as np
import pytest

from vizlight.geometry import depth_map as module
from vizlight.geometry.relief.depth_map import depth_map


def brute(x, y, points, triangles):
    """Return the same by one least-squares a triangle and node."""
    height = np.full((len(y), len(x)), np.nan)
    for a, b, c in points[triangles]:
        for j, i in np.ndindex(height.shape):
            matrix = np.stack([b[:2] - a[:2], c[:2] - a[:2]], axis=1)
            u, v = np.linalg.solve(matrix, [x[i] - a[0], y[j] - a[1]])
            if min(u, v, 1 - u - v) >= 0:
                z = a[2] + u * (b - a)[2] + v * (c - a)[2]
                height[j, i] = np.fmax(height[j, i], z)
    return height


def test_random_triangles(random, monkeypatch):
    monkeypatch.setattr(module, "BLOCK", 100)
    points = random.uniform(-1.5, 1.5, (60, 3))
    triangles = random.integers(0, 60, (25, 3))
    triangles = triangles[[len(set(t)) == 3 for t in triangles]]
    x, y = np.linspace(-1, 1, 23), np.linspace(-0.7, 1, 17)
    expected = brute(x, y, points, triangles)
    np.testing.assert_allclose(depth_map(x, y, points, triangles), expected, atol=1e-12)


def test_nothing_and_edge_on():
    x = np.linspace(0, 1, 3)
    assert np.isnan(depth_map(x, x, np.eye(3), np.empty((0, 3), int))).all()
    wall = np.array([[0, 0.3, 0], [1, 0.3, 0], [0, 0.3, 1.0]])
    assert np.isnan(depth_map(x, x, wall, [[0, 1, 2]])).all()


def test_a_node_on_an_edge_is_covered():
    points = np.array([[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1.0]])
    x = np.linspace(0, 1, 11)
    found = depth_map(x, x, points, [[0, 1, 2], [0, 2, 3]])
    np.testing.assert_allclose(found, 1)


def test_bad_input():
    with pytest.raises(ValueError, match="x: expected rising nodes of equal spacing"):
        depth_map([0, 1, 3], [0, 1], np.eye(3), [[0, 1, 2]])
    with pytest.raises(ValueError, match="triangles: expected integers"):
        depth_map([0, 1], [0, 1], np.eye(3), [[0.0, 1, 2]])
