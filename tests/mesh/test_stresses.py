"""Tests of stresses of solids."""

import numpy as np
import pytest
import pyvista as pv
from scipy.spatial.transform import Rotation

import vizlight
from vizlight import files
from vizlight.mesh.stresses import VON_MISES


def bar(rows, name="S_Centroid"):
    """Bar of two cells with rows of an array of cells."""
    mesh = pv.ImageData(dimensions=(3, 2, 2), spacing=(5, 1, 1)).cast_to_unstructured_grid()
    mesh.cell_data[name] = np.asarray(rows, dtype=float)
    return mesh


def test_tension_is_itself_and_pressure_from_all_sides_is_nothing():
    mesh = files.with_von_mises(bar([[3, 0, 0, 0, 0, 0], [-4, -4, -4, 0, 0, 0]]), "S_Centroid")
    assert mesh[VON_MISES] == pytest.approx([3, 0])
    assert mesh.active_scalars_name == VON_MISES


def test_it_is_the_same_in_every_frame_and_form():
    random = np.random.default_rng(3)
    tensor = random.normal(size=(3, 3))
    tensor += tensor.T
    principal = np.linalg.eigvalsh(tensor)
    expected = np.sqrt(np.sum((principal - np.roll(principal, 1)) ** 2) / 2)
    turn = Rotation.from_rotvec(random.normal(size=3)).as_matrix()
    for each in (tensor, turn @ tensor @ turn.T):
        xx, yy, zz, xy, xz, yz = each[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        for row in ([xx, yy, zz, xy, xz, yz], [xx, yy, zz, yz, xy, xz], each.ravel()):
            got = files.with_von_mises(bar([row] * 2, "stress"), "stress")[VON_MISES]
            assert got == pytest.approx([expected] * 2)
    flat = files.with_von_mises(bar([[xx, yy, zz, xy]] * 2), "S_Centroid")[VON_MISES]
    full = files.with_von_mises(bar([[xx, yy, zz, xy, 0, 0]] * 2), "S_Centroid")[VON_MISES]
    assert flat == pytest.approx(full)


def test_a_solid_with_stresses_shows_them_whatever_moves_it():
    mesh = bar([[1, 0, 0, 0, 0, 0], [2, 0, 0, 0, 0, 0]])
    # Reaction forces and displacements, as a solver of mechanics names them.
    mesh["RF"] = np.random.default_rng(0).normal(size=(mesh.n_points, 3))
    mesh["U"] = mesh["RF"] / 10
    before = mesh.copy()
    look = vizlight.look(mesh)
    assert (look.shown, look.array) == ("hull", VON_MISES)
    assert mesh == before
    assert 'files.with_von_mises(mesh, "S_Centroid")' in look.script("a.png")
    # Who has it, needs no other.
    mesh.cell_data["S_Mises"] = [1.0, 2.0]
    assert vizlight.look(mesh).array == "S_Mises"


@pytest.mark.parametrize(
    ("largest", "factor", "words"),
    [
        (0.5, 1, "; displaced, true to scale"),
        (1e-3, 500, "; displaced 500 times"),
        (50.0, None, ""),
    ],
)
def test_a_solid_with_stresses_is_displaced_so_that_it_is_seen(largest, factor, words):
    mesh = bar([[1, 0, 0, 0, 0, 0], [2, 0, 0, 0, 0, 0]])
    mesh["U"] = np.outer(mesh.points[:, 0] / 10, [0, 0, largest])
    look = vizlight.look(mesh)
    top = 1 + (factor or 0) * largest
    assert look.mesh.bounds[5] == pytest.approx(top)
    assert look.drawing.keys[0]["title"].partition(" stress")[2] == words
    assert sum("displaced by" in note for note in look.notes) == bool(factor)
    # The outline of what it was is around the whole of it.
    outline = [layer.mesh.run() for layer in look.drawing.layers if layer.mesh.name == "outline"]
    assert len(outline) == bool(factor)
    assert all(edges.bounds == mesh.bounds for edges in outline)
    # Who asks for other vectors has these.
    assert vizlight.look(mesh, warp="U", exaggeration=2.0).mesh.bounds[5] == 1 + 2 * largest


@pytest.mark.parametrize(
    ("peaks", "word"), [([0.0], "highest 52,300"), ([0.0, 30.0], ""), ([15.0], "")]
)
def test_a_single_highest_stress_that_has_room_beside_it_is_marked(peaks, word):
    plate = pv.Plane(center=(15, 3, 0), i_size=30, j_size=6, i_resolution=30, j_resolution=6)
    plate.points[:, 2] = np.abs(plate.points[:, 0] - 15) / 10
    far = np.min([np.hypot(*(plate.points[:, :2] - (x, 3)).T) for x in peaks], axis=0)
    plate["S_Mises"] = 52345 * np.exp(-far / 3)
    drawing = vizlight.look(plate, view="z").drawing
    layers = drawing.layers
    assert len(drawing.of_turns.layers) == len(layers) - 2 * bool(word)
    words = [layer.mesh.keywords.get("names") for layer in layers]
    assert ([word] in words) is bool(word)
    spots = [layer.mesh.run() for layer in layers if "point_size" in layer.keywords]
    assert [spot.points[0].tolist() for spot in spots] == [[peaks[0], 3, 1.5]] * bool(word)


def test_edges_of_elements_that_are_too_fine_are_left_out():
    for count, is_drawn in ((20, True), (70, False)):
        ball = pv.Sphere(theta_resolution=count, phi_resolution=count // 2)
        ball["S_Mises"] = ball.points[:, 0]
        layer = vizlight.look(ball, size=(300, 200)).drawing.layers[0]
        assert layer.keywords.get("show_edges", False) is is_drawn


def test_an_array_that_is_no_tensor_is_named():
    mesh = bar([[1.0, 2, 3], [4, 5, 6]], "U")
    with pytest.raises(ValueError, match="name: expected an array of tensors of 4, 6 or 9 columns"):
        files.with_von_mises(mesh, "U")
