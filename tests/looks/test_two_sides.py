"""Surfaces that are drawn from both sides, and those that are not."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.mesh import brains


def ball(sizes, values):
    mesh = pv.Sphere(theta_resolution=40, phi_resolution=40).scale(sizes)
    mesh["heat"] = values(*np.asarray(mesh.points, dtype=np.float64).T)
    return mesh


def shown(mesh, **options):
    drawing = vizlight.look(mesh, **options).drawing
    return [layer.mesh.path for layer in drawing.layers]


@pytest.mark.parametrize(
    ("sizes", "values", "names"),
    [
        ((3, 2, 1), lambda x, y, z: z + x**2, ["From z", "From -z"]),
        ((3, 1, 2), lambda x, y, z: y + x, ["From -y", "From y"]),
        ((3, 2, 1), lambda x, y, z: x**2, None),
        ((3, 2, 1.8), lambda x, y, z: z + x**2, None),
    ],
)
def test_a_flattened_surface_has_two_sides_where_its_values_differ(sizes, values, names):
    drawing = vizlight.look(ball(sizes, values)).drawing
    paths = [layer.mesh.path for layer in drawing.layers]
    if names is None:
        assert "[]" not in paths
        return
    assert paths == ["[]", "[]", "render.captions"]
    assert drawing.layers[0].mesh.arguments[0].run().keys() == names
    # One eye sees all of it, and the lit mesh is the surface alone.
    assert drawing.camera.run().parallel_projection
    assert drawing.lit.run().n_points == drawing.layers[0].mesh.run().n_points


def test_a_view_or_a_turn_shows_one_side():
    mesh = ball((3, 2, 1), lambda x, y, z: z + x**2)
    assert shown(mesh, view="x") == ["-"]
    turned = vizlight.look(mesh).drawing.of_turns
    assert [layer.mesh.path for layer in turned.layers] == ["-"]
    assert turned.camera.run().focal_point == pytest.approx((0, 0, 0), abs=1e-3)


def test_a_hemisphere_of_the_cortex_has_named_sides_and_a_unit():
    mesh = pv.Icosphere(radius=1, nsub=5).scale((34, 85, 60)).translate((35, 0, 0))
    mesh["thickness"] = np.cos(np.asarray(mesh.points)[:, 1] / 9)
    assert brains.hemisphere(mesh) == "right"
    assert brains.hemisphere(mesh.translate((-70, 0, 0))) == "left"
    assert brains.hemisphere(mesh.translate((-35, 0, 0))) == ""
    assert brains.hemisphere(mesh.scale(0.1)) == ""
    # One that is inflated lies around the origin, and is larger.
    inflated = mesh.scale(1.4).translate(-1.4 * np.array(mesh.center))
    inflated.rename_array("thickness", "lh.thickness")
    assert brains.hemisphere(inflated) == "left"
    drawing = vizlight.look(mesh).drawing
    blocks = drawing.layers[0].mesh.arguments[0].run()
    assert blocks.keys() == ["Right hemisphere, lateral", "Right hemisphere, medial"]
    assert drawing.keys[0]["title"] == "cortical thickness (mm)"
    mesh["curv_left"] = mesh["thick_left"] = mesh["thickness"]
    assert vizlight.look(mesh, array="curv_left").key[0]["title"] == "curvature (1/mm)"
    assert vizlight.look(mesh, array="thick_left").key[0]["title"] == "cortical thickness (mm)"
    # Its front is at the right of the lateral side, which is the right one, toward x.
    captions = drawing.layers[-1].mesh
    assert captions.path == "render.captions"
    assert captions.keywords["ends"] == [["posterior", "anterior"], ["anterior", "posterior"]]
    assert captions.keywords["unit"] == "mm"
    assert drawing.layers[0].mesh.arguments[0].arguments[1] == (1.0, 0.0, 0.0)
