"""Files are written whole or not at all, and can be read again."""

import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

import vizlight
from vizlight import files, pieces, writing
from vizlight.reading import formats


def volume():
    grid = pv.ImageData(dimensions=(8, 8, 8))
    grid["r"] = np.linalg.norm(grid.points - 3.5, axis=1)
    grid["V"] = np.ones((grid.n_points, 3))
    return grid


def test_a_full_disk_is_seen_before_writing(tmp_path, monkeypatch):
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage._replace(free=100))
    with pytest.raises(files.FileError, match="output: expected 0.* MB of free disk, got 0.0 MB"):
        files.write_mesh(pv.Sphere(), tmp_path / "a.vtp")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [".vtp", ".vtk", ".vtu"])
def test_surfaces_are_written_with_their_arrays(suffix, tmp_path):
    sphere = pv.Sphere()
    sphere["x"] = np.arange(sphere.n_points, dtype=float)
    path = files.write_mesh(sphere, tmp_path / f"s{suffix}")
    np.testing.assert_array_equal(pv.read(path)["x"], sphere["x"])
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_wrong_endings_and_folders(tmp_path):
    with pytest.raises(
        files.FileError,
        match=r"output: expected a name that ends in \.vti, \.vtk, \.stl for ImageData",
    ):
        files.write_mesh(volume(), tmp_path / "a.vtp")
    with pytest.raises(files.FileError, match=r"path: expected a name that ends in \.png, got"):
        writing.check_output(tmp_path / "a.gif", (".png",))
    with pytest.raises(
        files.FileError, match="path: expected a folder that exists, got .*; make it first"
    ):
        writing.check_output(tmp_path / "none" / "a.png", (".png",))
    (tmp_path / "d.png").mkdir()
    with pytest.raises(files.FileError, match="path: expected a file, got .*a folder"):
        writing.check_output(tmp_path / "d.png", (".png",))


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "a.vtp"
    path.write_text("old")

    def write(draft):
        Path(draft).write_text("half")
        raise OSError(28, "No space left on device")

    with pytest.raises(files.FileError, match="No space left on device"):
        writing.replace_file(path, write)
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.vtp"]


def test_a_writer_that_writes_nothing_is_an_error(tmp_path):
    with pytest.raises(files.FileError, match="output: expected a file that can be written"):
        writing.replace_file(tmp_path / "a.vtp", lambda draft: None)


@pytest.mark.parametrize("name", ["a<b", "a&b", 'a"b', "a\nb", "\x01"])
def test_names_that_xml_cannot_hold_are_refused(name, tmp_path):
    for data in ("point_data", "cell_data"):
        mesh = pv.Sphere()
        size = mesh.n_points if data == "point_data" else mesh.n_cells
        getattr(mesh, data)[name] = np.arange(float(size))
        with pytest.raises(files.FileError, match="output: expected array names without <"):
            files.write_mesh(mesh, tmp_path / "a.vtp")
        assert list(tmp_path.iterdir()) == []
        back = pv.read(files.write_mesh(mesh, tmp_path / "a.vtk"))
        assert name in getattr(back, data)
        (tmp_path / "a.vtk").unlink()


@pytest.mark.parametrize("name", ["T_{wall}", r"$\\alpha_{x}$", "{}"])
@pytest.mark.parametrize("data", ["point_data", "cell_data", "field_data"])
def test_names_at_which_the_writer_of_legacy_files_ends_are_refused(name, data, tmp_path):
    mesh = pv.ImageData(dimensions=(2, 2, 2))
    sizes = {"point_data": 8, "cell_data": 1, "field_data": 3}
    getattr(mesh, data)[name] = np.arange(float(sizes[data]))
    with pytest.raises(files.FileError, match="array names without braces .*such as .vtp"):
        files.write_mesh(mesh, tmp_path / "a.vtk")
    assert not [*tmp_path.iterdir()]
    again = files.read(files.write_mesh(mesh, tmp_path / "a.vti"))
    np.testing.assert_array_equal(getattr(again, data)[name], getattr(mesh, data)[name])


def test_the_mode_of_a_file_that_is_replaced_is_kept(tmp_path):
    path = files.write_mesh(pv.Sphere(), tmp_path / "a.vtp")
    path.chmod(0o640)
    files.write_mesh(pv.Cube(), path)
    assert path.stat().st_mode & 0o777 == 0o640
    assert pv.read(path).n_points == pv.Cube().n_points


def test_a_symbolic_link_stays_and_its_file_is_replaced(tmp_path):
    (tmp_path / "there").mkdir()
    path = files.write_mesh(pv.Sphere(), tmp_path / "there" / "a.vtp")
    link = tmp_path / "link.vtp"
    link.symlink_to(path)
    assert files.write_mesh(pv.Cube(), link) == link
    assert link.is_symlink()
    assert pv.read(path).n_points == pv.Cube().n_points
    assert [p.name for p in path.parent.iterdir()] == ["a.vtp"]


@pytest.mark.sampled(3)
@pytest.mark.skipif(not hasattr(os, "posix_fallocate"), reason="space cannot be reserved")
@pytest.mark.parametrize("suffix", [".vtp", ".vtk", ".vtu"])
def test_the_limit_of_file_sizes_is_seen_before_writing(suffix, tmp_path):
    code = f"""
import resource, pyvista as pv
from vizlight import _supervise, _trials, files, pieces
resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))
try:
    files.write_mesh(pv.Sphere(), {str(tmp_path / "a")!r} + {suffix!r})
except files.FileError as error:
    print(error)
"""
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "output: expected" in run.stdout
    assert "File too large" in run.stdout
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [".vtp", ".vtu"])
def test_a_draft_that_is_not_whole_does_not_replace_the_output(suffix, tmp_path, monkeypatch):
    path = files.write_mesh(pv.Sphere(), tmp_path / f"a{suffix}")
    old = path.read_bytes()
    kind = type(pv.read(path))
    save = kind.save

    def cut(mesh, to, **options):
        save(mesh, to, **options)
        os.truncate(to, Path(to).stat().st_size // 2)

    monkeypatch.setattr(kind, "save", cut)
    with pytest.raises(files.FileError, match="output: expected a file that can be written"):
        files.write_mesh(pv.Cube(), path)
    assert path.read_bytes() == old


@pytest.mark.parametrize("suffix", [".vtu", ".vtk"])
def test_a_grid_without_cells_is_written(suffix, tmp_path):
    made = vtkUnstructuredGrid()
    made.SetPoints(pv.vtk_points(np.eye(3)))
    for mesh in (pv.PolyData(), pv.PolyData().cast_to_unstructured_grid(), pv.wrap(made)):
        path = files.write_mesh(mesh, tmp_path / f"a{suffix}")
        assert pv.read(path).n_points == mesh.n_points


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
def test_pipes_are_refused_at_once(tmp_path):
    pipe = tmp_path / "a.vtp"
    os.mkfifo(pipe)
    ball = tmp_path / "ball.vtp"
    pv.Cube().save(ball)
    for name, words in (("file", (pipe,)), ("overlay", (ball, pipe))):
        with pytest.raises(files.FileError, match=f"{name}: expected a file, .*pipe or device"):
            files.read(words[0], overlay=words[1:])
    with pytest.raises(pieces.PieceError, match="sources: expected a file, .*pipe or device"):
        pieces.light(pipe, vizlight.Scene(), out=tmp_path / "lit.pvtp")
    with pytest.raises(files.FileError, match="output: expected a file, .*pipe or device"):
        files.write_mesh(pv.Cube(), pipe)
    assert pipe.is_fifo()


@pytest.mark.skipif(sys.platform == "win32", reason="a folder in use stays")
def test_a_working_folder_that_is_gone_is_seen_early(tmp_path, monkeypatch):
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    with pytest.raises(files.FileError, match=r"out: expected a folder .*working folder .* gone"):
        writing.check_output("lit.vtp", (".vtp",), name="out")
    assert writing.check_output(tmp_path / "lit.vtp", (".vtp",)) == tmp_path / "lit.vtp"
    with pytest.raises(files.FileError, match="file: expected a file, got 'a.vtp'"):
        files.read("a.vtp")


@pytest.mark.skipif(sys.platform == "win32", reason="no locks of folders")
def test_what_a_killed_writer_left_is_swept_by_the_next(tmp_path):
    names = (
        f"{writing.DRAFTS}dead",
        f"{writing.FRESH}young",
        f"{writing.DRAFTS}busy",
        f"{writing.FRESH}old",
    )
    left = [tmp_path / name for name in names]
    for folder in left:
        folder.mkdir()
        (folder / "a.vtp").write_text("part")
    for folder in left[2:]:
        os.utime(folder, (0, 0))
    with writing._locked(left[2]):
        files.write_mesh(pv.Cube(), tmp_path / "b.vtp")
    names = {"b.vtp", left[1].name, left[2].name}
    assert {path.name for path in tmp_path.iterdir()} == names


def test_blocks_are_written_whole_or_not_at_all(tmp_path, monkeypatch):
    ball = pv.Sphere()
    ball["label"] = np.array(["text"] * ball.n_points)
    inner = pv.MultiBlock({"plane": pv.Plane(), "none": None})
    both = pv.MultiBlock({"ball": ball, "more": inner})
    path = files.write_mesh(both, tmp_path / "a.vtm")
    again = pv.read(path)
    assert (again.keys(), again["more"].keys()) == (["ball", "more"], ["plane", "none"])
    np.testing.assert_array_equal(again["ball"]["label"], ball["label"])
    assert again["more"]["none"] is None
    before = {file: file.read_bytes() for file in tmp_path.rglob("*.vt?")}
    inner["plane"]["a<b"] = np.zeros(inner["plane"].n_points)
    with pytest.raises(files.FileError, match="array names without <"):
        files.write_mesh(both, path)
    inner["plane"].clear_data()
    monkeypatch.setattr(formats, "missing_part", lambda path: "its end" * (path.suffix == ".vtp"))
    for name in ("a.vtm", "b.vtm"):
        with pytest.raises(files.FileError, match="got its end"):
            files.write_mesh(both, tmp_path / name)
    assert {file: file.read_bytes() for file in tmp_path.rglob("*.vt?")} == before
    assert {file.name for file in tmp_path.iterdir()} == {"a.vtm", "a"}
    with pytest.raises(files.FileError, match=r"a name that ends in \.vtm for MultiBlock"):
        files.write_mesh(both, tmp_path / "a.vtp")


def test_a_relief_becomes_a_closed_solid_for_a_printer(tmp_path):
    relief = vizlight.bas_relief(pv.Sphere(), resolution=40)
    files.write_mesh(relief, tmp_path / "a.stl")
    solid = pv.read(tmp_path / "a.stl").clean()
    assert solid.is_manifold
    thickness = writing.BASE * max(relief.bounds_size)
    area = relief.bounds_size[0] * relief.bounds_size[1]
    dome = relief["height"].mean() * area
    assert solid.volume == pytest.approx(thickness * area + dome, rel=0.05)
    with pytest.raises(files.FileError, match="expected an image of one layer with an active"):
        files.write_mesh(pv.ImageData(dimensions=(3, 3, 3)), tmp_path / "b.stl")


def test_fine_ground_far_from_the_origin_is_moved_in_stl(tmp_path):
    ground = pv.ImageData(
        dimensions=(8, 6, 1), spacing=(0.25, 0.25, 1), origin=(501234, 5312345, 0)
    )
    ground["z"] = np.random.default_rng(0).random(48)
    with pytest.warns(UserWarning, match="moved by .* float32 numbers of .stl do not resolve"):
        files.write_mesh(ground, tmp_path / "a.stl")
    solid = pv.read(tmp_path / "a.stl")
    assert len(np.unique(np.asarray(solid.points)[:, 1])) == 6


def test_fine_rows_far_away_stay_apart_in_stl(tmp_path):
    x, y = np.meshgrid(np.arange(40.0) + 4e5, 0.05 * np.arange(60) + 5e5)
    ground = pv.StructuredGrid(x, y, np.sin(x)).extract_surface(algorithm="dataset_surface")
    field = pv.ImageData(dimensions=(40, 60, 1), spacing=(1, 0.05, 1), origin=(4e5, 5e5, 0))
    field["height"] = np.sin(x).ravel()
    for mesh in (ground, field):
        with pytest.warns(UserWarning, match="do not resolve its points where it is"):
            files.write_mesh(mesh, tmp_path / "a.stl")
        again = vizlight.read(tmp_path / "a.stl")
        assert len(np.unique(np.asarray(again.points)[:, 1])) == 60


def test_many_writers_of_one_file(tmp_path):
    """A writer that sweeps may remove the empty folder of one that has just ended."""
    mesh, path = pv.Plane(i_resolution=2, j_resolution=2), tmp_path / "a.vtp"
    with ThreadPoolExecutor(8) as pool:
        assert {*pool.map(lambda _: files.write_mesh(mesh, path), range(40))} == {path}
    assert [one.name for one in tmp_path.iterdir()] == ["a.vtp"]
    assert pv.read(path).n_points == 9
