"""Shapes as arrays; only NumPy and SciPy are used, no mesh and no file.

Every public module has a short name here, such as ``vizlight.geometry.manifolds``. The modules
themselves are in the folders ``lines``, ``nspace``, ``solids``, ``contours`` and ``relief``.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from vizlight._aliases import GEOMETRY

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


def __getattr__(name: str) -> ModuleType:
    """Import a public module on first use."""
    if name in GEOMETRY or name in ("relief", "solids"):
        return importlib.import_module(f"vizlight.geometry.{name}")
    raise AttributeError(f"module 'vizlight.geometry' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*GEOMETRY, "relief", "solids"])
