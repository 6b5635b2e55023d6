"""Records of how arrays were made, kept as field data, so that a saved file can be reproduced."""

from __future__ import annotations

import dataclasses
import json
import math
import zlib
from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._version import __version__
from vizlight.mesh import blocks, point_arrays

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from vizlight.scene import Scene
    from vizlight.shading.engine import Shading

#: What JSON holds: the scene, the options and facts about the result.
Record: TypeAlias = dict[str, object]

#: Largest number of values of an array that is written out in full.
WRITTEN_OUT = 100


def key(name: str) -> str:
    """Return the name of the field array that holds the record of a point array."""
    return f"{name}_provenance"


def attach(
    mesh: pv.DataSet, name: str, arrays: Mapping[str, NDArray[np.generic]], record: Record
) -> None:
    """Attach point arrays in place of earlier ones of a name, and activate the one of that name."""
    for stale in made(mesh, name):
        del mesh.point_data[stale]
    for own, array in arrays.items():
        point_arrays.attach_rows(mesh, own, array)
    point_arrays.activate(mesh, name)
    write(mesh, name, record, arrays)


def write(mesh: pv.DataSet, name: str, record: Record, arrays: Iterable[str] = ()) -> None:
    """Attach the record of an array, with digests of the point arrays that it tells of."""
    digests = {own: digest(mesh.point_data[own]) for own in sorted(arrays)}
    mesh.field_data[key(name)] = [json.dumps(record | {"arrays": digests})]


def digest(array: NDArray[np.generic]) -> str:
    """Return a digest of the shape and the bytes of an array."""
    rows = np.ascontiguousarray(array)
    return f"{'x'.join(str(n) for n in rows.shape)}:{zlib.crc32(rows.view(np.uint8).data):08x}"


def read(mesh: pv.DataSet, name: str) -> dict[str, Any] | None:
    """Return the record of an array, or None if the mesh has none that vizlight can have written.

    The record may come from a file of unknown origin: its form is checked, and nothing in it is
    taken for true that the mesh itself does not confirm.
    """
    try:
        record = json.loads(str(mesh.field_data[key(name)][0]))
    except (KeyError, IndexError, ValueError, RecursionError):
        return None
    return record if _is_record(record) else None


#: Type of each entry that every record has.
_ENTRIES = {"vizlight": str, "filter": str, "arrays": dict}


def _is_record(record: object) -> bool:
    """Return whether a value read from JSON has the form of a record."""
    if not isinstance(record, dict):
        return False
    if not all(isinstance(record.get(name), kind) for name, kind in _ENTRIES.items()):
        return False
    if not all(isinstance(record.get(name, {}), dict) for name in ("options", "scene")):
        return False
    return all(isinstance(made_as, str) for made_as in record["arrays"].values())


def share(record: Mapping[str, object], name: str) -> float:
    """Return a number from 0 to 1 in a record, 0 for anything else."""
    value = record.get(name)
    known = isinstance(value, int | float) and math.isfinite(value) and 0 <= value <= 1
    return float(value) if known and isinstance(value, int | float) else 0.0


def count(record: Mapping[str, object], name: str, most: int) -> int:
    """Return an integer from 0 to ``most`` in a record, 0 for anything else."""
    value = record.get(name)
    return value if isinstance(value, int) and 0 <= value <= most else 0


def made(mesh: pv.DataSet, name: str) -> set[str]:
    """Return the names of the point arrays attached under a name that are unchanged since."""
    claimed: dict[str, str] = (read(mesh, name) or {}).get("arrays", {})
    return {
        own
        for own, made_as in claimed.items()
        if own in mesh.point_data and digest(mesh.point_data[own]) == made_as
    }


def all_made(mesh: pv.DataSet) -> set[str]:
    """Return the names of all point arrays that vizlight attached to a mesh."""
    return set().union(*(made(mesh, name) for name in _names(mesh)))


def _names(mesh: pv.DataSet) -> list[str]:
    """Return the names of the arrays of which a mesh has records."""
    fields = getattr(mesh, "field_data", ())
    return [name.removesuffix(key("")) for name in fields if name.endswith(key(""))]


def carry(mesh: pv.DataSet, derived: pv.DataSet) -> None:
    """Let the records of a mesh hold for one that vizlight derived from it, with other points."""
    for name in _names(mesh):
        record = read(derived, name)
        if record is not None:
            write(derived, name, record, made(mesh, name) & set(derived.point_data))


def refuse_overwriting(
    named: Iterable[tuple[pv.DataSet, str]], name: str, arrays: Iterable[str]
) -> None:
    """Raise ValueError if a point array that vizlight did not make would be replaced."""
    for mesh, _ in named:
        ours = made(mesh, name)
        for array in arrays:
            if array in mesh.point_data and array not in ours:
                expected = "one under which the mesh has no array of its own"
                known = array in (read(mesh, name) or {}).get("arrays", {})
                got = repr(array) + ", changed since it was computed" * known
                remedy = "pass another name=, rename that array or delete it"
                raise ValueError(_check.message("name", expected, got, remedy))


def of_light(shading: Shading, filter_name: str, scene: Scene, options: object) -> Record:
    """Return the record of light that the engine computed."""
    plan = shading.plan
    return of_filter(
        filter_name, scene, options,
        precision=plan.dtype.name,
        terms=list(plan.terms),
        exponent=plan.exponent,
        highlight_error=plan.highlight_error,
        error_bound=plan.choice.bound if np.isfinite(plan.choice.bound) else None,
        points=int(shading.luminance.size),
        invalid=shading.invalid,
    )  # fmt: skip


def of_filter(filter_name: str, scene: Scene, options: object, **facts: object) -> Record:
    """Return the record of an array that a filter computed."""
    return {
        "vizlight": __version__,
        "filter": filter_name,
        **facts,
        "options": plain(options),
        "scene": scene.to_dict(),
    }


def amend(mesh: pv.DataSet, name: str, filter_name: str, *options: object) -> None:
    """Replace the filter and the options in the record of an array; options are merged."""
    own = {key: value for each in options for key, value in plain(each).items()}
    record = (read(mesh, name) or {}) | {"filter": filter_name, "options": own}
    write(mesh, name, record, made(mesh, name))


def plain(options: object) -> Record:
    """Return options, a dataclass or a dict, as values that JSON can hold."""
    if not isinstance(options, Mapping):
        names = [field.name for field in dataclasses.fields(options)]  # type: ignore[arg-type]
        options = {name: getattr(options, name) for name in names}
    return {str(name): _plain(value) for name, value in options.items()}


def _plain(value: object) -> object:
    """Return a value that JSON can hold, with a description of a mesh or a long array."""
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if isinstance(value, pv.DataObject):
        return f"{type(value).__name__} of {getattr(value, 'n_points', 0)} points"
    if isinstance(value, Fraction):
        return float(value)
    if isinstance(value, list | tuple) and len(value) <= WRITTEN_OUT:
        return [_plain(part) for part in value]
    if dataclasses.is_dataclass(value):
        return plain(value)
    array: NDArray[np.generic] = np.asarray(value)
    if array.size <= WRITTEN_OUT and array.dtype.kind in "biufU":
        # JSON holds at most the digits of float64.
        return (array.astype(np.float64) if array.dtype.kind == "f" else array).tolist()
    return _check.describe(array)


def provenance(mesh: pv.DataSet | pv.MultiBlock, /, name: str = "luminance") -> dict[str, Any]:
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
        Record, in the form that vizlight writes; what it says is as reliable as the file that it
        comes from. ``p["filter"]`` names the filter, which reproduces the array from the original
        mesh: ``illuminate(mesh, Scene.from_dict(p["scene"]), **p["options"])``; ``project`` takes
        the scene by ``scene=``, ``relief_day`` takes none. Meshes and arrays of more than 100
        numbers among the options are replaced by a description. ``p["arrays"]`` holds a digest of
        each array that was attached; only arrays that still have it are replaced by new light.

    Raises
    ------
    TypeError
        If it is not a mesh.
    ValueError
        If the mesh has no record of such an array.
    """
    if not isinstance(mesh, pv.DataSet | pv.MultiBlock):
        raise TypeError(_check.message("mesh", "a PyVista mesh", type(mesh).__name__))
    if not isinstance(name, str):
        raise TypeError(_check.message("name", "the name of an array", _check.describe(name)))
    known = set()
    for block in blocks.all_blocks(mesh):
        if (found := read(block, name)) is not None:
            return found
        known |= {own for own in _names(block) if read(block, own) is not None}
    if not known:
        remedy = "light it first, or read it from a file format that keeps field data"
        raise ValueError(_check.message("mesh", "one with an array by vizlight", "none", remedy))
    raise ValueError(
        _check.message("name", f"one of the arrays by vizlight, {sorted(known)}", repr(name))
    )
