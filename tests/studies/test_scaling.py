"""Time in step with the number of points, whose error and memory do not grow."""

from __future__ import annotations

import pytest

from studies import Row, scaling
from vizlight import _compiled, _pool


def test_rows_in_memory_and_from_disk():
    (memory,) = scaling.in_memory([30_000], 0.1)
    (disk,) = scaling.from_disk(30_000)
    assert memory.error < 2e-6
    assert disk.error < 2e-6
    assert disk.way == "in blocks from disk"


def test_rows_of_first_calls():
    rows = scaling.first_calls([2_000])
    compiled = ["first call, compiled", "first call, compiled before"]
    expected = ["first call, NumPy", *(compiled if _compiled.active() else [])]
    assert [row.way for row in rows] == expected
    assert all(row.error < 2e-6 for row in rows)
    assert len({row.error for row in rows[1:]}) <= 1


def test_memory_beyond_the_output_is_bounded(monkeypatch):
    """Blocks have one size; 1 MB is left to records of blocks. Threads may overlap or not."""
    monkeypatch.setattr(_pool, "workers", lambda _: 1)
    with _compiled.setting("0"):  # compiled code is read between the two where it pays by then
        small, large = scaling.in_memory([400_000, 1_600_000], 0.0)
    key = "MB beyond the output"
    assert large.more[key] < 1.6 * small.more[key] + 1


@pytest.mark.parametrize("power", [1.0, 1.3])
def test_exponent_of_known_times(power):
    rows = [
        Row(
            "in memory",
            n,
            1e-7,
            1.0,
            {"s": 1.0, "processor s": 1e-9 * n**power, "MB beyond the output": 30.0},
        )
        for n in (1e4, 2e6, 5e6, 1e7)
    ]
    rows[0] = rows[0]._replace(more={**rows[0].more, "processor s": 1.0})
    assert scaling.exponent(rows) == pytest.approx(power)
    assert scaling.verdict(rows).startswith("expect") == (power == 1.0)
    assert f"grows with the power {power:.3f}, in theory 1" in scaling.verdict(rows)


def test_no_room(monkeypatch):
    monkeypatch.setattr(scaling.shutil, "disk_usage", lambda _: type("Disk", (), {"free": 0}))
    assert scaling.from_disk(1000) == []
