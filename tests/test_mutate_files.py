"""Damaged files of all kinds are refused, or lit as what they hold."""

import re
import sys

import mutate_files
import pytest
from hostile import corpus, runner

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Linux starts a child")
RUN = runner.Run(2, "", "vizlight: file: no\n", [])


@pytest.mark.slow
def test_hostile_files(tmp_path):
    """Each gives the exit code and the line that are written down."""
    wrong = corpus.faults(tmp_path)
    assert not wrong, "\n".join(wrong)


@pytest.mark.slow
def test_sixty_damaged_files(tmp_path):
    failed = []
    counts = mutate_files.run(60, 1, tmp_path, failed.append)
    assert not failed, "\n".join(failed)
    assert counts["refused"] + counts["lit"] == 60
    assert min(counts.values()) > 0


@pytest.mark.parametrize(
    ("change", "content", "words"),
    [
        ({"code": -11}, b"a", "exit code -11"),
        ({"code": 1}, b"a", "exit code 1"),
        ({"err": "Traceback (most recent call last):\n"}, b"a", r"standard error: \['Traceback"),
        ({"err": "vizlight: a\nvizlight: b\n"}, b"a", "2 lines"),
        ({"stray": ["half"]}, b"a", "left behind"),
        ({"code": 0, "err": ""}, b"a", "no result"),
        ({}, b"b", "changed"),
    ],
)
def test_what_is_wrong_is_seen(change, content, words, tmp_path):
    path, out = tmp_path / "a.vtk", tmp_path / "out" / "b.vtk"
    out.parent.mkdir()
    path.write_bytes(b"a")
    assert re.search(words, runner.fault(RUN._replace(**change), path, content, out))
