"""A day of shadows: hours, directions, what does not fit."""

import numpy as np
import pytest
from fields import grids, level
from refusals import refusals

import vizlight
from vizlight import Light, Scene, relief_day, relief_shadow
from vizlight.geometry import sun


def test_hours_of_a_day():
    grid, _ = grids()["ImageData"]
    out = relief_day(grid, latitude=46.2, day=172, hours=[0, 6, 12, 18], depth=0.1)
    assert out["t"].shape == (63, 4)
    assert not out["t"][:, 0].any()
    noon = sun.directions(np.radians(46.2), 172, 12)
    single = relief_shadow(grid, Scene(lights=Light(direction=noon)), depth=0.1)
    np.testing.assert_array_equal(out["t"][:, 2], single["t"])
    np.testing.assert_allclose(out["t_mean"], out["t"].mean(axis=1))
    given = relief_day(grid, directions=[[0, 0, -1], noon], depth=0.1)
    np.testing.assert_array_equal(given["t"][:, 1], single["t"])
    assert set(given.point_data) == {"height", "t", "t_mean"}


def test_a_latitude_that_may_be_in_radians():
    with pytest.warns(UserWarning, match=r"latitude: 0\.64 is taken for degrees, not radians"):
        relief_day(level(), latitude=0.64, day=172, hours=12)


def test_one_hour_of_a_day():
    grid, _ = grids()["ImageData"]
    when = {"latitude": 40.0, "day": 172}
    one, many = (relief_day(grid, hours=hours, **when) for hours in (12, [12]))
    np.testing.assert_array_equal(one["t"], many["t"])
    assert one["t_mean"].shape == (63,)


test_bad_days = refusals(
    lambda options: relief_day(level(), **options),
    ({"directions": [[[0, 0, 1]]]}, "directions: expected a list of one or more"),
    ({"directions": np.zeros((0, 3))}, "directions: expected a list of one"),
    ({"directions": ()}, "directions: expected vectors"),
    ({"directions": [(0, 0, 0)]}, r"directions\[0\]: expected a direction of non-z"),
    ({"directions": [(0, 0, 1), (0, 0, np.nan)]}, r"directions\[1\]: expected fin"),
    ({"directions": [(0, 0, -1)]}, "directions: expected the sun above the hor"),
    ({"latitude": 0, "day": 9, "hours": [[12]]}, "hours: expected a list of one"),
    ({"latitude": 0, "day": 9, "hours": []}, "hours: expected a list of one"),
    ({"latitude": 29.0}, "latitude, day: expected both, or directions="),
    ({"latitude": 29.0, "day": 1, "hours": [0]}, "hours: expected the sun above .*, got night"),
    ({"directions": [(0, 0, 1)], "day": 4}, "directions: expected directions alone"),
    ({"sun": [1, 2, 3]}, "sun: expected pairs of azimuth and altitude"),
    ({"sun": [1, 2], "directions": [(0, 0, 1)]}, "sun: expected sun alone"),
    ({"latitude": 91, "day": 9}, "latitude: expected a number from -90 to 90"),
    ({"directions": (0, 0, 1), "scene": Scene()}, "scene: expected an option of", TypeError),
    ({"directions": (0, 0, 1), "lit": True}, "lit: expected an option of", TypeError),
)


@pytest.mark.parametrize(
    "when",
    [
        {"latitude": 40.0, "day": 172, "hours": np.array([3.0, 9, 12])},
        {"directions": [(0, 1, 1), (1, 0, -1)]},
    ],
)
def test_a_day_is_made_again_from_what_is_told(when):
    grid, _ = grids()["warped"]
    day = relief_day(grid, depth=0.2, name="sunlit", **when)
    told = vizlight.provenance(day, "sunlit")
    assert told["filter"] == "relief_day"
    again = relief_day(grid, **told["options"])
    np.testing.assert_array_equal(again["sunlit"], day["sunlit"])
    assert vizlight.provenance(again, "sunlit") == told
