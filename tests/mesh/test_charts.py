"""Maps in the plane of a projection: their sides, vectors, outlines, and lines that end on them."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals

from vizlight import cartography
from vizlight.mesh import charts, projections
from vizlight.mesh.georeference import in_degrees

EARTH = projections.around(0.0)
AMERICA = (-135, -45, 15, 60)


def sheet_of(west, east, south, north, step=1.0):
    """Return a map in degrees with a wind to the east."""
    columns, rows = round((east - west) / step) + 1, round((north - south) / step) + 1
    grid = pv.ImageData(
        dimensions=(columns, rows, 1), spacing=(step, step, 1), origin=(west, south, 0)
    )
    grid["u"], grid["v"] = np.full(grid.n_points, 3.0), np.full(grid.n_points, 4.0)
    return in_degrees(grid)


def test_a_cone_has_its_points_where_the_projection_says_and_its_winds_along_them():
    mesh = sheet_of(*AMERICA)
    flat = cartography.chart(mesh)
    plane = projections.of_text(str(flat.field_data["projection"][0]))
    places = np.asarray(mesh.points, dtype=float)[:, :2]
    np.testing.assert_allclose(np.asarray(flat.points)[:, :2], plane.forward(places), atol=1)
    # 3 east and 4 north for some seconds, on the sphere.
    ahead = places + 1e-3 * np.stack(
        [3 / np.cos(np.radians(places[:, 1])), 4 + 0 * places[:, 0]], 1
    )
    way = plane.forward(ahead) - plane.forward(places)
    way *= 5 / np.linalg.norm(way, axis=1, keepdims=True)
    np.testing.assert_allclose(np.asarray(flat["u,v"])[:, :2], way, atol=1e-3)
    assert "u,v" not in mesh.point_data


@pytest.mark.parametrize("west", [6, 355])
def test_a_small_map_stays_an_image_with_the_shape_of_the_place(west):
    flat = cartography.chart(sheet_of(west, west + 3, 59, 61, 0.1))
    assert charts.sheet(flat).extent == pytest.approx((west, west + 3, 59, 61), abs=0.01)
    assert isinstance(flat, pv.ImageData)
    x, y, _ = flat.bounds_size
    assert x / y == pytest.approx(1.5 * np.cos(np.radians(60)), rel=1e-6)


def test_the_outline_of_a_map_around_a_pole_is_its_ring():
    flat = cartography.chart(sheet_of(-180, 179, 60, 90))
    outline = charts.sheet(flat).outline
    radii = np.linalg.norm(outline, axis=1)
    assert len(outline) == 360
    np.testing.assert_allclose(radii, radii[0], rtol=1e-9)
    assert charts.sheet(flat).extent == pytest.approx((-180, 180, 60, 90), abs=0.6)


def test_a_surface_around_the_earth_is_one_map_with_round_sides():
    faces = sheet_of(-180, 180, -80, 85, 5).extract_surface(algorithm=None).triangulate()
    flat = cartography.chart(faces)
    assert "eqearth" in str(flat.field_data["projection"][0])
    sheet = charts.sheet(flat)
    # Every point is on the map, those of the first and the last meridian on its outline.
    assert sheet.holds(np.asarray(flat.points)[:, :2]).all()
    longest = np.abs(sheet.outline[:, 0]).max()
    assert longest == pytest.approx(flat.bounds.x_max, rel=1e-3)
    assert np.abs(sheet.outline[[0, -1], 0]).max() < 0.65 * longest
    # One that ends elsewhere keeps its box.
    part = cartography.chart(faces.clip("x", origin=(90, 0, 0)), EARTH)
    assert len(charts.sheet(part).outline) == 4


def test_a_grid_around_the_earth_of_few_rows_is_one_map_with_round_sides():
    few, many = (cartography.chart(sheet_of(-180, 180, -90, 90, step)) for step in (30, 1))
    sheets = [charts.sheet(flat) for flat in (few, many)]
    np.testing.assert_allclose(sheets[0].outline, sheets[1].outline, atol=1)
    assert sheets[0].holds(np.asarray(many.points)[:, :2]).all()


@pytest.mark.parametrize(("west", "columns"), [(0.0, 72), (0.0, 73), (-180.0, 72), (-180.0, 73)])
@pytest.mark.parametrize("place", ["points", "cells"])
def test_the_whole_earth_is_one_map_wherever_its_columns_begin(west, columns, place):
    grid = sheet_of(west, west + 5 * (columns - 1), -90, 90, 5)
    data = grid.point_data if place == "points" else grid.cell_data
    spots = grid if place == "points" else grid.cell_centers()
    lon, lat = np.radians(np.asarray(spots.points, dtype=float)[:, :2]).T
    data["warmth"] = np.cos(lon - 0.3) * np.cos(lat)
    if place == "cells":
        if columns == 72:
            # Cells end one step before the whole turn: there is a gap, which no map closes.
            assert charts.suited(grid) == ""
            return
        grid.clear_point_data()
    flat = cartography.chart(grid)
    sheet = charts.sheet(flat)
    assert sheet.extent == pytest.approx((-180, 180, -90, 90), abs=1e-4)
    assert not sheet.is_around
    x, _, y, _ = np.asarray(flat.bounds)[[0, 1, 2, 3]]
    assert (x, y) == pytest.approx((-1.7243e7, -8.3927e6), rel=1e-3)
    found = flat if place == "points" else flat.cell_centers()
    shown = flat.point_data if place == "points" else flat.cell_data
    lon, lat = np.radians(sheet.plane.inverse(np.asarray(found.points, dtype=float)[:, :2])).T
    expected = np.cos(lon - 0.3) * np.cos(lat)
    np.testing.assert_allclose(shown["warmth"], expected, atol=0.02 if place == "cells" else 1e-5)


def test_vectors_beside_the_seam_of_a_map_do_not_turn_round():
    grid = sheet_of(-180, 175, -90, 90, 5)
    grid["v"] = 0 * grid["v"]
    flat = cartography.chart(grid)
    np.testing.assert_allclose(np.asarray(flat["u,v"]), [[3, 0, 0]] * flat.n_points, atol=1e-4)


def test_the_extent_of_a_map_is_that_in_degrees():
    assert charts.sheet(cartography.chart(sheet_of(*AMERICA))).extent == pytest.approx(
        AMERICA, abs=0.05
    )


def test_lines_end_on_the_outline_and_come_back():
    sheet = charts.sheet(cartography.chart(sheet_of(*AMERICA)))
    lon = np.linspace(-200, 20, 441)
    (line,) = sheet.pieces([np.column_stack([lon, np.full_like(lon, 40.0)])])
    ends = sheet.plane.inverse(line[[0, -1]])
    np.testing.assert_allclose(ends, [(-135, 40), (-45, 40)], atol=0.2)
    # Over the outline and back: two parts.
    lat = np.concatenate([np.linspace(20, 70, 60), np.linspace(70, 20, 60)])
    lon = np.repeat([-100.0, -80.0], 60)
    assert len(sheet.pieces([np.column_stack([lon, lat])])) == 2
    assert sheet.pieces([]) == []


def test_coasts_of_a_chart_are_those_of_the_map_in_degrees():
    mesh = sheet_of(*AMERICA)
    flat = cartography.chart(mesh)
    plane = charts.sheet(flat).plane
    both = []
    for shore in (cartography.coasts(flat), cartography.coasts(mesh)):
        points = np.asarray(shore.points, dtype=float)[:, :2]
        both.append(points if shore.field_data["unit"][0] == "metre" else plane.forward(points))
    ours, others = both
    far = [np.linalg.norm(ours - place, axis=1).min() for place in others[::9]]
    assert np.max(far) < 120e3
    assert np.median(far) < 1e3


test_what_has_no_chart = refusals(
    cartography.chart,
    (pv.Plane(), None, "mesh: expected a map in degrees"),
    (sheet_of(90, 110, -8, 8), None, "projection: expected keywords of PROJ"),
    (sheet_of(*AMERICA), "+proj=nothing", "projection: expected keywords of PROJ"),
    (3, "mesh: expected a mesh", TypeError),
)


def test_what_is_no_sheet():
    assert charts.sheet(sheet_of(*AMERICA)) is None
    metres = pv.Plane()
    metres.field_data["unit"] = ["metre"]
    assert charts.sheet(metres) is None


def test_the_earth_as_a_satellite_sees_it_has_corners_beside_it():
    pytest.importorskip("rasterio")
    disc = pv.ImageData(dimensions=(2, 2, 1), spacing=(11e6, 11e6, 1), origin=(-5.5e6, -5.5e6, 0))
    disc.field_data["unit"], disc.field_data["crs"] = ["metre"], ["+proj=geos +h=35786023"]
    sheet = charts.sheet(disc)
    assert not sheet.is_around
    assert sheet.extent == pytest.approx((-81, 81, -81, 81), abs=8)
