"""What search engines and messengers show of a page: its first paragraph, and a picture."""

from __future__ import annotations

import html
import textwrap

from docutils import nodes

DEFAULT = "Light that makes scientific data legible, as point scalars on PyVista meshes."
IMAGE = "https://raw.githubusercontent.com/vizlight/vizlight/main/gallery/looks.jpg"


def describe(_app, _page, _template, context, doctree):
    """Add the description, and the tags of the Open Graph protocol, to the head of a page."""
    paragraphs = doctree.findall(nodes.paragraph) if doctree else ()
    first = next((text for p in paragraphs if len(text := p.astext()) > 40), DEFAULT)
    text = html.escape(textwrap.shorten(first, 200, placeholder=" ..."))
    title = html.escape(html.unescape(context.get("title") or "vizlight"))
    context["metatags"] = context.get("metatags", "") + (
        f'\n<meta name="description" content="{text}">'
        f'\n<meta property="og:type" content="website">'
        f'\n<meta property="og:title" content="{title}">'
        f'\n<meta property="og:description" content="{text}">'
        f'\n<meta property="og:image" content="{IMAGE}">\n'
    )


def setup(app):
    """Register with Sphinx."""
    app.connect("html-page-context", describe)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
