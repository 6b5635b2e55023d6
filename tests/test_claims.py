"""The register of claims is whole, its sample is kept, and it can fail."""

import re

import claims
import pytest
from claim_checks import CHECKS

REGISTER = claims.register()


@pytest.mark.parametrize("name", CHECKS)
def test_a_sample_is_kept(name, random):
    pairs = CHECKS[name](random)
    assert pairs
    assert [pair for pair in pairs if not pair[1] <= pair[0]] == []


def test_every_row_has_its_sentence():
    texts = {
        place: " ".join((claims.ROOT / place).read_text(encoding="utf-8").split())
        for place in {one.place for one in REGISTER}
    }
    assert [one for one in REGISTER if one.quote not in texts[one.place]] == []


def test_every_figure_has_a_row():
    assert claims.unregistered() == []


def test_every_check_is_there():
    kinds = {one.check.partition(" ")[0].rstrip(":") for one in REGISTER}
    assert {kind for kind in kinds if not kind.startswith("tests/")} <= {*CHECKS, *claims.ELSEWHERE}
    assert set(CHECKS) <= kinds
    for row in REGISTER:
        if row.check.startswith("tests/"):
            for path, name in (name.split("::") for name in row.check.split("; ")):
                test = name.partition("@")[0].partition("[")[0]
                assert f"def {test}(" in (claims.ROOT / path).read_text(encoding="utf-8"), row
        elif row.check.startswith("study"):
            names = {path.stem for path in (claims.ROOT / "gallery" / "studies").glob("[a-z]*.py")}
            assert row.check.split()[1] in names, row


@pytest.mark.parametrize(
    "sentence",
    [
        "The error is at most 0.01 there.", "It takes 3 ms.", "Bits are within 5 of 255.",
        "Colours are 5 % too bright.", "Four times as high is dark.", "Hue is read to 4 degrees.",
        "It leaves a half.", "The memory is three times that of the mesh.",
    ],
)  # fmt: skip
def test_a_figure_is_found(sentence):
    assert claims.figures(sentence)


@pytest.mark.parametrize(
    "sentence",
    [
        "Number of steps, default: 5 times.", "A share from 0 to 1.", "Shape (3, 4) of 2 axes.",
        "In November 2026 it was so.", "A grid of 512 x 512 nodes.", "Turned by a quarter of 90.",
    ],
)  # fmt: skip
def test_what_claims_nothing_is_left_alone(sentence):
    assert not claims.figures(sentence)


def test_a_claim_that_is_not_kept_is_named():
    assert claims.worst_of([(1.0, 0.5), (2.0, 2.5)]) == ("2", "2.5", "NO")
    assert claims.worst_of([(0.0, 0.0), (2.0, 0.5)]).kept == "yes"


def test_the_table_of_the_pages_has_the_rows_of_the_register():
    lines = claims.TABLE.read_text(encoding="utf-8").splitlines()
    """After a new row ``python tests/claims.py --write`` makes it again."""
    rows = [one for one in REGISTER if claims.kind(one) not in claims.ELSEWHERE]
    assert len(lines) == len(rows) + 1
    for line, row in zip(lines[1:], rows, strict=True):
        assert re.sub(r"\W", "", row.quote) in re.sub(r"\W", "", line)
