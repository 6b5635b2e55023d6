"""The study measures what it says; no time is asserted."""

from __future__ import annotations

import pytest

from vizlight.studies import tubes

pytestmark = pytest.mark.opengl


def test_tubes_take_twenty_times_the_points():
    (lines, *tubes_of), meshes, _ = tubes.measure(10, repeats=1)
    tube = tubes_of[-1]
    assert 15 * lines.more["points"] < tube.more["points"] < 25 * lines.more["points"]
    assert tube.more["MB"] > 10 * lines.more["MB"]
    assert min(lines.cost, tube.cost) > 0
    assert lines.error == 0 < tube.error < tubes_of[0].error
    assert all("luminance" in mesh.point_data for mesh in meshes)
    assert "one of 20 sides takes" in tubes.verdict([lines, *tubes_of])
