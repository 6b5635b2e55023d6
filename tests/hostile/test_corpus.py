"""Hostile files give the exit code and the line that are written down."""

from __future__ import annotations

import sys

import pytest
from hostile import corpus, runner

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Linux starts a child")


def test_hostile_files(tmp_path):
    paths = []
    for name, case in corpus.CASES.items():
        paths.append(tmp_path / name)
        paths[-1].write_bytes(case.content)
    (tmp_path / "out").mkdir()
    outs = [tmp_path / "out" / f"{path.name}.vtk" for path in paths]
    pairs = zip(paths, outs, strict=True)
    found = runner.run([["light", str(path), "-o", str(out)] for path, out in pairs])
    wrong = []
    for (name, case), path, out, run in zip(corpus.CASES.items(), paths, outs, found, strict=True):
        lines = run.err.splitlines()
        right = (
            run.code == case.code
            and case.words in run.err
            and all(line.startswith("vizlight: ") for line in lines)
            and (run.code == 0 or len(lines) == 1)
            and out.is_file() == (run.code == 0)
            and path.read_bytes() == case.content
            and not run.stray
        )
        if not right:
            wrong.append(f"{name}: {run.code} {run.err}{run.stray}")
    assert not wrong, "\n".join(wrong)
    assert len(list((tmp_path / "out").iterdir())) == sum(not run.code for run in found)


def test_the_files_are_small():
    assert sum(len(case.content) for case in corpus.CASES.values()) < 200_000
