"""Figures print what they are, and say in words what is not read."""

import json

import numpy as np
import pytest

from vizlight.observers.figures import (
    Direction,
    Heading,
    Legibility,
    Order,
    Scale,
    Sense,
    Shape,
    Slope,
    Speed,
    Value,
)

HOW = {"size": (200, 100), "size_mm": 20.0, "distance_mm": 400.0, "toward_eye": (0.0, 0.0, 1.0)}
HOW |= {"pixels": 5000, "noise": 2.3, "seed": 7}
READ = Direction(bits=1.25, most=7.5, readable=0.5, samples=100, within_10=0.4, median=12.5)
UNREAD = Value(
    bits=0.125, most=7.0, readable=0.0, samples=100, reason="too fine",
    median=0.25, p95=0.475, largest=0.5,
)  # fmt: skip


def test_figures_are_rows_with_their_chance():
    assert READ.rows() == [
        ("within 10 degrees", "40.0%", "11.1%"),
        ("median error", "12.5 degrees", "45"),
        ("information", "1.25 of 7.5 bits", "0"),
        ("readable share of the picture", "50%", "0%"),
    ]
    assert not READ.unreadable
    order = Order(bits=0.5, readable=0.25, samples=8, told=0.5, wrongly=0.25)
    assert order.rows()[:3] == [
        ("told", "50%", "50%"),
        ("told wrongly", "25%", "50%"),
        ("information", "0.50 of 1.0 bits", "0"),
    ]


def test_the_score_is_in_bits_of_an_answer_within_the_tolerance():
    # Six directions are 30 degrees apart, so that 15 degrees tell which.
    assert READ.score == pytest.approx(1.25 / np.log2(6))
    assert Order(bits=1, readable=1, samples=8, told=1, wrongly=0).score == 1
    assert UNREAD.score == 0
    ranked = Speed(bits=-np.log2(0.3), most=4, readable=1, samples=8, spearman=1)
    assert ranked.score == pytest.approx(1)


def test_what_is_unreadable_is_chance_and_has_a_reason():
    assert UNREAD.unreadable
    rows = [(figure, chance) for _, figure, chance in UNREAD.rows()]
    assert rows == [("chance", x) for x in ("25%", "48%", "50%")] + [
        ("0.12 of 7.0 bits", "0"),
        ("0%", "0%"),
    ]
    found = Legibility(direction=READ, value=UNREAD, **HOW)
    assert found.unreadable == {"value": "too fine"}
    lines = str(found).splitlines()
    assert lines[0].split() == ["question", "figure", "read", "chance"]
    assert [line.split()[0] for line in lines[1:6]] == [
        "direction", "median", "information", "readable", "value",
    ]  # fmt: skip
    assert lines[5].split()[-2:] == ["chance", "25%"]
    assert lines[10] == "value is unreadable: too fine"
    assert lines[11].startswith("5000 pixels of 200 x 100, 20 mm wide, seen from 400 mm; noise")
    assert lines[11].endswith("2.3 in CIELAB, seed 7")
    record = json.loads(json.dumps(found.to_dict()))
    assert (record["direction"]["median"], record["direction"]["chance"]) == (12.5, 45)


def test_each_figure_has_its_chance_and_is_printed_beside_it():
    kinds = Direction, Heading, Slope, Shape, Value, Speed, Order, Sense
    stated = [kind.ROWS[-1 if "median" not in kind.ROWS[0] else 0][3] for kind in kinds]
    assert [f"{kind.chance:g}" for kind in kinds] == [
        "45",
        "45",
        "0",
        "45",
        "0.25",
        "0",
        "0.5",
        "0.5",
    ]
    assert stated == ["45", "45", "0", "45", "25%", "0", "50%", "50%"]


def test_figures_are_left_out_with_their_scale():
    scale = Scale(question="direction", pixels=8.0, length=None, median=20.0)
    figures = Legibility(direction=READ, value=UNREAD, scale=scale, **HOW)
    left = figures.without("direction", "shape")
    assert (left.direction, left.value, left.scale) == (None, UNREAD, None)
    assert figures.without("value").scale == scale
    assert figures.without() == figures
    with pytest.raises(ValueError, match="questions: expected 'direction', .*, got 'hue'"):
        figures.without("hue")


@pytest.mark.parametrize(
    ("pixels", "length", "text"),
    [(None, None, "none"), (8.125, None, "8.12 pixels"), (16, 2.5, "16 pixels, 2.5 of the unit")],
)
def test_the_finest_structure_is_a_length(pixels, length, text):
    scale = Scale(question="value", pixels=pixels, length=length, median=33.0)
    assert scale.rows() == [
        ("finest structure read of value", text, "none"),
        ("median structure", "33 pixels", ""),
    ]
