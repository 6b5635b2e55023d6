"""A sample of the random walks of ``python tests/walks.py``, and faults that they find."""

import subprocess
import sys

import numpy as np
import pytest
import walks
from hostile import seeds

pytestmark = pytest.mark.skipif(not hasattr(sys, "getdlopenflags"), reason="forks")


@pytest.mark.slow
def test_twenty_walks():
    # A process without threads, which forks.
    run = subprocess.run(
        [sys.executable, walks.__file__, "20", "--seed", "3"],
        check=False,
        capture_output=True,
        text=True,
    )
    assert (run.returncode, run.stdout) == (0, "20 walks\n"), run.stdout + run.stderr


def raw(mesh, random):
    return mesh.points[len(mesh.points)]


def changed(mesh, random):
    mesh.points[0] = 9
    return mesh


def dark(mesh, random):
    mesh = mesh.copy()
    mesh["luminance"] = np.full(mesh.n_points, np.nan)
    return mesh


@pytest.mark.parametrize(
    ("step", "words"), [(raw, "raw IndexError"), (changed, "changed"), (dark, "not finite")]
)
def test_faults_are_found(step, words):
    wrong, _ = walks.fault("illuminate", step, seeds.ball(), np.random.default_rng(0))
    assert words in wrong
