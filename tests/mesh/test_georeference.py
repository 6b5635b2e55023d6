"""Maps in degrees as they are on the ground, and how much heights are exaggerated."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from rasterio.crs import CRS
from rasterio.transform import Affine

import vizlight
from vizlight.mesh import georeference


def chart(latitude=60.0, kind=pv.ImageData):
    """Return a map of half a degree with heights in metres."""
    grid = pv.ImageData(
        dimensions=(61, 61, 1), spacing=(1 / 120, 1 / 120, 1), origin=(11, latitude - 0.25, 0)
    )
    x, y, _ = grid.points.T
    grid["height"] = 1000 * np.sin(40 * (x - 11)) + 500 * np.cos(50 * y)
    grid.field_data["unit"] = ["degree"]
    if kind is pv.RectilinearGrid:
        return grid.cast_to_rectilinear_grid()
    return grid if kind is pv.ImageData else grid.cast_to_structured_grid()


def haversine(a, b):
    """Return the length of the great circle between two places in degrees."""
    (x, y), (u, v) = np.radians(a), np.radians(b)
    h = np.sin((v - y) / 2) ** 2 + np.cos(y) * np.cos(v) * np.sin((u - x) / 2) ** 2
    return 2 * 6_371_008.8 * np.arcsin(np.sqrt(h))


@pytest.mark.parametrize("kind", [pv.ImageData, pv.RectilinearGrid, pv.StructuredGrid])
def test_lengths_are_those_on_the_sphere(kind):
    grid = chart(kind=kind)
    moved = georeference.in_metres(grid)
    assert type(moved) is kind
    np.testing.assert_allclose(moved.center, 0, atol=1e-6)
    for end in (60, 3660):
        length = np.linalg.norm(moved.points[end] - moved.points[0])
        assert length == pytest.approx(
            haversine(grid.points[0, :2], grid.points[end, :2]), rel=0.01
        )
    assert georeference.in_metres(moved) is moved


def test_light_of_a_map_in_degrees_is_that_of_the_map_in_metres():
    grid = chart()
    scene = vizlight.Scene(lights=vizlight.Light(direction=(-1, 1, 0.6)))
    t = vizlight.relief_shadow(grid, scene)["t"]
    known = vizlight.relief_shadow(georeference.in_metres(grid), scene)["t"]
    # Compiled code, where it pays by then, rounds otherwise.
    np.testing.assert_allclose(t, known, rtol=0, atol=1e-12)
    assert 0.3 < t.mean() < 0.9
    plain = grid.copy()
    plain.field_data.clear()
    assert abs(vizlight.relief_shadow(plain, scene)["t"] - t).mean() > 0.1


def test_a_relief_that_nobody_sees_is_told_with_its_remedy():
    grid = chart()
    grid["height"] *= 1e-4
    scene = vizlight.Scene(lights=vizlight.Light(direction=(-1, 1, 0.6)))
    with pytest.warns(UserWarning, match=r"range over 5e-06 of its side.*pass exaggeration=10000"):
        flat = vizlight.relief_shadow(grid, scene, lit=True)["luminance"]
    raised = vizlight.relief_shadow(grid, scene, exaggeration=1e4, lit=True)["luminance"]
    assert np.ptp(flat) < 1e-3 < 0.1 < np.ptp(raised)


def test_a_volume_over_a_map_is_stretched_until_it_can_be_seen():
    air = pv.ImageData(dimensions=(5, 5, 4), spacing=(0.1, 0.1, 5.0), origin=(11, 50, 0))
    air.field_data["unit"] = ["degree"]
    before = np.array(air.points)
    factor = georeference.stretch(air)
    x, y, z = vizlight.files.stretched(air, factor).bounds_size
    assert factor == 100
    assert (y, z) == pytest.approx((0.4 * 111_195, 1500), rel=1e-3)
    assert 0.6 < x / y < 0.7  # the cosine of the latitude
    np.testing.assert_array_equal(air.points, before)
    air.field_data.clear()
    assert georeference.stretch(air) == georeference.stretch(pv.Sphere()) == 1
    flat = chart()
    assert georeference.stretch(flat) == 1


def test_a_raised_map_is_in_metres_without_its_holes():
    grid = chart()
    grid["height"][:7] = np.nan
    raised = vizlight.files.warped(grid, "height", 2.0)
    assert raised.points.dtype == np.float64
    assert np.isfinite(raised.points).all()
    assert raised.bounds_size[1] == pytest.approx(0.5 * 111_195, rel=1e-3)
    assert raised.bounds_size[2] == pytest.approx(2 * np.ptp(grid["height"][7:]))


@pytest.mark.parametrize(
    ("scale", "expected"), [(1.0, 1.0), (0.1, 5.0), (1e-4, 5e3), (100.0, 0.05), (0.0, 1.0)]
)
def test_heights_are_exaggerated_until_they_can_be_seen(scale, expected):
    grid = chart()
    grid["height"] *= scale
    grid["height"][5] *= 1e3  # one wrong height does not change the range
    assert georeference.exaggeration(grid, "height") == expected


rasterio = pytest.importorskip("rasterio")

NORTH_UP = Affine(30, 0, 4e5, 0, -20, 5.3e6)
HEIGHTS = np.add.outer(100.0 * np.arange(20), np.arange(40.0))


def written(path, rows, transform=NORTH_UP, crs=32633, **options):
    rows = np.atleast_3d(rows.T).T
    with rasterio.open(
        path, "w", height=rows.shape[1], width=rows.shape[2], count=len(rows), dtype=rows.dtype,
        transform=transform, crs=crs and CRS.from_epsg(crs), **options,
    ) as file:  # fmt: skip
        file.write(rows)
    return path


@pytest.mark.parametrize("dtype", ["uint8", "int16", "uint16", "int32", "float32", "float64"])
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"compress": "deflate"},
        {"compress": "lzw", "predictor": 2},
        {"tiled": True, "blockxsize": 16, "blockysize": 16, "compress": "lzw"},
        {"nodata": 7},
    ],
    ids=lambda options: ",".join(options) or "plain",
)
def test_every_pixel_has_its_height_and_its_place(dtype, options, tmp_path):
    if options.get("predictor") and dtype.startswith("float"):
        options = options | {"predictor": 3}
    heights = np.floor(HEIGHTS / 8).astype(dtype) if dtype == "uint8" else HEIGHTS.astype(dtype)
    mesh = vizlight.read(written(tmp_path / "a.tif", heights, **options))
    assert isinstance(mesh, pv.ImageData)
    column, row = ((mesh.points[:, :2] - (4e5, 5.3e6)) / (30, -20) - 0.5).round(6).T
    expected = heights[row.astype(int), column.astype(int)].astype(float)
    if "nodata" in options:
        expected[expected == 7] = np.nan
    np.testing.assert_array_equal(mesh["elevation"], expected)
    assert mesh.field_data["unit"][0] == "metre"
    assert CRS.from_wkt(mesh.field_data["crs"][0]).to_epsg() == 32633


def test_a_rotated_raster_stays_rotated(tmp_path):
    c, s = np.cos(0.35), np.sin(0.35)
    turn = Affine(30 * c, 20 * s, 4e5, 30 * s, -20 * c, 5.3e6)
    mesh = vizlight.read(written(tmp_path / "a.tif", HEIGHTS, turn))
    assert isinstance(mesh, pv.StructuredGrid)
    x, y, _ = mesh.points[mesh["elevation"].argmax()]
    np.testing.assert_allclose(x - 4e5, 30 * c * 39.5 + 20 * s * 19.5)
    np.testing.assert_allclose(y - 5.3e6, 30 * s * 39.5 - 20 * c * 19.5)
    # Its heights are those of the array, not the z of the level grid.
    sun = vizlight.Scene(lights=vizlight.Light(direction=(-1, 0, 0.3)))
    assert np.ptp(vizlight.relief_shadow(mesh, sun)["t"]) > 0.01


def test_bands_and_colours_have_their_names(tmp_path):
    bands = np.stack([HEIGHTS, HEIGHTS / 2]).astype(np.float32)
    assert vizlight.read(written(tmp_path / "a.tif", bands)).point_data.keys() == [
        "band_1",
        "band_2",
    ]
    with rasterio.open(tmp_path / "a.tif", "r+") as file:
        file.set_band_description(1, "depth")
        file.scales, file.offsets = (0.5, 1), (10, 0)
    mesh = vizlight.read(tmp_path / "a.tif")
    assert mesh.point_data.keys() == ["depth", "band_2"]
    assert mesh["depth"].max() == HEIGHTS.max() / 2 + 10
    colors = np.stack([HEIGHTS % 250, HEIGHTS % 200, HEIGHTS % 100]).astype(np.uint8)
    picture = vizlight.read(written(tmp_path / "b.tif", colors, photometric="rgb"))
    assert picture.point_data.keys() == ["rgb"]
    assert picture["rgb"].shape == (800, 3)


@pytest.mark.filterwarnings("ignore:The given matrix is equal")
def test_degrees_are_found_by_the_reference_system_or_by_steep_heights(tmp_path):
    degrees = Affine(1 / 1200, 0, 11, 0, -1 / 1200, 60)
    told = vizlight.read(written(tmp_path / "a.tif", HEIGHTS, degrees, 4326))
    seen = vizlight.read(written(tmp_path / "b.tif", HEIGHTS, degrees, None))
    pixels = vizlight.read(written(tmp_path / "c.tif", HEIGHTS, Affine.identity(), None))
    assert [mesh.field_data.get("unit", [""])[0] for mesh in (told, seen, pixels)] == [
        "degree", "degree", "",
    ]  # fmt: skip
    # The first row of a picture is its top.
    assert pixels.points[pixels["elevation"].argmin(), 1] == 19.5


def test_a_grid_of_ascii(tmp_path):
    path = tmp_path / "a.asc"
    path.write_text(
        "ncols 3\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 2\nNODATA_value -9\n1 2 3\n4 -9 6\n"
    )
    mesh = vizlight.read(path)
    np.testing.assert_array_equal(mesh["elevation"], [4, np.nan, 6, 1, 2, 3])
    assert tuple(mesh.origin[:2]) == (11, 21)


def test_complex_numbers_are_no_heights(tmp_path):
    with pytest.raises(vizlight.files.FileError, match="no band of numbers"):
        vizlight.read(written(tmp_path / "a.tif", HEIGHTS.astype(np.complex64)))
