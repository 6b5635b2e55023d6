"""``mesh.vizlight.plot`` takes what ``pyvista.plot`` takes."""

import inspect

import numpy as np
import pytest
import pyvista as pv
from shapes import ball

pytestmark = pytest.mark.opengl

SIZE = (90, 80)
#: A value for each keyword of ``pyvista.plot``.
VALUES = {
    "off_screen": True, "full_screen": False, "screenshot": False, "interactive": False,
    "cpos": "xy", "window_size": SIZE, "show_bounds": True, "show_axes": True, "notebook": False,
    "background": "black", "text": "words", "return_img": True, "eye_dome_lighting": True,
    "parallel_projection": True, "jupyter_backend": None, "return_viewer": False,
    "return_cpos": True, "jupyter_kwargs": {}, "theme": pv.themes.DarkTheme(),
    "anti_aliasing": "ssaa", "zoom": 1.5, "border": True, "border_color": "red",
    "border_width": 2.0, "before_close_callback": lambda _: None, "edl": True, "show_grid": True,
}  # fmt: skip


def shown(**options):
    kept = {"off_screen": True, "window_size": SIZE, "color": "white", "return_img": True}
    return ball().vizlight.plot(**(kept | options))


def test_every_keyword_of_pyvista_is_taken():
    named = {*inspect.signature(pv.plot).parameters} - {"var_item", "kwargs", "volume", "ssao"}
    assert named <= VALUES.keys()
    for names in (VALUES.keys() - {"edl"}, {"edl"}):  # the other name of eye_dome_lighting
        shown(**{name: VALUES[name] for name in names})


def test_keywords_change_the_picture():
    plain = shown(show_axes=False).astype(int)
    changes = {"text": "words", "zoom": 1.5, "cpos": "xy", "background": "black", "border": True}
    changes |= {"show_bounds": True, "show_axes": True, "anti_aliasing": False}
    for name, value in changes.items():
        seen = shown(**{"show_axes": False, name: value}).astype(int)
        assert np.abs(seen - plain).max() > 20, name


def test_a_volume_has_the_light_of_pyvista():
    grid = pv.ImageData(dimensions=(4, 4, 4))
    grid["height"] = np.arange(64.0)
    with pytest.warns(UserWarning, match="volume=True"):
        grid.vizlight.plot(volume=True, off_screen=True, scalars="height")


def test_unknown_keywords_name_the_nearest():
    with pytest.raises(TypeError, match=r"zom: .*did you mean zoom=\?"):
        shown(zom=2)


def test_short_form_saves_a_picture(tmp_path):
    path = tmp_path / "ball.png"
    ball().vizlight.plot(
        scalars="height", off_screen=True, screenshot=path, window_size=SIZE, background="black",
    )  # fmt: skip
    image = pv.read(path)
    assert image.dimensions[:2] == SIZE
    assert image.point_data.active_scalars.max() > 60
    with pytest.raises(ValueError, match="scalars: expected"):
        ball().vizlight.plot(scalars="none", off_screen=True)
