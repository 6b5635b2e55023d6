"""The meter on meshes: laws, kinds of data, views, and input that does not fit."""

import dataclasses
import json

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals
from shapes import straws

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View
from vizlight.draw.backends import BackendError
from vizlight.draw.cameras import camera_on
from vizlight.observers import samples

pytestmark = pytest.mark.opengl

MATTE = Material(ambient=0.08, diffuse=0.9, specular=0)
FEW = {"samples": 512}
HEAD = Scene(lights=Light.headlight(), material=MATTE, view=View(direction=(0, 0, 1)))


def ring(turn=None, height=0.0, head=0.4, view=None):
    """Return three lamps of several hues about z, or a turned axis, and a white one along it."""
    turn = np.eye(3) if turn is None else turn
    lamps = []
    for k, color in enumerate([(0.53, 0.29, 0.37), (0.2, 0.45, 0.2), (0.27, 0.26, 0.43)]):
        a = np.radians(90 + 120 * k)
        lamps.append(Light(direction=turn @ [np.cos(a), np.sin(a), height], color=color))
    lamps.append(Light(direction=turn[:, 2], intensity=head))
    view = View(direction=turn[:, 2]) if view is None else view
    return Scene(lights=lamps, material=MATTE, view=view)


def bumps(dtype=np.float64, n=60):
    """Return a curved sheet with a swirl and heights."""
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    z = 0.2 * np.sin(3 * x) * np.cos(2 * y)
    mesh = pv.StructuredGrid(x, y, z).extract_surface(algorithm="dataset_surface").triangulate()
    mesh.points = mesh.points.astype(dtype)
    x, y, z = np.asarray(mesh.points, np.float64).T
    slopes = 0.6 * np.cos(3 * x) * np.cos(2 * y), -0.4 * np.sin(3 * x) * np.sin(2 * y)
    mesh["swirl"] = np.stack([-y, x, -y * slopes[0] + x * slopes[1]], axis=1).astype(dtype)
    mesh["height"] = z.astype(dtype)
    return mesh


def figures(found):
    """Return all figures that are numbers, by name."""
    return {
        f"{name}.{key}": value
        for name in ("direction", "slope", "shape", "value")
        if (part := getattr(found, name)) is not None
        for key, value in dataclasses.asdict(part).items()
        if key != "samples"
    }


def test_a_good_light_is_read_and_a_headlight_is_not():
    good = vizlight.legibility(bumps(), ring(), tangents="swirl")
    assert good.direction.within_10 > 0.97
    assert good.direction.legend_median < 6
    bad = vizlight.legibility(bumps(), HEAD, tangents="swirl")
    assert bad.direction.within_10 < 0.6
    assert bad.direction.legend_median > 35
    assert good.slope is None
    assert good.value is None


def test_lines_under_a_headlight_tell_their_slope():
    found = vizlight.legibility(straws(40, 8), HEAD)
    assert found.slope.spearman < -0.99
    assert found.slope.bits > 3
    assert found.slope.within_10 < 0.75  # which end is near is a coin
    assert found.direction is found.shape is found.value is None


def test_points_with_vectors_have_a_direction():
    points = np.random.default_rng(0).uniform(-1, 1, (400, 3))
    cloud = pv.PolyData(points)
    cloud["v"] = np.random.default_rng(1).normal(size=(400, 3)) * [1, 1, 0.2]
    found = vizlight.legibility(cloud, ring(), tangents="v")
    assert found.direction.within_10 > 0.9
    assert found.direction.legend_median < 6
    assert found.shape is found.slope is None


def test_two_tangents_have_a_shape_alone():
    mesh = bumps()
    first = np.add(mesh["swirl"], [1e-3, 0, 0])
    normals = np.asarray(mesh.compute_normals(cell_normals=False)["Normals"])
    mesh["frame"] = np.hstack([first, np.cross(normals, first)])
    found = vizlight.legibility(mesh, ring(height=1.0), tangents="frame", **FEW)
    assert found.direction is None
    assert found.shape.median < 25


def test_a_turned_scene_reads_the_same():
    turn = pv.transformations.axis_angle_rotation((1, 2, 3), 50)[:3, :3]
    mesh, turned = bumps(), bumps()
    turned.points = np.asarray(mesh.points) @ turn.T
    turned["swirl"] = np.asarray(mesh["swirl"]) @ turn.T
    how = {"tangents": "swirl", "scalars": "height", "cmap": "viridis"}
    one = vizlight.legibility(mesh, ring(), **how)
    camera = camera_on(turned, turn[:, 2], up=turn[:, 1], parallel=True)
    other = vizlight.legibility(turned, ring(turn), view=camera, **how)
    for name, value in figures(one).items():
        # A sample of 4,096 pixels of some 200,000.
        slack = 0.02 if "within" in name else 0.3 + 0.1 * value
        assert abs(figures(other)[name] - value) < slack, name


def test_a_seed_repeats_and_another_one_does_not():
    runs = [
        vizlight.legibility(bumps(), ring(), tangents="swirl", seed=seed, **FEW)
        for seed in (3, 3, 4)
    ]
    assert runs[0] == runs[1]
    assert runs[0].direction != runs[2].direction
    assert abs(runs[0].direction.median - runs[2].direction.median) < 0.5


def test_more_noise_is_read_worse():
    found = [
        vizlight.legibility(bumps(), ring(height=0.5), tangents="swirl", noise=noise, samples=1024)
        for noise in (0, 2 / 255, 8 / 255, 32 / 255)
    ]
    for name, sign in (("direction.bits", -1), ("shape.bits", -1), ("direction.median", 1)):
        values = [sign * figures(one)[name] for one in found]
        assert values == sorted(values), name
    assert found[0].direction.within_10 > 0.98


def test_the_type_of_the_data_does_not_matter():
    how = {"tangents": "swirl", "scalars": "height", **FEW}
    one = figures(vizlight.legibility(bumps(np.float32), ring(), **how))
    other = figures(vizlight.legibility(bumps(np.float64), ring(), **how))
    for name, value in one.items():
        assert other[name] == pytest.approx(value, rel=0.03, abs=0.05), name


@pytest.mark.parametrize(
    "scene",
    [
        ring(view=View(position=(0, 0, 4))),
        ring(view=View(position=(0, 0, 4), direction=(0, 0, 1))),
        ring().replace(view=None),
        ring().replace(depth_cue=DepthCue(back_scale=0.5)),
        ring().replace(lights=[*ring().lights, Light(position=(0, 0, 3), intensity=0.2)]),
    ],
    ids=["perspective", "axis", "none", "cue", "near"],
)
def test_views_and_lamps(scene):
    found = vizlight.legibility(bumps(), scene, tangents="swirl", scalars="height", **FEW)
    assert found.direction.within_10 > 0.9
    assert found.shape.samples >= 64
    assert all(np.isfinite(value) for value in figures(found).values())


def test_a_camera_sees_what_it_shows():
    mesh = bumps()
    camera = camera_on(mesh, (0, 0, 1))
    camera.view_angle = 2
    near = vizlight.legibility(mesh, ring(), view=camera, tangents="swirl", **FEW)
    assert near.pixels == 512 * 512
    assert camera.view_angle == 2


def test_blocks_are_read_together():
    both = pv.MultiBlock({"sheet": bumps(), "lines": straws(40, 8), "none": None})
    found = vizlight.legibility(both, ring(height=1.0))
    assert found.slope is not None
    assert found.shape is not None
    assert found.slope.samples + found.shape.samples <= 4096


def test_light_inside_a_bundle_is_that_of_the_mesh():
    lines = straws()
    lit = vizlight.illuminate(lines, HEAD, bundle=vizlight.Bundle(depth=4.0))
    alone, inside = (vizlight.legibility(mesh, HEAD).slope for mesh in (lines, lit))
    assert 0 < inside.bits < alone.bits - 0.5
    assert abs(inside.spearman) < abs(alone.spearman) - 0.03
    with pytest.raises(ValueError, match="one column for each of the 4 lights"):
        vizlight.legibility(lit, ring())


def test_without_opengl_points_that_face_the_eye_are_read(monkeypatch):
    ball = pv.Icosphere(nsub=5)
    ball["v"] = np.cross([0.2, 0, 1.0], ball.points)
    how = {"tangents": "v", "scalars": np.asarray(ball.points)[:, 0]}
    drawn = vizlight.legibility(ball, ring(height=1.0), **how)

    def none():
        raise BackendError("no picture")

    monkeypatch.setattr(samples, "choose_backend", none)
    found = vizlight.legibility(ball, ring(height=1.0), **how)
    assert drawn.drawn
    assert not found.drawn
    assert "no picture was drawn" in str(found)
    assert found.direction.samples <= 4096
    assert abs(found.direction.within_10 - drawn.direction.within_10) < 0.03
    assert abs(found.shape.median - drawn.shape.median) < 5
    assert found.value.p95 == pytest.approx(drawn.value.p95, abs=0.05)


def test_values_are_read_off_the_bar():
    mesh = bumps()
    flat = HEAD.replace(material=Material(ambient=1, diffuse=0, specular=0))
    unlit = vizlight.legibility(mesh, flat, scalars="height", cmap="viridis").value
    # Half a step, and one more where bytes of the map repeat.
    assert unlit.p95 < 0.5 / 256
    assert unlit.largest < 1.51 / 256
    side = Scene(lights=Light(direction=(1, 0, 0.3)), material=MATTE, view=flat.view)
    dim = vizlight.legibility(mesh, side, scalars="height", cmap="viridis").value
    assert dim.p95 > 5 * unlit.p95
    assert dim.p95_chromaticity < dim.p95
    gray = vizlight.legibility(mesh, flat, scalars="height", cmap="gray", clim=(-1, 1)).value
    assert gray.median_chromaticity > 0.1


def test_records_print_and_become_dicts():
    found = vizlight.legibility(bumps(), ring(), tangents="swirl", scalars="height", **FEW)
    text = str(found)
    assert "within 10 degrees" in text
    assert "upper bound" in text
    assert f"{found.direction.within_10:.1%}" in text
    assert found._repr_html_().count("<tr>") == text.splitlines().index(
        next(line for line in text.splitlines() if "visible pixels" in line)
    )
    assert json.loads(json.dumps(found.to_dict()))["direction"]["samples"] == 512
    with pytest.raises(dataclasses.FrozenInstanceError):
        found.seed = 1


def test_what_has_no_answer_is_noted():
    mesh = bumps()
    mesh["zero"] = np.zeros((mesh.n_points, 3))
    found = vizlight.legibility(mesh, ring(), tangents="zero", **FEW)
    assert found.direction is None
    assert "512 of 512 places have zero tangents" in found.notes[0]
    mesh["one"] = np.full(mesh.n_points, 3.0)
    found = vizlight.legibility(mesh, ring(), scalars="one", **FEW)
    assert found.value is None
    assert found.notes == ("value: the scalars are constant, 3, and have one colour",)
    found = vizlight.legibility(mesh, ring(), scalars="height", cmap=["red"], **FEW)
    assert found.notes == ("value: the colour map has one colour",)
    found = vizlight.legibility(mesh, ring().replace(lights=[]), scalars="height", **FEW)
    assert found.shape is None
    assert found.value is not None
    assert found.notes == ("the scene has no lamp: light tells no direction, slope or shape",)
    mesh["part"] = np.where(mesh.points[:, 0] > 0, np.nan, mesh["height"])
    found = vizlight.legibility(mesh, ring(), scalars="part", **FEW)
    assert 200 < found.value.samples < 300
    assert "places have no value" in found.notes[0]


def bad_input(change):
    how = {"mesh": bumps(), "scene": ring(), **FEW} | change
    mesh, scene = how.pop("mesh"), how.pop("scene")
    vizlight.legibility(mesh, scene, **how)


test_bad_input = refusals(
    bad_input,
    ({"scene": None}, "scene: expected a vizlight.Scene", TypeError),
    ({"scene": Scene(view=View(direction=(1, 0, 0, 0)))}, "project the mesh"),
    ({"mesh": 3}, "mesh: expected a PyVista mesh", TypeError),
    ({"mesh": pv.PolyData()}, "expected a mesh with points"),
    ({"tangents": "none"}, "tangents: expected the name of a point array"),
    ({"tangents": np.zeros((3600, 8))}, "tangents: expected a point array of 3"),
    ({"conditioned": "frame"}, "conditioned: expected True or False", TypeError),
    ({"conditioned": True}, "conditioned: expected tangents"),
    ({"cmap": "viridis"}, "cmap: expected scalars= beside it"),
    ({"clim": (0, 1)}, "clim: expected scalars= beside it"),
    ({"scalars": "none"}, "scalars: expected a point array"),
    ({"noise": -1}, "noise: expected a number from 0 to 1"),
    ({"noise": np.nan}, "noise: expected"),
    ({"samples": 0}, "samples: expected an integer of at least 1"),
    ({"seed": 0.5}, "seed: expected an integer", TypeError),
    ({"view": "top"}, "view: expected a vizlight.View", TypeError),
    ({"view": View(direction=(1, 1))}, "view: expected vectors of 3 components"),
    ({"view": View(position=(0, 0, 9), direction=(0, 0, -1))}, "the eye sees"),
    ({"model": "gouraud"}, "model: expected"),
)
