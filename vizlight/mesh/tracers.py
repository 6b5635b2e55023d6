"""Streamlines of a mesh: by VTK in space, by vizlight itself in triangles and tetrahedra."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkCommonDataModel import vtkDataObject

from vizlight import _check
from vizlight._types import Array, Foreign
from vizlight.geometry.lines import even, fur, tracing
from vizlight.geometry.lines.simplices import CellPlaces, Simplices
from vizlight.geometry.lines.tracing import AT_REST, Curves, Flow, Tracing, trace
from vizlight.mesh import polylines
from vizlight.model import kernels, line_fields

#: Name of the array that is traced, or of the two of a cross field.
Vectors = str | tuple[str, str]
#: Name of the array that is traced; no array of a user has it.
TRACED = "vizlight vectors"
#: Largest number of samples of evenly spaced curves.
MOST_SAMPLES = 20_000_000
#: Largest spacing of curves in a mesh of size 1, in which there is room for one.
MOST_SPACING = 1e6
#: Order of the 6 components of a symmetric tensor in VTK: XX, YY, ZZ, XY, YZ, XZ.
SYMMETRIC = [[0, 3, 5], [3, 1, 4], [5, 4, 2]]


def principal_directions(rows: Array) -> Array:
    """Return first eigenvectors of tensors of 6 or 9 components; zero where none is first."""
    if rows.shape[1] == 9:
        tensors = rows.reshape(-1, 3, 3)
        # Only of a symmetric tensor the eigenvectors are sure to be real and at right angles: of a
        # gradient of velocity it is the rate of strain.
        tensors = (tensors + np.swapaxes(tensors, 1, 2)) / 2
    else:
        tensors = rows[:, SYMMETRIC]
    return line_fields.principal(tensors)[0][:, 0]


def in_space(
    mesh: pv.DataSet, seeds: Array, how: Tracing, report: Callable[[int], None]
) -> pv.PolyData:
    """Return the streamlines of the point array TRACED, one line per seed that leaves it.

    ``report`` takes the share that is done, out of 100.
    """
    from vtkmodules.vtkFiltersFlowPaths import vtkStreamTracer

    tracer = vtkStreamTracer()
    tracer.SetInputDataObject(mesh)
    tracer.SetSourceData(pv.PolyData(seeds))
    points = vtkDataObject.FIELD_ASSOCIATION_POINTS
    # By name: the active vectors of the mesh may be others.
    tracer.SetInputArrayToProcess(0, 0, 0, points, TRACED)
    tracer.SetIntegratorTypeToRungeKutta45()
    tracer.SetIntegrationDirectionToBoth()
    # In VTK a cell is as long as the diagonal of its bounding box.
    tracer.SetIntegrationStepUnit(vtkStreamTracer.CELL_LENGTH_UNIT)
    tracer.SetInitialIntegrationStep(how.step)
    # The method chooses its steps by an estimate of the error, within these bounds.
    tracer.SetMaximumIntegrationStep(how.step)
    tracer.SetMinimumIntegrationStep(min(0.01, how.step))
    tracer.SetMaximumNumberOfSteps(how.max_steps)
    # Always in the unit of the points, whatever unit the steps have.
    tracer.SetMaximumPropagation(how.max_length)
    # The vectors have a median length of 1 and the mesh has size 1: speed and error are relative.
    tracer.SetTerminalSpeed(1e-6)
    tracer.SetMaximumError(1e-6)
    # Vorticity serves ribbons; it would cost a derivative at each point and be one more array.
    tracer.SetComputeVorticity(False)
    tracer.AddObserver(vtkCommand.ProgressEvent, lambda *_: report(int(100 * tracer.GetProgress())))
    tracer.Update()
    lines: Foreign = pv.wrap(tracer.GetOutput())
    # Cut before they are joined: each half still begins at its seed, on whose side it is kept.
    return polylines.joined_at_seeds(polylines.before_turning_back(lines))


class CellTracer:
    """Curves in the triangles of a surface or the tetrahedra of a volume.

    The point array TRACED of 6 components is a cross field; vectors of a ``line_field`` have no
    sign.
    """

    def __init__(
        self, mesh: pv.PolyData | pv.UnstructuredGrid, normals: str | None, *, line_field: bool
    ) -> None:
        self.mesh = mesh
        if isinstance(mesh, pv.UnstructuredGrid):
            ids = mesh.cells_dict.get(np.uint8(pv.CellType.TETRA))
            cells = np.empty((0, 4), dtype=int) if ids is None else np.asarray(ids)
        else:
            cells = np.asarray(mesh.regular_faces)
        points = np.asarray(mesh.points, dtype=np.float64)
        rows: Array = np.asarray(mesh.point_data[TRACED])
        self.sheets = rows.shape[1] // 3
        if self.sheets == 2:
            # On the two sheets over the mesh a cross field is a line field (QuadCover).
            self.cells, rows = tracing.double_cover(points, cells, rows.reshape(-1, 2, 3))
        else:
            self.cells = Simplices(points, cells)
        upright = None if normals is None else self._rows(normals).astype(np.float64)
        self.flow = Flow(self.cells, rows, line_field=line_field, normals=upright)

    def _rows(self, name: str) -> Array:
        """Return a point array, on each sheet."""
        array = np.asarray(self.mesh.point_data[name])
        return array if self.sheets == 1 else np.concatenate([array, array])

    def located(self, points: Array) -> CellPlaces:
        """Return places: the closest on a surface; in a volume only those inside.

        On two sheets each point has two places, one after the other.
        """
        if isinstance(self.mesh, pv.PolyData):
            closest: Foreign = self.mesh.find_closest_cell(points, return_closest_point=True)  # type: ignore[arg-type]
            cell, points = np.atleast_1d(closest[0]), np.atleast_2d(closest[1])
        else:
            cell = np.atleast_1d(self.mesh.find_containing_cell(points))  # type: ignore[arg-type]
        inside = np.repeat(np.flatnonzero(cell >= 0), self.sheets)
        sheet = np.arange(len(inside)) % self.sheets
        # Cell i + M of the double cover lies on cell i, on the other sheet.
        on = cell[inside] + sheet * (len(self.cells.cells) // self.sheets)
        return self.cells.locate(on, points[inside])

    def random(self, count: int, seed: int) -> CellPlaces:
        """Return random places, uniform in area or volume."""
        if self.cells.k == 3:
            return self.cells.random(count, np.random.default_rng(seed))
        # On a surface one place in each of equal areas along a Hilbert curve, as for roots of fur.
        face, weights = fur.seeds(self.cells.points, self.cells.cells, count, seed=seed)
        return CellPlaces(face, weights.astype(np.float64))

    def traced(
        self, seeds: CellPlaces, how: Tracing, wanted: int | None, report: Callable[[int], None]
    ) -> Curves:
        """Return curves through seeds; where some fail others are drawn, up to ``wanted`` curves.

        ``report`` takes the share that is done, out of 100.
        """
        curves, tried = None, 0
        while True:
            # Curves grow at both ends, and each end is counted when it stops.
            total = max(2 * len(seeds.cell), 1)
            new = trace(
                self.flow,
                seeds,
                how,
                report=lambda done, total=total: report(100 * done // total),  # type: ignore[misc]
            )
            curves = new if curves is None else curves.joined(new)
            missing = 0 if wanted is None else wanted - (len(curves.offsets) - 1)
            tried += 1
            # In a field that is at rest nearly everywhere the number would never be reached.
            if missing <= 0 or tried == 10:
                return curves if wanted is None else curves.first(wanted)
            # Twice as many as are missing, since some will fail, and by another seed, as the last
            # failed.
            seeds = self.random(2 * missing, how.seed + tried)

    def even(
        self, seeds: CellPlaces | None, how: Tracing, spacing: float, report: Callable[[int], None]
    ) -> tuple[Curves, int]:
        """Return evenly spaced curves, and the number of closed ones; ``report`` as for traced."""
        total = even.place_count(self.flow, spacing)
        return even.evenly_spaced(
            self.flow, spacing, how, seeds=seeds, report=lambda done: report(100 * done // total)
        )

    def lines(self, curves: Curves, unsigned: Vectors | None = None) -> pv.PolyData:
        """Return curves as polylines with the point arrays of the mesh, TRACED of length 1.

        Vectors without sign, of the array ``unsigned``, are interpolated with the signs of the
        direction of the curve. A cross field's arrays, without order, are left out.
        """
        lines = polylines.polydata(self.cells.positions(curves.places), curves.offsets)
        if not lines.n_points:
            return lines
        for name, array in self.mesh.point_data.items():
            if isinstance(unsigned, tuple) and name in unsigned:
                continue
            # Tensors have no sign to be chosen: they are interpolated like any other array.
            if name == unsigned and np.shape(array)[1:] == (3,):
                rows = self._along(np.asarray(array), curves)
            else:
                rows = self.cells.interpolated(self._rows(name), curves.places)
            kind = array.dtype if array.dtype.kind == "f" else np.float64
            lines.point_data[name] = rows.astype(kind)
        # Interpolated without a regard to signs they would cancel in a line field.
        lines.point_data[TRACED] = curves.along
        return lines

    def _along(self, vectors: Array, curves: Curves) -> Array:
        """Return vectors at the places of curves; in each cell they are turned along the curve."""
        corners = np.asarray(vectors, dtype=np.float64)[self.cells.cells[curves.places.cell]]
        against = np.einsum("nij,nj->ni", corners, curves.along) < 0
        # A vector against the curve is turned over by the sign of its weight.
        weights = np.where(against, -curves.places.weights, curves.places.weights)
        return np.asarray(np.einsum("ni,nij->nj", weights, corners))


def check_spacing(tracer: CellTracer, spacing: float, size: float) -> None:
    """Refuse a spacing that gives more curves than memory holds, or is beyond the mesh."""
    k = tracer.cells.k
    # All curves are extent / spacing^(k - 1) long, with a number of samples on each spacing of
    # that.
    least = (tracer.cells.extent * even.SAMPLES / MOST_SAMPLES) ** (1 / k)
    if not least <= spacing <= MOST_SPACING:
        # The mesh has size 1 here; messages are in the unit of the user.
        ends = f"from {size * least:.3g} to {size * MOST_SPACING:.3g}"
        expected = f"a number {ends} for a mesh of this size"
        raise _check.value_error("spacing", expected, f"{size * spacing:.3g}")


def scaled(mesh: pv.DataSet, vectors: Array) -> pv.DataSet:
    """Attach vectors as TRACED, scaled to a median length of 1, zero where they are not finite.

    Below a millionth of that a line has come to rest. Vectors of a cross field, shape (N, 6), get
    length 1 or, below a millionth, 0.
    """
    array: Array = np.array(vectors, dtype=np.float64).reshape(-1, 3)
    array[~np.all(np.isfinite(array), axis=1)] = 0
    speed = kernels.length(np.ascontiguousarray(array.T))
    moving = speed[(speed > 0) & np.isfinite(speed)]
    # The median, since a few huge vectors, as beside a singularity, must not bring all others to
    # rest.
    scale = float(np.median(moving)) if len(moving) else 1.0
    # Within these bounds squares of outliers do not overflow.
    array = np.clip(array / scale, -1e30, 1e30)
    if vectors.shape[1] == 6:
        array[speed <= AT_REST * scale] = 0
        array = kernels.unit_rows(array)
    mesh.point_data[TRACED] = array.reshape(vectors.shape)
    return mesh
