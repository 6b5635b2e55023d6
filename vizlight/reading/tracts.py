"""Tractograms: streamlines of fibres of a brain, and the data beside them."""

from __future__ import annotations

import warnings
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight import _check, _supervise
from vizlight._types import Array, Foreign, Indices, Raw
from vizlight.mesh import meaning, polylines
from vizlight.mesh.georeference import UNIT
from vizlight.reading import brains, file_parts


def read(path: Path) -> pv.PolyData:
    """Return the streamlines of a file of TrackVis or MRtrix, by nibabel."""
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


def read_trx(path: Path) -> pv.PolyData:
    """Return the streamlines of a TRX file, by trx-python."""
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


#: Array of the group of each line, and the name of that of lines in none.
GROUP, NO_GROUP = "group", "none"
#: Folders of a .trx file with data beside its lines.
_SIDE = ("dps", "dpv", "dpg", "groups")


def _of_trx(tracts: Foreign) -> pv.PolyData:
    """Return the lines of a .trx file, and close it."""
    try:
        lines = tracts.streamlines
        of_lines = dict(tracts.data_per_streamline)
        masks = {
            str(name): np.isin(np.arange(len(lines)), members).astype(np.uint8)
            for name, members in sorted(tracts.groups.items())
        }
        names: list[str] = []
        # Each group is a mask of its own where a line is in several.
        if len(masks) > 1 and np.sum([*masks.values()], axis=0).max() <= 1:
            names = [NO_GROUP, *masks]
            masks = {GROUP: np.sum([k * mask for k, mask in enumerate(masks.values(), 1)], axis=0)}
        of_lines |= masks
        mesh = _polylines(
            lines._data,
            lines._offsets,
            lines._lengths,
            {name: rows._data for name, rows in tracts.data_per_vertex.items()},
            of_lines,
        )
        if names and GROUP in mesh.cell_data:
            said = meaning.of(mesh)
            said.add_kinds(GROUP, [(number, name, ()) for number, name in enumerate(names)])
            meaning.attach(mesh, said)
        return mesh
    finally:
        # Packed files lie in a temporary folder until then; the mesh has copies.
        tracts.close()


def read_tt(path: Path) -> pv.PolyData:
    """Return the tracks of a file of DSI Studio."""
    return _polylines(*brains.tracks_of_tt(path), {}, {})


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
    # By the header of the file.
    mesh.field_data[UNIT] = ["millimetre"]
    return meaning.attach(mesh, meaning.Meaning(axes=[*meaning.ANATOMY]))


def _attach(data: pv.DataSetAttributes, name: object, array: Raw) -> None:
    """Attach numbers as rows; rows of one component become flat."""
    # Files may have the bytes in the order of another machine, which VTK does not take.
    native = np.float32 if array.dtype == np.float16 else array.dtype.newbyteorder("=")
    rows = array.reshape(len(array), -1)
    data[str(name)] = np.array(rows[:, 0] if rows.shape[1] == 1 else rows, dtype=native)
