"""The checks of the engine for the stability suite: all of a scene's light at once."""

from __future__ import annotations

from functools import partial

import bounds as stated
import numpy as np
import oracles

from stability import hard, references
from stability.checks import TYPES, Check, exactly, spread, timed
from vizlight.scene import Light, Material, Scene, View
from vizlight.shading import engine

#: What is lit, in which space, under which law.
KINDS = (
    ("lines", 1, 3, "phong"), ("lines", 1, 3, "blinn"), ("lines", 1, 3, "cylinder"),
    ("surface", 2, 3, "phong"), ("surface", 2, 3, "blinn"), ("k = 2", 2, 4, "phong"),
)  # fmt: skip
AMBIENT, SHININESS = 0.125, 20.0


def shade(dtype, count, random):
    """Light of lines, surfaces and 4-space, light and eye nearby, also far off; hard cases 7, 8."""
    for what, k, n, model in KINDS:
        for case, far in (("random", 0.0), ("5e6 from the origin", 5e6), ("light far off", 1e12)):
            many = spread(count, KINDS * 3)
            yield _lit(dtype, many, random, (what, k, n, model), case, far)
    yield from _ends(dtype, random)


def _lit(dtype, many, random, kind, case, far):
    what, k, n, model = kind
    eps = float(np.finfo(dtype).eps)
    way = np.array([1.0, 2.0, 3.0, -1.0])[:n]
    centre = np.zeros(n) if case == "light far off" else far * np.array([1, -1, 1, 1])[:n]
    light = centre + way * (far if case == "light far off" else 1)
    eye = centre + np.array([0.0, 1.0, 5.0, 1.0])[:n]
    points = (centre + random.standard_normal((many, n))).astype(dtype)
    scene = Scene(
        lights=Light(position=light),
        view=View(position=eye),
        material=Material(ambient=AMBIENT, diffuse=1.0, specular=1.0, shininess=SHININESS),
    )
    precision = np.dtype(dtype).name
    if what == "surface":
        # Half of them where the highlight falls, near the half vectors.
        normal = random.standard_normal((many, n))
        ways = [end - points[::2].astype(float) for end in (light, eye)]
        middle = sum(way / np.linalg.norm(way, axis=1, keepdims=True) for way in ways)
        middle /= np.linalg.norm(middle, axis=1, keepdims=True)
        normal[::2] = middle + 0.3 * normal[::2]
        normal = normal.astype(dtype)
        work = partial(
            engine.shade, points, None, scene, normals=normal, model=model, precision=precision
        )
    else:
        frame = hard.frames(random, many, k, n, dtype)
        work = partial(engine.shade, points, frame, scene, model=model, precision=precision)
    shading, seconds = timed(work)
    p, true, claim = shading.plan.exponent, [], []
    bounds = stated.diffuse_bound(p, eps) / eps, stated.specular_bound(SHININESS, eps) / eps
    digits = oracles.digits
    for i, at in enumerate(points):
        lines, up = (None, normal[i]) if what == "surface" else (frame[i], None)
        true.append(digits.light(at, lines, up, scene, model=model, exponent=p, apart=0).luminance)
        wi, wo = (digits.toward(end, oracles.exact(at))[0] for end in (scene.lights[0], scene.view))
        if model == "cylinder":
            _, _, a, b, size = references.cylinder(wi, wo, frame[i, 0], SHININESS)
            claim.append(float(4 / b + 10 / min(a, b, size)))
            continue
        half = [a + b for a, b in zip(wi, wo, strict=True)]
        share = min(float(oracles.size(half)), 1.0)
        claim.append(bounds[0] + bounds[1] / (share if model == "blinn" else 1.0))
    return Check(
        case, shading.luminance, true, np.array(claim), seconds, f"{what}, {model.title()}"
    )


def _ends(dtype, random):
    """Check what is defined: the ambient light where no other comes from, none of no points."""
    here = random.standard_normal((20, 3)).astype(dtype)
    scene = Scene(
        lights=Light(position=here[0].astype(float)),
        view=View(position=(0.0, 1.0, 5.0)),
        material=Material(ambient=AMBIENT, diffuse=1.0, specular=1.0),
    )
    for what, k, n, model in KINDS:
        if n > 3:
            continue
        vectors = hard.frames(random, 20, k, n, dtype)
        given = {"model": model, "precision": np.dtype(dtype).name}
        tangents = vectors
        if what == "surface":
            tangents, given["normals"] = None, vectors[:, 0]
        regime = f"{what}, {model.title()}"
        made, seconds = timed(partial(engine.shade, here, tangents, scene, **given))
        yield exactly("on the light", made.luminance[0], AMBIENT, seconds)._replace(regime=regime)
        if what == "surface":
            # Inside a solid its light is behind every normal.
            away = here.astype(float) - here[0].astype(float)
            given["normals"] = away.astype(dtype)[1:]
            made, seconds = timed(partial(engine.shade, here[1:], None, scene, **given))
            yield exactly("light inside the solid", made.luminance, [AMBIENT] * 19)._replace(
                regime=regime
            )
            given["normals"] = vectors[:, 0]
        bad = vectors.copy()
        bad[:2], bad[2] = 0, np.nan
        rows = {**given, "normals": bad[:, 0]} if what == "surface" else given
        made = engine.shade(here, None if tangents is None else bad, scene, **rows)
        yield exactly("zero, NaN", made.luminance[:3], [AMBIENT] * 3)._replace(regime=regime)
        yield exactly("zero, NaN", made.valid[:4], [0, 0, 0, 1])._replace(regime=regime)
        if what == "surface":
            given["normals"] = vectors[:0, 0]
        made = engine.shade(here[:0], None if tangents is None else vectors[:0], scene, **given)
        yield exactly("none", made.luminance.shape, [0])._replace(regime=regime)


CHECKS = {
    "engine.shade": (shade, TYPES),
}
