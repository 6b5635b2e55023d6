"""Light that makes scientific data legible, as point scalars on PyVista meshes.

The public names are loaded on first use, so ``import vizlight`` is fast and
``import vizlight.model`` needs neither PyVista nor VTK.
"""

# Editors complete what is not private: the public names alone.
import importlib as _importlib
import sys as _sys
import typing as _typing

from vizlight._version import __version__ as __version__

if _typing.TYPE_CHECKING:
    from vizlight import cartography as cartography
    from vizlight import maps as maps
    from vizlight import pieces as pieces
    from vizlight import presets as presets
    from vizlight import vtk as vtk
    from vizlight.data import example_path as example_path
    from vizlight.data import load_example as load_example
    from vizlight.draw import movie as movie
    from vizlight.draw import paraview as paraview
    from vizlight.draw import render as render
    from vizlight.draw import testing as testing
    from vizlight.draw.gltf import save_gltf as save_gltf
    from vizlight.draw.html import live_html as live_html
    from vizlight.files import read as read
    from vizlight.filters.bas_relief import bas_relief as bas_relief
    from vizlight.filters.fur import fur as fur
    from vizlight.filters.illuminate import illuminate as illuminate
    from vizlight.filters.isoluminance import isoluminance as isoluminance
    from vizlight.filters.manifold import manifold as manifold
    from vizlight.filters.pathlines import pathlines as pathlines
    from vizlight.filters.project import project as project
    from vizlight.filters.refine import refine as refine
    from vizlight.filters.relief_day import relief_day as relief_day
    from vizlight.filters.relief_shadow import relief_shadow as relief_shadow
    from vizlight.filters.satin import satin as satin
    from vizlight.filters.sky import sky as sky
    from vizlight.filters.solids import to_polydata as to_polydata
    from vizlight.filters.streamlines import streamlines as streamlines
    from vizlight.filters.tint import tint as tint
    from vizlight.filters.tint import unlit_colors as unlit_colors
    from vizlight.geometry.solids.polyhedra import (
        HalfSpace as HalfSpace,
        Polyhedron as Polyhedron,
        Prism as Prism,
    )
    from vizlight.geometry.solids.primitives import (
        Block as Block,
        Frustum as Frustum,
        Sphere as Sphere,
        Torus as Torus,
    )
    from vizlight.looks import film as film
    from vizlight.looks.look import Look as Look, look as look
    from vizlight.mesh.polylines import direction_colors as direction_colors
    from vizlight.mesh.records import provenance as provenance
    from vizlight.observers.check import Report as Report, check as check
    from vizlight.observers.legibility import Legibility as Legibility, legibility as legibility
    from vizlight.scene import (
        DepthCue as DepthCue,
        Light as Light,
        Material as Material,
        Scene as Scene,
        View as View,
    )
    from vizlight.shading import engine as engine
    from vizlight.shading.options import Bundle as Bundle


#: Public names by their modules.
_NAMES = {
    "data": "example_path load_example",
    "files": "read",
    "filters.bas_relief": "bas_relief",
    "filters.fur": "fur",
    "filters.illuminate": "illuminate",
    "filters.isoluminance": "isoluminance",
    "filters.manifold": "manifold",
    "filters.pathlines": "pathlines",
    "filters.project": "project",
    "filters.refine": "refine",
    "filters.relief_day": "relief_day",
    "filters.relief_shadow": "relief_shadow",
    "filters.satin": "satin",
    "filters.sky": "sky",
    "filters.solids": "to_polydata",
    "filters.streamlines": "streamlines",
    "filters.tint": "tint unlit_colors",
    "geometry.solids.polyhedra": "HalfSpace Polyhedron Prism",
    "geometry.solids.primitives": "Block Frustum Sphere Torus",
    "mesh.polylines": "direction_colors",
    "mesh.records": "provenance",
    "observers.check": "Report check",
    "observers.legibility": "Legibility legibility",
    "draw.gltf": "save_gltf",
    "draw.html": "live_html",
    "looks.look": "Look look",
    "scene": "DepthCue Light Material Scene View",
    "shading.options": "Bundle",
}
_HOMES = {name: module for module, names in _NAMES.items() for name in names.split()}
#: Modules that are attributes of the package, by the folders that hold them.
_FOLDERS = {
    "vizlight": "accessor cartography files filters geometry maps model pieces presets vtk",
    "vizlight.draw": "movie paraview render testing",
    "vizlight.looks": "film",
    "vizlight.shading": "engine",
}
_MODULES = {
    name: f"{folder}.{name}" for folder, names in _FOLDERS.items() for name in names.split()
}

__all__ = sorted(_HOMES.keys() - {"unlit_colors"})  # noqa: PLE0605


if not _typing.TYPE_CHECKING:  # a name that is not there is an error to a type checker

    def __getattr__(name: str) -> object:
        """Load a public name on first use."""
        _join_qt()
        if name in _HOMES:
            value = getattr(_importlib.import_module(f"vizlight.{_HOMES[name]}"), name)
            globals()[name] = value
            return value
        if name in _MODULES:
            return _importlib.import_module(_MODULES[name])
        hint = ": take relief_shadow(mesh, sun=(315, 45), lit=True)" if name == "hillshade" else ""
        raise AttributeError(f"module 'vizlight' has no attribute {name!r}{hint}")


def _join_qt() -> None:
    """Let windows of pyvistaqt find ``plotter.vizlight``: their look-up hides PyVista's."""
    if "pyvistaqt" in _sys.modules:
        _importlib.import_module("vizlight.draw.component")


def __dir__() -> list[str]:
    # Sphinx takes names from elsewhere for those of the package where it finds "__all__".
    return sorted([*__all__, *_MODULES, "__all__", "__version__"])


_join_qt()
