"""Where the sun stands, and the disc that it is."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight import _check

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vizlight._types import VectorLike

__all__ = ["DIAMETER", "directions", "disc"]

#: The sun's mean angular diameter, in radians.
DIAMETER = np.radians(0.53)


def directions(latitude: float, day: float, hours: ArrayLike, /) -> Any:
    """Return unit directions toward the sun.

    Parameters
    ----------
    latitude : float
        In radians, north positive, from -pi/2 to pi/2.
    day : float
        Of the year, from 1 to 366.
    hours : array_like, shape (...)
        Of true solar time, 12 when the sun is highest.

    Returns
    -------
    ndarray, shape (..., 3)
        East, north, up; up is negative at night.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Notes
    -----
    The sun's ecliptic longitude is its mean one and the equation of the centre, from elements
    averaged over the years 2001 to 2040. As no year is told, the declination is up to 0.2
    degrees off near an equinox, for leap days alone, and half a day's turn of the earth as much
    again; the disc is 0.53 degrees wide.
    Refraction, which lifts a setting sun by 0.01 radians, is left out.
    """
    latitude = _check.number("latitude", latitude, low=-np.pi / 2, high=np.pi / 2)
    day = _check.number("day", day, low=1.0, high=366.0)
    times = _check.floats("hours", hours).astype(np.float64)
    if not np.all((times >= 0) & (times <= 24)):
        raise ValueError(_check.message("hours", "hours from 0 to 24", _check.describe(hours)))
    year = 2 * np.pi * (day - 1 + times / 24) / 365.2422
    anomaly = np.radians(357.21) + year
    longitude = np.radians(280.50) + year
    longitude += np.radians(1.9147 * np.sin(anomaly) + 0.0200 * np.sin(2 * anomaly))
    declination = np.arcsin(np.sin(np.radians(23.4367)) * np.sin(longitude))
    angle = (times - 12) * np.pi / 12
    sine, cosine = np.sin(declination), np.cos(declination)
    east = -cosine * np.sin(angle)
    north = np.cos(latitude) * sine - np.sin(latitude) * cosine * np.cos(angle)
    up = np.sin(latitude) * sine + np.cos(latitude) * cosine * np.cos(angle)
    return np.stack(np.broadcast_arrays(east, north, up), axis=-1)


def disc(direction: VectorLike, diameter: float, count: int, /) -> Any:
    """Return directions that are spread evenly over a disc of the sky.

    Parameters
    ----------
    direction : vector of 3 components
        Toward its centre.
    diameter : float
        In radians, from 0 to 1.
    count : int
        1 or more.

    Returns
    -------
    ndarray, shape (count, 3)
        Unit directions, each for an equal area; their mean is near the centre.

    Notes
    -----
    A sunflower's spiral: radius by the square root, angle by the golden section.
    """
    axis = np.array(_check.vector("direction", direction, direction=True))
    axis = axis / np.abs(axis).max()
    axis /= np.linalg.norm(axis)
    if len(axis) != 3:
        raise ValueError(_check.message("direction", "3 components", len(axis)))
    diameter = _check.number("diameter", diameter, low=0.0, high=1.0)
    count = _check.integer("count", count, low=1)
    least = np.zeros(3)
    least[np.abs(axis).argmin()] = 1
    side = np.cross(axis, least)
    side /= np.linalg.norm(side)
    k = np.arange(count)
    radius = np.tan(diameter / 2) * np.sqrt((k + 0.5) / count)
    angle = k * np.pi * (3 - np.sqrt(5))
    spread = np.outer(np.cos(angle) * radius, side)
    spread += np.outer(np.sin(angle) * radius, np.cross(axis, side))
    way = axis + spread
    return way / np.linalg.norm(way, axis=1, keepdims=True)
