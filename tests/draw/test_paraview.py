"""ParaView without a plugin shows the light of a plotter in each fragment, from every side."""

import json
import re

import numpy as np
import pytest
import pyvista as pv
import real_paraview
import shapes
from PIL import Image
from refusals import refusals

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, paraview

SIZE = 240
FAR = Light(direction=(1, 0.9, 0.5), intensity=0.8)
CUE = DepthCue(front=3, back=7, back_scale=0.3, cue=0.1, color=(0.3, 0.4, 1.0))
AWAY = (5e4, -5e4, 2e4)
#: Runs scripts in one process and draws each from every camera.
DRAW = """
import json, sys
size, todo = json.load(open(sys.argv[1]))
for name, script, cameras in todo:
    space = {"__name__": "__main__"}
    try:
        exec(script, space)
    except RuntimeError as error:
        print(f"{name}: {error}")
        continue
    view, save = space["view"], space["SaveScreenshot"]
    view.ViewSize, view.UseColorPaletteForBackground, view.Background = [size, size], 0, [0, 0, 0]
    view.OrientationAxesVisibility = view.UseFXAA = view.MultiSamples = 0
    for i, (position, focal, parallel) in enumerate(cameras):
        view.CameraPosition, view.CameraFocalPoint = position, focal
        view.CameraViewUp, view.CameraViewAngle = [0, 0, 1], 30
        view.CameraParallelProjection, view.CameraParallelScale = parallel, 1.6
        save(f"{name} {i}.png", view, ImageResolution=[size, size])
    space["Hide"](space["source"], view)
"""


def torus(centre=(0.0, 0.0, 0.0)):
    """Return a surface with normals in float32 and a field of tangents in float64."""
    mesh = shapes.torus(121, centre)
    mesh["Normals"] = np.asarray(mesh["n"], dtype=np.float32)
    mesh.rename_array("n", "wide")
    del mesh.point_data["height"]
    return mesh


def near(centre=(0, 0, 0)):
    at = np.add(centre, (3, 4, 5))
    return Light(position=at, intensity=0.5, attenuation=(0.5, 0.1, 0.01), color=(1, 0.8, 0.5))


COPPER = Material(color=(1, 0.7, 0.4))
CASES = {
    "surface": (torus, Scene(lights=FAR), {"normals": "Normals"}),
    "lines": (shapes.winding, Scene(lights=FAR), {"tangents": "T"}),
    "conditioned field": (
        torus, Scene(lights=FAR, material=COPPER),
        {"tangents": "around", "conditioned": True, "normals": "Normals"},
    ),
    "three lights in fog": (
        torus,
        Scene(
            lights=[FAR, near(), Light.headlight(intensity=0.2)], depth_cue=CUE,
            ambient_color=(0.7, 0.8, 1),
        ),
        {"normals": "Normals", "model": "blinn"},
    ),
    "far from the origin": (
        lambda: torus(AWAY), Scene(lights=[FAR, near(AWAY)]), {"normals": "Normals"}
    ),
    "saved and open": (lambda: torus().clip("x"), Scene(lights=[FAR, near()]), {}),
    "saved field": (
        torus, Scene(lights=[FAR, near()]), {"tangents": "around", "conditioned": True}
    ),
}  # fmt: skip


def cameras(mesh):
    """Return two cameras, turned by 60 degrees, and a parallel one."""
    found = []
    for azimuth, parallel in ((30, 0), (90, 0), (30, 1)):
        a = np.radians(azimuth)
        toward = np.array([4.6 * np.cos(a), 4.6 * np.sin(a), 2.5])
        found.append([list(mesh.center + toward), list(mesh.center), parallel])
    return found


def drawn(mesh, scene, options, camera):
    """Return the picture of a plotter."""
    plotter = pv.Plotter(off_screen=True, window_size=[SIZE, SIZE])
    plotter.background_color = "black"
    plotter.disable_anti_aliasing()
    # ParaView draws no halos.
    plotter.vizlight.add_mesh(mesh, scene=scene, light="fragments", halo=False, **options)
    plotter.camera.position, plotter.camera.focal_point, parallel = camera
    plotter.camera.up, plotter.camera.view_angle = (0, 0, 1), 30
    plotter.camera.parallel_projection, plotter.camera.parallel_scale = bool(parallel), 1.6
    plotter.renderer.ResetCameraClippingRange()
    return np.asarray(plotter.screenshot(return_img=True), dtype=float)


@pytest.mark.slow
@pytest.mark.opengl
@real_paraview.needed
def test_pixels_are_those_of_a_plotter(tmp_path):
    """The one text, drawn by ParaView: 99 % of the pixels within 2 of 255, and most within 1."""
    todo, meshes = [], {}
    for name, (make, scene, options) in CASES.items():
        meshes[name] = mesh = make()
        if name.startswith("saved"):
            script = paraview.save(mesh, scene, tmp_path / f"{name}.py", **options).read_text()
        else:
            mesh.save(tmp_path / f"{name}.vtp")
            script = paraview.shader(scene, **options).script(tmp_path / f"{name}.vtp")
        todo.append([name, script, cameras(mesh)])
    field = tmp_path / "conditioned field.vtp"
    for normals in ("wide", "none"):
        options = {"tangents": "around", "conditioned": True, "normals": normals}
        todo.append([normals, paraview.shader(Scene(lights=FAR), **options).script(field), []])
    (tmp_path / "todo.json").write_text(json.dumps([SIZE, todo]))
    said = real_paraview.run(tmp_path, DRAW, "todo.json")
    assert "wide: wide: ParaView passes an array of float32 alone" in said
    assert "none: the source has no point array 'none'" in said
    for name, (_, scene, options) in CASES.items():
        pictures = []
        for i, camera in enumerate(cameras(meshes[name])):
            ours = drawn(meshes[name], scene, options, camera)
            theirs = np.asarray(Image.open(tmp_path / f"{name} {i}.png").convert("RGB"), float)
            seen = np.any(ours > 0, axis=2) | np.any(theirs > 0, axis=2)
            error = np.abs(ours - theirs).max(axis=2)[seen]
            assert np.count_nonzero(seen) > 4000, (name, i)
            assert np.mean(error <= 2) >= 0.99, (name, i, np.percentile(error, [50, 99, 100]))
            assert np.mean(error) < 0.3, (name, i, np.mean(error))
            assert np.std(ours[seen]) > 10, (name, i)
            pictures.append(ours)
        # The light turns with neither the eye nor the shape alone.
        assert np.mean(np.abs(pictures[0] - pictures[1])) > 1, name


TEXTS = {
    "surface": {},
    "lines": {"tangents": "V"},
    "conditioned": {"tangents": "V", "conditioned": True, "facing": "eye"},
}


@pytest.mark.parametrize("case", TEXTS)
def test_text_holds_all_that_it_reads(case):
    """No uniform is given from outside: numbers stand in the text, or turn in the vertex shader."""
    lights = [FAR, near(), Light.headlight(), Light(direction=(0, 0, 1), intensity=0)]
    made = paraview.shader(Scene(lights=lights, depth_cue=CUE), **TEXTS[case])
    texts = {}
    for entry in json.loads(made.shader_replacements):
        assert set(entry) == {"type", "original", "replacement"}
        assert entry["original"].startswith("//VTK::")
        texts[entry["type"]] = texts.get(entry["type"], "") + entry["replacement"]
    assert set(texts) == {"vertex", "geometry", "fragment"}
    assert not re.search(r"uniform \w+ viz", "".join(texts.values()))
    for name in set(re.findall(r"\bviz\w+VSOutput\b", texts["fragment"])):
        assert re.search(rf"\bin \w+ {name};", texts["fragment"])
        assert re.search(rf"\bout \w+ {name};", texts["vertex"])
        assert f"{name} = " in texts["vertex"]
    for name in set(re.findall(r"\b(?:normal|tangent)MC\b", texts["vertex"])):
        assert f"in vec3 {name};" in texts["vertex"]
    # A headlight stands with the camera, and a light of no intensity is left out.
    assert "vec3 vizLight2 = vec3(0.0, 0.0, 1.0);" in texts["fragment"]
    assert "vizLight3" not in texts["fragment"]
    assert texts["vertex"].count("MCWCMatrix[3].xyz") == 1
    assert texts["vertex"].count("uniform mat4 MCWCMatrix;") == 1


def test_properties_and_script():
    scene = Scene(lights=FAR, material=Material(ambient=0.2, diffuse=2.0, color=(1, 0.5, 0)))
    made = paraview.shader(scene, tangents="V", conditioned=True)
    assert made.properties == {
        "AmbientColor": [1, 0.5, 0], "DiffuseColor": [1, 0.5, 0], "Ambient": 0.2, "Diffuse": 1.0,
        "Interpolation": "Gouraud", "SelectNormalArray": "V", "SelectTangentArray": "Normals",
        "UseShaderReplacements": 1,
    }  # fmt: skip
    # Diffuse is 1 at most in ParaView: the text has the rest.
    assert "float vizDiffuseGain = 2.0;" in made.shader_replacements
    own = made.script()
    assert "GetActiveSource()" in own
    assert "ResetCamera" not in own
    assert "ColorBy(display, None)" in own
    colored = paraview.shader(scene, tangents="V", conditioned=True, scalars="Temp")
    other = colored.script("it's.vtp")
    assert "ColorBy(display, (\"POINTS\", 'Temp'))" in other
    assert "bar.DrawNanAnnotation, bar.NanAnnotation = 1, 'no data'" in other
    assert "vizGood ? " in colored.shader_replacements
    # The colour of the data is what ParaView multiplied by Ambient and Diffuse.
    assert "float vizColorGain = 0.833333333;" in colored.shader_replacements
    for text in (own, other):
        compile(text, "script", "exec")
    plain = paraview.shader(scene).properties
    assert (plain["SelectNormalArray"], plain["SelectTangentArray"]) == ("Normals", "None")
    lines = paraview.shader(scene, tangents="V").properties
    assert (lines["SelectNormalArray"], lines["SelectTangentArray"]) == ("V", "None")


@pytest.mark.parametrize(
    ("options", "facing"),
    [({}, "vizFace"), ({"facing": "eye"}, "vizN = -vizN"), ({"facing": "as given"}, "")],
)
def test_side_that_is_lit(options, facing):
    text = paraview.shader(Scene(lights=FAR), **options).shader_replacements
    assert facing in text
    assert ("-vizN" in text) == bool(facing)
    assert ("vizFace" in text) == (facing == "vizFace")


test_what_a_fragment_cannot_do_is_an_error = refusals(
    lambda scene, options: paraview.shader(scene, **options),
    (Scene(lights=FAR), {"tangents": "V", "model": "cylinder"}, "integral"),
    (Scene(lights=FAR), {"tangents": "V", "conditioned": "f"}, "conditioned"),
    (Scene(lights=FAR), {"tangents": [[1, 0, 0]]}, "tangents: .*name of a point", TypeError),
    (Scene(lights=FAR), {"normals": 3}, "normals: .*name of a point", TypeError),
    (Scene(lights=FAR, depth_cue=DepthCue()), {}, "depth_cue: .*front="),
    (Scene(lights=Light(direction=(1, 0, 0, 0))), {}, "3"),
    (Scene(lights=[FAR] * 17), {}, "16 lights"),
    (Scene(lights=FAR), {"bundle": True}, "bundle", TypeError),
    (None, {}, "scene", TypeError),
)


def test_save_writes_both_files_or_says_why(tmp_path):
    scene = Scene(lights=FAR, view=View(direction=(1, 0, 0)))
    mesh = torus()
    before = mesh.copy()
    path = paraview.save(mesh, scene, tmp_path / "a.py", tangents="around", scalars="around")
    assert mesh == before
    kept = pv.read(tmp_path / "a-paraview.vtp")
    name = re.search(r"'SelectNormalArray': '(.*)'", path.read_text())[1]
    np.testing.assert_allclose(kept[name], mesh["around"], atol=1e-7)
    assert repr(str((tmp_path / "a-paraview.vtp").resolve())) in path.read_text()
    lit = vizlight.illuminate(mesh, scene, normals="Normals")
    assert paraview.save(lit, None, tmp_path / "b.py").exists()
    blocks = pv.MultiBlock([mesh, mesh])
    lines = pv.MultipleLines(np.eye(3))
    for target, options, words in (
        (blocks, {}, "one block, got 2"),
        (mesh, {"scalars": "none"}, "scalars"),
        (lines, {"model": "cylinder", "tangents": np.eye(3)}, "integral"),
    ):
        with pytest.raises(ValueError, match=words):
            paraview.save(target, scene, tmp_path / "c.py", **options)
    with pytest.raises(ValueError, match="scene"):
        paraview.save(mesh, None, tmp_path / "c.py")
    with pytest.raises(vizlight.files.FileError, match=r"\.py"):
        paraview.save(mesh, scene, tmp_path / "c.txt")
    assert not list(tmp_path.glob("c.*"))
