"""The plotter component ``plotter.vizlight``: meshes whose light follows the camera."""

from __future__ import annotations

import dataclasses
import weakref
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.files import check_output
from vizlight.filters import lighting, relight
from vizlight.filters.tint import RGB, unlit_colors
from vizlight.mesh import blocks, records
from vizlight.plotting.fragments import Fragments, unfit
from vizlight.plotting.live import Live, colorless, headlight_scene, items, lifted
from vizlight.plotting.notebook import guard, guard_exports
from vizlight.plotting.points import Points
from vizlight.scene import Scene
from vizlight.shading.options import LightOptions

if TYPE_CHECKING:
    from pathlib import Path

    from vtkmodules.vtkCommonCore import vtkObject
    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

    from vizlight._types import ColorLike
    from vizlight.filters.relight import Source

__all__ = ["Component", "LightAt", "add_recorded", "plot"]

LightAt = Literal["auto", "points", "fragments"]

#: Options of light that a live light takes; an actor has a name of its own.
LIGHT = {field.name for field in dataclasses.fields(LightOptions)} - {"name", "components"}
#: Keywords of PyVista that stand for another light or another surface than the one that is lit.
REFUSED = {
    "lighting": "the light is vizlight's",
    "smooth_shading": "normals are those of the points; pass normals= for others",
    "split_sharp_edges": "call mesh.compute_normals(split_vertices=True) first",
    "pbr": "leave it out, or add the mesh by plotter.add_mesh",
    "metallic": "leave it out, or add the mesh by plotter.add_mesh",
    "roughness": "leave it out, or add the mesh by plotter.add_mesh",
    "texture": "sample the texture to a point array and pass scalars=",
    "rgb": "pass the data and a colour map: scalars= and cmap=",
    "rgba": "pass the data and a colour map: scalars= and cmap=",
    "backface_params": "leave it out; two_sided=True lights both sides",
    "copy_mesh": "pass mesh.copy()",
}
#: Endings of the names of pictures that VTK writes.
PICTURES = (".png", ".jpeg", ".jpg", ".bmp", ".tif", ".tiff")
#: Coefficients that a scene has and PyVista takes as keywords.
MATERIAL = ("ambient", "diffuse", "specular", "specular_power")


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
        **options: Any,
    ) -> pv.Actor | list[pv.Actor]:
        """Add a mesh whose light follows the camera.

        Parameters
        ----------
        mesh : pyvista.DataSet or pyvista.MultiBlock
            Mesh that is lit and drawn; not changed. One with the light of a filter is lit again
            from its record, unless options of light are given.
        scene : Scene, optional
            Lights, material and depth cue. Default: those of the record of the mesh, otherwise
            the lights of the plotter and the material of the actor (``ambient=``, ``diffuse=``,
            ``specular=``, ``specular_power=``, ``color=``). The camera takes the place of its
            view, unless the view is one of n-space.
        light : {"auto", "points", "fragments"}
            Place where the light is computed: at the points of the mesh, the numbers that a filter
            attaches; or in each fragment, from interpolated tangents and normals, which is right
            between the points of a coarse mesh too. "auto": in fragments where the plan allows.
            ``"fragments"`` warns where it does not.
        scalars : str, optional
            Name of the array that gives the colours, which are multiplied by ambient and diffuse
            light. Default: none, or that of :func:`vizlight.tint` for a mesh that it returned.
        **options
            Options of :func:`vizlight.illuminate`, such as ``tangents=`` and ``conditioned=``,
            except ``name`` and ``components``; and keywords of ``pyvista.Plotter.add_mesh``, such
            as ``cmap``, ``clim``, ``name``, ``opacity``, ``line_width``, ``pickable``.

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
        Exported scenes cannot hold live light: ``export_html``, ``export_gltf`` and the like raise
        a ValueError with the remedy while there is any.

        Light at the points is bit-identical to that of the filter for the same camera. Light in
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
        sources, used = _sources(mesh, scene, own)
        if getattr(plotter, "notebook", False):
            guard()
        several = isinstance(mesh, pv.MultiBlock)
        actors = []
        for number, source in enumerate(sources):
            if not source.mesh.n_points:
                continue
            chosen, colors = (scalars, {}) if scalars is not None else _tinted(source.mesh)
            keywords = colors | drawing
            if several and keywords.get("name") is not None:
                keywords["name"] = f"{keywords['name']}-{number}"
            actors.append(self._add(plotter, source, used, light, chosen, keywords, follow=True))
        if not several and not actors:
            raise ValueError(_check.message("mesh", "a mesh with points", "none"))
        return actors if several else actors[0]

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
            raise ValueError(_check.message("actor", expected, actor))
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
        reason = "asked for" if light == "points" else _reason(source, drawing)
        live = Live(source, scene, follow=follow, by_surface=not reason)
        if light == "fragments" and reason:
            _check.warn(f"light='fragments': the light is computed at the points, because {reason}")
        drawing = dict(drawing)
        rendered = drawing.pop("render", True)
        if scalars is not None:
            live.color_by(scalars, drawing.pop("component", None), at_points=bool(reason))
            drawing["scalars"] = live.scalars
            bar = {"title": scalars, **(drawing.get("scalar_bar_args") or {})}
            drawing["scalar_bar_args"] = bar
        painter: Points | Fragments = Points(reason) if reason else Fragments()
        live.painter = painter
        painter.attach(live)
        drawing = painter.drawing(live, drawing)
        actor: pv.Actor = plotter.add_mesh(
            live.drawn, smooth_shading=False, split_sharp_edges=False, render=False, **drawing
        )
        try:
            painter.start(live, actor)
            live.start(plotter.renderer, actor)
        except (TypeError, ValueError):
            plotter.remove_actor(actor, render=False)
            raise
        invalid = live.invalid() if follow else 0
        if invalid:
            _check.warn(lighting.unlit(invalid, source.inputs.count))
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


class _Holder:
    """What an actor holds of its live light; VTK may keep the actor of a closed plotter."""

    def __init__(self, live: Live) -> None:
        self.live: Live | None = live

    def release(self, *_: object) -> None:
        """Let go of the light."""
        self.live = None


def _address(thing: vtkObject) -> str:
    return str(thing.GetAddressAsString(""))


def _sources(
    mesh: pv.DataSet | pv.MultiBlock, scene: Scene | None, options: dict[str, Any]
) -> tuple[list[Source], Scene | None]:
    """Return what is lit: by the record of the mesh, or by options."""
    if not options and relight.is_lit(mesh):
        return relight.from_record(mesh, scene)
    asked = LightOptions(**options)
    spaces = {
        np.shape(block.point_data[asked.positions])[-1]
        for block in blocks.all_blocks(mesh)
        if asked.positions is not None and asked.positions in block.point_data
    }
    n = max(spaces, default=3)
    provisional = headlight_scene(n) if scene is None else lifted(scene, n)
    if provisional.view is None and provisional.n in (None, n):
        # Which side of an open surface is lit is then the camera's to say.
        provisional = provisional.replace(view=headlight_scene(n).view)
    return relight.from_options(mesh, provisional, asked), scene


def _tinted(mesh: pv.DataSet) -> tuple[str | None, dict[str, Any]]:
    """Return the array and the colours of a mesh that tint returned."""
    record = records.read(mesh, RGB) or {}
    if record.get("filter") != "tint":
        return None, {}
    options = record["options"]
    name = options["scalars"]
    if name not in mesh.point_data:
        return None, {}
    return name, {"cmap": unlit_colors(mesh), "component": options["component"]}


def _check_drawing(drawing: dict[str, Any], scene: Scene | None) -> None:
    """Refuse keywords of PyVista that contradict the light."""
    for name, value in drawing.items():
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


def _reason(source: Source, drawing: dict[str, Any]) -> str:
    """Return why the light cannot be computed in each fragment, or an empty string."""
    if drawing.get("render_points_as_spheres") or drawing.get("render_lines_as_tubes"):
        return "VTK shades spheres and tubes by normals of their own"
    return unfit(source.inputs, source.options, source.mesh)


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
        Name of the light, or ``"rgb"`` for its colours or those of :func:`vizlight.tint`.
    **drawing
        Keywords of ``pyvista.Plotter.add_mesh``.

    Returns
    -------
    pyvista.Actor or None
        None, and nothing is added, if the mesh has no such light, the record does not suffice, or
        the light cannot be computed in each fragment.
    """
    blocks.check(mesh)
    _check.text("name", name, expected="the name of the light")
    light = lighting.DEFAULT_NAME if name == RGB else name
    scalars, colors = _tinted(mesh) if name == RGB else (None, {})
    maker = light if scalars is None else RGB
    if not relight.is_lit(mesh, light) or name not in records.made(mesh, maker):
        return None
    try:
        (source,), scene = relight.from_record(mesh, name=light)
    except (TypeError, ValueError):
        # The array says more than the record.
        return None
    if _reason(source, {}):
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
        Background colour. Default: that of PyVista's theme.
    camera : pyvista.Camera, optional
        First camera. Default: one that shows the whole mesh.
    screenshot : path, optional
        Path of a picture of the last view.
    jupyter_backend : str, optional
        Backend of a notebook; ``"client"`` and ``"html"`` are refused.
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
    return plotter.show(screenshot=screenshot or False, jupyter_backend=jupyter_backend)
