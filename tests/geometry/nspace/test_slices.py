"""A hyperplane cuts simplices without cracks, and frames to what lies in it."""

import itertools

import numpy as np
import oracles
import pytest
from refusals import refusals
from scipy.sparse import csr_array
from vectors import areas, projector

from vizlight.geometry import slices


def test_every_pattern_of_a_tetrahedron():
    """The area of the cut, and that its corners are where the function is zero."""
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    for signs in itertools.product([-1, 1], repeat=4):
        heights = np.array(signs) * [0.3, 0.7, 0.5, 0.9]
        edges, weights, cells = slices.cut(heights, [[0, 1, 2, 3]])
        number = signs.count(1)
        assert len(cells) == {0: 0, 1: 1, 2: 2, 3: 1, 4: 0}[number]
        points = (1 - weights)[:, None] * corners[edges[:, 0]] + weights[:, None] * corners[
            edges[:, 1]
        ]
        np.testing.assert_allclose(
            (1 - weights) * heights[edges[:, 0]] + weights * heights[edges[:, 1]], 0, atol=1e-15
        )
        if number == 2:
            # Two triangles that share a diagonal make the whole quadrilateral: the areas add up
            # to that of the hull, which the other diagonal would give too.
            a, b = cells
            shared = set(a) & set(b)
            assert len(shared) == 2
            ring = [*shared, *(set(a) ^ set(b))]
            p, q, r, s = points[[ring[0], ring[2], ring[1], ring[3]]]
            whole = 0.5 * np.linalg.norm(np.cross(r - p, s - q))
            assert areas(points[cells]).sum() == pytest.approx(whole, rel=1e-12)


def test_a_corner_at_zero_is_one_point():
    # A fan of triangles around point 0, which lies in the hyperplane with points 1 and 4.
    heights = [0.0, 0.0, 1.0, 1.0, 0.0, -1.0, -1.0]
    fan = [[0, i, i % 6 + 1] for i in range(1, 7)]
    edges, weights, cells = slices.cut(heights, fan)
    assert sorted(map(tuple, edges.tolist())) == [(0, 0), (1, 1), (4, 4)]
    np.testing.assert_array_equal(weights, 0)
    assert len(cells) == 2


def test_what_lies_in_the_hyperplane_or_touches_it():
    assert len(slices.cut([0.0, 0, 0], [[0, 1, 2]])[2]) == 0
    assert len(slices.cut([0.0, 1, 1], [[0, 1, 2]])[2]) == 0
    assert len(slices.cut([0.0, -1, -1], [[0, 1, 2]])[2]) == 0
    # An edge in the hyperplane is found once, from whichever side.
    assert len(slices.cut([0.0, 0, -1, 1], [[0, 1, 2], [0, 1, 3]])[2]) == 1
    assert len(slices.cut([0.0, 0, -1, -1], [[0, 1, 2], [0, 1, 3]])[2]) == 1


def test_values_that_are_not_finite_or_extreme():
    _, weights, cells = slices.cut([1e308, -1e308, np.nan, np.inf], [[0, 1], [0, 2], [1, 3]])
    assert len(cells) == 1
    assert weights == pytest.approx(0.5)
    edges, weights, cells = slices.cut([], np.empty((0, 3), int))
    assert edges.shape == (0, 2)
    assert cells.shape == (0, 2)


def test_a_circle_is_cut_in_two_points():
    t = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    edges, weights, cells = slices.cut(
        np.cos(t) - 0.3, np.stack([np.arange(40), np.roll(np.arange(40), -1)], 1)
    )
    assert cells.shape == (2, 1)
    x = (1 - weights) * np.cos(t)[edges[:, 0]] + weights * np.cos(t)[edges[:, 1]]
    np.testing.assert_allclose(x, 0.3, atol=1e-15)


@pytest.mark.parametrize(("k", "n"), [(1, 3), (2, 4), (3, 5)])
def test_mean_frames_do_not_depend_on_the_basis_at_a_point(k, n, random):
    """Random rotations and signs of each basis change nothing that is spanned."""
    base = oracles.frames(random, 1, k, n, np.float64)
    near = np.linalg.qr((base + 0.2 * random.standard_normal((30, k, n))).swapaxes(1, 2))[0]
    frame = np.ascontiguousarray(near.swapaxes(1, 2))
    turns = np.linalg.qr(random.standard_normal((30, k, k)))[0]
    shares = random.uniform(0, 1, (20, 30)) * (random.uniform(0, 1, (20, 30)) < 0.2)
    shares[:, 0] += 0.1
    shares = csr_array(shares / shares.sum(axis=1, keepdims=True))
    one, other = (slices.mean_frame(f, shares) for f in (frame, turns @ frame))
    np.testing.assert_allclose(projector(one), projector(other), atol=1e-14)
    gram = np.einsum("bki,bli->bkl", one, one)
    np.testing.assert_allclose(gram, np.tile(np.eye(k), (20, 1, 1)), atol=1e-14)


def test_spaces_without_a_mean_have_none():
    """At right angles either diagonal would do; a point without tangents has no space."""
    frame = np.stack([np.eye(4)[:2], np.eye(4)[1:3], np.eye(4)[[0, 0]], np.eye(4)[:2]])
    frame = np.concatenate([frame, np.full((1, 2, 4), np.nan)])
    shares = csr_array(
        np.array([[1, 1, 0, 0, 0], [1, 0, 1, 0, 0], [1, 0, 0, 0, 1], [1, 0, 0, 1, 0]]) / 2
    )
    found = slices.mean_frame(frame, shares)
    np.testing.assert_array_equal(found[:3], 0)
    np.testing.assert_allclose(projector(found[3:])[0], np.diag([1, 1, 0, 0]), atol=1e-15)
    assert slices.mean_frame(frame, csr_array((0, 5))).shape == (0, 2, 4)
    with pytest.raises(ValueError, match="shares: expected a matrix of 5 columns"):
        slices.mean_frame(frame, csr_array((2, 4)))
    with pytest.raises(ValueError, match="frame: expected shape"):
        slices.mean_frame(frame[0], shares)


def test_a_manifold_that_touches_within_the_rounding_of_float32():
    tilted = np.array([[1, 0, 0, 0.0], [0, 1, 0, 3e-8]])
    assert np.any(slices.slice_frame(tilted, (0, 0, 0, 1.0)))
    np.testing.assert_array_equal(slices.slice_frame(tilted, (0, 0, 0, 1.0), rtol=1e-6), 0)


def test_where_the_manifold_touches_the_hyperplane_there_is_no_frame():
    flat = np.eye(4)[:2]
    tilted = np.array([[1, 0, 0, 0.0], [0, 1, 0, 1e-3]])
    found = slices.slice_frame(np.stack([flat, tilted, 0 * flat]), (0, 0, 0, 2.0))
    np.testing.assert_array_equal(found[[0, 2]], 0)
    np.testing.assert_allclose(np.abs(found[1]), [[1, 0, 0, 0]], atol=1e-12)


test_bad_simplices = refusals(
    slices.cut,
    ([1.0, -1], [[0, 1, 1, 1, 1]], "simplices: expected integers of shape"),
    ([1.0, -1], [[0.0, 1]], "simplices: expected integers of shape"),
    ([1.0, -1], [[0, 2]], "simplices: expected indices of values from 0 to 1"),
    ([1.0, -1], [[-1, 0]], "simplices: expected indices of values"),
)


test_bad_slices = refusals(
    slices.slice_frame,
    (np.eye(4)[:1], (0, 0, 0, 1), "frame: expected 2 tangents or more"),
    (np.eye(4)[:2], (0, 0, 1), "normal: expected 4 components"),
    (np.eye(4)[:2], (0, 0, 0, 0), "normal: expected a direction of non-zero length"),
)
