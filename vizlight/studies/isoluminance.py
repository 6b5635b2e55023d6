"""Isoluminance contours against Gouraud-shaded facets and a ray cast: seconds, vertices, error.

The study draws a sphere and a cone in the sizes of the source's
tables and compares each pixel with the exact luminance there, and says how far the approximate
highlights are from the exact ones.
"""

from __future__ import annotations

import functools
import math
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv
from scipy import ndimage

from vizlight.filters.isoluminance import isoluminance
from vizlight.geometry.contours.isoluminance import virtual_light
from vizlight.geometry.solids.exact_surfaces import fibonacci
from vizlight.geometry.solids.primitives import Frustum, Sphere
from vizlight.pictures import render
from vizlight.scene import Light, Material, Scene
from vizlight.studies._framework import CLEAR, Curve, Panel, Row, Study, cheapest, words
from vizlight.studies._measuring import take_turns

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array

#: Pixels that the shape covers, as in the source's tables, and the facets of its comparison.
SIZES = (550, 4500, 9000, 55_000, 250_000)
FACETS = {"sphere": 70, "cone": 15}
#: A pixel has 256 steps: less cannot be told apart.
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
    """One way to make one picture: what it costs, and how far it is from the exact one."""

    shape: str
    way: str
    pixels: int
    vertices: int
    model: float
    draw: float
    largest: float
    mean: float


def lambert(normals: Array) -> Array:
    """Return the exact luminance."""
    return LOW + SCALE * np.maximum(normals @ TOWARD, 0)


def cast(shape: str, camera: Any, side: int) -> Array:
    """Return the exact luminance at the middle of each pixel, NaN beside the shape."""
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
    # The cone: |across| = radius at its height, or the plane of its foot.
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


def facets(shape: str, count: int) -> Any:
    """Return a mesh of about so many facets (of the cone's side) with the exact luminance."""
    if shape == "sphere":
        rings = max(round(math.sqrt(count / 2)), 3)
        mesh: Any = pv.Sphere(radius=1, theta_resolution=2 * rings, phi_resolution=rings + 1)
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


def contours(shape: str, levels: Any) -> pv.PolyData:
    """Return the bands, one value a polygon."""
    bands: pv.PolyData = isoluminance(SHAPES[shape], SCENE, levels=levels)["bands"]
    return bands


def picture(mesh: Any, camera: Any, side: int, repeats: int) -> tuple[float, Array]:
    """Return the seconds of a frame after the first, and the luminance of its pixels."""
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
    """Return the largest and the mean error, two pixels within the outline and beyond."""
    inside = ndimage.binary_erosion(np.isfinite(exact), iterations=2)
    miss = np.abs(pixels - exact)[inside]
    return float(miss.max()), float(miss.mean())


def measure(shape: str, area: int, levels: int = 200, repeats: int = 3) -> list[Picture]:
    """Return the rows of one picture: contours, facets, facets of equal error, ray cast."""
    camera = render.camera_on(
        (-1, 1, -1, 1, -1, 1), EYE.tolist(), parallel=True, zoom=math.sqrt(3) / 1.02
    )
    # A first picture says which share of the pixels the shape covers.
    share = np.isfinite(cast(shape, camera, 64)).mean()
    side = max(round(math.sqrt(area / share)), 16)
    exact = cast(shape, camera, side)

    def row(way: str, make: Callable[[], Any]) -> Picture:
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
    """The vertices that contours and Gouraud-shaded facets need for one worst error."""

    shape: str
    error: float
    contours: int
    facets: int


def count(shape: str, worst: float) -> Count:
    """Return the vertices needed, facets by growing them until no place misses by more."""
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


@dataclass(frozen=True)
class Highlight:
    """How far the virtual light's highlight is from the exact one, on a sphere of radius 1."""

    distance: float
    angle: float
    half: float
    mirror: float
    shift: float


def highlight(distance: float, angle: float, power: float = 20.0) -> Highlight:
    """Return the errors of the virtual light.

    Parameters
    ----------
    distance : float
        Of the light from the centre, in radii; infinite for one far away.
    angle : float
        Between light and eye, in degrees, seen from the centre; the eye is far away.
    power : float
        Shininess of ``R . E``; ``N . H`` has 4 times as much (Fisher-Woo).

    Returns
    -------
    Highlight
        ``half`` and ``mirror``: the largest difference to ``(N . H)^(4 s)`` and ``(R . E)^s``
        with the light where it stands. ``shift``: by how many degrees the true peak lies nearer
        to the light than the virtual light's. The source has it nearer to the eye; that is so
        for a near eye, not for a near light.
    """
    eye = np.array([0.0, 0.0, 1.0])
    light = np.array([math.sin(math.radians(angle)), 0.0, math.cos(math.radians(angle))])
    toward = virtual_light((0, 0, 0), light=light, eye=eye)
    normal = fibonacci(200_000)
    wi = np.broadcast_to(light, normal.shape)
    if math.isfinite(distance):
        wi = distance * light - normal
        wi = wi / np.linalg.norm(wi, axis=1, keepdims=True)
    cosine = np.einsum("ij,ij->i", normal, wi)
    seen = (cosine > 0) & (normal[:, 2] > 0)
    half = wi + eye
    half = half / np.linalg.norm(half, axis=1, keepdims=True)
    blinn = np.maximum(np.einsum("ij,ij->i", normal, half), 0)
    phong = np.maximum(2 * cosine * normal[:, 2] - wi[:, 2], 0)
    drawn = np.maximum(normal @ toward, 0) ** (4 * power)
    # The peak: a bisection in the plane of light and eye, where N is half way.
    low, high = 0.0, math.radians(angle)
    for _ in range(60):
        middle = (low + high) / 2
        n = np.array([math.sin(middle), 0.0, math.cos(middle)])
        ray = light if math.isinf(distance) else distance * light - n
        to_light = math.atan2(ray[0], ray[2]) - middle
        low, high = (middle, high) if to_light > middle else (low, middle)
    return Highlight(
        distance,
        angle,
        float(np.abs(drawn - blinn ** (4 * power))[seen].max()),
        float(np.abs(drawn - phong**power)[seen].max()),
        math.degrees(low) - angle / 2,
    )


def vertices(shape: str, worst: float) -> list[Row]:
    """Return how many vertices both ways need for one worst error."""
    found = count(shape, worst)
    return [
        Row(f"{shape}, contours", worst, worst, found.contours),
        Row(f"{shape}, facets", worst, worst, found.facets),
    ]


def pictures(shape: str, area: int, levels: int, repeats: int) -> list[Row]:
    """Return the ways to make one picture, with their times."""
    rows = []
    for made in measure(shape, area, levels, repeats):
        more: dict[str, float | str] = {
            "ms to model": 1e3 * made.model,
            "ms a frame": 1e3 * made.draw,
            "mean error": made.mean,
        }
        way = f"picture of a {shape}, {made.way}"
        rows.append(Row(way, area, made.largest, made.vertices or math.nan, more))
    return rows


def virtual(angle: float) -> list[Row]:
    """Return how far the virtual light's highlight is off, by the distance of the light."""
    rows = []
    for distance in (1.5, 2, 4, 8, 16, 64, math.inf):
        h = highlight(distance, angle)
        more: dict[str, float | str] = {"error of N.H": h.half, "degrees off the peak": h.shift}
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
    """Return what needs the fewest vertices for an error, and what makes a picture fastest."""
    fewest: dict[str, list[str]] = {}
    by_time = []
    for shape in SHAPES:
        drawn, flat = (
            {row.parameter: row.cost for row in rows if row.way == f"{shape}, {way}"}
            for way in ("contours", "facets")
        )
        for worst, few in drawn.items():
            many = flat[worst]
            way = "contours" if few <= CLEAR * many else "either way"
            way = "facets" if many <= CLEAR * few else way
            fewest.setdefault(way, []).append(
                f"a {shape} at an error of {worst:g} ({words(few)}, facets {words(many)})"
            )
        start = f"picture of a {shape}, "
        made = [
            row._replace(way=row.way.removeprefix(start).replace(", equal", " of equal error"))
            for row in rows
            if row.way.startswith(start)
        ]
        made = [row for row in made if row.parameter == max(float(r.parameter) for r in made)]
        if not made:
            continue
        bands = next(row for row in made if row.way.endswith("levels"))
        # What cannot be told apart in a picture counts as equal.
        good = [row._replace(cost=_milliseconds(row)) for row in made]
        best = cheapest(good, max(bands.error, FAINT))
        assert best is not None
        by_time.append(
            f"{best.way} for a {shape} of {words(float(best.parameter))} "
            f"pixels ({words(best.cost)} ms, "
            + ", ".join(f"{row.way} {words(row.cost)}" for row in good if row is not best)
            + ")"
        )
    said = "; ".join(f"{way} for {', '.join(where)}" for way, where in fewest.items())
    said = f"for few vertices take {said}"
    return f"{said}; for the time of a picture as good {', '.join(by_time)}" if by_time else said


def _milliseconds(row: Row) -> float:
    return float(row.more["ms to model"]) + float(row.more["ms a frame"])


def curve_of_vertices(row: Row) -> Curve | None:
    """Return the curve of vertices for an error: a colour a shape."""
    shape, _, way = row.way.partition(", ")
    return Curve(shape, way) if shape in SHAPES else None


def curve_of_pictures(row: Row) -> Curve | None:
    """Return the curve of pictures, whatever the number of facets of equal ones."""
    if not row.way.startswith("picture of a "):
        return None
    shape, way = row.way.removeprefix("picture of a ").split(", ", 1)
    return Curve(shape, "facets of equal error" if way.endswith("equal") else way)


def curve_of_highlights(row: Row) -> Curve | None:
    """Return the curve of a virtual light."""
    return Curve(row.way) if row.way.startswith("virtual") else None


STUDY = Study(
    approximates="a lit sphere and cone by contours of equal luminance",
    reference="the exact luminance, by a ray cast; Gouraud-shaded facets beside it",
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
