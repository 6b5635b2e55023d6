"""Turn, cut and project what a mesh carries in n-space, and light it before or after."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any, Literal, get_args

import pyvista as pv

from vizlight import _check, _progress
from vizlight.filters.illuminate import illuminate
from vizlight.filters.lighting import DEFAULT_NAME
from vizlight.geometry.nspace import projection
from vizlight.mesh import point_arrays
from vizlight.mesh.nspace import FRAME, POSITION, PROJECTED, Counter, Turning
from vizlight.mesh.records import provenance, retell
from vizlight.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

LightWhen = Literal["before", "after"]
#: Options of light that may come along; the others are this filter's own to set.
LIGHTING = set(inspect.signature(illuminate).parameters) - {
    "mesh", "scene", "positions", "inplace", "progress_bar",
}  # fmt: skip
#: What is no option of the record: the scene is told beside them.
UNTOLD = ("mesh", "scene", "options", "progress_bar")


def project(
    mesh: Any,
    /,
    *,
    rotation: Any = None,
    hyperplane: Any = None,
    distance: float | None = None,
    positions: str = POSITION,
    frame: str | None = FRAME,
    vectors: str | Sequence[str] | None = None,
    cut: bool = False,
    scene: Scene | None = None,
    light: LightWhen = "before",
    progress_bar: bool = False,
    **options: Any,
) -> Any:
    """Turn a mesh in n-space, cut it by a hyperplane, project it to 3-space; light it on the way.

    VTK's own transforms leave arrays of positions and frames alone; here they turn together.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Not changed. An image or a rectilinear grid becomes a structured grid.
    rotation : optional
        A matrix of SO(n), ``("xw", angle)`` with the angle in radians, or a list of these, the
        first done first; see :func:`vizlight.geometry.projection.rotation`.
    hyperplane : (normal, offset), optional
        Keep where the turned mesh meets ``{x : x . normal / |normal| = offset}``: a
        (k - 1)-manifold. Point arrays of numbers are interpolated, the frame as the space that it
        spans, whatever its basis at each point, and cut down to the directions within.
    distance : float, optional
        Of the eye on the last axis from the origin, in the mesh's unit: a perspective projection
        on the hyperplane across it. Default: orthographic, the first three coordinates.
    positions : str, default: "position"
        The point array of n components that says where the points are in n-space.
    frame : str or None, default: "frame"
        The point array of k n components, the tangents, row after row. None: there is none.
    vectors : str or sequence of str, optional
        Further point arrays of m n components, vectors in n-space that turn with the mesh.
    cut : bool, default: False
        Leave out points that cannot be cut or projected, those on or behind the eye's hyperplane
        or not finite, and the cells that have one, with a warning of the count; else they are an
        error.
    scene : Scene, optional
        Light the mesh by it.
    light : {"before", "after"}
        Light in n-space, with lights and eye of n components, before the projection; or in
        3-space, by the projected points and frame, after it.
    progress_bar : bool, default: False
        Show progress on standard error.
    **options
        Of :func:`illuminate`. ``tangents=`` names other tangents than the frame.

    Returns
    -------
    pyvista.DataSet or pyvista.MultiBlock
        A mesh with points in 3-space, ``position`` and ``frame`` turned, and for k < 3 the point
        array ``projected_frame``: the derivative of the projection applied to the frame,
        orthonormalised; for each array V of ``vectors`` its image ``projected_V``, of the length
        it comes to. What was done is kept as field data, ``provenance(mesh, "projection")``;
        ``luminance_provenance`` makes the light again from the mesh that was given.
        Arrays that nothing is done to, without a rotation positions and frame too, are shared with
        ``mesh``, as in PyVista's shallow copies: copy one before changing it in place.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If an array is missing or has the wrong number of components, the rotation is none, points
        cannot be projected, or there is no light for what is left: points have no tangents, and
        a 3-manifold fills 3-space.

    Warns
    -----
    UserWarning
        Once, with the count, if points are left out.

    Notes
    -----
    Where the projection flattens the tangent space (at a silhouette) ``projected_frame`` has rows
    of zero past its rank, which is what is left of unit tangents beyond rounding (see
    :func:`vizlight.geometry.projection.push_frame`). Light after the projection is there the
    ambient one, and ``luminance_valid`` marks the points; light before it knows of no silhouette.
    A frame on a cut is a mean of those at the points around, of second order in their distance,
    and zero where one of them lacks tangents.
    Error bounds: :func:`vizlight.geometry.projection.turn` and ``perspective``. Work is done in
    float64, block by block; arrays keep their type. Source: Banks, section 3.
    """
    told = {key: value for key, value in locals().items() if key not in UNTOLD}
    point_arrays.check(mesh)
    if light not in get_args(LightWhen):
        raise ValueError(_check.message("light", "'before' or 'after'", repr(light)))
    _check.instance("scene", scene, Scene, optional=True)
    for option in options:
        if option not in LIGHTING:
            expected = "an option of project or of illuminate"
            raise TypeError(_check.message(option, expected, "one that neither has"))
    if scene is None and options:
        expected = "an option of project, or scene= beside an option of illuminate"
        raise TypeError(_check.message(next(iter(options)), expected, "neither"))
    distance = None if distance is None else projection.check_distance(distance)
    names = () if vectors is None else (vectors,) if isinstance(vectors, str) else vectors
    if not isinstance(names, list | tuple):
        expected = "the name of a point array, or a list of names"
        raise TypeError(_check.message("vectors", expected, _check.describe(vectors)))
    job = Turning(rotation, hyperplane, distance, positions, frame, tuple(names), bool(cut))

    total = 2 * sum(leaf.n_points for leaf in point_arrays.leaves(mesh))
    with _progress.progress("project", total, show=progress_bar) as report:
        done = Counter(report)
        lost = Counter(lambda _: None)
        out = _each(mesh, lambda leaf: job.turned(leaf, done, lost))
        if scene is not None and light == "before":
            _check_tangents(out, job, options)
            _check_space(out, scene, light, positions)
            out = illuminate(out, scene, positions=positions, **_by(frame, options))
        out = _each(out, lambda leaf: job.projected(leaf, done, lost))
        if scene is not None and light == "after":
            _check_tangents(out, job, options, PROJECTED)
            _check_space(out, scene, light, positions)
            out = illuminate(out, scene, **_by(f"{PROJECTED}{frame}", options))
        if scene is not None:
            name = options.get("name", DEFAULT_NAME)
            for leaf in point_arrays.leaves(out):
                retell(leaf, name, "project", provenance(leaf, name)["options"] | told)
    if lost.count:
        _check.warn(
            f"{lost.count} points cannot be projected (on or behind the eye's hyperplane, or not "
            "finite) and are left out, with the cells that have one"
        )
    return out


def _each(mesh: Any, work: Callable[[Any], Any], path: str = "") -> Any:
    """Return a mesh with work done on it, or on each block; an error says which block it is."""
    if not isinstance(mesh, pv.MultiBlock):
        try:
            return work(mesh)
        except (TypeError, ValueError) as error:
            if not path:
                raise
            raise type(error)(f"block {path}: {error}") from error
    out = pv.MultiBlock()
    for i in range(mesh.n_blocks):
        name = mesh.get_block_name(i)
        done = None if mesh[i] is None else _each(mesh[i], work, f"{path}/{name or i}")
        out.append(done, name)
    for key, value in mesh.field_data.items():
        out.field_data[key] = value
    return out


def _by(tangents: str | None, options: dict[str, Any]) -> dict[str, Any]:
    """Return options of light by the frame, unless they name other tangents."""
    return options if options.get("tangents") is not None else {**options, "tangents": tangents}


def _check_space(mesh: Any, scene: Scene, light: LightWhen, positions: str) -> None:
    """Check that lights and eye live in the space that is lit: that of positions, or 3-space."""
    for leaf in point_arrays.leaves(mesh):
        n = leaf.point_data[positions].shape[1]
        lit, other, when = (n, 3, "after") if light == "before" else (3, n, "before")
        if scene.n not in (None, lit):
            remedy = f"pass light={when!r} to light in {other}-space" if scene.n == other else ""
            expected = f"vectors of {lit} components for light={light!r}"
            raise ValueError(_check.message("scene", expected, scene.n, remedy))


def _check_tangents(mesh: Any, job: Turning, options: dict[str, Any], prefix: str = "") -> None:
    """Check that there are tangents to light by; where there are none, say why."""
    if options.get("tangents") is not None:
        return
    if job.frame is None:
        raise ValueError(_check.message("frame", "tangents to light by", None, "or pass tangents="))
    for leaf in point_arrays.leaves(mesh):
        if job.frame not in leaf.point_data:
            got = "the points of a cut curve, which have no tangents"
            raise ValueError(_check.message("scene", "a mesh that can be lit", got))
        if prefix + job.frame not in leaf.point_data:
            k = leaf.point_data[job.frame].shape[1] // leaf.point_data[job.positions].shape[1]
            got = f"a {k}-manifold, which fills 3-space and has no normals there"
            remedy = "pass light='before', or cut it by hyperplane="
            raise ValueError(_check.message("light", "a curve or a surface", got, remedy))
