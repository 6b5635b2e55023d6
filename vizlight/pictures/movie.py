"""A mesh that turns in n-space, as a sequence of PNGs or a movie: camera fixed, light moving."""

from __future__ import annotations

import importlib
import inspect
import itertools
import os
import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv
from PIL import Image

from vizlight import _check
from vizlight._progress import progress
from vizlight.files import check_output, replace_file
from vizlight.filters import project
from vizlight.filters.lighting import DEFAULT_NAME
from vizlight.mesh.blocks import leaves
from vizlight.pictures import render

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    Picture = NDArray[np.uint8]

__all__ = ["MovieError", "turn"]

FORMATS = (".png", ".gif", ".mp4")
TURN = 2 * np.pi
#: The options of a projection that decide where points come to be.
PLACING = ("positions", "frame", "distance", "hyperplane", "cut")


class MovieError(RuntimeError):
    """The package that writes movies is not installed; the message says how to install it."""


def turn(
    mesh: Any,
    path: str | Path,
    /,
    *,
    plane: Any = "xw",
    frames: int = 72,
    angle: float = TURN,
    fps: float = 24.0,
    camera: Any = None,
    picture: Mapping[str, Any] | None = None,
    progress_bar: bool = False,
    **options: Any,
) -> list[Path]:
    """Turn a mesh in a plane of n-space, light it at every step, and write what is seen.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        With positions and a frame in n-space, as :func:`vizlight.project` takes it. Not changed.
    path : path
        A movie, ``.gif`` or ``.mp4``, or ``turn.png`` for ``turn_0000.png`` and so on; the
        folder must exist. What an earlier sequence has there is written over, and what follows
        the last frame without a gap, the end of a longer one, is removed.
    plane : str or (int, int), default: "xw"
        Of the turn, as for :func:`vizlight.geometry.projection.plane_rotation`.
    frames : int, default: 72
        How many; the one after the last would be at ``angle``.
    angle : float, default: 2 pi
        Of the whole turn, in radians.
    fps : float, default: 24.0
        Frames a second of a movie, up to 100.
    camera : pyvista.Camera, optional
        The eye, which stays. Default: one that sees the mesh at every step.
    picture : mapping, optional
        Further options of :func:`vizlight.render.make_plotter`: size, scalars, cmap, clim,
        background.
    progress_bar : bool, default: False
        Show progress on standard error.
    **options
        Of :func:`vizlight.project`: ``scene=``, which stays as the mesh turns; ``light=`` before
        or after the projection; distance, hyperplane, cut. ``rotation=`` comes before the turn.
        Without a scene the mesh's active scalars are drawn, those but luminance from their least
        to their largest number.

    Returns
    -------
    list of pathlib.Path
        The files.

    Raises
    ------
    MovieError
        If a movie is asked for and imageio is not installed; before anything is drawn.
    BackendError
        If no OpenGL library draws here.
    TypeError, ValueError
        If an argument does not fit, or a file cannot be written. No partial file is left: of a
        sequence the files that are whole, of a movie none.

    Warns
    -----
    UserWarning
        Once, with the number of frames, if :func:`vizlight.project` warns.
    """
    if not isinstance(path, str | os.PathLike):
        raise TypeError(_check.message("path", "the path of a file", _check.describe(path)))
    path = check_output(path, FORMATS)
    count = _check.integer("frames", frames, low=1)
    whole = _check.number("angle", angle)
    fps = _check.number("fps", fps, low=0.01, high=100.0)
    drawing = _drawing(picture)
    if options.get("scene") is not None:
        drawing.setdefault("scalars", options.get("name", DEFAULT_NAME))
    else:
        _draw_active(mesh, drawing)
    writer = _writer(path, fps, drawing["size"])
    before = options.pop("rotation", None)
    said: list[str] = []

    def steps(settings: dict[str, Any]) -> Iterator[Any]:
        for i in range(count):
            turned = (plane, whole * i / count)
            rotation = turned if before is None else [before, turned]
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                step = project(mesh, rotation=rotation, **settings)
            said.extend(str(warning.message) for warning in caught[:1])
            yield step

    with progress("turn", count if camera else 2 * count, show=progress_bar) as report:
        done = 0
        if camera is None:
            # What light there is makes no difference to where things are.
            where = {name: options[name] for name in PLACING if name in options}
            camera = render.camera_on(_bounds(_counted(steps(where), report, done)))
            done = count
            said.clear()
        seen = render.pictures(steps(options), camera=camera, **drawing)
        files = writer(_counted(seen, report, done))
    if said:
        _check.warn(f"in {len(said)} of {count} frames: {said[0]}")
    return files


def _drawing(picture: Any) -> dict[str, Any]:
    """Return options of a picture, if they are."""
    if not (picture is None or isinstance(picture, Mapping)):
        raise TypeError(_check.message("picture", "a mapping", _check.describe(picture)))
    drawing = {"size": (640, 480), **(picture or {})}
    if "camera" in drawing:
        raise ValueError(_check.message("picture", "no camera", "one", "pass it as camera="))
    known = set(inspect.signature(render.make_plotter).parameters) - {"panels", "camera"}
    for name in drawing:
        if name not in known:
            expected = f"options of a picture ({', '.join(sorted(known))})"
            raise ValueError(_check.message("picture", expected, repr(name)))
    return drawing


def _draw_active(mesh: Any, drawing: dict[str, Any]) -> None:
    """Have scalars drawn that a mesh has: those chosen, else the active ones."""
    parts = [leaf for leaf in leaves(mesh) if isinstance(leaf, pv.DataSet) and leaf.n_points]
    if not parts:
        return
    name = drawing.setdefault("scalars", parts[0].active_scalars_name)
    arrays = [np.asarray(part[name]) for part in parts if name in part.array_names]
    if not arrays or any(x.ndim == 2 and x.shape[1] != 3 for x in arrays):
        expected = "a scene, or a mesh with active scalars of 1 component or 3"
        raise ValueError(_check.message("scene", expected, f"none, and {name!r}"))
    if "clim" in drawing or name == DEFAULT_NAME:
        return
    finite = [x[np.isfinite(x)] for x in arrays if x.ndim == 1 and x.dtype.kind in "biuf"]
    ends = [float(end(x)) for x in finite if len(x) for end in (np.min, np.max)]
    if ends:
        low, high = min(ends), max(ends)
        drawing["clim"] = (low, high) if low < high else (low - 0.5, low + 0.5)


def _counted(items: Iterable[Any], report: Callable[[int], None], done: int) -> Iterator[Any]:
    """Yield items and tell how many there were."""
    for item in items:
        done += 1
        report(done)
        yield item


def _bounds(meshes: Iterable[Any]) -> list[float]:
    """Return the box around all meshes."""
    boxes = [leaf.bounds for mesh in meshes for leaf in leaves(mesh) if leaf.n_points]
    if not boxes:
        raise ValueError(_check.message("mesh", "points to draw", "none at any step"))
    low, high = np.array(boxes)[:, ::2].min(axis=0), np.array(boxes)[:, 1::2].max(axis=0)
    return [float(x) for pair in zip(low, high, strict=True) for x in pair]


def _writer(path: Path, fps: float, size: Any) -> Callable[[Iterator[Picture]], list[Path]]:
    """Return what writes pictures to files, if all that it needs is there."""
    pixels = render.pixels_of(size)
    if path.suffix.lower() == ".png":
        return lambda pictures: _write_sequence(path, pictures)
    _need("imageio")
    options: dict[str, Any] = {"duration": 1000 / fps, "loop": 0}
    if path.suffix.lower() == ".mp4":
        _need("imageio_ffmpeg")
        if any(side % 2 for side in pixels):
            expected = "an even width and height for MP4"
            raise ValueError(_check.message("size", expected, f"{pixels[0]}x{pixels[1]}"))
        options = {"fps": fps, "macro_block_size": 2}
    return lambda pictures: [replace_file(path, lambda to: _write_movie(to, pictures, options))]


def _need(package: str) -> None:
    try:
        importlib.import_module(package)
    except ImportError as error:
        raise MovieError(
            f"no movie: {package} is not installed; pip install 'vizlight[movie]', "
            "or write a sequence of PNGs: a path that ends in .png"
        ) from error


def _write_sequence(path: Path, pictures: Iterable[Picture]) -> list[Path]:
    files = []
    for i, picture in enumerate(pictures):
        name = path.with_name(f"{path.stem}_{i:04d}.png")
        files.append(replace_file(name, Image.fromarray(picture).save))
    for i in itertools.count(len(files)):
        # Frames of an earlier, longer sequence would play as the end of this one.
        name = path.with_name(f"{path.stem}_{i:04d}.png")
        if not name.is_file():
            return files
        name.unlink()
    return files


def _write_movie(path: str, pictures: Iterable[Picture], options: dict[str, Any]) -> None:
    """Write one picture after the other, so that a long movie needs no more memory."""
    import imageio.v2

    writer: Any = imageio.v2.get_writer(path, mode="I", **options)
    with writer as movie:
        for picture in pictures:
            movie.append_data(picture)
