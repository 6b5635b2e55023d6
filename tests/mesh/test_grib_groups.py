"""Files of GRIB with several levels and grids: those on one grid are read, others are told."""

import numpy as np
import pytest

import vizlight
from vizlight import files
from vizlight.mesh import meaning

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


def test_levels_on_one_grid_are_read_together(tmp_path):
    mesh = vizlight.read(written(tmp_path / "a.grib", 1.0))
    assert {*mesh.point_data} == {"t2m", "u10", "v10"}
    for name, height in (("t2m", 2), ("u10", 10), ("v10", 10)):
        np.testing.assert_allclose(mesh[name], mesh.points[:, 1] + height, atol=1e-3)
    assert vizlight.look(mesh, size=(90, 60)).array == "u10,v10"


def test_the_first_group_is_read_and_other_grids_are_told(tmp_path):
    mesh = vizlight.read(written(tmp_path / "a.grib", 2.0))
    assert {*mesh.point_data} == {"u10", "v10"}
    assert "on other grids: t2m at heightAboveGround 2" in meaning.line(mesh)


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
