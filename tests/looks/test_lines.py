"""Looks at lines: which of a dense set are shown."""

import contextlib

import numpy as np
import pytest
import pyvista as pv
from matplotlib import colormaps

import vizlight
from vizlight.looks.recipes import lines


def tangle(count, seed=0):
    """Return straight lines in a cube, each longer than the one before."""
    random = np.random.default_rng(seed)
    lengths = np.linspace(0.02, 0.5, count)
    ways = random.normal(size=(count, 3))
    ways *= (lengths / np.linalg.norm(ways, axis=1))[:, np.newaxis]
    begins = random.random((count, 3))
    points = np.stack([begins, begins + ways], axis=1).reshape(-1, 3)
    ids = np.arange(2 * count).reshape(-1, 2)
    return pv.PolyData(points, lines=np.insert(ids, 0, 2, axis=1).ravel())


def test_of_too_many_dense_lines_the_longest_are_shown_and_all_are_saved(monkeypatch, tmp_path):
    monkeypatch.setattr(lines, "MOST_LINES", 500)
    mesh = tangle(4000)
    look = vizlight.look(mesh)
    shown = look.drawing.layers[0].mesh.run()
    assert shown.n_cells == pytest.approx(500, abs=5)
    lengths = shown.compute_cell_sizes(area=False, volume=False)["Length"]
    assert lengths.min() > np.quantile(np.linspace(0.02, 0.5, 4000), 0.87)
    (key,) = look.drawing.keys
    assert key["title"] == f"direction of the longest {shown.n_cells} of 4000 lines"
    assert any("lines of 0.44 and longer are shown" in note for note in look.notes)
    assert look.mesh.n_cells == 4000
    # Few, and those that leave room for each other, are all shown.
    for few in (tangle(400), pv.PolyData(mesh.points * [40, 40, 0.0], lines=mesh.lines)):
        drawing = vizlight.look(few).drawing
        assert drawing.layers[0].mesh.run().n_cells == few.n_cells


def test_borders_on_a_map_have_one_color_and_no_key(tmp_path):
    corners = np.array([[-180.0, -80], [180, -80], [180, 80], [-180, 80], [-180, -80]])
    borders = pv.lines_from_points(np.column_stack([corners, 0 * corners[:, 0]]))
    borders.save(tmp_path / "borders.vtp")
    drawing = vizlight.look(tmp_path / "borders.vtp").drawing
    keywords = drawing.layers[0].keywords
    assert "color" in keywords
    assert "scalars" not in keywords
    assert [key["title"] for key in drawing.keys] == ["borders"]


def swirl():
    """Return a field whose speed rises outward from its axis, with a temperature."""
    grid = pv.ImageData(dimensions=(9, 9, 9), origin=(-4, -4, -4))
    x, y, z = grid.points.T
    grid["flow"], grid["T"] = np.column_stack([-y, x, 0 * z + 1]), z**2
    return grid


def test_streamlines_of_pyvista_have_the_colors_of_what_flows_and_none_of_the_tracer():
    lines_of = swirl().streamlines("flow", source_radius=3, n_points=12)
    look = vizlight.look(lines_of)
    (key,) = look.drawing.keys
    assert (look.array, key["title"]) == ("flow", "speed of flow")
    speeds = np.linalg.norm(lines_of["flow"], axis=1)
    assert key["clim"] == pytest.approx((speeds.min(), speeds.max()), rel=0.1)
    lines_of.set_active_scalars("T")
    assert vizlight.look(lines_of).array == "T"
    # By itself the time that a particle takes is a datum.
    times = lines_of.copy()
    times.clear_data()
    times["IntegrationTime"] = lines_of["IntegrationTime"]
    assert vizlight.look(times).array == "IntegrationTime"


def test_glyphs_of_pyvista_have_the_colors_of_their_scale_and_no_strokes():
    points = swirl().extract_subset((0, 8, 0, 8, 4, 4)).extract_surface(algorithm="geometry")
    points["speed"] = np.linalg.norm(points["flow"], axis=1)
    points.set_active_scalars("speed")
    look = vizlight.look(points.glyph(orient="flow", scale="speed", factor=0.1))
    assert (look.shown, look.array) == ("surface", "speed")


def test_contours_of_heights_have_the_colors_of_their_levels():
    x, y = np.meshgrid(np.linspace(-3, 3, 30), np.linspace(-3, 3, 30))
    hill = pv.StructuredGrid(x, y, np.exp(-(x**2) - y**2))
    hill["Elevation"] = hill.points[:, 2]
    assert vizlight.look(hill.contour(5, scalars="Elevation")).array == "Elevation"


@pytest.mark.opengl
def test_points_without_values_have_one_colour_though_an_array_is_active():
    cloud = pv.PolyData(np.random.default_rng(0).random((50, 3)))
    cloud["ID"] = np.arange(50) % 25
    with contextlib.closing(vizlight.look(cloud, size=(150, 100)).plotter()) as plotter:
        picture = np.asarray(plotter.screenshot(return_img=True), dtype=float)
    ink = picture[picture.min(axis=2) < 200]
    assert len(ink) > 50
    # Blue, lit or not.
    assert np.all(ink[:, 2] >= ink[:, 0])


def test_directions_have_colours_that_go_around():
    cloud = pv.PolyData(np.random.default_rng(0).random((50, 3)))
    cloud["bearing"] = np.linspace(0.0, 355.0, 50)
    (key,) = vizlight.look(cloud, size=(150, 100)).drawing.keys
    assert key["clim"] == (0, 360)
    first, last = colormaps[key["cmap"]]([0.0, 1.0])
    np.testing.assert_allclose(first, last)


@pytest.mark.parametrize(("others", "shown"), [(4, "lines by their direction"), (40, "colours of")])
def test_lines_nearly_all_of_one_bundle_are_shown_by_their_direction(others, shown):
    mesh = tangle(100)
    mesh.cell_data["group"] = np.where(np.arange(100) < others, 2, 1)
    look = vizlight.look(mesh)
    assert shown in look.drawing.words
    assert "colours of group" in vizlight.look(mesh, array="group").drawing.words


def test_some_of_the_lines_are_drawn_as_all_are():
    mesh = tangle(300)
    mesh.cell_data["group"] = np.arange(300) % 2
    whole = vizlight.look(mesh, scalars="direction").drawing.layers[0].keywords
    part = vizlight.look(mesh, threshold="group:1:1").drawing.layers[0]
    assert part.mesh.run().n_lines == 150
    assert part.keywords["rgb"]
    assert part.keywords["line_width"] >= whole["line_width"]


def test_light_of_the_colours_of_the_key_is_mixed_by_direction():
    mesh = tangle(20)
    look = vizlight.look(mesh)
    shown = look.drawing.layers[0].mesh.run()
    lines = np.diff(mesh.points.reshape(-1, 2, 3), axis=1)[:, 0]
    shares = lines**2 / np.sum(lines**2, axis=1, keepdims=True)
    keys = look._keys[0]["cmap"].run().values[:, :3].astype(float)
    assert np.ptp(keys, axis=1).max() < 200
    np.testing.assert_allclose(shown["rgb"][::2], np.sqrt(shares @ keys**2), atol=1.01)


def test_lines_of_a_mat_are_round_and_others_have_outlines():
    row = np.linspace(0.0, 1.0, 30)
    ends = np.array([((0, y, z), (3, y, z)) for y in row for z in row]).reshape(-1, 3)
    mat = pv.PolyData(ends, lines=np.insert(np.arange(1800).reshape(-1, 2), 0, 2, axis=1))
    shown = vizlight.look(mat).drawing.layers[0].keywords
    assert shown["render_lines_as_tubes"]
    assert shown["halo"] is False
    crossing = vizlight.look(tangle(300)).drawing.layers[0].keywords
    assert crossing["halo"] == "black"
    assert "render_lines_as_tubes" not in crossing


def test_no_words_are_above_a_picture_without_a_title():
    mesh = tangle(20)
    assert all(not key.get("title") for key in vizlight.look(mesh, title="")._keys)
    assert any(key.get("title") for key in vizlight.look(mesh)._keys)


def test_a_bar_of_lengths_holds_at_every_depth():
    mesh = tangle(20)
    assert not vizlight.look(mesh).view.parallel_projection
    mesh.field_data["unit"] = ["millimetre"]
    assert vizlight.look(mesh).view.parallel_projection
    assert not vizlight.look(mesh, parallel=False).view.parallel_projection
