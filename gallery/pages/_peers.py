"""The directive ``peers``: the pictures of a scene, what they took, the scripts that drew them."""

from __future__ import annotations

import ast
import sys
from pathlib import Path

from sphinx.util.docutils import SphinxDirective

sys.path.append(str(Path(__file__).resolve().parent))
from peers import kept

HEADINGS = (
    "picture", "lines of code", "points", "triangles and segments",
    "processor time to the picture, s", "ratio", "each further frame, s", "memory, MB",
)  # fmt: skip


def title(script):
    """Return the first line of a script, which names its picture."""
    return ast.get_docstring(ast.parse(script.read_text(encoding="utf-8"))).rstrip(".")


def pictures(scene, scripts):
    """Return lines of reST: a grid of pictures."""
    lines = [".. grid:: 1 2 3 3", "   :gutter: 2", ""]
    for script in scripts:
        path = kept.picture(scene, script).relative_to(kept.HERE.parent).as_posix()
        lines += [
            "   .. grid-item::", "",
            f"      .. figure:: /{path}", f"         :alt: {title(script)}", "",
            f"         {title(script)}", "",
        ]  # fmt: skip
    return lines


def measured(scene, scripts):
    """Return lines of reST: the table of a scene."""
    table = kept.read()
    rows = [table[scene, script.relative_to(kept.HERE).as_posix()] for script in scripts]
    lines = [".. list-table::", "   :header-rows: 1", "   :class: numbers", ""]
    cells = [HEADINGS]
    for script, row in zip(scripts, rows, strict=True):
        ratio = float(row["cpu_s"]) / float(rows[0]["cpu_s"])
        cells.append(
            (
                title(script), row["code_lines"], f"{int(row['points']):,}",
                f"{int(row['pieces']):,}" if int(row["pieces"]) else "..", row["cpu_s"],
                f"{ratio:.1f}", row["frame_cpu_s"] or "..", row["memory_mb"],
            )
        )  # fmt: skip
    for row in cells:
        lines += [f"   {'*' if i == 0 else ' '} - {cell}" for i, cell in enumerate(row)]
    return [*lines, ""]


def code(scripts):
    """Return lines of reST: the scripts, closed until they are asked for."""
    lines = []
    for script in scripts:
        path = script.relative_to(kept.HERE.parent).as_posix()
        lines += [
            f".. dropdown:: {title(script)}: {kept.code_lines(script)} lines", "",
            f"   .. literalinclude:: /{path}", "      :language: python", "      :lines: 3-", "",
        ]  # fmt: skip
    return lines


class Peers(SphinxDirective):
    """``.. peers:: SCENE``; with the option ``pictures`` without the table and the scripts."""

    required_arguments = 1
    option_spec = {"pictures": lambda _: True}  # noqa: RUF012 (as docutils has it)

    def run(self):
        """Return the nodes."""
        scene = self.arguments[0]
        scripts = [script for name, script in kept.todo() if name == scene]
        lines = pictures(scene, scripts)
        if "pictures" not in self.options:
            lines += measured(scene, scripts) + code(scripts)
        self.env.note_dependency(str(kept.TABLE))
        return self.parse_text_to_nodes("\n".join(lines))


class Measured(SphinxDirective):
    """``.. peers-measured::``: with what and when the tables were measured."""

    def run(self):
        """Return the nodes."""
        rows = kept.read().values()
        tools = "; ".join(sorted({row["tool"] for row in rows}))
        dates = " and ".join(sorted({row["date"] for row in rows}))
        systems = "; ".join(sorted({row["system"] for row in rows}))
        return self.parse_text_to_nodes(f"Measured on {dates} ({systems}) with {tools}.")


def setup(app):
    """Register with Sphinx."""
    app.add_directive("peers", Peers)
    app.add_directive("peers-measured", Measured)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
