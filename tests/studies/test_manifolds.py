"""The study measures what it says; no time is asserted."""

from __future__ import annotations

import numpy as np

from vizlight.studies import manifolds


def test_frame_errors():
    rows = {row.way: row for row in manifolds.frame_errors(24, repeats=1)}
    assert rows["exact"].space == rows["exact"].light == 0
    assert rows["complex, 1e-30"].space < 1e-14
    assert rows["central, 7.6e-07"].space < 1e-9
    # Order 2 above the best step, rounding below it.
    assert 50 < rows["central, 0.01"].space / rows["central, 0.001"].space < 200
    assert rows["central, 1e-12"].space > 1e-7
    for row in rows.values():
        assert row.light <= 10 * row.space + 1e-14
        assert row.nanoseconds > 0


def test_light_between_points_is_of_order_2():
    rows = manifolds.cell_errors((128, 256, 512))
    assert np.isnan(rows[0].order)
    assert all(abs(row.order - 2) < 0.2 for row in rows[1:])


def test_costs():
    rows = manifolds.costs(20_000, repeats=1)
    assert {row.n for row in rows} == {3, 4, 8}
    assert all(min(row.light, row.turn, row.project) > 0 for row in rows)


def test_memory_does_not_grow_with_the_mesh():
    """Beyond the result a few blocks are alive, whatever the number of points."""
    small, large = (
        manifolds.costs(count, repeats=1)[3].memory * count for count in (100_000, 400_000)
    )
    assert large < 1.5 * small


def test_tables(capsys):
    manifolds.main(12, 2000)
    out = capsys.readouterr().out
    assert "Frames of a wavy torus" in out
    assert "Cost of a point" in out
