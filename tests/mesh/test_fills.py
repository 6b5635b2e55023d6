"""Values that stand for none: -9999, 1e20 and the like, in any mesh."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import files
from vizlight.mesh import fills


@pytest.mark.parametrize(
    "value", [-9999, -32768, 32767, -3.4028235e38, 9.96921e36, -999, 1e20, -9.99e8]
)
def test_one_value_far_outside_and_repeated_is_missing(value):
    values = np.random.default_rng(0).normal(100, 30, 1000).astype(np.float32)
    values[:60] = value
    out, words = fills.without_missing("t", values)
    assert np.flatnonzero(np.isnan(out)).tolist() == list(range(60))
    assert words == f"6 % of 't' are {value:g}"
    assert not np.isnan(values).any()


@pytest.mark.parametrize(
    "values",
    [
        [0, 0, 1, 255], [0, 0, 0, 100, 101], [-9999, 1, 2, 3], [0, 50, 99, 99],
        [-10_900, -9_999, -9_999, 8_000],
        # A hole among stars stands once.
        [2e30, 5e30, 8e36],
    ],
)  # fmt: skip
def test_other_values_are_kept(values):
    rows = np.array(values)
    out, words = fills.without_missing("t", rows)
    assert out is rows
    assert words == ""


def test_nodata_names_the_value():
    rows = np.array([0, 7, 7, 12], np.int16)
    out, words = fills.without_missing("t", rows, 7)
    assert np.isnan(out).tolist() == [False, True, True, False]
    assert words == "50 % of 't' are 7"
    rows = np.array([-9999.0, -9999, 1, 2])
    assert fills.without_missing("t", rows, float("nan"))[0] is rows


@pytest.mark.parametrize("value", ["a", np.array([1.0, 1]), [1]])
def test_a_value_for_none_is_a_number(value, tmp_path):
    (tmp_path / "a.asc").write_text("")
    for call in (
        lambda: files.read(tmp_path / "a.asc", nodata=value),
        lambda: fills.checked(value),
    ):
        with pytest.raises(TypeError, match="nodata: expected a"):
            call()


def test_a_mesh_and_its_picture_are_without_them():
    sheet = pv.ImageData(dimensions=(12, 10, 1))
    x, y, _ = sheet.points.T
    sheet["warmth"] = np.where(x < 2, -9999, x + y)
    sheet["V"] = np.where(x[:, None] < 2, 1e20, np.stack([y, x, 0 * x], 1))
    known = files.without_fills(sheet)
    np.testing.assert_array_equal(np.isnan(known["warmth"]), x < 2)
    np.testing.assert_array_equal(np.isnan(known["V"]).all(axis=1), x < 2)
    assert sheet["warmth"].min() == -9999
    assert files.without_fills(known) is known
    assert files.without_fills(sheet, np.nan) is sheet
    look = vizlight.look(sheet, array="warmth")
    assert look.notes == ("17 % of 'warmth' are -9999, taken for missing, 17 % of 'V' are 1e+20, "
                          "taken for missing",)  # fmt: skip
    assert look.drawing.keys[0]["clim"] == (2, 20)
    kept = vizlight.look(sheet, array="warmth", nodata=np.nan)
    assert "taken for missing" not in str(kept)


def test_arrays_of_a_grid_of_a_file_are_searched_once(calls_of):
    xarray = pytest.importorskip("xarray")
    rows = np.where(np.eye(8) > 0, -9999.0, np.add.outer(np.arange(8.0), np.arange(8.0)))
    data = xarray.Dataset({name: (("y", "x"), rows + i) for i, name in enumerate("ab")})
    calls = calls_of(fills, "without_missing")
    with pytest.warns(match="taken for missing"):
        look = vizlight.look(data)
    assert [name for name, *_ in calls] == ["a", "b"]
    assert look.drawing.keys[0]["clim"] == (1.0, 13.0)
