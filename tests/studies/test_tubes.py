"""The study measures what it says; no time is asserted."""

from __future__ import annotations

import pytest

from studies import Row, tubes


@pytest.mark.opengl
def test_tubes_take_twenty_times_the_points(monkeypatch):
    monkeypatch.setattr(tubes, "SIDES", (4, 20))
    (lines, *tubes_of), meshes, _ = tubes.measure(10, repeats=1)
    tube = tubes_of[-1]
    assert 15 * lines.more["points"] < tube.more["points"] < 25 * lines.more["points"]
    assert tube.more["MB"] > 10 * lines.more["MB"]
    assert min(lines.cost, tube.cost) > 0
    assert lines.error == 0 < tube.error < tubes_of[0].error
    assert all("luminance" in mesh.point_data for mesh in meshes)


def known(line=1.0, errors=(0.1, 0.003, 0.002)):
    """Return lit lines of a cost, and tubes of 8, 10 and 20 sides with these errors."""
    more = {"MB": 1.0, "build and light, ms": 1.0}
    return [
        Row("lit lines", 0, 0.0, line, more),
        *(
            Row("tubes", n, error, n / 10, dict.fromkeys(more, 3 * n / 10))
            for n, error in zip((8, 10, 20), errors, strict=True)
        ),
    ]


def test_the_verdict_follows_from_the_rows():
    said = tubes.verdict(known(0.5))
    assert (
        "use lit lines (model='cylinder'), which are faster to draw: a tube needs 10 sides" in said
    )
    assert "(8 are too few); such a tube needs 3 times the memory" in said
    assert "use tubes of 10 sides, which are faster to draw" in tubes.verdict(known(50.0))
    said = tubes.verdict(known(50.0, (0.1, 0.1, 0.1)))
    assert "use lit lines (model='cylinder'), which alone are within 1/255" in said
    assert "tubes of 20 sides have an error of 26 of 255" in said
