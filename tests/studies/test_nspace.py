"""The study measures what it says; no time is asserted."""

from __future__ import annotations

import numpy as np
import pytest

from studies import Row, nspace


def test_costs():
    rows = nspace.cost(2, 4, 20_000, repeats=1)
    assert [row.way for row in rows] == [
        "light", "light, float32", nspace.ROTATE, "project",
    ]  # fmt: skip
    assert all(row.cost > 0 for row in rows)
    assert 0 < rows[1].error < 1e-5


def test_memory_does_not_grow_with_the_mesh():
    """Beyond the result a few blocks are alive, whatever the number of points."""
    small, large = (
        nspace.cost(2, 4, count, repeats=1)[2].more["bytes beyond the result"] * count
        for count in (100_000, 400_000)
    )
    assert large < 1.5 * small


@pytest.mark.parametrize(
    ("gains", "said"),
    [
        ((2.0, 1.5), "use precision='float32': 1.5 to 2 times as fast"),
        ((0.5, 0.9), "keep precision='float64': float32 is 0.5 to 0.9 times as fast"),
        ((2.0, 0.9), "use precision='float32' for (k, n) = (2, 4): 2 times as fast, elsewhere 0.9"),
    ],
)
def test_float32_is_for_where_it_is_faster(gains, said):
    rows = [
        Row(way, n, error, cost, {"k": k})
        for (k, n), gain in zip(((2, 4), (7, 8)), gains, strict=True)
        for way, error, cost in (
            ("light", np.nan, 100.0), ("light, float32", 1e-6, 100 / gain),
            (nspace.ROTATE, np.nan, 300.0),
        )
    ]  # fmt: skip
    assert said in nspace.verdict(rows)
    wrong = [row._replace(error=1.0) for row in rows]
    assert "keep precision='float64'" in nspace.verdict(wrong)


def test_every_curve_has_one_row_for_each_n():
    rows = [row for k, n in ((1, 3), (2, 3), (1, 4)) for row in nspace.cost(k, n, 500, repeats=1)]
    panels = (nspace.STUDY, *nspace.STUDY.beside)
    shown = [(panel.curve(row), row.parameter) for panel in panels for row in rows]
    shown = [pair for pair in shown if pair[0]]
    assert len(shown) == len(rows) == len(set(shown))
