"""Points of a surface that files store once for each face, as one point."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from vizlight.mesh import creases, normals, point_arrays
from vizlight.reading.cells import connectivity
from vizlight.reading.normals import computed_normals
from vizlight.reading.topology import Owners, coincident

__all__ = ["keep_normals", "welded"]


def welded(mesh: pv.PolyData) -> pv.PolyData:
    """Return a surface whose points at the same place are one, where all their arrays are equal.

    Points without a face are left out. Normals that are computed are then those of the surface, not
    of each face; points that differ in a colour or a texture coordinate stay apart.

    Parameters
    ----------
    mesh : pyvista.PolyData
        Surface of polygons alone; anything else is returned as it is.
    """
    if mesh.n_cells != mesh.GetNumberOfPolys() or not mesh.n_cells:
        return mesh
    parts = [np.asarray(mesh.points) + 0, *map(np.asarray, mesh.point_data.values())]
    if any(part.dtype.kind not in "biuf" for part in parts):
        return mesh
    rows = [np.ascontiguousarray(part.reshape(len(part), -1)).view(np.uint8) for part in parts]
    table = np.ascontiguousarray(np.hstack([row.reshape(mesh.n_points, -1) for row in rows]))
    _, first, same = np.unique(
        table.view(f"V{table.shape[1]}"), return_index=True, return_inverse=True
    )
    ids, ends = connectivity(mesh.GetPolys())
    corners = first[same.reshape(-1)][ids]
    kept = np.zeros(mesh.n_points, dtype=np.bool_)
    kept[corners] = True
    if kept.all():
        return mesh
    out = pv.PolyData()
    out.points = np.asarray(mesh.points)[kept]
    out.SetPolys(creases.cell_array((np.cumsum(kept) - 1)[corners], ends))
    for key, array in mesh.point_data.items():
        point_arrays.attach_rows(out, key, np.asarray(array)[kept])
    out.GetCellData().ShallowCopy(mesh.GetCellData())
    out.GetFieldData().ShallowCopy(mesh.GetFieldData())
    point_arrays.carry_active(mesh, out)
    return out


def keep_normals(mesh: pv.PolyData) -> None:
    """Keep the normals of a surface without creases at points that only their arrays tell apart.

    Along the seam of a texture, or where colours differ, light is then as smooth as the surface.

    Parameters
    ----------
    mesh : pyvista.PolyData
        Surface of polygons; where it has no sharp edge, its point normals are set.
    """
    if mesh.n_cells != mesh.GetNumberOfPolys() or mesh.n_points < normals.FEWEST:
        return
    if not mesh.point_data or mesh.point_data.active_normals is not None:
        return
    first = coincident(np.asarray(mesh.points), Owners())
    if first is None:
        return
    ids, ends = connectivity(mesh.GetPolys())
    whole = pv.PolyData()
    whole.SetPoints(mesh.GetPoints())
    whole.SetPolys(creases.cell_array(first[ids], ends))
    sided = computed_normals(whole)
    if not sided.sharp:
        normals.keep(mesh, sided.part(0, first))
