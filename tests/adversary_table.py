"""All public callables, and what the walk with adversarial values makes of each."""

from __future__ import annotations

import functools
import importlib
import inspect
import re
from pathlib import Path

import adversary_arrays
import adversary_meshes as meshes
import pyvista as pv

import vizlight
from vizlight import Light, Material
from vizlight.accessor import Accessor
from vizlight.draw.render import PlotterKeywords
from vizlight.geometry.solids.primitives import Solid
from vizlight.pieces.sources import Slabs
from vizlight.scene.scene import SceneKeywords
from vizlight.shading.engine import Shading
from vizlight.shading.options import Options

PAGES = Path(__file__).parent.parent / "gallery" / "pages" / "api.rst"
#: Public modules that have no page of their own.
BESIDE = (
    "vizlight.accessor", "vizlight.data", "vizlight.geometry.solids",
    "vizlight.geometry.solids.primitives", "vizlight.geometry.solids.polyhedra",
    "vizlight.draw.component", "vizlight.draw.show", "vizlight.scene",
)  # fmt: skip
#: Public classes that only vizlight makes, and methods that only it calls.
RETURNED = {
    "geometry.contours.banding.Bands": "returned by sphere and truncus",
    "geometry.contours.banding.Laminae": "returned by sphere and truncus",
    "observers.legibility.Legibility": "returned by legibility",
    "model.cylinder.Gradient": "returned by the gradients",
    "model.highlights.MaximumError": "returned by max_pixel_error",
    "draw.backends.Probe": "returned by probe",
    "pieces.run.Lit": "returned by light",
    "draw.testing.Difference": "returned by difference",
    "draw.snapshots.same_picture": "a fixture, made by pytest for each test",
    "draw.component.Component": "made by PyVista for each plotter",
    "draw.paraview.Shader": "returned by shader",
    "shading.engine.Shading": "returned by shade",
    "shading.inputs.ArraySource": "a protocol",
    "shading.plan.Plan": "returned by plan",
    "shading.inputs.ShadingInputs": "a record, which run checks",
    "geometry.solids.primitives.Solid": "a base class",
    "geometry.solids.primitives.Primitive": "a base class",
    "accessor.Accessor": "made by PyVista for each mesh",
}
#: Parts of the protocol between solids, whose arrays `contains` and `tessellate` checked, and
#: of those of meshes that are lit together and of slabs.
PROTOCOLS = {
    Solid: {"combine", "moved", "inside", "box", "surfaces", "primitives"},
    Shading: {"part"},
    Options: {"of"},
    Slabs: {"empty", "nodes"},
}
TYPED_DICTS = {"PlotterKeywords": lambda: PlotterKeywords, "SceneKeywords": lambda: SceneKeywords}


def modules():
    """Return the public modules."""
    text = PAGES.read_text(encoding="utf-8")
    named = re.findall(r"^   (vizlight[\w.]*)$", text, re.MULTILINE)
    return [*named, *BESIDE]


def public():
    """Return all public functions, constructors and methods, by the names of their definitions."""
    found = {}
    for module in map(importlib.import_module, modules()):
        for name in module.__all__:
            value = getattr(module, name)
            home = getattr(value, "__module__", "")
            if callable(value) and home.startswith("vizlight") and inspect.isroutine(value):
                found[f"{home}.{value.__qualname__}"] = value
            elif (
                inspect.isclass(value)
                and not issubclass(value, Exception)
                and home.startswith("vizlight")
            ):
                if not hasattr(value, "__total__"):
                    found[f"{home}.{value.__qualname__}"] = value
                found.update(methods(value))
    short = {name.partition(".")[2]: value for name, value in sorted(found.items())}
    return {name: value for name, value in short.items() if name not in RETURNED}


def methods(kind):
    """Return the public methods of a class that take arguments."""
    found = {}
    for name in dir(kind):
        # The methods of the accessor are made when they are first used.
        method = getattr(kind, name) if kind is Accessor else inspect.getattr_static(kind, name)
        made = isinstance(method, classmethod | staticmethod)
        function = method.__func__ if made else method
        # Methods of VTK's form are called by it, or set what the constructor takes too.
        if name[0] == "_" or name[0].isupper() or not inspect.isfunction(function):
            continue
        if any(issubclass(kind, whole) and name in parts for whole, parts in PROTOCOLS.items()):
            continue
        if kind is Accessor:
            found[f"vizlight.accessor.Accessor.{name}"] = of_accessor(function)
        elif function.__module__.startswith("vizlight") and (
            len(inspect.signature(function).parameters) > 1
        ):
            found[f"{function.__module__}.{function.__qualname__}"] = (
                getattr(kind, name) if made else function
            )
    return found


def of_accessor(method):
    """Return a method of the accessor as a function of the mesh."""

    @functools.wraps(method)
    def function(mesh, /, *args, **keywords):
        return method(Accessor(mesh), *args, **keywords)

    return function


def needs_nothing(function):
    """Return whether a callable can be called without arguments, or by its object alone."""
    needed = [
        parameter
        for parameter in inspect.signature(function).parameters.values()
        if parameter.default is parameter.empty
        and parameter.kind not in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD)
    ]
    return all(parameter.name == "self" for parameter in needed)


PUBLIC = public()
#: Arguments of a valid call by the name of the callable; positional ones by name too.
CALLS = {
    **{name: dict for name, function in PUBLIC.items() if needs_nothing(function)},
    **adversary_arrays.CALLS,
    **meshes.CALLS,
}
#: Objects whose methods are called.
SELF = {
    **{
        name: vizlight.Sphere
        for name in CALLS
        if name.startswith("geometry.solids.primitives.Solid.")
    },
    "geometry.contours.banding.Laminae.order": lambda: vizlight.geometry.isoluminance.sphere(
        (0, 0, 0), 1.0, direction=adversary_arrays.UP, levels=4, form="laminae"
    ),
    "draw.component.Component.add_key": lambda: meshes.plotter().vizlight,
    "draw.component.Component.add_mesh": lambda: meshes.plotter().vizlight,
    "draw.component.Component.explain": lambda: meshes.LAST[0].vizlight,
    "draw.component.Component.export_html": lambda: meshes.LAST[0].vizlight,
    "draw.component.Component.set_scene": lambda: meshes.LAST[0].vizlight,
    "draw.paraview.Shader.script": lambda: vizlight.paraview.shader(meshes.SCENE),
    "scene.light.Light.seen_from": Light.headlight,
    "scene.material.Material.to_property": Material,
    "scene.scene.Scene.moved": lambda: meshes.SCENE,
    "scene.scene.Scene.replace": lambda: meshes.SCENE,
    "shading.inputs.ShadingInputs.check": meshes.inputs,
}
#: Kinds of arguments, as annotations, where their own say less.
KINDS = {
    ("filters.pathlines.pathlines", "series"): "Sequence[pv.DataSet] | Path",
    ("pieces.run.camera_on", "sources"): "object | Path",
    ("pieces.run.light", "sources"): "object | Path",
}
#: The only arguments that are replaced where a function of the same arguments is walked anyway.
ONLY = {name: ("mesh", "surface", "lit", "scene") for name in CALLS if name.startswith("accessor.")}
#: Words by which an error may name an argument, where the command line says the same to its users.
ALIASES = {
    ("files.read", "path"): {"file"},
    ("files.write_mesh", "path"): {"output"},
    ("files.warped", "factor"): {"exaggeration"},
    ("draw.movie.save", "path"): {"output"},
    ("draw.movie.turn", "path"): {"output"},
    # Errors of a piece begin with its name.
    ("pieces.run.camera_on", "sources"): {"piece"},
    ("pieces.run.light", "sources"): {"piece"},
    ("draw.render.save_png", "panels"): {"scalars"},
    ("draw.render.save_png", "path"): {"output"},
    ("draw.testing.assert_same_picture", "expected"): {"output", "file"},
    ("draw.render.pictures", "sequence"): {"panels", "scalars"},
    ("draw.component.Component.export_html", "path"): {"output"},
    ("draw.show.plot", "screenshot"): {"output"},
    ("draw.gltf.save_gltf", "path"): {"output"},
    ("draw.html.live_html", "path"): {"output"},
    ("draw.paraview.save", "path"): {"output"},
    ("files.write_mesh", "mesh"): {"output"},
    ("files.warped", "name"): {"warp"},
    ("filters.relief_day.relief_day", "exaggeration"): {"z"},
    ("filters.relief_shadow.relief_shadow", "exaggeration"): {"z"},
    ("geometry.nspace.projection.rotation", "turns"): {"rotation", "plane", "angle"},
}
#: Places of results that are documented to be NaN or infinite, as regular expressions, and words of
#: the documentation that say so.
MARKED = {
    "model.half_vector.identity": ("^result$", "NaN where a vector is zero or not finite"),
    "model.half_vector.reflection": ("^result$", "NaN where a vector is zero or not finite"),
    "geometry.nspace.parametric.Manifold": (
        r"^\.(points|frame)$",
        "Numbers that are not finite are kept",
    ),
    "geometry.nspace.projection.image_and_depth": (
        r"^\[[01]\]$",
        "NaN where a point is not finite",
    ),
    "geometry.nspace.projection.perspective": ("^result$", "where a point is not finite"),
    "geometry.nspace.projection.push_forward": ("^result$", "Not finite where points or vectors"),
    "geometry.nspace.projection.turn": ("^result$", "Not finite where a number is not"),
    "shading.engine.depth_range": (r"^\[[01]\]$", "(inf, -inf) if there is no point"),
    "geometry.relief.depth_map.depth_map": ("^result$", "NaN where no triangle covers the node"),
    "geometry.relief.shadowing.inside_length": (
        "^result$",
        "infinity where a ray never leaves the solid; NaN",
    ),
    "model.frames.split": (r"^\[[01]\]$", "results are NaN where x is not finite"),
}


def changes(call):
    """Return whether a call is documented to change its inputs."""
    return call.argument == "inplace"


def also(call, given):
    """Return names that an error may have in place of the argument's.

    Where a mesh lacks what other arguments ask for, the error names these.
    """
    kind = call.label.partition(":")[0]
    if kind in ("mesh", "other") or call.argument == "inputs":
        # A height field names its coordinates.
        mesh = given.get(call.argument)
        arrays = [str(key) for key in mesh.point_data] if isinstance(mesh, pv.DataSet) else []
        return {"mesh", "z", *arrays, *inspect.signature(PUBLIC[call.name]).parameters}
    return set()
