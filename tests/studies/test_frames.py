"""The study measures what it says; no time is asserted."""

from __future__ import annotations

import pytest

from studies import Row, frames


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


def test_verdict_tells_the_order():
    said = frames.verdict(frames.frame_errors(16, repeats=1))
    assert "order 2.0" in said or "order 1.9" in said
    assert "larger steps have order" in said
    assert "in theory 2" in said
    assert "keep the default step 7.6e-07" in said


@pytest.fixture
def rows():
    central = [Row("central differences", h, max(h * h, 1e-14 / h), 1.0) for h in frames.CENTRAL]
    return [*central, Row("complex step", 1e-30, 1e-16, 2.0)]


def test_the_verdict_follows_from_the_rows(rows):
    assert "any step from 1e-05 to 0.01 of the domain is suitable" in frames.verdict(rows)
    off = [row._replace(error=0.1) if row.parameter == frames.DEFAULT else row for row in rows]
    assert "set the step to 1e-05" in frames.verdict(off)
    rough = [row._replace(error=row.error + 1) for row in rows]
    said = frames.verdict(rough)
    assert said.startswith(
        "no step of central differences is within 1/255, and the error of the best one is 255"
    )
    assert "tangents='complex' is not more accurate" in frames.verdict(
        [*rows[:-1], rows[-1]._replace(error=0.1)]
    )
