"""The data of the peers' pictures, and their cameras, lights and backgrounds."""

from __future__ import annotations

import json

import numpy as np
import pyvista as pv

import vizlight
from vizlight import render

#: Width and height of a picture in pixels; each is drawn at twice the size.
SIZES = {
    "lines": (480, 600), "near": (450, 450), "surface": (560, 448), "terrain": (390, 520),
}  # fmt: skip
BLACK = ("lines", "near")


def circle(count, radius, height):
    """Return points on a circle around the axis of the disk."""
    turn = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), 0 * turn + height], axis=1)


def prepare(folder, share=1.0):
    """Write the meshes and ``cameras.json``; a ``share`` of the lines below 1 is for tests."""
    flow = vizlight.load_example()
    seeds = [circle(round(60 * share), 2.75, 3.4), circle(round(90 * share), 2.2, 9.5)]
    lines = flow.streamlines_from_source(
        pv.PolyData(np.concatenate(seeds)), vectors="V", max_length=90, max_step_length=0.25
    )
    kept = {name: np.array(lines[name]) for name in ("Temp", "V")}
    lines.clear_data()
    lines.point_data.update(kept)
    lines.save(folder / "lines.vtp")

    surface = flow.contour([600], scalars="Temp")
    if share < 1:
        surface = surface.clip("-x").clip("-y").triangulate()
    surface = surface.compute_normals(cell_normals=False, auto_orient_normals=True)
    # Split each triangle into 16: a highlight is narrower than the triangles of the simulation.
    surface = surface.subdivide(2 if share == 1 else 1, "linear")
    surface["speed"] = np.linalg.norm(surface["V"], axis=1)
    surface.save(folder / "surface.vtp")
    flow.save(folder / "flow.vtu")

    if share == 1:
        terrain = pv.examples.download_st_helens()
        columns, rows = terrain.dimensions[:2]
        # The border has no heights.
        terrain = terrain.extract_subset((12, columns - 13, 12, rows - 13, 0, 0))
        heights = np.array(terrain["Elevation"], dtype=np.float32)
    else:
        part = vizlight.load_example("earth_relief.vti").extract_subset((750, 800, 340, 390, 0, 0))
        terrain = pv.ImageData(dimensions=part.dimensions, spacing=(321, 371, 1))
        heights = np.array(part["elevation"], dtype=np.float32)
    terrain.clear_data()
    terrain["height"] = heights
    terrain.origin = (0, 0, 0)
    terrain.save(folder / "terrain.vti")

    raised = terrain.cast_to_structured_grid().warp_by_scalar("height")
    box = (-4.6, 4.6, -4.6, 4.6, -9.5, 8.5)
    # The same lines from near: the upper rim of the ring.
    near = render.camera_on((-1.4, 2.2, -1.2, 1.2, 4.2, 6.2), (1, 0.5, 0.42), aspect=1)
    cameras = {
        "near": near,
        "lines": render.camera_on(box, (1, 0.5, 0.42), aspect=0.8, zoom=1.28),
        "surface": render.camera_on(surface, (1, 0.5, 0.45), aspect=1.25, zoom=1.0),
        "terrain": render.camera_on(raised, (0, 0, 1), aspect=0.75, parallel=True, zoom=1.0),
    }
    (folder / "cameras.json").write_text(json.dumps({
        name: {
            "position": list(camera.position), "focal": list(camera.focal_point),
            "up": list(camera.up), "angle": camera.view_angle,
            "scale": camera.parallel_scale if camera.parallel_projection else 0,
            "size": SIZES[name], "background": [0.0] * 3 if name in BLACK else [1.0] * 3,
        }
        for name, camera in cameras.items()
    }))  # fmt: skip
