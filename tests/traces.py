"""What a command leaves while it runs: sockets that listen, and files where others could look."""

from __future__ import annotations

import stat
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple


class Traces(NamedTuple):
    """What was seen of a command: code, streams, processes, sockets, and open temporary files."""

    code: int
    out: str
    err: str
    processes: int
    sockets: set[str]
    files: dict[str, str]


def listening(pids):
    """Return the sockets of some processes that listen, by the tables of the kernel."""
    found = set()
    for table, state, listens, inode in (
        ("tcp", 3, "0A", 9), ("tcp6", 3, "0A", 9), ("unix", 3, "00010000", 6),
    ):  # fmt: skip
        for row in Path(f"/proc/net/{table}").read_text().splitlines()[1:]:
            fields = row.split()
            if fields[state] == listens:
                found.add(f"socket:[{fields[inode]}]")
    own = set()
    for pid in pids:
        for link in Path(f"/proc/{pid}/fd").glob("*"):
            try:
                own.add(str(link.readlink()))
            except OSError:  # it was closed meanwhile
                continue
    return found & own


def children(pid):
    """Return a process and all below it."""
    tasks = Path(f"/proc/{pid}/task").glob("*/children")
    return [pid, *(one for task in tasks for own in task.read_text().split()
                   for one in children(int(own)))]  # fmt: skip


def open_to_others(root):
    """Return the modes of the files below a folder that other users could read or write.

    What is in a private folder is private.
    """
    found = {}
    for path in root.iterdir():
        try:
            mode = stat.S_IMODE(path.lstat().st_mode)
            if mode & 0o077:
                found[path.name] = oct(mode)
                if path.is_dir():
                    found |= open_to_others(path)
        except OSError:  # it is gone
            continue
    return found


def watched(words, temporary, **options):
    """Run a command and look every few milliseconds; ``temporary`` are folders for its files."""
    processes, sockets, files = 0, set(), {}
    with subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, umask=0, **options
    ) as run:
        while run.poll() is None:
            try:
                there = children(run.pid)
                sockets |= listening(there)
                processes = max(processes, len(there))
            except OSError:  # one ended meanwhile
                pass
            for folder in temporary:
                files |= open_to_others(folder)
            time.sleep(0.01)
        return Traces(run.returncode, *run.communicate(), processes, sockets, files)


def of_vizlight(arguments, temporary, **options):
    """Watch a command of the command line."""
    return watched([sys.executable, "-m", "vizlight", *arguments], temporary, **options)
