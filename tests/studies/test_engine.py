"""The study measures what it says; no time is asserted."""

from __future__ import annotations

import numpy as np

from vizlight.studies import _measure, engine


def test_rows_of_the_study():
    rows = engine.measure(40_000, repeats=1)
    script, first = rows[0], rows[1]
    assert script.way == "NumPy script, float32"
    assert all(row.cost > 0 for row in rows)
    assert first.error < 2e-6
    high = next(row for row in rows if "float64" in row.way)
    assert high.error < 1e-13
    small = next(row for row in rows if row.parameter == 4096)
    assert small.more["extra MB"] < script.more["extra MB"]
    assert "float64 costs" in engine.verdict(rows)


def test_peak_memory_counts_numpy():
    assert _measure.peak_memory(lambda: np.ones(100_000)) >= 800_000


def test_turns():
    seen = []
    seconds = _measure.take_turns({"a": lambda: seen.append(1), "b": lambda: seen.append(2)}, 3)
    assert seen == [1, 2] * 3
    assert all(value > 0 for value in seconds.values())
