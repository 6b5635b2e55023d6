"""The plotter component ``plotter.vizlight``: meshes with light that follows the camera."""

from __future__ import annotations

import dataclasses
import importlib
import weakref
from collections.abc import Sequence
from pathlib import Path
from typing import get_args

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike
from vtkmodules.vtkCommonCore import vtkObject, vtkWeakReference
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

from vizlight import _check
from vizlight._types import ColorLike, Foreign, Given, Keywords, Raw
from vizlight.draw import keywords
from vizlight.draw.glsl import Stroke
from vizlight.draw.html import PageMesh, drawn_mesh, write_page
from vizlight.draw.live import Fragments, LightAt, Live, draws_light, items, unfit
from vizlight.draw.margins import Margin, ink_on
from vizlight.draw.notebook import guard, guard_exports
from vizlight.draw.scalar_bars import name_no_data, settle
from vizlight.draw.sources import sources_of, tinted
from vizlight.draw.strokes import check_halo, check_widths, enlarge, has_pass, stroke_of
from vizlight.filters import relight
from vizlight.filters.key import WORDS, key, question_of
from vizlight.filters.relight import Source
from vizlight.filters.tint import RGB, default_map, default_nan_color, values_of
from vizlight.mesh import blocks, records
from vizlight.mesh.strokes import PHASE, WIDTH
from vizlight.scene import Material, Scene
from vizlight.scene.keywords import named
from vizlight.scene.presets import AnyScene, optional_scene, required_scene
from vizlight.shading.display import titled
from vizlight.shading.results import DEFAULT_NAME, unlit
from vizlight.vtk.arrays import are_colors
from vizlight.vtk.polylines import has_lines_only

__all__ = ["Component", "add_recorded"]

#: Opacity from which on colours are drawn as opaque.
OPAQUE = 0.98
#: Coefficients ka, kd and ks of an actor that PyVista was not told others for.
UNTOUCHED = (0.0, 1.0, 0.0)
#: Passes of VTK that need its own light or normals, and what they draw.
UNLIT_PASSES = {"vtkShadowMapPass": "the shadows", "vtkSSAOPass": "the ambient occlusions (SSAO)"}


class Component:
    """Meshes of one plotter with light that follows the camera.

    Parameters
    ----------
    plotter : pyvista.Plotter
        Plotter.
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        # Weak both ways: neither the plotter nor a removed actor is kept alive by its light.
        self._plotter = weakref.ref(plotter)
        self._lives: dict[str, tuple[vtkWeakReference, Live]] = {}
        self._observed: list[tuple[vtkRenderer, int]] = []
        self._margins: dict[str, Margin] = {}
        #: What was said to be lost.
        self._lost: set[str] = set()

    @named
    def add_mesh(
        self,
        mesh: pv.DataSet | pv.MultiBlock,
        /,
        *,
        scene: AnyScene | None = None,
        light: LightAt = "auto",
        scalars: str | ArrayLike | None = None,
        line_diameter: float | None = None,
        halo: bool | float | str | None = None,
        width: str | None = None,
        **options: Given,
    ) -> pv.Actor | list[pv.Actor]:
        """Add a mesh with light that follows the camera.

        Parameters
        ----------
        mesh : pyvista.DataSet or pyvista.MultiBlock
            Mesh that is lit and drawn; not changed. One with the light of a filter is lit again
            from its record, unless options of light are given.
        scene : Scene or str, optional
            Lights, material and depth cue. Default: the scene of the mesh's record, otherwise the
            lights of the plotter and the material of the actor (``ambient=``, ``diffuse=``,
            ``specular=``, ``specular_power=``, ``color=``). The camera takes the place of its
            view, unless the view is one of n-space.
        light : {"auto", "points", "fragments"}
            Place where the light is computed: at the points of the mesh, the numbers that a filter
            attaches; or in each fragment, from interpolated tangents and normals, which is right
            between the points of a coarse mesh too; of lines with halos at three places of each
            segment, if no highlight and no lamp at a place changes it faster. "auto": in fragments
            where the plan allows. ``"fragments"`` warns where it does not, and casts the cos-theta
            shadows of an even height field in each fragment, of lamps that move too.
        scalars : str or array_like, optional
            Array that gives the colours, by its name or with one row per point or cell. Light keeps
            them readable, as in :func:`vizlight.tint`: without a highlight, and grey for missing
            values. With ``rgb=True`` the array holds colours. Blocks without the array have no
            colours of data. Default: the array of :func:`vizlight.tint` for a mesh that it
            returned; as in PyVista, the active scalars, where no ``color``, no ``tangents`` and no
            ``scene`` say that the light itself is looked at; otherwise none.
        line_diameter : float, optional
            Diameter of lines in the unit of the mesh, at least a pixel, in place of PyVista's
            ``line_width`` in pixels: nearer lines are wider.
        halo : bool, float or str, optional
            Band of the colour of the ground on each side of lines, which tells the line in front
            where two cross: its width in widths of the line, or False for none. A colour, such as
            ``"black"``, draws a narrower one in it, 0.35 widths and at least 0.9 pixels: an outline
            for dense lines, which bands of the ground's colour would cut to pieces. A band is the
            deeper the farther it is from its line, up to 4 widths of the line, so that lines that
            run together have no gap. On a light ground the rim of lines that are nearly as light is
            darker, but of colours of data. Lines with halos have round ends and joints, and are
            drawn nearer to the eye by their own width, so that a surface on which they lie does not
            hide them. Default: one width, at least 2 pixels; none for lines of an opacity below 1.
        width : str, optional
            Name of a point array of lines, one number per point: the local width of the line, as a
            share from 0 to 1 of ``line_width`` or ``line_diameter``, such as ``"width"`` of the
            strokes of :func:`vizlight.streamlines`. NaN is 0. Halos keep their width.
        **options
            Options of :func:`vizlight.illuminate`, such as ``tangents=`` and ``conditioned=``,
            except ``name`` and ``components``, with ``feature_angle="auto"`` by default: where
            edges are creases a copy with split points is drawn, which does not follow later changes
            of the mesh; and keywords of ``pyvista.Plotter.add_mesh``, such as ``clim``, ``name``,
            ``opacity``, ``line_width``, ``pickable``, and ``cmap``, which is ``vizlight.maps.even``
            unless the theme's was changed. ``smooth_shading=False`` splits the points at every
            edge, so that faces are flat, ``split_sharp_edges`` at edges of the theme's angle.
            PyVista draws the mesh with its own light if ``lighting=False``, ``pbr=True`` or
            ``style="points_gaussian"``, and points that have no vectors. With
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
        ``export_gltf`` and the like raise a ValueError with the remedy as long as the plotter has
        any. :meth:`export_html` of this component can.

        Shadows and ambient occlusion (SSAO) of PyVista do not show on meshes with live light, and
        the light of a copy of an actor stays as it is.

        With ``bundle`` the shares of light are computed again only for lights that have moved. The
        lights of a scene must stay fixed; the plotter's lights may follow the camera, at the cost
        of one grid for each of them in each frame.

        Light at the points is bit-identical to the filter's for the same camera; halos blend the
        borders of lines with the ground. Light in
        fragments is within 4 of 255 of it on fine meshes, shadows within 2 of 255 at the nodes of a
        height field.
        """
        plotter = self._open_plotter()
        blocks.check(mesh)
        scene = optional_scene(scene)
        _check.choice("light", light, get_args(LightAt))
        light_options, drawing = keywords.sorted_out("plotter.vizlight.add_mesh", options, scene)
        width_of_lines = _check_lines(mesh, line_diameter, halo, width)
        if _check.boolean("copy_mesh", drawing.pop("copy_mesh", False)):
            mesh = mesh.copy(deep=False)
        # Some styles are PyVista's own shading: the mesh is added as it would be without this
        # component.
        why = keywords.left_to_pyvista(drawing)
        if why is not None:
            if why:
                _check.warn(f"the mesh has PyVista's light in place of vizlight's: {why}")
            color_rows: Foreign = scalars
            unlit: pv.Actor = plotter.add_mesh(mesh, scalars=color_rows, **drawing)
            if isinstance(unlit, pv.Actor):
                enlarge(unlit, plotter.renderer)
            return unlit
        if scalars is None and scene is None and not (light_options or relight.is_lit(mesh)):
            others = any(drawing.get(name) for name in ("color", "multi_colors", "texture"))
            scalars = None if others else keywords.active_scalars(mesh)
        mesh, chosen = keywords.colored(mesh, scalars, drawing)
        angle = keywords.shading_of(drawing)
        several, named = isinstance(mesh, pv.MultiBlock), list(blocks.named_blocks(mesh))
        # Points without vectors have no side that light could fall on.
        clouds = [keywords.is_cloud(block, light_options) for block, _ in named]
        if any(clouds):
            mesh = pv.MultiBlock()
            for (block, path), is_cloud in zip(named, clouds, strict=True):
                if not is_cloud:
                    mesh.append(block, path.lstrip("/"))
        # All blocks are read before one is drawn: an error leaves the plotter as it was.
        sources, used = sources_of(mesh, scene, light_options, angle)
        if getattr(plotter, "notebook", False):
            guard()
        lit, colors = iter(sources), keywords.block_colors(drawing)
        actors = []
        for number, ((block, path), is_cloud) in enumerate(zip(named, clouds, strict=True)):
            keywords_of = drawing | next(colors)
            if several and drawing.get("name") is not None:
                keywords_of["name"] = f"{drawing['name']}-{number}"
            # A block without the array has the colour of the material.
            lacks = several and chosen not in (*block.point_data, *block.cell_data)
            here = None if lacks else chosen
            if is_cloud:
                actors.append(_add_cloud(plotter, block, here, keywords_of))
                continue
            # Empty blocks have sources too: taken before they are left out, so that both stay in
            # step.
            source = next(lit)
            if not block.n_points:
                continue
            shown, tints = (here, {}) if here is not None else tinted(source.mesh)
            # What the caller passes counts over what a tint was made with.
            keywords_of = tints | keywords_of | width_of_lines
            keywords_of |= keywords.whole_range(block, here, keywords_of)
            live = _live(source, used, light, keywords_of)
            live.name = path.lstrip("/") or str(drawing.get("name") or "")
            actors.append(self._add(plotter, live, shown, keywords_of))
        if not several and not actors:
            raise _check.value_error("mesh", "a mesh with points", "none")
        return actors if several else actors[0]

    def add_key(
        self,
        scene: AnyScene | None = None,
        /,
        *,
        question: str | None = None,
        size: float = 0.15,
        color: ColorLike | None = None,
        lying: bool = False,
        **options: Given,
    ) -> pv.PolyData:
        """Draw the key of the light, with its words, in a margin beside the data.

        The margin is at the right of a picture that is wider than tall, else below; several keys
        stack there. The data are drawn in the rest of the picture. In a subplot without data, which
        a key of several views may have, it stands in the middle.

        Parameters
        ----------
        scene : Scene or str, optional
            Scene with the light that the key explains. Default: the scene of the first mesh of
            :meth:`add_mesh`, with the exponent of its light, and its colour map where it is
            coloured by values.
        question : str, optional
            Content of the key. Default: the question of the preset, see
            :func:`vizlight.presets.key`.
        size : float, default: 0.15
            Width of the key, as a share of the shorter side of the picture, from 0.02 to 1.
        color : colour, optional
            Colour of the words. Default: black on a light background, white on a dark one.
        lying : bool, default: False
            Whether a bar lies below the data, which suits wide maps, as long as it is the only key.
        **options
            Keywords of :func:`vizlight.presets.key`: exponent, conditioned, cmap, clim, levels,
            title.

        Returns
        -------
        pyvista.PolyData
            The key.

        Raises
        ------
        TypeError, ValueError
            If an argument does not fit; without a scene and without a mesh with live light.
        RuntimeError
            If the plotter is closed.

        Notes
        -----
        Lights that follow the view have the same key in all views. The key of fixed lights is made
        for the camera when it is added.
        """
        plotter = self._open_plotter()
        scene = optional_scene(scene)
        if scene is None:
            scene, light_of_data = self._first_light(plotter, question)
            options = light_of_data | options
        of_question: Keywords = {"question": question}
        mesh = key(scene, **(of_question | options))
        self.show_key(mesh, size=size, color=color, lying=lying)
        return mesh

    def show_key(
        self,
        mesh: pv.PolyData,
        /,
        *,
        size: float = 0.15,
        color: ColorLike | None = None,
        lying: bool = False,
    ) -> None:
        """Draw a key that was made by :func:`vizlight.presets.key` in the margin.

        Parameters
        ----------
        mesh : pyvista.PolyData
            Key.
        size : float, default: 0.15
            Width of the key, as a share of the shorter side of the picture, from 0.02 to 1.
        color : colour, optional
            Colour of the words of the first key, as for :meth:`add_key`.
        lying : bool, default: False
            As for :meth:`add_key`.

        Raises
        ------
        RuntimeError
            If the plotter is closed.
        TypeError, ValueError
            If an argument does not fit.
        """
        plotter = self._open_plotter()
        size = _check.number("size", size, low=0.02, high=1.0)
        if not isinstance(mesh, pv.PolyData) or WORDS not in mesh.field_data:
            expected = "a mesh that vizlight.presets.key returned"
            raise _check.type_error("mesh", expected, mesh)
        lying = _check.boolean("lying", lying)
        if lying and len(mesh.field_data[WORDS]) == 1:
            expected = "False for a key that is a disc"
            raise _check.value_error("lying", expected, lying, "take the key of a bar")
        renderer = plotter.renderer
        if _address(renderer) not in self._margins:
            ink = _check.color("color", color)
            if ink is None:
                ink = ink_on(plotter.background_color)
            self._margins[_address(renderer)] = Margin(renderer, ink)
        self._margins[_address(renderer)].add(mesh, size, lying=lying)

    def _first_light(self, plotter: pv.BasePlotter, question: str | None) -> tuple[Scene, Keywords]:
        """Return the scene of the first mesh with live light, and its options of a key."""
        for actor in items(plotter.renderer.GetActors()):
            live = self._live_of(actor)
            if live is not None:
                lit_by = live.scene_of(plotter.renderer, actor)
                options: Keywords = {"exponent": live.source.options.exponent}
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
        raise _check.value_error("scene", expected, None, remedy)

    def export_html(
        self,
        path: str | Path,
        /,
        *,
        title: str = "",
        panel: bool = True,
        key: bool = True,
        source: Sequence[str] = (),
    ) -> Path:
        """Write one HTML file that shows the meshes in light that follows the eye of the reader.

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
        source : sequence of str, optional
            File, and options of the command that lights it alike, as for
            :func:`vizlight.live_html`.

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
            If no mesh has live light, and none is drawn without light or some are lit by PyVista.

        Warns
        -----
        UserWarning
            If the light of a mesh does not follow the eye, or other actors are left out.
        """
        return write_page(
            path, self.shown(), self._open_plotter(), title=title, panel=panel, key=key,
            source=source,
        )  # fmt: skip

    def save_graphic(self, path: str | Path, /, *, error: float | None = None) -> Path:
        """Write the picture of the plotter as vector graphics: filled paths, strokes and text.

        Light is drawn as areas of one colour each, which are painted from dark to light and reach
        beneath those that follow, and the background last, so that no seams show at any scale.
        More than 128 colours become three plates in an SVG file, as in print: levels of red, of
        green and of blue, of which the picture has the lightest (``mix-blend-mode: lighten``).
        Hidden surfaces have no path. Lines are strokes of their widths, or outlines where these
        change, with halos; words of texts, keys and scalar bars stay text.

        Parameters
        ----------
        path : path
            Path of the file, which ends in .svg or .pdf. An existing file is replaced.
        error : float, optional
            Largest difference from the light, in 1/255 of each channel, from 0.1 to 128. Default:
            the smallest from 2 on with which the file has at most 500 kB.

        Returns
        -------
        pathlib.Path
            Path of the file.

        Raises
        ------
        FileError
            If the file cannot be written.
        BackendError
            If no OpenGL library can draw here.
        RuntimeError
            If the plotter is closed.
        TypeError, ValueError
            If the error does not fit.

        Warns
        -----
        UserWarning
            If the default error is more than 4, if the file has more than 500 kB, or if surfaces
            have so many details that the file holds pixels in place of their paths.

        Notes
        -----
        The light is read back from the plotter's own drawing in 24 bits, at 2 to 4 samples along
        the side of a pixel; translucent surfaces and lit lines have 8 bits. Edges are within half a
        sample. Of the error, 8 % let the light vary less, so that its contours are smooth, and 12 %
        let borders lie where the light is that far from their level. The rim of a surface has the
        colour within it, as its pixels are mixtures. The source is the rendering by filled
        polygons in the painter's order of Conway and Cottingham, The Isoluminance Contour Model.
        """
        # It draws, which a page does not.
        from vizlight.draw.vector.figure import save_graphic

        return save_graphic(self._open_plotter(), path, self._live_of, error=error)

    def shown(self) -> list[PageMesh]:
        """Return the visible meshes of a page, with its camera set.

        Those with live light come first, then points, lines, and what PyVista draws without light.
        What cannot be picked stands beside the data and has no name.

        Returns
        -------
        list of PageMesh

        Raises
        ------
        ValueError
            If the plotter has none, or surfaces in the light of PyVista beside what has no light.

        Warns
        -----
        UserWarning
            If surfaces in the light of PyVista are left out of the page.
        """
        plotter = self._open_plotter()
        visible = [actor for actor in items(plotter.renderer.GetActors()) if actor.GetVisibility()]
        lit = [(live, actor) for actor in visible if (live := self._live_of(actor)) is not None]
        visible_meshes = [
            PageMesh((light.name or f"mesh {i}") if actor.GetPickable() else "", light, actor)
            for i, (light, actor) in enumerate(lit, 1)
        ] + [PageMesh("", None, actor) for actor in visible if self._is_unlit(actor)]
        others = len(visible) - len(visible_meshes)
        if not visible_meshes or (others and not lit):
            got = f"none and {others} in the light of PyVista" if others else "none"
            remedy = "add a mesh by plotter.vizlight.add_mesh"
            raise _check.value_error("plotter", "a mesh with live light", got, remedy)
        if others:
            _check.warn(f"{others} actors in the light of PyVista are not in the page")
        # Until its first picture a plotter of PyVista has no view of its data, and a page takes
        # none.
        if not plotter.camera_set:
            plotter.renderer.view_isometric(render=False)
        return visible_meshes

    @property
    def margin(self) -> Margin | None:
        """Title and keys beside the data, None where :meth:`add_key` drew none."""
        return self._margins.get(_address(self._open_plotter().renderer))

    def moving(self) -> list[pv.PolyData]:
        """Return the lines with moving strokes: those of ``streamlines(travel=)`` with widths."""
        lives = [self._live_of(actor) for actor in items(self._open_plotter().renderer.GetActors())]
        meshes = [live.source.mesh for live in lives if live and live.stroke.width == WIDTH]
        lines = [mesh for mesh in meshes if isinstance(mesh, pv.PolyData)]
        return [mesh for mesh in lines if PHASE in mesh.point_data]

    def explain(self, actor: vtkActor, /) -> str:
        """Return where the light of an actor is computed and why, and which terms.

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
        plotter = self._open_plotter()
        return live.explain(live.scene_of(plotter.renderer, actor))

    def set_scene(self, actor: vtkActor, scene: AnyScene, /) -> None:
        """Light an actor by another scene, from the next frame on.

        Nothing else is computed again, but the cos-theta shadows of light at the points.

        Parameters
        ----------
        actor : pyvista.Actor
            Actor that :meth:`add_mesh` returned.
        scene : Scene or str
            Lights, material and depth cue, as for :meth:`add_mesh`.

        Raises
        ------
        TypeError, ValueError
            If it is no scene, or the actor has no live light.
        """
        self._lit_by_us(actor).set_scene(required_scene(scene), actor)

    @property
    def has_live_light(self) -> bool:
        """Whether the plotter shows a mesh with light that follows the camera."""
        self._forget()
        return bool(self._lives)

    def legibility(self, **options: Given) -> Foreign:
        """Measure how much a reader can read back from the whole picture of the plotter.

        Parameters
        ----------
        **options
            Options of :func:`vizlight.legibility` for the eye and the places: size_mm,
            distance_mm, screen, noise, samples, seed.

        Returns
        -------
        vizlight.Legibility
            Figures of the meshes of :meth:`add_mesh`, and of the values of others.

        Raises
        ------
        TypeError, ValueError
            If an option does not fit, or nothing that can be read is visible.
        RuntimeError
            If the plotter is closed.
        """
        # The meter stands above plotters, and draws by them.
        meter = importlib.import_module("vizlight.observers.whole")
        return meter.legibility_of(self._open_plotter(), self._live_of, **options)

    def _is_unlit(self, actor: vtkActor) -> bool:
        """Return whether PyVista draws points, lines, or a mesh without light."""
        if self._live_of(actor) is not None or draws_light(actor):
            return False
        mesh = drawn_mesh(actor)
        if not isinstance(mesh, pv.DataSet) or not mesh.n_points:
            return False
        flat = mesh.max_cell_dimensionality < 2 and mesh.point_data.active_normals is None
        return flat or not actor.GetProperty().GetLighting()

    def _lit_by_us(self, actor: vtkActor) -> Live:
        expected = "one of plotter.vizlight.add_mesh"
        if not hasattr(actor, "GetAddressAsString"):
            raise _check.type_error("actor", expected, actor)
        live = self._live_of(actor)
        if live is None:
            raise _check.value_error("actor", expected, _check.describe(actor))
        return live

    def _live_of(self, actor: vtkActor) -> Live | None:
        kept, live = self._lives.get(_address(actor), (None, None))
        # Another actor may have come to the place of one that is gone.
        return live if kept is not None and kept.Get() is not None else None

    def _forget(self) -> None:
        """Let go of the light of actors that are gone.

        Observers of their end would be called by VTK while Python collects garbage, which crashes.
        """
        for address, (kept, _) in [*self._lives.items()]:
            if kept.Get() is None:
                del self._lives[address]

    def _open_plotter(self) -> pv.BasePlotter:
        plotter = self._plotter()
        if plotter is None or plotter.render_window is None:
            remedy = "make another pyvista.Plotter"
            raise RuntimeError(_check.message("plotter", "an open plotter", "a closed one", remedy))
        return plotter

    def _add(
        self, plotter: pv.BasePlotter, live: Live, scalars: str | None, drawing: Keywords
    ) -> pv.Actor:
        """Draw a mesh, light it once, and let its light follow."""
        if drawing.get("name") is not None:
            _check.text("name", drawing["name"], expected="a name for the actor")
        # The first frame comes at the end, when the mesh has its light.
        rendered = drawing.pop("render", True)
        bar_options = drawing.get("scalar_bar_args") or {}
        if scalars is not None:
            live.color_by(scalars, drawing.pop("component", None))
            drawing["scalars"] = live.scalars
            if live.has_colors():
                drawing["rgb"] = True
            else:
                drawing |= _map_of(drawing)
                values = live.drawn[drawing["scalars"]]
                if drawing.get("clim") is None and not np.isfinite(values).any():
                    drawing["clim"] = (0.0, 1.0)  # of no value at all
                drawing["scalar_bar_args"] = {"title": scalars} | bar_options
        live.attach()
        drawing = live.drawing(drawing)
        actor: pv.Actor = plotter.add_mesh(
            # Normals of PyVista would take the place of those attached.
            live.drawn,
            smooth_shading=False,
            split_sharp_edges=False,
            render=False,
            **drawing,
        )
        if live.scene is None and not drawing.keys() & keywords.MATERIAL:
            prop, default = actor.prop, Material()
            # PyVista's own defaults are nobody's choice: the material of this package stands in
            # for them.
            if (prop.ambient, prop.diffuse, prop.specular) == UNTOUCHED:
                prop.ambient, prop.diffuse = default.ambient, default.diffuse
                prop.specular = default.specular
        if drawing.get("rgb") and _hides(live.drawn[drawing["scalars"]]):
            # VTK blends colours of four channels in the order of the cells, the far ones over
            # the near ones.
            actor.ForceOpaqueOn()
        try:
            live.start(actor)
            live.paint(plotter.renderer, actor)
        except (TypeError, ValueError):
            plotter.remove_actor(actor, render=False)
            raise
        if live.stroke == Stroke():
            enlarge(actor, plotter.renderer)
        invalid = live.invalid()
        if invalid and live.follow:
            _check.warn(unlit(invalid, live.source.inputs.count))
        for bar in plotter.scalar_bars.values() if scalars is not None else ():
            if bar.GetLookupTable() is actor.mapper.lookup_table:
                settle(plotter, bar, bar_options)
                if invalid or live.lacks_values():
                    name_no_data(bar)
        self._keep(plotter, live, actor)
        if rendered:
            plotter.render()
        return actor

    def _keep(self, plotter: pv.BasePlotter, live: Live, actor: pv.Actor) -> None:
        """Tie a live light to its actor, and observe the renderers."""
        guard_exports(plotter)
        self._forget()
        kept, me = vtkWeakReference(), weakref.ref(self)
        kept.Set(actor)
        self._lives[_address(actor)] = kept, live

        # The observer lives as long as its renderer, and must not keep the component alive.
        def update(renderer: vtkRenderer, _: str) -> None:
            component = me()
            if component is not None:
                component._update(renderer)

        observed = {_address(renderer) for renderer, _ in self._observed}
        for renderer in plotter.renderers:
            if _address(renderer) not in observed:
                # PyVista's own render callbacks come after the frame is drawn.
                self._observed.append((renderer, renderer.AddObserver("StartEvent", update)))

    def _update(self, renderer: vtkRenderer) -> None:
        """Light the meshes before a renderer draws them; warn once of those that do not show."""
        lost, any_live = set(), False
        self._forget()
        for actor in items(renderer.GetActors()):
            live = self._live_of(actor)
            if live is not None:
                # Passes matter only where they would have shown on a mesh of ours.
                any_live = True
                live.update(renderer, actor)
            elif draws_light(actor):
                lost.add("a copy of an actor has light that does not follow; add its mesh instead")
        if any_live:
            lost |= {
                f"{name} of PyVista do not show on meshes with live light"
                for kind, name in UNLIT_PASSES.items()
                if has_pass(renderer.GetPass(), kind)
            }
        for text in sorted(lost - self._lost):
            _check.warn(text)
        self._lost |= lost

    def __plotter_close__(self) -> None:
        """Let go of everything when the plotter closes."""
        for renderer, tag in self._observed:
            renderer.RemoveObserver(tag)
        self._observed.clear()
        # VTK may keep the actors.
        self._lives.clear()
        self._margins.clear()

    __plotter_deep_clean__ = __plotter_close__


def _check_lines(
    mesh: pv.DataSet | pv.MultiBlock,
    line_diameter: float | None,
    halo: bool | float | str | None,
    width: str | None,
) -> Keywords:
    """Return the keywords of how lines are drawn, checked."""
    if line_diameter is not None:
        line_diameter = _check.positive("line_diameter", line_diameter)
    if halo is not None:
        halo = check_halo(halo)
    if width is not None:
        width = _check.text("width", width, expected="the name of a point array")
        for block, _ in blocks.named_blocks(mesh):
            if block.n_points and has_lines_only(block):
                check_widths(block, width)
    return {"line_diameter": line_diameter, "halo": halo, "width": width}


def _address(thing: vtkObject) -> str:
    return str(thing.GetAddressAsString(""))


def _hides(colors: Raw) -> bool:
    """Return whether colours with opacities hide what is behind them, to the eye, everywhere."""
    if colors.ndim != 2 or colors.shape[1] != 4:
        return False
    opacity = np.asarray(colors[:, 3], dtype=np.float64)
    return bool(np.all(opacity >= OPAQUE * (255 if colors.dtype.kind == "u" else 1)))


def _map_of(drawing: Keywords) -> Keywords:
    """Return the colours of values, and of missing values, by keywords."""
    ends = drawing.get("clim")
    return {
        "cmap": default_map(drawing.get("cmap")),
        "nan_color": default_nan_color(drawing.get("nan_color")),
        "clim": None if ends is None else _check.limits("clim", ends),
    }


def _add_cloud(
    plotter: pv.BasePlotter, mesh: pv.DataSet, scalars: str | None, drawing: Keywords
) -> pv.Actor:
    """Add points that have nothing for light to fall on, in the colours that a lit mesh has."""
    if scalars is None:
        drawing = {"color": True} | drawing
    else:
        as_given = are_colors(values_of(mesh, scalars))
        drawing = drawing | ({"rgb": True} if as_given else _map_of(drawing))
    actor: pv.Actor = plotter.add_mesh(mesh, scalars=scalars, **drawing)
    enlarge(actor, plotter.renderer)
    return actor


def _live(source: Source, scene: Scene | None, light: LightAt, drawing: Keywords) -> Live:
    """Return a live light in each fragment, or at the points where that is asked for or needed."""
    stroke = stroke_of(source.mesh, drawing)
    # A shadow stays where the camera turns: it is cast in fragments where that is asked for.
    cast = light == "fragments"
    reason = "asked for" if light == "points" else _reason(source, drawing, stroke, cast=cast)
    if not reason:
        return Fragments(source, scene, stroke)
    if light == "fragments":
        _check.warn(f"light='fragments': the light is computed at the points, because {reason}")
    if stroke.round and stroke.diameter is None:
        # Light at points has no normal across a line: VTK's own tubes are drawn instead.
        drawing["render_lines_as_tubes"] = True
        stroke = Stroke()
    return Live(source, scene, stroke._replace(round=False), reason=reason)


def _reason(source: Source, drawing: Keywords, stroke: Stroke, *, cast: bool = False) -> str:
    """Return why the light cannot be computed in each fragment, or an empty string."""
    if drawing.get("render_points_as_spheres") or drawing.get("render_lines_as_tubes"):
        return "VTK shades spheres and tubes by normals of their own"
    return unfit(source, stroke, cast=cast)


def add_recorded(
    plotter: pv.BasePlotter, mesh: pv.DataSet, name: str, **drawing: Given
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
    _check.instance("plotter", plotter, pv.BasePlotter, "a pyvista.Plotter")
    blocks.check(mesh)
    if isinstance(mesh, pv.MultiBlock):
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
    stroke = stroke_of(source.mesh, drawing)
    if _reason(source, drawing, stroke):
        return None
    # The array of the light has no colours, whatever those of the lamps: it is drawn in grey.
    live = Fragments(source, scene if name == RGB else _colorless(scene), stroke, follow=False)
    component: Component = plotter.vizlight
    return component._add(plotter, live, scalars, colors | drawing)


def _colorless(scene: Scene) -> Scene:
    """Return a scene without colours: its light is luminance alone."""
    cue, material = scene.depth_cue, scene.material
    return scene.replace(
        lights=tuple(dataclasses.replace(light, color=None) for light in scene.lights),
        material=dataclasses.replace(material, color=None, specular_color=None),
        ambient_color=None,
        depth_cue=None if cue is None else dataclasses.replace(cue, color=None),
        exposure=None,
    )


# As a decorator it would hide the methods from type checkers.
pv.register_plotter_component("vizlight")(Component)
