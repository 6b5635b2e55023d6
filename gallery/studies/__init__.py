"""Studies of speed against error: scripts that make the tables of the pages.

A study is a module of this folder with a ``STUDY``, a :class:`Study`: what is approximated, the
reference, and the steps that measure rows. ``python gallery/studies`` lists the studies,
``python gallery/studies NAME --quick`` runs one.
"""

from __future__ import annotations

import csv
import importlib
import math
import pkgutil
import time
import tracemalloc
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from vizlight.scene import Material

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

#: Material with every term of the light, whose errors are measured where none other is named.
SHINY = Material(ambient=0.1, diffuse=0.5, specular=0.4)
#: One pixel value of a picture of 8 bits, an error that is not visible.
PIXEL = 1 / 255


class Row(NamedTuple):
    """One measurement.

    Attributes
    ----------
    way : str
        Method that is measured. The rows of one method form one curve of the figure.
    parameter : float or str
        Value of the parameter that the study varies.
    error, cost : float
        Error and cost in the units of the study; NaN if not measured.
    more : mapping
        Further columns by heading, each a number or a string.
    """

    way: str
    parameter: float | str
    error: float
    cost: float
    more: Mapping[str, float | str] = {}


class Curve(NamedTuple):
    """Curve of a figure: curves of one name share a colour, curves of one kind a line style."""

    name: str
    kind: str = ""


@dataclass(frozen=True, kw_only=True)
class Study:
    """Description of a study, and of its figure with logarithmic axes.

    Attributes
    ----------
    approximates, reference : str
        Quantity that is approximated, and the reference for its errors.
    parameter, error, cost : str
        Headings of the table for the varied parameter and the two measures, with their units.
    steps : callable
        Function of a bool, whether the run is quick. It returns functions without arguments,
        each of which returns some rows.
    axes : tuple of str
        Quantities on the x and y axes, of ``parameter``, ``error`` and ``cost``.
    joined : bool
        Whether the points of a curve are joined by a line.
    curve : callable
        Function from a row to its :class:`Curve`, or to None if the figure does not show the row.
    diagonal : str
        Label of the line y = x, which is drawn unless the label is empty.
    """

    approximates: str
    reference: str
    parameter: str
    error: str
    cost: str
    steps: Callable
    axes: tuple[str, str] = ("cost", "error")
    joined: bool = True
    curve: Callable = lambda row: Curve(row.way)
    diagonal: str = ""


@dataclass(frozen=True)
class Result:
    """Rows of a study that was run."""

    name: str
    study: Study
    rows: list[Row]

    def table(self):
        """Return headings and lines: method, parameter, error, cost, and the further columns."""
        study = self.study
        more = list(dict.fromkeys(key for row in self.rows for key in row.more))
        headings = ["method", study.parameter, study.error, study.cost, *more]
        lines = [[*row[:4], *(row.more.get(key, "") for key in more)] for row in self.rows]
        return headings, lines

    def write_csv(self, path, /):
        """Write the table with all digits to a CSV file."""
        headings, lines = self.table()
        with path.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([headings, *lines])
        return path

    def draw(self, path, /):
        """Draw the figure of the study to a PNG file."""
        from studies import _figure

        _figure.draw(self).savefig(path, format="png")
        return path


def names():
    """Return the names of the studies."""
    return sorted(m.name for m in pkgutil.iter_modules(__path__) if m.name[0] != "_")


def run(name, study, /, *, quick=False):
    """Run a study; a quick run measures less, within 20 s on 2 cores."""
    return Result(name, study, [row for step in study.steps(quick) for row in step()])


def load(name, /):
    """Return the study of a name, one of :func:`names`."""
    return importlib.import_module(f"studies.{name}").STUDY


def number(value):
    """Return a table cell: a number with four digits, or a string as it is."""
    if isinstance(value, str):
        return value
    return "" if math.isnan(value) else f"{value:.4g}"


def take_turns(ways, repeats):
    """Return the shortest processor time in seconds of each function, of all its threads together.

    The functions are called in turn, so a busy machine slows all of them. The minimum of three
    or more repeats excludes the extra cost of a first call.
    """
    times = dict.fromkeys(ways, math.inf)
    for _ in range(repeats):
        for way, work in ways.items():
            start = time.process_time()
            work()
            times[way] = min(times[way], time.process_time() - start)
    return times


def peak_memory(work):
    """Return the peak of the bytes that Python and NumPy allocate during a call."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
