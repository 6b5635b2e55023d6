"""Light inside a bundle of lines: the shares of light that reach the points of meshes."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Indices
from vizlight.geometry.lines import bundle as geometry
from vizlight.geometry.lines.bundle import Medium
from vizlight.geometry.lines.cylinders import Missed, missed
from vizlight.mesh import blocks, records
from vizlight.scene import Light, Scene
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import Bundle
from vizlight.shading.results import Record
from vizlight.vtk import polylines

#: Share of the diagonal that the default diameter is at most.
THICKEST = 1 / 500
#: Numbers of points and of directions that the default diameter is estimated from.
SAMPLE, SIDES = 20_000, 16
TRANSMITTANCE = "transmittance"


class Dimming(NamedTuple):
    """The shares of light that reach the points of a mesh, and a record of them.

    ``transmittance`` (N, L) is the share of each light of intensity above 0; their positions or
    directions are the ``keys``. The record has the diameter, the side of a voxel and digests of the
    sources of the shares; for each light the ``error`` that 95 of 100 points keep to, and the
    ``mean_error``, of the mean share of the points, as estimated by rays.
    """

    transmittance: Array
    record: Record
    keys: list[str]


class LineSet(NamedTuple):
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
    progress: Callable[[int, int], None],
) -> list[Dimming]:
    """Return the shares of light that reach the points of meshes inside a bundle of lines.

    ``inputs`` are the points of the meshes with tangents or normals, the scene is in the unit of
    the meshes, and ``names`` are those of the luminance and the transmittance: shares that a mesh
    has under that name are used again where nothing that they depend on has changed. ``progress``
    takes the number of grids that are done, and of all.
    """
    work, lights = Work(meshes, inputs, bundle), _lights(scene)
    dimmings: list[Dimming] = []
    for mesh, mesh_inputs in zip(meshes, inputs, strict=True):

        def report(count: int, done: int = len(dimmings) * len(lights)) -> None:
            # Grids of the meshes before, counted when the function is made, and of this one.
            progress(done + count, len(meshes) * len(lights))

        own = Dimmed(mesh, mesh_inputs, work, names)
        dimmings.append(own.with_errors(own.shares_of(lights, report), lights))
    return dimmings


class Work:
    """The lines that dim meshes, and their medium, which is computed once it is needed."""

    def __init__(
        self, meshes: Sequence[pv.DataSet], inputs: Sequence[ShadingInputs], bundle: Bundle
    ) -> None:
        for mesh_inputs in inputs:
            if mesh_inputs.points.shape[1] != 3:
                got = f"points of {mesh_inputs.points.shape[1]} components"
                raise _check.value_error("bundle", "points in 3-space", got)
        # Among the lines that are lit a point must not be in the shade of its own line.
        self.of_meshes, self.bundle = bundle.lines is None, bundle
        self.lines = joined(meshes) if self.of_meshes else _lines_of(bundle.lines)
        if not len(self.lines.ids):
            remedy = "pass Bundle(lines=...) to dim another mesh by lines"
            raise _check.value_error("bundle", "a mesh with lines", "none", remedy)
        # Shares that a mesh has kept hold only for the same lines and the same options.
        options_text = repr([bundle.diameter, bundle.depth, bundle.grid, self.of_meshes])
        self.source = records.source(*self.lines, np.array([options_text]))

    @functools.cached_property
    def medium(self) -> tuple[Medium, float]:
        """Medium of the lines and their diameter."""
        return medium_of(self.lines, self.bundle)


def _lights(scene: Scene) -> list[Light]:
    """Return the lights that shine, placed by the view of a scene."""
    # A lamp that is off would cost a grid of voxels for nothing.
    return [light.seen_from(scene.view) for light in scene.lights if light.intensity > 0]


def medium_of(lines: LineSet, bundle: Bundle) -> tuple[Medium, float]:
    """Return the medium of lines and their diameter."""
    ends = lines.points[lines.ids].astype(np.float64)
    # Only points of lines count, since others would make the box and all voxels larger.
    ends = ends[np.isfinite(ends).all(axis=1)]
    box = np.ptp(ends, axis=0) if len(ends) else np.zeros(3)
    longest, diagonal = float(box.max()), float(np.linalg.norm(box))
    # Cubes, so many along the longest side. Lines that are all in one place get a side of 1.
    voxel = longest / bundle.grid or 1.0
    diameter, coarse = bundle.diameter, None
    if diameter is None:
        diameter = diagonal * THICKEST or 1.0
        # The default diameter depends on how crowded the lines are, which a first medium tells.
        coarse = geometry.medium(*lines, voxel=voxel)
        ids = lines.ids[:: max(1, len(lines.ids) // SAMPLE)]
        halves = geometry.line_halves(*lines)[ids]
        tangents = _tangents(*lines)[ids]
        places = coarse.targets(lines.points[ids], tangents, halves)
        depth = coarse.crowded(places, SIDES)
        # The optical depth is that per diameter times the diameter in voxels: it is limited here.
        if depth * diameter > bundle.depth * voxel:
            diameter = bundle.depth * voxel / depth
    # The first medium serves, unless its voxels are too narrow for what are meant as thin lines.
    if coarse is not None and voxel >= geometry.LEAST_VOXEL * diameter:
        return coarse, diameter
    voxel = max(voxel, geometry.LEAST_VOXEL * diameter)
    return geometry.medium(*lines, voxel=voxel), diameter


class Dimmed:
    """A mesh that lines dim, and the shares that are known of it, one for each light.

    ``names`` are as for :func:`dim`.
    """

    def __init__(
        self, mesh: pv.DataSet, inputs: ShadingInputs, work: Work, names: tuple[str, str]
    ) -> None:
        self._work = work
        points = np.asarray(inputs.points[:])
        # Inputs far from 0 are relative to an origin for the sake of float32; the lines are not.
        if inputs.origin is not None and any(inputs.origin):
            points = points.astype(np.float64) + np.array(inputs.origin)
        vectors = inputs.normals if inputs.tangents is None else inputs.tangents
        rows = None if vectors is None else np.asarray(vectors[:])
        halves: Array | None = None
        if inputs.tangents is not None:
            # Length 0 stands for a point on no line of the medium, which adds nothing to its depth.
            halves = np.zeros((len(points), 2, 4))
            if work.of_meshes and polylines.has_lines_only(mesh):
                halves = polylines.of_points(mesh, geometry.line_halves)
        if rows is not None and len(rows) * inputs.repeat == len(points):
            # One vector may serve several points, as on a fibre of fur.
            rows = np.repeat(rows, inputs.repeat, axis=0)
        if rows is not None and rows.shape != points.shape:
            # Several tangents per point: a surface or a volume that light reaches from all sides.
            rows = halves = None
        self._targets = points, rows, halves
        # None has no bytes for a digest; an empty array stands for it.
        arrays = (np.empty(0) if x is None else x for x in self._targets)
        self._source = f"{work.source} {records.source(*arrays)}"
        self._known = _kept(mesh, names, self._source)
        self._missed = {} if self._known is None else _errors(self._known)

    def shares_of(
        self, lights: Sequence[Light], progress: Callable[[int], None] | None = None
    ) -> Dimming:
        """Return the shares of some lights, kept ones where they still hold."""
        keys, kept = [_key(light) for light in lights], self._known
        columns: dict[str, Array] = {}
        facts: Record = {}
        if kept is not None:
            if kept.keys == keys:
                # The same object, by which callers see that nothing has changed.
                return kept
            columns = dict(zip(kept.keys, kept.transmittance.T, strict=True))
            facts = kept.record
        # Where one lamp moves, the others keep their shares.
        missing = [i for i, key in enumerate(keys) if key not in columns]
        if missing:
            medium, diameter = self._work.medium
            places = [_place(lights[i]) for i in missing]
            targets = medium.targets(*self._targets)
            shares = medium.dimmed(targets, diameter, places, progress=progress)
            columns |= {keys[i]: column for i, column in zip(missing, shares.T, strict=True)}
            facts = {"diameter": diameter, "voxel": medium.voxel}
        transmittance = np.empty((len(self._targets[0]), len(keys)), np.float32)
        for i, key in enumerate(keys):
            transmittance[:, i] = columns[key]
        self._known = Dimming(transmittance, facts | {"source": self._source, "lights": keys}, keys)
        return self._known

    def with_errors(self, dimming: Dimming, lights: Sequence[Light]) -> Dimming:
        """Return shares of lights with their errors in the record, kept ones where they are."""
        known = self._missed
        missing = [i for i, key in enumerate(dimming.keys) if key not in known]
        if missing:
            medium, diameter = self._work.medium
            targets = medium.targets(*self._targets)
            for i in missing:
                left = dimming.transmittance[:, i]
                known[dimming.keys[i]] = missed(medium, targets, diameter, *_place(lights[i]), left)
        errors, means = ([known[key][k] for key in dimming.keys] for k in (0, 1))
        record = dimming.record | {"error": errors, "mean_error": means}
        return dimming._replace(record=record)

    def dimmed(self, inputs: ShadingInputs, scene: Scene) -> ShadingInputs:
        """Return inputs with the shares of the lights of a scene.

        They are the same object where they have those shares already.
        """
        dimming = self.shares_of(_lights(scene))
        if inputs.transmittance is dimming.transmittance:
            return inputs
        return dataclasses.replace(inputs, transmittance=dimming.transmittance)


def _tangents(points: Array, ids: Indices, offsets: Indices) -> Array:
    """Return a vector along a line through each point."""
    first = geometry.segment_starts(ids, offsets)
    tangents = np.zeros((len(points), 3))
    step = points[ids[first + 1]].astype(np.float64) - points[ids[first]]
    tangents[ids[first + 1]] = step
    # Written second: an inner point has the step after it, the last of a line the one before.
    tangents[ids[first]] = step
    return tangents


def _place(light: Light) -> tuple[tuple[float, ...], bool]:
    """Return the position of a light and True, or its direction and False."""
    place = light.direction if light.position is None else light.position
    assert place is not None
    return tuple(place), light.position is not None


def _key(light: Light) -> str:
    """Return a text that tells where light comes from."""
    place, near = _place(light)
    if not near:
        size = float(np.linalg.norm(place))
        # Of a light at infinity only the direction counts. Adding 0 makes 0.0 of -0.0, whose text
        # differs from it.
        place = tuple(round(x / size, 15) + 0.0 for x in place)
    return f"{'near' if near else 'far'} {place}"


def _kept(mesh: pv.DataSet, names: tuple[str, str], source: str) -> Dimming | None:
    """Return the shares of a mesh that still hold."""
    record = (records.read(mesh, names[0]) or {}).get("bundle")
    if not isinstance(record, dict) or record.get("source") != source:
        return None
    keys = record.get("lights")
    if not isinstance(keys, list) or names[1] not in records.made(mesh, names[0]):
        return None
    # VTK has no arrays of one column: of a single light they are flat.
    shares = np.asarray(mesh.point_data[names[1]]).reshape(mesh.n_points, -1)
    return Dimming(shares, record, keys) if shares.shape[1] == len(keys) else None


def _errors(dimming: Dimming) -> dict[str, Missed]:
    """Return the errors of each light that the record of shares has."""
    errors, means = (dimming.record.get(name) for name in ("error", "mean_error"))
    if not (isinstance(errors, list) and isinstance(means, list)):
        return {}
    missed_by_light = map(Missed, errors, means)
    return dict(zip(dimming.keys, missed_by_light, strict=False))


def _lines_of(mesh: object) -> LineSet:
    """Return the lines of a mesh or of the blocks of several."""
    if not isinstance(mesh, pv.DataSet | pv.MultiBlock):
        expected = "a PyVista mesh of lines"
        raise TypeError(_check.message("Bundle(lines=)", expected, type(mesh).__name__))
    lines = joined(list(blocks.all_blocks(mesh)))
    if not len(lines.ids):
        expected, got = "a mesh of lines", type(mesh).__name__
        raise _check.value_error("Bundle(lines=)", expected, got)
    return lines


def joined(meshes: Sequence[pv.DataSet]) -> LineSet:
    """Return the lines of the meshes that have nothing but lines."""
    cells = [polylines.cells_of(mesh) for mesh in meshes if polylines.has_lines_only(mesh)]
    none = np.empty((0, 3)), np.empty(0, np.intp), np.zeros(1, np.intp)
    points, ids, offsets = zip(*(cells or [none]), strict=True)
    starts = np.cumsum([0, *(len(rows) for rows in points)])
    ends = np.cumsum([0, *(len(line_ids) for line_ids in ids)])
    return LineSet(
        np.concatenate(points),
        np.concatenate([line_ids + start for line_ids, start in zip(ids, starts, strict=False)]),
        # The first offset of a mesh, 0, is where the mesh before ends.
        np.concatenate(
            [[0], *(line_starts[1:] + end for line_starts, end in zip(offsets, ends, strict=False))]
        ).astype(np.intp),
    )
