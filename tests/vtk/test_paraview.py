"""The plugin in a real ParaView lights points as vizlight does, on one rank and on two."""

import contextlib
import io
import re

import numpy as np
import pytest
import pyvista as pv
import real_paraview
from lamps import SHINY, shiny
from PIL import Image
from scipy.spatial import cKDTree

import vizlight
from vizlight import Light, Scene, View, cli

SIZE = 240
CAMERAS = ([30, 15, 13.5], [-10, 30, 25])
HEAD = """
import sys
from paraview.simple import *
LoadPlugin(sys.argv[1], ns=globals())
disk, suffix = OpenDataFile(sys.argv[2]), sys.argv[3]

def contour(source, name, value, normals):
    made = Contour(source, ContourBy=["POINTS", name], Isosurfaces=[value])
    made.ComputeNormals = normals
    return made

def lit(name, source, **values):
    made = VizlightIlluminate(Input=source, Light=[1, 0.9, 0.5], Eye=[0.3, 0.4, 1], **values)
    made.UpdatePipeline()
    SaveData(name + suffix, made)
    return made

"""
#: On one rank: properties, an error, and pictures whose light follows the eye.
ONE = """
surface = contour(disk, "Temp", 600, 1)
flow = lit("flow", surface, Tangents="V", Conditioned=1, Terms=1, Specular=0.3, Color=[1, 0.5, 0])
domain = flow.SMProxy.GetProperty("Tangents").FindDomain("vtkSMArrayListDomain")
print("offered", *sorted(domain.GetString(i) for i in range(domain.GetNumberOfStrings())))
lit("near", surface, LightType="position", ParallelProjection=0, Model="blinn", Shininess=9)
lit("head", surface, LightType="headlight")
VizlightIlluminate(Input=surface, Light=[0, 0, 0]).UpdatePipeline()
shown = VizlightIlluminate(Input=surface, Tangents="V", Conditioned=1, Light=[1, 0.9, 0.5])
view = GetActiveViewOrCreate("RenderView")
view.ViewSize, view.UseColorPaletteForBackground, view.Background = [SIZE, SIZE], 0, [0, 0, 0]
view.OrientationAxesVisibility = view.UseFXAA = view.MultiSamples = 0
display = Show(shown, view)
ColorBy(display, ("POINTS", "luminance"))
colors = GetColorTransferFunction("luminance")
colors.ApplyPreset("Grayscale", True)
colors.RescaleTransferFunction(0, 1)
display.Ambient, display.Diffuse, display.Specular = 1, 0, 0
import vizlight_eye
vizlight_eye.follow(view=view)
for i, position in enumerate(CAMERAS):
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = position, [0, 0, 5], [0, 0, 1]
    ResetCamera(view)  # which moves and updates
    SaveScreenshot(f"{i}.png", view, ImageResolution=[SIZE, SIZE])
    print("camera", *view.CameraPosition, *view.CameraFocalPoint)
print("alone", "pyvista" not in sys.modules)
"""
#: On any number of ranks: rank 0 has all of the disk, of which `parts` gives each a share.
RANKS = """
waves = Wavelet()
slope = Gradient(waves, ScalarArray=["POINTS", "RTData"], ResultArrayName="V")
lit("given", contour(slope, "RTData", 157, 1), Tangents="V", Conditioned=1)
lit("one", contour(disk, "Temp", 600, 1))
parts = RedistributeDataSet(disk)
ghosts = GhostCellsGenerator(parts, BuildIfRequired=0)
lit("ghosts", contour(ghosts, "Temp", 600, 0))
print("next")
lit("bare", contour(parts, "Temp", 600, 0))
"""


@pytest.fixture(scope="module")
def files():
    """Return the paths that the command line prints."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        assert cli.main(["paraview"]) == 0
    return dict(re.findall(r"(\w+) +(?:PYTHONPATH=)?(\S+)", said.getvalue()))


def start(folder, files, text, suffix, **options):
    arguments = files["plugin"], vizlight.example_path(), suffix
    return real_paraview.run(folder, HEAD + text, *arguments, path=files["start"], **options)


@pytest.mark.slow
@pytest.mark.opengl
@real_paraview.needed
def test_light_is_that_of_vizlight_and_follows_the_eye(tmp_path, files):
    text = ONE.replace("SIZE", str(SIZE)).replace("CAMERAS", repr(CAMERAS))
    said = start(tmp_path, files, text, ".vtp")
    assert "alone True" in said
    # Arrays of three components alone are offered.
    assert "offered None Normals V\n" in said, said
    assert "Light, direction: expected a direction of non-zero length" in said
    far, eye = Light(direction=(1, 0.9, 0.5)), View(direction=(0.3, 0.4, 1))
    orange = shiny(specular=0.3, color=(1, 0.5, 0))
    scenes = {
        "flow": (
            Scene(lights=far, view=eye, material=orange),
            {"tangents": "V", "conditioned": True, "components": True},
        ),
        "near": (
            Scene(
                lights=Light(position=(1, 0.9, 0.5)), view=View(position=(0.3, 0.4, 1)),
                material=shiny(shininess=9),
            ),
            {"model": "blinn"},
        ),
        "head": (Scene(lights=Light.headlight(), view=eye, material=SHINY), {}),
    }  # fmt: skip
    for name, (scene, options) in scenes.items():
        found = pv.read(tmp_path / f"{name}.vtp")
        mine = vizlight.illuminate(found, scene, facing="eye", **options)
        for part in ("luminance", "ambient", "diffuse", "specular", "rgb"):
            assert (part in found.point_data) == (part in mine.point_data), (name, part)
            if part in found.point_data:
                np.testing.assert_allclose(found[part], mine[part], atol=1e-6)
        assert np.std(found["luminance"]) > 0.02, name
    surface = vizlight.load_example().contour([600], scalars="Temp")
    # ParaView's contours have VTK's normals.
    surface = surface.compute_normals(
        cell_normals=False, split_vertices=False, consistent_normals=False
    )
    places = re.findall(r"^camera (.*)$", said, re.M)
    assert len(places) == len(CAMERAS)
    for i, place in enumerate(places):
        position, focal = np.reshape([float(x) for x in place.split()], (2, 3)).tolist()
        scene = Scene(lights=far, view=View(position=position), material=SHINY)
        mine = vizlight.illuminate(surface, scene, tangents="V", conditioned=True, facing="eye")
        plotter = pv.Plotter(off_screen=True, window_size=[SIZE, SIZE])
        plotter.background_color = "black"
        plotter.disable_anti_aliasing()
        plotter.add_mesh(
            mine, scalars="luminance", cmap="gray", clim=(0, 1), lighting=False,
            show_scalar_bar=False,
        )  # fmt: skip
        plotter.camera.position, plotter.camera.focal_point = position, focal
        plotter.camera.up = (0, 0, 1)
        plotter.renderer.ResetCameraClippingRange()
        ours = np.asarray(plotter.screenshot(return_img=True), dtype=float)
        theirs = np.asarray(Image.open(tmp_path / f"{i}.png").convert("RGB"), dtype=float)
        seen = np.any(ours > 0, axis=2) & np.any(theirs > 0, axis=2)
        error = np.abs(ours - theirs).max(axis=2)[seen]
        assert np.count_nonzero(seen) > 4000
        # Colour maps of 256 entries round to either side; a light from elsewhere differs by 30.
        assert np.mean(error <= 2) > 0.98, np.percentile(error, [50, 98, 99, 100])
        assert np.mean(error) < 0.5


@pytest.mark.slow
@real_paraview.needed
def test_two_ranks_are_equal_to_one(tmp_path, files):
    said = start(tmp_path, files, RANKS, ".pvtp", ranks=2)
    before, after = said.split("next", 1)
    assert "ghost cells before they are contoured" not in before, before
    assert "ghost cells before they are contoured" in after
    start(tmp_path, files, RANKS, ".vtp", ranks=1)
    # Two ranks may find a point of an edge from either of its ends, one rounding of float32 apart,
    # which turns the normals of small faces.
    for name, limit in (("given", 1e-6), ("one", 1e-6), ("ghosts", 1e-5), ("bare", 1)):
        whole = pv.read(tmp_path / f"{name}.vtp")
        tree, count, largest = cKDTree(whole.points), 0, 0.0
        for path in (tmp_path / name).glob("*.vtp"):
            part = pv.read(path)
            count += part.n_points > 0
            shown = np.zeros(part.n_points, dtype=bool)
            ghost = part.cell_data.get("vtkGhostType", np.zeros(part.n_cells, np.uint8))
            shown[part.regular_faces[ghost & 1 == 0]] = True
            distance, ids = tree.query(part.points[shown])
            assert distance.max() < 1e-6 * whole.length
            error = np.abs(part["luminance"][shown] - whole["luminance"][ids]).max()
            largest = max(largest, float(error))
        assert count == (1 if name == "one" else 2)
        assert largest <= limit, (name, largest)
        # Without neighbours light at the border is another one, of which the warning tells.
        assert (largest > 0.01) == (name == "bare"), (name, largest)
