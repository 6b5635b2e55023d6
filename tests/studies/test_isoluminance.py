"""The study's numbers are those of a short run: errors, not times."""

from __future__ import annotations

from studies import isoluminance


def test_the_contours_of_smooth_normals_are_circles_and_those_of_light_at_points_come_near():
    (ours, coarse), (_, fine) = (isoluminance.measure(side, 1) for side in (16, 64))
    assert ours.way == "isoluminance(mesh)"
    assert ours.error < 1e-5
    assert 1e-3 < fine.error < coarse.error / 3


def test_contours_of_the_solid_are_circles():
    (row,) = isoluminance.of_solid(1)
    assert row.error < 1e-10
