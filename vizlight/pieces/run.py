"""Light data in pieces: one after the other, by processes, or on a cluster of Dask."""

from __future__ import annotations

import builtins
import contextlib
import dataclasses
import inspect
import re
import shutil
import uuid
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from vizlight import _check, _compiled, _pool, files
from vizlight.mesh import normals
from vizlight.pieces import index, task
from vizlight.pieces.kinds import INDEX, PieceError, index_files, union
from vizlight.pieces.sources import pieces_of
from vizlight.pieces.survey import check_alike, job_of, nothing_found, prepared
from vizlight.pieces.workers import RETRIES, Work, checked
from vizlight.reading import sides
from vizlight.reading.orientation import SHARP
from vizlight.scene import Scene
from vizlight.shading.options import LightOptions, unknown_option
from vizlight.shading.results import unlit
from vizlight.verify import report

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from vizlight._types import Foreign, Given, Keywords
    from vizlight.pieces.kinds import Piece
    from vizlight.pieces.task import Done, Job
    from vizlight.pieces.workers import Map
    from vizlight.reading.normals import Told

#: Options of light that depend on a mesh as a whole.
WHOLE = {
    "bundle": "lines of all pieces dim one another; light them together",
}


@dataclass(frozen=True)
class Lit:
    """The result of :func:`light`.

    Attributes
    ----------
    path : pathlib.Path
        Path of the index.
    files : tuple of pathlib.Path
        Files of the pieces with points.
    points, cells : int
        Numbers of points and cells of all files; points on a common border count in each.
    bounds : tuple of 6 float
        Bounding box.
    ranges : dict of str to (float, float)
        Smallest and largest finite value of each point array, such as for ``clim``.
    scene : Scene
        Scene with both ends of its depth cue, the same for all pieces.
    level : float or None
        Value of the contoured array on the isosurface.
    empty : int
        Number of pieces that have no point.
    """

    path: Path
    files: tuple[Path, ...]
    points: int
    cells: int
    bounds: tuple[float, ...]
    ranges: dict[str, tuple[float, float]] = field(repr=False)
    scene: Scene = field(repr=False)
    level: float | None
    empty: int


def light(
    sources: object,
    /,
    scene: Scene,
    *,
    filter: str = "illuminate",
    contour: str | None = None,
    level: float | None = None,
    ghost: int = 1,
    out: str | Path = "lit.pvtp",
    map: Map = map,
    retries: int = RETRIES,
    slab: float = 64.0,
    progress_bar: bool = False,
    **options: Given,
) -> Lit:
    """Light data in pieces, each read, lit and written by itself, as the whole would be lit.

    Parameters
    ----------
    sources : path, Slabs or sequence of them
        Files, patterns such as ``"run/*.vtu"``, indices (.pvtu, .pvtp, .vtm), which name the
        files of pieces, VTKHDF files, whose partitions are pieces, and structured grids (.vti,
        .vtr, .vts, .pvti, .pvtr, .pvts and :class:`Slabs`), which are cut in slabs.
    scene : Scene
        Lights, material and view. The ends of a depth cue that are not given are taken from the
        bounding box of all pieces.
    filter : {"illuminate", "streamlines"}
        Filter of vizlight. Streamlines end where their piece ends, and ``seeds`` counts the seeds
        of each piece.
    contour : str, optional
        Name of a point array of one component, whose isosurface is lit.
    level : float, optional
        Value of the array on the isosurface. Default: the middle of its range over all pieces,
        which costs a first reading.
    ghost : int, default: 1
        Number of layers of cells of other pieces that are read around a piece for normals and
        gradients on its border. Files and partitions must have the same points, bit for bit, at
        common borders; several points at one place of a border are taken for one. Slivers on a
        border, as on isosurfaces through nodes of a grid, need 2. 0 is enough for tangents and for
        normals that are named.
    out : path, default: "lit.pvtp"
        Path of the index: .pvtp for isosurfaces, lines and surfaces, .pvtu for cells of any other
        kind, .pvti, .pvtr and .pvts for grids. The files of the pieces are in a folder beside it
        that has its name without the suffix.
    map : callable, executor or client, default: map
        What calls a function of each piece: ``map``, one after the other in this process;
        :class:`vizlight.pieces.Processes`; a ``ProcessPoolExecutor`` or its ``map``; or a
        ``distributed.Client`` of Dask, whose workers see the same files.
    retries : int, default: 2
        Number of times that a piece is tried again after an error of the operating system.
    slab : float, default: 64.0
        Largest size in MB of a slab of a structured grid, ghost cells apart. A layer of cells that
        is larger is cut across y too.
    progress_bar : bool, default: False
        Whether progress is shown on standard error.
    **options
        Options of the filter. ``normals="gradient"`` with ``contour`` takes the gradient of the
        contoured array. ``facing="auto"``, the default, and ``feature_angle="auto"`` are questions
        of the whole, which cost a reading of their own; ``facing="eye"`` costs none. With
        ``ghost=0``, as for the steps of a series, each piece is a whole. ``"outward"`` is not known
        of open surfaces in pieces.

    Returns
    -------
    Lit
        Path of the index, and what the pieces have in common.

    Raises
    ------
    TypeError, ValueError
        If an argument or an option does not fit.
    PieceError
        If a piece is missing or damaged, has other arrays than the first, or cannot be lit or
        written; the message begins with its name. An earlier result then stays as it was.

    Warns
    -----
    UserWarning
        Once, with the count, if points could not be lit; once, with the share in all pieces, if
        light was averaged across many sharp edges; once for each other warning of the filter that
        most pieces give.

    Notes
    -----
    Light of a piece equals the light of the whole by the same options within 1e-6, normals on
    borders, sides and the ends of a depth cue included. The memory of a
    process is bounded by its piece with its ghost cells, one neighbour at a time (all of them with
    ``ghost`` above 1), and the result: 0.55 GB for slabs of 64 MB of a file of any size. The files
    move to their place when all are written, so that a worker that is killed leaves no part of one;
    its piece is lit by another, with the same bits. Compiled code is used only with
    ``VIZLIGHT_FAST=1``, so that every worker computes alike.

    Examples
    --------
    >>> import tempfile, pyvista as pv, vizlight
    >>> folder = tempfile.mkdtemp()
    >>> for i in range(2):
    ...     pv.Sphere(center=(i, 0, 0)).save(f"{folder}/part{i}.vtp")
    >>> scene = vizlight.Scene(view=vizlight.View(direction=(0, 0, 1)))
    >>> lit = vizlight.pieces.light(f"{folder}/*.vtp", scene, out=f"{folder}/lit.pvtp")
    >>> len(lit.files), lit.points
    (2, 1684)
    """
    _check.instance("scene", scene, Scene)
    path = files.check_output(_check.path("out", out), tuple(INDEX.values()), name="out")
    ghost = _check.integer("ghost", ghost, low=0)
    job = job_of(
        contour,
        level,
        scene=scene,
        filter=filter,
        options=_common_options(filter, options, contour, ghost),
        ghost=ghost if filter == "illuminate" else 0,
        suffix={own: suffix for suffix, own in INDEX.items()}[path.suffix.lower()],
        compiled="1" if _compiled.wanted() == "1" else "0",
        # Workers share the processors.
        threads=_pool.workers() if checked(map) is builtins.map else 1,
    )
    retries = _check.integer("retries", retries, low=0)
    parts = pieces_of(sources, _check.positive("slab", slab))
    work = Work(map, retries, progress_bar)
    folder = path.with_suffix("")
    drafts = folder / f".vizlight-{uuid.uuid4().hex[:12]}"
    files.make_folder("out", drafts)
    try:
        parts, job = prepared(parts, job, work)
        targets = [drafts / f"{path.stem}_{i:04d}" for i in range(len(parts))]
        outputs = [folder / f"{target.name}{job.suffix}" for target in targets]
        _spare_sources(parts, path, outputs)
        job, told = _told(parts, job, work)
        calls = [*zip(parts, [job] * len(parts), targets, told, strict=True)]
        done: list[Done] = []
        with report.workers(lambda: sum(one.points for one in done)):
            done += work.each(task.light, calls, "light")
        full = [(piece, one) for piece, one in zip(parts, done, strict=True) if one.file]
        if not full:
            raise nothing_found(parts, job, work)
        first, made = full[0]
        for piece, one in full[1:]:
            check_alike(piece, one.arrays | one.grid, first, made.arrays | made.grid)
        earlier = _named_by(path, folder)
        for _, one in full:
            (drafts / one.file).replace(folder / one.file)
        index.write(path, [one for _, one in full], folder.name, job.name)
        for name in earlier - {one.file for _, one in full}:
            (folder / name).unlink()
    finally:
        _clear(folder)
    return _result(path, folder, done, job)


def _common_options(
    filter_name: str, options: Keywords, contour: str | None, ghost: int
) -> Keywords:
    """Return the options of a filter that give a piece no opinion of its own."""
    _check.choice("filter", filter_name, tuple(task.FILTERS))
    for name, remedy in WHOLE.items():
        if options.get(name):
            raise ValueError(_check.message(name, "no such option for pieces", "one", remedy))
    function: Foreign = task.FILTERS[filter_name]
    known = [*inspect.signature(function).parameters]
    for name in options:
        if name not in known or name in ("inplace", "progress_bar"):
            raise TypeError(unknown_option(filter_name, name, known))
    if filter_name != "illuminate":
        return dict(options)
    for name in ("tangents", "normals", "conditioned"):
        if options.get(name) is not None and not isinstance(options[name], str | bool):
            expected = "the name of a point array that every piece has"
            raise TypeError(_check.message(name, expected, _check.describe(options[name])))
    fields = {one.name for one in dataclasses.fields(LightOptions)}
    asked = LightOptions(**{name: value for name, value in options.items() if name in fields})
    if asked.facing == "outward":
        remedy = "what is closed faces outward by facing='auto'"
        expected = "'auto', 'eye' or 'as given'"
        raise ValueError(_check.message("facing", expected, "'outward'", remedy))
    if options.get("normals") == task.GRADIENT and contour is not None and not ghost:
        raise ValueError(_check.message("ghost", "1 at least beside normals='gradient'", ghost))
    return dict(options)


def _told(parts: list[Piece], job: Job, work: Work) -> tuple[Job, list[Told | None]]:
    """Return the job, and what the whole decides of the sides of each piece, where it does."""
    asked = LightOptions.of(job.options)
    told: list[Told | None] = [None] * len(parts)
    sharp = asked.feature_angle == "auto"
    if not job.ghost or not (asked.facing == "auto" or sharp):
        return job, told  # without neighbours each piece is a whole
    if asked.tangents is not None and asked.conditioned is not True:
        return job, told
    found = work.each(task.look, [(piece, job) for piece in parts], "sides")
    at = [i for i, one in enumerate(found) if one is not None]
    looks = [one for one in found if one is not None]
    if sharp:
        angle = SHARP if looks and sides.creases(looks) else None
        job = dataclasses.replace(job, options={**job.options, "feature_angle": angle})
    if asked.facing == "auto" and looks:
        for i, one in zip(at, sides.decided(looks), strict=True):
            told[i] = one
    return job, told


def _spare_sources(parts: Sequence[Piece], path: Path, outputs: Sequence[Path]) -> None:
    """Check that no source would be replaced, or removed as a piece of an earlier run."""
    taken = {output.resolve() for output in (path, *outputs)}
    folder, own = outputs[0].resolve().parent, _own_pieces(path.stem)
    for piece in parts:
        source = getattr(piece, "path", None)
        source = None if source is None else source.resolve()
        earlier = source is not None and source.parent == folder and own.fullmatch(source.name)
        if source in taken or earlier:
            expected = "another name than the sources'"
            raise PieceError(_check.message("out", expected, f"'{path}'"))


def _own_pieces(stem: str) -> re.Pattern[str]:
    """Return the pattern of the names of pieces."""
    return re.compile(re.escape(stem) + r"_\d{4,}\.vt[puirs]")


def _named_by(path: Path, folder: Path) -> set[str]:
    """Return the names of the pieces of an earlier run, in its folder, that its index names."""
    own = _own_pieces(path.stem)
    try:
        found = index_files(path)
    except PieceError:  # there is none, or its pieces are gone
        return set()
    return {file.name for file in found if file.parent == folder and own.fullmatch(file.name)}


def _clear(folder: Path) -> None:
    """Remove drafts, also from runs that were killed, and the folder if nothing is in it."""
    for draft in folder.glob(".vizlight-*"):
        shutil.rmtree(draft, ignore_errors=True)
    with contextlib.suppress(OSError):  # it holds pieces
        folder.rmdir()


def _result(path: Path, folder: Path, done: Sequence[Done], job: Job) -> Lit:
    """Return the result, and warn once of what the workers warned of."""
    full = [one for one in done if one.file]
    points, invalid = sum(one.points for one in full), sum(one.invalid for one in full)
    if invalid:
        _check.warn(f"{unlit(invalid, points)}; the point array '{job.name}_valid' marks them")
    for note, count in Counter(note for one in full for note in set(one.notes)).items():
        # Of the shape of the whole a single piece knows too little.
        if 2 * count > len(full):
            _check.warn(f"{note} ({count} of {len(done)} pieces)")
    sharp = sum((one.sharp or 0.0) * one.cells for one in full)
    sharp /= max(sum(one.cells for one in full), 1)
    normals.warn_of_edges(sharp, splits=job.suffix == ".vtp")
    names = {name for one in full for name in one.ranges}
    return Lit(
        path=path,
        files=tuple(folder / one.file for one in full),
        points=points,
        cells=sum(one.cells for one in full),
        bounds=union([one.bounds for one in full]),
        ranges={
            name: (
                min(one.ranges[name][0] for one in full if name in one.ranges),
                max(one.ranges[name][1] for one in full if name in one.ranges),
            )
            for name in sorted(names)
        },
        scene=job.scene,
        level=job.level,
        empty=len(done) - len(full),
    )
