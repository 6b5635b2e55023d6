"""The commands beside ``light``: what they write, and the script that does the same."""

from __future__ import annotations

import inspect
import json
import shutil
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from PIL import Image
from rich.console import Console

import vizlight
from vizlight import cli
from vizlight.cli import options
from vizlight.geometry import manifolds

SMALL = ("--size", "90x60")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Return a folder, made the current one, with a volume, a terrain and a torus in 4-space."""
    home = tmp_path / "first"
    home.mkdir()
    monkeypatch.chdir(home)
    grid = pv.ImageData(dimensions=(12, 12, 12))
    x, y, z = (grid.points - 5.5).T
    grid["r"] = np.sqrt(x * x + y * y + z * z)
    grid["V"] = np.stack([-y - 0.1, x + 0.1, 0.2 * z + 1], axis=1).astype(np.float32)
    grid["W"] = np.cross(grid["V"], (1, 0, 0)).astype(np.float32)
    grid.save("flow.vti")
    terrain = pv.ImageData(dimensions=(20, 16, 1))
    terrain["height"] = 3 * np.sin(terrain.points[:, 0] / 3) * np.cos(terrain.points[:, 1] / 4)
    terrain.save("terrain.vti")
    tract = pv.Line((0, 0, 0), (3, 4, 0), resolution=4)
    tract = tract + pv.Line((0, 0, 1), (2, 0, 3), resolution=3)
    tract.cell_data["bundle"] = np.arange(float(tract.n_cells))
    tract.save("tract.vtp")
    vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=12)).save("torus.vtp")
    return home


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
    "scene of a file": "light flow.vti --contour r --scene scene.json --specular 0.1",
    "view of a scene": "light flow.vti --contour r --scene view.json",
    "saved camera": "light flow.vti --contour r --view camera.json --zoom 2 --parallel",
    "streamlines": "streamlines flow.vti --vectors V --seeds 12 --model cylinder",
    "colour of data": "light flow.vti --slice z:4 --scalars r --diffuse 0.9",
    "streamlines by data": "streamlines flow.vti --vectors V --seeds 9 --scalars r --cmap plasma",
    "lines by direction": "light tract.vtp --scalars direction --line-width 3",
    "lines by their bundle": "light tract.vtp --scalars bundle",
    "streamlines on a surface": "streamlines flow.vti --vectors V --contour r --confined --seeds 9",
    "evenly spaced": "streamlines flow.vti --vectors V --contour r --confined --spacing 1.5",
    "a cross field": "streamlines flow.vti --vectors V,W --line-field --seeds 9",
    "lines without sign": "streamlines flow.vti --vectors V --line-field --seeds 9",
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
    "for slope": "streamlines flow.vti --vectors V --seeds 9 --for slope --diffuse 0.5 --no-key",
    "colours of cells": "light tract.vtp --scalars bundle --cmap viridis",
    "relief for a question": "relief terrain.vti --for shape --elevation height",
    "for values": "light flow.vti --slice z:4 --scalars r --for value",
    "cut": "project torus.vtp --hyperplane 0,0,1,0.2:0.1",
}


@pytest.mark.parametrize("question", ["direction", "slope", "heading"])
def test_the_only_vectors_are_traced_for_a_question(question, folder, run):
    flow = pv.read("flow.vti")
    del flow.point_data["W"]
    flow.save("one.vti")
    line = f"streamlines one.vti --seeds 9 --for {question} -o lines.vtp"
    assert run(*line.split())[::2] == (0, "")
    assert np.ptp(pv.read("lines.vtp")["luminance"]) > 0.1


@pytest.mark.opengl
@pytest.mark.parametrize("missing", [False, True])
def test_the_key_of_colours_names_what_they_are(missing, folder, run, monkeypatch):
    terrain = pv.read("terrain.vti")
    if missing:
        terrain["height"][3] = np.nan
    terrain["paint"] = np.zeros((terrain.n_points, 3), np.uint8)
    terrain.save("terrain.vti")
    made = []
    key = vizlight.presets.key
    monkeypatch.setattr(
        vizlight.presets,
        "key",
        lambda *args, **options: made.append(key(*args, **options)) or made[-1],
    )
    for name in ("height", "paint"):
        code, _, err = run(*f"light terrain.vti --scalars {name} -o a.png".split(), *SMALL)
        assert code == 0, err
    (mesh,) = made
    low, title, high = mesh.field_data["words"]
    assert title == ("height (grey: no data)" if missing else "height")
    ends = np.nanmin(terrain["height"]), np.nanmax(terrain["height"])
    assert (float(low), float(high)) == pytest.approx(ends, rel=1e-2)


@pytest.mark.opengl
@pytest.mark.parametrize("line", COMMANDS.values(), ids=COMMANDS)
def test_the_printed_script_does_the_same(line, folder, tmp_path, monkeypatch, run):
    # Code that is compiled between the two runs would round the second otherwise.
    monkeypatch.setenv("VIZLIGHT_FAST", "0")
    Path("scene.json").write_text(json.dumps(SCENE))
    Path("view.json").write_text(json.dumps(SCENE | {"view": VIEW}))
    Path("camera.json").write_text(json.dumps([[30, -10, 20], [5, 5, 5], [0, 0, 1]]))
    given = {path.name for path in folder.iterdir()}
    shutil.copytree(folder, tmp_path / "second")
    arguments = [*line.split(), *SMALL]
    code, script, err = run(*arguments, "--script")
    assert (code, err) == (0, "")
    assert {path.name for path in folder.iterdir()} == given
    code, out, err = run(*arguments)
    assert code == 0, err
    assert "points lit in" in out
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


FILTERS = {
    "light": vizlight.illuminate,
    "streamlines": vizlight.streamlines,
    "relief": vizlight.relief_shadow,
    "fur": vizlight.fur,
    "contours": vizlight.isoluminance,
    "project": vizlight.project,
}
#: Options that no text on the command line can give, or that a file has none of.
IN_SCRIPTS = {
    "light": {"positions", "occlusion"},
    "streamlines": {
        "positions",
        "tangents",
        "surface",
    },
    "relief": {"occluders", "sun"},
    "fur": set(),
    "contours": {"tolerance"},
    "project": set(),
}


def shown(name, run, monkeypatch):
    # The command line keeps its console, whatever the terminal of the first test was.
    monkeypatch.setattr(cli.app, "console", Console(width=100))
    code, out, _ = run(name, "--help")
    assert code == 0
    return out


@pytest.mark.parametrize("name", FILTERS)
def test_every_option_of_a_filter_is_one_of_its_command(name, run, monkeypatch):
    out = shown(name, run, monkeypatch)
    parameters = inspect.signature(FILTERS[name]).parameters.values()
    own = {p.name for p in parameters if p.kind is p.KEYWORD_ONLY} - {*options.NOT_OPTIONS}
    given = set(inspect.signature(options.arguments_of(FILTERS[name].__name__)).parameters)
    assert own - given <= IN_SCRIPTS[name]
    for option in own - IN_SCRIPTS[name]:
        text = {"light": "when"}.get(option, option) if name == "project" else option
        assert f"--{text.replace('_', '-')} " in out


@pytest.mark.parametrize("name", FILTERS)
def test_help_has_groups_and_an_example_and_fits_a_screen(name, run, monkeypatch):
    out = shown(name, run, monkeypatch)
    groups = ["Arguments", "Light", "Material", "Camera", "Output"]
    assert [out.index(f"─ {group} ─") for group in groups] == sorted(
        out.index(f"─ {group} ─") for group in groups
    )
    assert f"Example: vizlight {name} " in out
    assert len(out.splitlines()) <= 92


def test_the_first_clause_of_an_option():
    assert options.first_clause("Highlight, R . E or N . H. More.") == "Highlight, R . E or N . H."
    long = (
        "Whether it has the exponent p(k, n: the one), which gives lines the contrast of a surface."
    )
    assert options.first_clause(long) == "Whether it has the exponent p(k, n: the one)."


def test_azimuth_and_altitude(folder, run):
    for text, direction in (
        ("90,0", (1, 0, 0)),
        ("0,0", (0, 1, 0)),
        ("315,30", (-(0.375**0.5), 0.375**0.5, 0.5)),
        ("12,90", (0, 0, 1)),
        ("-1,2,3", (-1, 2, 3)),
        ("-y", (0, -1, 0)),
    ):
        code, _, err = run("light", "flow.vti", "--light", text, "-o", "lit.vtp")
        assert (code, err) == (0, "")
        (light,) = vizlight.provenance(pv.read("lit.vtp"))["scene"]["lights"]
        np.testing.assert_allclose(light["direction"], direction, atol=1e-15)


def test_a_scene_of_a_file_lights_as_in_a_script(folder, run):
    Path("view.json").write_text(json.dumps(SCENE | {"view": VIEW}))
    arguments = ("light", "flow.vti", "--contour", "r", "--scene", "view.json")
    code, _, err = run(*arguments, "-o", "lit.vtp")
    assert (code, err) == (0, "")
    scene = vizlight.Scene.from_dict(SCENE | {"view": VIEW})
    lit = vizlight.illuminate(pv.read("flow.vti").contour([5.06], scalars="r"), scene)
    assert vizlight.provenance(pv.read("lit.vtp"))["scene"] == vizlight.provenance(lit)["scene"]
    code, _, err = run(*arguments, "--diffuse", "0.3", "--light", "0,0,1", "-o", "lit.vtp")
    made = vizlight.provenance(pv.read("lit.vtp"))["scene"]
    assert made["material"] == {**vizlight.provenance(lit)["scene"]["material"], "diffuse": 0.3}
    assert [light["direction"] for light in made["lights"]] == [[0.0, 0.0, 1.0]]


def test_planes_and_ranges_keep_what_they_say(folder, run):
    for option, low, high in (
        ("--clip=z:5", 0, 5),
        ("--clip=-z:-5", 5, 11),
        ("--clip=0,0,-2:-5", 5, 11),
        ("--slice=0,0,3:4", 4, 4),
    ):
        code, _, err = run("light", "flow.vti", option, "-o", "lit.vtp")
        assert (code, err) == (0, ""), option
        bounds = pv.read("lit.vtp").bounds
        assert (bounds.z_min, bounds.z_max) == pytest.approx((low, high), abs=1e-5)
    sizes = []
    for text in ("r:2:4", "r:2:", "r::4"):
        arguments = ("light", "flow.vti", "--threshold", text, "-o", "lit.vtu", "--no-surface")
        code, _, err = run(*arguments, "--tangents", "V")
        assert (code, err) == (0, ""), text
        sizes.append(pv.read("lit.vtu").n_cells)
    assert sizes[0] < min(sizes[1:])
    assert max(sizes) < 11**3


def test_several_files_are_lit_each_by_itself(folder, run):
    shutil.copy("flow.vti", "again.vti")
    (folder / "made").mkdir()
    arguments = ("--contour", "r", "-o", "made", *SMALL)
    code, _, err = run("light", "flow.vti", "again.vti", *arguments)
    assert (code, err) == (0, "")
    assert {p.name for p in Path("made").iterdir()} == {
        f"{name}-lit.{suffix}" for name in ("flow", "again") for suffix in ("vtp", "png")
    }
    same_arrays(pv.read("made/flow-lit.vtp"), pv.read("made/again-lit.vtp"))


def test_an_error_in_one_file_leaves_the_others(folder, run):
    code, _, err = run("light", "none.vti", "torus.vtp", "flow.vti", "--contour", "r")
    assert code == 2
    assert err.count("\n") == 2
    assert err.startswith("vizlight: none.vti: file: expected a file")
    assert "vizlight: torus.vtp: contour: expected" in err
    assert Path("flow-lit.vtp").exists()
    assert not list(folder.glob("torus-lit*"))


def test_no_input_is_overwritten(folder, run):
    shutil.copy("torus.vtp", "flow-lit.vtp")
    before = Path("flow-lit.vtp").read_bytes()
    code, _, err = run("light", "flow.vti", "flow-lit.vtp")
    assert code == 2
    assert "flow.vti: output: expected another file than the input, got 'flow-lit.vtp'" in err
    assert Path("flow-lit.vtp").read_bytes() == before


@pytest.mark.opengl
@pytest.mark.parametrize(("altitude", "gray"), [(10, 1 / 3), (45, 0.5**0.5)])
def test_level_ground_under_a_low_sun_is_not_black(altitude, gray, folder, run):
    """The picture is brighter, and says so; the numbers are the shadow's own."""
    flat = pv.ImageData(dimensions=(9, 9, 1))
    flat["height"] = np.zeros(flat.n_points)
    flat.save("flat.vti")
    asked = ("--no-lit", "--light", f"315,{altitude}", "-o", "a.png", "-o", "a.vti", *SMALL)
    code, out, _ = run("relief", "flat.vti", *asked)
    assert code == 0
    assert ("white in the picture is t = 0.52" in out) == (altitude == 10)
    np.testing.assert_allclose(pv.read("a.vti")["t"], np.sin(np.radians(altitude)), atol=1e-6)
    picture = np.array(Image.open("a.png").convert("L"))
    assert abs(int(picture[30, 45]) - 255 * gray) <= 1


def test_a_map_in_degrees_is_lit_as_it_is_shown(folder, run):
    """The light is that of the heights in the picture, which the map as it is has not."""
    grid = pv.ImageData(dimensions=(30, 20, 1), spacing=(1 / 60, 1 / 60, 1), origin=(11, 60, 0))
    x, y, _ = grid.points.T
    grid["height"] = 200 * np.sin(15 * x) * np.cos(20 * y)
    grid.field_data["unit"] = ["degree"]
    grid.save("map.vti")
    code, out, _ = run("relief", "map.vti", "-o", "lit.vti")
    assert (code, "heights are taken 5 times" in out) == (0, True)
    made = pv.read("lit.vti")
    shown = vizlight.files.warped(grid, "height", 5.0)
    known = vizlight.provenance(made, "t")
    scene = vizlight.Scene.from_dict(known["scene"])
    raised = vizlight.relief_shadow(shown, scene, lit=True, depth=known["depth"])
    np.testing.assert_allclose(made["luminance"], raised["luminance"], atol=2e-6)
    assert np.ptp(made["luminance"]) > 0.15
    run("relief", "map.vti", "-o", "true.vti", "--exaggeration", "1")
    assert not np.allclose(pv.read("true.vti")["t"], made["t"], atol=0.01)


def test_report_stands_in_the_script_too(folder, capfd, run):
    arguments = ("relief", "terrain.vti", "--report", "-o", "lit.vti", "--progress")
    code, script, _ = run(*arguments, "--script")
    assert code == 0
    exec(script, {})
    printed, _ = capfd.readouterr()
    code, out, _ = run(*arguments)
    for text in (printed, out):
        assert "points" in text
        assert "not measured between points: cast shadows" in text
    code, out, _ = run("sky", "terrain.vti", "--report", "-o", "skylit.vti")
    assert (code, "or less at 95 of 100 points, as estimated, horizons" in out) == (0, True)


def test_components_of_vectors_are_joined(folder, run):
    mesh = pv.read("flow.vti")
    x, y, z = mesh["V"].T
    mesh["u"], mesh["v"] = x, y
    mesh.save("parts.vti")
    mesh["V"] = np.column_stack([x, y, 0 * z])
    mesh.save("whole.vti")
    for file, name in (("parts", "u,v"), ("whole", "V")):
        code, _, _ = run(
            "light", f"{file}.vti", "--tangents", name, "-o", f"{file}-lit.vtp",
        )  # fmt: skip
        assert code == 0
    parts, whole = pv.read("parts-lit.vtp"), pv.read("whole-lit.vtp")
    np.testing.assert_array_equal(parts["luminance"], whole["luminance"])
    joined = vizlight.files.with_vectors(pv.read("parts.vti"), "v,u")
    np.testing.assert_array_equal(joined["v,u"][:, [1, 0, 2]], pv.read("whole.vti")["V"])
    code, _, _ = run("streamlines", "parts.vti", "--vectors", "u,v", "-o", "lines.vtp")
    assert code == 0
    assert np.ptp(pv.read("lines.vtp").points[:, 2]) > 0.1


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("streamlines flow.vti --vectors U", "vectors: expected the name of an array of 3"),
        ("streamlines flow.vti --step 0", "step: expected"),
        ("streamlines flow.vti --seeds x", "--seeds"),
        ("streamlines flow.vti --vectors V --confined", "surface: expected a surface"),
        (
            "streamlines flow.vti --vectors V -o a.vti",
            "ends in .vtp, .vtk, .vtu, .stl for PolyData",
        ),
        (
            "relief flow.vti --contour r --exaggeration 3",
            "--exaggeration: expected --warp",
        ),
        ("relief torus.vtp --depth -1", "depth: expected"),
        ("relief terrain.vti --elevation none", "expected"),
        ("relief terrain.vti -o a.vtp", "ends in .vti, .vtk, .stl for ImageData"),
        ("fur flow.vti --contour r --density 0.1 --absorption 0.2", "absorption, density: exp"),
        ("fur flow.vti --contour r --density 2", "density: expected a number from 0 to 1"),
        ("fur flow.vti --contour r --density 0.1 --toward up --bend 1", "toward: expected"),
        ("contours flow.vti --levels much", "--levels: expected a number"),
        ("contours flow.vti --levels 0", "levels: expected"),
        ("project flow.vti", "expected"),
        ("project torus.vtp --rotation xw", "--rotation: expected PLANE:ANGLE"),
        ("project torus.vtp --rotation xq:1", "expected"),
        ("project torus.vtp --hyperplane 1,2", "--hyperplane: expected NORMAL:OFFSET"),
        ("project torus.vtp --light 1,2,3,4,5", "--light: expected three numbers x,y,z or 4"),
        ("project torus.vtp --view 1,2,3,4,5", "--view: expected three numbers x,y,z or 4"),
        ("project torus.vtp --distance 0.1", "expected"),
        ("light flow.vti --light 10,95", "altitude: expected degrees from -90 to 90"),
        ("light flow.vti --light nan,1,2", "--light: expected three numbers"),
        ("light flow.vti --slice 1,2", "--slice: expected NORMAL:OFFSET"),
        ("light flow.vti --slice x:1 --contour r", "--slice: expected no --contour beside it"),
        ("light flow.vti --clip 0,0,0:1", "--clip: expected NORMAL:OFFSET"),
        ("light flow.vti --clip x:-9", "--clip: expected a value that leaves points"),
        ("light flow.vti --slice x:99", "--slice: expected a value that leaves points"),
        ("light flow.vti --threshold r", "--threshold: expected NAME:LOW:HIGH"),
        ("light flow.vti --threshold r:3:1", "--threshold: expected NAME:LOW:HIGH"),
        ("light flow.vti --threshold q:3:4", "--threshold: expected the name of an array, one of"),
        ("light flow.vti --threshold r:99:", "--threshold: expected a value that leaves"),
        ("light flow.vti --scalars U", "--scalars: expected an array, one"),
        ("light flow.vti --scalars r --cmap no", "--cmap: expected the name of a colour map"),
        ("light flow.vti --scene no.json", "--scene: expected a JSON file, got 'no.json' (No such"),
        ("light flow.vti --scene flow.vti", "--scene: expected a JSON file"),
        ("light flow.vti --scene list.json", "--scene 'list.json': values: expected a dict of"),
        (
            "light flow.vti --for shape --headlight",
            "--for: expected lights of its own, got --headl",
        ),
        ("light flow.vti --view 0,0,0", "--view: expected a direction x,y,z, not all zero"),
        (
            "light flow.vti --contour r --for direction",
            "--for direction: expected --tangents with it where there are no lines",
        ),
        ("light flow.vti --for value", "--for value: expected --scalars with it, one of ['r', 'V'"),
        (
            "light flow.vti --contour r --scalars r --for shape",
            "--for shape: expected no --scalars beside it",
        ),
        ("light flow.vti --view list.json", "--view: expected a JSON list of the camera's"),
        ("light flow.vti --view no.json", "--view: expected a JSON file"),
        ("light flow.vti --view up", "--view: expected three numbers x,y,z"),
        ("light flow.vti flow.vti", "file: expected files of different names"),
        ("light flow.vti torus.vtp -o a.png", "output: expected a folder that exists"),
        ("light flow.vti -o none/a.png", "output: expected a folder that exists, got 'none'"),
        ("light flow.vti -o a.vtm", "it is one mesh, which has no blocks"),
        ("light flow.vti --tangents r,q", "names U,V of components, one of ['r', 'V'"),
        ("light terrain.vti --for slope", "for a surface without a flow, such as terrain, take --"),
        ("streamlines flow.vti --vectors U", "'U'; pass --vectors V"),
        ("fur scan.vtp", "mesh: expected a surface with faces, got a PolyData mesh without"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(line, words, folder, run):
    Path("list.json").write_text("[1, 2]")
    pv.PolyData(np.random.default_rng(0).random((30, 3))).save("scan.vtp")
    before = sorted(folder.iterdir())
    code, out, err = run(*line.split())
    assert (code, out) == (2, ""), err
    assert err.startswith("vizlight: ")
    assert words in err
    assert err.count("\n") == 1
    assert sorted(folder.iterdir()) == before


def test_completion_knows_commands_and_options():
    script = cli.app.generate_completion(shell="bash")
    for word in ("streamlines", "--rotation", "--tangents", "--threshold", "cylinder"):
        assert word in script
    assert "--install-completion" in script


def test_help_of_the_whole_loads_no_pyvista():
    code = (
        "import sys\nfrom vizlight import cli\ncli.main(['--help'])\n"
        "assert 'pyvista' not in sys.modules\n"
    )
    # As bytes: the output need not have the encoding of this process.
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert (run.returncode, run.stderr) == (0, b"")


@pytest.mark.parametrize(
    ("line", "file", "name", "expected"),
    [
        (
            "streamlines flow.vti --vectors V --contour r --confined --seeds 9 --model blinn",
            "lit.vtp",
            "luminance",
            {"vectors": "V", "confined": True, "seeds": 9, "model": "blinn", "seed": 0},
        ),
        (
            "relief terrain.vti --depth 0.5 --border wall --angular-diameter 0.01 --name shade",
            "lit.vti",
            "shade",
            {"depth": 0.5, "border": "wall", "angular_diameter": 0.01, "method": "fast"},
        ),
        (
            "fur flow.vti --contour r --density 0.3 --length r --toward -1,0,2 --bend 0.5 "
            "--fibres 8",
            "lit-fibres.vtp",
            "luminance",
            {"density": 0.3, "length": "r", "toward": [-1, 0, 2], "bend": 0.5}
            | {"conditioned": True},
        ),
        (
            "contours flow.vti --contour r --levels 1/50 --model blinn",
            "lit-bands.vtp",
            "luminance",
            {"levels": 0.02, "model": "blinn"},
        ),
        (
            "project torus.vtp --rotation xw:0.5 --rotation yz:-1/4 --distance 4 --components",
            "lit.vtk",
            "luminance",
            {"rotation": [["xw", 0.5], ["yz", -0.25]], "distance": 4.0, "components": True},
        ),
    ],
)
def test_options_reach_the_filter(line, file, name, expected, folder, run):
    suffix = Path(file).suffix
    code, _, err = run(*line.split(), "-o", f"lit{suffix}")
    assert code == 0, err
    options = vizlight.provenance(pv.read(file), name)["options"]
    assert {key: options[key] for key in expected} == expected


def test_a_saved_camera_is_the_view(folder, run):
    Path("camera.json").write_text(json.dumps([[30, -10, 20], [5, 5, 5], [0, 0, 1]]))
    arguments = ("light", "flow.vti", "--contour", "r", "--view", "camera.json", "-o", "lit.vtp")
    for parallel in ((), ("--parallel",)):
        assert run(*arguments, *parallel)[0] == 0
        view = vizlight.provenance(pv.read("lit.vtp"))["scene"]["view"]
        assert view["position"] == [30, -10, 20]
        direction = np.array([25, -15, 15]) / np.linalg.norm([25, -15, 15])
        np.testing.assert_allclose(view["direction"], direction, atol=1e-12)
        assert view["parallel"] is bool(parallel)


def test_lights_and_eye_of_n_space_are_filled_up_with_zeros(folder, run):
    arguments = ("project", "torus.vtp", "--view", "0,-1,2", "-o", "lit.vtk")
    assert run(*arguments, "--light", "90,0", "--light-position", "1,2,3,4")[0] == 0
    scene = vizlight.provenance(pv.read("lit.vtk"))["scene"]
    assert scene["view"]["direction"] == [0, -1, 2, 0]
    assert scene["lights"][0]["direction"] == [1, 0, 0, 0]
    assert scene["lights"][1]["position"] == [1, 2, 3, 4]
    assert run(*arguments)[0] == 0
    lights = vizlight.provenance(pv.read("lit.vtk"))["scene"]["lights"]
    assert lights == json.loads(json.dumps(vizlight.Scene().to_dict()["lights"]))


@pytest.mark.opengl
def test_colours_of_data_are_multiplied_by_the_light(folder, run):
    arguments = ("light", "flow.vti", "--slice", "z:4", "--scalars", "r", "-o", "a.png", *SMALL)
    code, script, _ = run(*arguments, "--script")
    assert code == 0
    space = {}
    exec(script, space)
    lit, ends = space["lit"], space["lit"].get_data_range("r")
    table = pv.LookupTable(vizlight.maps.even, scalar_range=ends)
    colors = np.array([table(float(r))[:3] for r in lit["r"]])
    # No highlight, and ambient light of 0.3 or more.
    scene = vizlight.Scene.from_dict(vizlight.provenance(lit)["scene"])
    terms = vizlight.illuminate(lit, scene, components=True, name="again")
    light = max(scene.material.ambient, 0.3) + np.asarray(terms["again_diffuse"])
    expected = colors * np.clip(light, 0, 1)[:, np.newaxis]
    np.testing.assert_allclose(space["shown"]["tint"] / 255, expected, atol=1.5 / 255)
    picture = np.asarray(pv.read("a.png")["PNGImage"], dtype=int)
    assert np.ptp(picture, axis=1).max() > 50


def test_parts_are_blocks_of_one_file_and_one_page(folder, run):
    """Other outputs have a file for each part."""
    given = ("fur", "flow.vti", "--contour", "r", "--level", "4", "--fibres", "50")
    code, out, _ = run(*given, "-o", "a.vtm", "-o", "a.html", "-o", "b.vtp")
    assert (code, out.count("mesh  "), out.count("page  ")) == (0, 3, 1)
    blocks = pv.read("a.vtm")
    assert blocks.keys() == ["fibres", "skin"]
    for name in blocks.keys():  # noqa: SIM118 - a MultiBlock is a list of its blocks
        same_arrays(blocks[name], pv.read(f"b-{name}.vtp"))
    page = Path("a.html").read_text(encoding="utf-8")
    assert "fibres" in page
    assert "skin" in page
    code, out, _ = run(*given, "-o", "c.vtm", "-o", "c.html", "--script")
    exec(compile(out, "script", "exec"), {})
    same_arrays(pv.read("c.vtm")["skin"], blocks["skin"])
    # Pages name the pictures that a reader saves after themselves.
    again = Path("c.html").read_text(encoding="utf-8")
    assert again.replace('": "c"', '": "a"') == page
    code, _, err = run("light", "flow.vti", "-o", "d.vtm")
    assert (code, "a name that ends in .vtp, .vtk, .vtu, .stl for PolyData" in err) == (2, True)


def test_steps_without_a_flow_name_those_that_have_one(folder, run):
    import foam

    def fields(time, middles):
        return {"U": time * np.tile([1.0, 0.5, 0.2], (len(middles), 1))}

    foam.write(folder / "case", [0, 0.5, 2], fields)
    arguments = ("streamlines", "case/case.foam", "--vectors", "U", "--seeds", "5")
    code, out, _ = run(*arguments, "-o", "a.vtp")
    assert (code, "note     time 2, the last of 3 steps; --time takes" in out) == (0, True)
    code, _, err = run(*arguments, "--time", "0", "-o", "a.vtp")
    assert (code, "'U' is not zero everywhere, got 0; pass --time with one of 0.5, 2" in err) == (
        2,
        True,
    )
    # So it is where the only vectors are taken.
    _, _, same = run("streamlines", "case/case.foam", "--time", "0", "-o", "a.vtp")
    assert same == err
    (folder / "out").mkdir()
    code, out, _ = run(*arguments, "--times", "1:", "-o", "out", *SMALL)
    assert (code, "note" in out) == (0, False)
    assert sorted(path.name for path in Path("out").glob("*.vtp")) == [
        "case-streamlines-0000.vtp",
        "case-streamlines-0001.vtp",
    ]
    (folder / "all").mkdir()
    code, out, _ = run("light", *arguments[1:2], "--times", "all", "-o", "all", *SMALL)
    assert (code, len([*Path("all").glob("*.png")])) == (0, 3)
    for asked in ("3:", "x", "all --time 1"):
        code, _, err = run(*arguments, "--times", *asked.split(), "-o", "out")
        assert (code, "--times: expected all, or indices of steps" in err) == (2, True)


def test_the_picture_of_a_share_is_not_white_on_white(tmp_path, monkeypatch, run):
    monkeypatch.chdir(tmp_path)
    pv.Sphere().save("ball.stl")
    for words, gray in (("", True), ("--background white", False)):
        code, _, error = run("sky", "ball.stl", "-o", "sky.png", *words.split())
        assert code == 0, error
        corner = pv.read("sky.png")["PNGImage"][0]
        assert (np.abs(corner.astype(int) - 128).max() < 3) == gray
