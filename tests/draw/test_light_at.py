"""Pictures of lit meshes: in fragments from the record, or the array as it is."""

import numpy as np
import pytest
import pyvista as pv
from fields import several_kinds
from lamps import far, shiny
from shapes import helix

import vizlight
from vizlight import View, render

pytestmark = pytest.mark.opengl


@pytest.fixture(autouse=True)
def one_sample_per_pixel(monkeypatch):
    """Draw pixels that are covered or not, whose colours can be compared."""
    monkeypatch.setattr(pv.global_theme, "multi_samples", 1)


def picture(mesh, **options):
    look = {"size": (240, 200), "background": "black", "anti_aliasing": None, "line_width": 3}
    (found,) = render.pictures([[mesh]], **look | options)
    return found.astype(np.int16)


CAMERA = render.camera_on((-1, 1, -1, 1, -1, 1), (1, 0.5, 0.6))
SCENE = far((1, 0.9, 0.5), CAMERA, shiny(shininess=60))


def lit_by(camera):
    return SCENE.replace(view=View.from_camera(camera))


def test_pictures_are_right_between_the_points():
    coarse, fine = (
        picture(vizlight.illuminate(helix(count), SCENE), camera=CAMERA) for count in (61, 6001)
    )
    points = picture(vizlight.illuminate(helix(61), SCENE), camera=CAMERA, light="points")
    both = (fine.min(axis=-1) > 0) & (coarse.min(axis=-1) > 0)
    errors = [np.abs(shown - fine)[both].mean() for shown in (coarse, points)]
    assert errors[0] < 0.5 * errors[1]


@pytest.mark.slow
@pytest.mark.parametrize("sky", [False, True])
def test_faces_lines_and_vertices_have_the_light_of_their_points(sky):
    mesh, options = several_kinds(120)[0], {}
    if sky:
        mesh["sky"] = np.linspace(0.2, 1, mesh.n_points)
        options = {"occlusion": "sky"}
    camera = render.camera_on(mesh.bounds, (1, 0.5, 0.6))
    lit = vizlight.illuminate(mesh, lit_by(camera), **options)
    look = {"camera": camera, "scalars": "luminance"}
    got, expected = picture(lit, **look), picture(lit, light="points", **look)
    error = np.abs(got - expected).max(axis=-1)[expected.max(axis=-1) > 0]
    assert np.quantile(error, 0.995) <= 4
    # What is drawn of the lines and the vertices is a share that matters.
    faces = picture(vizlight.illuminate(several_kinds(120)[1][0], lit_by(camera)), **look)
    assert np.mean((expected > 0) & (faces == 0)) > 0.004


def test_tinted_pictures_are_right_between_the_points():
    shown = []
    # Colours of data have no highlight: what bends between the points is the diffuse light.
    scene = SCENE.replace(material=shiny(ambient=0.0, diffuse=1.0))
    for count, light in ((6001, "points"), (61, "auto"), (61, "points")):
        mesh = helix(count)
        mesh["height"] = np.array(mesh.points[:, 2])
        tinted = vizlight.tint(vizlight.illuminate(mesh, scene), "height", cmap="viridis")
        shown.append(picture(tinted, scalars="rgb", camera=CAMERA, light=light))
    fine, *coarse = shown
    both = np.min([found.max(axis=-1) for found in shown], axis=0) > 0
    errors = [np.abs(found - fine)[both].mean() for found in coarse]
    assert errors[0] < 0.5 * errors[1]
    tinted["rgb"] = 255 - np.asarray(tinted["rgb"])
    options = {"scalars": "rgb", "camera": CAMERA}
    kept = [picture(tinted, light=light, **options) for light in ("auto", "points")]
    np.testing.assert_array_equal(*kept)


def test_an_array_that_is_not_that_of_its_record_is_drawn_as_it_is():
    lit = vizlight.illuminate(helix(61), SCENE)
    lit["luminance"] = 0.3 * np.asarray(lit["luminance"])
    shown = (picture(lit, camera=CAMERA, light=light) for light in ("auto", "points"))
    np.testing.assert_array_equal(*shown)
    bare = helix(61)
    bare["luminance"] = np.linspace(0, 1, bare.n_points)
    shown = (picture(bare, camera=CAMERA, light=light) for light in ("auto", "points"))
    np.testing.assert_array_equal(*shown)
    with pytest.raises(ValueError, match="light: expected 'auto' or 'points'"):
        render.make_plotter(lit, light="fragments")


def test_scalar_bar_beside_lit_colours_shows_the_unlit_ones():
    ball = pv.Sphere()
    ball["height"] = np.array(ball.points[:, 2])
    tinted = vizlight.tint(vizlight.illuminate(ball, SCENE), "height", cmap="hot", clim=(-1, 1))
    plotter = render.make_plotter(tinted, scalars="rgb", bar="height, m", size=(200, 160))
    table = plotter.scalar_bars["height, m"].GetLookupTable()
    np.testing.assert_array_equal(
        pv.convert_array(table.GetTable()), pv.LookupTable("hot", n_values=256).values
    )
    shown = np.array(plotter.screenshot(None, return_img=True))
    # The mapper gives the table its own range when it draws.
    assert table.GetRange() == (-1, 1)
    expected = pv.Plotter(off_screen=True, window_size=(200, 160))
    expected.add_mesh(tinted, scalars="rgb", rgb=True, lighting=False)
    direct = np.array(expected.screenshot(None, return_img=True))
    # A ball of red and black through white: both have the same darkest and brightest colours.
    assert np.ptp(shown[..., 0].astype(int)) > 150
    assert np.ptp(direct[..., 0].astype(int)) > 150
