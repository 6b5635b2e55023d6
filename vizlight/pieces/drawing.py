"""Pictures of data in pieces, each drawn by itself; the pictures are composited by depth."""

from __future__ import annotations

import dataclasses
import inspect
import itertools
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkFloatArray

from vizlight import _check, _pool, files
from vizlight.pictures import render
from vizlight.pieces import task
from vizlight.pieces.kinds import FilePiece, PieceError, union
from vizlight.pieces.run import Lit
from vizlight.pieces.sources import pieces_of
from vizlight.pieces.workers import workers_of
from vizlight.shading.options import unknown_option

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from vizlight._types import Array
    from vizlight.pieces.workers import Workers

    Picture = NDArray[np.uint8]

#: Number of samples along each side of a pixel.
SAMPLES = 2
#: What a camera is, in values that another process takes.
CAMERA = (
    "position", "focal_point", "up", "view_angle", "parallel_projection", "parallel_scale",
)  # fmt: skip


class Layer(NamedTuple):
    """Picture of some pieces, and the depth of each of its pixels, 1 where nothing is drawn."""

    color: Picture
    depth: Array
    last: bool

    def over(self, other: Layer | None) -> Layer:
        """Return both layers in one: of equal depths that of this one is seen."""
        if other is None:
            return self
        nearer = self.depth <= other.depth
        color = np.where(nearer[..., np.newaxis], self.color, other.color)
        return Layer(color, np.where(nearer, self.depth, other.depth), self.last)


@dataclass(frozen=True)
class Group:
    """Pieces that one task draws and puts together; ``last`` if the picture is then whole."""

    parts: tuple[FilePiece, ...]
    last: bool

    @property
    def name(self) -> str:
        """Name in messages."""
        return " to ".join(dict.fromkeys((self.parts[0].name, self.parts[-1].name)))


@dataclass(frozen=True, kw_only=True)
class Shot:
    """How each piece is drawn."""

    size: tuple[int, int]
    options: Mapping[str, Any]
    camera: Mapping[str, Any] = field(default_factory=dict)
    bounds: tuple[float, ...] = ()


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
        Results of :func:`light`, indices or files of each picture. Of an iterator no more is taken
        ahead than keeps the workers busy.
    camera : pyvista.Camera, optional
        Camera of all pictures. Default: :func:`vizlight.pictures.render.camera_on` the bounding box
        of the first.
    size : (int, int), default: (1200, 800)
        Width and height in pixels.
    samples : int, default: 2
        Number of samples along each side of a pixel, averaged after the pieces are put together.
    client, workers
        What draws, as for :func:`light`: a step in one piece is one task. No more local processes
        are started than there are processors. Every worker needs an OpenGL library.
    **options
        ``scalars``, ``cmap``, ``clim``, ``background`` and ``line_width`` of
        :func:`vizlight.pictures.render.make_plotter`; the background is white by default.

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
    A picture is that of the whole mesh, drawn with the same samples, but for the rounding of VTK:
    single pixels may differ by 1 of 255 where a triangle is cut. That holds for the edges of lines
    too: their samples are opaque, and are averaged after the pieces are put together, so that no
    edge is transparent before. Of fragments at the same depth the last piece's is seen, as the last
    mesh's is in one picture. VTK's own anti-aliasing ("ssaa") also weighs samples of the
    neighbouring pixels, so a picture of :mod:`vizlight.pictures.render` has softer edges.

    A task draws one or more pieces, one after the other, and sends their picture. A worker needs
    the memory of one piece and two pictures, the client that of two: 7 bytes per sample each. The
    pieces of a worker that is killed are drawn by another.

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
    aspect = width / height
    with workers_of(client, workers, 0, _pool.workers(None)) as pool:
        shots = _shots(sequence, pool, camera, aspect, Shot(size=large, options=options))
        whole = None
        for layer in pool.run(draw, shots, 2 * pool.number):
            whole = layer.over(whole)
            if layer.last:
                yield _smaller(whole.color, samples)
                whole = None


def _shots(
    sequence: Iterable[Any], pool: Workers, camera: pv.Camera | None, aspect: float, shot: Shot
) -> Iterator[tuple[Group, Shot]]:
    """Yield the pieces of each picture in groups, so many that all workers draw."""
    for one in sequence:
        parts, bounds = _parts(one, pool, camera)
        if camera is None:
            camera = render.camera_on(pv.Box(bounds), aspect=aspect)
        own = {name: getattr(camera, name) for name in CAMERA}
        now = dataclasses.replace(shot, camera=own, bounds=bounds)
        count = min(len(parts), 2 * pool.number)
        ends = [len(parts) * i // count for i in range(count + 1)]
        for low, high in itertools.pairwise(ends):
            yield Group(tuple(parts[low:high]), high == len(parts)), now


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


def draw(group: Group, shot: Shot) -> Layer:
    """Return the picture of the pieces of a group."""
    camera: Any = pv.Camera()  # type: ignore[no-untyped-call]
    for name, value in shot.camera.items():
        setattr(camera, name, value)
    whole = None
    for piece in group.parts:
        mesh = task.read(piece, 0)
        try:
            plotter = render.make_plotter(
                mesh, camera=camera, size=shot.size, anti_aliasing=None, light="points",
                **shot.options,
            )  # fmt: skip
        except (TypeError, ValueError) as error:
            raise PieceError(f"piece {piece.name}: {error}") from error
        try:
            plotter.renderer.ResetCameraClippingRange(shot.bounds or mesh.bounds)
            color = np.array(plotter.screenshot(return_img=True))
            width, height = shot.size
            depths = vtkFloatArray()
            window: Any = plotter.render_window
            window.GetZbufferData(0, 0, width - 1, height - 1, depths)
            depth = pv.convert_array(depths).reshape(height, width)[::-1].copy()
        finally:
            plotter.close()
        whole = Layer(color, depth, group.last).over(whole)
    assert whole is not None
    return whole


def _parts(
    shown: Any, pool: Workers, camera: pv.Camera | None
) -> tuple[list[FilePiece], tuple[float, ...]]:
    """Return the pieces with points of one picture, and their bounding box where it is needed."""
    if isinstance(shown, Lit):
        return [FilePiece(str(path), path) for path in shown.files], shown.bounds
    found = [piece for piece in pieces_of(shown, 1e9, "sequence") if isinstance(piece, FilePiece)]
    if len(found) == 1 and camera is not None:
        return found, ()
    boxes = list(pool.run(task.bounds, [(piece,) for piece in found]))
    full = [piece for piece, box in zip(found, boxes, strict=True) if box]
    if not full:
        expected = "files of surfaces, lines or cells"
        raise PieceError(_check.message("sequence", expected, _check.describe(shown)))
    return full, union([box for box in boxes if box])


def _smaller(picture: Picture, samples: int) -> Picture:
    """Return a picture whose pixels are means of squares of pixels."""
    if samples == 1:
        return picture
    height, width = picture.shape[0] // samples, picture.shape[1] // samples
    squares = picture.reshape(height, samples, width, samples, 3).astype(np.float32)
    means: Picture = np.rint(squares.mean(axis=(1, 3))).astype(np.uint8)
    return means
