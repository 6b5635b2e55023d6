"""The command line as the tests call it."""

from __future__ import annotations

import pytest

from vizlight import cli


@pytest.fixture
def run(capfd):
    """Return what runs words, of which a string may have several: exit code, output, errors."""

    def call(*arguments):
        code = cli.main([word for each in arguments for word in str(each).split()])
        return (code, *capfd.readouterr())

    return call
