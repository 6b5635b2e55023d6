"""Meshes at rising times, from a list, a file, or a reader, one read at a time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

from vizlight import _check
from vizlight._types import Foreign
from vizlight.mesh import blocks, dates, meaning
from vizlight.vtk.arrays import vectors_of


class Series:
    """Meshes with the same points at rising times.

    The source is a sequence of meshes, a reader of PyVista with ``time_values``, or the path of a
    file that has one; times of a sequence are by default the field arrays ``TimeValue``.
    """

    def __init__(self, source: object, times: object = None) -> None:
        self._meshes: Sequence[Foreign] | None = None
        self._reader: Foreign = None
        if isinstance(source, str | Path):
            path, reason = _check.path("series", source), ""
            try:
                source = reader_of(path)
            # A file that is missing gets the same message as one without a reader, with its reason
            # added.
            except OSError as error:
                source, reason = None, f" ({error})"
            if source is None:
                expected, got = "the path of a file that PyVista reads", f"'{path}'{reason}"
                raise _check.value_error("series", expected, got)
        # By its method, not its class: the wrappers of VTK's readers below are no readers of
        # PyVista.
        if hasattr(source, "read"):
            if times is not None:
                remedy = "leave times= out"
                raise _check.value_error("times", "the times of the reader", "both", remedy)
            self._reader, times = source, times_of(source)
        # A MultiBlock is a sequence, too: its blocks are then the steps.
        elif isinstance(source, Sequence):
            self._meshes = source
            times = _own_times(source) if times is None else times
        else:
            expected = "meshes, a reader with time values, or the path of its file"
            raise _check.type_error("series", expected, source)
        #: Times of the steps, shape (S,).
        self.times = _check.floats("times", times).astype(np.float64)
        if self._meshes is not None and self.times.shape != (len(self._meshes),):
            expected = f"{len(self._meshes)} times, one for each mesh"
            raise _check.value_error("times", expected, f"shape {self.times.shape}")
        if len(self.times) < 2:
            raise _check.value_error("series", "two steps or more", str(len(self.times)))
        # A difference with NaN is not above 0, so NaN counts as a fall, too.
        finite = np.isfinite(self.times)
        falls = np.flatnonzero(~(np.diff(self.times) > 0) | ~finite[1:] | ~finite[:-1])
        if len(falls):
            got = f"{self.times[falls[0]]:g} before {self.times[falls[0] + 1]:g}"
            raise _check.value_error("times", "finite times that rise", got)
        # The first mesh stays in memory: the points of all others are compared with its points.
        self._first: pv.DataSet | None = None

    def mesh(self, step: int) -> pv.DataSet:
        """Return the mesh of a step, which has the points of the first."""
        if self._meshes is not None:
            mesh = self._meshes[step]
        else:
            mesh = at(self._reader, float(self.times[step]))
        # Readers of .pvd wrap a single mesh in blocks, too; joining would make another type of it.
        if isinstance(mesh, pv.MultiBlock):
            mesh = mesh[0] if len(mesh) == 1 else blocks.joined(mesh)
        name = self.name(step)
        if not isinstance(mesh, pv.DataSet) or not mesh.n_cells:
            raise _check.type_error(name, "a mesh with cells", mesh)
        if self._first is None:
            self._first = mesh if step == 0 else self.mesh(0)
        first = self._first
        # Exactly equal: particles are carried in the cells of the first mesh by the vectors of all
        # steps.
        same = mesh.n_points == first.n_points and mesh.n_cells == first.n_cells
        if not same or not np.array_equal(mesh.points, first.points):
            expected = f"the {first.n_points} points of {self.name(0)}"
            remedy = "sample all steps to one mesh by mesh.sample(step)"
            got = f"{mesh.n_points} points" + (", others" if same else "")
            raise _check.value_error(name, expected, got, remedy)
        return mesh

    def vectors(self, step: int, array: str) -> NDArray[np.float64]:
        """Return the vectors of a step, zero where they are not finite."""
        mesh, name = self.mesh(step), f"tangents, {self.name(step)}"
        mesh = meaning.with_named(mesh, array)[0]
        if array not in mesh.point_data:
            there = ", ".join(map(repr, mesh.point_data)) or "none"
            expected = f"the point array {array!r} ({there})"
            raise _check.value_error(name, expected, "none of that name")
        rows = vectors_of(mesh, name, array, 3)
        # NaN at one point would reach all cells around it by interpolation; 0 brings particles to
        # rest.
        return np.where(np.isfinite(rows), rows, 0.0).astype(np.float64)

    def name(self, step: int) -> str:
        """Return the name of a step in messages."""
        return f"series[{step}] (time {self.times[step]:g})"


def _own_times(meshes: Sequence[Foreign]) -> list[float]:
    missing = [i for i, mesh in enumerate(meshes) if TIME not in getattr(mesh, "field_data", {})]
    if missing:
        expected = f"times=, or meshes with the field array {TIME!r}"
        raise _check.value_error("times", expected, f"none at series[{missing[0]}]")
    return [float(np.asarray(mesh.field_data[TIME]).ravel()[0]) for mesh in meshes]


#: Field array in which PyVista and VTK keep the time of a mesh.
TIME = "TimeValue"
#: Field array with the times of all steps of the file of a mesh.
STEPS = "TimeSteps"
#: Largest number of times that a message lists.
LISTED = 8
#: Largest deviation of a time from a step's, as a share of the largest time.
SAME = 1e-6


class NoStepError(ValueError):
    """A file has no step of the time that was asked for."""


def chosen(times: Sequence[float], time: object, name: str = "time") -> int:
    """Return the index of a step, or of a place along another axis.

    ``time`` is the time of a step, ``"last"``, the default, ``"first"`` or, if it is an integer and
    no time of a step, the index of a step, from the end if negative. ``name`` stands in errors.
    """
    count = len(times)
    if time is None or time == "last":
        return count - 1
    if time == "first":
        return 0
    try:
        number = float(time)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        # Words are near no time and are no index, so that the error at the end names them.
        number = np.nan
    off = np.abs(np.asarray(times, dtype=float) - number)
    # A time that was written as text is rounded. Times come before indices: of steps at 0, 0.5 and
    # 1 the number 1 is the last, not the second.
    if count and np.nanmin(off, initial=np.inf) <= SAME * np.max(np.abs(times)):
        return int(np.nanargmin(off))
    if number == np.floor(number) and -count <= number < count:
        return int(number) % count
    noun = "a time of a step" if name == "time" else "a value"
    expected = f"{noun}, {listed(times)}, an index from 0 to {count - 1}, or last"
    got = f"{number:g}" if np.isfinite(number) else repr(time)
    remedy = f"the nearest is {times[int(np.nanargmin(off))]:g}" if np.isfinite(off).any() else ""
    raise NoStepError(_check.message(name, expected, got, remedy))


def listed(times: Sequence[float]) -> str:
    """Return the times of steps in words."""
    words = [f"{time:g}" for time in times]
    if len(words) > LISTED:
        words = [*words[: LISTED - 1], "...", words[-1]]
    return ", ".join(words)


def marked(mesh: Foreign, times: Sequence[float], index: int) -> Foreign:
    """Attach the time of a step, and the times of all steps of the file."""
    # As field data the times stay with the mesh in filters and files, where its reader is gone.
    mesh.field_data[TIME] = [float(times[index])]
    mesh.field_data[STEPS] = [float(time) for time in times]
    return mesh


def of(mesh: pv.DataSet) -> list[float]:
    """Return the times of all steps of the file of a mesh, none where it had no steps."""
    return [float(time) for time in mesh.field_data[STEPS]] if STEPS in mesh.field_data else []


def note(mesh: pv.DataSet) -> str:
    """Return a note on the last step, which was taken by default."""
    times = of(mesh)
    if len(times) < 2:
        return ""
    when = dates.date(times[-1], meaning.of(mesh).time)
    last = f"time {when or format(times[-1], 'g')}, the last of {len(times)} steps"
    return f"{last}; --time takes another, --times all of them one by one"


def missing_of_foam(file: BinaryIO) -> str:
    """Return the fault of the boundary of an open OpenFOAM case for which VTK's reader waits."""
    boundary = Path(file.name).parent / "constant" / "polyMesh" / "boundary"
    text = boundary.read_bytes() if boundary.is_file() else b""
    return "the text of its boundary has bytes of 0" if b"\0" in text else ""


def is_case(folder: Path) -> bool:
    """Return whether a path is the folder of an OpenFOAM case.

    It has ``constant``, and ``system``, a time ``0``, a mesh, or pieces of a parallel run.
    """
    places = ("system", "0", "constant/polyMesh", "processor0")
    return (folder / "constant").is_dir() and any((folder / place).is_dir() for place in places)


def reader_of(path: Path) -> Foreign:
    """Return PyVista's reader of a file, None where meshio or another package reads it."""
    # A .foam file is empty and marks the folder of a case. A case that ran in parallel has its mesh
    # in processor0, processor1 and so on, until its parts are put together.
    has_mark = path.suffix.lower() == ".foam"
    case = path.parent if has_mark else path
    is_whole = (case / "constant" / "polyMesh").is_dir()
    in_parts = not is_whole and (case / "processor0").is_dir()
    if is_case(path) or (has_mark and in_parts):
        # PyVista's reader needs the mark, and reports that the whole is missing.
        from vtkmodules.vtkIOParallel import vtkPOpenFOAMReader

        kind = vtkPOpenFOAMReader
        reader_of_case = kind()
        reader_of_case.SetCaseType(kind.DECOMPOSED_CASE if in_parts else kind.RECONSTRUCTED_CASE)
        return _OfVtk(reader_of_case, case / "case.foam")
    try:
        reader: Foreign = pv.get_reader(path)  # type: ignore[no-untyped-call]
    except ValueError:
        return None
    except TypeError:
        # PyVista's reader of XDMF fails without times, as in a mesh that FEniCS writes.
        from vtkmodules.vtkIOXdmf2 import vtkXdmfReader

        return _OfVtk(vtkXdmfReader(), path)
    return reader


class _OfVtk:
    """Reader of VTK that has not PyVista's wrapper."""

    def __init__(self, reader: Foreign, path: Path) -> None:
        self.reader = reader
        self.reader.SetFileName(str(path))

    def read(self) -> Foreign:
        """Return the blocks of the step that was asked for."""
        self.reader.Update()
        return pv.wrap(self.reader.GetOutputDataObject(0))


def times_of(reader: Foreign) -> list[float]:
    """Return the times of the steps of a reader, none where its file has no time."""
    if hasattr(reader, "time_values"):
        return [float(time) for time in reader.time_values]
    inner: Foreign = getattr(reader, "reader", None)
    if not hasattr(inner, "GetOutputInformation"):
        return []
    # VTK's pipeline tells the times in a pass of its own, before any data are read.
    inner.UpdateInformation()
    times = inner.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    # VTK has no such key where a file has no times.
    return [float(time) for time in times or ()]


def at(reader: Foreign, time: float) -> Foreign:
    """Return the mesh of a reader at a time."""
    if hasattr(reader, "set_active_time_value"):
        reader.set_active_time_value(time)
    else:
        # The request stays in the pipeline, so that the read below gives this step.
        reader.reader.UpdateTimeStep(time)
    return unchecked(reader)


def unchecked(reader: Foreign) -> Foreign:
    """Return the mesh of a reader, without PyVista's warning of arrays that are then refused."""
    return reader.read(validate=False) if isinstance(reader, pv.BaseReader) else reader.read()


def check_single(path: Path, time: object) -> None:
    """Raise NoStepError for another step of a file of one mesh than the first or the last."""
    if time not in (None, "first", "last"):
        raise NoStepError(_check.message("time", "a file of several steps", f"'{path.name}'"))


def read(path: Path, time: object) -> pv.DataObject | None:
    """Return the mesh of a file, of a step if it has steps; None where VTK has no reader.

    ``time`` is as for :func:`chosen`.
    """
    reader = reader_of(path)
    times = times_of(reader)
    if reader is None or not times:
        check_single(path, time)
        return None if reader is None else unchecked(reader)
    index = chosen(times, time)
    mesh: pv.DataObject = marked(at(reader, times[index]), times, index)
    return mesh
