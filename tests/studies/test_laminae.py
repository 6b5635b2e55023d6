"""Laminae of a sphere and of a frustum, painted over one another."""

import numpy as np
import pytest

from studies import _laminae

AXIS = np.array([0.3, -0.2, 0.9])
AXIS /= np.linalg.norm(AXIS)


def test_laminae_from_the_light_from_behind_and_across(random):
    """Painted farthest first, the last lamina that covers a pixel shows its value."""
    toward = np.array([0.0, 0, 1])
    laminae = _laminae.sphere((0, 0, 0), 1.0, direction=toward, levels=10, segments=200)
    circles = laminae.points.reshape(-1, 200, 3)
    np.testing.assert_allclose(circles[:, :, 2], circles[:, :1, 2] + 0 * circles[:, :, 2])
    pixel = random.uniform(-0.7, 0.7, (400, 2))
    pixel = pixel[np.hypot(*pixel.T) < 0.98]
    r = np.linalg.norm(circles[:, 0, :2], axis=1) * np.cos(np.pi / 200)
    for eye, exact in (
        (toward, np.sqrt(1 - np.sum(pixel**2, axis=1))),
        (-toward, np.zeros(len(pixel))),
    ):
        shown = np.full(len(pixel), np.nan)
        for i in laminae.order(eye):
            shown[np.hypot(*pixel.T) < r[i]] = laminae.values[i]
        assert np.nanmax(np.abs(shown - exact)) <= 0.05 + 1e-3
        assert np.isnan(shown).sum() <= len(pixel) * 0.01
    # From a direction normal to the axis each lamina is seen as a line: nothing is drawn.
    assert np.ptp(circles[:, :, 2], axis=1).max() < 1e-12


def test_a_sphere_of_radius_0_has_none():
    assert len(_laminae.sphere((1, 2, 3), 0, direction=(0, 0, 1)).values) == 0


def test_laminae_hold_no_empty_one_and_close_the_far_side():
    laminae = _laminae.truncus(
        (0, 0, 0), AXIS, (0.3, 0.8), height=1.0, ambient=0.1, diffuse=0.8, levels=8,
        direction=(1, -2, 0.5),
    )  # fmt: skip
    quads = [
        laminae.points[a:b] for a, b in zip(laminae.offsets, laminae.offsets[1:], strict=False)
    ]
    for quad in quads:
        assert np.linalg.norm(np.cross(quad[1] - quad[0], quad[2] - quad[0])) > 1e-6
        # Each lamina is plane, as the source states.
        rel = quad - quad[0]
        assert np.linalg.svd(rel)[1][2] < 1e-12
    side = np.array([q.mean(axis=0) for q in quads[:-2]])
    light = np.array([1, -2, 0.5]) - (np.array([1, -2, 0.5]) @ AXIS) * AXIS
    assert (side @ light).min() < -0.4 * np.abs(side @ light).max()
    assert laminae.values[-2] == pytest.approx(
        max(0.1, 0.1 + 0.8 * (AXIS @ (1, -2, 0.5)) / np.sqrt(5.25))
    )
