"""What the command line prints and draws, and its exit codes."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    import pyvista as pv

    from vizlight.pictures.render import Backend, Panel

#: Exit codes: success; no picture or a machine that lacks something; bad input.
OK, LACKING, BAD_INPUT = 0, 1, 2


def say(text: str) -> None:
    """Write a line to standard output."""
    sys.stdout.write(f"{text}\n")


def complain(text: object) -> None:
    """Write a line to standard error."""
    sys.stderr.write(f"vizlight: {text}\n")


def draw(
    panels: Panel | Sequence[Panel],
    path: Path,
    *,
    camera: pv.Camera,
    size: tuple[int, int],
    background: str | None = None,
    line_width: float = 1.0,
    backend: Backend | None = None,
) -> int:
    """Draw a picture and return the exit code; without a library that draws print a message."""
    from vizlight import render

    try:
        made = render.save_png(
            panels,
            path,
            camera=camera,
            size=size,
            background=background,
            line_width=line_width,
            backend=backend,
        )
    except render.BackendError as error:
        complain(error)
        return LACKING
    say(f"picture  {made}")
    return OK
