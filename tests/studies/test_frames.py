"""The study measures what it says; no time is asserted."""

from __future__ import annotations

from studies import frames


def test_frame_errors():
    rows = {(row.way, row.parameter): row for row in frames.frame_errors(24, repeats=1)}
    space = {key: row.more["error of the space"] for key, row in rows.items()}
    assert space["exact", 0.0] == rows["exact", 0.0].error == 0
    assert space["complex step", 1e-30] < 1e-14
    assert space["central differences", 7.6e-7] < 1e-9
    # Order 2 above the best step, rounding below it.
    assert 50 < space["central differences", 1e-2] / space["central differences", 1e-3] < 200
    assert space["central differences", 1e-12] > 1e-7
    for key, row in rows.items():
        assert row.error <= 10 * space[key] + 1e-14
        assert row.cost > 0
