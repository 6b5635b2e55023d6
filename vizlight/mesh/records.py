"""Records of how arrays were made, kept as field data, so that a saved file can be reproduced."""

from __future__ import annotations

import dataclasses
import json
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
        if stale in mesh.point_data:
            del mesh.point_data[stale]
    for own, array in arrays.items():
        point_arrays.attach_rows(mesh, own, array)
    point_arrays.activate(mesh, name)
    write(mesh, name, record | {"arrays": list(arrays)})


def write(mesh: pv.DataSet, name: str, record: Record) -> None:
    """Attach the record of an array."""
    mesh.field_data[key(name)] = [json.dumps(record)]


def read(mesh: pv.DataSet, name: str) -> dict[str, Any] | None:
    """Return the record of an array, or None if the mesh has none."""
    if key(name) not in mesh.field_data:
        return None
    record: dict[str, Any] = json.loads(str(mesh.field_data[key(name)][0]))
    return record


def made(mesh: pv.DataSet, name: str) -> set[str]:
    """Return the names of the point arrays that were attached under a name."""
    return set((read(mesh, name) or {}).get("arrays", ()))


def all_made(mesh: pv.DataSet) -> set[str]:
    """Return the names of all point arrays that vizlight attached to a mesh."""
    names = [name.removesuffix(key("")) for name in getattr(mesh, "field_data", ())]
    return set().union(*(made(mesh, name) for name in names))


def refuse_overwriting(
    named: Iterable[tuple[pv.DataSet, str]], name: str, arrays: Iterable[str]
) -> None:
    """Raise ValueError if a point array that vizlight did not make would be replaced."""
    for mesh, _ in named:
        ours = made(mesh, name)
        for array in arrays:
            if array in mesh.point_data and array not in ours:
                expected = "one under which the mesh has no array of its own"
                remedy = "pass another name= or rename that array"
                raise ValueError(_check.message("name", expected, repr(array), remedy))


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
    write(mesh, name, (read(mesh, name) or {}) | {"filter": filter_name, "options": own})


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
        ``p["filter"]`` names the filter, which reproduces the array from the original mesh:
        ``illuminate(mesh, Scene.from_dict(p["scene"]), **p["options"])``; ``project`` takes the
        scene by ``scene=``, ``relief_day`` takes none. Meshes and arrays of more than 100 numbers
        among the options are replaced by a description.

    Raises
    ------
    TypeError
        If it is not a mesh.
    ValueError
        If the mesh has no record of such an array.
    """
    if not isinstance(mesh, pv.DataSet | pv.MultiBlock):
        raise TypeError(_check.message("mesh", "a PyVista mesh", type(mesh).__name__))
    known = set()
    for block in blocks.all_blocks(mesh):
        if (found := read(block, name)) is not None:
            return found
        known |= {k.removesuffix(key("")) for k in block.field_data if k.endswith(key(""))}
    if not known:
        remedy = "light it first, or read it from a file format that keeps field data"
        raise ValueError(_check.message("mesh", "one with an array by vizlight", "none", remedy))
    raise ValueError(
        _check.message("name", f"one of the arrays by vizlight, {sorted(known)}", repr(name))
    )
