"""Isoluminance contours compared with Gouraud-shaded facets and ray casting.

The study draws a sphere and a cone in the sizes of the source's tables, and measures the time, the
number of vertices, and the error of each pixel. It also measures the error of highlights that are
drawn by a virtual light.
"""

from __future__ import annotations

import functools
import math
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv
from scipy import ndimage

from studies import CLEAR, Curve, Panel, Row, Study, cheapest, take_turns, words
from studies._virtual_light import highlight
from vizlight.filters.isoluminance import isoluminance
from vizlight.geometry.solids.primitives import Frustum, Sphere
from vizlight.pictures import render
from vizlight.scene import Light, Material, Scene

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array

#: Numbers of pixels that the shape covers, and numbers of facets, as in the source's tables.
SIZES = (550, 4500, 9000, 55_000, 250_000)
FACETS = {"sphere": 70, "cone": 15}
#: Error below which pictures of 256 grey levels are taken as equal.
FAINT = 1.5 / 255
TOWARD = np.array([1.0, -0.8, 0.9]) / math.sqrt(2.45)
EYE = np.array([0.3, -1.0, 0.4]) / math.sqrt(1.25)
LOW, SCALE = 0.1, 0.9
SCENE = Scene(
    lights=Light(direction=TOWARD), material=Material(ambient=LOW, diffuse=SCALE, specular=0)
)
SHAPES = {"sphere": Sphere(), "cone": Frustum((0, 0, 0), (0, 0, 1.6), (0.0, 0.8))}


@dataclass(frozen=True)
class Picture:
    """Cost and error of one picture drawn by one method; times are in seconds."""

    shape: str
    way: str
    pixels: int
    vertices: int
    model: float
    draw: float
    largest: float
    mean: float


def lambert(normals: Array) -> Array:
    """Return the exact luminance for unit normals."""
    return LOW + SCALE * np.maximum(normals @ TOWARD, 0)


def cast(shape: str, camera: pv.Camera, side: int) -> Array:
    """Return the exact luminance at the centre of each pixel, NaN outside the shape."""
    up = np.array(camera.up) - np.dot(camera.up, EYE) * EYE
    up /= np.linalg.norm(up)
    step = (np.arange(side) + 0.5) / side * 2 - 1
    u, v = np.meshgrid(step * camera.parallel_scale, -step * camera.parallel_scale)
    foot = np.array(camera.focal_point) + u[..., None] * np.cross(up, EYE) + v[..., None] * up
    if shape == "sphere":
        along = np.einsum("ijk,k->ij", foot, EYE)
        rest = 1 - np.einsum("ijk,ijk->ij", foot, foot) + along**2
        lift = np.sqrt(np.where(rest >= 0, rest, np.nan)) - along
        return lambert(foot + lift[..., None] * EYE)
    # A ray meets the cone where the distance from the axis is the radius at that height.
    k, top = 0.5, 0.8
    d = top - foot[..., 2]
    a = EYE[0] ** 2 + EYE[1] ** 2 - (k * EYE[2]) ** 2
    b = foot[..., 0] * EYE[0] + foot[..., 1] * EYE[1] + k * k * d * EYE[2]
    c = foot[..., 0] ** 2 + foot[..., 1] ** 2 - (k * d) ** 2
    root = b * b - a * c
    lift = (-b + np.sqrt(np.where(root >= 0, root, np.nan))) / a
    hit = foot + lift[..., None] * EYE
    on = (hit[..., 2] <= top) & (hit[..., 2] >= -top)
    across = hit * [1, 1, 0]
    across /= np.sqrt(np.einsum("ijk,ijk->ij", across, across))[..., None]
    normal = (across + np.array([0, 0, k])) / math.hypot(1, k)
    return np.where(on, lambert(normal), np.nan)


def facets(shape: str, count: int) -> pv.PolyData:
    """Return a mesh of about ``count`` facets with the exact luminance at its vertices.

    The facets of a cone are those of its side.
    """
    if shape == "sphere":
        rings = max(round(math.sqrt(count / 2)), 3)
        mesh: pv.PolyData = pv.Sphere(
            radius=1, theta_resolution=2 * rings, phi_resolution=rings + 1
        )
        mesh["luminance"] = lambert(np.asarray(mesh.points, dtype=np.float64))
        return mesh
    angle = 2 * np.pi * np.arange(count) / count
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    normal = (ring + np.array([0, 0, 0.5])) / math.hypot(1, 0.5)
    points = np.concatenate([0 * ring + [0, 0, 0.8], 0.8 * ring - [0, 0, 0.8]])
    i = np.arange(count)
    faces = np.stack([i, i + count, (i + 1) % count + count], axis=1)
    mesh = pv.PolyData.from_regular_faces(points, faces.tolist())
    mesh["luminance"] = np.tile(lambert(normal), 2)
    return mesh


def contours(shape: str, levels: float) -> pv.PolyData:
    """Return the bands between contours, for a number of levels or a largest error."""
    bands = isoluminance(SHAPES[shape], SCENE, levels=levels)["bands"]
    assert isinstance(bands, pv.PolyData)
    return bands


def picture(mesh: pv.PolyData, camera: pv.Camera, side: int, repeats: int) -> tuple[float, Array]:
    """Return the seconds per frame after the first, and the luminance of the pixels."""
    plotter = render.make_plotter(
        mesh, camera=camera, size=(side, side), anti_aliasing=None, background="black"
    )
    try:
        plotter.show(auto_close=False)
        pixels = np.asarray(plotter.screenshot(return_img=True), dtype=np.float64)[..., 0] / 255

        def frame() -> None:
            plotter.camera.azimuth += 0.01
            plotter.render()

        return take_turns({"frame": frame}, repeats)["frame"], pixels
    finally:
        plotter.close()


def error(pixels: Array, exact: Array) -> tuple[float, float]:
    """Return the largest and the mean error of pixels at least two pixels inside the outline."""
    inside = ndimage.binary_erosion(np.isfinite(exact), iterations=2)
    errors = np.abs(pixels - exact)[inside]
    return float(errors.max()), float(errors.mean())


def measure(shape: str, area: int, levels: int = 200, repeats: int = 3) -> list[Picture]:
    """Return the pictures of one size: contours, facets, facets of equal error, ray casting."""
    camera = render.camera_on(
        (-1, 1, -1, 1, -1, 1), EYE.tolist(), parallel=True, zoom=math.sqrt(3) / 1.02
    )
    # A small picture shows which fraction of the pixels the shape covers.
    share = np.isfinite(cast(shape, camera, 64)).mean()
    side = max(round(math.sqrt(area / share)), 16)
    exact = cast(shape, camera, side)

    def row(way: str, make: Callable[[], pv.PolyData]) -> Picture:
        mesh = make()
        model = take_turns({"model": make}, repeats)["model"]
        draw, pixels = picture(mesh, camera, side, repeats)
        return Picture(shape, way, area, mesh.n_points, model, draw, *error(pixels, exact))

    rows = [row(f"{levels} levels", functools.partial(contours, shape, levels))]
    number = FACETS[shape]
    rows.append(row(f"{number} facets", functools.partial(facets, shape, number)))
    wanted = max(rows[0].largest, FAINT)
    while rows[-1].largest > wanted and number < 400_000:
        number = math.ceil(number * 1.6)
        fine = row(f"{number} facets, equal", functools.partial(facets, shape, number))
        rows[2:] = [fine]
    start = time.perf_counter()
    cast(shape, camera, side)
    rows.append(Picture(shape, "ray cast", area, 0, time.perf_counter() - start, 0.0, 0.0, 0.0))
    return rows


@dataclass(frozen=True)
class Count:
    """Numbers of vertices that contours and Gouraud-shaded facets need for one largest error."""

    shape: str
    error: float
    contours: int
    facets: int


def count(shape: str, worst: float) -> Count:
    """Return the numbers of vertices for one largest error; facets are added until it is met."""
    weights = np.random.default_rng(1990).dirichlet([1, 1, 1], 24)
    number = FACETS[shape]
    while True:
        mesh = facets(shape, number)
        corners = mesh.regular_faces
        points = np.asarray(mesh.points, dtype=np.float64)[corners]
        places = np.einsum("ni,tij->ntj", weights, points).reshape(-1, 3)
        shown = np.einsum("ni,ti->nt", weights, mesh["luminance"][corners]).ravel()
        across = places * np.array([1, 1, 0 if shape == "cone" else 1])
        normal = across / np.linalg.norm(across, axis=1, keepdims=True)
        if shape == "cone":
            normal = (normal + np.array([0, 0, 0.5])) / math.hypot(1, 0.5)
        if np.abs(shown - lambert(normal)).max() <= worst:
            return Count(shape, worst, contours(shape, worst).n_points, mesh.n_points)
        number = math.ceil(number * 1.25)


def vertices(shape: str, worst: float) -> list[Row]:
    """Return the rows of the numbers of vertices for one largest error."""
    found = count(shape, worst)
    return [
        Row(f"{shape}, contours", worst, worst, found.contours),
        Row(f"{shape}, facets", worst, worst, found.facets),
    ]


def pictures(shape: str, area: int, levels: int, repeats: int) -> list[Row]:
    """Return one row for each method of drawing one picture."""
    rows = []
    for made in measure(shape, area, levels, repeats):
        more = {
            "ms to model": 1e3 * made.model,
            "ms per frame": 1e3 * made.draw,
            "mean error": made.mean,
        }
        way = f"picture of a {shape}, {made.way}"
        rows.append(Row(way, area, made.largest, made.vertices or math.nan, more))
    return rows


def virtual(angle: float) -> list[Row]:
    """Return the errors of the highlight of a virtual light, one row for each distance."""
    rows = []
    for distance in (1.5, 2, 4, 8, 16, 64, math.inf):
        h = highlight(distance, angle)
        more = {"error of N.H": h.half, "displacement of the peak, degrees": h.shift}
        rows.append(Row(f"virtual light, {angle:g} degrees", distance, h.mirror, math.nan, more))
    return rows


def steps(quick: bool) -> list[Callable[[], list[Row]]]:
    """Return the steps: vertices for an error, pictures, the virtual light."""
    errors = (0.05, 0.02) if quick else (0.05, 0.02, 0.01, 0.005)
    sizes = SIZES[:2] if quick else SIZES
    levels, repeats = (50, 3) if quick else (200, 3)
    return [
        *(functools.partial(vertices, shape, worst) for shape in SHAPES for worst in errors),
        *(functools.partial(pictures, s, area, levels, repeats) for s in SHAPES for area in sizes),
        *(functools.partial(virtual, angle) for angle in (30.0, 90.0)),
    ]


def verdict(rows: Sequence[Row]) -> str:
    """Return which method needs the fewest vertices, and which draws a picture fastest."""
    fastest = list(filter(None, (_fastest(rows, shape) for shape in SHAPES)))
    time = f"; for the fastest picture of that quality use {', '.join(fastest)}" if fastest else ""
    return f"for few vertices use {_fewest(rows)}{time}"


def _fewest(rows: Sequence[Row]) -> str:
    """Return which method needs the fewest vertices for each shape and error."""
    fewest: dict[str, list[str]] = {}
    for shape in SHAPES:
        drawn, flat = (
            {row.parameter: row.cost for row in rows if row.way == f"{shape}, {way}"}
            for way in ("contours", "facets")
        )
        for worst, few in drawn.items():
            many = flat[worst]
            way = "contours" if few <= CLEAR * many else "either method"
            way = "facets" if many <= CLEAR * few else way
            fewest.setdefault(way, []).append(
                f"a {shape} at an error of {worst:g} (contours {words(few)}, facets {words(many)})"
            )
    return "; ".join(f"{way} for {', '.join(where)}" for way, where in fewest.items())


def _fastest(rows: Sequence[Row], shape: str) -> str:
    """Return which method draws the largest picture of a shape fastest, or an empty string."""
    start = f"picture of a {shape}, "
    made = [
        row._replace(
            way=row.way.removeprefix(start).replace(", equal", " of equal error"),
            cost=float(row.more["ms to model"]) + float(row.more["ms per frame"]),
        )
        for row in rows
        if row.way.startswith(start)
    ]
    made = [row for row in made if row.parameter == max(float(r.parameter) for r in made)]
    if not made:
        return ""
    bands = next(row for row in made if row.way.endswith("levels"))
    best = cheapest(made, max(bands.error, FAINT))
    assert best is not None
    others = ", ".join(f"{row.way} {words(row.cost)}" for row in made if row is not best)
    return (
        f"{best.way} for a {shape} of {words(float(best.parameter))} pixels "
        f"({words(best.cost)} ms, {others})"
    )


def curve_of_vertices(row: Row) -> Curve | None:
    """Return the curve of the vertices for an error, one colour for each shape."""
    shape, _, way = row.way.partition(", ")
    return Curve(shape, way) if shape in SHAPES else None


def curve_of_pictures(row: Row) -> Curve | None:
    """Return the curve of a picture; facets of equal error share one, whatever their number."""
    if not row.way.startswith("picture of a "):
        return None
    shape, way = row.way.removeprefix("picture of a ").split(", ", 1)
    return Curve(shape, "facets of equal error" if way.endswith("equal") else way)


def curve_of_highlights(row: Row) -> Curve | None:
    """Return the curve of a virtual light."""
    return Curve(row.way) if row.way.startswith("virtual") else None


STUDY = Study(
    approximates="lit sphere and cone by contours of equal luminance",
    reference="the exact luminance by ray casting; for comparison, Gouraud-shaded facets",
    parameter="allowed error, pixels, or distance of the light in radii",
    error="largest error of luminance",
    cost="vertices",
    steps=steps,
    verdict=verdict,
    curve=curve_of_vertices,
    beside=(
        Panel(axes=("parameter", "error"), curve=curve_of_pictures, x="pixels of the shape"),
        Panel(
            axes=("parameter", "error"), curve=curve_of_highlights, x="distance of the light, radii"
        ),
    ),
)
