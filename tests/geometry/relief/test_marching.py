"""Length inside a height field, cell by cell, against quadrature along the ray."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fields import METHODS, hills, places, sun, unit
from scipy.interpolate import RegularGridInterpolator

from vizlight.geometry import relief
from vizlight.geometry.relief import height_field, marching

pytestmark = pytest.mark.usefixtures("each_code")


def quadrature(x, y, z, start, way, reach, step=4e-4, base=-np.inf, wall=False):
    """Return the length inside by sampling one ray: no cells, no roots."""
    if way[2] > 0:
        # Above the highest point there is nothing to be in.
        reach = min(reach, max((z.max() - start[2]) / way[2], 1e-9))
    surface = RegularGridInterpolator((y, x), z)
    count = math.ceil(reach / step)
    s = (np.arange(count) + 0.5) * reach / count
    p = start + s[:, None] * way
    beside = np.stack([np.clip(p[:, 1], y[0], y[-1]), np.clip(p[:, 0], x[0], x[-1])], axis=1)
    inside = (p[:, 2] < surface(beside)) & (p[:, 2] > base)
    if wall:
        inside &= (p[:, 0] > x[0]) & (p[:, 0] < x[-1]) & (p[:, 1] > y[0]) & (p[:, 1] < y[-1])
    return np.count_nonzero(inside) * reach / count


@pytest.mark.parametrize("border", ["extend", "wall"])
@pytest.mark.parametrize("base", [None, -0.25])
def test_exact_length_is_that_of_ray_marching(border, base, random):
    """Uneven nodes, places beside and below the field, light high, low, along an axis, below."""
    x, y, z = hills(25, 31)
    points = places(x, y, z, 12, random)
    low = -np.inf if base is None else base
    for way in (sun(40, 30), sun(8, 200), sun(25, 90), sun(0, 77), sun(90, 0), sun(-20, 140)):
        if way[2] <= 0 and base is None and border == "extend":
            continue
        found = relief.inside_length(
            x, y, z, points, direction=3 * way, base=base, border=border, method="exact"
        )
        for point, length in zip(points, found, strict=True):
            reach = 40.0
            expected = quadrature(x, y, z, point, way, reach, base=low, wall=border == "wall")
            if np.isinf(length):
                assert expected > 20
            else:
                assert length == pytest.approx(expected, abs=2.5e-3)


@pytest.mark.parametrize("method", METHODS)
def test_length_to_a_near_light_is_that_of_ray_marching(method, random):
    x, y, z = hills(25, 31)
    light = np.array([7.0, 3.0, 2.5])
    points = places(x, y, z, 30, random)
    found = relief.inside_length(x, y, z, points, position=light, method=method)
    for point, length in zip(points, found, strict=True):
        reach = np.linalg.norm(light - point)
        expected = quadrature(x, y, z, point, unit(light - point), reach, step=8e-5)
        assert length == pytest.approx(expected, abs=2e-4)


def test_large_squares_change_nothing(random):
    """Every cell one by one, and 2^l x 2^l at once, to rounding."""
    x, y, z = hills(70, 41)
    field = height_field.make(x, y, z, base=None, border="extend")
    start = (places(x, y, z, 2000, random) - field.origin).T
    way = np.repeat(sun(12, 215)[:, None], 2000, axis=1)
    reach = np.full(2000, marching.FAR)
    one, many = (marching.march(field, start, way, reach, coarse=c) for c in (False, True))
    np.testing.assert_allclose(one, many, atol=64 * 2.2e-16 * 10)
    assert one.max() > 3
