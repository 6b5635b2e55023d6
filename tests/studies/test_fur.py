"""The study measures what it says; no time is asserted."""

from __future__ import annotations

import pytest

from studies import Row, fur, order


@pytest.mark.opengl
def test_row():
    (row,) = fur.measure(32, 3, repeats=1)
    assert row.more["fibres"] == 32 * 32 * 49
    assert row.cost > 0
    assert 0 < row.error < 0.05


def test_more_segments_are_nearer():
    few, more, many = (fur.along_fibres(n) for n in (1, 3, 12))
    assert few > 3 * more > 6 * many > 0


def test_more_fibres_are_nearer():
    exact = fur.over_patches(100_000)
    rows = [fur.count_fibres(64 * size, exact) for size in (8, 32, 128)]
    # Seeds are stratified: better than the 1/2 of independent ones.
    assert order(rows) < -0.5


def test_the_verdict_follows_error_and_time():
    more = {"VTK glyphs without light, s": 1.0}

    def rows(errors):
        return [
            Row(fur.SEGMENTS, n, error, 1.0, {**more, "s": 2.0 / n})
            for n, error in zip((1, 3, 7), errors, strict=True)
        ] + [Row(fur.FIBRES, n, 1e-3, 1.0) for n in (8, 32)]

    said = fur.verdict(rows((0.1, 1e-3, 1e-4)))
    assert said.startswith("for an RMS error of 1/255 use 3 segments per fibre (error 0.001); ")
    assert "use 8 fibres per patch" in said
    assert "generating and lighting the fibres is 0.5 to 3.5 times as fast" in said
    # One that is near by chance, where finer ones are not, is not enough.
    assert fur.verdict(rows((0.1, 1e-3, 0.1))).startswith(
        "the error of 7 segments per fibre is 26 of 255"
    )
