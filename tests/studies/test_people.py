"""The page that asks people keeps what is right, and its answers are compared with the meter."""

import csv
import json
import runpy
from pathlib import Path

import browsers
import numpy as np
import pytest

HERE = Path(__file__).parents[2] / "gallery" / "studies" / "people"
COMPARE = runpy.run_path(str(HERE / "compare.py"))
TRIALS = json.loads((HERE / "trials.json").read_text(encoding="utf-8"))


def saved(path, answer_of):
    """Write answers as the page does."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["trial", "question", "position", "answer", "seconds"])
        for t in TRIALS:
            writer.writerow([t["trial"], t["question"], 1, answer_of(t), 2.5])
    return path


def right(trial):
    answer = trial["right"]
    return " ".join(map(str, answer[:2])) if trial["question"] == "shape" else answer


def test_there_are_24_trials_of_four_questions_on_four_kinds_of_data():
    assert len(TRIALS) == 24
    assert {t["question"] for t in TRIALS} == set(COMPARE["CHANCE"])
    assert {t["data"].split()[0] for t in TRIALS} == {"winds", "gyroid", "hills", "curves"}
    pairs = {(t["question"], t["data"]) for t in TRIALS}
    assert {(*p, k) for p in pairs for k in ("vizlight", "plain")} == {
        (t["question"], t["data"], t["kind"]) for t in TRIALS
    }


def test_the_page_has_all_trials_needs_no_server_and_claims_nothing():
    page = (HERE / "people.html").read_text(encoding="utf-8")
    assert page.count('"picture": "data:image/webp') == 24
    assert "supports no claim" in page
    assert "http" not in page
    assert '"right"' not in page


def test_the_page_of_readers_has_the_figures_of_the_trials():
    text = (HERE.parents[1] / "pages" / "readers.rst").read_text(encoding="utf-8")
    for ours, plain in zip(TRIALS[::2], TRIALS[1::2], strict=True):
        pair = (ours, plain)
        cells = [f"{t['bits']:.2f}" for t in pair] + [f"{t['readable']:.0%}" for t in pair]
        assert ", ".join([ours["question"], ours["data"], *cells]) in text


def test_right_answers_have_no_error(tmp_path):
    rows = COMPARE["rows_of"]([saved(tmp_path / "a.csv", right)], {t["trial"]: t for t in TRIALS})
    assert max(error for _, error, _ in rows) < 0.1
    lines, _ = COMPARE["compared"](rows)
    assert len(lines) == 8
    assert {line[4] for line in lines} == {2.5}


@pytest.mark.parametrize(
    ("question", "answer", "truth", "error"),
    [
        ("direction", "170", 10.0, 20),
        ("direction", "90", 0.0, 90),
        ("value", "0.25", 0.75, 0.5),
        ("order", "0", 1, 1),
        ("shape", "0 0", [1.0, 0.0, 0.0], 90),
        ("shape", "0.6 0", [0.0, 0.0, 1.0], np.degrees(np.arcsin(0.6))),
    ],
)
def test_errors_of_answers(question, answer, truth, error):
    assert COMPARE["error_of"](question, answer, truth) == pytest.approx(error)


def test_answers_that_follow_the_score_correlate_with_it(tmp_path, capsys):
    def sure(t):
        if t["score"] > np.median([u["score"] for u in TRIALS]):
            return right(t)
        if t["question"] == "direction":
            return (t["right"] + 90) % 180
        if t["question"] == "order":
            return 1 - t["right"]
        return 2 if t["question"] == "value" else "0 0"

    COMPARE["main"]([str(saved(tmp_path / "a.csv", sure))])
    text = capsys.readouterr().out
    assert float(text.rsplit(":", 1)[1]) > 0.4


@browsers.needed()
def test_the_page_takes_answers_and_saves_them(tmp_path):
    from playwright.sync_api import sync_playwright

    question_of = {t["trial"]: t["question"] for t in TRIALS}
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=browsers.CHROMIUM, args=browsers.SOFTWARE)
        page, complaints = browser.new_page(), []
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.goto((HERE / "people.html").as_uri())
        page.click("#begin")
        for _ in TRIALS:
            if page.is_visible("#sides"):
                page.click('#sides button[data-answer="1"]')
                continue
            if page.is_visible("#dial"):
                # Up and to the right: 45 degrees.
                box = page.locator("#dial").bounding_box()
                page.mouse.click(box["x"] + 120, box["y"] + 40)
            else:
                page.fill("#slide", "250")
            page.click("#next")
        with page.expect_download() as download:
            page.click("#save")
        path = tmp_path / "answers.csv"
        download.value.save_as(path)
        browser.close()
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert not complaints
    assert sorted(int(row["trial"]) for row in rows) == list(range(1, 25))
    for row in rows:
        question = question_of[int(row["trial"])]
        assert row["question"] == question
        assert 0 <= float(row["seconds"]) < 600
        if question == "direction":
            assert float(row["answer"]) == pytest.approx(45, abs=2)
        elif question == "shape":
            np.testing.assert_allclose(
                [float(x) for x in row["answer"].split()], [0.51, 0.51], atol=0.03
            )
        else:
            assert row["answer"] == {"value": "0.250", "order": "1"}[question]
