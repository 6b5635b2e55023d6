"""The checks of the engine for the stability suite: all of a scene's light at once."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight.scene import Light, Material, Scene, View
from vizlight.shading import bounds as stated
from vizlight.shading import engine
from vizlight.studies import _hard
from vizlight.studies._stability_checks import TYPES, Check, exactly, spread, timed

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    Array = NDArray[Any]

#: What is lit, in which space, under which law.
KINDS = (
    ("lines", 1, 3, "phong"), ("lines", 1, 3, "blinn"), ("lines", 1, 3, "cylinder"),
    ("surface", 2, 3, "phong"), ("surface", 2, 3, "blinn"), ("k = 2", 2, 4, "phong"),
)  # fmt: skip
AMBIENT, SHININESS = 0.125, 20.0


def shade(dtype: Any, count: int, random: Any) -> Iterator[Check]:
    """Light of lines, surfaces and 4-space, light and eye nearby, also far off; hard cases 7, 8."""
    for what, k, n, model in KINDS:
        for case, far in (("random", 0.0), ("5e6 from the origin", 5e6), ("light far off", 1e12)):
            many = spread(count, KINDS * 3)
            yield _lit(dtype, many, random, (what, k, n, model), case, far)
    yield from _ends(dtype, random)


def _lit(
    dtype: Any, many: int, random: Any, kind: tuple[str, int, int, Any], case: str, far: float
) -> Check:
    from vizlight.studies import _digits

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
        frame = _hard.frames(random, many, k, n, dtype)
        work = partial(engine.shade, points, frame, scene, model=model, precision=precision)
    shading, seconds = timed(work)
    p, true, claim = shading.plan.exponent, [], []
    bounds = stated.diffuse_bound(p, eps) / eps, stated.specular_bound(SHININESS, eps) / eps
    ends = [_digits.exact(end) for end in (light, eye)]
    for i, at in enumerate(points):
        wi, wo = (
            _digits.unit([a - b for a, b in zip(end, _digits.exact(at), strict=True)])
            for end in ends
        )
        half = [a + b for a, b in zip(wi, wo, strict=True)]
        share = min(float(_digits.mp.sqrt(_digits.dot(half, half))), 1.0)
        if what == "surface":
            up = _digits.unit(_digits.exact(normal[i]))
            lit, seen = _digits.dot(up, wi), _digits.dot(up, wo)
            base = 2 * lit * seen - _digits.dot(wi, wo)
            if model == "blinn":
                base = _digits.dot(up, _digits.unit(half))
            zero = _digits.mp.mpf(0)
            shine = max(base, zero) ** SHININESS if lit > 0 else zero
            true.append(AMBIENT + max(lit, zero) + shine)
        elif model == "cylinder":
            diffuse, shine, a, b, size = _digits.cylinder(wi, wo, frame[i, 0], SHININESS)
            true.append(AMBIENT + diffuse + shine)
            claim.append(float(4 / b + 10 / min(a, b, size)))
            continue
        else:
            diffuse = _digits.diffuse(wi, frame[i], p)
            shine = _digits.specular(wi, wo, frame[i], SHININESS, model)
            true.append(AMBIENT + diffuse + shine)
        claim.append(bounds[0] + bounds[1] / (share if model == "blinn" else 1.0))
    return Check(
        case, shading.luminance, true, np.array(claim), seconds, f"{what}, {model.title()}"
    )


def _ends(dtype: Any, random: Any) -> Iterator[Check]:
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
        vectors = _hard.frames(random, 20, k, n, dtype)
        given: dict[str, Any] = {"model": model, "precision": np.dtype(dtype).name}
        tangents: Array | None = vectors
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


CHECKS: dict[str, tuple[Callable[..., Iterator[Check]], tuple[Any, ...]]] = {
    "engine.shade": (shade, TYPES),
}
