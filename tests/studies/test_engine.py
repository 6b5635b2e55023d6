"""The study measures what it says; no time is asserted."""

from __future__ import annotations

import itertools
import time

import numpy as np
import pytest

from studies import Row, engine, peak_memory, take_turns
from vizlight import _compiled


def test_rows_of_the_study():
    rows = engine.measure(40_000, repeats=1)
    script, one_pass = rows[0], rows[1]
    assert script.way == "NumPy script, float32"
    assert one_pass.way == "one pass, float32"
    assert np.isnan(one_pass.error)
    assert script.more["script / this"] == one_pass.more["this / pass"] == 1
    assert all(row.cost > 0 for row in rows)
    assert all(row.error < 2e-6 for row in rows if row is not one_pass and "pass" not in row.way)
    high = [row for row in rows if "float64" in row.way and "pass" not in row.way]
    assert all(row.error < 1e-13 for row in high)
    assert ("compiled, float64" in {row.way for row in high}) == _compiled.active()
    small = next(row for row in rows if row.parameter == 4096)
    assert small.more["extra MB"] < script.more["extra MB"]
    assert "float64 costs" in engine.verdict(rows)


def test_peak_memory_counts_numpy():
    assert peak_memory(lambda: np.ones(100_000)) >= 800_000


def test_turns():
    """The first time, which is slower, does not count."""
    seen, waits = [], itertools.chain((0.02,), itertools.repeat(0))

    def first():
        seen.append(1)
        time.sleep(next(waits))

    seconds = take_turns({"a": first, "b": lambda: seen.append(2)}, 3)
    assert 3 <= len(seen) // 2 <= 6  # repeated where times do not agree
    assert seen == [1, 2] * (len(seen) // 2)
    assert all(0 < value < 0.02 for value in seconds.values())


def known(one_thread=0.9):
    """Return rows in which one thread takes so much of the default's time."""
    costs = {
        ("NumPy script, float32", 1000): 5.0,
        ("one pass, float32", 1000): 0.5,
        ("NumPy blocks, float32", 64): 2.0,
        ("compiled, float32", 64): 1.0,
        ("compiled, float32, 1 thread", 64): one_thread,
        ("compiled, float64", 32): 1.5,
        ("compiled, float32, other blocks", 8): 3.0,
    }
    return [
        Row(
            way, block, 1e-6, cost,
            {"wall ns": 9.0, "script / this": 5 / cost, "this / pass": cost / 0.5},
        )
        for (way, block), cost in costs.items()
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("one_thread", "chosen", "float64"),
    [
        (0.9, "the engine's defaults, 'compiled, float32'", 1.5),
        (0.75, "'compiled, float32, 1 thread'", 2),
    ],
)
def test_the_default_is_kept_unless_another_is_clearly_faster(one_thread, chosen, float64):
    said = engine.verdict(known(one_thread))
    assert f"use {chosen} with blocks of 64 points" in said
    assert f"float64 costs {float64:g} times" in said
    assert "one pass over the arrays; NumPy blocks cost" in said


def test_no_way_is_near_enough():
    rows = [row._replace(error=1.0) for row in known()]
    assert engine.verdict(rows) == "no method is within 1/255; the error of float64 is 1"
