"""Small meshes that are joined to be lit: each has the light that it has by itself."""

import warnings
from unittest.mock import Mock

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View
from vizlight.mesh import batches, normals
from vizlight.shading import engine
from vizlight.shading.options import LightOptions
from vizlight.vtk import normals as vtk_normals

LIGHTS = [Light(direction=(0.3, 0.2, 1)), Light(position=(1, 5, 2))]
SCENE = Scene(lights=LIGHTS, view=View(position=(3, 2, 9)))
COLORED = Scene(lights=LIGHTS, view=View(position=(3, 2, 9)), material=Material(color="red"))


def sheet(i, *, double=False, size=1.0):
    """Return a wave: sheets of successive numbers share the points of a border."""
    mesh = pv.Plane(center=(i, 0, 0), i_resolution=4, j_resolution=3 + i % 2).triangulate()
    mesh.clear_data()
    points = np.asarray(mesh.points, dtype=np.float64 if double else np.float32)
    points[:, 2] = np.sin(3 * points[:, 0]) / 5
    mesh.points = size * points
    return mesh


def ball(i, *, inward=False, carried=True, open_=False):
    mesh = pv.Sphere(center=(0.4 * i, 0, 0), theta_resolution=9, phi_resolution=7)
    if open_:
        mesh = mesh.extract_cells(range(9, mesh.n_cells)).extract_surface(algorithm=None)
    own = np.array(mesh.points) - [0.4 * i, 0, 0]
    mesh.clear_data()
    if carried:
        mesh.point_data["N"] = -own if inward else own
        mesh.point_data.active_normals_name = "N"
    return mesh


def turned(i, size):
    mesh = ball(i, carried=False).flip_faces()
    mesh.points = size * np.asarray(mesh.points, dtype=np.float64)
    return mesh


def volume(i):
    mesh = pv.ImageData(dimensions=(4, 3, 4), origin=(i, 0, 0)).to_tetrahedra()
    mesh.clear_data()
    return mesh


def ghosts(i):
    """Return a slab whose outer layer belongs to its neighbour."""
    mesh = volume(i)
    beyond = mesh.cell_centers().points[:, 0] > i + 2
    mesh.cell_data["vtkGhostType"] = beyond.astype(np.uint8)
    return mesh


def line(i, n=9):
    t = np.linspace(0, 3, n) + i
    mesh = pv.PolyData()
    mesh.points = np.stack([np.cos(t), np.sin(t), t], axis=1)
    mesh.SetLines(pv.CellArray.from_arrays([0, n], np.arange(n)))
    mesh.point_data["V"] = np.stack([-np.sin(t), np.cos(t), 0 * t + 1], axis=1)
    return mesh


def segments(i):
    mesh = line(i)
    mesh.SetLines(pv.CellArray.from_regular_cells(np.stack([np.arange(8), np.arange(1, 9)], 1)))
    return mesh


def broken(i):
    mesh = sheet(i)
    if i == 1:
        mesh.points[3] = np.nan
    return mesh


def vectors(i):
    mesh = sheet(i)
    mesh["V"] = np.cross(mesh.points, [0, 1.0, 0.2 * i])
    if i == 2:
        mesh["V"][4] = 0
    return mesh


CUBE = pv.Cube().triangulate().clean()
MESHES = {
    "sheets that touch": ([sheet(i) for i in range(5)], {}),
    "one sheet five times": ([sheet(0) for _ in range(5)], {}),
    "sheets and balls": (
        [sheet(0, double=True), ball(1, carried=False), sheet(2), ball(3, carried=False)], {},
    ),
    "sizes": ([sheet(1, double=True, size=size) for size in (1e-30, 1, 1e30)], {}),
    "sizes of balls turned inside out": (
        [turned(1, size) for size in (1, 1e-130, 1e30)], {"facing": "outward"},
    ),
    "balls with normals": ([ball(i, inward=i % 2) for i in range(4)], {}),
    "open and closed with normals": (
        [ball(0), ball(0, open_=True), ball(1, inward=True), ball(1, open_=True, inward=True)], {},
    ),
    "toward the eye": ([sheet(i) for i in range(3)], {"facing": "eye"}),
    "as given": ([sheet(i) for i in range(3)], {"facing": "as given"}),
    "volumes": ([volume(i) for i in range(3)], {}),
    "grids of both": ([volume(0), sheet(1).cast_to_unstructured_grid(), volume(2)], {}),
    "ghost cells": ([ghosts(2 * i) for i in range(3)], {}),
    "lines": ([line(i, 5 + i) for i in range(4)], {}),
    "segments": ([segments(0), line(1), segments(2), line(2)], {}),
    "tangents": ([vectors(i) for i in range(4)], {"tangents": "V"}),
    "conditioned": ([vectors(i) for i in range(4)], {"tangents": "V", "conditioned": True}),
    "components": ([sheet(i) for i in range(3)], {"components": True, "name": "own"}),
    "broken": ([broken(i) for i in range(3)], {}),
    "sharp": ([CUBE, sheet(0), CUBE], {}),
    "kinds": ([sheet(0), line(0), pv.ImageData(dimensions=(3, 3, 1)), sheet(1), line(1)], {}),
}  # fmt: skip


def contents(mesh):
    """Return all arrays of a mesh, those of the fields as text."""
    found = {f"point {key}": np.asarray(mesh.point_data[key]) for key in mesh.point_data}
    found |= {f"field {key}": np.asarray(mesh.field_data[key]) for key in mesh.field_data}
    return found | {"active": np.array(str(mesh.active_scalars_info))}


def lit(mesh, scene, options):
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        return vizlight.illuminate(mesh, scene, **options), said


@pytest.mark.parametrize("scene", [SCENE, COLORED, Scene(lights=LIGHTS[:1])], ids=str)
@pytest.mark.parametrize("name", MESHES)
def test_each_mesh_has_its_own_light(name, scene):
    meshes, options = MESHES[name]
    if scene.view is None:
        scene = scene.replace(material=Material(specular=0))
        if options.get("facing") == "eye":
            pytest.skip("no eye")
    alone = [lit(mesh, scene, options) for mesh in meshes]
    together, said = lit(pv.MultiBlock([*meshes, pv.MultiBlock([meshes[0]])]), scene, options)
    assert bool(said) == any(own for _, own in alone)
    for block, (mesh, _) in zip(together, alone, strict=False):
        one, other = contents(block), contents(mesh)
        assert one.keys() == other.keys()
        for key, array in one.items():
            np.testing.assert_array_equal(array, other[key], err_msg=key)
    np.testing.assert_array_equal(
        together[-1][0].active_scalars, alone[0][0].active_scalars, strict=True
    )


def test_like_meshes_are_joined_and_others_are_not():
    meshes = [sheet(0), line(0), sheet(1), sheet(2, double=True), ball(0), ball(1, carried=False)]
    paths = [""] * len(meshes)
    groups, parts = batches.parts_of(meshes, paths, SCENE, LightOptions(), join=True)
    assert sorted(group.members for group in groups) == [[0, 2, 5], [1], [3], [4]]
    assert len(parts) == len(groups)
    large = pv.Plane(i_resolution=70, j_resolution=70)
    groups, _ = batches.parts_of([large, large], ["", ""], SCENE, LightOptions(), join=True)
    assert len(groups) == 2


def test_an_error_names_the_block():
    blocks = pv.MultiBlock([vectors(0), vectors(1), vectors(2)])
    blocks[1]["V"] = np.zeros(blocks[1].n_points)
    with pytest.raises(ValueError, match=r"block /Block-01: tangents: expected"):
        vizlight.illuminate(blocks, SCENE, tangents="V")
    blocks = pv.MultiBlock([vectors(i) for i in range(3)])
    with pytest.raises(ValueError, match=r"block /Block-00: .*conditioned"):
        vizlight.illuminate(blocks, SCENE, conditioned=True, model="phong")


def test_small_meshes_keep_no_normals_and_are_joined_again():
    large = pv.Plane(i_resolution=16, j_resolution=16)
    large.clear_data()
    lit = list(vizlight.illuminate(pv.MultiBlock([sheet(0), sheet(1), large]), SCENE))
    assert [normals.KEPT in block.point_data for block in lit] == [False, False, True]
    groups, _ = batches.parts_of(lit, [""] * 3, SCENE, LightOptions(), join=True)
    assert sorted(group.members for group in groups) == [[0, 1], [2]]


@pytest.mark.parametrize("make", [sheet, vectors])
def test_joined_meshes_are_lit_by_one_run(make, monkeypatch):
    """Runs and normals, not meshes, take the time."""
    counts = []
    for module, name in ((engine, "run"), (vtk_normals, "computed_normals")):
        counts.append(Mock(side_effect=getattr(module, name)))
        monkeypatch.setattr(module, name, counts[-1])
    options = {"tangents": "V"} if make is vectors else {}
    lit(pv.MultiBlock([make(i) for i in (0, 1, 3) * 50]), SCENE, options)
    assert [count.call_count for count in counts] == [1, 1 if make is sheet else 0]
