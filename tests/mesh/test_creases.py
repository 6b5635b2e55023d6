"""Points are split part by part as VTK splits those of the whole surface."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.mesh import creases
from vizlight.reading import cells, normals, orientation, topology


def plain(mesh):
    mesh.clear_data()
    return mesh


def turned_over():
    box = pv.Cube().triangulate().subdivide(2).clean()
    faces = box.regular_faces.copy()
    faces[::7] = faces[::7, ::-1]
    return pv.PolyData.from_regular_faces(box.points, faces)


def tips():
    """Two cones that meet at their tips alone."""
    cone = plain(pv.Cone(resolution=12).triangulate())
    other = cone.rotate_y(180, point=(cone.bounds[1], 0, 0))
    return cone.append_polydata(other).clean()


def tangle():
    rng = np.random.default_rng(0)
    faces = [row for row in rng.integers(0, 90, (300, 3)) if len(set(row)) == 3]
    return pv.PolyData.from_regular_faces(rng.random((90, 3)), np.array(faces))


SURFACES = {
    "box": lambda: plain(pv.Cube().triangulate().subdivide(2).clean()),
    "quads": lambda: plain(pv.Box(level=4).clean()),
    "polygons": lambda: plain(pv.Cylinder(resolution=9).clean()),
    "turned over": turned_over,
    "tips": tips,
    "tangle": tangle,
}


@pytest.mark.parametrize("name", SURFACES)
def test_parts_are_split_like_the_whole(name):
    mesh = SURFACES[name]()
    whole = mesh.compute_normals(
        cell_normals=False, split_vertices=True, feature_angle=25, consistent_normals=True,
        auto_orient_normals=False, non_manifold_traversal=False,
    )  # fmt: skip
    assert whole.n_points > mesh.n_points
    ids, ends = cells.connectivity(mesh.GetPolys())
    for size in (7, 40, None):
        corners, origin = creases.split(mesh.points, ids, ends, 25, size)
        np.testing.assert_array_equal(corners, cells.connectivity(whole.GetPolys())[0])
        np.testing.assert_array_equal(mesh.points[origin], whole.points)


@pytest.mark.parametrize("name", SURFACES)
def test_normals_do_not_depend_on_the_size_of_parts(name, monkeypatch):
    mesh = SURFACES[name]()
    own = [normals.computed_normals(mesh, as_wound=wound) for wound in (False, True)]
    monkeypatch.setattr(topology, "EDGES", 64)
    monkeypatch.setattr(orientation, "BLOCK", 16)
    for before, wound in zip(own, (False, True), strict=True):
        after = normals.computed_normals(mesh, as_wound=wound)
        np.testing.assert_array_equal(after.vectors, before.vectors)
        np.testing.assert_array_equal(after.lean, before.lean)
        np.testing.assert_array_equal(after.open, before.open)
        assert after.sharp == before.sharp


def test_a_surface_without_creases_is_surveyed_once(monkeypatch):
    made = []

    class Counted(orientation.Shape):
        def __init__(self, *given):
            made.append(self)
            super().__init__(*given)

    monkeypatch.setattr(normals, "Shape", Counted)
    ball = plain(pv.Sphere())
    scene = vizlight.Scene(lights=vizlight.Light(direction=(1, 1, 1)))
    lit = vizlight.illuminate(ball, scene, feature_angle="auto")
    assert len(made) == 1
    np.testing.assert_array_equal(lit["luminance"], vizlight.illuminate(ball, scene)["luminance"])


def test_edges_at_the_angle_itself_are_split_alike_however_a_cylinder_is_turned():
    for turn in range(0, 90, 9):
        cylinder = pv.Cylinder(resolution=12).triangulate().clean().rotate_vector((1, 2, 3), turn)
        cylinder = pv.PolyData.from_regular_faces(cylinder.points, cylinder.regular_faces)
        split = vizlight.illuminate(cylinder, vizlight.Scene(), feature_angle=30)
        # The rim is split between the side and the caps, the side nowhere.
        assert split.n_points == 2 * cylinder.n_points
