"""Rotations are rotations; projections and their derivatives against 50 digits."""

import numpy as np
import oracles
import pytest
from refusals import refusals
from scipy.stats import special_ortho_group

from vizlight.geometry import projection


def test_plane_rotation():
    turn = projection.plane_rotation(4, "xw", np.pi / 2)
    np.testing.assert_allclose(turn @ [1, 0, 0, 0], [0, 0, 0, 1], atol=1e-16)
    np.testing.assert_allclose(turn @ [0, 2, 3, 0], [0, 2, 3, 0])
    np.testing.assert_array_equal(projection.plane_rotation(4, (0, 3), np.pi / 2), turn)
    np.testing.assert_array_equal(
        projection.plane_rotation(7, (6, 2), 0.3).T, projection.plane_rotation(7, (2, 6), 0.3)
    )


def test_turns_one_after_the_other(random):
    one, other = projection.plane_rotation(5, "xw", 0.3), special_ortho_group.rvs(5, random_state=1)
    together = projection.rotation(5, [("xw", 0.3), other, ((1, 4), -0.2)])
    expected = projection.plane_rotation(5, (1, 4), -0.2) @ other @ one
    np.testing.assert_allclose(together, expected, atol=1e-15)
    np.testing.assert_array_equal(projection.rotation(5, other), other)
    np.testing.assert_array_equal(projection.rotation(5, other.tolist()), other)
    np.testing.assert_array_equal(projection.rotation(2, ((0, -1), (1, 0))), [[0, -1], [1, 0]])
    x = random.standard_normal((6, 2, 5))
    np.testing.assert_allclose(projection.turn(x, other), np.einsum("ij,abj->abi", other, x))


test_bad_rotations = refusals(
    lambda turns: projection.rotation(4, turns),
    (("xx", 0.1), "plane: expected two different axes of 4-space"),
    (("xyz", 0.1), "plane: expected two different axes"),
    (("xv", 0.1), "plane: expected two different axes"),
    (((0, 4), 0.1), "plane: expected two different axes"),
    (((0, -1), 0.1), "plane: expected an integer of at least 0"),
    (((0.0, 1.0), 0.1), "plane: expected two different axes", TypeError),
    ((3, 0.1), "plane: expected two different axes", TypeError),
    (("xw", np.nan), "angle: expected a finite number"),
    (("xw", np.inf), "angle: expected a finite number"),
    ("xw", r"rotation: expected a matrix of shape \(4, 4\)", TypeError),
    (None, "rotation: expected a matrix", TypeError),
    ([], "rotation: expected a matrix"),
    ([("xw", 0.1), 3], "rotation: expected a matrix"),
    (np.eye(3), r"rotation: .*got shape \(3, 3\)"),
    (np.eye(4) * 1.001, "rotation: expected an orthogonal.*scipy.linalg.polar"),
    (np.full((4, 4), 1e300), "rotation: expected an orthogonal"),
    (np.full((4, 4), np.nan), "rotation: expected finite numbers"),
    (np.diag([1, 1, 1, -1]), "rotation: expected a rotation, got a reflection"),
)


def test_planes_and_space_stay(random):
    x, v = random.standard_normal((4, 3)), random.standard_normal((4, 1, 3))
    np.testing.assert_array_equal(projection.perspective(x, distance=2.0), x)
    np.testing.assert_array_equal(projection.push_forward(v, x, distance=2.0), v)
    flat = projection.perspective(x[:, :2])
    np.testing.assert_array_equal(flat, np.c_[x[:, :2], np.zeros(4)])
    np.testing.assert_array_equal(projection.push_forward(v[..., :2], x[:, :2])[..., 2], 0)


def test_a_frame_of_what_is_seen(random):
    """It spans the images, the first row along the first; an overall scale changes nothing."""
    for n, distance in ((4, None), (4, 2.0), (6, 3.0)):
        frame = oracles.frames(random, 40, 2, n, np.float64)
        points = random.uniform(-0.4, 0.4, (40, n))
        found, rank = projection.push_frame(frame, points, distance=distance)
        image = projection.push_forward(frame, points, distance=distance)
        np.testing.assert_array_equal(rank, 2)
        np.testing.assert_allclose(
            np.einsum("bki,bli->bkl", found, found), np.tile(np.eye(2), (40, 1, 1)), atol=1e-14
        )
        inside = np.einsum("bki,bji,bjm->bkm", image, found, found)
        np.testing.assert_allclose(inside, image, atol=1e-13)
        first = image[:, 0] / np.linalg.norm(image[:, 0], axis=1, keepdims=True)
        np.testing.assert_allclose(found[:, 0], first, atol=1e-14)
        again, _ = projection.push_frame(1e-200 * frame, points, distance=distance)
        np.testing.assert_allclose(again, found, atol=1e-13)


@pytest.mark.parametrize("distance", [None, 1.7])
@pytest.mark.parametrize("k", [1, 2, 3])
def test_silhouettes_are_found_in_any_basis(k, distance, random):
    """Tangents aimed at the eye, mixed with others by a random rotation: rank k - 1, not k."""
    points = random.uniform(-1, 1, (500, 4)) * [2, 2, 2, 1]
    toward = np.array([0, 0, 0, 1.0]) if distance is None else [0, 0, 0, distance] - points
    rows = random.standard_normal((500, k, 4))
    rows[:, 0] = toward
    turns = np.linalg.qr(random.standard_normal((500, k, k)))[0]
    # Nearly, but not quite, along one row as well.
    turns[:50] = np.eye(k)
    turns[:50, -1, 0] = 1e-8
    found, rank = projection.push_frame(turns @ rows, points, distance=distance)
    np.testing.assert_array_equal(rank, k - 1)
    np.testing.assert_array_equal(np.any(found, axis=2).sum(axis=1), k - 1)
    # A millionth away from there it is no silhouette.
    rows[:, 0] += 1e-6 * np.linalg.norm(toward) * random.standard_normal((500, 4))
    _, rank = projection.push_frame(turns @ rows, points, distance=distance)
    assert np.mean(rank == k) > 0.95


def test_frames_that_cannot_be_pushed():
    with pytest.raises(ValueError, match="frame: expected 3 tangents or fewer"):
        projection.push_frame(np.eye(5)[:4], np.zeros(5))
    with pytest.raises(ValueError, match="rtol: expected"):
        projection.push_frame(np.eye(5)[:2], np.zeros(5), rtol=-1)
    lost = np.array([[[np.nan, 0, 0, 0], [0, 1, 0, 0]], [[0, 0, 0, 0], [0, 0, 0, 0]]])
    found, rank = projection.push_frame(lost, np.full((2, 4), 1e150), distance=1e-150)
    assert np.all(np.isfinite(found))
    assert rank.max() <= 1


def test_depth():
    """In more dimensions each step has an eye of its own."""
    both = np.array([[0, 0, 0, 0.8, 0.5], [0, 0, 0, 0.4, 0.5]])
    _, found = projection.image_and_depth(both, distance=1.0)
    np.testing.assert_allclose(found, [-0.6, 0.2])


ROWS = np.zeros((2, 4))


test_bad_projections = refusals(
    lambda call: call(),
    (lambda: projection.perspective([1.0]), "points: expected vectors"),
    (lambda: projection.perspective(ROWS, distance=0), "distance: expected a number above 0"),
    (lambda: projection.perspective(ROWS, distance=np.nan), "distance: expected"),
    (lambda: projection.push_forward(ROWS, ROWS), "vectors: expected shape"),
    (lambda: projection.push_forward(ROWS[:, None], ROWS[:, :3]), "points: expected vectors"),
    (lambda: projection.turn(ROWS, np.eye(3)), r"matrix: expected shape \(4, 4\)"),
    (lambda: projection.plane_rotation(1, (0, 1), 0.1), "n: expected an integer"),
)
