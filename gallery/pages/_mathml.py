"""Formulas as MathML, which browsers render without a network and without a script."""

from __future__ import annotations

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml


def inline(visitor, node):
    """Write an inline formula."""
    visitor.body.append(tex2mathml(node.astext()))
    raise nodes.SkipNode


def block(visitor, node):
    """Write a displayed formula."""
    visitor.body.append(f'<div class="formula">{tex2mathml(node.astext(), as_block=True)}</div>')
    raise nodes.SkipNode


def setup(app):
    """Register with Sphinx."""
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
