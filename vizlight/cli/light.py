"""``vizlight light FILE``: read a mesh, light it, write the lit mesh and a picture."""

from __future__ import annotations

import inspect
import shlex
from pathlib import Path  # noqa: TC003 - cyclopts reads the annotations
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

import vizlight
from vizlight import _words
from vizlight.cli import in_pieces, options, scenes
from vizlight.cli.arguments import (
    COMMON,
    GROUPS,
    LIT,
    OUTPUT,
    PIECES,
    Color,
    Common,
    Flag,
    Pieces,
    Target,
    fraction,
)  # fmt: skip
from vizlight.cli.job import Job, carry_out
from vizlight.cli.output import say
from vizlight.cli.script import Step

#: Questions whose light needs the self-shadow of a surface where tangents are lit.
CONDITIONED = ("shape", "value")

if TYPE_CHECKING:
    from collections.abc import Callable

    import pyvista as pv

    from vizlight._types import Keywords
    from vizlight.shading.options import LightOptions


# Places in n-space need lights and an eye in n-space, which scripts have; --sky is an occlusion.
@options.takes("illuminate", "Shading", without=("positions", "occlusion"))
def light(
    files: list[Path],
    /,
    *,
    target: Annotated[Target, LIT] = Target(),  # noqa: B008
    how: object = None,
    common: Annotated[Common, COMMON] = Common(),  # noqa: B008
    color: Annotated[Color, OUTPUT] = Color(),  # noqa: B008
    pieces: Annotated[Pieces, PIECES] = Pieces(),  # noqa: B008
    explain: Annotated[Flag, Parameter(group=GROUPS["Output"])] = False,
    legibility: Annotated[Flag, Parameter(group=GROUPS["Output"])] = False,
    sky: Annotated[Flag, Parameter(group=GROUPS["Light"])] = False,
    refine: Annotated[str | None, Parameter(group=GROUPS["Light"])] = None,
) -> int:
    """Light a mesh from any file that PyVista reads, and write the lit mesh and a picture.

    Parameters
    ----------
    files
        Mesh to light; several are lit one by one, or all as pieces of one where the output ends in
        .pvtp, .pvtu, .pvti, .pvtr or .pvts: a grid slab by slab.
    explain
        Print what is computed and what is skipped.
    legibility
        Print what an ideal reader reads back from the picture.
    sky
        Take the ambient light from an even sky.
    refine
        Largest error between points, such as 1/255: cells are split where it is more.
    """
    given = keywords(how, sky=sky)
    if in_pieces.are_asked(common.out, pieces):
        scenes.check_target(target)
        scenes.check_color(color)
        look = scenes.Look(common)
        if legibility:
            got = "pieces"
            raise ValueError(_words.message("--legibility", "one mesh, lit as a whole", got))
        if refine:
            remedy = "refine their union, so that split edges match"
            raise ValueError(_words.message("--refine", "one mesh", "pieces", remedy))
        return in_pieces.light(files, target, given, common, color, pieces, look)
    build = builder(
        target, how, common, color, sky=sky, refine=refine, explain=explain, legibility=legibility
    )
    return carry_out(files, build, common.out, "lit", target)


def keywords(how: object, *, sky: bool) -> Keywords:
    """Return the options of light, with the ambient light of a sky where it is asked for."""
    return options.keywords(how) | ({"occlusion": "sky"} if sky else {})


def builder(
    target: Target,
    how: object,
    common: Common,
    color: Color,
    *,
    sky: bool = False,
    refine: str | None = None,
    explain: bool = False,
    legibility: bool = False,
) -> Callable[[Path, float | str | None], Job]:
    """Return the function that makes the job of a file, after a check of what needs no mesh."""
    from vizlight.shading.options import LightOptions

    scenes.check_target(target)
    scenes.check_color(color)
    look = scenes.Look(common)
    given = keywords(how, sky=sky)
    taken = target.surface or target.contour is not None or target.slice is not None
    if taken:
        # In a picture a crease is seen as one.
        given = {"feature_angle": "auto"} | given
    if common.lights.question in CONDITIONED and "tangents" in given:
        given = {"conditioned": True} | given
    asked = LightOptions(**given)
    lights, place = "vizlight.illuminate", dict[str, object](inplace=True)
    if refine is not None:
        lights, place = "vizlight.refine", {"error": _finest(refine)}

    def job(path: Path, time: float | str | None) -> Job:
        data = scenes.data(path, target, time)
        mesh = data = scenes.joined(data, given.get("tangents"))
        if taken:
            mesh = scenes.surface(data, target)
        scenes.check_answers(common.lights.question, mesh, color, given.get("tangents"))
        camera = look.camera(mesh)
        progress = {"progress_bar": True} if common.out.progress else {}
        scene = look.scene(camera)
        # The lit mesh shares the arrays of the file; a refined one is new.
        source = mesh if refine else Step("", ".copy", mesh, deep=False)
        lit = Step("lit", lights, source, scene, **given, **place, **progress)
        made = Job(lit, asked.name, look, camera, suffix=".vtp" if taken or refine else "")
        made.before = None if refine else mesh
        made.source = [str(path), *options.words(target, how), *(["--sky"] if sky else [])]
        made.tint(lit, data, color)
        if not (target.contour or target.warp or target.slice):
            made.hint = lambda: _hint(data.run(), target, color.scalars)
        elif color.scalars is not None and color.scalars == target.contour:
            made.hint = lambda: (
                f"{color.scalars} is the same all over its isosurface; name another --scalars"
            )
        if explain:
            made.explain = lambda mesh: _explain(mesh, asked)
        if legibility:
            made.read = _read(made, scene, given)
        return made

    return job


def _finest(text: str) -> float:
    """Return the error between points that is asked for."""
    from vizlight.filters.refine import FINEST

    expected = f"a number of at least {FINEST:g}, such as 1/255"
    error = fraction("refine", text, expected)
    if error < FINEST:
        raise ValueError(_words.message("--refine", expected, text))
    return error


def _read(made: Job, scene: Step, given: dict[str, object]) -> Step:
    """Return the step that measures what a reader can read back from the picture."""
    names = [field for field in inspect.signature(vizlight.legibility).parameters if field in given]
    known = {name: given[name] for name in names}
    if made.shown is not None and made.shown.path == "vizlight.tint":
        known["scalars"] = made.shown.arguments[1]
        known |= {name: made.shown.keywords[name] for name in made.shown.keywords.keys() & {"cmap"}}
    return Step("", "vizlight.legibility", made.lit, scene, **known, view=made.camera)


def _hint(mesh: pv.DataSet | pv.MultiBlock, target: Target, scalars: str | None) -> str:
    """Return what may have been meant: the hull of a volume, a flat field, or values unseen."""
    from vizlight.filters.tint import are_colors
    from vizlight.mesh.blocks import all_blocks

    parts = [block for block in all_blocks(mesh) if block.n_cells]
    arrays = dict(parts[0].point_data.items()) if parts else {}
    if target.overlay and scalars is None:
        return f"--scalars {shlex.quote(list(arrays)[-1])} shows the values over the surface"
    flat = all(
        block.GetMaxSpatialDimension() == 2 and not min(block.bounds_size) for block in parts
    )
    whole = _varying(arrays)
    if not whole:
        cells = _varying(dict(parts[0].cell_data.items()) if parts else {})
        colors = [name for name, values in arrays.items() if are_colors(values)]
        colors += sorted(cells, key=lambda name: cells[name])
        shown = flat and colors and scalars is None
        return (
            f"the mesh is flat; --scalars {shlex.quote(colors[0])} shows colours" if shown else ""
        )
    name = shlex.quote(min(whole, key=lambda name: whole[name]))
    if any(block.GetMaxSpatialDimension() == 3 for block in parts):
        hull = f"the hull of a volume is lit; --contour {name} lights an isosurface of it"
        return hull if target.surface else ""
    if flat:
        colored = f"--scalars {name} colours it, " if scalars is None else ""
        return f"the mesh is flat; {colored}--warp {name} raises it"
    return ""


def _varying(arrays: Keywords) -> dict[str, bool]:
    """Return the arrays of one number that varies, and whether it is an integer.

    Integers may number the nodes, as names with "Id" do.
    """
    import numpy as np

    return {
        name: values.dtype.kind != "f"
        for name, values in arrays.items()
        if values.dtype.kind in "iuf"
        and values.ndim == 1
        and not name.endswith(("Id", "Ids"))
        and (kept := values[np.isfinite(values)]).size
        and kept.min() < kept.max()
    }


def _explain(lit: pv.DataSet, asked: LightOptions) -> None:
    """Print the plan by which a mesh was lit."""
    from vizlight.mesh.batches import inputs_of
    from vizlight.mesh.blocks import all_blocks
    from vizlight.shading.decide import decide

    record = vizlight.provenance(lit, asked.name)
    scene = vizlight.Scene.from_dict(record["scene"])
    inputs = inputs_of(next(all_blocks(lit)), "", scene, asked)
    layout = inputs.layout._replace(dimmed=bool(asked.bundle))
    say(decide(scene, layout, asked, record["precision"]).explain())
