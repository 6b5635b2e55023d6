"""Frames: rank, orthonormality and splitting, on vectors that break careless code."""

import numpy as np
import oracles
import pytest
from refusals import refusals

from vizlight.model import frames

SIZES = [(1, 2), (1, 3), (2, 3), (1, 4), (2, 4), (3, 8), (7, 8)]


@pytest.mark.parametrize(("k", "n"), SIZES)
def test_spans_what_it_was_given(k, n, dtype, random):
    vectors = random.standard_normal((40, k, n)).astype(dtype)
    frame, rank = frames.orthonormalize(vectors)
    assert frame.dtype == dtype
    assert frame.shape == vectors.shape
    assert np.all(rank == k)
    for v, f in zip(vectors, frame, strict=True):
        rest = v - (v @ f.T) @ f
        assert np.abs(rest).max() < 50 * oracles.eps(dtype) * np.abs(v).max()


def test_first_row_is_along_the_first_vector(dtype):
    frame, _ = frames.orthonormalize(np.array([[0, -3, 0], [5, 1, 0]], dtype=dtype))
    np.testing.assert_array_equal(frame, np.array([[0, -1, 0], [1, 0, 0]], dtype=dtype))


def test_rtol_sets_what_is_dependent():
    vectors = [[1.0, 0, 0], [1.0, 1e-3, 0]]
    assert frames.orthonormalize(vectors)[1] == 2
    assert frames.orthonormalize(vectors, rtol=1e-2)[1] == 1


def test_batch_equals_loop_and_input_stays(dtype, random):
    vectors = random.standard_normal((3, 5, 2, 4)).astype(dtype)
    vectors[0, 1, 1] = vectors[0, 1, 0]
    kept = vectors.copy()
    frame, rank = frames.orthonormalize(vectors)
    for index in np.ndindex(3, 5):
        one, r = frames.orthonormalize(vectors[index])
        np.testing.assert_allclose(frame[index], one, rtol=0, atol=4 * oracles.eps(dtype))
        assert r == rank[index]
    np.testing.assert_array_equal(vectors, kept)


test_bad_vectors = refusals(
    frames.orthonormalize,
    ([1.0, 0, 0], r"vectors: expected .*shape \(\.\.\., k, n\).*v\[\.\.\., None, :\]"),
    (np.ones((4, 3)), "vectors: expected 0 < k <= n.*shape \\(4, 3\\)"),
    ("abc", "vectors: expected real numbers", TypeError),
    (np.ones((2, 3), complex), "vectors: expected real numbers", TypeError),
    ([[1.0], [2.0, 3.0]], "vectors: expected numbers in rows of equal length", TypeError),
    (np.ones((1, 1)), "n of 2 or more"),
)


def test_bad_rtol():
    with pytest.raises(ValueError, match=r"rtol: expected .* at least 0, got -1"):
        frames.orthonormalize(np.eye(2, 3), rtol=-1.0)


test_bad_frames = refusals(
    lambda frame: frames.split([1.0, 0, 0], frame),
    (np.eye(3), "frame: expected 0 < k < n"),
    ([1.0, 0, 0], r"frame: .*v\[\.\.\., None, :\]"),
    ([[2.0, 0, 0]], "frame: expected orthonormal rows, got rows off by 3.*orthonormalize first"),
    ([[1.0, 0, 0], [1.0, 0, 0]], "frame: expected orthonormal rows"),
    ([[np.nan, 0, 0]], "frame: expected orthonormal rows"),
)


def test_direction_of_another_space():
    with pytest.raises(ValueError, match=r"direction: expected vectors of shape \(\.\.\., 3\)"):
        frames.split([1.0, 0.0], [[1.0, 0, 0]])
