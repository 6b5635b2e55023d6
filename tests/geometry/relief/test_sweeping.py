"""Lengths by profiles along the light: bands, levels, rays from anywhere."""

from __future__ import annotations

import numpy as np
import pytest
from fields import METHODS, hills, sun

from vizlight.geometry import relief
from vizlight.geometry.relief import height_field, sweeping


@pytest.fixture(autouse=True)
def _profiles(monkeypatch):
    """With compiled code there are no profiles."""
    monkeypatch.setenv("VIZLIGHT_FAST", "0")


@pytest.mark.parametrize("border", ["extend", "wall"])
def test_fast_rays_may_start_anywhere(border, random):
    """Far beside and below the field, above it, light at any height."""
    x, y, z = hills(40, 30)
    points = random.uniform([-6, -6, -6], [16, 16, 3], (500, 3))
    for way in (sun(12, 20), sun(70, 110), sun(30, 200), sun(45, 305), sun(5, 0), sun(60, 90)):
        fast, exact = (
            relief.inside_length(x, y, z, points, direction=way, border=border, method=method)
            for method in METHODS
        )
        assert np.all(np.isfinite(fast))
        assert np.median(np.abs(fast - exact)) < 2e-3
        assert np.mean(np.abs(fast - exact)) < 0.1


@pytest.mark.parametrize("border", ["extend", "wall"])
def test_bands_of_profiles_change_nothing(border, monkeypatch):
    """One band for all rays, or many narrow ones; holes and uneven nodes."""
    x, y, z = hills(32, 26)
    z[10:14, 20:26] = np.nan
    for way in (sun(12, 20), sun(9, 110), sun(15, 200), sun(14, 305), sun(8, 0), sun(10, 90)):
        field = height_field.make(x, y, z, border=border)
        profiles = sweeping.profiles(field, way, 0.2)
        assert profiles.count > 10 * sweeping.NARROW
        one = relief.shadow(x, y, z, depth=0.2, direction=way, border=border)
        with monkeypatch.context() as patch:
            patch.setattr(sweeping, "BAND", 1)
            assert profiles.width(z.size) == sweeping.NARROW
            many = relief.shadow(x, y, z, depth=0.2, direction=way, border=border)
        np.testing.assert_allclose(many, one, atol=1e-13)


def test_levels_are_followed_as_by_single_columns(random):
    """Rays through random profiles, in uneven columns, against a loop over segments."""
    x = np.sort(random.uniform(0, 30, 70))
    z = np.repeat(random.uniform(0, 3, (1, 70)), 5, axis=0)
    way = sun(6, 0)
    start = np.column_stack(
        [random.uniform(x[0], x[-1], 300), np.full(300, 2.0), random.uniform(-2, 3, 300)]
    )
    field = height_field.make(x, np.arange(5.0), z, border="extend")
    assert sweeping.profiles(field, way, 2.0) is not None
    found = relief.inside_length(x, np.arange(5.0), z, start, direction=way)
    edge = np.append(x, x[-1] + 100)
    for (a, _, c), length in zip(start, found, strict=True):
        s = np.sort(np.append(edge[edge > a], a))
        f = np.interp(s, x, z[0]) - (c + (s - a) * way[2] / way[0])
        high, low = np.maximum(f[:-1], f[1:]), np.minimum(f[:-1], f[1:])
        share = np.clip(high / np.where(high > low, high - low, 1), 0, 1)
        expected = np.where(low >= 0, 1, share) @ np.diff(s) / way[0]
        assert length == pytest.approx(expected, abs=1e-9)
