"""Map projections: PROJ's own places, back and forth, angles on cones, and which map has which."""

import numpy as np
import pytest

from vizlight.mesh import projections

#: Maps by their sides in degrees, and the projection that suits them.
SUITED = {
    (-135, -45, 15, 60): "lcc", (-20, 40, -60, -20): "lcc", (100, 175, 30, 80): "lcc",
    (-180, 180, 60, 90): "stere", (0, 357.5, -90, -50): "stere", (6, 9, 45, 47): "eqc",
    (-180, 180, -90, 90): "", (90, 110, -8, 8): "", (-90, 90, 20, 80): "lcc",
    (-100, 100, 20, 80): "",
}  # fmt: skip
POLE = {"grid_north_pole_latitude": 39.25, "grid_north_pole_longitude": -162.0}
ROTATED = projections.of_attributes(POLE | {"north_pole_grid_longitude": 10.0})


def places(bounds, count=200):
    random = np.random.default_rng(5)
    west, east, south, north = bounds
    return np.column_stack([random.uniform(west, east, count), random.uniform(south, north, count)])


@pytest.mark.parametrize(("bounds", "kind"), SUITED.items())
def test_which_map_has_which_projection(bounds, kind):
    text = projections.suited(bounds)
    assert text.partition("=")[2].split(" ")[0] == kind
    assert projections.suited(bounds, straight=True).startswith("+proj=eqc") == bool(
        kind in ("lcc", "eqc")
    )


@pytest.mark.parametrize(
    ("bounds", "kind"),
    {(0, 20, 55, 65): "merc", (0, 20, -65, -55): "merc", (-10, 40, 35, 70): "lcc"}.items(),
)
def test_north_is_up_on_a_map_whose_scales_differ_little(bounds, kind):
    text = projections.suited(bounds, north_up=True)
    assert text.startswith(f"+proj={kind} ")
    plane, earth = projections.of_text(text), places(bounds)
    courses = plane.forward(earth + np.array([0, 1e-5])) - plane.forward(earth)
    leans = np.degrees(np.abs(np.arctan2(courses[:, 0], courses[:, 1])))
    assert leans.max() < 1e-3 if kind == "merc" else leans.max() > 10


@pytest.mark.parametrize(
    ("text", "bounds"),
    [
        (projections.suited((0, 20, 55, 65), north_up=True), (0, 20, 55, 65)),
        ("+proj=merc +lon_0=15 +R=6371000", (-165, 195, -80, 80)),
        *((projections.suited(bounds), bounds) for bounds, kind in SUITED.items() if kind),
        (ROTATED, (-180, 180, -89, 89)),
        (projections.around(20.0), (-159.9, 199.9, -89.9, 89.9)),
        ("+proj=lcc +lon_0=15 +lat_0=63 +lat_1=63 +R=6371000 +units=m +no_defs", (0, 30, 50, 70)),
        ("+proj=lcc +lon_0=15 +lat_0=63 +lat_1=63 +R=6371000 +x_0=400000", (0, 30, 50, 70)),
    ],
)
def test_places_are_those_of_proj_and_come_back(text, bounds):
    warp = pytest.importorskip("rasterio.warp")
    plane = projections.of_text(text)
    earth = places(bounds)
    flat = plane.forward(earth)
    np.testing.assert_allclose(
        flat.T, warp.transform("EPSG:4326", text, *earth.T), rtol=0, atol=1e-6
    )
    back = plane.inverse(flat) - earth
    back[:, 0] = (back[:, 0] + 180) % 360 - 180
    np.testing.assert_allclose(back, 0, atol=1e-9)


@pytest.mark.parametrize("bounds", [(-135, -45, 15, 60), (-180, 180, -80, -40)])
def test_cones_keep_angles(bounds):
    """East and north are at right angles, and alike in scale, which is 1 on a true parallel."""
    plane, earth, step = projections.of_text(projections.suited(bounds)), places(bounds), 1e-5
    wide = step / np.cos(np.radians(earth[:, 1]))
    east = plane.forward(earth + np.stack([wide, 0 * wide], 1)) - plane.forward(earth)
    north = plane.forward(earth + np.array([0, step])) - plane.forward(earth)
    lengths = np.linalg.norm(east, axis=1), np.linalg.norm(north, axis=1)
    np.testing.assert_allclose(*lengths, rtol=1e-4)
    cosines = np.einsum("ij,ij->i", east, north) / (lengths[0] * lengths[1])
    np.testing.assert_allclose(cosines, 0, atol=1e-4)


def test_equal_earth_keeps_areas_and_both_ends_of_a_turn():
    plane, earth, step = (
        projections.of_text(projections.around(0.0)),
        places((-179, 179, -89, 89)),
        1e-4,
    )
    east, north = (
        plane.forward(earth + way) - plane.forward(earth - way)
        for way in (np.array([step, 0]), np.array([0, step]))
    )
    area = (east[:, 0] * north[:, 1] - east[:, 1] * north[:, 0]) / np.radians(2 * step) ** 2
    true = projections.RADIUS**2 * np.cos(np.radians(earth[:, 1]))
    np.testing.assert_allclose(area, true, rtol=1e-6)
    ends = plane.forward(np.array([[-180.0, 10], [180.0, 10]]))
    assert ends[0, 0] == -ends[1, 0] < 0


@pytest.mark.parametrize(
    ("attributes", "text"),
    [
        ({"grid_mapping_name": "lambert_conformal_conic", "standard_parallel": [30, 60],
          "longitude_of_central_meridian": 10, "latitude_of_projection_origin": 50,
          "earth_radius": 6370000}, "+proj=lcc +lat_0=50 +lon_0=10 +R=6370000 +lat_1=30 +lat_2=60"),
        ({"grid_mapping_name": "polar_stereographic", "standard_parallel": 70,
          "straight_vertical_longitude_from_pole": -45, "latitude_of_projection_origin": 90,
          "scale_factor_at_projection_origin": 1.0}, "+proj=stere +lat_0=90 +lon_0=-45 +lat_ts=70"),
        ({"MAP_PROJ": 1, "TRUELAT1": 30.0, "TRUELAT2": 60.0, "STAND_LON": -98.0},
         "+proj=lcc +lat_1=30 +lat_2=60 +lat_0=30 +lon_0=-98 +R=6371008.8"),
        ({"MAP_PROJ": 2, "TRUELAT1": -70.0, "STAND_LON": 0.0},
         "+proj=stere +lat_0=-90 +lon_0=0 +R=6371008.8"),
        ({"MAP_PROJ": 3}, ""),
        ({"grid_mapping_name": "geostationary", "perspective_point_height": 35786000.0,
          "fixed_angle_axis": "y"}, "+proj=geos +h=35786000 +sweep=x"),
        ({"grid_mapping_name": "latitude_longitude"}, ""),
        ({"grid_mapping_name": "x", "crs_wkt": "PROJCS[]"}, "PROJCS[]"),
    ],
)  # fmt: skip
def test_the_text_of_a_projection_of_a_file(attributes, text):
    assert projections.of_attributes(attributes) == text


def test_places_beyond_a_projection_of_proj_take_no_other_with_them():
    pytest.importorskip("rasterio")
    plane = projections.of_text("+proj=ortho +lat_0=50 +lon_0=0")
    flat = plane.forward(np.array([[0.0, 50.0], [180.0, 0.0], [10.0, 50.0]]))
    assert np.isfinite(flat).all(axis=1).tolist() == [True, False, True]


def test_the_example_of_the_guide_to_goes():
    pytest.importorskip("rasterio")
    # Product Definition and Users' Guide, volume 5, section 4.2.8: angles in radians, a place.
    angles, place = np.array([[-0.024052, 0.095340]]), [[-84.690932, 33.846162]]
    system = {
        "grid_mapping_name": "geostationary", "perspective_point_height": 35786023.0,
        "semi_major_axis": 6378137.0, "semi_minor_axis": 6356752.31414,
        "longitude_of_projection_origin": -75.0, "sweep_angle_axis": "x",
    }  # fmt: skip
    plane = projections.of_text(projections.of_attributes(system))
    np.testing.assert_allclose(plane.inverse(35786023.0 * angles), place, atol=1e-5)


@pytest.mark.parametrize("text", ["", "no such system", "EPSG:4326"])
def test_what_is_no_projection(text):
    assert projections.of_text(text) is None
