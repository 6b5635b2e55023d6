"""Meshes and blocks of meshes: checked, walked, measured, moved."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
import pyvista as pv

from vizlight import _check

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vizlight._types import Array, Vector

#: Type of a mesh that a filter returns as it takes it.
MeshT = TypeVar("MeshT", bound="pv.DataSet | pv.MultiBlock")


def check(mesh: Any) -> None:
    """Refuse what is neither a dataset nor blocks of them."""
    if not isinstance(mesh, pv.DataSet | pv.MultiBlock):
        remedy = "read files by pyvista.read, wrap VTK objects by pyvista.wrap"
        raise TypeError(_check.message("mesh", "a PyVista mesh", type(mesh).__name__, remedy))


def leaves(mesh: Any) -> Iterator[Any]:
    """Yield the meshes of a MultiBlock, however deep, or the mesh itself."""
    for leaf, _ in named_leaves(mesh):
        yield leaf


def named_leaves(mesh: Any, path: str = "") -> Iterator[tuple[Any, str]]:
    """Yield the meshes of a MultiBlock, however deep, with where they are."""
    if not isinstance(mesh, pv.MultiBlock):
        if not isinstance(mesh, pv.DataSet):
            where = f"block {path}: " if path else ""
            got = type(mesh).__name__
            raise TypeError(where + _check.message("mesh", "a PyVista mesh", got))
        yield mesh, path
        return
    for i in range(mesh.n_blocks):
        if mesh[i] is not None:
            yield from named_leaves(mesh[i], f"{path}/{mesh.get_block_name(i) or i}")


def box(mesh: pv.DataSet) -> tuple[Array, float]:
    """Return the middle of a mesh's finite points and its longest side, 1 where it has none."""
    low, high = np.reshape(mesh.bounds, (3, 2)).T
    if not np.all(np.isfinite([low, high])) and isinstance(mesh, pv.PointSet | pv.PolyData):
        points = np.asarray(mesh.points, dtype=np.float64)
        points = points[np.all(np.isfinite(points), axis=1)]
        low, high = points.min(axis=0, initial=np.inf), points.max(axis=0, initial=-np.inf)
    side = float(np.max(high / 2 - low / 2)) * 2
    if not (np.isfinite(side) and side > 0):
        return np.nan_to_num(low / 2 + high / 2, posinf=0.0, neginf=0.0), 1.0
    return low / 2 + high / 2, side


def near_origin(mesh: pv.DataSet) -> Vector:
    """Return a place near a mesh, 0 where that is near enough not to lose digits of float32."""
    middle, side = box(mesh)
    far = np.abs(middle).max() > side
    return tuple(float(x) if far else 0.0 for x in middle)


def moved(mesh: Any, offset: Array, scale: float = 1.0) -> Any:
    """Return a mesh with its points p at ``scale (p + offset)``, in float64."""
    out = mesh.copy(deep=False)
    if isinstance(mesh, pv.ImageData):
        out.origin = tuple(scale * (np.array(mesh.origin) + offset))
        out.spacing = tuple(scale * np.array(mesh.spacing))
    elif isinstance(mesh, pv.RectilinearGrid):
        for i, axis in enumerate("xyz"):
            ticks = np.asarray(getattr(mesh, axis), dtype=np.float64)
            setattr(out, axis, scale * (ticks + offset[i]))
    else:
        points: Any = scale * (np.asarray(mesh.points, dtype=np.float64) + offset)
        points[~np.isfinite(points)] = np.nan
        # Not by assigning to points, which would move those that the copy shares.
        out.SetPoints(pv.vtk_points(points))
    return out
