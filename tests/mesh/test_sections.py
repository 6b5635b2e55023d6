"""Vertical sections fill a picture, whatever the units of their axes are."""

import numpy as np
import pytest
import pyvista as pv

from vizlight import files
from vizlight.mesh import georeference, meaning
from vizlight.mesh.meaning import AxisScale, Meaning


def section(x, y, flat, up):
    """Return a section with scales of its axes."""
    mesh = pv.RectilinearGrid(np.array(x, float), np.array(y, float), np.zeros(1))
    meaning.attach(mesh, Meaning(scales=[flat, up]))
    return mesh


def filling(mesh):
    """Return a section as a look draws it."""
    factor = georeference.stretch(mesh)
    return mesh if factor == 1 else files.stretched(mesh, factor)


def test_axes_of_different_units_fill_the_picture():
    mesh = section([0, 300], [-4000, 0], AxisScale("longitude"), AxisScale("depth", "m", -1.0))
    flat = filling(mesh)
    assert flat.bounds_size[0] / flat.bounds_size[1] == pytest.approx(1.6, rel=1e-3)
    up = meaning.of(flat).section[1]
    assert 4000 * up.factor == pytest.approx(flat.bounds[2])
    assert not up.is_log
    assert mesh.bounds[2] == -4000
    assert georeference.stretch(flat) == 1


@pytest.mark.parametrize("grid", [pv.RectilinearGrid, pv.ImageData])
def test_pressures_of_two_decades_are_drawn_by_their_logarithm(grid):
    levels = [-1000, -505, -10]
    mesh = section([-90, 90], levels, AxisScale("latitude"), AxisScale("pressure", "hPa", -1.0))
    if grid is pv.ImageData:
        image = pv.ImageData(dimensions=(2, 3, 1), spacing=(180, 495, 1), origin=(-90, -1000, 0))
        meaning.attach(image, meaning.of(mesh))
        mesh = image
    flat = filling(mesh)
    up = meaning.of(flat).section[1]
    assert up.is_log
    np.testing.assert_allclose(flat.y / up.factor, np.log10([1000, 505, 10]))
    assert flat.bounds_size[0] / flat.bounds_size[1] == pytest.approx(1.6, rel=1e-3)
    assert georeference.stretch(flat) == 1


@pytest.mark.parametrize(("units", "y", "kept"), [
    (("m", "m"), 5e3, True), (("", ""), 5e3, True), (("m", "m"), 100, False),
    (("K", "m"), 5e3, False), (("m", "m"), 11e3, False),
])  # fmt: skip
def test_lengths_keep_their_shape_if_it_can_be_seen(units, y, kept):
    mesh = section([0, 1e4], [0, y], AxisScale("x", units[0]), AxisScale("z", units[1]))
    assert (filling(mesh) is mesh) == kept
