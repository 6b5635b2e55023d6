"""The run of a command on each file: look, compute, write and draw, or print a script."""

from __future__ import annotations

import functools
import gc
import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import vizlight
from vizlight._supervise import BAD_INPUT
from vizlight._words import message, value_error
from vizlight.cli.output import OK, add_note, complain, draw, notes_at_end, one_line, say
from vizlight.cli.scenes import times
from vizlight.looks.steps import Step, in_order, source, written

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight.cli.options import FilePart, Output
    from vizlight.looks.look import Look
    from vizlight.looks.wishes import Wishes

#: Words before the path that a step writes, for anything but a mesh.
SAID = {
    "render.save": "picture", "movie.orbit": "movie", "movie.travel": "movie",
    "film.save": "movie",
    ".vizlight.save_graphic": "picture", "vizlight.live_html": "page",
    ".vizlight.export_html": "page",
}  # fmt: skip


@dataclass(frozen=True)
class Command:
    """One command: the options of its looks, and its output.

    ``stem`` is the end of the names of files that have none, ``tell`` returns the notes on a look,
    or an empty text, ``read`` asks for the legibility of the picture, and ``recipe`` has the
    options of a command that lights a file alike, which a page copies.
    """

    wishes: Wishes
    out: Output
    stem: str
    part: FilePart
    tell: Callable[[Look], str] | None = None
    read: bool = False
    recipe: Sequence[str] | None = None

    def carry_out(self, paths: Sequence[Path]) -> int:
        """Show each file, or print the script that does; return the exit code.

        Several files make one picture if the output names one file. Otherwise an error in one of
        them is reported, and the others are still done. A file whose steps are taken one by one
        counts as several.
        """
        if not gc.isenabled():
            # What was loaded stays, and is not looked through again.
            gc.freeze()
            gc.enable()
        out = self.out
        named = out.output or ()
        joined = len(paths) > 1 and bool(named) and not any(path.is_dir() for path in named)
        if joined and self.part.times is not None:
            expected = "one time for several files in one picture"
            raise value_error("times", expected, self.part.times, "pass --time")
        groups = [list(paths)] if joined else [[path] for path in paths]
        _check_output(out, several=len(groups) > 1 or self._is_by_step)
        stems = [path.stem for path in paths]
        for twice in (name for name in stems if not joined and stems.count(name) > 1):
            expected = "files of different names, after which the outputs are named"
            raise value_error("file", expected, f"{twice!r} twice")
        scripts: list[list[Step]] = []
        codes = [OK]
        for group in groups:
            try:
                # A file that is refused has no notes.
                with notes_at_end():
                    steps = [None] if joined else times(group[0], self.part)
                    # Of a movie the look is that of the first step.
                    steps = steps if self._is_by_step else steps[:1]
                    for i, time in enumerate(steps):
                        look = self._look(group, time)
                        ending = self.stem if not self._is_by_step else f"{self.stem}-{i:04d}"
                        outputs = _outputs(look, f"{group[0].stem}-{ending}", out, paths)
                        if out.script:
                            last = [step for steps in outputs for step in steps]
                            read = look.read_steps() if self.read else []
                            checks = _checks(look) if out.report else []
                            scripts.append([*checks, *read, *last])
                        else:
                            codes.append(self._run(look, outputs))
            except (TypeError, ValueError, OSError) as error:
                # The error of a single file becomes the command's.
                if len(groups) == 1:
                    raise
                complain(f"{group[0]}: {one_line(error)}")
                codes.append(BAD_INPUT)
        if scripts:
            say(source(scripts))
        return max(codes)

    @property
    def _is_by_step(self) -> bool:
        """Whether steps are lit one by one, and are not those of a movie."""
        from vizlight.looks.look import MOVIES

        named = self.out.output or ()
        are_movies = bool(named) and all(path.suffix.lower() in MOVIES for path in named)
        return self.part.times is not None and not are_movies

    def _look(self, paths: Sequence[Path], time: float | str | None) -> Look:
        """Return the look of a file at a time, or of several in one picture."""
        from vizlight.looks.look import decide

        part = dict(self.wishes.part)
        if time is not None:
            part["time"] = time
        only = len(paths) == 1
        source_words = [] if self.recipe is None or not only else [str(paths[0]), *self.recipe]
        wishes = replace(self.wishes, part=part, source=source_words)
        if self.part.times is not None and not self._is_by_step:
            steps = [step for step in times(paths[0], self.part) if isinstance(step, float)]
            wishes = replace(wishes, steps=steps)
        return decide(paths[0] if only else list(paths), wishes)

    def _run(self, look: Look, outputs: Sequence[Sequence[Step]]) -> int:
        """Light, then write, draw and print; return the exit code."""
        from vizlight import writing

        lit = look.drawing.lit
        needed = any(step is lit for steps in outputs for step in in_order(steps))
        if self.out.report or self.tell or self.read or needed:
            self._light(look)
        # All formats are checked before the first file is written.
        for *_, last in outputs:
            if last.path == "files.write_mesh":
                mesh, path = last.arguments
                assert isinstance(mesh, Step)
                writing.check_format(mesh.run(), str(path))
        if self.read:
            say(str(look.figures()))
        codes = [OK]
        for steps in outputs:
            kind = SAID.get(steps[-1].path, "mesh")
            # A page is written without a library that draws too.
            codes.append(draw(functools.partial(written, steps), kind))
        # Last, so that an error is the only word on a step that failed.
        say(f"shown    {look.summary}")
        of_one_step = {steps[-1].note for steps in outputs if steps[-1].path == "film.save"}
        for note in dict.fromkeys(look.notes):
            if note not in of_one_step:
                say(f"note     {one_line(note)}")
        if look.others:
            say(f"ask      {'; '.join(other.shell for other in look.others)}")
        return max(codes)

    def _light(self, look: Look) -> None:
        """Light the points of the mesh and print how."""
        from vizlight.mesh.blocks import all_blocks

        step = look.drawing.lit
        # Reading and cutting come before, so that the time is the light's alone.
        for value in step.parts():
            if isinstance(value, Step):
                value.run()
        start = perf_counter()
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", UserWarning)
            lit = step.run()
        seconds = perf_counter() - start
        if self.tell is not None and (text := self.tell(look)):
            say(text)
        for warning in caught:
            add_note(warning.message)
        name = _name(look)
        record = vizlight.provenance(lit, name)
        terms = " + ".join(record.get("terms", [name]))
        points = sum(block.n_points for block in all_blocks(lit))
        say(f"{points} points lit in {seconds:.3f} s, {record['precision']}: {terms}")
        if self.out.report:
            say(str(vizlight.check(lit, name=name)))


def _name(look: Look) -> str:
    """Return the name of the light of a look."""
    return str(look.drawing.lit.keywords.get("name", look.drawing.name))


def _checks(look: Look) -> list[Step]:
    """Return the steps that print the cost and the error of the light of a look."""
    from vizlight.shading.results import DEFAULT_NAME

    name = _name(look)
    named = {} if name == DEFAULT_NAME else {"name": name}
    lit = look.drawing.lit
    return [lit, Step("", "print", Step("", "vizlight.check", lit, **named))]


def _check_output(out: Output, *, several: bool) -> None:
    """Check the options of output that need no mesh."""
    from vizlight import _check, files, writing
    from vizlight.looks.look import FORMATS, MOVIES

    _check.color("background", out.background)
    for path in out.output or ():
        if several and not path.is_dir():
            expected = "a folder that exists, for several files or steps"
            is_movie = path.suffix.lower() in MOVIES
            remedy = "name movies alone, or none" if is_movie else ""
            raise files.FileError(message("output", expected, f"'{path}'", remedy))
        if not path.is_dir():
            writing.check_output(path, FORMATS, name="output")
    if out.paraview and several:
        raise value_error("paraview", "one file to light", "several")
    if out.paraview:
        writing.check_output(out.paraview, (".py",), name="paraview")


def _outputs(look: Look, stem: str, out: Output, inputs: Sequence[Path]) -> list[list[Step]]:
    """Return the steps that write each file; they write over no input."""
    import pyvista as pv

    from vizlight import writing

    paths: list[Path] = []
    # Light at all points of a volume is for a file that is named.
    suffix = look.drawing.suffix() if look.wishes.surface else ""
    for path in out.output or ([] if out.paraview else [Path()]):
        endings = (suffix, ".png") if suffix else (".png",)
        paths += [path / f"{stem}{end}" for end in endings] if path.is_dir() else [path]
    # A mesh is written before a picture is drawn, which a machine may not be able to do.
    paths.sort(key=lambda path: path.suffix.lower() not in writing.SUFFIXES)
    outputs = [steps for path in paths for steps in look.steps(path)]
    if out.paraview:
        outputs.append([Step("", "paraview.save", look.drawing.lit, None, out.paraview)])
    kind = look.drawing.kind
    for *_, last in outputs:
        target = Path(str(last.arguments[-1]))
        _refuse_input(target, inputs, is_script=last.path == "paraview.save")
        whole = last.path == "files.write_mesh" and last.arguments[0] is look.drawing.lit
        if whole and not look.drawing.parts:
            writing.check_format(pv.PolyData() if kind is None else kind.run(), target)
    return outputs


def _refuse_input(path: Path, inputs: Sequence[Path], *, is_script: bool) -> None:
    """Refuse an input as an output."""
    from vizlight import files

    if is_script:
        from vizlight.draw.paraview import beside

        path = beside(path)
    # The files are compared, not their names: a link or another spelling leads to the same one.
    if any(path.exists() and file.exists() and path.samefile(file) for file in inputs):
        raise files.FileError(message("output", "another file than the input", f"'{path}'"))
