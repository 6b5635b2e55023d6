"""Height fields as arguments: nodes, holes, small fields, what does not fit."""

import numpy as np
import pytest
from fields import sun
from refusals import refusals

from vizlight.geometry import relief


def test_holes():
    """A flat field stays flat under holes; with walls, light comes in through them."""
    x = np.arange(21.0)
    z = np.zeros((21, 21))
    z[8:12, 9:13] = np.nan
    way = sun(30, 0)
    t = relief.shadow(x, x, z, depth=0.5, direction=way)
    hole = np.isnan(z)
    assert not t[hole].any()
    np.testing.assert_allclose(t[~hole], 0.5, atol=1e-12)
    wall = relief.shadow(x, x, z, depth=1.0, direction=way, border="wall")
    row = 10
    # The wall stands at x = 8: the ray from depth 1 reaches it before the surface.
    expected = np.where((x <= 8) & (8 - x < 3**0.5), 1 / np.maximum((8 - x) * 2 / 3**0.5, 1), 0.5)
    expected[20 - x < 3**0.5] = 1 / np.maximum((20 - x) * 2 / 3**0.5, 1)[20 - x < 3**0.5]
    np.testing.assert_allclose(wall[row][~hole[row]], expected[~hole[row]], atol=1e-12)


@pytest.mark.parametrize("shape", [(2, 2), (2, 7), (9, 2), (3, 3)])
def test_small_fields(shape, random):
    y, x = (np.arange(float(n)) for n in shape)
    z = random.uniform(0, 0.1, shape)
    for way in (sun(45, 10), sun(5, 200), sun(90, 0)):
        t = relief.shadow(x, y, z, depth=0.1, direction=way)
        assert np.all((t > 0) & (t <= 1))


def test_light_from_below_is_blocked():
    x, z = np.arange(5.0), np.zeros((5, 5))
    for way in ((0, 0, -1), (1, 0, -1e-12)):
        assert not relief.shadow(x, x, z, depth=0.25, direction=way).any()


FLAT = ([0, 1, 2], [0, 1], np.zeros((2, 3)))


UP = {"direction": (0, 0, 1)}


test_bad_input = refusals(
    lambda field, options: relief.shadow(*field, **options),
    (FLAT, {**UP, "depth": -1}, "depth: expected a finite number of at least 0"),
    (FLAT, {**UP, "depth": 1e300}, "depth: expected at most 2e.09, 1e9 times"),
    (FLAT, {**UP, "depth": "1"}, "depth: expected a number", TypeError),
    (FLAT, {"depth": 1}, "direction, position: expected one of them, got neither"),
    (FLAT, {"depth": 1, **UP, "position": (0, 0, 9)}, "got both"),
    (FLAT, {"depth": 1, "direction": (0, 0, 0)}, "direction of non-zero length"),
    (FLAT, {"depth": 1, "direction": (0, 1)}, "direction: expected 3 components"),
    (
        FLAT,
        {"depth": 1, "position": (1, 0.5, -0.1)},
        "position: expected a light outside the solid, above 0 there",
    ),
    (FLAT, {"depth": 1, **UP, "border": "none"}, "border: expected 'extend' or"),
    (FLAT, {"depth": 1, **UP, "normals": np.zeros((3, 3))}, r"normals: .*\(2, 3"),
    (([0, 1], [0, 1], np.full((2, 2), np.nan)), {"depth": 1, **UP}, "NaN every"),
    (([0, 1], [0, 1], [[0, np.inf]] * 2), {"depth": 1, **UP}, "z: expected finite"),
    (([0, 1], [0], np.zeros((1, 2))), {"depth": 1, **UP}, "y: .*repeat the row"),
    (([], [0, 1], np.zeros((2, 0))), {"depth": 1, **UP}, "x: expected two nodes"),
    (([1, 0], [0, 1], np.zeros((2, 2))), {"depth": 1, **UP}, "x: .*rising"),
    (([0, np.nan], [0, 1], np.zeros((2, 2))), {"depth": 1, **UP}, "x: .*finite"),
    (([0, 1], [0, 1, 2], np.zeros((2, 3))), {"depth": 1, **UP}, r"z: .*\(3, 2\)"),
    (([0, 1], [0, 1], [["a"] * 2] * 2), {"depth": 1, **UP}, "z: expected real", TypeError),
    (([0, 1e-80], [0, 1], np.zeros((2, 2))), {"depth": 1, **UP}, "1e-70 and 1e70"),
)


def test_integers_and_lists_are_numbers():
    t = relief.shadow([0, 1, 2], [0, 1], [[0, 1, 0], [0, 1, 0]], depth=1, direction=[0, 0, 1])
    assert t.shape == (2, 3)
