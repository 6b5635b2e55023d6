"""Tests of neurons of SWC files."""

import numpy as np
import pytest
from refusals import read_warned, refused, saved

import vizlight

ROWS = ["# a comment", "1 1 0 0 0 5 -1", "2 3 1 0 0 1 1", "3 3 2 0 0 1 2", "5 2 0 1 0 2 1"]
NAME = "path length from the root"


@pytest.fixture
def path(tmp_path):
    (tmp_path / "a.swc").write_text("\n".join(ROWS))
    return tmp_path / "a.swc"


def test_a_neuron_has_branches_path_lengths_radii_and_types(path):
    mesh = vizlight.read(path)
    assert mesh.n_points == 4
    assert [cell.point_ids for cell in mesh.cell] == [[0, 1, 2], [0, 3]]
    assert mesh[NAME].tolist() == [0, 1, 2, 1]
    assert mesh["radius"].tolist() == [5, 1, 1, 2]
    assert mesh["type"].dtype == np.int32


def test_several_trees_and_circles(path):
    path.write_text("\n".join([*ROWS[:4], "5 2 0 1 0 2 9", "6 2 0 3 0 2 7", "7 2 0 4 0 2 6"]))
    mesh = read_warned(path, "1 points follow others that are not there")
    assert mesh.n_points == 6
    np.testing.assert_array_equal(mesh[NAME], [0, 1, 2, 0, np.nan, np.nan])
    refused(saved(path, "1 2 3\n"), "3 columns, not the 7 of a neuron")


def test_a_neuron_shows_path_lengths_and_its_soma(path):
    look = vizlight.look(path)
    assert look.summary.startswith(f"lines in the colours of {NAME}")
    branches, soma = look.drawing.layers
    assert branches.keywords["scalars"] == NAME
    assert soma.mesh.run().bounds_size == pytest.approx((10, 10, 10), rel=0.05)
    assert [other.python for other in look.others] == ["array='radius'", "array='type'"]


def test_a_neuron_of_one_type_is_no_soma(path):
    path.write_text("\n".join(" ".join([row[0], "1", row[4:]]) for row in ROWS[1:]))
    assert len(vizlight.look(path).drawing.layers) == 1


def test_a_neuron_lies_across_the_picture(path):
    path.write_text("\n".join([*ROWS, "6 3 1 1 -9 1 2", "7 3 0.5 0 4 1 1"]))
    look = vizlight.look(path)
    right = np.cross(look.view.direction, look.view.up)
    assert abs(right[2]) > 0.9


def test_crowded_branches_are_thin_and_keep_their_gaps(tmp_path):
    rows = ["1 1 0 0 0 1 -1", "2 3 100 0 0 1 1"]
    angles = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    ends = np.column_stack([np.cos(angles), np.sin(angles), 20 * np.cos(3 * angles)])
    rows += [f"{i + 3} 3 {x:.4f} {y:.4f} {z:.4f} 1 1" for i, (x, y, z) in enumerate(ends)]
    (tmp_path / "b.swc").write_text("\n".join(rows))
    layer = vizlight.look(tmp_path / "b.swc").drawing.layers[0]
    assert layer.keywords["halo"] == "black"
    (tmp_path / "c.swc").write_text("\n".join(rows[:2]))
    layer = vizlight.look(tmp_path / "c.swc").drawing.layers[0]
    assert layer.keywords["halo"] is False
    assert layer.keywords["line_width"] == 6
