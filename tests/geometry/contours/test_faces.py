"""Faces of one colour from samples: places of borders, cover without gaps."""

import numpy as np
import pytest
from matplotlib.path import Path

from vizlight.geometry.contours.faces import faces
from vizlight.geometry.contours.palette import palette_of

SCALE = 3
GROUND = np.array([300.0])


def grid(width=120, height=100):
    """Return the places of samples in pixels."""
    y, x = (np.mgrid[: height * SCALE, : width * SCALE] + 0.5) / SCALE
    return x, y


def ball(radius=40.0):
    """Return the light of a ball in the light of the eye, in the middle of a picture."""
    x, y = grid()
    square = ((x - 60) ** 2 + (y - 50) ** 2) / radius**2
    light = 255 * np.sqrt(np.maximum(1 - square, 0))
    return np.where(square < 1, light, GROUND)[..., np.newaxis].astype(np.float32)


def painted(samples, found, ground):
    """Return the colours that faces paint at the middles of samples, -1 where none does."""
    x, y = grid()
    places = np.stack([x.ravel(), y.ravel()], axis=1)
    colors = np.full((len(places), samples.shape[2]), -1.0)
    for face in found:
        rings = [np.concatenate([ring, ring[:1]]) for ring in face.rings]
        winding = sum(
            Path(ring, closed=True).contains_points(places) * np.sign(area(ring)) for ring in rings
        )
        colors[winding != 0] = face.color
    return colors.reshape(samples.shape)


def area(ring):
    x, y = ring.T
    return 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))


def test_borders_of_a_ball_are_circles():
    samples = ball()
    palette = palette_of(samples, GROUND, 8.0)
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
    palette = palette_of(samples, GROUND, 8.0)
    assert palette.error <= 8.0
    got = painted(samples, faces(palette, samples, SCALE), GROUND)
    within = np.abs(got - samples) <= 8.01
    # What is inside by a pixel has a colour; the ground has none.
    x, y = grid()
    away = np.hypot(x - 60, y - 50)[..., np.newaxis]
    assert np.mean(within[away < 38]) > 0.99
    assert np.all(got[away < 39] >= 0)
    assert np.all(got[away > 40.5] < 0)


@pytest.mark.slow
@pytest.mark.parametrize("error", [12.0, 20.0])
def test_colours_of_three_channels_are_within_the_error(error):
    x, y = grid()
    samples = np.stack([2 * x, 2 * y, 120 + 60 * np.sin(x / 15)], axis=2).astype(np.float32)
    palette = palette_of(samples, np.array([255.0, 255.0, 255.0]), error)
    assert palette.error <= error
    found = list(faces(palette, samples, SCALE))
    got = painted(samples, found, None)
    assert np.mean(np.all(np.abs(got - samples) <= error + 0.5, axis=2)) > 0.95


def test_flat_colours_are_exact_and_borders_between_them_straight():
    x, y = grid()
    samples = np.where(x < 40, 10.25, np.where(y < 30, 200.5, 90.75))[..., np.newaxis]
    samples = samples.astype(np.float32)
    palette = palette_of(samples, GROUND, 4.0)
    assert palette.colors[1:, 0].tolist() == [10.25, 90.75, 200.5]
    found = list(faces(palette, samples, SCALE))[1:]
    assert [len(face.rings) for face in found] == [1, 1, 1]
    assert abs(area(found[2].rings[0])) == pytest.approx(80 * 30, rel=5e-3)


def test_nothing_but_ground_has_no_face():
    samples = np.full((30, 30, 1), 300, dtype=np.float32)
    palette = palette_of(samples, GROUND, 4.0)
    assert list(faces(palette, samples, SCALE)) == []
