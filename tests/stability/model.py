"""The checks of :mod:`vizlight.model` for the stability suite."""

import itertools
from functools import partial

import numpy as np
import oracles
from oracles import dot, exact

from stability import hard, references
from stability.checks import DOUBLE, TYPES, Check, exactly, off, some, spread, timed
from vizlight.model import (
    brightness,
    cylinder,
    falloff,
    half_vector,
    highlight_integral,
    highlights,
    reflection,
)
from vizlight.model import frames as spaces
from vizlight.scene import DepthCue

SIZES = ((1, 3), (1, 2), (2, 3), (1, 4), (2, 4), (3, 8), (7, 8))
EXPONENTS = (1.0, 4.7635, 0.5, 2.0, 64.0, 65.0, 128.0, 150.0, 1e3, 1e6)
SHININESS = (20.0, 1.0, 0.5, 20.5, 64.0, 65.0, 128.0, 200.0, 1e4, 1e6)
CYLINDER = (20.0, 0.0, 1.0, 2.0, 5.0, 33.0, 100.0, 0.5, 7.5, 20.5, 1e3, 1e5)


def orthonormalize(dtype, count, random):
    """|F F^T - 1|, hard case 3: nearly dependent, wildly scaled, smallest and largest numbers."""
    apart = 1e-3 if dtype == np.float32 else 1e-8
    scale = 30 if dtype == np.float32 else 150
    cases = ("random", f"{apart:g} apart", f"1e±{scale} long", "smallest and largest")
    for case in cases:
        for k, n in SIZES:
            many = spread(count, cases * len(SIZES))
            v = random.standard_normal((many, k, n))
            if case.endswith("apart"):
                v[:, 1:] = v[:, :1] + apart * v[:, 1:]
            v = v.astype(dtype)
            if case.endswith("long"):
                v = (v * 10.0 ** random.uniform(-scale, scale, (many, k, 1))).astype(dtype)
            if case.startswith("smallest"):
                info = np.finfo(dtype)
                v *= random.choice([info.tiny, info.max / 16], (many, k, 1))
            frame, rank = timed(spaces.orthonormalize, v)
            values, true = [], []
            for f, r in zip(frame, rank, strict=True):
                rows = exact(f[:r])
                off = [dot(a, b) - (i == j) for i, a in enumerate(rows) for j, b in enumerate(rows)]
                values.append(0.0 if r == k or case.endswith("apart") else np.nan)
                true.append(max(map(abs, off), default=exact(0.0)))
            yield Check(case, np.array(values), true, np.array(6.0))
    bad = _bad(dtype)
    frame, rank = timed(spaces.orthonormalize, bad[:, np.newaxis])
    yield exactly("zero, NaN, infinite", [*rank, *np.ravel(frame)], [0] * 4 * len(bad))
    small = _denormal(dtype)
    frame, rank = timed(spaces.orthonormalize, small[:, np.newaxis])
    true = [a for v in exact(small) for a in oracles.unit(v)]
    yield Check("denormal", frame, true, np.array(6.0))
    twice = np.repeat(random.standard_normal((50, 1, 4)), 2, axis=1).astype(dtype)
    _, rank = timed(spaces.orthonormalize, twice)
    yield exactly("dependent", rank, [1] * 50)
    frame, rank = timed(lambda: spaces.orthonormalize(np.empty((0, 2, 3), dtype)))
    yield exactly("none", [*frame.shape, *rank.shape], [0, 2, 3, 0])


def _bad(dtype):
    """Return vectors without a direction."""
    nan, inf = np.nan, np.inf
    return np.array([[0, 0, 0], [nan, 0, 1], [inf, 0, 0], [-inf, 1, nan], [0, -inf, inf]], dtype)


def _denormal(dtype):
    """Return vectors whose squares are nothing: they have a direction all the same."""
    info = np.finfo(dtype)
    least = float(info.smallest_subnormal)
    rows = [[least, 0, 3 * least], [-5 * least, 7 * least, least], [1024 * least, least, least]]
    return np.array([*rows, [float(info.tiny) / 4, float(info.tiny) / 3, 0]], dtype)


def split(dtype, count, random):
    """Coefficients and |x_N|, over |x|; hard case 1."""
    for case in hard.DIRECTIONS:
        for k, n in SIZES:
            many = spread(count, hard.DIRECTIONS * len(SIZES))
            frame = hard.frames(random, many, k, n, dtype)
            x = hard.directions(random, frame, case)
            along, normal = timed(spaces.split, x, frame)
            values, true = [], []
            for i in range(many):
                own, f = oracles.exact(x[i]), oracles.orthonormal(oracles.exact(frame[i]))
                size = oracles.size(own)
                exact_along, exact_normal = oracles.split(own, f)
                pairs = [*zip(along[i], exact_along, strict=True), (normal[i], exact_normal)]
                off = max(abs(oracles.exact(a) - b) for a, b in pairs)
                values.append(0.0 if np.all(np.isfinite(along[i])) else np.nan)
                true.append(off / size)
            yield Check(case, np.array(values), true, np.array(10.0))
    bad, frame = _bad(dtype), np.eye(3, dtype=dtype)[:1]
    along, normal = timed(spaces.split, bad, frame)
    true = [0, *[np.nan] * 4]
    yield exactly("zero, NaN, infinite", [*along[:, 0], *normal], [*true, *true])
    whole = hard.units(random, 20, 3).astype(dtype)
    along, normal = timed(spaces.split, whole, np.zeros((1, 3), dtype))
    sizes = [oracles.size(v) for v in oracles.exact(whole)]
    yield Check("frame of rank 0", [*along[:, 0], *normal], [0] * 20 + sizes, 10.0)
    along, normal = timed(lambda: spaces.split(np.empty((0, 3), dtype), frame))
    yield exactly("none", [*along.shape, *normal.shape], [0, 1, 0])


def diffuse(dtype, count, random):
    """sin(a)^p; hard cases 1 and 2."""
    eps = float(np.finfo(dtype).eps)
    cases = (*hard.DIRECTIONS, "where it is steepest")
    for case in cases:
        for j, p in enumerate(EXPONENTS):
            k, n = SIZES[j % len(SIZES)]
            many = spread(count, cases * len(EXPONENTS))
            frame = hard.frames(random, many, k, n, dtype)
            wi = hard.directions(random, frame, case, p)
            value = timed(reflection.diffuse, wi, frame, exponent=p)
            true = [oracles.diffuse(a, f, p) for a, f in zip(wi, frame, strict=True)]
            claim = np.array(oracles.diffuse_bound(p, eps) / eps)
            yield Check(case, value, true, claim, _steep(p))
    yield from _nothing(dtype, lambda v, f: reflection.diffuse(v, f, exponent=4.7635))
    small, frame = _denormal(dtype), np.eye(3, dtype=dtype)[:1]
    value = timed(reflection.diffuse, small, frame, exponent=2.0)
    yield Check("denormal", value, [oracles.diffuse(v, frame, 2.0) for v in small], 8.0)


def _steep(power):
    return "power < 1" if power < 1 else "power > 128" if power > 128 else ""


def _nothing(dtype, *works):
    """Vectors without a direction give 0, and none give none."""
    bad, frame = _bad(dtype), np.eye(3, dtype=dtype)[:1]
    for work in works:
        yield exactly("zero, NaN, infinite", timed(work, bad, frame), np.zeros(len(bad)))
        yield exactly("none", work(bad[:0], frame).shape, [0])


def specular(model, dtype, count, random):
    """Phong and Blinn; hard cases 1, 2, 4, 5. Blinn's in units of eps / |wi + wo| below 1."""
    eps = float(np.finfo(dtype).eps)
    cases = (*hard.EYES, *hard.STEEP)
    ends = itertools.product(("random", "near it", "near across"), cases)
    kinds = list(itertools.product(enumerate(ends), enumerate(SHININESS)))
    for (turn, (at, case)), (j, s) in some(random, kinds, count):
        k, n = SIZES[(turn + j) % len(SIZES)]
        many = spread(count, kinds)
        frame = hard.frames(random, many, k, n, dtype)
        wi, wo = hard.pairs(random, frame, at, case, s)
        value = timed(reflection.specular, wi, wo, frame, shininess=s, model=model)
        # The claim over |wi + wo| is a claim of its own where that is small.
        apart = ", over |wi + wo|" if model == "blinn" and case.startswith("opposite") else ""
        regime = f"{_steep(s)}{apart}".removeprefix(", ")
        true, claim = [], np.full(many, oracles.specular_bound(s, eps) / eps)
        for i in range(many):
            true.append(oracles.specular(wi[i], wo[i], frame[i], s, model))
            if model == "blinn":
                a, b = (oracles.unit(oracles.exact(v[i])) for v in (wi, wo))
                share = min(float(oracles.size([x + y for x, y in zip(a, b, strict=True)])), 1.0)
                if s < 1:
                    claim[i] = oracles.specular_bound(s, eps / share) / eps if share else np.inf
                else:
                    claim[i] = claim[i] / share if share else np.inf
        yield Check(f"eye {case}", value, true, claim, regime)
    here = np.ones(3, dtype)
    yield from _nothing(
        dtype,
        lambda v, f: reflection.specular(v, here, f, shininess=3, model=model),
        lambda v, f: reflection.specular(here, v, f, shininess=3, model=model),
    )
    small, frame = _denormal(dtype), np.eye(3, dtype=dtype)[:1]
    value = timed(reflection.specular, small, here, frame, shininess=3.0, model=model)
    true = [oracles.specular(v, here, frame, 3.0, model) for v in small]
    yield Check("denormal", value, true, 7.0)
    if model == "blinn":
        wi = hard.units(random, 20, 3).astype(dtype)
        value = timed(reflection.specular, wi, -wi, frame, shininess=3.0, model=model)
        yield exactly("eye exactly opposite", value, np.zeros(20))


def line_light(which, dtype, count, random):
    """Check the line light, in units of eps over the least of |wi_N|, |wo_N|, |wi + wo|."""
    powers = (0.0,) if which == "diffuse" else CYLINDER
    kinds = list(itertools.product(("random", "near it", "across"), hard.EYES, powers))
    for at, case, s in some(random, kinds, count):
        many = spread(count, kinds)
        frame = hard.frames(random, many, 1, 3, dtype)
        wi = hard.directions(random, frame, at)
        wo = hard.eyes(random, wi, frame, case)
        t = frame[:, 0]
        if which == "diffuse":
            value = timed(cylinder.diffuse, wi, wo, t)
        else:
            value = timed(cylinder.specular, wi, wo, t, shininess=s)
        true, claim = [], []
        for i in range(many):
            light, shine, a, b, size = references.cylinder(wi[i], wo[i], t[i], s)
            least = float(b if which == "diffuse" else min(a, b, size))
            true.append(light if which == "diffuse" else shine)
            claim.append((4.0 if which == "diffuse" else 10.0) / least if least else np.inf)
        yield Check(f"light {at}, eye {case}", value, true, np.array(claim))
    call = cylinder.diffuse
    if which == "specular":
        call = partial(cylinder.specular, shininess=9.0)
    up = np.array([0, 0, 1], dtype)
    yield from _nothing(
        dtype, lambda v, f: call(v, up, f[0]), lambda v, f: call(up, v, f[0]),
        lambda v, _: call(up, up, v),
    )  # fmt: skip
    small = _denormal(dtype)
    value = timed(lambda: call(small, up, np.array([0, 1, 0], dtype)))
    true = [references.cylinder(v, up, [0.0, 1.0, 0.0], 9.0)[which == "specular"] for v in small]
    yield Check("denormal", value, true, 10.0)
    # Exactly along the line: of the light nothing, of the eye the mean over the whole round.
    line = np.ldexp(hard.units(random, 50, 3), 3).astype(dtype)
    other = hard.units(random, 50, 3).astype(dtype)
    value = timed(lambda: call(line, other, line))
    apart = np.linalg.norm(np.cross(other, line), axis=1) / np.linalg.norm(line, axis=1)
    bound = 0 * apart if which == "specular" else 4 / apart
    yield Check("light along the line", value, [0] * 50, bound)
    value = timed(lambda: call(other, line, line))
    true = []
    for a, t in zip(other, line, strict=True):
        wi, along = (oracles.unit(oracles.exact(v)) for v in (a, t))
        true.append(oracles.digits.end_on(wi, along, along, 9.0)[which == "specular"])
    yield Check("eye along the line", value, true, 10.0 if which == "specular" else 4.0)
    if which == "specular":
        value = timed(lambda: call(other, -other, line))
        yield exactly("eye exactly opposite", value, np.zeros(50))


def half_integral(dtype, count, random):
    """G(z), of its largest value G(1): the incomplete beta function, and its table."""
    mp = oracles.mp
    for s in CYLINDER:
        many = spread(count, CYLINDER)
        ends = np.nextafter(np.array([1, -1], dtype), dtype(0))
        z = np.concatenate([random.uniform(-1, 1, many // 2), 10 ** random.uniform(-30, 0, many)])
        z = np.concatenate([z.astype(dtype)[:many], ends, np.array([0, 1, -1], dtype)])
        value = timed(highlight_integral.half_integral(s, dtype), z)
        whole = oracles.cosine_integral(mp.pi / 2, s + 1)
        errors = [
            (oracles.exact(v) - oracles.cosine_integral(mp.asin(oracles.exact(x)), s + 1)) / whole
            for v, x in zip(value, z, strict=True)
        ]
        how = "by the beta function" if s < highlight_integral.TABLE_FROM else "by a table"
        yield off(how, errors, 16.0 if dtype == np.float64 else 2.0)


def mean_intensity(dtype, count, random):
    """I(k, n, p) up to n = 1e6; relative, in units of (1 + |ln I|) eps; hard case 5."""
    for case, top in (("n to 10", 1.0), ("n to 1e6", 6.0)):
        values, true = [], []
        for _ in range(count // 2):
            n = int(10 ** random.uniform(0.31, top))
            k = int(random.integers(1, n)) if n > 2 else 1
            p = float(10 ** random.uniform(-3, top))
            value = timed(brightness.mean_intensity, k, n, p)
            exact = oracles.mean_intensity(k, n, p)
            scale = exact * (1 + abs(oracles.mp.log(exact)))
            values.append(0.0 if value == value else np.nan)
            normal = exact > 4 * float(np.finfo(dtype).tiny)
            true.append((oracles.exact(value) - exact) / scale if normal else oracles.exact(0.0))
        yield Check(case, np.array(values), true, np.array(32.0))


def exponent(_, count, random):
    """p(k, n) up to n = 1e6: the step of Newton's method in 50 digits; relative; hard case 5."""
    mp = oracles.mp
    for case, top in (("n to 10", 1.0), ("n to 1e6", 6.0)):
        values, true = [], []
        for _i in range(count // 2):
            n = int(10 ** random.uniform(0.31, top))
            k = int(random.integers(1, n)) if n > 2 else 1
            p = timed(brightness.exponent, k, n)
            c, e = n - k, oracles.exact(p)
            slope = (mp.digamma((c + e) / 2) - mp.digamma((n + e) / 2)) / 2
            step = mp.log(2 * oracles.mean_intensity(k, n, e)) / slope
            values.append(0.0 if p == p else np.nan)
            true.append(step / e)
        yield Check(case, np.array(values), true, np.array(2e-14 / np.finfo(float).eps))


def distance(dtype, count, random):
    """Check the attenuation, relative; hard case 8: the light on the point, and far away."""
    for case, low, high in (("random", -5, 8), ("near 0", -30, -5), ("far", 8, 15)):
        values, true = [], []
        for _ in range(count // 60):
            c = 10 ** random.uniform(-3, 2, 3)
            d = (10 ** random.uniform(low, high, 20)).astype(dtype)
            value = timed(falloff.distance, d, *c)
            for x, y in zip(value, d, strict=True):
                whole = oracles.digits.attenuation(oracles.exact(y), c)
                values.append(0.0 if x == x else np.nan)
                normal = whole > 4 * float(np.finfo(dtype).tiny)
                true.append(oracles.exact(x) / whole - 1 if normal else oracles.exact(0.0))
        yield Check(case, np.array(values), true, np.array(2.0))
    ends = np.array([0, np.inf], dtype)
    yield exactly("0 and infinity", timed(lambda: falloff.distance(ends, 4.0, 0.0, 1.0)), [0.25, 0])
    yield exactly("none", falloff.distance(ends[:0], 4.0, 0.0, 1.0).shape, [0])


def depth_cue(dtype, count, random):
    """Check the depth cue, of the larger of |I| and |Icue|."""
    for smooth in (False, True):
        values, true = [], []
        for _ in range(count // 40):
            light, cue = random.uniform(0, 2, 2).astype(dtype)
            low, high = sorted(random.uniform(0, 1, 2))
            # Powers of two and depths on their grid: no rounding of the depth itself.
            back = float(random.integers(-8, 8))
            front = back + float(2.0 ** random.integers(-3, 4))
            z = (back + (front - back) * random.integers(-64, 192, 20) / 128).astype(dtype)
            ends = DepthCue(
                front=front, back=back, front_scale=high, back_scale=low, cue=cue, smooth=smooth
            )
            work = partial(
                falloff.depth_cue, light, z, front=front, back=back, front_scale=high,
                back_scale=low, cue=cue, smooth=smooth,
            )  # fmt: skip
            value = timed(work)
            for x, depth in zip(value, z, strict=True):
                whole = oracles.digits.depth_cue(oracles.exact(light), oracles.exact(depth), ends)
                values.append(0.0 if x == x else np.nan)
                true.append((oracles.exact(x) - whole) / oracles.exact(max(light, cue)))
        yield Check("smooth" if smooth else "linear", np.array(values), true, np.array(4.0))


def fur(dtype, count, random):
    """(1 - rho)^(h / sin a); hard case 6."""
    for case, low in (("random", -6.0), ("grazing", -37.0)):
        values, true = [], []
        for j in range(count // 40):
            height = (10 ** random.uniform(-6, 3, 20)).astype(dtype)
            sine = (10 ** random.uniform(low, 0, 20)).astype(dtype)
            density = float((random.uniform(0, 1), 1e-6, 1 - 1e-6, 1e-15)[j % 4])
            value = timed(falloff.fur, height, sine, density)
            for h, a in zip(height, sine, strict=True):
                true.append(oracles.digits.fur(h, oracles.exact(a), density))
            values += value.tolist()
        yield Check(case, np.array(values), true, np.array(3.0))
    h, s = np.array([0, 0, 1, 1], dtype), np.array([0, 1, 0, 1], dtype)
    for density, ends in ((0.0, [1, 1, 1, 1]), (0.5, [1, 1, 0, 0.5]), (1.0, [1, 1, 0, 0])):
        value = timed(falloff.fur, h, s, density)
        yield exactly("density 0 and 1, height 0, sin a = 0", value, ends)
    yield exactly("none", falloff.fur(h[:0], s[:0], 0.5).shape, [0])


def reflection_by_half(dtype, count, random):
    """R.E by N.H, in units of eps / |wi + wo|; hard case 4."""
    cases = (*hard.EYES, *hard.STEEP)
    for case in cases:
        many = spread(count, cases)
        frame = hard.frames(random, many, 2, 3, dtype)
        normal = np.cross(frame[:, 0], frame[:, 1]).astype(dtype)
        wi, wo = hard.pairs(random, frame, "random", case)
        value = timed(half_vector.reflection, wi, wo, normal)
        true, claim = [], []
        for i in range(many):
            a, b, up = (oracles.unit(oracles.exact(v[i])) for v in (wi, wo, normal))
            half = [x + y for x, y in zip(a, b, strict=True)]
            true.append(2 * oracles.dot(up, a) * oracles.dot(up, b) - oracles.dot(a, b))
            size = float(oracles.size(half))
            claim.append(16 / size if size else np.inf)
        regime = "over |wi + wo|" if case.startswith("opposite") else ""
        yield Check(f"eye {case}", value, true, np.array(claim), regime)
    bad, here, up = _bad(dtype), np.array([1, 2, 3], dtype), np.array([0, 0, 1], dtype)
    nan = np.full(len(bad), np.nan)
    for place in range(3):
        given = [here, here, up]
        given[place] = bad
        yield exactly("zero, NaN, infinite", timed(half_vector.reflection, *given), nan)
    small = _denormal(dtype)
    value = timed(half_vector.reflection, small, here, up)
    yield Check("denormal", value, [_mirror(v, here, up) for v in small], 16.0)
    wi = hard.units(random, 50, 3).astype(dtype)
    value = timed(half_vector.reflection, wi, -wi, up)
    yield Check("eye exactly opposite", value, [_mirror(v, -v, up) for v in wi], 16.0)
    yield exactly("none", half_vector.reflection(wi[:0], wi[:0], up).shape, [0])


def _mirror(wi, wo, normal):
    """Return 2 (N.L)(N.E) - L.E."""
    a, b, up = (oracles.unit(oracles.exact(v)) for v in (wi, wo, normal))
    return 2 * oracles.dot(up, a) * oracles.dot(up, b) - oracles.dot(a, b)


def from_half(dtype, count, random):
    """R.E from N.H and the triple product."""
    many = count
    n_h = random.uniform(-1, 1, many).astype(dtype)
    triple = (random.uniform(-1, 1, many) * np.sqrt(1 - np.square(n_h))).astype(dtype)
    value = timed(half_vector.reflection_from_half, n_h, triple=triple)
    pairs = [tuple(map(oracles.exact, pair)) for pair in zip(n_h, triple, strict=True)]
    true = [2 * a * a - 1 + 2 * b * b for a, b in pairs]
    yield Check("random", value, true, np.array(4.0))
    ends = np.nextafter(np.array([1, -1, 0], dtype), dtype(0.5))
    value = timed(half_vector.reflection_from_half, ends)
    true = [2 * a * a - 1 for a in oracles.exact(ends)]
    yield Check("one ulp off 1, -1 and 0", value, true, np.array(4.0))


def from_angles(dtype, count, random):
    """R.E from the angles of normal, light and eye; also small ones and right ones."""
    mp, many = oracles.mp, count
    angles = random.uniform(0, np.pi / 2, (3, many))
    angles *= 10 ** (random.uniform(-20, 0, (3, many)) * random.integers(0, 2, (3, many)))
    angles = np.where(random.random((3, many)) < 1 / 3, np.pi / 2 - angles, angles).astype(dtype)
    nu, beta, theta = angles
    value = timed(half_vector.reflection_cosine, nu, beta=beta, theta=theta)
    true = []
    for a, b, c in zip(*angles, strict=True):
        cross = mp.sin(oracles.exact(b)) * mp.cos(oracles.exact(c))
        true.append(mp.cos(2 * oracles.exact(a)) + 2 * cross * cross)
    yield Check("random, small, near right", value, true, np.array(8.0))


def identity(dtype, count, random):
    """Check the identity of three unit vectors, which is 0."""
    for case in hard.EYES:
        many = spread(count, hard.EYES)
        frame = hard.frames(random, many, 1, 3, dtype)
        wi = hard.directions(random, frame, "random")
        wo = hard.eyes(random, wi, frame, case)
        value = timed(half_vector.identity, wi, wo, frame[:, 0])
        yield Check(f"eye {case}", value, [0] * many, np.array(16.0))
    bad, here = _bad(dtype), np.array([1, 2, 3], dtype)
    value = timed(half_vector.identity, bad, here, here)
    yield exactly("zero, NaN, infinite", value, np.full(len(bad), np.nan))


def required_factor(dtype, count, random):
    """Check the factor f of Fisher and Woo (5), relative: from 0 to 1.5."""
    mp = oracles.mp
    for case, low, high in (("random", -2.0, 0.17), ("near 0", -20.0, -2.0)):
        rho = np.minimum(10 ** random.uniform(low, high, count // 2), 1.5).astype(dtype)
        value = timed(highlights.required_factor, rho)
        off = []
        for x, angle in zip(value, rho, strict=True):
            a = oracles.exact(angle)
            below, above = (2 * mp.log1p(-2 * mp.sin(b) ** 2) for b in (a / 2, a / 4))
            exact = below / above if a else mp.mpf(4)
            off.append(oracles.exact(x) / exact - 1)
        yield Check(case, np.zeros(len(off)), off, np.array(8.0))


def pixel_error(dtype, count, random):
    """Blinn minus Phong, of 255, by power; hard case 5."""
    mp = oracles.mp
    powers = (10.0, 40.5, 400.0, 1e6)
    for r in powers:
        rho = (10 ** random.uniform(-8, 0.49, spread(count, powers))).astype(dtype)
        value = timed(highlights.pixel_error, rho, r)
        true = []
        for angle in rho:
            a = oracles.exact(angle)
            phong = max(mp.cos(a), mp.mpf(0)) ** oracles.exact(r)
            true.append(255 * (mp.cos(a / 2) ** (4 * oracles.exact(r)) - phong))
        claim = np.array(255 * 3.0)
        yield Check(f"power {r:g}", np.asarray(value), true, claim)


def max_pixel_error(_, count, random):
    """Check the largest difference of Phong and Blinn by a scan, Newton's method and 50 oracles."""
    powers = (0.2, 1.5, 10.0, 40.5, 400.0, 1e4, 1e6)
    for r in powers:
        many = spread(count, powers)
        angle = np.concatenate(
            [random.uniform(0, np.pi, many // 2), 10 ** random.uniform(-8, 0.4, many)]
        )[:many]
        factor = random.uniform(1.1, 6, many)
        found = timed(highlights.max_pixel_error, angle, r, factor=factor)
        true = references.largest_differences(angle, r, factor)
        yield Check(f"power {r:g}", found.error, true, 255 * 4.0)
    ends, *_ = timed(highlights.max_pixel_error, [0.0, np.pi], 0.0)
    yield exactly("power 0", ends, [0, 0])


CHECKS = {
    "frames.orthonormalize": (orthonormalize, TYPES),
    "frames.split": (split, TYPES),
    "reflection.diffuse": (diffuse, TYPES),
    "reflection.specular, Phong": (partial(specular, "phong"), TYPES),
    "reflection.specular, Blinn": (partial(specular, "blinn"), TYPES),
    "cylinder.diffuse": (partial(line_light, "diffuse"), TYPES),
    "cylinder.specular": (partial(line_light, "specular"), TYPES),
    "highlight_integral.half_integral": (half_integral, TYPES),
    "brightness.mean_intensity": (mean_intensity, DOUBLE),
    "brightness.exponent": (exponent, DOUBLE),
    "falloff.distance": (distance, TYPES),
    "falloff.depth_cue": (depth_cue, TYPES),
    "falloff.fur": (fur, TYPES),
    "half_vector.reflection": (reflection_by_half, TYPES),
    "half_vector.reflection_from_half": (from_half, TYPES),
    "half_vector.reflection_cosine": (from_angles, TYPES),
    "half_vector.identity": (identity, TYPES),
    "highlights.required_factor": (required_factor, TYPES),
    "highlights.pixel_error": (pixel_error, DOUBLE),
    "highlights.max_pixel_error": (max_pixel_error, DOUBLE),
}
