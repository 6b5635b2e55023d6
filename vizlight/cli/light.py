"""``vizlight light FILE``: read a mesh, light it, write the lit mesh and a picture."""

from __future__ import annotations

import contextlib
import time
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

import vizlight
from vizlight import _check
from vizlight.cli import arguments
from vizlight.cli.arguments import Eye, Lamps, LightArguments, Output, Target
from vizlight.cli.output import OK, complain, draw, say

if TYPE_CHECKING:
    import pyvista as pv

    from vizlight.scene import Scene
    from vizlight.shading.options import LightOptions


def light(
    file: Path,
    /,
    *,
    target: Annotated[Target, Parameter(name="*", group="What is lit")] = Target(),  # noqa: B008
    how: Annotated[LightArguments, Parameter(name="*", group="How")] = LightArguments(),  # type: ignore[valid-type]  # noqa: B008
    lamps: Annotated[Lamps, Parameter(name="*", group="Lights and material")] = Lamps(),  # noqa: B008
    eye: Annotated[Eye, Parameter(name="*", group="Camera")] = Eye(),  # noqa: B008
    out: Annotated[Output, Parameter(name="*", group="Output")] = Output(),  # noqa: B008
) -> int:
    """Light a mesh from any file that PyVista reads, and write the lit mesh and a picture.

    Parameters
    ----------
    file
        The mesh.
    """
    from vizlight import files, render
    from vizlight.filters.lighting import part_name

    meshes, pictures = _outputs(file, target, out)
    options, size = arguments.light_options(how), arguments.pixels(out.size)
    mesh, hint = _read(file, target, average_cells=options.average_cells)
    for path in meshes:
        files.check_format(mesh, path)
    camera = render.camera_on(
        mesh,
        arguments.vector("view", eye.view),
        up=None if eye.up is None else arguments.vector("up", eye.up),
        parallel=eye.parallel,
        zoom=eye.zoom,
        aspect=size[0] / size[1],
    )
    scene = _scene(lamps, camera)
    lit = _light(mesh, scene, options, out, hint)
    if pictures:
        _count_white(lit, options.name)
    if out.explain:
        _explain(lit, options)
    for path in meshes:
        say(f"mesh     {files.write_mesh(lit, path)}")
    shown = part_name(options.name, "rgb") if scene.colored else options.name
    codes = [
        draw(
            render.Panel(lit, shown),
            path,
            camera=camera,
            size=size,
            background=out.background,
            line_width=out.line_width,
            backend=out.backend,
        )
        for path in pictures
    ]
    return max(codes, default=OK)


def _outputs(file: Path, target: Target, out: Output) -> tuple[list[Path], list[Path]]:
    """Return the files of meshes and of pictures, after a check of all that needs no mesh."""
    from vizlight import files

    for option, value, needs, given in (
        ("level", target.level, "contour", target.contour),
        ("warp-factor", target.warp_factor, "warp", target.warp),
    ):
        if value is not None and given is None:
            raise ValueError(_check.message(f"--{option}", f"--{needs} with it", "it alone"))
    _check.color("background", out.background)
    _check.number("line_width", out.line_width, low=0.1, high=1000.0)
    paths = out.output
    if paths is None:
        paths = [Path(f"{file.stem}-lit.vtp"), Path(f"{file.stem}-lit.png")]
        if not target.surface and target.contour is None:
            paths.pop(0)
    for path in paths:
        files.check_output(path, (".png", *files.SUFFIXES))
        if path.exists() and file.exists() and path.samefile(file):
            raise files.FileError(
                _check.message("output", "another file than the input", f"'{path}'")
            )
    pictures = [path for path in paths if path.suffix.lower() == ".png"]
    return [path for path in paths if path not in pictures], pictures


def _read(file: Path, target: Target, *, average_cells: bool) -> tuple[pv.DataSet, str]:
    """Return what is lit of a file, and a hint at what else may have been meant."""
    from vizlight import files

    mesh = files.read_mesh(file)
    wanted = {target.contour, target.warp}
    if average_cells and not wanted <= {None, *getattr(mesh, "point_data", {})}:
        mesh = mesh.cell_data_to_point_data()
    if target.warp is not None:
        factor = 1.0 if target.warp_factor is None else target.warp_factor
        mesh = files.warped(mesh, target.warp, factor)
    hint = "" if target.contour or target.warp else _hint(mesh, surface=target.surface)
    if target.surface or target.contour is not None:
        mesh = files.surface_of(mesh, target.contour, target.level)
    return mesh, hint


def _hint(mesh: pv.DataSet | pv.MultiBlock, *, surface: bool) -> str:
    """Return what may have been meant for a volume, of which the hull is lit, or a flat field."""
    from vizlight.mesh.blocks import leaves

    parts = [leaf for leaf in leaves(mesh) if leaf.n_cells]
    names = [
        name for leaf in parts[:1] for name, values in leaf.point_data.items() if values.ndim == 1
    ]
    if not names:
        return ""
    if any(leaf.GetMaxSpatialDimension() == 3 for leaf in parts):
        hull = f"the hull of a volume is lit; --contour {names[0]} lights an isosurface of it"
        return hull if surface else ""
    if all(leaf.GetMaxSpatialDimension() == 2 and not min(leaf.bounds_size) for leaf in parts):
        return f"the mesh is flat; --warp {names[0]} raises it by its heights"
    return ""


def _scene(lamps: Lamps, camera: pv.Camera) -> Scene:
    """Return the scene that the options describe."""
    from vizlight import render

    lights = [
        vizlight.Light(direction=arguments.vector("light", text)) for text in lamps.light or ()
    ]
    lights += [
        vizlight.Light(position=arguments.vector("light-position", text, direction=False))
        for text in lamps.lamp or ()
    ]
    if lamps.headlight:
        lights.append(vizlight.Light.headlight())
    return vizlight.Scene(
        lights=lights or [vizlight.Light(direction=render.over_shoulder(camera))],
        material=vizlight.Material(
            ambient=lamps.ambient,
            diffuse=lamps.diffuse,
            specular=lamps.specular,
            shininess=lamps.shininess,
            color=lamps.color,
        ),
        view=vizlight.View.from_camera(camera),
        depth_cue=vizlight.DepthCue(back_scale=0.5) if lamps.depth_cue else None,
    )


def _light(
    mesh: pv.DataSet, scene: Scene, options: LightOptions, out: Output, hint: str
) -> pv.DataSet:
    """Light the mesh and print how."""
    from vizlight.filters.illuminate import light_mesh

    start = time.perf_counter()
    asked = vizlight.report() if out.report else contextlib.nullcontext()
    with warnings.catch_warnings(record=True) as caught, asked as cost:
        warnings.simplefilter("always", UserWarning)
        lit = light_mesh(mesh, scene, options, progress_bar=out.progress)
    seconds = time.perf_counter() - start
    if hint:
        say(f"note     {hint}")
    for warning in caught:
        complain(warning.message)
    record = vizlight.provenance(lit, options.name)
    terms = " + ".join(record["terms"])
    say(f"{lit.n_points} points lit in {seconds:.3f} s, {record['precision']}: {terms}")
    if cost is not None:
        say(str(cost))
    return lit


def _count_white(lit: pv.DataSet, name: str) -> None:
    """Print how many points are too bright for the picture."""
    from vizlight.mesh.blocks import leaves

    bright = sum(int((leaf.point_data[name] > 1).sum()) for leaf in leaves(lit))
    if bright:
        complain(
            f"{bright} of {lit.n_points} points are brighter than 1 and white in the "
            "picture; a smaller --ambient, --diffuse or --specular shows them"
        )


def _explain(lit: pv.DataSet, options: LightOptions) -> None:
    """Print the plan by which a mesh was lit."""
    from vizlight.mesh.blocks import leaves
    from vizlight.mesh.inputs import inputs_of
    from vizlight.shading.decide import decide

    record = vizlight.provenance(lit, options.name)
    scene = vizlight.Scene.from_dict(record["scene"])
    inputs = inputs_of(next(leaves(lit)), "", scene, options)
    dtype = None if options.tolerance and options.precision is None else record["precision"]
    say(decide(scene, inputs.layout, options, dtype).explain())
