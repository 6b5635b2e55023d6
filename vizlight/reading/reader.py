"""Reading and writing of meshes: readers with clear errors, writers that leave no partial file."""

from __future__ import annotations

import bz2
import functools
import gzip
import lzma
import os
import re
import zlib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyvista as pv

from vizlight import _check, _supervise, _trials
from vizlight._types import Foreign
from vizlight.mesh import blocks, fills, joining, meaning, normals
from vizlight.mesh.subdivision import simplices
from vizlight.reading import (
    brains,
    cf_grids,
    ensight,
    file_parts,
    formats,
    gltf,
    legacy_vtk,
    other_formats,
    rasters,
    references,
    series,
    stl,
    tables,
    wavefront,
)
from vizlight.reading.paths import FileError, checked_path, is_file, no_file, wrong
from vizlight.vtk import messages
from vizlight.vtk.cells import cell_arrays, check_whole, connectivity, dimensions, used
from vizlight.vtk.topology import place_numbers

#: Ends of names of files that have points for each face, or for each colour.
SOUPS = (".obj", ".off", ".ply", ".stl", ".wrl")
#: Formats that need no trial: of some thousand damaged files of each, none ended the process by
#: which :func:`.formats.missing_part` had let it be read.
GUARDED = (".obj", ".off", ".ply", ".stl", ".vti", ".vtp", ".vtr", ".vts", ".vtu")
#: Indices of pieces of one mesh, whose cells name their points, and of pieces of one grid.
PIECES, GRID_PIECES = (".pvtp", ".pvtu"), (".pvti", ".pvtr", ".pvts")
#: Ends of names of files in which y is up.
Y_UP = (".glb", ".gltf", ".vrml", ".wrl")
#: Names of the blocks of Exodus: those of elements, and of what is chosen among them.
EXODUS = (
    "Element Blocks", "Side Sets", "Node Sets", "Face Sets", "Edge Sets", "Element Sets",
)  # fmt: skip
#: Name that VTK gives to the numbers of blocks of Exodus at their cells.
_OF_BLOCKS = "ObjectId"
#: Largest number of points of a mesh: half of the addresses that processors have.
MOST_POINTS = 1 << 40
#: Largest rounding of points in a file of float32, as a share of the shortest side of a cell, and
#: the percentage of cells that may be smaller.
FINE, SHORT = 1e-2, 5.0
#: Number of cells of which the sides are measured.
MEASURED = 1 << 16


#: What VTK says of files that are whole: its importer of VRML makes a window that none needs, keys
#: of ParaView's, of NRRD and ranges of NaN are metadata, conditions at the boundary of CGNS no
#: cells and its lists of solutions known without them, and a case of Fluent is a mesh without data.
_HARMLESS = re.compile(
    "bad X server connection|Could not locate key|Error reading InformationKey|Skipping BC_t node"
    "|glTF extension .* is used in|Unknown field: '[^:]*:=|Only the case file will be opened"
    "|FlowSolutionPointers"
)
#: Most files of a folder that an error names.
MOST_NAMED = 8
#: What VTK says of an OpenFOAM file that is whole, but in a language that it has only a part of.
_DIRECTIVE = re.compile(r"Error reading line \d+ of (\S+): Unsupported directive (\w+)")


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
        return _read(checked_path("file", path), _selection(time, overlay, at, nodata))[0]


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

    Surfaces at the points of volumes are left out: they are walls, which would hide them.

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
        file, selection = checked_path("file", path), _selection(time, overlay, at, nodata)
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
    is_named = bool(formats.of(path).package)
    if is_packed or (
        not is_named and path.is_file() and file_parts.first_bytes(path, 4) == b"GRIB"
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
            data: Foreign = _found(path, selection)
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
    said, errors = errors, _faults(errors)
    if not meshes or not all(isinstance(mesh, pv.DataSet) and mesh.n_points for mesh in meshes):
        reason = f"no points: {errors[0]}" if errors else reason
        if reason.startswith("its overlay"):
            raise wrong("overlay", f"values for the points of '{path}'", f"none: {reason}")
        if "CFF Fluent" in reason:  # as VTK says of any other .h5 file
            reason = _of_hdf(path)
        got, remedy = f"'{path}' ({reason})", formats.way_out(path)
        raise wrong("file", "a mesh that PyVista reads", got, remedy)
    # After an error VTK gives what it has read so far: a part of a mesh, which looks like a whole.
    if errors:
        raise _damaged(path, errors[0])
    _warn_of_unread(path, said)
    if isinstance(data, pv.MultiBlock):
        notes += _left_out(data, meshes)
    if path.suffix.lower() == ".obj" and wavefront.has_free_form(path):
        notes.append("its free-form curves and surfaces (curv, surf) are left out")
    if path.is_file() and (elsewhere := references.outside(path)):
        notes.append(f"it takes files from outside of its folder: {', '.join(elsewhere)}")
    if notes:
        _check.warn(f"file: '{path}': {'; '.join(dict.fromkeys(notes))}")
    return meshes


def _of_hdf(path: Path) -> str:
    """Return the name of the format of an HDF5 file that is not read, and a way to its mesh."""
    content = path.read_bytes()
    if b"mdtraj" in content.lower():
        return (
            "a trajectory of MDTraj; it writes a state as .pdb: "
            f"mdtraj.load('{path.name}')[0].save('{path.stem}.pdb')"
        )
    if b"elangle" in content:
        return (
            "a radar's volume of ODIM; xradar makes CfRadial of it: xradar.io.to_cfradial1("
            f"xradar.io.open_odim_datatree('{path.name}'), '{path.stem}.nc')"
        )
    if b"topology" in content and (b"geometry" in content or b"coordinates" in content):
        return (
            "a mesh without its .xdmf file, which is read, and which programs write with it, as "
            "FEniCS by XDMFFile(...).write(mesh)"
        )
    return "HDF5 of an unknown program; look at a mesh of arrays that h5py reads"


def _check_before(path: Path, selection: Selection) -> None:
    """Raise FileError for a file that may end the process inside its reader."""
    if content := other_formats.of_content(path):
        raise wrong("file", "a mesh that PyVista reads", f"'{path}' ({content})")
    short = formats.missing_part(path)
    if short in formats.OTHERS:
        raise wrong("file", formats.OTHERS[short], f"'{path}' ({short})")
    if short:
        raise _damaged(path, short)
    if _trials.are_needed():
        if path.suffix.lower() in GUARDED and not selection.overlays:
            return
        load = functools.partial(formats.load, path)
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
    files |= {further for file in files if is_file(file) for further in references.named(file)}
    return sum(file.stat().st_size for file in files if is_file(file))


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
    return Selection(time, [checked_path("overlay", name) for name in overlays], at, nodata)


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
            raise wrong(name, "a file", f"'{checked}' ({what})", remedy)
    if not os.access(path, os.R_OK):
        raise wrong("file", "a readable file", f"'{path}'")
    # VTK opens a name by its bytes in UTF-8; under another locale those may name another file or
    # none.
    if str(path).encode("utf-8", "replace") != os.fsencode(path):
        expected, remedy = "a name in the characters of the locale", "set PYTHONUTF8=1"
        raise wrong("file", expected, ascii(str(path)), remedy)


def _readable(folder: Path) -> list[str]:
    """Return the first files of a folder that can be read, by their names, and their number."""
    paths = [path for path in sorted(folder.iterdir()) if formats.has_reader(path)]
    names = [f"'{path}'" for path in paths[:MOST_NAMED]]
    return names + [f"{len(paths) - MOST_NAMED} more"] * (len(paths) > MOST_NAMED)


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
        file_parts.warn_of_less(path, mesh.n_cells, stl.triangles(path), "triangles")
    for cells in cell_arrays(mesh):
        ids, ends = connectivity(cells)
        if len(ends) and ((ends[0], ends[-1]) != (0, len(ids)) or np.any(ends[1:] < ends[:-1])):
            # VTK ends the process where it draws or writes them.
            raise FileError(f"cells that do not follow one another among {len(ids)} corners")
    check_whole(mesh, "mesh")
    if lacking := legacy_vtk.missing_numbers(mesh, path):
        raise FileError(lacking)


def _whole(
    data: Foreign, suffix: str, overlays: Sequence[Path], time: float | str | None, notes: list[str]
) -> Foreign:
    """Return one upright mesh of the contents of a file with a suffix, with the values over it.

    Notes for its reader are appended to ``notes``.
    """
    mesh = data
    if isinstance(data, pv.MultiBlock):
        joined = blocks.highest(data)
        mesh = joined.grid
        _name_blocks(mesh, data)
        notes += [note] if (note := joined.note()) else []
    if isinstance(mesh, pv.DataSet):
        normals.drop_empty(mesh)
        _name_in_one_line(mesh)
        _name_materials(mesh)
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
        if path.suffix.lower() in (*cf_grids.SUFFIXES, *rasters.SUFFIXES):
            step = time if path.suffix.lower() in cf_grids.SUFFIXES else None
            cf_grids.add(mesh, _found(path, Selection(step)), path)
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
    if suffix in gltf.GLTF:
        notes += gltf.finished(mesh)
    # Points that only a colour tells apart have the normals of the surface, if it has no creases.
    if suffix in SOUPS and isinstance(mesh, pv.PolyData):
        normals.keep_normals(mesh)
    return mesh


def _name_blocks(mesh: pv.DataSet, data: pv.MultiBlock) -> None:
    """Give the numbers of several blocks of Exodus their names, as those of kinds of cells."""
    ids = mesh.cell_data.get(_OF_BLOCKS)
    if ids is None or len(there := np.unique(ids)) < 2:
        return
    said, kinds = meaning.of(mesh), dict[int, str]()
    for block, path in blocks.named_blocks(data):
        if _OF_BLOCKS in block.cell_data and (number := block.cell_data[_OF_BLOCKS][0]) in there:
            name = path.rpartition("/")[2].removeprefix("Unnamed block ID: ")
            kinds[int(number)] = name.strip()
    mesh.rename_array(_OF_BLOCKS, "block", preference="cell")
    said.add_kinds("block", [(number, name, ()) for number, name in kinds.items()])
    meaning.attach(mesh, said)


def _name_materials(mesh: pv.DataSet) -> None:
    """Give the materials of OBJ their names.

    Where the first faces have one, VTK gives them the number of faces without a material.
    """
    ids = mesh.cell_data.get("MaterialIds")
    if ids is None or "MaterialNames" not in mesh.field_data:
        return
    words: list[str] = np.asarray(mesh.field_data["MaterialNames"]).tolist()
    if not np.isin(ids, range(len(words))).all():
        return
    words = [words[0] if word == "NO_MATERIAL" else word for word in words]
    kinds = list(dict.fromkeys(words))
    mesh.rename_array("MaterialIds", "material", preference="cell")
    mesh.cell_data["material"] = np.array([kinds.index(word) for word in words])[ids]
    said = meaning.of(mesh)
    said.add_kinds("material", [(i, word, ()) for i, word in enumerate(kinds)])
    meaning.attach(mesh, said)


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


def _arrays(mesh: pv.DataSet) -> set[str]:
    """Return the names of the arrays of a mesh, but for VTK's own, such as numbers of points."""
    return {name for name in (*mesh.point_data, *mesh.cell_data) if not name.startswith("vtk")}


def _warn_of_unread(path: Path, errors: list[str]) -> None:
    """Warn of fields of an OpenFOAM case, and of steps of CGNS, that VTK could not read."""
    if any("FlowSolutionPointers" in error for error in errors):
        words = "has FlowSolutionPointers that name no solutions: those of one step are read"
        _check.warn(f"file: '{path}' {words}")
    unread = [match for match in map(_DIRECTIVE.search, errors) if match]
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


def _found(path: Path, selection: Selection) -> pv.DataObject:
    """Return the data of the first reader that knows a file."""
    contents: pv.DataObject | None = None
    if not series.is_case(path):
        contents = formats.read(path, selection.time, at=selection.at, nodata=selection.nodata)
    contents = series.read(path, selection.time) if contents is None else contents
    contents = _by_package(path) if contents is None else contents
    if path.suffix.lower() in _MESHERS and isinstance(contents, pv.DataSet):
        # As a block it is reduced to its cells of the highest dimension, see
        # :func:`.blocks.one_grid`.
        contents = pv.MultiBlock({"cells of lower dimension": contents})
    if isinstance(contents, pv.MultiBlock):
        contents = _without_sets(contents)
    if isinstance(contents, pv.PartitionedDataSet):
        data, contents = contents.field_data, pv.MultiBlock(list(contents))
        contents.field_data.update(data)
    return contents


def _names(data: pv.MultiBlock) -> list[str]:
    return [str(name) for name in data.keys()]  # noqa: SIM118 - its own loop gives blocks


def _without_sets(data: pv.MultiBlock) -> pv.MultiBlock:
    """Return the elements of a file of Exodus or Fluent, without sets of their sides and nodes.

    Cells of a flat set of sides come twice from VTK's reader of Fluent: in the set, and in the
    whole.
    """
    names = _names(data)
    chosen = [name for name in names if name.endswith((":fluid", ":solid"))]
    if EXODUS[0] in names and any(block.n_cells for block in blocks.all_blocks(data[EXODUS[0]])):
        chosen = [name for name in names if name not in EXODUS[1:]]
    if not chosen:
        return data
    kept = pv.MultiBlock({name: data[name] for name in chosen})
    kept.field_data.update(data.field_data)
    return kept


def _damaged(path: Path, reason: str) -> FileError:
    got, remedy = f"'{path}' ({reason})", formats.missing(path)
    return wrong("file", "a file that is not damaged", got, remedy)


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


def _rounded(mesh: pv.DataSet) -> str:
    """Return a note on points in float32 that are too far from the origin, else an empty text."""
    if not isinstance(mesh, pv.PolyData | pv.UnstructuredGrid) or not mesh.n_cells:
        return ""
    step = float(np.finfo(np.float32).eps * np.abs(blocks.near_origin(mesh)).max())
    if mesh.points.dtype != np.float32 or step < FINE * (cell := shortest(mesh)):
        return ""
    return (
        f"its points are read as float32, which are {step:.2g} apart at this distance from the "
        f"origin, and sides of cells have {cell:.2g}: points may fall together"
    )


def shortest(mesh: pv.DataSet) -> float:
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
