"""The checks of shapes for the stability suite: manifolds in n-space, contours of solids."""

import itertools
from functools import partial

import numpy as np
import oracles

from stability.checks import DOUBLE, Check, exactly, off, refused, timed
from studies import _shapes as manifolds
from vizlight.geometry.contours import isoluminance

#: Largest number of shapes that share the inputs of a check, and least number of inputs of one.
SHAPES, INPUTS = 8, 60


def _radii(random, count):
    """Return radii of all sizes."""
    return np.asarray(10 ** random.uniform(-100, 100, 1) * 10 ** random.uniform(-3, 3, count))


def _far(value, true):
    """Return the largest difference of components."""
    return max(abs(oracles.exact(float(a)) - b) for a, b in zip(value, true, strict=True))


def _outside(rows, space):
    """Return the most that orthonormal rows are outside a space, or less than unit."""
    worst = oracles.mp.mpf(0)
    frame = oracles.orthonormal(space)
    for row in oracles.exact(rows):
        rest = oracles.digits.across(row, frame)
        worst = max(worst, rest, abs(oracles.dot(row, row) - 1) / 2)
    return worst


def torus(_, count, random):
    """Points, of the largest radius, and tangents, of tori of 1, 2 and 3 circles."""
    mp, shapes = oracles.mp, min(max(count // INPUTS, 1), SHAPES)
    for k in (1, 2, 3):
        errors = []
        for _i in range(shapes):
            side = max(round((count / (3 * shapes)) ** (1 / k)), 3)
            shape = [int(n) for n in side + random.integers(0, 5, k)]
            radii = _radii(random, k)
            made = timed(manifolds.torus, *radii, resolution=shape)
            turns = [[2 * mp.pi * i / n for i in range(n)] for n in shape]
            circle = [[(mp.cos(t), mp.sin(t)) for t in turn] for turn in turns]
            top = oracles.exact(max(radii))
            rows = zip(made.points, made.frame, itertools.product(*circle), strict=True)
            for point, frame, pairs in rows:
                sized = zip(oracles.exact(radii), pairs, strict=True)
                worst = _far(point / float(top), [r * c / top for r, pair in sized for c in pair])
                for j, (c, s) in enumerate(pairs):
                    way = [mp.mpf(0)] * (2 * k)
                    way[2 * j : 2 * j + 2] = [-s, c]
                    worst = max(worst, _far(frame[j], way))
                errors.append(worst)
        yield off(f"{k} circles", errors, 8.0)
    yield refused("radius 0", partial(manifolds.torus, 1.0, 0.0), "radii[1]")


def torus_curve(_, count, random):
    """Points, of the larger radius, and tangents, over 8 and the largest angle."""
    mp = oracles.mp
    kinds = (
        ("closed", 1.5, None), ("closed", 3.0, None), ("closed", 7 / 5, None),
        ("open", np.sqrt(2), 3), ("open", 1 / 3 + 1e-6, 40), ("many turns", np.pi, 1000),
    )  # fmt: skip
    for case, ratio, turns in kinds:
        r1, r2 = _radii(random, 2)
        many = max(count // len(kinds), 3)
        made = timed(manifolds.torus_curve, ratio, r1=r1, r2=r2, turns=turns, resolution=many)
        a, errors = oracles.exact(ratio), []
        if turns is None:
            turns = {1.5: 2, 3.0: 1, 7 / 5: 5}[ratio]
            a = mp.mpf(round(turns * ratio)) / turns
        steps = many if case == "closed" else many - 1
        sizes = oracles.exact([r1, r2])
        top = max(sizes)
        for i, (point, frame) in enumerate(zip(made.points, made.frame, strict=True)):
            t = 2 * mp.pi * turns * i / steps
            turned = [f(x) for x in (t, a * t) for f in (mp.cos, mp.sin)]
            scales = (sizes[0], sizes[0], sizes[1], sizes[1])
            place = [s / top * c for s, c in zip(scales, turned, strict=True)]
            rates = (-1, 1, -a, a)
            swapped = (turned[1], turned[0], turned[3], turned[2])
            way = oracles.unit(
                [q * s / top * c for q, s, c in zip(rates, scales, swapped, strict=True)]
            )
            errors.append(max(_far(point / float(top), place), _far(frame[0], way)))
        claim = 8 + 4 * np.pi * turns * max(1.0, float(a))
        regime = "many turns" if case == "many turns" else ""
        yield off(case, errors, claim, regime)


def hopf_fibres(_, count, random):
    """Points, of the radius, and tangents; fibres over both poles and beside them."""
    mp, each = oracles.mp, 7
    for case in ("random", "near the poles", "at the poles"):
        base = random.standard_normal((max(count // (3 * each), 2), 3))
        if case == "near the poles":
            base[:, :2] *= 10 ** random.uniform(-17, -1, (len(base), 1))
        if case == "at the poles":
            base[:, :2] = 0
        radius = float(_radii(random, 1)[0])
        made = timed(manifolds.hopf_fibres, base, radius=radius, resolution=each)
        errors = []
        for i, (point, frame) in enumerate(zip(made.points, made.frame, strict=True)):
            x, y, z = oracles.unit(oracles.exact(base[i // each]))
            across = mp.sqrt(x * x + y * y)
            z1 = mp.sqrt((1 + z) / 2)
            z2 = mp.sqrt((1 - z) / 2) * (mp.mpc(x, -y) / across if across else 1)
            turn = mp.expj(2 * mp.pi * (i % each) / each)
            place = [f for w in (turn * z1, turn * z2) for f in (w.real, w.imag)]
            way = [f for w in (1j * turn * z1, 1j * turn * z2) for f in (w.real, w.imag)]
            errors.append(max(_far(point / radius, place), _far(frame[0], way)))
        yield off(case, errors, 8.0)


def klein_bottle(_, count, random):
    """Points, of the major radius, and the space of the frame, over R / (R - r)."""
    mp, shapes = oracles.mp, min(max(count // INPUTS, 1), SHAPES)
    for case, low, high in (("R/(R - r) to 10", -1.0, 0.0), ("R near r", -9.0, -3.0)):
        points, spaces, claim = [], [], []
        for _i in range(shapes):
            major = float(_radii(random, 1)[0])
            gap = 10 ** random.uniform(low, high)
            minor = min(major * (1 - gap) + major * 1e-4 * (gap > 0.9999), np.nextafter(major, 0))
            side = max(round((count / (2 * shapes)) ** 0.5), 3)
            shape = (side + int(random.integers(0, 5)), side)
            work = partial(manifolds.klein_bottle, major=major, minor=minor, resolution=shape)
            made = timed(work)
            r = oracles.exact(minor) / oracles.exact(major)
            rows = zip(made.points, made.frame, itertools.product(*map(range, shape)), strict=True)
            for point, frame, (i, j) in rows:
                u, v = 2 * mp.pi * i / shape[0], 2 * mp.pi * j / shape[1]
                cu, su, cv, sv = mp.cos(u), mp.sin(u), mp.cos(v), mp.sin(v)
                ch, sh, ring = mp.cos(u / 2), mp.sin(u / 2), 1 + r * cv
                place = [ring * cu, ring * su, r * sv * ch, r * sv * sh]
                along = [-ring * su, ring * cu, -r * sv * sh / 2, r * sv * ch / 2]
                across = [-sv * cu, -sv * su, cv * ch, cv * sh]
                points.append(_far(point / major, place))
                spaces.append(_outside(frame, [along, across]))
                claim.append(float(12 / (1 - r)))
        yield off(case, points, 12.0, "points")
        yield off(case, spaces, np.array(claim), "frame")
    same = refused("R = r", partial(manifolds.klein_bottle, major=1.0, minor=1.0), "minor")
    yield same._replace(regime="points")


def _lattice(corners, size):
    """Return unit vectors through lattice points of a cube's skin, in 50 digits, by the points."""
    mp = oracles.mp
    tangent = {c: mp.tan(mp.pi / 4 * c / size) for c in range(-size, size + 1)}
    return {corner: oracles.unit([tangent[c] for c in corner]) for corner in corners}


def _skin(n, size):
    """Return the lattice points of a cube's skin: ``size`` cells of 2 along an edge."""
    line = range(-size, size + 1, 2)
    return [p for p in itertools.product(line, repeat=n) if max(map(abs, p)) == size]


def _matched(points, true):
    """Return for each point which of the true ones is nearest."""
    from scipy.spatial import cKDTree

    tree = cKDTree(np.array([[float(c) for c in place] for place in true]))
    return np.asarray(tree.query(points)[1]).tolist()


def veronese(_, count, random):
    """Points, of the square of the radius, and the space of the frame."""
    for share in (0.4, 0.7):
        size = max(round((share * count / 3) ** 0.5), 2)
        radius = float(10 ** random.uniform(-70, 70))
        made = timed(manifolds.veronese, radius=radius, resolution=size)
        spheres = list(_lattice(_skin(3, size), size).values())
        images = [[x * y, x * z, y * z, (x * x - y * y) / 2] for x, y, z in spheres]
        errors = []
        near = _matched(made.points / radius**2, images)
        square = oracles.exact(radius) ** 2
        for point, frame, i in zip(made.points, made.frame, near, strict=True):
            x, y, z = spheres[i]
            slope = [[y, x, 0], [z, 0, x], [0, z, y], [x, -y, 0]]
            lengths = [abs(c) for c in (x, y, z)]
            axis = [oracles.mp.mpf(j == lengths.index(min(lengths))) for j in range(3)]
            _, *flat = oracles.orthonormal([[x, y, z], axis, _cross([x, y, z], axis)])
            space = [[oracles.dot(row, t) for row in slope] for t in flat]
            worst = max(
                abs(oracles.exact(a) / square - b) for a, b in zip(point, images[i], strict=True)
            )
            errors.append(max(worst, _outside(frame, space)))
        yield off(f"{size} cells along an edge", errors, 12.0)


def _cross(a, b):
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def sphere3(_, count, random):
    """Points, of the radius, and frames: i, j and k times the point as a quaternion."""
    for share in (0.3, 0.7):
        size = max(round((share * count / 8) ** (1 / 3)), 1)
        radius = float(_radii(random, 1)[0])
        made = timed(manifolds.sphere3, radius=radius, resolution=size)
        places = list(_lattice(_skin(4, size), size).values())
        errors = []
        near = _matched(made.points / radius, places)
        for point, frame, at in zip(made.points, made.frame, near, strict=True):
            x, y, z, w = places[at]
            rows = ([w, -z, y, -x], [z, w, -x, -y], [-y, x, w, -z])
            worst = _far(point / radius, places[at])
            errors.append(max(worst, *(_far(f, row) for f, row in zip(frame, rows, strict=True))))
        yield off(f"{size} cells along an edge", errors, 4.0)


def complex_curve(_, count, random):
    """Slopes without a derivative, over what is claimed of Cauchy's integral, and with one."""
    mp = oracles.mp
    h = float(np.finfo(float).eps) ** 0.2 * 2
    cases = (
        ("exp", np.exp, mp.exp, mp.exp),
        ("cubic", lambda z: z**3 - z, lambda z: z**3 - z, lambda z: 3 * z * z - 1),
        ("pole at 2", lambda z: 1 / (z - 2), lambda z: 1 / (z - 2), lambda z: -1 / (z - 2) ** 2),
        ("1e6 high", lambda z: z * z + 1e6, lambda z: z * z + 10**6, lambda z: 2 * z),
    )
    side = max(round((count / len(cases)) ** 0.5), 4)
    del random
    for case, function, exact, slope in cases:
        made = timed(manifolds.complex_curve, function, resolution=side)
        errors, claim = [], []
        for (x, y, *_w), frame in zip(made.points, made.frame, strict=True):
            z = mp.mpc(float(x), float(y))
            first = oracles.exact(frame[0])
            found = mp.mpc(first[2], first[3]) / first[0]
            errors.append(abs(found - slope(z)))
            size = float(abs(exact(z)) + abs(z * slope(z)))
            # The ninth coefficient of the series: 1/9! of exp, of the pole 1 over its distance.
            ninth = {"exp": float(abs(mp.exp(z))) / 362880, "pole at 2": float(abs(z - 2)) ** -10}
            cut = h**8 * ninth.get(case, 0.0)
            claim.append(cut / np.finfo(float).eps + size / h + 4 * float(abs(slope(z))))
        yield off(case, errors, np.array(claim))


def sphere(_, count, random):
    """Luminance at a contour's points less its level, of the range, the points as they are."""
    yield from _contours(count, random, _sphere_of)
    none = isoluminance.sphere((0, 0, 0), 0.0, direction=(0, 0, 1))
    yield exactly("radius 0", [none.points.size, none.lines.size, len(none.band)], [0, 0, 0])
    for case, place in (("light on the surface", 1.0), ("light inside", 0.5)):
        dark = isoluminance.sphere((0, 0, 0), 1.0, position=(0, 0, place), ambient=0.25)
        yield exactly(case, np.unique(dark.values), [0.25])


def _contours(count, random, make):
    """Check the contours of both kinds of light and of some powers."""
    kinds = [(p, near) for near in ("", "near", "close") for p in (1.0, 3.0, 50.0, 0.5, 1e4)]
    for power, near in kinds:
        errors = []
        claim = []
        many = max(count // len(kinds), 4)
        while len(errors) < many:
            offs, claims = make(random, power, near, many)
            if not offs:
                break
            errors += offs
            claim += claims
        if errors:
            case = f"light {near or 'at infinity'}, power {power:g}"
            regime = "power < 1" if power < 1 else "light close" if near == "close" else ""
            yield off(case, errors, np.array(claim), regime)


def _sphere_of(random, power, near, many):
    mp = oracles.mp
    radius = float(10 ** random.uniform(-3, 3))
    way = random.standard_normal(3)
    way /= np.linalg.norm(way)
    gap = {"": 1.0, "near": random.uniform(0.5, 3), "close": 10 ** random.uniform(-5, -1)}[near]
    place = radius * (1 + gap) * way
    where = {"position": tuple(place)} if near else {"direction": tuple(way)}
    low, scale = random.uniform(0, 1), random.uniform(0.1, 2)
    segments = max(min(many // 60, 60), 3)
    work = partial(
        isoluminance.sphere, (0.0, 0.0, 0.0), radius, ambient=low, diffuse=scale, power=power,
        levels=8, segments=segments, **where,
    )  # fmt: skip
    made = timed(work)
    span = oracles.exact(float(made.steps.edges[-1] - made.steps.edges[0]))
    errors, claim = [], []
    toward, light = oracles.unit(oracles.exact(way)), oracles.exact(place)
    for (i, _), level in zip(made.lines, made.line_levels, strict=True):
        point = oracles.exact(made.points[i])
        if near:
            toward = oracles.unit([a - b for a, b in zip(light, point, strict=True)])
        cosine = max(oracles.dot(oracles.unit(point), toward), mp.mpf(0))
        lit = oracles.exact(low) + oracles.exact(scale) * cosine ** oracles.exact(power)
        errors.append((lit - oracles.exact(level)) / span)
        claim.append(_law(power, 16.0, 2 * max(power, 1.0) ** 0.5 / gap if near else 0.0))
    return errors, claim


def _law(power, rounding, turned):
    """Return the claim for a law of a power, in eps: also of what turns normal or light."""
    eps = float(np.finfo(float).eps)
    if power < 1:
        return float(((rounding + turned) * eps) ** power) / eps
    return rounding + 4 * power + turned


def truncus(_, count, random):
    """Luminance at rulings less their level, of ``diffuse``, the points as they are."""
    shapes = ("frustum", "cone, R1 = 0", "cone, R2 = 0", "cylinder, R1 = R2", "thin")
    for case in shapes:
        for power in (1.0, 3.0, 50.0, 0.5, 1e4):
            errors = []
            claim = []
            tries = 0
            while len(errors) < count // (len(shapes) * 5) and tries < 400:
                tries += 1
                offs, claims = _truncus_of(random, power, case)
                errors += offs
                claim += claims
            if errors:
                regime = "power < 1" if power < 1 else ""
                yield off(case, errors, np.array(claim), regime)
    call = partial(isoluminance.truncus, (0, 0, 0), (0, 0, 2), diffuse=0.5, ambient=0.125)
    # A light along the axis makes the side one band: half a right angle's cosine, and none.
    made = call((1.0, 3.0), height=2.0, direction=(0, 0, 1))
    side = oracles.exact(0.125) + oracles.exact(0.5) / oracles.mp.sqrt(2)
    yield Check("light along the axis", made.values[made.patch == 0], [side] * np.count_nonzero(
        made.patch == 0), 12.0)  # fmt: skip
    yield exactly("light along the axis", [len(made.lines), *made.values[made.patch > 0]],
                  [0, 0.625, 0.125])  # fmt: skip
    for radii, lit in (((1.0, 3.0), 0.4 + 0.125), ((3.0, 1.0), 0.125)):
        made = call(radii, height=0.0, direction=(0, 3, 4))
        side = made.values[made.patch == 0]
        yield Check("height 0", side, [lit] * len(side), 12.0, 0.0)
        yield exactly("height 0", [len(made.lines)], [0])
    made = call((1.0, 1.0), direction=(0, 0, 1))
    yield exactly("light along the axis, R1 = R2", np.unique(made.values[made.patch == 0]), [0.125])
    for case, radii, cells in (
        ("rod, R1 = R2 = 0", (0, 0), 0),
        ("disc, R1 = R2, height 0", (1, 1), 2),
    ):
        made = call(radii, height=0.0 if cells else 2.0, direction=(1, 0, 1))
        yield exactly(case, [len(made.lines), len(made.band)], [0, cells])
    ends = call((1.0, 0.0), direction=(0, 0, -1))
    yield exactly("cone, one end", [np.count_nonzero(ends.patch == j) for j in (1, 2)], [1, 0])


def _truncus_of(random, power, case):
    mp = oracles.mp
    first, second = 10 ** random.uniform(-1, 1, 2)
    height = float(10 ** random.uniform(-1, 1))
    if "R1 = R2" in case:
        second = first
    elif "R1 = 0" in case:
        first = 0.0
    elif "R2 = 0" in case:
        second = 0.0
    elif case == "thin":
        height *= 10 ** random.uniform(1, 6)
    axis, way = random.standard_normal((2, 3))
    work = partial(
        isoluminance.truncus, (0.0, 0.0, 0.0), axis, (first, second), height=height,
        direction=way, diffuse=1.0, power=power, levels=16,
    )  # fmt: skip
    made = timed(work)
    up, toward = oracles.unit(oracles.exact(axis)), oracles.unit(oracles.exact(way))
    r1, r2, tall = oracles.exact([first, second, height])
    errors, claim = [], []
    for ends, level in zip(made.lines, made.line_levels, strict=True):
        point = oracles.exact(made.points[ends[0 if first >= second else 1]])
        along = oracles.dot(point, up)
        out = oracles.unit([p - along * a for p, a in zip(point, up, strict=True)])
        normal = [tall * o + (r2 - r1) * a for o, a in zip(out, up, strict=True)]
        cosine = max(oracles.dot(oracles.unit(normal), toward), mp.mpf(0))
        errors.append(cosine ** oracles.exact(power) - oracles.exact(level))
        claim.append(_law(power, 8.0, height / max(first, second)))
    return errors, claim


CHECKS = {
    "manifolds.torus": (torus, DOUBLE),
    "manifolds.torus_curve": (torus_curve, DOUBLE),
    "manifolds.hopf_fibres": (hopf_fibres, DOUBLE),
    "manifolds.klein_bottle": (klein_bottle, DOUBLE),
    "manifolds.veronese": (veronese, DOUBLE),
    "manifolds.sphere3": (sphere3, DOUBLE),
    "manifolds.complex_curve": (complex_curve, DOUBLE),
    "isoluminance.sphere": (sphere, DOUBLE),
    "isoluminance.truncus": (truncus, DOUBLE),
}
