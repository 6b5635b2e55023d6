"""One closed mesh of solids combined by union, intersection and difference.

Coarse meshes of the primitives are combined by manifold3d, which keeps the exact surface that each
triangle came from. The points are then moved onto their exact surfaces.
"""

from __future__ import annotations

import importlib.util
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.geometry.solids import placement, triangle_mesh
from vizlight.geometry.solids.primitives import EXPECTED, Block, Boolean, Frustum, Solid, Sphere
from vizlight.geometry.solids.triangle_mesh import Mesh

if TYPE_CHECKING:
    from collections.abc import Iterator

    import manifold3d

    from vizlight._types import Array, Indices
    from vizlight.geometry.solids.primitives import Primitive


__all__ = ["tessellate"]

#: Largest number of points of all primitives together.
MOST = 400_000
#: Largest number of points for a thin wall or a small solid.
PATIENCE = 60_000
#: Fewest segments of a circle, and ratio of radii below which circles have equal segments: the
#: facets of a thin wall between them are then parallel.
FEWEST, ALIKE = 24, 1.25
#: Grid of coordinates before a Boolean operation, so that equal places have equal coordinates.
GRID = 2.0**36
#: Inverse of the distance below which surfaces are one surface.
EQUAL = 1e10
#: Largest estimated share of the volume by which a mesh may differ from the exact solid, in units
#: of the tolerance, and the divisor of the tolerance where it differs by more.
SHARE, FINER = 8.0, 4.0
#: Error of the volume, in units of the tolerance, that never needs a finer tolerance. The scaled
#: solid is about as large as the unit ball.
NEGLIGIBLE = 1e-3
#: Number of times that the tolerance is divided for a solid that has less volume than its bound.
TRIALS = 2


def tessellate(solid: Solid, /, *, tolerance: float = 3e-3) -> Mesh:
    """Return a closed mesh of a solid.

    Parameters
    ----------
    solid : Solid
        Primitive, or a combination of primitives by ``|``, ``&`` and ``-``.
    tolerance : float, default: 3e-3
        Largest distance of triangles from curves and surfaces, as a share of the radius of a ball
        that contains all primitives, from 1e-6 to 0.1.

    Returns
    -------
    Mesh
        Mesh with points on the exact surfaces; points of an edge are on both surfaces to
        rounding, unless these touch without crossing. An empty solid has no triangles.

    Raises
    ------
    ImportError
        If a combined solid is given and manifold3d is not installed.
    TypeError, ValueError
        If an argument is not valid, if the tolerance needs more than 400,000 points, or if a thin
        wall or gap needs more than 60,000.

    Notes
    -----
    Coincident faces count once: shared faces of joined solids are removed, and the difference of
    equal solids is empty. Solids bounded by planes are exact to rounding. Points are about
    ``sqrt(2 tolerance r)`` apart on a surface of radius r. The volume between the triangles and
    their exact surfaces is measured; where it is more than ``8 tolerance`` of the volume of the
    solid, as in a thin wall between facets that are not parallel, the mesh is made again with a
    finer tolerance. Volume and area converge with the tolerance. Source: Isoluminance, Further
    Work.
    """
    if not isinstance(solid, Solid):
        raise TypeError(_check.message("solid", EXPECTED, _check.describe(solid)))
    tolerance = _check.number("tolerance", tolerance, low=1e-6, high=0.1)
    if isinstance(solid, Sphere | Frustum | Block):
        segments = max(FEWEST, math.ceil(math.pi / math.acos(1 - tolerance)))
        return triangle_mesh.mesh(solid, segments)
    if importlib.util.find_spec("manifold3d") is None:
        expected = "a single primitive, as the package manifold3d is not installed"
        remedy = "run pip install 'vizlight[solids]'"
        raise ImportError(_check.message("solid", expected, "a combined solid", remedy))
    tree = _Tree(solid)
    fine, trial = tolerance, 0
    made: Mesh | None = None
    while True:
        segments_of = tree.segments(fine)
        count = sum(_points(part, n) for part, n in zip(tree.parts, segments_of, strict=True))
        if count > (MOST if made is None else PATIENCE):
            break
        made, bound = tree.mesh(segments_of, fine)
        thin = made.volume_error > tolerance * max(SHARE * made.volume, NEGLIGIBLE)
        if not thin and (made.volume >= bound or trial == TRIALS):
            return made
        fine, trial = fine / FINER, trial + 1
    if made is not None and not thin:
        return made
    expected = f"a value that needs at most {MOST if made is None else PATIENCE} points"
    given = f"{tolerance:g}, which needs {count:.0f}"
    remedy = "raise it, or separate or join surfaces that nearly touch"
    raise ValueError(_check.message("tolerance", expected, given, remedy))


@dataclass
class _Tree:
    """A combined solid, scaled to about the unit ball."""

    solid: Solid

    def __post_init__(self) -> None:
        given = list(self.solid.primitives())
        self.shift, self.scale = _frame(given)
        self.parts = [part if part.empty else part.moved(self.shift, self.scale) for part in given]
        self.surfaces = tuple(s for part in self.parts for s in part.surfaces())
        owned = [len(part.surfaces()) for part in self.parts]
        self.first = np.cumsum(owned) - owned
        self.signs = np.repeat(_signs(self.solid, 1.0), owned)
        keys = [surface.key(sign) for surface, sign in zip(self.surfaces, self.signs, strict=True)]
        rows = np.round(np.reshape(keys, (-1, 10)) * EQUAL)
        _, first, which = np.unique(rows, axis=0, return_index=True, return_inverse=True)
        #: Index of the first surface that is equal to each.
        self.equal = first[which.ravel()]

    def segments(self, tolerance: float) -> list[int]:
        """Return the number of segments of a circle of each primitive, a multiple of 4."""
        radius = np.array([_radius(part) for part in self.parts])
        order = np.argsort(radius)
        with np.errstate(divide="ignore", invalid="ignore"):
            jump = radius[order][1:] > ALIKE * radius[order][:-1]
        group = np.empty(len(radius), np.intp)
        group[order] = np.concatenate([[0], np.cumsum(jump)])
        largest = np.zeros(len(radius))
        np.maximum.at(largest, group, radius)
        return [
            4 * math.ceil(max(FEWEST, math.pi / math.acos(max(1 - tolerance / (4 * r), 0))) / 4)
            if r > 0 else FEWEST
            for r in largest[group]
        ]  # fmt: skip

    def mesh(self, segments: list[int], tolerance: float) -> tuple[Mesh, float]:
        """Return the mesh, and a bound on the difference of its volume from the exact one."""
        from manifold3d import Manifold

        leaves: list[manifold3d.Manifold] = []
        bound = 0.0
        for part, count, first in zip(self.parts, segments, self.first, strict=True):
            if part.empty or not isinstance(part, Sphere | Frustum | Block):
                leaves.append(Manifold())
                continue
            leaves.append(_leaf(part, count, self.equal[first:]))
            bound += abs(part.volume - leaves[-1].volume())
        whole = _combine(self.solid, iter(leaves))
        if whole.is_empty():
            return self._empty(), bound
        found = whole.to_mesh64()
        triangles = np.asarray(found.tri_verts, np.intp)
        points = np.asarray(found.vert_properties, np.float64)[:, :3]
        same = np.arange(len(points))
        same[np.asarray(found.merge_from_vert, np.intp)] = found.merge_to_vert
        used, triangles = np.unique(same[triangles], return_inverse=True)
        mesh = Mesh(
            points[used],
            triangles.reshape(-1, 3).astype(np.intp),
            np.asarray(found.face_id, np.intp),
            self.surfaces,
            self.signs,
            self.shift,
            self.scale,
        )
        return placement.place(mesh, tolerance), bound

    def _empty(self) -> Mesh:
        none = np.empty((0, 3), np.intp)
        return Mesh(
            np.empty((0, 3)), none, none[:, 0], self.surfaces, self.signs, self.shift, self.scale
        )


def _frame(parts: list[Primitive]) -> tuple[Array, float]:
    """Return the centre of all primitives and the length that becomes the unit."""
    boxes = [part.box() for part in parts if not part.empty]
    if not boxes:
        return np.asarray(parts[0].box()[0]), 1.0
    low = np.min([center - radius for center, radius in boxes], axis=0)
    high = np.max([center + radius for center, radius in boxes], axis=0)
    shift = low + (high - low) / 2
    largest = max(radius for _, radius in boxes)
    # The distance of primitives counts too: all of them stay near the unit ball.
    apart = max(float(np.abs(center - shift).max()) for center, _ in boxes)
    return shift, max(largest, apart)


def _signs(solid: Solid, sign: float) -> list[float]:
    """Return for each primitive 1, or -1 if the solid lies outside of its surfaces."""
    if not isinstance(solid, Boolean):
        return [sign]
    second = -sign if solid.operation == "difference" else sign
    return _signs(solid.first, sign) + _signs(solid.second, second)


def _radius(part: Primitive) -> float:
    """Return the largest radius of a primitive's curved surfaces, 0 without any."""
    if isinstance(part, Sphere):
        return part.radius
    return max(part.radii) if isinstance(part, Frustum) else 0.0


def _points(part: Primitive, segments: int) -> float:
    """Return the approximate number of points of a primitive's mesh."""
    return 0.38 * segments**2 if isinstance(part, Sphere) else 2 * segments


def _leaf(part: Sphere | Frustum | Block, segments: int, number: Indices) -> manifold3d.Manifold:
    """Return the mesh of a primitive, with the number of the surface of each triangle."""
    from manifold3d import Error, Manifold, Mesh64

    mesh = triangle_mesh.mesh(part, segments)
    used, triangles = np.unique(mesh.triangles, return_inverse=True)
    points = np.round(mesh.world(mesh.points[used]) * GRID) / GRID
    leaf = Manifold(
        Mesh64(
            vert_properties=np.ascontiguousarray(points),
            tri_verts=np.ascontiguousarray(triangles.reshape(-1, 3), np.uint64),
            face_id=np.ascontiguousarray(number[mesh.patch], np.uint64),
        )
    )
    if leaf.status() != Error.NoError:
        remedy = "leave it out, or make it thicker"
        raise ValueError(_check.message("solid", "parts that are not flat", part, remedy))
    return leaf


def _combine(solid: Solid, leaves: Iterator[manifold3d.Manifold]) -> manifold3d.Manifold:
    if not isinstance(solid, Boolean):
        return next(leaves)
    first, second = _combine(solid.first, leaves), _combine(solid.second, leaves)
    if solid.operation == "union":
        return first + second
    return first ^ second if solid.operation == "intersection" else first - second
