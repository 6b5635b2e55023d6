"""Maps in degrees as they are on the ground, and how much heights are exaggerated."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.mesh import georeference


def chart(latitude=60.0, kind=pv.ImageData):
    """Return a map of half a degree with heights in metres."""
    grid = pv.ImageData(
        dimensions=(61, 61, 1), spacing=(1 / 120, 1 / 120, 1), origin=(11, latitude - 0.25, 0)
    )
    x, y, _ = grid.points.T
    grid["height"] = 1000 * np.sin(40 * (x - 11)) + 500 * np.cos(50 * y)
    grid.field_data["unit"] = ["degree"]
    if kind is pv.RectilinearGrid:
        return grid.cast_to_rectilinear_grid()
    return grid if kind is pv.ImageData else grid.cast_to_structured_grid()


def haversine(a, b):
    """Return the length of the great circle between two places in degrees."""
    (x, y), (u, v) = np.radians(a), np.radians(b)
    h = np.sin((v - y) / 2) ** 2 + np.cos(y) * np.cos(v) * np.sin((u - x) / 2) ** 2
    return 2 * 6_371_008.8 * np.arcsin(np.sqrt(h))


@pytest.mark.parametrize("kind", [pv.ImageData, pv.RectilinearGrid, pv.StructuredGrid])
def test_lengths_are_those_on_the_sphere(kind):
    grid = chart(kind=kind)
    moved = georeference.in_metres(grid)
    assert type(moved) is kind
    np.testing.assert_allclose(moved.center, 0, atol=1e-6)
    for end in (60, 3660):
        length = np.linalg.norm(moved.points[end] - moved.points[0])
        assert length == pytest.approx(
            haversine(grid.points[0, :2], grid.points[end, :2]), rel=0.01
        )
    assert georeference.in_metres(moved) is moved


def test_light_of_a_map_in_degrees_is_that_of_the_map_in_metres():
    grid = chart()
    scene = vizlight.Scene(lights=vizlight.Light(direction=(-1, 1, 0.6)))
    t = vizlight.relief_shadow(grid, scene)["t"]
    known = vizlight.relief_shadow(georeference.in_metres(grid), scene)["t"]
    # Compiled code, where it pays by then, rounds otherwise.
    np.testing.assert_allclose(t, known, rtol=0, atol=1e-12)
    assert 0.3 < t.mean() < 0.9
    plain = grid.copy()
    plain.field_data.clear()
    assert abs(vizlight.relief_shadow(plain, scene)["t"] - t).mean() > 0.1


def test_a_relief_that_nobody_sees_is_told_with_its_remedy():
    grid = chart()
    grid["height"] *= 1e-4
    scene = vizlight.Scene(lights=vizlight.Light(direction=(-1, 1, 0.6)))
    with pytest.warns(UserWarning, match=r"range over 5e-06 of its side.*pass exaggeration=10000"):
        flat = vizlight.relief_shadow(grid, scene, lit=True)["luminance"]
    raised = vizlight.relief_shadow(grid, scene, exaggeration=1e4, lit=True)["luminance"]
    assert np.ptp(flat) < 1e-3 < 0.1 < np.ptp(raised)


def test_a_volume_over_a_map_is_stretched_until_it_can_be_seen():
    air = pv.ImageData(dimensions=(5, 5, 4), spacing=(0.1, 0.1, 5.0), origin=(11, 50, 0))
    air.field_data["unit"] = ["degree"]
    before = np.array(air.points)
    factor = georeference.stretch(air)
    x, y, z = vizlight.files.stretched(air, factor).bounds_size
    assert factor == 100
    assert (y, z) == pytest.approx((0.4 * 111_195, 1500), rel=1e-3)
    assert 0.6 < x / y < 0.7  # the cosine of the latitude
    np.testing.assert_array_equal(air.points, before)
    air.field_data.clear()
    assert georeference.stretch(air) == georeference.stretch(pv.Sphere()) == 1
    flat = chart()
    assert georeference.stretch(flat) == 1


def test_a_raised_map_is_in_metres_without_its_holes():
    grid = chart()
    grid["height"][:7] = np.nan
    raised = vizlight.files.warped(grid, "height", 2.0)
    assert raised.points.dtype == np.float64
    assert np.isfinite(raised.points).all()
    assert raised.bounds_size[1] == pytest.approx(0.5 * 111_195, rel=1e-3)
    assert raised.bounds_size[2] == pytest.approx(2 * np.ptp(grid["height"][7:]))


@pytest.mark.parametrize(
    ("scale", "expected"), [(1.0, 1.0), (0.1, 5.0), (1e-4, 5e3), (100.0, 0.05), (0.0, 1.0)]
)
def test_heights_are_exaggerated_until_they_can_be_seen(scale, expected):
    grid = chart()
    grid["height"] *= scale
    grid["height"][5] *= 1e3  # one wrong height does not change the range
    assert georeference.exaggeration(grid, "height") == expected


def test_the_whole_earth_is_taken_for_it_and_other_planets_are_not():
    def grid(west, south, *, thick=1):
        return pv.ImageData(dimensions=(73, 37, thick), spacing=(5, 5, 1), origin=(west, south, 0))

    assert georeference.is_earth(grid(-180, -90))
    assert georeference.is_earth(grid(0, -90))
    for other in (grid(-90, -90), grid(-180, -60), grid(-180, -90, thick=2)):
        assert not georeference.is_earth(other)
    earth = georeference.in_degrees(grid(-180, -90))
    assert georeference.has_degrees(earth)
    assert not georeference.is_earth(earth)  # said, not seen
    assert georeference.on_earth(earth)
    for radius, here in ((6378137, True), (6370000.0, True), (3396190, False)):
        earth.field_data["crs"] = [f'GEOGCS["A",DATUM["D",SPHEROID["S",{radius},0]]]']
        assert georeference.on_earth(earth) is here
    with pytest.raises(ValueError, match="mesh: expected a mesh whose y is a latitude"):
        georeference.in_degrees(pv.Plane(i_size=1000, j_size=1000))
