"""What is installed, what draws here, what is missing and how to get it."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version
from typing import get_args

from vizlight import data
from vizlight.pictures import render

PACKAGES = ("vizlight", "numpy", "scipy", "vtk", "pyvista")


def findings() -> list[tuple[str, str]]:
    """Return parts and what was found of each."""
    rows = [("python", f"{platform.python_version()}, {platform.platform()}")]
    for package in PACKAGES:
        try:
            rows.append((package, version(package)))
        except PackageNotFoundError:
            rows.append((package, f"missing (try: pip install {package})"))
    rows.append(("data", str(data.example_path())))
    for backend in get_args(render.Backend):
        rows.append((f"draws by {backend}", render.probe(backend).detail))
    return rows
