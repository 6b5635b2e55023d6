"""Hostile files give the exit code and the line that are written down."""

from __future__ import annotations

import sys

import pytest
from hostile import corpus


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Linux starts a child")
def test_hostile_files(tmp_path):
    wrong = corpus.faults(tmp_path)
    assert not wrong, "\n".join(wrong)


def test_the_files_are_small():
    assert sum(len(case.content) for case in corpus.CASES.values()) < 200_000
