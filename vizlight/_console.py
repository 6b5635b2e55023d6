"""The console that tables are printed on."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

#: Characters per line where the output is a file or a pipe, which has no width of its own.
WIDTH = 140


def console() -> Console:
    """Return a console as wide as the terminal, or ``WIDTH`` wide where there is no terminal."""
    from rich.console import Console

    # Brackets in the text, as in an extra of a package, are not markup.
    own = Console(markup=False)
    return own if own.is_terminal else Console(width=WIDTH, markup=False)
