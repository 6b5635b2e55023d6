"""Fixture of pytest for snapshot tests: pictures beside the tests, named for them.

A project asks for it in its ``conftest.py``, by ``pytest_plugins = ["vizlight.draw.snapshots"]``;
elsewhere pytest does not load it. In a test ``same_picture(plotter)`` compares with
``pictures/MODULE/TEST.png`` beside the test's file, ``same_picture(plotter, "left")`` with
``TEST-left.png``, for tests of several pictures. The limits and ``background`` of
:func:`vizlight.draw.testing.assert_same_picture` are keywords. ``pytest --add-missing`` stores
pictures that do not exist yet. A failure leaves its pictures in ``failed_pictures/MODULE`` of
pytest's root folder.
"""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest

from vizlight._types import ColorLike
from vizlight.draw import testing

__all__ = ["same_picture"]

# pytest leaves the frames of this module out of tracebacks.
__tracebackhide__ = True

_ADDED = "picture added"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option of the command."""
    explained = "store the pictures of same_picture that do not exist yet; inspect them"
    parser.getgroup("vizlight").addoption("--add-missing", action="store_true", help=explained)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Name the pictures that were stored."""
    for report in terminalreporter.getreports("passed"):
        for name, path in report.user_properties:
            if name == _ADDED:
                terminalreporter.write_line(f"stored {path}; inspect it")


@pytest.fixture
def same_picture(request: pytest.FixtureRequest) -> Callable[..., testing.Difference]:
    """Return the comparison of a plotter, file or array with the picture of the test's name.

    Parameters
    ----------
    request : pytest.FixtureRequest
        Test that asks.

    Returns
    -------
    callable
        Takes the picture and its name, returns a :class:`~vizlight.draw.testing.Difference`.
    """
    # Names of tests with parameters have brackets and signs that names of files cannot have.
    module, test = request.path.stem, re.sub(r"[^\w.]+", "-", request.node.name).strip("-")
    failed = request.config.rootpath / "failed_pictures" / module
    add = bool(request.config.getoption("add_missing"))

    def same(
        got: testing.Picture,
        name: str = "",
        /,
        background: ColorLike | None = None,
        **limits: float,
    ) -> testing.Difference:
        file = f"{test}-{name}.png" if name else f"{test}.png"
        kept = request.path.parent / "pictures" / module / file
        if add and not kept.exists():
            kept.parent.mkdir(parents=True, exist_ok=True)
            # Properties travel with the report, also from the other processes of pytest-xdist.
            request.node.user_properties.append((_ADDED, str(kept)))
        return testing.assert_same_picture(
            got, kept, background=background, failed=failed, add_missing=add, **limits
        )

    return same
