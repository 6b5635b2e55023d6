"""What an editor that knows types says of scripts: nothing of README's, a line for each mistake.

``VIZLIGHT_PYRIGHT`` names the folder of pyright's commands, such as ``node_modules/.bin``, if any.
"""

import importlib.util
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from test_readme import GUIDE, README, blocks

ROOT = Path(__file__).parents[1]
BEFORE = """
import pyvista as pv
import vizlight
from vizlight import Light, Material, Scene, View, presets, render
from vizlight.accessor import Accessor
from vizlight.draw.component import Component
mesh = pv.Sphere()
scene = Scene(lights=Light(direction=(0, 0, 1)))
tools: Accessor = mesh.vizlight
component: Component = pv.Plotter().vizlight
""".strip()
#: A mistake per line; the last two are of methods of meshes and plotters, whose type is named.
MISTAKES = """
vizlight.no_such_name
vizlight.illuminate(mesh, scene, tangentz="V")
vizlight.illuminate(mesh, scene, model="flat")
Light(dirction=(0, 0, 1))
Material(ambient="bright")
View(position="there")
presets.directions()
render.make_plotter(mesh, sizes=(1, 2))
vizlight.streamlines(mesh, scene, vector="V")
Scene(light=1)
tools.illuminate(scene, tangentz="V")
component.add_keys()
"""
#: Lines of the mistakes, from 1.
LINES = range(BEFORE.count("\n") + 2, (BEFORE + MISTAKES).count("\n") + 1)


def write(folder, paths):
    """Write a script of mistakes, and one for each code block of pages and each script."""
    (folder / "mistakes.py").write_text(BEFORE + MISTAKES, "utf-8")
    for path in paths:
        made = [path.read_text("utf-8")] if path.suffix == ".py" else blocks(path, "python")
        # The blocks of a page are one script.
        (folder / f"{path.stem}_.py").write_text("\n".join(made), "utf-8")


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is not installed")
def test_mypy_finds_mistakes_and_none_in_the_readme(tmp_path):
    write(tmp_path, [README])
    command = [sys.executable, "-m", "mypy", "--config-file=", "--follow-imports=silent"]
    command += ["--ignore-missing-imports", f"--cache-dir={os.devnull}", *tmp_path.glob("*.py")]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    found = re.findall(r"(\w+)\.py:(\d+): error", run.stdout)
    assert found == [("mistakes", str(line)) for line in LINES], run.stdout


@pytest.mark.slow
@pytest.mark.skipif("VIZLIGHT_PYRIGHT" not in os.environ, reason="no folder of pyright named")
def test_pyright_finds_the_mistakes_and_none_in_what_users_read(tmp_path):
    write(tmp_path, [*GUIDE, *sorted((ROOT / "gallery").glob("plot_*.py"))[:10]])
    command = [Path(os.environ["VIZLIGHT_PYRIGHT"]).resolve() / "pyright", "--outputjson"]
    command += ["--pythonpath", sys.executable, tmp_path]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    told = json.loads(run.stdout)["generalDiagnostics"]
    mistakes = [one for one in told if one["file"].endswith("mistakes.py")]
    assert {one["range"]["start"]["line"] + 1 for one in mistakes} == {*LINES}
    # PyVista's own types do not fit its scripts; names and keywords of vizlight do.
    ours = [f"{one['file']}: {one['message']}" for one in told if one not in mistakes]
    assert [line for line in ours if re.search(r"No parameter named|: .*vizlight", line)] == []
