"""Shapes as arrays; only NumPy and SciPy are used, no mesh and no file.

The modules are in the folders ``lines``, ``nspace``, ``solids``, ``contours`` and ``relief``; the
public ones are also attributes here, such as ``vizlight.geometry.manifolds``.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from types import ModuleType

    from vizlight.geometry import relief as relief
    from vizlight.geometry import solids as solids
    from vizlight.geometry.contours import isoluminance as isoluminance
    from vizlight.geometry.lines import curves as curves
    from vizlight.geometry.lines import fur as fur
    from vizlight.geometry.nspace import manifolds as manifolds
    from vizlight.geometry.nspace import projection as projection
    from vizlight.geometry.nspace import slices as slices
    from vizlight.geometry.relief import depth_map as depth_map
    from vizlight.geometry.relief import sun as sun
    from vizlight.geometry.solids import primitives as primitives

#: Places of the public modules and folders.
_PLACES = {
    "curves": "lines.curves",
    "depth_map": "relief.depth_map",
    "fur": "lines.fur",
    "isoluminance": "contours.isoluminance",
    "manifolds": "nspace.manifolds",
    "primitives": "solids.primitives",
    "projection": "nspace.projection",
    "relief": "relief",
    "slices": "nspace.slices",
    "solids": "solids",
    "sun": "relief.sun",
}


def __getattr__(name: str) -> ModuleType:
    """Import a public module on first use."""
    if name in _PLACES:
        return importlib.import_module(f"vizlight.geometry.{_PLACES[name]}")
    raise AttributeError(f"module 'vizlight.geometry' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(_PLACES)
