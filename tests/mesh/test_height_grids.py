"""Surfaces that are terrains by their shape, and others."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.mesh import height_grids


def terrain(high=60.0, wide=500.0):
    """Return triangles with hills, as high and as wide as given."""
    plane = pv.Plane(i_size=wide, j_size=wide, i_resolution=12, j_resolution=12).triangulate()
    x, y, _ = plane.points.T / wide
    plane.points[:, 2] = high * np.sin(8 * x) * np.cos(7 * y + x)
    plane.clear_data()
    return plane


def tent():
    """Return a roof with two slopes, as of a part."""
    roof = terrain()
    roof.points[:, 2] = 50 - 0.2 * np.abs(roof.points[:, 0])
    return roof


@pytest.mark.parametrize(("surface", "expected"), [
    (terrain(), True),
    (terrain().flip_faces(), True),
    # A model of it as wide as a hand, a wall of hills, and one below another.
    (terrain(wide=40.0, high=4.0), False),
    (terrain(high=400.0), False),
    (terrain() + terrain().translate((0, 0, 200)), False),
    (tent(), False),
    (terrain().extrude((0, 0, -100), capping=True), False),
    (pv.Sphere(radius=300), False),
    (pv.Line(), False),
])  # fmt: skip
def test_a_surface_is_a_terrain_by_its_shape(surface, expected):
    assert height_grids.is_terrain(surface) is expected


def test_a_terrain_is_shown_by_its_heights():
    surface = terrain()
    look = vizlight.look(surface, size=(120, 80))
    assert (look.question, look.shown) == ("relief", "sheet")
    assert "a terrain by its shape" in str(look)
    # The lit mesh stands as the surface does; the one that is drawn is a map.
    np.testing.assert_array_equal(look.mesh.points, surface.points)
    shown = look.drawing.layers[0].mesh.run()
    assert shown.bounds_size[2] == 0
    np.testing.assert_allclose(shown["Elevation"], surface.points[:, 2], rtol=1e-6)
    assert vizlight.look(surface, view="iso").question == "shape"
    assert vizlight.look(surface, "shape").question == "shape"


def test_the_sky_is_above_a_terrain_whose_normals_point_down():
    surface = terrain().compute_normals(cell_normals=False)
    below = surface.copy()
    below["Normals"] = -surface["Normals"]
    lit = [
        vizlight.relief_shadow(each, lit=True, raster=0.0, occlusion="sky")["luminance"]
        for each in (surface, below)
    ]
    np.testing.assert_array_equal(*lit)
