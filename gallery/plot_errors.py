"""
Speed against error
===================

Three ways to compute the same light, for 10 thousand to a million points: a plain NumPy script,
and the engine in float32 and in float64. The engine is both faster and more accurate than the
script of the same precision. Float64 takes about twice as long as float32 and gives eight more
digits.

The error is the largest difference from float64 formulas that share no code with the engine.
"""

import pyvista as pv

from vizlight.studies import engine

counts = [10_000, 30_000, 100_000, 300_000, 1_000_000]
names = ("NumPy script, float32", "NumPy blocks, float32", "NumPy blocks, float64")
ways = {name: [] for name in (*names, "compiled, float32")}
for count in counts:
    for row in engine.measure(count, repeats=5):
        if row.way in ways:
            ways[row.way].append(row)

charts = (
    ("ns per point", (2, 1000), lambda row: row.cost),
    ("largest error", (1e-15, 1e-3), lambda row: row.error),
)
plotter = pv.Plotter(shape=(1, 2), window_size=(1500, 620), border=False)
for column, (label, ends, value) in enumerate(charts):
    chart = pv.Chart2D(x_label="points", y_label=label)
    chart.x_axis.log_scale = chart.y_axis.log_scale = True
    for color, (way, rows) in zip(
        ("#d55e00", "#0072b2", "#009e73", "#000000"), ways.items(), strict=True
    ):
        if not rows:  # Compiled code needs numba, the extra fast.
            continue
        values = [value(row) for row in rows]
        chart.line(counts, values, color=color, width=3, label=way)
        chart.scatter(counts, values, color=color, size=9)
    chart.y_range = ends
    chart.legend_visible = True
    for axis in (chart.x_axis, chart.y_axis):
        axis.label_size, axis.tick_label_size = 20, 15
    chart.GetLegend().SetLabelSize(17)
    plotter.subplot(0, column)
    plotter.background_color = "white"
    plotter.add_chart(chart)
plotter.show()
