"""Tests of volumes without the corner toward the eye, and of scans that are cut open."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import files


def head(size=40, air=0.0):
    """Scan of a ball with a dark shell under its skin, a cavity, and a neck that the scan cuts."""
    scan = pv.ImageData(dimensions=(size, size, size), origin=(-(size - 1) / 2,) * 3)
    radius = np.linalg.norm(scan.points, axis=1)
    values = np.select([radius < 3, radius < 12, radius < 13, radius < 15], [0, 100, 0, 90], 0)
    neck = (np.linalg.norm(np.asarray(scan.points)[:, :2], axis=1) < 8) & (scan.points[:, 2] < -8)
    values[neck & (radius > 12)] = 80
    scan["T1"] = values + air + np.arange(scan.n_points) % 5
    return scan


@pytest.mark.parametrize("air", [0.0, -1000.0])
@pytest.mark.parametrize("toward", [(1, 1, 1), (-1, 2, -0.5)])
def test_the_corner_toward_the_eye_is_taken_out_of_a_body(air, toward):
    scan = head(air=air)
    before = np.array(scan["T1"])
    parts = files.cut_open(scan, "T1", toward=toward)
    np.testing.assert_array_equal(scan["T1"], before)
    skin, cut, signs = parts["skin"], parts["cut"], np.sign(toward)
    places = np.asarray(skin.points)
    round_part = places[places[:, 2] > -5]
    np.testing.assert_allclose(np.linalg.norm(round_part, axis=1), 15, atol=1)
    # The middle of the body is below that of the ball.
    middle = np.array([0.5, 0.5, -1.5])
    assert ((places - middle) * signs).min(axis=1).max() == pytest.approx(0, abs=1.01)
    np.testing.assert_allclose(cut["T1"], cut.sample(scan)["T1"], atol=1e-3)
    # The cavity and the dark shell are seen in the cut, and the neck where the scan ends.
    radius = np.linalg.norm(cut.points, axis=1)
    assert cut["T1"][radius < 2].max() < air + 6
    assert cut["T1"][radius < 10].max() > air + 99
    assert (cut["T1"][(radius > 12.1) & (radius < 12.9)] < air + 60).any()
    assert (cut.points[:, 2] == scan.bounds[4]).any()


def test_axes_that_are_turned_are_those_of_the_scan():
    scan = head()
    turned = scan.copy()
    turned.direction_matrix = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]
    plain, other = (
        files.cut_open(each, "T1", toward=toward)["skin"].points @ matrix
        for each, toward, matrix in (
            (scan, (1, 1, 1), np.eye(3)),
            (turned, (1, -1, 1), np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])),
        )
    )
    assert plain.shape == other.shape


def test_what_stands_in_no_air_is_a_box_without_skin():
    scan = head()
    scan["T1"] = np.arange(scan.n_points) % 97.0
    parts = files.cut_open(scan, "T1")
    assert not parts["skin"].n_points
    assert parts["cut"].bounds == scan.bounds
    assert vizlight.look(scan).summary.startswith("slices of T1")


def test_only_scans_are_cut_open():
    with pytest.raises(TypeError, match=r"volume: expected a pyvista\.ImageData, got"):
        files.cut_open(pv.Sphere(), "T1")
    with pytest.raises(ValueError, match="name: expected a point array"):
        files.cut_open(head(), "T2")
    sheet = pv.ImageData(dimensions=(4, 4, 1))
    sheet["T1"] = np.arange(16.0)
    with pytest.raises(ValueError, match="volume: expected an image of two points at least along"):
        files.cut_open(sheet, "T1")


def shell(toward, level=None, *, low=False):
    """Return the parts of a ball of values in a block, and the grid."""
    grid = pv.ImageData(dimensions=(33, 31, 29), origin=(-16, -15, -14)).cast_to_unstructured_grid()
    grid["v"] = np.linalg.norm(grid.points, axis=1) * (1 if low else -1)
    before = grid.copy()
    parts = files.without_corner(grid, "v", level, toward=toward)
    assert grid == before
    return parts["cut"], parts["outside"], grid


@pytest.mark.parametrize("toward", [(1, 1, 1), (-1, 2, -0.5), (0, -1, 0.05), (1, 1, 0)])
def test_a_block_has_the_area_and_the_values_of_one_without_a_corner(toward):
    cut, outside, grid = shell(toward)
    signs = np.where(np.abs(toward) < 0.2 * np.abs(toward).max(), 0, np.sign(toward))
    for part in (cut, outside):
        # Nothing is left in the corner, and values are those of the grid.
        depths = (np.asarray(part.points) * signs)[:, signs != 0].min(axis=1)
        assert depths.max() == pytest.approx(0, abs=1e-5)
        np.testing.assert_allclose(part["v"], part.sample(grid)["v"], atol=0.05)
    # A corner takes as much from the sides as its own faces have; a half less.
    area = grid.extract_surface(algorithm="dataset_surface").area
    x, y, z = sizes = np.array([32.0, 30.0, 28.0])
    faces = np.array([y * z, x * z, x * y]) / 2.0 ** (np.sum(signs != 0) - 1)
    ends = np.prod(sizes) / sizes * 2 / 2.0 ** np.sum(signs != 0)
    removed = (faces * (signs != 0)).sum() + (ends * (signs == 0)).sum()
    assert cut.area == pytest.approx((faces * (signs != 0)).sum(), rel=1e-4)
    assert outside.area == pytest.approx(area - removed, rel=1e-4)


@pytest.mark.parametrize("low", [False, True])
def test_what_an_isosurface_encloses_is_cut_whichever_side_is_inside(low):
    radius = 10.0
    cut, outside, _ = shell((1, 1, 1), radius if low else -radius, low=low)
    assert cut.area == pytest.approx(0.75 * np.pi * radius**2, rel=0.02)
    assert outside.area == pytest.approx(3.5 * np.pi * radius**2, rel=0.02)
    assert np.abs(outside["v"]) == pytest.approx(radius, abs=1e-4)
    assert np.linalg.norm(outside.points, axis=1) == pytest.approx(radius, abs=0.1)


def test_what_the_volume_cuts_off_is_closed():
    grid = pv.ImageData(dimensions=(21, 21, 21)).cast_to_rectilinear_grid()
    grid["v"] = -np.linalg.norm(grid.points[:, :2] - 10, axis=1)
    outside = files.without_corner(grid, "v", -5.0)["outside"]
    assert outside.bounds[4:] == (0.0, 20.0)
    # The upper end lacks a quarter, the mantle an eighth.
    area = np.pi * 25 * 1.75 + 2 * np.pi * 5 * 20 * 7 / 8
    assert outside.area == pytest.approx(area, rel=0.02)


def test_whole_numbers_are_on_all_parts_with_values_between_them():
    grid = pv.ImageData(dimensions=(21, 21, 21))
    grid["v"] = np.minimum(30 - 2 * np.linalg.norm(grid.points - 10, axis=1), 25).astype(np.int16)
    parts = files.without_corner(grid, "v", 8.5)
    # Of corners of the box above the level, and of the isosurface.
    assert parts["outside"]["v"].min() == pytest.approx(8.5)
    assert parts["cut"]["v"].min() == pytest.approx(8.5)
    assert grid["v"].dtype == np.int16


def test_values_of_cells_stay_those_of_their_cells():
    grid = pv.ImageData(dimensions=(5, 5, 5))
    grid.cell_data["v"] = np.arange(64.0)
    parts = files.without_corner(grid, "v")
    for part in (parts["cut"], parts["outside"]):
        assert set(part.cell_data["v"]) <= set(range(64))


def test_with_a_level_values_of_cells_are_averaged_and_holes_are_left_out():
    grid = pv.ImageData(dimensions=(21, 21, 21))
    grid.cell_data["v"] = -np.linalg.norm(grid.cell_centers().points - 10, axis=1)
    parts = files.without_corner(grid, "v", -6.0)
    assert np.linalg.norm(parts["outside"].points - 10, axis=1) == pytest.approx(6, abs=0.3)
    grid = grid.cell_data_to_point_data()
    grid["v"][grid.points[:, 2] > 12] = np.nan
    parts = files.without_corner(grid, "v", -6.0)
    for each in (parts, files.without_corner(grid, "v")):
        for part in (each["cut"], each["outside"]):
            assert np.isfinite(part.points).all()
            assert np.isfinite(part["v"]).all()
            assert part.bounds[5] == 12


def test_a_level_that_nothing_reaches_leaves_nothing():
    parts = files.without_corner(pv.ImageData(dimensions=(5, 5, 5)).elevation(), "Elevation", 9.0)
    assert not parts["cut"].n_points
    assert not parts["outside"].n_points


@pytest.mark.parametrize(
    ("keywords", "error", "text"),
    [
        ({"volume": pv.Sphere()}, ValueError, "volume: expected a mesh with solid cells"),
        ({"volume": 3}, TypeError, "volume: expected a pyvista.DataSet with solid cells"),
        ({"name": "w"}, ValueError, "name: expected a point array of one component"),
        ({"level": np.nan}, ValueError, "level: expected"),
        ({"toward": (0, 0, 0)}, ValueError, "toward: expected"),
    ],
)
def test_bad_input_of_a_cut_is_named(keywords, error, text):
    grid = pv.ImageData(dimensions=(5, 5, 5))
    grid["v"] = np.arange(125.0)
    options = {"volume": grid, "name": "v"} | keywords
    with pytest.raises(error, match=text):
        files.without_corner(options.pop("volume"), options.pop("name"), **options)
