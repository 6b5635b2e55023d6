"""Run a study, or list the studies: ``python gallery/studies [NAME] [--quick] [-o FOLDER]``."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from rich.console import Console
from rich.table import Table

if __name__ == "__main__":
    # Python puts the folder of this file first: its modules are a package of the one above.
    sys.path[0] = str(Path(__file__).resolve().parents[1])
import studies


def main(arguments: list[str] | None = None) -> None:
    """Print the table and the verdict of a study; write NAME.csv and the figure NAME.png."""
    parser = argparse.ArgumentParser(prog="gallery/studies", description=main.__doc__)
    parser.add_argument("name", nargs="?", choices=studies.names(), metavar="NAME")
    parser.add_argument("--quick", action="store_true", help="measure less: under 20 s on 2 cores")
    parser.add_argument("-o", "--out", type=Path, default=Path("build/studies"), help="folder")
    options = parser.parse_args(arguments)
    console = Console(markup=False, highlight=False, width=140)
    if options.name is None:
        table = Table("study", "approximated quantity", "reference", "parameter")
        for name in studies.names():
            study = studies.load(name)
            table.add_row(name, study.approximates, study.reference, study.parameter)
        console.print(table)
        return
    study = studies.load(options.name)
    result = studies.run(options.name, study, quick=options.quick, progress_bar=True)
    headings, lines = result.table()
    table = Table(*headings)
    for line in lines:
        table.add_row(*map(studies.number, line))
    console.print(table)
    console.print(f"approximated: {result.study.approximates}")
    console.print(f"reference: {result.study.reference}")
    console.print(f"verdict: {result.verdict}")
    options.out.mkdir(parents=True, exist_ok=True)
    console.print(f"table: {result.write_csv(options.out / f'{options.name}.csv')}")
    console.print(f"figure: {result.draw(options.out / f'{options.name}.png')}")


if __name__ == "__main__":
    main()
