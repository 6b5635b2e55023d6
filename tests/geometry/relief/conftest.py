"""Compiled code and NumPy in turn, for the tests of both."""

import pytest

from vizlight import _compiled


@pytest.fixture(params=["NumPy", "compiled"])
def each_code(request, monkeypatch):
    """Run a test by NumPy alone, and by compiled code from the first ray on."""
    monkeypatch.setenv("VIZLIGHT_FAST", "1" if request.param == "compiled" else "0")
    if request.param == "compiled" and not _compiled.active():
        pytest.skip(_compiled.why_not())
    return request.param
