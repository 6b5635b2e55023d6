"""Volumes of values: an isosurface, what is shown on it, and when it gives way to slices."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.draw.margins import parted
from vizlight.filters.key import annotated
from vizlight.looks.recipes import volumes
from vizlight.mesh import meaning
from vizlight.reading import brains, density_maps


def volume(noise=0.0, count=24, kind=float):
    grid = pv.ImageData(dimensions=(count,) * 3, spacing=(2 / (count - 1),) * 3)
    x, y, z = grid.points.T - 1
    ball = np.tanh(8 * (0.7 - np.sqrt(x * x + y * y + z * z)))
    values = ball + noise * np.random.default_rng(0).normal(size=len(ball))
    # Scanners have whole numbers.
    grid["T"] = values if kind is float else np.round(100 * values).astype(kind)
    return grid


def test_an_array_that_is_asked_for_besides_is_shown_on_the_isosurface():
    grid = volume()
    grid["x"] = grid.points[:, 0]
    assert "colours of x" not in vizlight.look(grid, array="T").summary
    look = vizlight.look(grid, array="T", scalars="x")
    assert look.shown == "isosurface"
    assert "in the colours of x" in look.summary


def test_the_title_of_an_isosurface_has_the_words_and_the_unit_of_its_file():
    grid = volume()
    words = {"long_name": "air_temperature", "units": "K"}
    meaning.attach(grid, meaning.Meaning(arrays={"T": words}))
    (key,) = vizlight.look(grid, "shape", contour="T", level=0.5).drawing.keys
    assert parted(key["title"]) == ("Air temperature, isosurface at 0.5 K", "")
    grid.field_data["TimeValue"] = [0.0]
    when = meaning.Meaning(arrays={"T": words}, time="days since 2001-02-03")
    meaning.attach(grid, when)
    (key,) = vizlight.look(grid, "shape", contour="T", level=0.5).drawing.keys
    assert parted(key["title"]) == ("Air temperature, isosurface at 0.5 K, 2001-02-03", "")


def test_an_isosurface_is_cut_open_where_the_values_inside_differ(tmp_path):
    grid = pv.ImageData(dimensions=(24,) * 3).cast_to_rectilinear_grid()
    grid["T"] = np.exp(-((grid.points - 11.5) ** 2).sum(axis=1) / 40)
    look = vizlight.look(grid)
    assert look.shown == "isosurface"
    assert look.summary.endswith("with the values inside (shape: isosurface)")
    cut, outside = (layer.mesh.run() for layer in look.drawing.layers[:2])
    low, high = cut.get_data_range("T")
    assert outside["T"] == pytest.approx(low, abs=1e-3)
    assert high == pytest.approx(1, abs=0.05)
    cells = grid.point_data_to_cell_data()
    assert "with the values inside" in vizlight.look(cells, array="T").summary
    # Who asks for the shape has all of it, as has one whose values inside are the same.
    assert len(vizlight.look(grid, "shape").mesh.split_bodies()) == 1
    grid["T"] = np.minimum(grid["T"], 0.55)
    assert "inside" not in vizlight.look(grid, contour="T", level=0.5).summary


def test_the_outside_of_a_grey_scan_that_is_cut_open_is_not_black_and_there_is_room_for_its_key():
    grid = pv.ImageData(dimensions=(24,) * 3)
    grid["T"] = np.exp(-((grid.points - (11.5, 11.5, 21)) ** 2).sum(axis=1) / 40)
    grid = grid.cast_to_structured_grid()
    brains.mark_as_body(grid, "affine", np.eye(4))
    look = vizlight.look(grid)
    assert look.summary.endswith("with the values inside (shape: isosurface)")
    skin, sides = look.drawing.layers[1:3]
    assert skin.mesh.run()["T"].max() < sides.mesh.run()["T"].min() + 1e-6
    assert "scalars" not in skin.keywords
    assert sides.keywords["scalars"] == "T"
    wide, tall = look.wishes.room
    assert look.drawing.camera.keywords["aspect"] == pytest.approx(wide / tall, abs=1e-3)


def test_an_isosurface_of_a_scan_around_its_lowest_values_gives_way_to_slices():
    grid = pv.ImageData(dimensions=(24,) * 3)
    grid["T"] = 1 - np.exp(-((grid.points - 11.5) ** 2).sum(axis=1) / 20)
    assert vizlight.look(grid).shown == "isosurface"
    brains.mark_as_body(grid, "affine", np.eye(4))
    look = vizlight.look(grid)
    assert "slices of T" in look.summary
    grid["T"] = 1 - grid["T"]
    assert "isosurface T" in vizlight.look(grid).summary
    # What is around is one value, as where statistics are masked.
    grid["T"] = np.minimum(0.2 - grid["T"], 0)
    assert "isosurface T" in vizlight.look(grid).summary


def test_a_hollow_body_that_its_middle_does_not_meet_is_drawn(tmp_path):
    shell = pv.SolidSphere(inner_radius=0.8, outer_radius=1.0, theta_resolution=40)
    corner = shell.clip_box((-2, 0.1, -2, 0.1, -2, 0.1), merge_points=True)
    corner["T"] = np.random.default_rng(0).random(corner.n_points)
    look = vizlight.look(corner, "value", size=(300, 200))
    look.save(tmp_path / "a.png")
    assert all(layer.mesh.run().n_points for layer in look.drawing.layers)


def test_a_temperature_has_the_colours_of_heat():
    grid = volume()
    for name, colors in (("T", "vizlight.heat"), ("Temperature_K", "vizlight.heat"),
                         ("tempo", "vizlight.surface")):  # fmt: skip
        grid.rename_array(grid.active_scalars_name, name)
        (key,) = vizlight.look(grid).drawing.keys
        table = key["cmap"]
        assert (table if isinstance(table, str) else table.arguments[0]) == colors


def test_an_image_without_active_scalars_is_drawn():
    grid = volume(count=40)
    grid.set_active_scalars(None)
    assert vizlight.look(grid).mesh.n_points


def test_slices_are_named_so(monkeypatch):
    monkeypatch.setattr(volumes.levels, "GOOD", 1e9)
    look = vizlight.look(volume())
    assert look.shown == "slices"
    assert "no isosurface stands out" in look.summary


@pytest.mark.slow
@pytest.mark.opengl
def test_a_rough_isosurface_that_cannot_be_read_gives_way_to_slices(monkeypatch):
    monkeypatch.setattr(volumes.levels, "GOOD", 0.0)
    monkeypatch.setattr(volumes, "MOST_PIECES", 1e9)
    # An image would be a scan, which is smoothed.
    grid = volume(2.0, 60).cast_to_rectilinear_grid()
    look = vizlight.look(grid, array="T", size=(300, 200))
    assert look.shown == "slices"
    (reason,) = [note for note in look.notes if note.startswith("not chosen: isosurface T = ")]
    assert "cannot be read: " in reason
    # What is asked for is kept.
    assert vizlight.look(grid, "shape", array="T", size=(300, 200)).shown == "isosurface"
    smooth = vizlight.look(volume(), array="T", size=(300, 200))
    assert (smooth.shown, smooth.notes) == ("isosurface", ())


def test_a_volume_stands_in_a_box_with_numbers_but_in_movies():
    grid = volume()
    grid["x"] = grid.points[:, 0]
    for look in (vizlight.look(grid, array="T"), vizlight.look(volume(), "shape")):
        paths = [layer.mesh.path for layer in look.drawing.layers]
        assert paths[-2:] == ["render.box_edges", "render.box_axes"]
        # The camera shows the numbers too.
        eye = look.view
        axes = look.drawing.layers[-1].mesh.run()
        right = np.cross(eye.direction, eye.up)
        depth = (axes.points - eye.position) @ eye.direction
        across = np.abs((axes.points - eye.position) @ right) / depth
        assert across.max() < np.tan(np.radians(eye.view_angle / 2)) * 1.4
        turned = look.steps("turn.gif")[0]
        paths = [step.arguments[1].path for step in turned if step.path == ".add_mesh"]
        assert ".outline" in paths
        assert "render.box_axes" not in paths


def test_an_isosurface_of_crumbs_gives_way_to_slices():
    grid = pv.ImageData(dimensions=(40,) * 3)
    random = np.random.default_rng(0)
    bumps = np.zeros((40,) * 3)
    bumps[2:-2:4, 2:-2:4, 2:-2:4] = random.uniform(0.9, 1.1, bumps[2:-2:4, 2:-2:4, 2:-2:4].shape)
    grid["f"], grid["g"] = bumps.ravel(), bumps.ravel()
    assert volumes._is_crumbs(grid.contour([0.5], scalars="f"))
    assert not volumes._is_crumbs(volume().contour([0.0], scalars="T"))


def test_what_a_side_of_a_scan_cuts_off_is_closed_but_pores_are_open():
    grid = volume(count=40, kind=np.int16)
    grid = grid.extract_subset((0, 39, 0, 39, 0, 31))
    ball = vizlight.look(grid).mesh.clean()
    assert ball.n_open_edges == 0
    assert ball.bounds.z_max == pytest.approx(grid.bounds.z_max, abs=grid.spacing[2])
    grid["T"] = -grid["T"]
    assert vizlight.look(grid).mesh.clean().n_open_edges > 0


def test_a_scan_fills_the_picture_and_not_its_box():
    grid = volume(count=40, kind=np.int16)
    look = vizlight.look(grid)
    assert "render.box_edges" not in [layer.mesh.path for layer in look.drawing.layers]
    eye = look.view
    right = np.cross(eye.direction, eye.up)
    depth = (look.mesh.points - eye.position) @ eye.direction
    across = np.abs((look.mesh.points - eye.position) @ right) / depth
    assert across.max() > 0.75 * np.tan(np.radians(eye.view_angle / 2))


def scan(*layers, axes=()):
    """Return a scan of shells, each a radius and a value, from the outermost, in noise or air."""
    grid = pv.ImageData(dimensions=(32, 32, 32), origin=(-15.5,) * 3)
    radius = np.linalg.norm(grid.points, axis=1)
    values = np.arange(grid.n_points) % 17.0
    for end, value in layers:
        # Nothing is quite even but the ground of what was cut out.
        values = np.where(radius < end, value + 0.01 * radius * (value != 0), values)
    grid["NIFTI"] = values
    meaning.attach(grid, meaning.Meaning(axes=[*axes]))
    return grid


def test_a_scan_of_a_body_is_cut_open_or_shows_bones():
    tissue = (13, 80), (8, 120)
    look = vizlight.look(scan(*tissue, axes=meaning.ANATOMY))
    assert look.summary.startswith("NIFTI in a body cut open toward the eye")
    cut, skin = look.drawing.layers
    assert np.linalg.norm(cut.mesh.run().points, axis=1).max() < 14.5
    assert np.dot(skin.mesh.run().points.mean(axis=0), look.view.direction) > 0
    assert look.drawing.keys[0]["cmap"] == "gray"
    assert [other.python for other in look.others] == ["question='shape'"]
    assert vizlight.look(scan(*tissue)).shown == "isosurface"
    # What was cut out of its scan is an organ, but for what is thin.
    organ = vizlight.look(scan((99, 0), *tissue, axes=meaning.ANATOMY))
    assert "cut open" in organ.summary
    shell = vizlight.look(scan((99, 0), (13, 80), (11, 0), axes=meaning.ANATOMY))
    assert shell.shown == "isosurface"
    assert [other.python for other in shell.others] == ["question='value'", "question='shape'"]
    bones = vizlight.look(scan((99, -1000), (13, 40), (8, 900), (7, 30)))
    assert "NIFTI = 300" in bones.summary
    assert "bone" in str(bones)
    slices = vizlight.look(scan((99, -1000), (13, 40), (8, 900)), "value")
    assert (slices.shown, slices.drawing.keys[0]["cmap"]) == ("slices", "gray")
    measured = scan(*tissue, axes=meaning.ANATOMY)
    # Scans that are resampled have values a little below 0.
    measured["NIFTI"][::97] = -9
    assert vizlight.look(measured).drawing.keys[0]["cmap"] == "gray"


def test_both_signs_of_an_orbital_are_shown(monkeypatch):
    grid = pv.ImageData(dimensions=(25, 25, 25), origin=(-12.0,) * 3)
    x, y, z = grid.points.T
    grid["psi"] = x * np.exp(-np.sqrt(x * x + y * y + z * z) / 2)
    look = vizlight.look(grid)
    (key,) = look.drawing.keys
    level = key["clim"][1]
    assert [name for _, name in annotated(key["cmap"].run())] == [f"{-level:.4g}", f"{level:.4g}"]
    assert f"isosurface psi = ±{level:.4g}" in look.summary
    assert key["title"] == f"Psi, isosurfaces at ±{level:.4g}"
    # Of one colour each they have the light of a shape.
    assert len(look.scene.lights) == 3
    np.testing.assert_allclose(np.unique(look.mesh["psi"]), [-level, level], rtol=1e-6)
    # The molecule of a cube file is seen through lobes whose faces point outward.
    grid.field_data["atom_numbers"], grid.field_data["atom_places"] = [8, 1], [[0, 0, 0], [1, 0, 0]]
    with_atoms = vizlight.look(grid)
    lobes, atoms, *_ = with_atoms.drawing.layers
    end, squares = with_atoms.drawing.keys[0]["clim"][1], np.asarray(grid["psi"]) ** 2
    assert squares[squares > end**2].sum() == pytest.approx(0.85 * squares.sum(), rel=0.05)
    assert (lobes.keywords["opacity"], lobes.keywords["culling"]) == (0.5, "back")
    normals, points = lobes.mesh.run()["Normals"], np.asarray(lobes.mesh.run().points)
    sides = np.where(points[:, :1] > 0, 1, -1) * [4, 0, 0]
    assert np.all(np.sum(normals * (points - sides), axis=1) > 0)
    np.testing.assert_allclose(atoms.mesh.run().center, (0.5, 0, 0), atol=0.5)
    # An atom that stands out of the lobes of a scan is in the picture.
    grid.field_data["atom_places"] = [[0, 0, 0], [0, 0, 20]]
    monkeypatch.setattr(volumes, "_is_scan", lambda *_: True)
    camera = vizlight.look(grid).drawing.camera.run()
    toward = np.array([0, 0, 20]) - camera.position
    share = toward @ camera.GetDirectionOfProjection() / np.linalg.norm(toward)
    assert np.degrees(np.arccos(share)) < camera.view_angle / 2
    monkeypatch.undo()
    grid["psi"] = np.abs(grid["psi"])
    assert "±" not in vizlight.look(grid).summary


def test_a_level_of_both_signs_is_shown_where_0_is_the_ground():
    grid = pv.ImageData(dimensions=(32,) * 3, origin=(-15.5,) * 3)
    x, y, z = grid.points.T
    below, above = (np.tanh(2 - np.sqrt((x - side) ** 2 + y**2 + z**2) / 2) + 1 for side in (-6, 6))
    # Statistics of a brain, which is no scan of one.
    grid["t"] = above - below
    meaning.attach(grid, meaning.Meaning(axes=[*meaning.ANATOMY]))
    look = vizlight.look(grid)
    low, high = np.unique(look.mesh["t"])
    assert low == -high
    assert f"isosurface t = ±{high:.4g} " in look.summary
    np.testing.assert_array_equal(np.sign(look.mesh.points[:, 0]), np.sign(look.mesh["t"]))
    # A lobe of one sign, and a distance with 0 on its surface, have one isosurface.
    for values in (above - 0.01 * below, above - 1):
        meaning.attach(grid, meaning.Meaning())
        grid["t"] = values
        assert "±" not in vizlight.look(grid).summary


def test_signed_maps_of_a_masked_body_are_in_its_glass():
    grid = pv.ImageData(dimensions=(40,) * 3, origin=(-19.5,) * 3)
    x, y, z = grid.points.T
    below, above = (np.exp(-((x - side) ** 2 + y**2 + z**2) / 12) for side in (-6, 6))
    inside = np.sqrt(x * x + y * y + z * z) < 16
    grid["t"] = np.where(inside, 7 * above - 5 * below + 1e-3, 0.0)
    look = vizlight.look(grid)
    blobs, glass = (layer.mesh.run() for layer in look.drawing.layers[:2])
    radii = np.linalg.norm(glass.points, axis=1)
    assert radii.min() > 16 > np.linalg.norm(blobs.points, axis=1).max()
    assert np.ptp(radii) < 2
    assert look.drawing.layers[1].keywords["opacity"] < 0.5
    title = look.drawing.keys[0]["title"]
    assert title.endswith("peaks {:.3g} and {:.3g}".format(grid["t"].min(), grid["t"].max()))
    # Along an axis across which no lobe hides the other one.
    way = np.abs(look.view.direction)
    assert way[0] == 0
    assert np.sort(way).tolist() == [0, 0, 1]
    # Elsewhere the data do not say where a body is.
    grid["t"] = 7 * above - 5 * below + 1e-3
    assert "peaks" not in vizlight.look(grid).drawing.keys[0]["title"]


def test_a_map_of_densities_has_a_level_of_2_deviations_where_nothing_is_steeper(monkeypatch):
    monkeypatch.setattr(volumes.levels, "GOOD", 1e9)
    grid = volume(count=40)
    grid["T"] = np.sin(9 * grid.points).prod(axis=1)
    assert vizlight.look(grid).shown == "slices"
    grid["T"] = np.exp(2 * grid["T"])
    words = {"long_name": density_maps.WORDS}
    meaning.attach(grid, meaning.Meaning(arrays={"T": words}))
    look = vizlight.look(grid)
    level = grid["T"].mean() + 2 * grid["T"].std()
    np.testing.assert_allclose(look.mesh["T"], level, rtol=0.01)
    assert look.shown == "isosurface"
    assert look.mesh.clean().n_open_edges == 0
    assert look.drawing.layers[-1].mesh.path == "render.box_axes"
    # Noise has no surface.
    grid["T"] = np.random.default_rng(0).lognormal(size=grid.n_points)
    assert vizlight.look(grid).shown == "slices"
    assert vizlight.look(grid, "shape").shown == "isosurface"


def test_a_map_of_differences_of_densities_has_a_level_of_3_deviations_of_both_signs():
    grid = volume(count=40)
    grid["T"] = np.random.default_rng(0).normal(size=grid.n_points)
    words = {"long_name": density_maps.WORDS}
    meaning.attach(grid, meaning.Meaning(arrays={"T": words}))
    look = vizlight.look(grid)
    np.testing.assert_allclose(np.unique(look.mesh["T"]), [-3, 3], rtol=0.02)
    assert "the levels are 3 standard deviations from 0" in look.drawing.notes
    # Noise around a ground above 0 is none.
    grid["T"] += 0.5
    assert "±" not in vizlight.look(grid).summary


def test_borders_of_an_isosurface_are_as_light_as_its_box_and_it_has_no_creases():
    grid = pv.ImageData(dimensions=(12,) * 3)
    grid["T"] = np.abs(grid.points - 5).sum(axis=1)
    look = vizlight.look(grid, contour="T", level=6.0)
    colors = {layer.mesh.name: layer.keywords["color"] for layer in look.drawing.layers[1:2]}
    assert colors == {"borders": "gray"}
    assert "creases" not in [layer.mesh.name for layer in look.drawing.layers]


def test_specks_beside_the_isosurface_of_a_scan_are_left_out(tmp_path):
    grid = volume(count=64, kind=np.int16)
    values = np.asarray(grid["T"]).reshape(grid.dimensions, order="F")
    values[3:5, 3:5, 3:5] = values.max()
    values[55:57, 3:5, 3:5] = values.max()
    look = vizlight.look(grid)
    assert "2 small pieces are left out" in look.drawing.notes
    assert look.mesh.bounds[0] == pytest.approx(0.25, abs=0.05)
    assert '.connectivity("specified", [0])' in look.script("a.png")
    # Who asks for a level gets all of it.
    whole = vizlight.look(grid, "shape", contour="T", level=0.0)
    assert whole.mesh.bounds[0] < 0.1


def test_a_slab_of_a_scan_is_a_sheet_of_its_slices_and_what_has_signs_is_not_grey():
    grid = pv.ImageData(dimensions=(40, 36, 8), spacing=(2, 2, 2))
    x, y, z = grid.points.T
    grid["t"] = np.exp(-((x - 30) ** 2 + (y - 40) ** 2) / 300) + z / 100
    meaning.attach(grid, meaning.Meaning(axes=[*meaning.ANATOMY]))
    look = vizlight.look(grid)
    assert "side by side" in look.summary
    # Its brightest hundredth is white, as in a cut.
    keywords = look.drawing.layers[0].keywords
    assert grid["t"].min() < keywords["clim"][1] < grid["t"].max()
    signed = grid.copy()
    signed["t"] = np.sign(x - 30) * grid["t"]
    for mesh, is_grey in ((grid, True), (signed, False)):
        section = vizlight.look(mesh, slice=((0, 0, 1), (0, 0, 8)))
        table = section.drawing.layers[0].keywords["cmap"]
        names = getattr(table, "arguments", (table,))
        assert ("gray" in names) == is_grey
