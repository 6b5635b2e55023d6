"""GeoTIFF and other rasters: heights, holes and places, or an error; never other numbers."""

import numpy as np
import pytest
import pyvista as pv
from refusals import read_warned, refused, saved

import vizlight
from vizlight.mesh import georeference, meaning

rasterio = pytest.importorskip("rasterio")
from rasterio.crs import CRS  # noqa: E402
from rasterio.transform import Affine  # noqa: E402

pytestmark = pytest.mark.usefixtures("without_trial")

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
    # Bytes are the numbers of a picture.
    np.testing.assert_array_equal(mesh["a" if dtype == "uint8" else "elevation"], expected)
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
    assert abs(vizlight.relief_shadow(mesh, sun)["t"] - 0.3 / np.hypot(1, 0.3)).min() > 0.01


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
    with rasterio.open(tmp_path / "a.tif", "r+") as file:
        file.set_band_description(2, "depth")
    assert vizlight.read(tmp_path / "a.tif").point_data.keys() == ["depth", "depth_2"]
    colors = np.stack([HEIGHTS % 250, HEIGHTS % 200, HEIGHTS % 100]).astype(np.uint8)
    picture = vizlight.read(written(tmp_path / "b.tif", colors, photometric="rgb"))
    assert picture.point_data.keys() == ["rgb"]
    assert picture["rgb"].shape == (800, 3)


def test_bands_of_a_satellite_are_a_picture_beside_themselves(tmp_path):
    names = ["B02", "B03", "B04", "B08"]
    path = written(tmp_path / "a.tif", np.stack([HEIGHTS + 1000 * i for i in range(4)]))
    with rasterio.open(path, "r+") as file:
        file.descriptions = names
    look = vizlight.look(path)
    assert look.mesh["rgb"].dtype == np.uint8
    assert look.summary.startswith("B04, B03, B02 as red, green and blue")
    assert [other.array for other in look.others] == names


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


@pytest.mark.parametrize("kind", ["complex64", "complex_int16"])
def test_complex_numbers_are_no_heights(tmp_path, kind):
    place = rasterio.Affine(2, 0, 0, 0, -2, 0)
    size = {"height": 4, "width": 5, "count": 1, "transform": place}
    with rasterio.open(tmp_path / "a.tif", "w", driver="GTiff", dtype=kind, **size) as file:
        file.write(np.ones((1, 4, 5), dtype=np.complex64))
    refused(tmp_path / "a.tif", "no band of numbers")


@pytest.mark.filterwarnings("ignore::rasterio.errors.NotGeoreferencedWarning")
def test_pixels_without_a_place_have_no_unit_of_one(tmp_path):
    path = tmp_path / "a.tif"
    size = {"height": 4, "width": 5, "count": 1, "dtype": "uint8", "crs": "EPSG:4326"}
    with rasterio.open(path, "w", driver="GTiff", **size) as file:
        file.write(np.arange(20, dtype=np.uint8).reshape(1, 4, 5))
    assert "unit" not in vizlight.read(path).field_data


@pytest.mark.filterwarnings("ignore::rasterio.errors.NotGeoreferencedWarning")
def test_a_picture_of_a_camera_is_no_relief(tmp_path):
    rows = {"": HEIGHTS.astype(np.uint16)[None], "bytes": (HEIGHTS / 8).astype(np.uint8)[None]}
    rows["bands"] = np.concatenate([rows[""], 2 * rows[""]])
    shown = {}
    # A model of a camera has a system of reference, and values without a picture are masked.
    cases = {
        "cells": {"transform": None, "crs": None},
        "model": {"transform": None, "nodata": 0},
        "bytes": {},
        "bands": {},
        "ground": {},
    }
    for name, options in cases.items():
        path = written(tmp_path / f"{name}.tif", rows.get(name, rows[""]), **options)
        look = vizlight.look(path)
        is_gray = "gray" in str(look.drawing.keys[0].get("cmap"))
        shown[name] = (look.question, look.notes[0].partition(",")[0], is_gray)
    # Tones of a smooth picture are in no bands between isolines.
    assert shown == {
        "cells": ("none", "x to the right", True),
        "model": ("none", "x to the right", True),
        "bytes": ("none", "x east in metre by the reference system", True),
        "bands": ("none", "x east in metre by the reference system", True),
        "ground": ("relief", "x east in metre by the reference system", False),
    }


@pytest.mark.parametrize(
    ("name", "rows"),
    [
        ("scene_B4", HEIGHTS),
        ("wide_counts", 1e6 * HEIGHTS),
        ("ndvi_2020", HEIGHTS / 1e4),
        ("a", HEIGHTS * 40),
        ("population-density", HEIGHTS),
    ],
)
def test_a_band_of_a_satellite_is_no_relief(tmp_path, name, rows):
    of_name = {"ndvi": np.float32, "wide": np.uint32}
    kind = of_name.get(name.partition("_")[0], np.uint16)
    look = vizlight.look(written(tmp_path / f"{name}.tif", rows.astype(kind)[None]))
    assert (look.question, look.array) == ("none", name)


@pytest.mark.parametrize(
    ("size", "crs", "pixel", "name"),
    [(1e-3, 32633, 300, "balance"), (1e-3, 4326, 1e-3, "balance"), (1e-3, 32633, 0.5, "elevation"),
     (1.0, 32633, 300, "elevation")],
)  # fmt: skip
def test_a_slight_range_on_a_wide_map_is_none_of_heights(size, crs, pixel, name, tmp_path):
    place = Affine(pixel, 0, 10, 0, -pixel, 50)
    mesh = vizlight.read(written(tmp_path / "balance.tif", size * HEIGHTS - 1, place, crs))
    assert mesh.point_data.keys() == [name]


def test_a_band_beside_colours_has_its_own_unit(tmp_path):
    path = written(tmp_path / "a.tif", np.arange(120, dtype=np.uint8).reshape(4, 5, 6))
    with rasterio.open(path, "r+") as file:
        colors = rasterio.enums.ColorInterp
        file.colorinterp = [colors.red, colors.green, colors.blue, colors.undefined]
        file.units = ["", "", "", "K"]
        file.set_band_description(4, "heat")
    mesh = vizlight.read(path)
    assert {"rgb", "heat"} <= set(mesh.point_data)
    assert meaning.of(mesh).arrays == {"heat": {"units": "K"}}


def pages(path, values, **options):
    """Write pages of a TIFF file."""
    from PIL import Image

    first, *others = map(Image.fromarray, values)
    first.save(path, save_all=True, append_images=others, **options)
    return path


def test_pages_of_images_are_a_volume(tmp_path, random):
    values = random.integers(0, 255, (12, 5, 6)).astype(np.uint8)
    volume = vizlight.read(pages(tmp_path / "cells.tif", values))
    assert volume.dimensions == (6, 5, 12)
    # The first page is on top, and the first row of each is its upper edge.
    np.testing.assert_array_equal(
        volume["cells"].reshape(12, 5, 6), values[::-1, ::-1], strict=True
    )
    words = "ImageJ=1.53\nimages=12\nslices=12\nunit=micron\nspacing=0.5\n"
    volume = vizlight.read(
        pages(tmp_path / "scaled.tif", values, description=words, x_resolution=10, y_resolution=10)
    )
    assert volume.spacing == pytest.approx((0.1, 0.1, 0.5))


def test_numbers_of_a_scan_count_from_black_to_white(tmp_path):
    # A file without a place, of which the writer warns.
    with pytest.warns(rasterio.errors.NotGeoreferencedWarning):
        path = written(
            tmp_path / "scan.tif", np.array([[0, 1]], np.uint8), Affine.identity(), None, nbits=1,
            photometric="MINISWHITE",
        )  # fmt: skip
    assert vizlight.read(path)["scan"].tolist() == [1, 0]


def test_a_palette_of_many_colours_is_a_picture(tmp_path):
    path = written(tmp_path / "earth.tif", np.arange(256, dtype=np.uint8).reshape(8, 32))
    with rasterio.open(path, "r+") as file:
        file.write_colormap(1, {number: (number, 7, 255 - number) for number in range(256)})
    mesh = vizlight.read(path)
    assert mesh["rgb"].shape == (256, 3)
    np.testing.assert_array_equal(mesh["rgb"][:, 2], 255 - mesh["rgb"][:, 0])


def test_pages_of_several_sizes_are_told(tmp_path):
    path = pages(tmp_path / "a.tif", [np.zeros((4, 5), "u1"), np.zeros((3, 5), "u1")])
    assert read_warned(path, "the first of 2 pages is read").dimensions == (5, 4, 1)


def test_a_raster_of_heights_without_a_system_is_in_metres(tmp_path):
    head = "ncols 4\nnrows 3\nxllcorner 361015\nyllcorner 70223\ncellsize 10\n"
    rows = "\n".join(" ".join(f"{9.5 * i + j:g}" for j in range(4)) for i in range(3))
    mesh = vizlight.read(saved(tmp_path / "a.asc", head + rows))
    assert georeference.unit_of(mesh) == "metre"
    assert meaning.of(mesh).arrays["elevation"]["units"] == "m"
    assert "taken for metres" in meaning.line(mesh)


def test_what_an_elevation_model_misses_is_nan(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    from rasterio import shutil

    rows = np.arange(600, dtype=np.int16).reshape(20, 30) + 100
    rows[0, :4] = -32767
    place = rasterio.Affine(30, 0, 500_000, 0, -30, 5_100_000)
    kind = {"width": 30, "height": 20, "count": 1, "dtype": "int16", "nodata": -32767}
    with rasterio.open(
        tmp_path / "a.tif", "w", driver="GTiff", crs="EPSG:26710", transform=place, **kind
    ) as file:
        file.write(rows, 1)
    shutil.copy(tmp_path / "a.tif", tmp_path / "a.dem", driver="USGSDEM")
    mesh = vizlight.read(tmp_path / "a.dem")
    heights = np.asarray(mesh["elevation"]).reshape(mesh.dimensions[1::-1])[-20:]
    # Rows of the mesh run north; the format begins a profile one row lower.
    assert np.isnan(heights[-1, :4]).all()
    np.testing.assert_array_equal(heights[-1, 4:], rows[0, 4:])
    assert str(mesh.field_data["unit"][0]) == "metre"


def test_corners_in_degrees_and_minutes_are_read_whole(tmp_path):
    """GDAL reads 12 degrees of 12°40'E."""
    head = "ncols 4\nnrows 2\nxllcorner {}\nyllcorner {}\ncellsize 0.1\nNODATA_value -9999\n"
    rows = "5 6 7 8\n1 2 3 4\n"
    for x, y, corner in (
        ("12°40'E", "47°50'30\"N", (12 + 2 / 3, 47 + 50.5 / 60)),
        ("70°30'W", "33°15'S", (-70.5, -33.25)),
        ("12.5", "-47.25", (12.5, -47.25)),
    ):
        path = tmp_path / "a.asc"
        path.write_text(head.format(x, y) + rows, encoding="utf-8")
        mesh = vizlight.read(path)
        np.testing.assert_allclose(mesh.bounds[::2][:2], np.add(corner, 0.05), atol=1e-6)
