"""Checks of the register of claims: functions of a generator that return what is found.

Each returns pairs of a stated and a found figure, of which none may be larger than the stated one.
"""

from itertools import pairwise

import numpy as np
import oracles
import pyvista as pv
from oracles import exact, mp

from studies import normals, sky
from vizlight import Bundle, Light, Scene, View, illuminate, streamlines
from vizlight.geometry import relief
from vizlight.geometry.lines.curves import polyline_tangents
from vizlight.geometry.nspace import manifolds
from vizlight.geometry.relief import height_field
from vizlight.mesh import georeference
from vizlight.model import formulas, highlights
from vizlight.observers.eye import Eye
from vizlight.vtk.corners import surface_normals

EPS = float(np.finfo(float).eps)
#: Functions of a generator by name.
CHECKS = {}


def case(check):
    """Add a check to the table."""
    CHECKS[check.__name__] = check
    return check


def exact_length(x, y, z, start, way):
    """Return the length of a ray below a bilinear field, and the number of crossings."""
    ends = [0.0, max((z.max() - start[2]) / way[2], 0.0)]
    for nodes, along, place in zip((x, y), way, start, strict=False):
        if along:
            ends += [s for s in (nodes - place) / along if 0 < s < ends[1]]
    place, steps = exact(start), exact(way)
    total, crossings = mp.mpf(0), 0
    for low, high in pairwise(map(exact, np.unique(ends))):
        middle = start + float(low + high) / 2 * way
        at = [int(np.clip(np.searchsorted(n, p, "right") - 1, 0, len(n) - 2))
              for n, p in zip((x, y), middle, strict=False)]  # fmt: skip

        def above(s, i=at[0], j=at[1]):
            p = [a + s * b for a, b in zip(place, steps, strict=True)]
            u, v = (
                (min(max(c, exact(n[0])), exact(n[-1])) - exact(n[k])) / exact(n[k + 1] - n[k])
                for c, n, k in zip(p, (x, y), (i, j), strict=False)
            )
            (a, b), (c, d) = exact(z[j : j + 2, i : i + 2])
            return a * (1 - u) * (1 - v) + b * u * (1 - v) + c * (1 - u) * v + d * u * v - p[2]

        # The parabola through the heights at both ends and midway.
        first, half, last = above(low), above((low + high) / 2), above(high)
        two, one = 2 * (first - 2 * half + last), 4 * half - 3 * first - last
        square, roots = one * one - 4 * two * first, []
        if abs(two) > mp.mpf(10) ** -30:
            roots = [(-one + e * mp.sqrt(square)) / (2 * two) for e in (-1, 1)] * (square > 0)
        elif one:
            roots = [-first / one]
        shares = sorted([mp.mpf(0), *(r for r in roots if 0 < r < 1), mp.mpf(1)])
        crossings += len(shares) - 2
        for a, b in pairwise(shares):
            at = (a + b) / 2
            total += (high - low) * (b - a) * (first + at * (one + at * two) > 0)
    return total, crossings


@case
def lengths_below_rough_fields(random):
    """Uneven nodes; and heights of integers with rays in the planes of the nodes."""
    found = []
    for whole in (False, True):
        widths = (10 ** random.uniform(-1.4, 1, n) for n in (9, 8))
        x, y = (np.arange(float(n.size)) if whole else np.cumsum(n) for n in widths)
        z = random.integers(0, 5, (8, 9)).astype(float) if whole else random.uniform(0, 4, (8, 9))
        scale = max(map(np.ptp, (x, y, z)))
        for azimuth in (0, 90, 180, 270) if whole else random.uniform(0, 360, 4):
            e, a = np.radians([random.uniform(10, 80), azimuth])
            way = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
            way[np.abs(way) < 1e-15] = 0
            way /= np.linalg.norm(way)
            starts = [random.choice(x, 8), random.choice(y, 8), random.uniform(-1, 4, 8)]
            starts = np.stack(starts, axis=1)
            lengths = relief.inside_length(x, y, z, starts, direction=way)
            for start, length in zip(starts, lengths, strict=True):
                true, crossings = exact_length(x, y, z, start, way)
                stated = 3 * EPS * scale * max(crossings, 1) + 4 * EPS * float(true)
                found.append((stated, float(abs(exact(length) - true))))
    return found


@case
def axes_of_an_eye(random):
    """Scalar products of the axes, which are 0 and 1; in half of them up is beside the view."""
    found = []
    for i, n in enumerate(np.repeat(range(3, 7), 15)):
        way = random.standard_normal(n)
        beside = way + 10 ** random.uniform(-5, 0) * random.standard_normal(n)
        rows = exact(View(direction=way, up=beside if i % 2 else None).axes())
        found += [
            (4 * EPS, float(abs(oracles.dot(one, other) - (one is other))))
            for one in rows
            for other in rows
        ]
    return found


def threshold_of_a_line(width):
    """Return the contrast at which a line of a degree is just seen, its width in arc minutes.

    The model of Watson and Ahumada (J. Vision 5, 2005) with its contrast sensitivity, aperture and
    Minkowski sum, without the oblique effect.
    """
    size, degree = 512, 200
    x = (np.arange(size) - size / 2) / degree
    frequency = np.hypot(*np.meshgrid(*[np.fft.fftfreq(size, 1 / degree)] * 2))
    low = 0.8493 / np.cosh(frequency / 1.3625)
    passed = 373.08 * (1 / np.cosh((frequency / 4.1726) ** 0.7786) - low)
    cover = np.clip((width / 120 - abs(x)) * degree + 0.5, 0, 1)
    line = np.outer(abs(x) <= 0.5, cover)
    seen = np.fft.ifft2(np.fft.fft2(line) * passed).real
    seen *= np.exp(-np.add.outer(x**2, x**2) / (2 * 0.6273**2))
    return ((abs(seen) ** 2.4081).sum() / degree**2) ** (-1 / 2.4081)


@case
def thin_lines_of_the_eye(random):
    """Contrast of lines of 1 and 4 pixels at 300 dpi in the eye, and their thresholds."""
    eye, left, thresholds = Eye.at(1004, 85.0, 400.0, 2.3), [], []
    for pixels in (1, 4):
        lines = np.zeros((8, 401, 3))
        lines[:, 200 - pixels // 2 : 200 - pixels // 2 + pixels] = 1.0
        left.append(eye.filtered(lines)[4, :, 0].max())
        thresholds.append(threshold_of_a_line(pixels * 60 / eye.pixels_per_degree))
    return [
        (0.01, float(abs(left[0] - 0.25))),
        (0.05, float(abs(left[1] / left[0] - 3.2))),
        (0.05, float(abs(thresholds[0] / thresholds[1] - 3.4))),
    ]


@case
def mean_errors_of_highlights(random):
    """By longitude about the axis across light and eye: what both reach is a lune."""
    nodes, weights = np.polynomial.legendre.leggauss(600)
    pairs = []
    for angle, r in zip(random.uniform(0.01, 2.96, 2), random.uniform(5, 60, 2), strict=True):
        light, eye = (np.array([s * np.sin(angle / 2), 0, np.cos(angle / 2)]) for s in (1, -1))
        t, phi = np.meshgrid(nodes * np.pi / 2, nodes * (np.pi - angle) / 2)
        normal = np.stack([np.cos(t) * np.sin(phi), np.sin(t), np.cos(t) * np.cos(phi)], axis=-1)
        mirror = np.maximum(2 * (normal @ light) * (normal @ eye) - light @ eye, 0) ** r
        off = 255 * (mirror - np.maximum(normal[..., 2], 0) ** (4 * r))
        area = np.outer(weights, weights) * np.cos(t)
        exact_rms = np.sqrt(np.sum(area * off**2) / np.sum(area))
        volume = np.sum(area * np.abs(off)) / np.sum(area)
        for by, true in (("rms", exact_rms), ("volume", volume)):
            pairs.append((1e-4, abs(highlights.sphere_error(angle, r, by=by) / true - 1)))
    return pairs


#: Largest mean errors of normals by corners, over those of VTK's and of those by the best of
#: four weights; area is exact on planes, and Max's weight on balls.
BESIDE = {
    "ellipsoid": (0.6, 1.05), "gyroid": (0.9, 1.05), "gyroid, voxels 3 times as long": (1.1, 1.05),
    "gyroid, voxels 5 times as long": (1.1, 1.05), "ellipsoid, voxels 3 times as long": (1.1, 1.05),
    "border of a gyroid": (1.1, 1.05), "gyroid, off by 1 % of a voxel": (1.6, 1.5),
    "gyroid, off by 5 % of an edge": (1.6, 3), "grid of triangles": (1.1, 1.5),
    "grid of quads": (0.9, 2.2), "steep grid of quads": (1.7, 10),
    "grid of quads sheared by 1": (1.1, 1.5), "grid of quads sheared by 3": (2.2, 1.05),
    "grid of triangles sheared by 2": (1.6, 2.2), "border of a grid sheared by 2": (1.6, 2.2),
    "steep grid of quads sheared by 2": (2.2, 2.2), "grid of obtuse triangles": (0.9, 2.2),
    "grid of long triangles": (0.9, 1.05), "grid of triangles, off by 5 % of an edge": (1.6, 1.5),
    "two slopes with a ridge": (1.6, 2.2), "planes with a rounded edge": (2.2,),
    "random points of the plane": (0.9, 1.5), "border of random points": (0.9, 1.5),
    "random points, off by 5 % of an edge": (1.6, 1.5), "ball of uneven steps": (0.9,),
    "ellipsoid 8 times as long, between meridians": (1.6, 1.5), "random points of a ball": (0.6,),
    "random points of an ellipsoid": (0.6, 1.5), "random points of a long ellipsoid": (1.6, 1.5),
}  # fmt: skip


@case
def normals_by_corners(random):
    """Mean errors on random surfaces of each kind, over those of other weights."""
    found = []
    for name, stated in BESIDE.items():
        mesh, true = normals.SURFACES[name](int(random.integers(20, 40)), random)
        error, *others = (
            normals.mean_angle(vectors, true)
            for vectors in (surface_normals(mesh), normals.by_vtk(mesh), *normals.by_weights(mesh))
        )
        found += zip(stated, (error / others[0], error / min(others[1:])), strict=False)
    return found


@case
def light_of_single_lines(random):
    """Straight lines of any length, diameter and number of points, under light of any direction."""
    found = []
    for near in 30 * [False] + 30 * [True]:
        way, light = random.normal(size=(2, 3))
        points = np.linspace(-0.5, 0.5, int(random.integers(2, 60)))[:, np.newaxis] * way
        length = np.linalg.norm(way)
        if near:
            # Beside the line, by 20 degrees from it or more.
            light -= (light @ way) * way / length**2 * random.uniform(0, 1)
            light *= length * random.uniform(1, 4) / np.linalg.norm(light)
            if abs(light @ way) > np.cos(np.radians(20)) * length * np.linalg.norm(light):
                continue
            lamp = Light(position=light)
        else:
            lamp = Light(direction=way if random.random() < 0.3 else light)
        bundle = Bundle(diameter=length * 10 ** random.uniform(-3, -1))
        lit = illuminate(pv.lines_from_points(points), Scene(lights=[lamp]), bundle=bundle)
        off = 1 - np.asarray(lit["transmittance"], float)
        found += [(0.06, off.max()), (0.02, off.mean())]
    return found


@case
def light_behind_ridges(random):
    """High walls on level ground, as wide as a ray needs to go on a way through them."""
    found = []
    for times, share in ((1, 1 / 2), (4, 1 / 5)):
        depth, altitude = random.uniform(0.5, 2), np.radians(random.uniform(15, 60))
        through = times * depth / np.sin(altitude)
        x = np.array([0, 10, 10 + 1e-6, 10 + 1e-6 + through * np.cos(altitude)])
        x = np.append(x, x[-1] + [1e-6, 9])
        z = np.tile([0, 0, 1e3, 1e3, 0, 0], (3, 1))
        t = relief.shadow(
            x, np.arange(3.0), z, depth=depth, direction=(np.cos(altitude), 0, np.sin(altitude))
        )
        found.append((0.01, abs(t[1, 0] / t[1, -1] - share)))
    return found


@case
def shadows_of_the_default_depth(random):
    """Share of shadow on rough terrain by the default depth over that of hard shadows."""
    found = []
    while len(found) < 6:
        z = sky.ground(64, 10 ** random.uniform(-1, 1), int(random.integers(1 << 30)))
        field = height_field.make(np.arange(64.0), np.arange(64.0), z, border="extend")
        a = random.uniform(0, 2 * np.pi)
        way = (np.cos(0.1745) * np.cos(a), np.cos(0.1745) * np.sin(a), np.sin(0.1745))
        hard, soft = (
            np.mean(relief.shadow(field.x, field.y, field.heights, depth=d, direction=way) < 0.0868)
            for d in (0, height_field.default_depth(field))
        )
        if 0.07 < hard < 0.8:
            found += [(1.15, soft / hard), (1 / 0.72, hard / soft)]
    return found


@case
def lengths_of_degrees(random):
    """Metres of a degree of latitude and longitude on the ellipsoid WGS 84."""
    degrees = random.uniform(-88.9, 88.9, 200)
    latitude, squared = np.radians(degrees), 6.69437999e-3
    flat = 1 - squared * np.sin(latitude) ** 2
    across, along = 6378137 / np.sqrt(flat), 6378137 * (1 - squared) / flat**1.5
    true = np.radians([across * np.cos(latitude), along])
    ours = georeference.METRES * np.array([georeference._parallel(degrees), np.ones(200)])
    return [(0.006, np.abs(ours / true - 1).max())]


@case
def exposed_light(random):
    """Light at 1 and below, less what it is without a knee."""
    light = random.uniform(0, 1, 500)
    bent = [x * formulas.exposed(x, 1.0) for x in light]
    return [(0.074, np.abs(bent - light).max()), (0.0005, abs(formulas.exposed(1.0, 1.0) - 0.926))]


@case
def faults_that_are_missed(random):
    """Probability that 3,000 random points miss a fault of 1 in 1,000."""
    return [(0.05, (1 - 1e-3) ** 3000)]


@case
def errors_of_differences(random):
    """Tangents of the graph of one period of a sine, of random phase, by central differences."""
    found = []
    for kind, stated in ((np.float64, 3e-10), (np.float32, 9e-4)):
        phase = kind(random.uniform(0, 6))

        def wave(u, phase=phase, kind=kind):
            return np.stack([u, np.sin(u + phase)]).astype(kind)

        made = manifolds.parametric(wave, [(0, 2 * np.pi)], 2, resolution=200, closed=False)
        slope = np.cos(np.asarray(made.points[:, 0], float) + float(phase))
        true = np.stack([np.ones_like(slope), slope], axis=1) / np.hypot(1, slope)[:, np.newaxis]
        found.append((stated, np.abs(np.asarray(made.frame[:, 0], float) - true).max()))
    return found


@case
def order_of_tangents(random):
    """Errors of tangents of a circle with uneven points, each half as far apart as before."""
    share = np.sort(random.uniform(0, 1, 40)) + np.arange(40)
    errors = []
    for n in (1, 2):
        at = np.interp(np.arange(40 * n) / n, np.arange(40), share) / 20
        exact_tangents = np.stack([-np.sin(at), np.cos(at)], axis=1)
        found = polyline_tangents(np.stack([np.cos(at), np.sin(at)], axis=1))
        errors.append(np.abs(found - exact_tangents).max())
    return [(errors[0] / 3, errors[1])]


@case
def pixel_errors_of_highlights(random):
    """The table of the pages, for Phong's power of 40."""
    angle = np.radians([30, 60, 90, 120])
    rows = {4.0: (6.0, 26.6, 63.8, 120.9), None: (3.9, 14.1, 33.0, 64.5)}
    found = []
    for factor, row in rows.items():
        by = highlights.simple_factor(angle) if factor is None else factor
        errors = np.abs(highlights.max_pixel_error(angle, 40, factor=by).error)
        found += [(0.06, abs(a - b)) for a, b in zip(errors, row, strict=True)]
    return found


@case
def roughness_of_highlights(random):
    """A lobe of GGX beside a power of the cosine: by the roughness of the page, and by another."""
    angle, q = np.linspace(0, np.pi / 2, 2000), float(np.exp(random.uniform(np.log(80), 7)))

    def differences(squared):
        lobe = (squared / (np.cos(angle) ** 2 * (squared - 1) + 1)) ** 2
        return np.abs(lobe - np.cos(angle) ** q).max()

    return [(0.07, differences(2.8 / q)), (0.17, differences(2 / (q + 2)))]


@case
def largest_gaps(random):
    """Evenly spaced lines of random waves, on a plane, on a ball and in a volume."""
    found = []
    volume = pv.ImageData(dimensions=(8, 8, 8), spacing=(1 / 7,) * 3)
    ball = pv.Sphere(radius=1, theta_resolution=30, phi_resolution=30)
    for mesh, spacing in ((pv.Plane().triangulate(), 0.1), (ball, 0.25), (volume, 0.25)):
        waves = random.uniform(1, 4, (2, 3, 3))
        mesh["V"] = np.sin(np.asarray(mesh.points) @ waves[0] + waves[1, 0])
        lines = streamlines(mesh, tangents="V", spacing=spacing)
        found.append((1.5, float(lines.field_data["largest_gap"][0])))
    return found
