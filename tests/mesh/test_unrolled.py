"""Faces of the globe on a map: it is covered once, however the globe is turned."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import files
from vizlight.mesh import unrolled

xr = pytest.importorskip("xarray")
pytest.importorskip("cf_xarray")

EARTH = pv.Icosphere(nsub=2)


def degrees(points):
    """Return the longitudes and latitudes of points."""
    x, y, z = (points / np.linalg.norm(points, axis=1)[:, np.newaxis]).T
    return np.degrees(np.arctan2(y, x)), np.degrees(np.arcsin(np.clip(z, -1, 1)))


@pytest.mark.parametrize("turn", [(0, 0), (31, 0), (90, 0), (12, 77), (58.2825, 0)])
def test_a_globe_covers_the_map_once(turn):
    globe = EARTH.rotate_x(turn[0]).rotate_z(turn[1])
    lon, lat = degrees(np.asarray(globe.points))
    ids = globe.regular_faces
    faces = unrolled.unrolled(lon, lat, ids, np.ones(ids.shape, np.bool_))
    mesh = faces.mesh()
    assert mesh.bounds[:4] == pytest.approx((-180, 180, -90, 90), abs=1e-4)
    assert mesh.compute_cell_sizes()["Area"].sum() == pytest.approx(360 * 180, rel=1e-5)
    np.testing.assert_array_equal(faces.faces[: len(ids)], np.arange(len(ids)))
    # Points between nodes have values between theirs, and are where these say.
    found = faces.at_points(lat)
    polar = np.abs(faces.places[:, 1]) > 89.9
    np.testing.assert_allclose(found[~polar], faces.places[~polar, 1], atol=1e-6)
    assert {*np.unique(faces.at_points(np.arange(len(lon))))} <= {*range(len(lon))}
    # The middle of each face is in one of its parts.
    middle = degrees(np.asarray(globe.points)[ids].mean(axis=1))
    for i in range(0, len(ids), 7):
        cell = mesh.find_containing_cell((middle[0][i], middle[1][i], 0))
        assert faces.faces[cell] == i or abs(middle[1][i]) > 75


@pytest.mark.parametrize("west", [-170, -20, 10, 100, 165, 179.5])
def test_a_region_is_in_one_piece(west):
    plane = pv.Plane(i_size=30, j_size=20, center=(west + 15, 5, 0), i_resolution=9)
    lon, lat, _ = np.asarray(plane.points).T
    for turned in (lon, lon % 360, (lon + 180) % 360 - 180):
        ids = plane.regular_faces
        mesh = unrolled.unrolled(turned, lat, ids, np.ones(ids.shape, np.bool_)).mesh()
        assert mesh.n_cells == plane.n_cells
        start = west - 360 * (west + 15 > 180)
        assert mesh.bounds[:4] == pytest.approx((start, start + 30, -5, 15))


def polar(n=24, levels=2):
    """Return a dataset on a grid around the north pole, with values that are its latitudes."""
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    lat = 90 - 30 * np.hypot(x, y)
    lon = np.degrees(np.arctan2(y, x)) % 360
    lat[0, 0] = lon[0, 0] = -999
    t = np.stack([lat + 100 * k for k in range(levels)])
    wind = {"u": (("lev", "j", "i"), np.ones_like(t)), "v": (("lev", "j", "i"), np.zeros_like(t))}
    return xr.Dataset(
        {"t": (("lev", "j", "i"), t), **wind},
        {"lev": ("lev", [1000.0, 850.0][:levels], {"units": "hPa"}),
         "lon": (("j", "i"), lon, {"units": "degrees_east"}),
         "lat": (("j", "i"), lat, {"units": "degrees_north"})},
    )  # fmt: skip


def test_a_grid_around_a_pole_is_whole():
    mesh = vizlight.read(polar().isel(lev=0, drop=True))
    # All around at every latitude that the grid has all around.
    above = mesh.clip("y", origin=(0, 65, 0), invert=False)
    assert above.compute_cell_sizes()["Area"].sum() == pytest.approx(360 * 25, rel=1e-3)
    lat = np.asarray(mesh.points)[:, 1]
    used = np.unique(mesh.faces) if mesh.is_all_triangles else np.flatnonzero(lat > 50)
    far = used[lat[used] < 88]
    np.testing.assert_allclose(mesh["t"][far], lat[far], atol=1e-6)


def test_one_layer_of_a_volume_around_a_pole_is_shown():
    data = polar()
    volume = vizlight.read(data)
    assert files.layers(volume) == 2
    for at, added in ((0, 0), (1, 100)):
        layer = files.layer_of(volume, at)
        assert np.ptp(np.asarray(layer.points)[:, 2]) == 0
        flat = np.asarray(layer.points)
        far = flat[:, 1] < 88
        np.testing.assert_allclose(layer["t"][far], flat[far, 1] + added, atol=1e-4)
        above = layer.clip("y", origin=(0, 65, 0), invert=False)
        assert above.compute_cell_sizes()["Area"].sum() == pytest.approx(360 * 25, rel=1e-2)
    look = vizlight.look(data, size=(90, 60))
    assert look.shown == "sheet"
    assert any("the lowest of 2 layers is shown" in note for note in look.notes)


def test_a_mesh_without_levels_has_no_layers():
    ball = pv.SolidSphere(radius_resolution=3, theta_resolution=6, phi_resolution=5)
    assert files.layers(ball) == 0
    with pytest.raises(TypeError, match="an image or a grid"):
        files.layer_of(ball, 0)
