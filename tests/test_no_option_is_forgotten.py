"""Each option and each part of a scene has an effect in all that computes or writes light.

The fields are taken from the classes themselves: a new one needs a line below, and fails where an
algebra, the oracle, the filter, the page or the command line ignores it.
"""

import dataclasses
import json
import re
import warnings
from pathlib import Path

import numpy as np
import oracles
import pytest
import pyvista as pv
from differential import by_numpy

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, cli, writing
from vizlight.draw import glsl as program
from vizlight.draw import html
from vizlight.observers.check import reference
from vizlight.reading import brains, formats, reader
from vizlight.shading.arrays import Shading
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import LightOptions, ShadingOptions
from vizlight.shading.plan import decide
from vizlight.verify.between import columns

CUE = DepthCue(front=2, back=9, front_scale=0.9, back_scale=0.3, cue=0.1)
FAR = Light(direction=(1, 2, 3))
LAMP = Light(position=(3, 4, 5), intensity=0.8)
SHINE = Material(ambient=0.2, diffuse=0.5, specular=0.4)
SCENE = Scene(lights=LAMP, material=SHINE, view=View(position=(1, -2, 6), direction=(0.2, -0.3, 1)))
BASES = {Light: LAMP, Material: SHINE, DepthCue: CUE, Scene: SCENE}
#: Another value of each field, or a pair: what to compare with, and it with another value.
PARTS = {
    Light: {
        "direction": (FAR, Light(direction=(3, 2, 1))), "position": (-3, 4, 5), "intensity": 0.7,
        "attenuation": (0.5, 0.1, 0.01), "color": (1, 0.6, 0.3),
        "follows_view": (FAR, Light(direction=(1, 2, 3), follows_view=True)),
    },
    Material: {
        "ambient": 0.3, "diffuse": 0.6, "specular": 0.3, "shininess": 5.0,
        "color": (0.9, 0.6, 0.4), "specular_color": (0.9, 0.6, 0.4),
    },
    DepthCue: {
        "front": 3.0, "back": 8.0, "front_scale": 0.8, "back_scale": 0.2, "cue": 0.3,
        "color": (0.3, 0.4, 1), "smooth": True,
    },
    Scene: {
        "lights": [LAMP, FAR], "material": Material(diffuse=0.6), "depth_cue": CUE,
        "view": View(position=(2, -0.2, 6), direction=(0.2, 0, 1)),
        "ambient_intensity": 0.5, "ambient_color": (0.6, 0.8, 1), "exposure": 1.7,
    },
}  # fmt: skip
#: Another value of each option than its default; a pair is that and the options beside both.
OPTIONS = {
    "model": "blinn", "exponent": (1.0, {"tangents": "around"}),
    "conditioned": (True, {"tangents": "around", "conditioned": False}), "components": True,
    "precision": ("float64", {"precision": "float32"}), "tangents": "around",
    "positions": "place", "normals": "tilted", "facing": "eye",
    "feature_angle": (20.0, {"feature_angle": 179.0}), "line_field": (True, {"tangents": "around"}),
    "bundle": (True, {"bundle": False}), "occlusion": "share", "name": "other",
}  # fmt: skip
#: What has no effect in a place, and why.
WITHOUT = {
    ("glsl", "components"): "a fragment has one colour",
    ("glsl", "precision"): "fragments are float32",
    ("oracle", "components"): "it always returns them",
    ("oracle", "precision"): "it has the one of its numbers",
    ("filtered", "line_field"): "it matters between points, to refine and to a check",
    ("page", "line_field"): "it matters between points, to refine and to a check",
    ("page", "components"): "a page shows one picture",
    ("shell", "positions"): "lights in n-space are for scripts",
}


def within(part):
    """Return the scene with another part in its place."""
    if isinstance(part, Scene):
        return part
    name = {Light: "lights", Material: "material", DepthCue: "depth_cue"}[type(part)]
    return SCENE.replace(**{name: part})


def two_scenes(kind, name):
    """Return two scenes that differ in one field of a part."""
    value = PARTS[kind][name]
    if not (isinstance(value, tuple) and isinstance(value[0], kind)):
        value = BASES[kind], dataclasses.replace(BASES[kind], **{name: value})
    return [within(part) for part in value]


def two_options(name):
    """Return two sets of options that differ in one."""
    value, beside = OPTIONS[name] if isinstance(OPTIONS[name], tuple) else (OPTIONS[name], {})
    return beside, beside | {name: value}


GIVEN = np.random.default_rng(3).normal(size=(3, 6, 3))
POINTS = ShadingInputs(points=GIVEN[0], tangents=GIVEN[1][:, None], normals=GIVEN[2])


def planned(scene, options):
    """Return the options of points alone, which have no names of arrays, and their plan."""
    asked = ShadingOptions(**{k: v for k, v in options.items() if k != "tangents"})
    return asked, decide(scene, POINTS.layout, asked, asked.precision)


def numpy(scene, options, folder):
    """The algebra of arrays."""
    _, plan = planned(scene, options)
    output = Shading.of(plan, POINTS.count)
    by_numpy(plan, POINTS, output)
    return [(str(v.dtype), v.tolist()) for v in output.arrays().values()]


def glsl(scene, options, folder):
    """The algebra that writes text for fragments, with the numbers that it is given."""
    _, plan = planned(scene, options)
    lights = [light.seen_from(scene.view) for light in scene.lights]
    held = program.numbers(scene, lights, fur=0.0, tallest=1.0)
    # The renderer holds the colours of the material.
    colors = scene.material.color, scene.material.specular_color
    return program.write(plan, turned=False), held, colors


def oracle(scene, options, folder):
    """The second implementation."""
    asked, _ = planned(scene, options)
    known = {k: v for k, v in vars(asked).items() if k not in ("components", "precision")}
    rows = zip(POINTS.points, POINTS.tangents, POINTS.normals, strict=True)
    return [oracles.digits.light(*(v.tolist() for v in row), scene, **known) for row in rows]


def mesh_of(options):
    """Return lines for a bundle, else a body with edges."""
    random = np.random.default_rng(5)
    body = pv.Cylinder(resolution=12, capping=True).triangulate()
    mesh = pv.MultipleLines(random.normal(size=(30, 3))) if "bundle" in options else body
    mesh.clear_data()
    places = np.asarray(mesh.points, float)
    mesh["around"], mesh["place"] = np.cross(places, (0.3, 0.2, 1.0)), places * (1, 1, 2)
    mesh["tilted"] = places + random.normal(size=places.shape)
    mesh["share"] = np.linspace(0, 1, len(places))
    return mesh


def filtered(scene, options, folder):
    """The filter of meshes: all its point arrays."""
    lit = vizlight.illuminate(mesh_of(options), scene, **options)
    return {k: (str(v.dtype), v.tolist()) for k, v in lit.point_data.items()}


def page(scene, options, folder):
    """The page: all its data and texts."""
    path = vizlight.live_html(mesh_of(options), folder / "a.html", scene=scene, **options)
    return path.read_text("utf-8")


def shell(scene, options, folder):
    """The command line: all arrays of the file that it writes, records among them."""
    paths = [str(folder / name) for name in ("a.vtp", "scene.json", "lit.vtp")]
    mesh = mesh_of(options)
    for name in set(mesh.point_data) - {value for value in options.values() if value is not True}:
        # The command shows vectors that are there, and here options alone make the difference.
        if mesh.point_data[name].ndim == 2:
            del mesh.point_data[name]
    mesh.save(paths[0])
    Path(paths[1]).write_text(json.dumps(scene.to_dict()))
    words = [
        f"--{k.replace('_', '-')}" + ("" if v is True else f"={v}".replace(" ", "-"))
        for k, v in options.items() if v is not False
    ]  # fmt: skip
    # Where another array is shown no lines are traced along the vectors.
    light = ["light", paths[0], "--array", "share"]
    assert cli.main([*light, "--scene", paths[1], *words, "-o", paths[2]]) == 0
    lit = pv.read(paths[2])
    return [{k: v.tolist() for k, v in d.items()} for d in (lit.point_data, lit.field_data)]


ALGEBRAS, WRITERS = (numpy, glsl, oracle), (filtered, page, shell)
CASES = [
    (place, kind, field.name)
    for place in (*ALGEBRAS, *WRITERS)
    for kind in (*BASES, ShadingOptions if place in ALGEBRAS else LightOptions)
    for field in dataclasses.fields(kind)
]


@pytest.mark.sampled(2)
@pytest.mark.opengl
@pytest.mark.parametrize(("place", "kind", "name"), CASES, ids=lambda x: getattr(x, "__name__", x))
def test_a_field_has_an_effect(place, kind, name, tmp_path, monkeypatch):
    monkeypatch.setattr(html, "_picture", lambda *_, **__: "")
    ignored = (place.__name__, name) in WITHOUT
    if ignored and place in WRITERS:
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if kind in BASES:
            one, other = (place(scene, {}, tmp_path) for scene in two_scenes(kind, name))
        else:
            one, other = (place(SCENE, options, tmp_path) for options in two_options(name))
    assert (one == other) == ignored, f"{place.__name__} and {kind.__name__}.{name}"


_random = np.random.default_rng(4)
PLACES, LINES, NORMALS = _random.normal(size=(3, 12, 3))
PLANES = _random.normal(size=(12, 2, 4))
#: Points of each kind of manifold, on which a part of a scene may have a path of its own.
MANIFOLDS = {
    "surface": {"normals": NORMALS},
    "surface in a cos-theta shadow": {"normals": NORMALS, "shadow": _random.random((12, 2))},
    "lines": {"tangents": LINES},
    "lines on a surface": {"tangents": LINES, "normals": NORMALS},
    "mixed": {"tangents": LINES, "normals": NORMALS, "dimensions": np.arange(12) % 3},
    "n-space": {"points": _random.normal(size=(12, 4)), "tangents": PLANES},
}


def lifted(scene):
    """Return a scene of 4-space: each place and direction with a fourth component."""

    def longer(end):
        vectors = {name: getattr(end, name) for name in ("position", "direction")}
        vectors = {name: (*v, 0.5) for name, v in vectors.items() if v is not None}
        return dataclasses.replace(end, **vectors)

    return scene.replace(lights=list(map(longer, scene.lights)), view=longer(scene.view))


@pytest.mark.parametrize(
    ("manifold", "model"), list(zip(MANIFOLDS, 3 * ["phong", "blinn"], strict=True))
)
@pytest.mark.parametrize(
    ("kind", "name"), [(kind, field.name) for kind in BASES for field in dataclasses.fields(kind)]
)
def test_a_field_means_on_each_manifold_what_it_means_to_the_oracle(kind, name, manifold, model):
    scenes = two_scenes(kind, name)
    if manifold == "n-space":
        if name == "follows_view":
            return  # such a light is in the frame of the eye, which 3-space alone has
        scenes = map(lifted, scenes)
    options, lit = ShadingOptions(model=model, precision="float64"), []
    for scene in scenes:
        inputs = {"points": PLACES} | MANIFOLDS[manifold]
        if "shadow" in inputs:
            inputs["shadow"] = inputs["shadow"][:, : len(scene.lights)]
        inputs = ShadingInputs(**inputs)
        true = [reference(inputs, i, scene, options, 1e-14) for i in range(inputs.count)]
        lit.append([[light.luminance, *light.rgb] for light in true])
        plan = decide(scene, inputs.layout, options)
        output = Shading.of(plan, inputs.count)
        with np.errstate(all="ignore"):
            by_numpy(plan, inputs, output)
        np.testing.assert_allclose(columns(output), lit[-1], rtol=1e-9)
    assert lit[0] != lit[1]


def live(scene, then=None):
    """Return the picture of a ball in a live light, set to another scene after the first frame."""
    plotter = pv.Plotter(off_screen=True, window_size=(60, 60))
    actor = plotter.vizlight.add_mesh(pv.Sphere(radius=2), scene=scene.replace(view=None))
    plotter.camera_position = [(1, -2, 9), (0, 0, 0), (0, 1, 0)]
    picture = plotter.screenshot(return_img=True)
    if then is not None:
        plotter.vizlight.set_scene(actor, then.replace(view=None))
        plotter.render()
        picture = plotter.screenshot(return_img=True)
    return picture.astype(int)


@pytest.mark.sampled(5)
@pytest.mark.opengl
@pytest.mark.parametrize(
    ("kind", "name"), [(kind, name) for kind in PARTS for name in PARTS[kind] if name != "view"]
)
def test_another_scene_of_a_live_light_is_the_light_of_that_scene(kind, name):
    """A field that a shader holds as a constant makes another shader."""
    one, other = two_scenes(kind, name)
    if kind is Material and isinstance(getattr(one.material, name), float):
        # What a scene does not need is in no shader.
        one = one.replace(material=dataclasses.replace(one.material, **{name: 0.0}))
    pictures = live(one), live(other)
    if name != "smooth":
        assert np.abs(pictures[0] - pictures[1]).max() > 2
    assert np.abs(live(one, other) - pictures[1]).max() <= 1
    assert np.abs(live(other, one) - pictures[0]).max() <= 1


def test_no_line_is_left_of_a_field_that_is_gone():
    known = {(place.__name__, name) for place, _, name in CASES}
    assert known >= set(WITHOUT)
    assert {field.name for field in dataclasses.fields(LightOptions)} == set(OPTIONS)
    for kind, values in PARTS.items():
        assert {field.name for field in dataclasses.fields(kind)} == set(values)


def test_each_format_has_a_file_that_is_read():
    """Of what meshio and rasterio read, some formats stand for all; some endings are aliases.

    No package of tests writes what cfgrib and h5py read.
    """
    known = {*writing.SUFFIXES, *reader.SOUPS, *reader.Y_UP, *brains.SURFACES} - {".vrml"}
    others = ("meshio", "rasterio", "cfgrib", "h5py")
    rows = [row for row in formats.TABLE if row.package not in others]
    known |= {suffix for row in rows if row.read or row.package for suffix in row.suffixes}
    text = "".join(path.read_text("utf-8") for path in Path(__file__).parent.rglob("*.py"))
    names = set(re.findall(r"\w(\.\w+(?:\.gz)?)\b", text))
    assert sorted(known - names - {".cdf", ".ent", ".sgy", ".vrml"}) == []
