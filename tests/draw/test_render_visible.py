"""A picture in which data are hardly seen says so."""

import warnings

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import Scene, View, presets, render

SCENE = Scene(view=View(direction=(1, 1, 1)))
SIZE = (120, 80)


def lit(mesh):
    mesh.clear_data()
    return vizlight.illuminate(mesh, SCENE)


def test_the_share_is_that_of_the_square():
    plotter = pv.Plotter(off_screen=True, window_size=(100, 100))
    plotter.add_mesh(pv.Plane(), color="red", lighting=False)
    plotter.view_xy()
    plotter.camera.parallel_projection = True
    plotter.camera.parallel_scale = 1
    plotter.add_text("no data")
    share = render.share_of_data(plotter, plotter.screenshot(return_img=True))
    assert share == pytest.approx(0.25, abs=0.02)


def test_keys_are_no_data():
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.vizlight.add_key(presets.direction())
    plotter.add_mesh(pv.Sphere(), color="red")
    plotter.camera.position, plotter.camera.focal_point = (9, 0, 0), (10, 0, 0)
    plotter.reset_camera_clipping_range()
    share = render.share_of_data(plotter, plotter.screenshot(return_img=True))
    assert share == 0


def narrow():
    return pv.Plane(i_size=1, j_size=1e5)


def along_the_view():
    return pv.Line((0, 0, 0), (1, 1, 1))


@pytest.mark.parametrize("make", [narrow, along_the_view])
@pytest.mark.filterwarnings("ignore:.*could not be lit")
def test_what_is_hardly_seen_is_said(make, tmp_path):
    view = render.camera_on(make(), (1, 1, 1))
    with pytest.warns(UserWarning, match="hardly seen in 'p.png'"):
        render.save_png(lit(make()), tmp_path / "p.png", camera=view, size=SIZE)
    assert (tmp_path / "p.png").exists()


@pytest.mark.parametrize("make", [pv.Sphere, lambda: pv.Line((0, 0, 0), (1, 0, 0))])
def test_what_is_seen_needs_no_word(make, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        render.save_png(lit(make()), tmp_path / "p.png", size=SIZE)
    assert np.ptp(pv.read(tmp_path / "p.png").point_data.active_scalars)
