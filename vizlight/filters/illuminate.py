"""Light a mesh by its tangents or by its normals."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import pyvista as pv

from vizlight import _check
from vizlight.filters import lighting
from vizlight.mesh import blocks, refining
from vizlight.mesh.inputs import inputs_of
from vizlight.scene import Scene
from vizlight.shading.options import LightOptions, accepts

if TYPE_CHECKING:
    from collections.abc import Iterator

    from typing_extensions import Unpack

    from vizlight.mesh.blocks import MeshT
    from vizlight.shading.options import LightKeywords


@accepts(LightOptions)
def illuminate(
    mesh: MeshT,
    /,
    scene: Scene,
    *,
    threads: int | None = None,
    inplace: bool = False,
    progress_bar: bool = False,
    **options: Unpack[LightKeywords],
) -> MeshT:
    """Light a mesh and return it with the light as point scalars.

    With ``tangents`` each point is lit as a k-manifold: by one vector per point as a line, by k
    vectors as the space that they span. Without, a mesh of lines is lit by its own tangents, any
    other by the normals of its surface (codimension 1).

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh that is lit; not changed, unless ``inplace``.
    scene : Scene
        Lights, material and view, in the unit of the mesh.
    **options
        Fields of LightOptions.
    threads : int, optional
        Number of threads. Default: the processors that this process may use.
    inplace : bool, default: False
        Whether the result is attached to the mesh itself.
    progress_bar : bool, default: False
        Whether progress is shown on standard error.

    Returns
    -------
    pyvista.DataSet or pyvista.MultiBlock
        The mesh with the point array ``luminance`` (active scalars); ``rgb`` where the scene
        has a colour; ``luminance_valid`` where some point could not be lit; and the field array
        ``luminance_provenance``, which :func:`vizlight.provenance` reads. With ``refine`` it
        consists of triangles or polylines with more points, as :func:`vizlight.refine` returns it.

    Raises
    ------
    TypeError
        If an argument is of the wrong type, or a keyword is unknown.
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
    asked = LightOptions(**options)
    if asked.refine and _check.boolean("inplace", inplace):
        expected, remedy = "False for a mesh that gets new points", "leave it out"
        raise ValueError(_check.message("inplace", expected, inplace, remedy))
    return light_mesh(
        mesh, scene, asked, threads=threads, inplace=inplace, progress_bar=progress_bar
    )


def light_mesh(
    mesh: MeshT,
    scene: Scene,
    options: LightOptions,
    *,
    threads: int | None = None,
    inplace: bool = False,
    progress_bar: bool = False,
    max_points: int | None = None,
) -> MeshT:
    """Light a mesh by options that are checked; see :func:`illuminate`.

    With ``options.refine`` the result is a new mesh, also with ``inplace``.
    """
    _check.instance("scene", scene, Scene)
    blocks.check(mesh)
    out = mesh if _check.boolean("inplace", inplace) else shallow_copy(mesh)
    named = list(blocks.named_blocks(out))
    lighting.refuse_overwriting(
        named, options.name, components=options.components, colored=scene.colored
    )
    parts = [(inputs_of(block, path, scene, options), options) for block, path in named]
    rest: list[refining.Left] = []
    if options.refine:
        fitted = lighting.fit_depth_cue(scene, [inputs for inputs, _ in parts])
        refined = [
            refining.refined(block, path, inputs, fitted, options, max_points, threads)
            for (block, path), (inputs, _) in zip(named, parts, strict=True)
        ]
        refining.warn_of_rest(refined, options.refine)
        out = _replaced(out, iter([mesh for mesh, _, _ in refined]))
        named = list(blocks.named_blocks(out))
        parts = [(inputs, options) for _, inputs, _ in refined]
        rest = [left for _, _, left in refined]
    results, fitted = lighting.light(parts, scene, threads=threads, progress_bar=progress_bar)
    # Nothing is attached before all is computed: a failure leaves the mesh as it was.
    meshes = [block for block, _ in named]
    lighting.finish(meshes, results, "illuminate", fitted, options, options.name)
    for (block, _), left in zip(named, rest, strict=False):
        block.field_data[f"{options.name}_error"] = [left.error, left.share]
    return out


def _replaced(mesh: MeshT, made: Iterator[pv.DataSet]) -> MeshT:
    """Return the next of some datasets for a dataset, a MultiBlock of them for a MultiBlock."""
    if not isinstance(mesh, pv.MultiBlock):
        return cast("MeshT", next(made))
    for i in range(mesh.n_blocks):
        block = mesh[i]
        if block is not None:
            mesh.replace(i, _replaced(block, made))
    return mesh


def shallow_copy(mesh: MeshT) -> MeshT:
    """Return a mesh that shares its arrays but may get new ones."""
    if not isinstance(mesh, pv.MultiBlock):
        return mesh.copy(deep=False)
    out = type(mesh)()
    for i in range(mesh.n_blocks):
        block = mesh[i]
        out.append(None if block is None else shallow_copy(block), mesh.get_block_name(i))
    for key, value in mesh.field_data.items():
        out.field_data[key] = value
    return out
