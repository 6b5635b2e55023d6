"""glTF files hold the light that does not depend on the eye, linear, and are valid."""

import json
import os
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from fields import half_known, swatches
from lamps import SHINY, shiny

import vizlight
from vizlight import Light, Material, Scene, View
from vizlight.files import FileError
from vizlight.vtk.corners import surface_normals

FAR = Light(direction=(1, 0.9, 0.5))
#: Folder with the npm package gltf-validator: that of the viewer's recipe, or of a variable.
MODULES = Path(vizlight.__file__).parent / "draw" / "web" / "node_modules"
MODULES = Path(os.environ.get("VIZLIGHT_NODE_MODULES", MODULES))


def content(path):
    """Return the JSON of a file, and its arrays by the indices of their accessors."""
    data = path.read_bytes()
    magic, version, size = struct.unpack_from("<4sII", data)
    assert (magic, version, size) == (b"glTF", 2, len(data))
    (length,) = struct.unpack_from("<I", data, 12)
    text = json.loads(data[20 : 20 + length])
    buffer = data[28 + length :]
    kinds = {5126: "<f4", 5123: "<u2", 5125: "<u4"}
    arrays = []
    for accessor in text["accessors"]:
        view = text["bufferViews"][accessor["bufferView"]]
        part = buffer[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
        rows = np.frombuffer(part, kinds[accessor["componentType"]])
        arrays.append(rows.reshape(accessor["count"], -1))
    return text, arrays


def shown(text, arrays):
    """Return the colours of the first mesh as a screen shows them, from 0 to 1."""
    attributes = text["meshes"][0]["primitives"][0]["attributes"]
    # They are linear, of 16 bits.
    linear = arrays[attributes["COLOR_0"]][:, :3] / 65535
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def test_colours_are_ambient_and_diffuse_light(tmp_path):
    ball = pv.Sphere().translate((5e6, 0, 0))
    ball.points = np.asarray(ball.points, dtype=np.float64)
    scene = Scene(lights=FAR, material=shiny(color="tan", specular=0.9))
    path = vizlight.save_gltf(ball, tmp_path / "lit.glb", scene=scene)
    text, arrays = content(path)
    assert "ambient and diffuse light only" in text["asset"]["extras"]["light"]
    (primitive,) = text["meshes"][0]["primitives"]
    bare = Scene(lights=FAR, material=shiny(color="tan", specular=0))
    expected = vizlight.illuminate(ball, bare)["rgb"]
    np.testing.assert_allclose(shown(text, arrays), np.clip(expected, 0, 1), atol=0.6 / 255)
    moved = arrays[primitive["attributes"]["POSITION"]] + np.asarray(
        text["nodes"][1]["translation"]
    )
    np.testing.assert_allclose(moved, ball.points, atol=1e-6)
    assert np.ptp(arrays[primitive["indices"]]) == ball.n_points - 1


@pytest.mark.filterwarnings("ignore:lit.glb. ambient and diffuse light only")
def test_colours_of_data_are_those_of_tint(tmp_path):
    mesh = swatches()
    material = Material(ambient=0.4, diffuse=1.2, specular=0)
    lamp = Light(direction=(0.3, 0.2, 1))
    scene = Scene(lights=lamp, material=material, view=View(direction=(0, 0, 1)))
    path = vizlight.save_gltf(
        mesh, tmp_path / "lit.glb", scene=scene, scalars="value", cmap="turbo"
    )
    lit = vizlight.tint(vizlight.illuminate(mesh, scene), "value", cmap="turbo")
    assert len(np.unique(lit["rgb"], axis=0)) > 40
    np.testing.assert_allclose(255 * shown(*content(path)), lit["rgb"], atol=1.01)


@pytest.mark.parametrize("as_grid", [False, True])
def test_a_cell_has_one_colour_and_light_stays_smooth(as_grid, tmp_path):
    ball = pv.Sphere(theta_resolution=9, phi_resolution=9)
    ball.clear_data()
    ball["kind"] = np.arange(ball.n_cells) % 5
    mesh = ball.cast_to_unstructured_grid() if as_grid else ball
    scene = Scene(lights=FAR, material=Material(ambient=0.4, diffuse=0.5, specular=0))
    path = vizlight.save_gltf(mesh, tmp_path / "lit.glb", scene=scene, scalars="kind", cmap="tab10")
    text, arrays = content(path)
    primitive = text["meshes"][0]["primitives"][0]
    corners = arrays[primitive["indices"]].reshape(-1, 3)
    colors = shown(text, arrays)
    bright = colors.max(axis=1)
    hue = colors / np.maximum(bright, 1e-9)[:, np.newaxis]
    assert np.ptp(hue[corners], axis=1).max() < 0.03
    assert len(np.unique(np.round(hue[corners[:, 0]], 1), axis=0)) == 5
    # The light of a point is the same in all of its colours, and that of the sphere.
    light = vizlight.illuminate(ball, scene)["luminance"]
    places = arrays[primitive["attributes"]["POSITION"]] + text["nodes"][1]["translation"]
    expected = light[[ball.find_closest_point(place) for place in places]]
    for kind in range(5):
        at = corners[ball["kind"] == kind]
        most = np.max(bright[at] / expected[at])
        np.testing.assert_allclose(bright[at], most * expected[at], atol=0.02)


def test_a_lit_mesh_is_written_by_its_record_and_colours_of_data_count(tmp_path):
    lines = vizlight.load_example("fibre_bundle.vtp")
    lines["x"] = np.asarray(lines.points[:, 0], dtype=np.float64)
    scene = Scene(lights=FAR, material=SHINY)
    seen = scene.replace(view=View(direction=(1, 0, 0)))
    lit = vizlight.tint(vizlight.illuminate(lines, seen), "x")
    by_record = content(vizlight.save_gltf(lit, tmp_path / "a.glb"))
    by_hand = content(vizlight.save_gltf(lines, tmp_path / "b.glb", scene=scene, scalars="x"))
    for ours, others in zip(by_record[1], by_hand[1], strict=True):
        np.testing.assert_array_equal(ours, others)
    assert by_record[0]["meshes"][0]["primitives"][0]["mode"] == 1
    assert len(np.unique(by_record[1][1], axis=0)) > 1000


@pytest.mark.filterwarnings("ignore:.*depend on the eye")
def test_blocks_in_scenes_of_their_own_are_written_as_each_is_lit(tmp_path):
    scenes = [Scene(lights=Light(direction=way)) for way in ((0, 0, 1), (1, 0, 0))]
    lit = [vizlight.illuminate(pv.Sphere(), scene) for scene in scenes]
    text, arrays = content(vizlight.save_gltf(pv.MultiBlock(lit), tmp_path / "both.glb"))
    for i, mesh in enumerate(lit):
        alone = shown(*content(vizlight.save_gltf(mesh, tmp_path / "one.glb")))
        np.testing.assert_array_equal(shown({"meshes": text["meshes"][i:]}, arrays), alone)


def test_what_depends_on_the_eye_is_fixed_and_said_to_be(tmp_path):
    with pytest.warns(UserWarning, match=r"lit.glb: .*; the headlight and the light that follows"):
        path = vizlight.save_gltf(pv.Sphere(), tmp_path / "lit.glb", scene=Scene())
    assert "the headlight" in content(path)[0]["asset"]["extras"]["light"]


@pytest.mark.parametrize("height", [0.2, -0.2])
def test_a_terrain_is_lit_on_one_side_as_a_whole(height, tmp_path):
    x = np.linspace(-3, 3, 40)
    z = np.sin(2 * x)[:, np.newaxis] * np.cos(2 * x)
    hills = pv.StructuredGrid(*np.meshgrid(x, x), z).extract_surface(algorithm="dataset_surface")
    light = Light(direction=(0, 0, np.sign(height)))
    scene = Scene(lights=light, view=View(direction=(1, 0.3, height)), material=SHINY)
    with pytest.warns(UserWarning, match="the lit side of open surfaces"):
        path = vizlight.save_gltf(hills, tmp_path / "lit.glb", scene=scene)
    normals = surface_normals(hills)
    expected = 0.1 + 0.5 * np.abs(normals[:, 2])
    np.testing.assert_allclose(shown(*content(path))[:, 0], expected, atol=1 / 255)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"path": "lit.gltf"}, "path: expected a name that ends in .glb"),
        ({"scene": None}, "scene: expected a scene or the record of one"),
        ({"tangents": "nothing"}, "tangents: expected .*'nothing'"),
        ({"scalars": "nothing"}, "scalars: expected .*'nothing'"),
        ({"line_width": 3}, "options: expected an option of vizlight.illuminate, got 'line_width'"),
        ({"mesh": pv.PolyData()}, "mesh: expected a mesh with points"),
    ],
)
def test_what_does_not_fit_is_refused_and_nothing_is_written(options, message, tmp_path):
    given = {"mesh": pv.Sphere(), "scene": Scene(lights=FAR), "path": "lit.glb"} | options
    mesh, scene, name = (given.pop(key) for key in ("mesh", "scene", "path"))
    with pytest.raises((FileError, TypeError, ValueError), match=message):
        vizlight.save_gltf(mesh, tmp_path / name, scene=scene, **given)
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(
    shutil.which("node") is None or not (MODULES / "gltf-validator").is_dir(),
    reason="needs Node.js and npm ci in vizlight/draw/web",
)
def test_the_validator_of_gltf_has_no_objection(tmp_path):
    both = pv.MultiBlock({"ball": pv.Sphere(), "lines": vizlight.load_example("fibre_bundle.vtp")})
    both["grid"] = pv.ImageData(dimensions=(4, 4, 4))
    path = vizlight.save_gltf(both, tmp_path / "lit.glb", scene=Scene(lights=FAR, material=SHINY))
    script = """
    const { validateBytes } = require(process.argv[1] + '/gltf-validator');
    validateBytes(new Uint8Array(require('fs').readFileSync(process.argv[2])))
      .then((report) => console.log(JSON.stringify(report.issues)));
    """
    run = subprocess.run(
        ["node", "-e", script, os.fspath(MODULES), os.fspath(path)],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    issues = json.loads(run.stdout)
    assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues


@pytest.mark.parametrize("scalars", [None, "height"])
def test_what_is_not_data_is_grey(tmp_path, scalars):
    mesh = half_known()
    scene = Scene(lights=FAR, material=SHINY)
    vizlight.save_gltf(mesh, tmp_path / "a.glb", scene=scene, tangents="V", scalars=scalars)
    seen = np.rint(255 * shown(*content(tmp_path / "a.glb")))
    lost = ~np.any(mesh["V"], axis=1)
    np.testing.assert_array_equal(seen[lost], 128)
    assert not np.any(np.all(seen[~lost] == 128, axis=1))
    if scalars:
        # Light dims that grey where there is light.
        missing = seen[~lost & np.isnan(mesh["height"])]
        assert np.ptp(missing, axis=1).max() == 0
        assert np.ptp(seen[~lost & np.isfinite(mesh["height"])], axis=1).min() > 10
