"""``vizlight light`` of pieces, and ``vizlight view``: one private page from disk, no server."""

import json
import os
import re
import socket
import stat
import sys
import webbrowser
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from PIL import Image

import vizlight
from vizlight import render

CONTOUR = ("--contour", "r", "--level", "3")


@pytest.fixture
def parts():
    """Return the parts of a ball that is far smaller than the box of its grid."""
    grid = pv.ImageData(dimensions=(14, 12, 13))
    x, y, z = (grid.points - (4.5, 5.5, 7)).T
    grid["r"] = np.sqrt(x * x + 1.2 * y * y + z * z)
    grid = grid.cast_to_unstructured_grid()
    grid.save("whole.vtu")
    place = grid.cell_centers().points
    for i in range(3):
        which = np.flatnonzero(np.sum(place[:, ::2] > (4, 6), axis=1) == i)
        part = grid.extract_cells(which, pass_point_ids=False, pass_cell_ids=False)
        part.clear_cell_data()
        part.save(f"part{i}.vtu")
    return [f"part{i}.vtu" for i in range(3)]


@pytest.mark.opengl
@pytest.mark.parametrize("view", [(), ("--view", "1,0.5,0.45", "--parallel"), ("camera",)], ids=str)
def test_the_picture_is_that_of_the_whole(parts, view, tmp_path, done):
    if view == ("camera",):
        place = [[20, 9, 14], [4.5, 5.5, 7], [0, 0, 1]]
        (tmp_path / "camera.json").write_text(json.dumps(place), encoding="utf-8")
        view = ("--view", "camera.json")
    view = view or ("--view", "1,1,1")
    more = (*CONTOUR, "--size", "150x100", "--no-key", "--headlight", *view)
    lit = ("light", *parts, *more, "-o", "lit.pvtp", "-o", "lit.png")
    done(*lit)
    done("light", "whole.vtu", *more, "-o", "lit.vtp")
    whole = vizlight.read("lit.vtp")
    seen = vizlight.provenance(whole)["scene"]["view"]
    one = vizlight.provenance(pv.read(sorted(tmp_path.glob("lit/*.vtp"))[0]))["scene"]["view"]
    for key in ("position", "direction"):
        np.testing.assert_allclose(one[key], seen[key], rtol=1e-6)
    got = np.asarray(Image.open("lit.png").convert("RGB")).astype(int)
    camera = render.camera_on(whole, (1, 1, 1), aspect=1.5)
    if "--parallel" in view:
        camera = render.camera_on(whole, (1, 0.5, 0.45), aspect=1.5, parallel=True)
    elif "camera.json" in view:
        camera.position, camera.focal_point = place[:2]
    panel = render.Panel(whole, "luminance")
    (drawn,) = render.pictures([panel], camera=camera, size=(150, 100), light="points")
    assert np.abs(got - drawn).mean() < 0.1
    rows, columns = np.nonzero((got < 250).any(axis=2))
    if "camera.json" not in view:
        assert max(np.ptp(rows) / 100, np.ptp(columns) / 150) > 0.85


@pytest.mark.slow
def test_processes_write_the_same_bytes(parts, tmp_path, done):
    for name, more in (("one", ()), ("two", ("--workers", "2"))):
        lit = ("light", *parts, *CONTOUR, "-o", f"{name}.pvtp", *more)
        done(*lit)
    for i in range(3):
        one, two = (tmp_path / name / f"{name}_000{i}.vtp" for name in ("one", "two"))
        assert one.read_bytes() == two.read_bytes()


@pytest.mark.slow
def test_a_scheduler_that_does_not_answer(parts, refused):
    pytest.importorskip("distributed")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
    err = refused("light", *parts, "-o a.pvtp --scheduler", address)
    assert len(err.splitlines()) == 1
    assert "127.0.0.1" in err


@pytest.mark.slow
def test_the_script_does_the_same(parts, done):
    exec(done("light", *parts, "--contour r -o a.pvtp --script"), {})
    out = done("light", *parts, "-o a.pvtp --workers 3 --script")
    assert "work = vizlight.pieces.Processes(3)\n" in out
    assert out.count("map=work") == 2
    level = vizlight.read("whole.vtu")["r"]
    assert vizlight.read("a.pvtp")["r"] == pytest.approx((level.min() + level.max()) / 2)


def test_pieces_are_split_at_creases_as_one_file(done):
    box = pv.Box(level=40).triangulate().clean()
    box.clear_data()
    box.save("whole.vtp")
    turned = box.cell_centers().points @ (1, 2, 3)
    for i in range(2):
        part = box.remove_cells(np.flatnonzero((turned > 0) == i))
        part.clear_data()
        part.save(f"part{i}.vtp")
    seen = ("--view", "3,2,1", "--headlight", "--no-key")
    done("light", "part0.vtp", "part1.vtp", *seen, "-o", "a.pvtp")
    done("light", "whole.vtp", *seen, "-o", "b.vtp")
    lit, whole = vizlight.read("a.pvtp"), vizlight.read("b.vtp")
    assert len(np.unique(whole["luminance"])) < len(box.points)
    own, other = (
        np.sort(mesh["luminance"][mesh.faces.reshape(-1, 4)[:, 1:]].sum(axis=1))
        for mesh in (lit, whole)
    )
    np.testing.assert_allclose(own, other, atol=1e-5)


@pytest.fixture
def shell(tmp_path, monkeypatch):
    """Work in a folder with a ball, note what the browser opens, and keep temporary files here."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    ball = pv.Sphere(theta_resolution=12, phi_resolution=12)
    ball["V"] = np.cross(ball.points, (0.3, 0.2, 1.0))
    ball["height"] = ball.points[:, 2]
    ball.save("ball.vtp")
    opened = []
    monkeypatch.setattr(webbrowser, "open", lambda url: opened.append(url) or True)
    return opened


@pytest.mark.opengl
def test_the_page_is_private_and_opened(shell, done):
    out = done("view", "ball.vtp", "--scalars", "height", "--light", "-1,-2,3")
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


@pytest.mark.opengl
def test_the_page_is_kept_and_no_browser_is_opened(shell, tmp_path, done):
    out = done("view ball.vtp --scalars height -o kept.html --no-browser")
    assert "page     kept.html" in out
    assert 'export_html("ball.html"' in done("view ball.vtp --scalars height --script")
    assert shell == []
    assert sorted(path.name for path in tmp_path.iterdir()) == ["ball.vtp", "kept.html"]


@pytest.mark.opengl
def test_the_page_copies_the_command(shell, done):
    """The words of the command stand in the page, and light the file alike."""
    options = [
        "--scalars",
        "height",
        "--tangents",
        "V",
        "--conditioned",
        "--clip",
        "z:0.3",
        "--exponent",
        "2",
    ]
    done("view", "ball.vtp", *options, "-o", "kept.html", "--no-browser")
    recipe = json.loads(re.search(r'"recipe": (\{.*?\}), "name"', Path("kept.html").read_text())[1])
    assert recipe["file"] == "ball.vtp"
    words = recipe["command"]
    assert sorted(words) == ["--clip=z:0.3", "--conditioned", "--exponent=2", "--tangents=V"]
    for given, path in ((options, "a.vtp"), (words, "b.vtp")):
        done("light", "ball.vtp", *given, "-o", path)
    np.testing.assert_array_equal(pv.read("a.vtp")["luminance"], pv.read("b.vtp")["luminance"])


@pytest.mark.opengl
def test_without_a_browser_the_path_is_told(shell, run, monkeypatch):
    monkeypatch.setattr(webbrowser, "open", lambda url: False)
    code, _, err = run("view ball.vtp --scalars height -o kept.html")
    assert code == 0
    assert err == "vizlight: no browser was found; open 'kept.html' in one\n"
