"""The study's numbers are those of a short run: errors, not times."""

from __future__ import annotations

import numpy as np

from studies import Row, relief
from vizlight import _compiled


def test_error_and_memory_of_the_fast_method():
    fast, exact, *compiled = relief.measure(256, repeats=1)
    assert 0 < fast.error < 3e-2
    # What is worked on at a time has a fixed size; the rest grows with the field.
    assert fast.more["bytes per point"] * 256**2 < 50e6 + 100 * 256**2
    assert min(fast.cost, exact.cost) > 0
    assert len(compiled) == _compiled.active()
    assert all(row.error < 1e-12 for row in compiled)


def test_hemisphere():
    for method in ("fast", "exact"):
        coarse, fine = (relief.hemisphere(n, method)[0] for n in (151, 601))
        assert fine < 1e-3
        assert fine < coarse / 4


def test_hills_are_the_same_again():
    np.testing.assert_array_equal(relief.hills(64), relief.hills(64))
    assert abs(np.ptp(relief.hills(64)) - relief.HIGH) < 1e-12


def test_the_verdict_follows_error_and_time():
    dome = [
        Row(f"hemisphere, {way}", n, n**-1.5, 1.0, {"mean off the edges": n**-2.0})
        for way in ("fast", "exact") for n in (10, 20)
    ]  # fmt: skip

    def said(error, cost):
        rows = [Row("hills, fast", 64, error, cost), Row("hills, exact", 64, 0.0, 4.0), *dome]
        return relief.verdict(rows)

    assert "use method='fast' on fields of 64 x 64" in said(1e-3, 1.0)
    assert "use method='exact'" in said(1e-3, 8.0)
    assert "use method='exact'" in said(1e-1, 1.0)
    assert "of convergence is 2.00 (fast), 2.00 (exact) off the edges" in said(1e-3, 1.0)
    assert "in theory 2, and 1.50 (fast), 1.50 (exact) with the edges" in said(1e-3, 1.0)
