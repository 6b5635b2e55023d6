"""Results do not depend on what ran before in the process, beyond their error."""

import subprocess
import sys

import numpy as np
import orders
import pytest

LIMIT = 120


@pytest.mark.slow
def test_filters_with_an_error_give_the_same_in_any_order_of_fresh_processes(tmp_path):
    names = [*orders.CASES]
    random = np.random.default_rng()
    runs = {"alone": names}
    runs["shuffled"] = random.permutation(names).tolist()
    for run, order in runs.items():
        (tmp_path / run).mkdir()
        command = [sys.executable, orders.__file__, str(tmp_path / run), *order]
        done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=LIMIT)
        assert done.returncode == 0, done.stderr
    for name, error in orders.ERRORS.items():
        first, *others = (np.load(tmp_path / run / f"{name}.npy") for run in runs)
        assert np.isfinite(first).any()
        for other in others:
            # The order is in the message, by which a failure is repeated.
            np.testing.assert_allclose(other, first, rtol=0, atol=error, err_msg=f"{name} {runs}")


@pytest.mark.parametrize("name", ["sky", "relief_shadow"])
def test_each_case_has_numbers_of_its_own(name, tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["orders.py", str(tmp_path), name])
    orders.main()
    assert np.ptp(np.load(tmp_path / f"{name}.npy")) > 0.1
