"""Count the points that the gallery's scripts light, and those whose plan has a compiled form.

``python tests/gallery_points.py`` runs all scripts, in some minutes.
"""

from __future__ import annotations

import os
import runpy
from pathlib import Path

import matplotlib as mpl

from vizlight import engine
from vizlight.shading import compiled

ROOT = Path(__file__).parents[1]


def main() -> None:
    """Print the points of each script, the share with a compiled form, and why others have none."""
    import pyvista as pv

    mpl.use("Agg")
    pv.OFF_SCREEN = True
    os.chdir(ROOT / "gallery")
    everything: dict[str, int] = {}
    for path in sorted(Path().glob("plot_*.py")):
        counts: dict[str, int] = {}

        def count(inputs, scene, shading, options, counts=counts):
            reason = compiled.why_not(shading.plan)
            counts[reason] = counts.get(reason, 0) + inputs.count

        with engine.observed(count):
            runpy.run_path(str(path), run_name="__main__")
        print(path.stem, counts, flush=True)  # noqa: T201
        for reason, points in counts.items():
            everything[reason] = everything.get(reason, 0) + points
    total = sum(everything.values())
    print(f"{everything.get('', 0) / total:.2%} of {total} points have a compiled form")  # noqa: T201
    for reason, points in everything.items():
        print(f"{points:>12}  {reason or 'compiled'}")  # noqa: T201


if __name__ == "__main__":
    main()
