"""Compiled lengths: strips and squares against the NumPy walk, cell by cell."""

from __future__ import annotations

import numpy as np
import pytest
from fields import hills, places, sun

from vizlight import _compiled
from vizlight.geometry import relief
from vizlight.geometry.relief import compiled, height_field, marching

pytestmark = pytest.mark.skipif(not _compiled.active(), reason="numba is not available")


@pytest.fixture(autouse=True)
def _compile(monkeypatch):
    monkeypatch.setenv("VIZLIGHT_FAST", "1")


def by_cells(field, start, way):
    """Return lengths by NumPy, through every cell."""
    count = start.shape[1]
    ways = np.repeat(way[:, None], count, axis=1)
    return marching.march(field, start, ways, np.full(count, marching.FAR), coarse=False)


@pytest.mark.parametrize("azimuth", [0, 30, 90, 133, 180, 200, 270, 301])
@pytest.mark.parametrize("elevation", [0.3, 4, 25, 80])
def test_strips_are_the_cells(azimuth, elevation, random):
    """Uneven nodes, holes, and rays from below, beside, behind and above the field."""
    x, y, z = hills(37, 28)
    z[5:9, 10:20] = np.nan
    field = height_field.make(x, y, z, base=None, border="extend")
    count = 3000
    start = (places(x, y, np.nan_to_num(z), count, random) - field.origin).T.copy()
    start[:2, ::3] += random.uniform(-3, 3, (2, count // 3))
    way = sun(elevation, azimuth)
    strips = compiled.Strips(field, way, 6.0)
    index = strips.profile_index(start)
    assert 0 <= index.min() < index.max() < strips.count
    found = strips.lengths(start)
    np.testing.assert_allclose(found, by_cells(field, start, way), atol=1e-11)
    assert np.ptp(found) > 1


@pytest.mark.parametrize("way", [sun(0.01, 12), sun(90, 0), sun(88, 40), sun(-30, 250)])
@pytest.mark.parametrize("border", ["extend", "wall"])
def test_squares_are_the_cells(way, border, random):
    x, y, z = hills(37, 28)
    field = height_field.make(x, y, z, base=-3.0, border=border)
    start = (places(x, y, z, 500, random) - field.origin).T.copy()
    found = np.empty(500)
    ways = np.repeat(way[:, None], 500, axis=1)
    compiled.walk(
        start, ways, np.full(500, marching.FAR), *field.edges, field.corners,
        compiled.levels(field.bounds), field.base, field.top, found,
    )  # fmt: skip
    np.testing.assert_allclose(found, by_cells(field, start, way), atol=1e-11)


def test_fast_is_exact_whatever_the_number_of_threads():
    x, y, z = hills(60, 50)
    shade = {"depth": 0.1, "direction": sun(15, 70)}
    one = relief.shadow(x, y, z, threads=1, **shade)
    np.testing.assert_array_equal(relief.shadow(x, y, z, threads=3, **shade), one)
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


@pytest.mark.parametrize("light", [{"direction": sun(15, 70)}, {"position": (0, 0, 90)}])
def test_numpy_follows_the_rays_that_a_kernel_fails_with(light, monkeypatch):
    def broken(*_):
        raise RuntimeError("LLVM ERROR")

    x, y, z = hills(20, 15)
    with _compiled.setting("0"):
        numpys = relief.shadow(x, y, z, depth=0.1, **light)
    monkeypatch.setattr(_compiled, "_BROKEN", [])
    for kernel in (compiled.walk, compiled.follow):
        monkeypatch.setattr(kernel, "_proven", True)
        monkeypatch.setattr(kernel, "_compiled", broken)
    with pytest.warns(RuntimeWarning, match="LLVM ERROR") as caught:
        found = relief.shadow(x, y, z, depth=0.1, **light)
    assert len(caught) == 1
    np.testing.assert_array_equal(found, numpys)
