"""Point arrays of a mesh, and records of how they were made: attached, read and checked."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import cast

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkStringArray

from vizlight import _check
from vizlight._types import AnyArray, Foreign, Indices, Keywords, Raw, Slice
from vizlight._version import __version__
from vizlight.mesh import blocks
from vizlight.mesh.blocks import DataSetT
from vizlight.shading.results import Record, digest, plain, record_key
from vizlight.vtk import hull
from vizlight.vtk.arrays import is_of_cells, means
from vizlight.vtk.cells import (
    as_numpy,
    as_vtk,
    cell_arrays,
    cell_data,
    field_data,
    places,
    point_data,
)

#: In place of a digest of arrays of a piece, which stay vizlight's own where pieces are joined.
ANY = "any"


def attach(
    mesh: pv.DataSet, name: str, arrays: Mapping[str, Raw], record: Record, common: str = ""
) -> None:
    """Attach point arrays in place of earlier ones of a name, and activate the one of that name."""
    # Those that the new result does not have go, too: old colours beside new light would mislead.
    for stale in made(mesh, name):
        # PyVista's own way forgets in other copies, too, that an array is one of flags.
        point_data(mesh).RemoveArray(stale)
    for key, array in arrays.items():
        attach_rows(mesh, key, array)
    activate(mesh, name)
    write(mesh, name, record, arrays, common)


def write(
    mesh: pv.DataSet, name: str, record: Record, arrays: Iterable[str] = (), common: str = ""
) -> None:
    """Attach the record of an array, with digests of the point arrays that it describes.

    ``arrays`` has their names; a dict also has their rows, or None for :data:`ANY`. ``common``
    is the JSON text of other entries, which many records have in common.
    """
    if not isinstance(arrays, dict):
        data = point_data(mesh)
        # A caller that has the rows at hand passes a dict, and they are not read back from VTK.
        arrays = {key: as_numpy(data.GetAbstractArray(key)) for key in arrays}
    # VTK has no columns of width 1.
    digests = {
        key: ANY if rows is None else digest(rows[:, 0] if rows.shape[1:] == (1,) else rows)
        for key, rows in sorted(arrays.items())
    }
    text = json.dumps(record | {"arrays": digests})
    attached = vtkStringArray()
    attached.SetName(record_key(name))
    # Two JSON objects become one where the first loses its last brace and the second its first.
    attached.InsertNextValue(f"{common[:-1]}, {text[1:]}" if common else text)
    field_data(mesh).AddArray(attached)


def read(mesh: pv.DataSet, name: str) -> Keywords | None:
    """Return the record of an array, or None if the mesh has none that vizlight can have written.

    The record may come from a file of unknown origin: its form is checked, and nothing in it is
    taken for true that the mesh itself does not confirm.
    """
    if not field_data(mesh).HasArray(record_key(name)):
        return None
    try:
        record = json.loads(str(mesh.field_data[record_key(name)][0]))
    # Deep brackets in a damaged file end Python's reader of JSON by a RecursionError.
    except (KeyError, IndexError, ValueError, RecursionError):
        return None
    return record if _is_record(record) else None


#: Type of each entry of a record; every one has the first three.
_ENTRIES = {"vizlight": str, "filter": str, "arrays": dict, "options": dict, "scene": dict}


def _is_record(record: object) -> bool:
    """Return whether a value read from JSON has the form of a record."""
    if not isinstance(record, dict):
        return False
    # These two are missing in records of what is kept, such as normals.
    whole: Keywords = {"options": {}, "scene": {}} | record
    if not all(isinstance(whole.get(name), kind) for name, kind in _ENTRIES.items()):
        return False
    return all(isinstance(made_as, str) for made_as in record["arrays"].values())


def fingerprint(mesh: pv.DataSet) -> str | None:
    """Return a digest of the points and cells of a mesh, None for a kind that keeps no rows."""
    if not isinstance(mesh, pv.PolyData | pv.UnstructuredGrid):
        return None
    # A quadrilateral and a tetrahedron have the same connectivity: the types tell them apart.
    arrays = [places(mesh), np.array(sorted(hull.cell_types(mesh)))]
    for cells in cell_arrays(mesh):
        arrays += [as_numpy(cells.GetConnectivityArray()), as_numpy(cells.GetOffsetsArray())]
    return source(*arrays)


def source(*arrays: Raw) -> str:
    """Return a digest of arrays from which others are computed."""
    # Equal bytes of another type are other numbers.
    return " ".join(f"{array.dtype.str}{digest(array)}" for array in arrays)


def keep(mesh: pv.DataSet, name: str, filter_name: str, rows: Raw, **facts: object) -> None:
    """Attach rows of points, with a digest of the points and cells that they are computed from.

    Where the user has an array of that name nothing is attached.
    """
    mesh_digest = fingerprint(mesh)
    if mesh_digest is None or (point_data(mesh).HasArray(name) and name not in made(mesh, name)):
        return
    attach_rows(mesh, name, rows)
    record = {"vizlight": __version__, "filter": filter_name, "source": mesh_digest} | facts
    write(mesh, name, record, {name: rows})


def kept(mesh: pv.DataSet, name: str, width: int) -> tuple[AnyArray, Record] | None:
    """Return rows that were kept of points, and their record, if the mesh has not changed since."""
    record = read(mesh, name) if point_data(mesh).HasArray(name) else None
    if record is None or name not in made(mesh, name):
        return None
    rows = np.asarray(mesh.point_data[name])
    # Moved points or other cells: the rows are of another mesh.
    if rows.shape != (mesh.n_points, width) or record.get("source") != fingerprint(mesh):
        return None
    return rows, record


def share(record: Mapping[str, object], name: str) -> float:
    """Return a number from 0 to 1 in a record, 0 for anything else."""
    value = record.get(name)
    return float(value) if isinstance(value, int | float) and 0 <= value <= 1 else 0.0


def count(record: Mapping[str, object], name: str, most: int) -> int:
    """Return an integer from 0 to ``most`` in a record, 0 for anything else."""
    value = record.get(name)
    return value if isinstance(value, int) and 0 <= value <= most else 0


def made(mesh: pv.DataSet, name: str) -> set[str]:
    """Return the names of the point arrays attached under a name that are unchanged since.

    Those of pieces count even if they were changed.
    """
    claimed: dict[str, str] = (read(mesh, name) or {}).get("arrays", {})
    data = point_data(mesh)
    # An array that was edited since has another digest, and is the user's.
    return {
        key
        for key, made_as in claimed.items()
        if data.HasArray(key)
        and (made_as == ANY or digest(as_numpy(data.GetAbstractArray(key))) == made_as)
    }


def all_made(mesh: pv.DataSet) -> set[str]:
    """Return the names of all point arrays that vizlight attached to a mesh."""
    return set().union(*(made(mesh, name) for name in _names(mesh)))


def _names(mesh: pv.DataSet) -> list[str]:
    """Return the names of the arrays of which a mesh has records."""
    fields = getattr(mesh, "field_data", ())
    return [name.removesuffix(record_key("")) for name in fields if name.endswith(record_key(""))]


def carry(mesh: pv.DataSet, derived: pv.DataSet) -> None:
    """Let the records of a mesh hold for one that vizlight derived from it, with other points."""
    for name in _names(mesh):
        record = read(derived, name)
        if record is not None:
            # The source of the record is not the derived mesh.
            record.pop("source", None)
            # Whose an array is shows on the mesh, which has the values of the digests; then they
            # are anew.
            write(derived, name, record, made(mesh, name) & set(derived.point_data))


def refuse_overwriting(
    named: Iterable[tuple[pv.DataSet, str]], name: str, arrays: Iterable[str]
) -> None:
    """Raise ValueError if a point array that vizlight did not make would be replaced."""
    for mesh, _ in named:
        data = point_data(mesh)
        there = [array for array in arrays if data.HasArray(array)]
        ours = made(mesh, name) if there else ()
        for array in there:
            if array not in ours:
                expected = "one under which the mesh has no array of its own"
                # An array by vizlight that was edited later is the user's own, as the message says.
                edited = array in (read(mesh, name) or {}).get("arrays", {})
                got = repr(array) + ", changed since it was computed" * edited
                remedy = "pass another name=, rename that array or delete it"
                raise _check.value_error("name", expected, got, remedy)


def amend(mesh: pv.DataSet, name: str, filter_name: str, *options: object) -> None:
    """Replace the filter and the options in the record of an array; options are merged."""
    merged = {key: value for each in options for key, value in plain(each).items()}
    # Filters that light by illuminate take its place in the record, with their own options.
    record = (read(mesh, name) or {}) | {"filter": filter_name, "options": merged}
    write(mesh, name, record, made(mesh, name))


def provenance(mesh: pv.DataSet | pv.MultiBlock, /, name: str = "luminance") -> Keywords:
    """Return the record of a point array: filter, scene, options, terms, precision, version.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh that a filter of vizlight returned, or one read from a file of such a mesh.
    name : str, default: "luminance"
        Name of the point array.

    Returns
    -------
    dict
        Record, in the form that vizlight writes; it is as reliable as the file that it comes from.
        ``p["filter"]`` names the filter, which reproduces the array from the original mesh:
        ``illuminate(mesh, Scene.from_dict(p["scene"]), **p["options"])``; ``project`` takes the
        scene by ``scene=``, ``relief_day`` takes none. Meshes and arrays of more than 100 numbers
        among the options are replaced by a description. ``p["arrays"]`` holds a digest of each
        array that was attached, or "any" of pieces, which may be joined; only arrays that still
        have it are replaced by new light.

    Raises
    ------
    TypeError
        If it is not a mesh.
    ValueError
        If the mesh has no record of such an array.
    """
    if not isinstance(mesh, pv.DataSet | pv.MultiBlock):
        raise TypeError(_check.message("mesh", "a PyVista mesh", type(mesh).__name__))
    _check.instance("name", name, str, "the name of an array")
    names = set()
    for block in blocks.all_blocks(mesh):
        # VTK takes no name with half of a surrogate pair.
        if name in _names(block) and (record := read(block, name)) is not None:
            # Blocks that were lit together have scene and options in common: one record stands for
            # all.
            return record
        names |= {key for key in _names(block) if read(block, key) is not None}
    if not names:
        remedy = "light it first, or read it from a file format that keeps field data"
        raise _check.value_error("mesh", "one with an array by vizlight", "none", remedy)
    raise _check.value_error("name", f"one of the arrays by vizlight, {sorted(names)}", repr(name))


#: Number of values below which an array is sooner copied than shared.
_SMALL = 1 << 12


def refuse_unnamed(name: str, value: object) -> None:
    """Raise TypeError for anything but a name of an array or None."""
    expected, remedy = "the name of a point array", "attach the array to the mesh and pass its name"
    _check.instance(name, value, str | None, expected, remedy=remedy)
    if value is not None:
        _check.text(name, value, expected=expected)


def averaged(mesh: DataSetT, *names: object) -> DataSetT:
    """Return a mesh with cell arrays averaged to its points, where no point array has the name.

    Anything but a name is ignored. The mesh is not changed: a copy shares its arrays and has the
    means too.
    """
    wanted = [name for name in names if isinstance(name, str) and is_of_cells(mesh, name)]
    if not wanted:
        return mesh
    out = mesh.copy(deep=False)
    for name in wanted:
        out.point_data[name] = means(mesh, np.asarray(mesh.cell_data[name]))
    return out


def scalars_of(mesh: pv.DataSet, argument: str, name: object) -> AnyArray:
    """Return a point array of one component, or raise an error that names the argument."""
    data = mesh.point_data
    names = [key for key in data if data[key].ndim == 1]
    if name not in names:
        expected = f"a point array of one component, {_check.one_of(names)}"
        raise _check.value_error(argument, expected, repr(name))
    return np.asarray(data[str(name)])


def attach_rows(mesh: pv.DataSet, name: str, array: Raw) -> None:
    """Attach a point array; a part of a larger array is copied."""
    if array.dtype in (np.float32, np.float64) or not len(array):
        # By VTK itself: PyVista's way takes longer than the light of a small mesh, and refuses an
        # array without rows.
        part = getattr(array.base, "nbytes", 0) > array.nbytes
        # A part that is shared would keep the whole of the larger array in memory.
        copied = part or array.size < _SMALL
        attached = as_vtk(array, name) if copied else pv.convert_array(array, name)
        point_data(mesh).AddArray(attached)
    elif array.dtype == np.bool_:
        # Without the search for active scalars that assignment adds.
        mesh.point_data.set_array(cast("Foreign", array), name)
    else:
        mesh.point_data[name] = array


def activate(mesh: pv.DataSet, name: str) -> None:
    """Make a point array the active scalars of a mesh, even if a cell array was active."""
    point_data(mesh).SetActiveScalars(name)
    # PyVista's search takes longer than that by VTK, and finds no other where no cells are active.
    if (
        cell_data(mesh).GetScalars() is not None
        and mesh.GetNumberOfPoints()
        and mesh.active_scalars_info.association != pv.FieldAssociation.POINT
    ):
        mesh.set_active_scalars(name, preference="point")


def carry_rows(
    mesh: pv.DataSet, derived: pv.DataSet, points: Indices, cells: Indices | Slice = slice(None)
) -> None:
    """Give a mesh that is made of some points and cells of another all arrays of these."""
    for name, array in mesh.point_data.items():
        attach_rows(derived, name, np.asarray(array)[points])
    for name, array in mesh.cell_data.items():
        derived.cell_data[name] = np.asarray(array)[cells]
    # VTK marks active arrays in the data of the points, and copies of rows are without marks.
    carry_active(mesh, derived)
    derived.GetFieldData().DeepCopy(mesh.GetFieldData())


def carry_active(mesh: pv.DataSet, derived: pv.DataSet) -> None:
    """Make the arrays that are active at the points of a mesh active on one with the same names."""
    for attribute in ("Normals", "Vectors", "Scalars", "Tangents", "TCoords"):
        active = getattr(point_data(mesh), f"Get{attribute}")()
        if active is not None:
            getattr(point_data(derived), f"SetActive{attribute}")(active.GetName())
