"""What a plotter shows is read where its actors have placed it."""

import numpy as np
import pytest
import pyvista as pv
from PIL import Image
from sheets import DIRECTION, FLAT, HOW, SHAPE, plotter_of, sheet

from vizlight.draw.cameras import camera_on
from vizlight.observers.whole import moved, read_picture, reading
from vizlight.shading.options import LightOptions

pytestmark = pytest.mark.opengl

#: A turn about z, a scale and a step.
MATRIX = np.array([[0.8, -0.9, 0, 3], [0.6, 1.2, 0, 1], [0, 0, 1.3, 0], [0, 0, 0, 1]])


@pytest.mark.parametrize(
    ("question", "how"),
    [("direction", DIRECTION), ("shape", SHAPE), ("value", {"scene": FLAT, "scalars": "height"})],
)
def test_a_moved_actor_is_read_like_a_moved_mesh(question, how):
    mesh = sheet()
    there, options = moved(mesh, LightOptions(tangents="swirl"), MATRIX)
    there["swirl"] = options.tangents
    figures = []
    for shown in (mesh, there):
        plotter, actor = plotter_of(shown, **how)
        if shown is mesh:
            actor.user_matrix = MATRIX
        plotter.camera = camera_on(there, (0.1, 0.05, 1), up=(0, 1, 0), aspect=1.5)
        figures.append(getattr(plotter.vizlight.legibility(**HOW), question))
        plotter.close()
    assert figures[0].bits > 1
    assert figures[0].bits == pytest.approx(figures[1].bits, abs=0.08)
    assert figures[0].median == pytest.approx(figures[1].median, rel=0.1)


def test_position_and_scale_of_plain_colors_are_read():
    mesh = sheet()
    plotter = pv.Plotter(off_screen=True, window_size=(360, 240))
    how = {"cmap": "coolwarm", "lighting": False, "show_scalar_bar": False}
    actor = plotter.add_mesh(mesh, scalars="height", **how)
    actor.position, actor.scale = (5, 0, 0), (2, 1, 1)
    plotter.camera = camera_on(actor.bounds, (0, 0, 1), aspect=1.5)
    found = plotter.vizlight.legibility(**HOW).value
    plotter.close()
    assert found.median < 0.03


def test_normals_stay_across_a_scaled_surface():
    mesh = sheet()
    given = mesh.compute_normals(cell_normals=False).point_data["Normals"]
    there, options = moved(mesh, LightOptions(normals=np.asarray(given)), MATRIX)
    own = there.compute_normals(cell_normals=False).point_data["Normals"]
    rows = options.normals / np.linalg.norm(options.normals, axis=1, keepdims=True)
    inner = np.abs(np.asarray(mesh.points)[:, :2]).max(axis=1) < 0.9
    assert np.abs(np.einsum("ij,ij->i", rows, own))[inner].min() > 0.999
    assert np.array_equal(mesh.points, sheet().points)


def test_values_of_a_mesh_in_4_space_are_read():
    mesh = sheet()
    mesh["place"] = np.insert(np.asarray(mesh.points, np.float64), 3, mesh["speed"], axis=1)
    mesh["along"] = np.insert(mesh["swirl"], 3, 0.0, axis=1)
    how = {"positions": "place", "tangents": "along", "scalars": "height", "cmap": "coolwarm"}
    plotter, _ = plotter_of(mesh, show_scalar_bar=False, **how)
    found = plotter.vizlight.legibility(**HOW)
    plotter.close()
    assert found.value.median < 0.04
    assert found.direction is None


def test_a_direction_up_near_the_line_of_sight_turns_no_answer():
    medians = []
    for up in ((0, 1, 0), (0, 0, 1)):
        plotter, _ = plotter_of(sheet(), **DIRECTION)
        plotter.camera = camera_on(sheet(), (0.1, 0.05, 1), up=up, aspect=1.5)
        medians.append(plotter.vizlight.legibility(**HOW).direction.median)
        plotter.close()
    assert max(medians) < 6


def test_pictures_are_read_upright_and_without_their_opacity(tmp_path):
    picture = np.random.default_rng(0).integers(0, 256, (9, 12, 4), dtype=np.uint8)
    Image.fromarray(picture[..., :3]).save(tmp_path / "picture.png")
    expected = picture[..., :3] / 255
    for given in (picture, picture / 255, expected, tmp_path / "picture.png"):
        np.testing.assert_allclose(read_picture(given), expected)
    assert read_picture(np.zeros((8, 8, 3))).shape == (8, 8, 3)
    wrong = np.full((9, 9, 3), np.nan)
    for given in (
        picture[..., :2],
        picture[..., 0],
        picture[:7],
        picture[:, :7],
        wrong,
        1.1 + wrong,
    ):
        with pytest.raises(ValueError, match="picture: expected"):
            read_picture(given)


@pytest.mark.parametrize(
    ("given", "expected"),
    [((None, None, None), (85, 400)), ((50, None, None), (50, 400)), ((None, 250, None), (85, 250)),
     ((None, None, 96), (254, 600)), ((None, 500, 96), (254, 500))],
)  # fmt: skip
def test_a_picture_has_the_size_of_a_column_or_of_a_screen(given, expected):
    found = reading(960, *given, 2.3, 10, 3)
    assert (found["size_mm"], found["distance_mm"]) == pytest.approx(expected)
    assert (found["noise"], found["samples"], found["seed"]) == (2.3, 10, 3)


def test_the_active_part_of_a_window_is_read_alone():
    plotter = pv.Plotter(off_screen=True, shape=(2, 2), window_size=(240, 160), border=False)
    plotter.add_mesh(pv.Plane(), color="black")
    for row, column in ((1, 0), (0, 1)):
        plotter.subplot(row, column)
        how = {"cmap": "coolwarm", "lighting": False, "show_scalar_bar": False}
        plotter.add_mesh(sheet(30), scalars="height", **how)
        plotter.camera = camera_on(sheet(30), (0, 0, 1), aspect=1.5)
        found = plotter.vizlight.legibility(size_mm=20, samples=256)
        assert found.size == (120, 80)
        assert found.value.median < 0.03
        assert (found.size_mm, found.noise, found.seed) == (20, 2.3, 0)
    plotter.close()


def test_a_plotter_without_a_camera_is_read_from_where_pyvista_shows_it():
    figures = []
    for placed in (False, True):
        plotter, _ = plotter_of(sheet(30), **SHAPE)
        plotter.camera_set = False
        if placed:
            plotter.view_isometric(render=False)
        figures.append(plotter.vizlight.legibility(**HOW))
        plotter.close()
    assert figures[0] == figures[1]
    assert figures[0].toward_eye == pytest.approx([3**-0.5] * 3)


def test_what_hides_a_mesh_and_what_is_nearly_clear():
    flat = {"cmap": "coolwarm", "lighting": False, "show_scalar_bar": False}
    pixels = []
    for opacity in (0.4, 0.6, 0.0):
        plotter = pv.Plotter(off_screen=True, window_size=(120, 80))
        plotter.add_mesh(sheet(20), scalars="height", **flat)
        front = plotter.add_mesh(pv.Plane(center=(0.5, 0, 1), j_size=2), opacity=opacity or 1.0)
        front.SetVisibility(opacity > 0)
        plotter.camera = camera_on(sheet(20), (0, 0, 1), aspect=1.5, parallel=True)
        pixels.append(plotter.vizlight.legibility(size_mm=20, samples=64).pixels)
        plotter.close()
    assert pixels[0] == pixels[2]
    assert pixels[1] == pytest.approx(pixels[0] / 2, rel=0.03)
