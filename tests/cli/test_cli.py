"""The command line as a user meets it: one line on standard error, an exit code, whole files."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import Scene, cli, render
from vizlight.draw import backends


@pytest.fixture
def volume(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    grid = pv.ImageData(dimensions=(12, 12, 12))
    x, y, z = (grid.points - 5.5).T
    grid["r"] = np.sqrt(x * x + y * y + z * z)
    grid["V"] = np.stack([-y - 0.1, x + 0.1, 0.2 * z + 1], axis=1).astype(np.float32)
    grid.cell_data["C"] = np.ones((grid.n_cells, 3))
    grid.save("flow.vti")
    return "flow.vti"


def test_ctrl_c_is_one_line(volume, tmp_path, capfd, monkeypatch):
    def interrupted(*_args, **_keywords):
        raise KeyboardInterrupt

    # The package keeps the name of what it has loaded.
    for module in (vizlight, vizlight.files):
        monkeypatch.setattr(module, "read", interrupted)
    out = tmp_path / "lit.vtp"
    assert cli.main(["light", str(volume), "-o", str(out)]) == 2
    assert capfd.readouterr().err == "vizlight: interrupted\n"
    assert not out.exists()


@pytest.mark.opengl
def test_light_writes_mesh_and_picture(volume, tmp_path, run):
    code, out, err = run(
        "light",
        volume,
        "--contour r --level 4 --tangents V --conditioned --components --light -1,-2,3",
        "--size 120x90",
    )
    assert (code, err) == (0, "")
    assert "points lit in" in out
    assert {p.name for p in tmp_path.iterdir()} == {"flow.vti", "flow-lit.vtp", "flow-lit.png"}
    lit = pv.read("flow-lit.vtp")
    told = vizlight.provenance(lit)
    assert told["options"]["conditioned"]
    scene = Scene.from_dict(told["scene"])
    assert scene.lights[0].direction == (-1.0, -2.0, 3.0)
    again = vizlight.illuminate(lit, scene, **told["options"])
    np.testing.assert_array_equal(again["luminance"], lit["luminance"])


@pytest.mark.opengl
def test_upper_case_endings(volume, tmp_path, run):
    code, _, err = run("light", volume, "-o", "A.VTP", "-o", "B.PNG", "--size", "30x30")
    assert (code, err) == (0, "")
    assert (tmp_path / "A.VTP").stat().st_size > 0
    assert (tmp_path / "B.PNG").stat().st_size > 0


@pytest.mark.parametrize("suffix", [".vtp", ".vtu", ".vtk"])
def test_outputs_by_ending(suffix, volume, tmp_path, run):
    code, _, err = run("light", volume, "-o", f"x{suffix}", "--view", "0,-1,0", "--headlight")
    assert (code, err) == (0, "")
    assert "luminance" in pv.read(f"x{suffix}").point_data
    assert not list(tmp_path.glob("*.png"))


def test_gltf_has_the_colours_of_the_picture(volume, tmp_path, run):
    grid = pv.read(volume)
    grid["height"] = grid.points[:, 2]
    grid.save(volume)
    options = ("--contour", "r", "--light", "1,2,3")
    for name, extra in (("a.glb", ()), ("B.GLB", ("--scalars", "height"))):
        code, out, err = run("light", volume, *options, *extra, "-o", name)
        assert (code, err) == (0, "")
        assert f"mesh     {name}" in out
    plain, colored = ((tmp_path / name).read_bytes() for name in ("a.glb", "B.GLB"))
    assert plain[:4] == b"glTF"
    assert b"KHR_materials_unlit" in plain
    assert len(plain) == len(colored)
    assert plain != colored


def test_script_for_paraview(volume, tmp_path, run):
    options = ("light", volume, "--contour", "r", "--tangents", "V", "--paraview")
    code, out, err = run(*options, "a.py")
    assert (code, err) == (0, "")
    assert "mesh     a.py" in out
    assert sorted(path.name for path in tmp_path.glob("a*")) == ["a-paraview.vtp", "a.py"]
    assert not list(tmp_path.glob("*.png"))
    assert str(tmp_path / "a-paraview.vtp") in (tmp_path / "a.py").read_text()
    code, out, _ = run(*options, "a.py", "--script")
    assert code == 0
    assert 'paraview.save(lit, None, "a.py")' in out
    # The light of a cylinder is no program of fragments, and a script is named as one.
    for more, words in ((("b.py", "--model", "cylinder"), "integral"), (("b.txt",), ".py")):
        code, _, err = run(*options, *more)
        assert code == 2
        assert words in err
    again = ("light", tmp_path / "a-paraview.vtp", "--paraview", "a.py")
    assert "another file than the input" in run(*again)[2]
    assert not list(tmp_path.glob("b*"))


def test_all_points_of_a_volume(volume, run):
    code, _, err = run("light", volume, "--no-surface", "--tangents", "V", "-o", "x.vti")
    assert (code, err) == (0, "")
    assert pv.read("x.vti").n_points == 12**3


@pytest.mark.opengl
def test_more_options(volume, run):
    code, out, err = run(
        "light",
        volume,
        "--tangents C --light-position 9,9,-9 --color tomato --depth-cue --parallel --model blinn",
        "--specular 0.2 --explain --precision float64 --progress --exponent 1 --up 0,1,0",
        "-o c.png --size 60x60 --background black --zoom 1.2",
    )
    assert code == 0
    assert "compute  specular: blinn" in out
    assert "depth cue: linear" in out
    assert "float64" in out
    assert "100%" in err


def test_terrain_is_warped(tmp_path, monkeypatch, run):
    monkeypatch.chdir(tmp_path)
    grid = pv.ImageData(dimensions=(9, 9, 1))
    grid["elevation"] = np.sin(grid.points[:, 0])
    grid.save("t.vti")
    code, _, err = run(
        "light", "t.vti", "--warp", "elevation", "--exaggeration", "2", "-o", "t.vtp"
    )
    assert (code, err) == (0, "")
    assert pv.read("t.vtp").bounds.z_max > 1.5
    assert np.ptp(pv.read("t.vtp")["luminance"]) > 0.1


def test_what_may_have_been_meant_is_told(volume, tmp_path, run):
    pv.ImageData(dimensions=(4, 5, 1)).save("bare.vti")
    flat = pv.ImageData(dimensions=(4, 5, 1))
    flat["height"] = np.arange(20.0)
    flat["number"] = np.arange(20)
    flat["constant"] = np.ones(20)
    flat["NodeId"] = np.arange(20.0)
    order = ("NodeId", "constant", "number", "height")
    kept = {name: flat[name].copy() for name in order}
    flat.clear_data()
    flat.point_data.update(kept)
    flat.save("flat.vti")
    colors = pv.ImageData(dimensions=(4, 5, 1))
    colors["rgb"] = np.full((20, 3), 200, np.uint8)
    colors.save("colors.vti")
    cells = pv.ImageData(dimensions=(4, 5, 1))
    cells.cell_data["region"], cells.cell_data["temperature"] = np.arange(12), np.arange(12.0)
    cells.save("cells.vti")
    for options, words in (
        ((volume,), "hull of a volume is lit; --contour r"),
        (("flat.vti",), "flat; --scalars height colours it, --warp height raises it"),
        (("flat.vti", "--scalars", "height"), "mesh is flat; --warp height"),
        (("colors.vti",), "mesh is flat; --scalars rgb"),
        (("colors.vti", "--scalars", "rgb"), ""),
        (("cells.vti",), "mesh is flat; --scalars temperature"),
        ((volume, "--no-surface"), ""),
        ((volume, "--contour", "r", "--scalars", "r"), "r is the same all over its isosurface"),
        (("flat.vti", "--warp", "height"), "heights are taken 0.1 times"),
        (("flat.vti", "--warp", "height", "--exaggeration", "1"), ""),
        (("bare.vti",), ""),
    ):
        code, out, _ = run("light", *options, "-o", "a.vtk")
        assert code == 0
        assert words in out if words else "note" not in out


def test_values_over_a_surface_that_no_picture_shows_are_told(tmp_path, monkeypatch, run):
    monkeypatch.chdir(tmp_path)
    nibabel = pytest.importorskip("nibabel")
    ball = pv.Sphere()
    ball.save("ball.ply")
    nibabel.freesurfer.write_morph_data("lh.curv", ball.points[:, 2])
    shows = ("--overlay", "lh.curv", "-o", "a.vtp")
    code, out, _ = run("light", "ball.ply", *shows)
    assert code == 0
    assert "note     --scalars lh.curv shows the values over the surface" in out
    assert "note" not in run("light", "ball.ply", "--scalars", "lh.curv", *shows)[1]


@pytest.mark.opengl
def test_a_direction_is_the_name_of_an_axis(volume, tmp_path, run):
    pictures = []
    for up, view in (("y", "x"), ("0,1,0", "1,0,0"), ("z", "x")):
        options = ("--contour", "r", "--up", up, "--view", view, "-o", "a.png")
        assert run("light", volume, *options)[0] == 0
        pictures.append(pv.read("a.png")["PNGImage"])
    np.testing.assert_array_equal(pictures[0], pictures[1])
    assert np.any(pictures[0] != pictures[2])


def test_colours_of_a_file_are_no_light(tmp_path, monkeypatch, run):
    monkeypatch.chdir(tmp_path)
    ball = pv.Sphere()
    ball["rgb"] = np.full((ball.n_points, 3), 200, np.uint8)
    ball.save("ball.vtp")
    assert run("light", "ball.vtp", "-o", "a.png")[::2] == (0, "")
    assert "white in the picture" in run("light", "ball.vtp", "--diffuse", "9", "-o", "a.png")[2]


def test_points_that_cannot_be_lit_are_told_and_no_error(volume, run):
    grid = pv.read(volume)
    grid["V"][:3] = 0
    grid.save("flow.vti")
    code, _, err = run("light", volume, "--no-surface", "--tangents", "V", "-o", "x.vti")
    assert code == 0
    assert err.startswith("vizlight: 3 of 1728 points could not be lit")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("light no.vtp", "file: expected a file, got 'no.vtp' (no such file)"),
        ("light .", "file: expected a file, got '.' (a folder)"),
        ("light flow.vti -o flow.vti --no-surface", "another file than the input"),
        ("light flow.vti --level 3", "--level: expected --contour with it"),
        ("light flow.vti --exaggeration 3", "--exaggeration: expected --warp with it"),
        ("light flow.vti --background nocolor", "background: expected a colour's name"),
        ("light flow.vti --line-width -1", "--line-width: expected a number from 0.1"),
        ("light flow.vti --size 9000x100", "size: expected at most 8192 pixels per side"),
        ("light flow.vti --view 0,0,1 --up 0,0,2", "up: expected a direction across"),
        ("light bad.vtp", "file: expected a mesh that PyVista reads"),
        ("light", "requires an argument"),
        ("light flow.vti --tangents U", "tangents: expected the name of a point array"),
        ("light flow.vti --tangents r", "tangents: expected vectors"),
        ("light flow.vti --no-surface -o x.vti --normals C", "got the cell array 'C'"),
        ("light flow.vti --contour V", "contour: expected an array of one"),
        ("light flow.vti --contour r --level 99", "level: expected a value between"),
        ("light flow.vti -o x.gif", "output: expected a name that ends in"),
        ("light flow.vti -o none/x.vtp", "output: expected a folder that exists"),
        ("light flow.vti -o x.vti", "output: expected a name that ends in .vtp"),
        ("light flow.vti --light 1", "--light: expected three numbers x,y,z"),
        ("light flow.vti --light 0,0,0", "--light: expected a direction x,y,z, not all zero"),
        ("light flow.vti --color nothing", "color: expected a colour's name"),
        ("light flow.vti --size big", "--size: expected WIDTHxHEIGHT"),
        ("light flow.vti --size 0x5", "size: expected an integer of at least 1"),
        ("light flow.vti --shininess -1", "shininess: expected"),
        ("light flow.vti --shininess x", "--shininess"),
        ("light flow.vti --model x", "--model"),
        ("light flow.vti --bogus", "--bogus"),
        ("demo --out bad.vtp", "out: expected a folder that can be made"),
        ("nothing", "nothing"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(arguments, words, volume, tmp_path, run):
    (tmp_path / "bad.vtp").write_text("garbage")
    before = sorted(tmp_path.iterdir())
    code, out, err = run(arguments)
    assert code == 2
    assert out == ""
    assert err.startswith("vizlight: ")
    assert words in err
    assert err.count("\n") == 1
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.opengl
def test_demo(tmp_path, monkeypatch, run):
    monkeypatch.chdir(tmp_path)
    code, out, _ = run("demo", "--size", "200x100")
    assert code == 0
    for part in ("points", "terms", "time", "error", "by the key", "compute  diffuse: |wi_N|"):
        assert part in out
    assert {p.name for p in (tmp_path / "vizlight-demo").iterdir()} == {"flow.vtp", "flow.png"}
    lit = pv.read("vizlight-demo/flow.vtp")
    assert {"luminance", "rgb", "wind"} <= set(lit.point_data)


def test_paths_of_the_plugin_for_paraview(run):
    code, out, _ = run("paraview")
    assert code == 0
    *files, start = (line.split(maxsplit=1)[1] for line in out.splitlines())
    paths = [Path(file) for file in files]
    names = ["vizlight_plugin.py", "sitecustomize.py", "vizlight_eye.py"]
    assert [path.name for path in paths] == names
    for path in paths:
        compile(path.read_text(encoding="utf-8"), path, "exec")
        assert start == f"PYTHONPATH={path.parent} paraview"


def test_doctor(run):
    code, out, _ = run("doctor")
    assert code == (0 if render.probe("egl").works or render.probe("osmesa").works else 1)
    for part in ("python", "vtk", "pyvista", "egl", "osmesa", "rotating_disk.vtu"):
        assert part in out


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="backends are chosen on Linux")
def test_without_opengl_the_mesh_is_written_and_the_exit_code_is_1(
    volume, tmp_path, run, monkeypatch
):
    monkeypatch.delenv("VTK_DEFAULT_OPENGL_WINDOW", raising=False)
    monkeypatch.setattr(
        backends, "_PROBE", "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"
    )
    backends._probe_window.cache_clear()
    try:
        code, _, err = run("light", volume, "--tangents", "V")
        doctor = run("doctor")
    finally:
        backends._probe_window.cache_clear()
    assert code == 1
    assert "apt-get install -y libegl1 libgl1-mesa-dri" in err
    assert err.count("\n") == 1
    assert {p.name for p in tmp_path.iterdir()} == {"flow.vti", "flow-lit.vtp"}
    assert doctor[0] == 1
    assert "apt-get install -y" in doctor[2]


def test_help_and_version(run):
    code, out, _ = run("--help")
    assert code == 0
    assert "demo" in out
    code, out, _ = run("--version")
    assert out.strip() == vizlight.__version__


def test_another_name_where_the_file_has_its_own(tmp_path, monkeypatch, run):
    monkeypatch.chdir(tmp_path)
    mesh = pv.Sphere()
    mesh["luminance"] = np.arange(mesh.n_points)
    mesh.save("own.vtp")
    code, _, err = run("light", "own.vtp", "-o", "lit.vtp")
    assert code != 0
    assert "--name" in err
    code, _, err = run("light", "own.vtp", "--name", "light", "-o", "lit.vtp")
    assert (code, err) == (0, "")
    np.testing.assert_array_equal(pv.read("lit.vtp")["luminance"], mesh["luminance"])


def test_explain_tells_of_averaged_tangents(volume, run):
    options = ("--tangents", "C", "--no-surface", "--explain", "-o", "lit.vti")
    code, out, err = run("light", volume, *options)
    assert code == 0
    assert err.count("the cell array 'C' is averaged to the points") == 1
    assert "1 orthonormal tangent" in out


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="streams of a POSIX shell")
@pytest.mark.parametrize("streams", ["2>&-", "<&- >&- 2>&-", ">/dev/full", "| true"])
def test_the_work_is_done_where_nobody_reads_what_is_said(streams, tmp_path):
    pv.Sphere(theta_resolution=4, phi_resolution=4).save(tmp_path / "ball.vtp")
    command = f"{sys.executable} -m vizlight light ball.vtp --specular 0 -o lit.vtp {streams}"
    run = subprocess.run(
        command, shell=True, cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0
    assert run.stderr == ""
    assert "luminance" in pv.read(tmp_path / "lit.vtp").point_data


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Linux starts a child")
def test_a_reader_that_crashes_is_one_line(tmp_path):
    pv.Sphere().save(tmp_path / "ball.ply", binary=True)
    os.truncate(tmp_path / "ball.ply", (tmp_path / "ball.ply").stat().st_size * 7 // 10)
    run = subprocess.run(
        [sys.executable, "-m", "vizlight", "light", "ball.ply", "--specular", "0", "-o", "a.vtp"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 2
    assert run.stderr.count("\n") == 1
    assert "vizlight: file: expected a" in run.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["ball.ply"]


def test_a_mesh_is_refined_and_the_script_does_the_same(tmp_path, monkeypatch, run):
    monkeypatch.chdir(tmp_path)
    pv.Sphere().save("ball.vtp")
    for arguments in (("light", "ball.vtp"), ("light", "ball.vtp", "--no-surface")):
        code, out, _ = run(*arguments, "-o", "fine.vtp", "--refine", "1/255", "--report")
        assert code == 0
        assert "error between points" in out
        assert "would do" not in out
        fine = pv.read("fine.vtp")
        assert fine.n_points > 842
        assert fine.field_data["luminance_error"][0] <= 1 / 255
    code, script, _ = run("light", "ball.vtp", "-o", "again.vtp", "--refine", "1/255", "--script")
    assert code == 0
    exec(compile(script, "script", "exec"), {})
    assert pv.read("again.vtp").n_points == fine.n_points
    code, _, error = run("light", "ball.vtp", "-o", "no.vtp", "--refine", "1e-9")
    assert code == 2
    assert error.startswith("vizlight: --refine: expected a number of at least 1e-05")
    code, _, error = run("light", "ball.vtp", "-o", "no.pvtp", "--refine", "0.01")
    assert code == 2
    assert error.startswith("vizlight: --refine: expected one mesh, got pieces; refine their union")


def test_lines_are_lit_as_a_bundle(tmp_path, monkeypatch, run):
    monkeypatch.chdir(tmp_path)
    pv.Sphere(theta_resolution=12, phi_resolution=12).extract_all_edges().save("edges.vtp")
    code, out, _ = run("light edges.vtp -o lit.vtp --no-surface --bundle --explain --sky")
    assert code == 0
    assert "transmittance: a share of each light" in out
    assert {"transmittance", "sky"} <= set(pv.read("lit.vtp").point_data)
    pv.Sphere().save("ball.vtp")
    code, _, error = run("light", "ball.vtp", "-o", "no.vtp", "--bundle")
    assert code == 2
    assert error.startswith("vizlight: bundle: expected a mesh with lines")


@pytest.mark.opengl
def test_legibility_is_printed_and_the_script_does_the_same(tmp_path, monkeypatch, capfd, run):
    monkeypatch.chdir(tmp_path)
    ball = pv.Sphere()
    ball["v"] = np.cross([0.2, 0, 1], ball.points)
    ball["height"] = ball.points[:, 2]
    ball.save("ball.vtp")
    arguments = ("light", "ball.vtp", "-o", "lit.vtp", "--tangents", "v", "--scalars", "height")
    code, out, _ = run(*arguments, "--legibility")
    assert code == 0
    for text in ("within 10 degrees", "median error of the normal", "nearest colour"):
        assert text in out
    code, script, _ = run(*arguments, "--legibility", "--script")
    assert code == 0
    exec(compile(script, "script", "exec"), {})
    table = capfd.readouterr().out.strip()
    assert table.startswith("question")
    assert table in out
    code, _, error = run("light", "ball.vtp", "-o", "lit.pvtp", "--legibility")
    assert code == 2
    assert "--legibility: expected one mesh, lit as a whole" in error


@pytest.mark.filterwarnings("default")
def test_a_file_that_vtk_warns_of_is_refused_in_one_line(tmp_path, capfd):
    path = tmp_path / "a.vtk"
    path.write_text("# vtk DataFile Version g.1\nwords\nASCII\nDATASET NONE\n")
    assert cli.main(["light", str(path), "-o", str(tmp_path / "b.vtk")]) == 2
    err = capfd.readouterr().err
    assert "Cannot read file version" in err
    assert err.count("\n") == 1
