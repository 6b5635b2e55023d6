"""Light a mesh by its tangents or by its normals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.filters import lighting
from vizlight.filters.lighting import Job
from vizlight.mesh import point_arrays, polylines
from vizlight.scene import Scene

if TYPE_CHECKING:
    from vizlight.shading import engine


def illuminate(
    mesh: Any,
    /,
    scene: Scene,
    *,
    tangents: Any = None,
    positions: str | None = None,
    normals: Any = None,
    conditioned: bool | str = False,
    two_sided: bool = False,
    flip_normals: bool = False,
    compensate: bool = True,
    model: engine.Model = "phong",
    highlight_error: float = 0.0,
    tolerance: float = 0.0,
    terminator: float = 0.0,
    average_cells: bool = False,
    components: bool = False,
    precision: engine.Precision | None = None,
    threads: int | None = None,
    name: str = lighting.DEFAULT_NAME,
    inplace: bool = False,
    progress_bar: bool = False,
) -> Any:
    """Light a mesh and return it with the light as point scalars.

    With ``tangents`` each point is lit as a k-manifold: by one vector a point as a line, by k
    vectors as what they span. Without, a mesh of lines is lit by its own tangents, any other by
    the normals of its surface (codimension 1).

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Not changed, unless ``inplace``.
    scene : Scene
        Lights, material and view, in the mesh's unit.
    tangents : str or array_like, optional
        A point array of ``k n`` components (k vectors of n, row after row), or its values.
        Vectors of any length: they are orthonormalised.
    positions : str, optional
        A point array of n components that places the points in n-space; default the mesh's own.
    normals : str or array_like, optional
        Outward normals, a point array of n components or its values. Default: the mesh's active
        normals as they are (clear them after moving points), else those of its surface: outward
        if it is closed; if it is open, each piece as a whole rather toward the eye and away from
        its own centroid.
    conditioned : bool or str, default: False
        Tangents inherit the surface's self-shadow: diffuse and specular of each light times
        ``max(0, N . wi)`` (Banks 6). A surface of codimension 2 or more has no sides and no such
        shadow: give the name of a point array with its j tangents, ``"frame"`` for one, and its
        own brightness ``sin(a)^p(j, n)`` is the factor. In codimension 1 that is ``|N . wi|``.
    two_sided : bool, default: False
        Light the far side of a surface as the near one: ``|N . wi|``.
    flip_normals : bool, default: False
        Turn the normals over.
    compensate : bool, default: True
        Diffuse with the exponent p(k, n), which gives lines a surface's contrast (Banks 5).
    model : {"phong", "blinn", "cylinder"}
        The law of the highlight. ``"cylinder"``, for lines in 3-space, is the exact light of a
        thin cylinder, diffuse and specular (Blinn's), by which the others are measured.
        A mean over the width is dimmer than a line's brightest normal: raise the coefficients.
    highlight_error : float, default: 0.0
        How far, in pixel values of 255, Phong's highlight may be off for speed: under a parallel
        view and lights at infinity Blinn's, of the best power, may then take its place.
        :meth:`vizlight.engine.Plan.explain` tells what was chosen, and the bound.
    tolerance : float, default: 0.0
        How far ``luminance`` may be off for speed, such as 1/255: the cheapest evaluation whose
        stated bound is within it is taken, see :func:`vizlight.engine.plan`. Where rounding has
        no bound for all data (several tangents a point, a cylinder, Blinn's law with eye or light
        near) that is float64, which takes longer for float32 data. 0: the exact forms.
    terminator : float, default: 0.0
        A surface's highlight ends sharply where the light does. This is the ``N . wi``, up to 1,
        below which it fades smoothly instead; what that takes from it at most is
        :func:`vizlight.model.highlights.terminator_error`.
    average_cells : bool, default: False
        Allow cell data as tangents, averaged to the points.
    components : bool, default: False
        Add the arrays ``ambient``, ``diffuse`` and ``specular``, before any depth cue.
    precision : {"float32", "float64"}, optional
        Default: that of the tangents or normals, or what ``tolerance`` allows.
    threads : int, optional
        Default: the processors that this process may use.
    name : str, default: "luminance"
        Of the result. Under another name the further arrays are ``<name>_diffuse`` and so on.
    inplace : bool, default: False
        Attach the result to the mesh itself.
    progress_bar : bool, default: False
        Show progress on standard error.

    Returns
    -------
    pyvista.DataSet or pyvista.MultiBlock
        The mesh with the point array ``luminance`` (active scalars); ``rgb`` where the scene
        has a colour; ``luminance_valid`` where some point could not be lit; and the field array
        ``luminance_provenance``, which :func:`vizlight.provenance` reads.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If an array is missing, is cell data, or has the wrong number of components; if there
        is no surface to take normals from; if the scene lacks a view that it needs.

    Warns
    -----
    UserWarning
        Once, with the count, if points could not be lit: a zero, infinite or NaN vector,
        dependent tangents, or no normal. They have the ambient light.

    Notes
    -----
    Error bounds: :func:`vizlight.engine.shade`. Sources: Banks (1) to (6), Lecture.

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
    options = dict(locals())
    for own in ("mesh", "scene", "threads", "inplace", "progress_bar"):
        del options[own]
    _check.instance("scene", scene, Scene)
    point_arrays.check(mesh)

    out = mesh if inplace else _copy(mesh)
    leaves = list(point_arrays.named_leaves(out))
    lighting.refuse_overwriting(leaves, name, components=components, colored=scene.colored)
    jobs = [prepare(leaf, path, scene, options) for leaf, path in leaves]
    results, fitted = lighting.light(
        jobs,
        scene,
        threads=threads,
        progress_bar=progress_bar,
        precision=precision,
        model=model,
        highlight_error=highlight_error,
        tolerance=tolerance,
        compensate=compensate,
        two_sided=two_sided,
        terminator=terminator,
        components=components,
    )
    # Nothing is attached before all is computed: a failure leaves the mesh as it was.
    lighting.finish([leaf for leaf, _ in leaves], results, "illuminate", fitted, options, name)
    return out


def _copy(mesh: Any) -> Any:
    """Return a mesh that shares its arrays but may get new ones."""
    if not isinstance(mesh, pv.MultiBlock):
        return mesh.copy(deep=False)
    out = pv.MultiBlock()
    for i in range(mesh.n_blocks):
        block = mesh[i]
        out.append(None if block is None else _copy(block), mesh.get_block_name(i))
    for key, value in mesh.field_data.items():
        out.field_data[key] = value
    return out


def prepare(mesh: pv.DataSet, path: str, scene: Scene, options: dict[str, Any]) -> Job:
    """Take from one mesh what is lit; a block's errors say which block it is."""
    try:
        points = point_arrays.points_of(mesh, options["positions"])
        n = points.shape[1]
        tangents = normals = carrier = None
        conditioned = options["conditioned"]
        if options["tangents"] is not None:
            tangents = point_arrays.tangents_of(
                mesh, options["tangents"], n, average_cells=options["average_cells"]
            )
        elif n == 3 and polylines.has_lines_only(mesh):
            tangents = polylines.line_tangents(mesh)
        one_line = tangents is not None and n == 3 and tangents.shape[1:] == (3,)
        if options["model"] == "cylinder" and not one_line:
            remedy = "model='blinn' is its like for other manifolds"
            got = "a surface" if tangents is None else f"{n}-space, {tangents.shape[-1]} components"
            raise ValueError(
                _check.message("model", "lines in 3-space for 'cylinder'", got, remedy)
            )
        if not isinstance(conditioned, str | bool | np.bool_):
            expected = "True, False or the name of a point array"
            raise TypeError(_check.message("conditioned", expected, _check.describe(conditioned)))
        if tangents is None and conditioned:
            remedy = "a surface without tangents shadows itself as it is"
            raise ValueError(_check.message("conditioned", "tangents to condition", None, remedy))
        if isinstance(conditioned, str):
            carrier = point_arrays.tangents_of(
                mesh,
                conditioned,
                n,
                average_cells=options["average_cells"],
                argument="conditioned",
            )
            conditioned = False
        if tangents is not None and not conditioned:
            for option in ("normals", "two_sided", "flip_normals"):
                if options[option] is not None and options[option] is not False:
                    remedy = "pass conditioned=True, or leave one of them out"
                    expected = f"no {option} beside tangents, which have no sides"
                    raise ValueError(_check.message(option, expected, "both", remedy))
        if tangents is None or conditioned:
            normals = point_arrays.normals_of(
                mesh, options["normals"], n, point_arrays.onlooker(scene)
            )
            if options["flip_normals"]:
                normals = -_check.floats("normals", normals)
        return Job(points, tangents, normals, carrier)
    except (TypeError, ValueError) as error:
        if not path:
            raise
        raise type(error)(f"block {path}: {error}") from error
