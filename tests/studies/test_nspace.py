"""The study measures what it says; no time is asserted."""

from __future__ import annotations

from vizlight.studies import nspace


def test_costs():
    rows = nspace.cost(2, 4, 20_000, repeats=1)
    assert [row.way for row in rows] == [
        "light", "light, float32", "turn and project", "project",
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
