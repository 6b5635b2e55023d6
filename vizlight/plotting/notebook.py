"""Notebooks: light that follows the camera needs the renderer that Python has."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyvista as pv

from vizlight import _check

if TYPE_CHECKING:
    from collections.abc import Callable

    #: Takes a plotter and the options of the backend, returns what the notebook displays.
    Handler = Callable[..., object]

#: Backends that draw in the browser, or may: there nothing computes the light.
DRAWN_BY_THE_BROWSER = ("client", "html", "trame")


class Guarded:
    """A backend of PyVista that draws plotters with live light on the server or refuses them."""

    def __init__(self, name: str, handler: Handler) -> None:
        self.name, self.handler = name, handler

    def __call__(self, plotter: pv.BasePlotter, **options: object) -> object:
        """Show a plotter.

        Raises
        ------
        ValueError
            If the browser would draw live light.
        """
        if is_live(plotter):
            mode = options.get("mode") or self.name
            if mode in ("client", "html"):
                expected = "server rendering for light that follows the camera"
                remedy = (
                    "pass jupyter_backend='server', or draw the result of vizlight.illuminate or "
                    "vizlight.tint by plotter.add_mesh(lighting=False)"
                )
                raise ValueError(_check.message("jupyter_backend", expected, repr(mode), remedy))
            # The backend "trame" has a button that would leave the drawing to the browser.
            options["mode"] = "server"
        return self.handler(plotter, **options)


def is_live(plotter: pv.BasePlotter) -> bool:
    """Return whether a plotter shows a mesh with live light."""
    return bool(plotter.vizlight.has_live_light)


def guard() -> None:
    """Let the backends of PyVista that draw in the browser know of live light."""
    for registered in pv.jupyter.registered_jupyter_backends():
        if registered.name in DRAWN_BY_THE_BROWSER and not isinstance(registered.handler, Guarded):
            guarded = Guarded(registered.name, registered.handler)
            pv.jupyter.register_jupyter_backend(registered.name, guarded, override=True)
