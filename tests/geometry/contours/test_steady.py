"""Samples moved within a tolerance: noise goes, edges and flat colours stay."""

import numpy as np
import pytest

from vizlight.geometry.contours.steady import slopes, steadied

SCALE = 3


def sheet(noise):
    """Return a slope with an edge and noise of whole pixels, in samples."""
    x, y = np.meshgrid(np.arange(60), np.arange(40))
    pixels = 0.5 * x + np.where(y < 20, 0.0, 150.0)
    pixels = pixels + noise * np.random.default_rng(5).uniform(-1, 1, pixels.shape)
    return np.kron(pixels, np.ones((SCALE, SCALE)))[..., np.newaxis].astype(np.float32)


def test_noise_below_the_tolerance_goes_and_no_sample_moves_farther():
    samples = sheet(1.0)
    moved = steadied(samples, np.ones(samples.shape[:2], dtype=bool), SCALE, 1.0)
    assert np.abs(moved - samples).max() <= 1.0 + 1e-4
    inner = (slice(15, 45), slice(30, 150))
    before, after = (np.std(a[inner] - sheet(0.0)[inner]) for a in (samples, moved))
    assert after < 0.6 * before


def test_flat_colours_and_background_stay_as_they_are():
    flat = np.where(np.arange(90) < 40, 10.0, 200.0) * np.ones((60, 1))
    flat = flat[..., np.newaxis].astype(np.float32)
    shown = np.ones((60, 90), dtype=bool)
    assert np.array_equal(steadied(flat, shown, SCALE, 2.0), flat)
    samples = sheet(1.0)
    shown = np.zeros(samples.shape[:2], dtype=bool)
    assert np.array_equal(steadied(samples, shown, SCALE, 2.0), samples)


def test_slopes_are_changes_for_a_pixel():
    x = np.arange(50, dtype=np.float32) / SCALE
    samples = np.broadcast_to(7 * x, (20, 50))[..., np.newaxis]
    assert slopes(samples, SCALE) == pytest.approx(7, rel=1e-4)
