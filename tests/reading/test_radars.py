"""Sweeps of radars: gates at their places, as a map or as a section."""

import numpy as np
import pytest

import vizlight
from vizlight.mesh import meaning
from vizlight.reading import series

xarray = pytest.importorskip("xarray")
#: Rays of two sweeps of a whole turn, at 0 and 10 degrees of elevation, and gates in km.
AZIMUTH, ELEVATION = np.tile(np.arange(5.0, 365, 10), 2), np.repeat([0.0, 10.0], 36)
GATES = np.array([0.0, 10, 20, 50])


def volume(azimuth=AZIMUTH, elevation=ELEVATION):
    rays = len(azimuth) // 2
    fields = {
        "dbz": (("time", "range"), np.add.outer(azimuth, GATES), {"long_name": "Reflectivity"}),
        "azimuth": ("time", azimuth),
        "elevation": ("time", elevation),
        "sweep_start_ray_index": ("sweep", [0, rays]),
        "sweep_end_ray_index": ("sweep", [rays - 1, 2 * rays - 1]),
        "fixed_angle": ("sweep", [elevation[0], elevation[-1]]),
        "latitude": ((), 50.0),
        "longitude": ((), 8.0),
        "altitude": ((), 300.0),
    }
    time = ("time", np.arange(len(azimuth)) / 10, {"units": "seconds since 2011-05-20"})
    return xarray.Dataset(fields, {"range": ("range", GATES, {"units": "km"}), "time": time})


def at(mesh, place):
    return mesh["dbz"][mesh.find_closest_point(place)]


def test_a_sweep_is_a_whole_turn_around_its_radar():
    """A ray along the ground reaches, after 50 km, what an earth of 4/3 of its radius says."""
    mesh = vizlight.read(volume())
    assert mesh.dimensions == (37, 4, 1)
    far = np.arctan2(50e3, 4 / 3 * 6_371_008.8) * 4 / 3 * 6_371_008.8
    assert np.hypot(*mesh.points[:, :2].T).max() == pytest.approx(far, rel=1e-6)
    for azimuth in (5, 95, 275):
        angle = np.radians(azimuth)
        assert at(mesh, (20e3 * np.sin(angle), 20e3 * np.cos(angle), 0)) == azimuth + 20
    assert str(mesh.field_data["crs"][0]).startswith("+proj=aeqd +lat_0=50 +lon_0=8")
    said = meaning.of(mesh)
    assert said.level == "elevation 0°"
    assert said.notes == ["the sweep 0 of 0, 10; --at sweep= takes another"]
    assert said.arrays["dbz"] == {"long_name": "Reflectivity"}
    assert series.of(mesh) == [0.0]


def test_rain_has_the_colours_of_a_radar_in_steps_from_0_on():
    file = volume()
    file["dbz"].values[:] = np.random.default_rng(0).uniform(-30, 47, file["dbz"].shape)
    file["dbz"].attrs["units"] = "dBZ"
    (key,) = vizlight.look(file).drawing.keys
    assert key["cmap"].arguments[2] == "vizlight.rain"
    assert key["levels"] == pytest.approx(np.arange(0, 51, 5))
    # What reflects hardly at all is as pale as dry ground.
    table = key["cmap"].run()
    assert np.min(table.map_value(-10)[:3]) > 0.95
    file["dbz"].attrs["units"] = "m"
    assert "vizlight.rain" not in vizlight.look(file).script()


def test_reflectivity_is_the_first_of_the_variables():
    file = volume()
    names = ("NCP", "differential_reflectivity", "z")
    others = {name: file["dbz"].assign_attrs(long_name=name) for name in names}
    file = xarray.Dataset({**others, **file.data_vars})
    assert vizlight.look(file).array == "dbz"
    renamed = file.rename(dbz="first", z="DBZHC")
    assert [*vizlight.read(renamed).point_data][:2] == ["DBZHC", "first"]


@pytest.mark.parametrize("sweep", [10, 1, "last"])
def test_a_sweep_is_chosen_by_its_angle_or_its_number(sweep):
    mesh = vizlight.read(volume(), at={"sweep": sweep})
    assert meaning.of(mesh).level == "elevation 10°"
    assert series.of(mesh) == [3.6]
    with pytest.raises(ValueError, match="at: no axis 'ray' in a file of a radar, but sweep"):
        vizlight.read(volume(), at={"ray": 1})


def test_a_sweep_of_one_azimuth_is_a_section():
    """Straight up, the height is that of the radar and the range."""
    mesh = vizlight.read(volume(np.full(36, 30.0), np.tile(np.linspace(0, 90, 18), 2)))
    assert mesh.dimensions == (18, 4, 1)
    assert mesh.bounds[:4] == pytest.approx((0, 49_999.4, 300, 50_300), abs=0.5)
    said = meaning.of(mesh)
    assert [scale.title for scale in said.section] == ["distance", "height"]
    assert said.level == "azimuth 30°"


def test_rays_straight_up_are_a_section_in_time():
    file = volume(elevation=np.full(72, 90.0))
    mesh = vizlight.read(file)
    said = meaning.of(mesh)
    assert [scale.title for scale in said.section] == ["time", "height"]
    assert mesh.bounds[:4] == pytest.approx((0, 7.1, 300, 50_300), abs=0.5)
    assert at(mesh, (3.0, 20_300, 0)) == file["dbz"].values[30, 2]


def test_of_several_turns_the_first_is_shown():
    mesh = vizlight.read(volume(np.tile(np.arange(5.0, 1085, 30), 2) % 360))
    assert mesh.dimensions == (13, 4, 1)
    assert at(mesh, (0, 50e3, 0)) == pytest.approx(volume()["dbz"].values[0, 3], abs=30)
