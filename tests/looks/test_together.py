"""Several meshes and blocks of different dimensions in one picture."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.mesh import blocks

SIZE = (120, 80)


def ball(x):
    mesh = pv.Sphere(theta_resolution=12, phi_resolution=12, center=(x, 0, 0))
    mesh["T"] = np.asarray(mesh.points)[:, 0]
    return mesh


def lines():
    return pv.Spline(np.array([[0, 0, z] for z in (-2.0, 0.0, 2.0)]), 20)


def test_each_mesh_is_drawn_by_its_rule_and_all_share_the_camera_and_the_range():
    look = vizlight.look([ball(0), ball(3), lines()], size=SIZE)
    layers = look.drawing.layers
    assert [layer.keywords.get("scalars") for layer in layers] == ["T", "T", None]
    assert pv.Color(layers[2].keywords["color"]) == "black"
    first, second = (layer.keywords["clim"] for layer in layers[:2])
    assert first == second == pytest.approx((-0.5, 3.5), abs=0.02)
    assert len(look.drawing.keys) == 1
    assert isinstance(look.mesh, pv.MultiBlock)
    middle = np.asarray(look.view.GetFocalPoint())
    assert middle[0] == pytest.approx(1.5, abs=0.6)
    text = look.script("a.png")
    assert text.count("render.camera_on(") == 1
    dark = vizlight.look([ball(0), lines()], size=SIZE, style="dark")
    assert pv.Color(dark.drawing.layers[-1].keywords["color"]) == "white"
    # Beside no surface lines have the colours of their directions.
    alone = vizlight.look([lines(), lines()], size=SIZE)
    assert {layer.keywords["scalars"] for layer in alone.drawing.layers} == {"rgb"}


def test_files_whose_arrays_a_reader_named_alike_have_their_own_ranges(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    x, y, z = np.meshgrid(*[np.arange(-17.0, 17.0)] * 3, indexing="ij")
    of_ball = {side: np.tanh(4 - np.sqrt((x - side) ** 2 + y**2 + z**2)) + 1 for side in (-7, 7)}
    head = 400 * np.tanh(16 - np.sqrt(x**2 + y**2 + z**2)) + 400
    values = {"head": head, "t": of_ball[7] - of_ball[-7]}
    for name, rows in values.items():
        image = nibabel.Nifti1Image(rows.astype(np.float32), np.diag([3, 3, 3, 1]))
        nibabel.save(image, tmp_path / f"{name}.nii")
    look = vizlight.look([tmp_path / "head.nii", tmp_path / "t.nii"], size=SIZE)
    *_, blobs = (layer for layer in look.drawing.layers if "scalars" in layer.keywords)
    mesh, level = blobs.mesh.run(), blobs.keywords["clim"][1]
    assert blobs.keywords["clim"] == (-level, level)
    assert pv.Color(blobs.keywords["cmap"][1]) == pv.Color(look.key[-1]["cmap"].map_value(1))
    np.testing.assert_array_equal(np.sign(mesh["NIFTI"]), np.sign(mesh.points[:, 0] - 51))
    # Values of one title share a range.
    grids = [pv.ImageData(dimensions=(3, 3, 1), origin=(5 * i, 0, 0)) for i in (0, 1)]
    for i, grid in enumerate(grids):
        grid["values"] = np.arange(9.0) * (i + 1) + 0.5
    (key,) = vizlight.look(grids, size=SIZE).drawing.keys
    assert key["clim"] == (0.5, 16.5)


def test_a_closed_surface_around_others_is_see_through():
    inside, outside = ball(0).scale(0.5), lines()
    for other, is_around in ((inside, True), (outside, False), (ball(0.8), False)):
        look = vizlight.look([other, ball(0)], size=SIZE)
        seen = [
            it.keywords.get("opacity", 1) for it in look.drawing.layers if "scalars" in it.keywords
        ]
        assert seen[-1] < 1 if is_around else min(seen) == 1
        assert ("a surface is see-through: data lie inside it" in look.notes) == is_around
    # The lids of a cylinder have points of their own, and blocks of one dimension are apart.
    vessel = pv.Cylinder(radius=1, height=3, direction=(0, 0, 1))
    seen_through = vizlight.look(pv.MultiBlock({"vessel": vessel, "ball": inside}), size=SIZE)
    opacities = [layer.keywords.get("opacity") for layer in seen_through.drawing.layers]
    assert (opacities[0], opacities[1] < 1) == (None, True)
    assert [key["title"] for key in seen_through.drawing.keys] == ["T"]
    # An open one shows what it holds.
    look = vizlight.look([inside, ball(0).clip("z", origin=(0, 0, 0.4))], size=SIZE)
    assert not any("opacity" in layer.keywords for layer in look.drawing.layers)


def test_blocks_of_other_dimensions_are_drawn_and_walls_of_a_volume_are_not():
    mixed = pv.MultiBlock({"ball": ball(0), "lines": lines()})
    assert [part[0].max_cell_dimensionality for part in blocks.by_dimension(mixed)] == [2, 1]
    assert len(vizlight.look(mixed, size=SIZE).drawing.layers) == 2
    volume = pv.ImageData(dimensions=(3, 3, 3))
    walls = pv.MultiBlock(
        {"air": volume, "wall": volume.extract_surface(algorithm="dataset_surface")}
    )
    assert [part[0].max_cell_dimensionality for part in blocks.by_dimension(walls)] == [3]
    walls["wing"] = pv.Plane(center=(4, 0, 0), i_size=5)
    assert [part.keys() for part in blocks.by_dimension(walls)] == [["air"], ["wing"]]
    # A point alone is the reference of a rigid body.
    walls["reference"] = pv.PolyData([(0.0, 0.0, 0.0)])
    assert [part.keys() for part in blocks.by_dimension(walls)] == [["air"], ["wing"]]
    # The borders of a plane mesh are no lines of their own.
    plane = pv.Plane()
    inlet = plane.extract_feature_edges(feature_edges=False, manifold_edges=False)
    for lines_beside, sizes in ((inlet, [2]), (inlet.translate((3, 0, 0)), [2, 1])):
        both = pv.MultiBlock({"air": plane, "inlet": lines_beside})
        parts = blocks.by_dimension(both)
        assert [part[0].max_cell_dimensionality for part in parts] == sizes


def test_an_array_has_one_bar_though_it_is_drawn_in_two_ways():
    volume = pv.ImageData(dimensions=(20, 20, 20))
    volume["T"] = np.exp(-((np.asarray(volume.points) - 9.5) ** 2).sum(axis=1) / 40)
    surface = pv.Sphere(center=(9.5, 9.5, 30))
    surface["T"] = np.abs(np.asarray(surface.points)[:, 0] - 9.5)
    look = vizlight.look([volume, surface], array="T")
    assert len(look.drawing.keys) == 1


def test_an_array_that_one_of_several_has_is_enough():
    bare = pv.Sphere(theta_resolution=12, phi_resolution=12, center=(3, 0, 0))
    look = vizlight.look([ball(0), bare], array="T", size=SIZE)
    assert [layer.keywords.get("scalars") for layer in look.drawing.layers] == ["T", None]
    with pytest.raises(ValueError, match="array: expected the name of an array, one of"):
        vizlight.look([ball(0), bare], array="U", size=SIZE)
    with pytest.raises(ValueError, match="data: expected a mesh, a file, or several, got none"):
        vizlight.look([])


def test_files_of_one_command_are_one_picture(tmp_path, capsys):
    from vizlight.cli.main import main

    for name, x in (("a", 0), ("b", 3)):
        ball(x).save(tmp_path / f"{name}.vtp")
    files = [str(tmp_path / f"{name}.vtp") for name in "ab"]
    page = tmp_path / "both.html"
    assert main([*files, "-o", str(page)]) == 0
    assert page.stat().st_size
    assert "shown    2 meshes: T in colours" in capsys.readouterr().out
    assert main([*files, "-o", str(page), "--times", "all"]) == 2
    assert "one time for several files in one picture" in capsys.readouterr().err


def test_blocks_of_a_file_are_drawn_each_by_its_rule(tmp_path):
    cloud = pv.PolyData(np.random.default_rng(3).uniform(-1, 1, (40, 3)))
    cloud["q"] = np.arange(40.0) ** 2
    path = tmp_path / "mixed.vtm"
    pv.MultiBlock({"ball": ball(0), "lines": lines(), "cloud": cloud}).save(path)
    look = vizlight.look(path, size=SIZE)
    assert [layer.keywords.get("scalars") for layer in look.drawing.layers] == ["T", None, "q"]
    assert look.mesh.n_blocks == 3
    script = look.script(tmp_path / "a.png")
    assert "parts = files.read_parts(" in script
    exec(script, {})
    with pytest.warns(UserWarning, match="highest dimension; a .vtm file has all blocks"):
        look.save(tmp_path / "ball.vtp")
    assert pv.read(tmp_path / "ball.vtp").n_cells > 0
    # One part is read as any file is.
    pv.MultiBlock({"ball": ball(0)}).save(path)
    assert "vizlight.read(" in vizlight.look(path, size=SIZE).script("a.png")
