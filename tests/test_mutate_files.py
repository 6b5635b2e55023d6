"""Damaged files of all kinds are refused, or lit as what they hold."""

from __future__ import annotations

import sys

import mutate_files
import numpy as np
import pytest
from hostile import runner

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Linux starts a child")
RUN = runner.Run(2, "", "vizlight: file: no\n", 0.1, [])


@pytest.mark.slow
def test_two_hundred_damaged_files(tmp_path):
    failed = []
    counts = mutate_files.run(200, 1, tmp_path, report=failed.append)
    assert not failed, "\n".join(failed)
    assert sum(counts.values()) == 200
    assert min(sum(n for (_, k), n in counts.items() if k == kind) for kind in ("refused", "lit"))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"code": -11}, "exit code -11"),
        ({"code": 1}, "exit code 1"),
        ({"err": "Traceback (most recent call last):\n"}, "standard error: Traceback"),
        ({"err": "vizlight: a\nvizlight: b\n"}, "2 lines"),
        ({"stray": ["half"]}, "left behind"),
        ({"code": 0, "err": ""}, "no result"),
    ],
)
def test_what_is_wrong_is_seen(change, words, tmp_path):
    path = tmp_path / "a.vtk"
    path.write_bytes(b"a")
    (tmp_path / "out").mkdir()
    wrong = mutate_files.fault(
        RUN._replace(**change), path, b"a", tmp_path / "out" / "b.vtk", mutate_files.cut, None
    )
    assert words in wrong


def test_an_input_that_is_changed_is_seen(tmp_path):
    path = tmp_path / "a.vtk"
    path.write_bytes(b"b")
    (tmp_path / "out").mkdir()
    out = tmp_path / "out" / "b.vtk"
    assert "changed" in mutate_files.fault(RUN, path, b"a", out, mutate_files.cut, None)


@pytest.mark.parametrize("mutation", dict.fromkeys(mutate_files.MUTATIONS))
def test_a_mutation_is_repeated_from_its_seed(mutation):
    data = b"POINTS 12 float " + bytes(range(256))
    made = {mutation(data, np.random.default_rng(seed)) for seed in range(20)}
    assert mutation(data, np.random.default_rng(3)) in made
    assert len(made) > 10
