# SPDX-License-Identifier: GPL-3.0-or-later
"""Run bedFoam and other codes on the same beds, in turns; write peers.csv, ratios.csv and a figure.

usage: python scripts/compare_peers.py
       python scripts/compare_peers.py --beds short --repeats 1 --duration 0.01

Each finished run is kept in results/peers/<bed>/runs: a study that was stopped goes on, and one with more
repeats makes only what is new. A code that is not installed is named and left out (envs/apt_peers.txt). It
prints the tables in markdown, and ends with code 1 where a code failed.
"""

import argparse
import sys
from pathlib import Path

from bedchain.errors import report_user_errors
from bedchain.files import write_csv, write_text
from bedchain.lifetime import end_with_run
from bedchain.studies.peers.plots import draw
from bedchain.studies.peers.study import all_peers, compare
from bedchain.studies.peers.table import markdown, ratios, summary

SOLVER = Path("results/bin/bedFoam")
FOLDER = Path("results/peers")
BEDS = ("short", "paper")
DURATION_S = 0.02  # a thousand steps of the particles
LONGEST_S = 75.0
REPEATS = 3


def compare_peers(arguments: argparse.Namespace) -> bool:
    """Run the study and write what it found; whether every code that is installed did its runs."""
    beds, runs = compare(
        arguments.beds,
        arguments.folder,
        arguments.solver,
        arguments.repeats,
        arguments.duration,
        arguments.longest,
        arguments.start,
        lambda line: print(line, flush=True),
    )
    table = summary(runs, beds, all_peers(arguments.solver))
    found = ratios(table)
    text = markdown(table, found)
    write_csv(found, arguments.folder / "ratios.csv")
    write_text(arguments.folder / "peers.md", text + "\n")
    draw(table, arguments.folder / "figures" / "peers")
    write_csv(table, arguments.folder / "peers.csv")
    print(f"\n{text}")
    return not table["note"].str.contains("failed").any()


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--beds", nargs="+", default=BEDS, metavar="CASE", help=f"default {' '.join(BEDS)}")
    parser.add_argument("--repeats", type=int, default=REPEATS, help=f"runs of each code (default {REPEATS})")
    parser.add_argument(
        "--duration", type=float, default=DURATION_S, help=f"simulated time [s] (default {DURATION_S})"
    )
    parser.add_argument(
        "--longest",
        type=float,
        default=LONGEST_S,
        help=f"wall time of a run [s], about (default {LONGEST_S})",
    )
    parser.add_argument("--start", type=float, help="gas before the comparison [s] (default: by the case)")
    parser.add_argument("--solver", type=Path, default=SOLVER, help=f"bedFoam (default {SOLVER})")
    parser.add_argument("--folder", type=Path, default=FOLDER, help=f"for all results (default {FOLDER})")
    end_with_run()
    with report_user_errors():
        return 0 if compare_peers(parser.parse_args()) else 1


if __name__ == "__main__":
    sys.exit(main())
