"""Planes and ranges by text and by numbers, and options that cannot be taken."""

import math

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.looks import cuts
from vizlight.looks.options import CHECKS


def test_a_text_and_numbers_are_one_plane():
    normal, origin = cuts.plane("slice", "0,0,2:3")
    np.testing.assert_allclose(origin, (0, 0, 3))
    assert cuts.plane("slice", ((0, 0, 2), [0, 0, 3])) == (normal, (0, 0, 3))
    assert cuts.plane("slice", "-Y:1") == ((0, -1, 0), (0, -1, 0))


def test_a_text_and_numbers_are_one_range():
    assert cuts.interval("threshold", "a:b:0:1") == ("a:b", 0, 1)
    assert cuts.interval("threshold", "T::2") == ("T", -math.inf, 2)
    assert cuts.interval("threshold", ("T", -math.inf, 2)) == ("T", -math.inf, 2)
    one, two = ("T", 0, 1), "T:0:1"
    assert cuts.several("threshold", [one, two], cuts.interval) == [("T", 0.0, 1.0)] * 2
    assert cuts.several("threshold", one, cuts.interval) == [("T", 0.0, 1.0)]


@pytest.mark.parametrize("text", ["z", "0,0,0:1", "z:nan", ":1", "1,2:3", ""])
def test_texts_that_are_no_plane(text):
    with pytest.raises(ValueError, match="slice: expected NORMAL:OFFSET"):
        cuts.plane("slice", text)


@pytest.mark.parametrize("value", ["T", "T::", "T:2:1", "T:a:b", ("T", 2, 1), ("T", 1)])
def test_what_is_no_range(value):
    with pytest.raises(ValueError, match="threshold: expected"):
        cuts.interval("threshold", value)


@pytest.mark.parametrize("name", CHECKS)
def test_options_that_cannot_be_taken_are_named(name):
    grid = pv.ImageData(dimensions=(3, 3, 3))
    grid["T"] = np.arange(27.0)
    others = {"contour": "T"} if name == "level" else {}
    for odd in (object(), np.zeros(7), b"x", {}):
        with pytest.raises((TypeError, ValueError), match=f"^{name}: expected"):
            vizlight.look(grid, **others, **{name: odd})
