"""The level that stands out: through the steepest places, also of grids of other kinds."""

import numpy as np
import pytest
import pyvista as pv

from vizlight.looks import levels


def grid():
    made = pv.ImageData(dimensions=(24, 22, 20), spacing=(1, 1, 1))
    x, y, z = (made.points - np.asarray(made.center)).T
    r = np.sqrt(x * x + y * y + z * z)
    # A step at 40 between two slopes.
    made["T"] = 0.5 * r + 80 / (1 + np.exp(-3 * (r - 7)))
    made["ramp"] = 2 * x + 5
    return made


@pytest.mark.parametrize("cast", [lambda g: g, lambda g: g.cast_to_unstructured_grid()])
def test_the_level_is_where_the_values_rise_most(cast):
    level, contrast = levels.best_level(cast(grid()), "T")
    assert 25 < level < 60
    assert contrast > 2


def test_the_lowest_level_of_those_that_are_nearly_as_steep():
    best, contrast = levels.best_level(grid(), "T")
    lowest, other = levels.best_level(grid(), "T", share=0.7)
    assert lowest < best - 3
    assert 0.7 * contrast <= other < contrast


def test_a_ramp_has_no_level():
    _, contrast = levels.best_level(grid(), "ramp")
    assert contrast == pytest.approx(1, abs=0.05)
    assert contrast < levels.GOOD


def test_constants_and_holes():
    made = grid()
    made["flat"] = np.ones(made.n_points)
    assert levels.best_level(made, "flat")[1] == 0
    made["T"][::7] = np.nan
    assert np.isfinite(levels.best_level(made, "T")[0])


def test_values_that_rise_ever_faster_have_no_isosurface_that_stands_out():
    image = pv.ImageData(dimensions=(12, 12, 12))
    x, y, z = np.asarray(image.points).T
    image["p"] = x * y * z
    assert levels.best_level(image, "p")[1] <= 1


def test_corners_of_strips_are_those_of_their_triangles():
    tube = pv.Line(resolution=3).tube(radius=0.1, n_sides=5)
    assert tube.n_strips > 0
    ids, starts, counts = levels.sampled_corners(tube)
    assert (set(counts), len(ids)) == ({3}, 3 * len(starts))
    assert len(starts) == tube.triangulate().n_cells
    assert [len(part) for part in levels.sampled_corners(pv.Line())] == [0, 0, 0]


def test_what_a_scanner_did_not_see_has_no_level():
    """The edge of the circle of a scanner is the steepest one, and no part of the body."""
    scan = pv.ImageData(dimensions=(30, 30, 30), origin=(-14.5,) * 3)
    x, y, z = np.asarray(scan.points, dtype=float).T
    noise = np.random.default_rng(0).normal(0, 20, len(x))
    values = np.where(x**2 + y**2 + z**2 < 60, 50.0, -1000.0) + noise
    scan["CT"] = np.where(x**2 + y**2 < 180, values, -3000.0)
    level, contrast = levels.best_level(scan, "CT")
    assert -900 < level < 0
    assert contrast > 1.5
