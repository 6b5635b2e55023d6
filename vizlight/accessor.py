"""The accessor ``mesh.vizlight``: filters and live light as methods of every PyVista mesh.

It is registered as an entry point of PyVista, so it is available without importing vizlight. To an
editor and a type checker PyVista's accessors are of any type; ``tools: Accessor = mesh.vizlight``
gives them the names, the options and their documentation.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Concatenate, Generic, ParamSpec, TypeVar

import pyvista as pv

import vizlight
from vizlight._types import Foreign, Function

__all__ = ["Accessor"]

Options = ParamSpec("Options")
Result = TypeVar("Result")


class _Method(Generic[Options, Result]):
    """A filter as a method, with its signature and text, which ``load`` returns at first use."""

    def __init__(self, load: Callable[[], Callable[Concatenate[Foreign, Options], Result]]) -> None:
        self._load = load

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, accessor: Accessor | None, owner: type) -> Callable[Options, Result]:
        function = self._load()

        @functools.wraps(function)
        def method(self: Accessor, /, *args: Options.args, **kwargs: Options.kwargs) -> Result:
            return function(self._mesh, *args, **kwargs)

        # The filter takes the place of this loader, so that it is found without it from then on.
        setattr(owner, self._name, method)
        result: Callable[Options, Result] = getattr(
            owner if accessor is None else accessor, self._name
        )
        return result


def _plot() -> Function:
    from vizlight.looks.show import plot

    return plot


class Accessor:
    """Methods that apply the filters of vizlight to one mesh."""

    def __init__(self, mesh: pv.DataObject) -> None:
        # Each filter checks the kind of mesh that it takes.
        self._mesh: Foreign = mesh

    def __repr__(self) -> str:
        names = ", ".join(name for name in sorted(vars(Accessor)) if name[0] != "_")
        return f"vizlight of {type(self._mesh).__name__}: {names}"

    bas_relief = _Method(lambda: vizlight.bas_relief)
    fur = _Method(lambda: vizlight.fur)
    illuminate = _Method(lambda: vizlight.illuminate)
    isoluminance = _Method(lambda: vizlight.isoluminance)
    legibility = _Method(lambda: vizlight.legibility)
    plot = _Method(_plot)
    live_html = _Method(lambda: vizlight.live_html)
    project = _Method(lambda: vizlight.project)
    provenance = _Method(lambda: vizlight.provenance)
    refine = _Method(lambda: vizlight.refine)
    relief_day = _Method(lambda: vizlight.relief_day)
    relief_shadow = _Method(lambda: vizlight.relief_shadow)
    save_gltf = _Method(lambda: vizlight.save_gltf)
    satin = _Method(lambda: vizlight.satin)
    sky = _Method(lambda: vizlight.sky)
    streamlines = _Method(lambda: vizlight.streamlines)
    tint = _Method(lambda: vizlight.tint)


# As a decorator it would hide the methods from type checkers.
pv.register_dataset_accessor("vizlight", pv.DataObject)(Accessor)
