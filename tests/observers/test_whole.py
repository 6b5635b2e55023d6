"""What a plotter shows is read where its actors have placed it."""

import numpy as np
import pytest
import pyvista as pv
from sheets import DIRECTION, FLAT, HOW, SHAPE, plotter_of, sheet

from vizlight.draw.cameras import camera_on
from vizlight.observers.whole import moved
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
