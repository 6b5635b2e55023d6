"""Compare the answers of people with the meter: ``python compare.py answers.csv [...]``.

It prints for each question and kind of picture the median error, its chance and the median time,
and the rank correlation of the meter's score with the share of right answers over all trials.
"""

from __future__ import annotations

import argparse
import csv
import json
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from vizlight.observers.readers import rank_correlation

TRIALS = Path(__file__).with_name("trials.json")
#: Error of guessing, and largest error of an answer that is right.
CHANCE = {"direction": 45.0, "value": 0.25, "shape": 45.0, "order": 0.5}
RIGHT = {"direction": 15.0, "value": 0.1, "shape": 20.0, "order": 0.0}


def error_of(question, answer, right):
    """Return the error of an answer: degrees, a share of the bar, or 0 and 1 of the order.

    Raises
    ------
    ValueError
        If the answer is none to the question.
    """
    if question == "direction":
        return abs((float(answer) - right + 90) % 180 - 90)
    if question == "value":
        return abs(float(answer) - right)
    if question == "order":
        return abs(int(answer) - right)
    x, y = map(float, answer.split())
    normal = np.array([x, y, max(0.0, 1 - x * x - y * y) ** 0.5])
    return float(np.degrees(np.arccos(np.clip(normal @ right / np.linalg.norm(normal), -1, 1))))


def rows_of(paths, trials):
    """Return trial, error and seconds of all answers in files of the page."""
    found = []
    for path in paths:
        with Path(path).open(newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                trial = trials[int(row["trial"])]
                error = error_of(trial["question"], row["answer"], trial["right"])
                found.append((trial, error, float(row["seconds"])))
    return found


def compared(rows):
    """Return the lines of the table, and the rank correlation of scores and right answers."""
    lines, scores, shares = [], [], []
    for question, chance in CHANCE.items():
        for kind in ("vizlight", "plain"):
            own = [r for r in rows if (r[0]["question"], r[0]["kind"]) == (question, kind)]
            if own:
                error, seconds = (float(np.median([r[i] for r in own])) for i in (1, 2))
                meter = float(np.mean([r[0]["bits"] for r in own]))
                lines.append((question, kind, error, chance, seconds, meter, len(own)))
    for number in sorted({r[0]["trial"] for r in rows}):
        own = [r for r in rows if r[0]["trial"] == number]
        scores.append(own[0][0]["score"])
        shares.append(np.mean([r[1] <= RIGHT[r[0]["question"]] for r in own]))
    return lines, rank_correlation(np.array(scores), np.array(shares))


def main(arguments=None):
    """Print the table of some files of answers."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("answers", nargs="+", type=Path, help="CSV files that the page has saved")
    options = parser.parse_args(arguments)
    trials = {t["trial"]: t for t in json.loads(TRIALS.read_text(encoding="utf-8"))}
    lines, correlation = compared(rows_of(options.answers, trials))
    table = Table("question", "kind", "median error", "chance", "seconds", "meter, bits", "answers")
    for line in lines:
        table.add_row(*(f"{x:.3g}" if isinstance(x, float) else str(x) for x in line))
    Console().print(table)
    print(
        f"rank correlation of the meter's score with the share of right answers: {correlation:.2f}"
    )


if __name__ == "__main__":
    main()
