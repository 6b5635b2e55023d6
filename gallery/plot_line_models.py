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

import matplotlib.pyplot as plt
from matplotlib.ticker import NullFormatter

from vizlight.studies import lines

rows = [row for row in lines.measure(5000, repeats=1) if row.setting == "random"]
figure, axes = plt.subplots(1, 2, figsize=(12, 5), sharey=True)
for axis, term in zip(axes, ("diffuse", "specular"), strict=True):
    own = [row for row in rows if row.term == term and row.model != "exact"]
    errors = [row.scaled_rms for row in own if row.model.startswith("tube")]
    axis.plot(lines.SIDES, errors, "o-", color="black", label="tube")
    models = [row for row in own if not row.model.startswith("tube")]
    for color, row in zip(("#d55e00", "#0072b2"), models, strict=True):
        axis.axhline(row.scaled_rms, color=color, lw=2, label=row.model)
    axis.set(xscale="log", yscale="log", xlabel="sides of the tube", title=term)
    axis.set_xticks(lines.SIDES, lines.SIDES)
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.grid(alpha=0.3)
    axis.legend(loc="lower left")
axes[0].set_ylabel("RMS error")
figure.tight_layout()
plt.show()
