"""The isosurface of values that stands out: through the steepest places."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from vizlight._types import Array, Indices
from vizlight.vtk.cells import connectivity

#: Most cells that are looked at, number of levels, and shares of the values at their ends.
SAMPLE, LEVELS, ENDS = 20_000, 48, (0.02, 0.98)
#: Gradient at a level, as a multiple of the mean gradient, from which its isosurface is good.
GOOD = 1.5
#: Share of the levels at either end, where values that rise ever faster are steepest, and the
#: contrast that a level needs there.
OUTER, STRONG = 0.1, 3.0
#: Share of the values that are the lowest one, and its distance to the first others in that of
#: these to the median, from which it is no value; share of this distance at which others begin.
APART, FAR, UNBLENDED = 0.01, 2.0, 0.9
#: Share of the steepness of the best level at which scans are drawn: thin parts are dark.
THIN = 0.9
#: Fewest cells of the sample that a level must cross.
FEWEST = 30


def best_level(mesh: pv.DataSet, name: str, *, share: float = 1.0) -> tuple[float, float]:
    """Return the level with an isosurface through the steepest cells, and their steepness.

    ``share`` is that of the steepness of the best level with which the lowest is taken. The level
    has few digits; the steepness is the mean gradient of the cells that it crosses, as a multiple
    of the mean of all cells of the sample: 1 for values that rise evenly, 0 where no level crosses
    enough cells.
    """
    low, high, steep = _cells(mesh, name)
    kept = np.isfinite(low) & np.isfinite(high) & np.isfinite(steep)
    low, high, steep = low[kept], high[kept], steep[kept]
    middles = 0.5 * (low + high)
    mean = float(steep.mean()) if len(steep) else 0.0
    if not mean > 0:
        return (float(middles.mean()) if len(middles) else 0.0), 0.0
    bottom, top = np.quantile(middles, ENDS)
    if not bottom < top:
        bottom, top = float(low.min()), float(high.max())
    candidates = np.linspace(bottom, top, LEVELS + 2)[1:-1]
    scores = np.zeros(LEVELS)
    for i, level in enumerate(candidates):
        crossed = (low <= level) & (level < high)
        if crossed.sum() >= FEWEST:
            # A steep cell is crossed by more levels: its area is counted once at each.
            scores[i] = steep[crossed].mean() / mean
    # A level between two others that are as good is safer than one at the end of their range.
    smooth = np.convolve(scores, (0.25, 0.5, 0.25), mode="same")
    best = int(np.argmax(smooth))
    if not OUTER * LEVELS <= best < (1 - OUTER) * LEVELS and scores[best] < STRONG:
        scores[best] = min(scores[best], 1.0)
    if share < 1:
        best = int(np.argmax(scores >= share * scores[best]))
    return _few_digits(float(candidates[best]), float(top - bottom)), float(scores[best])


def number(value: float) -> str:
    """Return a value in few digits."""
    return f"{value + 0.0:.4g}"  # no -0


def _few_digits(value: float, spread: float) -> float:
    step = 10.0 ** np.floor(np.log10(spread / LEVELS)) if spread > 0 else 1.0
    return float(f"{np.round(value / step) * step:.6g}")


def _cells(mesh: pv.DataSet, name: str) -> tuple[Array, Array, Array]:
    """Return the ends of the values of some cells, and their difference over the cells' size."""
    if name not in mesh.point_data:
        mesh = mesh.cell_data_to_point_data()
    values = np.asarray(mesh.point_data[name], dtype=np.float64)
    ids, starts, counts = sampled_corners(mesh)
    if not len(counts):
        return np.empty(0), np.empty(0), np.empty(0)
    corners = _measured(values)[ids]
    low, high = np.minimum.reduceat(corners, starts), np.maximum.reduceat(corners, starts)
    if isinstance(mesh, pv.ImageData):
        size = np.full(len(low), float(np.linalg.norm(mesh.spacing)))
    else:
        places = np.asarray(mesh.points, dtype=np.float64)[ids]
        box = np.maximum.reduceat(places, starts) - np.minimum.reduceat(places, starts)
        size = np.linalg.norm(box, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return low, high, (high - low) / size


def _measured(values: Array) -> Array:
    """Return values, NaN where they are the lowest one, far below others, or blends with it.

    Nothing was measured there: scanners fill the corners around their circle so.
    """
    finite = values[np.isfinite(values)]
    if not len(finite):
        return values
    lowest = float(finite.min())
    others = finite[finite > lowest]
    if not len(others) or len(others) > (1 - APART) * len(finite):
        return values
    first, median = np.percentile(others, (5, 50))
    if first - lowest < FAR * (median - first):
        return values
    return np.where(values < lowest + UNBLENDED * (first - lowest), np.nan, values)


def sampled_corners(mesh: pv.DataSet) -> tuple[Indices, Indices, Indices]:
    """Return the points of some cells one after the other, where each begins, and their counts.

    The points of a cell of a grid are in the order of a walk around it, along its edges.
    """
    if isinstance(mesh, pv.PolyData) and mesh.n_strips:
        mesh = mesh.triangulate()
    generator = np.random.default_rng(0)
    count = mesh.n_cells
    chosen = np.arange(count)
    if count > SAMPLE:
        chosen = np.sort(generator.choice(count, SAMPLE, replace=False))
    if isinstance(mesh, pv.UnstructuredGrid | pv.PolyData):
        cells = mesh.GetCells() if isinstance(mesh, pv.UnstructuredGrid) else mesh.GetPolys()
        ids, ends = connectivity(cells)
        chosen = chosen[chosen < len(ends) - 1]
        counts = ends[chosen + 1] - ends[chosen]
        chosen, counts = chosen[counts > 0], counts[counts > 0]
        starts = (np.cumsum(counts) - counts).astype(np.intp)
        offsets = np.repeat(ends[chosen] - starts, counts)
        return ids[np.arange(counts.sum()) + offsets], starts, counts
    shape = np.maximum(np.asarray(mesh.dimensions), 1)
    sides = np.maximum(shape - 1, 1)
    x, y, z = np.unravel_index(chosen, tuple(sides), order="F")
    ring: list[tuple[int, ...]] = [()]
    for size in shape:
        back = [(*corner, 1) for corner in reversed(ring)] if size > 1 else []
        ring = [*((*corner, 0) for corner in ring), *back]
    offsets = np.array(ring)
    at = np.stack([x, y, z], axis=1)[:, np.newaxis] + offsets
    ids = at[..., 0] + shape[0] * (at[..., 1] + shape[1] * at[..., 2])
    counts = np.full(len(chosen), len(offsets))
    return ids.ravel(), np.arange(len(chosen)) * len(offsets), counts
