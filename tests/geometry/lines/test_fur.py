"""Seeds uniform in area, and fibres that grow as told."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals
from vectors import areas, unit

from vizlight.geometry import fur


def square(n, *, skewed=False):
    """Return a unit square in n x n x 2 triangles, equal or very unequal."""
    s = np.linspace(0, 1, n + 1)
    if skewed:
        s = s**3
    x, y = np.meshgrid(s, s, indexing="ij")
    points = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)
    i = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = (q.ravel() for q in (i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]))
    return points, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def places(points, faces, count, seed=0):
    face, weights = fur.seeds(points, faces, count, seed=seed)
    return np.einsum("fi,fij->fj", weights, points[faces[face]])


def test_each_triangle_has_its_share_to_within_two():
    points, faces = square(9, skewed=True)
    face, _ = fur.seeds(points, faces, 10_000)
    share = 10_000 * areas(points[faces])
    assert np.abs(np.bincount(face, minlength=len(faces)) - share).max() <= 2


def test_uniform_within_a_triangle():
    points, faces = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])
    x, y, _ = places(points, faces, 100_000).T
    assert x.mean() == pytest.approx(1 / 3, abs=2e-3)
    assert y.mean() == pytest.approx(1 / 3, abs=2e-3)
    assert np.mean(x * y) == pytest.approx(1 / 12, abs=1e-3)
    assert min(x.min(), y.min()) >= 0
    assert (x + y).max() <= 1 + 1e-6


def test_few_places_in_one_triangle_are_uniform_over_seeds():
    """Each of the four like triangles in it has its quarter, however few places there are."""
    points, faces = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])
    for count in (1, 2, 5):
        found = np.concatenate([places(points, faces, count, seed) for seed in range(800)])
        x, y = found[:, 0], found[:, 1]
        part = np.select([x > 0.5, y > 0.5, x + y < 0.5], [0, 1, 2], 3)
        number = np.bincount(part, minlength=4)
        chi2 = np.sum((number - len(found) / 4) ** 2) / (len(found) / 4)
        assert chi2 < 3 + 6 * np.sqrt(6)


def test_no_pattern_runs_over_the_triangles_of_a_grid():
    """The structure factor has no peak such as one lattice for all triangles would have."""
    found = places(*square(32), 32 * 32 * 34)[:, :2]
    along, across = (
        np.exp(2j * np.pi * np.outer(waves, place))
        for waves, place in zip((np.arange(100, 140), np.arange(80, 120)), found.T, strict=True)
    )
    power = np.abs(along @ across.T) ** 2 / len(found)
    assert power.max() < 25


def test_more_than_a_block():
    points, faces = square(4)
    face, weights = fur.seeds(points, faces, fur.SEED_BLOCK + 100)
    # One triangle after the other, along the curve.
    assert np.count_nonzero(np.diff(face)) == len(faces) - 1
    np.testing.assert_allclose(weights.sum(axis=1), 1, atol=1e-6)


def test_triangles_without_area_have_no_seeds():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0], [np.nan, 0, 0]])
    faces = np.array([[0, 1, 3], [0, 1, 2], [0, 1, 4], [3, 3, 3]])
    face, _ = fur.seeds(points, faces, 1000)
    assert set(face) == {1}


test_bad_seeds = refusals(
    fur.seeds,
    (np.eye(3), [[0, 1]], 5, r"faces: expected integers of shape \(M, 3\)"),
    (np.eye(3), [[0.0, 1, 2]], 5, "faces: expected integers"),
    (np.eye(3), [[0, 1, 1]], 5, "faces: expected triangles with an area above 0"),
    (np.eye(3), np.empty((0, 3), int), 5, "faces: expected triangles with an area above 0"),
    (np.eye(3), [[0, 1, 2]], -1, "count: expected an integer of at least 0"),
)


def grown(directions, lengths, toward=None, **options):
    """Return fibres, shape (F, S + 1, 3)."""
    toward = None if toward is None else toward.T.copy()
    return fur.strands(directions.T.copy(), lengths, toward=toward, **options).transpose(2, 0, 1)


def test_straight_fibres(random):
    direction = unit(random.standard_normal((20, 3)))
    length = random.uniform(0.1, 2, 20)
    strand = grown(direction, length, segments=4)
    assert strand.shape == (20, 5, 3)
    expected = np.linspace(0, 1, 5)[:, None] * (length[:, None] * direction)[:, None]
    np.testing.assert_allclose(strand, expected, atol=1e-14)


@pytest.mark.parametrize(
    "shape", [{"bend": 2.0}, {"curl": 1.5, "turns": 3.0}, {"bend": -1.0, "curl": 0.5}]
)
def test_segments_keep_their_length(shape, random):
    direction, toward = random.standard_normal((2, 30, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    toward /= np.linalg.norm(toward, axis=1, keepdims=True)
    phase = random.uniform(0, 6, 30)
    strand = grown(direction, 0.7, segments=5, toward=toward, phase=phase, **shape)
    step = np.linalg.norm(np.diff(strand, axis=1), axis=2)
    np.testing.assert_allclose(step, 0.7 / 5, rtol=1e-12)


def test_bend_goes_toward_more_and_more():
    up, right = np.array([[0.0, 0, 1]]), np.array([[1.0, 0, 0]])
    strand = grown(up, 1.0, segments=8, toward=right, bend=1.5)[0]
    step = np.diff(strand, axis=0)
    lean = step[:, 0] / step[:, 2]
    np.testing.assert_allclose(lean, 1.5 * (np.arange(8) + 0.5) / 8)
    np.testing.assert_allclose(strand[:, 1], 0)


def test_curl_turns_about_the_direction():
    up = np.array([[0.0, 0, 1]])
    strand = grown(up, 1.0, segments=40, curl=1.0, turns=2.0)[0]
    step = np.diff(strand, axis=0)
    angle = np.unwrap(np.arctan2(step[:, 1], step[:, 0]))
    assert abs(angle[-1] - angle[0]) == pytest.approx(2 * 2 * np.pi * 39 / 40)
    np.testing.assert_allclose(step[:, 2], step[0, 2])


@pytest.mark.parametrize("bits", [1, 2, 4])
def test_the_curve_visits_all_cells_from_neighbour_to_neighbour(bits):
    side = range(1 << bits)
    cells = np.stack(np.meshgrid(side, side, side, indexing="ij")).reshape(3, -1)
    index = fur.hilbert(cells, bits)
    assert np.array_equal(np.sort(index), np.arange(8**bits))
    steps = np.abs(np.diff(cells[:, np.argsort(index)], axis=1)).sum(axis=0)
    assert np.all(steps == 1)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("size", [1e-20, 1.0, 1e6])
def test_places_are_even_on_shuffled_triangles(size, random, claim):
    """Variance over mean of counts on patches of equal area: 320 thousand triangles of a sphere."""
    sphere = pv.Icosphere(nsub=7, radius=1)
    points = np.asarray(sphere.points, dtype=float)
    faces = random.permutation(sphere.regular_faces)
    for rows, per_patch in ((15, 30), (50, 40)):
        face, weights = fur.seeds(size * points + size, faces, 2 * rows**2 * per_patch)
        x, y, z = np.einsum("ij,ijk->ki", weights, points[faces[face]])
        # Equal steps of z and of longitude have equal areas.
        across = np.clip((z + 1) / 2 * rows, 0, rows - 1).astype(int)
        around = ((np.arctan2(y, x) / np.pi + 1) * rows).astype(int) % (2 * rows)
        counts = np.bincount(across * 2 * rows + around, minlength=2 * rows**2)
        claim(counts.var() / counts.mean(), 0.25)


def test_the_curve_through_triangles_that_are_not_finite_or_in_one_place():
    assert fur.laid(np.zeros((3, 3)), np.array([[0, 1, 2]] * 4))[0].tolist() == [0, 1, 2, 3]
    assert fur.laid(np.empty((0, 3)), np.empty((0, 3), int))[0].shape == (0,)
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [np.nan, 0, 0], [np.inf, 1, 0.0]])
    faces = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    assert sorted(fur.laid(points, faces)[0]) == [0, 1, 2]
