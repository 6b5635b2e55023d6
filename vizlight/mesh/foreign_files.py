"""Files that PyVista does not read: tractograms, netCDF, and indices of surfaces in pieces."""

from __future__ import annotations

import contextlib
import importlib.util
import itertools
import re
import threading
import warnings
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pyvista as pv
from pyvista.core.utilities.reader import CLASS_READERS
from vtkmodules.vtkIOXML import vtkXMLPPolyDataReader

from vizlight import _check, _supervise
from vizlight._types import Array, Foreign, Indices, Raw
from vizlight.mesh import (
    abaqus,
    brains,
    cf_grids,
    cubes,
    density_maps,
    dicom,
    file_parts,
    geomview,
    georeference,
    lammps,
    meaning,
    molecule_files,
    molecules,
    neurons,
    ply,
    point_clouds,
    polylines,
    scans,
    scene_files,
    seismic,
    series,
    studio_3ds,
    su2,
    tables,
    tetgen,
    xml_scenes,
)
from vizlight.vtk.topology import place_numbers

#: Number of bytes at the start of an .inp file that show whether it is one of Abaqus.
_INP_HEAD = 64
#: Ends of names of files of CIF.
CIF = (".cif", ".mmcif", ".pdbx")
#: Package that reads the files of a suffix, and the extra that installs it, if one does.
PACKAGES = {
    suffix: (package, extra)
    for package, extra, suffixes in (
        ("nibabel", "tracts", (".trk", ".tck", ".gii", ".nii", ".mgz", ".img")),
        ("trx-python", "tracts", (".trx",)),
        ("laspy", "formats", (".las", ".laz")),
        ("gemmi", "formats", (*CIF, *density_maps.SUFFIXES)),
        ("xarray", "formats", cf_grids.NETCDF),
        ("cfgrib", "", cf_grids.GRIB),
        ("zarr", "", cf_grids.ZARR),
        ("h5py", "formats", (".h5m", ".med", ".mmed")),
        ("rasterio", "maps", georeference.SUFFIXES),
        ("meshio", "formats", (
            ".avs", ".bdf", ".f3grid", ".fem", ".mdpa", ".mesh", ".meshb", ".msh", ".nas", ".post",
            ".tec", ".ugrid", ".vol", ".wkt", ".xmf",
        )),
    )
    for suffix in suffixes
}  # fmt: skip
#: Name under which a package is imported, where that is another.
MODULES = {"trx-python": "trx.trx_file_memmap"}
#: Modules that a package loads when it reads a file.
_TOGETHER = {"xarray": ("xarray", "cf_xarray", "netCDF4", "dask")}
#: Place of the number of columns in the header of an elevation model, and the least that VTK reads.
_DEM_COLUMNS, _DEM_LEAST = slice(858, 864), 100


def missing(path: Path) -> str:
    """Return the remedy for a file that needs a missing package, else an empty text."""
    package, extra = PACKAGES.get(path.suffix.lower(), ("", ""))
    if not package:
        return ""
    # By an import, since a package that is installed may still fail to load.
    try:
        importlib.import_module(MODULES.get(package, package))
    except ImportError:
        return (
            f"{path.suffix.lower()} files are read by {package}: "
            f"run pip install '{f'vizlight[{extra}]' if extra else package}'"
        )
    return ""


def load(path: Path) -> None:
    """Load the packages that read a file, which forks of this process then need not do again."""
    package, _ = PACKAGES.get(path.suffix.lower(), ("", ""))
    for name in _TOGETHER.get(package, (MODULES.get(package, package),) if package else ()):
        with contextlib.suppress(Exception):  # whoever reads the file says that it is missing
            importlib.import_module(name)


def way_out(path: Path) -> str:
    """Return the remedy for a file that no reader takes: a package, or another format."""
    if PACKAGES.get(path.suffix.lower(), ("",))[0] not in ("meshio", "h5py"):
        return missing(path)
    return missing(path) or "save it as .vtu, .vtk or .stl by the program that wrote it"


def has_reader(path: Path) -> bool:
    """Return whether a file can be read by the end of its name."""
    # Packed files have their kind before the suffix of the packer.
    suffixes = {suffix.lower() for suffix in path.suffixes[-2:]}
    is_known = not suffixes.isdisjoint({*CLASS_READERS, *PACKAGES, *_BY_SUFFIX})
    return is_known and path.is_file()


def read(
    path: Path,
    time: object = None,
    *,
    at: Mapping[str, object] | None = None,
    nodata: float | None = None,
) -> pv.DataSet | pv.MultiBlock | None:
    """Return the mesh of a file that PyVista cannot read; None where it is left to PyVista."""
    suffix = path.suffix.lower()
    # GMT's grids are netCDF mostly, and those of other programs rasters.
    if suffix in cf_grids.SUFFIXES or (
        suffix == ".grd" and first_bytes(path, 4)[:3] in (b"CDF", b"\x89HD")
    ):
        return cf_grids.read(path, time, at, nodata)
    if at:
        raise ValueError(f"at: expected a netCDF file beside it, got a {suffix} file; leave it out")
    if nodata is not None and suffix not in georeference.SUFFIXES:
        expected = "expected a netCDF file or a raster beside it"
        raise ValueError(f"nodata: {expected}, got a {suffix} file; leave it out")
    mesh = _of_other(path, time, nodata)
    if mesh is not None and series.TIME not in mesh.field_data:
        series.check_single(path, time)
    return mesh


def _of_other(path: Path, time: object, nodata: float | None) -> pv.DataSet | pv.MultiBlock | None:
    """Return the mesh of a file that is none of netCDF."""
    suffix = path.suffix.lower()
    if suffix in _BY_SUFFIX:
        return _BY_SUFFIX[suffix](path)
    if path.name.lower().endswith((".tt", ".tt.gz")):
        return _polylines(*brains.tracks_of_tt(path), {}, {})
    if path.name.lower().endswith(brains.SURFACES) or brains.is_freesurfer(path):
        return brains.read(path)
    if path.name.lower().endswith(brains.VOLUMES) or brains.is_pair(path):
        return brains.volume(path, time)
    if suffix in georeference.SUFFIXES:
        return georeference.read(path, nodata)
    if suffix == ".mesh" and geomview.is_mesh(path):
        return geomview.read_mesh(path)
    if suffix == ".dem":
        if importlib.util.find_spec("rasterio") is not None:
            # VTK's reader leaves out a row, and says nothing of what is missing.
            return georeference.read(path)
        _refuse_narrow(path)
    if suffix in (".inp", ".msh") and first_bytes(path, _INP_HEAD).lstrip().startswith(b"*"):
        # PyVista takes it for the format of AVS, or of gmsh.
        return abaqus.read(path)
    if PACKAGES.get(suffix, ("",))[0] in ("meshio", "h5py") and missing(path) == "":
        return _of_meshio(path)
    # PyVista has readers for the parallel files of grids, but none for those of surfaces.
    if suffix == ".pvtp":
        reader = vtkXMLPPolyDataReader()
        reader.SetFileName(str(path))
        reader.Update()
        mesh: pv.PolyData = pv.wrap(reader.GetOutput())
        # As its readers do, for arrays of booleans.
        mesh._restore_metadata()
        return mesh
    return None


def first_bytes(path: Path, count: int) -> bytes:
    """Return the first bytes of a file."""
    with path.open("rb") as file:
        return file.read(count)


#: Number of a texture coordinate in a corner of a face, before that of its normal.
_TEXTURE = re.compile(rb"(?<=\d)/-?\d+(/?)")
_OF_TEXTURE = re.compile(rb"[ \t]-?\d+/(\d+)")
#: Lines of faces and lines, and slashes at the end of a corner.
_CORNERS = re.compile(rb"(?m)^[ \t]*[fl][ \t].*")
_SLASHES = re.compile(rb"(?<=\d)/+(?=[ \t\r\n]|\Z)")


#: A curve of the first degree, which is a polyline.
_STRAIGHT = re.compile(rb"(?m)^(cstype\s+bspline\s*\ndeg\s+1\s*\n)curv\s+\S+\s+\S+\s")
_FREE_FORM = re.compile(rb"(?m)^(curv2?|surf)\s")


def has_free_form(path: Path) -> bool:
    """Return whether an OBJ file has curves and surfaces that are not read."""
    return _FREE_FORM.search(_STRAIGHT.sub(b"", path.read_bytes())) is not None


def _wavefront(path: Path) -> pv.DataSet | None:
    """Return the mesh of an OBJ file that VTK's reader does not take as it is, else None.

    It leaves out colours of points and curves of the first degree, ends the process at texture
    coordinates that are missing, and stops at a slash without a number.
    """
    whole = path.read_bytes()
    data = _STRAIGHT.sub(rb"\1l ", whole)
    if _SLASHES.search(data):
        data = _CORNERS.sub(lambda line: _SLASHES.sub(b"", line[0]), data)
    count = len(re.findall(rb"(?m)^[ \t]*vt\s", data))
    corners = b"\n".join(_CORNERS.findall(data)) if count else b""
    most = max(map(int, _OF_TEXTURE.findall(corners)), default=0)
    textured = 0 < count >= most
    if 0 < count < most:
        _check.warn(
            f"file: '{path}': its texture coordinates are left out: a face has number {most} of "
            f"{count}"
        )
    first = _VERTEX.search(data)
    colored = first is not None and len(first[0].split()) == _WITH_COLOR
    if data == whole and not colored and (textured or _TEXTURE.search(data) is None):
        return None
    # What is left of damaged corners may be such numbers, too.
    while not textured and _TEXTURE.search(data):
        data = _TEXTURE.sub(rb"\1\1", data)
    with _supervise.folder(path) as folder:
        draft = folder / "draft.obj"
        draft.write_bytes(data)
        with warnings.catch_warnings():
            # An error says what is wrong, with the name of the file.
            warnings.filterwarnings("ignore", "The VTK reader")
            mesh = pv.read(draft, validate=False)
    if colored and isinstance(mesh, pv.PolyData):
        _attach_colors(mesh, data, path)
    return mesh


#: Lines of points of OBJ, and the words of one with a place and a colour.
_VERTEX = re.compile(rb"(?m)^[ \t]*v[ \t].*")
_WITH_COLOR = 7


def _attach_colors(mesh: pv.PolyData, data: bytes, path: Path) -> None:
    """Attach the colours of the points of an OBJ file, which VTK's reader may have repeated."""
    lines = [line.split()[1:] for line in _VERTEX.findall(data)]
    if any(len(line) != _WITH_COLOR - 1 for line in lines):
        _check.warn(f"file: '{path}' has colours of some points alone, which are left out")
        return
    rows: Array = np.array(lines, dtype=np.float64)
    of_file = place_numbers(rows[:, :3].astype(np.float32))
    of_mesh = place_numbers(np.asarray(mesh.points))
    if np.array_equal(of_file, of_mesh):
        at = np.arange(len(rows))  # points at one place may have colours of their own
    else:
        order = np.argsort(of_file)
        at = order[np.minimum(np.searchsorted(of_file, of_mesh, sorter=order), len(order) - 1)]
    if not np.array_equal(of_file[at], of_mesh):
        _check.warn(f"file: '{path}' has colours of points that are left out")
        return
    colors = rows[at, 3:] * (255 if rows[:, 3:].max() <= 1 else 1)
    mesh.point_data["color"] = np.rint(np.clip(colors, 0, 255)).astype(np.uint8)


#: Words for the arrays of gmsh.
_GMSH = {"gmsh:physical": "Physical group", "gmsh:geometrical": "Geometrical entity"}
#: Header of the elements of gmsh in text.
_ELEMENTS = re.compile(rb"\n\$Elements\r?\n(\d+)(?:[ \t]+(\d+)[ \t]+\d+[ \t]+\d+)?[ \t]*\r?\n")


def _of_meshio(path: Path) -> pv.DataSet:
    """Return a mesh by the first reader of meshio that takes a file.

    ``meshio.read`` prints the messages of its readers, and ends the process. Names of parts are
    left out: gmsh's sets are not of the form that PyVista takes, and their numbers are cell data.
    """
    import meshio

    # The class is replaced for the whole process: meshio makes a console for each message.
    meshio._common.Console, _SAID.texts = _Console, []
    kinds = meshio.extension_to_filetypes.get(path.suffix.lower(), ["med"])
    for kind in kinds:
        reader = getattr(meshio, kind)
        try:
            with warnings.catch_warnings():
                # NumPy warns of lines without numbers, which the reader counts, and of others.
                warnings.simplefilter("ignore")
                warnings.filterwarnings("error", "string or file could not be read to its end")
                data = reader.read(path)
        except (meshio.ReadError, LookupError, ValueError) as error:
            if str(error).startswith("Incompatible cell data"):
                data = _without_data(path, reader)
                break
            # Several formats may have one suffix: only the last of them tells what is wrong.
            if kind == kinds[-1]:
                raise
        else:
            break
    if not data.cells:
        raise ValueError("it has no cells")
    content = path.read_bytes()
    if path.suffix.lower() == ".msh" and (head := _ELEMENTS.search(content)):
        # Before version 4 their number stands alone, and since then between others.
        stated = int(head[2] or head[1])
        file_parts.warn_of_less(path, sum(len(part.data) for part in data.cells), stated, "cells")
    if b"\0" not in content:
        file_parts.warn_of_last_line(path, content)
    data.cell_sets = {}
    _drop_short(data)
    for name in data.point_data.keys() & data.cell_data.keys():
        # A name stands for one array, and those of cells are the materials.
        data.point_data[f"{name} of points"] = data.point_data.pop(name)
    # PyVista adds one axis that is missing, and not two.
    data.points = np.pad(data.points, ((0, 0), (0, max(3 - data.points.shape[1], 0))))
    try:
        mesh = pv.from_meshio(data)
    except KeyError as error:
        raise ValueError(f"it has cells {error.args[0]!r}, which VTK has not") from None
    words = {name: {"long_name": _GMSH[name]} for name in mesh.cell_data if name in _GMSH}
    if words:
        meaning.attach(mesh, meaning.Meaning(arrays=words))
    if _SAID.texts:
        more = f" (the first of {len(_SAID.texts)} warnings)" if len(_SAID.texts) > 1 else ""
        _check.warn(f"file: '{path}': {_SAID.texts[0]}{more}")
    return mesh


#: Values of cells in a file of gmsh, which need not be those of all cells.
_OF_SOME_CELLS = re.compile(rb"(?s)\$(Element(?:Node)?Data)\b.*?\$End\1\s*")


def _without_data(path: Path, reader: Foreign) -> Foreign:
    """Return what meshio reads of a file whose values are those of some cells alone."""
    with _supervise.folder(path) as folder:
        draft = folder / path.name
        draft.write_bytes(_OF_SOME_CELLS.sub(b"", path.read_bytes()))
        data = reader.read(draft)
    _check.warn(f"file: '{path}': its values of some cells alone are left out")
    return data


def _drop_short(data: Foreign) -> None:
    """Leave out arrays without a row for each cell: meshio skips the groups of bars of Nastran."""
    n_cells = sum(len(cells.data) for cells in data.cells)
    for name, rows in [*data.cell_data.items()]:
        if (count := sum(map(len, rows))) != n_cells:
            del data.cell_data[name]
            _check.warn(f"file: {name!r} has {count} rows for {n_cells} cells, and is left out")


#: Messages of meshio, by thread.
_SAID = threading.local()


class _Console:
    """Stands for the console on which meshio prints: its messages are kept, by thread."""

    def __init__(self, **_options: object) -> None:
        pass

    def print(self, text: str, **_options: object) -> None:
        """Keep a text without its marks of style."""
        plain = " ".join(re.sub(r"\[/?[a-z]+\]|Warning:", "", text).split())
        _SAID.texts = [*getattr(_SAID, "texts", ()), plain]


#: Columns of a line of a scan: place, intensity, colour or normal.
_SCAN = (3, 4, 6, 7)
#: Largest difference from 1 of the length of a normal.
_UNIT = 0.02


def _scan(path: Path) -> pv.PolyData:
    """Return the points of a scan: an optional count, and a line for each point, or a molecule.

    VTK's reader loses the first of them, and ends the process where a line has no numbers.
    """
    with path.open(encoding="latin-1") as file:
        head = [*itertools.islice(file, 3)]
        if len(head) == 3 and path.suffix.lower() == ".xyz":
            molecule = molecules.of_xyz([*head, *file], path)
            if molecule is not None:
                return molecule
        file.seek(0)
        first = file.readline().split()
        count = int(first[0]) if len(first) == 1 else None
        if count is None:
            file.seek(0)
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "loadtxt: input contained no data")
            rows = np.loadtxt(file, ndmin=2, comments=("#", "//"))
    if rows.shape[1] not in _SCAN:
        raise ValueError(f"{rows.shape[1]} columns are no places with intensities or colours")
    if count is not None and len(rows) != count:
        raise ValueError(f"{len(rows)} of {count} points are there")
    mesh = pv.PolyData(rows[:, :3].copy())
    if rows.shape[1] == 7 and np.all(rows[:, 6] == 255) and np.ptp(rows[:, 3:6], axis=1).any():
        # Colours with an opacity.
        rows = rows[:, :6]
    if rows.shape[1] in (4, 7):
        mesh.point_data["intensity"] = rows[:, 3]
    if rows.shape[1] > 4:
        _attach_three(mesh, rows[:, -3:], path)
    return mesh


def _attach_three(mesh: pv.PolyData, rows: Array, path: Path) -> None:
    """Attach the last three numbers of points, which are colours or normals by their values."""
    lengths = np.linalg.norm(rows, axis=1)
    if np.all((rows >= 0) & (rows <= 255) & (rows == np.rint(rows))):
        mesh.point_data["color"] = rows.astype(np.uint8)
    elif np.all((np.abs(lengths - 1) < _UNIT) | (lengths == 0)):
        values: Foreign = rows.astype(np.float32)
        mesh.point_data.set_array(values, "Normals")
        mesh.point_data.active_normals_name = "Normals"
    elif np.all((rows >= 0) & (rows <= 1)):
        mesh.point_data["color"] = np.rint(255 * rows).astype(np.uint8)
    else:
        _check.warn(
            f"file: '{path}': the last three columns are left out: they are neither colours from "
            "0 to 255 or from 0 to 1, nor normals of length 1"
        )


def _avs_ucd(path: Path) -> pv.DataSet:
    """Return the mesh of an AVS UCD file, without the comments before its counts."""
    lines = path.read_bytes().splitlines(keepends=True)
    with _supervise.folder(path) as folder:
        draft = folder / "draft.avs"
        draft.write_bytes(b"".join(line for line in lines if not line.startswith(b"#")))
        mesh: pv.DataSet = series.unchecked(pv.AVSucdReader(draft))
    return mesh


def _triangles(path: Path) -> pv.PolyData | None:
    """Return the surface of a .tri file in text, of brains; None for one of marching cubes.

    A number of points stands before these and their normals, and three of triangles before theirs.
    """
    if first_bytes(path, 2) != b"- ":
        return None
    words = path.read_bytes().split()
    n_points = int(words[1])
    end = 2 + 6 * n_points
    rows = np.array(words[2:end], dtype=np.float64).reshape(n_points, 6)
    faces = np.array(words[end + 4 :], dtype=int).reshape(-1, 3)
    # The normals point in or out, by the program, and are left out.
    surface: pv.PolyData = pv.PolyData.from_regular_faces(rows[:, :3].copy(), faces)
    return surface


def _lidar(path: Path) -> pv.PolyData:
    """Return the points of a LAS file with intensity, classification and colours."""
    import laspy

    # Threads that unpacked one file do not live on in the process that tries the next.
    ways = laspy.LazBackend.detect_available()
    alone = [way for way in ways if way is not laspy.LazBackend.LazrsParallel]
    cloud: Foreign = laspy.read(path, laz_backend=alone or None)
    mesh = pv.PolyData(np.asarray(cloud.xyz, dtype=np.float64))
    mesh.point_data["intensity"] = np.asarray(cloud.intensity)
    mesh.point_data["classification"] = np.asarray(cloud.classification)
    names = {*cloud.point_format.dimension_names}
    if {"red", "green", "blue"} <= names:
        colors = np.stack([cloud.red, cloud.green, cloud.blue], axis=1)
        # Colours have 16 bits by the standard, and 8 by many writers.
        depth = 256 if colors.max(initial=0) > 255 else 1
        mesh.point_data["color"] = (colors // depth).astype(np.uint8)
        if np.any(colors):
            # A scan looks like the place that it is of.
            mesh.point_data.active_scalars_name = "color"
    return mesh


def _refuse_narrow(path: Path) -> None:
    """Raise ValueError for an elevation model in which VTK's reader divides by zero."""
    number = first_bytes(path, _DEM_COLUMNS.stop)[_DEM_COLUMNS].strip()
    if not number.isdigit() or int(number) < _DEM_LEAST:
        got = ascii(number.decode("latin-1"))
        raise ValueError(f"{got} columns in the header, VTK reads {_DEM_LEAST} or more")


def _tracts(path: Path) -> pv.PolyData:
    import nibabel

    # nibabel applies the affine of the header: points are in RAS+ and in mm, not in voxels.
    with np.errstate(all="ignore"), warnings.catch_warnings(record=True) as said:
        file: Foreign = nibabel.streamlines.load(path)
    tracts = file.tractogram
    lines = tracts.streamlines
    if len(lines) and not np.isfinite(lines.get_data()).any():
        raise ValueError("no point is finite, by the affine of its header")
    for warning in said:
        _check.warn(f"file: '{path}': {warning.message}")
    if path.suffix.lower() == ".trk":
        # The header as it is in the file; nibabel takes a cut between two streamlines for the end.
        header = nibabel.streamlines.load(path, lazy_load=True).header
        if len(lines) < header["nb_streamlines"]:
            raise ValueError(f"{len(lines)} of {header['nb_streamlines']} streamlines are there")
        # A number of 4 bytes for each line, place, scalar of a point and property of a line.
        of_point = 3 + int(header["nb_scalars_per_point"])
        of_line = 1 + int(header["nb_properties_per_streamline"])
        numbers = of_line * len(lines) + of_point * len(lines.get_data())
        size = path.stat().st_size - int(header["hdr_size"]) - 4 * numbers
        file_parts.warn_of_more(path, size, "bytes")
    else:
        file_parts.warn_of_less(path, len(lines), int(file.header.get("count", 0)), "streamlines")
    return _polylines(
        lines.get_data(),
        lines._offsets,
        lines._lengths,
        {name: rows.get_data() for name, rows in tracts.data_per_point.items()},
        dict(tracts.data_per_streamline.items()),
    )


def _tracts_of_trx(path: Path) -> pv.PolyData:
    from trx import trx_file_memmap

    try:
        return _of_trx(trx_file_memmap.load(str(path)))
    except Exception as error:
        # The lines may be whole where data beside them are not: they are read alone from a copy.
        with _supervise.folder(path) as folder:
            bare, left = folder / "bare.trx", []
            with zipfile.ZipFile(path) as whole, zipfile.ZipFile(bare, "w") as part:
                for name in whole.namelist():
                    if name.partition("/")[0] in _SIDE:
                        left.append(name)
                    else:
                        part.writestr(name, whole.read(name))
            # Nothing was left out, so the lines themselves are at fault.
            if not left:
                raise
            lines = _of_trx(trx_file_memmap.load(str(bare)))
        _check.warn(
            f"file: '{path}' has data beside its lines that cannot be read ({error}), which are "
            f"left out: {', '.join(left)}"
        )
        return lines


#: Folders of a .trx file with data beside its lines.
_SIDE = ("dps", "dpv", "dpg", "groups")


def _of_trx(tracts: Foreign) -> pv.PolyData:
    """Return the lines of a .trx file, and close it."""
    try:
        lines = tracts.streamlines
        of_lines = dict(tracts.data_per_streamline)
        for name, members in tracts.groups.items():
            # A line may be in several groups, so each group is a mask of its own.
            of_lines[name] = np.isin(np.arange(len(lines)), members).astype(np.uint8)
        return _polylines(
            lines._data,
            lines._offsets,
            lines._lengths,
            {name: rows._data for name, rows in tracts.data_per_vertex.items()},
            of_lines,
        )
    finally:
        # Packed files lie in a temporary folder until then; the mesh has copies.
        tracts.close()


def _polylines(
    points: Array,
    starts: Indices,
    lengths: Indices,
    of_points: Mapping[str, Raw],
    of_lines: Mapping[str, Raw],
) -> pv.PolyData:
    """Return a mesh with one polyline for each line that has points; arrays are copied."""
    lengths = np.asarray(lengths, dtype=np.intp)
    starts = np.asarray(starts, dtype=np.intp)[lengths > 0]
    ends = np.concatenate([[0], np.cumsum(lengths[lengths > 0])])
    # Lines need not follow one another in the file: each is gathered from where it begins.
    rows = np.arange(ends[-1]) + np.repeat(starts - ends[:-1], np.diff(ends))
    if not len(rows):
        return pv.PolyData()
    # Half precision, which TRX files have, is none of VTK's types.
    kind = np.result_type(points.dtype, np.float32)
    mesh = polylines.polydata(np.asarray(points[rows], dtype=kind), ends)
    odd = []
    for data, arrays, kept, count in (
        (mesh.point_data, of_points, rows, len(points)),
        (mesh.cell_data, of_lines, np.flatnonzero(lengths > 0), len(lengths)),
    ):
        for name, values in arrays.items():
            array = np.asarray(values)
            if len(array) == count and array.dtype.kind in "biuf":
                _attach(data, name, array[kept])
            else:
                odd.append(f"{name!r} ({len(array)} rows of {array.dtype} for {count})")
    if odd:
        _check.warn(f"file: data beside the lines are left out: {', '.join(odd)}")
    # By the header of the file, in mm.
    meaning.attach(mesh, meaning.Meaning(axes=[*meaning.ANATOMY]))
    return mesh


def _attach(data: pv.DataSetAttributes, name: object, array: Raw) -> None:
    """Attach numbers as rows; rows of one component become flat."""
    # Files may have the bytes in the order of another machine, which VTK does not take.
    native = np.float32 if array.dtype == np.float16 else array.dtype.newbyteorder("=")
    rows = array.reshape(len(array), -1)
    data[str(name)] = np.array(rows[:, 0] if rows.shape[1] == 1 else rows, dtype=native)


#: Readers that need the path alone, by suffix.
_BY_SUFFIX: Mapping[str, Callable[[Path], pv.DataSet | pv.MultiBlock | None]] = {
    ".trk": _tracts, ".tck": _tracts, ".trx": _tracts_of_trx, ".pts": _scan, ".xyz": _scan,
    ".las": _lidar, ".laz": _lidar, ".pcd": point_clouds.read,
    ".obj": _wavefront, ".off": geomview.read_off,
    ".pdb": molecules.of_pdb, ".ent": molecules.of_pdb,
    **dict.fromkeys(CIF, molecules.of_cif), ".lammpstrj": lammps.read, ".dump": lammps.read,
    ".gro": molecule_files.of_gro, ".mol2": molecule_files.of_mol2,
    ".mol": molecule_files.of_mol, ".sdf": molecule_files.of_mol,
    ".cube": cubes.read, ".dx": cubes.read_dx, ".ply": ply.read, ".su2": su2.read,
    ".ucd": _avs_ucd,
    ".swc": neurons.read, ".tri": _triangles,
    **dict.fromkeys(density_maps.SUFFIXES, density_maps.read),
    ".3ds": studio_3ds.read, ".dae": xml_scenes.read_collada, ".3mf": xml_scenes.read_3mf,
    **dict.fromkeys(scene_files.SUFFIXES, scene_files.read),
    **dict.fromkeys((".nhdr", ".nrrd"), scans.read_nrrd), ".dcm": dicom.read,
    **dict.fromkeys((".mha", ".mhd"), scans.read_meta),
    **dict.fromkeys(seismic.SUFFIXES, seismic.read),
    **dict.fromkeys(tables.SUFFIXES, tables.read),
    **dict.fromkeys(tetgen.SUFFIXES, tetgen.read),
}  # fmt: skip
