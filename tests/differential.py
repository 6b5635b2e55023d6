"""Random plans and inputs, directed at the hard cases, against the oracle of 50 digits.

``python tests/differential.py [FORMS [EACH]]`` lights EACH random plans (default 2) of FORMS forms
(default 500) at 32 points each, and writes the largest error in units of the stated bound for each
kind of plan to ``gallery/pages/forms.csv``. Numbers, points and vectors are random for each plan.
``tests/shading/test_terms.py`` runs a sample.
"""

from __future__ import annotations

import csv
import dataclasses
import math
import sys
from collections import defaultdict
from pathlib import Path
from typing import NamedTuple

import numpy as np
import oracles

from vizlight import DepthCue, Light, Material, Scene, View
from vizlight.model import frames
from vizlight.scene.light import NO_ATTENUATION
from vizlight.shading.arrays import Shading, shade_block
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import ShadingOptions
from vizlight.shading.plan import decide

PAGE = Path(__file__).parents[1] / "gallery" / "pages" / "forms.csv"
HEAD = ("kind", "forms", "plans", "points", "worst of the bound")
POINTS = 32
KINDS = ("surface", "line", "frame", "conditioned", "free", "based", "fur", "shadow", "cylinder")
POWERS = (0, 0.3, 1, 2, 7.5, 20, 20, 31, 63, 64, 100.5, 1e4, 1e6)


class Case(NamedTuple):
    """A scene, its inputs and options."""

    kind: str
    scene: Scene
    inputs: ShadingInputs
    options: ShadingOptions


#: How to draw the value of a field, by the text of its type, where no number below is passed.
BY_TYPE = {
    "float": lambda random: random.random(),
    "float | None": lambda random: 0.3 + 2 * random.random(),
    "bool": lambda random: bool(random.random() < 0.5),
    "Color | None": lambda random: tuple(random.random(3)),
}
#: Probability that a form leaves a field of a type at the default of its class.
PLAIN = {"float": 0.2, "float | None": 0.8, "bool": 0.5, "Color | None": 0.8}


def drawn(kind, random, plain=frozenset(), **values):
    """Return a part of a scene with a random value of each field that has none here.

    Fields are those of the class itself, so that a new one is drawn as soon as it is there. Those
    in ``plain``, such as ``"Material.color"``, keep the default of the class.
    """
    for field in dataclasses.fields(kind):
        name = f"{kind.__name__}.{field.name}"
        if field.name in values or name in plain:
            continue
        assert field.type in BY_TYPE, (
            f"tests/differential.py draws no {name} of type {field.type}: add the type to BY_TYPE, "
            f"or pass a value where drawn({kind.__name__}, ...) is called"
        )
        values[field.name] = BY_TYPE[field.type](random)
    return kind(**values)


def plain_fields(random):
    """Return the fields of parts of a scene that a form leaves at their defaults."""
    return frozenset(
        f"{kind.__name__}.{field.name}"
        for kind in (Light, Material, DepthCue, Scene)
        for field in dataclasses.fields(kind)
        if random.random() < PLAIN.get(field.type, 0)
    )


class Frame(NamedTuple):
    """What of a case its form depends on."""

    kind: str
    n: int
    k: int
    base: int
    types: tuple[type, ...]
    lights: tuple[tuple[bool, bool, frozenset[str]], ...]
    near_eye: bool
    cue: str
    axis: bool
    plain: frozenset[str]
    whole: bool
    repeat: int
    two_sided: bool
    dimmed: bool
    options: ShadingOptions


def frame(random) -> Frame:
    """Return a random form."""
    kind = str(random.choice(KINDS))
    n = 3 if kind == "cylinder" or random.random() < 0.6 else int(random.integers(2, 7))
    k = int(random.integers(1, min(3, n - 1) + 1)) if kind in ("frame", "based") else 1
    base = int(random.integers(k, n)) if kind == "based" else 0
    model = "cylinder" if kind == "cylinder" else str(random.choice(["phong", "blinn"]))
    types = [np.float32, np.float32, np.float64]
    sided = kind == "surface" and random.random() < 0.3
    count = int(random.choice([1, 1, 1, 2, 3, 7]))
    chosen = [types[random.integers(3)] for _ in range(4)]
    if kind == "based":
        chosen[3] = chosen[1]
    lights = [
        (*map(bool, random.random(2) < (0.6, 0.4)), plain_fields(random)) for _ in range(count)
    ]
    return Frame(
        kind=kind, n=n, k=k, base=base,
        types=tuple(chosen),
        lights=tuple(lights),
        near_eye=bool(random.random() < 0.6),
        cue=str(random.choice(["", "", "linear", "smooth"])),
        axis=bool(random.random() < 0.5),
        plain=plain_fields(random),
        whole=bool(random.random() < 0.5),
        repeat=int(random.choice([1, 1, 1, 4])),
        two_sided=sided,
        dimmed=bool(random.random() < 0.15),
        options=ShadingOptions(
            model=model,
            exponent="compensated" if random.random() < 0.8 else float(random.choice([1, 2])),
            conditioned=kind != "free",
            components=bool(random.random() < 0.3),
            precision=str(random.choice(["float32", "float64"])),
        ),
    )  # fmt: skip


def case(form: Frame, random) -> Case:
    """Return a case of a form: random numbers, points and vectors, some of them hard."""
    n = form.n
    offset = random.normal(size=n) * float(random.choice([0, 0, 1, 5e6]))
    size = float(random.choice([1, 1, 1e-3, 100]))

    def near():
        return tuple(offset + size * random.normal(size=n) * random.choice([1.5, 3]))

    direction = tuple(random.normal(size=n))
    axis = not form.near_eye or (form.axis and bool(form.cue))
    view = drawn(
        View, random, position=near() if form.near_eye else None,
        direction=direction if axis else None, parallel=not form.near_eye,
        up=tuple(random.normal(size=n)),
    )  # fmt: skip
    lights = [_light(kind, near, random, n, axis) for kind in form.lights]
    powers = [p for p in POWERS if (p in (1, 2, 20, 31, 63)) == form.whole]
    power = float(random.choice(powers))
    if form.options.model == "blinn" and form.whole:
        power *= 2
    cue = None
    if form.cue:
        front = float(random.normal() * size)
        back = front + size * float(random.choice([-3, 1, 4]))
        cue = drawn(
            DepthCue, random, form.plain, front=front, back=back, smooth=form.cue == "smooth"
        )
    scene = drawn(
        Scene, random, form.plain, lights=lights, view=view, depth_cue=cue,
        material=drawn(Material, random, form.plain, shininess=power),
    )  # fmt: skip
    return Case(form.kind, scene, _inputs(form, scene, offset, size, random), form.options)


def _light(kind, near, random, n, axis):
    placed, faded, plain = kind
    attenuation = tuple(random.random(3) * (1, 1, 0.3)) if placed and faded else NO_ATTENUATION
    place = near() if placed else None
    if placed and random.random() < 0.1:
        # Out of the range of float32, or of that of its squares.
        scale = float(random.choice([1e-42, 1e-25, 1e15, 1e25, 1e39, 1e120]))
        place = tuple(scale * random.normal(size=n))
    turning = not placed and axis and n == 3 and "Light.follows_view" not in plain
    return drawn(
        Light, random, plain, position=place, attenuation=attenuation,
        direction=None if placed else tuple(random.normal(size=n)),
        intensity=float(random.choice([0.3, 1.0, 2.0])), follows_view=turning,
    )  # fmt: skip


def _inputs(form, scene, offset, size, random):
    n, count, rows = form.n, POINTS, POINTS // form.repeat
    types = form.types
    points = (offset + size * random.normal(size=(count, n))).astype(types[0])
    each = rows if form.repeat > 1 and form.types[3] == np.float64 else count
    with np.errstate(over="ignore", under="ignore"):
        tangents = _vectors(random, (each, form.k, n), types[1], scene)
        normals = _vectors(random, (rows, n), types[2], scene)
        base = _vectors(random, (rows, max(form.base, 1), n), types[3], scene)
    light = scene.lights[0]
    # Places beyond the largest number of the type are no points.
    far = light.position is not None and np.abs(light.position).max() > np.finfo(types[0]).max
    if light.position is not None and random.random() < 0.1 and not far:
        points[0] = light.position
    if random.random() < 0.1:
        points[1], points[2] = np.nan, np.inf
    kind, given = form.kind, {}
    if kind in ("conditioned", "fur", "surface", "shadow", "free"):
        given["normals"] = normals
    if kind not in ("surface", "shadow") or form.options.model == "cylinder":
        given["tangents"] = tangents
    if kind == "based":
        given["base_tangents"] = base
    if kind == "fur":
        height = random.random(count) * 2
        height[:3] = (0, 1e3, 1e-30)
        given |= {"fur_height": height, "fur": float(random.choice([0.2, 0.9, 1.0]))}
    if kind == "shadow":
        shadow = random.random((count, len(scene.lights)))
        shadow[0] = 0
        given["shadow"] = shadow
    if form.dimmed:
        given["transmittance"] = random.random((count, len(scene.lights)))
        given["occlusion"] = random.random(count)
        given["transmittance"][2, 0] = given["occlusion"][3] = np.nan
    return ShadingInputs(points=points, repeat=form.repeat, two_sided=form.two_sided, **given)


def _vectors(random, shape, kind, scene):
    """Return random vectors, the first of them hard cases."""
    v = random.normal(size=shape)
    if random.random() < 0.5:
        return v.astype(kind)
    first = scene.lights[0].direction
    for i, change in enumerate(random.permutation(7)[:3]):
        row = v[i]
        if change == 0:
            row[...] = 0
        elif change == 1:
            row *= 1e-30
        elif change == 2:
            row *= 1e30
        elif change == 3 and first is not None:
            row[..., :] = np.asarray(first) + 1e-7 * random.normal(size=row.shape)
        elif change == 4:
            row[..., 0] = random.choice([np.nan, np.inf])
        elif change == 5:
            row[..., :] = np.atleast_2d(row)[0] + 1e-7 * random.normal(size=row.shape)
        else:
            row *= float(random.choice([1e-150, 1e150]))
    return v.astype(kind)


class Truth(NamedTuple):
    """The light of the points of a case in 50 digits, rounded to float64; NaN without any."""

    luminance: np.ndarray
    diffuse: np.ndarray
    specular: np.ndarray
    rgb: np.ndarray

    @property
    def valid(self):
        """Where there is light."""
        return np.isfinite(self.luminance)


def truth(made: Case) -> Truth:
    """Return the light of a case by the oracle, which shares nothing with the engine."""
    inputs, options = made.inputs, made.options
    n, count, repeat = inputs.points.shape[1], inputs.count, inputs.repeat
    # Tangents and base tangents have one type; they are worked on in the wider one of it and of the
    # precision.
    wide = np.float64 if inputs.tangents is None else inputs.tangents.dtype
    apart = frames.default_rtol(n, np.promote_types(wide, options.precision))

    def vectors(rows, i):
        if rows is None:
            return None
        row = i if rows.shape[0] == count else i // repeat
        return np.asarray(rows[row], float).reshape(-1, n).tolist()

    def number(rows, i):
        return None if rows is None else np.asarray(rows[i], float).tolist()

    lit = []
    for i in range(count):
        normal = vectors(inputs.normals, i)
        share = number(inputs.transmittance, i)
        open_ = 1.0 if inputs.occlusion is None else inputs.occlusion[i]
        found = oracles.digits.light(
            vectors(inputs.points, i)[0], vectors(inputs.tangents, i),
            None if normal is None else normal[0], made.scene,
            base_tangents=vectors(inputs.base_tangents, i), fur=inputs.fur,
            fur_height=number(inputs.fur_height, i) or 0.0, shadow=number(inputs.shadow, i),
            transmittance=share, occlusion=open_, model=options.model,
            exponent=options.exponent, conditioned=bool(options.conditioned),
            two_sided=inputs.two_sided, apart=apart,
        )  # fmt: skip
        known = np.isfinite(open_) and (share is None or np.isfinite(share).all())
        values = [found.luminance, found.diffuse, found.specular, *found.rgb]
        lit.append([float(x) if known else math.nan for x in values])
    table = np.array(lit)
    return Truth(*table[:, :3].T, table[:, 3:])


def by_numpy(plan, inputs, output):
    """Light points by NumPy."""
    shade_block(plan, slice(0, inputs.rows), inputs, output)


def compare(made: Case, true: Truth) -> tuple[float, int]:
    """Return the largest error in units of the stated bound, and the points that count.

    Parameters
    ----------
    made : Case
    true : Truth
        Its light by the oracle.

    Validity must be that of the oracle; points without light have the ambient light.
    """
    scene, inputs = made.scene, made.inputs
    plan = decide(scene, inputs.layout, made.options, made.options.precision)
    output = Shading.of(plan, inputs.count)
    with np.errstate(all="ignore"):
        by_numpy(plan, inputs, output)
        bound = _bound(plan, inputs)
    np.testing.assert_array_equal(output.valid, true.valid)
    worst, good = 0.0, true.valid
    share = np.ones(inputs.count) if inputs.occlusion is None else inputs.occlusion
    dark = plan.ambient * np.where(np.isnan(share), 1, share)
    unlit = {"luminance": dark, "diffuse": 0 * dark, "specular": 0 * dark}
    color = np.multiply(scene.material.color or (1, 1, 1), scene.ambient_color or (1, 1, 1))
    unlit["rgb"] = np.array(
        [
            oracles.digits.exposed(row, scene.exposure)
            for row in (dark[:, np.newaxis] * color).tolist()
        ],
        float,
    )
    # Exposure multiplies light and its error; its knee moves the other channels along with one.
    scales = {"rgb": 2 * max(scene.exposure or 1, 1)}
    for name, ambient in unlit.items():
        found = getattr(output, name)
        if found is None:
            continue
        assert np.isfinite(found).all()
        np.testing.assert_allclose(found[~good], ambient[~good], rtol=4 * np.finfo(plan.dtype).eps)
        off = np.abs(found[good].astype(float) - getattr(true, name)[good])
        limit = bound[good] if off.ndim == 1 else bound[good, np.newaxis]
        limit = limit * scales.get(name, 1)
        worst = max(worst, float((off / limit).max(initial=0.0)))
    return worst, int(good.sum())


def _unit(v):
    largest = np.abs(v).max(axis=-1, keepdims=True)
    v = v / np.where(largest > 0, largest, 1)
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def _dependence(v, n):
    """Return 1 over the sine of the angle between tangents: what it multiplies errors by."""
    v = _unit(np.asarray(v, float).reshape(len(v), -1, n))
    if v.shape[1] == 1:
        return np.ones(len(v)), v
    v = np.where(np.isfinite(v), v, 0)
    return 1 / np.maximum(np.linalg.svd(v, compute_uv=False)[:, -1], 1e-300), v


def _bound(plan, inputs):
    """Return the bound of the luminance's error at each point, from those of the docstrings."""
    eps = float(np.finfo(plan.dtype).eps)
    n, count = plan.n, inputs.count
    scene, material = plan.scene, plan.scene.material

    def each(v):
        return np.repeat(v, count // len(v), axis=0)

    points = np.asarray(inputs.points, float)
    spread = np.ones(count)
    if inputs.tangents is not None:
        wide, t = _dependence(inputs.tangents, n)
        spread, t = each(wide), each(t)
    if inputs.base_tangents is not None:
        spread = spread + each(_dependence(inputs.base_tangents, n)[0])
    normal = None if inputs.normals is None else each(_unit(np.asarray(inputs.normals[:], float)))
    wo = None
    if scene.view is not None:
        wo = _way(scene.view.position, scene.view.direction, points, far=scene.view.parallel)
    total = np.full(count, 4 * eps * plan.ambient)
    strengths = {f.name: getattr(material, f.name) for f in dataclasses.fields(material)}
    others = sum(
        value for name, value in strengths.items()
        if isinstance(value, float) and name not in ("ambient", "diffuse", "specular", "shininess")
    )  # fmt: skip
    for light, highlight in zip(scene.lights, plan.highlights, strict=True):
        seen = light.seen_from(scene.view)
        wi = _way(seen.position, seen.direction, points, far=seen.position is None)
        factors = 8.0 * (2 + (light.attenuation != NO_ATTENUATION) + plan.conditioned)
        if plan.base:
            factors = factors + oracles.diffuse_bound(plan.base_exponent, eps) / eps * spread
        if plan.fur:
            # (1 - rho)^d changes by at most 1/e of the relative change of d; and it is within 1.
            sines = [np.abs(np.sum(normal * w, axis=1)) for w in (wi, wo)]
            factors = factors + sum(4 / np.maximum(s, 1e-300) for s in sines) + 40
        if plan.shadowed:
            cosine = np.abs(np.sum(normal * wi, axis=1))
            factors = factors + 4 / np.maximum(cosine, 1e-300)
        d = (oracles.diffuse_bound(plan.exponent, eps) + factors * eps) * spread
        s = oracles.specular_bound(highlight.shininess, eps)
        if highlight.model == "blinn" and highlight.half is None:
            near = np.linalg.norm(wi + wo, axis=1)
            s = s / np.minimum(np.maximum(near, 1e-300), 1)
        if plan.model == "cylinder":
            rest = [w - np.sum(w * t[:, 0], axis=1, keepdims=True) * t[:, 0] for w in (wi, wo)]
            a, b = (np.linalg.norm(r, axis=1) for r in rest)
            least = np.minimum(np.minimum(a, b), np.linalg.norm(rest[0] + rest[1], axis=1))
            d = 4 * eps / np.maximum(b, 1e-300) + factors * eps
            s = 10 * eps / np.maximum(least, 1e-300)
        s = (s + factors * eps) * spread
        if plan.surface and not plan.two_sided:
            # The highlight ends where the light does: at N.wi = 0 rounding decides.
            cosine = np.abs(np.sum(normal * wi, axis=1))
            s = np.where(cosine < 8 * eps, 1, s)
        total += light.intensity * material.diffuse * np.minimum(d, 1)
        total += light.intensity * material.specular * np.minimum(s, 1)
        # A term of which nothing is said here has the bound of both.
        total += light.intensity * others * np.minimum(d + s, 1)
        total += 4 * eps * light.intensity * (material.diffuse + material.specular)
    cue = scene.depth_cue
    if cue is not None:
        weight = sum(one.intensity for one in scene.lights)
        weight *= material.diffuse + material.specular
        total += 4 * eps * (cue.cue + plan.ambient + weight)
        reach = np.abs(points).max(axis=1) + max(map(abs, scene.view.position or (0,)))
        total += 32 * np.finfo(float).eps * reach / abs(cue.front - cue.back) * (cue.cue + weight)
    return np.where(np.isfinite(total), total, math.inf)


def _way(position, direction, points, *, far):
    if far:
        return np.broadcast_to(_unit(np.asarray(direction, float)), points.shape)
    return _unit(np.asarray(position, float) - points)


def main(forms: int = 500, each: int = 2) -> None:
    """Run all, and write the worst of each kind to the table of the page."""
    worst, plans, points, made_of = (defaultdict(float), *(defaultdict(int) for _ in range(3)))
    for number in range(forms):
        form = frame(np.random.default_rng(1000 + number))
        random, kind = np.random.default_rng((14, number)), form.kind
        made_of[kind] += 1
        for _ in range(each):
            made = case(form, random)
            ratio, lit = compare(made, truth(made))
            worst[kind] = max(worst[kind], ratio)
            plans[kind] += 1
            points[kind] += lit
        print(number, kind, f"{worst[kind]:.3f}", flush=True)  # noqa: T201
    with PAGE.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(HEAD)
        for kind in KINDS:
            table.writerow([kind, made_of[kind], plans[kind], points[kind], f"{worst[kind]:.2f}"])


if __name__ == "__main__":
    main(*map(int, sys.argv[1:3]))
