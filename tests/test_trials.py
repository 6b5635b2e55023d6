"""Files that end the process that reads them: another one reads them first."""

import os
import re
import signal
import sys
import threading
import time
import warnings
from functools import partial
from pathlib import Path

import pytest

from vizlight import _supervise, _trials

LINUX = sys.platform.startswith("linux")
forks = pytest.mark.skipif(not LINUX, reason="only a fork of Linux is safe")


def loads():
    """Remember the process that loads what reads files."""
    os.environ["LOADED_BY"] = str(os.getpid())


def reads(path, how):
    """Return why a file is refused, end the process as a library may, or never end."""
    if how == "loaded":
        return "" if os.environ["LOADED_BY"] == str(os.getppid()) else "loaded for it alone"
    if how == "hangs":
        time.sleep(50)
    if how == "leaves":
        Path(_trials.tempfile.mkdtemp(), "half").write_text("half")
    if how in ("ends", "leaves"):
        os.kill(os.getpid(), signal.SIGKILL)
    if how == "prints":
        os.write(1, b"printed")
        os.write(2, b"printed")
        sys.stdout.write("printed")
        warnings.warn("printed", stacklevel=1)
    if how == "where":
        return str(Path.cwd())
    return f"'{path}' is damaged" if how == "refuses" else ""


@pytest.fixture(autouse=True)
def _bare(monkeypatch):
    """Load no package that reads files in helpers."""
    monkeypatch.setattr(
        _trials, "_PROGRAM", _trials._PROGRAM.replace("import vizlight.files; ", "")
    )
    monkeypatch.setattr(_trials, "_helpers", {})
    monkeypatch.setenv("LOADED_BY", "nobody")
    yield
    _trials._end()


@pytest.fixture(params=["fork", "helper"])
def refusal(request, monkeypatch):
    """Return what tries a file in a fork of this process, or of another one."""
    if request.param == "helper":
        monkeypatch.setattr(_trials, "_FORKS", False)
    elif not LINUX or threading.active_count() > 1:
        pytest.skip("threads run, as those of a test runner")
    path = Path("a.e\udcff")
    return lambda how: _trials.refusal(loads, partial(reads, str(path), how), path, 0)


def test_a_reader_that_ends_well_says_what_it_refuses(refusal):
    assert refusal("reads") == ""
    assert refusal("refuses") == "'a.e\udcff' is damaged"


def test_packages_are_loaded_once_for_all_files(refusal):
    """By the process that is forked for each."""
    assert refusal("loaded") == ""


def test_a_crash_is_a_refusal(refusal, monkeypatch):
    words = re.escape(
        "file: expected a file that can be read, got 'a.e\udcff' (its reader was ended"
    )
    assert re.match(f"{words} by SIGKILL; the file may be damaged", refusal("ends"))
    # The next file is read none the less.
    assert refusal("reads") == ""


def test_a_reader_without_end_is_ended(refusal, monkeypatch):
    monkeypatch.setenv("VIZLIGHT_READ_SECONDS", "0.2")
    assert "(not read within 0 s; the file may be damaged" in refusal("hangs")
    monkeypatch.delenv("VIZLIGHT_READ_SECONDS")
    assert _supervise.read_limit(2_000_000, _trials.SECONDS, _trials.SECONDS_PER_MB) == 16


def test_nothing_is_printed_or_left(refusal, capfd, recwarn, tmp_path, monkeypatch):
    monkeypatch.setattr(_trials.tempfile, "tempdir", str(tmp_path))
    refusal("prints")
    refusal("leaves")
    assert capfd.readouterr() == ("", "")
    assert not recwarn.list
    assert not LINUX or not [*tmp_path.iterdir()]


def test_the_working_folder_is_that_of_the_caller(refusal, tmp_path, monkeypatch):
    for folder in (tmp_path, tmp_path.parent):
        monkeypatch.chdir(folder)
        assert Path(refusal("where")) == folder


@pytest.fixture
def helper():
    helper = _trials._Helper()
    yield helper
    helper.end()


def test_a_helper_without_forks_ends_at_a_file_that_may_spoil_others(helper, monkeypatch):
    alone = _trials._PROGRAM.replace("_trials.serve()", "_trials._FORKS = False; _trials.serve()")
    monkeypatch.setattr(_trials, "_PROGRAM", alone)
    assert helper.tried((loads, partial(reads, "a", "reads"), 9.0)) == (0, "")
    first = helper._process
    assert helper.tried((loads, partial(reads, "a", "refuses"), 9.0)) == (0, "'a' is damaged")
    assert first.wait(timeout=9) == 0
    code, _ = helper.tried((loads, partial(reads, "a", "hangs"), 0.1))
    assert "not read within 9 s" in _supervise.unreadable("a", code, 9)
    code, _ = helper.tried((loads, partial(reads, "a", "ends"), 9.0))
    assert "reader was ended by SIGKILL" in _supervise.unreadable("a", code, 9)


def test_a_helper_ends_with_its_parent_or_at_an_interrupt(helper, monkeypatch, tmp_path):
    assert helper.tried((loads, partial(reads, "a", "reads"), 9.0)) == (0, "")
    process = helper._process
    process.stdin.close()
    assert process.wait(timeout=9) == 0
    helper.tried((loads, partial(reads, "a", "reads"), 9.0))

    def interrupt(_file):
        while LINUX and not [*tmp_path.iterdir()]:
            time.sleep(0.01)  # until the trial has begun
        raise KeyboardInterrupt

    monkeypatch.setattr(
        _trials,
        "_PROGRAM",
        f"import os; os.environ['TMPDIR'] = {str(tmp_path)!r}; {_trials._PROGRAM}",
    )
    helper.end()
    assert helper.tried((loads, partial(reads, "a", "reads"), 9.0)) == (0, "")
    with monkeypatch.context() as reading:
        reading.setattr(_trials.pickle, "load", interrupt)
        with pytest.raises(KeyboardInterrupt):
            helper.tried((loads, partial(reads, "a", "hangs"), 9.0))
    assert not [*tmp_path.iterdir()]
    assert helper._process is None


def test_a_file_is_read_without_a_trial_where_none_can_be_made(helper, monkeypatch):
    assert helper.tried((loads, partial(reads, "a", lambda: "no value of a file"), 9.0)) == (0, "")
    monkeypatch.setattr(_trials, "_PROGRAM", "raise ImportError")
    assert helper.tried((loads, partial(reads, "a", "refuses"), 9.0)) == (0, "")
    monkeypatch.setattr(_trials.sys, "executable", "/none")
    assert helper.tried((loads, partial(reads, "a", "refuses"), 9.0)) == (0, "")
    monkeypatch.setattr(_trials.sys, "executable", "")
    assert not _trials.are_needed()


@forks
def test_an_interrupt_ends_a_fork(monkeypatch):
    def interrupt(number, _frame):
        raise KeyboardInterrupt

    children, fork = [], os.fork

    def forked():
        children.append(fork())
        signal.setitimer(signal.ITIMER_REAL, 0.1 if children[-1] else 0)
        return children[-1]

    monkeypatch.setattr(os, "fork", forked)
    replaced = signal.signal(signal.SIGALRM, interrupt)
    try:
        with pytest.raises(KeyboardInterrupt):
            _trials._forked((loads, partial(reads, "a", "hangs"), 30.0))
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, replaced)
    with pytest.raises(ChildProcessError):
        os.waitpid(children[0], os.WNOHANG)
    monkeypatch.setattr(os, "fork", lambda: os.kill(0x7FFFFFF0, 0))
    assert _trials._forked((loads, partial(reads, "a", "refuses"), 9.0)) == (0, "")
