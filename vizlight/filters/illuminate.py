"""Light a mesh by its tangents or by its normals."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Exponent, Facing, FeatureAngle, Model, Precision
from vizlight.filters import lighting
from vizlight.filters.sky import with_sky
from vizlight.mesh import blocks, bundles, normals, refining
from vizlight.mesh.blocks import MeshT
from vizlight.scene import Scene
from vizlight.scene.keywords import named
from vizlight.scene.presets import AnyScene, as_scene
from vizlight.shading.options import Bundle, LightOptions
from vizlight.vtk.arrays import is_of_cells, points_of
from vizlight.vtk.normals import Sided, Vote
from vizlight.vtk.parts import Part, uses_normals


@named
def illuminate(
    mesh: MeshT,
    /,
    scene: AnyScene | None = None,
    *,
    tangents: str | ArrayLike | None = None,
    positions: str | None = None,
    normals: str | ArrayLike | None = None,
    facing: Facing = "auto",
    feature_angle: FeatureAngle = None,
    conditioned: bool | str | None = False,
    line_field: bool = False,
    bundle: bool | Bundle = False,
    occlusion: str | None = None,
    name: str = "luminance",
    exponent: Exponent = "compensated",
    model: Model = "phong",
    components: bool = False,
    precision: Precision | None = None,
    inplace: bool = False,
    progress_bar: bool = False,
) -> MeshT:
    """Light a mesh and return it with the light as point scalars.

    With ``tangents`` each point is lit as a k-manifold: by one vector per point as a line, by k
    vectors as the space that they span. Without, a mesh of lines is lit by its own tangents, any
    other by the normals of its surface (codimension 1). In a mesh in 3-space that has lines and
    vertices beside its faces, points that are on no face are lit as lines by their own tangents,
    and vertices by the normals that the mesh has, else as they face the eye.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh that is lit; not changed, unless ``inplace``.
    scene : Scene or str, optional
        Lights, material and view, in the unit of the mesh. Default: ``Scene()``, which has no
        view: the highlight is left out, and its light follows :meth:`vizlight.View.isometric`.
    tangents : str, names of components or array_like, optional
        Name of a point array of ``k n`` components (k vectors of n, row after row), or its values.
        The vectors may have any length: they are orthonormalised. A cell array is averaged to the
        points as lines without sign, with a warning. Names of two or three arrays of one component,
        as a tuple or as ``"u,v"``, are those of components.
    positions : str, optional
        Name of a point array of n components with the places of the points in n-space. Default:
        the points of the mesh.
    normals : str or array_like, optional
        Name of a point array of n components with normals, or its values. Default: the active
        normals of the mesh (clear them after moving points), else the normals of its surface, which
        stay with the result as ``vizlight_normals`` from 256 points on.
    facing : {"auto", "eye", "outward", "as given"}
        Side of the surface that is lit. ``"auto"``: each connected piece that is closed faces
        outward, any other faces the eye at every point (with ``normals`` that are given the mesh
        counts as one piece); a height field has one side, that of the eye, wherever a face beside
        the point is seen from there. ``"eye"``: every point faces the eye,
        whatever piece it belongs to; with ``normals`` from data a surface in parts is then lit
        as the whole. ``"outward"``: each piece faces outward as a whole, an open one away from its
        centroid. ``"as given"``: normals as they are; computed ones follow the order of the corners
        of the faces. Without a view both sides are lit alike where the eye would choose.
    feature_angle : float or "auto", optional
        Angle in degrees between two faces above which points on their common edge are split, so
        that light does not bend across it; only for normals that are computed. ``"auto"``: 30 if
        the sharp edges are creases, which stand apart from the others, else none is split.
        Default: none is split.
    conditioned : bool or str, default: False
        Whether tangents inherit the self-shadow of the surface: diffuse and specular term of each
        light times ``max(0, N . wi)`` (Banks 6). A surface of codimension 2 or more has no sides
        and no such shadow: name the point array of its j tangents, such as ``"frame"``, and its
        own brightness ``sin(a)^p(j, n)`` is the factor. In codimension 1 that is ``|N . wi|``.
    line_field : bool, default: False
        Whether the signs of ``tangents`` have no meaning, as those of eigenvectors. It matters
        between the points alone, for :func:`vizlight.refine` and :func:`vizlight.check`: vectors
        are interpolated linearly, as by VTK, and lines are turned alike before. Means of a cell
        array are lines in any case.
    bundle : bool or Bundle, default: False
        Whether lines dim one another, and surfaces among them, as a bundle of thin cylinders; a
        :class:`vizlight.Bundle` says how. The point array ``transmittance``, with one component
        per light of intensity above 0, multiplies each light; ``occlusion="sky"`` dims the ambient
        term. It is computed anew only where lines, lights or points have changed.
    occlusion : str, optional
        Name of a point array that multiplies the ambient term, such as the share of the sky that
        :func:`vizlight.sky` finds. ``"sky"``: that share is computed, with an error of 0.02 and for
        lines as for a medium, where a mesh has no array of this name. Default: the ambient term is
        the same at all points.
    name : str, default: "luminance"
        Name of the result. Under another name the further arrays are ``<name>_diffuse`` and so on.
    exponent : float or "compensated"
        Exponent of the diffuse term, above 0 and up to 1e6. ``"compensated"`` is p(k, n), which
        gives lines the contrast of a surface (Banks 5); 1 is the plain law; under lamps of several
        colours in the picture plane 2 makes hue a code of direction. It has no effect on a
        cylinder.
    model : {"phong", "blinn", "cylinder"}
        Reflection model of the highlight. ``"cylinder"``, for lines in 3-space, is the exact light
        of a thin cylinder, diffuse and specular (Blinn's), by which the others are measured. As a
        mean over the width it is dimmer than the brightest normal of a line: raise the
        coefficients.
    components : bool, default: False
        Whether the terms ``ambient``, ``diffuse`` and ``specular`` are kept, before any depth cue.
    precision : {"float32", "float64"}, optional
        Precision of the work and the result. Default: the precision of the tangents or normals.
    inplace : bool, default: False
        Whether the result is attached to the mesh itself, without a copy. Else the result shares
        no memory with the mesh; ``illuminate(mesh.copy(deep=False), ..., inplace=True)`` saves the
        copy where a shared result is wanted.
    progress_bar : bool, default: False
        Whether progress is shown on standard error.

    Returns
    -------
    pyvista.DataSet or pyvista.MultiBlock
        The mesh with the point array ``luminance`` (active scalars); ``rgb`` where the scene
        has a colour; ``luminance_valid`` where some point could not be lit; and the field array
        ``luminance_provenance``, which :func:`vizlight.provenance` reads. Normals that had to be
        computed, for 256 points or more, stay as ``vizlight_normals``, so that the result is lit
        again in a fraction of the time, as long as points and cells have not changed.

    Raises
    ------
    TypeError
        If an argument is of the wrong type, or a keyword is unknown.
    ValueError
        If an array is missing, is cell data, or has the wrong number of components; if there
        is no surface to take normals from; if the scene has a depth cue and no view.

    Warns
    -----
    UserWarning
        Once, with the count, if points could not be lit: a zero, infinite or NaN vector,
        dependent tangents, or no normal. They have the ambient light. Points inside a volume
        are not counted. Once, if many edges are sharp and normals are averaged across them; once,
        if the normals of a mesh lean from its faces by more than 60 degrees on a quarter of it.

    Notes
    -----
    Error bounds: :func:`vizlight.shading.engine.shade`. Sources: Banks (1) to (6), Lecture.

    ``bundle`` costs one grid for each light.

    Examples
    --------
    >>> import pyvista as pv, vizlight
    >>> scene = vizlight.Scene(
    ...     lights=vizlight.Light(direction=(1, 1, 1)), view=vizlight.View(direction=(0, 0, 1))
    ... )
    >>> lit = vizlight.illuminate(pv.Sphere(), scene)
    >>> lit.active_scalars_name
    'luminance'
    """
    asked = LightOptions.of(locals())
    return light_mesh(mesh, scene, asked, inplace=inplace, progress_bar=progress_bar)


def light_mesh(
    mesh: MeshT,
    scene: AnyScene | None,
    options: LightOptions,
    *,
    inplace: bool = False,
    progress_bar: bool = False,
    vote: Vote | None = None,
    known: Sided | None = None,
) -> MeshT:
    """Light a mesh by options that are checked; see :func:`illuminate`.

    ``vote`` is the decision of the whole about its sides, where the mesh is a part of one, and
    ``known`` are the normals of a dataset that were computed already.
    """
    scene = as_scene(scene)
    inplace = _check.boolean("inplace", inplace)
    taken, parts = parts_of(mesh, scene, options, vote, known, joined=True)
    return light_parts(
        mesh, taken, parts, scene, options, inplace=inplace, progress_bar=progress_bar
    )


def parts_of(
    mesh: MeshT,
    scene: Scene,
    options: LightOptions,
    vote: Vote | None = None,
    known: Sided | None = None,
    *,
    joined: bool = False,
) -> tuple[list[pv.DataSet], list[Part]]:
    """Return the datasets of a mesh, with the points that are lit, and what they are lit by.

    With ``joined`` small datasets of one kind have one part, else each has one of its own.
    """
    named = blocks.check(mesh)
    lighting.refuse_overwriting(
        named, options.name, scene, components=options.components, bundle=bool(options.bundle)
    )
    if options.feature_angle is not None:
        normals.compute_ahead(block for block, _ in named if normals.are_computed(block, options))
    # Points are split first: normals, sky and light then belong to the points of the result.
    split = [_split(block, path, options) for block, path in named]
    own = [block for block, _ in split]
    # A sky that is named and missing is found for all blocks at once, since they hide it from one
    # another.
    taken = with_sky(own, options.occlusion, finer=options.feature_angle is not None)
    # Where the sky asked for smaller triangles, their points have normals of their own.
    known_of = [
        sided or known if one.n_points == other.n_points else None
        for (one, sided), other in zip(split, taken, strict=True)
    ]
    paths = [path for _, path in named]
    parts = lighting.parts_of(taken, paths, scene, options, known_of, vote, joined=joined)
    _tell_of_averages(named, options)
    return taken, parts


def light_parts(
    mesh: MeshT,
    taken: Sequence[pv.DataSet],
    parts: list[Part],
    scene: Scene,
    options: LightOptions,
    *,
    inplace: bool = False,
    progress_bar: bool = False,
) -> MeshT:
    """Light what :func:`parts_of` returned, and return it in the place of a mesh.

    ``parts`` is emptied, since a copy of the mesh may need the memory.
    """
    inputs = [part.inputs for part in parts]
    dimmings: list[bundles.Dimming] = []
    if isinstance(options.bundle, Bundle):
        inputs, dimmings = lighting.dimmed(
            taken, inputs, scene, options.bundle, options.name, show=progress_bar
        )
    found, fitted = lighting.light(
        [(given, part.options) for given, part in zip(inputs, parts, strict=True)],
        scene,
        progress_bar=progress_bar,
    )
    by_number = dict(
        itertools.chain.from_iterable(map(Part.shadings, parts, found))  # of each dataset
    )
    shadings = [by_number[i] for i in range(len(taken))]
    # Of normals that do not stay with a mesh only the facts are kept, which the warnings below
    # need.
    of_number = dict(pair for part in parts for pair in normals.to_keep(taken, part))
    sides = [of_number[i] for i in range(len(taken))]
    rounded = max((_rounding(taken, part, options) for part in parts), default=0.0)
    inside = sum(int(np.sum(part.sided.inside)) for part in parts if part.sided is not None)
    # Nothing is attached before all is computed: a failure leaves the mesh as it was.
    inputs.clear()
    parts.clear()
    out, lit = blocks.placed(mesh, taken, inplace=inplace)
    for block, kept in zip(lit, sides, strict=True):
        if kept is not None:
            normals.keep(block, kept)
        # An earlier refinement measured the error of another light.
        refining.forget(block, options.name)
    lighting.finish(
        lit, shadings, "illuminate", fitted, options, options.name, inside=inside, dimmings=dimmings
    )
    normals.warn_of_rounding(rounded)
    _warn_of_normals(lit, sides, options)
    return out


def _tell_of_averages(named: list[tuple[pv.DataSet, str]], options: LightOptions) -> None:
    """Warn once of each cell array whose means at the points are the tangents."""
    for argument in ("tangents", "conditioned"):
        name: object = getattr(options, argument)
        if isinstance(name, str) and any(is_of_cells(block, name) for block, _ in named):
            _check.warn(
                f"{argument}: the cell array {name!r} is averaged to the points, whatever the "
                "signs; mesh.cell_data_to_point_data() keeps them"
            )


def _split(mesh: pv.DataSet, path: str, options: LightOptions) -> tuple[pv.DataSet, Sided | None]:
    """Return a mesh with points split at its sharp edges, if its normals will be computed.

    Where there is nothing to split they may be known then.
    """
    angle = options.feature_angle
    if angle is None or not uses_normals(mesh, options):
        return mesh, None
    # Normals that are given say themselves where edges are sharp: there is nothing to split.
    if not normals.are_computed(mesh, options):
        if options.normals is None:
            normals.warn_of_idle(mesh, angle)
        return mesh, None
    with _check.in_block(path):
        if not isinstance(mesh, pv.PolyData):
            expected, got = "a pyvista.PolyData, whose points can be split", type(mesh).__name__
            remedy = "take the mesh's extract_surface()"
            raise _check.value_error("feature_angle", expected, got, remedy)
        # An array without a name has no rows for the points that are split off.
        expected, remedy = "the name of a point array beside feature_angle=", "attach the array"
        _check.instance("tangents", options.tangents, str | None, expected, remedy=remedy)
    if options.facing == "as given":
        return normals.split_edges(mesh, angle), None
    return normals.split_or_normals(mesh, angle)


def _rounding(meshes: Sequence[pv.DataSet], part: Part, options: LightOptions) -> float:
    """Return the rounding of the points from which the normals of a part are computed."""
    if part.sided is None or not part.sided.computed:
        return 0.0
    if options.positions is None:
        return normals.rounding(part.inputs.points, part.ends)
    return max(normals.rounding(points_of(meshes[i], None)) for i in part.numbers)


def _warn_of_normals(
    meshes: Sequence[pv.DataSet], sides: Sequence[Sided | None], options: LightOptions
) -> None:
    """Warn if normals were averaged across many sharp edges, or do not fit the faces."""
    known = [(mesh, own) for mesh, own in zip(meshes, sides, strict=True) if own is not None]
    # With an angle the sharp edges are split already, and nothing is averaged across them.
    if options.feature_angle is None:
        splits = all(isinstance(mesh, pv.PolyData) for mesh in meshes)
        sharp = max((float(own.sharp) for _, own in known), default=0.0)
        normals.warn_of_edges(sharp, splits)
    # Normals may belong to positions in n-space, and faces in 3-space say nothing of those.
    if options.positions is None:
        given = [mesh for mesh, own in known if not own.computed]
        normals.warn_of_contradiction(given, options.normals, options.feature_angle)
