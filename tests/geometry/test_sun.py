"""The sun where almanacs have it, and its disc."""

from __future__ import annotations

import numpy as np
import pytest

from vizlight.geometry import sun

EQUINOX, SOLSTICE, WINTER = 79.9, 172, 355


def test_noon():
    """At noon the sun stands in the south, 90 degrees less latitude plus declination high."""
    for day, declination in ((EQUINOX, 0.0), (SOLSTICE, 23.44), (WINTER, -23.44)):
        for latitude in (0, 46.2, 60):
            way = sun.directions(np.radians(latitude), day, 12)
            height = np.degrees(np.arctan2(way[2], -way[1]))
            assert height == pytest.approx(90 - latitude + declination, abs=0.25)
            assert way[0] == pytest.approx(0, abs=1e-12)


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
