"""Every kernel on its hard cases against 50 digits: what is claimed, what is seen, pass or fail.

Inputs are directed at each singularity, down to one unit in the last place from it, and random. An
error is told in eps of its type and, where the claim is in other units (over ``|wi + wo|``, of the
result, of the size), in these. A claim passes if nothing seen is above it, and a defined value
(0, NaN, a refusal) if it is that exactly. What has a claim of its own, as powers below 1 have, is
a row of its own, and a claim is tight if its worst case comes within a factor 8 of it.
"""

from __future__ import annotations

import warnings
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight.studies import (
    _stability_engine,
    _stability_geometry,
    _stability_model,
    _stability_shapes,
)
from vizlight.studies._framework import Curve, Row, Study, words
from vizlight.studies._stability_checks import rows_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from vizlight.studies._stability_checks import Check

#: Inputs of a kernel and a type, and in a quick run.
INPUTS, QUICK = 10_600, 600
#: How many times what is seen a claim may be, and the inputs of a claim that can tell.
TIGHT, ENOUGH = 8.0, 1000

KERNELS: dict[str, tuple[Callable[..., Iterator[Check]], tuple[Any, ...]]] = {
    **_stability_model.CHECKS,
    **_stability_shapes.CHECKS,
    **_stability_geometry.CHECKS,
    **_stability_engine.CHECKS,
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


def loosest(rows: Sequence[Row]) -> dict[tuple[str, str], float]:
    """Return for each claim and type how many times it is what was seen at worst.

    A claim is that of a kernel, or of what it has an own claim for.
    """
    worst: dict[tuple[str, str], float] = {}
    for row in rows:
        claim = row.way, str(row.more["type"])
        worst[claim] = max(worst.get(claim, 0.0), float(row.more["seen / claimed"]))
    return {claim: 1 / ratio if ratio else np.inf for claim, ratio in worst.items()}


def verdict(rows: Sequence[Row]) -> str:
    """Return what holds, what does not, and how tight the claims are."""
    failed = [
        f"{row.way}, {row.more['type']} ({row.more['case']})"
        for row in rows
        if row.more[""] == "FAIL"
    ]
    inputs = sum(int(row.more["inputs"]) for row in rows)
    slack = loosest(rows)
    loose = [
        f"{claim}, {kind} {words(ratio)}" for (claim, kind), ratio in slack.items() if ratio > TIGHT
    ]
    said = (
        f"do not rely on the claims of {'; '.join(failed)}" if failed
        else f"rely on the docstrings: all {len(slack)} claims, each in its type, hold in all "
        f"{len(rows)} cases on {inputs} inputs"
    )  # fmt: skip
    tight = (
        "too few inputs to tell how tight they are" if inputs < ENOUGH * len(slack)
        else f"claims more than {TIGHT:g} times what is seen in their worst case: "
        f"{', '.join(loose)}" if loose
        else f"the worst case of each comes within a factor {words(max(slack.values()))} of what "
        "is claimed, other cases may be far below"
    )  # fmt: skip
    return f"{said}; {tight}"


def curve(row: Row) -> Curve:
    """Return what a row is drawn as: a colour for each part of the library, a mark for a type."""
    module = row.way.partition(".")[0]
    parts = {"model": _stability_model.CHECKS, "engine": _stability_engine.CHECKS}
    part = next(
        (name for name, checks in parts.items() if any(k.startswith(f"{module}.") for k in checks)),
        "geometry",
    )
    return Curve(part, str(row.more["type"]))


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
    curve=curve,
    diagonal="claimed = seen",
)
