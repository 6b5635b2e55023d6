"""Lighter pages: what the theme loads and these pages do not use is left out of each."""

from __future__ import annotations

import re

#: Scripts of every page that only the page of the search needs, and icons that are a font as well.
UNUSED = re.compile(
    r'\s*<script[^>]* src="[^"]*\b(?:fontawesome|searchtools|language_data|searchindex)\.js[^"]*">'
    r"</script>"
)
#: What lays out cards and tabs.
DESIGN = re.compile(
    r'\s*<(?:link|script)[^>]* (?:href|src)="[^"]*\b(?:sphinx-design\.min\.css|'
    r'design-tabs\.js)[^"]*"[^>]*>(?:</script>)?'
)
#: Buttons of the menu of names, which have an icon alone.
BUTTON = re.compile(r'<summary>(?=<span class="toctree-toggle")')
#: What the theme writes to the console of the browser.
MESSAGE = re.compile(r"console\.(?:log|info)\(")
#: Names of modules and functions, which are too long for one row of a telephone.
TITLE = re.compile(r"(?<=<h1>)[\w.]+(?=<)")


def lighten(text):
    """Return a page without unused scripts, with names for buttons and titles that may break."""
    text = UNUSED.sub("", text)
    if 'class="sd-' not in text:
        text = DESIGN.sub("", text)
    text = BUTTON.sub('<summary aria-label="Show or hide what is below">', text)
    return TITLE.sub(lambda name: re.sub(r"([._])", r"\1<wbr>", name[0]), text)


def lighten_all(app, error):
    """Rewrite the pages that were built, and silence the theme."""
    if error is None and app.builder.format == "html":
        for page in app.outdir.rglob("*.html"):
            if page.name != "search.html" and "_static" not in page.parts:
                page.write_text(lighten(page.read_text("utf-8")), "utf-8")
        for path in ("_static/scripts/pydata-sphinx-theme.js", "search.html"):
            script = app.outdir / path
            script.write_text(MESSAGE.sub("void(", script.read_text("utf-8")), "utf-8")


def setup(app):
    """Register with Sphinx."""
    app.connect("build-finished", lighten_all)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
