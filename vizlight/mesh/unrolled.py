"""Faces on the globe laid out on a map in degrees: whole at the date line and at the poles."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pyvista as pv

from vizlight._types import AnyArray, Array, Bools, Indices, Raw
from vizlight.geometry.lines.simplices import Columns
from vizlight.geometry.nspace import lattice
from vizlight.mesh import blocks, globes, meaning

#: Distance of a node from a pole, in degrees, below which it has no longitude of its own.
AT_POLE = 1e-4
#: Distance from the last column of a grid to the first, in steps between columns, below which the
#: grid is closed.
CLOSED = 2.0
#: Degrees without a node from which a mesh is one of a region.
GAP = 30.0
#: Longitude in degrees by which a face may reach beyond the date line.
BEYOND = 1e-6


@dataclass(frozen=True)
class Faces:
    """Faces on a map.

    ``places`` are longitude and latitude of each point: of the nodes in their order, then of more
    points, each at a share of the way from the first of two ``nodes`` to the second. ``corners``
    are the points of all faces one after the other, ``ends`` where each face ends, from 0;
    ``faces`` is the face of the file that each one is a part of: all in their order, then further
    parts.
    """

    places: Array
    nodes: Indices
    shares: Array
    corners: Indices
    ends: Indices
    faces: Indices

    def at_points(self, rows: AnyArray) -> AnyArray:
        """Return the values of the points by those of the nodes, in the type of these.

        Those that are no floating-point numbers are not mixed.
        """
        if rows.dtype.kind != "f":
            return rows[np.where(self.shares > 0.5, *self.nodes.T[::-1])]
        values = rows[self.nodes[:, 0]]
        cut = np.flatnonzero(self.shares)
        share = self.shares[cut].reshape(-1, *[1] * (rows.ndim - 1))
        first, second = (rows[self.nodes[cut, i]] for i in (0, 1))
        values[cut] = (1 - share) * first + share * second
        return values

    def mesh(self) -> pv.PolyData:
        """Return the faces as a mesh in the plane."""
        mesh = pv.PolyData()
        mesh.points = np.pad(self.places, ((0, 0), (0, 1)))
        mesh.SetPolys(blocks.cell_array(self.corners, self.ends))
        return mesh


@dataclass(frozen=True)
class _Ring(Columns):
    """Corners of one face: nodes between which they are, shares, longitudes and latitudes."""

    nodes: Indices
    shares: Array
    lon: Array
    lat: Array


def plain(x: Array, y: Array, ids: Indices, there: Bools) -> Faces:
    """Return faces in a plane, as :func:`unrolled` those of a globe."""
    ends = np.concatenate([[0], np.cumsum(there.sum(axis=1))])
    node = np.arange(len(x))
    nodes = np.column_stack([node, node])
    places = np.column_stack([x, y])
    return Faces(places, nodes, np.zeros(len(x)), ids[there], ends, np.arange(len(ids)))


def unrolled(x: Array, y: Array, ids: Indices, there: Bools) -> Faces:
    """Return the faces of a globe on a map from -180 to 180 degrees; a region in one piece.

    A face across the date line is cut in two parts. A face with one corner at a pole has that
    corner at the longitudes of both neighbours, and a face around a pole reaches up to it. ``ids``
    (M, K) are the nodes of each face, in the order around it, and ``there`` masks the valid
    corners, three in each row at least.
    """
    at_pole = np.abs(y) > 90 - AT_POLE
    # Missing corners repeat the corner before.
    columns = np.where(there, np.arange(there.shape[1]), there.argmax(axis=1)[:, np.newaxis])
    filled = np.take_along_axis(ids, np.maximum.accumulate(columns, axis=1), axis=1)
    lon: Array = np.unwrap(x[filled], period=360.0, axis=1)
    middle = _middle(lon)
    x, lon = x - middle, lon - middle
    x = x - 360.0 * np.ceil((x - 180.0) / 360.0)
    around = np.abs(lon[:, -1] - lon[:, 0]) > 180
    odd = around | ((at_pole[ids] & there).sum(axis=1) == 1)
    odd |= _over_pole(lon, np.roll(lon, -1, axis=1)).any(axis=1)
    middles = np.mean(lon, axis=1, where=there)
    lon -= 360.0 * np.ceil((middles - 180.0) / 360.0 - 1e-9)[:, np.newaxis]
    odd |= (lon.min(axis=1) < -180 - BEYOND) | (lon.max(axis=1) > 180 + BEYOND)
    plainly = there & ~odd[:, np.newaxis]
    node = ids[plainly]
    rings = [_Ring(np.column_stack([node, node]), np.zeros(len(node)), lon[plainly], y[node])]
    numbers = [np.nonzero(plainly)[0]]
    count = len(ids)
    faces = [np.arange(count)]
    for i in np.flatnonzero(odd):
        corners = ids[i][there[i]]
        for k, ring in enumerate(_parts(_at_pole(x, y, corners, at_pole[corners]))):
            number = count if k else i
            numbers.append(np.full(len(ring.lon), number))
            rings.append(ring)
            if k:
                faces.append(np.array([i]))
                count += 1
    of_face = np.concatenate(numbers)
    order = np.argsort(of_face, kind="stable")
    every = rings[0].joined(*rings[1:])[order]
    ends = np.concatenate([[0], np.cumsum(np.bincount(of_face, minlength=count))])
    map_faces = _joined(x, y, every, ends, np.concatenate(faces))
    return replace(map_faces, places=map_faces.places + np.array([middle, 0.0]))


def _middle(lon: Array) -> float:
    """Return the middle of the map of a region by the corners of its faces, 0 for a globe."""
    places = np.unique(lon % 360.0)
    if len(places) < 2:
        return 0.0
    gaps = np.diff(places, append=places[0] + 360.0)
    widest = int(np.argmax(gaps))
    end = (float(places[widest]) + gaps[widest] / 2) % 360.0
    # What spans the gap goes around, and a gap at the date line is at the ends of the map already.
    spans = (end - lon.min(axis=1)) % 360.0 < np.ptp(lon, axis=1)
    at_line = (180.0 - places[widest]) % 360.0 <= gaps[widest]
    if gaps[widest] < GAP or at_line or spans.any():
        return 0.0
    return float(end - 180.0 if end > 0 else 180.0)


def _joined(x: Array, y: Array, every: _Ring, ends: Indices, faces: Indices) -> Faces:
    """Return faces with their corners at one place, of the same nodes, merged to one point."""
    node = every.nodes[:, 0]
    at_node = (every.shares == 0) & (np.abs(every.lon - x[node]) < BEYOND) & (every.lat == y[node])
    rows: Array = np.column_stack(
        [every.nodes, np.round(every.shares, 9), np.round(every.lon, 6), every.lat]
    )[~at_node]
    more, which = np.unique(rows, axis=0, return_inverse=True)
    # A node that is at other places alone is at the first of these.
    target = len(x) + np.arange(len(more))
    _, first = np.unique(more[:, 0], return_index=True)
    first = first[(more[first, 2] == 0) & ~np.isin(more[first, 0], node[at_node])]
    moved = more[first, 0].astype(np.intp)
    target[first] = moved
    kept = np.delete(np.arange(len(more)), first)
    target[kept] = len(x) + np.arange(len(kept))
    places: Array = np.column_stack([x, y])
    places[moved] = more[first, 3:]
    nodes = np.repeat(np.arange(len(x)), 2).reshape(-1, 2)
    corners = node.copy()
    corners[~at_node] = target[np.ravel(which)]
    more = more[kept]
    return Faces(
        np.concatenate([places, more[:, 3:]]),
        np.concatenate([nodes, more[:, :2].astype(np.intp)]),
        np.concatenate([np.zeros(len(x)), more[:, 2]]),
        corners,
        ends,
        faces,
    )


def _at_pole(x: Array, y: Array, corners: Indices, at_pole: Bools) -> _Ring:
    """Return the corners of a face, those at a pole at the longitudes of their neighbours."""
    nodes, shares, lat = np.column_stack([corners, corners]), np.zeros(len(corners)), y[corners]
    over = np.flatnonzero(_over_pole(x[corners], np.roll(x[corners], -1)))
    pole = np.copysign(90.0, lat.mean())
    if len(over) and not at_pole.any():
        # An edge over the pole has a corner there.
        first, after = int(over[0]), (int(over[0]) + 1) % len(corners)
        far = 90 - np.abs(lat[[first, after]])
        nodes = np.insert(nodes, first + 1, corners[[first, after]], axis=0)
        shares = np.insert(shares, first + 1, far[0] / (far.sum() or 1.0))
        lat = np.insert(lat, first + 1, pole).astype(np.float64)
        at_pole = np.abs(lat) > 90 - AT_POLE
    if at_pole.sum() == 1:
        turned = np.roll(np.arange(len(lat)), -int(np.argmax(at_pole)))
        ring: Array = np.unwrap(x[nodes[turned[1:], 0]], period=360.0)
        turned = np.append(turned, turned[0])
        lon = np.concatenate([ring[:1], ring, ring[-1:]])
        return _Ring(nodes[turned], shares[turned], lon, lat[turned])
    lon = np.unwrap(x[np.append(corners, corners[0])], period=360.0)
    if abs(lon[-1] - lon[0]) < 180:
        return _Ring(nodes, shares, lon[:-1], lat)
    # The pole lies between two corners that are opposite each other.
    turned = np.append(np.arange(len(lat)), 0)
    far = 90 - np.abs(lat[[0, len(lat) // 2]])
    across = np.tile(corners[[0, len(lat) // 2]], (2, 1))
    nodes = np.concatenate([nodes[turned], across])
    shares = np.concatenate([shares[turned], np.full(2, far[0] / far.sum())])
    lat = np.concatenate([lat[turned], [pole, pole]])
    return _Ring(nodes, shares, np.append(lon, [lon[-1], lon[0]]), lat)


def _over_pole(lon: Array, after: Array) -> Bools:
    """Return whether edges between two longitudes go over a pole: they are half a turn apart."""
    away = np.abs((after - lon + 180.0) % 360.0 - 180.0)
    return np.asarray(np.abs(away - 180.0) < AT_POLE)


def _parts(ring: _Ring) -> list[_Ring]:
    """Return the parts of a face from -180 to 180 degrees, the larger one first."""
    low = 360.0 * np.floor((ring.lon.min() + 180.0 + BEYOND) / 360.0)
    ring = replace(ring, lon=ring.lon - low)
    if ring.lon.max() <= 180 + BEYOND:
        return [ring]
    west, east = _cut(ring, 1.0), _cut(ring, -1.0)
    east = replace(east, lon=east.lon - 360.0)
    return [west, east] if np.ptp(west.lon) >= np.ptp(east.lon) else [east, west]


def _cut(ring: _Ring, side: float) -> _Ring:
    """Return the part of a face on one side of 180 degrees: west for 1, east for -1."""
    off = side * (180.0 - ring.lon)
    following = np.roll(np.arange(len(off)), -1)
    parts = []
    for i, j in enumerate(following):
        if off[i] >= 0:
            parts.append(ring[i : i + 1])
        if off[i] * off[j] < 0:
            # The same in both faces at an edge, in whichever order they have its nodes.
            a, b = sorted((i, int(j)), key=lambda k: (ring.nodes[k, 0], ring.lon[k]))
            share = off[a] / (off[a] - off[b])
            lat = (1 - share) * ring.lat[a] + share * ring.lat[b]
            nodes = np.array([[ring.nodes[a, 0], ring.nodes[b, 0]]])
            if np.array_equal(ring.nodes[a], ring.nodes[b]):
                # Both are the pole.
                nodes, share = ring.nodes[a : a + 1], ring.shares[a]
            parts.append(_Ring(nodes, np.array([share]), np.array([180.0]), np.array([lat])))
    return parts[0].joined(*parts[1:])


def of_grid(grid: pv.StructuredGrid, there: Bools) -> tuple[pv.PolyData | pv.UnstructuredGrid, int]:
    """Return the cells of a grid of longitudes and latitudes that goes around a pole.

    The grid has one layer or levels; its cells have the arrays of the points. The second result
    is the number of cells that are left out, at a node without a place.
    """
    nx, ny, nz = grid.dimensions
    x, y, z = np.asarray(grid.points, dtype=np.float64).T.reshape(3, nz, ny * nx)
    is_closed = _is_closed(x[0].reshape(ny, nx), y[0].reshape(ny, nx), there)
    quads = lattice.cells((ny, nx), (False, is_closed), by_rows=True)
    kept = quads[there.ravel()[quads].all(axis=1)]
    faces = unrolled(x[0], y[0], kept, np.ones(kept.shape, np.bool_))
    mesh = faces.mesh() if nz == 1 else _between(faces, z[:, 0])
    for name in grid.point_data:
        rows = np.asarray(grid.point_data[name]).reshape(nz, ny * nx, -1)
        flat = np.concatenate([faces.at_points(layer) for layer in rows])
        mesh.point_data[name] = flat[:, 0] if flat.shape[1] == 1 else flat
    mesh.field_data.update(grid.field_data)
    turn_vectors(mesh, faces, np.column_stack([x[0], y[0]]))
    return mesh, (len(quads) - len(kept)) * max(nz - 1, 1)


def turn_vectors(mesh: pv.DataSet, faces: Faces, at: Array) -> None:
    """Turn the vectors of a mesh of faces at a pole, and where faces are cut, to its meridians.

    The mesh is on the points of the faces, of each level those of all nodes first, with vectors
    that point east, north and perhaps up at the nodes; ``at`` (N, 2) has their longitude and
    latitude in degrees.
    """
    for group in meaning.components(mesh):
        # Those along the rows of the grid, which stand turned beside them, are of no meridian.
        name = ",".join(group)
        names = [name] if name in mesh.point_data else [*group]
        if names[0] not in mesh.point_data:
            continue
        rows = np.column_stack([mesh.point_data[part] for part in names])
        levels = rows.reshape(-1, len(faces.places), rows.shape[1])[:, : len(at)]
        turned = np.concatenate([_from_meridians(faces, at, level) for level in levels])
        columns = [turned] if name in names else turned.T
        for part, column in zip(names, columns, strict=True):
            mesh.point_data[part] = column.astype(mesh.point_data[part].dtype)


def _from_meridians(faces: Faces, at: Array, rows: Raw) -> Array:
    """Return vectors at the points of faces by those of the nodes, east, north and perhaps up.

    At a point between nodes, and at a pole, these directions are others than at the nodes.
    """
    count = rows.shape[1]
    in_space = np.einsum("ij,ijk->ik", rows.astype(np.float64), globes.directions(at)[:, :count])
    onto = globes.directions(faces.places)[:, :count]
    return np.asarray(np.einsum("ik,ijk->ij", faces.at_points(in_space), onto))


def _between(faces: Faces, levels: Array) -> pv.UnstructuredGrid:
    """Return hexahedra on faces between levels, and wedges on the parts of faces not of four."""
    count, sizes = len(faces.places), np.diff(faces.ends)
    square = faces.corners[np.repeat(sizes == 4, sizes)].reshape(-1, 4)
    rings = [faces.corners[faces.ends[i] : faces.ends[i + 1]] for i in np.flatnonzero(sizes != 4)]
    fans = [(ring[-1], *pair) for ring in rings for pair in pairwise(ring[:-1])]
    third: Indices = np.array(fans, dtype=np.intp).reshape(-1, 3)
    layers = count * np.arange(len(levels) - 1)[:, np.newaxis, np.newaxis]
    cells = {
        kind: np.concatenate([below + layers, below + layers + count], axis=2).reshape(-1, 2 * n)
        for kind, below, n in ((pv.CellType.HEXAHEDRON, square, 4), (pv.CellType.WEDGE, third, 3))
    }
    places = np.tile(faces.places, (len(levels), 1))
    points = np.column_stack([places, np.repeat(levels, count)])
    return pv.UnstructuredGrid(cells, points)


def _is_closed(x: Array, y: Array, there: Bools) -> bool:
    """Return whether the last column of a grid is one step before the first."""
    lon, lat = np.radians(np.where(there, x, np.nan)), np.radians(np.where(there, y, np.nan))
    places = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)])
    steps = np.linalg.norm(np.diff(places, axis=2, append=places[:, :, :1]), axis=0)
    if not np.isfinite(steps[:, -1]).any():
        return False
    between, last = np.nanmedian(steps[:, :-1]), np.nanmedian(steps[:, -1])
    return bool(0.01 * between < last < CLOSED * between)
