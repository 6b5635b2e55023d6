"""Files of GRIB with several levels and grids: those on one grid are read, others are told."""

import numpy as np
import pytest

import vizlight
from vizlight import files
from vizlight.mesh import dates, meaning

pytest.importorskip("cfgrib")
eccodes = pytest.importorskip("eccodes")


def written(path, step):
    """Return a file of a temperature in steps of a degree, and winds in other steps."""
    with path.open("wb") as file:
        for level, size, name in ((2, 1.0, "2t"), (10, step, "10u"), (10, step, "10v")):
            message = eccodes.codes_grib_new_from_samples("regular_ll_sfc_grib1")
            columns, rows = int(10 / size) + 1, int(6 / size) + 1
            keys = {
                "Ni": columns, "Nj": rows, "latitudeOfFirstGridPointInDegrees": 50.0,
                "latitudeOfLastGridPointInDegrees": 44.0, "longitudeOfFirstGridPointInDegrees": 0.0,
                "longitudeOfLastGridPointInDegrees": 10.0, "iDirectionIncrementInDegrees": size,
                "jDirectionIncrementInDegrees": size, "shortName": name, "level": level,
                "typeOfLevel": "heightAboveGround",
            }  # fmt: skip
            for key, value in keys.items():
                eccodes.codes_set(message, key, value)
            lat = np.repeat(50 - size * np.arange(rows), columns)
            eccodes.codes_set_values(message, level + lat)
            eccodes.codes_write(message, file)
            eccodes.codes_release(message)
    return path


@pytest.mark.slow
def test_levels_on_one_grid_are_read_together(tmp_path):
    mesh = vizlight.read(written(tmp_path / "a.grib", 1.0))
    assert {*mesh.point_data} == {"t2m", "u10", "v10"}
    for name, height in (("t2m", 2), ("u10", 10), ("v10", 10)):
        np.testing.assert_allclose(mesh[name], mesh.points[:, 1] + height, atol=1e-3)
    assert vizlight.look(mesh, size=(90, 60)).array == "u10,v10"


def test_the_first_group_is_read_and_other_grids_are_told(tmp_path):
    # Forecasts have their hour at the end of their name.
    mesh = vizlight.read(written(tmp_path / "a.f006", 2.0))
    assert {*mesh.point_data} == {"u10", "v10"}
    assert "on other grids: t2m at heightAboveGround 2" in meaning.line(mesh)


def test_missing_messages_are_told(tmp_path):
    with (tmp_path / "a.grib").open("wb") as file:
        for date, level in ((20200101, 500), (20200101, 850), (20200102, 850)):
            message = eccodes.codes_grib_new_from_samples("regular_ll_pl_grib2")
            eccodes.codes_set(message, "dataDate", date)
            eccodes.codes_set(message, "level", level)
            eccodes.codes_set_values(message, np.arange(16.0 * 31))
            eccodes.codes_write(message, file)
            eccodes.codes_release(message)
    mesh = vizlight.read(tmp_path / "a.grib")
    assert "t has 3 of the 4 messages of its axes" in meaning.line(mesh)


@pytest.mark.parametrize(
    ("height", "names", "size"), [(2, {"t2m"}, (11, 7, 1)), (10, {"u10", "v10"}, (6, 4, 1))]
)
def test_a_group_is_chosen_by_its_level(tmp_path, height, names, size):
    mesh = vizlight.read(written(tmp_path / "a.grib", 2.0), at={"heightAboveGround": height})
    assert {*mesh.point_data} == names
    assert mesh.dimensions == size
    np.testing.assert_allclose(mesh[min(names)], mesh.points[:, 1] + height, atol=1e-3)


def test_no_group_has_a_level(tmp_path):
    with pytest.raises(files.FileError, match="no group of variables has"):
        vizlight.read(written(tmp_path / "a.grib", 2.0), at={"heightAboveGround": 80})


def test_winds_along_a_polar_grid_are_turned_in_a_file_of_several_groups(tmp_path):
    xarray = pytest.importorskip("xarray")
    path = tmp_path / "a.grib"
    with path.open("wb") as file:
        for level, name in ((2, "2t"), (10, "10u"), (10, "10v")):
            message = eccodes.codes_grib_new_from_samples("polar_stereographic_sfc_grib1")
            keys = {"shortName": name, "level": level, "uvRelativeToGrid": 1}
            keys |= {"typeOfLevel": "heightAboveGround", "DxInMetres": 2e5, "DyInMetres": 2e5}
            for key, value in keys.items():
                eccodes.codes_set(message, key, value)
            count = eccodes.codes_get(message, "numberOfPoints")
            eccodes.codes_set_values(message, np.full(count, 5.0 if name == "10u" else 0.0))
            eccodes.codes_write(message, file)
            eccodes.codes_release(message)
    mesh = vizlight.read(path)
    options = {"filter_by_keys": {"shortName": "10u"}, "indexpath": ""}
    data = xarray.open_dataset(path, engine="cfgrib", backend_kwargs=options)
    lon, lat = data["longitude"].values, data["latitude"].values
    places = np.asarray(mesh.points)[: lon.size]
    assert np.abs(places[:, 1] - lat.ravel()).max() < 1e-4
    assert dates.date(mesh.field_data["TimeValue"][0], meaning.of(mesh).time)
    # A wind along the rows blows from each point to the next of its row.
    rows = np.asarray(mesh["u10,v10"])[: lon.size].reshape(*lon.shape, 3)[5, 5]
    east = np.radians((lon[5, 6] - lon[5, 4] + 180) % 360 - 180) * np.cos(np.radians(lat[5, 5]))
    north = np.radians(lat[5, 6] - lat[5, 4])
    np.testing.assert_allclose(
        rows[:2], 5 * np.array([east, north]) / np.hypot(east, north), atol=0.02
    )
