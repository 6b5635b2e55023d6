"""The command line: ``vizlight demo``, ``light FILE``, ``study NAME``, ``doctor``."""

from vizlight.cli.main import app, main

__all__ = ["app", "main"]
