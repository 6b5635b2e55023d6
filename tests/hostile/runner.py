"""Run the command line many times from one process: each run is a fork that has all imported.

``run`` starts this file as a process of its own, which has no threads and forks once for each run;
there the command line forks its own child, as it does when it is started from a shell.
"""

from __future__ import annotations

import argparse
import atexit
import contextlib
import faulthandler
import gc
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
#: Seconds that a run may take, and bytes that it may allocate.
PATIENCE, MEMORY = 60.0, 4 << 30
#: What the packages that read files need, loaded once.
MODULES = (
    "vizlight.cli.commands", "vizlight.looks.look", "vizlight.accessor", "pyvista.plotting",
    "meshio",
    "nibabel", "xarray", "netCDF4", "trx.trx_file_memmap", "scipy.spatial",
)  # fmt: skip


class Run(NamedTuple):
    """What a run left behind: exit code (negative for a signal), streams, stray files."""

    code: int
    out: str
    err: str
    stray: list[str]


def run(commands, *, options=(), environment=None):
    """Return the result of each command, a list of words after ``vizlight``, in their order.

    ``options`` are Python's, ``environment`` has variables that are added.
    """
    server = subprocess.run(
        [sys.executable, *options, str(Path(__file__))],
        # Bytes, since a locale may not have all characters.
        input=json.dumps([[os.fsencode(word).hex() for word in words] for words in commands]),
        capture_output=True,
        text=True,
        check=True,
        env={
            **os.environ,
            "PYTHONPATH": str(ROOT),
            "OMP_NUM_THREADS": "1",
            "VTK_SMP_BACKEND_IN_USE": "Sequential",
            "VIZLIGHT_FAST": "0",
            "VIZLIGHT_READ_SECONDS": "5",
            **(environment or {}),
        },
    )
    return [Run(*json.loads(line)) for line in server.stdout.splitlines()]


def fault(run, path, content, out):
    """Return what is wrong with a run that lights a file, an empty text if nothing is.

    The file is lit (exit code 0, a whole result), or refused (2, one line). No input is changed
    and nothing else is left in the folder of the result.
    """
    lines = run.err.splitlines()
    left = [made.name for made in out.parent.iterdir() if made != out or run.code]
    wrong = {
        f"exit code {run.code}: {' '.join(lines)[:200]}": run.code not in (0, 2),
        f"standard error: {lines}": not all(line.startswith("vizlight: ") for line in lines),
        f"{len(lines)} lines: {lines}": run.code == 2 and len(lines) != 1,
        "the input was changed": path.read_bytes() != content,
        f"left behind: {left + run.stray}": left or run.stray,
        "no result": run.code == 0 and not out.is_file(),
    }
    return next((text for text, holds in wrong.items() if holds), "")


def _one(words):
    """Run one command in a fork with a folder of its own for temporary files."""
    # Not a TemporaryDirectory, which a fork that ends would remove.
    own = tempfile.mkdtemp()
    try:
        temporary = Path(own, "tmp")
        temporary.mkdir()
        pid = os.fork()
        if not pid:
            _child(words, own, temporary)
        code = _wait(pid, time.monotonic() + PATIENCE)
        out, err = (Path(own, name).read_text(errors="replace") for name in ("out", "err"))
        return Run(code, out, err, [path.name for path in temporary.iterdir()])
    finally:
        shutil.rmtree(own)


def _child(words, own, temporary):
    os.setsid()
    for number, name in ((1, "out"), (2, "err")):
        os.dup2(os.open(Path(own, name), os.O_CREAT | os.O_WRONLY), number)
    faulthandler.register(signal.SIGUSR1)
    atexit._clear()  # what the server has to remove at its end
    code = 70
    try:
        from vizlight import _supervise, cli

        tempfile.tempdir = os.environ["TMPDIR"] = str(temporary)
        resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))
        code = _supervise.run(lambda: cli.main(words))
        atexit._run_exitfuncs()
        sys.stdout.flush()
        sys.stderr.flush()
    except BaseException:  # noqa: BLE001 - the fork must not return
        import traceback

        traceback.print_exc()
    finally:
        os._exit(code)


def _wait(pid, end):
    """Return the exit code of a child, negative for a signal; one that is late is killed."""
    while True:
        done, status = os.waitpid(pid, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        if time.monotonic() > end:
            os.killpg(pid, signal.SIGUSR1)  # each process says where it is
            time.sleep(0.5)
            os.killpg(pid, signal.SIGKILL)
            os.waitpid(pid, 0)
            return -signal.SIGKILL
        time.sleep(0.002)


def ask(run, count):
    """Be the command line of a tool, which a count and a seed repeat; end with 1 if a run failed.

    ``run`` takes both, an empty folder, and what says a line; it counts what came out.
    """
    parser = argparse.ArgumentParser()
    parser.add_argument("count", type=int, nargs="?", default=count)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        counts = run(given.count, given.seed, Path(folder), lambda text: print(text, flush=True))
    print(", ".join(f"{n} {what}" for what, n in sorted(counts.items())))
    sys.exit(int(bool(counts["failed"])))


def warm_up():
    """Light a mesh, so that what is made at the first call is there before the forks."""
    import pyvista as pv

    from vizlight import cli

    with tempfile.TemporaryDirectory() as folder:
        pv.Sphere(theta_resolution=8, phi_resolution=8).save(f"{folder}/a.vtp")
        with contextlib.redirect_stdout(None):
            cli.main(["light", f"{folder}/a.vtp", "-o", f"{folder}/b.vtp"])
    if len(list(Path("/proc/self/task").iterdir())) > 1:
        raise RuntimeError("threads run, which a fork does not have")


def main():
    """Run the commands on standard input and print the results, one line each."""
    import importlib
    import importlib.util

    # Written once here, not by every fork.
    commands = [[os.fsdecode(bytes.fromhex(x)) for x in words] for words in json.load(sys.stdin)]
    for name in MODULES:
        if importlib.util.find_spec(name.partition(".")[0]):
            importlib.import_module(name)
    warm_up()
    gc.freeze()  # else a collection in each fork copies all that was imported
    for words in commands:
        sys.stdout.write(f"{json.dumps(_one(words))}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
