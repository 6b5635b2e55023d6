"""All public callables, a valid call of each, and what the walk makes of each.

A call has the arguments that are required and those in `OFTEN`, whose values go by their names;
what a callable needs beside or in place of these is in `OWN`.
"""

import functools
import importlib
import inspect
import re
from pathlib import Path

import numpy as np
import pyvista as pv
from scipy import sparse

import vizlight
from vizlight import Light, Material, Scene, View, engine, presets
from vizlight.accessor import Accessor
from vizlight.draw.render import PlotterKeywords
from vizlight.geometry import manifolds
from vizlight.geometry.solids.primitives import Solid
from vizlight.looks.look import Look
from vizlight.observers.figures import Legibility
from vizlight.pieces.sources import Slabs
from vizlight.scene.scene import SceneKeywords
from vizlight.shading.arrays import Shading
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import Options

UP = (0.3, -0.2, 1.0)
SCENE = Scene(
    lights=(Light(direction=UP), Light(position=(3.0, 2.0, 4.0))),
    view=View(position=(5.0, 4.0, 6.0)),
    material=Material(color=(1.0, 0.5, 0.2)),
)  # fmt: skip
SCENE4 = Scene(lights=Light(direction=(0.7, 0.6, 0.4, 0.1)), view=View(direction=(0, 0.3, 1, 0.2)))
SUN = Scene(lights=Light(direction=UP), view=View(direction=(0, 0, 1)))


def unit(*shape, seed=0):
    """Return random unit vectors."""
    rows = np.random.default_rng(seed).normal(size=shape)
    return rows / np.linalg.norm(rows, axis=-1, keepdims=True)


def frame(*shape):
    """Return random frames of orthonormal rows."""
    q = np.linalg.qr(np.swapaxes(unit(*shape, seed=1), -1, -2))[0]
    return np.ascontiguousarray(np.swapaxes(q, -1, -2))


def ball():
    """Return a small sphere with tangents and scalars."""
    mesh = pv.Sphere(theta_resolution=8, phi_resolution=7)
    mesh.point_data["V"] = np.cross(mesh.points, (0.1, 0.2, 1.0)) + 1e-3
    mesh.point_data["s"] = np.linspace(0.0, 1.0, mesh.n_points)
    return mesh


def flow(time=None):
    """Return a small field of vectors in a volume, at a time."""
    mesh = pv.ImageData(dimensions=(5, 5, 5), spacing=(0.25, 0.25, 0.25))
    x, y, z = mesh.points.T
    mesh.point_data["V"] = np.stack([1 - y, x, 0.2 + 0 * z], axis=1) * (0.2 + 0.2 * (time or 0))
    if time is not None:
        mesh.field_data["TimeValue"] = [time]
    return mesh


def hills():
    """Return a small height field."""
    x = np.linspace(0.0, 1.0, 8)
    mesh = pv.ImageData(dimensions=(8, 8, 1), spacing=(1 / 7, 1 / 7, 1.0))
    mesh.point_data["h"] = (0.2 * np.sin(5 * x)[:, None] * np.cos(4 * x)).ravel()
    return mesh


def lit():
    """Return a small sphere that is lit."""
    return vizlight.illuminate(ball(), SCENE)


def torus():
    """Return a small torus in 4-space as a mesh."""
    return vizlight.manifold(manifolds.torus(1.0, 1.0, resolution=(6, 5)))


def saved():
    """Return the path of a mesh that is saved."""
    ball().save("ball.vtp")
    return Path("ball.vtp")


def series_file():
    """Return the path of two steps that are saved."""
    sets = ""
    for i in range(2):
        ball().save(f"step{i}.vtp")
        sets += f'<DataSet timestep="{i}" file="step{i}.vtp"/>'
    text = f'<VTKFile type="Collection"><Collection>{sets}</Collection></VTKFile>'
    Path("steps.pvd").write_text(text, "utf-8")
    return Path("steps.pvd")


def plotter():
    """Return a plotter with a mesh."""
    made = pv.Plotter(off_screen=True, window_size=(60, 40))
    made.add_mesh(pv.Sphere(theta_resolution=6, phi_resolution=6))
    return made


def with_strokes():
    """Return a plotter with strokes that move."""
    sheet = pv.Plane(i_resolution=4, j_resolution=4)
    sheet["V"] = np.tile([1.0, 0, 0], (sheet.n_points, 1))
    lines = vizlight.streamlines(sheet, tangents="V", seeds=3, stroke_length=0.5, travel=1.0)
    made = plotter()
    made.vizlight.add_mesh(lines, scene=SCENE, width="width")
    return made


#: Plotter of the last call of `shown`.
LAST = []


def shown():
    """Return an actor that has live light."""
    LAST[:] = [plotter()]
    return LAST[0].vizlight.add_mesh(ball(), scene=SCENE)


def inputs():
    """Return inputs of the engine."""
    return ShadingInputs(points=unit(6, 3), normals=unit(6, 3))


def black():
    """Return a picture."""
    return np.zeros((20, 20, 3), np.uint8)


def strained():
    mesh = pv.ImageData(dimensions=(3, 3, 3))
    mesh["S"] = np.arange(162.0).reshape(27, 6)
    return mesh


def block():
    """Return a volume of values."""
    volume = pv.ImageData(dimensions=(4, 3, 2))
    volume["v"] = np.arange(24.0)
    return volume


def orbital():
    """Return a volume of two values with an atom in it."""
    volume = pv.ImageData(dimensions=(2, 1, 1))
    volume.field_data["atom_numbers"], volume.field_data["atom_places"] = [6], [[0.0, 0.0, 0.0]]
    return volume


def chain():
    """Return a molecule of eight residues."""
    mesh = pv.PolyData(np.outer(np.arange(8), (3.8, 0, 0)))
    mesh["atom_type"], mesh["chain"] = np.full(8, 6), np.zeros(8, int)
    mesh["backbone_mask"] = np.ones(8, np.uint8)
    return mesh


def europe():
    """Return a map in degrees."""
    return pv.ImageData(dimensions=(6, 5, 1), spacing=(10, 8, 1), origin=(-10, 30, 0))


def charted():
    """Return a map in metres of a known projection."""
    return vizlight.cartography.chart(vizlight.cartography.in_degrees(europe()))


X, Y = np.linspace(0.0, 1.0, 7), np.linspace(0.0, 1.0, 6)
CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
#: Valid values by the name of an argument; a function makes a new one for each call.
VALUES = {
    # numbers and names
    "altitude": 0.5, "angle": 0.3, "anti_aliasing": None, "azimuth": [0.3, 1.0], "backend": "egl",
    "back": 3.0, "beta": 0.3, "c1": 1.0, "c2": 0.1, "c3": 0.1, "center": (0, 0, 0), "count": 5,
    "d": [0.5, 2.0], "day": 100.0, "density": 0.3, "depth": 0.1, "diameter": 0.01,
    "distance": 3.0, "elevation": "h", "error": 0.2, "factor": 2.0, "fibres": 20, "front": 0.5,
    "height": 1.0, "hours": [9.0, 12.0], "intensity": [0.5, 1.0], "k": 2, "latitude": 0.8,
    "length": 0.1, "levels": 4, "light_eye_angle": [1.0], "lights": 2, "n": 4, "n_h": [0.5, 0.9],
    "name": "luminance", "names": "h,h", "nu": [0.1, 0.2], "offset": (1.0, 0.0, 0.0),
    "operation": "union", "outline": [[0, 0], [1, 0], [0, 1]], "plane": "xw", "r": [10.0],
    "radius": 1.0, "resolution": 6, "rho": [0.1, 0.2], "samples": 16,
    "scalars": "s", "seeds": 5, "shininess": 20.0, "sin_alpha": [0.3, 1.0], "size": (60, 40),
    "theta": 0.4, "tolerance": 0.1, "turns": ("xw", 0.3), "xyz": (1.0, 0.0, 0.0),
    # arrays
    "axis": UP, "direction": UP, "toward": UP, "vector": UP, "bounds": (0.0, 1.0) * 3,
    "cells": np.array([[0, 1, 3, 2]]), "domain": ((0.0, 3.0), (0.0, 1.0)), "faces": FACES,
    "frame": frame(4, 2, 3), "matrix": np.eye(4), "normal": unit(4, 3, seed=3),
    "points": unit(4, 3), "shares": sparse.csr_array(np.eye(4)),
    "simplices": np.array([[0, 1, 2, 3], [1, 2, 3, 4]]), "tangent": unit(4, 3, seed=3),
    "triangles": FACES, "values": np.linspace(-1, 1.1, 5), "vectors": unit(4, 2, 3),
    "wi": unit(4, 3), "wo": unit(4, 3, seed=2), "x": X, "y": Y,
    "z": 0.2 * np.sin(4 * Y)[:, None] * np.cos(3 * X), "got": black, "expected": black,
    # scenes, shapes, meshes, files
    "camera": pv.Camera, "eye": View(position=(0, 4, 0)), "first": vizlight.Sphere(),
    "frames": lambda: [lit(), lit()], "light": Light(position=(3, 0, 0)), "lit": lit,
    "mesh": ball, "panels": lit, "path": lambda: Path("out.vtp"), "plotter": plotter,
    "scene": SCENE, "second": vizlight.Block(), "sequence": lambda: [lit()],
    "series": lambda: [flow(0.0), flow(1.0)], "solid": vizlight.Sphere(), "source": pv.Property,
    "sources": saved, "shape": lambda: manifolds.torus(1.0, 1.0, resolution=(6, 5)),
    "surface": ball, "view": View(direction=(0, 0, 1)),
}  # fmt: skip
#: Optional arguments that a call has too, as their defaults take long or are none.
OFTEN = {
    "anti_aliasing", "density", "depth", "distance", "elevation", "error", "fibres", "length",
    "levels", "resolution", "samples", "scene", "seeds", "tolerance",
}  # fmt: skip
SMALL = {"size": (60, 40), "anti_aliasing": None}
IN_4 = {"points": unit(5, 4)}
SEEN = {"direction": UP}
SATIN = {"tangents": "V"}
HILLY = {"mesh": hills, "scene": SUN}
FILTERS = {
    "bas_relief": {"resolution": 8},
    "illuminate": SATIN,
    "isoluminance": {"scene": SUN},
    "legibility.legibility": {"tangents": "V", "scalars": "s"},
    "Accessor.legibility": {"tangents": "V", "scalars": "s"},
    "plot": {"off_screen": True, "window_size": (60, 40)},
    "project": {"mesh": torus, "scene": SCENE4},
    "provenance": {"mesh": lit},
    "relief_day": {"mesh": hills, "latitude": 46.0, "day": 100.0, "hours": [10.0, 12.0]},
    "relief_shadow": HILLY,
    "satin": SATIN,
    "streamlines": {"mesh": flow, "tangents": "V"},
    "tint": {"scalars": "s"},
    "save_gltf": {"path": lambda: Path("mesh.glb")},
    "live_html": {"path": lambda: Path("page.html")},
}
#: Arguments beside those, or in place of them, by the end of the name of a callable.
OWN = {
    **FILTERS,
    "Light": {"position": (3.0, 0.0, 0.0)},
    "Light.unclamped": {"position": (3.0, 0.0, 0.0)},
    "Light.linear": {"start": (3.0, 0.0, 0.0), "end": (3.0, 1.0, 0.0)},
    "View": {"position": (3.0, 0.0, 0.0)},
    "Scene": {"lights": Light(direction=UP), "view": View(direction=UP)},
    "DepthCue": {"front": 0.0, "back": 1.0},
    "isometric": {"n": 3},
    "from_dict": {"values": SCENE.to_dict},
    "key": {"scene": presets.shape()},
    "key_picture": {"scene": presets.shape()},
    "Component.add_key": {"scene": presets.shape()},
    "Component.explain": {"actor": shown},
    "Component.set_scene": {"actor": shown},
    "Component.export_html": {"path": lambda: shown() and Path("page.html")},
    "Component.save_graphic": {"path": lambda: shown() and Path("figure.svg"), "error": 30.0},
    "add_recorded": {"mesh": lit},
    "film.save": {
        "data": series_file, "path": lambda: Path("movie.png"), "array": "s", "size": (80, 60),
    },
    "movie.save": {"path": lambda: Path("movie.png"), "picture": SMALL},
    "movie.orbit": {"path": lambda: Path("movie.png"), "frames": 2},
    "coasts.coasts": {"bounds": (-10.0, 40.0, 35.0, 60.0)},
    "globes.globe": {"mesh": lambda: vizlight.cartography.in_degrees(europe())},
    "filters.key.key": {"scene": presets.shape(), "levels": [0.2, 0.4], "clim": (0.0, 1.0)},
    "smooth_maps.smoothed": {"mesh": hills, "name": "h", "factor": 2},
    "isolines.isolines": {"mesh": hills, "name": "h", "levels": [0.1, 0.3], "letters": 0.01},
    "creases.creases": {"surface": ball},
    "creases.borders": {"surface": ball},
    "walls.walls": {"volume": lambda: pv.SolidSphere(inner_radius=0.1, outer_radius=2.0)},
    "walls.obstacles": {"surface": ball, "name": "s"},
    "cutaways.cut_open": {"volume": block, "name": "v"},
    "cutaways.without_corner": {"volume": block, "name": "v"},
    "molecules.backbone": {"atoms": chain},
    "molecules.ligands": {"atoms": chain},
    "montages.side_by_side": {"volume": block, "name": "v"},
    "molecules.atoms_in": {"volume": orbital},
    "stresses.with_von_mises": {"mesh": strained, "name": "S"},
    "several_views.several_views": {"mesh": ball, "views": (UP, (0, -1, 0)), "names": ("a", "b")},
    "several_views.inset": {"mesh": ball, "direction": UP, "place": (0, 0, 1, 1), "up": (0, 1, 0)},
    "several_views.beside": {"right": 0.5},
    "box_axes.box_axes": {"size": 10.0},
    "box_axes.captions": {"meshes": lambda: pv.MultiBlock({"a": ball()}), "size": 10.0},
    "map_frames.frame": {"mesh": europe, "letters": 1.5},
    "map_frames.graticule": {"mesh": charted, "letters": 2e5},
    "charts.chart": {"mesh": lambda: vizlight.cartography.in_degrees(europe())},
    "movie.travel": {"path": lambda: Path("movie.png"), "frames": 2, "plotter": with_strokes},
    "maps.heights": {"low": -10.0, "high": 250.0},
    "maps.bands": {"levels": [1.0, 2.0], "limits": (0.0, 3.0)},
    "maps.kinds": {"values": [1.0, 2.0, 7.0]},
    "looks.look.look": {"data": ball},
    "Look.save": {"path": lambda: Path("look.vtp")},
    "Look.steps": {"path": lambda: Path("look.png")},
    "Component.show_key": {"mesh": lambda: presets.key(presets.shape())},
    "movie.turn": {
        "mesh": torus, "path": lambda: Path("movie.png"), "scene": SCENE4, "frames": 2,
        "picture": SMALL,
    },
    "make_plotter": SMALL,
    "render.pictures": SMALL,
    "save_png": SMALL | {"path": lambda: Path("picture.png")},
    "render.save": {"path": lambda: Path("picture.png")},
    "paraview.save": {"path": lambda: Path("shown.py")},
    "paraview.shader": SATIN,
    "pathlines": {"tangents": "V", "seeds": 4},
    "pieces.run.light": {"out": Path("lit.pvtp"), "tangents": "V"},
    "Processes": {"count": 1},
    "Slabs": {"arrays": {"a": np.zeros((3, 4, 5))}},
    "reader.read": {"path": saved},
    "reader.read_parts": {"path": saved},
    "surface_of": {"mesh": flow, "contour": None},
    "stretched": {"mesh": hills},
    "layer_of": {"mesh": lambda: pv.ImageData(dimensions=(3, 3, 3)), "at": 1},
    "warped": {"mesh": hills, "name": "h"},
    "with_last_coordinate": {"mesh": torus},
    "with_vectors": {"mesh": hills},
    "manifold": {"scene": SCENE4},
    "direction_colors": {"mesh": lambda: pv.Spline(np.cumsum(unit(5, 3), 0), 8)},
    "contours.isoluminance.sphere": SEEN,
    "truncus": SEEN | {"radii": (1.0, 0.5), "height": 1.0},
    "Frustum": {"height": 1.0},
    "relief.shadowing.shadow": SEEN,
    "torus": {"radii": (1.0, 0.5)},
    "seeds": {"points": CORNERS},
    "depth_map": {"points": CORNERS},
    "Polyhedron": {"points": CORNERS, "triangles": FACES},
    "polyline_tangents": {"points": np.cumsum(unit(5, 3), axis=0)},
    "manifolds.parametric": {"function": lambda u, v=0.5: (np.cos(u), np.sin(u), v, u * v)},
    "image_and_depth": IN_4,
    "perspective": IN_4,
    "push_forward": IN_4 | {"vectors": unit(5, 1, 4)},
    "push_frame": IN_4 | {"frame": frame(5, 2, 4)},
    "projection.turn": {"vectors": unit(5, 4)},
    "slices.mean_frame": {"frame": frame(4, 2, 4)},
    "slices.slice_frame": {"frame": frame(3, 2, 4), "normal": unit(4)},
    "inside_length": SEEN | {"points": np.array([[0.5, 0.5, -0.3]])},
    "mean_intensity": {"p": [1.0, 2.0]},
    "falloff.depth_cue": {"z": [1.0, 2.0]},
    "falloff.fur": {"height": [0.1, 0.5]},
    "split": {"direction": unit(4, 3)},
    "reflection_from_half": {"triple": 0.1},
    "sphere_error": {"light_eye_angle": 1.0, "r": 10.0},
    "simple_factor": {"r": [10.0]},
    "blinn_from_phong": {"light_eye_angle": 1.0},
    "phong_from_blinn": {"light_eye_angle": 1.0},
    "engine.plan": {"k": 1},
    "engine.run": {"inputs": inputs, "options": engine.ShadingOptions()},
    "engine.shade": {"tangents": unit(4, 3, seed=2), "normals": unit(4, 3, seed=3)},
}  # fmt: skip

PAGES = Path(__file__).parent.parent / "gallery" / "pages" / "api.rst"
#: Public modules that have no page of their own.
BESIDE = (
    "vizlight.accessor", "vizlight.data", "vizlight.geometry.solids",
    "vizlight.geometry.solids.primitives", "vizlight.geometry.solids.polyhedra",
    "vizlight.draw.component", "vizlight.looks.show", "vizlight.scene",
)  # fmt: skip
#: Public classes that only vizlight makes, which are records, or what others derive from.
RETURNED = {
    "geometry.contours.banding.Bands",
    "observers.figures.Legibility", "model.cylinder.Gradient", "model.highlights.MaximumError",
    "draw.backends.Probe", "pieces.run.Lit", "draw.testing.Difference",
    "draw.snapshots.same_picture", "draw.component.Component", "draw.paraview.Shader",
    "looks.look.Look",
    "shading.arrays.Shading", "shading.inputs.ArraySource", "shading.plan.Plan",
    "shading.inputs.ShadingInputs", "geometry.solids.primitives.Solid",
    "geometry.solids.primitives.Primitive", "accessor.Accessor",
}  # fmt: skip
#: Parts of the protocol between solids, whose arrays `contains` and `tessellate` checked, and
#: of those of meshes that are lit together and of slabs.
PROTOCOLS = {
    Solid: {"moved", "inside", "surfaces", "facets", "count", "missed"},
    Shading: {"arrays", "of", "part"},
    Options: {"of"},
    Slabs: {"empty", "nodes"},
    # What the command line runs, and words of calls that take files or questions of any number.
    Look: {"read_steps", "script", "figures", "show"},
    Legibility: {"without"},
}
TYPED_DICTS = {"PlotterKeywords": lambda: PlotterKeywords, "SceneKeywords": lambda: SceneKeywords}


def public():
    """Return all public functions, constructors and methods, by the names of their definitions."""
    found = {}
    named = re.findall(r"^   (vizlight[\w.]*)$", PAGES.read_text("utf-8"), re.MULTILINE)
    for module in map(importlib.import_module, [*named, *BESIDE]):
        for name in module.__all__:
            value = getattr(module, name)
            home = getattr(value, "__module__", "")
            if not home.startswith("vizlight"):
                continue
            if inspect.isclass(value) and not issubclass(value, Exception):
                found.update(methods(value))
            elif not inspect.isroutine(value):
                continue
            if not hasattr(value, "__total__"):  # as a TypedDict has
                found[f"{home}.{value.__qualname__}"] = value
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


def arguments(name):
    """Return the arguments of a valid call by their names, positional ones too."""
    own = [more for end, more in OWN.items() if f".{name}".endswith(f".{end}")]
    found = max(own, key=len, default={})
    given = {}
    for parameter in inspect.signature(PUBLIC[name]).parameters.values():
        needed = parameter.default is parameter.empty and parameter.kind != parameter.VAR_KEYWORD
        if parameter.name != "self" and (needed or parameter.name in OFTEN):
            given[parameter.name] = found.get(parameter.name, VALUES.get(parameter.name))
    given |= found
    return {
        key: make() if callable(make) and key != "function" else make for key, make in given.items()
    }


PUBLIC = public()


#: Objects whose methods are called, by the end of a callable's name.
SELF = {
    "Component.add_key": lambda: plotter().vizlight,
    "Component.show_key": lambda: plotter().vizlight,
    **{
        f"Look.{name}": lambda: vizlight.look(ball(), size=(60, 40))
        for name in ("plotter", "save", "steps")
    },
    "Component.add_mesh": lambda: plotter().vizlight,
    "Component.legibility": lambda: shown() and LAST[0].vizlight,
    "Component.explain": lambda: LAST[0].vizlight,
    "Component.export_html": lambda: LAST[0].vizlight,
    "Component.save_graphic": lambda: LAST[0].vizlight,
    "Component.set_scene": lambda: LAST[0].vizlight,
    "Shader.script": lambda: vizlight.paraview.shader(SCENE),
    "Light.seen_from": Light.headlight,
    "Material.to_property": Material,
    "Scene.moved": lambda: SCENE,
    "Scene.replace": lambda: SCENE,
    "ShadingInputs.check": inputs,
}


def owner(name):
    """Return the object whose method is called, if any."""
    if name.startswith("geometry.solids.primitives.Solid."):
        return vizlight.Sphere()
    return SELF.get(".".join(name.split(".")[-2:]), lambda: None)()


#: Kinds of arguments, as annotations, where their own say less.
KINDS = {"series": "Sequence[pv.DataSet] | Path", "sources": "object | Path"}
#: Words by which an error may name an argument, where the command line says the same to its users
#: and where errors of a piece begin with its name.
ALIASES = {
    "path": {"file", "output"}, "factor": {"exaggeration"}, "sources": {"piece"},
    "panels": {"scalars"}, "expected": {"output", "file"}, "sequence": {"panels", "scalars"},
    "screenshot": {"output"}, "name": {"warp"}, "exaggeration": {"z"},
    "turns": {"rotation", "plane", "angle"}, "data": {"file"}, "mesh": {"output"},
}  # fmt: skip
#: Places of results that are documented to be NaN or infinite, as regular expressions, and words of
#: the documentation that say so.
MARKED = {
    "model.half_vector.identity": ("^result$", "NaN where a vector is zero or not finite"),
    "model.half_vector.reflection": ("^result$", "NaN where a vector is zero or not finite"),
    "geometry.nspace.manifolds.Manifold": (
        r"^\.(points|frame)$", "Numbers that are not finite are kept",
    ),
    "geometry.nspace.projection.image_and_depth": (
        r"^\[[01]\]$", "NaN where a point is not finite",
    ),
    "geometry.nspace.projection.perspective": ("^result$", "where a point is not finite"),
    "geometry.nspace.projection.push_forward": ("^result$", "Not finite where points or vectors"),
    "geometry.nspace.projection.turn": ("^result$", "Not finite where a number is not"),
    "shading.engine.depth_range": (r"^\[[01]\]$", "(inf, -inf) without points"),
    "geometry.relief.depth_map.depth_map": ("^result$", "NaN where no triangle covers the node"),
    "geometry.relief.shadowing.inside_length": (
        "^result$", "infinity where a ray never leaves the solid; NaN",
    ),
    "observers.check.check": (r"^\.runs", "figures that are not measured are NaN"),
    "model.frames.split": (r"^\[[01]\]$", "results are NaN where x is not finite"),
}  # fmt: skip
