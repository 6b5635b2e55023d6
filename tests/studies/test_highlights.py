"""The study tells what the model has; no time is asserted."""

from __future__ import annotations

import pytest

from studies import highlights


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
    ]
    assert len({row.way for row in rows}) == 6 + 3 + 2
    said = highlights.verdict(rows)
    assert "use 4 cos(beta) corrected for r times the Phong power" in said
    assert "(4: 26.56, 4 cos(beta): 14.13, the best factor by search: 13.63)" in said
    assert "up to 2 degrees between light and eye for power 100" in said
    assert "its time is" in said


@pytest.fixture(scope="module")
def rows():
    return [
        *highlights.rows_of_rules(60.0, 40.0),
        *(
            row for power in (20.0, 100.0) for a in (2.0, 10.0, 60.0)
            for row in highlights.rows_of_exchange(a, power, 1000)
        ),
    ]  # fmt: skip


def test_the_verdict_names_each_power(rows):
    """The largest error falls with the power: 0.85 of 255 at 2 degrees for 20, 0.17 for 100."""
    said = highlights.verdict(rows)
    assert "up to 2 degrees between light and eye for power 20" in said
    assert "up to 10 degrees between light and eye for power 100" in said


def test_the_rule_follows_from_the_rows(rows):
    worse = [row._replace(error=250.0) if row.way.startswith("rule 4 cos") else row for row in rows]
    assert highlights.verdict(worse).startswith(
        "use 4 times the Phong power, with a largest error of 26"
    )


def test_without_any_angle_there_is_no_time(rows):
    off = [
        row._replace(more={**row.more, "bound": 9.0}) if "bound" in row.more else row
        for row in rows
    ]
    assert highlights.verdict(off).endswith("at 2 degrees)")


def test_the_figure_shows_few_curves_and_no_rounding(rows):
    left, right = (
        {panel.curve(row) for row in rows} - {None}
        for panel in (highlights.STUDY, *highlights.STUDY.beside)
    )
    assert len(left) == 6
    assert len(right) == 2
