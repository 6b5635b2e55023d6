"""What a piece of data is, in a file, a grid or an array, and how it is read."""

from __future__ import annotations

import itertools
import math
import threading
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv
from vtkmodules import vtkIOXML
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkFiltersExtraction import vtkExtractGrid, vtkExtractRectilinearGrid
from vtkmodules.vtkImagingCore import vtkExtractVOI

from vizlight import _check, files
from vizlight.pieces.ghosts import GHOST, own_cells, with_layer, without_ghosts

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from numpy.typing import ArrayLike

    from vizlight._types import Array, Foreign, VectorLike

    Extent = tuple[int, ...]

#: Suffix of a piece by its type of mesh, and suffix of an index of pieces by theirs.
SUFFIX = {kind: formats[0] for kind, formats in files.FORMATS.items() if kind != "MultiBlock"}
INDEX = {suffix: f".p{suffix[1:]}" for suffix in SUFFIX.values()}
#: Readers of structured grids, which read any box of nodes out of a file.
STRUCTURED = {
    **{suffix: files.READERS[suffix] for suffix in (".vti", ".vtr", ".vts")},
    ".pvti": vtkIOXML.vtkXMLPImageDataReader,
    ".pvtr": vtkIOXML.vtkXMLPRectilinearGridReader,
    ".pvts": vtkIOXML.vtkXMLPStructuredGridReader,
}
#: Last reader of a structured grid, of each thread.
_LAST = threading.local()
#: Files that name the files of their pieces.
INDICES = (".pvtu", ".pvtp", ".vtm")
HDF = (".vtkhdf", ".hdf")


class PieceError(ValueError):
    """A piece of the data cannot be read, lit or written; the message begins with its name."""


@dataclass(frozen=True)
class Piece:
    """One piece of data, small enough to be sent to another process, which reads it.

    Attributes
    ----------
    name : str
        Name in messages.
    """

    name: str

    def read(self, ghost: int) -> pv.DataSet:
        """Return the mesh of the piece; cells of other pieces have 1 in the array ``GHOST``."""
        raise NotImplementedError

    def own(self, mesh: pv.DataSet) -> pv.DataSet:
        """Return the part of a mesh, read with ghost cells, that belongs to the piece."""
        return own_cells(mesh)

    def places(self) -> Array:
        """Return points with the hull of the piece, from no more of the data than it needs."""
        return hull(self.read(0))


def hull(mesh: pv.DataSet) -> Array:
    """Return the corners of a grid with straight axes, the points of any other mesh."""
    if not isinstance(mesh, pv.ImageData | pv.RectilinearGrid) or not mesh.n_points:
        return np.asarray(mesh.points)
    nx, ny, nz = mesh.dimensions
    ends = itertools.product((0, nz - 1), (0, ny - 1), (0, nx - 1))
    return np.array([mesh.GetPoint(x + nx * (y + ny * z)) for z, y, x in ends])


def union(boxes: ArrayLike) -> tuple[float, ...]:
    """Return the bounding box of bounding boxes, each a row."""
    rows = np.asarray(boxes, dtype=np.float64).reshape(-1, 6)
    both = np.where(np.arange(6) % 2, rows.max(axis=0), rows.min(axis=0))
    return tuple(both.tolist())


@dataclass(frozen=True)
class FilePiece(Piece):
    """A file, or one partition of a VTKHDF file, of cells in any order.

    Attributes
    ----------
    path : pathlib.Path
        Path of the file.
    partition, partitions : int
        Index of the partition, and their number.
    beside : tuple of FilePiece
        Pieces whose bounding boxes touch this one's.
    """

    path: Path
    partition: int = 0
    partitions: int = 1
    beside: tuple[FilePiece, ...] = ()

    def load(self) -> pv.DataSet:
        """Return the mesh without ghost cells."""
        if self.path.suffix.lower() in HDF:
            reader = hdf(self.path)
            reader.UpdatePiece(self.partition, self.partitions, 0)
            found = pv.wrap(reader.GetOutputDataObject(0))
            mesh = found[self.partition] if isinstance(found, pv.PartitionedDataSet) else found
            if not isinstance(mesh, pv.DataSet) or not mesh.n_points:
                got = f"{self.name!r} (no points)"
                raise files.FileError(_check.message("sources", "pieces with points", got))
        else:
            mesh = files.read(self.path)
        return without_ghosts(mesh)

    def read(self, ghost: int) -> pv.DataSet:
        """See :class:`Piece`."""
        mesh = self.load()
        if not ghost:
            return mesh
        mesh = mesh if isinstance(mesh, pv.PolyData) else mesh.cast_to_unstructured_grid()
        others: Iterable[pv.DataSet] = (piece.load() for piece in self.beside)
        for more in reversed(range(ghost)):
            mesh, others = with_layer(mesh, others, keep=more > 0)
        return mesh


@dataclass(frozen=True)
class GridPiece(Piece):
    """A box of nodes of a structured grid.

    Attributes
    ----------
    extent, whole : tuple of 6 int
        First and last node of the piece and of the grid, along x, y and z.
    """

    extent: Extent
    whole: Extent

    def nodes(self, extent: Extent) -> Foreign:
        """Return a box of nodes."""
        raise NotImplementedError

    def read(self, ghost: int) -> pv.DataSet:
        """See :class:`Piece`."""
        grown = [
            min(node + ghost, self.whole[i]) if i % 2 else max(node - ghost, self.whole[i])
            for i, node in enumerate(self.extent)
        ]
        mesh = self.nodes(tuple(grown))
        found = mesh.GetExtent()
        outside = np.ones([max(found[i + 1] - found[i], 1) for i in (4, 2, 0)], dtype=np.uint8)
        own = [(self.extent[i] - found[i], self.extent[i + 1] - found[i]) for i in (4, 2, 0)]
        outside[tuple(slice(low, max(high, 1)) for low, high in own)] = 0
        mesh.cell_data[GHOST] = outside.ravel()
        return mesh  # type: ignore[no-any-return]

    def own(self, mesh: Foreign) -> pv.DataSet:
        """See :class:`Piece`."""
        if not hasattr(mesh, "GetExtent"):
            return own_cells(mesh)
        if tuple(mesh.GetExtent()) != self.extent:
            kinds = {pv.ImageData: vtkExtractVOI, pv.RectilinearGrid: vtkExtractRectilinearGrid}
            cutter: Foreign = kinds.get(type(mesh), vtkExtractGrid)()
            cutter.SetInputDataObject(mesh)
            cutter.SetVOI(self.extent)
            cutter.Update()
            own = pv.wrap(cutter.GetOutput())
            for name in mesh.field_data:
                own.field_data[name] = mesh.field_data[name]
            mesh = own
        mesh.cell_data.pop(GHOST, None)
        return mesh  # type: ignore[no-any-return]


@dataclass(frozen=True)
class BoxPiece(GridPiece):
    """A box of nodes of a structured grid in a file.

    Attributes
    ----------
    path : pathlib.Path
        Path of the file.
    """

    path: Path

    def nodes(self, extent: Extent) -> Foreign:
        """See :class:`GridPiece`."""
        reader = structured(self.path)
        reader.UpdateExtent(extent)
        mesh = pv.wrap(reader.GetOutputDataObject(0))
        reader.GetOutputDataObject(0).ReleaseData()
        return without_ghosts(mesh)

    def places(self) -> Array:
        """See :class:`Piece`."""
        info = structured(self.path).GetOutputInformation(0)
        if not info.Has(vtkDataObject.SPACING()):  # its places are coordinates in the file
            return super().places()
        grid = pv.ImageData()
        grid.CopyInformationFromPipeline(info)
        grid.SetExtent(*self.extent)
        return hull(grid)


class Slabs:
    """A grid that is read slab by slab from arrays that are larger than memory.

    Parameters
    ----------
    arrays : dict of str to array_like
        Point arrays by name, of shape (nz, ny, nx) or (nz, ny, nx, components): memory-mapped
        arrays, Zarr or Dask arrays, h5py datasets that can be pickled, or anything else of that
        shape whose slices ``[z0:z1]``, and ``[z0:z1, y0:y1]`` of wide grids, are arrays.
    spacing : vector of 3 components, default: (1, 1, 1)
        Distances between the nodes along x, y and z, in the unit of the mesh.
    origin : vector of 3 components, default: (0, 0, 0)
        Place of the first node.

    Raises
    ------
    TypeError, ValueError
        If there is no array, or their shapes do not fit each other.

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
            got = _check.describe(arrays)
            raise TypeError(_check.message("arrays", "a dict of point arrays by name", got))
        shapes = {}
        for name, array in arrays.items():
            shape = getattr(array, "shape", None)
            if shape is None or len(shape) not in (3, 4) or not hasattr(array, "dtype"):
                expected = (
                    f"an array of shape (nz, ny, nx) or (nz, ny, nx, components) for {name!r}"
                )
                raise ValueError(_check.message("arrays", expected, _check.describe(array)))
            shapes[name] = tuple(int(size) for size in shape[:3])
        if len(set(shapes.values())) > 1:
            got = ", ".join(f"{name!r} with {shape}" for name, shape in shapes.items())
            raise ValueError(_check.message("arrays", "one number of nodes along each axis", got))
        self.arrays = {name: _Mapped.of(array) for name, array in arrays.items()}
        steps = [_check.positive("spacing", step) for step in _check.vector("spacing", spacing)]
        self.spacing = tuple(steps)
        self.origin = _check.vector("origin", origin)
        nz, ny, nx = next(iter(shapes.values()))
        self.extent: Extent = (0, nx - 1, 0, ny - 1, 0, nz - 1)

    def bytes_per_node(self) -> float:
        """Return the memory of all arrays for each node."""
        sizes = [
            np.dtype(array.dtype).itemsize * math.prod(array.shape[3:])
            for array in self.arrays.values()
        ]
        return float(sum(sizes))


@dataclass(frozen=True)
class _Mapped:
    """A memory-mapped array by the place of its data in a file; other arrays are kept."""

    shape: tuple[int, ...]
    dtype: Foreign
    kept: Foreign = None
    path: str = ""
    offset: int = 0

    @classmethod
    def of(cls, array: Foreign) -> _Mapped:
        shape = tuple(int(size) for size in array.shape)
        if isinstance(array, np.memmap) and array.filename and array.flags.c_contiguous:
            base: Foreign = array
            while isinstance(base.base, np.memmap):
                base = base.base
            # A view begins later in the file than the array that it is a view of.
            first = array.__array_interface__["data"][0] - base.__array_interface__["data"][0]
            return cls(shape, array.dtype, None, str(array.filename), base.offset + first)
        return cls(shape, array.dtype, array)

    def box(self, low: int, high: int, first: int, last: int) -> Foreign:
        """Return rows from ``first`` up to ``last`` of the slices from ``low`` up to ``high``."""
        if self.kept is None:
            each = math.prod(self.shape[1:]) * np.dtype(self.dtype).itemsize
            mapped = np.memmap(
                self.path, self.dtype, "r", self.offset + low * each, (high - low, *self.shape[1:])
            )
            return np.array(mapped[:, first:last])
        whole = last - first == self.shape[1]
        part = self.kept[low:high] if whole else self.kept[low:high, first:last]
        if not hasattr(part, "compute"):
            return np.asarray(part)
        import dask

        # In this process; the name "sync" in place of the function is a warning with old versions.
        return np.asarray(part.compute(scheduler=dask.get))


@dataclass(frozen=True)
class SlabPiece(GridPiece):
    """Slices of nodes of a grid in arrays."""

    grid: Slabs

    def nodes(self, extent: Extent) -> pv.ImageData:
        """See :class:`GridPiece`."""
        mesh = self.empty(extent)
        for name, array in self.grid.arrays.items():
            box = array.box(extent[4], extent[5] + 1, extent[2], extent[3] + 1)
            mesh.point_data[name] = box.reshape(-1, *array.shape[3:])
        return mesh

    def empty(self, extent: Extent) -> pv.ImageData:
        """Return a box of nodes without arrays."""
        mesh = pv.ImageData(spacing=self.grid.spacing, origin=self.grid.origin)
        mesh.extent = extent
        return mesh

    def places(self) -> Array:
        """See :class:`Piece`."""
        return hull(self.empty(self.extent))


def index_files(path: Path) -> list[Path]:
    """Return the files that an index names.

    Raises
    ------
    PieceError
        If the index cannot be read, or a file is missing.
    """
    try:
        root = ET.parse(path).getroot()
    except (ET.ParseError, OSError) as error:
        got = f"'{path}' ({error})"
        raise PieceError(_check.message("sources", "an index in XML", got)) from error
    found = []
    for element in root.iter():
        name = {"Piece": "Source", "DataSet": "file"}.get(element.tag)
        if name and element.get(name):
            file = path.parent / str(element.get(name))
            if not file.is_file():
                text = f"'{path}' names '{file}' (no such file)"
                raise PieceError(_check.message("sources", "pieces that exist", text))
            found.append(file)
    return found


def structured(path: Path) -> Foreign:
    """Return a reader of a structured grid that knows the grid's extent.

    A thread keeps the last one: to find what a file holds a reader may have to go through all of
    it, which would take longer than to read a slab.
    """
    status = path.stat()
    stamp = (str(path.resolve()), status.st_size, status.st_mtime_ns)
    if getattr(_LAST, "stamp", None) != stamp:
        suffix = path.suffix.lower()
        _LAST.reader = hdf(path) if suffix in HDF else _informed(STRUCTURED[suffix](), path)
        _LAST.stamp = stamp
    return _LAST.reader


def hdf(path: Path) -> Foreign:
    """Return a reader of a VTKHDF file that knows what is in it."""
    from vtkmodules.vtkIOHDF import vtkHDFReader

    return _informed(vtkHDFReader(), path)


def _informed(reader: Foreign, path: Path) -> Foreign:
    """Return a reader that has read what a file holds, but no data."""
    reader.SetFileName(str(path))
    with files.captured_errors() as errors:
        reader.UpdateInformation()
    if errors:
        got = f"'{path}' ({errors[0]})"
        raise PieceError(_check.message("sources", "a file that can be read", got))
    return reader
