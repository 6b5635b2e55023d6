"""The parent of the command line: signals and limits become one line and an exit code."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Linux starts a child")

HEAD = """
import os, signal, sys, tempfile, time
from pathlib import Path
from vizlight import _supervise

for name in (signal.SIGINT, signal.SIGHUP):
    signal.signal(name, signal.default_int_handler if name == signal.SIGINT else signal.SIG_DFL)

def main():
{body}

sys.exit(_supervise.run(main))
"""


def script(body):
    return [sys.executable, "-c", HEAD.format(body=textwrap.indent(textwrap.dedent(body), "    "))]


def run(body, **environment):
    done = subprocess.run(
        script(body),
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
        env={**os.environ, **environment},
    )
    return done.returncode, done.stdout, done.stderr


def started(body):
    return subprocess.Popen(script(body), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.mark.parametrize("code", [0, 1, 2, 7])
def test_the_exit_code_and_output_of_the_child_are_kept(code):
    assert run(f"print('made'); return {code}") == (code, "made\n", "")


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_a_signal_after_the_end_of_the_child_is_too_late(name):
    late = f"""
parent = os.getpid()
code = _supervise.run(main)
if os.getpid() == parent:
    os.kill(parent, signal.{name})
sys.exit(code)
"""
    code = script("return 3")[2].replace("sys.exit(_supervise.run(main))", late)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (3, b"")


CRASH = "os.kill(os.getpid(), signal.{name})"


@pytest.mark.parametrize(
    ("doing", "code", "words"),
    [
        ("read", 2, ["file: expected a file that can be read, got 'a.ply'", "may be damaged"]),
        ("write", 2, ["output: expected a file that can be written", "is the disk full?"]),
        ("draw", 1, ["no picture", "vizlight doctor"]),
    ],
)
@pytest.mark.parametrize("name", ["SIGSEGV", "SIGABRT"])
def test_a_crash_is_one_line_that_says_what_was_done(doing, code, words, name):
    got = run(f"with _supervise.stage('{doing}', 'a.ply'):\n    {CRASH.format(name=name)}")
    assert got[:2] == (code, "")
    assert got[2].count("\n") == 1
    for word in (name, *words):
        assert word in got[2]


def test_a_crash_after_a_stage_does_not_blame_it():
    body = f"with _supervise.stage('read', 'a.ply'):\n    pass\n{CRASH.format(name='SIGKILL')}"
    code, _, error = run(body)
    assert code == 1
    assert "a.ply" not in error
    assert "SIGKILL (out of memory?)" in error


def test_the_innermost_stage_is_named():
    body = f"""
        with _supervise.stage('draw', 'a.png'), _supervise.stage('write', 'b.vtp'):
            {CRASH.format(name="SIGSEGV")}
    """
    code, _, error = run(body)
    assert code == 2
    assert "b.vtp" in error


def test_a_file_that_is_never_read_ends_at_the_limit():
    body = """
        with _supervise.stage('read', 'a.vti', seconds=_supervise.read_limit(1000)):
            time.sleep(50)
    """
    start = time.monotonic()
    code, _, error = run(body, VIZLIGHT_READ_SECONDS="0.2")
    assert time.monotonic() - start < 30
    assert code == 2
    assert "not read within" in error
    assert "VIZLIGHT_READ_SECONDS" in error


def test_a_count_beyond_memory_is_refused_at_once():
    body = """
        try:
            bytearray(1 << 50)
        except MemoryError:
            return 3
    """
    assert run(body)[0] == 3


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_signal_to_the_parent_ends_the_child_and_leaves_nothing(tmp_path, name):
    body = f"""
        folder = tempfile.mkdtemp(dir={str(tmp_path)!r})
        with _supervise.stage('write', 'a.vtp', temporary=folder):
            Path(folder, 'half').write_text('half')
            print('ready', os.getpid(), flush=True)
            time.sleep(50)
    """
    parent = started(body)
    word, child = parent.stdout.readline().split()
    assert word == "ready"
    assert list(tmp_path.iterdir())
    parent.send_signal(getattr(signal, name))
    _, error = parent.communicate(timeout=30)
    assert parent.returncode == 2
    assert error == f"vizlight: ended by {name}; no partial file is left\n"
    assert not list(tmp_path.iterdir())
    with pytest.raises(ProcessLookupError):
        os.kill(int(child), 0)


def test_ctrl_c_reaches_the_child_also_if_it_was_sent_to_the_parent_alone():
    body = """
        try:
            print('ready', flush=True)
            time.sleep(50)
        except KeyboardInterrupt:
            return 5
    """
    parent = started(body)
    assert parent.stdout.readline() == "ready\n"
    parent.send_signal(signal.SIGINT)
    parent.communicate(timeout=30)
    assert parent.returncode == 5


def test_ctrl_c_is_reported_once_though_it_comes_again():
    body = """
        try:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(50)
        except KeyboardInterrupt:
            for _ in range(3):
                os.kill(os.getpid(), signal.SIGINT)
                time.sleep(0.01)
            print('interrupted', file=sys.stderr)
            return 2
    """
    assert run(body) == (2, "", "interrupted\n")


def test_a_child_that_ignores_ctrl_c_is_killed():
    body = """
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        print('ready', flush=True)
        time.sleep(50)
    """
    parent = started(body)
    assert parent.stdout.readline() == "ready\n"
    parent.send_signal(signal.SIGINT)
    _, error = parent.communicate(timeout=30)
    assert parent.returncode == 2
    assert error == "vizlight: interrupted by SIGINT; no partial file is left\n"


def test_the_child_dies_with_its_parent():
    body = """
        print('ready', os.getpid(), flush=True)
        time.sleep(50)
    """
    parent = started(body)
    child = int(parent.stdout.readline().split()[1])
    parent.kill()
    parent.communicate(timeout=30)
    for _ in range(100):
        try:
            state = Path(f"/proc/{child}/stat").read_text().split()[2]
        except FileNotFoundError:
            return
        if state == "Z":
            return
        time.sleep(0.05)
    pytest.fail("the child goes on without its parent")


def test_without_a_parent_a_stage_does_nothing(tmp_path):
    from vizlight import _supervise

    with _supervise.stage("read", tmp_path, seconds=0.0):
        pass


def test_where_threads_run_no_child_is_started():
    body = """
        import threading
        threading.Thread(target=time.sleep, args=(0.5,)).start()
        me = os.getpid()
        return 4 if _supervise.run(lambda: int(os.getpid() != me)) == 0 else 5
    """
    assert run(body)[0] == 4
