"""Mutations: put one wrong sign, exponent or term into a copy of the package, and see what fails.

``python tests/mutations.py [WORD ...]`` copies the package and breaks one line of the copy at a
time. For MUTATIONS it runs the picture tests and, where no picture differs, the tests of the broken
module; for OF_NUMBERS the tests of the module alone. It prints the tests that failed and ends with
exit code 1 if a mutation passed them all. Words select the mutations whose titles contain all of
them. A run takes minutes, so it is no part of the test suite; ``test_mutations.py`` checks that
each line to break is still there.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
PICTURES = ["tests/test_pictures.py"]

#: What the pictures show: file, text in it, replacement.
MUTATIONS = {
    "Phong: sign of wo's tangential part (the slip of Banks' equation 2)": (
        "shading/terms.py",
        "eye.along, strict=True))\n            return formulas.phong(along, ",
        "eye.along, strict=True))\n            return formulas.phong(_square(lit.along), ",
    ),
    "Phong: normal parts added": (
        "model/formulas.py", "apart = sine_i - sine_o", "apart = sine_i + sine_o",
    ),
    "Phong on a surface: half of the deficit": (
        "model/formulas.py", "deficit = 0.5 * (along", "deficit = 1.0 * (along",
    ),
    "Blinn: power halved": (
        "model/formulas.py", "power(across * scale, along * scale, 0.5 * shininess)",
        "power(across * scale, along * scale, 0.25 * shininess)",
    ),
    "Blinn, one half vector: power halved": (
        "shading/terms.py", "formulas.power(_side(plan, up), None, h.shininess)",
        "formulas.power(_side(plan, up), None, h.shininess / 2)",
    ),
    "diffuse: cosine to the tangent for the sine": (
        "shading/terms.py", "return Split(x, along, rest, sqrt(w.dot(rest, rest)))",
        "return Split(x, along, rest, sqrt(formulas.maximum(1 - w.dot(rest, rest), 0)))",
    ),
    "diffuse on a surface: not clamped": (
        "shading/terms.py", "if plan.two_sided else formulas.one_side(cosine)",
        "if plan.two_sided else formulas.both_sides(cosine)",
    ),
    "diffuse: no compensation": (
        "model/brightness.py", "def exponent(k: int, n: int) -> float:",
        "def exponent(k: int, n: int) -> float:\n    return 1.0\n\n\n"
        "def _unused(k: int, n: int) -> float:",
    ),
    "compensation: half the codimension": (
        "model/brightness.py", "a, d, h = (n - k) / 2,", "a, d, h = (n - k) / 4,",
    ),
    "highlight: on the dark side too": (
        "shading/terms.py",
        "return value if plan.two_sided else formulas.lit_highlight(value, lit.size)",
        "return value",
    ),
    "distance: no linear term": (
        "model/formulas.py", "distance * (linear + distance * quadratic)",
        "distance * (distance * quadratic)",
    ),
    "distance: d in place of its square": (
        "model/formulas.py", "distance * (linear + distance * quadratic)",
        "distance * (linear + quadratic)",
    ),
    "depth cue: front and back exchanged": (
        "model/formulas.py", "t = clamp((depth - back) / (front - back), 0.0, 1.0)",
        "t = clamp((depth - front) / (back - front), 0.0, 1.0)",
    ),
    "depth cue: smooth step's 3 a 2": (
        "model/formulas.py", "3.0 - 2.0 * u", "2.0 - u",
    ),
    "fur: path times the sine": ("model/formulas.py", "height / sine", "height * sine"),
    "fur: density in place of 1 - density": (
        "model/falloff.py", "np.log1p(-density)", "np.log(density)",
    ),
    "exact line: alpha for pi - alpha": (
        "model/formulas.py", "arctan2(cross, -dot)", "arctan2(cross, dot)",
    ),
    "exact line: sine's term is missing": (
        "model/formulas.py", "-dot) * dot + cross)", "-dot) * dot)",
    ),
    "exact line: highlight without its ends": (
        "model/formulas.py", "cos_b * integrals + ends", "cos_b * integrals",
    ),
    "turn in n-space: wrong way round": (
        "geometry/nspace/projection.py", "matrix[j, i] = math.sin(angle)",
        "matrix[j, i] = -math.sin(angle)",
    ),
    "perspective in n-space: sign of the depth": (
        "geometry/nspace/projection.py", "(1 - image[..., -1] / distance)",
        "(1 + image[..., -1] / distance)",
    ),
    "cos-theta: r / d (the slip of its section 3)": (
        "geometry/relief/shadowing.py", "np.divide(depth, t, out=t)",
        "np.divide(t, 2 * t.max(), out=t)",
    ),
    "cos-theta: out of the ground in place of into it": (
        "geometry/relief/shadowing.py", "place - inset * normal", "place + inset * normal",
    ),
    "light 5 % too bright": (
        "model/formulas.py", "return power(sine * sine, along, 0.5 * exponent)",
        "return 1.05 * power(sine * sine, along, 0.5 * exponent)",
    ),
}  # fmt: skip

#: What no picture is needed for.
OF_NUMBERS = {
    "Phong in numbers: sign of wo's tangential part": (
        "shading/terms.py",
        "eye.along, strict=True))\n            return formulas.phong(along, ",
        "eye.along, strict=True))\n            return formulas.phong(_square(lit.along), ",
    ),
    "half vector: tangential parts subtracted": (
        "shading/terms.py", "split(w, lit.vector + eye.vector, self.rows)",
        "split(w, lit.vector - eye.vector, self.rows)",
    ),
    "fur of cylinders: the skin's own model is lost": (
        "filters/fur.py", "options.shading.for_surface()", "options.shading",
    ),
    "streamlines: the part across the surface added": (
        "filters/streamlines.py", "array - np.einsum", "array + np.einsum",
    ),
    "streamlines: forward alone": (
        "mesh/tracers.py", "SetIntegrationDirectionToBoth()",
        "SetIntegrationDirectionToForward()",
    ),
    "streamlines: seeds on one edge of each triangle": (
        "mesh/tracers.py", "Places(face, weights.astype(np.float64))",
        "Places(face, weights * (1.0, 1.0, 0.0))",
    ),
    "streamlines: lit by their chords": (
        "filters/streamlines.py", "made, tangents=tangents, conditioned",
        "made, tangents=None, conditioned",
    ),
    "line fields: vertices are not aligned": (
        "geometry/lines/tracing.py", "np.where(turned[:, :, np.newaxis], -corners, corners)",
        "corners",
    ),
    "camera: up is not set": ("pictures/cameras.py", "    camera.up = tuple(upward)\n", ""),
    "camera: fitted with another up": (
        "pictures/cameras.py", "right = np.cross(up, toward)",
        "right = np.cross((0.1, 1.0, 0.2), toward)",
    ),
    "camera: clipping range is VTK's own": (
        "pictures/cameras.py", "    camera.clipping_range = (", "    _ = (",
    ),
    "camera: clipped at the centre": (
        "pictures/cameras.py", "(max(distance - 2 * radius, distance * 1e-3)", "(max(distance, 0)",
    ),
    "camera: clipped behind the centre": (
        "pictures/cameras.py", "distance * 1e-3), distance + 2 * radius)",
        "distance * 1e-3), distance)",
    ),
    "surface: Bezier's control points taken as nodes": (
        "reading/hull.py",
        "np.where(off <= 1e-5 * np.abs(skin).max(initial=0), ids, -1)", "ids",
    ),
    "between: tangents added whatever their signs": (
        "verify/between.py", "best = np.argmax(scores, axis=0)", "best = np.zeros(m, int)",
    ),
    "between: no random places in the second half of a cell": (
        "verify/between.py", "turned = (rest.sum(axis=1) > 1.5)", "turned = (rest.sum(axis=1) > 9)",
    ),
    "refinement: no place where a highlight peaks in a triangle": (
        "mesh/refining.py", "tried += self.between.peaks(self.cells.corners[cells])", "pass",
    ),
    "refinement: twins get numbers of their own": (
        "mesh/splitting.py", "_, twin = np.unique(edge[first], return_inverse=True)",
        "twin = np.arange(len(first))",
    ),
    "report: no time": ("verify/report.py", "made.seconds += time.perf_counter() - start", "pass"),
    "report: the check counted as time": (
        "verify/report.py", "active.seconds -= time.perf_counter() - start", "pass",
    ),
}  # fmt: skip


def tests_of(path: str) -> list[str]:
    """Return the test files that mirror a file of the package; else those of its folder."""
    file = ROOT / "tests" / path
    own = sorted(file.parent.glob(f"test_{file.stem}*.py")) or [file.parent]
    return [str(found.relative_to(ROOT)) for found in own]


def failed(folder: Path, tests: list[str]) -> list[str]:
    """Return the names of the tests that fail on a copy."""
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-rfE", "--tb=no", *tests],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": f"{folder}{os.pathsep}{folder / 'tests'}"},
        capture_output=True,
        text=True,
        check=False,
    )
    if run.returncode not in (0, 1):
        sys.exit(run.stdout + run.stderr)
    return re.findall(r"^(?:FAILED|ERROR) \S*?([\w/]+\.py::\S+)", run.stdout, re.MULTILINE)


def main() -> int:
    """Break, run, print."""
    escaped = 0
    with tempfile.TemporaryDirectory() as name:
        copy = Path(name) / "copy"
        for folder in ("vizlight", "tests", "datasets"):
            shutil.copytree(ROOT / folder, copy / folder)
        for file in ("pyproject.toml", "README.md"):
            shutil.copy(ROOT / file, copy)
        chosen = {
            title: mutation
            for title, mutation in (MUTATIONS | OF_NUMBERS).items()
            if all(word in title for word in sys.argv[1:])
        }
        whole = {test for path, _, _ in chosen.values() for test in tests_of(path)}
        if chosen.keys() & MUTATIONS.keys():
            whole.update(PICTURES)
        if found := failed(copy, sorted(whole)):
            sys.exit(f"these fail without a mutation: {found}")
        for title, (path, old, new) in chosen.items():
            file = copy / "vizlight" / path
            text = file.read_text()
            if text.count(old) < 1:
                sys.exit(f"{title}: {path} does not hold {old!r}")
            file.write_text(text.replace(old, new))
            caught = title in MUTATIONS and failed(copy, PICTURES)
            caught = caught or failed(copy, tests_of(path))
            file.write_text(text)
            escaped += not caught
            tests = dict.fromkeys(re.split(r"::|\[", name)[1] for name in caught or ())
            names = ", ".join(tests) or "NOTHING"
            print(f"{title}\n    {names}", flush=True)  # noqa: T201
    print(f"{len(chosen) - escaped} of {len(chosen)} caught")  # noqa: T201
    return 1 if escaped else 0


if __name__ == "__main__":
    sys.exit(main())
