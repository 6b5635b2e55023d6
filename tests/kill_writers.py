"""Kill the command line while it writes: ``python tests/kill_writers.py 89 --seed 1``.

A run replaces an existing file. It is killed at a random time, by a signal to the process that was
started. Afterwards the file is the old one or the new one, whole, and nothing else is left: not
after SIGTERM, SIGINT and SIGHUP; SIGKILL may leave one hidden folder, which no other run takes for
a result.
"""

import os
import signal
import subprocess
import sys
import time
from collections import Counter

import numpy as np
import pyvista as pv
from hostile.runner import ROOT, ask

SIGNALS = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGKILL)
SUFFIXES = ("vtp", "vtk", "vtu")
#: Points along one side of the surface, so that writing takes long enough to be hit.
SIDE = 300


def light(path, out, *, wait=None, by=None, random=None):
    """Run the command line; kill it as soon as it writes, after a share of the given time."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "VIZLIGHT_FAST": "0"}
    command = [sys.executable, "-m", "vizlight", "light", path, "-o", out]
    how = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "env": environment}
    started = subprocess.Popen(command, **how)
    if by is not None:
        while started.poll() is None and not drafts(out.parent):
            time.sleep(0.001)
        time.sleep(wait * random.random())
        started.send_signal(by)
    _, error = started.communicate(timeout=120)
    return started.returncode, error.decode()


def drafts(folder):
    """Return the folders in which files are written."""
    return [path for path in folder.iterdir() if path.name.startswith(".vizlight-")]


def fault(code, error, by, out, old, new):
    """Return what is wrong after a kill, an empty text if nothing is."""
    content = out.read_bytes()
    if content not in (old, new):
        return f"{len(content)} bytes, neither the old file nor the new one"
    if by == signal.SIGKILL:
        return "" if code in (0, -by) else f"exit code {code}"
    if drafts(out.parent):
        return f"left behind: {[path.name for path in drafts(out.parent)]}"
    if code not in (0, 2) or len(error.splitlines()) != bool(code):
        return f"exit code {code}: {error}"
    return ""


def run(total, seed, folder, say, suffixes=SUFFIXES):
    """Kill runs of the command line; return the number of those that failed, hit and missed."""
    mesh = pv.Plane(i_resolution=SIDE, j_resolution=SIDE)
    mesh.save(folder / "plane.vtp")
    counts, news, waits = Counter(), {}, {}
    (folder / "new").mkdir()
    for suffix in suffixes:
        # The titles of pages have the names of their files.
        out = folder / "new" / f"a.{suffix}"
        start = time.monotonic()
        code, error = light(folder / "plane.vtp", out)
        if code:
            raise SystemExit(error)
        news[suffix], waits[suffix] = out.read_bytes(), 0.2 * (time.monotonic() - start)
    for i in range(total):
        random = np.random.default_rng([seed, i])
        by, suffix = SIGNALS[i % len(SIGNALS)], suffixes[i % len(suffixes)]
        place = folder / f"{i}"
        place.mkdir()
        out = place / f"a.{suffix}"
        out.write_bytes(b"old")
        code, error = light(folder / "plane.vtp", out, wait=waits[suffix], by=by, random=random)
        wrong = fault(code, error, by, out, b"old", news[suffix])
        counts["failed" if wrong else "too late" if code == 0 else "killed"] += 1
        if wrong:
            say(f"{i} {by.name} {suffix}: {wrong}")
    return counts


if __name__ == "__main__":
    ask(run, 89)
