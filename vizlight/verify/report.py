"""Cost and error of the light: a record of the engine's runs while a report is open."""

from __future__ import annotations

import contextlib
import contextvars
import dataclasses
import math
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.model import frames
from vizlight.scene import View
from vizlight.shading.engine import observed
from vizlight.verify import between, oracle

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from vizlight._types import Array, Bools
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
        Number of points whose luminance, or a channel of whose colour, is above 1.
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
    finer : int or None
        Factor by which all segments or triangles must be shorter so that no such place is left;
        None if 128 is not enough.
    unmeasured : str
        What of the error between the points is not measured and why, in words; empty if all is.
    tinted : bool
        Whether it is the light that :func:`vizlight.tint` puts on colours, of points that a filter
        lit before.
    """

    points: int
    terms: tuple[str, ...]
    precision: str
    seconds: float
    bytes: int
    sample: int
    error: float
    rms: float
    invalid: int
    bright: int = 0
    disagreed: int = 0
    bound: float = math.nan
    places: int = 0
    between: float = math.nan
    between_rms: float = math.nan
    visible: float = math.nan
    finer: int | None = 1
    unmeasured: str = ""
    tinted: bool = False

    @property
    def missed(self) -> float:
        """Share of the points that may be worse than the sample, with a confidence of 95 %."""
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
    found = [f"{text}; {run.invalid} invalid"]
    if run.disagreed:
        found.append(
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
            if run.finer:
                text += f": cells 1/{run.finer} as long, or refining to 1/255, would do"
            else:
                text += (
                    ": cells 1/128 as long would not do; "
                    "refining to 1/255 leaves only places where the light jumps"
                )
        found.append(text)
    if run.unmeasured:
        found.append(f"  not measured between points: {run.unmeasured}")
    return found


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
        that was lit, and ``skies``, what is known of each sky.

    Raises
    ------
    TypeError, ValueError
        If an argument is not an integer of 0 or more.

    Notes
    -----
    The sample's light is computed from the scene itself, not from a plan. t of a cos-theta shadow
    is computed again on at most 64 rays, each against all cells of a height field on its way, or
    all triangles of a closed surface; at depth 0 the report gives no error. Bands of
    ``isoluminance`` are compared with the light at their middles. A point of the sample takes about
    40 µs, 60 µs for ``model="cylinder"``, and a ray 3 ms; this time is not part of the reported
    time.

    The error between the points is the picture's: light that is interpolated over segments
    and triangles, against the light of normals and tangents that are interpolated and normalised,
    as a fragment shader computes it. It is computed by the engine in float64, in some 4 ms for
    4,096 places and 0.1 µs for each cell. It is not measured for fur, for cast shadows, for
    light inside a bundle, and for points without cells, and the report says so where it is not.
    Filters that other threads call are not recorded, nor light by the workers of
    ``pieces.light(..., map=)``, whose points the report counts. What a reader can read back from
    the picture is another question: :func:`vizlight.legibility` measures it.

    Examples
    --------
    >>> import pyvista as pv, vizlight
    >>> scene = vizlight.Scene(view=vizlight.View(direction=(0, 0, 1)))
    >>> with vizlight.report() as report:
    ...     lit = vizlight.illuminate(pv.Sphere(), scene)
    >>> report.error < 1e-5
    True
    """
    made = Report(
        sample=_check.integer("sample", sample, low=0), seed=_check.integer("seed", seed, low=0)
    )
    token, start = _ACTIVE.set(made), time.perf_counter()
    try:
        with observed(note):
            yield made
    finally:
        made.seconds += time.perf_counter() - start
        _ACTIVE.reset(token)


def note(given: ShadingInputs, scene: Scene, shading: Shading, options: ShadingOptions) -> None:
    """Add a run of the engine to the open report, if there is one."""
    active = _ACTIVE.get()
    if active is None:
        return
    start = time.perf_counter()
    count = shading.luminance.size
    random = np.random.default_rng(active.seed)
    drawn = np.sort(random.choice(count, min(active.sample, count), replace=False))
    apart = frames.default_rtol(shading.plan.n, shading.plan.dtype)
    width = 1 if shading.rgb is None else 4
    reference = [_reference(given, int(i), scene, options, apart) for i in drawn]
    true = np.array([[lit.luminance, *lit.rgb] for lit in reference]).reshape(-1, width)
    got = shading.luminance[drawn, np.newaxis]
    got = got if shading.rgb is None else np.hstack([got, shading.rgb[drawn]])
    valid, known = shading.valid[drawn], np.isfinite(true[:, 0])
    both = valid & known
    off = np.abs(got[both] - true[both]).max(axis=1, initial=0.0)
    results = (
        shading.luminance, shading.valid, shading.diffuse, shading.specular, shading.rgb
    )  # fmt: skip
    places = _between(given, scene, shading, options, active)
    # The time of the check is not a cost of the light.
    active.seconds -= time.perf_counter() - start
    active.runs.append(
        Run(
            points=count,
            bright=_bright(shading),
            terms=shading.plan.terms,
            precision=shading.plan.dtype.name,
            seconds=shading.seconds,
            bytes=sum(array.nbytes for array in results if array is not None),
            sample=int(both.sum()),
            error=float(off.max()) if off.size else math.nan,
            rms=float(np.sqrt(np.mean(off * off))) if off.size else math.nan,
            invalid=shading.invalid,
            disagreed=int(np.count_nonzero(valid != known)),
            bound=math.nan,
            places=len(places.error),
            between=float(places.error.max()) if len(places.error) else math.nan,
            between_rms=(
                float(np.sqrt(np.mean(places.error**2))) if len(places.error) else math.nan
            ),
            visible=float(np.mean(places.error > VISIBLE)) if len(places.error) else math.nan,
            finer=places.finer,
            tinted=_TINTED.get(),
            unmeasured=_unmeasured(given, shading, len(places.error)) if active.sample else "",
        )
    )


def _between(
    given: ShadingInputs, scene: Scene, shading: Shading, options: ShadingOptions, active: Report
) -> between.Measured:
    """Return the error of interpolated light at random places between the points."""
    if given.cells is None or not active.sample or not between.measurable(given):
        return between.Measured(np.empty(0), 1)
    return between.measure(
        given, scene, options, shading, given.cells(), count=active.sample, seed=active.seed,
        allowed=VISIBLE,
    )  # fmt: skip


def _unmeasured(given: ShadingInputs, shading: Shading, places: int) -> str:
    """Return what of the error between the points was not measured, and why."""
    if given.shadow is not None:
        return SHADOWED
    if given.repeat > 1 or given.fur_height is not None:
        return "fur, which light passes on a way of its own at each place"
    if given.transmittance is not None or given.occlusion is not None:
        return "light inside a bundle, or in the shade of the sky, whose shares the points have"
    if not places:
        return "points without cells between them, or cells without light"
    k = given.layout.k
    if k is not None and k > 1 and "specular" in shading.plan.terms:
        return (
            "the peaks of highlights, which have no closed form for several tangents per point: "
            "one that is smaller than a cell is seen only where a place falls on it"
        )
    return ""


def _bright(shading: Shading) -> int:
    """Return the number of points whose light is above 1."""
    above = shading.luminance > 1
    if shading.rgb is not None:
        above = above | np.any(shading.rgb > 1, axis=1)
    return int(np.count_nonzero(above))


def note_ratio(
    t: Array, valid: Bools, seconds: float, size: int, reference: Callable[[int, int], float],
    effort: int,
) -> None:  # fmt: skip
    """Add a cos-theta shadow to the open report, if there is one.

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
    active = _ACTIVE.get()
    if active is None:
        return
    start = time.perf_counter()
    random, good = np.random.default_rng(active.seed), np.flatnonzero(valid)
    rays = min(active.sample, RAYS, max(TRIALS // effort, 1)) if effort else 0
    drawn = random.choice(good.size * t.shape[1], min(rays, good.size * t.shape[1]), replace=False)
    at = [(int(good[k // t.shape[1]]), int(k % t.shape[1])) for k in drawn]
    off = np.array([abs(t[i, light] - reference(i, light)) for i, light in at], dtype=np.float64)
    off = off[np.isfinite(off)]
    active.seconds -= time.perf_counter() - start
    invalid = int(np.count_nonzero(~valid))
    run = _run(off, SHADOW, t, seconds, size, len(t), invalid, math.nan)
    active.runs.append(dataclasses.replace(run, unmeasured=SHADOWED if active.sample else ""))


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
    found = "  error unknown"
    if record["error"] is not None:
        found = f"  error {record['error']:.2g} or less at 95 of 100 points, as estimated"
    found += f", {record['method']}"
    if "between" in record:
        found += f"; between the points {record['between']:.2g} or less at 95 of 100 places"
    return found


def note_bands(
    values: Array, points: int, places: Array, normals: Array, scene: Scene,
    terms: tuple[str, ...], seconds: float, size: int, bound: float, *, model: str,
) -> None:  # fmt: skip
    """Add bands of equal luminance to the open report, compared with the light at places."""
    active = _ACTIVE.get()
    if active is None:
        return
    start = time.perf_counter()
    random, count = np.random.default_rng(active.seed), len(places)
    drawn = random.choice(count, min(active.sample, count), replace=False)
    off = np.array(
        [
            abs(
                values[i]
                - oracle.light(
                    places[i].tolist(), None, normals[i].tolist(), scene, model=model,
                ).luminance
            )
            for i in drawn
        ],
        dtype=np.float64,
    )  # fmt: skip
    off = off[np.isfinite(off)]
    active.seconds -= time.perf_counter() - start
    run = _run(off, terms, values, seconds, size, points, 0, bound)
    active.runs.append(dataclasses.replace(run, unmeasured=BANDED if active.sample else ""))


def _run(
    off: Array, terms: tuple[str, ...], values: Array, seconds: float, size: int, points: int,
    invalid: int, bound: float,
) -> Run:  # fmt: skip
    return Run(
        points=points,
        terms=terms,
        precision=values.dtype.name,
        seconds=seconds,
        bytes=size,
        sample=off.size,
        error=float(off.max()) if off.size else math.nan,
        rms=float(np.sqrt(np.mean(off * off))) if off.size else math.nan,
        invalid=invalid,
        bound=bound,
    )


def is_open() -> bool:
    """Return whether a report records the light of this context."""
    return _ACTIVE.get() is not None


@contextlib.contextmanager
def tinted() -> Iterator[None]:
    """Record light in this context as the colours' light, of points that were lit before."""
    token = _TINTED.set(True)
    try:
        yield
    finally:
        _TINTED.reset(token)


def note_stored(values: Array, name: str) -> None:
    """Add light on colours that is taken from the arrays of an earlier result."""
    active = _ACTIVE.get()
    if active is not None:
        run = _run(np.empty(0), ("stored",), values, 0.0, 0, len(values), 0, math.nan)
        said = f"light on colours as the arrays of {name!r} hold it, measured where that was lit"
        active.runs.append(dataclasses.replace(run, tinted=True, unmeasured=said))


@contextlib.contextmanager
def workers(points: Callable[[], int]) -> Iterator[None]:
    """Note that workers lit some points, unless they recorded runs in this context."""
    active = _ACTIVE.get()
    before = len(active.runs) if active is not None else 0
    yield
    if active is not None and len(active.runs) == before:
        active.elsewhere += points()


@contextlib.contextmanager
def paused() -> Iterator[None]:
    """Record nothing in this context, for a filter that lights many points on its way."""
    token = _ACTIVE.set(None)
    try:
        yield
    finally:
        _ACTIVE.reset(token)


def _reference(
    given: ShadingInputs, i: int, scene: Scene, options: ShadingOptions, apart: float
) -> oracle.Lit:
    """Return the light of one point by the oracle."""
    n, row = given.points.shape[1], i // given.repeat
    own, shared = slice(i, (row + 1) * given.repeat, given.repeat), slice(row, row + 1)

    def numbers(rows: ArraySource, at: slice) -> list[float]:
        values: list[float] = np.asarray(rows[at], dtype=np.float64).ravel().tolist()
        return values

    def vectors(rows: ArraySource | None) -> list[list[float]] | None:
        if rows is None:
            return None
        flat = numbers(rows, own if rows.shape[0] == given.points.shape[0] else shared)
        return [flat[j : j + n] for j in range(0, len(flat), n)]

    tangents = vectors(given.tangents)
    normal: Sequence[float] | None = None
    if given.normals is not None:
        normal = numbers(given.normals, shared)
    if given.dimensions is not None:
        dimension = numbers(given.dimensions, own)[0]
        if dimension == 0:
            eye = scene.view or View.isometric(n)
            normal = oracle.FLOATS.toward(eye, numbers(given.points, own))[0]
        tangents, normal = (tangents, None) if dimension == 1 else (None, normal)
    return oracle.light(
        numbers(given.points, own),
        tangents,
        normal,
        scene,
        base_tangents=vectors(given.base_tangents),
        fur_height=0.0 if given.fur_height is None else numbers(given.fur_height, own)[0],
        shadow=None if given.shadow is None else numbers(given.shadow, own),
        transmittance=(None if given.transmittance is None else numbers(given.transmittance, own)),
        occlusion=1.0 if given.occlusion is None else numbers(given.occlusion, own)[0],
        model=options.model,
        exponent=options.exponent,
        conditioned=bool(options.conditioned),
        two_sided=given.two_sided,
        fur=given.fur,
        apart=apart,
    )
