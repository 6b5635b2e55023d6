"""Rings of vertices: fewer of them within limits, and their places in a ring."""

import numpy as np
import pytest

from vizlight.geometry.contours.rings import area_of, shifted, simplified, walked

ANGLES = np.linspace(0, 2 * np.pi, 400, endpoint=False)
CIRCLE = 10 * np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)


def test_a_circle_has_the_vertices_that_its_limit_needs():
    kept = simplified(CIRCLE, np.array([0, 400]), np.full(400, 0.1))
    # A chord of angle a leaves a circle by r (1 - cos(a / 2)).
    widest = 2 * np.arccos(1 - 0.1 / 10)
    assert 2 * np.pi / widest <= kept.sum() <= 2 * np.pi / widest * 2.1
    assert area_of(CIRCLE[kept]) == pytest.approx(np.pi * 100, rel=0.02)
    assert area_of(CIRCLE[::-1]) == -area_of(CIRCLE)


def test_the_third_coordinate_of_vertices_counts():
    line = np.stack([np.arange(9.0), np.zeros(9), np.where(np.arange(9) == 4, 1.0, 0.0)], axis=1)
    assert simplified(line, np.array([0, 9]), np.full(9, 0.1))[4]


def test_rings_are_walked_one_by_one_and_each_ends_where_it_began():
    walk, starts = walked(np.array([2, 3, 0, 4, 1]))
    assert walk.tolist() == [0, 2, 1, 3, 4]
    assert starts.tolist() == [0, 2, 5]
    assert shifted(starts, np.array([1, -1])).tolist() == [1, 0, 4, 2, 3]
