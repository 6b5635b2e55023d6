"""The checks of curves, projections, cuts and height fields for the stability suite."""

from functools import partial

import numpy as np
import oracles

from stability import hard
from stability.checks import DOUBLE, TYPES, Check, exactly, off, refused, spread, timed
from vizlight.geometry.lines import curves
from vizlight.geometry.nspace import projection, slices
from vizlight.geometry.relief import depth_map, shadowing

#: Claim of the length inside a field, of its size.
RELIEF = 3.0


def _orthonormal(v, dtype):
    """Return vectors (..., k, n) made orthonormal, rounded to the type."""
    return np.asarray(np.swapaxes(np.linalg.qr(np.swapaxes(v, -1, -2))[0], -1, -2).astype(dtype))


def _apart(value, true):
    """Return the length of a difference."""
    return oracles.size([oracles.exact(float(a)) - b for a, b in zip(value, true, strict=True)])


def _outside(rows, space):
    """Return the most that rows are outside a space."""
    frame = oracles.orthonormal(space)
    return max((oracles.digits.across(row, frame) for row in oracles.exact(rows)), default=0)


def _lines(points, count):
    """Return a call for the tangents of lines of ``count`` points each."""
    return partial(
        curves.polyline_tangents, points, connectivity=np.arange(len(points)),
        offsets=np.arange(0, len(points) + 1, count),
    )  # fmt: skip


def tangents(dtype, count, random):
    """Tangents of lines of 2 points, of 3, and closed; far off, repeated; hard cases 7, 11."""
    work = float(np.finfo(float).eps / np.finfo(dtype).eps)
    far = 30 if dtype == np.float32 else 150
    for case, away, scale in (
        ("random", 0.0, 0.0), ("5e6 from the origin", 5e6, 0.0), (f"1e±{far} long", 0.0, far)
    ):  # fmt: skip
        many = max(count // 5, 2)
        points = away + random.standard_normal((many, 2, 3))
        points = (points * 10 ** random.uniform(-scale, scale, (many, 1, 1))).astype(dtype)
        value = timed(_lines(points.reshape(-1, 3), 2))
        errors = []
        for (a, b), row in zip(points, value[::2], strict=True):
            way = [y - x for x, y in zip(oracles.exact(a), oracles.exact(b), strict=True)]
            true = oracles.unit(way)
            errors.append(max(abs(oracles.exact(x) - y) for x, y in zip(row, true, strict=True)))
        yield off(f"2 points, {case}", errors, 1 + work)
    for case, closed in (("3 points", False), ("closed", True)):
        many = max(count // 15, 2)
        points = random.standard_normal((many, 3, 3))
        turn = random.random(many) < 0.3
        back = points[turn, 0] - points[turn, 1]
        points[turn, 2] = points[turn, 1] + back + 1e-3 * random.standard_normal(back.shape)
        points = points.astype(dtype)
        given = np.concatenate([points, points[:, :1]], axis=1) if closed else points
        value = timed(_lines(given.reshape(-1, 3), given.shape[1]))
        errors, claim = [], []
        for line, rows in zip(points, value.reshape(given.shape), strict=True):
            p = oracles.exact(line)
            for i in range(3):
                mean = _parabola(p, i, closed=closed)
                size = oracles.size(mean)
                off_by = zip(rows[i], oracles.unit(mean), strict=True)
                errors.append(max(abs(oracles.exact(x) - y) for x, y in off_by))
                claim.append(1 + 4 * work / float(size))
        yield off(case, errors, np.array(claim), "3 points and closed")
    same = np.repeat(random.standard_normal((5, 3)), 2, axis=0).astype(dtype)
    yield exactly("repeated points", timed(_lines(same, 2)), np.zeros((10, 3)))
    yield exactly("lines of one point", timed(_lines(same, 1)), np.zeros((10, 3)))
    yield exactly("no point", timed(_lines(same[:0], 1)).shape, [0, 3])
    bent = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 0], [np.nan, 0, 0], [3, 0, 0]], dtype)
    value = timed(curves.polyline_tangents, bent)
    yield exactly("turned back, beside NaN", value[1:], np.zeros((4, 3)))
    value = timed(_lines(np.repeat(bent[[0, 1, 0]], 2, axis=0), 6))
    yield exactly("closed, of two points", value[2:4], np.zeros((2, 3)))


def _parabola(p, i, *, closed):
    """Return the derivative by arc length of the parabola through 3 points, at one of them."""

    def step(a, b):
        way = [y - x for x, y in zip(a, b, strict=True)]
        return oracles.unit(way), oracles.size(way)

    if closed or i == 1:
        (u, g), (v, h) = step(p[i - 1], p[i]), step(p[i], p[(i + 1) % 3])
        return [(h * x + g * y) / (g + h) for x, y in zip(u, v, strict=True)]
    (u, g), (v, h) = step(p[0], p[1]), step(p[1], p[2])
    if i == 2:
        (u, g), (v, h) = (v, h), (u, g)
    return [x + (x - y) * g / (g + h) for x, y in zip(u, v, strict=True)]


def turn(dtype, count, random):
    """R x, of the length of x."""
    for n in (2, 3, 4, 8):
        matrix = hard.frames(random, 1, n, n, dtype)[0]
        x = random.standard_normal((count // 4, n)) * hard.steps(random, count // 4, -10, 10)
        x = x.astype(dtype)
        value = timed(projection.turn, x, matrix)
        rows, errors = oracles.exact(matrix), []
        for given, found in zip(x, value, strict=True):
            own = oracles.exact(given)
            true = [oracles.dot(row, own) for row in rows]
            errors.append(_apart(found, true) / oracles.size(own))
        yield off(f"n = {n}", errors, float(n))
    value = timed(projection.turn, np.empty((0, 3), dtype), np.eye(3, dtype=dtype))
    yield exactly("none", value.shape, [0, 3])


def _scene(dtype, many, n, case, random):
    """Return points before an eye at 2 on the last axis."""
    near = -6.0 if dtype == np.float32 else -12.0
    low = near if case == "near the eye" else -0.3
    points = random.standard_normal((many, n))
    share = 10 ** random.uniform(low, 0.3, many)
    points[:, 3:] = 0.3 * points[:, 3:]
    points[:, n - 1] = 2 * (1 - np.where(random.random(many) < 0.1, -share, share))
    return np.asarray(points.astype(dtype))


def _projected(point):
    """Return the image in 3-space from an eye at 2, the depths' product and their least."""
    x, product, least = list(point), 1, 1
    while len(x) > 3:
        share = (2 - x[-1]) / 2
        product, least = product * min(abs(share), 1), min(least, share)
        x = [y / share for y in x[:-1]]
    return x, product, least


def perspective(dtype, count, random):
    """Projection from 4, 5 and 6-space, of the image, over the depths; the depth."""
    for n in (4, 5, 6):
        for case in ("random", "near the eye"):
            points = _scene(dtype, max(count // 6, 2), n, case, random)
            value = timed(projection.perspective, points, distance=2.0)
            errors, claim = [], []
            for p, image in zip(points, value, strict=True):
                whole, product, _ = _projected(oracles.exact(p))
                errors.append(_apart(image, whole) / oracles.size(whole))
                claim.append(float(3 * (n - 3) / product))
            yield off(f"{case}, n = {n}", errors, np.array(claim))
    flat = random.standard_normal((20, 4)).astype(dtype)
    yield exactly("orthographic", timed(projection.perspective, flat), flat[:, :3])
    flat[:, 3] = 2
    value = timed(projection.perspective, flat, distance=2.0)
    yield exactly("in the eye's hyperplane", np.isfinite(value), np.zeros((20, 3)))
    yield exactly("none", timed(projection.perspective, flat[:0], distance=2.0).shape, [0, 3])


def image_and_depth(dtype, count, random):
    """Depth before the eye, of the larger of it and 1."""
    for case in ("random", "near the eye"):
        points = _scene(dtype, max(count // 2, 2), 4, case, random)
        _, depth = timed(projection.image_and_depth, points, distance=2.0)
        errors = []
        for p, found in zip(points, depth, strict=True):
            _, _, least = _projected(oracles.exact(p))
            errors.append((oracles.exact(found) - least) / max(abs(least), 1))
        yield off(case, errors, 2.0)
    here = np.array([[1, 2, 3, 2], [np.nan, 0, 0, np.nan]], dtype)
    _, depth = timed(projection.image_and_depth, here, distance=2.0)
    yield exactly("at the eye, NaN", depth, [0, np.nan])


def push_forward(dtype, count, random):
    """Images of vectors, of what they are sums of, over the depth; also ones toward the eye."""
    for case in ("random", "near the eye", "toward the eye"):
        many = max(count // 3, 2)
        points = _scene(dtype, many, 4, case, random)
        v = random.standard_normal((many, 1, 4)).astype(dtype)
        if case == "toward the eye":
            v[:, 0] = np.array([0, 0, 0, 2], dtype) - points
        value = timed(projection.push_forward, v, points, distance=2.0)
        errors, claim = [], []
        for p, way, image in zip(points, v[:, 0], value[:, 0], strict=True):
            x, u = oracles.exact(p), oracles.exact(way)
            place, product, _ = _projected(x)
            f = 2 / (2 - x[3])
            true = [f * (a + y * u[3] / 2) for a, y in zip(u[:3], place, strict=True)]
            whole = abs(f) * (oracles.size(u[:3]) + oracles.size(place) * abs(u[3]) / 2)
            errors.append(_apart(image, true) / whole)
            claim.append(float(3 / product))
        yield off(case, errors, np.array(claim))


def push_frame(dtype, count, random):
    """Check the space of the image of 1 and 2 tangents, over its least singular value."""
    mp = oracles.mp
    kinds = [(k, case) for k in (1, 2) for case in ("random", "near the eye", "near a silhouette")]
    for k, case in kinds:
        many = spread(count, kinds)
        points = _scene(dtype, many, 4, case, random)
        v = random.standard_normal((many, k, 4))
        if case == "near a silhouette":
            v[:, 0] = np.array([0, 0, 0, 2]) - points
            v[:, 0] += hard.steps(random, many, -5) * random.standard_normal((many, 4))
        v = _orthonormal(v, dtype)
        frame, rank = timed(projection.push_frame, v, points, distance=2.0)
        errors, claim = [], []
        for p, rows, found, r in zip(points, v, frame, rank, strict=True):
            x = oracles.exact(p)
            place, _, _ = _projected(x)
            f = 2 / (2 - x[3])
            own = oracles.orthonormal(oracles.exact(rows))
            image = [
                [f * (a + y * u[3] / 2) for a, y in zip(u[:3], place, strict=True)] for u in own
            ]
            bound = abs(f) * (1 + oracles.size(place) / 2 * (1 + abs(f * x[3]) / 2))
            gram = [[oracles.dot(a, b) for a in image] for b in image]
            least = gram[0][0]
            if k == 2:
                half = (gram[0][0] - gram[1][1]) / 2
                high = (gram[0][0] + gram[1][1]) / 2 + mp.sqrt(half * half + gram[0][1] ** 2)
                least = (gram[0][0] * gram[1][1] - gram[0][1] ** 2) / high
            least = mp.sqrt(least) / bound
            claim.append(float(4 / least))
            errors.append(_outside(found[:r], image) if r == k or least < 1e-3 else mp.inf)
        yield off(f"k = {k}, {case}", errors, np.array(claim))
    eye = np.array([0, 0, 0, 2], dtype)
    here = random.standard_normal((20, 4)).astype(dtype)
    work = partial(projection.push_frame, (eye - here)[:, np.newaxis], here, distance=2.0)
    frame, rank = timed(work)
    yield exactly("a silhouette", [*rank, *np.ravel(frame)], [0] * 80)


def slice_frame(dtype, count, random):
    """|F F^T - 1|, and the space of a cut, over the angle to the hyperplane."""
    low = -4.0 if dtype == np.float32 else -12.0
    for k, n in ((2, 3), (2, 4), (3, 4), (3, 8)):
        many = max(count // 4, 2)
        normal = random.standard_normal(n)
        v = random.standard_normal((many, k, n))
        # Nearly within the hyperplane: hardly anything along its normal is left.
        up = normal / np.linalg.norm(normal)
        part = v @ up
        v = v - (part * (1 - 10 ** random.uniform(low, 0, (many, 1))))[..., np.newaxis] * up
        v = _orthonormal(v, dtype)
        value = timed(slices.slice_frame, v, normal)
        loose, spans, claim = [], [], []
        across = oracles.unit(oracles.exact(normal))
        for rows, found in zip(v, value, strict=True):
            own = oracles.orthonormal(oracles.exact(rows))
            a = [oracles.dot(t, across) for t in own]
            sine = oracles.size(a)
            steep = [oracles.dot(a, column) / sine for column in zip(*own, strict=True)]
            r = oracles.exact(found)
            loose.append(max(
                abs(oracles.dot(x, y) - (i == j)) for i, x in enumerate(r) for j, y in enumerate(r)
            ))  # fmt: skip
            outside = _outside(found, own)
            spans.append(max(outside, *(abs(oracles.dot(x, steep)) for x in r)))
            claim.append(float(2 / sine))
        yield off(f"k = {k}, n = {n}", loose, 8.0, "rows")
        yield off(f"k = {k}, n = {n}", spans, np.array(claim), "space")
    flat = np.eye(3, dtype=dtype)[np.newaxis, :2]
    value = timed(slices.slice_frame, flat, [0, 0, 1])
    yield exactly("within the hyperplane", value, np.zeros((1, 1, 3)))._replace(regime="rows")


def mean_frame(dtype, count, random):
    """Means of the spaces at two points, over the cosine of their largest angle."""
    from scipy.sparse import csr_array

    mp = oracles.mp
    kinds = [(k, n, case) for k, n in ((1, 3), (2, 3), (2, 5)) for case in ("random", "near right")]
    for k, n, case in kinds:
        many = spread(count, kinds)
        v = random.standard_normal((many, 2, k, n))
        if case == "near right":
            one = v[:, 0, 0] / np.linalg.norm(v[:, 0, 0], axis=1, keepdims=True)
            off_by = 10 ** random.uniform(-3, -1, (many, 1, 1))
            rest = v[:, 1] - (v[:, 1] @ one[..., np.newaxis]) * (1 - off_by) * one[:, np.newaxis]
            v[:, 1] = rest
        v = _orthonormal(v, dtype)
        part = random.uniform(0.05, 0.45, many)
        shares = csr_array(
            (np.stack([part, 1 - part], axis=1).ravel(), np.arange(2 * many),
             np.arange(0, 2 * many + 1, 2)), (many, 2 * many),
        )  # fmt: skip
        value = timed(slices.mean_frame, v.reshape(-1, k, n), shares)
        errors, claim = [], []
        for (a, b), w, found in zip(v, part, value, strict=True):
            f, g = (oracles.orthonormal(oracles.exact(x)) for x in (b, a))
            m = [[oracles.dot(x, y) for y in g] for x in f]
            if k == 1:
                factor, least = [[mp.sign(m[0][0])]], abs(m[0][0])
            else:
                # The nearest rotation or reflection of two rows, in closed form.
                even = mp.hypot(m[0][0] + m[1][1], m[1][0] - m[0][1]) / 2
                odd = mp.hypot(m[0][0] - m[1][1], m[1][0] + m[0][1]) / 2
                least, sign = abs(even - odd), 1 if even >= odd else -1
                c, s = m[0][0] + sign * m[1][1], m[1][0] - sign * m[0][1]
                c, s = c / mp.hypot(c, s), s / mp.hypot(c, s)
                factor = [[c, -sign * s], [s, sign * c]]
            share = oracles.exact(w)
            turned = [
                [oracles.dot(row, column) for column in zip(*g, strict=True)] for row in factor
            ]
            mean = [
                [(1 - share) * x + share * y for x, y in zip(p, q, strict=True)]
                for p, q in zip(f, turned, strict=True)
            ]
            # At right angles, to rounding, they have no mean.
            none = not np.any(found) and least < 16 * np.sqrt(n) * np.finfo(dtype).eps
            errors.append(0 if none else _outside(found, mean) if np.any(found) else mp.inf)
            claim.append(float(2 / least))
        yield off(f"k = {k}, n = {n}, {case}", errors, np.array(claim))
    right = np.eye(3, dtype=dtype)[:2, np.newaxis]
    value = timed(slices.mean_frame, right, csr_array([[0.5, 0.5]]))
    yield exactly("right angle", value, np.zeros((1, 1, 3)))


def highest(_, count, random):
    """Heights of a triangle at nodes, over how it is claimed that slivers and steep ones lose."""
    mp = oracles.mp
    kinds = ("random", "steep", "slivers", "far off")
    for case in kinds:
        errors = []
        claim = []
        while len(errors) < count // len(kinds):
            first = 5e6 if case == "far off" else 0.0
            step = float(2.0 ** random.integers(-3, 4))
            nodes = first + step * np.arange(24)
            corners = random.uniform(0, 23, (3, 3)) * step
            if case == "slivers":
                way = corners[1] - corners[0]
                corners[2] = corners[0] + random.uniform() * way
                corners[2, :2] += 10 ** random.uniform(-6, 0) * step * np.array([-way[1], way[0]])
            if case == "steep":
                corners[:, 2] *= 10 ** random.uniform(0, 6)
            corners[:, :2] += first
            value = timed(depth_map.depth_map, nodes, nodes, corners, np.array([[0, 1, 2]]))
            a, b, c = oracles.exact(corners)
            area = _doubled(a, b, c)
            if not area:
                continue
            edges = [oracles.size([p[0] - q[0], p[1] - q[1]]) for p, q in ((a, b), (b, c), (c, a))]
            size = mp.mpf(24 * step)
            rise = max(p[2] for p in (a, b, c)) - min(p[2] for p in (a, b, c))
            unit = max(abs(p[2]) for p in (a, b, c)) + rise * max(edges) * size / abs(area)
            for j, i in zip(*np.nonzero(np.isfinite(value)), strict=True):
                at = oracles.exact([nodes[i], nodes[j]])
                parts = [_doubled(at, b, c), _doubled(a, at, c), _doubled(a, b, at)]
                true = sum(w * p[2] for w, p in zip(parts, (a, b, c), strict=True)) / area
                errors.append((oracles.exact(value[j, i]) - true) / unit)
                claim.append(4.0)
            for j, i in zip(*np.nonzero(np.isnan(value) & _near(corners, nodes)), strict=True):
                at = oracles.exact([nodes[i], nodes[j]])
                parts = [_doubled(at, b, c), _doubled(a, at, c), _doubled(a, b, at)]
                if all(w / area > 1e-8 for w in parts):
                    errors.append(mp.inf)
                    claim.append(4.0)
        yield off(case, errors, np.array(claim))
    none = depth_map.depth_map([0, 1], [0, 1], np.empty((0, 3)), np.empty((0, 3), int))
    yield exactly("no triangle", none, np.full((2, 2), np.nan))


def _near(corners, nodes):
    """Return which nodes may be within a triangle: work in float64 is not that far off."""
    a, b, c = corners
    at = np.meshgrid(nodes, nodes)
    parts = np.array([_doubled(at, b, c), _doubled(a, at, c), _doubled(a, b, at)])
    with np.errstate(all="ignore"):
        return ~(parts / _doubled(a, b, c) < -0.5).any(axis=0)


def _doubled(a, b, c):
    """Return twice the signed area below a triangle."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])


def inside_length(_, count, random):
    """Length inside a plane field of the field's size; hard case 10.

    A plane is bilinear, so the length has a closed form: depth over the rate at which a ray rises.
    """
    for case, low, tilt in (
        ("flat", -1.0, 0.0),
        ("tilted", -1.0, 0.3),
        ("near the surface", -9.0, 0.3),
    ):
        fields, many = 8, max(count // 24, 1)
        off, claim = [], RELIEF
        for _i in range(fields):
            x, y = (np.cumsum(random.uniform(0.5, 2, 9)) for _ in range(2))
            a, b = tilt * random.integers(-8, 9, 2) / 16
            z = a * x + b * y[:, np.newaxis]
            way = np.array([*random.uniform(-0.3, 0.3, 2), 1.0])
            down = 10 ** random.uniform(low, low + 1, many)
            place = np.stack([random.uniform(x[3], x[5], many), random.uniform(y[3], y[5], many)])
            points = np.stack([*place, a * place[0] + b * place[1] - down], axis=1)
            value = timed(shadowing.inside_length, x, y, z, points, direction=way)
            size = oracles.exact(float(max(x[-1] - x[0], y[-1] - y[0])))
            u = oracles.unit(oracles.exact(way))
            rate = u[2] - oracles.exact(a) * u[0] - oracles.exact(b) * u[1]
            for p, found in zip(points, value, strict=True):
                px, py, pz = oracles.exact(p)
                depth = oracles.exact(a) * px + oracles.exact(b) * py - pz
                off.append((oracles.exact(found) - depth / rate) / size)
        yield Check(case, np.zeros(len(off)), off, np.array(claim))
    mp, off = oracles.mp, []
    corners = np.array([0.0, 1.0])
    for _i in range(8):
        c = random.integers(-16, 17) / 16
        # z = c x y over one cell: along a ray a quadratic, whose first root is where it leaves.
        way = np.array([*random.uniform(-0.2, 0.2, 2), 1.0])
        place = random.uniform(0.4, 0.6, (max(count // 32, 1), 2))
        down = 10 ** random.uniform(-9, -1, len(place))
        points = np.column_stack([place, c * place[:, 0] * place[:, 1] - down])
        z = np.array([[0, 0], [0, c]])
        value = timed(shadowing.inside_length, corners, corners, z, points, direction=way)
        u, twist = oracles.unit(oracles.exact(way)), oracles.exact(c)
        for p, found in zip(points, value, strict=True):
            px, py, pz = oracles.exact(p)
            # c (px + u t)(py + v t) - pz - w t = 0, by the form that does not cancel.
            low = twist * px * py - pz
            middle = twist * (px * u[1] + py * u[0]) - u[2]
            high = twist * u[0] * u[1]
            root = 2 * low / (-middle + mp.sqrt(middle * middle - 4 * high * low))
            off.append(oracles.exact(found) - root)
    yield Check("twisted", np.zeros(len(off)), off, np.array(RELIEF))


def inside_ends(_, count, random):
    """Lights at the horizon and below it, holes, lights that stand somewhere; hard cases 8, 10."""
    many = max(count // 12, 2)
    x = y = np.cumsum(random.uniform(0.5, 2, 9))
    flat, size = np.zeros((9, 9)), float(x[-1] - x[0])
    inside = np.stack([*random.uniform(x[3], x[5], (2, many)), -random.uniform(0.1, 1, many)], 1)
    solid = partial(shadowing.inside_length, x, y)
    walls = partial(solid, border="wall")

    def against(case, work, true):
        value = timed(work)
        pairs = zip(value, true, strict=True)
        return off(case, [(oracles.exact(v) - t) / size for v, t in pairs], RELIEF)

    level = [oracles.exact(x[-1]) - p for p in oracles.exact(inside[:, 0])]
    yield against(
        "at the horizon, to a wall", lambda: walls(flat, inside, direction=(1, 0, 0)), level
    )
    # Down by 3 of 5.
    low = [d * 5 / 4 for d in level]
    yield against(
        "below the horizon, to a wall", lambda: walls(flat, inside, direction=(4, 0, -3)), low
    )
    holed = flat.copy()
    holed[:, 7] = np.nan
    gap = oracles.exact(x[8]) - oracles.exact(x[6])
    yield against(
        "holes", lambda: walls(holed, inside, direction=(1, 0, 0)), [d - gap for d in level]
    )
    place = np.array([x[4], y[4], 3.0])
    near = []
    for p in oracles.exact(inside):
        way = [a - b for a, b in zip(oracles.exact(place), p, strict=True)]
        near.append(-p[2] * oracles.size(way) / way[2])
    yield against("light nearby", lambda: solid(flat, inside, position=place), near)
    for case, toward in (("at the horizon", (1, 0, 0)), ("below it", (1, 0, -1))):
        yield exactly(case, timed(solid, flat, inside, direction=toward), np.full(many, np.inf))
    steep = [-p[2] for p in oracles.exact(inside)]
    for case, least in (("smallest number", 5e-324), ("one ulp", 2.0**-52)):
        value = timed(solid, flat, inside, direction=(least, -least, 1.0))
        errors = [(oracles.exact(v) - t) / size for v, t in zip(value, steep, strict=True)]
        yield off(f"off the zenith by the {case}", errors, RELIEF)
    above = inside * [1, 1, -1]
    value = timed(lambda: solid(flat, above, direction=(1, 0, 0)))
    yield exactly("at the horizon, above", value, np.zeros(many))
    value = timed(lambda: solid(flat, np.array([place, [np.nan, 0, 0]]), position=place))
    yield exactly("light on the point, NaN", value, [0, np.nan])
    yield refused(
        "light inside", lambda: solid(flat, inside, position=np.array([4, 4, -1.0])), "position"
    )
    yield refused("one row", lambda: shadowing.inside_length(
        x, y[:1], flat[:1], inside, direction=(0, 0, 1)), "y")  # fmt: skip


def shadow(_, count, random):
    """Cosine of a plane, over the depth; at depth 0 its limit, and 0 at holes; hard case 10."""
    for case, low, high in (("deep", -2.0, 0.0), ("shallow", -7.0, -4.0), ("depth 0", 0.0, 0.0)):
        errors = []
        claim = []
        while len(errors) < count // 3:
            x, y = (np.cumsum(random.uniform(0.5, 2, 17)) for _ in range(2))
            a, b = random.integers(-8, 9, 2) / 32
            z = a * x + b * y[:, np.newaxis]
            size = float(max(np.ptp(x), np.ptp(y), np.ptp(z)))
            depth = 0.0 if case == "depth 0" else size * 10 ** random.uniform(low, high) / 30
            way = np.array([*random.uniform(-0.6, 0.6, 2), 1.0])
            value = timed(shadowing.shadow, x, y, z, depth=depth, direction=way)
            normal = oracles.unit([-oracles.exact(a), -oracles.exact(b), 1])
            true = oracles.dot(normal, oracles.unit(oracles.exact(way)))
            errors += [oracles.exact(v) - true for v in value[6:11, 6:11].ravel()]
            claim += [8 + (size / depth if depth else 0)] * 25
        yield off(case, errors, np.array(claim), "depth 0" if case == "depth 0" else "")
    z = np.zeros((5, 5))
    z[2, 2] = np.nan
    for depth in (0.0, 0.5):
        t = shadowing.shadow(range(5), range(5), z, depth=depth, direction=(0, 0, 1))
        yield exactly("hole", t[2, 2], 0.0)
        t = shadowing.shadow(range(5), range(5), 0 * z[:1] + np.zeros((5, 5)), depth=depth,
                          direction=(1, 0, -1))  # fmt: skip
        yield exactly("light below the horizon", t, np.zeros((5, 5)))


def lengths(dtype, count, random):
    """Check both parts of the length inside."""
    yield from inside_length(dtype, count, random)
    yield from inside_ends(dtype, count, random)


CHECKS = {
    "curves.polyline_tangents": (tangents, TYPES),
    "projection.turn": (turn, TYPES),
    "projection.perspective": (perspective, TYPES),
    "projection.image_and_depth": (image_and_depth, TYPES),
    "projection.push_forward": (push_forward, TYPES),
    "projection.push_frame": (push_frame, TYPES),
    "slices.slice_frame": (slice_frame, TYPES),
    "slices.mean_frame": (mean_frame, TYPES),
    "depth_map.depth_map": (highest, DOUBLE),
    "relief.inside_length": (lengths, DOUBLE),
    "relief.shadow": (shadow, DOUBLE),
}
