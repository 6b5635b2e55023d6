"""The commands, and their errors: one line on standard error and an exit code."""

from __future__ import annotations

import functools
import logging
import shlex
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path

from cyclopts import CycloptsError

from vizlight._supervise import BAD_INPUT, LACKING
from vizlight.cli import commands, options  # noqa: F401 - the commands are in app
from vizlight.cli.options import HELP, Backend, app
from vizlight.cli.output import OK, add_note, complain, console, draw, notes_at_end, one_line, say


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code; errors are one line on standard error.

    Parameters
    ----------
    arguments : sequence of str, optional
        Words after ``vizlight``. Default: the process's own.
    """
    words = sys.argv[1:] if arguments is None else list(arguments)
    logging.disable()  # PyVista logs what VTK says, which the message of an error says too
    try:
        with warnings.catch_warnings(), notes_at_end():
            warnings.showwarning = _note
            words = _with_command(words)
            if HELP.intersection(words):
                # By itself the app reads all arguments of the command before it prints its help.
                app.help_print([word for word in words if word not in HELP])
                return OK
            result = app(words, exit_on_error=False, print_error=False, help_on_error=False)
    except CycloptsError as error:
        return _fail(str(error).replace("Unused Tokens", "arguments that belong to no option"))
    except (TypeError, ValueError, OSError) as error:
        return _fail(error)
    except MemoryError:
        return _fail("not enough memory")
    except KeyboardInterrupt:
        return _fail("interrupted")
    finally:
        logging.disable(logging.NOTSET)
    return result if isinstance(result, int) else OK


def _with_command(words: list[str]) -> list[str]:
    """Return the words of a command; ``vizlight FILE`` is short for ``vizlight light FILE``."""
    first = words[0] if words else ""
    if first == "hillshade":  # its name elsewhere
        words = ["relief", *words[1:]]
    path = Path(first)
    is_path = path.suffix or (len(path.parts) > 1 and path.exists())
    # A name without a suffix may be that of a command.
    is_path = is_path or (path.is_dir() and first and not options.is_command(first))
    if not first.startswith("-") and is_path:
        words = ["light", *words]
    options.add_commands(words[0] if words else "")
    return words


def _note(message: Warning | str, category: type[Warning], *_: object, **__: object) -> None:
    # The error of reading repeats VTK's words.
    if category.__name__ != "VTKExecutionWarning":
        add_note(message)


def _fail(error: object) -> int:
    complain(one_line(error))
    return BAD_INPUT


@app.command
def demo(
    *, out: Path = Path("vizlight-demo"), size: str = "1200x500", backend: Backend | None = None
) -> int:
    """Light measured winds so that hue is their direction.

    Writes flow.png and flow.vtp and prints a table: points, terms, time, the error against a
    float64 reference that shares no code with the engine, and how well the direction of the wind
    can be read.

    Parameters
    ----------
    out
        The folder to write to; made if it is missing.
    size
        Width and height of the picture in pixels.
    backend
        Library that draws: egl (the default) or osmesa.
    """
    from rich.table import Table

    from vizlight import demo, files, writing

    pixels = options.pixels(size)
    writing.make_folder("out", out)
    winds = demo.light_winds()
    mesh = files.write_mesh(winds.globe, out / "flow.vtp")
    table = Table(title="The winds of July, lit by their direction")
    for heading in ("light", "points", "terms", "time, ms", "error", "within 10°", "by the key"):
        table.add_column(heading, justify="left" if heading in ("light", "terms") else "right")
    for lamp, terms, milliseconds, error, read in winds.rows:
        by_key = "unreadable" if read.unreadable else f"{read.median:.1f}°"
        table.add_row(
            lamp, f"{winds.globe.n_points}", terms, f"{milliseconds:.2f}", f"{error:.1e}",
            f"{read.within_10:.0%}", by_key,
        )  # fmt: skip
    shown = console()
    shown.print(table)
    shown.print("Error: the largest of float32 luminance against plain NumPy in float64.")
    shown.print("Within 10°: share of the picture where the direction is read by the key.")
    shown.print("By the key: median error of a reader who matches hues; 45° is chance. The plan:")
    shown.print(winds.plan, highlight=False)
    shown.print(f"mesh     {mesh}", highlight=False)
    picture = functools.partial(
        demo.save_picture, winds, out / "flow.png", size=pixels, backend=backend
    )
    return draw(picture)


app.register_install_completion_command(help="Install shell completion.")


@app.command
def doctor() -> int:
    """Print the installed packages, the library that draws, and how to get missing ones."""
    from rich.table import Table

    from vizlight import doctor
    from vizlight.draw import render

    table = Table("part", "found", title="vizlight doctor")
    table.columns[1].overflow = "fold"
    for part, finding in doctor.findings():
        table.add_row(part, finding)
    console().print(table)
    try:
        render.choose_backend()
    except render.BackendError as error:
        complain(error)
        return LACKING
    return OK


@app.command
def paraview() -> int:
    """Print the paths of the plugin for ParaView and of its scripts, and how to start ParaView.

    PYTHONPATH is the folder of the plugin; its sitecustomize.py lets ParaView's Python find
    vizlight alone.
    """
    folder = Path(__file__).resolve().parents[1] / "vtk" / "paraview"
    for part, name in (
        ("plugin", "vizlight_plugin.py"),
        ("startup", "sitecustomize.py"),
        ("eye", "vizlight_eye.py"),
    ):
        say(f"{part:8} {folder / name}")
    say(f"start    PYTHONPATH={shlex.quote(str(folder))} paraview")
    return OK
