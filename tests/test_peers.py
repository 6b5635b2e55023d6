"""The page on peers: its scripts still run, and its table and pictures are those of the scripts."""

import csv
import importlib
import json
import re
import runpy
import sys
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from PIL import Image

PAGES = Path(__file__).parents[1] / "gallery" / "pages"
SIDE = 160


def module(name):
    """Return a module of the folder ``peers``."""
    sys.path.insert(0, str(PAGES))
    try:
        return importlib.import_module(f"peers.{name}")
    finally:
        sys.path.remove(str(PAGES))


kept = module("kept")
#: ParaView's scripts run in ParaView alone; see CONTRIBUTING.
OWN = [script for scene, script in kept.todo() if kept.tool(script) != "paraview"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("peers")
    module("data").prepare(made, share=0.1)
    return made


@pytest.mark.sampled(3)
@pytest.mark.opengl
@pytest.mark.filterwarnings("ignore:.*could not be lit")
@pytest.mark.parametrize("script", sorted(set(OWN)), ids=lambda path: path.stem)
def test_a_script_draws(script, folder, monkeypatch):
    """The picture is neither empty nor of one tone, and a further frame is drawn."""
    monkeypatch.chdir(folder)
    monkeypatch.setattr(pv, "OFF_SCREEN", True)
    measure = module("measure")
    scene = script.parent.name
    view = json.loads((folder / "cameras.json").read_text())[scene]
    view["size"] = [SIDE, SIDE]
    space = runpy.run_path(str(script))
    way = next(way for name, way in measure.WAYS.items() if name in space)
    frame, count = way(space, view, "picture.png")
    points, pieces = count()
    if frame is not None:
        frame()
        space["plotter"].close()
        assert pieces > 1000
    assert points > 500
    picture = np.asarray(Image.open("picture.png").convert("RGB"), dtype=float)
    seen = np.any(np.abs(picture - 255 * np.array(view["background"])) > 8, axis=2)
    assert seen.mean() > 0.04
    assert picture[seen].std() > 10


def test_the_table_is_that_of_the_scripts():
    rows = kept.read()
    assert set(rows) == {(scene, p.relative_to(kept.HERE).as_posix()) for scene, p in kept.todo()}
    for (_, name), row in rows.items():
        # A script that has changed is measured again.
        assert int(row["code_lines"]) == kept.code_lines(kept.HERE / name), name
        assert int(row["points"]) > 1000
        assert row["frame_cpu_s"] or row["tool"].startswith("matplotlib")


def better(row):
    """Return whether a figure of ours is better than PyVista's."""
    if "unreadable" in (row["vizlight"], row["PyVista"]):
        return row["vizlight"] != "unreadable"
    ours, theirs = abs(float(row["vizlight"])), abs(float(row["PyVista"]))
    return ours > theirs if re.match("rank|contrast", row["figure"]) else ours < theirs


def test_the_ten_pictures_are_measured_and_their_scripts_are_short():
    text = (PAGES / "peers.rst").read_text(encoding="utf-8")
    with (kept.HERE / "plain.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 10
    for row in rows:
        name = re.search(r"plot_\w+", row["picture"])[0]
        lines = kept.code_lines(PAGES.parent / f"{name}.py")
        # A script that has changed is measured again.
        assert lines == int(row["lines of the script"]) <= 40, name
        # The page names the pictures in which ours is not better, and no others.
        assert better(row) == (f"<examples/{name}>`" not in text), name


def test_the_table_of_marks_has_each_field_four_times():
    with (kept.HERE / "marks.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    marks = module("marks")
    assert tuple(rows[0]) == marks.COLUMNS
    assert [row["field"] for row in rows] == [name for name in marks.FIELDS for _ in range(4)]
    mesh, name, view = marks.street()
    # Between the rows of vortices the wind is fastest, and runs along them.
    fast = np.linalg.norm(mesh[name], axis=1).argmax()
    assert abs(mesh.points[fast, 1]) < 0.45
    assert abs(mesh[name][fast, 0]) > 5 * abs(mesh[name][fast, 1])
    assert view == (0, 0, 1)


def test_each_picture_is_kept_and_no_other():
    scripted = {kept.picture(scene, script) for scene, script in kept.todo()}
    assert scripted == set(kept.HERE.glob("*/*.webp"))
    own = set(kept.HERE.glob("*.webp"))
    assert {p.stem for p in own} >= {f"sheet_{name}" for name in module("sheets").SETS}
    text = (PAGES / "peers.rst").read_text(encoding="utf-8")
    assert set(re.findall(r"peers/(\w+\.webp)", text)) == {path.name for path in own}
    for path in scripted | own:
        assert path.stat().st_size <= (300_000 if path.stem.startswith("sheet") else 150_000), path
        with Image.open(path) as picture:
            assert np.asarray(picture.convert("RGB")).std() > 20, path
