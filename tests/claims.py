"""Register of claims: every figure that can be false, and what checks it.

``python tests/claims.py --seed 7`` checks all claims on random inputs of the families that they
speak of and prints a table: quote, place, stated, worst found, kept or not. ``--write`` writes the
table of the pages too; ``--only WORD`` takes the rows that have a word.

The rows stand in ``claims.txt``, one a line under the file they are of::

    quote | family | check

The quote is a part of the sentence, so that a sentence that changes breaks its row. A check is

- the name of a function of ``claim_checks.py``, which takes a generator and returns what is stated
  and the worst that is found;
- tests that hold it, ``tests/FILE.py::TEST``, apart by ``; ``, which run with the seed: one
  case of parameters as ``TEST[CASE]``, one of several figures as ``TEST@NAME``;
- ``stability``: bounds on rounding, which ``tests/stability`` checks and :func:`main` does not;
- ``study NAME``: figures that a study prints, times among them, which no test asserts;
- ``once: REASON`` for measurements that no command repeats, ``none: REASON`` for figures that claim
  nothing.
"""

from __future__ import annotations

import argparse
import ast
import csv
import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).resolve().parents[1]
REGISTER = ROOT / "tests" / "claims.txt"
TABLE = ROOT / "gallery" / "pages" / "claims.csv"

#: Files whose sentences are searched for figures.
PLACES = (
    "README.md", "paper.md", "vizlight/**/*.py", "gallery/*.rst", "gallery/plot_*.py",
    "gallery/pages/**/*.rst",
)  # fmt: skip

NUMBER = r"(?<![\w.^/*\[(=-])-?\d[\d,]*(?:\.\d+)?(?:e-?\d+)?(?![\w^])"
#: What makes a number one that claims: a unit of errors, shares, factors, times or memory after it,
#: or a word of bounds before it.
UNITS = (
    "%", "per cent", "eps", "of 255", "ns", "us", "µs", "ms", "s", "seconds", "microseconds",
    "minutes", "kB", "MB", "GB", "bytes", "pixel values", "times", "spacings",
)  # fmt: skip
BOUNDS = (
    "within", "within a factor", "at most", "up to", "less than", "fewer than", "more than",
    "off by", "differs? by", "by up to", "by at most", "errors? (?:of|is|are|was)",
    "errors? (?:is|are|was) (?:at most|below|about)", "below", "some", "about", "nearly", "takes?",
    "factor of", "a mean of", "median of",
)  # fmt: skip
COUNTS = "twice|two|three|four|five|six|seven|eight|nine|ten|twelve|twenty|hundred"
PARTS = "half|thirds?|quarters?|fifths?|tenths?|hundredths?|thousandths?"
FIGURE = re.compile(
    rf"{NUMBER} ?(?:{'|'.join(UNITS)})(?!\w)"
    rf"|\b(?:{'|'.join(BOUNDS)}) {NUMBER}|{NUMBER} (?:to|or) {NUMBER} (?:of|for)\b"
    rf"|\b1/255\b|\b(?:{COUNTS}) times (?:as|the|that|more|their|its)\b"
    rf"|\b(?:most|than|within|leaves|saves) (?:an? |two |three )?(?:{PARTS})\b"
    rf"|\b(?:hundredths|thousandths)\b|\bto {NUMBER}(?: and {NUMBER})? degrees\b",
    re.IGNORECASE,
)
#: Sections of docstrings that say what comes in: their numbers are ranges, defaults and shapes
#: unless a word speaks of errors or costs.
INPUTS = {"Parameters", "Other Parameters", "Attributes", "Raises", "Warns"}
SPOKEN = re.compile(r"\berrors? (?:of|is|are|was)\b|\bwithin \d|\bdiffer|\bms\b|µs|times as|%")
SECTION = re.compile(r"^([A-Z][A-Za-z ]+)\n-{3,}\n", re.MULTILINE)
#: Numbers that claim nothing: defaults, ranges of arguments and ends of scales.
IDLE = re.compile(
    r"default: [^.;]*|\bfrom [\d.e-]+ (?:to|up to|on)\b [\d.e-]*|\b[\d,]+ x [\d,]+(?: x [\d,]+)?"
    r"|\b(?:above|of) [\d.e-]+(?: and)? up to [\d.e]+|\bline \d+|^[A-Z]\w+Error(?:, \w+)* If .*"
    r"|\b(?:below|at most|up to|about|more than|less than) [01]\b(?![.\d]| of \d)|\b0 times\b"
)
#: Folders of kernels whose bounds in eps the stability suite checks, each against 50 digits.
SUITE = ("vizlight/model/", "vizlight/geometry/")
#: Checks that are no code of the register, and what the table says of them.
ELSEWHERE = {"study": "study", "once": "once", "stability": "stability", "none": ""}


class Claim(NamedTuple):
    """One row of the register."""

    place: str
    quote: str
    family: str
    check: str


def register() -> list[Claim]:
    """Return the rows of the register."""
    place, rows = "", []
    for line in REGISTER.read_text(encoding="utf-8").splitlines():
        if line.startswith("["):
            place = line.strip("[]")
        elif line.strip() and not line.startswith("#"):
            quote, family, check = (part.strip() for part in line.split(" | "))
            rows.append(Claim(place, quote, family, check))
    return rows


def sentences(path: Path) -> list[str]:
    """Return the sentences of a module's docstrings, or of a page, each on one line."""
    text = path.read_text(encoding="utf-8")
    if path.suffix != ".py":
        return split(prose(text))
    docstrings = list(_docstrings(ast.parse(text)))
    if path.is_relative_to(ROOT / "gallery"):
        docstrings += re.findall(r"^# %%\n((?:#.*\n)+)", text, re.MULTILINE)
        return split(prose("\n\n".join(docstrings).replace("\n# ", "\n")))
    return [sentence for docstring in docstrings for sentence in _of_docstring(docstring)]


def _docstrings(node: ast.AST) -> Iterator[str]:
    """Yield the docstrings of a module, of its classes and functions, and of those inside."""
    yield ast.get_docstring(node) or ""
    for child in node.body:
        if isinstance(child, ast.ClassDef | ast.FunctionDef):
            yield from _docstrings(child)


def _of_docstring(docstring: str) -> list[str]:
    """Return the sentences of a docstring, those of what comes in where they speak of errors."""
    first, *rest = SECTION.split(re.sub(r"^>>>.*?(?:\n\n|\Z)", "", docstring, flags=re.M | re.S))
    found = split(first)
    for title, body in zip(rest[::2], rest[1::2], strict=True):
        own = split(body)
        found += [one for one in own if title not in INPUTS or SPOKEN.search(one)]
    return found


def prose(text: str) -> str:
    """Return a page without code, pictures and comments; a table is one paragraph."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"^\|[ :|-]+\|\n", "", text, flags=re.MULTILINE)
    blocks, kind = [], ""
    for block in re.split(r"\n[ \t]*\n", text):
        if block[:1] not in " \t":
            kind = "table" if re.match(r"\.\. (?:csv|list)-table", block) else ""
            kind = "code" if (block.startswith("..") and not kind) or block.endswith("::") else kind
        if kind == "table":
            blocks.append(" ".join(block.split()))
        elif kind != "code" or block.endswith("::"):
            blocks.append(block)
    return "\n\n".join(blocks)


def split(text: str) -> list[str]:
    """Return sentences: of paragraphs, items of lists and descriptions of parameters."""
    parts = re.split(r"\n[ \t]*\n|\n(?=[ \t]*[-*] )|\n(?=\S+(?:, \S+)* : )", text)
    return [
        sentence
        for part in parts
        for sentence in re.split(r"(?<=[.;!?]) +(?=[A-Z`*\d(])", " ".join(part.split()))
    ]


def figures(sentence: str) -> list[str]:
    """Return the figures of a sentence that claim something."""
    return FIGURE.findall(IDLE.sub("", sentence))


def places() -> list[Path]:
    """Return the files that are searched."""
    return sorted({path for pattern in PLACES for path in ROOT.glob(pattern)})


def unregistered() -> list[str]:
    """Return the sentences with figures that have no row, each after its file."""
    quotes = {}
    for claim in register():
        quotes.setdefault(claim.place, []).append(claim.quote)
    missing = []
    for path in places():
        place = path.relative_to(ROOT).as_posix()
        for sentence in sentences(path):
            by_suite = place.startswith(SUITE) and "eps" in sentence
            known = any(quote in sentence for quote in quotes.get(place, ()))
            if figures(sentence) and not known and not by_suite:
                missing.append(f"{place}: {sentence}")
    return missing


class Result(NamedTuple):
    """What is stated, the worst that was found, and whether the claim is kept."""

    stated: str
    worst: str
    kept: str


def worst_of(pairs: list[tuple[float, float]]) -> Result:
    """Return the pair of a stated and a found figure that comes nearest to the claim."""
    stated, found = max(pairs, key=lambda pair: pair[1] / pair[0] if pair[0] else pair[1])
    return Result(f"{stated:.3g}", f"{found:.3g}", "yes" if found <= stated else "NO")


class Recorder:
    """Plugin of pytest that collects the figures that tests give to the fixture ``claim``."""

    def __init__(self) -> None:
        self.found: list[tuple[str, str, tuple[float, float]]] = []
        self.outcomes: list[tuple[str, str]] = []

    def pytest_runtest_logreport(self, report) -> None:
        """Take the outcome and the figures of a test."""
        if report.when == "call" or report.outcome != "passed":
            self.outcomes.append((report.nodeid, report.outcome))
        if report.when == "call":
            self.found += [(report.nodeid, *value) for key, value in report.user_properties
                           if key == "claim"]  # fmt: skip

    def result(self, names: list[str]) -> Result:
        """Return what tests found, ``FILE::TEST``, ``FILE::TEST[CASE]`` or ``FILE::TEST@NAME``."""
        outcomes, pairs = set(), []
        for name in names:
            test, _, label = name.partition("@")
            own = [out for node, out in self.outcomes if of_test(node, test)]
            outcomes |= set(own) or {"missing"}
            pairs += [pair for node, by, pair in self.found if of_test(node, test) and by == label]
        if outcomes <= {"passed", "skipped"}:
            return worst_of(pairs) if pairs else Result("", "", "yes" if own else "skipped")
        return Result("", "", "NO")


def of_test(node: str, name: str) -> bool:
    """Return whether a node of pytest is a test, or one of its cases."""
    return node == name or node.startswith((f"{name}[", f"{name.rstrip(']')}-"))


def run_tests(names: list[str], seed: int) -> Recorder:
    """Run tests with the seed, and return what they recorded."""
    import pytest

    recorder = Recorder()
    os.environ["VIZLIGHT_SEED"] = str(seed)
    os.chdir(ROOT)
    if names:
        pytest.main(["-q", "--no-header", *names], plugins=[recorder])
    return recorder


def kind(claim: Claim) -> str:
    """Return the first word of a check."""
    return claim.check.partition(" ")[0].rstrip(":")


def check(claim: Claim, seed: int, recorder: Recorder) -> Result:
    """Return what the check of a row finds."""
    from claim_checks import CHECKS

    if kind(claim) in ELSEWHERE:
        return Result("", "", ELSEWHERE[kind(claim)])
    if claim.check.startswith("tests/"):
        return recorder.result(claim.check.split("; "))
    return worst_of(CHECKS[claim.check](np.random.default_rng(seed)))


def main() -> int:
    """Check the claims and print the table; return 1 if one is not kept."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seed", type=int, default=1, help="seed of the random inputs")
    parser.add_argument("--only", default="", help="word of the rows to check")
    parser.add_argument("--write", action="store_true", help=f"write {TABLE.relative_to(ROOT)}")
    options = parser.parse_args()
    claims = [claim for claim in register() if options.only in " ".join(claim)]
    claims = [claim for claim in claims if not claim.check.startswith("none")]
    tests = [one.check for one in claims if one.check.startswith("tests/")]
    names = {name.partition("@")[0] for check in tests for name in check.split("; ")}
    recorder = run_tests(sorted(names), options.seed)
    rows = []
    for claim in claims:
        rows.append((claim, check(claim, options.seed, recorder)))
        place, (stated, worst, kept) = claim.place, rows[-1][1]
        print(f"{kept:10} {stated:>9} {worst:>9}  {place}: {claim.quote}", flush=True)  # noqa: T201
    if options.write:
        with TABLE.open("w", newline="", encoding="utf-8") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(["file", "claim", "inputs", "stated", "worst", "check"])
            for claim, (stated, worst, _) in rows:
                if kind(claim) not in ELSEWHERE:
                    name = re.split(r"[@\[]", claim.check.rpartition("::")[2])[0]
                    table.writerow([claim.place, claim.quote, claim.family, stated, worst, name])
    return int(any(result.kept == "NO" for _, result in rows))


if __name__ == "__main__":
    sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "gallery")]
    sys.exit(main())
