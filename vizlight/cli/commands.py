"""The commands that light files: a lit mesh, a picture, a page, or pieces."""

from __future__ import annotations

import functools
import importlib.util
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

import vizlight
from vizlight._words import message, value_error
from vizlight.cli import scenes
from vizlight.cli.job import Command
from vizlight.cli.options import (
    GROUPS,
    Color,
    Common,
    FilePart,
    Flag,
    Output,
    Pieces,
    SurfacePart,
    Target,
    fraction,
    keywords,
    takes,
    words,
)
from vizlight.cli.output import OK, complain, draw, say
from vizlight.looks.steps import Step, source
from vizlight.reading import other_formats

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from vizlight._types import Keywords
    from vizlight.looks.look import Look

#: File name extension of a page in which the light follows the eye.
HTML = ".html"


@takes("streamlines", "Streamlines", example="flow.vtu --tangents V --model cylinder --diffuse 0.8")
def streamlines(
    files: list[Path], /, *, part: FilePart, how: object, common: Common, color: Color
) -> int:
    """Trace streamlines of a vector field, free or on a surface, and light them.

    With --contour the isosurface conditions the light of the lines, and --confined keeps them
    on it.

    Parameters
    ----------
    files
        Mesh with vectors; of several each is lit by itself.
    """
    light_options = keywords(how)
    if light_options.get("line_field") and "," in light_options.get("tangents", ""):
        light_options["tangents"] = tuple(light_options["tangents"].split(","))
    return _shown("flow", "streamlines", files, part, light_options, common, color)


# Heights are exaggerated, and lit, as they are shown.
@takes(
    "relief_shadow",
    "Relief",
    example="terrain.dem --depth 60 --light 315,20",
    without=("exaggeration", "lit"),
)
def relief(
    files: list[Path],
    /,
    *,
    shape: SurfacePart,
    how: object,
    lit: Annotated[bool, Parameter(group=GROUPS["Output"])] = True,
    common: Common,
    color: Color,
) -> int:
    """Cast shadows on a height field or a closed surface, in the light of the sun and the sky.

    Parameters
    ----------
    files
        Height field, or closed surface; of several each is lit by itself.
    lit
        Show the light with its shadow; otherwise the cos-theta shadow t alone.
    """
    light_options = keywords(how) | ({} if lit else {"lit": False})
    return _shown("relief", "relief", files, shape, light_options, common, color)


@takes("sky", "Sky", example="terrain.dem --error 0.01 -o sky.png", up="sky_up")
def sky(files: list[Path], /, *, shape: SurfacePart, how: object, common: Common) -> int:
    """Find the share of a uniform sky that each point sees.

    Parameters
    ----------
    files
        Height field, surface or lines; of several each is taken by itself.
    """
    return _shown("sky", "sky", files, shape, keywords(how), common)


@takes("fur", "Fur", example="bunny.ply --absorption 0.7 --fibres 200000")
def fur(files: list[Path], /, *, shape: SurfacePart, how: object, common: Common) -> int:
    """Cover a surface with fibres, and light them and the skin below.

    Parameters
    ----------
    files
        Surface, or a mesh with one; of several each is lit by itself.
    """
    from vizlight.filters.fur import MATERIAL

    names = ("ambient", "diffuse", "specular")
    material = {name: getattr(MATERIAL, name) for name in names}
    return _shown("fur", "fur", files, shape, keywords(how), common, material=material)


# The tolerance is for solids, which no file holds.
@takes(
    "isoluminance", "Contours", example="part.stl --levels 8 --specular 0", without=("tolerance",)
)
def contours(files: list[Path], /, *, shape: SurfacePart, how: object, common: Common) -> int:
    """Find the contours of equal luminance of a surface, and the bands between them.

    Parameters
    ----------
    files
        Surface, or a mesh with one; of several each is lit by itself.
    """
    return _shown("contours", "contours", files, shape, keywords(how), common)


@takes("project", "Projection", example="torus.vtp --rotation xw:0.5 --distance 3", light="when")
def project(files: list[Path], /, *, how: object, common: Common) -> int:
    """Turn, cut and project a mesh of n-space to 3-space, lit before or after.

    Lights and eye have 3 numbers, or n before the projection; missing ones are 0. The light is
    computed for an eye at infinity.

    Parameters
    ----------
    files
        Mesh with positions and tangents in n-space; of several each is lit by itself.
    """
    return _shown("projection", "projected", files, FilePart(), keywords(how), common)


def _shown(
    question: str,
    stem: str,
    files: Sequence[Path],
    part: FilePart,
    light_options: Keywords,
    common: Common,
    color: Color | None = None,
    material: Mapping[str, float] | None = None,
) -> int:
    """Show files by the question of a command; return the exit code."""
    wishes = scenes.wishes_of(
        common, part, color, question=question, light=light_options, material=material
    )
    return Command(wishes, common.out, stem, part).carry_out(files)


# Places in n-space need lights and an eye in n-space, which scripts have.
@takes(
    "illuminate",
    "Shading",
    example="flow.vtu --contour Temp --tangents V --conditioned",
    without=("positions",),
)
def light(
    files: list[Path],
    /,
    *,
    target: Target,
    how: object,
    common: Common,
    color: Color,
    pieces: Pieces,
    explain: Annotated[Flag, Parameter(group=GROUPS["Output"])] = False,
    legibility: Annotated[Flag, Parameter(group=GROUPS["Output"])] = False,
    refine: Annotated[str | None, Parameter(group=GROUPS["Light"])] = None,
) -> int:
    """Show what is in a file: the picture that suits its data, and the lit mesh.

    Parameters
    ----------
    files
        Mesh to show; several are shown one by one, or lit as pieces of one where the output ends
        in .pvtp, .pvtu, .pvti, .pvtr or .pvts: a grid slab by slab.
    explain
        Print what is computed and what is skipped.
    legibility
        Print what a reader reads back from the picture.
    refine
        Largest error between points, such as 1/255: cells are split where it is more.
    """
    for path in files:
        other_formats.check(path)
    light_options = keywords(how)
    if indices := _indices(common.out, pieces):
        if legibility:
            raise value_error("--legibility", "one mesh, lit as a whole", "pieces")
        if refine:
            remedy = "refine their union, so that split edges match"
            raise value_error("--refine", "one mesh", "pieces", remedy)
        return _light_pieces(files, indices, target, light_options, common, color, pieces)
    wishes = scenes.wishes_of(common, target, color, light=light_options)
    wishes = replace(wishes, refine=_refinement(refine))
    tell = functools.partial(_explain, light_options) if explain else None
    recipe = words(target, how)
    job = Command(wishes, common.out, "lit", target, tell, legibility, recipe)
    return job.carry_out(files)


def _refinement(refine: str | None) -> float | None:
    """Return the largest error between points."""
    if refine is None:
        return None
    from vizlight.filters.refine import FINEST

    expected = f"a number of at least {FINEST:g}, such as 1/255"
    error = float(fraction("refine", refine, expected))
    if error < FINEST:
        raise value_error("--refine", expected, refine)
    return error


@takes(
    "illuminate",
    "Shading",
    example="flow.vtu --contour Temp --tangents V --conditioned",
    without=("positions",),
)
def view(
    file: Path,
    /,
    *,
    target: Target,
    how: object,
    common: Common,
    color: Color,
    browser: Annotated[bool, Parameter(group=GROUPS["Output"])] = True,
) -> int:
    """Show a file as the command light does, in a page with light that follows the reader's eye.

    Parameters
    ----------
    file
        Mesh to show.
    browser
        Open the page in the browser. Without --output it is in a private temporary folder.
    """
    from vizlight.files import FileError

    pages = list(common.out.output or ())
    if wrong := [path for path in pages if path.suffix.lower() != HTML]:
        raise FileError(message("output", f"a name that ends in {HTML}", f"'{wrong[0]}'"))
    folder = None
    if not pages and common.out.script:
        pages = [Path(f"{file.stem}{HTML}")]
    elif not pages:
        # Only this user may look into the folder.
        folder = Path(tempfile.mkdtemp(prefix="vizlight-"))
        pages = [folder / f"{file.stem}{HTML}"]
    try:
        wishes = scenes.wishes_of(common, target, color, light=keywords(how))
        out = replace(common.out, output=pages)
        code = Command(wishes, out, "view", target, recipe=words(target, how)).carry_out([file])
        if folder is not None:
            pages[0].chmod(0o600)
    finally:
        if folder is not None and not pages[0].exists():
            folder.rmdir()
    import webbrowser

    opens = browser and code == OK and not common.out.script
    if opens and not webbrowser.open(pages[0].resolve().as_uri()):
        complain(f"no browser was found; open '{pages[0]}' in one")
    return code


def _explain(light_options: Keywords, look: Look) -> str:
    """Return the plan by which a mesh was lit, in words."""
    from vizlight.filters.lighting import part_of
    from vizlight.mesh.blocks import all_blocks
    from vizlight.shading.options import LightOptions
    from vizlight.shading.plan import decide

    lit = look.mesh
    name = str(look.drawing.lit.keywords.get("name", look.drawing.name))
    record = vizlight.provenance(lit, name)
    scene = vizlight.Scene.from_dict(record["scene"])
    options = LightOptions(**(light_options | record.get("options", {})))
    inputs = part_of(next(all_blocks(lit)), "", scene, options).inputs
    layout = inputs.layout._replace(dimmed=bool(options.bundle))
    return decide(scene, layout, options, record["precision"]).explain()


def _indices(out: Output, pieces: Pieces) -> list[Path]:
    """Return the outputs that are indices of pieces, which options of pieces need."""
    flags = [f"--{name}" for name, value in vars(pieces).items() if value is not None]
    indices = [path for path in out.output or () if path.suffix.lower().startswith(".pv")]
    if indices or flags:
        from vizlight.pieces.sources import INDEX

        indices = [path for path in indices if path.suffix.lower() in INDEX.values()]
        if not indices and flags:
            endings = ", ".join(INDEX.values())
            expected = f"an output that ends in {endings}, of pieces, beside {flags[0]}"
            got = ", ".join(str(path) for path in out.output or ()) or "none"
            raise value_error("output", expected, got)
    return indices


def _light_pieces(
    files: Sequence[Path],
    indices: Sequence[Path],
    target: Target,
    light_options: Keywords,
    common: Common,
    color: Color,
    pieces: Pieces,
) -> int:
    """Light files as pieces of one mesh, or print the script that does; return the exit code."""
    out = common.out
    wishes = scenes.wishes_of(common, target, color, light=light_options)
    # The key of a light belongs to the picture of the whole.
    wishes = replace(wishes, picture={**wishes.picture, "key": False})
    for part, names in (
        (target, "time times overlay at nodata clip threshold slice warp"),
        (color, "scalars array"),
        (out, "report paraview"),
    ):
        for name in names.split():
            if getattr(part, name):
                raise value_error(f"--{name}", "no such option for pieces", "one")
    pictures = [path for path in out.output or () if path not in indices]
    for path in pictures:
        if path.suffix.lower() != ".png":
            expected = "pictures .png beside the index of pieces"
            remedy = f"make it of the index by 'vizlight light {indices[0]} -o {path}'"
            raise value_error("output", expected, f"'{path}'", remedy)
    if len(indices) > 1:
        raise value_error("output", "one index of pieces", ", ".join(map(str, indices)))
    if indices[0].suffix == ".pvtp":
        light_options = {"feature_angle": "auto"} | light_options
    what = scenes.given_options(contour=target.contour, level=target.level, slab=pieces.slab)
    from vizlight.looks.framing import ISOMETRIC
    from vizlight.shading.results import part_name

    runs: Keywords = _runs(pieces)
    shown = {"progress_bar": True} if out.progress else {}
    # The eye belongs to the lit whole, which no piece knows: it is found before the light.
    camera = wishes.camera(list(files), ISOMETRIC)
    if camera.path == "render.camera_on":
        camera.path = "vizlight.pieces.camera_on"
        camera.keywords |= what | runs | shown
    scene = wishes.scene(common.lights.question or "plain", camera)
    more = {"out": indices[0], **runs, **light_options}
    lit = wishes.step("lit", "pieces.light", list(files), scene, **what, **more)
    name = str(light_options.get("name", "luminance"))
    scalars = part_name(name, "rgb") if scene.run().colored else name
    panel = Step("", "render.Panel", Step("whole", "vizlight.read", indices[0]), scalars)
    drawing = scenes.given_options(
        background=out.background,
        line_width=None if out.line_width == 1 else out.line_width,
        backend=out.backend,
    )
    seen = {"camera": camera, "size": wishes.size, "light": "points", **drawing}
    drawn = [Step("", "render.save_png", panel, path, **seen) for path in pictures]
    if out.script:
        say(source([[lit, *drawn]]))
        return OK
    result = lit.run()
    none = f", {result.empty} empty" if result.empty else ""
    say(f"{result.points} points lit in {len(result.files)} pieces{none}")
    low, high = result.ranges[name]
    if high > 1:
        complain(f"{name} is from {low:.3g} to {high:.3g}; above 1 it is white in a picture")
    say(f"mesh     {result.path}")
    return max((draw(step.run) for step in drawn), default=OK)


def _runs(pieces: Pieces) -> dict[str, Step]:
    """Return the options of the workers: this process, processes, or a cluster."""
    if pieces.workers is not None:
        from vizlight import _check

        _check.integer("--workers", pieces.workers, low=1)
    if pieces.scheduler is None:
        processes = Step("work", "vizlight.pieces.Processes", pieces.workers)
        return {"map": processes} if (pieces.workers or 1) > 1 else {}
    if pieces.workers is not None:
        raise value_error("--workers", "--workers or --scheduler", "both")
    if importlib.util.find_spec("distributed") is None:
        remedy = "install it by: pip install 'vizlight[scale]'"
        raise value_error("--scheduler", "the package distributed", "none", remedy)
    # An address that nobody answers at is an error of the operating system.
    return {"map": Step("work", "distributed.Client", pieces.scheduler, timeout=10)}
