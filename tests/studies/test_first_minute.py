"""The study of the first minute: its rows."""

from __future__ import annotations

import sys

import pytest

from studies import first_minute

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")


def test_a_row_is_a_share_of_what_is_allowed():
    assert first_minute.row("picture of a file", 9, 2.6, 2.0).error == pytest.approx(1)
    assert first_minute.row("--help", 0, 0.7, 9.0).error == pytest.approx(2)
    row = first_minute.row("first call of the accessor", 9, 1.0, 0.4)
    assert row.error == pytest.approx(1 / 0.7)
    assert (row.cost, row.more) == (1.0, {"peer": 0.4})


def test_a_process_is_measured_and_one_that_fails_is_named():
    idle, busy = (first_minute.seconds(["-c", f"sum(range({n}))"]) for n in (0, 10**7))
    assert busy > 2 * idle
    with pytest.raises(RuntimeError, match="-c raise SystemExit"):
        first_minute.seconds(["-c", "raise SystemExit(3)"])


def test_memory_of_a_process_is_its_own():
    """That of the process which starts it does not count."""
    held = bytearray(300_000_000)
    small, large = (first_minute.peak(f"x = bytearray({n})") for n in (0, 10**8))
    assert large - small == pytest.approx(1e8, rel=0.1)
    assert large < len(held)


def test_surfaces_have_their_number_of_points():
    assert first_minute.surface(10_000).n_points == 10_000
