"""Places of a picture with the data there, and the light of what they might be."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vizlight.model.frames import orthonormalize
from vizlight.model.kernels import unit_rows
from vizlight.observers.parts import rows_of
from vizlight.observers.visible import rays, weights
from vizlight.shading import engine
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import ShadingOptions
from vizlight.verify.between import Places, interpolated, mean_spaces

if TYPE_CHECKING:
    import pyvista as pv

    from vizlight._types import Array, Bools, Indices
    from vizlight.observers.parts import Kind, Part, Shares
    from vizlight.scene import Scene


@dataclass(frozen=True, kw_only=True)
class Sample:
    """Some places of a picture on one mesh: where they are, and what is there.

    Attributes
    ----------
    kind : {"surface", "line", "point"}
        What is seen.
    points : ndarray, shape (M, 3)
        Places.
    eye, right, up : ndarray, shape (M, 3)
        Unit directions toward the eye, to the right and up in the picture.
    tangents : ndarray, shape (M, k, 3), or None
        Orthonormal tangents.
    normals : ndarray, shape (M, 3), or None
        Unit normals as they are lit.
    values : ndarray, shape (M,), or None
        Values that colours show.
    valid : ndarray of bool, shape (M,)
        Whether tangents and normals have a direction.
    scene : Scene
        Scene with a view, and with both ends of its depth cue.
    options : ShadingOptions
        How light is computed.
    shares : Shares
        Shares of the light that reach the places.
    """

    kind: Kind
    points: Array
    eye: Array
    right: Array
    up: Array
    tangents: Array | None
    normals: Array | None
    values: Array | None
    valid: Bools
    scene: Scene
    options: ShadingOptions
    shares: Shares

    def __len__(self) -> int:
        return len(self.points)

    def take(self, rows: Indices | slice | Bools) -> Sample:
        """Return some of the places."""
        own = {
            field.name: getattr(self, field.name)[rows]
            for field in dataclasses.fields(self)
            if isinstance(getattr(self, field.name), np.ndarray)
        }
        shares = self.shares.each(lambda array: array[rows])
        return dataclasses.replace(self, **own, shares=shares)

    @property
    def local(self) -> bool:
        """Whether light depends on the place, beside tangents and normals."""
        scene = self.scene
        assert scene.view is not None
        near = not scene.view.parallel or any(x.position is not None for x in scene.lights)
        return near or scene.depth_cue is not None or any(x is not None for x in self.shares)

    def given(
        self, tangents: Array | None, normals: Array | None, repeat: int = 1
    ) -> ShadingInputs:
        """Return inputs of the engine of other tangents and normals, ``repeat`` at each place."""
        lit = self.options.conditioned is True or tangents is None
        shares = self.shares.each(lambda rows: np.repeat(rows, repeat, axis=0))
        return ShadingInputs(
            points=np.repeat(self.points, repeat, axis=0),
            tangents=tangents,
            normals=normals if lit else None,
            transmittance=shares.transmittance,
            occlusion=shares.occlusion,
        )

    def light(self, tangents: Array | None, normals: Array | None, repeat: int = 1) -> Array:
        """Return the light of other tangents and normals at the places, shape (M repeat, 3)."""
        with engine.observed(None):
            found = engine.run(self.given(tangents, normals, repeat), self.scene, self.options)
        if found.rgb is not None:
            return np.asarray(found.rgb, np.float64)
        return np.repeat(found.luminance[:, np.newaxis].astype(np.float64), 3, axis=1)

    def own_light(self) -> Array:
        """Return the light of the places themselves, shape (M, 3)."""
        return self.light(self.tangents, self.normals)


def sample(part: Part, cells: Indices, at: Array, camera: pv.Camera, scene: Scene) -> Sample:
    """Return places of a picture with the data that are interpolated there.

    Parameters
    ----------
    part : Part
        Mesh.
    cells : ndarray of int, shape (M, s)
        Corners of the cells that are seen.
    at : ndarray, shape (M, 2)
        Places in the picture, see :class:`vizlight.observers.visible.Pixels`; for single points
        as cells they have no effect.
    camera : pyvista.Camera
        Camera of the picture.
    scene : Scene
        Scene with a view.
    """
    m, s = cells.shape
    ids = cells.ravel()
    corners = rows_of(part.inputs.points, ids).astype(np.float64).reshape(m, s, 3)
    share = weights(corners, rays(camera, at))
    places = Places(np.arange(m * s).reshape(m, s), share)
    points = interpolated(corners.reshape(-1, 3), places)
    toward = _toward_eye(camera, points)
    right = unit_rows(np.cross(np.asarray(camera.GetViewUp()), toward))
    tangents = _tangents(part, ids, places)
    normals = _normals(part, ids, places, points)
    valid = np.ones(m, dtype=np.bool_)
    for vectors in (normals, *(() if tangents is None else np.moveaxis(tangents, 1, 0))):
        if vectors is not None:
            valid &= np.einsum("ij,ij->i", vectors, vectors) > 0.5
    shares = part.shares.each(
        lambda rows: np.clip(interpolated(rows[ids].astype(np.float64), places), 0.0, 1.0)
    )
    values = None
    if part.values is not None:
        values = interpolated(part.values[ids].astype(np.float64), places)
    return Sample(
        kind=part.kind, points=points, eye=toward, right=right, up=np.cross(toward, right),
        tangents=tangents, normals=normals, values=values, valid=valid, scene=scene,
        options=_shading(part), shares=shares,
    )  # fmt: skip


def _shading(part: Part) -> ShadingOptions:
    """Return the options that light a part, in float64."""
    own = {
        field.name: getattr(part.options, field.name)
        for field in dataclasses.fields(ShadingOptions)
    }
    return ShadingOptions(**own | {"precision": "float64", "components": False})


def _toward_eye(camera: pv.Camera, points: Array) -> Array:
    """Return the unit directions from points toward the eye of a camera."""
    if camera.GetParallelProjection():
        away = np.array(camera.GetDirectionOfProjection())
        return np.broadcast_to(-away, points.shape).copy()
    return unit_rows(np.array(camera.GetPosition()) - points)


def _tangents(part: Part, ids: Indices, places: Places) -> Array | None:
    """Return tangents interpolated as a picture has them, zero where one has no direction.

    Vectors are interpolated linearly; lines without sign, and planes, are turned alike before.
    """
    if part.inputs.tangents is None:
        return None
    rows = rows_of(part.inputs.tangents, ids).astype(np.float64)
    frames: Array = rows.reshape(len(ids), -1, 3)
    one = frames.shape[1] == 1
    frames = unit_rows(frames[:, 0])[:, np.newaxis] if one else orthonormalize(frames)[0]
    if places.weights.shape[1] > 1:
        unsigned = part.inputs.line_field or not one
        frames = (mean_spaces if unsigned else interpolated)(frames, places)
    return unit_rows(frames[:, 0])[:, np.newaxis] if one else frames


def _normals(part: Part, ids: Indices, places: Places, points: Array) -> Array | None:
    """Return interpolated normals, turned to the side that is lit; zero without a direction."""
    sides = part.inputs.sides
    if sides is None or part.inputs.normals is None:
        return None
    own = sides()
    normals = interpolated(unit_rows(own.normals[ids]), places)
    facts = interpolated(own.facts[ids], places)
    return own.turned(unit_rows(normals), facts, points)
