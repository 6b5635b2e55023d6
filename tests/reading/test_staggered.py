"""Values at the sides of cells are averaged to their middles, and are then one wind."""

import numpy as np
import pytest

import vizlight
from vizlight.mesh import meaning

xr = pytest.importorskip("xarray")
pytest.importorskip("cf_xarray")

#: Places of the middles of cells along x and y.
X, Y = np.arange(6.0), np.arange(5.0)


def field(y, x):
    """Return values that are linear in the place, whose averages are exact."""
    return 10 * y[:, np.newaxis] + x


def sides(middles, *, outer):
    """Return the places of the sides of cells, those at both ends too or only those between."""
    return np.append(middles - 0.5, middles[-1] + 0.5)[slice(None) if outer else slice(1, -1)]


@pytest.mark.parametrize(
    ("outer", "names"),
    [
        (True, ("south_north", "west_east", "south_north_stag", "west_east_stag")),
        (True, ("yh", "xh", "yq", "xq")),
        (False, ("eta_rho", "xi_rho", "eta_v", "xi_u")),
    ],
)
def test_winds_on_both_sides_of_the_cells(outer, names):
    y, x, y_side, x_side = names
    data = xr.Dataset({
        "t": ((y, x), field(Y, X)),
        "p": ((y, x), field(Y, X)),
        "U": ((y, x_side), field(Y, sides(X, outer=outer)), {"units": "m s-1"}),
        "V": ((y_side, x), field(sides(Y, outer=outer), X), {"units": "m s-1"}),
    })  # fmt: skip
    mesh = vizlight.read(data)
    assert mesh.dimensions == (6, 5, 1)
    assert meaning.components(mesh) == [("U", "V")]
    assert "averaged from the sides of cells to their middles: U, V" in meaning.line(mesh)
    inside = np.ones((5, 6), bool)
    for name, edges in (("U", np.s_[:, [0, -1]]), ("V", np.s_[[0, -1]])):
        rows = np.asarray(mesh[name]).reshape(5, 6)
        known = inside.copy()
        # Where only the sides between cells have values, the outer cells have none.
        known[edges] = outer
        np.testing.assert_array_equal(np.isfinite(rows), known)
        np.testing.assert_allclose(rows[known], field(Y, X)[known])


def test_axes_with_other_coordinates_are_not_averaged():
    slat = ("slat", Y[1:] - 0.5, {"units": "degrees_north"})
    coords = {"lat": Y, "slat": slat, "lat_2": np.arange(4.0) * 7, "lon": X}
    data = xr.Dataset({
        "t": (("lat", "lon"), field(Y, X)), "T": (("lat", "lon"), field(Y, X)),
        "us": (("slat", "lon"), field(Y[1:] - 0.5, X)), "w": (("lat_2", "lon"), field(Y[:4], X)),
    }, coords)  # fmt: skip
    mesh = vizlight.read(data)
    assert {*mesh.point_data} == {"t", "T", "us"}
    np.testing.assert_allclose(np.asarray(mesh["us"]).reshape(5, 6)[1:-1], field(Y, X)[1:-1])
    assert "left out, on other axes: w" in meaning.line(mesh)


def test_the_wind_is_shown_before_the_angle_of_the_grid():
    lon, lat = np.meshgrid(X, Y)
    data = xr.Dataset({
        "angle": (("eta_rho", "xi_rho"), field(Y, X), {"long_name": "angle between XI and EAST"}),
        "lon_rho": (("eta_rho", "xi_rho"), lon + 0.1 * lat),
        "lat_rho": (("eta_rho", "xi_rho"), lat),
        "zeta": (("eta_rho", "xi_rho"), field(Y, X)),
    })  # fmt: skip
    look = vizlight.look(data, size=(90, 60))
    assert look.array == "zeta"
    wind = {"usur": (("eta_rho", "xi_u"), 1 + field(Y, X[1:]), {"units": "m/s"}),
            "vsur": (("eta_v", "xi_rho"), 1 + field(Y[1:], X), {"units": "m/s"})}  # fmt: skip
    assert vizlight.look(data.assign(wind), size=(90, 60)).array == "usur,vsur"
