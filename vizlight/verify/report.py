"""What light cost and how wrong it is: a record of the engine's runs while one is asked for."""

from __future__ import annotations

import contextlib
import contextvars
import math
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight import _check
from vizlight.model import frames
from vizlight.shading.engine import observed
from vizlight.verify import oracle

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vizlight.scene import Scene
    from vizlight.shading.engine import Shading
    from vizlight.shading.inputs import ShadingInputs
    from vizlight.shading.options import ShadingOptions


#: Rays through a solid that are sampled again, at most.
RAYS = 64
#: Places or triangles that are tried in all.
TRIALS = 20_000_000
SHADOW = ("t",)


@dataclass(frozen=True, kw_only=True)
class Run:
    """One run of the engine.

    Attributes
    ----------
    points : int
    terms : tuple of str
        That were added up; ``("t",)`` for a cos-theta shadow.
    precision : str
    seconds : float
        Wall time of the run.
    bytes : int
        Of the results: light, validity, components, colour.
    sample : int
        Points drawn at random and lit again, one by one in float64, by formulas that share no code
        with the engine.
    error, rms : float
        Largest and root mean square difference of their luminance and colour, or of t; NaN
        without a sample.
    invalid : int
        Points that could not be lit.
    disagreed : int
        Points of the sample that only one of both could light.
    bound : float
        Of what ``tolerance=`` chose, or of the bands of ``isoluminance``; NaN without.
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
    disagreed: int = 0
    bound: float = math.nan

    @property
    def nanoseconds(self) -> float:
        """Wall time for a point, in ns."""
        return 1e9 * self.seconds / self.points if self.points else math.nan


@dataclass
class Report:
    """Runs of the engine, and the wall time of all that was done meanwhile; see :func:`report`."""

    sample: int = 256
    seed: int = 0
    runs: list[Run] = field(default_factory=list)
    seconds: float = 0.0

    @property
    def points(self) -> int:
        """Points lit in all runs; those of shadows where nothing was lit."""
        lit = [run.points for run in self.runs if run.terms != SHADOW]
        return sum(lit or [run.points for run in self.runs])

    @property
    def invalid(self) -> int:
        """Points that could not be lit."""
        return sum(run.invalid for run in self.runs)

    @property
    def bytes(self) -> int:
        """Bytes of all results."""
        return sum(run.bytes for run in self.runs)

    @property
    def error(self) -> float:
        """The largest error seen in the samples; NaN without one."""
        return max((run.error for run in self.runs if run.error == run.error), default=math.nan)

    @property
    def terms(self) -> tuple[str, ...]:
        """The terms of any run."""
        return tuple(dict.fromkeys(term for run in self.runs for term in run.terms))

    def __str__(self) -> str:
        lines = [
            f"{self.points} points lit in {len(self.runs)} run(s), {self.seconds:.3f} s in all, "
            f"{self.bytes / 1e6:.3g} MB of light"
        ]
        for run in self.runs:
            lines.append(
                f"{run.points} points, {run.precision}: {' + '.join(run.terms)}; "
                f"{run.seconds:.3g} s, {run.nanoseconds:.3g} ns a point, {run.bytes} bytes"
            )
            wrong = (
                f"  error {run.error:.2g} at most, {run.rms:.2g} RMS, of {run.sample} points lit "
                "again one by one in float64" if run.sample else "  no point to light again"
            )  # fmt: skip
            if not math.isnan(run.bound):
                wrong += f"; stated bound {run.bound:.2g}"
            lines.append(f"{wrong}; {run.invalid} invalid")
            if run.disagreed:
                lines.append(
                    f"  {run.disagreed} points of the sample are valid in one of both only"
                )
        return "\n".join(lines)


_ACTIVE: contextvars.ContextVar[Report | None] = contextvars.ContextVar("report", default=None)


@contextlib.contextmanager
def report(*, sample: int = 256, seed: int = 0) -> Iterator[Report]:
    """Record what filters do while this context is entered: cost, terms, error.

    Parameters
    ----------
    sample : int, default: 256
        Points of each run, drawn at random, that are lit again one by one; 0 for none.
    seed : int, default: 0
        Of the drawing.

    Yields
    ------
    Report
        ``print`` it after the filters ran, or read ``points``, ``terms``, ``seconds``, ``bytes``,
        ``error``, ``invalid``, and ``runs``, one for each mesh that was lit.

    Raises
    ------
    TypeError, ValueError
        If an argument is not an integer of 0 or more.

    Notes
    -----
    The sample's light is computed from the scene as given, not from a plan: its error includes what
    ``tolerance=`` and ``highlight_error=`` chose. t of a cos-theta shadow is found again on at most
    64 rays: at 20,000 places of each in a height field, against all triangles of a closed surface;
    a depth of 0 is told without an error. Bands of ``isoluminance`` are compared with the light at
    their middles. About 40 µs a point of the sample, 3 ms for ``model="cylinder"`` and a ray, not
    counted as time.

    Examples
    --------
    >>> import pyvista as pv, vizlight
    >>> scene = vizlight.Scene(view=vizlight.View(direction=(0, 0, 1)))
    >>> with vizlight.report() as told:
    ...     lit = vizlight.illuminate(pv.Sphere(), scene)
    >>> told.error < 1e-5
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
    """Add a run of the engine to the report that is asked for, if one is."""
    active = _ACTIVE.get()
    if active is None:
        return
    start = time.perf_counter()
    count = shading.luminance.size
    random = np.random.default_rng(active.seed)
    drawn = np.sort(random.choice(count, min(active.sample, count), replace=False))
    apart = frames.default_rtol(shading.plan.n, shading.plan.dtype)
    width = 1 if shading.rgb is None else 4
    again = [_again(given, int(i), scene, options, apart) for i in drawn]
    true = np.array(again, dtype=np.float64).reshape(-1, width)
    got = shading.luminance[drawn, np.newaxis]
    got = got if shading.rgb is None else np.hstack([got, shading.rgb[drawn]])
    valid, known = shading.valid[drawn], np.isfinite(true[:, 0])
    both = valid & known
    off = np.abs(got[both] - true[both]).max(axis=1, initial=0.0)
    results = (
        shading.luminance, shading.valid, shading.diffuse, shading.specular, shading.rgb
    )  # fmt: skip
    choice = shading.plan.choice
    # What the check itself takes is no cost of the light.
    active.seconds -= time.perf_counter() - start
    active.runs.append(
        Run(
            points=count,
            terms=shading.plan.terms,
            precision=shading.plan.dtype.name,
            seconds=shading.seconds,
            bytes=sum(array.nbytes for array in results if array is not None),
            sample=int(both.sum()),
            error=float(off.max()) if off.size else math.nan,
            rms=float(np.sqrt(np.mean(off * off))) if off.size else math.nan,
            invalid=shading.invalid,
            disagreed=int(np.count_nonzero(valid != known)),
            bound=choice.bound if choice.tolerance else math.nan,
        )
    )


def note_ratio(
    t: Any, valid: Any, seconds: float, size: int, again: Callable[[int, int], float], effort: int
) -> None:
    """Add a cos-theta shadow to the report.

    t of each light, bytes, what finds one of them again, and what that tries; 0: it cannot.
    """
    active = _ACTIVE.get()
    if active is None:
        return
    start = time.perf_counter()
    random, good = np.random.default_rng(active.seed), np.flatnonzero(valid)
    rays = min(active.sample, RAYS, max(TRIALS // effort, 1)) if effort else 0
    drawn = random.choice(good.size * t.shape[1], min(rays, good.size * t.shape[1]), replace=False)
    at = [(int(good[k // t.shape[1]]), int(k % t.shape[1])) for k in drawn]
    off = np.array([abs(t[i, light] - again(i, light)) for i, light in at], dtype=np.float64)
    off = off[np.isfinite(off)]
    active.seconds -= time.perf_counter() - start
    invalid = int(np.count_nonzero(~valid))
    active.runs.append(_run(off, SHADOW, t, seconds, size, len(t), invalid, math.nan))


def note_bands(
    values: Any, points: int, places: Any, normals: Any, scene: Scene, terms: tuple[str, ...],
    seconds: float, size: int, bound: float, **options: Any,
) -> None:  # fmt: skip
    """Add bands of equal luminance to the report, to be compared with the light at places."""
    active = _ACTIVE.get()
    if active is None:
        return
    start = time.perf_counter()
    random, count = np.random.default_rng(active.seed), len(places)
    drawn = random.choice(count, min(active.sample, count), replace=False)
    off = np.array(
        [
            abs(values[i] - oracle.light(place, None, normal, scene, **options)[0])
            for i, place, normal in zip(
                drawn, places[drawn].tolist(), normals[drawn].tolist(), strict=True
            )
        ],
        dtype=np.float64,
    )
    off = off[np.isfinite(off)]
    active.seconds -= time.perf_counter() - start
    active.runs.append(_run(off, terms, values, seconds, size, points, 0, bound))


def _run(
    off: Any, terms: tuple[str, ...], values: Any, seconds: float, size: int, points: int,
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


@contextlib.contextmanager
def paused() -> Iterator[None]:
    """Record nothing of what is done meanwhile: a filter that lights much to make little."""
    token = _ACTIVE.set(None)
    try:
        yield
    finally:
        _ACTIVE.reset(token)


def _again(
    given: ShadingInputs, i: int, scene: Scene, options: ShadingOptions, apart: float
) -> list[float]:
    """Return the light of one point by the scalar formulas."""
    n, row = given.points.shape[1], i // given.repeat
    own, shared = slice(i, (row + 1) * given.repeat, given.repeat), slice(row, row + 1)

    def numbers(rows: Any, at: slice) -> Any:
        return np.asarray(rows[at], dtype=np.float64).ravel()

    def vectors(rows: Any) -> Any:
        if rows is None:
            return None
        at = own if rows.shape[0] == given.points.shape[0] else shared
        return numbers(rows, at).reshape(-1, n).tolist()

    return oracle.light(
        numbers(given.points, own).tolist(),
        vectors(given.tangents),
        None if given.normals is None else numbers(given.normals, shared).tolist(),
        scene,
        carrier=vectors(given.base_tangents),
        depth=(None if given.fur_height is None else float(numbers(given.fur_height, own)[0])),
        shadow=None if given.shadow is None else numbers(given.shadow, own).tolist(),
        model=options.model,
        compensate=options.compensate,
        conditioned=bool(options.conditioned),
        two_sided=options.two_sided,
        terminator=options.terminator,
        fur=given.fur,
        apart=apart,
    )
