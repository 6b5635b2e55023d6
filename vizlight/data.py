"""Data sets of the package; ``datasets/README.md`` names their sources."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from vizlight import _check

if TYPE_CHECKING:
    import pyvista as pv

__all__ = ["example_path", "load_example"]


def _folder() -> Path:
    package = Path(__file__).parent
    # The data are inside the package in a wheel, and next to it in a checkout.
    inside, beside = package / "datasets", package.parent / "datasets"
    return inside if inside.is_dir() else beside


def example_path(name: str = "rotating_disk.vtu") -> Path:
    """Return the path of a data set of the package.

    Parameters
    ----------
    name : str, default: "rotating_disk.vtu"
        Name of the file.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    ValueError
        If no data set has that name.
    """
    names = sorted(p.name for p in _folder().glob("*.vt?"))
    if not (isinstance(name, str) and name in names):
        raise _check.value_error("name", f"one of {names}", _check.describe(name))
    return _folder() / name


def load_example(name: str = "rotating_disk.vtu") -> pv.DataSet:
    """Return a data set of the package as a PyVista mesh.

    Parameters
    ----------
    name : str, default: "rotating_disk.vtu"
        Name of the file; other files are "fibre_bundle.vtp", "dog.vtp", "winds_of_july.vtp",
        "earth_relief.vti", "coasts.vtp", "jacksboro_fault.vti", "hawaii.vti", "carotid.vti" and
        "brain.vti".

    Returns
    -------
    pyvista.DataSet

    Raises
    ------
    ValueError
        If no data set has that name.
    """
    import pyvista as pv

    mesh = pv.read(example_path(name))
    assert isinstance(mesh, pv.DataSet)
    return mesh
