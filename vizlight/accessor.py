"""``mesh.vizlight``: the filters as methods of every PyVista mesh.

Installed as an entry point of PyVista, so that no import is needed.
"""

from __future__ import annotations

import functools
import inspect
from typing import TYPE_CHECKING, Any

import pyvista as pv

from vizlight import filters

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Accessor"]


def _method(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a filter as a method: signature and documentation are the filter's."""

    @functools.wraps(function)
    def method(self: Accessor, *arguments: Any, **options: Any) -> Any:
        return function(self._mesh, *arguments, **options)

    mesh, *others = inspect.signature(function).parameters.values()
    method.__signature__ = inspect.Signature([mesh.replace(name="self"), *others])  # type: ignore[attr-defined]
    return method


@pv.register_dataset_accessor("vizlight", pv.DataObject)
class Accessor:
    """The filters of vizlight on one mesh."""

    def __init__(self, mesh: Any) -> None:
        self._mesh = mesh

    def __repr__(self) -> str:
        known = ", ".join(name for name in dir(type(self)) if name[0] != "_")
        return f"vizlight of {type(self._mesh).__name__}: {known}"

    fur = _method(filters.fur)
    illuminate = _method(filters.illuminate)
    isoluminance = _method(filters.isoluminance)
    project = _method(filters.project)
    provenance = _method(filters.provenance)
    relief_day = _method(filters.relief_day)
    relief_from_mesh = _method(filters.relief_from_mesh)
    relief_shadow = _method(filters.relief_shadow)
    satin = _method(filters.satin)
    streamlines = _method(filters.streamlines)
