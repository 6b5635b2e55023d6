"""What an editor that knows types says of scripts: nothing of README's, a line for each mistake."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
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
"""


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is not installed")
def test_mistakes_are_found_and_the_examples_of_the_readme_have_none(tmp_path):
    readme = (ROOT / "README.md").read_text("utf-8")
    (tmp_path / "mistakes.py").write_text(BEFORE.strip() + MISTAKES, "utf-8")
    for i, text in enumerate(re.findall(r"```python\n(.*?)```", readme, re.DOTALL)):
        (tmp_path / f"readme_{i}.py").write_text(text, "utf-8")
    command = [sys.executable, "-m", "mypy", "--config-file=", "--follow-imports=silent"]
    command += ["--ignore-missing-imports", f"--cache-dir={tmp_path}", *tmp_path.glob("*.py")]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    found = re.findall(r"(\w+)\.py:(\d+): error", run.stdout)
    first = len(BEFORE.strip().splitlines()) + 1
    lines = range(first, first + len(MISTAKES.strip().splitlines()))
    assert found == [("mistakes", str(line)) for line in lines], run.stdout
