"""The accessor ``mesh.vizlight``: filters and live light as methods of every PyVista mesh.

It is registered as an entry point of PyVista, so it is available without importing vizlight.
"""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeVar

import pyvista as pv

from vizlight import filters
from vizlight.plotting import component, gltf, html

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Accessor"]

Options = ParamSpec("Options")
Result = TypeVar("Result")


def _method(
    function: Callable[Concatenate[Any, Options], Result],
) -> Callable[Concatenate[Accessor, Options], Result]:
    """Return a filter as a method with the signature and the documentation of the filter."""

    @functools.wraps(function)
    def method(self: Accessor, /, *args: Options.args, **kwargs: Options.kwargs) -> Result:
        return function(self._mesh, *args, **kwargs)

    return method


@pv.register_dataset_accessor("vizlight", pv.DataObject)
class Accessor:
    """Methods that apply the filters of vizlight to one mesh."""

    def __init__(self, mesh: pv.DataObject) -> None:
        # Each filter checks the kind of mesh that it takes.
        self._mesh: Any = mesh

    def __repr__(self) -> str:
        names = (*filters.__all__, "plot", "live_html", "save_gltf")
        known = ", ".join(name for name in names if hasattr(self, name))
        return f"vizlight of {type(self._mesh).__name__}: {known}"

    bas_relief = _method(filters.bas_relief)
    fur = _method(filters.fur)
    illuminate = _method(filters.illuminate)
    isoluminance = _method(filters.isoluminance)
    plot = _method(component.plot)
    live_html = _method(html.live_html)
    project = _method(filters.project)
    provenance = _method(filters.provenance)
    refine = _method(filters.refine)
    relief_day = _method(filters.relief_day)
    relief_from_mesh = _method(filters.relief_from_mesh)
    relief_shadow = _method(filters.relief_shadow)
    save_gltf = _method(gltf.save_gltf)
    satin = _method(filters.satin)
    streamlines = _method(filters.streamlines)
    tint = _method(filters.tint)
