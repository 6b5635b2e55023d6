"""Every validator lets good values pass and refuses bad ones by name."""

import contextlib
import warnings
from fractions import Fraction

import numpy as np
import pytest
import pyvista as pv
from pyvista.plotting.colors import color_synonyms, hex_colors
from refusals import refusals

from vizlight import _check
from vizlight.shading.options import LightOptions


@pytest.mark.parametrize(
    ("validate", "value", "expected"),
    [
        (lambda n, v: _check.number(n, v, low=0), 2, 2.0),
        (_check.number, np.float32(1.5), 1.5),
        (_check.number, np.array(3.0), 3.0),
        (lambda n, v: _check.integer(n, v, low=1), np.int64(4), 4),
        (_check.vector, np.array([1, 2, 3]), (1.0, 2.0, 3.0)),
        (lambda n, v: _check.vector(n, v, direction=True), [0, 1e-300], (0.0, 1e-300)),
        (_check.optional_vector, None, None),
        (_check.color, [0, 0.5, 1], (0.0, 0.5, 1.0)),
        (_check.color, "#ff0000", (1.0, 0.0, 0.0)),
        (_check.color, pv.Color("lime"), (0.0, 1.0, 0.0)),
        (_check.color, None, None),
    ],
)
def test_good_values(validate, value, expected):
    assert validate("x", value) == expected


test_bad_values = refusals(
    lambda validate, value: validate("x", value),
    (lambda n, v: _check.number(n, v, low=0), -1, "at least 0, got -1"),
    (lambda n, v: _check.number(n, v, low=0, high=1), 2, "from 0 to 1, got 2"),
    (_check.number, np.inf, "a finite number, got inf"),
    # Numbers beyond the largest, and beyond what Python writes.
    (lambda n, v: _check.number(n, 10**v), 5000, "got an integer of more digits"),
    (_check.number, 10**400, "a finite number, got 1000000"),
    (lambda n, v: _check.number(n, Fraction(10**v, 7)), 5000, "a number of more"),
    (_check.number, np.ma.masked, "a number, got an array", TypeError),
    (_check.number, True, "a number, got True", TypeError),
    (_check.number, [1.0], "a number", TypeError),
    (lambda n, v: _check.integer(n, v, low=1), 0, "at least 1, got 0"),
    (lambda n, v: _check.integer(n, v, low=1), 1.0, "an integer, got 1.0", TypeError),
    (_check.vector, [1.0], "n of 2 or more"),
    (_check.vector, np.ones((2, 3)), "one vector"),
    (_check.vector, [1, np.nan, 0], "finite components"),
    (lambda _, v: _check.vector("position", v), [np.inf, 0, 0], "pass direction="),
    (lambda n, v: _check.vector(n, v, direction=True), [0, 0, 0], "non-zero"),
    (_check.vector, "abc", "real numbers, got 'abc'", TypeError),
    (_check.vectors, [[1, 2], [3]], "numbers in rows of equal length", TypeError),
    (_check.color, [1, 2], "three channels"),
    (_check.color, [0, -1, 0], "three channels"),
    (_check.color, [255, 0, 0], "three channels .*divide bytes by 255"),
    (_check.color, "no such colour", "a colour's name"),
    (lambda n, v: _check.instance(n, v, int), "s", "a vizlight.int, got 's'", TypeError),
)


def test_types_of_floats():
    assert _check.floats("x", [1, 2]).dtype == np.float64
    assert _check.floats("x", np.float16(1)).dtype == np.float32
    assert _check.floats("x", np.float32(1)).dtype == np.float32


def test_long_values_are_shortened():
    assert len(_check.describe("x" * 500)) <= 60
    assert _check.describe(np.ones((2, 3))) == "an array of shape (2, 3) and type float64"
    assert _check.describe(np.float64(95)) == "95.0"


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.int64, np.bool_])
def test_masked_elements_are_nan(dtype):
    given = np.ma.array(np.ones((3, 3), dtype), mask=np.eye(3))
    for read in (_check.floats, _check.vectors):
        found = read("x", given)
        assert not isinstance(found, np.ma.MaskedArray)
        np.testing.assert_array_equal(np.isnan(found), np.eye(3))
    assert np.array_equal(given.data, np.ones((3, 3)))
    assert not np.isnan(_check.floats("x", np.ma.array(np.ones(3, dtype)))).any()


def test_colours_have_the_names_of_pyvista():
    for name in [*hex_colors, *color_synonyms, "Alice-Blue", "#12aBcd", "0x102030", "11223344"]:
        assert _check.color("color", name) == pv.Color(name).float_rgb, name


def test_flags_become_truth_values():
    assert LightOptions(line_field=1).line_field is True
    assert LightOptions(components=np.False_).components is False


def test_warnings_are_held_until_a_block_ends_well():
    def reading():
        with _check.held():
            _check.warn("first")
            with contextlib.suppress(ValueError), _check.held():
                _check.warn("of what failed")
                raise ValueError
            _check.warn("second")

    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        reading()
    assert [str(one.message) for one in heard] == ["first", "second"]
    assert heard[0].filename == __file__
