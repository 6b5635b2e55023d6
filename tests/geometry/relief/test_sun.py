"""The sun where almanacs have it, and its disc."""

import numpy as np
import pytest

from vizlight.geometry import sun

EQUINOX, SOLSTICE, WINTER = 79, 172, 355


def test_noon():
    """At noon the sun stands in the south, 90 degrees less latitude plus declination high."""
    for day, declination in ((EQUINOX, 0.0), (SOLSTICE, 23.44), (WINTER, -23.44)):
        for latitude in (0, 46.2, 60):
            way = sun.directions(np.radians(latitude), day, 12)
            height = np.degrees(np.arctan2(way[2], -way[1]))
            assert height == pytest.approx(90 - latitude + declination, abs=0.25)
            assert way[0] == pytest.approx(0, abs=1e-12)


def almanac(days):
    """Return the declination, days after noon of 1 January 2000, in degrees (Almanac C24)."""
    longitude = np.radians(280.460 + 0.9856474 * days)
    anomaly = np.radians(357.528 + 0.9856003 * days)
    longitude += np.radians(1.915 * np.sin(anomaly) + 0.020 * np.sin(2 * anomaly))
    return np.degrees(np.arcsin(np.sin(np.radians(23.439)) * np.sin(longitude)))


@pytest.mark.parametrize("hour", [0, 6, 12, 24])
def test_declination_is_that_of_the_almanac_in_any_year(hour, claim):
    """At the pole the sun is as high as its declination; years differ by their leap days."""
    days = np.arange(1, 366)
    up = [sun.directions(np.pi / 2, day, hour)[2] for day in days]
    for year in range(2001, 2041):
        first = (np.datetime64(f"{year}-01-01") - np.datetime64("2000-01-01")).astype(int) - 0.5
        error = np.degrees(np.arcsin(up)) - almanac(first + days - 1 + hour / 24)
        claim(np.abs(error).max(), 0.21)


def test_day_of_twelve_hours_and_midnight_sun():
    rise = sun.directions(0.8, EQUINOX, [6, 18])
    np.testing.assert_allclose(rise[:, 2], 0, atol=4e-3)
    assert rise[0, 0] > 0.99
    assert rise[1, 0] < -0.99
    assert np.all(sun.directions(np.radians(70), SOLSTICE, np.arange(25))[:, 2] > 0)
    assert np.all(sun.directions(np.radians(70), WINTER, np.arange(25))[:, 2] < 0)


def test_unit_and_shape(random):
    way = sun.directions(-0.6, 33, random.uniform(0, 24, (4, 5)))
    assert way.shape == (4, 5, 3)
    np.testing.assert_allclose(np.linalg.norm(way, axis=-1), 1, atol=1e-15)


@pytest.mark.parametrize("axis", [(0, 0, 2), (1, 2, 3), (-1e-200, 0, 1e-200), (1, 0, 0)])
def test_disc(axis):
    centre = np.array(axis) / max(map(abs, axis))
    centre /= np.linalg.norm(centre)
    way = sun.disc(axis, 0.1, 500)
    angle = np.arccos(np.clip(way @ centre, -1, 1))
    assert angle.max() <= 0.05
    np.testing.assert_allclose(way.mean(axis=0), centre * (way.mean(axis=0) @ centre), atol=1e-4)
    # Of equal area: as many within 1/sqrt(2) of the radius as beyond.
    assert np.count_nonzero(np.tan(angle) < np.tan(0.05) / np.sqrt(2)) == 250


def test_bad_input():
    with pytest.raises(ValueError, match="latitude: expected a number from -1.57"):
        sun.directions(46, 100, 12)
    with pytest.raises(ValueError, match="day: expected a number from 1 to 366"):
        sun.directions(0.5, 0, 12)
    with pytest.raises(ValueError, match="hours: expected hours from 0 to 24"):
        sun.directions(0.5, 1, [25])
    with pytest.raises(ValueError, match="count: expected an integer of at least 1"):
        sun.disc((0, 0, 1), 0.1, 0)
    with pytest.raises(ValueError, match="direction: expected 3 components"):
        sun.disc((0, 1), 0.1, 3)
