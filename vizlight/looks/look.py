"""``vizlight.look``: from any data to a finished picture, and the decision as a value."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check, files
from vizlight._words import message, one_of
from vizlight.looks import options as look_options
from vizlight.looks import recipes
from vizlight.looks.contents import Contents
from vizlight.looks.recipes import Case
from vizlight.looks.rules import RULES, Rule
from vizlight.looks.steps import Step, source
from vizlight.mesh import blocks, georeference, series

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Foreign, Given
    from vizlight.looks.contents import Named
    from vizlight.looks.recipes import Drawing
    from vizlight.looks.wishes import Wishes
    from vizlight.scene import Scene

__all__ = ["Look", "look"]

#: Endings of the names of pictures, pages, and movies.
PICTURES = (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff")
PAGES, MOVIES, GLTF = (".html", ".htm"), (".mp4", ".gif"), (".glb",)
#: Most other questions that are listed.
MOST_OTHERS = 5


@dataclass(frozen=True)
class Other:
    """Another question that the data can answer.

    Parameters
    ----------
    question : str
        Question.
    array : str, optional
        Array that it shows.
    python : str
        Arguments of :func:`vizlight.look` that ask it.
    shell : str
        Options of the command line that ask it.
    """

    question: str
    array: str | None
    python: str
    shell: str


@dataclass(frozen=True, eq=False)
class Look:
    """Decision how data are shown; made by :func:`vizlight.look`.

    Attributes
    ----------
    question : str
        Question that the light answers: direction, slope, heading, shape or value, relief for
        heights, ``"none"`` for colours without light, or that of a filter.
    shown : str
        What is drawn: sheet, surface, isosurface, slices, hull, streamlines, lines or points.
    array : str or None
        Array that is shown.
    reason : str
        Why, in words.
    others : tuple of Other
        What else can be asked, each with the words that ask it.
    """

    question: str
    shown: str
    array: str | None
    reason: str
    others: tuple[Other, ...]
    _wishes: Wishes
    _drawing: Drawing
    _file: str | None = None

    @property
    def mesh(self) -> pv.DataSet | pv.MultiBlock:
        """Mesh that is drawn, with its light as point arrays."""
        mesh: pv.DataSet = self._drawing.lit.run()
        return mesh

    @property
    def scene(self) -> Scene:
        """Lights, material and view."""
        scene: Scene = self._drawing.scene.run()
        return scene

    @property
    def view(self) -> pv.Camera:
        """Camera of the picture."""
        camera: pv.Camera = self._drawing.camera.run()
        return camera

    @property
    def notes(self) -> tuple[str, ...]:
        """What a reader should know, such as a factor of heights."""
        return tuple(self._drawing.notes)

    def plotter(self, *, off_screen: bool = True) -> pv.Plotter:
        """Return a plotter that shows the picture, which the caller must close."""
        plotter, steps = self._picture(off_screen=off_screen)
        made: pv.Plotter = plotter.run()
        try:
            for step in steps:
                step.run()
        except BaseException:
            made.close()
            raise
        return made

    def show(self, **options: Given) -> object:
        """Show the picture in a window, or in a notebook.

        Parameters
        ----------
        **options
            Keywords of ``pyvista.Plotter.show``.
        """
        return self.plotter(off_screen=bool(pv.OFF_SCREEN)).show(**options)

    def save(self, path: str | Path, /) -> Path:
        """Save the picture, a page, a movie of a turn, or the lit mesh, by the ending of the name.

        Parameters
        ----------
        path : path
            Path of a picture (.png, .jpg, .tif, .bmp), of a page (.html) whose light follows the
            reader's eye, of a glTF file (.glb), of a movie of one turn (.mp4, .gif), or of a mesh
            (.vtp, .vtu, .vtk, .vts, .vti, .vtr, .vtm). An existing file is replaced.

        Returns
        -------
        pathlib.Path

        Raises
        ------
        FileError
            If the file cannot be written.
        BackendError
            If a picture is asked for and no OpenGL library can draw here.
        """
        last = self.steps([path])
        result: Path | list[Path] = [step.run() for step in last][-1]
        return result[0] if isinstance(result, list) else Path(result)

    def script(self, *paths: str | Path) -> str:
        """Return Python that does the same without ``look``.

        Parameters
        ----------
        *paths : path
            Files that the script writes, as :meth:`save` does. Default: ``look.png``.
        """
        return source([self.steps(paths or ["look.png"])])

    def steps(self, paths: Sequence[str | Path]) -> list[Step]:
        """Return the steps that write files, in their order."""
        last: list[Step] = []
        every = (*PICTURES, *PAGES, *MOVIES, *GLTF, *files.SUFFIXES)
        for path in paths:
            checked = files.check_output(path, every)
            last += self._written(checked)
        return last

    def _written(self, path: Path) -> list[Step]:
        suffix, drawing = path.suffix.lower(), self._drawing
        if suffix in PICTURES:
            plotter, steps = self._picture()
            return [*steps, Step("", "render.save", plotter, path)]
        if suffix in PAGES:
            plotter, steps = self._picture()
            return [*steps, Step("", ".vizlight.export_html", plotter, path)]
        if suffix in MOVIES:
            plotter, steps = self._picture()
            return [*steps, Step("", "movie.orbit", plotter, path)]
        if suffix in GLTF:
            return [Step("", "vizlight.save_gltf", drawing.lit, None, path)]
        return [Step("", "files.write_mesh", drawing.lit, path)]

    def _picture(self, *, off_screen: bool = True) -> tuple[Step, list[Step]]:
        """Return the step that makes a plotter, and those that fill it."""
        wishes, drawing = self._wishes, self._drawing
        chosen = {"backend": wishes.picture.get("backend"), "off_screen": off_screen}
        keywords = {name: value for name, value in chosen.items() if value not in (None, True)}
        background = wishes.background
        plotter = Step("plotter", "render.canvas", wishes.size, background=background, **keywords)
        steps = [layer.added(plotter) for layer in drawing.layers]
        if wishes.picture.get("key", True):
            steps += [_key_step(plotter, key) for key in drawing.keys]
        steps.append(Step("", ".camera=", plotter, Step("", ".copy", drawing.camera)))
        return plotter, steps

    def figures(self) -> object:
        """Return what a reader reads back from the picture: :func:`vizlight.legibility`."""
        plotter = self.plotter()
        try:
            return plotter.vizlight.legibility()
        finally:
            plotter.close()

    def __str__(self) -> str:
        others = "; ".join(other.python for other in self.others) or "nothing else"
        return f"shown    {self.summary}\nwhy      {self.reason}\nask      {others}"

    @property
    def summary(self) -> str:
        """What is shown, in one line."""
        return f"{self._drawing.words} ({self.question}: {self.shown})"

    def _repr_html_(self) -> str:
        import base64
        import html
        import io

        from PIL import Image

        plotter = self.plotter()
        try:
            picture = Image.fromarray(np.asarray(plotter.screenshot(return_img=True)))
        finally:
            plotter.close()
        data = io.BytesIO()
        picture.save(data, "PNG")
        text = base64.b64encode(data.getvalue()).decode()
        image = f'<img alt="{html.escape(self.summary)}" src="data:image/png;base64,{text}"/>'
        return f"{image}<pre>{html.escape(str(self))}</pre>"


def _key_step(plotter: Step, key: dict[str, object]) -> Step:
    keywords = dict(key)
    scene = keywords.pop("scene", None)
    return Step("", ".vizlight.add_key", plotter, *([scene] if scene else []), **keywords)


def look(
    data: pv.DataSet | pv.MultiBlock | str | Path,
    question: str = "auto",
    /,
    *,
    array: str | None = None,
    view: object = None,
    size: tuple[int, int] = (1200, 800),
    style: str = "paper",
    **options: Given,
) -> Look:
    """Decide how data are shown: what of them, in which light, from where and with which key.

    Parameters
    ----------
    data : mesh, path or xarray object
        Mesh, file, or dataset to show.
    question : str, default: "auto"
        What the picture should tell: ``"direction"``, ``"slope"``, ``"heading"``, ``"shape"``,
        ``"value"``, ``"relief"``, ``"flow"``. ``"auto"``: what suits the data.
    array : str, optional
        Array that is shown; of components their names, ``"u,v"``. Default: the best.
    view : str, vector or pyvista.Camera, optional
        Direction toward the eye: a name such as ``"x"`` or ``"above"``, three numbers, or a camera.
        Default: what suits the data.
    size : (int, int), default: (1200, 800)
        Width and height of the picture in pixels.
    style : {"paper", "dark"}
        Background of the picture: white or nearly black.
    **options
        Further options. What is taken of the data: ``time``, ``overlay``, ``contour``, ``level``,
        ``warp``, ``exaggeration``. The light: ``scene``, and options of
        :func:`vizlight.illuminate` or of the filter of the question, such as ``tangents``. The
        picture: ``background``, ``line_width``, ``cmap``, ``clim``, ``key``, ``up``, ``parallel``,
        ``zoom``, ``backend``.

    Returns
    -------
    Look
        The decision, which shows and saves itself.

    Raises
    ------
    TypeError, ValueError
        If an option does not fit, or the data cannot answer the question.
    FileError
        If the file cannot be read.

    Examples
    --------
    >>> import vizlight
    >>> winds = vizlight.load_example("winds_of_july.vtp")
    >>> vizlight.look(winds).question
    'direction'
    """
    _check.text("question", question)
    wishes = look_options.sorted_out(
        question, array=array, view=view, size=size, style=style, options=options
    )
    return decide(data, wishes)


def decide(data: object, wishes: Wishes) -> Look:
    """Return the look of data, by options that are sorted out."""
    step, contents, notes = prepared(data, wishes)
    rule, case = _chosen(step, contents, wishes)
    drawing = rule.recipe(case)
    drawing = replace(drawing, notes=[*notes, *drawing.notes])
    array = None if case.array is None else case.array.name
    eye = case.eye(drawing.layers[0].mesh)
    reason = rule.why + (f"; seen {eye.words}" if eye.words and wishes.view is None else "")
    shown = drawing.words.split(" ", 1)[0] if rule.shown == "isosurface" else rule.shown
    return Look(
        case.question, shown, array, reason, _others(contents, case), wishes, drawing,
        str(data) if isinstance(data, str | Path) else None,
    )  # fmt: skip


def prepared(data: object, wishes: Wishes) -> tuple[Step, Contents, list[str]]:
    """Return the step that reads data and takes a part of them, what they hold, and notes."""
    part, notes, raster = wishes.part, [], False
    if isinstance(data, str | Path):
        keywords = {name: part[name] for name in ("time", "overlay") if part.get(name)}
        step = Step("data", "vizlight.read", data, **keywords)
        raster = Path(data).suffix.lower() in (*georeference.SUFFIXES, ".dem")
        if part.get("time") is None and (note := series.note(step.run())):
            notes.append(note)
    else:
        mesh = data
        if isinstance(mesh, pv.MultiBlock):
            blocks.check(mesh)
            mesh = blocks.one_grid(mesh)
        if not isinstance(mesh, pv.DataSet):
            expected = "a PyVista mesh, a path or an xarray object"
            raise TypeError(message("data", expected, _check.describe(data)))
        step = Step("mesh", "-", mesh)
    mesh = step.run()
    if not mesh.n_points:
        raise ValueError(message("data", "a mesh with points", "none"))
    step = look_options.cut(step, wishes)
    factor = 1.0 if part.get("slice") else georeference.stretch(step.run())
    if factor != 1:
        step = Step("stretched", "files.stretched", step, factor)
        notes.append(f"the volume is in metres over its map, its z taken {factor:g} times")
    return step, Contents(step.run(), raster), notes


def _chosen(data: Step, contents: Contents, wishes: Wishes) -> tuple[Rule, Case]:
    """Return the rule that fits, and the case that its recipe draws."""
    array = _asked_array(contents, wishes)
    question = wishes.question
    if wishes.part.get("contour") is not None and question == "auto" and array is None:
        question = "shape"
    fitting = [rule for rule in RULES if rule.fits(contents)]
    for rule in fitting:
        if question not in ("auto", rule.question, _ALIASES.get(rule.question)):
            continue
        if array is not None and array.role not in rule.roles:
            continue
        if array is None and not rule.holds(contents):
            continue
        chosen = rule.array(contents) if array is None else array
        return rule, Case(data, contents, wishes, rule.question, chosen)
    return _explicit(data, contents, wishes, array, question)


#: Other words for questions: a sheet's values are coloured without light.
_ALIASES = {"none": "value", "heading": "flow"}


def _explicit(
    data: Step, contents: Contents, wishes: Wishes, array: Named | None, question: str
) -> tuple[Rule, Case]:
    """Return a rule for a question that the table has not for these data."""
    known = [named.name for named in contents.arrays]
    recipe, roles = _EXPLICIT.get(question, (None, ()))
    if recipe is None:
        expected = f"a question that these data answer, {one_of(sorted(_EXPLICIT))}"
        raise ValueError(message("question", expected, repr(question)))
    chosen = array or (contents.first(*roles) if roles else None)
    if roles and (chosen is None or chosen.role not in roles):
        needs = " or ".join(roles)
        got = f"none among {', '.join(map(repr, known))}" if known else "no array"
        raise ValueError(message("array", f"{needs} for {question!r}", got))
    kind = next(rule.shown for rule in RULES if rule.fits(contents))
    rule = Rule(kind, lambda _: True, question, roles, recipe, f"{question} was asked for")
    return rule, Case(data, contents, wishes, question, chosen)


#: Recipes of questions, and the roles of the array that they need.
_EXPLICIT: Foreign = {
    "direction": (recipes.vectors, ("vectors",)),
    "slope": (recipes.vectors, ("vectors",)),
    "heading": (recipes.vectors, ("vectors",)),
    "shape": (recipes.surface, ()),
    "value": (recipes.values, ("values", "heights", "kinds", "colors")),
    "relief": (recipes.relief, ("heights", "values")),
    "flow": (recipes.flow, ("vectors",)),
}


def _asked_array(contents: Contents, wishes: Wishes) -> Named | None:
    """Return the array that was asked for, by any of the options that name one."""
    name = wishes.array or wishes.light.get("tangents") or wishes.picture.get("scalars")
    if not isinstance(name, str):
        return None
    named = contents.named(name)
    if named is None:
        there = [*contents.mesh.point_data, *contents.mesh.cell_data]
        expected = f"the name of an array, {one_of(there)}"
        raise ValueError(message("array", expected, repr(name)))
    return named


def _others(contents: Contents, case: Case) -> tuple[Other, ...]:
    """Return what else the data can tell."""
    shown = None if case.array is None else case.array.name
    others = [
        Other(array.role, array.name, f"array={array.name!r}", f"--array {array.name}")
        for array in contents.arrays
        if array.name != shown
    ]
    if case.question != "shape" and contents.flat_axis is None and contents.dimension > 1:
        others.append(Other("shape", None, "question='shape'", "--for shape"))
    return tuple(others[:MOST_OTHERS])
