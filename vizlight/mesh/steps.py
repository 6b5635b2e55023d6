"""Files of several time steps: which there are, and the mesh of one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOParallel import vtkPOpenFOAMReader
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader

from vizlight import _check

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from vizlight._types import Foreign

__all__ = [
    "STEPS",
    "TIME",
    "NoStepError",
    "at",
    "chosen",
    "note",
    "of",
    "read",
    "reader_of",
    "times_of",
]

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


def chosen(times: Sequence[float], time: object) -> int:
    """Return the index of a step.

    Parameters
    ----------
    times : sequence of float
        Times of the steps.
    time : float, int, str, optional
        A time of a step, ``"last"``, ``"first"`` or, if it is an integer and no time of a step,
        the index of a step, from the end if negative. Default: the last.

    Raises
    ------
    NoStepError
        If there is no such step.
    """
    count = len(times)
    if time is None or time == "last":
        return count - 1
    if time == "first":
        return 0
    try:
        number = float(time)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        number = np.nan
    off = np.abs(np.asarray(times, dtype=float) - number)
    if count and np.nanmin(off, initial=np.inf) <= SAME * np.max(np.abs(times)):
        return int(np.nanargmin(off))
    if number == np.floor(number) and -count <= number < count:
        return int(number) % count
    expected = f"a time of a step, {listed(times)}, an index from 0 to {count - 1}, or last"
    got = f"{number:g}" if np.isfinite(number) else repr(time)
    raise NoStepError(_check.message("time", expected, got))


def listed(times: Sequence[float]) -> str:
    """Return the times of steps in words.

    Parameters
    ----------
    times : sequence of float
    """
    words = [f"{time:g}" for time in times]
    if len(words) > LISTED:
        words = [*words[: LISTED - 1], "...", words[-1]]
    return ", ".join(words)


def marked(mesh: Foreign, times: Sequence[float], index: int) -> Foreign:
    """Attach the time of a step, and the times of all steps of the file.

    Parameters
    ----------
    mesh : pyvista.DataObject
    times : sequence of float
    index : int
    """
    mesh.field_data[TIME] = [float(times[index])]
    mesh.field_data[STEPS] = [float(time) for time in times]
    return mesh


def of(mesh: pv.DataSet) -> list[float]:
    """Return the times of all steps of the file of a mesh, none where it had no steps.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh of a step.
    """
    return [float(time) for time in mesh.field_data[STEPS]] if STEPS in mesh.field_data else []


def note(mesh: pv.DataSet) -> str:
    """Return what a reader should know of the last step, which was taken by itself.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh of a step.
    """
    times = of(mesh)
    if len(times) < 2:
        return ""
    last = f"time {times[-1]:g}, the last of {len(times)} steps"
    return f"{last}; --time takes another, --times all of them one by one"


def reader_of(path: Path) -> Foreign:
    """Return PyVista's reader of a file, None where meshio or another package reads it.

    Parameters
    ----------
    path : pathlib.Path
    """
    case = path.parent
    whole = (case / "constant" / "polyMesh").is_dir()
    if path.suffix.lower() == ".foam" and not whole and (case / "processor0").is_dir():
        # PyVista's reader looks for the whole first, and reports that it is missing.
        decomposed = vtkPOpenFOAMReader()
        decomposed.SetCaseType(vtkPOpenFOAMReader.DECOMPOSED_CASE)
        return _OfVtk(decomposed, path)
    try:
        reader: Foreign = pv.get_reader(path)  # type: ignore[no-untyped-call]
    except ValueError:
        return None
    except TypeError:
        # PyVista's reader of XDMF fails without times, as in a mesh that FEniCS writes.
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
    """Return the times of the steps of a reader, none where its file has no time.

    Parameters
    ----------
    reader : object
        Reader of PyVista.
    """
    if hasattr(reader, "time_values"):
        return [float(time) for time in reader.time_values]
    inner: Foreign = getattr(reader, "reader", None)
    if not hasattr(inner, "GetOutputInformation"):
        return []
    inner.UpdateInformation()
    times = inner.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    return [float(time) for time in times or ()]


def at(reader: Foreign, time: float) -> Foreign:
    """Return the mesh of a reader at a time.

    Parameters
    ----------
    reader : object
        Reader of PyVista.
    time : float
        Time of a step.
    """
    if hasattr(reader, "set_active_time_value"):
        reader.set_active_time_value(time)
    else:
        reader.reader.UpdateTimeStep(time)
    return reader.read()


def read(path: Path, time: object) -> pv.DataObject | None:
    """Return the mesh of a step of a file, None where the file has no steps or no reader.

    Parameters
    ----------
    path : pathlib.Path
    time : float, int or str, optional
        As for :func:`chosen`.

    Raises
    ------
    NoStepError
        If there is no such step, or a time is given for a file without steps.
    """
    reader = reader_of(path)
    times = times_of(reader)
    if reader is None or not times:
        if time not in (None, "first", "last"):
            raise NoStepError(_check.message("time", "a file of several steps", f"'{path.name}'"))
        return None
    index = chosen(times, time)
    found: pv.DataObject = marked(at(reader, times[index]), times, index)
    return found
