"""A turning torus as pictures and as movies: one camera, whole files, clear words."""

import importlib
import sys
import types

import numpy as np
import pytest
import pyvista as pv
from lamps import far
from PIL import Image

import vizlight
from vizlight import Material, Scene, View, movie, project, render
from vizlight.files import FileError
from vizlight.geometry import manifolds, projection

SCENE = far(
    (0.7, 0.6, 0.38, 0.2), (0, -1, 0.5, 0.3), Material(ambient=0.1, diffuse=0.6, specular=0.3)
)
SMALL = {"size": (80, 60), "anti_aliasing": None}
CAMERA = render.camera_on((-3, 3, -3, 3, -1, 1))


@pytest.fixture
def torus():
    return vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=24))


@pytest.fixture
def turned(torus, tmp_path):
    """Return what writes pictures of the torus that turns and returns their files."""

    def call(name="t.png", **options):
        return movie.turn(torus, tmp_path / name, **{"scene": SCENE, "picture": SMALL, **options})

    return call


def drawn(mesh, **options):
    return next(render.pictures([mesh], camera=CAMERA, **SMALL, **options))


def lit(mesh, angle, **options):
    return project(mesh, rotation=("xw", angle), scene=SCENE, **options)


@pytest.mark.opengl
def test_a_sequence(turned, tmp_path):
    files = turned(distance=3.0, frames=4)
    assert [file.name for file in files] == [f"t_{i:04d}.png" for i in range(4)]
    assert sorted(tmp_path.iterdir()) == files
    pictures = [np.asarray(Image.open(file)) for file in files]
    assert all(picture.shape == (60, 80, 3) for picture in pictures)
    # All of it is in the picture at every step, and it does not fill a corner only.
    for picture in pictures:
        ink = np.any(picture != 255, axis=2)
        assert not ink[[0, -1]].any()
        assert not ink[:, [0, -1]].any()
        assert ink.mean() > 0.05
    again = turned("u.png", distance=3.0, frames=4)
    for one, other in zip(files, again, strict=True):
        assert one.read_bytes() == other.read_bytes()


@pytest.mark.opengl
def test_the_camera_stays(torus, turned):
    files = turned(camera=CAMERA, distance=3.0, frames=3, angle=1.5)
    for i, file in enumerate(files):
        expected = drawn(lit(torus, 0.5 * i, distance=3.0))
        np.testing.assert_array_equal(np.asarray(Image.open(file)), expected)


@pytest.mark.opengl
def test_a_turn_keeps_the_colour_of_the_material(turned):
    scene = SCENE.replace(material=Material(ambient=0.3, color="red"))
    (file,) = turned(scene=scene, distance=3.0, frames=1)
    seen = np.asarray(Image.open(file)).astype(int)
    assert (seen[..., 0] - seen[..., 1]).max() > 60


@pytest.mark.opengl
def test_rotation_comes_before_the_turn(torus, turned):
    first = projection.rotation(4, [("yz", 0.4), ("xw", 0.3)])
    seen = drawn(project(torus, rotation=[first, ("zw", 0.5)], scene=SCENE))
    options = {"frames": 2, "angle": 1.0, "plane": "zw", "camera": CAMERA}
    for rotation in (first, first.tolist(), [("yz", 0.4), ("xw", 0.3)]):
        _, file = turned(rotation=rotation, **options)
        difference = np.asarray(Image.open(file), int) - seen
        assert np.abs(difference).max() <= 1


@pytest.mark.opengl
def test_without_a_scene_the_active_scalars_are_drawn(torus, turned):
    torus["temp"] = 300 + 50 * np.asarray(torus["position"])[:, 0]
    torus.cell_data["number"] = np.full(torus.n_cells, 7)

    def first(**picture):
        (file,) = turned(scene=None, frames=1, camera=CAMERA, picture=SMALL | picture)
        return np.asarray(Image.open(file))

    torus.set_active_scalars("temp")
    found = first()
    expected = drawn(torus, scalars="temp", clim=(300 - 75, 300 + 75))
    np.testing.assert_array_equal(found, expected)
    assert len(np.unique(found)) > 20
    np.testing.assert_array_equal(first(scalars="temp"), expected)
    assert np.any(first(clim=(0, 1)) != expected)
    torus.set_active_scalars("number", preference="cell")
    assert len(np.unique(first())) < 20


@pytest.mark.opengl
def test_a_shorter_sequence_leaves_nothing_of_a_longer_one(turned, tmp_path):
    kept = {"t_0004.png", "t_12.png", "u_0002.png"}
    for name in kept:
        (tmp_path / name).write_bytes(b"mine")
    for frames in (3, 2):
        assert len(turned(frames=frames, camera=CAMERA)) == frames
    assert {p.name for p in tmp_path.iterdir()} == {"t_0000.png", "t_0001.png", *kept}


@pytest.mark.opengl
def test_points_behind_the_eye_are_told_of_once(turned, tmp_path):
    with pytest.warns(UserWarning, match="in 2 of 2 frames: .* points cannot be projected") as said:
        turned(frames=2, distance=0.7, cut=True)
    assert len(said) == 1
    with pytest.raises(ValueError, match="points before the eye's hyperplane"):
        turned("u.png", frames=2, distance=0.7)
    assert not list(tmp_path.glob("u*"))


class Writer:
    """Stands for imageio's writer: keeps what it is told, writes at the end."""

    def __init__(self, path, **options):
        self.path, self.options, self.pictures = path, options, []

    def __enter__(self):
        return self

    def __exit__(self, *error):
        with open(self.path, "wb") as file:  # noqa: PTH123 - as a library would
            file.write(b"movie")

    def append_data(self, picture):
        self.pictures.append(picture)


@pytest.fixture
def writers(monkeypatch):
    made = []

    def get_writer(path, **options):
        made.append(Writer(path, **options))
        return made[-1]

    package, v2 = types.ModuleType("imageio"), types.ModuleType("imageio.v2")
    v2.get_writer, package.v2 = get_writer, v2
    for name, module in (("imageio", package), ("imageio.v2", v2), ("imageio_ffmpeg", package)):
        monkeypatch.setitem(sys.modules, name, module)
    return made


@pytest.mark.opengl
@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("t.gif", {"mode": "I", "duration": 50.0, "loop": 0}),
        ("t.mp4", {"mode": "I", "fps": 20.0, "macro_block_size": 2, "ffmpeg_log_level": "error"}),
    ],
)
def test_what_a_movie_writer_is_told(turned, tmp_path, writers, name, options):
    files = turned(name, frames=3, fps=20)
    assert files == [tmp_path / name]
    assert files[0].read_bytes() == b"movie"
    assert writers[0].options == options
    assert [p.shape for p in writers[0].pictures] == [(60, 80, 3)] * 3


@pytest.mark.opengl
def test_a_movie_that_fails_leaves_no_file(turned, tmp_path, writers):
    with pytest.raises(ValueError, match="points before the eye's hyperplane"):
        turned("t.gif", frames=3, distance=0.7, camera=CAMERA)
    assert not list(tmp_path.iterdir())


@pytest.mark.opengl
# imageio leaves the pipes to ffmpeg to the garbage collector.
@pytest.mark.filterwarnings("ignore::ResourceWarning")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize(("name", "package"), [("t.gif", "imageio"), ("t.mp4", "imageio_ffmpeg")])
def test_a_real_movie(turned, name, package):
    """Runs where the extra is installed."""
    pytest.importorskip(package)
    (file,) = turned(name, frames=4, distance=3.0)
    frames = importlib.import_module("imageio.v2").mimread(file)
    assert len(frames) == 4
    assert frames[0].shape[:2] == (60, 80)


@pytest.mark.parametrize(
    ("name", "missing", "words"),
    [
        ("t.gif", "imageio", "imageio is not installed; pip install 'vizlight.movie.'"),
        ("t.mp4", "imageio_ffmpeg", "imageio_ffmpeg is not installed"),
    ],
)
def test_a_missing_package_is_named_before_anything_is_drawn(
    turned, tmp_path, monkeypatch, writers, name, missing, words
):
    monkeypatch.setitem(sys.modules, missing, None)
    with pytest.raises(movie.MovieError, match=words):
        turned(name)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("name", "options", "error", "words"),
    [
        ("t.avi", {}, FileError, "path: expected a name that ends in .png, .gif, .mp4"),
        ("none/t.png", {}, FileError, "path: expected a folder that exists"),
        ("t.png", {"frames": 0}, ValueError, "frames: expected an integer of at least 1"),
        ("t.png", {"fps": 0}, ValueError, "fps: expected a number from 0.01 to 100"),
        ("t.png", {"angle": np.nan}, ValueError, "angle: expected a finite number"),
        ("t.png", {"plane": "xx"}, ValueError, "plane: expected two different axes"),
        ("t.png", {"picture": {"size": (0, 5)}}, ValueError, "size: expected an integer"),
        ("t.png", {"picture": {"camera": 1}}, ValueError, "picture: expected no camera"),
        ("t.png", {"picture": "abc"}, TypeError, "picture: expected a mapping, got 'abc'"),
        ("t.png", {"picture": {"foo": 1}}, ValueError, "picture: expected options of a picture"),
        ("t.png", {"rotate": 1}, TypeError, "rotate: expected an option of project, got"),
        ("t.png", {"scene": None}, ValueError, "scene: expected a scene, or a mesh with active"),
        ("t.mp4", {"picture": {"size": (81, 60)}}, ValueError, "size: expected an even width"),
    ],
)
def test_bad_arguments(turned, tmp_path, writers, name, options, error, words):
    with pytest.raises(error, match=words):
        turned(name, **options)
    assert not list(tmp_path.iterdir())


def test_frames_of_pathlines_become_pictures(tmp_path):
    times, scene = np.linspace(0, 1, 4), Scene(view=View(direction=(0, 0, 1)))
    steps = []
    for time in times:
        mesh = pv.ImageData(dimensions=(5, 5, 5))
        mesh["V"] = np.tile([1.0, np.cos(time), 0.0], (mesh.n_points, 1))
        steps.append(mesh)
    frames = list(vizlight.pathlines(steps, scene, times=times, tangents="V", seeds=9))
    files = movie.save(iter(frames), tmp_path / "flow.png", picture={"size": (64, 48)})
    assert [file.name for file in files] == [f"flow_000{i}.png" for i in range(3)]
    ink = [np.asarray(pv.read(file).active_scalars, dtype=float).sum() for file in files]
    assert 0 < ink[0] < ink[1] < ink[2]
    with pytest.raises(ValueError, match="frames: expected"):
        movie.save([], tmp_path / "none.png")


def test_pictures_are_written_as_they_come(tmp_path, writers):
    rng = np.random.default_rng(3)
    given = rng.integers(0, 256, (3, 20, 30, 3), dtype=np.uint8)
    files = movie.save(iter(given), tmp_path / "a.png")
    np.testing.assert_array_equal([np.asarray(Image.open(file)) for file in files], given)
    assert movie.save(given, tmp_path / "a.gif", progress_bar=True) == [tmp_path / "a.gif"]
    np.testing.assert_array_equal(writers[0].pictures, given)

    def broken():
        yield given[0]
        raise OSError("gone")

    with pytest.raises(FileError, match="output: "):
        movie.save(broken(), tmp_path / "b.gif")
    for frames, options, message in (
        ([given[0], given[1, :9]], {}, r"pictures of one shape, \(20, 30, 3\)"),
        ([given[0], pv.Sphere()], {}, "frames: expected pictures, each an array of uint8"),
        (given[0], {}, "frames: expected pictures, each an array of uint8"),
        ([given[0] / 255], {}, "frames: expected pictures, each an array of uint8"),
        ([given[0, :, :0]], {}, "frames: expected pictures, each an array of uint8"),
        ([given[0, :9]], {"path": "b.mp4"}, "size: expected an even width and height"),
        (
            [given[0]],
            {"camera": pv.Camera()},
            "camera: expected none beside frames that are pictures",
        ),
        ([given[0]], {"picture": SMALL}, "picture: expected none beside frames that are pictures"),
    ):
        path = tmp_path / options.pop("path", "b.gif")
        with pytest.raises(ValueError, match=message):
            movie.save(frames, path, **options)
    assert {path.stem for path in tmp_path.iterdir()} == {"a", "a_0000", "a_0001", "a_0002"}


@pytest.mark.opengl
def test_strokes_travel_and_the_movie_can_be_repeated(tmp_path):
    """A stroke of a uniform flow is farther by speed times time, to a pixel."""
    sheet = pv.Plane(i_size=4, j_size=1, i_resolution=40, j_resolution=10)
    sheet["V"] = np.tile([2.0, 0, 0], (sheet.n_points, 1))
    scene = Scene(lights=[], material=Material(ambient=1, diffuse=0, specular=0))
    lines = vizlight.streamlines(
        sheet, scene, tangents="V", seeds=[(-2, 0, 0)], step=0.1, stroke_length=0.8, travel=1.0
    )
    assert lines.field_data["period"][0] == pytest.approx(0.4)
    plotter = render.canvas((200, 50), background="white")
    plotter.vizlight.add_mesh(lines, scene=scene, color="black", width="width", line_width=8)
    plotter.camera = render.camera_on(sheet, (0, 0, 1), parallel=True, aspect=4.0)
    scale = 25 / plotter.camera.parallel_scale
    files = movie.travel(plotter, tmp_path / "t.png", frames=16)
    assert len(files) == 16
    ink = 255.0 - np.array([np.asarray(Image.open(file))[..., 0] for file in files]).mean(axis=1)
    # Heads are where the width of a stroke falls; each is found again 4 frames later.
    heads = [np.flatnonzero((row[:-1] > 20) & (row[1:] <= 20)) for row in ink]
    moved = 4 * 0.8 * scale / 16
    for now, later in zip(heads, heads[4:], strict=False):
        inner = now[(now > 40) & (now < 150)]
        assert len(inner) >= 2
        assert all(np.abs(later - place - moved).min() <= 1 for place in inner)
    plotter = render.canvas((40, 40))
    plotter.vizlight.add_mesh(pv.Sphere(), scene=scene)
    with pytest.raises(ValueError, match="plotter: expected a plotter that shows streamlines"):
        movie.travel(plotter, tmp_path / "t.png")
