"""The pictures that matter, each small, compared with one that was looked at.

Two comparisons: pytest-pyvista's, which also finds pictures that no test draws any more, and
:mod:`vizlight.draw.testing`'s, which is the strict one: its limits let edges be drawn
otherwise, and not light 5 % too bright. A scene with limits of its own says why.
"""

from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from lamps import SHINY, far
from shapes import clifford_torus

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, render, testing
from vizlight.geometry import manifolds
from vizlight.model import highlights

pytestmark = pytest.mark.opengl

HERE = Path(__file__).parent
SIZE = (300, 220)

CROSSED = ["streamlines", "fibres", "depth_cue", "exact_line_light"]
#: Limits beside the defaults, with the reason.
LIMITS = {
    # Thousands of lines of a pixel or less: other anti-aliasing dims them all.
    "fur": {"brightness": 0.04, "pixels": 0.1},
    # Lines in front of one another: which is nearer can change at a crossing.
    **{name: {"block": 7.0, "pixels": 0.06} for name in CROSSED},
}


def ball(**options):
    """Return a sphere with exact normals, so that no triangle is seen."""
    mesh = pv.Sphere(radius=1, theta_resolution=72, phi_resolution=72, **options)
    mesh["Normals"] = np.array(mesh.points)
    mesh.point_data.active_normals_name = "Normals"
    return mesh


def plot(panels, camera, **options):
    options = {"size": SIZE, "anti_aliasing": "ssaa", **options}
    return render.make_plotter(panels, camera=camera, **options)


def grid(lit, columns, light="auto", **options):
    block = pv.MultiBlock()
    for i, mesh in enumerate(lit):
        block.append(mesh.translate((2.2 * (i % columns), -2.2 * (i // columns), 0)))
    camera = render.camera_on(block.bounds, (0, 0, 1), parallel=True, zoom=1.3)
    return plot(render.Panel(block, **options), camera, background="#203040", light=light)


def ambient():
    """The grid of the lecture: ka across, Ia down."""
    lit = [
        vizlight.illuminate(
            ball(),
            Scene(
                lights=Light(direction=(-0.7, 0.8, 0.9), intensity=0.6),
                view=View(direction=(0, 0, 1)),
                ambient_intensity=around,
                material=Material(ambient=ka, diffuse=0.6, specular=0.5, color=(0.9, 0.12, 0.1)),
            ),
        )
        for around in (0.3, 1.0)
        for ka in (0.0, 0.4, 0.8)
    ]
    return grid(lit, 3, scalars="rgb")


def highlights_of_two_laws():
    """Fisher and Woo's figure 2, in part: R.E, and N.H to 4 and 4 cos(beta) times the power."""
    lit = []
    for model, rule in (("phong", None), ("blinn", 4.0), ("blinn", "rule")):
        for degrees in (0, 90, 135):
            angle = np.deg2rad(degrees)
            factor = float(highlights.simple_factor(angle)) if rule == "rule" else rule or 1.0
            scene = far(
                (-np.sin(angle), 0, np.cos(angle)),
                (0, 0, 1),
                Material(ambient=0.1, diffuse=0, specular=0.9, shininess=8 * factor),
            )
            lit.append(vizlight.illuminate(ball(), scene, model=model))
    # In fragments the highlight of Blinn's model ends sharply where the light does.
    return grid(lit, 3, light="points")


def flow_lines(**options):
    flow = vizlight.load_example()
    camera = render.camera_on(flow.bounds, (1, 0.5, 0.55), zoom=1.1)
    light, material = options.pop("light", (1, 0.9, 0.5)), options.pop("material", SHINY)
    scene = far(light, camera, material).replace(depth_cue=options.pop("depth_cue", None))
    seeds = flow.points[:: flow.n_points // 60]
    return vizlight.streamlines(flow, scene, tangents="V", seeds=seeds, **options), camera


def streamlines():
    return plot(*flow_lines(), line_width=0.9)


def depth_cue():
    both = [flow_lines(depth_cue=DepthCue(smooth=smooth))[0] for smooth in (False, True)]
    return plot(both, flow_lines()[1], line_width=0.9)


def exact_line_light():
    """With light from behind, where a cylinder shows its highlight's ends and its dark side."""
    sheen = Material(ambient=0, diffuse=0.5, specular=1.0, shininess=3)
    behind = {"model": "cylinder", "light": (-0.6, 1, 0.3)}
    panels = [flow_lines(**behind)[0], flow_lines(**behind, material=sheen)[0]]
    return plot(panels, flow_lines()[1], line_width=0.9)


def confined_streamlines():
    flow = vizlight.load_example()
    surface = flow.contour([400], scalars="Temp")
    camera = render.camera_on(flow.bounds, (1, 0.5, 0.3), zoom=1.9)
    scene = far((1, 0.9, 0.5), camera)
    lines = vizlight.streamlines(
        flow, scene, tangents="V", surface=surface, confined=True, seeds=80, max_length=20
    )
    return plot(lines, camera, line_width=0.9)


def fibres():
    bundle = vizlight.load_example("fibre_bundle.vtp")
    camera = render.camera_on(bundle.bounds, (0.3, -1, 0.4), zoom=1.5)
    lit = vizlight.illuminate(bundle, far((-0.5, -1, 1), camera))
    return plot(lit, camera, line_width=0.9)


def satin():
    """Banks' illustration 2, C and D, with white highlights."""
    mesh = ball(start_phi=1, end_phi=179)
    normals = np.asarray(mesh.points)
    mesh["satin"] = np.array([0, 0, 1], dtype=np.float32) - normals[:, 2:] * normals
    camera = render.camera_on(mesh.bounds, (0.2, -1, 0.35))
    scene = far((1, -1, 0.8), camera)
    lit = [
        vizlight.illuminate(mesh, scene, tangents="satin", conditioned=conditioned)
        for conditioned in (False, True)
    ]
    return plot(lit, camera)


def fur():
    mesh = ball()
    camera = render.camera_on(mesh.bounds, (0.2, -1, 0.35))
    scene = far((1, -1, 0.8), camera, Material(ambient=0.05, diffuse=1.0, specular=0.6))
    # Few fibres, and black behind: the base of each is seen, where the fur takes most.
    coat = vizlight.fur(mesh, scene, density=0.7, fibres=8_000, length=0.3, exponent=1)
    return plot(coat, camera, background="black", line_width=0.45)


def turning():
    """A torus of 4-space turning: lit before and after the projection."""
    torus = vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=96))
    camera = render.camera_on((-3, 3, -2, 2, -1, 1), (0.3, -1, 0.8), zoom=1.4)
    four = far((0.2, -0.8, 0.9, 0.3), (0.3, -1, 0.8, 0))
    three = far((0.2, -0.8, 0.9), camera)
    panels = [
        vizlight.project(torus, rotation=("xw", a), distance=3.0, scene=scene, light=light)
        for light, scene in (("before", four), ("after", three))
        for a in (0.0, 1.0)
    ]
    return plot(panels, camera, rows=2, background="#203048")


def complex_curve():
    def place(x, y):
        w = (x + 1j * y) ** 3 / 3 - (x + 1j * y) / 2
        return x, y, w.real, w.imag

    curve = manifolds.parametric(place, [(-1, 1)] * 2, 4, resolution=120, closed=False)
    scene = far((-0.4, -0.9, 0.9, 0.4), (0.5, -1, 0.7, 0))
    lit = vizlight.manifold(curve, scene=scene, rotation=("xw", 1.0))
    camera = render.camera_on(lit.bounds, (0.5, -1, 0.7), zoom=1.0)
    return plot(lit, camera, background="#203048")


def field_in_4_space():
    torus = vizlight.manifold(clifford_torus(128), rotation=("xw", 0.15), distance=1.6)
    frame = np.asarray(torus["frame"]).reshape(-1, 2, 4)
    torus["field"] = frame[:, 0] + frame[:, 1]
    scene = far((0.5, -0.7, 0.6, 0.2), (0.3, -1, 0.8, 0))
    lit = [
        vizlight.illuminate(
            torus, scene, positions="position", tangents="field", conditioned=conditioned
        )
        for conditioned in (False, "frame")
    ]
    camera = render.camera_on(torus.bounds, (0.3, -1, 0.8), zoom=0.95)
    return plot(lit, camera, background="#203048")


def terrain():
    """Cos-theta shadows of mountains at two heights of the sun, and through a deep ground."""
    earth = vizlight.load_example("earth_relief.vti")
    part = earth.extract_subset((750, 850, 340, 390, 0, 0))
    land = pv.ImageData(dimensions=part.dimensions, spacing=(32.1, 37.1, 1.0))
    land["height"] = np.array(part["elevation"], dtype=float) / 100
    panels = []
    for height, depth in ((15, 20.0), (45, 20.0), (15, 200.0)):
        e = np.radians(height)
        toward = (-np.cos(e) / 2**0.5, np.cos(e) / 2**0.5, np.sin(e))
        scene = Scene(lights=Light(direction=toward), material=Material(specular=0))
        lit = vizlight.relief_shadow(land, scene, depth=depth, elevation="height")
        panels.append(render.Panel(lit, "t"))
    camera = render.camera_on(land.bounds, (0, 0, 1), parallel=True, zoom=1.9)
    return plot(panels, camera, size=(600, 110))


def seeping_light():
    ant = pv.examples.load_ant().compute_normals(split_vertices=False)
    camera = render.camera_on(ant.bounds, (0.5, 1.0, 0.35), zoom=1.4)
    scene = Scene(
        lights=Light(direction=(-0.9, -0.8, 0.45)), material=Material(ambient=0.03, diffuse=0.97)
    )
    lit = vizlight.relief_shadow(ant, scene, depth=0.004 * ant.length)
    return plot(render.Panel(lit, "t"), camera, background="#101418")


SCENES = [
    ambient, highlights_of_two_laws, streamlines, depth_cue, exact_line_light,
    confined_streamlines, fibres, satin, fur, turning, complex_curve, field_in_4_space, terrain,
    seeping_light,
]  # fmt: skip

#: Scenes of several panels, whose edges VTK before 9.7 does not smooth as it does those of one.
PANELS = [depth_cue, exact_line_light, satin, terrain]


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.__name__)
def test_scene(scene, verify_image_cache, request):
    name = scene.__name__
    if scene in PANELS and pv.vtk_version_info < (9, 7):
        pytest.skip("VTK before 9.7 does not smooth several panels")
    # The comparison above is the strict one; this one is to tell a picture from another, and only
    # thousands of thin lines, drawn by another driver, come to more than its default.
    verify_image_cache.error_value = verify_image_cache.warning_value = 2000.0
    verify_image_cache.test_name = f"test_scene_{name}"
    cached = HERE / "image_cache" / f"scene_{name}.png"
    plotter = scene()
    if cached.exists() and not request.config.getoption("reset_image_cache"):
        testing.assert_same_picture(
            plotter, cached, failed=HERE.parent / "failed_images", **LIMITS.get(name, {})
        )
    plotter.show()


def test_there_are_few_pictures():
    assert len(list((HERE / "image_cache").glob("*.png"))) <= 40
