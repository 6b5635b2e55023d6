"""Light that makes scientific data legible, as point scalars on PyVista meshes.

The names below load when they are first used, so that ``import vizlight`` is quick and
``import vizlight.model`` needs neither PyVista nor VTK.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from vizlight._report import report
    from vizlight.data import example_path, load_example
    from vizlight.filters import (
        fur,
        illuminate,
        isoluminance,
        manifold,
        project,
        provenance,
        relief_day,
        relief_from_mesh,
        relief_shadow,
        satin,
        streamlines,
    )
    from vizlight.geometry.primitives import Block, Sphere, Truncus
    from vizlight.light import Light
    from vizlight.scene import DepthCue, Material, Scene, View

_HOMES = {
    "Block": "vizlight.geometry.primitives",
    "DepthCue": "vizlight.scene",
    "Light": "vizlight.light",
    "Material": "vizlight.scene",
    "Scene": "vizlight.scene",
    "Sphere": "vizlight.geometry.primitives",
    "Truncus": "vizlight.geometry.primitives",
    "View": "vizlight.scene",
    "example_path": "vizlight.data",
    "fur": "vizlight.filters",
    "illuminate": "vizlight.filters",
    "isoluminance": "vizlight.filters",
    "load_example": "vizlight.data",
    "manifold": "vizlight.filters",
    "project": "vizlight.filters",
    "provenance": "vizlight.filters",
    "relief_day": "vizlight.filters",
    "relief_from_mesh": "vizlight.filters",
    "relief_shadow": "vizlight.filters",
    "report": "vizlight._report",
    "satin": "vizlight.filters",
    "streamlines": "vizlight.filters",
}
_MODULES = (
    "accessor", "engine", "filters", "geometry", "model", "movie", "render", "studies", "testing",
)  # fmt: skip

__all__ = [
    "Block",
    "DepthCue",
    "Light",
    "Material",
    "Scene",
    "Sphere",
    "Truncus",
    "View",
    "example_path",
    "fur",
    "illuminate",
    "isoluminance",
    "load_example",
    "manifold",
    "project",
    "provenance",
    "relief_day",
    "relief_from_mesh",
    "relief_shadow",
    "report",
    "satin",
    "streamlines",
]


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used."""
    if name == "__version__":
        from importlib.metadata import version

        return version("vizlight")
    if name in _HOMES:
        value = getattr(importlib.import_module(_HOMES[name]), name)
        globals()[name] = value
        return value
    if name in _MODULES:
        return importlib.import_module(f"vizlight.{name}")
    raise AttributeError(f"module 'vizlight' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, *_MODULES, "__all__", "__version__"])
