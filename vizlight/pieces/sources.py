"""Pieces of data in files, grids and arrays: finding them and reading one."""

from __future__ import annotations

import functools
import glob
import itertools
import math
import threading
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pyvista as pv
from vtkmodules import vtkIOXML
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

from vizlight import _check, files, writing
from vizlight._types import Foreign, VectorLike
from vizlight.mesh.joining import without_ghosts
from vizlight.pieces.ghosts import GHOST, own_cells, with_layer
from vizlight.reading import paths, reader
from vizlight.vtk import messages
from vizlight.vtk.hull import cropped

Extent = tuple[int, ...]

#: Suffix of a piece by its type of mesh, and suffix of an index of pieces by theirs.
SUFFIX = {kind: formats[0] for kind, formats in writing.FORMATS.items() if kind != "MultiBlock"}
INDEX = {suffix: f".p{suffix[1:]}" for suffix in SUFFIX.values()}
#: Readers of structured grids, which read any box of nodes out of a file.
STRUCTURED = {
    ".vti": vtkIOXML.vtkXMLImageDataReader,
    ".vtr": vtkIOXML.vtkXMLRectilinearGridReader,
    ".vts": vtkIOXML.vtkXMLStructuredGridReader,
    ".pvti": vtkIOXML.vtkXMLPImageDataReader,
    ".pvtr": vtkIOXML.vtkXMLPRectilinearGridReader,
    ".pvts": vtkIOXML.vtkXMLPStructuredGridReader,
}
#: Last reader of a structured grid, of each thread.
_LAST = threading.local()
#: Files that name the files of their pieces.
INDICES = (*reader.PIECES, ".vtm")
HDF = (".vtkhdf", ".hdf")


class PieceError(ValueError):
    """A piece of the data cannot be read, lit or written; the message begins with its name."""


def _wrong(expected: str, got: str, remedy: str = "") -> PieceError:
    """Return the error of sources that are no pieces."""
    return PieceError(_check.message("sources", expected, got, remedy))


@dataclass(frozen=True)
class FilePiece:
    """A file, or one partition of a VTKHDF file, of cells in any order.

    It is small enough to be sent to another process, which reads the file. ``beside`` are pieces
    with bounding boxes that touch this one's.
    """

    name: str
    path: Path
    partition: int = 0
    partitions: int = 1
    beside: tuple[FilePiece, ...] = ()

    def load(self) -> pv.DataSet:
        """Return the mesh without ghost cells."""
        if self.path.suffix.lower() in HDF:
            reader = _informed(self.path)
            reader.UpdatePiece(self.partition, self.partitions, 0)
            data = pv.wrap(reader.GetOutputDataObject(0))
            mesh = data[self.partition] if isinstance(data, pv.PartitionedDataSet) else data
            if not isinstance(mesh, pv.DataSet) or not mesh.n_points:
                # An error with these words counts the piece as one without points, as parallel
                # writers make them.
                got = f"{self.name!r} (no points)"
                raise files.FileError(_check.message("sources", "pieces with points", got))
        else:
            mesh = files.read(self.path)
        return without_ghosts(mesh)

    def read(self, ghost: int) -> pv.DataSet:
        """Return the mesh of the piece; cells of other pieces have 1 in the array ``GHOST``."""
        mesh = self.load()
        if not ghost:
            return mesh
        mesh = mesh if isinstance(mesh, pv.PolyData) else mesh.cast_to_unstructured_grid()
        others: Iterable[pv.DataSet] = (piece.load() for piece in self.beside)
        # Each round adds a layer; the rest of the others is needed again unless it was the last.
        for more in reversed(range(ghost)):
            mesh, others = with_layer(mesh, others, keep=more > 0)
        return mesh

    def owned_part(self, mesh: pv.DataSet) -> pv.DataSet:
        """Return the part of a mesh, read with ghost cells, that belongs to the piece."""
        return own_cells(mesh)


@dataclass(frozen=True)
class GridPiece:
    """A box of nodes of a structured grid.

    ``extent`` and ``whole`` are the first and last node of the piece and of the grid, along x, y
    and z.
    """

    name: str
    source: Path | Slabs
    extent: Extent
    whole: Extent

    def read(self, ghost: int) -> pv.DataSet:
        """See :class:`FilePiece`."""
        # First nodes have even places and last nodes odd ones; ghosts end where the grid does.
        grown = tuple(
            min(node + ghost, self.whole[i]) if i % 2 else max(node - ghost, self.whole[i])
            for i, node in enumerate(self.extent)
        )
        mesh: Foreign
        if isinstance(self.source, Slabs):
            mesh = self.source.nodes(grown)
        else:
            reader = _grid_reader(self.source)
            reader.UpdateExtent(grown)
            mesh = pv.wrap(reader.GetOutputDataObject(0))
            # The reader stays with its thread, and would hold the data of this box.
            reader.GetOutputDataObject(0).ReleaseData()
            mesh = without_ghosts(mesh)
        # The box that was read, in nodes of the whole grid.
        extent = mesh.GetExtent()
        # Over the cells x runs fastest, so that the mask has the axes z, y and x; a flat axis has
        # one layer.
        outside = np.ones([max(extent[i + 1] - extent[i], 1) for i in (4, 2, 0)], dtype=np.uint8)
        # Nodes of the piece, counted from the first that was read.
        inner = [(self.extent[i] - extent[i], self.extent[i + 1] - extent[i]) for i in (4, 2, 0)]
        outside[tuple(slice(low, max(high, 1)) for low, high in inner)] = 0
        mesh.cell_data[GHOST] = outside.ravel()
        return mesh  # type: ignore[no-any-return]

    def owned_part(self, mesh: Foreign) -> pv.DataSet:
        """See :class:`FilePiece`."""
        # An isosurface is no grid any more, and its triangles have the mark of the cells that they
        # lie in.
        if not hasattr(mesh, "GetExtent"):
            return own_cells(mesh)
        if tuple(mesh.GetExtent()) != self.extent:
            part = pv.wrap(cropped(mesh, self.extent))
            # Records are field data, and are carried by hand.
            for name in mesh.field_data:
                part.field_data[name] = mesh.field_data[name]
            mesh = part
        mesh.cell_data.pop(GHOST, None)
        return mesh  # type: ignore[no-any-return]


Piece: TypeAlias = FilePiece | GridPiece


class Slabs:
    """A grid that is read slab by slab from arrays that are larger than memory.

    Parameters
    ----------
    arrays : dict of str to array_like
        Point arrays by name, of shape (nz, ny, nx) or (nz, ny, nx, components): memory-mapped
        arrays, Zarr or Dask arrays, h5py datasets that can be pickled, or anything else of that
        shape with arrays as its slices ``[z0:z1]``, and ``[z0:z1, y0:y1]`` of wide grids.
    spacing : vector of 3 components, default: (1, 1, 1)
        Distances between the nodes along x, y and z, in the unit of the mesh.
    origin : vector of 3 components, default: (0, 0, 0)
        Place of the first node.

    Raises
    ------
    TypeError, ValueError
        If no array is given, or their shapes do not fit each other.

    Notes
    -----
    A memory-mapped array is sent to other processes by the name of its file, others as they are.

    Examples
    --------
    >>> import numpy as np, vizlight
    >>> Z = np.linspace(0, 1, 20)[:, None, None] + np.zeros((20, 10, 10))
    >>> grid = vizlight.pieces.Slabs({"height": Z}, spacing=(0.1, 0.1, 0.05))
    >>> grid.extent
    (0, 9, 0, 9, 0, 19)
    """

    def __init__(
        self,
        arrays: Mapping[str, object],
        *,
        spacing: VectorLike = (1.0, 1.0, 1.0),
        origin: VectorLike = (0.0, 0.0, 0.0),
    ) -> None:
        if not isinstance(arrays, Mapping) or not arrays:
            raise _check.type_error("arrays", "a dict of point arrays by name", arrays)
        shapes = {}
        self.bytes_per_node = 0.0
        for name, array in arrays.items():
            shape = getattr(array, "shape", None)
            dtype = getattr(array, "dtype", None)
            if shape is None or len(shape) not in (3, 4) or dtype is None:
                expected = (
                    f"an array of shape (nz, ny, nx) or (nz, ny, nx, components) for {name!r}"
                )
                raise _check.value_error("arrays", expected, _check.describe(array))
            shapes[name] = tuple(int(size) for size in shape[:3])
            self.bytes_per_node += np.dtype(dtype).itemsize * math.prod(shape[3:])
        if len(set(shapes.values())) > 1:
            got = ", ".join(f"{name!r} with {shape}" for name, shape in shapes.items())
            raise _check.value_error("arrays", "one number of nodes along each axis", got)
        self.arrays = {name: _unmapped(array) for name, array in arrays.items()}
        steps = [_check.positive("spacing", step) for step in _check.vector("spacing", spacing)]
        self.spacing = tuple(steps)
        self.origin = _check.vector("origin", origin)
        nz, ny, nx = next(iter(shapes.values()))
        self.extent: Extent = (0, nx - 1, 0, ny - 1, 0, nz - 1)

    def nodes(self, extent: Extent) -> pv.ImageData:
        """Return a box of nodes with their arrays."""
        mesh = pv.ImageData(spacing=self.spacing, origin=self.origin)
        mesh.extent = extent
        slices, rows = slice(extent[4], extent[5] + 1), slice(extent[2], extent[3] + 1)
        for name, array in self.arrays.items():
            is_mapped = isinstance(array, functools.partial)
            values: Foreign = array() if is_mapped else array
            # Rows are sliced only where some are left out: some arrays know slices along z alone.
            wide = rows.stop - rows.start < values.shape[1]
            part = values[slices, rows] if wide else values[slices]
            if hasattr(part, "compute"):
                import dask

                # In this process; the name "sync" in place of the function warns in old versions.
                part = part.compute(scheduler=dask.get)
            # A copy, so that the file is not mapped as long as the mesh is there.
            box = np.array(part) if is_mapped else np.asarray(part)
            # The last axis, x, runs fastest in memory, as it does over the points of an image in
            # VTK.
            mesh.point_data[name] = box.reshape(-1, *values.shape[3:])
        return mesh


def _unmapped(array: Foreign) -> Foreign:
    """Return the call that maps a memory-mapped array, which is small; other arrays as they are."""
    if not (isinstance(array, np.memmap) and array.filename and array.flags.c_contiguous):
        return array
    base: Foreign = array
    while isinstance(base.base, np.memmap):
        base = base.base
    # A view begins later in the file than the array that it is a view of.
    first = array.__array_interface__["data"][0] - base.__array_interface__["data"][0]
    place = base.offset + first
    return functools.partial(
        np.memmap, str(array.filename), array.dtype, "r", place, tuple(array.shape)
    )


def pieces_of(sources: object, slab: float) -> list[Piece]:
    """Return the pieces of files, indices, folders of patterns, and arrays.

    Sources are files, patterns such as ``"run/*.vtu"``, indices, or grids; ``slab`` is the largest
    size in MB of a slab of a structured grid.
    """
    items = [sources] if isinstance(sources, str | Path | Slabs) else sources
    wrong = isinstance(items, Mapping | pv.DataSet | pv.MultiBlock)
    if wrong or not hasattr(items, "__iter__") or getattr(items, "ndim", 1) == 0:
        expected = "paths, patterns, or grids as vizlight.pieces.Slabs"
        remedy = "wrap arrays: Slabs({name: array})"
        raise TypeError(_check.message("sources", expected, type(sources).__name__, remedy))
    pieces: list[Piece] = []
    taken: set[Path] = set()
    for source in items:
        if isinstance(source, Slabs):
            pieces += _boxes(source, source.extent, source.bytes_per_node, slab)
        elif isinstance(source, str | Path):
            for path in _paths(source):
                if path.resolve() in taken:
                    raise _wrong("each file once", f"'{path}' twice")
                taken.add(path.resolve())
                pieces += _of_file(path, slab)
        else:
            expected = "a path, a pattern or a vizlight.pieces.Slabs"
            raise TypeError(_check.message("sources", expected, type(source).__name__))
    if not pieces:
        raise _wrong("at least one piece", "none")
    return pieces


def _paths(source: str | Path) -> list[Path]:
    """Return the files of a path or a pattern, in the order of their names."""
    text = str(source)
    try:
        what = paths.no_file(Path(text))
    except (OSError, ValueError):  # such as a name of more characters than the system takes
        what = "no such file"
    if not what:
        return [Path(text)]
    if any(sign in text for sign in "*?["):
        matches = sorted(Path(file) for file in glob.glob(text, recursive=True))  # noqa: PTH207
        if matches:
            return matches
        raise _wrong("a pattern that files match", repr(text))
    remedy = f"name its files, as '{text}/*.vtu'" if what == "a folder" else ""
    raise _wrong("a file", f"{_check.describe(text)} ({what})", remedy)


def _of_file(path: Path, slab: float) -> list[Piece]:
    """Return the pieces of a file."""
    suffix = path.suffix.lower()
    if suffix in INDICES:
        pieces = [piece for file in index_files(path) for piece in _of_file(file, slab)]
        if not pieces:
            raise _wrong("an index of files", f"'{path}' (it names none)")
        return pieces
    is_grid = suffix in STRUCTURED
    if suffix in HDF:
        reader = _informed(path)
        reader.UpdatePiece(1 << 20, 1 << 21, 0)  # beyond all partitions: nothing is read
        data = pv.wrap(reader.GetOutputDataObject(0))
        is_grid = isinstance(data, pv.ImageData)
        if isinstance(data, pv.PartitionedDataSet):
            # Each partition of a VTKHDF file is a piece.
            count = data.n_partitions
            return [FilePiece(f"{path}[{i}]", path, i, count) for i in range(count)]
    return [*_boxes(path, *_size(path), slab)] if is_grid else [FilePiece(str(path), path)]


def _size(path: Path) -> tuple[Extent, float]:
    """Return the extent of a structured grid in a file, and the memory in bytes of a node."""
    reader, pipeline = _grid_reader(path), vtkStreamingDemandDrivenPipeline
    info = reader.GetOutputInformation(0)
    whole: Foreign = info.Get(pipeline.WHOLE_EXTENT()) if info.Has(pipeline.WHOLE_EXTENT()) else ()
    if len(whole) != 6 or any(whole[2 * i + 1] < whole[2 * i] for i in range(3)):
        raise _wrong("a grid with nodes", f"'{path}'")
    # A corner of the grid tells the types of the arrays and their components.
    reader.UpdateExtent(
        [min(whole[2 * (i // 2)] + i % 2, whole[2 * (i // 2) + 1]) for i in range(6)]
    )
    mesh = pv.wrap(reader.GetOutputDataObject(0))
    if not mesh.n_points:
        raise _wrong("a file that can be read", f"'{path}'")
    arrays = [*mesh.point_data.values(), *mesh.cell_data.values()]
    each = sum(array.itemsize * math.prod(array.shape[1:]) for array in arrays)
    # A structured grid stores three coordinates of 8 bytes for each node beside its arrays.
    points = 24 if isinstance(mesh, pv.StructuredGrid) else 0
    return tuple(whole), float(max(each + points, 1))


def _boxes(
    source: Path | Slabs, whole: Extent, bytes_per_node: float, slab: float
) -> list[GridPiece]:
    """Return boxes of a grid of at most so many MB, which share nodes on borders.

    They are slabs across z; where one layer of cells is larger, they are cut across y too.
    """
    x0, x1, y0, y1, z0, z1 = whole
    row = (x1 - x0 + 1) * bytes_per_node
    thick = int(slab * 1e6 / (row * (y1 - y0 + 1)))
    rows = [(y0, y1)] if thick else _parts(y0, y1, int(slab * 1e6 / row))
    what = "slices " if isinstance(source, Slabs) else str(source)
    return [
        GridPiece(
            f"{what}[{low}:{high}{'' if thick else f', {first}:{last}'}]",
            source, (x0, x1, first, last, low, high), whole,
        )
        for low, high in _parts(z0, z1, thick)
        for first, last in rows
    ]  # fmt: skip


def _parts(first: int, last: int, most: int) -> list[tuple[int, int]]:
    """Return the ends of parts of at most so many steps, but of one at least."""
    count = max(math.ceil((last - first) / max(most, 1)), 1)
    # Even parts, so that none is left as a thin rest.
    ends = [first + (last - first) * i // count for i in range(count + 1)]
    return list(itertools.pairwise(ends))


def index_files(path: Path) -> list[Path]:
    """Return the files that an index names."""
    try:
        root = ET.parse(path).getroot()
    except (ET.ParseError, OSError) as error:
        raise _wrong("an index in XML", f"'{path}' ({error})") from error
    paths = []
    for element in root.iter():
        # Indices of parallel files name their pieces by one attribute, multiblock files by another.
        name = element.get({"Piece": "Source", "DataSet": "file"}.get(element.tag, ""))
        if name:
            paths.append(path.parent / name)
            if not paths[-1].is_file():
                raise _wrong("pieces that exist", f"'{path}' names '{paths[-1]}' (no such file)")
    return paths


def _grid_reader(path: Path) -> Foreign:
    """Return a reader of a structured grid that knows the grid's extent.

    A thread keeps the last one: a reader may have to go through a whole file to find its arrays,
    which would take longer than to read a slab.
    """
    status = path.stat()
    # A file that was written again is another one.
    stamp = (str(path.resolve()), status.st_size, status.st_mtime_ns)
    if getattr(_LAST, "stamp", None) != stamp:
        _LAST.reader, _LAST.stamp = _informed(path), stamp
    return _LAST.reader


def _informed(path: Path) -> Foreign:
    """Return a reader of a file in parts that has read the description of the file, but no data."""
    reader: Foreign
    if path.suffix.lower() in HDF:
        from vtkmodules.vtkIOHDF import vtkHDFReader

        reader = vtkHDFReader()
    else:
        reader = STRUCTURED[path.suffix.lower()]()
    reader.SetFileName(str(path))
    with messages.captured_errors() as errors:
        reader.UpdateInformation()
    if errors:
        raise _wrong("a file that can be read", f"'{path}' ({errors[0]})")
    return reader
