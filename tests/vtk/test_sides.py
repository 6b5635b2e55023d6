"""What the parts of a surface tell, and the whole decides."""

import numpy as np
import pyvista as pv

from vizlight.vtk import sides


def sheet(height):
    """Return a height field of its own."""
    mesh = pv.Plane(center=(0, 0, height), i_resolution=6, j_resolution=6).triangulate()
    mesh.clear_data()
    mesh.points[:, 2] += 0.1 * np.sin(4 * mesh.points[:, 0])
    return mesh


def test_each_height_field_has_a_number_of_its_own():
    """By the number the side is known that shows each of them to the eye."""
    looks = [sides.look(sheet(z), np.zeros(49), None, None) for z in (0.0, 1.0, 2.0)]
    told = sides.decided(looks)
    assert sorted(int(one.number[0]) for one in told) == [2, 3, 4]
    assert all(len(one.averted) == 5 for one in told)


def test_a_closed_surface_has_no_number_and_an_open_one_that_bends_over_has_one():
    ball = pv.Sphere(theta_resolution=12, phi_resolution=12)
    bowl = ball.clip("z", origin=(0, 0, 0.35), invert=True).extract_surface(algorithm="geometry")
    for mesh, number in ((ball, 0), (bowl, 1)):
        mesh.clear_data()
        (told,) = sides.decided([sides.look(mesh, np.zeros(mesh.n_points), None, None)])
        assert told.number.tolist() == [number]
