"""What the page shows: a plotter whose mesh, colours and light follow the state."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight.cli.scenes import VIEW
from vizlight.mesh.blocks import all_blocks
from vizlight.pictures.backends import choose_backend, window_class
from vizlight.pictures.cameras import camera_on, over_shoulder
from vizlight.plotting.component import Component  # noqa: TC001 - loads plotter.vizlight
from vizlight.reading.polylines import has_lines_only
from vizlight.view import steps

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from vizlight.view.state import State

__all__ = ["Stage"]

#: Size of the picture before a page says its own, in pixels.
SIZE = (1200, 800)


class Stage:
    """A plotter that shows one lit mesh, with the light of a state from where the camera is.

    Raises
    ------
    BackendError
        If no OpenGL library can draw here.
    """

    def __init__(self) -> None:
        with window_class(choose_backend(None)):
            self.plotter = pv.Plotter(off_screen=True, window_size=list(SIZE), border=False)
        # Multisampling triples the time of a frame of many lines; the picture that is saved has it.
        self.plotter.disable_anti_aliasing()
        self._live: Component = self.plotter.vizlight
        self._state: State | None = None
        self._mesh: pv.DataSet | None = None
        self._actor: pv.Actor | None = None
        self._lit_from: tuple[object, ...] = ()
        #: Size of the picture and camera by which the whole mesh was framed last.
        self._framed: tuple[object, steps.Eye] | None = None
        #: Called before a frame in which the light over the shoulder is another one.
        self.on_move: Callable[[], None] | None = None
        # Before the light of the mesh is computed, which has no priority.
        self.plotter.renderer.AddObserver("StartEvent", self._relight, 1.0)

    @property
    def eye(self) -> steps.Eye:
        """Where the camera is."""
        return steps.Eye.of(self.plotter.camera)

    @property
    def shoulder(self) -> tuple[float, float, float]:
        """Direction toward the light above and to the left of the eye."""
        return over_shoulder(self.plotter.camera)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        width, height = self.plotter.window_size
        return int(width), int(height)

    def show(self, mesh: pv.DataSet, state: State, *, framed: bool) -> list[str]:
        """Show a mesh that is lit, in place of the former, and return warnings.

        Parameters
        ----------
        mesh : pyvista.DataSet
            Mesh with the light of a filter.
        state : State
            State of the page.
        framed : bool
            Whether the camera is set so that the whole mesh is seen.

        Raises
        ------
        TypeError, ValueError
            If it cannot be drawn; then the former picture stays.
        """
        camera = self._whole(mesh) if framed else self.plotter.camera
        lines = all(has_lines_only(block) for block in all_blocks(mesh))
        options: dict[str, Any] = {"line_width": state.line_width}
        if state.color:
            options |= {"scalars": state.color, "cmap": state.cmap}
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", UserWarning)
            actor = self._live.add_mesh(
                mesh, scene=self._scene(state, camera), reset_camera=False,
                show_scalar_bar=False, render=False, **options,
            )  # fmt: skip
        if self._actor is not None:
            self.plotter.remove_actor(self._actor, render=False)
        assert isinstance(actor, pv.Actor)
        self._actor, self._mesh, self._state = actor, mesh, state
        if framed:
            self.frame_all()
        self.plotter.background_color = pv.Color("black" if lines else "white")
        self.plotter.reset_camera_clipping_range()
        self._lit_from = ()
        return [str(each.message) for each in caught]

    def light(self, state: State) -> list[str]:
        """Light what is shown by a state, from the next frame on; return warnings.

        Other colours or a line width take a new actor, light alone only new numbers.
        """
        if self._mesh is None or self._state is None:
            return []
        if state.drawn != self._state.drawn:
            return self.show(self._mesh, state, framed=False)
        self._state, self._lit_from = state, ()
        # A change of light alone does not make VTK draw anew.
        self.plotter.renderer.Modified()
        return []

    def frame_all(self) -> None:
        """Set the camera so that the whole mesh is seen."""
        if self._mesh is not None:
            self.plotter.camera = self._whole(self._mesh)
            self._framed = (self.size, self.eye)

    def _whole(self, mesh: pv.DataSet) -> pv.Camera:
        return camera_on(mesh, VIEW, aspect=self.size[0] / self.size[1])

    def screenshot(self) -> NDArray[Any]:
        """Return the picture as it is shown."""
        self.plotter.render()
        return np.array(self.plotter.screenshot(None, return_img=True))

    def close(self) -> None:
        """Close the plotter."""
        self.plotter.close()

    def _relight(self, *_: object) -> None:
        """Put in the light of the state, and that over the shoulder where the camera moved."""
        if self._state is None or self._actor is None:
            return
        if self._framed is not None and self._framed != (self.size, self.eye):
            moved = self.eye != self._framed[1]
            self._framed = None
            if not moved:
                # The window has another shape, and the camera is where it was put.
                self.frame_all()
                self.plotter.reset_camera_clipping_range()
        seen = (self._state, self.eye if self._state.shoulder else None)
        if seen != self._lit_from:
            self._lit_from = seen
            scene = self._scene(self._state, self.plotter.camera)
            self._live.set_scene(self._actor, scene)
            if self.on_move is not None:
                self.on_move()

    def _scene(self, state: State, camera: pv.Camera) -> Any:
        return steps.scene(state, steps.Eye.of(camera).step()).run()
