"""Compiled orders against those of NumPy."""

from __future__ import annotations

import math

import numpy as np
import pytest

from vizlight import _compiled
from vizlight.geometry.relief import strips

pytestmark = pytest.mark.skipif(not _compiled.active(), reason="numba is not available")


def test_ranks_are_those_of_a_sort(random):
    """Values in few buckets, all equal, of few, and with infinities of spread."""
    count = 500
    crowd = np.append(random.uniform(0, 1e-9, count - 1), 1e9)
    for values in (random.normal(size=count), crowd, np.zeros(9), np.ones(1), crowd[::-1] / 1e300):
        key, order = np.empty(len(values)), np.empty(len(values), np.int32)
        ends = np.empty(len(values) + 1, np.int32)
        rate = strips.sort(values, key, order, ends)
        np.testing.assert_array_equal(key, np.sort(values))
        np.testing.assert_array_equal(values[order], key)
        assert math.isfinite(rate)
        for value in (*values[:40], -1e10, 1e10, 0.5e-9):
            ours = strips.below.function(key, ends, rate, value)
            assert ours == np.searchsorted(key, value)


def test_groups_keep_the_order_of_rays(random):
    keys = random.integers(0, 7, 100).astype(np.int32)
    ends, order = np.empty(9, np.int64), np.empty(100, np.int32)
    strips.group(keys, ends, order)
    np.testing.assert_array_equal(order, np.argsort(keys, kind="stable"))
    np.testing.assert_array_equal(ends, [*np.searchsorted(np.sort(keys), np.arange(8)), 100])
