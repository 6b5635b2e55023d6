"""README and pages: code runs, commands and files exist, maps of the folders are true."""

import operator
import re
import runpy
import shlex
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from PIL import Image
from test_tiers import TIER, TIERS

import vizlight
from vizlight import cli

ROOT = Path(__file__).parents[1]
README = ROOT / "README.md"
PAGES = ROOT / "gallery" / "pages"
GUIDE = sorted((PAGES / "guide").glob("*.rst"))
DOCUMENTS = [README, *sorted(PAGES.glob("*.rst")), *GUIDE]
#: The module that draws the guide where the pages are built.
DRAWING = runpy.run_path(str(PAGES / "_guide.py"))


def text_of(path):
    return path.read_text(encoding="utf-8")


def blocks(path, language):
    """Return the code blocks of one language in a Markdown or reStructuredText file."""
    text = text_of(path)
    if path.suffix == ".md":
        return re.findall(rf"^```{language}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    return DRAWING["blocks"](text, language)


def lines(path):
    """Return the lines of the shell blocks of a file, continued lines as one."""
    joined = [re.sub(r"\\\n\s*", "", block) for block in blocks(path, "sh")]
    return [line for block in joined for line in block.split("\n") if line]


def named_commands(path):
    """Return what stands between backticks or in a shell line after ``vizlight``."""
    quoted = re.findall(r"`vizlight ([^`]+)`", text_of(path))
    return quoted + [m[1] for line in lines(path) if (m := re.search(r"vizlight ((?!/).+)", line))]


@pytest.mark.usefixtures("few_strokes")
@pytest.mark.opengl
@pytest.mark.parametrize(
    "path",
    [README, pytest.param(PAGES / "index.rst", marks=pytest.mark.slow)],
    ids=lambda path: path.name,
)
def test_every_python_block_runs(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(pv, "OFF_SCREEN", True)
    space = {"__name__": "example"}
    found = blocks(path, "python")
    assert found
    for i, block in enumerate(found):
        exec(compile(block, f"{path.name}, block {i}", "exec"), space)
    assert list(tmp_path.glob("*.png"))
    if path == README:
        assert float(space["lit"]["luminance"].max()) > 0.5


def mended(names):
    """Assert that each symptom of the page on troubleshooting is there, and its remedy mends it."""
    assert max(names["early"], names["behind"], names["faded"]) < 0.6 * names["right"]
    exact = vizlight.illuminate(names["ball"], names["scene"])["luminance"]
    off = [np.abs(names[mesh]["luminance"] - exact).mean() for mesh in ("given", "turned")]
    assert off[1] < 1e-3 < 0.05 < off[0]
    # Light of a ball has no jumps from point to point.
    roughness = [
        np.abs(np.diff(mesh["luminance"][mesh.regular_faces], axis=1)).mean()
        for mesh in (names["rough"], names["smooth"])
    ]
    assert roughness[1] < 0.5 * roughness[0]


@pytest.mark.slow
@pytest.mark.sampled(5)
@pytest.mark.opengl
@pytest.mark.parametrize("path", GUIDE, ids=lambda path: path.stem)
def test_a_page_of_the_guide_runs_and_writes_its_pictures(path, tmp_path, monkeypatch):
    if "open_gif(" in text_of(path):
        pytest.importorskip("imageio", reason="pip install 'vizlight[movie]'")
    if "vizlight.sky(" in text_of(path):
        pytest.importorskip("embreex", reason="pip install 'vizlight[rays]'")
    monkeypatch.setattr(pv, "OFF_SCREEN", True)
    names = DRAWING["run"](path, tmp_path)
    shown = DRAWING["shown"](path)
    assert {picture.name for picture in tmp_path.glob("*.png")} <= set(shown)
    for name in shown:
        if name.endswith(".png"):
            with Image.open(tmp_path / name) as picture:
                assert np.asarray(picture.convert("L")).std() > 5, name
        else:
            assert (tmp_path / name).stat().st_size, name
    if path.stem == "troubleshooting":
        mended(names)


@pytest.mark.usefixtures("few_strokes")
@pytest.mark.opengl
def test_the_command_of_the_example_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (line,) = [line for line in lines(README) if "vizlight light" in line]
    arguments = shlex.split(line)[1:]
    (tmp_path / arguments[1]).parent.mkdir()
    shutil.copy(ROOT / arguments[1], arguments[1])
    assert cli.main([*arguments, "--size", "120x80"]) == cli.OK
    assert (tmp_path / "lit.vtp").exists()
    assert (tmp_path / "lit.png").exists()


def test_every_command_is_one(capsys):
    described = {}
    for command in sorted({name for path in DOCUMENTS for name in named_commands(path)}):
        name, *words = shlex.split(command.partition("|")[0])
        if name not in described:
            assert cli.main([name, "--help"]) == cli.OK, command
            described[name] = capsys.readouterr().out
        for word in words:
            if word.startswith("--") and word != "--help":
                assert f"{word.partition('=')[0]} " in described[name], command


def test_readme_and_guide_are_short():
    lengths = [len(text_of(path).splitlines()) for path in GUIDE]
    assert max(lengths) <= 100
    assert sum(lengths) <= 700
    assert len(text_of(README).splitlines()) <= 120


def test_every_link_of_readme_is_a_file():
    """Links into the repository are absolute, because an index of packages shows README alone."""
    targets = re.findall(r"\]\(([^)#]+)\)", text_of(README))
    place = r"https://(?:raw\.githubusercontent\.com/\w+/\w+|github\.com/\w+/\w+/blob)/main/(.+)"
    paths = [match[1] for t in targets if (match := re.fullmatch(place, t))]
    assert len(paths) > 5
    assert not [path for path in paths if not (ROOT / path).exists()]
    assert not [t for t in targets if "://" not in t]


def test_the_map_names_the_folders_that_exist_in_the_order_of_imports():
    (block,) = re.findall(r"^## Folders\n\n```\n(.*?)^```$", text_of(README), re.S | re.M)
    named, above = [], []
    for line in block.splitlines():
        indent, name = re.match(r"( *)(\w+)/ ?", line).groups()
        above = [*above[: len(indent) // 2], name]
        named.append("/".join(above))
    assert all((ROOT / path).is_dir() for path in named)
    ours = [path for path in named if path.startswith("vizlight/")]
    folders = {p.parent for p in (ROOT / "vizlight").rglob("__init__.py")} - {ROOT / "vizlight"}
    assert {ROOT / path for path in ours} == folders
    order = [TIER[path.split("/")[1]] for path in ours]
    assert order == sorted(order)


def test_the_architecture_page_names_tiers_files_and_modules_that_exist():
    text = text_of(PAGES / "architecture.rst")
    rows = re.findall(r"^   \* - (``.*)$", text, re.M)
    assert [set(re.findall(r"``(\w+)``", row)) for row in rows] == TIERS
    paths = re.findall(r"``((?:vizlight|tests|gallery)/[\w/.]*)``", text)
    assert len(paths) > 20
    assert not [p for p in paths if "NAME" not in p and not (ROOT / p).exists()]
    for short, place in re.findall(r"``vizlight\.([.\w]+)`` for\s+``(vizlight[.\w]+)``", text):
        assert operator.attrgetter(short)(vizlight) is sys.modules[place]


def test_the_filters_that_readme_and_guide_name_are_all():
    """Names in lower case that the package gives are its filters and a few helpers."""
    helpers = {"direction_colors", "example_path", "load_example", "provenance", "read", "check"}
    helpers |= {"to_polydata"}
    filters = {name for name in vizlight.__all__ if name.islower()} - helpers
    guide = "".join(map(text_of, GUIDE))
    assert not [name for name in filters if not re.search(rf"`(vizlight\.)?{name}\b", guide)]
    assert not [name for name in filters if name not in text_of(README)]
