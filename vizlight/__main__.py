"""``python -m vizlight`` and the command ``vizlight``: the command line in a child process."""

from __future__ import annotations

import sys

from vizlight import _supervise

__all__ = ["main"]


def main() -> int:
    """Run the command line and return its exit code."""
    return _supervise.run(_command_line)


def _command_line() -> int:
    from vizlight import cli

    return cli.main()


if __name__ == "__main__":
    sys.exit(main())
