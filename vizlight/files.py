"""Meshes from and to files: clear errors in, whole files out."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import sys
import tempfile
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.mesh import hull

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

__all__ = ["FileError", "read_mesh", "surface_of", "warped", "write_mesh"]

#: File formats that keep point and field arrays, by kind of mesh.
FORMATS: dict[str, tuple[str, ...]] = {
    "PolyData": (".vtp", ".vtk", ".vtu"),
    "UnstructuredGrid": (".vtu", ".vtk"),
    "StructuredGrid": (".vts", ".vtk"),
    "RectilinearGrid": (".vtr", ".vtk"),
    "ImageData": (".vti", ".vtk"),
}
SUFFIXES = tuple(dict.fromkeys(suffix for kind in FORMATS.values() for suffix in kind))


class FileError(ValueError):
    """A file that cannot be read or written as asked."""


def read_mesh(path: str | Path, /) -> Any:
    """Read a mesh from any file that PyVista reads; several blocks become one grid.

    Parameters
    ----------
    path : path

    Returns
    -------
    pyvista.DataSet

    Raises
    ------
    FileError
        If there is no such file, PyVista does not read it, or it holds no points.
    """
    path = Path(path)
    if not path.is_file():
        what = "a folder" if path.is_dir() else "nothing there"
        raise FileError(_check.message("file", "a file", f"'{path}' ({what})"))
    if not os.access(path, os.R_OK):
        raise FileError(_check.message("file", "a file that may be read", f"'{path}'"))
    reason = "no points"
    with _quiet() as said, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            mesh: Any = pv.read(path)
            if isinstance(mesh, pv.MultiBlock):
                mesh = _one_grid(mesh)
        except Exception as error:  # noqa: BLE001 - readers raise whatever they like
            mesh, reason = None, f"{type(error).__name__}: {_first_line(error)}"
    if not isinstance(mesh, pv.DataSet) or mesh.n_points == 0:
        if said and reason == "no points":
            reason = f"no points: {said[0]}"
        raise FileError(_check.message("file", "a mesh that PyVista reads", f"'{path}' ({reason})"))
    return mesh


def _first_line(error: Exception) -> str:
    return next((line.strip() for line in str(error).splitlines() if line.strip()), "no reason")


def _one_grid(blocks: pv.MultiBlock) -> Any:
    """Return the cells of highest dimension of all blocks: a volume leaves its side sets out."""
    grid = blocks.combine()
    dimension = {kind: grid.GetCell(index).GetCellDimension() for kind, index in _samples(grid)}
    highest = max(dimension.values(), default=0)
    keep = [kind for kind, d in dimension.items() if d == highest]
    if len(keep) < len(dimension):
        grid = grid.extract_cells(
            np.isin(grid.celltypes, keep), pass_point_ids=False, pass_cell_ids=False
        )
    return grid


def _samples(grid: pv.UnstructuredGrid) -> Iterator[tuple[int, int]]:
    """Yield every type of cell with the index of one such cell."""
    kinds, first = np.unique(grid.celltypes, return_index=True)
    yield from zip(kinds.tolist(), first.tolist(), strict=True)


@contextlib.contextmanager
def _quiet() -> Iterator[list[str]]:
    """Catch what C and C++ readers print on standard error; afterwards the errors among it."""
    said: list[str] = []
    sys.stderr.flush()
    with tempfile.TemporaryFile() as sink:
        kept = os.dup(2)
        os.dup2(sink.fileno(), 2)
        try:
            yield said
        finally:
            sys.stderr.flush()
            os.dup2(kept, 2)
            os.close(kept)
            sink.seek(0)
            text = sink.read().decode(errors="replace")
            said += re.findall(r"ERR\|.*\(0x[0-9a-f]+\): ([^\x1b\n]+)", text)


def surface_of(mesh: Any, /, contour: str | None = None, level: float | None = None) -> Any:
    """Return an isosurface of a mesh, or without a contour its outer surface.

    Parameters
    ----------
    mesh : pyvista.DataSet
    contour : str, optional
        A point array of one component.
    level : float, optional
        Default: the middle of the array's range.

    Raises
    ------
    ValueError
        If there is no such array, or nothing lies at the level.
    """
    if contour is None:
        if isinstance(mesh, pv.PolyData):
            return mesh
        return hull.outer_surface(mesh)[0]
    values = _scalars(mesh, "contour", contour)
    finite = values[np.isfinite(values)]
    if not finite.size:
        raise ValueError(_check.message("contour", "an array with finite values", repr(contour)))
    low, high = float(finite.min()), float(finite.max())
    level = (low + high) / 2 if level is None else _check.number("level", level)
    found = mesh.contour([level], scalars=contour)
    if not found.n_points:
        raise ValueError(
            _check.message("level", f"a value between {low:g} and {high:g}", f"{level:g}")
        )
    return found


def warped(mesh: Any, name: str, factor: float, /) -> Any:
    """Return a mesh whose points are raised by a point array of one component.

    Parameters
    ----------
    mesh : pyvista.DataSet
    name : str
        Of the array, in the unit of height.
    factor : float
        Lengths of the mesh in a unit of height.

    Raises
    ------
    ValueError
        If there is no such array, or the factor is not finite.
    """
    _scalars(mesh, "warp", name)
    return mesh.warp_by_scalar(name, factor=_check.number("warp_factor", factor))


def _scalars(mesh: Any, argument: str, name: str) -> Any:
    data = mesh.point_data
    if name in data and data[name].ndim == 1:
        return data[name]
    got = repr(name)
    if name in data:
        got = f"{name!r} with {data[name].shape[1]} components"
    elif name in mesh.cell_data:
        got = f"the cell array {name!r}"
    there = [key for key in data if data[key].ndim == 1]
    remedy = "average it to the points" if name in mesh.cell_data else ""
    expected = f"a point array of one component, {_check.one_of(there)}"
    raise ValueError(_check.message(argument, expected, got, remedy))


def check_output(path: str | Path, /, formats: tuple[str, ...]) -> Path:
    """Return the path of a file that is yet to be written, if it can be.

    Raises
    ------
    FileError
        If the ending is not of a known format, or the folder is missing or not writable.
    """
    path = Path(path)
    if path.suffix.lower() not in formats:
        raise FileError(
            _check.message("output", f"a name that ends in {', '.join(formats)}", f"'{path}'")
        )
    if not path.parent.is_dir():
        raise FileError(_check.message("output", "a folder that exists", f"'{path.parent}'"))
    if path.is_dir():
        raise FileError(_check.message("output", "a file", f"the folder '{path}'"))
    if not os.access(path.parent, os.W_OK):
        got = f"'{path.parent}', which is read-only"
        raise FileError(_check.message("output", "a folder that can be written to", got))
    return path


def check_format(mesh: Any, path: str | Path, /) -> Path:
    """Return the path, if its ending is of a format that holds such a mesh.

    Raises
    ------
    FileError
        If it is not.
    """
    path, kind = Path(path), type(mesh).__name__
    formats = FORMATS[kind]
    if path.suffix.lower() not in formats:
        expected = f"a name that ends in {', '.join(formats)} for {kind}"
        raise FileError(_check.message("output", expected, f"'{path.name}'"))
    return path


def write_mesh(mesh: Any, path: str | Path, /) -> Path:
    """Write a mesh with its arrays, whole or not at all.

    Parameters
    ----------
    mesh : pyvista.DataSet
    path : path
        Its ending, one of .vtp, .vtu, .vtk, .vts, .vti and .vtr, is the format; its folder must
        exist. A file that is there is replaced.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    FileError
        If the format does not hold such a mesh, or the file cannot be written.
    """
    path = check_format(mesh, path)
    # VTK's writers end the process where the disk is full.
    needed, free = mesh.actual_memory_size * 1024, shutil.disk_usage(path.parent).free
    if needed > free:
        got = f"{free / 1e6:.1f} MB in '{path.parent}'"
        raise FileError(_check.message("output", f"{needed / 1e6:.1f} MB of free disk", got))
    if path.suffix.lower() == ".vtu" and isinstance(mesh, pv.PolyData):
        mesh = mesh.cast_to_unstructured_grid()
    return replace_file(path, mesh.save)


def replace_file(path: Path, write: Callable[[str], object]) -> Path:
    """Write a file in a folder of its own and move it to its place: whole, or not at all.

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    try:
        with tempfile.TemporaryDirectory(prefix=".vizlight-", dir=path.parent) as folder:
            draft = Path(folder) / f"{path.stem}{path.suffix.lower()}"
            write(str(draft))
            draft.replace(path)
    except OSError as error:
        raise FileError(
            _check.message("output", "a file that can be written", f"'{path}' ({error.strerror})")
        ) from error
    return path
