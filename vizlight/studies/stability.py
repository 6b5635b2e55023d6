"""Every kernel on its hard cases against 50 digits: what is claimed, what is seen, pass or fail.

Inputs are directed at each singularity, down to one unit in the last place from it, and random. An
error is told in eps of its type and, where the claim is in other units (over ``|wi + wo|``, of the
result, of the size), in these. A claim passes if nothing seen is above it.
"""

from __future__ import annotations

import time
import warnings
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from vizlight import _tolerance, engine
from vizlight.geometry import curves, projection, relief
from vizlight.light import Light
from vizlight.model import brightness, cylinder, falloff, half_vector, highlights, reflection
from vizlight.model import frames as spaces
from vizlight.scene import Material, Scene, View
from vizlight.studies import _hard
from vizlight.studies._study import Row, Study, words

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    Array = NDArray[Any]

#: Inputs of a kernel and a type, and in a quick run.
INPUTS, QUICK = 10_600, 600
TYPES = (np.float32, np.float64)
#: Claim of the length inside a field, of its size.
RELIEF = 3.0
SIZES = ((1, 3), (1, 2), (2, 3), (1, 4), (2, 4), (3, 8), (7, 8))
EXPONENTS = (1.0, 4.7635, 0.5, 2.0, 64.0, 65.0, 150.0, 1e3, 1e6)
SHININESS = (20.0, 1.0, 0.5, 20.5, 64.0, 65.0, 200.0, 1e4, 1e6)
CYLINDER = (20.0, 0.0, 1.0, 2.0, 5.0, 33.0, 100.0)
CYLINDER_SLOW = (0.5, 7.5, 20.5, 1e3, 1e5)


class Check(NamedTuple):
    """Results of one case: the values, the true ones, and the claim for each, in eps."""

    case: str
    values: Array
    true: Sequence[Any]
    claimed: Array
    seconds: float


def timed(work: Callable[[], Any]) -> tuple[Any, float]:
    """Return what work returns, and its seconds."""
    start = time.perf_counter()
    return work(), time.perf_counter() - start


def rows_of(kernel: str, dtype: Any, checks: Iterator[Check]) -> list[Row]:
    """Return a row for each case: the input that comes nearest to its claim, or passes it."""
    from vizlight.studies import _digits

    eps = float(np.finfo(dtype).eps)
    found: dict[str, Row] = {}
    kind = np.dtype(dtype).name
    for check in checks:
        seen, worst = 0.0, (0.0, 0.0, 0.0)
        for value, true, claimed in zip(
            np.ravel(check.values), check.true, np.broadcast_to(check.claimed, len(check.true)),
            strict=True,
        ):  # fmt: skip
            number = float(value)
            if number == number and abs(number) < np.inf:
                seen = float(abs(_digits.exact(number) - true)) / eps
            else:
                seen = 0.0 if number == true else np.inf
            worst = max(worst, (seen / float(claimed), seen, float(claimed)))
        ratio, seen, claimed = worst
        cost = 1e9 * check.seconds / max(len(check.true), 1)
        before = found.get(check.case)
        count = len(check.true) + (int(before.more["inputs"]) if before else 0)
        if before and float(before.more["seen / claimed"]) >= ratio:
            found[check.case] = before._replace(more={**before.more, "inputs": count})
            continue
        more: dict[str, float | str] = {
            "type": kind,
            "case": check.case,
            "seen / claimed": ratio,
            "inputs": count,
        }
        # Less than a millionth of eps is none.
        seen = seen if seen > 1e-6 else 0.0
        found[check.case] = Row(kernel, claimed, seen, cost, more)
    return [
        row._replace(
            more={**row.more, "": "pass" if float(row.more["seen / claimed"]) <= 1 else "FAIL"}
        )
        for row in found.values()
    ]


def _spread(count: int, kinds: Sequence[Any]) -> int:
    return max(count // len(kinds), 1)


def orthonormalize(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """|F F^T - 1|, hard case 3: nearly dependent, wildly scaled, smallest and largest numbers."""
    from vizlight.studies._digits import dot, exact

    apart = 1e-3 if dtype == np.float32 else 1e-8
    scale = 30 if dtype == np.float32 else 150
    cases = ("random", f"{apart:g} apart", f"1e±{scale} long", "smallest and largest")
    for case in cases:
        for k, n in SIZES:
            many = _spread(count, cases * len(SIZES))
            v = random.standard_normal((many, k, n))
            if case.endswith("apart"):
                v[:, 1:] = v[:, :1] + apart * v[:, 1:]
            v = v.astype(dtype)
            if case.endswith("long"):
                v = (v * 10.0 ** random.uniform(-scale, scale, (many, k, 1))).astype(dtype)
            if case.startswith("smallest"):
                info = np.finfo(dtype)
                v *= random.choice([info.tiny, info.max / 16], (many, k, 1))
            (frame, rank), seconds = timed(partial(spaces.orthonormalize, v))
            values, true = [], []
            for f, r in zip(frame, rank, strict=True):
                rows = exact(f[:r])
                off = [dot(a, b) - (i == j) for i, a in enumerate(rows) for j, b in enumerate(rows)]
                values.append(0.0 if r == k or case.endswith("apart") else np.nan)
                true.append(max(map(abs, off), default=exact(0.0)))
            yield Check(case, np.array(values), true, np.array(6.0), seconds)


def split(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """Coefficients and |x_N|, over |x|; hard case 1."""
    from vizlight.studies import _digits

    for case in _hard.DIRECTIONS:
        for k, n in SIZES:
            many = _spread(count, _hard.DIRECTIONS * len(SIZES))
            frame = _hard.frames(random, many, k, n, dtype)
            x = _hard.directions(random, frame, case)
            (along, normal), seconds = timed(partial(spaces.split, x, frame))
            values, true = [], []
            for i in range(many):
                own, f = _digits.exact(x[i]), _digits.orthonormal(_digits.exact(frame[i]))
                size = _digits.mp.sqrt(_digits.dot(own, own))
                exact_along, exact_normal = _digits.split(own, f)
                pairs = [*zip(along[i], exact_along, strict=True), (normal[i], exact_normal)]
                off = max(abs(_digits.exact(a) - b) for a, b in pairs)
                values.append(0.0 if np.all(np.isfinite(along[i])) else np.nan)
                true.append(off / size)
            yield Check(case, np.array(values), true, np.array(10.0), seconds)


def diffuse(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """sin(a)^p; hard cases 1 and 2."""
    from vizlight.studies import _digits

    eps = float(np.finfo(dtype).eps)
    for case in _hard.DIRECTIONS:
        for j, p in enumerate(EXPONENTS):
            k, n = SIZES[j % len(SIZES)]
            many = _spread(count, _hard.DIRECTIONS * len(EXPONENTS))
            frame = _hard.frames(random, many, k, n, dtype)
            wi = _hard.directions(random, frame, case)
            value, seconds = timed(partial(reflection.diffuse, wi, frame, exponent=p))
            true = [_digits.diffuse(a, f, p) for a, f in zip(wi, frame, strict=True)]
            claim = np.array(_tolerance.diffuse_bound(p, eps) / eps)
            yield Check(f"{case}{_steep(p)}", value, true, claim, seconds)
    yield _nothing(dtype, lambda v, f: reflection.diffuse(v, f, exponent=4.7635))


def _steep(power: float) -> str:
    return ", power < 1" if power < 1 else ", power > 128" if power > 128 else ""


def _nothing(dtype: Any, work: Callable[[Array, Array], Array]) -> Check:
    """Vectors without a direction: 0."""
    frame = np.eye(3, dtype=dtype)[:1]
    bad = np.array([[0, 0, 0], [np.nan, 0, 1], [np.inf, 0, 0], [-np.inf, 1, np.nan]], dtype)
    value, seconds = timed(lambda: work(bad, frame))
    return Check("zero, NaN, infinite", value, [0] * len(bad), np.array(1.0), seconds)


def specular(model: Any, dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """Phong and Blinn; hard cases 1, 2, 4, 5. Blinn's in units of eps / |wi + wo| below 1."""
    from vizlight.studies import _digits

    eps = float(np.finfo(dtype).eps)
    kinds = [(d, e) for d in ("random", "near it", "near across") for e in _hard.EYES]
    for at, case in kinds:
        for j, s in enumerate(SHININESS):
            k, n = SIZES[j % len(SIZES)]
            many = _spread(count, kinds * len(SHININESS))
            frame = _hard.frames(random, many, k, n, dtype)
            wi = _hard.directions(random, frame, at)
            wo = _hard.eyes(random, wi, frame, case)
            work = partial(reflection.specular, wi, wo, frame, shininess=s, model=model)
            value, seconds = timed(work)
            true, claim = [], np.full(many, _tolerance.specular_bound(s, eps) / eps)
            for i in range(many):
                true.append(_digits.specular(wi[i], wo[i], frame[i], s, model))
                if model == "blinn":
                    a, b = (_digits.unit(_digits.exact(v[i])) for v in (wi, wo))
                    half = [x + y for x, y in zip(a, b, strict=True)]
                    size = float(_digits.mp.sqrt(_digits.dot(half, half)))
                    share = min(size, 1.0)
                    if s < 1:
                        claim[i] = (
                            _tolerance.specular_bound(s, eps / share) / eps if share else 1e30
                        )
                    else:
                        claim[i] = claim[i] / share if share else 1e30
            yield Check(f"eye {case}{_steep(s)}", value, true, claim, seconds)
    yield _nothing(
        dtype, lambda v, f: reflection.specular(v, np.ones(3, dtype), f, shininess=3, model=model)
    )


def line_light(which: str, dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """Check the line light, in units of eps over the least of |wi_N|, |wo_N|, |wi + wo|."""
    from vizlight.studies import _digits

    kinds = [(d, e) for d in ("random", "near it", "across") for e in _hard.EYES]
    powers = (0.0,) if which == "diffuse" else CYLINDER + CYLINDER_SLOW
    for at, case in kinds:
        for s in powers:
            # mpmath's incomplete beta function takes a hundred times as long as whole powers.
            slow = which == "specular" and s in CYLINDER_SLOW
            if slow and at != "random":
                continue
            rest = 1 if which == "diffuse" else len(CYLINDER)
            many = max(count // 2000 if slow else count // (len(kinds) * rest), 1)
            frame = _hard.frames(random, many, 1, 3, dtype)
            wi = _hard.directions(random, frame, at)
            wo = _hard.eyes(random, wi, frame, case)
            t = frame[:, 0]
            if which == "diffuse":
                value, seconds = timed(partial(cylinder.diffuse, wi, wo, t))
            else:
                value, seconds = timed(partial(cylinder.specular, wi, wo, t, shininess=s))
            true, claim = [], []
            for i in range(many):
                light, shine, a, b, size = _digits.cylinder(wi[i], wo[i], t[i], s)
                least = float(b if which == "diffuse" else min(a, b, size))
                true.append(light if which == "diffuse" else shine)
                claim.append((4.0 if which == "diffuse" else 10.0) / least if least else 1e30)
            yield Check(f"light {at}, eye {case}", value, true, np.array(claim), seconds)
    up = np.array([0, 0, 1], dtype)
    calls: dict[str, Callable[[Array, Array], Array]] = {
        "diffuse": lambda v, f: cylinder.diffuse(v, up, f),
        "specular": lambda v, f: cylinder.specular(v, up, f, shininess=9),
    }
    yield _nothing(dtype, calls[which])


def mean_intensity(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """I(k, n, p) up to n = 1e6; relative, in units of (1 + |ln I|) eps; hard case 5."""
    from vizlight.studies import _digits

    for case, top in (("n to 10", 1.0), ("n to 1e6", 6.0)):
        values, true, seconds = [], [], 0.0
        for _ in range(count // 2):
            n = int(10 ** random.uniform(0.31, top))
            k = int(random.integers(1, n)) if n > 2 else 1
            p = float(10 ** random.uniform(-3, top))
            value, taken = timed(partial(brightness.mean_intensity, k, n, p))
            exact = _digits.mean_intensity(k, n, p)
            scale = exact * (1 + abs(_digits.mp.log(exact)))
            values.append(0.0 if value == value else np.nan)
            normal = exact > 4 * float(np.finfo(dtype).tiny)
            true.append((_digits.exact(value) - exact) / scale if normal else _digits.exact(0.0))
            seconds += taken
        yield Check(case, np.array(values), true, np.array(32.0), seconds)


def exponent(_: Any, count: int, random: Any) -> Iterator[Check]:
    """p(k, n) up to n = 1e6: the step of Newton's method in 50 digits; relative; hard case 5."""
    from vizlight.studies import _digits

    mp = _digits.mp
    for case, top in (("n to 10", 1.0), ("n to 1e6", 6.0)):
        values, true, seconds = [], [], 0.0
        for _i in range(count // 2):
            n = int(10 ** random.uniform(0.31, top))
            k = int(random.integers(1, n)) if n > 2 else 1
            p, taken = timed(partial(brightness.exponent, k, n))
            c, e = n - k, _digits.exact(p)
            slope = (mp.digamma((c + e) / 2) - mp.digamma((n + e) / 2)) / 2
            step = mp.log(2 * _digits.mean_intensity(k, n, e)) / slope
            values.append(0.0 if p == p else np.nan)
            true.append(step / e)
            seconds += taken
        yield Check(case, np.array(values), true, np.array(2e-14 / np.finfo(float).eps), seconds)


def distance(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """Check the attenuation, relative; hard case 8: the light on the point, and far away."""
    from vizlight.studies import _digits

    for case, low, high in (("random", -5, 8), ("near 0", -30, -5), ("far", 8, 15)):
        values, true, seconds = [], [], 0.0
        for _ in range(count // 60):
            c = 10 ** random.uniform(-3, 2, 3)
            d = (10 ** random.uniform(low, high, 20)).astype(dtype)
            value, taken = timed(partial(falloff.distance, d, *c))
            for x, y in zip(value, d, strict=True):
                a, b, e, z = (_digits.exact(v) for v in (*c, y))
                whole = 1 / max(_digits.mp.mpf(1), a + b * z + e * z * z)
                values.append(0.0 if x == x else np.nan)
                normal = whole > 4 * float(np.finfo(dtype).tiny)
                true.append(_digits.exact(x) / whole - 1 if normal else _digits.exact(0.0))
            seconds += taken
        yield Check(case, np.array(values), true, np.array(2.0), seconds)
    ends = np.array([0, np.inf], dtype)
    value, seconds = timed(lambda: falloff.distance(ends, 4.0, 0.0, 1.0))
    yield Check("0 and infinity", value, [0.25, 0], np.array(1.0), seconds)


def depth_cue(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """Check the depth cue, of the larger of |I| and |Icue|."""
    from vizlight.studies import _digits

    mp = _digits.mp
    for smooth in (False, True):
        values, true, seconds = [], [], 0.0
        for _ in range(count // 40):
            light, cue = random.uniform(0, 2, 2).astype(dtype)
            low, high = sorted(random.uniform(0, 1, 2))
            # Powers of two and depths on their grid: no rounding of the depth itself.
            back = float(random.integers(-8, 8))
            front = back + float(2.0 ** random.integers(-3, 4))
            z = (back + (front - back) * random.integers(-64, 192, 20) / 128).astype(dtype)
            work = partial(
                falloff.depth_cue, light, z, front=front, back=back, front_scale=high,
                back_scale=low, cue=cue, smooth=smooth,
            )  # fmt: skip
            value, taken = timed(work)
            for x, depth in zip(value, z, strict=True):
                t = (_digits.exact(depth) - _digits.exact(back)) / _digits.exact(front - back)
                t = min(max(t, mp.mpf(0)), mp.mpf(1))
                t = t * t * (3 - 2 * t) if smooth else t
                s = _digits.exact(low) + (_digits.exact(high) - _digits.exact(low)) * t
                whole = s * _digits.exact(light) + (1 - s) * _digits.exact(cue)
                values.append(0.0 if x == x else np.nan)
                true.append((_digits.exact(x) - whole) / _digits.exact(max(light, cue)))
            seconds += taken
        yield Check(
            "smooth" if smooth else "linear", np.array(values), true, np.array(4.0), seconds
        )


def fur(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """(1 - rho)^(h / sin a); hard case 6."""
    from vizlight.studies import _digits

    mp = _digits.mp
    for case, low in (("random", -6.0), ("grazing", -37.0)):
        values, true, seconds = [], [], 0.0
        for j in range(count // 40):
            height = (10 ** random.uniform(-6, 3, 20)).astype(dtype)
            sine = (10 ** random.uniform(low, 0, 20)).astype(dtype)
            density = float((random.uniform(0, 1), 1e-6, 1 - 1e-6, 1e-15)[j % 4])
            value, taken = timed(partial(falloff.fur, height, sine, density))
            rate = mp.log1p(-_digits.exact(density))
            for h, a in zip(height, sine, strict=True):
                true.append(mp.exp(_digits.exact(h) / _digits.exact(a) * rate))
            values += value.tolist()
            seconds += taken
        yield Check(case, np.array(values), true, np.array(3.0), seconds)
    h, s = np.array([0, 0, 1, 1], dtype), np.array([0, 1, 0, 1], dtype)
    for density, ends in ((0.0, [1, 1, 1, 1]), (0.5, [1, 1, 0, 0.5]), (1.0, [1, 1, 0, 0])):
        value, seconds = timed(partial(falloff.fur, h, s, density))
        yield Check("density 0 and 1, height 0, sin a = 0", value, ends, np.array(1.0), seconds)


def reflection_by_half(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """R.E by N.H, in units of eps / |wi + wo|; hard case 4."""
    from vizlight.studies import _digits

    for case in _hard.EYES:
        many = _spread(count, _hard.EYES)
        frame = _hard.frames(random, many, 2, 3, dtype)
        normal = np.cross(frame[:, 0], frame[:, 1]).astype(dtype)
        wi = _hard.directions(random, frame, "random")
        wo = _hard.eyes(random, wi, frame, case)
        value, seconds = timed(partial(half_vector.reflection, wi, wo, normal))
        true, claim = [], []
        for i in range(many):
            a, b, up = (_digits.unit(_digits.exact(v[i])) for v in (wi, wo, normal))
            half = [x + y for x, y in zip(a, b, strict=True)]
            true.append(2 * _digits.dot(up, a) * _digits.dot(up, b) - _digits.dot(a, b))
            size = float(_digits.mp.sqrt(_digits.dot(half, half)))
            claim.append(16 / size if size else 1e30)
        yield Check(f"eye {case}", value, true, np.array(claim), seconds)


def relations(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """R.E from N.H and from angles, and the identity of three unit vectors: 0."""
    from vizlight.studies import _digits

    mp, many = _digits.mp, count // 3
    n_h = random.uniform(-1, 1, many).astype(dtype)
    triple = (random.uniform(-1, 1, many) * np.sqrt(1 - np.square(n_h))).astype(dtype)
    value, seconds = timed(partial(half_vector.reflection_from_half, n_h, triple=triple))
    pairs = [tuple(map(_digits.exact, pair)) for pair in zip(n_h, triple, strict=True)]
    true = [2 * a * a - 1 + 2 * b * b for a, b in pairs]
    yield Check("from the half vector", value, true, np.array(4.0), seconds)
    angles = random.uniform(0, np.pi / 2, (3, many)).astype(dtype)
    nu, beta, theta = angles
    work = partial(half_vector.reflection_cosine, nu, beta=beta, theta=theta)
    value, seconds = timed(work)
    true = []
    for a, b, c in zip(*angles, strict=True):
        cross = mp.sin(_digits.exact(b)) * mp.cos(_digits.exact(c))
        true.append(mp.cos(2 * _digits.exact(a)) + 2 * cross * cross)
    yield Check("from angles", value, true, np.array(8.0), seconds)
    frame = _hard.frames(random, many, 1, 3, dtype)
    wi = _hard.directions(random, frame, "random")
    wo = _hard.eyes(random, wi, frame, "near it")
    value, seconds = timed(partial(half_vector.identity, wi, wo, frame[:, 0]))
    yield Check("identity", value, [0] * many, np.array(16.0), seconds)


def required_factor(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """Check the factor f of Fisher and Woo (5), relative: from 0 to 1.5."""
    from vizlight.studies import _digits

    mp = _digits.mp
    for case, low, high in (("random", -2.0, 0.17), ("near 0", -20.0, -2.0)):
        rho = np.minimum(10 ** random.uniform(low, high, count // 2), 1.5).astype(dtype)
        value, seconds = timed(partial(highlights.required_factor, rho))
        off = []
        for x, angle in zip(value, rho, strict=True):
            a = _digits.exact(angle)
            below, above = (2 * mp.log1p(-2 * mp.sin(b) ** 2) for b in (a / 2, a / 4))
            exact = below / above if a else mp.mpf(4)
            off.append(_digits.exact(x) / exact - 1)
        yield Check(case, np.zeros(len(off)), off, np.array(8.0), seconds)


def pixel_error(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """Blinn minus Phong, of 255, by power; hard case 5."""
    from vizlight.studies import _digits

    mp = _digits.mp
    powers = (10.0, 40.5, 400.0, 1e6)
    for r in powers:
        rho = (10 ** random.uniform(-8, 0.49, _spread(count, powers))).astype(dtype)
        value, seconds = timed(partial(highlights.pixel_error, rho, r))
        true = []
        for angle in rho:
            a = _digits.exact(angle)
            phong = max(mp.cos(a), mp.mpf(0)) ** _digits.exact(r)
            true.append(255 * (mp.cos(a / 2) ** (4 * _digits.exact(r)) - phong))
        claim = np.array(255 * 3.0)
        yield Check(f"power {r:g}", np.asarray(value), true, claim, seconds)


def tangents(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """Tangents of lines of two points, also far from the origin and repeated; hard cases 7, 11."""
    from vizlight.studies import _digits

    for case, far in (("random", 0.0), ("5e6 from the origin", 5e6)):
        many = count // 2
        points = (far + random.standard_normal((2 * many, 3))).astype(dtype)
        work = partial(
            curves.polyline_tangents, points, connectivity=np.arange(2 * many),
            offsets=np.arange(0, 2 * many + 1, 2),
        )  # fmt: skip
        value, seconds = timed(work)
        off = []
        for i in range(many):
            a, b = (_digits.exact(points[2 * i + j]) for j in (0, 1))
            way = _digits.unit([y - x for x, y in zip(a, b, strict=True)])
            off.append(
                max(abs(_digits.exact(x) - y) for x, y in zip(value[2 * i], way, strict=True))
            )
        yield Check(case, np.zeros(many), off, np.array(2.0), seconds)
    same = np.repeat(random.standard_normal((5, 3)), 2, axis=0).astype(dtype)
    work = partial(
        curves.polyline_tangents, same, connectivity=np.arange(10), offsets=np.arange(0, 11, 2)
    )
    value, seconds = timed(work)
    yield Check("repeated points", value, [0] * value.size, np.array(1.0), seconds)


def perspective(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """Projection from 4-space, relative to the image, over the depth where that is small."""
    from vizlight.studies import _digits

    near = -6.0 if dtype == np.float32 else -12.0
    for case, low in (("random", -0.3), ("near the eye", near)):
        many, d = count // 2, 2.0
        points = random.standard_normal((many, 4))
        points[:, 3] = d * (1 - 10 ** random.uniform(low, 0.3, many))
        points = points.astype(dtype)
        value, seconds = timed(partial(projection.perspective, points, distance=d))
        off, claim = [], []
        for p, image in zip(points, value, strict=True):
            x = _digits.exact(p)
            share = (2 - x[3]) / 2
            if not share:
                continue
            whole = [y / share for y in x[:3]]
            size = max(map(abs, whole))
            pairs = zip(image, whole, strict=True)
            off.append(max(abs(_digits.exact(a) - b) for a, b in pairs) / size)
            claim.append(3 / min(float(abs(share)), 1.0))
        yield Check(case, np.zeros(len(off)), off, np.array(claim), seconds)


def inside_length(_: Any, count: int, random: Any) -> Iterator[Check]:
    """Length inside a plane field, exact method, of the field's size; hard case 10.

    A plane is bilinear, so the length has a closed form: depth over the rate at which a ray rises.
    """
    from vizlight.studies import _digits

    for case, low, tilt in (
        ("flat", -1.0, 0.0),
        ("tilted", -1.0, 0.3),
        ("near the surface", -9.0, 0.3),
    ):
        fields, many = 8, max(count // 24, 1)
        off, seconds, claim = [], 0.0, RELIEF
        for _i in range(fields):
            x, y = (np.cumsum(random.uniform(0.5, 2, 9)) for _ in range(2))
            a, b = tilt * random.integers(-8, 9, 2) / 16
            z = a * x + b * y[:, np.newaxis]
            way = np.array([*random.uniform(-0.3, 0.3, 2), 1.0])
            down = 10 ** random.uniform(low, low + 1, many)
            place = np.stack([random.uniform(x[3], x[5], many), random.uniform(y[3], y[5], many)])
            points = np.stack([*place, a * place[0] + b * place[1] - down], axis=1)
            work = partial(relief.inside_length, x, y, z, points, direction=way, method="exact")
            value, taken = timed(work)
            seconds += taken
            size = _digits.exact(float(max(x[-1] - x[0], y[-1] - y[0])))
            u = _digits.unit(_digits.exact(way))
            rate = u[2] - _digits.exact(a) * u[0] - _digits.exact(b) * u[1]
            for p, found in zip(points, value, strict=True):
                px, py, pz = _digits.exact(p)
                depth = _digits.exact(a) * px + _digits.exact(b) * py - pz
                off.append((_digits.exact(found) - depth / rate) / size)
        yield Check(case, np.zeros(len(off)), off, np.array(claim), seconds)
    mp, off, seconds = _digits.mp, [], 0.0
    corners = np.array([0.0, 1.0])
    for _i in range(8):
        c = random.integers(-16, 17) / 16
        # z = c x y over one cell: along a ray a quadratic, whose first root is where it leaves.
        way = np.array([*random.uniform(-0.2, 0.2, 2), 1.0])
        place = random.uniform(0.4, 0.6, (max(count // 32, 1), 2))
        down = 10 ** random.uniform(-9, -1, len(place))
        points = np.column_stack([place, c * place[:, 0] * place[:, 1] - down])
        z = np.array([[0, 0], [0, c]])
        work = partial(
            relief.inside_length, corners, corners, z, points, direction=way, method="exact"
        )
        value, taken = timed(work)
        seconds += taken
        u, twist = _digits.unit(_digits.exact(way)), _digits.exact(c)
        for p, found in zip(points, value, strict=True):
            px, py, pz = _digits.exact(p)
            # c (px + u t)(py + v t) - pz - w t = 0, by the form that does not cancel.
            low = twist * px * py - pz
            middle = twist * (px * u[1] + py * u[0]) - u[2]
            high = twist * u[0] * u[1]
            root = 2 * low / (-middle + mp.sqrt(middle * middle - 4 * high * low))
            off.append(_digits.exact(found) - root)
    yield Check("twisted", np.zeros(len(off)), off, np.array(RELIEF), seconds)


def shade(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """Check the engine's light of lines, light and eye nearby, also far off; hard cases 7, 8."""
    from vizlight.studies import _digits

    eps = float(np.finfo(dtype).eps)
    for case, far in (("random", 0.0), ("5e6 from the origin", 5e6)):
        centre = np.array([far, -far, far])
        points = (centre + random.standard_normal((count // 2, 3))).astype(dtype)
        line = random.standard_normal((count // 2, 3)).astype(dtype)
        scene = Scene(
            lights=Light(position=centre + np.array([1.0, 2.0, 3.0])),
            view=View(position=centre + np.array([0.0, 1.0, 5.0])),
            material=Material(ambient=0.0, diffuse=1.0, specular=1.0),
        )
        work = partial(engine.shade, points, line, scene, precision=np.dtype(dtype).name)
        shading, seconds = timed(work)
        p = shading.plan.exponent
        true = []
        ends = [_digits.exact(centre + np.array(v)) for v in ((1.0, 2.0, 3.0), (0.0, 1.0, 5.0))]
        for at, t in zip(points, line, strict=True):
            wi, wo = ([a - b for a, b in zip(end, _digits.exact(at), strict=True)] for end in ends)
            total = _digits.diffuse(wi, [t], p)
            true.append(total + _digits.specular(wi, wo, [t], 20.0, "phong"))
        claim = (_tolerance.diffuse_bound(p, eps) + _tolerance.specular_bound(20.0, eps)) / eps
        yield Check(case, shading.luminance, true, np.array(claim), seconds)


KERNELS: dict[str, tuple[Callable[..., Iterator[Check]], tuple[Any, ...]]] = {
    "frames.orthonormalize": (orthonormalize, TYPES),
    "frames.split": (split, TYPES),
    "reflection.diffuse": (diffuse, TYPES),
    "reflection.specular, Phong": (partial(specular, "phong"), TYPES),
    "reflection.specular, Blinn": (partial(specular, "blinn"), TYPES),
    "cylinder.diffuse": (partial(line_light, "diffuse"), TYPES),
    "cylinder.specular": (partial(line_light, "specular"), TYPES),
    "brightness.mean_intensity": (mean_intensity, (np.float64,)),
    "brightness.exponent": (exponent, (np.float64,)),
    "falloff.distance": (distance, TYPES),
    "falloff.depth_cue": (depth_cue, TYPES),
    "falloff.fur": (fur, TYPES),
    "half_vector.reflection": (reflection_by_half, TYPES),
    "half_vector, relations": (relations, TYPES),
    "highlights.required_factor": (required_factor, TYPES),
    "highlights.pixel_error": (pixel_error, (np.float64,)),
    "curves.polyline_tangents": (tangents, TYPES),
    "projection.perspective": (perspective, TYPES),
    "relief.inside_length": (inside_length, (np.float64,)),
    "engine.shade": (shade, TYPES),
}


def measure(kernel: str, dtype: Any, count: int) -> list[Row]:
    """Return the rows of one kernel in one type."""
    work, _ = KERNELS[kernel]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return rows_of(kernel, dtype, work(dtype, count, np.random.default_rng(50)))


def steps(quick: bool) -> list[Callable[[], list[Row]]]:
    """Return a step for each kernel and type."""
    from vizlight.studies import _digits  # noqa: F401 - says at once what is missing

    count = QUICK if quick else INPUTS
    return [
        partial(measure, kernel, dtype, count)
        for kernel, (_, types) in KERNELS.items()
        for dtype in types
    ]


def loosest(rows: Sequence[Row]) -> dict[str, float]:
    """Return for each kernel how many times its claim is what was seen at worst."""
    worst: dict[str, float] = {}
    for row in rows:
        kernel = row.way
        worst[kernel] = max(worst.get(kernel, 0.0), float(row.more["seen / claimed"]))
    return {kernel: 1 / ratio if ratio else np.inf for kernel, ratio in worst.items()}


def verdict(rows: Sequence[Row]) -> str:
    """Return what holds, what does not, and how tight the claims are."""
    failed = [
        f"{row.way}, {row.more['type']} ({row.more['case']})"
        for row in rows
        if row.more[""] == "FAIL"
    ]
    inputs = sum(int(row.more["inputs"]) for row in rows)
    slack = loosest(rows)
    loose = [f"{kernel} {words(ratio)}" for kernel, ratio in slack.items() if ratio > 8]
    said = (
        f"do not rely on the claims of {'; '.join(failed)}" if failed
        else f"rely on the docstrings: all {len(rows)} claims hold on {inputs} inputs"
    )  # fmt: skip
    tight = (
        f"claims more than 8 times what is seen: {', '.join(loose)}" if loose
        else f"every claim is within {words(max(slack.values()))} times what is seen"
    )  # fmt: skip
    return f"{said}; {tight}"


STUDY = Study(
    approximates="every kernel in float32 and float64 on its hard cases",
    reference="mpmath at 50 digits",
    parameter="claimed, eps",
    error="seen, eps",
    cost="ns an input",
    steps=steps,
    verdict=verdict,
    axes=("parameter", "error"),
    joined=False,
)
