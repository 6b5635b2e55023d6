"""Tests of heights under a sun."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.geometry.relief import sun
from vizlight.looks.recipes import reliefs
from vizlight.mesh import georeference, height_grids

SIZE = (120, 90)


def hills(steepness):
    """Return waves of heights whose steepest slope is given, in metres, ten to a side."""
    grid = pv.ImageData(dimensions=(101, 81, 1), spacing=(50.0, 50.0, 1.0))
    x, y, _ = grid.points.T
    wave = 500 / (2 * np.pi)
    grid["elevation"] = steepness * wave * (np.sin(x / wave) + np.sin(y / wave)) / np.sqrt(2)
    return grid


def under(altitude):
    """Return a scene with the sun at an altitude in degrees."""
    return vizlight.Scene(lights=[vizlight.Light(direction=tuple(sun.toward(280.0, altitude)))])


def taken(look):
    return next(step for step in look.drawing.lit.chain() if hasattr(step, "keywords")).keywords


@pytest.mark.parametrize("altitude", [10.0, 25.0, 60.0])
def test_heights_are_raised_no_more_than_the_light_lies_on_most_of_them(altitude):
    mesh = hills(0.1)
    look = vizlight.look(mesh, "relief", scene=under(altitude), size=SIZE)
    factor = taken(look).get("exaggeration", 1.0)
    usual = georeference.exaggeration(mesh, "elevation")
    most = np.tan(np.radians(altitude)) / height_grids.steep(mesh, "elevation", reliefs.LIT)
    assert 1 <= factor <= max(usual, reliefs.GENTLE)
    assert factor <= max(most, 1.0)
    assert any("shadow of this light" in note for note in look.notes) == (factor < usual)
    assert any(f"azimuth and altitude 280,{altitude:g}" in note for note in look.notes)


@pytest.mark.parametrize("is_gentle", [True, False])
def test_gentle_slopes_are_raised(is_gentle):
    mesh = hills(0.8)
    if is_gentle:
        mesh["elevation"] = 0.2 * mesh.points[:, 0]
    assert georeference.exaggeration(mesh, "elevation") == 1
    look = vizlight.look(mesh, "relief", scene=under(45.0), size=SIZE)
    assert taken(look).get("exaggeration", 1.0) == (reliefs.GENTLE if is_gentle else 1.0)
    assert any("slopes are gentle" in note for note in look.notes) == is_gentle


def test_a_factor_of_the_user_is_kept_in_a_low_light():
    look = vizlight.look(hills(0.1), "relief", scene=under(10.0), exaggeration=7, size=SIZE)
    assert taken(look)["exaggeration"] == 7
    assert not any("shadow of this light" in note for note in look.notes)


def test_a_slope_is_that_of_a_plane():
    grid = pv.ImageData(dimensions=(9, 7, 1), spacing=(2.0, 3.0, 1.0))
    grid["h"] = 0.3 * grid.points[:, 0] + 0.4 * grid.points[:, 1]
    for mesh in (grid, grid.cast_to_structured_grid(), grid.extract_surface(algorithm=None)):
        assert height_grids.steep(mesh, "h", 0.5) == pytest.approx(0.5)
    grid["h"][:] = np.nan
    assert height_grids.steep(grid, "h", 0.5) == 0


def test_a_relief_is_offered_where_values_may_be_heights():
    grid = pv.ImageData(dimensions=(24, 18, 1))
    grid["ground"] = np.sin(grid.points[:, 0]) + grid.points[:, 1] ** 2
    look = vizlight.look(grid, size=SIZE)
    assert look.others[0].shell == "--for relief"
    assert vizlight.look(grid, "relief", size=SIZE).question == "relief"
    grid.rename_array("ground", "cloud")
    assert not vizlight.look(grid, size=SIZE).others


def test_heights_of_cells_of_any_shape_have_the_colours_of_a_ground():
    faces = pv.Plane(i_resolution=6, j_resolution=5).triangulate()
    faces["elevation"] = np.linspace(-3.0, 9.0, faces.n_points)
    look = vizlight.look(faces, size=SIZE)
    table = look.drawing.layers[0].keywords["cmap"]
    assert table.path == "vizlight.maps.heights"
    assert table.arguments == look.drawing.keys[0]["clim"] == (-3, 9)
    assert vizlight.look(faces, cmap="jet", size=SIZE).drawing.keys[0]["cmap"] == "jet"
