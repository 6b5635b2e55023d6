"""The command line: a command for each filter, ``demo`` and ``doctor``."""

from vizlight._supervise import BAD_INPUT, LACKING
from vizlight.cli.main import main
from vizlight.cli.options import app
from vizlight.cli.output import OK

__all__ = ["BAD_INPUT", "LACKING", "OK", "app", "main"]
