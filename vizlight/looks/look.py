"""``vizlight.look``: from any data to a finished picture, and the decision as a value."""

from __future__ import annotations

import contextlib
import dataclasses
import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check, files, writing
from vizlight._questions import QUESTIONS
from vizlight._words import one_of, type_error, value_error
from vizlight.draw.margins import parted
from vizlight.draw.render import IMAGES, BackendError
from vizlight.draw.vector import VECTORS
from vizlight.looks import film, insets, map_parts, together, views
from vizlight.looks import options as look_options
from vizlight.looks.contents import Contents, may_be_ground
from vizlight.looks.recipes import fields, lines, maps, reliefs, surfaces
from vizlight.looks.recipes.drawing import Case
from vizlight.looks.rules import RULES, Rule
from vizlight.looks.steps import Step, run, source, written
from vizlight.looks.wishes import even_light, is_whole_earth
from vizlight.mesh import blocks, georeference, height_grids, meaning
from vizlight.reading import cf_grids, rasters, series
from vizlight.vtk.cells import dimensions

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Given, Keywords
    from vizlight.looks.contents import Named, Role
    from vizlight.looks.recipes.drawing import Drawing, Layer, Recipe
    from vizlight.looks.wishes import Wishes
    from vizlight.observers.figures import Legibility
    from vizlight.scene import Scene

__all__ = ["Look", "look"]

#: Endings of the names of pages, movies and glTF, and of all files that a look writes.
PAGES, MOVIES, GLTF = (".html", ".htm"), (".mp4", ".gif"), (".glb",)
FORMATS = (*IMAGES, *VECTORS, *PAGES, *MOVIES, *GLTF, *writing.SUFFIXES)
#: Files that hold all parts of a result.
TOGETHER = (*PAGES, ".vtm")
#: Figures of light.
OF_LIGHT = ("slope", "heading", "shape")
#: Frames of a turn, of 5 seconds, and options of the pace of movies.
TURN_FRAMES, PACE = 120, ("frames", "fps")
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
        Question that the light answers: that of a preset, or relief for heights, ``"none"`` for
        colours without light, or that of a filter.
    shown : str
        Kind of drawing: sheet, surface, isosurface, slices, hull, streamlines, lines or points.
    array : str or None
        Array that is shown.
    reason : str
        Why, in words.
    others : tuple of Other
        Other questions to the data, each with the words that ask it.
    """

    question: str
    shown: str
    array: str | None
    reason: str
    others: tuple[Other, ...]
    wishes: Wishes = dataclasses.field(repr=False)
    drawing: Drawing = dataclasses.field(repr=False)

    @property
    def mesh(self) -> pv.DataSet | pv.MultiBlock:
        """Mesh that is drawn, with its light as point arrays."""
        mesh: pv.DataSet = self.drawing.lit.run()
        return mesh

    @property
    def scene(self) -> Scene:
        """Lights, material and view."""
        scene: Scene = self.drawing.scene.run()
        return scene

    @property
    def view(self) -> pv.Camera:
        """Camera of the picture."""
        drawing = self.drawing
        camera: pv.Camera = (drawing.picture_camera or drawing.camera).run()
        return camera

    @property
    def key(self) -> tuple[Keywords, ...]:
        """Keywords of ``plotter.vizlight.add_key`` for each key and bar of the picture."""
        return tuple({name: run(value) for name, value in key.items()} for key in self._keys)

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes for a reader, such as a factor of heights."""
        return tuple(self.drawing.notes)

    def plotter(self, *, off_screen: bool | None = True) -> pv.Plotter:
        """Return a plotter that shows the picture, which the caller must close.

        Parameters
        ----------
        off_screen : bool or None, default: True
            Whether no window is shown; None is PyVista's own choice.
        """
        hidden = bool(pv.OFF_SCREEN) if off_screen is None else off_screen
        plotter, steps = self._picture(off_screen=_check.boolean("off_screen", hidden))
        picture: pv.Plotter = plotter.run()
        try:
            for step in steps:
                step.run()
        except BaseException:
            picture.close()
            raise
        return picture

    def show(self, **options: Given) -> object:
        """Show the picture in a window, or in a notebook.

        Parameters
        ----------
        **options
            Keywords of ``pyvista.Plotter.show``.
        """
        return self.plotter(off_screen=None).show(**options)

    def save(self, path: str | Path, /) -> Path:
        """Save the picture, a page, a movie of a turn, or the lit mesh, by the ending of the name.

        Parameters
        ----------
        path : path
            Path of a picture (.png, .jpg, .tif, .bmp), of vector graphics (.svg, .pdf), of a page
            (.html) whose light follows the reader's eye, of a glTF file (.glb), of a movie (.mp4,
            .gif) of the steps of a series, if no time was asked for, or in which the strokes of a
            field move with it, else of one turn, or of a mesh
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
        ValueError
            If a movie is asked for of a map on which nothing moves.
        """
        paths = [written(steps) for steps in self.steps(path)]
        return paths[0]

    def script(self, *paths: str | Path) -> str:
        """Return Python that does the same without ``look``.

        Parameters
        ----------
        *paths : path
            Files that the script writes, as :meth:`save` does. Default: ``look.png``.
        """
        every = [self.steps(path) for path in paths or ["look.png"]]
        return source([steps for file in every for steps in file])

    def steps(self, path: str | Path) -> list[list[Step]]:
        """Return the steps that write a file, or one file for each part of the result."""
        path = writing.check_output(path, FORMATS)
        suffix, drawing = path.suffix.lower(), self.drawing
        if suffix in (*PAGES, *MOVIES) and views.are_several(self.wishes.view):
            expected = f"one view for '{path}', in which a reader or the eye moves"
            got = _check.describe(self.wishes.view)
            raise value_error("view", expected, got, "name a file that ends in .png or .svg")
        if suffix in MOVIES:
            if (whole := film.step(self, path)) is not None:
                return [[whole]]
            moving = fields.moving(drawing)
            if moving is None and drawing.is_flat:
                expected = "a picture or a page of a map on which nothing moves"
                remedy = "name a file that ends in .png, .svg or .html"
                raise value_error("path", expected, repr(str(path)), remedy)
            shown = replace(self, drawing=moving or drawing.turning)
            plotter, steps = shown._picture()
            pace: Keywords = {name: self.wishes.picture.get(name) for name in PACE}
            options = {name: value for name, value in pace.items() if value is not None}
            way = "movie.travel"
            if moving is None:
                way, options = "movie.orbit", {"frames": TURN_FRAMES} | options
                # Shading at each of the samples of a pixel takes twice the time.
                step = Step("", ".enable_anti_aliasing", plotter, "msaa", multi_samples=8)
                steps.append(step)
            return [[*steps, Step("", way, plotter, path, **options)]]
        if suffix in (*IMAGES, *VECTORS):
            plotter, steps = self._picture()
            way = "render.save" if suffix in IMAGES else ".vizlight.save_graphic"
            return [[*steps, Step("", way, plotter, path)]]
        if suffix in PAGES:
            return [self._page(path)]
        if drawing.alone is not None and suffix in writing.SUFFIXES and suffix not in TOGETHER:
            _check.warn(
                f"'{path}' has the cells of the highest dimension; a .vtm file has all blocks"
            )
            return [[self._written(drawing.alone, path)]]
        if not drawing.parts or suffix in TOGETHER:
            return [[self._written(drawing.lit, path)]]
        paths = {part: path.with_stem(f"{path.stem}-{part}") for part in drawing.parts}
        parts = {part: Step("", "[]", drawing.lit, part) for part in drawing.parts}
        return [[self._written(mesh, paths[part])] for part, mesh in parts.items()]

    def _written(self, mesh: Step, path: Path) -> Step:
        if path.suffix.lower() in GLTF:
            # No scene: the one in the record of the mesh is taken.
            return Step("", "vizlight.save_gltf", mesh, path, **self.drawing.colors)
        return Step("", "files.write_mesh", mesh, path)

    def _page(self, path: Path) -> list[Step]:
        """Return the steps that write a page, for which no library needs to draw."""
        wishes, drawing = self.wishes, self.drawing.of_turns
        key: Keywords = {} if wishes.picture.get("key", True) else {"key": False}
        if wishes.picture.get("title"):
            key["title"] = wishes.picture["title"]
        if wishes.source:
            key["source"] = list(wishes.source)
        camera = drawing.camera
        if "aspect" in camera.keywords:
            # Beside its panel the picture of a page is as high as it is wide.
            keywords = camera.keywords | {"aspect": 1.0}
            camera = Step(camera.name, camera.path, *camera.arguments, **keywords)
        away = camera.run().distance / drawing.camera.run().distance
        layers = [_of_page(layer, away) for layer in drawing.layers]
        # The frame of a map is no data.
        if not any(layer.keywords.get("pickable", True) for layer in layers):
            shown: Keywords = {"camera": camera, "background": wishes.background, **key}
            return [Step("", "vizlight.live_html", drawing.lit, path, **shown)]
        background = wishes.background
        plotter = Step("plotter", "render.canvas", wishes.size, background=background, draws=False)
        return [
            *(layer.added(plotter) for layer in layers),
            *(_key_step(plotter, key) for key in self._keys),
            Step("", ".camera=", plotter, Step("", ".copy", camera)),
            Step("", ".vizlight.export_html", plotter, path, **key),
        ]

    def _picture(self, *, off_screen: bool = True) -> tuple[Step, list[Step]]:
        """Return the step that makes a plotter, and those that fill it."""
        wishes, drawing = self.wishes, self.drawing
        chosen = {"backend": wishes.picture.get("backend"), "off_screen": off_screen}
        keywords = {name: value for name, value in chosen.items() if value not in (None, True)}
        background = wishes.picture.get("background") or drawing.background or wishes.background
        plotter = Step("plotter", "render.canvas", wishes.size, background=background, **keywords)
        steps = [layer.added(plotter) for layer in (*drawing.layers, *drawing.insets)]
        steps += [_key_step(plotter, key) for key in self._keys]
        camera = drawing.picture_camera or drawing.camera
        steps.append(Step("", ".camera=", plotter, Step("", ".copy", camera)))
        return plotter, steps

    @property
    def _keys(self) -> list[Keywords]:
        """Keys and bars of the picture."""
        keys, wishes = self._titled_keys, self.wishes
        if not wishes.picture.get("key", True):
            return []
        is_named = wishes.picture.get("title") is not None
        if keys and not is_named and not any(key.get("title") for key in keys):
            # Cameras of looks leave room for a title.
            keys[0]["title"] = self.drawing.words
        # The key of a lamp that stands somewhere differs from place to place.
        near = any(light.position is not None for light in self.scene.lights)
        # A bar has the colours of the map, in even light.
        even = {"scene": even_light(self.drawing.camera)} | ({"lying": True} if wishes.wide else {})
        is_bar = [key.get("question") == "value" for key in keys]
        return [
            key | even if bar else key
            for key, bar in zip(keys, is_bar, strict=True)
            if bar or not near
        ]

    @property
    def _titled_keys(self) -> list[Keywords]:
        """Keys of the drawing; a title that was given replaces that of the first, but its unit."""
        keys, title = [dict(key) for key in self.drawing.keys], self.wishes.picture.get("title")
        if title is not None:
            keys = keys or [dict(surfaces.TITLE_ALONE)] * bool(title)
            for key in keys[:1]:
                unit = parted(str(key.get("title", "")))[1]
                key["title"] = f"{title} ({unit})" if unit and not parted(title)[1] else title
        alone = surfaces.TITLE_ALONE["cmap"]
        return [key for key in keys if key.get("title") or key.get("cmap") is not alone]

    def read_steps(self) -> list[Step]:
        """Return the steps that print how much a reader reads back from the picture."""
        plotter, steps = self._picture()
        read = Step("", ".vizlight.legibility", plotter)
        if self._unexplained:
            read = Step("", ".without", read, *self._unexplained)
        return [*steps, Step("", "print", read), Step("", ".close", plotter)]

    def figures(self) -> Legibility:
        """Return how much a reader reads back from the picture: :func:`vizlight.legibility`.

        Figures of light are left out where no key of the picture explains its light, but for the
        lamps of a room, in which everybody has seen things.
        """
        with contextlib.closing(self.plotter()) as plotter:
            figures: Legibility = plotter.vizlight.legibility()
        return figures.without(*self._unexplained)

    @property
    def _unexplained(self) -> tuple[str, ...]:
        """Questions of light that no key of the picture explains."""
        has_key = any(key.get("question") != "value" for key in self.drawing.keys)
        return () if has_key or self.question == "shape" else OF_LIGHT

    def __str__(self) -> str:
        others = "; ".join(other.python for other in self.others) or "nothing else"
        notes = "".join(f"\nnote     {note}" for note in self.notes)
        return f"shown    {self.summary}\nwhy      {self.reason}{notes}\nask      {others}"

    @property
    def summary(self) -> str:
        """Subject and light of the picture, in one line."""
        return f"{self.drawing.words} ({self.question}: {self.shown})"

    def _repr_html_(self) -> str:
        import base64
        import html
        import io

        from PIL import Image

        with contextlib.closing(self.plotter()) as plotter:
            picture = Image.fromarray(np.asarray(plotter.screenshot(return_img=True)))
        data = io.BytesIO()
        picture.save(data, "PNG")
        text = base64.b64encode(data.getvalue()).decode()
        image = f'<img alt="{html.escape(self.summary)}" src="data:image/png;base64,{text}"/>'
        return f"{image}<pre>{html.escape(str(self))}</pre>"


def _of_page(layer: Layer, away: float) -> Layer:
    """Return a layer as a page has it, of which the eye is ``away`` times as far."""
    keywords = dict(layer.keywords)
    if "point_size" in keywords:
        keywords["point_size"] = round(keywords["point_size"] / away, 1)
    if "diffuse" not in keywords:
        return replace(layer, keywords=keywords)
    # A page has the light of plotters, and none of PyVista's own, which is on the side of the eye.
    return replace(layer, live=True, keywords=keywords | {"facing": "eye", "pickable": False})


def _key_step(plotter: Step, key: dict[str, object]) -> Step:
    keywords = dict(key)
    scene = keywords.pop("scene", None)
    return Step("", ".vizlight.add_key", plotter, *([scene] if scene else []), **keywords)


def look(
    data: pv.DataSet | pv.MultiBlock | str | Path | Sequence[pv.DataSet | str | Path],
    question: str = "auto",
    /,
    *,
    array: str | None = None,
    view: object = None,
    size: tuple[int, int] = (1200, 800),
    style: str = "paper",
    **options: Given,
) -> Look:
    """Decide how data are shown: which part, in which light, from where and with which key.

    Parameters
    ----------
    data : mesh, path, xarray object, or sequence of them
        Data to show. Of several, and of blocks of different dimensions, each is drawn by its own
        rule in one picture; walls of a volume are left out.
    question : str, default: "auto"
        What the picture should tell: the name of a preset, such as ``"heading"`` or ``"shape"``,
        ``"relief"`` or ``"flow"``. ``"auto"``: by the data.
    array : str, optional
        Array that is shown; of components their names, ``"u,v"``. Default: the best.
    view : str, vector or pyvista.Camera, or sequence of views, optional
        Direction toward the eye: ``"front"``, ``"back"``, ``"left"``, ``"right"``, ``"top"``,
        ``"bottom"``, ``"iso"``, an axis such as ``"x"`` or ``"-y"``, three numbers, or a camera.
        The front of a part is toward -y, its right toward x. Of several, such as ``["front",
        "side", "top"]``, each has its place in a picture, all in one scale. Default: by the data.
    size : (int, int), default: (1200, 800)
        Width and height of the picture in pixels.
    style : {"paper", "dark"}
        Background of the picture: white or nearly black.
    **options
        Further options. How files and data of xarray are read: ``time``, ``overlay``, ``at``,
        ``nodata``, as by :func:`vizlight.read`. Parts of the data: ``slice`` and ``clip`` (a plane,
        ``"z:4"`` or a normal and an origin), ``threshold`` (``"Temp:300:600"`` or a name and two
        numbers), ``contour``, ``level`` (of an isosurface), ``warp``, ``exaggeration``, ``globe``
        (a map of the whole earth on a ball, a raised one with ``warp`` or ``exaggeration``). The
        light: ``scene``, and options of :func:`vizlight.illuminate` or of the filter of the
        question, such as ``tangents``. The picture: ``background``, ``line_width``, ``scalars``
        (an array that only colours the drawing), ``cmap``, ``clim``, ``key``, ``title`` (words
        above it), ``map_parts`` (those that are drawn of "coasts", "frame" and "isolines"; () for
        none), ``up``, ``parallel``, ``zoom``, ``backend``. A movie: ``frames``, ``fps``.

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
    wishes = views.asked(wishes)
    if isinstance(data, pv.MultiBlock):
        blocks.check(data)
        data = [blocks.one_grid(part) for part in blocks.by_dimension(data)] or data
    several = list(data) if isinstance(data, list | tuple) else [data]
    if not several:
        raise value_error("data", "a mesh, a file, or several", "none")
    joined = _of_components(several, wishes)
    if joined is not None:
        wishes = replace(wishes, part={**wishes.part, "overlay": several[1:]})
        several = several[:1]
    ready = []
    for item in several:
        for read in read_steps(item, wishes) if joined is None else [joined]:
            ready.append(prepared(item, read, wishes))
            if wishes.question == "flow":
                mesh = ready[-1][0].run()
                look_options.check_flow(item, mesh, wishes.light.get("tangents"))
    if len(ready) == 1:
        ((step, contents, notes),) = ready
        step, contents, wishes, words = look_options.in_space(step, contents, wishes)
        notes = [*notes, *words]
        step, contents = look_options.charted(step, contents, wishes)
        step, contents = look_options.laid_flat(step, contents, wishes)
        step, contents = look_options.with_heights(step, contents, wishes)
        rule, case = _chosen(step, contents, wishes)
        case = insets.of_case(rule.recipe, views.of_case(case))
        bar = views.unit_of_bar(case)
        wide = replace(case, wishes=replace(case.wishes, bar=bar, wide=case.is_wide))
        return _decided(rule, wide, notes)
    by_part = [together.wishes_of(wishes, contents) for _, contents, _ in ready]
    if wishes.array is not None and not any(it.array for it in by_part):
        by_part[0] = wishes  # whose error says what is there
    pair = views.of_pair([contents.mesh for _, contents, _ in ready], wishes)
    if pair:
        by_part = [replace(it, views=mine) for it, mine in zip(by_part, pair, strict=True)]
    chosen = [
        _chosen(step, contents, it) for (step, contents, _), it in zip(ready, by_part, strict=True)
    ]
    shared = together.shared([case for _, case in chosen])
    looks = [
        _decided(rule, case, notes)
        for (rule, _), case, (_, _, notes) in zip(chosen, shared, ready, strict=True)
    ]
    cases = [case for _, case in chosen]
    drawings = [look.drawing for look in looks]
    drawing = together.joined(drawings if pair else together.seen_through(cases, drawings))
    if len(several) == 1:
        drawing = replace(drawing, alone=looks[0].drawing.lit)
    reasons = "; ".join(dict.fromkeys(look.reason for look in looks))
    seen = drawing.camera.note
    reason = f"{reasons}; seen {seen}" if seen else reasons
    return replace(looks[0], reason=reason, others=(), wishes=wishes, drawing=drawing)


def _decided(rule: Rule, case: Case, notes: Sequence[str], unread: int = 0) -> Look:
    """Return the look of one mesh: the first that a reader can read, after unread ones."""
    drawing = rule.recipe(case)
    for _ in range(unread):
        assert drawing.doubt is not None
        drawing = drawing.doubt.instead()
    while True:
        keys = [key for key in drawing.keys if key.get("cmap") != surfaces.TITLE_ALONE["cmap"]]
        if case.wishes.wide and [key.get("question") for key in keys] != ["value"]:
            # A disc has no room below a map.
            narrow = replace(case, wishes=replace(case.wishes, wide=False))
            return _decided(rule, narrow, notes, unread)
        look = _look_of(rule, case, drawing, notes)
        doubt = drawing.doubt
        if doubt is None or not (why := _unread(look, doubt.figures)):
            return look
        notes, unread, drawing = [*notes, why], unread + 1, doubt.instead()


def _look_of(rule: Rule, case: Case, drawing: Drawing, notes: Sequence[str]) -> Look:
    """Return the look of one mesh, as a recipe draws it, with the frame and coasts of a map."""
    drawing = maps.furnished(case, drawing)
    drawing = views.with_bar(case, views.arranged(case, drawing))
    drawing = insets.drawn(case, drawing)
    drawing = replace(drawing, notes=[*notes, *drawing.notes])
    place = case.place_of_cut(drawing.camera)
    if place and drawing.keys and drawing.keys[0].get("title"):
        first, *more = drawing.keys
        drawing = replace(drawing, keys=[first | {"title": f"{first['title']}; {place}"}, *more])
    array = None if case.array is None else case.array.name
    seen = "" if case.wishes.frame else drawing.camera.note
    reason = rule.why + (f"; seen {seen}" if seen else "")
    shown = drawing.words.split(" ", 1)[0] if rule.shown == "isosurface" else rule.shown
    others = _others(case.contents, case, shown)
    return Look(case.question, shown, array, reason, others, case.wishes, drawing)


def _unread(look: Look, names: Sequence[str]) -> str:
    """Return why a picture is not chosen, empty if a reader can read it, or nothing can draw."""
    try:
        with warnings.catch_warnings():
            # Points that cannot be lit are reported when the picture is made.
            warnings.simplefilter("ignore")
            figures = look.figures()
    except BackendError:
        # The decision from the data alone has to be enough.
        return ""
    for name, reason in figures.unreadable.items():
        if name in names:
            return f"not chosen: {look.drawing.words}; its {name} cannot be read: {reason}"
    return ""


def _is_of_grid(data: object) -> bool:
    """Return whether data have a reader that says which values of an array are missing."""
    if isinstance(data, str | Path):
        return Path(data).suffix.lower() in (*cf_grids.SUFFIXES, *rasters.SUFFIXES)
    return cf_grids.is_grid(data)


def _of_components(data: Sequence[object], wishes: Wishes) -> Step | None:
    """Return the step that reads components of one vector, such as a wind, from several files.

    None where they have no such components, or are not on one grid.
    """
    paths = [item for item in data if isinstance(item, str | Path)]
    if len(data) < 2 or len(paths) < len(data) or "overlay" in wishes.part:
        return None
    if not all(map(_is_of_grid, paths)):
        return None
    keywords = {name: wishes.part[name] for name in look_options.READ if name in wishes.part}
    step = Step("data", "vizlight.read", paths[0], **keywords | {"overlay": paths[1:]})
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            joined = step.run()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # those of the joined mesh are given below
            alone = files.read(paths[0], **keywords)
    except (ValueError, OSError):
        return None
    if all({*group} <= {*alone.point_data} for group in meaning.components(joined)):
        return None
    for warning in caught:
        _check.warn(str(warning.message))
    return step


def read_steps(data: object, wishes: Wishes) -> list[Step]:
    """Return the steps that read data: one for each dimension of the cells of a file of blocks."""
    keywords = {name: wishes.part[name] for name in look_options.READ if name in wishes.part}
    if not _is_of_grid(data):
        # Of other data they are left out afterwards.
        keywords.pop("nodata", None)
    if cf_grids.is_grid(data):
        return [Step("data", "vizlight.read", Step("ds", "-", data), **keywords)]
    if isinstance(data, str | Path):
        every = Step("parts", "files.read_parts", data, **keywords)
        meshes = every.run()
        if len(meshes) > 1:
            return [Step("data", "[]", every, i) for i in range(len(meshes))]
        step = Step("data", "vizlight.read", data, **keywords)
        step.hold(meshes[0])
        return [step]
    mesh = data
    if isinstance(mesh, pv.MultiBlock):
        blocks.check(mesh)
        mesh = blocks.one_grid(mesh)
    if not isinstance(mesh, pv.DataSet):
        expected = "a PyVista mesh, a path or an xarray object"
        # Of NumPy, pandas, PyTorch and others.
        remedy = (
            "take pyvista.PolyData(rows of x, y, z) of points, pyvista.wrap(array) of a volume, "
            "pyvista.StructuredGrid(x, y, z) of a surface; then mesh['name'] = values"
        )
        remedy = remedy if hasattr(data, "__array__") else ""
        raise type_error("data", expected, data, remedy)
    if keywords:
        name, value = next(iter(keywords.items()))
        expected = "no such option beside a mesh, which is read already"
        raise value_error(name, expected, _check.describe(value))
    return [Step("mesh", "-", mesh)]


def prepared(data: object, step: Step, wishes: Wishes) -> tuple[Step, Contents, list[str]]:
    """Return the step that takes a part of the data of a step, its contents, and notes."""
    part, notes, raster = wishes.part, [], False
    if isinstance(data, str | Path):
        raster = Path(data).suffix.lower() in (*rasters.SUFFIXES, ".dem")
        if part.get("time") is None and (note := series.note(step.run())):
            notes.append(note)
    if not _is_of_grid(data):
        nodata = [] if part.get("nodata") is None else [part["nodata"]]
        known = Step("known", "files.without_fills", step, *nodata)
        step = step if known.run() is step.run() else known
    mesh = step.run()
    notes += [text] if (text := meaning.line(mesh)) else []
    if not mesh.n_points:
        raise value_error("data", "a mesh with points", "none")
    if blocks.is_too_far(mesh):
        expected = f"points within {_check.FARTHEST:g} of the origin"
        raise value_error("data", expected, str(mesh.bounds), "scale the mesh")
    if not mesh.n_cells and not isinstance(mesh, pv.PolyData):
        # VTK draws points that are cells.
        step = Step("points", ".cast_to_poly_points", step)
    elif sum(size > 1 for size in dimensions(mesh)) == 1:
        step = Step("lines", ".cast_to_unstructured_grid", step)
    if georeference.is_earth(mesh):
        step = Step("chart", "vizlight.cartography.in_degrees", step)
        notes.append("x and y are those of the whole earth in degrees, and taken for them")
    step = look_options.strained(step, wishes)
    notes += [step.note] if step.note else []
    of_light = (wishes.light.get(name) for name in ("normals", "occlusion", "positions"))
    without = tuple(name for name in of_light if isinstance(name, str))
    contents = Contents(step.run(), raster, without)
    step, contents = look_options.cut(step, contents, wishes)
    notes += [step.note] if step.note else []
    if part.get("globe"):
        step = wishes.globe(step)
        notes += [step.note] if step.note else []
    if part.get("slice") is not None:
        # Planes that cut a map are in the coordinates of its file, so they come before metres.
        step = wishes.section(step)
    factor = georeference.stretch(step.run())
    if factor != 1:
        step = Step("stretched", "files.stretched", step, factor)
        notes.append(_of_stretched(step.run(), factor))
    if part.get("contour") is not None and wishes.question != "flow":
        step = wishes.isosurface(step)
        notes += [step.note] if step.note else []
    if contents.mesh is not step.run():
        contents = replace(contents, mesh=step.run())
    words = [
        contents.words_on_none(), contents.words_on_rounding(), contents.words_on_complex(),
    ]  # fmt: skip
    notes += [text for text in words if text]
    # A step that is none of its own has the note of the one before it.
    return step, contents, [*dict.fromkeys(notes)]


def _of_stretched(mesh: pv.DataSet, factor: float) -> str:
    """Return the note that tells how a volume or a section was stretched."""
    section = meaning.of(mesh).section
    if not section:
        return f"the volume is in metres over its map, its z taken {factor:g} times"
    by = ", pressures by their logarithm" * section[1].is_log
    return f"the section fills the picture, its axes have different units{by}"


def _chosen(data: Step, contents: Contents, wishes: Wishes) -> tuple[Rule, Case]:
    """Return the rule that fits, and the case that its recipe draws."""
    array = _asked_array(contents, wishes)
    question = wishes.question
    # Tangents of a volume are those of its hull.
    of_hull = contents.dimension == 3 and wishes.light.get("tangents") is not None
    if question in _FILTERS or not wishes.surface or of_hull:
        return _explicit(data, contents, wishes, array, question)
    fitting = [rule for rule in RULES if rule.fits(contents)]
    for rule in fitting:
        if question not in ("auto", rule.question, _ALIASES.get(rule.question)):
            continue
        if array is not None and array.role not in rule.roles:
            continue
        if array is None and not rule.holds(contents):
            continue
        chosen = rule.array(contents) if array is None else array
        has_level = rule.shown == "isosurface" or wishes.part.get("contour") is not None
        if wishes.part.get("level") is not None and not has_level:
            expected = "contour with it, of data that are no volume of values"
            raise value_error("level", expected, "it alone")
        return rule, Case(data, contents, wishes, rule.question, chosen)
    return _explicit(data, contents, wishes, array, question)


#: Other words for questions: a sheet's values are coloured without light.
_ALIASES = {"none": "value", "heading": "flow"}


def _explicit(
    data: Step, contents: Contents, wishes: Wishes, array: Named | None, question: str
) -> tuple[Rule, Case]:
    """Return a rule for a question that the table has not for these data."""
    if question == "auto":
        best = array or contents.first("vectors") or contents.first("values", "heights", "kinds")
        question = "shape" if best is None else "value"
        # Normals beside tangents are for light that is conditioned by a surface.
        shape = "normals" in wishes.light and not wishes.light.get("conditioned")
        if best is not None and best.role == "vectors":
            question = "shape" if shape else "direction"
    if array is not None and question in _FILTERS:
        data = wishes.joined(data, array)
    if question == "relief" and not _is_height_field(contents, array):
        question = "shadow"
    if question not in {**QUESTIONS, **_OF_FILTERS}:
        expected = f"a question that these data answer, {one_of([*QUESTIONS, *_FILTERS])}"
        raise value_error("question", expected, repr(question))
    recipe, roles, needed = _OF_FILTERS.get(question) or _of_preset(question)
    chosen = array if array is not None and array.role in roles else contents.first(*roles)
    if question == "relief" and chosen is None:
        # Level ground has heights too, all equal.
        chosen = contents.named(height_grids.heights_name(contents.mesh) or "")
    if needed and (chosen is None or (array is not None and array.role not in roles)):
        arrays = ", ".join(repr(named.name) for named in contents.arrays)
        got = f"{array.name!r} with {array.role}" if array is not None else arrays or "no array"
        is_of_tangents = question in QUESTIONS and QUESTIONS[question].of_tangents
        remedy = "take question='shape'" if is_of_tangents else ""
        # Without such an array it is the question that does not fit.
        name = "question" if contents.first(*roles) is None else "array"
        if name == "question" and not remedy:
            remedy = "take question='auto', or a mesh with such an array"
        raise value_error(name, f"{' or '.join(roles)} for {question!r}", got, remedy)
    kind = next(rule.shown for rule in RULES if rule.fits(contents))
    rule = Rule(kind, lambda _: True, question, roles, recipe, f"{question} was asked for")
    return rule, Case(data, contents, wishes, question, chosen)


def _of_preset(question: str) -> tuple[Recipe, tuple[Role, ...], bool]:
    """Return the recipe of a preset's question, as ``_OF_FILTERS`` has those of others."""
    if QUESTIONS[question].of_tangents:
        return fields.vectors, ("vectors",), True
    if QUESTIONS[question].key == "colors":
        return surfaces.values, ("values", "heights", "kinds", "colors"), True
    return surfaces.surface, (), False


#: Recipes of questions that have no preset, the roles of the array that they show, and whether they
#: need one.
_OF_FILTERS: dict[str, tuple[Recipe, tuple[Role, ...], bool]] = {
    "flow": (fields.flow, ("vectors",), True),
    "relief": (reliefs.relief, ("heights", "values"), True),
    "shadow": (reliefs.shadow, (), False),
    "sky": (reliefs.sky, ("heights", "values"), False),
    "fur": (surfaces.fur, (), False),
    "contours": (surfaces.contours, (), False),
    "projection": (surfaces.projection, (), False),
}
#: Those that a filter answers, whatever the data are.
_FILTERS = tuple(name for name in _OF_FILTERS if name != "shadow")
#: Those of which an array is no part.
_WITHOUT_ARRAY = ("sky", "fur", "contours", "projection")


def _is_height_field(contents: Contents, array: Named | None) -> bool:
    """Return whether data are a grid of one layer with heights."""
    is_layer = sum(size > 1 for size in dimensions(contents.mesh)) == 2
    return is_layer and bool(array or height_grids.heights_name(contents.mesh))


def _asked_array(contents: Contents, wishes: Wishes) -> Named | None:
    """Return the array that was asked for, by any of the options that name one."""
    options = {"array": wishes.array}
    options |= {name: wishes.light.get(name) for name in ("tangents", "elevation")}
    options["scalars"] = wishes.picture.get("scalars")
    named_by = [
        (option, value)
        for option, value in options.items()
        if isinstance(value, str) and value != lines.DIRECTION
    ]
    if not named_by:
        return None
    option, name = named_by[0]
    named = contents.named(name)
    if named is None:
        there = [*contents.mesh.point_data, *contents.mesh.cell_data]
        if name in there:
            expected = "an array of finite numbers, or of 3 components that are not all 0"
            raise value_error(option, expected, repr(name))
        expected = f"the name of an array, {one_of(there)}"
        raise value_error(option, expected, repr(name))
    if option == "tangents" and named.role != "vectors":
        got = f"{name!r} with {named.role}"
        raise value_error(option, "vectors, or names U,V of their components", got)
    # Colours of what is drawn along vectors.
    only_colors = (
        option == "scalars"
        and named.role in ("values", "heights")
        and wishes.question in ("auto", "direction", "heading", "flow")
        and contents.flow is not None
        and (contents.dimension == 3 or contents.flat_axis is not None)
    )
    return None if only_colors else named


def _others(contents: Contents, case: Case, drawn: str) -> tuple[Other, ...]:
    """Return the other questions that the data can answer."""
    shown = None if case.array is None else case.array.name
    others = [
        Other(array.role, array.name, f"array={array.name!r}", f"--array {array.name}")
        for array in contents.arrays
        if array.name != shown and case.question not in _WITHOUT_ARRAY
    ]
    if drawn == "isosurface":
        others.insert(0, Other("value", None, "question='value'", "--for value"))
    if case.question == "none" and case.array is not None and may_be_ground(contents, case.array):
        others.insert(0, Other("relief", None, "question='relief'", "--for relief"))
    is_shape = case.wishes.question == "shape" and drawn != "slices"
    if not is_shape and contents.flat_axis is None and contents.dimension > 1:
        others.append(Other("shape", None, "question='shape'", "--for shape"))
    if is_whole_earth(map_parts.before_chart(case.data).run()):
        others.insert(0, Other(case.question, None, "globe=True", "--globe"))
    return tuple(others[:MOST_OTHERS])
