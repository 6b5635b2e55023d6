"""Files of several times: which step is read, and what is said of it."""

import foam
import numpy as np
import pytest
import pyvista as pv
from refusals import read_warned
from vtkmodules.vtkIOParallel import vtkEnSightWriter

import vizlight
from vizlight.reading import series


def swirl(time, middles):
    """Return a flow that is at rest at time 0, and its speed."""
    x, y, _ = (middles - 0.5).T
    flow = time * np.stack([-y, x, 0.1 + 0 * x], axis=1)
    return {"U": flow, "p": np.linalg.norm(flow, axis=1)}


@pytest.fixture
def case(tmp_path):
    return foam.write(tmp_path / "case", [0, 0.5, 2], swirl)


def pvd(folder):
    """Write a series of three files with its index."""
    rows = []
    for i, time in enumerate((0, 0.5, 2)):
        mesh = pv.ImageData(dimensions=(3, 3, 3))
        mesh["p"] = np.full(27, float(time))
        mesh.save(folder / f"a{i}.vti")
        rows.append(f'<DataSet timestep="{time}" part="0" file="a{i}.vti"/>')
    path = folder / "a.pvd"
    path.write_text(
        '<VTKFile type="Collection" version="0.1"><Collection>'
        f"{''.join(rows)}</Collection></VTKFile>"
    )
    return path


def netcdf(folder):
    xarray = pytest.importorskip("xarray")
    values = np.multiply.outer([0, 0.5, 2], np.ones((3, 4)))
    path = folder / "a.nc"
    axes = {"time": [0, 0.5, 2], "lat": [1.0, 2, 3], "lon": [1.0, 2, 3, 4]}
    xarray.Dataset({"p": (("time", "lat", "lon"), values)}, coords=axes).to_netcdf(
        path, engine="scipy"
    )
    return path


def ensight(folder):
    writer = vtkEnSightWriter()
    writer.SetFileName(str(folder / "a"))
    for i, time in enumerate((0, 0.5, 2)):
        mesh = pv.ImageData(dimensions=(3, 3, 3)).cast_to_structured_grid()
        mesh = mesh.cast_to_unstructured_grid()
        mesh["p"] = np.full(27, time, np.float32)
        # The writer asks for the number of the part.
        mesh.cell_data["BlockId"] = np.ones(mesh.n_cells, np.int32)
        writer.SetTimeStep(i)
        writer.SetInputData(mesh)
        writer.Write()
    writer.WriteCaseFile(3)
    path = folder / "a.0.case"
    text = path.read_text().replace("0.000000 1.000000 2.000000", "0 0.5 2")
    path.write_text(text.replace(" p_n ", " p "))
    return path


@pytest.mark.sampled(5)
@pytest.mark.parametrize("make", [pvd, netcdf, ensight])
@pytest.mark.parametrize(
    ("asked", "time"),
    [(None, 2), ("last", 2), ("first", 0), (0.5, 0.5), ("0.5", 0.5), (1, 0.5), (-3, 0), (2, 2)],
)
def test_a_step_is_read_by_its_time_or_its_index(make, asked, time, tmp_path):
    mesh = vizlight.read(make(tmp_path), time=asked)
    assert mesh.field_data["TimeValue"][0] == time
    assert series.of(mesh) == [0, 0.5, 2]
    assert mesh["p"].max() == time


def test_a_time_that_is_not_there_is_an_error_with_those_that_are(tmp_path):
    path = pvd(tmp_path)
    for asked in (0.7, 3, -4, "soon", np.nan):
        with pytest.raises(ValueError, match="time: expected a time of a step, 0, 0.5, 2, "):
            vizlight.read(path, time=asked)
    with pytest.raises(ValueError, match=r"got 1\.6; the nearest is 2$"):
        vizlight.read(path, time=1.6)


def test_a_file_without_steps_is_opened_once(calls_of, tmp_path):
    pv.Sphere().save(tmp_path / "ball.vtp")
    opened = calls_of(pv, "get_reader")
    assert vizlight.read(tmp_path / "ball.vtp") == pv.Sphere()
    assert len(opened) == 1


def test_a_time_of_a_file_without_steps_is_refused(tmp_path):
    pv.Sphere().save(tmp_path / "a.vtp")
    assert vizlight.read(tmp_path / "a.vtp", time="last").n_points
    with pytest.raises(
        series.NoStepError, match=r"time: expected a file of several .*, got 'a.vtp'"
    ):
        vizlight.read(tmp_path / "a.vtp", time=3)


def test_the_last_step_of_a_case_has_its_fields_at_the_points(case):
    mesh = vizlight.read(case)
    assert series.of(mesh) == [0, 0.5, 2]
    assert mesh.point_data["U"].shape == (125, 3)
    assert np.abs(mesh.point_data["U"]).max() > 0.5
    assert vizlight.streamlines(mesh, seeds=5).n_lines  # of its only vectors


def test_a_case_in_parts_of_processors_is_read(case):
    folder = case.parent
    (folder / "processor0").mkdir()
    for part in ("constant", "0", "0.5", "2"):
        (folder / part).rename(folder / "processor0" / part)
    (folder / "constant").mkdir()
    assert vizlight.read(case).n_points == 125


@pytest.mark.sampled(2)
@pytest.mark.parametrize("marked", [True, False])
def test_the_folder_of_a_case_is_read_as_its_file(marked, case):
    expected = vizlight.read(case, time=0.5)
    if not marked:
        case.unlink()
    assert vizlight.read(case.parent, time=0.5) == expected
    assert vizlight.look(case.parent).drawing.words == vizlight.look(expected).drawing.words


def test_a_directive_that_vtk_does_not_read_is_no_damage(tmp_path):
    case = foam.write(tmp_path / "case", [1], swirl, before='speed #calc "2*3";\n')
    mesh = read_warned(case, r"fields that are left out.*U' \(#calc\).*-expand")
    assert mesh.n_points == 125
    assert "U" not in mesh.point_data
