"""Recipes of vectors: on a surface, on a sheet, and in a volume.

The drawing of a field follows from how fast it turns in the picture: strokes with their sense
where neighbours run alike, hue where strokes would be too fine, else the lengths of vectors alone.
Where that is in doubt the picture is read back, and the next is drawn if it cannot be read.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight.draw.cameras import footprint
from vizlight.draw.margins import parted
from vizlight.filters.streamlines import own_name, speed_of
from vizlight.looks.levels import sampled_corners
from vizlight.looks.recipes.drawing import (
    BESIDE,
    DISPLACEMENT,
    Doubt,
    Drawing,
    Layer,
    titled,
    titled_length,
    unlit,
)
from vizlight.looks.steps import Step
from vizlight.looks.wishes import even_light
from vizlight.mesh import meaning, records
from vizlight.mesh.strokes import FLAT, TUBE
from vizlight.model import kernels
from vizlight.vtk.polylines import has_lines_only
from vizlight.vtk.topology import coincident

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Foreign, Keywords
    from vizlight.looks.contents import Named
    from vizlight.looks.recipes.drawing import Case

#: Share of the size of a mesh between neighbouring lines, at most.
SPACING = 1 / 50
#: Radians by which a field turns from one stroke to the next, at most, and within a place of one
#: hue.
TURN, TURN_HUE = 0.6, 0.8
#: Least distance between strokes, and size of a place whose hue is seen, in least widths of lines.
LEAST_SPACING, LEAST_PLACE = 7.5, 2.2
#: Multiple of these from which no picture need be read back before it is chosen.
CLEAR = 2.0
#: Factor of the least distance between strokes in small views.
SPARSE = 2.0
#: Length of a stroke in distances between strokes.
LONG = 4.5
#: Step of lines in distances between strokes, and in cells where these are no smaller.
STEP, FINEST = 0.125, 0.3
#: Width of the head of a stroke as a share of its length, and its least and largest one in least
#: widths of lines: on maps, where wider ones darken what is beside them for the eye, on surfaces
#: that bend, where thinner ones tell as much, and in volumes.
HEAD_WIDTH, WIDTHS, WIDTHS_ON_SURFACE, WIDTHS_IN_VOLUME = 0.7, (3.0, 4.0), (2.6, 3.4), (4.0, 5.5)
#: Length below which lines on surfaces are left out, in distances between strokes: loops so small
#: are blots.
SHORTEST_ON_SURFACE = 2.0
#: Colour map of lengths of vectors, on which black is seen everywhere.
SPEED = "vizlight.speed"
#: Distances between streamlines of a volume as shares of its size: the second where more of the
#: first are left out than are kept, as in thin vessels.
SPACINGS_IN_VOLUME = (1 / 16, 1 / 25)
#: Length of strokes in a volume, and length below which streamlines are left out, in these
#: distances: many are cut short, or turn on the spot, where the field is noise.
LONG_IN_VOLUME, SHORTEST = 7.0, 4
#: Largest width of those without a sense, and the halo of all.
WIDE_IN_VOLUME, HALO_IN_VOLUME = 2.0, 0.15
#: Colours of the floor of a volume, and how far it is below the box as a share of its size.
FLOOR, BELOW = {"paper": "#eeeeee", "dark": "#2c2c2c"}, 2e-3
#: Colours and light of walls, which are pale: lines in colours are seen on them.
WALLS = {"paper": "white", "dark": "#3a3d42"}
WALL_LIGHT: Keywords = {"ambient": 0.72, "diffuse": 0.2, "smooth_shading": True}
#: Words of the key for the sense of strokes.
SENSE = "; arrows point downstream"
#: The same on a cut, where colours tell the whole length of vectors and strokes their course in it.
SENSE_IN_CUT = "; arrows: part in the cut"
#: Stroke lengths that strokes move in a movie where vectors are long.
TRAVEL = 3.0
#: Share by which the shortest vectors are shorter than most, below which lengths are no speed.
EVEN = 0.05
#: Number beyond all components of vectors.
MOST_FINITE = 1e300
#: Most cells of a volume in which lines are evenly spaced, and the number of lines in larger ones.
MOST_CELLS, SEEDS = 250_000, 300
#: Most cells of a grid all of which have strokes, and fewest points that others keep along an axis.
MOST_TRACED, FEWEST = 100_000, 100


def vectors(case: Case) -> Drawing:
    """Draw vectors on a surface or a sheet: their lengths in colours under strokes, or light."""
    array, contents = case.needed_array, case.contents
    surface = case.surface
    if contents.dimension == 3 and contents.flat_axis is not None and case.wishes.surface:
        # The outer surface of a slab has sides too, on which strokes would follow its rim.
        normal = "xyz"[contents.flat_axis]
        surface = Step("plane", ".slice", case.data, normal, generate_triangles=True)
    mesh = case.wishes.joined(surface, array)
    camera = case.camera(mesh)
    if case.wishes.question != "auto" or has_lines_only(mesh.run()):
        spacing = mesh.run().length * SPACING
        return _lit(case, mesh, camera, _strokes(mesh, case.scene(camera), array, spacing))
    pixel = pixel_of(case, camera)
    turn = turn_of(mesh.run(), array.name) * pixel
    # Distances over which the field turns by a radian, in least widths of lines.
    room = 1 / max(turn * case.width, 1e-9)
    if room * TURN < LEAST_SPACING:
        return _without_strokes(case, mesh, camera, room)
    spacing = min(room * TURN * case.width * pixel, mesh.run().length * SPACING)
    traced = _coarser(case, mesh, spacing)
    strokes = _strokes(traced, case.wishes.scene("none", camera), array, spacing)
    if strokes is None or _is_even(mesh.run(), array.name):
        return _lit(case, mesh, camera, strokes)
    drawing = _speed(case, mesh, camera, strokes)
    if room * TURN > CLEAR * LEAST_SPACING:
        return drawing
    doubt = Doubt(("direction",), lambda: _without_strokes(case, mesh, camera, room))
    return replace(drawing, doubt=doubt)


def _without_strokes(case: Case, mesh: Step, camera: Step, room: float) -> Drawing:
    """Draw vectors by hue, or by their lengths alone where places of one hue are too small."""
    name = case.needed_array.name

    def lengths_alone() -> Drawing:
        note = f"{name} turns too fast here for its course to be seen: colours are its length"
        drawing = _speed(case, mesh, camera, None)
        return replace(drawing, notes=[note, *drawing.notes])

    if room * TURN_HUE < LEAST_PLACE:
        return lengths_alone()
    note = f"{name} turns too fast here for strokes: hue tells its course, not its sense"
    in_doubt = room * TURN_HUE < CLEAR * LEAST_PLACE
    doubt = Doubt(("direction",), lengths_alone) if in_doubt else None
    return replace(_lit(case, mesh, camera, strokes=None), notes=[note], doubt=doubt)


def lengths(case: Case) -> Drawing:
    """Draw the surface of a solid in the colours of the lengths of its vectors."""
    mesh = case.wishes.joined(case.surface, case.needed_array)
    return _speed(case, mesh, case.camera(mesh), None)


def _lit(case: Case, mesh: Step, camera: Step, strokes: Step | None) -> Drawing:
    """Draw vectors by light, with strokes along them."""
    array = case.needed_array
    light = {"tangents": array.name} | case.wishes.light_of_surface()
    scene = case.exposed(mesh, camera, **light)
    lit = case.lit(mesh, scene, **light)
    if (other := case.second) is not None:
        # Colours of data take the place of the hues of the light.
        scene = case.exposed(mesh, camera, "value", **light)
        lit = case.lit(mesh, scene, **light)
        drawn = {"scalars": other.name, "show_scalar_bar": False, **case.wishes.colors}
        layer = Layer(mesh, {"scene": scene, **drawn, **case.wishes.drawn(light)})
        words = f"{other.name} in colours, lit along {array.name}"
        keys = [case.bar(other, case.wishes.colors)]
        return Drawing([layer], camera, scene, lit, words, keys, kind=mesh)
    layers = [Layer(mesh, {"scene": scene, **case.wishes.drawn(light)}), *case.edges(camera)]
    if strokes is not None:
        layers.append(_inked(case, strokes, camera))
    keys = [{"scene": scene, "title": _titled_course(mesh.run(), array.name)}]
    return Drawing(layers, camera, scene, lit, f"direction of {array.name}", keys, kind=mesh)


def _titled_course(mesh: pv.DataSet, name: str) -> str:
    """Return the title of the course of vectors, with their length where all have one.

    That of unit vectors tells nothing.
    """
    lengths, title = _lengths(mesh, name), titled(mesh, name, course=True)
    if not lengths.size or not _is_even(mesh, name) or np.isclose(np.median(lengths), 1, atol=EVEN):
        return title
    unit = parted(titled(mesh, name))[1]
    return f"{title}; {np.median(lengths):.3g} {unit}".rstrip() + " everywhere"


def _speed(case: Case, mesh: Step, camera: Step, strokes: Step | None) -> Drawing:
    """Draw a mesh in the colours of the lengths of its vectors, with strokes along them."""
    array = case.needed_array
    bent = case.contents.flat_axis is None
    light = case.wishes.light_of_surface() if bent else {}
    scene = case.wishes.scene("none", camera)
    if bent:
        scene = case.exposed(mesh, camera, "value", **light)
    sense = SENSE if case.wishes.part.get("slice") is None else SENSE_IN_CUT
    sense *= strokes is not None
    if (shown_array := case.second) is not None:
        colors, note, bar = _colors_of(case, mesh, shown_array, SPEED, sense)
    else:
        shown_array, (colors, note) = array, colors_of_lengths(case, mesh, SPEED)
        bar = bar_of_lengths(mesh, array.name, colors, sense)
    shown = {"scene": scene, "scalars": shown_array.name, "show_scalar_bar": False, **colors}
    layers = [Layer(mesh, shown | case.wishes.drawn(light)), *case.edges(camera)]
    if strokes is not None:
        layers.append(_inked(case, strokes, camera))
    words = f"length of {array.name}" if shown_array is array else shown_array.name
    along = "it" if shown_array is array else array.name
    words += " in colours" + f", with strokes along {along}" * (strokes is not None)
    lit = case.lit(mesh, scene, **light)
    notes = [note] if note else []
    return Drawing(layers, camera, scene, lit, words, [bar], notes=notes, kind=mesh)


def colors_of_lengths(case: Case, mesh: Step, cmap: str) -> tuple[Keywords, str]:
    """Return the colours of lengths of vectors, and words if their range is not all."""
    name = case.needed_array.name
    # Displacements are compared with each other, and not in decades.
    skewed = DISPLACEMENT.fullmatch(name.lower()) is None
    sizes = _lengths(mesh.run(), name)
    return case.ranged(sizes, f"the length of {name}", cmap, lengths=skewed)


def bar_of_lengths(mesh: Step, name: str, colors: Keywords, sense: str = "") -> Keywords:
    """Return the keywords of the key of lengths of vectors in colours."""
    title = f"{titled_length(mesh.run(), name)}{sense}"
    return {"question": "value", "title": title, "cmap": colors["cmap"], "clim": colors["clim"]}


def _lengths(mesh: pv.DataSet, name: str) -> Array:
    """Return the finite lengths of vectors; one of 0 is that of a place without a vector."""
    sizes = kernels.length_rows(mesh[name])
    return sizes[np.isfinite(sizes) & (sizes > 0)]


def _is_even(mesh: pv.DataSet, name: str) -> bool:
    """Return whether vectors have nearly one length, such as unit vectors: directions alone."""
    least, median = np.percentile(_lengths(mesh, name), (1, 50))
    return bool(least > (1 - EVEN) * median)


def strokes_on(case: Case, section: Step, camera: Step, pixel: float) -> Layer | None:
    """Return the layer of strokes along vectors on a section, None if none can be laid.

    The section has the array of vectors of the case; ``pixel`` is the size of one in the unit of
    the mesh.
    """
    spacing = max(section.run().length * SPACING, SPARSE * LEAST_SPACING * case.width * pixel)
    scene = case.wishes.scene("none", camera)
    strokes = _strokes(section, scene, case.needed_array, spacing)
    return None if strokes is None else _inked(case, strokes, camera)


def _inked(case: Case, strokes: Step, camera: Step) -> Layer:
    """Return the layer of strokes in black, for grounds that are light in either style."""
    # The lamps of a user are for the ground.
    scene = even_light(camera)
    flat = case.contents.flat_axis is not None
    wide = _head_width(case, strokes, camera, WIDTHS if flat else WIDTHS_ON_SURFACE)
    return Layer(
        strokes,
        {"scene": scene, "color": "black", "width": "width", "line_width": wide, "halo": False},
    )


def _head_width(case: Case, strokes: Step, camera: Step, between: tuple[float, float]) -> float:
    """Return the width of the heads of strokes in pixels."""
    step: Foreign = strokes.keywords["stroke_length"]
    arrow = FLAT if strokes.keywords.get("confined") else TUBE
    length = arrow.head * step / pixel_of(case, camera)
    low, high = (case.width * end for end in between)
    return round(float(np.clip(HEAD_WIDTH * length, low, high)), 1)


def pixel_of(case: Case, camera: Step) -> float:
    """Return the size of a pixel at the focus of a camera, in the unit of the mesh."""
    eye: pv.Camera = camera.run()
    return float(footprint(eye, np.array([eye.focal_point]), case.wishes.room[1])[0])


def turn_of(mesh: pv.DataSet, name: str) -> float:
    """Return how much vectors turn along the edges of a cell, in radians per length: the median.

    Half of the area turns less, so that it is that of a field which is smooth in most places,
    however many small cells are elsewhere.
    """
    mesh = records.averaged(mesh, name)
    first, starts, counts = sampled_corners(mesh)
    if not len(first):
        return 0.0
    last = np.roll(first, -1)
    last[starts + counts - 1] = first[starts]
    rows = np.asarray(mesh.point_data[name], dtype=np.float64)
    ends = np.linalg.norm(rows[first], axis=1) * np.linalg.norm(rows[last], axis=1)
    good = np.isfinite(ends) & (ends > 0)
    points = np.asarray(mesh.points, dtype=np.float64)
    lengths, turns = np.zeros((2, len(first)))
    lengths[good] = np.linalg.norm(points[last[good]] - points[first[good]], axis=1)
    cosines = np.einsum("ij,ij->i", rows[first[good]], rows[last[good]]) / ends[good]
    turns[good] = np.arccos(np.clip(cosines, -1, 1))
    around = np.add.reduceat(lengths, starts)
    has_length = around > 0
    around, turned = around[has_length], np.add.reduceat(turns, starts)[has_length]
    each, areas = turned / around, around**2
    ranked = np.argsort(each)
    half = np.searchsorted(np.cumsum(areas[ranked]), areas.sum() / 2)
    return float(each[ranked[half]]) if len(each) else 0.0


def flow(case: Case) -> Drawing:
    """Draw streamlines of the vectors in a volume as strokes, in the colours of their speed.

    Where a scene, another question or an isosurface is asked for, they are lit. On a surface they
    are the strokes of its vectors, unless options ask for other lines.
    """
    if (drawing := _along_surface(case)) is not None:
        return drawing
    array = case.needed_array
    mesh = case.wishes.joined(case.data, array)
    if array.of_cells:
        mesh = Step("averaged", ".cell_data_to_point_data", mesh)
    keywords: Keywords = {"tangents": array.name} | dict(case.wishes.light)
    mesh = _where_it_flows(_in_one_piece(mesh), array.name)
    on = mesh
    if "contour" in case.wishes.part:
        on = keywords["surface"] = case.wishes.isosurface(mesh)
    box = Step("box", ".outline", mesh)
    camera = case.camera(box, case.eye(on if keywords.get("confined") else mesh), boxed=True)
    without_light = case.wishes.question == "auto" or (
        case.wishes.question == "flow" and case.wishes.make_scene is None
    )
    # Lines of a line field have no speed.
    has_speed = "surface" not in keywords and not keywords.get("line_field")
    by_speed = without_light and has_speed and not _is_even(mesh.run(), array.name)
    scene = case.wishes.scene("lamp", camera) if by_speed else case.scene(camera)
    # Lines that are asked for have their light in files.
    light = scene if case.wishes.question == "auto" else case.scene(camera)
    lit = _streamlines(case, mesh, light, keywords)
    keys: list[Keywords] = [{"scene": scene, "title": _titled_course(mesh.run(), array.name)}]
    wide = round(WIDE_IN_VOLUME * case.width, 1)
    if not keywords.get("line_field"):
        wide = _head_width(case, lit, camera, WIDTHS_IN_VOLUME)
    drawn: Keywords = {"width": "width", "line_width": wide, "halo": HALO_IN_VOLUME}
    words = f"streamlines of {array.name}"
    notes = []
    if by_speed:
        colors, note, keys = _colors_of_flow(case, mesh, lit)
        notes += [note] if note else []
        # Light on tubes tells their course toward the eye.
        drawn |= {"show_scalar_bar": False, **colors, "render_lines_as_tubes": True}
        shown = str(colors["scalars"])
        words += f" in the colours of {shown if shown in mesh.run().point_data else 'their speed'}"
    lines = Layer(lit, {"scene": scene, **drawn})
    if "surface" in keywords:
        # The surface that conditions the light of the lines is not drawn with them.
        name = str(keywords.get("name", "luminance"))
        lines = unlit(lit, scene, name, line_width=case.width)
    if left_out := _left_out(lit):
        least = f"{lit.keywords['min_length']:g}"
        notes += [
            f"lines without a part of {least}, four times their distance, free of kinks are left "
            f"out: {left_out}"
        ]
    layers = [lines]
    if case.map_frame is None:
        layers += [*_hull(case, mesh, drawn), *_floor(case, box, camera), *case.boxed(box, camera)]
    return Drawing(layers, camera, scene, lit, words, keys, notes=notes)


def _colors_of(
    case: Case, mesh: Step, array: Named, cmap: str, sense: str
) -> tuple[Keywords, str, Keywords]:
    """Return the colours of values beside a flow, words on their range, and the key."""
    colors, note = case.ranged_of(mesh, array, cmap)
    key = case.bar(array, colors)
    is_warm = meaning.is_temperature(case.data.run(), array.name) and key["title"] == array.name
    title = "temperature" if is_warm else key["title"]
    return colors, note, key | {"title": f"{title}{sense}"}


def _colors_of_flow(case: Case, mesh: Step, lines: Step) -> tuple[Keywords, str, list[Keywords]]:
    """Return the colours of streamlines, words on their range, and the key.

    They are those of the array that is to colour them, else of the temperature if the file has one,
    which drives the flow or is carried by it, and nobody asks for the vectors alone; else of the
    speed.
    """
    array = case.needed_array
    arrays = [array for array in case.contents.arrays if array.role == "values"]
    source = case.data.run()
    warm = next((array for array in arrays if meaning.is_temperature(source, array.name)), None)
    shown = case.second or (warm if case.wishes.array is None else None)
    if shown is not None and shown.name in lines.run().point_data:
        colors, note, key = _colors_of(case, lines, shown, case.map_on_ground, SENSE)
        return {"scalars": shown.name, **colors}, note, [key]
    speed = own_name(mesh.run(), "speed")
    speeds = np.asarray(lines.run()[speed], dtype=np.float64)
    colors, note = case.ranged(speeds, "speed", case.map_on_ground, lengths=True)
    return {"scalars": speed, **colors}, note, [bar_of_lengths(mesh, array.name, colors, SENSE)]


def _in_one_piece(mesh: Step) -> Step:
    """Return the step that joins blocks of a grid where they meet, which else have walls there."""
    grid = mesh.run()
    if not isinstance(grid, pv.UnstructuredGrid) or coincident(np.asarray(grid.points)) is None:
        return mesh
    return Step("whole", ".clean", mesh, produce_merge_map=False)


def _where_it_flows(mesh: Step, name: str) -> Step:
    """Return the step that takes the part of an image with vectors, if the rest is larger."""
    grid = mesh.run()
    if not isinstance(grid, pv.ImageData):
        return mesh
    rows: Bools = np.any(grid.point_data[name], axis=1)
    flows = rows.reshape(grid.dimensions, order="F")
    spans = [np.flatnonzero(np.any(flows, axis=others)) for others in ((1, 2), (0, 2), (0, 1))]
    if any(not len(span) for span in spans):
        return mesh
    ends = [
        (max(int(span[0]) - 1, 0), min(int(span[-1]) + 1, count - 1))
        for span, count in zip(spans, grid.dimensions, strict=True)
    ]
    if np.prod([high - low + 1 for low, high in ends]) > grid.n_points / 2:
        return mesh
    starts = np.reshape(grid.extent, (3, 2))[:, 0].tolist()
    voi = [start + end for start, pair in zip(starts, ends, strict=True) for end in pair]
    return Step("part", ".extract_subset", mesh, voi)


def _along_surface(case: Case) -> Drawing | None:
    """Return the drawing of evenly spaced strokes on a surface, None where it needs other lines."""
    asked = case.wishes.light.keys() - {"tangents"}
    if case.contents.dimension != 2 or asked or case.wishes.make_scene is not None:
        return None
    drawing = vectors(
        replace(case, question="direction", wishes=replace(case.wishes, question="auto"))
    )
    strokes = drawing.layers[-1].mesh
    if strokes.path != "vizlight.streamlines":
        return None
    # Files of lines have their light.
    scene = case.scene(drawing.camera)
    lit = Step("lit", strokes.path, strokes.arguments[0], scene, **strokes.keywords)
    return replace(drawing, lit=lit, kind=None, doubt=None)


def moving(drawing: Drawing) -> Drawing | None:
    """Return a drawing with strokes that move in a movie, None without strokes that have a sense.

    The key says how much time a movie shows.
    """
    layers, period = [], 0.0
    for layer in drawing.layers:
        step = layer.mesh
        if "width" in layer.keywords and have_sense(step):
            step = Step(step.name, step.path, *step.arguments, **step.keywords, travel=TRAVEL)
            step.quiet = layer.mesh.quiet
            period = float(step.run().field_data["period"][0])
        layers.append(replace(layer, mesh=step))
    if not period:
        return None
    head = _title_without_sense(drawing)
    unit = " s" if head.endswith("/s)") else ""
    words = f"strokes move with it, {period:.3g}{unit} of its time in all"
    return replace(with_words(drawing, words), layers=layers)


def with_words(drawing: Drawing, words: str) -> Drawing:
    """Return a drawing with a first key that says how strokes move, in place of their sense."""
    said = f"{_title_without_sense(drawing)}; {words}"
    keys = [dict(key, title=said) if i == 0 else key for i, key in enumerate(drawing.keys)]
    return replace(drawing, keys=keys)


def _title_without_sense(drawing: Drawing) -> str:
    title = drawing.keys[0].get("title", "") if drawing.keys else ""
    return str(title).replace(SENSE, "")


def have_sense(strokes: Step) -> bool:
    """Return whether a step lays strokes along vectors, which are not a line field."""
    if "stroke_length" not in strokes.keywords or strokes.keywords.get("line_field"):
        return False
    return speed_of(strokes.run()) is not None


def _streamlines(case: Case, mesh: Step, scene: Step, keywords: Keywords) -> Step:
    """Return the step that lays strokes in a volume, without short ones where some are long."""
    evenly = "spacing" not in keywords and "seeds" not in keywords
    evenly = evenly and mesh.run().n_cells <= MOST_CELLS and "surface" not in keywords
    for share in SPACINGS_IN_VOLUME:
        spacing = share * float(mesh.run().length)
        usual: Keywords = {"stroke_length": float(f"{LONG_IN_VOLUME * spacing:.3g}")}
        if evenly:
            usual["spacing"] = float(f"{spacing:.3g}")
        elif "spacing" not in keywords:
            usual["seeds"] = SEEDS
        step = _long_lines(case, mesh, scene, usual | keywords, float(f"{SHORTEST * spacing:.3g}"))
        if not evenly or _left_out(step) <= step.run().n_lines:
            break
    return step


def _long_lines(case: Case, mesh: Step, scene: Step, keywords: Keywords, least: float) -> Step:
    """Return the step that lays streamlines of a least length, of any where none is so long."""
    for shortest in ({"min_length": least}, {}):
        step = case.wishes.step("lit", "streamlines", mesh, scene, **(shortest | keywords))
        # Fewer lines than a number that nobody asked for are no concern of the reader.
        step.quiet = "seeds" not in case.wishes.light
        try:
            step.run()
        except ValueError as error:
            if shortest and "min_length" in str(error):
                continue
            raise
        break
    return step


def _left_out(lines: Step) -> int:
    """Return the number of lines that were too short."""
    return int(lines.run().field_data.get("left_out", [0])[0])


def _hull(case: Case, mesh: Step, drawn: Keywords) -> list[Layer]:
    """Return the layer of the inner sides of the hull of a volume, none for a box.

    What the flow goes around is seen as a solid, in the colours of the values of the lines where
    they differ on it, and the walls toward the eye are left out.
    """
    if isinstance(mesh.run(), pv.ImageData | pv.RectilinearGrid):
        return []
    surface = Step("surface", ".extract_surface", mesh, algorithm="dataset_surface")
    # Cells whose corners are in the other order have walls that face inward.
    outward: Keywords = {"auto_orient_normals": True, "cell_normals": False}
    outward["split_vertices"] = True
    hull = Step("hull", ".compute_normals", surface, **outward)
    shown: Keywords = {"color": WALLS[case.wishes.style]}
    name = str(drawn.get("scalars"))
    if name in mesh.run().point_data:
        inner = Step("hull", "files.obstacles", hull, name)
        values = inner.run().point_data[name]
        low, high = drawn["clim"]
        values = np.clip(values[np.isfinite(values)], low, high)
        if values.size and np.ptp(values) > EVEN * (high - low):
            table = {key: drawn[key] for key in ("scalars", "cmap", "clim")}
            shown = {**table, "nan_color": shown["color"], "show_scalar_bar": False}
            hull = inner
    shown |= {"culling": "front", **WALL_LIGHT}
    return [Layer(hull, shown, live=False)]


def _floor(case: Case, box: Step, camera: Step) -> list[Layer]:
    """Return the floor of a box as a layer, if the eye is above it: it helps to read heights."""
    if camera.run().up[2] <= 0:
        return []
    low = np.array(box.run().bounds).reshape(3, 2)
    if camera.run().position[2] <= low[2, 1]:
        return []
    sizes = np.ptp(low, axis=1)
    # Lines on the floor are seen.
    middle = (*low.mean(axis=1)[:2].tolist(), float(low[2, 0] - BELOW * sizes.max()))
    wide, deep = sizes[:2].tolist()
    floor = Step("floor", "pyvista.Plane", center=middle, i_size=wide, j_size=deep)
    drawn = {"color": FLOOR[case.wishes.style], "lighting": False, **BESIDE}
    return [Layer(floor, drawn, live=False)]


def _strokes(mesh: Step, scene: Step, array: Named, spacing: float) -> Step | None:
    """Return the step that lays evenly spaced strokes on a surface, None if none can be laid."""
    surface = mesh.run()
    if has_lines_only(surface) or not surface.n_cells:
        return None
    spacing = float(f"{spacing:.3g}")
    keywords: Keywords = {"tangents": array.name, "spacing": spacing, "confined": True}
    keywords["min_length"] = float(f"{SHORTEST_ON_SURFACE * spacing:.3g}")
    # Lines of four strokes, many of which grow at once, and cost less than few long ones.
    keywords["max_length"] = float(f"{2 * LONG * spacing:.3g}")
    keywords |= {"stroke_length": LONG * spacing, "feature_angle": "auto"}
    if (step := _fine_step(surface, spacing)) > FINEST:
        keywords["step"] = step
    # Of one mesh normals are computed once.
    whole = isinstance(surface, pv.PolyData) and surface.is_all_triangles
    triangles = mesh if whole else Step("triangles", ".triangulate", mesh)
    if not np.isfinite(surface[array.name]).all() and not array.of_cells:
        # Between a vector and a missing one, as at a coast, no line is drawn.
        every: Keywords = {"scalars": array.name, "all_scalars": True, "component_mode": "all"}
        known = Step("known", ".threshold", triangles, (-MOST_FINITE, MOST_FINITE), **every)
        triangles = Step("known", ".extract_surface", known, algorithm="dataset_surface")
    strokes = Step("strokes", "vizlight.streamlines", triangles, scene, **keywords)
    try:
        strokes.run()
    except ValueError:
        # The light tells the direction by itself where no line can be laid.
        return None
    return strokes


def _coarser(case: Case, mesh: Step, spacing: float) -> Step:
    """Return the surface of a share of the points of a large grid, where strokes need no more."""
    grid = case.data.run()
    is_grid = isinstance(grid, pv.ImageData | pv.RectilinearGrid | pv.StructuredGrid)
    is_large = case.contents.dimension == 2 and grid.n_cells > MOST_TRACED
    if not is_grid or not is_large or case.on_globe:
        return mesh
    every = int(_fine_step(mesh.run(), spacing))
    rate = [max(min(every, size // FEWEST), 1) for size in grid.dimensions]
    if max(rate) == 1:
        return mesh
    coarse = Step("coarse", ".extract_subset", case.data, list(grid.extent), rate)
    return case.wishes.joined(replace(case, data=coarse).surface, case.needed_array)


def _fine_step(surface: pv.DataSet, spacing: float) -> float:
    """Return the step of lines, in cells, that is a small share of their distance."""
    cell = np.sqrt(2 * surface.area / surface.n_cells)
    return float(f"{STEP * spacing / cell:.1g}") if cell > 0 else FINEST
