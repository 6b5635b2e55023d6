"""The study tells what the model has; no time is asserted."""

from __future__ import annotations

import pytest

from vizlight.studies import highlights


def test_rules_at_a_right_angle():
    rows = {row.rule: row for row in highlights.rules(90.0, 10.0)}
    assert rows["4"].worst == pytest.approx(63.75)
    assert min(row.worst for row in rows.values()) == rows["best by worst"].worst
    assert min(row.rms for row in rows.values()) == rows["best by RMS"].rms
    assert min(row.volume for row in rows.values()) == rows["best by volume"].volume
    assert rows["4 cos(beta)"].rms < 0.7 * rows["4"].rms


@pytest.mark.parametrize(("k", "c"), [(1, 2), (2, 1), (2, 3)])
def test_codimensions(k, c):
    """The worst of a sample nears the bound that holds in every codimension."""
    four, simple, _ = highlights.codimension(k, c, count=20_000)
    assert 23 < four.worst <= 25.56
    assert simple.worst < 0.7 * four.worst
    assert simple.rms < 0.8 * four.rms


def test_exchange():
    row = highlights.exchange(40.0, 20.0, count=20_000, repeats=1)
    assert min(row.phong, row.blinn) > 0
    assert 0.5 * row.bound < row.error <= row.bound


def test_rows_of_the_study():
    rows = [
        *highlights.rows_of_rules(60.0, 40.0),
        *highlights.rows_of_codimension(1, 2, 500),
        *(row for a in (2.0, 60.0) for row in highlights.rows_of_exchange(a, 100.0, 1000)),
        *highlights.rows_of_terminators(120),
    ]
    assert len({row.way for row in rows}) == 6 + 3 + 2 + 4
    said = highlights.verdict(rows)
    assert "holds 1/255 up to 2 degrees" in said
    assert "usual 4 makes 26.6" in said
