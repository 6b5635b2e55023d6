"""The eye of a picture, and a random sample of the places that it sees."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.draw.backends import BackendError, choose_backend
from vizlight.draw.cameras import VIEW_ANGLE, camera_on
from vizlight.observers.parts import rows_of
from vizlight.observers.samples import Sample, sample
from vizlight.observers.visible import visible
from vizlight.scene import Scene, View
from vizlight.scene.view import as_view, is_camera

if TYPE_CHECKING:
    import pyvista as pv

    from vizlight._types import Indices
    from vizlight.observers.parts import Part
    from vizlight.scene.vtk import AnyView


def seen_from(
    mesh: pv.DataSet | pv.MultiBlock, scene: Scene, view: AnyView
) -> tuple[pv.Camera, Scene]:
    """Return the camera of the picture, and the scene with its view."""
    own = as_view(view) or scene.view
    for name, n in (("scene", scene.n), ("view", None if own is None else Scene(view=own).n)):
        if n not in (None, 3):
            remedy = "project the mesh first, vizlight.project, and measure it in 3-space"
            raise ValueError(_check.message(name, "vectors of 3 components", n, remedy))
    if is_camera(view):
        camera = camera_on((-1, 1, -1, 1, -1, 1))
        camera.DeepCopy(view)
    elif own is None:
        camera = camera_on(mesh)
    else:
        camera = _camera_of(own, mesh)
    return camera, scene.replace(view=View.from_camera(camera) if own is None else own)


def _camera_of(view: View, mesh: pv.DataSet | pv.MultiBlock) -> pv.Camera:
    """Return a camera at the eye of a view."""
    if view.position is None or view.parallel:
        assert view.direction is not None
        return camera_on(mesh, view.direction, up=view.axes()[1].tolist(), parallel=view.parallel)
    position = np.array(view.position)
    if view.direction is None:
        toward = position - np.array(camera_on(mesh).focal_point)
    else:
        toward = np.array(view.direction)
    eye = View(direction=toward, up=view.up)
    camera = camera_on((-1, 1, -1, 1, -1, 1), toward, up=eye.axes()[1].tolist())
    camera.position = tuple(position)
    camera.focal_point = tuple(position - toward)
    camera.view_angle = VIEW_ANGLE
    return camera


def places_of(
    parts: list[Part],
    camera: pv.Camera,
    scene: Scene,
    most: int,
    random: np.random.Generator,
) -> tuple[list[tuple[Sample, Part]], int, bool]:
    """Return places of the picture with what is there, the number of pixels, and whether drawn."""
    try:
        backend = choose_backend()
    except BackendError:
        found = _facing(parts, camera, scene, most, random)
        total = sum(len(one) for one, _ in found)
        drawn = False
    else:
        pixels = visible([part.drawn for part in parts], camera, backend)
        total, drawn = len(pixels.part), True
        chosen = np.sort(random.permutation(total)[:most])
        found = []
        for number, part in enumerate(parts):
            own = chosen[pixels.part[chosen] == number]
            if len(own):
                corners = part.cells[pixels.cell[own]]
                found.append((sample(part, corners, pixels.at[own], camera, scene), part))
    if not total:
        remedy = "pass view= with a direction, or a camera that looks at the mesh"
        raise ValueError(_check.message("mesh", "a point that the eye sees", "none", remedy))
    return found, total, drawn


def _facing(
    parts: list[Part], camera: pv.Camera, scene: Scene, most: int, random: np.random.Generator
) -> list[tuple[Sample, Part]]:
    """Return random points that face the eye, each as likely as its surface is large in a picture.

    Points that are even on a surface are then as in a picture without what hides them.
    """
    total = sum(part.inputs.count for part in parts)
    found = []
    for part in parts:
        count = part.inputs.count
        # On a ball half of the points face the eye, and are half as large in the picture.
        chosen = random.permutation(count)[: max(1, round(4 * most * count / total))]
        ids: Indices = np.sort(chosen)
        ids = ids[np.isfinite(rows_of(part.inputs.points, ids)).all(axis=1)]
        own = sample(part, ids[:, np.newaxis], np.zeros((len(ids), 2)), camera, scene)
        if own.normals is not None:
            toward = np.einsum("ij,ij->i", own.normals, own.eye)
            own = own.take(toward > random.uniform(0.0, 1.0, len(own)))
        if len(own):
            found.append((own, part))
    keep = min(1.0, most / max(1, sum(len(one) for one, _ in found)))
    few = [random.permutation(len(one))[: max(1, round(keep * len(one)))] for one, _ in found]
    return [(one.take(np.sort(ids)), part) for ids, (one, part) in zip(few, found, strict=True)]
