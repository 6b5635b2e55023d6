"""What every filter does: take the inputs of each mesh, light them all, then attach."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterable, Sequence

import numpy as np
import pyvista as pv

from vizlight import _check, _progress
from vizlight.mesh import bundles, normals, records, subdivision
from vizlight.mesh.bundles import Dimming
from vizlight.scene import Scene
from vizlight.shading import engine
from vizlight.shading.inputs import ArraySource, ShadingInputs
from vizlight.shading.options import Bundle, LightOptions, Options, ShadingOptions
from vizlight.shading.results import PARTS, VALID, Record, arrays_of, of_light, part_name, unlit
from vizlight.vtk import parts as vtk_parts
from vizlight.vtk.batches import Batch, batches
from vizlight.vtk.normals import Sided, Vote
from vizlight.vtk.parts import Part

#: Options that may name an array.
_ARRAYS = ("tangents", "normals", "positions", "conditioned", "occlusion")


def part_of(
    mesh: pv.DataSet,
    path: str,
    scene: Scene,
    options: LightOptions,
    known: Sided | None = None,
    vote: Vote | None = None,
) -> Part:
    """Return what one mesh is lit by; see :func:`vizlight.vtk.parts.part_of`.

    ``known`` are normals of its surface that were computed already, and ``vote`` is the decision of
    a whole about its sides.
    """
    part = vtk_parts.part_of(
        mesh,
        path,
        scene,
        options,
        kept_normals=normals.kept if known is None else lambda _: known,
        kept_tangents=subdivision.kept_tangents,
        vote=vote,
    )
    # Triangles are found only where something asks for them, such as a check between the points.
    cells = lambda: subdivision.simplices(mesh)  # noqa: E731
    return part._replace(inputs=dataclasses.replace(part.inputs, cells=cells))


def parts_of(
    meshes: Sequence[pv.DataSet],
    paths: Sequence[str],
    scene: Scene,
    options: LightOptions,
    known: Sequence[Sided | None],
    vote: Vote | None = None,
    *,
    joined: bool = False,
) -> list[Part]:
    """Return what meshes are lit by, each as by :func:`part_of`.

    With ``joined`` small ones of one kind are lit as one.
    """
    joint: list[Part] = []
    try:
        for batch in _batches(meshes, options, known) if joined and vote is None else ():
            joint += vtk_parts.parts_of(batch, scene, options)
    except (TypeError, ValueError):
        # One by one an error names its block.
        joint.clear()
    done = {number for part in joint for number in part.numbers}
    return joint + [
        part_of(mesh, paths[i], scene, options, known[i], vote)._replace(numbers=(i,))
        for i, mesh in enumerate(meshes)
        if i not in done
    ]


def _batches(
    meshes: Sequence[pv.DataSet], options: LightOptions, known: Sequence[Sided | None]
) -> Iterable[Batch]:
    """Return the meshes that are lit together."""
    values = [getattr(options, name) for name in _ARRAYS]
    names = [value for value in values if isinstance(value, str)]
    # An array without a name belongs to one mesh; a bundle looks at each by itself.
    without_name = any(not isinstance(value, str | bool | None) for value in values)
    if without_name or options.bundle:
        return []
    unknown = {i: mesh for i, mesh in enumerate(meshes) if known[i] is None}
    return batches(unknown, names, (normals.KEPT, subdivision.TANGENTS))


def light(
    parts: Sequence[tuple[ShadingInputs, ShadingOptions]], scene: Scene, /, *, progress_bar: bool
) -> tuple[list[engine.Shading], Scene]:
    """Light all inputs, each by its options.

    The scene that is returned has both ends of its depth cue.
    """
    # One range of depth for all parts: a cue that began anew in each block would lie.
    fitted = fit_depth_cue(scene, [inputs.points for inputs, _ in parts])
    results: list[engine.Shading] = []
    total, done = sum(inputs.count for inputs, _ in parts), 0
    with _progress.progress("light", total, show=progress_bar) as report:
        for inputs, options in parts:

            def progress(now: int, _: int, before: int = done) -> None:
                report(before + now)

            results.append(engine.run(inputs, fitted, options, progress=progress))
            done += inputs.count
    return results, fitted


def fit_depth_cue(scene: Scene, points: Sequence[ArraySource]) -> Scene:
    """Return the scene with the ends of its depth cue, taken from the points where not given."""
    cue = scene.depth_cue
    if cue is None or scene.view is None or (cue.front is not None and cue.back is not None):
        return scene
    return with_depth_ends(scene, [engine.depth_range(rows, scene) for rows in points])


def with_depth_ends(scene: Scene, ranges: Sequence[tuple[float, float]]) -> Scene:
    """Return a scene whose depth cue has ends, those that are not given from ranges of depth."""
    cue = scene.depth_cue
    assert cue is not None
    # The range of a mesh without points is (inf, -inf).
    near = min((near for near, _ in ranges if np.isfinite(near)), default=0.0)
    far = max((far for _, far in ranges if np.isfinite(far)), default=1.0)
    # An end that is given may lie beyond all points: the other is then put beyond it.
    front, back = cue.front, cue.back
    if front is None:
        front = near if back is None or near < back else back - 1.0
    if back is None:
        back = far if far > front else front + 1.0
    return scene.replace(depth_cue=dataclasses.replace(cue, front=front, back=back))


def refuse_overwriting(
    named: list[tuple[pv.DataSet, str]],
    name: str,
    scene: Scene,
    *,
    components: bool = False,
    bundle: bool = False,
) -> None:
    """Refuse a name under which the light would replace an array of the user."""
    _check.array_name("name", name)
    parts = [part for part in PARTS if (scene.colored if part == "rgb" else components)]
    parts += [bundles.TRANSMITTANCE] if bundle else []
    made = [part_name(name, part) for part in parts]
    records.refuse_overwriting(named, name, [name, name + VALID, *made])


def dimmed(
    meshes: Sequence[pv.DataSet],
    inputs: Sequence[ShadingInputs],
    scene: Scene,
    bundle: Bundle,
    name: str,
    *,
    show: bool,
) -> tuple[list[ShadingInputs], list[Dimming]]:
    """Return inputs with the shares of light that reach them inside a bundle, and these."""
    names = (name, part_name(name, bundles.TRANSMITTANCE))
    with _progress.progress("bundle", 100, show=show) as report:
        shares = bundles.dim(
            meshes, inputs, scene, bundle, names,
            progress=lambda done, total: report(100 * done // total),
        )  # fmt: skip
    return [
        dataclasses.replace(given, transmittance=own.transmittance)
        for given, own in zip(inputs, shares, strict=True)
    ], shares


def finish(
    meshes: Sequence[pv.DataSet],
    results: Sequence[engine.Shading],
    filter_name: str,
    scene: Scene,
    options: Options,
    name: str,
    *,
    inside: int = 0,
    dimmings: Sequence[Dimming] = (),
) -> None:
    """Attach the light to the meshes with its record; warn once if points could not be lit.

    Points inside volumes, ``inside`` in number, have no normal and are not counted.
    """
    shared: dict[tuple[object, ...], str] = {}
    # Points inside volumes are among those without light, but nobody sees them.
    invalid = -inside
    for i, (mesh, shading) in enumerate(zip(meshes, results, strict=True)):
        plan = shading.plan.dtype, shading.plan.terms, shading.plan.exponent
        record: Record = {"points": shading.valid.size, "invalid": shading.invalid}
        # Blocks that are lit alike share most of their record: it is written as text once.
        if plan not in shared:
            all_of = of_light(shading, filter_name, scene, options)
            shared[plan] = json.dumps({k: v for k, v in all_of.items() if k not in record})
        share: str | None = getattr(options, "occlusion", None)
        known = None if share is None else np.asarray(mesh.point_data[share])
        arrays = arrays_of(shading, name, occlusion=known)
        if dimmings:
            record["bundle"] = dimmings[i].record
            if dimmings[i].transmittance.size:
                arrays[part_name(name, bundles.TRANSMITTANCE)] = dimmings[i].transmittance
        records.attach(mesh, name, arrays, record, shared[plan])
        invalid += shading.invalid
    if invalid > 0:
        total = sum(shading.luminance.size for shading in results) - inside
        _check.warn(f"{unlit(invalid, total)}; the point array {name + VALID!r} marks them")
