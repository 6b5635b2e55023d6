"""Cost and error of the light: a record of the engine's runs while a report is open."""

from __future__ import annotations

import contextlib
import contextvars
import math
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight._context import assigned
from vizlight.model import frames
from vizlight.scene import View
from vizlight.shading.engine import observed
from vizlight.verify import between, oracle

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from vizlight._types import Array, Bools, Foreign, Indices
    from vizlight.scene import Scene
    from vizlight.shading.engine import Shading
    from vizlight.shading.inputs import ArraySource, ShadingInputs
    from vizlight.shading.options import ShadingOptions
    from vizlight.shading.results import Record


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
BANDED = (
    "a band has one light, and nothing is interpolated: the difference above is all of its error"
)


@dataclass(frozen=True, kw_only=True)
class Run:
    """One run of the engine.

    Attributes
    ----------
    points : int
        Number of points.
    terms : tuple of str
        Terms that were added up; ``("t",)`` for a cos-theta shadow.
    precision : str
        Type of the numbers.
    seconds : float
        Wall time of the run.
    bytes : int
        Size of the results: light, validity, components, colour.
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
    tinted : bool
        Whether it is the light that :func:`vizlight.tint` puts on colours, of points that a filter
        lit before.
    """

    points: int
    terms: tuple[str, ...]
    precision: str
    seconds: float
    bytes: int
    invalid: int
    sample: int
    error: float
    rms: float
    bright: int = 0
    disagreed: int = 0
    bound: float = math.nan
    places: int = 0
    between: float = math.nan
    between_rms: float = math.nan
    visible: float = math.nan
    unmeasured: str = ""
    tinted: bool = False

    @property
    def missed(self) -> float:
        """Share of the points that may be worse than the sample, with a confidence of 95 %."""
        # A sample of all points that could be lit has missed none.
        return 0.0 if self.sample + self.invalid >= self.points else unseen(self.sample)

    @property
    def nanoseconds(self) -> float:
        """Wall time per point, in ns."""
        return 1e9 * self.seconds / self.points if self.points else math.nan


@dataclass
class Report:
    """Runs of the engine, and the wall time while the report was open; see :func:`report`."""

    sample: int = 4096
    seed: int = 0
    runs: list[Run] = field(default_factory=list)
    #: What is known of each sky, in words.
    skies: list[str] = field(default_factory=list)
    seconds: float = 0.0
    #: Number of points that workers lit, which record nothing here.
    elsewhere: int = 0

    @property
    def points(self) -> int:
        """Number of points lit in all runs, or else of points with colours or with shadows."""
        shaded = [run for run in self.runs if run.terms != SHADOW]
        lit = [run for run in shaded if not run.tinted]
        return sum(run.points for run in lit or shaded or self.runs)

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
    def error(self) -> float:
        """Largest error of all samples; NaN without a sample."""
        return max((run.error for run in self.runs if run.error == run.error), default=math.nan)

    @property
    def between(self) -> float:
        """Largest error between the points of all runs; NaN if none was measured."""
        return max((run.between for run in self.runs if run.places), default=math.nan)

    @property
    def terms(self) -> tuple[str, ...]:
        """Terms of all runs, each once."""
        return tuple(dict.fromkeys(term for run in self.runs for term in run.terms))

    def __str__(self) -> str:
        lines = [*self.skies]
        if self.runs or not self.skies:
            lines.append(
                f"{self.points} points lit in {len(self.runs)} run(s), {self.seconds:.3f} s in "
                f"all, {self.bytes / 1e6:.3g} MB of light"
            )
        if self.bright:
            lines.append(f"{self.bright} points are brighter than 1, which a picture shows as 1")
        if self.elsewhere:
            lines.append(
                f"{self.elsewhere} points lit by workers, which record nothing: cost and error "
                "unknown; without map= they are measured"
            )
        for run in self.runs:
            what = "points on whose colours light was put" if run.tinted else "points"
            lines.append(
                f"{run.points} {what}, {run.precision}: {' + '.join(run.terms)}; "
                f"{run.seconds:.3g} s, {run.nanoseconds:.3g} ns per point, {run.bytes} bytes"
            )
            lines += _lines(run)
        if self.runs:
            lines.append("not measured: what a reader can read back, see vizlight.legibility")
        return "\n".join(lines)


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
        elif not math.isnan(run.bound):
            error, how = "difference", f"light at {run.sample} places from their band"
        text = f"  {error} {run.error:.2g} at most, {run.rms:.2g} RMS, {how}"
        if run.missed:
            text += f"; {_confident(run.missed)} of the points are worse"
    else:
        text = "  no sample: error unknown"
    if not math.isnan(run.bound):
        text += f"; stated bound {run.bound:.2g}"
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


_ACTIVE: contextvars.ContextVar[Report | None] = contextvars.ContextVar("report", default=None)
_TINTED: contextvars.ContextVar[bool] = contextvars.ContextVar("tinted", default=False)


@contextlib.contextmanager
def report(*, sample: int = 4096, seed: int = 0) -> Iterator[Report]:
    """Record the cost, the terms and the error of all light computed in this context.

    Parameters
    ----------
    sample : int, default: 4096
        Number of points of each run, drawn at random, that are computed again one by one, and of
        places between the points; 0 for none. A fault in 1 of 1,000 points or places is found by
        3,000 with a confidence of 95 %.
    seed : int, default: 0
        Seed of the drawing.

    Yields
    ------
    Report
        Report to print after the filters ran, with the attributes ``points``, ``terms``,
        ``seconds``, ``bytes``, ``error``, ``between``, ``invalid``, ``runs``, one for each mesh
        that was lit, and ``skies``, the facts of each sky.

    Raises
    ------
    TypeError, ValueError
        If an argument is not an integer of 0 or more.

    Notes
    -----
    The sample's light is computed from the scene itself, not from a plan. t of a cos-theta shadow
    is computed again on at most 64 rays, each against all cells of a height field on its way, or
    all triangles of a closed surface; at depth 0 the report gives no error. Bands of
    ``isoluminance`` are compared with the light at their middles. The time of the sample
    is not part of the reported time.

    The error between the points is the picture's: light that is interpolated over segments and
    triangles, against the light of normals and tangents that are interpolated and normalised, as a
    fragment shader computes it. It is computed by the engine in float64. It is not measured for
    fur, for cast shadows, for light inside a bundle, and for points without cells, and the report
    says so where it is not. Filters that other threads call are not recorded, nor light by the
    workers of ``pieces.light(..., map=)``, although the report counts its points.
    :func:`vizlight.legibility` measures which values a reader can read back from the picture.

    Examples
    --------
    >>> import pyvista as pv, vizlight
    >>> scene = vizlight.Scene(view=vizlight.View(direction=(0, 0, 1)))
    >>> with vizlight.report() as report:
    ...     lit = vizlight.illuminate(pv.Sphere(), scene)
    >>> report.error < 1e-5
    True
    """
    opened = Report(
        sample=_check.integer("sample", sample, low=0), seed=_check.integer("seed", seed, low=0)
    )
    start = time.perf_counter()
    with assigned(_ACTIVE, opened), observed(note):
        try:
            yield opened
        finally:
            opened.seconds += time.perf_counter() - start


@contextlib.contextmanager
def _checking() -> Iterator[Report | None]:
    """Give the open report, if any; the time of a check is not a cost of the light."""
    active, start = _ACTIVE.get(), time.perf_counter()
    yield active
    if active is not None:
        active.seconds -= time.perf_counter() - start


def _drawn(active: Report, count: int, most: int) -> Indices:
    """Return at most so many of a count of rows, drawn at random."""
    random = np.random.default_rng(active.seed)
    return random.choice(count, min(active.sample, most, count), replace=False)


def _largest(off: Array) -> tuple[float, float]:
    """Return the largest and the root mean square error; NaN without any."""
    if not off.size:
        return math.nan, math.nan
    return float(off.max()), float(np.sqrt(np.mean(off * off)))


def note(inputs: ShadingInputs, scene: Scene, shading: Shading, options: ShadingOptions) -> None:
    """Add a run of the engine to the open report, if any."""
    with _checking() as active:
        if active is None:
            return
        count = shading.luminance.size
        drawn = np.sort(_drawn(active, count, count))
        # A tangent counts as dependent from the same share on as in the type of the engine.
        apart = frames.default_rtol(shading.plan.n, shading.plan.dtype)
        oracle_lights = [reference(inputs, int(i), scene, options, apart) for i in drawn]
        got = between.columns(shading, drawn)
        true = np.array([[lit.luminance, *lit.rgb] for lit in oracle_lights]).reshape(got.shape)
        valid, finite = shading.valid[drawn], np.isfinite(true[:, 0])
        # Points that one of both calls invalid have no difference; they are counted as disagreed.
        both = valid & finite
        off = np.abs(got[both] - true[both]).max(axis=1, initial=0.0)
        places: Array = np.empty(0)
        if inputs.cells is not None and active.sample and between.measurable(inputs):
            places = between.measure(
                inputs, scene, options, shading, inputs.cells(), count=active.sample,
                seed=active.seed,
            )  # fmt: skip
        largest, mean = _largest(places)
        results = (
            shading.luminance, shading.valid, shading.diffuse, shading.specular, shading.rgb
        )  # fmt: skip
        _add(
            active,
            off,
            points=count,
            bright=int(np.count_nonzero((between.columns(shading) > 1).any(axis=1))),
            terms=shading.plan.terms,
            precision=shading.plan.dtype.name,
            seconds=shading.seconds,
            bytes=sum(array.nbytes for array in results if array is not None),
            invalid=shading.invalid,
            disagreed=int(np.count_nonzero(valid != finite)),
            places=len(places),
            between=largest,
            between_rms=mean,
            visible=float(np.mean(places > VISIBLE)) if len(places) else math.nan,
            tinted=_TINTED.get(),
            unmeasured=_unmeasured(inputs, shading, len(places)) if active.sample else "",
        )


def _add(active: Report, off: Array, **facts: Foreign) -> None:
    """Add a run with the errors of a sample and other facts."""
    off = off[np.isfinite(off)]
    error, rms = _largest(off)
    active.runs.append(Run(sample=off.size, error=error, rms=rms, **facts))


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


def note_ratio(
    t: Array, valid: Bools, seconds: float, size: int, reference: Callable[[int, int], float],
    effort: int,
) -> None:  # fmt: skip
    """Add a cos-theta shadow to the open report, if any.

    Parameters
    ----------
    t : ndarray, shape (n_points, n_lights)
        Cos-theta shadow of each light.
    valid : ndarray of bool, shape (n_points,)
        Points that have a shadow.
    seconds, size : float, int
        Wall time, and bytes of the results.
    reference : callable
        Takes the indices of a point and a light, returns t by a second implementation.
    effort : int
        Number of planes of nodes or triangles that ``reference`` tests; 0 if it cannot be called.
    """
    with _checking() as active:
        if active is None:
            return
        good, lights = np.flatnonzero(valid), t.shape[1]
        # A ray costs ``effort`` tests, and all rays together TRIALS at most.
        rays = min(RAYS, max(TRIALS // effort, 1)) if effort else 0
        # A pair of a point and a light is drawn as one number.
        at = [divmod(int(k), lights) for k in _drawn(active, good.size * lights, rays)]
        off = np.array([abs(t[good[i], k] - reference(int(good[i]), k)) for i, k in at])
        _add(
            active, off, points=len(t), terms=SHADOW, precision=t.dtype.name, seconds=seconds,
            bytes=size, invalid=int(np.count_nonzero(~valid)),
            unmeasured=SHADOWED if active.sample else "",
        )  # fmt: skip


@contextlib.contextmanager
def noted_sky(points: int) -> Iterator[Callable[[Sequence[Record]], None]]:
    """Give a function that adds the records of the skies of a mesh to the open report."""
    start, active = time.perf_counter(), _ACTIVE.get()

    def note(records: Sequence[Record]) -> None:
        if active is None:
            return
        seconds = time.perf_counter() - start
        each = 1e6 * seconds / max(points, 1)
        active.skies.append(
            f"{points} points see the sky; {seconds:.3g} s, {each:.3g} µs per point"
        )
        active.skies += [_of_sky(record) for record in records]

    yield note


def _of_sky(record: Record) -> str:
    """Return the errors of a sky in words."""
    text = "  error unknown"
    error, requested = record["error"], record["requested"]
    if isinstance(error, float) and isinstance(requested, float):
        text = f"  error {error:.2g} or less at 95 of 100 points, as estimated"
        if error > requested:
            text += f" ({requested:g} was requested)"
    text += f", {record['method']}"
    if "between" in record:
        text += f"; between the points {record['between']:.2g} or less at 95 of 100 places"
    return text


def note_bands(
    values: Array, points: int, places: Array, normals: Array, scene: Scene,
    terms: tuple[str, ...], seconds: float, size: int, bound: float, *, model: str,
) -> None:  # fmt: skip
    """Add bands of equal luminance to the open report, compared with the light at places."""
    with _checking() as active:
        if active is None:
            return
        off: Array = np.empty(0)
        if len(places):
            drawn = _drawn(active, len(places), len(places))
            true = [
                oracle.light(places[i].tolist(), None, normals[i].tolist(), scene, model=model)
                for i in drawn
            ]
            off = np.abs(values[drawn] - [lit.luminance for lit in true])
        _add(
            active, off, points=points, terms=terms, precision=values.dtype.name, seconds=seconds,
            bytes=size, invalid=0, bound=bound, unmeasured=BANDED if active.sample else "",
        )  # fmt: skip


def is_open() -> bool:
    """Return whether a report records the light of this context."""
    return _ACTIVE.get() is not None


def tinted() -> contextlib.AbstractContextManager[None]:
    """Record light in this context as the colours' light, of points that were lit before."""
    return assigned(_TINTED, True)


def note_stored(values: Array, name: str) -> None:
    """Add light on colours that is taken from the arrays of an earlier result."""
    active = _ACTIVE.get()
    if active is not None:
        said = f"light on colours as the arrays of {name!r} hold it, measured where that was lit"
        _add(
            active, np.empty(0), points=len(values), terms=("stored",), seconds=0.0, bytes=0,
            precision=values.dtype.name, invalid=0, tinted=True, unmeasured=said,
        )  # fmt: skip


@contextlib.contextmanager
def workers(points: Callable[[], int]) -> Iterator[None]:
    """Note that workers lit some points, unless they recorded runs in this context."""
    active = _ACTIVE.get()
    before = len(active.runs) if active is not None else 0
    yield
    if active is not None and len(active.runs) == before:
        active.elsewhere += points()


def paused() -> contextlib.AbstractContextManager[None]:
    """Record nothing in this context, for a filter that lights many points on its way."""
    return assigned(_ACTIVE, None)


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
