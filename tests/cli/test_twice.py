"""What a command does once: it reads its file once and loads nothing that it does not use."""

from __future__ import annotations

import subprocess
import sys

import pytest
import pyvista as pv
from cyclopts import App

from vizlight import cli

#: Counts the reads of PyVista, runs a command, and prints the count and what is loaded.
COUNTED = """
import sys
import pyvista as pv
read, reads = pv.BaseReader.read, []
pv.BaseReader.read = lambda *args: reads.append(args) or read(*args)
from vizlight import cli
assert cli.main(sys.argv[1:]) == cli.OK
print(len(reads), *sys.modules)
"""


def counted(folder, *words):
    command = [sys.executable, "-c", COUNTED, *words]
    run = subprocess.run(command, capture_output=True, text=True, check=True, cwd=folder)
    reads, *modules = run.stdout.splitlines()[-1].split()
    return int(reads), set(modules)


@pytest.fixture
def ball(tmp_path):
    pv.Sphere().save(tmp_path / "ball.vtp")
    return tmp_path


def test_a_lit_mesh_is_read_once_and_nothing_that_draws_is_loaded(ball):
    reads, modules = counted(ball, "light", "ball.vtp", "-o", "lit.vtp")
    assert reads == 1
    drawing = {"vizlight.draw.component", "vizlight.pieces.run", "vizlight.pieces.sources"}
    assert not modules & {*drawing, "numba", "scipy.optimize", "scipy.spatial"}


@pytest.mark.opengl
def test_a_picture_reads_its_file_once(ball):
    reads, modules = counted(ball, "light", "ball.vtp", "-o", "lit.png", "--size", "60x40")
    assert reads == 1
    assert not modules & {"vizlight.pieces.run", "numba", "scipy.optimize", "scipy.spatial"}
    assert "vizlight.draw.component" in modules


def test_help_reads_the_arguments_of_its_command_once(monkeypatch, capsys):
    asked = []
    assemble = App.assemble_argument_collection

    def counted(app, **options):
        asked.append(app.name)
        return assemble(app, **options)

    monkeypatch.setattr(App, "assemble_argument_collection", counted)
    assert cli.main(["fur", "--help"]) == 0
    assert "--density" in capsys.readouterr().out
    assert asked == [("fur",)]
