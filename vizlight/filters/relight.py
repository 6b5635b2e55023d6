"""Arrays and options for lighting a mesh again, from the record of its light."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Facing, Given, Keywords
from vizlight.filters import lighting
from vizlight.filters.relief_shadow import ReliefOptions, Shadows
from vizlight.filters.sky import with_sky
from vizlight.mesh import blocks, bundles, normals, records
from vizlight.mesh.casters import EvenField, FieldCaster
from vizlight.mesh.height_grids import Grid
from vizlight.mesh.nspace import PROJECTED
from vizlight.scene import Scene, View
from vizlight.shading.engine import Shading
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import Bundle, LightOptions, ShadingOptions
from vizlight.shading.results import DEFAULT_NAME, part_name
from vizlight.vtk.normals import Sided

#: Share of the points whose light may differ from the record, such as those on the rim of a cut.
CHANGED = 0.05
#: Difference of luminance that counts as one.
SEEN = 2 / 255


class Source(NamedTuple):
    """One mesh, with the inputs and the options of its light.

    ``named`` are options of a filter, from which the inputs are read again after the mesh has
    changed; None where that takes the filter itself. Where normals are turned to the eye,
    ``inputs`` has them as they are and ``sided`` turns them. ``inside`` is the number of points of
    a volume that are not on its surface. ``shares`` gives the shares of light inside a bundle.
    ``field`` is the height field by which a shader casts the shadow, and ``uncast`` the reason for
    none.
    """

    mesh: pv.DataSet
    inputs: ShadingInputs
    options: ShadingOptions
    named: LightOptions | None
    sided: Sided | None = None
    inside: int = 0
    shares: bundles.Dimmed | None = None
    field: EvenField | None = None
    uncast: str = ""

    @property
    def facing(self) -> Facing:
        """Side of the surface that is lit."""
        return "as given" if self.named is None else self.named.facing

    def dimmed_by(self, scene: Scene) -> Source:
        """Return the source with the shares of the lights of a scene, where a bundle dims them."""
        if self.shares is None:
            return self
        inputs = self.shares.dimmed(self.inputs, scene)
        return self if inputs is self.inputs else self._replace(inputs=inputs)

    def seen_from(self, view: View | None, inputs: ShadingInputs) -> ShadingInputs:
        """Return inputs with the normals turned to an eye."""
        if self.sided is None or inputs.normals is None:
            return inputs
        sided = dataclasses.replace(self.sided, vectors=np.asarray(inputs.normals[:]))
        return dataclasses.replace(inputs, normals=sided.facing(self.facing, inputs.points, view))


def from_options(
    mesh: pv.DataSet | pv.MultiBlock, scene: Scene, options: LightOptions
) -> list[Source]:
    """Return the sources that :func:`vizlight.illuminate` lights on a mesh, one for each block."""
    chosen = [*blocks.named_blocks(mesh)]
    # One sky for all blocks, since they hide it from one another.
    meshes = with_sky([block for block, _ in chosen], options.occlusion)
    sources = [
        read(block, path, scene, options, sky_mesh)
        for sky_mesh, (block, path) in zip(meshes, chosen, strict=True)
    ]
    refuse_following(sources, scene)
    return sources


def read(
    mesh: pv.DataSet,
    path: str,
    scene: Scene,
    options: LightOptions,
    sky_mesh: pv.DataSet | None = None,
) -> Source:
    """Return the source on one mesh that options of :func:`vizlight.illuminate` light.

    ``sky_mesh`` is the mesh with its sky, which several blocks hide from one another.
    """
    if options.feature_angle is not None:
        expected = "None for light that follows"
        remedy = (
            "light the mesh first, illuminate(mesh, scene, feature_angle=...), and pass the "
            "result with scene=None"
        )
        raise _check.value_error("feature_angle", expected, repr(options.feature_angle), remedy)
    sky_mesh = with_sky([mesh], options.occlusion)[0] if sky_mesh is None else sky_mesh
    part = lighting.part_of(sky_mesh, path, scene, options)
    inputs, sided = part.inputs, part.sided
    shares: bundles.Dimmed | None = None
    if isinstance(options.bundle, Bundle):
        names = (options.name, part_name(options.name, bundles.TRANSMITTANCE))
        work = bundles.Work([mesh], [inputs], options.bundle)
        shares = bundles.Dimmed(mesh, inputs, work, names)
        inputs = shares.dimmed(inputs, scene)
    inside = 0 if sided is None else int(sided.inside)
    source = Source(mesh, inputs, part.options, options, None, inside, shares)
    # Only normals whose side depends on the eye are turned again as it moves.
    turned = sided is not None and (
        source.facing == "eye" or (source.facing == "auto" and sided.any_open)
    )
    if scene.view is None or sided is None or not turned:
        return source
    inputs = dataclasses.replace(inputs, normals=sided.vectors)
    return source._replace(inputs=inputs, sided=sided)


def refuse_following(sources: Sequence[Source], scene: Scene) -> None:
    """Refuse a light that follows the view beside shares of light that do not."""
    dimmed = any(source.inputs.transmittance is not None for source in sources)
    if dimmed and any(light.follows_view and light.intensity > 0 for light in scene.lights):
        expected, got = "lights that stay beside it in a live light", "one that follows the view"
        raise _check.value_error("bundle", expected, got, "give the scene fixed lights")


def is_lit(mesh: pv.DataSet | pv.MultiBlock, name: str = DEFAULT_NAME) -> bool:
    """Return whether each block of a mesh has the record of a light."""
    every = list(blocks.all_blocks(mesh))
    return bool(every) and all(
        "scene" in (records.read(block, name) or {}) and name in block.point_data for block in every
    )


def from_record(
    mesh: pv.DataSet | pv.MultiBlock, scene: Scene | None = None, name: str = DEFAULT_NAME
) -> tuple[list[Source], Scene]:
    """Return the sources that a filter lit on the meshes it returned, and the scene.

    The mesh is the result of :func:`vizlight.illuminate`, ``streamlines``, ``satin``, ``project``,
    ``fur`` or, with ``lit=True``, ``relief_shadow``, and ``scene`` takes the place of the recorded
    one. An error is raised if a record of the light is missing or does not suffice, or the light of
    the record differs from the mesh's, because points or arrays have changed.
    """
    sources, recorded = _read_record(mesh, scene, name)
    refuse_following(sources, recorded)
    if scene is None and records.provenance(mesh, name).get("filter") != "fur":
        _light_again(sources, recorded, name)
    return sources, recorded


class Relit(NamedTuple):
    """Light of one mesh, computed once more from its record.

    ``scene`` has both ends of its depth cue, and ``inputs`` has the normals on the side of the eye.
    """

    source: Source
    inputs: ShadingInputs
    scene: Scene
    shading: Shading


def lit_again(
    mesh: pv.DataSet | pv.MultiBlock, name: str, *, components: bool | None = None
) -> list[Relit]:
    """Return the light of each mesh by its record, in terms if the record or a caller says so."""
    sources, scene = _read_record(mesh, None, name)
    return _light_again(sources, scene, name, components=components)


def _read_record(
    mesh: pv.DataSet | pv.MultiBlock, scene: Scene | None, name: str
) -> tuple[list[Source], Scene]:
    """Return the sources of a record, and its scene or the given one."""
    record = records.provenance(mesh, name)
    recorded = Scene.from_dict(record["scene"])
    normals.compute_ahead(blocks.all_blocks(mesh))
    used = recorded if scene is None else scene
    if record.get("filter") == "fur":
        return _of_fur(mesh, record["options"], used), used
    sources: list[Source] = []
    for block, path in blocks.named_blocks(mesh):
        block_record = records.read(block, name)
        if block_record is None:
            expected = f"a record of {name!r} on each block"
            raise _check.value_error("mesh", expected, f"none on block {path or block}")
        sources.append(_of_block(block, path, block_record, used))
    return sources, used


def _of_block(mesh: pv.DataSet, path: str, record: Mapping[str, Given], scene: Scene) -> Source:
    filter_name, options = str(record["filter"]), dict(record["options"])
    if filter_name == "streamlines":
        # Where lines start has no part in their light.
        options = {key: value for key, value in options.items() if key != "seeds"}
    _refuse_described(filter_name, options)
    if filter_name == "relief_shadow":
        return _of_relief(mesh, options, scene)
    readers: dict[str, Callable[[pv.DataSet, Keywords], LightOptions]] = {
        "illuminate": lambda _, options: LightOptions(**options),
        "refine": lambda _, options: LightOptions.of(options),
        "streamlines": _of_lines,
        "project": _of_projection,
    }
    if filter_name not in readers:
        expected = "light that follows the view"
        remedy = "draw its arrays by plotter.add_mesh"
        raise _check.value_error("mesh", expected, f"light of {filter_name}", remedy)
    light = readers[filter_name](mesh, options)
    # The points of the result are split already.
    return read(mesh, path, scene, dataclasses.replace(light, feature_angle=None))


def _refuse_described(filter_name: str, options: Mapping[str, object]) -> None:
    """Refuse options that the record describes instead of holding them."""
    for option, values in options.items():
        for value in values if isinstance(values, list) else [values]:
            # Meshes and large arrays are described in a record by words like these.
            if not isinstance(value, str) or not (
                value.startswith("an array of shape") or value.endswith(" points")
            ):
                continue
            remedy = f"attach the array and name it by {option}=, or pass scene= and the options"
            expected = f"a record of {filter_name} that holds {option}"
            raise _check.value_error("mesh", expected, value, remedy)


def _of_lines(mesh: pv.DataSet, options: Keywords) -> LightOptions:
    """Return the options of streamlines: beside a surface their normals condition the light."""
    from vizlight.filters.streamlines import OWN_TANGENTS, TANGENTS

    beside = "Normals" in mesh.point_data
    light = dict(options)
    # Lines beside a surface have its normals, and are conditioned by default.
    if light.get("conditioned") is None:
        light["conditioned"] = beside
    if light["conditioned"] is True and light.get("normals") is None:
        light["normals"] = "Normals"
    # The record names the vectors of the traced mesh. Both of these are there if it had an array of
    # the second name.
    names = (name for name in (OWN_TANGENTS, TANGENTS) if name in mesh.point_data)
    light["tangents"] = next(names, None)
    return LightOptions.of(light)


def _of_projection(mesh: pv.DataSet, options: Keywords) -> LightOptions:  # noqa: ARG001
    """Return the options of light in n-space before a projection, or in 3-space after it."""
    from vizlight.filters.project import ProjectOptions

    # The mesh of the record is turned and cut already.
    kept = {name: value for name, value in options.items() if name not in ("rotation", "cut")}
    projection = ProjectOptions.of(kept)
    before = projection.light == "before"
    # After the projection the frame in 3-space gives the light, which has another name.
    frame = None if projection.frame is None else f"{'' if before else PROJECTED}{projection.frame}"
    return projection.by(frame, projection.positions if before else None)


def shadows_of(
    mesh: pv.DataSet, options: Mapping[str, Given], scene: Scene
) -> tuple[Shadows, ReliefOptions]:
    """Return the shadows that a record tells of, before they are cast, and their options."""
    _refuse_described("relief_shadow", options)
    relief_options = ReliefOptions.of({**options, "lit": True, "components": False})
    with warnings.catch_warnings():
        # They were given when the field was lit.
        warnings.simplefilter("ignore", UserWarning)
        surface = mesh if isinstance(mesh, pv.PolyData | Grid) else blocks.surface(mesh, "mesh")
        return Shadows.of(surface, scene, relief_options), relief_options


def _of_relief(mesh: pv.DataSet, options: Keywords, scene: Scene) -> Source:
    """Return the source of light with a cos-theta shadow, cast again unless its arrays suffice."""
    shadows, relief_options = shadows_of(mesh, options, scene)
    t = shadows.recorded(relief_options, scene)
    if t is None:
        t = shadows.ratios(relief_options, progress_bar=False)
    field, uncast = None, "a closed surface casts it"
    if relief_options.angular_diameter > 0:
        uncast = "the lights are discs"
    elif isinstance(shadows.caster, FieldCaster):
        field, uncast = shadows.caster.even(mesh)
    return Source(mesh, shadows.inputs(t), ShadingOptions(), None, field=field, uncast=uncast)


def _of_fur(
    mesh: pv.DataSet | pv.MultiBlock, options: Mapping[str, Given], scene: Scene
) -> list[Source]:
    """Return the sources of fibres and skin, which grow again."""
    from vizlight.filters.fur import FurOptions, grow

    _refuse_described("fur", options)
    if not isinstance(mesh, pv.MultiBlock) or {"fibres", "skin"} - set(mesh.keys()):
        expected, remedy = "the fibres and the skin of fur", "pass the MultiBlock that fur returned"
        raise _check.value_error("mesh", expected, "one of them", remedy)
    fibres, skin = mesh["fibres"], mesh["skin"]
    assert isinstance(fibres, pv.DataSet)
    assert isinstance(skin, pv.PolyData)
    fur_options = FurOptions.of(options)
    grown = grow(skin, scene, fur_options, progress_bar=False)
    return [
        Source(block, inputs, light, None)
        for block, (inputs, light) in zip((fibres, skin), grown.parts, strict=True)
    ]


def _light_again(
    sources: list[Source], scene: Scene, name: str, *, components: bool | None = None
) -> list[Relit]:
    """Return the light of the record, which must match the light of the meshes."""
    parts = []
    for source in sources:
        options = source.options
        if components is not None:
            options = dataclasses.replace(options, components=components)
        parts.append((source.seen_from(scene.view, source.inputs), options))
    results, fitted = lighting.light(parts, scene, progress_bar=False)
    for source, shading in zip(sources, results, strict=True):
        stored = _check.floats(f"mesh, {name}", source.mesh.point_data[name])
        if stored.shape != shading.luminance.shape:
            expected = f"the {len(shading.luminance)} values of its record"
            raise _check.value_error(f"mesh, {name}", expected, stored, "light it again")
        # Written so that NaN differs, too.
        differs = ~(np.abs(shading.luminance - stored) <= SEEN)
        if np.count_nonzero(differs) > CHANGED * differs.size:
            share = f"other light at {np.mean(differs):.0%} of the points"
            expected = f"a mesh whose {name!r} matches its record"
            remedy = "light it again: points or arrays have changed"
            raise _check.value_error("mesh", expected, share, remedy)
    return [
        Relit(source, inputs, fitted, shading)
        for source, (inputs, _), shading in zip(sources, parts, results, strict=True)
    ]
