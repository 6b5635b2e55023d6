"""Results of a study: run it, and present its rows as a table, a CSV file and a figure."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check, _console, _progress
from vizlight.studies._framework import PIXEL, Curve, Study
from vizlight.studies._measuring import MOST_SPREAD, noted_spreads

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from matplotlib.axes import Axes

    from vizlight.studies._framework import Panel, Row

#: Colours of Okabe and Ito, which colour-blind readers can distinguish; markers and line styles.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
MARKS, STYLES = "osD^vP*X<>", ("-", "--", ":", "-.")
GREY = "#888888"


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
        """Write the table with all digits to a CSV file; no partial file is left."""
        from vizlight import files

        headings, lines = self.table()

        def write(place: str) -> None:
            with open(place, "w", newline="", encoding="utf-8") as file:  # noqa: PTH123
                csv.writer(file).writerows([headings, *lines])

        return files.replace_file(path, write)

    def draw(self, path: Path, /) -> Path:
        """Draw the panels of the study with logarithmic axes to a PNG file."""
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

    def _draw_panel(self, panel: Panel, axes: Axes) -> None:
        curves: dict[Curve, list[Row]] = {}
        for row in self.rows:
            if curve := panel.curve(row):
                curves.setdefault(curve, []).append(row)
        _draw_curves(panel, curves, axes)
        x, y = panel.axes
        if y == "error" and "luminance" in self.study.error:
            axes.axhline(PIXEL, color=GREY, linestyle="--", label="1/255")
        axes.set(
            xscale="log", yscale="log", xlabel=panel.x or getattr(self.study, x),
            ylabel=getattr(self.study, y),
        )  # fmt: skip
        if panel.diagonal:
            axes.axline((1, 1), (10, 10), color=GREY, linestyle="-", label=panel.diagonal)
        _draw_slopes(panel, axes)
        _label_axes(axes)


def _draw_slopes(panel: Panel, axes: Axes) -> None:
    """Draw the slopes in theory, each through the middle of the curve that is nearest to it."""
    data = [np.array(line.get_data(), dtype=np.float64) for line in axes.lines]
    for slope in panel.slopes:
        found = []
        for x, y in (np.log(curve) for curve in data if curve.shape[1] > 2):
            found.append((abs(np.polyfit(x, y, 1)[0] - slope), x.mean(), y.mean(), np.ptp(x)))
        if found:
            _, x, y, width = min(found)
            ends = np.array([-width / 2, width / 2])
            axes.plot(
                np.exp(x + ends), np.exp(y + slope * ends), color=GREY, linestyle="--",
                linewidth=2, alpha=0.6, label=f"slope {slope:g} (theory)",
            )  # fmt: skip


def _draw_curves(panel: Panel, curves: Mapping[Curve, Sequence[Row]], axes: Axes) -> None:
    """Draw the curves of a panel; a method without error is a vertical line at its cost."""
    names, kinds = (list(dict.fromkeys(curve[i] for curve in curves)) for i in (0, 1))
    exact: dict[float, list[str]] = {}
    for i, (curve, rows) in enumerate(curves.items()):
        label = ", ".join(filter(None, curve))
        points = _points(panel, rows)
        if not points:
            if panel.axes == ("cost", "error") and rows[0].error == 0 < rows[0].cost:
                exact.setdefault(rows[0].cost, []).append(label)
            continue
        # The line style changes with each repetition of the colours, which are few.
        repetition, colour = divmod(names.index(curve.name), len(COLOURS))
        style = STYLES[(kinds.index(curve.kind) + repetition) % len(STYLES)]
        axes.plot(
            *zip(*points, strict=True), marker=MARKS[i % len(MARKS)], label=label,
            color=COLOURS[colour], markersize=5, linestyle=style if panel.joined else "",
        )  # fmt: skip
    for cost, labels in exact.items():
        axes.axvline(cost, color=GREY, linestyle=":", label=f"no error: {', '.join(labels)}")


def _points(panel: Panel, rows: Sequence[Row]) -> list[tuple[float, float]]:
    """Return the sorted points of a curve that logarithmic axes can show."""
    pairs = [tuple(getattr(row, axis) for axis in panel.axes) for row in rows]
    return sorted(
        (x, y) for x, y in pairs
        if all(isinstance(v, float | int) and 0 < v < math.inf for v in (x, y))
    )  # fmt: skip


def _label_axes(axes: Axes) -> None:
    """Add tick labels, a grid and a legend below the panel."""
    from matplotlib.ticker import LogFormatter

    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(LogFormatter())
        # An axis within one decade has too few powers of 10 to be read without minor labels.
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
        Name of the study, shown with the progress bar.
    study : Study
        Study to run.
    quick : bool, default: False
        Whether to measure less, within 20 s on 2 cores.
    progress_bar : bool, default: False
        Show progress on standard error.

    Returns
    -------
    Result
        Rows, and the verdict. There is none if the two shortest repeats of a processor time differ
        by more than 15 %.
    """
    _check.text("name", name, expected="the name of a study")
    _check.instance("study", study, Study, home="studies")
    steps = study.steps(_check.boolean("quick", quick))
    rows: list[Row] = []
    with (
        noted_spreads() as spreads,
        _progress.progress(name, len(steps), show=progress_bar) as report,
    ):
        for done, step in enumerate(steps):
            rows += step()
            report(done + 1)
    worst = max(spreads, default=0.0)
    if worst > MOST_SPREAD:
        found = (
            f"none, because repeats of one time differ by {worst:.0%}, more than "
            f"{MOST_SPREAD:.0%}; run the study while nothing else runs"
        )
        return Result(name, study, rows, found)
    return Result(name, study, rows, study.verdict(rows))


def number(value: float | str) -> str:
    """Return a table cell: a number with four digits, or a string as it is."""
    if isinstance(value, str):
        return value
    return "" if math.isnan(value) else f"{value:.4g}"


def print_result(result: Result) -> None:
    """Print the table, the subject, the reference and the verdict of a study.

    Parameters
    ----------
    result : Result
        Result returned by :func:`run`.
    """
    from rich.table import Table

    _check.instance("result", result, Result, home="studies")
    study, console = result.study, _console.console()
    headings, lines = result.table()
    table = Table(title=f"vizlight study {result.name}")
    for i, heading in enumerate(headings):
        strings = all(isinstance(line[i], str) for line in lines)
        table.add_column(heading, justify="left" if strings else "right", overflow="fold")
    for line in lines:
        table.add_row(*map(number, line))
    console.print(table)
    console.print(f"approximated: {study.approximates}", highlight=False)
    console.print(f"reference: {study.reference}", highlight=False)
    console.print(f"verdict: {result.verdict}", style="bold", highlight=False)


def print_list(studies: Mapping[str, Study]) -> None:
    """Print the list of the studies.

    Parameters
    ----------
    studies : dict of str to Study
        Studies by name.
    """
    from rich.table import Table

    if not isinstance(studies, Mapping):
        raise TypeError(_check.message("studies", "a dict of studies", _check.describe(studies)))
    for study in studies.values():
        _check.instance("studies", study, Study, home="studies")
    table = Table("study", "approximated quantity", "reference", "parameter")
    table.title = "vizlight study"
    for name, study in studies.items():
        table.add_row(name, study.approximates, study.reference, study.parameter)
    _console.console().print(table)
