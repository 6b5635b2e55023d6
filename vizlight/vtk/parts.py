"""The arrays of a dataset that the engine lights, selected by the options of a filter."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from vizlight import _check
from vizlight._types import Array, Bools, Dataset, Foreign, Indices, Keywords
from vizlight.scene import Scene, View
from vizlight.shading.arrays import Shading
from vizlight.shading.inputs import ArraySource, ShadingInputs, Sides
from vizlight.shading.options import LightOptions
from vizlight.shading.plan import not_a_line
from vizlight.vtk import polylines
from vizlight.vtk.arrays import named, points_of, tangents_of, without_sign
from vizlight.vtk.batches import Batch
from vizlight.vtk.normals import Sided, Turned, Vote, computed_normals, sided_normals


class Part(NamedTuple):
    """Inputs of the light of one mesh, or of several at once.

    ``numbers`` are those of the meshes, and ``ends`` has the first point of each of several, and
    the end of the last.
    """

    inputs: ShadingInputs
    options: LightOptions
    sided: Sided | None
    numbers: Sequence[int] = (0,)
    ends: Sequence[int] | Indices = ()

    def shadings(self, whole: Shading) -> Iterator[tuple[int, Shading]]:
        """Yield the number and the light of each mesh, given that of all."""
        if not len(self.ends):
            yield self.numbers[0], whole
            return
        for i, number in enumerate(self.numbers):
            yield number, whole.part(i, slice(*self.ends[i : i + 2]))


def uses_normals(mesh: Dataset, options: LightOptions) -> bool:
    """Return whether light depends on the normals of the surface."""
    if isinstance(options.conditioned, str):
        return False
    lines = options.positions is None and polylines.has_lines_only(mesh)
    return (options.tangents is None and not lines) or bool(options.conditioned)


def part_of(
    mesh: Dataset,
    path: str,
    scene: Scene,
    options: LightOptions,
    *,
    kept_normals: Callable[[Foreign], Sided | None] | None = None,
    kept_tangents: Callable[[Foreign], Array | None] | None = None,
    vote: Vote | None = None,
    block: Indices | None = None,
) -> Part:
    """Return the inputs of the light of one mesh; an error names the path of its block.

    With ``vote`` it is a part of a whole, see :mod:`vizlight.vtk.sides`, and with ``block`` it is
    several, see :func:`parts_of`. Without a view both sides of an open surface are lit alike.
    """
    with _check.in_block(path):
        points = points_of(mesh, options.positions)
        n = int(points.shape[1])
        tangents = _tangents(mesh, n, options, kept_tangents)
        _check_options(tangents, n, options)
        base = normals = sided = dimensions = None
        alike = False
        if isinstance(options.conditioned, str):
            base = tangents_of(mesh, options.conditioned, n, argument="conditioned")
        elif tangents is None or options.conditioned:
            sided = sided_normals(
                mesh, options.normals, n, options.facing, kept=kept_normals, vote=vote, block=block
            )
            # Lines and vertices beside faces: each point is lit as what it is, in one call of the
            # engine.
            if tangents is None and n == 3 and polylines.has_several_kinds(mesh):
                tangents, sided, dimensions = _several(mesh, sided)
            normals = sided.facing(options.facing, points, scene.view)
            # Without an eye there is nothing to turn a surface to whose outer side is unknown.
            alike = scene.view is None and (
                options.facing == "eye" or (options.facing == "auto" and sided.any_open)
            )
    inputs = ShadingInputs(
        points=points,
        occlusion=share_of(mesh, options.occlusion, path),
        tangents=tangents,
        normals=normals,
        base_tangents=base,
        dimensions=dimensions,
        two_sided=alike,
        line_field=options.line_field or without_sign(mesh, options.tangents),
        sides=None if sided is None else partial(_sides, sided, points, scene.view, options),
    )
    return Part(inputs, options, sided)


def parts_of(batch: Batch, scene: Scene, options: LightOptions) -> Iterator[Part]:
    """Yield the inputs of the light of several joined meshes, see :func:`part_of`."""

    def kept(mesh: Foreign) -> Sided:
        return computed_normals(mesh, block=batch.block, owner=batch.owner)

    part = part_of(batch.mesh, "", scene, options, kept_normals=kept, block=batch.block)
    part = part._replace(numbers=batch.numbers, ends=batch.ends)
    sided, border = part.sided, np.ones(len(batch.numbers), dtype=np.bool_)
    if sided is not None and options.facing == "auto" and part.inputs.two_sided:
        border = np.bincount(batch.block, sided.open > 0) > 0
    if border.all():
        yield part
        return
    # Without a view the sides of open meshes alone are lit alike.
    for two_sided in (False, True):
        yield _some(part, batch, border == two_sided, two_sided=two_sided)


def _some(part: Part, batch: Batch, chosen: Bools, *, two_sided: bool) -> Part:
    """Return the inputs of the light of some of several meshes."""
    rows = np.flatnonzero(chosen[batch.block])
    arrays: Keywords = {name: x[:][rows] for name, x in part.inputs.arrays().items()}
    inputs = dataclasses.replace(part.inputs, two_sided=two_sided, sides=None, **arrays)
    sided = part.sided and part.sided.of_blocks(chosen, rows)
    numbers = np.asarray(part.numbers)[chosen].tolist()
    ends = np.cumsum(np.append(0, np.diff(part.ends)[chosen]))
    return part._replace(inputs=inputs, sided=sided, numbers=numbers, ends=ends)


def share_of(mesh: Dataset, name: str | None, path: str = "") -> Array | None:
    """Return the point array of one component that is the share of the ambient light."""
    if name is None:
        return None
    array = named(mesh.GetPointData(), name)
    if array is None or array.ndim != 1:
        got = repr(name) if array is None else f"{name!r} with {array.shape[1]} components"
        remedy = "vizlight.sky(mesh) makes the array 'sky'"
        expected = "the name of a point array of 1 component"
        with _check.in_block(path):
            raise _check.value_error("occlusion", expected, got, remedy)
    return _check.floats("occlusion", array)


def _sides(sided: Sided, points: ArraySource, view: View | None, options: LightOptions) -> Sides:
    """Return normals before they are turned to the visible side, and their turn."""
    # Which side of a height field is seen is a matter of all of its points.
    averted = sided.averted_fields(points, view)

    def turned(normals: Array, facts: Array, points: Array) -> Array:
        if options.facing not in ("auto", "eye") or view is None:
            return normals
        # Facts come interpolated, and rounding may have moved the number of a piece.
        at_point = Sided(normals, lean=facts[:, 0], open=np.rint(facts[:, 1]).astype(np.intp))
        return Turned(at_point, points, view, options.facing, averted)[:]

    return Sides(sided.vectors, sided.facts(), turned)


def _tangents(
    mesh: Dataset, n: int, options: LightOptions, kept: Callable[[Foreign], Array | None] | None
) -> Array | None:
    """Return the tangents in the options, or the lines' own for a mesh of lines."""
    if options.tangents is not None:
        return tangents_of(mesh, options.tangents, n)
    if n == 3 and polylines.has_lines_only(mesh):
        kept_rows = None if kept is None else kept(mesh)
        return polylines.line_tangents(mesh) if kept_rows is None else kept_rows
    return None


def _several(mesh: Dataset, sided: Sided) -> tuple[Array | None, Sided, Array | None]:
    """Return tangents, normals and dimensions of the points of a mesh of several kinds of cells.

    Where a point is not lit by an input, this is a direction of any length but 0.
    """
    carried = np.any(sided.vectors, axis=1) & (not sided.computed)
    kinds = polylines.dimensions(mesh, carried)
    if kinds is None:
        return None, sided, None
    tangents, vectors = polylines.line_tangents(mesh), sided.vectors.copy()
    tangents = tangents.astype(vectors.dtype)
    # A vector of length 0 would make the engine call the point one that cannot be lit.
    tangents[(kinds != 1) & ~np.any(tangents, axis=1)] = 1
    vectors[kinds < 2] = 1
    return tangents, dataclasses.replace(sided, vectors=vectors), kinds


def _check_options(tangents: Array | None, n: int, options: LightOptions) -> None:
    """Check that the options fit a surface, or its tangents if any."""
    one_line = tangents is not None and n == 3 and tangents.shape[1:] == (3,)
    if options.model == "cylinder" and not one_line:
        components = "" if tangents is None else f"{n}-space, {tangents.shape[-1]} components"
        raise ValueError(not_a_line(components or "a surface"))
    if tangents is None:
        if options.conditioned:
            remedy = "leave it out: a surface without tangents has its attached shadow in any case"
            raise _check.value_error("conditioned", "tangents to condition", None, remedy)
    elif not options.conditioned or isinstance(options.conditioned, str):
        _refuse_sides(options)


def _refuse_sides(options: LightOptions) -> None:
    """Raise ValueError if an option fits only a surface, which has two sides."""
    for name in ("normals", "facing"):
        value = getattr(options, name)
        # An array of normals has no truth value, and compares with a text element by element.
        if not (value is None or value is False or (isinstance(value, str) and value == "auto")):
            remedy = "pass conditioned=True, or leave one of them out"
            expected = f"no {name} beside tangents, which have no sides"
            raise _check.value_error(name, expected, "both", remedy)
