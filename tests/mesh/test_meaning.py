"""What arrays mean: components of vectors, and the words of files."""

from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

from vizlight.mesh import meaning
from vizlight.mesh.meaning import Meaning


def mesh_with(*names, units="", **standard):
    mesh = pv.ImageData(dimensions=(2, 2, 1))
    for name in (*names, *standard):
        mesh[name] = np.ones(4)
    said = Meaning()
    for name in names:
        said.add_array(name, {"units": units})
    for name, value in standard.items():
        said.add_array(name, {"standard_name": value})
    meaning.attach(mesh, said)
    return mesh


@pytest.mark.parametrize(
    "group",
    [
        ("u", "v"), ("U", "V"), ("u10", "v10"), ("uo", "vo"), ("uas", "vas"), ("vx", "vy", "vz"),
        ("UGRD_10maboveground", "VGRD_10maboveground"), ("x_wind", "y_wind"),
        ("water_u", "water_v"),
        ("10m_u_component_of_wind", "10m_v_component_of_wind"), ("u", "v", "w"),
        ("B_x", "B_y", "B_z"),
        ("ugos", "vgos"), ("uwnd", "vwnd"), ("vozocrtx", "vomecrty"), ("Velocity_X", "Velocity_Y"),
        ("east_wind", "north_wind"), ("U10M", "V10M"), ("u_rho", "v_rho"), ("ux", "uy"),
        ("10u", "10v"), ("tauu", "tauv"), ("siu", "siv"), ("xwind", "ywind"), ("uEast", "vNorth"),
        ("u_eastward", "v_northward"), ("ewind", "nwind"), ("vel_e", "vel_n"), ("iews", "inss"),
        ("um", "vm"), ("we", "wn"), ("ve", "vn", "vu"), ("var165", "var166"), ("windu", "windv"),
        ("E_wind", "N_wind"), ("utotal", "vtotal"), ("sustr", "svstr"), ("u@10m", "v@10m"),
        ("ugrd10m", "vgrd10m"), ("U_RHO", "V_RHO"), ("ssu", "ssv"), ("curu", "curv"),
        ("u-component_of_wind_isobaric", "v-component_of_wind_isobaric"), ("xcomp", "ycomp"),
        ("ulon", "ulat"), ("velocity_0", "velocity_1", "velocity_2"), ("vector.0", "vector.1"),
    ],
)  # fmt: skip
def test_components_by_usual_names(group):
    assert meaning.components(mesh_with("height", *reversed(group))) == [group]


def test_any_word_after_the_letter_needs_a_unit():
    names = ("urot", "vrot", "uu", "uv", "vv")
    assert meaning.components(mesh_with(*names)) == []
    mesh = mesh_with(*names, units="cm2/s2")
    assert meaning.components(mesh) == [("urot", "vrot")]


@pytest.mark.parametrize("unit", ["m/s", "m s**-1", "cm.s-1", "knots", "km/h", "mm yr-1", "N m-2"])
@pytest.mark.parametrize("group", [("uu", "vv"), ("qux", "qvx"), ("viwve", "viwvn")])
def test_a_letter_anywhere_tells_the_components_of_a_motion(group, unit):
    assert meaning.components(mesh_with(*group, units=unit)) == [group]
    assert meaning.components(mesh_with(*group, units="K")) == []


@pytest.mark.parametrize(
    "names",
    [
        ("u",),
        ("u", "V"),
        ("u10", "v100"),
        ("x", "y"),
        ("uu", "uv", "vv"),
        ("lat", "lon"),
        ("mask_u", "mask_v"),
        ("lon_u", "lon_v"),
        ("max", "may"),
        ("MAPFAC_UX", "MAPFAC_UY"),
        ("wind_0", "wind_1", "wind_2", "wind_3"),
        ("temperature_0", "temperature_1"),
        ("PERMX", "PERMY", "PERMZ"),
        ("TRANX", "TRANY", "TRANZ"),
        ("kx", "ky", "kz"),
    ],
)
def test_half_a_pair_is_no_vector(names):
    assert meaning.components(mesh_with(*names)) == []


def test_standard_names_come_first():
    mesh = mesh_with("u", a="northward_wind", b="eastward_wind", v="air_temperature")
    assert meaning.components(mesh) == [("b", "a"), ("u", "v")]
    sea = mesh_with(
        a="sea_water_x_velocity", b="sea_water_y_velocity", c="upward_sea_water_velocity"
    )
    assert meaning.components(sea) == [("a", "b")]
    heights = mesh_with(
        u10="eastward_wind", v10="northward_wind", u100="eastward_wind", v100="northward_wind"
    )
    assert meaning.components(heights) == [("u10", "v10"), ("u100", "v100")]


def test_components_by_long_names():
    mesh, said = mesh_with("var165", "var166"), Meaning()
    for name, letter in (("var166", "V"), ("var165", "U")):
        said.add_array(name, {"long_name": f"10 metre {letter} wind component"})
    meaning.attach(mesh, said)
    assert meaning.components(mesh) == [("var165", "var166")]


def test_flags_have_names_unless_they_are_bits():
    mesh, said = mesh_with("cover", "bits"), Meaning()
    words = {"flag_values": np.array([1, 4], np.int8), "flag_meanings": "bare_land sea"}
    said.add_array("cover", words)
    said.add_array("bits", words | {"flag_masks": np.array([1, 4], np.int8)})
    meaning.attach(mesh, said)
    assert meaning.flags(mesh, "cover") == {1.0: "bare land", 4.0: "sea"}
    assert meaning.flags(mesh, "bits") == {}


def test_components_become_vectors():
    mesh = mesh_with("u", "v")
    mesh["u"][2] = np.nan
    out, name = meaning.with_named(mesh, None)
    assert name == "u,v"
    assert name not in mesh.point_data
    assert np.isnan(out[name]).all(axis=1).tolist() == [False, False, True, False]
    with pytest.raises(ValueError, match="tangents: expected the name .*u,v or u10,v10"):
        meaning.with_named(mesh_with("u", "v", "u10", "v10"), None)
    with pytest.raises(ValueError, match="names of two or three arrays .*got 'u,w'; there are u,v"):
        meaning.with_named(mesh, "u,w")


def test_a_mesh_without_meaning():
    mesh = pv.ImageData(dimensions=(2, 2, 1))
    assert meaning.line(mesh) == ""
    mesh.field_data["meaning"] = ["42"]
    assert meaning.of(mesh) == Meaning()


@pytest.mark.parametrize(
    ("unit", "expected"),
    [
        ("m s**-1", "m/s"),
        ("m s-1", "m/s"),
        ("kg m^-3", "kg/m³"),
        ("m2 s-2", "m²/s²"),
        ("m+2 s-2", "m²/s²"),
        ("K", "K"),
        ("m/s", "m/s"),
        ("meters", "m"),
        ("METERS", "m"),
        ("M/S", "m/s"),
        ("meter second-1", "m/s"),
        ("centimeter/s", "cm/s"),
        ("mm/month", "mm/month"),
        ("s-1", "s-1"),
        ("kg m-2 s-1", "kg m-2 s-1"),
        ("degrees_north", "degrees_north"),
        ("degree_C", "°C"),
        ("degrees Celsius", "°C"),
        ("%", "%"),
        ("", ""),
    ],
)
def test_a_unit_is_printed_as_a_quotient(unit, expected):
    assert meaning.written(unit) == expected


@pytest.mark.parametrize(
    ("standard", "unit", "size", "expected"),
    [
        ("air_pressure_at_sea_level", "Pa", 1.03e5, (100.0, "hPa")),
        ("surface_air_pressure", "Pa", 9e3, (1.0, "Pa")),
        ("air_pressure", "hPa", 1e4, (1.0, "hPa")),
        ("sea_water_pressure", "Pa", 1e7, (1.0, "Pa")),
        ("air_temperature", "K", 1e5, (1.0, "K")),
    ],
)
def test_pressures_of_air_have_a_usual_unit(standard, unit, size, expected):
    mesh, said = pv.Sphere(), meaning.Meaning()
    said.add_array("p", {"standard_name": standard, "units": unit})
    meaning.attach(mesh, said)
    assert meaning.usual_unit(mesh, "p", size) == expected
    assert meaning.usual_unit(mesh, "q", size) == (1.0, "")


@pytest.mark.parametrize(
    ("unit", "size"), [("cm s-1", 0.01), ("km/h", 1 / 3.6), ("kt", 1852 / 3600), ("", 1), ("K", 1)]
)
def test_the_unit_of_a_speed_in_metres_a_second(unit, size):
    assert meaning.speed(mesh_with("u", "v", units=unit), "u,v") == pytest.approx(size)


@pytest.mark.parametrize(("name", "title"), [
    ("ImageFile", "heart"), ("ImageScalars", "heart"), ("DICOMImage", "heart"),
    ("scalars", "heart"), ("Scalars_", "heart"), ("temperature", None),
])  # fmt: skip
def test_a_word_of_a_reader_is_no_title(name, title):
    mesh = mesh_with(name)
    meaning.name_by_file(mesh, Path("heart.nii.gz"))
    assert meaning.of(mesh).arrays.get(name, {}).get("long_name") == title
    several = mesh_with(name, "values")
    meaning.name_by_file(several, Path("heart.vtk"))
    assert "long_name" not in meaning.of(several).arrays.get(name, {})


@pytest.mark.parametrize(
    ("scale", "coordinate", "words", "of_sea"),
    [
        (meaning.AxisScale("pressure", "hPa", -1.0), -500.0, "500 hPa", False),
        (meaning.AxisScale("pressure", "dbar", -100.0), -5e4, "500 dbar", True),
        (meaning.AxisScale("depth", "m", -1.0), -12345.0, "12345 m", True),
        (meaning.AxisScale("s_rho"), -0.5, "", True),
        (meaning.AxisScale("level", "", -1.0), -3.0, "", False),
        (meaning.AxisScale("potential temperature", "K"), 315.0, "315 K", False),
    ],
)
def test_a_scale_has_the_number_of_a_layer_and_says_whether_it_is_one_of_a_sea(
    scale, coordinate, words, of_sea
):
    assert scale.at(coordinate) == words
    assert scale.is_of_sea(coordinate) == of_sea


@pytest.mark.parametrize(
    ("name", "heat", "decades"),
    [
        ("T", True, False), ("Temp_K", True, False), ("sst", True, False), ("tempo", False, False),
        ("temp anomaly", False, False), ("temperature change", False, False),
        ("PERMX", False, True), ("log10", False, False), ("permittivity", False, False),
        ("Electrical resistivity", False, True), ("thermal_conductivity", False, True),
    ],
)  # fmt: skip
def test_temperatures_and_properties_of_rock_are_known_by_their_names(name, heat, decades):
    mesh = mesh_with(name)
    assert meaning.is_temperature(mesh, name) == heat
    assert meaning.is_in_decades(mesh, name) == decades
    said = meaning.Meaning(arrays={"v": {"long_name": name}})
    meaning.attach(mesh, said)
    assert meaning.is_temperature(mesh, "v") == heat
    assert meaning.is_in_decades(mesh, "v") == decades


def test_units_of_heights_above_the_sea_are_lengths():
    units = {"meters MSL": 1, "m a.s.l.": 1, "km above sea level": 1000, "m (amsl)": 1}
    assert {unit: meaning.metres(unit) for unit in units} == units
    assert meaning.metres("m s-1") is None
