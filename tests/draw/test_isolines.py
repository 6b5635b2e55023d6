"""Isolines: on their values, with numbers in gaps, of smooth fields alone."""

import numpy as np
import pytest
import pyvista as pv

from vizlight.draw.isolines import are_smooth, contoured, isolines


def cone(count=41):
    """Return a sheet of 40 x 40 whose values are the distance from its middle."""
    grid = pv.ImageData(
        dimensions=(count, count, 1), spacing=(40 / (count - 1),) * 3, origin=(-20, -20, 2)
    )
    x, y, _ = np.asarray(grid.points, dtype=float).T
    grid["r"] = np.hypot(x, y)
    return grid


def test_lines_are_where_the_field_has_their_levels():
    made = isolines(cone(201), "r", [5.0, 10.0, 15.0], letters=0.8)
    lines = made["lines"]
    x, y, z = np.asarray(lines.points, dtype=float).T
    assert np.abs(np.hypot(x, y) - lines["level"]).max() < 0.01
    assert set(z) == {2.0}
    assert set(lines["level"]) == {5.0, 10.0, 15.0}


def test_numbers_stand_in_gaps_of_their_lines_and_upright():
    letters = 0.8
    made = isolines(cone(201), "r", [5.0, 10.0, 15.0], letters=letters)
    lines, numbers = made["lines"], made["numbers"]
    for level in (5.0, 10.0, 15.0):
        word = np.asarray(numbers.points)[numbers["level"] == level][:, :2]
        assert len(word)
        assert np.abs(np.hypot(*word.T) - level).max() < 0.9 * letters
        line = np.asarray(lines.points)[lines["level"] == level][:, :2]
        distance = np.linalg.norm(line[:, np.newaxis] - word, axis=2).min()
        assert distance > 0.15 * letters


def test_numbers_say_the_level_exactly():
    texts = []
    for level in (5.0, 7.5, 12.25):
        made = isolines(cone(), "r", [level], letters=0.5)
        texts.append(np.ptp(np.asarray(made["numbers"].points)[:, :2], axis=0).max())
    # 5, 7.5 and 12.25 have more letters each.
    assert texts == sorted(texts)
    assert texts[2] > 2 * texts[1] - texts[0] > texts[0]


def test_missing_values_have_no_lines():
    grid = cone()
    values = np.array(grid["r"])
    values[np.asarray(grid.points)[:, 0] > 0] = np.nan
    grid["r"] = values
    lines = isolines(grid, "r", [10.0], letters=0.5)["lines"]
    assert lines.n_points
    assert lines.bounds[1] <= 0
    assert np.isfinite(lines.points).all()


def test_smooth_fields_and_noise():
    grid = cone(81)
    levels = [2.0, 6.0, 10.0, 14.0]
    assert are_smooth(grid, contoured(grid, "r", np.array(levels)), levels, 0.8, sparse=1.3)
    grid["r"] = grid["r"] + np.random.default_rng(1).normal(scale=3, size=grid.n_points)
    assert not are_smooth(grid, contoured(grid, "r", np.array(levels)), levels, 0.8, sparse=1.3)
    assert not are_smooth(grid, contoured(grid, "r", np.array([1e6])), [1e6], 0.8, sparse=1.3)
    # Isolines of noise are not joined, which takes long.
    circle = np.array([6.0])
    assert contoured(cone(81), "r", circle, longest=13 * np.pi)
    assert contoured(cone(81), "r", circle, longest=11 * np.pi) == []


def test_numbers_keep_clear_of_other_lines():
    letters = 0.8
    free = np.array(isolines(cone(), "r", [3.0], letters=letters)["numbers"].center)
    assert np.hypot(*free[:2]) == pytest.approx(3, abs=0.5)
    aside = np.array([2.0, 0.0, 0.0])
    fence = pv.Line(free - aside, free + aside)
    made = isolines(cone(), "r", [3.0], letters=letters, clear_of=fence)
    assert np.linalg.norm(made["numbers"].center - free) > 2 * letters


def test_long_lines_have_several_numbers_and_other_words():
    made = isolines(cone(), "r", [15.0], letters=0.8, words=["0.15"])
    widths = np.ptp(np.asarray(made["numbers"].points)[:, :2], axis=0)
    # Numbers at several places of the circle.
    assert widths.max() > 15
    with pytest.raises(ValueError, match="words: expected a word for each of the 1 levels, got 2"):
        isolines(cone(), "r", [15.0], letters=0.8, words=["a", "b"])


def test_an_array_that_is_missing():
    with pytest.raises(ValueError, match="name: expected the name of an array"):
        isolines(cone(), "q", [1.0], letters=1.0)


def hills():
    """Return a sheet of 40 x 40 with a high of 30 at (-10, 0) and a low of -20 at (9, 6)."""
    grid = cone(81)
    x, y, _ = np.asarray(grid.points, dtype=float).T
    grid["h"] = 30 * np.exp(-(np.hypot(x + 10, y) ** 2) / 50)
    grid["h"] -= 20 * np.exp(-(np.hypot(x - 9, y - 6) ** 2) / 40)
    return grid


def test_highs_and_lows_are_where_values_are_extreme_and_lines_closed():
    grid = hills()
    levels = [-15.0, -10.0, -5.0, 5.0, 10.0, 15.0, 20.0, 25.0]
    made = isolines(grid, "h", levels, letters=0.6, extremes=0.1)
    marks, lines = made["extremes"], made["lines"]
    values = np.unique(marks["level"])
    np.testing.assert_allclose(values, [grid["h"].min(), grid["h"].max()])
    for value, place in zip(values, [(9, 6), (-10, 0)], strict=True):
        corners = np.asarray(marks.points)[marks["level"] == value][:, :2]
        np.testing.assert_allclose((corners.max(axis=0) + corners.min(axis=0)) / 2, place, atol=0.6)
        # No line runs through the letter or the number.
        inside = np.all(
            (lines.points[:, :2] > corners.min(axis=0))
            & (lines.points[:, :2] < corners.max(axis=0)),
            axis=1,
        )
        assert not inside.any()
    # 300 and -200 in tenths have three digits and a sign.
    plain = isolines(grid, "h", levels, letters=0.6, extremes=1.0)["extremes"]
    assert marks.n_points > plain.n_points
    assert isolines(grid, "h", levels, letters=0.6)["extremes"].n_points == 0


def test_extremes_at_a_side_or_without_a_closed_line_are_not_marked():
    grid = hills()
    assert isolines(grid, "h", [100.0], letters=0.6, extremes=1.0)["extremes"].n_points == 0
    grid["h"] = np.asarray(grid.points, dtype=float)[:, 0]
    made = isolines(grid, "h", [-10.0, 0.0, 10.0], letters=0.6, extremes=1.0)
    assert made["extremes"].n_points == 0
    with pytest.raises(ValueError, match="extremes: expected"):
        isolines(grid, "h", [1.0], letters=0.6, extremes=0.0)


def test_lines_of_a_level_do_not_depend_on_the_other_levels():
    y, x = np.mgrid[:12, :15]
    field = pv.ImageData(dimensions=(15, 12, 1))
    field["f"] = (np.sin(x / 2.0) + np.cos(y / 3.0)).ravel()
    field = field.extract_surface(algorithm="dataset_surface")
    few = contoured(field, "f", np.array([-0.4, 0.4]))
    every = contoured(field, "f", np.linspace(-0.8, 0.8, 9).round(1))
    kept = [(piece, level) for piece, level in every if level in (-0.4, 0.4)]
    assert [level for _, level in few] == [level for _, level in kept]
    for (one, _), (other, _) in zip(few, kept, strict=True):
        np.testing.assert_array_equal(one, other)
