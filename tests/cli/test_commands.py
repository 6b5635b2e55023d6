"""The commands beside ``light``: what they write, and the script that does the same."""

import json
import shutil
import warnings
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from PIL import Image
from vectors import unit

import vizlight
from vizlight.draw import component

SMALL = ("--size", "90x60")


def same_arrays(one, other):
    assert set(one.point_data) == set(other.point_data)
    assert set(one.cell_data) == set(other.cell_data)
    np.testing.assert_array_equal(one.points, other.points)
    for name in one.point_data:
        np.testing.assert_array_equal(one.point_data[name], other.point_data[name])
    for name in one.cell_data:
        np.testing.assert_array_equal(one.cell_data[name], other.cell_data[name])


SCENE = {
    "lights": [{"direction": [0.0, -1.0, 1.0]}, {"position": [20.0, 20.0, 20.0]}],
    "material": {"ambient": 0.2, "diffuse": 0.7, "color": [1.0, 0.5, 0.2]},
}
VIEW = {"position": [30.0, -30.0, 30.0], "direction": [1.0, -1.0, 1.0]}

COMMANDS = {
    "light": "light flow.vti --contour r --level 4 --tangents V --conditioned",
    "light, all at once": "light flow.vti --contour r --clip x:6 --threshold r:0:8 --light 315,30 "
    "--light-position 9,9,-9 --headlight --color tomato --depth-cue --parallel --zoom 2 "
    "--precision float64 --components --background black --line-width 2 --up 0,1,0 --view 1,0,1",
    "section": "light flow.vti --slice 0,1,1:8 --tangents V",
    "points of a volume": "light flow.vti --no-surface --tangents V",
    "raised": "light terrain.vti --warp height --exaggeration 2 --facing as-given",
    "scene of a file": "light terrain.vti --warp height --scene scene.json --specular 0.1",
    "view of a scene": "light terrain.vti --warp height --scene view.json",
    "saved camera": "light terrain.vti --warp height --view camera.json --zoom 2 --parallel",
    "streamlines": "streamlines flow.vti --tangents V --seeds 9 --model cylinder --scalars r "
    "--cmap plasma",
    "colour of data": "light flow.vti --slice z:4 --scalars r --diffuse 0.9",
    "lines by direction": "light tract.vtp --scalars direction --line-width 3",
    "lines by their bundle": "light tract.vtp --scalars bundle",
    "streamlines on a surface": "streamlines flow.vti --tangents V --contour r --confined "
    "--seeds 9",
    "evenly spaced": "streamlines flow.vti --tangents V --contour r --confined --spacing 1.5",
    "a cross field": "streamlines flow.vti --tangents V,W --line-field --seeds 9",
    "lines without sign": "streamlines flow.vti --tangents V --line-field --seeds 9",
    "relief": "relief terrain.vti --light 315,20 --depth 0.5 --border wall",
    "relief, lit": "relief terrain.vti --color white --exaggeration 2 --elevation height",
    "relief of a surface": "relief flow.vti --contour r --level 3 --depth 0.5",
    "fur": "fur flow.vti --contour r --level 4 --density 0.3 --length 0.4 --fibres 200 "
    "--toward 0,0,-1 --bend 0.5",
    "fur, named length": "fur flow.vti --contour r --level 4 --density 0.3 --length r --fibres 9",
    "contours": "contours flow.vti --contour r --level 4 --levels 5 --specular 0",
    "contours at values": "contours flow.vti --contour r --levels 0.2,0.4 --name light",
    "project": "project torus.vtp --rotation xw:0.5 --rotation yz:1/3 --distance 3 "
    "--light 0.7,0.6,0.38,0",
    "project, lit after": "project torus.vtp --when after --view 0,-1,0.5 --color red",
    "for shape": "light flow.vti --contour r --tangents V --for shape",
    "for slope": "streamlines flow.vti --tangents V --seeds 9 --for slope --diffuse 0.5 --no-key",
    "colours of cells": "light tract.vtp --scalars bundle --cmap viridis",
    "relief for a question": "relief terrain.vti --for shape --elevation height",
    "for values": "light flow.vti --slice z:4 --scalars r --for value",
    "cut": "project torus.vtp --hyperplane 0,0,1,0.2:0.1",
}


@pytest.mark.parametrize("question", ["direction", "slope", "heading"])
def test_the_only_vectors_are_traced_for_a_question(question, folder, done):
    flow = pv.read("flow.vti")
    del flow.point_data["W"]
    flow.save("one.vti")
    line = f"streamlines one.vti --seeds 9 --for {question} -o lines.vtp"
    done(*line.split())
    assert np.ptp(pv.read("lines.vtp")["luminance"]) > 0.1


@pytest.mark.slow
@pytest.mark.parametrize("command", ["streamlines flow.vti --tangents V --seeds 9", "fur flow.vti"])
@pytest.mark.parametrize("question", ["direction", "shape"])
def test_the_light_of_a_question_is_that_of_any_command(command, question, folder, done):
    """It was left out where nothing else of the light was asked for."""
    assert f"vizlight.presets.{question}(" in done(*command.split(), "--for", question, "--script")
    assert "presets" not in done(*command.split(), "--script")


@pytest.mark.sampled(8)
@pytest.mark.opengl
@pytest.mark.parametrize("line", COMMANDS.values(), ids=COMMANDS)
def test_the_printed_script_does_the_same(line, folder, tmp_path, monkeypatch, run, done):
    # Code that is compiled between the two runs would round the second otherwise.
    monkeypatch.setenv("VIZLIGHT_FAST", "0")
    Path("scene.json").write_text(json.dumps(SCENE))
    Path("view.json").write_text(json.dumps(SCENE | {"view": VIEW}))
    Path("camera.json").write_text(json.dumps([[30, -10, 20], [5, 5, 5], [0, 0, 1]]))
    given = {path.name for path in folder.iterdir()}
    shutil.copytree(folder, tmp_path / "second")
    arguments = [*line.split(), *SMALL]
    script = done(*arguments, "--script")
    assert {path.name for path in folder.iterdir()} == given
    code, out, err = run(*arguments)
    assert code == 0, err
    assert "shown " in out
    made = {path.name for path in folder.iterdir()} - given
    monkeypatch.chdir(tmp_path / "second")
    with warnings.catch_warnings():
        # Where the projection flattens a tangent space there is no light but the ambient one.
        warnings.simplefilter("ignore", UserWarning)
        exec(compile(script, "script", "exec"), {})
    assert {path.name for path in Path.cwd().iterdir()} == given | made
    assert any(name.endswith(".png") for name in made)
    for name in made:
        if name.endswith(".png"):
            picture = np.asarray(pv.read(folder / name)["PNGImage"])
            assert len(np.unique(picture)) > 4
            np.testing.assert_array_equal(np.asarray(pv.read(name)["PNGImage"]), picture)
        else:
            same_arrays(pv.read(name), pv.read(folder / name))


def test_a_scene_of_a_file_lights_as_in_a_script(folder, done):
    Path("view.json").write_text(json.dumps(SCENE | {"view": VIEW}))
    asked = "light flow.vti --no-surface --tangents V --scene view.json -o lit.vti"
    done(asked)
    scene = vizlight.Scene.from_dict(SCENE | {"view": VIEW})
    lit = vizlight.illuminate(pv.read("flow.vti"), scene, tangents="V")
    assert vizlight.provenance(pv.read("lit.vti"))["scene"] == vizlight.provenance(lit)["scene"]
    done(asked, "--diffuse 0.3 --light 0,0,1")
    made = vizlight.provenance(pv.read("lit.vti"))["scene"]
    assert made["material"] == {**vizlight.provenance(lit)["scene"]["material"], "diffuse": 0.3}
    assert [light["direction"] for light in made["lights"]] == [[0.0, 0.0, 1.0]]


@pytest.mark.opengl
@pytest.mark.parametrize(("altitude", "gray"), [(10, 1 / 3), (45, 0.5**0.5)])
def test_level_ground_under_a_low_sun_is_not_black(altitude, gray, folder, done):
    """The picture is brighter, and says so; the numbers are the shadow's own."""
    flat = pv.ImageData(dimensions=(9, 9, 1))
    flat["height"] = np.zeros(flat.n_points)
    flat.save("flat.vti")
    asked = ("--no-lit", "--light", f"315,{altitude}", "-o", "a.png", "-o", "a.vti", *SMALL)
    out = done("relief", "flat.vti", *asked)
    assert ("white in the picture is t = 0.52" in out) == (altitude == 10)
    np.testing.assert_allclose(pv.read("a.vti")["t"], np.sin(np.radians(altitude)), atol=1e-6)
    picture = np.array(Image.open("a.png").convert("L"))
    assert abs(int(picture[30, 45]) - 255 * gray) <= 1


def test_a_map_in_degrees_is_lit_as_it_is_shown(folder, done):
    """The light is that of the heights in the picture, which the map as it is has not."""
    grid = pv.ImageData(dimensions=(30, 20, 1), spacing=(1 / 60, 1 / 60, 1), origin=(11, 60, 0))
    x, y, _ = grid.points.T
    grid["height"] = 200 * np.sin(15 * x) * np.cos(20 * y)
    grid.field_data["unit"] = ["degree"]
    grid.save("map.vti")
    assert "heights are taken 5 times" in done("relief", "map.vti", "-o", "lit.vti")
    made = pv.read("lit.vti")
    shown = vizlight.files.warped(grid, "height", 5.0)
    known = vizlight.provenance(made, "t")
    scene = vizlight.Scene.from_dict(known["scene"])
    raised = vizlight.relief_shadow(shown, scene, lit=True, depth=known["depth"], occlusion="sky")
    np.testing.assert_allclose(made["luminance"], raised["luminance"], atol=2e-3)
    assert np.ptp(made["luminance"]) > 0.15
    done("relief", "map.vti", "-o", "true.vti", "--exaggeration", "1")
    assert not np.allclose(pv.read("true.vti")["t"], made["t"], atol=0.01)


def test_report_stands_in_the_script_too(folder, capfd, run, done):
    arguments = ("relief", "terrain.vti", "--report", "-o", "lit.vti", "--progress")
    exec(done(*arguments, "--script"), {})
    printed, _ = capfd.readouterr()
    for text in (printed, run(*arguments)[1]):
        assert "points" in text
        assert "not measured between points: cast shadows" in text
    out = done("sky terrain.vti --report -o skylit.vti")
    assert "or less at 95 of 100 points, as estimated, horizons" in out


def test_components_of_vectors_are_joined(folder, run, done):
    mesh = pv.read("flow.vti")
    x, y, z = mesh["V"].T
    mesh["u"], mesh["v"] = x, y
    mesh.save("parts.vti")
    mesh["V"] = np.column_stack([x, y, 0 * z])
    mesh.save("whole.vti")
    for file, name in (("parts", "u,v"), ("whole", "V")):
        done(f"light {file}.vti --no-surface --tangents {name} -o {file}-lit.vti")
    parts, whole = pv.read("parts-lit.vti"), pv.read("whole-lit.vti")
    np.testing.assert_array_equal(parts["luminance"], whole["luminance"])
    joined = vizlight.files.with_vectors(pv.read("parts.vti"), "v,u")
    np.testing.assert_array_equal(joined["v,u"][:, [1, 0, 2]], pv.read("whole.vti")["V"])
    done("streamlines parts.vti --tangents u,v --seeds 9 -o lines.vtp")
    assert np.ptp(pv.read("lines.vtp").points[:, 2]) > 0.1
    for file, name in (("parts", "u,v"), ("whole", "V")):
        # Most of them point into the isosurface, and a warning says so.
        assert run(f"fur {file}.vti --contour r --tangents {name} --fibres 9 -o {file}.vtp")[0] == 0
    parts, whole = pv.read("parts-fibres.vtp"), pv.read("whole-fibres.vtp")
    np.testing.assert_array_equal(parts.points, whole.points)


@pytest.mark.opengl
def test_colours_of_data_are_multiplied_by_the_light(folder, done):
    arguments = ("light", "flow.vti", "--slice", "z:4", "--scalars", "r", "-o", "a.png", *SMALL)
    done(*arguments, "--light", "1,0,1")
    lit = np.asarray(pv.read("a.png")["PNGImage"], dtype=int)
    done(*arguments)
    picture = np.asarray(pv.read("a.png")["PNGImage"], dtype=int)
    # Without a lamp the section, which is flat, has the colours of the map.
    assert lit.sum() < picture.sum()
    assert np.ptp(picture, axis=1).max() > 50


def test_parts_are_blocks_of_one_file_and_one_page(folder, done, refused):
    """Other outputs have a file for each part."""
    given = ("fur", "flow.vti", "--contour", "r", "--level", "4", "--fibres", "50")
    out = done(*given, "-o", "a.vtm", "-o", "a.html", "-o", "b.vtp")
    assert (out.count("mesh  "), out.count("page  ")) == (3, 1)
    blocks = pv.read("a.vtm")
    assert blocks.keys() == ["fibres", "skin"]
    for name in blocks.keys():  # noqa: SIM118 - a MultiBlock is a list of its blocks
        same_arrays(blocks[name], pv.read(f"b-{name}.vtp"))
    page = Path("a.html").read_text(encoding="utf-8")
    assert "fibres" in page
    assert "skin" in page
    exec(done(*given, "-o", "c.vtm", "-o", "c.html", "--script"), {})
    same_arrays(pv.read("c.vtm")["skin"], blocks["skin"])
    # Pages name the pictures that a reader saves after themselves.
    again = Path("c.html").read_text(encoding="utf-8")
    assert again.replace('": "c"', '": "a"') == page
    err = refused("light flow.vti --array r -o d.vtm")
    assert "a name that ends in .vtp, .vtk, .vtu, .stl for PolyData" in err


def test_steps_without_a_flow_name_those_that_have_one(folder, done, refused):
    import foam

    def fields(time, middles):
        return {"U": time * np.tile([1.0, 0.5, 0.2], (len(middles), 1))}

    foam.write(folder / "case", [0, 0.5, 2], fields)
    arguments = ("streamlines", "case/case.foam", "--tangents", "U", "--seeds", "5")
    assert "note     time 2, the last of 3 steps; --time takes" in done(*arguments, "-o", "a.vtp")
    err = refused(*arguments, "--time", "0", "-o", "a.vtp")
    assert "'U' is not zero everywhere, got 0; pass --time with one of 0.5, 2" in err
    # So it is where the only vectors are taken.
    assert refused("streamlines case/case.foam --time 0 -o a.vtp") == err
    (folder / "out").mkdir()
    assert "of 3 steps" not in done(*arguments, "--times", "1:", "-o", "out", *SMALL)
    made = {path.name for path in Path("out").glob("*.vtp")}
    assert made == {f"case-streamlines-000{i}.vtp" for i in range(2)}
    (folder / "all").mkdir()
    done("light", *arguments[1:2], "--for shape --times all -o all", *SMALL)
    assert len([*Path("all").glob("*.png")]) == 3
    script = done("light", *arguments[1:2], "--for shape --times -2: -o some.gif --script", *SMALL)
    assert "times=[0.5, 2.0]" in script.replace("\n", "")
    for asked in ("3:", "x", "all --time 1"):
        err = refused(*arguments, "--times", asked, "-o", "out")
        assert "--times: expected all, or indices of steps" in err


def test_the_picture_of_a_share_is_not_white_on_white(done):
    pv.Sphere().save("ball.stl")
    done("sky ball.stl -o sky.png")
    corner = pv.read("sky.png")["PNGImage"][0]
    assert np.abs(corner.astype(int) - 128).max() < 3


def lit(done, words, path="lit.vtp", name="luminance"):
    """Return the mesh that a command writes, and the record of its light."""
    done(words, "-o", path)
    made = pv.read(path)
    return made, vizlight.provenance(made, name)


@pytest.mark.opengl
def test_the_key_of_colours_names_what_they_are(folder, monkeypatch, done):
    terrain = pv.read("terrain.vti")
    terrain["paint"] = np.zeros((terrain.n_points, 3), np.uint8)
    terrain["warmth"] = 30.0 + 3.0 * terrain["height"]
    terrain.save("terrain.vti")
    made, key = [], component.key
    monkeypatch.setattr(component, "key", lambda *a, **k: made.append(key(*a, **k)) or made[-1])
    for name in ("warmth", "paint"):
        done(f"light terrain.vti --scalars {name} -o a.png", *SMALL)
    (mesh,) = made
    assert mesh.field_data["title"][0] == "warmth"
    ends = np.nanmin(terrain["warmth"]), np.nanmax(terrain["warmth"])
    np.testing.assert_allclose(mesh.field_data["range"], ends)


@pytest.mark.parametrize(
    ("text", "direction"),
    [
        ("90,0", (1, 0, 0)),
        ("0,0", (0, 1, 0)),
        ("315,30", (-(0.375**0.5), 0.375**0.5, 0.5)),
        ("12,90", (0, 0, 1)),
        ("-1,2,3", (-1, 2, 3)),
        ("-y", (0, -1, 0)),
    ],
)
def test_azimuth_and_altitude(text, direction, folder, done):
    _, record = lit(done, f"light flow.vti --no-surface --tangents V --light {text}", "lit.vti")
    np.testing.assert_allclose(record["scene"]["lights"][0]["direction"], direction, atol=1e-15)


@pytest.mark.parametrize(
    ("option", "low", "high"),
    [("clip=z:5", 0, 5), ("clip=-z:-5", 5, 11), ("clip=0,0,-2:-5", 5, 11), ("slice=0,0,3:4", 4, 4)],
)
def test_planes_keep_what_they_say(option, low, high, folder, done):
    bounds = lit(done, f"light flow.vti --no-surface --tangents V --{option}", "lit.vtk")[0].bounds
    assert (bounds.z_min, bounds.z_max) == pytest.approx((low, high), abs=1e-5)


def test_ranges_keep_what_they_say(folder, done):
    asked = "light flow.vti --no-surface --tangents V --threshold"
    both, above, below = (
        lit(done, f"{asked} {text}", "lit.vtu")[0].n_cells for text in ("r:2:4", "r:2:", "r::4")
    )
    assert both < min(above, below)
    assert max(above, below) < 11**3


def test_several_files_are_lit_each_by_itself(folder, run, done):
    """An error in one leaves the others, and no input is overwritten."""
    shutil.copy("flow.vti", "again.vti")
    (folder / "made").mkdir()
    done("light flow.vti again.vti --contour r --for shape -o made", *SMALL)
    assert {p.name for p in Path("made").iterdir()} == {
        f"{name}-lit.{suffix}" for name in ("flow", "again") for suffix in ("vtp", "png")
    }
    same_arrays(pv.read("made/flow-lit.vtp"), pv.read("made/again-lit.vtp"))
    shutil.copy("torus.vtp", "again-lit.vtp")
    before = Path("again-lit.vtp").read_bytes()
    files = "none.vti torus.vtp again.vti flow.vti again-lit.vtp"
    code, _, err = run("light", files, "--contour r --for shape", *SMALL)
    assert (code, err.count("\n")) == (2, 4)
    assert err.startswith("vizlight: none.vti: file: expected a file")
    assert "vizlight: torus.vtp: contour: expected" in err
    assert "again.vti: output: expected another file than the input, got 'again-lit.vtp'" in err
    assert Path("flow-lit.vtp").exists()
    assert not list(folder.glob("torus-lit*"))
    assert Path("again-lit.vtp").read_bytes() == before


TURNED = "project torus.vtp --rotation xw:0.5 --rotation yz:-1/4 --distance 4 --components"


@pytest.mark.parametrize(
    ("line", "path", "name", "expected"),
    [
        (
            COMMANDS["streamlines on a surface"], "lit.vtp", "luminance",
            {"tangents": "V", "confined": True, "seeds": 9, "seed": 0},
        ),
        (
            "relief terrain.vti --depth 0.5 --border wall --angular-diameter 0.01 --name shade",
            "lit.vti", "shade",
            {"depth": 0.5, "border": "wall", "angular_diameter": 0.01},
        ),
        (
            "fur flow.vti --contour r --length r --toward -1,0,2 --bend 0.5 --fibres 8",
            "lit.vtm", "luminance",
            {"length": "r", "toward": [-1, 0, 2], "bend": 0.5, "conditioned": True},
        ),
        (
            "contours flow.vti --contour r --levels 1/50 --model blinn", "lit.vtm", "luminance",
            {"levels": 0.02, "model": "blinn"},
        ),
        (
            TURNED, "lit.vtk", "luminance",
            {"rotation": [["xw", 0.5], ["yz", -0.25]], "distance": 4.0, "components": True},
        ),
    ],
)  # fmt: skip
def test_options_reach_the_filter(line, path, name, expected, folder, done):
    options = lit(done, line, path, name)[1]["options"]
    assert {key: options[key] for key in expected} == expected


def test_a_saved_camera_is_the_view(folder, done):
    Path("camera.json").write_text(json.dumps([[30, -10, 20], [5, 5, 5], [0, 0, 1]]))
    for parallel in ("", "--parallel"):
        asked = "light flow.vti --no-surface --tangents V --view camera.json"
        _, record = lit(done, f"{asked} {parallel}", "lit.vti")
        view = record["scene"]["view"]
        assert view["position"] == [30, -10, 20]
        np.testing.assert_allclose(view["direction"], unit([25, -15, 15]), atol=1e-12)
        assert view["parallel"] is bool(parallel)


def test_lights_and_eye_of_n_space_are_filled_up_with_zeros(folder, done):
    asked = "project torus.vtp --view 0,-1,2"
    scene = lit(done, f"{asked} --light 90,0 --light-position 1,2,3,4", "lit.vtk")[1]["scene"]
    assert scene["view"]["direction"] == [0, -1, 2, 0]
    assert scene["lights"][0]["direction"] == [1, 0, 0, 0]
    assert scene["lights"][1]["position"] == [1, 2, 3, 4]
    lights = lit(done, asked, "lit.vtk")[1]["scene"]["lights"]
    assert lights == json.loads(json.dumps(vizlight.Scene().to_dict()["lights"]))
