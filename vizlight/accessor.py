"""``mesh.vizlight``: the filters as methods of every PyVista mesh.

Installed as an entry point of PyVista, so that no import is needed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyvista as pv

from vizlight import filters

if TYPE_CHECKING:
    from vizlight.scene import Scene


@pv.register_dataset_accessor("vizlight", pv.DataObject)
class Accessor:
    """The filters of vizlight on one mesh."""

    def __init__(self, mesh: Any) -> None:
        self._mesh = mesh

    def illuminate(self, scene: Scene, **options: Any) -> Any:
        """Return the mesh lit: :func:`vizlight.illuminate` with this mesh."""
        return filters.illuminate(self._mesh, scene, **options)

    def provenance(self, name: str = "luminance") -> dict[str, Any]:
        """Return what made an array: :func:`vizlight.provenance` with this mesh."""
        return filters.provenance(self._mesh, name)
