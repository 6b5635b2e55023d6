"""Faces of one colour from samples: places of borders, cover without gaps."""

import numpy as np
import pytest
from samples import GROUND, SCALE, ball, grid, painted

from vizlight.geometry.contours.faces import faces
from vizlight.geometry.contours.palette import palette_of


def test_borders_of_a_ball_are_circles():
    samples = ball()
    palette = palette_of(samples, GROUND, 8.0, SCALE)
    by_color = {float(face.color[0]): face for face in faces(palette, samples, SCALE)}
    for label in range(8, len(palette.colors)):
        # A face of light begins where the sphere has its level; what hides it later lies within.
        level = palette.centres[label - 1 : label + 1, 0].mean()
        radius = 40 * np.sqrt(1 - (level / 255) ** 2)
        rings = by_color[float(palette.colors[label, 0])].rings
        away = np.hypot(*(max(rings, key=len) - (60, 50)).T)
        assert away.max() == pytest.approx(radius, abs=0.12)


def test_colours_are_within_the_error_and_no_gap_is_left():
    samples = ball()
    palette = palette_of(samples, GROUND, 8.0, SCALE)
    assert palette.error <= 8.0
    got = painted(samples, faces(palette, samples, SCALE), GROUND)
    within = np.abs(got - samples) <= 8.01
    # What is inside by a pixel has a colour; the ground has none.
    x, y = grid()
    away = np.hypot(x - 60, y - 50)[..., np.newaxis]
    assert np.mean(within[away < 38]) > 0.99
    assert np.all(got[away < 39] >= 0)
    assert np.all(got[away > 40.5] == GROUND)


@pytest.mark.slow
@pytest.mark.parametrize("error", [12.0, 20.0])
def test_colours_of_three_channels_are_within_the_error(error):
    x, y = grid()
    samples = np.stack([2 * x, 2 * y, 120 + 60 * np.sin(x / 15)], axis=2).astype(np.float32)
    palette = palette_of(samples, np.array([255.0, 255.0, 255.0]), error, SCALE)
    assert palette.error <= error
    found = list(faces(palette, samples, SCALE))
    got = painted(samples, found, None)
    assert np.mean(np.all(np.abs(got - samples) <= error + 0.5, axis=2)) > 0.95


def test_flat_colours_are_exact_and_borders_between_them_straight():
    x, y = grid()
    samples = np.where(x < 40, 10.25, np.where(y < 30, 200.5, 90.75))[..., np.newaxis]
    samples = samples.astype(np.float32)
    palette = palette_of(samples, GROUND, 4.0, SCALE)
    assert palette.colors[1:, 0].tolist() == [10.25, 90.75, 200.5]
    found = list(faces(palette, samples, SCALE))[1:-1]
    assert [len(face.rings) for face in found] == [1, 1, 1]
    # Beyond the picture it reaches beneath the background.
    light = np.clip(found[2].rings[0], (0, 0), (120, 100))
    within = light[light[:, 1] > 0]
    assert within[:, 0].min() == pytest.approx(40, abs=0.1)
    assert light[light[:, 0] < 120, 1].max() == pytest.approx(30, abs=0.1)


def test_nothing_but_ground_has_no_face():
    samples = np.full((30, 30, 1), 300, dtype=np.float32)
    palette = palette_of(samples, GROUND, 4.0, SCALE)
    assert list(faces(palette, samples, SCALE)) == []
