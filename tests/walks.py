"""Random walks over the public filters and over files: ``python tests/walks.py 400 --seed 7``.

A walk begins at a small mesh and takes steps, each with options drawn at random: filters of
vizlight, filters of PyVista, a file that is written and read. A step may refuse the mesh at a
``raise`` of vizlight, and the walk goes on. It fails if the error is another one, if a mesh that
was given has changed, if light is not finite or beyond what can be white, or if it takes too long.
A walk is repeated by its seed and number.
"""

import collections
import contextlib
import functools
import signal
import warnings

import adversary
import numpy as np
import pyvista as pv
from hostile import seeds
from hostile.runner import ask

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, pieces
from vizlight.geometry import manifolds

#: Steps of a walk, largest number of points to go on with, and seconds that a step may take.
STEPS, MOST, LIMIT = 5, 20_000, 30.0


def field():
    """Return a height field with a hole."""
    x, y = np.meshgrid(np.linspace(0, 6, 12), np.linspace(0, 5, 10))
    mesh = pv.StructuredGrid(x, y, np.sin(x) * np.cos(y))
    mesh["V"] = np.stack([np.ones(120), np.sin(x.T.ravel()), np.zeros(120)], axis=1)
    mesh["height"] = np.where(np.arange(120) == 55, np.nan, mesh.points[:, 2])
    return mesh


MESHES = {
    "ball": seeds.ball,
    "box": seeds.box,
    "tetrahedra": seeds.tetrahedra,
    "lines": lambda: pv.MultiBlock(
        [pv.lines_from_points(line) for line in seeds.lines()]
    ).combine(),
    "field": field,
    "cube": lambda: pv.Cube().triangulate(),
    "two": lambda: pv.MultiBlock({"a": seeds.ball(), "b": seeds.ball().translate((2, 0, 0))}),
    "torus": lambda: vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=8)),
    "cloud": lambda: pv.PolyData(np.random.default_rng(0).random((40, 3))),
    "empty": pv.PolyData,
}


def scene(random):
    """Return a scene of some lights."""
    n = random.normal
    lamps = [
        Light(direction=n(size=3), intensity=random.uniform(0, 2)) if random.random() < 0.5
        else Light(position=n(size=3), attenuation=(1, random.uniform(0, 1), 0))
        for _ in range(random.integers(1, 4))
    ]  # fmt: skip
    view = [None, View(direction=n(size=3)), View(position=9 * n(size=3))][random.integers(3)]
    return Scene(
        lights=lamps, view=view, depth_cue=DepthCue() if view and random.random() < 0.3 else None,
        material=Material(
            color=(0.9, 0.5, 0.2) if random.random() < 0.3 else None,
            shininess=float(random.choice([0, 1, 20, 1e3])),
        ),
    )  # fmt: skip


def options(random, mesh):
    """Return some options of light."""
    names = [*getattr(mesh, "point_data", {}), "V", "missing"]
    every = {
        "tangents": names, "normals": names, "facing": ["auto", "eye", "outward", "as given"],
        "feature_angle": [30.0, None], "conditioned": [True], "exponent": [1, 2],
        "model": ["phong", "blinn"], "components": [True], "name": ["luminance", "second"],
    }  # fmt: skip
    chosen = {key: values[random.integers(len(values))] for key, values in every.items()}
    return {key: value for key, value in chosen.items() if random.random() < 0.15}


def through_a_file(mesh, random):
    """Return a mesh as it comes back from a file."""
    suffix = random.choice([".vtk", ".vtp", ".vtu", ".vts", ".vti", ".vtm", ".stl"])
    path = vizlight.files.write_mesh(mesh, f"walk{suffix}")
    return vizlight.read(path)


def in_pieces(mesh, random):
    """Return a mesh that was written, lit in pieces and read."""
    suffix = {"PolyData": "vtp", "UnstructuredGrid": "vtu", "StructuredGrid": "vts"}.get(
        type(mesh).__name__, "vti"
    )
    path = vizlight.files.write_mesh(mesh, f"piece.{suffix}")
    lit = pieces.light(path, scene(random), out=f"lit.p{suffix}", **options(random, mesh))
    return vizlight.read(lit.path)


def _filter(name):
    def step(mesh, random):
        found = getattr(vizlight, name)(mesh, scene(random), **options(random, mesh))
        return found["bands"] if name == "isoluminance" else found

    return step


def _with_missing(mesh, random):
    found = mesh.copy()
    if found.n_points and "V" in found.point_data:
        found["V"][random.random(found.n_points) < 0.2] = np.nan
    return found


#: Steps by name; those of PyVista may fail as they like.
TAKEN = {
    **{
        name: _filter(name)
        for name in ("illuminate", "refine", "isoluminance", "fur", "satin", "relief_shadow")
    },
    "tint": lambda mesh, random: vizlight.tint(mesh, str(random.choice(["height", "V", "none"]))),
    "sky": lambda mesh, random: vizlight.sky(mesh, error=0.1),
    "streamlines": lambda mesh, random: vizlight.streamlines(
        mesh, scene(random), tangents="V", seeds=20
    ),
    "project": lambda mesh, random: vizlight.project(mesh),
    "file": through_a_file,
    "pieces": in_pieces,
}
FOREIGN = {
    "clip": lambda mesh, random: mesh.clip(normal=tuple(random.normal(size=3))),
    "contour": lambda mesh, random: mesh.contour(3, scalars="height"),
    "scale": lambda mesh, random: mesh.scale(10.0 ** int(random.integers(-6, 7))),
    "move": lambda mesh, random: mesh.translate(tuple(1e6 * random.normal(size=3))),
    "surface": lambda mesh, random: mesh.extract_surface(algorithm="geometry").triangulate(),
    "some cells": lambda mesh, random: mesh.extract_cells(
        np.flatnonzero(random.random(mesh.n_cells) < 0.5)
    ),
    "join": lambda mesh, random: pv.MultiBlock([mesh, mesh.copy()]).combine(),
    "missing points": _with_missing,
}


def fault(name, step, mesh, random):
    """Return what is wrong with a step, an empty text if nothing is, and the mesh to go on with."""
    before, found = adversary.mark(mesh), mesh
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", UserWarning)
            found = step(mesh, random)
    except Exception as error:  # noqa: BLE001
        place, own = adversary.place_of(error)
        if not own:
            return f"raw {type(error).__name__} at {place}: {error}", mesh
    if adversary.mark(mesh) != before:
        return "the mesh was changed", mesh
    for block in found if isinstance(found, pv.MultiBlock) else [found]:
        light = np.asarray(getattr(block, "point_data", {}).get("luminance", np.zeros(1)))
        if name in ("illuminate", "refine", "fur") and light.size and not np.isfinite(light).all():
            return "light is not finite", mesh
    return "", found


def walk(seed, number, said):
    """Take a walk; write its steps as they are taken, and return what is wrong with the last."""
    random = np.random.default_rng([seed, number])
    start = str(random.choice([*MESHES]))
    mesh = MESHES[start]()
    said.write(start)
    for _ in range(STEPS):
        steps = FOREIGN if random.random() < 0.35 else TAKEN
        name = str(random.choice([*steps]))
        said.write(f" > {name}")
        said.flush()
        wrong, made = "", mesh
        try:
            with adversary.limited(LIMIT):
                if steps is TAKEN:
                    wrong, made = fault(name, TAKEN[name], mesh, random)
                else:
                    # PyVista refuses what it cannot do in any way.
                    with contextlib.suppress(Exception):
                        made = FOREIGN[name](mesh, random)
        except adversary.TooSlow:
            wrong = f"more than {LIMIT:g} s"
        if wrong:
            return wrong
        whole = isinstance(made, pv.DataSet | pv.MultiBlock)
        if whole and sum(block.n_points for block in _blocks(made)) <= MOST:
            mesh = made
    return ""


def _blocks(mesh):
    if not isinstance(mesh, pv.MultiBlock):
        return [mesh]
    return [one for block in mesh if block is not None for one in _blocks(block)]


def run(total, seed, folder, say):
    """Take walks, each in a fork of this process, and count those that failed."""
    counts = collections.Counter()
    for number in range(total):
        text, code = adversary.forked(functools.partial(_alone, seed, number))
        path, _, wrong = text.partition("\n")
        failed = bool(code or wrong)
        counts["failed" if failed else "walks"] += 1
        if failed:
            say(f"{number}: {path}: {wrong} (exit code {code})")
    return counts


def _alone(seed, number, file):
    """Take one walk in this process; what is wrong is written line by line."""
    signal.alarm(int(20 * LIMIT))
    with adversary.new_folder():
        file.write("\n" + " ".join(walk(seed, number, file).split()))


if __name__ == "__main__":
    ask(run, 100)
