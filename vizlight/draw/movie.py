"""Movies and PNG sequences: of lit meshes, of a turn about a scene, of a turn in n-space."""

from __future__ import annotations

import contextlib
import importlib
import itertools
import os
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sized
from pathlib import Path
from typing import TypeVar

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from PIL import Image

from vizlight import _check
from vizlight._progress import progress
from vizlight._types import Foreign, Given, Raw
from vizlight.draw import render
from vizlight.draw.cameras import Mesh, common_bounds
from vizlight.filters.project import project
from vizlight.filters.tint import RGB
from vizlight.mesh import strokes
from vizlight.mesh.blocks import all_blocks
from vizlight.scene import Scene
from vizlight.scene.presets import AnyScene, optional_scene
from vizlight.shading.results import DEFAULT_NAME
from vizlight.writing import check_output, replace_file

Picture = NDArray[np.uint8]

Item = TypeVar("Item")

__all__ = ["MovieError", "orbit", "save", "travel", "turn"]

FORMATS = (".png", ".gif", ".mp4")
TURN = 2 * np.pi
#: Options of :func:`vizlight.project` that determine the positions of the projected points.
PLACING = ("positions", "frame", "distance", "hyperplane", "cut")


class MovieError(RuntimeError):
    """The package that writes movies is not installed; the message says how to install it."""


def save(
    frames: Iterable[Mesh | render.Panel | Picture],
    path: str | Path,
    /,
    *,
    fps: float = 24.0,
    camera: pv.Camera | None = None,
    picture: render.PlotterKeywords | None = None,
    progress_bar: bool = False,
) -> list[Path]:
    """Save a picture of each lit mesh, such as :func:`vizlight.pathlines` yields, as a movie.

    Parameters
    ----------
    frames : iterable of meshes or Panels, or of pictures
        Meshes to draw, one after the other; or pictures, arrays of uint8 of one shape (height,
        width, 3), such as :func:`vizlight.draw.render.pictures` makes. They are written as they
        come.
    path : path
        Path of a movie or of a sequence of PNGs, as for :func:`turn`.
    fps : float, default: 24.0
        Frames per second of a movie, up to 100.
    camera : pyvista.Camera, optional
        Camera of all frames. Default: one that shows them all; the frames are then kept in memory
        until the last has come. Pictures have theirs.
    picture : mapping, optional
        Further options of :func:`vizlight.draw.render.make_plotter`, for meshes.
    progress_bar : bool, default: False
        Show progress on standard error.

    Returns
    -------
    list of pathlib.Path
        Paths of the files written.

    Raises
    ------
    MovieError, BackendError, TypeError, ValueError
        As for :func:`turn`; also without any frame.
    """
    path = _check_movie(path)
    _check.iterable("frames", frames, "an iterable of meshes or Panels, or of pictures")
    drawing = _drawing(picture)
    fps = _check.number("fps", fps, low=0.01, high=100.0)
    # A missing package or a size that does not fit raises an error before anything is drawn.
    writer = _writer(path, fps, drawing["size"])
    count = len(frames) if isinstance(frames, Sized) else 0
    rest: Iterator[Foreign] = iter(frames)
    first = next(rest, None)
    if first is None:
        raise _check.value_error("frames", "one mesh, Panel or picture or more", "none")
    rest = itertools.chain([first], rest)
    if isinstance(first, np.ndarray):
        for name, value in (("camera", camera), ("picture", picture)):
            if value is not None:
                raise _check.value_error(name, "none beside frames that are pictures", "one")
        _check_picture(first, first.shape)
        writer = _writer(path, fps, first.shape[1::-1])
        drawn: Iterator[Picture] = (_check_picture(each, first.shape) for each in rest)
    else:
        rest = map(_check_mesh, rest)
        if camera is None:
            meshes = list(rest)
            count, rest = len(meshes), iter(meshes)
            bare = [mesh.mesh if isinstance(mesh, render.Panel) else mesh for mesh in meshes]
            camera = render.camera_on(common_bounds("frames", bare))
        drawing["camera"] = camera
        drawn = render.pictures(rest, **drawing)
    with progress("draw", count, show=progress_bar) as report:
        return writer(_counted(drawn, report, 0))


def turn(
    mesh: Mesh,
    path: str | Path,
    /,
    *,
    scene: AnyScene | None = None,
    plane: str | tuple[int, int] = "xw",
    frames: int = 72,
    angle: float = TURN,
    fps: float = 24.0,
    camera: pv.Camera | None = None,
    picture: render.PlotterKeywords | None = None,
    progress_bar: bool = False,
    **options: Given,
) -> list[Path]:
    """Rotate a mesh in a plane of n-space, light it at every step, and save the pictures.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh with positions and a frame in n-space, as for :func:`vizlight.project`. It is not
        changed.
    path : path
        Path of a movie, ``.gif`` or ``.mp4``, or of a sequence: ``turn.png`` stands for
        ``turn_0000.png``, ``turn_0001.png`` and so on. The folder must exist. An earlier
        sequence of the same name is overwritten; its frames beyond the last new one are removed.
    scene : Scene, optional
        Scene that lights the mesh, fixed while the mesh rotates. Without a scene the mesh's
        active scalars are drawn: luminance from 0 to 1, other scalars from their minimum to
        their maximum.
    plane : str or (int, int), default: "xw"
        Plane of the rotation, as for :func:`vizlight.geometry.nspace.projection.plane_rotation`.
    frames : int, default: 72
        Number of frames. Frame i is at ``i / frames`` of the angle.
    angle : float, default: 2 pi
        Angle of the whole rotation in radians.
    fps : float, default: 24.0
        Frames per second of a movie, up to 100.
    camera : pyvista.Camera, optional
        Camera of all frames. Default: one that shows the whole mesh at every step.
    picture : mapping, optional
        Further options of :func:`vizlight.draw.render.make_plotter`: size, scalars, cmap, clim,
        background.
    progress_bar : bool, default: False
        Show progress on standard error.
    **options
        Options of :func:`vizlight.project`: those of the projection, such as ``rotation`` before
        the turn, ``distance`` and ``frame``, and those of the light.

    Returns
    -------
    list of pathlib.Path
        Paths of the files written.

    Raises
    ------
    MovieError
        If the path names a movie and imageio is not installed. Raised before anything is
        drawn.
    BackendError
        If no OpenGL library can draw here.
    TypeError, ValueError
        If an argument does not fit, or a file cannot be written. No partial file is left: the
        complete pictures of a sequence remain, but no part of a movie.

    Warns
    -----
    UserWarning
        Once, with the number of frames affected, if :func:`vizlight.project` warns.
    """
    path = _check_movie(path)
    count = _check.integer("frames", frames, low=1)
    whole = _check.number("angle", angle)
    fps = _check.number("fps", fps, low=0.01, high=100.0)
    drawing = _drawing(picture)
    scene = optional_scene(scene)
    if scene is not None:
        drawing.setdefault("scalars", RGB if scene.colored else options.get("name", DEFAULT_NAME))
    else:
        _draw_active(mesh, drawing)
    writer = _writer(path, fps, drawing["size"])
    before = options.pop("rotation", None)
    notes: list[str] = []

    def steps(settings: Mapping[str, Given], scene: Scene | None) -> Iterator[Mesh]:
        for i in range(count):
            # The last frame is a step short of the whole turn, so that a loop does not show it
            # twice.
            turned = (plane, whole * i / count)
            rotation = turned if before is None else [before, turned]
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                step = project(mesh, scene=scene, rotation=rotation, **settings)
            # At most one of each frame, as the frames are counted by them.
            notes.extend(str(warning.message) for warning in caught[:1])
            yield step

    with progress("turn", 2 * count if camera is None else count, show=progress_bar) as report:
        done = 0
        if camera is None:
            # The light does not affect the positions, so the camera is found without it.
            placing = {name: value for name, value in options.items() if name in PLACING}
            unlit = _counted(steps(placing, None), report, done)
            bounds = _check.coordinates("mesh", common_bounds("mesh", unlit))
            camera = render.camera_on(bounds)
            done = count
            # The same steps come once more with their light, and would be counted twice.
            notes.clear()
        drawing["camera"] = camera
        files = writer(_counted(render.pictures(steps(options, scene), **drawing), report, done))
    if notes:
        _check.warn(f"in {len(notes)} of {count} frames: {notes[0]}")
    return files


def orbit(
    plotter: pv.Plotter,
    path: str | Path,
    /,
    *,
    frames: int = 72,
    fps: float = 24.0,
    progress_bar: bool = False,
) -> list[Path]:
    """Save the picture of a plotter, seen once all around, and close the plotter.

    The camera moves about its direction up, through its focal point.

    Parameters
    ----------
    plotter : pyvista.Plotter
        Plotter that draws offscreen, with its camera set.
    path : path
        Path of a movie or of a sequence of PNGs, as for :func:`turn`.
    frames : int, default: 72
        Number of frames of the whole turn.
    fps : float, default: 24.0
        Frames per second of a movie, up to 100.
    progress_bar : bool, default: False
        Show progress on standard error.

    Returns
    -------
    list of pathlib.Path
        Paths of the files written.

    Raises
    ------
    MovieError
        If the path names a movie and imageio is not installed.
    TypeError, ValueError
        If an argument does not fit, or a file cannot be written. No partial file is left.
    """

    def frame(i: int, count: int) -> None:
        if i:
            plotter.camera.Azimuth(360.0 / count)
        plotter.reset_camera_clipping_range()
        # A screenshot alone returns the frame before.
        plotter.render()

    return _filmed(plotter, path, frames, fps, "turn", frame, progress_bar=progress_bar)


def travel(
    plotter: pv.Plotter,
    path: str | Path,
    /,
    *,
    frames: int = 72,
    fps: float = 24.0,
    progress_bar: bool = False,
) -> list[Path]:
    """Save the picture of a plotter while strokes move along streamlines, and close the plotter.

    The movie shows one period of the strokes, of which frame i is at ``i / frames``, so that it can
    be repeated. From frame to frame a stroke moves as far as the vectors carry it: to the length of
    a segment of its line in a uniform flow, to 0.004 radians in a solid rotation.

    Parameters
    ----------
    plotter : pyvista.Plotter
        Plotter that draws offscreen, to which ``plotter.vizlight.add_mesh(lines, width="width")``
        added lines of ``vizlight.streamlines(..., stroke_length=, travel=)``.
    path : path
        Path of a movie or of a sequence of PNGs, as for :func:`turn`.
    frames : int, default: 72
        Number of frames of the period.
    fps : float, default: 24.0
        Frames per second of a movie, up to 100.
    progress_bar : bool, default: False
        Show progress on standard error.

    Returns
    -------
    list of pathlib.Path
        Paths of the files written.

    Raises
    ------
    MovieError
        If the path names a movie and imageio is not installed.
    TypeError, ValueError
        If an argument does not fit, the plotter has no strokes that move, or a file cannot be
        written. No partial file is left.
    """
    _check.instance("plotter", plotter, pv.BasePlotter, "a pyvista.Plotter")
    component: Foreign = plotter.vizlight
    moving: list[pv.PolyData] = component.moving()
    if not moving:
        plotter.close()
        expected = "a plotter that shows streamlines with travel= and width='width'"
        raise _check.value_error("plotter", expected, "none of them")
    plotter.reset_camera_clipping_range()

    def frame(i: int, count: int) -> None:
        for lines in moving:
            lines.point_data[strokes.WIDTH] = strokes.moved_widths(lines, i / count)
        plotter.render()

    return _filmed(plotter, path, frames, fps, "travel", frame, progress_bar=progress_bar)


def _filmed(
    plotter: pv.Plotter,
    path: str | Path,
    frames: object,
    fps: object,
    name: str,
    frame: Callable[[int, int], None],
    *,
    progress_bar: bool,
) -> list[Path]:
    """Save the pictures of a plotter that a function sets to a frame of some, and close it."""
    _check.instance("plotter", plotter, pv.BasePlotter, "a pyvista.Plotter")
    path = _check_movie(path)
    count = _check.integer("frames", frames, low=1)
    fps = _check.number("fps", fps, low=0.01, high=100.0)

    def pictures() -> Iterator[Picture]:
        for i in range(count):
            frame(i, count)
            yield np.array(plotter.screenshot(return_img=True))

    with contextlib.closing(plotter):
        writer = _writer(path, fps, plotter.window_size)
        with progress(name, count, show=progress_bar) as report:
            return writer(_counted(pictures(), report, 0))


def _check_movie(path: str | Path) -> Path:
    """Return the path of a movie or of a sequence that can be written."""
    _check.instance("path", path, str | os.PathLike, "the path of a file")
    return check_output(Path(path), FORMATS)


def _check_picture(picture: object, shape: tuple[int, ...]) -> Picture:
    """Return a picture of a movie, checked to have the shape of all its pictures."""
    rgb = picture if isinstance(picture, np.ndarray) else None
    if rgb is None or rgb.dtype != np.uint8 or rgb.ndim != 3 or rgb.shape[2] != 3 or not rgb.size:
        expected = "pictures, each an array of uint8 of shape (height, width, 3)"
        raise _check.value_error("frames", expected, _check.describe(picture))
    if rgb.shape != shape:
        expected = f"pictures of one shape, {shape} as the first"
        raise _check.value_error("frames", expected, rgb.shape)
    return rgb


def _check_mesh(frame: object) -> object:
    """Return a frame that is a mesh or a Panel."""
    mesh = frame.mesh if isinstance(frame, render.Panel) else frame
    _check.instance("frames", mesh, Mesh, "meshes or Panels, or pictures alone")
    return frame


def _drawing(picture: render.PlotterKeywords | None) -> render.PlotterKeywords:
    """Return the validated options of the pictures, except the camera."""
    _check.instance("picture", picture, Mapping | None, "a mapping")
    drawing: render.PlotterKeywords = {"size": (640, 480)}
    drawing.update(picture or {})
    if "camera" in drawing:
        raise _check.value_error("picture", "no camera", "one", "pass it as camera=")
    names = set(render.PlotterKeywords.__annotations__) - {"camera"}
    for name in drawing:
        if name not in names:
            expected = f"options of a picture ({', '.join(sorted(names))})"
            raise _check.value_error("picture", expected, repr(name))
    return drawing


def _draw_active(mesh: Mesh, drawing: render.PlotterKeywords) -> None:
    """Choose the scalars of a mesh that is not lit: the requested ones, otherwise the active."""
    parts = [block for block in all_blocks(mesh) if block.n_points]
    if not parts:
        return
    name = drawing.setdefault("scalars", parts[0].active_scalars_name or "")
    arrays = [np.asarray(part[name]) for part in parts if name in part.array_names]
    if not arrays or any(x.ndim == 2 and x.shape[1] != 3 for x in arrays):
        expected = "a scene, or a mesh with active scalars of 1 or 3 components"
        raise _check.value_error("scene", expected, f"none, and {name!r}")
    if "clim" not in drawing and name != DEFAULT_NAME and (ends := _range(arrays)):
        drawing["clim"] = ends


def _range(arrays: Iterable[Raw]) -> tuple[float, float] | None:
    """Return the minimum and the maximum of the finite numbers in arrays of one component."""
    numbers = [x for x in arrays if x.ndim == 1 and x.dtype.kind in "biuf"]
    finite = np.concatenate([[], *(x[np.isfinite(x)] for x in numbers)])
    if not finite.size:
        return None
    low, high = float(finite.min()), float(finite.max())
    # A single value has a range too, in whose middle it lies.
    return (low, high) if low < high else (low - 0.5, low + 0.5)


def _counted(items: Iterable[Item], report: Callable[[int], None], done: int) -> Iterator[Item]:
    """Yield the items and report the number of items so far, counted from ``done``."""
    for item in items:
        done += 1
        report(done)
        yield item


def _writer(path: Path, fps: float, size: object) -> Callable[[Iterator[Picture]], list[Path]]:
    """Return the function that writes pictures to files, after checking its packages."""
    pixels = render.pixels_of(size)
    if path.suffix.lower() == ".png":
        return lambda pictures: _write_sequence(path, pictures)
    _need("imageio")
    # Milliseconds of a frame, and no end to the repetitions.
    options: dict[str, float | str] = {"duration": 1000 / fps, "loop": 0}
    if path.suffix.lower() == ".mp4":
        _need("imageio_ffmpeg")
        # The films that all players show hold colour at half the width and the height.
        if any(side % 2 for side in pixels):
            expected = "an even width and height for MP4"
            raise _check.value_error("size", expected, f"{pixels[0]}x{pixels[1]}")
        # By default imageio scales a picture to multiples of 16 pixels, which blurs thin lines.
        options = {"fps": fps, "macro_block_size": 2, "ffmpeg_log_level": "error"}
    return lambda pictures: [replace_file(path, lambda to: _write_movie(to, pictures, options))]


def _need(package: str) -> None:
    try:
        importlib.import_module(package)
    except ImportError as error:
        raise MovieError(
            f"no movie: {package} is not installed; pip install 'vizlight[movie]', "
            "or write a sequence of PNGs with a path that ends in .png"
        ) from error


def _write_sequence(path: Path, pictures: Iterable[Picture]) -> list[Path]:
    paths = (path.with_name(f"{path.stem}_{i:04d}.png") for i in itertools.count())
    files = [
        replace_file(file, Image.fromarray(picture).save)
        for picture, file in zip(pictures, paths, strict=False)
    ]
    # Frames left over from an earlier, longer sequence would play at the end of this one.
    for file in itertools.takewhile(Path.is_file, paths):
        file.unlink()
    return files


def _write_movie(
    path: str, pictures: Iterable[Picture], options: Mapping[str, float | str]
) -> None:
    """Write the pictures one by one, so that memory does not grow with their number."""
    import imageio.v2

    with imageio.v2.get_writer(path, mode="I", **options) as movie:
        for picture in pictures:
            movie.append_data(picture)
