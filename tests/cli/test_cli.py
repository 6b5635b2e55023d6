"""The command line as a user meets it: one line on standard error, an exit code, whole files."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from cyclopts import App

import vizlight
from vizlight import Scene, cli
from vizlight.draw import backends

#: Counts the reads of PyVista, runs a command, and prints the count and what is loaded.
COUNTED = """
import sys
import pyvista as pv
read, reads = pv.BaseReader.read, []
pv.BaseReader.read = lambda *args, **how: reads.append(args) or read(*args, **how)
from vizlight import cli
assert cli.main(sys.argv[1:]) == cli.OK
print(len(reads), *sys.modules)
"""


def test_ctrl_c_is_one_line(volume, tmp_path, capfd, monkeypatch):
    def interrupted(*_args, **_keywords):
        raise KeyboardInterrupt

    monkeypatch.setattr(vizlight.files, "read_parts", interrupted)
    out = tmp_path / "lit.vtp"
    assert cli.main(["light", str(volume), "-o", str(out)]) == 2
    assert capfd.readouterr().err == "vizlight: interrupted\n"
    assert not out.exists()


def test_a_file_in_a_folder_needs_no_suffix(tmp_path, capfd):
    (tmp_path / "solid").write_bytes(b"1 2 3")
    assert cli.main([str(tmp_path / "solid")]) == 2
    assert "no reader takes '' files" in capfd.readouterr().err


@pytest.mark.filterwarnings("ignore:data are hardly seen")
@pytest.mark.parametrize(("count", "lit"), [(3, False), (40, True)])
def test_clouds_of_points_are_drawn_and_many_are_lit(tmp_path, capfd, count, lit):
    path, out = tmp_path / "cloud.xyz", tmp_path / "cloud.vtp"
    np.savetxt(path, np.random.default_rng(0).normal(size=(count, 3)))
    assert cli.main(["light", str(path), "-o", str(tmp_path / "cloud.png")]) == 0
    assert cli.main(["light", str(path), "-o", str(out)]) == (0 if lit else 2)
    assert ("without faces" in capfd.readouterr().err) != lit
    assert out.exists() == lit


def test_names_with_control_characters_are_written_by_their_numbers(tmp_path, capfd):
    """They would move the cursor of a terminal, or turn the direction of writing."""
    name = "\x1b[31m\u202egnp\x7f\u200b"
    shown = r"\x1b[31m\u202egnp\x7f\u200b"
    assert cli.main(["light", f"{name}.vtp"]) == 2
    assert capfd.readouterr().err.endswith(f"got '{shown}.vtp' (no such file)\n")
    ball = tmp_path / f"{name}.vtp"
    pv.Icosphere(nsub=2).save(ball)
    assert cli.main(["light", str(ball), "-o", str(tmp_path / f"{name}o.vtp"), "--script"]) == 0
    script = capfd.readouterr().out
    assert script.replace("\n", "").isprintable()
    exec(script, {})
    assert (tmp_path / f"{name}o.vtp").is_file()


@pytest.mark.opengl
def test_light_writes_mesh_and_picture(volume, tmp_path, done):
    words = "--contour r --level 4 --tangents V --conditioned --components --light -1,-2,3"
    assert "points lit in" in done("light", volume, words, "--size 120x90")
    assert {p.name for p in tmp_path.iterdir()} == {"flow.vti", "flow-lit.vtp", "flow-lit.png"}
    lit = pv.read("flow-lit.vtp")
    told = vizlight.provenance(lit)
    assert told["options"]["conditioned"]
    scene = Scene.from_dict(told["scene"])
    assert scene.lights[0].direction == (-1.0, -2.0, 3.0)
    again = vizlight.illuminate(lit, scene, **told["options"])
    np.testing.assert_array_equal(again["luminance"], lit["luminance"])


def test_gltf_has_the_colours_of_the_picture(volume, tmp_path, done):
    grid = pv.read(volume)
    grid["height"] = grid.points[:, 2]
    grid.save(volume)
    options = ("--contour", "r", "--level", "4", "--light", "1,2,3")
    for name, extra in (("a.glb", ()), ("B.GLB", ("--scalars", "height"))):
        assert f"mesh     {name}" in done("light", volume, *options, *extra, "-o", name)
    plain, colored = ((tmp_path / name).read_bytes() for name in ("a.glb", "B.GLB"))
    assert plain[:4] == b"glTF"
    assert b"KHR_materials_unlit" in plain
    assert len(plain) == len(colored)
    assert plain != colored


@pytest.mark.slow
def test_script_for_paraview(volume, tmp_path, done, refused, run):
    options = ("light", volume, "--contour", "r", "--tangents", "V", "--paraview")
    assert "mesh     a.py" in done(*options, "a.py")
    assert sorted(path.name for path in tmp_path.glob("a*")) == ["a-paraview.vtp", "a.py"]
    assert not list(tmp_path.glob("*.png"))
    assert str(tmp_path / "a-paraview.vtp") in (tmp_path / "a.py").read_text()
    assert 'paraview.save(lit, None, "a.py")' in done(*options, "a.py", "--script")
    # The light of a cylinder is no program of fragments, and a script is named as one.
    for more, words in ((("b.py", "--model", "cylinder"), "integral"), (("b.txt",), ".py")):
        code, _, err = run(*options, *more)
        assert (code, words in err) == (2, True)
    again = ("light", tmp_path / "a-paraview.vtp", "--paraview", "a.py")
    assert "another file than the input" in refused(*again)
    assert not list(tmp_path.glob("b*"))


@pytest.mark.opengl
def test_a_direction_is_the_name_of_an_axis(volume, done):
    pictures = []
    for up, view in (("y", "x"), ("0,1,0", "1,0,0"), ("z", "x")):
        options = ("--contour r --for shape --size 90x60", "--up", up, "--view", view, "-o a.png")
        done("light", volume, *options)
        pictures.append(pv.read("a.png")["PNGImage"])
    np.testing.assert_array_equal(pictures[0], pictures[1])
    assert np.any(pictures[0] != pictures[2])


def test_a_colour_is_seen_in_plain_light_and_a_view_has_a_name(done):
    pv.Cone().save("part.stl")
    script = done(
        "light", "part.stl", "-o", "x.png", "--color", "tan", "--view", "front", "--script"
    )
    assert "presets" not in script
    assert "color='tan'" in script.replace('"', "'")
    assert "camera_on(data, (0.0, -1.0, 0.0)" in script
    several = done("light", "part.stl", "-o", "x.png", "--view", "front,side,top", "--script")
    assert "render.several_views(" in several
    assert "camera_on(data" not in several
    hues = done("light", "part.stl", "-o", "x.png", "--color", "tan", "--for", "shape", "--script")
    assert "vizlight.presets.shape(" in hues


def test_colours_of_a_file_are_no_light(done):
    ball = pv.Sphere()
    ball["rgb"] = np.arange(3 * ball.n_points).astype(np.uint8).reshape(-1, 3)
    ball.save("ball.vtp")
    assert done("light ball.vtp -o a.png").splitlines()[-2].startswith("shown    rgb in colours")


def test_paths_of_the_plugin_for_paraview(done):
    *files, start = (line.split(maxsplit=1)[1] for line in done("paraview").splitlines())
    paths = [Path(file) for file in files]
    names = ["vizlight_plugin.py", "sitecustomize.py", "vizlight_eye.py"]
    assert [path.name for path in paths] == names
    for path in paths:
        compile(path.read_text(encoding="utf-8"), path, "exec")
        assert start == f"PYTHONPATH={path.parent} paraview"


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


@pytest.mark.slow
@pytest.mark.sampled(2)
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="streams of a POSIX shell")
@pytest.mark.parametrize("streams", ["2>&-", "<&- >&- 2>&-", ">/dev/full", "| true"])
def test_the_work_is_done_where_nobody_reads_what_is_said(streams, tmp_path):
    pv.Sphere(theta_resolution=16, phi_resolution=16).save(tmp_path / "ball.vtp")
    command = f"{sys.executable} -m vizlight light ball.vtp --specular 0 -o lit.vtp {streams}"
    run = subprocess.run(
        command, shell=True, cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0
    assert run.stderr == ""
    assert "luminance" in pv.read(tmp_path / "lit.vtp").point_data


def counted(folder, *words):
    command = [sys.executable, "-c", COUNTED, *words]
    run = subprocess.run(command, capture_output=True, text=True, check=True, cwd=folder)
    reads, *modules = run.stdout.splitlines()[-1].split()
    return int(reads), set(modules)


def test_help_reads_the_arguments_of_its_command_once(monkeypatch, done):
    asked = []
    assemble = App.assemble_argument_collection

    def counted(app, **options):
        asked.append(app.name)
        return assemble(app, **options)

    monkeypatch.setattr(App, "assemble_argument_collection", counted)
    assert "--density" in done("fur --help")
    assert asked == [("fur",)]


def test_hillshade_leads_to_relief(done):
    assert done("hillshade --help") == done("relief --help")


@pytest.mark.parametrize("name", ["x.vtp", "X.VTU", "x.vtk", "x.vti"])
def test_outputs_by_ending(name, volume, tmp_path, done):
    more = "--no-surface --tangents V" if name == "x.vti" else "--array r --view 0,-1,0 --headlight"
    done("light", volume, "-o", name, more)
    lit = pv.read(name)
    assert "luminance" in lit.point_data
    assert (lit.n_points == 12**3) == (name == "x.vti")
    assert not list(tmp_path.glob("*.png"))


@pytest.mark.opengl
def test_what_is_computed_is_told(volume, run):
    code, out, err = run(
        "light", volume, "--tangents C --model blinn --specular 0.2 --explain --precision float64",
        "--depth-cue --progress -o c.png --size 60x60",
    )  # fmt: skip
    assert code == 0
    for text in ("specular: blinn", "depth cue: linear", "float64", "1 orthonormal tangent"):
        assert text in out
    assert "100%" in err
    assert err.count("the cell array 'C' is averaged to the points") == 1


def flat(**arrays):
    """Return a flat grid with arrays."""
    grid = pv.ImageData(dimensions=(4, 5, 1))
    for name, values in arrays.items():
        grid[name] = values
    return grid


def test_what_is_shown_is_told(volume, done, run):
    number, rising = np.arange(20), np.arange(20.0)
    flat().save("bare.vti")
    flat(NodeId=rising, constant=np.ones(20), number=number, height=rising).save("flat.vti")
    flat(rgb=np.arange(60, dtype=np.uint8).reshape(20, 3)).save("colors.vti")
    cells = flat()
    cells.cell_data["region"], cells.cell_data["temperature"] = np.arange(12), np.arange(12.0)
    cells.save("cells.vti")
    for words, told in (
        ("flow.vti --array r", "slices of r through the middle"),
        ("flat.vti", "relief of height (relief: sheet)"),
        ("flat.vti --for value", "height in colours (none: sheet)"),
        ("colors.vti", "rgb in colours (none: sheet)"),
        ("cells.vti --array temperature", "temperature in colours (none: sheet)"),
        (
            "flow.vti --contour r",
            "length of V in colours, with strokes along it (direction: surface)",
        ),
        ("flat.vti --warp height", "heights are taken 0.1 times"),
        ("bare.vti", "plane (none: sheet)"),
    ):
        code, out, _ = run("light", words, "-o", "a.vtk")
        assert code == 0
        assert told in out
    done("light flat.vti --warp height --exaggeration 2 -o a.vtp")
    assert pv.read("a.vtp").bounds.z_max == 38


def test_values_over_a_surface_are_shown(done):
    nibabel = pytest.importorskip("nibabel")
    ball = pv.Sphere()
    ball.save("ball.ply")
    nibabel.freesurfer.write_morph_data("lh.curv", ball.points[:, 2])
    for more in ("", "--scalars lh.curv"):
        out = done("light ball.ply --overlay lh.curv -o a.vtp", more)
        assert "shown    lh.curv in colours (value: surface)" in out


def test_points_that_cannot_be_lit_are_told_and_no_error(volume, run, refused):
    grid = pv.read(volume)
    grid["V"][:3] = 0
    grid["luminance"] = np.arange(grid.n_points)
    grid.save("flow.vti")
    asked = "light flow.vti --no-surface --tangents V -o x.vti"
    assert "--name" in refused(asked)
    code, _, err = run(asked, "--name light")
    assert code == 0
    assert "vizlight: 3 of 1728 points could not be lit" in err
    np.testing.assert_array_equal(pv.read("x.vti")["luminance"], grid["luminance"])


@pytest.fixture
def ball(tmp_path):
    made = pv.Sphere()
    made["v"] = np.cross([0.2, 0, 1], made.points)
    made["height"] = made.points[:, 2]
    made.save("ball.vtp")
    return tmp_path


@pytest.mark.slow
@pytest.mark.opengl
@pytest.mark.parametrize("name", ["lit.vtp", "lit.png"])
def test_a_mesh_is_read_once_and_what_draws_is_loaded_for_a_picture(name, ball):
    # Of vectors a picture is drawn to see whether it can be read.
    words = ("light", "ball.vtp", "--array", "height", "-o", name, "--size", "60x40")
    reads, modules = counted(ball, *words)
    assert reads == 1
    assert ("vizlight.draw.component" in modules) == (name == "lit.png")
    assert "vizlight.pieces.run" not in modules


@pytest.mark.slow
def test_a_mesh_is_refined_and_the_script_does_the_same(ball, done):
    for more in ("", "--no-surface"):
        out = done("light ball.vtp -o fine.vtp --refine 1/255 --report", more)
        assert ("error between points" in out, "would do" in out) == (True, False)
        fine = pv.read("fine.vtp")
        assert fine.n_points > 842
        assert fine.field_data["luminance_error"][0] <= 1 / 255
    exec(done("light ball.vtp -o again.vtp --refine 1/255 --script"), {})
    assert pv.read("again.vtp").n_points == fine.n_points


def test_lines_are_lit_as_a_bundle(done):
    pv.Sphere(theta_resolution=12, phi_resolution=12).extract_all_edges().save("edges.vtp")
    out = done("light edges.vtp -o lit.vtp --no-surface --bundle --explain --occlusion sky")
    assert "transmittance: a share of each light" in out
    assert {"transmittance", "sky"} <= set(pv.read("lit.vtp").point_data)


@pytest.mark.slow
@pytest.mark.opengl
def test_legibility_is_printed_and_the_script_does_the_same(ball, capfd, done):
    asked = "light ball.vtp -o lit.vtp --tangents v --scalars height --legibility"
    out = done(asked)
    for text in ("value", "noise of the eye"):
        assert text in out
    exec(done(asked, "--script"), {})
    table = capfd.readouterr().out.strip()
    assert table.startswith("question")
    assert table in out


def test_a_folder_names_the_files_in_it_that_can_be_read(folder, refused):
    (folder / "parts").mkdir()
    for name in ("ball.stl", "scan.nii.gz", "notes.odt", *(f"step_{i}.vtu" for i in range(9))):
        (folder / "parts" / name).touch()
    err = refused("parts")
    assert "expected a file, got 'parts' (a folder); in it are 'parts/ball.stl'" in err
    assert "'parts/scan.nii.gz'" in err
    assert "3 more" in err
    assert "notes" not in err


def test_the_help_begins_with_what_is_used_most(run):
    code, out, _ = run("--help")
    assert code == 0
    assert out.startswith("Usage: vizlight FILE [OPTIONS]\n")
