"""One small, valid call of every public callable, by the name of its definition."""

from __future__ import annotations

import functools
import importlib
import inspect
import re
from pathlib import Path

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, engine, studies
from vizlight.accessor import Accessor
from vizlight.geometry import manifolds
from vizlight.geometry.solids.primitives import Solid
from vizlight.pictures.render import PlotterKeywords
from vizlight.scene.scene import SceneKeywords
from vizlight.shading.inputs import ShadingInputs

PAGES = Path(__file__).parent.parent / "gallery" / "pages" / "api.rst"
#: Public modules that have no page of their own.
BESIDE = (
    "vizlight.accessor", "vizlight.data", "vizlight.geometry.solids",
    "vizlight.geometry.solids.primitives", "vizlight.geometry.solids.polyhedra",
    "vizlight.plotting.component", "vizlight.scene", "vizlight.studies",
)  # fmt: skip
#: Public modules that are not walked, with the reason.
APART = {"vizlight.pieces": "each call starts processes and reads files, which takes seconds"}
#: Public classes that only vizlight makes, and methods that only it calls.
RETURNED = {
    "geometry.contours.banding.Bands": "returned by sphere and truncus",
    "geometry.contours.banding.Laminae": "returned by sphere and truncus",
    "model.cylinder.Gradient": "returned by the gradients",
    "model.highlights.MaximumError": "returned by max_pixel_error",
    "pictures.backends.Probe": "returned by probe",
    "pictures.testing.Difference": "returned by difference",
    "plotting.component.Component": "made by PyVista for each plotter",
    "shading.engine.Shading": "returned by shade",
    "shading.inputs.ArraySource": "a protocol",
    "shading.plan.Plan": "returned by plan",
    "studies._framework.Curve": "a record without checks",
    "studies._framework.Panel": "a record without checks",
    "studies._framework.Row": "a record without checks",
    "studies._framework.Study": "a record without checks",
    "studies._results.Result": "returned by run",
    "shading.inputs.ShadingInputs": "a record, which run checks",
    "geometry.solids.base.Solid": "a base class",
    "geometry.solids.base.Primitive": "a base class",
    "accessor.Accessor": "made by PyVista for each mesh",
}
#: Parts of the protocol between solids, which take arrays that `contains` and `tessellate` checked.
PROTOCOL = {"combine", "moved", "inside", "box", "surfaces", "primitives"}
TYPED_DICTS = {"PlotterKeywords": lambda: PlotterKeywords, "SceneKeywords": lambda: SceneKeywords}


def modules():
    """Return the public modules."""
    text = PAGES.read_text(encoding="utf-8")
    named = re.findall(r"^   (vizlight[\w.]*)$", text, re.MULTILINE)
    return [name for name in [*named, *BESIDE] if name not in APART]


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
                if not (
                    hasattr(value, "__total__")
                    or f"{home}.{value.__qualname__}".partition(".")[2] in RETURNED
                ):
                    found[f"{home}.{value.__qualname__}"] = value
                found.update(methods(value))
    return {name.partition(".")[2]: value for name, value in sorted(found.items())}


def methods(kind):
    """Return the public methods of a class that take arguments."""
    found = {}
    for name in dir(kind):
        method = inspect.getattr_static(kind, name)
        made = isinstance(method, classmethod | staticmethod)
        function = method.__func__ if made else method
        if name[0] == "_" or not inspect.isfunction(function):
            continue
        if issubclass(kind, Solid) and name in PROTOCOL:
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


def flow():
    """Return a small field of vectors in a volume."""
    mesh = pv.ImageData(dimensions=(5, 5, 5), spacing=(0.25, 0.25, 0.25))
    x, y, z = mesh.points.T
    mesh.point_data["V"] = np.stack([1 - y, x, 0.2 + 0 * z], axis=1)
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


def triangles():
    """Return points and triangles of a tetrahedron."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    return points, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def grid():
    """Return axes and heights of a height field."""
    x, y = np.linspace(0.0, 1.0, 7), np.linspace(0.0, 1.0, 6)
    return {"x": x, "y": y, "z": 0.2 * np.sin(4 * y)[:, None] * np.cos(3 * x)}


def study():
    """Return a study of two rows."""
    rows = [studies.Row("a", 1.0, 0.1, 1.0), studies.Row("a", 2.0, 0.05, 2.0)]
    return studies.Study(
        approximates="a", reference="b", parameter="p", error="e", cost="c",
        steps=lambda quick: [lambda: rows], verdict=lambda rows: "rely on it",
    )  # fmt: skip


def result():
    """Return the result of that study."""
    rows = list(study().steps(True)[0]())
    return studies.Result("a", study(), rows, "rely on it")


def saved():
    """Return the path of a mesh that is saved."""
    ball().save("ball.vtp")
    return Path("ball.vtp")


def plotter():
    """Return a plotter with a mesh."""
    made = pv.Plotter(off_screen=True, window_size=(60, 40))
    made.add_mesh(pv.Sphere(theta_resolution=6, phi_resolution=6))
    return made


def inputs():
    """Return inputs of the engine."""
    return ShadingInputs(points=unit(6, 3), normals=unit(6, 3))


def eye():
    """Return directions toward light and eye."""
    return {"wi": unit(4, 3), "wo": unit(4, 3, seed=2)}


def cylinder(**more):
    """Return arguments of a function of the line light."""
    return lambda: {
        "wi": unit(4, 3),
        "wo": unit(4, 3, seed=2),
        "tangent": unit(4, 3, seed=3),
        **more,
    }


def half():
    """Return arguments of a function of the half vector."""
    return lambda: {
        "wi": unit(4, 3),
        "wo": unit(4, 3, seed=2),
        "normal": unit(4, 3, seed=3),
    }


FILTERS = {
    "bas_relief": lambda: {"mesh": ball(), "resolution": 8},
    "fur": lambda: {"surface": ball(), "scene": SCENE, "fibres": 20, "length": 0.1, "density": 0.3},
    "illuminate": lambda: {"mesh": ball(), "scene": SCENE, "tangents": "V"},
    "isoluminance": lambda: {"mesh": ball(), "scene": SUN, "levels": 4},
    "project": lambda: {"mesh": torus(), "scene": SCENE4, "distance": 4.0},
    "provenance": lambda: {"mesh": lit()},
    "refine": lambda: {"mesh": ball(), "scene": SCENE, "error": 0.2},
    "relief_day": lambda: {
        "mesh": hills(), "latitude": 0.8, "day": 100.0, "hours": [10.0, 12.0], "depth": 0.1,
        "elevation": "h",
    },
    "relief_shadow": lambda: {"mesh": hills(), "scene": SUN, "depth": 0.1, "elevation": "h"},
    "satin": lambda: {
        "surface": ball(), "scene": SCENE, "tangents": "V", "seeds": 5, "max_steps": 20,
    },
    "streamlines": lambda: {
        "mesh": flow(), "scene": SCENE, "vectors": "V", "seeds": 5, "max_steps": 20,
    },
    "tint": lambda: {"lit": lit(), "scalars": "s"},
}  # fmt: skip


def plotting():
    """Return the arguments of `plot`."""
    return {"mesh": ball(), "scene": SCENE, "off_screen": True, "window_size": (60, 40)}


def drawn(**more):
    """Return arguments of a small picture."""
    return {"panels": lit(), "size": (60, 40), "anti_aliasing": None, **more}


#: Arguments of a valid call by the name of the callable; positional ones by name too.
CALLS = {
    "data.example_path": dict,
    "data.load_example": dict,
    "files.read": lambda: {"path": saved()},
    "files.surface_of": lambda: {"mesh": flow(), "contour": None},
    "files.warped": lambda: {"mesh": hills(), "name": "h", "factor": 1.0},
    "files.write_mesh": lambda: {"mesh": ball(), "path": Path("out.vtp")},
    **{f"filters.{name}.{name}": make for name, make in FILTERS.items() if name != "provenance"},
    **{f"accessor.Accessor.{name}": make for name, make in FILTERS.items()},
    "accessor.Accessor.relief_from_mesh": FILTERS["bas_relief"],
    "accessor.Accessor.plot": plotting,
    "filters.manifold.manifold": lambda: {
        "shape": manifolds.torus(1.0, 1.0, resolution=(6, 5)),
        "scene": SCENE4,
        "distance": 4.0,
    },
    "filters.solids.to_polydata": lambda: {"solid": vizlight.Sphere(), "tolerance": 0.1},
    "geometry.contours.banding.Laminae.order": lambda: {"toward": UP},
    "geometry.contours.frustum.truncus": lambda: {
        "center": (0, 0, 0),
        "axis": (0, 0, 1),
        "radii": (1.0, 0.5),
        "height": 1.0,
        "direction": UP,
        "levels": 4,
    },
    "geometry.contours.isoluminance.sphere": lambda: {
        "center": (0, 0, 0),
        "radius": 1.0,
        "direction": UP,
        "levels": 4,
    },
    "geometry.contours.isoluminance.virtual_light": lambda: {
        "center": (0, 0, 0),
        "light": Light(position=(3, 0, 0)),
        "eye": View(position=(0, 4, 0)),
    },
    "geometry.lines.curves.polyline_tangents": lambda: {"points": np.cumsum(unit(5, 3), axis=0)},
    "geometry.lines.fur.grow": lambda: {
        "roots": unit(4, 3),
        "directions": unit(4, 3),
        "lengths": np.full(4, 0.1),
        "segments": 3,
    },
    "geometry.lines.fur.seeds": lambda: dict(
        zip(("points", "faces"), triangles(), strict=True), count=5
    ),
    "geometry.nspace.manifolds.complex_curve": lambda: {"function": np.square, "resolution": 4},
    "geometry.nspace.manifolds.klein_bottle": lambda: {"resolution": (6, 5)},
    "geometry.nspace.manifolds.sphere3": lambda: {"resolution": 4},
    "geometry.nspace.manifolds.veronese": lambda: {"resolution": 4},
    "geometry.nspace.parametric.Manifold": lambda: {
        "points": unit(4, 3),
        "frame": frame(4, 2, 3),
        "cells": np.array([[0, 1, 3, 2]]),
    },
    "geometry.nspace.parametric.parametric": lambda: {
        "function": lambda u, v=0.5: (np.cos(u), np.sin(u), v, u * v),
        "domain": ((0.0, 3.0), (0.0, 1.0)),
        "n": 4,
        "resolution": 4,
    },
    "geometry.nspace.projection.image_and_depth": lambda: {"points": unit(5, 4), "distance": 3.0},
    "geometry.nspace.projection.perspective": lambda: {"points": unit(5, 4), "distance": 3.0},
    "geometry.nspace.projection.plane_rotation": lambda: {"n": 4, "plane": "xw", "angle": 0.3},
    "geometry.nspace.projection.push_forward": lambda: {
        "vectors": unit(5, 1, 4),
        "points": unit(5, 4),
        "distance": 3.0,
    },
    "geometry.nspace.projection.push_frame": lambda: {
        "frame": frame(5, 2, 4),
        "points": unit(5, 4),
        "distance": 3.0,
    },
    "geometry.nspace.projection.rotation": lambda: {"n": 4, "turns": ("xw", 0.3)},
    "geometry.nspace.projection.turn": lambda: {"vectors": unit(5, 4), "matrix": np.eye(4)},
    "geometry.nspace.slices.cut": lambda: {
        "values": np.linspace(-1, 1.1, 5),
        "simplices": np.array([[0, 1, 2, 3], [1, 2, 3, 4]]),
    },
    "geometry.nspace.slices.mean_frame": lambda: {
        "frame": frame(3, 2, 4),
        "shares": __import__("scipy.sparse").sparse.csr_array(np.eye(3)),
    },
    "geometry.nspace.slices.slice_frame": lambda: {"frame": frame(3, 2, 4), "normal": unit(4)},
    "geometry.nspace.tori.clifford_torus": lambda: {"resolution": (6, 5)},
    "geometry.nspace.tori.hopf_fibres": lambda: {"fibres": 3, "resolution": 8},
    "geometry.nspace.tori.torus": lambda: {"radii": (1.0, 0.5), "resolution": 6},
    "geometry.nspace.tori.torus_curve": lambda: {"ratio": 1.5, "resolution": 16},
    "geometry.relief.depth_map.depth_map": lambda: {
        "x": np.linspace(0, 1, 5),
        "y": np.linspace(0, 1, 4),
        **dict(zip(("points", "triangles"), triangles(), strict=True)),
    },
    "geometry.relief.shadowing.inside_length": lambda: {
        **grid(),
        "points": np.array([[0.5, 0.5, -0.3]]),
        "direction": UP,
    },
    "geometry.relief.shadowing.shadow": lambda: {**grid(), "depth": 0.1, "direction": UP},
    "geometry.relief.sun.directions": lambda: {"latitude": 0.8, "day": 100.0, "hours": [9.0, 12.0]},
    "geometry.relief.sun.disc": lambda: {"direction": UP, "diameter": 0.01, "count": 5},
    "geometry.relief.sun.toward": lambda: {"azimuth": [0.3, 1.0], "altitude": 0.5},
    "geometry.solids.base.Boolean": lambda: {
        "operation": "union",
        "first": vizlight.Sphere(),
        "second": vizlight.Block(),
    },
    "geometry.solids.base.Solid.contains": lambda: {"points": unit(4, 3)},
    "geometry.solids.base.Solid.rotate_vector": lambda: {"vector": UP, "angle": 0.3},
    "geometry.solids.base.Solid.rotate_x": lambda: {"angle": 0.3},
    "geometry.solids.base.Solid.rotate_y": lambda: {"angle": 0.3},
    "geometry.solids.base.Solid.rotate_z": lambda: {"angle": 0.3},
    "geometry.solids.base.Solid.scale": lambda: {"factor": 2.0},
    "geometry.solids.base.Solid.translate": lambda: {"xyz": (1.0, 0.0, 0.0)},
    "geometry.solids.polyhedra.HalfSpace": dict,
    "geometry.solids.polyhedra.Polyhedron": lambda: dict(
        zip(("points", "triangles"), triangles(), strict=True)
    ),
    "geometry.solids.polyhedra.Prism": lambda: {"outline": [[0, 0], [1, 0], [0, 1]]},
    "geometry.solids.primitives.Block": dict,
    "geometry.solids.primitives.Frustum": lambda: {"height": 1.0},
    "geometry.solids.primitives.Sphere": dict,
    "geometry.solids.primitives.Torus": dict,
    "geometry.solids.tessellation.tessellate": lambda: {
        "solid": vizlight.Sphere(),
        "tolerance": 0.1,
    },
    "geometry.solids.tessellation.volume_bounds": lambda: {
        "solid": vizlight.Sphere(),
        "tolerance": 0.1,
    },
    "mesh.polylines.direction_colors": lambda: {"mesh": pv.Spline(np.cumsum(unit(5, 3), 0), 8)},
    "mesh.records.provenance": FILTERS["provenance"],
    "model.brightness.exponent": lambda: {"k": 2, "n": 4},
    "model.brightness.mean_intensity": lambda: {"k": 2, "n": 4, "p": [1.0, 2.0]},
    "model.cylinder.diffuse": cylinder(),
    "model.cylinder.diffuse_gradient": cylinder(),
    "model.cylinder.specular": cylinder(shininess=20.0),
    "model.cylinder.specular_gradient": cylinder(shininess=20.0),
    "model.falloff.depth_cue": lambda: {
        "intensity": [0.5, 1.0],
        "z": [1.0, 2.0],
        "front": 0.5,
        "back": 3.0,
    },
    "model.falloff.distance": lambda: {"d": [0.5, 2.0], "c1": 1.0, "c2": 0.1, "c3": 0.1},
    "model.falloff.fur": lambda: {"height": [0.1, 0.5], "sin_alpha": [0.3, 1.0], "density": 0.3},
    "model.frames.orthonormalize": lambda: {"vectors": unit(4, 2, 3)},
    "model.frames.split": lambda: {"direction": unit(4, 3), "frame": frame(4, 2, 3)},
    "model.half_vector.identity": half(),
    "model.half_vector.reflection": half(),
    "model.half_vector.reflection_cosine": lambda: {"nu": [0.1, 0.2], "beta": 0.3, "theta": 0.4},
    "model.half_vector.reflection_from_half": lambda: {"n_h": [0.5, 0.9], "triple": 0.1},
    "model.highlights.best_factor": lambda: {"light_eye_angle": [1.0], "r": [10.0]},
    "model.highlights.blinn_from_phong": lambda: {"shininess": [10.0], "light_eye_angle": 1.0},
    "model.highlights.exchange_rate": lambda: {"light_eye_angle": [0.5, 1.0]},
    "model.highlights.max_pixel_error": lambda: {"light_eye_angle": [1.0], "r": [10.0]},
    "model.highlights.phong_from_blinn": lambda: {"shininess": [10.0], "light_eye_angle": 1.0},
    "model.highlights.pixel_error": lambda: {"rho": [0.1, 0.2], "r": 10.0},
    "model.highlights.required_factor": lambda: {"rho": [0.1, 0.2]},
    "model.highlights.simple_factor": lambda: {"light_eye_angle": [1.0], "r": [10.0]},
    "model.highlights.sphere_error": lambda: {"light_eye_angle": 1.0, "r": 10.0},
    "model.highlights.terminator_error": lambda: {
        "light_eye_angle": [1.0],
        "shininess": 10.0,
        "width": 0.2,
    },
    "model.reflection.diffuse": lambda: {"wi": unit(4, 3), "frame": frame(4, 2, 3)},
    "model.reflection.specular": lambda: {
        "wi": unit(4, 3),
        "wo": unit(4, 3, seed=2),
        "frame": frame(4, 2, 3),
        "shininess": 20.0,
    },
    "pictures.backends.choose_backend": dict,
    "pictures.backends.probe": lambda: {"backend": "EGL"},
    "pictures.cameras.camera_on": lambda: {"bounds": (0.0, 1.0, 0.0, 1.0, 0.0, 1.0)},
    "pictures.cameras.over_shoulder": lambda: {"camera": pv.Camera()},
    "pictures.movie.turn": lambda: {
        "mesh": torus(),
        "path": Path("movie.gif"),
        "scene": SCENE4,
        "frames": 2,
        "picture": {"size": (60, 40), "anti_aliasing": None},
    },
    "pictures.render.Panel": lambda: {"mesh": lit()},
    "pictures.render.make_plotter": drawn,
    "pictures.render.pictures": lambda: {
        "sequence": [lit()],
        "size": (60, 40),
        "anti_aliasing": None,
    },
    "pictures.render.save_png": lambda: drawn(path=Path("picture.png")),
    "pictures.testing.assert_same_picture": lambda: {
        "got": np.zeros((20, 20, 3), np.uint8),
        "expected": np.zeros((20, 20, 3), np.uint8),
    },
    "pictures.testing.difference": lambda: {
        "got": np.zeros((20, 20, 3), np.uint8),
        "expected": np.zeros((20, 20, 3), np.uint8),
    },
    "plotting.component.Component.add_mesh": lambda: {"mesh": ball(), "scene": SCENE},
    "plotting.component.Component.explain": lambda: {"actor": pv.Actor()},
    "plotting.component.add_recorded": lambda: {
        "plotter": plotter(),
        "mesh": lit(),
        "name": "luminance",
    },
    "plotting.component.plot": plotting,
    "scene.light.Light": lambda: {"position": (3.0, 0.0, 0.0)},
    "scene.light.Light.headlight": dict,
    "scene.light.Light.seen_from": lambda: {"view": View(direction=(0, 0, 1))},
    "scene.material.Material": dict,
    "scene.material.Material.from_property": lambda: {"source": pv.Property()},
    "scene.material.Material.to_property": dict,
    "scene.scene.Scene": lambda: {"lights": Light(direction=UP), "view": View(direction=UP)},
    "scene.scene.Scene.from_dict": lambda: {"values": SCENE.to_dict()},
    "scene.scene.Scene.from_plotter": lambda: {"plotter": plotter()},
    "scene.scene.Scene.moved": lambda: {"offset": (1.0, 0.0, 0.0)},
    "scene.scene.Scene.replace": dict,
    "scene.view.DepthCue": lambda: {"front": 0.0, "back": 1.0},
    "scene.view.View": lambda: {"position": (3.0, 0.0, 0.0)},
    "scene.view.View.from_camera": lambda: {"camera": pv.Camera()},
    "shading.decide.plan": lambda: {"scene": SCENE, "k": 1},
    "shading.engine.depth_range": lambda: {"points": unit(6, 3), "scene": SCENE},
    "shading.engine.observed": lambda: {"observer": None},
    "shading.engine.run": lambda: {
        "inputs": inputs(),
        "scene": SCENE,
        "options": engine.ShadingOptions(),
    },
    "shading.engine.shade": lambda: {
        "points": unit(6, 3),
        "tangents": unit(6, 3, seed=2),
        "scene": SCENE,
        "normals": unit(6, 3, seed=3),
    },
    "shading.inputs.ShadingInputs.check": lambda: {"lights": 2},
    "shading.options.Bundle": dict,
    "shading.options.ShadingOptions": dict,
    "studies._framework.cheapest": lambda: {"rows": result().rows},
    "studies._framework.holding": lambda: {"rows": result().rows},
    "studies._framework.order": lambda: {"rows": result().rows},
    "studies._results.Result.draw": lambda: {"path": Path("figure.png")},
    "studies._results.Result.write_csv": lambda: {"path": Path("rows.csv")},
    "studies._results.print_list": lambda: {"studies": {"a": study()}},
    "studies._results.print_result": lambda: {"result": result()},
    "studies._results.run": lambda: {"name": "a", "study": study()},
    "studies.load": lambda: {"name": "frames"},
    "studies.names": dict,
    "verify.report.report": dict,
}
#: Objects whose methods are called.
SELF = {
    **{name: vizlight.Sphere for name in CALLS if name.startswith("geometry.solids.base.Solid.")},
    "geometry.contours.banding.Laminae.order": lambda: vizlight.geometry.isoluminance.sphere(
        (0, 0, 0), 1.0, direction=UP, levels=4, form="laminae"
    ),
    "plotting.component.Component.add_mesh": lambda: plotter().vizlight,
    "plotting.component.Component.explain": lambda: plotter().vizlight,
    "scene.light.Light.seen_from": Light.headlight,
    "scene.material.Material.to_property": Material,
    "scene.scene.Scene.moved": lambda: SCENE,
    "scene.scene.Scene.replace": lambda: SCENE,
    "shading.inputs.ShadingInputs.check": inputs,
    "studies._results.Result.draw": result,
    "studies._results.Result.write_csv": result,
}
#: Arguments that are not replaced, with the reason.
SKIPPED = {
    ("files.read", "isolated"): "starts Python, which takes seconds",
}
#: The only arguments that are replaced where a function of the same arguments is walked anyway.
ONLY = {name: ("mesh", "surface", "lit", "scene") for name in CALLS if name.startswith("accessor.")}
#: Words by which an error may name an argument, where the command line says the same to its users.
ALIASES = {
    ("files.read", "path"): {"file"},
    ("files.write_mesh", "path"): {"output"},
    ("files.warped", "factor"): {"warp_factor"},
    ("pictures.movie.turn", "path"): {"output"},
    ("pictures.render.save_png", "path"): {"output"},
    ("pictures.testing.assert_same_picture", "expected"): {"output", "file"},
    ("plotting.component.plot", "screenshot"): {"output"},
    ("studies._results.Result.draw", "path"): {"output"},
    ("studies._results.Result.write_csv", "path"): {"output"},
    ("files.write_mesh", "mesh"): {"output"},
    ("files.warped", "name"): {"warp"},
    ("filters.relief_day.relief_day", "factor"): {"z"},
    ("filters.relief_shadow.relief_shadow", "factor"): {"z"},
    ("studies.load", "name"): {"study"},
    ("geometry.nspace.projection.rotation", "turns"): {"rotation", "plane", "angle"},
}
#: Places of results that are documented to be NaN or infinite, as regular expressions, and words of
#: the documentation that say so.
MARKED = {
    "model.half_vector.identity": ("^result$", "NaN where a vector is zero or not finite"),
    "model.half_vector.reflection": ("^result$", "NaN where a vector is zero or not finite"),
    "geometry.lines.fur.grow": ("^result$", "NaN where an array is not finite"),
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
    "geometry.relief.depth_map.depth_map": ("^result$", "NaN where no triangle covers the node"),
    "geometry.relief.shadowing.inside_length": (
        "^result$",
        "infinity where a ray never leaves the solid; NaN",
    ),
    "model.frames.split": (r"^\[[01]\]$", "results are NaN where x is not finite"),
}
PUBLIC = public()


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
