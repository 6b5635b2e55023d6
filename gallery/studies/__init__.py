"""Studies of speed against error: scripts that make the tables of the pages.

A study is a module of this folder with a ``STUDY``, a :class:`Study`: what is approximated, the
reference, the steps that measure rows, and the verdict that follows from the rows.
``python gallery/studies`` lists the studies, ``python gallery/studies NAME --quick`` runs one.
"""

from __future__ import annotations

import contextlib
import contextvars
import csv
import importlib
import math
import pkgutil
import time
import tracemalloc
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeVar

import numpy as np

from vizlight.scene import Material

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

Axis = Literal["parameter", "error", "cost"]
Key = TypeVar("Key")

#: Material with every term of the light, whose errors are measured where none other is named.
SHINY = Material(ambient=0.1, diffuse=0.5, specular=0.4)
#: One pixel value of a picture of 8 bits, an error that is not visible.
PIXEL = 1 / 255
#: Ratio of costs below which one is clearly lower than the other, in spite of timing noise.
CLEAR = 0.85
#: Spread of repeats beyond which times do not support a verdict.
MOST_SPREAD = 0.15
_SPREADS: contextvars.ContextVar[list[float] | None] = contextvars.ContextVar(
    "spreads", default=None
)


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


def by_way(row: Row) -> Curve | None:
    """Return the curve of a row in a panel with one curve per method."""
    return Curve(row.way)


@dataclass(frozen=True, kw_only=True)
class Panel:
    """One panel of a figure with logarithmic axes.

    Attributes
    ----------
    axes : tuple of str
        Quantities on the x and y axes, of ``parameter``, ``error`` and ``cost``.
    joined : bool
        Whether the points of a curve are joined by a line.
    curve : callable
        Function from a row to its :class:`Curve`, or to None if the panel does not show the row.
    diagonal : str
        Label of the line y = x, which is drawn unless the label is empty.
    x : str
        Label of the x axis. Default: the heading of its column in the table.
    """

    axes: tuple[Axis, Axis] = ("cost", "error")
    joined: bool = True
    curve: Callable[[Row], Curve | None] = by_way
    diagonal: str = ""
    x: str = ""


@dataclass(frozen=True, kw_only=True)
class Study(Panel):
    """Description of a study; its own panel is the first of the figure.

    Attributes
    ----------
    approximates, reference : str
        Quantity that is approximated, and the reference for its errors.
    parameter, error, cost : str
        Headings of the table for the varied parameter and the two measures, with their units.
    steps : callable
        Function of a bool, whether the run is quick. It returns functions without arguments,
        each of which returns some rows.
    verdict : callable
        Function from all rows to a recommendation in one sentence with their numbers.
    beside : tuple of Panel
        Further panels of the figure.
    """

    approximates: str
    reference: str
    parameter: str
    error: str
    cost: str
    steps: Callable[[bool], Sequence[Callable[[], Iterable[Row]]]]
    verdict: Callable[[Sequence[Row]], str]
    beside: tuple[Panel, ...] = ()


@dataclass(frozen=True)
class Result:
    """Rows and verdict of a study that was run."""

    name: str
    study: Study
    rows: list[Row] = field(repr=False)
    verdict: str

    def table(self) -> tuple[list[str], list[list[float | str]]]:
        """Return headings and lines: method, parameter, error, cost, and the further columns."""
        study = self.study
        more = list(dict.fromkeys(key for row in self.rows for key in row.more))
        headings = ["method", study.parameter, study.error, study.cost, *more]
        lines = [[*row[:4], *(row.more.get(key, "") for key in more)] for row in self.rows]
        return headings, lines

    def write_csv(self, path: Path, /) -> Path:
        """Write the table with all digits to a CSV file."""
        headings, lines = self.table()
        with path.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([headings, *lines])
        return path

    def draw(self, path: Path, /) -> Path:
        """Draw the panels of the study with logarithmic axes to a PNG file."""
        from studies import _figure

        _figure.draw(self, path)
        return path


def names() -> list[str]:
    """Return the names of the studies."""
    return sorted(m.name for m in pkgutil.iter_modules(__path__) if m.name[0] != "_")


def load(name: str, /) -> Study:
    """Return the study of a name, one of :func:`names`."""
    if name not in names():
        raise ValueError(f"study: expected one of {', '.join(names())}, got '{name}'")
    study: Study = importlib.import_module(f"studies.{name}").STUDY
    return study


def run(name: str, study: Study, /, *, quick: bool = False, progress_bar: bool = False) -> Result:
    """Run a study; a quick run measures less, within 20 s on 2 cores.

    There is no verdict if the two shortest repeats of a processor time differ by more than 15 %.
    """
    from rich.console import Console
    from rich.progress import track

    rows: list[Row] = []
    with noted_spreads() as spreads:
        steps = study.steps(quick)
        shown = track(steps, name, console=Console(stderr=True), disable=not progress_bar)
        for step in shown:
            rows += step()
    worst = max(spreads, default=0.0)
    if worst > MOST_SPREAD:
        found = (
            f"none, because repeats of one time differ by {worst:.0%}, more than "
            f"{MOST_SPREAD:.0%}; run the study while nothing else runs"
        )
        return Result(name, study, rows, found)
    return Result(name, study, rows, study.verdict(rows))


def cheapest(rows: Iterable[Row], limit: float = PIXEL, *, usual: Row | None = None) -> Row | None:
    """Return the row of the lowest cost with an error within a limit, or None.

    ``usual``, the default among the rows, is returned if it is within the limit and no other row
    is clearly cheaper.
    """
    good = [row for row in rows if row.error <= limit and not math.isnan(row.cost)]
    best = min(good, key=lambda row: row.cost) if good else None
    if best and usual in good and usual and best.cost > CLEAR * usual.cost:
        return usual
    return best


def holding(rows: Iterable[Row], limit: float = PIXEL, *, coarse: bool = True) -> Row | None:
    """Return the coarsest row such that it and all finer rows are within a limit, or None.

    A larger parameter is coarser, like a step, or with ``coarse=False`` finer, like a count.
    """
    found = None
    for row in sorted(rows, key=lambda row: float(row.parameter), reverse=not coarse):
        if not row.error <= limit:
            break
        found = row
    return found


def order(rows: Sequence[Row]) -> float:
    """Return the order of convergence: the least-squares slope of log error on log parameter."""
    return slope([float(row.parameter) for row in rows], [row.error for row in rows])


def slope(x: Sequence[float], y: Sequence[float]) -> float:
    """Return the least-squares slope of log y on log x."""
    u, v = np.log(np.array([x, y], dtype=np.float64))
    u, v = u - u.mean(), v - v.mean()
    return float(u @ v / (u @ u))


def words(value: float) -> str:
    """Return a number for a sentence: three digits, and no exponent below 1e7."""
    return f"{value:.0f}" if 1000 <= abs(value) < 1e7 else f"{value:.3g}"


def span(values: Iterable[float]) -> str:
    """Return the range of some numbers for a sentence."""
    known = list(values)
    least, largest = words(min(known)), words(max(known))
    return least if least == largest else f"{least} to {largest}"


def number(value: float | str) -> str:
    """Return a table cell: a number with four digits, or a string as it is."""
    if isinstance(value, str):
        return value
    return "" if math.isnan(value) else f"{value:.4g}"


def take_turns(ways: Mapping[Key, Callable[[], object]], repeats: int) -> dict[Key, float]:
    """Return the shortest processor time in seconds of each function, of all its threads together.

    The functions are called in turn, so a busy machine slows all of them. The minimum of three
    or more repeats excludes the extra cost of a first call. Three or more repeats are up to doubled
    until the two shortest times of each function agree.
    """
    times: dict[Key, list[float]] = {way: [] for way in ways}
    for turn in range(2 * repeats if repeats > 2 else repeats):
        if turn >= repeats and all(spread(each) <= MOST_SPREAD for each in times.values()):
            break
        for way, work in ways.items():
            start = time.process_time()
            work()
            times[way].append(time.process_time() - start)
    for each in times.values():
        note_spread(each)
    return {way: min(each) for way, each in times.items()}


def note_spread(times: list[float]) -> None:
    """Add the spread of three or more repeats to the list of :func:`noted_spreads`."""
    noted = _SPREADS.get()
    if noted is not None and len(times) > 2:
        noted.append(spread(times))


def spread(times: list[float]) -> float:
    """Return by how much the second shortest of repeats exceeds the shortest, as a share of it."""
    shortest, second = sorted(times)[:2]
    return second / shortest - 1 if shortest > 0 else 0.0


@contextlib.contextmanager
def noted_spreads() -> Iterator[list[float]]:
    """Yield a list to which :func:`take_turns` and :func:`note_spread` add spreads."""
    spreads: list[float] = []
    token = _SPREADS.set(spreads)
    try:
        yield spreads
    finally:
        _SPREADS.reset(token)


def peak_memory(work: Callable[[], object]) -> int:
    """Return the peak of the bytes that Python and NumPy allocate during a call."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
