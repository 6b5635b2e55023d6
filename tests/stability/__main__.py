"""Run the stability suite, print the worst case of each kernel, and write all cases to a CSV file.

``.venv/bin/python tests/stability`` makes the table of the pages, ``gallery/pages/stability.csv``,
in some 5 minutes. With ``--quick`` a sample takes 20 s; no file is written without ``--out``.
"""

import argparse
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
TABLE = TESTS.parent / "gallery" / "pages" / "stability.csv"


def main():
    """Run the suite; return 0 if all claims hold."""
    parser = argparse.ArgumentParser(prog="tests/stability", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="run a sample of the inputs")
    parser.add_argument("--out", type=Path, help=f"file to write; default: {TABLE}")
    options = parser.parse_args()
    # Python puts the folder of this file first: its modules are a package of the one above.
    sys.path[:1] = [str(TESTS), str(TESTS.parent / "gallery")]
    try:
        from stability import suite
    except ModuleNotFoundError as error:
        if error.name != "mpmath":
            raise
        sys.exit("mpmath is missing, the reference of 50 digits; pip install 'vizlight[test]'")
    import studies

    result = studies.run("stability", suite.STUDY, quick=options.quick)
    for line in [*suite.worst(result.rows)[1], [suite.verdict(result.rows)]]:
        print(*(cell if isinstance(cell, str) else f"{cell:.4g}" for cell in line), sep="  ")  # noqa: T201
    out = options.out or (None if options.quick else TABLE)
    if out is not None:
        print("table   ", result.write_csv(out))  # noqa: T201
    return int(any(row.more[""] == "FAIL" for row in result.rows))


if __name__ == "__main__":
    sys.exit(main())
