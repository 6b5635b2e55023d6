"""The arrays of a mesh that the engine lights, selected by the options of a filter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vizlight import _check
from vizlight.mesh import polylines, splitting
from vizlight.mesh.normals import normals_of, onlooker
from vizlight.mesh.point_arrays import points_of, tangents_of
from vizlight.shading.decide import not_a_line
from vizlight.shading.inputs import ShadingInputs

if TYPE_CHECKING:
    import pyvista as pv

    from vizlight._types import Array
    from vizlight.scene import Scene
    from vizlight.shading.options import LightOptions


def inputs_of(mesh: pv.DataSet, path: str, scene: Scene, options: LightOptions) -> ShadingInputs:
    """Return the inputs of the engine from one mesh; an error names the path of its block.

    Raises
    ------
    TypeError, ValueError
        If an array is missing or does not fit, or options contradict each other.
    """
    try:
        points = points_of(mesh, options.positions)
        n = int(points.shape[1])
        tangents = _tangents(mesh, n, options)
        _check_options(tangents, n, options)
        base = normals = None
        if isinstance(options.conditioned, str):
            base = tangents_of(
                mesh,
                options.conditioned,
                n,
                average_cells=options.average_cells,
                argument="conditioned",
            )
        elif tangents is None or options.conditioned:
            normals = normals_of(mesh, options.normals, n, onlooker(scene))
            if options.flip_normals:
                normals = -_check.floats("normals", normals)
    except (TypeError, ValueError) as error:
        if not path:
            raise
        raise type(error)(f"block {path}: {error}") from error
    return ShadingInputs(
        points=points,
        tangents=tangents,
        normals=normals,
        base_tangents=base,
        cells=lambda: splitting.simplices(mesh),
    )


def _tangents(mesh: pv.DataSet, n: int, options: LightOptions) -> Array | None:
    """Return the tangents in the options, or those of a mesh of lines."""
    if options.tangents is not None:
        return tangents_of(mesh, options.tangents, n, average_cells=options.average_cells)
    if n == 3 and polylines.has_lines_only(mesh):
        return polylines.line_tangents(mesh)
    return None


def _check_options(tangents: Array | None, n: int, options: LightOptions) -> None:
    """Check that the options fit a surface, or tangents if there are any."""
    one_line = tangents is not None and n == 3 and tangents.shape[1:] == (3,)
    if options.model == "cylinder" and not one_line:
        components = "" if tangents is None else f"{n}-space, {tangents.shape[-1]} components"
        raise ValueError(not_a_line(components or "a surface"))
    if tangents is None:
        if options.conditioned:
            remedy = "leave it out: a surface without tangents has its attached shadow in any case"
            raise ValueError(_check.message("conditioned", "tangents to condition", None, remedy))
    elif not options.conditioned or isinstance(options.conditioned, str):
        _refuse_sides(options)


def _refuse_sides(options: LightOptions) -> None:
    """Raise ValueError if an option fits only a surface, which has two sides."""
    for name in ("normals", "two_sided", "flip_normals"):
        value = getattr(options, name)
        if value is not None and value is not False:
            remedy = "pass conditioned=True, or leave one of them out"
            expected = f"no {name} beside tangents, which have no sides"
            raise ValueError(_check.message(name, expected, "both", remedy))
