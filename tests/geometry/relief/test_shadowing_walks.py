"""Length inside a height field, against rays that are cut at all planes of nodes."""

from itertools import pairwise

import numpy as np
import pytest
from fields import by_cells, followed, hills, places, sun

from vizlight import _compiled, _pool
from vizlight.geometry import relief
from vizlight.geometry.relief import height_field, shadowing

pytestmark = pytest.mark.usefixtures("each_code")


@pytest.mark.parametrize("way", [sun(12, 215), sun(0.01, 12), sun(90, 0), sun(-30, 250)])
@pytest.mark.parametrize("border", ["extend", "wall"])
def test_both_codes_over_squares_are_the_cells(way, border, random):
    """Uneven nodes, holes; every cell one by one, and 2^l x 2^l at once, to rounding."""
    x, y, z = hills(70, 41)
    start = places(x, y, z, 1000, random)
    z[5:9, 10:20] = np.nan
    field = height_field.make(x, y, z, border=border)
    start = (start - field.origin).T.copy()
    one = by_cells(field, start, way)
    np.testing.assert_allclose(followed(shadowing.march, field, start, way), one, atol=1e-11)
    if _compiled.active():
        np.testing.assert_allclose(followed(shadowing.walk, field, start, way), one, atol=1e-11)


@pytest.mark.skipif(bool(_compiled._missing()), reason="numba is not available")
@pytest.mark.parametrize("light", [{"direction": sun(15, 70)}, {"position": (0, 0, 90)}])
def test_numpy_follows_the_rays_that_a_kernel_fails_with(light, monkeypatch):
    def broken(*_):
        raise RuntimeError("LLVM ERROR")

    x, y, z = hills(20, 15)
    monkeypatch.setenv("VIZLIGHT_FAST", "0")
    numpys = relief.shadow(x, y, z, depth=0.1, **light)
    monkeypatch.setattr(_compiled, "_BROKEN", [])
    monkeypatch.setattr(shadowing.walk, "_proven", True)
    monkeypatch.setattr(shadowing.walk, "_compiled", broken)
    monkeypatch.setenv("VIZLIGHT_FAST", "1")
    with pytest.warns(RuntimeWarning, match="LLVM ERROR") as caught:
        found = relief.shadow(x, y, z, depth=0.1, **light)
    assert len(caught) == 1
    np.testing.assert_array_equal(found, numpys)


def test_the_number_of_threads_changes_nothing(monkeypatch):
    monkeypatch.setattr(shadowing, "BLOCK", 300)
    x, y, z = hills(60, 50)
    shade = {"depth": 0.1, "direction": sun(15, 70)}
    with _pool.threads(1):
        one = relief.shadow(x, y, z, **shade)
    with _pool.threads(3):
        np.testing.assert_array_equal(relief.shadow(x, y, z, **shade), one)


def test_a_level_surface_and_one_that_the_light_grazes():
    """Bounds that are equal to the level of the rays decide nothing wrongly."""
    x = np.arange(40.0)
    slope = np.repeat(np.tan(np.radians(10)) * x[None], 40, axis=0)
    # Light along the slope never leaves the solid before the border, or lies on it.
    down = relief.shadow(x, x, slope, depth=1e-3, direction=sun(10, 180))
    np.testing.assert_allclose(down[5:-5, 5:-5], np.sin(np.radians(20)), atol=1e-9)
    assert relief.shadow(x, x, slope, depth=0.5, direction=sun(10, 0))[:, 3].max() < 0.02


def brute(x, y, z, start, way, *, wall, reach=1e3):
    """Return the length inside of one ray, cut at all planes of nodes: a closed solid, no cells.

    Between two planes the height below the surface is a quadratic, known from three places; in a
    plane of nodes it is that of any cell beside it that has a surface.
    """
    cuts = [0.0, reach]
    for nodes, p, w in ((x, start[0], way[0]), (y, start[1], way[1])):
        cuts += [s for s in (nodes - p) / w if 0 < s < reach] if abs(w) > 1e-12 else []
    cuts, total = np.unique(cuts), 0.0
    for low, high in pairwise(cuts):
        three = start + np.array([low, (low + high) / 2, high])[:, np.newaxis] * way
        if not wall:
            three[:, :2] = np.clip(three[:, :2], (x[0], y[0]), (x[-1], y[-1]))
        beside = [
            [k for k in range(len(n) - 1) if n[k] - 1e-9 <= at <= n[k + 1] + 1e-9]
            for n, at in ((x, three[1, 0]), (y, three[1, 1]))
        ]
        corners = [(i, j, z[j : j + 2, i : i + 2]) for i in beside[0] for j in beside[1]]
        solid = [each for each in corners if np.isfinite(each[2]).all()]
        if high - low < 1e-12 or not solid:
            continue
        i, j, ((a, b), (c, d)) = solid[0]
        u, v = (three[:, 0] - x[i]) / (x[i + 1] - x[i]), (three[:, 1] - y[j]) / (y[j + 1] - y[j])
        f = a * (1 - u) * (1 - v) + b * u * (1 - v) + c * (1 - u) * v + d * u * v - three[:, 2]
        two, one = 2 * (f[0] - 2 * f[1] + f[2]), -3 * f[0] + 4 * f[1] - f[2]
        two = two if abs(two) > 1e-10 * abs(one) else 0.0
        roots = np.roots([two, one, f[0]]) if abs(two) + abs(one) > 1e-12 else np.zeros(0)
        ends = np.unique([0, *(r.real for r in roots if abs(r.imag) < 1e-9 and 0 < r.real < 1), 1])
        middle = (ends[:-1] + ends[1:]) / 2
        inside = f[0] + middle * (one + middle * two) > 1e-10
        total += (high - low) * np.sum(np.diff(ends)[inside])
    return total


@pytest.mark.sampled(3)
@pytest.mark.parametrize("azimuth", [0, 90, 180, 270])
@pytest.mark.parametrize("kind", ["extend", "wall", "holes"])
def test_walls_are_part_of_the_solid(kind, azimuth, random):
    """Rough fields of integer heights, where rays run in planes of nodes and of walls."""
    x, y = np.arange(6.0), np.arange(5.0)
    z = random.integers(0, 4, (5, 6)).astype(float)
    if kind == "holes":
        z[[1, 3, 4], [4, 1, 3]] = np.nan
    places = np.stack(np.meshgrid(x, y, [-0.5, 0.25, 1.75]), axis=-1).reshape(-1, 3)
    border = "extend" if kind == "extend" else "wall"
    for elevation in (20, 45, 90):
        way = sun(elevation, azimuth)
        found = relief.inside_length(x, y, z, places, direction=way, border=border)
        expected = [brute(x, y, z, place, way, wall=border == "wall") for place in places]
        np.testing.assert_allclose(found, expected, atol=1e-9)
    lamps = places + 12 * sun(30, azimuth)
    for place, at in zip(places[::7], lamps[::7], strict=True):
        (length,) = relief.inside_length(x, y, z, [place], position=at, border=border)
        ahead = brute(x, y, z, place, sun(30, azimuth), wall=border == "wall")
        assert length == pytest.approx(ahead, abs=1e-9)


@pytest.mark.parametrize("border", ["extend", "wall"])
def test_uneven_hills_from_beside_below_and_toward_a_lamp(border, random):
    x, y, z = hills(25, 31)
    points = places(x, y, z, 12, random)
    points[:3, 0] -= 12
    for way in (sun(40, 30), sun(8, 200), sun(0, 77), sun(-20, 140)):
        found = relief.inside_length(x, y, z, points, direction=3 * way, border=border)
        for point, length in zip(points, found, strict=True):
            expected = brute(x, y, z, point, way, wall=border == "wall")
            assert expected > 500 if np.isinf(length) else abs(length - expected) < 1e-8
    lamp = np.array([7.0, 3.0, 2.5])
    found = relief.inside_length(x, y, z, points, position=lamp, border=border)
    for point, length in zip(points, found, strict=True):
        reach = np.linalg.norm(lamp - point)
        way = (lamp - point) / reach
        expected = brute(x, y, z, point, way, wall=border == "wall", reach=reach)
        assert length == pytest.approx(expected, abs=1e-8)
