"""Small, valid calls of what takes meshes, scenes, files or plotters, for the same walk."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyvista as pv
from adversary_arrays import UP, unit

import vizlight
from vizlight import Light, Material, Scene, View, engine, presets
from vizlight.geometry import manifolds
from vizlight.scene.presets import PRESETS
from vizlight.shading.inputs import ShadingInputs

SCENE = Scene(
    lights=(Light(direction=UP), Light(position=(3.0, 2.0, 4.0))),
    view=View(position=(5.0, 4.0, 6.0)),
    material=Material(color=(1.0, 0.5, 0.2)),
)  # fmt: skip
SCENE4 = Scene(lights=Light(direction=(0.7, 0.6, 0.4, 0.1)), view=View(direction=(0, 0.3, 1, 0.2)))
SUN = Scene(lights=Light(direction=UP), view=View(direction=(0, 0, 1)))


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


def saved():
    """Return the path of a mesh that is saved."""
    ball().save("ball.vtp")
    return Path("ball.vtp")


def plotter():
    """Return a plotter with a mesh."""
    made = pv.Plotter(off_screen=True, window_size=(60, 40))
    made.add_mesh(pv.Sphere(theta_resolution=6, phi_resolution=6))
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


FILTERS = {
    "bas_relief": lambda: {"mesh": ball(), "resolution": 8},
    "fur": lambda: {"surface": ball(), "scene": SCENE, "fibres": 20, "length": 0.1, "density": 0.3},
    "illuminate": lambda: {"mesh": ball(), "scene": SCENE, "tangents": "V"},
    "isoluminance": lambda: {"mesh": ball(), "scene": SUN, "levels": 4},
    "legibility": lambda: {
        "mesh": ball(), "scene": SCENE, "tangents": "V", "scalars": "s", "samples": 16,
    },
    "project": lambda: {"mesh": torus(), "scene": SCENE4, "distance": 4.0},
    "provenance": lambda: {"mesh": lit()},
    "refine": lambda: {"mesh": ball(), "scene": SCENE, "error": 0.2},
    "relief_day": lambda: {
        "mesh": hills(), "latitude": 0.8, "day": 100.0, "hours": [10.0, 12.0], "depth": 0.1,
        "elevation": "h",
    },
    "relief_shadow": lambda: {"mesh": hills(), "scene": SUN, "depth": 0.1, "elevation": "h"},
    "satin": lambda: {
        "surface": ball(), "scene": SCENE, "tangents": "V", "seeds": 5,
    },
    "sky": lambda: {"mesh": ball(), "error": 0.1},
    "streamlines": lambda: {
        "mesh": flow(), "scene": SCENE, "vectors": "V", "seeds": 5,
    },
    "tint": lambda: {"lit": lit(), "scalars": "s"},
}  # fmt: skip


def plotting():
    """Return the arguments of `plot`."""
    return {"mesh": ball(), "scene": SCENE, "off_screen": True, "window_size": (60, 40)}


def series():
    """Return two steps of a flow that changes with time, and how its lines are made."""
    steps = [flow(), flow()]
    for time, step in enumerate(steps):
        step.field_data["TimeValue"] = [float(time)]
        step.point_data["V"] *= 0.2 * (1 + time)
    return {"series": steps, "scene": SCENE, "vectors": "V", "seeds": 4}


def written(name):
    """Return arguments of a function that writes a lit mesh to a file."""
    return {"mesh": ball(), "scene": SCENE, "path": Path(name)}


def drawn(**more):
    """Return arguments of a small picture."""
    return {"panels": lit(), "size": (60, 40), "anti_aliasing": None, **more}


#: Arguments of a valid call by the name of the callable; positional ones by name too.
CALLS = {
    "files.read": lambda: {"path": saved()},
    "files.surface_of": lambda: {"mesh": flow(), "contour": None},
    "files.stretched": lambda: {"mesh": hills(), "factor": 2.0},
    "files.warped": lambda: {"mesh": hills(), "name": "h", "factor": 1.0},
    "files.with_vectors": lambda: {"mesh": hills(), "names": "h,h"},
    "files.write_mesh": lambda: {"mesh": ball(), "path": Path("out.vtp")},
    **{
        f"filters.{name}.{name}": make
        for name, make in FILTERS.items()
        if name not in ("legibility", "provenance")
    },
    **{f"accessor.Accessor.{name}": make for name, make in FILTERS.items()},
    "accessor.Accessor.live_html": lambda: written("page.html"),
    "accessor.Accessor.plot": plotting,
    "accessor.Accessor.save_gltf": lambda: written("mesh.glb"),
    "filters.manifold.manifold": lambda: {
        "shape": manifolds.torus(1.0, 1.0, resolution=(6, 5)),
        "scene": SCENE4,
        "distance": 4.0,
    },
    "filters.solids.to_polydata": lambda: {"solid": vizlight.Sphere(), "tolerance": 0.1},
    "mesh.polylines.direction_colors": lambda: {"mesh": pv.Spline(np.cumsum(unit(5, 3), 0), 8)},
    "mesh.records.provenance": FILTERS["provenance"],
    "observers.legibility.legibility": FILTERS["legibility"],
    "filters.pathlines.pathlines": series,
    "draw.backends.probe": lambda: {"backend": "egl"},
    "draw.cameras.camera_on": lambda: {"bounds": (0.0, 1.0, 0.0, 1.0, 0.0, 1.0)},
    "draw.cameras.over_shoulder": lambda: {"camera": pv.Camera()},
    "draw.movie.save": lambda: {
        "frames": [lit(), lit()],
        "path": Path("movie.png"),
        "picture": {"size": (60, 40), "anti_aliasing": None},
    },
    "draw.movie.turn": lambda: {
        "mesh": torus(),
        "path": Path("movie.png"),
        "scene": SCENE4,
        "frames": 2,
        "picture": {"size": (60, 40), "anti_aliasing": None},
    },
    "draw.render.Panel": lambda: {"mesh": lit()},
    "draw.render.make_plotter": drawn,
    "draw.render.pictures": lambda: {
        "sequence": [lit()],
        "size": (60, 40),
        "anti_aliasing": None,
    },
    "draw.render.save_png": lambda: drawn(path=Path("picture.png")),
    "draw.testing.assert_same_picture": lambda: {
        "got": np.zeros((20, 20, 3), np.uint8),
        "expected": np.zeros((20, 20, 3), np.uint8),
    },
    "draw.testing.difference": lambda: {
        "got": np.zeros((20, 20, 3), np.uint8),
        "expected": np.zeros((20, 20, 3), np.uint8),
    },
    "pieces.sources.Slabs": lambda: {"arrays": {"a": np.zeros((3, 4, 5))}},
    "pieces.run.camera_on": lambda: {"sources": saved()},
    "pieces.run.light": lambda: {
        "sources": saved(),
        "scene": SCENE,
        "out": Path("lit.pvtp"),
        "tangents": "V",
    },
    "pieces.workers.Processes": lambda: {"count": 1},
    "draw.component.Component.add_key": lambda: {"scene": presets.shape()},
    "draw.component.Component.add_mesh": lambda: {"mesh": ball(), "scene": SCENE},
    "draw.component.Component.explain": lambda: {"actor": shown()},
    "draw.component.Component.export_html": lambda: {
        "path": shown() and Path("page.html"),
    },
    "draw.component.Component.set_scene": lambda: {"actor": shown(), "scene": SCENE},
    "draw.component.add_recorded": lambda: {
        "plotter": plotter(),
        "mesh": lit(),
        "name": "luminance",
    },
    "draw.gltf.save_gltf": lambda: written("mesh.glb"),
    "draw.html.live_html": lambda: written("page.html"),
    "draw.paraview.save": lambda: written("shown.py"),
    "draw.paraview.shader": lambda: {"scene": SCENE, "tangents": "V"},
    "draw.show.plot": plotting,
    "scene.light.Light": lambda: {"position": (3.0, 0.0, 0.0)},
    "scene.light.Light.seen_from": lambda: {"view": View(direction=(0, 0, 1))},
    "scene.material.Material.from_property": lambda: {"source": pv.Property()},
    **{f"scene.presets.{name}": dict for name in PRESETS},
    "filters.key.key": lambda: {"scene": presets.shape()},
    "filters.key.key_picture": lambda: {"scene": presets.shape()},
    "scene.scene.Scene": lambda: {"lights": Light(direction=UP), "view": View(direction=UP)},
    "scene.scene.Scene.from_dict": lambda: {"values": SCENE.to_dict()},
    "scene.scene.Scene.from_plotter": lambda: {"plotter": plotter()},
    "scene.scene.Scene.moved": lambda: {"offset": (1.0, 0.0, 0.0)},
    "scene.view.DepthCue": lambda: {"front": 0.0, "back": 1.0},
    "scene.view.View": lambda: {"position": (3.0, 0.0, 0.0)},
    "scene.view.View.from_camera": lambda: {"camera": pv.Camera()},
    "scene.view.View.isometric": lambda: {"n": 3},
    "vtk.illuminate.Illuminate": lambda: {"scene": SCENE},
    "shading.engine.plan": lambda: {"scene": SCENE, "k": 1},
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
}
