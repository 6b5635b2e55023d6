"""Contours of equal luminance, Gouraud's shading and rays, by the area of the image.

The two graphs of Conway and Cottingham: a sphere and a cone with the highlight cos^8 about a
virtual light, at 200 intensities; and the sphere in the diffuse light of a segment, of which the
source says that it costs more. Contours are laminae that Pillow fills in the painter's order;
facets are 72 triangles of the sphere and 15 of the cone's side, their light interpolated between
corners; rays meet the exact surface once per pixel. All run on the processor, and the time is that
of model and picture. The error is the root mean square over the pixels that both cover, in pixel
values, from the rays.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pyvista as pv
from PIL import Image, ImageDraw

import vizlight
from studies import Curve, Row, Study, _laminae, take_turns
from vizlight import Light, Material, Scene

POWER, LEVELS = 8.0, 200
LAMP = np.array([0.48, 0.64, 0.6])
#: Axes of the picture, and the way to the eye.
RIGHT, UP, EYE = np.eye(3)
#: Axis of the cone from its base to its apex, its height and the radius of its base.
AXIS, HEIGHT, RADIUS = np.array([0.6, 0.64, 0.48]), 1.6, 0.8
AMBIENT = 0.1
#: Ends of the linear light, and its name.
ENDS, LINEAR = np.array([[-1.0, 0.5, 2.0], [2.0, 2.0, 1.0]]), "sphere by a linear light"


def light(normals):
    """Return the luminance of unit normals."""
    return AMBIENT + (1 - AMBIENT) * np.maximum(normals @ LAMP, 0) ** POWER


def linear(places):
    """Return the diffuse luminance of places on the unit sphere, by the integral in closed form.

    The cosine is linear along the segment, over the distance: the part above the horizon ends where
    it is 0.
    """
    start, end = ENDS
    length = np.linalg.norm(end - start)
    way = (end - start) / length
    # Cosines times distances at both ends; on the unit sphere the normal is the place.
    low, high = ((places * (tip - places)).sum(axis=-1) for tip in ENDS)
    cut = length * low / np.where(low == high, 1, low - high)
    first = np.where(low < 0, cut, 0)
    last = np.where(high < 0, cut, length)
    nearest = (places - start) @ way
    foot = start + nearest[..., np.newaxis] * way - places
    off = np.linalg.norm(foot, axis=-1)
    across, along = (places * foot).sum(axis=-1), places @ way

    def integral(s):
        return across * np.arcsinh((s - nearest) / off) + along * np.hypot(s - nearest, off)

    mean = (integral(last) - integral(first)) / length
    return AMBIENT + (1 - AMBIENT) * np.where(np.maximum(low, high) > 0, mean, 0)


def law(shape):
    """Return the light of a shape as a function of its unit normals."""
    return linear if shape == LINEAR else light


def laminae(shape):
    """Return the laminae of a shape."""
    options = {
        "direction": LAMP, "power": POWER, "ambient": AMBIENT, "diffuse": 1 - AMBIENT,
        "levels": LEVELS,
    }  # fmt: skip
    if shape == "sphere":
        return _laminae.sphere((0, 0, 0), 1.0, **options)
    return _laminae.truncus((0, 0, 0), AXIS, (0.0, RADIUS), height=HEIGHT, **options)


def composite():
    """Return the polygons of the bands of the linear light that face the eye, and their values."""
    matt = Material(ambient=AMBIENT, diffuse=1 - AMBIENT, specular=0)
    scene = Scene(lights=Light.linear(*ENDS), material=matt)
    bands = vizlight.isoluminance(vizlight.Sphere(), scene, levels=LEVELS)["bands"]
    values, offsets = bands["luminance"], bands.GetPolys().GetOffsetsArray()
    ends = pv.convert_array(offsets)
    corners = bands.points[pv.convert_array(bands.GetPolys().GetConnectivityArray())]
    seen = np.add.reduceat(corners[:, 2], ends[:-1]) > 0
    return corners, ends, values, np.flatnonzero(seen)


def contours(shape, side):
    """Return the picture of laminae, -1 where there is none."""
    if shape == LINEAR:
        points, offsets, values, order = composite()
    else:
        parts = laminae(shape)
        points, offsets, values = np.asarray(parts.points), parts.offsets, parts.values
        order = parts.order(EYE)
    places = (points[:, :2] * [1, -1] + 1) * (side / 2)
    grey = np.rint(255 * np.asarray(values)).astype(int)
    picture = Image.new("I", (side, side), -1)
    draw = ImageDraw.Draw(picture)
    for i in order:
        corners = places[offsets[i] : offsets[i + 1]]
        draw.polygon([*map(tuple, corners)], fill=int(grey[i]))
    return np.asarray(picture)


def pixels(side):
    """Return x and y of the centres of pixels, from -1 to 1."""
    at = (np.arange(side) + 0.5) * (2 / side) - 1
    return np.meshgrid(at, -at)


def rays(shape, side):
    """Return the picture of the exact surface, -1 where there is none."""
    x, y = pixels(side)
    if shape != "cone":
        depth = 1 - x * x - y * y
        normals = np.stack([x, y, np.sqrt(np.maximum(depth, 0))], axis=-1)
        return np.where(depth > 0, np.rint(255 * law(shape)(normals)), -1)
    start = np.stack([x, y, 0 * x], axis=-1) - AXIS * HEIGHT / 2  # from the apex
    slope = 1 + (RADIUS / HEIGHT) ** 2
    along, tilt = start @ AXIS, float(EYE @ AXIS)
    a = 1 - slope * tilt**2
    b = start @ EYE - slope * along * tilt
    c = np.sum(start * start, axis=-1) - slope * along**2
    with np.errstate(invalid="ignore"):
        depth = (-b + np.sqrt(b * b - a * c)) / a
    down = along + depth * tilt
    places = start + depth[..., np.newaxis] * EYE
    across = places - down[..., np.newaxis] * AXIS
    radial = across / np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1e-12)
    normals = (HEIGHT * radial + RADIUS * AXIS) / np.hypot(HEIGHT, RADIUS)
    # The base faces away from this eye.
    return np.where((down <= 0) & (down >= -HEIGHT), np.rint(255 * light(normals)), -1)


def facets(shape):
    """Return the corners of triangles that face the eye, and normals there."""
    if shape != "cone":
        polar, turn = np.linspace(0, np.pi, 5), np.linspace(0, 2 * np.pi, 13)
        p, t = np.meshgrid(polar, turn, indexing="ij")
        corners = np.stack([np.sin(p) * np.cos(t), np.cos(p), np.sin(p) * np.sin(t)], axis=-1)
        normals = corners
    else:
        turn = np.linspace(0, 2 * np.pi, 16)
        first = np.cross(AXIS, EYE) / np.linalg.norm(np.cross(AXIS, EYE))
        ring = np.outer(np.cos(turn), first) + np.outer(np.sin(turn), np.cross(AXIS, first))
        normals = (HEIGHT * ring + RADIUS * AXIS) / np.hypot(HEIGHT, RADIUS)
        corners = np.stack([0 * ring + AXIS * HEIGHT / 2, RADIUS * ring - AXIS * HEIGHT / 2])
        normals = np.stack([normals, normals])
    quads = [
        np.stack([v[:-1, :-1], v[1:, :-1], v[1:, 1:], v[:-1, 1:]], axis=2).reshape(-1, 4, 3)
        for v in (corners, normals)
    ]
    triangles, own = (np.concatenate([q[:, [0, 1, 2]], q[:, [0, 2, 3]]]) for q in quads)
    faces = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    outward = np.einsum("ij,ij->i", faces, own.mean(axis=1))
    return triangles[outward * faces[:, 2] > 1e-12], own[outward * faces[:, 2] > 1e-12]


def gouraud(shape, side):
    """Return the picture of facets, -1 where there is none."""
    x, y = pixels(side)
    picture = np.full((side, side), -1.0)
    for corners, normals in zip(*facets(shape), strict=True):
        grey = law(shape)(normals)
        low = np.floor((np.array([corners[:, 0].min(), -corners[:, 1].max()]) + 1) * side / 2)
        high = np.ceil((np.array([corners[:, 0].max(), -corners[:, 1].min()]) + 1) * side / 2)
        box = np.s_[max(int(low[1]), 0) : int(high[1]) + 1, max(int(low[0]), 0) : int(high[0]) + 1]
        (ax, ay), (bx, by), (cx, cy) = corners[:, :2]
        size = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        u = ((x[box] - ax) * (cy - ay) - (cx - ax) * (y[box] - ay)) / size
        v = ((bx - ax) * (y[box] - ay) - (x[box] - ax) * (by - ay)) / size
        inside = (u >= 0) & (v >= 0) & (u + v <= 1)
        value = np.rint(255 * (grey[0] * (1 - u - v) + grey[1] * u + grey[2] * v))
        picture[box] = np.where(inside, value, picture[box])
    return picture


WAYS = {"contours": contours, "Gouraud": gouraud, "rays": rays}


def measure(shape, side, repeats):
    """Return a row for each way, by the number of pixels that the shape covers."""
    works = {name: partial(way, shape, side) for name, way in WAYS.items()}
    pictures = {name: work() for name, work in works.items()}
    seconds, exact = take_turns(works, repeats), pictures["rays"]
    area = int(np.count_nonzero(exact >= 0))
    rows = []
    for name, picture in pictures.items():
        both = (picture >= 0) & (exact >= 0)
        error = float(np.sqrt(np.mean((picture - exact)[both].astype(float) ** 2)))
        covered = {"covered": np.count_nonzero(both) / area}
        rows.append(Row(f"{name}, {shape}", area, error, 1e9 * seconds[name] / area, covered))
    return rows


STUDY = Study(
    approximates="pictures of spheres and of a cone by contours and by facets",
    reference="rays to the exact surface",
    parameter="area, pixels",
    error="RMS error in pixel values",
    cost="processor time, ns per pixel",
    axes=("parameter", "cost"),
    steps=lambda quick: [
        partial(measure, shape, side, 3)
        for shape in ("sphere", "cone", LINEAR)
        for side in ((28, 108, 268) if quick else (28, 76, 108, 268, 564, 1200))
    ],
    curve=lambda row: Curve(*row.way.split(", ")),
)
