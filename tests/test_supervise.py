"""The parent of the command line: signals and limits become one line and an exit code."""

import os
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import pytest

from vizlight import _supervise

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
#: Replaces the last line: a signal comes when the child has ended.
LATE = """
parent = os.getpid()
code = _supervise.run(main)
if os.getpid() == parent:
    os.kill(parent, signal.{name})
sys.exit(code)
"""


def started(body, last="sys.exit(_supervise.run(main))", **environment):
    code = HEAD.format(body=textwrap.indent(textwrap.dedent(body), "    "))
    return subprocess.Popen(
        [sys.executable, "-c", code.replace("sys.exit(_supervise.run(main))", last)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, **environment},
    )


def run(body, *last, **environment):
    process = started(body, *last, **environment)
    out, error = process.communicate(timeout=60)
    return process.returncode, out, error


def signalled(body, name):
    """Return what is left of a child, whose first line says that it is ready, after a signal."""
    process = started(body)
    word, *more = process.stdout.readline().split()
    assert word == "ready"
    process.send_signal(getattr(signal, name))
    _, error = process.communicate(timeout=30)
    return process.returncode, error, more


@pytest.mark.parametrize("code", [0, 1, 2, 7])
def test_the_exit_code_and_output_of_the_child_are_kept(code):
    assert run(f"print('made'); return {code}") == (code, "made\n", "")


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_a_signal_after_the_end_of_the_child_is_too_late(name):
    assert run("return 3", LATE.format(name=name)) == (3, "", "")


READ = "with _supervise.stage('read', 'a.ply'):\n    "
INNER = "with _supervise.stage('draw', 'a.png'), _supervise.stage('write', 'b.vtp'):\n    "


@pytest.mark.parametrize(
    ("head", "code", "words"),
    [
        (READ, 2, ["file: expected a file that can be read, got 'a.ply'", "may be damaged"]),
        (INNER, 2, ["output: expected a file that can be written, got 'b.vtp'", "disk full?"]),
        ("with _supervise.stage('draw', 'a'):\n    ", 1, ["no picture", "vizlight doctor"]),
        (f"{READ}pass\n", 1, ["vizlight: the process was ended by"]),
    ],
)
@pytest.mark.parametrize("name", ["SIGSEGV", "SIGKILL"])
def test_a_crash_is_one_line_that_says_what_was_done(head, code, words, name):
    got = run(f"{head}os.kill(os.getpid(), signal.{name})")
    assert got[:2] == (code, "")
    assert got[2].count("\n") == 1
    for word in (name, *words):
        assert word in got[2]
    assert ("(out of memory?)" in got[2]) == (name == "SIGKILL" and code == 1)


def test_a_file_that_is_never_read_ends_at_the_limit():
    body = """
        with _supervise.stage('read', 'a.vti', seconds=_supervise.read_limit(1000)):
            with _supervise.stage('read', 'b.vti', seconds=9):
                pass
            time.sleep(50)
    """
    start = time.monotonic()
    code, _, error = run(body, VIZLIGHT_READ_SECONDS="0.2")
    assert time.monotonic() - start < 30
    assert code == 2
    assert "'a.vti' (not read within 0 s; the file may be damaged, VIZLIGHT_READ_SEC" in error


def test_a_stage_that_ends_in_time_has_no_limit_after_it():
    body = "with _supervise.stage('read', 'a', seconds=0.3):\n    pass\ntime.sleep(0.6); return 4"
    assert run(body)[0] == 4
    with _supervise.stage("read", "a", seconds=1e-9):
        time.sleep(0.01)


def test_a_count_beyond_memory_is_refused_at_once():
    assert run("try:\n    bytearray(1 << 50)\nexcept MemoryError:\n    return 3")[0] == 3


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_signal_to_the_parent_ends_the_child_and_leaves_nothing(tmp_path, name):
    body = f"""
        folder = tempfile.mkdtemp(dir={str(tmp_path)!r})
        with _supervise.stage('write', 'a.vtp', temporary=folder):
            Path(folder, 'half').write_text('half')
            print('ready', os.getpid(), flush=True)
            time.sleep(50)
    """
    code, error, (child,) = signalled(body, name)
    assert (code, error) == (2, f"vizlight: ended by {name}; no partial file is left\n")
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
    assert signalled(body, "SIGINT")[0] == 5


@pytest.mark.slow
def test_a_child_that_ignores_ctrl_c_is_killed():
    body = """
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        print('ready', flush=True)
        time.sleep(50)
    """
    code, error, _ = signalled(body, "SIGINT")
    assert (code, error) == (2, "vizlight: interrupted by SIGINT; no partial file is left\n")


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


def test_what_ends_a_child_that_has_said_all_is_no_news():
    body = "import atexit; atexit.register(os.kill, os.getpid(), signal.SIGKILL); return 3"
    assert run(body) == (3, "", "")


def test_the_child_dies_with_its_parent():
    parent = started("print('ready', os.getpid(), flush=True)\ntime.sleep(50)")
    child = int(parent.stdout.readline().split()[1])
    parent.kill()
    parent.communicate(timeout=30)
    for _ in range(100):
        status = Path(f"/proc/{child}/stat")
        if not status.exists() or status.read_text().split()[2] == "Z":
            return
        time.sleep(0.05)
    pytest.fail("the child goes on without its parent")


def test_where_threads_run_no_child_is_started():
    body = """
        import threading
        threading.Thread(target=time.sleep, args=(0.5,)).start()
        me = os.getpid()
        return 4 if _supervise.run(lambda: int(os.getpid() != me)) == 0 else 5
    """
    assert run(body)[0] == 4
