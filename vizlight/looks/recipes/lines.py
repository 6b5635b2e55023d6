"""Recipes of lines and points: by their heading or in the colours of values."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv
import scipy

from vizlight.draw.margins import ink_on
from vizlight.draw.ticks import USUAL, even_levels
from vizlight.filters.tint import RGB
from vizlight.looks.contents import Contents
from vizlight.looks.framing import eye_across, eye_on_body
from vizlight.looks.recipes import surfaces
from vizlight.looks.recipes.drawing import (
    LIGHTNESS,
    ONLY,
    Drawing,
    Layer,
    colors_of_kinds,
    file_named,
    named,
    titled_length,
)
from vizlight.looks.recipes.fields import bar_of_lengths, colors_of_lengths, pixel_of
from vizlight.looks.steps import Step
from vizlight.looks.wishes import even_light
from vizlight.mesh import meaning
from vizlight.model import kernels
from vizlight.reading import molecules, neurons
from vizlight.vtk.cells import connectivity

if TYPE_CHECKING:
    from collections.abc import Callable

    from vizlight._types import Array, Keywords
    from vizlight.looks.recipes.drawing import Case

#: Name that stands for the direction of lines among the arrays that colour a picture.
DIRECTION = "direction"

#: Colours of lines along x, y and z, of which those of others are mixed: red, green and blue as in
#: tractography, but muted, so that light on them tells their form.
OF_AXES = {0: "#e8503e", 1: "#3fb257", 2: "#4a72ee"}

#: Least width of lines in widths of the thinnest, their largest in pixels, and the share of a
#: picture that they may fill.
THINNEST, WIDEST, COVERED = 1.7, 6.0, 0.08
#: Width of the halo of a wide line, in widths of the thinnest.
BAND = 1.5
#: Side of the squares in which lines are crowded, in widths of the thinnest, and the share of them
#: that they may fill.
SQUARE, CROWDED = 8.0, 0.5
#: Length of lines in such a square, in its sides, from which they are a mat without crossings.
MATTED = 48.0
#: Least and largest size of points in pixels, and the share of a picture that they may fill.
POINT_SIZES, FILLED = (3.0, 20.0), 0.15
#: Size of the points of a map in distances of neighbours, and most points whose neighbours are
#: looked for.
TOUCHING, MOST_ASKED = 1.6, 2000
#: Size of the points of a surface in their distance, and the largest one in pixels; most points for
#: which it is looked for, and ratios of the distances of the 16th and the 4th neighbour on a
#: surface: it is 2 on a plane, 1.6 in a volume, 4 on a line.
CLOSED, LARGEST, MOST_CLOSED, ON_SURFACE = 1.3, 24.0, 300_000, (1.75, 2.6)
#: The two neighbours, each point being its own first one.
NEIGHBOURS = (5, 17)
#: Length of arrows as a share of the size of the data, and their form.
LONG_ARROW = 0.03
ARROW = {"tip_length": 0.4, "tip_radius": 0.18, "shaft_radius": 0.06}
#: Most atoms of a molecule that are balls, their size in radii of van der Waals, and the sticks
#: between them, in angstroms.
MOST_BALLS, BALL, STICK = 1000, 0.2, {"radius": 0.1, "n_sides": 20}
#: Most lines of a dense set that are shown by their direction, and the colour around dense ones.
MOST_LINES, OUTLINE = 7000, "black"
#: Most atoms without bonds that are balls, and the size of these, which touch each other.
MOST_ALONE, BALL_ALONE = 20_000, 0.5
#: Size of atoms and sticks beside the chains of a large molecule, in that of others.
BESIDE_CHAINS = 1.5
#: Share of a bar of residues that is free between the number at an end and the next.
CLOSE = 0.05
#: Atoms up to whose number balls are large in a picture, and as much finer.
FEW_BALLS, FINER = 60, 3
#: Size in pixels of balls up to which they are squares on a map.
SMALL_BALL = 6.0


def lines(case: Case) -> Drawing:
    """Draw lines lit by their heading or in the colours of their direction, or of values.

    Values are drawn without light, so that lightness tells them too: hues alone are hard to see on
    thin lines. Of a molecule water is left out.
    """
    dry = _without_water(lines, case)
    if dry is not None:
        return dry
    mesh = case.data
    if case.is_of_body:
        case = replace(case, viewpoint=eye_on_body(mesh.run()))
    elif is_tree(mesh.run()) and case.contents.flat_axis is None:
        case = replace(case, viewpoint=eye_across(mesh.run()))
    camera = case.camera(mesh)
    scene = case.scene(camera)
    light = dict(case.wishes.light)
    keys: list[Keywords] = [{"scene": scene}]
    name, array = case.wishes.picture.get("scalars"), case.array
    is_open = name is None and case.wishes.question == "auto" and array is None
    if is_open and (case.is_beside or case.is_of_earth):
        # Borders on a map, or edges and paths beside solids, whose direction tells nothing.
        color = ink_on(pv.Color(case.wishes.background)) if case.is_beside else ONLY
        layer = Layer(mesh, {"scene": even_light(camera), "color": color, **_pen(case, camera)})
        title = "" if case.is_beside else file_named(mesh)
        keys = [surfaces.TITLE_ALONE | {"title": title}] if title else []
        lit = case.lit(mesh, scene, **light)
        return Drawing([layer], camera, scene, lit, "lines", keys, kind=case.data)
    if is_open or name == DIRECTION:
        lit = case.lit(mesh, scene, **light)
        mesh, camera, pen = _longest(case, camera)
        is_round = pen.get("render_lines_as_tubes", False)
        lamp = case.wishes.scene("lamp", camera) if is_round else even_light(camera)
        shown = {"scene": lamp, "scalars": RGB, "rgb": True} | pen
        layer = Layer(_by_direction(case.lit(mesh, even_light(camera))), shown)
        words_of_axes = dict(enumerate(meaning.ways(mesh.run())))
        table = Step("", "vizlight.maps.kinds", words_of_axes, colors=OF_AXES)
        key: Keywords = {"question": "value", "cmap": table}
        of_all = f"the longest {mesh.run().n_cells} of {case.data.run().n_cells} lines"
        title = f"direction of {'lines' if mesh is case.data else of_all}"
        # Alone in its picture, a file needs no name.
        name = "" if case.wishes.frame is None else file_named(case.data)
        key["title"] = named(name, title)
        words = "lines by their direction"
        notes = [] if mesh is case.data else [mesh.note]
        return Drawing([layer], camera, scene, lit, words, [key], notes, kind=case.data)
    drawn: Keywords = {"scene": scene, **_pen(case, camera), **case.wishes.drawn(light)}
    words, note = "lines by their heading", ""
    if case.question == "value":
        array = case.needed_array
        is_vector = array.role == "vectors"
        if is_vector:
            colors, note = colors_of_lengths(case, mesh, case.map_on_ground)
        elif array.role == "kinds":
            colors = colors_of_kinds(mesh, array, case.wishes.colors)
            if not array.of_cells:
                mesh = Step("halves", "files.surface_of", mesh, labels=array.name)
        else:
            colors, note = case.ranged_of(mesh, array, case.map_on_ground)
        scene = case.wishes.scene("none", camera)
        drawn |= {"scene": scene, "scalars": array.name, "show_scalar_bar": False, **colors}
        bar = bar_of_lengths(mesh, array.name, colors) if is_vector else case.bar(array, colors)
        keys = [bar | {"scene": scene}]
        words = f"lines in the colours of {'the length of ' * is_vector}{array.name}"
    lit = case.lit(case.data, scene, **light)
    notes = [note] if note else []
    layers = [Layer(mesh, drawn), *_somas(case)]
    return Drawing(layers, camera, scene, lit, words, keys, notes, kind=case.data)


def _longest(case: Case, camera: Step) -> tuple[Step, Step, Keywords]:
    """Return the step that takes the longest of too many lines, or all, its camera and its pen.

    Short lines hide the bundles that long ones form.
    """
    mesh: pv.DataSet = case.data.run()
    if mesh.n_cells <= MOST_LINES:
        return case.data, camera, _pen(case, camera, can_be_round=True)
    lengths = mesh.compute_cell_sizes(area=False, volume=False)["Length"]
    least = float(f"{np.partition(lengths, -MOST_LINES)[-MOST_LINES]:.3g}")
    sized = Step("sized", ".compute_cell_sizes", case.data, area=False, volume=False)
    longest = Step("longest", ".threshold", sized, least, scalars="Length")
    longest = Step("longest", ".extract_surface", longest, algorithm="dataset_surface")
    longest.note = f"lines of {least:g} and longer are shown"
    closer = case.camera(longest)
    pen = _pen(replace(case, data=longest), closer, can_be_round=True)
    # Where a part is dense all are, which takes longer to measure.
    if not _is_dense(pen):
        of_all = _pen(case, camera, can_be_round=True)
        if not _is_dense(of_all):
            return case.data, camera, of_all
    return longest, closer, pen


def is_tree(mesh: pv.DataSet) -> bool:
    """Return whether lines are the branches of a tree, such as a neuron."""
    return isinstance(mesh, pv.PolyData) and neurons.PATH_LENGTH in mesh.point_data


def _somas(case: Case) -> list[Layer]:
    """Return the layer of a ball at each point of a cell body, none where all points are of one."""
    mesh = case.data.run()
    bodies = np.asarray(mesh.point_data.get("type", ())) == neurons.SOMA
    if not is_tree(mesh) or not bodies.any() or bodies.all():
        return []
    ends = (neurons.SOMA - 0.5, neurons.SOMA + 0.5)
    points = Step("", ".cast_to_poly_points", case.data)
    of_body = Step("", ".threshold", points, ends, scalars="type")
    ball = Step("", "pyvista.Sphere", radius=1.0)
    balls = Step("soma", ".glyph", of_body, orient=False, scale="radius", factor=1.0, geom=ball)
    return [case.inked(balls)]


def is_molecule(mesh: pv.DataSet) -> bool:
    """Return whether a mesh is a molecule, with few enough atoms for balls, and sticks if any."""
    arrays = mesh.point_data
    kinds = {"atom_type", molecules.RESIDUE} & set(arrays)
    is_one = isinstance(mesh, pv.PolyData) and "radius" in arrays and bool(kinds)
    if not is_one or np.ndim(arrays["radius"]) != 1:
        return False
    return mesh.n_points <= (MOST_BALLS if mesh.n_lines else MOST_ALONE)


def molecule(case: Case, size: float = 1.0) -> Drawing:
    """Draw the atoms of a molecule as balls, and its bonds as sticks, in the colours of values.

    Balls and sticks are larger than usual by the factor ``size``.
    """
    array, atoms = case.needed_array, case.data
    if array.name == "radius":
        # Balls have it as their size alone.
        return lines(case)
    dry = _without_water(partial(molecule, size=size), case)
    if dry is not None:
        return dry
    bonds = atoms
    if array.role == "kinds":
        bonds = Step("halves", "files.surface_of", atoms, labels=array.name)
    count, has_bonds = atoms.run().n_points, bool(atoms.run().n_lines)
    finer = FINER if count <= FEW_BALLS else 1
    corners = (24 * finer, 16 * finer) if count <= MOST_BALLS else (12, 8)
    fine = {"theta_resolution": corners[0], "phi_resolution": corners[1]}
    ball = Step("", "pyvista.Sphere", radius=1, **fine)
    factor = BALL * size if has_bonds or size != 1 else BALL_ALONE
    balls = Step("balls", ".glyph", atoms, orient=False, scale="radius", factor=factor, geom=ball)
    solid = balls
    if has_bonds:
        stick = {"radius": STICK["radius"] * size, "n_sides": STICK["n_sides"] * finer}
        solid = Step("molecule", ".append_polydata", balls, Step("", ".tube", bonds, **stick))
    wishes = case.wishes
    if case.contents.flat_axis == 2 and wishes.view is None and wishes.frame is None:
        # A formula is read from above.
        wishes = replace(wishes, view="above")
    balls_and_sticks = replace(case, data=solid, contents=Contents(solid.run()), wishes=wishes)
    cell = _cell(atoms)
    if cell is not None and wishes.frame is None:
        both = Step("", "pyvista.MultiBlock", [solid, cell])
        frame = wishes.camera(both, balls_and_sticks.eye(solid))
        balls_and_sticks = replace(balls_and_sticks, wishes=replace(wishes, frame=frame))
    drawing = surfaces.values(balls_and_sticks)
    title = _molecule_named(atoms)
    keys = drawing.keys
    if array.name == "atom_type" and title:
        # Symbols of elements need no title.
        keys = [key | {"title": title} for key in keys]
    return replace(drawing, layers=[*drawing.layers, *case.strokes([cell])], keys=keys)


def _without_water(draw: Callable[[Case], Drawing], case: Case) -> Drawing | None:
    """Draw the atoms beside those of water, None where there are none of either."""
    atoms = case.data
    counts = molecules.beside_chains(atoms.run())
    names = meaning.flags(atoms.run(), molecules.RESIDUE)
    water = [number for number, name in names.items() if name in molecules.WATERS & set(counts)]
    if len(water) != 1 or len(names) == 1:
        return None
    ends, name = (water[0] - 0.5, water[0] + 0.5), names[water[0]]
    dry = Step("dry", ".threshold", atoms, ends, invert=True, scalars=molecules.RESIDUE)
    dry = Step("dry", ".extract_surface", dry, algorithm="dataset_surface")
    drawing = draw(replace(case, data=dry, contents=Contents(dry.run())))
    return replace(drawing, notes=[*drawing.notes, f"left out: {name} ({counts[name]} atoms)"])


def _molecule_named(atoms: Step) -> str:
    """Return the name of a molecule, or that of its file, empty where neither is known."""
    said = meaning.of(atoms.run()).arrays.get("atom_type", {})
    return said.get(molecules.NAME) or file_named(atoms)


def _cell(atoms: Step) -> Step | None:
    """Return the step that makes the edges of the cell of a crystal, None for other atoms."""
    edges = atoms.run().field_data.get(molecules.CELL)
    if edges is None:
        return None
    matrix = np.eye(4)
    matrix[:3, :3] = np.round(np.transpose(edges), 4)
    unit = Step("", ".outline", Step("", "pyvista.Box", (0.0, 1.0) * 3))
    return Step("cell", ".transform", unit, matrix.tolist(), inplace=False)


def backbone(case: Case) -> Drawing:
    """Draw the chains of a molecule as ribbons and tubes, in the colours of values."""
    if case.needed_array.name in ("atom_type", "radius"):
        # Of these the atoms beside the backbone have others.
        return lines(case)
    solid, name = Step("chains", "files.backbone", case.data), case.needed_array.name
    if not solid.run().n_points:
        # No two are near enough to each other.
        return lines(case)
    bar: Keywords = {}
    wishes = case.wishes
    ends = [float(end) for end in solid.run().get_data_range(name)]
    if name == "residue" and "clim" not in wishes.colors and ends[0] < ends[1]:
        # There are none beyond the first and the last.
        wishes = replace(wishes, picture={**wishes.picture, "clim": tuple(ends)})
        free = CLOSE * (ends[1] - ends[0])
        inner = even_levels(ends[0] + free, ends[1] - free, USUAL)
        bar["levels"] = [ends[0], *inner, ends[1]]
    chains = replace(case, data=solid, contents=Contents(solid.run()), wishes=wishes)
    chains = replace(chains, viewpoint=eye_across(solid.run()))
    ligands = Step("ligands", "files.ligands", case.data)
    has_ligands = bool(ligands.run().n_points)
    whole = Step("", "pyvista.MultiBlock", [solid, ligands]) if has_ligands else solid
    # A fold is seen from one side, whatever its values are.
    frame = wishes.camera(whole, chains.eye(solid))
    drawing = surfaces.values(replace(chains, wishes=replace(wishes, frame=frame)))
    name_of = _molecule_named(case.data)
    keys = [key | {"title": named(name_of, key["title"])} | bar for key in drawing.keys]
    drawing = replace(drawing, words=f"backbone in the colours of {name}", keys=keys)
    drawing = replace(drawing, notes=[*drawing.notes, *_on_ligands(case.data.run(), ligands.run())])
    return with_molecule(case, drawing, ligands, BESIDE_CHAINS) if has_ligands else drawing


def with_molecule(case: Case, drawing: Drawing, atoms: Step, size: float = 1.0) -> Drawing:
    """Return a drawing with atoms and bonds beside its meshes, in the colours of elements."""
    contents = Contents(atoms.run())
    wishes = replace(case.wishes, frame=drawing.camera, picture={}, light={}, make_scene=None)
    array = contents.named("atom_type")
    beside = replace(case, data=atoms, contents=contents, array=array, wishes=wishes)
    beside_drawing = molecule(beside, size)
    layers = [*drawing.layers, *beside_drawing.layers]
    # Symbols of elements need no title.
    keys = [*drawing.keys, *(key | {"title": ""} for key in beside_drawing.keys)]
    return replace(drawing, layers=layers, keys=keys)


def _on_ligands(atoms: pv.DataSet, ligands: pv.DataSet) -> list[str]:
    """Return notes on the atoms beside chains that are drawn, and on those that are left out."""
    counts, drawn = molecules.beside_chains(atoms), set[str]()
    if ligands.n_points:
        names = meaning.flags(ligands, molecules.RESIDUE)
        drawn = {names[number] for number in set(ligands[molecules.RESIDUE].tolist())}
    notes = []
    for words, chosen in (("beside the chains", drawn), ("left out", set(counts) - drawn)):
        texts = [
            f"{name} ({count} atom{'s' * (count > 1)})"
            for name, count in counts.items()
            if name in chosen
        ]
        notes += [f"{words}: {', '.join(texts)}"] if texts else []
    return notes


def _pen(case: Case, camera: Step, *, can_be_round: bool = False) -> Keywords:
    """Return the width of lines by their spacing, and a dark outline of dense ones.

    Few are wider than many, and so are those that lie apart. Halos of the colour of the ground
    would cut dense ones to pieces, and of a mat outlines would be most: its lines are round.
    """
    mesh: pv.PolyData = case.data.run()
    if case.wishes.picture.get("line_width") or not isinstance(mesh, pv.PolyData):
        return {"line_width": case.width}
    ids, ends = connectivity(mesh.GetLines())
    places = np.asarray(mesh.points, dtype=np.float64)[ids]
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    steps[ends[1:-1] - 1] = 0  # from the end of a line to the next
    columns, rows = case.wishes.size
    length = float(np.nansum(steps)) / (mesh.length or 1.0) * np.hypot(columns, rows)
    widest = COVERED * columns * rows / max(length, 1e-9)
    thinnest = THINNEST * case.width
    side = SQUARE * thinnest
    square = side * pixel_of(case, camera)
    crowd = _crowd(places / square, steps / square, camera)
    widest = min(widest, CROWDED * side / max(crowd, 1e-9))
    if case.contents.flat_axis is not None and case.wishes.frame is None:
        # None is in front.
        width = np.clip(widest, case.width / 2, WIDEST)
        return {"line_width": round(float(width), 1), "halo": False}
    pen: Keywords = {"line_width": round(float(np.clip(widest, thinnest, WIDEST)), 1)}
    if crowd > MATTED and can_be_round:
        return pen | {"halo": False, "render_lines_as_tubes": True}
    if widest < thinnest:
        return pen | {"halo": OUTLINE}
    # The halo of a wide line is as wide as that of a thin one.
    share = BAND * case.width / pen["line_width"]
    return pen | {"halo": round(share, 2)} if share < 1 else pen


def _is_dense(pen: Keywords) -> bool:
    """Return whether lines are drawn as dense ones are."""
    return pen.get("halo") == OUTLINE or "render_lines_as_tubes" in pen


def _crowd(places: Array, lengths: Array, camera: Step) -> float:
    """Return the length of lines in the usual square of the picture.

    Half of the length is in squares that hold more. All lengths are in sides of a square.
    """
    eye = camera.run()
    right = np.cross(eye.direction, eye.up)
    flat = places @ np.stack([right / np.linalg.norm(right), eye.up], axis=1)
    (kept,) = np.nonzero(lengths > 0)
    if not len(kept):
        return 0.0
    # Long segments are in several squares.
    counts = np.ceil(lengths[kept]).astype(np.intp)
    number = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    share = (number + 0.5) / np.repeat(counts, counts)
    first = np.repeat(kept, counts)
    middles = flat[first] + share[:, np.newaxis] * (flat[first + 1] - flat[first])
    column, row = np.floor(middles - middles.min(axis=0)).astype(np.intp).T
    _, square = np.unique(column * (row.max() + 1) + row, return_inverse=True)
    sums = np.bincount(square, np.repeat(lengths[kept] / counts, counts))
    order = np.argsort(sums)
    total = np.cumsum(sums[order])
    return float(sums[order[np.searchsorted(total, total[-1] / 2)]])


def points(case: Case) -> Drawing:
    """Draw points as small balls, or as discs in the colours of values if they have any."""
    mesh = case.data
    camera = case.camera(mesh)
    scene = case.scene(camera)
    # As large as they can be without hiding each other, were they spread over the picture.
    columns, rows = case.wishes.size
    size = np.sqrt(FILLED * columns * rows / max(mesh.run().n_points, 1))
    if case.contents.flat_axis is not None:
        # Those of a map fill it where they are even.
        size = max(size, TOUCHING * _apart(mesh.run()) / pixel_of(case, camera))
    size = float(np.clip(size, *POINT_SIZES))
    if case.contents.flat_axis is None and mesh.run().n_points <= MOST_CLOSED:
        # Those of a surface close it.
        closed = CLOSED * _apart_on_surface(mesh.run()) / pixel_of(case, camera)
        size = max(size, min(closed, LARGEST))
    size = round(size, 1)
    drawn: Keywords = {"point_size": size}
    # Small balls of a map leave gaps between them, which squares do not.
    drawn["render_points_as_spheres"] = case.contents.flat_axis is None or size > SMALL_BALL
    keys: list[Keywords] = []
    words, note = "points", ""
    array = case.array
    if array is not None and array.role == "vectors":
        mesh = case.wishes.joined(mesh, array)
        lengths = kernels.length_rows(mesh.run().point_data[array.name])
        ends = float(np.nanmin(lengths)), float(np.nanmax(lengths))
        colors: Keywords = {"cmap": LIGHTNESS, "clim": ends} | case.wishes.colors
        drawn |= {"scalars": array.name, "show_scalar_bar": False, **colors}
        bar: Keywords = {"question": "value", **colors}
        keys = [bar | {"title": titled_length(mesh.run(), array.name)}]
        words = f"arrows of {array.name} in the colours of its length"
        arrows = _arrows(mesh, array.name, lengths[np.isfinite(lengths)])
        if arrows is not None:
            camera = case.camera(arrows, case.eye(mesh))
            shown = {"scene": even_light(camera), "scalars": "GlyphScale", **colors}
            layer = Layer(arrows, {**shown, "show_scalar_bar": False})
            lit = case.lit(mesh, scene)
            return Drawing([layer], camera, scene, lit, words, keys, kind=mesh)
        words = f"points in the colours of the length of {array.name}"
    elif array is not None:
        drawn |= {"scalars": array.name, "show_scalar_bar": False}
        words = f"points in the colours of {array.name}"
        if array.role == "colors":
            drawn["rgb"] = True
        else:
            colors, note = case.ranged_of(mesh, array, LIGHTNESS)
            if array.role == "kinds":
                colors = colors_of_kinds(mesh, array, case.wishes.colors)
            drawn |= colors
            # No light follows these points, so the key is that of the scene and its colours.
            keys = [case.bar(array, colors) | {"scene": scene}]
    if array is not None:
        # Light on balls would change the colours by which they are read.
        drawn["lighting"] = False
    else:
        # Numbers of points, which may be the active array, are no colours.
        drawn["color"] = ONLY
    lit = case.lit(mesh, scene)
    notes = [note] if note else []
    return Drawing([Layer(mesh, drawn)], camera, scene, lit, words, keys, notes, kind=mesh)


def _arrows(mesh: Step, name: str, lengths: Array) -> Step | None:
    """Return the step that makes arrows along the vectors of points, None where all are 0.

    Points nearer to each other than the length of an arrow share one.
    """
    size = float(mesh.run().length)
    longest = float(np.percentile(lengths, 95)) if lengths.size else 0.0
    if not longest > 0 or not size > 0:
        return None
    factor = float(f"{LONG_ARROW * size / longest:.3g}")
    points = Step("", ".cast_to_poly_points", mesh)
    geometry = Step("", "pyvista.Arrow", **ARROW)
    return Step(
        "arrows", ".glyph", points, orient=name, scale=name, factor=factor,
        tolerance=LONG_ARROW / 1.5, geom=geometry,
    )  # fmt: skip


def _apart(mesh: pv.DataSet) -> float:
    """Return the distance of points that are even, of others twice that of nearest neighbours."""
    points: Array = np.asarray(mesh.points, dtype=np.float64)
    points = np.unique(points[np.isfinite(points).all(axis=1)], axis=0)
    if len(points) < 2:
        return 0.0
    some = points[:: max(len(points) // MOST_ASKED, 1)]
    distances: Array = np.asarray(scipy.spatial.cKDTree(points).query(some, k=2)[0])
    nearest = float(np.median(distances[:, 1]))
    sides = np.sort(np.ptp(points, axis=0))[1:]
    return min(2 * nearest, float(np.sqrt(sides.prod() / len(points))))


def _apart_on_surface(mesh: pv.DataSet) -> float:
    """Return the distance of points that lie on a surface in space, 0 for others."""
    points: Array = np.asarray(mesh.points, dtype=np.float64)
    points = np.unique(points[np.isfinite(points).all(axis=1)], axis=0)
    if len(points) <= NEIGHBOURS[1]:
        return 0.0
    some = points[:: max(len(points) // MOST_ASKED, 1)]
    distances: Array = np.asarray(scipy.spatial.cKDTree(points).query(some, k=[*NEIGHBOURS])[0])
    near, far = np.median(distances, axis=0).tolist()
    on_surface = ON_SURFACE[0] * near < far < ON_SURFACE[1] * near
    # As many points are on a disc of this radius.
    return float(far * np.sqrt(np.pi / NEIGHBOURS[1])) if on_surface else 0.0


def _by_direction(lit: Step) -> Step:
    """Return the step that colours lines by the size of the components of their direction."""
    # Light is mixed, whose root colours are: those of pure red, green and blue are the sizes.
    axes = [[part**2 for part in pv.Color(color).int_rgb] for color in OF_AXES.values()]
    shares = Step("", "numpy.square", Step("", "vizlight.direction_colors", lit))
    rgb = Step("", "numpy.sqrt", Step("", "numpy.matmul", shares, axes))
    # The type, bytes, sets colours apart from vectors.
    return Step("shown", "vizlight.tint", lit, Step("", "numpy.uint8", rgb))
