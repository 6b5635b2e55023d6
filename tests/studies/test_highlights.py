"""The study tells what the model has."""

from __future__ import annotations

import pytest

from studies import highlights


def test_rules_at_a_right_angle():
    rows = {row.way.removeprefix("rule "): row for row in highlights.rules(90.0, 10.0)}
    assert rows["4"].error == pytest.approx(63.75)
    assert min(row.error for row in rows.values()) == rows["best by worst"].error
    for by, key in (("RMS", "RMS"), ("volume", "mean size")):
        assert min(row.more[key] for row in rows.values()) == rows[f"best by {by}"].more[key]
    assert rows["4 cos(beta)"].more["RMS"] < 0.7 * rows["4"].more["RMS"]
