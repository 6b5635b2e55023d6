import collections
import gc
import os
import sys
from pathlib import Path

import hypothesis
import numpy as np
import pytest

hypothesis.settings.register_profile(
    "suite", deadline=None, derandomize=True, max_examples=60, print_blob=False
)
hypothesis.settings.load_profile("suite")
# A test's threads and blocks must not depend on the machine.
os.environ.setdefault("OMP_NUM_THREADS", "1")
# Until all tests are collected nearly nothing is garbage, and the search for it takes long.
gc.disable()


def pytest_addoption(parser):
    parser.addoption("--skipped", metavar="FILE", help="file of the names of skipped tests")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    """Leave all but every n-th case of a test that is sampled to runs of all tests."""
    counts = collections.Counter()
    for item in items:
        if (mark := item.get_closest_marker("sampled")) is not None:
            name = item.nodeid.partition("[")[0]
            if counts[name] % mark.args[0]:
                item.add_marker(pytest.mark.slow)
                item.add_marker(pytest.mark.rest)
            counts[name] += 1
    _skip_drawing(items)


def _skip_drawing(items):
    """Skip what draws where nothing draws, with the remedy; where CI is set it must draw."""
    drawing = [item for item in items if item.get_closest_marker("opengl")]
    if not drawing or os.environ.get("CI"):
        return
    from vizlight import render

    try:
        render.choose_backend()
    except render.BackendError as error:
        for item in drawing:
            item.add_marker(pytest.mark.skip(reason=str(error)))


def pytest_collection_finish():
    """Search for garbage in what the tests make, not in all that was imported and collected."""
    gc.collect()
    gc.freeze()
    gc.enable()


def pytest_terminal_summary(terminalreporter, config):
    if path := config.getoption("--skipped"):
        names = {report.nodeid for report in terminalreporter.stats.get("skipped", ())}
        Path(path).write_text("\n".join(sorted(names)), encoding="utf-8")


@pytest.fixture(autouse=True)
def own_account(monkeypatch):
    """Let no test pay for code that another would have saved time by: its results stay its own."""
    if "vizlight.geometry.relief.shadowing" in sys.modules:
        module = sys.modules["vizlight.geometry.relief.shadowing"]
        monkeypatch.setattr(module.walk, "missed", 0.0)


@pytest.fixture(autouse=True)
def closed_plotters():
    """Close the plotters of a test after it."""
    yield
    if "pyvista" in sys.modules:
        sys.modules["pyvista"].close_all()


@pytest.fixture
def few_strokes(monkeypatch):
    """Draw strokes and streamlines further apart than in pictures, in a fraction of the time."""
    from vizlight.looks.recipes import fields

    monkeypatch.setattr(fields, "SPACING", 3 * fields.SPACING)
    monkeypatch.setattr(fields, "SPACINGS_IN_VOLUME", (1 / 8, 1 / 12))


@pytest.fixture
def calls_of(monkeypatch):
    """Return a function that lists the arguments of the calls of one of a module or class."""

    def listed(owner, name):
        calls, plain = [], getattr(owner, name)
        monkeypatch.setattr(owner, name, lambda *a, **k: calls.append(a) or plain(*a, **k))
        return calls

    return listed


@pytest.fixture
def random():
    """Return a generator; its seed is another for ``python tests/claims.py --seed``."""
    return np.random.default_rng(int(os.environ.get("VIZLIGHT_SEED", "1994")))


@pytest.fixture
def seed():
    """Return a number by which inputs differ for ``python tests/claims.py --seed``, 0 without."""
    return int(os.environ.get("VIZLIGHT_SEED", "0"))


@pytest.fixture
def claim(record_property):
    """Return a function that holds what is found to what is stated, for the register of claims."""

    def hold(found, stated, name=""):
        record_property("claim", (name, (float(stated), float(found))))
        assert found <= stated

    return hold


@pytest.fixture(params=[np.float32, np.float64], ids=["float32", "float64"])
def dtype(request):
    return request.param
