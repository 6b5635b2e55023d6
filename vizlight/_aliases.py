"""Import aliases: short public names of modules that are in deeper folders."""

from __future__ import annotations

import importlib
import sys
from importlib.machinery import ModuleSpec
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.abc import Loader
    from types import ModuleType
else:
    # The module of the base class takes 10 ms to load, and the import system needs only methods.
    Loader = object

#: Folder of each module that ``vizlight.geometry`` also offers under a short name.
GEOMETRY = {
    "curves": "lines",
    "depth_map": "relief",
    "fur": "lines",
    "isoluminance": "contours",
    "manifolds": "nspace",
    "primitives": "solids",
    "projection": "nspace",
    "slices": "nspace",
    "sun": "relief",
}
ALIASES = {
    "vizlight.engine": "vizlight.shading.engine",
    "vizlight.light": "vizlight.scene.light",
    "vizlight.movie": "vizlight.pictures.movie",
    "vizlight.paraview": "vizlight.plotting.paraview",
    "vizlight.plan": "vizlight.shading.engine",
    "vizlight.render": "vizlight.pictures.render",
    "vizlight.testing": "vizlight.pictures.testing",
    **{f"vizlight.geometry.{m}": f"vizlight.geometry.{d}.{m}" for m, d in GEOMETRY.items()},
}


class _Alias(Loader):
    """Loader that returns the original module itself, not a copy."""

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        module = importlib.import_module(ALIASES[spec.name])
        self._spec = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        # The import system has replaced the module's own specification with the alias's.
        module.__spec__ = self._spec


class _Finder:
    def find_spec(
        self, fullname: str, _path: Sequence[str] | None, _target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the specification of an alias, or None for any other module."""
        return ModuleSpec(fullname, _Alias()) if fullname in ALIASES else None


def install() -> None:
    """Make ``import`` recognise the aliases."""
    if not any(isinstance(finder, _Finder) for finder in sys.meta_path):
        sys.meta_path.append(_Finder())
