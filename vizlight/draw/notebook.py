"""Notebooks and exported scenes: live light is drawn by Python, or by a page of its own."""

from __future__ import annotations

import html
import importlib.util
import sys
import weakref

import pyvista as pv

from vizlight import _check
from vizlight._types import Foreign, Function

#: Takes a plotter and the options of the backend, returns what the notebook displays.
Handler = Function

#: Backends that draw in the browser, or may: there nothing computes the light.
DRAWN_BY_THE_BROWSER = ("client", "html", "trame")
#: Component of a plotter for notebooks.
TRAME = "trame"
#: Methods of a plotter, and of its component ``trame``, that write scenes for other renderers.
EXPORTS = ("export_html", "export_vtksz", "export_gltf", "export_obj", "export_vrml")


#: Least height of a page in a notebook, in pixels.
LOWEST = 420
#: What a page in a frame may do: run, save pictures and copy texts; nothing of the notebook.
SANDBOX = "allow-scripts allow-downloads allow-modals"


class Frame:
    """A page within a notebook, which stays interactive where the notebook is exported."""

    def __init__(self, text: str, height: int) -> None:
        self.text, self.height = text, height

    def _repr_html_(self) -> str:
        """Return the frame as a notebook displays it."""
        style = f"width: 100%; height: {self.height}px; border: 0"
        return (
            f'<iframe srcdoc="{html.escape(self.text, quote=True)}" sandbox="{SANDBOX}" '
            f'allow="clipboard-write; fullscreen" style="{style}" title="Lit scene"></iframe>'
        )


class Guarded:
    """A backend of PyVista that draws plotters with live light on the server or as a page."""

    def __init__(self, name: str, handler: Handler) -> None:
        self.name, self.handler = name, handler

    def __call__(self, plotter: pv.BasePlotter, **options: object) -> object:
        """Show a plotter."""
        if is_live(plotter):
            mode = options.get("mode") or self.name
            if mode == "html":
                return _frame(plotter)
            if mode == "client":
                expected = "'html', or server rendering for light that follows the camera"
                remedy = "pass jupyter_backend='html' or 'server'"
                raise _check.value_error("jupyter_backend", expected, repr(mode), remedy)
            # The backend "trame" has a button that would leave the drawing to the browser.
            options["mode"] = "server"
        return self.handler(plotter, **options)


def _frame(plotter: pv.BasePlotter) -> Frame:
    """Return the page of a plotter with live light, as high as its window."""
    from vizlight.draw.html import page_text

    shown = plotter.vizlight.shown()
    height = max(int(plotter.window_size[1]), LOWEST)
    return Frame(page_text(shown, plotter, panel=False), height)


def is_live(plotter: pv.BasePlotter) -> bool:
    """Return whether a plotter shows a mesh with live light."""
    return bool(plotter.vizlight.has_live_light)


def _static(plotter: pv.BasePlotter, **options: object) -> object:
    """Show a picture, by functions that need IPython."""
    from pyvista.jupyter.notebook import show_static_image

    shown: object = show_static_image(plotter, **options)  # type: ignore[arg-type]
    return shown


def guard() -> None:
    """Let the backends of PyVista that draw in the browser know of live light."""
    backends = pv.jupyter.registered_jupyter_backends()
    if all(registered.name != "html" for registered in backends):
        # Without trame, which live light does not need, other plotters are pictures as before.
        pv.jupyter.register_jupyter_backend("html", Guarded("html", _static), override=True)
    for registered in backends:
        if registered.name in DRAWN_BY_THE_BROWSER and not isinstance(registered.handler, Guarded):
            guarded = Guarded(registered.name, registered.handler)
            pv.jupyter.register_jupyter_backend(registered.name, guarded, override=True)


def _refusing(plotter: pv.BasePlotter, owner: Foreign, name: str) -> Function:
    """Return a method that writes the scene, unless it has live light."""
    # The owner has this as an attribute, and is to be released with its last reference.
    weak = weakref.ref(plotter), weakref.ref(owner)

    def export(*arguments: object, **options: object) -> object:
        plotter, owner = (ref() for ref in weak)
        if plotter is not None and is_live(plotter):
            remedy = (
                "call plotter.vizlight.export_html or vizlight.live_html for a page whose light "
                "follows the eye, or draw the result of vizlight.illuminate or vizlight.tint by "
                "plotter.add_mesh(lighting=False)"
            )
            expected = "a scene without light that follows the camera, which this file cannot hold"
            # PyVista's gallery keeps the picture of a plotter whose scene it cannot export.
            kind = ImportError if pv.BUILDING_GALLERY else ValueError
            raise kind(_check.message(name, expected, "live light", remedy))
        return getattr(type(owner), name)(owner, *arguments, **options)

    return export


class _Component:
    """The component ``trame`` of a plotter, which is imported when something of it is asked for."""

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter = weakref.ref(plotter)

    def __getattr__(self, name: str) -> object:
        plotter = self._plotter()
        if plotter is None:
            raise AttributeError(name)
        # Once this is out of the way, the plotter makes the real component under the same name.
        vars(plotter).pop(TRAME, None)
        _guard(plotter, getattr(plotter, TRAME))
        return getattr(getattr(plotter, TRAME), name)


def guard_exports(plotter: pv.BasePlotter) -> None:
    """Let the methods of a plotter that export its scene know of live light."""
    _guard(plotter, plotter)
    if "trame_pyvista" in sys.modules:
        _guard(plotter, getattr(plotter, TRAME))
    elif importlib.util.find_spec("trame_pyvista") is not None:
        # Not imported yet: a stand-in spares the import until something of it is asked for.
        vars(plotter).setdefault(TRAME, _Component(plotter))


def _guard(plotter: pv.BasePlotter, owner: Foreign) -> None:
    for name in EXPORTS:
        if callable(getattr(owner, name, None)) and name not in vars(owner):
            setattr(owner, name, _refusing(plotter, owner, name))
