"""``vizlight streamlines``, ``relief``, ``fur``, ``contours`` and ``project``."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - cyclopts reads the annotations
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from vizlight.cli import scenes
from vizlight.cli.arguments import GROUPS, Color, Common, Flag, Part, Shape
from vizlight.cli.job import Job, carry_out
from vizlight.cli.options import keywords, takes
from vizlight.cli.script import Step

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyvista as pv

    from vizlight._types import Keywords
    from vizlight.scene import Light


@takes("streamlines", "Streamlines", example="flow.vtu --vectors V --model cylinder --diffuse 0.8")
def streamlines(
    files: list[Path], /, *, part: Part, how: object, common: Common, color: Color
) -> int:
    """Trace streamlines of a vector field, free or on a surface, and light them.

    With --contour the isosurface conditions the light of the lines, and --confined keeps them
    on it.

    Parameters
    ----------
    files
        Mesh with vectors; of several each is lit by itself.
    """
    look = scenes.Look(common, part, color)
    given = keywords(how)
    if given.get("line_field") and "," in given.get("vectors", ""):
        given["vectors"] = tuple(given["vectors"].split(","))

    def job(path: Path, time: float | str | None) -> Job:
        mesh = scenes.joined(scenes.data(path, part, time), given.get("vectors"))
        scenes.check_flow(path, mesh.run(), given.get("vectors"))
        # The lines that are traced are the tangents that light for a question needs.
        scenes.check_answers(common.lights.question, mesh, color, "lines")
        if color.scalars in mesh.run().cell_data and color.scalars not in mesh.run().point_data:
            # Lines have the arrays of points alone.
            mesh = Step("averaged", ".cell_data_to_point_data", mesh)
        on = {} if part.contour is None else {"surface": scenes.surface(mesh, part)}
        camera = look.camera(on.get("surface", mesh) if given.get("confined") else mesh)
        lit = look.step("lit", "streamlines", mesh, look.scene(camera), **given, **on)
        made = Job(lit, look, camera)
        made.tint(mesh, color)
        return made

    return carry_out(files, job, common.out, "streamlines", part)


# Heights are exaggerated, and lit, as they are shown.
@takes(
    "relief_shadow",
    "Relief",
    example="terrain.dem --depth 60 --light 315,20",
    without=("exaggeration", "lit"),
)
def relief(
    files: list[Path],
    /,
    *,
    shape: Shape,
    how: object,
    lit: Annotated[bool, Parameter(group=GROUPS["Output"])] = True,
    common: Common,
    sky: Annotated[Flag, Parameter(group=GROUPS["Light"])] = False,
) -> int:
    """Cast shadows on a height field or a closed surface: the cos-theta shadow t.

    Parameters
    ----------
    files
        Height field, or closed surface; of several each is lit by itself.
    lit
        Show the light with its shadow; otherwise the shadow t alone.
    sky
        Take the ambient light from an even sky.
    """
    # The shadow is cast by one light.
    look = scenes.Look(common, shape, raised=True, fill=False)
    # A shadow alone answers no question.
    given: Keywords = {"lit": lit or common.lights.question is not None}
    given |= keywords(how)
    given |= {"lit": True, "occlusion": "sky"} if sky else {}

    def job(path: Path, time: float | str | None) -> Job:
        mesh = scenes.data(path, shape, time)
        field, on, raised = _is_field(mesh, shape), dict[str, object](), None
        if field:
            raised = _raised(mesh, given.get("elevation"), shape.exaggeration)
        else:
            mesh = scenes.surface(mesh, shape)
            scenes.check_target(shape)
            if "raster" not in given:
                on["feature_angle"] = "auto"
        if raised is not None and raised.arguments[2] != 1:
            on["exaggeration"] = raised.arguments[2]
        camera = look.camera(raised or mesh, is_map=field)
        scene = look.scene(camera)
        shaded = look.step("shaded", "relief_shadow", mesh, scene, **(on | given))
        made = _shared(shaded, look, camera, mesh, raised, field=field)
        made.suffix = made.suffix or ".vtp"
        if given["lit"]:
            made.scalars = "rgb" if look.colored else "luminance"
        elif field and (white := 3 * _level_light(scene.run().lights)) < 1:
            made.clim = (0.0, round(white, 3))
            text = (
                f"note     white in the picture is t = {white:.2f}, 3 times the t of level ground"
            )
            made.tell.append(lambda _: text)
        return made

    return carry_out(files, job, common.out, "relief", shape)


@takes("sky", "Sky", example="terrain.dem --error 0.01 -o sky.png", up="sky_up")
def sky(files: list[Path], /, *, shape: Shape, how: object, common: Common) -> int:
    """Find the share of a uniform sky that each point sees.

    Parameters
    ----------
    files
        Height field, surface or lines; of several each is taken by itself.
    """
    look = scenes.Look(common, shape)
    given = keywords(how)

    def job(path: Path, time: float | str | None) -> Job:
        mesh = scenes.data(path, shape, time)
        field = _is_field(mesh, shape)
        if shape.contour is not None or shape.slice is not None:
            mesh = scenes.surface(mesh, shape)
        # The sky belongs to the heights as they are.
        raised = _raised(mesh, None, 1.0) if field else None
        camera = look.camera(raised or mesh, is_map=field)
        lit = look.step("skylit", "sky", mesh, **given)
        return _shared(lit, look, camera, mesh, raised, field=field)

    return carry_out(files, job, common.out, "sky", shape)


def _raised(mesh: Step, elevation: str | None, factor: float | None) -> Step | None:
    """Return the step that raises a flat grid by its heights in a picture, if it has some."""
    from vizlight.mesh.height_grids import heights_name

    field = mesh.run()
    name = elevation or heights_name(field)
    if name not in field.point_data or field.bounds.z_min != field.bounds.z_max:
        return None
    return scenes.warped("raised", mesh, str(name), factor)


def _shared(
    lit: Step, look: scenes.Look, camera: Step, mesh: Step, raised: Step | None, *, field: bool
) -> Job:
    """Return the job of a share of light at the points of a mesh, of a map as it was raised."""
    from vizlight import files

    made = Job(lit, look, camera, kind=mesh)
    made.scalars = made.name
    made.suffix = files.FORMATS[type(mesh.run()).__name__][0] if field else ""
    if raised is not None:
        made.shown = Step("shown", raised.path, lit, *raised.arguments[1:])
        made.shown.note = raised.note
    return made


def _level_light(lights: Sequence[Light]) -> float:
    """Return the sine of the altitude of the highest light at infinity; 1 without one above."""
    import numpy as np

    fixed = [light for light in lights if not light.follows_view]
    ways = [np.asarray(light.direction) for light in fixed if light.direction is not None]
    sines = [float(way[2] / np.linalg.norm(way)) for way in ways]
    return max((sine for sine in sines if sine > 0), default=1.0)


@takes("fur", "Fur", example="bunny.ply --absorption 0.7 --fibres 200000")
def fur(files: list[Path], /, *, shape: Shape, how: object, common: Common) -> int:
    """Cover a surface with fibres, and light them and the skin below.

    Parameters
    ----------
    files
        Surface, or a mesh with one; of several each is lit by itself.
    """
    from vizlight.filters.fur import MATERIAL

    names = ("ambient", "diffuse", "specular")
    look = scenes.Look(common, shape, material={name: getattr(MATERIAL, name) for name in names})
    given: Keywords = {"feature_angle": "auto"}
    given |= keywords(how)

    def job(path: Path, time: float | str | None) -> Job:
        mesh = scenes.surface(scenes.data(path, shape, time), shape)
        camera = look.camera(_tips(mesh, given.get("length")))
        lit = look.step("furry", "fur", mesh, look.scene(camera), **given)
        return Job(lit, look, camera, parts=("fibres", "skin"))

    return carry_out(files, job, common.out, "fur", shape)


# The tolerance is for solids, which no file holds.
@takes(
    "isoluminance", "Contours", example="part.stl --levels 8 --specular 0", without=("tolerance",)
)
def contours(files: list[Path], /, *, shape: Shape, how: object, common: Common) -> int:
    """Find the contours of equal luminance of a surface, and the bands between them.

    Parameters
    ----------
    files
        Surface, or a mesh with one; of several each is lit by itself.
    """
    look = scenes.Look(common, shape)
    # In a picture a crease is seen as one.
    given: Keywords = {"feature_angle": "auto"}
    given |= keywords(how)

    def job(path: Path, time: float | str | None) -> Job:
        mesh = scenes.surface(scenes.data(path, shape, time), shape)
        camera = look.camera(mesh)
        lit = look.step("found", "isoluminance", mesh, look.scene(camera), **given)
        bands = Step("", "[]", lit, "bands")
        return Job(lit, look, camera, shown=bands, parts=("bands", "contours"))

    return carry_out(files, job, common.out, "contours", shape)


@takes("project", "Projection", example="torus.vtp --rotation xw:0.5 --distance 3", light="when")
def project(files: list[Path], /, *, how: object, common: Common) -> int:
    """Turn, cut and project a mesh of n-space to 3-space, lit before or after.

    Lights and eye have 3 numbers, or n before the projection; what they lack is 0. The light is
    computed for an eye at infinity.

    Parameters
    ----------
    files
        Mesh with positions and tangents in n-space; of several each is lit by itself.
    """
    from vizlight.mesh.nspace import POSITION

    look = scenes.Look(common)
    given = keywords(how)

    def job(path: Path, time: float | str | None) -> Job:
        mesh = scenes.data(path, Part(), time)
        found = mesh.run()
        rows = found.point_data.get(given.get("positions", POSITION))
        n = 3 if given.get("light") == "after" or rows is None or rows.ndim == 1 else rows.shape[1]
        lit = look.step("projected", "project", mesh, **given, scene=look.scene_in(n))
        return Job(lit, look, look.camera(lit), kind=None, suffix=".vtk")

    return carry_out(files, job, common.out, "projected", Part())


def _tips(mesh: Step, length: float | str | None) -> Step:
    """Return the step that moves the points of a surface to where straight fur ends."""
    from vizlight.filters.fur import LENGTH
    from vizlight.mesh import blocks

    found: pv.PolyData = blocks.surface(mesh.run(), "mesh")
    length = LENGTH * found.length if length is None else length
    if isinstance(length, str):
        known = length in found.point_data and found.n_points
        length = float(found.point_data[length].max()) if known else 0.0
    normals = Step("", ".compute_normals", mesh, auto_orient_normals=True, cell_normals=False)
    return Step("tips", ".warp_by_vector", normals, "Normals", factor=length)


def _is_field(mesh: Step, shape: Shape) -> bool:
    """Tell whether a mesh, of which no part is taken, is a grid of one layer."""
    sizes: tuple[int, ...] = getattr(mesh.run(), "dimensions", ())
    whole = shape.contour is None and shape.slice is None
    return whole and sum(size > 1 for size in sizes) == 2
