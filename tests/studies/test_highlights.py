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
    assert 0.5 * row.bound < row.error <= row.bound + 0.1


def test_tables(capsys, monkeypatch):
    monkeypatch.setattr(highlights, "DEGREES", (60.0,))
    monkeypatch.setattr(highlights, "POWERS", (10.0,))
    full = highlights.codimension
    monkeypatch.setattr(highlights, "codimension", lambda k, c: full(k, c, count=500))
    monkeypatch.setenv("COLUMNS", "150")
    highlights.main(1000)
    said = capsys.readouterr().out
    for number in ("4.0038", "7.668", "198.52", "best by volume"):
        assert number in said
