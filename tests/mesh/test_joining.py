"""Blocks are joined with all their arrays, whatever their types and places."""

import numpy as np
import pytest
import pyvista as pv
from pyvista.examples import cells

import vizlight
from vizlight import Scene, View
from vizlight.mesh import blocks, joining

SCENE = Scene(view=View(direction=(1, 1, 1)))


def volume(x=0.0, **arrays):
    grid = pv.ImageData(dimensions=(4, 4, 4), origin=(x, 0, 0)).cast_to_unstructured_grid()
    for name, rows in arrays.items():
        grid.point_data[name] = rows(grid.points)
    return grid


def heat(points):
    return points[:, 0] + 1


def middles(mesh):
    """Return the middle of each cell along y."""
    return [np.mean(mesh.get_cell(i).bounds[2:4]) for i in range(mesh.n_cells)]


def test_an_array_that_a_block_lacks_is_nan_there():
    found = joining.joined([(volume(T=heat), "fluid"), (volume(10), "solid")])
    T = found.grid.point_data["T"]
    np.testing.assert_array_equal(T[:64], volume(T=heat)["T"])
    assert np.isnan(T[64:]).all()
    assert len(T) == 128
    assert found.filled == {"T": ["solid"]}
    assert "'T' (solid)" in found.note()


@pytest.mark.parametrize(
    ("kinds", "expected"),
    [(("f4", "f8"), "f8"), (("i4", "f4"), "f8"), (("u1", "i2"), "i2"), (("i8", "i8"), "i8")],
)
def test_types_are_promoted_to_one_that_holds_all_values(kinds, expected):
    parts = [
        (volume(10 * i, T=lambda p, kind=kind: p[:, 0].astype(kind)), "")
        for i, kind in enumerate(kinds)
    ]
    found = joining.joined(parts)
    assert found.grid["T"].dtype == np.dtype(expected)
    np.testing.assert_array_equal(found.grid["T"], found.grid.points[:, 0])
    assert not found.note()


def test_values_of_cells_are_brought_to_the_points_where_another_block_has_points():
    means = volume(10)
    means.cell_data["T"] = np.full(means.n_cells, 7.0)
    labels = volume(20)
    labels.cell_data["T"] = np.full(labels.n_cells, 5, dtype=np.int32)
    grid = joining.joined([(volume(T=heat), ""), (means, ""), (labels, "")]).grid
    assert "T" not in grid.cell_data
    np.testing.assert_allclose(grid.point_data["T"][64:128], 7)
    np.testing.assert_allclose(grid.point_data["T"][128:], 5)


def test_a_field_at_points_and_cells_stays_at_both():
    both = [volume(10.0 * i, T=heat) for i in range(2)]
    for mesh in both:
        mesh.cell_data["T"] = mesh.cell_centers().points[:, 0]
    grid = joining.joined((mesh, "") for mesh in both).grid
    np.testing.assert_allclose(grid.cell_data["T"], grid.cell_centers().points[:, 0])
    np.testing.assert_allclose(grid.point_data["T"], heat(grid.points))


def test_arrays_of_other_components_are_told_apart():
    small = pv.ImageData(dimensions=(2, 2, 2), origin=(10, 0, 0))
    small["T"] = np.ones((8, 3))
    found = joining.joined([(volume(T=heat), "fluid"), (small, "solid")])
    assert found.apart == {"T": ["solid"]}
    assert np.isnan(found.grid["T"][64:]).all()
    assert "solid" in found.note()


def test_points_and_cells_of_all_kinds_of_datasets_keep_their_order():
    parts = [
        pv.ImageData(dimensions=(3, 3, 3)),
        pv.PolyData(np.array([[9.0, 0, 0], [9, 1, 1]])),
        pv.PolyData(),
        pv.Sphere(center=(20, 0, 0), theta_resolution=8, phi_resolution=8),
        cells.Polyhedron(),
        pv.RectilinearGrid([0.0, 1, 3], [0.0, 1], [5.0, 6]),
    ]
    for mesh in parts:
        if mesh.n_points:
            mesh.point_data["x"] = np.array(mesh.points)[:, 0].astype(float)
            mesh.cell_data["y"] = middles(mesh)
    grid = joining.joined((mesh, "") for mesh in parts).grid
    assert grid.points.dtype == np.float64
    np.testing.assert_array_equal(grid.point_data["x"], grid.points[:, 0])
    np.testing.assert_allclose(grid.cell_data["y"], middles(grid), atol=1e-6)


def test_colours_without_a_value_are_grey_and_words_are_empty():
    coloured = volume(c=lambda p: np.full((len(p), 3), 255, np.uint8))
    coloured["word"] = np.array(["a"] * 64)
    grid = joining.joined([(coloured, ""), (volume(10), "")]).grid
    np.testing.assert_array_equal(np.unique(grid["c"][64:]), [128])
    assert grid["c"].dtype == np.uint8
    assert list(grid["word"][[0, 64]]) == ["a", ""]


def test_fields_that_all_share_and_the_active_vectors_stay():
    parts = [volume(U=lambda p: p * 1.0), volume(10)]
    for mesh in parts:
        mesh.field_data["unit"] = ["degree"]
    parts[0].point_data.active_vectors_name = "U"
    parts[1].field_data["only"] = [1]
    grid = joining.joined((mesh, "") for mesh in parts).grid
    assert [*grid.field_data] == ["unit"]
    assert grid.point_data.active_vectors_name == "U"
    for part in parts:
        part.point_data["N"] = np.ones((part.n_points, 3), np.float32)
    for part, expected in zip(parts, (None, "N"), strict=True):
        part.point_data.active_normals_name = "N"
        grid = joining.joined((mesh, "") for mesh in parts).grid
        assert grid.point_data.active_normals_name == expected


def test_hidden_cells_of_one_block_stay_hidden():
    hidden = pv.ImageData(dimensions=(4, 4, 4)).cast_to_structured_grid().hide_cells([0, 1])
    found = joining.joined([(volume(10), ""), (hidden, "")])
    np.testing.assert_array_equal(np.flatnonzero(found.grid.cell_data["vtkGhostType"]), [27, 28])
    assert not found.note()


def test_cells_of_highest_dimension_alone():
    mixed = volume().merge(pv.Line((10, 0, 0), (11, 0, 0)))
    image = pv.ImageData(dimensions=(2, 2, 2))
    kept = joining.highest([(mixed, "m"), (pv.Sphere(), "s"), (image, "i")])
    assert [name for _, name in kept] == ["m", "i"]
    assert kept[0][0].n_cells == 27
    lone = [(pv.PolyData(), ""), (pv.PointSet(np.zeros((2, 3))), "")]
    assert joining.highest(lone) == lone


def test_of_no_blocks_nothing_is_joined():
    assert blocks.one_grid(pv.MultiBlock()).n_points == 0


def test_a_wall_that_is_left_out_costs_no_array(tmp_path):
    wall = pv.Plane(center=(0, 1.5, 1.5), direction=(1, 0, 0), i_size=3, j_size=3)
    wall.clear_data()
    wall["shear"] = np.ones(wall.n_points)
    pv.MultiBlock({"inner": volume(T=heat), "wall": wall}).save(tmp_path / "b.vtm")
    with pytest.warns(UserWarning, match="left out: wall"):
        found = vizlight.read(tmp_path / "b.vtm")
    np.testing.assert_array_equal(found["T"], volume(T=heat)["T"])


def test_reading_notes_once_what_was_filled(tmp_path):
    pv.MultiBlock({"fluid": volume(T=heat), "solid": volume(10)}).save(tmp_path / "b.vtm")
    with pytest.warns(UserWarning, match=r"lack arrays.*'T' \(solid\)") as notes:
        found = vizlight.read(tmp_path / "b.vtm")
    assert len(notes) == 1
    assert np.isnan(found["T"]).sum() == 64


def test_places_in_textures_are_filled_without_a_note(tmp_path):
    blocks = pv.MultiBlock({"fluid": volume(TEXCOORD_0=heat), "solid": volume(10)})
    blocks.save(tmp_path / "b.vtm")
    assert "TEXCOORD_0" in vizlight.read(tmp_path / "b.vtm").point_data


def test_lines_stay_in_the_block_that_has_the_flow():
    flow = volume(U=lambda p: np.tile([1.0, 0, 0], (len(p), 1)))
    lines = vizlight.streamlines(pv.MultiBlock([flow, volume(10)]), SCENE, tangents="U", seeds=5)
    assert lines.n_lines == 5
    assert lines.bounds[1] <= 3.001


@pytest.mark.parametrize("made", ["tint", "legibility", "gltf"])
def test_a_block_without_the_array_is_drawn_without_data(made, tmp_path):
    balls = [pv.Sphere(center=(x, 0, 0), theta_resolution=8, phi_resolution=8) for x in (0, 2)]
    for ball in balls:
        ball.clear_data()
    balls[0]["T"] = balls[0].points[:, 2]
    lit = vizlight.illuminate(pv.MultiBlock(balls), SCENE)
    if made == "tint":
        grey = vizlight.tint(lit, "T")[1]["rgb"]
        assert np.ptp(grey, axis=1).max() == 0
    elif made == "gltf":
        lamp = Scene(lights=vizlight.Light(direction=(0, 0, 1)))
        vizlight.save_gltf(pv.MultiBlock(balls), tmp_path / "b.glb", scene=lamp, scalars="T")
        assert (tmp_path / "b.glb").stat().st_size
    else:
        vizlight.legibility(lit, SCENE, scalars="T", view=SCENE.view)
    with pytest.raises(ValueError, match="'S'"):
        vizlight.tint(lit, "S")
