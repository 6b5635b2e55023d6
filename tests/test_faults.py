"""Full disks, limits, kills, closed streams and drawing libraries that are broken."""

import contextlib
import os
import subprocess
import sys

import kill_writers
import numpy as np
import pytest
import pyvista as pv
from hostile import runner
from lamps import far

import vizlight
from vizlight import Light, Material, Scene, View, files

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Linux starts a child")


@pytest.fixture
def ball(tmp_path):
    path = tmp_path / "ball.vtp"
    pv.Sphere(theta_resolution=40, phi_resolution=40).save(path)
    return path


@contextlib.contextmanager
def small_disk(place, size):
    """Mount a file system of some bytes; without the right to do so skip the test."""
    place.mkdir(exist_ok=True)
    words = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(place)]
    try:
        done = subprocess.run(words, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        pytest.skip("there is no mount")
    if done.returncode:
        pytest.skip(f"a small disk cannot be mounted: {done.stderr.strip()}")
    try:
        yield place
    finally:
        subprocess.run(["umount", str(place)], check=True)


@pytest.mark.slow
def test_a_disk_that_is_too_small_leaves_the_old_file(ball, tmp_path):
    scene = Scene(lights=Light(direction=(0.3, 0.2, 1)), view=View(direction=(0, 0, 1)))
    lit = files.write_mesh(vizlight.illuminate(pv.read(ball), scene), tmp_path / "whole.vtp")
    size, outs = lit.stat().st_size, []
    with contextlib.ExitStack() as disks:
        for share in (0.9, 1.1, 1.3, 1.6, 10):
            disk = small_disk(tmp_path / str(share), int(share * size) // 4096 * 4096)
            outs.append(disks.enter_context(disk) / "lit.vtp")
            outs[-1].write_bytes(b"old")
        runs = runner.run([["light", str(ball), "-o", str(out)] for out in outs])
        for out, run in zip(outs, runs, strict=True):
            assert run.code in (0, 2)
            assert (out.read_bytes() == b"old") == (run.code == 2)
            assert run.code == 0 or run.err.count("\n") == 1
            assert [path.name for path in out.parent.iterdir()] == ["lit.vtp"]
            if not run.code:
                assert "luminance" in files.read(out).point_data
        assert {run.code for run in runs} == {0, 2}


@pytest.mark.slow
def test_kills_while_a_file_is_written(tmp_path):
    failed = []
    counts = kill_writers.run(4, 1, tmp_path, failed.append, ("vtp",))
    assert not failed
    assert counts["killed"] > 0


def command(*words, **how):
    environment = {**os.environ, "PYTHONPATH": str(runner.ROOT), "VIZLIGHT_FAST": "0"}
    environment |= how.pop("environment", {})
    line = [sys.executable, "-m", "vizlight", *map(str, words)]
    return subprocess.run(line, check=False, timeout=300, env=environment, **how)


BROKEN = {
    "no vendor": {"__EGL_VENDOR_LIBRARY_DIRS": "/none", "LIBGL_DRIVERS_PATH": "/none"},
    "no such window": {"VTK_DEFAULT_OPENGL_WINDOW": "vtkNoOpenGLRenderWindow"},
    "no such device": {"VTK_DEFAULT_EGL_DEVICE_INDEX": "99"},
    "no display": {"DISPLAY": ":77", "VTK_DEFAULT_OPENGL_WINDOW": "vtkXOpenGLRenderWindow"},
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.sampled(2)
@pytest.mark.parametrize("name", BROKEN)
def test_a_picture_is_drawn_or_refused_where_the_library_is_broken(name, ball, tmp_path):
    out = tmp_path / "lit.png"
    done = command(
        "light", ball, "-o", out, "--size", "80x60", environment=BROKEN[name], capture_output=True
    )
    assert done.returncode in (0, 1)
    assert out.is_file() == (done.returncode == 0)
    # VTK before 9.7 tells of a device that is not there and takes another.
    said = done.stderr.decode().splitlines()
    lines = [line for line in said if "Trying other devices" not in line]
    assert len(lines) == done.returncode
    assert all(line.startswith("vizlight: ") for line in lines)


@pytest.mark.filterwarnings("ignore:.*could not be lit")
@pytest.mark.parametrize("power", [-300, -200, -100, -30, 30, 100, 150, 300])
def test_light_at_every_scale_is_the_same_or_marked(power):
    t = np.linspace(0, 3, 20)
    points = np.stack([np.cos(t), np.sin(t), t], axis=1)
    scene = far((0.3, 0.2, 1), (0, 0, 1), Material(specular=0.4))
    line, ball = pv.lines_from_points(points), pv.Sphere(theta_resolution=9, phi_resolution=9)
    ball.clear_data()
    ball.points = np.asarray(ball.points, dtype=np.float64)
    for mesh in (line, ball):
        scaled = mesh.copy()
        scaled.points = np.asarray(mesh.points, dtype=np.float64) * 10.0**power
        expected = vizlight.illuminate(mesh, scene)["luminance"]
        lit = vizlight.illuminate(scaled, scene)
        marked = ~lit.point_data.get("luminance_valid", np.ones(lit.n_points, bool))
        assert mesh is ball or not marked.any()
        np.testing.assert_allclose(lit["luminance"][~marked], expected[~marked], atol=1e-6)
