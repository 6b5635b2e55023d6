"""Run one script in this process, draw what it has made, and print what that took as JSON.

Python runs it for PyVista, vizlight and matplotlib, ``pvpython`` for ParaView, which is why it
imports nothing but the standard library before it knows. ``measure.py SCRIPT SCENE PICTURE`` is
called in the folder of the data. Camera, size and background are set here, the same for all.
"""

from __future__ import annotations

import json
import math
import resource
import runpy
import sys
import time

FRAMES = 2
DEGREES = 3.0


def main(script, scene, picture):
    """Write the picture at twice its size, and print a JSON object."""
    with open("cameras.json", encoding="utf-8") as file:  # noqa: PTH123 (standard library alone)
        view = json.load(file)[scene]
    view["size"] = [2 * side for side in view["size"]]
    space = runpy.run_path(script)
    way = next(way for name, way in WAYS.items() if name in space)
    frame, count = way(space, view, picture)
    # Time and memory from the start of the process to the picture.
    row = {
        "cpu": time.process_time(),
        "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }
    start = time.process_time()
    if frame is not None:
        for _ in range(FRAMES):
            frame()
        row["frame"] = (time.process_time() - start) / FRAMES
    points, pieces = count()
    print(json.dumps(row | {"points": points, "pieces": pieces}), file=sys.stderr)


def of_pyvista(space, view, picture):
    """Draw a plotter of PyVista."""
    plotter = space["plotter"]
    plotter.window_size, plotter.background_color = view["size"], view["background"]
    plotter.render_window.SetMultiSamples(0)
    camera = plotter.camera
    camera.position, camera.focal_point, camera.up = view["position"], view["focal"], view["up"]
    camera.view_angle = view["angle"]
    if view["scale"]:
        camera.parallel_projection, camera.parallel_scale = True, view["scale"]
    plotter.renderer.ResetCameraClippingRange()
    plotter.screenshot(picture)

    def frame():
        camera.azimuth += DEGREES
        plotter.render()

    def count():
        actors = [actor for actor in plotter.actors.values() if hasattr(actor, "mapper")]
        return total(actor.mapper.GetInputDataObject(0, 0) for actor in actors)

    return frame, count


def of_paraview(space, view, picture):
    """Draw a view of ParaView."""
    own = space["view"]
    own.ViewSize, own.OrientationAxesVisibility = view["size"], 0
    own.UseColorPaletteForBackground, own.Background = 0, view["background"]
    own.UseFXAA = own.MultiSamples = 0
    own.CameraPosition, own.CameraFocalPoint = view["position"], view["focal"]
    own.CameraViewUp, own.CameraViewAngle = view["up"], view["angle"]
    if view["scale"]:
        own.CameraParallelProjection, own.CameraParallelScale = 1, view["scale"]
    simple = space["simple"]
    simple.SaveScreenshot(picture, own, ImageResolution=view["size"])

    def frame():
        simple.GetActiveCamera().Azimuth(DEGREES)
        simple.Render(own)

    def count():
        shown = [each for each in own.Representations if each.Visibility]
        return total(simple.servermanager.Fetch(each.Input) for each in shown)

    return frame, count


def of_matplotlib(space, view, picture):
    """Draw a figure of matplotlib, which shows a map, in the frame of the camera."""
    figure = space["figure"]
    width, height = view["size"]
    figure.set_size_inches(width / 100, height / 100)
    figure.subplots_adjust(0, 0, 1, 1)
    axes, (x, y) = figure.axes[0], view["focal"][:2]
    half = view["scale"]
    axes.set_axis_off()
    axes.set_xlim(x - half * width / height, x + half * width / height)
    axes.set_ylim(y - half, y + half)
    figure.savefig(picture, dpi=100, facecolor=view["background"])
    return None, lambda: (math.prod(axes.images[0].get_array().shape[:2]), 0)


def total(meshes):
    """Return the points, and the triangles and segments, of VTK's data sets together."""
    points = pieces = 0
    for mesh in meshes:
        points += mesh.GetNumberOfPoints()
        if mesh.IsA("vtkPolyData"):
            for cells, corners in (
                (mesh.GetLines(), 1), (mesh.GetPolys(), 2), (mesh.GetStrips(), 2),
            ):  # fmt: skip
                pieces += cells.GetNumberOfConnectivityIds() - corners * cells.GetNumberOfCells()
        else:
            pieces += mesh.GetNumberOfCells()
    return points, pieces


#: Variable by which a script names what it has made.
WAYS = {"plotter": of_pyvista, "view": of_paraview, "figure": of_matplotlib}

if __name__ == "__main__":
    main(*sys.argv[1:])
