"""``vizlight view``: one private page from disk, no server."""

from __future__ import annotations

import json
import os
import re
import stat
import sys
import webbrowser
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

from vizlight import cli

pytestmark = pytest.mark.opengl


@pytest.fixture
def shell(tmp_path, monkeypatch):
    """Work in a folder with a ball, note what the browser opens, and keep temporary files here."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    ball = pv.Sphere(theta_resolution=12, phi_resolution=12)
    ball["V"] = np.cross(ball.points, (0.3, 0.2, 1.0))
    ball["height"] = ball.points[:, 2]
    ball.save("ball.vtp")
    opened = []
    monkeypatch.setattr(webbrowser, "open", lambda url: opened.append(url) or True)
    return opened


def run(capfd, *arguments):
    code = cli.main(["view", *map(str, arguments)])
    out, err = capfd.readouterr()
    return code, out, err


def test_the_page_is_private_and_opened(shell, capfd):
    code, out, err = run(capfd, "ball.vtp", "--tangents", "V", "--light", "-1,-2,3")
    assert (code, err) == (0, "")
    page = Path(re.search(r"^page +(.+)$", out, re.MULTILINE)[1])
    assert page.name == "ball.html"
    assert shell == [page.as_uri()]
    if sys.platform != "win32":
        assert stat.S_IMODE(page.stat().st_mode) == 0o600
        assert stat.S_IMODE(page.parent.stat().st_mode) == 0o700
        assert page.parent.stat().st_uid == os.getuid()
    text = page.read_text(encoding="utf-8")
    assert text.rstrip().endswith("</html>")
    toward = np.array(re.search(r'"value": \[([^\]]+)\]', text)[1].split(","), float)
    np.testing.assert_allclose(toward / np.linalg.norm(toward), np.array([-1, -2, 3]) / 14**0.5)


def test_the_page_is_kept_and_no_browser_is_opened(shell, capfd, tmp_path):
    code, out, err = run(
        capfd, "ball.vtp", "--scalars", "height", "-o", "kept.html", "--no-browser"
    )
    assert (code, err, shell) == (0, "", [])
    assert "page     kept.html" in out
    assert sorted(path.name for path in tmp_path.iterdir()) == ["ball.vtp", "kept.html"]


def test_the_page_copies_the_command(shell, capfd):
    """The words of the command stand in the page, and light the file alike."""
    options = ["--tangents", "V", "--conditioned", "--clip", "z:0.3", "--exponent", "2"]
    code, _, err = run(capfd, "ball.vtp", *options, "-o", "kept.html", "--no-browser")
    assert (code, err) == (0, "")
    recipe = json.loads(re.search(r'"recipe": (\{.*?\}), "name"', Path("kept.html").read_text())[1])
    assert recipe["file"] == "ball.vtp"
    words = recipe["command"]
    assert sorted(words) == ["--clip=z:0.3", "--conditioned", "--exponent=2", "--tangents=V"]
    for given, path in ((options, "a.vtp"), (words, "b.vtp")):
        assert cli.main(["light", "ball.vtp", *given, "-o", path]) == 0
    np.testing.assert_array_equal(pv.read("a.vtp")["luminance"], pv.read("b.vtp")["luminance"])


def test_without_a_browser_the_path_is_told(shell, capfd, monkeypatch):
    monkeypatch.setattr(webbrowser, "open", lambda url: False)
    code, _, err = run(capfd, "ball.vtp", "-o", "kept.html")
    assert code == 0
    assert err == "vizlight: no browser was found; open 'kept.html' in one\n"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["none.vtp"], "no such file"),
        (["ball.vtp", "-o", "page.png"], "ends in .html"),
        (["ball.vtp", "--tangents", "W"], "tangents"),
        (["ball.vtp", "--port", "80"], "--port"),
    ],
)
def test_what_cannot_be_shown_leaves_nothing(arguments, words, shell, capfd, tmp_path):
    code, _, err = run(capfd, *arguments)
    assert code == 2
    assert words in err
    assert err.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["ball.vtp"]
    assert not shell
