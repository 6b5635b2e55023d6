"""The pages of the studies: each study is run with ``--quick`` when the pages are built."""

from __future__ import annotations

import csv
import re
import shutil
from pathlib import Path

from sphinx.util.display import status_iterator

from vizlight import studies
from vizlight.studies._results import number

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
        kept = name == "stability"
        result = _kept(study, source / KEPT) if kept else studies.run(name, study, quick=True)
        result.draw(folder / f"{name}.png")
        headings, rows = _worst(result) if kept else result.table()
        cells = [[_plain(number(cell)) for cell in row] for row in rows]
        approximates, verdict = _plain(study.approximates), _plain(result.verdict)
        overview.append([f":doc:`{name} <studies/{name}>`", approximates, verdict])
        page = [
            name, "=" * len(name), "",
            f"Approximated: {approximates}.", "",
            f"Reference: {_plain(study.reference)}.", "",
            f"**Verdict**: {verdict}.", "",
            f".. figure:: {name}.png", f"   :alt: {study.error} over {study.cost}", "",
            f"   ``vizlight study {name}{'' if kept else ' --quick'}``.", "",
            *_table(map(_plain, headings), cells),
        ]  # fmt: skip
        (folder / f"{name}.rst").write_text("\n".join(page) + "\n", encoding="utf-8")
    table = _table(["study", "what is approximated", "verdict"], overview, "12 28 60")
    (folder / "_verdicts.txt").write_text("\n".join(table) + "\n", encoding="utf-8")


def _plain(text):
    """Return text with the markup characters of reStructuredText escaped."""
    return re.sub(r"([\\`*_|])", r"\\\1", text)


def _table(headings, rows, widths="auto"):
    lines = [".. list-table::", "   :header-rows: 1", "   :class: numbers", f"   :widths: {widths}"]
    for row in [headings, *rows]:
        lines += [f"   {'*' if i == 0 else ' '} - {cell or '..'}" for i, cell in enumerate(row)]
    return [*lines[:4], "", *lines[4:], ""]


def _kept(study, path):
    """Return the result that was written to a file."""
    with path.open(newline="", encoding="utf-8") as file:
        _, *lines = csv.reader(file)
    more = ("type", "case", "seen / claimed", "inputs", "")
    rows = [
        studies.Row(way, *map(float, numbers), dict(zip(more, rest, strict=True)))
        for way, *numbers, rest in ((*line[:4], line[4:]) for line in lines)
    ]
    return studies.Result(path.stem, study, rows, study.verdict(rows))


def _worst(result):
    """Return headings, and for each kernel and type its worst case."""
    headings = ["kernel", "type", "inputs", "worst case", "claimed, eps", "seen, eps", ""]
    lines = []
    for key in dict.fromkeys((row.way, row.more["type"]) for row in result.rows):
        own = [row for row in result.rows if (row.way, row.more["type"]) == key]
        top = max(own, key=lambda row: float(row.more["seen / claimed"]))
        inputs = sum(int(row.more["inputs"]) for row in own)
        more = top.more
        lines.append([*key, f"{inputs}", more["case"], top.parameter, top.error, more[""]])
    return headings, lines


def setup(app):
    """Register with Sphinx."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
