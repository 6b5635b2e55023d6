"""What of a field is shown follows from how fast it turns in the picture."""

from types import SimpleNamespace

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.draw.render import BackendError
from vizlight.looks.recipes import drawing, fields
from vizlight.mesh import meaning


def sheet(turn, count=60):
    """Flat grid of unit cells whose vectors turn by an angle from each column to the next."""
    grid = pv.ImageData(dimensions=(count, count // 2, 1))
    angle = turn * grid.points[:, 0]
    speed = 1 + grid.points[:, 1] / count
    grid["wind"] = (speed * np.stack([np.cos(angle), np.sin(angle), 0 * angle])).T
    return grid


@pytest.mark.parametrize("turn", [0.0, 0.2, 1.0])
@pytest.mark.parametrize("kind", ["image", "polygons"])
def test_the_turn_of_a_field_is_that_per_length_around_its_cells(turn, kind):
    grid = sheet(turn)
    mesh = grid if kind == "image" else grid.extract_surface(algorithm="dataset_surface")
    # Along the columns it does not turn, and each cell has as many edges along them.
    assert fields.turn_of(mesh, "wind") == pytest.approx(turn / 2, rel=1e-6, abs=1e-7)


def test_what_a_field_does_in_few_places_does_not_count():
    grid = sheet(0.2)
    wild = np.asarray(grid.points)[:, 0] > 45
    grid["wind"][wild] = np.random.default_rng(0).normal(size=(wild.sum(), 3))
    assert fields.turn_of(grid, "wind") == pytest.approx(0.1, rel=1e-6)
    # Cells that are small are few places, however many they are.
    small = pv.ImageData(dimensions=(90, 90, 1), spacing=(1e-3, 1e-3, 1))
    small["wind"] = np.random.default_rng(0).normal(size=(small.n_points, 3))
    quads = [mesh.extract_surface(algorithm="dataset_surface") for mesh in (sheet(0.2), small)]
    both = pv.merge(quads, merge_points=False)
    assert fields.turn_of(both, "wind") == pytest.approx(0.1, rel=1e-6)


def test_a_field_at_rest_does_not_turn():
    grid = sheet(1.0)
    grid["wind"][:] = 0
    grid["wind"][0] = np.nan
    assert fields.turn_of(grid, "wind") == 0


@pytest.mark.usefixtures("few_strokes")
def test_a_slow_field_is_arrows_along_it_over_its_speed():
    look = vizlight.look(sheet(0.05))
    assert look.drawing.words == "length of wind in colours, with strokes along it"
    assert not look.notes
    ground, strokes = look.drawing.layers
    assert ground.keywords["scalars"] == "wind"
    assert strokes.keywords["width"] == "width"
    assert "point downstream" in look.drawing.keys[0]["title"]
    assert look.drawing.keys[0]["clim"] == (1.0, 1.5)
    mesh = strokes.mesh.run()
    line = mesh.get_cell(mesh.n_cells // 2)
    widths, age = mesh["width"][line.point_ids], mesh["age"][line.point_ids]
    along = np.einsum("ij,ij->i", np.diff(line.points, axis=0), mesh["wind"][line.point_ids[1:]])
    # The head, from its base to its tip, is ahead.
    assert np.all(np.sign(along) == np.sign(along[0]))
    ahead = widths[:: int(np.sign(along[0]))]
    base = int(np.argmax(ahead))
    assert np.all(np.diff(ahead[: base + 1]) > 0)
    assert np.all(np.diff(ahead[base:]) < 0)
    assert base > len(ahead) / 2
    assert np.all(np.diff(age) * along > 0)


@pytest.mark.usefixtures("few_strokes")
def test_the_title_of_a_cut_tells_its_place_its_axes_and_what_its_arrows_are():
    grid = pv.ImageData(dimensions=(9, 31, 31), spacing=(0.5, 0.1, 0.1))
    x, y, z = grid.points.T
    grid["wind"] = np.stack([5 + y, 0.2 * z - 0.3, 0.3 - 0.1 * y], axis=1)
    look = vizlight.look(grid, slice="x:2")
    assert look.drawing.words.startswith("length of wind in colours, with strokes")
    title = look.drawing.keys[0]["title"]
    assert title.startswith("speed of wind; arrows: part in the cut; x = 2, ")
    # The words for the axes are those of the camera.
    eye = look.view
    for letter, axis in (("y", (0, 1, 0)), ("z", (0, 0, 1))):
        right, up = (float(np.dot(axis, way)) for way in (np.cross(eye.direction, eye.up), eye.up))
        word = {1: "to the right", -1: "to the left"}.get(round(right)) or {1: "up"}.get(
            round(up), "down"
        )
        assert f"{letter} {word}" in title
    grid["heat"] = x + y + z
    for axes, words in ((["x", "y", "z"], "z = 1, "), ([*meaning.ANATOMY], "R to the right, A up")):
        meaning.attach(grid, meaning.Meaning(axes=axes))
        assert words in vizlight.look(grid, slice="z:1", array="heat").drawing.keys[0]["title"]
    oblique = vizlight.look(grid, slice="1,1,0:1", array="heat").drawing.keys[0]["title"]
    assert oblique.lower() == "heat"


@pytest.mark.slow
def test_strokes_are_nearer_where_the_field_turns_faster():
    spacings = []
    for turn in (0.05, 0.7):
        strokes = vizlight.look(sheet(turn, 120)).drawing.layers[1].mesh
        spacings.append(strokes.keywords["spacing"])
    assert spacings[0] == pytest.approx(sheet(0, 120).length / 50, rel=0.01)
    assert spacings[1] < 0.8 * spacings[0]


@pytest.mark.slow
def test_strokes_of_a_large_grid_follow_it_in_a_share_of_its_points():
    turn, grid = 0.005, sheet(0.005, count=800)
    grid.offset = (10, 5, 0)
    strokes = vizlight.look(grid).drawing.layers[1].mesh
    assert strokes.arguments[0].run().n_points < grid.n_points / 3
    lines = strokes.run()
    angle = turn * (lines.points[:, 0] - grid.bounds[0])
    along = np.cos(angle) * lines["Tangents"][:, 0] + np.sin(angle) * lines["Tangents"][:, 1]
    assert along.min() > np.cos(0.01)
    assert np.ptp(lines.points, axis=0)[:2] == pytest.approx([799, 399], rel=0.02)


@pytest.mark.slow
def test_a_faster_field_is_hues_and_a_faster_one_yet_its_speed_alone():
    look = vizlight.look(sheet(0.9, 300))
    assert "hue tells its course" in look.notes[0]
    assert look.drawing.words == "direction of wind"
    random = np.random.default_rng(0)
    noise = sheet(0, 300)
    noise["wind"][:, :2] = random.normal(size=(noise.n_points, 2))
    look = vizlight.look(noise)
    assert "for its course to be seen" in look.notes[0]
    assert look.drawing.words == "length of wind in colours"
    assert len(look.drawing.layers) == 1


def volume(noise):
    grid = pv.ImageData(dimensions=(14, 13, 12), origin=(-6.5, -6, -5.5))
    x, y, _ = grid.points.T
    grid["V"] = np.stack([-y, x, 0 * x + 1], axis=1)
    random = np.random.default_rng(1).normal(size=(grid.n_points, 3))
    where = grid.points[:, 2] < noise
    grid["V"][where] = random[where]
    return grid


@pytest.mark.slow
def test_a_volume_has_a_floor_where_it_is_seen_from_above():
    grid = pv.ImageData(dimensions=(6, 6, 6))
    grid["v"] = np.column_stack([1 + grid.points[:, 2], 0 * grid.points[:, :2]])
    for view, count in ((None, 1), ((1, -1, 0.5), 1), ((1, -1, -0.5), 0)):
        layers = vizlight.look(grid, view=view, size=(300, 200)).drawing.layers
        floors = [layer.mesh.run() for layer in layers if layer.mesh.name == "floor"]
        assert len(floors) == count
        for floor in floors:
            np.testing.assert_allclose(floor.bounds[:4], (0, 5, 0, 5), atol=1e-6)
            assert -0.05 < floor.bounds[5] < 0


@pytest.mark.slow
def test_flow_runs_across_the_picture_to_the_right():
    grid = pv.ImageData(dimensions=(9, 9, 9))
    grid["v"] = np.column_stack([0 * grid.points[:, :2], 0 * grid.points[:, 0]])
    grid["v"][:, 1] = 1 + grid.points[:, 2]
    look = vizlight.look(grid, size=(300, 200))
    right = np.cross(look.view.direction, look.view.up)
    assert right[1] > 0.75


@pytest.mark.slow
def test_flow_that_is_asked_for_has_the_colours_of_its_speed_and_its_light_in_files():
    grid = pv.ImageData(dimensions=(6, 6, 6))
    grid["v"] = np.column_stack([1 + grid.points[:, 2], 0 * grid.points[:, :2]])
    look = vizlight.look(grid, "flow", size=(300, 200))
    assert look.drawing.keys[0]["question"] == "value"
    assert "speed" in look.drawing.words
    # The names of colour maps are known to a script.
    assert "import vizlight.maps\n" in look.script()
    assert np.max(look.mesh["luminance"]) < 0.95


def test_zones_of_a_flow_have_no_walls_where_they_meet():
    zones = [
        pv.ImageData(dimensions=(9, 9, 5), spacing=(0.1,) * 3, origin=(0, 0, z)) for z in (0, 0.4)
    ]
    for zone in zones:
        zone["wind"] = zone.points + 1.0
    blocks = pv.MultiBlock([zone.cast_to_unstructured_grid() for zone in zones])
    look = vizlight.look(blocks, size=(240, 160))
    (hull,) = (layer.mesh.run() for layer in look.drawing.layers if layer.mesh.name == "hull")
    assert hull.area == pytest.approx(6 * 0.8**2)
    assert look.mesh.array_names


def test_short_lines_are_left_out_of_volumes_and_counted_where_some_are_long():
    noisy = vizlight.look(volume(0), "flow", seeds=60)
    assert noisy.drawing.words == "streamlines of V in the colours of their speed"
    lines = noisy.drawing.lit.run()
    assert lines.field_data["left_out"][0] > 5
    assert noisy.notes[-1].endswith(f"left out: {lines.field_data['left_out'][0]}")
    short = vizlight.look(volume(-9), "flow", seeds=20, max_length=1.0)
    assert not any("left out" in note for note in short.notes)
    assert short.drawing.lit.run().n_lines > 0


@pytest.mark.slow
def test_unit_vectors_are_shown_by_their_direction_and_not_by_their_length():
    image = pv.ImageData(dimensions=(5, 5, 5))
    x, y, _ = (np.asarray(image.points) - 2).T
    vectors = np.stack([-y, x, 0 * x + 3], axis=1)
    image["m"] = vectors
    assert vizlight.look(image, size=(120, 80)).drawing.keys[0]["question"] == "value"
    image["m"] = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    look = vizlight.look(image, size=(120, 80))
    assert "question" not in look.drawing.keys[0]
    assert "speed" not in look.summary


def test_an_image_with_vectors_in_a_small_part_is_drawn_around_that_part():
    grid = pv.ImageData(dimensions=(30, 30, 30), origin=(5, 0, 0))
    flows = np.linalg.norm(grid.points - (15, 10, 10), axis=1) < 5
    grid["V"] = np.outer(flows, (0.0, 0, 1))
    look = vizlight.look(grid, size=(300, 200))
    assert "extract_subset([5, 15, 5, 15, 5, 15])" in look.script()
    assert look.key[0]["title"] == "V"


@pytest.mark.usefixtures("few_strokes")
def test_strokes_along_the_border_are_left_out():
    grid = sheet(0.0)
    grid["wind"][:, 0] += np.asarray(grid.points)[:, 0] / 30
    step = vizlight.look(grid, size=(300, 200)).drawing.layers[-1].mesh
    assert fields.have_sense(step)
    mesh, scene = (argument.run() for argument in step.arguments)
    whole = {name: value for name, value in step.keywords.items() if name != "stroke_length"}
    for lines, is_inner in (
        (vizlight.streamlines(mesh, scene, **whole), False),
        (step.run(), True),
    ):
        beside = []
        for line in lines.cell:
            y = np.asarray(line.points)[:, 1]
            near = np.median(np.minimum(y, grid.bounds[3] - y))
            beside.append(near < 0.29 * step.keywords["spacing"])
        assert any(beside) != is_inner


@pytest.mark.slow
def test_a_picture_in_doubt_is_read_back_and_not_chosen_where_it_cannot_be_read():
    look = vizlight.look(sheet(1.2, 300))
    assert look.drawing.words == "length of wind in colours"
    assert look.notes[0].startswith("not chosen: direction of wind; its direction cannot be read: ")
    assert "for its course to be seen" in look.notes[1]
    assert "direction" not in look.figures().unreadable


def test_hues_are_asked_for_after_strokes(monkeypatch):
    monkeypatch.setattr(fields, "CLEAR", 1e9)
    monkeypatch.setattr(fields, "SPACING", 1 / 8)
    kind = type(vizlight.look(pv.Sphere()))
    read = []

    def figures(look):
        read.append(look.drawing.words)
        is_first = len(read) == 1
        reason = {"direction": "it is too fine", "value": "too"} if is_first else {"value": "too"}
        return SimpleNamespace(unreadable=reason)

    monkeypatch.setattr(kind, "figures", figures)
    look = vizlight.look(sheet(0.05))
    assert read == ["length of wind in colours, with strokes along it", "direction of wind"]
    assert look.drawing.words == "direction of wind"
    assert look.notes[0].endswith("its direction cannot be read: it is too fine")


def test_without_a_library_that_draws_the_data_decide(monkeypatch):
    def no_picture(look):
        raise BackendError("no library")

    monkeypatch.setattr(fields, "CLEAR", 1e9)
    monkeypatch.setattr(fields, "SPACING", 1 / 8)
    monkeypatch.setattr(type(vizlight.look(pv.Sphere())), "figures", no_picture)
    assert "with strokes" in vizlight.look(sheet(0.05)).drawing.words


def test_streamlines_of_a_flat_map_have_its_frame_and_no_box():
    grid = pv.ImageData(dimensions=(41, 31, 1), origin=(0, 50, 0), spacing=(0.5, 0.5, 1))
    grid["wind"] = np.tile([10.0, 10.0, 0.0], (grid.n_points, 1))
    grid = vizlight.cartography.in_degrees(grid)
    look = vizlight.look(grid, "flow", tangents="wind")
    assert any(layer.mesh.path == "vizlight.cartography.frame" for layer in look.drawing.layers)
    assert not any(layer.mesh.path == "render.box_edges" for layer in look.drawing.layers)
    lines = look.drawing.layers[0].mesh.run()
    assert str(lines.field_data["unit"][0]) == "metre"
    assert "projection" in lines.field_data


@pytest.mark.parametrize(
    ("name", "unit", "word"),
    [("UWND,VWND", "", "speed"), ("uvw", "", "speed"), ("B", "M/S", "speed"), ("B", "T", "length")],
)
def test_lengths_of_vectors_are_speeds_by_their_name_or_unit(name, unit, word):
    grid = pv.ImageData(dimensions=(2, 2, 1))
    names = name.split(",")
    for part in names:
        grid[part] = np.zeros((4, 3)) if len(names) == 1 else np.zeros(4)
    said = meaning.Meaning()
    for part in names:
        said.add_array(part, {"units": unit})
    meaning.attach(grid, said)
    assert drawing.titled_length(grid, name).startswith(f"{word} of ")


def test_the_title_of_a_speed_is_what_the_names_of_components_have_in_common():
    grid, said = pv.ImageData(dimensions=(2, 2, 1)), meaning.Meaning()
    for letter in "uv":
        grid[letter] = np.zeros(4)
        said.add_array(letter, {"units": "m/s", "long_name": f"{letter}-momentum component"})
    meaning.attach(grid, said)
    assert drawing.titled_length(grid, "u,v") == "speed of u,v (m/s)"
    grid["wind"] = np.zeros((4, 3))
    said.add_array("wind", {"units": "m/s", "long_name": "wind-velocity"})
    meaning.attach(grid, said)
    assert drawing.titled_length(grid, "wind") == "wind speed (m/s)"
    grid["w"] = np.zeros((4, 3))
    said.add_array("w", {"units": "cm/s", "long_name": "Velocity"})
    meaning.attach(grid, said)
    assert drawing.titled_length(grid, "w") == "speed (cm/s)"
    grid["vectors"] = np.zeros((4, 3))
    assert drawing.titled_length(grid, "vectors") == "speed"
    # Names of components without words of a file tell it themselves.
    assert drawing.titled_length(grid, "X Velocity,Y Velocity,Z Velocity") == "speed"
    assert drawing.titled_length(grid, "flux_x,flux_y") == "length of flux"


@pytest.mark.usefixtures("few_strokes")
def test_flow_on_a_surface_is_its_evenly_spaced_strokes():
    grid = sheet(0.05, 16)
    look = vizlight.look(grid, "flow", size=(240, 160))
    ground, strokes = look.drawing.layers
    assert ground.keywords["scalars"] == "wind"
    assert strokes.mesh.keywords["confined"] is True
    # What is written is lines with their light.
    assert look.mesh.n_lines == strokes.mesh.run().n_lines
    assert np.ptp(look.mesh["luminance"]) > 0
    assert len(vizlight.look(grid, "flow", spacing=3.0).drawing.layers) > 2


def test_walls_toward_the_eye_are_left_out_whatever_the_order_of_corners():
    volume = pv.ImageData(dimensions=(7, 7, 7)).cast_to_unstructured_grid()
    volume["wind"] = np.column_stack([1 + volume.points[:, 1], *np.zeros((2, volume.n_points))])
    cells = volume.cells.reshape(-1, 9)
    turned = cells[:, [0, 5, 6, 7, 8, 1, 2, 3, 4]]
    some = np.where(volume.cell_centers().points[:, :1] < 2, turned, cells)
    mesh = pv.UnstructuredGrid(some, volume.celltypes, volume.points)
    mesh["wind"] = volume["wind"]
    layers = vizlight.look(mesh, "flow", seeds=20).drawing.layers
    (walls,) = (layer for layer in layers if layer.keywords.get("culling") == "front")
    hull = walls.mesh.run()
    outward = hull.cell_centers().points - volume.center
    assert np.all(np.einsum("ij,ij->i", outward, hull.face_normals) > 0)


@pytest.mark.parametrize(
    ("heat", "is_colored"), [("height", True), ("constant", False), ("none", False)]
)
def test_what_stands_in_a_flow_has_the_colours_of_its_lines_where_they_differ(heat, is_colored):
    grid = pv.ImageData(dimensions=(16, 16, 16)).cast_to_unstructured_grid()
    inside = np.all(np.abs(grid.cell_centers().points - (8, 8, 0)) < (3, 3, 8), axis=1)
    volume = grid.extract_cells(~inside)
    volume.clear_data()
    x, y, z = np.asarray(volume.points).T
    volume["wind"] = np.column_stack([1 + y, 0 * y, 0 * y])
    if heat != "none":
        volume["temperature"] = 300 + (z if heat == "height" else np.where(x < 2, 1.0, 5.0))
    layers = vizlight.look(volume, "flow", seeds=20).drawing.layers
    lines, hull = layers[0], next(layer for layer in layers if layer.mesh.name == "hull")
    assert ("scalars" in hull.keywords) is is_colored
    if is_colored:
        assert hull.keywords["clim"] == lines.keywords["clim"]
        assert hull.keywords["cmap"] == lines.keywords["cmap"]
        warm = hull.mesh.run()
        warm = warm.extract_points(warm.points[:, 2] > 0, adjacent_cells=False, include_cells=False)
        on_block = np.all(np.abs(warm.points - (8, 8, 0)) < (3.1, 3.1, 8.1), axis=1)
        assert np.array_equal(np.isfinite(warm["temperature"]), on_block)


def test_streamlines_have_the_colours_of_the_temperature_that_they_carry():
    volume = pv.ImageData(dimensions=(9, 9, 9))
    x, y, _ = np.asarray(volume.points).T
    volume["wind"] = np.column_stack([1 + y, *np.zeros((2, len(y)))])
    volume["Temp"] = 300 + 9.7 * x
    look = vizlight.look(volume, "flow", seeds=20)
    assert look.summary.startswith("streamlines of wind in the colours of Temp")
    assert look.drawing.layers[0].keywords["scalars"] == "Temp"
    assert look.key[0]["title"] == "temperature; arrows point downstream"
    # Who asks for colours of another array has them on the same lines, and on a section.
    volume["p"] = np.asarray(volume.points) @ (1, 0.1, 0.01)
    for part in ({}, {"slice": "z:4"}):
        look = vizlight.look(volume, scalars="p", **part)
        assert look.drawing.layers[0].keywords["scalars"] == "p"
        assert look.drawing.keys[0]["title"].startswith("p; arrows")
    speed_drawing = vizlight.look(volume, "flow", array="wind", seeds=20).drawing
    assert speed_drawing.layers[0].keywords["scalars"] == "speed"


@pytest.mark.usefixtures("few_strokes")
def test_strokes_of_a_slab_lie_in_its_middle_and_not_on_its_sides():
    slab = pv.ImageData(dimensions=(31, 21, 2), spacing=(1, 1, 3)).cast_to_unstructured_grid()
    x, y, _ = slab.points.T
    slab["U"] = np.column_stack([10 - y, x - 15, 0 * x])
    look = vizlight.look(slab)
    assert "with strokes" in look.drawing.words
    drawn = {layer.mesh.name: layer.mesh.run() for layer in look.drawing.layers}
    for name in ("plane", "strokes"):
        assert drawn[name].bounds[4:] == pytest.approx((1.5, 1.5))


@pytest.mark.parametrize("name", ["displacement", "Mode 1"])
@pytest.mark.parametrize("shape", [pv.Plane, pv.Sphere])
def test_what_moves_a_surface_is_no_flow_and_has_no_strokes(name, shape):
    mesh = shape()
    mesh[name] = mesh.points * [1.0, 2.0, 3.0] + 0.5
    look = vizlight.look(mesh, size=(240, 160))
    assert (look.array, look.question) == (name, "value")
    assert not any("width" in layer.keywords for layer in look.drawing.layers)
    # Values are shown before it, as on a solid, and it can be asked for.
    mesh["T"] = mesh.points[:, 0] ** 2
    assert vizlight.look(mesh, size=(240, 160)).array == "T"
    again = vizlight.look(mesh, array=name, size=(240, 160))
    assert (again.array, again.question) == (name, "value")
    mesh["velocity"] = mesh.point_data.pop(name)
    assert vizlight.look(mesh, size=(240, 160)).question == "direction"


def test_displacements_have_a_linear_bar_and_a_word_for_their_length():
    bar = pv.ImageData(dimensions=(30, 5, 5)).cast_to_unstructured_grid()
    # A beam that bends near its end alone.
    bar["zdsp"] = 1e-7 * (bar.points[:, 0] / 29) ** 12
    bar["xdsp"], bar["ydsp"] = bar["zdsp"] / 9, 0 * bar["zdsp"]
    (key,) = vizlight.look(bar, array="xdsp,ydsp,zdsp").key
    assert key["title"] == "displacement"
    assert "log_scale" not in getattr(key["cmap"], "keywords", {})
    named = bar.copy()
    for old, new in zip(("xdsp", "ydsp", "zdsp"), "uvw", strict=True):
        named.rename_array(old, new)
    (key,) = vizlight.look(named, array="u,v,w").key
    assert key["cmap"].log_scale


def test_no_stroke_is_between_vectors_and_missing_ones():
    grid = pv.ImageData(dimensions=(41, 31, 1))
    x, y, _ = grid.points.T
    wind = np.column_stack([1 + 0.02 * y, 0.02 * (x - 20), 0 * x])
    is_land = (x > 12) & (x < 28) & (y > 10) & (y < 20) & (x != 20)
    wind[is_land] = np.nan
    grid["wind"] = wind
    layers = vizlight.look(grid).drawing.layers
    (strokes,) = (layer.mesh.run() for layer in layers if layer.mesh.path == "vizlight.streamlines")
    surface = grid.extract_surface(algorithm="dataset_surface").triangulate()
    cells = surface.find_containing_cell(strokes.points)
    inside = np.isnan(surface["wind"][surface.regular_faces[cells]]).any(axis=(1, 2))
    # A place on the edge of two triangles may be found in either.
    assert inside.mean() < 0.02
