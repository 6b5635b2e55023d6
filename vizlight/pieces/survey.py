"""What is found of data in pieces before they are lit: arrays, neighbours, level, box, camera."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.pictures import cameras
from vizlight.pieces import task
from vizlight.pieces.kinds import FilePiece, PieceError, union
from vizlight.pieces.sources import pieces_of
from vizlight.pieces.workers import collected, workers_of
from vizlight.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight.pieces.kinds import Piece
    from vizlight.pieces.task import Job, Survey
    from vizlight.pieces.workers import Workers

#: Number of times that a piece is tried again after an error of the operating system.
RETRIES = 2


def bounding_box(
    sources: object,
    /,
    *,
    client: Any = None,
    workers: int | None = None,
    progress_bar: bool = False,
) -> pv.PolyData:
    """Return the bounding box of data in pieces as a mesh, such as to set a camera on it.

    Parameters
    ----------
    sources, client, workers, progress_bar
        As for :func:`light`.

    Returns
    -------
    pyvista.PolyData

    Raises
    ------
    TypeError, ValueError, PieceError, ImportError
        As for :func:`light`.
    """
    parts = pieces_of(sources, 64.0)
    with workers_of(client, workers, 0, len(parts)) as pool:
        calls = [(piece,) for piece in parts]
        boxes = collected(pool.run(task.bounds, calls), len(calls), "bounds", show=progress_bar)
    rows = np.array([box for box in boxes if box]).reshape(-1, 6)
    if not len(rows):
        raise PieceError(_check.message("sources", "pieces with points", "none"))
    return pv.Box(union(rows))


def camera_on(
    sources: object,
    /,
    direction: Sequence[float] = (1.0, 1.0, 1.0),
    *,
    contour: str | None = None,
    level: float | None = None,
    up: Sequence[float] | None = None,
    parallel: bool = False,
    zoom: float = 1.0,
    aspect: float = 1.0,
    client: Any = None,
    workers: int | None = None,
    slab: float = 64.0,
    progress_bar: bool = False,
) -> pv.Camera:
    """Return a camera that shows data in pieces, the same as on the whole.

    Parameters
    ----------
    sources, contour, level, client, workers, slab, progress_bar
        As for :func:`light`. Without ``contour`` only the corners of an image are taken; an
        isosurface costs a first reading and contouring.
    direction, up, parallel, zoom, aspect
        As for :func:`vizlight.pictures.render.camera_on`.

    Returns
    -------
    pyvista.Camera
        That of :func:`vizlight.pictures.render.camera_on` for the mesh of all pieces, to rounding.

    Raises
    ------
    TypeError, ValueError, PieceError, ImportError
        As for :func:`light`.
    """
    job = job_of(contour, level)
    options: dict[str, Any] = {"up": up, "parallel": parallel, "zoom": zoom, "aspect": aspect}
    cameras.camera_on((0, 1) * 3, direction, **options)  # checks them before anything is read
    parts = pieces_of(sources, _check.positive("slab", slab))
    with workers_of(client, workers, RETRIES, len(parts)) as pool:
        if job.contour is not None and job.level is None:
            pairs = _surveyed(parts, job, pool, show=progress_bar)
            job = dataclasses.replace(job, level=_middle([one for _, one in pairs], job))
        calls = [(piece, job, direction, up, aspect) for piece in parts]
        found = collected(pool.run(task.outermost, calls), len(calls), "camera", show=progress_bar)
        points = np.concatenate([np.asarray(some, dtype=np.float64) for some in found])
        if not len(points):
            raise nothing_found(parts, job, pool)
    return cameras.camera_on(pv.PolyData(points), direction, **options)


def job_of(contour: object, level: object, **more: Any) -> Job:
    """Return a job of an isosurface, or of whole pieces."""
    if level is not None and contour is None:
        raise ValueError(_check.message("level", "contour= beside it", level))
    facts: dict[str, Any] = {"scene": Scene(), "filter": "illuminate", "options": {}}
    return task.Job(
        contour=contour if contour is None else _name("contour", contour),
        level=None if level is None else _check.number("level", level),
        **({**facts, "ghost": 0, "suffix": ""} | more),
    )


def nothing_found(parts: list[Piece], job: Job, pool: Workers) -> PieceError:
    """Return the error of pieces without a point to light."""
    if job.contour is None:
        expected = "pieces with something to light"
        return PieceError(_check.message("sources", expected, "no points"))
    values = [one.values for _, one in _surveyed(parts, job, pool, show=False)]
    low, high = min(low for low, _ in values), max(high for _, high in values)
    expected = f"a value between {low:g} and {high:g}"
    return PieceError(_check.message("level", expected, f"{job.level:g}"))


def _name(argument: str, value: object) -> str:
    if not _check.text(argument, value, expected="the name of a point array"):
        raise ValueError(_check.message(argument, "the name of a point array", repr(value)))
    return str(value)


def prepared(parts: list[Piece], job: Job, pool: Workers, *, show: bool) -> tuple[list[Piece], Job]:
    """Return pieces that know their neighbours, and a job without a question left open."""
    cue = job.scene.depth_cue
    open_cue = cue is not None and (cue.front is None or cue.back is None)
    loose = any(isinstance(piece, FilePiece) for piece in parts)
    if not (loose or open_cue or (job.contour is not None and job.level is None)):
        return parts, job
    pairs = _surveyed(parts, job, pool, show=show)
    boxes = np.array([one.bounds for _, one in pairs]).reshape(-1, 3, 2)
    if open_cue:
        low, high = boxes[:, :, 0].min(axis=0), boxes[:, :, 1].max(axis=0)
        grid = np.meshgrid(*np.stack([low, high], axis=1), indexing="ij")
        corners = np.stack(grid, axis=-1).reshape(-1, 3)
        job = dataclasses.replace(job, scene=_with_ends(job.scene, corners))
    if job.contour is not None and job.level is None:
        job = dataclasses.replace(job, level=_middle([one for _, one in pairs], job))
    return _neighbours([piece for piece, _ in pairs], boxes, job.ghost), job


def _surveyed(
    parts: list[Piece], job: Job, pool: Workers, *, show: bool
) -> list[tuple[Piece, Survey]]:
    """Return the pieces with points, which have arrays of the same types, and what is in them."""
    calls = [(piece, job.contour) for piece in parts]
    found = collected(pool.run(task.survey, calls), len(calls), "survey", show=show)
    pairs = [(piece, one) for piece, one in zip(parts, found, strict=True) if one.points]
    if not pairs:
        raise PieceError(_check.message("sources", "pieces with points", "none"))
    first_piece, first = pairs[0]
    for piece, one in pairs[1:]:
        check_alike(piece, one.arrays, first_piece, first.arrays)
    return pairs


def _middle(found: Sequence[Survey], job: Job) -> float:
    """Return the middle of the range of the contoured array over all pieces."""
    low = min(one.values[0] for one in found)
    high = max(one.values[1] for one in found)
    if not low <= high:
        arrays = found[0].arrays.items()
        names = [key[6:] for key, kind in arrays if key.startswith("point ") and " x " not in kind]
        expected = f"a point array of one component, {_check.one_of(names)}"
        raise ValueError(_check.message("contour", expected, repr(job.contour)))
    return (low + high) / 2


def check_alike(
    piece: Piece, found: dict[str, Any], first: Piece, expected: dict[str, Any]
) -> None:
    """Check that a piece has the arrays of the first, and the grid of which both are boxes."""
    for name in expected | found:
        here, there = found.get(name), expected.get(name)
        if here != there:
            kind, _, own = name.partition(" ")
            what = f"{kind} array {own!r}" if own else kind
            wanted = f"the {what} of {there}" if there else f"no {what}"
            text = _check.message("sources", f"{wanted} as in {first.name}", here or "none")
            raise PieceError(f"piece {piece.name}: {text}")


def _with_ends(scene: Scene, corners: Any) -> Scene:
    from vizlight.filters.lighting import fit_depth_cue
    from vizlight.shading.inputs import ShadingInputs

    return fit_depth_cue(scene, [ShadingInputs(points=corners)])


def _neighbours(parts: list[Piece], boxes: Any, ghost: int) -> list[Piece]:
    """Return the pieces, those of files with the pieces whose boxes touch theirs."""
    if not ghost:
        return parts
    found: list[Piece] = []
    for i, piece in enumerate(parts):
        if not isinstance(piece, FilePiece):
            found.append(piece)
            continue
        touch = np.all((boxes[:, :, 0] <= boxes[i, :, 1]) & (boxes[:, :, 1] >= boxes[i, :, 0]), 1)
        beside = [parts[j] for j in np.flatnonzero(touch) if j != i]
        own = tuple(one for one in beside if isinstance(one, FilePiece))
        found.append(dataclasses.replace(piece, beside=own))
    return found
