"""The checks of shapes for the stability suite: manifolds in n-space, contours of solids."""

import itertools
from functools import partial

import numpy as np
import oracles

from stability.checks import DOUBLE, Check, exactly, off, refused, timed
from vizlight.geometry import manifolds
from vizlight.geometry.contours import isoluminance

#: Largest number of shapes that share the inputs of a check, and least number of inputs of one.
SHAPES, INPUTS = 8, 60


def _radii(random, count):
    """Return radii of all sizes."""
    return np.asarray(10 ** random.uniform(-100, 100, 1) * 10 ** random.uniform(-3, 3, count))


def _far(value, true):
    """Return the largest difference of components."""
    return max(abs(oracles.exact(float(a)) - b) for a, b in zip(value, true, strict=True))


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
    "isoluminance.sphere": (sphere, DOUBLE),
    "isoluminance.truncus": (truncus, DOUBLE),
}
