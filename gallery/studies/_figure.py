"""The figure of a study: logarithmic axes, one curve per method."""

from __future__ import annotations

import math

from matplotlib.figure import Figure

from studies import PIXEL

#: Colours of Okabe and Ito, which colour-blind readers can distinguish; markers and line styles.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
MARKS, STYLES = "osD^vP*X<>", ("-", "--", ":", "-.")
GREY = "#888888"


def draw(result):
    """Return the figure of a result; colour by the name of a curve, line style by its kind."""
    study = result.study
    curves = {}
    for row in result.rows:
        if curve := study.curve(row):
            curves.setdefault(curve, []).append(row)
    figure = Figure(figsize=(8, 6), dpi=120, layout="constrained")
    figure.suptitle(study.approximates, fontsize=11)
    axes = figure.subplots()
    x, y = study.axes
    axes.set(
        xscale="log", yscale="log", xlabel=getattr(study, x), ylabel=getattr(study, y),
    )  # fmt: skip
    names, kinds = (list(dict.fromkeys(curve[i] for curve in curves)) for i in (0, 1))
    for i, (curve, rows) in enumerate(curves.items()):
        # The line style changes with each repetition of the colours, which are few.
        repetition, colour = divmod(names.index(curve.name), len(COLOURS))
        style = STYLES[(kinds.index(curve.kind) + repetition) % len(STYLES)]
        if points := _points(study.axes, rows):
            axes.plot(
                *zip(*points, strict=True), marker=MARKS[i % len(MARKS)],
                label=", ".join(filter(None, curve)), color=COLOURS[colour], markersize=5,
                linestyle=style if study.joined else "",
            )  # fmt: skip
    if y == "error" and "luminance" in study.error:
        axes.axhline(PIXEL, color=GREY, linestyle="--", label="1/255")
    if study.diagonal:
        axes.axline((1, 1), (10, 10), color=GREY, linestyle="-", label=study.diagonal)
    axes.grid(visible=True, which="major", color="#dddddd")
    if handles := axes.get_legend_handles_labels()[0]:
        columns = 1 + (len(handles) > 4) + (len(handles) > 12)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), fontsize=7, ncols=columns)
    return figure


def _points(axes, rows):
    """Return the sorted points of a curve that logarithmic axes can show."""
    pairs = [tuple(getattr(row, axis) for axis in axes) for row in rows]
    return sorted(
        (x, y) for x, y in pairs
        if all(isinstance(v, float | int) and 0 < v < math.inf for v in (x, y))
    )  # fmt: skip
