"""The data that come with the package; ``datasets/README.md`` tells where they are from."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from vizlight import _check

__all__ = ["example_path", "load_example"]


def _folder() -> Path:
    package = Path(__file__).parent
    # In a wheel the data are inside the package, in a checkout beside it.
    inside, beside = package / "datasets", package.parent / "datasets"
    return inside if inside.is_dir() else beside


def example_path(name: str = "rotating_disk.vtu") -> Path:
    """Return the path of an embedded data set.

    Parameters
    ----------
    name : str, default: "rotating_disk.vtu"
        The file's name.

    Raises
    ------
    ValueError
        If there is no such data set.
    """
    names = sorted(p.name for p in _folder().glob("*.vt?"))
    if name not in names:
        raise ValueError(_check.message("name", f"one of {names}", repr(name)))
    return _folder() / name


def load_example(name: str = "rotating_disk.vtu") -> Any:
    """Return an embedded data set as a PyVista mesh.

    Parameters
    ----------
    name : str, default: "rotating_disk.vtu"
        The file's name; "fibre_bundle.vtp" and "earth_relief.vti" are others.

    Returns
    -------
    pyvista.DataSet

    Raises
    ------
    ValueError
        If there is no such data set.
    """
    import pyvista as pv

    return pv.read(example_path(name))
