"""Damaged files of all kinds are refused, or lit as what they hold."""

from __future__ import annotations

import sys

import mutate_files
import numpy as np
import pytest

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Linux starts a child")


@pytest.mark.slow
def test_two_hundred_damaged_files(tmp_path):
    failed = []
    counts = mutate_files.run(200, 1, tmp_path, report=failed.append)
    assert not failed, "\n".join(failed)
    assert sum(counts.values()) == 200
    assert min(sum(n for (_, k), n in counts.items() if k == kind) for kind in ("refused", "lit"))


@pytest.mark.parametrize("mutation", dict.fromkeys(mutate_files.MUTATIONS))
def test_a_mutation_is_repeated_from_its_seed(mutation):
    data = b"POINTS 12 float " + bytes(range(256))
    made = {mutation(data, np.random.default_rng(seed)) for seed in range(20)}
    assert mutation(data, np.random.default_rng(3)) in made
    assert len(made) > 10
