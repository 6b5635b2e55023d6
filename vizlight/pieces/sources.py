"""The pieces of files, patterns, indices and arrays."""

from __future__ import annotations

import glob
import itertools
import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import pyvista as pv
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

from vizlight import _check, files
from vizlight.pieces.kinds import (
    HDF,
    INDICES,
    STRUCTURED,
    BoxPiece,
    FilePiece,
    Piece,
    PieceError,
    SlabPiece,
    Slabs,
    hdf,
    index_files,
    structured,
)  # fmt: skip

if TYPE_CHECKING:
    from vizlight._types import Foreign
    from vizlight.pieces.kinds import Extent


def pieces_of(sources: object, slab: float) -> list[Piece]:
    """Return the pieces of files, indices, folders of patterns, and arrays.

    Parameters
    ----------
    sources : path, Slabs or sequence of them
        Files; patterns such as ``"run/*.vtu"``; indices; grids.
    slab : float
        Largest size in MB of a slab of a structured grid.

    Raises
    ------
    TypeError, PieceError
        If a source is of no known kind, or a file is missing.
    """
    given = [sources] if isinstance(sources, str | Path | Slabs) else sources
    wrong = isinstance(given, Mapping | pv.DataSet | pv.MultiBlock)
    if wrong or not hasattr(given, "__iter__") or getattr(given, "ndim", 1) == 0:
        expected = "paths, patterns, or grids as vizlight.pieces.Slabs"
        remedy = "wrap arrays: Slabs({name: array})"
        raise TypeError(_check.message("sources", expected, type(sources).__name__, remedy))
    found: list[Piece] = []
    taken: set[Path] = set()
    for source in given:
        if isinstance(source, Slabs):
            found += _slabs(source, slab)
        elif isinstance(source, str | Path):
            for path in _paths(source):
                if path.resolve() in taken:
                    raise PieceError(_check.message("sources", "each file once", f"'{path}' twice"))
                taken.add(path.resolve())
                found += _of_file(path, slab)
        else:
            expected = "a path, a pattern or a vizlight.pieces.Slabs"
            raise TypeError(_check.message("sources", expected, type(source).__name__))
    if not found:
        raise PieceError(_check.message("sources", "at least one piece", "none"))
    return found


def _paths(source: str | Path) -> list[Path]:
    """Return the files of a path or a pattern, in the order of their names."""
    text = str(source)
    try:
        what = files.no_file(Path(text))
    except (OSError, ValueError):  # such as a name of more characters than the system takes
        what = "no such file"
    if not what:
        return [Path(text)]
    if any(sign in text for sign in "*?["):
        found = sorted(Path(file) for file in glob.glob(text, recursive=True))  # noqa: PTH207
        if found:
            return found
        raise PieceError(_check.message("sources", "a pattern that files match", repr(text)))
    remedy = f"name its files, as '{text}/*.vtu'" if what == "a folder" else ""
    raise PieceError(
        _check.message("sources", "a file", f"{_check.describe(text)} ({what})", remedy)
    )


def _of_file(path: Path, slab: float) -> list[Piece]:
    """Return the pieces of a file."""
    suffix = path.suffix.lower()
    if suffix in STRUCTURED:
        return _boxes(path, slab)
    if suffix in INDICES:
        made = [piece for file in index_files(path) for piece in _of_file(file, slab)]
        if not made:
            got = f"'{path}' (it names none)"
            raise PieceError(_check.message("sources", "an index of files", got))
        return made
    if suffix in HDF:
        reader = hdf(path)
        reader.UpdatePiece(1 << 20, 1 << 21, 0)  # beyond all partitions: nothing is read
        found = pv.wrap(reader.GetOutputDataObject(0))
        if isinstance(found, pv.ImageData):
            return _boxes(path, slab)
        if isinstance(found, pv.PartitionedDataSet):
            count = found.n_partitions
            return [FilePiece(f"{path}[{i}]", path, i, count) for i in range(count)]
    return [FilePiece(str(path), path)]


def _boxes(path: Path, slab: float) -> list[Piece]:
    """Return slabs of a structured grid in a file, cut across its last long axis."""
    reader = structured(path)
    pipeline = vtkStreamingDemandDrivenPipeline
    info = reader.GetOutputInformation(0)
    whole: Foreign = info.Get(pipeline.WHOLE_EXTENT()) if info.Has(pipeline.WHOLE_EXTENT()) else ()
    if len(whole) != 6 or any(whole[2 * i + 1] < whole[2 * i] for i in range(3)):
        raise PieceError(_check.message("sources", "a grid with nodes", f"'{path}'"))
    nodes = math.prod(whole[2 * i + 1] - whole[2 * i] + 1 for i in range(3))
    size = _uncompressed(path, reader, nodes)
    return [
        BoxPiece(f"{path}[{place}]", box, tuple(whole), path)
        for box, place in _cuts(tuple(whole), size / nodes, slab)
    ]


def _uncompressed(path: Path, reader: Foreign, nodes: int) -> float:
    """Return the memory in bytes that the arrays of a grid take."""
    # A corner of the grid tells the types of the arrays and their components.
    info = reader.GetOutputInformation(0)
    whole = info.Get(vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT())
    corner = tuple(min(whole[2 * (i // 2)] + i % 2, whole[2 * (i // 2) + 1]) for i in range(6))
    reader.UpdateExtent(corner)
    mesh = pv.wrap(reader.GetOutputDataObject(0))
    if not mesh.n_points:
        raise PieceError(_check.message("sources", "a file that can be read", f"'{path}'"))
    arrays = [mesh.point_data[name] for name in mesh.point_data]
    arrays += [mesh.cell_data[name] for name in mesh.cell_data]
    each = sum(array.itemsize * math.prod(array.shape[1:]) for array in arrays)
    points = 24 if isinstance(mesh, pv.StructuredGrid) else 0
    return float(max(each + points, 1) * nodes)


def _slabs(grid: Slabs, slab: float) -> list[Piece]:
    return [
        SlabPiece(f"slices [{place}]", box, grid.extent, grid)
        for box, place in _cuts(grid.extent, grid.bytes_per_node(), slab)
    ]


def _cuts(whole: Extent, bytes_per_node: float, slab: float) -> list[tuple[Extent, str]]:
    """Return boxes of at most so many MB, and their place in words; they share nodes on borders.

    They are slabs across z; where one layer of cells is larger, they are cut across y too.
    """
    x0, x1, y0, y1, z0, z1 = whole
    row = (x1 - x0 + 1) * bytes_per_node
    thick = int(slab * 1e6 / (row * (y1 - y0 + 1)))
    layers = _parts(z0, z1, max(thick, 1))
    if thick:
        return [((x0, x1, y0, y1, *z), f"{z[0]}:{z[1]}") for z in layers]
    rows = _parts(y0, y1, max(int(slab * 1e6 / row), 1))
    return [((x0, x1, *y, *z), f"{z[0]}:{z[1]}, {y[0]}:{y[1]}") for z in layers for y in rows]


def _parts(first: int, last: int, most: int) -> list[tuple[int, int]]:
    """Return the ends of parts of at most so many steps."""
    count = max(math.ceil((last - first) / most), 1)
    ends = [first + (last - first) * i // count for i in range(count + 1)]
    return list(itertools.pairwise(ends))
