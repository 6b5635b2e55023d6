"""``vizlight view FILE``: tune a picture by eye on a page of this machine."""

from __future__ import annotations

import importlib.util
import os
import socket
from pathlib import Path  # noqa: TC003 - cyclopts reads the annotations

from vizlight import _check, _supervise
from vizlight.cli.arguments import Flag  # noqa: TC001
from vizlight.cli.output import LACKING, OK, complain
from vizlight.view import HOST

#: Packages of the extra.
NEEDED = ("trame", "trame_vuetify", "trame_vtk", "aiohttp")


def view(file: Path, /, *, port: int = 0, browser: bool = True, salvage: Flag = False) -> int:
    """Tune array, colours, light and material by eye, on a page of this machine alone.

    The page copies its picture as a Python script. Ctrl-C ends it.

    Parameters
    ----------
    file
        Mesh to show.
    port
        Port of the page. Default: a free one.
    browser
        Open the page in the browser; otherwise only print its address.
    salvage
        Use what could be read of a damaged file.
    """
    missing = [name for name in NEEDED if importlib.util.find_spec(name) is None]
    if missing:
        expected, got = f"the package {missing[0]}", "none"
        remedy = "install it by: pip install 'vizlight[view]'"
        raise ValueError(_check.message("view", expected, got, remedy))
    _check_port(port)
    from vizlight.files import FileError
    from vizlight.view.worker import Worker

    if not file.is_file():
        raise FileError(_check.message("file", "a file", f"'{file}' (no such file)"))
    worker = Worker(file, salvage=salvage)
    worker.begin()
    try:
        # The file is read meanwhile.
        from vizlight.pictures.backends import BackendError
        from vizlight.view import serving
        from vizlight.view.stage import Stage

        try:
            stage = Stage()
        except BackendError as error:
            complain(error)
            return LACKING
        serving.run(worker, worker.facts(), stage, port=port, browser=browser)
    finally:
        worker.stop()
    return _supervise.leave(OK)


def _check_port(port: int) -> None:
    """Check that a port can be listened on, before a file is read for long."""
    if not 0 <= port < 65536:
        raise ValueError(_check.message("--port", "a number from 0 to 65535", port))
    with socket.socket() as trial:
        try:
            if os.name == "posix":
                trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            trial.bind((HOST, port))
        except OSError as error:
            expected, remedy = "a port that can be listened on", "leave it out for a free one"
            got = f"{port} ({error.strerror})"
            raise ValueError(_check.message("--port", expected, got, remedy)) from error
