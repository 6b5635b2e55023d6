"""What is found of data in pieces before they are lit: arrays, neighbours, level, box, camera."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.draw import cameras
from vizlight.filters import lighting
from vizlight.pieces import task
from vizlight.pieces.kinds import FilePiece, PieceError
from vizlight.pieces.sources import pieces_of
from vizlight.pieces.workers import RETRIES, Work, checked
from vizlight.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Foreign, Given, Keywords
    from vizlight.pieces.kinds import Piece
    from vizlight.pieces.task import Job, Survey
    from vizlight.pieces.workers import Map


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
    map: Map = map,
    slab: float = 64.0,
    progress_bar: bool = False,
) -> pv.Camera:
    """Return a camera that shows data in pieces, the same as on the whole.

    Parameters
    ----------
    sources, contour, level, map, slab, progress_bar
        As for :func:`light`. Without ``contour`` only the corners of an image are taken; an
        isosurface costs a first reading and contouring.
    direction, up, parallel, zoom, aspect
        As for :func:`vizlight.draw.render.camera_on`.

    Returns
    -------
    pyvista.Camera
        The camera of :func:`vizlight.draw.render.camera_on` for the mesh of all pieces, to
        rounding.

    Raises
    ------
    TypeError, ValueError, PieceError
        As for :func:`light`.
    """
    job = job_of(contour, level)
    options: Keywords = {"up": up, "parallel": parallel, "zoom": zoom, "aspect": aspect}
    cameras.camera_on((0, 1) * 3, direction, **options)  # checks them before anything is read
    parts = pieces_of(sources, _check.positive("slab", slab))
    work = Work(checked(map), RETRIES, progress_bar)
    if job.contour is not None and job.level is None:
        pairs = _surveyed(parts, job, work)
        job = dataclasses.replace(job, level=_middle([one for _, one in pairs], job))
    calls = [(piece, job, direction, up, aspect) for piece in parts]
    found = work.each(task.outermost, calls, "camera")
    points = np.concatenate([np.asarray(some, dtype=np.float64) for some in found])
    if not len(points):
        raise nothing_found(parts, job, work)
    return cameras.camera_on(pv.PolyData(points), direction, **options)


def job_of(contour: object, level: object, **more: Given) -> Job:
    """Return a job of an isosurface, or of whole pieces."""
    if level is not None and contour is None:
        raise ValueError(_check.message("level", "contour= beside it", level))
    facts: Keywords = {"scene": Scene(), "filter": "illuminate", "options": {}}
    return task.Job(
        contour=contour if contour is None else _name("contour", contour),
        level=None if level is None else _check.number("level", level),
        **({**facts, "ghost": 0, "suffix": ""} | more),
    )


def nothing_found(parts: list[Piece], job: Job, work: Work) -> PieceError:
    """Return the error of pieces without a point to light."""
    if job.contour is None:
        expected = "pieces with something to light"
        return PieceError(_check.message("sources", expected, "no points"))
    values = [one.values for _, one in _surveyed(parts, job, work)]
    low, high = min(low for low, _ in values), max(high for _, high in values)
    expected = f"a value between {low:g} and {high:g}"
    return PieceError(_check.message("level", expected, f"{job.level:g}"))


def _name(argument: str, value: object) -> str:
    if not _check.text(argument, value, expected="the name of a point array"):
        raise ValueError(_check.message(argument, "the name of a point array", repr(value)))
    return str(value)


def prepared(parts: list[Piece], job: Job, work: Work) -> tuple[list[Piece], Job]:
    """Return pieces that know their neighbours, and a job without a question left open."""
    cue = job.scene.depth_cue
    open_cue = cue is not None and (cue.front is None or cue.back is None)
    loose = any(isinstance(piece, FilePiece) for piece in parts)
    if not (loose or open_cue or (job.contour is not None and job.level is None)):
        return parts, job
    pairs = _surveyed(parts, job, work)
    boxes = np.array([one.bounds for _, one in pairs]).reshape(-1, 3, 2)
    if job.contour is not None and job.level is None:
        job = dataclasses.replace(job, level=_middle([one for _, one in pairs], job))
    if open_cue:
        calls = [(piece, job) for piece, _ in pairs]
        ends = work.each(task.depths, calls, "depth")
        job = dataclasses.replace(job, scene=lighting.with_depth_ends(job.scene, ends))
    return _neighbours([piece for piece, _ in pairs], boxes, job.ghost), job


def _surveyed(parts: list[Piece], job: Job, work: Work) -> list[tuple[Piece, Survey]]:
    """Return the pieces with points, which have arrays of the same types, and what is in them."""
    calls = [(piece, job.contour) for piece in parts]
    found = work.each(task.survey, calls, "survey")
    pairs = [(piece, one) for piece, one in zip(parts, found, strict=True) if one.points]
    if not pairs:
        raise PieceError(_check.message("sources", "pieces with points", "none"))
    first_piece, first = pairs[0]
    for piece, one in pairs[1:]:
        check_alike(piece, one.arrays, first_piece, first.arrays)
        if one.lines != first.lines and _by_faces(job):
            # A whole of both is lit by its faces, and a piece of lines alone by their tangents.
            expected = f"{'lines' if first.lines else 'faces'} as in {first_piece.name}"
            got, remedy = "lines alone" if one.lines else "faces", "light lines by themselves"
            text = _check.message("sources", expected, got, remedy)
            raise PieceError(f"piece {piece.name}: {text}")
    return pairs


def _by_faces(job: Job) -> bool:
    """Return whether light depends on faces where a mesh has some."""
    options = job.options
    tangents = options.get("tangents") is not None and options.get("conditioned") is not True
    return job.contour is None and job.filter == "illuminate" and not tangents


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


def check_alike(piece: Piece, found: Keywords, first: Piece, expected: Keywords) -> None:
    """Check that a piece has the arrays of the first, and that both are boxes of one grid."""
    for name in expected | found:
        here, there = found.get(name), expected.get(name)
        if here != there:
            kind, _, own = name.partition(" ")
            what = f"{kind} array {own!r}" if own else kind
            wanted = f"the {what} of {there}" if there else f"no {what}"
            text = _check.message("sources", f"{wanted} as in {first.name}", here or "none")
            raise PieceError(f"piece {piece.name}: {text}")


def _neighbours(parts: list[Piece], boxes: Foreign, ghost: int) -> list[Piece]:
    """Return the pieces; pieces of files come with the pieces whose boxes touch theirs."""
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
