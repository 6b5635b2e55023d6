"""
Speed against error
===================

Three ways to compute the same light, for 10 thousand to a million points: a plain NumPy script,
and the engine in float32 and in float64. The engine is both faster and more accurate than the
script of the same precision. Float64 takes about twice as long as float32 and gives eight more
digits.

The error is the largest difference from float64 formulas that share no code with the engine.
"""

import matplotlib.pyplot as plt

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
figure, axes = plt.subplots(1, 2, figsize=(12, 5))
for axis, (label, ends, value) in zip(axes, charts, strict=True):
    for color, (way, rows) in zip(
        ("#d55e00", "#0072b2", "#009e73", "#000000"), ways.items(), strict=True
    ):
        if rows:  # Compiled code needs numba, the extra fast.
            axis.plot(counts, [value(row) for row in rows], "o-", color=color, label=way)
    axis.set(xscale="log", yscale="log", ylim=ends, xlabel="points", ylabel=label)
    axis.grid(alpha=0.3)
axes[0].legend()
figure.tight_layout()
plt.show()
