"""The study measures what it says; no time is asserted."""

from __future__ import annotations

import pytest

from vizlight.studies import fur

pytestmark = pytest.mark.opengl


def test_row():
    row = fur.measure(32, 3, repeats=1)
    assert row.fibres == 32 * 32 * 49
    assert min(row.fur, row.glyph, row.draw, row.memory) > 0


def test_table(capsys):
    fur.main(8)
    assert "Fur of 9408 segments" in capsys.readouterr().out
