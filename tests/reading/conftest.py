"""How the tests of readers read files."""

import pytest

from vizlight import _trials


@pytest.fixture
def without_trial(monkeypatch):
    """Read files at once; tests of damaged, real and all kinds of files try them first."""
    monkeypatch.setattr(_trials, "are_needed", lambda: False)
