"""Rules: which picture suits which data. One row for each kind of data, the first that fits counts.

To add a row, write its predicate on :class:`Contents`, the question, the roles of the array that it
shows, the recipe of ``recipes`` that draws it, and the words that say why.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from vizlight.looks.contents import TRACED, Contents, Named, Role, kinds_of
from vizlight.looks.recipes import fields, lines, reliefs, surfaces, volumes
from vizlight.looks.recipes.drawing import Recipe
from vizlight.mesh import globes
from vizlight.reading import molecules
from vizlight.vtk.cells import dimensions


@dataclass(frozen=True)
class Rule:
    """One row of the table.

    ``shown`` is the kind of drawing, ``fits`` a predicate on the contents, and ``question`` that of
    the light: a preset, ``"relief"``, or ``"none"`` where nothing bends. ``roles`` are those of the
    array that is shown, the data having at least one; ``why`` is the kind of the data in words.
    """

    shown: str
    fits: Callable[[Contents], bool]
    question: str
    roles: tuple[Role, ...]
    recipe: Recipe
    why: str

    def array(self, contents: Contents) -> Named | None:
        """Return the array that the rule shows of some contents."""
        return contents.first(*self.roles) if self.roles else None

    def holds(self, contents: Contents) -> bool:
        """Return whether the rule fits, and the contents have an array for it."""
        return self.fits(contents) and (not self.roles or self.array(contents) is not None)


def _is_lines(contents: Contents) -> bool:
    return contents.dimension == 1


def _is_traced(contents: Contents) -> bool:
    return _is_lines(contents) and TRACED in contents.mesh.array_names


def _is_one_bundle(contents: Contents) -> bool:
    array = contents.first("values", "heights", "kinds") if _is_lines(contents) else None
    if array is None or array.role != "kinds":
        return False
    return len(kinds_of(contents.mesh, array.name, 1)) == 1


def _is_molecule(contents: Contents) -> bool:
    return lines.is_molecule(contents.mesh)


def _is_polymer(contents: Contents) -> bool:
    return molecules.is_polymer(contents.mesh)


def _is_points(contents: Contents) -> bool:
    return contents.dimension == 0


def _is_flat(contents: Contents) -> bool:
    return contents.flat_axis is not None


def _has_flow(contents: Contents) -> bool:
    return contents.flow is not None


def _is_flat_flow(contents: Contents) -> bool:
    return _is_flat(contents) and _has_flow(contents)


def _is_surface_flow(contents: Contents) -> bool:
    return _is_surface(contents) and _has_flow(contents)


def _is_loaded_surface(contents: Contents) -> bool:
    return (_is_flat(contents) or _is_surface(contents)) and not _has_flow(contents)


def _is_terrain(contents: Contents) -> bool:
    # Shadows are followed over grids.
    return contents.flat_axis == 2 and (contents.raster or bool(dimensions(contents.mesh)))


def _is_globe(contents: Contents) -> bool:
    return contents.dimension == 2 and globes.is_globe(contents.mesh)


def _is_surface(contents: Contents) -> bool:
    return contents.dimension == 2


def _is_volume(contents: Contents) -> bool:
    return contents.dimension == 3


def _is_part(contents: Contents) -> bool:
    return contents.is_part


def _is_loaded(contents: Contents) -> bool:
    return _is_volume(contents) and not _has_flow(contents)


#: The table. Of a question that is given, the first row with that question counts.
RULES = (
    Rule("backbone", _is_polymer, "value", ("kinds", "values"), lines.backbone,
         "a molecule of long chains"),
    Rule("molecule", _is_molecule, "value", ("kinds", "values"), lines.molecule, "a molecule"),
    Rule("lines", _is_traced, "value", ("values", "heights", "kinds", "vectors"), lines.lines,
         "streamlines"),
    Rule("lines", _is_one_bundle, "heading", (), lines.lines, "lines nearly all of one kind"),
    Rule("lines", _is_lines, "value", ("values", "heights", "kinds"), lines.lines,
         "lines with values"),
    Rule("lines", _is_lines, "heading", (), lines.lines, "lines"),
    Rule("points", _is_points, "none", ("values", "heights", "kinds", "colors"), lines.points,
         "points with values"),
    Rule("points", _is_points, "none", ("vectors",), lines.points, "points with vectors"),
    Rule("points", _is_points, "shape", (), lines.points, "points without values"),
    Rule("sheet", _is_flat_flow, "direction", ("vectors",), fields.vectors, "a map with vectors"),
    Rule("sheet", _is_terrain, "relief", ("heights",), reliefs.relief, "a map of heights"),
    Rule("sheet", _is_flat, "none", ("values", "heights", "kinds", "colors"), surfaces.values,
         "a map of values"),
    Rule("surface", _is_surface_flow, "direction", ("vectors",), fields.vectors,
         "a surface with vectors"),
    Rule("globe", _is_globe, "none", ("values", "heights", "kinds"), surfaces.values,
         "a globe of values"),
    Rule("surface", _is_surface, "value", ("values", "heights", "kinds", "colors"), surfaces.values,
         "a surface with values"),
    Rule("surface", _is_loaded_surface, "value", ("vectors",), fields.lengths,
         "a surface under loads"),
    Rule("sheet", _is_flat, "none", (), surfaces.plane, "a plane without data"),
    Rule("surface", _is_surface, "shape", (), surfaces.surface, "a surface without data"),
    Rule("hull", _is_part, "value", ("values", "heights", "kinds", "colors"), surfaces.values,
         "a solid part with values"),
    Rule("hull", _is_loaded, "value", ("vectors",), fields.lengths, "a solid under loads"),
    Rule("streamlines", _is_volume, "heading", ("vectors",), fields.flow, "a volume with vectors"),
    Rule("isosurface", _is_volume, "shape", ("values", "heights"), volumes.isosurface,
         "a volume of values"),
    Rule("slices", _is_volume, "value", ("values", "heights"), volumes.slices,
         "a volume of values"),
    Rule("hull", _is_volume, "value", ("kinds", "colors"), surfaces.values,
         "a volume of a few kinds"),
    Rule("hull", _is_volume, "shape", (), surfaces.surface, "a solid without data"),
)  # fmt: skip
