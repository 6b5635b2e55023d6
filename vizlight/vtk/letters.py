"""Words as flat triangles, which are drawn wherever a mesh is: in pictures, pages and files."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPath, vtkPolyData
from vtkmodules.vtkFiltersGeneral import vtkContourTriangulator
from vtkmodules.vtkRenderingCore import vtkTextProperty
from vtkmodules.vtkRenderingFreeType import vtkFreeTypeTools

from vizlight._types import Array, Indices
from vizlight.vtk import cells

#: Size of the letters whose outlines VTK gives, in pixels.
SIZE = 100
#: Height of digits in the size of the font.
DIGIT = 0.73
#: Straight steps of a curve of an outline.
STEPS = 4


@lru_cache(maxsize=512)
def triangles(word: str) -> tuple[Array, Indices]:
    """Return the triangles of a word in Arial.

    Corners (N, 2) are x to the right from 0, y up from the line that the letters stand on, in the
    size of the font. Digits are 0.73 high.
    """
    outlines = _outlines(word)
    loops = vtkPolyData()
    points, lines = vtkPoints(), vtkCellArray()
    points.SetDataTypeToDouble()
    for outline in outlines:
        first = points.GetNumberOfPoints()
        for x, y in outline:
            points.InsertNextPoint(x, y, 0.0)
        lines.InsertNextCell(len(outline) + 1)
        for at in (*range(len(outline)), 0):
            lines.InsertCellPoint(first + at)
    loops.SetPoints(points)
    loops.SetLines(lines)
    surface = cells.result(vtkContourTriangulator(), loops)
    corners, _ = cells.connectivity(surface.GetPolys())
    places = cells.as_numpy(surface.GetPoints().GetData())[:, :2] if outlines else np.empty((0, 2))
    # Some points of an outline are corners of no triangle.
    used, ids = np.unique(corners, return_inverse=True)
    return np.asarray(places[used], dtype=np.float64), ids.reshape(-1, 3)


def width(word: str) -> float:
    """Return the width of a word, in the size of its font."""
    points, _ = triangles(word)
    return float(np.ptp(points[:, 0])) if len(points) else 0.0


def union(parts: Sequence[tuple[Array, Indices]]) -> tuple[Array, Indices]:
    """Return several sets of points with their triangles, such as words at their places, as one."""
    starts = np.cumsum([0, *(len(points) for points, _ in parts)])
    ids = [ids + start for (_, ids), start in zip(parts, starts, strict=False)]
    return np.concatenate([points for points, _ in parts]), np.concatenate(ids)


def _outlines(word: str) -> list[Array]:
    """Return the closed outlines of the letters of a word, in the size of the font."""
    flat, codes = _path(word)
    ground = float(_path("H")[0][:, 1].min())
    left = float(flat[:, 0].min()) if len(flat) else 0.0
    flat = (flat - (left, ground)) / SIZE
    outlines: list[list[Array]] = []
    share = np.linspace(0, 1, STEPS + 1)[1:, np.newaxis]
    at = 0
    while at < len(codes):
        if codes[at] == vtkPath.MOVE_TO:
            outlines.append([flat[at : at + 1]])
        elif codes[at] == vtkPath.LINE_TO:
            outlines[-1].append(flat[at : at + 1])
        else:
            degree = 2 if codes[at] == vtkPath.CONIC_CURVE else 3
            # De Casteljau's construction of a Bezier curve.
            rows: list[Array] = [outlines[-1][-1][-1], *flat[at : at + degree]]
            while len(rows) > 1:
                rows = [(1 - share) * a + share * b for a, b in itertools.pairwise(rows)]
            outlines[-1].append(rows[0])
            at += degree - 1
        at += 1
    loops = [np.concatenate(parts) for parts in outlines]
    # The first point is repeated at the end.
    return [loop[:-1] if np.array_equal(loop[0], loop[-1]) else loop for loop in loops]


def _path(word: str) -> tuple[Array, Indices]:
    """Return the control points of a word's outlines in pixels, and the kind of each."""
    style, path = vtkTextProperty(), vtkPath()
    style.SetFontFamilyToArial()
    style.SetFontSize(SIZE)
    # Pixels are points of a font at 72 dots per inch.
    vtkFreeTypeTools.GetInstance().StringToPath(style, word, 72, path)
    if not path.GetNumberOfPoints():
        return np.empty((0, 2)), np.empty(0, dtype=np.intp)
    places = cells.as_numpy(path.GetPoints().GetData())[:, :2]
    return places.astype(np.float64), cells.as_numpy(path.GetCodes()).astype(np.intp).ravel()
