"""Nested areas of one channel: places of borders, cover without gaps, edges between surfaces."""

import numpy as np
import pytest
from samples import GROUND, SCALE, area, ball, grid, painted

from vizlight.geometry.contours.levels import levels
from vizlight.geometry.contours.palette import palette_of


def test_borders_of_a_ball_are_circles_within_the_distance_that_the_tolerance_leaves():
    samples = ball()
    palette = palette_of(samples, GROUND, 6.0, SCALE)
    tolerance = 2.0
    by_color = {float(face.color[0]): face for face in levels(palette, samples, SCALE, tolerance)}
    for label in range(12, len(palette.colors)):
        level = palette.centres[label - 1 : label + 1, 0].mean()
        ring = max(by_color[float(palette.colors[label, 0])].rings, key=len)
        away = np.hypot(*(ring - (60, 50)).T)
        light = 255 * np.sqrt(1 - (away / 40) ** 2)
        # Vertices are on the border; the chords between them leave it by the tolerance.
        assert np.abs(light - level).max() < tolerance


def test_colours_are_within_the_error_and_each_border_is_written_once():
    samples = ball()
    palette = palette_of(samples, GROUND, 6.0, SCALE)
    found = list(levels(palette, samples, SCALE, 2.0))
    got = painted(samples, found, GROUND)
    within = np.abs(got - samples) <= 8.01
    x, y = grid()
    away = np.hypot(x - 60, y - 50)[..., np.newaxis]
    assert np.mean(within[away < 38]) > 0.99
    assert np.all(got[away > 40.5] == GROUND)
    # One ring around all that is at least as light, with no hole for what is lighter.
    assert {len(face.rings) for face in found[1:-1]} == {1}
    assert all(area(face.rings[0]) > 0 for face in found[1:-1])


def test_an_edge_between_surfaces_is_the_border_of_the_lighter_one_alone():
    x, y = grid()
    near = np.hypot(x - 60, y - 50) < 25
    samples = np.where(near, 220 + 0.2 * x, 40 + 0.5 * x)[..., np.newaxis].astype(np.float32)
    palette = palette_of(samples, GROUND, 3.0, SCALE)
    found = list(levels(palette, samples, SCALE, 1.0))
    got = painted(samples, found, GROUND)
    assert np.mean(np.abs(got - samples) <= 4.01) > 0.99
    on_edge = [
        face.color[0]
        for face in found[1:-1]
        if any(np.min(np.abs(np.hypot(*(ring - (60, 50)).T) - 25)) < 0.2 for ring in face.rings)
    ]
    assert not [color for color in on_edge if 90 < color < 215]


@pytest.mark.parametrize("shape", [(30, 30), (4, 90)])
def test_nothing_but_ground_has_no_area(shape):
    samples = np.full((*shape, 1), 300, dtype=np.float32)
    assert list(levels(palette_of(samples, GROUND, 4.0, SCALE), samples, SCALE)) == []
