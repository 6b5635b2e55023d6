"""Reading and writing of meshes: readers with clear errors, writers that leave no partial file."""

from __future__ import annotations

import bz2
import contextlib
import errno
import functools
import gzip
import lzma
import os
import re
import shutil
import time
import uuid
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

from vizlight import _check, _supervise, _trials
from vizlight._types import Foreign, Raw
from vizlight.mesh import (
    blocks,
    brains,
    cf_grids,
    ensight,
    file_parts,
    fills,
    foreign_files,
    georeference,
    height_grids,
    joining,
    legacy_vtk,
    meaning,
    normals,
    other_formats,
    references,
    series,
    short_files,
    tables,
)
from vizlight.mesh.blocks import DataSetT
from vizlight.mesh.creases import borders, creases
from vizlight.mesh.cutaways import cut_open, without_corner
from vizlight.mesh.derived import (
    check_dataset,
    layer_of,
    layers,
    stretched,
    surface_of,
    warped,
    with_vectors,
)
from vizlight.mesh.fills import without_fills
from vizlight.mesh.molecules import atoms_in, backbone, ligands
from vizlight.mesh.montages import side_by_side
from vizlight.mesh.nspace import with_last_coordinate
from vizlight.mesh.stresses import with_von_mises
from vizlight.mesh.subdivision import simplices
from vizlight.mesh.walls import walls
from vizlight.vtk import messages
from vizlight.vtk.cells import cell_arrays, check_whole, connectivity, dimensions, used
from vizlight.vtk.topology import place_numbers

try:
    import fcntl
except ImportError:  # on Windows
    fcntl = None  # type: ignore[assignment]


__all__ = [
    "FileError", "atoms_in", "backbone", "borders", "creases", "cut_open", "layer_of", "layers",
    "ligands", "read", "read_parts", "side_by_side", "stretched", "surface_of", "walls", "warped",
    "with_last_coordinate", "with_vectors", "with_von_mises", "without_corner", "without_fills",
    "write_mesh",
]  # fmt: skip

#: File formats that keep point and field arrays, by type of mesh.
FORMATS: dict[str, tuple[str, ...]] = {
    "PolyData": (".vtp", ".vtk", ".vtu", ".stl"),
    "UnstructuredGrid": (".vtu", ".vtk"),
    "StructuredGrid": (".vts", ".vtk"),
    "RectilinearGrid": (".vtr", ".vtk"),
    "ImageData": (".vti", ".vtk", ".stl"),
    "MultiBlock": (".vtm",),
}
#: Ends of names of files that have points for each face, or for each colour.
SOUPS = (".obj", ".off", ".ply", ".stl", ".wrl")
#: Formats that need no trial: of some thousand damaged files of each, none ended the process by
#: which :func:`.short_files.missing_part` had let it be read.
GUARDED = (".obj", ".off", ".ply", ".stl", ".vti", ".vtp", ".vtr", ".vts", ".vtu")
#: Indices of pieces of one mesh, whose cells name their points, and of pieces of one grid.
PIECES, GRID_PIECES = (".pvtp", ".pvtu"), (".pvti", ".pvtr", ".pvts")
#: Ends of names of files in which y is up.
Y_UP = (".glb", ".gltf", ".vrml", ".wrl")
#: Names of the blocks of Exodus: those of elements, and of what is chosen among them.
EXODUS = (
    "Element Blocks", "Side Sets", "Node Sets", "Face Sets", "Edge Sets", "Element Sets",
)  # fmt: skip
#: Ends of names of files of glTF, and their array of colours.
GLTF, GLTF_COLORS = (".glb", ".gltf"), "COLOR_0"
#: Arrays by which VTK's reader of glTF has the shapes of an animation.
_SHAPES = re.compile(r"target\d+_")
#: Largest number of points of a mesh: half of the addresses that processors have.
MOST_POINTS = 1 << 40
#: Largest rounding of points in a file of float32, as a share of the shortest side of a cell, and
#: the percentage of cells that may be smaller.
FINE, SHORT = 1e-2, 5.0
#: Number of cells of which the sides are measured.
MEASURED = 1 << 16
#: Thickness of the base of a solid below a height field, as a share of its longer side.
BASE = 0.02
SUFFIXES = tuple(dict.fromkeys(suffix for kind in FORMATS.values() for suffix in kind))


#: What VTK says of files that are whole: its importer of VRML makes a window that none needs, keys
#: of ParaView's, of NRRD and ranges of NaN are metadata, conditions at the boundary of CGNS no
#: cells.
_HARMLESS = re.compile(
    "bad X server connection|Could not locate key|Error reading InformationKey|Skipping BC_t node"
    "|glTF extension .* is used in|Unknown field: '[^:]*:="
)
#: Most files of a folder that an error names.
MOST_NAMED = 8
#: What VTK says of an OpenFOAM file that is whole, but in a language that it has only a part of.
_DIRECTIVE = re.compile(r"Error reading line \d+ of (\S+): Unsupported directive (\w+)")
#: Begin of the names of temporary folders, of those without a lock yet, and the time in seconds
#: after which one of these is swept.
DRAFTS, FRESH, ABANDONED = ".vizlight-file-", ".vizlight-new-", 60.0


class FileError(ValueError):
    """A file cannot be read or written."""


def _wrong(name: str, expected: str, got: object, remedy: str = "") -> FileError:
    """Return the error of an argument that names a file."""
    return FileError(_check.message(name, expected, got, remedy))


def read(
    path: str | Path | Foreign,
    /,
    *,
    time: float | str | None = None,
    overlay: str | Path | Sequence[str | Path] = (),
    at: Mapping[str, object] | None = None,
    nodata: float | None = None,
) -> pv.DataSet:
    """Read a mesh from a file; one that is damaged does not end this process.

    These are files that PyVista reads, tractograms, rasters, netCDF grids, molecules and crystals
    (.pdb, .cif, .pdbx, .xyz, dumps of LAMMPS), maps of densities (.mrc, .ccp4), fields of OpenDX
    (.dx), point clouds (.las, .pcd), and tables (.csv) of points that name columns of places in
    their first line: x, y, z or lon, lat.

    Parameters
    ----------
    path : path, xarray.Dataset or xarray.DataArray
        Path of the file, or data of xarray, of which one step is loaded. Tractograms (.trk, .tck,
        .trx) need the extra ``tracts``; netCDF files (.nc, .cdf), .cif, .mrc and those that
        PyVista reads by meshio, such as .mesh and .msh, need the extra ``formats``; GeoTIFF and
        other rasters (.tif, .asc, .hgt) the extra ``maps``; GRIB (.grib, .grb) cfgrib and Zarr
        (.zarr) zarr beside ``formats``.
    time : float or "first" or "last", optional
        Time of the step that is read from a file of several, or the index of the step, if it is
        an integer and no time of a step. Default: the last step.
    overlay : path or sequence of paths, optional
        Files with values for the points, which become point arrays of their names: GIFTI (.gii),
        FreeSurfer's (lh.curv, .annot, .mgh), .mz3 and CIFTI (.dscalar.nii, .dlabel.nii), whose
        hemisphere the surface has to be, for a surface of a brain; grids of the same points, such
        as the other component of a wind; tables (.csv) of a row for each point.
    at : dict, optional
        Value or index along any other axis of a netCDF file by its name, such as
        ``{"number": 3}`` of an ensemble; a whole number within the values of an axis is the nearest
        of these. Default: the first value.
    nodata : float, optional
        Value of a raster or a netCDF file that stands for none though the file does not say so.
        Default: one value far outside of all others and repeated, such as -9999, with a warning;
        NaN for none.

    Returns
    -------
    pyvista.DataSet
        Several blocks become one grid. A tractogram is a mesh of polylines in the space of its
        header (RAS, in mm), with the data per point and, as cell data, those per streamline; a
        group is a cell array of 0 and 1. A netCDF file is the grid of its largest variable:
        an image, a rectilinear grid where its steps are unequal, or a structured grid where each
        point has a longitude and a latitude of its own, a surface of faces where cells have nodes
        or bounds, points where only places are known; components at the sides of cells are averaged
        to their middles. Which axis is x (east), y (north) and z
        (up) its attributes say, else its names, else the order. Lengths of axes and heights are in
        metres, pressures in hPa and negative, depths below 0. Longitudes go on across the meridian
        where they begin anew, and around the earth they close. A raster is an image
        with a point at the centre of each pixel; missing values are NaN. The field array ``unit``
        of a map in degrees is ``degree``. glTF and VRML, where y is up by the standard, are turned
        so that z is; others are as they stand. Points of a .stl, .ply, .obj or .off file at one
        place with equal arrays are one. The field array ``TimeValue`` is the time of a step,
        ``TimeSteps`` are those of all steps.

    Raises
    ------
    TypeError
        If ``at`` is no dict, or ``nodata`` no number.
    FileError
        If the file does not exist, cannot be read or is damaged, the package that reads it is not
        installed, or it has no points or no such step.

    Warns
    -----
    UserWarning
        If a field of an OpenFOAM case is left out because VTK does not read its directives, or the
        file takes others from outside of its folder.

    Notes
    -----
    Readers are libraries in C and C++, which damaged files may end. Another process reads a file
    first, within 15 s and 0.5 s for each megabyte: a fork, or a helper that is kept, on other
    systems than Linux and where threads run. So files are read twice, but those of ``GUARDED``
    formats, and by the command line, which has a process of its own. A file is
    refused where its reader gives an error or a warning, and where it is shorter than its format
    states: .stl, netCDF, HDF5, TIFF, VTK's XML and legacy text. Threads may read at the same time:
    each thread gets the messages of its own reader, and no stream is redirected. Libraries other
    than VTK may print.
    """
    nodata = _check_selection(time, at, nodata)
    if cf_grids.is_grid(path):
        return cf_grids.of_dataset(path, time, at, nodata)
    with _check.held():
        return _read(_path("file", path), _selection(time, overlay, at, nodata))[0]


def read_parts(
    path: str | Path,
    /,
    *,
    time: float | str | None = None,
    overlay: str | Path | Sequence[str | Path] = (),
    at: Mapping[str, object] | None = None,
    nodata: float | None = None,
) -> list[pv.DataSet]:
    """Read a file of blocks as one mesh for each dimension of their cells, the highest first.

    Surfaces beside volumes are left out: most are walls, which would hide them.

    Parameters
    ----------
    path, time, overlay, at, nodata
        As for :func:`vizlight.read`.

    Returns
    -------
    list of pyvista.DataSet
        One mesh if the file has no blocks.

    Raises
    ------
    TypeError, FileError
        As for :func:`vizlight.read`.
    """
    nodata = _check_selection(time, at, nodata)
    with _check.held():
        file, selection = _path("file", path), _selection(time, overlay, at, nodata)
        return _read(file, selection._replace(whole=False))


class Selection(NamedTuple):
    """Part of a file, by options of :func:`read`; ``whole`` is False for :func:`read_parts`."""

    time: float | str | None = None
    overlays: Sequence[Path] = ()
    at: Mapping[str, object] | None = None
    nodata: float | None = None
    whole: bool = True


def _read(path: Path, selection: Selection) -> list[pv.DataSet]:
    """Return the meshes of a file, or the one with cells of the highest dimension."""
    _check_there(path, selection.overlays)
    inner = Path(path.stem).suffix.lower()
    is_packed = path.suffix.lower() in _UNPACK and inner and inner not in _PACKED_ALIKE
    # GRIB is known by its first bytes: names of forecasts end by their hour.
    is_named = path.suffix.lower() in foreign_files.PACKAGES
    if is_packed or (
        not is_named and path.is_file() and foreign_files.first_bytes(path, 4) == b"GRIB"
    ):
        return _unpacked(path, lambda file: _read(file, selection))
    reason, notes = "no points", list[str]()
    meshes: list[Foreign] = []
    limit = _supervise.read_limit(path.stat().st_size)
    reading = _supervise.stage("read", path, seconds=limit)
    # Damaged numbers overflow in readers, which say what is wrong beside that.
    with reading, messages.captured_errors() as errors, np.errstate(all="ignore"):
        _check_before(path, selection)
        try:
            data: Foreign = _found(path, selection.time, selection.at, selection.nodata)
            if _faults(errors):
                # Its cells may end the process.
                meshes = [block for block in blocks.all_blocks(data) if block.n_points]
            else:
                meshes = _meshes(data, path, selection, notes)
                for mesh in meshes:
                    meaning.name_by_file(mesh, path)
        except series.NoStepError:
            raise
        except Exception as error:  # noqa: BLE001 - readers raise exceptions of any type
            reason = messages.reason(error)
            meshes = []
        except SystemExit as error:  # so ends meshio where it finds a fault
            reason = f"its reader ended with {error.code}"
    unread = [match for match in map(_DIRECTIVE.search, errors) if match]
    errors = _faults(errors)
    if not meshes or not all(isinstance(mesh, pv.DataSet) and mesh.n_points for mesh in meshes):
        reason = f"no points: {errors[0]}" if errors else reason
        if reason.startswith("its overlay"):
            raise _wrong("overlay", f"values for the points of '{path}'", f"none: {reason}")
        if "CFF Fluent" in reason:  # as VTK says of any other .h5 file
            reason = _of_hdf(path)
        got, remedy = f"'{path}' ({reason})", foreign_files.way_out(path)
        raise _wrong("file", "a mesh that PyVista reads", got, remedy)
    # After an error VTK gives what it has read so far: a part of a mesh, which looks like a whole.
    if errors:
        raise _damaged(path, errors[0])
    _warn_of_unread(path, unread)
    if isinstance(data, pv.MultiBlock):
        notes += _left_out(data, meshes)
    if path.suffix.lower() == ".obj" and foreign_files.has_free_form(path):
        notes.append("its free-form curves and surfaces (curv, surf) are left out")
    if path.is_file() and (elsewhere := references.outside(path)):
        notes.append(f"it takes files from outside of its folder: {', '.join(elsewhere)}")
    if notes:
        _check.warn(f"file: '{path}': {'; '.join(dict.fromkeys(notes))}")
    return meshes


def _of_hdf(path: Path) -> str:
    """Return the name of the format of an HDF5 file that is not read, and a way to its mesh."""
    content = path.read_bytes()
    if b"topology" in content and (b"geometry" in content or b"coordinates" in content):
        return "a mesh of FEniCS; FEniCS writes a .xdmf file with it: XDMFFile(...).write(mesh)"
    return "HDF5 of an unknown program; look at a mesh of arrays that h5py reads"


def _check_before(path: Path, selection: Selection) -> None:
    """Raise FileError for a file that may end the process inside its reader."""
    if content := other_formats.of_content(path):
        raise _wrong("file", "a mesh that PyVista reads", f"'{path}' ({content})")
    short = short_files.missing_part(path)
    if short in short_files.OTHERS:
        raise _wrong("file", short_files.OTHERS[short], f"'{path}' ({short})")
    if short:
        raise _damaged(path, short)
    if _trials.are_needed():
        if path.suffix.lower() in GUARDED and not selection.overlays:
            return
        load = functools.partial(foreign_files.load, path)
        tried = functools.partial(_refusal, path, selection)
        if refusal := _trials.refusal(load, tried, path, _size(path)):
            raise FileError(refusal)
    elif path.suffix.lower() in GRID_PIECES:
        # VTK ends the process where a piece of a grid has an error.
        for piece in references.named(path):
            _read(piece, Selection())


def _refusal(path: Path, selection: Selection) -> str:
    """Return why a file is refused, or "" where it is read, or where its caller is at fault."""
    try:
        with _check.held():
            _read(path, selection)
    except FileError as error:
        return str(error)
    except Exception:  # noqa: BLE001 - of any type: it is raised again where the file is read
        return ""
    return ""


def _size(path: Path) -> int:
    """Return the number of bytes of a file, and of those that are read with it."""
    if path.is_dir() or path.suffix.lower() == ".foam":
        folder = path if path.is_dir() else path.parent
        return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())
    if path.suffix.lower() == ".case":
        with path.open("rb") as case:
            return ensight.size(case)
    files = {path, *references.named(path)}
    files |= {further for file in files if _is_file(file) for further in references.named(file)}
    return sum(file.stat().st_size for file in files if _is_file(file))


def _is_file(path: Path) -> bool:
    """Return whether a path is a file, also one with a name that the system does not take."""
    with contextlib.suppress(OSError, ValueError):
        return path.is_file()
    return False


def _meshes(data: Foreign, path: Path, selection: Selection, notes: list[str]) -> list[Foreign]:
    """Return the meshes of the contents of a file, whose blocks are checked."""
    for block in blocks.all_blocks(data):
        # Before blocks are joined, since joining reads their cells.
        _check_block(block, path)
    several = isinstance(data, pv.MultiBlock) and not selection.whole
    return [
        _whole(part, path.suffix.lower(), () if i else selection.overlays, selection.time, notes)
        for i, part in enumerate(blocks.by_dimension(data) if several else [data])
    ]


def _faults(errors: list[str]) -> list[str]:
    """Return the messages of VTK for which a file is refused.

    A directive that VTK does not know costs a field of an OpenFOAM case, and not the case.
    """
    harmless = _DIRECTIVE.search, _HARMLESS.search
    return [error for error in errors if not any(search(error) for search in harmless)]


def _selection(
    time: float | str | None,
    overlay: str | Path | Sequence[str | Path],
    at: Mapping[str, object] | None,
    nodata: float | None,
) -> Selection:
    """Return the part of a file that checked options name."""
    overlays = overlay if isinstance(overlay, list | tuple) else [overlay]
    return Selection(time, [_path("overlay", name) for name in overlays], at, nodata)


def _check_selection(time: object, at: object, nodata: object) -> float | None:
    if getattr(time, "ndim", 0):
        raise _check.type_error("time", "the time of a step, or its index", time)
    _check.instance("at", at, dict, optional=True)
    return fills.checked(nodata)


def _check_there(path: Path, overlays: Sequence[Path]) -> None:
    """Check that a file and those over it exist and can be opened."""
    for name, checked in (("file", path), *(("overlay", checked) for checked in overlays)):
        if what := no_file(checked):
            inside = _readable(checked) if checked.is_dir() else []
            remedy = f"in it are {', '.join(inside)}" if inside else ""
            raise _wrong(name, "a file", f"'{checked}' ({what})", remedy)
    if not os.access(path, os.R_OK):
        raise _wrong("file", "a readable file", f"'{path}'")
    # VTK opens a name by its bytes in UTF-8; under another locale those may name another file or
    # none.
    if str(path).encode("utf-8", "replace") != os.fsencode(path):
        expected, remedy = "a name in the characters of the locale", "set PYTHONUTF8=1"
        raise _wrong("file", expected, ascii(str(path)), remedy)


def _readable(folder: Path) -> list[str]:
    """Return the first files of a folder that can be read, by their names, and their number."""
    paths = [path for path in sorted(folder.iterdir()) if foreign_files.has_reader(path)]
    names = [f"'{path}'" for path in paths[:MOST_NAMED]]
    return names + [f"{len(paths) - MOST_NAMED} more"] * (len(paths) > MOST_NAMED)


def no_file(path: Path) -> str:
    """Return why a path is no file that can be read, an empty text if it is one.

    A store of Zarr is a folder, and so is a case of OpenFOAM.
    """
    if path.is_file() or (path.is_dir() and path.suffix.lower() in cf_grids.ZARR):
        return ""
    if series.is_case(path):
        return ""
    return "a folder" if path.is_dir() else "a pipe or device" if path.exists() else "no such file"


def _check_block(mesh: pv.DataSet, path: Path) -> None:
    """Raise ValueError for a block that VTK's reader makes of an incomplete file."""
    size = dimensions(mesh)
    if min(size, default=1) < 0 or mesh.n_points > MOST_POINTS:
        raise FileError(f"no points: the dimensions are {size}")
    if isinstance(mesh, pv.RectilinearGrid):
        axes = mesh.GetXCoordinates(), mesh.GetYCoordinates(), mesh.GetZCoordinates()
        if most := max(axis.GetNumberOfComponents() for axis in axes) - 1:
            raise FileError(f"an axis has {most + 1} numbers for each place")
    if blocks.is_too_far(mesh):
        raise FileError(f"points beyond {_check.FARTHEST:g}, the largest coordinate")
    # VTK's reader of OBJ gives groups and materials to the faces alone, also beside lines, and
    # normals that no face names to the points, however many these are; points alone lose nothing.
    of_points = [(mesh.point_data, mesh.n_points, "point")] if path.suffix.lower() == ".obj" else []
    for data, count, what in ((mesh.cell_data, mesh.n_cells, "cell"), *of_points):
        odd = [key for key in data if len(data[key]) != count]
        for key in odd:
            del data[key]
        if odd and (mesh.GetMaxSpatialDimension() or not of_points):
            _check.warn(f"file: arrays without a row for each {what} are left out: {odd}")
    if path.suffix.lower() == ".stl":
        file_parts.warn_of_less(path, mesh.n_cells, short_files.triangles(path), "triangles")
    for cells in cell_arrays(mesh):
        ids, ends = connectivity(cells)
        if len(ends) and ((ends[0], ends[-1]) != (0, len(ids)) or np.any(ends[1:] < ends[:-1])):
            # VTK ends the process where it draws or writes them.
            raise FileError(f"cells that do not follow one another among {len(ids)} corners")
    check_whole(mesh, "mesh")
    if lacking := legacy_vtk.missing_numbers(mesh, path):
        raise FileError(lacking)


def _whole(
    data: Foreign, suffix: str, overlays: Sequence[Path], time: object, notes: list[str]
) -> Foreign:
    """Return one upright mesh of the contents of a file with a suffix, with the values over it.

    Notes for its reader are appended to ``notes``.
    """
    mesh = data
    if isinstance(data, pv.MultiBlock):
        joined = blocks.highest(data)
        mesh = joined.grid
        notes += [note] if (note := joined.note()) else []
    if isinstance(mesh, pv.DataSet):
        normals.drop_empty(mesh)
        _name_in_one_line(mesh)
        notes += [note] if (note := _rounded(mesh)) else []
    # These formats may have points for each face or colour; an overlay has a row for each point,
    # and keeps them apart.
    if suffix in SOUPS and mesh.GetMaxSpatialDimension() == 2 and not overlays:
        surface = blocks.surface(mesh, "file")
        mesh = normals.welded(surface)
        # VTK's reader of STL, which has no points of its own, keeps those of faces without area.
        is_soup = suffix == ".stl" or mesh is surface
        if not is_soup and (alone := np.count_nonzero(~used(surface))):
            notes.append(f"{alone} of its {surface.n_points} points are in no face and left out")
    elif suffix in PIECES:
        # Pieces have cells of their neighbours, and points of their own along the seams.
        mesh = normals.welded(joining.without_ghosts(mesh))
    elif suffix == ".grdecl":
        # Each cell has points of its own, so that faces between cells would be outer ones.
        mesh = normals.welded(mesh.cast_to_unstructured_grid())
    elif isinstance(mesh, pv.UnstructuredGrid) and not overlays and _has_points_outside(mesh):
        count = mesh.n_points
        mesh = mesh.remove_unused_points()
        notes.append(f"{count - mesh.n_points} of its {count} points are in no cell and left out")
    for path in overlays:
        if path.suffix.lower() in (*cf_grids.SUFFIXES, *georeference.SUFFIXES):
            step = time if path.suffix.lower() in cf_grids.SUFFIXES else None
            cf_grids.add(mesh, _found(path, step), path)
            continue
        if path.suffix.lower() in tables.SUFFIXES:
            tables.add(mesh, path)
            continue
        arrays, meant = brains.overlay(path, mesh)
        for name, rows in arrays.items():
            mesh.point_data[name] = rows
        if meant.arrays:
            said = meaning.of(mesh)
            said.arrays |= meant.arrays
            meaning.attach(mesh, said)
    # Their standards say that y is up; here z is.
    mesh = mesh.rotate_x(90) if suffix in Y_UP else mesh
    if suffix in GLTF:
        notes += _finish_gltf(mesh)
    # Points that only a colour tells apart have the normals of the surface, if it has no creases.
    if suffix in SOUPS and isinstance(mesh, pv.PolyData):
        normals.keep_normals(mesh)
    return mesh


def _finish_gltf(mesh: pv.DataSet) -> list[str]:
    """Make colours of glTF bytes and drop the shapes of an animation; return notes."""
    if GLTF_COLORS in mesh.point_data:
        mesh.point_data[GLTF_COLORS] = _as_bytes(mesh.point_data[GLTF_COLORS])
    # They are differences to other shapes, and no vectors of this one.
    shapes = [name for name in mesh.point_data if _SHAPES.match(name)]
    for name in shapes:
        del mesh.point_data[name]
    return [f"shapes of its animation are left out: {', '.join(shapes)}"] if shapes else []


def _has_points_outside(mesh: pv.UnstructuredGrid) -> bool:
    """Return whether points of no cell are outside of the box around all cells."""
    corners = np.zeros(mesh.n_points, np.bool_)
    corners[mesh.cell_connectivity] = True
    if not corners.any() or corners.all():
        return False
    low, high = np.asarray(mesh.points[corners]).min(axis=0), mesh.points[corners].max(axis=0)
    return bool(np.any(mesh.points < low) or np.any(mesh.points > high))


def _name_in_one_line(mesh: pv.DataSet) -> None:
    """Take breaks, and spaces at the ends, out of the names of arrays, which can then be typed."""
    for name in (*mesh.point_data, *mesh.cell_data):
        line = " ".join(name.split())
        if line and line not in mesh.array_names and (name.strip() != name or "\n" in name):
            mesh.rename_array(name, line)


def _as_bytes(colors: Raw) -> Raw:
    """Return colours of glTF, which are linear in light, as bytes in sRGB."""
    if colors.dtype.kind != "f":
        return colors
    light = np.clip(np.asarray(colors, np.float64), 0, 1)
    light[:, :3] = np.where(
        light[:, :3] <= 0.0031308, 12.92 * light[:, :3], 1.055 * light[:, :3] ** (1 / 2.4) - 0.055
    )
    return np.rint(255 * light).astype(np.uint8)


def _arrays(mesh: pv.DataSet) -> set[str]:
    """Return the names of the arrays of a mesh, but for VTK's own, such as numbers of points."""
    return {name for name in (*mesh.point_data, *mesh.cell_data) if not name.startswith("vtk")}


def _warn_of_unread(path: Path, unread: list[re.Match[str]]) -> None:
    """Warn of fields of an OpenFOAM case that VTK could not read."""
    if unread:
        fields = ", ".join(f"'{match[1]}' (#{match[2]})" for match in unread)
        _check.warn(
            f"file: '{path}' has fields that are left out, for VTK does not read their directives: "
            f"{fields}; foamDictionary -expand writes them out"
        )


#: Functions that open packed files, by the ends of their names.
_UNPACK: dict[str, Foreign] = {
    ".gz": gzip.open, ".bz2": bz2.open, ".xz": lzma.open,
}  # fmt: skip
#: Formats whose readers take them packed.
_PACKED_ALIKE = (".img", ".mgh", ".nii", ".tt")
#: Most bytes that are unpacked: a small file can hold any number of zeros.
MOST_UNPACKED = 1 << 33
#: Formats of meshers, whose meshes have the points and edges of the shape beside its cells.
_MESHERS = (".med", ".mmed", ".mesh", ".meshb", ".msh")


def _unpacked(path: Path, read: Callable[[Path], list[pv.DataSet]]) -> list[pv.DataSet]:
    """Return the meshes of a packed file, or of GRIB, from a temporary file of its contents."""
    unpack = _UNPACK.get(path.suffix.lower())
    with _supervise.folder(path) as folder:
        inner = folder / (path.stem if unpack else f"{path.name}.grib")
        try:
            with (unpack or open)(path, "rb") as packed, inner.open("wb") as file:
                while block := packed.read(1 << 20):
                    file.write(block)
                    if file.tell() > MOST_UNPACKED:
                        raise _damaged(path, f"more than {MOST_UNPACKED} bytes are in it")
        except (OSError, EOFError, lzma.LZMAError, zlib.error) as error:
            raise _damaged(path, messages.reason(error)) from error
        try:
            with _check.held(str(inner), str(path)):
                return read(inner)
        except FileError as error:
            # The name of the temporary file says nothing to anyone.
            raise FileError(str(error).replace(str(inner), str(path))) from error


def _found(
    path: Path,
    time: object,
    at: Mapping[str, object] | None = None,
    nodata: float | None = None,
) -> pv.DataObject:
    """Return the data of the first reader that knows a file."""
    contents: pv.DataObject | None = None
    if not series.is_case(path):
        contents = foreign_files.read(path, time, at=at, nodata=nodata)
    contents = series.read(path, time) if contents is None else contents
    contents = _by_package(path) if contents is None else contents
    if path.suffix.lower() in _MESHERS:
        # As a block it is reduced to its cells of the highest dimension, see
        # :func:`.blocks.one_grid`.
        contents = pv.MultiBlock({"cells of lower dimension": contents})
    if isinstance(contents, pv.MultiBlock):
        contents = _without_sets(contents, is_fluent=path.suffix.lower() == ".cas")
    if isinstance(contents, pv.PartitionedDataSet):
        data, contents = contents.field_data, pv.MultiBlock(list(contents))
        contents.field_data.update(data)
    return contents


def _names(data: pv.MultiBlock) -> list[str]:
    return [str(name) for name in data.keys()]  # noqa: SIM118 - its own loop gives blocks


def _without_sets(data: pv.MultiBlock, *, is_fluent: bool) -> pv.MultiBlock:
    """Return the elements of a file of Exodus or Fluent, without sets of their sides and nodes.

    Cells of a flat set of sides come twice from VTK's reader of Fluent: in the set, and in the
    whole.
    """
    names = _names(data)
    chosen = [name for name in names if is_fluent and name.endswith((":fluid", ":solid"))]
    if EXODUS[0] in names and any(block.n_cells for block in blocks.all_blocks(data[EXODUS[0]])):
        chosen = [name for name in names if name not in EXODUS[1:]]
    if not chosen:
        return data
    kept = pv.MultiBlock({name: data[name] for name in chosen})
    for name in data.field_data:
        kept.field_data[name] = data.field_data[name]
    return kept


def _path(name: str, value: object) -> Path:
    """Return a path that the system takes, whether or not the file exists."""
    path = _check.path(name, value)
    try:
        path.stat()
    except OSError as error:
        # The system reports other errors, such as a name that is too long; the check for a missing
        # file comes later.
        if error.errno not in (errno.ENOENT, errno.ENOTDIR, errno.EACCES):
            got = f"{_check.describe(str(path))} ({error.strerror})"
            raise _wrong(name, "a path that the system takes", got) from error
    return path


def _damaged(path: Path, reason: str) -> FileError:
    got, remedy = f"'{path}' ({reason})", foreign_files.missing(path)
    return _wrong("file", "a file that is not damaged", got, remedy)


def _by_package(path: Path) -> pv.DataObject:
    """Return the data of a file that VTK has no reader for, but a package such as meshio."""
    try:
        return pv.read(path, validate=False)
    except OSError as error:
        raise FileError(other_formats.reason(path)) from error


def _left_out(data: pv.MultiBlock, meshes: Sequence[pv.DataSet]) -> list[str]:
    """Return a note on blocks that are not in the meshes, or on the arrays that only they have."""
    grid = meshes[0]
    kept = {kind for mesh in meshes for kind in mesh.distinct_cell_types}
    lower = [pair for pair in blocks.named_blocks(data) if pair[0].distinct_cell_types - kept]
    # A block whose points are all the grid's is a side set, which bounds cells of the grid.
    there = place_numbers(np.asarray(grid.points)) if lower else ()
    names = ", ".join(
        path.lstrip("/")
        for block, path in lower
        if not np.isin(place_numbers(np.asarray(block.points)), there).all()
    )
    if names:
        said = "blocks whose cells are of a lower dimension than other blocks', "
        way = "light pyvista.read(...) to keep all blocks"
        return [f"{said}which are left out: {names}; {way}"]
    lost = {name for block, _ in lower for name in _arrays(block)}
    lost -= {name for mesh in meshes for name in _arrays(mesh)}
    return [f"arrays of side sets alone are left out: {', '.join(sorted(lost))}"] if lost else []


def check_output(path: str | Path, /, formats: tuple[str, ...], *, name: str = "path") -> Path:
    """Return the path of an output file, if the file can be written.

    Parameters
    ----------
    path : path
        Path of the file.
    formats : tuple of str
        Allowed file name extensions, each with its dot.
    name : str, default: "path"
        Name of the argument in messages.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    FileError
        If the extension is not allowed, or the folder is missing or not writable.
    """
    path = _path(name, path)
    try:
        path.absolute()
    except FileNotFoundError as error:
        got = f"'{path}' in a working folder that is gone"
        raise _wrong(name, "a folder that exists", got) from error
    if path.suffix.lower() not in formats:
        raise _wrong(name, f"a name that ends in {', '.join(formats)}", f"'{path}'")
    if not path.parent.is_dir():
        raise _wrong(name, "a folder that exists", f"'{path.parent}'", "make it first")
    _refuse_others(name, path)
    if not os.access(path.parent, os.W_OK):
        got = f"'{path.parent}', which is read-only"
        raise _wrong(name, "a writable folder", got)
    return path


def check_format(mesh: pv.DataSet | pv.MultiBlock, path: str | Path, /) -> Path:
    """Return the path, if its extension belongs to a format for this type of mesh.

    Raises
    ------
    FileError
        If the format does not support the type of mesh.
    """
    for block in blocks.all_blocks(mesh) if isinstance(mesh, pv.MultiBlock) else [mesh]:
        check_dataset(block)
    path, kind = _path("output", path), type(mesh).__name__
    if kind not in FORMATS:
        expected = f"one of {', '.join(FORMATS)}"
        raise _wrong("mesh", expected, kind, "cast it to one of them")
    formats = FORMATS[kind]
    if path.suffix.lower() not in formats:
        expected = f"a name that ends in {', '.join(formats)} for {kind}"
        remedy = "it is one mesh, which has no blocks" if path.suffix.lower() == ".vtm" else ""
        raise _wrong("output", expected, f"'{path.name}'", remedy)
    return path


def write_mesh(mesh: pv.DataSet | pv.MultiBlock, path: str | Path, /) -> Path:
    """Write a mesh with its arrays; no partial file is left.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh to write.
    path : path
        Path of the file, in an existing folder. Its extension, one of .vtp, .vtu, .vtk, .vts,
        .vti and .vtr, or .vtm for several blocks, determines the format; .stl has no arrays, and
        of an image the solid below its active heights; far from the origin it is moved there, with
        a warning. An existing file is replaced. The blocks are in a folder beside the .vtm file,
        which has its name without the extension.

    Returns
    -------
    pathlib.Path
        Path of the file.

    Raises
    ------
    FileError
        If the format does not support the type of mesh, or the file cannot be written.
    """
    path = check_format(mesh, path)
    for block in blocks.all_blocks(mesh):
        _check_names(block, legacy=path.suffix.lower() == ".vtk")
    if path.suffix.lower() == ".vtu" and isinstance(mesh, pv.PolyData):
        mesh = mesh.cast_to_unstructured_grid()
    # STL has no cells but triangles.
    if path.suffix.lower() == ".stl":
        mesh = _resolved(mesh if isinstance(mesh, pv.ImageData) else mesh.triangulate())
        mesh = _solid(mesh) if isinstance(mesh, pv.ImageData) else mesh

    # Files of blocks are moved there when all of them are whole.
    folder = path.with_suffix("")

    def save(draft: str) -> None:
        _reserve(Path(draft), blocks.all_blocks(mesh))
        copies = blocks.like(mesh, map(_to_save, blocks.all_blocks(mesh)))
        with messages.captured_errors() as errors:
            copies.save(draft)
        # VTK writes the files of the blocks to a folder that has the name of the draft.
        files = sorted(Path(draft).with_suffix("").glob("*"))
        _check_drafts([Path(draft), *files], errors)
        for file in files:
            file.replace(folder / file.name)

    if not isinstance(mesh, pv.MultiBlock):
        return replace_file(path, save)
    make_folder("output", folder)
    try:
        return replace_file(path, save)
    finally:
        with contextlib.suppress(OSError):  # it is removed if nothing is in it
            folder.rmdir()


def _rounded(mesh: pv.DataSet) -> str:
    """Return a note on points in float32 that are too far from the origin, else an empty text."""
    if not isinstance(mesh, pv.PolyData | pv.UnstructuredGrid) or not mesh.n_cells:
        return ""
    step = float(np.finfo(np.float32).eps * np.abs(blocks.near_origin(mesh)).max())
    if mesh.points.dtype != np.float32 or step < FINE * (cell := _shortest(mesh)):
        return ""
    return (
        f"its points are read as float32, which are {step:.2g} apart at this distance from the "
        f"origin, and sides of cells have {cell:.2g}: points may fall together"
    )


def _shortest(mesh: pv.DataSet) -> float:
    """Return the length than which few sides of cells are shorter, infinity without sides.

    It is measured at evenly spaced cells where they are many.
    """
    # Rows may be closer to each other than columns.
    if isinstance(mesh, pv.ImageData):
        return float(min(mesh.spacing[:2]))
    ids = simplices(mesh)
    ids = ids[:: len(ids) // MEASURED + 1]
    corners = np.asarray(mesh.points)[ids].astype(np.float64)
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).min(axis=1)
    return float(np.percentile(sides[sides > 0], SHORT)) if sides.any() else np.inf


def _resolved(mesh: DataSetT) -> DataSetT:
    """Return a mesh moved to the origin if float32, which .stl has, does not resolve its points."""
    origin = np.array(blocks.near_origin(mesh))
    if np.finfo(np.float32).eps * np.abs(origin).max() < FINE * _shortest(mesh):
        return mesh
    words = ", ".join(f"{-part:.9g}" for part in origin)
    _check.warn(
        f"output: the mesh is moved by ({words}), since the float32 numbers of .stl do not "
        "resolve its points where it is"
    )
    return blocks.moved(mesh, -origin)


def _solid(field: pv.ImageData) -> pv.PolyData:
    """Return the closed surface of a height field above a level base."""
    name = height_grids.heights_name(field)
    if name is None or min(field.dimensions[:2]) < 2 or field.dimensions[2] != 1:
        expected = "an image of one layer with an active array of heights, for .stl"
        raise _wrong("mesh", expected, _check.describe(field))
    top = warped(field, name, 1.0).extract_surface(algorithm="dataset_surface")
    base = top.bounds.z_min - BASE * max(field.bounds_size[:2])
    middle = (top.center[0], top.center[1], base)
    # The plane is larger than the field on all sides, so that all walls end at it.
    plane = pv.Plane(center=middle, i_size=3 * top.length, j_size=3 * top.length)
    solid: pv.PolyData = top.extrude_trim((0, 0, -1), plane).clean().triangulate()
    return solid


def _to_save(mesh: pv.DataSet) -> pv.DataSet:
    """Return a copy, because PyVista notes the types of arrays in the mesh that it saves."""
    copy = mesh.copy(deep=False)
    if isinstance(copy, pv.UnstructuredGrid) and copy.GetCells() is None:
        copy.SetCells(vtkUnsignedCharArray(), pv.CellArray())  # VTK's writer ends the process
    for data in (copy.GetPointData(), copy.GetCellData()):
        for kind in range(data.NUM_ATTRIBUTES):
            # VTK ends the process where the active normals or vectors are text.
            if data.GetAbstractAttribute(kind) is not None and data.GetAttribute(kind) is None:
                data.SetActiveAttribute(-1, kind)
    return copy


def _check_names(mesh: pv.DataSet, *, legacy: bool) -> None:
    """Check that a file can hold the names of the arrays.

    VTK's writers of XML do not escape them; its writer of legacy files ends the process at braces.
    """
    wrong, signs = '[<&"\x00-\x1f]', "<, &, quotation marks and control characters"
    other = "a .vtk file"
    if legacy:
        wrong, signs, other = "[{}]", "braces in a legacy file", "a file of XML, such as .vtp"
    for data in (mesh.point_data, mesh.cell_data, mesh.field_data):
        for name in data:
            if re.search(wrong, name):
                expected = f"array names without {signs}"
                raise _wrong("output", expected, repr(name), f"rename the array, or write {other}")


def _reserve(draft: Path, meshes: Iterable[pv.DataSet]) -> None:
    """Check that the disk, a quota and the limit of file sizes leave room for meshes.

    VTK's writers end the process where they do not. Space that is reserved and released tells of
    all three.
    """
    # Text of base64 has 4 bytes for 3.
    size = sum(mesh.actual_memory_size for mesh in meshes) * 1024 * 4 // 3 + 65536
    if hasattr(os, "posix_fallocate"):
        with draft.open("wb") as file:
            try:
                os.posix_fallocate(file.fileno(), 0, size)
            except OSError as error:
                # By these errors a file system says that it cannot reserve space; the free space is
                # asked for below.
                if error.errno not in (errno.EINVAL, errno.EOPNOTSUPP, errno.ENOSYS):
                    expected = f"{size / 1e6:.1f} MB of free disk"
                    got = f"'{draft.parent.parent}' ({error.strerror})"
                    raise _wrong("output", expected, got) from error
        draft.unlink()
    free = shutil.disk_usage(draft.parent).free
    if size > free:
        got = f"{free / 1e6:.1f} MB in '{draft.parent.parent}'"
        raise _wrong("output", f"{size / 1e6:.1f} MB of free disk", got)


def _check_drafts(drafts: Iterable[Path], errors: list[str]) -> None:
    """Check that written files are whole, by the messages of the writer and by their ends."""
    reasons = [short_files.missing_part(draft) if draft.is_file() else "none" for draft in drafts]
    for reason in (*errors, *filter(None, reasons)):
        raise _wrong("output", "a file that can be written", reason)


def _refuse_others(name: str, path: Path) -> None:
    """Raise FileError where a path is no regular file, such as a folder or a pipe, but exists."""
    if path.exists() and (what := no_file(path)):
        raise _wrong(name, "a file", f"'{path}' ({what})")


def _sweep(place: Path) -> None:
    """Remove the temporary folders of writers that were killed: those still at work lock theirs."""
    for folder in [*place.glob(f"{DRAFTS}*"), *place.glob(f"{FRESH}*")] if fcntl else ():
        with contextlib.suppress(OSError), _opened(folder) as opened:
            # An error says that it is locked, another's, or gone.
            fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
            # A fresh one may belong to a writer that has just made it.
            age = time.time() - os.fstat(opened).st_mtime
            if folder.name.startswith(DRAFTS) or age > ABANDONED:
                shutil.rmtree(folder)


@contextlib.contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a temporary folder, where the system has such locks."""
    if not fcntl:
        yield
        return
    with _opened(folder) as opened:
        # Who sweeps asks for the lock that excludes others, which is refused while a writer holds
        # this one.
        with contextlib.suppress(OSError):  # the file system has none
            fcntl.flock(opened, fcntl.LOCK_SH)
        yield


@contextlib.contextmanager
def _opened(folder: Path) -> Iterator[int]:
    opened = os.open(folder, os.O_RDONLY)
    try:
        yield opened
    finally:
        os.close(opened)


def make_folder(name: str, path: Path, /) -> None:
    """Make a folder and those above it; ``name`` is the argument in the error message."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _wrong(name, "a folder that can be made", f"'{path}' ({error.strerror})") from error


def replace_file(
    path: Path, write: Callable[[str], object], *, doing: _supervise.Doing = "write"
) -> Path:
    """Write a file in a temporary folder and move it to its path, so that no partial file is left.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file. An existing file is replaced.
    write : callable
        Function that writes the file to a path given as a string.
    doing : {"write", "draw"}
        Work of the function, for the message if it ends the process.

    Returns
    -------
    pathlib.Path
        Path of the file.

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    path = _path("output", path)
    _refuse_others("output", path)
    target = path.resolve()  # a symbolic link stays, and what it points to is replaced
    _sweep(target.parent)
    # A parent knows of the folder before it is there and until it is gone. It has its name from the
    # time of its lock on: others sweep folders of that name without one.
    number = uuid.uuid4().hex[:12]
    fresh, folder = (target.parent / f"{begin}{number}" for begin in (FRESH, DRAFTS))
    try:
        with (
            _supervise.stage(doing, path, temporary=str(fresh)),
            _supervise.stage(doing, path, temporary=str(folder)),
        ):
            fresh.mkdir(mode=0o700)
            try:
                with _locked(fresh):
                    fresh.rename(folder)
                    draft = folder / f"{path.stem}{path.suffix.lower()}"
                    write(str(draft))
                    # A file that is replaced hands on its permissions.
                    if target.exists():
                        draft.chmod(target.stat().st_mode)
                    # Within a file system a file is moved at once: readers see the old one or the
                    # new one.
                    draft.replace(target)
            finally:
                # Without its lock another writer may sweep it at the same time.
                shutil.rmtree(folder if folder.exists() else fresh, ignore_errors=True)
    except OSError as error:
        got = f"'{path}' ({error.strerror})"
        raise _wrong("output", "a file that can be written", got) from error
    return path
