"""The study's numbers are those of a short run: errors, not times."""

from __future__ import annotations

import numpy as np

from vizlight.studies import relief


def test_error_and_memory_of_the_fast_method():
    fast, exact = relief.measure(256, repeats=1)
    assert 0 < fast.error < 3e-2
    # What is worked on at a time has a fixed size; the rest grows with the field.
    assert fast.more["bytes a point"] * 256**2 < 50e6 + 100 * 256**2
    assert min(fast.cost, exact.cost) > 0


def test_hemisphere():
    for method in ("fast", "exact"):
        coarse, fine = (relief.hemisphere(n, method)[0] for n in (151, 601))
        assert fine < 1e-3
        assert fine < coarse / 4


def test_hills_are_the_same_again():
    np.testing.assert_array_equal(relief.hills(64), relief.hills(64))
    assert abs(np.ptp(relief.hills(64)) - relief.HIGH) < 1e-12
