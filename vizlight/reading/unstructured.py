"""Meshes of netCDF files: nodes and a table of the nodes of each face, by UGRID or by custom.

VTK's reader of UGRID is not used: tables of floating-point numbers, which xarray writes, can end
the process, faces of more than four nodes become triangles, and packed values stay packed.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from vizlight._types import Array, Bools, Foreign
from vizlight.mesh import unrolled

#: Numbers of nodes of a face that a table of a file without names may have.
_CORNERS = range(3, 17)
#: Names of dimensions of the corners of a face.
_OF_CORNERS = re.compile(
    r"three|four|max_?\w*|\w*(vert|corner|per_?(face|cell|el))\w*", re.IGNORECASE
)
#: Names of tables of the nodes of faces, among others of such files.
_TABLES = re.compile(
    r"(.*[_\W])?(ele(m|ms|ments?)?|tri(s|angles?)?|quads?|polygons?|faces?|cells?|nv|ien|ikle\w*"
    r"|connect\w*|topology)([_\W].*)?"
    r"|.*(node|vert|corner).*",
    re.IGNORECASE,
)
#: Names of tables of the nodes of solids.
_SOLIDS = re.compile(
    r"(.*[_\W])?(tet(s|ras?|rahedra)|hexa(s|hedra)?|prisms?|wedges?)", re.IGNORECASE
)


@dataclass(frozen=True)
class Topology:
    """Names of the variables and dimensions of a mesh in a file.

    ``x`` and ``y`` are the coordinates of the nodes, ``table`` has the nodes of each face,
    ``nodes`` and ``faces`` are dimensions, and ``by`` is the source of these names.
    """

    x: str
    y: str
    table: str
    nodes: str
    faces: str
    by: str


def with_nodes(file: Foreign) -> Foreign:
    """Return a dataset with a variable for each coordinate of nodes that ESMF has in a table."""
    if not {"nodeCoords", "elementConn"} <= {*file.variables}:
        return file
    table = file["nodeCoords"]
    unit = str(table.attrs.get("units", ""))
    kind = ("lon", "lat") if unit.startswith(("deg", "rad")) else ("x", "y")
    columns = {
        f"node_{word}": (table.dims[:1], table.values[:, i], {"units": unit})
        for i, word in enumerate(kind)
    }
    return file.assign(columns).drop_vars(["nodeCoords", "centerCoords"], errors="ignore")


def topology(
    file: Foreign, letter_of: Callable[[str, Mapping[str, Foreign]], str]
) -> Topology | None:
    """Return the mesh of a dataset, None where it has none.

    ``letter_of`` is as for :func:`.listed.listed`.
    """
    meshes = [
        str(name)
        for name, variable in file.variables.items()
        if variable.attrs.get("cf_role") == "mesh_topology"
    ]
    # A network of rivers may stand beside the mesh of the land.
    named = sorted(meshes, key=lambda name: "face_node_connectivity" not in _attributes(file, name))
    return _of_ugrid(file, named[0], letter_of) if named else _guessed(file, letter_of)


def _attributes(file: Foreign, name: str) -> dict[str, Foreign]:
    """Return all attributes of a variable: xarray keeps names of coordinates apart from others."""
    return {**file[name].encoding, **file[name].attrs}


def _of_ugrid(
    file: Foreign, name: str, letter_of: Callable[[str, Mapping[str, Foreign]], str]
) -> Topology:
    """Return the mesh that a variable of UGRID describes."""
    attributes = _attributes(file, name)
    table = attributes.get("face_node_connectivity", "")
    places = str(attributes.get("node_coordinates", "")).split()
    if not table or len(places) < 2:
        raise ValueError(f"the mesh {name!r} of UGRID has no faces of nodes in a plane")
    missing = [key for key in (table, *places[:2]) if key not in file.variables]
    if missing:
        raise ValueError(f"the mesh {name!r} of UGRID names {missing[0]!r}, which is not there")
    by_letter = {letter_of(key, file[key].attrs): key for key in places}
    x, y = by_letter.get("x", places[0]), by_letter.get("y", places[1])
    dims = [str(dim) for dim in file[table].dims]
    face_dim = str(attributes.get("face_dimension", ""))
    faces = face_dim if face_dim in dims else _of_faces(file, dims)
    return Topology(x, y, str(table), str(file[x].dims[0]), faces, "UGRID")


def _of_faces(file: Foreign, dims: list[str]) -> str:
    """Return the dimension of the faces of a table: the first, unless that is of the corners.

    The name tells where a mesh has as few faces as a face may have corners.
    """
    first, second = dims
    if file.sizes[first] in _CORNERS and _OF_CORNERS.fullmatch(first):
        return second
    return first if file.sizes[second] in _CORNERS else second


def _guessed(
    file: Foreign, letter_of: Callable[[str, Mapping[str, Foreign]], str]
) -> Topology | None:
    """Return the mesh of a table of numbers of nodes, which have an x and a y each."""
    places: dict[str, dict[str, str]] = {}
    for key, variable in file.variables.items():
        name, dims = str(key), [str(dim) for dim in variable.dims]
        letter = letter_of(name, variable.attrs)
        if len(dims) == 1 and dims != [name] and letter in ("x", "y"):
            pair = places.setdefault(dims[0], {})
            # Files may have lengths beside degrees, of which either may be all 0.
            if letter not in pair or not np.any(file[pair[letter]].values):
                pair[letter] = name
    meshes, tables = [], []
    for key, variable in file.variables.items():
        name, dims = str(key), [str(dim) for dim in variable.dims]
        if len(dims) != 2 or not any(size in _CORNERS for size in variable.shape):
            continue
        faces = _of_faces(file, dims)
        # The corners of a face have no coordinates.
        if {*dims} - {faces} & {*map(str, file.variables)}:
            continue
        sizes = [count for dim, count in file.sizes.items() if dim not in dims]
        if _SOLIDS.fullmatch(name) and any(_numbers(variable, count) for count in sizes):
            raise ValueError(f"{name!r} has the nodes of solids, not of faces: save it as .vtu")
        if _TABLES.fullmatch(name) and any(_numbers(variable, count) for count in sizes):
            tables.append(name)
        for nodes, pair in places.items():
            if len(pair) == 2 and nodes not in dims and _numbers(variable, file.sizes[nodes]):
                fields = sum({nodes, faces} & {*map(str, array.dims)} != set() for array in
                             file.data_vars.values())  # fmt: skip
                rank = bool(_TABLES.fullmatch(name)), fields, file.sizes[faces]
                meshes.append((rank, Topology(pair["x"], pair["y"], name, nodes, faces, "table")))
    if tables and not meshes:
        raise ValueError(
            f"{tables[0]!r} seems a table of the nodes of faces, which have no x and y: "
            "name them as UGRID does, by node_coordinates"
        )
    return max(meshes, key=lambda entry: entry[0])[1] if meshes else None


def _numbers(variable: Foreign, count: int) -> bool:
    """Return whether a variable has numbers of nodes, which differ in most rows."""
    if variable.dtype.kind not in "iuf":
        return False
    values = np.asarray(variable.values, dtype=np.float64)
    values = values if values.shape[1] in _CORNERS else values.T
    numbers = values[np.isfinite(values) & (values >= 0)]
    if not numbers.size or np.any(numbers != np.round(numbers)) or numbers.max() > count:
        return False
    ordered = np.sort(values, axis=1)
    return bool(np.median((np.diff(ordered, axis=1) > 0).sum(axis=1)) >= min(_CORNERS) - 1)


def tables(file: Foreign) -> set[str]:
    """Return the names of variables that describe meshes, and so are no data."""
    names = set()
    for name in file.variables:
        attributes = _attributes(file, name)
        role = str(attributes.get("cf_role", ""))
        if role.endswith(("connectivity", "mesh_topology")):
            names.add(str(name))
        if role == "mesh_topology":
            texts = (text for text in attributes.values() if isinstance(text, str))
            names |= {word for text in texts for word in text.split() if word in file.variables}
    return names


def surface(
    file: Foreign, of: Topology, scale: float, *, degrees: bool
) -> tuple[unrolled.Faces, Bools]:
    """Return the faces of a mesh in a plane, and a mask of those of the file that they are.

    ``scale`` is a factor of the coordinates. In degrees, faces across the meridian at which
    counting begins anew are cut at it.
    """
    x, y = (np.ravel(file[name].values).astype(np.float64) * scale for name in (of.x, of.y))
    table = file[of.table]
    rows: Array = np.asarray(
        table.values if table.dims[0] == of.faces else table.values.T, np.float64
    )
    # A face of fewer nodes than others has no number in the rest of its row.
    start = float(table.attrs.get("start_index", _start(rows, len(x))))
    if start == 1 and np.any(rows == 0) and not np.any(rows == len(x)):
        start = 0.0  # the file says otherwise, and has a node 0
    there: Bools = np.isfinite(rows) & (rows >= start)
    ids = np.where(there, rows - start, 0).astype(np.intp)
    if ids.max(initial=0) >= len(x):
        raise ValueError(f"{of.table!r} has the node {ids.max() + start:g} of {len(x)}")
    # Some repeat the last node in place of that.
    there[:, 1:] &= (ids[:, 1:] != ids[:, :-1]) | ~there[:, :-1]
    whole = there.sum(axis=1) >= min(_CORNERS)
    ids, there = ids[whole], there[whole]
    return (unrolled.unrolled if degrees else unrolled.plain)(x, y, ids, there), whole


def _start(rows: Array, count: int) -> int:
    """Return the number of the first node of a table that does not say it: 0 may fill its rows."""
    return int(np.nanmax(rows, initial=0) == count)
