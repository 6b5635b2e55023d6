"""Light data in pieces: one after the other, by processes, or on a cluster of Dask."""

from __future__ import annotations

import builtins
import contextlib
import dataclasses
import inspect
import re
import shutil
import uuid
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight import _check, _pool, writing
from vizlight._types import Foreign, Given, Keywords
from vizlight.draw import cameras
from vizlight.filters import lighting
from vizlight.mesh import normals
from vizlight.pieces import task
from vizlight.pieces.sources import (
    INDEX,
    SUFFIX,
    FilePiece,
    Piece,
    PieceError,
    index_files,
    pieces_of,
)
from vizlight.pieces.task import Job, PieceSummary
from vizlight.pieces.workers import RETRIES, Map, RetryingMap
from vizlight.scene import Scene
from vizlight.scene.keywords import unknown_option
from vizlight.scene.presets import AnyScene, required_scene
from vizlight.shading.options import LightOptions
from vizlight.shading.results import unlit
from vizlight.vtk import sides
from vizlight.vtk.corners import SHARP
from vizlight.vtk.normals import Vote


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
    scene: AnyScene,
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
        Files, patterns such as ``"run/*.vtu"``, indices (.pvtu, .pvtp, .vtm), which name the files
        of pieces, VTKHDF files, with a piece for each partition, and structured grids (.vti, .vtr,
        .vts, .pvti, .pvtr, .pvts and :class:`Slabs`), which are cut in slabs.
    scene : Scene
        Lights, material and view. The ends of a depth cue that are not given are taken from the
        bounding box of all pieces.
    filter : {"illuminate", "streamlines"}
        Filter of vizlight. Streamlines end where their piece ends, and ``seeds`` counts the seeds
        of each piece.
    contour : str, optional
        Name of a point array of one component, to light an isosurface of it.
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
        Callable that applies a function to each piece: ``map``, one after the other in this
        process; :class:`vizlight.pieces.Processes`; a ``ProcessPoolExecutor`` or its ``map``; or a
        ``distributed.Client`` of Dask, with workers that see the same files.
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
        Path of the index, and facts about all pieces.

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
    scene = required_scene(scene)
    path = writing.check_output(_check.path("out", out), tuple(INDEX.values()), name="out")
    ghost = _check.integer("ghost", ghost, low=0)
    _check_options(filter, options, contour, ghost)
    job = task.Job(
        contour=contour,
        level=level,
        scene=scene,
        filter=filter,
        options=options,
        # Streamlines end where their piece ends, and need no cells of others.
        ghost=ghost if filter == "illuminate" else 0,
        suffix={ending: suffix for suffix, ending in INDEX.items()}[path.suffix.lower()],
        # Workers share the processors.
        threads=_pool.workers() if map is builtins.map else 1,
    )
    work = RetryingMap(map, retries, progress_bar)
    parts = pieces_of(sources, _check.positive("slab", slab))
    folder = path.with_suffix("")
    # The pieces are written here, and moved to their place when all of them are whole.
    drafts = folder / f".vizlight-{uuid.uuid4().hex[:12]}"
    writing.make_folder("out", drafts)
    try:
        parts, job = _prepared(parts, job, work)
        targets = [drafts / f"{path.stem}_{i:04d}" for i in range(len(parts))]
        outputs = [folder / f"{target.name}{job.suffix}" for target in targets]
        _spare_sources(parts, path, outputs)
        job, whole_sides = _with_sides(parts, job, targets, work)
        calls = [*zip(parts, [job] * len(parts), targets, whole_sides, strict=True)]
        done: list[PieceSummary] = work.each(task.light, calls, "light")
        full = [(piece, facts) for piece, facts in zip(parts, done, strict=True) if facts.file]
        if not full:
            raise _nothing_found(parts, job, work)
        first, reference = full[0]
        # The index states the arrays of the first piece for all of them.
        for piece, facts in full[1:]:
            _check_alike(piece, facts.arrays | facts.grid, first, reference.arrays | reference.grid)
        # Read before the index is replaced.
        earlier = _named_by(path, folder)
        for _, facts in full:
            (drafts / facts.file).replace(folder / facts.file)
        _write_index(path, [facts for _, facts in full], folder.name, job.name)
        # Pieces that only the earlier index named belong to no mesh any more.
        for name in earlier - {facts.file for _, facts in full}:
            (folder / name).unlink()
    finally:
        # Drafts of runs that were killed, too.
        for draft in folder.glob(".vizlight-*"):
            shutil.rmtree(draft, ignore_errors=True)
        with contextlib.suppress(OSError):  # it holds pieces
            folder.rmdir()
    return _result(path, folder, done, job)


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
        As for :func:`light`. All pieces are read, and contoured, once more for it.
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
    job = task.Job(contour=contour, level=level)
    options: Keywords = {"up": up, "parallel": parallel, "zoom": zoom, "aspect": aspect}
    cameras.camera_on((0, 1) * 3, direction, **options)  # checks them before anything is read
    parts = pieces_of(sources, _check.positive("slab", slab))
    work = RetryingMap(map, RETRIES, progress_bar)
    if job.contour is not None and job.level is None:
        job = _with_level(job, job.contour, _surveyed(parts, job, work))
    calls = [(piece, job, direction, up, aspect) for piece in parts]
    # Each worker sends only the few points on which a camera depends.
    outer_points = work.each(task.outermost, calls, "camera")
    points = np.concatenate([np.asarray(some, dtype=np.float64) for some in outer_points])
    if not len(points):
        raise _nothing_found(parts, job, work)
    return cameras.camera_on(pv.PolyData(points), direction, **options)


def _check_options(filter_name: str, options: Keywords, contour: str | None, ghost: int) -> None:
    """Check that the options of a filter give a piece no opinion of its own."""
    _check.choice("filter", filter_name, tuple(task.FILTERS))
    if options.get("bundle"):  # it depends on a mesh as a whole
        remedy = "lines of all pieces dim one another; light them together"
        raise _check.value_error("bundle", "no such option for pieces", "one", remedy)
    function: Foreign = task.FILTERS[filter_name]
    parameters = [*inspect.signature(function).parameters]
    for name in options:
        if name not in parameters or name in ("inplace", "progress_bar"):
            raise TypeError(unknown_option(filter_name, name, parameters))
    if filter_name != "illuminate":
        return
    for name in ("tangents", "normals", "conditioned"):
        if options.get(name) is not None and not isinstance(options[name], str | bool):
            expected = "the name of a point array that every piece has"
            raise _check.type_error(name, expected, options[name])
    light_options = LightOptions.of(options)
    if light_options.facing == "outward":
        remedy = "what is closed faces outward by facing='auto'"
        expected = "'auto', 'eye' or 'as given'"
        raise _check.value_error("facing", expected, "'outward'", remedy)
    # At a border without neighbours the gradient would be one-sided.
    if options.get("normals") == task.GRADIENT and contour is not None and not ghost:
        raise _check.value_error("ghost", "1 at least beside normals='gradient'", ghost)


def _with_sides(
    parts: list[Piece], job: Job, targets: Sequence[Path], work: RetryingMap
) -> tuple[Job, list[Vote | None]]:
    """Return the job, and the sides of each piece where all pieces together decide them."""
    light_options = LightOptions.of(job.options)
    decisions: list[Vote | None] = [None] * len(parts)
    sharp = light_options.feature_angle == "auto"
    if not job.ghost or not (light_options.facing == "auto" or sharp):
        return job, decisions  # without neighbours each piece is a whole
    # Pieces lit by tangents alone have no sides.
    if light_options.tangents is not None and light_options.conditioned is not True:
        return job, decisions
    calls = [(piece, job, target) for piece, target in zip(parts, targets, strict=True)]
    answers = work.each(task.look, calls, "sides")
    looks = {i: look for i, look in enumerate(answers) if look is not None}
    if sharp:
        # The angle is one for all pieces: their common borders would not fit if some were split
        # alone.
        angle = SHARP if looks and sides.creases([*looks.values()]) else None
        job = dataclasses.replace(job, options={**job.options, "feature_angle": angle})
    if light_options.facing == "auto" and looks:
        for i, decision in zip(looks, sides.decided([*looks.values()]), strict=True):
            decisions[i] = decision
    return job, decisions


def _spare_sources(parts: Sequence[Piece], path: Path, outputs: Sequence[Path]) -> None:
    """Check that no source would be replaced, or removed as a piece of an earlier run."""
    taken = {output.resolve() for output in (path, *outputs)}
    folder, pattern = outputs[0].resolve().parent, _own_pieces(path.stem)
    for piece in parts:
        origin = piece.path if isinstance(piece, FilePiece) else piece.source
        if not isinstance(origin, Path):
            continue
        source = origin.resolve()
        # A source that is named like a piece may be taken for one of an earlier run, and removed.
        if source in taken or (source.parent == folder and pattern.fullmatch(source.name)):
            raise PieceError(_check.message("out", "another name than the sources'", f"'{path}'"))


def _own_pieces(stem: str) -> re.Pattern[str]:
    """Return the pattern of the names of pieces."""
    return re.compile(re.escape(stem) + r"_\d{4,}\.vt[puirs]")


def _named_by(path: Path, folder: Path) -> set[str]:
    """Return the names of the pieces of an earlier run, in its folder, that its index names."""
    pattern = _own_pieces(path.stem)
    try:
        paths = index_files(path)
    except PieceError:  # there is none, or its pieces are gone
        return set()
    return {file.name for file in paths if file.parent == folder and pattern.fullmatch(file.name)}


def _result(path: Path, folder: Path, done: Sequence[PieceSummary], job: Job) -> Lit:
    """Return the result, and repeat each warning of the workers once."""
    full = [facts for facts in done if facts.file]
    points = sum(facts.points for facts in full)
    invalid = sum(facts.invalid for facts in full)
    names = sorted({name for facts in full for name in facts.ranges})
    if invalid:
        _check.warn(f"{unlit(invalid, points)}; the point array '{job.name}_valid' marks them")
    for note, count in Counter(note for facts in full for note in set(facts.notes)).items():
        # Of the shape of the whole a single piece knows too little.
        if 2 * count > len(full):
            _check.warn(f"{note} ({count} of {len(done)} pieces)")
    # Weighed by cells, the mean is nearly the share of the whole.
    sharp = sum((facts.sharp or 0.0) * facts.cells for facts in full)
    sharp /= max(sum(facts.cells for facts in full), 1)
    normals.warn_of_edges(sharp, splits=job.suffix == ".vtp")
    boxes = np.array([facts.bounds for facts in full])
    ends = {name: [facts.ranges[name] for facts in full if name in facts.ranges] for name in names}
    return Lit(
        path=path,
        files=tuple(folder / facts.file for facts in full),
        points=points,
        cells=sum(facts.cells for facts in full),
        bounds=tuple(np.where(np.arange(6) % 2, boxes.max(axis=0), boxes.min(axis=0)).tolist()),
        ranges={name: (min(ends[name])[0], max(high for _, high in ends[name])) for name in ends},
        scene=job.scene,
        level=job.level,
        empty=len(done) - len(full),
    )


def _nothing_found(parts: list[Piece], job: Job, work: RetryingMap) -> PieceError:
    """Return the error of pieces without a point to light."""
    if job.contour is None:
        expected = "pieces with something to light"
        return PieceError(_check.message("sources", expected, "no points"))
    low, high = _ends([facts for _, facts in _surveyed(parts, job, work)], job.contour)
    expected = f"a value between {low:g} and {high:g}"
    return PieceError(_check.message("level", expected, f"{job.level:g}"))


def _prepared(parts: list[Piece], job: Job, work: RetryingMap) -> tuple[list[Piece], Job]:
    """Return pieces that know their neighbours, and a job without a question left open."""
    cue = job.scene.depth_cue
    open_cue = cue is not None and (cue.front is None or cue.back is None)
    # Pieces of files find their neighbours by their boxes, which are not known before a reading.
    loose = any(isinstance(piece, FilePiece) for piece in parts)
    if not (loose or open_cue or (job.contour is not None and job.level is None)):
        return parts, job
    pairs = _surveyed(parts, job, work)
    boxes = np.array([facts.bounds for _, facts in pairs]).reshape(-1, 3, 2)
    if job.contour is not None and job.level is None:
        job = _with_level(job, job.contour, pairs)
    # The depth belongs to the isosurface, if there is one, whose level is known by now.
    if open_cue:
        calls = [(piece, job) for piece, _ in pairs]
        ends = work.each(task.depths, calls, "depth")
        job = dataclasses.replace(job, scene=lighting.with_depth_ends(job.scene, ends))
    return _neighbours([piece for piece, _ in pairs], boxes, job.ghost), job


def _surveyed(parts: list[Piece], job: Job, work: RetryingMap) -> list[tuple[Piece, PieceSummary]]:
    """Return the pieces with points, which have arrays of the same types, and their summaries."""
    calls = [(piece, job.contour) for piece in parts]
    summaries = work.each(task.survey, calls, "survey")
    pairs = [(piece, facts) for piece, facts in zip(parts, summaries, strict=True) if facts.points]
    if not pairs:
        raise PieceError(_check.message("sources", "pieces with points", "none"))
    first_piece, first = pairs[0]
    for piece, facts in pairs[1:]:
        _check_alike(piece, facts.arrays, first_piece, first.arrays)
        if facts.lines != first.lines and _by_faces(job):
            # A whole of both is lit by its faces, and a piece of lines alone by their tangents.
            expected = f"{'lines' if first.lines else 'faces'} as in {first_piece.name}"
            got, remedy = "lines alone" if facts.lines else "faces", "light lines by themselves"
            text = _check.message("sources", expected, got, remedy)
            raise PieceError(f"piece {piece.name}: {text}")
    return pairs


def _with_level(job: Job, contour: str, pairs: list[tuple[Piece, PieceSummary]]) -> Job:
    """Return a job with the level in the middle of the range of the contoured array."""
    return dataclasses.replace(job, level=sum(_ends([facts for _, facts in pairs], contour)) / 2)


def _by_faces(job: Job) -> bool:
    """Return whether light depends on faces where a mesh has some."""
    options = job.options
    tangents = options.get("tangents") is not None and options.get("conditioned") is not True
    return job.contour is None and job.filter == "illuminate" and not tangents


def _ends(summaries: Sequence[PieceSummary], contour: str) -> tuple[float, float]:
    """Return the range of the contoured array over all pieces."""
    arrays = summaries[0].arrays
    # A key is "point NAME", and the type of several components has their number behind an x.
    names = [key[6:] for key in arrays if key.startswith("point ") and " x " not in arrays[key]]
    ends = [facts.ranges[contour] for facts in summaries if contour in facts.ranges]
    if contour not in names or not ends:
        expected = f"a point array of one component, {_check.one_of(names)}"
        raise _check.value_error("contour", expected, repr(contour))
    return min(low for low, _ in ends), max(high for _, high in ends)


def _check_alike(piece: Piece, arrays: Keywords, first: Piece, expected: Keywords) -> None:
    """Check that a piece has the arrays of the first, and that both are boxes of one grid."""
    for name in expected | arrays:
        here, there = arrays.get(name), expected.get(name)
        if here != there:
            kind, _, array_name = name.partition(" ")
            what = f"{kind} array {array_name!r}" if array_name else kind
            wanted = f"the {what} of {there}" if there else f"no {what}"
            text = _check.message("sources", f"{wanted} as in {first.name}", here or "none")
            raise PieceError(f"piece {piece.name}: {text}")


def _neighbours(parts: list[Piece], boxes: Foreign, ghost: int) -> list[Piece]:
    """Return the pieces; pieces of files come with the pieces of boxes that touch theirs."""
    if not ghost:
        return parts
    linked: list[Piece] = []
    for i, piece in enumerate(parts):
        if not isinstance(piece, FilePiece):
            linked.append(piece)
            continue
        # Boxes that only touch may have points in common on their border.
        touch = np.all((boxes[:, :, 0] <= boxes[i, :, 1]) & (boxes[:, :, 1] >= boxes[i, :, 0]), 1)
        beside = [parts[j] for j in np.flatnonzero(touch) if j != i]
        file_pieces = tuple(neighbour for neighbour in beside if isinstance(neighbour, FilePiece))
        linked.append(dataclasses.replace(piece, beside=file_pieces))
    return linked


def _write_index(path: Path, pieces: Sequence[PieceSummary], folder: str, scalars: str) -> Path:
    """Write the file that names lit pieces, which VTK and ParaView read as one mesh."""
    first = pieces[0]
    suffix = Path(first.file).suffix
    # The parallel types of VTK's XML are the serial ones with a P before them.
    kind = "P" + next(kind for kind, extension in SUFFIX.items() if extension == suffix)
    root = ET.Element("VTKFile", type=kind, version="1.0", byte_order="LittleEndian")
    # Ghost cells were cut off before the pieces were written.
    grid = ET.SubElement(root, kind, GhostLevel="0")
    active = {"Scalars": scalars}
    if {piece.normals for piece in pieces} == {first.normals} and first.normals:
        active["Normals"] = first.normals
    for name, data in (("point", "PPointData"), ("cell", "PCellData")):
        element = ET.SubElement(grid, data, active if name == "point" else {})
        for key, type_ in first.arrays.items():
            if key.startswith(f"{name} "):
                _array(element, key.partition(" ")[2], type_)
    if "points " in first.arrays:
        _array(ET.SubElement(grid, "PPoints"), "Points", first.arrays["points "])
    if kind == "PRectilinearGrid":
        axes = ET.SubElement(grid, "PCoordinates")
        for axis in "xyz":
            _array(axes, axis, "float64")
    if first.extent:
        # An extent is the first and the last node along each axis in turn.
        whole = [
            (min, max)[i % 2](piece.extent[i] for piece in pieces if piece.extent) for i in range(6)
        ]
        grid.set("WholeExtent", " ".join(map(str, whole)))
        for name, values in first.grid.items():
            # ``repr`` keeps all digits of a float, so that the pieces fit each other.
            grid.set(name, " ".join(map(repr, values)))
    for piece in pieces:
        element = ET.SubElement(grid, "Piece", Source=f"{folder}/{piece.file}")
        if piece.extent:
            element.set("Extent", " ".join(map(str, piece.extent)))
    ET.indent(root)
    return writing.replace_file(path, ET.ElementTree(root).write)


def _array(parent: ET.Element, name: str, type_: str) -> None:
    type_name, _, components = type_.partition(" x ")
    kind = "String"
    if type_name != "text":
        dtype = np.dtype(type_name)
        family = {"f": "Float", "i": "Int"}.get(dtype.kind, "UInt")
        kind = f"{family}{8 * dtype.itemsize}"
    ET.SubElement(parent, "PDataArray", type=kind, Name=name, NumberOfComponents=components or "1")
