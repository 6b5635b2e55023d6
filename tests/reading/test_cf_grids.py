"""Grids of netCDF and of xarray: one field has one picture, however its file spells it."""

import sys

import numpy as np
import pytest
import pyvista as pv
from refusals import refused, saved

import vizlight
from vizlight import cartography, files
from vizlight.looks.recipes.drawing import titled
from vizlight.mesh import dates, meaning, projections
from vizlight.reading import series

xr = pytest.importorskip("xarray")
pytest.importorskip("cf_xarray")

pytestmark = pytest.mark.usefixtures("without_trial")

ROWS, COLUMNS = 8, 12
HEIGHTS = np.random.default_rng(0).random((ROWS, COLUMNS)).astype(np.float32) * 500
LAT, LON = 47 + np.arange(ROWS) / 100, -0.05 + np.arange(COLUMNS) / 100
#: Spellings of each axis: its name, the attributes that tell, and what they leave open.
X = [
    ("lon", {}), ("longitude", {}), ("x", {"units": "degrees_east"}), ("i", {"units": "degree_E"}),
    ("x", {"long_name": "Longitude", "units": "degrees"}), ("q", {"standard_name": "longitude"}),
    ("nlon", {"axis": "X", "units": "degrees_east"}),
]  # fmt: skip
Y = [
    ("lat", {}), ("latitude", {}), ("y", {"units": "degrees_north"}), ("j", {"units": "degreeN"}),
    ("y", {"long_name": "Latitude", "units": "degrees"}), ("p", {"standard_name": "latitude"}),
    ("nlat", {"axis": "Y", "units": "degrees_north"}),
]  # fmt: skip


def one_spelling(seed):
    """Return a dataset of HEIGHTS in a random spelling."""
    random = np.random.default_rng(seed)
    (x, x_words), (y, y_words) = X[random.integers(len(X))], Y[random.integers(len(Y))]
    values, lat, lon = HEIGHTS.astype(np.float64), LAT, LON
    if random.random() < 0.5:
        values, lat = values[::-1], lat[::-1]
    if random.random() < 0.5:
        values, lon = values[:, ::-1], lon[::-1]
    lon = [lon, lon % 360, lon - 360][random.integers(3)]
    words = {"units": "m", "long_name": "height"}
    kind = random.integers(4)
    if kind == 1:
        values, words = values / 1000, words | {"units": "km"}
    if kind == 2:
        values, words = 300 - values, words | {
            "standard_name": "sea_floor_depth_below_geoid", "positive": "down"
        }  # fmt: skip
    data = xr.Dataset(
        {"z": ((y, x), values, words)}, coords={y: (y, lat, y_words), x: (x, lon, x_words)}
    )
    if kind == 3:
        data["z"].encoding.update(dtype="i2", scale_factor=0.1, _FillValue=-32768)
    return data.transpose(x, y) if random.random() < 0.5 else data


@pytest.mark.sampled(3)
@pytest.mark.parametrize("seed", range(120))
def test_one_field_in_many_spellings(seed, tmp_path):
    data = one_spelling(seed)
    data.to_netcdf(tmp_path / "a.nc")
    mesh = vizlight.read(tmp_path / "a.nc")
    assert mesh.dimensions == (COLUMNS, ROWS, 1), data
    assert mesh.field_data["unit"][0] == "degree", data
    np.testing.assert_allclose(mesh.bounds[:4], [LON[0], LON[-1], LAT[0], LAT[-1]], atol=1e-4)
    z = np.asarray(mesh["z"]).reshape(ROWS, COLUMNS)
    np.testing.assert_allclose(z - z[0, 0], HEIGHTS - HEIGHTS[0, 0], atol=0.11, err_msg=str(data))


def axes_of(**sizes):
    return {name: (name, *parts) for name, parts in sizes.items()}


def grid(variables, coords, **options):
    return vizlight.read(xr.Dataset(variables, coords), **options)


def test_names_that_are_not_of_utf_8(tmp_path):
    netcdf = pytest.importorskip("scipy.io").netcdf_file
    with netcdf(tmp_path / "a.nc", "w") as file:
        for name in "yx":
            file.createDimension(name, 3)
        band = file.createVariable("band", "f4", ("y", "x"))
        band[:] = np.arange(9).reshape(3, 3)
        setattr(band, "Bandwidth (\xb5m)", "35")
    np.testing.assert_array_equal(vizlight.read(tmp_path / "a.nc")["band"], np.arange(9))


def test_lengths_in_kilometres_and_what_the_axes_are():
    x, y = {"units": "km", "axis": "X"}, {"units": "km", "axis": "Y"}
    mesh = grid(
        {"z": (("y", "x"), HEIGHTS)},
        axes_of(x=(np.arange(COLUMNS) * 2.0, x), y=(np.arange(ROWS) * 2.0, y)),
    )
    assert mesh.bounds[1] == 22_000
    assert mesh.field_data["unit"][0] == "metre"
    assert meaning.line(mesh) == "x 'x' in m by axis, from km, y 'y' in m by axis, from km"


@pytest.mark.parametrize(("unit", "scale"), [("rad", 1.0), ("microradian", 1e6)])
def test_angles_of_a_satellite_are_lengths_of_its_plane(unit, scale):
    x, y = (np.array([0.0, 0.05, 0.1]) * scale, {"units": unit}), (LAT[:2] * scale, {"units": unit})
    system = {"grid_mapping_name": "geostationary", "perspective_point_height": 1e6}
    fields = {"t": (("y", "x"), 300 * HEIGHTS[:2, :3])}
    mesh = grid(fields | {"system": ((), 0, system)}, axes_of(x=x, y=y))
    np.testing.assert_allclose(mesh.bounds[:4], (0.0, 1e5, LAT[0] * 1e6, LAT[1] * 1e6))
    assert str(mesh.field_data["unit"][0]) == "metre"
    assert str(mesh.field_data["crs"][0]) == "+proj=geos +h=1000000 +sweep=y"
    mesh = grid(fields, axes_of(x=x, y=y))
    assert "unit" not in mesh.field_data
    assert "angles of a scan without a known projection, no degrees" in meaning.line(mesh)


def test_begin_and_end_of_a_time_are_no_steps():
    fields = {"t": (("lat", "lon"), HEIGHTS), "time_bounds": ("number_of_time_bounds", [0.0, 6.0])}
    time = {"units": "hours since 2001-01-01", "bounds": "time_bounds"}
    mesh = grid(fields, {"lat": LAT, "lon": LON, "time": ((), 3.0, time)})
    assert series.of(mesh) == [3.0]
    assert meaning.of(mesh).span == [0.0, 6.0]


@pytest.mark.parametrize(
    ("place", "words", "height", "of_height", "section"),
    [
        ("lat", {}, "plev", {"units": "Pa"},
         [("latitude", "degrees"), ("pressure", "hPa", -1.0)]),
        ("lon", {}, "depth", {"units": "m", "positive": "down"},
         [("longitude", "degrees"), ("depth", "m", -1.0)]),
        ("x", {"units": "km", "long_name": "distance"}, "z", {"units": "km"},
         [("distance", "m"), ("height", "m")]),
        ("x", {"units": "m"}, "pressure", {"units": "dbar"},
         [("x", "m"), ("pressure", "dbar", -100.0)]),
        ("x", {}, "lev", {"units": "1", "long_name": "sigma"}, [("x",), ("sigma", "", -1.0)]),
    ],
)  # fmt: skip
def test_a_section_has_the_scales_of_its_axes(place, words, height, of_height, section):
    axes = axes_of(**{place: (np.arange(20.0), words), height: (np.arange(1.0, 15.0), of_height)})
    mesh = grid({"t": ((height, place), np.outer(np.arange(14.0), np.arange(20.0)))}, axes)
    assert meaning.of(mesh).section == [meaning.AxisScale(*scale) for scale in section]
    assert not mesh.bounds_size[2]


@pytest.mark.parametrize(
    ("unit", "step", "read_in", "end"),
    [
        ("seconds since 2001-03-01", 1800, "hours since 2001-03-01", 9.5),
        ("hours since 2001-03-01 06:00", 6, "days since 2001-03-01 06:00", 4.75),
        ("months since 2001-03-01", 1, "months since 2001-03-01", 19.0),
    ],
)
def test_the_time_of_a_mast_is_an_axis(unit, step, read_in, end):
    axes = axes_of(
        time=(np.arange(20.0) * step, {"units": unit}), depth=(np.arange(10.0), {"units": "m"})
    )
    axes |= {"lat": ("lat", [50.0]), "lon": ("lon", [8.0])}
    values = np.outer(np.arange(20.0), np.arange(10.0)).reshape(20, 10, 1, 1)
    mesh = grid({"t": (("time", "depth", "lat", "lon"), values)}, axes)
    assert mesh.bounds[:4] == pytest.approx((0, end, -9, 0))
    assert meaning.of(mesh).section[0] == meaning.AxisScale("time", read_in)
    assert series.of(mesh) == []
    np.testing.assert_allclose(mesh["t"].reshape(10, 20)[0], 9 * np.arange(20))


@pytest.mark.parametrize(
    ("other", "unit", "titles"),
    [
        ("lat", "degrees_north", ["time", "latitude"]),
        ("lon", "degrees_east", ["longitude", "time"]),
    ],
)
def test_values_over_time_and_one_axis_are_a_section(other, unit, titles):
    """As in a diagram of Hovmoller time rises along longitudes; a time that is chosen is none."""
    times = (np.arange(4.0), {"units": "days since 2001-03-01", "calendar": "noleap"})
    axes = axes_of(time=times, **{other: (np.arange(5.0), {"units": unit})})
    fields = {"height": (("time", other), np.outer(np.arange(4.0), np.arange(5.0)))}
    mesh = grid(fields, axes)
    said = meaning.of(mesh)
    assert [scale.title for scale in said.section] == titles
    scale = said.section[titles.index("time")]
    assert scale.unit == "days since 2001-03-01, noleap calendar"
    assert mesh["height"][mesh.find_closest_point((3, 3, 0))] == 9
    assert series.of(mesh) == []
    # Along time there is no ground for heights.
    assert vizlight.look(mesh).question == "none"


@pytest.mark.parametrize(
    ("name", "values", "words", "span", "lowest"),
    [
        ("level", [100_000.0, 85_000, 50_000], {"units": "Pa"}, (-1000, -500), 0),
        ("pressure_lev", [10.0, 500, 1000], {}, (-1000, -10), 2),
        ("depth", [1.0, 2, 5], {"units": "km", "positive": "down"}, (-5000, -1000), 2),
        ("depth", [1.0, 2, 5], {"units": "km", "standard_name": "depth"}, (-5000, -1000), 2),
        ("depth", [1.0, 2, 5], {"units": "km"}, (-5000, -1000), 2),
    ],
)
def test_pressure_falls_upward_and_depths_are_negative(name, values, words, span, lowest):
    mesh = grid(
        {"t": ((name, "lat", "lon"), np.arange(3.0)[:, None, None] * np.ones((3, 4, 5)))},
        axes_of(**{name: (values, words)}, lat=(np.arange(4.0),), lon=(np.arange(5.0),)),
    )
    assert mesh.bounds[4:] == span
    assert mesh["t"][np.argmin(mesh.points[:, 2])] == lowest
    assert ("pressure in hPa that falls upward" in meaning.line(mesh)) == (words == {"units": "Pa"})


@pytest.mark.parametrize(("sign", "is_down"), [(1, True), (-1, False)])
def test_a_bathymetry_that_is_mostly_above_0_counts_down(sign, is_down):
    depths = sign * np.arange(-3.0, 17).reshape(4, 5)
    mesh = grid({"h": (("y", "x"), depths, {"long_name": "Final bathymetry", "units": "m"})}, {})
    expected = -depths if is_down else depths
    assert sorted(mesh["h"]) == sorted(expected.ravel())


def test_the_first_place_with_data_is_taken_along_further_axes():
    values = np.full((2, 3, 4, 5), np.nan)
    values[1, 2] = 7
    mesh = grid({"t": (("direction", "frequency", "y", "x"), values)}, {})
    assert set(mesh["t"]) == {7.0}
    said = " ".join(meaning.of(mesh).notes)
    assert "first with data of direction" in said
    assert "first with data of frequency" in said


def test_longitudes_across_zero_and_around_the_earth():
    lon = (np.arange(20) * 1.0 + 350) % 360
    mesh = grid({"t": (("lat", "lon"), np.arange(60.0).reshape(3, 20))}, axes_of(
        lat=(np.arange(3.0),), lon=(lon,)
    ))  # fmt: skip
    np.testing.assert_allclose(mesh.bounds[:2], [-10, 9])
    np.testing.assert_array_equal(mesh["t"], np.arange(60))
    around = grid({"t": (("lat", "lon"), np.arange(36.0).reshape(3, 12))}, axes_of(
        lat=(np.arange(3.0),), lon=(np.arange(12) * 30.0,)
    ))  # fmt: skip
    assert around.dimensions == (13, 3, 1)
    assert around.bounds[1] == 360
    np.testing.assert_array_equal(
        around["t"].reshape(3, 13)[:, 0], around["t"].reshape(3, 13)[:, -1]
    )


def turned(angle):
    """Return longitudes and latitudes near the equator of a grid that is turned."""
    x, y = np.meshgrid(np.arange(COLUMNS) * 0.1, np.arange(ROWS) * 0.1)
    cos, sin = np.cos(angle), np.sin(angle)
    return cos * x - sin * y, sin * x + cos * y


@pytest.mark.parametrize(("name", "along"), [("x_wind", True), ("eastward_wind", False)])
def test_coordinates_of_each_point_and_winds_along_the_grid(name, along):
    lon, lat = turned(0.5)
    names = {"u": name, "v": name.replace("x_", "y_").replace("east", "north")}
    wind = {
        key: (("j", "i"), np.full(lon.shape, value), {"standard_name": names[key]})
        for key, value in (("u", 2.0), ("v", 0.0))
    }
    places = {"nav_lon": (("j", "i"), lon), "nav_lat": (("j", "i"), lat)}
    mesh = grid(wind | places, {})
    assert isinstance(mesh, pv.StructuredGrid)
    np.testing.assert_allclose(mesh.points[:, 0], lon.ravel(), atol=1e-6)
    rows = files.with_vectors(mesh, "u,v")["u,v"]
    way = [2 * np.cos(0.5), 2 * np.sin(0.5), 0] if along else [2, 0, 0]
    np.testing.assert_allclose(rows, np.tile(way, (lon.size, 1)), atol=1e-3)


@pytest.mark.parametrize("words", ["{}-wind component", "{} at 10 M"])
def test_winds_of_wrf_are_along_the_grid(words):
    lon, lat = turned(0.5)
    place = ("south_north", "west_east")
    data = {"XLONG": (place, lon, {"units": "degree_east"}),
            "XLAT": (place, lat, {"units": "degree_north"})}  # fmt: skip
    for name, value in (("U", 2.0), ("V", 0.0)):
        said = {"description": words.format("xy"[name == "V"]), "units": "m s-1"}
        data[name] = (place, np.full(lon.shape, value), said)
    mesh = vizlight.read(xr.Dataset(data, attrs={"MAP_PROJ": 1}))
    rows = files.with_vectors(mesh, "U,V")["U,V"]
    np.testing.assert_allclose(rows[:, :2], np.tile([2 * np.cos(0.5), 2 * np.sin(0.5)], (96, 1)),
                               atol=1e-3)  # fmt: skip


def test_a_table_of_kinds_of_values_is_no_volume():
    random = np.random.default_rng(0)
    rows = random.random((4, 20, 30)) + np.reshape([0, 40, -7, 900], (4, 1, 1))
    table = xr.Dataset({"s": (("ncl0", "ncl1", "ncl2"), rows)})
    with pytest.raises(ValueError, match="'s' is a table of 4 kinds of values along 'ncl0'"):
        vizlight.read(table)
    assert vizlight.read(table, at={"ncl0": 1})["s"].min() >= 40
    assert vizlight.read(table - rows.mean(axis=(1, 2), keepdims=True)).dimensions == (30, 20, 4)
    named = table.rename(ncl0="z", ncl1="y", ncl2="x")
    assert vizlight.read(named).dimensions == (30, 20, 4)


def test_cells_at_a_place_that_is_missing_are_left_out():
    lon, lat = turned(0.5)
    lon[0, 0] = lat[0, 0] = -999
    data = {"t": (("j", "i"), HEIGHTS), "lon": (("j", "i"), lon), "lat": (("j", "i"), lat)}
    mesh = grid(data, {})
    assert mesh.bounds[0] > -1
    assert (
        mesh.extract_surface(algorithm="dataset_surface").n_cells == (ROWS - 1) * (COLUMNS - 1) - 1
    )


def test_a_rotated_pole_is_where_proj_says():
    """The longitudes and latitudes are those of PROJ's ob_tran."""
    x = (np.array([-20.0, 0, 25]), {"standard_name": "grid_longitude", "units": "degrees"})
    y = (np.array([-15.0, 0, 20]), {"standard_name": "grid_latitude", "units": "degrees"})
    pole = {"grid_mapping_name": "rotated_latitude_longitude",
            "grid_north_pole_latitude": 39.25, "grid_north_pole_longitude": -162.0}  # fmt: skip
    data = {"t": (("rlat", "rlon"), np.zeros((3, 3))), "pole": ((), 0, pole)}
    mesh = grid(data, axes_of(rlon=x, rlat=y))
    expected = [[-5.095065, 32.625073, 0], [18, 50.75, 0], [73.397696, 61.152862, 0]]
    np.testing.assert_allclose(np.asarray(mesh.points)[[0, 4, 8]], expected, atol=1e-5)
    # Places that are all missing are none.
    full = {name: (("rlat", "rlon"), np.full((3, 3), 9.97e36)) for name in ("lon", "lat")}
    mesh = grid(data | full, axes_of(rlon=x, rlat=y))
    np.testing.assert_allclose(np.asarray(mesh.points)[[0, 4, 8]], expected, atol=1e-5)


def test_members_and_times_without_since():
    values = np.arange(6.0).reshape(2, 3, 1, 1) * np.ones((1, 1, 4, 5))
    coords = axes_of(forecast_hour=([10.0, 20.0],), number=([7, 8, 9],))
    data = {"t": (("forecast_hour", "number", "y", "x"), values)}
    assert grid(data, coords)["t"][0] == 3
    zonal = {"t": (("basins", "z_t", "lat_t"), np.arange(24.0).reshape(2, 3, 4))}
    assert grid(zonal, {})["t"].max() == 11
    mesh = grid(data, coords, time=10, at={"number": 9})
    assert mesh["t"][0] == 2
    assert mesh.field_data["TimeSteps"].tolist() == [10, 20]
    assert "number 9" in meaning.line(mesh)
    with pytest.raises(ValueError, match="at: no axis 'member', but forecast_hour, number"):
        grid(data, coords, at={"member": 1})


def test_dates_of_datasets_in_memory_need_no_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "cftime", None)
    time = np.array(["1999-12-31T18:00", "2000-01-03"], "datetime64[ns]")
    data = {"t": (("time", "y", "x"), np.arange(2.0).reshape(2, 1, 1) * np.ones((2, 4, 5)))}
    mesh = grid(data, axes_of(time=(time,)), time="2000-01-03")
    assert mesh["t"][0] == 1
    assert np.diff(mesh.field_data["TimeSteps"]).tolist() == [54]
    assert dates.date(mesh.field_data["TimeValue"][0], meaning.of(mesh).time) == "2000-01-03 00:00"


def test_dates_of_wrf_are_texts(tmp_path):
    data = xr.Dataset({"t": (("Time", "y", "x"), np.zeros((2, 4, 5)))})
    data["Times"] = ("Time", np.array(["2005-09-21_00:00:00", "2005-09-21_03:00:00"], "S19"))
    data["XTIME"] = ("Time", [0.0, 180.0])
    data.to_netcdf(tmp_path / "a.nc")
    for source in (data, tmp_path / "a.nc"):
        mesh = vizlight.read(source, time="2005-09-21 03")
        assert dates.date(mesh.field_data["TimeValue"][0], meaning.of(mesh).time).endswith("03:00")
    # Files of what has no time, as of a ground, have one of zeros.
    ground = data.isel(Time=[0]).drop_vars("XTIME")
    ground["Times"] = ("Time", np.array(["0000-00-00_00:00:00"], "S19"))
    assert vizlight.read(ground)["t"].shape == (20,)


def test_dates_of_steps_and_of_an_only_time():
    pytest.importorskip("cftime")
    clock = {"units": "days since 2001-01-01", "calendar": "360_day"}
    data = {"t": (("time", "y", "x"), np.arange(2.0).reshape(2, 1, 1) * np.ones((2, 4, 5)))}
    coords = axes_of(time=([0.0, 59.0], clock))
    assert dates.date(59, meaning.of(grid(data, coords)).time) == "2001-02-30 00:00"
    assert grid(data, coords, time="2001-01-01")["t"][0] == 0
    with pytest.raises(ValueError, match="expected a time of a step"):
        grid(data, coords, time="2001-01-02")
    moment = xr.Dataset(data, coords).isel(time=1)
    assert vizlight.read(moment).field_data["TimeValue"][0] == 59


def test_texts_at_the_places_of_a_grid_are_no_hindrance(tmp_path):
    names = np.array([[b"one", b"two"]] * 3)
    data = xr.Dataset({"t": (("y", "x"), np.arange(6.0).reshape(3, 2))}, axes_of(y=(range(3),)))
    data.assign_coords(names=(("y", "x"), names)).to_netcdf(tmp_path / "a.nc")
    np.testing.assert_array_equal(vizlight.read(tmp_path / "a.nc")["t"], np.arange(6))


@pytest.mark.parametrize(
    ("name", "attributes", "scale", "step", "unit"),
    [
        ("data", {}, 4000, 1e-3, "m"),
        ("data", {}, 14000, 1e-3, "ft"),
        ("Band1", {"long_name": "GDAL Band Number 1"}, 4000, 1e-3, "m"),
        ("data", {}, 40000, 1e-3, ""),
        ("data", {}, 90, 1e-3, ""),
        ("data", {"units": "K"}, 4000, 1e-3, ""),
        ("data", {}, 4000, 0.5, ""),
        ("rain", {}, 4000, 1e-3, ""),
    ],
)
def test_an_only_array_without_a_name_on_a_fine_map_is_of_the_ground(
    name, attributes, scale, step, unit
):
    rows = scale * np.linspace(0, 1, 40).reshape(5, 8)
    coords = {
        "lat": ("lat", 40 + step * np.arange(5), {"units": "degrees_north"}),
        "lon": ("lon", 10 + step * np.arange(8), {"units": "degrees_east"}),
    }
    mesh = grid({name: (("lat", "lon"), rows, attributes)}, coords)
    assert ("taken for heights" in meaning.line(mesh)) == bool(unit)
    if unit:
        np.testing.assert_allclose(mesh[name], rows.ravel() * (0.3048 if unit == "ft" else 1))
        assert meaning.of(mesh).arrays[name] == {"long_name": "elevation", "units": "m"}
        rows[1, :3] = -32768
        with pytest.warns(UserWarning, match="are -32768"):
            mesh = grid({name: (("lat", "lon"), rows, attributes)}, coords)
        assert "taken for heights" in meaning.line(mesh)


@pytest.mark.parametrize(
    ("words", "title", "high", "step", "unit"),
    [
        ({"long_name": "z"}, "", 2000, 1 / 60, "degree"),
        ({}, "", 2000, 5000.0, "metre"),
        ({}, "grdreformat elevation.nc", 300, 5000.0, "metre"),
        ({}, "", 300, 5000.0, ""),
        ({}, "", 2000, 1.0, ""),
        ({"long_name": "Geopotential"}, "", 2000, 1 / 60, ""),
        ({"units": "mGal"}, "", 2000, 1 / 60, ""),
    ],
)
def test_z_is_a_ground_by_its_range_or_by_words_of_its_file(words, title, high, step, unit):
    rows = high * np.linspace(-1, 1, 40).reshape(5, 8)
    rows[0, :3] = np.nan
    coords = {"y": step * np.arange(5), "x": step * np.arange(8)}
    data = xr.Dataset({"z": (("y", "x"), rows, words)}, coords, {"history": title})
    mesh = vizlight.read(data)
    heights = meaning.of(mesh).arrays.get("z", {}).get("long_name") == "elevation"
    assert heights == bool(unit)
    if unit:
        assert mesh.field_data["unit"][0] == unit
        assert vizlight.look(data, size=(90, 60)).question == "relief"


@pytest.mark.parametrize("kind", ["f2", "longdouble", "O", ">f4"])
def test_numbers_of_types_that_vtk_lacks(kind):
    rows = np.arange(20.0).reshape(4, 5)
    mesh = grid({"t": (("y", "x"), rows.astype(kind))}, axes_of())
    np.testing.assert_array_equal(mesh["t"], rows.ravel())


def test_durations_are_numbers_and_complex_numbers_are_left_out():
    spans = (np.arange(20) * 86_400 * 10**9).astype("m8[ns]").reshape(4, 5)
    data = {"t": (("y", "x"), spans, {"units": "K"}), "z": (("y", "x"), np.full((4, 5), 1j))}
    mesh = grid(data, axes_of())
    np.testing.assert_array_equal(mesh["t"], np.arange(20))
    assert "complex numbers: z" in meaning.line(mesh)
    with pytest.raises(ValueError, match=r"no variable .* \(left out, complex numbers: z"):
        grid({"z": data["z"]}, axes_of())


@pytest.mark.parametrize(
    "lon", [np.arange(0, 411, 10.0), np.r_[np.arange(0, 181, 10.0), np.arange(-180, 1, 10.0)]]
)
def test_a_second_turn_and_a_meridian_that_stands_twice_are_one(lon):
    rows = np.cos(np.radians(lon)) * np.ones((3, 1))
    mesh = grid({"t": (("lat", "lon"), rows)}, {"lat": [0.0, 1, 2], "lon": lon})
    assert mesh.bounds_size[0] == 360
    x = np.asarray(mesh.points)[:, 0]
    np.testing.assert_allclose(mesh["t"], np.cos(np.radians(x)), atol=1e-6)


def test_places_of_zero_are_none():
    y, x = np.mgrid[20:30, 5:17] + 0.0
    lon, lat = x + 0.1 * y, y + 0.1 * x
    lon[2:4, 3:6] = lat[2:4, 3:6] = 0
    data = {"t": (("j", "i"), x), "lon": (("j", "i"), lon), "lat": (("j", "i"), lat)}
    mesh = vizlight.read(xr.Dataset(data))
    assert mesh.compute_cell_sizes()["Area"].max() < 1.1


def test_a_true_place_of_zero_is_one_beside_others_that_are_none():
    y, x = np.mgrid[-5:6, -5:6] + 0.0
    lon, lat = x + 0.2 * y, y + 0.1 * x
    lon[0, 8:] = lat[0, 8:] = 0
    data = {"t": (("j", "i"), x), "lon": (("j", "i"), lon), "lat": (("j", "i"), lat)}
    mesh = vizlight.read(xr.Dataset(data))
    # Only the corner is left out, not the cells around the place in the middle.
    assert mesh.n_cells == 100 - 3
    assert np.min(np.linalg.norm(np.asarray(mesh.points)[:, :2], axis=1)) < 1e-12


def test_the_shown_step_is_the_last_that_has_data():
    rows = np.full((3, 2, ROWS, COLUMNS), np.nan)
    rows[1, 1], rows[0, 0] = 7, 5
    hours = {"units": "hours", "standard_name": "forecast_period"}
    clock = {"units": "days since 2001-01-01"}
    coords = axes_of(time=([0, 1, 2], clock), step=([0, 6], hours), lat=(LAT,), lon=(LON,))
    data = {"t": (("time", "step", "lat", "lon"), rows)}
    mesh = grid(data, coords)
    assert mesh["t"].max() == 7
    assert mesh.field_data["TimeValue"][0] == 1
    assert np.isnan(grid(data, coords, time="last")["t"]).all()
    assert np.isnan(grid({"t": (data["t"][0], 0 * rows * np.nan)}, coords)["t"]).all()


def test_the_places_of_a_face_go_before_names_of_its_rows_and_columns():
    lat, lon = np.meshgrid(LAT, LON, indexing="ij")
    lats = np.stack([lat + 0.1 * lon, -lat + 0.3 * lon])
    lons = np.stack([lon + 0.2 * lat, lon + 90])
    dims = ("face", "Ydim", "Xdim")
    data = {"t": (dims, np.stack([lat, lon])), "lats": (dims, lats), "lons": (dims, lons)}
    coords = axes_of(Ydim=(LAT, {"units": "degrees_north"}), Xdim=(LON, {"units": "degrees_east"}))
    for face in (0, 1):
        mesh = grid(data, coords, at={"face": face})
        np.testing.assert_allclose(mesh.points[:, 1], lats[face].ravel(), atol=1e-6)
        np.testing.assert_array_equal(mesh["t"], data["t"][1][face].ravel())


def of_sphere(places):
    """Return directions of longitudes and latitudes in degrees, and their east and north."""
    lon, lat = np.radians(places[..., 0]), np.radians(places[..., 1])
    up = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1)
    east = np.stack([-np.sin(lon), np.cos(lon), 0 * lon], axis=-1)
    return up, east, np.cross(up, east)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("count", [12, 13])
def test_winds_on_the_face_of_a_cube_around_a_pole(count, side):
    """Solid rotation is rotation at every point: at a node at the pole, and in a cell around it."""
    axis = np.tan(np.linspace(-np.pi / 4, np.pi / 4, count))
    x, y = np.meshgrid(axis, axis)
    lon, lat = np.degrees(np.arctan2(y, x)) + 5, side * np.degrees(np.arctan2(1, np.hypot(x, y)))
    up, east, north = of_sphere(np.stack([lon, lat], axis=-1))
    about = np.array([0.3, -0.5, 0.8])
    wind = np.cross(about, up)
    row = np.gradient(up, axis=1, edge_order=2)
    row /= np.linalg.norm(row, axis=-1, keepdims=True)
    ways = {"eastward": east, "northward": north, "x": row, "y": np.cross(up, row)}
    data = {
        key[0]: (("nj", "ni"), (wind * way).sum(axis=-1), {"standard_name": f"{key}_wind"})
        for key, way in ways.items()
    }
    data |= {"lon": (("nj", "ni"), lon % 360, {}), "lat": (("nj", "ni"), lat, {})}
    mesh = vizlight.read(xr.Dataset(data))
    up, east, north = of_sphere(np.asarray(mesh.points))
    right = np.cross(about, up)
    for u, v in ((mesh["e"], mesh["n"]), np.transpose(mesh["x,y"])[:2]):
        drawn = u[:, np.newaxis] * east + v[:, np.newaxis] * north
        off = np.linalg.norm(drawn - right, axis=1)
        assert off.max() < 0.03
        assert np.median(off) < 1e-3


@pytest.mark.parametrize(
    ("text", "units", "unit"),
    [
        ('GEOGCS["WGS 84",UNIT["degree",0.0174]]', "m", "degree"),
        ('PROJCS["UTM",GEOGCS["WGS 84",UNIT["degree",0.0174]],UNIT["metre",1]]', "", "metre"),
        (
            'PROJCS["S",GEOGCS["N",UNIT["degree",1]],UNIT["US survey foot",0.3048]]',
            "",
            "metre",
        ),
    ],
)
def test_the_text_of_a_reference_system_tells_the_unit(text, units, unit):
    words = {"units": units} if units else {}
    coords = axes_of(y=(LAT, words), x=(LON, words)) | {"crs": ((), 0, {"crs_wkt": text})}
    mesh = grid({"t": (("y", "x"), HEIGHTS)}, coords)
    assert mesh.field_data["unit"][0] == unit
    scale = 1200 / 3937 if "foot" in text else 1
    assert mesh.bounds[3] == pytest.approx(scale * LAT[-1])


def test_two_files_of_one_wind(tmp_path):
    for name in "uv":
        data = {name: (("lat", "lon"), np.ones((ROWS, COLUMNS)))}
        xr.Dataset(data, axes_of(lat=(LAT,), lon=(LON,))).to_netcdf(tmp_path / f"{name}.nc4")
    mesh = vizlight.read(tmp_path / "u.nc4", overlay=tmp_path / "v.nc4")
    assert meaning.components(mesh) == [("u", "v")]
    other = xr.Dataset(
        {"v": (("lat", "lon"), np.ones((3, 4)))}, axes_of(lat=(LAT[:3],), lon=(LON[:4],))
    )
    other.to_netcdf(tmp_path / "w.nc")
    with pytest.raises(files.FileError, match=r"its overlay '.*w\.nc' is a grid of other points"):
        vizlight.read(tmp_path / "u.nc4", overlay=tmp_path / "w.nc")


def test_a_range_that_the_file_states():
    data = {"t": (("y", "x"), np.array([[0.0, 1], [2, 99]]), {"valid_range": [0.0, 10.0]})}
    assert np.isnan(grid(data, {})["t"]).tolist() == [False, False, False, True]


def test_a_store_of_zarr(tmp_path):
    pytest.importorskip("zarr")
    data = xr.Dataset({"t": (("y", "x"), HEIGHTS)}, coords={"y": LAT, "x": LON})
    data.to_zarr(tmp_path / "a.zarr", consolidated=False)
    data.to_netcdf(tmp_path / "a.nc")
    one, other = (vizlight.read(tmp_path / name) for name in ("a.zarr", "a.nc"))
    np.testing.assert_allclose(one.points, other.points)


@pytest.mark.parametrize(("name", "package"), [("a.grib", "cfgrib"), ("a.zarr", "zarr")])
def test_the_way_to_read_grib_and_zarr(tmp_path, name, package, monkeypatch):
    # Another process would have the package.
    monkeypatch.setitem(sys.modules, package, None)
    refused(saved(tmp_path / name, b"GRIB"), f"are read by {package}: run pip install '{package}'")


def test_series_of_times_are_refused_as_such():
    time = ("time", np.arange(4.0), {"units": "days since 2000-01-01"})
    rain = {f"rain_{i}": ("time", np.arange(4.0) + i) for i in range(3)}
    with pytest.raises(ValueError, match=r"it has 3 series of times, such as 'rain_2', without"):
        vizlight.read(xr.Dataset(rain, {"time": time}))


def test_values_in_a_list_are_no_image():
    nodes = xr.Dataset({"sst": (("nz", "nod2"), np.zeros((4, 30)))})
    with pytest.raises(ValueError, match="no variable on a grid of two or three axes"):
        vizlight.read(nodes)


@pytest.mark.parametrize("turned", [0, 1])
def test_a_list_that_stands_row_by_row_is_a_grid(turned):
    lon, lat = np.meshgrid(170.0 + 5 * np.arange(5), np.array([10.0, 4, 1, 0]))
    values = lat + 100 * lon
    values[1::2] = values[1::2, ::-1] if turned else values[1::2]
    data = {"t": (("points",), values.ravel(), {"GRIB_alternativeRowScanning": turned})}
    coords = {"lon": ("points", (lon.ravel() + 180) % 360 - 180), "lat": ("points", lat.ravel())}
    mesh = grid(data, coords)
    assert mesh.dimensions == (5, 4, 1)
    np.testing.assert_allclose(mesh["t"], mesh.points[:, 1] + 100 * mesh.points[:, 0])


def test_a_grid_that_bends_on_its_way_around_the_earth_shows_no_part_twice():
    lon, lat = np.meshgrid(np.arange(0.0, 361, 10), np.arange(-45.0, 46, 10))
    lon = lon + np.where(lat > 0, lat, 0)
    data = {"t": (("j", "i"), np.cos(np.radians(lon)) + lat)}
    mesh = grid(data, {"lon": (("j", "i"), lon % 360), "lat": (("j", "i"), lat)})
    assert mesh.bounds[:2] == (-180, 180)
    # At the date line values are between those of the columns beside it.
    expected = np.cos(np.radians(mesh.points[:, 0])) + mesh.points[:, 1]
    np.testing.assert_allclose(mesh["t"], expected, atol=0.02)


def test_a_mapping_that_xarray_cannot_decode_names_no_axis(tmp_path):
    data = xr.Dataset({"t": (("lat", "lon"), np.arange(12.0).reshape(3, 4))},
                      {"lat": [0.0, 1, 2], "lon": [0.0, 1, 2, 3]})  # fmt: skip
    data["t"].attrs["grid_mapping"] = "rotated pole: latitude: 40. longitude 12"
    data.to_netcdf(tmp_path / "a.nc")
    assert vizlight.read(tmp_path / "a.nc")["t"].tolist() == list(range(12))


def test_the_lowest_layer_of_the_air_and_the_highest_of_the_sea_are_shown():
    values = np.arange(24.0).reshape(3, 2, 4)
    places = {"lat": ("lat", [50.0, 51], {"units": "degrees_north"}),
              "lon": ("lon", [0.0, 1, 2, 3], {"units": "degrees_east"})}  # fmt: skip
    for axis, which, expected in (
        (("level", [200.0, 500, 850], {"units": "millibars"}), "lowest", values[2]),
        (("hybrid", [1.0, 2, 3], {"positive": "down"}), "lowest", values[2]),
        (("depth", [5.0, 100, 400], {"units": "m", "positive": "down"}), "highest", values[0]),
    ):
        data = xr.Dataset({"t": ((axis[0], "lat", "lon"), values)}, {axis[0]: axis} | places)
        look = vizlight.look(data, size=(90, 60))
        assert look.shown == "sheet"
        assert any(f"the {which} of 3 layers is shown" in note for note in look.notes)
        np.testing.assert_array_equal(np.unique(look.mesh["t"]), expected.ravel())
        assert "files.layer_of(" in look.script("a.png")
        assert vizlight.look(data, "shape", size=(90, 60)).shown != "sheet"


def test_a_layer_without_data_is_passed_over():
    values = np.arange(24.0).reshape(3, 2, 4)
    values[0] = 0.0  # the wind through the ground
    places = {"lat": ("lat", [50.0, 51], {"units": "degrees_north"}),
              "lon": ("lon", [0.0, 1, 2, 3], {"units": "degrees_east"})}  # fmt: skip
    height = {"height": ("height", [0.0, 10, 20], {"units": "m", "axis": "Z"})}
    data = xr.Dataset({"w": (("height", "lat", "lon"), values)}, height | places)
    look = vizlight.look(data, size=(90, 60))
    assert any("the lowest with data of 3 layers is shown, at 10 along z" in n for n in look.notes)
    np.testing.assert_array_equal(np.unique(look.mesh["w"]), values[1].ravel())


def test_a_grid_says_in_which_projection_it_is_straight():
    """A model's grid without coordinates along its axes, and one in lengths with its mapping."""
    cone = {"MAP_PROJ": 1, "TRUELAT1": 30.0, "TRUELAT2": 60.0, "STAND_LON": 10.0}
    x, y = np.meshgrid(np.arange(-4, 5) * 1e5, np.arange(-3, 4) * 1e5)
    plane = projections.of_text(projections.of_attributes(cone))
    lon, lat = plane.inverse(np.column_stack([x.ravel(), y.ravel()])).T
    rows = {"t": x, "XLONG": lon.reshape(x.shape), "XLAT": lat.reshape(x.shape)}
    rows = {name: (("j", "i"), values) for name, values in rows.items()}
    flat = cartography.chart(vizlight.read(xr.Dataset(rows, attrs=cone)))
    np.testing.assert_allclose(flat.bounds[:4], (-4e5, 4e5, -3e5, 3e5), atol=1)
    pole = {"grid_mapping_name": "polar_stereographic", "latitude_of_projection_origin": 90.0}
    axes = axes_of(
        x=(x[0], {"standard_name": "projection_x_coordinate", "units": "m"}),
        y=(y[:, 0], {"standard_name": "projection_y_coordinate", "units": "m"}),
    )
    mesh = grid({"t": (("y", "x"), x), "polar": ((), 0, pole)}, axes)
    assert str(mesh.field_data["crs"][0]) == "+proj=stere +lat_0=90"
    assert str(mesh.field_data["unit"][0]) == "metre"


def test_a_table_that_is_larger_than_a_field_is_not_shown(tmp_path):
    data = {
        "weights": (("links", "parts"), np.random.default_rng(0).random((500, 4))),
        "t": (("lat", "lon"), HEIGHTS),
    }
    xr.Dataset(data, coords={"lat": LAT, "lon": LON}).to_netcdf(tmp_path / "a.nc")
    mesh = vizlight.read(tmp_path / "a.nc")
    assert mesh.n_points == HEIGHTS.size
    assert "t" in mesh.array_names


@pytest.mark.parametrize("in_file", [True, False])
def test_a_step_has_the_bounds_of_its_time(tmp_path, in_file):
    data = xr.Dataset(
        {"t": (("time", "lat", "lon"), np.arange(24.0).reshape(2, 3, 4), {"units": "K"})},
        coords={
            "time": ("time", [12.0, 36.0], {"units": "hours since 2001-01-01", "bounds": "spans"}),
            "lat": ("lat", [40.0, 41, 42]), "lon": ("lon", [5.0, 6, 7, 8]),
        },
    )  # fmt: skip
    data["spans"] = ("time", "ends"), [[0.0, 24.0], [24.0, 48.0]]
    if in_file:
        data.to_netcdf(tmp_path / "means.nc")
    mesh = vizlight.read(tmp_path / "means.nc" if in_file else data, time="first")
    assert meaning.of(mesh).span == [0.0, 24.0]
    del data["time"].attrs["bounds"]
    assert meaning.of(vizlight.read(data)).span == []


def test_fake_places_are_left_out_for_true_ones():
    lon, lat = np.meshgrid(np.linspace(-50.0, 30.0, 9), np.linspace(-40.0, 40.0, 7))
    fake = {"units": "degrees_east", "long_name": "Fake Longitude for GrADS Compatibility"}
    data = xr.Dataset(
        {"t": (("nf", "Ydim", "Xdim"), np.stack([lon, lon]))},
        coords={
            "Xdim": ("Xdim", np.arange(9.0), fake),
            "Ydim": ("Ydim", np.arange(7.0), fake | {"units": "degrees_north"}),
            "lons": (("nf", "Ydim", "Xdim"), np.stack([lon + lat / 9] * 2), X[2][1]),
            "lats": (("nf", "Ydim", "Xdim"), np.stack([lat] * 2), Y[2][1]),
        },
    )
    assert vizlight.read(data).bounds_size[:2] == pytest.approx((80 + 80 / 9, 80.0))


@pytest.mark.parametrize(
    ("asked", "index", "note"),
    [
        (0, 2, "s_rho -0.1, the value nearest to 0; its index is 2"),
        ("0", 2, "s_rho -0.1, the value nearest to 0; its index is 2"),
        (1, 1, "s_rho -0.5"),
        (-0.9, 0, "s_rho -0.9"),
        ("last", 2, "s_rho -0.1"),
    ],
)
def test_a_number_within_the_values_of_an_axis_is_the_nearest_of_them(asked, index, note):
    values = np.stack([HEIGHTS, HEIGHTS + 100, HEIGHTS + 200])
    axes = {"s_rho": np.array([-0.9, -0.5, -0.1]), "lat": LAT, "lon": LON}
    mesh = grid({"t": (("s_rho", "lat", "lon"), values)}, axes, at={"s_rho": asked})
    assert mesh["t"].min() == HEIGHTS.min() + 100 * index
    assert note in meaning.of(mesh).notes


def test_eastings_and_northings_without_a_unit_are_in_metres():
    axes = {"northing": LAT * 1e3, "easting": LON * 1e3}
    mesh = grid({"t": (("northing", "easting"), HEIGHTS)}, axes)
    assert str(mesh.field_data["unit"][0]) == "metre"


@pytest.mark.parametrize(
    ("unit", "ticks", "given", "shown"),
    [("hPa", [1000, 500], {}, "1000 hPa"), ("Pa", [1e5, 5e4], {"lev": 5e4}, "500 hPa"),
     ("m", [10.0, 80.0], {"lev": 80.0}, "80 m"), ("1", [1.0, 2.0], {"lev": 2.0}, "")],
)  # fmt: skip
def test_the_title_has_the_level_of_a_single_layer(unit, ticks, given, shown):
    words = {"axis": "Z", "units": unit} | ({"positive": "up"} if unit == "m" else {})
    coords = {"lev": ("lev", np.array(ticks, float), words),
              "lat": ("lat", LAT, {"units": "degrees_north"}),
              "lon": ("lon", LON, {"units": "degrees_east"})}  # fmt: skip
    values = np.stack([HEIGHTS, HEIGHTS + 3])
    data = xr.Dataset({"t": (("lev", "lat", "lon"), values, {"units": "K"})}, coords)
    look = vizlight.look(data, size=(90, 60), at=given)
    level = f" at {shown}" if shown else ""
    assert look.drawing.keys[0]["title"].startswith(f"t{level} (K)")


@pytest.mark.parametrize("offset", [0, 1])
def test_old_grids_of_gmt_are_rows_from_north_to_south(tmp_path, offset):
    ends = {"x_range": [0.0, 4], "y_range": [-1.0, 2], "z_range": [0.0, 9], "spacing": [1.0, 1.0]}
    data = xr.Dataset({name: ("side", values) for name, values in ends.items()})
    data["x_range"].attrs["units"] = "longitude [degrees_east]"
    data["y_range"].attrs["units"] = "latitude [degrees_north]"
    data["dimension"] = "side", [5 - offset, 4 - offset]
    count = (5 - offset) * (4 - offset)
    data["z"] = "xysize", np.arange(float(count)), {"node_offset": offset}
    data.to_netcdf(tmp_path / "a.grd")
    mesh = vizlight.read(tmp_path / "a.grd")
    assert mesh.field_data["unit"][0] == "degree"
    assert mesh.bounds[:4] == (offset / 2, 4 - offset / 2, -1 + offset / 2, 2 - offset / 2)
    assert mesh["z"][mesh.find_closest_point((0, 2, 0))] == 0
    assert mesh["z"][mesh.find_closest_point((4, -1, 0))] == count - 1
    data.to_netcdf(tmp_path / "b.grd", format="NETCDF3_CLASSIC")
    content = (tmp_path / "b.grd").read_bytes()
    refused(saved(tmp_path / "b.grd", content[:-20]), "a variable is not whole")


def test_what_changes_with_no_time_has_no_date_in_its_title():
    ground = {"h": (("y", "x"), np.random.default_rng(0).random((4, 5)))}
    steps = {"t": (("time", "y", "x"), np.random.default_rng(1).random((2, 4, 5)))}
    coords = axes_of(time=([0.0, 59.0], {"units": "days since 2001-01-01"}))
    mesh = vizlight.read(xr.Dataset({**ground, **steps}, coords))
    assert {"h", "t"} <= {*mesh.point_data}
    assert titled(mesh, "t") == "t, 2001-03-01"
    assert titled(mesh, "h") == "h"
