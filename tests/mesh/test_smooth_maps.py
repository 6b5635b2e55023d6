"""Maps of few points as smooth grids of triangles."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals
from scipy.interpolate import PchipInterpolator

from vizlight.cartography import smoothed

RANDOM = np.random.default_rng(5)


def grid(kind=pv.ImageData):
    """Return a grid of 7 x 5 with random values."""
    mesh = pv.ImageData(dimensions=(7, 5, 1), spacing=(2, 3, 1), origin=(-1, 4, 2))
    mesh["v"] = RANDOM.normal(size=35)
    mesh.field_data["unit"] = ["degree"]
    if kind is pv.StructuredGrid:
        return mesh.cast_to_structured_grid()
    return mesh.cast_to_rectilinear_grid() if kind is pv.RectilinearGrid else mesh


@pytest.mark.parametrize("kind", [pv.ImageData, pv.RectilinearGrid, pv.StructuredGrid])
def test_points_keep_their_values_and_no_new_extreme_appears(kind):
    mesh = grid(kind)
    smooth = smoothed(mesh, "v", 6)
    assert smooth.n_points == 37 * 25
    assert smooth.n_cells == 2 * 36 * 24
    found = smooth["v"].reshape(25, 37)
    np.testing.assert_allclose(found[::6, ::6], mesh["v"].reshape(5, 7), rtol=1e-12)
    np.testing.assert_allclose(smooth.bounds, mesh.bounds)
    for row, rough in zip(found[::6], mesh["v"].reshape(5, 7), strict=True):
        np.testing.assert_allclose(row, PchipInterpolator(range(7), rough)(np.arange(37) / 6))
    assert mesh["v"].min() <= smooth["v"].min() <= smooth["v"].max() <= mesh["v"].max()
    assert str(smooth.field_data["unit"][0]) == "degree"


def test_lines_of_triangles_are_the_borders_of_their_colours():
    smooth = smoothed(grid(), "v", 4)
    lines = smooth.contour([0.1], scalars="v")
    at = smooth.find_closest_cell(lines.points)
    corners = smooth["v"][smooth.regular_faces[at]]
    assert ((corners.min(axis=1) <= 0.1 + 1e-9) & (corners.max(axis=1) >= 0.1 - 1e-9)).all()


def test_a_plane_stays_a_plane():
    mesh = grid(pv.StructuredGrid)
    mesh["v"] = mesh.points @ (1.0, -2.0, 0.0)
    smooth = smoothed(mesh, "v", 5)
    np.testing.assert_allclose(smooth["v"], smooth.points @ (1.0, -2.0, 0.0), atol=1e-5)


test_what_does_not_fit = refusals(
    smoothed,
    (pv.Plane(), "v", 2, "mesh: expected a grid", TypeError),
    (pv.ImageData(dimensions=(3, 3, 3)), "v", 2, "mesh: expected a grid of one"),
    (grid(), "w", 2, "name: expected a point array of one component"),
    (grid(), "v", 0, "factor"),
)


def test_values_end_halfway_to_missing_ones():
    mesh = grid()
    rough = mesh["v"].copy().reshape(5, 7)
    rough[2, 3] = rough[0, 0] = np.nan
    mesh["v"] = rough.ravel()
    smooth = smoothed(mesh, "v", 4)
    is_known = np.isfinite(smooth["v"])
    assert np.nanmin(rough) <= smooth["v"][is_known].min()
    assert smooth["v"][is_known].max() <= np.nanmax(rough)
    np.testing.assert_allclose(smooth.bounds, mesh.bounds)
    # All of it is drawn once: a part with values, and a part without.
    assert smooth.area == pytest.approx(12 * 12)
    for column, is_there in ((3, False), (3.25, False), (3.75, True), (4, True)):
        nearest = smooth.find_closest_point((-1 + 2 * column, 4 + 3 * 2, 2))
        assert np.isfinite(smooth["v"][nearest]) == is_there
    has_value = np.isfinite(mesh["v"])
    for place, value in zip(mesh.points[has_value], mesh["v"][has_value], strict=True):
        assert smooth["v"][smooth.find_closest_point(place)] == pytest.approx(value)


def test_a_map_without_a_value_is_refused():
    mesh = grid()
    mesh["v"] = np.full(35, np.nan)
    with pytest.raises(ValueError, match="finite places and values"):
        smoothed(mesh, "v", 2)
