"""Values in a list: cells by the bounds of their coordinates, or points."""

import numpy as np
import pytest

import vizlight
from vizlight.looks.recipes.drawing import titled
from vizlight.mesh import meaning
from vizlight.reading import listed

pytestmark = pytest.mark.usefixtures("without_trial")

xr = pytest.importorskip("xarray")
pytest.importorskip("cf_xarray")

#: Middles of cells of 30 degrees on the globe.
LON, LAT = (
    part.ravel() for part in np.meshgrid(np.arange(15.0, 360, 30), np.arange(-75.0, 90, 30))
)
CORNERS = np.array([[-15, -15], [15, -15], [15, 15], [-15, 15]])


def by_cell(scale, unit):
    """Return a dataset of values in cells, whose corners are given."""
    corners = {
        f"{name}_bnds": (("cell", "nv"), scale * (middle[:, np.newaxis] + CORNERS[:, k]))
        for k, (name, middle) in enumerate((("clon", LON), ("clat", LAT)))
    }
    words = {"clon": "longitude", "clat": "latitude"}
    places = {
        name: ("cell", scale * middle,
               {"units": unit, "standard_name": words[name], "bounds": f"{name}_bnds"})
        for name, middle in (("clon", LON), ("clat", LAT))
    }  # fmt: skip
    values = np.stack([LAT, 1000 * LAT + LON])
    return xr.Dataset({"t": (("lev", "cell"), values, {"units": "K"}), **corners}, places)


@pytest.mark.parametrize(("scale", "unit"), [(1.0, "degrees_east"), (np.pi / 180, "radian")])
def test_cells_by_their_bounds(tmp_path, scale, unit):
    by_cell(scale, unit).to_netcdf(tmp_path / "a.nc")
    mesh = vizlight.read(tmp_path / "a.nc", at={"lev": 1})
    assert mesh.bounds[:4] == pytest.approx((-180, 180, -90, 90))
    assert mesh.field_data["unit"][0] == "degree"
    assert mesh.compute_cell_sizes()["Area"].sum() == pytest.approx(360 * 180)
    lon, lat = mesh.cell_centers().points[: len(LON), :2].T
    np.testing.assert_allclose(lat, LAT, atol=1e-3)
    np.testing.assert_allclose(np.cos(np.radians(lon - LON)), 1, atol=1e-4)
    np.testing.assert_array_equal(mesh.cell_data["t"][: len(LON)], 1000 * LAT + LON)


def test_a_cell_of_fewer_corners_repeats_one():
    data = by_cell(1.0, "degrees")
    for name in ("clon_bnds", "clat_bnds"):
        data[name][5, 3] = data[name][5, 2]
    mesh = vizlight.read(data)
    assert mesh.get_cell(5).n_points == 3
    assert mesh.get_cell(6).n_points == 4


def test_points_where_no_cells_are_known():
    # Unlike those of a list on a grid, they are on no rows.
    lon = LON + np.arange(len(LON)) % 7
    places = {"lon": ("ncol", lon, {"units": "degrees_east"}),
              "lat": ("ncol", LAT, {"units": "degrees_north"})}  # fmt: skip
    mesh = vizlight.read(xr.Dataset({"t": ("ncol", LAT + lon), **places}))
    np.testing.assert_allclose(np.asarray(mesh.points)[:, 0] % 360, lon % 360)
    np.testing.assert_array_equal(mesh["t"], LAT + lon)
    assert "points, since no cells of 'ncol' are known" in meaning.line(mesh)
    look = vizlight.look(mesh, size=(90, 60))
    assert look.shown == "points"
    assert "from above, north up" in look.reason


def reduced_gaussian(rows=16):
    """Return places on parallels with fewer points toward the poles."""
    lat = 90 - (np.arange(rows) + 0.5) * 180 / rows
    counts = np.maximum(8, np.rint(2 * rows * np.cos(np.radians(lat)))).astype(int)
    lon = np.concatenate([np.arange(count) * 360 / count for count in counts])
    return lon, np.repeat(lat, counts)


def test_points_that_cover_the_earth_are_joined():
    lon, lat = reduced_gaussian()
    places = {"lon": ("values", lon, {"units": "degrees_east"}),
              "lat": ("values", lat, {"units": "degrees_north"})}  # fmt: skip
    values = np.sin(np.radians(lat))
    mesh = vizlight.read(xr.Dataset({"t": ("values", values), **places}))
    assert "triangles between the points, which cover the earth" in meaning.line(mesh)
    # All of the map, once, with the values at their places; a pole has the mean of its ring.
    assert mesh.compute_cell_sizes()["Area"].sum() == pytest.approx(360 * 180)
    y = mesh.points[:, 1]
    inner = np.abs(y) < 84
    np.testing.assert_allclose(mesh["t"][inner], np.sin(np.radians(y[inner])), atol=0.01)
    np.testing.assert_allclose(mesh["t"][np.abs(y) > 89.9], np.sign(y[np.abs(y) > 89.9]), atol=0.01)
    assert (mesh.compute_normals()["Normals"][:, 2] > 0.99).all()
    # On a ball nothing is open.
    ball = vizlight.cartography.globe(mesh)
    assert ball.clean(tolerance=1e-5).n_open_edges == 0


def test_points_of_a_part_of_the_earth_are_not_joined():
    lon, lat = reduced_gaussian()
    assert listed.around_earth(lon, lat) is not None
    ocean = (lon > 60) | (lat < -20)
    assert listed.around_earth(lon[ocean], lat[ocean]) is None
    assert listed.around_earth(lon[lat > -40], lat[lat > -40]) is None
    assert listed.around_earth(np.zeros(200), np.linspace(-90, 90, 200)) is None


def test_stations_of_several_times():
    places = {"lon": ("station", LON, {"units": "degrees_east"}),
              "lat": ("station", LAT, {"units": "degrees_north"})}  # fmt: skip
    data = xr.Dataset({"t": (("time", "station"), [LAT, LON]), **places}, {"time": [0.0, 6.0]})
    mesh = vizlight.read(data, time="first")
    np.testing.assert_array_equal(mesh["t"], LAT)
    assert mesh.field_data["TimeSteps"].tolist() == [0, 6]


def test_angles_without_a_unit_are_radians_where_they_go_around_the_globe():
    x, y = np.radians(LON), np.radians(LAT) * 90 / 75
    data = xr.Dataset({"p": (("Time", "nCells"), [LAT]), "lonCell": ("nCells", x),
                       "latCell": ("nCells", y)})  # fmt: skip
    mesh = vizlight.read(data)
    assert mesh.bounds[:4] == pytest.approx((-165, 165, -90, 90))
    assert "taken for radians" in meaning.line(mesh)
    near = data.assign(lonCell=("nCells", x / 10), latCell=("nCells", y / 10))
    assert vizlight.read(near).bounds[1] == pytest.approx(x.max() / 10)


def test_a_track_across_the_date_line_has_the_places_of_its_times():
    data = xr.Dataset(
        {"t": ("time", [1.0, 2, 3]),
         "lon": ("time", [179.0, -179, -178], {"units": "degrees_east"}),
         "lat": ("time", [10.0, 11, np.nan], {"units": "degrees_north"})},
        {"time": ("time", [0.0, 1, 2], {"units": "hours since 2000-01-01"})},
    )  # fmt: skip
    mesh = vizlight.read(data)
    np.testing.assert_allclose(mesh.points, [[179, 10, 0], [181, 11, 0]])
    assert mesh["t"].tolist() == [1, 2]


def glider():
    """Return a glider that goes down and up, 0.1 degrees to the east at 60 north, then north."""
    down = 50 * (1 - np.cos(np.linspace(0, 20, 41)))
    lon = 179.95 + np.r_[np.linspace(0, 0.1, 21), np.full(20, 0.1)]
    lat = 60 + np.r_[np.zeros(21), np.linspace(0, 0.1, 21)[1:]]
    of_time = {
        "heading": (down**2 % 360, {"standard_name": "platform_orientation", "units": "degrees"}),
        "salinity": (34 + np.sin(down), {"units": "1e-3"}),
        "temperature": (20 - down**2 / 1000, {"units": "Celsius"}),
        "depth": (down, {"units": "m", "positive": "down"}),
        "lon": ((lon + 180) % 360 - 180, {"units": "degrees_east"}),
        "lat": (lat, {"units": "degrees_north"}),
    }
    variables = {name: ("time", rows, words) for name, (rows, words) in of_time.items()}
    times = {"time": ("time", np.arange(41.0), {"units": "hours since 2000-01-01"})}
    return xr.Dataset(variables, times, {"featureType": "trajectory"})


def test_a_track_with_depths_is_a_section_along_it():
    file = glider()
    mesh = vizlight.read(file)
    np.testing.assert_allclose(mesh.points[:, 1], -file["depth"].values, atol=1e-4)
    degree = np.radians(6_371_008.8)
    east = 0.1 * degree * np.cos(np.radians(60))
    assert mesh.points[20, 0] == pytest.approx(east, rel=1e-4)
    assert mesh.points[40, 0] == pytest.approx(east + 0.1 * degree, rel=1e-4)
    titles = [scale.title for scale in meaning.of(mesh).scales]
    assert titles == ["distance along the track", "depth"]
    shown = vizlight.look(file)
    assert shown.array == "temperature"
    assert [other.array for other in shown.others] == ["salinity", "heading"]
    # At one depth it is a line on a map, of which the north is up.
    level = vizlight.look(file.assign(depth=file["depth"] * 0 + 15))
    assert level.mesh.bounds_size[0] < 1
    assert tuple(level.view.up) == (0, 1, 0)


def test_corners_of_scrip_are_told_by_their_names():
    data = by_cell(1.0, "degrees")
    names = {"clon": "grid_center_lon", "clat": "grid_center_lat"}
    names |= {f"{old}_bnds": new.replace("center", "corner") for old, new in names.items()}
    for old in ("clon", "clat"):
        del data[old].attrs["bounds"], data[old].attrs["standard_name"]
    mesh = vizlight.read(data.rename(names))
    assert mesh.compute_cell_sizes()["Area"].sum() == pytest.approx(360 * 180)


def test_a_region_across_both_meridians_is_not_parted():
    lat, lon = np.meshgrid(np.arange(0.0, 40, 10), np.arange(130.0, 371, 10), indexing="ij")
    places = {
        "lon": ("values", lon.ravel() % 360, {"units": "degrees_east"}),
        "lat": ("values", lat.ravel(), {"units": "degrees_north"}),
    }
    mesh = vizlight.read(xr.Dataset({"t": ("values", lon.ravel())}, places))
    assert mesh.bounds_size[0] == 240
    np.testing.assert_allclose((np.asarray(mesh["t"]) - mesh.points[:, 0]) % 360, 0)


def test_levels_of_a_list_are_no_rows():
    places = {
        "longitude": ("values", LON, {"units": "degrees_east"}),
        "latitude": ("values", LAT + LON % 7, {"units": "degrees_north"}),
        "level": ("level", [1000.0, 500], {"units": "hPa"}),
    }
    values = {"t": (("level", "values"), np.stack([LAT, LON])), "ground": ("values", LON)}
    mesh = vizlight.read(xr.Dataset(values, places))
    assert mesh.n_points == len(LON)
    np.testing.assert_array_equal(mesh["t"], LAT)
    # The title of what has no level names none.
    assert [titled(mesh, name) for name in ("t", "ground")] == ["t at 1000 hPa", "ground"]


def of_cube(count):
    """Return longitudes and latitudes of count x count nodes on each of the faces of a cube."""
    x, y = np.meshgrid(*[np.tan(np.linspace(-np.pi / 4, np.pi / 4, count))] * 2)
    one = np.ones_like(x)
    faces = [(one, x, y), (-x, one, y), (-one, -x, y), (x, -one, y), (-y, x, one), (y, x, -one)]
    lon = np.degrees([np.arctan2(face[1], face[0]) for face in faces]) % 360
    return lon, np.degrees([np.arctan2(face[2], np.hypot(*face[:2])) for face in faces])


def test_all_faces_of_a_cube_are_one_surface():
    nodes = dict(zip(("lon", "lat"), of_cube(7), strict=True))
    numbers = np.arange(54.0).reshape(6, 3, 3)
    dims, around = ("nf", "Ydim", "Xdim"), ("nf", "YCdim", "XCdim")
    data = xr.Dataset(
        {"t": (("lev", *dims), np.stack([numbers, numbers + 100]))}
        | {f"{name}s": (dims, rows[:, 1::2, 1::2]) for name, rows in nodes.items()}
        | {f"corner_{name}s": (around, rows[:, ::2, ::2]) for name, rows in nodes.items()},
        {"lev": ("lev", [500.0, 1000], {"units": "hPa"})},
    )
    mesh = vizlight.read(data)
    assert mesh.area == pytest.approx(360 * 180)
    assert "lev 1000" in meaning.line(mesh)
    numbers = np.asarray(mesh["t"]).astype(int) - 100
    assert {*numbers} == {*range(54)}
    whole = np.bincount(numbers) == 1
    places = np.asarray(mesh.cell_centers().points)[whole[numbers]]
    middles = np.column_stack([rows[:, 1::2, 1::2].ravel() for rows in nodes.values()])
    at = middles[numbers[whole[numbers]]]
    off = np.abs((places[:, :2] - at + 180) % 360 - 180)
    assert np.median(off) < 0.5
    assert off.max() < 10
    face = vizlight.read(data, at={"nf": 4, "lev": 1})
    np.testing.assert_array_equal(np.unique(face["t"]), 136 + np.arange(9))


@pytest.mark.parametrize("form", ["contiguous", "indexed", "single"])
def test_trajectories_are_lines(form):
    lon, lat = np.array([10.0, 20, 30, 170, -170, -160]), np.array([0.0, 1, 3, 5, 5, 7])
    file = xr.Dataset(
        {"T": ("obs", np.arange(6.0))},
        {
            "lon": ("obs", lon, {"units": "degrees_east"}),
            "lat": ("obs", lat, {"units": "degrees_north"}),
        },
        {"featureType": "trajectory"},
    )
    if form == "contiguous":
        file["count"] = ("track", [3, 3], {"sample_dimension": "obs"})
    elif form == "indexed":
        file["track"] = ("obs", [7, 7, 7, 2, 2, 2], {"instance_dimension": "tracks"})
    lines = [cell.point_ids for cell in vizlight.look(file).mesh.cell]
    # Longitudes begin behind the widest gap, so that the date line is inside.
    assert sorted(lines) == ([[0, 1, 2], [3, 4, 5]] if form != "single" else [[0, 1, 2, 3, 4, 5]])
    del file.attrs["featureType"]
    assert not vizlight.look(file).drawing.layers[0].mesh.run().n_lines
