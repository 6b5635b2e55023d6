"""The commands that light files: a lit mesh, a picture, a page, or pieces."""

from __future__ import annotations

import importlib.util
import inspect
import shlex
import tempfile
import webbrowser
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

import vizlight
from vizlight._words import message
from vizlight.cli import scenes
from vizlight.cli.job import HTML, Job, carry_out, drawing
from vizlight.cli.options import (
    GROUPS,
    Color,
    Common,
    Flag,
    Output,
    Part,
    Pieces,
    Shape,
    Target,
    fraction,
    keywords,
    takes,
    words,
)
from vizlight.cli.output import OK, complain, draw, say
from vizlight.looks.steps import Step, source

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pyvista as pv

    from vizlight._types import Keywords
    from vizlight.scene import Light
    from vizlight.shading.options import LightOptions


@takes("streamlines", "Streamlines", example="flow.vtu --vectors V --model cylinder --diffuse 0.8")
def streamlines(
    files: list[Path], /, *, part: Part, how: object, common: Common, color: Color
) -> int:
    """Trace streamlines of a vector field, free or on a surface, and light them.

    With --contour the isosurface conditions the light of the lines, and --confined keeps them
    on it.

    Parameters
    ----------
    files
        Mesh with vectors; of several each is lit by itself.
    """
    look = scenes.Look(common, part, color)
    given = keywords(how)
    if given.get("line_field") and "," in given.get("vectors", ""):
        given["vectors"] = tuple(given["vectors"].split(","))

    def job(path: Path, time: float | str | None) -> Job:
        mesh = scenes.joined(scenes.data(path, part, time), given.get("vectors"))
        scenes.check_flow(path, mesh.run(), given.get("vectors"))
        # The lines that are traced are the tangents that light for a question needs.
        scenes.check_answers(common.lights.question, mesh, color, "lines")
        if color.scalars in mesh.run().cell_data and color.scalars not in mesh.run().point_data:
            # Lines have the arrays of points alone.
            mesh = Step("averaged", ".cell_data_to_point_data", mesh)
        on = {} if part.contour is None else {"surface": scenes.surface(mesh, part)}
        camera = look.camera(on.get("surface", mesh) if given.get("confined") else mesh)
        lit = look.step("lit", "streamlines", mesh, look.scene(camera), **given, **on)
        made = Job(lit, look, camera)
        made.tint(mesh, color)
        return made

    return carry_out(files, job, common.out, "streamlines", part)


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
    shape: Shape,
    how: object,
    lit: Annotated[bool, Parameter(group=GROUPS["Output"])] = True,
    common: Common,
    sky: Annotated[Flag, Parameter(group=GROUPS["Light"])] = False,
) -> int:
    """Cast shadows on a height field or a closed surface: the cos-theta shadow t.

    Parameters
    ----------
    files
        Height field, or closed surface; of several each is lit by itself.
    lit
        Show the light with its shadow; otherwise the shadow t alone.
    sky
        Take the ambient light from an even sky.
    """
    # The shadow is cast by one light.
    look = scenes.Look(common, shape, raised=True, fill=False)
    # A shadow alone answers no question.
    given: Keywords = {"lit": lit or common.lights.question is not None}
    given |= keywords(how)
    given |= {"lit": True, "occlusion": "sky"} if sky else {}

    def job(path: Path, time: float | str | None) -> Job:
        mesh = scenes.data(path, shape, time)
        field, on, raised = _is_field(mesh, shape), dict[str, object](), None
        if field:
            raised = _raised(mesh, given.get("elevation"), shape.exaggeration)
        else:
            mesh = scenes.surface(mesh, shape)
            scenes.check_target(shape)
            if "raster" not in given:
                on["feature_angle"] = "auto"
        if raised is not None and raised.arguments[2] != 1:
            on["exaggeration"] = raised.arguments[2]
        camera = look.camera(raised or mesh, is_map=field)
        scene = look.scene(camera)
        shaded = look.step("shaded", "relief_shadow", mesh, scene, **(on | given))
        made = _shared(shaded, look, camera, mesh, raised, field=field)
        made.suffix = made.suffix or ".vtp"
        if given["lit"]:
            made.scalars = "rgb" if look.colored else "luminance"
        elif field and (white := 3 * _level_light(scene.run().lights)) < 1:
            made.clim = (0.0, round(white, 3))
            text = (
                f"note     white in the picture is t = {white:.2f}, 3 times the t of level ground"
            )
            made.tell.append(lambda _: text)
        return made

    return carry_out(files, job, common.out, "relief", shape)


@takes("sky", "Sky", example="terrain.dem --error 0.01 -o sky.png", up="sky_up")
def sky(files: list[Path], /, *, shape: Shape, how: object, common: Common) -> int:
    """Find the share of a uniform sky that each point sees.

    Parameters
    ----------
    files
        Height field, surface or lines; of several each is taken by itself.
    """
    look = scenes.Look(common, shape)
    given = keywords(how)

    def job(path: Path, time: float | str | None) -> Job:
        mesh = scenes.data(path, shape, time)
        field = _is_field(mesh, shape)
        if shape.contour is not None or shape.slice is not None:
            mesh = scenes.surface(mesh, shape)
        # The sky belongs to the heights as they are.
        raised = _raised(mesh, None, 1.0) if field else None
        camera = look.camera(raised or mesh, is_map=field)
        lit = look.step("skylit", "sky", mesh, **given)
        return _shared(lit, look, camera, mesh, raised, field=field)

    return carry_out(files, job, common.out, "sky", shape)


def _raised(mesh: Step, elevation: str | None, factor: float | None) -> Step | None:
    """Return the step that raises a flat grid by its heights in a picture, if it has some."""
    from vizlight.mesh.height_grids import heights_name

    field = mesh.run()
    name = elevation or heights_name(field)
    if name not in field.point_data or field.bounds.z_min != field.bounds.z_max:
        return None
    return scenes.warped("raised", mesh, str(name), factor)


def _shared(
    lit: Step, look: scenes.Look, camera: Step, mesh: Step, raised: Step | None, *, field: bool
) -> Job:
    """Return the job of a share of light at the points of a mesh, of a map as it was raised."""
    from vizlight import files

    made = Job(lit, look, camera, kind=mesh)
    made.scalars = made.name
    made.suffix = files.FORMATS[type(mesh.run()).__name__][0] if field else ""
    if raised is not None:
        made.shown = Step("shown", raised.path, lit, *raised.arguments[1:])
        made.shown.note = raised.note
    return made


def _level_light(lights: Sequence[Light]) -> float:
    """Return the sine of the altitude of the highest light at infinity; 1 without one above."""
    import numpy as np

    fixed = [light for light in lights if not light.follows_view]
    ways = [np.asarray(light.direction) for light in fixed if light.direction is not None]
    sines = [float(way[2] / np.linalg.norm(way)) for way in ways]
    return max((sine for sine in sines if sine > 0), default=1.0)


@takes("fur", "Fur", example="bunny.ply --absorption 0.7 --fibres 200000")
def fur(files: list[Path], /, *, shape: Shape, how: object, common: Common) -> int:
    """Cover a surface with fibres, and light them and the skin below.

    Parameters
    ----------
    files
        Surface, or a mesh with one; of several each is lit by itself.
    """
    from vizlight.filters.fur import MATERIAL

    names = ("ambient", "diffuse", "specular")
    look = scenes.Look(common, shape, material={name: getattr(MATERIAL, name) for name in names})
    given: Keywords = {"feature_angle": "auto"}
    given |= keywords(how)

    def job(path: Path, time: float | str | None) -> Job:
        mesh = scenes.surface(scenes.data(path, shape, time), shape)
        camera = look.camera(_tips(mesh, given.get("length")))
        lit = look.step("furry", "fur", mesh, look.scene(camera), **given)
        return Job(lit, look, camera, parts=("fibres", "skin"))

    return carry_out(files, job, common.out, "fur", shape)


# The tolerance is for solids, which no file holds.
@takes(
    "isoluminance", "Contours", example="part.stl --levels 8 --specular 0", without=("tolerance",)
)
def contours(files: list[Path], /, *, shape: Shape, how: object, common: Common) -> int:
    """Find the contours of equal luminance of a surface, and the bands between them.

    Parameters
    ----------
    files
        Surface, or a mesh with one; of several each is lit by itself.
    """
    look = scenes.Look(common, shape)
    # In a picture a crease is seen as one.
    given: Keywords = {"feature_angle": "auto"}
    given |= keywords(how)

    def job(path: Path, time: float | str | None) -> Job:
        mesh = scenes.surface(scenes.data(path, shape, time), shape)
        camera = look.camera(mesh)
        lit = look.step("found", "isoluminance", mesh, look.scene(camera), **given)
        bands = Step("", "[]", lit, "bands")
        return Job(lit, look, camera, shown=bands, parts=("bands", "contours"))

    return carry_out(files, job, common.out, "contours", shape)


@takes("project", "Projection", example="torus.vtp --rotation xw:0.5 --distance 3", light="when")
def project(files: list[Path], /, *, how: object, common: Common) -> int:
    """Turn, cut and project a mesh of n-space to 3-space, lit before or after.

    Lights and eye have 3 numbers, or n before the projection; what they lack is 0. The light is
    computed for an eye at infinity.

    Parameters
    ----------
    files
        Mesh with positions and tangents in n-space; of several each is lit by itself.
    """
    from vizlight.mesh.nspace import POSITION

    look = scenes.Look(common)
    given = keywords(how)

    def job(path: Path, time: float | str | None) -> Job:
        mesh = scenes.data(path, Part(), time)
        found = mesh.run()
        rows = found.point_data.get(given.get("positions", POSITION))
        # Light after the projection is in the space of the picture.
        n = 3 if given.get("light") == "after" or rows is None or rows.ndim == 1 else rows.shape[1]
        lit = look.step("projected", "project", mesh, **given, scene=look.scene_in(n))
        return Job(lit, look, look.camera(lit), kind=None, suffix=".vtk")

    return carry_out(files, job, common.out, "projected", Part())


def _tips(mesh: Step, length: float | str | None) -> Step:
    """Return the step that moves the points of a surface to where straight fur ends."""
    from vizlight.filters.fur import LENGTH
    from vizlight.mesh import blocks

    found: pv.PolyData = blocks.surface(mesh.run(), "mesh")
    length = LENGTH * found.length if length is None else length
    if isinstance(length, str):
        known = length in found.point_data and found.n_points
        length = float(found.point_data[length].max()) if known else 0.0
    normals = Step("", ".compute_normals", mesh, auto_orient_normals=True, cell_normals=False)
    return Step("tips", ".warp_by_vector", normals, "Normals", factor=length)


def _is_field(mesh: Step, shape: Shape) -> bool:
    """Tell whether a mesh, taken whole, is a grid of one layer."""
    sizes: tuple[int, ...] = getattr(mesh.run(), "dimensions", ())
    whole = shape.contour is None and shape.slice is None
    return whole and sum(size > 1 for size in sizes) == 2


#: Questions whose light needs the self-shadow of a surface where tangents are lit.
CONDITIONED = ("shape", "value")


# Places in n-space need lights and an eye in n-space, which scripts have; --sky is an occlusion.
@takes(
    "illuminate",
    "Shading",
    example="flow.vtu --contour Temp --tangents V --conditioned",
    without=("positions", "occlusion"),
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
        Print what a reader reads back from the picture.
    sky
        Take the ambient light from an even sky.
    refine
        Largest error between points, such as 1/255: cells are split where it is more.
    """
    given = keywords(how) | ({"occlusion": "sky"} if sky else {})
    if indices := _indices(common.out, pieces):
        if legibility:
            raise ValueError(message("--legibility", "one mesh, lit as a whole", "pieces"))
        if refine:
            remedy = "refine their union, so that split edges match"
            raise ValueError(message("--refine", "one mesh", "pieces", remedy))
        return _light_pieces(files, indices, target, given, common, color, pieces)
    recipe = [*words(target, how), *(["--sky"] if sky else [])]
    build = _builder(target, given, common, color, recipe, refine, explain, legibility)
    return carry_out(files, build, common.out, "lit", target)


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
    """Light a mesh as the command light does, and open a page whose light follows the reader's eye.

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
        common = replace(common, out=replace(common.out, output=pages))
        build = _builder(target, keywords(how), common, color, words(target, how))
        code = carry_out([file], build, common.out, "view", target)
        if folder is not None:
            pages[0].chmod(0o600)
    finally:
        if folder is not None and not pages[0].exists():
            folder.rmdir()
    opens = browser and code == OK and not common.out.script
    if opens and not webbrowser.open(pages[0].resolve().as_uri()):
        complain(f"no browser was found; open '{pages[0]}' in one")
    return code


def _builder(
    target: Target,
    given: Keywords,
    common: Common,
    color: Color,
    recipe: list[str],
    refine: str | None = None,
    explain: bool = False,
    legibility: bool = False,
) -> Callable[[Path, float | str | None], Job]:
    """Return the function that makes the job of a file, after a check of what needs no mesh."""
    from vizlight.shading.options import LightOptions

    look = scenes.Look(common, target, color)
    taken = target.surface or target.contour is not None or target.slice is not None
    if taken:
        # In a picture a crease is seen as one.
        given = {"feature_angle": "auto"} | given
    if common.lights.question in CONDITIONED and "tangents" in given:
        given = {"conditioned": True} | given
    asked = LightOptions(**given)
    lights, place = "illuminate", dict[str, object](inplace=True)
    if refine is not None:
        from vizlight.filters.refine import FINEST

        expected = f"a number of at least {FINEST:g}, such as 1/255"
        error = float(fraction("refine", refine, expected))
        if error < FINEST:
            raise ValueError(message("--refine", expected, refine))
        lights, place = "refine", {"error": error}

    def job(path: Path, time: float | str | None) -> Job:
        data = scenes.joined(scenes.data(path, target, time), given.get("tangents"))
        mesh = scenes.surface(data, target) if taken else data
        scenes.check_answers(common.lights.question, mesh, color, given.get("tangents"))
        camera = look.camera(mesh)
        scene = look.scene(camera)
        # The lit mesh shares the arrays of the file; a refined one is new.
        source = mesh if refine else Step("", ".copy", mesh, deep=False)
        lit = look.step("lit", lights, source, scene, **given, **place)
        made = Job(lit, look, camera, suffix=".vtp" if taken or refine else "")
        made.kind = made.kind if refine else mesh
        made.source = [str(path), *recipe]
        made.tint(data, color)
        made.tell.append(lambda _: _hint(data.run(), target, color.scalars))
        if explain:
            made.tell.append(lambda lit: _explain(lit, asked))
        if legibility:
            made.read = _read(made, scene, given)
        return made

    return job


def _read(made: Job, scene: Step, given: dict[str, object]) -> Step:
    """Return the step that measures what a reader can read back from the picture."""
    asked = inspect.signature(vizlight.legibility).parameters
    known = {name: value for name, value in given.items() if name in asked}
    if made.shown is not None and made.shown.path == "vizlight.tint":
        known["scalars"] = made.shown.arguments[1]
        known |= scenes.known(cmap=made.shown.keywords.get("cmap"))
    return Step("", "vizlight.legibility", made.lit, scene, **known, view=made.camera)


def _hint(mesh: pv.DataSet | pv.MultiBlock, target: Target, scalars: str | None) -> str:
    """Return what may have been meant: the hull of a volume, a flat field, or values unseen."""
    from vizlight.mesh.blocks import all_blocks
    from vizlight.vtk.arrays import are_colors

    if scalars is not None and scalars == target.contour:
        return f"note     {scalars} is the same all over its isosurface; name another --scalars"
    parts = [block for block in all_blocks(mesh) if block.n_cells]
    if target.contour or target.warp or target.slice or not parts:
        return ""
    arrays = parts[0].point_data
    if target.overlay and scalars is None:
        name = shlex.quote(list(arrays.keys())[-1])
        return f"note     --scalars {name} shows the values over the surface"
    raises = _varying(arrays)
    colors = raises + [shlex.quote(name) for name, one in arrays.items() if are_colors(one)]
    if any(block.GetMaxSpatialDimension() == 3 for block in parts):
        shows = f"; --contour {raises[0]} lights an isosurface of it" if raises else ""
        return f"note     the hull of a volume is lit{shows}" if target.surface and shows else ""
    colors += _varying(parts[0].cell_data)
    ways = [f"--scalars {colors[0]} colours it"] if colors and scalars is None else []
    ways += [f"--warp {raises[0]} raises it"] if raises else []
    flat = all(
        block.GetMaxSpatialDimension() == 2 and not min(block.bounds_size) for block in parts
    )
    return f"note     the mesh is flat; {', '.join(ways)}" if flat and ways else ""


def _varying(arrays: pv.DataSetAttributes) -> list[str]:
    """Return the names of arrays of one number that varies, as a shell takes them.

    Integers, which may number the nodes as names with "Id" do, come last.
    """
    import numpy as np

    found = [
        (values.dtype.kind != "f", i, shlex.quote(name))
        for i, (name, values) in enumerate(arrays.items())
        if values.dtype.kind in "iuf"
        and values.ndim == 1
        and not name.endswith(("Id", "Ids"))
        and (kept := values[np.isfinite(values)]).size
        and kept.min() < kept.max()
    ]
    return [name for *_, name in sorted(found)]


def _explain(lit: pv.DataSet, asked: LightOptions) -> str:
    """Return the plan by which a mesh was lit, in words."""
    from vizlight.filters.lighting import part_of
    from vizlight.mesh.blocks import all_blocks
    from vizlight.shading.plan import decide

    record = vizlight.provenance(lit, asked.name)
    scene = vizlight.Scene.from_dict(record["scene"])
    inputs = part_of(next(all_blocks(lit)), "", scene, asked).inputs
    layout = inputs.layout._replace(dimmed=bool(asked.bundle))
    return decide(scene, layout, asked, record["precision"]).explain()


def _indices(out: Output, pieces: Pieces) -> list[Path]:
    """Return the outputs that are indices of pieces, which options of pieces need."""
    asked = [f"--{name}" for name, value in vars(pieces).items() if value is not None]
    found = [path for path in out.output or () if path.suffix.lower().startswith(".pv")]
    if found or asked:
        from vizlight.pieces.sources import INDEX

        found = [path for path in found if path.suffix.lower() in INDEX.values()]
        if not found and asked:
            endings = ", ".join(INDEX.values())
            expected = f"an output that ends in {endings}, of pieces, beside {asked[0]}"
            got = ", ".join(str(path) for path in out.output or ()) or "none"
            raise ValueError(message("output", expected, got))
    return found


def _light_pieces(
    files: Sequence[Path],
    indices: Sequence[Path],
    target: Target,
    given: Keywords,
    common: Common,
    color: Color,
    pieces: Pieces,
) -> int:
    """Light files as pieces of one mesh, or print the script that does; return the exit code."""
    out = common.out
    look = scenes.Look(common, target, color)
    for part, names in (
        (target, "time times overlay clip threshold slice warp"),
        (color, "scalars"),
        (out, "report paraview"),
    ):
        for name in names.split():
            if getattr(part, name):
                raise ValueError(message(f"--{name}", "no such option for pieces", "one"))
    pictures = [path for path in out.output or () if path not in indices]
    for path in pictures:
        if path.suffix.lower() != ".png":
            expected = "pictures .png beside the index of pieces"
            remedy = f"make it of the index by 'vizlight light {indices[0]} -o {path}'"
            raise ValueError(message("output", expected, f"'{path}'", remedy))
    if len(indices) > 1:
        expected = "one index of pieces"
        raise ValueError(message("output", expected, ", ".join(map(str, indices))))
    if indices[0].suffix == ".pvtp":
        given = {"feature_angle": "auto"} | given
    what = scenes.known(contour=target.contour, level=target.level, slab=pieces.slab)
    runs: Keywords = _runs(pieces)
    shown = {"progress_bar": True} if out.progress else {}
    # The eye belongs to the lit whole, which no piece knows: it is found before the light.
    camera = look.camera(list(files), by="vizlight.pieces.camera_on", **what, **runs, **shown)
    scene, more = look.scene(camera), {"out": indices[0], **runs, **given}
    lit = look.step("lit", "pieces.light", list(files), scene, **what, **more)
    name = str(given.get("name", "luminance"))
    scalars = ("rgb" if name == "luminance" else f"{name}_rgb") if look.colored else name
    panel = Step("", "render.Panel", Step("whole", "vizlight.read", indices[0]), scalars)
    seen = {"camera": camera, "size": look.size, "light": "points", **drawing(out)}
    drawn = [Step("", "render.save_png", panel, path, **seen) for path in pictures]
    if out.script:
        say(source([[lit, *drawn]]))
        return OK
    made = lit.run()
    none = f", {made.empty} empty" if made.empty else ""
    say(f"{made.points} points lit in {len(made.files)} pieces{none}")
    low, high = made.ranges[name]
    if high > 1:
        complain(f"{name} is from {low:.3g} to {high:.3g}; above 1 it is white in a picture")
    say(f"mesh     {made.path}")
    return max((draw(step.run) for step in drawn), default=OK)


def _runs(pieces: Pieces) -> dict[str, Step]:
    """Return what the pieces are lit by: this process, processes, or a cluster."""
    if pieces.workers is not None:
        from vizlight import _check

        _check.integer("--workers", pieces.workers, low=1)
    if pieces.scheduler is None:
        processes = Step("work", "vizlight.pieces.Processes", pieces.workers)
        return {"map": processes} if (pieces.workers or 1) > 1 else {}
    if pieces.workers is not None:
        raise ValueError(message("--workers", "--workers or --scheduler", "both"))
    if importlib.util.find_spec("distributed") is None:
        remedy = "install it by: pip install 'vizlight[scale]'"
        raise ValueError(message("--scheduler", "the package distributed", "none", remedy))
    # An address that nobody answers at is an error of the operating system.
    return {"map": Step("work", "distributed.Client", pieces.scheduler, timeout=10)}
