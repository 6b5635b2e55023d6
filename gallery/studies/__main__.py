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


def main(arguments=None):
    """Print the table of a study; write NAME.csv and the figure NAME.png."""
    parser = argparse.ArgumentParser(prog="gallery/studies", description=main.__doc__)
    parser.add_argument("name", nargs="?", choices=studies.names(), metavar="NAME")
    parser.add_argument("--quick", action="store_true", help="measure less: under 20 s on 2 cores")
    parser.add_argument("-o", "--out", type=Path, default=Path("build/studies"), help="folder")
    options = parser.parse_args(arguments)
    console = Console(markup=False, highlight=False, width=140)
    if options.name is None:
        for name in studies.names():
            console.print(f"{name}: {studies.load(name).approximates}")
        return
    result = studies.run(options.name, studies.load(options.name), quick=options.quick)
    headings, lines = result.table()
    table = Table(*headings, caption=f"reference: {result.study.reference}")
    for line in lines:
        table.add_row(*map(studies.number, line))
    console.print(table)
    options.out.mkdir(parents=True, exist_ok=True)
    console.print(f"table: {result.write_csv(options.out / f'{options.name}.csv')}")
    console.print(f"figure: {result.draw(options.out / f'{options.name}.png')}")


if __name__ == "__main__":
    main()
