"""Words as triangles: the size of letters, their holes, and words without ink."""

import numpy as np
import pytest

from vizlight.vtk import letters


def area(word):
    """Return the area of the triangles of a word, all with one orientation or zero."""
    points, ids = letters.triangles(word)
    a, b, c = np.moveaxis(points[ids], 1, 0)
    u, v = b - a, c - a
    return np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2


def test_digits_stand_on_the_line_and_are_as_high_as_they_say():
    points, ids = letters.triangles("180°E")
    low, high = points.min(axis=0), points.max(axis=0)
    assert low == pytest.approx((0, 0), abs=0.02)
    assert high[1] == pytest.approx(0.73, abs=0.03)
    assert high[0] == letters.width("180°E") == pytest.approx(2.6, abs=0.4)
    assert ids.max() == len(points) - 1


def test_letters_have_their_holes():
    """A zero has less ink than its outline, and two letters as much as both."""
    points, _ = letters.triangles("0")
    wide, high = np.ptp(points, axis=0)
    ellipse = np.pi / 4 * wide * high
    assert 0.2 * ellipse < area("0") < 0.6 * ellipse
    assert area("NN") == pytest.approx(2 * area("N"), rel=1e-3)
    assert area("I") == pytest.approx(np.prod(np.ptp(letters.triangles("I")[0], axis=0)), rel=0.02)


@pytest.mark.parametrize("word", ["", " "])
def test_words_without_ink(word):
    points, ids = letters.triangles(word)
    assert points.shape == (0, 2)
    assert ids.shape == (0, 3)
    assert letters.width(word) == 0
