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
#: What costs at most this part of another is clearly cheaper, whatever a busy machine does.
CLEAR = 0.85
#: Okabe and Ito's colours, which colour-blind readers tell apart; marks and lines of curves.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
MARKS, STYLES = "osD^vP*X<>", ("-", "--", ":", "-.")


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


class Curve(NamedTuple):
    """Where a figure shows a row: curves of one name share a colour, of one kind a line style."""

    name: str
    kind: str = ""


def by_way(row: Row) -> Curve | None:
    """Return the curve of a row where every way is one."""
    return Curve(row.way)


@dataclass(frozen=True, kw_only=True)
class Panel:
    """One log-log panel of a figure.

    Attributes
    ----------
    axes : tuple of str
        What is shown, of ``parameter``, ``error`` and ``cost``: x and y.
    joined : bool
        Whether the rows of one curve are joined by a line.
    curve : callable
        Takes a row, returns its :class:`Curve`, or None where the panel does not show it.
    diagonal : str
        Name of the line on which y is x, which is drawn if there is one.
    x : str
        What the x axis is called, where the heading of the table says too much.
    """

    axes: tuple[Axis, Axis] = ("cost", "error")
    joined: bool = True
    curve: Callable[[Row], Curve | None] = by_way
    diagonal: str = ""
    x: str = ""


@dataclass(frozen=True, kw_only=True)
class Study(Panel):
    """What a study says of itself, how it is run, what follows from it, and its figure.

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
    beside : tuple of Panel
        Panels of the figure beside the first, which is the study's own ``axes`` and the like.
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
        """Draw the study's panels, all axes logarithmic."""
        # matplotlib comes with PyVista, which requires it.
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        from vizlight import files

        panels = (self.study, *self.study.beside)
        figure = Figure(figsize=(4 + 4 * len(panels), 6), dpi=120, layout="constrained")
        FigureCanvasAgg(figure)
        figure.suptitle(self.study.approximates, fontsize=11)
        for panel, axes in zip(
            panels, figure.subplots(1, len(panels), squeeze=False)[0], strict=True
        ):
            self._draw_panel(panel, axes)
        return files.replace_file(path, lambda place: figure.savefig(place, format="png"))

    def _draw_panel(self, panel: Panel, axes: Any) -> None:
        from matplotlib.ticker import LogFormatter

        x, y = panel.axes
        curves: dict[Curve, list[Row]] = {}
        for row in self.rows:
            if curve := panel.curve(row):
                curves.setdefault(curve, []).append(row)
        names, kinds = (list(dict.fromkeys(curve[i] for curve in curves)) for i in (0, 1))
        exact: dict[float, list[str]] = {}
        for i, (curve, rows) in enumerate(curves.items()):
            label = ", ".join(filter(None, curve))
            at = [(getattr(row, x), getattr(row, y)) for row in rows]
            at = [
                pair for pair in at
                if all(isinstance(v, float | int) and 0 < v < math.inf for v in pair)
            ]  # fmt: skip
            if not at:
                if (x, y) == ("cost", "error") and rows[0].error == 0 < rows[0].cost:
                    exact.setdefault(rows[0].cost, []).append(label)
                continue
            # One more kind for each time that the colours begin anew.
            again, colour = divmod(names.index(curve.name), len(COLOURS))
            style = STYLES[(kinds.index(curve.kind) + again) % len(STYLES)]
            axes.plot(
                *zip(*sorted(at), strict=True), marker=MARKS[i % len(MARKS)], label=label,
                color=COLOURS[colour], markersize=5, linestyle=style if panel.joined else "",
            )  # fmt: skip
        for cost, labels in exact.items():
            axes.axvline(cost, color="#888888", ls=":", label=f"no error: {', '.join(labels)}")
        if y == "error" and "luminance" in self.study.error:
            axes.axhline(PIXEL, color="#888888", linestyle="--", label="1/255")
        axes.set(
            xscale="log", yscale="log", xlabel=panel.x or getattr(self.study, x),
            ylabel=getattr(self.study, y),
        )  # fmt: skip
        if panel.diagonal:
            axes.axline((1, 1), (10, 10), color="#888888", linestyle="-", label=panel.diagonal)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(LogFormatter())
            # Within a decade there are too few powers of 10 to read by.
            axis.set_minor_formatter(LogFormatter(minor_thresholds=(1.1, 0.5)))
        axes.grid(visible=True, which="major", color="#dddddd")
        if handles := axes.get_legend_handles_labels()[0]:
            columns = 1 + (len(handles) > 4) + (len(handles) > 12)
            axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), fontsize=7, ncols=columns)


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
    from vizlight import _progress

    steps = study.steps(quick)
    rows: list[Row] = []
    with _progress.progress(name, len(steps), show=progress_bar) as report:
        for done, step in enumerate(steps):
            rows += step()
            report(done + 1)
    return Result(name, study, rows, study.verdict(rows))


def cheapest(rows: Iterable[Row], limit: float = PIXEL, *, usual: Row | None = None) -> Row | None:
    """Return the row of least cost whose error is within a limit, or None.

    Parameters
    ----------
    rows : iterable of Row
    limit : float, default: 1/255
        In the unit of the rows' errors.
    usual : Row, optional
        Of the rows: the one to keep, if it is within the limit, unless another is clearly cheaper.
    """
    good = [row for row in rows if row.error <= limit and not math.isnan(row.cost)]
    best = min(good, key=lambda row: row.cost) if good else None
    if best and usual in good and usual and best.cost > CLEAR * usual.cost:
        return usual
    return best


def holding(rows: Iterable[Row], limit: float = PIXEL, *, coarse: bool = True) -> Row | None:
    """Return the row that is coarsest of those that hold with all finer ones, or None.

    Parameters
    ----------
    rows : iterable of Row
        Of one way, with numbers for parameters.
    limit : float, default: 1/255
        In the unit of the rows' errors.
    coarse : bool, default: True
        Whether a larger parameter is coarser, as a step is; otherwise finer, as a count is.
    """
    found = None
    for row in sorted(rows, key=lambda row: float(row.parameter), reverse=not coarse):
        if not row.error <= limit:
            break
        found = row
    return found


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
    """Print a study's table, what it compares, and its verdict.

    Parameters
    ----------
    result : Result
        What :func:`run` returned.
    """
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
    """Print the studies there are.

    Parameters
    ----------
    studies : dict of str to Study
        The studies by name.
    """
    from rich.table import Table

    table = Table("study", "what is approximated", "reference", "swept", title="vizlight study")
    for name, study in studies.items():
        table.add_row(name, study.approximates, study.reference, study.parameter)
    _console.console().print(table)


def words(value: Any) -> str:
    """Return a number as a sentence has it: three digits, whole ones without an exponent."""
    return f"{value:.0f}" if 1000 <= abs(value) < 1e7 else f"{value:.3g}"


def span(values: Iterable[float]) -> str:
    """Return the least and the largest of some numbers as a sentence has them."""
    known = list(values)
    least, largest = words(min(known)), words(max(known))
    return least if least == largest else f"{least} to {largest}"
