"""The study measures what it says; no time is asserted."""

from __future__ import annotations

import pytest

from studies import fur


@pytest.mark.opengl
def test_row():
    (row,) = fur.measure(32, 3, repeats=1)
    assert row.more["fibres"] == 32 * 32 * 49
    assert row.cost > 0
    assert 0 < row.error < 0.05


def test_more_segments_are_nearer():
    few, more, many = (fur.along_fibres(n) for n in (1, 3, 12))
    assert few > 3 * more > 6 * many > 0
