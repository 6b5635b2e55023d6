"""Light inside a bundle of lines: the shares of light that reach the points of meshes."""

from __future__ import annotations

import dataclasses
import functools
import hashlib
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.geometry.lines import bundle as geometry
from vizlight.mesh import blocks, records
from vizlight.vtk import polylines

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array, Indices, Raw
    from vizlight.geometry.lines.bundle import Medium
    from vizlight.scene import Light, Scene
    from vizlight.shading.inputs import ShadingInputs
    from vizlight.shading.options import Bundle
    from vizlight.shading.results import Record

#: Share of the diagonal that the default diameter is at most.
THICKEST = 1 / 500
#: Numbers of points and of directions that the default diameter is estimated from.
SAMPLE, SIDES = 20_000, 16
TRANSMITTANCE = "transmittance"


class Dimming(NamedTuple):
    """The shares of light that reach the points of a mesh, and a record of them.

    Attributes
    ----------
    transmittance : ndarray of float32, shape (N, L)
        Share of each light of intensity above 0.
    record : dict
        Diameter, side of a voxel, and digests of what the shares were computed from.
    """

    transmittance: Array
    record: Record


class Lines(NamedTuple):
    """Polylines of one or several meshes."""

    points: Array
    ids: Indices
    offsets: Indices


def dim(
    meshes: Sequence[pv.DataSet],
    inputs: Sequence[ShadingInputs],
    scene: Scene,
    bundle: Bundle,
    names: tuple[str, str],
    /,
    *,
    progress: Callable[[int, int], None] | None = None,
) -> list[Dimming]:
    """Return the shares of light that reach the points of meshes inside a bundle of lines.

    Parameters
    ----------
    meshes : sequence of pyvista.DataSet
        Meshes that are lit.
    inputs : sequence of ShadingInputs
        Their points with tangents or normals.
    scene : Scene
        Lights, in the unit of the meshes, and the view that headlights follow.
    bundle : Bundle
        How the lines dim the light.
    names : tuple of str
        Names of the luminance and the transmittance. Shares that a mesh has under that name are
        used again where nothing that they depend on has changed.
    progress : callable, optional
        Function that is called with the number of grids that are done, and of all.

    Returns
    -------
    list of Dimming
        One for each mesh.

    Raises
    ------
    TypeError, ValueError
        If there are no lines, or points that are not in 3-space.
    """
    work = _work_of(meshes, inputs, bundle)
    lights = _lights(scene)
    made = []
    for number, (mesh, given) in enumerate(zip(meshes, inputs, strict=True)):
        done, total = number * len(lights), len(meshes) * len(lights)

        def report(count: int, done: int = done, total: int = total) -> None:
            if progress is not None:
                progress(done + count, total)

        made.append(_Target(work, mesh, given, names).dim(lights, report))
    return made


def _work_of(
    meshes: Sequence[pv.DataSet],
    inputs: Sequence[ShadingInputs],
    bundle: Bundle,
) -> _Work:
    """Return the lines that dim meshes."""
    for given in inputs:
        if given.points.shape[1] != 3:
            got = f"points of {given.points.shape[1]} components"
            raise ValueError(_check.message("bundle", "points in 3-space", got))
    own = bundle.lines is None
    lines = joined(meshes) if own else _lines_of(bundle.lines)
    if not len(lines.ids):
        remedy = "pass Bundle(lines=...) to dim another mesh by lines"
        raise ValueError(_check.message("bundle", "a mesh with lines", "none", remedy))
    asked = [bundle.diameter, bundle.depth, bundle.grid]
    source = _digest(lines.points, lines.ids, lines.offsets, np.array(repr([asked, own])))
    return _Work(lines, source, bundle)


def _lights(scene: Scene) -> list[Light]:
    """Return the lights that shine, where the view of a scene has them."""
    return [light.seen_from(scene.view) for light in scene.lights if light.intensity > 0]


class Live:
    """Shares of light of one mesh, computed again only for lights that have moved.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh that is lit.
    inputs : ShadingInputs
        Its points with tangents or normals.
    bundle : Bundle
        How the lines dim the light.
    names : tuple of str
        As for :func:`dim`.
    """

    def __init__(
        self, mesh: pv.DataSet, inputs: ShadingInputs, bundle: Bundle, names: tuple[str, str]
    ) -> None:
        self._target = _Target(_work_of([mesh], [inputs], bundle), mesh, inputs, names)

    def dimmed(self, inputs: ShadingInputs, scene: Scene) -> ShadingInputs:
        """Return inputs with the shares of the lights of a scene.

        They are the same object where they have those shares already.
        """
        known = self._target.known
        made = self._target.dim(_lights(scene))
        if known is made and inputs.transmittance is made.transmittance:
            return inputs
        return dataclasses.replace(inputs, transmittance=made.transmittance)


@dataclasses.dataclass
class _Work:
    """Lines and what is computed of them once they are needed."""

    lines: Lines
    source: str
    bundle: Bundle

    @functools.cached_property
    def medium(self) -> tuple[Medium, float]:
        """Medium of the lines and their diameter."""
        return medium_of(self.lines, self.bundle)


def medium_of(lines: Lines, bundle: Bundle) -> tuple[Medium, float]:
    """Return the medium of lines and their diameter."""
    ends = lines.points[lines.ids].astype(np.float64)
    ends = ends[np.isfinite(ends).all(axis=1)]
    box = np.ptp(ends, axis=0) if len(ends) else np.zeros(3)
    longest, diagonal = float(box.max()), float(np.linalg.norm(box))
    voxel = longest / bundle.grid or 1.0
    diameter, coarse = bundle.diameter, None
    if diameter is None:
        diameter = diagonal * THICKEST or 1.0
        coarse = geometry.medium(*lines, voxel=voxel)
        ids = lines.ids[:: max(1, len(lines.ids) // SAMPLE)]
        lengths = geometry.line_lengths(*lines)[ids]
        tangents = _tangents(*lines)[ids]
        places = coarse.targets(lines.points[ids], tangents, lengths)
        depth = coarse.crowded(places, SIDES)
        if depth * diameter > bundle.depth * voxel:
            diameter = bundle.depth * voxel / depth
    if coarse is not None and voxel >= geometry.LEAST_VOXEL * diameter:
        return coarse, diameter
    voxel = max(voxel, geometry.LEAST_VOXEL * diameter)
    return geometry.medium(*lines, voxel=voxel), diameter


class _Target:
    """A mesh that lines dim, and the shares that are known of it."""

    def __init__(
        self, work: _Work, mesh: pv.DataSet, given: ShadingInputs, names: tuple[str, str]
    ) -> None:
        self._work = work
        points = np.asarray(given.points[:])
        if given.origin is not None and any(given.origin):
            points = points.astype(np.float64) + np.array(given.origin)
        vectors = given.normals if given.tangents is None else given.tangents
        rows = None if vectors is None else np.asarray(vectors[:])
        lengths: Array | None = None
        if given.tangents is not None:
            lengths = np.zeros(len(points))
            if work.bundle.lines is None and polylines.has_lines_only(mesh):
                lengths = polylines.of_points(mesh, geometry.line_lengths)
        if rows is not None and len(rows) * given.repeat == len(points):
            rows = np.repeat(rows, given.repeat, axis=0)
        if rows is not None and rows.shape != points.shape:
            # Several tangents per point: a surface or a volume that light reaches from all sides.
            rows = lengths = None
        self._points, self._rows, self._lengths = points, rows, lengths
        empty = np.empty(0)
        self._digest = _digest(
            np.array(work.source),
            points,
            *(empty if x is None else x for x in (rows, lengths)),
        )
        kept = _kept(mesh, names, self._digest)
        #: Shares that still hold, and the keys of their lights.
        self.known = None if kept is None else kept[1]
        self._keys = [] if kept is None else kept[0]

    def dim(
        self, lights: Sequence[Light], progress: Callable[[int], None] | None = None
    ) -> Dimming:
        """Return the shares of some lights, known ones where they still hold."""
        keys, known = [_key(light) for light in lights], self.known
        columns: dict[str, Array] = {}
        facts: Record = {}
        if known is not None:
            if self._keys == keys:
                return known
            columns = dict(zip(self._keys, known.transmittance.T, strict=True))
            facts = {name: known.record.get(name) for name in ("diameter", "voxel")}
        missing = [i for i, key in enumerate(keys) if key not in columns]
        if missing:
            medium, diameter = self._work.medium
            found = medium.dimmed(
                medium.targets(self._points, self._rows, self._lengths),
                diameter,
                [_place(lights[i]) for i in missing],
                progress=progress,
            )
            columns |= {keys[i]: found[:, j] for j, i in enumerate(missing)}
            facts = {"diameter": diameter, "voxel": medium.voxel}
        transmittance = np.empty((len(self._points), len(keys)), np.float32)
        for i, key in enumerate(keys):
            transmittance[:, i] = columns[key]
        record: Record = {**facts, "source": self._digest, "lights": keys}
        made = Dimming(transmittance, record)
        self.known, self._keys = made, keys
        return made


def _tangents(points: Array, ids: Indices, offsets: Indices) -> Array:
    """Return a vector along a line through each point."""
    first = geometry.segment_starts(ids, offsets)
    found = np.zeros((len(points), 3))
    step = points[ids[first + 1]].astype(np.float64) - points[ids[first]]
    found[ids[first + 1]] = step
    found[ids[first]] = step
    return found


def _place(light: Light) -> tuple[tuple[float, ...], bool]:
    """Return the position of a light and True, or its direction and False."""
    if light.position is not None:
        return tuple(light.position), True
    assert light.direction is not None
    return tuple(light.direction), False


def _key(light: Light) -> str:
    """Return a text that tells where light comes from."""
    place, near = _place(light)
    if not near:
        size = float(np.linalg.norm(place))
        place = tuple(round(x / size, 15) + 0.0 for x in place)
    return f"{'near' if near else 'far'} {place}"


def _kept(
    mesh: pv.DataSet, names: tuple[str, str], digest: str
) -> tuple[list[str], Dimming] | None:
    """Return the keys of lights and the shares of a mesh that still hold."""
    whole = records.read(mesh, names[0])
    record = (whole or {}).get("bundle")
    if not isinstance(record, dict) or record.get("source") != digest:
        return None
    keys, made = record.get("lights"), records.made(mesh, names[0])
    if not isinstance(keys, list) or names[1] not in made & set(mesh.point_data):
        return None
    shares = np.asarray(mesh.point_data[names[1]]).reshape(mesh.n_points, -1)
    if shares.shape[1] != len(keys):
        return None
    facts: Record = {name: record.get(name) for name in ("diameter", "voxel")}
    return keys, Dimming(shares, {**facts, "source": digest, "lights": keys})


def _digest(*arrays: Raw) -> str:
    """Return a digest of arrays."""
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(f"{array.dtype}{array.shape}".encode())
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()


def _lines_of(given: object) -> Lines:
    """Return the lines of a mesh or of the blocks of several."""
    if not isinstance(given, pv.DataSet | pv.MultiBlock):
        expected = "a PyVista mesh of lines"
        raise TypeError(_check.message("Bundle(lines=)", expected, type(given).__name__))
    lines = joined(list(blocks.all_blocks(given)))
    if not len(lines.ids):
        expected, got = "a mesh of lines", type(given).__name__
        raise ValueError(_check.message("Bundle(lines=)", expected, got))
    return lines


def joined(meshes: Sequence[pv.DataSet]) -> Lines:
    """Return the lines of the meshes that have nothing but lines."""
    found = [polylines.cells_of(mesh) for mesh in meshes if polylines.has_lines_only(mesh)]
    if not found:
        none = np.empty(0, np.intp)
        return Lines(np.empty((0, 3)), none, np.zeros(1, np.intp))
    points, ids, offsets = zip(*found, strict=True)
    kind = np.result_type(*points)
    starts = np.cumsum([0, *(len(rows) for rows in points)])
    ends = np.cumsum([0, *(len(own) for own in ids)])
    return Lines(
        np.concatenate(points).astype(kind, copy=False),
        np.concatenate([own + start for own, start in zip(ids, starts, strict=False)]),
        np.concatenate(
            [[0], *(own[1:] + end for own, end in zip(offsets, ends, strict=False))]
        ).astype(np.intp),
    )
