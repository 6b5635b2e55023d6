"""Recipes of surfaces: their shape, values on them, fur, bands of light, and n-space."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv
import scipy

from vizlight.draw.cameras import axes_of
from vizlight.draw.margins import LETTERS
from vizlight.draw.ticks import USUAL, even_levels, numerals_of
from vizlight.filters.fur import LENGTH
from vizlight.looks.contents import SAMPLE, WHITE, Contents, is_of_kinds, kinds_of
from vizlight.looks.framing import places_on, sees
from vizlight.looks.ranges import Range
from vizlight.looks.recipes.drawing import (
    BESIDE,
    DARK,
    LIGHTNESS,
    MOST_IN_KEY,
    ON_SURFACES,
    PLACE,
    Drawing,
    Layer,
    colors_in,
    colors_of,
    colors_of_kinds,
    file_named,
    lines_every,
    titled,
    unlit,
)
from vizlight.looks.recipes.fields import pixel_of
from vizlight.looks.steps import DISPLACED, Step
from vizlight.looks.wishes import SMALL
from vizlight.mesh import blocks, georeference, meaning
from vizlight.mesh.nspace import POSITION
from vizlight.mesh.stresses import is_von_mises
from vizlight.reading import brains
from vizlight.vtk import hull, letters
from vizlight.vtk.cells import dimensions

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Array, Bools, Keywords, Raw
    from vizlight.looks.contents import Named
    from vizlight.looks.recipes.drawing import Case

#: Colour of what is seen face on and has no data, and most cells whose edges are drawn.
LIGHT_GREY, MOST_WITH_EDGES = "#bcbcbc", 5000
#: Note on the walls of a body in a flow.
ONLY_WALLS = "the walls inside of the mesh are drawn, its far field is left out"
#: Opacity of the edges of elements, least length of most of them in pixels beside values, and
#: outline of a solid before it is displaced.
FAINT, FINE, BEFORE = 0.35, 6.0, {"color": "#8a8a8a"}
#: Share of the range of a stress from which a place belongs to a peak, and largest size of a single
#: one as a share of that of the mesh; width of its dot in those of lines.
PEAK, SINGLE, DOT = 0.9, 0.2, 5.0
#: Length in pixels from which isolines on a solid are long, least share of their length in long
#: ones, and least distance between them in pixels.
LONG, SMOOTH, APART = 100.0, 0.9, 30.0
#: Largest share of a step by which multiples of it differ from whole ones.
ROUNDING = 0.05
#: Largest area of a cell of a plane in the least from which on sizes are shown, and share of the
#: plane that the lesser half of its cells covers below which the rest is far around them.
GRADED, FAR_FIELD = 100, 0.02
#: Number of air in computed tomography, in Hounsfield units, and how near others are its own.
AIR, NEAR_AIR = -1000.0, 50.0
#: Largest share of the brightest value by which those of a scan that is resampled are below 0.
RINGING = 0.1
#: Most values of a scan that are looked at.
MOST_VALUES = 100_000
#: Key of a kind without a name, which is its title alone.
TITLE_ALONE: Keywords = {"question": "value", "cmap": Step("", "vizlight.maps.kinds", {0: " "})}


def values(case: Case) -> Drawing:
    """Draw a sheet or a surface in the colours of values, with their bar."""
    array = case.needed_array
    mesh = smooth = _of_labels(case, array) if array.role == "kinds" else None
    # The edges of an image are those of its box.
    edges = case if smooth is None else replace(case, data=smooth)
    if mesh is None:
        by_corner = array.role == "kinds" or _is_of_single_points(case, array)
        mesh = _by_corner(case, array) if by_corner else case.surface
    if array.role == "kinds" and case.contents.dimension == 3:
        kinds = kinds_of(mesh.run(), array.name)
        if len(kinds) == 1 and smooth is not None:
            # The surface of a single label is a shape.
            shape = replace(case, question="shape", data=mesh)
            drawing = surface(shape)
            # Alone in its file, the number of a label tells nothing.
            number = f" {kinds[0]:g}" * (array.distinct > 2)
            keys = _keys(shape, drawing.scene, titled(mesh.run(), array.name) + number)
            return replace(drawing, words=f"surface of {array.name} {kinds[0]:g}", keys=keys)
        inner = _inside(case, array, kinds) if len(kinds) == 1 else None
        if inner is not None:
            drawing = values(replace(case, data=inner, contents=Contents(inner.run())))
            note = f"{array.name} {kinds[0]:g}, which is around all else, is left out"
            return replace(drawing, notes=[*drawing.notes, note])
    outline = _undisplaced(case)
    framed = mesh if outline is None else Step("", "pyvista.MultiBlock", [mesh, outline])
    camera = case.camera(framed, case.eye(mesh))
    light = case.wishes.light_of_surface()
    bent = case.question != "none"
    # Seen along an axis, much of a surface faces the eye, and a lamp there would show no relief.
    # Neither would it on lobes of one colour each.
    has_lobes = isinstance(case.wishes.part.get("level"), tuple)
    is_shaded = case.wishes.views is not None or array.role == "kinds"
    lamp = "room" if has_lobes else "lamp" if is_shaded else ""
    scene = case.exposed(mesh, camera, lamp, **light) if bent else case.scene(camera)
    keywords = case.wishes.colors
    note = ""
    if bent and array.role == "values":
        keywords, note = case.ranged_of(mesh, array, ON_SURFACES)
    elif bent and array.role == "heights":
        rows = np.asarray(mesh.run()[array.name], dtype=np.float64)
        keywords, note = case.ranged(rows, array.name, ON_SURFACES)
    elif not bent and array.role == "heights":
        keywords = case.colors_of_heights
    elif not bent:
        # Nothing is lit: the map may run in lightness, which shows more than hues alone.
        # Of bytes on a map those up to 100 may be shares; bands without a name are a sensor's.
        is_band = case.contents.raster and array.name.startswith("band_")
        is_tone = is_band or (case.contents.raster and 100 < array.high <= 255)
        is_photograph = meaning.is_photograph(mesh.run())
        rows = np.asarray(mesh.run()[array.name])
        # Missing values make numbers in floating point of those of a camera.
        is_whole = (is_tone or is_photograph) and np.array_equal(
            rows, np.round(rows), equal_nan=True
        )
        is_picture = is_whole and array.low >= 0 and is_tone
        is_scan = is_photograph and (is_whole or _are_steps(rows))
        is_of_scanner = case.is_of_body and is_gray(case, array)
        in_gray = is_of_scanner or is_picture or is_scan
        cmap = "gray" if in_gray else LIGHTNESS
        is_scan = is_of_scanner or (is_picture and is_band)
        kind = {"amounts": case.is_of_earth and not in_gray, "scan": is_scan}
        keywords, note = case.ranged_of(mesh, array, cmap, **kind)
    if array.role == "kinds":
        keywords = colors_of_kinds(mesh, array, case.wishes.colors)
    elif array.role == "colors":
        keywords = {"rgb": True}
    shown = {"scene": scene, "scalars": array.name, "show_scalar_bar": False, **keywords}
    shown |= case.wishes.drawn(light) | _elements(case, mesh, camera)
    lit = case.lit(mesh, scene, **light)
    keys = [] if array.role == "colors" else [case.bar(array, keywords)]
    words = f"{array.name} in colours"
    if array.role == "colors" and (bands := meaning.of(mesh.run()).arrays.get(array.name, {})):
        words = f"{bands['long_name']} as red, green and blue"
    notes = [note] if note else []
    if array.role == "kinds":
        more, keys = _notes_on_kinds(case, mesh, keys[0])
        notes = [*notes, *more]
    layers = [Layer(mesh, shown), *edges.edges(camera), *case.strokes([outline], **BEFORE)]
    layers += _peak(case, mesh, camera)
    drawing = Drawing(
        layers, camera, scene, lit,
        words, keys,
        colors=colors_of(array, keywords), notes=notes,
    )  # fmt: skip
    is_smooth = array.role == "values" and not array.of_cells and case.contents.dimension == 3
    return _with_isolines(case, drawing) if bent and is_smooth else drawing


def _notes_on_kinds(case: Case, mesh: Step, key: Keywords) -> tuple[list[str], list[Keywords]]:
    """Return notes on the kinds that are not seen or have no colour of their own, and the key."""
    array, title, notes = case.needed_array, key["title"], list[str]()
    kinds = kinds_of(mesh.run(), array.name)
    if hidden := _hidden_kinds(case, array, kinds):
        notes.append(f"{array.name} {hidden} is inside, where it is not seen")
        title = f"{title}; inside: {hidden}"
    count, shown = len(kinds), kinds
    if count > MOST_IN_KEY:
        shown = kinds_of(mesh.run(), array.name, MOST_IN_KEY)
    if rest := count - len(shown):
        notes.append(f"{array.name} has {count} kinds: the {rest} smallest are grey")
        small = f"{rest} small {'one' if rest == 1 else 'ones'}"
        return notes, [key | {"title": f"{title}; grey: {small}"}]
    if count > MOST_IN_KEY:
        notes.append(f"{array.name} has {count} kinds: colours repeat, and have no key")
        return notes, [key | TITLE_ALONE | {"title": f"{title}; {count} kinds"}]
    return notes, [key | {"title": title}]


def _hidden_kinds(case: Case, array: Named, kinds: Sequence[float]) -> str:
    """Return the names of kinds that a solid has inside of its surface alone, if they are few."""
    data = case.data.run()
    if case.contents.dimension != 3 or isinstance(data, pv.ImageData):
        return ""
    names = meaning.flags(data, array.name)
    hidden = [kind for kind in kinds_of(data, array.name) if kind not in kinds]
    return ", ".join(names.get(kind, f"{kind:g}") for kind in hidden[:MOST_IN_KEY])


def _undisplaced(case: Case) -> Step | None:
    """Return the step of the outline of a solid before its displacement, None for all else."""
    moved = case.moved
    if moved is None or moved.name != DISPLACED:
        return None
    surface = Step("before", "files.surface_of", moved.arguments[0])
    edges = Step("outline", ".extract_feature_edges", surface, manifold_edges=False)
    return edges if edges.run().n_cells else None


def _elements(case: Case, mesh: Step, camera: Step) -> Keywords:
    """Return the drawing of edges of the cells that stresses, or values of a solid, belong to."""
    of_cells = case.needed_array.of_cells and case.contents.dimension == 3
    # The surface of curved cells is in triangles, which are none of the elements.
    is_wanted = (of_cells or case.contents.is_strained) and not hull.is_curved(case.data.run())
    if not is_wanted or not mesh.run().n_cells:
        return {}
    areas = mesh.run().compute_cell_sizes(length=False, volume=False)["Area"]
    is_fine = np.sqrt(np.median(areas)) < FINE * pixel_of(case, camera)
    return {} if is_fine else _edges_of_cells(mesh)


def _peak(case: Case, mesh: Step, camera: Step) -> list[Layer]:
    """Return the layers that mark the highest stress with a dot and a word beside the mesh.

    None are where it is no single one, is not seen, or the picture has no room for the word.
    """
    array, surface, eye = case.needed_array, mesh.run(), camera.run()
    is_alone = case.wishes.views is None and case.wishes.frame is None
    if not (is_alone and is_von_mises(array.name) and isinstance(surface, pv.PolyData)):
        return []
    values: Array = np.nan_to_num(np.asarray(surface[array.name], dtype=np.float64))
    places = surface.cell_centers() if array.of_cells else surface
    points: Array = np.asarray(places.points, dtype=np.float64)
    if not values.size or not np.ptp(values):
        return []
    peak, way, filled = points[np.argmax(values)], np.negative(eye.direction), places_on(surface)
    high = points[values >= values.min() + PEAK * np.ptp(values)]
    is_single = np.linalg.norm(high - peak, axis=1).max() < SINGLE * surface.length
    if not is_single or not sees(filled, peak, way):
        return []
    factor, unit = meaning.usual_unit(surface, array.name, float(values.max()))
    word = f"highest {numerals_of([float(f'{values.max() / factor:.3g}')])[0]} {unit}".rstrip()
    size, pixel = SMALL * LETTERS * min(case.wishes.size), pixel_of(case, camera)
    across, room = axes_of(way, eye.up)[:2], np.array(case.wishes.room) / pixel / 2
    wide, tall = letters.width(word) * size * pixel, size * pixel
    # Above, beside and below the peak, first near it.
    shifts = itertools.product(
        (0.3, 0.8, 1.5), ((0, 1), (1, 0), (-1, 0), (1, -1), (-1, -1), (0, -1))
    )
    for apart, (x, y) in shifts:
        middle = np.array([x * (wide / 2 + apart * tall), y * (0.5 + apart) * tall])
        half = np.array([wide, tall]) / 2
        beside = np.abs((filled - peak) @ across.T - middle) < half
        ends = np.abs((peak - eye.focal_point) @ across.T + middle) + half
        if not beside.all(axis=1).any() and np.all(ends < room):
            spot, place = (
                Step(name, "pyvista.PolyData", [[float(f"{part:.6g}") for part in at]])
                for name, at in ((PLACE, peak), ("", peak + (middle - (0, 0.6 * tall)) @ across))
            )
            block = Step("", "pyvista.MultiBlock", [place])
            text = case.wishes.words_around(block, camera, 1.0, names=[word])
            dot: Keywords = {"point_size": DOT * case.width, "render_points_as_spheres": True}
            return [*case.strokes([spot], **dot), case.inked(text)]
    return []


def _edges_of_cells(mesh: Step) -> Keywords:
    """Return the drawing of edges of cells, thin and faint, where these are not too many."""
    if mesh.run().n_cells > MOST_WITH_EDGES:
        return {}
    return {"show_edges": True, "edge_color": DARK, "edge_opacity": FAINT}


def _with_isolines(case: Case, drawing: Drawing) -> Drawing:
    """Return a drawing of smooth values on a solid with isolines at the numbers of the bar.

    Others are returned as they are: where isolines would be short or close, and other surfaces,
    which would lose their shape.
    """
    array, mesh, (bar,) = case.needed_array, drawing.layers[0].mesh, drawing.keys
    table = bar.get("cmap")
    is_log = getattr(table.run() if isinstance(table, Step) else table, "log_scale", False)
    low, high = bar["clim"]
    levels = [level for level in even_levels(low, high, USUAL) if low < level < high]
    if is_log or not levels:
        return drawing
    factor, _ = meaning.usual_unit(mesh.run(), array.name, max(abs(low), abs(high)))
    values = [float(f"{factor * level:.12g}") for level in levels]
    lines = Step("isolines", ".contour", mesh, values, scalars=array.name)
    curves = lines.run()
    if not curves.n_cells:
        return drawing
    lengths = curves.compute_cell_sizes(area=False, volume=False)["Length"]
    by_piece = np.bincount(curves.connectivity().cell_data["RegionId"], lengths)
    pixel = pixel_of(case, drawing.camera)
    is_smooth = by_piece[by_piece > LONG * pixel].sum() > SMOOTH * by_piece.sum()
    if not is_smooth or mesh.run().area < APART * pixel * by_piece.sum():
        return drawing
    ink = {"color": "black", "line_width": case.width / 2, "lighting": False}
    key = bar | {"title": lines_every(bar["title"], levels)}
    layers = [*drawing.layers, Layer(lines, ink | BESIDE, live=False)]
    return replace(drawing, layers=layers, keys=[key])


def surface(case: Case) -> Drawing:
    """Draw a surface in the light of a question about its shape, with the edges of its elements.

    The walls of a body alone are drawn where the mesh reaches far around it.
    """
    is_solid = case.contents.dimension == 3 and not isinstance(case.data.run(), pv.ImageData)
    inner = Step("walls", "files.walls", case.data)
    if is_solid and case.wishes.surface and inner.run().n_cells:
        drawing = surface(replace(case, data=inner, contents=Contents(inner.run())))
        return replace(drawing, words="walls", notes=[*drawing.notes, ONLY_WALLS])
    mesh = case.surface
    camera = case.camera(mesh)
    light = case.wishes.light_of_surface()
    scene = case.exposed(mesh, camera, **light)
    lit = case.lit(mesh, scene, **light)
    name = case.wishes.part.get("contour")
    words = f"isosurface of {name}" if name else "surface"
    drawn = {"scene": scene, **case.wishes.drawn(light)}
    if is_solid or case.data.path == inner.path:
        drawn |= _edges_of_cells(mesh)
    title = words if name else "; ".join(filter(None, [file_named(mesh), _size_of(case)]))
    if name and case.wishes.part.get("level") is not None:
        level = case.wishes.part["level"]
        title = titled(mesh.run(), name, value=level, sign=", isosurface at")
    keys = _keys(case, scene, title)
    layers = [Layer(mesh, drawn), *case.edges(camera)]
    return Drawing(layers, camera, scene, lit, words, keys, kind=mesh)


def _keys(case: Case, scene: Step, title: str) -> list[Keywords]:
    """Return the key of the light of a shape with a title, none for a room without one."""
    if case.in_room:
        # A room needs no key: everybody has seen things in one.
        return [TITLE_ALONE | {"title": title}] if title else []
    return [{"scene": scene, "title": title}]


def sample(case: Case, array: Named) -> Array:
    """Return some of the finite values of an array of one component."""
    rows: Array = np.asarray(case.data.run()[array.name], dtype=np.float64)
    rows = rows[:: max(len(rows) // MOST_VALUES, 1)]
    return rows[np.isfinite(rows)]


def is_air(values: Array) -> Bools:
    """Return which values are those of air in computed tomography."""
    return np.asarray(np.abs(values - AIR) < NEAR_AIR)


def is_gray(case: Case, array: Named) -> bool:
    """Return whether values are those of a scan of a body in grey, as radiologists print them."""
    values = sample(case, array)
    is_signed = len(values) > 0 and values.min() < -RINGING * values.max()
    return bool(is_air(values).any()) if is_signed else case.is_of_body


def _are_steps(rows: Raw) -> bool:
    """Return whether numbers are multiples of one step, as those of a scanner by its scale."""
    some = rows[:: max(len(rows) // SAMPLE, 1)]
    steps = np.diff(np.unique(some[np.isfinite(some)]).astype(np.float64))
    parts = steps / steps.min(initial=np.inf)
    is_even = np.abs(parts - np.round(parts)) < ROUNDING
    return bool(len(parts) and is_even.all() and parts.sum() <= WHITE[-1])


def _size_of(case: Case) -> str:
    """Return the sizes of the box of a part that is alone, with their unit if one is known."""
    is_alone = case.in_room and case.wishes.frame is None
    if not is_alone or case.on_globe or brains.hemisphere(case.surface.run()):
        return ""
    unit = georeference.unit_of(case.data.run())
    words = meaning.written(unit) if meaning.metres(unit) else ""
    sizes = case.surface.run().bounds_size
    return f"size {' × '.join(f'{size:.4g}' for size in sizes)} {words}".rstrip()


def plane(case: Case) -> Drawing:
    """Draw a plane without data, which no light can shape: grey, with the edges of its cells.

    An array with one value is the title.

    Sizes of cells are shown, near most of the cells, where many differ.
    """
    mesh = case.surface
    drawn: Keywords = {"color": LIGHT_GREY} | _edges_of_cells(mesh)
    if mesh.run().n_cells > MOST_WITH_EDGES:
        sized = Step("sized", ".compute_cell_sizes", mesh, length=False, volume=False)
        areas = np.asarray(sized.run()["Area"])
        low, median, high = map(float, np.quantile(areas, (0, 0.5, 1)))
        if 0 < low < high / GRADED:
            is_far = bool(areas[areas <= median].sum() < FAR_FIELD * areas.sum())
            fine = Step("fine", ".threshold", sized, (low, median), scalars="Area")
            colors = colors_in(Range(low, high, logarithmic=True), LIGHTNESS)
            frame = case.camera(fine if is_far else mesh)
            wishes = replace(case.wishes, frame=frame, picture=colors | dict(case.wishes.picture))
            sizes = replace(case, data=sized, contents=Contents(sized.run()), wishes=wishes)
            drawing = values(replace(sizes, array=sizes.contents.named("Area"), question="none"))
            return replace(
                drawing,
                words="plane in the colours of the areas of its cells",
                keys=[key | {"title": "Area of cells"} for key in drawing.keys],
                notes=["the lesser half of the cells fills the picture"] * is_far,
            )
    camera = case.camera(mesh)
    scene = case.wishes.scene("none", camera)
    border = Step("borders", "files.borders", mesh)
    outline = case.strokes([border] if border.run().n_cells else [])
    layers = [Layer(mesh, {"scene": scene} | drawn), *outline]
    constants = case.contents.constants.items()
    title = ", ".join(
        titled(case.data.run(), name, value=value)
        for name, value in constants
        if value is not None and not is_of_kinds(name)
    )
    title = title or file_named(mesh)
    keys = [TITLE_ALONE | {"title": title}] if title else ()
    return Drawing(layers, camera, scene, case.lit(mesh, scene), "plane", keys=keys)


def fur(case: Case) -> Drawing:
    """Draw a surface covered with fibres."""
    mesh = case.surface
    keywords: Keywords = {"feature_angle": "auto"} | dict(case.wishes.light)
    camera = case.camera(_tips(mesh, keywords.get("length")), case.eye(mesh))
    scene = case.wishes.scene("fur", camera)
    lit = case.wishes.step("furry", "fur", mesh, scene, **keywords)
    return Drawing(
        [Layer(lit)], camera, scene, lit, "surface with fur", parts=("fibres", "skin"),
        name=str(keywords.get("name", "luminance")),
    )  # fmt: skip


def contours(case: Case) -> Drawing:
    """Draw the bands of equal luminance of a surface."""
    mesh = case.surface
    camera = case.camera(mesh)
    scene = case.wishes.scene("contours", camera)
    keywords: Keywords = {"feature_angle": "auto"} | dict(case.wishes.light)
    lit = case.wishes.step("lit", "isoluminance", mesh, scene, **keywords)
    name = str(keywords.get("name", "luminance"))
    bands = unlit(Step("", "[]", lit, "bands"), scene, name)
    words = "bands of equal luminance"
    return Drawing(
        [bands], camera, scene, lit, words, parts=("bands", "contours"), name=name
    )  # fmt: skip


def projection(case: Case) -> Drawing:
    """Draw a mesh of n-space, projected to 3-space and lit before or after."""
    mesh, light = case.data, dict(case.wishes.light)
    rows = mesh.run().point_data.get(light.get("positions", POSITION))
    # Light after the projection is in the space of the picture.
    n = 3 if light.get("light") == "after" or rows is None or rows.ndim == 1 else rows.shape[1]
    scene = case.wishes.scene_in(n)
    lit = case.wishes.step("projected", "project", mesh, **light, scene=scene)
    camera = case.camera(lit)
    name = str(light.get("name", "luminance"))
    layer = unlit(lit, scene, name)
    return Drawing([layer], camera, scene, lit, "projection", kind=lit, name=name)


def _tips(mesh: Step, length: object) -> Step:
    """Return the step that moves the points of a surface to where straight fur ends."""
    skin: pv.PolyData = blocks.surface(mesh.run(), "mesh")
    tip = LENGTH * skin.length
    if isinstance(length, str):
        has_lengths = length in skin.point_data and skin.n_points
        tip = float(skin.point_data[length].max()) if has_lengths else 0.0
    elif isinstance(length, int | float):
        tip = float(length)
    normals = Step("", ".compute_normals", mesh, auto_orient_normals=True, cell_normals=False)
    return Step("tips", ".warp_by_vector", normals, "Normals", factor=tip)


def _inside(case: Case, array: Named, kinds: Sequence[float]) -> Step | None:
    """Return the step that leaves out the only visible kind, None if no other is inside."""
    ends = (kinds[0] - 0.5, kinds[0] + 0.5)
    # Cells that have a point of the kind go too.
    inner = Step("inside", ".threshold", case.data, ends, scalars=array.name, invert=True)
    left = inner.run()
    return inner if left.n_cells and kinds[0] not in kinds_of(left, array.name) else None


def _of_labels(case: Case, array: Named) -> Step | None:
    """Return the step that takes the surface of the labels of an image, without its ground, 0."""
    grid, contents = case.data.run(), case.contents
    fills = contents.dimension == 3 and contents.flat_axis is None and array.low == 0 and array.high
    if not fills or not isinstance(grid, pv.ImageData) or grid[array.name].dtype.kind not in "iu":
        return None
    return Step("surface", "files.surface_of", case.data, labels=array.name)


def _is_of_single_points(case: Case, array: Named) -> bool:
    """Return whether most values of a flat grid are at no cell with values at all its corners."""
    mesh = case.data.run()
    sizes = [size for size in reversed(dimensions(mesh)) if size > 1]
    if array.of_cells or array.role != "values" or len(sizes) != 2:
        return False
    finite = np.isfinite(np.asarray(mesh.point_data[array.name])).reshape(sizes)
    seen = scipy.ndimage.binary_opening(finite, np.ones((2, 2), dtype=np.bool_))
    return bool(seen.sum() < finite.sum() / 2)


def _by_corner(case: Case, array: Named) -> Step:
    """Return the step that takes a surface, with the labels of the nearest points on its cells."""
    surface = case.surface
    if array.of_cells or array.name not in surface.run().point_data:
        return surface
    return Step("surface", "files.surface_of", surface, labels=array.name)
