"""Volumes without the corner toward the eye: the faces of the cut, and the outside."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import numpy as np
import pyvista as pv
import scipy

from vizlight import _check
from vizlight._types import AnyArray, Array, Bools
from vizlight.mesh import blocks, records

__all__ = ["cut_open", "without_corner"]

#: Share of the range of a scan up to which nothing is of a body, share of the median of what is
#: above that up to which it is dark, share of its sides that are, and values that are looked at.
DARK, EDGE, MOSTLY, SAMPLE = 0.1, 0.3, 0.5, 100_000
#: Steps along the longest side of a scan in which gaps of a body are closed, and half their width.
COARSE, GAP = 90, 3
#: Share of body on the skin, and name of the temporary array of shares and of distances.
MIDDLE, _SHARE = 0.5, "vizlight share"
#: Share of the largest part of a direction below which it does not point along an axis.
ALONG = 0.2
#: Distance of points that are one, and distance from them of a cut, as shares of the size of a
#: surface.
ROUNDING, BESIDE_POINTS = 1e-6, 1e-3
#: Steps along the longest side in which the skin is sought, and the thickness in these steps of
#: what has the values of skin.
FINE, THICKNESS, SMOOTH = 320, 3, 1.5


def cut_open(
    volume: pv.ImageData, name: str, /, toward: Sequence[float] = (1.0, 1.0, 1.0)
) -> pv.MultiBlock:
    """Return a scan of a body in air with the corner toward an eye taken out of it.

    Air is dark and connects to the sides of the volume: cavities stay, and narrow gaps. The
    skin is where values rise to 0.3 times the median of those of the body, smoothed by 1.5 voxels.

    Parameters
    ----------
    volume : pyvista.ImageData
        Scan, which is not changed.
    name : str
        Name of the point array of its values.
    toward : sequence of 3 float, default: (1, 1, 1)
        Direction toward the eye. Along each axis of the scan the half on its side is taken out.

    Returns
    -------
    pyvista.MultiBlock
        ``"cut"``, the faces of the cut through the middle of the body and those where the scan
        ends, with the values; and ``"skin"``, the surface of the body between them, without points
        where the sides of the scan are not mostly dark.

    Raises
    ------
    TypeError, ValueError
        If it is no image of two points at least along each axis, has no such array of one number
        per point, or the direction has no length.

    Examples
    --------
    >>> import numpy as np
    >>> import pyvista as pv
    >>> from vizlight import files
    >>> scan = pv.ImageData(dimensions=(20, 20, 20))
    >>> scan["T1"] = 100.0 * (np.linalg.norm(scan.points - 10, axis=1) < 8)
    >>> parts = files.cut_open(scan, "T1")
    >>> [round(end, 1) for end in parts["cut"].bounds[:2]]
    [10.0, 17.5]
    """
    _check.instance("volume", volume, pv.ImageData, "a pyvista.ImageData")
    name = _check.text("name", name, expected="the name of a point array")
    rows = np.asarray(records.scalars_of(volume, "name", name))
    if min(volume.dimensions) < 2:
        expected = "an image of two points at least along each axis"
        raise _check.value_error("volume", expected, f"{volume.dimensions} points")
    direction = np.array(_check.vector("toward", toward, direction=True, n=3))
    steps = -(-np.array(volume.dimensions) // FINE)
    values = rows.reshape(volume.dimensions, order="F")[tuple(slice(None, None, k) for k in steps)]
    inside = _inside(_check.floats("name", values))
    is_body = inside is not None
    if inside is None:
        inside = np.ones(values.shape, np.float32)
    corner = np.rint(scipy.ndimage.center_of_mass(inside > MIDDLE)).astype(int)
    is_high = direction @ volume.direction_matrix >= 0
    skin = _skin(volume, inside, steps, corner, is_high) if is_body else pv.PolyData()
    scan = pv.ImageData()
    scan.copy_structure(volume)
    scan.point_data[name] = rows
    faces = []
    for extent in _extents(corner * steps, (np.array(inside.shape) - 1) * steps, is_high):
        axes = (np.arange(low, high + 1) / k for (low, high), k in zip(extent, steps, strict=True))
        places = np.ix_(*axes)
        shares = scipy.ndimage.map_coordinates(inside, np.broadcast_arrays(*places), order=1)
        if shares.max() > MIDDLE:
            face = scan.extract_subset(np.ravel(extent).tolist())
            face.point_data[_SHARE] = shares.ravel(order="F")
            faces.append(face.clip_scalar(scalars=_SHARE, value=MIDDLE, invert=False))
    cut = _merged(faces)
    del cut.point_data[_SHARE]
    return pv.MultiBlock({"cut": cut, "skin": skin})


def without_corner(
    volume: pv.DataSet,
    name: str,
    /,
    level: float | None = None,
    toward: Sequence[float] = (1.0, 1.0, 1.0),
) -> pv.MultiBlock:
    """Return a volume, or the inside of an isosurface, without the corner toward an eye.

    Parameters
    ----------
    volume : pyvista.DataSet
        Mesh with solid cells, which is not changed.
    name : str
        Name of an array of one number per point or per cell. Values of cells are averaged to the
        points where there is a level; cells at points without a finite value are left out.
    level : float, optional
        Level of the isosurface. Values above it are left, or those below it where fewer of those
        on the outer surface of the volume are. Default: all of the volume is left.
    toward : sequence of 3 float, default: (1, 1, 1)
        Direction toward the eye. Along each axis along which it points, the half on its side is
        taken out, from the middle of its box.

    Returns
    -------
    pyvista.MultiBlock
        ``"cut"``, the faces of the cut, and ``"outside"``, the rest of the surface, both with the
        values. Without points where nothing is left.

    Raises
    ------
    TypeError, ValueError
        If it is no mesh with solid cells, has no such array, the level is no finite number, or the
        direction has no length.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import files
    >>> block = pv.ImageData(dimensions=(9, 9, 9)).cast_to_unstructured_grid()
    >>> block["height"] = block.points[:, 2]
    >>> parts = files.without_corner(block, "height", 6.0)
    >>> [round(end, 1) for end in parts["cut"].bounds]
    [4.0, 8.0, 4.0, 8.0, 7.0, 8.0]
    """
    _check.instance("volume", volume, pv.DataSet, "a pyvista.DataSet with solid cells")
    if not volume.n_cells or volume.max_cell_dimensionality != 3:
        raise _check.value_error("volume", "a mesh with solid cells", type(volume).__name__)
    name = _check.text("name", name, expected="the name of an array")
    if level is not None:
        volume = _whole(records.averaged(volume, name), name)
    elif name not in volume.cell_data:
        volume = _whole(volume, name)
    direction = np.array(_check.vector("toward", toward, direction=True, n=3))
    signs = np.where(np.abs(direction) < ALONG * np.abs(direction).max(), 0, np.sign(direction))
    hull = blocks.outer_surface(volume)[0]
    isosurface, is_low = pv.PolyData(), False
    if level is not None:
        level = _check.number("level", level)
        is_low = bool(np.mean(np.asarray(hull[name]) > level) > MIDDLE)
        hull = hull.clip_scalar(scalars=name, value=level, invert=is_low)
        isosurface = volume.contour([level], scalars=name, compute_normals=False)
        isosurface.point_data[name] = np.full(isosurface.n_points, level, hull[name].dtype)
    body = _merged([hull, isosurface])
    middle = np.reshape(body.bounds, (3, 2)).mean(axis=1)
    # Clipped through their points, cells of an isosurface would have sides without length.
    middle += BESIDE_POINTS * body.length * (level is not None)
    faces = []
    for axis in np.flatnonzero(signs):
        face = volume.slice(np.eye(3)[axis], origin=middle)
        for other in np.flatnonzero(signs):
            if other != axis and face.n_points:
                face = face.clip(signs[other] * np.eye(3)[other], origin=middle, invert=False)
        if level is not None and face.n_points:
            face = face.clip_scalar(scalars=name, value=level, invert=is_low)
        faces.append(face)
    outside = [_flat_without(hull, middle, signs), _bent_without(isosurface, middle, signs)]
    return pv.MultiBlock({"cut": _merged(faces), "outside": _merged(outside)})


def _whole(volume: pv.DataSet, name: str) -> pv.DataSet:
    """Return a volume with finite values in floating point, without cells at other points."""
    rows = records.scalars_of(volume, "name", name)
    if rows.dtype.kind in "biu":
        # Parts of different types lose their values where they become one mesh.
        volume = volume.copy(deep=False)
        volume.point_data[name] = rows.astype(np.float64)
    finite = np.isfinite(rows)
    whole: pv.DataSet = volume
    if not finite.all():
        whole = volume.extract_points(finite, adjacent_cells=False)
    return whole


def _ends(values: AnyArray) -> list[AnyArray]:
    """Return the values on the six sides of a scan, as views."""
    return [np.moveaxis(values, axis, 0)[end] for axis in range(3) for end in (0, -1)]


def _inside(values: Array) -> Array | None:
    """Return the share of each voxel that is body, 0.5 on the skin; None for no body in air."""
    sides = _ends(values)
    ground = min(np.nanmedian(side) for side in sides)
    some = values.ravel()[:: values.size // SAMPLE + 1] - ground
    darkest, brightest = np.nanpercentile(some, (1, 99))
    tissue = some[some > DARK * brightest]
    reach = float(EDGE * np.median(tissue)) if len(tissue) else 0.0
    # Nothing is darker than air but its noise.
    dark = [np.mean(side <= ground + reach) for side in sides]
    if not reach > max(-darkest, 0.0) or np.mean(dark) < MOSTLY:
        return None
    is_dark = ~(values > ground + reach)
    body = _largest(~_air(is_dark))
    # What is light only by noise does not reach the skin.
    share = np.clip((values - ground) / (2 * reach), 0, 1).astype(np.float32)
    share[np.isnan(share)] = 0
    share[~scipy.ndimage.binary_dilation(body, iterations=2)] = 0
    share[scipy.ndimage.binary_erosion(body, iterations=THICKNESS, border_value=1)] = 1
    smooth: Array = scipy.ndimage.gaussian_filter(share, SMOOTH, mode="nearest")
    # Where the scan ends, skin beside it is no part of that end.
    for plane, smooth_plane in zip(_ends(share), _ends(smooth), strict=True):
        smooth_plane[:] = scipy.ndimage.gaussian_filter(plane, SMOOTH)
    return smooth


def _air(is_dark: Bools) -> Bools:
    """Return where the air around a body is."""
    # Gaps of a few steps, as between skin and skull where a scan ends, are none of the air.
    steps = [max(1, size // COARSE) for size in is_dark.shape]
    coarse = is_dark[tuple(slice(None, None, step) for step in steps)]
    part, count = scipy.ndimage.label(
        scipy.ndimage.binary_erosion(coarse, None, GAP, border_value=1)
    )
    is_air = np.zeros(count + 1, np.bool_)
    for plane in _ends(part):
        is_air[np.unique(plane)] = True
    is_air[0] = False
    around = is_air[part]
    for axis, (size, step) in enumerate(zip(is_dark.shape, steps, strict=True)):
        around = np.take(around, np.arange(size) // step, axis=axis)
    around &= is_dark
    # On an end of the scan what is dark up to its edges is air; what is dark in a body has a rim.
    for dark, plane in zip(_ends(is_dark), _ends(around), strict=True):
        edges = np.ones(dark.shape, np.bool_)
        edges[1:-1, 1:-1] = False
        plane |= scipy.ndimage.binary_propagation(edges & dark, mask=dark)
    # Narrow folds of the skin, as around the eyes, are air too, as deep as the gaps are wide.
    reach = 2 * (GAP + 1) * max(steps)
    return scipy.ndimage.binary_dilation(around, iterations=reach, mask=is_dark)


def _largest(mask: Bools) -> Bools:
    """Return the largest connected part of a mask."""
    parts, _ = scipy.ndimage.label(mask)
    sizes = np.bincount(parts.ravel())
    sizes[0] = 0
    largest: Bools = parts == np.argmax(sizes)
    return largest


def _extents(corner: Array, last: Array, is_high: Bools) -> Iterator[list[tuple[int, int]]]:
    """Yield the faces of a cut and of the ends of a scan, by their first and last points."""
    low = [(0, int(at)) for at in corner]
    high = [(int(at), int(end)) for at, end in zip(corner, last, strict=True)]
    near = [up if is_up else down for up, down, is_up in zip(high, low, is_high, strict=True)]
    for axis, quarter in itertools.product(range(3), itertools.product((low, high), repeat=3)):
        extent = [half[i] for i, half in enumerate(quarter)]
        end = last[axis] if quarter[axis] is high else 0
        # The quarter in front of the cut is taken out of the end, and is that of the cut.
        extent[axis] = (corner[axis],) * 2 if extent == near else (end, end)
        yield extent


def _skin(
    volume: pv.ImageData, inside: Array, steps: Array, corner: Array, is_high: Bools
) -> pv.PolyData:
    """Return the surface of a body without the corner toward the eye."""
    body = pv.ImageData(dimensions=inside.shape, spacing=steps.tolist())
    body.point_data[_SHARE] = inside.ravel(order="F")
    skin = body.contour([MIDDLE], scalars=_SHARE, compute_normals=False).connectivity("largest")
    skin = _bent_without(skin, corner * steps, np.where(is_high, 1.0, -1.0))
    skin.clear_data()
    placed: pv.PolyData = skin.transform(volume.index_to_physical_matrix, inplace=False)
    return placed


def _flat_without(surface: pv.PolyData, middle: Array, signs: Array) -> pv.PolyData:
    """Return a surface without the corner on one side of the middle along each axis with a sign.

    Its edges are straight. Along them slivers remain, which would spoil normals.
    """
    left, corner = [], surface
    for axis in np.flatnonzero(signs):
        normal = signs[axis] * np.eye(3)[axis]
        if corner.n_points:
            left.append(corner.clip(normal, origin=middle.tolist()))
            corner = corner.clip(normal, origin=middle.tolist(), invert=False)
    return _merged(left)


def _bent_without(surface: pv.PolyData, middle: Array, signs: Array) -> pv.PolyData:
    """Return a surface of small cells without the corner, whose edges may end in a cell."""
    if not surface.n_points:
        return surface
    surface = surface.copy(deep=False)
    # Least of the distances from the planes of the cut: above 0 in the corner alone.
    depths = ((surface.points - middle) * signs)[:, signs != 0]
    surface.point_data[_SHARE] = depths.min(axis=1)
    rest: pv.PolyData = surface.clip_scalar(scalars=_SHARE, value=0.0)
    del rest.point_data[_SHARE]
    return rest


def _merged(parts: list[pv.PolyData]) -> pv.PolyData:
    """Return surfaces as one, without points where none has any."""
    first, *others = [part for part in parts if part.n_points] or [pv.PolyData()]
    if not others:
        return first
    # Along the seams of parts that were clipped by themselves points differ by rounding.
    grid = first.cast_to_unstructured_grid().merge(others, tolerance=ROUNDING * first.length)
    merged: pv.PolyData = grid.extract_surface(algorithm="dataset_surface")
    return merged
