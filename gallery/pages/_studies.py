"""The pages of the studies: each study is run with ``--quick`` when the pages are built."""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

from sphinx.util.display import status_iterator

#: Table of the stability suite, which ``.venv/bin/python tests/stability`` writes here.
KEPT = Path(__file__).resolve().with_name("stability.csv")
sys.path += [str(KEPT.parents[1]), str(KEPT.parents[2] / "tests")]


def write(app):
    """Write a page, a table and a figure for each study, and the table of all studies."""
    from stability import suite

    import studies

    source = Path(app.srcdir)
    folder = source / "studies"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    overview = []
    names = sorted([*studies.names(), KEPT.stem])
    for name in status_iterator(names, "measuring... ", "darkgreen", len(names)):
        if name == KEPT.stem:
            result, command = suite.read(KEPT), "python tests/stability"
            headings, rows = suite.worst(result.rows)
        else:
            result = studies.run(name, studies.load(name), quick=True)
            command = f"python gallery/studies {name} --quick"
            headings, rows = result.table()
        study = result.study
        result.draw(folder / f"{name}.png")
        cells = [[_plain(studies.number(cell)) for cell in row] for row in rows]
        approximates, reference = _plain(study.approximates), _plain(study.reference)
        overview.append([f":doc:`{name} <studies/{name}>`", approximates, reference])
        # The page of all charts includes this one.
        chart = [
            f".. figure:: studies/{name}.png", f"   :alt: {study.error} over {study.cost}", "",
            f"   :doc:`studies/{name}`: {approximates}.",
        ]  # fmt: skip
        (folder / f"_{name}.txt").write_text("\n".join(chart) + "\n", encoding="utf-8")
        page = [
            name, "=" * len(name), "",
            f"Approximated: {approximates}.", "",
            f"Reference: {reference}.", "",
            f".. figure:: {name}.png", f"   :alt: {study.error} over {study.cost}", "",
            f"   ``{command}``.", "",
            *_table(map(_plain, headings), cells),
        ]  # fmt: skip
        (folder / f"{name}.rst").write_text("\n".join(page) + "\n", encoding="utf-8")
    table = _table(["study", "what is approximated", "reference"], overview, "20 45 35")
    (folder / "_overview.txt").write_text("\n".join(table) + "\n", encoding="utf-8")


def _plain(text):
    """Return text with the markup characters of reStructuredText escaped."""
    return re.sub(r"([\\`*_|])", r"\\\1", text)


def _table(headings, rows, widths="auto"):
    lines = [".. list-table::", "   :header-rows: 1", "   :class: numbers", f"   :widths: {widths}"]
    for row in [headings, *rows]:
        lines += [f"   {'*' if i == 0 else ' '} - {cell or '..'}" for i, cell in enumerate(row)]
    return [*lines[:4], "", *lines[4:], ""]


def setup(app):
    """Register with Sphinx."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
