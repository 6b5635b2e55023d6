"""The engine against one point at a time in 50 digits, and against its own laws."""

import functools
import os
import platform
import subprocess
import sys

import numpy as np
import oracles
import pytest
from lamps import SHINY, shiny
from refusals import refusals

from studies import peak_memory
from vizlight import DepthCue, Light, Material, Scene, View, _pool, engine

SUN = Light(direction=(1, 2, 0.5))
LAMP = Light(position=(0.5, 4, 2), intensity=0.7, attenuation=(0.5, 0.2, 0.05), color="red")
NEAR = View(position=(0, 1, 6))
FAR = View(direction=(0.2, -0.1, 1))
WHITE = Material(ambient=0.1, diffuse=1.0, specular=1.0, shininess=20)

SCENES = {
    "sun, far eye": Scene(lights=SUN, view=FAR, material=WHITE),
    "sun, near eye": Scene(lights=SUN, view=NEAR, material=WHITE),
    "lamp, near eye": Scene(lights=LAMP, view=NEAR, material=WHITE),
    "lamp, far eye": Scene(lights=LAMP, view=FAR, material=WHITE),
    "headlights": Scene(lights=[Light.headlight()], view=NEAR, material=WHITE),
    "three lights, colours": Scene(
        lights=[SUN, LAMP, Light.headlight(intensity=0.3, color=(0, 1, 0.5))],
        view=NEAR,
        material=shiny(color=(1, 0.25, 0.3), specular_color=(0.9, 0.9, 1), shininess=7.5),
        ambient_intensity=0.5,
        ambient_color=(0.2, 0.3, 0.9),
    ),
    "depth cue": Scene(
        lights=SUN,
        view=View(position=(0, 1, 6), direction=(0, 0.1, 1)),
        material=WHITE,
        depth_cue=DepthCue(front=3, back=9, front_scale=0.9, back_scale=0.2, cue=0.4),
    ),
    "smooth depth cue, colours": Scene(
        lights=LAMP,
        view=NEAR,
        depth_cue=DepthCue(front=4, back=8, cue=0.5, color=(0.5, 0.6, 1), smooth=True),
        material=SHINY,
    ),
    "parallel depth cue": Scene(
        lights=SUN, view=FAR, material=WHITE, depth_cue=DepthCue(front=-2, back=2)
    ),
}


def cloud(random, count, dtype, k=1, n=3):
    points = random.standard_normal((count, n)).astype(dtype)
    tangents = random.standard_normal((count, k, n)).astype(dtype)
    normals = random.standard_normal((count, n)).astype(dtype)
    return points, tangents, normals


def test_shadow_takes_the_place_of_the_cosine(random):
    """Where normals condition tangents; of the lights that have an intensity."""
    points, tangents, normals = random.standard_normal((3, 50, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    dark = Light(direction=(0, 0, 1), intensity=0)
    scene = Scene(lights=[SUN, dark, LAMP], view=NEAR, material=WHITE)
    way = np.array(LAMP.position) - points
    toward = np.array(SUN.direction) / np.linalg.norm(SUN.direction)
    cosine = np.sum(normals * way, axis=1) / np.linalg.norm(way, axis=1)
    cosine = np.stack([normals @ toward, cosine], axis=1)
    bare = engine.shade(points, tangents, scene, normals=normals)
    # The cosine itself changes nothing; half of it halves all but the ambient light.
    for share in (1, 0.5):
        same = np.maximum(cosine, 0) * share
        fibre = engine.shade(points, tangents, scene, normals=normals, shadow=same)
        expected = bare.ambient + share * (bare.luminance - bare.ambient)
        np.testing.assert_allclose(fibre.luminance, expected, atol=1e-12)


def test_bad_shadow(random):
    points, normals = random.standard_normal((2, 5, 3))
    scene = Scene(lights=SUN, view=NEAR, material=SHINY)
    with pytest.raises(ValueError, match=r"shadow: expected shape \(5, 1\), normals, got shape"):
        engine.shade(points, None, scene, normals=normals, shadow=np.ones((5, 2)))
    with pytest.raises(ValueError, match="shadow: .* got no normals"):
        engine.shade(points, normals, scene, shadow=np.ones((5, 1)))
    t = np.array([[1.0], [0.5], [np.nan], [0.5], [0.5]])
    lit = engine.shade(points, None, scene, normals=normals, shadow=t)
    assert lit.invalid == 1
    assert np.all(np.isfinite(lit.luminance))


def test_bad_depth(random):
    points, tangents, normals = cloud(random, 4, float)
    scene = SCENES["sun, far eye"]
    for options in ({"fur_height": np.ones(4)}, {"fur": 0.5}):
        with pytest.raises(ValueError, match="fur_height: expected fur_height and fur= together"):
            engine.shade(points, tangents, scene, normals=normals, **options)
    with pytest.raises(ValueError, match=r"fur_height: expected shape \(4,\)"):
        engine.shade(points, tangents, scene, normals=normals, fur=0.5, fur_height=np.ones(3))
    shaded = engine.shade(
        points, tangents, scene, normals=normals, fur=0.5, fur_height=[1.0, -1.0, np.nan, 0.0]
    )
    np.testing.assert_array_equal(shaded.valid, [True, False, False, True])
    assert np.isfinite(shaded.luminance).all()


def test_blocks_and_threads_change_nothing(dtype, random):
    points, tangents, normals = cloud(random, 1003, dtype)
    scene = SCENES["three lights, colours"]
    light = functools.partial(engine.shade, points, tangents, scene, normals=normals)
    with _pool.threads(1):
        whole = light(components=True)
    for block, threads in [(1, 2), (7, 1), (100, 3), (1002, 2), (5000, 4)]:
        with _pool.threads(threads):
            parts = light(block=block, components=True)
        for name in ("luminance", "diffuse", "specular", "rgb", "valid"):
            np.testing.assert_allclose(
                getattr(parts, name), getattr(whole, name), atol=8 * oracles.eps(dtype)
            )


def test_dependent_tangents_are_invalid(dtype):
    tangents = np.array([[[1, 0, 0], [2, 0, 0]], [[1, 0, 0], [0, 1, 0]]], dtype=dtype)
    shaded = engine.shade(np.zeros((2, 3), dtype), tangents, SCENES["sun, far eye"])
    np.testing.assert_array_equal(shaded.valid, [False, True])


def test_an_eye_on_the_point(dtype):
    """At d = 0 an eye has no direction: there is no highlight, and nothing breaks."""
    points = np.array([[0, 0, 0], [1, 0, 0]], dtype=dtype)
    tangents = np.array([[0, 1, 0], [0, 1, 0]], dtype=dtype)
    scene = Scene(lights=SUN, view=View(position=(0, 0, 0)), material=SHINY)
    eye = engine.shade(points, tangents, scene, components=True)
    assert eye.valid.all()
    assert eye.specular[0] == 0
    assert eye.diffuse[0] > 0


def test_a_light_on_the_point_is_dark_in_any_dimension():
    """With p(1, 60) = 175 the power is taken through the deficit, which is 0 for no direction."""
    points, tangents = np.zeros((1, 60)), np.eye(60)[:1]
    scene = Scene(
        lights=Light(position=np.zeros(60)), view=View(position=np.ones(60)), material=SHINY
    )
    shaded = engine.shade(points, tangents, scene, components=True)
    assert shaded.plan.exponent > 128
    assert (shaded.diffuse[0], shaded.specular[0]) == (0, 0)


@pytest.mark.parametrize("count", [0, 1])
def test_no_point_and_one_point(count, dtype):
    shaded = engine.shade(
        np.zeros((count, 3), dtype), np.ones((count, 3), dtype), SCENES["depth cue"]
    )
    assert shaded.luminance.shape == (count,)
    assert shaded.valid.shape == (count,)


def test_memory_beyond_the_output_does_not_grow(random):
    points, tangents, _ = cloud(random, 240_000, np.float32)
    scene = SCENES["lamp, near eye"]

    def extra(count, threads):
        def work():
            with _pool.threads(threads):
                engine.shade(points[:count], tangents[:count], scene, block=2000)

        # Luminance, validity, rgb. What other threads of the process allocate is counted too.
        return min(peak_memory(work) for _ in range(3)) - count * (4 + 1 + 12)

    small, large = extra(15_000, 1), extra(240_000, 1)
    assert large - small < 225_000 / 2  # no array of a byte for each point
    assert small < 40 * 2000 * 12
    # How far threads overlap differs from run to run; twice one thread is the most.
    assert extra(240_000, 2) < 2.5 * small + 225_000 / 2


@pytest.mark.parametrize("asked", ["0", "two", "-1", "1.5"])
def test_a_number_of_threads_that_is_none(asked, monkeypatch):
    monkeypatch.setenv("VIZLIGHT_THREADS", asked)
    with pytest.raises(ValueError, match="VIZLIGHT_THREADS: expected an integer of at least 1"):
        engine.shade(ONES, ONES, SCENES["sun, far eye"])


def test_progress_reaches_the_end(random):
    points, tangents, _ = cloud(random, 95, float)
    for threads in (1, 2):
        seen = []
        with _pool.threads(threads):
            engine.shade(
                points,
                tangents,
                SCENES["sun, far eye"],
                block=10,
                progress=lambda done, total, seen=seen: seen.append((done, total)),
            )
        assert seen == [(min(10 * i, 95), 95) for i in range(1, 11)]


def test_an_error_in_a_block_comes_out():
    class Broken:
        shape, dtype = (50, 3), np.dtype(float)

        def __getitem__(self, rows):
            raise OSError("the disk is gone")

    with _pool.threads(2), pytest.raises(OSError, match="the disk is gone"):
        engine.shade(Broken(), np.ones((50, 3)), SCENES["lamp, near eye"], block=5)


def test_types_decide_the_precision(random):
    points, tangents, _ = cloud(random, 4, np.float32)
    scene = SCENES["sun, far eye"]
    assert engine.shade(points, tangents, scene).luminance.dtype == np.float32
    assert engine.shade(points.astype(float), tangents, scene).luminance.dtype == np.float32
    assert engine.shade(points, tangents.astype(float), scene).luminance.dtype == np.float64
    assert engine.shade(points, tangents.astype(np.float16), scene).luminance.dtype == np.float32
    assert engine.shade(points, np.ones((4, 3), int), scene).luminance.dtype == np.float64


def test_depth_range(random):
    points = random.standard_normal((1000, 3))
    points[7] = np.nan
    scene = SCENES["depth cue"]
    near, far = engine.depth_range(points, scene, block=64)
    axis = np.array(scene.view.direction) / np.linalg.norm(scene.view.direction)
    depth = (np.array(scene.view.position) - points) @ axis
    assert (near, far) == (pytest.approx(np.nanmin(depth)), pytest.approx(np.nanmax(depth)))
    assert engine.depth_range(np.empty((0, 3)), scene) == (np.inf, -np.inf)


ONES = np.ones((4, 3))


test_bad_input = refusals(
    lambda arguments, options: engine.shade(*arguments, SCENES["sun, far eye"], **options),
    ((np.ones(3), ONES), {}, r"points: expected shape \(N, n\)"),
    ((ONES, np.ones((4, 5))), {}, r"tangents: expected shape \(4, k, 3\)"),
    ((ONES, np.ones((3, 3))), {}, r"tangents: expected .* got shape \(3, 3\)"),
    ((ONES, np.ones((4, 9))), {}, "tangents: expected .* k < 3"),
    ((ONES, None), {}, "tangents: expected tangents .* or normals .*, got neither"),
    ((ONES, None), {"normals": np.ones((4, 2))}, r"normals: expected shape \(4, 3\)"),
    ((ONES, ONES), {"precision": "half"}, "precision: expected 'float32' or"),
    ((ONES, ONES), {"block": 0}, "block: expected an integer of at least 1"),
    ((ONES, [["a"] * 3] * 4), {}, "tangents: expected real numbers", TypeError),
    ((ONES.astype(complex), ONES), {}, "points: expected real numbers", TypeError),
)


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_points_that_share_a_normal(kind, random):
    """As if each row of tangents and normals stood there once for each of its points."""
    points = random.standard_normal((300, 3)).astype(kind)
    tangents, normals = random.standard_normal((2, 100, 3)).astype(kind)
    depth = random.random(300).astype(kind)
    lights = [Light(direction=(1, 2, 3)), Light(position=(4, 0, 1), attenuation=(1, 0.1, 0))]
    scene = Scene(lights=lights, view=View(position=(0, 0, 9)), material=SHINY)
    whole = {"normals": np.repeat(normals, 3, axis=0), "fur_height": depth, "fur": 0.3}
    expected = engine.shade(points, np.repeat(tangents, 3, axis=0), scene, **whole)
    shared = {**whole, "normals": normals, "repeat": 3, "block": 7}
    for rows in (tangents, np.repeat(tangents, 3, axis=0)):
        found = engine.shade(points, rows, scene, **shared)
        np.testing.assert_allclose(found.luminance, expected.luminance, rtol=1e-5)
    alone = engine.shade(points, None, scene, normals=normals, repeat=3)
    each = engine.shade(points, None, scene, normals=whole["normals"])
    np.testing.assert_allclose(alone.luminance, each.luminance, rtol=1e-5)
    with pytest.raises(ValueError, match="repeat: expected a divisor of 300 points, got 7"):
        engine.shade(points, tangents, scene, normals=normals, repeat=7)
    with pytest.raises(ValueError, match=r"tangents: expected shape \(100 or 300, k, 3\)"):
        engine.shade(points, tangents[:50], scene, normals=normals, repeat=3)


@pytest.mark.parametrize("role", ["tangents", "normals", "base_tangents", "points"])
def test_masked_rows_are_invalid(role):
    rng = np.random.default_rng(5)
    scene = Scene(lights=Light(position=(1, 2, 3)), material=shiny(specular=0))
    arrays = {name: rng.normal(size=(9, 3)) for name in ("points", "tangents", role)}
    arrays[role] = np.ma.array(arrays[role], mask=np.zeros((9, 3), bool))
    arrays[role][2] = np.ma.masked
    arrays[role][5, 1] = np.ma.masked
    if role == "base_tangents":
        rows = np.ma.concatenate([arrays[role], rng.normal(size=(9, 3))], axis=1)
        arrays[role] = rows
    points, tangents = arrays.pop("points"), arrays.pop("tangents")
    options = {"conditioned": True} if role == "normals" else {}
    lit = engine.shade(points, tangents, scene, **arrays, **options)
    np.testing.assert_array_equal(np.flatnonzero(~lit.valid), [2, 5])
    assert np.isfinite(lit.luminance).all()


@pytest.mark.parametrize("vectors", [np.float32, np.float64])
def test_light_does_not_depend_on_the_unit_of_length(vectors):
    """The same scene in units from 1e-300 to 1e300: float32 work keeps float64 distances."""
    rng = np.random.default_rng(3)
    points, normals = rng.normal(size=(64, 3)), rng.normal(size=(64, 3)).astype(vectors)
    place, eye = np.array([1.0, 2.0, 9.0]), np.array([0.0, 1.0, 8.0])
    limit = 2e-6 if vectors == np.float32 else 1e-13
    base = None
    for exponent in (0, *range(-300, 301, 50), -42, 37, 38):
        unit = 10.0**exponent
        scene = Scene(
            lights=Light(position=unit * place, attenuation=(1, 0.1 / unit, 0)),
            view=View(position=unit * eye),
            material=SHINY,
        )
        lit = engine.shade(points * unit, None, scene, normals=normals)
        base = lit.luminance if base is None else base
        assert lit.valid.all()
        np.testing.assert_allclose(lit.luminance, base, rtol=0, atol=limit)


def test_a_light_nearer_than_float32_resolves_has_a_direction():
    points, normals = np.zeros((1, 3), np.float32), np.float32([[0, 0, 1]])
    scene = Scene(lights=Light(position=(0, 0, 1e-60)), material=shiny(specular=0, ambient=0))
    lit = engine.shade(points, None, scene, normals=normals)
    np.testing.assert_allclose(lit.luminance, scene.material.diffuse)


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="the memory of the GNU C library")
def test_blocks_of_a_new_process_keep_their_memory():
    """The system hands out the pages of temporary arrays once, not once per block."""
    script = """
import resource
import numpy as np
from vizlight import Scene, View, engine
vectors = [np.random.default_rng(7).standard_normal((2_000_000, 3), dtype="f4") for _ in range(2)]
scene = Scene(view=View(position=(0, 0, 9)))
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
engine.shade(*vectors, scene)
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""
    # Dask leaves settings of the library behind, which a process reads when it starts.
    kept = {name: value for name, value in os.environ.items() if not name.startswith("MALLOC_")}
    kept["VIZLIGHT_THREADS"] = "1"
    run = subprocess.run(
        [sys.executable, "-c", script], env={**kept, "VIZLIGHT_FAST": "0"},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    # 2500 pages of output; without the memory kept 78,000 were seen.
    assert int(run.stdout) < 15_000
