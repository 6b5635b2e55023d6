"""Recipes of the values in a volume: the isosurface that stands out, a cut body, or slices."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyvista as pv
from matplotlib.colors import to_hex

from vizlight.draw.margins import parted
from vizlight.filters.tint import color_table
from vizlight.looks import levels
from vizlight.looks.contents import Contents
from vizlight.looks.framing import ISOMETRIC, Viewpoint, eye_around
from vizlight.looks.recipes import fields, lines, surfaces
from vizlight.looks.recipes.drawing import ON_SURFACES, Doubt, Drawing, Layer, range_of
from vizlight.looks.steps import Step
from vizlight.mesh import meaning, montages
from vizlight.reading import density_maps, molecules
from vizlight.vtk.cells import dimensions
from vizlight.vtk.normals import piece_numbers

if TYPE_CHECKING:
    from vizlight._types import Array, Foreign, Keywords
    from vizlight.looks.contents import Named
    from vizlight.looks.recipes.drawing import Case

#: Least share of the side of its box that an isosurface has where the box is drawn.
LEAST_OF_BOX = 0.4
#: Fewest voxels along each side of a scan, and the most of its sides that it closes.
VOXELS, MOST_CLOSED = 30, 0.4
#: Number of bone in computed tomography, in Hounsfield units; least share of air, and shares of
#: bone, of such a scan.
BONE, MUCH_AIR, BONES = 300.0, 0.05, (0.002, 0.3)
#: Least share of its box that what is above the lowest value of a scan fills where it is cut open,
#: and the points along each axis by which that is found.
COMPACT, STEPS = 0.25, 50
#: Share of the values of a scan above a level from which it encloses those below it.
MOSTLY = 0.75
#: Share of the values above a level up to which they are on its isosurface.
ON_LEVEL = 1e-3
#: Colour of the skin.
SKIN = "#d9cabd"
#: Direction toward the eye that sees a face, in the axes of a body.
FACE = (0.5, 0.75, 0.45)
#: Largest share of the ends of values within which their quartiles lie where 0 is their ground, and
#: least ratio of the numbers of values beyond a level below and above it.
GROUND, LESSER_SIDE = 0.15, 0.1
#: Share of the squares of an orbital that is within its isosurface.
ENCLOSED = 0.85
#: Colours of a level below and above 0.
LOBES = ["#4169cf", "#d63a3a"]
#: Level of maps of densities above their mean, in their standard deviations, where nothing is
#: steeper: crystallographers take 1 to 3. Level of both signs of maps of differences of densities;
#: most of their mean, in their deviation, and least ratio of the sizes of their ends.
SIGMAS = 2.0
SIGMAS_OF_DIFFERENCES, MEAN_OF_DIFFERENCES, ENDS_OF_DIFFERENCES = 3.0, 0.1, 0.5
#: Deviation of the filter that smooths scans, in voxels, and the note on it.
SMOOTH = 0.7
SMOOTHED = f"the values are smoothed by {SMOOTH:g} voxels"
#: Share of the points of the largest piece of a scan below which others are debris.
DEBRIS = 0.003
#: Percentiles of the values on the faces of a cut, and least share of those of the volume through
#: which they run where they are worth a cut.
MOST_OF_CUT, LEAST_OF_CUT = (10, 90), 0.1
#: Drawing of an isosurface around a molecule, whose far side would hide it too, and normals that
#: point out of it.
CLEAR = {"opacity": 0.5, "culling": "back"}
OUTWARD = {"auto_orient_normals": True, "split_vertices": False, "cell_normals": False}
#: Shares of the voxels of a masked scan that are 0, least share of the outline of all others that
#: is that of the body, deviation of the filter that smooths it, in voxels, its level, so that it is
#: around what is in it, voxels around the scan, and its drawing.
OUTSIDE, MOST_OF_BODY, OUTLINE, EDGE, MARGIN = (0.2, 0.9), 0.7, 2.0, 0.25, 4
GLASS = {"color": "#9aa1ad", "opacity": 0.2, "culling": "back", "pickable": False}
#: Most pieces of an isosurface, where none has this share of it; share of one that is sure.
MOST_PIECES, LARGE, DUST = 50, 0.3, 0.01
#: Radians in a pixel from which the normals of an isosurface may turn too fast, and how they are
#: computed for that.
ROUGH = 0.1
PLAIN_NORMALS = {"cell_normals": False, "split_vertices": False, "consistent_normals": False}


class _Level(NamedTuple):
    """Level of an isosurface, or one on each side of 0, and the volume in which it is drawn.

    One that ``is_sure`` is drawn even where slices would be read better.
    """

    at: float | tuple[float, float]
    volume: Step
    notes: list[str]
    boxed: bool
    is_sure: bool


def isosurface(case: Case) -> Drawing:
    """Draw the isosurface through the steepest places, or slices where none is good.

    Where the values that it encloses differ, the isosurface is cut open to them.

    The skin of a scan of a body tells least of it: bones are shown where their numbers are known,
    else the body is cut open.
    """
    array = case.needed_array
    is_slab = case.is_of_body and not array.of_cells and _is_slab(case.data.run())
    if case.wishes.question == "auto" and (is_slab or _is_stack(case, array)):
        # A sheet of slices has no place among other meshes.
        return stack(case) if case.wishes.frame is None else slices(case)
    # Where values are shown there is room for their key.
    valued = replace(case, question="value")
    level = _level(case, array)
    if isinstance(level, str):
        return _cut_open(valued) or slices(valued, level)
    if not level.is_sure and case.is_of_body and _are_low_inside(case, array, level.at):
        return slices(valued, "; the isosurface would enclose the lowest values")
    part = dict(case.wishes.part) | {"contour": array.name, "level": level.at}
    whole = replace(case, wishes=replace(case.wishes, part=part))
    mesh = whole.wishes.isosurface(level.volume)
    has_molecule = molecules.PLACES in case.data.run().field_data
    if has_molecule:
        mesh = Step("outward", ".compute_normals", mesh, **OUTWARD)
    is_one = case.wishes.question == "auto" and not isinstance(level.at, tuple)
    if is_one and _is_crumbs(mesh.run(), DUST if level.is_sure else LARGE):
        return _cut_open(valued) or slices(valued, "; isosurfaces are crumbs")
    # One that is asked for besides is shown on it.
    second = case.second
    is_free = not level.is_sure and not has_molecule and not isinstance(level.at, tuple)
    if second is None and is_free and not _is_of_scanner(case, array):
        opened = _opened(valued, level)
        if opened is not None:
            return replace(opened, notes=[*opened.notes, *level.notes])
    if not level.is_sure and _is_scan(case, array):
        mesh = _without_debris(mesh, level.notes)
    surface, box = _framed(whole, mesh, boxed=level.boxed)
    body = _body_around(case, array)
    if box is None and case.wishes.frame is None and (body is not None or has_molecule):
        frame = _camera_around(case, mesh, body)
        surface = replace(surface, wishes=replace(surface.wishes, frame=frame))
    if isinstance(level.at, tuple):
        peaks = None if body is None else range_of(case.data.run(), array.name)
        drawing = _of_both_signs(surface, array, level.at, peaks)
    elif second is not None:
        drawing = surfaces.values(replace(surface, question="value", array=second))
    else:
        drawing = surfaces.surface(replace(surface, question="shape"))
    if has_molecule:
        drawing = _around_molecule(case, drawing)
    if not level.is_sure and _is_rough(surface, mesh, drawing.camera):
        figure = "value" if second is not None else "shape"
        drawing = replace(drawing, doubt=Doubt((figure,), lambda: slices(valued)))
    words = f"{array.name} = {_written(level.at)}"
    words += "" if second is None else f" in the colours of {second.name}"
    around = [] if box is None else whole.boxed(box, drawing.camera)
    around += [] if body is None else [Layer(body, {"scene": drawing.scene, **GLASS})]
    return replace(
        drawing,
        words=f"isosurface {words}",
        notes=[*drawing.notes, *level.notes],
        layers=[*drawing.layers, *around],
    )


def _written(level: float | tuple[float, float]) -> str:
    return f"±{levels.number(level[1])}" if isinstance(level, tuple) else levels.number(level)


def _level(case: Case, array: Named) -> _Level | str:
    """Return the level of the isosurface of an array, or why slices are drawn in its place."""
    is_auto, is_scan = case.wishes.question == "auto", _is_scan(case, array)
    values, notes = surfaces.sample(case, array), [SMOOTHED] * is_scan
    volume = case.data
    if is_scan:
        # The edge of a mask would be a staircase of voxels.
        scan = Step("scan", ".copy", volume, deep=False)
        # Without active scalars VTK's filter ends the process.
        scan.attributes = {"active_scalars_name": array.name}
        volume = Step("smooth", ".gaussian_smooth", scan, std_dev=SMOOTH, scalars=array.name)
    if (level := case.wishes.part.get("level")) is not None:
        return _Level(level, volume, notes, not is_scan, is_sure=not is_auto)
    if is_auto and (size := _size_of_both_signs(values, volume, array)) is not None:
        if is_scan:
            volume = Step("closed", ".pad_image", volume, pad_value=0.0, scalars=array.name)
        return _Level((-size, size), volume, notes, not is_scan, is_sure=True)
    # What stands out, such as a particle, is as that of a scan; that of a crystal is at its place.
    is_density = _is_density(case, array)
    if is_density and _are_differences(values):
        size = float(f"{SIGMAS_OF_DIFFERENCES * values.std():.2g}")
        notes = [f"the levels are {SIGMAS_OF_DIFFERENCES:g} standard deviations from 0"]
        return _Level((-size, size), case.data, notes, boxed=True, is_sure=True)
    if is_density and levels.best_level(case.data.run(), array.name)[1] < levels.GOOD:
        level = float(f"{values.mean() + SIGMAS * values.std():.2g}")
        is_image = isinstance(case.data.run(), pv.ImageData)
        volume = _closed(case.data, array.name, level) if is_image else case.data
        notes = [f"the level is {SIGMAS:g} standard deviations above the mean"]
        return _Level(level, volume, notes, boxed=True, is_sure=True)
    if is_scan and _has_bones(values):
        level, contrast = BONE, levels.GOOD
        notes.append("bone, by the numbers of computed tomography, in which air is -1000")
    elif is_scan and is_auto and surfaces.is_gray(case, array) and _is_compact(case, array):
        return ""
    else:
        share = levels.THIN if is_scan else 1.0
        level, contrast = levels.best_level(volume.run(), array.name, share=share)
    if contrast < levels.GOOD:
        return f"; no isosurface stands out (the steepest is {contrast:.1f} times the mean)"
    volume = _closed(volume, array.name, level) if is_scan else volume
    return _Level(level, volume, notes, boxed=not is_scan, is_sure=not is_auto)


def _body_around(case: Case, array: Named) -> Step | None:
    """Return the step that makes the body in a masked map of both signs, None without one.

    It is around the largest piece of what is not 0, which is most of that.
    """
    rows = np.asarray(case.data.run()[array.name])
    is_signed = bool(rows.min() < 0 < rows.max())
    if not is_signed or case.wishes.question != "auto" or not _is_scan(case, array):
        return None
    if not OUTSIDE[0] < np.mean(rows == 0) < OUTSIDE[1]:
        return None
    scan = Step("scan", ".copy", case.data, deep=False)
    scan.attributes = {"active_scalars_name": array.name}
    mask = Step(
        "mask", ".image_threshold", scan, [0.0, 0.0], in_value=0.0, out_value=1.0,
        scalars=array.name,
    )  # fmt: skip
    mask = Step("mask", ".pad_image", mask, pad_value=0.0, pad_size=MARGIN, scalars=array.name)
    smooth = Step("", ".gaussian_smooth", mask, std_dev=OUTLINE, scalars=array.name)
    every = Step("outlines", ".contour", smooth, [EDGE], scalars=array.name)
    sizes = np.bincount(piece_numbers(every.run())) if every.run().n_cells else np.zeros(1)
    if sizes.max() <= MOST_OF_BODY * sizes.sum():
        return None
    return Step("body", ".connectivity", every, "largest")


def _are_low_inside(case: Case, array: Named, level: float | tuple[float, float]) -> bool:
    """Return whether an isosurface encloses the lesser part of a scan, of low values.

    What it would show of a body is a gap, unless the others are one value, as of statistics.
    """
    values = surfaces.sample(case, array)
    is_gap = np.mean(values > level) > MOSTLY > np.mean(values == values.max())
    return not isinstance(level, tuple) and bool(is_gap)


def _size_of_both_signs(values: Array, volume: Step, array: Named) -> float | None:
    """Return the size of a level of both signs.

    None where 0 is not the ground of values of both signs, as it is of orbitals and statistics.
    """
    if array.of_cells or not values.size or not values.min() < 0 < values.max():
        return None
    if np.abs(np.percentile(values, (25, 75))).max() > GROUND * np.abs(values).max():
        return None
    sizes = volume.run().copy(deep=False)
    rows = np.asarray(sizes[array.name], dtype=np.float64)
    sizes.point_data[array.name] = np.abs(rows)
    level, contrast = levels.best_level(sizes, array.name)
    if molecules.PLACES in sizes.field_data:
        # As chemists print orbitals.
        squares = np.sort(rows**2)[::-1]
        count = np.searchsorted(np.cumsum(squares), ENCLOSED * squares.sum())
        level = float(f"{np.sqrt(squares[count]):.2g}")
    lesser, larger = sorted((np.sum(rows < -level), np.sum(rows > level)))
    return None if contrast < levels.GOOD or lesser < LESSER_SIDE * larger else level


def _of_both_signs(
    surface: Case, array: Named, ends: tuple[float, float], peaks: tuple[float, float] | None
) -> Drawing:
    """Return the drawing of the isosurfaces at a level of both signs, each in its colour."""
    cmap: Foreign = surface.wishes.colors.get("cmap", LOBES)
    # No range but theirs tells the two levels apart.
    picture = {**surface.wishes.picture, "cmap": cmap, "clim": ends}
    wishes = replace(surface.wishes, picture=picture)
    drawing = surfaces.values(replace(surface, question="value", array=array, wishes=wishes))
    title, unit = parted(str(drawing.keys[0]["title"]))
    named = {place: levels.number(end) for place, end in enumerate(ends)}
    table = color_table([], cmap=cmap, clim=ends)
    colors = {place: to_hex(table.map_value(end)) for place, end in enumerate(ends)}
    words = _written(ends)
    words += "" if peaks is None else ", peaks {:.3g} and {:.3g}".format(*peaks)
    key = drawing.keys[0] | {
        "title": f"{title}, isosurfaces at {words} {unit}".rstrip(),
        # Nothing is drawn between the levels, as a bar would say.
        "cmap": Step("", "vizlight.maps.kinds", named, colors=colors),
    }
    return replace(drawing, keys=[key])


def _around_molecule(case: Case, drawing: Drawing) -> Drawing:
    """Return the drawing of an isosurface that lets the molecule in its volume be seen."""
    atoms = Step("atoms", "files.atoms_in", case.data)
    layers = [replace(each, keywords=each.keywords | CLEAR) for each in drawing.layers]
    return lines.with_molecule(case, replace(drawing, layers=layers), atoms)


def _framed(case: Case, mesh: Step, *, boxed: bool) -> tuple[Case, Step | None]:
    """Return the case of an isosurface in a volume, and the box that tells where it is.

    There is no box where none is asked for, nor one that is much larger, which would make the
    isosurface small.
    """
    contents, wishes = Contents(mesh.run()), case.wishes
    box = Step("box", ".outline", case.data)
    around = max(contents.sides) > LEAST_OF_BOX * max(case.contents.sides)
    if around and wishes.view is None and wishes.frame is None:
        eye = eye_around(mesh.run())
        wishes = replace(
            wishes,
            frame=wishes.camera(box if boxed else mesh, eye, axes=case.axes if boxed else ()),
        )
    case = replace(case, data=mesh, contents=contents, wishes=wishes)
    return case, box if boxed and around else None


def _camera_around(case: Case, mesh: Step, body: Step | None) -> Step:
    """Return the step of the camera on an isosurface, and on the body or the atoms around it."""
    if body is not None:
        return case.wishes.camera(body, eye_around(mesh.run(), in_body=True))
    # Atoms may stand out of the isosurface.
    ball = Step("", "pyvista.Sphere", radius=1)
    atoms = Step("atoms", "files.atoms_in", case.data)
    balls = Step("", ".glyph", atoms, orient=False, scale="radius", factor=lines.BALL, geom=ball)
    both = Step("", "pyvista.MultiBlock", [mesh, balls])
    return case.wishes.camera(both, eye_around(mesh.run()))


def _closed(image: Step, name: str, level: float) -> Step:
    """Return an image with a margin below a level, in which cut-off parts are closed, no cups.

    One whose sides are mostly above it, such as of a rock with pores, would be a box: it is left.
    """
    mesh = image.run()
    values = np.asarray(mesh[name]).reshape(mesh.dimensions, order="F")
    sides = (values.take(end, axis) > level for axis in range(3) for end in (0, -1))
    if np.mean(np.concatenate([side.ravel() for side in sides])) > MOST_CLOSED:
        return image
    return Step("closed", ".pad_image", image, pad_value=float(np.nanmin(values)), scalars=name)


def _without_debris(mesh: Step, notes: list[str]) -> Step:
    """Return the step that takes the large pieces of an isosurface, and note how many others are.

    Such are specks of noise, and ends of what is too thin for the level.
    """
    if not mesh.run().n_cells:
        return mesh
    sizes = np.bincount(piece_numbers(mesh.run()))
    kept = int(np.sum(sizes >= DEBRIS * sizes.max()))
    if kept == len(sizes):
        return mesh
    notes.append(f"{len(sizes) - kept} small pieces are left out")
    # VTK numbers pieces by their sizes.
    return Step("pieces", ".connectivity", mesh, "specified", list(range(kept)))


def _is_crumbs(mesh: pv.DataSet, large: float = LARGE) -> bool:
    """Return whether an isosurface is in many pieces of which none has a large share of it."""
    if not mesh.n_cells:
        return False
    sizes = np.bincount(piece_numbers(mesh))
    return len(sizes) > MOST_PIECES and sizes.max() < large * sizes.sum()


def _is_rough(case: Case, mesh: Step, camera: Step) -> bool:
    """Return whether the normals of an isosurface may turn too fast to be seen."""
    normals = mesh.run().compute_normals(**PLAIN_NORMALS)
    return fields.turn_of(normals, "Normals") * fields.pixel_of(case, camera) > ROUGH


def slices(case: Case, why: str = "") -> Drawing:
    """Draw a volume without the corner toward the eye, in the colours of its values."""
    array = case.needed_array
    box = Step("box", ".outline", case.data)
    eye = case.eye(case.data)
    camera = case.camera(box, eye, boxed=True)
    cut, outside = _parts_of_cut(case, case.data, eye)
    drawing = _of_cut(case, cut, outside, camera, case.data)
    first, *strokes = drawing.layers
    faces = replace(case, data=outside, contents=Contents(outside.run()))
    # Of what is hollow the faces of the cut may be empty.
    both = [each for each in (first, Layer(outside, first.keywords)) if each.mesh.run().n_points]
    layers = [*both, *strokes, *case.strokes([faces.creases])]
    words = f"slices of {array.name} through the middle, around the corner toward the eye{why}"
    return replace(drawing, layers=[*layers, *case.boxed(box, camera)], words=words)


def _opened(case: Case, level: _Level) -> Drawing | None:
    """Draw an isosurface without its corner toward the eye, in the colours of the values inside.

    None where these are much the same.
    """
    array, wishes, at = case.needed_array, case.wishes, level.at
    assert not isinstance(at, tuple)
    eye = case.eye(level.volume)
    cut, outside = _parts_of_cut(case, level.volume, eye, at)
    if _is_even(cut.run(), level.volume.run(), array.name):
        return None
    sides = Contents(outside.run()).sides
    boxed = level.boxed and max(sides) > LEAST_OF_BOX * max(case.contents.sides)
    box = Step("box", ".outline", case.data)
    camera = case.camera(box if boxed else outside, eye, boxed=boxed)
    drawing = _of_cut(case, cut, outside, camera, cut)
    first, *strokes = drawing.layers
    lit = replace(case, data=outside, contents=Contents(outside.run()))
    light = wishes.light_of_surface()
    lamp = {"scene": lit.exposed(outside, camera, "lamp", **light)} | wishes.drawn(light)
    layers = [first, *_outside_of(case, outside, first.keywords | lamp, at), *strokes]
    (key,) = drawing.keys
    _, unit = parted(str(key["title"]))
    title = f"{key['title']}; surface: {levels.number(at)} {unit}".rstrip()
    return replace(
        drawing,
        layers=[*layers, *(case.boxed(box, camera) if boxed else [])],
        words=f"isosurface {array.name} = {levels.number(at)}, with the values inside",
        keys=[key | {"title": title}],
    )


def _outside_of(case: Case, outside: Step, drawn: Keywords, level: float) -> list[Layer]:
    """Return the layers of an isosurface and of the sides of its volume.

    In the grey of its level, which is nearly that of air, the shape of a scan would be black.
    """
    name = case.needed_array.name
    high = range_of(outside.run(), name)[1]
    end = level + ON_LEVEL * (range_of(case.data.run(), name)[1] - level)
    if not surfaces.is_gray(case, case.needed_array) or "cmap" in case.wishes.colors:
        return [Layer(outside, drawn)]
    names = ("scene", "pickable", *case.wishes.drawn(case.wishes.light_of_surface()))
    plain = {key: value for key, value in drawn.items() if key in names} | {"color": SKIN}
    if high <= end:
        return [Layer(outside, plain)]
    skin, sides = (
        Step(part, ".clip_scalar", outside, scalars=name, value=end, invert=part == "skin")
        for part in ("skin", "sides")
    )
    return [Layer(skin, plain), Layer(sides, drawn)]


def _parts_of_cut(
    case: Case, volume: Step, eye: Viewpoint, level: float | None = None
) -> tuple[Step, Step]:
    """Return the steps that take the faces of a cut toward an eye, and the outside around it."""
    toward = _toward(case, volume, eye)
    name = case.needed_array.name
    parts = Step("parts", "files.without_corner", volume, name, level, toward=toward)
    return Step("cut", "[]", parts, "cut"), Step("outside", "[]", parts, "outside")


def _toward(case: Case, mesh: Step, eye: Viewpoint) -> tuple[float, ...]:
    """Return the direction toward an eye on a mesh."""
    camera = case.wishes.camera(mesh, eye).run()
    way = np.subtract(camera.position, camera.focal_point) / camera.distance
    return tuple(np.round(way, 3).tolist())


def _of_cut(case: Case, cut: Step, outside: Step, camera: Step, valued: Step) -> Drawing:
    """Return the drawing of the faces of a cut, in colours for the values of a mesh."""
    array, is_gray = case.needed_array, surfaces.is_gray(case, case.needed_array)
    scene = case.wishes.scene("none", camera)
    colors, note = case.ranged_of(valued, array, "gray" if is_gray else ON_SURFACES, scan=is_gray)
    drawn = {"scene": scene, "scalars": array.name, "show_scalar_bar": False, **colors}
    faces = replace(case, data=cut, contents=Contents(cut.run()))
    layers = [Layer(cut, drawn), *case.strokes([faces.borders, faces.creases])]
    both = Step("both", ".append_polydata", cut, outside)
    lit = case.lit(both, scene, **case.wishes.light_of_surface())
    notes = [note] if note else []
    return Drawing(layers, camera, scene, lit, "", [case.bar(array, colors)], notes)


def _is_even(cut: pv.DataSet, volume: pv.DataSet, name: str) -> bool:
    """Return whether the values on the faces of a cut are much the same."""
    if not cut.n_points:
        return True
    low, high = range_of(volume, name)
    first, last = np.nanpercentile(np.asarray(cut[name], dtype=np.float64), MOST_OF_CUT)
    return bool(last - first < LEAST_OF_CUT * (high - low))


def _is_of_scanner(case: Case, array: Named) -> bool:
    """Return whether a volume is a scan of a body or one in whole numbers, as scanners have."""
    is_whole = case.data.run()[array.name].dtype.kind in "iu"
    return _is_scan(case, array) and (is_whole or case.is_of_body)


def _is_compact(case: Case, array: Named) -> bool:
    """Return whether the values above the lowest one of an image fill much of its box."""
    mesh = case.data.run()
    steps = tuple(slice(None, None, max(1, size // STEPS)) for size in mesh.dimensions)
    values = np.asarray(mesh[array.name]).reshape(mesh.dimensions, order="F")[steps]
    places = np.argwhere(values > np.nanmin(values))
    return bool(len(places) > COMPACT * np.prod(np.ptp(places, axis=0) + 1))


def _cut_open(case: Case) -> Drawing | None:
    """Draw the body in a scan cut open toward the eye, None without a body in air."""
    array, wishes = case.needed_array, case.wishes
    if not _is_scan(case, array) or not surfaces.is_gray(case, array):
        return None
    eye = Viewpoint(FACE, (0.0, 0.0, 1.0)) if case.is_of_body else ISOMETRIC
    toward = _toward(case, case.data, eye)
    parts = Step("parts", "files.cut_open", case.data, array.name, toward=toward)
    if not parts.run()["skin"].n_points:
        return None
    skin, cut = (Step(name, "[]", parts, name) for name in ("skin", "cut"))
    camera = case.camera(skin, eye)
    scene = wishes.scene("none", camera)
    colors, note = case.ranged_of(case.data, array, "gray", scan=True)
    shown = {"scene": scene, "scalars": array.name, "show_scalar_bar": False, **colors}
    around = replace(case, data=skin, contents=Contents(skin.run()), question="shape")
    light = wishes.light_of_surface()
    drawn = {"color": SKIN, "scene": around.exposed(skin, camera, **light)}
    drawn |= wishes.drawn(light)
    layers = [Layer(cut, shown), Layer(skin, drawn)]
    words = f"{array.name} in a body cut open toward the eye"
    notes = [note] if note else []
    lit = case.lit(cut, scene)
    return Drawing(layers, camera, scene, lit, words, [case.bar(array, colors)], notes)


def stack(case: Case) -> Drawing:
    """Draw the slices of a stack side by side, in the colours of its values."""
    array = case.needed_array
    sheet = Step("sheet", "files.side_by_side", case.data, array.name)
    flat = replace(case, data=sheet, contents=Contents(sheet.run()), question="none")
    words = f"slices of {array.name} side by side, from the upper left"
    drawing = surfaces.values(flat)
    first, *others = drawing.layers
    # What is between slices is paper.
    paper = {"nan_color": case.wishes.background}
    colors = first.keywords | paper
    if isinstance(table := colors.get("cmap"), Step):
        colors["cmap"] = Step(table.name, table.path, *table.arguments, **table.keywords | paper)
    layers = [replace(first, keywords=colors), *others]
    return replace(drawing, words=words, layers=layers)


def _is_stack(case: Case, array: Named) -> bool:
    """Return whether a volume has one array, and few slices that are far apart."""
    is_one = len(case.contents.arrays) == 1 and not array.of_cells
    return is_one and montages.is_stack(case.data.run())


def _has_bones(values: Array) -> bool:
    """Return whether a scan has much air and some bone by the numbers of computed tomography."""
    bones = float(np.mean(values > BONE))
    return float(np.mean(surfaces.is_air(values))) > MUCH_AIR and BONES[0] < bones < BONES[1]


def _is_slab(mesh: pv.DataSet) -> bool:
    """Return whether an image has many voxels along two axes, and few along the other."""
    least, middle, _ = sorted(dimensions(mesh)) or (0, 0, 0)
    return least <= VOXELS < middle


def _is_scan(case: Case, array: Named) -> bool:
    """Return whether a volume is a scan: one array of an image, of many voxels each way."""
    mesh = case.data.run()
    return (
        isinstance(mesh, pv.ImageData)
        and not array.of_cells
        and len(case.contents.arrays) == 1
        and min(mesh.dimensions) > VOXELS
    )


def _are_differences(values: Array) -> bool:
    """Return whether densities are differences of two maps: around 0, and as far below as above."""
    low, high = float(values.min()), float(values.max())
    is_even = min(-low, high) > ENDS_OF_DIFFERENCES * max(-low, high)
    return is_even and abs(float(values.mean())) < MEAN_OF_DIFFERENCES * float(values.std())


def _is_density(case: Case, array: Named) -> bool:
    """Return whether values are densities by crystallography or electron microscopy."""
    words = meaning.of(case.data.run()).arrays.get(array.name, {})
    return words.get("long_name") == density_maps.WORDS
