"""The study measures what it says; no time is asserted."""

from __future__ import annotations

from studies import engine
from vizlight import _compiled


def test_rows_of_the_study():
    rows = engine.measure(40_000, repeats=1)
    assert rows[0].way == "NumPy script, float32"
    assert all(row.error < (2e-6 if "float32" in row.way else 1e-13) for row in rows)
    assert ("compiled, float64" in {row.way for row in rows}) == _compiled.active()
    assert all(row.cost > 0 for row in rows)


def test_rows_of_first_calls():
    rows = engine.first_calls([2_000])
    compiled = ["first call, compiled", "first call, compiled before"] * _compiled.active()
    assert [row.way for row in rows] == ["first call, NumPy", *compiled]
    assert all(row.error < 2e-6 for row in rows)
    assert len({row.error for row in rows[1:]}) <= 1
