"""The plotter component ``plotter.vizlight``: meshes whose light follows the camera."""

from __future__ import annotations

import dataclasses
import difflib
import inspect
import weakref
from typing import TYPE_CHECKING, Any, get_args

import pyvista as pv

from vizlight import _check
from vizlight.files import check_output
from vizlight.filters import relight
from vizlight.filters.key import key, question_of
from vizlight.filters.sky import SKY
from vizlight.filters.tint import RGB, default_map, default_nan_color
from vizlight.mesh import blocks, records
from vizlight.plotting.corner import PLACES, CornerKey, ink_on
from vizlight.plotting.fragments import Fragments, unfit
from vizlight.plotting.html import write_page
from vizlight.plotting.live import LightAt, Live, colorless, items
from vizlight.plotting.notebook import guard, guard_exports
from vizlight.plotting.page import Shown
from vizlight.plotting.points import Points
from vizlight.plotting.program import Stroke
from vizlight.plotting.sources import sources_of, tinted
from vizlight.reading.polylines import has_lines_only
from vizlight.scene import Material, Scene
from vizlight.shading.display import NO_DATA_NAME, titled
from vizlight.shading.options import LightOptions, unknown_option
from vizlight.shading.results import DEFAULT_NAME, unlit

if TYPE_CHECKING:
    from pathlib import Path

    from vtkmodules.vtkCommonCore import vtkObject
    from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

    from vizlight._types import ColorLike
    from vizlight.filters.key import Question
    from vizlight.filters.relight import Source
    from vizlight.plotting.corner import Corner

__all__ = ["Component", "add_recorded", "plot"]

#: Options of light that a live light takes; an actor has a name of its own.
LIGHT = {field.name for field in dataclasses.fields(LightOptions)} - {"name", "components"}
#: Keywords of PyVista that stand for another light or another surface than the one that is lit.
REFUSED = {
    "lighting": "the light is vizlight's",
    "smooth_shading": "normals belong to the points; pass normals= for others",
    "split_sharp_edges": "call mesh.compute_normals(split_vertices=True) first",
    "pbr": "leave it out, or add the mesh by plotter.add_mesh",
    "metallic": "leave it out, or add the mesh by plotter.add_mesh",
    "roughness": "leave it out, or add the mesh by plotter.add_mesh",
    "texture": "sample the texture to a point array and pass scalars=",
    "rgb": "pass the data and a colour map: scalars= and cmap=",
    "rgba": "pass the data and a colour map: scalars= and cmap=",
    "backface_params": "leave it out; facing='eye' lights the side that is seen",
    "copy_mesh": "pass mesh.copy()",
}
#: Endings of the names of pictures that VTK writes.
PICTURES = (".png", ".jpeg", ".jpg", ".bmp", ".tif", ".tiff")
#: Coefficients that a scene has and PyVista takes as keywords.
MATERIAL = {"ambient", "diffuse", "specular", "specular_power"}
#: Coefficients ka, kd and ks of an actor that PyVista was not told others for.
UNTOUCHED = (0.0, 1.0, 0.0)


@pv.register_plotter_component("vizlight")
class Component:
    """Meshes of one plotter whose light follows the camera.

    Parameters
    ----------
    plotter : pyvista.Plotter
        Plotter.
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter = weakref.ref(plotter)
        self._holders: weakref.WeakValueDictionary[str, _Holder] = weakref.WeakValueDictionary()
        self._observed: list[tuple[vtkRenderer, int]] = []

    def add_mesh(
        self,
        mesh: pv.DataSet | pv.MultiBlock,
        /,
        *,
        scene: Scene | None = None,
        light: LightAt = "auto",
        scalars: str | None = None,
        line_diameter: float | None = None,
        **options: Any,
    ) -> pv.Actor | list[pv.Actor]:
        """Add a mesh whose light follows the camera.

        Parameters
        ----------
        mesh : pyvista.DataSet or pyvista.MultiBlock
            Mesh that is lit and drawn; not changed. One with the light of a filter is lit again
            from its record, unless options of light are given.
        scene : Scene, optional
            Lights, material and depth cue. Default: the scene of the mesh's record, otherwise the
            lights of the plotter and the material of the actor (``ambient=``, ``diffuse=``,
            ``specular=``, ``specular_power=``, ``color=``). The camera takes the place of its
            view, unless the view is one of n-space.
        light : {"auto", "points", "fragments"}
            Place where the light is computed: at the points of the mesh, the numbers that a filter
            attaches; or in each fragment, from interpolated tangents and normals, which is right
            between the points of a coarse mesh too. "auto": in fragments where the plan allows.
            ``"fragments"`` warns where it does not.
        scalars : str, optional
            Name of the array that gives the colours. Light keeps them readable, as in
            :func:`vizlight.tint`: there is no highlight, and values that are missing are grey.
            Default: none, or the array of :func:`vizlight.tint` for a mesh that it returned.
        line_diameter : float, optional
            Diameter of lines in the unit of the mesh, at least a pixel, in place of PyVista's
            ``line_width`` in pixels: nearer lines are wider.
        **options
            Options of :func:`vizlight.illuminate`, such as ``tangents=`` and ``conditioned=``,
            except ``name`` and ``components``, with ``feature_angle="auto"`` by default: where
            edges are creases a copy is drawn whose points are split there, which does not follow
            later changes of the mesh; and keywords of ``pyvista.Plotter.add_mesh``, such
            as ``clim``, ``name``, ``opacity``, ``line_width``, ``pickable``, and ``cmap``, which is
            ``vizlight.maps.even`` unless the theme's was changed. With
            ``render_lines_as_tubes=True`` lines wider than a pixel have, where light is in
            fragments, the light of the cylinder that they stand for across their width: its mean is
            the light of ``model="cylinder"``.

        Returns
        -------
        pyvista.Actor, or list of them
            Actor, for a MultiBlock one for each block.

        Raises
        ------
        TypeError, ValueError
            If an argument does not fit, as for :func:`vizlight.illuminate`, or the record of the
            mesh does not suffice.
        RuntimeError
            If the plotter is closed.

        Warns
        -----
        UserWarning
            Once, if points cannot be lit; before a frame, if the mesh can no longer be lit, such
            as after an array was removed: it keeps the light that it has.

        Notes
        -----
        Scenes that PyVista exports cannot hold live light: ``plotter.export_html``,
        ``export_gltf`` and the like raise a ValueError with the remedy while there is any.
        :meth:`export_html` of this component can.

        With ``bundle`` the shares of light are computed again only for lights that have moved. The
        lights of a scene must stay fixed; those of the plotter may follow the camera, at the cost
        of one grid for each of them in each frame.

        Light at the points is bit-identical to the filter's for the same camera. Light in
        fragments is within 4 of 255 of it on fine meshes.
        """
        plotter = self._open_plotter()
        blocks.check(mesh)
        _check.instance("scene", scene, Scene, optional=True)
        _check.choice("light", light, get_args(LightAt))
        if scalars is not None:
            _check.text("scalars", scalars, expected="the name of an array")
        own = {key: value for key, value in options.items() if key in LIGHT}
        drawing = {key: value for key, value in options.items() if key not in LIGHT}
        _check_drawing(drawing, scene)
        if line_diameter is not None:
            line_diameter = _check.positive("line_diameter", line_diameter)
        sources, used = sources_of(mesh, scene, own)
        names = [path.lstrip("/") for _, path in blocks.named_blocks(mesh)]
        if getattr(plotter, "notebook", False):
            guard()
        several = isinstance(mesh, pv.MultiBlock)
        actors = []
        for number, source in enumerate(sources):
            if not source.mesh.n_points:
                continue
            chosen, colors = (scalars, {}) if scalars is not None else tinted(source.mesh)
            keywords = colors | drawing
            if several and keywords.get("name") is not None:
                keywords["name"] = f"{keywords['name']}-{number}"
            keywords["line_diameter"] = line_diameter
            name = names[number] or str(keywords.get("name") or "")
            actor = self._add(plotter, source, used, light, chosen, keywords, follow=True)
            live = self._live_of(actor)
            assert live is not None
            live.name = name
            actors.append(actor)
        if not several and not actors:
            raise ValueError(_check.message("mesh", "a mesh with points", "none"))
        return actors if several else actors[0]

    def add_key(
        self,
        scene: Scene | None = None,
        /,
        *,
        question: Question | None = None,
        corner: Corner = "auto",
        size: float = 0.2,
        color: ColorLike | None = None,
        **options: Any,
    ) -> pv.PolyData:
        """Draw the key of the light in a corner of the picture, with its words.

        Parameters
        ----------
        scene : Scene, optional
            Scene whose light the key explains. Default: the scene of the first mesh of
            :meth:`add_mesh`, with the exponent of its light, and its colour map where it is
            coloured by values.
        question : {"direction", "slope", "heading", "shape", "value"}, optional
            What the key tells. Default: the question of the preset, see
            :func:`vizlight.presets.key`.
        corner : {"auto", "lower left", "lower right", "upper left", "upper right"}
            Corner of the picture. ``"auto"``: the one in which the data have the fewest points when
            the first frame is drawn.
        size : float, default: 0.2
            Width of the key, as a share of the shorter side of the picture, from 0.02 to 1.
        color : colour, optional
            Colour of the words. Default: black on a light background, white on a dark one.
        **options
            Keywords of :func:`vizlight.presets.key`: exponent, conditioned, cmap, clim.

        Returns
        -------
        pyvista.PolyData
            The key.

        Raises
        ------
        TypeError, ValueError
            If an argument does not fit; if there is neither a scene nor a mesh with live light.
        RuntimeError
            If the plotter is closed.

        Notes
        -----
        Lights that follow the view have the same key in all views. The key of fixed lights is made
        for the camera when it is added.
        """
        plotter = self._open_plotter()
        _check.choice("corner", corner, ("auto", *PLACES))
        size = _check.number("size", size, low=0.02, high=1.0)
        if scene is None:
            scene, own = self._first_light(plotter, question)
            options = own | options
        made = key(scene, **({"question": question} | options))
        ink = _check.color("color", color)
        if ink is None:
            ink = ink_on(plotter.background_color)
        CornerKey(made, corner, size, ink).show(plotter.renderer)
        return made

    def _first_light(
        self, plotter: pv.BasePlotter, question: Question | None
    ) -> tuple[Scene, dict[str, Any]]:
        """Return the scene of the first mesh with live light, and its options of a key."""
        for actor in items(plotter.renderer.GetActors()):
            live = self._live_of(actor)
            if live is not None:
                lit_by = live.scene_of(plotter.renderer, actor)
                options: dict[str, Any] = {"exponent": live.source.options.exponent}
                table = actor.GetMapper().GetLookupTable()
                valued = live.scalars is not None and isinstance(table, pv.LookupTable)
                # The default light is made for values; without values it tells the shape.
                if question is None and question_of(lit_by) == "value":
                    question = "value" if valued else "shape"
                if question == "value" and valued:
                    title = titled(str(live.given), lacking=live.lacks_values())
                    options |= {"cmap": table, "title": title}
                return lit_by, options | {"question": question}
        expected, remedy = "a scene, or a mesh with live light", "pass the scene of the picture"
        raise ValueError(_check.message("scene", expected, None, remedy))

    def export_html(
        self, path: str | Path, /, *, title: str = "", panel: bool = True, key: bool = True
    ) -> Path:
        """Write one HTML file that shows the meshes, whose light follows the eye of the reader.

        The page has the meshes of :meth:`add_mesh` that are visible, and the camera, the
        background and the scalar bars of the plotter; see :func:`vizlight.live_html`.

        Parameters
        ----------
        path : path
            Path of the file, which ends in .html or .htm. An existing file is replaced.
        title : str, default: ""
            Title of the page.
        panel : bool, default: True
            Whether the panel of the sliders is open at first.
        key : bool, default: True
            Whether the key is shown where the light of the first mesh comes from a preset.

        Returns
        -------
        pathlib.Path
            Path of the file.

        Raises
        ------
        FileError
            If the file cannot be written.
        RuntimeError
            If the plotter is closed.
        ValueError
            If no mesh has live light.

        Warns
        -----
        UserWarning
            If the light of a mesh does not follow the eye, or what is drawn beside the meshes is
            left out.
        """
        plotter = self._open_plotter()
        shown: list[Shown] = []
        others = 0
        for actor in items(plotter.renderer.GetActors()):
            live = self._live_of(actor)
            if not actor.GetVisibility():
                continue
            if live is None or live.painter is None:
                others += 1
            else:
                shown.append(Shown(live.name or f"mesh {len(shown) + 1}", live, actor))
        if not shown:
            remedy = "add a mesh by plotter.vizlight.add_mesh"
            raise ValueError(_check.message("plotter", "a mesh with live light", "none", remedy))
        if not plotter.camera_set:
            plotter.renderer.view_isometric(render=False)
        written = write_page(path, shown, plotter, title=title, panel=panel, key=key)
        if others:
            _check.warn(f"{others} actors without light of vizlight are not in the page")
        return written

    def explain(self, actor: vtkActor, /) -> str:
        """Return where the light of an actor is computed and why, and what of it.

        Parameters
        ----------
        actor : pyvista.Actor
            Actor that :meth:`add_mesh` returned.

        Returns
        -------
        str

        Raises
        ------
        ValueError
            If the actor has no live light.
        """
        live = self._lit_by_us(actor)
        assert live.painter is not None
        plotter = self._open_plotter()
        return live.painter.explain(live, live.scene_of(plotter.renderer, actor))

    def set_scene(self, actor: vtkActor, scene: Scene, /) -> None:
        """Light an actor by another scene, from the next frame on; nothing else is computed again.

        Parameters
        ----------
        actor : pyvista.Actor
            Actor that :meth:`add_mesh` returned.
        scene : Scene
            Lights, material and depth cue, as for :meth:`add_mesh`.

        Raises
        ------
        TypeError, ValueError
            If it is no scene, or the actor has no live light.
        """
        _check.instance("scene", scene, Scene)
        self._lit_by_us(actor).set_scene(scene, actor)

    @property
    def has_live_light(self) -> bool:
        """Whether the plotter shows a mesh whose light follows the camera."""
        return any(holder.live is not None for holder in self._holders.values())

    def _lit_by_us(self, actor: vtkActor) -> Live:
        expected = "one of plotter.vizlight.add_mesh"
        if not hasattr(actor, "GetAddressAsString"):
            raise TypeError(_check.message("actor", expected, _check.describe(actor)))
        live = self._live_of(actor)
        if live is None or live.painter is None:
            raise ValueError(_check.message("actor", expected, _check.describe(actor)))
        return live

    def _live_of(self, actor: vtkActor) -> Live | None:
        holder = self._holders.get(_address(actor))
        return None if holder is None else holder.live

    def _open_plotter(self) -> pv.BasePlotter:
        plotter = self._plotter()
        if plotter is None or plotter.render_window is None:
            remedy = "make another pyvista.Plotter"
            raise RuntimeError(_check.message("plotter", "an open plotter", "a closed one", remedy))
        return plotter

    def _add(
        self,
        plotter: pv.BasePlotter,
        source: Source,
        scene: Scene | None,
        light: LightAt,
        scalars: str | None,
        drawing: dict[str, Any],
        *,
        follow: bool,
    ) -> pv.Actor:
        """Draw one source, light it once, and let its light follow."""
        drawing = dict(drawing)
        stroke = _stroke(source, drawing)
        reason = "asked for" if light == "points" else _reason(source, drawing, stroke)
        live = Live(source, scene, follow=follow, by_surface=not reason)
        if light == "fragments" and reason:
            _check.warn(f"light='fragments': the light is computed at the points, because {reason}")
        rendered = drawing.pop("render", True)
        if scalars is not None:
            live.color_by(scalars, drawing.pop("component", None), at_points=bool(reason))
            drawing["scalars"] = live.scalars
            drawing["cmap"] = default_map(drawing.get("cmap"))
            drawing["nan_color"] = default_nan_color(drawing.get("nan_color"))
            bar = {"title": scalars, **(drawing.get("scalar_bar_args") or {})}
            drawing["scalar_bar_args"] = bar
        painter: Points | Fragments = (
            Points(reason, stroke.diameter) if reason else Fragments(stroke)
        )
        if stroke.round and reason and stroke.diameter is None:
            drawing["render_lines_as_tubes"] = True
        live.painter = painter
        painter.attach(live)
        drawing = painter.drawing(live, drawing)
        actor: pv.Actor = plotter.add_mesh(
            live.drawn, smooth_shading=False, split_sharp_edges=False, render=False, **drawing
        )
        if scene is None and not drawing.keys() & MATERIAL:
            own, default = actor.prop, Material()
            if (own.ambient, own.diffuse, own.specular) == UNTOUCHED:
                own.ambient, own.diffuse = default.ambient, default.diffuse
                own.specular = default.specular
        try:
            painter.start(live, actor)
            live.start(plotter.renderer, actor)
        except (TypeError, ValueError):
            plotter.remove_actor(actor, render=False)
            raise
        invalid = live.invalid()
        if invalid and follow:
            _check.warn(unlit(invalid, source.inputs.count))
        if scalars is not None and (invalid or live.lacks_values()):
            for bar in plotter.scalar_bars.values():
                if bar.GetLookupTable() is actor.mapper.lookup_table:
                    name_no_data(bar)
        self._keep(plotter, live, actor)
        if rendered:
            plotter.render()
        return actor

    def _keep(self, plotter: pv.BasePlotter, live: Live, actor: pv.Actor) -> None:
        """Tie a live light to its actor, and observe the renderers."""
        guard_exports(plotter)
        # The actor owns its observer: without the actor nothing is left of the light.
        holder = _Holder(live)
        actor.AddObserver("DeleteEvent", holder.release)
        self._holders[_address(actor)] = holder
        me = weakref.ref(self)

        def update(renderer: vtkRenderer, _: str) -> None:
            component = me()
            if component is not None:
                component._update(renderer)

        def forget() -> None:
            component = me()
            if component is not None and not component.has_live_light:
                component._stop()

        weakref.finalize(holder, forget)
        observed = {_address(renderer) for renderer, _ in self._observed}
        for renderer in plotter.renderers:
            if _address(renderer) not in observed:
                # PyVista's own render callbacks come after the frame is drawn.
                self._observed.append((renderer, renderer.AddObserver("StartEvent", update)))

    def _update(self, renderer: vtkRenderer) -> None:
        """Light what a renderer is about to draw."""
        for actor in items(renderer.GetActors()):
            live = self._live_of(actor)
            if live is not None:
                live.update(renderer, actor)

    def _stop(self) -> None:
        """Remove the observers of the renderers."""
        for renderer, tag in self._observed:
            renderer.RemoveObserver(tag)
        self._observed.clear()

    def __plotter_close__(self) -> None:
        """Let go of everything when the plotter closes."""
        self._stop()
        for holder in list(self._holders.values()):
            holder.release()
        self._holders.clear()

    def __plotter_deep_clean__(self) -> None:
        """Let go of everything when the plotter is cleaned."""
        self.__plotter_close__()


def name_no_data(bar: vtkScalarBarActor) -> None:
    """Let a scalar bar name the colour of what is not data."""
    bar.SetDrawNanAnnotation(True)
    bar.SetNanAnnotation(NO_DATA_NAME)


class _Holder:
    """What an actor holds of its live light; VTK may keep the actor of a closed plotter."""

    def __init__(self, live: Live) -> None:
        self.live: Live | None = live

    def release(self, *_: object) -> None:
        """Let go of the light."""
        self.live = None


def _address(thing: vtkObject) -> str:
    return str(thing.GetAddressAsString(""))


def _check_drawing(drawing: dict[str, Any], scene: Scene | None) -> None:
    """Refuse keywords of PyVista that contradict the light, and slips of the light's options."""
    drawn = inspect.signature(pv.Plotter.add_mesh).parameters
    for name, value in drawing.items():
        if name not in drawn and difflib.get_close_matches(name, LIGHT, n=1):
            raise TypeError(unknown_option("plotter.vizlight.add_mesh", name, [*LIGHT]))
        if name in REFUSED and value is not None and value is not False:
            expected = "no such keyword for a mesh with light of its own"
            got = _check.describe(value)
            raise ValueError(_check.message(name, expected, got, REFUSED[name]))
        if name in MATERIAL and scene is not None and value is not None:
            remedy = "pass Scene(material=Material(...))"
            expected = "the material of the scene, or no scene"
            raise ValueError(_check.message(name, expected, f"both ({value})", remedy))
    if drawing.get("style") == "points_gaussian":
        remedy = "pass style='points'"
        raise ValueError(
            _check.message(
                "style", "'surface', 'wireframe' or 'points'", "'points_gaussian'", remedy
            )
        )
    for name in [name for name in drawing if name in REFUSED]:
        del drawing[name]


def _stroke(source: Source, drawing: dict[str, Any]) -> Stroke:
    """Take from keywords how lines are drawn; a surface has none."""
    diameter = drawing.pop("line_diameter", None)
    if not has_lines_only(source.mesh):
        return Stroke()
    wide = diameter is not None or drawing.get("line_width", pv.global_theme.line_width) > 1
    return Stroke(diameter, bool(drawing.pop("render_lines_as_tubes", False)) and wide)


def _reason(source: Source, drawing: dict[str, Any], stroke: Stroke) -> str:
    """Return why the light cannot be computed in each fragment, or an empty string."""
    if drawing.get("render_points_as_spheres") or drawing.get("render_lines_as_tubes"):
        return "VTK shades spheres and tubes by normals of their own"
    return unfit(source.inputs, source.options, source.mesh, stroke)


def add_recorded(
    plotter: pv.BasePlotter, mesh: pv.DataSet, name: str, **drawing: Any
) -> pv.Actor | None:
    """Add a mesh with the light of its record, as its own view sees it, in each fragment.

    Parameters
    ----------
    plotter : pyvista.Plotter
        Plotter.
    mesh : pyvista.DataSet
        Mesh with the light of a filter; not changed.
    name : str
        Name of the light, or ``"rgb"`` for its colours or the colours of :func:`vizlight.tint`.
    **drawing
        Keywords of ``pyvista.Plotter.add_mesh``, and ``line_diameter``.

    Returns
    -------
    pyvista.Actor or None
        None, and nothing is added, if the mesh has no such light, the record does not suffice, or
        the light cannot be computed in each fragment.
    """
    given: tuple[object, object] = plotter, mesh
    if not isinstance(given[0], pv.BasePlotter):
        got = _check.describe(given[0])
        raise TypeError(_check.message("plotter", "a pyvista.Plotter", got))
    blocks.check(mesh)
    if isinstance(given[1], pv.MultiBlock):
        remedy = "add its blocks one after the other"
        raise TypeError(_check.message("mesh", "one dataset", "a MultiBlock", remedy))
    _check.text("name", name, expected="the name of the light")
    light = DEFAULT_NAME if name == RGB else name
    scalars, colors = tinted(mesh, warn=False) if name == RGB else (None, {})
    maker = light if scalars is None else RGB
    if not relight.is_lit(mesh, light) or name not in records.made(mesh, maker):
        return None
    try:
        (source,), scene = relight.from_record(mesh, name=light)
    except (TypeError, ValueError):
        # The array says more than the record.
        return None
    if _reason(source, {}, _stroke(source, dict(drawing))):
        return None
    used = scene if name == RGB else colorless(scene)
    own: Component = plotter.vizlight
    return own._add(plotter, source, used, "auto", scalars, colors | drawing, follow=False)


def plot(
    mesh: pv.DataSet | pv.MultiBlock,
    /,
    *,
    scene: Scene | None = None,
    light: LightAt = "auto",
    scalars: str | None = None,
    off_screen: bool | None = None,
    notebook: bool | None = None,
    window_size: tuple[int, int] | None = None,
    background: ColorLike | None = None,
    camera: pv.Camera | None = None,
    screenshot: str | Path | None = None,
    jupyter_backend: str | None = None,
    sky: bool = False,
    **options: Any,
) -> object:
    """Show a mesh whose light follows the camera.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh that is lit and drawn; not changed.
    scene, light, scalars
        As for ``plotter.vizlight.add_mesh``.
    off_screen, notebook : bool, optional
        Whether nothing appears on a screen, and whether a notebook shows the picture. Default: as
        PyVista decides.
    window_size : (int, int), optional
        Width and height in pixels.
    background : colour, optional
        Background colour. Default: the colour of PyVista's theme.
    camera : pyvista.Camera, optional
        First camera. Default: one that shows the whole mesh.
    screenshot : path, optional
        Path of a picture of the last view.
    jupyter_backend : str, optional
        Backend of a notebook; ``"client"`` and ``"html"`` are refused.
    sky : bool, default: False
        Whether the ambient light is that of a sky: ``occlusion="sky"``.
    **options
        As for ``plotter.vizlight.add_mesh``: options of :func:`vizlight.illuminate` and keywords
        of ``pyvista.Plotter.add_mesh``.

    Returns
    -------
    object
        Widget of a notebook; None elsewhere.

    Raises
    ------
    TypeError, ValueError
        As for ``plotter.vizlight.add_mesh``.
    """
    if _check.boolean("sky", sky):
        options = {"occlusion": SKY} | options
    for name, flag in (("off_screen", off_screen), ("notebook", notebook)):
        if flag is not None:
            _check.boolean(name, flag)
    if window_size is not None:
        sides = _check.vector("window_size", window_size)
        if len(sides) != 2 or not all(1 <= side <= 1 << 14 for side in sides):
            expected = "(width, height), each from 1 to 16384 pixels"
            raise ValueError(_check.message("window_size", expected, sides))
        window_size = (int(sides[0]), int(sides[1]))
    if camera is not None and not hasattr(camera, "GetPosition"):
        raise TypeError(_check.message("camera", "a pyvista.Camera", _check.describe(camera)))
    if screenshot is not None:
        screenshot = check_output(screenshot, PICTURES)
    if jupyter_backend is not None:
        _check.text("jupyter_backend", jupyter_backend)
    plotter: Any = pv.Plotter(
        off_screen=off_screen,
        notebook=notebook,
        window_size=None if window_size is None else list(window_size),
    )
    try:
        if background is not None:
            plotter.background_color = _check.color("background", background)
        plotter.vizlight.add_mesh(mesh, scene=scene, light=light, scalars=scalars, **options)
        if camera is not None:
            plotter.camera = camera.copy()  # type: ignore[no-untyped-call]
    except BaseException:
        plotter.close()
        raise
    # Outside a notebook PyVista warns that it ignores the backend.
    backend = jupyter_backend if plotter.notebook else None
    return plotter.show(screenshot=screenshot or False, jupyter_backend=backend)
