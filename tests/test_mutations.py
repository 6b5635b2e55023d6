"""Each mutation of the table breaks a line that is there, and has tests to catch it."""

from __future__ import annotations

import mutations
import pytest


@pytest.mark.parametrize("title", [*mutations.MUTATIONS, *mutations.OF_NUMBERS])
def test_the_line_to_break_is_there(title):
    path, old, new = (mutations.MUTATIONS | mutations.OF_NUMBERS)[title]
    assert old in (mutations.ROOT / "vizlight" / path).read_text(encoding="utf-8")
    assert old != new
    assert all((mutations.ROOT / test).exists() for test in mutations.tests_of(path))
