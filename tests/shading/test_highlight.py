"""How each highlight is computed."""

import numpy as np
import pytest
from lamps import SHINY, shiny

from vizlight import Light, Scene, View, engine
from vizlight.shading.engine import plan

FAR = View(direction=(0, 0, 1))
SUN, LOW = Light(direction=(1, 1, 1)), Light(direction=(1, 0, -0.7))
NEAR = Light(position=(3, 2, 4))


def test_a_half_vector_of_all_points_needs_no_eye():
    """Blinn's model under a parallel view and a light at infinity."""
    scene = Scene(lights=[SUN, LOW], view=FAR, material=SHINY)
    made = plan(scene, k=1, model="blinn")
    assert all(h.half is not None for h in made.highlights)
    assert not made.splits_eye
    assert "eye: no split per point" in made.explain()
    assert "half vector: one for all points for 2 light(s)" in made.explain()
    assert plan(scene.replace(view=View(position=(0, 0, 9))), k=1, model="blinn").splits_eye


@pytest.mark.parametrize(
    ("scene", "model"),
    [
        (Scene(lights=[NEAR], view=FAR, material=SHINY), "blinn"),
        (Scene(lights=[SUN], view=View(position=(0, 0, 9)), material=SHINY), "blinn"),
        (Scene(lights=[SUN], view=FAR, material=shiny(shininess=1.9)), "blinn"),
        (Scene(lights=[Light(direction=(0, 0, -1))], view=FAR, material=SHINY), "blinn"),
        (Scene(lights=[SUN], view=FAR, material=SHINY), "phong"),
        (Scene(lights=[SUN], view=FAR, material=SHINY), "cylinder"),
    ],
)
def test_no_half_vector_where_it_moves_or_is_none(scene, model):
    assert all(h.half is None for h in plan(scene, k=1, model=model).highlights)


def test_hard_points_of_cylinders(dtype):
    """Zero, NaN and infinite tangents and points, light and eye on a point, along the line."""
    points = np.array(
        [[0, 0, 0], [0, 0, 0], [0, 0, 0], [np.nan, 0, 0], [3, 2, 4], [0, 1, 9], [1, 1, 1],
         [0, 0, 0]]
    ).astype(dtype)  # fmt: skip
    tangents = np.array(
        [[0, 0, 0], [np.nan, 1, 0], [np.inf, 0, 0], [1, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0],
         [0, 1, 9]]
    ).astype(dtype)  # fmt: skip
    scene = Scene(lights=[NEAR, SUN], view=View(position=(0, 1, 9)), material=SHINY)
    for shininess in (0.0, 5.0, 1e6):
        here = scene.replace(material=shiny(shininess=shininess))
        shading = engine.shade(points, tangents, here, model="cylinder")
        assert shading.valid.tolist() == [False] * 4 + [True] * 4
        assert np.isfinite(shading.luminance).all()
        assert shading.luminance[:4] == pytest.approx(0.1)
        assert np.all(shading.luminance[4:] > 0.1)


def test_cylinder_in_words_and_what_it_needs():
    said = plan(Scene(lights=SUN, view=FAR, material=SHINY), k=1, model="cylinder").explain()
    assert "diffuse: Lambert's law averaged over the visible half of a thin cylinder" in said
    assert "specular: cylinder, shininess 20" in said
    dull = Scene(lights=SUN, material=shiny(specular=0))
    assert plan(dull, k=1, model="cylinder").needs_eye
    for options in ({"k": 2}, {"normals": True}, {"k": 1, "n": 4}):
        with pytest.raises(ValueError, match="model: expected lines in 3-space for 'cylinder'"):
            plan(Scene(lights=[], material=SHINY), model="cylinder", **options)
