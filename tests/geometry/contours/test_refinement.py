import pytest
import pyvista as pv

import vizlight


def test_new_light_brings_new_steps():
    """A highlight beyond what is seen at first is found as triangles are split."""
    scene = vizlight.Scene(
        lights=vizlight.Light(direction=(-0.909, 0.777, -0.523)),
        material=vizlight.Material(ambient=0, diffuse=0, specular=0.3, shininess=300),
        view=vizlight.View(position=(-3.8688, 9.525, -10.951)),
    )
    frustum = vizlight.Frustum(radii=(0.5, 0.2), height=1)
    assert vizlight.isoluminance(frustum, scene, levels=8)[0].n_cells < 1000


@pytest.mark.slow
def test_contours_that_coincide_at_a_corner_have_no_cells_between():
    scene = vizlight.Scene(lights=vizlight.Light(position=(0.57, -1.64, -1.61)))
    bands = vizlight.isoluminance(pv.Cylinder(resolution=12).clean(), scene)[0]
    assert bands.n_cells < 15_000
