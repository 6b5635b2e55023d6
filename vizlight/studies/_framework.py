"""Form of a study: its subject, its reference, its measurements, and helpers for verdicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from vizlight import _check

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    Axis = Literal["parameter", "error", "cost"]

#: One pixel value of a picture of 8 bits, an error that is not visible.
PIXEL = 1 / 255
#: Ratio of costs below which one is clearly lower than the other, in spite of timing noise.
CLEAR = 0.85


class Row(NamedTuple):
    """One measurement.

    Attributes
    ----------
    way : str
        Method that is measured. The rows of one method form one curve of the figure.
    parameter : float or str
        Value of the parameter that the study varies.
    error, cost : float
        Error and cost in the units of the study; NaN if not measured.
    more : mapping
        Further columns by heading, each a number or a string.
    """

    way: str
    parameter: float | str
    error: float
    cost: float
    more: Mapping[str, float | str] = {}


class Curve(NamedTuple):
    """Curve of a figure: curves of one name share a colour, curves of one kind a line style."""

    name: str
    kind: str = ""


def by_way(row: Row) -> Curve | None:
    """Return the curve of a row in a panel with one curve per method."""
    return Curve(row.way)


@dataclass(frozen=True, kw_only=True)
class Panel:
    """One panel of a figure with logarithmic axes.

    Attributes
    ----------
    axes : tuple of str
        Quantities on the x and y axes, of ``parameter``, ``error`` and ``cost``.
    joined : bool
        Whether the points of a curve are joined by a line.
    curve : callable
        Function from a row to its :class:`Curve`, or to None if the panel does not show the row.
    diagonal : str
        Label of the line y = x, which is drawn unless the label is empty.
    x : str
        Label of the x axis. Default: the heading of its column in the table.
    slopes : tuple of float
        Slopes in theory, which are drawn beside the curves.
    """

    axes: tuple[Axis, Axis] = ("cost", "error")
    joined: bool = True
    curve: Callable[[Row], Curve | None] = by_way
    diagonal: str = ""
    x: str = ""
    slopes: tuple[float, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Study(Panel):
    """Description of a study: its subject, its steps, its verdict and its figure.

    The panel attributes of the study describe the first panel of the figure.

    Attributes
    ----------
    approximates, reference : str
        Quantity that is approximated, and the reference for its errors.
    parameter, error, cost : str
        Headings of the table for the varied parameter and the two measures, with their units.
    steps : callable
        Function of a bool, whether the run is quick. It returns functions without arguments,
        each of which returns some rows.
    verdict : callable
        Function from all rows to a recommendation in one sentence with their numbers.
    beside : tuple of Panel
        Further panels of the figure.
    """

    approximates: str
    reference: str
    parameter: str
    error: str
    cost: str
    steps: Callable[[bool], Sequence[Callable[[], Iterable[Row]]]]
    verdict: Callable[[Sequence[Row]], str]
    beside: tuple[Panel, ...] = ()


def cheapest(rows: Iterable[Row], limit: float = PIXEL, *, usual: Row | None = None) -> Row | None:
    """Return the row of the lowest cost with an error within a limit, or None.

    Parameters
    ----------
    rows : iterable of Row
        Rows to choose from.
    limit : float, default: 1/255
        Largest allowed error, in the unit of the rows.
    usual : Row, optional
        Default among the rows. It is returned if it is within the limit and no other row is
        clearly cheaper.
    """
    limit = _check.number("limit", limit, low=0.0)
    good = [row for row in _rows(rows) if row.error <= limit and not math.isnan(row.cost)]
    best = min(good, key=lambda row: row.cost) if good else None
    if best and usual in good and usual and best.cost > CLEAR * usual.cost:
        return usual
    return best


def holding(rows: Iterable[Row], limit: float = PIXEL, *, coarse: bool = True) -> Row | None:
    """Return the coarsest row such that it and all finer rows are within a limit, or None.

    Parameters
    ----------
    rows : iterable of Row
        Rows of one method, with numbers as parameters.
    limit : float, default: 1/255
        Largest allowed error, in the unit of the rows.
    coarse : bool, default: True
        Whether a larger parameter is coarser, like a step. Otherwise it is finer, like a count.
    """
    limit = _check.number("limit", limit, low=0.0)
    coarse = _check.boolean("coarse", coarse)
    found = None
    for row in sorted(_rows(rows), key=lambda row: float(row.parameter), reverse=not coarse):
        if not row.error <= limit:
            break
        found = row
    return found


def order(rows: Sequence[Row]) -> float:
    """Return the order of convergence: the least-squares slope of log error on log parameter.

    Parameters
    ----------
    rows : sequence of Row
        Two rows or more of one method, with parameters and errors above 0.
    """
    rows = _rows(rows)
    least = min((min(float(row.parameter), row.error) for row in rows), default=0.0)
    if len({row.parameter for row in rows}) < 2 or not 0 < least < math.inf:
        expected = "two rows or more, with parameters and errors above 0"
        raise ValueError(_check.message("rows", expected, _check.describe(rows)))
    return slope([float(row.parameter) for row in rows], [row.error for row in rows])


def _rows(rows: object) -> list[Row]:
    """Return rows as a list, each a :class:`Row`."""
    given: list[Any] = list(rows) if isinstance(rows, list | tuple | Iterator) else [rows]
    for row in given:
        _check.instance("rows", row, Row, home="studies")
    return given


def slope(x: Sequence[float], y: Sequence[float]) -> float:
    """Return the least-squares slope of log y on log x."""
    u, v = np.log(np.array([x, y], dtype=np.float64))
    u, v = u - u.mean(), v - v.mean()
    return float(u @ v / (u @ u))


def words(value: float) -> str:
    """Return a number for a sentence: three digits, and no exponent below 1e7."""
    return f"{value:.0f}" if 1000 <= abs(value) < 1e7 else f"{value:.3g}"


def span(values: Iterable[float]) -> str:
    """Return the range of some numbers for a sentence."""
    known = list(values)
    least, largest = words(min(known)), words(max(known))
    return least if least == largest else f"{least} to {largest}"
