"""The study's numbers are those of a short run: errors, not times."""

from __future__ import annotations

import numpy as np
import pytest

from studies import relief
from vizlight import _compiled


def test_error_and_memory():
    numpys, *compiled = relief.measure(128, repeats=1)
    assert numpys.error == 0
    # What is worked on at a time has a fixed size; the rest grows with the field.
    assert numpys.more["bytes per point"] * 128**2 < 50e6 + 100 * 128**2
    assert numpys.cost > 0
    assert len(compiled) == _compiled.active()
    assert all(row.error < 1e-12 for row in compiled)


def test_hemisphere():
    coarse, fine = (relief.hemisphere(n)[0] for n in (151, 601))
    assert fine < 1e-3
    assert fine < coarse / 4


def test_hills_are_the_same_again():
    np.testing.assert_array_equal(relief.hills(64), relief.hills(64))
    assert abs(np.ptp(relief.hills(64)) - relief.HIGH) < 1e-12


@pytest.mark.filterwarnings("ignore:Please import:DeprecationWarning")
def test_hard_shadows_have_few_nodes_on_the_wrong_side():
    ours, *_ = relief.hard(96)
    assert ours.way.startswith("hard shadow")
    assert ours.error < 0.02


def test_rays_in_small_steps_see_a_wall():
    """A wall of height 10 under a sun at 45 degrees shades the 9 nodes behind it."""
    z = np.zeros((30, 60))
    z[:, 40:] = 10.0
    toward = np.array([1.0, 0.0, 1.0]) / np.sqrt(2)
    at = np.stack([np.full(60, 15), np.arange(60)], axis=1)
    seen = relief.lit_places(z, at, toward)
    np.testing.assert_array_equal(seen, (np.arange(60) <= 30) | (np.arange(60) >= 40))
