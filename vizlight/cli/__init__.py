"""The command line: ``vizlight demo``, ``light FILE``, ``study NAME``, ``doctor``."""

from __future__ import annotations

import contextlib
import re
import sys
import time
import warnings
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import App, CycloptsError, Parameter

import vizlight
from vizlight import _check, _console

if TYPE_CHECKING:
    from collections.abc import Sequence

#: Exit codes: all well; done but for the picture, or a machine that lacks something; bad input.
OK, LACKING, BAD_INPUT = 0, 1, 2

app = App(
    name="vizlight",
    help="Light that makes scientific data legible.",
    version=lambda: vizlight.__version__,
    result_action="return_value",
)
Backend = Literal["egl", "osmesa"]
Vector = Annotated[str, Parameter(allow_leading_hyphen=True)]
Vectors = Annotated[list[str], Parameter(allow_leading_hyphen=True, negative=())]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code; errors are one line on standard error."""
    try:
        result = app(
            None if arguments is None else list(arguments),
            exit_on_error=False,
            print_error=False,
            help_on_error=False,
        )
    except CycloptsError as error:
        return _fail(str(error).replace("Unused Tokens", "arguments that belong to no option"))
    except (TypeError, ValueError, OSError) as error:
        return _fail(error)
    except KeyboardInterrupt:
        return _fail("interrupted")
    return result if isinstance(result, int) else OK


def _fail(error: object) -> int:
    text = " ".join(str(error).split())
    # The library names its options as Python does.
    text = re.sub(r"\b([a-z]+(?:_[a-z]+)*)=(?:True)?(?=[ ,;.)]|$)", _option, text)
    sys.stderr.write(f"vizlight: {text}\n")
    return BAD_INPUT


def _option(found: re.Match[str]) -> str:
    return f"--{found[1].replace('_', '-')}"


@app.command
def demo(
    *,
    out: Path = Path("vizlight-demo"),
    size: str = "1200x500",
    backend: Backend | None = None,
) -> int:
    """Light a real flow: an isosurface of the rotating disk, lit as a surface and by its flow.

    Writes flow.png and flow.vtp and prints a table: points, terms, time, and the error against
    a float64 reference that shares no code with the engine.

    Parameters
    ----------
    out
        The folder to write to; made if it is missing.
    size
        Width and height of the picture in pixels.
    backend
        What draws: egl (the default) or osmesa.
    """
    from rich.table import Table

    from vizlight import demo, files

    pixels = _size(size)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise files.FileError(
            _check.message("out", "a folder that can be made", f"'{out}' ({error.strerror})")
        ) from error
    lit, camera, rows, explained = demo.light_flow()
    mesh = files.write_mesh(lit, out / "flow.vtp")
    table = Table(title="Isosurface Temp = 600 of the rotating disk")
    for heading in ("lit", "points", "terms", "time, ms", "largest error"):
        table.add_column(heading, justify="left" if heading in ("lit", "terms") else "right")
    for row in rows:
        table.add_row(
            row.light, f"{row.points}", row.terms, f"{row.milliseconds:.2f}", f"{row.error:.1e}"
        )
    console = _console.console()
    console.print(table)
    console.print("Error: float32 luminance against plain NumPy in float64. The flow's plan:")
    console.print(explained, highlight=False)
    console.print(f"mesh     {mesh}", highlight=False)
    return _draw(demo.panels(lit), out / "flow.png", camera=camera, size=pixels, backend=backend)


@app.command
def light(
    file: Path,
    /,
    *,
    contour: str | None = None,
    level: float | None = None,
    warp: str | None = None,
    warp_factor: float | None = None,
    tangents: str | None = None,
    average_cells: bool = False,
    conditioned: bool = False,
    two_sided: bool = False,
    flip_normals: bool = False,
    compensate: bool = True,
    model: Literal["phong", "blinn", "cylinder"] = "phong",
    tolerance: str = "0",
    light: Vectors | None = None,
    lamp: Vectors | None = None,
    headlight: bool = False,
    ambient: float = 0.1,
    diffuse: float = 0.5,
    specular: float = 0.4,
    shininess: float = 20.0,
    color: str | None = None,
    view: Vector = "1,1,1",
    up: Vector | None = None,
    parallel: bool = False,
    zoom: float = 1.0,
    depth_cue: bool = False,
    components: bool = False,
    name: str = "luminance",
    precision: Literal["float32", "float64"] | None = None,
    output: Annotated[list[Path], Parameter(name=["--output", "-o"], negative=())] | None = None,
    surface: bool = True,
    size: str = "1200x800",
    background: str | None = None,
    line_width: float = 1.0,
    backend: Backend | None = None,
    explain: bool = False,
    report: bool = False,
    progress: bool = False,
) -> int:
    """Light a mesh from any file that PyVista reads, and write the lit mesh and a picture.

    Parameters
    ----------
    file
        The mesh.
    contour
        Light an isosurface of this point array; otherwise the outer surface.
    level
        The isosurface's value; default the middle of the range.
    warp
        Raise the points of a grid by this point array, such as a terrain's elevation.
    warp_factor
        Times the array's values; default 1.
    tangents
        A point array of vectors to light by; without, the surface's normals.
    average_cells
        Allow cell data, averaged to the points.
    conditioned
        Tangents inherit the surface's self-shadow.
    two_sided
        Light both sides of a surface.
    flip_normals
        Turn the normals over.
    compensate
        Give lines a surface's contrast.
    model
        Law of the highlight; cylinder, for lines, of all their light.
    tolerance
        How far the light may be off for speed, such as 1/255; default 0, the exact forms.
    light
        Direction x,y,z toward a light at infinity; may be repeated. Default: over the left
        shoulder of the eye.
    lamp
        Position x,y,z of a light; may be repeated.
    headlight
        Add a light that follows the view; alone it takes the place of the default light.
    ambient
        Coefficient of the ambient term.
    diffuse
        Coefficient of the diffuse term.
    specular
        Coefficient of the specular term.
    shininess
        Power of the specular term.
    color
        A colour's name or #rrggbb; the picture is then in colour.
    view
        Direction x,y,z from the mesh toward the eye.
    up
        What is up in the picture; default z.
    parallel
        Parallel projection.
    zoom
        2 shows half the width.
    depth_cue
        Fade to half with depth.
    components
        Keep ambient, diffuse and specular as arrays.
    name
        Of the point array that holds the light.
    precision
        Default: that of the vectors.
    output
        A file: .png for the picture; .vtp, .vtu, .vtk, .vts, .vti or .vtr for the mesh; may be
        repeated. Default: NAME-lit.vtp and NAME-lit.png here.
    surface
        Take the surface of a volume; --no-surface lights all its points.
    size
        Width and height of the picture in pixels.
    background
        Colour behind the mesh; default white, or black behind lines.
    line_width
        Of lines, in pixels of a picture of twice the size, as it is drawn.
    backend
        What draws: egl (the default) or osmesa.
    explain
        Say what is computed and what is skipped.
    report
        Say what it cost, and how wrong a sample is that is lit again in float64.
    progress
        Show a progress bar.
    """
    from vizlight import files
    from vizlight.filters import illuminate, provenance
    from vizlight.filters.lighting import part_name
    from vizlight.mesh.blocks import leaves
    from vizlight.mesh.polylines import has_lines_only
    from vizlight.pictures import render
    from vizlight.shading import engine

    for option, value, needs, given in (
        ("level", level, "contour", contour),
        ("warp-factor", warp_factor, "warp", warp),
    ):
        if value is not None and given is None:
            raise ValueError(_check.message(f"--{option}", f"--{needs} with it", "it alone"))
    _check.color("background", background)
    _check.number("line_width", line_width, low=0.1, high=1000.0)
    if output is None:
        output = [Path(f"{file.stem}-lit.vtp"), Path(f"{file.stem}-lit.png")]
        if not surface and contour is None:
            output.pop(0)
    for path in output:
        files.check_output(path, (".png", *files.SUFFIXES))
        if path.exists() and file.exists() and path.samefile(file):
            raise files.FileError(
                _check.message("output", "another file than the input", f"'{path}'")
            )
    pictures = [path for path in output if path.suffix.lower() == ".png"]
    meshes = [path for path in output if path not in pictures]
    pixels = _size(size)
    mesh = files.read_mesh(file)
    if average_cells and not {contour, warp} <= {None, *getattr(mesh, "point_data", {})}:
        mesh = mesh.cell_data_to_point_data()
    if warp is not None:
        mesh = files.warped(mesh, warp, 1.0 if warp_factor is None else warp_factor)
    hint = None if contour or warp else _hint(mesh)
    if surface or contour is not None:
        mesh = files.surface_of(mesh, contour, level)
    for path in meshes:
        files.check_format(mesh, path)
    camera = render.camera_on(
        mesh,
        _vector("view", view),
        up=None if up is None else _vector("up", up),
        parallel=parallel,
        zoom=zoom,
        aspect=pixels[0] / pixels[1],
    )
    lights = [vizlight.Light(direction=_vector("light", text)) for text in light or ()]
    lights += [vizlight.Light(position=_vector("lamp", text)) for text in lamp or ()]
    if headlight:
        lights.append(vizlight.Light.headlight())
    scene = vizlight.Scene(
        lights=lights or [vizlight.Light(direction=render.over_shoulder(camera))],
        material=vizlight.Material(
            ambient=ambient, diffuse=diffuse, specular=specular, shininess=shininess, color=color
        ),
        view=vizlight.View.from_camera(camera),
        depth_cue=vizlight.DepthCue(back_scale=0.5) if depth_cue else None,
    )
    start = time.perf_counter()
    asked = vizlight.report() if report else contextlib.nullcontext()
    with warnings.catch_warnings(record=True) as caught, asked as cost:
        warnings.simplefilter("always", UserWarning)
        lit = illuminate(
            mesh,
            scene,
            tangents=tangents,
            conditioned=conditioned,
            two_sided=two_sided,
            flip_normals=flip_normals,
            compensate=compensate,
            model=model,
            tolerance=_fraction("tolerance", tolerance),
            average_cells=average_cells,
            components=components,
            name=name,
            precision=precision,
            progress_bar=progress,
        )
    seconds = time.perf_counter() - start
    if hint and (surface or "flat" in hint):
        _say(f"note     {hint}")
    for warning in caught:
        sys.stderr.write(f"vizlight: {warning.message}\n")
    bright = sum(int((leaf.point_data[name] > 1).sum()) for leaf in leaves(lit))
    if bright and pictures:
        sys.stderr.write(
            f"vizlight: {bright} of {lit.n_points} points are brighter than 1 and white in the "
            "picture; a smaller --ambient, --diffuse or --specular shows them\n"
        )
    told = provenance(lit, name)
    terms = " + ".join(told["terms"])
    _say(f"{lit.n_points} points lit in {seconds:.3f} s, {told['precision']}: {terms}")
    if cost is not None:
        _say(str(cost))
    if explain:
        k: int | None = 1 if has_lines_only(lit) else None
        if tangents is not None:
            k = lit[tangents].shape[1] // 3
        plan = engine.plan(
            vizlight.Scene.from_dict(told["scene"]),
            k=k,
            normals=k is None or conditioned,
            dtype=None if precision is None and told["options"]["tolerance"] else told["precision"],
            model=model,
            tolerance=told["options"]["tolerance"],
            compensate=compensate,
            two_sided=two_sided,
        )
        _say(plan.explain())
    for path in meshes:
        _say(f"mesh     {files.write_mesh(lit, path)}")
    codes = [
        _draw(
            render.Panel(lit, part_name(name, "rgb") if scene.colored else name),
            path,
            camera=camera,
            size=pixels,
            background=background,
            line_width=line_width,
            backend=backend,
        )
        for path in pictures
    ]
    return max(codes, default=OK)


@app.command
def doctor() -> int:
    """Say what is installed, what draws here, what is missing and how to get it."""
    from rich.table import Table

    from vizlight import doctor
    from vizlight.pictures import render

    table = Table("part", "found", title="vizlight doctor")
    table.columns[1].overflow = "fold"
    for part, found in doctor.findings():
        table.add_row(part, found)
    _console.console().print(table)
    try:
        render.choose_backend()
    except render.BackendError as error:
        sys.stderr.write(f"vizlight: {error}\n")
        return LACKING
    return OK


@app.command
def study(
    name: str | None = None,
    /,
    *,
    quick: bool = False,
    out: Annotated[Path, Parameter(name=["--out", "-o"])] = Path("vizlight-study"),
) -> int:
    """Measure speed against error; without a name list the studies.

    Prints a table and a verdict, and writes NAME.csv and the log-log figure NAME.png.

    Parameters
    ----------
    name
        Of the study.
    quick
        Measure less: under 20 s on 2 cores.
    out
        The folder to write to; made if it is missing.
    """
    from vizlight import files, studies

    if name is None:
        studies.print_list({known: studies.load(known) for known in studies.names()})
        return OK
    chosen = studies.load(name)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise files.FileError(
            _check.message("out", "a folder that can be made", f"'{out}' ({error.strerror})")
        ) from error
    try:
        result = studies.run(name, chosen, quick=quick, progress_bar=True)
    except studies.LackingError as error:
        sys.stderr.write(f"vizlight: {error}\n")
        return LACKING
    studies.print_result(result)
    _say(f"table    {result.write_csv(out / f'{name}.csv')}")
    _say(f"figure   {result.draw(out / f'{name}.png')}")
    return OK


def _hint(mesh: Any) -> str | None:
    """Return what may have been meant for a volume, of which the hull is lit, or a flat field."""
    from vizlight.mesh.blocks import leaves

    parts = [leaf for leaf in leaves(mesh) if leaf.n_cells]
    names = [
        name for leaf in parts[:1] for name, values in leaf.point_data.items() if values.ndim == 1
    ]
    if not names:
        return None
    if any(leaf.GetMaxSpatialDimension() == 3 for leaf in parts):
        return f"the hull of a volume is lit; --contour {names[0]} lights an isosurface of it"
    if all(leaf.GetMaxSpatialDimension() == 2 and not min(leaf.bounds_size) for leaf in parts):
        return f"the mesh is flat; --warp {names[0]} raises it by its heights"
    return None


def _draw(panels: Any, path: Path, **options: Any) -> int:
    """Draw a picture; where nothing draws say so and keep what was written."""
    from vizlight.pictures import render

    try:
        _say(f"picture  {render.save_png(panels, path, **options)}")
    except render.BackendError as error:
        sys.stderr.write(f"vizlight: {error}\n")
        return LACKING
    return OK


def _say(text: str) -> None:
    sys.stdout.write(f"{text}\n")


def _vector(name: str, text: str) -> tuple[float, ...]:
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    if len(values) != 3:
        raise ValueError(_check.message(f"--{name}", "three numbers x,y,z", repr(text)))
    if name != "lamp" and not any(values):
        raise ValueError(_check.message(f"--{name}", "a direction x,y,z, not all zero", repr(text)))
    return values


def _fraction(name: str, text: str) -> float:
    try:
        return float(Fraction(text))
    except (ValueError, ZeroDivisionError) as error:
        expected = "a number or a fraction such as 1/255"
        raise ValueError(_check.message(f"--{name}", expected, repr(text))) from error


def _size(text: str) -> tuple[int, int]:
    from vizlight.pictures import render

    width, _, height = text.lower().partition("x")
    if not (width.isdecimal() and height.isdecimal()):
        raise ValueError(_check.message("--size", "WIDTHxHEIGHT in pixels", repr(text)))
    columns, rows = render.pixels_of((int(width), int(height)))
    return columns, rows


if __name__ == "__main__":
    sys.exit(main())
