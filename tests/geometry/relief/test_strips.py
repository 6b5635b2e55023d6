"""Lengths by strips of a light at infinity: compiled code against the NumPy walk, cell by cell."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from fields import by_cells, hills, places, sun

from vizlight import _compiled, _pool
from vizlight.geometry import relief
from vizlight.geometry.relief import height_field, strips

pytestmark = pytest.mark.skipif(not _compiled.active(), reason="numba is not available")


@pytest.fixture(autouse=True)
def _compile(monkeypatch):
    monkeypatch.setenv("VIZLIGHT_FAST", "1")


def by_strips(field, start, way, below):
    found = np.full(start.shape[1], np.nan)
    made = strips.Strips(field, way, below)
    order, ends = made.order(made.band(start, 2), 2)
    for first, last in pairwise(ends):
        made.write(start[:, order[first:last]], order[first:last], found)
    return found


@pytest.mark.parametrize("azimuth", [0, 30, 90, 133, 180, 200, 270, 301])
@pytest.mark.parametrize("elevation", [0.3, 4, 25, 80])
def test_strips_are_the_cells(azimuth, elevation, random):
    """Uneven nodes, holes, and rays from below, beside, behind and above the field."""
    x, y, z = hills(37, 28)
    z[5:9, 10:20] = np.nan
    field = height_field.make(x, y, z, border="extend")
    count = 3000
    start = (places(x, y, np.nan_to_num(z), count, random) - field.origin).T.copy()
    start[:2, ::3] += random.uniform(-3, 3, (2, count // 3))
    way = sun(elevation, azimuth)
    found = by_strips(field, start, way, 6.0)
    np.testing.assert_allclose(found, by_cells(field, start, way), atol=1e-11)
    assert np.ptp(found) > 1


@pytest.mark.parametrize("way", [(1.0, 0.0, 0.2), (0.0, -1.0, 0.2), (-1.0, 1.0, 0.5)])
def test_rays_along_rows_columns_and_diagonals(way, random):
    """Rays that run exactly on the edges of cells and through their corners, and equal levels."""
    x = np.arange(24.0)
    z = np.round(random.uniform(0, 3, (20, 24)))
    z[8:14, 6:18] = 1.0
    field = height_field.make(x, x[:20], z, border="extend")
    row, column = np.divmod(np.arange(z.size), 24)
    start = np.stack([x[column], x[row], z.ravel() - 0.5])
    way = np.array(way) / np.linalg.norm(way)
    found = by_strips(field, start, way, 0.5)
    np.testing.assert_allclose(found, by_cells(field, start, way), atol=1e-12)


def test_fast_is_exact_whatever_the_number_of_threads(monkeypatch):
    monkeypatch.setattr(strips, "BAND", 300)
    x, y, z = hills(60, 50)
    shade = {"depth": 0.1, "direction": sun(15, 70)}
    with _pool.threads(1):
        one = relief.shadow(x, y, z, **shade)
    with _pool.threads(3):
        np.testing.assert_array_equal(relief.shadow(x, y, z, **shade), one)
    np.testing.assert_array_equal(relief.shadow(x, y, z, method="exact", **shade), one)


def test_a_level_surface_and_one_that_the_light_grazes():
    """Bounds that are equal to the level of the rays decide nothing wrongly."""
    x = np.arange(40.0)
    slope = np.repeat(np.tan(np.radians(10)) * x[None], 40, axis=0)
    flat = relief.shadow(x, x, 0 * slope, depth=1.5, direction=sun(10, 0))
    np.testing.assert_allclose(flat, np.sin(np.radians(10)), atol=1e-13)
    # Light along the slope never leaves the solid before the border, or lies on it.
    down = relief.shadow(x, x, slope, depth=1e-3, direction=sun(10, 180))
    np.testing.assert_allclose(down[5:-5, 5:-5], np.sin(np.radians(20)), atol=1e-9)
    assert relief.shadow(x, x, slope, depth=0.5, direction=sun(10, 0))[:, 3].max() < 0.02
