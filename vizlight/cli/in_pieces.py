"""``vizlight light`` of data in pieces: files of one mesh, or slabs of a grid beyond memory."""

from __future__ import annotations

import importlib.util
from typing import TYPE_CHECKING

from vizlight._words import message
from vizlight.cli.output import OK, complain, draw, say
from vizlight.cli.script import Step, source

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from vizlight._types import Keywords
    from vizlight.cli.arguments import Color, Common, Output, Pieces, Target
    from vizlight.cli.scenes import Look

#: What ``--workers`` stands for.
PROCESSES = "vizlight.pieces.Processes"


def are_asked(out: Output, pieces: Pieces) -> bool:
    """Return whether files are pieces of one mesh, by the output and the workers."""
    if _indices(out):
        return True
    for name, value in vars(pieces).items():
        option = f"--{name}"
        if value is not None:
            from vizlight.pieces.sources import INDEX

            endings = ", ".join(INDEX.values())
            expected = f"an output that ends in {endings}, of pieces, beside {option}"
            got = ", ".join(str(path) for path in out.output or ()) or "none"
            raise ValueError(message("output", expected, got))
    return False


def _indices(out: Output) -> list[Path]:
    """Return the outputs that are indices of pieces."""
    found = [path for path in out.output or () if path.suffix.lower().startswith(".pv")]
    if not found:
        return []
    from vizlight.pieces.sources import INDEX

    return [path for path in found if path.suffix.lower() in INDEX.values()]


def light(
    files: Sequence[Path],
    target: Target,
    given: Keywords,
    common: Common,
    color: Color,
    pieces: Pieces,
    look: Look,
) -> int:
    """Light files as pieces of one mesh, or print the script that does; return the exit code."""
    out = common.out
    _refuse(target, color, out)
    indices = _indices(out)
    others = [path for path in out.output or () if path not in indices]
    for path in others:
        if path.suffix.lower() != ".png":
            expected = "pictures .png beside the index of pieces"
            remedy = f"make it of the index by 'vizlight light {indices[0]} -o {path}'"
            raise ValueError(message("output", expected, f"'{path}'", remedy))
    if len(indices) > 1:
        expected = "one index of pieces"
        raise ValueError(message("output", expected, ", ".join(map(str, indices))))
    if indices[0].suffix == ".pvtp":
        given = {"feature_angle": "auto"} | given
    runs: Keywords = _runs(pieces)
    shown = {"progress_bar": True} if out.progress else {}
    asked: Keywords = {"contour": target.contour, "level": target.level, "slab": pieces.slab}
    what = {key: value for key, value in asked.items() if value is not None}
    # The eye belongs to the lit whole, which no piece knows: it is found before the light.
    camera = look.camera(list(files), by="vizlight.pieces.camera_on", **what, **runs, **shown)
    scene = look.scene(camera)
    lit = Step(
        "lit", "vizlight.pieces.light", list(files), scene, **what, out=indices[0], **runs, **given,
        **shown,
    )  # fmt: skip
    name = str(given.get("name", "luminance"))
    scalars = ("rgb" if name == "luminance" else f"{name}_rgb") if look.colored else name
    options = {
        "background": out.background,
        "line_width": None if out.line_width == 1 else out.line_width,
        "backend": out.backend,
    }
    panel = Step("", "render.Panel", Step("whole", "vizlight.read", indices[0]), scalars)
    drawn = [
        Step(
            "", "render.save_png", panel, path, camera=camera, size=look.size, light="points",
            **{key: value for key, value in options.items() if value is not None},
        )
        for path in others
    ]  # fmt: skip
    if out.script:
        say(source([[lit, *drawn]]))
        return OK
    made = lit.run()
    none = f", {made.empty} empty" if made.empty else ""
    say(f"{made.points} points lit in {len(made.files)} pieces{none}")
    low, high = made.ranges[name]
    if high > 1:
        complain(f"{name} is from {low:.3g} to {high:.3g}; above 1 it is white in a picture")
    say(f"mesh     {made.path}")
    return max((draw(step.run) for step in drawn), default=OK)


def _runs(pieces: Pieces) -> dict[str, Step]:
    """Return what the pieces are lit by: this process, processes, or a cluster."""
    if pieces.workers is not None:
        from vizlight import _check

        _check.integer("--workers", pieces.workers, low=1)
    if pieces.scheduler is None:
        several = pieces.workers is not None and pieces.workers > 1
        return {"map": Step("work", PROCESSES, pieces.workers)} if several else {}
    if pieces.workers is not None:
        raise ValueError(message("--workers", "--workers or --scheduler", "both"))
    if importlib.util.find_spec("distributed") is None:
        remedy = "install it by: pip install 'vizlight[scale]'"
        raise ValueError(message("--scheduler", "the package distributed", "none", remedy))
    # An address that nobody answers at is an error of the operating system.
    return {"map": Step("work", "distributed.Client", pieces.scheduler, timeout=10)}


def _refuse(target: Target, color: Color, out: Output) -> None:
    """Refuse options that need the mesh as a whole."""
    unknown = {
        "--time": target.time,
        "--times": target.times,
        "--overlay": target.overlay,
        "--clip": target.clip,
        "--threshold": target.threshold,
        "--slice": target.slice,
        "--warp": target.warp,
        "--scalars": color.scalars,
        "--report": out.report,
        "--paraview": out.paraview,
    }
    for option, value in unknown.items():
        if value:
            raise ValueError(message(option, "no such option for pieces", "one"))
