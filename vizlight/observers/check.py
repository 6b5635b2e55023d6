"""Cost and error of the light that a mesh carries, measured from its record."""

from __future__ import annotations

import dataclasses
import math
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vizlight import _check
from vizlight.filters import relight
from vizlight.filters.relief_day import directions_of
from vizlight.mesh import blocks, records
from vizlight.model import frames
from vizlight.scene import Scene, View
from vizlight.shading.results import DEFAULT_NAME
from vizlight.verify import between, oracle

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    import pyvista as pv

    from vizlight._types import Array, Indices, Keywords
    from vizlight.shading.engine import Shading
    from vizlight.shading.inputs import ArraySource, ShadingInputs
    from vizlight.shading.options import ShadingOptions


#: Error that a picture of 8 bits shows.
VISIBLE = 1 / 255
#: Share of the runs in which a stated bound of what a sample has missed may be wrong.
DOUBT = 0.05
#: Largest number of rays through a solid that are computed again.
RAYS = 64
#: Largest number of planes of nodes or triangles that all these rays are tested against.
TRIALS = 20_000_000
SHADOW = ("t",)
SHADOWED = "cast shadows, whose edges run between the points"
BANDED = "a band has one light, and nothing is interpolated: the bound above is all of its error"


@dataclass(frozen=True, kw_only=True)
class Run:
    """Light of one mesh, or of one block.

    Attributes
    ----------
    points : int
        Number of points.
    terms : tuple of str
        Terms that were added up; ``("t",)`` for a cos-theta shadow.
    precision : str
        Type of the numbers.
    seconds : float
        Wall time of the light; NaN for shadows and bands.
    bytes : int
        Size of the arrays that the mesh carries: light, validity, components, colour.
    sample : int
        Number of points that were drawn at random and computed again, one by one in float64, by
        formulas that share no code with the engine.
    error, rms : float
        Largest and root mean square difference of their luminance and colour, or of t; NaN
        without a sample.
    invalid : int
        Number of points that could not be lit.
    bright : int
        Number of points with a luminance, or a channel of colour, above 1.
    disagreed : int
        Number of points of the sample that only one of the two implementations could light.
    bound : float
        Stated error bound of the bands of ``isoluminance``; NaN without.
    places : int
        Number of random places between the points, uniform in area or length, at which the light
        of interpolated normals or tangents was computed; 0 where nothing is interpolated.
    between, between_rms : float
        Largest and root mean square difference of interpolated luminance and colour from the light
        at those places; NaN without places.
    visible : float
        Share of those places that are off by more than 1/255.
    unmeasured : str
        Part of the error between the points that is not measured and why, in words; empty if none.
    """

    points: int
    terms: tuple[str, ...]
    precision: str
    bytes: int
    invalid: int
    seconds: float = math.nan
    sample: int = 0
    error: float = math.nan
    rms: float = math.nan
    bright: int = 0
    disagreed: int = 0
    bound: float = math.nan
    places: int = 0
    between: float = math.nan
    between_rms: float = math.nan
    visible: float = math.nan
    unmeasured: str = ""

    @property
    def missed(self) -> float:
        """Share of the points that may be worse than the sample, with a confidence of 95 %."""
        # A sample of all points that could be lit has missed none.
        return 0.0 if self.sample + self.invalid >= self.points else unseen(self.sample)

    @property
    def nanoseconds(self) -> float:
        """Wall time per point, in ns."""
        return 1e9 * self.seconds / self.points if self.points else math.nan


@dataclass(frozen=True, kw_only=True)
class Report:
    """Cost and error of the light of a mesh, one run for each block; see :func:`check`."""

    runs: tuple[Run, ...] = ()
    #: What is known of each sky, and of the light inside each bundle, in words.
    skies: tuple[str, ...] = ()

    @property
    def points(self) -> int:
        """Number of points with light, or else with shadows."""
        lit = [run for run in self.runs if run.terms != SHADOW]
        return sum(run.points for run in lit or self.runs)

    @property
    def invalid(self) -> int:
        """Number of points that could not be lit."""
        return sum(run.invalid for run in self.runs)

    @property
    def bright(self) -> int:
        """Number of points with light above 1, which a picture shows as 1."""
        return sum(run.bright for run in self.runs)

    @property
    def bytes(self) -> int:
        """Size of all results in bytes."""
        return sum(run.bytes for run in self.runs)

    @property
    def seconds(self) -> float:
        """Wall time of the light of all runs; NaN if none was measured."""
        return _finite(sum, [run.seconds for run in self.runs])

    @property
    def error(self) -> float:
        """Largest error of all samples; NaN without a sample."""
        return _finite(max, [run.error for run in self.runs])

    @property
    def between(self) -> float:
        """Largest error between the points of all runs; NaN if none was measured."""
        return _finite(max, [run.between for run in self.runs])

    @property
    def terms(self) -> tuple[str, ...]:
        """Terms of all runs, each once."""
        return tuple(dict.fromkeys(term for run in self.runs for term in run.terms))

    def __str__(self) -> str:
        lines = [*self.skies]
        if self.runs:
            lines.append(
                f"{self.points} points lit in {len(self.runs)} run(s), {self.bytes / 1e6:.3g} MB"
                f" of light{_timed(self.seconds)}"
            )
        if self.bright:
            lines.append(f"{self.bright} points are brighter than 1, which a picture shows as 1")
        for run in self.runs:
            each = f", {run.nanoseconds:.3g} ns per point" if run.seconds == run.seconds else ""
            lines.append(
                f"{run.points} points, {run.precision}: {' + '.join(run.terms)}; {run.bytes} bytes"
                f"{_timed(run.seconds)}{each}"
            )
            lines += _lines(run)
        if self.runs:
            lines.append("not measured: what a reader can read back, see vizlight.legibility")
        return "\n".join(lines)


class RandomRows(NamedTuple):
    """Number of points that are drawn at random, and the seed."""

    sample: int
    seed: int

    def of(self, count: int, most: int) -> Indices:
        """Return at most so many of a count of rows."""
        random = np.random.default_rng(self.seed)
        return random.choice(count, min(self.sample, most, count), replace=False)


def _finite(total: Callable[[list[float]], float], values: list[float]) -> float:
    """Return the sum or the largest of the values that are no NaN; NaN without any."""
    numbers = [value for value in values if not math.isnan(value)]
    return total(numbers) if numbers else math.nan


def _timed(seconds: float) -> str:
    return "" if math.isnan(seconds) else f"; {seconds:.3g} s"


def unseen(count: int) -> float:
    """Return the share that may be worse than all of a random sample, with 95 % confidence.

    A fault in a share p of the points is missed by n of them with probability ``(1 - p)^n``.
    """
    # 1 - DOUBT^(1/n), by functions that keep its digits where it is small.
    return float(-np.expm1(np.log(DOUBT) / count)) if count else 1.0


def _lines(run: Run) -> list[str]:
    """Return the errors of a run in words."""
    if run.sample:
        what = f"{run.sample} points" if run.missed else f"all {run.sample} points"
        error, how = "rounding error", f"{what} computed again one by one in float64"
        if run.terms == SHADOW:
            error, how = "error of t", f"{what} computed again, each ray against all cells"
        text = f"  {error} {run.error:.2g} at most, {run.rms:.2g} RMS, {how}"
        if run.missed:
            text += f"; {_confident(run.missed)} of the points are worse"
    elif not math.isnan(run.bound):
        text = f"  stated bound of the error {run.bound:.2g}"
    else:
        text = "  no sample: error unknown"
    lines = [f"{text}; {run.invalid} invalid"]
    if run.disagreed:
        lines.append(
            f"  {run.disagreed} points of the sample are valid in only one of the two "
            "implementations"
        )
    if run.places:
        text = (
            f"  error between points {run.between:.2g} at most, {run.between_rms:.2g} RMS, at "
            f"{run.places} random places; {_confident(unseen(run.places))} of the places are worse"
        )
        if run.visible:
            text += f"; {_percent(run.visible)} are off by more than 1/255"
        if run.visible > unseen(run.places):
            text += "; vizlight.refine to 1/255 leaves only places where the light jumps"
        lines.append(text)
    if run.unmeasured:
        lines.append(f"  not measured between points: {run.unmeasured}")
    return lines


def _confident(share: float) -> str:
    """Return a bound of a share, rounded up to one digit, with its confidence."""
    digits = 1 - math.floor(math.log10(share))
    up = math.ceil(share * 10.0 ** (digits - 1)) / 10.0 ** (digits - 1)
    return f"95 %: fewer than {_percent(up)}"


def _percent(share: float) -> str:
    return f"{float(f'{100 * share:.2g}'):g} %"


def check(
    lit: pv.DataSet | pv.MultiBlock,
    /,
    *,
    name: str = DEFAULT_NAME,
    sample: int = 4096,
    seed: int = 0,
) -> Report:
    """Return the cost, the terms and the error of the light that a mesh carries.

    Parameters
    ----------
    lit : pyvista.DataSet or pyvista.MultiBlock
        Mesh that a filter of vizlight returned, or one read from a file of such a mesh.
    name : str, default: "luminance"
        Name of the light, of a cos-theta shadow, or of a sky.
    sample : int, default: 4096
        Number of points of each block, drawn at random, that are computed again one by one, and of
        places between the points; 0 for none. A fault in 1 of 1,000 points or places is found by
        3,000 with a confidence of 95 %.
    seed : int, default: 0
        Seed of the drawing.

    Returns
    -------
    Report
        Report to print, with the attributes ``points``, ``terms``, ``seconds``, ``bytes``,
        ``error``, ``between``, ``invalid``, ``runs``, one for each block that has light, and
        ``skies``, the facts of each sky and each bundle; figures that are not measured are NaN.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, the mesh has no record of the light, or one that describes an
        array or a mesh in place of holding it, or points or arrays have changed since.

    Notes
    -----
    The light of the mesh is compared with that of the recorded scene itself, not of a plan. t of a
    cos-theta shadow is computed again on at most 64 rays, each against all cells of a height field
    on its way, or all triangles of a closed surface; at depth 0 the report gives no error. Bands
    of ``isoluminance`` state the error that they carry. The time is that of light computed once
    more; shadows, skies and bands are not made again.

    The error between the points is the picture's: light that is interpolated over segments and
    triangles, against the light of normals and tangents that are interpolated and normalised, as a
    fragment shader computes it. It is computed by the engine in float64. It is not measured for
    fur, for cast shadows, for light inside a bundle, and for points without cells, and the report
    says so where it is not. :func:`vizlight.legibility` measures which values a reader can read
    back from the picture.

    Examples
    --------
    >>> import pyvista as pv, vizlight
    >>> scene = vizlight.Scene(view=vizlight.View(direction=(0, 0, 1)))
    >>> lit = vizlight.illuminate(pv.Sphere(), scene)
    >>> vizlight.check(lit).error < 1e-5
    True
    """
    drawing = RandomRows(
        _check.integer("sample", sample, low=0), _check.integer("seed", seed, low=0)
    )
    record = records.provenance(lit, name)
    if record["filter"] == "tint":
        # Colours were put on a light, which the mesh carries too.
        return check(lit, name=record["options"]["light"], sample=sample, seed=seed)
    skies = dict.fromkeys([*_skies(lit, name, record), *_bundles(lit, name, record)])
    with warnings.catch_warnings():
        # They were given when the mesh was lit.
        warnings.simplefilter("ignore", UserWarning)
        # Fur is one light; other blocks may have a scene each, and contours beside bands none.
        whole = [lit] if record["filter"] == "fur" else list(blocks.all_blocks(lit))
        if record["filter"] == "isoluminance":
            whole = [block for block in whole if records.read(block, name)]
        runs = [run for part in whole for run in _runs(part, name, drawing)]
    return Report(runs=tuple(runs), skies=tuple(skies))


def _skies(lit: pv.DataSet | pv.MultiBlock, name: str, record: Keywords) -> Iterator[str]:
    """Yield the errors of the skies that have a name, or by which a mesh was lit, in words."""
    used = name if record["filter"] == "sky" else record["options"].get("occlusion")
    for block in blocks.all_blocks(lit) if used else ():
        sky = records.read(block, used) or {}
        if sky.get("filter") != "sky":
            continue
        text, error, requested = "error unknown", sky["error"], sky["requested"]
        if isinstance(error, float) and isinstance(requested, float):
            text = f"error {error:.2g} or less at 95 of 100 points"
            if error > requested:
                text += f" ({requested:g} was requested)"
        text = f"sky of {sky['points']} points: {text}, as estimated, {sky['method']}"
        if "between" in sky:
            text += f"; between the points {sky['between']:.2g} or less at 95 of 100 places"
        yield text


def _bundles(lit: pv.DataSet | pv.MultiBlock, name: str, record: Keywords) -> Iterator[str]:
    """Yield the errors of the light inside the bundles by which a mesh was lit, in words."""
    for block in blocks.all_blocks(lit) if record["options"].get("bundle") else ():
        facts = (records.read(block, name) or {}).get("bundle")
        if isinstance(facts, dict) and facts.get("error"):
            error, mean = max(facts["error"]), max(facts["mean_error"])
            yield (
                f"bundle at {block.n_points} points: error {error:.2g} or less at 95 of 100 points,"
                f" of the mean share {mean:.2g} or less, as estimated, rays through cylinders"
            )


def _runs(mesh: pv.DataSet | pv.MultiBlock, name: str, drawing: RandomRows) -> Iterator[Run]:
    """Yield the runs of a mesh, of one dataset unless it is fur."""
    record = records.provenance(mesh, name)
    made_by, shadow = record["filter"], record["options"].get("name")
    if made_by == "isoluminance":
        # Of bands of equal luminance, or of the contours beside them.
        (bound,) = np.asarray(mesh.field_data[f"{name}_error"])
        yield Run(
            points=mesh.n_points, terms=tuple(record["terms"]), precision=record["precision"],
            bytes=np.asarray(mesh.cell_data[name]).nbytes, invalid=record["invalid"],
            bound=float(bound), unmeasured=BANDED,
        )  # fmt: skip
        return
    if made_by in ("relief_day", "relief_shadow") and shadow in records.made(mesh, shadow):
        yield _of_shadow(mesh, shadow, records.provenance(mesh, shadow), drawing)
    if made_by not in ("relief_day", "sky") and not (made_by == "relief_shadow" and name == shadow):
        for lit in relight.lit_again(mesh, name):
            yield _of_light(lit, name, drawing)


def _of_shadow(mesh: pv.DataSet, name: str, record: Keywords, drawing: RandomRows) -> Run:
    """Return the run of a cos-theta shadow."""
    shadows, options = relight.shadows_of(mesh, record["options"], Scene.from_dict(record["scene"]))
    ours, count = records.made(mesh, name), len(shadows.lights)
    t = np.asarray(mesh.point_data[name]).reshape(mesh.n_points, -1)
    # A column of t for each light, or the mean of all.
    each, shares = [f"{name}_{i}" for i in range(count)], np.eye(count)
    if record["filter"] == "relief_day":
        t = t[:, directions_of(record["options"])[:, 2] > 0]
    elif set(each) <= ours:
        t = np.stack([np.asarray(mesh.point_data[key]) for key in each], axis=1)
    else:
        weight = np.array([light.intensity for light in shadows.lights])
        shares = (weight / weight.sum())[np.newaxis]
    valid = shadows.caster.valid
    good = np.flatnonzero(valid)
    effort = shadows.effort(options) * int(np.count_nonzero(shares[0]))
    # A ray costs ``effort`` tests, and all rays together TRIALS at most.
    rays = min(RAYS, max(TRIALS // effort, 1)) if effort else 0
    # A pair of a point and a column is drawn as one number.
    at = [divmod(int(k), len(shares)) for k in drawing.of(good.size * len(shares), rays)]
    off = [
        t[good[i], k]
        - sum(
            share * shadows.reference(int(good[i]), light, options)
            for light, share in enumerate(shares[k])
            if share
        )
        for i, k in at
    ]
    sample, error, rms = _errors(np.array(off, dtype=np.float64))
    return Run(
        points=len(t), terms=SHADOW, precision=t.dtype.name, bytes=_bytes(mesh, name),
        invalid=int(np.count_nonzero(~valid)), sample=sample, error=error, rms=rms,
        unmeasured=SHADOWED if drawing.sample else "",
    )  # fmt: skip


def _of_light(lit: relight.Relit, name: str, drawing: RandomRows) -> Run:
    """Return the run of light that was computed once more."""
    mesh, inputs, scene, options = lit.source.mesh, lit.inputs, lit.scene, lit.source.options
    stored = np.asarray(mesh.point_data[name])
    shading = dataclasses.replace(lit.shading, luminance=stored)
    count = stored.size
    drawn = np.sort(drawing.of(count, count))
    off, disagreed = errors_at(drawn, inputs, scene, shading, options)
    places: Array = np.empty(0)
    if inputs.cells is not None and drawing.sample and between.measurable(inputs):
        places = between.measure(
            inputs, scene, options, shading, inputs.cells(), count=drawing.sample,
            seed=drawing.seed,
        )  # fmt: skip
    sample, error, rms = _errors(off)
    _, largest, mean = _errors(places)
    return Run(
        points=count,
        bright=int(np.count_nonzero((between.columns(shading) > 1).any(axis=1))),
        terms=shading.plan.terms,
        precision=shading.plan.dtype.name,
        seconds=shading.seconds,
        bytes=_bytes(mesh, name),
        sample=sample, error=error, rms=rms,
        invalid=shading.invalid,
        disagreed=disagreed,
        places=len(places),
        between=largest,
        between_rms=mean,
        visible=float(np.mean(places > VISIBLE)) if len(places) else math.nan,
        unmeasured=_unmeasured(inputs, shading, len(places)) if drawing.sample else "",
    )  # fmt: skip


def errors_at(
    rows: Indices, inputs: ShadingInputs, scene: Scene, shading: Shading, options: ShadingOptions
) -> tuple[Array, int]:
    """Return the errors of light at rows, and how many only one implementation could light.

    ``inputs``, ``scene`` and ``options`` are as :func:`vizlight.shading.engine.run` takes them; an
    error is the largest difference of luminance and colour of a row that both could light.
    """
    # The points are less an origin, and lights and eye are moved likewise.
    if inputs.origin is not None:
        scene = scene.moved([-x for x in inputs.origin])
    # A tangent counts as dependent from the same share on as in the type of the engine.
    apart = frames.default_rtol(shading.plan.n, shading.plan.dtype)
    lights = [reference(inputs, int(i), scene, options, apart) for i in rows]
    got = between.columns(shading, rows)
    true = np.array([[lit.luminance, *lit.rgb] for lit in lights]).reshape(got.shape)
    valid, finite = shading.valid[rows], np.isfinite(true[:, 0])
    # Points that one of both calls invalid have no difference; they are counted as disagreed.
    both = valid & finite
    off = np.abs(got[both] - true[both]).max(axis=1, initial=0.0)
    return np.asarray(off), int(np.count_nonzero(valid != finite))


def _errors(off: Array) -> tuple[int, float, float]:
    """Return the number of finite errors, the largest and the root mean square, NaN without any."""
    off = np.abs(off[np.isfinite(off)])
    if not off.size:
        return 0, math.nan, math.nan
    return off.size, float(off.max()), float(np.sqrt(np.mean(off * off)))


def _bytes(mesh: pv.DataSet, name: str) -> int:
    return sum(np.asarray(mesh.point_data[key]).nbytes for key in records.made(mesh, name))


def _unmeasured(inputs: ShadingInputs, shading: Shading, places: int) -> str:
    """Return the part of the error between the points that was not measured, and why."""
    if inputs.shadow is not None:
        return SHADOWED
    if inputs.repeat > 1 or inputs.fur_height is not None:
        return "fur, which light passes on a way of its own at each place"
    if inputs.transmittance is not None or inputs.occlusion is not None:
        return "light inside a bundle, or in the shade of the sky, whose shares the points have"
    if not places:
        return "points without cells between them, or cells without light"
    k = inputs.layout.k
    if k is not None and k > 1 and "specular" in shading.plan.terms:
        return (
            "the peaks of highlights, which have no closed form for several tangents per point: "
            "one that is smaller than a cell is seen only where a place falls on it"
        )
    return ""


def reference(
    inputs: ShadingInputs, i: int, scene: Scene, options: ShadingOptions, apart: float
) -> oracle.OracleLight:
    """Return the light of one point by the oracle."""
    count, n = inputs.points.shape

    def numbers(rows: ArraySource | None) -> list[float] | None:
        if rows is None:
            return None
        # Points of a fibre share rows, which are fewer.
        at = i if rows.shape[0] == count else i // inputs.repeat
        values: list[float] = np.asarray(rows[at : at + 1], dtype=np.float64).ravel().tolist()
        return values

    def vectors(rows: ArraySource | None) -> list[list[float]] | None:
        flat = numbers(rows)
        return None if flat is None else [flat[j : j + n] for j in range(0, len(flat), n)]

    point, tangents = numbers(inputs.points), vectors(inputs.tangents)
    assert point is not None
    normal: Sequence[float] | None = numbers(inputs.normals)
    if inputs.dimensions is not None:
        dimension = numbers(inputs.dimensions)
        # A point alone is lit as if it faced the eye.
        if dimension == [0]:
            normal = oracle.FLOATS.toward(scene.view or View.isometric(n), point)[0]
        # A point of a line is lit by its tangent, and any other by its normal.
        tangents, normal = (tangents, None) if dimension == [1] else (None, normal)
    (height,) = numbers(inputs.fur_height) or [0.0]
    (occlusion,) = numbers(inputs.occlusion) or [1.0]
    return oracle.light(
        point,
        tangents,
        normal,
        scene,
        base_tangents=vectors(inputs.base_tangents),
        fur_height=height,
        shadow=numbers(inputs.shadow),
        transmittance=numbers(inputs.transmittance),
        occlusion=occlusion,
        model=options.model,
        exponent=options.exponent,
        conditioned=bool(options.conditioned),
        two_sided=inputs.two_sided,
        fur=inputs.fur,
        apart=apart,
    )
