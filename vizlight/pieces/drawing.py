"""Pictures of data in pieces, each drawn by itself; the pictures are composited by depth."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkFloatArray
from vtkmodules.vtkRenderingCore import vtkRenderer

from vizlight import _check, files
from vizlight.pictures import render
from vizlight.pieces.kinds import FilePiece, PieceError, union
from vizlight.pieces.run import Lit
from vizlight.pieces.sources import pieces_of
from vizlight.pieces.task import survey
from vizlight.pieces.workers import runner
from vizlight.shading.options import unknown_option

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from vizlight._types import Array

    Picture = NDArray[np.uint8]

#: Number of samples along each side of a pixel.
SAMPLES = 2
#: What a camera is, in values that another process takes.
CAMERA = (
    "position", "focal_point", "up", "view_angle", "parallel_projection", "parallel_scale",
)  # fmt: skip


class Layer(NamedTuple):
    """Picture of one piece, and the depth of each of its pixels, 1 where nothing is drawn."""

    color: Picture
    depth: Array


@dataclass(frozen=True, kw_only=True)
class Shot:
    """How each piece is drawn."""

    camera: Mapping[str, Any]
    clipping: tuple[float, float]
    size: tuple[int, int]
    options: Mapping[str, Any]


def pictures(
    sequence: Iterable[Lit | str | Path | list[str | Path]],
    /,
    *,
    camera: pv.Camera | None = None,
    size: tuple[int, int] = (1200, 800),
    samples: int = SAMPLES,
    client: Any = None,
    workers: int | None = None,
    **options: Any,
) -> Iterator[Picture]:
    """Yield pictures of meshes in pieces, such as the steps of a series, for a movie.

    Parameters
    ----------
    sequence : iterable of Lit, path or list of paths
        Results of :func:`light`, indices or files of each picture.
    camera : pyvista.Camera, optional
        Camera of all pictures. Default: :func:`vizlight.render.camera_on` the bounding box of the
        first.
    size : (int, int), default: (1200, 800)
        Width and height in pixels.
    samples : int, default: 2
        Number of samples along each side of a pixel, averaged after the pieces are put together.
    client, workers
        What draws, as for :func:`light`. Every worker needs an OpenGL library.
    **options
        ``scalars``, ``cmap``, ``clim``, ``background`` and ``line_width`` of
        :func:`vizlight.render.make_plotter`; the background is white by default.

    Yields
    ------
    ndarray of uint8, shape (height, width, 3)

    Raises
    ------
    TypeError, ValueError
        If an option does not fit.
    PieceError
        If a piece cannot be read or drawn.
    BackendError
        If no OpenGL library can draw here.

    Notes
    -----
    No pixel differs from that of a picture of the whole mesh, drawn with the same samples. Of
    fragments at the same depth the last piece's is seen, as the last mesh's is in one picture.
    A worker needs the memory of one piece; the client that of the picture, 7 bytes per sample.

    Examples
    --------
    >>> import tempfile, pyvista as pv, vizlight
    >>> folder = tempfile.mkdtemp()
    >>> pv.Sphere().save(f"{folder}/ball.vtp")
    >>> scene = vizlight.Scene(view=vizlight.View(direction=(0, 0, 1)))
    >>> path = f"{folder}/lit.pvtp"
    >>> lit = vizlight.pieces.light(f"{folder}/ball.vtp", scene, workers=1, out=path)
    >>> camera = pv.Camera()
    >>> camera.position = (0, 0, 3)
    >>> next(vizlight.pieces.pictures([lit], camera=camera, size=(60, 40), workers=1)).shape
    (40, 60, 3)
    """
    _check.iterable("sequence", sequence, "an iterable of Lit, paths or lists of them")
    known = [
        *inspect.signature(pictures).parameters,
        *("scalars", "cmap", "clim", "background", "line_width", "backend"),
    ]
    for name in options:
        if name not in known:
            raise TypeError(unknown_option("pictures", name, known))
    if camera is not None and not hasattr(camera, "GetPosition"):
        raise TypeError(_check.message("camera", "a pyvista.Camera", _check.describe(camera)))
    samples = _check.integer("samples", samples, low=1)
    width, height = render.pixels_of(size)
    large = (samples * width, samples * height)
    render.pixels_of(large)
    options = {"background": "white", "line_width": 1.0} | options
    options["line_width"] = samples * _check.number("line_width", options["line_width"], low=0.1)
    with runner(client, workers, 0, 1 << 20) as run:
        for one in sequence:
            parts = _parts(one)
            bounds = _bounds(one, parts, run)
            if camera is None:
                camera = render.camera_on(pv.Box(bounds), aspect=width / height)
            shot = Shot(
                camera={name: getattr(camera, name) for name in CAMERA},
                clipping=_clipping(camera, bounds),
                size=large,
                options=options,
            )
            layers = run(draw, [(piece, shot) for piece in parts])
            yield _smaller(_together(layers, len(parts)), samples)


def save_png(
    shown: Lit | str | Path | list[str | Path], path: str | Path, /, **options: Any
) -> Path:
    """Draw a mesh in pieces and save the picture as a PNG file.

    Parameters
    ----------
    shown : Lit, path or list of paths
        Result of :func:`light`, an index or files.
    path : path
        Path of the picture, in an existing folder.
    **options
        Options of :func:`pictures`.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    TypeError, ValueError
        As for :func:`pictures`, or if the file cannot be written. No partial file is left.
    """
    from PIL import Image

    path = files.check_output(path, (".png",))
    picture = next(pictures([shown], **options))
    return files.replace_file(path, lambda draft: Image.fromarray(picture).save(draft))


def draw(piece: FilePiece, shot: Shot) -> Layer:
    """Return the picture of one piece."""
    mesh = piece.load()
    camera: Any = pv.Camera()  # type: ignore[no-untyped-call]
    for name, value in shot.camera.items():
        setattr(camera, name, value)
    try:
        plotter = render.make_plotter(
            mesh, camera=camera, size=shot.size, anti_aliasing=None, light="points", **shot.options
        )
    except (TypeError, ValueError) as error:
        raise PieceError(f"piece {piece.name}: {error}") from error
    try:
        plotter.camera.clipping_range = shot.clipping
        color = np.array(plotter.screenshot(return_img=True))
        width, height = shot.size
        depths = vtkFloatArray()
        window: Any = plotter.render_window
        window.GetZbufferData(0, 0, width - 1, height - 1, depths)
        depth = pv.convert_array(depths).reshape(height, width)[::-1].copy()
    finally:
        plotter.close()
    return Layer(color, depth)


def _parts(shown: Lit | str | Path | list[str | Path]) -> list[FilePiece]:
    if isinstance(shown, Lit):
        return [FilePiece(str(path), path) for path in shown.files]
    found = [piece for piece in pieces_of(shown, 1e9, "sequence") if isinstance(piece, FilePiece)]
    if not found:
        expected = "files of surfaces, lines or cells"
        raise PieceError(_check.message("sequence", expected, _check.describe(shown)))
    return found


def _bounds(shown: object, parts: list[FilePiece], run: Any) -> tuple[float, ...]:
    if isinstance(shown, Lit):
        return shown.bounds
    return union([one.bounds for _, one in run(survey, [(piece, None) for piece in parts])])


def _clipping(camera: pv.Camera, bounds: tuple[float, ...]) -> tuple[float, float]:
    """Return the range of depths that a camera needs for a box."""
    own, renderer = camera.copy(), vtkRenderer()  # type: ignore[no-untyped-call]
    renderer.SetActiveCamera(own)
    renderer.ResetCameraClippingRange(bounds)
    near, far = own.clipping_range
    return float(near), float(far)


def _together(layers: Iterator[tuple[int, Layer]], count: int) -> Picture:
    """Return one picture of several, in the order of the pieces, whenever they come."""
    waiting: dict[int, Layer] = {}
    color: Picture = np.zeros((0, 0, 3), np.uint8)
    depth: Array = np.zeros((0, 0))
    wanted = 0
    for i, layer in layers:
        waiting[i] = layer
        while wanted in waiting:
            own = waiting.pop(wanted)
            if not wanted:
                color, depth = own.color.copy(), own.depth.copy()
            nearer = own.depth <= depth
            color[nearer], depth[nearer] = own.color[nearer], own.depth[nearer]
            wanted += 1
    assert wanted == count
    return color


def _smaller(picture: Picture, samples: int) -> Picture:
    """Return a picture whose pixels are means of squares of pixels."""
    if samples == 1:
        return picture
    height, width = picture.shape[0] // samples, picture.shape[1] // samples
    squares = picture.reshape(height, samples, width, samples, 3).astype(np.float32)
    means: Picture = np.rint(squares.mean(axis=(1, 3))).astype(np.uint8)
    return means
