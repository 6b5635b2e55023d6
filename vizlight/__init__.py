"""Light that makes scientific data legible, as point scalars on PyVista meshes.

The public names are loaded on first use, so ``import vizlight`` is fast and
``import vizlight.model`` needs neither PyVista nor VTK.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from vizlight._version import __version__ as __version__

if TYPE_CHECKING:
    from vizlight import maps as maps
    from vizlight import pieces as pieces
    from vizlight import presets as presets
    from vizlight import vtk as vtk
    from vizlight.data import example_path, load_example
    from vizlight.files import read
    from vizlight.filters.bas_relief import bas_relief
    from vizlight.filters.fur import fur
    from vizlight.filters.illuminate import illuminate
    from vizlight.filters.isoluminance import isoluminance
    from vizlight.filters.manifold import manifold
    from vizlight.filters.pathlines import pathlines
    from vizlight.filters.project import project
    from vizlight.filters.refine import refine
    from vizlight.filters.relief_day import relief_day
    from vizlight.filters.relief_shadow import relief_shadow
    from vizlight.filters.satin import satin
    from vizlight.filters.sky import sky
    from vizlight.filters.solids import to_polydata
    from vizlight.filters.streamlines import streamlines
    from vizlight.filters.tint import tint
    from vizlight.filters.tint import unlit_colors as unlit_colors
    from vizlight.geometry.solids.polyhedra import HalfSpace, Polyhedron, Prism
    from vizlight.geometry.solids.primitives import Block, Frustum, Sphere, Torus
    from vizlight.mesh.polylines import direction_colors
    from vizlight.mesh.records import provenance
    from vizlight.observers.legibility import legibility
    from vizlight.observers.record import Legibility
    from vizlight.pictures import movie as movie
    from vizlight.pictures import render as render
    from vizlight.pictures import testing as testing
    from vizlight.plotting import paraview as paraview
    from vizlight.plotting.gltf import save_gltf
    from vizlight.plotting.html import live_html
    from vizlight.scene import DepthCue, Light, Material, Scene, View
    from vizlight.shading import engine as engine
    from vizlight.shading.options import Bundle
    from vizlight.verify.report import report

_HOMES = {
    "Block": "vizlight.geometry.solids.primitives",
    "Bundle": "vizlight.shading.options",
    "DepthCue": "vizlight.scene",
    "Frustum": "vizlight.geometry.solids.primitives",
    "HalfSpace": "vizlight.geometry.solids.polyhedra",
    "Legibility": "vizlight.observers.record",
    "Light": "vizlight.scene",
    "Material": "vizlight.scene",
    "Polyhedron": "vizlight.geometry.solids.polyhedra",
    "Prism": "vizlight.geometry.solids.polyhedra",
    "Scene": "vizlight.scene",
    "Sphere": "vizlight.geometry.solids.primitives",
    "Torus": "vizlight.geometry.solids.primitives",
    "View": "vizlight.scene",
    "bas_relief": "vizlight.filters.bas_relief",
    "direction_colors": "vizlight.mesh.polylines",
    "example_path": "vizlight.data",
    "fur": "vizlight.filters.fur",
    "illuminate": "vizlight.filters.illuminate",
    "isoluminance": "vizlight.filters.isoluminance",
    "legibility": "vizlight.observers.legibility",
    "live_html": "vizlight.plotting.html",
    "load_example": "vizlight.data",
    "manifold": "vizlight.filters.manifold",
    "pathlines": "vizlight.filters.pathlines",
    "project": "vizlight.filters.project",
    "provenance": "vizlight.mesh.records",
    "read": "vizlight.files",
    "refine": "vizlight.filters.refine",
    "relief_day": "vizlight.filters.relief_day",
    "relief_shadow": "vizlight.filters.relief_shadow",
    "report": "vizlight.verify.report",
    "satin": "vizlight.filters.satin",
    "sky": "vizlight.filters.sky",
    "save_gltf": "vizlight.plotting.gltf",
    "streamlines": "vizlight.filters.streamlines",
    "tint": "vizlight.filters.tint",
    "unlit_colors": "vizlight.filters.tint",
    "to_polydata": "vizlight.filters.solids",
}
#: Places of the modules that are attributes of the package.
_MODULES = {
    "accessor": "accessor",
    "engine": "shading.engine",
    "files": "files",
    "filters": "filters",
    "geometry": "geometry",
    "maps": "maps",
    "model": "model",
    "movie": "pictures.movie",
    "paraview": "plotting.paraview",
    "pieces": "pieces",
    "presets": "presets",
    "render": "pictures.render",
    "testing": "pictures.testing",
    "vtk": "vtk",
}

__all__ = [
    "Block",
    "Bundle",
    "DepthCue",
    "Frustum",
    "HalfSpace",
    "Legibility",
    "Light",
    "Material",
    "Polyhedron",
    "Prism",
    "Scene",
    "Sphere",
    "Torus",
    "View",
    "bas_relief",
    "direction_colors",
    "example_path",
    "fur",
    "illuminate",
    "isoluminance",
    "legibility",
    "live_html",
    "load_example",
    "manifold",
    "pathlines",
    "project",
    "provenance",
    "read",
    "refine",
    "relief_day",
    "relief_shadow",
    "report",
    "satin",
    "save_gltf",
    "sky",
    "streamlines",
    "tint",
    "to_polydata",
]


def __getattr__(name: str) -> object:
    """Load a public name on first use."""
    if name in _HOMES:
        value = getattr(importlib.import_module(_HOMES[name]), name)
        globals()[name] = value
        return value
    if name in _MODULES:
        return importlib.import_module(f"vizlight.{_MODULES[name]}")
    raise AttributeError(f"module 'vizlight' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, *_MODULES, "__all__", "__version__"])
