"""Every kernel on its hard cases against 50 digits: what is claimed, what is seen, pass or fail.

Inputs are directed at each singularity, down to one unit in the last place from it, and random. An
error is given in eps of its type and, where the claim is in other units (over ``|wi + wo|``, of the
result, of the size), in these. A claim passes if no error seen is above it, and a defined value
(0, NaN, a refusal) if it is exactly that. What has a claim of its own, as powers below 1 have, has
a row of its own, and a claim is tight if its worst case comes within a factor 8 of it.
"""

import csv
import warnings
from functools import partial

import numpy as np

from stability import geometry, model, shapes
from stability.checks import rows_of
from studies import Curve, Result, Row, Study

#: Number of inputs of a kernel and a type, and in a quick run.
INPUTS, QUICK = 10_600, 600
#: Largest ratio of claim to error of a tight claim, and number of inputs that can tell.
TIGHT, ENOUGH = 8.0, 1000

#: Checks of each kernel, and the types that it is checked in.
KERNELS = {**model.CHECKS, **shapes.CHECKS, **geometry.CHECKS}


def measure(kernel, dtype, count):
    """Return the rows of one kernel in one type."""
    work, _ = KERNELS[kernel]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return rows_of(kernel, dtype, work(dtype, count, np.random.default_rng(50)))


def steps(quick):
    """Return a step for each kernel and type."""
    count = QUICK if quick else INPUTS
    return [
        partial(measure, kernel, dtype, count)
        for kernel, (_, types) in KERNELS.items()
        for dtype in types
    ]


def loosest(rows):
    """Return for each claim and type its ratio to the largest error seen.

    A claim is that of a kernel, or of a case that has a claim of its own.
    """
    worst = {}
    for row in rows:
        claim = row.way, str(row.more["type"])
        worst[claim] = max(worst.get(claim, 0.0), float(row.more["seen / claimed"]))
    return {claim: 1 / ratio if ratio else np.inf for claim, ratio in worst.items()}


def verdict(rows):
    """Return what holds, what does not, and how tight the claims are."""
    failed = [
        f"{row.way}, {row.more['type']} ({row.more['case']})"
        for row in rows
        if row.more[""] == "FAIL"
    ]
    inputs = sum(int(row.more["inputs"]) for row in rows)
    slack = loosest(rows)
    loose = [
        f"{claim}, {kind} {ratio:.3g}" for (claim, kind), ratio in slack.items() if ratio > TIGHT
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
        else f"the worst case of each comes within a factor {max(slack.values()):.3g} of what "
        "is claimed, other cases may be far below"
    )  # fmt: skip
    return f"{said}; {tight}"


def worst(rows):
    """Return headings and, for each kernel and type, the case that comes nearest to its claim."""
    headings = ["kernel", "type", "inputs", "worst case", "claimed, eps", "seen, eps", ""]
    lines = []
    for key in dict.fromkeys((row.way, row.more["type"]) for row in rows):
        own = [row for row in rows if (row.way, row.more["type"]) == key]
        top = max(own, key=lambda row: float(row.more["seen / claimed"]))
        inputs = sum(int(row.more["inputs"]) for row in own)
        more = top.more
        lines.append([*key, f"{inputs}", more["case"], top.parameter, top.error, more[""]])
    return headings, lines


def read(path):
    """Return the result that :meth:`Result.write_csv` wrote to a file."""
    with path.open(newline="", encoding="utf-8") as file:
        (*_, case), *lines = csv.reader(file)
    names = ("type", "case", "seen / claimed", "inputs", case)
    rows = [
        Row(line[0], *map(float, line[1:4]), dict(zip(names, line[4:], strict=True)))
        for line in lines
    ]
    return Result(path.stem, STUDY, rows)


def curve(row):
    """Return the curve of a row: a colour for each part of the library, a mark for a type."""
    module = row.way.partition(".")[0]
    in_model = any(kernel.startswith(f"{module}.") for kernel in model.CHECKS)
    part = "model" if in_model else "geometry"
    return Curve(part, str(row.more["type"]))


STUDY = Study(
    approximates="every kernel in float32 and float64 on its hard cases",
    reference="mpmath at 50 digits",
    parameter="claimed, eps",
    error="seen, eps",
    cost="ns per input",
    steps=steps,
    axes=("parameter", "error"),
    joined=False,
    curve=curve,
    diagonal="claimed = seen",
)
