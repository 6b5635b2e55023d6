"""The figure of a study: panels with logarithmic axes, one curve per method."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatter

from studies import PIXEL, Curve, Panel, Result, Row

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from matplotlib.axes import Axes

#: Colours of Okabe and Ito, which colour-blind readers can distinguish; markers and line styles.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
MARKS, STYLES = "osD^vP*X<>", ("-", "--", ":", "-.")
GREY = "#888888"


def draw(result: Result, path: Path) -> None:
    """Draw the panels of a result to a PNG file."""
    panels = (result.study, *result.study.beside)
    figure = Figure(figsize=(4 + 4 * len(panels), 6), dpi=120, layout="constrained")
    figure.suptitle(result.study.approximates, fontsize=11)
    for panel, axes in zip(panels, figure.subplots(1, len(panels), squeeze=False)[0], strict=True):
        draw_panel(result, panel, axes)
    figure.savefig(path, format="png")


def draw_panel(result: Result, panel: Panel, axes: Axes) -> None:
    """Draw one panel; colour by the name of a curve, line style by its kind."""
    curves: dict[Curve, list[Row]] = {}
    for row in result.rows:
        if curve := panel.curve(row):
            curves.setdefault(curve, []).append(row)
    _draw_curves(panel, curves, axes)
    x, y = panel.axes
    if y == "error" and "luminance" in result.study.error:
        axes.axhline(PIXEL, color=GREY, linestyle="--", label="1/255")
    axes.set(
        xscale="log", yscale="log", xlabel=panel.x or getattr(result.study, x),
        ylabel=getattr(result.study, y),
    )  # fmt: skip
    if panel.diagonal:
        axes.axline((1, 1), (10, 10), color=GREY, linestyle="-", label=panel.diagonal)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(LogFormatter())
        # An axis within one decade has too few powers of 10 to be read without minor labels.
        axis.set_minor_formatter(LogFormatter(minor_thresholds=(1.1, 0.5)))
    axes.grid(visible=True, which="major", color="#dddddd")
    if handles := axes.get_legend_handles_labels()[0]:
        columns = 1 + (len(handles) > 4) + (len(handles) > 12)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), fontsize=7, ncols=columns)


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
