"""Coasts: where capes are, land against water, the sides of maps, and turns around the earth."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals

import vizlight
from vizlight.mesh.coasts import coasts

EARTH = (-180.0, 180.0, -90.0, 90.0)
#: Capes with their longitudes and latitudes, by the charts of their coasts.
CAPES = {
    "Horn": (-67.27, -55.98), "Agulhas": (20.00, -34.83), "Roca": (-9.50, 38.78),
    "York": (142.53, -10.69), "Farewell": (-43.92, 59.78), "Hafun": (51.41, 10.44),
    "Leeuwin": (115.14, -34.37), "Comorin": (77.55, 8.08), "Skagen": (10.64, 57.75),
    "Branco": (-34.79, -7.15), "Gallinas": (-71.66, 12.46), "Nordkinn": (27.65, 71.13),
}  # fmt: skip


def segments(lines):
    """Return the ends of all segments, shape (N, 2, 2)."""
    parts = [np.asarray(cell.points)[:, :2] for cell in lines.cell]
    return np.concatenate([np.stack([part[:-1], part[1:]], axis=1) for part in parts])


def lengths(lines):
    return np.linalg.norm(np.diff(segments(lines), axis=1)[:, 0], axis=1)


@pytest.mark.parametrize("name", CAPES)
def test_capes_are_where_charts_have_them(name):
    place = np.array(CAPES[name])
    ends = segments(coasts(EARTH)).astype(float)
    start, step = ends[:, 0], ends[:, 1] - ends[:, 0]
    share = np.einsum("ij,ij->i", place - start, step) / np.einsum("ij,ij->i", step, step)
    nearest = start + np.clip(share, 0, 1)[:, np.newaxis] * step
    assert np.linalg.norm(nearest - place, axis=1).min() < 0.7


def test_coasts_part_land_from_sea():
    """By rays to the pole: an odd number of coasts south of a place is land, as its height says."""
    earth = vizlight.load_example("earth_relief.vti")
    x, y, _ = np.asarray(earth.points[::97], dtype=float).T
    high = np.asarray(earth["elevation"])[::97]
    # Far from the level of the sea, and outside of ice and of depressions.
    kept = (np.abs(high) > 300) & (np.abs(y) < 60)
    x, y, high = x[kept], y[kept], high[kept]
    a, b = np.moveaxis(segments(coasts(EARTH)).astype(float), 1, 0)
    crossings = np.zeros(len(x), int)
    for (ax, ay), (bx, by) in zip(a, b, strict=True):
        between = (ax <= x) != (bx <= x)
        if between.any():
            crossings[between] += y[between] > ay + (x[between] - ax) * (by - ay) / (bx - ax)
    # Antarctica lies below all.
    land = crossings % 2 == 0
    assert np.mean(land == (high > 0)) > 0.99


def test_lines_end_at_the_sides_of_a_map_and_none_runs_across_it():
    bounds = (-25.0, 45.0, 30.0, 72.0)
    lines = coasts(bounds)
    assert np.all(np.array(lines.bounds[:4]) - bounds == pytest.approx((0, 0, 0, 0), abs=1e-5))
    assert lengths(lines).max() < 10
    # Each end is at a side of the map, or the line is closed.
    for cell in lines.cell:
        points = np.asarray(cell.points, dtype=float)
        if not np.array_equal(points[0], points[-1]):
            for x, y, _ in (points[0], points[-1]):
                sides = (x - bounds[0], x - bounds[1], y - bounds[2], y - bounds[3])
                assert np.abs(sides).min() < 1e-4


def test_maps_from_0_to_360_have_the_coasts_of_those_from_minus_180():
    one, other = coasts(EARTH), coasts((0.0, 360.0, -90.0, 90.0))
    assert lengths(other).sum() == pytest.approx(lengths(one).sum(), rel=1e-5)
    assert lengths(other).max() == pytest.approx(lengths(one).max(), rel=1e-5)
    twice = coasts((-180.0, 540.0, -90.0, 90.0))
    assert lengths(twice).sum() == pytest.approx(2 * lengths(one).sum(), rel=1e-5)


def test_a_mesh_gives_its_bounds_and_its_height():
    sheet = pv.ImageData(dimensions=(31, 21, 1), origin=(5, 35, 2))
    lines = coasts(sheet)
    assert set(np.asarray(lines.points)[:, 2]) == {2.0}
    assert lines.n_points == coasts((5.0, 35.0, 35.0, 55.0)).n_points
    assert coasts((-150.0, -130.0, -40.0, -20.0)).n_points == 0


test_bounds_that_are_none = refusals(
    coasts,
    ((0, 1, 2), "bounds: expected .*west, east"),
    ((5, 4, 0, 1), "bounds: expected .*that ascend"),
    ((0, 1e6, 0, 1), "bounds: expected .*no farther than"),
)
