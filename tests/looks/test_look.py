"""``vizlight.look``: what is shown of which data, files, scripts, and bad input."""

import contextlib
import json
import re

import numpy as np
import pytest
import pyvista as pv
from PIL import Image
from refusals import refusals

import vizlight
from vizlight import files
from vizlight.files import FileError
from vizlight.looks import levels
from vizlight.looks.recipes.drawing import titled
from vizlight.looks.rules import RULES
from vizlight.mesh import meaning
from vizlight.reading import series
from vizlight.scene.presets import preset_of

SIZE = (120, 80)


def sheet(**arrays):
    """Return a flat grid with point arrays of x and y."""
    grid = pv.ImageData(dimensions=(24, 18, 1))
    x, y, _ = grid.points.T
    for name, values in arrays.items():
        grid[name] = values(x, y)
    return grid


def volume(**arrays):
    grid = pv.ImageData(dimensions=(14, 13, 12), origin=(-6.5, -6, -5.5))
    x, y, z = grid.points.T
    for name, values in arrays.items():
        grid[name] = values(x, y, z)
    return grid


def chart(**arrays):
    """Return a map of Europe in degrees."""
    grid = sheet(**arrays)
    grid.spacing, grid.origin = (2.5, 2.0, 1.0), (-15.0, 33.0, 0.0)
    grid.field_data["unit"] = ["degree"]
    return grid


def turning(x, y, z):
    return np.stack([-y, x, 0.3 * z + 1], axis=1)


def edge(x, y, z):
    return np.tanh(x * x + y * y + z * z - 16)


def ball(**arrays):
    made = pv.Sphere(theta_resolution=24, phi_resolution=24)
    for name, values in arrays.items():
        made[name] = values(*made.points.T)
    return made


def planet(**arrays):
    """Return a ball of radius 1 that names a system of longitudes and latitudes."""
    made = ball(**arrays).scale(2.0)
    made.field_data["gvCRS"] = ["EPSG:4326"]
    return made


#: Data of each kind, and the question, what is shown and the array of their look.
KINDS = {
    "values": (sheet(warmth=lambda x, y: x + y * y), "none", "sheet", "warmth"),
    "heights": (sheet(elevation=lambda x, y: 3 * np.sin(x / 3)), "relief", "sheet", "elevation"),
    "map": (chart(warmth=lambda x, y: x + y * y), "none", "sheet", "warmth"),
    "classes": (sheet(land=lambda x, _: (x > 9).astype(int)), "none", "sheet", "land"),
    "components": (
        sheet(u=lambda x, y: 1 + 0 * x, v=lambda x, y: np.sin(x)), "direction", "sheet", "u,v",
    ),
    "surface with vectors": (
        ball(V=lambda x, y, z: np.stack([-y - 0.1, x, 0 * z + 0.2], 1)), "direction", "surface",
        "V",
    ),
    "surface with values": (ball(p=lambda x, y, z: x), "value", "surface", "p"),
    "planet": (planet(p=lambda x, y, z: x), "none", "globe", "p"),
    "surface": (pv.Sphere(), "shape", "surface", None),
    "flow": (volume(V=turning, T=edge), "heading", "streamlines", "V"),
    "scan": (volume(T=edge), "shape", "isosurface", "T"),
    "even ramp": (volume(T=lambda x, y, z: x), "shape", "slices", "T"),
    "materials": (
        volume(mat=lambda x, y, z: np.digitize(x, (-2, 3)).astype(np.int32)), "value", "hull",
        "mat",
    ),
    "lines": (
        pv.Spline(np.random.default_rng(1).normal(size=(9, 3)), 60), "heading", "lines", None,
    ),
    "cloud": (
        pv.PolyData(np.random.default_rng(2).normal(size=(90, 3))), "shape", "points", None,
    ),
}  # fmt: skip


@pytest.mark.usefixtures("few_strokes")
@pytest.mark.parametrize("kind", KINDS)
def test_the_data_choose(kind):
    mesh, question, shown, array = KINDS[kind]
    names = list(mesh.array_names)
    look = vizlight.look(mesh, size=SIZE)
    assert (look.question, look.shown, look.array) == (question, shown, array)
    assert look.reason
    assert mesh.array_names == names
    assert str(look).count("\n") == 2 + len(look.notes)
    assert all(other.array != look.array for other in look.others if other.question != "shape")


def test_hues_that_tell_normals_are_for_those_who_ask_for_them():
    look, asked = (vizlight.look(pv.Sphere(), what, size=SIZE) for what in ("auto", "shape"))
    assert [other.shell for other in look.others] == ["--for shape"]
    assert not asked.others
    assert [preset_of(each.scene) for each in (look, asked)] == [None, "shape"]
    # Nobody needs to be told how things look in a room: its title has the sizes alone.
    assert [key.get("scene") is None for key in look.drawing.keys] == [True]
    assert [key.get("scene") is None for key in asked.drawing.keys] == [False]
    assert look.wishes.room[0] < look.drawing.camera.keywords["aspect"] * look.wishes.room[1]
    lit, view = vizlight.illuminate(pv.Sphere(), look.scene), look.scene.view
    across = lit["Normals"] @ np.cross(view.up, view.direction)
    left, right = (lit["rgb"][place(across)] for place in (np.argmin, np.argmax))
    assert lit.points[np.argmax(lit["rgb"].sum(axis=1)), 2] > 0.3
    # Grey, so that no colour looks like data, and light from one side.
    assert np.ptp(lit["rgb"], axis=1).max() < 0.06
    assert left.mean() > 1.2 * right.mean()
    assert asked.figures().shape.median < 5 < look.figures().shape.median < 30


def globe(**options):
    """Return the look of a globe with one array, and what it is of."""
    grid = pv.ImageData(dimensions=(25, 13, 1), spacing=(15, 15, 1), origin=(-180, -90, 0))
    x, y, _ = np.radians(np.asarray(grid.points, dtype=float)).T
    grid["warmth"] = np.sin(y) + np.cos(x)
    return grid, vizlight.look(grid, size=SIZE, globe=True, **options)


def test_a_globe_is_a_closed_ball_with_coasts_and_a_part_of_the_earth_is_none():
    _, look = globe()
    assert (look.question, look.shown, look.array) == ("none", "globe", "warmth")
    layers = [layer.mesh.path for layer in look.drawing.layers]
    assert layers[1:] == [".scale", ".scale", "pyvista.Icosphere"]
    assert look.mesh.n_open_edges == 0
    for mesh in (chart(warmth=lambda x, y: x), sheet(warmth=lambda x, y: x)):
        with pytest.raises(ValueError, match="globe: expected a map of the whole earth"):
            vizlight.look(mesh, globe=True)
    with pytest.raises(TypeError, match="globe: expected True or False"):
        vizlight.look(ball(), globe="yes")


def test_a_globe_with_heights_is_raised():
    _, look = globe(exaggeration=1e6)
    size = np.linalg.norm(np.asarray(look.mesh.points, dtype=float), axis=1)
    assert size == pytest.approx(1 + 1e6 * np.asarray(look.mesh["warmth"]) / 6_371_008.8, abs=1e-4)
    _, look = globe(warp="warmth")
    assert "heights are taken 200000 times; exaggeration=1 takes them as they are" in look.notes


@pytest.mark.parametrize("question", ["auto", "relief"])
def test_a_title_says_how_often_heights_are_taken(question):
    grid = pv.ImageData(dimensions=(12, 9, 1), spacing=(10, 10, 1))
    grid["elevation"] = np.add.outer(np.arange(9.0), np.arange(12.0) ** 2).ravel()
    raised = {"warp": "elevation"} if question == "auto" else {}
    for factor, words in ((2, "elevation; relief 2 times as high"), (1, "elevation")):
        look = vizlight.look(grid, question, exaggeration=factor, size=SIZE, **raised)
        assert look.drawing.keys[0]["title"] == words


@pytest.mark.slow
@pytest.mark.opengl
def test_the_script_of_a_globe_draws_the_same(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh, look = globe()
    look.save("one.png")
    exec(look.script("two.png"), {"mesh": mesh})
    one, two = (np.asarray(Image.open(f"{name}.png")).astype(int) for name in ("one", "two"))
    assert np.abs(one - two).max() <= 2
    assert look.save("page.html").stat().st_size > 10_000


@pytest.mark.slow
@pytest.mark.sampled(4)
@pytest.mark.opengl
@pytest.mark.parametrize("kind", KINDS)
def test_a_look_saves_itself_and_its_script_draws_the_same(kind, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mesh = KINDS[kind][0]
    look = vizlight.look(mesh, size=SIZE)
    look.save("one.png")
    exec(look.script("two.png"), {"mesh": mesh})
    files = (Image.open(tmp_path / f"{name}.png").convert("RGB") for name in ("one", "two"))
    one, two = (np.asarray(file).astype(int) for file in files)
    assert one.shape == (SIZE[1], SIZE[0], 3)
    assert len(np.unique(one.reshape(-1, 3), axis=0)) > 8
    assert np.abs(one - two).max() <= 2


@pytest.mark.opengl
def test_a_look_is_a_page_a_mesh_and_a_movie(tmp_path):
    look = vizlight.look(ball(p=lambda x, y, z: x), size=(60, 40))
    page = look.save(tmp_path / "a.html").read_text("utf-8")
    assert page.rstrip().endswith("</html>")
    lit = pv.read(look.save(tmp_path / "a.vtp"))
    assert {"p", "luminance"} <= set(lit.point_data)
    with pytest.warns(UserWarning, match="the headlight as from the scene's view"):
        assert look.save(tmp_path / "a.glb").stat().st_size > 1000
    pytest.importorskip("imageio")
    with Image.open(look.save(tmp_path / "a.gif")) as movie:
        # A turn of 120 frames, of which neighbours may be equal in so small a picture.
        assert movie.n_frames > 100
    html = look._repr_html_()
    assert html.startswith('<img alt="p in colours')


@pytest.mark.opengl
def test_a_movie_of_a_turn_cuts_nothing_off_and_has_the_frames_of_its_options(tmp_path):
    pytest.importorskip("imageio")
    rod = pv.Cube(x_length=8.0).triangulate()
    look = vizlight.look(rod, size=(360, 240), frames=6, fps=5.0)
    with Image.open(look.save(tmp_path / "a.gif")) as movie:
        assert movie.n_frames == 6
        assert movie.info["duration"] == 200
        for i in range(6):
            movie.seek(i)
            ink = np.asarray(movie.convert("L")) < 240
            assert not ink[[0, -1]].any()
            assert not ink[:, [0, -1]].any()
    assert re.search(r"frames=6,\s+fps=5\.0", look.script(tmp_path / "a.gif"))
    with pytest.raises(ValueError, match="frames: expected"):
        vizlight.look(rod, frames=0)


@pytest.mark.opengl
@pytest.mark.parametrize("title", [None, "A rod"])
def test_a_part_seen_from_above_fills_the_picture_and_no_more(title):
    rod = pv.Cube(x_length=4.0, y_length=2.0)
    more = {} if title is None else {"title": title}
    look = vizlight.look(rod, view="top", parallel=True, size=(300, 200), **more)
    with contextlib.closing(look.plotter()) as plotter:
        picture = plotter.screenshot(return_img=True)
    columns = np.flatnonzero((picture[100] < 250).any(axis=1))
    assert 3 < columns[0] < 15
    assert 285 < columns[-1] < 297


@pytest.mark.parametrize(
    ("name", "toward"),
    [("front", (0, -1, 0)), ("back", (0, 1, 0)), ("left", (-1, 0, 0)), ("right", (1, 0, 0)),
     ("side", (1, 0, 0)), ("top", (0, 0, 1)), ("bottom", (0, 0, -1))],
)  # fmt: skip
def test_sides_of_a_part_have_names(name, toward):
    camera = vizlight.look(pv.Cube(), view=name).view
    way = np.subtract(camera.position, camera.focal_point)
    np.testing.assert_allclose(way / np.linalg.norm(way), toward, atol=1e-9)


def test_an_unknown_view_is_refused_before_anything_is_read():
    with pytest.raises(ValueError, match="view: expected .*'front', 'back', 'left'.*got 'upside'"):
        vizlight.look("no-such-file.stl", view="upside")


def test_a_title_replaces_the_words_above_a_picture_but_not_the_unit(tmp_path):
    look = vizlight.look(ball(p=lambda x, y, z: x), title="Pressure")
    assert look.key[0]["title"] == "Pressure"
    assert "Pressure" in look.save(tmp_path / "a.html").read_text("utf-8")
    assert vizlight.look(pv.Cube()).key[0]["title"] == "size 1 × 1 × 1"
    assert vizlight.look(pv.Cube(), title="A cube").key[0]["title"] == "A cube"
    assert not vizlight.look(pv.Cube(), title="").key
    mesh = ball(p=lambda x, y, z: x)
    meaning.attach(mesh, meaning.Meaning(arrays={"p": {"units": "Pa"}}))
    assert vizlight.look(mesh, title="Pressure").key[0]["title"] == "Pressure (Pa)"
    assert vizlight.look(mesh, title="Pressure (bar)").key[0]["title"] == "Pressure (bar)"


@pytest.mark.slow
@pytest.mark.opengl
def test_strokes_of_a_movie_move_and_the_key_says_how_much_time_it_shows(tmp_path):
    pytest.importorskip("imageio")
    sheet = pv.Plane(i_resolution=20, j_resolution=20)
    sheet["V"] = np.column_stack([1 + sheet.points[:, 1], 0 * sheet.points[:, :2]])
    look = vizlight.look(sheet, size=(120, 80))
    script = look.script(tmp_path / "a.gif")
    assert "travel=3.0" in script
    assert "movie.travel(" in script
    assert re.search(r'title="speed of V; strokes move with it, 0\.\d+ of its time in all"', script)
    assert "travel" not in look.script(tmp_path / "a.png")
    with Image.open(look.save(tmp_path / "a.gif")) as movie:
        assert movie.n_frames > 60


def test_options_win_over_the_rule():
    mesh = volume(V=turning, T=edge)
    assert vizlight.look(mesh, array="T", size=SIZE).shown == "isosurface"
    assert vizlight.look(mesh, "shape", size=SIZE).question == "shape"
    assert vizlight.look(mesh, "flow", seeds=9, size=SIZE).shown == "streamlines"
    # Without a level the isosurface is where the values are steepest, which a note tells.
    steepest, _ = levels.best_level(mesh, "T")
    without_level = vizlight.look(volume(T=edge), contour="T", size=SIZE)
    np.testing.assert_allclose(without_level.mesh["T"], steepest, rtol=1e-5)
    note = f"the level of T is {levels.number(steepest)}, where it is steepest"
    assert note in without_level.notes
    look = vizlight.look(mesh, array="T", view="x", size=SIZE, scene="shape")
    toward = np.subtract(look.view.position, look.view.focal_point)
    np.testing.assert_allclose(toward / np.linalg.norm(toward), (1, 0, 0), atol=1e-9)
    assert look.scene.lights == vizlight.presets.shape().lights
    asked = {"slice": "z:3", "array": "T", "size": SIZE}
    bar, none = (vizlight.look(mesh, **asked, key=key).key for key in (True, False))
    assert [(key["question"], key["title"]) for key in bar] == [
        ("value", "T; z = 3, x to the right, y up")
    ]
    assert none == ()


test_bad_input = refusals(
    lambda mesh, options, question="auto": vizlight.look(mesh, question, **options),
    (pv.PolyData(), {}, "data: expected a mesh with points"),
    (pv.PolyData([[0.0, 0, 1e150]]), {}, r"data: expected points within 1e\+100"),
    (3, {}, "data: expected a PyVista mesh", TypeError),
    (np.zeros((4, 3)), {}, r"; take pyvista.PolyData\(rows of x, y, z\) of points", TypeError),
    ("none.vtp", {}, "no such file", FileError),
    (ball(p=lambda x, y, z: x), {"array": "q"}, "array: expected the name of an"),
    (ball(p=lambda x, y, z: x), {}, "direction", "vectors for 'directi"),
    (ball(p=lambda x, y, z: x), {}, "flow", "question: expected vectors"),
    (ball(), {"slice": "z:99"}, "the mesh has .*z from -0.5 to 0.5"),
    (ball(), {}, "beauty", "question: expected a question"),
    (ball(), {"stile": "dark"}, "an option of look, got a name that", TypeError),
    (ball(), {"style": "neon"}, "style: expected"),
    (ball(), {"size": (0, 5)}, "size: expected"),
    (ball(), {"scene": "glow"}, "scene: expected"),
)


def test_every_rule_can_be_reached():
    shown = {(look[1], look[2]) for look in KINDS.values()}
    shown |= {("shape", "isosurface"), ("value", "molecule"), ("value", "backbone")}
    for rule in RULES:
        assert any(rule.shown == what for _, what in shown) or rule.shown == "hull"


def test_a_surface_without_data_has_the_name_of_its_file_and_its_sizes_as_its_title(tmp_path):
    pv.Cone().save(tmp_path / "bracket.v2.stl")
    script = vizlight.look(tmp_path / "bracket.v2.stl", size=SIZE).script()
    assert 'title="bracket; size 1 ×' in script
    # Without a name it has its sizes alone.
    assert 'title="size 2 × 4 × 6"' in vizlight.look(pv.Box((0, 2, 0, 4, 0, 6)), size=SIZE).script()
    assert 'title="surface"' in vizlight.look(pv.Sphere(), "shape", size=SIZE).script()


def test_a_molecule_has_balls_for_its_atoms_and_sticks_between_them(tmp_path):
    path = tmp_path / "water.xyz"
    path.write_text("3\n\nO 0 0 0\nH 0.76 0.59 0\nH -0.76 0.59 0\n")
    look = vizlight.look(path, size=SIZE)
    assert (look.shown, look.array) == ("molecule", "atom_type")
    hydrogen = look.mesh.extract_cells(look.mesh.cell_data["atom_type"] == 1).points
    far = np.linalg.norm(hydrogen[hydrogen[:, 0] > 0] - (0.76, 0.59, 0), axis=1)
    # A fifth of the radius of van der Waals, 1.2 angstroms.
    # Few balls are so fine that no corners are seen.
    assert np.isclose(far, 0.24, atol=1e-5).sum() > 2000
    # Each half of a stick has the colour of its own atom.
    assert far.max() < 0.5
    assert look.drawing.keys[0]["title"] == "water"
    assert vizlight.look(vizlight.read(path), size=SIZE).drawing.keys[0]["title"] == "element"
    assert vizlight.look(path, size=SIZE, array="radius").array == "radius"


def test_a_molecule_of_long_chains_shows_its_backbone(tmp_path):
    turn = np.linspace(0, 40, 61)
    places = np.column_stack([3 * np.cos(turn), 3 * np.sin(turn), turn])
    chain = pv.PolyData(np.concatenate([places, places + np.array([9, 0, 0])]))
    chain["atom_type"], chain["radius"] = np.full(122, 6), np.full(122, 1.7)
    chain["chain"] = np.repeat([0, 1], 61)
    chain["backbone_mask"] = np.ones(122, np.uint8)
    look = vizlight.look(chain, size=SIZE, array="chain")
    assert (look.shown, look.mesh.n_lines) == ("backbone", 0)
    assert look.mesh.bounds_size[0] == pytest.approx(9 + 6 + 0.8, abs=0.3)
    assert "files.backbone(" in look.script()
    chain["residue"] = np.tile(np.arange(4, 65), 2)
    chain.save(tmp_path / "fold.vtp")
    look = vizlight.look(tmp_path / "fold.vtp", size=SIZE, array="residue")
    key = look.drawing.keys[0]
    # One chain is seen from one side, though its values differ on both.
    assert look.drawing.layers[0].mesh.path == "files.backbone"
    # The bar ends at the first and the last residue, and has numbers there.
    assert (key["title"], key["clim"]) == ("fold, residue", (4, 64))
    assert key["levels"] == [4, 10, 20, 30, 40, 50, 60, 64]


def test_many_atoms_without_bonds_are_balls_with_light(tmp_path):
    x, y, z = (9.0 * axis.ravel() for axis in np.mgrid[:11, :11, :11])
    lines = [f"Ar {a} {b} {c}" for a, b, c in zip(x, y, z, strict=True)]
    path = tmp_path / "gas.xyz"
    path.write_text("\n".join([str(len(lines)), "", *lines]) + "\n")
    look = vizlight.look(path, size=SIZE)
    assert (look.shown, look.array) == ("molecule", "atom_type")
    # Half of the radius of argon, 1.88 angstroms.
    np.testing.assert_allclose(np.reshape(look.mesh.bounds, (3, 2))[:, 0], -0.94, atol=0.06)
    assert look.drawing.layers[0].keywords.get("lighting") is not False


def test_ligands_are_balls_and_sticks_beside_the_chains(tmp_path):
    row = "{:6}{:5d} {:4} {:3} A{:4d}    {:8.3f}{:8.3f}{:8.3f}  1.00  0.00          {:>2}  "
    rows = [
        row.format("ATOM", i, " CA", "GLY", i, 3 * np.cos(i), 3 * np.sin(i), 1.2 * i, "C")
        for i in range(1, 71)
    ]
    rows += [
        row.format("HETATM", 80 + i, " O1", name, 80 + i, 40.0 + 20 * i, 0, 0, "O")
        for i, name in enumerate(["LIG", "HOH"])
    ]
    path = tmp_path / "one.pdb"
    path.write_text("\n".join(rows) + "\n")
    look = vizlight.look(path, size=SIZE)
    assert look.shown == "backbone"
    chains, ligands = (layer.mesh.run() for layer in look.drawing.layers[:2])
    assert chains.bounds[1] < 10
    # The ball of the ligand, without water, is in the picture.
    np.testing.assert_allclose(ligands.center, (40, 0, 0), atol=0.01)
    assert look.view.focal_point[0] > 15
    assert look.notes == ("beside the chains: LIG (1 atom)", "left out: HOH (1 atom)")
    assert [key["title"] for key in look.key] == ["one, residue", ""]
    assert "files.ligands(" in look.script()


def test_a_part_with_most_points_on_its_surface_shows_values_there():
    beam = pv.examples.load_hexbeam()
    beam.clear_data()
    z = np.asarray(beam.points)[:, 2]
    beam["displacement"] = np.c_[z**2, 0 * z, 0 * z]
    look = vizlight.look(beam, size=SIZE)
    assert (look.shown, look.array, look.question) == ("hull", "displacement", "value")
    beam["stress"] = z
    look = vizlight.look(beam, size=SIZE)
    assert (look.shown, look.array) == ("hull", "stress")
    # What flows is drawn as streamlines.
    beam["velocity"] = beam["displacement"] + 1.0
    del beam.point_data["displacement"]
    assert vizlight.look(beam, size=SIZE).shown == "streamlines"


def test_smooth_values_on_a_solid_have_isolines_at_the_numbers_of_their_bar():
    solid = pv.ImageData(dimensions=(9, 9, 3), spacing=(1, 1, 2)).cast_to_unstructured_grid()
    x, y, _ = np.asarray(solid.points).T
    solid["T"] = 100 * (x + 0.3 * y)
    look = vizlight.look(solid)
    *_, isolines = look.drawing.layers
    np.testing.assert_allclose(np.unique(isolines.mesh.run()["T"].round(6)), range(200, 1001, 200))
    assert look.key[0]["title"].endswith("; lines every 200")
    noisy = pv.ImageData(dimensions=(40, 40, 3), spacing=(1, 1, 10)).cast_to_unstructured_grid()
    noisy["T"] = np.random.default_rng(0).random(noisy.n_points)
    assert "lines" not in vizlight.look(noisy).key[0]["title"]


def test_a_plane_without_data_is_grey_with_its_edges(tmp_path):
    plane = pv.Plane(i_resolution=2, j_resolution=2)
    plane.clear_data()
    look = vizlight.look(plane, size=SIZE)
    assert (look.question, look.shown, look.drawing.keys) == ("none", "sheet", ())
    pixels = np.asarray(Image.open(look.save(tmp_path / "a.png")).convert("L"))
    assert 120 < np.median(pixels[30:50, 50:70]) < 200


def test_the_title_of_a_plane_is_its_only_value():
    plane = pv.Plane(i_size=4, i_resolution=2, j_resolution=2)
    plane.clear_data()
    plane["T"] = np.full(plane.n_cells, 285.0)
    meaning.attach(plane, meaning.Meaning(arrays={"T": {"long_name": "warmth", "units": "K"}}))
    look = vizlight.look(plane)
    assert look.shown == "sheet"
    assert [key["title"] for key in look.key] == ["warmth = 285 K"]
    # A title alone leaves the room of a key beside the data, and takes none below them.
    assert look.drawing.camera.keywords["aspect"] <= 1200 / 748


def test_labels_of_an_image_have_the_smooth_surface_of_what_has_a_label(tmp_path):
    image = pv.ImageData(dimensions=(30, 30, 30))
    x, y, z = image.points.T - 14.5
    inside = x**2 + y**2 + z**2 < 100
    image["atlas"] = np.where(inside, 5 + (x > 0) * 4 + (y > 0) * 20, 0).astype(np.int16)
    look = vizlight.look(image, size=SIZE)
    assert look.shown == "hull"
    # The box of the image has no creases in the picture.
    (drawn,) = look.drawing.layers
    mesh = drawn.mesh.run()
    assert {*np.unique(mesh.cell_data["atlas"])} == {5, 9, 25, 29}
    radius = np.linalg.norm(np.asarray(mesh.points) - 14.5, axis=1)
    assert np.ptp(radius) < 1.5
    image["atlas"] = np.where(inside, np.arange(27000) // 37 * 3, 0).astype(np.int16)
    look = vizlight.look(image, array="atlas", size=SIZE)
    # Of more kinds than colours there is the title alone.
    (key,) = look.drawing.keys
    assert key["title"].startswith("atlas; ")
    assert key["title"].endswith(" kinds")
    assert [*key["cmap"].run().annotations.values()] == [" "]
    assert any("colours repeat, and have no key" in note for note in look.notes)


def test_of_many_kinds_small_ones_are_grey_where_a_few_fill_nearly_all():
    sheet = pv.ImageData(dimensions=(101, 11, 1))
    labels = np.minimum(np.arange(1000) // 60, 15) + 10
    labels[[0, 1]] = 3, 40
    sheet.cell_data["label"] = labels
    look = vizlight.look(sheet, size=(120, 80))
    assert "label has 18 kinds: the 2 smallest are grey" in look.notes
    assert look.key[0]["title"] == "label; grey: 2 small ones"
    table = look.key[0]["cmap"]
    assert table.scalar_range == (9.5, 25.5)
    for value, is_grey in ((3, True), (40, True), (10, False), (25, False)):
        color = pv.Color(table.map_value(value))
        assert (color == pv.Color(vizlight.maps.MISSING)) == is_grey


def test_a_solid_whose_least_kind_is_0_is_drawn_whole():
    grid = pv.ImageData(dimensions=(5, 5, 5)).cast_to_unstructured_grid()
    grid["group"] = (np.asarray(grid.points)[:, 2] > 2).astype(np.int32)
    look = vizlight.look(grid, size=SIZE)
    assert look.drawing.layers[0].mesh.run().bounds == grid.bounds


def test_lines_show_their_values_and_few_are_wider_than_many():
    few = pv.Spline(np.array([(0, 0, 0), (1, 1, 0), (2, 0, 1.0)]), 60)
    many = pv.PolyData(
        np.random.default_rng(5).random((4000, 3)), lines=np.insert(np.arange(4000), 0, 4000)
    )
    widths = [
        vizlight.look(mesh, size=(600, 400)).drawing.layers[0].keywords["line_width"]
        for mesh in (few, many)
    ]
    assert widths[0] > 2 * widths[1]
    few["radius"] = np.linspace(1, 2, 60)
    look = vizlight.look(few, size=SIZE)
    assert (look.question, look.array) == ("value", "radius")
    assert vizlight.look(few, "heading", size=SIZE).question == "heading"
    few.clear_data()
    few["atom_type"] = np.arange(60) // 20 + 6
    assert vizlight.look(few, size=SIZE).array == "atom_type"


def test_points_without_cells_show_the_length_of_their_vectors(tmp_path):
    cloud = pv.UnstructuredGrid()
    cloud.points = np.random.default_rng(2).random((50, 3))
    cloud["Force"] = np.asarray(cloud.points) * 3
    look = vizlight.look(cloud, size=SIZE)
    assert (look.shown, look.array) == ("points", "Force")
    low, high = look.drawing.keys[0]["clim"]
    lengths = np.linalg.norm(cloud["Force"], axis=1)
    assert (low, high) == pytest.approx((lengths.min(), lengths.max()))
    pixels = np.asarray(Image.open(look.save(tmp_path / "a.png")).convert("RGB")).astype(int)
    assert np.mean(np.ptp(pixels[:, :90], axis=2) > 40) > 0.003


def test_one_label_is_a_shape_and_what_is_around_all_kinds_is_left_out():
    image = pv.ImageData(dimensions=(20, 20, 20))
    x, y, z = np.asarray(image.points).T - 9.5
    inside = x**2 + y**2 + z**2 < 36
    image["label"] = inside.astype(np.int16)
    look = vizlight.look(image, size=SIZE)
    assert look.summary.startswith("surface of label 1")
    # Alone, its number tells nothing.
    assert look.key[0]["title"].partition(";")[0] == "label"
    grid = image.cast_to_unstructured_grid()
    grid["material"] = np.where(inside, 3 + (z > 0), 2).astype(np.int32)
    del grid.point_data["label"]
    look = vizlight.look(grid, size=SIZE)
    assert {*np.unique(look.drawing.layers[0].mesh.run()["material"])} == {3, 4}
    assert any("material 2, which is around all else, is left out" in note for note in look.notes)


def test_a_row_of_points_is_a_line():
    row = pv.RectilinearGrid([0.0, 1, 2, 4], [0.0], [0.0])
    row["p"] = [1.0, 2.5, 4, 9]
    look = vizlight.look(row, size=SIZE)
    assert (look.shown, look.array) == ("lines", "p")
    look.plotter().close()


def test_components_in_two_files_are_one_vector(tmp_path):
    xr = pytest.importorskip("xarray")
    pytest.importorskip("netCDF4")
    lat, lon = np.linspace(40, 60, 9), np.linspace(0, 30, 11)
    paths = []
    for name, standard in (("a", "eastward_wind"), ("b", "northward_wind")):
        rows = np.add.outer(0.1 * lat, lon) + len(paths)
        values = xr.DataArray(rows, dims=("lat", "lon"), attrs={"standard_name": standard})
        places = {
            "lat": ("lat", lat, {"units": "degrees_north"}),
            "lon": ("lon", lon, {"units": "degrees_east"}),
        }
        paths.append(tmp_path / f"{name}.nc")
        xr.Dataset({name: values}, coords=places).to_netcdf(paths[-1])
    look = vizlight.look(paths, size=(300, 200))
    assert look.array == "a,b"
    assert "overlay=" in look.script()
    assert vizlight.look([paths[0], paths[0]], size=(300, 200)).array == "a"


def test_colours_of_a_thin_volume_from_above_are_those_of_its_highest_layer():
    slab = pv.ImageData(dimensions=(20, 12, 4), spacing=(1, 1, 0.02))
    slab["T"] = 20 + slab.points[:, 0] / 19 + 300 * (slab.points[:, 2] - 0.06)
    look = vizlight.look(slab)
    assert "the highest of 4 layers is shown, at 0.06 along z" in look.notes
    assert look.drawing.keys[0]["clim"] == (20, 21)
    # What is asked for is of the whole volume.
    assert vizlight.look(slab, "value").mesh.bounds.z_min == 0


def test_a_threshold_keeps_voxels_of_labels_and_cells_with_all_corners_in_the_range():
    image = pv.ImageData(dimensions=(9, 9, 9))
    labels = np.zeros((9, 9, 9), np.uint8)
    labels[1:8, 4, 4] = 255
    image["label"], image["x"] = labels.ravel(order="F"), image.points[:, 0] / 10
    bar = vizlight.look(image, threshold=[("label", 200, np.inf)]).mesh
    np.testing.assert_allclose(bar.bounds, (0.5, 7.5, 3.5, 4.5, 3.5, 4.5))
    for low, high in ((0.25, np.inf), (-np.inf, 0.45), (0.25, 0.45)):
        kept = vizlight.look(image, "shape", threshold=[("x", low, high)], view="iso").mesh
        assert kept.bounds[:2] == (3 if low > 0 else 0, 4 if high < 9 else 8)


def test_a_level_needs_the_array_that_it_is_one_of():
    with pytest.raises(ValueError, match="level: expected contour with it, of data that"):
        vizlight.look(pv.ImageData(dimensions=(3, 3, 3)), level=2)


def test_a_page_has_the_bar_of_its_values_and_is_seen_whole(tmp_path):
    grid = pv.ImageData(dimensions=(24, 12, 1))
    grid["kind"] = (np.arange(288) // 96).astype(np.int32)
    page = vizlight.look(grid, size=SIZE).save(tmp_path / "kinds.html").read_text("utf-8")
    content = json.loads(page.partition('id="scene">')[2].partition("</script>")[0])
    (bar,) = content["bars"]
    assert [words for _, words in bar["marks"]] == ["0", "1", "2"]
    np.testing.assert_allclose([at for at, _ in bar["marks"]], [1 / 6, 1 / 2, 5 / 6])
    # The colour of the second kind fills the middle third.
    ends = [float(color.partition(" ")[2].rstrip("%")) for color in bar["colors"][2:4]]
    np.testing.assert_allclose(ends, [100 / 3, 200 / 3], atol=0.1)
    # The long side of the grid fits in a square.
    assert content["camera"]["scale"] >= 23 / 2


@pytest.mark.parametrize(("name", "said"), [("zinc", True), ("elevation", False)])
def test_an_only_band_is_said_to_be_taken_for_heights(tmp_path, name, said):
    rasterio = pytest.importorskip("rasterio")
    rows = np.add.outer(np.arange(20.0), np.arange(30.0) ** 1.5)
    with rasterio.open(
        tmp_path / "a.tif", "w", driver="GTiff", height=20, width=30, count=1, dtype="float64",
        transform=rasterio.Affine(10, 0, 4e5, 0, -10, 5e6), crs="EPSG:32633",
    ) as file:  # fmt: skip
        file.write(rows, 1)
        file.set_band_description(1, name)
    notes = vizlight.look(tmp_path / "a.tif", size=SIZE).notes
    assert any(f"{name} is taken for heights" in note for note in notes) == said


def test_creases_of_a_part_are_lines_that_are_seen():
    # A ball with a slot on the side away from the usual eye.
    ball = pv.Sphere(theta_resolution=40, phi_resolution=40)
    points = ball.points.copy()
    points[(np.abs(points[:, 1]) < 0.15) & (points[:, 0] > 0), 0] -= 0.2
    ball.points = points
    look = vizlight.look(ball, size=SIZE)
    drawn, creases = look.drawing.layers
    assert drawn.live
    assert creases.mesh.run().points[:, 0].max() > 0.4
    assert look.view.position[0] > 0
    assert len(vizlight.look(pv.Sphere(), size=SIZE).drawing.layers) == 1


def test_a_plane_of_many_unequal_cells_shows_their_sizes_where_most_are():
    ring = pv.Disc(inner=1, outer=2, r_res=80, c_res=80)
    far = np.linalg.norm(ring.points, axis=1, keepdims=True)
    ring.points *= np.exp(8 * (far - 1)) / far
    ring.clear_data()
    look = vizlight.look(ring, size=SIZE)
    assert look.drawing.words == "plane in the colours of the areas of its cells"
    assert look.notes[-1] == "the lesser half of the cells fills the picture"
    assert look.view.GetParallelScale() < ring.points.max() / 10
    even = pv.ImageData(dimensions=(81, 81, 1))
    assert vizlight.look(even, size=SIZE).drawing.words == "plane"


def test_a_plane_without_data_has_faint_edges_of_cells_a_border_and_the_name_of_its_file(tmp_path):
    plane = pv.Plane(i_resolution=20, j_resolution=20)
    plane.clear_data()
    plane.save(path := tmp_path / "duct.vtp")
    look = vizlight.look(path, size=SIZE)
    sheet, border = look.drawing.layers
    assert pv.Color(sheet.keywords["edge_color"]).float_rgb < (0.5, 0.5, 0.5)
    assert sheet.keywords["edge_opacity"] < 0.5
    assert border.mesh.run().n_cells == 80
    assert look.key[0]["title"] == "duct"


def test_a_solid_without_data_has_the_edges_of_its_cells_and_a_surface_has_none():
    grid = pv.StructuredGrid(*np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij"))
    solid, skin = (
        vizlight.look(mesh, size=SIZE).drawing.layers[0].keywords
        for mesh in (grid, grid.extract_surface(algorithm="dataset_surface"))
    )
    assert solid["show_edges"]
    assert "show_edges" not in skin


def test_of_a_mesh_far_around_a_body_its_walls_are_drawn():
    look = vizlight.look(pv.SolidSphere(inner_radius=1.0, outer_radius=9.0), size=SIZE)
    assert look.drawing.words == "walls"
    assert look.mesh.length < 4
    assert look.notes[-1] == "the walls inside of the mesh are drawn, its far field is left out"


def test_kinds_that_a_solid_has_inside_alone_are_in_the_title():
    grid = pv.ImageData(dimensions=(6, 6, 6)).cast_to_unstructured_grid()
    grid.cell_data["material"] = np.where(np.abs(grid.cell_centers().points - 2.5).max(1) < 1, 7, 1)
    grid.cell_data["material"][0] = 3
    look = vizlight.look(grid, size=SIZE)
    assert look.notes[-1] == "material 7 is inside, where it is not seen"
    assert look.key[0]["title"] == "material; inside: 7"


def test_cells_that_lie_over_others_on_a_flat_mesh_are_no_creases():
    # Columns of a grid of an ocean come again at its seam.
    x, y = np.meshgrid([0.0, 1, 2, 3, 1, 2], np.arange(5.0), indexing="ij")
    grid = pv.StructuredGrid(x, y, np.zeros_like(x))
    grid["sst"] = np.arange(30.0)
    assert files.creases(files.surface_of(grid)).n_cells > 0
    look = vizlight.look(grid, size=SIZE)
    assert "creases" not in [layer.mesh.name for layer in look.drawing.layers]


def test_points_of_a_surface_close_it_and_those_in_a_volume_do_not_hide_each_other():
    random = np.random.default_rng(0)
    on_ball = random.normal(size=(2000, 3))
    on_ball /= np.linalg.norm(on_ball, axis=1, keepdims=True)
    within = random.uniform(-1, 1, (2000, 3))
    sizes = []
    for points in (on_ball, within, within[:40] * [1, 1, 0]):
        (drawn,) = vizlight.look(pv.PolyData(points), size=(600, 400)).drawing.layers
        sizes.append(drawn.keywords["point_size"])
    # 2000 points on a ball some 300 pixels wide are 12 pixels apart, those in front of it.
    assert 10 < sizes[0] < 20
    assert sizes[1] < 6
    # Few points are as large as their colours need to be read.
    assert sizes[2] == 20


def test_a_title_is_the_name_of_a_file_and_no_word_of_a_reader(tmp_path):
    mesh = ball(ImageScalars=lambda x, y, z: z)
    mesh.save(tmp_path / "heart.vtp")
    titles = [vizlight.look(of).drawing.keys[0]["title"] for of in (tmp_path / "heart.vtp", mesh)]
    assert titles == ["heart", "values"]


def test_the_neutral_colour_of_signed_values_is_at_0():
    mesh = ball(stress=lambda x, y, z: np.where(z > 0, 2, 1) * z, height=lambda x, y, z: 2 + z)
    for options, name, ends in (
        ({}, "coolwarm", (-1, 1)),
        ({"clim": (-3, 3)}, "coolwarm", (-3, 3)),
        ({"clim": (-1, 3)}, "vizlight.surface", (-1, 3)),
        ({"cmap": "RdBu"}, "RdBu", (-1, 1)),
        ({"array": "height"}, "vizlight.surface", (1.5, 2.5)),
    ):
        (key,) = vizlight.look(mesh, **options).drawing.keys
        assert (key["cmap"], key["clim"]) == (name, ends)


@pytest.mark.parametrize(
    ("days", "long_name", "title"),
    [
        ((0, 31, 59), "SURFACE WIND", "surface wind, 2000-02 (m/s)"),
        ((0, 31, 60), "SST", "SST, 2000-02 (m/s)"),
        ((0, 1, 2), "Wind", "Wind, 2000-01-02 (m/s)"),
    ],
)
def test_titles_in_capitals_are_written_small_and_monthly_steps_are_months(days, long_name, title):
    grid = pv.ImageData(dimensions=(3, 3, 1))
    arrays = {"w": {"long_name": long_name, "units": "M/S"}}
    meaning.attach(grid, meaning.Meaning(arrays=arrays, time="days since 2000-01-01"))
    assert titled(series.marked(grid, days, 1), "w") == title


def test_a_step_of_a_climatology_has_the_name_of_its_month():
    grid = pv.ImageData(dimensions=(3, 3, 1))
    meaning.attach(grid, meaning.Meaning(time="hour since 0000-01-01 00:00:00"))
    hours = 366 + 730.485 * np.arange(12)
    titles = [titled(series.marked(grid, hours, i), "SST") for i in (0, 1, 11)]
    assert titles == ["SST, January", "SST, February", "SST, December"]


def test_a_surface_of_four_coordinates_is_not_folded_onto_itself():
    circle = np.linspace(0, 2 * np.pi, 33)
    u, v = np.meshgrid(circle, circle, indexing="ij")
    x, y, z, w = (np.sqrt(0.5) * rows for rows in (np.cos(u), np.sin(u), np.cos(v), np.sin(v)))
    mesh = pv.StructuredGrid(x, y, z).extract_surface(algorithm="geometry")
    mesh["position"] = pv.StructuredGrid(x, y, z).points[:, [0, 1, 2, 2]].astype(float)
    mesh["position"][:, 3] = w.ravel(order="F")
    look = vizlight.look(mesh, size=SIZE)
    assert (look.question, look.shown, look.array) == ("value", "surface", "w")
    assert look.key[0]["title"] == "w, the last of 4 coordinates"
    # From the pole of the sphere: a torus of revolution.
    places = np.asarray(mesh["position"])
    image = places[:, :3] / (1 - places[:, 3:])
    np.testing.assert_allclose(look.mesh.points, image, atol=1e-6)
    assert any("perspective" in note and "distance" in note for note in look.notes)
    # One that is projected already stays as it is.
    ready = vizlight.project(mesh, distance=2.0)
    look = vizlight.look(ready, size=SIZE)
    assert look.array == "w"
    np.testing.assert_array_equal(look.mesh.points, ready.points)
    assert not look.notes
    # Other data have the colours.
    mesh["heat"] = np.asarray(mesh.points, float)[:, 0]
    look = vizlight.look(mesh, size=SIZE)
    assert look.array == "heat"
    np.testing.assert_allclose(look.mesh.points, image, atol=1e-6)


@pytest.mark.parametrize(
    ("time", "attributes", "words", "end"),
    [
        (("month", [1, 7], {}), {}, {}, ", July"),
        (("month", [1, 17], {}), {}, {}, ", t = 17"),
        (("time", [31.0, 59.0, 90.0], {"units": "days since 1970-01-01"}), {},
         {"long_name": "Monthly Long Term mean"}, ", April"),
        (("time", [31.0, 59.0, 90.0], {"units": "days since 1970-01-01"}), {}, {}, ", 1970-04"),
        ((), {"time": ((), 43200.0, {"units": "seconds since 0001-01-01"})}, {}, ""),
        ((), {"time": ((), 0.5, {"units": "days since 2001-01-01"})}, {}, ", 2001-01-01 12:00"),
        ((), {"p": ((), 2e4, {"units": "Pa", "standard_name": "air_pressure"})}, {}, " at 200 hPa"),
        ((), {"h": ((), 2.0, {"units": "m", "standard_name": "height"})}, {}, " at 2 m"),
        ((), {"h": ((), 2.0, {"units": "m"})}, {}, ""),
    ],
)  # fmt: skip
def test_a_title_has_the_month_the_date_or_the_level_that_a_file_tells(
    time, attributes, words, end
):
    xr = pytest.importorskip("xarray")
    rows = np.add.outer(np.arange(4.0), np.arange(5.0) ** 2)
    coords = {"lat": 40 + np.arange(4.0), "lon": 10 + np.arange(5.0)} | attributes
    dims = ("lat", "lon")
    if time:
        name, ticks, of_ticks = time
        coords[name] = (name, ticks, of_ticks)
        dims, rows = (name, *dims), np.stack([rows + k for k in ticks])
    data = xr.Dataset({"t": (dims, rows, words)}, coords)
    title = vizlight.look(data, size=SIZE).drawing.keys[0]["title"]
    name = words.get("long_name", "t")
    assert title.partition(";")[0] == f"{name}{end}"


def test_a_note_on_the_last_step_has_its_date(tmp_path):
    xr = pytest.importorskip("xarray")
    rows = np.arange(40.0).reshape(2, 4, 5)
    clock = ("time", [0.0, 1.5e9], {"units": "seconds since 1970-01-01"})
    coords = {"time": clock, "lat": np.arange(4.0), "lon": np.arange(5.0)}
    xr.Dataset({"t": (("time", "lat", "lon"), rows)}, coords).to_netcdf(tmp_path / "a.nc")
    notes = vizlight.look(tmp_path / "a.nc", size=SIZE).notes
    assert notes[0].startswith("time 2017-07-14 02:40, the last of 2 steps")


def test_points_of_a_layer_have_the_colours_of_their_heights():
    """As a lidar in the air measures them, whose intensity is noise from place to place."""
    random = np.random.default_rng(0)
    x, y = random.random((2, 3000)) * [[200], [150]]
    ground = pv.PolyData(np.column_stack([x, y, 0.1 * x + 15 * np.sin(y / 30)]))
    bare = vizlight.look(ground)
    assert bare.array == "Elevation"
    assert [key["title"] for key in bare.key] == ["Elevation"]
    assert bare.key[0]["clim"] == pytest.approx(ground.bounds[4:], rel=1e-5)
    lidar = ground.copy()
    lidar["intensity"] = random.integers(0, 255, 3000).astype(np.uint16)
    lidar["classification"] = random.integers(1, 4, 3000).astype(np.uint8)
    scan = vizlight.look(lidar)
    assert scan.array == "Elevation"
    assert {other.array for other in scan.others} == {"intensity", "classification"}
    assert vizlight.look(lidar, array="intensity").array == "intensity"
    # Other data count more, and a body is no layer.
    lidar["grade"] = random.random(3000)
    assert vizlight.look(lidar).array in ("grade", "intensity")
    assert vizlight.look(pv.PolyData(random.random((3000, 3)))).array is None
