"""Strokes of which the way is known, and the figures that an example prints."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

import studies
from studies import strokes
from vizlight import render


def plane(angle):
    """Return a square that faces the eye, with a field of one direction."""
    mesh = pv.Plane(i_size=2, j_size=2)
    way = np.array([np.cos(angle), np.sin(angle), 0])
    mesh["way along"] = np.tile(way, (mesh.n_points, 1))
    return mesh, render.camera_on(mesh.bounds, (0, 0, 1), parallel=True)


@pytest.mark.parametrize("degrees", [0, 20, 90, 135])
def test_stripes_are_read_along_not_across(degrees):
    mesh, camera = plane(np.radians(degrees))
    true = strokes.ways(mesh, "way along", camera, (96, 96))
    shown = np.isfinite(true[..., 0])
    assert 0.2 < shown.mean() < 1
    right, up = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    assert np.allclose(true[shown], [right, up], atol=0.02)
    y, x = np.mgrid[:96, :96]
    across = np.sin(0.4 * (x * up + y * right))
    stripes = np.repeat(127 + 120 * across[..., np.newaxis], 3, axis=2)
    assert strokes.read_off(stripes, true, 5) < 2
    turned = np.stack([-true[..., 1], true[..., 0]], axis=-1)
    assert strokes.read_off(stripes, turned, 5) > 88


def test_the_example_prints_the_figures_of_the_study():
    result = studies.run("strokes", strokes.STUDY, quick=True)
    found = {row.way: row.error for row in result.rows}
    script = Path(studies.__file__).parents[1] / "plot_read_direction.py"
    titles = re.findall(r'"([a-zA-Z ]+): ([\d.]+)":', script.read_text(encoding="utf-8"))
    # The example has no lines from seeds at random.
    del found["streamlines at random, VTK"]
    for (way, error), (_, figure) in zip(found.items(), titles, strict=True):
        assert error == pytest.approx(float(figure), rel=0.1), way
