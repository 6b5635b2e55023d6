"""Studies of speed against error, which ``vizlight study`` runs; each measures both in one run.

A study is a module of this package with a ``STUDY``, a :class:`vizlight.studies.Study`.
"""

from __future__ import annotations

import importlib
import pkgutil

from vizlight import _check
from vizlight.studies._framework import (
    Curve,
    Panel,
    Row,
    Study,
    cheapest,
    holding,
    order,
)
from vizlight.studies._results import Result, print_list, print_result, run

__all__ = [
    "Curve",
    "Panel",
    "Result",
    "Row",
    "Study",
    "cheapest",
    "holding",
    "load",
    "names",
    "order",
    "print_list",
    "print_result",
    "run",
]

#: Modules that serve the studies and are not studies themselves.
_NO_STUDIES = {"reference"}


def names() -> list[str]:
    """Return the names of the studies."""
    found = (module.name for module in pkgutil.iter_modules(__path__))
    return sorted(name for name in found if name[0] != "_" and name not in _NO_STUDIES)


def load(name: str, /) -> Study:
    """Return a study.

    Parameters
    ----------
    name : str
        Name of the study, one of :func:`names`.

    Returns
    -------
    Study

    Raises
    ------
    ValueError
        If there is no study of that name.
    """
    if not (isinstance(name, str) and name in names()):
        expected = f"one of {', '.join(names())}"
        raise ValueError(_check.message("study", expected, _check.describe(name)))
    study: Study = importlib.import_module(f"vizlight.studies.{name}").STUDY
    return study
