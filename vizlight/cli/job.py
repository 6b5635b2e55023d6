"""What a command does with each file: check, compute, write and draw, or print a script."""

from __future__ import annotations

import contextlib
import inspect
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import vizlight
from vizlight._supervise import BAD_INPUT
from vizlight._words import message
from vizlight.cli.output import OK, complain, draw, one_line, say
from vizlight.cli.scenes import TINT, known, times, tinted
from vizlight.looks.steps import Step, in_order, source

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pyvista as pv

    from vizlight._types import Keywords
    from vizlight.cli.options import Color, Output, Part
    from vizlight.cli.scenes import Look


#: File name extension of glTF, which holds what of the light does not depend on the eye.
GLTF = ".glb"
#: File name extension of a page in which the light follows the eye.
HTML = ".html"
#: Files that no writer of meshes writes, and the functions that do.
SHOWN = {GLTF: "vizlight.save_gltf", HTML: "vizlight.live_html", ".py": "paraview.save"}
#: Options of light that its key has too.
KEY_OPTIONS: tuple[str, ...] = ("exponent", "conditioned")
#: Files that hold all parts of a result.
TOGETHER = (HTML, ".vtm")


@dataclass
class Job:
    """Steps for one file.

    Parameters
    ----------
    lit
        Step that lights.
    look, camera
        How the picture is seen.
    shown
        Mesh of the picture. Default: what is lit.
    scalars
        Name of the array that is shown. Default: the light, or its colour.
    kind
        Step whose mesh is of the type of the result, None where no mesh is yet.
    parts
        Names of the blocks that are written to files of their own.
    suffix
        Format of the mesh where none is given, none to write only a picture.
    color
        Array and colour map of that mesh.
    title
        What its colours stand for, which a key tells; empty where they are colours already.
    clim
        Values that are black and white in the picture. Default: 0 and 1.
    tell
        Functions that return what a reader should know of the lit mesh, or an empty text.
    read
        Step that measures what a reader can read back from the picture.
    source
        File and options of a command that lights it alike, which a page copies.
    """

    lit: Step
    look: Look
    camera: Step
    shown: Step | None = None
    scalars: str | None = None
    kind: Step | None = field(default_factory=lambda: Step("", "pyvista.PolyData"))
    parts: Sequence[str] = ()
    suffix: str = ".vtp"
    color: Color | None = None
    title: str = ""
    clim: tuple[float, float] | None = None
    tell: list[Callable[[pv.DataSet], str]] = field(default_factory=list)
    read: Step | None = None
    source: Sequence[str] = ()

    def tint(self, data: Step, color: Color) -> None:
        """Show the colours of an array of the data, lit, if one is asked for."""
        if color.scalars is not None:
            self.shown, self.title = tinted(self.lit, self.name, data, color)
            self.scalars, self.color = TINT, color

    @property
    def name(self) -> str:
        """Name of the array that the filter makes."""
        filter_ = getattr(vizlight, self.lit.path.removeprefix("vizlight."))
        default = inspect.signature(filter_).parameters["name"].default
        return str(self.lit.keywords.get("name", default))

    @property
    def light(self) -> str:
        """Name of the light that a picture shows; a file may have an own "rgb"."""
        from vizlight.shading.results import part_name

        return part_name(self.name, "rgb") if self.look.colored else self.name


def carry_out(
    files_: Sequence[Path],
    build: Callable[[Path, float | str | None], Job],
    out: Output,
    stem: str,
    part: Part,
) -> int:
    """Do the job of each file, or print the script that does; return the exit code.

    With several files an error is reported, and the other files are still done. A file whose steps
    are taken one by one counts as several.
    """
    _check_output(out, several=len(files_) > 1 or part.times is not None)
    stems = [path.stem for path in files_]
    for twice in (name for name in stems if stems.count(name) > 1):
        expected = "files of different names, after which the outputs are named"
        raise ValueError(message("file", expected, f"{twice!r} twice"))
    scripts: list[list[Step]] = []
    codes = [OK]
    for path in files_:
        try:
            for i, time in enumerate(times(path, part)):
                job = build(path, time)
                own = f"{path.stem}-{stem if part.times is None else f'{stem}-{i:04d}'}"
                last = _outputs(job, own, out, files_)
                if out.script:
                    scripts.append([job.lit, *last])
                else:
                    codes.append(_run(job, last, out))
        except (TypeError, ValueError, OSError) as error:
            # The error of a single file becomes the command's.
            if len(files_) == 1:
                raise
            complain(f"{path}: {one_line(error)}")
            codes.append(BAD_INPUT)
    if scripts:
        say(source(scripts, reported=[steps[0] for steps in scripts] if out.report else []))
    return max(codes)


def _check_output(out: Output, *, several: bool) -> None:
    """Check the options of output that need no mesh."""
    from vizlight import _check, files

    _check.color("background", out.background)
    _check.number("line_width", out.line_width, low=0.1, high=1000.0)
    for path in out.output or ():
        if several and not path.is_dir():
            expected = "a folder that exists, for several files or steps"
            raise files.FileError(message("output", expected, f"'{path}'"))
        if not path.is_dir():
            files.check_output(path, (".png", GLTF, HTML, *files.SUFFIXES))
    if out.paraview and several:
        raise ValueError(message("paraview", "one file to light", "several"))
    if out.paraview:
        files.check_output(out.paraview, (".py",))


def _outputs(job: Job, stem: str, out: Output, inputs: Sequence[Path]) -> list[Step]:
    """Return the steps that leave something behind; no input is among what they write."""
    from vizlight import files

    paths: list[Path] = []
    for path in out.output or ([] if out.paraview else [Path()]):
        endings = (job.suffix, ".png") if job.suffix else (".png",)
        paths += [path / f"{stem}{end}" for end in endings] if path.is_dir() else [path]
    paths += [out.paraview] if out.paraview else []
    written, pictures = [], []
    for path in paths:
        suffix = path.suffix.lower()
        if suffix == ".png":
            pictures.append(_picture(job, path, out))
        elif not job.parts or suffix in TOGETHER:
            written.append(_written(job, job.lit, path, out))
        else:
            for part in job.parts:
                mesh = Step("", "[]", job.lit, part)
                written.append(_written(job, mesh, path.with_stem(f"{path.stem}-{part}"), out))
    for step in (*written, *pictures):
        path = Path(str(step.arguments[-1]))
        files.check_output(path, (".png", *SHOWN, *files.SUFFIXES))
        if path.suffix.lower() == ".py":
            from vizlight.draw.paraview import beside

            path = beside(path)
        # The files are compared, not their names: a link or another spelling leads to the same one.
        if any(path.exists() and file.exists() and path.samefile(file) for file in inputs):
            raise files.FileError(message("output", "another file than the input", f"'{path}'"))
        whole = step.path == "files.write_mesh" and not (job.parts and step.arguments[0] is job.lit)
        if whole and job.kind is not None:
            files.check_format(job.kind.run(), path)
    read = [] if job.read is None else [Step("", "print", job.read)]
    return [*read, *written, *pictures]


def _picture(job: Job, path: Path, out: Output) -> Step:
    """Return the step that draws the picture."""
    # A share that is 1 at most points is white, as paper is.
    plain = "gray" if job.scalars == job.name else None
    options = known(background=plain) | drawing(out) | known(clim=job.clim, key=_key(job))
    panel = Step("", "render.Panel", job.shown or job.lit, job.scalars or job.light)
    seen: Keywords = {"camera": job.camera, "size": job.look.size}
    return Step("", "render.save_png", panel, path, **seen, **options)


def drawing(out: Output) -> Keywords:
    """Return the options of a picture that are not left to their defaults."""
    width = None if out.line_width == 1 else out.line_width
    return known(background=out.background, line_width=width, backend=out.backend)


def _key(job: Job) -> Step | None:
    """Return the step that makes the key of light for a question or of colours, if there is one."""
    lights = job.look.lights
    scaled = job.title and lights.question in (None, "value")
    if not lights.key or not (lights.question or scaled):
        return None
    scene = job.lit.keywords.get("scene", job.lit.arguments[-1])
    given = job.lit.keywords
    options = {name: given[name] for name in KEY_OPTIONS if name in given}
    if scaled:
        colors = Step("", "vizlight.unlit_colors", job.shown, TINT)
        options = {"question": "value", "cmap": colors, "title": job.title}
    return Step("key", "vizlight.presets.key", scene, **options)


def _written(job: Job, mesh: Step, path: Path, out: Output) -> Step:
    """Return the step that writes a mesh."""
    suffix = path.suffix.lower()
    writer = SHOWN.get(suffix)
    if writer is None:
        return Step("", "files.write_mesh", mesh, path)
    color = job.color
    chosen: Keywords = {} if color is None else {"scalars": color.scalars}
    if color is not None and suffix in (GLTF, HTML):
        chosen |= known(cmap=color.cmap)
    if suffix == HTML:
        key = None if job.look.lights.key else False
        chosen |= known(camera=job.camera, source=list(job.source) or None, key=key)
        chosen |= {name: value for name, value in drawing(out).items() if name != "backend"}
    # No scene: the one in the record of the mesh is taken.
    return Step("", writer, mesh, None, path, **chosen)


def _run(job: Job, last: Sequence[Step], out: Output) -> int:
    """Light, then write, draw and print; return the exit code."""
    from vizlight import files

    lit = _light(job, out)
    # All formats are checked before the first file is written.
    for step in last:
        if step.path == "files.write_mesh":
            mesh, path = step.arguments
            assert isinstance(mesh, Step)
            files.check_format(mesh.run(), str(path))
    if any(step.path == "render.save_png" for step in last):
        _count_white(lit, job.light)
    codes = [OK]
    for step in last:
        if step.path == "render.save_png":
            codes.append(draw(step.run))
        elif step is last[0] and job.read is not None:
            say(str(job.read.run()))
        elif step.path == SHOWN[HTML]:
            with _window(out):
                say(f"page     {step.run()}")
        else:
            say(f"mesh     {step.run()}")
    return max(codes)


def _window(out: Output) -> contextlib.AbstractContextManager[None]:
    """Return a context for windows that need no display; a page is written without them too."""
    from vizlight.draw import backends

    try:
        return backends.window_class(backends.choose_backend(out.backend))
    except backends.BackendError:
        return contextlib.nullcontext()


def _light(job: Job, out: Output) -> pv.DataSet:
    """Light the mesh and print how."""
    from vizlight.mesh.blocks import all_blocks

    # What is read and cut comes before, so that the time is the light's alone.
    for value in job.lit.parts():
        if isinstance(value, Step):
            value.run()
    start = perf_counter()
    asked = vizlight.report() if out.report else contextlib.nullcontext()
    with warnings.catch_warnings(record=True) as caught, asked as cost:
        warnings.simplefilter("always", UserWarning)
        lit: pv.DataSet = job.lit.run()
    seconds = perf_counter() - start
    notes = [f"note     {step.note}" for step in in_order([job.shown or job.lit]) if step.note]
    for note in dict.fromkeys([*notes, *(tell(lit) for tell in job.tell)]):
        if note:
            say(note)
    for warning in caught:
        complain(one_line(warning.message))
    record = vizlight.provenance(lit, job.name)
    terms = " + ".join(record.get("terms", [job.name]))
    points = sum(block.n_points for block in all_blocks(lit))
    say(f"{points} points lit in {seconds:.3f} s, {record['precision']}: {terms}")
    if cost is not None:
        say(str(cost))
    return lit


def _count_white(lit: pv.DataSet, name: str) -> None:
    """Print how many points are too bright for the picture."""
    from vizlight.mesh.blocks import all_blocks

    blocks = [block for block in all_blocks(lit) if name in block.point_data]
    rows = [block.point_data[name].reshape(block.n_points, -1) for block in blocks]
    bright = sum(int((values > 1).any(axis=1).sum()) for values in rows)
    if bright:
        total = sum(block.n_points for block in blocks)
        complain(
            f"{bright} of {total} points are brighter than 1 and white in the "
            "picture; a smaller --ambient, --diffuse or --specular shows them"
        )
