"""Convergence orders that theory gives: light between points, streamlines, relief."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from studies import Row, cheapest, mesh, order, relief, streamlines


@cache
def measured(n, shininess, size):
    (row,) = mesh.measure(n, shininess, (size,))
    return row


def rows_of(n, shininess, sizes=(128, 256, 512)):
    """Return rows of the study, each measured once for all tests."""
    return [measured(n, shininess, size) for size in sizes]


@cache
def every_pixel():
    (row,) = mesh.every_pixel()
    return row


@pytest.mark.parametrize(("n", "shininess"), [(3, 5.0), (3, 20.0), (4, 20.0)])
def test_light_between_points_is_of_order_2_off_the_terminator(n, shininess):
    rows = rows_of(n, shininess, (128, 256, 512) if n == 3 else (64, 128, 256))
    smooth = [row._replace(error=row.more["off the terminator"]) for row in rows]
    assert order(smooth) == pytest.approx(-2, abs=0.2)


def test_a_kink_is_of_order_1():
    rows = rows_of(3, 5.0, (64, 128, 256, 512))
    assert order(rows) == pytest.approx(-1, abs=0.2)


def test_the_verdict_names_a_row_that_holds():
    rows = [*rows_of(3, 20.0), every_pixel()]
    best = cheapest(rows[:3])
    assert best.error <= 1 / 255
    said = mesh.verdict(rows)
    assert f"normals: {best.parameter} for power 20" in said
    assert "off the terminator, in theory 2, and" in said


def test_the_verdict_leaves_no_power_out():
    """What no measured mesh is enough for is named with what it leaves."""
    rows = [*rows_of(3, 5.0), *rows_of(3, 100.0), every_pixel()]
    said = mesh.verdict(rows)
    assert "512 for power 5, more than 512 for power 100 (whose error is 1.04 of 255)" in said
    better = [row._replace(error=1e-3) if row.parameter == 512 else row for row in rows]
    assert "512 for power 5, 512 for power 100, at" in mesh.verdict(better)


def test_streamlines_drift_with_the_square_of_the_cells():
    cells = (8, 16, 32)
    rows = [
        row for n in cells
        for row in streamlines.measure(streamlines.CELL, 1 / n, streamlines.swirling(n), 0.1, 1)
    ]  # fmt: skip
    assert order(rows) == pytest.approx(2, abs=0.3)


def test_streamlines_on_a_sphere_drift_with_the_square_of_the_triangles():
    rows = [
        row for n in (24, 48, 96, 192)
        for row in streamlines.measure(streamlines.SPHERE, 1 / n, streamlines.sphere(n), 0.1, 1)
    ]  # fmt: skip
    assert order(rows) == pytest.approx(2, abs=0.3)


@pytest.fixture(scope="module")
def drifts():
    return [
        *(Row(streamlines.STEP, step, error, 1.0) for step, error in ((2, 2e-5), (1, 1e-5))),
        *(Row(streamlines.CELL, h, h**2, 1.0) for h in (0.1, 0.05)),
        *(Row(streamlines.SPHERE, h, h**2, 1.0) for h in (0.1, 0.05)),
    ]


def test_the_largest_step_that_holds_is_taken(drifts):
    """Whatever the steps cost; and the one that drifts more is refined first."""
    said = streamlines.verdict(drifts)
    assert "use step=2 cell lengths, the largest measured, with a drift of 2e-05" in said
    assert "refine the cells rather than the step" in said
    assert "2.00 in a volume and 2.00 on a surface, in theory 2" in said
    off = [row._replace(error=2e-3) if row.parameter == 2 else row for row in drifts]
    assert "use step=1 cell lengths, with a drift of 1e-05" in streamlines.verdict(off)
    off = [row._replace(error=0.1) if row.way == streamlines.STEP else row for row in drifts]
    said = streamlines.verdict(off)
    assert said.startswith("use a step below 1 cell lengths, whose drift is 0.1 of the radius")
    assert "refine the step before the cells" in said


def test_a_solid_turn_has_the_tracer_s_own_drift_alone():
    (row,) = streamlines.measure(streamlines.STEP, 0.3, streamlines.turning(), 0.3, 1)
    assert row.error < 1e-5


def test_relief_orders():
    """The shadow's edge is a jump, met to a cell: its share of the points falls as the spacing."""
    rows = [row for side in (76, 151, 301) for row in relief.of_hemisphere(side)]
    for method in ("fast", "exact"):
        own = [row for row in rows if row.way.endswith(method)]
        assert -2.2 < order(own) < -1.2
        assert np.all(np.diff([row.error for row in own]) < 0)
        smooth = [row._replace(error=row.more["mean off the edges"]) for row in own]
        assert order(smooth) == pytest.approx(-2, abs=0.2)
