"""The study of what a tolerance saves."""

import math

from vizlight.studies import tolerance as study
from vizlight.studies._framework import PIXEL, Row


def test_settings_are_lit_within_the_tolerance():
    rows = study.measure("NumPy", "float64", 200, 1)
    assert len({row.parameter for row in rows}) == len(rows) == 20
    assert 0 < max(row.error for row in rows) <= PIXEL
    for row in rows:
        assert math.isnan(row.cost) == (row.more["chosen"] == "the exact forms")
        assert row.more["gain"] == 1 or row.cost > 0
    headlight = next(row for row in rows if row.parameter == "headlight, lines, cylinder, power 20")
    assert str(headlight.more["chosen"]).startswith("cylinder: Banks' model times 0.7854")


def test_verdict_follows_from_the_rows():
    def row(way, gain, error=0.001):
        return Row(way, "near", error if gain != 1 else 0.0, 9.0, {"gain": gain, "chosen": ""})

    rows = [row("a", 1.0), row("a", 1.5), row("a", 2.5), row("b", 1.0)]
    words = study.verdict(rows)
    assert "1/255 is kept (largest difference 0.001)" in words
    assert "a: nothing is cheaper in 1 of 3 settings, in the others the median gain is 2 " in words
    assert "the least 1.5; over all the median is 1.5" in words
    assert words.endswith("b: nothing is cheaper in 1 of 1 settings")
    assert "is not kept" in study.verdict([row("a", 2.0, 0.01)])
