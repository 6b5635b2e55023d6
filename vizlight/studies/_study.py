"""The one shape of a study: what is approximated, by what it is judged, and what it costs."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from vizlight import _console

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from pathlib import Path

    Axis = Literal["parameter", "error", "cost"]

#: One value of a picture of 8 bits, the error that nobody sees.
PIXEL = 1 / 255


class LackingError(RuntimeError):
    """A study needs what is not installed; the message says how to get it."""


class Row(NamedTuple):
    """One measurement.

    Attributes
    ----------
    way : str
        What is done: the rows of one way are one curve of the figure.
    parameter : float or str
        Its value of what the study sweeps.
    error, cost : float
        In the study's measures; NaN where there is none.
    more : mapping
        Further columns, a number or a word each.
    """

    way: str
    parameter: float | str
    error: float
    cost: float
    more: Mapping[str, float | str] = {}


@dataclass(frozen=True, kw_only=True)
class Study:
    """What a study says of itself, how it is run, and what follows from it.

    Attributes
    ----------
    approximates, reference : str
        What is judged, and by what.
    parameter, error, cost : str
        What is swept and the two measures, with their units: headings of the table.
    steps : callable
        Takes whether to be quick, returns functions of no argument, each giving some rows.
    verdict : callable
        Takes all rows, returns a sentence to act on, made of their numbers.
    axes : tuple of str
        What the log-log figure shows, of ``parameter``, ``error`` and ``cost``: x and y.
    joined : bool
        Whether the rows of one way are joined by a line.
    """

    approximates: str
    reference: str
    parameter: str
    error: str
    cost: str
    steps: Callable[[bool], Sequence[Callable[[], Iterable[Row]]]]
    verdict: Callable[[Sequence[Row]], str]
    axes: tuple[Axis, Axis] = ("cost", "error")
    joined: bool = True


@dataclass(frozen=True)
class Result:
    """The rows of a study that was run, and its verdict."""

    name: str
    study: Study
    rows: list[Row] = field(repr=False)
    verdict: str

    def table(self) -> tuple[list[str], list[list[float | str]]]:
        """Return headings and rows: way, parameter, error, cost, and what more there is."""
        study = self.study
        more = list(dict.fromkeys(key for row in self.rows for key in row.more))
        headings = ["way", study.parameter, study.error, study.cost, *more]
        lines = [[*row[:4], *(row.more.get(key, "") for key in more)] for row in self.rows]
        return headings, lines

    def write_csv(self, path: Path, /) -> Path:
        """Write the table, all digits, whole or not at all."""
        from vizlight import files

        headings, lines = self.table()

        def write(place: str) -> None:
            with open(place, "w", newline="", encoding="utf-8") as file:  # noqa: PTH123
                writer = csv.writer(file)
                writer.writerows([headings, *lines])

        return files.replace_file(path, write)

    def draw(self, path: Path, /) -> Path:
        """Draw one axis of the study against the other, both logarithmic, a curve a way."""
        # matplotlib comes with PyVista, which requires it.
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        from vizlight import files

        figure = Figure(figsize=(8, 5), dpi=120, layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.add_subplot()
        marks = "osD^vP*X<>"
        # Okabe and Ito's colours, which colour-blind readers tell apart.
        colours = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
        x, y = self.study.axes
        for i, way in enumerate(dict.fromkeys(row.way for row in self.rows)):
            at = [(getattr(r, x), getattr(r, y)) for r in self.rows if r.way == way]
            at = [pair for pair in at if all(isinstance(v, float | int) and v > 0 for v in pair)]
            if not at:
                exact = [r.cost for r in self.rows if r.way == way and r.error == 0 < r.cost]
                if exact and (x, y) == ("cost", "error"):
                    label = f"{way}: no error"
                    axes.axvline(exact[0], color=colours[i % len(colours)], ls=":", label=label)
                continue
            style = "-" if len(at) > 1 and self.study.joined else ""
            axes.plot(
                *zip(*sorted(at), strict=True), style + marks[i % len(marks)],
                color=colours[i % len(colours)], label=way, markersize=5,
            )  # fmt: skip
        if y == "error" and "luminance" in self.study.error:
            axes.axhline(PIXEL, color="#888888", linestyle="--", label="1/255")
        axes.set(
            xscale="log", yscale="log", xlabel=getattr(self.study, x), ylabel=getattr(self.study, y)
        )
        axes.set_title(self.study.approximates, wrap=True, fontsize=10)
        axes.grid(visible=True, which="major", color="#dddddd")
        if axes.get_legend_handles_labels()[0]:
            figure.legend(loc="outside right upper", fontsize=7)
        return files.replace_file(path, lambda place: figure.savefig(place, format="png"))


def run(name: str, study: Study, /, *, quick: bool = False, progress_bar: bool = False) -> Result:
    """Run a study.

    Parameters
    ----------
    name : str
        Of the study, for the progress bar.
    study : Study
    quick : bool, default: False
        Measure less, in less than 20 s on 2 cores.
    progress_bar : bool, default: False
        Show progress on standard error.

    Returns
    -------
    Result
    """
    from vizlight.filters import _progress

    steps = study.steps(quick)
    rows: list[Row] = []
    with _progress.progress(name, len(steps), show=progress_bar) as report:
        for done, step in enumerate(steps):
            rows += step()
            report(done + 1)
    return Result(name, study, rows, study.verdict(rows))


def cheapest(rows: Iterable[Row], limit: float = PIXEL) -> Row | None:
    """Return the row of least cost whose error is within a limit, or None.

    Parameters
    ----------
    rows : iterable of Row
    limit : float, default: 1/255
        In the unit of the rows' errors.
    """
    good = [row for row in rows if row.error <= limit and not math.isnan(row.cost)]
    return min(good, key=lambda row: row.cost) if good else None


def order(rows: Sequence[Row]) -> float:
    """Return the exponent by which the error changes with the parameter: a least-squares slope.

    Parameters
    ----------
    rows : sequence of Row
        Of one way, with parameters and errors above 0.
    """
    points = np.array([(row.parameter, row.error) for row in rows], dtype=np.float64)
    x, y = np.log(points).T
    x, y = x - x.mean(), y - y.mean()
    return float(x @ y / (x @ x))


def number(value: float | str) -> str:
    """Return a cell of a table: four digits of a number, a word as it is."""
    if isinstance(value, str):
        return value
    return "" if math.isnan(value) else f"{value:.4g}"


def print_result(result: Result) -> None:
    """Print a study's table, what it compares, and its verdict."""
    from rich.table import Table

    study, console = result.study, _console.console()
    headings, lines = result.table()
    table = Table(title=f"vizlight study {result.name}")
    for i, heading in enumerate(headings):
        words = all(isinstance(line[i], str) for line in lines)
        table.add_column(heading, justify="left" if words else "right", overflow="fold")
    for line in lines:
        table.add_row(*map(number, line))
    console.print(table)
    console.print(f"approximated: {study.approximates}", highlight=False)
    console.print(f"reference: {study.reference}", highlight=False)
    console.print(f"verdict: {result.verdict}", style="bold", highlight=False)


def print_list(studies: Mapping[str, Study]) -> None:
    """Print the studies there are."""
    from rich.table import Table

    table = Table("study", "what is approximated", "reference", "swept", title="vizlight study")
    for name, study in studies.items():
        table.add_row(name, study.approximates, study.reference, study.parameter)
    _console.console().print(table)


def words(value: Any) -> str:
    """Return a number as a sentence has it: three digits, whole ones without an exponent."""
    return f"{value:.0f}" if 1000 <= abs(value) < 1e7 else f"{value:.3g}"
