"""The page on this machine alone: its address holds a token, and it serves only its own files."""

from __future__ import annotations

import asyncio
import contextlib
import os
import secrets
import signal
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

from aiohttp import web
from trame.app import get_server
from trame_client.module import vue3

from vizlight.cli.output import say
from vizlight.view import HOST
from vizlight.view.layout import lay_out
from vizlight.view.page import Page

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from vizlight.view.stage import Stage
    from vizlight.view.state import Facts
    from vizlight.view.worker import Worker

    Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]

__all__ = ["run"]

#: Names by which a browser may know this machine; others are those of other sites that a name
#: server sends here.
HOSTS = {HOST, "localhost"}
HEADERS = {
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Content-Security-Policy": "frame-ancestors 'none'",
    "Cache-Control": "no-store",
}


async def _own_pages(request: web.Request, handler: Handler) -> web.StreamResponse:
    """Refuse requests that other sites make, and keep the address from them."""
    host = urlsplit(f"//{request.headers.get('Host', '')}").hostname
    origin = request.headers.get("Origin")
    if host not in HOSTS or origin not in (None, f"http://{request.headers['Host']}"):
        raise web.HTTPForbidden(text="only pages of this address are answered")
    response = await handler(request)
    if not response.prepared:
        response.headers.update(HEADERS)
    return response


def run(worker: Worker, facts: Facts, stage: Stage, *, port: int = 0, browser: bool = True) -> None:
    """Serve the page of a file until Ctrl-C.

    Parameters
    ----------
    worker, facts, stage
        See :class:`vizlight.view.page.Page`.
    port : int
        Port to listen on; 0 for any that is free.
    browser : bool
        Whether the page is opened in the browser of this machine.

    Raises
    ------
    OSError
        If the port is taken.
    """
    # Where an event loop has no signals Ctrl-C is an exception.
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(_serve(worker, facts, stage, port, browser=browser))
    # Ctrl-C once more must not disturb the end of the process.
    signal.signal(signal.SIGINT, signal.SIG_IGN)


async def _serve(worker: Worker, facts: Facts, stage: Stage, port: int, *, browser: bool) -> None:
    token = secrets.token_hex(16)
    # Without this trame reads the words of this command line.
    os.environ["TRAME_ARGS"] = f"--no-http --ws-endpoint {token}/ws"
    server = get_server(f"vizlight-{token}", client_type="vue3")
    page = Page(server, worker, facts, stage)
    lay_out(page)

    def add_routes(served: Any) -> None:
        served.app.middlewares.append(web.middleware(_own_pages))
        index = Path(vue3.www) / "index.html"

        async def answer(_: web.Request) -> web.FileResponse:
            return web.FileResponse(index)

        served.app.router.add_get(f"/{token}/", answer)
        folders = {**server.serve, "": vue3.www}
        for place, folder in folders.items():
            path = folder[0] if isinstance(folder, list | tuple) else folder
            served.app.router.add_static(f"/{token}/{place}".rstrip("/"), path)

    def ready(**_: Any) -> None:
        address = f"http://{HOST}:{server.port}/{token}/"
        say(f"page     {address}  (Ctrl-C ends)")
        page.start()
        if browser:
            asyncio.get_running_loop().run_in_executor(None, webbrowser.open, address)

    server.controller.on_server_bind.add(add_routes)
    server.controller.on_server_ready.add(ready)
    ended = asyncio.Event()
    loop = asyncio.get_running_loop()
    for name in (signal.SIGINT, signal.SIGTERM):
        with contextlib.suppress(NotImplementedError):
            loop.add_signal_handler(name, ended.set)
    try:
        await _until(server, ended, port)
    finally:
        page.close()


async def _until(server: Any, ended: asyncio.Event, port: int) -> None:
    """Serve until an event."""
    serving = asyncio.ensure_future(
        server.start(
            host=HOST, port=port, exec_mode="coroutine", thread=True, timeout=0,
            open_browser=False, show_connection_info=False, disable_logging=True,
        )
    )  # fmt: skip
    waiting = asyncio.ensure_future(ended.wait())
    await asyncio.wait({serving, waiting}, return_when=asyncio.FIRST_COMPLETED)
    if not serving.done():
        await server.stop()
    waiting.cancel()
    await serving
