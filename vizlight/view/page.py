"""What happens on the page: values that change, pictures that follow, undo, scripts."""

from __future__ import annotations

import asyncio
import dataclasses
import math
import time
from typing import TYPE_CHECKING, Any

from vizlight.cli.output import one_line
from vizlight.view import state as states
from vizlight.view import steps
from vizlight.view.state import History, State

if TYPE_CHECKING:
    from vizlight.view.stage import Stage
    from vizlight.view.state import Facts
    from vizlight.view.worker import Worker

__all__ = ["FIELDS", "LEVELS", "Page"]

#: Values of the state, by whose names the page knows them.
FIELDS = tuple(field.name for field in dataclasses.fields(State))
#: Values after which another part of the file is seen, so that the camera is set again.
FRAMED = ("show", "array", "heights", "factor")
#: Steps of the slider of the level.
LEVELS = 200
#: Seconds within which changes of one value are one step of undo, and in which changes that came
#: together are drawn together.
ONE_STEP, TOGETHER = 1.0, 0.01


class Page:
    """The page of one file, however many browsers show it.

    Parameters
    ----------
    server : trame_server.Server
        Server whose state the browsers share.
    worker : Worker
        Process that holds the mesh.
    facts : Facts
        What the file offers.
    stage : Stage
        What is shown.
    """

    def __init__(self, server: Any, worker: Worker, facts: Facts, stage: Stage) -> None:
        self.server, self.worker, self.facts, self.stage = server, worker, facts, stage
        self.history = History(states.first(facts))
        self.redraw: Any = None
        self._shown: State | None = None
        self._failed: tuple[object, ...] = ()
        self._lock = asyncio.Lock()
        self._task: asyncio.Task[None] | None = None
        self._stopped = False
        self._due: asyncio.TimerHandle | None = None
        self._last: tuple[set[str], float] = (set(), 0.0)
        stage.on_move = self._camera_moved
        self._push(notice="", busy="", script="")
        server.state.change(*FIELDS)(self._changed)
        server.state.change("level_at")(self._level_moved)

    @property
    def state(self) -> State:
        """Present state."""
        return self.history.present

    # What a browser asks for

    def start(self) -> None:
        """Make the first picture."""
        self._follow()

    def undo(self) -> None:
        """Take back the last change."""
        self._go(self.history.undone())

    def redo(self) -> None:
        """Repeat the last change that was taken back."""
        self._go(self.history.redone())

    def defaults(self) -> None:
        """Go back to the state in which the file was opened, as one change."""
        self._go(self.history.with_state(states.first(self.facts)))

    def frame_all(self) -> None:
        """Set the camera so that all is seen."""
        self.stage.frame_all()
        self._draw_soon()

    def stop(self) -> None:
        """End what the worker does, and go back to what is shown."""
        if self._task is not None:
            self._stopped = True
            self.worker.stop()

    def copy(self) -> None:
        """Write the script of the picture."""
        with self.server.state as shared:
            shared.script = self.script()

    def script(self) -> str:
        """Return the script of the picture."""
        return steps.script(
            self.state, self.facts, self.worker.file, self.stage.eye, self.stage.size
        )

    async def picture(self) -> bytes | None:
        """Return the bytes of the picture that the script makes, None if there is none."""
        state, eye, size = self.state, self.stage.eye, self.stage.size
        answer = await self._ask("drawing the picture", self.worker.picture, state, eye, size)
        self._busy("")
        if answer.error:
            self._push(notice=answer.error)
        made: bytes | None = answer.result
        return made

    def close(self) -> None:
        """End the worker and close the stage."""
        if self._due is not None:
            self._due.cancel()
        self.worker.stop()
        self.stage.close()

    # What changes

    def _changed(self, **shared: Any) -> None:
        """Take what a browser changed."""
        present = self.state
        values = {name: shared[name] for name in FIELDS if shared[name] != getattr(present, name)}
        if not values:
            return
        try:
            state = states.fitted(present.changed(**values), present, self.facts)
        except (TypeError, ValueError) as error:
            self._push(notice=one_line(error))
            return
        names, now = set(values), time.monotonic()
        merged = (names, True) == (self._last[0], now - self._last[1] < ONE_STEP)
        self._last = names, now
        self._go(self.history.with_state(state, merged=merged))

    def _level_moved(self, level_at: float, **_: Any) -> None:
        low, high = self.facts.scalars.get(self.state.array, (0.0, 0.0))
        if level_at != self._level_at():
            level = low + (high - low) * min(max(level_at, 0), LEVELS) / LEVELS
            self.server.state.level = float(f"{level:.6g}") if low < level < high else level

    def _level_at(self) -> int:
        low, high = self.facts.scalars.get(self.state.array, (0.0, 0.0))
        return round(LEVELS * (self.state.level - low) / (high - low)) if high > low else 0

    def _go(self, history: History) -> None:
        self.history = history
        self._push(notice="")
        self._follow()

    def _push(self, **other: Any) -> None:
        """Show the present state in the browsers."""
        with self.server.state as shared:
            shared.update(dataclasses.asdict(self.state))
            shared.update(
                {
                    "level_at": self._level_at(),
                    "can_undo": bool(self.history.past),
                    "can_redo": bool(self.history.future),
                    "lined": states.has_lines(self.state, self.facts),
                    **other,
                }
            )

    def _camera_moved(self) -> None:
        """Show where the light is that follows the eye."""
        if self.state.shoulder:
            x, y, z = self.stage.shoulder
            azimuth = round(math.degrees(math.atan2(x, y))) % 360
            altitude = round(math.degrees(math.atan2(z, math.hypot(x, y))))
            present = dataclasses.replace(self.state, azimuth=azimuth, altitude=altitude)
            self.history = dataclasses.replace(self.history, present=present)
            asyncio.get_running_loop().call_soon(self._push)

    # What follows

    def _follow(self) -> None:
        """Let the picture follow the state: by light alone, or by another mesh."""
        state = self.state
        if self._shown is None or state.built != self._shown.built:
            if self._task is None and state.built != self._failed:
                self._task = asyncio.get_running_loop().create_task(self._build())
            return
        try:
            self.stage.light(state)
            self._shown = state
        except (TypeError, ValueError) as error:
            self._give_up(one_line(error))
        self._draw_soon()

    async def _build(self) -> None:
        """Make the mesh of the state, and again if the state has changed meanwhile."""
        try:
            while self._shown is None or self.state.built != self._shown.built:
                state, self._stopped = self.state, False
                answer = await self._ask(_doing(state), self.worker.light, state)
                error = "stopped; the picture is the one before" if self._stopped else answer.error
                if not error:
                    error = self._show(answer.result, state)
                if error and state.built == self.state.built:
                    self._give_up(error)
                    return
                if not error:
                    self._push(notice=" ".join(answer.warnings))
        finally:
            self._task = None
            self._busy("")
            self._draw_soon()

    def _show(self, mesh: Any, state: State) -> str:
        """Show a mesh with the light of now, and return what is wrong with it."""
        before = self._shown
        framed = before is None or any(
            getattr(before, name) != getattr(state, name) for name in FRAMED
        )
        built = {name: getattr(state, name) for name in states.BUILT[state.show]}
        now = dataclasses.replace(self.state, show=state.show, **built)
        try:
            self.stage.show(mesh, now, framed=framed)
        except Exception as error:  # noqa: BLE001 - the page shows it and keeps its picture
            return one_line(error)
        self._shown = now
        return ""

    def _give_up(self, error: str) -> None:
        """Go back to the state that is shown, and say why."""
        present, past = self.state, self.history.past
        self._failed = present.built
        if self._shown is not None:
            names = {"show", "color", "cmap"} | set().union(*states.BUILT.values())
            good = {name: getattr(self._shown, name) for name in names}
            present = dataclasses.replace(present, **good)
            past = past[:-1] if past and past[-1].built == present.built else past
            self._failed = ()
        self.history = History(present, past)
        self._push(notice=error)

    async def _ask(self, doing: str, ask: Any, *arguments: Any) -> Any:
        """Let the worker do one thing after the other while the page goes on."""
        async with self._lock:
            self._busy(doing)
            return await asyncio.to_thread(ask, *arguments)

    def _busy(self, doing: str) -> None:
        with self.server.state as shared:
            shared.busy = doing

    def _draw_soon(self) -> None:
        """Draw once for all that changed together."""
        if self._due is None:
            self._due = asyncio.get_running_loop().call_later(TOGETHER, self._draw)

    def _draw(self) -> None:
        self._due = None
        if self.redraw is not None and self._shown is not None:
            self.redraw()


def _doing(state: State) -> str:
    """Return what the worker does for a state, in words."""
    if state.show == "streamlines":
        return f"tracing {state.lines} lines"
    if state.show == "isosurface":
        return f"contouring {state.array}"
    return "lighting the surface"
