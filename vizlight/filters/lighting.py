"""What every filter does with meshes that are ready to be lit: light them all, then attach."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight import _check, _progress
from vizlight.mesh import records
from vizlight.shading import engine

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pyvista as pv

    from vizlight._types import Vector
    from vizlight.scene import Scene

DEFAULT_NAME = "luminance"
VALID = "_valid"
PARTS = ("ambient", "diffuse", "specular", "rgb")


@dataclass(frozen=True)
class Job:
    """The rows of one mesh that the engine lights.

    Points are given less ``origin``, where one is named; ``made_on_the_fly`` are those that are
    not there before they are lit; ``own`` are options of the engine for this mesh alone.
    """

    points: engine.Rows
    tangents: engine.Rows | None
    normals: engine.Rows | None
    carrier: engine.Rows | None = None
    depth: engine.Rows | None = None
    repeat: int = 1
    block: int | None = None
    origin: Vector | None = None
    made_on_the_fly: bool = False
    own: dict[str, Any] = field(default_factory=dict)


def light(
    jobs: Sequence[Job],
    scene: Scene,
    /,
    *,
    threads: int | None,
    progress_bar: bool,
    **options: Any,
) -> tuple[list[engine.Shading], Scene]:
    """Light all jobs; return their light and the scene with the ends of its depth cue."""
    fitted = _fit_depth_cue(scene, [job for job in jobs if not job.made_on_the_fly])
    results: list[engine.Shading] = []
    total = sum(job.points.shape[0] for job in jobs)
    with _progress.progress("light", total, show=progress_bar) as report:
        for job in jobs:
            done = sum(shading.luminance.size for shading in results)
            results.append(
                engine.shade(
                    job.points,
                    job.tangents,
                    fitted if job.origin is None else fitted.moved([-x for x in job.origin]),
                    normals=job.normals,
                    carrier=job.carrier,
                    depth=job.depth,
                    repeat=job.repeat,
                    block=job.block,
                    threads=threads,
                    progress=_after(done, report),
                    **(options | job.own),
                )
            )
    return results, fitted


def _after(done: int, report: Callable[[int], None]) -> Callable[[int, int], None]:
    return lambda now, _: report(done + now)


def _fit_depth_cue(scene: Scene, jobs: Sequence[Job]) -> Scene:
    """Return the scene with the ends of its depth cue taken from the points where not given."""
    cue = scene.depth_cue
    if cue is None or scene.view is None or (cue.front is not None and cue.back is not None):
        return scene
    ranges = [engine.depth_range(job.points, scene) for job in jobs]
    near = min((near for near, _ in ranges if np.isfinite(near)), default=0.0)
    far = max((far for _, far in ranges if np.isfinite(far)), default=1.0)
    # An end that is given may lie beyond all points: the other is then put beyond it.
    front, back = cue.front, cue.back
    if front is None:
        front = near if back is None or near < back else back - 1.0
    if back is None:
        back = far if far > front else front + 1.0
    return scene.replace(depth_cue=dataclasses.replace(cue, front=front, back=back))


def part_name(name: str, part: str) -> str:
    """Return what an array that comes with the light is called."""
    return part if name == DEFAULT_NAME else f"{name}_{part}"


def refuse_overwriting(
    leaves: list[tuple[pv.DataSet, str]], name: str, *, components: bool, colored: bool
) -> None:
    """Refuse to lose the user's own arrays to the light and what comes with it."""
    if not isinstance(name, str) or not name:
        raise ValueError(_check.message("name", "a name for the point array", repr(name)))
    parts = [part for part in PARTS if (colored if part == "rgb" else components)]
    made = [part_name(name, part) for part in parts]
    records.refuse_overwriting(leaves, name, [name, name + VALID, *made])


def finish(
    meshes: Sequence[pv.DataSet],
    results: Sequence[engine.Shading],
    filter_name: str,
    scene: Scene,
    options: dict[str, Any],
    name: str,
) -> None:
    """Attach the light to the meshes, with what made it; warn once if points could not be lit."""
    for mesh, shading in zip(meshes, results, strict=True):
        attach(mesh, shading, name, records.record(shading, filter_name, scene, options))
    invalid = sum(shading.invalid for shading in results)
    if invalid:
        total = sum(shading.luminance.size for shading in results)
        _check.warn(f"{unlit(invalid, total)}; the point array {name + VALID!r} marks them")


def unlit(invalid: int, total: int) -> str:
    """Return how many points could not be lit, and why, for a warning."""
    return (
        f"{invalid} of {total} points could not be lit (a zero, infinite or NaN vector, "
        "dependent tangents, or no surface normal there) and have the ambient light"
    )


def attach(mesh: pv.DataSet, shading: engine.Shading, name: str, told: dict[str, Any]) -> None:
    """Attach the light to a mesh, in place of what was there under the name."""
    parts: dict[str, Any] = {}
    if shading.diffuse is not None and shading.specular is not None:
        ambient = np.full_like(shading.luminance, shading.plan.ambient)
        parts = {"ambient": ambient, "diffuse": shading.diffuse, "specular": shading.specular}
    if shading.rgb is not None:
        parts["rgb"] = shading.rgb
    arrays = {part_name(name, part): array for part, array in parts.items()}
    if shading.invalid:
        arrays[name + VALID] = shading.valid
    records.attach(mesh, name, arrays | {name: shading.luminance}, told)
