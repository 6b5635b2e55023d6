"""Convergence orders that theory gives: light between points, streamlines, relief."""

from __future__ import annotations

import numpy as np
import pytest

from vizlight.studies import cheapest, mesh, order, relief, streamlines


@pytest.mark.parametrize(("n", "shininess"), [(3, 5.0), (3, 20.0), (4, 20.0)])
def test_light_between_points_is_of_order_2_off_the_terminator(n, shininess):
    rows = mesh.measure(n, shininess, (128, 256, 512))
    smooth = [row._replace(error=row.more["off the terminator"]) for row in rows]
    assert order(smooth) == pytest.approx(-2, abs=0.2)


def test_a_kink_is_of_order_1():
    rows = mesh.measure(3, 5.0, (128, 256, 512, 1024))
    assert order(rows) == pytest.approx(-1, abs=0.2)


def test_the_verdict_names_a_row_that_holds():
    rows = [*mesh.measure(3, 20.0, (128, 256, 512)), *mesh.every_pixel()]
    best = cheapest(rows[:3])
    assert best.error <= 1 / 255
    assert f"in {best.parameter} steps" in mesh.verdict(rows)


def test_streamlines_drift_with_the_square_of_the_cells():
    cells = (8, 16, 32)
    rows = [
        row for n in cells
        for row in streamlines.measure(streamlines.CELL, 1 / n, streamlines.swirling(n), 0.1, 1)
    ]  # fmt: skip
    assert order(rows) == pytest.approx(2, abs=0.3)


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
