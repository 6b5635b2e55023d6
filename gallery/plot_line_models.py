"""
Line models against the exact line light
========================================

A line that is one pixel wide should show the mean light of a thin cylinder. The charts show root
mean square errors of the inexpensive models, each with its best factor, and of tubes with 3 to 40
sides, for random directions of line, light and eye. The power of the highlights is 20.

The error of tubes falls with the square of the number of sides, and their cost grows with that
number. Left: no model that depends only on the angle to the light reproduces the diffuse term,
because the dark side of a line is visible too. Right: Blinn's highlight is about as accurate as a
tube with 3 sides, and ``model="cylinder"`` is exact.
"""

import pyvista as pv
from vtkmodules.vtkChartsCore import vtkChartLegend

from vizlight.studies import lines

rows = [row for row in lines.measure(5000, repeats=1) if row.setting == "random"]
plotter = pv.Plotter(shape=(1, 2), window_size=(1500, 620), border=False)
colors = ("#d55e00", "#0072b2")
for column, term in enumerate(("diffuse", "specular")):
    own = [row for row in rows if row.term == term and row.model != "exact"]
    chart = pv.Chart2D(x_label="sides of the tube", y_label="RMS error")
    chart.title = term
    chart.GetTitleProperties().SetFontSize(24)
    chart.x_axis.log_scale = chart.y_axis.log_scale = True
    errors = [row.scaled_rms for row in own if row.model.startswith("tube")]
    chart.line(lines.SIDES, errors, color="black", width=2, label="tube")
    chart.scatter(lines.SIDES, errors, color="black", size=9)
    for color, row in zip(colors, (r for r in own if not r.model.startswith("tube")), strict=True):
        ends = (lines.SIDES[0], lines.SIDES[-1])
        chart.line(ends, [row.scaled_rms] * 2, color=color, width=3, label=row.model)
    chart.legend_visible = True
    for axis in (chart.x_axis, chart.y_axis):
        axis.label_size, axis.tick_label_size = 20, 15
    chart.GetLegend().SetLabelSize(17)
    chart.GetLegend().SetHorizontalAlignment(vtkChartLegend.LEFT)
    chart.GetLegend().SetVerticalAlignment(vtkChartLegend.BOTTOM)
    chart.y_range = (1e-4, 0.5)
    plotter.subplot(0, column)
    plotter.background_color = "white"
    plotter.add_chart(chart)
plotter.show()
