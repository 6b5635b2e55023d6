"""What the kernels' checks of the stability suite share: one case, and its row of the table."""

from __future__ import annotations

import time
from typing import NamedTuple

import numpy as np
import oracles

from studies import Row

TYPES = (np.float32, np.float64)
DOUBLE = (np.float64,)
#: A claim above this, of results of size 1, says nothing: it passes, and shows no tightness.
VACUOUS = 1 / 16


#: Seconds of the work of the check that is being made.
SPENT = []


class Check(NamedTuple):
    """Results of one case: the values, the true ones, and the claim for each, in eps.

    ``regime`` names what has a claim of its own, such as powers below 1; it is a row of its own
    and has to be as tight as any other. A claim of 0 is of a value that is exact: a defined one.
    """

    case: str
    values: object
    true: object
    claimed: object
    regime: str = ""


def off(case, errors, claimed, regime=""):
    """Return a check of errors that are already differences, or parts of what they are parts of."""
    return Check(case, np.zeros(len(errors)), errors, claimed, regime)


def exactly(case, values, true):
    """Return a check of values that are defined: they have no error; NaN is NaN."""
    values, true = (np.asarray(v, dtype=np.float64) for v in (values, true))
    if values.shape != true.shape:
        return Check(case, [np.nan], [0.0], 0.0)
    same = (values == true) | (np.isnan(values) & np.isnan(true))
    return Check(case, (~same).astype(float).ravel(), [0.0] * same.size, 0.0)


def refused(case, work, word):
    """Return a check that a call is refused by a message that has a word."""
    said = ""
    try:
        timed(work)
    except ValueError as error:
        said = str(error)
    return Check(case, [0.0 if word in said else np.nan], [0.0], 0.0)


def timed(work, *args, **options):
    """Return what a call returns; its time is that of the check which is yielded next."""
    start = time.perf_counter()
    found = work(*args, **options)
    SPENT.append(time.perf_counter() - start)
    return found


def spread(count, kinds):
    """Return how many inputs each of some kinds has."""
    return max(count // len(kinds), 1)


def some(random, kinds, count):
    """Return all kinds, or as many at random as there are inputs if there are fewer."""
    if count >= len(kinds):
        return kinds
    return [kinds[i] for i in np.sort(random.permutation(len(kinds))[:count])]


def rows_of(kernel, dtype, checks):
    """Return a row for each case: the input that comes nearest to its claim, or passes it."""
    eps = float(np.finfo(dtype).eps)
    found = {}
    kind = np.dtype(dtype).name
    for check in checks:
        worst = (-1.0, 0.0, 0.0)
        for value, true, claimed in zip(
            np.ravel(check.values), check.true, np.broadcast_to(check.claimed, len(check.true)),
            strict=True,
        ):  # fmt: skip
            number, claim = float(value), float(claimed)
            if abs(number) < np.inf:
                seen = float(abs(oracles.exact(number) - true)) / eps
            else:
                seen = 0.0 if number == true else np.inf
            # A reference that is no number has found an error too.
            seen = np.inf if np.isnan(seen) else seen
            ratio = seen / claim if claim else (np.inf if seen else 0.0)
            if ratio <= 1 and claim * eps > VACUOUS:
                ratio = 0.0
            worst = max(worst, (ratio, seen, claim))
        ratio, seen, claimed = max(worst, (0.0, 0.0, 0.0))
        cost = 1e9 * sum(SPENT) / max(len(check.true), 1)
        SPENT.clear()
        way = f"{kernel}, {check.regime}" if check.regime else kernel
        before = found.get((way, check.case))
        count = len(check.true) + (int(before.more["inputs"]) if before else 0)
        if before and float(before.more["seen / claimed"]) >= ratio:
            found[way, check.case] = before._replace(more={**before.more, "inputs": count})
            continue
        more = {"type": kind, "case": check.case, "seen / claimed": ratio, "inputs": count}
        # Less than a millionth of eps is none.
        seen = seen if seen > 1e-6 else 0.0
        found[way, check.case] = Row(way, claimed, seen, cost, more)
    return [
        row._replace(
            more={**row.more, "": "pass" if float(row.more["seen / claimed"]) <= 1 else "FAIL"}
        )
        for row in found.values()
    ]
