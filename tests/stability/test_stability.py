"""The stability suite: it passes, its claims are tight, and it can fail."""

import ast
import collections
import itertools
import pathlib
import re
import subprocess
import sys

import numpy as np
import oracles
import pytest
from vectors import unit

import vizlight
from stability import checks, hard, model, suite
from vizlight.model import reflection

COUNT = 120
#: The table of the pages, which ``.venv/bin/python tests/stability`` makes.
KEPT = suite.read(pathlib.Path(__file__).parents[2] / "gallery" / "pages" / "stability.csv")


@pytest.mark.sampled(3)
@pytest.mark.parametrize("kernel", suite.KERNELS)
def test_claims_hold(kernel):
    for dtype in suite.KERNELS[kernel][1]:
        rows = suite.measure(kernel, dtype, COUNT)
        for row in rows:
            assert row.more[""] == "pass", (row.more["case"], row.error, row.parameter)
        assert any(row.error > 0 for row in rows)
        own = [row for row in KEPT.rows if f"{row.way},".startswith(f"{kernel},")]
        kept = {row.way for row in own if row.more["type"] == np.dtype(dtype).name}
        assert {row.way for row in rows} == kept


def test_a_kernel_that_loses_digits_fails(monkeypatch):
    """sqrt(1 - cos^2) in place of the residual is found out along the tangent, and only there."""

    def careless(wi, frame, *, exponent):
        w = wi / np.abs(wi).max(axis=-1, keepdims=True)
        w = w / np.linalg.norm(w, axis=-1, keepdims=True)
        cosine = np.einsum("bkn,bn->bk", np.broadcast_to(frame, (len(w), *frame.shape[-2:])), w)
        return np.sqrt(np.maximum(1 - np.sum(cosine**2, axis=-1), 0)) ** w.dtype.type(exponent)

    monkeypatch.setattr(model.reflection, "diffuse", careless)
    with np.errstate(all="ignore"):
        all_cases = model.diffuse(np.float32, 600, np.random.default_rng(1))
        made = checks.rows_of("careless", np.float32, itertools.islice(all_cases, 60))
    rows = {row.more["case"]: row for row in made if row.way == "careless"}
    assert rows["along the tangent"].more[""] == "FAIL"
    assert rows["across"].more[""] == "pass"
    said = suite.verdict(list(rows.values()))
    assert said.startswith("do not rely on the claims of careless, float32 (")


def test_not_a_number_fails():
    nan = oracles.mp.nan
    for values, true in (([1.0, np.nan], [1, 2]), ([1.0, 2.0], [1, nan]), ([0.0, 0.0], [nan, 1])):
        check = checks.Check("a", np.array(values), true, np.array(5.0))
        (row,) = checks.rows_of("kernel", np.float64, iter([check]))
        assert row.error == np.inf
        assert row.more[""] == "FAIL"


def test_defined_values_are_exact():
    def refuse():
        raise ValueError("radius: no")

    nan = np.nan
    made = [
        checks.exactly("good", [0.0, nan, np.inf], [0.0, nan, np.inf]),
        checks.exactly("off", [0.0, 1.0], [0.0, 1 + 1e-16 + 1e-15]),
        checks.exactly("NaN for 0", [nan], [0.0]),
        checks.exactly("shape", [0.0], [0.0, 0.0]),
        checks.refused("told", refuse, "radius"),
        checks.refused("told of another", refuse, "height"),
        checks.refused("taken", lambda: 0.0, "radius"),
    ]
    rows = checks.rows_of("kernel", np.float64, iter(made))
    said = {row.more["case"]: row.more[""] for row in rows}
    assert {case for case, word in said.items() if word == "pass"} == {"good", "told"}


def test_a_claim_of_more_than_the_result_shows_no_tightness():
    """An error of half the claim does not make it tight where any number is within it."""
    check = checks.Check("a", np.array([1.0]), [0.5], np.array(1 / oracles.eps(float)))
    (row,) = checks.rows_of("kernel", np.float64, iter([check]))
    assert (row.more[""], row.more["seen / claimed"]) == ("pass", 0)
    assert suite.loosest([row])["kernel", "float64"] == np.inf


def test_every_kernel_has_ten_thousand_inputs():
    """Counted without the oracle: how many inputs each case would have."""
    rows = suite.measure("falloff.fur", np.float32, suite.INPUTS)
    assert sum(row.more["inputs"] for row in rows) >= 10_000
    assert len(suite.steps(True)) == sum(len(t) for _, t in suite.KERNELS.values())


def test_the_kept_table_is_whole():
    """It is of a full run, of these kernels and of the claims that a sample finds, and passes."""
    inputs = collections.Counter()
    for row in KEPT.rows:
        assert row.more[""] == "pass"
        (kernel,) = (k for k in suite.KERNELS if f"{row.way},".startswith(f"{k},"))
        inputs[kernel, row.more["type"]] += int(row.more["inputs"])
    types = {(k, np.dtype(t).name) for k, (_, known) in suite.KERNELS.items() for t in known}
    assert set(inputs) == types
    assert min(inputs.values()) >= 10_000
    assert suite.verdict(KEPT.rows).startswith("rely on the docstrings")


def test_loose_claims_are_named():
    many = suite.ENOUGH
    made = [
        checks.Check("a", np.ones(many), [1 - 1e-15] * many, 9.0),
        checks.Check("a", np.ones(many), [1 - 1e-15] * many, 500.0, "steep"),
    ]
    rows = checks.rows_of("slack", np.float64, iter(made))
    loose = suite.loosest(rows)
    assert loose["slack, steep", "float64"] > 8 > loose["slack", "float64"]
    said = suite.verdict(rows)
    assert "more than 8 times what is seen in their worst case: slack, steep, float64 111" in said
    few = [row._replace(more={**row.more, "inputs": 10}) for row in rows]
    assert "too few inputs to tell how tight" in suite.verdict(few)


def test_hard_directions_are_where_they_say(random):
    frame = hard.frames(random, 200, 2, 4, np.float32)
    for kind, low, high in (("along the tangent", 0, 1e-6), ("one ulp off it", 1e-9, 1e-6)):
        x = unit(hard.directions(random, frame, kind).astype(float))
        sine = np.linalg.norm(
            x - np.einsum("bkn,bk->bn", frame, np.einsum("bkn,bn->bk", frame, x)), axis=1
        )
        assert low <= np.median(sine) < high
    wi = hard.directions(random, frame, "random")
    mirror = hard.eyes(random, wi, frame, "at the mirror")
    value = reflection.specular(wi, mirror, frame, shininess=50)
    np.testing.assert_allclose(value, 1, atol=1e-4)


#: Docstrings that speak of eps and are no claim of the table, and why.
UNTOLD = {
    "manifolds.central_step": "a step, not an error",
    "manifolds.parametric": "of any function: the register of claims has a sine",
}


def claims():
    """Yield module.function for every docstring of model and geometry that speaks of eps."""
    root = pathlib.Path(vizlight.__file__).parent
    for file in sorted([*root.glob("model/*.py"), *root.glob("geometry/**/*.py")]):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                name = f"{file.stem}.{node.name}"
                if re.search(r"\beps\b", ast.get_docstring(node) or ""):
                    yield name


def test_every_claim_is_in_the_table():
    public = {"shadowing": "relief"}
    told = {kernel.partition(",")[0] for kernel in suite.KERNELS}
    found = set(claims())
    assert {"reflection.diffuse", "manifolds.torus", "depth_map.depth_map"} <= found
    for name in found - set(UNTOLD):
        module, _, function = name.partition(".")
        assert f"{public.get(module, module)}.{function}" in told, name
    assert set(UNTOLD) <= found


def test_without_mpmath_it_says_how_to_get_it():
    folder = str(pathlib.Path(__file__).parent)
    code = (
        "import runpy, sys; sys.modules['mpmath'] = None; sys.argv = sys.argv[1:]; "
        "sys.path.insert(0, sys.argv[0]); runpy.run_path(sys.argv[0], run_name='__main__')"
    )
    command = [sys.executable, "-c", code, folder, "--quick"]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 1
    assert "pip install 'vizlight[test]'" in run.stderr
