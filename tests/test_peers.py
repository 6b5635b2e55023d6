"""The page on peers: its scripts still run, and its table and pictures are those of the scripts."""

from __future__ import annotations

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
        assert tuple(row) == kept.COLUMNS
        # A script that has changed is measured again.
        assert int(row["code_lines"]) == kept.code_lines(kept.HERE / name), name
        assert int(row["points"]) > 1000
        assert 50 < int(row["memory_mb"]) < 5000
        assert 0.1 < float(row["cpu_s"]) < 100
        assert row["frame_cpu_s"] or row["tool"].startswith("matplotlib")
        assert row["date"].count("-") == 2


def test_each_picture_is_kept_and_no_other():
    pictures = {kept.picture(scene, script) for scene, script in kept.todo()}
    assert pictures == set(kept.HERE.glob("*/*.webp"))
    for path in pictures:
        assert path.stat().st_size <= 150_000, path
        with Image.open(path) as picture:
            assert np.asarray(picture.convert("RGB")).std() > 20, path


def test_the_six_sheets_are_kept():
    sheets = module("sheets")
    kept_sheets = {path.stem: path for path in kept.HERE.glob("sheet_*.webp")}
    assert set(kept_sheets) == {f"sheet_{name}" for name in sheets.SETS}
    text = (PAGES / "peers.rst").read_text(encoding="utf-8")
    for name, path in kept_sheets.items():
        assert path.stat().st_size <= 300_000
        assert f"peers/{name}.webp" in text
        with Image.open(path) as picture:
            assert picture.width == 4 * sheets.SIZE[0]
            assert np.asarray(picture.convert("RGB")).std() > 20, name


def test_the_ten_pictures_are_measured_and_their_scripts_are_short():
    with (kept.HERE / "plain.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 10
    for row in rows:
        name = re.search(r"plot_\w+", row["picture"])[0]
        lines = kept.code_lines(PAGES.parent / f"{name}.py")
        # A script that has changed is measured again.
        assert lines == int(row["lines of the script"]) <= 25, name
        ours, theirs = abs(float(row["vizlight"])), abs(float(row["PyVista"]))
        better = ours > theirs if re.match("rank|contrast", row["figure"]) else ours < theirs
        assert better, name


def test_the_pairs_and_the_four_tools_are_on_the_page():
    text = (PAGES / "peers.rst").read_text(encoding="utf-8")
    pictures = [*kept.HERE.glob("plain_*.webp"), kept.HERE / "tools_fibres.webp"]
    assert len(pictures) == 6
    for path in pictures:
        assert path.stat().st_size <= 150_000
        assert f"peers/{path.name}" in text
