"""``mesh.vizlight`` is there without an import, on every kind of mesh."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Scene, View

SCENE = Scene(lights=Light(direction=(0, 0, 1)), view=View(direction=(0, 0, 1)))


def test_accessor_lights_as_the_function_does():
    mesh = pv.Sphere()
    lit = mesh.vizlight.illuminate(SCENE, name="x")
    np.testing.assert_array_equal(lit["x"], vizlight.illuminate(mesh, SCENE, name="x")["x"])
    assert lit.vizlight.provenance("x") == vizlight.provenance(lit, "x")


def test_accessor_on_blocks():
    blocks = pv.MultiBlock([pv.Sphere(), pv.Cube()])
    lit = blocks.vizlight.illuminate(SCENE)
    assert all("luminance" in block.point_data for block in lit)


def test_accessor_needs_no_import():
    code = "import pyvista as pv; print(type(pv.Sphere().vizlight).__name__)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "Accessor"
