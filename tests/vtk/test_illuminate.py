"""The filter of pipelines gives the light of the mesh filter, when it is asked for, on any cut."""

import dataclasses
import re
import subprocess
import sys

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals
from vtkmodules.vtkCommonDataModel import vtkTable
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkFiltersCore import vtkReverseSense
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkSphereSource

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View
from vizlight.shading.options import LightOptions
from vizlight.vtk import Illuminate, illuminate

SCENE = Scene(
    lights=[Light(direction=(1, 0.9, 0.5)), Light(position=(2, 3, 4), intensity=0.5)],
    view=View(position=(3, 1, 5)),
)
COPPER = SCENE.replace(material=Material(color="sandy_brown"))


def field():
    """Return an open surface with tangents, some of them zero, and without normals."""
    mesh = pv.Sphere(theta_resolution=40, phi_resolution=40, end_phi=130)
    mesh.clear_data()
    x, y, z = np.asarray(mesh.points).T
    mesh["around"] = np.stack([-y, x, 0 * z], axis=1)
    return mesh


def image():
    grid = pv.ImageData(dimensions=(6, 7, 8), spacing=(0.3, 0.2, 0.1))
    grid["V"] = 0.1 + np.cross(grid.points, (1, 2, 3))
    grid.cell_data["C"] = 0.1 + np.cross(grid.cell_centers().points, (3, 2, 1))
    return grid


CASES = {
    "normals": (pv.Sphere, {}),
    "faces": (field, {}),
    "field": (field, {"tangents": "around"}),
    "conditioned": (field, {"tangents": "around", "conditioned": True, "components": True}),
    "lines": (lambda: pv.Spline(np.random.default_rng(1).random((9, 3)), 200), {}),
    "cylinders": (lambda: pv.Spline(np.eye(3), 50), {"model": "cylinder"}),
    "image": (image, {"tangents": "V", "model": "blinn"}),
    "cells": (image, {"tangents": "C"}),
    "grid": (lambda: field().cast_to_unstructured_grid(), {"facing": "eye", "name": "own"}),
    "volume": (lambda: pv.Cube().triangulate().delaunay_3d(), {"precision": "float64"}),
    "curved": (pv.examples.cells.QuadraticTriangle, {}),
}


@pytest.mark.filterwarnings("ignore:.* cell array 'C' is averaged")
@pytest.mark.filterwarnings("ignore:.* points could not be lit", "ignore:.* edges are sharper")
@pytest.mark.parametrize("case", CASES)
def test_light_is_that_of_the_mesh_filter(case):
    make, options = CASES[case]
    mesh = make()
    before = mesh.copy()
    lit = Illuminate(COPPER, **options)
    lit.SetInputData(mesh)
    lit.AddObserver("WarningEvent", lambda *_: None)
    lit.Update()
    found, expected = pv.wrap(lit.GetOutput()), vizlight.illuminate(mesh, COPPER, **options)
    assert type(found) is type(mesh)
    assert mesh == before
    kept = [name for name in expected.point_data if name != "vizlight_normals"]
    assert sorted(found.point_data) == sorted(kept)
    for name in kept:
        np.testing.assert_array_equal(found[name], np.asarray(expected[name], found[name].dtype))
    name = options.get("name", "luminance")
    assert found.active_scalars_name == name
    record = vizlight.provenance(found, name)
    scene = Scene.from_dict(record["scene"])
    again = vizlight.illuminate(mesh, scene, **record["options"])
    np.testing.assert_array_equal(again[name], found[name])


def test_it_computes_when_asked_and_only_if_something_changed(monkeypatch):
    runs = []
    run = illuminate.engine.run
    monkeypatch.setattr(illuminate.engine, "run", lambda *a: runs.append(0) or run(*a))
    source, lit = vtkSphereSource(), Illuminate(SCENE)
    lit.SetInputConnection(source.GetOutputPort())
    assert not runs
    for change, count in (
        (lambda: None, 1),
        (lambda: None, 1),
        (lambda: setattr(lit, "model", "phong"), 1),
        (lambda: lit.SetScene(Scene(lights=SCENE.lights, view=SCENE.view)), 1),
        (lambda: lit.SetModel("blinn"), 2),
        (lambda: setattr(lit, "scene", COPPER), 3),
        (lambda: source.SetThetaResolution(20), 4),
    ):
        change()
        lit.Update()
        assert len(runs) == count
    assert (lit.model, lit.GetModel(), lit.GetScene()) == ("blinn", "blinn", COPPER)


def test_blocks_are_lit_one_by_one():
    blocks = pv.MultiBlock({"a": field(), "b": None, "c": pv.MultiBlock([pv.Plane()])})
    lit = Illuminate(SCENE)
    lit.SetInputDataObject(blocks)
    lit.Update()
    found, expected = pv.wrap(lit.GetOutputDataObject(0)), vizlight.illuminate(blocks, SCENE)
    assert found.keys() == blocks.keys()
    np.testing.assert_array_equal(found["a"]["luminance"], expected["a"]["luminance"])
    np.testing.assert_array_equal(found["c"][0]["luminance"], expected["c"][0]["luminance"])


def told(lit, event, **pieces):
    """Return the texts of an event while a filter runs."""
    said = []

    def hear(_, __, text):
        said.append(text)

    hear.CallDataType = "string0"
    lit.AddObserver(event, hear)
    lit.UpdatePiece(pieces.get("piece", 0), pieces.get("of", 1), 0)
    return said


@pytest.mark.parametrize(
    ("scene", "options", "of", "words"),
    [
        (SCENE, {"tangents": "V"}, 1, "tangents: .*point array .'Normals'.*'V'"),
        (SCENE, {"conditioned": True}, 1, "conditioned: expected tangents"),
        (SCENE, {"name": "Normals"}, 1, "name: .*no array of"),
        (SCENE, {"facing": "outward"}, 2, "facing: expected 'eye' or 'as given'"),
        (Scene(lights=[], depth_cue=DepthCue(front=0, back=1)), {}, 1, "view: expected a View"),
    ],
)
def test_what_does_not_fit_the_data_is_an_error_of_vtk(scene, options, of, words, caplog):
    source, lit = vtkSphereSource(), Illuminate(scene, **options)
    lit.SetInputConnection(source.GetOutputPort())
    (text,) = told(lit, "ErrorEvent", of=of)
    assert text.startswith("Illuminate: ")
    assert re.search(words, text)
    assert lit.GetOutput().GetNumberOfPoints() == 0
    lit.RemoveAllObservers()
    lit.Modified()
    lit.UpdatePiece(0, of, 0)
    assert text in caplog.text  # where PyVista puts the words of VTK's window
    # What is set next is lit.
    for name, value in (
        ("tangents", None), ("conditioned", False), ("name", "light"), ("facing", "eye"),
        ("scene", SCENE),
    ):  # fmt: skip
        setattr(lit, name, value)
    lit.UpdatePiece(0, of, 0)
    assert lit.GetOutput().GetPointData().HasArray("light")


test_bad_values_are_errors_when_they_are_set = refusals(
    lambda change: Illuminate(**change),
    ({"scene": 3}, "scene: expected a vizlight.Scene", TypeError),
    ({"scene": SCENE.replace(depth_cue=DepthCue())}, "depth_cue: .*front="),
    ({"model": "flat"}, "model"),
    ({"tangents": np.eye(3)}, "tangents: expected the name of a point array", TypeError),
    ({"refine": 0.1}, "refine: expected an option of Illuminate", TypeError),
    ({"tangent": "V"}, "did you mean tangents=", TypeError),
)


def test_every_option_that_fits_a_pipeline_is_a_property():
    fields = {field.name for field in dataclasses.fields(LightOptions)} - {*illuminate._WITHOUT}
    lit = Illuminate()
    for name in fields:
        assert getattr(lit, name) == getattr(lit.options, name)
        words = "".join(word.capitalize() for word in name.split("_"))
        assert getattr(lit, f"Get{words}")() == getattr(lit.options, name)


def test_light_does_not_depend_on_the_cut():
    source, whole = vtkSphereSource(), Illuminate(SCENE, facing="eye")
    source.SetThetaResolution(24)
    source.SetPhiResolution(24)
    whole.SetInputConnection(source.GetOutputPort())
    whole.Update()
    expected = pv.wrap(whole.GetOutput())
    assert "luminance_valid" not in expected.point_data
    lit = Illuminate(SCENE)
    lit.SetInputConnection(source.GetOutputPort())
    for piece in range(3):
        assert not told(lit, "WarningEvent", piece=piece, of=3)
        part = pv.wrap(lit.GetOutput())
        assert 0 < part.n_points < expected.n_points
        ids = [expected.find_closest_point(point) for point in part.points]
        np.testing.assert_allclose(part["luminance"], expected["luminance"][ids], atol=1e-6)
        assert part["luminance_valid"].all()


def test_pieces_without_neighbours_are_told_of_and_empty_ones_have_all_arrays():
    mesh = field()
    lit = Illuminate(COPPER, components=True)
    lit.SetInputData(mesh)
    (text,) = told(lit, "WarningEvent", of=2)
    assert "ghost cells before they are contoured" in text
    names = sorted(pv.wrap(lit.GetOutput()).point_data)
    mesh.cell_data["vtkGhostType"] = np.zeros(mesh.n_cells, np.uint8)
    lit.SetInputData(mesh)
    assert not told(lit, "WarningEvent", of=2)
    empty = pv.PolyData()
    lit.SetInputData(empty)
    lit.tangents, lit.conditioned = "around", True
    assert not told(lit, "ErrorEvent", of=2)
    found = lit.GetOutput().GetPointData()
    made = {found.GetArrayName(i) for i in range(found.GetNumberOfArrays())}
    assert made == set(names) - {"around"}
    information = lit.GetOutputInformation(0)
    assert information.Get(vtkStreamingDemandDrivenPipeline.UPDATE_NUMBER_OF_PIECES()) == 2


def test_data_without_points_are_an_error():
    lit = Illuminate(SCENE)
    for other, words in ((None, "got nothing"), (vtkTable(), "got vtkTable")):
        lit.SetInputDataObject(0, other)
        assert (
            f"input: expected a vtkDataSet or blocks of them, {words}" in told(lit, "ErrorEvent")[0]
        )
    lit.SetInputData(field())
    assert not told(lit, "ErrorEvent")


def test_points_that_could_not_be_lit_are_told_of():
    mesh = field()
    mesh["around"][:5] = 0
    lit = Illuminate(SCENE, tangents="around")
    lit.SetInputData(mesh)
    (text,) = told(lit, "WarningEvent")
    assert "points could not be lit" in text
    assert np.count_nonzero(pv.wrap(lit.GetOutput())["luminance_valid"] == 0) >= 5


def test_it_runs_where_there_is_no_pyvista():
    code = (
        "import sys; sys.modules['pyvista'] = None\n"
        "import vizlight; from vtkmodules.vtkFiltersSources import vtkPlaneSource\n"
        "scene = vizlight.Scene(lights=vizlight.Light(direction=(0, 0, 1), color='gold'),\n"
        "    view=vizlight.View(direction=(0, 0, 1)))\n"
        "source, lit = vtkPlaneSource(), vizlight.vtk.Illuminate(scene)\n"
        "lit.SetInputConnection(source.GetOutputPort()); lit.Update()\n"
        "print(lit.GetOutput().GetPointData().GetScalars().GetRange())"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    source = vtkPlaneSource()
    source.Update()
    lit = vizlight.illuminate(
        pv.wrap(source.GetOutput()),
        Scene(lights=Light(direction=(0, 0, 1)), view=View(direction=(0, 0, 1))),
    )
    low, high = lit.get_data_range("luminance")
    assert run.stdout.strip() == f"({float(low)}, {float(high)})"


def test_normals_as_given_stay_so_in_pieces():
    """A sphere turned inside out is lit on the side that it says, not on that of the eye."""
    source, turned = vtkSphereSource(), vtkReverseSense()
    turned.SetInputConnection(source.GetOutputPort())
    turned.ReverseNormalsOn()
    light = {}
    for facing in ("as given", "eye"):
        lit = Illuminate(SCENE, facing=facing)
        lit.SetInputConnection(turned.GetOutputPort())
        lit.UpdatePiece(0, 2, 0)
        part = pv.wrap(lit.GetOutput())
        toward = np.asarray(part["Normals"]) @ (1, 0.9, 0.5)
        light[facing] = part["luminance"][toward < -1.2].mean()
    assert light["eye"] > light["as given"] + 0.2
