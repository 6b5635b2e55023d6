"""Tangents of polylines: exact where theory says so, right where lines are odd."""

import itertools

import numpy as np
import pytest
from refusals import refusals

from vizlight.geometry import curves


def test_straight_line_is_exact(dtype):
    points = np.outer([0, 0.5, 3, 3.25, 10], [1, 2, 2]).astype(dtype)
    tangents = curves.polyline_tangents(points)
    assert tangents.dtype == dtype
    np.testing.assert_allclose(tangents, np.tile([1 / 3, 2 / 3, 2 / 3], (5, 1)), rtol=1e-6)


def test_closed_line_has_no_seam():
    s = np.linspace(0, 2 * np.pi, 13)
    circle = np.stack([np.cos(s), np.sin(s), 0 * s], axis=1)
    circle[-1] = circle[0]
    exact = np.stack([-np.sin(s), np.cos(s), 0 * s], axis=1)
    np.testing.assert_allclose(curves.polyline_tangents(circle), exact, atol=1e-12)
    by_index = curves.polyline_tangents(circle[:12], connectivity=[*range(12), 0], offsets=[0, 13])
    np.testing.assert_allclose(by_index, exact[:12], atol=1e-12)


def test_there_and_back_is_not_closed():
    tangents = curves.polyline_tangents([[0.0, 0, 0], [1, 0, 0], [0, 0, 0]])
    np.testing.assert_allclose(tangents[0], [1.0, 0, 0])
    assert np.all(np.isfinite(tangents))


def test_many_lines_equal_one_at_a_time(random):
    sizes = random.integers(0, 9, 60)
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    points = random.standard_normal((offsets[-1], 3))
    ids = random.permutation(len(points))
    together = curves.polyline_tangents(points, connectivity=ids, offsets=offsets)
    for a, b in itertools.pairwise(offsets):
        np.testing.assert_array_equal(
            together[ids[a:b]], curves.polyline_tangents(points[ids[a:b]])
        )


test_bad_input = refusals(
    lambda points, options: curves.polyline_tangents(points, **options),
    (np.ones(3), {}, r"points: expected shape \(N, n\)"),
    (np.ones((3, 3)), {"connectivity": [0, 3]}, "connectivity: .* from 0 to 2"),
    (np.ones((3, 3)), {"connectivity": [0.5]}, "connectivity: expected integers", TypeError),
    (np.ones((3, 3)), {"offsets": [0, 2]}, "offsets: expected rising indices"),
    (np.ones((3, 3)), {"offsets": [0, 2, 1, 3]}, "offsets: expected rising"),
    (np.ones((3, 3)), {"offsets": [0, 4]}, "offsets: .* from 0 to 3"),
)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_points_that_are_not_finite_spoil_only_their_neighbours(bad):
    points = np.outer(np.arange(9.0), [1, 0, 0])
    points[4, 1] = bad
    tangents = curves.polyline_tangents(points)
    assert np.all(np.isfinite(tangents))
    np.testing.assert_array_equal(tangents[[0, 1, 2, 6, 7, 8]], np.tile([1.0, 0, 0], (6, 1)))
    np.testing.assert_array_equal(tangents[4], 0)
