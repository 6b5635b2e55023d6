"""The pages of the studies: each is run, quickly, by the machine that builds the pages."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

from sphinx.util.display import status_iterator

from vizlight import studies
from vizlight.studies._study import number

#: All inputs of the stability suite: ``vizlight study stability -o gallery/pages``.
KEPT = "stability.csv"


def write(app):
    """Write a page, a table and a figure for each study, and the table of all verdicts."""
    source = Path(app.srcdir)
    folder = source / "studies"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    overview = []
    for name in status_iterator(
        studies.names(), "measuring... ", "darkgreen", len(studies.names())
    ):
        study = studies.load(name)
        result = studies.run(name, study, quick=True)
        result.draw(folder / f"{name}.png")
        headings, rows = result.table()
        if name == "stability":
            headings, rows = _kept(source / KEPT)
        overview.append([f":doc:`{name} <studies/{name}>`", study.approximates, result.verdict])
        page = [
            name, "=" * len(name), "",
            f"Approximated: {study.approximates}.", "",
            f"Reference: {study.reference}.", "",
            f"**Verdict**: {result.verdict}.", "",
            f".. figure:: {name}.png", f"   :alt: {study.error} over {study.cost}", "",
            f"   ``vizlight study {name} --quick``.", "",
            *_table(headings, [list(map(number, row)) for row in rows]),
        ]  # fmt: skip
        (folder / f"{name}.rst").write_text("\n".join(page) + "\n", encoding="utf-8")
    table = _table(["study", "what is approximated", "verdict"], overview, "12 28 60")
    (folder / "_verdicts.txt").write_text("\n".join(table) + "\n", encoding="utf-8")


def _table(headings, rows, widths="auto"):
    lines = [".. list-table::", "   :header-rows: 1", "   :class: numbers", f"   :widths: {widths}"]
    for row in [headings, *rows]:
        lines += [f"   {'*' if i == 0 else ' '} - {cell or '..'}" for i, cell in enumerate(row)]
    return [*lines[:4], "", *lines[4:], ""]


def _kept(path):
    """Return the worst case of each kernel and type, of all that were measured."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    headings = ["kernel", "type", "inputs", "worst case", "claimed, eps", "seen, eps", ""]
    worst = []
    for key in dict.fromkeys((row["way"], row["type"]) for row in rows):
        own = [row for row in rows if (row["way"], row["type"]) == key]
        top = max(own, key=lambda row: float(row["seen / claimed"]))
        inputs = sum(int(row["inputs"]) for row in own)
        ends = (float(top["claimed, eps"]), float(top["seen, eps"]))
        worst.append([*key, f"{inputs}", top["case"], *ends, top[""]])
    return headings, worst


def setup(app):
    """Register with Sphinx."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
