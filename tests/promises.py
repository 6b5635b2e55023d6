"""Every stated bound against formulas, quadrature, random numbers and rays of this file's own.

``python tests/promises.py [FACTOR]`` computes each promise again on FACTOR times as many cases and
writes ``gallery/pages/promises.csv``: the thing, the cases, the worst error, and the stated bound.
The truth uses nothing of the package's mathematics: it is written anew, in 40 digits by mpmath, by
quadrature, or by rays in NumPy. ``tests/test_promises.py`` runs a part.
"""

from __future__ import annotations

import csv
import math
import sys
import tempfile
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import mpmath
import numpy as np
import pyvista as pv
from scipy.spatial import cKDTree

import vizlight
from vizlight import Bundle, Light, Material, Scene, View
from vizlight.geometry import relief
from vizlight.geometry.lines import curves, fur
from vizlight.model import (
    brightness,
    cylinder,
    falloff,
    frames,
    half_vector,
    highlights,
    reflection,
)

PAGE = Path(__file__).parents[1] / "gallery" / "pages" / "promises.csv"
KINDS = (np.float32, np.float64)


class Promise(NamedTuple):
    """What was promised of a thing, and what was found.

    ``worst`` is the largest error as a share of the bound, ``error`` that error itself.
    """

    thing: str
    cases: int
    error: float
    worst: float
    stated: str


class Worst:
    """The largest error so far, as a share of its bound."""

    def __init__(self) -> None:
        self.cases, self.worst, self.error = 0, 0.0, 0.0

    def add(self, found, true, bound) -> None:
        self.cases += 1
        error = abs(float(mpmath.mpf(float(found)) - true))
        assert math.isfinite(error)
        if error >= self.worst * float(bound):
            self.worst, self.error = error / float(bound), error

    def of(self, thing: str, stated: str) -> Promise:
        return Promise(thing, self.cases, self.error, self.worst, stated)


def mp(row):
    return [mpmath.mpf(float(x)) for x in row]


def dot(a, b):
    return mpmath.fsum(x * y for x, y in zip(a, b, strict=True))


def size(a):
    return mpmath.sqrt(dot(a, a))


def across(v, rows):
    """Return the part of a vector across the space of orthonormal rows."""
    for row in rows:
        along = dot(v, row)
        v = [x - along * y for x, y in zip(v, row, strict=True)]
    return v


def directions(random, n, kind, *, near=None):
    """Return a direction in a type of numbers, near another one or not."""
    v = (
        random.standard_normal(n)
        if near is None
        else near + 10.0 ** random.uniform(-7, -1) * random.standard_normal(n)
    )
    return (v / np.linalg.norm(v)).astype(kind)


def frame_of(random, k, n, kind):
    return np.linalg.qr(random.standard_normal((n, k)))[0].T.astype(kind)


def exact(rows):
    """Return rows of numbers of a computer, orthonormal in 40 digits."""
    made = []
    for row in rows:
        rest = across(across(mp(row), made), made)
        made.append([x / size(rest) for x in rest])
    return made


def unit(row):
    v = mp(row)
    return [x / size(v) for x in v]


def reflections(random, times):
    """Banks' diffuse and specular terms in n-space, from the residual and from mirror vectors."""
    found = {name: Worst() for name in ("diffuse", "phong", "blinn", "split", "frame")}
    for kind in KINDS:
        eps = float(np.finfo(kind).eps)
        for _ in range(60 * times):
            n = int(random.integers(2, 9))
            k = int(random.integers(1, n))
            frame = frame_of(random, k, n, kind)
            wi = directions(random, n, kind, near=frame[0] if random.random() < 0.4 else None)
            wo = directions(random, n, kind, near=-wi if random.random() < 0.2 else None)
            rows, i, o = exact(frame), unit(wi), unit(wo)
            across_i, across_o = across(i, rows), across(o, rows)
            sine = size(across_i)
            p = float(random.choice([0.3, 1, 2, 7, 100, 1000]))
            bound = (8 * eps) ** p if p < 1 else ((4 + 2 * p) if p <= 128 else 8 + p**0.5) * eps
            got = reflection.diffuse(wi, frame, exponent=p)
            found["diffuse"].add(got, sine**p, bound)
            s = float(random.choice([0.5, 1, 8, 40, 128, 1e3, 1e5]))
            # The mirror direction: its tangential part is turned, its normal part points to wo's.
            along_i = [x - y for x, y in zip(i, across_i, strict=True)]
            along_o = [x - y for x, y in zip(o, across_o, strict=True)]
            mirror = sine * size(across_o) - dot(along_i, along_o)
            limit = (8 * eps) ** s if s < 1 else ((4 + s) if s <= 128 else 8 + 3 * s**0.5) * eps
            got = reflection.specular(wi, wo, frame, shininess=s)
            found["phong"].add(got, max(mirror, mpmath.mpf(0)) ** s, limit)
            half = [x + y for x, y in zip(i, o, strict=True)]
            length = size(half)
            if length > 1e-6:
                true = (size(across(half, rows)) / length) ** s
                got = reflection.specular(wi, wo, frame, shininess=s, model="blinn")
                own = eps / min(float(length), 1.0)
                limit = (8 * own) ** s if s < 1 else limit / eps * own
                found["blinn"].add(got, true, limit)
            x = random.standard_normal(n).astype(kind)
            found["split"].add(
                frames.split(x, frame)[1], size(across(mp(x), rows)), 10 * eps * np.linalg.norm(x)
            )
            made = frames.orthonormalize(random.standard_normal((k, n)).astype(kind))[0]
            gram = [[dot(mp(a), mp(b)) for b in made] for a in made]
            off = max(abs(gram[a][b] - (a == b)) for a in range(k) for b in range(k))
            found["frame"].add(off, 0, 6 * eps)
    yield found["diffuse"].of("reflection.diffuse", "(4 + 2 p) eps; (8 + sqrt p) eps; (8 eps)^p")
    yield found["phong"].of(
        "reflection.specular, Phong", "(4 + s) eps; (8 + 3 sqrt s) eps; (8 eps)^s"
    )
    yield found["blinn"].of(
        "reflection.specular, Blinn", "the same, eps over the length of wi + wo"
    )
    yield found["split"].of("frames.split", "10 eps times the length of x")
    yield found["frame"].of("frames.orthonormalize", "6 eps")


def cylinders(random, times):
    """The light of a thin cylinder by quadrature over its visible half."""
    diffuse, specular = Worst(), Worst()
    for kind in KINDS:
        eps = float(np.finfo(kind).eps)
        for _ in range(12 * times):
            t = directions(random, 3, kind)
            wi = directions(random, 3, kind, near=t if random.random() < 0.3 else None)
            wo = directions(random, 3, kind, near=wi if random.random() < 0.3 else None)
            (line,), i, o = exact([t]), unit(wi), unit(wo)
            i_n, o_n = across(i, [line]), across(o, [line])
            a, b = size(i_n), size(o_n)
            h = [x + y for x, y in zip(i, o, strict=True)]
            if min(a, b, size(h)) < 1e-5:
                continue
            u = [x / b for x in o_n]
            v = [
                line[1] * u[2] - line[2] * u[1],
                line[2] * u[0] - line[0] * u[2],
                line[0] * u[1] - line[1] * u[0],
            ]

            def mean(f, *, at):
                # Normals u cos x + v sin x, weighted by their projected width cos x / 2.
                cuts = sorted(
                    {-mpmath.pi / 2, mpmath.pi / 2, *(x for x in at if abs(x) < mpmath.pi / 2)}
                )
                return mpmath.quad(lambda x: f(x) * mpmath.cos(x) / 2, cuts)

            light = mpmath.atan2(dot(i, v), dot(i, u))
            ends = [light + e * mpmath.pi / 2 for e in (-3, -1, 1, 3)]
            lit = lambda x: max(mpmath.mpf(0), a * mpmath.cos(x - light))  # noqa: B023, E731
            diffuse.add(cylinder.diffuse(wi, wo, t), mean(lit, at=ends), 4 * eps / float(b))
            s = float(random.choice([1, 2.5, 8, 30, 100]))
            peak = mpmath.atan2(dot(h, v), dot(h, u))
            share = size(across(h, [line])) / size(h)

            def shine(x):
                if mpmath.cos(x - light) <= 0:  # noqa: B023
                    return mpmath.mpf(0)
                return max(mpmath.mpf(0), share * mpmath.cos(x - peak)) ** s  # noqa: B023

            around = [peak + w / mpmath.sqrt(s) for w in (-6, -2, 0, 2, 6)]
            true = mean(shine, at=[*ends, *around, *(peak + e * mpmath.pi / 2 for e in (-1, 1))])
            limit = 10 * eps / float(min(a, b, size(h)))
            specular.add(cylinder.specular(wi, wo, t, shininess=s), true, limit)
    yield diffuse.of("cylinder.diffuse", "4 eps over the length of wo_N")
    yield specular.of("cylinder.specular", "10 eps / d")


def brightnesses(random, times):
    """Mean brightness as an integral over the sphere, and the exponent that makes it 1/2."""
    mean, root, eps = Worst(), Worst(), float(np.finfo(float).eps)
    for _ in range(25 * times):
        n = int(random.integers(2, 12))
        k, p = int(random.integers(1, n)), float(10 ** random.uniform(-2, 3))
        c = n - k

        def integral(power):
            # |x_N| = sin t on the sphere has the density sin^(c-1) cos^(k-1).
            weight = lambda t: mpmath.sin(t) ** (c - 1) * mpmath.cos(t) ** (k - 1)  # noqa: B023, E731
            cuts = [0, mpmath.pi / 4, mpmath.pi / 2 - 0.3 / mpmath.sqrt(1 + power), mpmath.pi / 2]
            cuts = sorted(cuts)
            part = mpmath.quad(lambda t: weight(t) * mpmath.sin(t) ** power, cuts)
            return part / mpmath.quad(weight, cuts)

        true = integral(p)
        mean.add(
            brightness.mean_intensity(k, n, p), true, 32 * eps * (1 + abs(mpmath.log(true))) * true
        )
        got = brightness.exponent(k, n)
        true = mpmath.findroot(lambda power: integral(power) - 0.5, (got * 0.99, got * 1.01))
        root.add(got, true, 2e-14 * true)
    yield mean.of("brightness.mean_intensity", "32 eps (1 + abs(ln I)), relative")
    yield root.of("brightness.exponent", "2e-14, relative")


def highlight_errors(random, times):
    """Phong's highlight less Blinn's, in one plane and anywhere."""
    factor, error, most, sphere, rate = (Worst() for _ in range(5))
    eps = float(np.finfo(float).eps)
    for _ in range(150 * times):
        rho = float(random.uniform(0.01, 1.5))
        true = mpmath.log(mpmath.cos(rho)) / mpmath.log(mpmath.cos(mpmath.mpf(rho) / 2))
        factor.add(highlights.required_factor(rho), true, 8 * eps * true)
        r, f = float(10 ** random.uniform(0, 5)), float(random.uniform(1, 8))
        cosine = [max(mpmath.cos(mpmath.mpf(rho) / d), mpmath.mpf(0)) for d in (1, 2)]
        true = 255 * (cosine[1] ** (f * r) - cosine[0] ** r)
        got = highlights.pixel_error(rho, r, factor=f)
        error.add(
            got, true if abs(float(got) - true) < abs(float(got) + true) else -true, 255 * 3 * eps
        )
    for _ in range(6 * times):
        angle, r, f = (
            float(random.uniform(0.1, 2.8)),
            float(10 ** random.uniform(0.3, 4)),
            float(random.uniform(1, 6)),
        )
        square = mpmath.cos(mpmath.mpf(angle) / 2) ** 2
        best = mpmath.mpf(0)
        for a in (2 * square, mpmath.mpf(2)):
            f_of = lambda x: 255 * (max(1 - a * x, mpmath.mpf(0)) ** r - (1 - x) ** (f * r / 2))  # noqa: B023, E731
            near_end = (1 - np.geomspace(1e-9, 1, 400)) / float(a)
            grid = np.concatenate([np.geomspace(1e-9, 1, 4000), near_end])
            grid = grid[grid <= 1]
            values = [f_of(mpmath.mpf(float(x))) for x in grid]
            at = float(grid[int(np.argmax([abs(v) for v in values]))])
            low, high = mpmath.mpf(at) * 0.99, mpmath.mpf(min(at * 1.01, 1.0))
            for _ in range(120):
                one, other = low + (high - low) * 0.382, low + (high - low) * 0.618
                low, high = (low, other) if abs(f_of(one)) > abs(f_of(other)) else (one, high)
            best = max(best, abs(f_of((low + high) / 2)))
        most.add(
            abs(float(highlights.max_pixel_error(angle, r, factor=f).error)), best, 255 * 4 * eps
        )
    for _ in range(2 * times):
        angle, r = float(random.uniform(0.2, 2.5)), float(random.uniform(5, 60))
        light, eye = (np.array([s * np.sin(angle / 2), 0, np.cos(angle / 2)]) for s in (1, -1))
        h = (light + eye) / np.linalg.norm(light + eye)

        # Longitude about the axis across light and eye: the bright set is a lune.
        nodes, weights = np.polynomial.legendre.leggauss(600)
        t, phi = np.meshgrid(nodes * np.pi / 2, nodes * (np.pi - angle) / 2)
        normal = np.stack([np.cos(t) * np.sin(phi), np.sin(t), np.cos(t) * np.cos(phi)], axis=-1)
        mirror = np.maximum(2 * (normal @ light) * (normal @ eye) - light @ eye, 0) ** r
        off = 255 * (mirror - np.maximum(normal @ h, 0) ** (4 * r))
        area = np.outer(weights, weights) * np.cos(t)
        rms = np.sqrt(np.sum(area * off**2) / np.sum(area))
        sphere.add(highlights.sphere_error(angle, r), rms, 1e-4 * rms)
    for angle in np.radians(random.uniform(1, 170, 20 * times)):
        cosine = mpmath.cos(mpmath.mpf(float(angle)) / 2)
        for (k, n), true in (
            ((2, 3), 4 * cosine),
            ((1, 2), mpmath.mpf(4)),
            ((1, 3), (4 * cosine / (1 + cosine)) ** 2),
        ):
            rate.add(highlights.exchange_rate(float(angle), k=k, n=n), true, 1e-12 * true)
    yield factor.of("highlights.required_factor", "8 eps, relative")
    yield error.of("highlights.pixel_error", "255 (3 eps)")
    yield most.of("highlights.max_pixel_error", "255 (4 eps)")
    yield sphere.of("highlights.sphere_error", "1e-4, relative")
    yield rate.of("highlights.exchange_rate", "1e-12, relative")


def half_vectors(random, times):
    """Fisher and Woo's identities by vectors."""
    from_half, found, zero, of_angles = (Worst() for _ in range(4))
    for kind in KINDS:
        eps = float(np.finfo(kind).eps)
        for _ in range(60 * times):
            n, wi, wo = (directions(random, 3, kind) for _ in range(3))
            m, i, o = unit(n), unit(wi), unit(wo)
            h = [x + y for x, y in zip(i, o, strict=True)]
            if size(h) < 1e-3:
                continue
            mirror = 2 * dot(m, i) * dot(m, o) - dot(i, o)
            found.add(half_vector.reflection(wi, wo, n), mirror, 16 * eps / float(size(h)))
            x = kind(random.uniform(0, 1))
            t = kind(random.uniform(-0.5, 0.5))
            got = half_vector.reflection_from_half(x, triple=t)
            from_half.add(
                got, 2 * mpmath.mpf(float(x)) ** 2 - 1 + 2 * mpmath.mpf(float(t)) ** 2, 4 * eps
            )
            zero.add(half_vector.identity(wi, wo, n), 0, 16 * eps)
            # N from its angles to H and to the pole of the plane of light and eye.
            to_pole = kind(random.uniform(0, np.pi))
            to_half = kind(random.uniform(abs(np.pi / 2 - float(to_pole)), np.pi / 2))
            aside = kind(random.uniform(0, np.pi / 2))
            a, b, c = (mpmath.mpf(float(v)) for v in (to_half, aside, to_pole))
            rest = 1 - mpmath.cos(a) ** 2 - mpmath.cos(c) ** 2
            up = [mpmath.sqrt(max(rest, mpmath.mpf(0))), mpmath.cos(c), mpmath.cos(a)]
            light, eye = ([e * mpmath.sin(b), mpmath.mpf(0), mpmath.cos(b)] for e in (1, -1))
            if rest > 0:
                true = 2 * dot(up, light) * dot(up, eye) - dot(light, eye)
                got = half_vector.reflection_cosine(to_half, beta=aside, theta=to_pole)
                of_angles.add(got, true, 8 * eps)
    yield zero.of("half_vector.identity", "16 eps")
    yield of_angles.of("half_vector.reflection_cosine", "8 eps")
    yield found.of("half_vector.reflection", "16 eps over the length of wi + wo")
    yield from_half.of("half_vector.reflection_from_half", "4 eps")


def falloffs(random, times):
    distance, cue, fur = Worst(), Worst(), Worst()
    for kind in KINDS:
        eps = float(np.finfo(kind).eps)
        for _ in range(100 * times):
            d, c = kind(10 ** random.uniform(-3, 4)), [float(x) for x in random.uniform(0.1, 2, 3)]
            true = min(
                mpmath.mpf(1),
                1 / (c[0] + c[1] * mpmath.mpf(float(d)) + c[2] * mpmath.mpf(float(d)) ** 2),
            )
            distance.add(falloff.distance(d, *c), true, 2 * eps * true)
            value, z, front, back = (kind(x) for x in random.uniform(-3, 3, 4))
            one, other, own = (float(x) for x in random.random(3))
            for smooth in (False, True):
                got = falloff.depth_cue(
                    abs(value), z, front=float(front), back=float(back), front_scale=one,
                    back_scale=other, cue=own, smooth=smooth,
                )  # fmt: skip
                u = (mpmath.mpf(float(z)) - float(front)) / (mpmath.mpf(float(back)) - float(front))
                u = min(max(u, mpmath.mpf(0)), mpmath.mpf(1))
                u = u * u * (3 - 2 * u) if smooth else u
                s = one + u * (mpmath.mpf(other) - one)
                true = s * abs(mpmath.mpf(float(value))) + (1 - s) * mpmath.mpf(own)
                cue.add(got, true, 4 * eps * max(abs(float(value)), own))
            h, sine = kind(10 ** random.uniform(-3, 2)), kind(10 ** random.uniform(-4, 0))
            rho = float(random.choice([0.0, 1e-12, 0.1, 0.7, 0.999]))
            true = (1 - mpmath.mpf(rho)) ** (mpmath.mpf(float(h)) / mpmath.mpf(float(sine)))
            fur.add(falloff.fur(h, sine, rho), true, 3 * eps)
    yield distance.of("falloff.distance", "2 eps, relative")
    yield cue.of("falloff.depth_cue", "4 eps max(abs(I), abs(Icue)), exact depths")
    yield fur.of("falloff.fur", "3 eps")


def inside(x, y, z, start, way):
    """Return the length of a ray below a bilinear field, and the number of crossings."""
    cuts = [0.0, max((z.max() - start[2]) / way[2], 0.0)]
    for nodes, axis in ((x, 0), (y, 1)):
        cuts += (
            [s for s in (nodes - start[axis]) / way[axis] if 0 < s < cuts[1]]
            if abs(way[axis]) > 1e-14
            else []
        )
    total, crossings = mpmath.mpf(0), 0
    for low, high in pairwise(np.unique(cuts)):
        middle = np.clip(start + (low + high) / 2 * way, [x[0], y[0], -9e9], [x[-1], y[-1], 9e9])
        i, j = (
            min(max(np.searchsorted(n, p, "right") - 1, 0), len(n) - 2)
            for n, p in ((x, middle[0]), (y, middle[1]))
        )

        def above(s):
            p = [
                mpmath.mpf(float(a)) + s * mpmath.mpf(float(b))
                for a, b in zip(start, way, strict=True)
            ]
            u, v = (
                min(max(c, mpmath.mpf(float(n[0]))), mpmath.mpf(float(n[-1])))
                for c, n in ((p[0], x), (p[1], y))
            )
            u, v = (u - x[i]) / (x[i + 1] - x[i]), (v - y[j]) / (y[j + 1] - y[j])  # noqa: B023
            a, b, c, d = (mpmath.mpf(float(z[j + q, i + r])) for q in (0, 1) for r in (0, 1))  # noqa: B023
            return a * (1 - u) * (1 - v) + b * u * (1 - v) + c * (1 - u) * v + d * u * v - p[2]

        lo, hi = mpmath.mpf(low), mpmath.mpf(high)
        f0, f1, f2 = above(lo), above((lo + hi) / 2), above(hi)
        two, one = 2 * (f0 - 2 * f1 + f2), 4 * f1 - 3 * f0 - f2
        roots = []
        if abs(two) > mpmath.mpf(10) ** -30:
            square = one * one - 4 * two * f0
            roots = (
                [(-one + e * mpmath.sqrt(square)) / (2 * two) for e in (-1, 1)]
                if square > 0
                else []
            )
        elif one:
            roots = [-f0 / one]
        ends = sorted([mpmath.mpf(0), *(r for r in roots if 0 < r < 1), mpmath.mpf(1)])
        crossings += len(ends) - 2
        for one_end, other_end in pairwise(ends):
            at = (one_end + other_end) / 2
            total += (hi - lo) * (other_end - one_end) * (f0 + at * (one + at * two) > 0)
    return total, crossings


def reliefs(random, times):
    """Lengths below rough fields, one of them of integers with rays in planes of nodes; a plane."""
    length, plane, eps = Worst(), Worst(), float(np.finfo(float).eps)
    for number in range(4 * times):
        whole = number % 2
        x, y = (
            (np.arange(9.0), np.arange(8.0))
            if whole
            else (np.sort(random.uniform(0, 9, n)) for n in (9, 8))
        )
        z = random.integers(0, 5, (8, 9)).astype(float) if whole else random.uniform(0, 4, (8, 9))
        scale = max(np.ptp(x), np.ptp(y), np.ptp(z))
        for azimuth in (0, 90, 180, 270) if whole else random.uniform(0, 360, 4):
            e, a = np.radians([random.uniform(10, 80), azimuth])
            way = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
            way[np.abs(way) < 1e-15] = 0
            way /= np.linalg.norm(way)
            start = np.stack(
                [random.choice(x, 8), random.choice(y, 8), random.uniform(-1, 4, 8)], axis=1
            )
            got = relief.inside_length(x, y, z, start, direction=way, method="exact")
            for place, own in zip(start, got, strict=True):
                true, crossings = inside(x, y, z, place, way)
                length.add(own, true, 3 * eps * scale * max(crossings, 1) + 4 * eps * float(true))
    for _ in range(20 * times):
        x, y = np.linspace(0, 5, 7), np.linspace(-2, 2, 6)
        a, b = random.uniform(-1.5, 1.5, 2)
        z = a * x + b * y[:, np.newaxis]
        n = np.array([-a, -b, 1]) / np.sqrt(1 + a * a + b * b)
        way = np.append(random.standard_normal(2), abs(random.standard_normal()) + 0.2)
        way /= np.linalg.norm(way)
        d = float(10 ** random.uniform(-3, -0.5))
        # Beyond the border the heights go on level: only the inner nodes see the plane alone.
        t = relief.shadow(x, y, z, depth=d, direction=way, method="exact")
        if n @ way > 0.3:
            inner = t[2:-2, 2:-2]
            if d / (n @ way) < 0.8:
                for value in inner.ravel():
                    m = mp([-a, -b, 1])
                    w = mp(way)
                    true = dot(m, w) / size(m) / size(w)
                    plane.add(value, true, (8 + max(5.0, np.ptp(z)) / d) * eps)
    yield length.of("relief.inside_length, exact", "3 eps S for each crossing")
    yield plane.of("relief.shadow on a plane, exact", "(8 + S/d) eps")


def tangents(random, times):
    two, more = Worst(), Worst()
    for kind in KINDS:
        eps = float(np.finfo(kind).eps)
        for _ in range(40 * times):
            points = (random.standard_normal((5, 3)) * 10).astype(kind)
            got = curves.polyline_tangents(points[:2])
            true = unit(np.asarray(points[1], float) - np.asarray(points[0], float))
            off = max(abs(mpmath.mpf(float(g)) - t) for g, t in zip(got[0], true, strict=True))
            two.add(off, 0, eps + np.finfo(float).eps)
            got = curves.polyline_tangents(points)
            rows = [mp(p) for p in points]
            steps = [[b - a for a, b in zip(p, q, strict=True)] for p, q in pairwise(rows)]
            h, u = [size(s) for s in steps], [[c / size(s) for c in s] for s in steps]
            at = [(h[2] * a + h[1] * b) / (h[1] + h[2]) for a, b in zip(u[1], u[2], strict=True)]
            true = [c / size(at) for c in at]
            off = max(abs(mpmath.mpf(float(g)) - t) for g, t in zip(got[2], true, strict=True))
            more.add(off, 0, (eps + 4 * np.finfo(float).eps) / float(size(at)))
    yield two.of("tangents of a line of two points", "1 eps of the points and 1 of float64")
    yield more.of("tangents of longer lines", "1 eps and 4 of float64, by the length before")


def gaps(random, times):
    """The farthest place from evenly spaced lines of a plane, by many places."""
    worst = Worst()
    for _ in range(2 * times):
        sheet = pv.Plane(i_size=4, j_size=3, i_resolution=24, j_resolution=18).triangulate()
        x, y, _ = sheet.points.T
        turn = random.uniform(0, 6)
        sheet["V"] = np.stack([np.cos(0.6 * y + turn), np.sin(0.5 * x + turn), 0 * x], axis=1)
        lines = vizlight.streamlines(sheet, vectors="V", spacing=0.3)
        stated = float(np.ravel(lines.field_data["largest_gap"])[0])
        dense = []
        for i in range(lines.n_cells):
            p = np.asarray(lines.get_cell(i).points, float)
            steps = [np.linspace(a, b, 40, endpoint=False) for a, b in pairwise(p)]
            dense += [*steps, p[-1:]]
        grid = np.stack(
            np.meshgrid(np.linspace(-2, 2, 1201), np.linspace(-1.5, 1.5, 901)), axis=-1
        ).reshape(-1, 2)
        places = np.column_stack([grid, np.zeros(len(grid))])
        far = cKDTree(np.concatenate(dense)).query(places)[0].max() / 0.3
        worst.add(stated, far, 0.015)
    yield worst.of(
        "largest_gap of evenly spaced lines", "0.01 spacings (and 0.005 of the grid here)"
    )


def bands(random, times):
    """Bands on a sphere, each against Lambert's law at places of its polygons."""
    worst = Worst()
    for _ in range(3 * times):
        toward = random.standard_normal(3)
        scene = Scene(
            lights=Light(direction=toward), view=View(direction=(0, 0, 1)),
            material=Material(ambient=0.1, diffuse=0.8, specular=0.0),
        )  # fmt: skip
        ball = vizlight.Sphere((0.3, 0.2, -1), 2.0)
        made = vizlight.isoluminance(ball, scene, levels=int(random.integers(4, 12)))["bands"]
        stated = float(np.ravel(made.field_data["luminance_error"])[0])
        for i in random.choice(made.n_cells, 40):
            corners = np.asarray(made.get_cell(int(i)).points, float)
            share = random.dirichlet(np.ones(len(corners)))
            n = share @ corners - [0.3, 0.2, -1]
            n /= np.linalg.norm(n)
            true = 0.1 + 0.8 * max(n @ toward / np.linalg.norm(toward), 0)
            worst.add(made.cell_data["luminance"][i], true, stated * (1 + 1e-9))
    yield worst.of("isoluminance of a sphere", "luminance_error of the result")


def refined(random, times):
    """Places on a refined sheet against Phong's law of normals that are interpolated linearly."""
    share, total, worst = 0, 0, 0.0
    scene = Scene(
        lights=Light(direction=(0.3, 0.5, 1)), view=View(direction=(0, 0.2, 1)),
        material=Material(ambient=0.1, diffuse=0.5, specular=0.4, shininess=30),
    )  # fmt: skip
    for _ in range(times):
        sheet = pv.Plane(i_resolution=12, j_resolution=12).triangulate()
        p = np.asarray(sheet.points)
        n = np.column_stack([np.sin(5 * p[:, 0]), np.sin(4 * p[:, 1] + 1), np.full(len(p), 1.5)])
        sheet["N"] = n / np.linalg.norm(n, axis=1, keepdims=True)
        fine = vizlight.refine(sheet, scene, error=1 / 255, normals="N", facing="as given")
        at = np.column_stack([random.uniform(-0.5, 0.5, (20_000, 2)), np.zeros(20_000)])
        probe = pv.PolyData(at)
        shown = probe.sample(fine)["luminance"]
        normal = probe.sample(sheet)["N"]
        normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
        light, eye = (np.array(v) / np.linalg.norm(v) for v in ((0.3, 0.5, 1), (0, 0.2, 1)))
        cosine = normal @ light
        mirror = np.maximum(2 * cosine * (normal @ eye) - light @ eye, 0)
        true = 0.1 + np.where(cosine > 0, 0.5 * cosine + 0.4 * mirror**30, 0)
        off = np.abs(shown - true)
        share, total, worst = (
            share + np.count_nonzero(off > 1 / 255),
            total + len(off),
            max(worst, off.max()),
        )
    yield Promise(
        "refine(error=1/255), share of places beyond", total, share / total, share / total / 8e-4,
        "95 %: fewer than 0.08 % where light does not jump",
    )  # fmt: skip


def bundles(random, times):
    """The mean share of far and near light among thin cylinders, by rays that test each of them."""
    kinds = {
        "isotropic lines, far light": (None, "far", 0.01),
        "parallel lines, light within 10 degrees": ((1, 0, 0), "along", 0.05),
        "lamp among isotropic lines": (None, "near", 0.04),
    }
    for name, (axis, light, bound) in kinds.items():
        off = []
        for _ in range(8):
            count, d, length = 1200, 0.012, 0.6
            t = random.standard_normal((count, 3)) * (1 if axis is None else 0.03)
            t = t + (0 if axis is None else np.array(axis))
            t /= np.linalg.norm(t, axis=1, keepdims=True)
            middle = random.uniform(-0.8, 0.8, (count, 3))
            ends = np.stack([middle - length / 2 * t, middle, middle + length / 2 * t], axis=1)
            lines = pv.PolyData(
                ends.reshape(-1, 3),
                lines=np.insert(np.arange(3 * count).reshape(-1, 3), 0, 3, axis=1).ravel(),
            )
            e = np.radians(6)
            toward = (
                np.array([np.cos(e), np.sin(e), 0])
                if light == "along"
                else np.array([0.3, -0.4, 0.866])
            )
            place = np.array([0.1, 0.05, -0.08])
            lamp = Light(position=place) if light == "near" else Light(direction=toward)
            scene = Scene(lights=lamp, view=View(direction=(0, 0, 1)))
            lit = vizlight.illuminate(lines, scene, bundle=Bundle(diameter=d))
            got = np.asarray(lit["transmittance"]).reshape(count, 3)[:, 1].astype(float)
            rows = random.choice(count, 150 * times, replace=False)
            free = []
            for i in rows:
                way = place - middle[i] if light == "near" else toward
                reach = np.linalg.norm(way) if light == "near" else 9.0
                way = way / np.linalg.norm(way)
                side = np.cross(way, t[i])
                side /= np.linalg.norm(side)
                passed = 0
                for shift in random.uniform(-0.5, 0.5, 8):
                    start = middle[i] + shift * d * side
                    # Nearest approach of the ray and each axis.
                    b, w = t @ way, middle - start
                    p, q = w @ way, np.einsum("ij,ij->i", w, t)
                    s = (p - b * q) / np.maximum(1 - b * b, 1e-12)
                    u = np.clip(b * s - q, -length / 2, length / 2)
                    s = np.clip((w + u[:, None] * t) @ way, 0, reach)
                    near = np.linalg.norm(w + u[:, None] * t - s[:, None] * way, axis=1) < d / 2
                    near[i] = False
                    passed += not near.any()
                free.append(passed / 8)
            off.append(float(np.mean(got[rows] - free)))
        mean = float(np.mean(off))
        yield Promise(
            f"bundle, {name}",
            8 * 150 * times,
            abs(mean),
            abs(mean) / bound,
            f"{bound}, mean share of 8 bundles",
        )


def solids(random, times):
    """Volumes of combined balls and half balls, known in closed form."""
    worst = Worst()
    for _ in range(2 * times):
        gap = float(random.uniform(0.3, 1.2))
        one, other = vizlight.Sphere((0, 0, 0), 1.0), vizlight.Sphere((gap, 0, 0), 1.0)
        lens = np.pi / 12 * (4 + gap) * (2 - gap) ** 2
        for made, true in (
            (one & other, lens),
            (one | other, 8 * np.pi / 3 - lens),
            (one - other, 4 * np.pi / 3 - lens),
        ):
            mesh = vizlight.to_polydata(made)
            worst.add(mesh.volume, true, float(np.ravel(mesh.field_data["volume_error"])[0]))
    yield worst.of("volume of combined solids", "volume_error of the result")


def in_pieces(random, times):
    """A contour of a volume lit in slabs and as a whole."""
    worst = Worst()
    grid = pv.ImageData(dimensions=(40, 40, 40), spacing=(0.1, 0.1, 0.1))
    x, y, z = grid.points.T
    grid["f"] = np.sin(2 * x + 1) * np.cos(3 * y) + np.sin(2.5 * z) + 0.1 * x
    scene = Scene(lights=Light(direction=(1, 2, 3)), view=View(direction=(0, -1, 2)))
    options = {"normals": "gradient"}
    with tempfile.TemporaryDirectory() as folder:
        grid.save(f"{folder}/whole.vti")
        parts = {}
        for name, slab in (("whole", 64), ("slabs", 0.1)):
            lit = vizlight.pieces.light(
                f"{folder}/whole.vti", scene, out=f"{folder}/{name}.pvtp", contour="f", level=0.3,
                slab=slab, **options,
            )  # fmt: skip
            parts[name] = [pv.read(file) for file in lit.files]
    (known,) = parts["whole"]
    assert len(parts["slabs"]) > 2
    for part in parts["slabs"]:
        far, at = cKDTree(known.points).query(part.points)
        assert far.max() < 1e-5
        own, true = (np.asarray(mesh["luminance"], float) for mesh in (part, known))
        for one, other in zip(own, true[at], strict=True):
            worst.add(one, other, 1e-6)
    yield worst.of("light in pieces", "1e-6")


def axes(random, times):
    """The frame of an eye, and the factor of highlights at large exponents."""
    worst, level, eps = Worst(), Worst(), float(np.finfo(float).eps)
    for _ in range(60 * times):
        n = int(random.integers(3, 7))
        made = [mp(row) for row in View(direction=random.standard_normal(n)).axes()]
        for a in range(3):
            for b in range(3):
                worst.add(float(dot(made[a], made[b]) - (a == b)), 0, 4 * eps)
        angle = float(random.uniform(0.2, 2.6))
        cosine = mpmath.cos(mpmath.mpf(angle) / 2)
        factor = float(highlights.simple_factor(angle))
        level.add(factor, 4 * cosine, 4 * eps * 4 * cosine)
    yield worst.of("View.axes", "4 eps")
    yield level.of("highlights.simple_factor", "4 cos beta, to rounding")


def fibres(random, times):
    """Places on a flat surface of uneven triangles, counted on patches of equal area."""
    x = np.sort(np.append(random.uniform(0, 1, 30), [0, 1]))
    n = len(x)
    across, up = np.meshgrid(x, np.sort(np.append(random.uniform(0, 1, 30), [0, 1])))
    points = np.column_stack([across.ravel(), up.ravel(), np.zeros(n * n)])
    i = np.arange(n * (n - 1)).reshape(-1, n)[:, :-1].ravel()
    faces = np.stack([i, i + 1, i + n + 1, i, i + n + 1, i + n], axis=1).reshape(-1, 3)
    counts = []
    for seed in range(10 * times):
        own = random.permutation(faces)
        face, weights = fur.seeds(points, own, 4096, seed=seed)
        place = np.einsum("ij,ijk->ik", weights, points[own[face]])
        counts.append(np.histogram2d(place[:, 0], place[:, 1], bins=8, range=[[0, 1], [0, 1]])[0])
    share = float(np.var(counts) / np.mean(counts))
    stated = "0.25, variance of counts over their mean"
    yield Promise("places of fur", len(counts) * 64, share, share / 0.25, stated)


GROUPS = (
    reflections, cylinders, brightnesses, highlight_errors, half_vectors, falloffs, reliefs,
    tangents, axes, fibres, gaps, bands, refined, bundles, solids, in_pieces,
)  # fmt: skip


def rows(times: int, groups=GROUPS):
    """Yield the promises of some groups."""
    with mpmath.workdps(40):
        for group in groups:
            yield from group(np.random.default_rng(20261123), times)


def main(times: int = 4) -> None:
    """Compute all promises and write the table of the page."""
    made = [["thing", "cases", "worst error", "of the bound", "stated bound"]]
    for promise in rows(times):
        error, worst = f"{promise.error:.2g}", f"{promise.worst:.2f}"
        made.append([promise.thing, str(promise.cases), error, worst, promise.stated])
        print(*made[-1], sep=" | ", flush=True)  # noqa: T201
    with PAGE.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(made)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
