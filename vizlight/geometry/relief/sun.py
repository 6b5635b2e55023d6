"""Directions toward the sun, and toward points of its disc."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array, VectorLike
from vizlight.geometry import axial

__all__ = ["DIAMETER", "directions", "disc", "toward"]

#: Mean angular diameter of the sun, in radians.
DIAMETER = np.radians(0.53)


def directions(latitude: float, day: float, hours: ArrayLike, /) -> Array:
    """Return unit directions toward the sun.

    Parameters
    ----------
    latitude : float
        Latitude in radians, north positive, from -pi/2 to pi/2.
    day : float
        Day of the year, from 1 to 366.
    hours : array_like, shape (...)
        Hours of true solar time, from 0 to 24; at 12 the sun is highest.

    Returns
    -------
    ndarray, shape (..., 3)
        Components east, north and up; up is negative at night.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid.

    Notes
    -----
    The ecliptic longitude of the sun is its mean longitude plus the equation of the centre, with
    elements averaged over the years 2001 to 2040. Because the year is not an argument, leap days
    make the declination wrong by up to 0.21 degrees near an equinox, and half a day's rotation of
    the earth by as much again; the disc of the sun is 0.53 degrees wide. Refraction, which raises a
    setting sun by 0.01 radians, is neglected.
    """
    latitude = _check.number("latitude", latitude, low=-np.pi / 2, high=np.pi / 2)
    day = _check.number("day", day, low=1.0, high=366.0)
    times = _check.floats("hours", hours).astype(np.float64)
    if not np.all((times >= 0) & (times <= 24)):
        raise _check.value_error("hours", "hours from 0 to 24", _check.describe(hours))
    # Angle since the start of the year; a tropical year has 365.2422 days.
    year = 2 * np.pi * (day - 1 + times / 24) / 365.2422
    # Mean anomaly and mean longitude, whose values at the start of the year are in degrees.
    anomaly = np.radians(357.21) + year
    longitude = np.radians(280.50) + year
    # Equation of the centre: near perihelion, in January, the earth goes faster than its mean.
    longitude += np.radians(1.9147 * np.sin(anomaly) + 0.0200 * np.sin(2 * anomaly))
    # The earth's axis leans by the obliquity of the ecliptic, 23.4367 degrees.
    declination = np.arcsin(np.sin(np.radians(23.4367)) * np.sin(longitude))
    # Hour angle: 0 at true noon, and positive in the afternoon, when the sun is in the west.
    angle = (times - 12) * np.pi / 12
    sine, cosine = np.sin(declination), np.cos(declination)
    east = -cosine * np.sin(angle)
    north = np.cos(latitude) * sine - np.sin(latitude) * cosine * np.cos(angle)
    up = np.sin(latitude) * sine + np.cos(latitude) * cosine * np.cos(angle)
    return np.stack(np.broadcast_arrays(east, north, up), axis=-1)


def toward(azimuth: ArrayLike, altitude: ArrayLike, /) -> Array:
    """Return unit directions toward the sun from its angles on a map.

    Parameters
    ----------
    azimuth : array_like, shape (...)
        Angles in degrees, clockwise from north: 90 is east.
    altitude : array_like, shape (...)
        Angles above the horizon in degrees, from -90 to 90.

    Returns
    -------
    ndarray, shape (..., 3)
        Components east (x), north (y) and up (z).

    Raises
    ------
    TypeError, ValueError
        If an angle is not a finite number, or an altitude is outside [-90, 90].

    Examples
    --------
    >>> toward(270, 30).round(3).tolist()
    [-0.866, -0.0, 0.5]
    """
    around = _check.floats("azimuth", azimuth).astype(np.float64)
    above = _check.floats("altitude", altitude).astype(np.float64)
    if not np.all(np.isfinite(around)):
        raise _check.value_error("azimuth", "finite angles", _check.describe(azimuth))
    if not np.all(np.abs(above) <= 90):
        raise _check.value_error("altitude", "degrees from -90 to 90", _check.describe(altitude))
    # Whole turns are taken off in degrees: in radians they are no floating-point number.
    turn, rise = _check.together(azimuth=np.radians(around % 360), altitude=np.radians(above))
    east, north = np.cos(rise) * np.sin(turn), np.cos(rise) * np.cos(turn)
    return np.stack([east, north, np.sin(rise)], axis=-1)


def disc(direction: VectorLike, diameter: float, count: int, /) -> Array:
    """Return directions that are spread evenly over a disc of the sky.

    Parameters
    ----------
    direction : vector of 3 components
        Direction toward the centre of the disc.
    diameter : float
        Angular diameter in radians, from 0 to 1.
    count : int
        Number of directions, 1 or more.

    Returns
    -------
    ndarray, shape (count, 3)
        Unit directions, each representing an equal area; their mean is near the centre.

    Notes
    -----
    The directions follow a sunflower's spiral: the radius grows as a square root and the angle by
    the golden angle.
    """
    axis = _check.unit("direction", direction)
    diameter = _check.number("diameter", diameter, low=0.0, high=1.0)
    count = _check.integer("count", count, low=1)
    side, other = axial.frame(axis)
    k = np.arange(count)
    # In the plane that touches the sphere of directions at the centre of the disc.
    radius = np.tan(diameter / 2) * np.sqrt((k + 0.5) / count)
    angle = k * np.pi * (3 - np.sqrt(5))
    spread = np.outer(np.cos(angle) * radius, side)
    spread += np.outer(np.sin(angle) * radius, other)
    way = axis + spread
    unit: Array = way / np.linalg.norm(way, axis=1, keepdims=True)
    return unit
