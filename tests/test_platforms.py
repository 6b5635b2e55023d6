"""Where the names of POSIX are missing, as on Windows, every module loads and the main job runs."""

import subprocess
import sys

import pytest

#: Takes away what only POSIX has, once the packages that vizlight needs are loaded.
WITHOUT_POSIX = """
import concurrent.futures.process, importlib, multiprocessing, os, pkgutil, signal, subprocess, sys
from pathlib import Path
import cyclopts.completion, pyvista, scipy.optimize, scipy.spatial
missing = {
    signal: ("SIGHUP", "SIGKILL", "SIGALRM", "SIGCHLD", "SIGPIPE", "SIGUSR1", "pthread_sigmask",
             "SIG_BLOCK", "SIG_UNBLOCK", "alarm", "setitimer"),
    os: ("fork", "getuid", "geteuid", "mkfifo", "posix_fallocate", "sched_getaffinity", "killpg",
         "setsid", "sysconf", "fchmod", "uname", "wait4", "nice"),
}
for module, names in missing.items():
    for name in names:
        vars(module).pop(name, None)
for name in ("fcntl", "grp", "pwd", "resource", "termios"):
    sys.modules[name] = None
"""
LOADED = """
import vizlight
for found in pkgutil.walk_packages(vizlight.__path__, "vizlight."):
    left_out = (".vtk.paraview.", "__main__", "vizlight.xarray")
    if not any(name in found.name for name in left_out):
        importlib.import_module(found.name)
"""
USED = """
import vizlight
from vizlight import cli, files
mesh = pyvista.Sphere()
mesh["V"] = mesh.points
files.write_mesh(mesh, "größe.vtp")
assert vizlight.read("größe.vtp").n_points == mesh.n_points
asked = ["größe.vtp", "-o", "a.png", "-o", "a.html", "-o", "a.vtp", "--size", "60x40"]
assert cli.main(["light", *asked]) == cli.OK
assert all(Path(name).stat().st_size for name in ("a.png", "a.html", "a.vtp"))
assert {path.suffix for path in Path().iterdir()} == {".vtp", ".png", ".html"}
"""


def run(code, folder):
    command = [sys.executable, "-W", "ignore", "-c", WITHOUT_POSIX + code]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
def test_every_module_loads(tmp_path):
    run(LOADED, tmp_path)


@pytest.mark.slow
@pytest.mark.opengl
def test_a_file_is_read_lit_drawn_and_written(tmp_path):
    run(USED, tmp_path)
