"""No command opens a way in, or leaves what other users could read, while it runs or after."""

import os
import socket
import sys
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
import traces

from vizlight import cli
from vizlight.cli import options

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")

ROOT = Path(__file__).resolve().parents[2]
#: Words of each command, and the names of what it leaves in the folder.
COMMANDS = {
    "light in processes": (
        "light box.vti --contour height --workers 2 --slab 0.002 -o lit.pvtp", ["lit", "lit.pvtp"]
    ),
    "light with a picture": (
        "light ball.vtp --for shape -o lit.vtp -o lit.png", ["lit.png", "lit.vtp"]
    ),
    "contours": ("contours ball.vtp -o bands.vtm", ["bands", "bands.vtm"]),
    "demo": ("demo --out demo --size 200x150", ["demo"]),
    "doctor": ("doctor", []),
    "fur": ("fur ball.vtp -o fur.vtp", ["fur-fibres.vtp", "fur-skin.vtp"]),
    "paraview": ("paraview", []),
    "project": ("project ball.vtp --positions W --frame F -o flat.vtp", ["flat.vtp"]),
    "relief": ("relief ball.vtp -o cast.vtp", ["cast.vtp"]),
    "sky": ("sky ball.vtp --error 0.1 -o sky.vtp", ["sky.vtp"]),
    "streamlines": ("streamlines box.vti --seeds 9 -o lines.vtp", ["lines.vtp"]),
    "view": ("view ball.vtp --for shape --no-browser -o page.html", ["page.html"]),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.sampled(5)
@pytest.mark.parametrize("name", COMMANDS)
def test_nothing_listens_and_nothing_is_open_to_others(name, tmp_path):
    work, temporary, home = (tmp_path / part for part in ("work", "tmp", "home"))
    for folder in (work, temporary, home):
        folder.mkdir()
    ball = pv.Sphere(theta_resolution=20, phi_resolution=20)
    ball["V"] = np.cross(ball.points, (0.3, 0.2, 1.0))
    ball["W"] = np.column_stack([ball.points, ball.points[:, 0]])
    ball["F"] = np.tile(np.eye(2, 4).ravel(), (ball.n_points, 1))
    ball.save(work / "ball.vtp")
    box = pv.ImageData(dimensions=(12, 12, 12))
    box["V"] = np.cross(box.points, (0.3, 0.2, 1.0)) + 1
    box["height"] = box.points[:, 2]
    box.save(work / "box.vti")
    given = {path.name for path in work.iterdir()}
    words, made = COMMANDS[name]
    seen = traces.of_vizlight(
        words.split(),
        [temporary],
        cwd=work,
        env=os.environ
        | {"TMPDIR": str(temporary), "HOME": str(home), "PYTHONPATH": str(ROOT)}
        | {"XDG_CACHE_HOME": str(home / "cache"), "VIZLIGHT_FAST": "0"},
    )
    assert (seen.code, "Traceback" in seen.err) == (0, False), seen.err
    # The second process of ``paraview`` may end between two looks.
    assert seen.processes > (name != "paraview") + ("in processes" in name)
    assert (seen.sockets, seen.files) == (set(), {})
    assert sorted({path.name for path in work.iterdir()} - given) == made
    assert [*temporary.iterdir()] == []
    # Matplotlib makes a folder for its settings.
    assert {path.name for path in home.iterdir()} <= {"cache", ".config"}


def test_every_command_is_watched():
    options.add_commands("")
    known = {words.split()[0] for words, _ in COMMANDS.values()}
    assert known == {name for name in cli.app if not name.startswith("-")}


def test_the_look_finds_a_socket_and_a_file(tmp_path):
    with socket.socket() as known:
        known.bind(("127.0.0.1", 0))
        known.listen()
        assert traces.listening([os.getpid()])
    (tmp_path / "own").mkdir(mode=0o700)
    (tmp_path / "own" / "kept").touch()
    (tmp_path / "own" / "kept").chmod(0o644)
    assert traces.open_to_others(tmp_path) == {}
    (tmp_path / "open").touch()
    (tmp_path / "open").chmod(0o644)
    assert traces.open_to_others(tmp_path) == {"open": "0o644"}
