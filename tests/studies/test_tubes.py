"""The study measures what it says; no time is asserted."""

from __future__ import annotations

import pytest

from studies import tubes


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
