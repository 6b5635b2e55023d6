"""``vizlight view FILE``: light a mesh, write a page that shows it, and open the page."""

from __future__ import annotations

import tempfile
import webbrowser
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from vizlight._words import message
from vizlight.cli import options
from vizlight.cli.arguments import (
    CAMERA,
    LIGHT,
    LIT,
    MATERIAL,
    OUTPUT,
    Color,
    Common,
    Eye,
    Finish,
    Flag,
    Lights,
    Output,
    Target,
)
from vizlight.cli.job import HTML, carry_out
from vizlight.cli.light import builder
from vizlight.cli.output import OK, complain


@dataclass(frozen=True, kw_only=True)
class Window:
    """Page that is written and opened.

    Parameters
    ----------
    output
        File .html of the page. Default: one in a private temporary folder.
    browser
        Open the page in the browser.
    background
        Colour behind the mesh. Default: white, or black behind lines and points.
    line_width
        Width of lines in pixels.
    progress
        Show a progress bar.
    """

    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None
    browser: bool = True
    background: str | None = None
    line_width: float = 1.0
    progress: Flag = False


@options.takes("illuminate", "Shading", without=("positions",))
def view(
    file: Path,
    /,
    *,
    target: Annotated[Target, LIT] = Target(),  # noqa: B008
    how: object = None,
    lights: Annotated[Lights, LIGHT] = Lights(),  # noqa: B008
    finish: Annotated[Finish, MATERIAL] = Finish(),  # noqa: B008
    eye: Annotated[Eye, CAMERA] = Eye(),  # noqa: B008
    color: Annotated[Color, OUTPUT] = Color(),  # noqa: B008
    window: Annotated[Window, OUTPUT] = Window(),
) -> int:
    """Light a mesh as the command light does, and open a page whose light follows the reader's eye.

    Parameters
    ----------
    file
        Mesh to show.
    """
    from vizlight.files import FileError

    page = window.output
    if page is not None and page.suffix.lower() != HTML:
        expected = f"a name that ends in {HTML}"
        raise FileError(message("output", expected, f"'{page}'"))
    folder = None
    if page is None:
        # Only this user may look into the folder.
        folder = Path(tempfile.mkdtemp(prefix="vizlight-"))
        page = folder / f"{file.stem}{HTML}"
    try:
        out = Output(
            output=[page],
            background=window.background,
            line_width=window.line_width,
            progress=window.progress,
        )
        common = Common(lights=lights, finish=finish, eye=eye, out=out)
        build = builder(target, how, common, color)
        code = carry_out([file], build, out, "view", target)
        if folder is not None:
            page.chmod(0o600)
    finally:
        if folder is not None and not page.exists():
            folder.rmdir()
    if code == OK and window.browser and not webbrowser.open(page.resolve().as_uri()):
        complain(f"no browser was found; open '{page}' in one")
    return code
